//! `cruisefit adapt`: one adapted model per tail, continuing from what the folder holds.
//!
//! A first pass reads who flew and when from the beginning of each report; then tails are learnt side by side, each
//! tail's flights in the order of flying. What a tail comes to is written to the folder's waiting room at once, so that
//! memory holds the tails in work and nothing of those that are done.

mod other_tails;
mod results;
mod tail;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use pipeline::adaptation::{LawAsked, RemainderChoice, Start, Starts};
use pipeline::distinct::warn_of_copies;
use pipeline::file_names::page_file_of_tail;
use pipeline::model_file::ModelFile;
use pipeline::models::{Models, NoModel, ReportsByModel};
use pipeline::reading::Checks;
use rayon::prelude::*;

use crate::args::{AdaptArgs, LawName};
use crate::commands::{Outcome, check_refused, source_of};
use crate::failure::{Failure, RefusedReport, show};
use crate::folder::lock::Busy;
use crate::folder::{Beginning, Folder};
use crate::inputs;
use crate::models::read_models;
use crate::progress::{Bar, Progress};
use crate::reading::heads::{Head, Heads};
use crate::reading::{Buffers, Source};
pub(crate) use tail::stage;

/// What all tails of a run have in common.
struct Run<'a> {
    arguments: &'a AdaptArgs,
    folder: &'a Folder,
    source: &'a Source,
    /// Whether the page of the run holds the tails' charts; otherwise each tail has its own page.
    on_one_page: bool,
    anchors: page::Anchors,
    /// Files of the folders that are no reports.
    other_files: usize,
    /// Counts reports: half of one when it is read, the other half when its tail has learnt.
    bar: Bar,
}

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &AdaptArgs, progress: Progress) -> Result<Outcome, Failure> {
    let models = read_models(&arguments.models.models)?;
    check_threshold(arguments)?;
    let source = source_of(&arguments.reports, Checks::Made)?;
    let inputs = inputs::collect(&arguments.reports.reports, arguments.reports.mapping.as_deref())?;
    let bar = progress.bar(inputs.files.len(), "reading headers");
    let Heads { tails, mut refused } = source.heads(inputs.files, &bar);
    bar.finish();
    refused.extend(inputs.refused);
    // Flights, as all commands count them: a recording holds many.
    let files = tails.values().map(Vec::len).sum::<usize>() + refused.len();
    let law = law_of(arguments);
    let by_model = with_models(tails, &models, &mut refused);
    check_refused(&refused, files, arguments.reports.strict, by_model.is_empty())?;
    let beginning = if arguments.restart { Beginning::Restart } else { Beginning::Continue };
    if arguments.restart {
        check_inputs_stay(&arguments.output, &arguments.reports.reports)?;
    }
    let mut folder = Folder::open(&arguments.output, beginning, Busy::from_option(arguments.wait))?;
    results::check_own(&folder)?;
    let mut starts = Starts::new(law, &arguments.reports.criteria.name, remainder_of(arguments));
    let tails = choose(by_model, &mut starts, &folder, &mut refused);
    let tails = begun_alike(tails, arguments, &folder, &mut refused)?;
    warn_of_other_books(&tails, &folder);
    let mut all: BTreeSet<String> = folder.tails();
    all.extend(tails.keys().cloned());
    crate::folder::names::check(&arguments.output, &all)?;
    let reports = tails.values().map(|(_, heads)| heads.len()).sum();
    let run = Run {
        arguments,
        folder: &folder,
        source: &source,
        on_one_page: all.len() <= page::TAILS_ON_ONE_PAGE,
        anchors: page::Anchors::new(all.iter().map(String::as_str)),
        other_files: inputs.skipped,
        bar: progress.bar(reports, "learning flights"),
    };
    let mut outcomes = learn_all(&run, tails, reports)?;
    // The summary covers every tail that the folder holds, also those without a report in this run.
    let done: BTreeSet<String> = outcomes.iter().map(|one| one.tail.clone()).collect();
    let others: Vec<&String> = all.difference(&done).collect();
    let at_rest = others
        .into_par_iter()
        .map(|tail| run.at_rest(tail))
        .collect::<Result<Vec<_>, Failure>>()?;
    outcomes.extend(at_rest);
    outcomes.sort_by(|one, other| one.tail.cmp(&other.tail));
    for outcome in &mut outcomes {
        refused.append(&mut outcome.refused);
    }
    refused.sort_by(|one, other| one.path.cmp(&other.path));
    let usable: usize = outcomes.iter().map(|outcome| outcome.usable).sum();
    check_refused(&refused, files, arguments.reports.strict, usable == 0)?;
    let copies = outcomes.iter().map(|outcome| outcome.copies).sum();
    warn_of_copies(copies, outcomes.iter_mut().find_map(|outcome| outcome.first_copy.take()));
    other_tails::warn_of_twins(&arguments.output, &folder, &outcomes);
    let summary = results::write(&run, &refused, &outcomes)?;
    // One page holds every tail: pages that an earlier run or program gave each of them would show old figures.
    let pages: Vec<String> = if run.on_one_page {
        all.iter().map(|tail| page_file_of_tail(tail)).collect()
    } else {
        Vec::new()
    };
    let states = outcomes.into_iter().filter_map(|one| Some((one.tail, one.state?))).collect();
    drop(run);
    folder.removes(pages);
    folder.commit(states)?;
    let text = format!(
        "{}Written to {}: models/, segments/, flights/, deviations/, summary.json, report.html\n",
        summary.to_text(),
        show(&arguments.output)
    );
    Ok(Outcome { refused, ..Outcome::with_json(text, summary.to_json()) })
}

