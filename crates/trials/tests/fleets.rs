//! Fleets of blind trials: what is drawn, what is refused, and scores by hand.
#![allow(clippy::unwrap_used, reason = "helpers of tests, which clippy does not take for tests")]

use std::collections::BTreeSet;

use diagnose::{FleetDiagnosis, FleetFinding, FleetLevel, Magnitude};
use flight::effect::EffectId;
use simulate::{Planted, PlantedLevel, TruthEffect};
use trials::{
    DrawnFleet, FleetPart, FleetTrials, FleetTruth, FoundFleet, LevelFound, MonitoredTail,
    TrialPlan,
};

fn finding(tail: Option<usize>, class: &[EffectId], levels: &[FleetLevel]) -> FleetFinding {
    FleetFinding {
        level: levels[0],
        levels: levels.to_vec(),
        tail,
        effect: class[0],
        class: class.to_vec(),
        probability: 0.99,
        effect_probability: 0.9,
        magnitude: Magnitude { value: 1.0, ci95: [0.9, 1.1] },
    }
}

fn planted(level: PlantedLevel, tail: Option<&str>, effect: EffectId) -> Planted {
    let step = effect == EffectId::StepChange;
    Planted {
        level,
        tail: tail.map(ToOwned::to_owned),
        effect: TruthEffect::Library(effect),
        size: 1.0,
        target: None,
        from: step.then(|| start(10)),
        until: None,
    }
}

fn start(flight: usize) -> flight::Timestamp {
    let day_s = 86_400 * i64::try_from(flight).unwrap();
    flight::Timestamp::from_second(1_500_000_000 + day_s).unwrap()
}

fn part() -> FleetPart {
    let plan = "(seed: 1, fleets: [(repeats: 1)])";
    TrialPlan::from_ron(plan).unwrap().fleets[0]
}

/// Four tails: a type's effect found, an engine's found with its meter, one sensor missed, one tail's called a sensor's, two
/// findings too many, one of them on the tail with a step.
fn fleet() -> (FoundFleet, FleetTruth) {
    use EffectId::{DragFactor, FuelFlowGainEngine, MachBias, ReynoldsNumber, TsfcEngine};
    let findings = vec![
        finding(None, &[ReynoldsNumber], &[FleetLevel::Type]),
        finding(
            Some(0),
            &[FuelFlowGainEngine(1), TsfcEngine(1)],
            &[FleetLevel::Sensor, FleetLevel::Tail],
        ),
        finding(Some(1), &[MachBias, DragFactor], &[FleetLevel::Sensor]),
        finding(Some(2), &[DragFactor], &[FleetLevel::Tail]),
        finding(Some(3), &[DragFactor], &[FleetLevel::Tail]),
    ];
    let monitored = |changes: &[usize]| MonitoredTail {
        starts: (0..20).map(start).collect(),
        changes: changes.to_vec(),
    };
    let found = FoundFleet {
        tails: ["F-1", "F-2", "F-3", "F-4"].map(ToOwned::to_owned).to_vec(),
        diagnosis: FleetDiagnosis {
            effects: vec![],
            findings,
            false_share: 0.01,
            of_type: vec![],
            of_tails: vec![],
            spread_of_typical: 0.0,
            smooth_amplitude: 0.0,
            noise: vec![],
        },
        monitored: vec![monitored(&[]), monitored(&[5]), monitored(&[]), monitored(&[2, 12])],
    };
    let truth = FleetTruth {
        schema: String::new(),
        fleet: 1,
        part: part(),
        planted: vec![
            planted(PlantedLevel::Type, None, ReynoldsNumber),
            planted(PlantedLevel::Tail, Some("F-1"), TsfcEngine(1)),
            planted(PlantedLevel::Tail, Some("F-2"), DragFactor),
            planted(PlantedLevel::Sensor, Some("F-3"), MachBias),
            planted(PlantedLevel::Tail, Some("F-4"), EffectId::StepChange),
        ],
    };
    (found, truth)
}

