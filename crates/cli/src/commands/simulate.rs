//! `cruisefit simulate`: cruise reports of a virtual aircraft.

use std::path::Path;

use rayon::prelude::*;
use report::TextLayout;
use simulate::{Flown, Plan, Simulation, Switch};

use crate::args::SimulateArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::{file_stem_of_tail, make_folder, read_text, write_atomically};
use crate::progress::Progress;

/// First comment of every report: nobody shall take it for a recording.
const COMMENT: &str = "simulated with cruisefit, not a real aircraft";

/// Runs the command.
///
/// # Errors
/// What leaves nothing done.
pub fn run(arguments: &SimulateArgs, progress: bool) -> Result<Outcome, Failure> {
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
                let mut writer = csv::Writer::from_writer(Vec::new());
                for state in &states {
                    writer.serialize(state).map_err(|error| failed(&error))?;
                }
                let bytes = writer.into_inner().map_err(|error| failed(&error))?;
                write_atomically(&base.join(format!("{stem}-states.csv")), &bytes)?;
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
