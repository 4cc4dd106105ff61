//! Effects of past diagnoses that a model contains permanently.
//!
//! An applied `tsfc_throttle` always acts over corrected thrust, even where its size was found over N2, so that every
//! command agrees.
//! Difficult: an applied effect acts in one of two places. Effects of the aircraft and its surroundings change
//! predictions. Effects of the recording (sensors, load sheet, fuel quantity) correct recordings before anything else
//! uses them, and no prediction contains them.

use core::fmt;

use flight::effect::{EffectId, HiddenParameter, NeededInput, ThrottleArgument};
use lut::Table;
use lut::surface::{FitError, Surface};
use perf_model::FlightPoint;
use serde::{Deserialize, Serialize};

use crate::error::EffectModelError;
use crate::form::AppliedForm;
use crate::polar::fit_polar;
use crate::references::EffectReferences;
use crate::set::{Effects, SizedEffect};
use crate::terms::Terms;
use crate::variable::Variable;

/// The column of flight points that holds the date.
const DATE: &str = "date";
/// What a form outside the library is called, in files, options and messages.
pub const OUTSIDE: &str = "outside";

/// Effects that were applied together, with the references that they are relative to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AppliedLayer {
    /// Sizes and hidden parameters.
    pub effects: Effects,
    /// What acts beside them without being an effect of the library.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forms: Vec<AppliedForm>,
    /// The conditions at which they are zero.
    pub references: EffectReferences,
}

impl AppliedLayer {
    /// Effects of the library alone.
    #[must_use]
    pub const fn new(effects: Effects, references: EffectReferences) -> Self {
        Self { effects, forms: Vec::new(), references }
    }

    fn is_empty(&self) -> bool {
        self.effects.is_empty() && self.forms.is_empty()
    }
}

/// Effects that a model contains, layer by layer in the order in which they were applied.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct AppliedEffects {
    layers: Vec<AppliedLayer>,
}

impl AppliedEffects {
    /// These layers.
    #[must_use]
    pub const fn new(layers: Vec<AppliedLayer>) -> Self {
        Self { layers }
    }

    /// The layers.
    #[must_use]
    pub fn layers(&self) -> &[AppliedLayer] {
        &self.layers
    }

    /// Whether nothing is applied.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.layers.iter().all(AppliedLayer::is_empty)
    }

    /// Whether an effect was applied.
    #[must_use]
    pub fn contains(&self, effect: EffectId) -> bool {
        self.iter().any(|(id, _)| id == effect)
    }

    /// Whether an effect whose coefficient physics knows was applied: it is then no candidate of a diagnosis any more.
    #[must_use]
    pub fn settles(&self, effect: EffectId) -> bool {
        effect.is_known() && self.contains(effect)
    }

    /// Forms outside the library, layer by layer.
    pub fn forms(&self) -> impl Iterator<Item = &AppliedForm> {
        self.layers.iter().flat_map(|layer| &layer.forms)
    }

    /// Effects and sizes, layer by layer.
    pub fn iter(&self) -> impl Iterator<Item = (EffectId, f64)> + '_ {
        self.layers.iter().flat_map(|layer| layer.effects.iter())
    }

    /// Flight-to-flight scatter of fuel flow that was applied, as a share: layers add in squares.
    #[must_use]
    pub fn fuel_heating_value_deviation(&self) -> f64 {
        self.iter()
            .filter(|(id, _)| *id == EffectId::FuelHeatingValue)
            .map(|(_, percent)| (percent / 100.0) * (percent / 100.0))
            .sum::<f64>()
            .sqrt()
    }

    /// Physical effects that a flight point lacks an input for, with the column that is missing: the prediction has
    /// them at their reference (center of gravity and date of the reference, standard gravity, anti-ice bleed off, wings level,
    /// no wind), and a form outside the library at the mean of its variable.
    #[must_use]
    pub fn at_reference(&self, point: &FlightPoint) -> Vec<(AtReference, &'static str)> {
        let mut lacking = Vec::new();
        let mut lacks_one = |one: AtReference, missing: Option<&'static str>| {
            if let Some(missing) = missing
                && !lacking.contains(&(one, missing))
            {
                lacking.push((one, missing));
            }
        };
        for (id, _) in self.iter().filter(|(id, _)| !id.is_of_recordings()) {
            let missing = match id {
                EffectId::AirframeAgeing
                | EffectId::EngineAgeing
                | EffectId::AirframeHistory
                | EffectId::EngineHistory
                | EffectId::StepChange => point.date.is_none().then_some(DATE),
                _ => id.entry().needs.iter().find_map(|needed| lacks(*needed, point)),
            };
            lacks_one(AtReference::Effect(id), missing);
        }
        for variable in self.forms().flat_map(AppliedForm::variables) {
            lacks_one(AtReference::Outside, lacks_variable(variable, point));
        }
        lacking
    }

    fn terms(&self, acts: ActsOnWhat, dated: Dated) -> Vec<Terms> {
        let with_forms = acts == ActsOnWhat::Aircraft;
        let of = |id: EffectId| id.is_of_recordings() == (acts == ActsOnWhat::Recordings);
        self.layers
            .iter()
            .filter_map(|layer| {
                let effects: Effects = layer
                    .effects
                    .as_slice()
                    .iter()
                    .filter(|effect| of(effect.id))
                    .map(|effect| SizedEffect { hidden: over_thrust(effect.hidden), ..*effect })
                    .collect();
                let forms = if with_forms { layer.forms.clone() } else { Vec::new() };
                if effects.is_empty() && forms.is_empty() {
                    return None;
                }
                let terms = Terms::new(&effects, &layer.references).with_forms(forms);
                Some(match dated {
                    Dated::Yes => terms,
                    Dated::No => terms.at_reference_date(),
                })
            })
            .collect()
    }
}

