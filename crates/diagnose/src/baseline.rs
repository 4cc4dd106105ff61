//! What a model remembers of clean flights: how far its initial drag table is off, a smooth remainder, the N2 deck, the split
//! between engines, effects that the fleet shows at all times, and how large the noise is. One posterior over all of it.

use effects::{BetweenNodes, EffectReferences, Response, Variable};
use faer::Mat;
use flight::MAXIMUM_ENGINES;
use serde::{Deserialize, Serialize};

use crate::baseline::gauge_level::GaugeLevel;
use crate::baseline::layout::NuisanceLayout;
use crate::baseline::smooth::{LeftOfProcess, Smooth};
use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::priors::{
    DECK_DEVIATION, GUIDE_SHAPE_DEVIATION, PATH_FORCE_DEVIATION, REMAINDER_LEVEL_DEVIATION,
    REMAINDER_PRODUCT_DEVIATION, REMAINDER_SLOPE_DEVIATION, REMAINDER_SMOOTH_DEVIATION,
    TAUGHT_SPLIT_DEVIATION,
};
use crate::signals::n2_deck::{DECK_TERMS, Deck};
use crate::signals::noise::NoiseFactors;
use crate::signals::table_uncertainty::TableUncertainty;
use crate::signals::variables::flown;
use crate::thresholds::FARTHEST_PRODUCT;

pub(crate) mod gauge_level;
pub(crate) mod layout;
pub(crate) mod smooth;
pub(crate) mod standing_effects;

/// A learnt baseline.
#[derive(Clone, Debug, PartialEq)]
pub struct Baseline {
    pub(crate) parts: BaselineRecord,
    /// What was believed of the drag table before the flights; `None` where the table was taken as exact.
    pub(crate) table: Option<TableUncertainty>,
    pub(crate) factor: Mat<f64>,
    /// Whether it holds of another aircraft than that which flew.
    pub(crate) of_another: bool,
}

/// A baseline as it is written, to the same bits. With the prior of the drag table ([`Baseline::new`]) it is a baseline.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Baseline")]
pub struct BaselineRecord {
    pub(crate) flights: usize,
    pub(crate) segments: usize,
    pub(crate) references: EffectReferences,
    pub(crate) noise: NoiseFactors,
    /// Factors on the prior standard deviations of smooth functions and products.
    pub(crate) scales: [f64; 2],
    pub(crate) smooth: Vec<Smooth>,
    pub(crate) contrasts: usize,
    pub(crate) deck_known: bool,
    pub(crate) deck_centers: [f64; 4],
    pub(crate) deck_coefficients: Vec<f64>,
    /// Means of remainder terms and splits.
    pub(crate) mean: Vec<f64>,
    /// Nodes of the drag table from whose covariances its loadings are made.
    pub(crate) drag_nodes: Vec<usize>,
    /// Means of the loadings.
    pub(crate) drag: Vec<f64>,
    /// Lower triangle, row by row, of the Cholesky factor of the covariance of remainder terms, splits, deck, effects and
    /// loadings.
    pub(crate) factor: Vec<f64>,
    /// Sizes of the effects that the fleet shows at all times.
    pub(crate) standing_effects: Vec<f64>,
    /// What each of them was worth in ln fuel flow, on average over the flights that it was learnt from.
    pub(crate) standing_means: Vec<f64>,
    /// Variance of what each of them was worth in ln fuel flow; none in files of older programs.
    #[serde(default)]
    pub(crate) standing_variances: Vec<f64>,
    /// Whether the drag table was smooth between its nodes; it was not for older programs.
    #[serde(default)]
    pub(crate) smooth_table: bool,
    /// Whether the remainder has a term for the force along the path; it had none for older programs.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub(crate) path_force: bool,
    /// Share of the remainder that is thrust, so that N2 answers to it, and not fuel alone; 0 in files of older programs.
    #[serde(default)]
    pub(crate) thrust_share: f64,
    /// Segments that counted less than half.
    pub(crate) outliers: usize,
    /// Inequalities of physics that were in doubt and to which the coefficients are held.
    #[serde(default, skip_serializing_if = "is_none")]
    pub(crate) held_to_physics: usize,
    /// Those that flights speak against.
    #[serde(default, skip_serializing_if = "is_none")]
    pub(crate) against_physics: usize,
    /// Factor on stated standard deviations, by flights that were left out.
    pub(crate) interval_factor: f64,
    /// Remaining rms of ln fuel flow over the flights that it was learnt from.
    pub(crate) rms: f64,
    /// How tank gauges read; `None` where they are not recorded, and in files of older programs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) gauges: Option<GaugeLevel>,
}

