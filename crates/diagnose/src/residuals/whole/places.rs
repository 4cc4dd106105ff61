//! Where a prediction of the whole model leans on what is not in its loadings.

use effects::Response;

use crate::baseline::{Baseline, LeftOfSmooth};
use crate::signals::table_uncertainty::left_out::Weighted;

/// Where a prediction leans on what its loadings leave out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Places {
    /// Along each smooth function, lengths.
    pub(super) smooth: Vec<f64>,
    /// Nodes of the drag table, with their weights in ln fuel flow.
    pub(super) nodes: Vec<Weighted>,
    /// Variance of what was not flown: one thing wherever one flies there.
    pub(super) unflown: f64,
}

impl Places {
    /// Of a state, `left` by the terms of the smooth functions.
    pub(super) fn new(baseline: &Baseline, response: &Response, left: LeftOfSmooth) -> Self {
        let corners = baseline.table.as_ref().and_then(|table| table.corners(response));
        let of_thrust = |(node, weight): Weighted| (node, response.drag_over_thrust * weight);
        let nodes: Vec<Weighted> = corners.into_iter().flatten().map(of_thrust).collect();
        let unvisited =
            baseline.table.as_ref().map_or(0.0, |table| table.left_out_unvisited(&nodes));
        let unflown = left.beyond() + unvisited * unvisited;
        Self { smooth: baseline.places(response).collect(), nodes, unflown }
    }
}
