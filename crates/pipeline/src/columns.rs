//! Tables of named columns, and their text as CSV.
//!
//! Numbers in CSV are the shortest decimals that read back to the same bits; an absent value is an empty field.

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Text, never absent.
    Text(Vec<String>),
    /// Whole numbers.
    Count(Vec<u64>),
    /// Numbers, perhaps absent.
    Number(Vec<Option<f64>>),
}

impl Cells {
    fn len(&self) -> usize {
        match self {
            Self::Text(values) => values.len(),
            Self::Count(values) => values.len(),
            Self::Number(values) => values.len(),
        }
    }

    fn field(&self, row: usize) -> String {
        match self {
            Self::Text(values) => values[row].clone(),
            Self::Count(values) => values[row].to_string(),
            Self::Number(values) => values[row].map_or_else(String::new, |value| value.to_string()),
        }
    }
}

/// Columns of one length, with names, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    columns: Vec<(String, Cells)>,
}

impl Columns {
    /// Adds a column of text.
    pub fn text(&mut self, name: impl Into<String>, values: impl Iterator<Item = String>) {
        self.columns.push((name.into(), Cells::Text(values.collect())));
    }

    /// Adds a column of whole numbers.
    pub fn count(&mut self, name: impl Into<String>, values: impl Iterator<Item = u64>) {
        self.columns.push((name.into(), Cells::Count(values.collect())));
    }

    /// Adds a column of numbers.
    pub fn number(&mut self, name: impl Into<String>, values: impl Iterator<Item = Option<f64>>) {
        self.columns.push((name.into(), Cells::Number(values.collect())));
    }

    /// Names and cells, in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Cells)> {
        self.columns.iter().map(|(name, cells)| (name.as_str(), cells))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, cells)| cells.len())
    }

    /// The table as CSV with a header line.
    pub fn to_csv(&self) -> Vec<u8> {
        let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
        // Writing to memory cannot fail.
        let _ = writer.write_record(self.columns.iter().map(|(name, _)| name.as_str()));
        for row in 0..self.rows() {
            let _ = writer.write_record(self.columns.iter().map(|(_, cells)| cells.field(row)));
        }
        writer.into_inner().unwrap_or_default()
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
        columns
    }

    #[test]
    fn csv_quotes_and_keeps_the_bits() {
        let text = String::from_utf8(table().to_csv()).unwrap();
        assert_eq!(text, "tail,samples,mach\nT-001,9,0.30000000000000004\n\"T, \"\"2\"\"\",10,\n");
    }
}
