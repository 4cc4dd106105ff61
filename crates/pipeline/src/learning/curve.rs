//! How far off a model was on each flight before it learnt it.

use std::collections::BTreeMap;

use flight::{Observation, Segment, Timestamp};
use monitor::FlightDeviation;

use super::{LearningAgain, LearningError};
use crate::evaluation::{evaluate, evaluated};
use crate::model_file::ModelFile;
use crate::segments_table::Evaluated;

/// A flight among those of a tail: START and name.
pub type FlightKey = (Timestamp, String);

/// How far off the drag table was on a flight before it learnt it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Mean of 100·ln(recorded/predicted) fuel flow over the segments inside the table, and their scatter.
    pub deviation: FlightDeviation,
    /// Mean of 100·(recorded − predicted)/recorded fuel flow over the same, %.
    pub mean_error_percent: f64,
}

/// The forecast of each flight; nothing of a flight without a segment inside the table.
pub type LearningCurve = BTreeMap<FlightKey, Forecast>;

/// 100·ln(recorded/predicted); `None` where one of them is not positive.
pub(crate) fn deviation_percent(recorded_kg_s: f64, predicted_kg_s: f64) -> Option<f64> {
    (recorded_kg_s > 0.0 && predicted_kg_s > 0.0)
        .then(|| 100.0 * (recorded_kg_s / predicted_kg_s).ln())
}

/// The curve of a model whose flights' segments these are, in the order in which they were learnt: up to the first flight whose
/// segments are missing. Empty for a model that has learnt nothing.
///
/// Exact, the same flights in the same order by the same settings as the model has learnt them, but where a flight's date was
/// taken for an error: it is learnt here as recorded.
///
/// # Errors
/// A model that cannot learn its own flights again (a damaged file).
pub fn curve_of(model: &ModelFile, segments: &[Segment]) -> Result<LearningCurve, LearningError> {
    let mut curve = LearningCurve::new();
    let (Some(known), Some(again)) = (&model.learnt, LearningAgain::new(model)?) else {
        return Ok(curve);
    };
    // The flights of the ledger in its order, as far as all of their segments are there.
    let mut ledger = known.ledger.iter().filter(|entry| entry.segments > 0);
    let learnt =
        segments.chunk_by(|one, other| one.identity == other.identity).take_while(|flight| {
            let identity = &flight[0].identity;
            ledger.next().is_some_and(|entry| {
                entry.flight == identity.flight
                    && entry.start == identity.start.to_string()
                    && entry.segments == flight.len() as u64
            })
        });
    continue_curve(&mut curve, again, learnt.map(|flight| (flight, flight)))?;
    Ok(curve)
}

/// Goes on with flights that were learnt one after the other: each as it was recorded, and as it was learnt (its date may have
/// been taken for an error).
///
/// # Errors
/// As for [`curve_of`].
pub(crate) fn continue_curve<'s>(
    curve: &mut LearningCurve,
    mut again: LearningAgain<'_>,
    flights: impl Iterator<Item = (&'s [Segment], &'s [Segment])>,
) -> Result<(), LearningError> {
    for (recorded, as_learnt) in flights {
        let Some(first) = recorded.first() else { continue };
        let observations = again.observe(as_learnt);
        let predicted = predicted(&again, (recorded, as_learnt), &observations)?;
        let start = first.identity.start;
        if let Some(forecast) = forecast(start, recorded, &predicted) {
            curve.insert((start, first.identity.flight.clone()), forecast);
        }
        again.learn_observed(&observations)?;
    }
    Ok(())
}

/// What the table says now of a flight as it was recorded; given what its segments say as they are learnt, which mostly is the
/// same.
fn predicted(
    again: &LearningAgain<'_>,
    (recorded, as_learnt): (&[Segment], &[Segment]),
    observations: &[Option<Observation>],
) -> Result<Vec<Option<Evaluated>>, LearningError> {
    let table = again.table()?;
    // Effects may be shares of the table's own drag.
    if again.initial().effects().is_some() || !std::ptr::eq(recorded, as_learnt) {
        return Ok(evaluate(again.initial(), &table, recorded));
    }
    let segments = recorded.iter().zip(observations);
    Ok(segments.map(|(segment, said)| Some(evaluated(&table, segment, said.as_ref()?))).collect())
}

fn forecast(
    start: Timestamp,
    segments: &[Segment],
    predicted: &[Option<Evaluated>],
) -> Option<Forecast> {
    let shown: Vec<(f64, f64)> = segments
        .iter()
        .zip(predicted)
        .filter_map(|(segment, predicted)| {
            let predicted = (*predicted)?;
            let recorded = segment.means.fuel_flow_total_kg_s;
            let deviation = deviation_percent(recorded, predicted.predicted_fuel_flow_kg_s?)?;
            Some((deviation, predicted.error_percent?))
        })
        .collect();
    let deviations: Vec<f64> = shown.iter().map(|(deviation, _)| *deviation).collect();
    let errors = shown.iter().map(|(_, error)| error);
    Some(Forecast {
        deviation: FlightDeviation::of_segments(start, &deviations)?,
        mean_error_percent: errors.sum::<f64>() / shown.len() as f64,
    })
}
