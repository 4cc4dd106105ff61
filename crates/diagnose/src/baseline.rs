//! What a model remembers of clean flights beside its table: a smooth remainder, the N2 deck, the split between engines,
//! and how large the noise is. Each with its covariance.

use faer::Mat;
use perf_model::PerformanceModel;
use perf_model::effects::{EffectModel, EffectPoint, EffectReferences, Response};
use serde::{Deserialize, Serialize};

use crate::data::{DECK_TERMS, Data, Deck};
use crate::design::{half_whitened, whiten_flight};
use crate::library::Library;
use crate::linear::{Factor, add_gram, symmetrize};
use crate::noise::{MAXIMUM_CHANNELS, NoiseFactors};
use crate::record::FlightRecord;
use crate::variables::{Hats, Scaled, Variable};
use crate::DiagnoseError;

/// Variables of the remainder.
const VARIABLES: [Variable; 6] = [
    Variable::Mach,
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::IsaDeviation,
    Variable::Mass,
];
const QUANTILES: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];
/// Prior standard deviation of the remainder's level, of a hat function and of a product: shares of fuel flow.
const LEVEL_DEVIATION: f64 = 0.10;
const HAT_DEVIATION: f64 = 0.02;
const PRODUCT_DEVIATION: f64 = 0.005;
/// Prior standard deviation of the level of ln(Wf1/Wf2).
const SPLIT_DEVIATION: f64 = 0.03;
/// Prior standard deviation of a deck coefficient about its least-squares value.
const DECK_DEVIATION: f64 = 0.02;
/// Rounds of learning coefficients and noise levels in turn.
const ROUNDS: usize = 4;
/// Limits of a noise factor: what a few flights say is not believed beyond them.
const NOISE_LIMITS: (f64, f64) = (0.1, 10.0);
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
    hats: Vec<(Variable, Hats)>,
    products: Vec<(Variable, Scaled, Variable, Scaled)>,
    contrasts: usize,
    deck_known: bool,
    deck_centers: [f64; 4],
    deck_coefficients: Vec<f64>,
    /// Means of remainder terms and splits.
    mean: Vec<f64>,
    /// Lower triangle, row by row, of the Cholesky factor of the covariance of remainder terms, splits and deck.
    factor: Vec<f64>,
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
        let (mut data, _) = Data::prepare(&effect_model, flights, None, |points, engines, starts| {
            Library::of(&effect_model, points, engines, starts, |_| false)
        });
        if data.flights.len() < FEWEST_FLIGHTS {
            let found = data.flights.len();
            return Err(DiagnoseError::TooFewFlights { found, needed: FEWEST_FLIGHTS });
        }
        let mut baseline = Self::prior(&data, &references);
        for _ in 0..ROUNDS {
            let effective = baseline.fit(&data)?;
            let before = baseline.parts.noise;
            baseline.measure_noise(&data, &effective);
            rescale(&mut data, &before, &baseline.parts.noise);
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
    pub fn remainder(&self, point: &EffectPoint, response: &Response) -> (f64, f64) {
        let mut terms = vec![0.0; self.remainder_terms()];
        self.write_remainder(point, response, &self.parts.references, &mut terms);
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

    pub(crate) const fn knows_deck(&self) -> bool {
        true
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
        1 + self.parts.hats.iter().map(|(_, hats)| hats.len()).sum::<usize>()
            + self.parts.products.len()
    }

    pub(crate) fn remainder_mean(&self, terms: &[f64]) -> f64 {
        terms.iter().zip(&self.parts.mean).map(|(term, mean)| term * mean).sum()
    }

    /// Writes the remainder's terms. The baseline's own references hold, whatever the caller's are.
    pub(crate) fn write_remainder(
        &self,
        point: &EffectPoint,
        response: &Response,
        _references: &EffectReferences,
        into: &mut [f64],
    ) {
        let value = |variable: Variable| {
            variable.value(point, response, &self.parts.references).unwrap_or(0.0)
        };
        into[0] = 1.0;
        let mut at = 1;
        for (variable, hats) in &self.parts.hats {
            hats.write(value(*variable), &mut into[at..at + hats.len()]);
            at += hats.len();
        }
        for (a, scaled_a, b, scaled_b) in &self.parts.products {
            into[at] = scaled_a.at(value(*a)) * scaled_b.at(value(*b));
            at += 1;
        }
    }

    /// The baseline before it has learnt.
    fn prior(data: &Data, references: &EffectReferences) -> Self {
        let values = |variable: Variable| -> Option<Vec<f64>> {
            data.segments
                .iter()
                .map(|row| variable.value(&row.point, &row.response, references))
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
        let terms = 1 + hats.iter().map(|(_, h): &(_, Hats)| h.len()).sum::<usize>() + products.len();
        let width = terms + data.channels.contrasts + DECK_TERMS;
        let parts = Parts {
            flights: data.flights.len(),
            segments: data.segments.len(),
            references: *references,
            noise: NoiseFactors::default(),
            hats,
            products,
            contrasts: data.channels.contrasts,
            deck_known: data.channels.n2,
            deck_centers: data.deck.centers,
            deck_coefficients: data.deck.coefficients.to_vec(),
            mean: vec![0.0; terms + data.channels.contrasts],
            factor: Vec::new(),
            rms: f64::NAN,
        };
        Self { parts, factor: Mat::zeros(width, width) }
    }

    fn prior_deviation(&self, index: usize) -> f64 {
        let terms = self.remainder_terms();
        let products = terms - self.parts.products.len();
        if index == 0 {
            LEVEL_DEVIATION
        } else if index < products {
            HAT_DEVIATION
        } else if index < terms {
            PRODUCT_DEVIATION
        } else if index < terms + self.parts.contrasts {
            SPLIT_DEVIATION
        } else {
            DECK_DEVIATION
        }
    }

    /// Posterior of all coefficients at the present noise; returns how many coefficients each channel kind spent.
    fn fit(&mut self, data: &Data) -> Result<[f64; 3], DiagnoseError> {
        let width = self.factor.nrows();
        let mut gram = Mat::<f64>::zeros(width + 1, width + 1);
        for flight in &data.flights {
            let segments = &data.segments[flight.segments.clone()];
            let channels = data.channels.count();
            let mut matrix = Mat::<f64>::zeros(segments.len() * channels, width + 1);
            for (index, row) in segments.iter().enumerate() {
                let raw = self.raw_row(data, row);
                for (column, values) in raw.iter().enumerate() {
                    let white = half_whitened(row, values, channels);
                    for channel in 0..channels {
                        matrix[(index * channels + channel, column)] = white[channel];
                    }
                }
            }
            whiten_flight(data, segments, &mut matrix);
            add_gram(&mut gram, &matrix);
        }
        symmetrize(&mut gram);
        let mut precision = Mat::from_fn(width, width, |i, j| gram[(i, j)]);
        for k in 0..width {
            let deviation = self.prior_deviation(k);
            precision[(k, k)] += 1.0 / (deviation * deviation);
        }
        let factor = Factor::of(precision).ok_or(DiagnoseError::Degenerate)?;
        let mut covariance = Mat::<f64>::identity(width, width);
        factor.solve(&mut covariance);
        let mut solution = Mat::from_fn(width, 1, |i, _| gram[(i, width)]);
        factor.solve(&mut solution);
        let terms = self.parts.mean.len();
        for k in 0..terms {
            self.parts.mean[k] = solution[(k, 0)];
        }
        for k in 0..DECK_TERMS {
            self.parts.deck_coefficients[k] = data.deck.coefficients[k] + solution[(terms + k, 0)];
        }
        let mut spent = [0.0; 3];
        let remainder = self.remainder_terms();
        for k in 0..width {
            let deviation = self.prior_deviation(k);
            let kind = if k < remainder { 0 } else if k < terms { 1 } else { 2 };
            spent[kind] += (1.0 - covariance[(k, k)] / (deviation * deviation)).clamp(0.0, 1.0);
        }
        // A covariance inverted in floating point may miss definiteness by rounding; a hair on the diagonal mends it.
        for k in 0..width {
            covariance[(k, k)] *= 1.0 + 1e-12;
        }
        let lower = Factor::of(covariance).ok_or(DiagnoseError::Degenerate)?;
        self.factor = lower.lower().to_owned();
        self.parts.factor =
            (0..width).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|ij| self.factor[ij]).collect();
        Ok(spent)
    }

    /// Raw values of every column and, last, the residual.
    fn raw_row(
        &self,
        data: &Data,
        row: &crate::data::SegmentRow,
    ) -> Vec<[f64; MAXIMUM_CHANNELS]> {
        let terms = self.remainder_terms();
        let mut remainder = vec![0.0; terms];
        self.write_remainder(&row.point, &row.response, &self.parts.references, &mut remainder);
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
        if let Some(last) = raw.last_mut() {
            *last = row.residual;
        }
        raw
    }

    /// Compares what is left with what the sensors announce, within and between flights, channel kind by channel kind.
    fn measure_noise(&mut self, data: &Data, spent: &[f64; 3]) {
        let width = self.factor.nrows();
        let coefficients: Vec<f64> = self
            .parts
            .mean
            .iter()
            .copied()
            .chain(
                (0..DECK_TERMS)
                    .map(|k| self.parts.deck_coefficients[k] - data.deck.coefficients[k]),
            )
            .collect();
        debug_assert_eq!(coefficients.len(), width);
        let channels = data.channels.count();
        let (mut within, mut announced_within) = ([0.0; 3], [0.0; 3]);
        let (mut between, mut announced_between) = ([0.0; 3], [0.0; 3]);
        let (mut rows, mut squares) = ([0.0; 3], 0.0);
        for flight in &data.flights {
            let segments = &data.segments[flight.segments.clone()];
            let left: Vec<[f64; MAXIMUM_CHANNELS]> = segments
                .iter()
                .map(|row| {
                    let raw = self.raw_row(data, row);
                    let mut left = row.residual;
                    for (coefficient, values) in coefficients.iter().zip(&raw) {
                        for channel in 0..channels {
                            left[channel] -= coefficient * values[channel];
                        }
                    }
                    left
                })
                .collect();
            let count = segments.len() as f64;
            for channel in 0..channels {
                if !segments.iter().all(|row| row.is_recorded[channel]) {
                    continue;
                }
                let kind = data.channels.kind(channel);
                let mean = left.iter().map(|e| e[channel]).sum::<f64>() / count;
                let own = |row: &crate::data::SegmentRow| -> f64 {
                    row.noise.factor[channel][..=channel].iter().map(|l| l * l).sum()
                };
                let announced: f64 = segments.iter().map(own).sum();
                within[kind] += left.iter().map(|e| (e[channel] - mean).powi(2)).sum::<f64>();
                announced_within[kind] += announced * (1.0 - 1.0 / count);
                between[kind] += mean * mean;
                // What the segments' own noise leaves in the mean is taken off below.
                between[kind] -= announced / (count * count);
                announced_between[kind] += segments
                    .iter()
                    .map(|row| row.noise.common.iter().map(|u| u[channel] * u[channel]).sum::<f64>())
                    .sum::<f64>()
                    / count;
                rows[kind] += count;
                if channel == 0 {
                    squares += left.iter().map(|e| e[0] * e[0]).sum::<f64>();
                }
            }
        }
        self.parts.rms = (squares / rows[0].max(1.0)).sqrt();
        let (low, high) = NOISE_LIMITS;
        for kind in 0..3 {
            if rows[kind] == 0.0 || announced_within[kind] <= 0.0 {
                continue;
            }
            // Coefficients that were fitted ate some of the scatter.
            let share = (1.0 - spent[kind] / rows[kind]).max(0.2);
            let ratio = (within[kind] / announced_within[kind] / share).sqrt();
            if ratio.is_finite() {
                let factor = &mut self.parts.noise.within[kind];
                *factor = (*factor * ratio).clamp(low, high);
            }
            if announced_between[kind] > 0.0 {
                let ratio = (between[kind] / announced_between[kind] / share).max(0.01).sqrt();
                let factor = &mut self.parts.noise.between[kind];
                *factor = (*factor * ratio).clamp(low, high);
            }
        }
    }
}

/// Rescales the noise of prepared segments from one set of factors to another.
fn rescale(data: &mut Data, from: &NoiseFactors, to: &NoiseFactors) {
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
            if found == expected { Ok(()) } else { Err(BaselineLengthError { quantity, found, expected }) }
        };
        let means = baseline.remainder_terms() + baseline.parts.contrasts;
        let width = means + DECK_TERMS;
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
