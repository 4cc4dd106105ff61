use super::*;

#[test]
fn names_go_both_ways_and_are_unique() {
    let library = EffectId::library(4);
    let names: std::collections::BTreeSet<String> =
        library.iter().map(ToString::to_string).collect();
    assert_eq!(names.len(), library.len());
    for id in library {
        assert_eq!(EffectId::from_name(&id.to_string()), Some(id));
    }
    assert_eq!(EffectId::from_name("tsfc_engine_5"), None);
    assert_eq!(EffectId::from_name("magic"), None);
}

#[test]
fn effects_of_single_engines_follow_the_number_of_engines() {
    // The table has 29 rows, two of which are one effect per engine (with a single engine that is 'all').
    assert_eq!(EffectId::library(1).len(), 27);
    assert_eq!(EffectId::library(2).len(), 31);
    assert!(EffectId::library(2).contains(&EffectId::TsfcEngine(2)));
    assert!(!EffectId::library(2).contains(&EffectId::TsfcEngine(3)));
}

#[test]
fn every_entry_is_complete() {
    for id in EffectId::library(2) {
        let entry = id.entry();
        let of_engine = id.engine().is_some();
        for text in [entry.name, entry.phrase.positive, entry.phrase.negative] {
            assert_eq!(text.contains("{k}"), of_engine, "{id}: {text}");
        }
        assert!(!entry.unit.is_empty() && !entry.perturbation.is_empty(), "{id}");
        assert!(entry.hidden.is_like(entry.hidden));
        if let TypicalSize::Absolute(size) | TypicalSize::ShareOfMass(size) = entry.typical {
            assert!(size > 0.0, "{id}");
        }
    }
    assert_eq!(EffectId::TsfcEngine(2).phrase(-1.0), "engine 2 burns less");
    assert_eq!(EffectId::WaveDrag.phrase(0.006), "earlier drag rise with Mach number");
}
