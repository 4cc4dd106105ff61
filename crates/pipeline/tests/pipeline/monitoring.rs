//! From segments with a planted change to what `monitor` states.
#![expect(clippy::unwrap_used, reason = "a test that cannot continue must stop")]

use monitor::{FlightDeviation, FlownConditions};
use pipeline::model_file::{GuideRecord, LawSettings, ModelFile};
use pipeline::monitoring::{
    AlertDocument, BeforeLearning, Event, MeanConditions, MonitorDocument, MonitorOptions,
    MonitoredFlight, MonitoredTail, Rows, TailDeviations, TailDocument, tables, text,
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
            mass_kg: None,
            pressure_altitude_m: None,
            residual_rms: 0.0,
            condition_number: 1.0,
        },
        settings: LawSettings::published(),
        learnt: None,
        applied: Vec::new(),
        by_guide: None,
    }
}

/// Sixty flights without any effect; from the 31st on, engine 2 burns 3 % more. Events lie an hour before that flight.
fn changed(kinds: &[&str]) -> TailDocument {
    found(&[(1, 1.03)], kinds, &[]).0
}

/// The same with engines (from 0) whose fuel flow is multiplied from the 31st flight on, and what fires of some rules.
fn found(
    engines: &[(usize, f64)],
    kinds: &[&str],
    rules: &[&str],
) -> (TailDocument, Vec<AlertDocument>) {
    let fleet = fly(160, &Setup::default(), &[], &Background::default());
    let mut segments = Vec::new();
    for (number, mut flight) in fleet.flights.into_iter().enumerate() {
        for segment in flight.iter_mut().filter(|_| number >= 30) {
            let flows = &mut segment.means.fuel_flow_engine_kg_s;
            for (engine, factor) in engines {
                flows[*engine] *= factor;
            }
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
    let rules = rules.iter().map(|rule| rule.parse().unwrap()).collect();
    let options = MonitorOptions { rules, ..MonitorOptions::default() };
    (found.document(&options), found.alerts(&options))
}

/// Engine by engine what was planted, by hand: 3 % of engine 2 are one event and not another one of all; an exchange of +2 and −2 %
/// is nothing of all; of +2 % of both engines that of all is told.
#[test]
fn a_rule_for_changes_looks_at_single_engines_and_fires_once_for_an_event() {
    for (planted, expected) in [
        (&[(1, 1.03)][..], &[(Some(2), 2.96)][..]),
        (&[(0, 1.02), (1, 0.98)][..], &[(Some(1), 1.98), (Some(2), -2.02)][..]),
        (&[(0, 1.02), (1, 1.02)][..], &[(None, 1.98)][..]),
    ] {
        let (document, alerts) = found(planted, &[], &["change=1", "deviation=9"]);
        let fired: Vec<Option<usize>> = alerts.iter().map(|alert| alert.engine).collect();
        let engines: Vec<Option<usize>> = expected.iter().map(|(engine, _)| *engine).collect();
        assert_eq!(fired, engines, "{planted:?}: {:?}", document.changes);
        for (alert, (_, step)) in alerts.iter().zip(expected) {
            let error = (alert.size.value - step).abs();
            assert!(error < 1.5 * alert.size.half_width(), "{planted:?}: {alert:?}");
        }
        let document = MonitorDocument::new(vec![document], alerts);
        let table = tables(&document).pop().unwrap();
        let csv = String::from_utf8(table.columns.to_csv()).unwrap();
        let engine = expected[0].0.map_or_else(|| "all".to_owned(), |engine| engine.to_string());
        assert!(csv.lines().nth(1).unwrap().contains(&format!(",{engine},change=1,")), "{csv}");
        let words = expected[0].0.map_or_else(String::new, |engine| format!(" engine {engine}"));
        let printed = text(&document, Rows::Tails);
        let tail = &document.tails[0].tail;
        assert!(printed.contains(&format!("ALERT {tail}{words}: ")), "{printed}");
    }
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

/// Oracle: what was planted, on engine 2 alone, on which no wash of the airframe acts, whichever is given first.
#[test]
fn a_change_of_one_engine_is_not_a_wash() {
    for kinds in [["wash", "engine_change"], ["engine_change", "wash"]] {
        let tail = changed(&kinds);
        let of_all = tail.changes.iter().find(|change| change.engine.is_none()).unwrap();
        assert_eq!(of_all.event.as_deref(), Some("engine_change"));
        assert_eq!(of_all.other_events, ["wash"]);
        let of_engine = tail.changes.iter().find(|change| change.engine == Some(2)).unwrap();
        assert_eq!(of_engine.event.as_deref(), Some("engine_change"));
        // A wash changes every engine alike: this step is twice what all together show.
        assert!(of_engine.other_events.is_empty(), "{:?}", of_engine.other_events);
        let document = MonitorDocument::new(vec![tail], Vec::new());
        let printed = text(&document, Rows::Tails);
        assert!(printed.contains("engine_change (or wash, in the same interval)"), "{printed}");
    }
    // Neither a wash alone explains it, nor an exchange of engine 1.
    for kind in ["wash", "exchange of engine 1"] {
        let tail = changed(&[kind]);
        let of_engine = tail.changes.iter().find(|change| change.engine == Some(2)).unwrap();
        assert_eq!(of_engine.event, None, "{kind}");
    }
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

/// A flight a day from this one on, 100·ln(recorded/predicted) by the learnt model as given, and of two engines where they are.
fn flight(start: &str, percent: f64, engines: Option<[f64; 2]>) -> MonitoredFlight {
    let start = start.parse().unwrap();
    let shown = |mean: f64| {
        FlightDeviation::of_segments(start, &[mean - 0.1, mean, mean + 0.1, mean + 0.1, mean - 0.1])
    };
    MonitoredFlight {
        flight: start.to_string(),
        start,
        segments: 5,
        outside_table: 0,
        book: shown(percent),
        learnt: shown(percent),
        before_learning: None,
        engines: engines.into_iter().flatten().filter_map(shown).collect(),
        learnt_over_book_percent: 0.0,
        cruise_fuel_kg: 1000.0,
        conditions: MeanConditions { segments: 5, ..MeanConditions::default() },
    }
}

fn document(
    flights: Vec<MonitoredFlight>,
    events: &[Event],
    options: &MonitorOptions,
) -> TailDocument {
    let deviations = TailDeviations::of_flights("C750", "law", flights).since(options.since);
    MonitoredTail::new("T-1", &deviations, events).unwrap().unwrap().document(options)
}

/// Scatter of a flight, ± 0.4 %, without a pattern.
fn scatter(k: usize) -> f64 {
    [0.1, -0.4, 0.3, 0.0, -0.2, 0.4, -0.1, -0.3, 0.2, 0.0][k % 10]
}

/// A tail of one flight and one of five in 40 days have no trend, and do not enter the fleet's: that is the one of the third, whose
/// flights show 2 % a year.
#[test]
fn a_trend_that_flights_do_not_show_is_none() {
    let day = |k: usize| format!("2018-{:02}-{:02}T08:00:00Z", 3 + k / 28, 1 + k % 28);
    let of = |name: &str, days: &[usize], slope: f64| {
        let flights =
            days.iter().map(|&k| flight(&day(k), slope * k as f64 / 365.25 + scatter(k / 3), None));
        TailDocument {
            tail: name.to_owned(),
            ..document(flights.collect(), &[], &MonitorOptions::default())
        }
    };
    let many: Vec<usize> = (0..250).step_by(3).collect();
    let tails =
        vec![of("T-1", &[0], 0.0), of("T-2", &[0, 8, 15, 30, 40], 0.0), of("T-3", &many, 2.0)];
    let document = MonitorDocument::new(tails, Vec::new());
    let trends = || document.tails.iter().map(|tail| tail.trend_percent_per_year);
    assert!(trends().take(2).all(|trend| trend.is_none()), "{:?}", trends().next());
    let shown = document.tails[2].trend_percent_per_year.unwrap();
    assert!((shown.value - 2.0).abs() < shown.half_width(), "{shown:?}");
    assert_eq!(document.fleet[0].tails, 3);
    let of_fleet = document.fleet[0].trend_percent_per_year.unwrap();
    assert!((of_fleet.value - shown.value).abs() < 1e-9, "{of_fleet:?}");
    let printed = text(&document, Rows::Tails);
    let row = printed.lines().find(|line| line.starts_with("T-1")).unwrap();
    assert!(row.trim_end().ends_with('–'), "{printed}");
    let csv = String::from_utf8(tables(&document)[0].columns.to_csv()).unwrap();
    let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let place = lines.next().unwrap().iter().position(|name| *name == "trend_percent_per_year");
    assert_eq!(lines.next().unwrap()[place.unwrap()], "");
    let json = String::from_utf8(document.to_json()).unwrap();
    assert!(json.contains("\"trend_percent_per_year\": null"));
    // A rule for trends has none to fire on.
    let none = MonitorDocument::new(vec![of("T-1", &[0], 0.0)], Vec::new());
    assert!(none.fleet[0].trend_percent_per_year.is_none());
}

/// No flight from day 90 to 210, and 0.9 % more afterwards: a trend or a step, which is said wherever the trend is.
#[test]
fn a_trend_that_may_be_a_step_in_a_gap_says_so() {
    let start = |day: i64| {
        let first: jiff::Timestamp = "2018-01-01T08:00:00Z".parse().unwrap();
        (first + jiff::SignedDuration::from_hours(24 * day)).to_string()
    };
    let days = (0..90).step_by(3).chain((210..365).step_by(3));
    let flights = days.enumerate().map(|(k, day)| {
        let step = if day < 150 { 0.0 } else { 0.9 };
        flight(&start(day), 3.0 * scatter(k) + step, None)
    });
    let deviations = TailDeviations::of_flights("C750", "law", flights.collect());
    let found = MonitoredTail::new("T-1", &deviations, &[]).unwrap().unwrap();
    let rules = vec!["trend=0.5".parse().unwrap()];
    let options = MonitorOptions { rules, ..MonitorOptions::default() };
    let document = MonitorDocument::new(vec![found.document(&options)], found.alerts(&options));
    let tail = &document.tails[0];
    assert!(tail.changes.is_empty(), "{:?}", tail.changes);
    let step = tail.step_in_gap.as_ref().unwrap();
    assert_eq!((&step.after, &step.until), (&start(87), &start(210)));
    assert!((step.step_percent.value - 0.9).abs() < step.step_percent.half_width(), "{step:?}");
    // What may be a step is no trend that an alert can be raised for.
    assert!(document.alerts.is_empty(), "{:?}", document.alerts);
    let printed = text(&document, Rows::Tails);
    let words = "or one step of ";
    assert_eq!(printed.matches(words).count(), 1, "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
    let tables = tables(&document);
    let tails = tables.iter().find(|table| table.name == "tails").unwrap();
    let csv = String::from_utf8(tails.columns.to_csv()).unwrap();
    assert!(csv.contains("step_in_gap_percent_ci95_low") && csv.contains(&start(87)), "{csv}");
}

/// A tail of sixty flights about a Mach number, which burns so much more than the others, by an initial model whose error falls by
/// 0.5 % for each 0.01 Mach.
fn of_network(name: &str, mach: f64, more: f64) -> (TailDocument, FlownConditions) {
    let flights = (0..60).map(|k| {
        // No pattern has the period of the scatter.
        let mach = mach + 0.0017 * ((5 * k % 13) as f64 - 6.0);
        let error = -50.0 * (mach - 0.77) + more;
        let start = format!("2018-{:02}-{:02}T08:00:00Z", 3 + k / 28, 1 + k % 28);
        let shown = flight(&start, scatter(k), None);
        MonitoredFlight {
            book: shown.learnt.map(|learnt| learnt.raised(error)),
            learnt_over_book_percent: error,
            conditions: MeanConditions {
                mach,
                pressure_altitude_m: 10_500.0 + 100.0 * (k % 7) as f64,
                static_air_temperature_k: 220.0 + (k % 9) as f64,
                mass_kg: 60_000.0 + 1000.0 * (k % 11) as f64,
                true_airspeed_m_s: 230.0,
                initial_fuel_flow_kg_s: 0.6,
                segments: 5,
            },
            ..shown
        }
    });
    let deviations = TailDeviations::of_flights("C750", "law", flights.collect());
    let found = MonitoredTail::new(name, &deviations, &[]).unwrap().unwrap();
    (found.document(&MonitorOptions::default()), found.flown_conditions())
}

/// By construction: five slow and five fast tails are alike but for one of the fast ones, which burns 0.6 % more.
#[test]
fn tails_of_other_networks_are_compared_at_common_conditions() {
    let machs = [0.75, 0.752, 0.754, 0.756, 0.758, 0.79, 0.792, 0.794, 0.796, 0.798];
    let tails: Vec<(TailDocument, FlownConditions)> = machs
        .iter()
        .enumerate()
        .map(|(k, mach)| of_network(&format!("T-{k}"), *mach, if k == 6 { 0.6 } else { 0.0 }))
        .collect();
    let own = MonitorDocument::new(tails.iter().map(|(tail, _)| tail.clone()).collect(), vec![]);
    assert!(own.fleet[0].between_tails_percent > 0.9, "{:?}", own.fleet[0]);
    let document = MonitorDocument::compared(tails, Vec::new());
    let fleet = &document.fleet[0];
    assert!(fleet.between_tails_percent < 0.3, "{fleet:?}");
    assert!((fleet.reference.mach - 0.774).abs() < 0.002, "{fleet:?}");
    let worst = &document.tails[6];
    assert_eq!(document.by_news()[0], 6);
    let against = document.against_type(worst).unwrap();
    assert!((against.value - 0.54).abs() < against.half_width(), "{against:?}");
    for tail in &document.tails {
        let (compared, own) = (tail.at_type_conditions_percent.unwrap(), tail.deviation_percent);
        assert!(compared.half_width() > own.half_width(), "{compared:?} {own:?}");
        let expected =
            -50.0 * (fleet.reference.mach - 0.77) + if tail.tail == "T-6" { 0.6 } else { 0.0 };
        assert!(
            (compared.value - expected).abs() < compared.half_width(),
            "{compared:?} {expected}"
        );
    }
    // Months are compared so too.
    let month = fleet.months[0].deviation_percent;
    assert!((month.value - fleet.deviation_percent.value).abs() < 0.1, "{month:?} {fleet:?}");
    let printed = text(&document, Rows::Tails);
    assert!(printed.contains("; at Mach 0.774, "), "{printed}");
    assert!(printed.lines().all(|line| line.chars().count() <= 80), "{printed}");
    let csv = String::from_utf8(tables(&document)[0].columns.to_csv()).unwrap();
    assert!(csv.lines().next().unwrap().contains(",at_type_conditions_percent,"), "{csv}");
    // What is written reads back with the same fleet.
    let json = String::from_utf8(document.to_json()).unwrap();
    let read = MonitorDocument::from_json(&json).unwrap();
    let (read, written) = (&read.fleet[0], &document.fleet[0]);
    assert!((read.between_tails_percent - written.between_tails_percent).abs() < 1e-9, "{read:?}");
    assert!((read.deviation_percent.value - written.deviation_percent.value).abs() < 1e-9);
}

/// Oracle: 100·(e^{d/100} − 1) of the level; a last month of one flight that is 2 % lower decides nothing.
#[test]
fn what_to_plan_with_follows_from_the_level_and_not_from_one_flight() {
    let months = ["2018-02", "2018-03", "2018-04", "2018-05", "2018-06", "2018-07"];
    let mut flights: Vec<MonitoredFlight> = months
        .iter()
        .flat_map(|month| [5, 20].map(|day| format!("{month}-{day:02}T08:00:00Z")))
        .enumerate()
        .map(|(k, start)| flight(&start, 9.6 + scatter(k), None))
        .collect();
    flights.push(flight("2019-01-10T08:00:00Z", 7.6, None));
    let options =
        MonitorOptions { basic_performance_factor_percent: Some(1.0), ..Default::default() };
    let tail = document(flights, &[], &options);
    let (level, factor) = (tail.deviation_percent, tail.airbus.fuel_factor_percent);
    let of = |percent: f64| 100.0 * ((percent / 100.0).exp() - 1.0);
    assert!((factor.value - of(level.value)).abs() < 1e-9, "{factor:?}");
    assert!((factor.ci95[1] - of(level.ci95[1])).abs() < 1e-9, "{factor:?}");
    let retained = tail.airbus.retained_fuel_factor_percent;
    assert!(factor.value > retained + 1.0, "{factor:?} {retained}");
    assert!((retained - 7.9).abs() < 1e-9, "as Airbus has it: {retained}");
    let entered = tail.airbus.entered_fuel_factor_percent();
    assert!((0.0..0.1).contains(&(entered - factor.value)), "{entered}");
    assert!((tail.airbus.performance_factor_percent.unwrap() - 1.0 - entered).abs() < 1e-9);
    let printed = text(&MonitorDocument::new(vec![tail], Vec::new()), Rows::Tails);
    let told =
        format!("T-1: PERF FACTOR {:+.1} %, basic +1.0 and factor {entered:+.1}", 1.0 + entered);
    assert!(printed.contains(&told), "{printed}");
}

/// A recorder that sent one flight's total alone once took every engine's series of the tail with it.
#[test]
fn a_flight_without_flow_of_each_engine_is_left_out_of_the_engines_alone() {
    let flights: Vec<MonitoredFlight> = (0..60)
        .map(|k| {
            let start = format!("2018-{:02}-{:02}T08:00:00Z", 3 + k / 28, 1 + k % 28);
            let step = if k < 30 { 0.0 } else { 3.0 };
            let engines = [scatter(k), scatter(k) + step];
            flight(&start, scatter(k) + 0.5 * step, (k != 10).then_some(engines))
        })
        .collect();
    let tail = document(flights, &[], &MonitorOptions::default());
    assert_eq!(tail.flights_without_engines, 1);
    let since: Vec<&String> =
        tail.changes.iter().filter(|c| c.engine == Some(2)).map(|change| &change.since).collect();
    assert_eq!(since, [&tail.flights[30].start]);
    assert!(tail.changes.iter().all(|change| change.engine != Some(1)));
    let engines = |k: usize| tail.flights[k].engines_percent.clone();
    assert!(engines(10).is_empty(), "{:?}", engines(10));
    assert!(
        (engines(9)[1] - scatter(9)).abs() < 1e-9
            && (engines(40)[1] - 3.0 - scatter(40)).abs() < 1e-9
    );
    assert!(tail.months.iter().all(|month| month.engines_percent.len() == 2));
    let printed = text(&MonitorDocument::new(vec![tail], Vec::new()), Rows::Tails);
    assert!(printed.contains("T-1: 1 of 60 flights without fuel flow of each engine"), "{printed}");
}

/// The learnt model holds 2 % more than the initial one on early routes, 6 % on late ones; by it nothing changes.
#[test]
fn a_window_does_not_move_the_level() {
    let flights = || -> Vec<MonitoredFlight> {
        (0..40)
            .map(|k| {
                let start = format!("2018-{:02}-{:02}T08:00:00Z", 3 + k / 20, 1 + k % 20);
                let learnt_over_book_percent = if k < 20 { 2.0 } else { 6.0 };
                MonitoredFlight { learnt_over_book_percent, ..flight(&start, scatter(k), None) }
            })
            .collect()
    };
    let all = document(flights(), &[], &MonitorOptions::default());
    let since = Some("2018-04-01T00:00:00Z".parse().unwrap());
    let window = document(flights(), &[], &MonitorOptions { since, ..Default::default() });
    assert_eq!((all.flights.len(), window.flights.len()), (40, 20));
    assert_eq!(window.reference, all.reference);
    for (one, other) in window.flights.iter().zip(&all.flights[20..]) {
        assert_eq!(one.deviation_percent.value.to_bits(), other.deviation_percent.value.to_bits());
    }
    assert!((window.deviation_percent.value - 4.0).abs() < 0.3, "{:?}", window.deviation_percent);
}

#[test]
fn events_that_no_flights_surround_are_measured_neither_alone_nor_together() {
    let flights: Vec<MonitoredFlight> = (0..20)
        .map(|k| flight(&format!("2018-03-{:02}T08:00:00Z", 1 + k), scatter(k), None))
        .collect();
    let event = |time: &str, kind: &str| Event {
        time: time.parse().unwrap(),
        tail: "T-1".to_owned(),
        kind: kind.to_owned(),
        note: String::new(),
    };
    let events = [
        event("2017-01-01T00:00:00Z", "weighing"),
        event("2017-02-01T00:00:00Z", "wash"),
        event("2019-01-13T00:00:00Z", "retrofit"),
        event("2019-07-22T00:00:00Z", "wash"),
    ];
    let tail = document(flights, &events, &MonitorOptions::default());
    assert_eq!(tail.events.len(), 4);
    for event in &tail.events {
        assert!(event.effect_percent.is_none() && event.together_with.is_empty(), "{event:?}");
    }
}

#[test]
fn a_document_reads_back() {
    let document = MonitorDocument::new(vec![changed(&["wash"])], Vec::new());
    let json = String::from_utf8(document.to_json()).unwrap();
    let read = MonitorDocument::from_json(&json).unwrap();
    for rows in [Rows::Tails, Rows::Months] {
        assert_eq!(text(&read, rows), text(&document, rows));
    }
    assert!(MonitorDocument::from_json("{\"schema\": 1}").is_err());
}
