//! Numbers as the page writes them. A hyphen is the minus sign, no separators: figures can be pasted into a spreadsheet.

use pipeline::summary::not_minus_zero;

/// With sign and two decimals, a dash for no value.
pub(crate) fn signed(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{:+.2}", not_minus_zero(value, 2)))
}

/// With sign and one decimal.
pub(crate) fn signed_tenths(value: f64) -> String {
    format!("{:+.1}", not_minus_zero(value, 1))
}

/// Two decimals, a dash for no value.
pub(crate) fn plain(value: Option<f64>) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{:.2}", not_minus_zero(value, 2)))
}

/// A share as whole per cent, a dash for no value.
pub(crate) fn percent(share: Option<f64>) -> String {
    share.map_or_else(|| "–".to_owned(), |share| format!("{:.0} %", 100.0 * share))
}

/// A count, a dash for none.
pub(crate) fn count(count: Option<u32>) -> String {
    count.map_or_else(|| "–".to_owned(), |count| count.to_string())
}

/// A breakpoint or coefficient: two decimals, more where it has more, four at most.
pub(crate) fn breakpoint(value: f64) -> String {
    let text = format!("{value:.4}");
    let mut text = text.as_str();
    for _ in 0..2 {
        text = text.strip_suffix('0').unwrap_or(text);
    }
    text.to_owned()
}

/// With sign and three significant digits, as a person writes them.
pub(crate) fn three_digits(value: f64) -> String {
    let size = value.abs();
    let decimals = if size >= 100.0 {
        0
    } else if size >= 10.0 {
        1
    } else if size >= 1.0 {
        2
    } else if size >= 0.1 {
        3
    } else {
        4
    };
    format!("{:+.decimals$}", not_minus_zero(value, i32::try_from(decimals).unwrap_or(0)))
}

/// With its first letter as at the beginning of a sentence.
pub(crate) fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_words() {
        assert_eq!(signed(Some(4.406)), "+4.41");
        assert_eq!(signed(Some(-0.841)), "-0.84");
        assert_eq!(signed(Some(-0.001)), "+0.00");
        assert_eq!(signed(None), "–");
        assert_eq!(signed_tenths(-0.04), "+0.0");
        assert_eq!(plain(Some(1.0675)), "1.07");
        assert_eq!(percent(Some(0.41)), "41 %");
    }

    #[test]
    fn three_digits_with_sign() {
        assert_eq!(three_digits(123.8340), "+124");
        assert_eq!(three_digits(-12.34), "-12.3");
        assert_eq!(three_digits(0.0061), "+0.0061");
        assert_eq!(three_digits(-0.000_01), "+0.0000");
        assert_eq!(capitalised("engine 2"), "Engine 2");
        assert_eq!(capitalised(""), "");
    }

    #[test]
    fn breakpoints_keep_their_digits() {
        assert_eq!(breakpoint(0.8), "0.80");
        assert_eq!(breakpoint(0.825), "0.825");
        assert_eq!(breakpoint(0.30000000000000004), "0.30");
        assert_eq!(breakpoint(0.76125), "0.7612");
    }
}
