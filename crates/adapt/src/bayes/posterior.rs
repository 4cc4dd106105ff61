//! The result of a solve: corrections, their standard deviations, the corrected table.

use flight::ObservationVariance;
use lut::{Cell, Grid, Table};

use super::blocks::{BlockFactor, BlockMatrix, Layout, SelectedInverse};
use super::guard::{GuardReport, project};
use super::information::Information;
use super::support::Support;
use super::{BayesSettings, VarianceByCell, prior};

/// The solution: every node's correction and drag with their uncertainty, informed or not.
///
/// Standard deviations and variances are relative to the initial drag: 0.01 is 1 % of it. They are those of the table;
/// [`segment_variance`](Self::segment_variance) includes what a new flight and a new segment add.
#[derive(Clone, Debug)]
pub struct Posterior {
    pub(super) initial: Table,
    pub(super) support: Support,
    pub(super) settings: BayesSettings,
    drag: Table,
    correction: Vec<f64>,
    standard_deviation: Vec<f64>,
    observations: Vec<f64>,
    guard: Option<GuardReport>,
    factor: BlockFactor,
    pub(super) inverse: SelectedInverse,
}

/// Why there is no solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// Prior plus information is not a positive definite precision matrix.
    #[error("what was learnt is not a positive definite information matrix: the state is damaged")]
    NotPositiveDefinite,
}

impl Posterior {
    pub(super) fn new(
        initial: &Table,
        support: &Support,
        settings: BayesSettings,
        information: &Information,
    ) -> Result<Self, SolveError> {
        let factor = precision(support.grid(), &settings, information)
            .factor()
            .ok_or(SolveError::NotPositiveDefinite)?;
        let inverse = factor.selected_inverse();
        let correction = support.at_table(factor.solve(&information.vector()));
        let variances = support.variances(|node, other| inverse.entry(node, other));
        if !correction.iter().chain(&variances).all(|value| value.is_finite()) {
            return Err(SolveError::NotPositiveDefinite);
        }
        let mut drag = initial.clone();
        let mut precisions = variances.clone();
        for (node, value) in drag.values_mut().iter_mut().enumerate() {
            precisions[node] = 1.0 / (*value * *value * variances[node]);
            *value *= 1.0 + correction[node];
        }
        let guard = project(initial, drag.values_mut(), &precisions);
        Ok(Self {
            initial: initial.clone(),
            support: support.clone(),
            settings,
            drag,
            correction,
            standard_deviation: variances.into_iter().map(f64::sqrt).collect(),
            observations: support.at_table(information.observations()),
            guard,
            factor,
            inverse,
        })
    }

    /// The corrected table, physical.
    #[must_use]
    pub const fn drag(&self) -> &Table {
        &self.drag
    }

    /// The changes by which the guard kept drag physical; `None` where there were none.
    #[must_use]
    pub const fn guard(&self) -> Option<&GuardReport> {
        self.guard.as_ref()
    }

    /// Every node's correction x: drag is the initial times 1 + x. Before the guard.
    #[must_use]
    pub fn correction(&self) -> &[f64] {
        &self.correction
    }

    /// Standard deviation of every node's correction.
    #[must_use]
    pub fn standard_deviation(&self) -> &[f64] {
        &self.standard_deviation
    }

    /// Effective number of observations at every node: each counts with its bilinear weight, its outlier weight (1 at
    /// most) and its decay.
    #[must_use]
    pub fn observations(&self) -> &[f64] {
        &self.observations
    }

    /// Nodes that no observation ever touched.
    pub fn never_informed(&self) -> impl Iterator<Item = usize> {
        let empty = self.observations.iter().enumerate().filter(|(_, count)| **count <= 0.0);
        empty.map(|(node, _)| node)
    }

    /// Share of nodes with at least one effective observation.
    #[must_use]
    pub fn informed_share(&self) -> f64 {
        let informed = self.observations.iter().filter(|count| **count >= 1.0).count();
        informed as f64 / self.observations.len() as f64
    }

    /// The initial table.
    #[must_use]
    pub const fn initial(&self) -> &Table {
        &self.initial
    }

    /// The correction at a located point; before the guard.
    #[must_use]
    pub fn correction_at(&self, cell: &Cell) -> f64 {
        let (nodes, weights) = (cell.nodes(), super::coefficients(&self.initial, cell));
        nodes.iter().zip(&weights).map(|(&node, weight)| weight * self.correction[node]).sum()
    }