/// What is held at its reference where a point lacks its input; displays as its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AtReference {
    /// An effect of the library.
    Effect(EffectId),
    /// A form outside it.
    Outside,
}

impl fmt::Display for AtReference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Effect(id) => id.fmt(f),
            Self::Outside => f.write_str(OUTSIDE),
        }
    }
}

/// What a term acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ActsOnWhat {
    /// The aircraft and its surroundings.
    Aircraft,
    /// What is recorded of them.
    Recordings,
}

/// Whether points have a date.
#[derive(Clone, Copy, Debug)]
enum Dated {
    Yes,
    /// Effects are as they were on the date of their references.
    No,
}

/// The column of flight points that an effect's input would be in, where the point lacks it. Roll and drift are not columns
/// of theirs.
fn lacks(needed: NeededInput, point: &FlightPoint) -> Option<&'static str> {
    let (there, name) = match needed {
        NeededInput::CenterOfGravity => {
            (point.center_of_gravity_percent_mac.is_some(), "cg_percent_mac")
        }
        NeededInput::AntiIce => (point.anti_ice.is_some(), "anti_ice"),
        NeededInput::Latitude => (point.latitude.is_some(), "latitude_deg"),
        NeededInput::TrueHeading => (point.true_heading.is_some(), "true_heading_deg"),
        NeededInput::Roll => (false, "roll"),
        NeededInput::Drift => (false, "drift"),
        NeededInput::FuelFlowPerEngine | NeededInput::StaticAirTemperature => (true, ""),
    };
    (!there).then_some(name)
}

/// The same for a variable of a form.
fn lacks_variable(variable: Variable, point: &FlightPoint) -> Option<&'static str> {
    let needed = match variable {
        Variable::Date => return point.date.is_none().then_some(DATE),
        Variable::Roll => NeededInput::Roll,
        Variable::CrossWind | Variable::LatitudeCrossWind => NeededInput::Drift,
        Variable::Latitude => NeededInput::Latitude,
        Variable::EastwardSpeed => NeededInput::TrueHeading,
        Variable::CenterOfGravity | Variable::CenterOfGravityLift => NeededInput::CenterOfGravity,
        Variable::Mach
        | Variable::LiftCoefficient
        | Variable::PressureAltitude
        | Variable::CorrectedThrust
        | Variable::IsaDeviation
        | Variable::StaticAirTemperature
        | Variable::Acceleration
        | Variable::Mass
        | Variable::MachLift
        | Variable::MachExcess
        | Variable::AntiIce
        // No form is over these.
        | Variable::FuelUsed
        | Variable::Engine
        | Variable::N2 => return None,
    };
    lacks(needed, point)
}

/// Points of a forecast have no N2, and most of what evaluates a model has no deck: N2 only served to find the size.
const fn over_thrust(hidden: HiddenParameter) -> HiddenParameter {
    match hidden {
        HiddenParameter::Throttle { pivot, .. } => {
            HiddenParameter::Throttle { pivot, argument: ThrottleArgument::CorrectedThrust }
        }
        other => other,
    }
}

/// Applied effects prepared for a drag table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Prepared {
    effects: AppliedEffects,
    /// Effects that predictions have.
    pub(crate) physical: Vec<Terms>,
    /// The same on the date of their references.
    pub(crate) undated: Vec<Terms>,
    /// Effects that recordings are corrected by.
    pub(crate) recorded: Vec<Terms>,
    pub(crate) polar: Surface,
}

impl Prepared {
    pub(crate) fn new(
        effects: AppliedEffects,
        drag_table: &Table,
    ) -> Result<Option<Self>, EffectModelError> {
        if effects.is_empty() {
            return Ok(None);
        }
        for layer in &effects.layers {
            layer.references.check()?;
            for (effect, size) in layer.effects.iter() {
                if !size.is_finite() {
                    return Err(EffectModelError::Size { effect, size });
                }
            }
            layer.forms.iter().try_for_each(AppliedForm::check)?;
        }
        Ok(Some(Self {
            physical: effects.terms(ActsOnWhat::Aircraft, Dated::Yes),
            undated: effects.terms(ActsOnWhat::Aircraft, Dated::No),
            recorded: effects.terms(ActsOnWhat::Recordings, Dated::Yes),
            polar: fit_polar(drag_table)?,
            effects,
        }))
    }

    pub(crate) const fn effects(&self) -> &AppliedEffects {
        &self.effects
    }

    pub(crate) fn changes_predictions(&self) -> bool {
        !self.physical.is_empty()
    }

    pub(crate) fn refit(&mut self, drag_table: &Table) -> Result<(), FitError> {
        self.polar = fit_polar(drag_table)?;
        Ok(())
    }
}
