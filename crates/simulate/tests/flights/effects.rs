//! Each effect changes its own channels as physics requires, and no other.
//!
//! One flight is flown with and without it: same seed, perfect sensors, still air. The first sample is compared, where the
//! fuel burnt differently has hardly changed the mass yet.

use crate::common::{column, fly_first, northbound, quiet_plan};
use flight::effect::{EffectGroup, EffectId};
use simulate::{
    FlightPlan, Flown, OutsideEffect, PlannedEffect, References, StepTarget, TruthEffect,
};

const AIR: [&str; 4] = ["ALT", "MACH", "VTAS", "SAT"];
const THRUST: [&str; 5] = ["N2(1)", "N2(2)", "WF(1)", "WF(2)", "FU"];
const FUEL: [&str; 3] = ["WF(1)", "WF(2)", "FU"];
const ALL: [&str; 17] = [
    "ALT", "SAT", "MACH", "VTAS", "GSPD", "ROLL", "DRIFT", "N2(1)", "N2(2)", "WF(1)", "WF(2)",
    "FU", "HDG", "LAT", "CG", "A/I", "EGT(1)",
];

/// A flight in which every effect shows: warm air, a wing low, center of gravity forward, anti-ice on, a year after the
/// reference.
fn showing() -> FlightPlan {
    FlightPlan {
        anti_ice: vec![(0.0, 3600.0)],
        waypoints: vec![(45.0, 10.0), (60.0, 40.0)],
        center_of_gravity_percent_mac: 20.0,
        start: "2020-01-01T00:00:00Z".parse().unwrap(),
        ..northbound()
    }
}

/// Different from the flight in everything, so that nothing is zero by chance.
fn references() -> References {
    References {
        mach: 0.75,
        lift_coefficient: 0.33,
        reynolds_number: 2.0e7,
        temperature_ratio: 0.73,
        corrected_thrust_n: 50_000.0,
        fuel_flow_kg_s: 0.22,
        mass_kg: 13_600.0,
        center_of_gravity_percent_mac: 27.0,
        date_s: 1_546_300_800.0,
        first_date_s: 1_530_000_000.0,
        last_date_s: 1_590_000_000.0,
    }
}

fn fly(effects: Vec<PlannedEffect>) -> Flown {
    let mut plan = quiet_plan(vec![showing()]);
    plan.weather.isa_deviation_k = simulate::Spread { mean: 6.0, sd: 0.0 };
    plan.scatter.roll_trim_deg = 0.5;
    plan.tails[0].references = Some(references());
    plan.effects = effects;
    fly_first(plan)
}

fn relative_change(name: &str, with: &Flown, without: &Flown) -> f64 {
    // Fuel used needs some minutes to show an effect that is switched on with the recording.
    let sample = if name == "FU" { 5 } else { 0 };
    let (a, b) = (column(&with.report, name)[sample], column(&without.report, name)[sample]);
    if b == 0.0 { a } else { a / b - 1.0 }
}

/// Channels whose first sample differs by more than the share explained by fuel burnt before it.
fn changed(with: &Flown, without: &Flown) -> Vec<&'static str> {
    ALL.into_iter()
        .filter(|name| {
            // A per cent of the fuel of climb and settling is 0.05 % of the mass and, through it, 0.03 % of the fuel flow.
            let tolerance = match *name {
                "N2(1)" | "N2(2)" => 1.5e-4,
                "WF(1)" | "WF(2)" => 6e-4,
                "EGT(1)" => 2e-4,
                // A wing held low by half a degree has a load factor of 1.00004.
                "FU" => 2e-5,
                // The speed hold needs an error to act: another thrust changes the speed by a few millionths.
                _ => 5e-6,
            };
            relative_change(name, with, without).abs() > tolerance
        })
        .collect()
}

