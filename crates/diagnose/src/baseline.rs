//! What a model remembers of clean flights in addition to its table: a smooth remainder, the N2 deck, the split between engines,
//! and how large the noise is. Each with its covariance.

use effects::{EffectReferences, Response};
use faer::Mat;
use serde::{Deserialize, Serialize};

use crate::baseline::layout::NuisanceLayout;
use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::priors::{
    DECK_DEVIATION, REMAINDER_HAT_DEVIATION, REMAINDER_LEVEL_DEVIATION,
    REMAINDER_PRODUCT_DEVIATION, TAUGHT_SPLIT_DEVIATION,
};
use crate::signals::n2_deck::{DECK_TERMS, Deck};
use crate::signals::noise::NoiseFactors;
use crate::signals::variables::{Hats, Scaled, Variable};
use crate::thresholds::INFORMED_SHARE;

pub(crate) mod layout;
pub(crate) mod standing_effects;

/// Effects that the first model files with a baseline carried.
const FIRST_CARRIED: usize = 3;

/// A learnt baseline. Reads and writes with serde, to the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Parts", into = "Parts")]
pub struct Baseline {
    pub(crate) parts: Parts,
    pub(crate) factor: Mat<f64>,
}

/// A baseline as it is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Baseline")]
pub(crate) struct Parts {
    pub(crate) flights: usize,
    pub(crate) segments: usize,
    pub(crate) references: EffectReferences,
    pub(crate) noise: NoiseFactors,
    /// Factors on the prior standard deviations of hat functions and products.
    pub(crate) scales: [f64; 2],
    pub(crate) hats: Vec<(Variable, Hats)>,
    pub(crate) products: Vec<(Variable, Scaled, Variable, Scaled)>,
    /// Variables that the remainder may bend along differently at each Mach number.
    pub(crate) local: Vec<(Variable, Scaled)>,
    pub(crate) contrasts: usize,
    pub(crate) deck_known: bool,
    pub(crate) deck_centers: [f64; 4],
    pub(crate) deck_coefficients: Vec<f64>,
    /// Means of remainder terms and splits.
    pub(crate) mean: Vec<f64>,
    /// Lower triangle, row by row, of the Cholesky factor of the covariance of remainder terms, splits and deck.
    pub(crate) factor: Vec<f64>,
    /// Sizes of the effects that the fleet shows at all times.
    #[serde(rename = "environment")]
    pub(crate) standing_effects: Vec<f64>,
    /// Remaining rms of ln fuel flow over the flights that it was learnt from.
    pub(crate) rms: f64,
}

/// Numbers that are not a baseline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{quantity}: {found} numbers, expected {expected}")]
pub struct BaselineLengthError {
    quantity: &'static str,
    found: usize,
    expected: usize,
}

impl Baseline {
    /// Factors on the sensors' standard deviations.
    #[must_use]
    pub const fn noise(&self) -> &NoiseFactors {
        &self.parts.noise
    }

    /// The conditions that effects are zero at: the mean over the flights that it was learnt from.
    #[must_use]
    pub const fn references(&self) -> &EffectReferences {
        &self.parts.references
    }

    /// Numbers of flights and segments that it was learnt from.
    #[must_use]
    pub const fn taught_by(&self) -> (usize, usize) {
        (self.parts.flights, self.parts.segments)
    }

    /// Root mean square of ln fuel flow that it leaves over the flights that it was learnt from.
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

    /// Sizes of effects that its fleet shows at all times, each in its unit: local gravity, rotating Earth and
    /// isobaric slope, load factor, trim drag with the center of gravity, drag of a low wing, anti-ice bleed, and drag rise
    /// about three Mach numbers.
    #[must_use]
    pub const fn standing_effects(&self) -> &[f64] {
        self.parts.standing_effects.as_slice()
    }

    pub(crate) const fn contrasts(&self) -> usize {
        self.parts.contrasts
    }

    pub(crate) fn split_mean(&self, contrast: usize) -> f64 {
        self.parts.mean[self.layout().contrasts.start + contrast - 1]
    }

    pub(crate) const fn factor(&self) -> &Mat<f64> {
        &self.factor
    }

    pub(crate) fn deck(&self) -> Option<Deck> {
        let mut coefficients = [0.0; DECK_TERMS];
        coefficients.copy_from_slice(self.parts.deck_coefficients.get(..DECK_TERMS)?);
        self.parts.deck_known.then_some(Deck { centers: self.parts.deck_centers, coefficients })
    }

    /// Which of its coefficients is what.
    pub(crate) fn layout(&self) -> NuisanceLayout {
        NuisanceLayout::of_baseline(self.remainder_terms(), self.parts.contrasts)
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

    pub(crate) fn prior_deviation(&self, index: usize) -> f64 {
        let layout = self.layout();
        let products = 1 + self.parts.hats.iter().map(|(_, hats)| hats.len() + 2).sum::<usize>();
        if index == 0 {
            REMAINDER_LEVEL_DEVIATION
        } else if index < products {
            REMAINDER_HAT_DEVIATION * self.parts.scales[0]
        } else if layout.remainder.contains(&index) {
            REMAINDER_PRODUCT_DEVIATION * self.parts.scales[1]
        } else if layout.contrasts.contains(&index) {
            TAUGHT_SPLIT_DEVIATION
        } else if layout.deck.contains(&index) {
            DECK_DEVIATION
        } else {
            self.standing_effect_deviation(index - layout.standing_effects.start)
        }
    }

    /// Prior standard deviation of a carried effect, in its unit.
    fn standing_effect_deviation(&self, carried: usize) -> f64 {
        let effect = &STANDING_EFFECTS[carried];
        effect.deviation * self.parts.references.typical_size(effect.id)
    }
}

/// Lower triangle, row by row.
pub(crate) fn lower_triangle(matrix: &Mat<f64>) -> Vec<f64> {
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
        let layout = baseline.layout();
        check("means", baseline.parts.mean.len(), layout.contrasts.end)?;
        check("deck coefficients", baseline.parts.deck_coefficients.len(), DECK_TERMS)?;
        let carried = baseline.parts.standing_effects.len();
        if carried != FIRST_CARRIED {
            check("carried effects", carried, STANDING_EFFECTS.len())?;
        }
        let known = layout.standing_effects.start + carried;
        check("covariance factor", baseline.parts.factor.len(), known * (known + 1) / 2)?;
        let mut factor = Mat::zeros(layout.len(), layout.len());
        let mut values = baseline.parts.factor.iter();
        for i in 0..known {
            for j in 0..=i {
                factor[(i, j)] = values.next().copied().unwrap_or(0.0);
            }
        }
        // An older file holds no effect that was added since: the prior of those remains.
        for k in carried..STANDING_EFFECTS.len() {
            let deviation = baseline.standing_effect_deviation(k);
            let column = layout.standing_effects.start + k;
            factor[(column, column)] = deviation;
            baseline.parts.standing_effects.push(0.0);
        }
        if known < layout.len() {
            baseline.parts.factor = lower_triangle(&factor);
        }
        baseline.factor = factor;
        Ok(baseline)
    }
}
