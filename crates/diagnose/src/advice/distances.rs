//! What this data can tell apart, before any residual is looked at.

use faer::Mat;

use crate::hypotheses::design::Design;
use crate::hypotheses::evidence::ScoredHypothesis;
use crate::library::Library;
use crate::library::forms::open_by_law;
use crate::math::eliminate::integrate_out;
use crate::math::gram::Gram;
use crate::priors::SMOOTH_AMPLITUDES;
use crate::thresholds::{
    DECK_MEASURED, DETECTION, FORM_DIRECTIONS, LEAST_GAIN, LEAST_GAIN_DEVIATIONS,
};

/// Distances between effects in the data at hand, nuisance integrated out.
#[derive(Clone, Debug)]
pub(crate) struct Distances {
    /// Gram over columns, without residual.
    pub(crate) gram: Mat<f64>,
    /// The same if an N2 deck were known.
    pub(crate) with_deck: Mat<f64>,
    /// Of each effect the column that stands for it: the best supported value of its hidden parameter.
    pub(crate) leading: Vec<usize>,
}

impl Distances {
    /// `leading` has one column an effect; see [`leading_columns`].
    pub(crate) fn from_gram(gram: &Gram, design: &Design<'_>, leading: Vec<usize>) -> Option<Self> {
        let kept: Vec<usize> = (0..design.effects).collect();
        let out: Vec<usize> = design.nuisance.clone().collect();
        let plain = integrate_out(&gram.matrix, &kept, &out, &vec![1.0; out.len()])?;
        // A measured deck says nothing of the rest of the nuisance. Of a baseline's coefficients, whose columns are those of
        // their covariance's Cholesky factor, it shrinks what remainder and contrasts do not explain of the deck.
        let of_deck = design.deck_columns();
        let deviation = |column| if of_deck.contains(column) { DECK_MEASURED } else { 1.0 };
        let deviations: Vec<f64> = out.iter().map(deviation).collect();
        let deck = integrate_out(&gram.matrix, &kept, &out, &deviations)?;
        const { assert!(SMOOTH_AMPLITUDES[0] == 0.0) };
        Some(Self { gram: plain.matrix, with_deck: deck.matrix, leading })
    }

    /// The column that stands for an effect.
    pub(crate) fn leading(&self, effect: usize) -> usize {
        self.leading[effect]
    }

    /// Gram of some columns, nuisance integrated out.
    pub(crate) fn gram_of(&self, columns: &[usize]) -> Mat<f64> {
        Mat::from_fn(columns.len(), columns.len(), |i, j| self.gram[(columns[i], columns[j])])
    }

    /// Information on a column: 1/√ is the standard deviation of its size.
    pub(crate) fn information(&self, column: usize) -> f64 {
        self.gram[(column, column)].max(0.0)
    }

    /// The size of an effect that would just be detected, in its unit; infinite where the data say nothing. A hidden parameter
    /// has its usual value: where nothing acts, the best supported one is that at which noise happens to look like the effect.
    pub(crate) fn smallest_detectable(&self, library: &Library, effect: usize) -> f64 {
        DETECTION / self.information(library.effects[effect].representative).sqrt()
    }

    /// By how much a squared distance of column `k` at a size from column `l` is to be divided because neither need have the form
    /// that the library gives it, over what noise leaves open.
    ///
    /// ```text
    /// d'² = d²/(1 + (φ_k² θ² G_kk + φ_l² θ_l² G_ll)/3),   θ_l = θ G_kl/G_ll                           [diagnosis.61]
    /// ```
    ///
    /// A form that is off by a share φ of its size ([`open_by_law`]) may be off in about three directions, of which the one that
    /// leads from `k` to `l` is one. However large the effects are and however many flights show them, what differs by less than
    /// that stays alike.
    pub(crate) fn form_variance(&self, library: &Library, [k, l]: [usize; 2], size: f64) -> f64 {
        let open = [k, l].map(|column| {
            let of = &library.columns[column];
            open_by_law(library.effects[of.effect].id, of.hidden)
        });
        form_variance(&self.gram, [k, l], size, open)
    }

    /// Squared distance of column `k` at a size from the best-fitting multiple of column `l`, and that multiple.
    ///
    /// ```text
    /// d²(k|l) = θ²·(G_kk − G_kl²/G_ll)                                    [diagnosis.22]
    /// ```
    pub(crate) fn squared(&self, k: usize, l: usize, size: f64) -> (f64, f64) {
        squared(&self.gram, k, l, size)
    }

    /// Squared distance of a column at a size from the nearest of several: those of an effect with a hidden parameter.
    pub(crate) fn squared_from_any(
        &self,
        k: usize,
        others: core::ops::Range<usize>,
        size: f64,
    ) -> f64 {
        squared_from_any(&self.gram, k, others, size)
    }

    /// Squared distance of a column at a size from the best-fitting pair of two others.
    fn squared_from_pair(&self, k: usize, pair: [usize; 2], size: f64) -> f64 {
        let g = &self.gram;
        let [a, b] = pair;
        let determinant = g[(a, a)] * g[(b, b)] - g[(a, b)] * g[(a, b)];
        if determinant <= 1e-9 * g[(a, a)] * g[(b, b)] {
            return self.squared(k, a, size).0.min(self.squared(k, b, size).0);
        }
        let (ka, kb) = (g[(k, a)], g[(k, b)]);
        let explained =
            (ka * ka * g[(b, b)] - 2.0 * ka * kb * g[(a, b)] + kb * kb * g[(a, a)]) / determinant;
        (size * size * (g[(k, k)] - explained)).max(0.0)
    }

