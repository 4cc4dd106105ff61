//! The model that a case is held against: the truth's drag and TSFC without what was planted.

use std::sync::Arc;

use effects::ExtendedModel;
use lut::Table;
use lut::surface::{Basis, Surface};
use perf_model::aircraft::{AircraftFile, AxisFile, SensorDeviations, TableFile, TsfcFile};
use perf_model::{Aircraft, PerformanceModel};
use simulate::study::DragError;
use simulate::{AircraftTruth, TruthPhysics};
use units::Mach;
use units::convert::TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR;

use crate::failure::CaseFailure;

/// Grid of an exact model: chords of it err by less than 0.005 % of drag below the drag rise.
pub(crate) const FINE: [(f64, f64, f64); 2] = [(0.08, 0.75, 0.005), (0.50, 0.95, 0.005)];
/// Grid of an adapted model, as an aircraft file of the paper has it.
pub(crate) const COARSE: [(f64, f64, f64); 2] = [(0.10, 0.75, 0.05), (0.50, 0.95, 0.05)];

/// The truth's drag at its reference conditions, and its TSFC law at the best part load, as a model's table.
pub(crate) fn reference_model(
    truth: &AircraftTruth,
    physics: TruthPhysics,
    sensors: SensorDeviations,
    grid: &[(f64, f64, f64); 2],
    error: Option<&DragError>,
) -> Result<ExtendedModel, CaseFailure> {
    let aircraft = reference_aircraft(truth, sensors, grid)?;
    let at = truth.reference_conditions();
    let grid = Arc::clone(aircraft.grid());
    let values = (0..grid.nodes())
        .map(|node| grid.coordinates(node))
        .map(|(lift, mach)| {
            let drag = truth.drag_coefficient(lift, Mach::new(mach), &at, physics);
            drag * (1.0 + error.map_or(0.0, |error| error.at(mach, lift)))
        })
        .collect();
    let table = Table::new(Arc::clone(&grid), values)?;
    let polynomial = Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] };
    let extrapolated = vec![false; grid.nodes()];
    Ok(PerformanceModel::new(aircraft, polynomial, table, extrapolated)?.into())
}

/// The aircraft file that knows the truth's wing and TSFC.
pub(crate) fn reference_aircraft(
    truth: &AircraftTruth,
    sensors: SensorDeviations,
    grid: &[(f64, f64, f64); 2],
) -> Result<Aircraft, perf_model::AircraftError> {
    let axis = |(from, to, step)| AxisFile::Step { from, to, step };
    Aircraft::new(AircraftFile {
        name: truth.name.clone(),
        type_code: truth.type_code.clone(),
        engines: truth.engine.count,
        wing_area_m2: truth.airframe.wing_area_m2,
        tsfc: TsfcFile {
            static_lb_per_lbf_h: truth.engine.tsfc.static_kg_n_s
                / TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR,
            mach_exponent: truth.engine.tsfc.mach_exponent,
        },
        table: TableFile { lift_coefficient: axis(grid[0]), mach: axis(grid[1]) },
        polynomial: Basis::SeparableQuadratic,
        mean_aerodynamic_chord_m: Some(truth.airframe.mean_aerodynamic_chord_m),
        drag_divergence_mach: None,
        reference_lhv_mj_kg: None,
        table_uncertainty_percent: None,
        sensors,
    })
}

#[cfg(test)]
mod tests {
    use effects::{EffectModel, EffectPoint, Effects};
    use flight::Segment;
    use simulate::{Earth, FleetDesign, Plan, Scatter, SensorChoice, Sensors, Simulation, Weather};

    use super::*;
    use crate::draw::TAIL;
    use crate::flown_case::fly;
    use crate::stated_sensors::stated_sensors;

    fn residuals(plan: Plan) -> Vec<f64> {
        let simulation = Simulation::new(plan).unwrap();
        let truth = simulation.aircraft();
        let model = reference_model(
            truth,
            TruthPhysics::plain(),
            stated_sensors(&Sensors::transport(), &Scatter::default(), truth),
            &FINE,
            None,
        )
        .unwrap();
        let flights = fly(&simulation, 0..simulation.len()).unwrap();
        let segments: Vec<Segment> = flights.into_iter().flat_map(|f| f.segments).collect();
        let points: Vec<EffectPoint> = segments
            .iter()
            .map(|s| EffectPoint::from_means(&s.means, s.identity.start_s(), 2))
            .collect();
        let references =
            effects::mean_references(model.aircraft(), model.drag_table(), &points).unwrap();
        let of = EffectModel::new(&model, model.drag_table(), references).unwrap();
        segments
            .iter()
            .zip(&points)
            .map(|(segment, point)| {
                let response = of.response(point, &Effects::none()).unwrap();
                segment.means.fuel_flow_total_kg_s.ln() - response.ln_fuel_flow_total
            })
            .collect()
    }

    fn plan(flights: usize) -> Plan {
        let design = FleetDesign { flights, ..FleetDesign::default() };
        Plan {
            physics: TruthPhysics::plain(),
            earth: Earth::plain(),
            sensors: SensorChoice::Perfect,
            scatter: Scatter::none(),
            ..Plan::of_one_tail(5, TAIL, design)
        }
    }

    #[test]
    fn an_exact_model_is_exact() {
        // The oracle is the simulator, whose physics is its own: without effect, noise and weather nothing may be left.
        let all = residuals(Plan { weather: Weather::still(), ..plan(6) });
        assert!(all.len() > 40, "{}", all.len());
        let rms = (all.iter().map(|r| r * r).sum::<f64>() / all.len() as f64).sqrt();
        // 0.02 % is left where the speed changes within a segment.
        assert!(rms < 5e-4, "{rms}");
        // With weather 0.1 %, against 0.2 to 0.5 % of noise.
        let all = residuals(plan(6));
        let rms = (all.iter().map(|r| r * r).sum::<f64>() / all.len() as f64).sqrt();
        assert!(rms < 2e-3, "{rms}");
    }
}
