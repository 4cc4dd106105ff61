//! `cruisefit trial`: blind trials of the diagnosis.

use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

use pipeline::summary::counted;
use rayon::prelude::*;
use simulate::{AircraftChoice, AircraftTruth};
use trials::{
    CaseSpec, DrawnCase, DrawnFleet, FleetSpec, FleetTrials, TrialPlan, Trials, floors_missed,
    markdown, summarize, terminal,
};

use crate::args::TrialArgs;
use crate::commands::{Ending, Outcome};
use crate::failure::{Failure, RefusedReport, show};
use crate::files::{make_folder, read_text, write_atomically};
use crate::folder::keep_aside;
use crate::progress::Progress;
use crate::terminal::neutral;

mod folder;
mod shown;

use folder::TruthFolder;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &TrialArgs, progress: Progress) -> Result<Outcome, Failure> {
    let plan = read_plan(arguments)?;
    let begun = Instant::now();
    if arguments.restart {
        keep_aside(&arguments.output)?;
    }
    make_folder(&arguments.output.join("cases"))?;
    begin(&arguments.output, &plan)?;
    let cases = plan.cases(engines(&plan)?);
    let fleets = plan.fleets();
    let truths = seal(&arguments.output, &plan, (&cases, &fleets), progress)?;
    // Printed before the first diagnosis, also where no progress is shown.
    let and_fleets = match fleets.len() {
        0 => String::new(),
        fleets => format!(" and {}", counted(fleets, "fleet")),
    };
    crate::terminal::tell(&format!(
        "{} cases{and_fleets}, truth sealed: sha256 {}\n",
        cases.len(),
        truths.seal().hash()
    ));
    let bar = progress.bar(cases.len() + fleets.len(), "trials");
    let results: Vec<_> = cases
        .par_iter()
        .map(|case| {
            let result = folder::run_case(&arguments.output, &plan, case, &truths);
            bar.step();
            result.map_err(|error| (case.number, error.to_string()))
        })
        .collect();
    let of_fleets: Vec<_> = fleets
        .par_iter()
        .map(|fleet| {
            let result = folder::run_fleet(&arguments.output, &plan, fleet, &truths);
            bar.step();
            result.map_err(|error| (fleet.number, error.to_string()))
        })
        .collect();
    bar.finish();
    let (done, failed) = parted(results);
    let mut trials = summarize(&plan, truths.seal().hash(), done, failed);
    let (done, failed) = parted(of_fleets);
    trials.fleets = FleetTrials::new(&plan, done, failed);
    let json = write(&arguments.output, &plan, &trials)?;
    let ending = if arguments.check { check(&plan, &trials) } else { Ending::Done };
    let mut text = terminal(&trials);
    let _ = writeln!(
        text,
        "{} cases{and_fleets} in {:.0} s. Written to {}: trials.html, trials.json, trials.md, truth/, cases/",
        trials.cases.len(),
        begun.elapsed().as_secs_f64(),
        show(&arguments.output)
    );
    let refused =
        trials
            .failed
            .iter()
            .map(|(case, reason)| RefusedReport::whole(format!("case {case}").into(), reason))
            .chain(trials.fleets.failed.iter().map(|(fleet, reason)| {
                RefusedReport::whole(format!("fleet {fleet}").into(), reason)
            }))
            .collect();
    Ok(Outcome { refused, ending, ..Outcome::with_json(text, json) })
}

/// What has a result, and what came to nothing.
fn parted<T>(results: Vec<Result<T, (usize, String)>>) -> (Vec<T>, Vec<(usize, String)>) {
    let (mut done, mut failed) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(one) => done.push(one),
            Err(reason) => failed.push(reason),
        }
    }
    (done, failed)
}

fn read_plan(arguments: &TrialArgs) -> Result<TrialPlan, Failure> {
    let mut plan = match &arguments.plan {
        Some(path) => TrialPlan::from_ron(&read_text(path)?)
            .map_err(|reason| Failure::bad_file(path, reason))?,
        None if arguments.long => TrialPlan::long().map_err(|error| embedded(&error))?,
        None => TrialPlan::short().map_err(|error| embedded(&error))?,
    };
    if let Some(seed) = arguments.seed {
        plan.seed = seed;
    }
    Ok(plan)
}

