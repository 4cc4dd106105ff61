use std::sync::Arc;

use flight::effect::{DragRise, HiddenParameter, History, StepTarget, ThrottleArgument};
use flight::{Cruise, FlightIdentity, Segment};
use lut::surface::{Basis, Surface};
use perf_model::PerformanceModel;
use units::{FuelFlowTotal, Mach, Mass, PressureAltitude, Temperature, TrueAirspeed};

use super::*;
use crate::mean::mean_references;
use crate::response::value_continued;

/// Constants of the numerical prototype whose signature table is the oracle: CD0 0.0188, K 0.056, Lock's wave drag with
/// Mdd 0.797 + 0.1077 at lift coefficient 0.35, TSFC exponent 0.8.
const CD0: f64 = 0.0188;
const K: f64 = 0.056;
const MDD: f64 = 0.797 + 0.1077;

fn wave(mach: f64, lift: f64) -> f64 {
    20.0 * (mach - (0.797 - 0.085 * (lift - 0.35))).max(0.0).powi(4)
}

fn model(with_wave: bool) -> ExtendedModel {
    let aircraft = Aircraft::from_ron(
        r#"(
            name: "test", type_code: "TEST", engines: 2, wing_area_m2: 48.96,
            tsfc: (static_lb_per_lbf_h: 0.48, mach_exponent: 0.8),
            table: (lift_coefficient: (0.10, 0.70, 0.005), mach: (0.50, 0.95, 0.005)),
        )"#,
    )
    .unwrap();
    let grid = aircraft.grid();
    let values = (0..grid.nodes())
        .map(|node| grid.coordinates(node))
        .map(|(lift, mach)| CD0 + K * lift * lift + if with_wave { wave(mach, lift) } else { 0.0 })
        .collect();
    let table = Table::new(Arc::clone(grid), values).unwrap();
    let polynomial = Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] };
    let marks = vec![false; grid.nodes()];
    PerformanceModel::new(aircraft, polynomial, table, marks).unwrap().into()
}

fn point(mach: f64) -> EffectPoint {
    let sat_k = 222.0_f64;
    EffectPoint {
        date_s: 1.5e9,
        pressure_altitude_m: 12_000.0,
        static_air_temperature_k: sat_k,
        is_temperature_assumed: false,
        mach,
        true_airspeed_m_s: mach * (1.4 * 287.05287 * sat_k).sqrt(),
        ground_speed_m_s: 250.0,
        acceleration_m_s2: 0.0,
        mass_kg: 13_500.0,
        fuel_used_kg: 1500.0,
        fuel_flow_share: [0.5, 0.5, 0.0, 0.0],
        roll_squared_deg2: Some(0.64),
        drift_deg: Some(-4.0),
        latitude_deg: Some(50.0),
        true_heading_deg: Some(60.0),
        center_of_gravity_percent_mac: Some(22.0),
        anti_ice: None,
        corrected_thrust_by_n2_n: None,
    }
}

fn references() -> EffectReferences {
    EffectReferences {
        date_s: 1.5e9 - 365.25 * 86_400.0,
        mach: 0.8,
        unit_reynolds_number_per_m: 5e6,
        temperature_ratio: 0.765,
        corrected_thrust_n: 60_000.0,
        fuel_flow_total_kg_s: 0.235,
        mass_kg: 13_600.0,
        center_of_gravity_percent_mac: Some(26.0),
    }
}

/// The prototype's quantities at a point: CL, CD, wi = K CL²/CD, w0 = CD0/CD and the partial derivatives of wave drag.
struct Hand {
    cl: f64,
    cd: f64,
    wi: f64,
    w0: f64,
    wave_per_mach: f64,
    wave_per_cl: f64,
}