    /// Relative variance of the table's drag at a located point, of the initial drag there.
    ///
    /// # Source
    /// Book `[bayes.9]`.
    #[must_use]
    pub fn relative_variance(&self, cell: &Cell) -> f64 {
        let terms = self.support.terms(&self.initial, cell);
        terms.variance(|node, other| self.inverse.entry(node, other))
    }

    /// Relative variance of what a segment of a new flight will show at a located point: that of the table, of the
    /// flight's common error, and of the segment alone.
    #[must_use]
    pub fn segment_variance(&self, cell: &Cell, of_sensors: &ObservationVariance) -> f64 {
        self.relative_variance(cell)
            + self.settings.flight_variance(of_sensors)
            + self.settings.segment_variance(of_sensors)
    }

    /// The same for many points.
    #[must_use]
    pub fn variance_by_cell(&self) -> VarianceByCell<'_> {
        VarianceByCell::new(self)
    }

    /// Relative covariances of the table's drag at several located points, row by row: the errors of the table are
    /// common to points near each other.
    #[must_use]
    pub fn relative_covariances(&self, cells: &[Cell]) -> Vec<Vec<f64>> {
        let columns: Vec<Vec<(usize, f64)>> = cells
            .iter()
            .map(|cell| {
                let terms = self.support.terms(&self.initial, cell);
                terms.nodes.into_iter().zip(terms.coefficients).collect()
            })
            .collect();
        self.forms(&columns)
    }

    /// Covariances of one node's correction with every node's, in node order: a column of the inverse of the precision,
    /// by one solve.
    ///
    /// # Panics
    /// `node` is not a node of the grid.
    #[must_use]
    pub fn covariances_with(&self, node: usize) -> Vec<f64> {
        let mut unit = vec![0.0; self.support.grid().nodes()];
        for (node, value) in self.support.combination(&[(node, 1.0)]) {
            unit[node] += value;
        }
        self.support.at_table(self.factor.solve(&unit))
    }

    /// A table drawn from the distribution of what is known: what the drag may also be, given what was learnt. As many
    /// independent standard normal numbers are needed as there are nodes; the same numbers give the same table. Drag
    /// is kept physical as in [`drag`](Self::drag).
    ///
    /// # Panics
    /// Where there are fewer numbers than nodes.
    #[must_use]
    pub fn drawn(&self, standard_normal: &[f64]) -> Table {
        let nodes = self.correction.len();
        let numbers = &standard_normal[..self.support.grid().nodes()];
        let deviation = self.support.at_table(self.factor.correlate(numbers));
        let mut drag = self.initial.clone();
        let mut precisions = vec![0.0; nodes];
        for (node, value) in drag.values_mut().iter_mut().enumerate() {
            precisions[node] = (*value * self.standard_deviation[node]).powi(-2);
            *value *= 1.0 + self.correction[node] + deviation[node];
        }
        let _ = project(&self.initial, drag.values_mut(), &precisions);
        drag
    }

    /// Covariances of linear combinations of corrections at nodes of the table.
    pub(super) fn covariances_of(&self, columns: &[Vec<(usize, f64)>]) -> Vec<Vec<f64>> {
        let columns: Vec<_> = columns.iter().map(|one| self.support.combination(one)).collect();
        self.forms(&columns)
    }

    /// The same of the corrections that there are.
    fn forms(&self, columns: &[Vec<(usize, f64)>]) -> Vec<Vec<f64>> {
        let forms = self.factor.quadratic_forms(columns);
        (0..forms.nrows())
            .map(|row| (0..forms.ncols()).map(|column| forms[(row, column)]).collect())
            .collect()
    }
}

/// The precision matrix: prior and information.
pub(super) fn precision(
    grid: &Grid,
    settings: &BayesSettings,
    information: &Information,
) -> BlockMatrix {
    let (reach_x, reach_y) = information.reach(grid);
    let reach_x = reach_x.max(prior::reach(grid.x()));
    let reach_y = reach_y.max(prior::reach(grid.y()));
    let mut matrix = BlockMatrix::zeros(Layout::new(grid, reach_x, reach_y));
    prior::visit(grid, settings, |node, other, value| matrix.add(node, other, value));
    for (node, other, value) in information.entries() {
        if value != 0.0 {
            matrix.add(node, other, value);
        }
    }
    matrix
}
