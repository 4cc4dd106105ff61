//! Tables of named columns, and their text as CSV.
//!
//! Numbers in CSV are the shortest decimals that read back to the same bits; an absent value is an empty field; texts are
//! made harmless by [`csv_cell`].

mod texts;

use std::fmt::Write as _;

use crate::csv_cell;
pub use texts::Texts;

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Text, never absent.
    Text(Texts),
    /// Whole numbers.
    Count(Vec<u64>),
    /// Numbers, perhaps absent.
    Number(Vec<Option<f64>>),
    /// Numbers, NaN where absent: half the memory.
    Dense(Vec<f64>),
}

impl Cells {
    fn len(&self) -> usize {
        match self {
            Self::Text(values) => values.len(),
            Self::Count(values) => values.len(),
            Self::Number(values) => values.len(),
            Self::Dense(values) => values.len(),
        }
    }

    fn value(&self, row: usize) -> serde_json::Value {
        match self {
            Self::Text(values) => values.get(row).into(),
            Self::Count(values) => values[row].into(),
            Self::Number(values) => values[row].into(),
            // A number that is not finite is `null`.
            Self::Dense(values) => values[row].into(),
        }
    }

    fn push_field(&self, row: usize, text: &mut String) {
        match self {
            Self::Text(values) => push_quoted(&csv_cell::written(values.get(row)), text),
            Self::Count(values) => text.push_str(itoa::Buffer::new().format(values[row])),
            Self::Number(values) => {
                if let Some(value) = values[row] {
                    push_shortest(value, text);
                }
            }
            Self::Dense(values) => {
                if !values[row].is_nan() {
                    push_shortest(values[row], text);
                }
            }
        }
    }
}

/// Appends a number as `Display` writes it: the shortest decimal that reads back to the same bits, without exponent.
/// A table holds millions of them, and `Display` is slow at this.
pub fn push_shortest(value: f64, text: &mut String) {
    if value.is_finite() {
        let mut buffer = zmij::Buffer::new();
        let printed = buffer.format_finite(value);
        // Far from where any program begins to write exponents nothing needs to be looked for.
        let is_plain = (1e-4..1e15).contains(&value.abs());
        if is_plain || !printed.bytes().any(|byte| byte == b'e') {
            text.push_str(printed.strip_suffix(".0").unwrap_or(printed));
            return;
        }
    }
    let _ = write!(text, "{value}");
}

/// Appends a field, in quotes where it has to be.
///
/// # Source
/// RFC 4180, section 2.
fn push_quoted(field: &str, text: &mut String) {
    if !field.bytes().any(|byte| matches!(byte, b',' | b'"' | b'\n' | b'\r')) {
        text.push_str(field);
        return;
    }
    text.push('"');
    for (index, part) in field.split('"').enumerate() {
        text.push_str(if index == 0 { "" } else { "\"\"" });
        text.push_str(part);
    }
    text.push('"');
}

/// Ends the line that begins at `start` and in which a comma follows every field. A line of one empty field is written as
/// quotes: an empty line would be none.
fn end_line(text: &mut String, start: usize) {
    text.pop();
    if text.len() == start {
        text.push_str("\"\"");
    }
    text.push('\n');
}

/// Columns of one length, with names, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    columns: Vec<(String, Cells)>,
}

impl Columns {
    /// Adds a column of text.
    pub fn text(&mut self, name: impl Into<String>, values: impl Iterator<Item: AsRef<str>>) {
        self.columns.push((name.into(), Cells::Text(values.collect())));
    }

    /// The same of texts that are put together already.
    pub fn texts(&mut self, name: impl Into<String>, values: Texts) {
        self.columns.push((name.into(), Cells::Text(values)));
    }

    /// Adds a column of whole numbers.
    pub fn count(&mut self, name: impl Into<String>, values: impl Iterator<Item = u64>) {
        self.columns.push((name.into(), Cells::Count(values.collect())));
    }

    /// Adds a column of numbers.
    pub fn number(&mut self, name: impl Into<String>, values: impl Iterator<Item = Option<f64>>) {
        self.columns.push((name.into(), Cells::Number(values.collect())));
    }

