//! `cruisefit init`: the initial model of an aircraft from its flight-planning guide.

use std::fmt::Write;

use flight::{Finding, Severity};
use perf_model::{Aircraft, Guide, InitialModel};

use crate::args::InitArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::outputs::check_not_read;
use crate::files::read_text;
use crate::models::{check_model_replaceable, write_model};
use pipeline::model_file::ModelFile;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &InitArgs) -> Result<Outcome, Failure> {
    for read in [&arguments.aircraft, &arguments.guide].into_iter().chain(&arguments.sensors) {
        check_not_read(Some(&arguments.output), read)?;
    }
    let aircraft = Aircraft::from_ron(&read_text(&arguments.aircraft)?).map_err(|error| {
        Failure::bad_file(&arguments.aircraft, format!("not an aircraft file: {error}"))
    })?;
    let aircraft = match &arguments.sensors {
        None => aircraft,
        Some(path) => aircraft
            .with_sensors_ron(&read_text(path)?)
            .map_err(|error| Failure::bad_file(path, error))?,
    };
    let guide = Guide::from_csv_of_engines(
        read_text(&arguments.guide)?.as_bytes(),
        u8::try_from(aircraft.engines()).unwrap_or(1),
    )
    .map_err(|error| Failure::bad_file(&arguments.guide, error))?;
    let initial = perf_model::initial_model(&aircraft, &guide)
        .map_err(|error| Failure::bad_file(&arguments.guide, chain(&error)))?;
    refuse_serious(arguments, &initial.findings)?;
    let model = ModelFile::from_initial(&initial, &guide);
    // What `init` made before was an initial model too.
    check_model_replaceable(&arguments.output, arguments.force, Some(&model), |known| {
        known.learnt.is_none() && known.applied.is_empty()
    })?;
    write_model(&model, &arguments.output)?;
    let mut text = String::new();
    let grid = model.grid();
    let _ = writeln!(
        text,
        "Initial model of {} ({}) from {} points of the guide: lift coefficient {:.3} to {:.3}, Mach number {:.3} to {:.3}.",
        aircraft.name(),
        aircraft.type_code(),
        model.guide.points,
        model.guide.lift_coefficient.0,
        model.guide.lift_coefficient.1,
        model.guide.mach.0,
        model.guide.mach.1,
    );
    let _ = writeln!(
        text,
        "Fit residual {:.2} drag counts rms ({:.2} % of drag), condition number of the design {:.1e}.",
        1e4 * model.guide.residual_rms,
        initial.fit.residual_rms_percent,
        model.guide.condition_number
    );
    let _ = writeln!(
        text,
        "Table of {} lift coefficients by {} Mach numbers, {} nodes.",
        grid.x().len(),
        grid.y().len(),
        grid.nodes()
    );
    for finding in &initial.findings {
        let word = severity(finding);
        let line = finding.line.map_or_else(String::new, |line| format!("line {line}: "));
        let _ = writeln!(text, "{word}: {line}{}.", finding.message);
    }
    let _ = writeln!(text, "Written to {}", show(&arguments.output));
    Ok(Outcome::with_figures(text, figures(&model, &initial, arguments)))
}

/// The figures of the text.
fn figures(model: &ModelFile, initial: &InitialModel, arguments: &InitArgs) -> serde_json::Value {
    let aircraft = model.initial.aircraft();
    let range = |(low, high): (f64, f64)| serde_json::json!([low, high]);
    let findings: Vec<serde_json::Value> = initial
        .findings
        .iter()
        .map(|finding| {
            serde_json::json!({
                "severity": severity(finding).to_lowercase(), "line": finding.line, "message": finding.message,
            })
        })
        .collect();
    serde_json::json!({
        "aircraft": aircraft.name(),
        "type": aircraft.type_code(),
        "guide_points": model.guide.points,
        "lift_coefficient": range(model.guide.lift_coefficient),
        "mach": range(model.guide.mach),
        "fit_residual_rms_drag_coefficient": model.guide.residual_rms,
        "fit_residual_rms_percent": initial.fit.residual_rms_percent,
        "condition_number": model.guide.condition_number,
        "table_lift_coefficients": model.grid().x().len(),
        "table_mach_numbers": model.grid().y().len(),
        "findings": findings,
        "written": [show(&arguments.output)],
    })
}

const fn severity(finding: &Finding) -> &'static str {
    match finding.severity {
        Severity::Serious => "SERIOUS",
        Severity::Warning => "Warning",
        Severity::Note => "Note",
    }
}

/// A guide in other units than its columns say gives a model that nothing can be compared with.
fn refuse_serious(arguments: &InitArgs, findings: &[Finding]) -> Result<(), Failure> {
    let serious: Vec<&str> = findings
        .iter()
        .filter(|finding| finding.severity >= Severity::Serious)
        .map(|finding| finding.message.as_str())
        .collect();
    if serious.is_empty() || arguments.accept {
        return Ok(());
    }
    Err(Failure::BadFile {
        path: show(&arguments.guide),
        reason: serious.join("; "),
        help: Some("nothing was written; --accept writes the model nevertheless".to_owned()),
    })
}

/// An error with its causes, in one sentence.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let _ = write!(text, ": {error}");
        cause = error.source();
    }
    text
}
