//! The level of a tail over time: one trend, and a step at each boundary between pieces; beside them what depends on conditions.

use nalgebra::{SMatrix, SVector};

use crate::series::{CONDITIONS, Series};
use crate::settings::{ChangeBeliefs, MEASURED_TREND_SHARE};

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

/// Columns of the regression besides the pieces: years, conditions, and how often something was done to burn less.
const COLUMNS: usize = 2 + CONDITIONS;
/// The place of the last.
const TIMES_DONE: usize = COLUMNS - 1;
type Row = SVector<f64, COLUMNS>;

/// A trend common to all pieces, what conditions change, and the level of each piece.
#[derive(Clone, Debug, PartialEq)]
pub struct Levels {
    boundaries: Vec<usize>,
    pieces: Vec<PieceMeans>,
    /// Trend, % a year, what a standard deviation of each condition changes, %, and what the mean of what is done to burn less changes
    /// more than is believed, %.
    coefficients: Row,
    covariance: SMatrix<f64, COLUMNS, COLUMNS>,
    /// Standard deviation of the trend before the flights are seen, % a year.
    trend_before_percent_per_year: f64,
    /// The trend where it is averaged over what may step beside the boundaries.
    averaged_trend: Option<Estimate>,
    /// Squares about levels, trend and conditions, in variances of flights.
    residual: f64,
    /// ln |Σ Sxx + Λ| − ln |Λ|.
    ln_volume: f64,
    flights: usize,
    done: Done,
}

/// First flights after something was done to burn less, and what each is believed to change, %.
#[derive(Clone, Debug, PartialEq)]
struct Done {
    flights: Vec<usize>,
    believed_percent: f64,
}

impl Done {
    /// How often before a flight.
    fn times(&self, flight: usize) -> f64 {
        self.flights.iter().filter(|done| **done <= flight).count() as f64
    }
}

/// Weighted means of a piece.
#[derive(Clone, Debug, PartialEq)]
struct PieceMeans {
    weight: f64,
    mean_x: Row,
    mean_y: f64,
}

impl Levels {
    /// Weighted least squares of deviations on one slope, the conditions of the flights and the level of each piece; slope and
    /// conditions are believed to be normal about 0 beforehand, which only matters where the flights do not show them.
    ///
    /// ```text
    /// b = (Σ Sxx + Λ)⁻¹ Σ Sxy,  level at x = ȳ + b·(x − x̄)  of the piece                        [monitoring.9]
    /// step = ȳ₂ − ȳ₁ − b·(x̄₂ − x̄₁),  variance 1/W₁ + 1/W₂ + (x̄₂ − x̄₁)ᵀ(Σ Sxx + Λ)⁻¹(x̄₂ − x̄₁)  [monitoring.10]
    /// ```
    ///
    /// x are years and the flight's conditions in standard deviations, S sums of squares and products about the means of a
    /// piece, Λ one over the prior variances. `boundaries` are first flights of pieces, in order, each once, from the second
    /// piece on; others are left out. `None` for a series without a flight.
    #[must_use]
    pub fn fit(
        series: &Series,
        weights: &[f64],
        boundaries: &[usize],
        beliefs: &ChangeBeliefs,
    ) -> Option<Self> {
        Self::fit_beside(series, weights, (boundaries, &[]), beliefs)
    }

