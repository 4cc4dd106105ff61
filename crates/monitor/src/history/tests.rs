use units::convert::DAYS_PER_YEAR;

use super::*;
use crate::FlightDeviation;

/// By hand: one event, so that there are two sets, with it and without it, each alone and with a step more before each other flight,
/// of a tail that ages and of one that hardly does; each trend counts as much as it is probable, and what they differ by is added to the
/// variance.
#[test]
fn the_trend_is_that_of_all_that_may_have_stepped() {
    let beliefs = ChangeBeliefs::of_2026();
    let day = |days: i64| Timestamp::from_second(1_700_000_000 + 86_400 * days).unwrap();
    // 1 % a year with 0.4 % of noise that alternates, and a step of −0.3 % in the middle.
    let percent = |k: i64| {
        let noise = if k % 2 == 0 { 0.4 } else { -0.4 };
        k as f64 * 6.0 / 365.25 + noise - if k >= 30 { 0.3 } else { 0.0 }
    };
    let flights = (0..60).map(|k| FlightDeviation::of_segments(day(6 * k), &[percent(k)]).unwrap());
    let series = Series::new(flights.collect()).unwrap();
    let found = History::fit(&series, &[day(180)], &beliefs).unwrap();
    assert!(found.changes.is_empty());
    let steady = ChangeBeliefs { slope_deviation_percent_per_year: 0.3, ..beliefs };
    let middle = Asked::new(&series, &found.weights, &[], beliefs).middle_percent;
    // A change a year, six days from flight to flight.
    let odds_of_a_step = (6.0 / DAYS_PER_YEAR).exp_m1();
    let mut parts: Vec<(f64, Estimate)> = Vec::new();
    for boundaries in [&[30][..], &[]] {
        for (beliefs, is_stated) in [(beliefs, true), (steady, false)] {
            let levels = Levels::fit(&series, &found.weights, boundaries, &beliefs).unwrap();
            // An event is a step as probably as none.
            let share = levels.ln_evidence(middle, &beliefs).exp();
            if is_stated {
                parts.push((share, levels.trend_percent_per_year()));
            }
            for step in levels.steps_beside(&series, &found.weights) {
                if step.first_flight != 30 {
                    parts.extend([0.5, 1.5].map(|size| {
                        let odds = 0.5 * odds_of_a_step * step.ln_odds(size).exp();
                        (share * odds, step.trend(&levels, size))
                    }));
                }
            }
        }
    }
    let total: f64 = parts.iter().map(|(share, _)| share).sum();
    let largest = parts.iter().map(|(share, _)| *share).fold(0.0, f64::max);
    assert!(largest < 0.8 * total, "{largest} of {total}: one alone tests nothing");
    let mean = |of: &dyn Fn(&Estimate) -> f64| -> f64 {
        parts.iter().map(|(share, part)| share * of(part)).sum::<f64>() / total
    };
    let value = mean(&|part| part.value);
    let variance = mean(&|part| part.deviation.powi(2) + (part.value - value).powi(2));
    let trend = found.levels.trend_percent_per_year();
    assert!((trend.value - value).abs() < 1e-9, "{} {value}", trend.value);
    assert!((trend.deviation - variance.sqrt()).abs() < 1e-9, "{} {variance}", trend.deviation);
}

/// The oracle is the fit that is given the boundary: a step that is known is one in every set, whatever its evidence, so that the trend is
/// that beside it. Without it the same flights are a trend. An instant before all flights is no boundary.
#[test]
fn what_is_known_to_be_a_step_is_no_trend() {
    let beliefs = ChangeBeliefs::of_2026();
    let day = |days: i64| Timestamp::from_second(1_700_000_000 + 86_400 * days).unwrap();
    // No trend, 0.6 % of noise that alternates, and a step of 0.8 % in the middle.
    let percent = |k: i64| {
        let noise = if k % 2 == 0 { 0.6 } else { -0.6 };
        noise + if k >= 20 { 0.8 } else { 0.0 }
    };
    let flights =
        (0..40).map(|k| FlightDeviation::of_segments(day(10 * k), &[percent(k)]).unwrap());
    let series = Series::new(flights.collect()).unwrap();
    let unknown = History::fit_to_events(&series, &[], &beliefs).unwrap();
    assert!(unknown.changes.is_empty());
    assert!(unknown.levels.trend_percent_per_year().value > 0.5);
    let known = KnownSteps { of_a_part: vec![day(199), day(-1)], ..KnownSteps::default() };
    let found = History::fit_with_steps(&series, &[], &known, &beliefs).unwrap();
    assert_eq!(found.levels.boundaries(), [20]);
    let trend = found.levels.trend_percent_per_year();
    assert!(trend.value.abs() < 0.6 * unknown.levels.trend_percent_per_year().value, "{trend:?}");
    assert_eq!(found.levels.boundaries(), [20]);
    assert!(found.changes.is_empty(), "a step that is known is not found");
}

/// A step that stands out by thousands of standard deviations, and is no boundary because the series is too short for a change to be
/// probable beforehand, leaves a trend that is a number.
#[test]
fn a_step_beyond_all_doubt_leaves_a_finite_trend() {
    let beliefs = ChangeBeliefs::of_2026();
    let minute = |k: i64| Timestamp::from_second(1_700_000_000 + 60 * k).unwrap();
    let flights = (0..40).map(|k| {
        let mean = 1e-3 * (k % 2) as f64 + if k >= 20 { 60.0 } else { 0.0 };
        FlightDeviation::of_segments(minute(k), &[mean; 400]).unwrap()
    });
    let series = Series::new(flights.collect()).unwrap();
    let weights = vec![1e6; 40];
    let levels = Levels::fit(&series, &weights, &[], &beliefs).unwrap();
    let steps = levels.steps_beside(&series, &weights);
    assert!(steps.iter().any(|step| step.ln_odds(1.5) > 1e3));
    let asked = Asked::new(&series, &weights, &[], beliefs);
    let stepped = stepped_events(&asked, &[], (&[], &[])).unwrap();
    let trend = trend::averaged(&stepped, &asked, (&[], &[])).unwrap();
    assert!(trend.value.is_finite() && trend.deviation > 0.0, "{trend:?}");
}