#[test]
fn scores_by_hand() {
    let (found, truth) = fleet();
    let result = found.score(&truth, "abc");
    let levels: Vec<Option<LevelFound>> =
        result.planted.iter().map(|one| one.found.map(|found| found.level)).collect();
    assert_eq!(
        levels,
        [Some(LevelFound::Right), Some(LevelFound::Open), Some(LevelFound::Wrong), None]
    );
    let right: Vec<bool> = result.findings.iter().map(|one| one.right).collect();
    assert_eq!(right, [true, true, true, false, false]);
    assert!(result.findings[4].beside_a_step);
    // The step is before flight 10; the change at 12 is two flights off, those at 2 and 5 belong to nothing.
    assert_eq!((result.steps[0].flight, result.steps[0].nearest), (10, Some(12)));
    assert!(result.steps[0].dated);
    let false_changes: Vec<(&str, usize)> =
        result.false_changes.iter().map(|one| (one.tail.as_str(), one.flight)).collect();
    assert_eq!(false_changes, [("F-2", 5), ("F-4", 2)]);

    let plan = TrialPlan::from_ron("(seed: 1, fleets: [(repeats: 1)])").unwrap();
    let groups = FleetTrials::new(&plan, vec![result], Vec::new()).groups;
    let share = |name: &str| {
        let score = groups[0].scores.iter().find(|score| score.name == name).unwrap();
        (score.reached.count, score.reached.of, score.met)
    };
    assert_eq!(share("level_right"), (1, 2, Some(false)));
    assert_eq!(share("level_open"), (1, 3, None));
    assert_eq!(share("found_type"), (1, 1, None));
    assert_eq!(share("found_tail"), (2, 2, None));
    assert_eq!(share("found_sensor"), (0, 1, None));
    assert_eq!(share("named"), (1, 3, None));
    // Of four findings away from the step one is false.
    assert_eq!(share("false"), (1, 4, Some(false)));
    // Every tail has something of its own.
    assert_eq!(share("silent"), (0, 0, None));
    assert_eq!(share("dated"), (1, 1, Some(true)));
    assert_eq!(share("false_changes"), (2, 80, Some(false)));
}

#[test]
fn quiet_tails_are_silent_or_not() {
    let (found, mut truth) = fleet();
    truth.planted.clear();
    let result = found.score(&truth, "abc");
    let plan = TrialPlan::from_ron("(seed: 1, fleets: [(repeats: 1)])").unwrap();
    let groups = FleetTrials::new(&plan, vec![result], Vec::new()).groups;
    let score = |name: &str| groups[0].scores.iter().find(|score| score.name == name).unwrap();
    // A finding on each of four tails, and one of the type; no goal where all of them are false.
    assert_eq!((score("silent").reached.count, score("silent").reached.of), (0, 4));
    assert_eq!((score("false").reached.count, score("false").goal), (5, None));
}

/// Gravity by latitude acts on all tails, planted or not: to find it is neither right nor false; on one tail alone it is false.
#[test]
fn what_the_earth_does_is_no_false_finding() {
    let (mut found, truth) = fleet();
    let class = [EffectId::WaveDrag, EffectId::LocalGravity];
    found.diagnosis.findings.push(finding(None, &class, &[FleetLevel::Type]));
    found.diagnosis.findings.push(finding(Some(1), &class, &[FleetLevel::Tail]));
    let result = found.score(&truth, "abc");
    let last: Vec<(bool, bool)> =
        result.findings[5..].iter().map(|one| (one.right, one.of_the_earth)).collect();
    assert_eq!(last, [(false, true), (false, false)]);
    let plan = TrialPlan::from_ron("(seed: 1, fleets: [(repeats: 1)])").unwrap();
    let groups = FleetTrials::new(&plan, vec![result], Vec::new()).groups;
    let score = groups[0].scores.iter().find(|score| score.name == "false").unwrap();
    assert_eq!((score.reached.count, score.reached.of), (2, 5));
}

