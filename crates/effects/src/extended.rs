//! A performance model with effects of past diagnoses applied: every command predicts and observes with it.

use std::borrow::Cow;

use atmos::{airspeed, isa};
use flight::{Observation, Segment, SegmentMeans};
use lut::Table;
use lut::surface::Surface;
use perf_model::fuel_flow::{self, CruiseConditions};
use perf_model::{
    Aircraft, FlightPoint, PerformanceModel, Prediction, SegmentPrediction, SegmentState, forces,
};
use units::{Acceleration, Force, FuelFlowTotal, OutOfDomain, Tsfc};

use crate::applied::{AppliedEffects, Prepared};
use crate::error::{EffectError, EffectModelError, ObserveError, PredictError};
use crate::point::EffectPoint;
use crate::recorded::corrected_by;
use crate::references::EffectReferences;
use crate::response::{Bare, Edge, Response, evaluate};
use crate::set::Effects;
use crate::terms::{Layers, Terms};

/// A performance model and the effects that were applied to it; a plain model converts by [`From`].
///
/// Effects of the aircraft and its surroundings are part of every prediction; effects of the recording (sensors, load
/// sheet, fuel quantity) are undone in every recorded segment, and never change a prediction for a flight point.
#[derive(Clone, Debug, PartialEq)]
pub struct ExtendedModel {
    base: PerformanceModel,
    applied: Option<Box<Prepared>>,
}

impl From<PerformanceModel> for ExtendedModel {
    fn from(base: PerformanceModel) -> Self {
        Self { base, applied: None }
    }
}

impl ExtendedModel {
    /// This model with these effects.
    ///
    /// # Errors
    /// [`EffectModelError`] for a size or reference that is not finite, and where the drag table does not determine the
    /// polar that some effects scale.
    pub fn new(base: PerformanceModel, applied: AppliedEffects) -> Result<Self, EffectModelError> {
        let applied = Prepared::new(applied, base.drag_table())?.map(Box::new);
        Ok(Self { base, applied })
    }

