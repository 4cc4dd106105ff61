//! `cruisefit simulate`: cruise reports of a virtual aircraft.

use pipeline::summary::counted;
use simulate::{Plan, Simulation, Switch};

use crate::args::SimulateArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::read_text;
use crate::progress::Progress;
use crate::simulated_reports::{self, Written};

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &SimulateArgs, progress: Progress) -> Result<Outcome, Failure> {
    if arguments.plan.as_os_str() == "ghazi-2020" {
        let written = simulated_reports::ghazi_2020()?.write(&arguments.output, progress)?;
        let text = format!(
            "the study of Ghazi et al. 2020 written to {}: {} flights, AIRCRAFT.ron, guide.csv, static.csv\n",
            show(&arguments.output),
            written.flights
        );
        return Ok(Outcome::with_figures(text, figures(written, arguments)));
    }
    let mut plan = Plan::from_ron(&read_text(&arguments.plan)?)
        .map_err(|error| Failure::bad_file(&arguments.plan, error))?;
    if arguments.states {
        plan.recording.true_states = Switch::On;
    }
    let simulation =
        Simulation::new(plan).map_err(|error| Failure::bad_file(&arguments.plan, error))?;
    simulated_reports::check_folder(&simulation, &arguments.output, arguments.force)?;
    let written = simulated_reports::write(&simulation, &arguments.output, progress)?;
    let Written { flights, drawn_again } = written;
    let again = match drawn_again {
        0 => String::new(),
        1 => " (1 was drawn again)".to_owned(),
        n => format!(" ({n} were drawn again)"),
    };
    let text = format!(
        "{}{again} written to {}: one folder per tail, TRUTH.json{}\n",
        counted(flights, "flight"),
        show(&arguments.output),
        if simulation.plan().fleet.is_some() { ", EVENTS.csv" } else { "" }
    );
    Ok(Outcome::with_figures(text, figures(written, arguments)))
}

fn figures(written: Written, arguments: &SimulateArgs) -> serde_json::Value {
    serde_json::json!({
        "flights": written.flights,
        "drawn_again": written.drawn_again,
        "written": [show(&arguments.output)],
    })
}
