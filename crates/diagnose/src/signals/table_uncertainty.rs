//! What a drag table does not know.

pub(crate) mod left_out;

use std::sync::Arc;

use effects::{EffectModel, EffectPoint, ExtendedModel, Response};
use faer::Mat;
use lut::{Cell, Grid, Outside, SmoothCell};

use crate::math::cholesky::Cholesky;
use crate::signals::record::FlightRecord;
use crate::signals::references::{DiagnoseError, references_of};

/// Most columns of a factor that is made of single columns of a covariance. Every one is a column of nuisance; our choice.
const MAXIMUM_RANK: usize = 700;
/// Most numbers of such a factor: 128 MB.
const MAXIMUM_NUMBERS: usize = 16_000_000;
/// Share of a node's variance that may be left out: 3 % of its standard deviation.
const NEGLIGIBLE_SHARE: f64 = 1e-3;

/// Where the uncertainty of a drag table comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableOrigin {
    /// A guide, before any flight: what is believed of its drag. It may be right as it is.
    Book,
    /// What flights have left open.
    Learnt,
}

/// Uncertainty of a drag table: a factor of the covariance of its nodes' relative errors, one row per node.
///
/// The covariance is `factor · factorᵀ`; a diagonal one (node standard deviations alone) has as many columns as nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct TableUncertainty {
    grid: Arc<Grid>,
    origin: TableOrigin,
    rank: usize,
    factor: Vec<f64>,
    /// Largest share of a visited node's variance that the factor leaves out; `None` where it has all nodes.
    missing_share: Option<f64>,
    /// Nodes whose columns of the covariance the factor is made of, in order; none where it has all nodes.
    pivots: Vec<usize>,
    /// Variance of each node that the factor leaves out; none where it has all nodes.
    left: Vec<f64>,
    /// Masses and levels of the guide that was believed, where they are known.
    guide: Option<GuideStates>,
}

/// Masses and levels of a guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuideStates {
    /// Smallest and largest mass, kg.
    pub masses_kg: (f64, f64),
    /// Lowest and highest pressure altitude, m.
    pub pressure_altitudes_m: (f64, f64),
}

