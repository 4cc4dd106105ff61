//! Comparing two texts whose numbers may differ within tolerance: CSV, JSON and RON alike.

/// How far numbers may be apart: `absolute + relative · |expected|`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    /// Share of the expected value.
    pub relative: f64,
    /// Floor for values near zero.
    pub absolute: f64,
}

/// A place where two texts differ.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Difference {
    /// Line from 1.
    pub line: usize,
    /// Which number or word of the line, from 1.
    pub token: usize,
    /// What was expected.
    pub expected: String,
    /// What was found.
    pub found: String,
}

/// Places where `found` differs from `expected`: numbers beyond tolerance, anything else at all.
pub fn differences(expected: &str, found: &str, tolerance: Tolerance) -> Vec<Difference> {
    let mut all = Vec::new();
    let mut expected_lines = expected.lines();
    let mut found_lines = found.lines();
    let mut line = 0;
    loop {
        line += 1;
        match (expected_lines.next(), found_lines.next()) {
            (None, None) => return all,
            (Some(e), Some(f)) => compare_line(line, e, f, tolerance, &mut all),
            (e, f) => {
                let told = |text: Option<&str>| text.unwrap_or("no such line").to_owned();
                all.push(Difference { line, token: 1, expected: told(e), found: told(f) });
                return all;
            }
        }
    }
}

fn compare_line(
    line: usize,
    expected: &str,
    found: &str,
    tolerance: Tolerance,
    all: &mut Vec<Difference>,
) {
    let (mut e, mut f) = (tokens(expected).into_iter(), tokens(found).into_iter());
    let mut token = 0;
    loop {
        token += 1;
        match (e.next(), f.next()) {
            (None, None) => return,
            (Some(e), Some(f)) if same(e, f, tolerance) => {}
            (e, f) => {
                let told = |text: Option<&str>| text.unwrap_or("end of line").to_owned();
                all.push(Difference { line, token, expected: told(e), found: told(f) });
            }
        }
    }
}

fn same(expected: &str, found: &str, tolerance: Tolerance) -> bool {
    if expected == found {
        return true;
    }
    match (number(expected), number(found)) {
        (Some(e), Some(f)) => (e - f).abs() <= tolerance.absolute + tolerance.relative * e.abs(),
        _ => false,
    }
}

/// A finite number written with digits; a word such as `inf` is a word.
fn number(token: &str) -> Option<f64> {
    token.bytes().any(|byte| byte.is_ascii_digit()).then(|| token.parse().ok()).flatten()
}

/// Words and numbers of a line, and each other character for itself; blanks separate and are left out.
fn tokens(line: &str) -> Vec<&str> {
    let part_of_word = |c: char| c.is_alphanumeric() || matches!(c, '.' | '+' | '-' | '_' | '%');
    let mut tokens = Vec::new();
    let mut rest = line;
    while let Some(first) = rest.chars().next() {
        let length = if part_of_word(first) {
            rest.find(|c| !part_of_word(c)).unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        let (token, after) = rest.split_at(length);
        if !token.trim().is_empty() {
            tokens.push(token);
        }
        rest = after;
    }
    tokens
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: Tolerance = Tolerance { relative: 1e-9, absolute: 1e-12 };

    #[test]
    fn numbers_within_tolerance_are_the_same() {
        let expected = "tail,mach\nT-001,0.8\n";
        assert!(differences(expected, "tail,mach\nT-001,0.8000000000001\n", TOLERANCE).is_empty());
        let apart = differences(expected, "tail,mach\nT-001,0.80001\n", TOLERANCE);
        assert_eq!(apart.len(), 1);
        assert_eq!((apart[0].line, apart[0].expected.as_str()), (2, "0.8"));
        assert!(differences("a: 0.0,", "a: 1e-13,", TOLERANCE).is_empty());
    }

    #[test]
    fn words_and_lines_must_agree() {
        assert_eq!(differences("law: Paper", "law: Bayes", TOLERANCE).len(), 1);
        assert_eq!(differences("a\nb", "a", TOLERANCE).len(), 1);
        // Two more tokens: a comma and a number.
        assert_eq!(differences("1,2", "1,2,3", TOLERANCE).len(), 2);
        assert_eq!(differences("NaN", "nan", TOLERANCE).len(), 1);
    }
}
