//! Columns in which no value is missing, read faster than columns of any kind.
//!
//! The decoder writes down a level for each value of a column that may lack some, and counts them, although recorders' columns
//! nearly always lack none. Whatever is otherwise is an error here, upon which the column is read anew by the decoder.

use parquet::basic::Type as PhysicalType;
use parquet::errors::ParquetError;
use parquet::schema::types::ColumnDescriptor;
use parquet_pages::{Column, Damage, Form, Values};
use report::mapping::BatchColumn;

use super::cells::add_run;
use super::pages::{Pages, refused};
use super::{Kind, Whole, power_of_ten};

/// A column that is read so.
pub(super) struct Present {
    pages: Pages,
    column: Column,
    is_local: bool,
}

impl Present {
    /// `None` for a column of other values than numbers, instants and texts.
    pub(super) fn new(column: &ColumnDescriptor, kind: Kind, pages: Pages) -> Option<Self> {
        let form = match (kind, column.physical_type()) {
            (Kind::Number, PhysicalType::DOUBLE) => Form::Double,
            (Kind::Number, PhysicalType::FLOAT) => Form::Float,
            (Kind::Whole(Whole { is_unsigned: true, .. }), _) => return None,
            (Kind::Whole(whole), PhysicalType::INT32) => Form::Int32(power_of_ten(whole.decimals)),
            (Kind::Whole(whole), PhysicalType::INT64) => Form::Int64(power_of_ten(whole.decimals)),
            (Kind::Instant(each) | Kind::LocalTime(each), PhysicalType::INT64) => {
                Form::Nanoseconds(each)
            }
            (Kind::Text, PhysicalType::BYTE_ARRAY) => Form::Text,
            _ => return None,
        };
        let is_local = matches!(kind, Kind::LocalTime(_));
        let column = Column::new(form, column.max_def_level() > 0);
        Some(Self { pages, column, is_local })
    }

    /// The next rows.
    pub(super) fn rows(&mut self, rows: usize) -> Result<BatchColumn, ParquetError> {
        let mut values = self.column.values(rows);
        let (mut missing, mut are_finite) = (rows, true);
        while missing > 0 {
            let appended =
                self.column.append(missing, &mut values).map_err(|damage| refused(&damage))?;
            are_finite &= appended == 0 || self.column.is_finite();
            missing -= appended;
            if missing > 0 {
                let kind = self.pages.next(self.column.page())?;
                let kind = kind.ok_or_else(|| refused(&Damage::EndsEarly))?;
                self.column.begin(kind).map_err(|damage| refused(&damage))?;
            }
        }
        Ok(match values {
            Values::Numbers(numbers) if are_finite => BatchColumn::Finite(numbers),
            Values::Numbers(numbers) => BatchColumn::Numbers(numbers),
            Values::Nanoseconds(times) => {
                if self.is_local {
                    BatchColumn::LocalTimes(times)
                } else {
                    BatchColumn::Instants(times)
                }
            }
            Values::Texts(places) => {
                let mut runs = Vec::with_capacity(places.len());
                for (place, rows) in places {
                    add_run(&mut runs, self.column.text(place).unwrap_or_default(), rows);
                }
                BatchColumn::Texts(runs)
            }
        })
    }
}
