//! The flight itself: balances, wind, gravity, steps and turns.

use crate::common::{fly_first, northbound, quiet_plan};
use simulate::{
    Change, Earth, PlannedEffect, Simulation, Spread, Switch, TruthEffect, Turbulence, Weather,
};

const OMEGA_RAD_S: f64 = 7.292_115e-5;

#[test]
fn energy_and_fuel_close_when_summed_again_from_the_states() {
    // From the recorded states alone, by trapezoids and the equation of motion written out, in wind, slope, vertical wind
    // and turbulence, with a climb and a speed change on the way.
    let mut flight = northbound();
    flight.changes = vec![
        Change::PressureAltitude { at_s: 900.0, feet: 41_000.0 },
        Change::Mach { at_s: 2000.0, mach: 0.78 },
    ];
    let mut plan = quiet_plan(vec![flight]);
    plan.earth = Earth::full();
    plan.weather = Weather {
        turbulence: Turbulence { light_patches_per_h: 2.0, ..Turbulence::default() },
        ..Weather::default()
    };
    plan.recording.interval_s = 1.0;
    let flown = fly_first(plan);
    assert!(flown.truth.turbulence_min > 1.0, "no turbulence met");
    let (mut thrust, mut work, mut burnt) = (0.0, 0.0, 0.0);
    for pair in flown.states.windows(2) {
        let (mut thrusts, mut powers, mut flows) = (0.0, 0.0, 0.0);
        for s in pair {
            let drift = (s.wind_from_left_m_s / s.smooth_airspeed_m_s).asin();
            let across = s.tail_wind_m_s * drift.sin() + s.wind_from_left_m_s * drift.cos();
            let coriolis = 2.0 * OMEGA_RAD_S * s.latitude_deg.to_radians().sin() * across;
            let force = (s.thrust_n - s.drag_n) / s.mass_kg
                - s.effective_gravity_m_s2 * s.climb_angle_rad
                - coriolis;
            thrusts += 0.5 * s.smooth_airspeed_m_s * s.thrust_n / s.mass_kg;
            powers += 0.5 * s.smooth_airspeed_m_s * force;
            flows += 0.5 * (s.fuel_flow_kg_s[0] + s.fuel_flow_kg_s[1]);
        }
        let [a, b] = pair else { unreachable!() };
        let drift = (a.wind_from_left_m_s / a.smooth_airspeed_m_s).asin();
        let wind = (b.tail_wind_m_s - a.tail_wind_m_s) * drift.cos()
            - (b.wind_from_left_m_s - a.wind_from_left_m_s) * drift.sin();
        thrust += thrusts;
        work += powers - wind * 0.5 * (a.smooth_airspeed_m_s + b.smooth_airspeed_m_s);
        burnt += flows;
    }
    let (first, last) = (&flown.states[0], &flown.states[flown.states.len() - 1]);
    let gain = 0.5 * (last.smooth_airspeed_m_s.powi(2) - first.smooth_airspeed_m_s.powi(2));
    assert!(((gain - work) / thrust).abs() < 1e-6, "{}", (gain - work) / thrust);
    assert!((thrust / flown.truth.energy.thrust_j_kg - 1.0).abs() < 1e-9);
    let lost = first.mass_kg - last.mass_kg;
    assert!(((lost - burnt) / lost).abs() < 1e-6, "{}", (lost - burnt) / lost);
    assert!(flown.truth.energy.residual().abs() < 1e-6);
    assert!(flown.truth.mass.residual().abs() < 1e-6);
}

/// Northbound at 45° N and on, westerly wind of 30 m/s everywhere.
fn in_westerly_wind(earth: Earth, effects: Vec<PlannedEffect>) -> simulate::Flown {
    let mut plan = quiet_plan(vec![northbound()]);
    plan.earth = earth;
    plan.effects = effects;
    plan.weather.wind_east_m_s = Spread { mean: 30.0, sd: 0.0 };
    fly_first(plan)
}

