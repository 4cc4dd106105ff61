//! From segments with a planted change to what `monitor` states.
#![expect(clippy::unwrap_used, reason = "a test that cannot continue must stop")]

use pipeline::model_file::{GuideRecord, LawSettings, ModelFile};
use pipeline::monitoring::{
    BeforeLearning, Event, MonitorDocument, MonitorOptions, MonitoredTail, Rows, TailDeviations,
    TailDocument, tables, text,
};
use test_support::fleet::{Background, Setup, exact_model, fly};

/// A model that has learnt nothing: deviations are those of the initial model.
fn model() -> ModelFile {
    ModelFile {
        initial: exact_model(),
        guide: GuideRecord {
            points: 0,
            lift_coefficient: (0.1, 0.7),
            mach: (0.5, 0.9),
            residual_rms: 0.0,
            condition_number: 1.0,
        },
        settings: LawSettings::published(),
        learnt: None,
        applied: Vec::new(),
    }
}

/// Sixty flights without any effect; from the 31st on, engine 2 burns 3 % more. Events lie an hour before that flight.
fn changed(kinds: &[&str]) -> TailDocument {
    let fleet = fly(160, &Setup::default(), &[], &Background::default());
    let mut segments = Vec::new();
    for (number, mut flight) in fleet.flights.into_iter().enumerate() {
        for segment in flight.iter_mut().filter(|_| number >= 30) {
            let flows = &mut segment.means.fuel_flow_engine_kg_s;
            flows[1] *= 1.03;
            segment.means.fuel_flow_total_kg_s = flows.iter().sum();
        }
        segments.extend(flight);
    }
    let model = model();
    let deviations = TailDeviations::new(&model, &segments, BeforeLearning::LeaveOut).unwrap();
    let tail = segments[0].identity.tail.clone();
    let time = deviations.flights[30].start - jiff::SignedDuration::from_hours(1);
    let event = |kind: &&str| Event {
        time,
        tail: tail.clone(),
        kind: (*kind).to_owned(),
        note: String::new(),
    };
    let events: Vec<Event> = kinds.iter().map(event).collect();
    let found = MonitoredTail::new(&tail, &deviations, &events).unwrap().unwrap();
    found.document(&MonitorOptions::default())
}

/// Oracle: what was planted, 100·ln 1.03 on engine 2, nothing on engine 1, and 100·ln 1.015 on both together.
#[test]
fn an_engine_that_burns_more_is_found_on_its_engine() {
    let tail = changed(&[]);
    let of = |engine: Option<usize>| -> Vec<_> {
        tail.changes.iter().filter(|change| change.engine == engine).collect()
    };
    for (engine, step) in [(None, 100.0 * 1.015_f64.ln()), (Some(2), 100.0 * 1.03_f64.ln())] {
        let found = of(engine);
        assert_eq!(found.len(), 1, "{engine:?}: {found:?}");
        let size = found[0].step_percent;
        assert!((size.value - step).abs() < 1.5 * size.half_width(), "{engine:?}: {size:?}");
        let near = tail.flights[26..=34].iter().any(|flight| flight.start == found[0].since);
        assert!(near, "{engine:?}: {}", found[0].since);
    }
    assert!(of(Some(1)).is_empty());
    // Half of the flights burn 1.5 % more, and DSR is negative then.
    assert!((tail.airbus.specific_range_deviation_percent + 0.75).abs() < 0.4);
    assert_eq!(tail.airbus.readings, 60);
}

#[test]
fn events_between_the_same_flights_are_measured_together() {
    let tail = changed(&["engine_change", "wash"]);
    assert_eq!(tail.changes[0].event.as_deref(), Some("engine_change"));
    assert_eq!(tail.changes[0].since, tail.flights[30].start);
    assert_eq!(tail.events[0].together_with, ["wash"]);
    let effect = tail.events[0].effect_percent.unwrap();
    assert!((effect.value - 100.0 * 1.015_f64.ln()).abs() < 1.5 * effect.half_width());
}

#[test]
fn the_text_fits_a_terminal_and_tables_have_a_row_each() {
    let tail = changed(&["engine_change", "wash"]);
    let flights = tail.flights.len();
    let document = MonitorDocument::new(vec![tail.clone(), tail], Vec::new());
    for rows in [Rows::Tails, Rows::Months] {
        let printed = text(&document, rows);
        for line in printed.lines() {
            assert!(line.chars().count() <= 80, "{line}");
        }
        assert!(printed.contains("engine 2"), "{printed}");
    }
    let rows: Vec<(&str, usize)> =
        tables(&document).iter().map(|table| (table.name, table.columns.rows())).collect();
    assert_eq!(rows[0], ("tails", 2));
    assert_eq!(rows[2], ("flights", 2 * flights));
    assert_eq!(document.fleet[0].tails, 2);
    // Two tails that are alike differ by nothing, and their mean is each of them.
    assert!(document.fleet[0].between_tails_percent.abs() < 1e-12);
    let mean = document.fleet[0].deviation_percent.value;
    assert!((mean - document.tails[0].deviation_percent.value).abs() < 1e-9);
}
