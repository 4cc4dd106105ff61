//! From a flight-planning guide to fuel flow and specific range at weights and altitudes between its rows.
//!
//! `cargo run -p cruisefit-perf-model --example guide_to_fuel_flow`
#![expect(clippy::print_stdout, reason = "an example shows its result")]

use perf_model::{Aircraft, FlightPoint, Guide, initial_model};
use units::{Mach, Mass, PressureAltitude};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let aircraft = Aircraft::from_ron(
        r#"(
            name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
            tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0),
            table: (lift_coefficient: (0.10, 0.80, 0.05), mach: (0.50, 0.95, 0.05)),
        )"#,
    )?;
    let guide = Guide::from_csv(include_bytes!("../tests/golden/guide.csv"))?;
    let initial = initial_model(&aircraft, &guide)?;
    println!("polynomial misses {:.1} % of the guide", initial.fit.residual_rms_percent);
    for finding in &initial.findings {
        println!("{:?}: {}", finding.severity, finding.message);
    }

    let at_weight = |weight_lb: f64| {
        let altitude = PressureAltitude::feet(41_500.0);
        initial.model.predict(&FlightPoint::new(Mass::pounds(weight_lb), altitude, Mach::new(0.80)))
    };
    for weight_lb in [55_000.0, 60_000.0, 67_000.0, 75_000.0] {
        let prediction = at_weight(weight_lb)?;
        let flow = prediction.fuel_flow_total.to_pounds_per_hour();
        let range = prediction.specific_range.to_nautical_miles_per_pound();
        println!("{weight_lb} lb: {flow:.0} lb/h, {range:.4} nm/lb");
    }

    // One per cent more weight costs 0.2 to 0.8 % more fuel flow, depending on the share of induced drag.
    let heavier =
        at_weight(1.01 * 67_000.0)?.fuel_flow_total / at_weight(67_000.0)?.fuel_flow_total;
    println!("1 % more weight burns {:.2} % more", 100.0 * (heavier - 1.0));
    assert!((1.002..1.008).contains(&heavier));
    Ok(())
}
