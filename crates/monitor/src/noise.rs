//! How much flights scatter when nothing changes: within a flight, between flights, and whether successive flights err
//! alike. Estimated from differences of neighbours, which neither a step nor a trend disturbs.

use crate::series::Series;
use crate::settings::{
    BETWEEN_PRIOR_COUNT, BETWEEN_PRIOR_PERCENT, CORRELATION_ERROR, CORRELATION_SEEN,
    FEWEST_FLIGHTS_OF_A_CORRELATION, LARGEST_CORRELATION, MEDIAN_REACH, RobustScale,
    SCALE_OF_CORRELATION, SCALE_OF_SCATTER, STUDENT_DEGREES_OF_FREEDOM, WITHIN_PRIOR_COUNT,
    WITHIN_PRIOR_PERCENT,
};

/// Ratio of a normal distribution's standard deviation to its median absolute value, 1/Φ⁻¹(3/4).
const NORMAL_MEDIAN_FACTOR: f64 = 1.482_602_218_505_602;
/// Rounds of the robust scale; each brings it nearer by a factor of ten or more.
const ROUNDS: usize = 20;

/// The scatter of a tail's flights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Standard deviation of a segment about its flight, %.
    pub within_flight_percent: f64,
    /// Standard deviation of what is common to a flight (heating value, load sheet), %.
    pub between_flights_percent: f64,
    /// Correlation of successive flights' errors, 0 or above.
    pub correlation: f64,
}

impl Noise {
    /// The noise of a series.
    ///
    /// ```text
    /// s²within = (ν₀·s₀² + Σ scatter)/(ν₀ + Σ(n − 1))                                       [monitoring.2]
    /// v₁ = ½·scale²(y(i+1) − y(i)),   s²between = v₁/(1 − ρ) − s²within·mean(1/n)             [monitoring.3]
    /// r = v₂/v₁ − 1,   ρ = max(0, r − (2·1.46/√n)²/r) ≤ 0.8;   v₂ of y(i+2) − y(i)                  [monitoring.4]
    /// ```
    ///
    /// The garrote (Breiman 1995, Technometrics 37, 373–384) leaves a large correlation nearly as it is, and keeps nothing of
    /// one that chance explains: a white series that is taken for a correlated one loses half of its flights.
    ///
    /// The scale is Huber's (proposal 2): a step, or an odd flight, is one or two differences out of all. That of s has a limit of 1.5,
    /// those whose ratio is r one of 2.5.
    #[must_use]
    pub fn estimate(series: &Series) -> Self {
        let flights = series.flights();
        let within = {
            let freedom: f64 = flights.iter().map(|flight| f64::from(flight.segments() - 1)).sum();
            let scatter: f64 =
                flights.iter().map(super::series::FlightDeviation::scatter_percent2).sum();
            let prior = WITHIN_PRIOR_COUNT * WITHIN_PRIOR_PERCENT.powi(2);
            (prior + scatter) / (WITHIN_PRIOR_COUNT + freedom)
        };
        let near = half_squared_scale(&differences(series, 1), SCALE_OF_SCATTER);
        let correlation = correlation(series);
        let count = flights.len().saturating_sub(1) as f64;
        let reciprocal: f64 = flights.iter().map(|flight| 1.0 / f64::from(flight.segments())).sum();
        let found = (near / (1.0 - correlation)
            - within * reciprocal / flights.len().max(1) as f64)
            .max(0.0);
        let prior = BETWEEN_PRIOR_COUNT * BETWEEN_PRIOR_PERCENT.powi(2);
        let between = (prior + count * found) / (BETWEEN_PRIOR_COUNT + count);
        Self {
            within_flight_percent: within.sqrt(),
            between_flights_percent: between.sqrt(),
            correlation,
        }
    }

    /// Variance of a flight's mean deviation, %².
    ///
    /// ```text
    /// v = s²between + s²within/n                                                              [monitoring.1]
    /// ```
    #[must_use]
    pub fn flight_variance_percent2(&self, segments: u32) -> f64 {
        self.between_flights_percent.powi(2)
            + self.within_flight_percent.powi(2) / f64::from(segments.max(1))
    }

