//! The performance model: aircraft, drag table, and the state of a segment.

use std::sync::Arc;

use flight::{Observation, Segment};
use lut::surface::Surface;
use lut::{Cell, Cells, Grid, Outside, OutsideGrid, Table};
use units::{OutOfDomain, PressureAltitude};

use crate::Aircraft;
use crate::levels::{GuideLevels, GuidePlace};
use crate::state::SegmentState;

mod level_flight;
mod observe;
mod predict;

pub use level_flight::{LevelBlock, LevelFlights, LevelPrediction};
pub use observe::ObserveError;
pub use predict::{PredictError, Prediction, SegmentPrediction};

/// A node with a bilinear weight up to this has no part in a value: the point lies on a grid line or on a node.
/// Our choice: far above the rounding of a weight, far below any weight that moves a drag coefficient.
pub const NODE_WEIGHT_THRESHOLD: f64 = 1e-9;

/// An aircraft with a drag table over lift coefficient and Mach number.
#[derive(Clone, Debug, PartialEq)]
pub struct PerformanceModel {
    aircraft: Aircraft,
    polynomial: Surface,
    drag_table: Table,
    extrapolated: Vec<bool>,
    levels: Option<Box<GuideLevels>>,
}

/// Why parts do not make a performance model.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// A table on another grid than the aircraft's.
    #[error("the drag table is not on the grid of the aircraft file")]
    GridDiffers,
    /// The number of marks differs from the number of nodes.
    #[error("{found} marks of extrapolated nodes for {nodes} nodes")]
    ExtrapolatedLength {
        /// Marks found.
        found: usize,
        /// Nodes of the table.
        nodes: usize,
    },
    /// A coefficient of the polynomial that is not finite.
    #[error("coefficient {index} of the polynomial is {value}, not finite")]
    CoefficientNotFinite {
        /// Its index, from 0.
        index: usize,
        /// The value given.
        value: f64,
    },
    /// A node whose drag coefficient is not positive.
    #[error(
        "drag coefficient {drag_coefficient} at lift coefficient {lift_coefficient}, Mach number {mach} is not positive"
    )]
    DragNotPositive {
        /// The node's lift coefficient.
        lift_coefficient: f64,
        /// The node's Mach number.
        mach: f64,
        /// The table's value there.
        drag_coefficient: f64,
    },
}

/// A point outside the drag table. Nothing is extrapolated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "lift coefficient {:.4}, Mach number {:.4} outside the table's lift coefficients {} to {} and Mach numbers {} to {}",
    .lift_coefficient, .mach, .lift_coefficients.0, .lift_coefficients.1, .machs.0, .machs.1
)]
pub struct OutsideTable {
    /// Lift coefficient of the point.
    pub lift_coefficient: f64,
    /// Mach number of the point.
    pub mach: f64,
    /// First and last lift coefficient of the table.
    pub lift_coefficients: (f64, f64),
    /// First and last Mach number of the table.
    pub machs: (f64, f64),
}

impl PerformanceModel {
    /// A model of these parts. `extrapolated` marks the nodes that no row of the guide supports, one mark per node.
    ///
    /// # Errors
    /// [`ModelError`] where the table is not on the aircraft's grid, a drag coefficient is not positive, or lengths
    /// differ.
    pub fn new(
        aircraft: Aircraft,
        polynomial: Surface,
        drag_table: Table,
        extrapolated: Vec<bool>,
    ) -> Result<Self, ModelError> {
        let nodes = aircraft.grid().nodes();
        if extrapolated.len() != nodes {
            return Err(ModelError::ExtrapolatedLength { found: extrapolated.len(), nodes });
        }
        for (index, &value) in polynomial.coefficients.iter().enumerate() {
            if !value.is_finite() {
                return Err(ModelError::CoefficientNotFinite { index, value });
            }
        }
        check_drag_table(&aircraft, &drag_table)?;
        Ok(Self { aircraft, polynomial, drag_table, extrapolated, levels: None })
    }

    /// The same model with another drag table, for example an adapted one.
    ///
    /// # Errors
    /// [`ModelError`] where the table is not on the aircraft's grid or a drag coefficient is not positive.
    pub fn with_drag_table(&self, drag_table: Table) -> Result<Self, ModelError> {
        check_drag_table(&self.aircraft, &drag_table)?;
        Ok(Self { drag_table, ..self.clone() })
    }

    /// The same model with a factor on the drag of the table by level. Predictions have it, and an observation is without it, as the
    /// table is.
    #[must_use]
    pub fn with_levels(self, levels: GuideLevels) -> Self {
        Self { levels: Some(Box::new(levels)), ..self }
    }

