//! What is learnt is held to the guide where nobody flew: a guide is some per cent off, and not by a sixth at the end of its range.
//!
//! Slopes that flights have shown go on beyond what was flown. Those of Mach number, lift coefficient, thrust and mass make up for each
//! other as long as these rise and fall together, which they do among the flights and not beyond.

use effects::{EffectModel, Response, Variable};
use faer::Mat;
use lut::Outside;
use perf_model::model::NODE_WEIGHT_THRESHOLD;
use units::{PressureAltitude, TemperatureDifference};

use crate::baseline::Baseline;
use crate::learning::physical::{Conditions, Mesh, mesh};
use crate::math::cholesky::Cholesky;
use crate::math::integrated_wiener;
use crate::math::linear::{subtract_gram, symmetrize};
use crate::priors::{GUIDE_SHAPE_DEVIATION, GUIDE_SHAPE_LIFT, GUIDE_SHAPE_MACH};
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::signals::table_uncertainty::{GuideStates, TableUncertainty};
use crate::signals::variables::flown;
use crate::thresholds::{MASSES_BEYOND, PHYSICAL_LIFT_STEP, PHYSICAL_MACH_STEP};

/// Levels at which a state of the guide is asked, from its lowest to its highest: another level is another mass.
const LEVELS: u32 = 8;
/// Share of a state's variance that keeps the matrix of many near ones positive definite.
const JITTER: f64 = 1e-3;

/// How far what is learnt departs from the guide over the guide's range, less what it does at the mean of the flights: slopes along the
/// coefficients, and how far they are believed to be from zero.
///
/// ```text
/// g_i = f(CL_i, M_i) − f(CL̄, M̄) ~ N(0, C),   C = s²·exp(−½(ΔCL/0.1)² − ½(ΔM/0.03)²)                    [baseline.10]
/// ```
///
/// f is the mean over the guide's levels at which its masses are flown: how far it is off is asked over both alone. What the
/// coefficients do not hold of f, where nothing was flown, is added to C: the smooth functions' processes, and the nodes' own.
pub(super) struct Guide {
    departures: Vec<Departure>,
    /// How far the guide goes on below and above what was flown, for each smooth function; lengths.
    reaches: Vec<(f64, f64)>,
    width: usize,
}

impl Guide {
    /// Of the range that a model's guide informs; nothing where its table is taken as exact.
    pub(super) fn of(
        model: &EffectModel<'_>,
        baseline: &Baseline,
        data: &PreparedFlights<'_>,
        extrapolated: &[bool],
    ) -> Self {
        let (departures, reaches) =
            baseline.table.as_ref().map_or_else(Default::default, |table| {
                let of_states = Departures::new(model, baseline, data, table);
                let all = of_states.over_range(extrapolated);
                let reaches = reaches(&all, baseline.smooth_functions());
                (all.into_iter().filter(|one| of_states.is_unflown(one)).collect(), reaches)
            });
        Self { departures, reaches, width: baseline.layout().len() }
    }

    /// How far the guide goes on below and above what was flown, for each smooth function; lengths.
    pub(super) fn reaches(&self) -> &[(f64, f64)] {
        &self.reaches
    }

    /// Holds coefficients, in units of these deviations, to it.
    ///
    /// ```text
    /// S = AVAᵀ + C,   m ← m − VAᵀS⁻¹Am,   V ← V − VAᵀS⁻¹AV
    /// ```
    pub(super) fn hold(
        &self,
        baseline: &Baseline,
        mean: &mut [f64],
        covariance: &mut Mat<f64>,
        deviations: &[f64],
    ) {
        let (count, width) = (self.departures.len(), self.width);
        if count == 0 {
            return;
        }
        let rows = Mat::from_fn(count, width, |k, j| self.departures[k].slopes[j] * deviations[j]);
        let mut spread = &rows * &*covariance;
        let stated = &spread * rows.transpose() + self.covariance(baseline);
        let Some(root) = Cholesky::new(&stated) else { return };
        let along = |k: usize| (0..width).map(|j| rows[(k, j)] * mean[j]).sum::<f64>();
        let mut off = Mat::from_fn(count, 1, |k, _| -along(k));
        root.solve(&mut off);
        for (j, value) in mean.iter_mut().enumerate() {
            *value += (0..count).map(|k| spread[(k, j)] * off[(k, 0)]).sum::<f64>();
        }
        root.solve_lower(&mut spread);
        subtract_gram(covariance, &spread.transpose().to_owned());
        symmetrize(covariance);
    }

