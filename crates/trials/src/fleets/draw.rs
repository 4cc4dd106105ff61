//! What a fleet flies. Knows the truth.

use flight::Timestamp;
use flight::effect::EffectId;
use sha2::{Digest, Sha256};
use simulate::{
    Chosen, Earth, FleetDesign, FleetPlan, Plan, PlannedEffect, References, Simulation, StepTarget,
    Switch, TailEffects, TruthEffect, TypeEffect,
};

use super::part::{FleetPart, FleetSpec};
use super::truth::{FleetTruth, SEALED_FLEET_SCHEMA};
use crate::draw::{FIRST_DATE_S, SIXTY_FLIGHTS_S, TAIL, learnable};
use crate::plan::TrialPlan;

/// What the model of a type may lack: physics.
const OF_TYPE: [EffectId; 6] = [
    EffectId::ReynoldsNumber,
    EffectId::WaveDrag,
    EffectId::TsfcMachExponent,
    EffectId::InducedDrag,
    EffectId::TsfcFactor,
    EffectId::ZeroLiftDrag,
];
/// What one aircraft may have.
const OF_TAIL: [EffectId; 6] = [
    EffectId::TsfcEngine(1),
    EffectId::DragFactor,
    EffectId::ZeroLiftDrag,
    EffectId::InducedDrag,
    EffectId::TsfcFactor,
    EffectId::ZeroFuelMassBias,
];
/// What its sensors may have.
const OF_SENSORS: [EffectId; 5] = [
    EffectId::MachBias,
    EffectId::StaticPressureBias,
    EffectId::TemperatureBias,
    EffectId::FuelFlowGainEngine(1),
    EffectId::FuelFlowGain,
];
/// Steps are within this part of a tail's dates, so that there are flights before and after.
const STEPS_WITHIN: (f64, f64) = (0.25, 0.75);

/// A fleet, drawn.
#[derive(Clone, Debug)]
pub struct DrawnFleet {
    /// The clean tail, then the fleet's.
    simulation: Simulation,
    clean: usize,
    part: FleetPart,
    truth: FleetTruth,
}

impl DrawnFleet {
    /// Draws a fleet.
    ///
    /// # Errors
    /// What the simulator refuses.
    pub fn draw(plan: &TrialPlan, spec: &FleetSpec) -> Result<Self, simulate::PlanError> {
        let part = spec.part;
        let seed = u64::from_le_bytes([0, 1, 2, 3, 4, 5, 6, 7].map(|byte: usize| spec.draws[byte]));
        let span_s = |flights: usize| SIXTY_FLIGHTS_S * i64::try_from(flights).unwrap_or(60) / 60;
        let date = |at_s| Timestamp::from_second(at_s).unwrap_or(Timestamp::UNIX_EPOCH);
        let begins_s = FIRST_DATE_S + span_s(plan.clean_flights);
        let dates = (date(begins_s), date(begins_s + span_s(part.flights)));
        let design = |flights, dates| FleetDesign {
            flights,
            dates,
            duration_h: (plan.duration_h, plan.duration_h),
            ..FleetDesign::default()
        };
        let clean = design(plan.clean_flights, (date(FIRST_DATE_S), date(begins_s)));
        let bare = Plan {
            aircraft: plan.aircraft.clone(),
            physics: learnable(),
            earth: Earth::full(),
            columns: plan.columns,
            sensors: plan.sensors,
            ..Plan::of_one_tail(seed, TAIL, clean)
        };
        let references = references(&bare, dates)?;
        let fleet = FleetPlan {
            tails: part.tails,
            prefix: "F-".to_owned(),
            flights: Box::new(design(part.flights, dates)),
            references: Some(references),
            type_effects: of_type(spec, references.mass_kg),
            tail_effects: of_tails(spec, dates, references.mass_kg),
            airframe: None,
            engines: None,
            events: Vec::new(),
        };
        let simulation = Simulation::new(Plan { fleet: Some(fleet), ..bare })?;
        let truth = FleetTruth {
            schema: SEALED_FLEET_SCHEMA.to_owned(),
            fleet: spec.number,
            part,
            planted: simulation.planted().to_vec(),
        };
        Ok(Self { simulation, clean: plan.clean_flights, part, truth })
    }

    /// What is sealed.
    pub const fn truth(&self) -> &FleetTruth {
        &self.truth
    }

    pub(super) const fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    pub(super) const fn clean_flights(&self) -> usize {
        self.clean
    }

    pub(super) const fn part(&self) -> &FleetPart {
        &self.part
    }
}

