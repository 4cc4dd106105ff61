//! Where a recording comes from: text piece by piece, or a table batch by batch.

use core::fmt;
use std::io::BufRead;

use super::{Batch, Mapping, Piece, Pieces, Stream, line_of_names};
use crate::Parsed;
use crate::refusal::{Found, Refusal, RefusalKind};

/// Gives the next rows of a table, of the columns at these places; `None` after the last, or why there are none.
pub type Batches<'s> = dyn FnMut(&[usize]) -> Result<Option<Batch>, String> + 's;

/// A recording that has not been read yet.
pub enum Source<'s> {
    /// Delimited text.
    Text(Pieces<Box<dyn BufRead + 's>>),
    /// A table in columns.
    Table {
        /// Names of its columns.
        names: Vec<String>,
        /// Places of those of types that are not read.
        unread: Vec<usize>,
        /// Its rows.
        batches: Box<Batches<'s>>,
        /// Rows that were given.
        rows: usize,
    },
}

impl fmt::Debug for Source<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Text(_) => "Source::Text",
            Self::Table { .. } => "Source::Table",
        })
    }
}

impl<'s> Source<'s> {
    /// Delimited text, plain or gzip.
    ///
    /// # Errors
    /// [`Refusal`] for a text that cannot be read.
    pub fn text(source: impl BufRead + 's) -> Result<Self, Refusal> {
        let source: Box<dyn BufRead + 's> = Box::new(source);
        Pieces::new(source).map(Self::Text)
    }

    /// A table whose columns have these names; those at the places `unread` are of types that are not read, so that
    /// only a mapping that names one asks for them.
    #[must_use]
    pub fn table(names: Vec<String>, unread: Vec<usize>, batches: Box<Batches<'s>>) -> Self {
        Self::Table { names, unread, batches, rows: 0 }
    }

    /// The beginning of its text, of a table as comma-separated text: about this many bytes, in whole lines.
    ///
    /// # Errors
    /// [`Refusal`] for what cannot be read.
    pub fn beginning(mut self, most_bytes: usize) -> Result<Vec<u8>, Refusal> {
        let (names, wanted) = match self {
            Self::Text(pieces) => return pieces.beginning(most_bytes),
            Self::Table { ref names, ref unread, .. } => {
                let is_read = |place: &usize| !unread.contains(place);
                (names, (0..names.len()).filter(is_read).collect::<Vec<_>>())
            }
        };
        let (mut text, columns) = (line_of_names(names), names.len());
        while text.len() < most_bytes
            && let Some(batch) = self.next_batch(&wanted)?
        {
            text.push_str(&batch.to_text(columns));
        }
        Ok(text.into_bytes())
    }

    /// Begins to read it with a mapping.
    ///
    /// # Errors
    /// [`Refusal`] for a recording without the columns that the mapping needs.
    pub fn begin(&mut self, mapping: &Mapping, file_name: Option<&str>) -> Result<Stream, Refusal> {
        match self {
            Self::Text(pieces) => Stream::begin(mapping, pieces, file_name),
            Self::Table { names, .. } => Stream::begin_table(mapping, names, file_name),
        }
    }

    /// The next piece of rows; `None` after the last.
    ///
    /// # Errors
    /// [`Refusal`] for what cannot be read.
    pub fn next_piece(&mut self, stream: &mut Stream) -> Result<Option<Piece>, Refusal> {
        match self {
            Self::Text(pieces) => stream.next_piece(pieces),
            Self::Table { .. } => {
                let needed = stream.needed();
                Ok(self.next_batch(&needed)?.map(Piece::from))
            }
        }
    }

    fn next_batch(&mut self, wanted: &[usize]) -> Result<Option<Batch>, Refusal> {
        let Self::Table { batches, rows, .. } = self else { return Ok(None) };
        let batch = batches(wanted).map_err(|reason| Refusal {
            line: *rows + 1,
            column: 1,
            found: Found::Rows(*rows),
            kind: RefusalKind::TableUnreadable { reason },
        })?;
        Ok(batch.map(|batch| {
            let batch = Batch { first_row: *rows, ..batch };
            *rows += batch.rows;
            batch
        }))
    }
}

impl Mapping {
    /// Reads a recording flight by flight; what is held at a time is some rows and the flights that they belong to. Gives what
    /// is to be said of it as a whole.
    ///
    /// # Errors
    /// As [`Mapping::read`]; the flights before were given.
    pub fn each(
        &self,
        source: &mut Source<'_>,
        file_name: Option<&str>,
        mut give: impl FnMut(Parsed),
    ) -> Result<Vec<flight::Finding>, Refusal> {
        let mut stream = source.begin(self, file_name)?;
        let converter = stream.converter();
        loop {
            let piece = match source.next_piece(&mut stream) {
                Ok(Some(piece)) => piece,
                Ok(None) => break,
                Err(refusal) => {
                    for flight in stream.stop() {
                        stream.count(converter.report(flight))?.into_iter().for_each(&mut give);
                    }
                    return Err(refusal);
                }
            };
            let rows = converter.rows(piece);
            let (flights, added) = stream.add(rows);
            for flight in flights {
                stream.count(converter.report(flight))?.into_iter().for_each(&mut give);
            }
            added?;
        }
        for flight in stream.finish() {
            stream.count(converter.report(flight))?.into_iter().for_each(&mut give);
        }
        stream.end()
    }
}
