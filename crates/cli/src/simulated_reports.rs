//! Reports of virtual aircraft on disk: any simulation, and the data built into the program (the paper's study, the
//! fleet of the demonstration).

use std::collections::BTreeSet;
use std::fmt::Write;
use std::io::Read;
use std::path::{Path, PathBuf};

use pipeline::columns::Columns;
use rayon::prelude::*;
use report::TextLayout;
use serde_json::Value;
use simulate::{
    AircraftTruth, Flown, Plan, Preset, REPORT_COMMENT, Simulation, Switch, TrueState,
    TruthPhysics, study,
};
use units::FuelFlowTotal;

use crate::failure::Failure;
use crate::files::{file_stem_of_tail, make_folder, write_atomically, write_unsynced};
use crate::progress::Progress;

/// The truth, written last: a folder without it was not completed.
const TRUTH: &str = "TRUTH.json";

/// What was done to the tails of a fleet.
const EVENTS: &str = "EVENTS.csv";

/// The aircraft file of the study: what a performance engineer knows of the Cessna Citation X. The TSFC constants are
/// those that reproduce its published fuel burn (static TSFC of the AE 3007C1 from its emission certification).
pub(crate) const CITATION_X: &str = include_str!("../embedded/CITATION-X.ron");

/// The plan of the demonstration.
const DEMONSTRATION: &str = include_str!("../embedded/DEMO-PLAN.ron");

/// The later period of the demonstration, with an effect that the model does not have.
const DEMONSTRATION_LATER: &str = include_str!("../embedded/DEMO-LATER.ron");

/// Seed of the study, fixed before anything was run.
const GHAZI_2020_SEED: u64 = 2020;

/// Input data for `init`, `adapt` and `predict` that belong together.
#[derive(Debug)]
pub(crate) struct Study {
    /// Text of the aircraft file.
    pub(crate) aircraft: &'static str,
    /// Text of the flight-planning guide.
    pub(crate) guide: String,
    /// Text of the static points, with measured fuel flow.
    pub(crate) static_points: String,
    /// The flights.
    pub(crate) plan: Plan,
}

/// The study of Ghazi et al. 2020: ten flights of table 5, 45 static points, a guide whose drag is wrong in a known way.
///
/// # Errors
/// A request that the simulator refuses.
pub(crate) fn ghazi_2020() -> Result<Study, Failure> {
    study_with(study::paper_study_plan(GHAZI_2020_SEED))
}

/// The demonstration: the same aircraft and guide, one tail with airline-like sensors, wind, turbulence.
///
/// # Errors
/// A request that the simulator refuses.
pub(crate) fn demonstration() -> Result<Study, Failure> {
    study_with(Plan::from_ron(DEMONSTRATION).map_err(|error| wrong(&error))?)
}

/// The demonstration's tail a year later, with an effect that its model has not learnt. `fuel_quantity`: whether tank gauges
/// are recorded.
///
/// # Errors
/// A request that the simulator refuses.
pub(crate) fn demonstration_later(fuel_quantity: Switch) -> Result<Simulation, Failure> {
    let mut plan = Plan::from_ron(DEMONSTRATION_LATER).map_err(|error| wrong(&error))?;
    plan.columns.fuel_quantity = fuel_quantity;
    Simulation::new(plan).map_err(|error| wrong(&error))
}

/// Refuses a folder that holds something else than reports of this simulation; with `force` only removes the reports
/// that another simulation wrote there.
///
/// # Errors
/// A folder that holds something else.
pub(crate) fn check_folder(
    simulation: &Simulation,
    folder: &Path,
    force: bool,
) -> Result<(), Failure> {
    let own: BTreeSet<PathBuf> = (0..simulation.len())
        .filter_map(|index| simulation.flight(index))
        .flat_map(|(tail, plan)| {
            let base = folder.join(file_stem_of_tail(tail));
            let stem = file_stem_of_tail(&plan.flight);
            [base.join(format!("{stem}.txt")), base.join(format!("{stem}-states.csv"))]
        })
        .chain([folder.join(TRUTH)])
        .chain(simulation.plan().fleet.is_some().then(|| folder.join(EVENTS)))
        .collect();
    let strangers: Vec<PathBuf> =
        files_below(folder)?.into_iter().filter(|path| !own.contains(path)).collect();
    if strangers.is_empty() {
        return Ok(());
    }
    if !force {
        return Err(Failure::WouldReplace { path: crate::failure::show(folder) });
    }
    let begins_as_ours = |path: &Path| {
        let mut beginning = [0; 200];
        let read = std::fs::File::open(path).and_then(|mut file| file.read(&mut beginning));
        read.is_ok_and(|read| String::from_utf8_lossy(&beginning[..read]).contains(REPORT_COMMENT))
    };
    for path in strangers.iter().filter(|path| begins_as_ours(path)) {
        std::fs::remove_file(path).map_err(|error| Failure::unwritable(path, error))?;
    }
    Ok(())
}

