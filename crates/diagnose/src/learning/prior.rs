//! What is believed of the few columns of a channel before its flights.

use faer::Mat;

use crate::learning::dials::SCALES;
use crate::math::lower::Lower;
use crate::math::pivoted::Pivoted;

/// Prior covariance of the pivots by groups of columns: the one that stays, and those that scales multiply.
pub(super) struct Prior {
    /// Each of its parts, and a root of it.
    pub(super) parts: Vec<Lower>,
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

    /// Whether scales multiply anything.
    pub(super) const fn has_scales(&self) -> bool {
        self.parts.len() > 1
    }

    /// Covariance of the pivots at scales.
    pub(super) fn covariance(&self, scales: [f64; SCALES]) -> Lower {
        let mut covariance = self.parts[0].clone();
        for (part, scale) in self.parts[1..].iter().zip(scales) {
            covariance.add_share(scale * scale, part);
        }
        covariance
    }

    /// Of roots of its parts.
    pub(super) fn of_roots(roots: Vec<Mat<f64>>) -> Self {
        Self {
            parts: roots.iter().map(|root| Lower::of(&(root * root.transpose()))).collect(),
            roots,
        }
    }
}
