//! Effects that a model contains for good: those of past diagnoses, applied.
//!
//! An applied `tsfc_throttle` always acts over corrected thrust, also where N2 told its size: the same in every command.
//!
//! Difficult: an applied effect acts in one of two places. Effects of the aircraft and its surroundings change what is
//! predicted. Effects of what is recorded (sensors, load sheet, fuel quantity) correct recordings before anything looks at
//! them, and no prediction knows of them.

use std::borrow::Cow;

use flight::effect::{EffectId, NeededInput, TypicalSize};
use flight::{Segment, SegmentMeans};
use lut::Table;
use lut::surface::{FitError, Surface};
use serde::{Deserialize, Serialize};

use super::recorded::corrected;
use super::terms::{Layers, Terms, ThrottleArgument};
use super::{
    EffectError, EffectModel, EffectModelError, EffectPoint, EffectReferences, Effects,
    HiddenParameters, Response, polar_of,
};
use crate::{FlightPoint, PerformanceModel};

/// What a flight point says a date in.
const DATE: &str = "date";

/// Effects that were applied together, with what they are relative to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AppliedLayer {
    /// Sizes and hidden parameters.
    pub effects: Effects,
    /// What they are zero at.
    pub references: EffectReferences,
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
        self.layers.iter().all(|layer| layer.effects.is_empty())
    }

    /// Whether an effect was applied.
    #[must_use]
    pub fn contains(&self, effect: EffectId) -> bool {
        self.iter().any(|(id, _)| id == effect)
    }

    /// Whether an effect whose coefficient physics knows was applied: it is then no candidate of a diagnosis any more.
    #[must_use]
    pub fn settles(&self, effect: EffectId) -> bool {
        matches!(effect.entry().typical, TypicalSize::Known) && self.contains(effect)
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

    /// Physical effects that a flight point lacks an input for, with the column that is missing: the prediction has them at
    /// their reference (center of gravity and date of the reference, standard gravity, anti-ice bleed off, wings level, no
    /// wind).
    #[must_use]
    pub fn at_reference(&self, point: &FlightPoint) -> Vec<(EffectId, &'static str)> {
        let mut lacking = Vec::new();
        for (id, _) in self.iter().filter(|(id, _)| !id.is_of_recordings()) {
            let missing = match id {
                EffectId::AirframeAgeing | EffectId::EngineAgeing | EffectId::StepChange => {
                    point.date.is_none().then_some(DATE)
                }
                _ => id.entry().needs.iter().find_map(|needed| lacks(*needed, point)),
            };
            if let Some(missing) = missing
                && !lacking.contains(&(id, missing))
            {
                lacking.push((id, missing));
            }
        }
        lacking
    }

    fn terms(&self, of: impl Fn(EffectId) -> bool, dated: bool) -> Vec<Terms> {
        self.layers
            .iter()
            .filter_map(|layer| {
                let mut effects = Effects::none();
                for (id, size) in layer.effects.iter().filter(|(id, _)| of(*id)) {
                    effects = effects.with(id, size);
                }
                if effects.is_empty() {
                    return None;
                }
                let hidden = HiddenParameters {
                    // Points of a forecast have no N2, and most of what evaluates a model has no deck: N2 told the size.
                    throttle_argument: ThrottleArgument::CorrectedThrust,
                    ..*layer.effects.hidden()
                };
                let effects = effects.with_hidden(hidden);
                let effects =
                    if dated { effects } else { on_reference_date(&effects, &layer.references) };
                Some(Terms::of(&effects, &layer.references))
            })
            .collect()
    }
}

/// The column of flight points that an effect's input would be in, where the point lacks it. Roll and drift are no columns
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
        NeededInput::FuelFlowPerEngine => (true, ""),
    };
    (!there).then_some(name)
}

/// The effects as they are on the date of their references: no ageing since, a step as it was then.
fn on_reference_date(effects: &Effects, references: &EffectReferences) -> Effects {
    let mut hidden = *effects.hidden();
    hidden.step_from_s =
        if references.date_s >= hidden.step_from_s { f64::NEG_INFINITY } else { f64::INFINITY };
    let mut there = Effects::none();
    for (id, size) in effects.iter() {
        if !matches!(id, EffectId::AirframeAgeing | EffectId::EngineAgeing) {
            there = there.with(id, size);
        }
    }
    there.with_hidden(hidden)
}

/// Applied effects made ready for a drag table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Contained {
    pub(super) applied: AppliedEffects,
    /// Effects that predictions have.
    pub(super) physical: Vec<Terms>,
    /// The same on the date of their references.
    undated: Vec<Terms>,
    /// Effects that recordings are corrected by.
    pub(super) recorded: Vec<Terms>,
    polar: Surface,
}

impl Contained {
    pub(crate) fn of(
        applied: AppliedEffects,
        drag_table: &Table,
    ) -> Result<Option<Self>, EffectModelError> {
        if applied.is_empty() {
            return Ok(None);
        }
        for layer in &applied.layers {
            layer.references.check()?;
            for (effect, size) in layer.effects.iter() {
                if !size.is_finite() {
                    return Err(EffectModelError::Size { effect, size });
                }
            }
        }
        let is_physical = |id: EffectId| !id.is_of_recordings();
        Ok(Some(Self {
            physical: applied.terms(is_physical, true),
            undated: applied.terms(is_physical, false),
            recorded: applied.terms(EffectId::is_of_recordings, true),
            polar: polar_of(drag_table)?,
            applied,
        }))
    }

