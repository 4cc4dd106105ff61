//! The state of law `paper`: two tables on one grid.

use std::sync::Arc;

use lut::{Grid, Table};

/// Drag coefficient and confidence λ over (lift coefficient, Mach number), on one grid; λ ≥ 1.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    drag_coefficient: Table,
    confidence: Table,
}

/// Why two tables do not make a state.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StateError {
    /// The tables are not on one grid.
    #[error("drag coefficient and confidence are on different grids")]
    GridsDiffer,
    /// A confidence is below 1.
    #[error("confidence of node {node} is {value}, below 1")]
    ConfidenceBelowOne {
        /// The node.
        node: usize,
        /// The value given.
        value: f64,
    },
}

impl State {
    /// An empty state: confidence 1 at every node.
    #[must_use]
    pub fn new(drag_coefficient: Table) -> Self {
        let mut confidence = drag_coefficient.clone(); // shares the grid
        confidence.values_mut().fill(1.0);
        Self { drag_coefficient, confidence }
    }

    /// A state that was learnt earlier.
    ///
    /// # Errors
    /// [`StateError`] where the tables are on different grids or a confidence is below 1.
    pub fn from_tables(drag_coefficient: Table, confidence: Table) -> Result<Self, StateError> {
        if drag_coefficient.grid() != confidence.grid() {
            return Err(StateError::GridsDiffer);
        }
        let below = confidence.values().iter().enumerate().find(|(_, value)| **value < 1.0);
        if let Some((node, &value)) = below {
            return Err(StateError::ConfidenceBelowOne { node, value });
        }
        Ok(Self { drag_coefficient, confidence })
    }

    /// The grid of both tables: x is the lift coefficient, y the Mach number.
    #[must_use]
    pub const fn grid(&self) -> &Arc<Grid> {
        self.drag_coefficient.grid()
    }

    /// Drag coefficients.
    #[must_use]
    pub const fn drag_coefficient(&self) -> &Table {
        &self.drag_coefficient
    }

    /// Confidences λ.
    #[must_use]
    pub const fn confidence(&self) -> &Table {
        &self.confidence
    }

    /// Both tables, drag coefficient and confidence, by value: what changes them makes a state of them again by
    /// [`Self::from_tables`].
    #[must_use]
    pub fn into_tables(self) -> (Table, Table) {
        (self.drag_coefficient, self.confidence)
    }

    pub(super) fn values_mut(&mut self) -> (&mut [f64], &mut [f64]) {
        (self.drag_coefficient.values_mut(), self.confidence.values_mut())
    }
}