type ByModel<'a> = BTreeMap<String, ReportsByModel<'a, Head>>;
type Chosen<'a> = BTreeMap<String, (Start<'a>, Vec<Head>)>;

/// The model of each report; one without a model is refused.
fn with_models<'a>(
    tails: BTreeMap<String, Vec<Head>>,
    models: &'a Models,
    refused: &mut Vec<RefusedReport>,
) -> ByModel<'a> {
    let mut by_model = ByModel::new();
    for (tail, heads) in tails {
        for head in heads {
            match models.to_begin_with(&tail, &head.aircraft_type) {
                Ok(model) => by_model.entry(tail.clone()).or_default().add(model, head),
                Err(reason) => refused.push(RefusedReport::whole(head.path.into(), reason)),
            }
        }
    }
    by_model
}

/// The state that each tail starts from; a report of another type than the tail's is refused.
fn choose<'a>(
    by_model: ByModel<'a>,
    starts: &mut Starts<'a>,
    folder: &Folder,
    refused: &mut Vec<RefusedReport>,
) -> Chosen<'a> {
    let mut chosen = Chosen::new();
    for (tail, reports) in by_model {
        let begun = folder.state_of(&tail).map(|state| state.begun.as_str());
        let is_known = |model| begun == Some(starts.of_model(model).begun.as_str());
        let Some(one) = reports.of_one(&tail, is_known) else { continue };
        let strays = one.strays.into_iter();
        refused.extend(strays.map(|(head, reason)| RefusedReport::whole(head.path.into(), reason)));
        chosen.insert(tail, (starts.of_model(one.model), one.reports));
    }
    chosen
}

/// The tails that go on from what the folder has of them: those that it does not hold, or that were begun with the same. The
/// reports of the others are refused, tail by tail.
///
/// # Errors
/// What every tail was begun with otherwise: then it is the run that asks for something else.
fn begun_alike<'a>(
    tails: Chosen<'a>,
    arguments: &AdaptArgs,
    folder: &Folder,
    refused: &mut Vec<RefusedReport>,
) -> Result<Chosen<'a>, Failure> {
    let (mut alike, mut otherwise) = (Chosen::new(), Vec::new());
    let mut refuse = |heads: Vec<Head>, reason: &str| {
        let all = heads.into_iter();
        refused.extend(all.map(|head| RefusedReport::whole(head.path.into(), reason)));
    };
    for (tail, (start, heads)) in tails {
        match difference(folder, &tail, &start)? {
            None => {
                alike.insert(tail, (start, heads));
            }
            Some(Otherwise::Type(reason)) => refuse(heads, &reason.to_string()),
            Some(Otherwise::Begun(what, found)) => otherwise.push((tail, heads, what, found)),
        }
    }
    let goes_on = alike.keys().any(|tail| folder.holds(tail));
    if !goes_on && let Some(new) = alike.values().next() {
        // What all tails of a folder have in common is asked of the others.
        let states = || folder.tails().into_iter().filter_map(|tail| folder.state_of(&tail));
        let otherwise = states().find_map(|state| other_choice(&new.0, &state.begun));
        if let Some(difference) = otherwise
            && states().all(|state| state.begun != new.0.begun)
        {
            let (folder, difference) = (show(&arguments.output), difference.to_owned());
            return Err(Failure::BegunOtherwise { folder, what: "setting", difference });
        }
        let known = folder.tails().into_iter().find_map(|tail| folder.load(&tail).ok());
        if let Some((what, difference)) =
            known.and_then(|one| new.0.difference_of_folder(&one.model))
        {
            let folder = show(&arguments.output);
            return Err(Failure::BegunOtherwise { folder, what, difference });
        }
    }
    for (tail, heads, what, difference) in otherwise {
        if !goes_on {
            let folder = show(&arguments.output);
            let difference = format!("{difference} (tail {tail})");
            return Err(Failure::BegunOtherwise { folder, what, difference });
        }
        refuse(heads, &format!("tail {tail} was begun with another {what}: {difference}"));
    }
    Ok(alike)
}

/// Names a new tail whose initial model is another one than that of the tails of its type: what `monitor` compares of them is then
/// against two books.
fn warn_of_other_books(tails: &Chosen<'_>, folder: &Folder) {
    let mut told = BTreeSet::new();
    for (tail, (start, _)) in tails {
        let is_known = |known: &String| {
            known == tail || folder.state_of(known).is_some_and(|state| state.begun == start.begun)
        };
        if folder.tails().iter().any(is_known) || !told.insert(start.begun.clone()) {
            continue;
        }
        let type_of = |model: &ModelFile| model.initial.aircraft().type_code().to_owned();
        let of_type = folder.tails().into_iter().find_map(|known| {
            let stored = folder.load(&known).ok()?;
            (type_of(&stored.model) == type_of(start.model)).then_some((known, stored.model))
        });
        let Some((known, model)) = of_type else { continue };
        if let Ok(Some((what, difference))) = start.difference(tail, &model) {
            tracing::warn!(
                "tail {tail} begins with another {what} than tail {known} of its type ({difference}): each is compared with its own"
            );
        }
    }
}

