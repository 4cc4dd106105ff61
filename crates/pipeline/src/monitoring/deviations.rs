//! What a tail's segments show against its models: the initial one, the learnt one, and the learnt one as it was before each
//! flight.

use flight::{MAXIMUM_ENGINES, Segment, Timestamp};
use monitor::FlightDeviation;

use crate::evaluation::evaluate;
use crate::learning::{LearningAgain, LearningError};
use crate::model_file::{LedgerEntry, ModelFile};
use crate::whole_model::{Predicts, ln_gap_of};

/// Whether the model is rebuilt flight by flight, which takes a table per flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BeforeLearning {
    /// Rebuild it.
    Rebuild,
    /// Leave it out.
    LeaveOut,
}

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
    /// Against the initial model, at the tail's reference conditions.
    pub normalised: Option<FlightDeviation>,
    /// Against the model as it was before it learnt this flight.
    pub before_learning: Option<FlightDeviation>,
    /// Of each engine that is recorded, against its share of the initial model, at reference conditions.
    pub engines: Vec<FlightDeviation>,
    /// Fuel used between the first and the last segment, kg.
    pub cruise_fuel_kg: f64,
}

/// The conditions to which deviations are normalised: means over all segments of the tail inside the table, geometric
/// where the quantity is positive by nature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReferenceConditions {
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

/// A tail's flights in the order of flying.
#[derive(Clone, Debug, PartialEq)]
pub struct TailDeviations {
    /// Type code of the aircraft.
    pub aircraft_type: String,
    /// What the model has learnt, in words.
    pub model: String,
    /// The flights.
    pub flights: Vec<MonitoredFlight>,
    /// What they are normalised to.
    pub reference: ReferenceConditions,
}

/// What a segment shows; `None` where a prediction has no value.
#[derive(Clone, Copy, Debug, Default)]
struct Shown {
    initial: Option<f64>,
    learnt: Option<f64>,
    before_learning: Option<f64>,
}

impl TailDeviations {
    /// What the segments of a tail show, which are in the order in which its model learnt them.
    ///
    /// ```text
    /// normalised d = 100·[ln Wf − ln Ŵf_learnt] + mean over all segments of 100·[ln Ŵf_learnt − ln Ŵf_initial]   [monitoring.16]
    /// ```
    ///
    /// The learnt model knows how fuel flow depends on conditions; the initial one is the level from which is counted.
    ///
    /// # Errors
    /// A model that cannot learn its own flights again (a damaged file).
    pub fn new(
        model: &ModelFile,
        segments: &[Segment],
        before_learning: BeforeLearning,
    ) -> Result<Self, LearningError> {
        let mut shown = vec![Shown::default(); segments.len()];
        let initial = evaluate(&model.initial, model.initial.drag_table(), segments);
        let learnt = learnt_deviations_percent(model, segments);
        for (index, shown) in shown.iter_mut().enumerate() {
            let recorded = segments[index].means.fuel_flow_total_kg_s;
            shown.initial = initial[index]
                .and_then(|of| deviation_percent(recorded, of.predicted_fuel_flow_kg_s?));
            shown.learnt = learnt[index];
        }
        if before_learning == BeforeLearning::Rebuild {
            rebuild(model, segments, &mut shown)?;
        }
        let reference = reference(segments, &shown);
        let levels = shown.iter().filter_map(|shown| Some(shown.initial? - shown.learnt?));
        let level = levels.sum::<f64>() / reference.segments.max(1) as f64;
        let engines = model.initial.aircraft().engines();
        let mut flights = Vec::new();
        let mut from = 0;
        for flight in segments.chunk_by(|one, other| one.identity == other.identity) {
            let shown = &shown[from..from + flight.len()];
            flights.push(flight_of(flight, shown, level, engines));
            from += flight.len();
        }
        flights.sort_by(|one, other| (one.start, &one.flight).cmp(&(other.start, &other.flight)));
        let aircraft_type = model.initial.aircraft().type_code().to_owned();
        Ok(Self { aircraft_type, model: model.told(), flights, reference })
    }
}

/// 100·ln(recorded/predicted); `None` where one of them is not positive.
fn deviation_percent(recorded_kg_s: f64, predicted_kg_s: f64) -> Option<f64> {
    (recorded_kg_s > 0.0 && predicted_kg_s > 0.0)
        .then(|| 100.0 * (recorded_kg_s / predicted_kg_s).ln())
}

