//! The size of an effect with its interval, over all hypotheses that name it.

use core::f64::consts::{FRAC_1_SQRT_2, TAU};

use statrs::function::erf::erfc;

use crate::output::Magnitude;

/// Steps at most: bisections alone would settle in 47.
const STEPS: usize = 120;
/// A step this short beside the first bracket is rounding.
const SETTLED: f64 = 1e-14;

/// What one hypothesis believes of a size: a normal with the hypothesis's probability.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SizeBelief {
    pub(crate) probability: f64,
    pub(crate) size: f64,
    pub(crate) deviation: f64,
}

/// The size that the most probable hypothesis has, with the 95 % interval of all of them.
///
/// ```text
/// Σ p_h Φ((x − θ_h)/√(σ_h² + (φ θ_h)²)) / Σ p_h = 0.025, 0.975                                    [diagnosis.51]
/// ```
///
/// φ is what the law of the effect leaves open ([`crate::library::forms::open_by_law`]).
pub(crate) fn magnitude(value: f64, beliefs: &[SizeBelief], open_by_law: f64) -> Magnitude {
    let widened: Vec<SizeBelief> = beliefs
        .iter()
        .map(|of| SizeBelief { deviation: of.deviation.hypot(open_by_law * of.size), ..*of })
        .collect();
    Magnitude { value, ci95: [0.025, 0.975].map(|share| quantile(&widened, share)) }
}

/// Where a mixture of normals has a share below it: Newton's method, with bisection where its step leaves the bracket or is more
/// than half the step before.
///
/// # Source
/// Press et al., *Numerical Recipes*, 3rd edition, section 9.4.
fn quantile(beliefs: &[SizeBelief], share: f64) -> f64 {
    let total: f64 = beliefs.iter().map(|of| of.probability).sum();
    // The share below x less that which is wanted, and the density there.
    let above = |x: f64| -> (f64, f64) {
        let (mut below, mut density) = (0.0, 0.0);
        for of in beliefs {
            let z = (x - of.size) / of.deviation;
            below += of.probability * 0.5 * erfc(-z * FRAC_1_SQRT_2);
            density += of.probability * (-0.5 * z * z).exp() / (of.deviation * TAU.sqrt());
        }
        (below / total - share, density / total)
    };
    // Eight standard deviations leave 1e-15 outside.
    let ends = |by: f64| beliefs.iter().map(move |of| of.size + by * of.deviation);
    let mut low = ends(-8.0).fold(f64::INFINITY, f64::min);
    let mut high = ends(8.0).fold(f64::NEG_INFINITY, f64::max);
    let settled = SETTLED * (high - low);
    let (mut x, mut step) = (f64::midpoint(low, high), high - low);
    for _ in 0..STEPS {
        let (off, density) = above(x);
        if off < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - off / density;
        let converges = low < newton && newton < high && (newton - x).abs() <= 0.5 * step;
        let next = if converges { newton } else { f64::midpoint(low, high) };
        step = (next - x).abs();
        x = next;
        if step <= settled {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn belief(probability: f64, size: f64, deviation: f64) -> SizeBelief {
        SizeBelief { probability, size, deviation }
    }

    /// The normal distribution's table: 1.959964 standard deviations. 0.15·2 = 0.3 beside 0.4 are 0.5.
    #[test]
    fn one_hypothesis_has_the_interval_of_a_normal() {
        let of = magnitude(2.0, &[belief(0.3, 2.0, 0.4)], 0.0);
        assert!((of.ci95[0] - (2.0 - 0.4 * 1.959_964)).abs() < 1e-6, "{of:?}");
        assert!((of.ci95[1] - (2.0 + 0.4 * 1.959_964)).abs() < 1e-6, "{of:?}");
        let of = magnitude(2.0, &[belief(0.3, 2.0, 0.4)], 0.15);
        assert!((of.ci95[1] - (2.0 + 0.5 * 1.959_964)).abs() < 1e-6, "{of:?}");
    }

    /// By hand: of two narrow normals far apart with 1 % and 99 %, 2.5 % lie below where the second has 1.5/99 below it, at
    /// −2.1661 standard deviations, and 97.5 % where it has 96.5/99, at +1.9557 (the normal distribution's table).
    #[test]
    fn an_unlikely_other_size_moves_the_interval() {
        let of = magnitude(10.0, &[belief(0.01, 1.0, 0.1), belief(0.99, 10.0, 1.0)], 0.0);
        assert!((of.ci95[0] - (10.0 - 2.1661)).abs() < 2e-3, "{of:?}");
        assert!((of.ci95[1] - (10.0 + 1.9557)).abs() < 2e-3, "{of:?}");
    }

    /// Oracle: the share below, at the quantile of narrow and wide normals, near and far.
    #[test]
    fn the_share_below_a_quantile_is_its_share() {
        let mixtures = [
            vec![belief(0.5, -3.0, 1e-3), belief(0.5, 3.0, 1e-3)],
            vec![belief(0.9, 1.0, 0.01), belief(0.1, 0.0, 10.0)],
            vec![belief(0.02, -50.0, 0.1), belief(0.97, 0.0, 1.0), belief(0.01, 1e4, 5.0)],
        ];
        for mixture in mixtures {
            for share in [0.01, 0.025, 0.3, 0.7, 0.975] {
                let x = quantile(&mixture, share);
                let below: f64 = mixture
                    .iter()
                    .map(|of| {
                        let z = (x - of.size) / of.deviation;
                        of.probability * 0.5 * erfc(-z * FRAC_1_SQRT_2)
                    })
                    .sum();
                assert!((below - share).abs() < 1e-9, "{mixture:?} {share}: {x} {below}");
            }
        }
    }
}
