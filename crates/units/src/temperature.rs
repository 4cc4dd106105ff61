//! Absolute temperature and temperature difference: two types, because only some sums are meaningful.

use crate::convert::KELVIN_AT_ZERO_CELSIUS;
use crate::quantity::{additive, quantity};

quantity!(
    /// Absolute temperature. The argument's name states whether it is static (SAT) or total (TAT).
    Temperature, "K",
    [(kelvin, to_kelvin, 1.0, "kelvin")]
);
quantity!(
    /// Difference of two temperatures, for example a deviation from the ISA.
    TemperatureDifference, "K",
    [(kelvin, to_kelvin, 1.0, "kelvin")]
);
additive!(TemperatureDifference);

impl Temperature {
    /// From degrees Celsius.
    #[must_use]
    pub const fn celsius(value: f64) -> Self {
        Self(value + KELVIN_AT_ZERO_CELSIUS)
    }

    /// In degrees Celsius.
    #[must_use]
    pub const fn to_celsius(self) -> f64 {
        self.0 - KELVIN_AT_ZERO_CELSIUS
    }
}

impl core::ops::Sub for Temperature {
    type Output = TemperatureDifference;
    fn sub(self, other: Self) -> TemperatureDifference {
        TemperatureDifference(self.0 - other.0)
    }
}

impl core::ops::Add<TemperatureDifference> for Temperature {
    type Output = Self;
    fn add(self, difference: TemperatureDifference) -> Self {
        Self(self.0 + difference.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn celsius_and_differences() {
        assert!((Temperature::celsius(-56.5).to_kelvin() - 216.65).abs() < 1e-12);
        let deviation = Temperature::celsius(-46.5) - Temperature::kelvin(216.65);
        assert!((deviation.to_kelvin() - 10.0).abs() < 1e-12);
        let warm = Temperature::kelvin(216.65) + deviation;
        assert!((warm.to_celsius() + 46.5).abs() < 1e-12);
    }
}
