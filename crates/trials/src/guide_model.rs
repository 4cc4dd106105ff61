//! The model that `cruisefit init` makes of a guide whose drag is off.

use perf_model::aircraft::SensorDeviations;
use perf_model::{Guide, initial_model};
use pipeline::model_file::ModelFile;
use simulate::AircraftTruth;
use simulate::study::{GuideGrid, flight_planning_guide, guide_csv};
use units::Mass;

use crate::draw::DrawnCase;
use crate::failure::CaseFailure;
use crate::reference_model::{COARSE, reference_aircraft};

/// The initial model of a guide with the case's error of drag: rows of fuel flow over the aircraft's masses, pressure altitudes and
/// airspeeds, read and fitted as a user's file is.
///
/// # Errors
/// Rows that are no guide, or do not determine the polynomial.
pub(crate) fn model_of_guide(
    drawn: &DrawnCase,
    sensors: SensorDeviations,
) -> Result<ModelFile, CaseFailure> {
    let (truth, error) = (drawn.aircraft(), drawn.book_error());
    let (rows, _) = flight_planning_guide(truth, drawn.physics(), &guide_grid(truth), error)?;
    let guide = Guide::from_csv(guide_csv(&rows).as_bytes())?;
    let aircraft = reference_aircraft(truth, sensors, &COARSE)?;
    Ok(ModelFile::from_initial(&initial_model(&aircraft, &guide)?, &guide))
}

/// The study's grid, its masses those of this aircraft: six, evenly from empty with a tenth of the fuel to the maximum at take-off.
fn guide_grid(truth: &AircraftTruth) -> GuideGrid {
    let masses = &truth.masses;
    let lightest = masses.operating_empty_kg + 0.1 * masses.maximum_fuel_kg;
    let step = (masses.maximum_take_off_kg - lightest) / 5.0;
    let weights_lb = (0..6)
        .map(|k| Mass::kilograms(lightest + step * f64::from(k)).to_pounds().round())
        .collect();
    GuideGrid { weights_lb, ..GuideGrid::paper() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::TrialPlan;
    use crate::stated_sensors::stated_sensors;
    use simulate::Scatter;
    use units::Mach;

    /// A case of an aircraft without an effect, and the model that `init` makes of its guide.
    fn model_of(aircraft: &str, seed: u64) -> (DrawnCase, ModelFile) {
        let plan = format!(
            "(seed: {seed}, aircraft: Preset({aircraft}), parts: [(denied: guide, background: clean, kind: null, repeats: 1)])"
        );
        let plan = TrialPlan::from_ron(&plan).unwrap();
        let drawn = DrawnCase::draw(&plan, &plan.cases(2).remove(0)).unwrap();
        let sensors = drawn.flown().plan().sensors.sensors();
        let stated = stated_sensors(&sensors, &Scatter::default(), drawn.aircraft());
        let model = model_of_guide(&drawn, stated).unwrap();
        (drawn, model)
    }

    /// The oracle is the simulator's drag times the error that was drawn: below the rise the polynomial is near it, and off by what
    /// a polynomial loses of the rise.
    #[test]
    fn the_model_of_a_guide_is_the_truth_with_its_error_and_without_its_rise() {
        for aircraft in ["citation_x", "a320", "regional_jet"] {
            let (drawn, model) = model_of(aircraft, 3);
            let truth = drawn.aircraft();
            let at = truth.reference_conditions();
            let (lift, mach) = (0.40, 0.65);
            let off = drawn.book_error().at(mach, lift);
            let expected =
                truth.drag_coefficient(lift, Mach::new(mach), &at, drawn.physics()) * (1.0 + off);
            let found = model.initial.polynomial().value(lift, mach);
            assert!((found / expected - 1.0).abs() < 0.03, "{aircraft}: {found} {expected}");
            assert!(model.guide.residual_rms > 1e-5, "{aircraft}: {:?}", model.guide);
        }
    }

    /// The oracle is the simulator's drag times the error that was drawn, at the nodes within the guide's range: what flights are held
    /// against has the drag rise that the polynomial lost.
    #[test]
    fn what_is_learnt_refers_to_the_drag_of_the_guides_rows() {
        for aircraft in ["citation_x", "a320", "regional_jet"] {
            let (drawn, model) = model_of(aircraft, 4);
            let truth = drawn.aircraft();
            let at = truth.reference_conditions();
            let rms_over_guide = |table: &lut::Table| {
                let grid = table.grid();
                let within = |value: f64, (low, high): (f64, f64)| (low..=high).contains(&value);
                let errors: Vec<f64> = (0..grid.nodes())
                    .map(|node| (node, grid.coordinates(node)))
                    .filter(|(_, (lift, mach))| {
                        within(*lift, model.guide.lift_coefficient)
                            && within(*mach, model.guide.mach)
                    })
                    .map(|(node, (lift, mach))| {
                        let off = drawn.book_error().at(mach, lift);
                        let drag =
                            truth.drag_coefficient(lift, Mach::new(mach), &at, drawn.physics());
                        table.value_at_node(node) / (drag * (1.0 + off)) - 1.0
                    })
                    .collect();
                (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
            };
            let polynomial = rms_over_guide(model.initial.drag_table());
            let reference = rms_over_guide(model.reference().drag_table());
            println!("{aircraft}: polynomial {polynomial:.4}, reference {reference:.4}");
            assert!(reference < 0.6 * polynomial, "{aircraft}: {reference} {polynomial}");
        }
    }
}
