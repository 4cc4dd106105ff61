//! The place of what is named: where the gap of the named effect is largest, along a variable that drives it.
//!
//! Steps over regions see fuel flow alone. A name is found in all channels and against all that is uncertain about the model, so
//! that it may be certain where no step stands out.

use effects::{Form, Variable};

use crate::output::Slice;
use crate::output::form::FoundForm;
use crate::output::region::{Condition, Edge};
use crate::place::binned_variable::{BinnedVariable, places};
use crate::place::regions::{BinnedRegion, intervals};
use crate::place::told::{Told, gaps};
use crate::residuals::rows::SegmentRow;
use crate::search::system::WhitenedSystem;
use crate::thresholds::{
    FEWEST_FLIGHTS_OF_A_REGION, LEAST_OF_A_FORM, LEVEL_LIKE, REGION_P_VALUE, REGION_SHARES,
    SMALLEST_GAP_PERCENT,
};

/// Falls of squares that differ by less are of one place and its complement.
const EQUAL: f64 = 1e-6;

/// What the verdict names, as its place is found.
#[derive(Clone, Debug)]
pub(crate) struct NamedGap {
    /// What it makes of ln fuel flow, segment by segment.
    pub(crate) gap: Vec<f64>,
    /// Variables that drive it, each with the probability that nothing acts which the variable drives.
    pub(crate) drivers: Vec<(Variable, f64)>,
}

/// How well a step over a region fits the gap of what is named.
struct Fit {
    region: BinnedRegion,
    members: Vec<usize>,
    fall: f64,
    /// Mean of the gap that was recorded there, whatever its sign.
    size: f64,
    p_value: f64,
}

impl NamedGap {
    /// The same of the form that describes a gap best, where it surely closes more than half of it on unseen flights: driven by its
    /// variable, but for the probability of forms over others. `None` for a level and for a product.
    pub(crate) fn of_forms(forms: &[FoundForm], system: &WhitenedSystem<'_>) -> Option<Self> {
        let best = forms.first()?;
        best.closure.filter(|closure| closure.is_surely_more_than(LEAST_OF_A_FORM))?;
        if matches!(best.form, Form::Offset | Form::Product { .. }) {
            return None;
        }
        let value = |row: &SegmentRow| {
            let x = best.variable.value(&row.point, &row.response, system.design.references())?;
            Some(best.form.value(x, best.scale, 0.0))
        };
        let mut gap = system.data.segments.iter().map(value).collect::<Option<Vec<f64>>>()?;
        // Of drag or of fuel flow: as much as it makes of fuel flow.
        let square = gap.iter().map(|shape| shape * shape).sum::<f64>() / gap.len().max(1) as f64;
        let size = (0.01 * best.rms_percent / square.sqrt()).copysign(best.size);
        for value in &mut gap {
            *value *= size;
        }
        let of_variable = forms.iter().filter(|form| form.variable == best.variable);
        let certain: f64 = of_variable.map(|form| form.probability).sum();
        Some(Self { gap, drivers: vec![(best.variable, (1.0 - certain).max(0.0))] })
    }

    /// The region of one driving variable over which a step fits the gap of what is named best, of regions that fit alike the one
    /// with the larger gap; its p-value is the probability that nothing acts which the variable drives. `None` where that is too
    /// large for every variable, and where the gap of what is named is nearly the same everywhere.
    ///
    /// ```text
    /// max (Σ_{i in place} (g_i − ḡ))²/(n(1 − n/N)),   g what the named effect makes                        [diagnosis.56]
    /// ```
    pub(crate) fn place(
        &self,
        system: &WhitenedSystem<'_>,
        variances: &[f64],
        seed: u64,
    ) -> Option<Slice> {
        if self.variance() < (SMALLEST_GAP_PERCENT / 100.0).powi(2) {
            return None;
        }
        let places = places(&system.data.segments, system.design.references());
        let gaps = gaps(system);
        let told = Told { system, places: &places, gaps: &gaps, variances };
        if let Some(place) = self.of_step(&told, seed) {
            return Some(place);
        }
        let mut best: Option<Fit> = None;
        for (driver, p_value) in self.drivers.iter().filter(|(_, p)| *p <= REGION_P_VALUE) {
            let of_driver = |place: &BinnedVariable| place.variable() == *driver;
            let Some(place) = places.iter().position(of_driver) else { continue };
            for bins in intervals(places[place].count(), true) {
                let region = BinnedRegion::of_bins(place, bins);
                let fit = self.fit(region, *p_value, &told);
                let Some(fit) = fit else { continue };
                if best.as_ref().is_none_or(|best| fit.is_better_than(best)) {
                    best = Some(fit);
                }
            }
        }
        best.map(|best| told.slice(&best.region, &best.members, best.p_value, seed))
    }

