//! Which combinations of what tails share their flights tell anything about: the rest stays as believed and is left out, so that
//! a tail's Gram is small.

use core::ops::Range;

use faer::{Mat, Side};

use crate::math::linear::gather;
use crate::thresholds::FLEET_TOLD;

/// The columns of a design that a fleet keeps.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// One for each effect.
    pub(crate) effects: Vec<usize>,
    pub(crate) nuisance: Range<usize>,
    pub(crate) smooth: Range<usize>,
    pub(crate) residual: usize,
    /// Largest prior standard deviation of a smooth term; that of a nuisance column is 1.
    pub(crate) smooth_deviation: f64,
}

/// From the columns of a design to those that a fleet keeps: effects, orthonormal combinations of the nuisance, those of the smooth
/// discrepancy, residual. A normal prior of equal variances stays one.
#[derive(Clone, Debug)]
pub(crate) struct SharedBasis {
    map: Mat<f64>,
    nuisance: usize,
    smooth: usize,
}

impl SharedBasis {
    /// From the Gram of some flights, which all flights make `more` times as large.
    pub(crate) fn new(gram: &Mat<f64>, layout: &Layout, more: f64) -> Option<Self> {
        let block = |columns: &Range<usize>, deviation: f64| {
            let places: Vec<usize> = columns.clone().collect();
            told(&gather(gram, &places, &places), more * deviation * deviation)
        };
        let nuisance = block(&layout.nuisance, 1.0)?;
        let smooth = block(&layout.smooth, layout.smooth_deviation)?;
        let effects = layout.effects.len();
        let columns = effects + nuisance.ncols() + smooth.ncols() + 1;
        let mut map = Mat::<f64>::zeros(gram.ncols(), columns);
        for (place, &column) in layout.effects.iter().enumerate() {
            map[(column, place)] = 1.0;
        }
        let mut first = effects;
        for (range, vectors) in [(&layout.nuisance, &nuisance), (&layout.smooth, &smooth)] {
            map.submatrix_mut(range.start, first, vectors.nrows(), vectors.ncols())
                .copy_from(vectors);
            first += vectors.ncols();
        }
        map[(layout.residual, columns - 1)] = 1.0;
        Some(Self { map, nuisance: nuisance.ncols(), smooth: smooth.ncols() })
    }

    /// How many combinations of the nuisance, and of the smooth discrepancy, are kept.
    pub(crate) const fn columns(&self) -> [usize; 2] {
        [self.nuisance, self.smooth]
    }

    /// Rows over the columns that are kept.
    pub(crate) fn project(&self, rows: &Mat<f64>) -> Mat<f64> {
        rows * &self.map
    }
}

/// Eigenvectors along which the flights divide the prior's variance by more than a trifle.
fn told(gram: &Mat<f64>, weight: f64) -> Option<Mat<f64>> {
    if gram.ncols() == 0 {
        return Some(Mat::zeros(0, 0));
    }
    let eigen = gram.self_adjoint_eigen(Side::Lower).ok()?;
    let values = eigen.S().column_vector();
    let kept: Vec<usize> = (0..gram.ncols()).filter(|&k| values[k] * weight > FLEET_TOLD).collect();
    let vectors = eigen.U();
    Some(Mat::from_fn(gram.ncols(), kept.len(), |row, place| vectors[(row, kept[place])]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::eliminate::integrate_out;
    use crate::math::random::RandomStream;

    /// Dense algebra as oracle: what integrating the combinations out leaves of effects and residual is what integrating all
    /// columns out leaves, but for what was not told.
    #[test]
    fn what_is_not_told_changes_nothing() {
        let (effects, nuisance, smooth, rows) = (2, 6, 5, 40);
        let columns = effects + nuisance + smooth + 1;
        let mut random = RandomStream::new(5, 0);
        let mut drawn = Mat::<f64>::zeros(rows, columns);
        for column in 0..columns {
            random.fill(drawn.col_as_slice_mut(column));
        }
        // Two nuisance columns that are one, one that no flight tells of.
        for row in 0..rows {
            drawn[(row, effects + 1)] = drawn[(row, effects)];
            drawn[(row, effects + 2)] = 0.0;
        }
        let gram = drawn.transpose() * &drawn;
        let layout = Layout {
            effects: vec![0, 1],
            nuisance: effects..effects + nuisance,
            smooth: effects + nuisance..columns - 1,
            residual: columns - 1,
            smooth_deviation: 0.3,
        };
        let basis = SharedBasis::new(&gram, &layout, 1.0).unwrap();
        assert_eq!(basis.columns(), [nuisance - 2, smooth]);
        let projected = basis.project(&drawn);
        let small = projected.transpose() * &projected;
        let shared: Vec<usize> = (effects..columns - 1).collect();
        let deviations = |of: [usize; 2]| [vec![1.0; of[0]], vec![0.3; of[1]]].concat();
        let kept = |last: usize| vec![0, 1, last];
        let out: Vec<usize> = (effects..small.ncols() - 1).collect();
        let left =
            integrate_out(&small, &kept(small.ncols() - 1), &out, &deviations(basis.columns()))
                .unwrap();
        let all =
            integrate_out(&gram, &kept(columns - 1), &shared, &deviations([nuisance, smooth]))
                .unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let error = (left.matrix[(i, j)] - all.matrix[(i, j)]).abs();
                assert!(
                    error < 1e-9 * all.matrix[(i, i)].max(all.matrix[(j, j)]),
                    "{i} {j} {error}"
                );
            }
        }
        assert!((left.ln_determinant - all.ln_determinant).abs() < 1e-9);
    }
}