    /// By how much drag differs by level from the table; `None` where it does not.
    #[must_use]
    pub fn levels(&self) -> Option<&GuideLevels> {
        self.levels.as_deref()
    }

    /// The factor on the drag of the table: 1 where drag does not differ by level.
    #[must_use]
    #[inline]
    pub fn level_factor(&self, place: GuidePlace) -> f64 {
        self.levels.as_deref().map_or(1.0, |levels| levels.factor(place))
    }

    /// What a model without levels has observed, as the table has it: without the factor.
    #[must_use]
    pub fn without_level(
        &self,
        observed: &Observation,
        pressure_altitude: PressureAltitude,
    ) -> Observation {
        let factor = self.level_factor(GuidePlace {
            lift_coefficient: observed.lift_coefficient,
            mach: observed.mach,
            pressure_altitude,
        });
        Observation {
            drag_coefficient: observed.drag_coefficient / factor,
            fuel_flow_per_drag_coefficient_kg_s: observed.fuel_flow_per_drag_coefficient_kg_s
                * factor,
            ..*observed
        }
    }

    /// The aircraft.
    #[must_use]
    pub const fn aircraft(&self) -> &Aircraft {
        &self.aircraft
    }

    /// The polynomial that was fitted to the guide.
    #[must_use]
    pub const fn polynomial(&self) -> &Surface {
        &self.polynomial
    }

    /// Drag coefficient over lift coefficient (outer) and Mach number (inner).
    #[must_use]
    pub const fn drag_table(&self) -> &Table {
        &self.drag_table
    }

    /// Nodes that no row of the guide supports, in node order.
    #[must_use]
    pub fn extrapolated(&self) -> &[bool] {
        &self.extrapolated
    }

    /// The state of a segment as recorded: every quantity that does not need the drag table.
    ///
    /// # Errors
    /// [`OutOfDomain`] as for [`SegmentState::of_means`].
    pub fn state_of(&self, segment: &Segment) -> Result<SegmentState, OutOfDomain> {
        SegmentState::of_means(&self.aircraft, &segment.means)
    }

    /// The cell of a point.
    fn locate(&self, lift_coefficient: f64, mach: f64) -> Result<Cell, OutsideTable> {
        Ok(self.aircraft.grid().locate(lift_coefficient, mach, Outside::Error)?)
    }

    /// Whether a node that the guide does not support has a part in the value at a cell's point.
    #[must_use]
    #[inline]
    pub fn uses_extrapolated(&self, cell: &Cell) -> bool {
        cell.nodes()
            .into_iter()
            .zip(cell.weights())
            .any(|(node, weight)| weight > NODE_WEIGHT_THRESHOLD && self.extrapolated[node])
    }

    /// The same at several points: whether a node that the guide does not support has a part in each value.
    #[must_use]
    #[inline]
    pub fn use_extrapolated<const N: usize>(&self, cells: &Cells<N>) -> [bool; N] {
        let mut found = [false; N];
        for (place, found) in found.iter_mut().enumerate() {
            let nodes = cells.nodes(place);
            let [a, b, c, d] = nodes;
            let is_set = &self.extrapolated;
            // The weights are asked only where they decide.
            if is_set[a] | is_set[b] | is_set[c] | is_set[d] {
                let mut weights = cells.weights(place).into_iter().zip(nodes);
                *found =
                    weights.any(|(weight, node)| weight > NODE_WEIGHT_THRESHOLD && is_set[node]);
            }
        }
        found
    }
}

impl From<OutsideGrid> for OutsideTable {
    fn from(outside: OutsideGrid) -> Self {
        Self {
            lift_coefficient: outside.x,
            mach: outside.y,
            lift_coefficients: (outside.x_first, outside.x_last),
            machs: (outside.y_first, outside.y_last),
        }
    }
}

fn check_drag_table(aircraft: &Aircraft, drag_table: &Table) -> Result<(), ModelError> {
    if !same_grid(aircraft.grid(), drag_table.grid()) {
        return Err(ModelError::GridDiffers);
    }
    for (node, &drag_coefficient) in drag_table.values().iter().enumerate() {
        // Written so that NaN is refused too: a table's values can be changed after its construction.
        if drag_coefficient.is_nan() || drag_coefficient <= 0.0 {
            let (lift_coefficient, mach) = drag_table.grid().coordinates(node);
            return Err(ModelError::DragNotPositive { lift_coefficient, mach, drag_coefficient });
        }
    }
    Ok(())
}

fn same_grid(a: &Arc<Grid>, b: &Arc<Grid>) -> bool {
    Arc::ptr_eq(a, b) || a == b
}

#[cfg(test)]
mod tests;