/// (T − D)/m at the start, and f·V with V the wind from the left of the nose.
fn excess_m_s2(flown: &simulate::Flown) -> (f64, f64) {
    let s = &flown.states[0];
    let from_left_of_nose = s.wind_from_left_m_s * s.drift_deg.to_radians().cos();
    (
        (s.thrust_n - s.drag_n) / s.mass_kg - s.acceleration_m_s2,
        2.0 * OMEGA_RAD_S * s.latitude_deg.to_radians().sin() * from_left_of_nose,
    )
}

#[test]
fn level_flight_in_uniform_geostrophic_wind_needs_thrust_equal_to_drag() {
    // The slope of the pressure surface and the Coriolis force on the wind cancel along the path; each alone is ±f·Vcross.
    let (both, coriolis) = excess_m_s2(&in_westerly_wind(Earth::plain(), Vec::new()));
    assert!((coriolis - 2.0 * OMEGA_RAD_S * 47.0_f64.to_radians().sin() * 29.8).abs() < 1e-4);
    assert!(both.abs() < 1e-5 * coriolis, "{both} {coriolis}");

    // Slope alone: the wind comes from the left, low pressure is ahead, the surface falls: thrust is saved.
    let slope = Earth { coriolis_along_path: Switch::Off, ..Earth::plain() };
    let (slope_alone, f_v) = excess_m_s2(&in_westerly_wind(slope, Vec::new()));
    assert!((slope_alone / -f_v - 1.0).abs() < 2e-3, "{slope_alone} {f_v}");

    let force = Earth { isobaric_slope: Switch::Off, ..Earth::plain() };
    let (coriolis_alone, f_v) = excess_m_s2(&in_westerly_wind(force, Vec::new()));
    assert!((coriolis_alone / f_v - 1.0).abs() < 2e-3, "{coriolis_alone} {f_v}");

    // The effect of size 0.5: half of the slope alone. In the library's form thrust + θ·m·f·V with V from the right.
    let id: TruthEffect = "isobaric_slope".parse().unwrap();
    let (half, f_v) =
        excess_m_s2(&in_westerly_wind(Earth::plain(), vec![PlannedEffect::sized(id, 0.5)]));
    assert!((half / (-0.5 * f_v) - 1.0).abs() < 2e-3, "{half} {f_v}");
}

#[test]
fn the_aircraft_descends_with_the_pressure_surface() {
    // dZ/ds = −f·V/g: over an hour, summed over the latitudes flown. Pressure altitude stays.
    let flown = in_westerly_wind(Earth::plain(), Vec::new());
    let mut expected = 0.0;
    for pair in flown.states.windows(2) {
        let s = &pair[0];
        let f =
            2.0 * OMEGA_RAD_S * (0.5 * (s.latitude_deg + pair[1].latitude_deg)).to_radians().sin();
        expected -= f * s.wind_from_left_m_s / 9.80665 * s.smooth_airspeed_m_s * 60.0;
    }
    let (first, last) = (&flown.states[0], &flown.states[60]);
    let found = last.geometric_altitude_m - first.geometric_altitude_m;
    assert!(expected < -200.0);
    assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
    assert!((last.pressure_altitude_m - first.pressure_altitude_m).abs() < 0.5);
}

#[test]
fn apparent_gravity_of_the_published_table() {
    // Reconstruction of the paper, table of bias sources: at 45°, FL410, 240 m/s, gravity, Coriolis and centrifugal together
    // are −0.74 % eastbound, −0.49 % northbound, −0.24 % westbound of standard gravity.
    for (target, expected) in [((45.0, 11.0), -0.74), ((46.0, 10.0), -0.49), ((45.0, 9.0), -0.24)] {
        let mut flight = northbound();
        flight.waypoints = vec![(45.0, 10.0), target];
        flight.pressure_altitude_ft = 41_000.0;
        flight.mach = 240.0 / 295.07;
        flight.duration_s = 180.0;
        let mut plan = quiet_plan(vec![flight]);
        plan.earth = Earth::full();
        plan.recording.after_top_of_climb_min = 0.0;
        let flown = fly_first(plan);
        let percent = 100.0 * (flown.states[1].effective_gravity_m_s2 / 9.80665 - 1.0);
        assert!((percent - expected).abs() < 0.012, "{target:?}: {percent}");
    }
}

