//! The line of a file that a message is about, with what is wrong in it underlined.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::neutral;

/// Lines are looked for in so much of a file.
const MOST_BYTES: u64 = 16 << 20;
/// So much of a line is shown about the place.
const SHOWN: usize = 72;
/// Where the line goes on.
const CUT: char = '…';

/// A line, and the place in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Excerpt {
    line: usize,
    /// The part of the line that is shown; one character where the file has one.
    shown: String,
    /// The underlined part of `shown`: first character and number of characters.
    underlined: (usize, usize),
}

impl Excerpt {
    /// The line of a text file; `None` where it has none: a packed file, a file that is gone.
    pub(crate) fn read(
        path: &Path,
        line: usize,
        column: Option<usize>,
        reason: &str,
    ) -> Option<Self> {
        if !path.is_file() {
            return None;
        }
        let file = std::fs::File::options().read(true).open(path).ok()?;
        let mut reader = BufReader::new(file.take(MOST_BYTES));
        // Tables of other kinds count rows as lines.
        let beginning = reader.fill_buf().ok()?;
        if beginning.starts_with(b"PAR1") || beginning.starts_with(b"ARROW1") {
            return None;
        }
        let mut bytes = Vec::new();
        for _ in 0..line {
            bytes.clear();
            if reader.read_until(b'\n', &mut bytes).ok()? == 0 {
                return None;
            }
        }
        let text = String::from_utf8(bytes).ok()?;
        Self::of_line(text.trim_end_matches(['\n', '\r']), line, column, reason)
    }

    fn of_line(text: &str, line: usize, column: Option<usize>, reason: &str) -> Option<Self> {
        if text.contains('\0') || text.trim().is_empty() {
            return None;
        }
        // What a terminal obeys is one box, so that columns stay columns.
        let letters: Vec<char> = text.chars().map(one).collect();
        let (first, count) = place(&letters, column, reason);
        let from = if letters.len() <= SHOWN { 0 } else { first.saturating_sub(SHOWN / 3) };
        let to = letters.len().min(from + SHOWN);
        let count = count.min(to.saturating_sub(first)).max(1);
        let mut shown = letters[from..to].to_vec();
        // A part of a number is not to be taken for one.
        if from > 0 {
            shown[0] = CUT;
        }
        if let Some(last) = shown.last_mut().filter(|_| to < letters.len() && first + count < to) {
            *last = CUT;
        }
        Some(Self { line, shown: shown.into_iter().collect(), underlined: (first - from, count) })
    }

    /// Two lines: the file's, and one that underlines the place.
    pub(crate) fn drawn(&self) -> String {
        let number = self.line.to_string();
        let margin = " ".repeat(number.len());
        let (first, count) = self.underlined;
        format!(
            "  {number} │ {}\n  {margin} │ {}{}\n",
            self.shown,
            " ".repeat(first),
            "^".repeat(count)
        )
    }
}

fn one(letter: char) -> char {
    let is_obeyed = neutral(letter.encode_utf8(&mut [0; 4])).len() > letter.len_utf8();
    if is_obeyed || letter == '\t' { ' ' } else { letter }
}

/// What is underlined: the name that the reason gives where the line has it, the occurrence nearest to the column; else the
/// field of a table, or the word at the column; else the whole line.
fn place(letters: &[char], column: Option<usize>, reason: &str) -> (usize, usize) {
    // "column 4 (mach)" is the fourth field, "column 4" the fourth character.
    let is_field = |column: &usize| reason.contains(&format!("column {column} ("));
    let field = column.filter(is_field).and_then(|number| field(letters, number));
    let near = field.map(|(first, _)| first + 1).or(column);
    if let Some(found) = names_in(reason).find_map(|name| occurrence(letters, name, near)) {
        return found;
    }
    if let Some(field) = field {
        return field;
    }
    let ends = |letter: &char| letter.is_whitespace() || matches!(letter, ',' | ';' | ')' | ':');
    if let Some(column) = column {
        let first = column.saturating_sub(1).min(letters.len());
        let length = letters[first..].iter().position(ends);
        return (first, length.unwrap_or(letters.len() - first).max(1));
    }
    let first = letters.iter().position(|letter| !letter.is_whitespace()).unwrap_or(0);
    (first, letters.len() - first)
}

/// A field of a line of a table: first character and number of characters, one for an empty field.
fn field(letters: &[char], number: usize) -> Option<(usize, usize)> {
    let separator = [';', '\t', ','].into_iter().find(|letter| letters.contains(letter))?;
    let mut fields = letters.split(|letter| *letter == separator);
    let before: usize = fields.by_ref().take(number.checked_sub(1)?).map(|of| of.len() + 1).sum();
    fields.next().map(|of| (before, of.len().max(1)))
}

