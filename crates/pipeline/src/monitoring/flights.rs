//! What each flight shows against a tail's models: the initial one, the learnt one, and the learnt one as it was before that
//! flight. All that `monitor` needs of a flight.

use flight::{MAXIMUM_ENGINES, Segment, Timestamp};
use monitor::FlightDeviation;
use serde::{Deserialize, Serialize};

use crate::evaluation::TailResult;
use crate::learning::{Forecast, LearningCurve, deviation_percent};
use crate::segments_table::Evaluated;

/// One flight of a tail; deviations are 100·ln(recorded/predicted) fuel flow.
#[derive(Clone, Debug, PartialEq)]
pub struct MonitoredFlight {
    /// Its name.
    pub flight: String,
    /// START.
    pub start: Timestamp,
    /// Segments that the table holds.
    pub segments: usize,
    /// Segments outside the table, which show nothing.
    pub outside_table: usize,
    /// Against the initial model, at the conditions flown; `None` where no segment is inside the table, as for the others.
    pub initial: Option<FlightDeviation>,
    /// Against the learnt model.
    pub learnt: Option<FlightDeviation>,
    /// Against the model as it was before it learnt this flight.
    pub before_learning: Option<Forecast>,
    /// Of each engine that is recorded, against its share of the learnt model.
    pub engines: Vec<FlightDeviation>,
    /// Mean of what the learnt model predicts more than the initial one over the flight's segments, %.
    pub learnt_over_initial_percent: f64,
    /// Fuel used between the first and the last segment, kg.
    pub cruise_fuel_kg: f64,
    /// Conditions flown.
    pub conditions: MeanConditions,
}

/// Means over segments that both the initial and the learnt model predict, geometric where the quantity is positive by nature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeanConditions {
    /// Mean pressure altitude, m.
    pub pressure_altitude_m: f64,
    /// Mean Mach number.
    pub mach: f64,
    /// Mean static air temperature, K.
    pub static_air_temperature_k: f64,
    /// Mean gross mass, kg.
    pub mass_kg: f64,
    /// Geometric mean of true airspeed, m/s.
    pub true_airspeed_m_s: f64,
    /// Geometric mean of fuel flow by the initial model, kg/s.
    pub initial_fuel_flow_kg_s: f64,
    /// Segments.
    pub segments: usize,
}

impl MeanConditions {
    /// Of all segments of these together.
    #[must_use]
    pub fn mean_of(parts: impl Iterator<Item = Self>) -> Self {
        let mut sums = Self::default();
        for part in parts.filter(|part| part.segments > 0) {
            let count = part.segments as f64;
            sums.pressure_altitude_m += count * part.pressure_altitude_m;
            sums.mach += count * part.mach;
            sums.static_air_temperature_k += count * part.static_air_temperature_k;
            sums.mass_kg += count * part.mass_kg;
            sums.true_airspeed_m_s += count * part.true_airspeed_m_s.ln();
            sums.initial_fuel_flow_kg_s += count * part.initial_fuel_flow_kg_s.ln();
            sums.segments += part.segments;
        }
        let count = sums.segments.max(1) as f64;
        Self {
            pressure_altitude_m: sums.pressure_altitude_m / count,
            mach: sums.mach / count,
            static_air_temperature_k: sums.static_air_temperature_k / count,
            mass_kg: sums.mass_kg / count,
            true_airspeed_m_s: (sums.true_airspeed_m_s / count).exp(),
            initial_fuel_flow_kg_s: (sums.initial_fuel_flow_kg_s / count).exp(),
            segments: sums.segments,
        }
    }
}

/// What a segment shows; `None` where a prediction has no value.
#[derive(Clone, Copy, Debug)]
struct Shown<'s> {
    segment: &'s Segment,
    initial: Option<f64>,
    learnt: Option<f64>,
}

/// The flights of a tail that has learnt, in the order in which it learnt them.
#[must_use]
pub fn flights_of(result: &TailResult) -> Vec<MonitoredFlight> {
    flights_with(result, &result.learning_curve())
}

/// The same with this learning curve.
pub(super) fn flights_with(result: &TailResult, curve: &LearningCurve) -> Vec<MonitoredFlight> {
    let initial = result.rows.iter().map(|row| (&row.segment, row.evaluated));
    monitored(initial, &result.after, curve, result.model.initial.aircraft().engines())
}

