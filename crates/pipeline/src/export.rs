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

use crate::model_file::ModelFile;
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
/// not keep the rows.
#[must_use]
pub fn rows_missed(model: &ModelFile) -> Option<[f64; 2]> {
    let rows = model.untaught_rows()?.drag_table().values();
    let nodes = model.initial.drag_table().values().iter().zip(rows);
    let nodes = nodes.zip(model.initial.extrapolated()).filter(|(_, extrapolated)| !**extrapolated);
    let percents = nodes.map(|((polynomial, row), _)| 100.0 * (polynomial / row - 1.0));
    rms_and_largest(&percents.collect::<Vec<f64>>())
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