/// Files of a folder and of those directly in it.
fn files_below(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    let list = |folder: &Path| -> Result<Vec<PathBuf>, Failure> {
        let entries =
            std::fs::read_dir(folder).map_err(|error| Failure::unreadable(folder, error))?;
        Ok(entries.flatten().map(|entry| entry.path()).collect())
    };
    if folder.is_dir() {
        for path in list(folder)? {
            if path.is_dir() { files.extend(list(&path)?) } else { files.push(path) }
        }
    }
    Ok(files)
}

/// What a simulation came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Written {
    /// Flights.
    pub(crate) flights: usize,
    /// Flights that were drawn again, because the aircraft could not fly what was drawn first.
    pub(crate) drawn_again: usize,
}

/// Flies every flight of a simulation and writes reports, true states where the plan asks for them, and the truth.
///
/// # Errors
/// A flight that cannot be flown, or a file that cannot be written.
pub(crate) fn write(
    simulation: &Simulation,
    folder: &Path,
    progress: Progress,
) -> Result<Written, Failure> {
    make_folder(folder)?;
    for index in 0..simulation.len() {
        if let Some((tail, _)) = simulation.flight(index) {
            make_folder(&folder.join(file_stem_of_tail(tail)))?;
        }
    }
    let bar = progress.bar(simulation.len(), "flying");
    let truths = (0..simulation.len())
        .into_par_iter()
        .map(|index| {
            let failed = |error: &dyn std::fmt::Display| Failure::BadArgument {
                argument: "PLAN.ron",
                reason: error.to_string(),
            };
            let Flown { report, truth, states, drawn_again } =
                simulation.fly(index).map_err(|error| failed(&error))?;
            if drawn_again > 0 {
                tracing::warn!(
                    "tail {} flight {} was drawn again: the aircraft lacked thrust or lift for what was drawn first",
                    truth.tail,
                    truth.flight
                );
            }
            let text = report::write(&report, &TextLayout::industry(), &[REPORT_COMMENT])
                .map_err(|error| failed(&error))?;
            let identity = &report.header().identity;
            let base = folder.join(file_stem_of_tail(&identity.tail));
            let stem = file_stem_of_tail(&identity.flight);
            write_unsynced(&base.join(format!("{stem}.txt")), text.as_bytes())?;
            if !states.is_empty() {
                let table = states_table(&states).map_err(|error| failed(&error))?;
                write_unsynced(&base.join(format!("{stem}-states.csv")), &table.to_csv())?;
            }
            bar.step();
            Ok((truth, drawn_again > 0))
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    bar.finish();
    let drawn_again = truths.iter().filter(|(_, again)| *again).count();
    let written = Written { flights: truths.len(), drawn_again };
    if simulation.plan().fleet.is_some() {
        let events = simulate::events_csv(simulation.events());
        write_atomically(&folder.join(EVENTS), events.as_bytes())?;
    }
    let truth = simulation.truth(truths.into_iter().map(|(truth, _)| truth).collect());
    let path = folder.join(TRUTH);
    let mut text =
        serde_json::to_string_pretty(&truth).map_err(|error| Failure::unwritable(&path, error))?;
    text.push('\n');
    write_atomically(&path, text.as_bytes())?;
    Ok(written)
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
    /// Writes `AIRCRAFT.ron`, `guide.csv`, `static.csv` and the reports (one folder per tail below `reports`).
    ///
    /// # Errors
    /// A file that cannot be written, or a flight that cannot be flown.
    pub(crate) fn write(self, folder: &Path, progress: Progress) -> Result<Written, Failure> {
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

/// True states as columns; a quantity with one number per engine becomes one column per engine.
fn states_table(states: &[TrueState]) -> Result<Columns, serde_json::Error> {
    let rows = states.iter().map(flattened).collect::<Result<Vec<_>, _>>()?;
    let mut columns = Columns::default();
    let names: Vec<String> =
        rows.first().into_iter().flatten().map(|(name, _)| name.clone()).collect();
    for (column, name) in names.into_iter().enumerate() {
        columns.number(name, rows.iter().map(|row| row.get(column).and_then(|(_, value)| *value)));
    }
    Ok(columns)
}

fn flattened(state: &TrueState) -> Result<Vec<(String, Option<f64>)>, serde_json::Error> {
    let mut flat = Vec::new();
    if let Value::Object(fields) = serde_json::to_value(state)? {
        for (name, value) in fields {
            match value {
                Value::Array(engines) => {
                    for (engine, value) in engines.iter().enumerate() {
                        flat.push((format!("{name}_{}", engine + 1), value.as_f64()));
                    }
                }
                value => flat.push((name, value.as_f64())),
            }
        }
    }
    Ok(flat)
}
