//! Backgrounds: small matrices over the library's columns from which nuisance, a smooth discrepancy and small amounts of every effect
//! were integrated out.
//!
//! Difficult: refinement changes two columns and the residual and wants every background again. What is integrated out is
//! not touched by that but for the small amounts, so that the changed columns follow through what was factored once.

use faer::Mat;

use crate::hypotheses::design::Design;
use crate::library::Library;
use crate::math::eliminate::{Changed, Elimination, Reduced, integrate_out};
use crate::priors::{BACKGROUND_SPIKES, SMOOTH_AMPLITUDES};

/// A background: Gram of the effects' columns, product with the residual, square of the residual.
#[derive(Clone, Debug)]
pub(crate) struct Background {
    pub(crate) small_effects_scale: f64,
    pub(crate) smooth_amplitude: f64,
    /// Which level of scatter between flights.
    pub(crate) scatter: usize,
    /// Where each column of the library lies in `gram`.
    places: Vec<usize>,
    width: usize,
    gram: Vec<f64>,
    product: Vec<f64>,
    pub(crate) square: f64,
    pub(crate) ln_determinant: f64,
}

/// A background of single columns: no products between columns.
#[derive(Clone, Debug)]
pub(crate) struct Diagonal {
    pub(crate) gram: Vec<f64>,
    pub(crate) product: Vec<f64>,
    pub(crate) square: f64,
    pub(crate) ln_determinant: f64,
}

/// A Gram over the library's columns and the residual, smooth discrepancy of one amplitude integrated out.
#[derive(Debug)]
pub(crate) struct Smoothed {
    smooth_amplitude: f64,
    scatter: usize,
    matrix: Mat<f64>,
    ln_determinant: f64,
    elimination: Elimination,
}

impl Background {
    /// A background in which only some columns are known: those of `own`, with the residual last in `matrix`.
    pub(crate) fn small(
        matrix: &faer::Mat<f64>,
        own: &[usize],
        columns: usize,
        ln_determinant: f64,
    ) -> Self {
        let last = own.len();
        let mut at = Self {
            small_effects_scale: 0.0,
            smooth_amplitude: 0.0,
            scatter: 0,
            places: vec![usize::MAX; columns],
            width: last,
            gram: Vec::with_capacity(last * last),
            product: Vec::with_capacity(last),
            square: matrix[(last, last)],
            ln_determinant,
        };
        for (place, &column) in own.iter().enumerate() {
            at.places[column] = place;
            at.product.push(matrix[(place, last)]);
            for other in 0..last {
                at.gram.push(matrix[(place, other)]);
            }
        }
        at
    }

    pub(crate) fn gram(&self, a: usize, b: usize) -> f64 {
        self.gram[self.places[a] * self.width + self.places[b]]
    }

    pub(crate) fn product(&self, column: usize) -> f64 {
        self.product[self.places[column]]
    }
}

/// Integrates nuisance out of a Gram over a design's columns, smooth terms included or not; the residual is the last: what is
/// left are effects, smooth background, smooth terms and residual.
pub(crate) fn without_nuisance(
    gram: &Mat<f64>,
    design: &Design<'_>,
) -> Option<(Elimination, Reduced)> {
    let kept = (0..design.effects).chain(design.smooth.start..gram.ncols()).collect();
    let out: Vec<usize> = design.nuisance.clone().collect();
    let deviations = vec![1.0; out.len()];
    Elimination::new(gram, kept, out, deviations)
}

/// Every smooth discrepancy that is admitted at every level of scatter between flights, from Grams without nuisance whose
/// columns are effects, smooth background, …, residual.
pub(crate) fn smoothed(
    levels: &[Reduced],
    effects: usize,
    smooth: usize,
    admits: impl Fn(f64) -> bool,
) -> Vec<Smoothed> {
    let mut all = Vec::new();
    for (scatter, reduced) in levels.iter().enumerate() {
        let residual = reduced.matrix.ncols() - 1;
        for smooth_amplitude in
            SMOOTH_AMPLITUDES.into_iter().filter(|&smooth_amplitude| admits(smooth_amplitude))
        {
            let kept: Vec<usize> = (0..effects).chain([residual]).collect();
            let out: Vec<usize> =
                if smooth_amplitude > 0.0 { (effects..effects + smooth).collect() } else { vec![] };
            let deviations = vec![smooth_amplitude; out.len()];
            let found = Elimination::new(&reduced.matrix, kept, out, deviations);
            let Some((elimination, left)) = found else { continue };
            let ln_determinant = reduced.ln_determinant + left.ln_determinant;
            all.push(Smoothed {
                smooth_amplitude,
                scatter,
                matrix: left.matrix,
                ln_determinant,
                elimination,
            });
        }
    }
    all
}