#[test]
fn every_effect_of_the_library_changes_its_own_channels_only() {
    let base = fly(Vec::new());
    let drag: Vec<&str> = [&THRUST[..], &["EGT(1)"]].concat();
    let fuel: Vec<&str> = [&FUEL[..], &["EGT(1)"]].concat();
    for id in EffectId::library(2) {
        // What is expected of a group, and the effects that are another case.
        let expected: Vec<&str> = match id {
            EffectId::TsfcEngine(1) => vec!["WF(1)", "FU", "EGT(1)"],
            EffectId::TsfcEngine(_) | EffectId::FuelFlowGainEngine(2..) => vec!["WF(2)", "FU"],
            EffectId::FuelFlowGain => FUEL.to_vec(),
            EffectId::FuelFlowGainEngine(_) => vec!["WF(1)", "FU"],
            EffectId::FuelQuantityGain => vec!["FU"],
            EffectId::MachBias => vec!["MACH", "VTAS", "SAT"],
            EffectId::StaticPressureBias => AIR.to_vec(),
            EffectId::TemperatureBias => vec!["VTAS", "SAT"],
            // In the header; no turn and no wind here.
            EffectId::ZeroFuelMassBias | EffectId::LoadFactor | EffectId::IsobaricSlope => vec![],
            other => match other.entry().group {
                EffectGroup::Engine => fuel.clone(),
                EffectGroup::Airframe | EffectGroup::Environment | EffectGroup::Event => {
                    drag.clone()
                }
                EffectGroup::Mass | EffectGroup::Sensor => panic!("{other}: which channels?"),
            },
        };
        let mut effect = PlannedEffect::typical(TruthEffect::Library(id));
        // Three times the usual asymmetry: a wing low by half a degree makes little.
        if id == EffectId::AsymmetryDrag {
            effect.size = Some(6.0);
        }
        if id == EffectId::WaveDrag {
            // At M 0.80 this aircraft has no drag rise yet.
            effect.size = Some(0.07);
        }
        effect.from = Some("2019-06-01T00:00:00Z".parse().unwrap());
        let with = fly(vec![effect]);
        let mut expected: Vec<&str> =
            ALL.into_iter().filter(|name| expected.contains(name)).collect();
        let mut found = changed(&with, &base);
        expected.sort_unstable();
        found.sort_unstable();
        assert_eq!(found, expected, "{id}");
        // True states are the same to the bit for effects that only sensors have.
        if matches!(id.entry().group, EffectGroup::Sensor | EffectGroup::Mass) {
            assert_eq!(with.states, base.states, "{id}");
        }
    }
}

#[test]
fn effects_outside_the_library_change_their_own_channels_only() {
    let base = fly(Vec::new());
    for (outside, at, expected) in [
        (
            OutsideEffect::MachBump,
            Some(0.80),
            &["EGT(1)", "FU", "N2(1)", "N2(2)", "WF(1)", "WF(2)"][..],
        ),
        (
            OutsideEffect::SpoilerFloat,
            Some(0.25),
            &["EGT(1)", "FU", "N2(1)", "N2(2)", "WF(1)", "WF(2)"],
        ),
        (OutsideEffect::CombustorLoss, None, &["EGT(1)", "FU", "WF(1)", "WF(2)"]),
        (OutsideEffect::FuelTemperature, None, &["EGT(1)", "FU", "WF(1)", "WF(2)"]),
    ] {
        let mut effect = PlannedEffect::typical(TruthEffect::Outside(outside));
        effect.at = at;
        let mut found = changed(&fly(vec![effect]), &base);
        found.sort_unstable();
        assert_eq!(found, expected, "{outside:?}");
        // Away from their position, the two effects that have one vanish.
        if let Some(at) = at {
            effect.at = Some(at + 0.15);
            assert_eq!(changed(&fly(vec![effect]), &base), Vec::<&str>::new(), "{outside:?}");
        }
    }
}

/// Relative change of the first sample's total fuel flow.
fn fuel_change(effect: PlannedEffect) -> f64 {
    let total = |flown: &Flown| -> f64 {
        column(&flown.report, "WF(1)")[0] + column(&flown.report, "WF(2)")[0]
    };
    total(&fly(vec![effect])) / total(&fly(Vec::new())) - 1.0
}

fn sized(name: &str, size: f64) -> PlannedEffect {
    PlannedEffect::sized(name.parse().unwrap(), size)
}

