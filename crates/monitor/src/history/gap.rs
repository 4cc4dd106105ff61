//! A trend or a step: where no flight was flown for a while, a step then may be what is taken for a trend.

use units::convert::DAYS_PER_YEAR;

use super::{Asked, merged};
use crate::levels::{Estimate, Levels};
use crate::series::{Series, years_between};
use crate::settings::{ChangeBeliefs, DOUBTED_TREND_ODDS, GAP_DAYS};

/// A step in a gap between two flights, in place of a trend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepInGap {
    /// First flight after the gap.
    pub first_flight: usize,
    /// Size of the step, %, where the tail hardly ages.
    pub step_percent: Estimate,
    /// Odds of this step, without a trend, against the trend without it.
    pub odds: f64,
}

/// The most probable step in a gap that is at least a tenth as probable as a trend that stands out; `None` without such a trend.
///
/// ```text
/// odds = p/(1 − p)·p(d | step, slope of 0.3 % a year)/p(d | slope of 1.5 % a year)               [monitoring.21]
/// ```
///
/// with p of [`ChangeBeliefs::change_within`], or of an event where one is recorded (flights), and the densities of
/// [`Levels::ln_evidence`].
pub(super) fn step_instead(
    series: &Series,
    weights: &[f64],
    levels: &Levels,
    (recorded, beliefs): (&[usize], &ChangeBeliefs),
) -> Option<StepInGap> {
    let trend = levels.measured_trend_percent_per_year()?;
    if !trend.differs_from_zero() {
        return None;
    }
    let middle = Asked::new(series, weights, recorded, *beliefs).middle_percent;
    let ln_trend = levels.ln_evidence(middle, beliefs);
    let steady = beliefs.of_a_steady_tail();
    let in_gap = |first_flight: usize| {
        let flights = series.flights();
        let years = years_between(flights[first_flight - 1].time(), flights[first_flight].time());
        let is_new = !levels.boundaries().contains(&first_flight);
        if !is_new || years * DAYS_PER_YEAR < GAP_DAYS {
            return None;
        }
        let changes = if recorded.contains(&first_flight) {
            beliefs.change_at_event
        } else {
            beliefs.change_within(years)
        };
        let boundaries = merged(levels.boundaries(), &[first_flight]);
        let stepped = Levels::fit(series, weights, &boundaries, &steady)?;
        let place = boundaries.iter().position(|boundary| *boundary == first_flight)?;
        let ln_odds =
            changes.ln() - (-changes).ln_1p() + stepped.ln_evidence(middle, &steady) - ln_trend;
        Some(StepInGap {
            first_flight,
            step_percent: stepped.step_percent(place)?,
            odds: ln_odds.exp(),
        })
    };
    (1..series.len())
        .filter_map(in_gap)
        .filter(|step| step.odds >= DOUBTED_TREND_ODDS && step.step_percent.differs_from_zero())
        .max_by(|one, other| one.odds.total_cmp(&other.odds))
}

#[cfg(test)]
mod tests {
    use flight::Timestamp;

    use super::*;
    use crate::noise::Noise;
    use crate::series::FlightDeviation;

    /// What is found of flights on these days, each as given and ± 0.5 %, where no change was found.
    fn found(days: &[i64], percent: impl Fn(i64) -> f64) -> Option<StepInGap> {
        let scatter = [0.2, -0.5, 0.4, 0.0, -0.3, 0.5, -0.1, -0.4, 0.3, -0.1];
        let flights = days.iter().enumerate().map(|(k, &day)| {
            let time = Timestamp::from_second(86_400 * day).unwrap();
            let mean = percent(day) + scatter[k % 10];
            FlightDeviation::of_segments(time, &[mean - 0.2, mean + 0.2]).unwrap()
        });
        let series = Series::new(flights.collect()).unwrap();
        let weights = Noise::estimate(&series).weights(&series);
        let beliefs = ChangeBeliefs::of_2026();
        let levels = Levels::fit(&series, &weights, &[], &beliefs).unwrap();
        step_instead(&series, &weights, &levels, (&[], &beliefs))
    }

    /// By construction: a step of 1.5 % on day 150, of which no flight from day 90 to 210 shows when.
    #[test]
    fn a_step_in_a_gap_may_be_what_a_trend_is_taken_for() {
        let days: Vec<i64> = (0..90).step_by(3).chain((210..365).step_by(3)).collect();
        let step = found(&days, |day| if day > 150 { 1.5 } else { 0.0 }).unwrap();
        assert_eq!(days[step.first_flight], 210);
        let size = step.step_percent;
        assert!((size.value - 1.5).abs() < size.half_width95(), "{size:?}");
        assert!(step.odds > 1.0, "{}", step.odds);
        // Nothing at all: no trend that could be one.
        assert_eq!(found(&days, |_| 0.0), None);
        // Before and after the gap the flights show the trend by themselves.
        assert_eq!(found(&days, |day| day as f64 / 365.25 * 6.0), None);
        // The same trend where flights leave no gap: a step would have been seen.
        let all: Vec<i64> = (0..365).step_by(3).collect();
        assert_eq!(found(&all, |day| day as f64 / 365.25 * 2.0), None);
    }
}
