//! How tank gauges read against flow meters: what an aircraft's flights have in common, and how far they scatter about it.

use serde::{Deserialize, Serialize};

use crate::priors::{GAUGE_GAIN_DEVIATION, GAUGE_SCATTER_FREEDOM, STUDENT_FREEDOM};

/// How often weights, level and scatter are found from one another. Our choice: they stay to a thousandth after ten.
const STEPS: usize = 30;

/// Information of Student's distribution over that of a normal one of its scale.
const SHARE: f64 = (STUDENT_FREEDOM + 1.0) / (STUDENT_FREEDOM + 3.0);

/// What tank gauges show of clean flights: both kinds of sensors have gains of their own, which are there at all times. Only what
/// changes against this tells a meter from an engine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GaugeLevel {
    /// Flights with gauges.
    pub flights: usize,
    /// What they have in common of ln(gauged/metered fuel).
    pub mean: f64,
    /// Its standard deviation.
    pub deviation: f64,
    /// Scatter from flight to flight, over what is stated of gauges.
    pub scatter: f64,
}

/// What gauges show of one flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GaugedFlight {
    /// ln(gauged/metered fuel).
    pub(crate) value: f64,
    /// Its stated standard deviation.
    pub(crate) deviation: f64,
    /// Share of the flight that counts.
    pub(crate) share: f64,
}

impl GaugeLevel {
    /// Of flights, robustly: Student's distribution about the level, whose information is (ν + 1)/(ν + 3) of that of a normal one of
    /// its scale. What is found and stated of scatter is that of a normal distribution of as much information.
    ///
    /// ```text
    /// y_i ~ t_ν(μ, g·k·s_i),   g² = (ν + 1)/(ν + 3),   μ ~ N(0, σ²),   w_i = (ν + 1)/(ν + (y_i − μ)²/(g·k·s_i)²)
    /// 1/V = 1/σ² + Σ c_i·w_i/(k·s_i)²,   μ = V·Σ c_i·w_i·y_i/(k·s_i)²
    /// k² = (f + Σ c_i·w_i·(y_i − μ)²/(g·s_i)²)/(f + Σ c_i − 1)                                     [diagnosis.62]
    /// ```
    ///
    /// y is ln(gauged/metered) of a flight, s its stated standard deviation, c the share of it that counts; `None` of no flights.
    pub(crate) fn of(flights: &[GaugedFlight]) -> Option<Self> {
        let mut sorted: Vec<f64> = flights.iter().map(|flight| flight.value).collect();
        sorted.sort_by(f64::total_cmp);
        let mut level = Self {
            flights: flights.len(),
            mean: *sorted.get(flights.len() / 2)?,
            deviation: GAUGE_GAIN_DEVIATION,
            scatter: 1.0,
        };
        for _ in 0..STEPS {
            let mut information = GAUGE_GAIN_DEVIATION.powi(-2);
            let (mut sum, mut squares, mut freedom) = (0.0, 0.0, 0.0);
            for flight in flights {
                let counts = flight.share * level.weight(flight);
                let by = counts / (level.scatter * flight.deviation).powi(2);
                information += by;
                sum += by * flight.value;
                squares +=
                    counts * ((flight.value - level.mean) / flight.deviation).powi(2) / SHARE;
                freedom += flight.share;
            }
            level.mean = sum / information;
            level.deviation = information.powf(-0.5);
            // One of the flights' degrees of freedom is the level's.
            let freedom = GAUGE_SCATTER_FREEDOM + (freedom - 1.0).max(0.0);
            level.scatter = ((GAUGE_SCATTER_FREEDOM + squares) / freedom).sqrt();
        }
        Some(level)
    }

