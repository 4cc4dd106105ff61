//! The columns that a report may lack.

use std::collections::BTreeMap;

use crate::column::Column;

/// A column whose samples may be unavailable one by one.
pub type OptionalColumn = Vec<Option<f64>>;

/// Optional columns by their name, in the stored unit, in the order of the format's page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OptionalColumns(BTreeMap<Column, OptionalColumn>);

impl OptionalColumns {
    /// The column; `None` where the report lacks it.
    #[must_use]
    pub fn get(&self, column: Column) -> Option<&OptionalColumn> {
        self.0.get(&column)
    }

    /// The column, to change its samples; `None` where the report lacks it.
    pub fn get_mut(&mut self, column: Column) -> Option<&mut OptionalColumn> {
        self.0.get_mut(&column)
    }

    /// Sets a column. Whether it is one of those that a report may lack is checked by
    /// [`Report::new`](crate::Report::new).
    pub fn insert(&mut self, column: Column, values: OptionalColumn) {
        self.0.insert(column, values);
    }

    /// The columns that are there.
    pub fn iter(&self) -> impl Iterator<Item = (Column, &OptionalColumn)> {
        self.0.iter().map(|(column, values)| (*column, values))
    }

    /// The columns that are there, to change their samples.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut OptionalColumn> {
        self.0.values_mut()
    }
}

impl FromIterator<(Column, OptionalColumn)> for OptionalColumns {
    fn from_iter<I: IntoIterator<Item = (Column, OptionalColumn)>>(columns: I) -> Self {
        Self(columns.into_iter().collect())
    }
}
