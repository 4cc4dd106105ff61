//! `cruisefit optimum`: what a flight management system would fly with a model, and with the book.

use std::borrow::Cow;
use std::fmt::Write;
use std::path::Path;

use pipeline::model_file::ModelFile;
use pipeline::optimum::{
    self, ConditionOptimum, CostIndex, DRAWS, MassAndDay, OptimumDocument, OptimumModel, Question,
};
use rayon::prelude::*;
use units::{Mass, PressureAltitude, TemperatureDifference, TrueAirspeed};

use crate::args::OptimumArgs;
use crate::columns;
use crate::commands::Outcome;
use crate::failure::{Failure, RefusedReport, show};
use crate::files::is_device_or_pipe;
use crate::files::outputs::write_result;
use crate::models::read_model;

/// Seed of the models drawn for the intervals: the same model gives the same intervals.
const SEED: u64 = 1;

/// Levels that are asked for: a flight level in hundreds of feet is none of them.
const LEVELS_FT: (f64, f64, &str) = (5_000.0, 65_000.0, "ft");
/// Winds along the track: what is beyond was never flown in.
const TAILWINDS_KT: (f64, f64, &str) = (-400.0, 400.0, "kt");
/// Days, as flight points have them.
const DAYS_K: (f64, f64, &str) = (-50.0, 50.0, "K");

/// Fuel flow of the optima that is further from that of `predict`, %, is warned of. Our choice.
const FAR_FROM_PREDICT_PERCENT: f64 = 0.5;

/// Runs the command.
///
/// # Errors
/// A reason for which nothing was done.
pub(crate) fn run(arguments: &OptimumArgs) -> Result<Outcome, Failure> {
    check_endings(&arguments.output)?;
    let file = read_model(&arguments.model)?;
    let file = file.to_plan_with();
    let is_by_rows = matches!(file, Cow::Owned(_));
    let model = OptimumModel::new(&file, DRAWS, SEED)
        .map_err(|error| Failure::bad_file(&arguments.model, error))?;
    let masses = match &arguments.mass_kg[..] {
        [] => optimum::usual_masses(&file).unwrap_or_default(),
        given => {
            let given = each_once(positive("--mass-kg", given)?);
            warn_of_masses(&file, &given);
            given.into_iter().map(Mass::kilograms).collect()
        }
    };
    let mut levels = match &arguments.levels[..] {
        [] => optimum::usual_levels(&file),
        given => {
            let given = each_once(within("--levels", given, LEVELS_FT)?);
            given.into_iter().map(PressureAltitude::feet).collect()
        }
    };
    levels.sort_by(|one, other| one.to_feet().total_cmp(&other.to_feet()));
    let cost_index = arguments.cost_index.map(CostIndex::kilograms_per_minute);
    let tailwinds = each_once(within("--tailwind", &arguments.tailwind, TAILWINDS_KT)?);
    let question = Question {
        levels,
        tailwinds: tailwinds.into_iter().map(TrueAirspeed::knots).collect(),
        cost_index,
    };
    let days = each_once(within("--isa-deviation", &arguments.isa_deviation, DAYS_K)?);
    let asked: Vec<MassAndDay> = masses
        .iter()
        .flat_map(|mass| {
            days.iter().map(|day| MassAndDay {
                mass: *mass,
                isa_deviation: TemperatureDifference::kelvin(*day),
            })
        })
        .collect();
    let found: Vec<Vec<ConditionOptimum>> =
        asked.par_iter().map(|condition| optimum::at(&model, *condition, &question)).collect();
    let conditions: Vec<ConditionOptimum> = found.into_iter().flatten().collect();
    let json = OptimumDocument::new(&file, cost_index, &conditions)
        .to_json()
        .map_err(|error| Failure::bad_file(&arguments.model, error))?;
    for path in &arguments.output {
        write(path, &json, &conditions)?;
    }
    let highest = optimum::highest_known_level(&file).map(PressureAltitude::to_feet);
    let mut text = optimum::table(&conditions, highest);
    if is_by_rows {
        text.push_str(
            "The model has learnt nothing: it is the book itself, the drag of its guide's rows. `predict` goes by the polynomial through \
             them until flights are learnt.\n",
        );
    } else if file.learnt.is_none() {
        text.push_str("The model has learnt nothing: it is the book itself.\n");
    } else if file.posterior().is_none() {
        text.push_str(
            "Law paper does not say how well it knows its table: there are no intervals.\n",
        );
    }
    for path in &arguments.output {
        let _ = writeln!(text, "Written to {}", show(path));
    }
    warn_of_surface(&file, &conditions);
    let refused = optimum::without_optimum(&conditions).into_iter();
    let refused = refused.map(|reason| RefusedReport::whole(arguments.model.clone(), reason));
    Ok(Outcome { refused: refused.collect(), ..Outcome::with_json(text, json) })
}

