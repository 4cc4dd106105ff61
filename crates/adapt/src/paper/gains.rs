//! The two gains of equation (27).

/// How much of its own value a node keeps, and how much of the observed one it adopts. They sum to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// kc, of the node's value before.
    pub keep: f64,
    /// ka, of the observed value.
    pub adopt: f64,
}

/// Gains of a node at normalized distance δ from the point and with confidence λ before the update.
///
/// ```text
/// kc = (δ − δ^λ)/(1 − δ^λ)        ka = (1 − δ)/(1 − δ^λ)
/// ```
///
/// λ = 1: kc = 0, ka = 1, whatever δ. δ = 0: the same. δ → 1: ka → 1/λ. λ → ∞: kc → δ, ka → 1 − δ.
/// Valid for δ in 0..=1 and λ ≥ 1. 1 − δ^λ is formed as −expm1(λ ln δ), which loses no digits near δ = 1.
///
/// # Source
/// Book `[adaptation.4]`, `[adaptation.5]`; Ghazi et al. 2020, equation (27), reconstructed from a damaged text.
#[must_use]
#[inline]
pub fn gains(normalized_distance: f64, confidence: f64) -> Gains {
    // λ first: with λ = 1 and δ = 1 the fraction is 0/0, and a first observation always replaces.
    let adopt = if confidence <= 1.0 || normalized_distance <= 0.0 {
        1.0
    } else if normalized_distance >= 1.0 {
        1.0 / confidence
    } else {
        -(1.0 - normalized_distance) / (confidence * normalized_distance.ln()).exp_m1()
    };
    Gains { keep: 1.0 - adopt, adopt }
}