    /// Factor on the variance of a mean of many flights whose errors follow a first-order autoregression,
    /// (1 + ρ)/(1 − ρ).
    #[must_use]
    pub fn inflation(&self) -> f64 {
        (1.0 + self.correlation) / (1.0 - self.correlation)
    }

    /// Weight of each flight in a mean over many: one over its variance, correlation included, and less for a flight that
    /// is far from the median of its neighbours.
    ///
    /// ```text
    /// w = min(1, (ν + 1)/(ν + z²))/(v·(1 + ρ)/(1 − ρ)),  z = (y − median of 11)/√v            [monitoring.5]
    /// ```
    ///
    /// A median keeps the edge of a step; at the end of a series a single odd flight is doubted until its successors confirm
    /// it.
    #[must_use]
    pub fn weights(&self, series: &Series) -> Vec<f64> {
        let flights = series.flights();
        let mut neighbours = Vec::with_capacity(2 * MEDIAN_REACH + 1);
        flights
            .iter()
            .enumerate()
            .map(|(index, flight)| {
                let from = index.saturating_sub(MEDIAN_REACH);
                let to = (index + MEDIAN_REACH + 1).min(flights.len());
                neighbours.clear();
                neighbours.extend(
                    flights[from..to].iter().map(super::series::FlightDeviation::deviation_percent),
                );
                let variance = self.flight_variance_percent2(flight.segments());
                let distance = flight.deviation_percent() - median(&mut neighbours);
                let doubt = (STUDENT_DEGREES_OF_FREEDOM + 1.0)
                    / (STUDENT_DEGREES_OF_FREEDOM + distance * distance / variance);
                doubt.min(1.0) / (variance * self.inflation())
            })
            .collect()
    }
}

fn differences(series: &Series, lag: usize) -> Vec<f64> {
    let flights = series.flights();
    let later = flights.iter().skip(lag);
    later.zip(flights).map(|(b, a)| b.deviation_percent() - a.deviation_percent()).collect()
}

fn correlation(series: &Series) -> f64 {
    let flights = series.len();
    let scale = |lag: usize| half_squared_scale(&differences(series, lag), SCALE_OF_CORRELATION);
    let near = scale(1);
    if flights < FEWEST_FLIGHTS_OF_A_CORRELATION || near <= 0.0 {
        return 0.0;
    }
    let found = scale(2) / near - 1.0;
    let unseen = CORRELATION_SEEN * CORRELATION_ERROR / (flights as f64).sqrt();
    if found <= unseen {
        return 0.0;
    }
    (found - unseen * unseen / found).min(LARGEST_CORRELATION)
}

/// Half the squared robust scale of differences: the variance of what they are differences of. 0 without a difference.
fn half_squared_scale(differences: &[f64], scale: RobustScale) -> f64 {
    if differences.is_empty() {
        return 0.0;
    }
    let mut sizes: Vec<f64> = differences.iter().map(|value| value.abs()).collect();
    let mut square = (NORMAL_MEDIAN_FACTOR * median(&mut sizes)).powi(2);
    for _ in 0..ROUNDS {
        let most = scale.limit * scale.limit * square;
        let sum: f64 = differences.iter().map(|value| (value * value).min(most)).sum();
        square = sum / (differences.len() as f64 * scale.consistency);
    }
    square / 2.0
}

/// The median; the values are reordered. 0 without a value.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    let count = values.len();
    if count == 0 {
        return 0.0;
    }
    values.sort_unstable_by(f64::total_cmp);
    if count % 2 == 1 {
        values[count / 2]
    } else {
        values[count / 2 - 1].midpoint(values[count / 2])
    }
}

#[cfg(test)]
mod tests {
    use flight::Timestamp;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::series::FlightDeviation;

    /// Oracle: numerical integration of min(z², c²) over the normal density, and the quartile of the distribution from its table,
    /// 0.6745.
    #[test]
    fn constants_of_the_robust_scale() {
        let step = 1e-4;
        for scale in [SCALE_OF_SCATTER, SCALE_OF_CORRELATION] {
            let integral: f64 = (-100_000..100_000)
                .map(|k| (f64::from(k) + 0.5) * step)
                .map(|z| (z * z).min(scale.limit * scale.limit) * (-0.5 * z * z).exp() * step)
                .sum::<f64>()
                / core::f64::consts::TAU.sqrt();
            assert!((integral - scale.consistency).abs() < 1e-6, "{integral}");
        }
        assert!((1.0 / NORMAL_MEDIAN_FACTOR - 0.6745).abs() < 5e-5);
    }

