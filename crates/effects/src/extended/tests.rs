use std::sync::Arc;

use flight::effect::{DragRise, EffectId, HiddenParameter, History, StepTarget, ThrottleArgument};
use flight::{FlightIdentity, MAXIMUM_ENGINES};
use lut::surface::Basis;
use units::{Angle, Mach, Mass, PressureAltitude};

use super::*;
use crate::applied::{AppliedLayer, AtReference};
use crate::model::EffectModel;

mod outside;

const DATE_S: f64 = 1.5e9;
const YEAR_S: f64 = 365.25 * 86_400.0;

/// CD0 0.0188, K 0.056, a drag rise: no test depends on the values.
fn bare() -> ExtendedModel {
    let aircraft = Aircraft::from_ron(
        r#"(
            name: "test", type_code: "TEST", engines: 2, wing_area_m2: 48.96,
            tsfc: (static_lb_per_lbf_h: 0.48, mach_exponent: 0.8),
            table: (lift_coefficient: (0.10, 0.70, 0.05), mach: (0.50, 0.95, 0.05)),
        )"#,
    )
    .unwrap();
    let grid = aircraft.grid();
    let values = (0..grid.nodes())
        .map(|node| grid.coordinates(node))
        .map(|(lift, mach)| 0.0188 + 0.056 * lift * lift + 0.5 * (mach - 0.7_f64).max(0.0).powi(4))
        .collect();
    let table = Table::new(Arc::clone(grid), values).unwrap();
    let polynomial = Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] };
    let marks = vec![false; grid.nodes()];
    PerformanceModel::new(aircraft, polynomial, table, marks).unwrap().into()
}

fn references() -> EffectReferences {
    EffectReferences {
        date_s: DATE_S - YEAR_S,
        mach: 0.78,
        unit_reynolds_number_per_m: 5e6,
        temperature_ratio: 0.765,
        corrected_thrust_n: 60_000.0,
        fuel_flow_total_kg_s: 0.235,
        mass_kg: 13_600.0,
        center_of_gravity_percent_mac: Some(26.0),
    }
}

/// The same effects with hidden parameters that are not the library's.
fn hidden(effects: Effects) -> Effects {
    let argument = ThrottleArgument::CorrectedThrust;
    let from_s = DATE_S - 0.5 * YEAR_S;
    let step = HiddenParameter::Step { from_s, target: StepTarget::FuelFlow };
    effects
        .with_hidden(EffectId::TsfcThrottle, HiddenParameter::Throttle { pivot: 0.8, argument })
        .with_hidden(EffectId::WaveDrag, HiddenParameter::DragRise(DragRise::by_lock(0.86)))
        .with_hidden(EffectId::StepChange, step)
}

fn layer(effects: Effects) -> AppliedLayer {
    AppliedLayer::new(hidden(effects), references())
}

fn with(effects: Effects) -> ExtendedModel {
    bare().with_effects(AppliedEffects::new(vec![layer(effects)])).unwrap()
}

fn flight_point() -> FlightPoint {
    FlightPoint {
        date: Some("2017-07-14T02:40:00Z".parse().unwrap()), // 1.5e9 s since 1970
        center_of_gravity_percent_mac: Some(22.0),
        anti_ice: Some(true),
        latitude: Some(Angle::degrees(50.0)),
        true_heading: Some(Angle::degrees(60.0)),
        ..FlightPoint::new(
            Mass::kilograms(13_500.0),
            PressureAltitude::meters(12_000.0),
            Mach::new(0.8),
        )
    }
}

