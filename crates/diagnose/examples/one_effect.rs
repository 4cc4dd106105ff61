//! A fleet that burns 2 % more than its model says, from plain numbers: what could it be?

use std::sync::Arc;

use diagnose::{FlightRecord, Input, Options, diagnose};
use flight::effect::EffectId;
use test_support::fleet::{Background, Setup, exact_model, fly};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = exact_model();
    let clean = fly(5, &Setup::default(), &[], &Background::default());
    let mut flights = clean.flights;
    for segment in flights.iter_mut().flatten() {
        segment.means.fuel_flow_total_kg_s *= 1.02;
        for flow in &mut segment.means.fuel_flow_engine_kg_s {
            *flow *= 1.02;
        }
        segment.identity = Arc::clone(&segment.identity);
    }
    let records: Vec<FlightRecord<'_>> =
        flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let found = diagnose(&Input::against(&model, &records), &Options::default())?;
    // Fuel flow alone cannot say whether engine or airframe: both are in the class, and neither is sure.
    let verdict = found.verdict.found().ok_or("an effect explains the gap")?;
    assert!(verdict.class.contains(&EffectId::TsfcFactor));
    assert!(verdict.class.contains(&EffectId::DragFactor));
    assert!(verdict.probability < 0.9);
    Ok(())
}
