//! What is believed of the few columns of a channel before its flights.

use faer::Mat;

use crate::math::pivoted::Pivoted;

/// Prior covariance of the pivots by groups of columns: the one that stays, and those that scales multiply.
pub(super) struct Prior {
    /// Each of its parts, and a root of it.
    pub(super) parts: Vec<Mat<f64>>,
    pub(super) roots: Vec<Mat<f64>>,
}

impl Prior {
    /// Of columns in these groups.
    pub(super) fn of(reduction: &Pivoted, groups: &[usize]) -> Self {
        let rank = reduction.pivots.len();
        let last = groups.iter().copied().max().unwrap_or(0);
        let root = |group: usize| {
            let columns: Vec<usize> =
                (0..groups.len()).filter(|&column| groups[column] == group).collect();
            Mat::from_fn(rank, columns.len(), |k, at| reduction.transfer[(k, columns[at])])
        };
        Self::of_roots((0..=last).map(root).collect())
    }

    /// Of roots of its parts.
    pub(super) fn of_roots(roots: Vec<Mat<f64>>) -> Self {
        Self { parts: roots.iter().map(|root| root * root.transpose()).collect(), roots }
    }
}
