//! What each effect makes of a gap that three carry, all of the library at once.
#![expect(clippy::unwrap_used, reason = "a test")]

use diagnose::{Diagnosis, FlightRecord, Input, Options, diagnose};
use flight::effect::EffectId;
use test_support::fleet::{Background, Planted, Setup, exact_model, fly, typical};

const PLANTED: [EffectId; 3] =
    [EffectId::ReynoldsNumber, EffectId::TrimDragCg, EffectId::TemperatureBias];

fn found(seed: u64, planted: &[Planted]) -> Diagnosis {
    let model = exact_model();
    let fleet = fly(seed, &Setup::default(), planted, &Background::default());
    let records: Vec<FlightRecord<'_>> =
        fleet.flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let options = Options { skip_closure: true, skip_where: true, ..Options::default() };
    diagnose(&Input::against(&model, &records), &options).unwrap()
}

/// Sizes are known: those of the three that act, 0 of all others. Nine tenths of the 95 % intervals hold them, and of the effects
/// that act and that nothing else resembles, all are told from nothing.
#[test]
fn intervals_of_all_effects_hold_their_sizes() {
    let planted = PLANTED.map(|id| Planted { id, size: 2.0 * typical(id) });
    let (mut hold, mut of) = (0, 0);
    for seed in 51..57 {
        let found = found(seed, &planted);
        assert!(found.contributions.len() > 25, "{}", found.contributions.len());
        for one in &found.contributions {
            let size = planted.iter().find(|p| p.id == one.effect).map_or(0.0, |p| p.size);
            let [low, high] = one.magnitude.ci95;
            of += 1;
            hold += usize::from(low <= size && size <= high);
        }
        let of_effect = |id| found.contributions.iter().find(|one| one.effect == id).unwrap();
        for id in [EffectId::ReynoldsNumber, EffectId::TrimDragCg] {
            assert!(of_effect(id).rms_ci95[0] > 0.05, "{seed}: {:?}", of_effect(id));
        }
        let leads: f64 = found.contributions.iter().map(|one| one.leads).sum();
        assert!((leads - 1.0).abs() < 1e-9, "{leads}");
    }
    assert!(hold * 10 >= of * 9, "{hold} of {of}");
}

#[test]
fn nothing_contributes_to_no_gap() {
    let found = found(58, &[]);
    assert!(!found.gap.detected && found.contributions.is_empty());
}