    /// By hand: one flight in twelve is off by 8 standard deviations, so that one difference in six is. The scatter that is found
    /// is at most that of the others and half of it.
    #[test]
    fn odd_flights_hardly_widen_the_scatter() {
        let mut random = ChaCha8Rng::seed_from_u64(8);
        let mut total = 0.0;
        for _ in 0..100 {
            let flights = (0..120).map(|flight| {
                let normal: f64 = StandardNormal.sample(&mut random);
                let odd = if flight % 12 == 5 { 8.0 } else { 0.0 };
                let time = Timestamp::from_second(86_400 * flight).unwrap();
                FlightDeviation::of_segments(time, &[0.6 * (normal + odd); 10]).unwrap()
            });
            let found = Noise::estimate(&Series::new(flights.collect()).unwrap());
            total += found.between_flights_percent / 100.0;
        }
        assert!((0.6..0.9).contains(&total), "{total}");
    }

    /// Oracle: Monte Carlo. 600 white series of 200 flights give r a standard deviation of 1.46/√200, known to 3 %; one in
    /// forty or so is taken for correlated, and a series of correlation 0.5 keeps nearly all of it.
    #[test]
    fn error_of_the_correlation_by_monte_carlo() {
        const FLIGHTS: i64 = 200;
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let mut series = |correlation: f64| {
            let mut before = 0.0;
            let flights = (0..FLIGHTS).map(|flight| {
                let normal: f64 = StandardNormal.sample(&mut random);
                before = correlation * before + (1.0 - correlation * correlation).sqrt() * normal;
                let time = Timestamp::from_second(86_400 * flight).unwrap();
                FlightDeviation::of_segments(time, &[before]).unwrap()
            });
            Series::new(flights.collect()).unwrap()
        };
        let (mut square, mut believed) = (0.0, 0);
        for _ in 0..600 {
            let white = series(0.0);
            let scale =
                |lag: usize| half_squared_scale(&differences(&white, lag), SCALE_OF_CORRELATION);
            square += (scale(2) / scale(1) - 1.0).powi(2);
            believed += usize::from(correlation(&white) > 0.0);
        }
        let error = (square / 600.0 * FLIGHTS as f64).sqrt();
        assert!((error / CORRELATION_ERROR - 1.0).abs() < 0.09, "{error}");
        assert!((6..30).contains(&believed), "{believed} of 600");
        let kept: f64 = (0..100).map(|_| correlation(&series(0.5))).sum();
        assert!((0.35..0.52).contains(&(kept / 100.0)), "{kept}");
    }

    /// Oracle: quantiles of the normal distribution have the variance 1, and one in twenty of them far off adds what the
    /// limit lets through: 0.05·2.5²/0.95/0.97756 in the first round, a third of the whole in the end.
    #[test]
    fn the_robust_scale_of_normal_quantiles() {
        // Numerical integration of the density up to each quantile.
        let mut quantiles = Vec::new();
        let (mut z, mut below) = (-8.0_f64, 0.0);
        let step = 1e-4;
        while quantiles.len() < 2000 {
            below += (-0.5 * z * z).exp() * step / core::f64::consts::TAU.sqrt();
            z += step;
            if below >= (quantiles.len() as f64 + 0.5) / 2000.0 {
                quantiles.push(z);
            }
        }
        let clean = half_squared_scale(&quantiles, SCALE_OF_CORRELATION);
        assert!((clean - 0.5).abs() < 0.004, "{clean}");
        for quantile in quantiles.iter_mut().step_by(20) {
            *quantile = 1000.0;
        }
        let disturbed = half_squared_scale(&quantiles, SCALE_OF_CORRELATION);
        assert!(clean < disturbed && disturbed < 1.5 * clean, "{disturbed}");
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "whole and half numbers are exact")]
    fn median_by_hand() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(median(&mut []), 0.0);
    }
}
