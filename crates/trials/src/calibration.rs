//! Whether stated probabilities and intervals hold: counts by bin, for charts and for the calibration error.

use pipeline::statistics::NORMAL_95;
use serde::Serialize;

use crate::scored_case::Case;
use crate::share::Share;

/// Bins of stated probability.
const BINS: usize = 10;
/// Upper ends of the first nine tenths of the normal distribution, in standard deviations: tables of its quantiles.
const TENTHS: [f64; 9] = [
    -1.281_551_565_5,
    -0.841_621_233_6,
    -0.524_400_512_7,
    -0.253_347_103_1,
    0.0,
    0.253_347_103_1,
    0.524_400_512_7,
    0.841_621_233_6,
    1.281_551_565_5,
];

/// Cases whose most probable effect was stated with a probability in a range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CalibrationBin {
    /// From this probability on.
    pub from: f64,
    /// Up to this one.
    pub to: f64,
    /// Mean of the stated probabilities.
    pub stated: f64,
    /// Of how many the planted effect was that effect.
    pub right: Share,
}

/// Bins of stated probability that hold a case, in rising order.
pub(crate) fn bins(cases: &[&Case]) -> Vec<CalibrationBin> {
    let mut sums = [(0_usize, 0.0, 0_usize); BINS];
    for case in cases {
        let Some((_, probability)) = &case.top else { continue };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a probability times the number of bins"
        )]
        let bin = ((probability * BINS as f64) as usize).min(BINS - 1);
        sums[bin].0 += 1;
        sums[bin].1 += probability;
        sums[bin].2 += usize::from(case.on_top());
    }
    let edge = |bin: usize| bin as f64 / BINS as f64;
    let filled = sums.iter().enumerate().filter(|(_, sum)| sum.0 > 0);
    filled
        .map(|(bin, &(of, stated, right))| CalibrationBin {
            from: edge(bin),
            to: edge(bin + 1),
            stated: stated / of as f64,
            right: Share::new(right, of),
        })
        .collect()
}

/// Expected calibration error: Σ over bins of share of the cases × |mean stated − observed|.
pub(crate) fn error(cases: &[&Case]) -> f64 {
    let bins = bins(cases);
    let total: f64 = bins.iter().map(|bin| bin.right.of as f64).sum();
    let weighted =
        bins.iter().map(|bin| bin.right.of as f64 * (bin.stated - bin.right.share).abs() / total);
    weighted.sum()
}

/// In which tenth of its stated distribution the planted size lies, cases counted: alike in all tenths where stated sizes
/// and intervals are right, full ends where intervals are too short.
pub(crate) fn size_tenths(cases: &[&Case]) -> [usize; 10] {
    let mut counts = [0; 10];
    for position in cases.iter().filter_map(|case| case.size_position) {
        counts[TENTHS.partition_point(|&end| end <= NORMAL_95 * position)] += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the standard normal distribution at the ends, by the series of its error function.
    #[test]
    fn tenths_hold_a_tenth_each() {
        for (k, end) in TENTHS.iter().enumerate() {
            let (mut term, mut sum) = (*end, *end);
            for n in 1..60_i32 {
                let n = f64::from(n);
                term *= -end * end / (2.0 * n);
                sum += term / (2.0 * n + 1.0);
            }
            let below = 0.5 + sum / (2.0 * core::f64::consts::PI).sqrt();
            assert!((below - 0.1 * (k as f64 + 1.0)).abs() < 1e-9, "{end}: {below}");
        }
    }
}
