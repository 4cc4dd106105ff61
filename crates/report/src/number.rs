//! Numbers of the format: `[+-]digits[.digits][e[+-]digits]`; digits before or after the point may be missing, not
//! both.
//!
//! The grammar is checked here, byte by byte: general float parsers accept more (`inf`, `nan`, `1E3`). The digits seen
//! by the check give the value at no further cost where that is exact; everything else is passed to `fast-float2`.
//! Either way the value is the double nearest to the decimal.

/// Powers of ten that a double holds exactly and that fifteen digits can need.
const POWERS_OF_TEN: [f64; 16] =
    [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];

/// Digits of an integer that a double surely holds exactly.
const EXACT_DIGITS: usize = 15;

/// A number of at most 15 digits without plus sign and exponent at the start of `bytes`, and what follows it: nearly
/// every field of a report. `None` for anything else, also at the end of `bytes`; [`leading`] handles that.
#[inline]
pub(crate) fn short(bytes: &[u8]) -> Option<(f64, &[u8])> {
    short_at(bytes, 0).map(|(number, end)| (number, &bytes[end..]))
}

/// The same at a place in `bytes`, and its end.
#[inline]
pub(crate) fn short_at(bytes: &[u8], at: usize) -> Option<(f64, usize)> {
    match within_words(bytes, at) {
        Some((number, end, after)) if after != b'e' => Some((number, end)),
        _ => {
            let (number, rest) = short_by_bytes(bytes.get(at..)?)?;
            Some((number, bytes.len() - rest.len()))
        }
    }
}

/// A number without plus sign and exponent that ends within eight bytes, its end, and the byte there, which can be an `e`.
/// `None` for anything else, also within eight bytes of the end.
#[expect(
    clippy::inline_always,
    reason = "called, it costs as much again: its constants are loaded for each number"
)]
#[inline(always)]
pub(crate) fn within_words(bytes: &[u8], at: usize) -> Option<(f64, usize, u8)> {
    let is_negative = *bytes.get(at)? == b'-';
    let (magnitude, end, after) = within_a_word(bytes, at + usize::from(is_negative))?;
    // Without a branch: in a column about zero the sign is one way as often as the other.
    let sign = u64::from(is_negative) << 63;
    Some((f64::from_bits(magnitude.to_bits() | sign), end, after))
}

/// The magnitude of [`within_words`]: eight bytes are looked at together, as one 64-bit word whose lowest byte is the first.
///
/// # Source
/// Eight digits in three multiplications: Lemire 2021, "Number parsing at a gigabyte per second", section 6.
#[inline(always)]
fn within_a_word(bytes: &[u8], at: usize) -> Option<(f64, usize, u8)> {
    const EACH: u64 = 0x0101_0101_0101_0101;
    let word = u64::from_le_bytes(*bytes.get(at..)?.first_chunk()?);
    // Digits become 0 to 9. Of each byte that is not one of these the highest bit is set, up to the first byte from which a
    // sum carries: that is neither a digit nor a point, and nothing behind it is looked at.
    let digits = word ^ (EACH * 0x30);
    let no_digit = (digits.wrapping_add(EACH * 0x76) | digits) & (EACH * 0x80);
    let point = no_digit.trailing_zeros() / 8;
    if point == 8 {
        return None;
    }
    let (digits, fraction_digits, length) = if byte_of(word, point) == b'.' {
        let before_point = (no_digit ^ (no_digit - 1)) >> 8;
        let end = (no_digit & (no_digit - 1)).trailing_zeros() / 8;
        // Closed up over the point.
        let closed_up = digits & before_point | (digits >> 8) & !before_point;
        (closed_up << 8, end - point - 1, end)
    } else {
        (digits, 0, point)
    };
    // A point alone has no digit.
    if length == 8 || length <= u32::from(point == 0) {
        return None;
    }
    // The last digit to the highest byte, zeros before the first.
    let pairs = (digits << (64 - 8 * length)).wrapping_mul(10 * 0x100 + 1) >> 8;
    let fours = (pairs & 0x00ff_00ff_00ff_00ff).wrapping_mul(100 * 0x1_0000 + 1) >> 16;
    let mantissa = (fours & 0x0000_ffff_0000_ffff).wrapping_mul(10_000 * 0x1_0000_0000 + 1) >> 32;
    // At most eight digits.
    let mantissa = f64::from(mantissa as u32);
    // Both operands are exact, so the quotient is the nearest double (Clinger 1990).
    let magnitude = mantissa / POWERS_OF_TEN[fraction_digits as usize];
    Some((magnitude, at + length as usize, byte_of(word, length)))
}

