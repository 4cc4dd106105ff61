//! The effects of each tail, with their sizes.

use flight::effect::{EffectId, StepTarget, TypicalSize};
use units::check_within;

use crate::aircraft::AircraftTruth;
use crate::effect::{PlannedEffect, TruthEffect};
use crate::fleet::{DrawnEffect, DrawnTail, Planted, PlantedLevel};
use crate::plan::{Plan, PlanError, TailPlan};
use crate::random::{Purpose, Streams};
use crate::terms::References;
use crate::truth::EffectTruth;

/// The effects of a tail: of the plan, of the tail, and of the fleet if it is of one; those are added to what was planted.
pub(super) fn effects_of_tail(
    (plan, tail, of_fleet): (&Plan, &TailPlan, Option<&DrawnTail>),
    (aircraft, references): (&AircraftTruth, &References),
    planted: &mut Vec<Planted>,
) -> Result<Vec<(PlannedEffect, f64)>, PlanError> {
    let sized = |drawn: &DrawnEffect| {
        check_engine(&drawn.effect, aircraft)?;
        let id = drawn.effect.id;
        let mean = drawn.effect.size.unwrap_or_else(|| id.typical_size(references.mass_kg));
        let size = check_within("effect size", id.unit(), drawn.factor * mean, -1e6, 1e6)?;
        Ok::<_, PlanError>((drawn.effect, mean, size))
    };
    let of_plan: Vec<DrawnEffect> =
        plan.effects.iter().chain(&tail.effects).copied().map(DrawnEffect::plain).collect();
    let mut effects: Vec<(PlannedEffect, f64)> = Vec::new();
    for drawn in &of_plan {
        let (effect, _, size) = sized(drawn)?;
        effects.push((effect, size));
    }
    check_effects(&tail.tail, &effects)?;
    for drawn in of_fleet.into_iter().flat_map(|tail| &tail.effects) {
        let (effect, mean, size) = sized(drawn)?;
        effects.push((effect, size));
        let of_type = drawn.level == PlantedLevel::Type;
        let one = Planted {
            level: drawn.level,
            tail: (!of_type).then(|| tail.tail.clone()),
            effect: effect.id,
            size: if of_type { mean } else { size },
            target: step_target(&effect),
            from: effect.from,
            until: effect.until,
        };
        // That of the type is planted once, with the size that tails scatter about.
        if !(of_type && planted.contains(&one)) {
            planted.push(one);
        }
    }
    Ok(effects)
}

fn check_engine(effect: &PlannedEffect, aircraft: &AircraftTruth) -> Result<(), PlanError> {
    let (engine, is_step) = match effect.id {
        TruthEffect::Library(EffectId::TsfcEngine(k) | EffectId::FuelFlowGainEngine(k)) => {
            (Some(k), false)
        }
        TruthEffect::Library(EffectId::StepChange) => (effect.target.engine(), true),
        _ => (None, false),
    };
    let engines = aircraft.engines();
    match engine.filter(|engine| usize::from(*engine) > engines) {
        Some(k) if is_step => {
            Err(PlanError::Engine { effect: format!("{} of engine {k}", effect.id), engines })
        }
        Some(_) => Err(PlanError::Engine { effect: effect.id.to_string(), engines }),
        None => Ok(()),
    }
}

/// Refuses an effect that a tail has twice from the same date: a slip of the pen.
fn check_effects(tail: &str, effects: &[(PlannedEffect, f64)]) -> Result<(), PlanError> {
    let key = |effect: &PlannedEffect| (effect.id, effect.from, effect.until);
    for (index, (effect, _)) in effects.iter().enumerate() {
        if effects[..index].iter().any(|(other, _)| key(other) == key(effect)) {
            return Err(PlanError::DoubledEffect {
                tail: tail.to_owned(),
                effect: effect.id.to_string(),
            });
        }
    }
    Ok(())
}

/// Every effect of the library that the tail does not carry, with a small size.
pub(super) fn draw_clutter(
    plan: &Plan,
    tail: &str,
    effects: &[(PlannedEffect, f64)],
    references: &References,
    aircraft: &AircraftTruth,
) -> Vec<(PlannedEffect, f64)> {
    if plan.clutter_share <= 0.0 {
        return Vec::new();
    }
    let mut random = Streams::of_tail(plan.seed, tail).stream(Purpose::Clutter);
    EffectId::library(aircraft.engines())
        .into_iter()
        .filter_map(|id| {
            // Drawn whether used or not: a planted effect changes no other draw.
            let drawn = plan.clutter_share * random.normal();
            let effect = TruthEffect::Library(id);
            let size = effect.typical_size(references.mass_kg)
                * if id.is_one_sided() { drawn.abs() } else { drawn };
            let planted = effects.iter().any(|(other, _)| other.id == effect);
            let known = id.entry().typical == TypicalSize::Known;
            (!planted && !known).then(|| (PlannedEffect::sized(effect, size), size))
        })
        .collect()
}

pub(super) fn effect_truths(effects: &[(PlannedEffect, f64)]) -> Vec<EffectTruth> {
    effects.iter().map(|(effect, size)| effect_truth(effect, *size)).collect()
}

fn effect_truth(effect: &PlannedEffect, size: f64) -> EffectTruth {
    EffectTruth {
        id: effect.id,
        size,
        from: effect.from,
        until: effect.until,
        target: step_target(effect),
        at: effect.at,
    }
}

fn step_target(effect: &PlannedEffect) -> Option<StepTarget> {
    (effect.id == TruthEffect::Library(EffectId::StepChange)).then_some(effect.target)
}