    /// Of what is believed of departures, and of what no coefficient holds of them.
    fn covariance(&self, baseline: &Baseline) -> Mat<f64> {
        let growths: Vec<f64> =
            (0..baseline.smooth_functions()).map(|k| baseline.growth_beyond(k)).collect();
        let left_by_guide = |one: &Departure| {
            one.beyond.iter().map(|at| baseline.left_by_guide(at).sqrt()).collect()
        };
        let left: Vec<Vec<f64>> = self.departures.iter().map(left_by_guide).collect();
        Mat::from_fn(self.departures.len(), self.departures.len(), |a, b| {
            let (one, other) = (&self.departures[a], &self.departures[b]);
            let lengths = (one.place.0 - other.place.0) / GUIDE_SHAPE_LIFT;
            let machs = (one.place.1 - other.place.1) / GUIDE_SHAPE_MACH;
            let shape = (-0.5 * (lengths * lengths + machs * machs)).exp();
            let own = if a == b { JITTER } else { 0.0 };
            let unflown = unflown((one, &left[a]), (other, &left[b]), &growths);
            let of_node = if a == b { one.left } else { 0.0 };
            GUIDE_SHAPE_DEVIATION.powi(2) * (shape + own) + unflown + of_node
        })
    }
}

/// Covariance of what no coefficient holds of the means of two states, each over its levels; with each the roots of what the guide
/// leaves of it.
fn unflown(
    (one, of_one): (&Departure, &[f64]),
    (other, of_other): (&Departure, &[f64]),
    growths: &[f64],
) -> f64 {
    let mut sum = 0.0;
    for (near, left_near) in one.beyond.iter().zip(of_one) {
        for (far, left_far) in other.beyond.iter().zip(of_other) {
            let functions = near.iter().zip(far).zip(growths);
            let of = |((near, far), growth): ((&f64, &f64), &f64)| {
                growth * integrated_wiener::covariance(*near, *far)
            };
            sum += left_near * left_far * functions.map(of).sum::<f64>();
        }
    }
    sum / (one.beyond.len() * other.beyond.len()) as f64
}

/// How far states go on below and above what was flown, for each smooth function; lengths.
fn reaches(states: &[Departure], functions: usize) -> Vec<(f64, f64)> {
    let mut found = vec![(0.0_f64, 0.0_f64); functions];
    for distances in states.iter().flat_map(|state| &state.beyond) {
        for ((below, above), distance) in found.iter_mut().zip(distances) {
            *below = below.max(-distance);
            *above = above.max(*distance);
        }
    }
    found
}

/// A departure from the guide.
struct Departure {
    /// Lift coefficient and Mach number.
    place: (f64, f64),
    /// Along the coefficients.
    slopes: Vec<f64>,
    /// At each of the levels, how far each variable of the remainder lies beyond what was flown, signed lengths.
    beyond: Vec<Vec<f64>>,
    /// Variance of the table's nodes that no coefficient holds.
    left: f64,
}

/// What departures from a guide are made from.
struct Departures<'a, 'm> {
    model: &'a EffectModel<'m>,
    baseline: &'a Baseline,
    states: Mesh<'a, 'm>,
    /// At each level.
    conditions: Vec<Conditions>,
    /// Mean lift coefficient and Mach number of the flights.
    middle: (f64, f64),
}

