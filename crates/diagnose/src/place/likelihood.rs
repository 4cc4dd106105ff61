//! How much better a step over a region fits the gap, with the noise that flights have in common taken into account.

use faer::Mat;

use crate::math::cholesky::Cholesky;
use crate::place::draws::NoiseLevel;
use crate::search::system::WhitenedSystem;

/// Regions that are weighed together.
const TOGETHER: usize = 40;

/// C⁻¹, C the noise of fuel flow: a segment's own, and what its flight has in common. Not what the model does not know:
/// a gap that resembles it would be looked for in what differs from it, at places that have nothing to do with the gap.
pub(crate) struct Noise<'a> {
    flights: Vec<OfFlight>,
    system: &'a WhitenedSystem<'a>,
}

/// A step over a region.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    /// ln of fuel flow.
    pub(crate) size: f64,
    /// Fall of χ² by it.
    pub(crate) fall: f64,
}

struct OfFlight {
    /// 1/σ² of each segment.
    weights: Vec<f64>,
    /// Loadings of what is common, scaled by 1/σ²: one row per segment.
    loadings: Vec<Vec<f64>>,
    /// Of 1 + UᵀD⁻¹U.
    inner: Option<Cholesky>,
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

    /// The flights it is the noise of.
    pub(crate) const fn system(&self) -> &'a WhitenedSystem<'a> {
        self.system
    }

    /// C⁻¹ times values of all segments, one column a draw.
    ///
    /// ```text
    /// C⁻¹ = D⁻¹ − D⁻¹U(1 + UᵀD⁻¹U)⁻¹UᵀD⁻¹,   flight by flight
    /// ```
    pub(crate) fn weigh(&self, values: &mut Mat<f64>) {
        let width = values.ncols();
        for (flight, of) in self.flights.iter().zip(&self.system.data.flights) {
            let rank = flight.loadings.first().map_or(0, Vec::len);
            let start = of.segments.start;
            let mut common = Mat::<f64>::zeros(rank, width);
            for draw in 0..width {
                for (place, loading) in flight.loadings.iter().enumerate() {
                    let value = values[(start + place, draw)];
                    for (k, u) in loading.iter().enumerate() {
                        common[(k, draw)] += u * value;
                    }
                }
            }
            if let Some(inner) = &flight.inner {
                inner.solve(&mut common);
            }
            for draw in 0..width {
                for (place, (loading, weight)) in
                    flight.loadings.iter().zip(&flight.weights).enumerate()
                {
                    let shared: f64 =
                        loading.iter().enumerate().map(|(k, u)| u * common[(k, draw)]).sum();
                    let value = &mut values[(start + place, draw)];
                    *value = *value * weight - shared;
                }
            }
        }
    }

    /// C⁻¹ times one value a segment.
    pub(crate) fn weighed(&self, values: &[f64]) -> Vec<f64> {
        let mut column = Mat::from_fn(values.len(), 1, |segment, _| values[segment]);
        self.weigh(&mut column);
        (0..values.len()).map(|segment| column[(segment, 0)]).collect()
    }

    /// Steps over regions (lists of segments), of any size, beside a level of any size: the best size of each, and the fall of χ²
    /// by it.
    ///
    /// ```text
    /// xᵀC⁻¹y/xᵀC⁻¹x,   (xᵀC⁻¹y)²/xᵀC⁻¹x,  x the place less its projection on the level, products with C⁻¹   [diagnosis.29]
    /// ```
    pub(crate) fn steps(&self, gap: &[f64], regions: &[Vec<usize>]) -> Vec<Step> {
        let (gap, level) = (self.weighed(gap), self.weighed(&vec![1.0; gap.len()]));
        let sum = |of: &[f64], region: &[usize]| region.iter().map(|&k| of[k]).sum::<f64>();
        let (of_level, level_of_gap) = (level.iter().sum::<f64>(), gap.iter().sum::<f64>());
        let mut found = Vec::with_capacity(regions.len());
        for regions in regions.chunks(TOGETHER) {
            let mut steps = Mat::<f64>::zeros(gap.len(), regions.len());
            for (column, region) in regions.iter().enumerate() {
                for &segment in region {
                    steps[(segment, column)] = 1.0;
                }
            }
            self.weigh(&mut steps);
            found.extend(regions.iter().enumerate().map(|(column, region)| {
                let own: f64 = region.iter().map(|&segment| steps[(segment, column)]).sum();
                let with_level = sum(&level, region);
                let square = own - with_level * with_level / of_level;
                let slope = sum(&gap, region) - with_level * level_of_gap / of_level;
                if square > 0.0 {
                    Step { size: slope / square, fall: slope * slope / square }
                } else {
                    Step { size: 0.0, fall: 0.0 }
                }
            }));
        }
        found
    }
}