fn embedded(error: &trials::TrialPlanError) -> Failure {
    Failure::BadArgument { argument: "embedded plan", reason: error.to_string() }
}

fn engines(plan: &TrialPlan) -> Result<usize, Failure> {
    match &plan.aircraft {
        AircraftChoice::Preset(preset) => AircraftTruth::preset(*preset)
            .map(|aircraft| aircraft.engines())
            .map_err(|error| wrong(&error)),
        AircraftChoice::Custom(aircraft) => Ok(aircraft.engines()),
    }
}

/// Records what the folder was started with, or checks that it was started with the same.
fn begin(folder: &Path, plan: &TrialPlan) -> Result<(), Failure> {
    let path = folder.join("plan.ron");
    let mut text = plan.to_ron().map_err(|error| Failure::unwritable(&path, error))?;
    text.push('\n');
    if !path.exists() {
        return write_atomically(&path, text.as_bytes());
    }
    let known = read_text(&path)?;
    let difference = known.lines().zip(text.lines()).find(|(one, other)| one != other);
    if known == text {
        return Ok(());
    }
    Err(Failure::BegunOtherwise {
        folder: show(folder),
        what: "plan",
        difference: difference.map_or_else(
            || "one is longer".to_owned(),
            |(one, other)| format!("{} against {}", one.trim(), other.trim()),
        ),
    })
}

/// Draws every case and every fleet and seals the truths.
fn seal(
    folder: &Path,
    plan: &TrialPlan,
    (cases, fleets): (&[CaseSpec], &[FleetSpec]),
    progress: Progress,
) -> Result<TruthFolder, Failure> {
    let bar = progress.bar(cases.len() + fleets.len(), "sealing");
    let truths = cases
        .par_iter()
        .map(|case| {
            let truth = DrawnCase::draw(plan, case).map_err(|error| wrong(&error))?.truth().clone();
            bar.step();
            Ok(truth)
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let of_fleets = fleets
        .par_iter()
        .map(|fleet| {
            let drawn = DrawnFleet::draw(plan, fleet).map_err(|error| wrong(&error))?;
            bar.step();
            Ok(drawn.truth().clone())
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    bar.finish();
    TruthFolder::write(folder, &truths, &of_fleets)
}

/// Writes what a folder of trials holds, and returns `trials.json`.
fn write(folder: &Path, plan: &TrialPlan, trials: &Trials) -> Result<String, Failure> {
    let path = folder.join("trials.json");
    let mut json =
        serde_json::to_string_pretty(trials).map_err(|error| Failure::unwritable(&path, error))?;
    json.push('\n');
    write_atomically(&path, json.as_bytes())?;
    let html = page::trials(&shown::page_of(plan, trials));
    write_atomically(&folder.join("trials.html"), neutral(&html).as_bytes())?;
    write_atomically(&folder.join("trials.md"), markdown(trials).as_bytes())?;
    Ok(json)
}

fn check(plan: &TrialPlan, trials: &Trials) -> Ending {
    let missed = floors_missed(plan, trials);
    for one in &missed {
        let floor = &one.floor;
        crate::terminal::tell(&format!(
            "floor missed: {:?} model, {:?}, {} x typical, {:?}: {}, allowed {}{}\n",
            floor.reference_model,
            floor.background,
            floor.times,
            floor.score,
            one.reached.map_or_else(|| "no case".to_owned(), |value| format!("{value:.3}")),
            floor.least.map_or_else(String::new, |least| format!(">= {least} ")),
            floor.most.map_or_else(String::new, |most| format!("<= {most}")),
        ));
    }
    let failed = trials.failed.len() + trials.fleets.failed.len();
    if missed.is_empty() && failed == 0 {
        Ending::Done
    } else {
        Ending::NotPassed(Failure::TrialFloors { missed: missed.len(), failed })
    }
}

fn wrong(error: &dyn std::fmt::Display) -> Failure {
    Failure::BadArgument { argument: "PLAN.ron", reason: error.to_string() }
}
