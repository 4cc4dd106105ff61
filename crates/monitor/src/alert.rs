//! Rules by which a tail's history is brought to somebody's attention.

use core::fmt;
use core::str::FromStr;

use flight::Timestamp;
use units::convert::SECONDS_PER_DAY;

use crate::history::{Change, History};
use crate::levels::Estimate;
use crate::series::Series;

/// A rule: `deviation=PCT`, `trend=PCT_A_YEAR`, `change=PCT` or `change=PCT/DAYSd`.
///
/// A rule fires where the size is at least its limit, in either direction, and its 95 % interval does not hold 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlertRule {
    /// The present level against the reference, %.
    Deviation {
        /// Limit, %.
        percent: f64,
    },
    /// The trend between changes, % a year; not where the flights do not show it.
    Trend {
        /// Limit, % a year.
        percent_per_year: f64,
    },
    /// A step.
    Change {
        /// Limit, %.
        percent: f64,
        /// Only one within these many days before the tail's last flight; without it, any.
        days: Option<f64>,
    },
}

/// Why a text is not a rule.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "found {found:?}, expected deviation=PCT, trend=PCT, change=PCT or change=PCT/DAYSd with a number above 0"
)]
pub struct AlertRuleError {
    found: String,
}

/// A rule that fired.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alert {
    /// The rule.
    pub rule: AlertRule,
    /// What it looked at: %, of a trend % a year.
    pub size: Estimate,
    /// Since when: the change itself; of the level the last change before it, or the first flight where none was found; of the
    /// trend, which all pieces between changes share, the first flight.
    pub since: Timestamp,
}

impl FromStr for AlertRule {
    type Err = AlertRuleError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || AlertRuleError { found: text.to_owned() };
        let positive = |text: &str| {
            text.parse::<f64>()
                .ok()
                .filter(|value| *value > 0.0 && value.is_finite())
                .ok_or_else(wrong)
        };
        let (name, limit) = text.split_once('=').ok_or_else(wrong)?;
        match name {
            "deviation" => Ok(Self::Deviation { percent: positive(limit)? }),
            "trend" => Ok(Self::Trend { percent_per_year: positive(limit)? }),
            "change" => {
                let (percent, days) = match limit.split_once('/') {
                    None => (limit, None),
                    Some((percent, days)) => {
                        (percent, Some(days.strip_suffix('d').ok_or_else(wrong)?))
                    }
                };
                Ok(Self::Change {
                    percent: positive(percent)?,
                    days: days.map(positive).transpose()?,
                })
            }
            _ => Err(wrong()),
        }
    }
}

impl fmt::Display for AlertRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Deviation { percent } => write!(f, "deviation={percent}"),
            Self::Trend { percent_per_year } => write!(f, "trend={percent_per_year}"),
            Self::Change { percent, days: None } => write!(f, "change={percent}"),
            Self::Change { percent, days: Some(days) } => write!(f, "change={percent}/{days}d"),
        }
    }
}

impl AlertRule {
    /// What of a history this rule is about: every change that is large enough, or the one level or trend.
    #[must_use]
    pub fn apply(&self, series: &Series, history: &History) -> Vec<Alert> {
        let flights = series.flights();
        let Some(last) = flights.last() else { return Vec::new() };
        let last_change = history.levels.boundaries().last().copied().unwrap_or(0);
        let one = |size: Estimate, limit: f64, since: Timestamp| {
            let fires = size.value.abs() >= limit && size.differs_from_zero();
            fires.then_some(Alert { rule: *self, size, since })
        };
        let since = flights[last_change].time();
        match *self {
            Self::Deviation { percent } => {
                let level = history.levels.last_level_percent(series);
                one(level, percent, since).into_iter().collect()
            }
            Self::Trend { percent_per_year } => {
                let trend = history.levels.measured_trend_percent_per_year();
                trend
                    .and_then(|trend| one(trend, percent_per_year, flights[0].time()))
                    .into_iter()
                    .collect()
            }
            Self::Change { percent, days } => {
                let recent = |change: &&Change| {
                    let age = last.time().duration_since(flights[change.first_flight].time());
                    days.is_none_or(|days| age.as_secs_f64() <= days * SECONDS_PER_DAY)
                };
                let changes = history.changes.iter().filter(recent);
                changes
                    .filter_map(|change| {
                        one(change.step_percent, percent, flights[change.first_flight].time())
                    })
                    .collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::FlightDeviation;
    use crate::settings::ChangeBeliefs;

    #[test]
    fn rules_read_back_and_wrong_ones_are_refused() {
        for text in ["deviation=2", "trend=1.5", "change=1", "change=0.8/30d"] {
            assert_eq!(text.parse::<AlertRule>().unwrap().to_string(), text);
        }
        for text in [
            "",
            "deviation",
            "deviation=",
            "deviation=-1",
            "deviation=NaN",
            "speed=1",
            "change=1/30",
            "change=1/0d",
        ] {
            assert!(text.parse::<AlertRule>().is_err(), "{text}");
        }
    }

    /// A step of 2 % on day 30 of 60, flights of ± 0.2 %: by construction.
    #[test]
    fn a_step_fires_by_size_and_by_age() {
        let flights = (0..60).map(|day| {
            let time = Timestamp::from_second(86_400 * day).unwrap();
            let step = if day < 30 { 0.0 } else { 2.0 };
            FlightDeviation::of_segments(time, &[step + if day % 2 == 0 { 0.2 } else { -0.2 }])
                .unwrap()
        });
        let series = Series::new(flights.collect()).unwrap();
        let history = History::fit(&series, &[], &ChangeBeliefs::of_2026()).unwrap();
        let fired = |text: &str| text.parse::<AlertRule>().unwrap().apply(&series, &history);
        let alerts = fired("change=1.5");
        assert_eq!(alerts.len(), 1);
        assert_eq!(alerts[0].since, series.flights()[30].time());
        assert!((alerts[0].size.value - 2.0).abs() < 0.3);
        assert_eq!(fired("change=1.5/30d").len(), 1);
        assert!(fired("change=1.5/28d").is_empty());
        assert!(fired("change=2.5").is_empty());
        assert_eq!(fired("deviation=1.5").len(), 1);
        assert!(fired("trend=1.0").is_empty());
    }
}
