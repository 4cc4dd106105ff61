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
    assert_eq!(EffectId::from_name("drag_table"), Some(EffectId::DragTable));
    assert_eq!(EffectId::from_name("tsfc_engine_5"), None);
    assert_eq!(EffectId::from_name("magic"), None);
}

#[test]
fn effects_of_single_engines_follow_the_number_of_engines() {
    // Each of them is one effect per engine; with a single engine it is the effect of all engines. The drag table is no size.
    let single = EffectId::ALL.iter().filter(|id| id.engine().is_some()).count();
    let others = EffectId::ALL.len() - single - 1;
    assert_eq!(single, 2);
    for (engines, of_each) in [(1, 0), (2, 2), (4, 4)] {
        assert_eq!(EffectId::library(engines).len(), others + of_each * single);
    }
    assert!(EffectId::library(2).contains(&EffectId::TsfcEngine(2)));
    assert!(!EffectId::library(2).contains(&EffectId::TsfcEngine(3)));
}

#[test]
fn places_in_the_list_and_factors_of_the_units() {
    for (place, id) in EffectId::ALL.iter().enumerate() {
        assert_eq!(id.index(), place);
    }
    assert_eq!(EffectId::TsfcEngine(3).index(), EffectId::TsfcEngine(1).index());
    // 2 % are 0.02, 5 drag counts are 0.0005, 0.006 Mach are 0.006.
    let factors: std::collections::BTreeSet<_> = EffectId::ALL
        .iter()
        .map(|id| (id.entry().unit, id.entry().unit_factor().to_string()))
        .collect();
    let by_hand = [
        ("%", "0.01"),
        ("% of K", "0.01"),
        ("% of p", "0.01"),
        ("% rms", "0.01"),
        ("%/year", "0.01"),
        ("1", "1"),
        ("K", "1"),
        ("Mach", "1"),
        ("counts per 10 %MAC forward", "0.0001"),
        ("counts/deg²", "0.0001"),
        ("drag counts", "0.0001"),
        ("exponent", "1"),
        ("kg", "1"),
        ("known, 1", "1"),
    ];
    let by_hand: std::collections::BTreeSet<_> =
        by_hand.into_iter().map(|(unit, factor)| (unit, factor.to_owned())).collect();
    assert_eq!(factors, by_hand);
}

/// Of the effects whose size physics knows, "1.02 times its known size", not "1.02 known, 1".
#[test]
fn units_in_a_sentence() {
    for id in EffectId::library(2) {
        let expected = if id.is_known() { "times its known size" } else { id.entry().unit };
        assert_eq!(id.unit_words(), expected);
        assert!(!id.unit_words().contains("known, 1"));
    }
    assert!(EffectId::LocalGravity.is_known());
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
