//! Shades of a value on either side of zero.

/// Shades on each side.
const SHADES: f64 = 5.0;

/// Class of a value: `more1` … `more5`, `less1` … `less5`, or `even` within half a shade; the strongest from `full` on.
pub(crate) fn class(value: f64, full: f64) -> String {
    let shade = (value / full * SHADES).round().clamp(-SHADES, SHADES);
    if shade > 0.0 {
        format!("more{shade}")
    } else if shade < 0.0 {
        format!("less{}", -shade)
    } else {
        "even".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shades_follow_the_sign() {
        assert_eq!(
            [-9.0, -1.2, 0.4, 0.6, 5.0].map(|value| class(value, 5.0)),
            ["less5", "less1", "even", "more1", "more5"]
        );
    }
}