fn segment() -> Segment {
    let sat_k = 222.0_f64;
    let means = SegmentMeans {
        time_s: 0.0,
        pressure_altitude_m: 12_000.0,
        static_air_temperature_k: sat_k,
        mach: 0.8,
        true_airspeed_m_s: 0.8 * (1.4 * 287.05287 * sat_k).sqrt(),
        ground_speed_m_s: 250.0,
        acceleration_m_s2: 0.002,
        vertical_speed_m_s: 0.0,
        mass_kg: 13_500.0,
        fuel_flow_total_kg_s: 0.24,
        fuel_flow_engine_kg_s: vec![0.12, 0.12],
        fuel_used_kg: 1500.0,
        drift_deg: Some(-4.0),
        roll_deg: Some(0.5),
        roll_squared_deg2: Some(0.64),
        n2_percent: vec![],
        latitude_deg: Some(50.0),
        longitude_deg: None,
        true_heading_deg: Some(60.0),
        center_of_gravity_percent_mac: Some(22.0),
        total_air_temperature_k: None,
        n1_percent: [None; MAXIMUM_ENGINES],
        exhaust_gas_temperature_k: [None; MAXIMUM_ENGINES],
        fuel_quantity_kg: None,
        anti_ice: Some(1.0),
    };
    let identity = FlightIdentity {
        tail: "T".to_owned(),
        start: "2017-07-14T02:40:00Z".parse().unwrap(),
        flight: "1".to_owned(),
    };
    Segment {
        identity: Arc::new(identity),
        rows: (0..10).collect(),
        means,
        temperature_assumed: false,
    }
}

fn typical(id: EffectId) -> f64 {
    references().typical_size(id)
}

fn ids(of_recordings: bool) -> impl Iterator<Item = EffectId> {
    EffectId::library(2).into_iter().filter(move |id| id.is_of_recordings() == of_recordings)
}

#[test]
fn effects_of_recordings_never_change_a_prediction() {
    // A planner asks what will be burnt, not what a sensor with an error will indicate.
    let plain = bare().predict(&flight_point()).unwrap();
    let mut seen = 0;
    for id in ids(true) {
        let model = with(Effects::one(id, typical(id)));
        let found = model.predict(&flight_point()).unwrap();
        assert_eq!(
            found.fuel_flow_total.to_kilograms_per_second().to_bits(),
            plain.fuel_flow_total.to_kilograms_per_second().to_bits(),
            "{id}"
        );
        assert_eq!(format!("{found:?}"), format!("{plain:?}"), "{id}");
        // But it corrects what was recorded.
        assert_ne!(*model.corrected(&segment()).unwrap(), segment(), "{id}");
        seen += 1;
    }
    // zero_fuel_mass_bias, fuel_quantity_gain, mach_bias, static_pressure_bias, temperature_bias, fuel_flow_gain and
    // that of each engine.
    assert_eq!(seen, 8);
}

/// A segment whose fuel flow is that of the effect model is recorded with the effect as a *trial*: the oracle, itself
/// held against hand computations in its own tests.
fn recorded_with(id: EffectId, size: f64) -> Segment {
    let model = bare();
    let mut segment = segment();
    let effect_model = EffectModel::new(&model, model.drag_table(), references()).unwrap();
    let effects = hidden(Effects::one(id, size));
    // The engines' shares enter the mass: the recorded ones are those of the response.
    for _ in 0..3 {
        let point = EffectPoint::from_means(&segment.means, DATE_S, 2);
        let response = effect_model.response(&point, &effects).unwrap();
        segment.means.fuel_flow_total_kg_s = response.ln_fuel_flow_total.exp();
        segment.means.fuel_flow_engine_kg_s =
            response.ln_fuel_flow_engine[..2].iter().map(|ln| ln.exp()).collect();
    }
    segment
}

#[test]
fn a_model_that_contains_an_effect_leaves_nothing_of_it() {
    for id in EffectId::library(2) {
        if id == EffectId::FuelHeatingValue {
            continue; // a scatter moves no mean
        }
        let size = typical(id);
        let recorded = recorded_with(id, size);
        let model = with(Effects::one(id, size));
        // Against the bare model there is an error; with the effect there is none, and drag is the table's.
        let before = bare().predict_segment(&recorded, bare().drag_table()).unwrap();
        let after = model.predict_segment(&recorded, model.drag_table()).unwrap();
        assert!(before.error_percent.abs() > 1e-3, "{id}: {}", before.error_percent);
        assert!(after.error_percent.abs() < 1e-9, "{id}: {}", after.error_percent);
        let observed = model.observe(&recorded).unwrap().drag_coefficient;
        assert!((observed / after.drag_coefficient - 1.0).abs() < 1e-9, "{id}: {observed}");
    }
}

