//! `cruisefit golden`: a whole run against expected files.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::args::{AdaptArgs, GoldenCommand, InitArgs, JsonFlag, LawName, ModelArgs, ReportsArgs};
use crate::commands::{Ending, Outcome, adapt, init};
use crate::failure::{Failure, show};
use crate::files::{make_folder, read_text, write_atomically};
use crate::models::read_model;
use crate::progress::Progress;
use pipeline::difference::{Difference, Tolerance, differences};
use pipeline::model_table;

/// `golden.ron`: a run, and how exactly its results must be reproduced.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Golden {
    /// Aircraft file; all paths are relative to the folder.
    aircraft: PathBuf,
    /// Flight-planning guide.
    guide: PathBuf,
    /// Files or folders with reports.
    reports: Vec<PathBuf>,
    /// Adaptation law.
    law: Law,
    /// How far numbers may be off.
    tolerances: Tolerance,
}

/// A law with its settings.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
enum Law {
    /// Law `bayes` with the default settings.
    #[serde(rename = "bayes")]
    Bayes,
    /// Law `paper`.
    #[serde(rename = "paper")]
    Paper {
        /// Threshold, %.
        threshold_percent: f64,
    },
}

/// A value out of tolerance, as the document of `golden check` has it.
#[derive(Debug, Serialize)]
struct OutOfTolerance {
    file: String,
    #[serde(flatten)]
    difference: Difference,
}

/// Runs the command.
///
/// # Errors
/// A folder that cannot be run.
pub(crate) fn run(command: &GoldenCommand) -> Result<Outcome, Failure> {
    match command {
        GoldenCommand::Check { folders, .. } => check_all(folders),
        GoldenCommand::Bless { folders, .. } => bless_all(folders),
    }
}

fn check_all(folders: &[PathBuf]) -> Result<Outcome, Failure> {
    let mut text = String::new();
    let mut all = Vec::new();
    for folder in folders {
        let result = produce(folder)?;
        let found = check_one(folder, &result)?;
        if found.is_empty() {
            let _ = writeln!(text, "{}: {} files as expected", show(folder), result.files.len());
        }
        all.extend(found);
    }
    for one in &all {
        let Difference { line, token, expected, found } = &one.difference;
        let _ = writeln!(
            text,
            "{}:{line}: value {token}: expected {expected}, found {found}",
            one.file
        );
    }
    let figures = serde_json::json!({ "folders": folders.len(), "differences": all });
    let ending = match all.len() {
        0 => Ending::Done,
        count => Ending::NotPassed(Failure::GoldenDiffers { count }),
    };
    Ok(Outcome { ending, ..Outcome::with_figures(text, figures) })
}

fn check_one(folder: &Path, result: &Produced) -> Result<Vec<OutOfTolerance>, Failure> {
    let mut all = Vec::new();
    for (name, found) in &result.files {
        let path = folder.join("expected").join(name);
        let expected = read_text(&path)?;
        let (expected, found) = (without_checksum(&expected), without_checksum(found));
        let found = differences(&expected, &found, result.tolerances);
        all.extend(
            found.into_iter().map(|difference| OutOfTolerance { file: show(&path), difference }),
        );
    }
    Ok(all)
}

fn bless_all(folders: &[PathBuf]) -> Result<Outcome, Failure> {
    let mut text = String::new();
    let mut written = Vec::new();
    for folder in folders {
        let result = produce(folder)?;
        let expected = folder.join("expected");
        make_folder(&expected)?;
        for (name, content) in &result.files {
            let path = expected.join(name);
            write_atomically(&path, content.as_bytes())?;
            written.push(show(&path));
        }
        let _ = writeln!(text, "{}: {} files written", show(&expected), result.files.len());
    }
    let figures = serde_json::json!({ "folders": folders.len(), "written": written });
    Ok(Outcome::with_figures(text, figures))
}

struct Produced {
    tolerances: Tolerance,
    /// Name in `expected/`, and content.
    files: Vec<(String, String)>,
}

/// Runs the chain that the folder describes and collects its results.
fn produce(folder: &Path) -> Result<Produced, Failure> {
    let path = folder.join("golden.ron");
    let golden: Golden =
        ron::from_str(&read_text(&path)?).map_err(|error| Failure::bad_file(&path, error))?;
    let (law, threshold) = match golden.law {
        Law::Bayes => (LawName::Bayes, None),
        Law::Paper { threshold_percent } => (LawName::Paper, Some(threshold_percent)),
    };
    let scratch =
        tempfile::tempdir().map_err(|error| Failure::unwritable(&std::env::temp_dir(), error))?;
    let model_path = scratch.path().join("MODEL.ron");
    let _ = init::run(&InitArgs {
        json: JsonFlag::default(),
        sensors: None,
        accept: true,
        aircraft: folder.join(&golden.aircraft),
        guide: folder.join(&golden.guide),
        output: model_path.clone(),
        force: true,
    })?;
    let output = scratch.path().join("adapted");
    let outcome = adapt::run(
        &AdaptArgs {
            json: JsonFlag::default(),
            accept: true,
            reports: ReportsArgs {
                reports: golden.reports.iter().map(|report| folder.join(report)).collect(),
                mapping: None,
                criteria: crate::criteria::NamedCriteria::default(),
                strict: true,
            },
            models: ModelArgs { models: vec![model_path.clone()] },
            output: output.clone(),
            law,
            threshold,
            // What no table can hold concerns the diagnosis; a model with it is six times as large.
            no_remainder: true,
            relearn: false,
            restart: false,
            wait: false,
        },
        Progress::Hidden,
    )?;
    tracing::debug!("{}", outcome.text);
    let initial = read_model(&model_path)?;
    let mut files = vec![
        ("initial_table.csv".to_owned(), text_of(&model_table::table(&initial).to_csv())),
        ("summary.json".to_owned(), read_text(&output.join("summary.json"))?),
    ];
    for name in names_in(&output.join("models"))? {
        let path = output.join("models").join(&name);
        let model = read_model(&path)?;
        let stem = name.trim_end_matches(".ron");
        files.push((format!("{stem}_table.csv"), text_of(&model_table::table(&model).to_csv())));
        files.push((format!("{stem}.ron"), read_text(&path)?));
        let segments = output.join("segments").join(format!("{stem}.csv"));
        files.push((format!("{stem}_segments.csv"), read_text(&segments)?));
    }
    Ok(Produced { tolerances: golden.tolerances, files })
}

fn names_in(folder: &Path) -> Result<Vec<String>, Failure> {
    let entries = std::fs::read_dir(folder).map_err(|error| Failure::unreadable(folder, error))?;
    let mut names = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|error| Failure::unreadable(folder, error))?;
        names.push(entry.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

/// A checksum changes with the last bit of any number, so it is left out of the comparison within tolerance.
fn without_checksum(text: &str) -> String {
    text.lines()
        .filter(|line| !line.trim_start().starts_with("checksum:"))
        .fold(String::new(), |text, line| text + line + "\n")
}

fn text_of(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
