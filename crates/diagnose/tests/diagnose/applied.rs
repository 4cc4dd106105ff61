//! Diagnosing the same flights with the model that was extended by what they showed finds nothing left.
#![expect(clippy::unwrap_used, reason = "a test")]

use diagnose::{Diagnosis, FlightRecord, Input, Options, Verdict, diagnose};
use effects::AppliedEffects;
use effects::ExtendedModel;
use flight::effect::EffectId;
use test_support::fleet::{Background, Fleet, Planted, Setup, exact_model, fly, typical};

/// What the fleet recorded, as the diagnosis takes it.
fn records(fleet: &Fleet) -> Vec<FlightRecord<'_>> {
    fleet.flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect()
}

fn run(model: &ExtendedModel, fleet: &Fleet) -> Diagnosis {
    let records = records(fleet);
    let input = Input::against(model, &records);
    diagnose(&input, &Options { skip_closure: true, ..Options::default() }).unwrap()
}

/// Fleets whose truth has other functional forms than the library, at 1.5 typical sizes: one effect of each kind, with
/// hidden parameters, of the aircraft and of what is recorded.
#[test]
fn nothing_is_left_after_applying() {
    let model = exact_model();
    for id in [
        EffectId::ZeroLiftDrag,
        EffectId::TsfcEngine(2),
        EffectId::StepChange,
        EffectId::MachBias,
        EffectId::FuelFlowGain,
        EffectId::ZeroFuelMassBias,
        EffectId::LocalGravity,
    ] {
        let known = id == EffectId::LocalGravity;
        let size = if known { 1.0 } else { 1.5 * typical(id) };
        let fleet = fly(31, &Setup::default(), &[Planted { id, size }], &Background::default());
        let found = run(&model, &fleet);
        let named = found.verdict.effects().to_vec();
        assert!(!named.is_empty(), "{id}: {:?}", found.verdict);
        let addition = found.addition.unwrap();
        assert_eq!(addition.effects[0].effect, named[0]);
        let layer = addition.layer();
        let extended = model.with_effects(AppliedEffects::new(vec![layer])).unwrap();
        let left = run(&extended, &fleet);
        eprintln!(
            "{id}: {:?}, gap {:.2} -> {:.2} %, floor {:.2} %, then {:?}",
            addition.effects,
            found.gap.rms_percent,
            left.gap.rms_percent,
            left.gap.noise_floor_rms_percent,
            left.verdict
        );
        assert_eq!(left.verdict, Verdict::NoGap, "{id}: {:?}", left.verdict);
        assert!(left.gap.rms_percent < found.gap.rms_percent, "{id}");
        if named == [EffectId::LocalGravity] {
            // What physics knows and the model contains is no candidate any more.
            assert!(left.detectable.iter().all(|entry| entry.effect != EffectId::LocalGravity));
        }
    }
}
