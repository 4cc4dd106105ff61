//! A tail of `monitor.html` in plain words: what its fuel flow does, and what to do about it. Sentences have per cent of what is
//! predicted; the figures that they are made from are logarithms.

use pipeline::monitoring::{
    AlertDocument, ChangeDocument, Figure, FleetDocument, MonitorDocument, TailDocument,
    TypeConditions, monitored_fuel_factor_percent,
};

use super::{day, figure};
use crate::text::{signed, signed_tenths};
use pipeline::summary::counted;

/// Whether the tail burns more or less than its book says.
fn burns_otherwise(tail: &TailDocument) -> bool {
    differs_from_zero(&tail.deviation_percent)
}

/// Fewest tails of a type whose mean says what is the model's.
const FEWEST_TAILS: usize = 3;

/// Whether there is a cause to look for on the tail: it burns otherwise than predicted, and otherwise than its type, or since a change
/// that no event explains. What all tails of a type burn otherwise is the model's.
pub(super) fn has_cause_to_find(tail: &TailDocument, document: &MonitorDocument) -> bool {
    burns_otherwise(tail)
        && (unexplained(tail).next().is_some() || differs_from_type(tail, document))
}

fn differs_from_type(tail: &TailDocument, document: &MonitorDocument) -> bool {
    let is_its = |fleet: &&FleetDocument| fleet.aircraft_type == tail.aircraft_type;
    let fleet = document.fleet.iter().find(is_its);
    let is_known = fleet.is_some_and(|fleet| fleet.tails >= FEWEST_TAILS);
    let against = document.against_type(tail).filter(|_| is_known);
    against.is_none_or(|against| differs_from_zero(&against))
}

/// Changes that no event explains, each event once.
fn unexplained(tail: &TailDocument) -> impl Iterator<Item = &ChangeDocument> {
    let is_unexplained = |change: &&ChangeDocument| {
        change.event.is_none() && differs_from_zero(&change.step_percent)
    };
    tail.told_changes().into_iter().filter(is_unexplained)
}

/// The newest of some changes. Instants are written alike, in UTC; of several at one the first, that of all engines.
pub(super) fn newest<'a>(
    changes: impl DoubleEndedIterator<Item = &'a ChangeDocument>,
) -> Option<&'a ChangeDocument> {
    changes.rev().max_by(|one, other| one.since.cmp(&other.since))
}

/// What the fuel flow of a tail does, in a sentence.
pub(super) fn found(tail: &TailDocument) -> String {
    let level = &tail.deviation_percent;
    let level = if burns_otherwise(tail) {
        format!(
            "Burns {} % {} than its book says (level {})",
            size(&of_predicted(level)),
            more_or_less(level.value),
            figure(level)
        )
    } else {
        format!("Burns what its book says ({} %)", figure(&of_predicted(level)))
    };
    let Some(trend) = &tail.trend_percent_per_year.as_ref().map(of_predicted) else {
        return format!("{level}; the flights are too few to show a trend.");
    };
    if differs_from_zero(trend) {
        let each_year =
            format!("{level}, and {} % {} each year", size(trend), more_or_less(trend.value));
        match &tail.step_in_gap {
            Some(step) => {
                let by = of_predicted(&step.step_percent);
                format!(
                    "{each_year}, or {} % {} since one step between {} and {}, when it did not fly: which of the two, these flights \
                     cannot say.",
                    size(&by),
                    more_or_less(by.value),
                    day(&step.after),
                    day(&step.until)
                )
            }
            None => format!("{each_year}."),
        }
    } else {
        format!("{level}; no trend stands out ({} % a year).", figure(trend))
    }
}

/// Changes that an event explains: they are part of the level and of no trend.
pub(super) fn explained(tail: &TailDocument) -> Option<String> {
    let of = |change: &ChangeDocument| {
        let event = change.event_in_words()?;
        let engine = change.engine.map_or_else(String::new, |engine| format!("engine {engine} "));
        let step = figure(&of_predicted(&change.step_percent));
        Some(format!("{engine}{step} % since {}, with the event {event}", day(&change.since)))
    };
    let changes: Vec<String> = tail
        .told_changes()
        .into_iter()
        .filter(|change| differs_from_zero(&change.step_percent))
        .filter_map(of)
        .collect();
    (!changes.is_empty()).then(|| format!("Changed: {}.", changes.join("; ")))
}

