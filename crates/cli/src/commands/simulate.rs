//! `cruisefit simulate`: cruise reports of a virtual aircraft.

use std::path::Path;

use rayon::prelude::*;
use report::TextLayout;
use serde_json::Value;
use simulate::{Flown, Plan, Simulation, Switch, TrueState};

use crate::args::SimulateArgs;
use crate::columns::Columns;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::{file_stem_of_tail, make_folder, read_text, write_atomically};
use crate::progress::Progress;
use crate::studies;

/// First comment of every report: nobody shall take it for a recording.
const COMMENT: &str = "simulated with cruisefit, not a real aircraft";

/// Runs the command.
///
/// # Errors
/// What leaves nothing done.
pub fn run(arguments: &SimulateArgs, progress: bool) -> Result<Outcome, Failure> {
    if arguments.plan.as_os_str() == "ghazi-2020" {
        let flights = studies::ghazi_2020()?.write(&arguments.output, progress)?;
        return Ok(Outcome::text(format!(
            "the study of Ghazi et al. 2020 written to {}: {flights} flights, AIRCRAFT.ron, guide.csv, static.csv\n",
            show(&arguments.output)
        )));
    }
    let mut plan = Plan::from_ron(&read_text(&arguments.plan)?)
        .map_err(|error| Failure::bad_file(&arguments.plan, error))?;
    if arguments.states {
        plan.recording.true_states = Switch::On;
    }
    let simulation =
        Simulation::new(plan).map_err(|error| Failure::bad_file(&arguments.plan, error))?;
    let flights = write(&simulation, &arguments.output, progress)?;
    Ok(Outcome::text(format!(
        "{flights} flights written to {}: a folder a tail, TRUTH.json\n",
        show(&arguments.output)
    )))
}

/// Flies every flight of a simulation and writes reports, true states where the plan asks for them, and the truth.
///
/// # Errors
/// A flight that cannot be flown, or a place that cannot be written.
pub fn write(simulation: &Simulation, folder: &Path, progress: bool) -> Result<usize, Failure> {
    make_folder(folder)?;
    for index in 0..simulation.len() {
        if let Some((tail, _)) = simulation.flight(index) {
            make_folder(&folder.join(file_stem_of_tail(tail)))?;
        }
    }
    let bar = Progress::new(simulation.len(), "flying", progress);
    let truths = (0..simulation.len())
        .into_par_iter()
        .map(|index| {
            let failed = |error: &dyn std::fmt::Display| Failure::BadArgument {
                argument: "PLAN.ron",
                reason: error.to_string(),
            };
            let Flown { report, truth, states } =
                simulation.fly(index).map_err(|error| failed(&error))?;
            let text = report::write(&report, &TextLayout::industry(), &[COMMENT])
                .map_err(|error| failed(&error))?;
            let identity = &report.header().identity;
            let base = folder.join(file_stem_of_tail(&identity.tail));
            let stem = file_stem_of_tail(&identity.flight);
            write_atomically(&base.join(format!("{stem}.txt")), text.as_bytes())?;
            if !states.is_empty() {
                let table = states_table(&states).map_err(|error| failed(&error))?;
                write_atomically(&base.join(format!("{stem}-states.csv")), &table.to_csv())?;
            }
            bar.step();
            Ok(truth)
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    bar.finish();
    let flights = truths.len();
    let truth = simulation.truth(truths);
    let path = folder.join("TRUTH.json");
    let mut text =
        serde_json::to_string_pretty(&truth).map_err(|error| Failure::unwritable(&path, error))?;
    text.push('\n');
    write_atomically(&path, text.as_bytes())?;
    Ok(flights)
}

/// True states as columns; what is one number an engine becomes a column an engine.
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
