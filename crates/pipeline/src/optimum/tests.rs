use std::fmt::Write;

use effects::{AppliedEffects, AppliedLayer, EffectReferences, Effects};
use flight::effect::EffectId;
use perf_model::{Aircraft, Guide, GuideLevel, GuideLevels, initial_model};

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

/// Long range is the Mach number of still air in any wind; its ground range is (V + w)/Wf, with the speed of sound written
/// out, and never more than that of maximum range in the same wind. There is none where the aircraft does not get on.
#[test]
fn long_range_has_the_mach_number_of_still_air_and_the_ground_range_of_the_wind() {
    let winds = [-50.0, 0.0, 50.0, -500.0];
    let all = found(&model(0.1, 0.8), 17_000.0, &question(&winds, None));
    let sound_m_s = (1.4_f64 * 287.052_87 * 216.65).sqrt();
    let of = |condition: &ConditionOptimum, kind: Kind| {
        let speeds = condition.levels.first().map_or(&[][..], |level| &level.speeds[..]);
        speeds.iter().copied().find(|speed| speed.kind == kind)
    };
    let still = of(&all[1], Kind::LongRange).unwrap();
    for (condition, wind_kt) in all.iter().zip(winds).take(3) {
        let long = of(condition, Kind::LongRange).unwrap();
        assert_eq!(long.mach.to_bits(), still.mach.to_bits());
        let ground_speed_m_s = long.mach * sound_m_s + wind_kt * 1852.0 / 3600.0;
        let expected = ground_speed_m_s / (long.fuel_flow_kg_h / 3600.0);
        assert!((long.ground_range_m_kg / expected - 1.0).abs() < 1e-6, "wind {wind_kt}");
        let most = of(condition, Kind::MaximumRange).unwrap();
        assert!(long.ground_range_m_kg < most.ground_range_m_kg, "wind {wind_kt}");
    }
    assert_eq!(of(&all[3], Kind::LongRange), None);
}

