//! What a deviation costs, in fuel and what follows from fuel.

/// The factors by which an operator turns fuel into other things; none has a default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CostFactors {
    /// kg of CO₂ from a kg of fuel.
    pub co2_kg_per_kg: Option<f64>,
    /// Price of a kg of fuel, in any currency.
    pub price_per_kg: Option<f64>,
    /// Flights a year; without it, as many as were recorded.
    pub flights_per_year: Option<f64>,
}

/// A factor of an operator's that is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{quantity}: found {value}, expected {expected}")]
pub struct FactorError {
    /// Which factor, in words.
    pub quantity: &'static str,
    /// The value given.
    pub value: f64,
    /// What a value of it is.
    pub expected: &'static str,
}

impl CostFactors {
    /// The same factors, each of which may be multiplied by.
    ///
    /// # Errors
    /// [`FactorError`] for one that is not a finite number above 0: costs would be negative, or no number.
    pub fn checked(self) -> Result<Self, FactorError> {
        let expected = "a finite number above 0";
        for (quantity, value) in [
            ("kg of CO₂ from a kg of fuel", self.co2_kg_per_kg),
            ("price of a kg of fuel", self.price_per_kg),
            ("flights a year", self.flights_per_year),
        ] {
            match value {
                Some(value) if !(value > 0.0 && value.is_finite()) => {
                    return Err(FactorError { quantity, value, expected });
                }
                _ => {}
            }
        }
        Ok(self)
    }
}

/// What a deviation costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Fuel a flight, kg.
    pub fuel_kg_per_flight: f64,
    /// Fuel a year, kg.
    pub fuel_kg_per_year: f64,
    /// CO₂ a year, kg, where its factor is given.
    pub co2_kg_per_year: Option<f64>,
    /// Price a year, where the price is given.
    pub price_per_year: Option<f64>,
}

/// Fuel that a flight burnt beyond what was predicted.
///
/// ```text
/// excess = burnt·(1 − exp(−d/100))                                                           [monitoring.15]
/// ```
#[must_use]
pub fn excess_fuel_kg(burnt_kg: f64, deviation_percent: f64) -> f64 {
    burnt_kg * -(-deviation_percent / 100.0).exp_m1()
}

impl Cost {
    /// The cost of a level of deviation to flights that burn so much in cruise, this many of them a year.
    #[must_use]
    pub fn new(
        deviation_percent: f64,
        cruise_fuel_kg: f64,
        recorded_flights_per_year: f64,
        factors: &CostFactors,
    ) -> Self {
        let flights = factors.flights_per_year.unwrap_or(recorded_flights_per_year);
        let fuel_kg_per_flight = excess_fuel_kg(cruise_fuel_kg, deviation_percent);
        let fuel_kg_per_year = fuel_kg_per_flight * flights;
        Self {
            fuel_kg_per_flight,
            fuel_kg_per_year,
            co2_kg_per_year: factors.co2_kg_per_kg.map(|factor| factor * fuel_kg_per_year),
            price_per_year: factors.price_per_kg.map(|price| price * fuel_kg_per_year),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_is_finite_and_above_0() {
        let all = |value| CostFactors {
            co2_kg_per_kg: value,
            price_per_kg: value,
            flights_per_year: value,
        };
        for fine in [None, Some(f64::MIN_POSITIVE), Some(3.16)] {
            assert_eq!(all(fine).checked(), Ok(all(fine)));
        }
        for value in [-5.0, 0.0, f64::INFINITY, f64::NAN] {
            let bad = Some(value);
            for (factors, quantity) in [
                (CostFactors { co2_kg_per_kg: bad, ..all(None) }, "kg of CO₂ from a kg of fuel"),
                (CostFactors { price_per_kg: bad, ..all(None) }, "price of a kg of fuel"),
                (CostFactors { flights_per_year: bad, ..all(None) }, "flights a year"),
            ] {
                let refused = factors.checked().unwrap_err().to_string();
                let expected =
                    format!("{quantity}: found {value}, expected a finite number above 0");
                assert_eq!(refused, expected);
            }
        }
    }

    /// By hand: 5050 kg burnt where 5000 were predicted.
    #[test]
    fn excess_by_hand() {
        let deviation = 100.0 * (5050.0_f64 / 5000.0).ln();
        let factors =
            CostFactors { co2_kg_per_kg: Some(3.0), price_per_kg: None, flights_per_year: None };
        let cost = Cost::new(deviation, 5050.0, 200.0, &factors);
        assert!((cost.fuel_kg_per_flight - 50.0).abs() < 1e-9);
        assert!((cost.fuel_kg_per_year - 10_000.0).abs() < 1e-6);
        assert!((cost.co2_kg_per_year.unwrap() - 30_000.0).abs() < 1e-6);
        assert_eq!(cost.price_per_year, None);
        let other = CostFactors { flights_per_year: Some(100.0), ..factors };
        assert!(
            (Cost::new(deviation, 5050.0, 200.0, &other).fuel_kg_per_year - 5_000.0).abs() < 1e-6
        );
    }
}
