use std::fmt::Write;

use perf_model::{Aircraft, Guide, initial_model};

use super::*;

/// A guide of a parabolic polar: CD = 0.02 + 0.045 CL², whatever the Mach number, by the TSFC law of the aircraft.
const CD0: f64 = 0.02;
const K: f64 = 0.045;
const WING_AREA_M2: f64 = 50.0;

fn aircraft(step: f64, mach_exponent: f64) -> Aircraft {
    Aircraft::from_ron(&format!(
        r#"(name: "parabola", type_code: "PARA", engines: 2, wing_area_m2: {WING_AREA_M2},
            tsfc: (static_lb_per_lbf_h: 0.5, mach_exponent: {mach_exponent}),
            table: (lift_coefficient: (0.1, 1.1, {step}), mach: (0.3, 0.9, {step})))"#
    ))
    .unwrap()
}

/// The model file of that polar; the guide has rows over the whole grid.
fn model(step: f64, mach_exponent: f64) -> ModelFile {
    let aircraft = aircraft(step, mach_exponent);
    let mut text = "mass_kg,pressure_altitude_ft,true_airspeed_kt,fuel_flow_kg_h\n".to_owned();
    let level = PressureAltitude::feet(37_000.0);
    let sat = atmos::isa::temperature(level).unwrap();
    let pressure = atmos::isa::pressure(level).unwrap();
    for mach in [0.3, 0.5, 0.7, 0.9] {
        for lift in [0.1, 0.35, 0.6, 0.85, 1.1] {
            let speed = atmos::airspeed::mach_to_true_airspeed(units::Mach::new(mach), sat);
            let density = atmos::isa::density(pressure, sat);
            let force_n =
                atmos::airspeed::dynamic_pressure(density, speed).to_pascals() * WING_AREA_M2;
            let tsfc = perf_model::tsfc::tsfc(
                aircraft.tsfc_law(),
                atmos::isa::temperature_ratio(sat),
                units::Mach::new(mach),
            );
            let flow_kg_h =
                force_n * (CD0 + K * lift * lift) * tsfc.to_kilograms_per_newton_second() * 3600.0;
            let mass_kg = force_n * lift / units::convert::STANDARD_GRAVITY_M_S2;
            let _ = writeln!(text, "{mass_kg},37000,{},{flow_kg_h}", speed.to_knots());
        }
    }
    let guide = Guide::from_csv(text.as_bytes()).unwrap();
    ModelFile::from_initial(&initial_model(&aircraft, &guide).unwrap(), &guide)
}

fn question(winds_kt: &[f64], cost_index: Option<CostIndex>) -> Question {
    Question {
        levels: vec![PressureAltitude::feet(37_000.0)],
        tailwinds: winds_kt.iter().map(|wind| TrueAirspeed::knots(*wind)).collect(),
        cost_index,
    }
}

fn found(file: &ModelFile, mass_kg: f64, question: &Question) -> Vec<ConditionOptimum> {
    let model = OptimumModel::new(file, 0, 1).unwrap();
    let condition = MassAndDay {
        mass: Mass::kilograms(mass_kg),
        isa_deviation: TemperatureDifference::kelvin(0.0),
    };
    at(&model, condition, question)
}

/// Mach number of a lift coefficient at 37,000 ft: the inverse of CL = m·g/(0.7·p·M²·S).
fn mach_of(lift: f64, mass_kg: f64) -> f64 {
    let pressure = atmos::isa::pressure(PressureAltitude::feet(37_000.0)).unwrap().to_pascals();
    (mass_kg * units::convert::STANDARD_GRAVITY_M_S2 / (0.7 * pressure * WING_AREA_M2 * lift))
        .sqrt()
}

fn mach(of: &ConditionOptimum, kind: Kind) -> f64 {
    of.levels[0].speeds.iter().find(|speed| speed.kind == kind).unwrap().mach
}

/// With TSFC independent of Mach number, specific range is greatest where √CL/CD is: CL² = CD0/(3K) (any textbook:
/// Anderson, *Aircraft Performance and Design*, 1999, section 5.13). The table's grid has no part in the answer.
#[test]
fn maximum_range_of_a_parabolic_polar_in_closed_form() {
    let lift = (CD0 / (3.0 * K)).sqrt();
    for step in [0.05, 0.1, 0.2] {
        for mass_kg in [12_000.0, 17_000.0, 20_000.0] {
            let expected = mach_of(lift, mass_kg);
            let all = found(&model(step, 0.0), mass_kg, &question(&[0.0], None));
            let optimum = mach(&all[0], Kind::MaximumRange);
            assert!((optimum - expected).abs() <= 0.001, "step {step}: {optimum} {expected}");
        }
    }
}