fn hand(at: &EffectPoint) -> Hand {
    // ICAO standard atmosphere at 12 000 m of geopotential: 19 330.4 Pa (22 632.06 Pa·exp(−g0·1000/(R·216.65))).
    let q = 0.7 * 19_330.4 * at.mach * at.mach;
    let cl = at.mass_kg * 9.80665 / (q * 48.96);
    let cd = CD0 + K * cl * cl + wave(at.mach, cl);
    let beyond = (at.mach - (0.797 - 0.085 * (cl - 0.35))).max(0.0);
    let wave_per_mach = 80.0 * beyond.powi(3);
    Hand {
        cl,
        cd,
        wi: K * cl * cl / cd,
        w0: CD0 / cd,
        wave_per_mach,
        wave_per_cl: 0.085 * wave_per_mach,
    }
}

/// Central difference of ln recorded fuel flow, per unit of θ.
fn slope(model: &EffectModel<'_>, at: &EffectPoint, effect: EffectId, step: f64) -> f64 {
    let hidden = match effect.entry().hidden {
        HiddenParameter::DragRise(_) => HiddenParameter::DragRise(DragRise::by_lock(MDD)),
        HiddenParameter::Step { target, .. } => {
            HiddenParameter::Step { from_s: at.date_s - 1.0, target }
        }
        // A year of gathering, of which 60 % was taken back in its middle: 0.5·0.4 + 0.5 = 0.7 years.
        HiddenParameter::History(_) => {
            let year_s = 365.25 * 86_400.0;
            let fall_s = at.date_s - 0.5 * year_s;
            HiddenParameter::History(History::new(at.date_s - year_s, 0.6, &[fall_s]).unwrap())
        }
        other => other,
    };
    let value = |size: f64| {
        let effects = Effects::one(effect, size).with_hidden(effect, hidden);
        model.response(at, &effects).unwrap().ln_fuel_flow_total
    };
    (value(step) - value(-step)) / (2.0 * step)
}

