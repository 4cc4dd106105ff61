//! Which findings are kept so that few of them are false.

/// How many of the findings, the surest first, are kept so that the expected share of false ones is at most `share`; the
/// probabilities are those that a finding is true.
///
/// ```text
/// the largest k with  Σ_{i ≤ k} (1 − p_(i))/k ≤ share                                                  [fleet.3]
/// ```
///
/// # Source
/// Newton, Noueiry, Sarkar and Ahlquist 2004, doi 10.1093/biostatistics/5.2.155.
pub(crate) fn kept(probabilities: &mut [f64], share: f64) -> usize {
    probabilities.sort_by(|a, b| b.total_cmp(a));
    let mut false_ones = 0.0;
    let mut kept = 0;
    for (place, probability) in probabilities.iter().enumerate() {
        false_ones += 1.0 - probability;
        if false_ones <= share * (place + 1) as f64 {
            kept = place + 1;
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_by_hand() {
        // Errors 0.01, 0.04, 0.10, 0.40: means 0.01, 0.025, 0.05, 0.1375.
        assert_eq!(kept(&mut [0.60, 0.96, 0.90, 0.99], 0.05), 3);
        assert_eq!(kept(&mut [0.94], 0.05), 0);
        assert_eq!(kept(&mut [], 0.05), 0);
    }
}