impl BaselineRecord {
    /// Takes the longest list out of it, the factor of the covariance: for those who write it themselves.
    pub fn take_factor(&mut self) -> Vec<f64> {
        core::mem::take(&mut self.factor)
    }

    /// Whether every number is one that learning can have written: a file may have been changed by hand.
    fn check_values(&self) -> Result<(), BaselineError> {
        if self.contrasts > MAXIMUM_ENGINES {
            let (found, most) = (self.contrasts, MAXIMUM_ENGINES);
            return Err(BaselineError::TooMany { quantity: "contrasts of engines", found, most });
        }
        let expected_finite: [(&'static str, &[f64]); 8] = [
            ("means", &self.mean),
            ("loadings of the drag table", &self.drag),
            ("deck coefficients", &self.deck_coefficients),
            ("centers of the deck", &self.deck_centers),
            ("carried effects", &self.standing_effects),
            ("means of carried effects", &self.standing_means),
            ("covariance factor", &self.factor),
            ("share of the remainder that is thrust", core::slice::from_ref(&self.thrust_share)),
        ];
        for (quantity, numbers) in expected_finite {
            every(quantity, numbers, "a finite number", |_| true)?;
        }
        let noise = &self.noise;
        let factors = noise.within.iter().chain(&noise.between);
        every("noise factors", factors, "0 or more", |number| number >= 0.0)?;
        // A factor on a covariance: flights may show one of the other sign.
        let with_n2 = [&noise.fuel_flow_with_n2];
        every("factor on the covariance of fuel flow and N2", with_n2, "a finite number", |_| {
            true
        })?;
        let variances = &self.standing_variances;
        every("variances of carried effects", variances, "0 or more", |number| number >= 0.0)?;
        let positive = |number| number > 0.0;
        every("scales of smooth functions", &self.scales, "more than 0", positive)?;
        every("interval factor", [&self.interval_factor], "more than 0", positive)?;
        every("remaining rms", [&self.rms], "0 or more", |number| number >= 0.0)
    }

    /// Nodes of the drag table whose covariances its loadings need ([`TableUncertainty::pivots`]); none where the table was
    /// taken as exact.
    #[must_use]
    pub fn drag_nodes(&self) -> &[usize] {
        &self.drag_nodes
    }
}

/// Whether all numbers are finite and as they have to be.
fn every<'n>(
    quantity: &'static str,
    numbers: impl IntoIterator<Item = &'n f64>,
    expected: &'static str,
    may_be: impl Fn(f64) -> bool,
) -> Result<(), BaselineError> {
    let wrong = numbers.into_iter().find(|number| !(number.is_finite() && may_be(**number)));
    wrong.map_or(Ok(()), |&found| Err(BaselineError::Value { quantity, found, expected }))
}

/// Numbers that are not a baseline.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BaselineError {
    /// Numbers that are missing or left over.
    #[error("{quantity}: {found} numbers, expected {expected}")]
    Length {
        /// Of what.
        quantity: &'static str,
        /// How many there are.
        found: usize,
        /// How many there have to be.
        expected: usize,
    },
    /// A number that cannot be.
    #[error("{quantity}: found {found}, expected {expected}")]
    Value {
        /// Of what.
        quantity: &'static str,
        /// The number.
        found: f64,
        /// What it has to be.
        expected: &'static str,
    },
    /// More of something than any aircraft has.
    #[error("{quantity}: found {found}, expected at most {most}")]
    TooMany {
        /// Of what.
        quantity: &'static str,
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: usize,
    },
}

impl Baseline {
    /// A baseline that was written, with what was believed of the drag table before its flights.
    ///
    /// # Errors
    /// [`BaselineError`] where numbers are missing, left over, not finite or not positive where they have to be.
    pub fn new(
        parts: BaselineRecord,
        table: Option<TableUncertainty>,
    ) -> Result<Self, BaselineError> {
        parts.check_values()?;
        let mut baseline = Self { parts, table, factor: Mat::zeros(0, 0), of_another: false };
        baseline.scale_smooth();
        let layout = baseline.layout();
        let parts = &baseline.parts;
        let width = layout.len();
        for (quantity, found, expected) in [
            ("means", parts.mean.len(), layout.contrasts.end),
            ("deck coefficients", parts.deck_coefficients.len(), DECK_TERMS),
            ("carried effects", parts.standing_effects.len(), STANDING_EFFECTS.len()),
            ("means of carried effects", parts.standing_means.len(), STANDING_EFFECTS.len()),
            ("nodes of the drag table", parts.drag_nodes.len(), layout.drag.len()),
            ("loadings of the drag table", parts.drag.len(), layout.drag.len()),
            ("covariance factor", parts.factor.len(), width * (width + 1) / 2),
        ] {
            if found != expected {
                return Err(BaselineError::Length { quantity, found, expected });
            }
        }
        let mut factor = Mat::zeros(width, width);
        let mut values = parts.factor.iter();
        for i in 0..width {
            for j in 0..=i {
                factor[(i, j)] = values.next().copied().unwrap_or(0.0);
            }
        }
        baseline.factor = factor;
        Ok(baseline)
    }