    /// The same model with these effects in place of those that it contained.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn with_effects(&self, applied: AppliedEffects) -> Result<Self, EffectModelError> {
        Self::new(self.base.clone(), applied)
    }

    /// The same model with another drag table, for example an adapted one.
    ///
    /// # Errors
    /// [`EffectModelError`] where the table is not on the aircraft's grid, a drag coefficient is not positive, or the
    /// table does not determine the polar that applied effects scale.
    pub fn with_drag_table(&self, drag_table: Table) -> Result<Self, EffectModelError> {
        let base = self.base.with_drag_table(drag_table)?;
        let mut applied = self.applied.clone();
        if let Some(prepared) = &mut applied {
            prepared.refit(base.drag_table())?;
        }
        Ok(Self { base, applied })
    }

    /// The model without any effect.
    #[must_use]
    pub const fn base(&self) -> &PerformanceModel {
        &self.base
    }

    /// The effects that the model contains; `None` for a model without any.
    #[must_use]
    pub fn effects(&self) -> Option<&AppliedEffects> {
        self.prepared().map(Prepared::effects)
    }

    /// The aircraft.
    #[must_use]
    pub const fn aircraft(&self) -> &Aircraft {
        self.base.aircraft()
    }

    /// The polynomial that was fitted to the guide.
    #[must_use]
    pub const fn polynomial(&self) -> &Surface {
        self.base.polynomial()
    }

    /// Drag coefficient, without effects, over lift coefficient (outer) and Mach number (inner).
    #[must_use]
    pub const fn drag_table(&self) -> &Table {
        self.base.drag_table()
    }

    /// Which nodes of the drag table no row of the guide supports, in node order.
    #[must_use]
    pub fn extrapolated(&self) -> &[bool] {
        self.base.extrapolated()
    }

    /// The state of a segment as recorded: every quantity that does not need the drag table.
    ///
    /// # Errors
    /// [`OutOfDomain`] as for [`PerformanceModel::state_of`].
    pub fn state_of(&self, segment: &Segment) -> Result<SegmentState, OutOfDomain> {
        self.base.state_of(segment)
    }

    /// The observation of a segment, as [`PerformanceModel::observe`]. Applied effects are removed first
    /// ([`without_effects`](Self::without_effects)): what is left is drag, and everything that is not among them.
    ///
    /// # Errors
    /// [`ObserveError`] where the base model gives no observation, or an effect no prediction.
    pub fn observe(&self, segment: &Segment) -> Result<Observation, ObserveError> {
        if self.applied.is_none() {
            return Ok(self.base.observe(segment)?);
        }
        let bare = self.without_effects(segment, self.drag_table())?;
        Ok(self.base.observe(&bare)?)
    }

    /// Predicted fuel flow and error of a segment by a drag table, for example an adapted one or
    /// [`drag_table`](Self::drag_table). State and drag coefficient are those without the applied effects; fuel flow and
    /// error are as recorded.
    ///
    /// # Errors
    /// [`PredictError`] where a mean is outside its domain, the point is outside the table, the table is on another
    /// grid than the model's, or an effect has no prediction.
    pub fn predict_segment(
        &self,
        segment: &Segment,
        drag_table: &Table,
    ) -> Result<SegmentPrediction, PredictError> {
        if self.applied.is_none() {
            return Ok(self.base.predict_segment(segment, drag_table)?);
        }
        if drag_table.grid() != self.aircraft().grid() {
            return Err(perf_model::PredictError::GridDiffers.into());
        }
        let recorded = FuelFlowTotal::kilograms_per_second(segment.means.fuel_flow_total_kg_s);
        let bare = self.without_effects(segment, drag_table)?;
        let plain = self.base.predict_segment(&bare, drag_table)?;
        let fuel_flow_total = plain.fuel_flow_total * (recorded / plain.state.fuel_flow_total);
        Ok(SegmentPrediction {
            fuel_flow_total,
            error_percent: fuel_flow::fuel_flow_error_percent(recorded, fuel_flow_total),
            ..plain
        })
    }

    /// Predicted fuel flow and specific range at a flight point: level flight without acceleration.
    ///
    /// Lift coefficient, drag coefficient, thrust and TSFC include the applied physical effects, held at their
    /// reference where the point lacks an input ([`AppliedEffects::at_reference`]).
    ///
    /// # Errors
    /// [`PredictError`] where a number is outside its domain or the point is outside the table.
    pub fn predict(&self, point: &FlightPoint) -> Result<Prediction, PredictError> {
        let plain = self.base.predict(point)?;
        if self.without_applied().is_some() { Ok(plain) } else { self.with_applied(point, plain) }
    }

    /// The model without any effect where no applied effect changes a prediction for a flight point: [`predict`](Self::predict)
    /// is then its prediction.
    #[must_use]
    pub fn without_applied(&self) -> Option<&PerformanceModel> {
        let changes = self.prepared().is_some_and(Prepared::changes_predictions);
        (!changes).then_some(&self.base)
    }

    /// The response at a flight point with the applied physical effects; those whose input the point lacks are held at
    /// their reference ([`AppliedEffects::at_reference`]).
    ///
    /// # Errors
    /// [`EffectError`] for a quantity outside its domain, a point outside the table, or no thrust left.
    pub fn response(&self, point: &FlightPoint) -> Result<Response, EffectError> {
        let terms = self.prepared().map_or(&[][..], |prepared| {
            if point.date.is_some() { &prepared.physical } else { &prepared.undated }
        });
        let point = EffectPoint::from_flight_point(point, self.aircraft().engines())?;
        self.predicted(&point, self.drag_table(), terms)
    }

    /// A segment as it would have been recorded without the errors that were applied; unchanged where there are none.
    ///
    /// # Errors
    /// [`EffectError`] where a correction leaves the domain of a quantity.
    pub fn corrected<'s>(&self, segment: &'s Segment) -> Result<Cow<'s, Segment>, EffectError> {
        if self.applied.is_none() {
            return Ok(Cow::Borrowed(segment));
        }
        Ok(match self.corrected_means(&segment.means)? {
            Cow::Borrowed(_) => Cow::Borrowed(segment),
            Cow::Owned(means) => Cow::Owned(Segment { means, ..segment.clone() }),
        })
    }

    /// The same for a segment's means.
    ///
    /// # Errors
    /// As for [`corrected`](Self::corrected).
    pub fn corrected_means<'s>(
        &self,
        means: &'s SegmentMeans,
    ) -> Result<Cow<'s, SegmentMeans>, EffectError> {
        let recorded = self.prepared().map_or(&[][..], |prepared| &prepared.recorded);
        corrected_by(recorded, means, self.aircraft().engines())
    }

    /// A segment as an aircraft without any of the applied effects would have recorded it: errors undone, then fuel
    /// flow converted to that of the model without effects.
    ///
    /// ```text
    /// Wf → Wf·Ŵf_without/Ŵf_with,  both predicted over the drag table at the corrected means          [applying.2]
    /// ```
    ///
    /// Engines that are recorded separately are each scaled by their own ratio, their sum by that of the total. The
    /// segment is unchanged where nothing is applied, or where the point is outside the table (the caller then gets
    /// that error).
    ///
    /// # Errors
    /// [`EffectError`] where a correction leaves the domain of a quantity, or no thrust is left.
    pub fn without_effects<'s>(
        &self,
        segment: &'s Segment,
        drag_table: &Table,
    ) -> Result<Cow<'s, Segment>, EffectError> {
        let corrected = self.corrected(segment)?;
        let Some(prepared) = self.prepared().filter(|p| p.changes_predictions()) else {
            return Ok(corrected);
        };
        let point = EffectPoint::from_segment(&corrected, self.aircraft().engines());
        let without = match self.predicted(&point, drag_table, &[]) {
            Err(EffectError::OutsideTable { .. }) => return Ok(corrected),
            result => result?,
        };
        let with = self.predicted(&point, drag_table, &prepared.physical)?;
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

    /// The applied effects, prepared.
    pub(crate) fn prepared(&self) -> Option<&Prepared> {
        self.applied.as_deref()
    }

    /// A prediction with the applied physical effects.
    fn with_applied(
        &self,
        point: &FlightPoint,
        plain: Prediction,
    ) -> Result<Prediction, PredictError> {
        let response = self.response(point)?;
        let fuel_flow_total =
            FuelFlowTotal::kilograms_per_second(response.ln_fuel_flow_total.exp());
        let net_thrust = Force::newtons(response.net_thrust_n);
        let tsfc = Tsfc::kilograms_per_newton_second(
            fuel_flow_total.to_kilograms_per_second() / net_thrust.to_newtons(),
        );
        let density = isa::density(plain.static_pressure, point.static_air_temperature()?);
        let conditions = CruiseConditions {
            dynamic_pressure: airspeed::dynamic_pressure(density, plain.true_airspeed),
            wing_area: self.aircraft().wing_area(),
            tsfc,
            mass: point.mass,
            acceleration: Acceleration::meters_per_second_squared(0.0),
        };
        let drag = Force::newtons(response.net_thrust_n * response.drag_over_thrust);
        Ok(Prediction {
            lift_coefficient: response.lift_coefficient,
            drag_coefficient: forces::drag_coefficient(
                drag,
                conditions.dynamic_pressure,
                conditions.wing_area,
            ),
            net_thrust,
            tsfc,
            fuel_flow_per_drag_coefficient_kg_s: fuel_flow::fuel_flow_per_drag_coefficient_kg_s(
                &conditions,
            ),
            ..plain
        }
        .with_fuel_flow(fuel_flow_total, point))
    }

    fn predicted(
        &self,
        point: &EffectPoint,
        drag_table: &Table,
        contained: &[Terms],
    ) -> Result<Response, EffectError> {
        let polar = self.prepared().map_or(*self.polynomial(), |prepared| prepared.polar);
        let bare = Bare {
            aircraft: self.aircraft(),
            drag_table,
            polar,
            levels: self.base.levels(),
            smooth: None,
        };
        // References are for trial effects, and there are none.
        let trial = Terms::new(&Effects::none(), &EffectReferences::UNUSED);
        let layers = Layers { contained, trial: &trial };
        let (response, _) = evaluate(&bare, point, layers, Edge::under(layers), None)?;
        Ok(response)
    }
}

#[cfg(test)]
mod tests;
