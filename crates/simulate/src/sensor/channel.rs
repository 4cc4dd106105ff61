//! One channel: bias, gain, drift, noise, lag, rounding, and its faults.

use serde::{Deserialize, Serialize};

use crate::random::Stream;

/// The errors of one channel: measured = true·(1 + gain) + bias, rounded.
///
/// Every part is the sum of a constant, a draw for the tail, a draw for the flight, a drift and a draw for the sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ChannelSensor {
    /// Constant bias.
    pub bias: f64,
    /// Standard deviation of the tail's bias.
    pub tail_sd: f64,
    /// Standard deviation of the flight's bias.
    pub flight_sd: f64,
    /// Standard deviation of the bias that drifts within a flight.
    #[serde(alias = "slow_sd")]
    pub drift_sd: f64,
    /// Standard deviation of a sample's noise.
    pub noise_sd: f64,
    /// Constant gain error, relative.
    pub gain: f64,
    /// Standard deviation of the tail's gain error.
    pub gain_tail_sd: f64,
    /// Standard deviation of the flight's gain error.
    pub gain_flight_sd: f64,
    /// Standard deviation of the gain error that drifts within a flight.
    #[serde(alias = "gain_slow_sd")]
    pub gain_drift_sd: f64,
    /// Standard deviation of a sample's relative noise.
    pub gain_noise_sd: f64,
    /// Time constant of the sensor, s.
    pub lag_s: f64,
    /// Step of the recorded number; 0 does not round.
    pub resolution: f64,
}

/// Time constant of the drift within a flight, a first-order Gauss–Markov process, s: our choice, longer than a segment.
pub const DRIFT_TIME_CONSTANT_S: f64 = 1200.0;

/// Faults of the recording.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Faults {
    /// Probability that a sample is missing altogether.
    pub missing_sample: f64,
    /// Probability that an optional column has no value in a sample.
    pub drop_out: f64,
    /// Stuck values per hour: one channel keeps its last value.
    pub stuck_per_h: f64,
    /// Mean length of a stuck value, min.
    pub stuck_min: f64,
}

/// The errors of one channel in one flight.
#[derive(Clone, Debug)]
pub(crate) struct Channel {
    sensor: ChannelSensor,
    bias: f64,
    gain: f64,
    drifting_bias: f64,
    drifting_gain: f64,
}

impl Channel {
    /// Draws the parts that are constant for the tail and for the flight. Every channel draws the same number of values
    /// whatever its sizes, so that switching one error on changes no other draw.
    pub(crate) fn draw(
        sensor: &ChannelSensor,
        of_tail: &mut Stream,
        of_flight: &mut Stream,
    ) -> Self {
        let bias =
            sensor.bias + sensor.tail_sd * of_tail.normal() + sensor.flight_sd * of_flight.normal();
        let gain = sensor.gain
            + sensor.gain_tail_sd * of_tail.normal()
            + sensor.gain_flight_sd * of_flight.normal();
        let drifting_bias = sensor.drift_sd * of_flight.normal();
        let drifting_gain = sensor.gain_drift_sd * of_flight.normal();
        Self { sensor: *sensor, bias, gain, drifting_bias, drifting_gain }
    }

    /// Advances the drifting errors by an interval: a first-order Gauss–Markov process.
    pub(crate) fn advance_drift(&mut self, interval_s: f64, random: &mut Stream) {
        let keep = (-interval_s / DRIFT_TIME_CONSTANT_S).exp();
        let fresh = (1.0 - keep * keep).sqrt();
        self.drifting_bias =
            keep * self.drifting_bias + fresh * self.sensor.drift_sd * random.normal();
        self.drifting_gain =
            keep * self.drifting_gain + fresh * self.sensor.gain_drift_sd * random.normal();
    }

    /// Without the noise of a sample: what a meter integrates.
    pub(crate) fn steady(&self, value: f64) -> f64 {
        value * (1.0 + self.gain + self.drifting_gain) + self.bias + self.drifting_bias
    }

    /// With it, not rounded.
    pub(crate) fn measure(&self, value: f64, random: &mut Stream) -> f64 {
        let relative = self.sensor.gain_noise_sd * random.normal();
        self.steady(value) * (1.0 + relative) + self.sensor.noise_sd * random.normal()
    }