    /// The same where something was done to burn less before these flights, as much each time: x has how often, believed beforehand to
    /// change so much as [`ChangeBeliefs::to_burn_less_percent`] says.
    pub(crate) fn fit_beside(
        series: &Series,
        weights: &[f64],
        (boundaries, done): (&[usize], &[usize]),
        beliefs: &ChangeBeliefs,
    ) -> Option<Self> {
        let [believed_percent, _] = beliefs.to_burn_less_percent;
        let done = Done { flights: done.to_vec(), believed_percent };
        let flights = series.len().min(weights.len());
        if flights == 0 {
            return None;
        }
        let mut kept: Vec<usize> = Vec::with_capacity(boundaries.len());
        for &boundary in boundaries {
            if boundary > kept.last().copied().unwrap_or(0) && boundary < flights {
                kept.push(boundary);
            }
        }
        let starts = core::iter::once(0).chain(kept.iter().copied());
        let ends = kept.iter().copied().chain(core::iter::once(flights));
        let rows: Vec<(Row, f64, f64)> = (0..flights)
            .map(|k| (row(series, k, &done), beside(series, k, &done), weights[k]))
            .collect();
        let mut information = information_before(beliefs);
        let ln_before: f64 = information.diagonal().map(f64::ln).sum();
        let mut right = Row::zeros();
        let mut squares = 0.0;
        let mut pieces = Vec::with_capacity(kept.len() + 1);
        for (from, to) in starts.zip(ends) {
            let piece = PieceMeans::of(&rows[from..to]);
            for (x, y, weight) in &rows[from..to] {
                let apart = x - piece.mean_x;
                information += *weight * apart * apart.transpose();
                right += *weight * (y - piece.mean_y) * apart;
                squares += *weight * (y - piece.mean_y).powi(2);
            }
            pieces.push(piece);
        }
        let cholesky = information.cholesky()?;
        let ln_volume = 2.0 * cholesky.l_dirty().diagonal().map(f64::ln).sum() - ln_before;
        let covariance = cholesky.inverse();
        let coefficients = covariance * right;
        let trend_before_percent_per_year = beliefs.slope_deviation_percent_per_year;
        Some(Self {
            boundaries: kept,
            pieces,
            coefficients,
            covariance,
            trend_before_percent_per_year,
            averaged_trend: None,
            residual: squares - coefficients.dot(&right),
            ln_volume,
            flights,
            done,
        })
    }

    /// What a standard deviation of each condition changes of a deviation, %: nothing where conditions are not known.
    #[must_use]
    pub fn by_condition_percent(&self) -> [f64; CONDITIONS] {
        core::array::from_fn(|k| self.coefficients[1 + k])
    }

    /// Boundaries of pieces: first flights from the second piece on.
    #[must_use]
    pub fn boundaries(&self) -> &[usize] {
        &self.boundaries
    }

    /// The trend between changes, % a year.
    #[must_use]
    pub fn trend_percent_per_year(&self) -> Estimate {
        self.averaged_trend.unwrap_or_else(|| Estimate {
            value: self.coefficients[0],
            deviation: self.covariance[(0, 0)].sqrt(),
        })
    }

    /// The same levels where the trend is not known from these boundaries alone.
    pub(crate) fn with_trend(self, trend: Estimate) -> Self {
        Self { averaged_trend: Some(trend), ..self }
    }

    /// The same where the flights show it; `None` where they say next to nothing beyond what was believed before them: its standard
    /// deviation is above [`MEASURED_TREND_SHARE`] of the one before.
    #[must_use]
    pub fn measured_trend_percent_per_year(&self) -> Option<Estimate> {
        let trend = self.trend_percent_per_year();
        let largest = MEASURED_TREND_SHARE * self.trend_before_percent_per_year;
        (trend.deviation <= largest).then_some(trend)
    }

    /// ln of the density of the flights' deviations, less Σ ½ ln(w/2π), which no boundary changes: levels, normal about `middle_percent`,
    /// trend and conditions are integrated out.
    ///
    /// ```text
    /// −½ [Σ Syy − bᵀ Σ Sxy + ln |Σ Sxx + Λ| − ln |Λ| + Σ (ȳ − middle)²W/(1 + s²W) + ln(1 + s²W)]  [monitoring.20]
    /// ```
    #[must_use]
    pub(crate) fn ln_evidence(&self, middle_percent: f64, beliefs: &ChangeBeliefs) -> f64 {
        let of_level = |piece: &PieceMeans| {
            let volume = 1.0 + beliefs.level_deviation_percent.powi(2) * piece.weight;
            (piece.mean_y - middle_percent).powi(2) * piece.weight / volume + volume.ln()
        };
        -0.5 * (self.residual + self.ln_volume + self.pieces.iter().map(of_level).sum::<f64>())
    }

