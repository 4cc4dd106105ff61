//! How much of what fuel flow and N2 err by within a flight they err by together.
//!
//! Channels are learnt one after the other, so that each has its own noise; what the aircraft file's sensors state of their
//! correlation is not what flights show. A meter that drifts moves fuel flow alone, an acceleration that is off both.

use crate::learning::channel::LearntChannel;
use crate::learning::dials::Dials;
use crate::learning::outliers::Weights;
use crate::priors::NOISE_FREEDOM;
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::signals::channels::ByChannel;
use crate::thresholds::LEAST_CORRELATION;

/// What a learnt channel leaves of every segment in which it is recorded, in the order of the segments.
#[derive(Clone, Copy)]
pub(super) struct Left<'a> {
    channel: usize,
    values: &'a [f64],
    weights: &'a Weights,
    dials: Dials,
}

/// A segment: what is left of fuel flow and N2, and what both are believed to err by.
#[derive(Clone, Debug)]
struct Pair {
    left: [f64; 2],
    /// Variances of what the segment has of its own, and their covariance.
    variances: [f64; 2],
    covariance: f64,
    /// Loadings of both on what the flight has in common.
    common: Vec<[f64; 2]>,
}

/// Sums over segments, each less the mean of its flight.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    squares: [f64; 2],
    product: f64,
    /// The same as they are believed to be: squares, product by what flights have in common, product by the segments' own.
    believed: [f64; 2],
    of_common: f64,
    of_own: f64,
    /// Segments less flights.
    freedom: f64,
}

/// The factor on the stated covariance of fuel flow and N2 within a flight.
///
/// ```text
/// κ = (ν κ' + ν0)/(ν + ν0),   κ' = (r √(T_u T_v) − T_c)/T_uv,   r = Σ u v/√(Σ u² Σ v²)                  [baseline.8]
/// ```
///
/// u and v are what is left of both, less the mean of their flight, `T_u` and `T_v` what Σu² and Σv² should be by the noise that
/// each has learnt, `T_c` and `T_uv` what Σuv should be by what flights have in common and by the segments' own errors; ν segments
/// less flights, and what is stated counts as ν0 [`NOISE_FREEDOM`] segments. Both are shortened by what was fitted to them, so that r
/// alone is asked. 1 where hardly any correlation is stated.
pub(super) fn correlation_factor(
    data: &PreparedFlights<'_>,
    fuel_flow: Left<'_>,
    n2: Left<'_>,
) -> f64 {
    let channels = [fuel_flow, n2];
    let values = channels.map(|left| left.by_segment(data));
    let mut sums = Sums::default();
    for flight in &data.flights {
        let of = |at: usize| {
            let left = [values[0][at]?, values[1][at]?];
            Some(Pair::new(&data.segments[at], left, channels))
        };
        sums.add(&flight.segments.clone().filter_map(of).collect::<Vec<Pair>>());
    }
    sums.factor()
}

impl<'a> Left<'a> {
    /// Of a channel that was learnt.
    pub(super) fn of(channel: usize, learnt: &'a LearntChannel) -> Self {
        let dials = learnt.posterior.dials;
        Self { channel, values: &learnt.left, weights: &learnt.weights, dials }
    }

    /// By segment, outliers weighed down; `None` where the channel is not recorded.
    fn by_segment(&self, data: &PreparedFlights<'_>) -> Vec<Option<f64>> {
        let mut values = self.values.iter().zip(&self.weights.rows);
        let mut next = || values.next().map(|(left, weight)| left * weight.sqrt());
        let segments = data.segments.iter();
        segments.map(|row| if row.is_recorded[self.channel] { next() } else { None }).collect()
    }
}

