//! Residuals of any model on any flights, segment by segment, and by the model *before* it learnt the flight.
//!
//! A model that has learnt a flight predicts it better than it would have before. Where the ledger holds a flight, the
//! model is learnt again from its initial part, flight by flight in the ledger's order, and every flight is predicted
//! before it is learnt. That needs the reports of all flights up to it: from the first ledger entry whose report is not
//! among those given, flights can only be predicted by the model that has learnt them, and their rows say so.

use std::collections::BTreeMap;

use flight::{FlightIdentity, Segment};

use crate::columns::Columns;
use crate::evaluation::evaluate;
use crate::learning::{LearningAgain, LearningError};
use crate::model_file::{LedgerEntry, ModelFile};
use crate::segments_table::Evaluated;
use crate::statistics::NORMAL_95;
use crate::whole_model::{HeldByTable, Predicts, SegmentHeld};

/// What the model that predicted a flight knew of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Knowledge {
    /// The model as given, which has not learnt the flight.
    NotLearnt,
    /// The model's drag table as it was before it learnt the flight, learnt again for that.
    BeforeLearning,
    /// The model as given, which has learnt the flight: an earlier report of its ledger is missing.
    Learnt,
}

impl Knowledge {
    /// The word in files.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Self::NotLearnt => "not_learnt",
            Self::BeforeLearning => "before_learning",
            Self::Learnt => "learnt",
        }
    }
}

/// A flight as given: its segments, in time order, and the SHA-256 of its report.
#[derive(Clone, Copy, Debug)]
pub struct GivenFlight<'a> {
    /// Who and when.
    pub identity: &'a FlightIdentity,
    /// SHA-256 of the report's bytes.
    pub content: &'a str,
    /// Segments.
    pub segments: &'a [Segment],
}

/// The residuals of one flight.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightResiduals {
    /// What the model knew.
    pub knowledge: Knowledge,
    /// What it says of each segment.
    pub evaluated: Vec<Option<Evaluated>>,
    /// How far it expects to err; `None` where a table alone predicts.
    pub expected: Option<ExpectedErrors>,
}

/// How far a model expects to err on one new flight.
#[derive(Clone, Debug, PartialEq)]
pub struct ExpectedErrors {
    /// Of each segment; `None` outside its table or a domain.
    pub segments: Vec<Option<ExpectedError>>,
    /// Half the width of the 95 % interval of the flight's mean error, %; `None` where a table alone predicts.
    pub flight_half_width95_percent: Option<f64>,
}

/// How far a model expects to err on one new segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedError {
    /// Half the width of the 95 % interval of its error, %.
    pub half_width95_percent: f64,
    /// Whether it lies beyond what the flights that were learnt have flown; `None` where a table alone predicts.
    pub beyond_flights: Option<bool>,
}

impl ExpectedErrors {
    /// Of the segments of one flight: by the whole model, or by a table of law `bayes`; `None` where neither is there.
    fn new(model: &ModelFile, predicts: Predicts, segments: &[Segment]) -> Option<Self> {
        let Some(whole) = model.whole(predicts) else { return Self::by_table(model, segments) };
        let held: Vec<Option<SegmentHeld>> =
            segments.iter().map(|one| SegmentHeld::new(&whole, &model.initial, one)).collect();
        let half = |variance: f64| 100.0 * NORMAL_95 * variance.sqrt();
        let of_segment = |held: &SegmentHeld| ExpectedError {
            half_width95_percent: half(held.prediction.variance()),
            beyond_flights: Some(held.prediction.beyond_flights),
        };
        let of_flight = || {
            let predictions: Vec<_> = held.iter().flatten().map(|held| &held.prediction).collect();
            (!predictions.is_empty()).then(|| half(whole.variance_of_flight(&predictions)))
        };
        Some(Self {
            segments: held.iter().map(|held| held.as_ref().map(of_segment)).collect(),
            flight_half_width95_percent: of_flight(),
        })
    }

    fn by_table(model: &ModelFile, segments: &[Segment]) -> Option<Self> {
        let posterior = model.posterior()?;
        let of_segment = |segment| {
            let held = HeldByTable::new(&model.initial, posterior, segment)?;
            let half_width95_percent = 100.0 * NORMAL_95 * held.fuel_flow_deviation;
            Some(ExpectedError { half_width95_percent, beyond_flights: None })
        };
        Some(Self {
            segments: segments.iter().map(of_segment).collect(),
            flight_half_width95_percent: None,
        })
    }
}