    /// The step at a boundary, by its place among the boundaries, %.
    #[must_use]
    pub fn step_percent(&self, place: usize) -> Option<Estimate> {
        self.step_between(place, place + 1)
    }

    /// What the level of one piece is above that of another before it, by their places, %.
    fn step_between(&self, before: usize, after: usize) -> Option<Estimate> {
        let (before, after) = (self.pieces.get(before)?, self.pieces.get(after)?);
        let apart = after.mean_x - before.mean_x;
        let variance = 1.0 / before.weight + 1.0 / after.weight + self.variance_along(&apart);
        Some(Estimate {
            value: after.mean_y - before.mean_y - self.coefficients.dot(&apart),
            deviation: variance.sqrt(),
        })
    }

    /// The step before a flight, %; `None` where no piece begins with it.
    pub(crate) fn step_at(&self, first_flight: usize) -> Option<Estimate> {
        self.step_over(first_flight, first_flight)
    }

    /// The step over the boundaries from one to another, both among them, %; `None` where one of them is no boundary.
    pub(crate) fn step_over(&self, first: usize, last: usize) -> Option<Estimate> {
        let place = |flight| self.boundaries.binary_search(&flight).ok();
        self.step_between(place(first)?, place(last)? + 1)
    }

    /// The level of the piece that a flight belongs to, at a date and mean conditions, %.
    #[must_use]
    pub fn level_percent(&self, flight: usize, years: f64) -> Estimate {
        let piece = &self.pieces[self.boundaries.partition_point(|start| *start <= flight)];
        let mut x = Row::zeros();
        x[0] = years;
        let apart = x - piece.mean_x;
        Estimate {
            value: piece.mean_y + self.coefficients.dot(&apart),
            deviation: (1.0 / piece.weight + self.variance_along(&apart)).sqrt(),
        }
    }

    /// The flights of a series at its mean conditions.
    pub(crate) fn at_mean_conditions(&self, series: &Series) -> Series {
        series.at_mean_conditions(&self.by_condition_percent())
    }

    /// What one step more would be before each flight that is not the first of its piece.
    ///
    /// ```text
    /// z: 1 from the flight on to the end of its piece, about its mean there
    /// J = S_zz − S_zxᵀ C S_zx,  e = Σ w·z·(y − level − b·x)                                    [monitoring.26]
    /// ```
    pub(crate) fn steps_beside(&self, series: &Series, weights: &[f64]) -> Vec<StepBeside> {
        let mut steps = Vec::with_capacity(self.flights);
        let starts = core::iter::once(0).chain(self.boundaries.iter().copied());
        let ends = self.boundaries.iter().copied().chain(core::iter::once(self.flights));
        for ((from, to), piece) in starts.zip(ends).zip(&self.pieces) {
            // Sums over the flights from the end of the piece back to the one before which the step lies.
            let (mut weight, mut along, mut score) = (0.0, Row::zeros(), 0.0);
            for first_flight in (from + 1..to).rev() {
                let apart = row(series, first_flight, &self.done) - piece.mean_x;
                let y = beside(series, first_flight, &self.done) - piece.mean_y;
                let own = weights[first_flight];
                weight += own;
                along += own * apart;
                score += own * (y - self.coefficients.dot(&apart));
                let with_trend = self.covariance * along;
                let alone = weight * (piece.weight - weight) / piece.weight;
                // What is left of rounding is no information.
                let information = (alone - along.dot(&with_trend)).max(0.0);
                let trend = with_trend[0];
                steps.push(StepBeside { first_flight, information, score, trend });
            }
        }
        steps
    }

    fn variance_along(&self, apart: &Row) -> f64 {
        (apart.transpose() * self.covariance * apart)[0].max(0.0)
    }

    /// The level at the last flight's date, %.
    #[must_use]
    pub fn last_level_percent(&self, series: &Series) -> Estimate {
        let years = series.flights().last().map_or(0.0, |flight| series.years(flight.time()));
        self.level_percent(self.flights - 1, years)
    }
}

