//! What the terms of a smooth function leave of the mean over many places.

use crate::baseline::smooth::{BEYOND_BY_ROUNDING, Smooth, kernel};

/// Places that are held against each other: more are brought to so many even ones. Between two knots, of which 16 at most follow
/// one another, there are then 16, and 1 % of what is left is lost by it.
const MOST_PLACES: usize = 256;

/// A place along a function, in lengths, and how many of all places are there.
type Weighted = (f64, f64);

impl Smooth {
    /// Variance of the mean over places in lengths, as a share of the process' variance, of what the terms do not hold between
    /// the knots. It changes its sign from knot to knot, so that of a mean over many places little is left. Places beyond what
    /// was flown count with 0: what is not known there is one thing.
    ///
    /// ```text
    /// var(mean) = Σ_ab (k(z_a, z_b) − φ(z_a)ᵀφ(z_b))/n²                                      [baseline.9]
    /// ```
    pub(crate) fn left_of_mean(&self, places: &[f64]) -> f64 {
        let within = |z: &&f64| self.text.beyond(**z) <= BEYOND_BY_ROUNDING;
        let mut flown: Vec<f64> = places.iter().filter(within).copied().collect();
        flown.sort_by(f64::total_cmp);
        let weighted = brought_together(&flown, places.len());
        let mut terms = vec![0.0; self.len()];
        let mut mean = vec![0.0; self.text.count];
        let mut all = 0.0;
        for (k, (z, weight)) in weighted.iter().enumerate() {
            self.write_at(*z, &mut terms);
            for (sum, term) in mean.iter_mut().zip(&terms[1..]) {
                *sum += weight * term;
            }
            let others: f64 =
                weighted[..k].iter().map(|(other, share)| share * kernel(*z, *other)).sum();
            all += weight * (weight + 2.0 * others);
        }
        (all - mean.iter().map(|sum| sum * sum).sum::<f64>()).max(0.0)
    }
}

/// Places in order with the share of all `count` that is at each, brought to an even grid where there are too many.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number from 0 to the most places"
)]
fn brought_together(flown: &[f64], count: usize) -> Vec<Weighted> {
    let share = 1.0 / count.max(1) as f64;
    let mut found: Vec<Weighted> = Vec::new();
    for z in flown {
        match found.last_mut() {
            Some((last, weight)) if (*last - z).abs() <= 0.0 => *weight += share,
            _ => found.push((*z, share)),
        }
    }
    if found.len() <= MOST_PLACES {
        return found;
    }
    let (first, last) = (flown[0], flown[flown.len() - 1]);
    let distance = (last - first) / (MOST_PLACES - 1) as f64;
    let mut even: Vec<Weighted> =
        (0..MOST_PLACES).map(|k| (first + distance * k as f64, 0.0)).collect();
    for (z, weight) in found {
        let at = (z - first) / distance;
        let below = (at as usize).min(MOST_PLACES - 2);
        let above = at - below as f64;
        even[below].1 += weight * (1.0 - above);
        even[below + 1].1 += weight * above;
    }
    even
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::RandomStream;
    use effects::Variable;

    fn smooth() -> Smooth {
        let values: Vec<f64> = (0..50).map(|k| 0.70 + 0.003 * f64::from(k)).collect();
        Smooth::over(Variable::Mach, 0.02, &values).unwrap()
    }

    fn places(count: u32) -> Vec<f64> {
        (0..count).map(|k| smooth().at(0.70 + 0.147 * f64::from(k) / f64::from(count))).collect()
    }

    /// The oracle is the covariance of what is left at every pair of places, written out.
    #[test]
    fn the_mean_of_few_places_is_that_of_all_pairs() {
        let smooth = smooth();
        let places = places(60);
        let terms: Vec<Vec<f64>> = places
            .iter()
            .map(|z| {
                let mut terms = vec![0.0; smooth.len()];
                smooth.write_at(*z, &mut terms);
                terms[1..].to_vec()
            })
            .collect();
        let mut expected = 0.0;
        for (a, of_a) in places.iter().zip(&terms) {
            for (b, of_b) in places.iter().zip(&terms) {
                let held: f64 = of_a.iter().zip(of_b).map(|(p, q)| p * q).sum();
                expected += (kernel(*a, *b) - held) / 3600.0;
            }
        }
        let found = smooth.left_of_mean(&places);
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        assert!(found > 1e-7, "{found}: of nothing nothing is tested");
    }

    /// The oracle is the same function without the grid: one place after the other is the same as many at once.
    #[test]
    fn many_places_are_what_few_of_the_same_spread_are() {
        let smooth = smooth();
        let mut stream = RandomStream::new(9, 1);
        let mut normals = vec![0.0; 4000];
        stream.fill(&mut normals);
        let about: Vec<f64> = normals.iter().map(|normal| 0.3 * normal).collect();
        let pairs: f64 = {
            let terms: Vec<Vec<f64>> = about
                .iter()
                .map(|z| {
                    let mut terms = vec![0.0; smooth.len()];
                    smooth.write_at(*z, &mut terms);
                    terms
                })
                .collect();
            let mean: Vec<f64> = (1..smooth.len())
                .map(|k| terms.iter().map(|one| one[k]).sum::<f64>() / 4000.0)
                .collect();
            let kernels: f64 =
                about.iter().map(|a| about.iter().map(|b| kernel(*a, *b)).sum::<f64>()).sum();
            kernels / 1.6e7 - mean.iter().map(|mean| mean * mean).sum::<f64>()
        };
        let found = smooth.left_of_mean(&about);
        assert!((found / pairs - 1.0).abs() < 0.02, "{found} {pairs}");
    }

    #[test]
    fn one_place_is_what_its_terms_leave_and_a_mean_over_many_far_less() {
        let smooth = smooth();
        let mut terms = vec![0.0; smooth.len()];
        let (mut most, all) = (0.0_f64, places(200));
        for z in &all {
            let left = smooth.write_at(*z, &mut terms).total();
            assert!((smooth.left_of_mean(&[*z]) - left).abs() < 1e-12);
            most = most.max(left);
        }
        assert!(smooth.left_of_mean(&all) < most / 50.0);
        let beyond = smooth.at(0.9);
        assert!(smooth.left_of_mean(&[beyond, beyond]) <= 0.0);
    }
}
