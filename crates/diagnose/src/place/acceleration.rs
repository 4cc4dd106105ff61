//! What the error of the recorded acceleration makes of a gap.

use core::ops::Range;

use crate::place::told::Gaps;
use crate::search::system::WhitenedSystem;

/// Takes out of fuel flow what the error of the recorded acceleration makes of it, as far as the recording itself tells;
/// and weighs segments down, where heavy tails were found.
///
/// A recorded acceleration that is far from the mean is partly in error, and the error is in the residual: without this,
/// slices over acceleration would stand out in every recording. Where ground speed is recorded better than stated, residuals do
/// not follow acceleration so much, and no more is taken out than they do.
///
/// ```text
/// E(δ | V̇G) = (V̇G − mean)·s,   s = σ_δ²/var(V̇G) at most,   ∂ ln Wf/∂V̇G = m/F                         [diagnosis.27]
/// ```
pub(crate) fn expected_errors_removed(system: &WhitenedSystem<'_>, gaps: &Gaps) -> Gaps {
    let segments = &system.data.segments;
    let count = segments.len() as f64;
    let mean = segments.iter().map(|row| row.point.acceleration_m_s2).sum::<f64>() / count;
    let variance =
        segments.iter().map(|row| (row.point.acceleration_m_s2 - mean).powi(2)).sum::<f64>()
            / count;
    let by_acceleration: Vec<f64> = segments
        .iter()
        .map(|row| {
            let slope = row.point.mass_kg / row.response.net_thrust_n;
            slope * (row.point.acceleration_m_s2 - mean)
        })
        .collect();
    let flights = system.data.flights.iter().map(|flight| flight.segments.clone());
    let seen = share_in_residuals(flights, &by_acceleration, &gaps.total);
    let mut left = gaps.clone();
    for ((row, gap), by_acceleration) in segments.iter().zip(&mut left.total).zip(&by_acceleration)
    {
        if variance > 0.0 {
            let share = error_share(row.acceleration_deviation_m_s2, variance).min(seen);
            *gap += share * by_acceleration;
        }
        *gap *= row.weight;
    }
    left
}

/// The share of an acceleration by which residuals fall as it grows, within flights: least squares; 0 where they rise.
fn share_in_residuals(
    flights: impl Iterator<Item = Range<usize>>,
    by_acceleration: &[f64],
    residuals: &[f64],
) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for flight in flights {
        let mean = |of: &[f64]| of[flight.clone()].iter().sum::<f64>() / flight.len() as f64;
        let (of_acceleration, of_residual) = (mean(by_acceleration), mean(residuals));
        for segment in flight.clone() {
            let moved = by_acceleration[segment] - of_acceleration;
            product += moved * (residuals[segment] - of_residual);
            square += moved * moved;
        }
    }
    if square > 0.0 { (-product / square).max(0.0) } else { 0.0 }
}

/// Share of the deviation of a recorded acceleration from the mean that is expected to be error.
fn error_share(deviation_m_s2: f64, recorded_variance: f64) -> f64 {
    // A recording that varies less than its sensor announces is all error.
    (deviation_m_s2.powi(2) / recorded_variance).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::RandomStream;

    /// By hand: within two flights, whose levels differ, residuals fall by half of what acceleration makes, or rise.
    #[test]
    fn residuals_say_how_much_of_an_acceleration_is_error() {
        let by_acceleration = [0.01, 0.03, -0.02, 0.02, 0.0];
        let share = |by: f64| {
            let levels = [0.3, 0.3, -0.1, -0.1, -0.1];
            let residuals: Vec<f64> =
                levels.iter().zip(&by_acceleration).map(|(level, a)| level + by * a).collect();
            share_in_residuals([0..2, 2..5].into_iter(), &by_acceleration, &residuals)
        };
        assert!((share(-0.5) - 0.5).abs() < 1e-12 && share(0.5).abs() < 1e-12);
    }

    /// Monte Carlo: of accelerations with a standard deviation of 3, recorded with errors of 4, the error is 16/25 of what is
    /// recorded, on average; what is left of the error after that is no function of the recording.
    #[test]
    fn expected_error_of_a_recorded_acceleration() {
        let mut stream = RandomStream::new(27, 0);
        let (mut truth, mut error) = (vec![0.0; 200_000], vec![0.0; 200_000]);
        stream.fill(&mut truth);
        stream.fill(&mut error);
        let recorded: Vec<f64> = truth.iter().zip(&error).map(|(t, e)| 3.0 * t + 4.0 * e).collect();
        let variance = recorded.iter().map(|r| r * r).sum::<f64>() / recorded.len() as f64;
        let share = error_share(4.0, variance);
        assert!((share - 16.0 / 25.0).abs() < 0.005, "{share}");
        let left = recorded.iter().zip(&error).map(|(r, e)| r * (4.0 * e - share * r));
        // Its standard error: √(25·(16 − 16²/25)/200 000) = 0.027.
        let product = left.sum::<f64>() / recorded.len() as f64;
        assert!(product.abs() < 5.0 * 0.027, "{product}");
        assert!((error_share(4.0, 1.0) - 1.0).abs() < 1e-15);
    }
}
