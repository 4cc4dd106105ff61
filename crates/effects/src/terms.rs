//! The effects that act at a point, in the units of the equations, layer by layer.

use flight::MAXIMUM_ENGINES;
use flight::effect::{DragRise, EffectId, HiddenParameter, History, StepTarget, ThrottleArgument};

use crate::form::AppliedForm;
use crate::references::EffectReferences;
use crate::set::{Effects, SizedEffect};

/// Everything that acts at once: the effects that the model contains, in the order in which they were applied, and the
/// trial effects on top of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layers<'t> {
    pub(crate) contained: &'t [Terms],
    pub(crate) trial: &'t Terms,
}

impl<'t> Layers<'t> {
    pub(crate) fn iter(self) -> impl Iterator<Item = &'t Terms> {
        self.contained.iter().chain(core::iter::once(self.trial))
    }

    pub(crate) fn sum(self, value: impl Fn(&Terms) -> f64) -> f64 {
        self.contained.iter().map(&value).sum::<f64>() + value(self.trial)
    }

    /// Whether anything outside the library acts.
    pub(crate) fn has_forms(self) -> bool {
        self.iter().any(|terms| !terms.forms.is_empty())
    }

    /// Whether an effect moves lift coefficient or Mach number away from what was recorded.
    pub(crate) fn moves_the_point(self) -> bool {
        self.iter().any(Terms::moves_the_point)
    }
}

/// Sizes in the form that the equations need: shares instead of per cent, coefficients instead of counts.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Terms {
    pub(crate) references: EffectReferences,
    sizes: [f64; EffectId::ALL.len()],
    /// The rise of drag with Mach number that is shifted.
    pub(crate) drag_rise: DragRise,
    pub(crate) tsfc_engine: [f64; MAXIMUM_ENGINES],
    /// Corrected thrust over its reference at which TSFC is unchanged.
    pub(crate) throttle_pivot: f64,
    pub(crate) throttle_argument: ThrottleArgument,
    pub(crate) fuel_flow_gain: [f64; MAXIMUM_ENGINES],
    pub(crate) step_fuel_flow: f64,
    pub(crate) step_drag: f64,
    pub(crate) step_engine: [f64; MAXIMUM_ENGINES],
    /// Instant from which the step holds, s since 1970.
    pub(crate) step_from_s: f64,
    /// Of the engines and of the airframe.
    pub(crate) engine_history: History,
    pub(crate) airframe_history: History,
    /// What is no effect of the library.
    pub(crate) forms: Vec<AppliedForm>,
    /// Whether everything is as it was on the reference date, whatever the point's.
    is_at_reference_date: bool,
}

impl Terms {
    pub(crate) fn new(effects: &Effects, references: &EffectReferences) -> Self {
        let mut terms = Self::none(*references);
        for effect in effects.as_slice() {
            terms.add(effect);
        }
        terms
    }

    /// The same with forms outside the library.
    pub(crate) fn with_forms(self, forms: Vec<AppliedForm>) -> Self {
        Self { forms, ..self }
    }

    /// The same as they were on the date of their references.
    pub(crate) fn at_reference_date(self) -> Self {
        Self { is_at_reference_date: true, ..self }
    }

    /// The date at which they act on a point of a date.
    pub(crate) const fn date_s(&self, of_point_s: f64) -> f64 {
        if self.is_at_reference_date { self.references.date_s } else { of_point_s }
    }

    /// Size of an effect in the form that the equations need; 0 where it is not there. Effects of single engines and
    /// steps have fields of their own.
    #[inline]
    pub(crate) const fn size(&self, id: EffectId) -> f64 {
        self.sizes[id.index()]
    }

    /// Whether an effect moves lift coefficient or Mach number away from what was recorded.
    pub(crate) fn moves_the_point(&self) -> bool {
        self.changes_weight()
            || self.any(&[
                EffectId::ZeroFuelMassBias,
                EffectId::FuelQuantityGain,
                EffectId::MachBias,
                EffectId::StaticPressureBias,
            ])
            || self.fuel_flow_gain.iter().any(|gain| *gain != 0.0)
    }

