//! What a learnt drag table does not know, as the diagnosis takes it.

use std::sync::Arc;

use adapt::bayes::Posterior;
use diagnose::{TableUncertainty, TableUncertaintyError};

use crate::model_file::ModelFile;

/// Most nodes of a table whose full covariance is taken; beyond, the nodes' standard deviations alone.
const NODES_WITH_COVARIANCE: usize = 700;

/// What a model's table does not know; `None` by a law that does not say.
///
/// # Errors
/// A covariance that is invalid.
pub fn of_model(model: &ModelFile) -> Result<Option<TableUncertainty>, TableUncertaintyError> {
    model.posterior().map(|posterior| of_posterior(posterior, model.grid())).transpose()
}

/// What a table learnt by law `bayes` does not know.
///
/// # Errors
/// A covariance that is invalid.
pub fn of_posterior(
    posterior: &Posterior,
    grid: &Arc<lut::Grid>,
) -> Result<TableUncertainty, TableUncertaintyError> {
    let nodes = grid.nodes();
    if nodes > NODES_WITH_COVARIANCE {
        let mut factor = vec![0.0; nodes * nodes];
        for (node, deviation) in posterior.standard_deviation().iter().enumerate() {
            factor[node * nodes + node] = *deviation;
        }
        return TableUncertainty::new(Arc::clone(grid), nodes, factor);
    }
    let cells: Vec<lut::Cell> = (0..nodes)
        .filter_map(|node| {
            let (x, y) = grid.coordinates(node);
            grid.locate(x, y, lut::Outside::Hold).ok()
        })
        .collect();
    TableUncertainty::from_covariance(Arc::clone(grid), &posterior.relative_covariances(&cells))
}
