//! The learnt state as plain numbers for a file.

use flight::Timestamp;
use lut::Table;
use serde::{Deserialize, Serialize};

use super::information::{Information, Parts};
use super::outlier_weights::{ExpectedResidual, TERMS, TRIANGLE};
use super::{BayesSettings, BayesState, InitialError};

/// What a [`BayesState`] has learnt, without grid, initial table and settings, which the model holds already.
///
/// Numbers are restored to the bit. Nodes are in ascending order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BayesStateData {
    /// Flights learnt.
    pub flights: u64,
    /// Segments learnt.
    pub segments: u64,
    /// The instant to which the numbers refer, as ISO 8601 text; `None` where nothing was learnt.
    pub newest: Option<String>,
    /// Whether nodes are those of fewer corrections than the table has nodes; absent where they are the table's.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub thinned: bool,
    /// Nodes ever touched, ascending.
    pub nodes: Vec<usize>,
    /// Information matrix over these nodes, lower triangle. Row k ends at the diagonal; entries missing at its start
    /// are 0.
    pub information: Vec<Vec<f64>>,
    /// Information vector.
    pub vector: Vec<f64>,
    /// Effective number of observations.
    pub observations: Vec<f64>,
    /// State of the outlier weights, the expected residual: 21 numbers of a triangle, 6 of a vector. The name is the
    /// file format's.
    pub judge: Vec<f64>,
}

/// Why numbers do not make a state.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StateDataError {
    /// The initial table cannot be corrected by a relative amount.
    #[error(transparent)]
    Initial(#[from] InitialError),
    /// The length of a list differs from the number of touched nodes.
    #[error("{list} of what was learnt has {found} entries, expected {expected}")]
    Length {
        /// Which list.
        list: &'static str,
        /// Its length.
        found: usize,
        /// The length it must have.
        expected: usize,
    },
    /// A row of the information matrix is longer than the triangle.
    #[error("row {row} of the information has {found} entries, outside 0 to {maximum}")]
    Row {
        /// Which row.
        row: usize,
        /// Its length.
        found: usize,
        /// The most it may have.
        maximum: usize,
    },
    /// Nodes are not ascending nodes of the grid.
    #[error("touched node {node} is out of order or not one of the grid's {nodes}")]
    Node {
        /// The node.
        node: usize,
        /// How many nodes the grid has.
        nodes: usize,
    },
    /// The nodes are those of the table, or of other corrections than this program has.
    #[error(
        "what was learnt is over other nodes than this program corrects: learn the tail anew (`cruisefit adapt --restart`)"
    )]
    OtherNodes,
    /// A number is not finite, or negative where it must not be.
    #[error("{list} of what was learnt has the value {value}")]
    Value {
        /// In which list.
        list: &'static str,
        /// The value.
        value: f64,
    },
    /// The instant is missing, unreadable, or given although nothing was learnt.
    #[error("the newest instant of what was learnt is missing or not an instant")]
    Newest,
}

impl BayesState {
    /// The learnt state, for a file.
    #[must_use]
    pub fn to_data(&self) -> BayesStateData {
        let Parts { nodes, rows, vector, observations } = self.information.to_parts();
        BayesStateData {
            flights: self.flights,
            segments: self.segments,
            newest: self.newest.map(|newest| newest.to_string()),
            thinned: self.support.is_thinned(),
            nodes,
            information: rows,
            vector,
            observations,
            judge: self
                .expected_residual
                .matrix
                .iter()
                .chain(&self.expected_residual.vector)
                .copied()
                .collect(),
        }
    }

    /// Restores a state from [`to_data`](Self::to_data), with the initial table and the settings it was learnt with.
    ///
    /// # Errors
    /// [`StateDataError`] where the data are not of this grid or damaged.
    pub fn from_data(
        initial: &Table,
        settings: BayesSettings,
        data: BayesStateData,
    ) -> Result<Self, StateDataError> {
        let mut state = Self::new(initial, settings)?;
        if data.thinned != state.support.is_thinned() {
            return Err(StateDataError::OtherNodes);
        }
        let nodes = state.support.grid().nodes();
        check(&data, nodes)?;
        state.newest = match &data.newest {
            Some(text) => Some(text.parse::<Timestamp>().map_err(|_| StateDataError::Newest)?),
            None if data.flights == 0 && data.nodes.is_empty() => None,
            None => return Err(StateDataError::Newest),
        };
        state.expected_residual = ExpectedResidual::new();
        let numbers =
            state.expected_residual.matrix.iter_mut().chain(&mut state.expected_residual.vector);
        numbers.zip(&data.judge).for_each(|(number, value)| *number = *value);
        state.flights = data.flights;
        state.segments = data.segments;
        let parts = Parts {
            nodes: data.nodes,
            rows: data.information,
            vector: data.vector,
            observations: data.observations,
        };
        state.information = Information::from_parts(nodes, &parts);
        Ok(state)
    }
}

fn check(data: &BayesStateData, nodes: usize) -> Result<(), StateDataError> {
    let touched = data.nodes.len();
    for (list, found, expected) in [
        ("information", data.information.len(), touched),
        ("vector", data.vector.len(), touched),
        ("observations", data.observations.len(), touched),
        ("judge", data.judge.len(), TRIANGLE + TERMS),
    ] {
        if found != expected {
            return Err(StateDataError::Length { list, found, expected });
        }
    }
    let mut lowest = 0;
    for &node in &data.nodes {
        if node < lowest || node >= nodes {
            return Err(StateDataError::Node { node, nodes });
        }
        lowest = node + 1;
    }
    for (row, entries) in data.information.iter().enumerate() {
        // A row without entries is a node that was touched with weight 0 only: by a segment on a grid line.
        if entries.len() > row + 1 {
            return Err(StateDataError::Row { row, found: entries.len(), maximum: row + 1 });
        }
    }
    let lists =
        [("vector", &data.vector), ("observations", &data.observations), ("judge", &data.judge)];
    let rows = data.information.iter().map(|row| ("information", row));
    for (list, values) in rows.chain(lists) {
        let negative = list == "observations";
        let bad = |value: &&f64| !value.is_finite() || negative && **value < 0.0;
        if let Some(&value) = values.iter().find(bad) {
            return Err(StateDataError::Value { list, value });
        }
    }
    Ok(())
}
