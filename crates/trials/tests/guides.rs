//! Fleets against a guide whose drag is off by some per cent, with one effect that no table can hold.

use flight::effect::EffectId;
use trials::{DiagnosedCase, TrialPlan};

/// Cases that were looked at while this was developed.
const PLAN: &str = "(
    seed: 41, parts: [(denied: initial, background: clean, kind: single, repeats: 12)],
)";

/// Each was wrong once: with the table believed to be right, one effect of throttle was preferred to it, which explains half of
/// the gap on unseen flights where a table explains all of it. 17, 83 and 95 were named after the throttle; 44, 61 and 125 read
/// "no gap", because no name was borne out.
#[test]
fn what_a_guide_lacks_is_its_table_before_anything_that_a_table_can_hold() {
    let plan = TrialPlan::from_ron(PLAN).unwrap();
    for spec in plan.cases(2) {
        if ![17, 44, 61, 83, 95, 125].contains(&spec.number) {
            continue;
        }
        let case = DiagnosedCase::run(&plan, &spec).unwrap();
        let (verdict, number) = (&case.diagnosis().verdict, spec.number);
        assert_eq!(verdict.effects().first(), Some(&EffectId::DragTable), "{number}: {verdict:?}");
        let found = verdict.found().unwrap();
        // Throttle is said to be held by the table, never to act beside it.
        assert!(found.class.contains(&EffectId::TsfcThrottle), "{number}: {verdict:?}");
        assert!(!verdict.effects()[1..].contains(&EffectId::TsfcThrottle), "{number}: {verdict:?}");
    }
}

/// Each was wrong once: 3 % of one engine's meter was read as the other's with the opposite sign, which beside a level that a table may
/// have is nearly the same, and the class held both engines' TSFC and not the meter that was off.
#[test]
fn beside_a_table_one_engine_high_may_be_the_other_low() {
    let plan = "(
        seed: 20263351, parts: [(denied: guide, background: clean, kind: single, repeats: 32)],
    )";
    let plan = TrialPlan::from_ron(plan).unwrap();
    for spec in plan.cases(2).into_iter().filter(|spec| [88, 139].contains(&spec.number)) {
        let case = DiagnosedCase::run(&plan, &spec).unwrap();
        let (verdict, number) = (&case.diagnosis().verdict, spec.number);
        let beside = &verdict.found().unwrap().beside;
        let holds = |id| beside.iter().any(|beside| beside.class.contains(&id));
        let meters = [1, 2].map(EffectId::FuelFlowGainEngine);
        assert!(meters.into_iter().all(holds), "{number}: {verdict:?}");
    }
}