#[test]
fn a_throttle_effect_found_over_n2_acts_over_corrected_thrust() {
    let by_thrust = with(Effects::one(EffectId::TsfcThrottle, 0.6));
    let over_n2 = HiddenParameter::Throttle { pivot: 0.8, argument: ThrottleArgument::N2 };
    let effects =
        Effects::one(EffectId::TsfcThrottle, 0.6).with_hidden(EffectId::TsfcThrottle, over_n2);
    let layer = AppliedLayer::new(effects, references());
    let model = bare().with_effects(AppliedEffects::new(vec![layer])).unwrap();
    let flow = |model: &ExtendedModel| {
        model.predict(&flight_point()).unwrap().fuel_flow_total.to_kilograms_per_second()
    };
    assert_eq!(flow(&model).to_bits(), flow(&by_thrust).to_bits());
    assert_ne!(flow(&model).to_bits(), flow(&bare()).to_bits());
    // Nor does the corrected thrust that N2 indicates make a difference: every command gives the same.
    let at = EffectPoint {
        corrected_thrust_by_n2_n: Some(80_000.0),
        ..EffectPoint::from_means(&segment().means, DATE_S, 2)
    };
    let response = |model: &ExtendedModel| {
        let effects = EffectModel::new(model, model.drag_table(), references()).unwrap();
        effects.response(&at, &Effects::none()).unwrap()
    };
    assert_eq!(response(&model), response(&by_thrust));
}

#[test]
fn corrections_by_hand() {
    // Meter of engine 2 reads 4 % high, each engine records 0.12 kg/s: engine 2 burnt 0.12/1.04 = 0.115 384 615; the
    // total is 0.12·… minus half of 0.04/1.04 = 1.923 %; 1500 kg of fuel used become 1471.15 and the mass gains 28.85 kg.
    let model = with(Effects::one(EffectId::FuelFlowGainEngine(2), 4.0));
    let means = &model.corrected(&segment()).unwrap().means.clone();
    assert!((means.fuel_flow_engine_kg_s[0] - 0.12).abs() < 1e-15);
    assert!((means.fuel_flow_engine_kg_s[1] - 0.115_384_615_384_615).abs() < 1e-14);
    assert!((means.fuel_flow_total_kg_s - 0.235_384_615_384_615).abs() < 1e-14);
    assert!((means.fuel_used_kg - 1_471.153_846_153_846).abs() < 1e-9);
    assert!((means.mass_kg - 13_528.846_153_846_154).abs() < 1e-9);

    // Static pressure reads 0.3 % high: above the tropopause the true altitude is 216.65·287.05287/9.80665·ln 1.003 =
    // 19.0 m higher.
    let model = with(Effects::one(EffectId::StaticPressureBias, 0.3));
    let means = &model.corrected(&segment()).unwrap().means.clone();
    let higher = 216.65 * 287.052_87 / 9.806_65 * 1.003_f64.ln();
    assert!((means.pressure_altitude_m - 12_000.0 - higher).abs() < 1e-3, "{means:?}");
    // 1 + 0.2 M² = 1.128·1.003^(2/7): M = 0.803 01.
    let mach = ((1.128 * 1.003_f64.powf(2.0 / 7.0) - 1.0) / 0.2).sqrt();
    assert!((means.mach - mach).abs() < 1e-12);
}

#[test]
fn physical_effects_change_predictions_by_what_they_say() {
    let flow = |model: &ExtendedModel, point: &FlightPoint| {
        model.predict(point).unwrap().fuel_flow_total.to_kilograms_per_second()
    };
    let ratio =
        |effects: Effects, point: &FlightPoint| flow(&with(effects), point) / flow(&bare(), point);
    let point = flight_point();
    for (effects, expected, what) in [
        // Half of the fuel flow is engine 2's.
        (Effects::one(EffectId::TsfcEngine(2), 3.0), 1.015, "tsfc_engine_2"),
        // Without acceleration thrust is drag.
        (Effects::one(EffectId::DragFactor, 2.0), 1.02, "drag_factor"),
        (Effects::one(EffectId::AntiIceBleed, 2.0), 1.02, "anti_ice_bleed"),
        // A year after the reference, half a year after the step. 1.5e9 s is exact.
        (Effects::one(EffectId::EngineAgeing, 0.8), 1.008, "engine_ageing"),
        (Effects::one(EffectId::StepChange, 1.5), 1.015, "step_change"),
    ] {
        assert!((ratio(effects, &point) - expected).abs() < 1e-12, "{what}");
    }
    // Before its date a step is not there.
    let before = FlightPoint { date: Some("2016-08-01T00:00:00Z".parse().unwrap()), ..point };
    assert!((ratio(Effects::one(EffectId::StepChange, 1.5), &before) - 1.0).abs() < 1e-15);
    // 4 %MAC forward of the reference: 3 counts per 10 %MAC·CL/0.4.
    let plain = bare().predict(&point).unwrap();
    let trimmed = with(Effects::one(EffectId::TrimDragCg, 3.0)).predict(&point).unwrap();
    let counts = 3.0 * 0.4 * plain.lift_coefficient / 0.4;
    let found = 1e4 * (trimmed.drag_coefficient - plain.drag_coefficient);
    assert!((found - counts).abs() < 1e-9, "{found} {counts}");
    // Specific range and thrust go with it.
    let range = |p: &Prediction| {
        p.true_airspeed.to_meters_per_second() / p.fuel_flow_total.to_kilograms_per_second()
    };
    assert!((trimmed.specific_range.to_meters_per_kilogram() - range(&trimmed)).abs() < 1e-9);
}

