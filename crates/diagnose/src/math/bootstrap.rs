//! Bootstrap over groups: intervals of a ratio of two sums.

use crate::math::quantile::central_95;
use crate::math::random::RandomStream;
use crate::thresholds::RESAMPLES;

/// 95 % interval of a ratio of sums over groups, groups drawn with replacement; `ratio` divides the two sums.
pub(crate) fn interval_95(
    groups: &[(f64, f64)],
    stream: &mut RandomStream,
    ratio: impl Fn(f64, f64) -> f64,
) -> [f64; 2] {
    let mut ratios: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let (mut above, mut below) = (0.0, 0.0);
            for _ in 0..groups.len() {
                let (numerator, denominator) = groups[stream.below(groups.len())];
                above += numerator;
                below += denominator;
            }
            ratio(above, below)
        })
        .collect();
    central_95(&mut ratios)
}
