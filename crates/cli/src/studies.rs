//! Simulated data that comes with the program: the paper's study, and the fleet of the demonstration.

use std::fmt::Write;
use std::path::Path;

use simulate::{AircraftTruth, Plan, Preset, Simulation, TruthPhysics, study};
use units::FuelFlowTotal;

use crate::commands::simulate::write;
use crate::failure::Failure;
use crate::files::{make_folder, write_atomically};

/// The aircraft file of the study: what a performance engineer knows of the Cessna Citation X. The TSFC constants are
/// those that reproduce its published fuel burn (static TSFC of the AE 3007C1 from its emission certification).
pub const CITATION_X: &str = include_str!("../embedded/CITATION-X.ron");

/// The plan of the demonstration.
const DEMONSTRATION: &str = include_str!("../embedded/DEMO-PLAN.ron");

/// The later period of the demonstration, with an effect that the model does not know.
const DEMONSTRATION_LATER: &str = include_str!("../embedded/DEMO-LATER.ron");

/// Seed of the study, fixed before anything was run.
const GHAZI_2020_SEED: u64 = 2020;

/// Data that belong together: what `init`, `adapt` and `predict` are given.
#[derive(Debug)]
pub struct Study {
    /// Text of the aircraft file.
    pub aircraft: &'static str,
    /// Text of the flight-planning guide.
    pub guide: String,
    /// Text of the static points, with measured fuel flow.
    pub static_points: String,
    /// The flights.
    pub plan: Plan,
}

/// The study of Ghazi et al. 2020: ten flights of table 5, 45 static points, a guide whose drag is wrong in a known way.
///
/// # Errors
/// What the simulator refuses.
pub fn ghazi_2020() -> Result<Study, Failure> {
    study_with(study::paper_study_plan(GHAZI_2020_SEED))
}

/// The demonstration: the same aircraft and guide, one tail with airline-like sensors, wind, turbulence.
///
/// # Errors
/// What the simulator refuses.
pub fn demonstration() -> Result<Study, Failure> {
    study_with(Plan::from_ron(DEMONSTRATION).map_err(|error| wrong(&error))?)
}

/// The demonstration's tail a year later, with an effect that its model has not learnt.
///
/// # Errors
/// What the simulator refuses.
pub fn demonstration_later() -> Result<Simulation, Failure> {
    let plan = Plan::from_ron(DEMONSTRATION_LATER).map_err(|error| wrong(&error))?;
    Simulation::new(plan).map_err(|error| wrong(&error))
}

fn study_with(plan: Plan) -> Result<Study, Failure> {
    let aircraft = AircraftTruth::preset(Preset::CitationX).map_err(|error| wrong(&error))?;
    let physics = TruthPhysics::full();
    let (rows, _) = study::flight_planning_guide(
        &aircraft,
        physics,
        &study::GuideGrid::paper(),
        &study::DragError::study(),
    )
    .map_err(|error| wrong(&error))?;
    Ok(Study {
        aircraft: CITATION_X,
        guide: study::guide_csv(&rows),
        static_points: static_points(&aircraft, physics)?,
        plan,
    })
}

impl Study {
    /// Writes `AIRCRAFT.ron`, `guide.csv`, `static.csv` and the reports (a folder a tail below `reports`).
    ///
    /// # Errors
    /// A place that cannot be written, or a flight that cannot be flown.
    pub fn write(self, folder: &Path, progress: bool) -> Result<usize, Failure> {
        make_folder(folder)?;
        write_atomically(&folder.join("AIRCRAFT.ron"), self.aircraft.as_bytes())?;
        write_atomically(&folder.join("guide.csv"), self.guide.as_bytes())?;
        write_atomically(&folder.join("static.csv"), self.static_points.as_bytes())?;
        let simulation = Simulation::new(self.plan).map_err(|error| wrong(&error))?;
        write(&simulation, &folder.join("reports"), progress)
    }
}

/// The static points that the aircraft can fly, as flight points with measured fuel flow.
fn static_points(aircraft: &AircraftTruth, physics: TruthPhysics) -> Result<String, Failure> {
    let mut text =
        String::from("weight_lb,pressure_altitude_ft,mach,isa_deviation_c,fuel_flow_lb_h\n");
    for condition in study::static_conditions() {
        let point =
            study::static_point(aircraft, physics, &condition).map_err(|error| wrong(&error))?;
        let measured = FuelFlowTotal::kilograms_per_second(point.measured_fuel_flow_kg_s);
        let _ = writeln!(
            text,
            "{},{},{},0,{:.1}",
            condition.weight_lb,
            condition.pressure_altitude_ft,
            condition.mach,
            measured.to_pounds_per_hour()
        );
    }
    Ok(text)
}

fn wrong(error: &dyn std::fmt::Display) -> Failure {
    Failure::BadArgument { argument: "embedded study", reason: error.to_string() }
}