/// Why numbers are not the uncertainty of a table.
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
    /// A matrix that is not a covariance.
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
        Ok(Self {
            grid,
            origin: TableOrigin::Learnt,
            rank,
            factor,
            missing_share: None,
            pivots: vec![],
            left: vec![],
            guide: None,
        })
    }

    /// From the covariance of the nodes' relative errors, row by row.
    ///
    /// # Errors
    /// [`TableUncertaintyError`] for a wrong length, or numbers that are not a covariance.
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

    /// From columns of the covariance, where a grid has too many nodes for all of it at once: a Cholesky factor whose pivots
    /// are nodes that the flights at hand visit.
    ///
    /// ```text
    /// ℓ = (C_·p − Σ_k L_·k L_pk)/√v_p,   v ← v − ℓ²,   p the visited node with the largest variance v left
    /// ```
    ///
    /// It ends when every visited node has at most a thousandth of its variance left (a smooth table needs far fewer columns
    /// than nodes), or at the largest rank; [`missing_share`](Self::missing_share) is what is left out. Of nodes that nobody
    /// visits it has the part that they share with visited ones.
    ///
    /// # Source
    /// Harbrecht, Peters and Schneider 2012, doi 10.1016/j.apnum.2011.10.001: the pivoted Cholesky decomposition.
    ///
    /// # Errors
    /// [`TableUncertaintyError`] for a wrong length or a number that is not finite.
    pub fn from_columns(
        grid: Arc<Grid>,
        visited: &[usize],
        variances: &[f64],
        mut column: impl FnMut(usize) -> Vec<f64>,
    ) -> Result<Self, TableUncertaintyError> {
        let nodes = grid.nodes();
        if variances.len() != nodes {
            return Err(TableUncertaintyError::Length { found: variances.len(), nodes, rank: 1 });
        }
        let largest_rank = MAXIMUM_RANK.min(MAXIMUM_NUMBERS / nodes.max(1)).max(1);
        let mut left = variances.to_vec();
        let mut columns: Vec<Vec<f64>> = Vec::new();
        let mut pivots = Vec::new();
        let share_left = |left: &[f64], node: usize| left[node] / variances[node];
        loop {
            let open =
                visited.iter().copied().filter(|&node| share_left(&left, node) > NEGLIGIBLE_SHARE);
            let Some(pivot) = open.max_by(|&a, &b| left[a].total_cmp(&left[b])) else { break };
            if columns.len() == largest_rank {
                break;
            }
            let mut next = column(pivot);
            if next.len() != nodes {
                let found = next.len();
                return Err(TableUncertaintyError::Length { found, nodes, rank: 1 });
            }
            for before in &columns {
                let by = before[pivot];
                for (value, known) in next.iter_mut().zip(before) {
                    *value -= by * known;
                }
            }
            let root = left[pivot].sqrt();
            for (value, left) in next.iter_mut().zip(&mut left) {
                *value /= root;
                *left = (*left - *value * *value).max(0.0);
            }
            left[pivot] = 0.0;
            columns.push(next);
            pivots.push(pivot);
        }
        let missing_share = visited.iter().map(|&node| share_left(&left, node)).fold(0.0, f64::max);
        let rank = columns.len();
        let mut factor = vec![0.0; nodes * rank];
        for (k, column) in columns.into_iter().enumerate() {
            for (node, value) in column.into_iter().enumerate() {
                factor[node * rank + k] = value;
            }
        }
        let missing_share = Some(missing_share);
        Ok(Self { missing_share, pivots, left, ..Self::new(grid, rank, factor)? })
    }

    /// The same as what is believed of a guide before any flight.
    #[must_use]
    pub fn of_book(self) -> Self {
        Self { origin: TableOrigin::Book, ..self }
    }

    /// The same of a guide of these masses and levels.
    #[must_use]
    pub fn with_guide(self, guide: Option<GuideStates>) -> Self {
        Self { guide, ..self }
    }

    /// The guide's masses and levels, where they are known.
    pub(crate) const fn guide(&self) -> Option<GuideStates> {
        self.guide
    }

    /// Where it comes from.
    #[must_use]
    pub const fn origin(&self) -> TableOrigin {
        self.origin
    }

    /// Largest share of a visited node's variance that the columns leave out; `None` where the covariance of all nodes is
    /// kept.
    #[must_use]
    pub const fn missing_share(&self) -> Option<f64> {
        self.missing_share
    }

    /// The nodes that [`from_columns`](Self::from_columns) chose, in the order in which it chose them; of these alone it
    /// makes the same factor again.
    #[must_use]
    pub fn pivots(&self) -> &[usize] {
        &self.pivots
    }

    /// Covariance of two nodes' relative errors.
    ///
    /// # Panics
    /// A node that the grid does not have.
    #[must_use]
    pub fn covariance(&self, node: usize, other: usize) -> f64 {
        self.row(node).iter().zip(self.row(other)).map(|(a, b)| a * b).sum()
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
        for (slot, loading) in into.iter_mut().zip(self.loadings(&cell)) {
            *slot = loading;
        }
    }

    /// The same with the weights of the smooth surface through the nodes.
    pub(crate) fn write_smooth(&self, response: &Response, into: &mut [f64]) {
        into.fill(0.0);
        let Ok(cell) = SmoothCell::locate(&self.grid, response.lift_coefficient, response.mach)
        else {
            return;
        };
        for (node, weight) in cell.parts() {
            for (slot, loading) in into.iter_mut().zip(self.row(node)) {
                *slot += weight * loading;
            }
        }
    }

    /// The same of a cell of its grid, one after the other.
    pub(crate) fn loadings(&self, cell: &Cell) -> impl Iterator<Item = f64> {
        let [a, b, c, d] = cell.weights();
        let [p, q, r, s] = cell.nodes().map(|node| self.row(node));
        let rows = p.iter().zip(q).zip(r).zip(s);
        rows.map(move |(((p, q), r), s)| a * p + b * q + c * r + d * s)
    }

    /// Standard deviation of each node that the factor leaves out; none where it has all nodes.
    pub(crate) fn left_deviations(&self) -> Vec<f64> {
        self.left.iter().map(|left| left.sqrt()).collect()
    }
}

