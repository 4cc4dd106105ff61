//! Levels of tails of one type, each flown at conditions of its own, put to common ones.
//!
//! What the type's model lacks at other conditions all its tails share; how it varies with conditions each tail shows among its own
//! flights, and what tails differ by does not enter there.

use nalgebra::{SMatrix, SVector};

use crate::levels::Estimate;
use crate::series::{CONDITIONS, one_over};
use crate::settings::MODEL_BY_CONDITION_PERCENT;

/// The conditions, the squares of the first two (Mach number and lift coefficient, by which drag is not straight), their product.
const FEATURES: usize = CONDITIONS + 3;
type Features = SVector<f64, FEATURES>;
type Information = SMatrix<f64, FEATURES, FEATURES>;

/// One flight of a tail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlownFlight {
    /// Conditions flown, as [`CONDITIONS`] has them; the first two are those by which the model's error may be curved.
    pub conditions: [f64; CONDITIONS],
    /// Deviation by the model of the type at these conditions, less what of it is of its date, %.
    pub deviation_percent: f64,
    /// Weight, %⁻².
    pub weight: f64,
}

/// A tail's flights by the conditions flown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlownConditions {
    /// The flights.
    pub flights: Vec<FlownFlight>,
    /// The conditions whose mean the tail's level is of, each with its weight.
    pub of_level: Vec<([f64; CONDITIONS], f64)>,
}

/// What each tail's level is to be raised by at the mean conditions of all tails, each counted alike: how the deviation by the
/// model that they share varies with conditions, found within tails.
///
/// ```text
/// b = (Σ Sff/φ + Λ)⁻¹ Σ Sfd/φ,  raised by b·(f̄ − f̄_tail),  variance (f̄ − f̄_tail)ᵀ(Σ Sff/φ + Λ)⁻¹(f̄ − f̄_tail)  [monitoring.22]
/// ```
///
/// f are the conditions in standard deviations, squares and product of the first two among them, S sums of squares and products of
/// the tail's flights about their means, Λ one over the square of [`MODEL_BY_CONDITION_PERCENT`], φ the mean square of what is left
/// over, in variances of flights, where it is above 1. The errors of tails of like conditions are common to them.
///
/// `None` for all of them where there are fewer than two tails, one has no conditions of its level, or conditions are not finite.
#[must_use]
pub fn to_common_conditions(tails: &[FlownConditions]) -> Option<Vec<Estimate>> {
    if tails.len() < 2 || tails.iter().any(|tail| tail.of_level.is_empty()) {
        return None;
    }
    let scale = Scale::of(tails);
    let means: Vec<Features> = tails.iter().map(|tail| scale.mean_of(&tail.of_level)).collect();
    let of_all = means.iter().sum::<Features>() / means.len() as f64;
    let (coefficients, covariance) = Within::of(tails, &scale).solved()?;
    let raised = |mean: &Features| {
        let apart = of_all - mean;
        let variance = (apart.transpose() * covariance * apart)[0].max(0.0);
        Estimate { value: coefficients.dot(&apart), deviation: variance.sqrt() }
    };
    let found: Vec<Estimate> = means.iter().map(raised).collect();
    found.iter().all(|one| one.value.is_finite() && one.deviation.is_finite()).then_some(found)
}

/// Mean of each condition over tails, each tail counted alike, and one over its standard deviation; 0 of one that does not vary.
struct Scale {
    mean: [f64; CONDITIONS],
    per_condition: [f64; CONDITIONS],
}

impl Scale {
    fn of(tails: &[FlownConditions]) -> Self {
        let over_tails = |of: &dyn Fn(&[f64; CONDITIONS]) -> f64| {
            let of_tail = |tail: &FlownConditions| weighted(&tail.of_level, of);
            tails.iter().map(of_tail).sum::<f64>() / tails.len() as f64
        };
        let mean: [f64; CONDITIONS] = core::array::from_fn(|k| over_tails(&|x| x[k]));
        let per_condition =
            core::array::from_fn(|k| one_over(over_tails(&|x| (x[k] - mean[k]).powi(2)).sqrt(), k));
        Self { mean, per_condition }
    }

    fn features(&self, conditions: &[f64; CONDITIONS]) -> Features {
        let z: [f64; CONDITIONS] =
            core::array::from_fn(|k| (conditions[k] - self.mean[k]) * self.per_condition[k]);
        let curved = [z[0] * z[0], z[1] * z[1], z[0] * z[1]];
        Features::from_fn(|k, _| if k < CONDITIONS { z[k] } else { curved[k - CONDITIONS] })
    }

    fn mean_of(&self, conditions: &[([f64; CONDITIONS], f64)]) -> Features {
        Features::from_fn(|k, _| weighted(conditions, &|x| self.features(x)[k]))
    }
}

fn weighted(
    conditions: &[([f64; CONDITIONS], f64)],
    of: &dyn Fn(&[f64; CONDITIONS]) -> f64,
) -> f64 {
    let weight: f64 = conditions.iter().map(|(_, weight)| weight).sum();
    conditions.iter().map(|(x, weight)| weight * of(x)).sum::<f64>() / weight
}

