//! What a model remembers of clean flights beside its table: a smooth remainder, the N2 deck, the split between engines,
//! and how large the noise is. Each with its covariance.

use effects::ExtendedModel;
use effects::{EffectModel, EffectReferences, Response};
use faer::Mat;
use serde::{Deserialize, Serialize};

use crate::DiagnoseError;
use crate::data::{Against, Data, ENVIRONMENT};
use crate::deck::{DECK_TERMS, Deck};
use crate::library::Library;
use crate::noise::{MAXIMUM_CHANNELS, NoiseFactors};
use crate::record::FlightRecord;
use crate::variables::{Hats, Scaled, Variable};

mod learning;
mod moments;

use moments::Moments;

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
/// Folds of flights that the scatter between flights is judged on, and rounds of it.
const FOLDS: usize = 10;
const INFLATIONS: usize = 3;
/// Effects that the first model files with a baseline carried.
const FIRST_CARRIED: usize = 3;
/// Share of the prior variance that is left where flown data informed the remainder.
const INFORMED_SHARE: f64 = 0.25;
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
    /// Sizes of the effects that the fleet shows at all times.
    environment: Vec<f64>,
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
        model: &ExtendedModel,
        drag_table: &lut::Table,
        flights: &[FlightRecord<'_>],
    ) -> Result<Self, DiagnoseError> {
        let references = crate::references_of(model, drag_table, flights)?;
        let effect_model = EffectModel::new(model, drag_table, references)?;
        let (data, _) = Data::prepare(
            &effect_model,
            flights,
            Against::NothingYet,
            |points, engines, starts| {
                Library::of(&effect_model, points, engines, starts, |_| false)
            },
        );
        if data.flights.len() < FEWEST_FLIGHTS {
            let found = data.flights.len();
            return Err(DiagnoseError::TooFewFlights { found, needed: FEWEST_FLIGHTS });
        }
        let mut baseline = Self::prior(&data, &references);
        let moments = Moments::of(&baseline, &data);
        baseline.tune(&moments);
        for _ in 0..INFLATIONS {
            baseline.inflate(&moments);
        }
        baseline.fit(&data, &moments)?;
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

    /// The same where flown data informed it; `None` elsewhere, where the mean is hardly more than the prior's.
    ///
    /// Informed is a point that lies inside the range flown of each variable, and at which the remainder's variance is at
    /// most a quarter of what it was before anything was flown. The level, which any flight informs, does not count in the
    /// latter.
    #[must_use]
    pub fn known_remainder(&self, response: &Response) -> Option<(f64, f64)> {
        let inside = self.parts.hats.iter().all(|(variable, hats)| {
            let value = variable.flown(response, &self.parts.references);
            hats.beyond(value).iter().all(|distance| *distance <= 0.0)
        });
        let mut terms = vec![0.0; self.remainder_terms()];
        self.write_remainder(response, &mut terms);
        let prior: f64 = terms
            .iter()
            .enumerate()
            .skip(1)
            .map(|(index, term)| (term * self.prior_deviation(index)).powi(2))
            .sum();
        let (mean, deviation) = self.remainder(response);
        (inside && deviation * deviation <= INFORMED_SHARE * prior).then_some((mean, deviation))
    }

    /// Mean of the remainder at a point.
    pub(crate) fn mean_at(&self, response: &Response) -> f64 {
        let mut terms = vec![0.0; self.remainder_terms()];
        self.write_remainder(response, &mut terms);
        self.remainder_mean(&terms)
    }

    /// Sizes of effects that the fleet that taught it shows at all times, each in its unit: local gravity, rotating Earth and
    /// isobaric slope, load factor, trim drag with the center of gravity, drag of a low wing, anti-ice bleed, and drag rise
    /// about three Mach numbers.
    #[must_use]
    pub const fn environment(&self) -> &[f64] {
        self.parts.environment.as_slice()
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
            environment: vec![0.0; ENVIRONMENT.len()],
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
            self.carried_deviation(index + ENVIRONMENT.len() - self.factor.nrows())
        }
    }

    /// Prior standard deviation of a carried effect, in its unit.
    fn carried_deviation(&self, carried: usize) -> f64 {
        let effect = &ENVIRONMENT[carried];
        effect.deviation * self.parts.references.typical_size(effect.id)
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
}

/// Lower triangle, row by row.
fn lower_triangle(matrix: &Mat<f64>) -> Vec<f64> {
    (0..matrix.nrows()).flat_map(|i| (0..=i).map(move |j| matrix[(i, j)])).collect()
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
        let carried = baseline.parts.environment.len();
        if carried != FIRST_CARRIED {
            check("carried effects", carried, ENVIRONMENT.len())?;
        }
        let known = means + DECK_TERMS + carried;
        check("covariance factor", baseline.parts.factor.len(), known * (known + 1) / 2)?;
        let mut factor = Mat::zeros(width, width);
        let mut values = baseline.parts.factor.iter();
        for i in 0..known {
            for j in 0..=i {
                factor[(i, j)] = values.next().copied().unwrap_or(0.0);
            }
        }
        // An older file was taught nothing of the effects that were added since: their prior stands.
        for k in carried..ENVIRONMENT.len() {
            let deviation = baseline.carried_deviation(k);
            factor[(means + DECK_TERMS + k, means + DECK_TERMS + k)] = deviation;
            baseline.parts.environment.push(0.0);
        }
        if known < width {
            baseline.parts.factor = lower_triangle(&factor);
        }
        baseline.factor = factor;
        Ok(baseline)
    }
}
