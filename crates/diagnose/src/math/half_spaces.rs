//! A normal distribution held to half-spaces, by its first two moments.

use faer::Mat;
use statrs::function::erf::erfc;

/// Correlation from which a half-space is taken for the same as one that was held before. Our choice: two thirds of its
/// variance; held twice, one fact would count twice.
const SAME: f64 = 0.8;

/// Limits of [`hold`], in standard deviations by which a half-space lies off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Doubt {
    /// Held are those that lie at most so far inside.
    pub(crate) most: f64,
    /// Not those that lie farther outside than this: what is known speaks against them.
    pub(crate) least: f64,
}

/// What [`hold`] came to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Held {
    /// The half-spaces that were held, in order.
    pub(crate) rows: Vec<usize>,
    /// How many known values speak against.
    pub(crate) against: usize,
}

/// Holds `x ~ N(mean, covariance)` to `aᵀx + b ≥ 0`, `a` a row of `rows` and `b` its offset: the most doubtful one first, each
/// by the moments of the truncated normal distribution along it.
///
/// ```text
/// g = aᵀm + b,  s² = aᵀVa,  z = g/s,  λ = φ(z)/Φ(z)
/// m ← m + Va·λ/s,   V ← V − Va·aᵀV·λ(λ + z)/s²                                                       [baseline.7]
/// ```
///
/// One that hangs together with another which was held is held too only where its mean lies outside.
///
/// # Source
/// Johnson, Kotz and Balakrishnan 1994, Continuous univariate distributions 1, section 10.1 (moments); assumed density
/// filtering as of Opper 1998: the moments are exact of one half-space, and near of several.
pub(crate) fn hold(
    mean: &mut [f64],
    covariance: &mut Mat<f64>,
    rows: &Mat<f64>,
    offsets: &[f64],
    doubt: Doubt,
) -> Held {
    let (count, width) = (rows.nrows(), rows.ncols());
    let mut gaps: Vec<f64> = (0..count)
        .map(|k| offsets[k] + (0..width).map(|j| rows[(k, j)] * mean[j]).sum::<f64>())
        .collect();
    let spread = rows * &*covariance;
    let mut variances: Vec<f64> = (0..count)
        .map(|k| (0..width).map(|j| spread[(k, j)] * rows[(k, j)]).sum::<f64>())
        .collect();
    let mut is_same = vec![false; count];
    let mut is_done = vec![false; count];
    let mut held = Held::default();
    // Every half-space is held once at most.
    for _ in 0..count {
        let z = |k: usize| gaps[k] / variances[k].sqrt();
        let open = (0..count).filter(|&k| {
            let most = if is_same[k] { 0.0 } else { doubt.most };
            !is_done[k] && variances[k] > 0.0 && z(k) < most
        });
        let Some(next) = open.min_by(|&one, &other| z(one).total_cmp(&z(other))) else { break };
        is_done[next] = true;
        let distance = z(next);
        if distance < doubt.least {
            held.against += 1;
            continue;
        }
        held.rows.push(next);
        let deviation = variances[next].sqrt();
        let ratio = density_over_share(distance);
        let fall = ratio * (ratio + distance);
        let along: Vec<f64> = (0..width)
            .map(|i| {
                (0..width).map(|j| covariance[(i, j)] * rows[(next, j)]).sum::<f64>() / deviation
            })
            .collect();
        for (k, gap) in gaps.iter_mut().enumerate() {
            let by: f64 = (0..width).map(|j| rows[(k, j)] * along[j]).sum();
            is_same[k] |= by > SAME * variances[k].sqrt();
            *gap += ratio * by;
            variances[k] -= fall * by * by;
        }
        for (value, by) in mean.iter_mut().zip(&along) {
            *value += ratio * by;
        }
        for (j, by) in along.iter().enumerate() {
            for (i, other) in along.iter().enumerate() {
                covariance[(i, j)] -= fall * by * other;
            }
        }
    }
    held
}

/// φ(z)/Φ(z) of the standard normal distribution.
fn density_over_share(z: f64) -> f64 {
    let density = (-0.5 * z * z).exp() / (2.0 * core::f64::consts::PI).sqrt();
    density / (0.5 * erfc(-z / core::f64::consts::SQRT_2))
}

#[cfg(test)]
mod tests {
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::math::cholesky::Cholesky;

    const DOUBT: Doubt = Doubt { most: 2.0, least: -2.0 };

