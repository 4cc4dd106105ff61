use std::sync::Arc;

use flight::{Cruise, FlightIdentity, SegmentMeans};
use units::{FuelFlowTotal, Mach, Mass, PressureAltitude, Temperature, TrueAirspeed};

use super::*;
use crate::{Guide, PerformanceModel, initial_model};

/// The steps of the finite differences are small against each quantity and large against rounding.
const RELATIVE_STEP: f64 = 1e-6;

fn model() -> PerformanceModel {
    let aircraft = Aircraft::from_ron(
        r#"(
            name: "test", type_code: "TEST", engines: 2, wing_area_m2: 94.94690688,
            tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0.8),
            table: (lift_coefficient: (0.30, 0.60, 0.05), mach: (0.76, 0.88, 0.02)),
        )"#,
    )
    .unwrap();
    let guide = Guide::from_csv(include_bytes!("../../tests/golden/guide.csv")).unwrap();
    initial_model(&aircraft, &guide).unwrap().model
}

pub(crate) fn segment() -> Segment {
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
                mass: Mass::kilograms(29_000.0),
                fuel_flow_total: FuelFlowTotal::kilograms_per_second(0.5),
            })
        },
        temperature_assumed: false,
    }
}

/// ln CD observed − ln CD table, as a user of the crate would compute it.
fn residual(model: &PerformanceModel, edit: impl Fn(&mut SegmentMeans)) -> f64 {
    let mut segment = segment();
    edit(&mut segment.means);
    let observation = model.observe(&segment).unwrap();
    let grid = model.drag_table().grid();
    let cell =
        grid.locate(observation.lift_coefficient, observation.mach, lut::Outside::Error).unwrap();
    (observation.drag_coefficient / model.drag_table().interpolate(&cell)).ln()
}

/// Central difference of the residual over ±step.
fn difference(model: &PerformanceModel, step: f64, edit: impl Fn(&mut SegmentMeans, f64)) -> f64 {
    let plus = residual(model, |means| edit(means, step));
    let minus = residual(model, |means| edit(means, -step));
    (plus - minus) / (2.0 * step)
}

fn sensitivity(model: &PerformanceModel) -> ResidualSensitivity {
    let segment = segment();
    let state = model.state_of(&segment).unwrap();
    let grid = model.drag_table().grid();
    let cell = grid.locate(state.lift_coefficient, 0.803, lut::Outside::Error).unwrap();
    let slopes = TableSlopes::at(model.drag_table(), &cell, state.lift_coefficient);
    let pressure_altitude = PressureAltitude::meters(12_496.8);
    ResidualSensitivity::new(model.aircraft(), pressure_altitude, &state, slopes).unwrap()
}

#[test]
fn sensitivities_against_finite_differences() {
    let model = model();
    let analytic = sensitivity(&model);
    let h = RELATIVE_STEP;
    for (name, value, numeric) in [
        (
            "fuel flow",
            analytic.ln_fuel_flow,
            difference(&model, h, |means, d| means.fuel_flow_total_kg_s *= 1.0 + d),
        ),
        (
            // The air-data computer derives true airspeed from Mach number and temperature.
            "Mach number",
            analytic.mach,
            difference(&model, h, |means, d| {
                means.true_airspeed_m_s *= 1.0 + d / means.mach;
                means.mach += d;
            }),
        ),
        (
            "static air temperature",
            analytic.static_air_temperature_per_k,
            difference(&model, 100.0 * h, |means, d| {
                let warmer = means.static_air_temperature_k + d;
                means.true_airspeed_m_s *= (warmer / means.static_air_temperature_k).sqrt();
                means.static_air_temperature_k = warmer;
            }),
        ),
        (
            "acceleration",
            analytic.acceleration_s2_per_m,
            difference(&model, h, |means, d| means.acceleration_m_s2 += d),
        ),
        ("mass", analytic.ln_mass, difference(&model, h, |means, d| means.mass_kg *= 1.0 + d)),
        (
            "pressure altitude",
            analytic.pressure_altitude_per_m,
            difference(&model, 1000.0 * h, |means, d| means.pressure_altitude_m += d),
        ),
    ] {
        assert!(
            (value - numeric).abs() < 1e-5 * numeric.abs().max(1e-3),
            "{name}: {value} against {numeric}"
        );
    }
}

