//! A performance model in which effects can be switched on: used by a diagnosis to try them.

use std::borrow::Cow;

use flight::SegmentMeans;
use flight::effect::EffectId;
use lut::{SmoothTable, Table};
use perf_model::{Aircraft, GuideLevels};

use crate::applied::{AppliedEffects, Prepared};
use crate::error::{EffectError, EffectModelError};
use crate::extended::ExtendedModel;
use crate::known::{KnownPoint, Trial};
use crate::point::EffectPoint;
use crate::polar::fit_polar;
use crate::recorded;
use crate::references::EffectReferences;
use crate::response::{Bare, BetweenNodes, Edge, Response, evaluate};
use crate::set::Effects;
use crate::terms::{Layers, Terms};

/// A performance model in which effects can be switched on.
///
/// Effects that the extended model contains already always act: its physical effects are part of every response, and
/// points are made from *corrected* recordings ([`ExtendedModel::corrected`]). Trial effects are added to them.
#[derive(Clone, Debug)]
pub struct EffectModel<'a> {
    bare: Bare<'a>,
    references: EffectReferences,
    applied: Option<&'a AppliedEffects>,
    contained: &'a [Terms],
    recorded: &'a [Terms],
    /// No trial effects.
    nothing: Terms,
}

impl<'a> EffectModel<'a> {
    /// A model with effects, over the extended model's own table or another one on its grid (an adapted one).
    ///
    /// CD0(M) and K(M), shares of which some effects scale, are the six-coefficient polynomial
    /// p0 + p1 M + p2 M² + (p3 + p4 M + p5 M²) CL² fitted to that table beside a drag rise. Book `[diagnosis.57]`.
    ///
    /// # Errors
    /// [`EffectModelError`] where the table is on another grid, does not determine the polynomial, or a reference is not
    /// positive.
    pub fn new(
        model: &'a ExtendedModel,
        drag_table: &'a Table,
        references: EffectReferences,
    ) -> Result<Self, EffectModelError> {
        if drag_table.grid() != model.aircraft().grid() {
            return Err(EffectModelError::GridDiffers);
        }
        references.check()?;
        let prepared = model.prepared();
        Ok(Self {
            bare: Bare {
                aircraft: model.aircraft(),
                drag_table,
                polar: fit_polar(drag_table)?,
                levels: model.base().levels(),
                smooth: None,
            },
            references,
            applied: prepared.map(Prepared::effects),
            contained: prepared.map_or(&[], |prepared| &prepared.physical),
            recorded: prepared.map_or(&[], |prepared| &prepared.recorded),
            nothing: Terms::new(&Effects::none(), &references),
        })
    }

    /// The same with another surface between the nodes of its drag table; bilinear where this is not called.
    #[must_use]
    pub fn between_nodes(mut self, between_nodes: BetweenNodes) -> Self {
        let is_smooth = between_nodes == BetweenNodes::Smooth;
        self.bare.smooth = is_smooth.then(|| SmoothTable::new(self.bare.drag_table));
        self
    }

    /// Whether the drag table is bilinear between its nodes.
    #[must_use]
    pub const fn is_bilinear(&self) -> bool {
        self.bare.smooth.is_none()
    }

    /// Whether the model contains an effect already.
    #[must_use]
    pub fn contains(&self, effect: EffectId) -> bool {
        self.applied.is_some_and(|applied| applied.contains(effect))
    }

    /// The effects that the model contains already; `None` for none.
    #[must_use]
    pub const fn applied(&self) -> Option<&AppliedEffects> {
        self.applied
    }