impl<'a, 'm> Departures<'a, 'm> {
    fn new(
        model: &'a EffectModel<'m>,
        baseline: &'a Baseline,
        data: &'a PreparedFlights<'m>,
        table: &TableUncertainty,
    ) -> Self {
        let values = |variable| {
            let of = move |row: &SegmentRow| flown(variable, &row.response, baseline.references());
            data.segments.iter().map(of)
        };
        let mean = |variable| values(variable).sum::<f64>() / data.segments.len().max(1) as f64;
        let range = |variable| {
            values(variable).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            })
        };
        let flown_states = || {
            let (low, high) = range(Variable::Mass);
            GuideStates {
                masses_kg: (low * (1.0 - MASSES_BEYOND), high * (1.0 + MASSES_BEYOND)),
                pressure_altitudes_m: range(Variable::PressureAltitude),
            }
        };
        let guide = table.guide().unwrap_or_else(flown_states);
        let (lowest_m, highest_m) = guide.pressure_altitudes_m;
        let level_m =
            |k: u32| lowest_m + f64::from(k) / f64::from(LEVELS - 1) * (highest_m - lowest_m);
        let at_level = |k| Conditions {
            altitude: PressureAltitude::meters(level_m(k)),
            isa_deviation: TemperatureDifference::kelvin(mean(Variable::IsaDeviation)),
            masses_kg: guide.masses_kg.0..=guide.masses_kg.1,
        };
        Self {
            model,
            baseline,
            states: Mesh::new(model, baseline, data),
            conditions: (0..LEVELS).map(at_level).collect(),
            middle: (mean(Variable::LiftCoefficient), mean(Variable::Mach)),
        }
    }

    fn over_range(&self, extrapolated: &[bool]) -> Vec<Departure> {
        let grid = self.model.drag_table().grid();
        let Some(middle) = self.departure(self.middle) else { return Vec::new() };
        let informs = |(lift, mach): &(f64, f64)| {
            grid.locate(*lift, *mach, Outside::Error).is_ok_and(|cell| {
                let parts = cell.nodes().into_iter().zip(cell.weights());
                let mut parts = parts.filter(|(_, weight)| *weight > NODE_WEIGHT_THRESHOLD);
                parts.all(|(node, _)| !extrapolated[node])
            })
        };
        let machs = mesh(grid.y().first(), grid.y().last(), PHYSICAL_MACH_STEP);
        let lifts = mesh(grid.x().first(), grid.x().last(), PHYSICAL_LIFT_STEP);
        let places = lifts.iter().flat_map(|lift| machs.iter().map(|mach| (*lift, *mach)));
        let of_place = |place: (f64, f64)| {
            let mut found = self.departure(place)?;
            for (here, there) in found.slopes.iter_mut().zip(&middle.slopes) {
                *here -= there;
            }
            Some(found)
        };
        places.filter(informs).filter_map(of_place).collect()
    }

    /// Whether Mach number, lift coefficient or thrust lies beyond what was flown: elsewhere flights say what the aircraft does.
    fn is_unflown(&self, departure: &Departure) -> bool {
        const OF_DRAG: [Variable; 3] =
            [Variable::Mach, Variable::LiftCoefficient, Variable::CorrectedThrust];
        let of_drag =
            |function: usize| OF_DRAG.contains(&self.baseline.parts.smooth[function].variable());
        let is_beyond = |distances: &Vec<f64>| {
            let mut distances = distances.iter().enumerate();
            distances.any(|(function, distance)| of_drag(function) && *distance != 0.0)
        };
        departure.beyond.iter().all(is_beyond)
    }

    /// Mean over the guide's levels; `None` where it has none there.
    fn departure(&self, place: (f64, f64)) -> Option<Departure> {
        let at =
            |level: &Conditions| self.states.slopes(&level.point(self.model, place.0, place.1)?);
        let found: Vec<(Vec<f64>, Response)> = self.conditions.iter().filter_map(at).collect();
        let (first, count) = (found.first()?, found.len() as f64);
        let mut mean = Departure {
            place,
            slopes: vec![0.0; first.0.len()],
            beyond: Vec::with_capacity(found.len()),
            left: 0.0,
        };
        let table = self.baseline.table.as_ref();
        for (slopes, response) in &found {
            for (total, slope) in mean.slopes.iter_mut().zip(slopes) {
                *total += slope / count;
            }
            mean.beyond.push(self.baseline.beyond(response).collect());
            let square = response.drag_over_thrust * response.drag_over_thrust;
            mean.left += table.map_or(0.0, |table| square * table.left_out(response)) / count;
        }
        Some(mean)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use test_support::fleet::{Background, Setup, exact_model, fly};

    use super::*;
    use crate::baseline::within_guide;
    use crate::learning::tests::with_taught;

    /// What six flights leave to a guide that may be off by 3 % alike everywhere.
    fn with_guide(work: impl FnOnce(&Baseline, &Guide)) {
        let fleet = fly(95, &Setup { flights: 6, ..Setup::default() }, &[], &Background::default());
        let table = exact_model().drag_table().clone();
        let nodes = table.grid().nodes();
        let belief = TableUncertainty::new(Arc::clone(table.grid()), 1, vec![0.03; nodes]).unwrap();
        with_taught(&fleet.flights, (&table, Some(belief)), false, |effects, taught, data| {
            work(taught, &Guide::of(effects, taught, data, &vec![false; nodes]));
        });
    }

    fn inverse(of: &Mat<f64>) -> Mat<f64> {
        let mut found = Mat::identity(of.nrows(), of.nrows());
        Cholesky::new(of).unwrap().solve(&mut found);
        found
    }

    /// The oracle is dense algebra: the covariance of (δ, δ + e) given the second, by the inverse of the precision.
    #[test]
    fn what_nobody_flew_given_the_guide() {
        let of_guide = GUIDE_SHAPE_DEVIATION.powi(2);
        for variance in [1e-6, 1e-3, 0.2] {
            let joint =
                Mat::from_fn(2, 2, |i, j| variance + if i == 1 && j == 1 { of_guide } else { 0.0 });
            let expected = 1.0 / inverse(&joint)[(0, 0)];
            assert!((within_guide(variance) / expected - 1.0).abs() < 1e-9, "{variance}");
        }
    }

    /// The oracle is dense algebra in the other form: precisions add, V' = (V⁻¹ + AᵀC⁻¹A)⁻¹, m' = V'V⁻¹m.
    #[test]
    fn held_as_information_adds() {
        with_guide(|taught, guide| {
            let width = guide.width;
            let deviations: Vec<f64> = (0..width).map(|k| taught.prior_deviation(k)).collect();
            let count = guide.departures.len();
            assert!(count > 20, "{count}");
            let start: Vec<f64> = (0..width).map(|k| ((7 * k) as f64).sin()).collect();
            let before = Mat::from_fn(width, width, |i, j| {
                0.3 * start[i] * start[j] + if i == j { 0.5 } else { 0.0 }
            });
            let (mut mean, mut covariance) = (start.clone(), before.clone());
            guide.hold(taught, &mut mean, &mut covariance, &deviations);
            let rows =
                Mat::from_fn(count, width, |k, j| guide.departures[k].slopes[j] * deviations[j]);
            let precision = inverse(&before);
            let added = rows.transpose() * inverse(&guide.covariance(taught)) * &rows;
            let expected = inverse(&(&precision + added));
            let mean_before = Mat::from_fn(width, 1, |k, _| start[k]);
            let expected_mean = &expected * (&precision * mean_before);
            for i in 0..width {
                assert!((mean[i] - expected_mean[(i, 0)]).abs() < 1e-6, "{i}");
                for j in 0..width {
                    assert!((covariance[(i, j)] - expected[(i, j)]).abs() < 1e-6, "{i} {j}");
                }
            }
        });
    }

    /// What is believed beforehand departs from the guide by tens of per cent at its ends; held, by little more than a guide is off.
    /// States that flights flew are not asked.
    #[test]
    fn far_ends_are_no_farther_from_the_guide_than_guides_are() {
        with_guide(|taught, guide| {
            let width = guide.width;
            let deviations: Vec<f64> = (0..width).map(|k| taught.prior_deviation(k)).collect();
            let spread = |covariance: &Mat<f64>| {
                let of = |one: &Departure| {
                    let scaled = Mat::from_fn(width, 1, |k, _| one.slopes[k] * deviations[k]);
                    let square = scaled.transpose() * covariance * &scaled;
                    square[(0, 0)].sqrt()
                };
                guide.departures.iter().map(of).fold(0.0, f64::max)
            };
            let (mut mean, mut covariance) = (vec![0.0; width], Mat::identity(width, width));
            let before = spread(&covariance);
            guide.hold(taught, &mut mean, &mut covariance, &deviations);
            let after = spread(&covariance);
            assert!(before > 0.2 && after < 0.5 * before, "{before} {after}");
            assert!(mean.iter().all(|value| value.abs() < 1e-15));
            // What no coefficient holds is as far from the guide as guides are off at most, and never farther than before.
            for distances in guide.departures.iter().flat_map(|one| &one.beyond) {
                let growth = |k: usize| taught.growth_beyond(k) / taught.interval_factor().powi(2);
                let grown: f64 =
                    distances.iter().enumerate().map(|(k, d)| growth(k) * d.abs().powi(3)).sum();
                let left = taught.left_by_guide(distances);
                assert!(left <= 1.0 && left * grown <= GUIDE_SHAPE_DEVIATION.powi(2), "{left}");
            }
            let is_flown = |one: &Departure| one.beyond.iter().flatten().all(|d| *d == 0.0);
            assert!(!guide.departures.iter().any(is_flown));
        });
    }
}
