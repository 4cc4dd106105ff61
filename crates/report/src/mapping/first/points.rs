//! Whether the rows of a recording are samples, or means over stable frames: by how far apart they are.

use std::collections::BTreeMap;

use super::super::MappedReport;
use super::LEVEL_CRUISE;
use super::columns::Columns;
use super::flights::each_flight;
use super::mass::START_MASS;
use super::rules::TEXTS;

const AVERAGED_POINTS: &str = "    // Rows too far apart for samples: means over stable frames.\n    rows: AveragedPoints(averaged_over_s: 60),   // ?\n";
/// A mass at the start of a flight needs samples to be followed from: of points each has its own.
const MASS_OF_POINTS: &str =
    "GrossMass(column: \"GROSS WEIGHT\", unit: \"kg\", largest_rise_kg: 200),   // ?";
/// Rows of a flight farther apart than this are no samples: a track refuses them.
pub(super) const LONGEST_STEP_S: f64 = 90.0;
/// Fewest rows from which anything is concluded.
const FEWEST_ROWS: usize = 3;
/// Rows of a flight up to which they are taken for points where no time says how far apart they are. Our choice: frames are
/// minutes apart, so that a long flight has some dozens, and samples of a flight are hundreds.
const MOST_POINTS: usize = 50;

/// The mapping with its rows as averaged points.
pub(super) fn of_points(mapping: &str) -> String {
    mapping.replace(LEVEL_CRUISE, AVERAGED_POINTS).replace(START_MASS, MASS_OF_POINTS)
}

/// Whether the rows of flights are too far apart for samples; `None` where the mapping reads no flight.
pub(super) fn are_far_apart(mapping: &str, text: &str) -> Option<bool> {
    let mut steps_s = Vec::new();
    let mut points = 0;
    each_flight(mapping, text, |converter, flight| {
        if let MappedReport::Points(flight) = converter.report(flight) {
            let time_s = &flight.parsed.report.columns().time_s;
            points += time_s.len();
            steps_s.extend(time_s.windows(2).map(|pair| pair[1] - pair[0]));
        }
    })?;
    // Flights of one row each have no step.
    (points >= FEWEST_ROWS).then(|| median(steps_s).is_none_or(|step_s| step_s > LONGEST_STEP_S))
}

pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

impl Columns {
    /// The same of rows that no mapping reads yet, because a column that it needs has no name that is known: by their times
    /// within each tail and flight, and without times by how few rows a flight has.
    pub(super) fn rows_are_far_apart(&self) -> bool {
        if self.rows.len() < FEWEST_ROWS {
            return false;
        }
        let of_flight: Vec<usize> =
            TEXTS[1..].iter().filter_map(|(_, names, _)| self.named(names)).collect();
        let mut flights: BTreeMap<Vec<&str>, Vec<&[String]>> = BTreeMap::new();
        for row in &self.rows {
            let key = of_flight.iter().map(|column| row.get(*column).map_or("", String::as_str));
            flights.entry(key.collect()).or_default().push(row);
        }
        let day = self.time_column().is_some_and(|column| self.counts_days(column));
        let unit_s = if day { 86_400.0 } else { 1.0 };
        let steps = flights.values().flat_map(|rows| self.steps_s(rows));
        let steps = steps.map(|step| step * unit_s).collect();
        let few = !of_flight.is_empty() && self.rows.len() <= MOST_POINTS * flights.len();
        median(steps).map_or(few && flights.len() > 1, |step_s| step_s > LONGEST_STEP_S)
    }

    /// The steps between the rows of a flight, in the order of their times; those over midnight as very long ones.
    fn steps_s(&self, rows: &[&[String]]) -> Vec<f64> {
        let mut times: Vec<(&str, f64)> = rows.iter().filter_map(|row| self.time_of(row)).collect();
        times.sort_by(|one, other| one.0.cmp(other.0).then(one.1.total_cmp(&other.1)));
        let step = |pair: &[(&str, f64)]| match pair {
            [(day, from), (next, to)] if day == next => to - from,
            _ => f64::INFINITY,
        };
        times.windows(2).map(step).collect()
    }

    /// The day, where there is one, and a time in seconds; `None` of a day alone.
    fn time_of<'r>(&self, row: &'r [String]) -> Option<(&'r str, f64)> {
        let text = row.get(self.time_column()?)?.as_str();
        if let Some(number) = self.number(text) {
            let per_second = match number {
                _ if number > 1e17 => 1e9,
                _ if number > 1e14 => 1e6,
                _ if number > 1e11 => 1e3,
                _ => 1.0,
            };
            return Some(("", number / per_second));
        }
        let (day, clock) = text.split_once(['T', ' ']).unwrap_or(("", text));
        let date = self.date_column().filter(|_| day.is_empty()).and_then(|column| row.get(column));
        let mut parts = clock.trim_end_matches('Z').splitn(3, ':').map(|part| {
            let digits = part.split(['+', '-']).next().unwrap_or_default();
            digits.parse::<f64>().ok()
        });
        let (hours, minutes) = (parts.next()??, parts.next()??);
        let seconds = parts.next().flatten().unwrap_or(0.0);
        let day = date.map_or(day, String::as_str);
        Some((day, 3600.0 * hours + 60.0 * minutes + seconds))
    }
}