    /// A smooth function on a line of nodes, which may not fall: nodes, and differences of neighbours as rows.
    fn smooth_function(nodes: usize, length: f64, rise: f64) -> (Vec<f64>, Mat<f64>, Mat<f64>) {
        let mean = (0..nodes).map(|k| rise * k as f64).collect();
        let covariance = Mat::from_fn(nodes, nodes, |i, j| {
            let apart = (i as f64 - j as f64) / length;
            (-0.5 * apart * apart).exp() + if i == j { 1e-9 } else { 0.0 }
        });
        let rows = Mat::from_fn(nodes - 1, nodes, |k, j| {
            f64::from(u8::from(j == k + 1)) - f64::from(u8::from(j == k))
        });
        (mean, covariance, rows)
    }

    /// Mean and variance of every component over draws that meet all half-spaces.
    fn by_draws(mean: &[f64], covariance: &Mat<f64>, rows: &Mat<f64>) -> (Vec<f64>, Vec<f64>, u32) {
        let root = Cholesky::new(covariance).unwrap().lower().to_owned();
        let width = mean.len();
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let (mut sums, mut squares, mut kept) = (vec![0.0; width], vec![0.0; width], 0_u32);
        for _ in 0..200_000 {
            let normal: Vec<f64> = (0..width).map(|_| StandardNormal.sample(&mut random)).collect();
            let drawn: Vec<f64> = (0..width)
                .map(|i| mean[i] + (0..=i).map(|j| root[(i, j)] * normal[j]).sum::<f64>())
                .collect();
            let meets = (0..rows.nrows())
                .all(|k| (0..width).map(|j| rows[(k, j)] * drawn[j]).sum::<f64>() >= 0.0);
            if meets {
                kept += 1;
                for (k, value) in drawn.iter().enumerate() {
                    sums[k] += value;
                    squares[k] += value * value;
                }
            }
        }
        let count = f64::from(kept);
        let means: Vec<f64> = sums.iter().map(|sum| sum / count).collect();
        let variances = squares.iter().zip(&means).map(|(s, m)| s / count - m * m).collect();
        (means, variances, kept)
    }

    /// One half-space, by hand from tables: φ(½) = 0.352 065 327, Φ(½) = 0.691 462 461, λ = 0.509 160 434.
    #[test]
    fn one_half_space_gives_the_moments_of_the_truncated_normal() {
        let (mut mean, mut covariance) = (vec![0.0, 1.0], Mat::<f64>::identity(2, 2));
        let rows = Mat::from_fn(1, 2, |_, j| if j == 0 { 1.0 } else { 0.0 });
        let held = hold(&mut mean, &mut covariance, &rows, &[0.5], DOUBT);
        assert_eq!(held, Held { rows: vec![0], against: 0 });
        assert!((mean[0] - 0.509_160_43).abs() < 1e-7, "{}", mean[0]);
        assert!((covariance[(0, 0)] - 0.486_175_44).abs() < 1e-7, "{}", covariance[(0, 0)]);
        // What has nothing to do with it stays to the bit.
        let one = 1.0_f64.to_bits();
        assert_eq!([mean[1], covariance[(1, 1)]].map(f64::to_bits), [one; 2]);
    }

    /// Several that hang together, against draws: means within a quarter of a standard deviation, deviations within 30 %.
    #[test]
    fn several_half_spaces_are_near_the_moments_of_draws() {
        for (length, rise) in [(4.0, 0.1), (6.0, 0.05), (3.0, 0.3)] {
            let (before, covariance, rows) = smooth_function(8, length, rise);
            let (means, variances, kept) = by_draws(&before, &covariance, &rows);
            assert!(kept > 2000, "{kept}");
            let (mut mean, mut held_covariance) = (before, covariance);
            let held = hold(&mut mean, &mut held_covariance, &rows, &[0.0; 7], DOUBT);
            assert!(!held.rows.is_empty() && held.against == 0);
            let mut slopes = (0..7).map(|k| mean[k + 1] - mean[k]);
            assert!(slopes.all(|slope| slope >= 0.0), "{mean:?}");
            for k in 0..8 {
                let off = (mean[k] - means[k]) / variances[k].sqrt();
                let ratio = (held_covariance[(k, k)] / variances[k]).sqrt();
                assert!(off.abs() < 0.25, "length {length} node {k}: {off}");
                assert!((ratio - 1.0).abs() < 0.3, "length {length} node {k}: {ratio}");
            }
        }
    }

    /// What is met beyond doubt, or known to be otherwise, moves nothing.
    #[test]
    fn what_is_known_stays_to_the_bit() {
        let (mut mean, mut covariance) = (vec![3.0, -3.0], Mat::<f64>::identity(2, 2));
        let rows = Mat::<f64>::identity(2, 2);
        let held = hold(&mut mean, &mut covariance, &rows, &[0.0; 2], DOUBT);
        assert_eq!(held, Held { rows: vec![], against: 1 });
        assert_eq!((mean, covariance), (vec![3.0, -3.0], Mat::identity(2, 2)));
    }
}
