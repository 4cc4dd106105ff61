//! Flies one flight twice, clean and with 2 % more drag, and finds the 2 % in the recorded fuel flow.
#![expect(clippy::print_stdout, reason = "an example shows its result")]

use simulate::{FleetDesign, Plan, PlannedEffect, Scatter, SensorChoice, Simulation};

fn mean_fuel_flow_kg_s(plan: Plan) -> Result<f64, Box<dyn std::error::Error>> {
    let flown = Simulation::new(plan)?.fly(0)?;
    let flows = &flown.report.columns().fuel_flow;
    Ok((0..flows.len()).map(|sample| flows.total_kg_s(sample)).sum::<f64>() / flows.len() as f64)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let design = FleetDesign { flights: 1, ..FleetDesign::default() };
    let clean = Plan {
        sensors: SensorChoice::Perfect,
        scatter: Scatter::none(),
        ..Plan::of_one_tail(2020, "T-001", design)
    };
    let mut draggy = clean.clone();
    draggy.effects = vec![PlannedEffect::sized("drag_factor".parse()?, 2.0)];

    let ratio = mean_fuel_flow_kg_s(draggy)? / mean_fuel_flow_kg_s(clean)?;
    let percent = 100.0 * (ratio - 1.0);
    println!("2 % more drag burn {percent:.2} % more fuel");
    // A little less than 2 %: fuel for bleed and shaft power makes no thrust, and TSFC changes with part load.
    assert!((1.9..2.0).contains(&percent));
    Ok(())
}