#[test]
fn a_change_four_flights_away_is_another() {
    let (mut found, truth) = fleet();
    found.monitored[3].changes = vec![14];
    let result = found.score(&truth, "abc");
    assert!(!result.steps[0].dated);
    assert_eq!(result.false_changes.len(), 2);
    found.monitored[3].changes = vec![7];
    assert!(found.score(&truth, "abc").steps[0].dated);
}

fn drawn(part: &str) -> FleetTruth {
    let text =
        format!("(seed: 7, clean_flights: 4, duration_h: 0.5, fleets: [({part} repeats: 1)])");
    let plan = TrialPlan::from_ron(&text).unwrap();
    DrawnFleet::draw(&plan, &plan.fleets()[0]).unwrap().truth().clone()
}

#[test]
fn a_fleet_is_drawn_as_its_part_says() {
    let truth = drawn("tails: 20, flights: 3, step_share: 0.25, times: 0.5,");
    let count = |level| truth.planted.iter().filter(|one| one.level == level).count();
    assert_eq!(count(PlantedLevel::Type), 1);
    // Six disturbed tails, every other one by a sensor, and five steps.
    assert_eq!(count(PlantedLevel::Sensor), 3);
    assert_eq!(count(PlantedLevel::Tail), 3 + 5);
    let step = TruthEffect::Library(EffectId::StepChange);
    for one in &truth.planted {
        // A bias of the mass is a share of the fleet's mean mass, which is about 14 t.
        let of_mass = one.effect == TruthEffect::Library(EffectId::ZeroFuelMassBias);
        let typical = 0.5 * one.effect.typical_size(14_000.0);
        let (size, tolerance) = match one.effect {
            effect if effect == step => (1.0, 1e-12),
            _ => (typical, if of_mass { 0.1 } else { 1e-12 }),
        };
        assert!((one.size.abs() / size - 1.0).abs() < tolerance, "{one:?}");
        assert_eq!(one.from.is_some(), one.effect == step);
    }
    // No tail has two of them.
    let tails: BTreeSet<&String> =
        truth.planted.iter().filter_map(|one| one.tail.as_ref()).collect();
    assert_eq!(tails.len(), 11);
}

#[test]
fn nothing_is_planted_in_a_fleet_without_effects() {
    let truth = drawn("tails: 3, flights: 3, type_effects: 0, disturbed_share: 0.0,");
    assert_eq!(truth.planted, []);
}

#[test]
fn what_makes_no_fleet_is_refused_by_name() {
    for (part, says) in [
        ("tails: 2, repeats: 1", "fleets: tails: found 2"),
        ("type_effects: 2, repeats: 1", "fleets: type_effects: found 2"),
        ("disturbed_share: 0.8, step_share: 0.3, repeats: 1", "fleets: step_share: found 0.3"),
        ("repeats: 0", "fleets: repeats: found 0"),
        ("repeats: 1), (repeats: 2", "occurs twice"),
    ] {
        let error = TrialPlan::from_ron(&format!("(seed: 1, fleets: [({part})])")).unwrap_err();
        assert!(error.to_string().contains(says), "{error}");
    }
}

#[test]
fn a_fleet_keeps_its_draws_when_parts_are_added() {
    let fleets = |parts: &str| {
        TrialPlan::from_ron(&format!("(seed: 1, fleets: [{parts}])")).unwrap().fleets()
    };
    let alone = fleets("(repeats: 2)");
    let after = fleets("(tails: 5, repeats: 1), (repeats: 2)");
    assert_eq!(after.len(), 3);
    assert_eq!([after[1].draws, after[2].draws], [alone[0].draws, alone[1].draws]);
    assert_ne!(alone[0].draws, alone[1].draws);
}
