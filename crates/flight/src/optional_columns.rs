//! The columns that a report may lack.

use crate::column::Column;

/// A column whose samples may be unavailable one by one.
pub type OptionalColumn = Vec<Option<f64>>;

/// Optional columns by their name, in the stored unit, in the order of the format's page.
///
/// A sorted list: there are few, and they are looked up for every segment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OptionalColumns(Vec<(Column, OptionalColumn)>);

impl OptionalColumns {
    /// The column; `None` where the report lacks it.
    #[must_use]
    pub fn get(&self, column: Column) -> Option<&OptionalColumn> {
        self.0.iter().find(|(name, _)| *name == column).map(|(_, values)| values)
    }

    /// The column, to change its samples; `None` where the report lacks it.
    pub fn get_mut(&mut self, column: Column) -> Option<&mut OptionalColumn> {
        self.0.iter_mut().find(|(name, _)| *name == column).map(|(_, values)| values)
    }

    /// Sets a column. Whether it is one of those that a report may lack is checked by
    /// [`Report::new`](crate::Report::new).
    pub fn insert(&mut self, column: Column, values: OptionalColumn) {
        match self.0.binary_search_by_key(&column, |(name, _)| *name) {
            Ok(place) => self.0[place].1 = values,
            Err(place) => self.0.insert(place, (column, values)),
        }
    }

    /// The columns that are there.
    pub fn iter(&self) -> impl Iterator<Item = (Column, &OptionalColumn)> {
        self.0.iter().map(|(column, values)| (*column, values))
    }

    /// The columns that are there, to change their samples.
    pub fn values_mut(&mut self) -> impl Iterator<Item = &mut OptionalColumn> {
        self.0.iter_mut().map(|(_, values)| values)
    }
}

impl FromIterator<(Column, OptionalColumn)> for OptionalColumns {
    fn from_iter<I: IntoIterator<Item = (Column, OptionalColumn)>>(columns: I) -> Self {
        let mut sorted = Self::default();
        for (column, values) in columns {
            sorted.insert(column, values);
        }
        sorted
    }
}
