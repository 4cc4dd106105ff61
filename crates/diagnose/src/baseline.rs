//! What a model remembers of clean flights beside its table: a smooth remainder, the N2 deck, the split between engines,
//! and how large the noise is. Each with its covariance.

use faer::Mat;
use perf_model::PerformanceModel;
use perf_model::effects::{EffectModel, EffectReferences, Response};
use serde::{Deserialize, Serialize};

use crate::DiagnoseError;
use crate::data::{DECK_TERMS, Data, Deck, ENVIRONMENT};
use crate::design::{half_whitened, whiten_flight};
use crate::gram::integrate_out;
use crate::library::Library;
use crate::linear::{Factor, add_gram, symmetrize};
use crate::noise::{MAXIMUM_CHANNELS, NoiseFactors};
use crate::record::FlightRecord;
use crate::variables::{Hats, Scaled, Variable};

/// Variables of the remainder.
const VARIABLES: [Variable; 6] = [
    Variable::Mach,
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::IsaDeviation,
    Variable::Mass,
];
/// Variables that the remainder may bend along differently at each Mach number: drag rises locally, and so does thrust.
const LOCAL_VARIABLES: [Variable; 3] =
    [Variable::LiftCoefficient, Variable::CorrectedThrust, Variable::PressureAltitude];
const QUANTILES: [f64; 9] = [0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0];
/// Prior standard deviation of the remainder's level, of a hat function and of a product: shares of fuel flow.
const LEVEL_DEVIATION: f64 = 0.10;
const HAT_DEVIATION: f64 = 0.02;
const PRODUCT_DEVIATION: f64 = 0.005;
/// Prior standard deviation of the level of ln(Wf1/Wf2).
const SPLIT_DEVIATION: f64 = 0.03;
/// Prior standard deviation of a deck coefficient about its least-squares value.
const DECK_DEVIATION: f64 = 0.02;
/// Usual noise over the handbook's, and its spread: factors of 0.3 to 0.55 were seen on simulated fleets.
const USUAL_NOISE: f64 = 0.5;
const USUAL_NOISE_LN_DEVIATION: f64 = 0.5;
/// Spread of the sizes of hat functions and products about their defaults.
const SCALE_LN_DEVIATION: f64 = 1.0;
/// Folds of flights that the scatter between flights is judged on, and rounds of it.
const FOLDS: usize = 10;
const INFLATIONS: usize = 3;
/// Prior standard deviation of how much of the environment's effects a fleet shows: all of it, or none.
const ENVIRONMENT_DEVIATION: f64 = 1.0;
/// Rounds over all dials, the first of them coarse.
const ROUNDS: usize = 12;
const COARSE_ROUNDS: usize = 4;
const COARSE_STEP: f64 = 1.6;
const FINE_STEP: f64 = 1.1;
/// Dials: noise within flights and between flights of three kinds of channels, sizes of hat functions and of products.
const DIALS: usize = 8;
/// Limits of every dial: what a few flights say is not believed beyond them.
const NOISE_LIMITS: (f64, f64) = (0.03, 10.0);
/// Fewest flights that teach a remainder.
const FEWEST_FLIGHTS: usize = 5;

/// A taught baseline. Reads and writes with serde, to the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Parts", into = "Parts")]
pub struct Baseline {
    parts: Parts,
    factor: Mat<f64>,
}

/// A baseline as it is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Baseline")]
struct Parts {
    flights: usize,
    segments: usize,
    references: EffectReferences,
    noise: NoiseFactors,
    /// Factors on the prior standard deviations of hat functions and products.
    scales: [f64; 2],
    hats: Vec<(Variable, Hats)>,
    products: Vec<(Variable, Scaled, Variable, Scaled)>,
    /// Variables that the remainder may bend along differently at each Mach number.
    local: Vec<(Variable, Scaled)>,
    contrasts: usize,
    deck_known: bool,
    deck_centers: [f64; 4],
    deck_coefficients: Vec<f64>,
    /// Means of remainder terms and splits.
    mean: Vec<f64>,
    /// Lower triangle, row by row, of the Cholesky factor of the covariance of remainder terms, splits and deck.
    factor: Vec<f64>,
    /// How much of local gravity, rotating Earth and isobaric slope the fleet shows.
    environment: [f64; ENVIRONMENT.len()],
    /// Remaining rms of ln fuel flow over what taught it.
    rms: f64,
}