/// A model that has learnt nothing is its own book: nothing is saved, and nothing is known of intervals.
#[test]
fn an_initial_model_saves_nothing() {
    let all = found(&model(0.1, 0.0), 17_000.0, &question(&[0.0], None));
    let best = all[0].best[0];
    assert_eq!(Some(best.mach), best.book_mach);
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

/// The mark is at what lies at the edge: of one level that was asked for the level, not the Mach number that lies inside the table.
#[test]
fn the_mark_of_an_edge_is_at_the_level_or_at_the_mach_number() {
    let best = |mass_kg: f64| {
        let all = found(&model(0.1, 0.0), mass_kg, &question(&[0.0], None));
        let table = super::text::table(&all, None);
        (all[0].best[0].mach, table)
    };
    let (inside, table) = best(17_000.0);
    assert!(table.contains("370*"), "{table}");
    let row = table.lines().find(|line| line.starts_with("max range")).unwrap();
    assert!(!row.contains(&format!("370*  {inside:.3}*")), "{row}");
    let (highest, table) = best(45_000.0);
    let row = table.lines().find(|line| line.starts_with("max range")).unwrap();
    assert!(row.contains(&format!("370*  {highest:.3}*")), "{row}");
}

/// By hand: at 2,000 kg the optimum lies below the table's Mach 0.3, so that 99 % of the greatest specific range is not known: the
/// long-range Mach number is at that edge, though it lies above it.
#[test]
fn a_long_range_of_a_maximum_at_the_edge_is_at_the_edge() {
    assert!(mach_of((CD0 / (3.0 * K)).sqrt(), 2_000.0) < 0.3);
    let all = found(&model(0.1, 0.0), 2_000.0, &question(&[0.0], None));
    let [most, long] = all[0].levels[0].speeds[..] else { panic!("{all:?}") };
    assert_eq!((most.mach, most.edge), (0.3, Some(Edge::Lowest)));
    assert!(long.mach > 0.3 && long.edge == Some(Edge::Lowest), "{long:?}");
}

/// By hand: across masses of 10,000 to 20,000 kg, up to 40,000 ft, not above; files that keep neither have what they had.
#[test]
fn usual_masses_and_levels_are_those_of_the_guide() {
    let mut file = model(0.1, 0.0);
    let kilograms = |file: &ModelFile| -> Vec<f64> {
        usual_masses(file).unwrap().into_iter().map(Mass::to_kilograms).collect()
    };
    let thousands = |file: &ModelFile| {
        let feet = usual_levels(file).into_iter().map(|level| (level.to_feet() / 1e3).round());
        feet.collect::<Vec<f64>>()
    };
    file.guide.mass_kg = Some((10_000.0, 20_000.0));
    file.guide.pressure_altitude_m = Some((7_000.0, 12_192.0));
    assert_eq!(kilograms(&file), [11_000.0, 13_000.0, 15_000.0, 17_000.0, 19_000.0]);
    assert_eq!(thousands(&file), (22..=40).map(f64::from).collect::<Vec<_>>());
    file.guide.pressure_altitude_m = Some((0.0, 3_500.0));
    assert_eq!(thousands(&file), (1..=11).map(f64::from).collect::<Vec<_>>());
    file.guide.mass_kg = None;
    file.guide.pressure_altitude_m = None;
    assert_eq!(kilograms(&file).len(), 5);
    assert_eq!(thousands(&file), (25..=43).map(f64::from).collect::<Vec<_>>());
    let text = table(&found(&file, 17_000.0, &question(&[0.0], None)), Some(35_000.0));
    assert!(text.contains("Thrust, buffet, ceiling, MMO and VMO are not known"), "{text}");
    assert!(text.contains("have a point above FL 350"), "{text}");
}

/// A model that has learnt more than a table: fuel flow is what `predict` states of it, but for drag that is smooth between the
/// nodes, and the optimum is that of brute force over predictions. Drawn models scatter about it as it states that it knows.
#[test]
fn the_optimum_of_a_whole_model_is_that_of_its_predictions() {
    let file = crate::prediction::tests::whole();
    let predictor =
        crate::prediction::Predictor::new(&file, crate::whole_model::Predicts::WholeModel).unwrap();
    let whole = file.whole(crate::whole_model::Predicts::WholeModel).unwrap();
    let model = OptimumModel::new(&file, DRAWS, 1).unwrap();
    let condition = MassAndDay {
        mass: Mass::kilograms(32_000.0),
        isa_deviation: TemperatureDifference::kelvin(0.0),
    };
    let level = PressureAltitude::feet(41_000.0);
    let at_mach =
        |mach: f64| perf_model::FlightPoint::new(condition.mass, level, units::Mach::new(mach));
    let curve = model.curve(condition, level);
    let mut remainder: f64 = 0.0;
    for (at, point) in curve.points.iter().enumerate().step_by(10) {
        let flight_point = at_mach(f64::from(point.mach_thousandths) / 1000.0);
        let predicted = predictor.at(&flight_point).unwrap();
        let kg_s = predicted.prediction.fuel_flow_total.to_kilograms_per_second();
        assert!((curve.own_kg_s[at] / kg_s - 1.0).abs() < 5e-3, "{}", curve.own_kg_s[at] / kg_s);
        remainder = remainder.max(predicted.beside_table.unwrap().ln_fuel_flow.abs());
        let deviation = whole.of_point(&flight_point).unwrap().of_model().sqrt();
        let squares = curve.drawn_kg_s.iter().map(|drawn| (drawn[at] / curve.own_kg_s[at]).ln());
        let found = (squares.map(|ln| ln * ln).sum::<f64>() / DRAWS as f64).sqrt();
        assert!((found / deviation - 1.0).abs() < 0.25, "{found} {deviation}");
    }
    assert!(remainder > 5e-4, "without a remainder nothing is tested: {remainder}");

    let asked = Question { levels: vec![level], ..question(&[0.0], None) };
    let found = &at(&model, condition, &asked)[0].levels[0].speeds[0];
    let range = |mach: f64| {
        predictor.at(&at_mach(mach)).unwrap().prediction.specific_range.to_meters_per_kilogram()
    };
    let most = curve.points.iter().map(|point| range(f64::from(point.mach_thousandths) / 1000.0));
    let most = most.fold(0.0, f64::max);
    assert!(range(found.mach) > 0.999 * most, "{} {most}", range(found.mach));
}

/// What drag is more at a level the book burns more there, and a model that has learnt nothing, which plans by it: fuel flow is in
/// proportion to drag.
#[test]
fn the_book_has_its_factor_by_level() {
    let level = PressureAltitude::feet(37_000.0);
    let file = model(0.05, 0.0);
    let more = GuideLevel { pressure_altitude_m: level.to_meters(), shares: [0.03, 0.0, 0.0] };
    let levels = GuideLevels::new([(0.2, 0.6), (0.7, 0.9)], vec![more]).unwrap();
    let condition = MassAndDay {
        mass: Mass::kilograms(20_000.0),
        isa_deviation: TemperatureDifference::kelvin(0.0),
    };
    let curve = |levels: GuideLevels| {
        let initial = file.initial.base().clone().with_levels(levels).into();
        let file = ModelFile { initial, by_guide: None, ..file.clone() };
        OptimumModel::new(&file, 0, 1).unwrap().curve(condition, level)
    };
    let (without, with) = (curve(GuideLevels::default()), curve(levels));
    assert!(with.book_kg_s.len() > 50);
    for (more, kg_s) in with.book_kg_s.iter().zip(&without.book_kg_s) {
        assert!((more / kg_s - 1.03).abs() < 1e-12, "{more} {kg_s}");
    }
    for (more, kg_s) in with.own_kg_s.iter().zip(&without.own_kg_s) {
        assert!((more / kg_s - 1.03).abs() < 1e-12, "{more} {kg_s}");
    }
}

/// A table alone with 5 % more drag burns 5 % more than the book at every Mach number: fuel flow is in proportion to drag, and what
/// moves a prediction from chords to the smooth surface is not the effect.
#[test]
fn effects_on_drag_stay_in_fuel_flow() {
    let file = model(0.05, 0.0);
    let references = EffectReferences {
        date_s: 0.0,
        mach: 0.7,
        unit_reynolds_number_per_m: 5e6,
        temperature_ratio: 0.75,
        corrected_thrust_n: 1e5,
        fuel_flow_total_kg_s: 0.4,
        mass_kg: 30_000.0,
        center_of_gravity_percent_mac: None,
    };
    let layer = AppliedLayer::new(Effects::one(EffectId::DragFactor, 5.0), references);
    let more = file.initial.with_effects(AppliedEffects::new(vec![layer])).unwrap();
    let file = ModelFile { initial: more, by_guide: None, ..file };
    let condition = MassAndDay {
        mass: Mass::kilograms(20_000.0),
        isa_deviation: TemperatureDifference::kelvin(0.0),
    };
    let level = PressureAltitude::feet(37_000.0);
    let curve = OptimumModel::new(&file, 0, 1).unwrap().curve(condition, level);
    assert!(curve.own_kg_s.len() > 50);
    for (own, book) in curve.own_kg_s.iter().zip(&curve.book_kg_s) {
        assert!((own / book - 1.05).abs() < 3e-3, "{own} {book}");
    }
}
