//! Why points do not determine a surface.

use nalgebra::Vector6;

use super::{Basis, COEFFICIENTS};
use crate::SNAP;

/// Why a surface cannot be fitted.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Fewer points of positive weight than coefficients.
    #[error("{points} points with a positive weight, a surface needs 6 or more")]
    TooFewPoints {
        /// How many there are.
        points: usize,
    },
    /// A coordinate or value is not finite, or too large to square.
    #[error("point {index} is ({x}, {y}, {z}): not finite, or too large to square")]
    NotFinite {
        /// Its index, from 0.
        index: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
        /// Its value.
        z: f64,
    },
    /// A weight is negative or not finite.
    #[error("weight of point {index} is {weight}, outside 0..")]
    WeightInvalid {
        /// The point's index, from 0.
        index: usize,
        /// The value given.
        weight: f64,
    },
    /// The points leave a direction undetermined.
    #[error("rank {rank} of 6, condition number {condition_number:.1e}: {undetermined}")]
    RankDeficient {
        /// How many directions are determined.
        rank: usize,
        /// Ratio of largest to smallest singular value of the weighted design; may be infinite.
        condition_number: f64,
        /// What the points do not determine.
        undetermined: Undetermined,
    },
}

/// What points do not determine about a surface. Distinct means more than [`SNAP`] apart.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Undetermined {
    /// All points have one x.
    #[error("all points have the same x {value}")]
    SameX {
        /// That x.
        value: f64,
    },
    /// All points have one y.
    #[error("all points have the same y {value}")]
    SameY {
        /// That y.
        value: f64,
    },
    /// Too few different x.
    #[error("the points have {distinct} different x where {needed} are needed")]
    FewX {
        /// How many different x (first basis: |x|) there are.
        distinct: usize,
        /// How many the basis needs.
        needed: usize,
    },
    /// Too few different y.
    #[error("the points have {distinct} different y where {needed} are needed")]
    FewY {
        /// How many different y there are.
        distinct: usize,
        /// How many the basis needs.
        needed: usize,
    },
    /// A sum of basis functions vanishes at every point: for example when all lie on one line or conic.
    #[error(
        "adding any multiple of the coefficients {coefficients:?} changes nothing at the points"
    )]
    Combination {
        /// The coefficients of that sum, the largest of which is 1.
        coefficients: [f64; COEFFICIENTS],
    },
}

/// States what is undetermined, the simplest reason first. `null` is the direction of the smallest singular value.
pub(super) fn undetermined(
    basis: Basis,
    points: &[(f64, f64, f64, f64)],
    null: Option<&Vector6<f64>>,
) -> Undetermined {
    let weighted = || points.iter().filter(|point| point.3 > 0.0);
    let (needed_x, needed_y) = basis.distinct_needed();
    let xs = distinct(weighted().map(|point| match basis {
        Basis::SeparableQuadratic => point.0.abs(),
        Basis::FullQuadratic => point.0,
    }));
    let ys = distinct(weighted().map(|point| point.1));
    if let [value] = *ys {
        return Undetermined::SameY { value };
    }
    if let [value] = *xs {
        return Undetermined::SameX { value };
    }
    if ys.len() < needed_y {
        return Undetermined::FewY { distinct: ys.len(), needed: needed_y };
    }
    if xs.len() < needed_x {
        return Undetermined::FewX { distinct: xs.len(), needed: needed_x };
    }
    // Back to unscaled columns: the scaled column k is column k over its length.
    let mut coefficients = [0.0; COEFFICIENTS];
    if let Some(null) = null {
        for (k, coefficient) in coefficients.iter_mut().enumerate() {
            let length = weighted()
                .map(|&(x, y, _, weight)| weight * basis.row(x, y)[k].powi(2))
                .sum::<f64>()
                .sqrt();
            *coefficient = if length > 0.0 { null[k] / length } else { null[k] };
        }
        let largest = coefficients
            .iter()
            .copied()
            .fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
        if largest != 0.0 {
            for coefficient in &mut coefficients {
                *coefficient /= largest;
            }
        }
    }
    Undetermined::Combination { coefficients }
}

/// The different values, increasing.
fn distinct(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|next, kept| *next - *kept <= SNAP);
    values
}