/// A step beside the boundaries of [`Levels`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepBeside {
    /// First flight after it.
    pub(crate) first_flight: usize,
    /// J: what the flights say of its size, %⁻².
    information: f64,
    /// e, %⁻¹.
    score: f64,
    /// `(C S_zx)` of the trend: what a step of 1 % takes from it, % a year.
    trend: f64,
}

impl StepBeside {
    /// ln of the density of the flights with a step of this standard deviation beforehand over that without one.
    ///
    /// ```text
    /// ½ [e²/(J + 1/σ²) − ln(1 + σ² J)]                                                         [monitoring.27]
    /// ```
    pub(crate) fn ln_odds(&self, deviation_percent: f64) -> f64 {
        let variance = deviation_percent.powi(2);
        0.5 * (self.score.powi(2) / (self.information + variance.recip())
            - (variance * self.information).ln_1p())
    }

    /// The trend beside it: `b − C S_zx·e/(J + 1/σ²)`, variance `C + (C S_zx)²/(J + 1/σ²)`.
    pub(crate) fn trend(&self, levels: &Levels, deviation_percent: f64) -> Estimate {
        let variance = (self.information + deviation_percent.powi(-2)).recip();
        let (before, size) = (levels.trend_percent_per_year(), variance * self.score);
        Estimate {
            value: before.value - self.trend * size,
            deviation: (before.deviation.powi(2) + self.trend.powi(2) * variance).sqrt(),
        }
    }
}

impl PieceMeans {
    /// Of rows of x, y and weight; at least one.
    fn of(rows: &[(Row, f64, f64)]) -> Self {
        let weight: f64 = rows.iter().map(|(_, _, weight)| weight).sum();
        let mean_x = rows.iter().map(|(x, _, weight)| *weight * x).sum::<Row>() / weight;
        let mean_y = rows.iter().map(|(_, y, weight)| weight * y).sum::<f64>() / weight;
        Self { weight, mean_x, mean_y }
    }
}

/// Λ: one over the variances of before the flights are seen.
fn information_before(beliefs: &ChangeBeliefs) -> SMatrix<f64, COLUMNS, COLUMNS> {
    let mut information = SMatrix::<f64, COLUMNS, COLUMNS>::zeros();
    information.fill_diagonal(beliefs.condition_deviation_percent.powi(-2));
    information[(0, 0)] = beliefs.slope_deviation_percent_per_year.powi(-2);
    let [_, done] = beliefs.to_burn_less_percent;
    information[(TIMES_DONE, TIMES_DONE)] = done.powi(-2);
    information
}

fn row(series: &Series, flight: usize, done: &Done) -> Row {
    let years = series.years(series.flights()[flight].time());
    let conditions = series.conditions().get(flight).copied().unwrap_or_default();
    Row::from_fn(|k, _| match k {
        0 => years,
        TIMES_DONE => done.times(flight),
        _ => conditions[k - 1],
    })
}

/// The deviation of a flight without what is believed of what was done to burn less, %.
fn beside(series: &Series, flight: usize, done: &Done) -> f64 {
    series.flights()[flight].deviation_percent() - done.believed_percent * done.times(flight)
}

#[cfg(test)]
mod tests {
    use flight::Timestamp;
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use crate::series::FlightDeviation;

    /// Twelve flights in three pieces, which begin with flights 0, 4 and 9: days, deviations, weights, and the series.
    fn twelve_flights() -> ([i64; 12], [f64; 12], [f64; 12], Series) {
        let days = [0, 3, 9, 20, 31, 60, 61, 80, 120, 200, 230, 365];
        let y = [0.1, 0.3, -0.2, 0.4, -0.8, -0.5, -0.9, -0.4, -0.6, 1.2, 1.4, 1.0];
        let weights = [4.0, 2.0, 1.0, 4.0, 3.0, 4.0, 4.0, 2.0, 4.0, 1.0, 4.0, 4.0];
        let flights = days.iter().zip(y).map(|(&day, y)| {
            let time = Timestamp::from_second(86_400 * day).unwrap();
            FlightDeviation::of_segments(time, &[y]).unwrap()
        });
        let series = Series::new(flights.collect()).unwrap();
        (days, y, weights, series)
    }

