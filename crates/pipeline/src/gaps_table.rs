//! The gap at every segment of each diagnosis as a table, and back: what charts of a diagnosis are drawn from, for a user's
//! own figures as well.

use std::collections::BTreeMap;

use crate::columns::Columns;
use crate::csv_cell;
use crate::diagnosed_tail::DiagnosedTail;
use crate::diagnosis_figures::DiagnosisFigures;
use crate::diagnosis_words::variable_words;
use diagnose::SegmentGap;

/// One row per segment that was used, in the order of tails and dates. Empty cells: `driver` where the variable is not
/// recorded, `gap_after_percent` where nothing is added.
#[must_use]
pub fn table(diagnoses: &[DiagnosedTail], figures: &[DiagnosisFigures]) -> Columns {
    let rows: Vec<(&DiagnosedTail, &DiagnosisFigures, &SegmentGap)> = diagnoses
        .iter()
        .zip(figures)
        .flat_map(|(tail, figures)| {
            figures.segments.iter().map(move |segment| (tail, figures, segment))
        })
        .collect();
    let number =
        |of: fn(&SegmentGap) -> f64| rows.iter().map(move |row| of(row.2)).collect::<Vec<f64>>();
    let mut columns = Columns::default();
    columns.text("tail", rows.iter().map(|row| row.0.tail.clone()));
    columns.count("flight_number", rows.iter().map(|row| row.2.flight as u64));
    columns.dense("date_s", number(|one| one.date_s));
    columns.dense("mach", number(|one| one.mach));
    columns.dense("lift_coefficient", number(|one| one.lift_coefficient));
    columns.text(
        "driver_variable",
        rows.iter().map(|row| {
            row.1.driver.map_or_else(String::new, |driver| variable_words(driver).into())
        }),
    );
    columns.number("driver", rows.iter().map(|row| row.2.driver));
    columns.count("in_region", rows.iter().map(|row| u64::from(row.2.in_region)));
    columns.dense("gap_before_percent", number(|one| one.before_percent));
    columns.number("gap_after_percent", rows.iter().map(|row| row.2.after_percent.last().copied()));
    columns
}

/// The segments of each tail of such a table, without the driving variable.
///
/// # Errors
/// A missing column, or a cell that is no number, with its line.
pub fn read(bytes: &[u8]) -> Result<BTreeMap<String, Vec<SegmentGap>>, GapsTableError> {
    let mut reader = csv::ReaderBuilder::new().from_reader(bytes);
    let header = reader.headers()?.clone();
    let mut tails: BTreeMap<String, Vec<SegmentGap>> = BTreeMap::new();
    for record in reader.records() {
        let record = record?;
        let row = Row { header: &header, record: &record };
        let after = row.text("gap_after_percent")?;
        let segment = SegmentGap {
            flight: row.parsed("flight_number", |cell| cell.parse().ok())?,
            date_s: row.number("date_s")?,
            mach: row.number("mach")?,
            lift_coefficient: row.number("lift_coefficient")?,
            driver: None,
            in_region: row.number("in_region")? != 0.0,
            before_percent: row.number("gap_before_percent")?,
            after_percent: match after {
                "" => Vec::new(),
                _ => vec![row.number("gap_after_percent")?],
            },
            engines_apart_percent: Vec::new(),
        };
        tails.entry(csv_cell::read(row.text("tail")?).into_owned()).or_default().push(segment);
    }
    Ok(tails)
}

/// Why a table is not one of gaps.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GapsTableError {
    /// No CSV.
    #[error(transparent)]
    Csv(#[from] csv::Error),
    /// A column is missing.
    #[error("no column {column:?}; expected the gaps.csv of `diagnose`")]
    MissingColumn {
        /// Its name.
        column: &'static str,
    },
    /// A cell is not a number.
    #[error("line {line}, column {column:?}: found {found:?}, expected a finite number")]
    NotANumber {
        /// Line in the file, from 1.
        line: u64,
        /// Name of the column.
        column: &'static str,
        /// What the cell holds.
        found: String,
    },
}

struct Row<'a> {
    header: &'a csv::StringRecord,
    record: &'a csv::StringRecord,
}

impl Row<'_> {
    fn text(&self, column: &'static str) -> Result<&str, GapsTableError> {
        let place = self.header.iter().position(|name| name == column);
        place
            .and_then(|place| self.record.get(place))
            .ok_or(GapsTableError::MissingColumn { column })
    }

    fn number(&self, column: &'static str) -> Result<f64, GapsTableError> {
        self.parsed(column, |cell| cell.parse().ok().filter(|value: &f64| value.is_finite()))
    }

    fn parsed<T>(
        &self,
        column: &'static str,
        parse: impl Fn(&str) -> Option<T>,
    ) -> Result<T, GapsTableError> {
        let cell = self.text(column)?;
        parse(cell).ok_or_else(|| GapsTableError::NotANumber {
            line: self.record.position().map_or(0, csv::Position::line),
            column,
            found: cell.to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "tail,flight_number,date_s,mach,lift_coefficient,driver_variable,driver,in_region,gap_before_percent,\
                         gap_after_percent\nN1,0,1.5e9,0.8,0.45,mach,0.8,1,2.5,\nN1,3,1.6e9,0.78,0.5,mach,,0,-0.5,0.25\n";

    #[test]
    fn a_table_is_read_by_the_names_of_its_columns() {
        let tails = read(TABLE.as_bytes()).unwrap();
        let segments = &tails["N1"];
        assert_eq!(segments.len(), 2);
        assert_eq!((segments[0].mach, segments[0].in_region), (0.8, true));
        assert_eq!(segments[0].after_percent, Vec::<f64>::new());
        assert_eq!((segments[1].flight, segments[1].before_percent), (3, -0.5));
        assert_eq!(segments[1].after_percent, vec![0.25]);
    }

    #[test]
    fn errors_name_line_and_column() {
        let error = |text: &str| read(text.as_bytes()).unwrap_err().to_string();
        let damaged = TABLE.replace("-0.5,0.25", "nan,0.25");
        assert_eq!(
            error(&damaged),
            "line 3, column \"gap_before_percent\": found \"nan\", expected a finite number"
        );
        assert!(error(&TABLE.replace("mach,lift", "ma,lift")).contains("no column \"mach\""));
    }
}
