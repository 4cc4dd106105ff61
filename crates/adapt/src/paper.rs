//! Law `paper`: the published local adaptation, Ghazi et al. 2020, equations (24)–(28).
//!
//! A segment whose fuel-flow error exceeds a threshold pulls the drag coefficients of its cell's four nodes towards the
//! observed one; a node's confidence λ determines how much of its own value it keeps.
//!
//! Limits, as published: it gives all four nodes the drag at the *flight point*, it learns nothing inside the
//! threshold, it does not reject outliers, and its gain never falls below 1 − δ. The book's page on adaptation has the
//! sizes. One thing differs from the print: see [`WEIGHT_OF_NO_PART`].

use flight::Observation;
use lut::{Cell, Outside, OutsideGrid, Table};

mod gains;
mod state;

pub use gains::{Gains, gains};
pub use state::{State, StateError};

/// A node of at most this bilinear weight is left unchanged: the point lies on a grid line or a node, and the node had
/// no part in the prediction. Our one deviation from the printed law, which would overwrite it. Book `[adaptation.3]`.
pub const WEIGHT_OF_NO_PART: f64 = 1e-9;

/// The law and its one setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperLaw {
    threshold_percent: f64,
}

/// A threshold that is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("adaptation threshold {threshold_percent} %, outside 0.. %")]
#[non_exhaustive]
pub struct ThresholdError {
    /// The value given, %.
    pub threshold_percent: f64,
}

/// The effect of an observation on the state.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub enum Update {
    /// A number of the observation cannot be used; nothing changed.
    Unusable {
        /// Which, in the field's words and with its unit.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },
    /// The point lies outside the grid; nothing changed.
    OutsideGrid(OutsideGrid),
    /// The error does not exceed the threshold; nothing changed.
    WithinDeadBand {
        /// Fuel-flow error ε against the table before the update, %.
        error_percent: f64,
    },
    /// Nodes were adapted.
    Adapted {
        /// Fuel-flow error ε against the table before the update, %.
        error_percent: f64,
        /// The update of each of the cell's nodes, in the cell's order; `None` for one that was left unchanged.
        nodes: [Option<NodeChange>; 4],
    },
}

/// A node before and after an update.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeChange {
    /// Index in the grid.
    pub node: usize,
    /// Distance δ from the point to the node over the cell's diagonal.
    pub normalized_distance: f64,
    /// Drag coefficient before.
    pub drag_coefficient_before: f64,
    /// Drag coefficient after.
    pub drag_coefficient_after: f64,
    /// Confidence λ before.
    pub confidence_before: f64,
    /// Confidence λ after.
    pub confidence_after: f64,
}

impl PaperLaw {
    /// The law with this threshold on the magnitude of the fuel-flow error, %.
    ///
    /// # Errors
    /// [`ThresholdError`] where it is negative or not finite.
    pub fn new(threshold_percent: f64) -> Result<Self, ThresholdError> {
        if threshold_percent.is_finite() && threshold_percent >= 0.0 {
            Ok(Self { threshold_percent })
        } else {
            Err(ThresholdError { threshold_percent })
        }
    }

    /// The published threshold, 5 %.
    #[must_use]
    pub const fn ghazi_2020() -> Self {
        Self { threshold_percent: 5.0 }
    }

    /// The threshold, %.
    #[must_use]
    pub const fn threshold_percent(&self) -> f64 {
        self.threshold_percent
    }

    /// Lets the state learn from one observation, if its error exceeds the threshold (strictly).
    ///
    /// # Source
    /// Book `[adaptation.1]`–`[adaptation.6]`; Ghazi et al. 2020, equations (24)–(28).
    pub fn adapt(&self, state: &mut State, observation: &Observation) -> Update {
        if let Some((quantity, value)) = unusable(observation) {
            return Update::Unusable { quantity, value };
        }
        let (lift_coefficient, mach) = (observation.lift_coefficient, observation.mach);
        let cell = match state.grid().locate(lift_coefficient, mach, Outside::Error) {
            Ok(cell) => cell,
            Err(outside) => return Update::OutsideGrid(outside),
        };
        let error_percent = error_percent(state.drag_coefficient(), &cell, observation);
        if error_percent.abs() > self.threshold_percent {
            let nodes = pull_nodes(state, &cell, observation.drag_coefficient);
            Update::Adapted { error_percent, nodes }
        } else {
            Update::WithinDeadBand { error_percent }
        }
    }
}

