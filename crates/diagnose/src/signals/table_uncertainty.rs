//! What a drag table does not know.

use std::sync::Arc;

use effects::Response;
use faer::Mat;
use lut::{Grid, Outside};

use crate::math::cholesky::Cholesky;

/// Uncertainty of a drag table: a factor of the covariance of its nodes' relative errors, one row a node.
///
/// The covariance is `factor · factorᵀ`; a diagonal one (node standard deviations alone) has as many columns as nodes.
#[derive(Clone, Debug)]
pub struct TableUncertainty {
    grid: Arc<Grid>,
    rank: usize,
    factor: Vec<f64>,
}

/// Why numbers are no uncertainty of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TableUncertaintyError {
    /// Not `nodes × rank` numbers.
    #[error("{found} numbers for {nodes} nodes and rank {rank}")]
    Length {
        /// Numbers found.
        found: usize,
        /// Nodes of the grid.
        nodes: usize,
        /// Columns of the factor.
        rank: usize,
    },
    /// A matrix that is no covariance.
    #[error("the covariance of the table's nodes is not positive definite")]
    NotPositiveDefinite,
    /// A number that is not finite.
    #[error("number {index} of the factor is not finite")]
    NotFinite {
        /// Its index, from 0.
        index: usize,
    },
}

impl TableUncertainty {
    /// A factor in node order, row by row.
    ///
    /// # Errors
    /// [`TableUncertaintyError`] for a wrong length or a number that is not finite.
    pub fn new(
        grid: Arc<Grid>,
        rank: usize,
        factor: Vec<f64>,
    ) -> Result<Self, TableUncertaintyError> {
        if factor.len() != grid.nodes() * rank {
            let (found, nodes) = (factor.len(), grid.nodes());
            return Err(TableUncertaintyError::Length { found, nodes, rank });
        }
        if let Some(index) = factor.iter().position(|value| !value.is_finite()) {
            return Err(TableUncertaintyError::NotFinite { index });
        }
        Ok(Self { grid, rank, factor })
    }

    /// From the covariance of the nodes' relative errors, row by row.
    ///
    /// # Errors
    /// [`TableUncertaintyError`] for a wrong length, or numbers that are no covariance.
    pub fn from_covariance(
        grid: Arc<Grid>,
        covariance: &[Vec<f64>],
    ) -> Result<Self, TableUncertaintyError> {
        let nodes = grid.nodes();
        if covariance.len() != nodes || covariance.iter().any(|row| row.len() != nodes) {
            let found = covariance.iter().map(Vec::len).sum();
            return Err(TableUncertaintyError::Length { found, nodes, rank: nodes });
        }
        let matrix = Mat::from_fn(nodes, nodes, |row, column| covariance[row][column]);
        let factor = Cholesky::new(&matrix).ok_or(TableUncertaintyError::NotPositiveDefinite)?;
        let lower = factor.lower();
        let values = (0..nodes)
            .flat_map(|row| {
                (0..nodes).map(move |column| if column <= row { lower[(row, column)] } else { 0.0 })
            })
            .collect();
        Self::new(grid, nodes, values)
    }

    /// Number of columns of the factor.
    #[must_use]
    pub const fn rank(&self) -> usize {
        self.rank
    }

    pub(crate) const fn grid(&self) -> &Arc<Grid> {
        &self.grid
    }

    /// A node's row of the factor.
    pub(crate) fn row(&self, node: usize) -> &[f64] {
        &self.factor[node * self.rank..(node + 1) * self.rank]
    }

    /// Loadings of the prediction at a point: bilinear weights times the factor. Zero outside the grid.
    pub(crate) fn write(&self, response: &Response, into: &mut [f64]) {
        into.fill(0.0);
        let Ok(cell) = self.grid.locate(response.lift_coefficient, response.mach, Outside::Hold)
        else {
            return;
        };
        for (node, weight) in cell.nodes().into_iter().zip(cell.weights()) {
            let row = &self.factor[node * self.rank..(node + 1) * self.rank];
            for (slot, value) in into.iter_mut().zip(row) {
                *slot += weight * value;
            }
        }
    }
}