/// The residuals of flights by the model before it learnt each of them, as far as the flights given allow it. `as_given`
/// is what the model as given says of each segment of each flight, `predicts` with which of its parts.
///
/// # Errors
/// As for [`learn_flight`](crate::learning::learn_flight), which do not happen on flights that were learnt before.
pub fn before_learning(
    model: &ModelFile,
    flights: &[GivenFlight<'_>],
    as_given: Vec<Vec<Option<Evaluated>>>,
    predicts: Predicts,
) -> Result<Vec<FlightResiduals>, LearningError> {
    let ledger = model.learnt.as_ref().map_or(&[][..], |learnt| &learnt.ledger);
    let mut found: Vec<FlightResiduals> = flights
        .iter()
        .zip(as_given)
        .map(|(flight, evaluated)| FlightResiduals {
            knowledge: if ledger.iter().any(|entry| is_of(entry, flight.identity)) {
                Knowledge::Learnt
            } else {
                Knowledge::NotLearnt
            },
            evaluated,
            expected: ExpectedErrors::new(model, predicts, flight.segments),
        })
        .collect();
    let Some(mut again) = LearningAgain::new(model)? else { return Ok(found) };
    let positions: BTreeMap<(&str, String, &str), usize> = flights
        .iter()
        .enumerate()
        .map(|(at, flight)| {
            let FlightIdentity { start, flight: name, .. } = flight.identity;
            ((name.as_str(), start.to_string(), flight.content), at)
        })
        .collect();
    for entry in ledger {
        let key = (entry.flight.as_str(), entry.start.clone(), entry.content.as_str());
        let Some(at) = positions.get(&key) else { break };
        let segments = flights[*at].segments;
        let table = again.table()?;
        found[*at] = FlightResiduals {
            knowledge: Knowledge::BeforeLearning,
            evaluated: evaluate(&model.initial, &table, segments),
            expected: None,
        };
        drop(table);
        again.learn(segments)?;
    }
    Ok(found)
}

fn is_of(entry: &LedgerEntry, identity: &FlightIdentity) -> bool {
    entry.tail == identity.tail
        && entry.flight == identity.flight
        && entry.start == identity.start.to_string()
}

/// One row per segment, with its flight's mean.
#[must_use]
pub fn columns(flights: &[(&[Segment], &FlightResiduals)]) -> Columns {
    struct Row<'a> {
        segment: &'a Segment,
        evaluated: Option<Evaluated>,
        expected: Option<ExpectedError>,
        knowledge: Knowledge,
        flight: Option<f64>,
        flight_half_width95: Option<f64>,
    }
    let rows: Vec<Row<'_>> = flights
        .iter()
        .flat_map(|(segments, residuals)| {
            let flight = mean_error(&residuals.evaluated);
            let expected = residuals.expected.as_ref();
            segments.iter().zip(&residuals.evaluated).enumerate().map(
                move |(place, (segment, evaluated))| Row {
                    segment,
                    evaluated: *evaluated,
                    expected: expected.and_then(|of| of.segments.get(place).copied().flatten()),
                    knowledge: residuals.knowledge,
                    flight,
                    flight_half_width95: expected.and_then(|of| of.flight_half_width95_percent),
                },
            )
        })
        .collect();
    let mut columns = Columns::default();
    columns.text("tail", rows.iter().map(|row| row.segment.identity.tail.clone()));
    columns.text("flight", rows.iter().map(|row| row.segment.identity.flight.clone()));
    columns.text("start", rows.iter().map(|row| row.segment.identity.start.to_string()));
    let mean = |of: fn(&flight::SegmentMeans) -> f64| {
        rows.iter().map(move |row| Some(of(&row.segment.means)))
    };
    columns.number("time_s", mean(|means| means.time_s));
    columns.number("pressure_altitude_m", mean(|means| means.pressure_altitude_m));
    columns.number("static_air_temperature_k", mean(|means| means.static_air_temperature_k));
    columns.number("mach", mean(|means| means.mach));
    columns.number("mass_kg", mean(|means| means.mass_kg));
    let said =
        |of: fn(Evaluated) -> Option<f64>| rows.iter().map(move |row| row.evaluated.and_then(of));
    columns.number("lift_coefficient", said(|e| Some(e.lift_coefficient)));
    columns.number("fuel_flow_kg_s", mean(|means| means.fuel_flow_total_kg_s));
    columns.number("predicted_fuel_flow_kg_s", said(|e| e.predicted_fuel_flow_kg_s));
    columns.number("error_percent", said(|e| e.error_percent));
    let expected = |of: fn(ExpectedError) -> Option<f64>| {
        rows.iter().map(move |row| row.expected.and_then(of))
    };
    columns.number("error_half_width95_percent", expected(|e| Some(e.half_width95_percent)));
    let beyond = |e: ExpectedError| e.beyond_flights.map(|beyond| f64::from(u8::from(beyond)));
    columns.number("beyond_flights", expected(beyond));
    columns.number("flight_mean_error_percent", rows.iter().map(|row| row.flight));
    columns
        .number("flight_mean_half_width95_percent", rows.iter().map(|row| row.flight_half_width95));
    columns.text("predicted_by", rows.iter().map(|row| row.knowledge.id().to_owned()));
    columns
}

/// Mean error of a flight's segments inside the table.
fn mean_error(evaluated: &[Option<Evaluated>]) -> Option<f64> {
    let errors: Vec<f64> =
        evaluated.iter().filter_map(|evaluated| evaluated.and_then(|e| e.error_percent)).collect();
    (!errors.is_empty()).then(|| errors.iter().sum::<f64>() / errors.len() as f64)
}
