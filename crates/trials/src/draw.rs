//! What a case flies. Knows the truth; the diagnosis never sees a value of these types.

use diagnose::KnownClutter;
use flight::Timestamp;
use flight::effect::{EffectId, TypicalSize};
use simulate::study::DragError;
use simulate::{
    AircraftTruth, Earth, FleetDesign, FlightPlan, Flights, OutsideEffect, Plan, PlannedEffect,
    References, Simulation, SmoothErrorSizes, StepTarget, Switch, TailPlan, TailTruth, TruthEffect,
    TruthPhysics,
};

use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

use crate::plan::{Background, CaseSpec, Kind, ReferenceModel, TrialPlan};
use crate::seal::{CaseTruth, SEALED_SCHEMA};

/// Tail of every case: a name that gives nothing away.
pub(crate) const TAIL: &str = "TRIAL";
/// Dates of sixty flights, s since 1970: 1.6 years, as the fleets of the virtual aircraft have them by default.
pub(crate) const FIRST_DATE_S: i64 = 1_515_153_600;
pub(crate) const SIXTY_FLIGHTS_S: i64 = 50_716_800;

/// A case, drawn: flights, effects, clutter.
#[derive(Clone, Debug)]
pub struct DrawnCase {
    /// Flights with everything that is drawn, after `clean` ones.
    flown: Simulation,
    /// The same flights and clutter without what is planted.
    twin: Simulation,
    /// The same flights with nothing drawn: what an adapted model learns.
    training_flights: Simulation,
    /// How many flights the model may learn: the first ones, of the twin.
    clean: usize,
    aircraft: AircraftTruth,
    physics: TruthPhysics,
    truth: CaseTruth,
    /// How the model errs, where it is a guide's.
    book_error: DragError,
    /// Stated over true standard deviations of the sensors, where they are misstated.
    stated_over_true: f64,
}

impl DrawnCase {
    /// Draws a case.
    ///
    /// # Errors
    /// What the simulator refuses.
    pub fn draw(plan: &TrialPlan, spec: &CaseSpec) -> Result<Self, simulate::PlanError> {
        let (physics, earth, clean) = match spec.part.reference_model {
            ReferenceModel::Exact
            | ReferenceModel::Misstated
            | ReferenceModel::Initial
            | ReferenceModel::Guide => (TruthPhysics::plain(), Earth::plain(), 0),
            ReferenceModel::Adapted => (learnable(), Earth::full(), plan.clean_flights),
        };
        let all = plan.flights + clean;
        let span_s = SIXTY_FLIGHTS_S * i64::try_from(all).unwrap_or(60) / 60;
        let date = |at_s| Timestamp::from_second(at_s).unwrap_or(Timestamp::UNIX_EPOCH);
        let design = FleetDesign {
            flights: all,
            dates: (date(FIRST_DATE_S), date(FIRST_DATE_S + span_s)),
            duration_h: (plan.duration_h, plan.duration_h),
            ..FleetDesign::default()
        };
        let seed = u64::from_le_bytes([0, 1, 2, 3, 4, 5, 6, 7].map(|byte: usize| spec.draws[byte]));
        let bare = Plan {
            aircraft: plan.aircraft.clone(),
            physics,
            earth,
            columns: plan.columns,
            sensors: plan.sensors,
            ..Plan::of_one_tail(seed, TAIL, design)
        };
        let designed = Simulation::new(bare.clone())?;
        let flights: Vec<FlightPlan> =
            (0..all).filter_map(|index| Some(designed.flight(index)?.1.clone())).collect();
        let references = references(&bare, &designed, &flights, clean)?;
        let listed = |effects: Vec<PlannedEffect>| TailPlan {
            tail: TAIL.to_owned(),
            effects,
            engine_deterioration_percent: Vec::new(),
            references: Some(references),
            flights: Flights::Listed(flights.clone()),
        };
        let last_start = flights.last().map_or(Timestamp::UNIX_EPOCH, |flight| flight.start);
        let first_start = flights.get(clean).map_or(Timestamp::UNIX_EPOCH, |flight| flight.start);
        let effects: Vec<PlannedEffect> = spec
            .planted
            .iter()
            .enumerate()
            .map(|(place, id)| {
                planned(*id, place, spec, references.mass_kg, (first_start, last_start))
            })
            .collect();
        let clutter = spec.part.background == Background::Clutter;
        let smooth = if clutter { plan.smooth_error_percent } else { 0.0 };
        let with = |effects: Vec<PlannedEffect>| {
            Simulation::new(Plan {
                tails: vec![listed(effects)],
                clutter_share: if clutter { plan.clutter_share } else { 0.0 },
                smooth_errors: SmoothErrorSizes { drag_percent: smooth, fuel_flow_percent: smooth },
                ..bare.clone()
            })
        };
        // Named with size 0, so that clutter does not draw them either.
        let nothing = effects
            .iter()
            .filter(|effect| !is_known(effect.id))
            .map(|effect| PlannedEffect { size: Some(0.0), ..*effect })
            .collect();
        let (flown, twin) = (with(effects)?, with(nothing)?);
        let training_flights = Simulation::new(Plan { tails: vec![listed(vec![])], ..bare })?;
        let truth = truth(&flown, spec);
        Ok(Self {
            aircraft: flown.aircraft().clone(),
            flown,
            twin,
            training_flights,
            clean,
            physics,
            truth,
            book_error: book_error(spec),
            stated_over_true: if spec.draws[15].is_multiple_of(2) { 3.0 } else { 1.0 / 3.0 },
        })
    }