    /// Oracle: the same regression with dense matrices, columns slope, conditions and one level per piece.
    #[test]
    fn slope_steps_and_levels_are_those_of_dense_least_squares() {
        let (days, y, weights, without) = twelve_flights();
        // The third does not vary.
        let conditions: [[f64; CONDITIONS]; 12] = core::array::from_fn(|k| {
            let number = |seed: usize| ((k * 7 + seed * 5) % 11) as f64;
            [0.7 + 0.01 * number(1), 4.0 + 0.1 * number(2), 1e4, 3.0 * number(3), 1e3 * number(4)]
        });
        let with = without.clone().under(&conditions).unwrap();
        for series in [without, with] {
            checked_by_dense_least_squares(&series, &days, &y, &weights);
        }
    }

    /// Oracle: regression with dense matrices. Flat levels of three pieces beside a slope, how often something was done and one step
    /// more, each with its prior; the densities are those of normal numbers with this covariance, in which levels vary by 1000 %.
    #[test]
    fn a_step_more_is_that_of_dense_least_squares() {
        const WIDTH: usize = 6;
        let (days, y, weights, series) = twelve_flights();
        let beliefs = ChangeBeliefs::of_2026();
        let [believed, done_deviation] = beliefs.to_burn_less_percent;
        let done = [2, 7];
        let levels = Levels::fit_beside(&series, &weights, (&[4, 9], &done), &beliefs).unwrap();
        let times = |k: usize| done.iter().filter(|done| **done <= k).count() as f64;
        let piece = |k: usize| usize::from(k >= 4) + usize::from(k >= 9);
        let above = DVector::from_fn(12, |k, _| y[k] - believed * times(k));
        let steps = levels.steps_beside(&series, &weights);
        assert_eq!(steps.len(), 12 - 3);
        for step in steps {
            for size in beliefs.unrecorded_step_deviations_percent {
                let is_after =
                    |k: usize| k >= step.first_flight && piece(k) == piece(step.first_flight);
                let design = DMatrix::from_fn(12, WIDTH, |k, column| match column {
                    0 => days[k] as f64 / 365.25,
                    1 => times(k),
                    2 => f64::from(u8::from(is_after(k))),
                    _ => f64::from(u8::from(piece(k) == column - 3)),
                });
                let fit = |of_step: f64| {
                    let prior = DVector::from_vec(vec![
                        beliefs.slope_deviation_percent_per_year.powi(2),
                        done_deviation.powi(2),
                        of_step,
                        1e6,
                        1e6,
                        1e6,
                    ]);
                    let spread = DMatrix::from_diagonal(&prior);
                    let noise = DVector::from_fn(12, |k, _| 1.0 / weights[k]);
                    let covariance =
                        &design * &spread * design.transpose() + DMatrix::from_diagonal(&noise);
                    let cholesky = covariance.cholesky().unwrap();
                    let ln = -0.5 * above.dot(&cholesky.solve(&above))
                        - cholesky.l().diagonal().map(f64::ln).sum();
                    let gain = &spread * design.transpose() * cholesky.inverse();
                    let (mean, left) = (&gain * &above, &spread - &gain * &design * &spread);
                    (ln, Estimate { value: mean[0], deviation: left[(0, 0)].sqrt() })
                };
                let ((without, _), (with, expected)) = (fit(0.0), fit(size * size));
                let (found, trend) = (step.ln_odds(size), step.trend(&levels, size));
                assert!((found - (with - without)).abs() < 1e-4, "{step:?} {with} {without}");
                assert!((trend.value - expected.value).abs() < 1e-4, "{trend:?} {expected:?}");
                assert!((trend.deviation - expected.deviation).abs() < 1e-4, "{trend:?}");
            }
        }
    }