/// The table of signatures in the theory page's section on effects, written out: every effect with a step of its size,
/// dlnWf/dθ by hand and the relative tolerance. The fitted polar gives CD0(M) and K(M) where an effect scales them.
fn signatures_by_hand(polar: [f64; 6], mach: f64) -> Vec<(EffectId, f64, f64, f64)> {
    let [p0, p1, p2, p3, p4, p5] = polar;
    let at = point(mach);
    let h = hand(&at);
    let zero_lift = p0 + p1 * mach + p2 * mach * mach;
    let induced = p3 + p4 * mach + p5 * mach * mach;
    let e_m = 2.0 * h.wi + h.cl * h.wave_per_cl / h.cd;
    let wave_share = wave(mach, h.cl) / h.cd;
    let e_p = h.w0 + wave_share - h.wi - h.cl * h.wave_per_cl / h.cd;
    let e_mach = 2.0 / mach * e_p + h.wave_per_mach / h.cd + 0.8 / (1.0 + mach);
    // θ = 222/288.15; δ = 19 330.4/101 325.
    let theta: f64 = 222.0 / 288.15;
    let thrust = 0.7 * 19_330.4 * mach * mach * 48.96 * h.cd;
    let x = thrust / (19_330.4 / 101_325.0) / 60_000.0;
    let tsfc = 0.48 / (3600.0 * 9.80665) * theta.sqrt() * (1.0 + mach).powf(0.8);
    let density = 19_330.4 / (287.05287 * 222.0);
    let viscosity = 1.458e-6 * 222.0_f64.powf(1.5) / (222.0 + 110.4);
    let reynolds = density * at.true_airspeed_m_s / viscosity;
    // f = 2Ω sin 50°; drift −4°: the wind blows to the left, the surface climbs.
    let coriolis = 2.0 * 7.292115e-5 * 50.0_f64.to_radians().sin();
    // Across the nose the ground speed has the wind alone.
    let cross = at.ground_speed_m_s * 4.0_f64.to_radians().sin();
    // Eötvös by hand on a sphere of 6371 km: V²/R + 2ΩV_east cos φ, heading 60° less 4° of drift.
    let east = 250.0 * 56.0_f64.to_radians().sin();
    let lighter = 2.0 * 7.292115e-5 * east * 50.0_f64.to_radians().cos() + 250.0 * 250.0 / 6.371e6;
    // International gravity formula 1980 with the free-air gradient.
    let sine = 50.0_f64.to_radians().sin().powi(2);
    let gravity = 9.780327 * (1.0 + 0.0053024 * sine) - 3.086e-6 * 12_000.0;
    let percent = 0.01;
    vec![
        (EffectId::ZeroLiftDrag, 0.01, 1e-4 / h.cd, 3e-4),
        (EffectId::DragFactor, 0.01, percent, 2e-5),
        (EffectId::InducedDrag, 0.01, percent * induced * h.cl * h.cl / h.cd, 3e-4),
        (EffectId::WaveDrag, 1e-5, h.wave_per_mach / h.cd, 2e-3),
        (EffectId::ReynoldsNumber, 1e-4, -zero_lift / h.cd * (reynolds / 5e6).ln(), 3e-4),
        (EffectId::TrimDragCg, 0.01, 1e-4 * 0.4 * h.cl / 0.4 / h.cd, 3e-4),
        (EffectId::AsymmetryDrag, 0.01, 1e-4 * 0.64 / h.cd, 3e-4),
        (EffectId::AirframeAgeing, 0.01, percent * zero_lift / h.cd, 3e-4),
        (EffectId::TsfcFactor, 0.01, percent, 2e-5),
        (EffectId::TsfcEngine(2), 0.01, 0.5 * percent, 2e-5),
        (EffectId::TsfcMachExponent, 1e-3, ((1.0 + mach) / 1.8).ln(), 1e-6),
        (EffectId::TsfcTemperatureExponent, 1e-3, (theta / 0.765).ln(), 1e-6),
        (EffectId::TsfcThrottle, 0.01, percent * ((x - 1.0) / 0.25).powi(2), 8e-3),
        (EffectId::PowerOfftake, 0.01, percent * 0.235 / (thrust * tsfc), 3e-4),
        // 222 K is below −40 °C and no A/I is recorded.
        (EffectId::AntiIceBleed, 0.01, 0.0, 1e-12),
        // Exactly one year after the reference.
        (EffectId::EngineAgeing, 0.01, percent, 2e-5),
        (EffectId::ZeroFuelMassBias, 1.0, e_m / 13_500.0, 1e-2),
        (EffectId::FuelQuantityGain, 0.01, percent * e_m * 1500.0 / 13_500.0, 1e-2),
        (EffectId::MachBias, 1e-5, -e_mach, 1.2e-2),
        (
            EffectId::StaticPressureBias,
            1e-3,
            percent * (-e_p + e_mach * (1.0 + 0.2 * mach * mach) / (1.4 * mach)),
            1.2e-2,
        ),
        (EffectId::TemperatureBias, 0.01, -1.0 / (2.0 * 222.0), 2e-5),
        (EffectId::FuelFlowGain, 0.01, percent * (1.0 + e_m * 1500.0 / 13_500.0), 1e-3),
        (
            EffectId::FuelFlowGainEngine(1),
            0.01,
            0.5 * percent * (1.0 + e_m * 1500.0 / 13_500.0),
            1e-3,
        ),
        (EffectId::LocalGravity, 0.01, e_m * (gravity / 9.80665 - 1.0), 2e-2),
        (EffectId::RotatingEarth, 0.01, -e_m * lighter / 9.80665, 2e-2),
        (EffectId::LoadFactor, 0.01, e_m * (1.0 / 0.8_f64.to_radians().cos() - 1.0), 1e-2),
        (EffectId::IsobaricSlope, 0.01, 13_500.0 * coriolis * cross / thrust, 2e-4),
        (EffectId::StepChange, 0.01, percent, 2e-5),
        (EffectId::EngineHistory, 0.01, percent * 0.7, 2e-5),
        (EffectId::AirframeHistory, 0.01, percent * 0.7 * zero_lift / h.cd, 3e-4),
    ]
}

