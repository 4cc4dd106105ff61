use super::*;
use crate::FlightDeviation;

/// By hand: one event, so that there are two sets, with it and without it; each trend counts as much as its set is probable, and what
/// they differ by is added to the variance.
#[test]
fn the_trend_is_that_of_both_where_an_event_may_be_a_step_or_none() {
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
    let with = Levels::fit(&series, &found.weights, &[30], &beliefs).unwrap();
    let without = Levels::fit(&series, &found.weights, &[], &beliefs).unwrap();
    let middle = Asked::new(&series, &found.weights, &[], beliefs).middle_percent;
    let ln = |levels: &Levels| levels.ln_evidence(middle, &beliefs);
    let believed = beliefs.change_at_event / (1.0 - beliefs.change_at_event);
    let odds = believed * (ln(&with) - ln(&without)).exp();
    let p = odds / (1.0 + odds);
    assert!((0.05..0.95).contains(&p), "{p}: one of both alone tests nothing");
    let (a, b) = (with.trend_percent_per_year(), without.trend_percent_per_year());
    let value = p * a.value + (1.0 - p) * b.value;
    let variance = p * (a.deviation.powi(2) + (a.value - value).powi(2))
        + (1.0 - p) * (b.deviation.powi(2) + (b.value - value).powi(2));
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
    let known = [day(199), day(-1)];
    let found = History::fit_with_steps(&series, &[], &known, &beliefs).unwrap();
    let beside = Levels::fit(&series, &found.weights, &[20], &beliefs).unwrap();
    let (trend, expected) =
        (found.levels.trend_percent_per_year(), beside.trend_percent_per_year());
    assert!((trend.value - expected.value).abs() < 1e-12, "{trend:?} {expected:?}");
    assert!((trend.deviation - expected.deviation).abs() < 1e-12, "{trend:?} {expected:?}");
    assert!(trend.value.abs() < 0.6 * unknown.levels.trend_percent_per_year().value, "{trend:?}");
    assert_eq!(found.levels.boundaries(), [20]);
    assert!(found.changes.is_empty(), "a step that is known is not found");
}
