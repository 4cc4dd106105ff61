//! `cruisefit forget`: a tail without one of its flights.

use std::collections::BTreeMap;

use flight::Timestamp;
use pipeline::adaptation::{choice_of, materials, rebuild, result_of, settled};
use pipeline::file_names::page_file_of_tail;
use pipeline::learning;
use pipeline::learnt_flights::{self, KnownFlight};
use pipeline::model_file::ModelFile;
use pipeline::summary::counted;

use crate::args::ForgetArgs;
use crate::commands::Outcome;
use crate::commands::adapt::stage;
use crate::failure::{Failure, show};
use crate::folder::lock::Busy;
use crate::folder::state::TailState;
use crate::folder::{Beginning, Folder, state};

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &ForgetArgs) -> Result<Outcome, Failure> {
    if !arguments.folder.join(state::NAME).exists() {
        return Err(Failure::bad_file(
            &arguments.folder,
            "no folder of `adapt`: it has no STATE.ron (a run of `adapt` gives one to an older folder)",
        ));
    }
    let busy = Busy::from_option(arguments.wait);
    let mut folder = Folder::open(&arguments.folder, Beginning::Continue, busy)?;
    let tail = &arguments.tail;
    let Some(begun) = folder.state_of(tail).map(|state| state.begun.clone()) else {
        let known: Vec<String> = folder.tails().into_iter().collect();
        return Err(Failure::BadArgument {
            argument: "--tail",
            reason: if known.is_empty() {
                format!("no tail {tail:?} in the folder, which holds none")
            } else {
                format!("no tail {tail:?} in the folder; it holds {}", known.join(", "))
            },
        });
    };
    let stored = folder.load(tail)?;
    let place = find(&stored.flights, arguments)?;
    let remainder = choice_of(&stored.model, &begun);
    let mut flights = materials(stored.flights, stored.segments);
    let forgotten = flights.remove(place).known;
    let mut states: BTreeMap<String, TailState> = folder
        .tails()
        .into_iter()
        .filter_map(|tail| Some((tail.clone(), folder.state_of(&tail)?.clone())))
        .collect();
    let left = flights.len();
    if flights.is_empty() {
        states.remove(tail);
        folder.removes([page_file_of_tail(tail)]);
    } else {
        let wrong = |reason: &dyn std::fmt::Display| Failure::BadArgument {
            argument: "--flight",
            reason: format!("the tail cannot be learnt without it: {reason}"),
        };
        let rebuilt = rebuild(as_begun(&stored.model).map_err(|error| wrong(&error))?, flights)
            .map_err(|error| wrong(&error))?;
        let rebuilt = settled(rebuilt, remainder, &mut Vec::new());
        let csv = learnt_flights::to_csv(&rebuilt.flights);
        let result = result_of(rebuilt, 0, Vec::new());
        states.insert(tail.clone(), stage(&folder, &begun, &result, &csv)?);
    }
    folder.commit(states)?;
    let text = format!(
        "Flight {} of {} forgotten; tail {tail} in {} has learnt {}. summary.json and report.html are those of \
         the last run of `adapt`, which learns the flight again if its report is still among those that it reads.\n",
        forgotten.entry.flight,
        forgotten.entry.start,
        show(&arguments.folder),
        match left {
            0 => "no other".to_owned(),
            left => counted(left, "other"),
        }
    );
    let figures = serde_json::json!({
        "tail": tail,
        "flight": forgotten.entry.flight,
        "start": forgotten.entry.start,
        "flights_left": left,
    });
    Ok(Outcome::with_figures(text, figures))
}

/// The place of the flight among those that the tail has learnt.
fn find(flights: &[KnownFlight], arguments: &ForgetArgs) -> Result<usize, Failure> {
    let start = match &arguments.start {
        None => None,
        Some(text) => Some(text.parse::<Timestamp>().map_err(|_| Failure::BadArgument {
            argument: "--start",
            reason: format!("found {text:?}, expected an instant like 2018-05-20T14:14:21Z"),
        })?),
    };
    let found: Vec<usize> = flights
        .iter()
        .enumerate()
        .filter(|(_, known)| known.entry.flight == arguments.flight)
        .filter(|(_, known)| start.is_none_or(|start| start == known.start))
        .map(|(place, _)| place)
        .collect();
    match found.as_slice() {
        [place] => Ok(*place),
        [] => Err(Failure::BadArgument {
            argument: "--flight",
            reason: format!(
                "tail {} has not learnt a flight {:?}; flights/ lists those that it has",
                arguments.tail, arguments.flight
            ),
        }),
        several => {
            let starts: Vec<&str> =
                several.iter().map(|place| flights[*place].entry.start.as_str()).collect();
            Err(Failure::BadArgument {
                argument: "--start",
                reason: format!(
                    "several flights have this name, choose one by its START: {}",
                    starts.join(", ")
                ),
            })
        }
    }
}

/// The model as it was before it learnt anything.
fn as_begun(model: &ModelFile) -> Result<ModelFile, learning::LearningError> {
    Ok(ModelFile { learnt: learning::begin_again(model)?, ..model.clone() })
}