/// What of it all tails of the type have: an aircraft is not sent to a hangar for what its model lacks.
pub(super) fn shared(tail: &TailDocument, fleets: &[FleetDocument]) -> Option<String> {
    let fleet = fleets.iter().find(|fleet| fleet.aircraft_type == tail.aircraft_type)?;
    let level = &fleet.deviation_percent;
    let same_sign = level.value * tail.deviation_percent.value > 0.0;
    (fleet.tails >= FEWEST_TAILS && burns_otherwise(tail) && differs_from_zero(level) && same_sign).then(|| {
        format!(
            "The {} tails of its type burn {} % {} in the mean: that part is the model's rather than the aircraft's.",
            fleet.tails,
            size(&of_predicted(level)),
            more_or_less(level.value)
        )
    })
}

/// Against the other tails of its type, at conditions common to all of them.
pub(super) fn compared(tail: &TailDocument, document: &MonitorDocument) -> Option<String> {
    let fleet = document.fleet.iter().find(|fleet| fleet.aircraft_type == tail.aircraft_type)?;
    let against = document.against_type(tail).map(|against| of_predicted(&against))?;
    tail.at_type_conditions_percent?;
    let burns = if differs_from_zero(&against) {
        format!("burns {} % {} than", size(&against), more_or_less(against.value))
    } else {
        format!("burns as much ({} %) as", figure(&against))
    };
    Some(format!(
        "At the mean conditions of its type ({}; its own are {}) it {burns} the {} tails in the mean.",
        fleet.reference.in_words(),
        TypeConditions::from(&tail.reference).in_words(),
        fleet.tails
    ))
}

/// What to do about it; never empty.
pub(super) fn advice(tail: &TailDocument, document: &MonitorDocument) -> Vec<String> {
    // The newest is the one that can still be looked up; the others are listed below it.
    let unexplained: Vec<&ChangeDocument> = unexplained(tail).collect();
    let newest = newest(unexplained.into_iter());
    let mut told: Vec<String> = newest.map(look_up).into_iter().collect();
    told.extend(drift(tail));
    if has_cause_to_find(tail, document) {
        told.push(cause(tail, &document.alerts, newest));
        told.push(format!("Until then: {}.", plan_with(tail)));
    } else if burns_otherwise(tail) {
        told.push(format!("For flight planning: {}.", plan_with(tail)));
    }
    if told.is_empty() {
        told.push("Nothing to do.".to_owned());
    }
    told
}

/// What to do about a trend: where it may be a step, that is looked up first.
fn drift(tail: &TailDocument) -> Option<String> {
    if let Some(step) = &tail.step_in_gap {
        return Some(format!(
            "Look up what was done between {} and {}: a step then explains the flights about as well as wear or dirt year by year.",
            day(&step.after),
            day(&step.until)
        ));
    }
    let rises = |change: &&ChangeDocument| change.step_percent.ci95[0] > 0.0;
    let told = tail.told_changes();
    let beside = newest(told.into_iter().filter(rises)).map_or_else(String::new, |change| {
        format!(", beside the change of {}", day(&change.since))
    });
    tail.trend_percent_per_year.is_some_and(|trend| trend.ci95[0] > 0.0).then(|| {
        format!(
            "Wear, or dirt on engines or airframe{beside}: cruisefit diagnose says which of them fits the flights."
        )
    })
}

