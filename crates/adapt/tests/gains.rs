//! Equation (27): published and derived values of the gains, their limits, and their meaning.
#![expect(clippy::float_cmp, reason = "the limits are exact")]

use adapt::paper::{Gains, gains};
use proptest::prelude::*;

fn adopt(normalized_distance: f64, confidence: f64) -> f64 {
    gains(normalized_distance, confidence).adopt
}

/// Values of ka computed together with the reconstruction of the equation, to the digits given there.
#[test]
fn table_of_the_adopting_gain() {
    let confidences = [1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0];
    for (normalized_distance, expected) in [
        (0.0, [1.0; 7]),
        (0.1, [1.0, 0.9294, 0.9091, 0.9009, 0.9000, 0.9000, 0.9000]),
        (0.5, [1.0, 0.7735, 0.6667, 0.5714, 0.5161, 0.5005, 0.5000]),
        (0.9, [1.0, 0.6841, 0.5263, 0.3690, 0.2442, 0.1535, 0.1138]),
        (1.0, [1.0, 0.6667, 0.5, 0.3333, 0.2, 0.1, 0.05]),
    ] {
        for (confidence, expected) in confidences.into_iter().zip(expected) {
            let ours = adopt(normalized_distance, confidence);
            assert!(
                (ours - expected).abs() < 0.5001e-4,
                "{normalized_distance} {confidence}: {ours}"
            );
        }
    }
    for normalized_distance in [0.0, 0.1, 0.5, 0.9] {
        assert!((adopt(normalized_distance, 1e9) - (1.0 - normalized_distance)).abs() < 1e-15);
    }
}

/// Whole confidences by hand, as fractions: (1 − δ)/(1 − δ²) = 1/(1 + δ), (1 − δ)/(1 − δ³) = 1/(1 + δ + δ²).
#[test]
fn whole_confidences_are_geometric_sums() {
    for normalized_distance in [1e-12, 0.1, 0.37, 0.5, 0.9, 0.999_999, 1.0 - 1e-12] {
        let delta: f64 = normalized_distance;
        assert!((adopt(delta, 2.0) * (1.0 + delta) - 1.0).abs() < 4e-16);
        assert!((adopt(delta, 3.0) * (1.0 + delta + delta * delta) - 1.0).abs() < 5e-16);
    }
}

#[test]
fn limits_are_exact() {
    let replace = Gains { keep: 0.0, adopt: 1.0 };
    for normalized_distance in [0.0, 1e-300, 0.3, 1.0 - f64::EPSILON / 2.0, 1.0] {
        assert_eq!(gains(normalized_distance, 1.0), replace);
    }
    for confidence in [1.0, 1.4, 7.0, 1e12] {
        assert_eq!(gains(0.0, confidence), replace);
        assert_eq!(adopt(1.0, confidence), 1.0 / confidence);
    }
    // The last double below 1 is no different from 1: no digits are lost on the way.
    for confidence in [1.4, 4.0, 7.0] {
        assert!((adopt(1.0 - f64::EPSILON / 2.0, confidence) * confidence - 1.0).abs() < 1e-15);
    }
}

proptest! {
    #[test]
    fn gains_are_shares(normalized_distance in 0.0..=1.0, confidence in 1.0..1e6_f64) {
        let Gains { keep, adopt } = gains(normalized_distance, confidence);
        prop_assert!((keep + adopt - 1.0).abs() <= f64::EPSILON);
        prop_assert!((0.0..=1.0).contains(&adopt));
        prop_assert!((0.0..=1.0).contains(&keep));
        // Never below 1 − δ: the law never stops adopting.
        prop_assert!(adopt >= (1.0 - normalized_distance) * (1.0 - 1e-15));
    }

    #[test]
    fn confidence_only_slows(normalized_distance in 0.0..=1.0, confidence in 1.0..100.0_f64, more in 0.0..10.0_f64) {
        let (before, after) = (adopt(normalized_distance, confidence), adopt(normalized_distance, confidence + more));
        prop_assert!(after <= before * (1.0 + 1e-15));
    }

    /// The meaning of (27): at a constant δ, λ = 1, 2, 3, … forms the mean of all observations with weights 1, δ, δ², …
    /// from the newest to the oldest. The oracle is that mean.
    #[test]
    fn constant_distance_is_a_forgetting_mean(
        normalized_distance in 0.01..1.0_f64,
        observations in prop::collection::vec(0.02..0.04_f64, 1..12),
    ) {
        let mut value = 99.0; // replaced by the first observation
        for (i, observation) in observations.iter().enumerate() {
            let Gains { keep, adopt } = gains(normalized_distance, 1.0 + i as f64);
            value = keep * value + adopt * observation;
        }
        let (mut sum, mut weights, mut weight) = (0.0, 0.0, 1.0);
        for observation in observations.iter().rev() {
            sum += weight * observation;
            weights += weight;
            weight *= normalized_distance;
        }
        prop_assert!((value - sum / weights).abs() < 1e-15);
    }
}