    /// Share of a step that a lagging sensor follows.
    pub(crate) fn lag_share(&self, step_s: f64) -> f64 {
        if self.sensor.lag_s > 0.0 { 1.0 - (-step_s / self.sensor.lag_s).exp() } else { 1.0 }
    }

    pub(crate) fn round(&self, value: f64) -> f64 {
        round_to(value, self.sensor.resolution)
    }
}

/// To the nearest multiple of a step; 0 leaves the value unchanged.
pub(crate) fn round_to(value: f64, resolution: f64) -> f64 {
    if resolution > 0.0 {
        let steps = (value / resolution).round();
        // A step like 0.1 has no exact double, its inverse often has: the quotient prints without a tail of digits.
        let inverse = (1.0 / resolution).round();
        if (inverse * resolution - 1.0).abs() < 1e-12 {
            steps / inverse
        } else {
            steps * resolution
        }
    } else {
        value
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact by construction")]
mod tests {
    use super::*;
    use crate::random::{Purpose, Streams};

    fn draw(sensor: &ChannelSensor, flight: usize) -> (Channel, Stream) {
        let mut tail = Streams::of_tail(1, "T").stream(Purpose::SensorsOfTail);
        let mut random = Streams::of_flight(1, "T", flight).stream(Purpose::Sensors);
        (Channel::draw(sensor, &mut tail, &mut random), random)
    }

    #[test]
    fn bias_gain_noise_and_rounding_are_what_they_say() {
        let sensor =
            ChannelSensor { bias: 2.0, gain: 0.01, noise_sd: 0.5, ..ChannelSensor::default() };
        let (channel, mut random) = draw(&sensor, 0);
        let n = 20_000;
        let values: Vec<f64> = (0..n).map(|_| channel.measure(100.0, &mut random)).collect();
        let mean = values.iter().sum::<f64>() / f64::from(n);
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / f64::from(n - 1);
        // 100·1.01 + 2 = 103, standard error 0.5/√20000 = 0.0035.
        assert!((mean - 103.0).abs() < 0.015, "{mean}");
        assert!((variance.sqrt() - 0.5).abs() < 0.01);
        assert_eq!(round_to(43_008.37, 1.0), 43_008.0);
        assert_eq!(round_to(0.80269, 0.0005), 0.8025);
        assert_eq!(round_to(-0.06, 0.1).to_bits(), (-0.1_f64).to_bits());
        assert_eq!(round_to(1234.0, 10.0), 1230.0);
    }

    #[test]
    fn flights_differ_tails_keep() {
        let sensor = ChannelSensor { tail_sd: 1.0, ..ChannelSensor::default() };
        assert_eq!(draw(&sensor, 0).0.steady(5.0), draw(&sensor, 1).0.steady(5.0));
        let sensor = ChannelSensor { flight_sd: 1.0, ..ChannelSensor::default() };
        let spread: f64 =
            (0..2000).map(|f| draw(&sensor, f).0.steady(0.0).powi(2)).sum::<f64>() / 2000.0;
        assert!((spread.sqrt() - 1.0).abs() < 0.07, "{spread}");
    }

    #[test]
    fn drift_keeps_its_size_and_forgets_in_its_time_constant() {
        let sensor = ChannelSensor { drift_sd: 1.0, ..ChannelSensor::default() };
        let (mut channel, mut random) = draw(&sensor, 0);
        let series: Vec<f64> = (0..200_000)
            .map(|_| {
                channel.advance_drift(60.0, &mut random);
                channel.steady(0.0)
            })
            .collect();
        let n = series.len() as f64;
        let variance = series.iter().map(|v| v * v).sum::<f64>() / n;
        let lag = 20;
        assert_eq!(DRIFT_TIME_CONSTANT_S, 60.0 * 20.0);
        let covariance = series.windows(lag + 1).map(|w| w[0] * w[lag]).sum::<f64>() / n;
        assert!((variance - 1.0).abs() < 0.05, "{variance}");
        // e⁻¹ after one time constant.
        assert!(
            (covariance / variance - (-1.0_f64).exp()).abs() < 0.05,
            "{}",
            covariance / variance
        );
    }
}