    /// Whether an effect means that the flown state differs from the recorded one.
    pub(crate) fn corrects_recordings(&self) -> bool {
        self.any(&[
            EffectId::ZeroFuelMassBias,
            EffectId::FuelQuantityGain,
            EffectId::MachBias,
            EffectId::StaticPressureBias,
            EffectId::TemperatureBias,
        ]) || self.fuel_flow_gain.iter().any(|gain| *gain != 0.0)
    }

    /// Whether an effect changes the weight of a mass.
    pub(crate) fn changes_weight(&self) -> bool {
        self.any(&[EffectId::LoadFactor, EffectId::LocalGravity, EffectId::RotatingEarth])
    }

    fn any(&self, ids: &[EffectId]) -> bool {
        ids.iter().any(|id| self.size(*id) != 0.0)
    }

    fn none(references: EffectReferences) -> Self {
        Self {
            references,
            sizes: [0.0; EffectId::ALL.len()],
            drag_rise: DragRise::by_lock(0.0),
            tsfc_engine: [0.0; MAXIMUM_ENGINES],
            throttle_pivot: 0.0,
            throttle_argument: ThrottleArgument::CorrectedThrust,
            fuel_flow_gain: [0.0; MAXIMUM_ENGINES],
            step_fuel_flow: 0.0,
            step_drag: 0.0,
            step_engine: [0.0; MAXIMUM_ENGINES],
            step_from_s: f64::INFINITY,
            engine_history: History::NONE,
            airframe_history: History::NONE,
            forms: Vec::new(),
            is_at_reference_date: false,
        }
    }

    fn add(&mut self, effect: &SizedEffect) {
        let size = effect.size * effect.id.entry().unit_factor();
        self.set_hidden(effect);
        match effect.id {
            EffectId::TsfcEngine(engine) => add_engine(&mut self.tsfc_engine, engine, size),
            EffectId::FuelFlowGain => {
                for gain in &mut self.fuel_flow_gain {
                    *gain += size;
                }
            }
            EffectId::FuelFlowGainEngine(engine) => {
                add_engine(&mut self.fuel_flow_gain, engine, size);
            }
            EffectId::StepChange => self.add_step(effect.hidden, size),
            // The scatter of the heating value is among them. It moves no mean: no equation reads it, and variances are
            // handled where variances are.
            id => self.sizes[id.index()] += size,
        }
    }

    fn add_step(&mut self, hidden: HiddenParameter, size: f64) {
        let HiddenParameter::Step { target, .. } = hidden else {
            self.step_fuel_flow += size;
            return;
        };
        match (target, target.engine()) {
            (_, Some(engine)) => add_engine(&mut self.step_engine, engine, size),
            (StepTarget::Drag, None) => self.step_drag += size,
            (_, None) => self.step_fuel_flow += size,
        }
    }

    fn set_hidden(&mut self, effect: &SizedEffect) {
        match effect.hidden {
            HiddenParameter::None => {}
            HiddenParameter::DragRise(rise) => self.drag_rise = rise,
            HiddenParameter::Throttle { pivot, argument } => {
                self.throttle_pivot = pivot;
                self.throttle_argument = argument;
            }
            HiddenParameter::Step { from_s, .. } => self.step_from_s = from_s,
            HiddenParameter::History(history) if effect.id == EffectId::AirframeHistory => {
                self.airframe_history = history;
            }
            HiddenParameter::History(history) => self.engine_history = history,
        }
    }
}

/// Adds a share to engine k, counted from 1. An engine that the aircraft does not have carries no fuel.
fn add_engine(shares: &mut [f64; MAXIMUM_ENGINES], engine: u8, share: f64) {
    if let Some(value) = shares.get_mut(usize::from(engine).wrapping_sub(1)) {
        *value += share;
    }
}