    /// A segment's means as they would have been recorded without the errors that the model contains; points are made
    /// from these.
    ///
    /// # Errors
    /// [`EffectError`] where a correction leaves the domain of a quantity.
    pub fn corrected_means<'m>(
        &self,
        means: &'m SegmentMeans,
    ) -> Result<Cow<'m, SegmentMeans>, EffectError> {
        recorded::corrected_by(self.recorded, means, self.bare.aircraft.engines())
    }

    /// Ratio of the fuel that meters counted to the fuel that was burnt, by the errors that the model contains, at a
    /// corrected point.
    #[must_use]
    pub fn metered_over_burnt(&self, point: &EffectPoint) -> f64 {
        let of = |terms: &Terms| -> f64 {
            let shares = point.fuel_flow_share.iter().zip(terms.fuel_flow_gain);
            1.0 + shares.map(|(share, gain)| share * gain).sum::<f64>()
        };
        self.recorded.iter().map(of).product()
    }

    /// The references.
    #[must_use]
    pub const fn references(&self) -> &EffectReferences {
        &self.references
    }

    /// The aircraft.
    #[must_use]
    pub const fn aircraft(&self) -> &Aircraft {
        self.bare.aircraft
    }

    /// By how much drag differs by level from the table; `None` where it does not.
    #[must_use]
    pub const fn levels(&self) -> Option<&'a GuideLevels> {
        self.bare.levels
    }

    /// The drag table.
    #[must_use]
    pub const fn drag_table(&self) -> &Table {
        self.bare.drag_table
    }

    /// The recorded quantities at this segment if the effects were present.
    ///
    /// The recorded point must be inside the table; where an effect moves it beyond the table's edge, the edge's bilinear
    /// surface is continued in a straight line: effects are small, and a value held at the edge would have no slope.
    ///
    /// # Errors
    /// [`EffectError`] for an input that is not recorded, a quantity outside its domain, a point outside the table, or
    /// when no thrust is left.
    ///
    /// # Source
    /// Book, page on diagnosis, `[diagnosis.1]` to `[diagnosis.11]`.
    pub fn response(
        &self,
        point: &EffectPoint,
        effects: &Effects,
    ) -> Result<Response, EffectError> {
        let acting = effects.iter().filter(|(_, size)| *size != 0.0);
        has_inputs(acting.map(|(effect, _)| effect), point)?;
        let trial = Terms::new(effects, &self.references);
        let layers = Layers { contained: self.contained, trial: &trial };
        evaluate(&self.bare, point, layers, Edge::under(layers), None).map(|(response, _)| response)
    }

    /// As [`response`](Self::response), at a point near a recorded one: the table is continued in a straight line there
    /// too. For derivatives with respect to recorded quantities.
    ///
    /// # Errors
    /// As for [`response`](Self::response), but for a point outside the table.
    pub fn response_beside(
        &self,
        point: &EffectPoint,
        effects: &Effects,
    ) -> Result<Response, EffectError> {
        let own;
        let trial = if effects.as_slice().is_empty() {
            &self.nothing
        } else {
            own = Terms::new(effects, &self.references);
            &own
        };
        let layers = Layers { contained: self.contained, trial };
        evaluate(&self.bare, point, layers, Edge::Continue, None).map(|(response, _)| response)
    }

    /// [`response_beside`](Self::response_beside) of a point that differs in mass and acceleration alone, without trial effects,
    /// to the last bit and in less time: the air is the same.
    ///
    /// # Errors
    /// As there.
    pub fn response_with_mass_and_acceleration(
        &self,
        at: &KnownPoint,
        mass_kg: f64,
        acceleration_m_s2: f64,
    ) -> Result<Response, EffectError> {
        let layers = Layers { contained: self.contained, trial: &self.nothing };
        let point = EffectPoint { acceleration_m_s2, mass_kg, ..at.point };
        let same = mass_kg.to_bits() == at.point.mass_kg.to_bits();
        let known = if same { at.known } else { at.known.with_mass_kg(mass_kg) };
        let found = evaluate(&self.bare, &point, layers, Edge::Continue, Some(&known));
        found.map(|(response, _)| response)
    }

    /// Prepares effects for many points.
    #[must_use]
    pub fn trial(&self, effects: &Effects) -> Trial {
        Trial {
            terms: Terms::new(effects, &self.references),
            acting: effects.iter().filter(|(_, size)| *size != 0.0).map(|(id, _)| id).collect(),
        }
    }

    /// A recorded point and its response without trial effects, for [`response_at`](Self::response_at).
    ///
    /// # Errors
    /// As for [`response`](Self::response) without effects.
    pub fn known_point(&self, point: &EffectPoint) -> Result<(KnownPoint, Response), EffectError> {
        let layers = Layers { contained: self.contained, trial: &self.nothing };
        let (response, known) = evaluate(&self.bare, point, layers, Edge::under(layers), None)?;
        Ok((KnownPoint { point: *point, known }, response))
    }

    /// The same numbers as [`response`](Self::response), to the last bit, in less time: what the effects do not change
    /// is not computed again.
    ///
    /// # Errors
    /// As for [`response`](Self::response).
    pub fn response_at(&self, at: &KnownPoint, trial: &Trial) -> Result<Response, EffectError> {
        has_inputs(trial.acting.iter().copied(), &at.point)?;
        let layers = Layers { contained: self.contained, trial: &trial.terms };
        let edge = Edge::under(layers);
        evaluate(&self.bare, &at.point, layers, edge, Some(&at.known)).map(|(response, _)| response)
    }
}

/// Whether every input of these effects was recorded at a point.
fn has_inputs(
    effects: impl Iterator<Item = EffectId>,
    point: &EffectPoint,
) -> Result<(), EffectError> {
    for effect in effects {
        if let Some(needs) = point.lacks(effect) {
            return Err(EffectError::NotRecorded { effect, needs: needs.name() });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
