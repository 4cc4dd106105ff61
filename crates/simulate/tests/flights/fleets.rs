//! Fleets: whose every effect is, from when, and what is done to the tails.

use crate::common::column;
use flight::Timestamp;
use simulate::{
    Columns, Earth, FleetDesign, FleetPlan, Flown, Plan, PlantedLevel, Scatter, SensorChoice,
    Simulation, TruthPhysics, Weather, events_csv,
};

/// A fleet of two flights a tail in still air, without physics that depend on each other, errors or scatter.
fn quiet(tails: usize, rest: &str) -> Plan {
    let text = format!(
        "(tails: {tails}, flights: (flights: 6, duration_h: (0.1, 0.1), turns_per_h: 0.0), {rest})"
    );
    let options =
        ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    let fleet: FleetPlan = options.from_str(&text).unwrap();
    Plan {
        physics: TruthPhysics::plain(),
        earth: Earth::plain(),
        weather: Weather::still(),
        sensors: SensorChoice::Perfect,
        columns: Columns::all(),
        scatter: Scatter::none(),
        tails: Vec::new(),
        fleet: Some(fleet),
        ..Plan::of_one_tail(3, "T", FleetDesign::default())
    }
}

fn fly_all(plan: Plan) -> Vec<Flown> {
    let simulation = Simulation::new(plan).unwrap();
    (0..simulation.len()).map(|index| simulation.fly(index).unwrap()).collect()
}

/// What is burnt in climb is more by as much as the engines burn more, and the aircraft lighter: up to 0.1 % of fuel flow for 5 %.
const BY_CLIMB: f64 = 1.2e-3;

/// Of every flight: tail, start, and the change of the first fuel flow of engine 1 and 2 against a fleet on which nothing acts.
fn changes(tails: usize, rest: &str) -> Vec<(String, Timestamp, [f64; 2])> {
    let first = |flown: &Flown| ["WF(1)", "WF(2)"].map(|name| column(&flown.report, name)[0]);
    fly_all(quiet(tails, rest))
        .iter()
        .zip(&fly_all(quiet(tails, "")))
        .map(|(with, without)| {
            let (with_it, base) = (first(with), first(without));
            let change = [0, 1].map(|engine| with_it[engine] / base[engine] - 1.0);
            (with.truth.tail.clone(), with.truth.start, change)
        })
        .collect()
}

fn instant(text: &str) -> Timestamp {
    text.parse().unwrap()
}

#[test]
fn the_example_fleet_is_drawn_as_it_says() {
    let plan = Plan::from_ron(include_str!("../../examples/fleet.ron")).unwrap();
    assert_eq!(Plan::from_ron(&plan.to_ron().unwrap()).unwrap(), plan);
    let simulation = Simulation::new(plan).unwrap();
    assert_eq!(simulation.len(), 20 * 60);
    let count = |level| simulation.planted().iter().filter(|one| one.level == level).count();
    // One of the type; a given tail, two drawn and ten of a retrofit; two sensors.
    assert_eq!(count(PlantedLevel::Type), 1);
    assert_eq!(count(PlantedLevel::Tail), 1 + 2 + 10);
    assert_eq!(count(PlantedLevel::Sensor), 2);
    let of_type = &simulation.planted()[0];
    assert_eq!((of_type.tail.as_deref(), of_type.size), (None, 0.12));
    let kind = |kind: &str| simulation.events().iter().filter(|event| event.kind == kind).count();
    assert_eq!(kind("retrofit"), 10);
    // 587 days, a wash each 150 to 210: two to four a tail, and three more.
    assert!((20 * 2 + 3..=20 * 4 + 3).contains(&kind("wash")), "{}", kind("wash"));
    // Forty engines for 1.6 years, 0.1 changes a year: 6.4 on average, and the given one.
    assert!((2..=14).contains(&kind("engine_change")), "{}", kind("engine_change"));
    assert!(simulation.events().windows(2).all(|pair| pair[0].at <= pair[1].at));
    let csv = events_csv(simulation.events());
    assert!(csv.contains("\n2018-10-01T00:00:00Z,T-001,engine_change,engine 1\n"), "{csv}");
    let truth = simulation.truth(Vec::new());
    assert_eq!(truth.planted, simulation.planted());
    // One condition at which the effects of the type are zero, for all tails.
    assert!(truth.tails.iter().all(|tail| tail.references == truth.tails[0].references));
    let text = serde_json::to_string(&truth).unwrap();
    let read = serde_json::from_str::<simulate::Truth>(&text).unwrap();
    assert_eq!((read.planted.len(), read.events.len()), (truth.planted.len(), truth.events.len()));
}

