//! What scatter an oracle would leave: fuel flow recorded against what the *true* aircraft burns at the recorded segment means.
//!
//! `cargo run --release -p cruisefit-trials --example floor -- LAST PLAN.ron ...`
//!
//! Prints a line per plan: mean, standard deviation and number of the errors, 100 (recorded − oracle)/recorded, over the
//! segments of the last LAST flights; without arguments, of a few flights as the virtual aircraft is. The oracle knows the
//! aircraft, but reads the conditions off the same instruments as everybody: load sheet, Mach number, temperature and
//! acceleration are as recorded, and the heating value is the usual one.

#![expect(clippy::print_stdout, reason = "an example shows what it does")]
#![expect(clippy::disallowed_methods, reason = "an example reads the plans that it is given")]

use flight::Segment;
use pipeline::reduction::ReducedFlight;
use pipeline::statistics::ErrorStatistics;
use segmenter::TrimCriteria;
use simulate::{
    AircraftTruth, Flown, Plan, Simulation, Switch, TrimPoint, TrueState, TruthPhysics,
};
use units::{Mach, Mass, PressureAltitude, Temperature};

type Failure = Box<dyn std::error::Error>;

const PLAN: &str = r#"(seed: 2020, tails: [(tail: "T-001", flights: Designed((flights: 8, duration_h: (1.0, 1.0))))])"#;
const EXACT: &str =
    "sensors: Perfect, scatter: (heating_value_percent: 0.0, zero_fuel_mass_percent: 0.0), seed";

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    if let Some(last) = arguments.next() {
        for path in arguments {
            let found = errors_of(&std::fs::read_to_string(&path)?, last.parse()?)?;
            let (mean, std) = (found.mean.unwrap_or(f64::NAN), found.std.unwrap_or(f64::NAN));
            println!("{path} {mean:.4} {std:.4} {}", found.n);
        }
        return Ok(());
    }
    let usual = errors_of(PLAN, 8)?.std.ok_or("no segments")?;
    // Without errors of instruments gusts and an acceleration by differences are left.
    let exact = errors_of(&PLAN.replace("seed", EXACT), 8)?.std.ok_or("no segments")?;
    println!(
        "an oracle leaves {usual:.2} %, with instruments and load sheets without errors {exact:.2} %"
    );
    assert!(exact < usual);
    Ok(())
}

/// Errors over the segments of the last flights of a plan.
fn errors_of(plan: &str, last: usize) -> Result<ErrorStatistics, Failure> {
    let mut plan = Plan::from_ron(plan)?;
    plan.recording.true_states = Switch::On;
    let physics = plan.physics;
    let simulation = Simulation::new(plan)?;
    let mut errors = Vec::new();
    for index in simulation.len().saturating_sub(last)..simulation.len() {
        errors.extend(of_flight(&simulation, physics, simulation.fly(index)?)?);
    }
    Ok(ErrorStatistics::from_errors(&errors))
}

/// Errors of one flight's segments, %.
fn of_flight(
    simulation: &Simulation,
    physics: TruthPhysics,
    flown: Flown,
) -> Result<Vec<f64>, Failure> {
    let Flown { report, truth, states, .. } = flown;
    if states.len() != report.len() {
        return Err(format!("{} states, {} samples", states.len(), report.len()).into());
    }
    let aircraft = simulation.aircraft();
    let usual_mj_kg = aircraft.engine.reference_lower_heating_value_mj_kg;
    let criteria = TrimCriteria::preset(TrimCriteria::PRESETS[0]).ok_or("no criteria")?;
    let reduced = ReducedFlight::from_report(report, &criteria, Vec::new())?;
    let error = |segment: &Segment| {
        let heat = truth.lower_heating_value_mj_kg / usual_mj_kg;
        let ln = ln_oracle_kg_s(aircraft, physics, segment, &states)? + heat.ln();
        Ok(-100.0 * (ln - segment.means.fuel_flow_total_kg_s.ln()).exp_m1())
    };
    reduced.segments.iter().map(error).collect()
}

/// ln of the true fuel flow, moved from the true to the recorded conditions along the true aircraft.
///
/// ```text
/// ln Wf + ln Wf(recorded)/Wf(true) + m (V̇_recorded − V̇_true)/F
/// ```
fn ln_oracle_kg_s(
    aircraft: &AircraftTruth,
    physics: TruthPhysics,
    segment: &Segment,
    states: &[TrueState],
) -> Result<f64, Failure> {
    let rows = &segment.rows;
    let mean = |of: &dyn Fn(&TrueState) -> f64| {
        rows.iter().map(|row| of(&states[*row as usize])).sum::<f64>() / rows.len() as f64
    };
    let center_of_gravity = mean(&|state| state.center_of_gravity_percent_mac);
    let trimmed = |mass_kg, altitude_m, mach, sat_k, center_of_gravity_percent_mac| {
        let point = TrimPoint {
            mass: Mass::kilograms(mass_kg),
            pressure_altitude: PressureAltitude::meters(altitude_m),
            mach: Mach::new(mach),
            sat: Temperature::kelvin(sat_k),
            center_of_gravity_percent_mac,
        };
        aircraft.trim(&point, physics).map(|trimmed| trimmed.fuel_flow_kg_s.ln())
    };
    let means = &segment.means;
    let recorded = trimmed(
        means.mass_kg,
        means.pressure_altitude_m,
        means.mach,
        means.static_air_temperature_k,
        means.center_of_gravity_percent_mac.unwrap_or(center_of_gravity),
    )?;
    let as_flown = trimmed(
        mean(&|state| state.mass_kg),
        mean(&|state| state.pressure_altitude_m),
        mean(&|state| state.mach),
        mean(&|state| state.static_air_temperature_k),
        center_of_gravity,
    )?;
    let excess = means.acceleration_m_s2 - mean(&|state| state.acceleration_m_s2);
    let by_acceleration = mean(&|state| state.mass_kg) * excess / mean(&|state| state.thrust_n);
    let burnt = mean(&|state| state.fuel_flow_kg_s.iter().sum());
    Ok(burnt.ln() + recorded - as_flown + by_acceleration)
}
