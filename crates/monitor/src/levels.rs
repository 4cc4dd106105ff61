//! The level of a tail over time: one trend, and a step at each boundary between pieces.

use crate::piece::{Piece, RunningSums};
use crate::series::Series;
use crate::settings::ChangeBeliefs;

/// A value and its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

impl Estimate {
    /// Half width of its 95 % interval: normal, because deviations come from the scatter of many flights.
    #[must_use]
    pub fn half_width95(&self) -> f64 {
        NORMAL_95 * self.deviation
    }

    /// Whether 0 lies outside its 95 % interval.
    #[must_use]
    pub fn differs_from_zero(&self) -> bool {
        self.value.abs() > self.half_width95()
    }
}

/// Half width of a two-sided 95 % interval of a normal distribution, in standard deviations; two decimals, as tables and
/// text books have it, so that intervals can be checked by hand.
pub const NORMAL_95: f64 = 1.96;

/// A trend common to all pieces and the level of each.
#[derive(Clone, Debug, PartialEq)]
pub struct Levels {
    boundaries: Vec<usize>,
    pieces: Vec<Piece>,
    slope: f64,
    slope_precision: f64,
    flights: usize,
}

impl Levels {
    /// Weighted least squares of deviations on one slope and the level of each piece; the slope is believed to be normal
    /// about 0 beforehand, which only matters where the flights span too few months to show it.
    ///
    /// ```text
    /// b = Σ Sxy/(Σ Sxx + 1/o²),  level at x = ȳ + b(x − x̄)  of the piece                      [monitoring.9]
    /// step = ȳ₂ − ȳ₁ − b(x̄₂ − x̄₁),  variance 1/W₁ + 1/W₂ + (x̄₂ − x̄₁)²/(Σ Sxx + 1/o²)       [monitoring.10]
    /// ```
    ///
    /// `boundaries` are first flights of pieces, in order, each once, from the second piece on; others are left out.
    /// `None` for a series without a flight.
    #[must_use]
    pub fn fit(
        series: &Series,
        weights: &[f64],
        boundaries: &[usize],
        beliefs: &ChangeBeliefs,
    ) -> Option<Self> {
        let flights = series.len().min(weights.len());
        if flights == 0 {
            return None;
        }
        let mut sums = RunningSums::new();
        for (flight, weight) in series.flights().iter().zip(weights) {
            sums.push(series.years(flight.time()), flight.deviation_percent(), *weight);
        }
        let mut kept: Vec<usize> = Vec::with_capacity(boundaries.len());
        for &boundary in boundaries {
            if boundary > kept.last().copied().unwrap_or(0) && boundary < flights {
                kept.push(boundary);
            }
        }
        let starts = core::iter::once(0).chain(kept.iter().copied());
        let ends = kept.iter().copied().chain(core::iter::once(flights));
        let pieces: Vec<Piece> = starts.zip(ends).map(|(from, to)| sums.piece(from, to)).collect();
        let slope_precision = pieces.iter().map(|piece| piece.sxx).sum::<f64>()
            + beliefs.slope_deviation_percent_per_year.powi(-2);
        let slope = pieces.iter().map(|piece| piece.sxy).sum::<f64>() / slope_precision;
        Some(Self { boundaries: kept, pieces, slope, slope_precision, flights })
    }

    /// Boundaries of pieces: first flights from the second piece on.
    #[must_use]
    pub fn boundaries(&self) -> &[usize] {
        &self.boundaries
    }

    /// The trend between changes, % a year.
    #[must_use]
    pub fn trend_percent_per_year(&self) -> Estimate {
        Estimate { value: self.slope, deviation: self.slope_precision.powf(-0.5) }
    }