/// Numbers that are no baseline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{quantity}: {found} numbers, expected {expected}")]
pub struct BaselineLengthError {
    quantity: &'static str,
    found: usize,
    expected: usize,
}

impl Baseline {
    /// Learns from clean flights against a model and a drag table (its own, or the adapted one).
    ///
    /// # Errors
    /// [`DiagnoseError`] where the model takes no effects, or fewer than five flights are inside the table.
    pub fn learn(
        model: &PerformanceModel,
        drag_table: &lut::Table,
        flights: &[FlightRecord<'_>],
    ) -> Result<Self, DiagnoseError> {
        let references = crate::references_of(model, drag_table, flights)?;
        let effect_model = EffectModel::new(model, drag_table, references)?;
        let (mut data, _) =
            Data::prepare(&effect_model, flights, None, |points, engines, starts| {
                Library::of(&effect_model, points, engines, starts, |_| false)
            });
        if data.flights.len() < FEWEST_FLIGHTS {
            let found = data.flights.len();
            return Err(DiagnoseError::TooFewFlights { found, needed: FEWEST_FLIGHTS });
        }
        let mut baseline = Self::prior(&data, &references);
        baseline.tune(&mut data);
        for _ in 0..INFLATIONS {
            baseline.inflate(&mut data);
        }
        baseline.fit(&data)?;
        Ok(baseline)
    }

    /// Factors on the sensors' standard deviations.
    #[must_use]
    pub const fn noise(&self) -> &NoiseFactors {
        &self.parts.noise
    }

    /// The conditions that effects are zero at: the mean of what taught it.
    #[must_use]
    pub const fn references(&self) -> &EffectReferences {
        &self.parts.references
    }

    /// Flights and segments that taught it.
    #[must_use]
    pub const fn taught_by(&self) -> (usize, usize) {
        (self.parts.flights, self.parts.segments)
    }

    /// Root mean square of ln fuel flow that it leaves over what taught it.
    #[must_use]
    pub const fn remaining_rms(&self) -> f64 {
        self.parts.rms
    }

    /// Mean and standard deviation of the remainder of ln fuel flow at a point: what `predict` adds to ln Wf.
    #[must_use]
    pub fn remainder(&self, response: &Response) -> (f64, f64) {
        let mut terms = vec![0.0; self.remainder_terms()];
        self.write_remainder(response, &mut terms);
        let variance: f64 = (0..self.factor.ncols())
            .map(|column| {
                let loading: f64 = terms
                    .iter()
                    .enumerate()
                    .map(|(row, term)| term * self.factor[(row, column)])
                    .sum();
                loading * loading
            })
            .sum();
        (self.remainder_mean(&terms), variance.sqrt())
    }

    /// Mean of the remainder at a point.
    pub(crate) fn mean_at(&self, response: &Response) -> f64 {
        let mut terms = vec![0.0; self.remainder_terms()];
        self.write_remainder(response, &mut terms);
        self.remainder_mean(&terms)
    }

    /// How much of local gravity, rotating Earth and isobaric slope the fleet that taught it shows: 1 is all that physics
    /// says, 0 none.
    #[must_use]
    pub const fn environment(&self) -> [f64; 3] {
        self.parts.environment
    }

    pub(crate) const fn contrasts(&self) -> usize {
        self.parts.contrasts
    }

    pub(crate) fn split_mean(&self, contrast: usize) -> f64 {
        self.parts.mean[self.remainder_terms() + contrast - 1]
    }

    pub(crate) const fn factor(&self) -> &Mat<f64> {
        &self.factor
    }

    pub(crate) fn deck(&self) -> Option<Deck> {
        let mut coefficients = [0.0; DECK_TERMS];
        coefficients.copy_from_slice(self.parts.deck_coefficients.get(..DECK_TERMS)?);
        self.parts.deck_known.then_some(Deck { centers: self.parts.deck_centers, coefficients })
    }

    pub(crate) fn remainder_terms(&self) -> usize {
        1 + self.parts.hats.iter().map(|(_, hats)| hats.len() + 2).sum::<usize>()
            + self.parts.products.len()
            + self.local_hats().map(|(hats, local)| hats.len() * local.len()).sum::<usize>()
    }

    pub(crate) fn remainder_mean(&self, terms: &[f64]) -> f64 {
        terms.iter().zip(&self.parts.mean).map(|(term, mean)| term * mean).sum()
    }

    /// Writes the remainder's terms at the state that was flown. The baseline's own references hold.
    pub(crate) fn write_remainder(&self, response: &Response, into: &mut [f64]) {
        let value = |variable: Variable| variable.flown(response, &self.parts.references);
        into[0] = 1.0;
        let mut at = 1;
        for (variable, hats) in &self.parts.hats {
            let value = value(*variable);
            hats.write(value, &mut into[at..at + hats.len()]);
            at += hats.len();
            into[at..at + 2].copy_from_slice(&hats.beyond(value));
            at += 2;
        }
        for (a, scaled_a, b, scaled_b) in &self.parts.products {
            into[at] = scaled_a.at(value(*a)) * scaled_b.at(value(*b));
            at += 1;
        }
        for (hats, local) in self.local_hats() {
            let mach = value(Variable::Mach);
            for (variable, scaled) in local {
                let by = scaled.at(value(*variable));
                hats.write(mach, &mut into[at..at + hats.len()]);
                for slot in &mut into[at..at + hats.len()] {
                    *slot *= by;
                }
                at += hats.len();
            }
        }
    }

    /// Mach number's hat functions and the variables that each of them may bend along.
    fn local_hats(&self) -> impl Iterator<Item = (&Hats, &Vec<(Variable, Scaled)>)> {
        self.parts
            .hats
            .iter()
            .filter(|(variable, _)| *variable == Variable::Mach)
            .map(|(_, hats)| (hats, &self.parts.local))
    }

    /// The baseline before it has learnt.
    fn prior(data: &Data<'_>, references: &EffectReferences) -> Self {
        let values = |variable: Variable| -> Option<Vec<f64>> {
            data.segments
                .iter()
                .map(|row| variable.flown(&row.response, references))
                .map(Some)
                .collect()
        };
        let hats: Vec<_> = VARIABLES
            .into_iter()
            .filter_map(|v| Some((v, Hats::at_quantiles(&values(v)?, &QUANTILES)?)))
            .collect();
        let mut products = Vec::new();
        for (k, a) in VARIABLES.into_iter().enumerate() {
            for b in VARIABLES.into_iter().skip(k + 1) {
                if let (Some(of_a), Some(of_b)) = (values(a), values(b)) {
                    products.push((a, Scaled::of(&of_a), b, Scaled::of(&of_b)));
                }
            }
        }
        let local: Vec<(Variable, Scaled)> = LOCAL_VARIABLES
            .into_iter()
            .filter_map(|v| Some((v, Scaled::of(&values(v)?))))
            .collect();
        let parts = Parts {
            flights: data.flights.len(),
            segments: data.segments.len(),
            references: *references,
            noise: NoiseFactors::default(),
            scales: [1.0; 2],
            hats,
            products,
            local,
            contrasts: data.channels.contrasts,
            deck_known: data.channels.n2,
            deck_centers: data.predictor.deck.centers,
            deck_coefficients: data.predictor.deck.coefficients.to_vec(),
            mean: Vec::new(),
            factor: Vec::new(),
            environment: [0.0; ENVIRONMENT.len()],
            rms: f64::NAN,
        };
        let mut baseline = Self { parts, factor: Mat::zeros(0, 0) };
        let means = baseline.remainder_terms() + baseline.parts.contrasts;
        let width = means + DECK_TERMS + ENVIRONMENT.len();
        baseline.parts.mean = vec![0.0; means];
        baseline.factor = Mat::zeros(width, width);
        baseline
    }

    fn prior_deviation(&self, index: usize) -> f64 {
        let terms = self.remainder_terms();
        let products = 1 + self.parts.hats.iter().map(|(_, hats)| hats.len() + 2).sum::<usize>();
        if index == 0 {
            LEVEL_DEVIATION
        } else if index < products {
            HAT_DEVIATION * self.parts.scales[0]
        } else if index < terms {
            PRODUCT_DEVIATION * self.parts.scales[1]
        } else if index < terms + self.parts.contrasts {
            SPLIT_DEVIATION
        } else if index < self.factor.nrows() - ENVIRONMENT.len() {
            DECK_DEVIATION
        } else {
            ENVIRONMENT_DEVIATION
        }
    }

    /// Posterior of all coefficients at the present noise.
    fn fit(&mut self, data: &Data<'_>) -> Result<(), DiagnoseError> {
        let width = self.factor.nrows();
        let (gram, _) = self.gram(data);
        let mut precision = Mat::from_fn(width, width, |i, j| gram[(i, j)]);
        for k in 0..width {
            let deviation = self.prior_deviation(k);
            precision[(k, k)] += 1.0 / (deviation * deviation);
        }
        let factor = Factor::of(&precision).ok_or(DiagnoseError::Degenerate)?;
        let mut covariance = Mat::<f64>::identity(width, width);
        factor.solve(&mut covariance);
        let mut solution = Mat::from_fn(width, 1, |i, _| gram[(i, width)]);
        factor.solve(&mut solution);
        let terms = self.parts.mean.len();
        for k in 0..terms {
            self.parts.mean[k] = solution[(k, 0)];
        }
        for k in 0..DECK_TERMS {
            self.parts.deck_coefficients[k] =
                data.predictor.deck.coefficients[k] + solution[(terms + k, 0)];
        }
        for k in 0..ENVIRONMENT.len() {
            self.parts.environment[k] = solution[(terms + DECK_TERMS + k, 0)];
        }
        // A covariance inverted in floating point may miss definiteness by rounding; a hair on the diagonal mends it.
        for k in 0..width {
            covariance[(k, k)] *= 1.0 + 1e-12;
        }
        let lower = Factor::of(&covariance).ok_or(DiagnoseError::Degenerate)?;
        self.factor = lower.lower().to_owned();
        self.parts.factor = (0..width)
            .flat_map(|i| (0..=i).map(move |j| (i, j)))
            .map(|ij| self.factor[ij])
            .collect();
        let squares: f64 = data
            .segments
            .iter()
            .map(|row| {
                let carried: f64 = row
                    .environment
                    .iter()
                    .zip(self.parts.environment)
                    .map(|(slope, size)| slope[0] * size)
                    .sum();
                (row.residual[0] - self.mean_at(&row.response) - carried).powi(2)
            })
            .sum();
        self.parts.rms = (squares / data.segments.len().max(1) as f64).sqrt();
        Ok(())
    }

    /// Raw values of every column and, last, the residual.
    fn raw_row(
        &self,
        data: &Data<'_>,
        row: &crate::data::SegmentRow,
    ) -> Vec<[f64; MAXIMUM_CHANNELS]> {
        let terms = self.remainder_terms();
        let mut remainder = vec![0.0; terms];
        self.write_remainder(&row.response, &mut remainder);
        let mut raw = vec![[0.0; MAXIMUM_CHANNELS]; self.factor.nrows() + 1];
        for (slot, value) in raw.iter_mut().zip(&remainder) {
            slot[0] = *value;
        }
        for contrast in 1..=self.parts.contrasts {
            if row.is_recorded[contrast] {
                raw[terms + contrast - 1][contrast] = 1.0;
            }
        }
        if data.channels.n2 {
            let channel = data.channels.n2_row();
            if row.is_recorded[channel] {
                for (k, term) in row.deck.into_iter().enumerate() {
                    raw[terms + self.parts.contrasts + k][channel] = term;
                }
            }
        }
        let environment = self.factor.nrows() - ENVIRONMENT.len();
        raw[environment..environment + ENVIRONMENT.len()].copy_from_slice(&row.environment);
        if let Some(last) = raw.last_mut() {
            *last = row.residual;
        }
        raw
    }

    /// Noise factors and sizes of the remainder by marginal likelihood: what is left of a flexible remainder is no measure
    /// of the noise, because the remainder has eaten part of it.
    fn tune(&mut self, data: &mut Data<'_>) {
        let mut best = self.ln_marginal(data);
        for round in 0..ROUNDS {
            let step = if round < COARSE_ROUNDS { COARSE_STEP } else { FINE_STEP };
            let mut moved = false;
            for dial in 0..DIALS {
                if !Self::is_live(dial, data) {
                    continue;
                }
                for by in [step, 1.0 / step] {
                    while let Some(found) = self.try_dial(dial, by, best, data) {
                        best = found;
                        moved = true;
                    }
                }
            }
            if !moved && round >= COARSE_ROUNDS {
                break;
            }
        }
    }

    const fn is_live(dial: usize, data: &Data<'_>) -> bool {
        match dial {
            0 | 3 | 6 | 7 => true,
            1 | 4 => data.channels.contrasts > 0,
            _ => data.channels.n2,
        }
    }

    /// Turns a dial; the better marginal likelihood, or `None` where it is not better, and the dial is turned back.
    fn try_dial(&mut self, dial: usize, by: f64, best: f64, data: &mut Data<'_>) -> Option<f64> {
        let before = (self.parts.noise, self.parts.scales);
        let value = match dial {
            0..3 => &mut self.parts.noise.within[dial],
            3..6 => &mut self.parts.noise.between[dial - 3],
            _ => &mut self.parts.scales[dial - 6],
        };
        let turned = *value * by;
        let (low, high) = NOISE_LIMITS;
        if turned < low || turned > high {
            return None;
        }
        *value = turned;
        rescale(data, &before.0, &self.parts.noise);
        let found = self.ln_marginal(data);
        if found > best + 1e-3 {
            return Some(found);
        }
        rescale(data, &self.parts.noise, &before.0);
        (self.parts.noise, self.parts.scales) = before;
        None
    }

    /// Raises the scatter between flights to what flights show that were not learnt from.
    ///
    /// A remainder that fits the flights it has seen says too little about the next one. For flights left out by folds, the
    /// mean residual must be as large as announced:
    ///
    /// ```text
    /// Σ_f e_f²/(v_model + v_within + κ² v_between) = number of flights
    /// ```
    fn inflate(&mut self, data: &mut Data<'_>) {
        let mut errors: [Vec<[f64; 3]>; 3] = [vec![], vec![], vec![]]; // squared error, known variance, between
        for fold in 0..FOLDS {
            let Some((solution, factor)) = self.posterior_without(data, fold) else { return };
            for (_, flight) in data.flights.iter().enumerate().filter(|(k, _)| k % FOLDS == fold) {
                let segments = &data.segments[flight.segments.clone()];
                for channel in 0..data.channels.count() {
                    let kind = data.channels.kind(channel);
                    let found = self.left_out(data, segments, channel, &solution, &factor);
                    errors[kind].extend(found);
                }
            }
        }
        let before = self.parts.noise;
        let (low, high) = NOISE_LIMITS;
        for (kind, errors) in errors.iter().enumerate() {
            if errors.is_empty() {
                continue;
            }
            let excess = |factor: f64| {
                errors
                    .iter()
                    .map(|[square, known, between]| square / (known + factor * factor * between))
                    .sum::<f64>()
                    - errors.len() as f64
            };
            let now = self.parts.noise.between[kind];
            if excess(1.0) <= 0.0 {
                continue;
            }
            let (mut below, mut above) = (1.0, high / now);
            for _ in 0..60 {
                let middle = f64::midpoint(below, above);
                if excess(middle) > 0.0 { below = middle } else { above = middle }
            }
            self.parts.noise.between[kind] = (now * above).clamp(low, high);
        }
        rescale(data, &before, &self.parts.noise);
    }

    /// Coefficients and precision factor from all flights but a fold's.
    fn posterior_without(&self, data: &Data<'_>, fold: usize) -> Option<(Mat<f64>, Factor)> {
        let width = self.factor.nrows();
        let (gram, _) = self.gram_of(data, |flight| flight % FOLDS != fold);
        let mut precision = Mat::from_fn(width, width, |i, j| gram[(i, j)]);
        for k in 0..width {
            let deviation = self.prior_deviation(k);
            precision[(k, k)] += 1.0 / (deviation * deviation);
        }
        let factor = Factor::of(&precision)?;
        let mut solution = Mat::from_fn(width, 1, |i, _| gram[(i, width)]);
        factor.solve(&mut solution);
        Some((solution, factor))
    }

    /// Squared mean residual of a flight that was left out, its variance but for what the flight has in common, and that.
    fn left_out(
        &self,
        data: &Data<'_>,
        segments: &[crate::data::SegmentRow],
        channel: usize,
        solution: &Mat<f64>,
        factor: &Factor,
    ) -> Option<[f64; 3]> {
        if !segments.iter().all(|row| row.is_recorded[channel]) {
            return None;
        }
        let width = self.factor.nrows();
        let count = segments.len() as f64;
        let mut loading = Mat::<f64>::zeros(width, 1);
        let mut error = 0.0;
        let mut known = 0.0;
        let mut between = 0.0;
        for row in segments {
            let raw = self.raw_row(data, row);
            error += row.residual[channel] / count;
            for (k, values) in raw.iter().take(width).enumerate() {
                loading[(k, 0)] += values[channel] / count;
            }
            let own: f64 = row.noise.factor[channel][..=channel].iter().map(|l| l * l).sum();
            known += own / (count * count);
            between +=
                row.noise.common.iter().map(|u| u[channel] * u[channel]).sum::<f64>() / count;
        }
        error -= (0..width).map(|k| loading[(k, 0)] * solution[(k, 0)]).sum::<f64>();
        factor.half_solve(&mut loading);
        known += (0..width).map(|k| loading[(k, 0)] * loading[(k, 0)]).sum::<f64>();
        Some([error * error, known, between])
    }

    /// ln of the marginal likelihood, up to a constant.
    ///
    /// ```text
    /// −½ Σ_f ln|C_f| − ½ ln|1 + S G S| − ½ (y² − bᵀ S (1 + S G S)⁻¹ S b)                  [diagnosis.17]
    /// ```
    fn ln_marginal(&self, data: &Data<'_>) -> f64 {
        let width = self.factor.nrows();
        let (gram, ln_noise) = self.gram(data);
        let kept = [width];
        let out: Vec<usize> = (0..width).collect();
        let deviations: Vec<f64> = out.iter().map(|&k| self.prior_deviation(k)).collect();
        integrate_out(&gram, &kept, &out, &deviations).map_or(f64::NEG_INFINITY, |left| {
            self.ln_prior_of_dials() - 0.5 * (ln_noise + left.ln_determinant + left.matrix[(0, 0)])
        })
    }

    /// Dials are log-normal about what is usual: a few flights do not make noise vanish.
    fn ln_prior_of_dials(&self) -> f64 {
        let noise = self.parts.noise;
        let of = |value: f64, center: f64, ln_deviation: f64| {
            let z = (value / center).ln() / ln_deviation;
            -0.5 * z * z
        };
        noise
            .within
            .into_iter()
            .chain(noise.between)
            .map(|factor| of(factor, USUAL_NOISE, USUAL_NOISE_LN_DEVIATION))
            .sum::<f64>()
            + self
                .parts
                .scales
                .into_iter()
                .map(|scale| of(scale, 1.0, SCALE_LN_DEVIATION))
                .sum::<f64>()
    }

    /// Whitened Gram of raw columns and residual, and Σ `ln|C_f|`.
    fn gram(&self, data: &Data<'_>) -> (Mat<f64>, f64) {
        self.gram_of(data, |_| true)
    }

    /// The same of some flights.
    fn gram_of(&self, data: &Data<'_>, keep: impl Fn(usize) -> bool) -> (Mat<f64>, f64) {
        let width = self.factor.nrows();
        let mut gram = Mat::<f64>::zeros(width + 1, width + 1);
        let mut ln_noise = 0.0;
        let channels = data.channels.count();
        for (index, flight) in data.flights.iter().enumerate() {
            if !keep(index) {
                continue;
            }
            let segments = &data.segments[flight.segments.clone()];
            let mut matrix = Mat::<f64>::zeros(segments.len() * channels, width + 1);
            for (index, row) in segments.iter().enumerate() {
                for channel in 0..channels {
                    ln_noise += 2.0 * row.noise.factor[channel][channel].ln();
                }
                let raw = self.raw_row(data, row);
                for (column, values) in raw.iter().enumerate() {
                    let white = half_whitened(row, values, channels);
                    for channel in 0..channels {
                        matrix[(index * channels + channel, column)] = white[channel];
                    }
                }
            }
            ln_noise += whiten_flight(data, segments, &mut matrix);
            add_gram(&mut gram, &matrix);
        }
        symmetrize(&mut gram);
        (gram, ln_noise)
    }
}

/// Rescales the noise of prepared segments from one set of factors to another.
fn rescale(data: &mut Data<'_>, from: &NoiseFactors, to: &NoiseFactors) {
    let channels = data.channels;
    for row in &mut data.segments {
        for channel in 0..channels.count() {
            let kind = channels.kind(channel);
            if !row.is_recorded[channel] {
                continue;
            }
            for value in &mut row.noise.factor[channel] {
                *value *= to.within[kind] / from.within[kind];
            }
            for loading in &mut row.noise.common {
                loading[channel] *= to.between[kind] / from.between[kind];
            }
        }
    }
}

impl From<Baseline> for Parts {
    fn from(baseline: Baseline) -> Self {
        baseline.parts
    }
}

impl TryFrom<Parts> for Baseline {
    type Error = BaselineLengthError;
    fn try_from(parts: Parts) -> Result<Self, BaselineLengthError> {
        let mut baseline = Self { parts, factor: Mat::zeros(0, 0) };
        let check = |quantity, found, expected| {
            if found == expected {
                Ok(())
            } else {
                Err(BaselineLengthError { quantity, found, expected })
            }
        };
        let means = baseline.remainder_terms() + baseline.parts.contrasts;
        let width = means + DECK_TERMS + ENVIRONMENT.len();
        check("means", baseline.parts.mean.len(), means)?;
        check("deck coefficients", baseline.parts.deck_coefficients.len(), DECK_TERMS)?;
        check("covariance factor", baseline.parts.factor.len(), width * (width + 1) / 2)?;
        let mut factor = Mat::zeros(width, width);
        let mut values = baseline.parts.factor.iter();
        for i in 0..width {
            for j in 0..=i {
                factor[(i, j)] = values.next().copied().unwrap_or(0.0);
            }
        }
        baseline.factor = factor;
        Ok(baseline)
    }
}