#[test]
fn what_a_point_does_not_say_is_at_its_reference() {
    let bare_point = FlightPoint {
        mass: Mass::kilograms(13_500.0),
        ..FlightPoint::new(
            Mass::kilograms(13_500.0),
            PressureAltitude::meters(12_000.0),
            Mach::new(0.8),
        )
    };
    let plain = bare().predict(&bare_point).unwrap().fuel_flow_total.to_kilograms_per_second();
    for (id, missing) in [
        (EffectId::TrimDragCg, "cg_percent_mac"),
        (EffectId::AntiIceBleed, "anti_ice"),
        (EffectId::LocalGravity, "latitude_deg"),
        (EffectId::RotatingEarth, "latitude_deg"),
        (EffectId::LoadFactor, "roll"),
        (EffectId::AirframeAgeing, "date"),
        (EffectId::EngineAgeing, "date"),
        // The reference date, a year back, is before the step.
        (EffectId::StepChange, "date"),
    ] {
        let model = with(Effects::one(id, typical(id)));
        let effects = model.effects().unwrap();
        assert_eq!(effects.at_reference(&bare_point), vec![(AtReference::Effect(id), missing)]);
        let found = model.predict(&bare_point).unwrap().fuel_flow_total.to_kilograms_per_second();
        assert!((found / plain - 1.0).abs() < 1e-12, "{id}: {found} {plain}");
    }
    let model = with(Effects::one(EffectId::MachBias, 0.004).with(EffectId::DragFactor, 2.0));
    assert_eq!(model.effects().unwrap().at_reference(&bare_point), vec![]);
}

/// By hand: without a date, what had gathered by the reference date, half a year's worth; with one, a year later, half of the
/// sum before the fall and what came after it.
#[test]
fn a_history_is_as_on_the_reference_date_where_a_point_has_none() {
    let year_s = 365.25 * 86_400.0;
    let reference_s = references().date_s;
    let history = History::new(reference_s - 0.5 * year_s, 0.5, &[reference_s + 0.5 * year_s]);
    let hidden = HiddenParameter::History(history.unwrap());
    let effects =
        Effects::one(EffectId::EngineHistory, 2.0).with_hidden(EffectId::EngineHistory, hidden);
    let flow = |model: &ExtendedModel, point: &FlightPoint| {
        model.predict(point).unwrap().fuel_flow_total.to_kilograms_per_second()
    };
    let ratio = |point: &FlightPoint| flow(&with(effects.clone()), point) / flow(&bare(), point);
    let undated = FlightPoint { date: None, ..flight_point() };
    assert!((ratio(&undated) - 1.01).abs() < 1e-9, "{}", ratio(&undated));
    // One year after the reference: (0.5 + 0.5)·0.5 + 0.5 = 1 year.
    assert!((ratio(&flight_point()) - 1.02).abs() < 1e-6, "{}", ratio(&flight_point()));
}

