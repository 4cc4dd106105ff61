//! Columns of a Parquet file that go into another one as they are: of whatever type, with whatever is in them.

use std::path::Path;

use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::column::writer::ColumnWriterImpl;
use parquet::data_type::{
    BoolType, ByteArrayType, DataType, DoubleType, FixedLenByteArrayType, FloatType, Int32Type,
    Int64Type, Int96Type,
};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedColumnWriter;
use parquet::schema::types::{ColumnDescriptor, SchemaDescriptor, TypePtr};

use super::VALUES_AT_ONCE;
use crate::parquet_batches::{SharedFile, checked, column_reader};

/// A file whose columns are copied.
pub(super) struct Given {
    file: SharedFile,
    reader: SerializedFileReader<SharedFile>,
}

/// Values of a column and their levels, in memory that is used again.
struct Chunk<T> {
    values: Vec<T>,
    definition: Vec<i16>,
    repetition: Vec<i16>,
}

impl Given {
    pub(super) fn open(path: &Path) -> Result<Self, ParquetError> {
        let file = checked(std::fs::File::open(path)?)?;
        let reader = SerializedFileReader::new(file.clone())?;
        Ok(Self { file, reader })
    }

    fn schema(&self) -> &SchemaDescriptor {
        self.reader.metadata().file_metadata().schema_descr()
    }

    /// The types of the columns, nested ones too.
    pub(super) fn fields(&self) -> &[TypePtr] {
        self.schema().root_schema().get_fields()
    }

    /// The columns of values: a nested one has several.
    pub(super) fn leaves(&self) -> impl Iterator<Item = &ColumnDescriptor> {
        self.schema().columns().iter().map(AsRef::as_ref)
    }

    /// Copies the values of one of them, from all groups of rows.
    pub(super) fn copy(
        &self,
        leaf: usize,
        to: &mut SerializedColumnWriter<'_>,
    ) -> Result<(), ParquetError> {
        let column = self.schema().column(leaf);
        for group in 0..self.reader.num_row_groups() {
            let chunk = self.reader.metadata().row_group(group).column(leaf);
            match column_reader(&self.file, chunk)? {
                ColumnReader::BoolColumnReader(from) => {
                    copy(from, to.typed::<BoolType>(), &column)?;
                }
                ColumnReader::Int32ColumnReader(from) => {
                    copy(from, to.typed::<Int32Type>(), &column)?;
                }
                ColumnReader::Int64ColumnReader(from) => {
                    copy(from, to.typed::<Int64Type>(), &column)?;
                }
                ColumnReader::Int96ColumnReader(from) => {
                    copy(from, to.typed::<Int96Type>(), &column)?;
                }
                ColumnReader::FloatColumnReader(from) => {
                    copy(from, to.typed::<FloatType>(), &column)?;
                }
                ColumnReader::DoubleColumnReader(from) => {
                    copy(from, to.typed::<DoubleType>(), &column)?;
                }
                ColumnReader::ByteArrayColumnReader(from) => {
                    copy(from, to.typed::<ByteArrayType>(), &column)?;
                }
                ColumnReader::FixedLenByteArrayColumnReader(from) => {
                    copy(from, to.typed::<FixedLenByteArrayType>(), &column)?;
                }
            }
        }
        Ok(())
    }
}

fn copy<T: DataType>(
    mut from: ColumnReaderImpl<T>,
    to: &mut ColumnWriterImpl<'_, T>,
    column: &ColumnDescriptor,
) -> Result<(), ParquetError> {
    let (is_optional, is_repeated) = (column.max_def_level() > 0, column.max_rep_level() > 0);
    let mut chunk = Chunk { values: Vec::new(), definition: Vec::new(), repetition: Vec::new() };
    loop {
        chunk.values.clear();
        chunk.definition.clear();
        chunk.repetition.clear();
        let (records, _, _) = from.read_records(
            VALUES_AT_ONCE,
            is_optional.then_some(&mut chunk.definition),
            is_repeated.then_some(&mut chunk.repetition),
            &mut chunk.values,
        )?;
        if records == 0 {
            return Ok(());
        }
        to.write_batch(
            &chunk.values,
            is_optional.then_some(&chunk.definition[..]),
            is_repeated.then_some(&chunk.repetition[..]),
        )?;
    }
}