/// The learning curve that flights hold.
#[must_use]
pub fn curve_of_flights(flights: &[MonitoredFlight]) -> LearningCurve {
    let shown = |flight: &MonitoredFlight| {
        Some(((flight.start, flight.flight.clone()), flight.before_learning?))
    };
    flights.iter().filter_map(shown).collect()
}

/// The flights of these segments, with what the initial model and, in the same order, the learnt one predicts for each.
pub(super) fn monitored<'s>(
    initial: impl Iterator<Item = (&'s Segment, Option<Evaluated>)>,
    learnt: &[Option<Evaluated>],
    curve: &LearningCurve,
    engines: usize,
) -> Vec<MonitoredFlight> {
    let shown: Vec<Shown<'s>> = initial
        .zip(learnt)
        .map(|((segment, initial), learnt)| {
            let deviation = |evaluated: Option<Evaluated>| {
                let predicted = evaluated?.predicted_fuel_flow_kg_s?;
                deviation_percent(segment.means.fuel_flow_total_kg_s, predicted)
            };
            Shown { segment, initial: deviation(initial), learnt: deviation(*learnt) }
        })
        .collect();
    shown
        .chunk_by(|one, other| one.segment.identity == other.segment.identity)
        .map(|flight| flight_of(flight, curve, engines))
        .collect()
}

fn flight_of(shown: &[Shown<'_>], curve: &LearningCurve, engines: usize) -> MonitoredFlight {
    let identity = &shown[0].segment.identity;
    let all = |of: &dyn Fn(&Shown<'_>) -> Option<f64>| -> Option<FlightDeviation> {
        let deviations: Vec<f64> = shown.iter().filter_map(of).collect();
        FlightDeviation::of_segments(identity.start, &deviations)
    };
    let by_engine = (0..engines.min(MAXIMUM_ENGINES)).map(|engine| {
        all(&|shown| Some(shown.learnt? + share_percent(shown.segment, engine, engines)?))
    });
    let fuel_used =
        |shown: Option<&Shown<'_>>| shown.map_or(0.0, |shown| shown.segment.means.fuel_used_kg);
    let inside = shown.iter().filter(|shown| shown.learnt.is_some()).count();
    let over: Vec<f64> = shown.iter().filter_map(|one| Some(one.initial? - one.learnt?)).collect();
    MonitoredFlight {
        flight: identity.flight.clone(),
        start: identity.start,
        segments: inside,
        outside_table: shown.len() - inside,
        initial: all(&|shown| shown.initial),
        learnt: all(&|shown| shown.learnt),
        before_learning: curve.get(&(identity.start, identity.flight.clone())).copied(),
        engines: by_engine.collect::<Option<Vec<_>>>().unwrap_or_default(),
        learnt_over_initial_percent: over.iter().sum::<f64>() / over.len().max(1) as f64,
        cruise_fuel_kg: (fuel_used(shown.last()) - fuel_used(shown.first())).max(0.0),
        conditions: MeanConditions::mean_of(shown.iter().filter_map(conditions)),
    }
}

/// Of one segment; `None` where a model does not predict it.
fn conditions(shown: &Shown<'_>) -> Option<MeanConditions> {
    let (initial, _) = (shown.initial?, shown.learnt?);
    let means = &shown.segment.means;
    Some(MeanConditions {
        pressure_altitude_m: means.pressure_altitude_m,
        mach: means.mach,
        static_air_temperature_k: means.static_air_temperature_k,
        mass_kg: means.mass_kg,
        true_airspeed_m_s: means.true_airspeed_m_s,
        initial_fuel_flow_kg_s: means.fuel_flow_total_kg_s * (-initial / 100.0).exp(),
        segments: 1,
    })
}

/// How much more an engine burns than its share of all: `100·ln(N·Wf_k/ΣWf)`; `None` where engines are not recorded apart.
fn share_percent(segment: &Segment, engine: usize, engines: usize) -> Option<f64> {
    let flows = &segment.means.fuel_flow_engine_kg_s;
    let total: f64 = flows.iter().sum();
    if flows.len() != engines {
        return None;
    }
    deviation_percent(flows[engine] * engines as f64, total)
}
