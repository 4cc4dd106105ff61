//! Step 1: which samples of a run meet which criteria.

use crate::channel::Channel;
use crate::{CriterionKind, CriterionSet};

/// For each sample of a run, the criteria it fails.
///
/// ```text
/// |x_i − x_{i−1}| ≤ ℓ and |x_i − x_{i+1}| ≤ ℓ,  1 < i < N
/// |x_1 − x_2| ≤ ℓ and |x_1 − x_3| ≤ ℓ
/// |x_N − x_{N−1}| ≤ ℓ and |x_N − x_{N−2}| ≤ ℓ
/// |x_i| ≤ ℓ  (drift, roll)
/// ```
///
/// In runs of fewer than three samples (`track` makes none) only the neighbors that exist count.
///
/// # Source
/// `[steadiness.8]`, `[steadiness.9]`; Ghazi et al. 2020, eq. (19) and table 4.
pub(crate) fn failed_criteria(channels: &[Channel<'_>], samples: usize) -> Vec<CriterionSet> {
    let mut failed = vec![CriterionSet::EMPTY; samples];
    for channel in channels {
        match channel.criterion.kind() {
            CriterionKind::ChangeToNeighbors => mark_changes(channel, &mut failed),
            CriterionKind::Size => mark_sizes(channel, &mut failed),
        }
    }
    failed
}

fn mark_changes(channel: &Channel<'_>, failed: &mut [CriterionSet]) {
    let values = channel.values;
    // Written as 'within' and not as 'exceeds', so that a limit of NaN rejects.
    let within = |a: f64, b: f64| (a - b).abs() <= channel.limit;
    for (before, pair) in values.windows(2).enumerate() {
        if !within(pair[0], pair[1]) {
            failed[before].insert(channel.criterion);
            failed[before + 1].insert(channel.criterion);
        }
    }
    if let [first, _, third, ..] = values
        && !within(*first, *third)
    {
        failed[0].insert(channel.criterion);
    }
    if let [.., third, _, last] = values
        && !within(*last, *third)
    {
        failed[values.len() - 1].insert(channel.criterion);
    }
}

fn mark_sizes(channel: &Channel<'_>, failed: &mut [CriterionSet]) {
    for (value, failed) in channel.values.iter().zip(failed) {
        let within = value.abs() <= channel.limit;
        if !within {
            failed.insert(channel.criterion);
        }
    }
}
