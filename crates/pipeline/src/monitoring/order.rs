//! The order in which a fleet is looked at: what is new first, then what differs from its type.

use std::collections::BTreeSet;

use flight::Timestamp;
use units::convert::SECONDS_PER_DAY;

use super::document::{Figure, MonitorDocument, TailDocument};

/// Days before the newest flight of a run within which a change counts as new. Our choice: a quarter of a year.
const NEW_DAYS: f64 = 90.0;

impl MonitorDocument {
    /// Tails by their places: those of which a rule fired, or which have changed in the last 90 days of the data, before the others;
    /// then those that burn most over the mean of their type, and of equal ones those that burn most.
    #[must_use]
    pub fn by_news(&self) -> Vec<usize> {
        let alerted: BTreeSet<&str> = self.alerts.iter().map(|alert| alert.tail.as_str()).collect();
        let newest = self.tails.iter().filter_map(|tail| tail.to.parse::<Timestamp>().ok()).max();
        let is_new = |since: &str| match (newest, since.parse::<Timestamp>()) {
            (Some(newest), Ok(since)) => {
                newest.duration_since(since).as_secs_f64() <= NEW_DAYS * SECONDS_PER_DAY
            }
            _ => false,
        };
        let key = |tail: &TailDocument| {
            let has_news = alerted.contains(tail.tail.as_str())
                || tail.told_changes().iter().any(|change| is_new(&change.since));
            let against = self.against_type(tail).map_or(0.0, |figure| figure.value);
            (has_news, against, tail.deviation_percent.value)
        };
        let keys: Vec<(bool, f64, f64)> = self.tails.iter().map(key).collect();
        let mut order: Vec<usize> = (0..keys.len()).collect();
        order.sort_by(|one, other| {
            let (one, other) = (keys[*one], keys[*other]);
            let news = other.0.cmp(&one.0);
            news.then(other.1.total_cmp(&one.1)).then(other.2.total_cmp(&one.2))
        });
        order
    }

    /// Whether the folder holds more than one type of aircraft.
    #[must_use]
    pub fn has_several_types(&self) -> bool {
        self.fleet.len() > 1
    }

    /// By how much a tail's present level is above the mean of the tails of its type, at the mean conditions of all of them, %, with
    /// the interval of the tail's level there: the mean is what these tails are compared with, whatever it is. `None` of the only
    /// tail of its type.
    #[must_use]
    pub fn against_type(&self, tail: &TailDocument) -> Option<Figure> {
        let fleet = self.fleet.iter().find(|fleet| fleet.aircraft_type == tail.aircraft_type)?;
        let mean = fleet.deviation_percent.value;
        (fleet.tails > 1).then(|| tail.compared_percent().map(|percent| percent - mean))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn figure(value: f64) -> Value {
        json!({ "value": value, "ci95": [value - 0.2, value + 0.2] })
    }

    /// A tail of which only this is known; `changed`: the day of its only change.
    fn tail(name: &str, of_type: &str, level: f64, changed: Option<&str>) -> TailDocument {
        let change = |day: &str| {
            let time = format!("{day}T00:00:00Z");
            json!({ "engine": 2, "since": time, "since_ci95": [time, time], "probability": 0.99,
                "step_percent": figure(1.0), "event": null })
        };
        let changes: Vec<Value> = changed.into_iter().map(change).collect();
        serde_json::from_value(json!({
            "tail": name, "aircraft_type": of_type, "from": "2025-01-01T00:00:00Z", "to": "2026-06-30T00:00:00Z",
            "reference": { "pressure_altitude_m": 1.0, "mach": 0.8, "static_air_temperature_k": 220.0, "mass_kg": 1.0,
                "true_airspeed_m_s": 1.0, "initial_fuel_flow_kg_s": 1.0, "segments": 1 },
            "deviation_percent": figure(level), "before_learning_percent": null, "trend_percent_per_year": figure(0.0),
            "within_flight_percent": 0.0, "between_flights_percent": 0.0, "correlation": 0.0,
            "airbus": { "specific_range_deviation_percent": 0.0, "specific_range_deviation_std_percent": null,
                "readings": 1, "monitored_fuel_factor_percent": figure(1.2), "retained_fuel_factor_percent": 1.3,
                "performance_factor_percent": null },
            "cost": { "flights_per_year": null, "fuel_kg_per_flight": 1.0, "fuel_kg_per_year": null,
                "co2_kg_per_year": null, "price_per_year": null },
            "changes": changes, "events": [], "months": [], "flights": []
        }))
        .unwrap()
    }

    /// By hand: R900 have a guide that is 5 % off and burn alike; N-3 burns 1 % more than the mean of its type, 88 days are new, 91 are
    /// not.
    #[test]
    fn what_is_new_comes_first_and_then_what_differs_from_its_type() {
        let tails = vec![
            tail("N-1", "N320", -3.3, None),
            tail("N-2", "N320", -3.5, Some("2026-04-03")),
            tail("N-3", "N320", -2.0, Some("2026-03-31")),
            tail("N-4", "N320", -3.2, None),
            tail("R-1", "R900", 5.0, None),
            tail("R-2", "R900", 5.0, None),
        ];
        let names = |document: &MonitorDocument| -> Vec<String> {
            document.by_news().into_iter().map(|place| document.tails[place].tail.clone()).collect()
        };
        let document = MonitorDocument::new(tails.clone(), Vec::new());
        assert!(document.has_several_types());
        let against = document.against_type(&document.tails[2]).unwrap();
        assert!((against.value - 1.0).abs() < 1e-9 && (against.half_width() - 0.2).abs() < 1e-9);
        assert_eq!(names(&document), ["N-2", "N-3", "R-1", "R-2", "N-4", "N-1"]);
        let alert = super::super::AlertDocument {
            tail: "R-2".to_owned(),
            engine: None,
            rule: "deviation=2".to_owned(),
            size: document.tails[5].deviation_percent,
            unit: "%".to_owned(),
            since: String::new(),
            step_in_gap: None,
            likely_causes: Vec::new(),
            likely_causes_in_words: Vec::new(),
            no_likely_cause: None,
        };
        let document = MonitorDocument::new(tails, vec![alert]);
        assert_eq!(names(&document)[..2], ["R-2", "N-2"]);
        let printed = super::super::text(&document, super::super::Rows::Tails);
        let rows: Vec<&str> = printed.lines().skip(1).take(3).collect();
        assert!(rows[0].starts_with("tail  type  flights"), "{printed}");
        assert!(rows[1].starts_with("R-2   R900"), "{printed}");
        // Of one type alone there is no such column, and of a tail alone no mean of others.
        let alone = MonitorDocument::new(vec![document.tails[0].clone()], Vec::new());
        assert!(!alone.has_several_types() && alone.against_type(&alone.tails[0]).is_none());
    }
}