/// Sums of squares and products about the means of each tail.
struct Within {
    of_features: Information,
    with_deviation: Features,
    of_deviation: f64,
    /// Flights beyond one a tail and one a feature.
    freedom: f64,
}

impl Within {
    fn of(tails: &[FlownConditions], scale: &Scale) -> Self {
        let mut sums = Self {
            of_features: Information::zeros(),
            with_deviation: Features::zeros(),
            of_deviation: 0.0,
            freedom: -(FEATURES as f64),
        };
        for tail in tails {
            let rows: Vec<(Features, &FlownFlight)> =
                tail.flights.iter().map(|f| (scale.features(&f.conditions), f)).collect();
            let weight: f64 = rows.iter().map(|(_, flight)| flight.weight).sum();
            if weight <= 0.0 {
                continue;
            }
            let mean_f =
                rows.iter().map(|(f, flight)| flight.weight * f).sum::<Features>() / weight;
            let mean_d = rows
                .iter()
                .map(|(_, flight)| flight.weight * flight.deviation_percent)
                .sum::<f64>()
                / weight;
            for (f, flight) in &rows {
                let (f, d) = (f - mean_f, flight.deviation_percent - mean_d);
                sums.of_features += flight.weight * f * f.transpose();
                sums.with_deviation += flight.weight * d * f;
                sums.of_deviation += flight.weight * d * d;
            }
            sums.freedom += rows.len() as f64 - 1.0;
        }
        sums
    }

    /// Coefficients and their covariance; `None` where the sums are not finite.
    fn solved(&self) -> Option<(Features, Information)> {
        let (coefficients, covariance) = self.solved_with(1.0)?;
        let left = self.of_deviation - coefficients.dot(&self.with_deviation);
        if self.freedom > 0.0 && left > self.freedom {
            return self.solved_with(left / self.freedom);
        }
        Some((coefficients, covariance))
    }