#[test]
fn signs_and_sizes_as_published() {
    // Published for a business jet at Mach 0.80: 1 % of weight is about 0.5 % of fuel flow (0.2 to 0.8), 1 K of SAT at
    // constant Mach number 0.23 %, 1 kt/min of acceleration 1.06 % of a drag of L/D 12 (here L/D is another).
    let sensitivity = sensitivity(&model());
    assert!((-0.8..-0.2).contains(&sensitivity.ln_mass), "{sensitivity:?}");
    assert!((100.0 * sensitivity.static_air_temperature_per_k + 0.23).abs() < 0.01);
    assert!(sensitivity.acceleration_s2_per_m < -0.7, "{sensitivity:?}");
    assert!(sensitivity.pressure_altitude_per_m > 0.0);
}

#[test]
fn variance_of_a_segment_by_hand() {
    let model = model();
    let segment = segment();
    let variance = model.observe(&segment).unwrap().variance;
    let s = sensitivity(&model);
    // Defaults: 0.5 % per engine, Mach 0.001, 0.3 K, 0.0045 m/s² per sample, 8 m; LHV 0.3 %, mass 0.7 %.
    // Engines 0.26 and 0.24 kg/s: (0.0676 + 0.0576)/0.25 = 0.5008 of the single variance.
    // Eight samples.
    let by_hand = s.ln_fuel_flow.powi(2) * 0.005_f64.powi(2) * 0.5008
        + (s.mach * 0.001).powi(2)
        + (s.static_air_temperature_per_k * 0.3).powi(2)
        + (s.acceleration_s2_per_m * 0.0045).powi(2) / 8.0
        + (s.pressure_altitude_per_m * 8.0).powi(2);
    assert!((variance.segment / by_hand - 1.0).abs() < 1e-12);
    let by_hand = (s.ln_fuel_flow * 0.003).powi(2) + (s.ln_mass * 0.007).powi(2);
    assert!((variance.flight / by_hand - 1.0).abs() < 1e-12);
    // A segment is good to about half a per cent, and so is a flight.
    for variance in [variance.segment, variance.flight] {
        assert!((0.003..0.008).contains(&variance.sqrt()), "{}", variance.sqrt());
    }
}

#[test]
fn fuel_flow_of_engines() {
    let variance =
        |flows: &[f64], engines| total_fuel_flow_relative_variance(0.005, flows, engines);
    assert!((variance(&[0.3, 0.3], 2) - 0.005_f64.powi(2) / 2.0).abs() < 1e-18);
    assert!((variance(&[], 4) - 0.005_f64.powi(2) / 4.0).abs() < 1e-18); // engines not apart
    assert!((variance(&[0.3], 1) - 0.005_f64.powi(2)).abs() < 1e-18);
}

#[test]
fn mean_acceleration_against_simulated_fleets() {
    // Standard deviation of the error of the mean acceleration, measured on 744 segments of three simulated fleets in
    // turbulence (book, page on uncertainty): samples, m/s². The law with its default stays within a factor of 2.
    for (samples, measured) in
        [(3, 0.0030), (4, 0.0020), (5, 0.0011), (7, 0.0011), (8, 0.0014), (9, 0.0016), (10, 0.0017)]
    {
        let sample_deviation = crate::aircraft::SensorDeviations::default().acceleration_m_s2;
        let ratio = mean_acceleration_deviation_m_s2(sample_deviation, samples) / measured;
        assert!((0.5..2.0).contains(&ratio), "{samples}: {ratio}");
    }
    // Four samples: half of one, by hand.
    assert!((mean_acceleration_deviation_m_s2(0.0045, 4) - 0.00225).abs() < 1e-15);
}