    /// Weight of a flight: below 1 far from the level.
    pub(crate) fn weight(&self, flight: &GaugedFlight) -> f64 {
        let over = (flight.value - self.mean) / (self.scatter * flight.deviation);
        (STUDENT_FREEDOM + 1.0) / (STUDENT_FREEDOM + over * over / SHARE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flights(values: &[(f64, f64)]) -> Vec<GaugedFlight> {
        let of = |&(value, deviation): &(f64, f64)| GaugedFlight { value, deviation, share: 1.0 };
        values.iter().map(of).collect()
    }

    /// Values about 1.5 % that scatter as a normal distribution does: quantiles of it.
    fn normal(scatter: f64) -> Vec<(f64, f64)> {
        use statrs::distribution::{ContinuousCDF, Normal};
        let quantile = |k: usize| Normal::standard().inverse_cdf((k as f64 + 0.5) / 40.0);
        (0..40).map(|k| (0.015 + scatter * 0.004 * quantile(k), 0.004)).collect()
    }

    /// The oracle is the same posterior on a grid of level and scale, its density written out (the scale's prior is that of
    /// f squares of 1): numerical integration.
    #[test]
    fn level_is_that_of_the_posterior_on_a_grid() {
        for scatter in [0.5, 1.0, 2.5] {
            let values = normal(scatter);
            let found = GaugeLevel::of(&flights(&values)).unwrap();
            let (mut total, mut mean, mut square) = (0.0, 0.0, 0.0);
            let nu = STUDENT_FREEDOM;
            for at in 0..400 {
                let level = 0.01 + 1e-2 * f64::from(at) / 400.0;
                for step in 0..160 {
                    let scale = (f64::from(step - 80) / 40.0).exp();
                    let mut ln = -0.5 * (level / GAUGE_GAIN_DEVIATION).powi(2)
                        - 0.5 * GAUGE_SCATTER_FREEDOM * (scale.powi(-2) + 2.0 * scale.ln());
                    for (value, deviation) in &values {
                        let over = (value - level) / (scale * SHARE.sqrt() * deviation);
                        ln -= scale.ln() + 0.5 * (nu + 1.0) * (over * over / nu).ln_1p();
                    }
                    let weight = (ln - 80.0).exp();
                    total += weight;
                    mean += weight * level;
                    square += weight * level * level;
                }
            }
            let (mean, square) = (mean / total, square / total);
            let deviation = (square - mean * mean).sqrt();
            assert!((found.mean - mean).abs() < 0.1 * deviation, "{found:?}: {mean}");
            assert!((found.deviation / deviation - 1.0).abs() < 0.1, "{found:?}: {deviation}");
        }
    }

    #[test]
    fn one_absurd_flight_hardly_moves_the_level() {
        let mut values = normal(1.0);
        let before = GaugeLevel::of(&flights(&values)).unwrap();
        values.push((0.7, 0.004));
        let after = GaugeLevel::of(&flights(&values)).unwrap();
        assert!((after.mean - before.mean).abs() < 0.3 * before.deviation, "{before:?} {after:?}");
        let weights: Vec<f64> = flights(&values).iter().map(|one| after.weight(one)).collect();
        assert!(weights[40] < 1e-3, "{weights:?}");
        assert!(weights[20] > 1.0, "{weights:?}");
    }

    /// Oracle: Monte Carlo. Of 2000 sets of 40 and of 10 flights that scatter as stated, or twice as much, the stated deviation is
    /// that of the error of the level: within 15 % of 40 flights (of normal errors Student's fit knows the level by a tenth less than
    /// it says), and of ten, whose scatter is hardly known, within 30 %.
    #[test]
    fn the_stated_deviation_is_that_of_the_error() {
        let mut random = test_support::Random::new(62, 0);
        for (flights, scatter, tolerance) in
            [(40, 1.0, 0.15), (40, 2.0, 0.15), (10, 1.0, 0.3), (10, 2.0, 0.3)]
        {
            let mut square = 0.0;
            for _ in 0..2000 {
                let of = |_| GaugedFlight {
                    value: random.normal(0.003, 0.004 * scatter),
                    deviation: 0.004,
                    share: 1.0,
                };
                let set: Vec<GaugedFlight> = (0..flights).map(of).collect();
                let found = GaugeLevel::of(&set).unwrap();
                square += ((found.mean - 0.003) / found.deviation).powi(2) / 2000.0;
            }
            let over = square.sqrt();
            assert!((over - 1.0).abs() < tolerance, "{flights} flights, scatter {scatter}: {over}");
        }
    }

    #[test]
    fn flights_without_gauges_have_no_level() {
        assert_eq!(GaugeLevel::of(&[]), None);
    }
}