    fn checked_by_dense_least_squares(
        series: &Series,
        days: &[i64; 12],
        y: &[f64; 12],
        weights: &[f64; 12],
    ) {
        const WIDTH: usize = 4 + CONDITIONS;
        let beliefs = ChangeBeliefs::of_2026();
        let levels = Levels::fit(series, weights, &[4, 9], &beliefs).unwrap();

        let years = |k: usize| days[k] as f64 / 365.25;
        let piece = |k: usize| usize::from(k >= 4) + usize::from(k >= 9);
        let design = DMatrix::from_fn(12, WIDTH, |row, column| match column {
            0 => years(row),
            1..4 => f64::from(u8::from(piece(row) + 1 == column)),
            _ => series.conditions().get(row).map_or(0.0, |conditions| conditions[column - 4]),
        });
        let weight = DMatrix::from_diagonal(&DVector::from_row_slice(weights));
        let mut normal = design.transpose() * &weight * &design;
        normal[(0, 0)] += beliefs.slope_deviation_percent_per_year.powi(-2);
        for column in 4..WIDTH {
            normal[(column, column)] += beliefs.condition_deviation_percent.powi(-2);
        }
        let covariance = normal.clone().try_inverse().unwrap();
        let found = &covariance * design.transpose() * &weight * DVector::from_row_slice(y);
        let check = |estimate: Estimate, by: [f64; 4]| {
            let by = DVector::from_fn(WIDTH, |k, _| by.get(k).copied().unwrap_or(0.0));
            let variance = (by.transpose() * &covariance * &by)[(0, 0)];
            assert!((estimate.value - by.dot(&found)).abs() < 1e-10, "{estimate:?}");
            assert!((estimate.deviation - variance.sqrt()).abs() < 1e-10, "{estimate:?}");
        };
        check(levels.trend_percent_per_year(), [1.0, 0.0, 0.0, 0.0]);
        check(levels.step_percent(0).unwrap(), [0.0, -1.0, 1.0, 0.0]);
        check(levels.step_percent(1).unwrap(), [0.0, 0.0, -1.0, 1.0]);
        check(levels.step_over(4, 9).unwrap(), [0.0, -1.0, 0.0, 1.0]);
        check(levels.level_percent(5, 0.3), [0.3, 0.0, 1.0, 0.0]);
        check(levels.last_level_percent(series), [365.0 / 365.25, 0.0, 0.0, 1.0]);
        assert!(levels.step_percent(2).is_none());
        // Levels about a middle of 0.2 %, beside slope and conditions about 0: a dense normal density.
        let middle = 0.2;
        let level = beliefs.level_deviation_percent.powi(2);
        let means: Vec<DVector<f64>> = (0..3)
            .map(|which| {
                let weight = |k: usize| if piece(k) == which { weights[k] } else { 0.0 };
                let sum: f64 = (0..12).map(weight).sum();
                let mean =
                    |column: usize| (0..12).map(|k| weight(k) * design[(k, column)]).sum::<f64>();
                DVector::from_fn(WIDTH, |column, _| mean(column) / sum)
            })
            .collect();
        let prior = |column: usize| match column {
            0 => beliefs.slope_deviation_percent_per_year.powi(2),
            1..4 => 0.0,
            _ => beliefs.condition_deviation_percent.powi(2),
        };
        let apart = |k: usize, column: usize| design[(k, column)] - means[piece(k)][column];
        let dense = DMatrix::from_fn(12, 12, |i, j| {
            let common = |column: usize| apart(i, column) * apart(j, column) * prior(column);
            let of_level = if piece(i) == piece(j) { level } else { 0.0 };
            (0..WIDTH).map(common).sum::<f64>()
                + of_level
                + if i == j { 1.0 / weights[i] } else { 0.0 }
        });
        let cholesky = dense.cholesky().unwrap();
        let apart = DVector::from_fn(12, |k, _| y[k] - middle);
        let expected = -0.5
            * (apart.dot(&cholesky.solve(&apart))
                + 2.0 * cholesky.l().diagonal().map(f64::ln).sum()
                + weights.map(f64::ln).iter().sum::<f64>());
        let found_evidence = levels.ln_evidence(middle, &beliefs);
        assert!((found_evidence - expected).abs() < 1e-9, "{found_evidence} {expected}");
        for (k, by) in levels.by_condition_percent().iter().enumerate() {
            assert!((by - found[4 + k]).abs() < 1e-10, "{by}");
        }
    }
}