    /// Distance of an effect at its typical size from the nearest other one, in noise standard deviations.
    pub(crate) fn nearest_other(&self, library: &Library, effect: usize) -> f64 {
        let own = &library.effects[effect];
        let leading = self.leading[effect];
        (0..library.columns.len())
            .filter(|&column| library.columns[column].effect != effect)
            .map(|column| self.squared(leading, column, own.typical).0.sqrt())
            .fold(own.typical * self.information(leading).sqrt(), f64::min)
    }

    /// Distance of an effect at its typical size from the nearest pair of others, in noise standard deviations: what is
    /// nearer than about 5 cannot be found missing from the library, because two others imitate it.
    pub(crate) fn nearest_pair(&self, library: &Library, effect: usize) -> f64 {
        let own = &library.effects[effect];
        let others: Vec<usize> = (0..library.columns.len())
            .filter(|&column| library.columns[column].effect != effect)
            .collect();
        let leading = self.leading[effect];
        let mut nearest = own.typical * self.information(leading).sqrt();
        for (place, &a) in others.iter().enumerate() {
            for &b in &others[place + 1..] {
                if library.columns[a].effect != library.columns[b].effect {
                    let squared = self.squared_from_pair(leading, [a, b], own.typical);
                    nearest = nearest.min(squared.sqrt());
                }
            }
        }
        nearest
    }
}

/// Of each effect the column of the most probable model that it makes alone. Where an effect has a hidden parameter
/// (Mdd, pivot, date), its distance from others is that at the value which the data support, not at an arbitrary one.
pub(crate) fn leading_columns(library: &Library, models: &[(ScoredHypothesis, f64)]) -> Vec<usize> {
    let mut leading: Vec<usize> = library.effects.iter().map(|e| e.representative).collect();
    let mut found = vec![false; leading.len()];
    // Most probable first.
    for (scored, _) in models {
        if let ([column], None) =
            (&scored.hypothesis.columns[..], scored.hypothesis.flight_scatter_percent)
        {
            let effect = library.columns[*column].effect;
            if !core::mem::replace(&mut found[effect], true) {
                leading[effect] = *column;
            }
        }
    }
    leading
}

/// The smallest of [`squared`] over several columns.
pub(crate) fn squared_from_any(
    g: &Mat<f64>,
    k: usize,
    others: impl IntoIterator<Item = usize>,
    size: f64,
) -> f64 {
    others.into_iter().map(|l| squared(g, k, l, size).0).fold(f64::INFINITY, f64::min)
}

/// Whether a distance is worth an effort: a tenth more than another one, and a tenth of a standard deviation.
pub(crate) fn gains(before: f64, after: f64) -> bool {
    after > LEAST_GAIN * before + LEAST_GAIN_DEVIATIONS
}

/// [`Distances::form_variance`] in any Gram, of what the laws of both columns leave open.
fn form_variance(g: &Mat<f64>, [k, l]: [usize; 2], size: f64, open: [f64; 2]) -> f64 {
    let (_, implied) = squared(g, k, l, size);
    let square = |column: usize, deviation: f64| deviation * deviation * g[(column, column)];
    1.0 + (square(k, open[0] * size) + square(l, open[1] * implied)) / FORM_DIRECTIONS
}

/// [`Distances::squared`] in any Gram.
pub(crate) fn squared(g: &Mat<f64>, k: usize, l: usize, size: f64) -> (f64, f64) {
    if g[(l, l)] <= 0.0 {
        return (size * size * g[(k, k)], 0.0);
    }
    let slope = g[(k, l)] / g[(l, l)];
    ((size * size * (g[(k, k)] - slope * g[(k, l)])).max(0.0), size * slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: two columns of unit information whose correlation is 0.98, so that d² = θ²·(1 − 0.9604) = 0.0396 θ². At θ = 40
    /// they are 63 apart where forms are known, and (0.0396·1600)/(1 + 0.0225·(1600 + 0.9604·1600)/3) = 2.58 where both are open by
    /// 0.15; however large, never more than 3·0.0396/(0.0225·1.9604) = 2.69. One that is known adds nothing.
    #[test]
    fn what_a_form_may_be_off_by_stays_alike_at_any_size() {
        let correlation = |i, j| if i == j { 1.0 } else { 0.98 };
        let g = Mat::from_fn(2, 2, correlation);
        let apart = |size: f64, open: [f64; 2]| {
            squared(&g, 0, 1, size).0 / form_variance(&g, [0, 1], size, open)
        };
        assert!((apart(40.0, [0.0, 0.0]) - 63.36).abs() < 1e-9);
        assert!((apart(40.0, [0.15, 0.15]) - 2.584).abs() < 1e-3);
        assert!(apart(1e6, [0.15, 0.15]) < 2.694);
        let one = 63.36 / (1.0 + 0.0225 * 1600.0 / 3.0);
        assert!((apart(40.0, [0.15, 0.0]) - one).abs() < 1e-9);
    }
}
