//! Ticks of a time scale: midnights UTC of days, months or years, labelled `2019-03-14`.

use jiff::civil::Date;
use jiff::tz::Offset;
use jiff::{Timestamp, ToSpan};

use super::{Axis, Tick};

/// Distances between ticks.
#[derive(Clone, Copy)]
enum Step {
    Days(i64),
    Months(i8),
    Years(i16),
}

const STEPS: [Step; 15] = [
    Step::Days(1),
    Step::Days(2),
    Step::Days(5),
    Step::Days(10),
    Step::Months(1),
    Step::Months(2),
    Step::Months(3),
    Step::Months(6),
    Step::Years(1),
    Step::Years(2),
    Step::Years(5),
    Step::Years(10),
    Step::Years(20),
    Step::Years(50),
    Step::Years(1000),
];

const SECONDS_PER_DAY: f64 = units::convert::SECONDS_PER_DAY;

/// A scale in seconds since 1970-01-01 UTC with some room at both ends and at most `ticks` ticks.
pub(crate) fn axis(low_s: f64, high_s: f64, ticks: usize) -> Axis {
    if !(low_s.is_finite() && high_s.is_finite() && low_s <= high_s) {
        return Axis::of_dates(0.0, SECONDS_PER_DAY, Vec::new());
    }
    // At least half a day, so that a single flight has a midnight near it.
    let room = (0.03 * (high_s - low_s)).max(0.6 * SECONDS_PER_DAY);
    let (first_s, last_s) = (low_s - room, high_s + room);
    let mut dates = Vec::new();
    for step in STEPS {
        dates = dates_between(first_s, last_s, step, ticks);
        if !dates.is_empty() {
            break;
        }
    }
    let labelled = dates.into_iter().map(|(at, date)| Tick { at, label: date.to_string() });
    Axis::of_dates(first_s, last_s, labelled.collect())
}

/// Instant as `2019-03-14`, UTC.
pub(crate) fn day(instant: Timestamp) -> String {
    Offset::UTC.to_datetime(instant).date().to_string()
}

/// "2019-03-14 to 2020-01-02", or one day; instants in seconds since 1970-01-01 UTC.
pub(crate) fn period(first_s: f64, last_s: f64) -> String {
    let day = |at_s| day_of(at_s).map_or_else(|| "–".to_owned(), |day| day.to_string());
    let (first, last) = (day(first_s), day(last_s));
    if first == last { first } else { format!("{first} to {last}") }
}

/// Every date at this step, none if there are more than `most`.
fn dates_between(first_s: f64, last_s: f64, step: Step, most: usize) -> Vec<(f64, Date)> {
    let mut dates = Vec::new();
    let mut date = day_of(first_s).and_then(|day| start(day, step));
    while let Some(this) = date {
        let Some(at) = seconds_of(this) else { break };
        if at > last_s {
            break;
        }
        if at >= first_s {
            if dates.len() == most {
                return Vec::new();
            }
            dates.push((at, this));
        }
        date = match step {
            Step::Days(days) => this.checked_add(days.days()),
            Step::Months(months) => this.checked_add(months.months()),
            Step::Years(years) => this.checked_add(years.years()),
        }
        .ok();
    }
    dates
}

/// A date not after `day` from which steps of months and years fall on round ones.
fn start(day: Date, step: Step) -> Option<Date> {
    match step {
        Step::Days(_) => Some(day),
        Step::Months(months) => {
            Date::new(day.year(), (day.month() - 1) / months * months + 1, 1).ok()
        }
        Step::Years(years) => Date::new(day.year().div_euclid(years) * years, 1, 1).ok(),
    }
}

fn day_of(unix_s: f64) -> Option<Date> {
    #[expect(clippy::cast_possible_truncation, reason = "what saturates is refused")]
    let instant = Timestamp::from_second(unix_s.floor() as i64).ok()?;
    Some(Offset::UTC.to_datetime(instant).date())
}

fn seconds_of(date: Date) -> Option<f64> {
    Some(Offset::UTC.to_timestamp(date.at(0, 0, 0, 0)).ok()?.as_second() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(text: &str) -> f64 {
        text.parse::<Timestamp>().unwrap().as_second() as f64
    }

    fn labels(from: &str, to: &str) -> Vec<String> {
        let axis = axis(seconds(from), seconds(to), 6);
        axis.ticks().iter().map(|tick| tick.label.clone()).collect()
    }

    #[test]
    fn days_months_and_years() {
        assert_eq!(labels("2019-03-14T18:00:00Z", "2019-03-14T18:00:00Z"), ["2019-03-15"]);
        assert_eq!(
            labels("2019-02-20T00:00:00Z", "2019-05-20T00:00:00Z"),
            ["2019-03-01", "2019-04-01", "2019-05-01"]
        );
        assert_eq!(
            labels("2012-06-01T00:00:00Z", "2020-03-01T00:00:00Z"),
            ["2014-01-01", "2016-01-01", "2018-01-01", "2020-01-01"]
        );
    }

    #[test]
    fn ticks_are_few_and_on_the_scale() {
        for days in [0.0, 0.2, 3.0, 17.0, 45.0, 200.0, 800.0, 4000.0, 40_000.0] {
            let low = seconds("1999-12-30T23:00:00Z");
            let axis = axis(low, low + days * SECONDS_PER_DAY, 6);
            assert!((1..=6).contains(&axis.ticks().len()), "{days}: {axis:?}");
            assert!(axis.ticks().iter().all(|tick| axis.holds(tick.at)));
        }
        assert!(axis(f64::NAN, 0.0, 6).ticks().is_empty());
    }

    #[test]
    fn a_day_is_that_of_utc() {
        assert_eq!(day("2019-03-14T23:30:00-02:00".parse().unwrap()), "2019-03-15");
    }
}
