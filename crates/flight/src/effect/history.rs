//! The course of a deterioration over months: it gathers steadily, and falls at dates.

use serde::{Deserialize, Serialize};
use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

/// Most falls that one history has.
pub const MAXIMUM_FALLS: usize = 8;

/// A deterioration that gathers at a constant rate, and of which each fall (a wash, an engine change, a repair) takes
/// back a share of what has gathered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "HistoryText", try_from = "HistoryText")]
pub struct History {
    since_s: f64,
    recovered: f64,
    /// In order of time, +∞ behind the last.
    falls_s: [f64; MAXIMUM_FALLS],
}

/// Why there is no such history.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum HistoryError {
    /// A share of less than nothing or of more than all.
    #[error("a fall takes back {0} of what has gathered; a share from 0 to 1 is expected")]
    Recovered(f64),
    /// More falls than a history has.
    #[error("{0} falls; at most {MAXIMUM_FALLS} are possible")]
    Falls(usize),
    /// An instant that is no number.
    #[error("an instant that is no finite number of seconds: {0}")]
    Instant(f64),
}

impl History {
    /// Without a fall, since the epoch.
    pub const NONE: Self =
        Self { since_s: 0.0, recovered: 1.0, falls_s: [f64::INFINITY; MAXIMUM_FALLS] };

    /// A history that begins to gather at an instant, s since 1970, and falls at others, each time by the same share of what
    /// has gathered.
    ///
    /// # Errors
    /// A share outside 0 to 1, more falls than [`MAXIMUM_FALLS`], an instant that is not finite.
    pub fn new(since_s: f64, recovered: f64, falls_s: &[f64]) -> Result<Self, HistoryError> {
        if !(0.0..=1.0).contains(&recovered) {
            return Err(HistoryError::Recovered(recovered));
        }
        if falls_s.len() > MAXIMUM_FALLS {
            return Err(HistoryError::Falls(falls_s.len()));
        }
        let instants = falls_s.iter().chain([&since_s]);
        if let Some(instant) = instants.copied().find(|instant| !instant.is_finite()) {
            return Err(HistoryError::Instant(instant));
        }
        let mut all = [f64::INFINITY; MAXIMUM_FALLS];
        all[..falls_s.len()].copy_from_slice(falls_s);
        all.sort_by(f64::total_cmp);
        Ok(Self { since_s, recovered, falls_s: all })
    }

    /// When it began to gather, s since 1970.
    #[must_use]
    pub const fn since_s(&self) -> f64 {
        self.since_s
    }

    /// The share of what has gathered that a fall takes back.
    #[must_use]
    pub const fn recovered(&self) -> f64 {
        self.recovered
    }

    /// Dates of the falls, s since 1970, in order of time.
    pub fn falls_s(&self) -> impl Iterator<Item = f64> + '_ {
        self.falls_s.iter().copied().take_while(|fall_s| fall_s.is_finite())
    }

    /// What has gathered at a date, in years of deterioration; negative before it began.
    ///
    /// ```text
    /// h = t − t0 before the first fall;  at a fall h becomes (1 − r)·h, and grows on with t      [diagnosis.48]
    /// ```
    #[must_use]
    pub fn years(&self, date_s: f64) -> f64 {
        let (mut gathered_s, mut last_s) = (0.0, self.since_s);
        for fall_s in self.falls_s().take_while(|fall_s| *fall_s <= date_s) {
            gathered_s = (gathered_s + fall_s - last_s) * (1.0 - self.recovered);
            last_s = fall_s;
        }
        (gathered_s + date_s - last_s) / (DAYS_PER_YEAR * SECONDS_PER_DAY)
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "History")]
struct HistoryText {
    since_s: f64,
    recovered: f64,
    falls_s: Vec<f64>,
}

impl From<History> for HistoryText {
    fn from(history: History) -> Self {
        Self {
            since_s: history.since_s,
            recovered: history.recovered,
            falls_s: history.falls_s().collect(),
        }
    }
}

impl TryFrom<HistoryText> for History {
    type Error = HistoryError;

    fn try_from(text: HistoryText) -> Result<Self, HistoryError> {
        Self::new(text.since_s, text.recovered, &text.falls_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const YEAR_S: f64 = DAYS_PER_YEAR * SECONDS_PER_DAY;

    /// By hand: a year of gathering, half of it taken back, half a year more, half of that sum taken back.
    #[test]
    fn gathers_and_falls_as_by_hand() {
        let at = |years: f64| 1.0e9 + years * YEAR_S;
        let history = History::new(at(0.0), 0.5, &[at(1.5), at(1.0)]).unwrap();
        for (years, expected) in [
            (-0.5, -0.5),
            (0.0, 0.0),
            (0.99, 0.99),
            (1.0, 0.5),
            (1.49, 0.99),
            (1.5, 0.5),
            (2.0, 1.0),
        ] {
            let found = history.years(at(years));
            assert!((found - expected).abs() < 1e-7, "{years} years: {found} for {expected}");
        }
        assert!((History::NONE.years(YEAR_S) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_history_is_refused() {
        assert_eq!(History::new(0.0, 1.1, &[]), Err(HistoryError::Recovered(1.1)));
        assert!(matches!(History::new(0.0, f64::NAN, &[]), Err(HistoryError::Recovered(_))));
        assert_eq!(History::new(0.0, 0.5, &[1.0; 9]), Err(HistoryError::Falls(9)));
        assert_eq!(
            History::new(f64::INFINITY, 0.5, &[]),
            Err(HistoryError::Instant(f64::INFINITY))
        );
    }
}
