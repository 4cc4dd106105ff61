//! Coordinates of a drawing as text.

use maud::PreEscaped;

/// A letter of a path and the point that it leads to.
pub(crate) fn push_point(d: &mut String, letter: char, (x, y): (f64, f64)) {
    d.push(letter);
    push_coordinate(d, x);
    d.push(' ');
    push_coordinate(d, y);
}

/// A tenth of a pixel is enough.
pub(crate) fn coordinate(value: f64) -> String {
    let mut text = String::new();
    push_coordinate(&mut text, value);
    text
}

/// The same as the value of an attribute: there is nothing in it to escape.
pub(crate) fn pixel(value: f64) -> PreEscaped<String> {
    PreEscaped(coordinate(value))
}

/// Appends what `{value:.1}` gives, without a last `.0` and without a sign of zero. A page holds hundreds of thousands of
/// them, and formatting with a precision is slow.
fn push_coordinate(text: &mut String, value: f64) {
    /// What follows a whole number.
    const TENTHS: [&str; 10] = ["", ".1", ".2", ".3", ".4", ".5", ".6", ".7", ".8", ".9"];
    /// Distance from the middle between two tenths above which the product with 10 is rounded as the value would be.
    const CLEAR: f64 = 1e-6;
    let tenths = value * 10.0;
    let nearest = tenths.round();
    // In this range tenths are exact numbers, and the error of the product is far below what is clear.
    if tenths.abs() < 1e8 && (tenths - nearest).abs() < 0.5 - CLEAR {
        if nearest < 0.0 {
            text.push('-');
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "from 0 to 1e8"
        )]
        let magnitude = nearest.abs() as u32;
        text.push_str(itoa::Buffer::new().format(magnitude / 10));
        text.push_str(TENTHS[magnitude as usize % TENTHS.len()]);
        return;
    }
    let printed = format!("{value:.1}");
    match printed.strip_suffix(".0") {
        Some("-0") => text.push('0'),
        Some(whole) => text.push_str(whole),
        None => text.push_str(&printed),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the standard library's formatting with a precision.
    #[test]
    fn coordinates_are_rounded_as_the_standard_library_does() {
        for step in -40_000..40_000_i32 {
            let tie = f64::from(step) / 20.0;
            let bits = tie.to_bits();
            let beside = [bits.wrapping_sub(1), bits, bits + 1].map(f64::from_bits);
            for value in beside.into_iter().chain([tie / 7.0, tie * 1e3, tie * 1e7]) {
                let printed = format!("{value:.1}");
                let expected = printed.strip_suffix(".0").unwrap_or(&printed);
                let expected = if expected == "-0" { "0" } else { expected };
                assert_eq!(coordinate(value), expected);
            }
        }
    }
}