    /// As it is written.
    #[must_use]
    pub const fn record(&self) -> &BaselineRecord {
        &self.parts
    }

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

    /// Factor on the standard deviations of predictions, by flights that did not teach them.
    #[must_use]
    pub const fn interval_factor(&self) -> f64 {
        self.parts.interval_factor
    }

    /// Segments that lie so far from the rest that they counted less than half.
    #[must_use]
    pub const fn outliers(&self) -> usize {
        self.parts.outliers
    }

    /// Whether it was asked how much of the force along the path shows in thrust; older programs took all of it.
    #[must_use]
    pub const fn has_path_force(&self) -> bool {
        self.parts.path_force
    }

    /// Inequalities of physics (fuel flow does not fall with mass, nor drag with Mach number in the drag rise) that were in doubt
    /// and to which it is held, and those that its flights speak against, which are left as flights have them.
    #[must_use]
    pub const fn physics(&self) -> (usize, usize) {
        (self.parts.held_to_physics, self.parts.against_physics)
    }

    /// Root mean square of ln fuel flow that it leaves over the flights that it was learnt from.
    #[must_use]
    pub const fn remaining_rms(&self) -> f64 {
        self.parts.rms
    }

    /// What of it holds of another aircraft of the type: all but how its tank gauges read, and how fast its engines turn at a thrust,
    /// which are another aircraft's own.
    #[must_use]
    pub fn of_another_aircraft(&self) -> Self {
        let parts = BaselineRecord { gauges: None, ..self.parts.clone() };
        Self { parts, of_another: true, ..self.clone() }
    }

    /// How tank gauges read against the flow meters in the flights that it was learnt from, where they are recorded.
    #[must_use]
    pub const fn gauges(&self) -> Option<&GaugeLevel> {
        self.parts.gauges.as_ref()
    }

    /// Mean of what of the force along the path shows beyond all of it.
    pub(crate) fn path_force(&self) -> f64 {
        if self.parts.path_force { self.parts.mean[self.products_end()] } else { 0.0 }
    }

    /// What the drag table is between its nodes where this is added to it.
    pub(crate) const fn between_nodes(&self) -> BetweenNodes {
        if self.parts.smooth_table { BetweenNodes::Smooth } else { BetweenNodes::Straight }
    }

    /// Mean of the remainder at a point.
    pub(crate) fn mean_at(&self, response: &Response) -> f64 {
        let mut terms = vec![0.0; self.remainder_terms()];
        self.write_remainder(response, &mut terms);
        self.remainder_mean(&terms)
    }

    /// Mean change of ln net thrust by what it has learnt of the drag table.
    pub(crate) fn drag_at(&self, response: &Response) -> f64 {
        let mut loadings = vec![0.0; self.parts.drag.len()];
        self.write_drag(response, &mut loadings);
        let drag: f64 = loadings.iter().zip(&self.parts.drag).map(|(l, mean)| l * mean).sum();
        response.drag_over_thrust * drag
    }

    /// Mean change of ln net thrust by all that it has learnt: drag, and the remainder's share that is thrust.
    pub(crate) fn thrust_at(&self, response: &Response) -> f64 {
        let drag = self.drag_at(response);
        let share = self.parts.thrust_share;
        // Files of older programs: to the same bits.
        if share == 0.0 { drag } else { drag + share * self.mean_at(response) }
    }

    pub(crate) const fn thrust_share(&self) -> f64 {
        self.parts.thrust_share
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
        let drag = self.table.as_ref().map_or(0, TableUncertainty::rank);
        NuisanceLayout::of_baseline(self.remainder_terms(), self.parts.contrasts, drag)
    }

    /// A level, each variable's slope and smooth function, a product of every pair, and the force along the path.
    pub(crate) fn remainder_terms(&self) -> usize {
        self.products_end() + usize::from(self.parts.path_force)
    }