/// 99 % of the greatest specific range: with z = (`M/M_mrc)²`, `SR/SR_max` = 4 z^1.5/(3 z² + 1), solved by bisection for the
/// root above 1.
#[test]
fn long_range_of_a_parabolic_polar_in_closed_form() {
    let (mut low, mut high) = (1.0_f64, 2.0_f64);
    for _ in 0..60 {
        let z = f64::midpoint(low, high);
        if 4.0 * z.powf(1.5) / (3.0 * z * z + 1.0) > LONG_RANGE_SHARE { low = z } else { high = z }
    }
    let expected = mach_of((CD0 / (3.0 * K)).sqrt(), 17_000.0) * low.sqrt();
    let all = found(&model(0.1, 0.0), 17_000.0, &question(&[0.0], None));
    let optimum = mach(&all[0], Kind::LongRange);
    // The last thousandth that still has 99 %.
    assert!(optimum <= expected && expected - optimum < 0.001 + 1e-9, "{optimum} {expected}");
}

/// Cost index and wind, against the least of the cost over a fine grid of Mach numbers with the drag written out; a TSFC
/// that grows with Mach number.
#[test]
fn cost_index_in_wind_against_brute_force() {
    let (mass_kg, exponent, cost_index_kg_min) = (17_000.0, 0.8, 8.0);
    let file = model(0.1, exponent);
    let level = PressureAltitude::feet(37_000.0);
    let theta = atmos::isa::temperature(level).unwrap().to_kelvin() / 288.15;
    let pressure = atmos::isa::pressure(level).unwrap().to_pascals();
    let static_tsfc = 0.5 / (3600.0 * 9.80665);
    let sound_m_s = (1.4 * 287.052_87 * theta * 288.15_f64).sqrt();
    let cost = |mach: f64, wind_kt: f64| {
        let force_n = 0.7 * pressure * mach * mach * WING_AREA_M2;
        let lift = mass_kg * 9.80665 / force_n;
        let flow = force_n
            * (CD0 + K * lift * lift)
            * static_tsfc
            * theta.sqrt()
            * (1.0 + mach).powf(exponent);
        (flow + cost_index_kg_min / 60.0) / (mach * sound_m_s + wind_kt * 1852.0 / 3600.0)
    };
    let winds = [-80.0, 0.0, 80.0];
    let cost_index = Some(CostIndex::kilograms_per_minute(cost_index_kg_min));
    let all = found(&file, mass_kg, &question(&winds, cost_index));
    let mut before = f64::INFINITY;
    for (condition, wind) in all.iter().zip(winds) {
        let best = (3_000..9_000).map(|k| f64::from(k) / 10_000.0);
        let best = best.min_by(|a, b| cost(*a, wind).total_cmp(&cost(*b, wind))).unwrap();
        let optimum = mach(condition, Kind::CostIndex);
        assert!((optimum - best).abs() <= 0.001, "wind {wind}: {optimum} {best}");
        // A headwind is a reason to fly faster.
        assert!(optimum < before);
        before = optimum;
    }
}

/// A model that has learnt nothing is its own book: nothing is saved, and nothing is known of intervals.
#[test]
fn an_initial_model_saves_nothing() {
    let all = found(&model(0.1, 0.0), 17_000.0, &question(&[0.0], None));
    let best = all[0].best[0];
    assert!((best.mach - best.book_mach).abs() < 1e-12);
    assert_eq!((best.saving_kg_h, best.saving_ci95), (Some(0.0), None));
}

/// Heavier than the grid's lift coefficients carry at the optimum: what is found lies at the edge and says so.
#[test]
fn an_optimum_beyond_what_is_informed_is_at_the_edge() {
    let all = found(&model(0.1, 0.0), 45_000.0, &question(&[0.0], None));
    let speed = all[0].levels[0].speeds[0];
    assert_eq!((speed.kind, speed.edge), (Kind::MaximumRange, Some(Edge::Highest)));
    let nowhere = found(&model(0.1, 0.0), 450_000.0, &question(&[0.0], None));
    assert!(nowhere[0].levels.is_empty() && nowhere[0].best.is_empty());
}