/// How a tail that the folder holds is not what its reports would go on with.
enum Otherwise {
    /// It is of another aircraft type: the reports are not its own.
    Type(NoModel),
    /// It was begun with something else: what, and both values.
    Begun(&'static str, String),
}

/// Learns every tail. Many tails are learnt side by side, each by one thread; a tail with a large share of all reports
/// is read by several.
fn learn_all(
    run: &Run<'_>,
    tails: Chosen<'_>,
    reports: usize,
) -> Result<Vec<tail::TailOutcome>, Failure> {
    let large = reports / (2 * rayon::current_num_threads()).max(1);
    let jobs: Vec<_> = tails.into_iter().collect();
    let outcomes = jobs
        .into_par_iter()
        .map_init(Buffers::default, |buffers, (tail, (start, heads))| {
            // Few tails can be as large as that, so few jobs can wait inside each other.
            let side_by_side = heads.len() > large.max(tail::READ_AT_A_TIME);
            run.learn(&tail, &start, heads, buffers, side_by_side)
        })
        .collect();
    run.bar.finish();
    outcomes
}

/// What was begun with --no-remainder is not what this run would make of it.
const TABLE_ALONE: &str = "the table alone was learnt, and more would be now; add --no-remainder";

/// And the other way round.
pub(super) const MORE_THAN_TABLE: &str =
    "more than the table was learnt, which --no-remainder would drop";

const fn remainder_of(arguments: &AdaptArgs) -> RemainderChoice {
    if arguments.no_remainder { RemainderChoice::Leave } else { RemainderChoice::Learn }
}

const fn law_of(arguments: &AdaptArgs) -> LawAsked {
    match arguments.law {
        LawName::Bayes => LawAsked::Bayes,
        LawName::Paper => LawAsked::Paper { threshold_percent: arguments.threshold },
    }
}

/// What a tail that was begun with this (its SHA-256) was to learn, where it is more or less than what it would learn now.
fn other_choice(start: &Start<'_>, begun: &str) -> Option<&'static str> {
    if start.learns_more_than(begun) {
        Some(TABLE_ALONE)
    } else if start.learns_less_than(begun) {
        Some(MORE_THAN_TABLE)
    } else {
        None
    }
}

/// What a tail that the folder holds was begun with otherwise.
fn difference(
    folder: &Folder,
    tail: &str,
    start: &Start<'_>,
) -> Result<Option<Otherwise>, Failure> {
    if !folder.holds(tail) || folder.state_of(tail).is_some_and(|s| s.begun == start.begun) {
        return Ok(None);
    }
    if let Some(setting) = folder.state_of(tail).and_then(|state| other_choice(start, &state.begun))
    {
        return Ok(Some(Otherwise::Begun("setting", setting.to_owned())));
    }
    // A damaged tail is refused when its flights are.
    let Ok(stored) = folder.load(tail) else { return Ok(None) };
    let type_of = |model: &ModelFile| model.initial.aircraft().type_code().to_owned();
    let (found, expected) = (type_of(start.model), type_of(&stored.model));
    if found != expected {
        let tail = tail.to_owned();
        return Ok(Some(Otherwise::Type(NoModel::TypeOfTail { found, expected, tail })));
    }
    let begun =
        start.difference(tail, &stored.model).map_err(|error| tail::not_correctable(&error))?;
    Ok(begun.map(|(what, difference)| Otherwise::Begun(what, difference)))
}

/// What --restart moves out of the way must not hold what is read: the next night would find nothing.
fn check_inputs_stay(output: &Path, reports: &[PathBuf]) -> Result<(), Failure> {
    let Ok(output) = output.canonicalize() else { return Ok(()) };
    let inside = |path: &&PathBuf| path.canonicalize().is_ok_and(|path| path.starts_with(&output));
    match reports.iter().find(inside) {
        None => Ok(()),
        Some(path) => Err(Failure::BadArgument {
            argument: "--restart",
            reason: format!(
                "{} lies in {}, which would be moved out of the way with it; write to another folder",
                show(path),
                show(&output)
            ),
        }),
    }
}

fn check_threshold(arguments: &AdaptArgs) -> Result<(), Failure> {
    let wrong = |reason: String| Failure::BadArgument { argument: "--threshold", reason };
    match (arguments.threshold, arguments.law) {
        (Some(_), LawName::Bayes) => {
            Err(wrong("law bayes has no threshold; --law paper has".to_owned()))
        }
        (Some(threshold), LawName::Paper) => adapt::paper::PaperLaw::new(threshold)
            .map(|_| ())
            .map_err(|error| wrong(error.to_string())),
        (None, _) => Ok(()),
    }
}