    /// Where the terms of products end.
    pub(crate) fn products_end(&self) -> usize {
        let smooth = &self.parts.smooth;
        1 + smooth.iter().map(Smooth::len).sum::<usize>() + pairs(smooth.len())
    }

    pub(crate) fn remainder_mean(&self, terms: &[f64]) -> f64 {
        terms.iter().zip(&self.parts.mean).map(|(term, mean)| term * mean).sum()
    }

    /// Writes the remainder's terms at the state that was flown. The baseline's own references hold. Returns what they leave.
    pub(crate) fn write_remainder(&self, response: &Response, into: &mut [f64]) -> LeftOfSmooth {
        let smooth = &self.parts.smooth;
        let mut left = LeftOfSmooth::default();
        let mut at = 1;
        let mut scaled = Vec::with_capacity(smooth.len());
        into[0] = 1.0;
        for one in smooth {
            let value = flown(one.variable(), response, &self.parts.references);
            left.add(self.smooth_variance(), one.write(value, &mut into[at..at + one.len()]));
            scaled.push(one.at(value).clamp(-FARTHEST_PRODUCT, FARTHEST_PRODUCT));
            at += one.len();
        }
        for (k, a) in scaled.iter().enumerate() {
            for b in &scaled[k + 1..] {
                into[at] = a * b;
                at += 1;
            }
        }
        if self.parts.path_force {
            into[at] = 1.0 - response.drag_over_thrust;
        }
        left
    }

    /// Where a state lies along each smooth function, lengths.
    pub(crate) fn places(&self, response: &Response) -> impl Iterator<Item = f64> {
        let references = &self.parts.references;
        let smooth = self.parts.smooth.iter();
        smooth.map(move |one| one.at(flown(one.variable(), response, references)))
    }

    /// Variance of the mean over states of what the smooth functions' terms leave between their knots; `places` are the states'
    /// along each function.
    pub(crate) fn left_of_mean(&self, places: &[Vec<f64>]) -> f64 {
        let functions = self.parts.smooth.iter().zip(places);
        self.smooth_variance()
            * functions.map(|(one, places)| one.left_of_mean(places)).sum::<f64>()
    }

    /// Smooth functions of the remainder.
    pub(crate) const fn smooth_functions(&self) -> usize {
        self.parts.smooth.len()
    }

    /// How far each variable of the remainder lies beyond what was flown, in lengths, below it negative; 0 within it.
    pub(crate) fn beyond(&self, response: &Response) -> impl Iterator<Item = f64> {
        let references = &self.parts.references;
        self.parts
            .smooth
            .iter()
            .map(move |one| one.beyond(flown(one.variable(), response, references)))
    }

    /// Variance by which what is announced of a smooth function grows beyond what was flown, per cube of lengths.
    pub(crate) fn growth_beyond(&self, function: usize) -> f64 {
        let stated = self.interval_factor();
        stated * stated * self.parts.smooth[function].growth() * self.smooth_variance()
    }

    /// Whether a variable of the remainder lies beyond what was flown.
    pub(crate) fn is_beyond_flights(&self, response: &Response) -> bool {
        let of = |one: &Smooth| flown(one.variable(), response, &self.parts.references);
        self.parts.smooth.iter().any(|one| one.is_beyond(of(one)))
    }

    /// The smallest and the largest value of a variable that the learnt flights flew; `None` of a variable that the remainder is no
    /// function of.
    #[must_use]
    pub fn flown(&self, variable: Variable) -> Option<(f64, f64)> {
        self.parts.smooth.iter().find(|one| one.variable() == variable).map(Smooth::flown)
    }

    /// Share of what the smooth functions would grow by at these signed distances beyond what was flown that the guide leaves.
    pub(crate) fn left_by_guide(&self, distances: &[f64]) -> f64 {
        let (mut known, mut rest, mut all) = (0.0, 0.0, 0.0);
        for (one, distance) in self.parts.smooth.iter().zip(distances) {
            let growth = one.growth() * self.smooth_variance();
            let split = one.split_by_guide(*distance);
            known += growth * split.0.powi(3);
            rest += growth * split.1.powi(3);
            all += growth * distance.abs().powi(3);
        }
        if all > 0.0 { (within_guide(known) + rest) / all } else { 1.0 }
    }