#[test]
fn sizes_mean_what_the_library_says() {
    // Hand, from the state of the flight: fuel flow is drag times TSFC, so dln Wf = dCD/CD for drag at its reference form.
    let base = fly(Vec::new());
    let s = &base.states[0];
    let (cd, cl) = (s.drag_coefficient, s.lift_coefficient);
    let near = |name: &str, size: f64, expected: f64, tolerance: f64| {
        let found = fuel_change(sized(name, size));
        assert!((found - expected).abs() < tolerance, "{name}: {found}, by hand {expected}");
    };
    // 5 counts, times ((1 + 0.144·0.80²)/(1 + 0.144·0.75²))^−0.65 = 0.9932.
    near("zero_lift_drag", 5.0, 5e-4 * 0.9932 / cd, 3e-4);
    near("drag_factor", 2.0, 0.02, 4e-4);
    // K = 0.06·(1 + 0.5·0.2²); bend 1 + 0.3·(CL − 0.35).
    let induced = 0.06 * 0.06 * 1.02 * cl * cl * (1.0 + 0.3 * (cl - 0.35)) / cd;
    near("induced_drag", 6.0, induced, 3e-4);
    // Prandtl–Schlichting: CD0 = 0.0206·1.02; Re of the state; reference 2e7; exponent 0.12 over 2.58/ln Re.
    let viscosity =
        1.458e-6 * s.static_air_temperature_k.powf(1.5) / (s.static_air_temperature_k + 110.4);
    let density = s.static_pressure_pa / (287.05287 * s.static_air_temperature_k);
    let reynolds = density * s.true_airspeed_m_s * 2.757 / viscosity;
    let friction = |re: f64| 0.455 / re.log10().powf(2.58);
    let share = 0.12 / (2.58 / 2.0e7_f64.ln());
    let reynolds_change = 0.0206 * 1.02 * share * (friction(reynolds) / friction(2.0e7) - 1.0) / cd;
    near("reynolds_number", 0.12, reynolds_change, 3e-4);
    // 7 %MAC forward: x = 0.7 + 0.15·0.49.
    near("trim_drag_cg", 3.0, 3e-4 * (0.7 + 0.15 * 0.49) * cl / 0.4 / cd, 1e-4);
    let roll = s.roll_deg.abs();
    near("asymmetry_drag", 1.0, 1e-4 * roll * roll * (0.9 + 0.2 * roll) / cd, 1e-4);
    near("tsfc_factor", 2.0, 0.02, 4e-4);
    near("tsfc_engine_1", 3.0, 0.015, 4e-4);
    // (0.80/0.75)^p, p = 0.15·0.75/1.75.
    near("tsfc_mach_exponent", 0.15, (0.80_f64 / 0.75).powf(0.15 * 0.75 / 1.75) - 1.0, 1e-4);
    let ratio = s.static_air_temperature_k / 288.15;
    near("tsfc_temperature_exponent", 0.20, 0.20 * (ratio / 0.73 - 1.0), 1e-4);
    // x = F/δ over 50 000 N, above the pivot: 0.70 of the parabola.
    let x = s.thrust_n / (s.static_pressure_pa / 101_325.0) / 50_000.0;
    near("tsfc_throttle", 0.6, 0.006 * 0.70 * ((x - 1.0) / 0.25_f64).powi(2), 2e-4);
    let flow: f64 = s.fuel_flow_kg_s.iter().sum();
    near("power_offtake", 2.0, 0.02 * 0.22 * (ratio / 0.73_f64).sqrt() / flow, 4e-4);
    near("anti_ice_bleed", 2.0, 0.02 * (1.0 / x).sqrt(), 4e-4);
    near("fuel_flow_gain", 2.0, 0.02, 1e-12);
    near("fuel_flow_gain_1", 3.0, 0.015, 1e-12);
    // Gravity at FL390 and 47° N minus Somigliana's 9.8085 … free air: fuel by the induced share.
    let local = fuel_change(sized("local_gravity", 1.0));
    assert!(local < 0.0 && local > -0.004, "{local}");
}

