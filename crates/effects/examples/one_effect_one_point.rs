//! A meter that reads 2 % high and an engine that burns 2 % more at one point: the same fuel flow, but not the same thrust.

use effects::{EffectModel, EffectPoint, Effects, ExtendedModel, mean_references};
use flight::effect::EffectId;
use perf_model::{Aircraft, FlightPoint, Guide, initial_model};
use units::{Mach, Mass, PressureAltitude};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let aircraft = Aircraft::from_ron(
        r#"(
            name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
            tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0),
            table: (lift_coefficient: (0.30, 0.60, 0.05), mach: (0.76, 0.88, 0.02)),
        )"#,
    )?;
    let guide = Guide::from_csv(include_bytes!("../../perf-model/tests/golden/guide.csv"))?;
    let model = ExtendedModel::from(initial_model(&aircraft, &guide)?.model);

    let cruise =
        FlightPoint::new(Mass::pounds(66_000.0), PressureAltitude::feet(41_000.0), Mach::new(0.80));
    let point = EffectPoint::from_flight_point(&cruise, 2)?;
    let references = mean_references(model.aircraft(), model.drag_table(), &[point])?;
    let effects = EffectModel::new(&model, model.drag_table(), references)?;
    let plain = effects.response(&point, &Effects::none())?;
    let engine = effects.response(&point, &Effects::one(EffectId::TsfcFactor, 2.0))?;
    let meter = effects.response(&point, &Effects::one(EffectId::FuelFlowGain, 2.0))?;
    let drag = effects.response(&point, &Effects::one(EffectId::DragFactor, 2.0))?;

    let two_percent = 1.02_f64.ln();
    for response in [engine, meter, drag] {
        let more = response.ln_fuel_flow_total - plain.ln_fuel_flow_total;
        assert!((more - two_percent).abs() < 1e-12);
    }
    assert!((engine.net_thrust_n - plain.net_thrust_n).abs() < 1e-9);
    assert!((drag.net_thrust_n / plain.net_thrust_n - 1.02).abs() < 1e-12);
    Ok(())
}
