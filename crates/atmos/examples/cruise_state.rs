//! From the quantities of a cruise report (pressure altitude, SAT, Mach number) to those of a performance model.
//!
//! `cargo run -p cruisefit-atmos --example cruise_state`
#![expect(clippy::print_stdout, reason = "an example shows its result")]

use atmos::{airspeed, gravity, isa, temperature};
use units::{Angle, GeometricAltitude, Mach, OutOfDomain, PressureAltitude, Temperature};

fn main() -> Result<(), OutOfDomain> {
    let pressure_altitude = PressureAltitude::feet(41_000.0);
    let sat = Temperature::celsius(-52.0);
    let mach = Mach::new(0.82);

    let static_pressure = isa::pressure(pressure_altitude)?;
    let density = isa::density(static_pressure, sat);
    let true_airspeed = airspeed::mach_to_true_airspeed(mach, sat);
    let calibrated_airspeed = airspeed::mach_to_calibrated_airspeed(mach, static_pressure);
    let total_air_temperature = temperature::static_to_total(sat, mach, 1.0);
    println!("ISA deviation  {:+.1} K", isa::isa_deviation(pressure_altitude, sat)?.to_kelvin());
    println!("density        {:.4} kg/m³", density.to_kilograms_per_cubic_meter());
    println!("TAS            {:.1} kt", true_airspeed.to_knots());
    println!("CAS            {:.1} kt", calibrated_airspeed.to_knots());
    println!("TAT            {:.1} °C", total_air_temperature.to_celsius());

    // Eastbound over 50° north: what the lift has to carry, compared with standard gravity.
    let latitude = Angle::degrees(50.0);
    let height = GeometricAltitude::feet(41_000.0);
    let ground_speed_m_s = true_airspeed.to_meters_per_second();
    let apparent_gravity = gravity::gravity(latitude, height)
        - gravity::earth_motion_acceleration(latitude, ground_speed_m_s, 0.0, height);
    let lighter_percent = 100.0 * (1.0 - apparent_gravity.to_meters_per_second_squared() / 9.80665);
    println!("lighter by     {lighter_percent:.2} %");

    // 0.35 % by latitude and height, 0.33 % by flying east over a turning Earth.
    assert!((lighter_percent - 0.68).abs() < 0.01);
    Ok(())
}