    /// What is sealed.
    pub const fn truth(&self) -> &CaseTruth {
        &self.truth
    }

    pub(crate) const fn aircraft(&self) -> &AircraftTruth {
        &self.aircraft
    }

    pub(crate) const fn physics(&self) -> TruthPhysics {
        self.physics
    }

    pub(crate) const fn reference_model(&self) -> ReferenceModel {
        self.truth.reference_model
    }

    pub(crate) const fn book_error(&self) -> &DragError {
        &self.book_error
    }

    pub(crate) const fn stated_over_true(&self) -> f64 {
        self.stated_over_true
    }

    /// How the clutter of a case varies.
    pub(crate) fn known_clutter(&self, truth: &CaseTruth) -> KnownClutter {
        let plan = self.flown.plan();
        let SmoothErrorSizes { drag_percent, fuel_flow_percent } = plan.smooth_errors;
        KnownClutter {
            share: plan.clutter_share,
            // A share of drag is about the same share of fuel flow.
            smooth_percent: drag_percent.hypot(fuel_flow_percent),
            times: truth.times,
        }
    }

    /// Flights that the model may learn, and those that are diagnosed.
    pub(crate) const fn clean_flights(&self) -> usize {
        self.clean
    }

    pub(crate) const fn flown(&self) -> &Simulation {
        &self.flown
    }

    pub(crate) const fn twin(&self) -> &Simulation {
        &self.twin
    }

    pub(crate) const fn training_flights(&self) -> &Simulation {
        &self.training_flights
    }
}

/// A smooth error of a guide's drag: 3 to 8 % in the middle of what is flown, either way, with slopes of up to 3 % across it.
fn book_error(spec: &CaseSpec) -> DragError {
    let unit = |byte: usize| (f64::from(spec.draws[byte]) + 0.5) / 256.0;
    let sign = if spec.draws[22].is_multiple_of(2) { -1.0 } else { 1.0 };
    DragError {
        constant: sign * (0.03 + 0.05 * unit(23)),
        per_mach: 0.6 * (unit(30) - 0.5),
        mach: 0.78,
        per_lift_coefficient: 0.6 * (unit(31) - 0.5),
        lift_coefficient: 0.33,
    }
}

/// Size over the typical size: the part's, or drawn evenly in its logarithm up to `times_to`.
fn times(spec: &CaseSpec) -> f64 {
    let from = spec.part.times;
    // Bytes that no other draw of a case without pairs uses.
    let unit = (f64::from(u16::from_le_bytes([spec.draws[26], spec.draws[27]])) + 0.5) / 65_536.0;
    spec.part.times_to.map_or(from, |to| from * (to / from).powf(unit))
}

/// Everything beyond the model's equations that an adapted model can learn. Trim drag with the center of gravity and drag of
/// a wing held low it cannot: with them in the truth, a flight without a planted effect would not be without effect.
pub(crate) fn learnable() -> TruthPhysics {
    TruthPhysics { trim_drag: Switch::Off, asymmetry: Switch::Off, ..TruthPhysics::full() }
}

