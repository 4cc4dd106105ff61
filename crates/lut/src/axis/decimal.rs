//! Arithmetic progressions in decimals: 0.1, 0.15, 0.2, … without binary error.

/// `start + i·step` in exact decimal arithmetic, both taken as the shortest decimals that name their doubles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progression {
    start: i128,
    step: i128,
    exponent: i32,
}

impl Progression {
    /// `None` where a number is not finite or the two together have too many digits.
    pub(super) fn new(start: f64, step: f64) -> Option<Self> {
        let (start, start_exponent) = shortest_decimal(start)?;
        let (step, step_exponent) = shortest_decimal(step)?;
        let exponent = start_exponent.min(step_exponent);
        Some(Self {
            start: scaled(start, start_exponent - exponent)?,
            step: scaled(step, step_exponent - exponent)?,
            exponent,
        })
    }

    /// The double nearest to `start + index·step`.
    pub(super) fn value(&self, index: u32) -> Option<f64> {
        let digits = self.step.checked_mul(i128::from(index))?.checked_add(self.start)?;
        format!("{digits}e{}", self.exponent).parse().ok()
    }
}

/// `value = digits · 10^exponent` with the fewest digits that name this double.
fn shortest_decimal(value: f64) -> Option<(i128, i32)> {
    if !value.is_finite() {
        return None;
    }
    // Rust's exponent format is the shortest that reads back: "-1.25e-3".
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e')?;
    let exponent: i32 = exponent.parse().ok()?;
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
    let places = i32::try_from(fraction.len()).ok()?;
    Some((digits, exponent - places))
}

fn scaled(digits: i128, places: i32) -> Option<i128> {
    if digits == 0 {
        return Some(0); // any number of places
    }
    digits.checked_mul(10_i128.checked_pow(u32::try_from(places).ok()?)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shortest_decimals_by_hand() {
        assert_eq!(shortest_decimal(0.05), Some((5, -2)));
        assert_eq!(shortest_decimal(-1.25e-3), Some((-125, -5)));
        assert_eq!(shortest_decimal(400.0), Some((4, 2)));
        assert_eq!(shortest_decimal(0.0), Some((0, 0)));
        assert_eq!(shortest_decimal(f64::NAN), None);
    }

    #[test]
    fn values_are_the_typed_decimals() {
        let progression = Progression::new(0.1, 0.05).unwrap();
        assert_eq!(progression.value(0), Some(0.1));
        assert_eq!(progression.value(4), Some(0.3));
        assert_eq!(progression.value(14), Some(0.8));
    }

    #[test]
    fn too_many_digits_are_refused_and_not_rounded() {
        assert!(Progression::new(1e80, 1e-9).is_none());
        assert!(Progression::new(0.0, 1e-9).is_some());
    }
}