/// Names that a reason quotes or has in parentheses; what was found comes before what is expected.
fn names_in(reason: &str) -> impl Iterator<Item = &str> {
    let found = reason.split(", expected").next().unwrap_or_default();
    let between = |open: char, close: char| {
        let behind = found.split_once(open)?.1;
        behind.split_once(close).map(|(name, _)| name).filter(|name| !name.is_empty())
    };
    [between('"', '"'), between('`', '`'), between('(', ')')].into_iter().flatten()
}

fn occurrence(letters: &[char], name: &str, column: Option<usize>) -> Option<(usize, usize)> {
    let name: Vec<char> = name.chars().collect();
    let wanted = column.map_or(0, |column| column.saturating_sub(1));
    let found = letters
        .windows(name.len())
        .enumerate()
        .filter(|(_, part)| *part == name)
        .min_by_key(|(first, _)| first.abs_diff(wanted));
    found.map(|(first, _)| (first, name.len()))
}

/// Line and column that a message names: `line 3, column 5`, `line 3`, or `3:5` in front, as parsers of RON write it.
pub(crate) fn position_in(message: &str) -> Option<(usize, Option<usize>)> {
    let number = |text: &str| -> Option<usize> {
        let digits: String = text.chars().take_while(char::is_ascii_digit).collect();
        digits.parse().ok().filter(|found| *found > 0)
    };
    if let Some(behind) = message.split("line ").skip(1).find(|behind| number(behind).is_some()) {
        let line = number(behind)?;
        let column = behind
            .trim_start_matches(|letter: char| letter.is_ascii_digit())
            .strip_prefix(", column ")
            .and_then(number);
        return Some((line, column));
    }
    message.split(' ').find_map(|word| {
        let (line, behind) = word.split_once(':')?;
        let column = number(behind)?;
        let is_number = !line.is_empty() && line.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then(|| Some((number(line)?, Some(column)))).flatten()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_as_messages_write_them() {
        assert_eq!(
            position_in("not an aircraft file: line 8, column 14: Unexpected"),
            Some((8, Some(14)))
        );
        assert_eq!(position_in("line 20: 5 fields, expected 4"), Some((20, None)));
        assert_eq!(position_in("plan: 5:5-5:9: Unexpected field"), Some((5, Some(5))));
        assert_eq!(position_in("at 2019-03-14T10:45:00Z nothing"), None);
        assert_eq!(position_in("No such file"), None);
    }

    #[test]
    fn the_word_at_the_column_is_underlined() {
        let drawn = |text: &str, column, reason: &str| {
            Excerpt::of_line(text, 12, column, reason).unwrap().drawn()
        };
        assert_eq!(
            drawn("60 41000 NaN 3", Some(10), ""),
            "  12 │ 60 41000 NaN 3\n     │          ^^^\n"
        );
        assert_eq!(
            drawn("  wing_area: 3", None, "field named `wing_area`"),
            "  12 │   wing_area: 3\n     │   ^^^^^^^^^\n"
        );
        // A column of a table is a field, a column of RON is behind the name: the name decides.
        assert_eq!(
            drawn("a,mahc,b", Some(2), "line 1, column 2 (mahc): unknown, expected one of mach"),
            "  12 │ a,mahc,b\n     │   ^^^^\n"
        );
        let nothing = "line 12, column 3 (mach): found \"\", expected a number";
        assert_eq!(drawn("680,390,,4", Some(3), nothing), "  12 │ 680,390,,4\n     │         ^\n");
        let four = "line 12, column 4 (date): found \"4\", expected a date";
        assert_eq!(drawn("4;4;0,4;4", Some(4), four), "  12 │ 4;4;0,4;4\n     │         ^\n");
        assert_eq!(drawn("\ta\u{1b}[2Jb", Some(2), "").lines().next(), Some("  12 │  a [2Jb"));
        // Of a long line the part about the place is shown.
        let long = format!("{} here {}", "x".repeat(200), "y".repeat(200));
        let shown = Excerpt::of_line(&long, 1, Some(202), "").unwrap();
        assert_eq!(shown.shown.chars().count(), SHOWN);
        let here: String = shown.shown.chars().skip(shown.underlined.0).take(4).collect();
        assert_eq!(here, "here");
        assert!(shown.shown.starts_with("…x") && shown.shown.ends_with("y…"), "{}", shown.shown);
        // Beyond the end of the line: one mark there.
        assert_eq!(drawn("abc", Some(4), ""), "  12 │ abc\n     │    ^\n");
    }
}