#[test]
fn layers_come_one_on_top_of_the_other() {
    // 2 % of drag, then 3 % of the result: 1.02·1.03. Meters 2 % and 1 % high: 1/(1.02·1.01).
    let applied = AppliedEffects::new(vec![
        layer(Effects::one(EffectId::DragFactor, 2.0).with(EffectId::FuelFlowGain, 2.0)),
        layer(Effects::one(EffectId::DragFactor, 3.0).with(EffectId::FuelFlowGain, 1.0)),
    ]);
    let model = bare().with_effects(applied).unwrap();
    let flow = |model: &ExtendedModel| {
        model.predict(&flight_point()).unwrap().fuel_flow_total.to_kilograms_per_second()
    };
    assert!((flow(&model) / flow(&bare()) - 1.02 * 1.03).abs() < 1e-12);
    let corrected = model.corrected(&segment()).unwrap().means.fuel_flow_total_kg_s;
    assert!((corrected - 0.24 / (1.02 * 1.01)).abs() < 1e-12);
    // Another table keeps them, and effects in the place of others leave none of these.
    let moved = model.with_drag_table(model.drag_table().clone()).unwrap();
    assert_eq!(moved, model);
    assert_eq!(model.with_effects(AppliedEffects::default()).unwrap(), bare());
}

#[test]
fn trial_effects_come_on_top_and_known_ones_are_settled() {
    let model = with(Effects::one(EffectId::DragFactor, 2.0).with(EffectId::LocalGravity, 1.0));
    let plain = bare();
    let on_top = EffectModel::new(&model, model.drag_table(), references()).unwrap();
    let alone = EffectModel::new(&plain, plain.drag_table(), references()).unwrap();
    let point = EffectPoint::from_means(&segment().means, DATE_S, 2);
    let contained = Effects::one(EffectId::DragFactor, 2.0).with(EffectId::LocalGravity, 1.0);
    // Contained effects act exactly as the same trial effects did.
    assert_eq!(
        on_top.response(&point, &Effects::none()).unwrap(),
        alone.response(&point, &contained).unwrap()
    );
    let applied = on_top.applied().unwrap();
    assert!(applied.settles(EffectId::LocalGravity) && !applied.settles(EffectId::DragFactor));
    assert!(applied.contains(EffectId::DragFactor) && !applied.contains(EffectId::WaveDrag));
    assert!(!on_top.contains(EffectId::RotatingEarth) && alone.applied().is_none());
}

#[test]
fn sizes_that_are_no_numbers_are_refused() {
    let applied = AppliedEffects::new(vec![layer(Effects::one(EffectId::DragFactor, f64::NAN))]);
    assert!(matches!(
        bare().with_effects(applied),
        Err(EffectModelError::Size { effect: EffectId::DragFactor, .. })
    ));
}

/// By hand: scatters of 0.3 and 0.4 % in two layers are one of 0.5 %; other effects are no scatter.
#[test]
fn scatters_of_layers_add_in_squares() {
    let scatter = |percent: f64| Effects::one(EffectId::FuelHeatingValue, percent);
    let other = scatter(0.4).with(EffectId::TsfcFactor, 3.0);
    let applied = AppliedEffects::new(vec![layer(scatter(0.3)), layer(other)]);
    assert!((applied.fuel_heating_value_deviation() - 0.005).abs() < 1e-15);
    assert!(AppliedEffects::default().fuel_heating_value_deviation().abs() < 1e-15);
}

/// By hand: engine 2 burns 0.4 of the fuel and its meter counts 5 % more, 1.02 of it all; another 1 % on all meters makes
/// 1.02·1.01. Without an error the meters count what is burnt.
#[test]
fn metered_fuel_over_burnt_fuel_by_hand() {
    let ratio = |layers: &[Effects]| {
        let layers = layers.iter().cloned().map(layer).collect();
        let model = bare().with_effects(AppliedEffects::new(layers)).unwrap();
        let effects = EffectModel::new(&model, model.drag_table(), references()).unwrap();
        let at = EffectPoint::from_segment(&segment(), 2);
        effects.metered_over_burnt(&EffectPoint { fuel_flow_share: [0.6, 0.4, 0.0, 0.0], ..at })
    };
    let one = Effects::one(EffectId::FuelFlowGainEngine(2), 5.0);
    let all = Effects::one(EffectId::FuelFlowGain, 1.0);
    assert!((ratio(&[]) - 1.0).abs() < 1e-15);
    assert!((ratio(std::slice::from_ref(&one)) - 1.02).abs() < 1e-15);
    assert!((ratio(&[one, all]) - 1.02 * 1.01).abs() < 1e-15);
}
