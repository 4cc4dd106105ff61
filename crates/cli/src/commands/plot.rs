//! `cruisefit plot`: the charts of a model, of a tail of an adapted folder, of a diagnosis, of months or trials, as SVG, PNG or PDF.

use std::collections::BTreeMap;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::args::PlotArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::outputs::write_result;
use crate::files::{file_stem_of_tail, is_device_or_pipe, read_text};
use crate::models::read_model;
use diagnose::SegmentGap;
use page::{PictureFormat, TrialConfusion};
use pipeline::diagnosis_document::TailDiagnosis;
use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::gaps_table;
use pipeline::model_file::ModelFile;
use pipeline::monitoring::TailDocument;
use pipeline::segments_table;
use pipeline::whole_model::Predicts;
use serde::Deserialize;

/// What `diagnose`, `monitor` and `trial` write into their folders.
const DOCUMENTS: [&str; 3] = ["diagnosis.json", "monitor.json", "trials.json"];

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &PlotArgs) -> Result<Outcome, Failure> {
    let format = format(arguments)?;
    let source = &arguments.source;
    let charts: Vec<&str> = arguments.charts.iter().map(String::as_str).collect();
    let document = DOCUMENTS.map(|name| source.join(name)).into_iter().find(|path| path.is_file());
    let drawn = if let Some(document) = document {
        of_document(&document, arguments.tail.as_deref(), &charts)?
    } else if source.is_dir() {
        page::plot(&of_folder(source, arguments.tail.as_deref())?, &charts)
    } else if source.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json")) {
        of_document(source, arguments.tail.as_deref(), &charts)?
    } else {
        page::plot(&of_model(read_model(source)?), &charts)
    };
    let drawn = drawn.ok_or_else(|| Failure::BadArgument {
        argument: "MODEL.ron|DIR|FILE.json",
        reason: format!(
            "{} holds {} of {}; a model or tail has {}, a diagnosis {}",
            show(source),
            if charts.is_empty() {
                "no chart".to_owned()
            } else {
                format!("no {}", charts.join(", "))
            },
            arguments.tail.as_deref().unwrap_or("any tail"),
            page::TAIL_CHARTS.join(", "),
            page::DIAGNOSIS_CHARTS.join(", ")
        ),
    })?;
    let picture =
        format.draw(drawn).map_err(|error| Failure::unwritable(&arguments.output, error))?;
    write_result(&arguments.output, &picture.bytes)?;
    let unknown: String = picture.unknown_characters.iter().collect();
    if !unknown.is_empty() {
        tracing::warn!(
            "the font of PNG and PDF does not have {unknown:?}: boxes in {}; an SVG has them",
            show(&arguments.output)
        );
    }
    let figures = serde_json::json!({
        "format": format.ending(), "unknown_characters": unknown, "written": [show(&arguments.output)],
    });
    // To `-` the picture alone.
    if arguments.output.as_os_str() == "-" {
        return Ok(Outcome::default());
    }
    Ok(Outcome::with_figures(format!("Written to {}\n", show(&arguments.output)), figures))
}

/// What is written: what was asked for, else what the name of the file ends in, else SVG to standard output, a device or a pipe.
fn format(arguments: &PlotArgs) -> Result<PictureFormat, Failure> {
    let output = &arguments.output;
    let on_standard_output = output.as_os_str() == "-";
    if on_standard_output && arguments.json.json {
        return Err(Failure::BadArgument {
            argument: "--json",
            reason:
                "standard output has room for the document alone; give the picture a file with -o"
                    .to_owned(),
        });
    }
    let ending = output.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let of_name = PictureFormat::from_ending(ending);
    let asked = arguments.format.as_deref().and_then(PictureFormat::from_ending);
    let is_unnamed = on_standard_output || is_device_or_pipe(output);
    let unnamed = is_unnamed.then_some(PictureFormat::Svg);
    asked.or(of_name).or(unnamed).ok_or_else(|| Failure::BadArgument {
        argument: "--output",
        reason: format!(
            "{}: found {ending:?}, expected a name that ends in .svg, .png or .pdf, or --format",
            show(output)
        ),
    })
}

/// What this command reads of the documents of others.
#[derive(Deserialize)]
#[serde(tag = "schema")]
enum Document {
    #[serde(rename = "cruisefit.diagnosis/1")]
    Diagnosis { diagnoses: Vec<TailDiagnosis> },
    #[serde(rename = "cruisefit.monitor/1")]
    Monitor { tails: Vec<TailDocument> },
    #[serde(rename = "cruisefit.trials/1")]
    Trials { groups: Vec<TrialConfusion> },
}

fn of_document(
    path: &Path,
    tail: Option<&str>,
    charts: &[&str],
) -> Result<Option<String>, Failure> {
    let document: Document =
        serde_json::from_str(&read_text(path)?).map_err(|error| Failure::bad_file(path, error))?;
    let asked = |name: &str| tail.is_none_or(|tail| tail == name);
    Ok(match document {
        Document::Diagnosis { mut diagnoses } => {
            diagnoses.retain(|one| asked(&one.tail));
            page::plot_diagnoses(&diagnoses, &gaps_beside(path)?, charts)
        }
        Document::Monitor { mut tails } => {
            tails.retain(|one| asked(&one.tail));
            page::plot_months(&tails)
        }
        Document::Trials { groups } => page::plot_trials(&groups),
    })
}

/// The gap at every segment, where `diagnose` left it beside its document.
fn gaps_beside(document: &Path) -> Result<BTreeMap<String, Vec<SegmentGap>>, Failure> {
    let path = document.with_file_name("gaps.csv");
    match fs::read(&path) {
        Ok(bytes) => gaps_table::read(&bytes).map_err(|error| Failure::bad_file(&path, error)),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(BTreeMap::new()),
        Err(error) => Err(Failure::unreadable(&path, error)),
    }
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
            curve: None,
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
    let data = TailData {
        tail,
        model,
        segments,
        counts: TailCounts::default(),
        notes: Vec::new(),
        curve: None,
    };
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