/// 100·ln(recorded/predicted) by everything that the model has learnt; `None` outside its table.
fn learnt_deviations_percent(model: &ModelFile, segments: &[Segment]) -> Vec<Option<f64>> {
    if let Some(whole) = model.whole(Predicts::WholeModel) {
        let gap = |segment| ln_gap_of(&whole, &model.initial, segment);
        return segments.iter().map(|segment| gap(segment).map(|gap| 100.0 * gap)).collect();
    }
    let learnt = evaluate(&model.initial, model.drag_coefficient(), segments);
    let recorded = segments.iter().map(|segment| segment.means.fuel_flow_total_kg_s);
    learnt
        .iter()
        .zip(recorded)
        .map(|(evaluated, recorded)| {
            deviation_percent(recorded, evaluated.and_then(|of| of.predicted_fuel_flow_kg_s)?)
        })
        .collect()
}

/// Learns the flights again, one by one, and predicts each before it is learnt. Exact: the same flights in the same order
/// by the same settings as the model has learnt them.
fn rebuild(
    model: &ModelFile,
    segments: &[Segment],
    shown: &mut [Shown],
) -> Result<(), LearningError> {
    let (Some(known), Some(mut again)) = (&model.learnt, LearningAgain::new(model)?) else {
        return Ok(());
    };
    let mut from = 0;
    let mut ledger = known.ledger.iter();
    for flight in segments.chunk_by(|one, other| one.identity == other.identity) {
        let table = again.table()?;
        let predicted = evaluate(&model.initial, &table, flight);
        drop(table);
        for (offset, (segment, predicted)) in flight.iter().zip(predicted).enumerate() {
            shown[from + offset].before_learning = predicted
                .and_then(|of| of.predicted_fuel_flow_kg_s)
                .and_then(|kg_s| deviation_percent(segment.means.fuel_flow_total_kg_s, kg_s));
        }
        from += flight.len();
        let start = flight[0].identity.start.to_string();
        // In the ledger's order, but for flights that had no segment.
        let is_this = |entry: &&LedgerEntry| {
            entry.flight == flight[0].identity.flight && entry.start == start
        };
        if ledger.find(is_this).is_none() {
            break;
        }
        again.learn(flight)?;
    }
    Ok(())
}

fn reference(segments: &[Segment], shown: &[Shown]) -> ReferenceConditions {
    let mut sums = ReferenceConditions::default();
    for (segment, shown) in segments.iter().zip(shown) {
        let (Some(initial), Some(_)) = (shown.initial, shown.learnt) else { continue };
        let means = &segment.means;
        sums.pressure_altitude_m += means.pressure_altitude_m;
        sums.mach += means.mach;
        sums.static_air_temperature_k += means.static_air_temperature_k;
        sums.mass_kg += means.mass_kg;
        sums.true_airspeed_m_s += means.true_airspeed_m_s.ln();
        sums.initial_fuel_flow_kg_s += means.fuel_flow_total_kg_s.ln() - initial / 100.0;
        sums.segments += 1;
    }
    let count = sums.segments.max(1) as f64;
    ReferenceConditions {
        pressure_altitude_m: sums.pressure_altitude_m / count,
        mach: sums.mach / count,
        static_air_temperature_k: sums.static_air_temperature_k / count,
        mass_kg: sums.mass_kg / count,
        true_airspeed_m_s: (sums.true_airspeed_m_s / count).exp(),
        initial_fuel_flow_kg_s: (sums.initial_fuel_flow_kg_s / count).exp(),
        segments: sums.segments,
    }
}

fn flight_of(segments: &[Segment], shown: &[Shown], level: f64, engines: usize) -> MonitoredFlight {
    let identity = &segments[0].identity;
    let all = |of: &dyn Fn(usize) -> Option<f64>| -> Option<FlightDeviation> {
        let deviations: Vec<f64> = (0..segments.len()).filter_map(of).collect();
        FlightDeviation::of_segments(identity.start, &deviations)
    };
    let normalised = |index: usize| shown[index].learnt.map(|learnt| learnt + level);
    let by_engine = (0..engines.min(MAXIMUM_ENGINES)).map(|engine| {
        all(&|index| Some(normalised(index)? + share_percent(&segments[index], engine, engines)?))
    });
    let fuel_used = |segment: Option<&Segment>| segment.map_or(0.0, |s| s.means.fuel_used_kg);
    let inside = shown.iter().filter(|shown| shown.learnt.is_some()).count();
    MonitoredFlight {
        flight: identity.flight.clone(),
        start: identity.start,
        segments: inside,
        outside_table: segments.len() - inside,
        initial: all(&|index| shown[index].initial),
        normalised: all(&normalised),
        before_learning: all(&|index| shown[index].before_learning),
        engines: by_engine.collect::<Option<Vec<_>>>().unwrap_or_default(),
        cruise_fuel_kg: (fuel_used(segments.last()) - fuel_used(segments.first())).max(0.0),
    }
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
