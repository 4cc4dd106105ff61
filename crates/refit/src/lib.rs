//! Global adaptation of a drag table: what was learnt at the visited nodes, carried to all others by a polynomial.
//!
//! What it is not: it does not decide when to refit (the method does so after each flight), does not observe, and does
//! not judge whether the polynomial is plausible as an aircraft's drag.
//!
//! The one design decision: the share of adapted nodes is a fraction of whole numbers, so that "more than 30 %" means
//! `10·n > 3·N` to the node, on every machine.
//!
//! Limits, as published: nodes that were never adapted enter the fit with their old values and full weight, and so hold
//! back what the others have learnt; adapted nodes keep their values, which leaves a step at the border; setting every
//! confidence to 1 discards how often a node was visited. The book's page on adaptation has the sizes.
//!
//! ```
//! use std::sync::Arc;
//! use lut::{Axis, Grid, Table, surface::Basis};
//! use refit::{RefitRule, refit};
//!
//! let grid = Arc::new(Grid::new(Axis::from_step(0.3, 0.6, 0.1)?, Axis::from_step(0.6, 0.8, 0.1)?));
//! let mut drag_coefficient = Table::new(Arc::clone(&grid), vec![0.030; 12])?;
//! let mut confidence = Table::new(grid, vec![1.0; 12])?;
//! confidence.values_mut()[..3].fill(1.4); // 3 of 12 nodes: 25 %
//! let report = refit(
//!     RefitRule::ghazi_2020(),
//!     Basis::SeparableQuadratic,
//!     &mut drag_coefficient,
//!     &mut confidence,
//! )?;
//! assert!(report.fit.is_none());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use lut::Table;
use lut::surface::{self, Basis, Fit, FitError};

/// How many nodes must have been adapted before the polynomial is fitted again: more than a share of all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RefitRule {
    numerator: u32,
    denominator: u32,
}

/// An invalid share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("refit share {numerator}/{denominator}, outside 0 to 1")]
#[non_exhaustive]
pub struct ShareError {
    /// The numerator given.
    pub numerator: u32,
    /// The denominator given.
    pub denominator: u32,
}

/// The result of a refit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct RefitReport {
    /// Nodes with a confidence above 1.
    pub nodes_adapted: usize,
    /// All nodes.
    pub nodes: usize,
    /// The polynomial, where it was fitted: then every other node has its value, and every confidence is 1.
    /// `None` where too few nodes were adapted: then nothing changed.
    pub fit: Option<Fit>,
}

/// Why a refit that was due was not made. The tables are unchanged.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RefitError {
    /// The tables are not on one grid.
    #[error("drag coefficient and confidence are on different grids")]
    GridsDiffer,
    /// The nodes do not determine the polynomial.
    #[error("the table's nodes do not determine its polynomial")]
    Fit(#[from] FitError),
    /// The polynomial's value at a node is not finite.
    #[error("the polynomial's value at node {node} is {value}")]
    ValueNotFinite {
        /// The node.
        node: usize,
        /// The value.
        value: f64,
    },
}

impl RefitRule {
    /// Refit once strictly more than `numerator/denominator` of the nodes were adapted; 1/1 means never.
    ///
    /// # Errors
    /// [`ShareError`] where the share is invalid.
    pub const fn more_than(numerator: u32, denominator: u32) -> Result<Self, ShareError> {
        if denominator == 0 || numerator > denominator {
            return Err(ShareError { numerator, denominator });
        }
        Ok(Self { numerator, denominator })
    }

    /// The published share: more than 30 %.
    #[must_use]
    pub const fn ghazi_2020() -> Self {
        Self { numerator: 3, denominator: 10 }
    }

    /// Whether `nodes_adapted` of `nodes` are enough.
    #[must_use]
    pub const fn is_due(self, nodes_adapted: usize, nodes: usize) -> bool {
        self.denominator as u128 * nodes_adapted as u128 > self.numerator as u128 * nodes as u128
    }
}

impl RefitReport {
    /// Share of adapted nodes, 0 … 1.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.nodes_adapted as f64 / self.nodes as f64
    }
}

/// Fits the polynomial to all nodes and assigns its values to the nodes that were not adapted, if enough others were.
///
/// A node counts as adapted when its confidence λ exceeds 1. The fit takes every node with its present drag coefficient,
/// λ multiplying the squared residual. Nodes with λ = 1 get the polynomial's value, all others keep theirs, and every λ
/// becomes 1.
///
/// # Errors
/// [`RefitError`]; the tables are then unchanged.
///
/// # Source
/// Book `[adaptation.7]`, `[adaptation.8]`; Ghazi et al. 2020, equation (29), by QR instead of normal equations.
pub fn refit(
    rule: RefitRule,
    basis: Basis,
    drag_coefficient: &mut Table,
    confidence: &mut Table,
) -> Result<RefitReport, RefitError> {
    if drag_coefficient.grid() != confidence.grid() {
        return Err(RefitError::GridsDiffer);
    }
    let grid = drag_coefficient.grid();
    let nodes = grid.nodes();
    let nodes_adapted = confidence.values().iter().filter(|lambda| **lambda > 1.0).count();
    if !rule.is_due(nodes_adapted, nodes) {
        return Ok(RefitReport { nodes_adapted, nodes, fit: None });
    }

    let coordinates: Vec<(f64, f64)> = (0..nodes).map(|node| grid.coordinates(node)).collect();
    let points: Vec<_> = coordinates
        .iter()
        .zip(drag_coefficient.values().iter().zip(confidence.values()))
        .map(|(&(x, y), (&value, &lambda))| (x, y, value, lambda))
        .collect();
    let fit = surface::fit(basis, &points)?;
    let surface_values: Vec<f64> =
        coordinates.iter().map(|&(x, y)| fit.surface.value(x, y)).collect();
    if let Some((node, &value)) =
        surface_values.iter().enumerate().find(|(_, value)| !value.is_finite())
    {
        return Err(RefitError::ValueNotFinite { node, value });
    }

    for ((value, lambda), surface_value) in
        drag_coefficient.values_mut().iter_mut().zip(confidence.values_mut()).zip(surface_values)
    {
        if *lambda <= 1.0 {
            *value = surface_value;
        }
        *lambda = 1.0;
    }
    Ok(RefitReport { nodes_adapted, nodes, fit: Some(fit) })
}
