//! `cruisefit demo`: the whole chain on data built into the program.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::args::{
    AdaptArgs, DemoArgs, DiagnoseArgs, EvaluateArgs, InitArgs, JsonFlag, JsonOutput, LawName,
    ModelArgs, PredictArgs, ReportsArgs,
};
use crate::commands::{Outcome, adapt, diagnose, evaluate, init, predict};
use crate::failure::{Failure, show};
use crate::files::read_text;
use crate::progress::Progress;
use crate::simulated_reports;
use ::simulate::Switch;
use pipeline::checksum::sha256;
use pipeline::statistics::ErrorStatistics;

/// Flights that are learnt; the later ones are used for evaluation.
const TEACHING_FLIGHTS: usize = 30;

/// Runs the command.
///
/// # Errors
/// A file or folder that cannot be written.
pub(crate) fn run(arguments: &DemoArgs, progress: Progress) -> Result<Outcome, Failure> {
    let folder = &arguments.output;
    let mut text = String::new();
    let flights = simulated_reports::demonstration()?.write(folder, progress)?.flights;
    let _ = writeln!(
        text,
        "A virtual Citation X, tail N750CF: {flights} cruise reports, a flight-planning guide whose drag is wrong, and \
         static points written to {}.\nThe first {TEACHING_FLIGHTS} flights are learnt, the others are used for evaluation.\n",
        show(folder)
    );
    let model = folder.join("MODEL.ron");
    let initial = init::run(&InitArgs {
        json: JsonFlag::default(),
        sensors: None,
        accept: false,
        aircraft: folder.join("AIRCRAFT.ron"),
        guide: folder.join("guide.csv"),
        output: model.clone(),
        force: true,
    })?;
    let _ = writeln!(
        text,
        "$ cruisefit init --aircraft AIRCRAFT.ron --guide guide.csv -o MODEL.ron\n{}",
        initial.text
    );
    let reports = reports_below(&folder.join("reports/N750CF"))?;
    let (teaching, judging) = reports.split_at(TEACHING_FLIGHTS.min(reports.len()));
    let adapted = adapt_by_both_laws(folder, teaching, progress, &mut text)?;
    let judged: Vec<(String, PathBuf)> =
        std::iter::once(("initial model".to_owned(), model)).chain(adapted).collect();
    judge(folder, &judged, judging, &mut text)?;
    later_period(folder, progress, &mut text)?;
    let _ = writeln!(
        text,
        "\nLook at {} and {}; everything above can be run again by hand from {}.",
        show(&folder.join("adapted-bayes/report.html")),
        show(&folder.join("diagnosis/diagnosis.html")),
        show(folder)
    );
    let figures = serde_json::json!({
        "flights": flights, "teaching_flights": TEACHING_FLIGHTS, "written": [show(folder)],
    });
    Ok(Outcome::with_figures(text, figures))
}

/// The initial model adapted by each law: its name and where its model is.
fn adapt_by_both_laws(
    folder: &Path,
    teaching: &[PathBuf],
    progress: Progress,
    text: &mut String,
) -> Result<Vec<(String, PathBuf)>, Failure> {
    let mut models = Vec::new();
    for (law, threshold, arguments) in [
        (LawName::Bayes, None, "--law bayes"),
        (LawName::Paper, Some(1.0), "--law paper --threshold 1"),
    ] {
        let name = if law == LawName::Bayes { "bayes" } else { "paper" };
        let adapted = folder.join(format!("adapted-{name}"));
        let learnt = adapt::run(
            &AdaptArgs {
                json: JsonFlag::default(),
                accept: false,
                reports: reports_arguments(teaching),
                models: ModelArgs { models: vec![folder.join("MODEL.ron")] },
                output: adapted.clone(),
                law,
                threshold,
                no_remainder: false,
                relearn: false,
                restart: adapted.exists(),
                wait: false,
            },
            progress,
        )?;
        let _ = writeln!(
            text,
            "$ cruisefit adapt … --model MODEL.ron {arguments} -o adapted-{name}\n{}",
            learnt.text
        );
        models.push((format!("law {name}"), adapted.join("models/N750CF.ron")));
    }
    Ok(models)
}

/// Errors of every model on flights and static points that none of them has learnt.
fn judge(
    folder: &Path,
    judged: &[(String, PathBuf)],
    judging: &[PathBuf],
    text: &mut String,
) -> Result<(), Failure> {
    let _ = writeln!(text, "{} flights that no model has seen:", judging.len());
    for (name, path) in judged {
        let (errors, coverage) = unseen_errors(path, judging)?;
        let covered = coverage.map_or_else(String::new, |share| {
            format!("; {:.0} % of them within the stated 95 % interval", 100.0 * share)
        });
        let _ = writeln!(text, "  {name:<14} {}{covered}", in_words(&errors));
    }
    let _ = writeln!(text, "\n45 static points at three masses, between FL300 and FL450:");
    for (name, path) in judged {
        let predicted = folder.join(format!("static-{}.csv", name.replace(' ', "-")));
        let outcome = predict::run(&PredictArgs {
            json: JsonFlag::default(),
            mapping: None,
            model: path.clone(),
            points: folder.join("static.csv"),
            output: Some(predicted.clone()),
            table_only: false,
            without_deviations: false,
            columns: None,
        })?;
        let errors = errors_of(&predicted)?;
        let _ = writeln!(
            text,
            "  {name:<14} {}{}",
            in_words(&ErrorStatistics::from_errors(&errors)),
            match outcome.refused.len() {
                0 => String::new(),
                outside => format!("; {outside} outside the table"),
            }
        );
    }
    Ok(())
}