#[test]
fn every_signature_against_its_formula_by_hand() {
    let performance = model(true);
    let effects = EffectModel::new(&performance, performance.drag_table(), references()).unwrap();
    for mach in [0.7613, 0.8471] {
        let at = point(mach);
        let cases = signatures_by_hand(effects.bare.polar.coefficients, mach);
        for id in EffectId::ALL {
            let tried = cases.iter().any(|case| case.0.entry() == id.entry());
            assert_eq!(tried, id.has_signature(), "{id} has no formula by hand");
        }
        for (effect, step, expected, relative) in cases {
            let found = slope(&effects, &at, effect, step);
            // A chord's slope is that of the cell's middle: up to 0.0025/0.36 = 0.7 % off along lift coefficient.
            assert!(
                (found - expected).abs() <= relative * expected.abs() + 2e-7,
                "{effect} at Mach {mach}: {found:e}, by hand {expected:e}"
            );
        }
    }
}

fn segment() -> Segment {
    let identity = FlightIdentity {
        tail: "T-001".into(),
        start: "2018-05-20T14:14:21Z".parse().unwrap(),
        flight: "0007".into(),
    };
    Segment {
        identity: Arc::new(identity),
        rows: vec![3, 4, 5, 7, 8, 9, 10, 12],
        means: SegmentMeans {
            time_s: 570.25,
            ground_speed_m_s: 215.0,
            acceleration_m_s2: 0.004,
            fuel_flow_engine_kg_s: vec![0.26, 0.24],
            fuel_used_kg: 1000.0,
            ..SegmentMeans::cruise(&Cruise {
                pressure_altitude: PressureAltitude::meters(12_496.8),
                static_air_temperature: Temperature::kelvin(220.4),
                mach: Mach::new(0.803),
                true_airspeed: TrueAirspeed::meters_per_second(239.4),
                mass: Mass::kilograms(13_500.0),
                fuel_flow_total: FuelFlowTotal::kilograms_per_second(0.5),
            })
        },
        temperature_assumed: false,
    }
}

#[test]
fn without_effects_it_is_the_models_own_prediction() {
    let performance = model(true);
    let effects = EffectModel::new(&performance, performance.drag_table(), references()).unwrap();
    let segment = segment();
    let predicted = performance.predict_segment(&segment, performance.drag_table()).unwrap();
    let at = EffectPoint::from_means(&segment.means, 0.0, 2);
    let response = effects.response(&at, &Effects::none()).unwrap();
    let flow = predicted.fuel_flow_total.to_kilograms_per_second();
    assert!((response.ln_fuel_flow_total.exp() / flow - 1.0).abs() < 1e-13);
    // Recorded 0.26 and 0.24: shares 0.52 and 0.48.
    assert!((at.fuel_flow_share[0] - 0.52).abs() < 1e-15);
    // 17 671 days from 1970 to 2018-05-20, then 14:14:21 and 570.25 s of flight.
    let date_s = EffectPoint::from_segment(&segment, 2).date_s;
    assert!((date_s - (17_671.0 * 86_400.0 + 51_261.0 + 570.25)).abs() < 1e-6, "{date_s}");
}