    pub(crate) const fn applied(&self) -> &AppliedEffects {
        &self.applied
    }

    pub(crate) fn changes_predictions(&self) -> bool {
        !self.physical.is_empty()
    }

    pub(crate) fn refit(&mut self, drag_table: &Table) -> Result<(), FitError> {
        self.polar = polar_of(drag_table)?;
        Ok(())
    }
}

/// Undoes layers of recording errors, one after the other.
pub(super) fn corrected_by<'m>(
    layers: &[Terms],
    means: &'m SegmentMeans,
    engines: usize,
) -> Result<Cow<'m, SegmentMeans>, EffectError> {
    let mut result = Cow::Borrowed(means);
    for terms in layers {
        result = Cow::Owned(corrected(&result, terms, engines)?);
    }
    Ok(result)
}

impl PerformanceModel {
    /// A segment as it would have been recorded without the errors that were applied; the same where none was.
    ///
    /// # Errors
    /// [`EffectError`] where a correction leaves the domain of a quantity.
    pub fn corrected<'s>(&self, segment: &'s Segment) -> Result<Cow<'s, Segment>, EffectError> {
        Ok(match self.corrected_means(&segment.means)? {
            Cow::Borrowed(_) => Cow::Borrowed(segment),
            Cow::Owned(means) => Cow::Owned(Segment { means, ..segment.clone() }),
        })
    }

    /// The same of a segment's means.
    ///
    /// # Errors
    /// As for [`corrected`](Self::corrected).
    pub fn corrected_means<'s>(
        &self,
        means: &'s SegmentMeans,
    ) -> Result<Cow<'s, SegmentMeans>, EffectError> {
        let recorded = self.contained().map_or(&[][..], |contained| &contained.recorded);
        corrected_by(recorded, means, self.aircraft().engines())
    }

    /// A segment as an aircraft without any of the applied effects would have recorded it: errors undone, then fuel flow
    /// brought to the model without effects.
    ///
    /// ```text
    /// Wf → Wf·Ŵf_without/Ŵf_with,  both predicted over the drag table at the corrected means          [applying.2]
    /// ```
    ///
    /// Engines recorded apart each by their own ratio, their sum by that of the total. The same segment where nothing is
    /// applied, or where the table does not hold the point (which the caller then meets).
    ///
    /// # Errors
    /// [`EffectError`] where a correction leaves the domain of a quantity, or no thrust is left.
    pub fn without_effects<'s>(
        &self,
        segment: &'s Segment,
        drag_table: &Table,
    ) -> Result<Cow<'s, Segment>, EffectError> {
        let corrected = self.corrected(segment)?;
        let Some(contained) = self.contained().filter(|c| c.changes_predictions()) else {
            return Ok(corrected);
        };
        #[expect(clippy::cast_precision_loss, reason = "seconds since 1970 are below 2^53")]
        let start_s = segment.identity.start.as_second() as f64;
        let point = EffectPoint::of_means(&corrected.means, start_s, self.aircraft().engines());
        let without = match self.predicted(&point, drag_table, &[]) {
            Err(EffectError::OutsideTable { .. }) => return Ok(corrected),
            result => result?,
        };
        let with = self.predicted(&point, drag_table, &contained.physical)?;
        let mut bare = corrected.into_owned();
        let means = &mut bare.means;
        means.fuel_flow_total_kg_s *= (without.ln_fuel_flow_total - with.ln_fuel_flow_total).exp();
        let mut sum = 0.0;
        for (engine, flow) in means.fuel_flow_engine_kg_s.iter_mut().enumerate() {
            *flow *= (without.ln_fuel_flow_engine[engine] - with.ln_fuel_flow_engine[engine]).exp();
            sum += *flow;
        }
        for flow in &mut means.fuel_flow_engine_kg_s {
            *flow *= means.fuel_flow_total_kg_s / sum;
        }
        Ok(Cow::Owned(bare))
    }

    /// The response at a flight point with the physical effects that were applied; those whose input the point lacks at
    /// their reference ([`AppliedEffects::at_reference`]).
    ///
    /// # Errors
    /// [`EffectError`] for a quantity outside its domain, a point outside the table, or no thrust left.
    pub fn response(&self, point: &FlightPoint) -> Result<Response, EffectError> {
        let terms = self.contained().map_or(&[][..], |contained| {
            if point.date.is_some() { &contained.physical } else { &contained.undated }
        });
        let point = EffectPoint::of_flight_point(point, self.aircraft().engines())?;
        self.predicted(&point, self.drag_table(), terms)
    }

    fn predicted(
        &self,
        point: &EffectPoint,
        drag_table: &Table,
        contained: &[Terms],
    ) -> Result<Response, EffectError> {
        let polar = self.contained().map_or(*self.polynomial(), |contained| contained.polar);
        let model = EffectModel {
            aircraft: self.aircraft(),
            drag_table,
            polar,
            // Those of trial effects, and there are none.
            references: EffectReferences::UNUSED,
            applied: None,
            contained,
            recorded: &[],
        };
        let trial = Terms::of(&Effects::none(), &EffectReferences::UNUSED);
        let layers = Layers { contained, trial: &trial };
        let (response, _) = model.evaluate(point, layers, layers.moves_the_point(), None)?;
        Ok(response)
    }
}

#[cfg(test)]
mod tests;