impl Pair {
    fn new(row: &SegmentRow, left: [f64; 2], channels: [Left<'_>; 2]) -> Self {
        let [a, b] = channels.map(|of| row.noise.factor[of.channel].map(|l| of.dials.within * l));
        let product = |a: &ByChannel, b: &ByChannel| a.iter().zip(b).map(|(a, b)| a * b).sum();
        let common = row.noise.common.iter();
        let common = common.map(|u| channels.map(|of| of.dials.between * u[of.channel]));
        Self {
            left,
            variances: [product(&a, &a), product(&b, &b)],
            covariance: product(&a, &b),
            common: common.collect(),
        }
    }
}

impl Sums {
    /// Adds the segments of a flight.
    fn add(&mut self, pairs: &[Pair]) {
        let count = pairs.len() as f64;
        if pairs.len() < 2 {
            return;
        }
        let [[uu, uv], [_, vv]] = products_about_mean(&pairs.iter().map(|pair| pair.left));
        self.squares[0] += uu;
        self.squares[1] += vv;
        self.product += uv;
        let own = (count - 1.0) / count;
        for pair in pairs {
            self.believed[0] += own * pair.variances[0];
            self.believed[1] += own * pair.variances[1];
            self.of_own += own * pair.covariance;
        }
        for at in 0..pairs[0].common.len() {
            let loadings =
                pairs.iter().map(|pair| pair.common.get(at).copied().unwrap_or_default());
            let [[uu, uv], [_, vv]] = products_about_mean(&loadings);
            self.believed[0] += uu;
            self.believed[1] += vv;
            self.of_common += uv;
        }
        self.freedom += count - 1.0;
    }

    fn factor(&self) -> f64 {
        let believed = (self.believed[0] * self.believed[1]).sqrt();
        let left = (self.squares[0] * self.squares[1]).sqrt();
        if self.of_own < LEAST_CORRELATION * believed || left <= 0.0 {
            return 1.0;
        }
        let found = (self.product / left * believed - self.of_common) / self.of_own;
        (self.freedom * found + NOISE_FREEDOM) / (self.freedom + NOISE_FREEDOM)
    }
}

/// Sums of squares and products of two values, each less its mean.
fn products_about_mean(values: &(impl Iterator<Item = [f64; 2]> + Clone)) -> [[f64; 2]; 2] {
    let count = values.clone().count() as f64;
    let mean = |k: usize| values.clone().map(|value| value[k]).sum::<f64>() / count;
    let means = [mean(0), mean(1)];
    let of = |i: usize, j: usize| {
        values.clone().map(|value| (value[i] - means[i]) * (value[j] - means[j])).sum()
    };
    [[of(0, 0), of(0, 1)], [of(1, 0), of(1, 1)]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values (−1, 0, 1) and the same plus twice (−1, 2, −1), which has the product 0 with it: Σu² = 2, Σv² = 2 + 24, Σuv = 2,
    /// r = 2/√52. Believed: variances 1 and 13, so that `r√(T_u T_v)` of a flight is 2/√52·√(2·26) = 2; own covariance 1.25,
    /// which makes 2.5, and 0.5 in common, from loadings (½, 0, −½) and (1, 0, −1)/2.
    #[test]
    fn correlation_is_drawn_to_what_is_stated_by_forty_segments() {
        let flight = |level: f64| {
            let pair = |u: f64, w: f64| Pair {
                left: [level + u, 7.0 - level + u + 2.0 * w],
                variances: [0.75, 12.75],
                covariance: 1.25,
                common: vec![[-0.5 * u, -0.5 * u], [1.0, 3.0]],
            };
            [pair(-1.0, -1.0), pair(0.0, 2.0), pair(1.0, -1.0)]
        };
        let mut sums = Sums::default();
        for number in 0..20 {
            sums.add(&flight(f64::from(number)));
        }
        // By hand: (2 − 0.5)/2.5 = 0.6 of 40 segments less flights, and 1 of as many.
        assert!((sums.factor() - 0.8).abs() < 1e-12, "{}", sums.factor());
        // One segment of a flight says nothing, and nor does a correlation of which nothing is stated.
        let mut alone = sums;
        alone.add(&flight(100.0)[..1]);
        assert!((alone.factor() - sums.factor()).abs() < 1e-15);
        let unstated = Sums { of_own: 0.0, ..sums };
        assert!((unstated.factor() - 1.0).abs() < 1e-15);
    }
}