/// Flies the tail a year later with an effect that its model does not have, diagnoses it against the adapted model, does what
/// the diagnosis advises (the tank gauges are recorded too), and only then opens the truth.
fn later_period(folder: &Path, progress: Progress, text: &mut String) -> Result<(), Failure> {
    let later = folder.join("later");
    let without = simulated_reports::demonstration_later(Switch::Off)?;
    let flights = simulated_reports::write(&without, &later, progress)?.flights;
    let sealed = later.join("TRUTH.json");
    let hash = hash_of(&sealed)?;
    let _ = writeln!(
        text,
        "\nA year later, {flights} more flights: something about the aircraft has changed, and the model does not know \
         it.\nThe change is sealed in later/TRUTH.json, SHA-256 {hash}.\n"
    );
    diagnose_later(folder, "later", "diagnosis", progress, text)?;
    let with = simulated_reports::demonstration_later(Switch::On)?;
    simulated_reports::write(&with, &folder.join("later-gauges"), progress)?;
    let _ = writeln!(
        text,
        "As advised: the same flights with the tank gauges recorded (column FQ), as those that taught the model have them.\n"
    );
    diagnose_later(folder, "later-gauges", "diagnosis-gauges", progress, text)?;
    let opened = read_text(&sealed)?;
    let truth: ::simulate::Truth =
        serde_json::from_str(&opened).map_err(|error| Failure::bad_file(&sealed, error))?;
    let unchanged = if hash_of(&sealed)? == hash { "unchanged" } else { "CHANGED SINCE" };
    let planted: Vec<String> = truth
        .tails
        .iter()
        .flat_map(|tail| &tail.effects)
        .map(|effect| format!("{} {:+}", effect.id, effect.size))
        .collect();
    let _ = writeln!(text, "The seal is opened ({unchanged}). The truth: {}.", planted.join(", "));
    Ok(())
}

/// Diagnoses a folder of later flights against the model that law `bayes` has adapted.
fn diagnose_later(
    folder: &Path,
    flights: &str,
    output: &str,
    progress: Progress,
    text: &mut String,
) -> Result<(), Failure> {
    let found = diagnose::run(
        &DiagnoseArgs {
            json: JsonFlag::default(),
            events: None,
            accept: false,
            reports: reports_arguments(&[folder.join(flights).join("N750CF")]),
            models: ModelArgs { models: vec![folder.join("adapted-bayes/models/N750CF.ron")] },
            output: folder.join(output),
            effects: vec![],
            without: vec![],
            apply: None,
            pool: false,
            fleet: false,
            table_only: false,
            allow_learnt: false,
        },
        progress,
    )?;
    let _ = writeln!(
        text,
        "$ cruisefit diagnose {flights}/N750CF --model adapted-bayes/models/N750CF.ron -o {output}\n{}",
        found.text
    );
    Ok(())
}

fn hash_of(path: &Path) -> Result<String, Failure> {
    Ok(sha256(read_text(path)?.as_bytes()))
}

fn reports_arguments(reports: &[PathBuf]) -> ReportsArgs {
    ReportsArgs {
        reports: reports.to_vec(),
        mapping: None,
        criteria: crate::criteria::NamedCriteria::default(),
        strict: true,
    }
}

fn reports_below(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    Ok(crate::inputs::collect(&[folder.to_owned()], None)?.files)
}

fn unseen_errors(
    model: &Path,
    reports: &[PathBuf],
) -> Result<(ErrorStatistics, Option<f64>), Failure> {
    let arguments = EvaluateArgs {
        reports: reports_arguments(reports),
        models: ModelArgs { models: vec![model.to_owned()] },
        json: JsonOutput::default(),
        output: None,
        fuel_factors: None,
        table_only: false,
    };
    let summary = evaluate::evaluate(&arguments, Progress::Hidden)?.summary;
    Ok(summary.tails.first().map_or((ErrorStatistics::from_errors(&[]), None), |tail| {
        (tail.fuel_flow_error_percent.before, tail.interval95_coverage)
    }))
}

fn in_words(errors: &ErrorStatistics) -> String {
    let figure = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:+.2}"));
    let plain = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.2}"));
    format!(
        "mean error {} %, standard deviation {} %, largest {} % (n {})",
        figure(errors.mean),
        plain(errors.std),
        plain(errors.max_abs),
        errors.n
    )
}

/// The errors that `predict` wrote next to the measured fuel flows.
fn errors_of(path: &Path) -> Result<Vec<f64>, Failure> {
    let wrong = |error: csv::Error| Failure::bad_file(path, error);
    let mut reader = csv::Reader::from_path(path).map_err(wrong)?;
    let place = reader.headers().map_err(wrong)?.iter().position(|name| name == "error_percent");
    let mut errors = Vec::new();
    for record in reader.records() {
        let record = record.map_err(wrong)?;
        let field = place.and_then(|place| record.get(place)).unwrap_or_default();
        errors.extend(field.parse::<f64>().ok());
    }
    Ok(errors)
}
