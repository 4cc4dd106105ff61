//! What is learnt is held to physics: fuel flow does not fall where an aircraft is heavier, nor drag with Mach number where its
//! drag rises.
//!
//! Both are asked on a mesh over the table at the fleet's mean level and temperature, as linear inequalities of the
//! coefficients. Only what is in doubt is held; what flights have shown stays.

use core::ops::RangeInclusive;

use atmos::constants::{RATIO_OF_SPECIFIC_HEATS, SEA_LEVEL_PRESSURE_PA};
use effects::{EffectModel, EffectPoint, Effects, Response, Variable};
use faer::Mat;
use perf_model::FlightPoint;
use units::convert::STANDARD_GRAVITY_M_S2;
use units::{Mach, Mass, PressureAltitude, TemperatureDifference};

use crate::baseline::Baseline;
use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::residuals::signatures::Difference;
use crate::signals::channels::MAXIMUM_CHANNELS;
use crate::signals::variables::flown;
use crate::thresholds::{DRAG_RISE_SLOPE, MASSES_BEYOND, PHYSICAL_LIFT_STEP, PHYSICAL_MACH_STEP};

/// Inequalities `slopesᵀβ + offset ≥ 0` of the coefficients β.
pub(super) struct Physics {
    /// One row per inequality.
    pub(super) slopes: Mat<f64>,
    pub(super) offsets: Vec<f64>,
}

/// A point of the mesh.
struct Node {
    response: Response,
    /// Slopes of ln fuel flow along the coefficients.
    slopes: Vec<f64>,
    /// ln of the initial drag coefficient.
    ln_drag: f64,
}

/// What a lift coefficient and a Mach number become flight points at.
pub(super) struct Conditions {
    pub(super) altitude: PressureAltitude,
    pub(super) isa_deviation: TemperatureDifference,
    pub(super) masses_kg: RangeInclusive<f64>,
}

impl Physics {
    /// What holds of a model near the conditions of its flights.
    pub(super) fn of(
        model: &EffectModel<'_>,
        baseline: &Baseline,
        data: &PreparedFlights<'_>,
    ) -> Self {
        let conditions = Conditions::of(baseline, data);
        let grid = model.drag_table().grid();
        let lifts = mesh(grid.x().first(), grid.x().last(), PHYSICAL_LIFT_STEP);
        let machs = mesh(grid.y().first(), grid.y().last(), PHYSICAL_MACH_STEP);
        let states = Mesh::new(model, baseline, data);
        let at = |lift: &f64, mach: &f64| {
            let point = conditions.point(model, *lift, *mach)?;
            states.node(&point)
        };
        let nodes: Vec<Vec<Option<Node>>> =
            machs.iter().map(|mach| lifts.iter().map(|lift| at(lift, mach)).collect()).collect();
        let stated = model.aircraft().drag_divergence_mach().map(Mach::value);
        let mut pairs = Vec::new();
        for (row, column) in nodes.iter().enumerate() {
            for (place, node) in column.iter().enumerate() {
                let Some(node) = node else { continue };
                if let Some(Some(heavier)) = column.get(place + 1)
                    && heavier.ln_drag > node.ln_drag
                {
                    pairs.push((node, heavier));
                }
                if let Some(Some(faster)) = nodes.get(row + 1).map(|column| &column[place])
                    && node.is_in_drag_rise(faster, stated)
                {
                    pairs.push((node, faster));
                }
            }
        }
        let width = baseline.layout().len();
        Self {
            slopes: Mat::from_fn(pairs.len(), width, |k, j| {
                pairs[k].1.slopes[j] - pairs[k].0.slopes[j]
            }),
            offsets: pairs.iter().map(|(from, to)| to.ln_drag - from.ln_drag).collect(),
        }
    }
}

impl Conditions {
    fn of(baseline: &Baseline, data: &PreparedFlights<'_>) -> Self {
        let mean = |variable| {
            let of = |row: &SegmentRow| flown(variable, &row.response, baseline.references());
            data.segments.iter().map(of).sum::<f64>() / data.segments.len().max(1) as f64
        };
        let masses = || data.segments.iter().map(|row| row.response.mass_kg);
        let low = masses().fold(f64::INFINITY, f64::min);
        let high = masses().fold(f64::NEG_INFINITY, f64::max);
        Self {
            altitude: PressureAltitude::meters(mean(Variable::PressureAltitude)),
            isa_deviation: TemperatureDifference::kelvin(mean(Variable::IsaDeviation)),
            masses_kg: low * (1.0 - MASSES_BEYOND)..=high * (1.0 + MASSES_BEYOND),
        }
    }

