//! The names and the first rows of a recording.

use core::fmt::Write;
use std::collections::BTreeSet;

use super::super::table::{self, Form};
use super::names::{Name, unit_called};
use super::rules::Rule;
use crate::number::without_groups;
use crate::refusal::Refusal;

/// Rows whose values are looked at.
const ROWS: usize = 5000;

/// A recording's columns: names and the first rows.
pub(super) struct Columns {
    pub(super) form: Form,
    pub(super) names: Vec<Name>,
    /// Rows of values.
    pub(super) rows: Vec<Vec<String>>,
    /// Whether a row of units comes before them.
    pub(super) units_row: bool,
    /// The character before the decimals of a number.
    pub(super) decimal: char,
    /// The one between groups of three digits.
    pub(super) thousands: Option<char>,
    /// Texts that stand where there is no number; in `rows` they are empty.
    not_available: BTreeSet<String>,
}

impl Columns {
    pub(super) fn from_text(text: &str) -> Result<Self, Refusal> {
        let form = form_of(text);
        let sent = table::names(form, text)?;
        let text = table::below_titles(form, text);
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(true)
            .flexible(true)
            .delimiter(form.separator)
            .comment(form.comment)
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let mut rows: Vec<Vec<String>> = reader
            .records()
            .take(ROWS)
            .filter_map(Result::ok)
            .map(|record| record.iter().map(str::to_owned).collect::<Vec<String>>())
            // A blank row below the names tells nothing of the columns.
            .filter(|row| row.iter().any(|field| !field.is_empty()))
            .collect();
        let units = rows.first().filter(|row| is_row_of_units(row)).cloned();
        let units_row = units.is_some();
        if units_row {
            rows.remove(0);
        }
        let not_available = take_marks(&mut rows);
        let commented = units_in_comment(form, text, sent.len());
        let units = units.or(commented);
        let unit_of = |column| units.as_ref().and_then(|row| row.get(column)).map(String::as_str);
        let names = sent
            .iter()
            .enumerate()
            .map(|(column, name)| Name::new(name, unit_of(column)))
            .collect();
        let has_commas = form.separator != b',' && has_decimal_commas(&rows);
        let decimal = if has_commas { ',' } else { '.' };
        let thousands = mark_of_thousands(&rows, decimal);
        Ok(Self { form, names, rows, units_row, decimal, thousands, not_available })
    }

    /// The entries that tell how the text is written.
    pub(super) fn form_entries(&self) -> String {
        let mut text = String::new();
        if self.form.separator != b',' {
            let _ = writeln!(text, "    separator: {:?},", char::from(self.form.separator));
        }
        if let Some(mark) = self.form.comment {
            let _ = writeln!(text, "    comment: {:?},", char::from(mark));
        }
        if !self.not_available.is_empty() {
            let _ = writeln!(text, "    not_available: {:?},", Vec::from_iter(&self.not_available));
        }
        if self.decimal == ',' {
            text += "    decimal: ',',\n";
        }
        if let Some(mark) = self.thousands {
            let _ = writeln!(text, "    thousands: {mark:?},   // ?");
        }
        if self.form.names_line > 1 {
            let _ = writeln!(text, "    names_line: {},   // ?", self.form.names_line);
        }
        if self.units_row {
            text += "    units_row: true,\n";
        }
        text
    }

    /// The column of the first of the rule's names that is there and not empty.
    pub(super) fn find(&self, rule: &Rule) -> Option<usize> {
        let found = |wanted: &&str| {
            (0..self.names.len()).find(|&column| {
                self.names[column].is_of(wanted, rule.kind) && !self.is_empty(column)
            })
        };
        rule.names.iter().find_map(found)
    }

    /// Whether no row has anything in a column.
    pub(super) fn is_empty(&self, column: usize) -> bool {
        !self.rows.is_empty() && self.texts_of(column).all(str::is_empty)
    }

    pub(super) fn texts_of(&self, column: usize) -> impl Iterator<Item = &str> {
        self.rows.iter().filter_map(move |row| row.get(column)).map(String::as_str)
    }

    pub(super) fn number(&self, text: &str) -> Option<f64> {
        let joined = self.thousands.and_then(|mark| without_groups(text, mark, self.decimal));
        let text = joined.as_deref().unwrap_or(text);
        match self.decimal {
            ',' => text.replace(',', ".").parse().ok(),
            _ => text.parse().ok(),
        }
    }

    /// Median of a column's numbers.
    pub(super) fn median(&self, column: usize) -> Option<f64> {
        let mut numbers: Vec<f64> =
            self.texts_of(column).filter_map(|text| self.number(text)).collect();
        numbers.retain(|number: &f64| number.is_finite());
        numbers.sort_by(f64::total_cmp);
        numbers.get(numbers.len() / 2).copied()
    }

    /// Largest number of a column: what a flight reaches in cruise.
    pub(super) fn largest(&self, column: usize) -> Option<f64> {
        self.texts_of(column).filter_map(|text| self.number(text)).reduce(f64::max)
    }

    /// The first column whose values look like a date or a time of day.
    pub(super) fn column_of_dates(&self) -> Option<usize> {
        let looks_so = |text: &str| {
            text.starts_with(|c: char| c.is_ascii_digit()) && text.matches(':').count() == 2
        };
        (0..self.names.len()).find(|&column| self.texts_of(column).next().is_some_and(looks_so))
    }
}

/// Lines among which that of the names is looked for.
const TITLES: usize = 40;