/// The factor of the level with its interval, as it is entered: rounded up. Where it is that of flights too few for a trend, their
/// number is said.
fn plan_with(tail: &TailDocument) -> String {
    let factor = &tail.airbus;
    let [low, high] = factor.fuel_factor_percent.ci95;
    let few = match tail.trend_percent_per_year {
        Some(_) => String::new(),
        None => format!(", by {} alone", counted(tail.flights.len(), "flight")),
    };
    let interval = format!("95 % interval {} to {} %{few}", signed(Some(low)), signed(Some(high)));
    let entered = signed_tenths(factor.entered_fuel_factor_percent());
    match factor.performance_factor_percent {
        Some(percent) => format!(
            "FMS PERF FACTOR {} %, with a fuel factor of {entered} % ({interval})",
            signed_tenths(percent)
        ),
        None => format!("plan with a fuel factor of {entered} % ({interval})"),
    }
}

fn look_up(change: &ChangeDocument) -> String {
    let of = change.engine.map_or_else(String::new, |engine| format!(" of engine {engine}"));
    format!(
        "Look up what was done between {} and {}: the fuel flow{of} changed by {} %, and no event states why.",
        day(&change.since_ci95[0]),
        day(&change.since_ci95[1]),
        figure(&of_predicted(&change.step_percent))
    )
}

/// The likely causes of an alert, the most probable first.
pub(super) fn likely(alert: &AlertDocument) -> String {
    let in_words = &alert.likely_causes_in_words;
    if in_words.is_empty() { alert.likely_causes.join(", ") } else { in_words.join(", or ") }
}

/// Where the cause is named, or how to find it: by a model that has not learnt these flights.
fn cause(tail: &TailDocument, alerts: &[AlertDocument], newest: Option<&ChangeDocument>) -> String {
    let of_tail = || alerts.iter().filter(|alert| alert.tail == tail.tail);
    if let Some(alert) = of_tail().find(|alert| !alert.likely_causes.is_empty()) {
        let causes = likely(alert);
        return format!("The newest diagnosis says: {causes}. Its page says what to do.");
    }
    if let Some(reason) = of_tail().find_map(|alert| alert.no_likely_cause.as_ref()) {
        return format!("The newest diagnosis names no cause: {reason}.");
    }
    let older = newest.map_or_else(String::new, |change| {
        format!(
            " For the change alone take the model of {} in a copy of the folder from before {}, and the reports since then.",
            tail.tail,
            day(&change.since_ci95[0])
        )
    });
    format!(
        "Find the cause: cruisefit diagnose REPORTS --model MODEL.ron -o DIR, with the reports of {}, the initial model of type {}, \
         which was given to cruisefit adapt, and a new folder; the tail's own model has learnt these flights, which hides what is \
         found here.{older}",
        tail.tail, tail.aircraft_type
    )
}

/// 100 ln(recorded/predicted) as per cent of what is predicted; a trend or a step, of what was burnt before it.
fn of_predicted(figure: &Figure) -> Figure {
    figure.map(monitored_fuel_factor_percent)
}

fn differs_from_zero(figure: &Figure) -> bool {
    figure.ci95[0] > 0.0 || figure.ci95[1] < 0.0
}

fn more_or_less(percent: f64) -> &'static str {
    if percent > 0.0 { "more" } else { "less" }
}

