//! The names and the first rows of a recording.

use super::super::table::{self, Form};
use super::Rule;
use super::names::{Name, unit_called};
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
}

impl Columns {
    pub(super) fn from_text(text: &str) -> Result<Self, Refusal> {
        let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
        let separator = [b',', b';', b'\t', b'|']
            .into_iter()
            .max_by_key(|separator| first.matches(char::from(*separator)).count())
            .unwrap_or(b',');
        let form = Form { separator, comment: None };
        let sent = table::names(form, text)?;
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(true)
            .flexible(true)
            .delimiter(separator)
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
        if units.is_some() {
            rows.remove(0);
        }
        let unit_of = |column| units.as_ref().and_then(|row| row.get(column)).map(String::as_str);
        let names = sent
            .iter()
            .enumerate()
            .map(|(column, name)| Name::new(name, unit_of(column)))
            .collect();
        let decimal = if separator != b',' && has_decimal_commas(&rows) { ',' } else { '.' };
        Ok(Self { form, names, rows, units_row: units.is_some(), decimal })
    }

    /// The column of the first of the rule's names that is there.
    pub(super) fn find(&self, rule: &Rule) -> Option<usize> {
        rule.names.iter().find_map(|wanted| self.names.iter().position(|name| name.is(wanted)))
    }

    pub(super) fn texts_of(&self, column: usize) -> impl Iterator<Item = &str> {
        self.rows.iter().filter_map(move |row| row.get(column)).map(String::as_str)
    }

    pub(super) fn number(&self, text: &str) -> Option<f64> {
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
