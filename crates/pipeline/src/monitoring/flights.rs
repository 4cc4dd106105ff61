//! What each flight shows against a tail's models: the initial one, the learnt one, and the learnt one as it was before that
//! flight. All that `monitor` needs of a flight.

use atmos::isa;
use flight::{MAXIMUM_ENGINES, Segment, Timestamp};
use monitor::{CONDITIONS, FlightDeviation};
use serde::{Deserialize, Serialize};
use units::{Pressure, PressureAltitude, Temperature};

use crate::evaluation::TailResult;
use crate::learning::{Forecast, LearningCurve, deviation_percent};
use crate::model_file::ModelFile;
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
    /// Against the book, at the conditions flown; `None` where no segment is inside the table, as for the others.
    pub book: Option<FlightDeviation>,
    /// Against the learnt model.
    pub learnt: Option<FlightDeviation>,
    /// Against the model as it was before it learnt this flight.
    pub before_learning: Option<Forecast>,
    /// Of each engine that is recorded, against its share of the learnt model.
    pub engines: Vec<FlightDeviation>,
    /// Mean of what the learnt model predicts more than the book over the flight's segments, %.
    pub learnt_over_book_percent: f64,
    /// Fuel used from the beginning of the first segment to the end of the last one, kg.
    pub cruise_fuel_kg: f64,
    /// Conditions flown.
    pub conditions: MeanConditions,
}

/// Means over segments that both the book and the learnt model predict, geometric where the quantity is positive by nature.
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
    /// Geometric mean of fuel flow by the book, kg/s.
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

impl MeanConditions {
    /// What a flight's deviation may depend on: Mach number, lift coefficient (but for a constant factor), pressure altitude, ISA
    /// deviation and mass. Those of all flights together for a flight of which none are known.
    pub(super) fn to_monitor(self, of_all: &Self) -> [f64; CONDITIONS] {
        let known = if self.segments > 0 { self } else { *of_all };
        let altitude = PressureAltitude::meters(known.pressure_altitude_m);
        // Flights were flown where the atmosphere is defined.
        let pressure_pa = isa::pressure(altitude).map_or(f64::NAN, Pressure::to_pascals);
        let isa_k = isa::temperature(altitude).map_or(f64::NAN, Temperature::to_kelvin);
        let lift = known.mass_kg / (pressure_pa * known.mach * known.mach);
        let isa_deviation_k = known.static_air_temperature_k - isa_k;
        [known.mach, lift, known.pressure_altitude_m, isa_deviation_k, known.mass_kg]
            .map(|value| if value.is_finite() { value } else { 0.0 })
    }
}

/// What a segment shows; `None` where a prediction has no value.
#[derive(Clone, Copy, Debug)]
struct Shown<'s> {
    segment: &'s Segment,
    book: Option<f64>,
    learnt: Option<f64>,
}

/// The flights of a tail that has learnt, in the order of flying.
#[must_use]
pub fn flights_of(result: &TailResult) -> Vec<MonitoredFlight> {
    flights_with(result, &result.learning_curve())
}

/// The same with this learning curve.
pub(super) fn flights_with(result: &TailResult, curve: &LearningCurve) -> Vec<MonitoredFlight> {
    let book = result.rows.iter().map(|row| &row.segment).zip(result.book.iter().copied());
    let engines = result.model.initial.aircraft().engines();
    with_those_without_segment(&result.model, monitored(book, &result.after, curve, engines))
}

/// In the order of flying these flights of a model and those that gave it no segment: they show nothing, but were flown.
pub(super) fn with_those_without_segment(
    model: &ModelFile,
    mut flights: Vec<MonitoredFlight>,
) -> Vec<MonitoredFlight> {
    let ledger = model.learnt.iter().flat_map(|learnt| &learnt.ledger);
    flights.extend(ledger.filter(|entry| entry.segments == 0).filter_map(|entry| {
        Some(MonitoredFlight {
            flight: entry.flight.clone(),
            start: entry.start.parse().ok()?,
            segments: 0,
            outside_table: 0,
            book: None,
            learnt: None,
            before_learning: None,
            engines: Vec::new(),
            learnt_over_book_percent: 0.0,
            cruise_fuel_kg: 0.0,
            conditions: MeanConditions::default(),
        })
    }));
    sort(&mut flights);
    flights
}

/// Puts flights in the order of flying.
pub(super) fn sort(flights: &mut [MonitoredFlight]) {
    flights.sort_by(|one, other| (one.start, &one.flight).cmp(&(other.start, &other.flight)));
}