fn size(figure: &Figure) -> String {
    format!("{:.2} ± {:.2}", figure.value.abs(), figure.half_width())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(value: f64, half: f64) -> serde_json::Value {
        serde_json::json!({ "value": value, "ci95": [value - half, value + half] })
    }

    /// A tail of which only this is known.
    fn tail(level: (f64, f64), trend: (f64, f64), changes: &serde_json::Value) -> TailDocument {
        serde_json::from_value(serde_json::json!({
            "tail": "N1", "aircraft_type": "C750", "model": "law bayes, 3 flights of N1 learnt",
            "from": "2026-01-01T00:00:00Z", "to": "2026-03-01T00:00:00Z",
            "reference": { "pressure_altitude_m": 1.0, "mach": 0.8, "static_air_temperature_k": 220.0, "mass_kg": 1.0,
                "true_airspeed_m_s": 1.0, "initial_fuel_flow_kg_s": 1.0, "segments": 1 },
            "deviation_percent": figure(level.0, level.1), "before_learning_percent": null,
            "trend_percent_per_year": figure(trend.0, trend.1),
            "within_flight_percent": 0.0, "between_flights_percent": 0.0, "correlation": 0.0,
            "airbus": { "specific_range_deviation_percent": 0.0, "specific_range_deviation_std_percent": null,
                "readings": 1, "fuel_factor_percent": figure(1.2072, 0.2012), "monitored_fuel_factor_percent": figure(1.2, 0.2),
                "retained_fuel_factor_percent": 1.3, "performance_factor_percent": null },
            "cost": { "flights_per_year": null, "fuel_kg_per_flight": 1.0, "fuel_kg_per_year": null,
                "co2_kg_per_year": null, "price_per_year": null },
            "changes": changes, "events": [], "months": [], "flights": []
        }))
        .unwrap()
    }

    fn alone(tail: &TailDocument, alerts: &[AlertDocument]) -> MonitorDocument {
        MonitorDocument::new(vec![tail.clone()], alerts.to_vec())
    }

    fn change(day: &str, event: Option<&str>) -> serde_json::Value {
        let time = format!("{day}T00:00:00Z");
        serde_json::json!({ "engine": 2, "since": time, "since_ci95": [time, time], "probability": 0.99,
            "step_percent": figure(1.0, 0.2), "event": event })
    }

    #[test]
    fn a_tail_that_burns_what_is_predicted_needs_nothing() {
        let tail = tail((0.1, 0.3), (-1.0, 2.0), &serde_json::json!([]));
        assert_eq!(
            found(&tail),
            "Burns what its book says (+0.10 ± 0.30 %); no trend stands out (-1.00 ± 2.00 % a year)."
        );
        assert_eq!(advice(&tail, &alone(&tail, &[])), ["Nothing to do."]);
    }

    #[test]
    fn what_all_tails_have_is_the_models() {
        let tail = tail((9.2, 0.3), (0.0, 1.0), &serde_json::json!([]));
        let fleet = |tails: usize, level: f64| FleetDocument {
            aircraft_type: "C750".to_owned(),
            tails,
            reference: TypeConditions::from(&tail.reference),
            deviation_percent: Figure { value: level, ci95: [level - 0.5, level + 0.5] },
            between_tails_percent: 0.7,
            trend_percent_per_year: tail.trend_percent_per_year,
            months: Vec::new(),
        };
        let told = shared(&tail, &[fleet(8, 8.0)]).unwrap();
        assert!(told.starts_with("The 8 tails of its type burn 8.33 ± 0.54 % more"), "{told}");
        // A tail alone, a fleet that burns as predicted, one that burns less: no part of this is shared.
        for other in [fleet(1, 9.2), fleet(8, 0.3), fleet(8, -1.0)] {
            assert_eq!(shared(&tail, &[other]), None);
        }
    }

    /// By hand: e^0.0961 = 1.100869, e^0.1032 = 1.108713; 9.61 alone would be the share of neither flow.
    #[test]
    fn what_is_said_is_per_cent_of_what_is_predicted() {
        let tail = tail((9.61, 0.71), (0.0, 1.0), &serde_json::json!([]));
        assert!(
            found(&tail)
                .starts_with("Burns 10.09 ± 0.78 % more than its book says (level +9.61 ± 0.71);"),
            "{}",
            found(&tail)
        );
    }

    #[test]
    fn a_diagnosis_that_names_none_says_why() {
        let tail = tail((1.2, 0.2), (0.0, 1.0), &serde_json::json!([]));
        let alert = AlertDocument {
            tail: "N1".to_owned(),
            engine: None,
            rule: "deviation=1".to_owned(),
            size: tail.deviation_percent,
            unit: "%".to_owned(),
            since: tail.from.clone(),
            step_in_gap: None,
            likely_causes: Vec::new(),
            likely_causes_in_words: Vec::new(),
            no_likely_cause: Some("no cause stands out".to_owned()),
        };
        let told = advice(&tail, &alone(&tail, &[alert]));
        assert_eq!(told[0], "The newest diagnosis names no cause: no cause stands out.");
    }

    #[test]
    fn the_newest_change_that_no_event_explains_is_looked_up() {
        let changes = [
            change("2026-02-05", None),
            change("2026-01-05", None),
            change("2026-02-20", Some("wash")),
        ];
        let tail = tail((1.2, 0.2), (0.5, 0.1), &serde_json::json!(changes));
        assert_eq!(
            found(&tail),
            "Burns 1.21 ± 0.20 % more than its book says (level +1.20 ± 0.20), and 0.50 ± 0.10 % more each year."
        );
        let told = advice(&tail, &alone(&tail, &[]));
        assert_eq!(told.len(), 4, "{told:?}");
        assert!(told[0].contains("2026-02-05") && told[0].contains("engine 2"), "{told:?}");
        assert!(told[2].starts_with("Find the cause"), "{told:?}");
        assert!(
            told[3]
                .ends_with("plan with a fuel factor of +1.3 % (95 % interval +1.01 to +1.41 %)."),
            "{told:?}"
        );
    }

    #[test]
    fn a_trend_that_may_be_a_step_is_no_wear_for_certain() {
        let certain = tail((1.2, 0.2), (1.7, 0.4), &serde_json::json!([]));
        let told = advice(&certain, &alone(&certain, &[]));
        assert!(told[0].starts_with("Wear, or dirt"), "{told:?}");
        let step = serde_json::json!({ "after": "2026-01-05T00:00:00Z", "until": "2026-02-20T00:00:00Z",
            "step_percent": figure(1.5, 0.3) });
        let doubted =
            TailDocument { step_in_gap: serde_json::from_value(step).unwrap(), ..certain };
        let words = "1.71 ± 0.41 % more each year, or 1.51 ± 0.30 % more since one step between 2026-01-05 and 2026-02-20";
        assert!(found(&doubted).contains(words), "{}", found(&doubted));
        let told = advice(&doubted, &alone(&doubted, &[]));
        assert!(told[0].starts_with("Look up what was done between 2026-01-05"), "{told:?}");
        assert!(!told.iter().any(|advice| advice.contains("Wear")), "{told:?}");
    }

    #[test]
    fn few_flights_show_no_trend_and_are_counted_where_planned_with() {
        let few = TailDocument {
            trend_percent_per_year: None,
            ..tail((1.2, 0.2), (0.0, 1.0), &serde_json::json!([]))
        };
        assert!(
            found(&few).ends_with("; the flights are too few to show a trend."),
            "{}",
            found(&few)
        );
        let told = advice(&few, &alone(&few, &[]));
        assert!(told[1].ends_with("+1.41 %, by 0 flights alone)."), "{told:?}");
    }

    /// Two tails that burn 2 % differently as they are flown, and alike at common conditions.
    #[test]
    fn tails_are_compared_at_common_conditions() {
        let flown = |name: &str, level: f64, common: f64| TailDocument {
            tail: name.to_owned(),
            at_type_conditions_percent: Some(Figure {
                value: common,
                ci95: [common - 0.3, common + 0.3],
            }),
            ..tail((level, 0.2), (0.0, 1.0), &serde_json::json!([]))
        };
        let tails = vec![flown("N1", -1.0, -2.0), flown("N2", -3.0, -2.1)];
        let document = MonitorDocument::new(tails, Vec::new());
        let told = compared(&document.tails[0], &document).unwrap();
        assert!(told.contains("it burns as much (+0.05 ± 0.30 %) as the 2 tails"), "{told}");
        assert!(told.contains("its own are Mach 0.800, 0 ft, 0 kg"), "{told}");
        let tails = vec![flown("N1", -2.0, -1.0), flown("N2", -2.0, -3.0)];
        let document = MonitorDocument::new(tails, Vec::new());
        let told = compared(&document.tails[0], &document).unwrap();
        assert!(told.contains("it burns 1.01 ± 0.30 % more than the 2 tails"), "{told}");
        assert_eq!(compared(&document.tails[0], &alone(&document.tails[0], &[])), None);
    }

    #[test]
    fn a_diagnosis_at_hand_is_quoted_of_its_own_tail_alone() {
        let tail = tail((-1.2, 0.2), (0.0, 1.0), &serde_json::json!([]));
        let alert = |name: &str| AlertDocument {
            tail: name.to_owned(),
            engine: None,
            rule: "deviation=1".to_owned(),
            size: tail.deviation_percent,
            unit: "%".to_owned(),
            since: tail.from.clone(),
            step_in_gap: None,
            likely_causes: vec![format!("cause_of_{name}")],
            likely_causes_in_words: vec![format!("what is of {name} (cause_of_{name})")],
            no_likely_cause: None,
        };
        let told = advice(&tail, &alone(&tail, &[alert("N2"), alert("N1")]));
        assert!(told[0].contains("what is of N1 (cause_of_N1)"), "{told:?}");
        assert!(found(&tail).starts_with("Burns 1.19 ± 0.20 % less"), "{}", found(&tail));
    }

    /// Four tails of +8 %, of which two have changed, one by a wash; then one of four burns 0.75 % more than the mean of all.
    #[test]
    fn a_cause_is_looked_for_where_a_tail_differs_from_its_type_or_has_changed() {
        let none = serde_json::json!([]);
        let named = |name: &str, level: f64, changes: &serde_json::Value| TailDocument {
            tail: name.to_owned(),
            ..tail((level, 0.3), (0.0, 1.0), changes)
        };
        let unexplained = serde_json::json!([change("2026-02-05", None)]);
        let washed = serde_json::json!([change("2026-02-05", Some("wash"))]);
        let alike = MonitorDocument::new(
            [("N1", &none), ("N2", &unexplained), ("N3", &washed), ("N5", &none)]
                .map(|(name, changes)| named(name, 8.0, changes))
                .to_vec(),
            Vec::new(),
        );
        let found: Vec<bool> =
            alike.tails.iter().map(|tail| has_cause_to_find(tail, &alike)).collect();
        assert_eq!(found, [false, true, false, false]);
        let levels = [("N1", 8.0), ("N2", 8.0), ("N3", 8.0), ("N4", 9.0)];
        let tails = levels.map(|(name, level)| named(name, level, &none)).to_vec();
        let other = MonitorDocument::new(tails, Vec::new());
        assert!(has_cause_to_find(&other.tails[3], &other));
        assert!(!has_cause_to_find(&other.tails[0], &other));
        let told = advice(&alike.tails[0], &alike);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].starts_with("For flight planning: plan with a fuel factor"), "{told:?}");
        let told = advice(&alike.tails[1], &alike);
        let words = "cruisefit diagnose REPORTS --model MODEL.ron -o DIR, with the reports of N2, the initial model of type C750, which was given to cruisefit adapt";
        assert!(told[1].contains(words), "{told:?}");
        assert!(told[1].contains("from before 2026-02-05"), "{told:?}");
    }

    /// 1.88 % of one engine is 0.94 % of two: one event, of which the engine's interval of the date is the narrower.
    #[test]
    fn the_engine_that_changed_is_named_and_its_date() {
        let changes = serde_json::json!([
            { "engine": null, "since": "2024-10-14T00:00:00Z",
              "since_ci95": ["2024-09-30T00:00:00Z", "2024-10-17T00:00:00Z"], "probability": 0.9,
              "step_percent": figure(0.87, 0.30), "event": null },
            { "engine": 2, "since": "2024-10-04T00:00:00Z",
              "since_ci95": ["2024-10-04T00:00:00Z", "2024-10-07T00:00:00Z"], "probability": 1.0,
              "step_percent": figure(1.88, 0.32), "event": null },
        ]);
        let tail = tail((1.2, 0.2), (0.0, 1.0), &changes);
        let told = advice(&tail, &alone(&tail, &[]));
        let words = "between 2024-10-04 and 2024-10-07: the fuel flow of engine 2 changed by +1.90";
        assert!(told[0].contains(words), "{told:?}");
    }
}