impl Update {
    /// The error ε against the table before the update, %; `None` where it cannot be computed.
    #[must_use]
    pub const fn error_percent(&self) -> Option<f64> {
        match *self {
            Self::Unusable { .. } | Self::OutsideGrid(_) => None,
            Self::WithinDeadBand { error_percent } | Self::Adapted { error_percent, .. } => {
                Some(error_percent)
            }
        }
    }

    /// The nodes that changed, in the cell's order.
    pub fn changes(&self) -> impl Iterator<Item = &NodeChange> {
        let nodes: &[Option<NodeChange>] = match self {
            Self::Adapted { nodes, .. } => nodes,
            _ => &[],
        };
        nodes.iter().flatten()
    }
}

/// Fuel-flow error ε of a drag table at a located observation, %.
///
/// ```text
/// ε = 100 · (∂Wf/∂CD) · (CD_observed − CD_table)/Wf
/// ```
///
/// This is (Wf − Ŵf)/Wf, because predicted fuel flow is linear in the drag coefficient. ε > 0: the aircraft burns more
/// than the model predicts.
///
/// # Source
/// Book `[adaptation.1]`; Ghazi et al. 2020, equations (22)–(24).
#[must_use]
#[inline]
pub fn error_percent(drag_coefficient: &Table, cell: &Cell, observation: &Observation) -> f64 {
    error_percent_of(drag_coefficient.interpolate(cell), observation)
}

/// The same of a drag coefficient that was read from a table otherwise.
#[must_use]
#[inline]
pub fn error_percent_of(drag_coefficient: f64, observation: &Observation) -> f64 {
    let excess = observation.drag_coefficient - drag_coefficient;
    100.0 * observation.fuel_flow_per_drag_coefficient_kg_s * excess
        / observation.fuel_flow_total_kg_s
}

/// Applies (27), then (28), to the nodes that took part in the prediction.
fn pull_nodes(state: &mut State, cell: &Cell, observed: f64) -> [Option<NodeChange>; 4] {
    let (nodes, weights) = (cell.nodes(), cell.weights());
    let distances = cell.normalized_distances();
    let (drag_coefficient, confidence) = state.values_mut();
    let mut changes = [None; 4];
    for (k, change) in changes.iter_mut().enumerate() {
        if weights[k] <= WEIGHT_OF_NO_PART {
            continue;
        }
        let (node, normalized_distance) = (nodes[k], distances[k]);
        let drag_coefficient_before = drag_coefficient[node];
        let confidence_before = confidence[node];
        let Gains { keep, adopt } = gains(normalized_distance, confidence_before);
        let drag_coefficient_after = keep * drag_coefficient_before + adopt * observed;
        let confidence_after = confidence_before + (1.0 - normalized_distance);
        drag_coefficient[node] = drag_coefficient_after;
        confidence[node] = confidence_after;
        *change = Some(NodeChange {
            node,
            normalized_distance,
            drag_coefficient_before,
            drag_coefficient_after,
            confidence_before,
            confidence_after,
        });
    }
    changes
}

/// The first number that prevents computing an error.
fn unusable(observation: &Observation) -> Option<(&'static str, f64)> {
    let finite = [
        ("lift coefficient", observation.lift_coefficient),
        ("Mach number", observation.mach),
        ("observed drag coefficient", observation.drag_coefficient),
    ];
    let positive = [
        ("total fuel flow, kg/s", observation.fuel_flow_total_kg_s),
        ("fuel flow per drag coefficient, kg/s", observation.fuel_flow_per_drag_coefficient_kg_s),
    ];
    let not_finite = finite.into_iter().find(|(_, value)| !value.is_finite());
    not_finite
        .or_else(|| positive.into_iter().find(|(_, value)| !(value.is_finite() && *value > 0.0)))
}
