//! `cruisefit simulate`: cruise reports of a virtual aircraft.

use simulate::{Plan, Simulation, Switch};

use crate::args::SimulateArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::read_text;
use crate::progress::Progress;
use crate::simulated_reports;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &SimulateArgs, progress: Progress) -> Result<Outcome, Failure> {
    if arguments.plan.as_os_str() == "ghazi-2020" {
        let flights = simulated_reports::ghazi_2020()?.write(&arguments.output, progress)?;
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
    let flights = simulated_reports::write(&simulation, &arguments.output, progress)?;
    Ok(Outcome::text(format!(
        "{flights} flights written to {}: one folder per tail, TRUTH.json\n",
        show(&arguments.output)
    )))
}
