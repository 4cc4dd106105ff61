//! Variances at many points of the table: what depends on the cell alone is computed once.

use flight::ObservationVariance;
use lut::Cell;

use super::Posterior;

/// [`Posterior::segment_variance`] for many points.
#[derive(Clone, Debug)]
pub struct VarianceByCell<'p> {
    posterior: &'p Posterior,
    /// For each lowest node of a cell, covariances of drag at its corners relative to nothing (initial drag times relative
    /// covariance times initial drag), the lower triangle row by row, off the diagonal twice. Zeros where a node is the lowest
    /// of no cell. None at all where corrections live on fewer nodes than the table's.
    covariances: Vec<[f64; 10]>,
}

impl<'p> VarianceByCell<'p> {
    pub(super) fn new(posterior: &'p Posterior) -> Self {
        if posterior.support.is_thinned() {
            return Self { posterior, covariances: vec![] };
        }
        let initial = &posterior.initial;
        let (rows, columns) = (initial.grid().x().len(), initial.grid().y().len());
        let mut covariances = vec![[0.0; 10]; rows * columns];
        for row in 0..rows - 1 {
            for column in 0..columns - 1 {
                let low = row * columns + column;
                let nodes = [low, low + 1, low + columns, low + columns + 1];
                let mut entries = (0..4).flat_map(|k| (0..=k).map(move |other| (k, other)));
                covariances[low] = [(); 10].map(|()| {
                    let Some((k, other)) = entries.next() else { return 0.0 };
                    let (node, other_node) = (nodes[k], nodes[other]);
                    let times = if k == other { 1.0 } else { 2.0 };
                    times
                        * initial.value_at_node(node)
                        * initial.value_at_node(other_node)
                        * posterior.inverse.entry(node, other_node)
                });
            }
        }
        Self { posterior, covariances }
    }

    /// As [`Posterior::segment_variance`], within rounding.
    ///
    /// # Panics
    /// Where the cell is of a larger grid.
    #[must_use]
    #[inline]
    pub fn segment_variance(&self, cell: &Cell, of_sensors: &ObservationVariance) -> f64 {
        if self.covariances.is_empty() {
            return self.posterior.segment_variance(cell, of_sensors);
        }
        let drag = self.posterior.initial.interpolate(cell);
        let [a, b, c, d] = cell.weights();
        let [aa, ba, bb, ca, cb, cc, da, db, dc, dd] = self.covariances[cell.nodes()[0]];
        let of_drag = a * a * aa
            + b * (a * ba + b * bb)
            + c * (a * ca + b * cb + c * cc)
            + d * (a * da + b * db + c * dc + d * dd);
        of_drag / (drag * drag)
            + self.posterior.settings.flight_variance(of_sensors)
            + self.posterior.settings.segment_variance(of_sensors)
    }
}
