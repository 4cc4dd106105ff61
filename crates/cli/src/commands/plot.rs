//! `cruisefit plot`: the charts of a model, or of one tail of an adapted folder, as an SVG file.

use std::fs;
use std::path::{Path, PathBuf};

use crate::args::PlotArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::{file_stem_of_tail, write_atomically};
use crate::models::read_model;
use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::model_file::ModelFile;
use pipeline::segments_table;
use pipeline::whole_model::Predicts;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &PlotArgs) -> Result<Outcome, Failure> {
    if arguments.output.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("svg")) {
        return Err(Failure::BadArgument {
            argument: "--output",
            reason: format!(
                "{}: only SVG is drawn; name the file FIG.svg",
                show(&arguments.output)
            ),
        });
    }
    let result = if arguments.source.is_dir() {
        of_folder(&arguments.source, arguments.tail.as_deref())?
    } else {
        of_model(read_model(&arguments.source)?)
    };
    write_atomically(&arguments.output, page::plot(&result).as_bytes())?;
    Ok(Outcome::text(format!("Written to {}\n", show(&arguments.output))))
}

/// A model without flights.
fn of_model(model: ModelFile) -> TailResult {
    let tail = match &model.learnt {
        Some(learnt) => learnt.tail.clone(),
        None => model.initial.aircraft().name().to_owned(),
    };
    TailResult::as_given(
        TailData {
            tail,
            model,
            segments: Vec::new(),
            counts: TailCounts::default(),
            notes: Vec::new(),
        },
        Predicts::WholeModel,
    )
}

/// A tail of what `adapt` wrote, with its segments.
fn of_folder(folder: &Path, tail: Option<&str>) -> Result<TailResult, Failure> {
    let path = model_of(folder, tail)?;
    let model = read_model(&path)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let table = folder.join("segments").join(format!("{stem}.csv"));
    let bytes = fs::read(&table).map_err(|error| Failure::unreadable(&table, error))?;
    let segments =
        segments_table::read(&bytes).map_err(|error| Failure::bad_file(&table, error))?;
    let tail = match &model.learnt {
        Some(learnt) => learnt.tail.clone(),
        None => model.initial.aircraft().name().to_owned(),
    };
    let data = TailData { tail, model, segments, counts: TailCounts::default(), notes: Vec::new() };
    Ok(TailResult::adapted(data))
}

/// The model file of the tail, or of the only one.
fn model_of(folder: &Path, tail: Option<&str>) -> Result<PathBuf, Failure> {
    let models = folder.join("models");
    if let Some(tail) = tail {
        return Ok(models.join(format!("{}.ron", file_stem_of_tail(tail))));
    }
    let entries = fs::read_dir(&models).map_err(|error| Failure::unreadable(&models, error))?;
    let mut found: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "ron"))
        .collect();
    found.sort();
    match found.len() {
        1 => Ok(found.remove(0)),
        0 => Err(Failure::BadArgument {
            argument: "MODEL.ron|DIR",
            reason: format!("{}: no model in it", show(&models)),
        }),
        count => Err(Failure::BadArgument {
            argument: "--tail",
            reason: format!("{} holds {count} tails: name one", show(folder)),
        }),
    }
}
