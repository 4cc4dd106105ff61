//! Backgrounds: small matrices over the library's columns from which nuisance, a smooth discrepancy and small amounts of every effect
//! were integrated out.
//!
//! Difficult: refinement changes two columns and the residual and wants every background again. What is integrated out is
//! not touched by that but for the small amounts, so that the changed columns follow through what was factored once.

use faer::Mat;

use crate::hypotheses::design::Design;
use crate::library::Library;
use crate::math::eliminate::{Changed, Elimination, Reduced, integrate_out};
use crate::priors::SMOOTH_AMPLITUDES;

/// What is assumed of all flights at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    /// Scatter between flights beyond what the noise has, relative.
    pub(crate) scatter: f64,
    pub(crate) table: TableBelief,
    /// ln of its prior probability.
    pub(crate) ln_prior: f64,
}

/// What is believed of the drag table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TableBelief {
    /// Uncertain as stated.
    Uncertain,
    /// Right, whatever was stated.
    Right,
}

/// A background: Gram of the effects' columns, product with the residual, square of the residual.
#[derive(Clone, Debug)]
pub(crate) struct Background {
    pub(crate) small_effects_scale: f64,
    pub(crate) smooth_amplitude: f64,
    /// Which [`Level`].
    pub(crate) level: usize,
    /// ln of its prior probability, whatever the hypothesis.
    pub(crate) ln_prior: f64,
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
    pub(crate) ln_prior: f64,
}

/// A Gram over the library's columns and the residual, smooth discrepancy of one amplitude integrated out.
#[derive(Debug)]
pub(crate) struct Smoothed {
    smooth_amplitude: f64,
    level: usize,
    table: TableBelief,
    ln_prior: f64,
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
            level: 0,
            ln_prior: 0.0,
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
    table: TableBelief,
) -> Option<(Elimination, Reduced)> {
    let kept = (0..design.effects).chain(design.smooth.start..gram.ncols()).collect();
    let of_table = design.table_columns();
    let is_out = |column: &usize| table == TableBelief::Uncertain || !of_table.contains(column);
    let out: Vec<usize> = design.nuisance.clone().filter(is_out).collect();
    let deviations = vec![1.0; out.len()];
    Elimination::new(gram, kept, out, deviations)
}

/// Every smooth discrepancy that is admitted at every level, from Grams without nuisance whose columns are effects, smooth
/// background, …, residual.
pub(crate) fn smoothed(
    levels: &[(Level, &Reduced)],
    design: &Design<'_>,
    admits: impl Fn(f64) -> bool,
) -> Vec<Smoothed> {
    let (effects, smooth) = (design.effects, design.smooth.len());
    let amplitudes: Vec<f64> =
        SMOOTH_AMPLITUDES.into_iter().filter(|&amplitude| admits(amplitude)).collect();
    let mut all = Vec::new();
    for (level, (at, reduced)) in levels.iter().enumerate() {
        let residual = reduced.matrix.ncols() - 1;
        let ln_prior = at.ln_prior - (amplitudes.len() as f64).ln();
        for &smooth_amplitude in &amplitudes {
            let kept: Vec<usize> = (0..effects).chain([residual]).collect();
            let out: Vec<usize> =
                if smooth_amplitude > 0.0 { (effects..effects + smooth).collect() } else { vec![] };
            let deviations = vec![design.smooth_deviation(smooth_amplitude); out.len()];
            let found = Elimination::new(&reduced.matrix, kept, out, deviations);
            let Some((elimination, left)) = found else { continue };
            let ln_determinant = reduced.ln_determinant + left.ln_determinant;
            all.push(Smoothed {
                smooth_amplitude,
                level,
                table: at.table,
                ln_prior,
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
    let mut all = Vec::with_capacity(library.spikes.len() * smoothed.len());
    for (under, small_effects_scale) in
        smoothed.iter().flat_map(|under| under.spikes(library).map(move |scale| (under, scale)))
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
            level: under.level,
            ln_prior: under.ln_prior_of_each(library),
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
    let mut all = Vec::with_capacity(library.spikes.len() * smoothed.len());
    for (under, small_effects_scale) in
        smoothed.iter().flat_map(|under| under.spikes(library).map(move |scale| (under, scale)))
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
            ln_prior: under.ln_prior_of_each(library),
        });
    }
    all
}

/// Columns that small amounts of every effect take out, and its standard deviations.
pub(crate) fn small_effects(library: &Library, small_effects_scale: f64) -> (Vec<usize>, Vec<f64>) {
    if small_effects_scale == 0.0 {
        return (vec![], vec![]);
    }
    library.effects.iter().map(|e| (e.representative, small_effects_scale * e.small)).unzip()
}

impl Smoothed {
    /// The Gram over all columns of the library and the residual, the last.
    pub(crate) const fn gram(&self) -> &Mat<f64> {
        &self.matrix
    }

    /// ln of its prior probability and of the determinant of its evidence, for residuals whose variance is this.
    pub(crate) fn ln_weight(&self, noise_scale: f64) -> f64 {
        let residual = self.matrix.ncols() - 1;
        let square = self.matrix[(residual, residual)] / noise_scale;
        self.ln_prior - 0.5 * (self.ln_determinant + square)
    }

    pub(crate) fn is_of(&self, at: &Background) -> bool {
        self.smooth_amplitude.total_cmp(&at.smooth_amplitude).is_eq() && self.level == at.level
    }

    pub(crate) const fn level(&self) -> usize {
        self.level
    }

    /// ln of the prior of each background over it.
    fn ln_prior_of_each(&self, library: &Library) -> f64 {
        self.ln_prior - (self.spikes(library).count() as f64).ln()
    }

    /// Scales of the small effects over it. Large ones of drag would be a table that is off by another name.
    fn spikes(&self, library: &Library) -> impl Iterator<Item = f64> + use<> {
        let count = match self.table {
            TableBelief::Uncertain => library.spikes.len(),
            TableBelief::Right => library.spikes_of_right_table,
        };
        library.spikes.into_iter().take(count)
    }

    /// Backgrounds of a few columns that changed, and the residual: `changed` has them in the order of `columns`, then the
    /// residual, in the Gram without nuisance at this level.
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
        let mut all = Vec::with_capacity(library.spikes.len());
        for small_effects_scale in self.spikes(library).filter(|&scale| choose(scale)) {
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
                level: self.level,
                ln_prior: self.ln_prior_of_each(library),
                ..at
            });
        }
        all
    }
}
