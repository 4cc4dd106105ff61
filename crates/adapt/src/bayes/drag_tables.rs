//! The corrected tables of a state on its way, without their uncertainty: one small system each.
//!
//! Flights touch few nodes of a table, and what they say of the others is the prior's. With Q the precision of the prior, Λ and
//! η the information matrix and vector over the touched nodes t:
//!
//! ```text
//! (Q + Λ) x = η      x = K_·t (1 + Λ_tt K_tt)⁻¹ η_t,   K = Q⁻¹                                      [bayes.13]
//! ```
//!
//! K is that of the prior alone, so that its columns are solved for once, however many states there are.

use faer::Mat;
use faer::linalg::solvers::Solve;
use lut::Table;

use super::guard::project;
use super::information::Information;
use super::posterior::precision;
use super::{BayesState, SolveError};

/// Tables of the states that a tail went through.
#[derive(Clone, Debug)]
pub struct DragTables {
    /// Column of each node's prior covariances; `None` of nodes that were never touched.
    columns: Vec<Option<usize>>,
    /// Prior covariances of every node with the touched ones.
    prior: Mat<f64>,
}

impl DragTables {
    /// For `last` and every state that learnt some of its flights, with its settings.
    ///
    /// # Errors
    /// [`SolveError`] where the prior is not positive definite.
    pub fn new(last: &BayesState) -> Result<Self, SolveError> {
        let grid = last.support.grid();
        let nothing = Information::new(grid.nodes());
        let factor = precision(grid, &last.settings, &nothing)
            .factor()
            .ok_or(SolveError::NotPositiveDefinite)?;
        let touched = last.information.touched();
        let mut columns = vec![None; grid.nodes()];
        for (column, &node) in touched.iter().enumerate() {
            columns[node] = Some(column);
        }
        // One by one: to the last bit a column must not depend on which other nodes are touched in the end, so that a table is
        // the same whether its flights were learnt at once or night by night.
        let mut prior = Mat::zeros(grid.nodes(), touched.len());
        let mut unit = vec![0.0; grid.nodes()];
        for (column, node) in touched.iter().enumerate() {
            unit[*node] = 1.0;
            prior.col_as_slice_mut(column).copy_from_slice(&factor.solve(&unit));
            unit[*node] = 0.0;
        }
        Ok(Self { columns, prior })
    }

    /// The table of [`Posterior::drag`](super::Posterior::drag), to rounding.
    ///
    /// # Errors
    /// As for [`BayesState::solve`].
    pub fn drag(&self, state: &BayesState) -> Result<Table, SolveError> {
        let touched = state.information.touched();
        // In the order of nodes: that of first touch is not that of a state which was stored in the meantime.
        let mut slots: Vec<usize> = (0..touched.len()).collect();
        slots.sort_unstable_by_key(|&slot| touched[slot]);
        let columns: Option<Vec<usize>> =
            slots.iter().map(|&slot| self.columns[touched[slot]]).collect();
        let found = columns.and_then(|columns| self.corrected(state, &slots, &columns));
        // How unphysical drag is mended depends on variances, and these on everything.
        found.map_or_else(|| Ok(state.solve()?.drag().clone()), Ok)
    }

    /// The table of a state that touched nodes in these slots, whose columns these are; `None` where it is not physical.
    fn corrected(&self, state: &BayesState, slots: &[usize], columns: &[usize]) -> Option<Table> {
        let nodes = state.information.touched();
        let count = slots.len();
        let among = Mat::from_fn(count, count, |row, column| {
            self.prior[(nodes[slots[row]], columns[column])]
        });
        let (matrix, vector) = state.information.of_touched();
        let matrix = Mat::from_fn(count, count, |row, column| matrix[(slots[row], slots[column])]);
        let right = Mat::from_fn(count, 1, |row, _| vector[slots[row]]);
        let mut system = &matrix * &among;
        for k in 0..count {
            system[(k, k)] += 1.0;
        }
        let weights = system.partial_piv_lu().solve(right);
        let mut correction = vec![0.0; self.prior.nrows()];
        for (k, &column) in columns.iter().enumerate() {
            for (sum, covariance) in correction.iter_mut().zip(self.prior.col_as_slice(column)) {
                *sum += weights[(k, 0)] * covariance;
            }
        }
        let mut drag = state.initial.clone();
        for (value, correction) in
            drag.values_mut().iter_mut().zip(state.support.at_table(correction))
        {
            *value *= 1.0 + correction;
        }
        let is_finite = drag.values().iter().all(|value| value.is_finite());
        let equal = vec![1.0; drag.values().len()];
        let is_physical = is_finite && project(&state.initial, drag.values_mut(), &equal).is_none();
        is_physical.then_some(drag)
    }
}