/// One byte of a word; the lowest is the first.
#[inline]
const fn byte_of(word: u64, place: u32) -> u8 {
    (word >> (8 * place)).to_le_bytes()[0]
}

/// As [`short`], byte by byte.
fn short_by_bytes(bytes: &[u8]) -> Option<(f64, &[u8])> {
    let mut rest = bytes.iter();
    let mut byte = *rest.next()?;
    let is_negative = byte == b'-';
    if is_negative {
        byte = *rest.next()?;
    }
    let mut mantissa = 0_u64;
    let mut digit = byte.wrapping_sub(b'0');
    let after_sign = rest.len();
    while digit <= 9 {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        byte = *rest.next()?;
        digit = byte.wrapping_sub(b'0');
    }
    let mut digits = after_sign - rest.len();
    let mut fraction_digits = 0;
    if byte == b'.' {
        let after_point = rest.len();
        loop {
            byte = *rest.next()?;
            digit = byte.wrapping_sub(b'0');
            if digit > 9 {
                break;
            }
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        }
        fraction_digits = after_point - rest.len() - 1;
        digits += fraction_digits;
    }
    if digits == 0 || digits > EXACT_DIGITS || byte == b'e' {
        return None;
    }
    // Both operands are exact, so the quotient is the nearest double (Clinger 1990).
    let magnitude = mantissa as f64 / POWERS_OF_TEN[fraction_digits];
    let number = if is_negative { -magnitude } else { magnitude };
    Some((number, &bytes[bytes.len() - rest.len() - 1..]))
}

/// The number at the start of `bytes` and its length; `None` if there is none or it is too large for a double.
/// The caller has to check what follows the number.
pub(crate) fn leading(bytes: &[u8]) -> Option<(f64, usize)> {
    let (is_negative, sign) = match bytes.first() {
        Some(b'-') => (true, 1),
        Some(b'+') => (false, 1),
        _ => (false, 0),
    };
    let (magnitude, length) = unsigned(&bytes[sign..])?;
    Some((if is_negative { -magnitude } else { magnitude }, sign + length))
}

/// Numbers without sign of any length.
fn unsigned(bytes: &[u8]) -> Option<(f64, usize)> {
    let mut at = 0;
    let mut mantissa = 0_u64;
    let mut digits = take_digits(bytes, &mut at, &mut mantissa);
    let mut fraction_digits = 0;
    if bytes.get(at) == Some(&b'.') {
        at += 1;
        fraction_digits = take_digits(bytes, &mut at, &mut mantissa);
        digits += fraction_digits;
    }
    if digits == 0 {
        return None;
    }
    if digits <= EXACT_DIGITS && bytes.get(at) != Some(&b'e') {
        return Some((mantissa as f64 / POWERS_OF_TEN[fraction_digits], at));
    }
    if bytes.get(at) == Some(&b'e') {
        at += 1;
        if matches!(bytes.get(at), Some(b'+' | b'-')) {
            at += 1;
        }
        if take_digits(bytes, &mut at, &mut 0) == 0 {
            return None;
        }
    }
    let magnitude = fast_float2::parse::<f64, _>(&bytes[..at]).ok()?;
    magnitude.is_finite().then_some((magnitude, at))
}

/// The number that `bytes` is from start to end.
pub(crate) fn whole(bytes: &[u8]) -> Option<f64> {
    leading(bytes).filter(|(_, length)| *length == bytes.len()).map(|(value, _)| value)
}

/// A number without the marks between its groups of three digits; `None` where it has none, or a group of another length.
pub(crate) fn without_groups(text: &str, mark: char, decimal: char) -> Option<String> {
    let digits = text.trim_start_matches(['+', '-']);
    let end = digits.find(decimal).unwrap_or(digits.len());
    let mut groups = digits[..end].split(mark);
    let is_digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let first = groups.next().filter(|first| (1..=3).contains(&first.len()) && is_digits(first))?;
    let mut following = groups.clone().peekable();
    following.peek()?;
    let are_groups = following.all(|group| group.len() == 3 && is_digits(group));
    let sign = &text[..text.len() - digits.len()];
    let joined = || core::iter::once(first).chain(groups).collect::<String>();
    are_groups.then(|| format!("{sign}{}{}", joined(), &digits[end..]))
}