    /// The flight point of a lift coefficient and a Mach number; `None` at other masses.
    pub(super) fn point(
        &self,
        model: &EffectModel<'_>,
        lift: f64,
        mach: f64,
    ) -> Option<EffectPoint> {
        let pressure = atmos::isa::pressure(self.altitude).ok()?.to_pascals();
        let area_m2 = model.aircraft().wing_area().to_square_meters();
        let mass_kg = lift * force_n(pressure, mach, area_m2) / STANDARD_GRAVITY_M_S2;
        if !self.masses_kg.contains(&mass_kg) {
            return None;
        }
        let point = FlightPoint {
            isa_deviation: self.isa_deviation,
            ..FlightPoint::new(Mass::kilograms(mass_kg), self.altitude, Mach::new(mach))
        };
        EffectPoint::from_flight_point(&point, model.aircraft().engines()).ok()
    }
}

impl Node {
    /// `None` outside the table or a domain.
    fn new(
        model: &EffectModel<'_>,
        baseline: &Baseline,
        data: &PreparedFlights<'_>,
        differences: &[Difference],
        point: &EffectPoint,
    ) -> Option<Self> {
        let date_s = baseline.references().date_s;
        let (known, response) = model.known_point(&EffectPoint { date_s, ..*point }).ok()?;
        let layout = baseline.layout();
        let mut slopes = vec![0.0; layout.len()];
        baseline.write_remainder(&response, &mut slopes[layout.remainder.clone()]);
        baseline.write_drag(&response, &mut slopes[layout.drag.clone()]);
        for slope in &mut slopes[layout.drag] {
            *slope *= response.drag_over_thrust;
        }
        let mut recorded = [false; MAXIMUM_CHANNELS];
        recorded[0] = true;
        let untaught = data.predictor.untaught();
        for (k, effect) in STANDING_EFFECTS.iter().enumerate() {
            // What lacks an input is the same everywhere on the mesh.
            if !effect.lacks_input(point) {
                let found = differences[k].signature(model, &known, recorded, &untaught).ok()?;
                slopes[layout.standing_effects.start + k] = found[0];
            }
        }
        // Level and unaccelerated: thrust is drag.
        let area_m2 = model.aircraft().wing_area().to_square_meters();
        let ln_force = force_n(SEA_LEVEL_PRESSURE_PA, response.mach, area_m2).ln();
        Some(Self { ln_drag: response.ln_corrected_thrust - ln_force, response, slopes })
    }

    /// Whether drag rises from here to a higher Mach number: beyond the drag-divergence Mach number of the aircraft file, and
    /// where the initial drag does.
    fn is_in_drag_rise(&self, faster: &Self, stated: Option<f64>) -> bool {
        let rise = faster.ln_drag.exp() - self.ln_drag.exp();
        let slope = rise / (faster.response.mach - self.response.mach);
        let is_stated = stated.is_some_and(|stated| self.response.mach >= stated);
        slope >= DRAG_RISE_SLOPE || (is_stated && rise >= 0.0)
    }
}

/// Dynamic pressure times area, N: the force at a coefficient of 1.
fn force_n(static_pressure_pa: f64, mach: f64, area_m2: f64) -> f64 {
    0.5 * RATIO_OF_SPECIFIC_HEATS * static_pressure_pa * mach * mach * area_m2
}

/// What the slopes of a state are made from.
pub(super) struct Mesh<'a, 'm> {
    model: &'a EffectModel<'m>,
    baseline: &'a Baseline,
    data: &'a PreparedFlights<'m>,
    differences: Vec<Difference>,
}

impl<'a, 'm> Mesh<'a, 'm> {
    pub(super) fn new(
        model: &'a EffectModel<'m>,
        baseline: &'a Baseline,
        data: &'a PreparedFlights<'m>,
    ) -> Self {
        let differences = STANDING_EFFECTS
            .iter()
            .map(|effect| {
                let step = 0.5 * baseline.references().typical_size(effect.id);
                Difference::new(model, &Effects::none(), effect.id, effect.hidden, step)
            })
            .collect();
        Self { model, baseline, data, differences }
    }

    /// Slopes of ln fuel flow along the coefficients, and the response there.
    pub(super) fn slopes(&self, point: &EffectPoint) -> Option<(Vec<f64>, Response)> {
        self.node(point).map(|node| (node.slopes, node.response))
    }

    fn node(&self, point: &EffectPoint) -> Option<Node> {
        Node::new(self.model, self.baseline, self.data, &self.differences, point)
    }
}

/// Evenly from the first to the last value, in steps of at most one.
pub(super) fn mesh(first: f64, last: f64, step: f64) -> Vec<f64> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small positive number"
    )]
    let intervals = ((last - first) / step - 1e-9).ceil().max(1.0) as usize;
    (0..=intervals).map(|k| first + (last - first) * k as f64 / intervals as f64).collect()
}

#[cfg(test)]
mod tests {
    use test_support::fleet::{Background, Setup, exact_model, fly};

