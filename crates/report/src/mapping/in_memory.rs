//! Rows of a table in memory: a recording that is no text. Its numbers are taken as they are; wherever that could differ from
//! reading the same rows as text, they are read as text.

use std::fmt::{self, Debug, Formatter};
use std::ops::Range;
use std::sync::Arc;

use flight::Timestamp;

/// Writes the text of a row, counted from the first of its stretch: comma-separated, without a line end.
type RowText = dyn Fn(usize) -> String + Send + Sync;

/// A stretch of the rows of a table, column by column.
#[derive(Clone, Debug)]
pub struct TableRows {
    /// Its columns, in the order of their names.
    pub columns: Vec<Cells>,
    /// Number of rows.
    pub rows: usize,
    /// The rows as text.
    pub text: Lines,
}

/// The cells of a column in a stretch of rows.
#[derive(Clone, Debug, PartialEq)]
pub enum Cells {
    /// Finite numbers, NaN where there is none.
    Numbers(Vec<f64>),
    /// Instants.
    Instants(Vec<Timestamp>),
    /// Dates and times of day without an offset, as if they were UTC: the mapping's offset makes instants of them.
    LocalTimes(Vec<Timestamp>),
    /// Texts without blanks around them: from which row on which, beginning with row 0.
    Texts(Vec<(usize, String)>),
    /// Anything else: what the text of the row has.
    AsText,
}

/// Rows of which the text is made when it is asked for.
#[derive(Clone)]
pub struct Lines(Arc<RowText>);

impl Lines {
    /// Lines from what writes one.
    pub fn new(text: impl Fn(usize) -> String + Send + Sync + 'static) -> Self {
        Self(Arc::new(text))
    }

    /// The text of a row.
    pub(super) fn line(&self, row: usize) -> String {
        (self.0)(row)
    }

    /// The text of rows that follow each other.
    pub(super) fn text(&self, rows: Range<usize>) -> String {
        rows.map(|row| self.line(row) + "\n").collect()
    }
}

impl Debug for Lines {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.debug_struct("Lines").finish_non_exhaustive()
    }
}

impl Cells {
    /// The number of rows, where the cells know it.
    pub(super) fn len(&self) -> Option<usize> {
        match self {
            Self::Numbers(values) => Some(values.len()),
            Self::Instants(values) | Self::LocalTimes(values) => Some(values.len()),
            Self::Texts(_) | Self::AsText => None,
        }
    }
}
