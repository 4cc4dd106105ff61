//! Conditions on a plan before anything is drawn.

use std::collections::BTreeSet;

use units::check_within;

pub(super) use crate::plan::MOST_FLIGHTS;
use crate::plan::{Plan, PlanError};
use crate::route::FlightPlan;

/// Every number of a plan that has limits.
pub(super) fn check_plan(plan: &Plan) -> Result<(), PlanError> {
    let recording = &plan.recording;
    let weather = &plan.weather;
    let checks = [
        ("recording interval", "s", recording.interval_s, 0.1, 3600.0),
        ("simulation step", "s", recording.longest_step_s, 0.01, 1.0),
        ("time after top of climb", "min", recording.after_top_of_climb_min, 0.0, 600.0),
        ("mean eastward wind", "m/s", weather.wind_east_m_s.mean, -100.0, 100.0),
        ("standard deviation of eastward wind", "m/s", weather.wind_east_m_s.sd, 0.0, 50.0),
        ("mean northward wind", "m/s", weather.wind_north_m_s.mean, -100.0, 100.0),
        ("standard deviation of northward wind", "m/s", weather.wind_north_m_s.sd, 0.0, 50.0),
        ("mean ISA deviation", "K", weather.isa_deviation_k.mean, -60.0, 60.0),
        ("standard deviation of ISA deviation", "K", weather.isa_deviation_k.sd, 0.0, 30.0),
        ("wind field", "m/s", weather.wind_field_m_s, 0.0, 40.0),
        ("season", "K", weather.season_k, 0.0, 30.0),
        ("ISA deviation field", "K", weather.isa_deviation_field_k, 0.0, 15.0),
        ("ageostrophic share", "-", weather.ageostrophic_share, 0.0, 1.0),
        ("vertical wind", "m/s", weather.vertical_wind_m_s, 0.0, 2.0),
        ("shortest wave", "km", weather.wavelengths_km.0, 100.0, weather.wavelengths_km.1),
        ("longest wave", "km", weather.wavelengths_km.1, weather.wavelengths_km.0, 20_000.0),
        (
            "shortest vertical wave",
            "km",
            weather.vertical_wavelengths_km.0,
            20.0,
            weather.vertical_wavelengths_km.1,
        ),
        ("gusts elsewhere", "m/s", weather.turbulence.elsewhere_m_s, 0.0, 10.0),
        ("heating value scatter", "%", plan.scatter.heating_value_percent, 0.0, 10.0),
        ("zero-fuel mass scatter", "%", plan.scatter.zero_fuel_mass_percent, 0.0, 10.0),
        ("clutter share", "-", plan.clutter_share, 0.0, 1.0),
        ("roll trim limit", "deg", plan.scatter.roll_trim_limit_deg, 0.0, 10.0),
        ("throttle split", "%", plan.scatter.throttle_split_percent, 0.0, 20.0),
        ("autopilot Mach frequency", "rad/s", plan.autopilot.mach_frequency_rad_s, 0.001, 0.3),
        ("autopilot altitude gain", "1/s", plan.autopilot.altitude_gain_s, 0.001, 0.3),
        ("engine time constant", "s", plan.autopilot.engine_time_s, 0.1, 30.0),
        ("bank in turns", "deg", plan.autopilot.bank_deg, 5.0, 35.0),
        ("roll time constant", "s", plan.autopilot.roll_time_s, 2.0, 30.0),
    ];
    for (quantity, unit, value, minimum, maximum) in checks {
        check_within(quantity, unit, value, minimum, maximum)?;
    }
    Ok(())
}

/// Every number of the flights of a tail.
pub(super) fn check_flights(tail: &str, flights: &[FlightPlan]) -> Result<(), PlanError> {
    if flights.is_empty() {
        return Err(PlanError::NoFlights { tail: tail.to_owned() });
    }
    let mut names = BTreeSet::new();
    for flight in flights {
        if !names.insert(flight.flight.as_str()) {
            return Err(PlanError::DoubledFlight {
                tail: tail.to_owned(),
                flight: flight.flight.clone(),
            });
        }
        if flight.waypoints.len() < 2 {
            return Err(PlanError::Waypoints {
                tail: tail.to_owned(),
                flight: flight.flight.clone(),
                found: flight.waypoints.len(),
            });
        }
        for (latitude_deg, longitude_deg) in &flight.waypoints {
            check_within("latitude", "deg", *latitude_deg, -80.0, 80.0)?;
            check_within("longitude", "deg", *longitude_deg, -360.0, 360.0)?;
        }
        check_within("duration", "s", flight.duration_s, 1.0, 86_400.0)?;
        check_within("fuel on board", "kg", flight.loading.fuel_on_board_kg(), 1.0, 3e5)?;
        for (_, feet, mach) in crate::plan::legs(flight) {
            check_within("pressure altitude", "ft", feet, 1_000.0, 60_000.0)?;
            check_within("Mach number", "-", mach, 0.2, 0.98)?;
        }
    }
    Ok(())
}