    /// The step at a boundary, by its place among the boundaries, %.
    #[must_use]
    pub fn step_percent(&self, place: usize) -> Option<Estimate> {
        let (before, after) = (self.pieces.get(place)?, self.pieces.get(place + 1)?);
        let apart = after.mean_x - before.mean_x;
        let variance =
            1.0 / before.weight + 1.0 / after.weight + apart * apart / self.slope_precision;
        Some(Estimate {
            value: after.mean_y - before.mean_y - self.slope * apart,
            deviation: variance.sqrt(),
        })
    }

    /// The level of the piece that a flight belongs to, at a date, %.
    #[must_use]
    pub fn level_percent(&self, flight: usize, years: f64) -> Estimate {
        let piece = &self.pieces[self.boundaries.partition_point(|start| *start <= flight)];
        let apart = years - piece.mean_x;
        Estimate {
            value: piece.mean_y + self.slope * apart,
            deviation: (1.0 / piece.weight + apart * apart / self.slope_precision).sqrt(),
        }
    }

    /// The level at the last flight's date, %.
    #[must_use]
    pub fn last_level_percent(&self, series: &Series) -> Estimate {
        let years = series.flights().last().map_or(0.0, |flight| series.years(flight.time()));
        self.level_percent(self.flights - 1, years)
    }
}

#[cfg(test)]
mod tests {
    use flight::Timestamp;
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::series::FlightDeviation;

    /// Oracle: the same regression with dense matrices, columns slope and one level per piece.
    #[test]
    fn slope_steps_and_levels_are_those_of_dense_least_squares() {
        let days = [0, 3, 9, 20, 31, 60, 61, 80, 120, 200, 230, 365];
        let y = [0.1, 0.3, -0.2, 0.4, -0.8, -0.5, -0.9, -0.4, -0.6, 1.2, 1.4, 1.0];
        let weights = [4.0, 2.0, 1.0, 4.0, 3.0, 4.0, 4.0, 2.0, 4.0, 1.0, 4.0, 4.0];
        let flights = days.iter().zip(y).map(|(&day, y)| {
            let time = Timestamp::from_second(86_400 * day).unwrap();
            FlightDeviation::of_segments(time, &[y]).unwrap()
        });
        let series = Series::new(flights.collect()).unwrap();
        let beliefs = ChangeBeliefs::of_2026();
        let levels = Levels::fit(&series, &weights, &[4, 9], &beliefs).unwrap();

        let years = |k: usize| days[k] as f64 / 365.25;
        let piece = |k: usize| usize::from(k >= 4) + usize::from(k >= 9);
        let design = DMatrix::from_fn(12, 4, |row, column| match column {
            0 => years(row),
            column => f64::from(u8::from(piece(row) + 1 == column)),
        });
        let weight = DMatrix::from_diagonal(&DVector::from_row_slice(&weights));
        let mut normal = design.transpose() * &weight * &design;
        normal[(0, 0)] += beliefs.slope_deviation_percent_per_year.powi(-2);
        let covariance = normal.clone().try_inverse().unwrap();
        let found = &covariance * design.transpose() * &weight * DVector::from_row_slice(&y);
        let check = |estimate: Estimate, by: [f64; 4]| {
            let by = DVector::from_row_slice(&by);
            let variance = (by.transpose() * &covariance * &by)[(0, 0)];
            assert!((estimate.value - by.dot(&found)).abs() < 1e-10, "{estimate:?}");
            assert!((estimate.deviation - variance.sqrt()).abs() < 1e-10, "{estimate:?}");
        };
        check(levels.trend_percent_per_year(), [1.0, 0.0, 0.0, 0.0]);
        check(levels.step_percent(0).unwrap(), [0.0, -1.0, 1.0, 0.0]);
        check(levels.step_percent(1).unwrap(), [0.0, 0.0, -1.0, 1.0]);
        check(levels.level_percent(5, 0.3), [0.3, 0.0, 1.0, 0.0]);
        check(levels.last_level_percent(&series), [365.0 / 365.25, 0.0, 0.0, 1.0]);
        assert!(levels.step_percent(2).is_none());
    }
}
