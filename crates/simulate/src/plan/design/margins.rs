//! Whether a drawn flight can be flown.

use units::{CalibratedAirspeed, Mach, Mass, OutOfDomain, PressureAltitude, TemperatureDifference};

use super::legs;
use crate::aircraft::{AircraftTruth, TruthPhysics};
use crate::route::{FlightPlan, Loading};
use crate::terms::Terms;
use crate::trim::{TrimPoint, trim_with};

/// Share of the maximum lift coefficient and thrust that a planned point may need: the day may be warm.
const LIFT_MARGIN: f64 = 0.85;
const THRUST_MARGIN: f64 = 0.90;
/// Warmest air in which the margin must hold, above the ISA, K.
const WARM_DAY_K: f64 = 10.0;

/// Whether the heaviest aircraft can fly every leg on a warm day with a margin, and the fuel is sufficient.
pub(super) fn can_be_flown(
    aircraft: &AircraftTruth,
    plan: &FlightPlan,
) -> Result<bool, OutOfDomain> {
    let Loading::ZeroFuel { zero_fuel_mass_kg, fuel_on_board_kg } = plan.loading else {
        return Ok(true);
    };
    let terms = Terms::new(aircraft, TruthPhysics::full());
    let mass = Mass::kilograms(zero_fuel_mass_kg + fuel_on_board_kg);
    let envelope = &aircraft.envelope;
    let mut flow_kg_s: f64 = 0.0;
    for (_, feet, mach) in legs(plan) {
        let pressure_altitude = PressureAltitude::feet(feet);
        let sat =
            atmos::isa::temperature(pressure_altitude)? + TemperatureDifference::kelvin(WARM_DAY_K);
        let trimmed = trim_with(
            aircraft,
            &terms,
            &TrimPoint {
                mass,
                pressure_altitude,
                mach: Mach::new(mach),
                sat,
                center_of_gravity_percent_mac: plan.center_of_gravity_percent_mac,
            },
        )?;
        let airspeed: CalibratedAirspeed = atmos::airspeed::mach_to_calibrated_airspeed(
            Mach::new(mach),
            atmos::isa::pressure(pressure_altitude)?,
        );
        if trimmed.lift_coefficient > LIFT_MARGIN * envelope.maximum_lift_coefficient
            || trimmed.thrust_n > THRUST_MARGIN * trimmed.maximum_thrust_n
            || airspeed.to_knots() > envelope.maximum_operating_calibrated_airspeed_kt
        {
            return Ok(false);
        }
        flow_kg_s = flow_kg_s.max(trimmed.fuel_flow_kg_s);
    }
    // An hour more than recorded for climb and settling, and a tenth left.
    Ok(flow_kg_s * (plan.duration_s + 3600.0) < 0.9 * fuel_on_board_kg)
}
