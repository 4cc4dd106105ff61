//! Mass and its flow. The types of fuel flow distinguish one engine from all together.

use crate::TrueAirspeed;
use crate::convert::{
    KILOGRAMS_PER_POUND, KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR,
    KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR, METERS_PER_NAUTICAL_MILE,
    TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR,
};
use crate::quantity::{additive, quantity};

quantity!(
    /// Mass ("weight" in files and on the flight deck).
    Mass, "kg",
    [(kilograms, to_kilograms, 1.0, "kilograms"), (pounds, to_pounds, KILOGRAMS_PER_POUND, "pounds")]
);
quantity!(
    /// Fuel flow of all engines together.
    FuelFlowTotal, "kg/s",
    [(kilograms_per_second, to_kilograms_per_second, 1.0, "kg/s"),
     (pounds_per_hour, to_pounds_per_hour, KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR, "lb/h"),
     (kilograms_per_hour, to_kilograms_per_hour, KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR, "kg/h")]
);
quantity!(
    /// Fuel flow of one engine.
    FuelFlowEngine, "kg/s",
    [(kilograms_per_second, to_kilograms_per_second, 1.0, "kg/s"),
     (pounds_per_hour, to_pounds_per_hour, KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR, "lb/h"),
     (kilograms_per_hour, to_kilograms_per_hour, KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR, "kg/h")]
);
quantity!(
    /// Thrust-specific fuel consumption: fuel flow over net thrust.
    Tsfc, "kg/(N s)",
    [(kilograms_per_newton_second, to_kilograms_per_newton_second, 1.0, "kg/(N s)"),
     (pounds_per_pound_force_hour, to_pounds_per_pound_force_hour,
      TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR, "lb/(lbf h)")]
);
quantity!(
    /// Specific air range: true airspeed divided by total fuel flow, the distance through the air per mass of fuel.
    SpecificRange, "m/kg",
    [(meters_per_kilogram, to_meters_per_kilogram, 1.0, "m/kg"),
     (nautical_miles_per_pound, to_nautical_miles_per_pound,
      METERS_PER_NAUTICAL_MILE / KILOGRAMS_PER_POUND, "NM/lb"),
     (nautical_miles_per_kilogram, to_nautical_miles_per_kilogram, METERS_PER_NAUTICAL_MILE, "NM/kg")]
);
additive!(Mass, FuelFlowTotal, FuelFlowEngine);

impl core::ops::Div<FuelFlowTotal> for TrueAirspeed {
    type Output = SpecificRange;
    fn div(self, flow: FuelFlowTotal) -> SpecificRange {
        SpecificRange::meters_per_kilogram(
            self.to_meters_per_second() / flow.to_kilograms_per_second(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tsfc_of_one_pound_per_pound_force_hour() {
        // 2.8325e-5 kg/(N s), the value that every propulsion text gives for 1 lb/(lbf h).
        let tsfc = Tsfc::pounds_per_pound_force_hour(1.0).to_kilograms_per_newton_second();
        assert!((tsfc - 2.8325e-5).abs() < 5e-10, "{tsfc}");
    }

    #[test]
    fn specific_range_from_airspeed_and_flow() {
        // 470 kt and 1610 lb/h: 470/1610 = 0.29193 NM/lb.
        let range = TrueAirspeed::knots(470.0) / FuelFlowTotal::pounds_per_hour(1610.0);
        assert!((range.to_nautical_miles_per_pound() - 470.0 / 1610.0).abs() < 1e-12);
    }
}