#[test]
fn effects_act_on_whom_and_when_the_plan_says() {
    // By hand: a factor of TSFC and the gain of a meter multiply the recorded fuel flow.
    let found = changes(
        3,
        r#"type_effects: [(effect: (id: "tsfc_factor", size: 2.0))],
           tail_effects: [
               (effects: [(id: "tsfc_engine_2", size: 3.0)], of: Tails(["T-002"])),
               (effects: [(id: "fuel_flow_gain", size: -1.0, from: "2018-06-01T00:00:00Z", until: "2019-03-01T00:00:00Z")], of: Tails(["T-003"])),
           ],"#,
    );
    assert_eq!(found.len(), 18);
    let (mut within, mut outside) = (0, 0);
    for (tail, start, change) in found {
        let off =
            (instant("2018-06-01T00:00:00Z")..instant("2019-03-01T00:00:00Z")).contains(&start);
        let meter = if tail == "T-003" && off { 0.99 } else { 1.0 };
        let second = if tail == "T-002" { 1.03 } else { 1.0 };
        assert!((change[0] - (1.02 * meter - 1.0)).abs() < BY_CLIMB, "{tail} {start} {change:?}");
        assert!(
            (change[1] - (1.02 * meter * second - 1.0)).abs() < BY_CLIMB,
            "{tail} {start} {change:?}"
        );
        if tail == "T-003" {
            if off { within += 1 } else { outside += 1 }
        }
    }
    assert!(within > 0 && outside > 0, "{within} {outside}");
}

#[test]
fn an_engine_change_brings_the_other_engines_level() {
    // By hand: TSFC of engine 1 is 1 % high until it is new: 3·1·(1 − exp(−2/3)) = 1.46 % after two years, then −0.5 %.
    let found = changes(
        1,
        r#"engines: (percent_per_year: 1.0, age_years: (2.0, 2.0)),
           events: [(of: All, at: "2018-11-01T00:00:00Z", what: EngineChange(engine: 1, level_percent: -0.5))],"#,
    );
    let at = instant("2018-11-01T00:00:00Z");
    let first = instant("2018-01-05T12:00:00Z");
    let years = |from: Timestamp, to: Timestamp| {
        (to.as_second() - from.as_second()) as f64 / (365.25 * 86_400.0)
    };
    assert!(found.iter().any(|(_, start, _)| *start < at));
    assert!(found.iter().any(|(_, start, _)| *start >= at));
    for (_, start, change) in found {
        let gathered = |years: f64| 0.03 * (1.0 - (-years / 3.0).exp());
        let old = gathered(2.0 + years(first, start));
        let engine_1 = if start < at { old } else { gathered(years(at, start)) - 0.005 };
        assert!((change[0] - engine_1).abs() < BY_CLIMB, "{start} {change:?} {engine_1}");
        assert!((change[1] - old).abs() < BY_CLIMB, "{start} {change:?} {old}");
    }
}

#[test]
fn a_wash_lowers_drag_and_is_an_event() {
    let rest = r#"airframe: (percent_per_year: 4.0, age_years: (2.0, 2.0), wash_takes_back: 1.0),
        events: [(of: Tails(["T-001"]), at: "2018-11-01T00:00:00Z", what: Wash)],"#;
    let simulation = Simulation::new(quiet(2, rest)).unwrap();
    assert_eq!(
        events_csv(simulation.events()),
        "date,tail,kind,note\n2018-11-01T00:00:00Z,T-001,wash,\n"
    );
    // 12·(1 − exp(−(2 + 300/365.25)/3)) %, all of it taken back.
    let change = simulation.events()[0].change_percent.unwrap();
    assert!((change + 12.0 * (1.0 - (-2.8203_f64 / 3.0).exp())).abs() < 0.02, "{change}");
    let at = instant("2018-11-01T00:00:00Z");
    let first = instant("2018-01-05T12:00:00Z");
    for (tail, start, change) in changes(2, rest) {
        let years = |from: Timestamp| (start.as_second() - from.as_second()) as f64 / 31_557_600.0;
        let age = if tail == "T-001" && start >= at { years(at) } else { 2.0 + years(first) };
        let zero_lift = 0.12 * (1.0 - (-age / 3.0).exp());
        // Zero-lift drag is half of all drag to most of it.
        let share = change[0] / zero_lift;
        assert!((0.4..0.85).contains(&share), "{tail} {start} {change:?} {zero_lift}");
    }
}