/// Conditions at which effects are zero: the means over the flights that the model learns; dates are the fleet's.
fn references(
    bare: &Plan,
    (first, last): (Timestamp, Timestamp),
) -> Result<References, simulate::PlanError> {
    let truth = Simulation::new(bare.clone())?.truth(Vec::new());
    let Some(tail) = truth.tails.first() else {
        return Err(simulate::PlanError::NoTails);
    };
    let (first_date_s, last_date_s) =
        (flight::seconds_since_1970(first), flight::seconds_since_1970(last));
    Ok(References {
        date_s: 0.5 * (first_date_s + last_date_s),
        first_date_s,
        last_date_s,
        ..tail.references
    })
}

fn of_type(spec: &FleetSpec, mean_mass_kg: f64) -> Vec<TypeEffect> {
    (0..spec.part.type_effects)
        .map(|_| {
            let id = of_this_type(spec);
            TypeEffect { effect: sized(spec, "type", id, mean_mass_kg), scatter: 0.0 }
        })
        .collect()
}

fn of_this_type(spec: &FleetSpec) -> EffectId {
    OF_TYPE[below(spec, "type", OF_TYPE.len())]
}

/// The effects of tails and sensors, in turn, and the steps.
fn of_tails(
    spec: &FleetSpec,
    dates: (Timestamp, Timestamp),
    mean_mass_kg: f64,
) -> Vec<TailEffects> {
    let part = spec.part;
    let mut order: Vec<(f64, usize)> =
        (0..part.tails).map(|tail| (unit(spec, &format!("tail/{tail}")), tail)).collect();
    order.sort_by(|one, other| one.0.total_cmp(&other.0));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of at most 999 tails"
    )]
    let count = |share: f64| (share * part.tails as f64).round() as usize;
    let disturbed = count(part.disturbed_share).min(part.tails);
    let steps = count(part.step_share).min(part.tails - disturbed);
    let avoided = (part.type_effects > 0).then(|| of_this_type(spec));
    let mut all = Vec::new();
    for (place, (_, tail)) in order.iter().enumerate().take(disturbed + steps) {
        let key = format!("effect/{tail}");
        let effect = if place < disturbed {
            let library: &[EffectId] = if place % 2 == 0 { &OF_TAIL } else { &OF_SENSORS };
            let others: Vec<EffectId> =
                library.iter().copied().filter(|id| Some(*id) != avoided).collect();
            sized(spec, &key, others[below(spec, &key, others.len())], mean_mass_kg)
        } else {
            step(spec, &key, dates)
        };
        all.push(TailEffects {
            effects: vec![effect],
            of: Chosen::Tails(vec![format!("F-{:03}", tail + 1)]),
            between: None,
            scatter: 0.0,
            either_sign: Switch::Off,
            event: None,
        });
    }
    all
}

fn sized(spec: &FleetSpec, key: &str, id: EffectId, mean_mass_kg: f64) -> PlannedEffect {
    let id = TruthEffect::Library(id);
    let sign = if id.is_one_sided() { 1.0 } else { sign(spec, key) };
    PlannedEffect::sized(id, sign * spec.part.times * id.typical_size(mean_mass_kg))
}

fn step(spec: &FleetSpec, key: &str, (first, last): (Timestamp, Timestamp)) -> PlannedEffect {
    let (least, most) = STEPS_WITHIN;
    let share = least + (most - least) * unit(spec, &format!("{key}/date"));
    let span_s = (last.as_second() - first.as_second()) as f64;
    #[expect(clippy::cast_possible_truncation, reason = "seconds, far below 2^53")]
    let from = Timestamp::from_second(first.as_second() + (share * span_s) as i64).ok();
    let of_drag = unit(spec, &format!("{key}/target")) < 0.5;
    let id = TruthEffect::Library(EffectId::StepChange);
    PlannedEffect {
        from,
        target: if of_drag { StepTarget::Drag } else { StepTarget::FuelFlow },
        ..PlannedEffect::sized(id, sign(spec, key) * spec.part.step_percent)
    }
}

fn sign(spec: &FleetSpec, key: &str) -> f64 {
    if unit(spec, &format!("{key}/sign")) < 0.5 { -1.0 } else { 1.0 }
}

fn below(spec: &FleetSpec, key: &str, count: usize) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a product of a share and a small count"
    )]
    let drawn = (unit(spec, &format!("{key}/which")) * count as f64) as usize;
    drawn.min(count - 1)
}

/// A number from 0 to 1 for each purpose of a fleet: 53 bits of a hash, so that no draw moves another.
fn unit(spec: &FleetSpec, key: &str) -> f64 {
    let mut hasher = Sha256::new();
    hasher.update(spec.draws);
    hasher.update(key.as_bytes());
    let bytes: [u8; 32] = hasher.finalize().into();
    let word = u64::from_le_bytes([0, 1, 2, 3, 4, 5, 6, 7].map(|byte: usize| bytes[byte]));
    (word >> 11) as f64 / (1_u64 << 53) as f64
}