/// Whether `bytes` ends where a number cannot end: in a sign or in an exponent without digits.
pub(crate) fn is_cut_off(bytes: &[u8]) -> bool {
    let unsigned_exponent = bytes.strip_suffix(b"-").or_else(|| bytes.strip_suffix(b"+"));
    match unsigned_exponent {
        Some([]) => true,
        Some(rest) => rest.strip_suffix(b"e").is_some_and(|mantissa| whole(mantissa).is_some()),
        None => bytes.strip_suffix(b"e").is_some_and(|mantissa| whole(mantissa).is_some()),
    }
}

#[inline]
fn take_digits(bytes: &[u8], at: &mut usize, mantissa: &mut u64) -> usize {
    let start = *at;
    while let Some(digit) = bytes.get(*at).map(|byte| byte.wrapping_sub(b'0'))
        && digit <= 9
    {
        // Wraps only beyond 19 digits, where the value is not used.
        *mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        *at += 1;
    }
    *at - start
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grammar_and_nothing_else() {
        for good in ["0", "-0", "+5", "5.", ".5", "-.5", "1e3", "1.5e-3", "1e+3", "007", "1e0"] {
            assert_eq!(whole(good.as_bytes()), Some(good.parse().unwrap()), "{good}");
        }
        for bad in [
            "", "-", "+", ".", "-.", "e3", ".e3", "1e", "1e+", "1E3", "inf", "-inf", "nan", "NaN",
            "0x10", "1_000", "1,5", "--1", "+-1", "1e3.5", "1 ", " 1", "1e999", "infinity", "١",
        ] {
            assert_eq!(whole(bad.as_bytes()), None, "{bad}");
        }
    }

    #[test]
    fn groups_of_three_digits_and_no_others() {
        for (text, joined) in
            [("28,993", "28993"), ("-1,234,567.25", "-1234567.25"), ("1,000.5", "1000.5")]
        {
            assert_eq!(without_groups(text, ',', '.').as_deref(), Some(joined));
        }
        for other in ["28993", "2,89,93", "0,7175", "1,000,00", ",100", "1,000.5,0", "x,100", ""] {
            let found = without_groups(other, ',', '.');
            assert!(found.is_none_or(|found| whole(found.as_bytes()).is_none()), "{other}");
        }
        assert_eq!(without_groups("12 345,5", ' ', ',').as_deref(), Some("12345,5"));
    }

    #[test]
    fn cut_off_numbers() {
        for cut in ["-", "+", "1e", "1.5e-", "-3e+"] {
            assert!(is_cut_off(cut.as_bytes()), "{cut}");
        }
        for complete in ["", "1", "1.", "x-", "e", "e-", "1e5", "1-"] {
            assert!(!is_cut_off(complete.as_bytes()), "{complete}");
        }
    }

    proptest::proptest! {
        /// The short way finds the same as the long way, or leaves the number to it.
        #[test]
        fn short_numbers_are_numbers(line in "[+-]?[0-9.]{0,18}[e\\-:/x§ \\t]?[ -~§]{0,9}") {
            let long = leading(line.as_bytes()).map(|(value, length)| (value.to_bits(), length));
            let found = short(line.as_bytes())
                .map(|(value, rest)| (value.to_bits(), line.len() - rest.len()));
            let is_short = long.is_some_and(|(_, length)| {
                length <= 15 && length < line.len() && !line[..length].contains(['e', '+'])
            });
            if found.is_some() || is_short {
                proptest::prop_assert_eq!(found, long);
            }
        }

        /// Oracle: the standard library's correctly rounding parser.
        #[test]
        fn value_is_the_nearest_double(text in "[+-]?([0-9]{1,22}\\.?[0-9]{0,12}|\\.[0-9]{1,18})(e[+-]?[0-9]{1,3})?") {
            let expected: f64 = text.parse().unwrap();
            let expected = expected.is_finite().then_some(expected.to_bits());
            proptest::prop_assert_eq!(whole(text.as_bytes()).map(f64::to_bits), expected);
        }
    }
}