    use super::*;
    use crate::learning::tests::with_taught;
    use crate::math::half_spaces::{Doubt, hold};
    use crate::residuals::whole::WholeModel;

    const DOUBT: Doubt = Doubt { most: 2.0, least: -2.0 };

    /// A baseline of a few flights, its physics, and what `work` finds with them.
    fn with_physics(
        work: impl FnOnce(&EffectModel<'_>, &Baseline, &PreparedFlights<'_>, &Physics),
    ) {
        let fleet = fly(94, &Setup { flights: 6, ..Setup::default() }, &[], &Background::default());
        let table = exact_model().drag_table().clone();
        with_taught(&fleet.flights, (&table, None), false, |effects, taught, data| {
            work(effects, taught, data, &Physics::of(effects, taught, data));
        });
    }

    /// The oracle is the whole model at two flight points: what it makes of the initial prediction differs by the slopes.
    #[test]
    fn slopes_are_those_of_predictions() {
        with_physics(|effects, taught, data, _| {
            let model = exact_model();
            let whole = WholeModel::new(&model, taught).unwrap();
            let layout = taught.layout();
            let mut learnt = vec![0.0; layout.len()];
            let parts = &taught.parts;
            learnt[layout.remainder.clone()].copy_from_slice(&parts.mean[layout.remainder]);
            learnt[layout.standing_effects].copy_from_slice(&parts.standing_effects);
            let conditions = Conditions::of(taught, data);
            let differences: Vec<Difference> = STANDING_EFFECTS
                .iter()
                .map(|effect| {
                    let step = 0.5 * taught.references().typical_size(effect.id);
                    Difference::new(effects, &Effects::none(), effect.id, effect.hidden, step)
                })
                .collect();
            let grid = effects.drag_table().grid();
            let mut before: Option<(f64, f64)> = None;
            let mut count = 0;
            for node in 0..grid.nodes() {
                let (lift, mach) = grid.coordinates(node);
                let Some(point) = conditions.point(effects, lift, mach) else { continue };
                let found = Node::new(effects, taught, data, &differences, &point).unwrap();
                let drag = effects.drag_table().value_at_node(node);
                assert!((found.ln_drag.exp() / drag - 1.0).abs() < 1e-9, "{lift} {mach}");
                let flight_point = FlightPoint {
                    isa_deviation: conditions.isa_deviation,
                    ..FlightPoint::new(
                        Mass::kilograms(point.mass_kg),
                        conditions.altitude,
                        Mach::new(mach),
                    )
                };
                let predicted = whole.of_point(&flight_point).unwrap().ln_fuel_flow;
                let expected = predicted - found.response.ln_fuel_flow_total;
                let by_slopes: f64 = found.slopes.iter().zip(&learnt).map(|(s, c)| s * c).sum();
                if let Some((expected_before, before)) = before {
                    let off = (expected - expected_before) - (by_slopes - before);
                    assert!(off.abs() < 1e-9, "{lift} {mach}: {off}");
                    count += 1;
                }
                before = Some((expected, by_slopes));
            }
            assert!(count > 20, "{count}");
        });
    }

    /// Beliefs as wide as before any flight allow a drag that falls; held, no mean does. Where all is known nothing moves.
    #[test]
    fn what_is_in_doubt_is_held_and_what_is_known_stays() {
        with_physics(|_, taught, _, physics| {
            let width = taught.layout().len();
            let deviations: Vec<f64> = (0..width).map(|k| taught.prior_deviation(k)).collect();
            let count = physics.offsets.len();
            assert!(count > 20, "{count}");
            let gaps = |mean: &[f64]| -> Vec<f64> {
                let along =
                    |k: usize| (0..width).map(|j| physics.slopes[(k, j)] * mean[j]).sum::<f64>();
                (0..count).map(|k| physics.offsets[k] + along(k)).collect()
            };
            let prior = |share: f64| {
                Mat::from_fn(width, width, |i, j| {
                    if i == j { (share * deviations[i]).powi(2) } else { 0.0 }
                })
            };
            let (mut mean, mut wide) = (vec![0.0; width], prior(3.0));
            let held = hold(&mut mean, &mut wide, &physics.slopes, &physics.offsets, DOUBT);
            assert!(!held.rows.is_empty() && held.against == 0, "{held:?}");
            assert!(gaps(&mean).iter().all(|gap| *gap > 0.0), "{:?}", gaps(&mean));
            let (mut mean, mut narrow) = (vec![0.0; width], prior(1e-3));
            let held = hold(&mut mean, &mut narrow, &physics.slopes, &physics.offsets, DOUBT);
            assert!(held.rows.is_empty() && narrow == prior(1e-3));
            assert!(mean.iter().all(|value| value.to_bits() == 0.0_f64.to_bits()));
        });
    }
}