#[test]
fn step_climb_and_speed_change_arrive_and_stay() {
    let mut flight = northbound();
    flight.changes = vec![
        Change::PressureAltitude { at_s: 600.0, feet: 41_000.0 },
        Change::Mach { at_s: 2000.0, mach: 0.82 },
    ];
    let flown = fly_first(quiet_plan(vec![flight]));
    for s in &flown.states {
        let feet = s.pressure_altitude_m / 0.3048;
        // 2 000 ft at 600 ft/min: 200 s, and some to settle.
        if s.time_s <= 600.0 {
            assert!((feet - 39_000.0).abs() < 1.0, "{} s: {feet} ft", s.time_s);
        } else if s.time_s >= 1000.0 {
            assert!((feet - 41_000.0).abs() < 5.0, "{} s: {feet} ft", s.time_s);
        }
        assert!(s.vertical_speed_m_s * 196.85 < 620.0, "{} s: {}", s.time_s, s.vertical_speed_m_s);
        if s.time_s <= 2000.0 {
            assert!((s.mach - 0.80).abs() < 0.004, "{} s: M {}", s.time_s, s.mach);
        } else if s.time_s >= 2300.0 {
            assert!((s.mach - 0.82).abs() < 0.001, "{} s: M {}", s.time_s, s.mach);
        }
    }
}

#[test]
fn a_turn_needs_lift_where_the_load_factor_counts() {
    let mut flight = northbound();
    flight.waypoints = vec![(45.0, 10.0), (47.5, 10.0), (47.5, 20.0)];
    let fly = |load_factor| {
        let mut plan = quiet_plan(vec![flight.clone()]);
        plan.earth.load_factor = load_factor;
        plan.recording.interval_s = 5.0;
        fly_first(plan)
    };
    let (with, without) = (fly(Switch::On), fly(Switch::Off));
    let turning: Vec<usize> =
        (0..with.states.len()).filter(|i| with.states[*i].roll_deg > 19.5).collect();
    assert!(turning.len() > 5, "{}", turning.len());
    let middle = turning[turning.len() / 2];
    // Lift over static pressure: the two flights' speeds part a little in the turn.
    let lift = |flown: &simulate::Flown| {
        let s = &flown.states[middle];
        s.lift_coefficient * s.mach * s.mach
    };
    let ratio = lift(&with) / lift(&without);
    let expected = 1.0 / with.states[middle].roll_deg.to_radians().cos();
    assert!((ratio / expected - 1.0).abs() < 1e-3, "{ratio} {expected}");
    assert_eq!(with.states[0].lift_coefficient, without.states[0].lift_coefficient);
}

#[test]
fn what_cannot_be_flown_is_refused_with_its_reason() {
    let mut flight = northbound();
    flight.pressure_altitude_ft = 51_000.0;
    flight.loading =
        simulate::Loading::AtRecording { gross_mass_kg: 16_000.0, fuel_on_board_kg: 5_000.0 };
    let simulation = Simulation::new(quiet_plan(vec![flight])).unwrap();
    let message = simulation.fly(0).unwrap_err().to_string();
    assert!(
        message.contains("not enough thrust") || message.contains("lift coefficient"),
        "{message}"
    );

    let mut flight = northbound();
    flight.loading =
        simulate::Loading::AtRecording { gross_mass_kg: 13_600.0, fuel_on_board_kg: 900.0 };
    let simulation = Simulation::new(quiet_plan(vec![flight])).unwrap();
    let message = simulation.fly(0).unwrap_err().to_string();
    assert!(message.contains("no fuel is left of 900 kg"), "{message}");
}