/// The learning curve that flights hold.
#[must_use]
pub fn curve_of_flights(flights: &[MonitoredFlight]) -> LearningCurve {
    let shown = |flight: &MonitoredFlight| {
        Some(((flight.start, flight.flight.clone()), flight.before_learning?))
    };
    flights.iter().filter_map(shown).collect()
}

/// The flights of these segments, with what the book and, in the same order, the learnt model predicts for each.
pub(super) fn monitored<'s>(
    book: impl Iterator<Item = (&'s Segment, Option<Evaluated>)>,
    learnt: &[Option<Evaluated>],
    curve: &LearningCurve,
    engines: usize,
) -> Vec<MonitoredFlight> {
    let shown: Vec<Shown<'s>> = book
        .zip(learnt)
        .map(|((segment, book), learnt)| {
            let deviation = |evaluated: Option<Evaluated>| {
                let predicted = evaluated?.predicted_fuel_flow_kg_s?;
                deviation_percent(segment.means.fuel_flow_total_kg_s, predicted)
            };
            Shown { segment, book: deviation(book), learnt: deviation(*learnt) }
        })
        .collect();
    let flights: Vec<&[Shown<'s>]> =
        shown.chunk_by(|one, other| one.segment.identity == other.segment.identity).collect();
    let usual_step_s = usual_step_s(&flights);
    flights.into_iter().map(|flight| flight_of(flight, usual_step_s, curve, engines)).collect()
}

fn flight_of(
    shown: &[Shown<'_>],
    usual_step_s: f64,
    curve: &LearningCurve,
    engines: usize,
) -> MonitoredFlight {
    let identity = &shown[0].segment.identity;
    let all = |of: &dyn Fn(&Shown<'_>) -> Option<f64>| -> Option<FlightDeviation> {
        let deviations: Vec<f64> = shown.iter().filter_map(of).collect();
        FlightDeviation::of_segments(identity.start, &deviations)
    };
    let by_engine = (0..engines.min(MAXIMUM_ENGINES)).map(|engine| {
        all(&|shown| Some(shown.learnt? + share_percent(shown.segment, engine, engines)?))
    });
    let inside = shown.iter().filter(|shown| shown.learnt.is_some()).count();
    let over: Vec<f64> = shown.iter().filter_map(|one| Some(one.book? - one.learnt?)).collect();
    MonitoredFlight {
        flight: identity.flight.clone(),
        start: identity.start,
        segments: inside,
        outside_table: shown.len() - inside,
        book: all(&|shown| shown.book),
        learnt: all(&|shown| shown.learnt),
        before_learning: curve.get(&(identity.start, identity.flight.clone())).copied(),
        engines: by_engine.collect::<Option<Vec<_>>>().unwrap_or_default(),
        learnt_over_book_percent: over.iter().sum::<f64>() / over.len().max(1) as f64,
        cruise_fuel_kg: cruise_fuel_kg(shown, usual_step_s),
        conditions: MeanConditions::mean_of(shown.iter().filter_map(conditions)),
    }
}

/// Fuel used from the beginning of the first segment to the end of the last one: between their middles, and half of each.
fn cruise_fuel_kg(shown: &[Shown<'_>], usual_step_s: f64) -> f64 {
    let [Some(first), Some(last)] = [shown.first(), shown.last()].map(|one| Some(one?.segment))
    else {
        return 0.0;
    };
    let step_s = sample_step_s(shown).unwrap_or(usual_step_s);
    let half_kg = |segment: &Segment| {
        0.5 * step_s * segment.samples() as f64 * segment.means.fuel_flow_total_kg_s
    };
    let between_kg = (last.means.fuel_used_kg - first.means.fuel_used_kg).max(0.0);
    between_kg + half_kg(first) + half_kg(last)
}

/// Time from one sample to the next in the flights that show it: their median, s. Where none has two segments, that since the
/// recordings began, which may begin late.
fn usual_step_s(flights: &[&[Shown<'_>]]) -> f64 {
    let known = |of: fn(&[Shown<'_>]) -> Option<f64>| -> Option<f64> {
        let mut steps: Vec<f64> = flights.iter().filter_map(|flight| of(flight)).collect();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied()
    };
    let since_start = |shown: &[Shown<'_>]| step_s((0.0, 0.0), middle(shown.first()?));
    known(sample_step_s).or_else(|| known(since_start)).unwrap_or(0.0)
}

/// Time from one sample to the next, s: the shortest that two segments' middles show, because there may be a hole between others;
/// `None` of one segment.
fn sample_step_s(shown: &[Shown<'_>]) -> Option<f64> {
    let between = shown.windows(2).filter_map(|pair| step_s(middle(&pair[0]), middle(&pair[1])));
    between.reduce(f64::min)
}

/// Mean time and mean sample of a segment.
fn middle(shown: &Shown<'_>) -> (f64, f64) {
    let rows = &shown.segment.rows;
    let ends = rows.first().zip(rows.last());
    let row = ends.map_or(0.0, |(first, last)| 0.5 * (f64::from(*first) + f64::from(*last)));
    (shown.segment.means.time_s, row)
}

/// Time per sample between two such middles, s; `None` where none lies between.
fn step_s(from: (f64, f64), to: (f64, f64)) -> Option<f64> {
    let (time_s, rows) = (to.0 - from.0, to.1 - from.1);
    (rows > 0.0 && time_s > 0.0).then(|| time_s / rows)
}

/// Of one segment; `None` where a model does not predict it.
fn conditions(shown: &Shown<'_>) -> Option<MeanConditions> {
    let (book, _) = (shown.book?, shown.learnt?);
    let means = &shown.segment.means;
    Some(MeanConditions {
        pressure_altitude_m: means.pressure_altitude_m,
        mach: means.mach,
        static_air_temperature_k: means.static_air_temperature_k,
        mass_kg: means.mass_kg,
        true_airspeed_m_s: means.true_airspeed_m_s,
        initial_fuel_flow_kg_s: means.fuel_flow_total_kg_s * (-book / 100.0).exp(),
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use flight::{Cruise, FlightIdentity, SegmentMeans};
    use units::{FuelFlowTotal, Mach, Mass, TrueAirspeed};

    use super::*;

    /// A segment of ten samples from a row on, one sample every 30 s, at 0.5 kg/s.
    fn segment(flight: &str, first_row: u32) -> Segment {
        let identity = FlightIdentity {
            tail: "T".to_owned(),
            start: "2024-03-01T10:00:00Z".parse().unwrap(),
            flight: flight.to_owned(),
        };
        let cruise = SegmentMeans::cruise(&Cruise {
            pressure_altitude: PressureAltitude::feet(35_000.0),
            static_air_temperature: Temperature::kelvin(220.0),
            mach: Mach::new(0.8),
            true_airspeed: TrueAirspeed::meters_per_second(240.0),
            mass: Mass::kilograms(30_000.0),
            fuel_flow_total: FuelFlowTotal::kilograms_per_second(0.5),
        });
        // The recording begins 1000 s after START.
        let time_s = 1000.0 + 30.0 * (f64::from(first_row) + 4.5);
        Segment {
            identity: Arc::new(identity),
            rows: (first_row..first_row + 10).collect(),
            means: SegmentMeans { time_s, fuel_used_kg: 0.5 * time_s, ..cruise },
            temperature_assumed: false,
        }
    }

    /// By hand: ten samples of 30 s at 0.5 kg/s are 150 kg, wherever they lie; from row 0 to row 40 are 40 samples, 600 kg.
    #[test]
    fn cruise_fuel_is_that_of_whole_segments() {
        let segments = [segment("1", 0), segment("1", 10), segment("1", 30), segment("2", 55)];
        let shown = || segments.iter().map(|segment| (segment, None));
        let flights = monitored(shown(), &[None; 4], &LearningCurve::new(), 2);
        let fuel: Vec<f64> = flights.iter().map(|flight| flight.cruise_fuel_kg).collect();
        assert!((fuel[0] - 600.0).abs() < 1e-9 && (fuel[1] - 150.0).abs() < 1e-9, "{fuel:?}");
    }

    /// By hand: ISA at 11 000 m is 216.65 K and 22 632 Pa; a flight of which no segment was predicted has those of all.
    #[test]
    fn conditions_of_a_flight() {
        let of_all = MeanConditions {
            pressure_altitude_m: 11_000.0,
            mach: 0.8,
            static_air_temperature_k: 220.0,
            mass_kg: 30_000.0,
            segments: 7,
            ..MeanConditions::default()
        };
        let found = of_all.to_monitor(&MeanConditions::default());
        let lift = 30_000.0 / (22_632.06 * 0.64);
        for (found, known) in found.into_iter().zip([0.8, lift, 11_000.0, 3.35, 30_000.0]) {
            assert!((found / known - 1.0).abs() < 1e-6, "{found} {known}");
        }
        let none = MeanConditions::default().to_monitor(&of_all);
        assert!(none.iter().zip(found).all(|(one, other)| one.to_bits() == other.to_bits()));
    }
}