/// In the order given: what is asked for twice is answered once.
fn each_once(mut values: Vec<f64>) -> Vec<f64> {
    let mut known: Vec<f64> = Vec::with_capacity(values.len());
    values.retain(|value| {
        let is_new = !known.contains(value);
        known.push(*value);
        is_new
    });
    values
}

/// A lift coefficient and a Mach number are inside a table at any mass, if only the level is low enough: pounds in place of kilograms
/// give an optimum too.
fn warn_of_masses(file: &ModelFile, masses_kg: &[f64]) {
    let Some((low_kg, high_kg)) = optimum::known_masses_kg(file) else { return };
    for mass_kg in masses_kg.iter().filter(|mass_kg| !(low_kg..=high_kg).contains(*mass_kg)) {
        tracing::warn!(
            "--mass-kg {mass_kg}: guide and flights have {low_kg:.0} to {high_kg:.0} kg; what is said of it is continued from there"
        );
    }
}

/// Between nodes that bend evenly a smooth surface is nearer to the truth than chords; between such as law `paper` leaves it
/// overshoots, and an optimum is drawn to where it does.
fn warn_of_surface(file: &ModelFile, conditions: &[ConditionOptimum]) {
    let largest = optimum::largest_against_predict_percent(conditions);
    let Some(percent) = largest.filter(|percent| *percent > FAR_FROM_PREDICT_PERCENT) else {
        return;
    };
    let is_by_law_paper = file.learnt.is_some() && file.posterior().is_none();
    let why = if is_by_law_paper {
        "law paper leaves neighbouring nodes of the table so far apart that a smooth surface through them overshoots, and its \
         optima may be no aircraft's"
    } else {
        "the nodes of the table are so far apart that the chords of `predict` leave the smooth surface"
    };
    tracing::warn!(
        "fuel flow at these optima is up to {percent:.2} % from what `predict` states with the same drag: {why}"
    );
}

fn write(path: &Path, json: &str, conditions: &[ConditionOptimum]) -> Result<(), Failure> {
    if ending(path) == Some("json") {
        write_result(path, json.as_bytes())
    } else {
        columns::write(&optimum::columns(conditions), Some(path))
    }
}

/// Before anything is computed.
fn check_endings(paths: &[std::path::PathBuf]) -> Result<(), Failure> {
    let is_known = |path: &std::path::PathBuf| {
        matches!(ending(path), Some("csv" | "parquet" | "json"))
            || path.as_os_str() == "-"
            || is_device_or_pipe(path)
    };
    let wrong = paths.iter().find(|path| !is_known(path));
    wrong.map_or(Ok(()), |path| {
        Err(Failure::BadArgument {
            argument: "--output",
            reason: format!("{} ends neither in .csv nor in .parquet nor in .json", path.display()),
        })
    })
}

fn ending(path: &Path) -> Option<&str> {
    path.extension().and_then(|ending| ending.to_str())
}

fn within(
    argument: &'static str,
    values: &[f64],
    (least, most, unit): (f64, f64, &str),
) -> Result<Vec<f64>, Failure> {
    match values.iter().find(|value| !(least..=most).contains(*value)) {
        None => Ok(values.to_vec()),
        Some(value) => Err(Failure::BadArgument {
            argument,
            reason: format!("found {value}, expected {least} to {most} {unit}"),
        }),
    }
}

fn positive(argument: &'static str, values: &[f64]) -> Result<Vec<f64>, Failure> {
    match values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
        None => Ok(values.to_vec()),
        Some(value) => Err(Failure::BadArgument {
            argument,
            reason: format!("found {value}, expected positive numbers"),
        }),
    }
}
