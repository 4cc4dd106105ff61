//! How much better a step over a region fits the gap, with the noise that flights have in common taken into account.

use faer::Mat;

use crate::math::cholesky::Cholesky;
use crate::place::draws::NoiseLevel;
use crate::search::system::WhitenedSystem;

/// Products aᵀC⁻¹b over all flights, C the noise of fuel flow: a segment's own, and what its flight has in common.
pub(crate) struct Noise<'a> {
    flights: Vec<OfFlight>,
    system: &'a WhitenedSystem<'a>,
}

struct OfFlight {
    /// 1/σ² of each segment.
    weights: Vec<f64>,
    /// Loadings of what is common, scaled by 1/σ²: one row per segment.
    loadings: Vec<Vec<f64>>,
    /// Of 1 + UᵀD⁻¹U.
    inner: Option<Cholesky>,
}

/// A vector ready for products: C⁻¹·v needs its loadings only once.
struct Projected {
    /// Of each flight: L⁻¹·UᵀD⁻¹v.
    common: Vec<Vec<f64>>,
}

impl<'a> Noise<'a> {
    pub(crate) fn new(system: &'a WhitenedSystem<'a>, level: NoiseLevel) -> Self {
        let data = system.data;
        let flights = data
            .flights
            .iter()
            .map(|flight| {
                let rows = &data.segments[flight.segments.clone()];
                let scale = level.factor * level.factor;
                let weights: Vec<f64> =
                    rows.iter().map(|row| 1.0 / (scale * row.noise.factor[0][0].powi(2))).collect();
                let plain: Vec<Vec<f64>> = rows
                    .iter()
                    .map(|row| {
                        let common = row.noise.common.iter().map(|u| level.factor * u[0]);
                        common.chain([level.scatter]).collect()
                    })
                    .collect();
                let rank = plain.first().map_or(0, Vec::len);
                let inner = Mat::from_fn(rank, rank, |i, j| {
                    let product: f64 =
                        plain.iter().zip(&weights).map(|(u, w)| u[i] * u[j] * w).sum();
                    product + if i == j { 1.0 } else { 0.0 }
                });
                let loadings = plain
                    .iter()
                    .zip(&weights)
                    .map(|(u, w)| u.iter().map(|u| u * w).collect())
                    .collect();
                OfFlight { weights, loadings, inner: Cholesky::new(&inner) }
            })
            .collect();
        Self { flights, system }
    }

    pub(crate) const fn system(&self) -> &'a WhitenedSystem<'a> {
        self.system
    }

    /// C⁻¹ times the values of one flight's segments, any number of draws side by side.
    pub(crate) fn weigh(&self, flight: usize, values: &mut [Vec<f64>]) {
        let OfFlight { weights, loadings, inner } = &self.flights[flight];
        let rank = loadings.first().map_or(0, Vec::len);
        let width = values.first().map_or(0, Vec::len);
        let mut common = Mat::<f64>::zeros(rank, width);
        for (loading, values) in loadings.iter().zip(&*values) {
            for (k, u) in loading.iter().enumerate() {
                for (draw, value) in values.iter().enumerate() {
                    common[(k, draw)] += u * value;
                }
            }
        }
        if let Some(inner) = inner {
            inner.solve(&mut common);
        }
        for ((loading, weight), values) in loadings.iter().zip(weights).zip(values) {
            for (draw, value) in values.iter_mut().enumerate() {
                *value *= weight;
                for (k, u) in loading.iter().enumerate() {
                    *value -= u * common[(k, draw)];
                }
            }
        }
    }

    /// C⁻¹ times the values of all segments.
    pub(crate) fn weighed(&self, values: &[f64]) -> Vec<f64> {
        let ranges = self.system.data.flights.iter().map(|flight| flight.segments.clone());
        let of_flights = ranges.enumerate().flat_map(|(index, range)| {
            let mut own: Vec<Vec<f64>> = values[range].iter().map(|value| vec![*value]).collect();
            self.weigh(index, &mut own);
            own
        });
        of_flights.flatten().collect()
    }

    fn projected(&self, values: &[f64]) -> Projected {
        let ranges = self.system.data.flights.iter().map(|flight| flight.segments.clone());
        let common = self
            .flights
            .iter()
            .zip(ranges)
            .map(|(flight, range)| {
                let rank = flight.loadings.first().map_or(0, Vec::len);
                let mut sums = Mat::<f64>::zeros(rank, 1);
                for (loading, value) in flight.loadings.iter().zip(&values[range]) {
                    for (k, u) in loading.iter().enumerate() {
                        sums[(k, 0)] += u * value;
                    }
                }
                if let Some(inner) = &flight.inner {
                    inner.solve_lower(&mut sums);
                }
                (0..rank).map(|k| sums[(k, 0)]).collect()
            })
            .collect();
        Projected { common }
    }

    fn product(&self, a: (&[f64], &Projected), b: (&[f64], &Projected)) -> f64 {
        let mut sum = 0.0;
        for (index, flight) in self.flights.iter().enumerate() {
            let range = self.system.data.flights[index].segments.clone();
            let own: f64 = flight
                .weights
                .iter()
                .zip(a.0[range.clone()].iter().zip(&b.0[range]))
                .map(|(w, (a, b))| w * a * b)
                .sum();
            let shared: f64 =
                a.1.common[index].iter().zip(&b.1.common[index]).map(|(a, b)| a * b).sum();
            sum += own - shared;
        }
        sum
    }

    /// Fall of χ² by a step over a region, of any size, beside a level of any size.
    ///
    /// ```text
    /// (xᵀC⁻¹y)²/xᵀC⁻¹x,  x the place less its projection on the level, products with C⁻¹             [diagnosis.29]
    /// ```
    pub(crate) fn falls(&self, gap: &[f64], places: impl Iterator<Item = Vec<f64>>) -> Vec<f64> {
        let ones = vec![1.0; gap.len()];
        let (level, gaps) = (self.projected(&ones), self.projected(gap));
        let of_level = self.product((&ones, &level), (&ones, &level));
        let level_of_gap = self.product((&ones, &level), (gap, &gaps));
        places
            .map(|place| {
                let own = self.projected(&place);
                let x = (&*place, &own);
                let with_level = self.product(x, (&ones, &level));
                let square = self.product(x, x) - with_level * with_level / of_level;
                let slope = self.product(x, (gap, &gaps)) - with_level * level_of_gap / of_level;
                if square > 0.0 { slope * slope / square } else { 0.0 }
            })
            .collect()
    }
}
