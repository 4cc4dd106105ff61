//! Step 3: samples that lie too far from the mean of their piece.

use core::ops::Range;

use crate::CriterionSet;
use crate::channel::Channel;

/// Marks in `failed` the samples of a piece that lie beyond the limit in a channel; all channels are judged on the same
/// piece at once.
///
/// ```text
/// discard i where |x_i − μ| > k σ + 1e-9,  μ = Σ x/n,  σ² = Σ (x − μ)²/(n − 1)
/// ```
///
/// The 1e-9 is in the limit's unit and keeps a constant channel from discarding samples for its own rounding. With k =
/// 2 no sample of fewer than six can be discarded, because |x − μ|/σ cannot exceed (n − 1)/√n. A piece of one sample
/// has no σ and is left unmarked.
///
/// # Source
/// `[steadiness.11]`. That σ is the sample's (n − 1) and that the filter runs once are our choice: the paper says 2σ.
pub(crate) fn mark(channels: &[Channel<'_>], piece: Range<usize>, failed: &mut [CriterionSet]) {
    if piece.len() < 2 {
        return;
    }
    let failed = &mut failed[piece.clone()];
    for channel in channels {
        let values = &channel.values[piece.clone()];
        let (mean, standard_deviation) = mean_and_standard_deviation(values);
        let farthest = channel.standard_deviations * standard_deviation + channel.tolerance;
        for (value, failed) in values.iter().zip(&mut *failed) {
            if (value - mean).abs() > farthest {
                failed.insert(channel.criterion);
            }
        }
    }
}

/// Mean and sample standard deviation of at least two values, in two passes and in their order.
fn mean_and_standard_deviation(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    (mean, (squares / (count - 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_deviation_by_hand() {
        // 2, 4, 4, 4, 5, 5, 7, 9: mean 5, squares 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16 = 32, σ = √(32/7).
        let (mean, deviation) =
            mean_and_standard_deviation(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]);
        assert!((mean - 5.0).abs() < 1e-15);
        assert!((deviation - (32.0_f64 / 7.0).sqrt()).abs() < 1e-15);
    }
}