/// The separator, and the line of the names: the first line that is not blank, unless another one begins the table that follows,
/// where a program writes what the table is above it.
fn form_of(text: &str) -> Form {
    let lines: Vec<(usize, &str)> =
        (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty()).take(TITLES).collect();
    if let Some(separator) = names_below_comments(&lines) {
        return Form { separator, comment: Some(COMMENT), names_line: 1 };
    }
    let (first, separator) = (0..lines.len())
        .find_map(|first| begins_a_table(&lines[first..]).map(|separator| (first, separator)))
        .unwrap_or_else(|| {
            (0, most_frequent_separator(lines.first().map_or("", |(_, line)| line)))
        });
    // Blank lines above the first one are left out by themselves.
    let names_line = if first == 0 { 1 } else { lines[first].0 };
    Form { separator, comment: None, names_line }
}

/// What avionics and instruments write before a line above the names.
const COMMENT: u8 = b'#';

/// The separator of a table below comments; its names are no numbers, lest a row below names with that mark is taken for them.
fn names_below_comments(lines: &[(usize, &str)]) -> Option<u8> {
    let is_comment = |(_, line): &&(usize, &str)| line.as_bytes().first() == Some(&COMMENT);
    let comments = lines.iter().take_while(is_comment).count();
    let (_, names) = lines.get(comments).filter(|_| comments > 0)?;
    let separator = begins_a_table(&lines[comments..])?;
    let has_number =
        names.split(char::from(separator)).any(|field| field.trim().parse::<f64>().is_ok());
    (!has_number).then_some(separator)
}

/// The units where a comment above the names has as many fields as there are names.
fn units_in_comment(form: Form, text: &str, columns: usize) -> Option<Vec<String>> {
    let mark = char::from(form.comment?);
    let comments = text.lines().map_while(|line| line.strip_prefix(mark));
    let fields = comments.map(|line| line.split(char::from(form.separator)).map(unit_word));
    let rows: Vec<Vec<String>> = fields.map(Iterator::collect).collect();
    rows.into_iter().rfind(|row| row.len() == columns && is_row_of_units(row))
}

/// A unit without what follows it: "ft" of "ft Baro".
fn unit_word(field: &str) -> String {
    let field = field.trim();
    let word = field.split_whitespace().next().unwrap_or_default();
    if unit_called(field).is_none() && unit_called(word).is_some() { word } else { field }
        .to_owned()
}

/// Makes texts that mean "no number" empty, and gives them, but for NaN, which means it in every recording.
fn take_marks(rows: &mut [Vec<String>]) -> BTreeSet<String> {
    let mut marks = BTreeSet::new();
    for cell in rows.iter_mut().flatten().filter(|cell| means_no_number(cell)) {
        let mark = core::mem::take(cell);
        if !mark.eq_ignore_ascii_case("nan") {
            marks.insert(mark);
        }
    }
    marks
}

/// Whether programs and print-outs write a text where they have no number.
fn means_no_number(text: &str) -> bool {
    let words = ["nan", "null", "n/a", "na", "#n/a", "none", "nil"];
    let is_mark = |letter: char| "*-.#?_".contains(letter);
    !text.is_empty()
        && (text.chars().all(is_mark) || words.iter().any(|word| text.eq_ignore_ascii_case(word)))
}

fn most_frequent_separator(line: &str) -> u8 {
    let count = |separator: &u8| separators_of(line, char::from(*separator));
    [b',', b';', b'\t', b'|'].into_iter().max_by_key(count).unwrap_or(b',')
}

/// The separator of the table that begins with these lines: as many are in most of the next lines as in the first one, whose fields
/// are names.
fn begins_a_table(lines: &[(usize, &str)]) -> Option<u8> {
    let ((_, names), rows) = lines.split_first()?;
    let separator = most_frequent_separator(names);
    let mark = char::from(separator);
    let count = separators_of(names, mark);
    let next = &rows[..rows.len().min(5)];
    let alike = next.iter().filter(|(_, row)| separators_of(row, mark) == count).count();
    let fields = || names.split(mark).map(str::trim).filter(|field| !field.is_empty());
    let numbers = fields().filter(|field| field.parse::<f64>().is_ok()).count();
    let is_table = count >= 2 && !next.is_empty() && 2 * alike > next.len();
    (is_table && 2 * numbers < fields().count()).then_some(separator)
}

/// Separators that are not between quotes.
fn separators_of(line: &str, separator: char) -> usize {
    line.split('"').step_by(2).map(|outside| outside.matches(separator).count()).sum()
}

/// The mark between groups of three digits: that of the most numbers of which a comma or a point makes no other number, if any.
fn mark_of_thousands(rows: &[Vec<String>], decimal: char) -> Option<char> {
    let marks = [',', '.', ' ', '\'', '\u{a0}', '\u{202f}'].into_iter();
    let counted = marks.filter(|mark| *mark != decimal).map(|mark| {
        let cells = rows.iter().flatten();
        (cells.filter(|cell| without_groups(cell, mark, decimal).is_some()).count(), mark)
    });
    counted.max_by_key(|(count, _)| *count).filter(|(count, _)| *count > 0).map(|(_, mark)| mark)
}

/// Whether a row holds no number, and the names of at least two units.
fn is_row_of_units(row: &[String]) -> bool {
    row.iter().all(|cell| cell.parse::<f64>().is_err())
        && row.iter().filter(|cell| unit_called(cell).is_some()).count() >= 2
}

/// Whether more numbers have a comma before their decimals than a point.
fn has_decimal_commas(rows: &[Vec<String>]) -> bool {
    let with = |mark: char| {
        let is_number = |cell: &&String| {
            cell.matches(mark).count() == 1 && cell.replace(mark, ".").parse::<f64>().is_ok()
        };
        rows.iter().flatten().filter(is_number).count()
    };
    with(',') > with('.')
}
