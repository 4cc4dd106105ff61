//! `cruisefit guide`: aircraft file and guide of a public model of the type.

use std::fmt::Write;
use std::path::Path;

use perf_model::poll_schumann::{self, Parameters, STATED_ACCURACY_PERCENT, guide::PublicGuide};
use pipeline::public_guide::{accuracy, aircraft_text, is_public};

use crate::args::GuideArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::outputs::would_lose;
use crate::files::{make_folder, write_atomically};

/// Runs the command.
///
/// # Errors
/// A type without a public model, or a folder that cannot be written.
pub(crate) fn run(arguments: &GuideArgs) -> Result<Outcome, Failure> {
    let (Some(code), Some(folder)) = (&arguments.type_code, &arguments.output) else {
        return Ok(Outcome::with_figures(list(), types()));
    };
    let Some(parameters) = poll_schumann::find(code) else {
        return Err(Failure::BadArgument {
            argument: "--type",
            reason: format!(
                "no public model of {code}{}; `cruisefit guide --list` shows the types",
                meant(code)
            ),
        });
    };
    if let Some(engines) = &arguments.engines {
        check_engines(engines, code, parameters)?;
    }
    let bad = |reason: String| Failure::BadArgument { argument: "--type", reason };
    let code = code.to_ascii_uppercase();
    let guide =
        poll_schumann::guide::guide(&code, parameters).map_err(|error| bad(error.to_string()))?;
    let aircraft = aircraft_text(&guide, parameters).map_err(|error| bad(error.to_string()))?;
    make_folder(folder)?;
    let (aircraft_path, guide_path) = (folder.join("AIRCRAFT.ron"), folder.join("guide.csv"));
    let is_own = std::fs::read_to_string(&aircraft_path).is_ok_and(|known| is_public(&known));
    for path in [&aircraft_path, &guide_path] {
        if path.exists() && !is_own {
            would_lose(path, "an operator's own file")?;
        }
    }
    write_atomically(&aircraft_path, aircraft.as_bytes())?;
    write_atomically(&guide_path, guide.to_csv().as_bytes())?;
    Ok(Outcome::with_figures(text(&guide, parameters, folder), figures(&guide, parameters, folder)))
}

/// Refuses a public model of another number of engines.
fn check_engines(engines: &str, code: &str, parameters: &Parameters) -> Result<(), Failure> {
    let bad = |reason: String| Failure::BadArgument { argument: "--engines", reason };
    let Ok(number) = engines.parse::<u8>() else {
        return Err(bad(format!(
            "expected the number of engines, found {engines:?}: the public model knows no engine options; how far a tail's engines \
             are from it, `cruisefit adapt` finds from flights"
        )));
    };
    if number != parameters.engines {
        return Err(bad(format!(
            "the public model of {} has {} engines, not {number}",
            code.to_ascii_uppercase(),
            parameters.engines
        )));
    }
    Ok(())
}

fn text(guide: &PublicGuide, parameters: &Parameters, folder: &Path) -> String {
    let mut text = format!("{} ({})", guide.aircraft.name, guide.aircraft.type_code);
    if !parameters.is_of(&guide.aircraft.type_code) {
        let _ = write!(text, ", represented by {}", parameters.type_code);
    }
    let _ = write!(
        text,
        ": {} points, {} engines.\n\
         Source: Poll and Schumann, The Aeronautical Journal 125 (1284), 2021. {}; engine option and age of a tail are not in it.\n\
         The TSFC law misses the model's engine by {:.1} % (root mean square).\n\
         Written to {folder}: AIRCRAFT.ron, guide.csv. Next:\n    \
         cruisefit init --aircraft {folder}/AIRCRAFT.ron --guide {folder}/guide.csv -o MODEL.ron\n",
        guide.points.len(),
        parameters.engines,
        accuracy(guide, parameters),
        guide.tsfc_residual_percent,
        folder = show(folder)
    );
    text
}

fn figures(guide: &PublicGuide, parameters: &Parameters, folder: &Path) -> serde_json::Value {
    serde_json::json!({
        "aircraft": guide.aircraft.name,
        "type": guide.aircraft.type_code,
        "represented_by": parameters.type_code,
        "guide_points": guide.points.len(),
        "engines": parameters.engines,
        "stated_accuracy_percent": parameters.is_of(&guide.aircraft.type_code).then_some(STATED_ACCURACY_PERCENT),
        "tsfc_residual_rms_percent": guide.tsfc_residual_percent,
        "written": [show(&folder.join("AIRCRAFT.ron")), show(&folder.join("guide.csv"))],
    })
}

/// The types of the list.
fn types() -> serde_json::Value {
    let types: Vec<serde_json::Value> = poll_schumann::types()
        .iter()
        .map(|one| {
            serde_json::json!({
                "type": one.type_code,
                "manufacturer": one.manufacturer,
                "variant": one.variant,
                "engines": one.engines,
                "also": one.stands_for().collect::<Vec<_>>(),
            })
        })
        .collect();
    serde_json::json!({ "types": types })
}

fn meant(code: &str) -> String {
    let types = poll_schumann::types();
    report::nearest(code, types.iter().map(|one| one.type_code.as_str()))
        .map_or_else(String::new, |name| format!("; did you mean {name}?"))
}

fn list() -> String {
    let mut text = String::new();
    for parameters in poll_schumann::types() {
        let Parameters { type_code, manufacturer, variant, .. } = parameters;
        let _ = write!(text, "{type_code}  {manufacturer} {variant}");
        let also: Vec<&str> = parameters.stands_for().collect();
        if !also.is_empty() {
            let _ = write!(text, "; also {}", also.join(", "));
        }
        text.push('\n');
    }
    text
}
