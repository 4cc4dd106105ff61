//! Specific range.

use units::{FuelFlowTotal, SpecificRange, TrueAirspeed};

/// Specific air range: SR = V/Wf, distance through still air for a mass of fuel. `[forces.15]`
///
/// # Source
/// Airbus, *Getting to grips with aircraft performance monitoring*, 2002: SR = TAS/FF.
#[must_use]
pub fn specific_range(
    true_airspeed: TrueAirspeed,
    fuel_flow_total: FuelFlowTotal,
) -> SpecificRange {
    true_airspeed / fuel_flow_total
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_row() {
        // 470 kt at 1610 lb/h: 0.292 nm/lb, as printed in the synthetic Citation X table.
        let range =
            specific_range(TrueAirspeed::knots(470.0), FuelFlowTotal::pounds_per_hour(1610.0));
        assert!((range.to_nautical_miles_per_pound() - 0.292).abs() < 0.0005);
    }
}