#[test]
fn ageing_is_fast_at_first_and_on_average_as_stated() {
    // Over the fleet's dates T: a(t) = T·(1 − e^(−t/T))/(1 − e^−1). From the first to the last date it grows by T years.
    let fly_at = |date: &str| {
        let mut plan =
            quiet_plan(vec![FlightPlan { start: date.parse().unwrap(), ..northbound() }]);
        plan.tails[0].references = Some(references());
        plan.effects = vec![sized("engine_ageing", 0.8)];
        let flown = fly_first(plan);
        column(&flown.report, "WF(1)")[0]
    };
    let date = |s: i64| flight::Timestamp::from_second(s).unwrap().to_string();
    let (first, middle, last) =
        (fly_at(&date(1_530_000_000)), fly_at(&date(1_560_000_000)), fly_at(&date(1_590_000_000)));
    let years = 60_000_000.0 / (365.25 * 86_400.0);
    assert!(((last / first - 1.0) / (0.008 * years) - 1.0).abs() < 0.06, "{}", last / first - 1.0);
    // (1 − e^−½)/(1 − e^−1) = 0.6225 of it in the first half.
    let share = (middle / first - 1.0) / (last / first - 1.0);
    assert!((share - 0.6225).abs() < 0.01, "{share}");
}

#[test]
fn a_step_holds_from_its_date_and_of_its_target() {
    let fly_at = |date: &str, target| {
        let mut plan =
            quiet_plan(vec![FlightPlan { start: date.parse().unwrap(), ..northbound() }]);
        let mut effect = sized("step_change", 1.5);
        effect.from = Some("2019-06-02T00:00:00Z".parse().unwrap());
        effect.target = target;
        plan.effects = vec![effect];
        let flown = fly_first(plan);
        (column(&flown.report, "WF(1)")[0], column(&flown.report, "N2(1)")[0])
    };
    let before = fly_at("2019-06-01T23:00:00Z", StepTarget::Drag);
    let drag = fly_at("2019-06-02T00:00:00Z", StepTarget::Drag);
    let fuel = fly_at("2019-06-02T00:00:00Z", StepTarget::FuelFlow);
    assert!((drag.0 / before.0 - 1.015).abs() < 4e-4 && drag.1 > before.1 * 1.001);
    assert!((fuel.0 / before.0 - 1.015).abs() < 4e-4 && (fuel.1 / before.1 - 1.0).abs() < 1.5e-4);
}

#[test]
fn recorded_errors_are_exact() {
    let base = fly(Vec::new());
    let with = fly(vec![sized("mach_bias", 0.004)]);
    assert!(
        (column(&with.report, "MACH")[0] - column(&base.report, "MACH")[0] - 0.004).abs() < 1e-12
    );
    // TAS follows from the wrong Mach number and the SAT that the wrong Mach number gives.
    let sat = column(&with.report, "SAT")[0];
    let expected = column(&with.report, "MACH")[0] * (1.4 * 287.05287 * sat).sqrt();
    assert!((column(&with.report, "VTAS")[0] - expected).abs() < 1e-9);

    let with = fly(vec![sized("temperature_bias", 2.0)]);
    // The probe reads 2·(1 + 0.2·0.75²) high; at M 0.80 that is SAT by 2·1.1125/1.128.
    let change = column(&with.report, "SAT")[0] - column(&base.report, "SAT")[0];
    assert!((change - 2.0 * 1.1125 / 1.128).abs() < 1e-3, "{change}");

    let with = fly(vec![sized("zero_fuel_mass_bias", 200.0)]);
    let mass = |flown: &Flown| flown.report.header().zero_fuel_mass.to_kilograms();
    assert!((mass(&base) - mass(&with) - 200.0).abs() < 1e-9);

    let with = fly(vec![sized("fuel_quantity_gain", 3.0)]);
    let (recorded, truth) = (column(&with.report, "FU")[7], column(&base.report, "FU")[7]);
    assert!((truth / recorded - 0.97).abs() < 1e-12);
    assert_eq!(column(&with.report, "FQ"), column(&base.report, "FQ"));

    // The scatter of the heating value: over flights its standard deviation is the size.
    let mut plan = quiet_plan(
        (0..400)
            .map(|i| FlightPlan { flight: format!("{i:04}"), duration_s: 120.0, ..northbound() })
            .collect(),
    );
    plan.effects = vec![sized("fuel_heating_value", 0.6)];
    plan.recording.after_top_of_climb_min = 0.0;
    let simulation = simulate::Simulation::new(plan).unwrap();
    let values: Vec<f64> = (0..400)
        .map(|i| simulation.fly(i).unwrap().truth.lower_heating_value_mj_kg / 43.24 - 1.0)
        .collect();
    let rms = (values.iter().map(|v| v * v).sum::<f64>() / 400.0).sqrt();
    assert!((rms - 0.006).abs() < 0.0007, "{rms}");
}