#[test]
fn what_acts_in_the_type_and_on_a_tail_acts_with_both_sizes() {
    let twice = r#"type_effects: [(effect: (id: "tsfc_mach_exponent", size: 0.10))],
        tail_effects: [(effects: [(id: "tsfc_mach_exponent", size: 0.05)], of: All)],"#;
    let once = r#"type_effects: [(effect: (id: "tsfc_mach_exponent", size: 0.15))],"#;
    let reports = |rest| -> Vec<_> {
        fly_all(quiet(2, rest)).into_iter().map(|flown| column(&flown.report, "WF(1)")).collect()
    };
    for (one, other) in reports(twice).iter().flatten().zip(reports(once).iter().flatten()) {
        assert!((one / other - 1.0).abs() < 1e-9, "{one} {other}");
    }
    assert_ne!(reports(twice), reports(""));
}

#[test]
fn another_tail_or_effect_moves_no_draw_of_a_fleet() {
    let effects = |more: &str| {
        format!(
            r#"type_effects: [(effect: (id: "tsfc_factor", size: 2.0), scatter: 0.3)],
               tail_effects: [
                   (effects: [(id: "step_change", target: fuel_flow)], of: All, scatter: 0.2, either_sign: On,
                    between: ("2018-03-01T00:00:00Z", "2019-03-01T00:00:00Z"), event: "retrofit"),
                   {more}
               ],"#
        )
    };
    let truth = |tails, more| Simulation::new(quiet(tails, &effects(more))).unwrap().truth(vec![]);
    let three = truth(3, "");
    let four = truth(4, r#"(effects: [(id: "drag_factor")], of: Tails(["T-004"]))"#);
    for (one, other) in three.tails.iter().zip(&four.tails) {
        assert_eq!(one.effects, other.effects);
    }
    assert_eq!(
        three.events,
        four.events.iter().filter(|event| event.tail != "T-004").cloned().collect::<Vec<_>>()
    );
    // Scatter: no two tails alike; the truth of the type is the size they scatter about.
    assert_ne!(three.tails[0].effects[0].size, three.tails[1].effects[0].size);
    assert_eq!(three.planted[0].size, 2.0);
}

#[test]
fn summer_is_in_july_in_the_north_and_in_january_in_the_south() {
    let isa_deviation_k = |latitude_deg: f64, start: &str| {
        let mut flight = crate::common::northbound();
        flight.start = instant(start);
        flight.duration_s = 600.0;
        flight.waypoints = vec![(latitude_deg, 10.0), (latitude_deg, 10.2)];
        let mut plan = crate::common::quiet_plan(vec![flight]);
        plan.weather.season_k = 6.0;
        crate::common::fly_first(plan).truth.isa_deviation_k
    };
    // By hand: 6·sin φ/sin 45°, on 22 July (day 202 of the year) and half a year before.
    let near =
        |found: f64, expected: f64| assert!((found - expected).abs() < 0.02, "{found} {expected}");
    near(isa_deviation_k(45.0, "2018-07-22T00:00:00Z"), 6.0);
    near(isa_deviation_k(45.0, "2018-01-20T12:00:00Z"), -6.0);
    near(isa_deviation_k(-30.0, "2018-01-20T12:00:00Z"), 6.0 * 0.5 * 2.0_f64.sqrt());
    near(isa_deviation_k(0.0, "2018-07-22T00:00:00Z"), 0.0);
}

#[test]
fn wrong_fleets_are_refused_with_the_reason() {
    for (rest, says) in [
        (r#"tail_effects: [(effects: [], of: Tails(["X"]))],"#, "the fleet has no tail X"),
        ("tail_effects: [(effects: [], of: Drawn(4))],", "tails drawn 4"),
        (r#"type_effects: [(effect: (id: "tsfc_engine_3"))],"#, "tsfc_engine_3"),
        (
            r#"type_effects: [(effect: (id: "tsfc_factor")), (effect: (id: "tsfc_factor"))],"#,
            "tail * has the effect tsfc_factor twice",
        ),
        ("airframe: (changes_per_year: 1.0),", "changes of the airframe"),
        ("engines: (wash_every_days: (0.0, 5.0)),", "days between washes"),
        (
            r#"events: [(of: All, at: "2018-11-01T00:00:00Z", what: EngineChange(engine: 3, level_percent: 0.0))],"#,
            "changed engine 3",
        ),
    ] {
        let error = Simulation::new(quiet(3, rest)).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    let mut none = quiet(1, "");
    none.fleet = None;
    assert!(Simulation::new(none).unwrap_err().to_string().contains("no tail"));
}