    /// Tells the smooth functions how far the guide goes on below and above what was flown, lengths.
    pub(crate) fn set_reach_of_guide(&mut self, reaches: &[(f64, f64)]) {
        for (one, reach) in self.parts.smooth.iter_mut().zip(reaches) {
            one.set_reach_of_guide(*reach);
        }
    }

    /// Tells the smooth functions by how much flights have scaled them.
    pub(crate) fn scale_smooth(&mut self) {
        let [scale, _] = self.parts.scales;
        self.parts.smooth.iter_mut().for_each(|one| one.scale_by(scale));
    }

    /// Prior variance of one smooth function.
    pub(crate) fn smooth_variance(&self) -> f64 {
        (REMAINDER_SMOOTH_DEVIATION * self.parts.scales[0]).powi(2)
    }

    /// Writes the loadings of the drag table at the state that was flown.
    pub(crate) fn write_drag(&self, response: &Response, into: &mut [f64]) {
        if let Some(table) = &self.table {
            table.write(response, into);
        }
    }

    /// The same of a table that is smooth between its nodes.
    pub(crate) fn write_smooth_drag(&self, response: &Response, into: &mut [f64]) {
        if let Some(table) = &self.table {
            table.write_smooth(response, into);
        }
    }

    pub(crate) fn prior_deviation(&self, index: usize) -> f64 {
        let layout = self.layout();
        if index == 0 {
            REMAINDER_LEVEL_DEVIATION
        } else if layout.remainder.contains(&index) {
            self.remainder_deviation(index)
        } else if layout.contrasts.contains(&index) {
            TAUGHT_SPLIT_DEVIATION
        } else if layout.deck.contains(&index) {
            DECK_DEVIATION
        } else if layout.drag.contains(&index) {
            1.0
        } else {
            self.standing_effect_deviation(index - layout.standing_effects.start)
        }
    }

    /// Prior standard deviation of a term of the remainder but the level.
    fn remainder_deviation(&self, index: usize) -> f64 {
        let mut start = 1;
        for one in &self.parts.smooth {
            if index == start {
                return REMAINDER_SLOPE_DEVIATION;
            }
            start += one.len();
            if index < start {
                return REMAINDER_SMOOTH_DEVIATION * self.parts.scales[0];
            }
        }
        if index >= self.products_end() {
            return PATH_FORCE_DEVIATION;
        }
        REMAINDER_PRODUCT_DEVIATION * self.parts.scales[1]
    }

    /// Prior standard deviation of a carried effect, in its unit.
    fn standing_effect_deviation(&self, carried: usize) -> f64 {
        let effect = &STANDING_EFFECTS[carried];
        effect.deviation * self.parts.references.typical_size(effect.id)
    }
}

/// Variance of the smooth functions that their terms do not hold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LeftOfSmooth {
    /// Within what was flown, from knot to knot another.
    pub(crate) between_knots: f64,
    /// Where nothing was flown and the guide goes, before the guide is asked.
    within_guide: f64,
    /// Where it does not go either, in addition.
    beyond_guide: f64,
}

impl LeftOfSmooth {
    /// Adds a function's, of a process of this variance.
    pub(crate) const fn add(&mut self, variance: f64, left: LeftOfProcess) {
        self.between_knots += variance * left.between_knots;
        self.within_guide += variance * left.within_guide;
        self.beyond_guide += variance * left.beyond_guide;
    }

    /// Where nothing was flown.
    pub(crate) const fn beyond(self) -> f64 {
        within_guide(self.within_guide) + self.beyond_guide
    }

    /// All of it.
    pub(crate) const fn total(self) -> f64 {
        within_guide(self.between_knots + self.within_guide) + self.beyond_guide
    }
}

/// Variance of what nobody flew at a state of the guide, given that the guide is off there by no more than guides are.
///
/// ```text
/// v·s²/(v + s²),   s = 0.06 of fuel flow                                                  [baseline.12]
/// ```
pub(crate) const fn within_guide(variance: f64) -> f64 {
    const OF_GUIDE: f64 = GUIDE_SHAPE_DEVIATION * GUIDE_SHAPE_DEVIATION;
    variance * OF_GUIDE / (variance + OF_GUIDE)
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde asks")]
const fn is_none(count: &usize) -> bool {
    *count == 0
}

const fn pairs(of: usize) -> usize {
    of * of.saturating_sub(1) / 2
}

/// Lower triangle, row by row.
pub(crate) fn lower_triangle(matrix: &Mat<f64>) -> Vec<f64> {
    (0..matrix.nrows()).flat_map(|i| (0..=i).map(move |j| matrix[(i, j)])).collect()
}
