//! What errs alike in neighbouring segments of a flight, and less so in distant ones.

use crate::signals::channels::{ByChannel, MAXIMUM_CHANNELS};
use crate::signals::noise::{SegmentNoise, Statistics};

/// Adds what wanders within a flight to what its segments have in common, one loading a segment each: the flow meters, and
/// air data: a share s of what they err by from segment to segment.
///
/// ```text
/// cov(i, j) = σ²/n·exp(−|t_i − t_j|/τ),  n engines                                    [diagnosis.47]
/// cov(i, j) = L_i L_jᵀ·exp(−|t_i − t_j|/τ),  L_i L_iᵀ = s·Σ_s J_s J_sᵀ σ_s² at a segment  [diagnosis.58]
/// ```
///
/// `times_s` rise.
pub(crate) fn add_wander(
    noises: &mut [&mut SegmentNoise],
    times_s: &[f64],
    statistics: &Statistics,
    engines: usize,
) {
    let meters = statistics.drift();
    if meters.percent > 0.0 {
        let deviation = meters.percent / 100.0 / (engines.max(1) as f64).sqrt();
        let mut of_meters = [0.0; MAXIMUM_CHANNELS];
        of_meters[0] = deviation;
        add_markov(noises, times_s, meters.time_s, |_| of_meters);
    }
    for source in 0..MAXIMUM_CHANNELS {
        if noises.iter().any(|noise| noise.air_data.iter().any(|row| row[source] != 0.0)) {
            let of_source = |noise: &SegmentNoise| noise.air_data.map(|row| row[source]);
            add_markov(noises, times_s, statistics.air_data_drift.time_s, of_source);
        }
    }
}

/// Adds the loadings of one process, as large at each segment as is said.
///
/// Each value is ρ times the one before plus √(1 − ρ²) times something new, ρ the likeness of neighbours, which is the Cholesky
/// factor of its correlations row by row.
fn add_markov(
    noises: &mut [&mut SegmentNoise],
    times_s: &[f64],
    time_s: f64,
    size: impl Fn(&SegmentNoise) -> ByChannel,
) {
    let mut weights = vec![0.0; times_s.len()];
    for (index, noise) in noises.iter_mut().enumerate() {
        let likeness = match index {
            0 => 0.0,
            _ => (-(times_s[index] - times_s[index - 1]).abs() / time_s).exp(),
        };
        for weight in &mut weights {
            *weight *= likeness;
        }
        weights[index] = (1.0 - likeness * likeness).max(0.0).sqrt();
        let size = size(noise);
        noise.common.extend(weights.iter().map(|weight| size.map(|value| value * weight)));
    }
}

#[cfg(test)]
mod tests {
    use perf_model::aircraft::{AirDataDrift, FlightBias, FuelFlowDrift, SensorDeviations};

    use super::*;
    use crate::signals::noise::NoiseFactors;

    #[test]
    fn wander_has_the_covariance_it_states() {
        let noise = || SegmentNoise {
            factor: [[0.0; MAXIMUM_CHANNELS]; MAXIMUM_CHANNELS],
            common: vec![],
            air_data: [[0.0; MAXIMUM_CHANNELS]; MAXIMUM_CHANNELS],
            acceleration: [0.0; MAXIMUM_CHANNELS],
        };
        let (mut a, mut b, mut c) = (noise(), noise(), noise());
        let statistics = Statistics {
            factors: NoiseFactors::default(),
            flight_bias: FlightBias::none(),
            fuel_flow_drift: FuelFlowDrift { percent: 0.2, time_s: 1200.0 },
            air_data_drift: AirDataDrift::default(),
        };
        add_wander(&mut [&mut a, &mut b, &mut c], &[0.0, 600.0, 2400.0], &statistics, 2);
        let covariance = |x: &SegmentNoise, y: &SegmentNoise| {
            x.common.iter().zip(&y.common).map(|(x, y)| x[0] * y[0]).sum::<f64>()
        };
        // By hand: 0.002²/2 = 2e-6, e^(−1/2) = 0.606531, e^(−3/2) = 0.223130, e^(−2) = 0.135335.
        for (found, expected) in [
            (covariance(&a, &a), 2e-6),
            (covariance(&b, &b), 2e-6),
            (covariance(&c, &c), 2e-6),
            (covariance(&a, &b), 2e-6 * 0.606531),
            (covariance(&b, &c), 2e-6 * 0.223130),
            (covariance(&a, &c), 2e-6 * 0.135335),
        ] {
            assert!((found - expected).abs() < 1e-11, "{found} {expected}");
        }
    }

    /// By hand: factors (2, 0 | 1, 3) and (4, 0 | 0, 5) a correlation time apart have e⁻¹·(2·4, 2·0 | 1·4, 1·0 + 3·5) in common,
    /// and each has its own product with itself.
    #[test]
    fn air_data_wander_in_all_channels_together() {
        let noise = |air_data: [[f64; 2]; 2]| {
            let mut own = [[0.0; MAXIMUM_CHANNELS]; MAXIMUM_CHANNELS];
            for (row, from) in own.iter_mut().zip(air_data) {
                row[..2].copy_from_slice(&from);
            }
            SegmentNoise {
                factor: [[0.0; MAXIMUM_CHANNELS]; MAXIMUM_CHANNELS],
                common: vec![],
                air_data: own,
                acceleration: [0.0; MAXIMUM_CHANNELS],
            }
        };
        let mut a = noise([[2.0, 0.0], [1.0, 3.0]]);
        let mut b = noise([[4.0, 0.0], [0.0, 5.0]]);
        let sensors = SensorDeviations {
            air_data_drift: AirDataDrift { share: 1.0, time_s: 900.0 },
            ..SensorDeviations::default()
        };
        let statistics = Statistics::of(&NoiseFactors::default(), &sensors);
        add_wander(&mut [&mut a, &mut b], &[100.0, 1000.0], &statistics, 2);
        let covariance = |x: &SegmentNoise, i: usize, y: &SegmentNoise, j: usize| {
            x.common.iter().zip(&y.common).map(|(x, y)| x[i] * y[j]).sum::<f64>()
        };
        let likeness = (-1.0_f64).exp();
        for (i, j, together, of_b) in
            [(0, 0, 8.0, 16.0), (0, 1, 0.0, 0.0), (1, 0, 4.0, 0.0), (1, 1, 15.0, 25.0)]
        {
            assert!((covariance(&a, i, &b, j) - together * likeness).abs() < 1e-12);
            assert!((covariance(&b, i, &b, j) - of_b).abs() < 1e-12);
        }
    }
}
