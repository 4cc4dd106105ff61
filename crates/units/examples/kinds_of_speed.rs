//! Quantities of one dimension that must not change places, and how a constructor refuses a bad value.
//!
//! `cargo run -p cruisefit-units --example kinds_of_speed`
#![allow(clippy::print_stdout, reason = "an example")]

use units::{CalibratedAirspeed, OutOfDomain, PressureAltitude, TrueAirspeed, check_within};

/// Only a true airspeed fits here: a calibrated one does not compile.
fn minutes_for_100_nautical_miles(speed: TrueAirspeed) -> f64 {
    100.0 / speed.to_knots() * 60.0
}

fn check_cruise(at: PressureAltitude) -> Result<PressureAltitude, OutOfDomain> {
    check_within("pressure altitude of a cruise", "m", at.to_meters(), 3_000.0, 16_000.0)?;
    Ok(at)
}

fn main() {
    let indicated = CalibratedAirspeed::knots(250.0);
    let minutes = minutes_for_100_nautical_miles(TrueAirspeed::knots(480.0));
    println!(
        "{:.0} kt CAS on the dial, 100 nautical miles in {minutes:.1} min",
        indicated.to_knots()
    );
    assert!((minutes - 12.5).abs() < 1e-12);

    let refused = check_cruise(PressureAltitude::feet(410.0)).map_err(|error| error.to_string());
    println!("{refused:?}");
    assert!(refused.is_err_and(|text| text.contains("pressure altitude of a cruise")));
}