    fn solved_with(&self, variance: f64) -> Option<(Features, Information)> {
        let before = Information::identity() * MODEL_BY_CONDITION_PERCENT.powi(-2);
        let covariance = (self.of_features / variance + before).cholesky()?.inverse();
        Some((covariance * self.with_deviation / variance, covariance))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    /// Numbers without a pattern, from 0 to 1.
    fn number(k: usize) -> f64 {
        ((k * 7919 + 104_729) % 1009) as f64 / 1009.0
    }

    /// Flights of tails that fly at these Mach numbers, with an error of the model of `of` the Mach number and 0.1 % for each 100 m.
    fn flown(machs: &[f64], flights: usize, of: impl Fn(f64) -> f64) -> Vec<FlownConditions> {
        let tail = |(place, &mach): (usize, &f64)| {
            let flights: Vec<FlownFlight> = (0..flights)
                .map(|k| {
                    let draw = |which: usize| number(place * 1000 + k * 10 + which) - 0.5;
                    let (mach, altitude) = (mach + 0.03 * draw(1), 10_000.0 + 2000.0 * draw(2));
                    FlownFlight {
                        conditions: [
                            mach,
                            5.0 + draw(3),
                            altitude,
                            10.0 * draw(4),
                            6e4 + 1e4 * draw(5),
                        ],
                        deviation_percent: of(mach) + altitude / 1000.0 + 0.4 * draw(6),
                        weight: 4.0 + draw(7),
                    }
                })
                .collect();
            let of_level = flights.iter().map(|flight| (flight.conditions, 1.0)).collect();
            FlownConditions { flights, of_level }
        };
        machs.iter().enumerate().map(tail).collect()
    }

    fn level(tail: &FlownConditions) -> f64 {
        let sum: f64 = tail.flights.iter().map(|flight| flight.deviation_percent).sum();
        sum / tail.flights.len() as f64
    }

    /// By construction: tails are alike, and the model's error is a parabola over the Mach number; slow and fast ones are 2 % apart.
    #[test]
    fn tails_that_are_alike_are_alike_at_common_conditions() {
        let machs = [0.74, 0.745, 0.75, 0.775, 0.79, 0.795, 0.80];
        let tails = flown(&machs, 60, |mach| -40.0 * (mach - 0.72) - 200.0 * (mach - 0.72).powi(2));
        let levels: Vec<f64> = tails.iter().map(level).collect();
        assert!((levels[0] - levels[6]).abs() > 3.0, "{levels:?}");
        let raised = to_common_conditions(&tails).unwrap();
        let common: Vec<f64> =
            levels.iter().zip(&raised).map(|(level, raised)| level + raised.value).collect();
        let mean = common.iter().sum::<f64>() / common.len() as f64;
        for (level, raised) in common.iter().zip(&raised) {
            let noise = 0.05;
            let deviation = raised.deviation.hypot(noise);
            assert!((level - mean).abs() < 3.0 * deviation, "{common:?} {raised:?}");
            assert!(raised.deviation < 0.3, "{raised:?}");
        }
        // What a tail burns more of its own stays.
        let mut worse = tails;
        for flight in &mut worse[6].flights {
            flight.deviation_percent += 1.0;
        }
        let again = to_common_conditions(&worse).unwrap();
        for (one, other) in raised.iter().zip(&again) {
            assert!((one.value - other.value).abs() < 1e-9);
        }
        assert!(to_common_conditions(&worse[..1]).is_none());
    }

    /// By construction: tails fly on standard days but for rounding, with which their deviations go. There is no condition by which they
    /// differ, and nothing to raise.
    #[test]
    fn rounding_is_no_condition() {
        let mut tails = flown(&[0.77, 0.77], 40, |_| 0.0);
        for (place, tail) in tails.iter_mut().enumerate() {
            let fixed = |k: usize| {
                let isa_deviation_k =
                    if (k + place).is_multiple_of(3) { 2.8e-14 } else { -2.8e-14 };
                [0.77, 5.0, 10_000.0, isa_deviation_k, 6e4]
            };
            for (k, flight) in tail.flights.iter_mut().enumerate() {
                flight.conditions = fixed(k);
                flight.deviation_percent = flight.conditions[3].signum();
            }
            tail.of_level = (0..10 + 10 * place).map(|k| (fixed(k), 1.0)).collect();
        }
        for raised in to_common_conditions(&tails).unwrap() {
            assert_eq!((raised.value, raised.deviation), (0.0, 0.0));
        }
        // And none of them knows anything where one has no conditions of its level.
        tails[1].of_level.clear();
        assert!(to_common_conditions(&tails).is_none());
    }

    /// Tails that fly at one Mach number each do not show how the model's error depends on it: the interval is that of before.
    #[test]
    fn what_no_tail_shows_is_as_uncertain_as_before() {
        let mut tails = flown(&[0.74, 0.80], 40, |_| 0.0);
        for (tail, mach) in tails.iter_mut().zip([0.74, 0.80]) {
            tail.flights.iter_mut().for_each(|flight| flight.conditions[0] = mach);
            tail.of_level.iter_mut().for_each(|(conditions, _)| conditions[0] = mach);
        }
        // A standard deviation of the Mach number from their mean either way.
        for raised in to_common_conditions(&tails).unwrap() {
            let before = MODEL_BY_CONDITION_PERCENT;
            assert!((0.9 * before..1.2 * before).contains(&raised.deviation), "{raised:?}");
        }
    }

    /// Oracle: the same regression with dense matrices and a column for each tail.
    #[test]
    fn what_is_raised_is_that_of_dense_least_squares() {
        let tails = flown(&[0.75, 0.77, 0.80], 12, |mach| 30.0 * mach);
        let scale = Scale::of(&tails);
        let rows: Vec<(usize, &FlownFlight)> = tails
            .iter()
            .enumerate()
            .flat_map(|(place, tail)| tail.flights.iter().map(move |flight| (place, flight)))
            .collect();
        let design = DMatrix::from_fn(rows.len(), 3 + FEATURES, |row, column| {
            let (place, flight) = rows[row];
            match column {
                0..3 => f64::from(u8::from(place == column)),
                _ => scale.features(&flight.conditions)[column - 3],
            }
        });
        let weights: Vec<f64> = rows.iter().map(|(_, flight)| flight.weight).collect();
        let weight = DMatrix::from_diagonal(&DVector::from_row_slice(&weights));
        let y = DVector::from_fn(rows.len(), |row, _| rows[row].1.deviation_percent);
        let mut normal = design.transpose() * &weight * &design;
        for column in 3..3 + FEATURES {
            normal[(column, column)] += MODEL_BY_CONDITION_PERCENT.powi(-2);
        }
        let covariance = normal.try_inverse().unwrap();
        let found = &covariance * design.transpose() * &weight * y;
        let means: Vec<DVector<f64>> = (0..3)
            .map(|place| {
                DVector::from_fn(3 + FEATURES, |column, _| {
                    let of: Vec<usize> =
                        (0..rows.len()).filter(|row| rows[*row].0 == place).collect();
                    of.iter().map(|row| design[(*row, column)]).sum::<f64>() / of.len() as f64
                })
            })
            .collect();
        let of_all = (&means[0] + &means[1] + &means[2]) / 3.0;
        for (mean, raised) in means.iter().zip(to_common_conditions(&tails).unwrap()) {
            let apart =
                DVector::from_fn(
                    3 + FEATURES,
                    |k, _| if k < 3 { 0.0 } else { of_all[k] - mean[k] },
                );
            let variance = (apart.transpose() * &covariance * &apart)[(0, 0)];
            assert!((raised.value - apart.dot(&found)).abs() < 1e-6, "{raised:?}");
            assert!((raised.deviation - variance.sqrt()).abs() < 1e-6, "{raised:?}");
        }
    }
}