/// Nodes of the drag table that flights visit: corners of the cells that their segments lie in, ascending.
///
/// # Errors
/// [`DiagnoseError::Model`] where nothing is inside the drag table.
pub fn visited_nodes(
    model: &ExtendedModel,
    drag_table: &lut::Table,
    flights: &[FlightRecord<'_>],
) -> Result<Vec<usize>, DiagnoseError> {
    let references = references_of(model, drag_table, flights)?;
    let effects = EffectModel::new(model, drag_table, references)?;
    let engines = model.aircraft().engines();
    let nodes: std::collections::BTreeSet<usize> = flights
        .iter()
        .flat_map(|flight| flight.segments)
        .filter_map(|segment| {
            let means = effects.corrected_means(&segment.means).ok()?;
            let point = EffectPoint::from_means(&means, segment.identity.start_s(), engines);
            let (_, response) = effects.known_point(&point).ok()?;
            let (lift, mach) = (response.lift_coefficient, response.mach);
            Some(drag_table.grid().locate(lift, mach, Outside::Hold).ok()?.nodes())
        })
        .flatten()
        .collect();
    Ok(nodes.into_iter().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lut::Axis;

    fn grid(x: usize, y: usize) -> Arc<Grid> {
        let axis = |count: usize| Axis::new((0..count).map(|k| k as f64).collect()).unwrap();
        Arc::new(Grid::new(axis(x), axis(y)))
    }

    /// A smooth covariance: likeness falls with the distance of two nodes.
    fn covariance(columns: usize, a: usize, b: usize) -> f64 {
        let at = |node: usize| ((node / columns) as f64, (node % columns) as f64);
        let ((x, y), (u, v)) = (at(a), at(b));
        let own = |node: usize| 0.01 * (1.0 + 0.1 * (node % 3) as f64);
        own(a) * own(b) * (-((x - u).powi(2) + (y - v).powi(2)) / 8.0).exp()
            + if a == b { 1e-7 } else { 0.0 }
    }

    #[test]
    fn columns_of_visited_nodes_have_their_covariance() {
        let (rows, columns) = (6, 5);
        let nodes = rows * columns;
        let dense: Vec<Vec<f64>> =
            (0..nodes).map(|a| (0..nodes).map(|b| covariance(columns, a, b)).collect()).collect();
        let whole = TableUncertainty::from_covariance(grid(rows, columns), &dense).unwrap();
        assert_eq!(whole.missing_share(), None);
        let visited = [6, 7, 11, 12, 8, 13, 23];
        let variances: Vec<f64> = (0..nodes).map(|node| dense[node][node]).collect();
        let some =
            TableUncertainty::from_columns(grid(rows, columns), &visited, &variances, |node| {
                dense[node].clone()
            })
            .unwrap();
        assert!(some.rank() <= visited.len());
        for a in visited {
            for b in visited {
                let (found, known) = (some.covariance(a, b), whole.covariance(a, b));
                let scale = (variances[a] * variances[b]).sqrt();
                assert!((found - known).abs() <= NEGLIGIBLE_SHARE * scale, "{a} {b}");
            }
        }
        // Elsewhere it never has more than there is.
        for (node, variance) in variances.iter().enumerate() {
            assert!(some.covariance(node, node) <= variance * (1.0 + 1e-12));
        }
        assert!(some.missing_share().is_some());
        assert_eq!(some.grid().nodes(), 30);
    }

    /// A legal table of 300 × 300 nodes, of which a hundred are visited: no square matrix of all nodes is ever made.
    #[test]
    fn a_large_table_has_an_uncertainty() {
        let side = 300;
        let nodes = side * side;
        let visited: Vec<usize> = (0..100).map(|k| (100 + k / 10) * side + 150 + k % 10).collect();
        let variances: Vec<f64> = (0..nodes).map(|node| covariance(side, node, node)).collect();
        let found =
            TableUncertainty::from_columns(grid(side, side), &visited, &variances, |node| {
                (0..nodes).map(|other| covariance(side, node, other)).collect()
            })
            .unwrap();
        assert!(found.rank() <= 100, "{}", found.rank());
        for node in visited {
            assert!(
                (found.covariance(node, node) / variances[node] - 1.0).abs() <= NEGLIGIBLE_SHARE
            );
        }
    }
}