    /// Adds a column of numbers, NaN where one is absent.
    pub fn dense(&mut self, name: impl Into<String>, values: Vec<f64>) {
        self.columns.push((name.into(), Cells::Dense(values)));
    }

    /// Names and cells, in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Cells)> {
        self.columns.iter().map(|(name, cells)| (name.as_str(), cells))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, cells)| cells.len())
    }

    /// The table as a JSON array with an object for each row, and `null` for what is absent.
    pub fn to_json(&self) -> Vec<u8> {
        let rows: Vec<serde_json::Map<String, serde_json::Value>> = (0..self.rows())
            .map(|row| {
                let fields = self.columns.iter();
                fields.map(|(name, cells)| (name.clone(), cells.value(row))).collect()
            })
            .collect();
        let mut bytes = serde_json::to_vec(&rows).unwrap_or_default();
        bytes.push(b'\n');
        bytes
    }

    /// The table as CSV with a header line.
    pub fn to_csv(&self) -> Vec<u8> {
        let mut text = String::new();
        for (name, _) in &self.columns {
            push_quoted(&csv_cell::written(name), &mut text);
            text.push(',');
        }
        end_line(&mut text, 0);
        self.push_rows(&mut text);
        text.into_bytes()
    }

    /// The same without the header line: more rows of a table with the same columns.
    pub fn to_csv_rows(&self) -> Vec<u8> {
        let mut text = String::new();
        self.push_rows(&mut text);
        text.into_bytes()
    }

    fn push_rows(&self, text: &mut String) {
        for row in 0..self.rows() {
            let start = text.len();
            for (_, cells) in &self.columns {
                cells.push_field(row, text);
                text.push(',');
            }
            end_line(text, start);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Columns {
        let mut columns = Columns::default();
        columns.text("tail", ["T-001", "T, \"2\""].into_iter().map(str::to_owned));
        columns.count("samples", [9, 10].into_iter());
        columns.number("mach", [Some(0.1 + 0.2), None].into_iter());
        columns.dense("lift_coefficient", vec![f64::NAN, 0.5]);
        columns
    }

    #[test]
    fn csv_quotes_and_keeps_the_bits() {
        let text = String::from_utf8(table().to_csv()).unwrap();
        assert_eq!(
            text,
            "tail,samples,mach,lift_coefficient\nT-001,9,0.30000000000000004,\n\"T, \"\"2\"\"\",10,,0.5\n"
        );
    }

    #[test]
    fn a_line_of_one_empty_field_is_a_line() {
        let mut columns = Columns::default();
        columns.text("a", ["", "b"].into_iter().map(str::to_owned));
        assert_eq!(columns.to_csv(), b"a\n\"\"\nb\n");
    }

    proptest::proptest! {
        /// Oracle: the writer of the `csv` crate.
        #[test]
        fn text_is_quoted_as_the_csv_crate_quotes(fields in proptest::collection::vec("[ -~\n\r,\"é]{0,6}", 1..5)) {
            let mut columns = Columns::default();
            let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
            for field in &fields {
                columns.text("name", std::iter::once(field.clone()));
            }
            writer.write_record(fields.iter().map(|_| "name")).unwrap();
            writer.write_record(fields.iter().map(|field| csv_cell::written(field).into_owned())).unwrap();
            proptest::prop_assert_eq!(columns.to_csv(), writer.into_inner().unwrap());
        }

        /// Oracle: `Display` of the standard library; where two shortest decimals are equally near, either is right.
        #[test]
        fn numbers_are_as_short_as_those_of_display(value in proptest::num::f64::ANY, power in -30..30_i32) {
            for value in [value, value.signum() * (value.abs() % 1e6), 10_f64.powi(power), -0.0] {
                let mut text = String::new();
                push_shortest(value, &mut text);
                let display = value.to_string();
                proptest::prop_assert_eq!(text.len(), display.len());
                if value.is_nan() {
                    proptest::prop_assert_eq!(text, display);
                } else {
                    proptest::prop_assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
                }
            }
        }
    }
}