/// Conditions at which effects are zero: means over the flights that the model has learnt; of an exact model, over those
/// diagnosed. What gathers with time gathers from the mean date of what was learnt, because the model was right then, to the last
/// flight.
fn references(
    bare: &Plan,
    designed: &Simulation,
    flights: &[FlightPlan],
    clean: usize,
) -> Result<References, simulate::PlanError> {
    let of = |simulation: &Simulation| {
        simulation.truth(Vec::new()).tails.first().map(|tail| tail.references)
    };
    let whole = of(designed);
    if clean == 0 {
        return whole.ok_or_else(|| simulate::PlanError::NoFlights { tail: TAIL.to_owned() });
    }
    let learnt = Simulation::new(Plan {
        tails: vec![TailPlan {
            tail: TAIL.to_owned(),
            effects: Vec::new(),
            engine_deterioration_percent: Vec::new(),
            references: None,
            flights: Flights::Listed(flights[..clean].to_vec()),
        }],
        ..bare.clone()
    })?;
    let (Some(learnt), Some(whole)) = (of(&learnt), whole) else {
        return Err(simulate::PlanError::NoFlights { tail: TAIL.to_owned() });
    };
    Ok(References { first_date_s: learnt.date_s, last_date_s: whole.last_date_s, ..learnt })
}

/// An effect with its size, sign and hidden parameters.
fn planned(
    id: TruthEffect,
    place: usize,
    spec: &CaseSpec,
    mean_mass_kg: f64,
    (first, last): (Timestamp, Timestamp),
) -> PlannedEffect {
    // Six draws an effect, from byte 8 and byte 16 on.
    let byte = |number: usize| spec.draws[8 + 8 * place.min(1) + number];
    let unit = |number: usize| (f64::from(byte(number)) + 0.5) / 256.0;
    let between = |number: usize, low: f64, high: f64| low + unit(number) * (high - low);
    let sign = if id.is_one_sided() || is_known(id) || byte(0) % 2 == 0 { 1.0 } else { -1.0 };
    let mut effect = PlannedEffect::sized(id, sign * times(spec) * id.typical_size(mean_mass_kg));
    let span_s = (last.as_second() - first.as_second()) as f64;
    #[expect(clippy::cast_possible_truncation, reason = "seconds, far below 2^53")]
    let within = || {
        let after_s = (span_s * between(1, 0.25, 0.75)) as i64;
        Timestamp::from_second(first.as_second() + after_s).ok()
    };
    match id {
        TruthEffect::Library(id @ (EffectId::EngineHistory | EffectId::AirframeHistory)) => {
            effect.from = within();
            // What gathers in half of the flights' time is at least what a usual fall takes back.
            let half_years = 0.5 * span_s / (DAYS_PER_YEAR * SECONDS_PER_DAY);
            let usual = TruthEffect::Library(id).typical_size(mean_mass_kg);
            let fall = TruthEffect::Library(EffectId::StepChange).typical_size(mean_mass_kg);
            effect.size = Some(times(spec) * usual.max(fall / half_years));
        }
        TruthEffect::Library(EffectId::StepChange) => {
            effect.from = within();
            effect.target = if byte(2) % 2 == 0 { StepTarget::Drag } else { StepTarget::FuelFlow };
        }
        TruthEffect::Library(EffectId::TsfcThrottle) => effect.at = Some(between(3, 0.9, 1.1)),
        TruthEffect::Outside(OutsideEffect::MachBump) => effect.at = Some(between(4, 0.72, 0.84)),
        TruthEffect::Outside(OutsideEffect::SpoilerFloat) => {
            effect.at = Some(between(5, 0.32, 0.42));
        }
        _ => {}
    }
    effect
}

/// Effects that are there or not, without a size.
fn is_known(id: TruthEffect) -> bool {
    matches!(id, TruthEffect::Library(library) if library.entry().typical == TypicalSize::Known)
}

fn truth(flown: &Simulation, spec: &CaseSpec) -> CaseTruth {
    let tail = flown.truth(Vec::new()).tails.into_iter().next();
    let (effects, clutter) =
        tail.map_or_else(Default::default, |tail: TailTruth| (tail.effects, tail.clutter));
    CaseTruth {
        schema: SEALED_SCHEMA.to_owned(),
        case: spec.number,
        reference_model: spec.part.reference_model,
        background: spec.part.background,
        kind: spec.part.kind,
        times: spec.part.times,
        struck: match spec.part.kind {
            Kind::Struck => spec.planted.iter().map(ToString::to_string).collect(),
            _ => Vec::new(),
        },
        effects,
        clutter,
    }
}