/// Fuel flow of level flight is TSFC times drag, so that two tables' predictions differ by the ratio of their drag. Between
/// nodes of a grid of 0.1 the chord lies above the parabola; the smooth surface is the parabola itself (by hand).
#[test]
fn a_smooth_table_is_the_parabola_that_it_was_made_of() {
    let aircraft = r#"(
        name: "test", type_code: "TEST", engines: 2, wing_area_m2: 48.96,
        tsfc: (static_lb_per_lbf_h: 0.48, mach_exponent: 0.8),
        table: (lift_coefficient: (0.10, 0.70, 0.1), mach: (0.50, 0.95, 0.15)),
    )"#;
    let aircraft = Aircraft::from_ron(aircraft).unwrap();
    let grid = Arc::clone(aircraft.grid());
    let drag = |(lift, mach): (f64, f64)| CD0 + 0.01 * mach * mach + K * lift * lift;
    let values = (0..grid.nodes()).map(|node| drag(grid.coordinates(node))).collect();
    let table = Table::new(Arc::clone(&grid), values).unwrap();
    let polynomial = Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] };
    let marks = vec![false; grid.nodes()];
    let model: ExtendedModel =
        PerformanceModel::new(aircraft, polynomial, table, marks).unwrap().into();
    let bilinear = EffectModel::new(&model, model.drag_table(), references()).unwrap();
    let smooth = bilinear.clone().between_nodes(BetweenNodes::Smooth);
    assert!(bilinear.is_bilinear() && !smooth.is_bilinear());
    for mach in [0.72, 0.77, 0.83] {
        let at = point(mach);
        let of = |model: &EffectModel<'_>| model.response(&at, &Effects::none()).unwrap();
        let (chord, curve) = (of(&bilinear), of(&smooth));
        let state = (curve.lift_coefficient, mach);
        let cell = grid.locate(state.0, state.1, lut::Outside::Error).unwrap();
        let expected = (model.drag_table().interpolate(&cell) / drag(state)).ln();
        assert!(expected > 1e-4, "the chord is off: {expected}");
        let found = chord.ln_fuel_flow_total - curve.ln_fuel_flow_total;
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

/// A plane is its own straight continuation, by definition: inside the table, beyond each edge and beyond its corners.
#[test]
fn a_plane_is_continued_as_the_plane() {
    let axis = |values: [f64; 3]| lut::Axis::new(values.to_vec()).unwrap();
    let grid = Arc::new(lut::Grid::new(axis([0.2, 0.3, 0.5]), axis([0.6, 0.7, 0.8])));
    let plane = |(lift, mach): (f64, f64)| 0.01 + 0.04 * lift + 0.02 * mach;
    let values = (0..grid.nodes()).map(|node| plane(grid.coordinates(node))).collect();
    let table = Table::new(grid, values).unwrap();
    let smooth = lut::SmoothTable::new(&table);
    for surface in [None, Some(&smooth)] {
        let continued = |lift, mach| value_continued((&table, surface), lift, mach);
        for lift in [0.15, 0.25, 0.41, 0.6] {
            for mach in [0.55, 0.62, 0.74, 0.9] {
                let found = continued(lift, mach).unwrap();
                assert!((found - plane((lift, mach))).abs() < 1e-12, "{lift} {mach}: {found}");
            }
        }
        assert_eq!(continued(f64::NAN, 0.7), None);
    }
}

/// The same as a point that is made from the start ([`EffectModel::response_beside`]), to the last bit.
#[test]
fn another_mass_or_acceleration_in_the_same_air() {
    let performance = model(true);
    let effects = EffectModel::new(&performance, performance.drag_table(), references()).unwrap();
    let at = point(0.80);
    let (known, _) = effects.known_point(&at).unwrap();
    for (mass_kg, acceleration_m_s2) in [(13_500.0, 0.01), (13_700.0, 0.0), (12_900.0, -0.02)] {
        let moved = EffectPoint { acceleration_m_s2, mass_kg, ..at };
        let expected = effects.response_beside(&moved, &Effects::none()).unwrap();
        let found = effects.response_with_mass_and_acceleration(&known, mass_kg, acceleration_m_s2);
        assert_eq!(found.unwrap(), expected);
    }
}

/// A recording with known errors, made from a true state by hand: undoing them gives the true prediction back, not only
/// to first order.
#[test]
fn sensor_errors_are_undone_exactly() {
    let performance = model(true);
    let effects = EffectModel::new(&performance, performance.drag_table(), references()).unwrap();
    let truth = point(0.80);
    let flown = effects.response(&truth, &Effects::none()).unwrap();
    let same = |recorded: &EffectPoint, effect: EffectId, size: f64, added: f64| {
        let undone = effects.response(recorded, &Effects::one(effect, size)).unwrap();
        let gap = undone.ln_fuel_flow_total - flown.ln_fuel_flow_total - added;
        assert!(gap.abs() < 1e-9, "{effect}: {gap:e}");
    };
    let sound = (1.4_f64 * 287.05287 * 222.0).sqrt();
    // Mach number reads 0.02 high, and true airspeed with it.
    let mach = EffectPoint { mach: 0.82, true_airspeed_m_s: 0.82 * sound, ..truth };
    same(&mach, EffectId::MachBias, 0.02, 0.0);
    // SAT reads 8 K high; true airspeed by √(230/222).
    let warm = EffectPoint {
        static_air_temperature_k: 230.0,
        true_airspeed_m_s: truth.true_airspeed_m_s * (230.0_f64 / 222.0).sqrt(),
        ..truth
    };
    same(&warm, EffectId::TemperatureBias, 8.0, 0.0);
    // Static pressure reads 3 % high: pressure altitude lower by R·216.65/g0·ln 1.03 in the isothermal layer; recorded
    // Mach number from the same total pressure.
    let lower = 287.05287 * 216.65 / 9.80665 * 1.03_f64.ln();
    let recorded_mach = (((1.0 + 0.2 * 0.64) * 1.03_f64.powf(-2.0 / 7.0) - 1.0) / 0.2_f64).sqrt();
    let pressure = EffectPoint {
        pressure_altitude_m: 12_000.0 - lower,
        mach: recorded_mach,
        true_airspeed_m_s: recorded_mach * sound,
        ..truth
    };
    assert!(pressure.pressure_altitude_m > 11_000.0);
    same(&pressure, EffectId::StaticPressureBias, 3.0, 0.0);
    // 500 kg more on board than recorded.
    let heavy = EffectPoint { mass_kg: 13_000.0, ..truth };
    same(&heavy, EffectId::ZeroFuelMassBias, 500.0, 0.0);
    // Recorded fuel used 1500/0.9: true is 10 % less than recorded.
    let used = 1500.0 / 0.9;
    let counted =
        EffectPoint { fuel_used_kg: used, mass_kg: truth.mass_kg - (used - 1500.0), ..truth };
    same(&counted, EffectId::FuelQuantityGain, 10.0, 0.0);
    // Both meters read 5 % high: fuel used 1575 kg, mass 75 kg too low, recorded fuel flow ln 1.05 up.
    let metered = EffectPoint { fuel_used_kg: 1575.0, mass_kg: truth.mass_kg - 75.0, ..truth };
    same(&metered, EffectId::FuelFlowGain, 5.0, 1.05_f64.ln());
    // Only engine 2 reads 5 % high: its share is 1.05/2.05, fuel used 1537.5 kg.
    let one = EffectPoint {
        fuel_used_kg: 1537.5,
        mass_kg: truth.mass_kg - 37.5,
        fuel_flow_share: [1.0 / 2.05, 1.05 / 2.05, 0.0, 0.0],
        ..truth
    };
    same(&one, EffectId::FuelFlowGainEngine(2), 5.0, 1.025_f64.ln());
}

#[test]
fn dated_steps_begin_on_their_date_and_know_drag_from_fuel_flow() {
    let performance = model(true);
    let effects = EffectModel::new(&performance, performance.drag_table(), references()).unwrap();
    let at = point(0.8);
    let step = |from_s: f64, target: StepTarget| {
        let hidden = HiddenParameter::Step { from_s, target };
        let on = Effects::one(EffectId::StepChange, 3.0).with_hidden(EffectId::StepChange, hidden);
        effects.response(&at, &on).unwrap()
    };
    let plain = effects.response(&at, &Effects::none()).unwrap();
    let fuel = step(at.date_s, StepTarget::FuelFlow);
    let drag = step(at.date_s, StepTarget::Drag);
    assert!((fuel.ln_fuel_flow_total - plain.ln_fuel_flow_total - 1.03_f64.ln()).abs() < 1e-14);
    assert!((fuel.ln_corrected_thrust - plain.ln_corrected_thrust).abs() < 1e-14);
    assert!((drag.ln_fuel_flow_total - plain.ln_fuel_flow_total - 1.03_f64.ln()).abs() < 1e-14);
    assert!((drag.ln_corrected_thrust - plain.ln_corrected_thrust - 1.03_f64.ln()).abs() < 1e-14);
    assert_eq!(step(at.date_s + 1.0, StepTarget::Drag), plain);
    // Of one of two engines: half of it in all, thrust the same, and the engine apart from the other by 3 %.
    let engine = step(at.date_s, StepTarget::Engine2);
    assert!((engine.ln_fuel_flow_total - plain.ln_fuel_flow_total - 1.015_f64.ln()).abs() < 1e-14);
    assert!((engine.ln_corrected_thrust - plain.ln_corrected_thrust).abs() < 1e-14);
    let apart = |of: &Response| of.ln_fuel_flow_engine[1] - of.ln_fuel_flow_engine[0];
    assert!((apart(&engine) - apart(&plain) - 1.03_f64.ln()).abs() < 1e-14);
    assert_eq!(step(at.date_s + 1.0, StepTarget::Engine2), plain);
}

/// F/δ that N2 indicates is 1.3 references, pivot 0.9: ((1.3 − 0.9)/0.25)² = 2.56, at 0.5 % a factor of 1.0128.
#[test]
fn the_throttle_effect_over_n2_by_hand() {
    let performance = model(true);
    let effects = EffectModel::new(&performance, performance.drag_table(), references()).unwrap();
    let over = |at: &EffectPoint, argument: ThrottleArgument| {
        let hidden = HiddenParameter::Throttle { pivot: 0.9, argument };
        let id = EffectId::TsfcThrottle;
        let on = Effects::one(id, 0.5).with_hidden(id, hidden);
        effects.response(at, &on).unwrap()
    };
    let at = EffectPoint { corrected_thrust_by_n2_n: Some(1.3 * 60_000.0), ..point(0.8) };
    let plain = effects.response(&at, &Effects::none()).unwrap();
    let by_n2 = over(&at, ThrottleArgument::N2);
    assert!((by_n2.ln_fuel_flow_total - plain.ln_fuel_flow_total - 1.0128_f64.ln()).abs() < 1e-14);
    // N2 moves the argument of TSFC, not the thrust that is flown.
    assert!((by_n2.ln_corrected_thrust - plain.ln_corrected_thrust).abs() < 1e-15);
    // Over corrected thrust the point's N2 is not used.
    let x = plain.ln_corrected_thrust.exp() / 60_000.0;
    let factor: f64 = 1.0 + 0.005 * ((x - 0.9) / 0.25).powi(2);
    let by_thrust = over(&at, ThrottleArgument::CorrectedThrust);
    let grown = by_thrust.ln_fuel_flow_total - plain.ln_fuel_flow_total;
    assert!((grown - factor.ln()).abs() < 1e-14);
    // A point without N2 uses corrected thrust too.
    assert_eq!(over(&point(0.8), ThrottleArgument::N2), by_thrust);
}

#[test]
fn what_is_not_recorded_is_said_and_nothing_becomes_nan() {
    let performance = model(true);
    let effects = EffectModel::new(&performance, performance.drag_table(), references()).unwrap();
    let bare = EffectPoint {
        roll_squared_deg2: None,
        drift_deg: None,
        latitude_deg: None,
        true_heading_deg: None,
        center_of_gravity_percent_mac: None,
        ..point(0.8)
    };
    for (effect, needs) in [
        (EffectId::TrimDragCg, "CG"),
        (EffectId::AsymmetryDrag, "ROLL"),
        (EffectId::LoadFactor, "ROLL"),
        (EffectId::LocalGravity, "LAT"),
        (EffectId::RotatingEarth, "LAT"),
        (EffectId::IsobaricSlope, "LAT"),
    ] {
        let error = effects.response(&bare, &Effects::one(effect, 1.0)).unwrap_err();
        assert_eq!(error, EffectError::NotRecorded { effect, needs });
    }
    // Impossible sizes are errors, not numbers.
    for (effect, size) in [
        (EffectId::MachBias, 0.9),
        (EffectId::TemperatureBias, 300.0),
        (EffectId::StaticPressureBias, -100.0),
        (EffectId::ZeroFuelMassBias, -1e6),
        (EffectId::ZeroLiftDrag, -1e4),
        (EffectId::DragFactor, f64::NAN),
    ] {
        assert!(effects.response(&bare, &Effects::one(effect, size)).is_err(), "{effect}");
    }
    let outside = EffectPoint { mass_kg: 60_000.0, ..bare };
    let error = effects.response(&outside, &Effects::none()).unwrap_err();
    assert!(matches!(error, EffectError::OutsideTable { .. }), "{error}");
}

#[test]
fn anti_ice_is_taken_as_recorded_else_by_temperature() {
    let performance = model(false);
    let effects = EffectModel::new(&performance, performance.drag_table(), references()).unwrap();
    let ratio = |at: &EffectPoint| {
        let on = effects.response(at, &Effects::one(EffectId::AntiIceBleed, 2.0)).unwrap();
        let off = effects.response(at, &Effects::none()).unwrap();
        (on.ln_fuel_flow_total - off.ln_fuel_flow_total).exp() - 1.0
    };
    let cold = point(0.8);
    let warm = EffectPoint { static_air_temperature_k: 240.0, ..cold };
    assert!(ratio(&cold).abs() < 1e-15);
    assert!((ratio(&warm) - 0.02).abs() < 1e-14);
    assert!((ratio(&EffectPoint { anti_ice: Some(0.5), ..cold }) - 0.01).abs() < 1e-14);
    assert!(ratio(&EffectPoint { anti_ice: Some(0.0), ..warm }).abs() < 1e-15);
}

#[test]
fn references_are_means_and_read_back_to_the_same_bits() {
    let performance = model(true);
    let points = [point(0.76), EffectPoint { mass_kg: 14_500.0, ..point(0.80) }];
    let table = performance.drag_table();
    let found = mean_references(performance.aircraft(), table, &points).unwrap();
    assert!((found.mach - 0.78).abs() < 1e-15);
    assert!((found.mass_kg - 14_000.0).abs() < 1e-9);
    assert!((found.date_s - 1.5e9).abs() < 1e-6);
    assert_eq!(found.center_of_gravity_percent_mac, Some(22.0));
    // 222 K over 288.15 K, at both points.
    assert!((found.temperature_ratio - 222.0 / 288.15).abs() < 1e-12);
    // 1.5 % of 14 000 kg.
    assert!((found.typical_size(EffectId::ZeroFuelMassBias) - 210.0).abs() < 1e-9);
    let text = ron::to_string(&found).unwrap();
    assert_eq!(ron::from_str::<EffectReferences>(&text).unwrap(), found);
    let nothing = mean_references(performance.aircraft(), table, &[]).unwrap_err();
    assert_eq!(nothing, EffectModelError::NothingInside { segments: 0 });
    let effects = Effects::one(EffectId::TsfcEngine(2), 3.0);
    let text = ron::to_string(&effects).unwrap();
    assert_eq!(ron::from_str::<Effects>(&text).unwrap(), effects);
}

/// The short way to a response against the long one, to the last bit, for every effect alone and together with two
/// others.
#[test]
fn known_point_gives_the_same_response() {
    let model = model(true);
    let effects = EffectModel::new(&model, model.drag_table(), references()).unwrap();
    let at = point(0.82);
    let (known, plain) = effects.known_point(&at).unwrap();
    assert_eq!(plain, effects.response(&at, &Effects::none()).unwrap());
    let step = HiddenParameter::Step { from_s: 1.0e9, target: StepTarget::FuelFlow };
    let mut tried = 0;
    for id in EffectId::library(2) {
        let size = 0.5 * effects.references().typical_size(id);
        for on in [
            Effects::one(id, size),
            Effects::one(EffectId::MachBias, 0.003).with(id, -size),
            Effects::one(EffectId::LocalGravity, 1.0).with(id, size),
        ] {
            let on = on.with_hidden(EffectId::StepChange, step);
            let short = effects.response_at(&known, &effects.trial(&on)).unwrap();
            assert_eq!(short, effects.response(&at, &on).unwrap(), "{id}");
            tried += 1;
        }
    }
    assert!(tried > 80);
    let bare = EffectPoint { latitude_deg: None, ..at };
    let (known, _) = effects.known_point(&bare).unwrap();
    let trial = effects.trial(&Effects::one(EffectId::LocalGravity, 1.0));
    let error = effects.response_at(&known, &trial).unwrap_err();
    assert_eq!(
        error,
        effects.response(&bare, &Effects::one(EffectId::LocalGravity, 1.0)).unwrap_err()
    );
}