/// Every background: every scale of small effects over every smooth discrepancy.
pub(crate) fn backgrounds(smoothed: &[Smoothed], library: &Library) -> Vec<Background> {
    let effects = library.columns.len();
    let mut all = Vec::with_capacity(BACKGROUND_SPIKES.len() * smoothed.len());
    for (under, small_effects_scale) in smoothed
        .iter()
        .flat_map(|under| BACKGROUND_SPIKES.map(|small_effects_scale| (under, small_effects_scale)))
    {
        let (out, deviations) = small_effects(library, small_effects_scale);
        let kept: Vec<usize> = (0..=effects).collect();
        let Some(with_small_effects) = integrate_out(&under.matrix, &kept, &out, &deviations)
        else {
            continue;
        };
        let m = &with_small_effects.matrix;
        all.push(Background {
            small_effects_scale,
            smooth_amplitude: under.smooth_amplitude,
            scatter: under.scatter,
            places: (0..effects).collect(),
            width: effects,
            gram: (0..effects).flat_map(|a| m.col_as_slice(a)[..effects].iter().copied()).collect(),
            product: m.col_as_slice(effects)[..effects].to_vec(),
            square: m[(effects, effects)],
            ln_determinant: under.ln_determinant + with_small_effects.ln_determinant,
        });
    }
    all
}

/// The same for single columns.
pub(crate) fn diagonals(smoothed: &[Smoothed], library: &Library) -> Vec<Diagonal> {
    let effects = library.columns.len();
    let mut all = Vec::with_capacity(BACKGROUND_SPIKES.len() * smoothed.len());
    for (under, small_effects_scale) in smoothed
        .iter()
        .flat_map(|under| BACKGROUND_SPIKES.map(|small_effects_scale| (under, small_effects_scale)))
    {
        let (out, deviations) = small_effects(library, small_effects_scale);
        let kept: Vec<usize> = (0..=effects).collect();
        let Some(elimination) = Elimination::projection(&under.matrix, kept, out, deviations)
        else {
            continue;
        };
        let m = &under.matrix;
        let left = |a: usize, b: usize| m[(a, b)] - elimination.explained(a, b);
        all.push(Diagonal {
            gram: (0..effects).map(|column| left(column, column)).collect(),
            product: (0..effects).map(|column| left(column, effects)).collect(),
            square: left(effects, effects),
            ln_determinant: under.ln_determinant + elimination.ln_determinant(),
        });
    }
    all
}

/// Columns that small amounts of every effect take out, and its standard deviations.
pub(crate) fn small_effects(library: &Library, small_effects_scale: f64) -> (Vec<usize>, Vec<f64>) {
    if small_effects_scale == 0.0 {
        return (vec![], vec![]);
    }
    library.effects.iter().map(|e| (e.representative, small_effects_scale * e.typical)).unzip()
}

impl Smoothed {
    pub(crate) fn is_of(&self, at: &Background) -> bool {
        self.smooth_amplitude.total_cmp(&at.smooth_amplitude).is_eq() && self.scatter == at.scatter
    }

    pub(crate) const fn scatter(&self) -> usize {
        self.scatter
    }

    /// Backgrounds of a few columns that changed, and the residual: `changed` has them in the order of `columns`, then the
    /// residual, in the Gram without nuisance at this level of scatter.
    pub(crate) fn changed(
        &self,
        library: &Library,
        columns: &[usize],
        changed: &Changed,
        choose: impl Fn(f64) -> bool,
    ) -> Vec<Background> {
        let effects = library.columns.len();
        let places: Vec<usize> = columns.iter().copied().chain([effects]).collect();
        let mut matrix = self.matrix.clone();
        self.elimination.follow(changed).write(&mut matrix, &places);
        let mut all = Vec::with_capacity(BACKGROUND_SPIKES.len());
        for small_effects_scale in
            BACKGROUND_SPIKES.into_iter().filter(|&small_effects_scale| choose(small_effects_scale))
        {
            let (out, deviations) = small_effects(library, small_effects_scale);
            let Some(with_small_effects) = integrate_out(&matrix, &places, &out, &deviations)
            else {
                continue;
            };
            let ln_determinant = self.ln_determinant + with_small_effects.ln_determinant;
            let at =
                Background::small(&with_small_effects.matrix, columns, effects, ln_determinant);
            all.push(Background {
                small_effects_scale,
                smooth_amplitude: self.smooth_amplitude,
                scatter: self.scatter,
                ..at
            });
        }
        all
    }
}
