//! A fleet flown, diagnosed and monitored, without knowing what was planted.

use core::ops::Range;

use diagnose::{
    FleetDiagnosis, FleetFrame, FleetTail, FlightRecord, ModelOf, Options, diagnose_fleet,
};
use flight::Timestamp;
use monitor::{ChangeBeliefs, FlightDeviation, History, Series};
use pipeline::reduction::ReducedFlight;
use simulate::Scatter;
use simulate::study::DragError;

use super::draw::DrawnFleet;
use super::part::FleetSpec;
use crate::diagnosis_inputs::{DiagnosisInputs, WholeOfType, adapted};
use crate::failure::CaseFailure;
use crate::flown_case::{fly, records};
use crate::plan::TrialPlan;
use crate::reference_model::{COARSE, reference_model};
use crate::stated_sensors::stated_sensors;

/// What was found in a fleet: nothing of it has met the truth.
#[derive(Clone, Debug)]
pub struct FoundFleet {
    /// The tails that took part, in the order of the diagnosis.
    pub tails: Vec<String>,
    /// The diagnosis of all tails together.
    pub diagnosis: FleetDiagnosis,
    /// Of each tail, when its flights began and the changes that they show.
    pub monitored: Vec<MonitoredTail>,
}

/// What the flights of a tail show over time.
#[derive(Clone, Debug)]
pub struct MonitoredTail {
    /// When its flights began, in order.
    pub starts: Vec<Timestamp>,
    /// The first flight after each change.
    pub changes: Vec<usize>,
}

impl FoundFleet {
    /// Draws, flies, teaches the model, diagnoses and monitors a fleet.
    ///
    /// # Errors
    /// [`CaseFailure`]; other fleets are not touched by it.
    pub fn run(plan: &TrialPlan, spec: &FleetSpec) -> Result<Self, CaseFailure> {
        let drawn = DrawnFleet::draw(plan, spec)?;
        let simulation = drawn.simulation();
        let truth = simulation.aircraft();
        let stated = stated_sensors(&plan.sensors.sensors(), &Scatter::default(), truth);
        let physics = simulation.plan().physics;
        let initial = reference_model(truth, physics, stated, &COARSE, Some(&DragError::study()))?;
        let clean = drawn.clean_flights();
        let training_flights = fly(simulation, 0..clean)?;
        let part = drawn.part();
        let mut flights: Vec<ReducedFlight> = Vec::new();
        let mut tails: Tails = Vec::new();
        for tail in 0..part.tails {
            let from = clean + tail * part.flights;
            let name =
                simulation.flight(from).map_or_else(String::new, |(name, _)| name.to_owned());
            let flown = fly(simulation, from..from + part.flights)?;
            tails.push((name, flights.len()..flights.len() + flown.len()));
            flights.extend(flown);
        }
        let inputs = adapted(initial, &training_flights, flights)?;
        let (tails, diagnosis) = diagnosed(&inputs, &tails)?;
        let whole = inputs.whole_model()?;
        let monitored = tails
            .iter()
            .map(|(_, range)| monitored(&inputs.flights()[range.clone()], &whole))
            .collect();
        Ok(Self { tails: tails.into_iter().map(|(name, _)| name).collect(), diagnosis, monitored })
    }
}

/// Tails by name, each with its place among all flights.
type Tails = Vec<(String, Range<usize>)>;

/// All tails together, and those that took part.
fn diagnosed(
    inputs: &DiagnosisInputs,
    tails: &[(String, Range<usize>)],
) -> Result<(Tails, FleetDiagnosis), CaseFailure> {
    let all = inputs.records();
    let frame = FleetFrame::new(inputs.input(&all), &Options::default(), ModelOf::Type)?;
    let mut reduced: Vec<FleetTail> = Vec::new();
    let mut took_part = Vec::new();
    for (name, range) in tails {
        let own: Vec<FlightRecord<'_>> = records(&inputs.flights()[range.clone()]);
        if let Some(tail) = frame.tail(&own) {
            reduced.push(tail);
            took_part.push((name.clone(), range.clone()));
        }
    }
    let mut grams: Vec<&mut FleetTail> = reduced.iter_mut().collect();
    let diagnosis = diagnose_fleet(&mut grams)?;
    Ok((took_part, diagnosis))
}

/// The deviations of a tail's flights, in order of flying, from the model of its type, and their changes.
fn monitored(flights: &[ReducedFlight], whole: &WholeOfType<'_>) -> MonitoredTail {
    let shown: Vec<FlightDeviation> = flights
        .iter()
        .filter_map(|flight| {
            let gaps: Vec<f64> =
                flight.segments.iter().filter_map(|segment| whole.gap_percent(segment)).collect();
            FlightDeviation::of_segments(flight.identity.start, &gaps)
        })
        .collect();
    let starts = shown.iter().map(FlightDeviation::time).collect();
    let history = Series::new(shown)
        .ok()
        .and_then(|series| History::fit(&series, &[], &ChangeBeliefs::of_2026()));
    let changes = history.map_or_else(Vec::new, |history| {
        history.changes.iter().map(|change| change.first_flight).collect()
    });
    MonitoredTail { starts, changes }
}
