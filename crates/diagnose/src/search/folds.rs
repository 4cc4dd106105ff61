//! Folds of flights, for everything that is judged on flights it has not seen.

use faer::Mat;

use crate::math::gram::Gram;
use crate::thresholds::CLOSURE_FOLDS;

/// Grams of all folds but one, made when first asked for.
#[derive(Clone, Debug, Default)]
pub(crate) struct Folds {
    each: core::cell::OnceCell<Vec<Gram>>,
    sums: [core::cell::OnceCell<Gram>; CLOSURE_FOLDS],
}

/// Fold of a flight by its place in the order of flying.
pub(crate) const fn fold_of(flight: usize) -> usize {
    flight % CLOSURE_FOLDS
}

impl Folds {
    /// All flights but those of one fold; `make` makes the Gram of each.
    pub(crate) fn without(&self, fold: usize, make: impl FnOnce() -> Vec<Gram>) -> &Gram {
        self.sums[fold].get_or_init(|| {
            let each = self.each.get_or_init(make);
            let mut kept = each.iter().enumerate().filter(|(k, _)| *k != fold).map(|(_, g)| g);
            let Some(first) = kept.next() else {
                return Gram { matrix: Mat::zeros(0, 0), rows: 0.0 };
            };
            let mut sum = first.clone();
            for gram in kept {
                sum.matrix += &gram.matrix;
                sum.rows += gram.rows;
            }
            sum
        })
    }
}
