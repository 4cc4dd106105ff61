//! The likelihood of a channel as a function of the scales of its prior alone: no prior has to be inverted.

use faer::Mat;

use crate::learning::dials::Dials;
use crate::learning::prior::Prior;
use crate::math::linear::add_gram;
use crate::math::lower::{Lower, dot};

/// What makes scales cheap to move at one ratio of the noise.
///
/// ```text
/// G = LLᵀ,  h = L⁻¹g,  C = Σ_i s_i²/w² LᵀP_iL,  K = Σ_i s_i² P_i:
/// ln|K| + ln|K⁻¹ + G/w²| = ln|1 + C|,   gᵀ(K⁻¹ + G/w²)⁻¹g/w² = hᵀC(1 + C)⁻¹h                 [diagnosis.17]
/// ```
pub(super) struct ByScales {
    ratio: f64,
    /// `LᵀP_iL` and its product with h.
    parts: Vec<(Lower, Vec<f64>)>,
    right: Vec<f64>,
    /// Room for what is factored.
    seen: Lower,
}

impl ByScales {
    /// At a ratio, whose Gram matrix and right side these are; `None` where that has no factor.
    pub(super) fn new(ratio: f64, (gram, right): (&Lower, &[f64]), prior: &Prior) -> Option<Self> {
        let mut factor = gram.clone();
        if !factor.factor() {
            return None;
        }
        let mut right = right.to_vec();
        factor.solve_lower(&mut right);
        let lower = factor.to_mat();
        let part = |root: &Mat<f64>| {
            let turned = lower.transpose() * root;
            let mut part = Mat::<f64>::zeros(turned.nrows(), turned.nrows());
            add_gram(&mut part, turned.transpose());
            let part = Lower::of(&part);
            let with_right = part.times(&right);
            (part, with_right)
        };
        let parts = prior.roots.iter().map(part).collect();
        Some(Self { ratio, parts, right, seen: Lower::default() })
    }

    /// Whether this is the ratio.
    pub(super) const fn is_at(&self, ratio: f64) -> bool {
        self.ratio.to_bits() == ratio.to_bits()
    }

    /// ln|K| + ln|K⁻¹ + G/w²| and gᵀ(K⁻¹ + G/w²)⁻¹g/w²; `None` where a matrix is not positive definite.
    pub(super) fn seen(&mut self, dials: &Dials) -> Option<(f64, f64)> {
        let square = dials.within * dials.within;
        let scales = dials.scales.iter().map(|scale| scale * scale);
        let shares: Vec<f64> =
            core::iter::once(1.0).chain(scales).map(|share| share / square).collect();
        let parts = || shares.iter().copied().zip(&self.parts);
        self.seen.set_one_and_sum(parts().map(|(share, (part, _))| (share, part)));
        if !self.seen.factor() {
            return None;
        }
        let mut moved = vec![0.0; self.right.len()];
        for (share, (_, with_right)) in parts() {
            for (sum, value) in moved.iter_mut().zip(with_right) {
                *sum += share * value;
            }
        }
        let mut right = self.right.clone();
        self.seen.solve_lower(&mut moved);
        self.seen.solve_lower(&mut right);
        Some((self.seen.ln_determinant(), dot(&moved, &right)))
    }
}