    /// The first segment of a gap that begins on a date: nothing before it, something from then on.
    pub(crate) fn step(&self) -> Option<usize> {
        let from = self.gap.iter().position(|gap| *gap != 0.0).filter(|from| *from > 0)?;
        self.gap[from..].iter().all(|gap| *gap != 0.0).then_some(from)
    }

    /// The segments from a step on, where the date is sure enough; flights are in order.
    fn of_step(&self, told: &Told<'_>, seed: u64) -> Option<Slice> {
        let from = self.step()?;
        let of_date =
            |(driver, p): &&(Variable, f64)| *driver == Variable::Date && *p <= REGION_P_VALUE;
        let (_, p_value) = *self.drivers.iter().find(of_date)?;
        let segments = &told.system.data.segments;
        let (before, first) = (segments[from - 1].point.date_s, segments[from].point.date_s);
        let members: Vec<usize> = (from..self.gap.len()).collect();
        if before >= first || told.flights_of(&members) < FEWEST_FLIGHTS_OF_A_REGION {
            return None;
        }
        let edge = Edge { value: first, flown_below: before };
        let condition = Condition { variable: Variable::Date, from: Some(edge), to: None };
        Some(told.slice_of((None, vec![condition]), &members, p_value, seed))
    }

    /// Whether it has nearly the same sign and size everywhere: its mean exceeds its standard deviation.
    pub(crate) fn is_level(&self) -> bool {
        self.mean().powi(2) > LEVEL_LIKE * LEVEL_LIKE * self.variance()
    }

    /// The variables that drive it, however sure they are.
    pub(crate) fn variables(&self) -> Vec<Variable> {
        self.drivers.iter().map(|(variable, _)| *variable).collect()
    }

    fn mean(&self) -> f64 {
        self.gap.iter().sum::<f64>() / self.gap.len().max(1) as f64
    }

    fn variance(&self) -> f64 {
        let mean = self.mean();
        let squares = self.gap.iter().map(|gap| (gap - mean).powi(2));
        squares.sum::<f64>() / self.gap.len().max(1) as f64
    }

    /// `None` for a region that holds too few or too many segments, or too few flights.
    fn fit(&self, region: BinnedRegion, p_value: f64, told: &Told<'_>) -> Option<Fit> {
        let all = self.gap.len();
        let members: Vec<usize> = (0..all).filter(|&k| region.holds(told.places, k)).collect();
        let share = members.len() as f64 / all as f64;
        if !(REGION_SHARES[0]..=REGION_SHARES[1]).contains(&share)
            || told.flights_of(&members) < FEWEST_FLIGHTS_OF_A_REGION
        {
            return None;
        }
        let mean = self.mean();
        let sum: f64 = members.iter().map(|&k| self.gap[k] - mean).sum();
        let fall = sum * sum / (members.len() as f64 * (1.0 - share));
        let size = told.mean(&region, &members).abs();
        Some(Fit { region, members, fall, size, p_value })
    }
}

impl Fit {
    fn is_better_than(&self, other: &Self) -> bool {
        self.fall > other.fall * (1.0 + EQUAL)
            || (self.fall >= other.fall * (1.0 - EQUAL) && self.size > other.size)
    }
}
