//! A model's drag for other programs: OpenAP, JSBSim, and as JSON for any language.
//!
//! Drag alone is handed on: neither the effects that a model contains nor its remainder are in a table. What is left out of a model
//! that has learnt more than a table is stated with its size ([`remainder_left_out`]).

mod jsbsim;
mod json;
mod openap;
mod remainder;

pub use jsbsim::jsbsim;
pub use json::{SCHEMA, json};
pub use openap::{OpenapError, OpenapPolar, openap};
pub use remainder::{LeftOut, remainder_left_out};

use perf_model::{GuideLevels, GuidePlace};
use units::PressureAltitude;

use crate::model_file::ModelFile;
use crate::optimum::mass_at_kg;
use crate::summary::counted;

/// Which nodes guide or learnt flights inform.
pub(crate) fn informed(model: &ModelFile) -> Vec<bool> {
    let by_flights = model.learnt.as_ref().map(|learnt| learnt.law.informed());
    let by_guide = model.initial.extrapolated().iter().map(|extrapolated| !extrapolated);
    by_guide
        .enumerate()
        .map(|(node, by_guide)| {
            by_guide || by_flights.as_ref().is_some_and(|informed| informed[node])
        })
        .collect()
}

/// What the table of a model that has learnt nothing, the polynomial through its guide's rows, misses of the drag of these rows at
/// the nodes within the guide, %: root mean square, and the largest; `None` once a segment has taught it, and where the file does
/// not keep the rows. Where drag has a factor by level, at every level at which the guide has the node's mass.
#[must_use]
pub fn rows_missed(model: &ModelFile) -> Option<[f64; 2]> {
    let rows = model.untaught_rows()?;
    let polynomial = model.initial.drag_table();
    let extrapolated = model.initial.extrapolated();
    let mut percents = Vec::new();
    for node in (0..polynomial.grid().nodes()).filter(|&node| !extrapolated[node]) {
        let by_polynomial = polynomial.value_at_node(node);
        let by_rows = rows.drag_table().value_at_node(node);
        let percent = |factor: f64| 100.0 * (by_polynomial / (factor * by_rows) - 1.0);
        match rows.base().levels() {
            Some(levels) => percents.extend(factors_at(model, levels, node).map(percent)),
            None => percents.push(percent(1.0)),
        }
    }
    rms_and_largest(&percents)
}

/// Factors at a node, by the levels at which the guide has its mass.
fn factors_at(model: &ModelFile, levels: &GuideLevels, node: usize) -> impl Iterator<Item = f64> {
    let (lift_coefficient, mach) = model.grid().coordinates(node);
    let masses_kg = model.guide.mass_kg;
    levels.levels().iter().filter_map(move |level| {
        let pressure_altitude = PressureAltitude::meters(level.pressure_altitude_m);
        let place = GuidePlace { lift_coefficient, mach, pressure_altitude };
        let mass_kg = mass_at_kg(model, place)?;
        let is_printed = masses_kg.is_none_or(|(low, high)| (low..=high).contains(&mass_kg));
        is_printed.then(|| levels.factor(place))
    })
}

/// Root mean square of what an export misses, and the largest of it without its sign; `None` of nothing.
pub(crate) fn rms_and_largest(percents: &[f64]) -> Option<[f64; 2]> {
    let largest = percents.iter().map(|percent| percent.abs()).reduce(f64::max)?;
    let squares: f64 = percents.iter().map(|percent| percent * percent).sum();
    Some([(squares / percents.len() as f64).sqrt(), largest])
}

/// The model's name, tail and number of learnt flights, for a comment.
fn origin(model: &ModelFile) -> String {
    let aircraft = model.initial.aircraft();
    let learnt = model.learnt.as_ref().map_or_else(
        || "initial model, nothing learnt".to_owned(),
        |learnt| format!("tail {}, {} learnt", learnt.tail, counted(learnt.ledger.len(), "flight")),
    );
    format!("{} ({}), {learnt}", aircraft.name(), aircraft.type_code())
}

#[cfg(test)]
mod tests;
