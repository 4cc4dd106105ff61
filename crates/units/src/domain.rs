//! The shared error for a value outside its domain.

/// A quantity outside the domain in which a function or constructor is valid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{quantity} {value} {unit} outside {minimum} to {maximum} {unit}")]
pub struct OutOfDomain {
    /// The quantity in the field's words.
    pub quantity: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The value given.
    pub value: f64,
    /// Smallest admissible value.
    pub minimum: f64,
    /// Largest admissible value.
    pub maximum: f64,
}

/// Returns `value` when it lies in `minimum..=maximum` (so NaN does not).
///
/// # Errors
/// [`OutOfDomain`] otherwise.
pub fn check_within(
    quantity: &'static str,
    unit: &'static str,
    value: f64,
    minimum: f64,
    maximum: f64,
) -> Result<f64, OutOfDomain> {
    if (minimum..=maximum).contains(&value) {
        Ok(value)
    } else {
        Err(OutOfDomain { quantity, unit, value, minimum, maximum })
    }
}

/// Returns `value` when it is finite.
///
/// # Errors
/// [`OutOfDomain`] with the limits of `f64` otherwise.
pub fn check_finite(
    quantity: &'static str,
    unit: &'static str,
    value: f64,
) -> Result<f64, OutOfDomain> {
    check_within(quantity, unit, value, f64::MIN, f64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_inclusive_and_nan_is_outside() {
        assert_eq!(check_within("Mach number", "-", 0.1, 0.1, 0.99), Ok(0.1));
        assert!(check_within("Mach number", "-", f64::NAN, 0.1, 0.99).is_err());
        assert!(check_finite("mass", "kg", f64::INFINITY).is_err());
    }

    #[test]
    fn message_names_quantity_value_unit_and_limits() {
        let error = check_within("pressure altitude", "m", 31_000.0, -2000.0, 20_000.0);
        assert_eq!(
            error.unwrap_err().to_string(),
            "pressure altitude 31000 m outside -2000 to 20000 m"
        );
    }
}
