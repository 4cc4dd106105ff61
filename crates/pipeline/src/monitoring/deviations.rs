//! A tail's flights in the order of flying, and the conditions to which their deviations are normalised.

use flight::{Segment, Timestamp};
use monitor::CONDITIONS;

use super::flights::{
    MeanConditions, MonitoredFlight, flights_of, flights_with, monitored, sort,
    with_those_without_segment,
};
use crate::evaluation::{BookEffects, TailResult, evaluate_book, evaluate_model};
use crate::learning::{LearningCurve, LearningError, curve_of};
use crate::model_file::ModelFile;
use crate::whole_model::Predicts;

/// Whether the model is rebuilt flight by flight, which takes a table per flight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BeforeLearning {
    /// Rebuild it, where what it said was not kept.
    #[default]
    Rebuild,
    /// Leave it out.
    LeaveOut,
}

impl BeforeLearning {
    /// Left out where that is asked for.
    #[must_use]
    pub const fn left_out(asked: bool) -> Self {
        if asked { Self::LeaveOut } else { Self::Rebuild }
    }
}

/// A tail's flights in the order of flying.
#[derive(Clone, Debug, PartialEq)]
pub struct TailDeviations {
    /// Type code of the aircraft.
    pub aircraft_type: String,
    /// What the model has learnt, in words.
    pub model: String,
    /// The flights.
    pub flights: Vec<MonitoredFlight>,
    /// What they are normalised to: means over all segments of the tail inside the table.
    pub reference: MeanConditions,
    /// What the learnt model predicts more than the book, mean over the same segments, %.
    pub level_percent: f64,
    /// What they are normalised to, flight by flight: conditions as `monitor` has them, and segments inside the table.
    pub of_level: Vec<([f64; CONDITIONS], f64)>,
}

impl TailDeviations {
    /// What the segments of a tail show, which are in the order in which its model learnt them.
    ///
    /// # Errors
    /// A model that cannot learn its own flights again (a damaged file).
    pub fn new(
        model: &ModelFile,
        segments: &[Segment],
        before_learning: BeforeLearning,
    ) -> Result<Self, LearningError> {
        let curve = match before_learning {
            BeforeLearning::Rebuild => curve_of(model, segments)?,
            BeforeLearning::LeaveOut => LearningCurve::new(),
        };
        let book = evaluate_book(model, BookEffects::OfModel, segments);
        let learnt = evaluate_model(model, Predicts::WholeModel, segments);
        let aircraft = model.initial.aircraft();
        let flights = monitored(segments.iter().zip(book), &learnt, &curve, aircraft.engines());
        let flights = with_those_without_segment(model, flights);
        Ok(Self::of_flights(aircraft.type_code(), &model.told(), flights))
    }

    /// The same of a tail at the end of a run, whose segments have been predicted.
    #[must_use]
    pub fn of_result(result: &TailResult, before_learning: BeforeLearning) -> Self {
        let flights = match before_learning {
            BeforeLearning::Rebuild => flights_of(result),
            BeforeLearning::LeaveOut => flights_with(result, &LearningCurve::new()),
        };
        let of_type = result.model.initial.aircraft().type_code();
        Self::of_flights(of_type, &result.model.told(), flights)
    }

    /// Only the flights that began at or after an instant, if there is one; at the conditions of all flights all the same, so that
    /// no level moves with the window.
    #[must_use]
    pub fn since(mut self, instant: Option<Timestamp>) -> Self {
        if let Some(instant) = instant {
            self.flights.retain(|flight| flight.start >= instant);
        }
        self
    }

    /// The flights of a tail of this type, whose model has learnt so much in words.
    ///
    /// ```text
    /// normalised d = 100·[ln Wf − ln Ŵf_learnt] + mean over all segments of 100·[ln Ŵf_learnt − ln Ŵf_book]   [monitoring.16]
    /// ```
    ///
    /// The learnt model knows how fuel flow depends on conditions; the book is the level from which is counted.
    #[must_use]
    pub fn of_flights(aircraft_type: &str, model: &str, mut flights: Vec<MonitoredFlight>) -> Self {
        sort(&mut flights);
        let reference = MeanConditions::mean_of(flights.iter().map(|flight| flight.conditions));
        let over = flights
            .iter()
            .map(|flight| flight.conditions.segments as f64 * flight.learnt_over_book_percent);
        let conditions = flights.iter().map(|flight| flight.conditions);
        let of_level = conditions
            .filter(|conditions| conditions.segments > 0)
            .map(|conditions| (conditions.to_monitor(&reference), conditions.segments as f64));
        Self {
            of_level: of_level.collect(),
            aircraft_type: aircraft_type.to_owned(),
            model: model.to_owned(),
            reference,
            level_percent: over.sum::<f64>() / reference.segments.max(1) as f64,
            flights,
        }
    }
}
