//! Names in a header: type, tail, flight. They come from outside and go to terminals and into tables that spreadsheets open.

/// What a name has to be.
pub(crate) const FORM: &str =
    "a name: no control characters but tabs, and no =, + or @ at its beginning, nor - before more";

/// Whether a terminal or a spreadsheet only shows a name.
///
/// # Source
/// Control characters: ECMA-48, C0 and C1 (ESC begins a sequence that a terminal acts on). Beginnings that make a field of a CSV
/// file a formula: OWASP, "CSV injection". A single `-` is how some recorders write that they know no name.
pub(crate) fn is_harmless(name: &str) -> bool {
    let is_formula = name.starts_with(['=', '+', '@']) || (name.starts_with('-') && name != "-");
    !is_formula && !name.chars().any(|c| c.is_control() && c != '\t')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_something_acts_on() {
        for name in ["D-ABCD", "..N123", "-", "C-FXYZ é", "a=b", "<b>", "../../x", "0007", "a\tb"]
        {
            assert!(is_harmless(name), "{name:?}");
        }
        for name in ["=1+1", "+1", "@A1", "-2+3", "\u{1b}[2J", "x\u{9b}2J", "a\u{7f}"] {
            assert!(!is_harmless(name), "{name:?}");
        }
    }
}
