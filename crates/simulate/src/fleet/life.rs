//! Deterioration of one airframe or engine over its dates, with washes and exchanges.

use flight::Timestamp;
use serde::{Deserialize, Serialize};
use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

/// Years in which deterioration loses its haste: after them it gathers at 0.37 of the first rate. Our choice.
const TIME_CONSTANT_YEARS: f64 = 3.0;

/// Level and deterioration of one airframe or engine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Life {
    /// Level without deterioration, %.
    pub level_percent: f64,
    /// Years of deterioration at `first`.
    pub age_years: f64,
    /// Where the dates begin.
    #[serde(with = "crate::effect::timestamp")]
    pub first: Timestamp,
    /// Deterioration per year when new, %.
    pub percent_per_year: f64,
    /// What is done to it, in order of time.
    pub events: Vec<LifeEvent>,
}

/// Something that is done to an airframe or engine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LifeEvent {
    /// When.
    #[serde(with = "crate::effect::timestamp")]
    pub at: Timestamp,
    /// What.
    pub what: Recovery,
}

/// What becomes better.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Recovery {
    /// This share of what has gathered is taken back.
    Wash(f64),
    /// Another one of this level, %, without deterioration.
    Exchange(f64),
}

/// The airframe's and every engine's life.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Lives {
    pub(crate) airframe: Option<Life>,
    pub(crate) engines: Vec<Life>,
}

impl Life {
    /// Level and deterioration at an instant, %.
    ///
    /// ```text
    /// d(t) = L + g(t),  dg/dt = r − g/τ,  g → (1 − q)·g at a wash,  L → L′ and g → 0 at an exchange      [virtual.20]
    /// ```
    #[must_use]
    pub fn percent_at(&self, instant: Timestamp) -> f64 {
        let saturated = self.percent_per_year * TIME_CONSTANT_YEARS;
        let grown = |from: f64, years: f64| {
            saturated + (from - saturated) * (-years.max(0.0) / TIME_CONSTANT_YEARS).exp()
        };
        let mut level = self.level_percent;
        let mut gathered = grown(0.0, self.age_years);
        let mut at = self.first;
        for event in self.events.iter().filter(|event| event.at <= instant) {
            gathered = grown(gathered, years(at, event.at));
            // One before the first flight is part of the age that the tail has by then.
            at = at.max(event.at);
            match event.what {
                Recovery::Wash(share) => gathered *= 1.0 - share,
                Recovery::Exchange(percent) => (level, gathered) = (percent, 0.0),
            }
        }
        level + grown(gathered, years(at, instant))
    }

    /// By how much an event changes it, %.
    #[must_use]
    pub(crate) fn change_percent(&self, event: usize) -> f64 {
        let Some(own) = self.events.get(event) else { return 0.0 };
        let before = Self { events: self.events[..event].to_vec(), ..self.clone() };
        let after = Self { events: self.events[..=event].to_vec(), ..self.clone() };
        after.percent_at(own.at) - before.percent_at(own.at)
    }
}

fn years(from: Timestamp, to: Timestamp) -> f64 {
    (flight::seconds_since_1970(to) - flight::seconds_since_1970(from))
        / (DAYS_PER_YEAR * SECONDS_PER_DAY)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn instant(text: &str) -> Timestamp {
        text.parse().unwrap()
    }

    fn life() -> Life {
        Life {
            level_percent: 0.5,
            age_years: 1.0,
            first: instant("2018-01-01T00:00:00Z"),
            percent_per_year: 1.2,
            events: vec![
                LifeEvent { at: instant("2018-07-01T00:00:00Z"), what: Recovery::Wash(0.7) },
                LifeEvent { at: instant("2019-03-01T00:00:00Z"), what: Recovery::Exchange(-0.2) },
            ],
        }
    }

    #[test]
    fn deterioration_against_its_differential_equation() {
        // Euler's method over days: dg/dt = r − g/τ with r = 1.2 %/year, τ = 3 years, from one year before the first date.
        let life = life();
        let step_years = 1.0 / 36_525.0;
        let mut gathered = 0.0;
        for _ in 0..36_525 {
            gathered += step_years * (1.2 - gathered / 3.0);
        }
        let mut level = 0.5;
        let day =
            |days: i64| Timestamp::from_second(life.first.as_second() + 86_400 * days).unwrap();
        for days in 0..600 {
            if days == 181 {
                gathered *= 0.3;
            }
            if days == 424 {
                (level, gathered) = (-0.2, 0.0);
            }
            let found = life.percent_at(day(days));
            assert!((found - level - gathered).abs() < 1e-4, "day {days}: {found}");
            for _ in 0..100 {
                gathered += step_years * (1.2 - gathered / 3.0);
            }
        }
    }

    /// By hand: what was gathered by the first date, 3.6·(1 − exp(−1/3)) = 1.0205, and the wash of months before leaves 0.3 of
    /// it; the months between do not count twice.
    #[test]
    fn an_event_before_the_first_date_does_not_age() {
        let wash = LifeEvent { at: instant("2017-07-01T00:00:00Z"), what: Recovery::Wash(0.7) };
        let life = Life { level_percent: 0.0, events: vec![wash], ..life() };
        let found = life.percent_at(life.first);
        assert!((found - 0.3 * 1.0205).abs() < 1e-4, "{found}");
    }

    #[test]
    fn an_event_changes_what_it_changes() {
        let life = life();
        // Gathered on 1 July: 3.6·(1 − exp(−(1 + 181/365.25)/3)) = 1.4135; the wash takes back 0.7 of it.
        assert!((life.change_percent(0) + 0.7 * 1.4135).abs() < 1e-3, "{}", life.change_percent(0));
        let before = life.percent_at(instant("2019-02-28T23:59:59Z"));
        assert!((life.change_percent(1) - (-0.2 - before)).abs() < 1e-6);
        let after = life.percent_at(instant("2019-03-01T00:00:00Z"));
        assert!((after + 0.2).abs() < 1e-12, "{after}");
    }
}
