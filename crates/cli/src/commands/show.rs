//! `cruisefit show`: the contents of a model file, a report, a diagnosis, or a folder of results, in readable form.

mod diagnosis;
mod report;
mod state;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use ::diagnose::Baseline;
use lut::surface::Basis;

use crate::args::ShowArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, RefusedReport};
use crate::files::standard_input;
use crate::folder::state::NAME;
use crate::folder::waiting_model;
use crate::models::model_of_bytes;
use pipeline::model_file::{AppliedRecord, LawState, Learnt, ModelFile};
use pipeline::monitoring::{self, MonitorDocument, Rows, SCHEMA as MONITOR};
use pipeline::statistics::NORMAL_95;
use pipeline::summary::{SCHEMA as SUMMARY, Summary, aligned, counted};

/// What a gzip file begins with (RFC 1952, section 2.3.1).
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &ShowArgs) -> Result<Outcome, Failure> {
    let path = file_of(&arguments.file);
    let bytes = match waiting_model(&path)? {
        Some(bytes) => bytes,
        None => bytes_of(&path)?,
    };
    if bytes.starts_with(b"CRUISE-REPORT") || bytes.starts_with(&GZIP) {
        return match ::report::Reader::new().read(&bytes) {
            Ok(parsed) => Ok(report::outcome(&parsed)),
            Err(refusal) => {
                let reason = RefusedReport::at(path.clone(), &refusal).reason;
                let place = format!("line {}, column {}", refusal.line, refusal.column);
                Err(Failure::bad_file(&path, format!("{place}: {reason}")))
            }
        };
    }
    let text = String::from_utf8(bytes)
        .map_err(|_| Failure::bad_file(&path, "not a text file (invalid UTF-8)"))?;
    let beginning = text.trim_start_matches('\u{feff}').trim_start();
    if beginning.starts_with('{') {
        return document(&path, &text);
    }
    if path.file_name().is_some_and(|name| name == NAME) {
        return state::outcome(&path, &text);
    }
    let model = model_of_bytes(&path, text.as_bytes())?;
    Ok(Outcome::with_json(words(&model), format!("{:#}\n", figures(&model))))
}

/// What commands leave in their folders, the first found is shown.
const INSIDE: [&str; 4] = ["diagnosis.json", "summary.json", "trials.json", "monitor.json"];

/// The file of a folder that is shown: what a diagnosis, an adaptation, a run of trials or `monitor` left there.
fn file_of(path: &Path) -> PathBuf {
    let inside = INSIDE.map(|name| path.join(name));
    inside.into_iter().find(|file| file.is_file()).unwrap_or_else(|| path.to_owned())
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, Failure> {
    if path.is_dir() {
        return Err(Failure::bad_file(
            path,
            "a folder without diagnosis.json, summary.json, trials.json or monitor.json",
        ));
    }
    standard_input::file(path)
        .and_then(std::fs::read)
        .map_err(|error| Failure::unreadable(path, error))
}

/// A document of this program.
fn document(path: &Path, text: &str) -> Result<Outcome, Failure> {
    let document: serde_json::Value = serde_json::from_str(text)
        .map_err(|error| Failure::bad_file(path, format!("not JSON: {error}")))?;
    let words = match document["schema"].as_str() {
        Some("cruisefit.diagnosis/1") => diagnosis::text(&document),
        Some(SUMMARY) => {
            let summary =
                Summary::from_json(text).map_err(|error| Failure::bad_file(path, error))?;
            summary.to_text() + &state::since(path, &summary)
        }
        Some(MONITOR) => {
            let document =
                MonitorDocument::from_json(text).map_err(|error| Failure::bad_file(path, error))?;
            monitoring::text(&document, Rows::Tails)
        }
        Some(other) => format!("A document of schema {other}, as it is:\n{document:#}\n"),
        None => {
            return Err(Failure::bad_file(path, "JSON without `schema`: not made by this program"));
        }
    };
    Ok(Outcome::with_json(words, text))
}

/// The figures of a model without its tables; `export --format json` has these.
fn figures(model: &ModelFile) -> serde_json::Value {
    let aircraft = model.initial.aircraft();
    serde_json::json!({
        "schema": "cruisefit.model-summary/1",
        "aircraft": aircraft.name(),
        "type": aircraft.type_code(),
        "engines": aircraft.engines(),
        "guide": {
            "points": model.guide.points,
            "lift_coefficient": model.guide.lift_coefficient,
            "mach": model.guide.mach,
            "residual_counts_rms": 1e4 * model.guide.residual_rms,
        },
        "nodes": model.grid().nodes(),
        "informed_nodes": model.informed_nodes(),
        "learnt": model.learnt.as_ref().map(|learnt| serde_json::json!({
            "tail": learnt.tail,
            "flights": learnt.ledger.len(),
            "segments": learnt.ledger.iter().map(|entry| entry.segments).sum::<u64>(),
            "first_flight": learnt.ledger.iter().map(|entry| &entry.start).min(),
            "last_flight": learnt.ledger.iter().map(|entry| &entry.start).max(),
            "law": learnt.law.told(),
            "criteria": learnt.criteria,
        })),
        "applied": model.applied.iter().map(AppliedRecord::told).collect::<Vec<_>>(),
    })
}

fn words(model: &ModelFile) -> String {
    let mut text = String::new();
    describe_initial(model, &mut text);
    match &model.learnt {
        Some(learnt) => describe_learnt(model, learnt, &mut text),
        None => text.push_str("It has learnt nothing yet.\n"),
    }
    describe_effects(model, &mut text);
    describe_table(model, &mut text);
    text
}

fn describe_initial(model: &ModelFile, text: &mut String) {
    let aircraft = model.initial.aircraft();
    let _ = writeln!(
        text,
        "{} ({}), {}",
        aircraft.name(),
        aircraft.type_code(),
        counted(aircraft.engines(), "engine")
    );
    let law = aircraft.tsfc_law();
    let _ = writeln!(
        text,
        "wing area {} m², TSFC {:.4} lb/(lbf h) · √θ · (1 + M)^{}",
        aircraft.wing_area().to_square_meters(),
        law.static_tsfc.to_pounds_per_pound_force_hour(),
        law.mach_exponent
    );
    let polynomial = model.initial.polynomial();
    let _ = writeln!(
        text,
        "initial polynomial {}: {}",
        match polynomial.basis {
            Basis::SeparableQuadratic => "p0 + p1 M + p2 M² + (p3 + p4 M + p5 M²) CL²",
            Basis::FullQuadratic => "p0 + p1 M + p2 CL + p3 M² + p4 M CL + p5 CL²",
        },
        polynomial.coefficients.map(|c| format!("{c:.6e}")).join(", ")
    );
    let guide = &model.guide;
    let _ = writeln!(
        text,
        "from {} of a guide, lift coefficient {:.3} to {:.3}, Mach number {:.3} to {:.3}, residual {:.2} counts rms",
        counted(guide.points, "point"),
        guide.lift_coefficient.0,
        guide.lift_coefficient.1,
        guide.mach.0,
        guide.mach.1,
        1e4 * guide.residual_rms
    );
}

fn describe_learnt(model: &ModelFile, learnt: &Learnt, text: &mut String) {
    let segments: u64 = learnt.ledger.iter().map(|entry| entry.segments).sum();
    let _ = writeln!(
        text,
        "Learnt from {} of tail {} ({}) by {}, criteria {}; {:.0} % of the nodes informed{}",
        counted(learnt.ledger.len(), "flight"),
        learnt.tail,
        counted(segments, "segment"),
        learnt.law.told(),
        learnt.criteria,
        100.0 * model.informed_nodes(),
        model.refits().map_or_else(String::new, |refits| format!(", {refits} global refits"))
    );
    if let (Some(first), Some(last)) = (
        learnt.ledger.iter().map(|entry| entry.start.as_str()).min(),
        learnt.ledger.iter().map(|entry| entry.start.as_str()).max(),
    ) {
        let _ = writeln!(text, "flights from {first} to {last}");
    }
    let means: Vec<String> = learnt
        .references
        .iter()
        .map(|(name, reference)| format!("{name} {:.4} (n {})", reference.mean, reference.segments))
        .collect();
    if !means.is_empty() {
        let _ = writeln!(text, "reference means: {}", means.join(", "));
    }
    if let Some(level) = learnt.baseline.as_ref().and_then(Baseline::gauges) {
        let _ = writeln!(
            text,
            "tank gauges against the flow meters: {:+.2} ± {:.2} % of what is burnt ({})",
            100.0 * level.mean,
            100.0 * NORMAL_95 * level.deviation,
            counted(level.flights, "flight")
        );
    }
}

/// Effects that were applied, and what each acts on.
fn describe_effects(model: &ModelFile, text: &mut String) {
    for record in &model.applied {
        let from = &record.diagnosis;
        let _ = writeln!(
            text,
            "Applied: {}, from {} of tail {} ({} to {}), probability {:.2}",
            record.told(),
            counted(from.flights, "flight"),
            from.tail,
            from.first,
            from.last,
            from.probability
        );
    }
    let Some(effects) = model.initial.effects() else { return };
    let named = |of_recordings: bool| {
        let of_library = effects
            .iter()
            .filter(|(id, _)| id.is_of_recordings() == of_recordings)
            .map(|(id, _)| id.to_string());
        let outside =
            effects.forms().filter(|_| !of_recordings).map(|_| effects::OUTSIDE.to_owned());
        let mut names: Vec<String> = of_library.chain(outside).collect();
        names.dedup();
        names.join(", ")
    };
    for (words, names) in
        [("Predictions have", named(false)), ("Recordings are corrected by", named(true))]
    {
        if !names.is_empty() {
            let _ = writeln!(text, "{words} {names}");
        }
    }
}

fn describe_table(model: &ModelFile, text: &mut String) {
    let grid = model.grid();
    let drag = model.drag_coefficient();
    let informed = match &model.learnt {
        // The refit resets the confidences: what counts is what was adapted since.
        Some(Learnt { law: law @ LawState::Paper { .. }, .. }) => {
            law.confidence().iter().map(|confidence| *confidence > 1.0).collect()
        }
        Some(learnt) => learnt.law.informed(),
        None => vec![false; grid.nodes()],
    };
    let posterior = model.posterior();
    let star = match &model.learnt {
        Some(Learnt { law: LawState::Paper { .. }, .. }) => "* adapted since the last global refit",
        _ => "* with at least one effective observation",
    };
    let _ = writeln!(
        text,
        "\nDrag coefficient in counts (1e-4), lift coefficient down, Mach number across{}. \
         ~ extrapolated beyond the guide and not informed; {star}",
        if posterior.is_some() { ", ± its standard deviation" } else { "" }
    );
    let mut rows = Vec::new();
    let mut head = vec!["CL \\ M".to_owned()];
    head.extend(grid.y().breakpoints().iter().map(|mach| format!("{mach:.3} ")));
    rows.push(head);
    for (i, lift_coefficient) in grid.x().breakpoints().iter().enumerate() {
        let mut row = vec![format!("{lift_coefficient:.3}")];
        for j in 0..grid.y().len() {
            let node = i * grid.y().len() + j;
            let mark = match (informed[node], model.initial.extrapolated()[node]) {
                (true, _) => '*',
                (false, true) => '~',
                (false, false) => ' ',
            };
            let deviation = posterior.map_or_else(String::new, |posterior| {
                let relative = posterior.standard_deviation()[node];
                format!("±{:.1}", 1e4 * relative * posterior.initial().value_at_node(node))
            });
            row.push(format!("{:.1}{deviation}{mark}", 1e4 * drag.value_at_node(node)));
        }
        rows.push(row);
    }
    text.push_str(&aligned(&rows));
}
