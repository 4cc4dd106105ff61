//! Effects that a model may contain: what each effect of the library does to the predicted fuel flow of a segment.
//!
//! Id, unit and typical size of an effect are in [`flight::effect`]; here is the physics. An effect changes the drag
//! coefficient, the TSFC, the weight that lift carries, or undoes an error of what was recorded; nothing is linearised.
//! What is predicted is always the *recorded* fuel flow, so that the residual ln Wf recorded − ln Wf predicted is the
//! gap.
//!
//! Difficult: a sensor effect says how the *recording* errs, so that its sign is the other way round from a change of the
//! aircraft. All of it is in the file on what was recorded.

use std::borrow::Cow;

use flight::effect::{EffectId, TypicalSize};
use flight::{MAXIMUM_ENGINES, SegmentMeans};
use lut::surface::{Basis, FitError, Surface, fit};
use lut::{Outside, Table};
use serde::{Deserialize, Serialize};
use units::{Mach, OutOfDomain};

use crate::tsfc::tsfc;
use crate::{Aircraft, FlightPoint, PerformanceModel};

mod applied;
mod drag;
mod engine;
mod known;
mod recorded;
mod terms;

pub use applied::{AppliedEffects, AppliedLayer};
pub use engine::ANTI_ICE_PROXY_K;
pub use known::{KnownPoint, Trial};
pub use terms::{Effects, HiddenParameters, StepTarget, ThrottleArgument};

pub(crate) use applied::Contained;
use known::{Known, has_inputs};
use terms::{Layers, Terms};

/// What effects need to know about a segment. SI unless the name says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectPoint {
    /// Instant, s since 1970.
    pub date_s: f64,
    /// Pressure altitude, m.
    pub pressure_altitude_m: f64,
    /// Static air temperature, K.
    pub static_air_temperature_k: f64,
    /// Mach number.
    pub mach: f64,
    /// True airspeed, m/s.
    pub true_airspeed_m_s: f64,
    /// Ground speed, m/s.
    pub ground_speed_m_s: f64,
    /// Along-path acceleration, m/s².
    pub acceleration_m_s2: f64,
    /// Gross mass, kg.
    pub mass_kg: f64,
    /// Fuel used since engine start, kg.
    pub fuel_used_kg: f64,
    /// Share of each engine in the recorded fuel flow; equal shares where engines are not recorded apart.
    pub fuel_flow_share: [f64; MAXIMUM_ENGINES],
    /// Mean of the squared roll angle, degrees².
    pub roll_squared_deg2: Option<f64>,
    /// Drift angle, degrees: track minus heading.
    pub drift_deg: Option<f64>,
    /// Latitude, degrees.
    pub latitude_deg: Option<f64>,
    /// True heading, degrees.
    pub true_heading_deg: Option<f64>,
    /// Center of gravity, % of the mean aerodynamic chord.
    pub center_of_gravity_percent_mac: Option<f64>,
    /// Share of the samples with anti-ice bleed on.
    pub anti_ice: Option<f64>,
    /// Net thrust of all engines over pressure ratio that the recorded N2 stands for, N. It takes a deck (N2 over corrected
    /// thrust), which whoever makes points may have; `None` without one, or where N2 is not recorded.
    pub corrected_thrust_by_n2_n: Option<f64>,
}

/// What effects are zero at: the mean of what a model was adapted to, or of the data at hand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EffectReferences {
    /// Instant, s since 1970.
    pub date_s: f64,
    /// Mach number.
    pub mach: f64,
    /// Reynolds number over one meter.
    pub unit_reynolds_number_per_m: f64,
    /// Static air temperature over that of the standard day at sea level.
    pub temperature_ratio: f64,
    /// Net thrust of all engines over pressure ratio, N.
    pub corrected_thrust_n: f64,
    /// Fuel flow of all engines, kg/s.
    pub fuel_flow_total_kg_s: f64,
    /// Gross mass, kg.
    pub mass_kg: f64,
    /// Center of gravity, % of the mean aerodynamic chord; `None` where it is not recorded.
    pub center_of_gravity_percent_mac: Option<f64>,
}

/// A performance model that effects can be switched on in.
///
/// What the performance model contains already ([`PerformanceModel::with_effects`]) acts always: its physical effects are
/// part of every response, and points are those of *corrected* recordings
/// ([`PerformanceModel::corrected`]). Trial effects come on top.
#[derive(Clone, Debug)]
pub struct EffectModel<'a> {
    aircraft: &'a Aircraft,
    drag_table: &'a Table,
    polar: Surface,
    references: EffectReferences,
    applied: Option<&'a AppliedEffects>,
    contained: &'a [Terms],
    recorded: &'a [Terms],
}

/// The prediction for one segment, with everything the residual channels ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Natural logarithm of the fuel flow of all engines that would be recorded, kg/s.
    pub ln_fuel_flow_total: f64,
    /// The same of each engine; equal thrust is assumed. −∞ beyond the aircraft's engines.
    pub ln_fuel_flow_engine: [f64; MAXIMUM_ENGINES],
    /// ln(F/δ), F the net thrust of all engines in N, δ the pressure ratio.
    pub ln_corrected_thrust: f64,
    /// ln δ.
    pub ln_pressure_ratio: f64,
    /// ln θ, θ the ratio of static air temperature.
    pub ln_temperature_ratio: f64,
    /// Mach number as it truly was.
    pub mach: f64,
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Drag over net thrust: how much of a change of drag arrives in fuel flow.
    pub drag_over_thrust: f64,
    /// Net thrust of all engines, N.
    pub net_thrust_n: f64,
    /// Reynolds number over one meter.
    pub unit_reynolds_number_per_m: f64,
    /// Gross mass as it truly was, kg.
    pub mass_kg: f64,
}

/// Why there is no model with effects.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EffectModelError {
    /// A table on another grid than the aircraft's.
    #[error("the drag table is not on the grid of the aircraft file")]
    GridDiffers,
    /// The table does not determine CD0(M) and K(M).
    #[error("CD0(M) and K(M) cannot be fitted to the drag table: {0}")]
    Polar(#[from] FitError),
    /// A reference that is not finite and positive.
    #[error("reference {quantity} is {value}, not finite and positive")]
    Reference {
        /// Which.
        quantity: &'static str,
        /// What was given.
        value: f64,
    },
    /// The size of an applied effect that is not finite.
    #[error("size of {effect} is {size}, not finite")]
    Size {
        /// The effect.
        effect: EffectId,
        /// What was given.
        size: f64,
    },
    /// No segment that the model can predict, so no references.
    #[error("none of {segments} segments is inside the drag table")]
    NothingInside {
        /// Segments given.
        segments: usize,
    },
}

/// Why an effect has no prediction for a segment.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EffectError {
    /// An input that the effect needs was not recorded.
    #[error("{effect} needs {needs}, which is not recorded")]
    NotRecorded {
        /// The effect.
        effect: EffectId,
        /// Name of the column.
        needs: &'static str,
    },
    /// A quantity outside its domain, as recorded or as corrected by a sensor effect.
    #[error(transparent)]
    OutOfDomain(#[from] OutOfDomain),
    /// The table does not hold the *recorded* point.
    #[error("lift coefficient {lift_coefficient:.4}, Mach number {mach:.4} outside the drag table")]
    OutsideTable {
        /// Lift coefficient.
        lift_coefficient: f64,
        /// Mach number.
        mach: f64,
    },
    /// No thrust is left with these effects.
    #[error("net thrust {net_thrust_n:.0} N is not positive")]
    ThrustNotPositive {
        /// Net thrust, N.
        net_thrust_n: f64,
    },
}

impl EffectPoint {
    /// The point that a prediction is wanted for: level, unaccelerated, wings level, no wind. Anti-ice bleed is off and
    /// the center of gravity, latitude and heading are unknown where the flight point does not say; `date_s` is 0 without
    /// a date.
    ///
    /// # Errors
    /// [`OutOfDomain`] for a pressure altitude outside the atmosphere's domain.
    pub fn of_flight_point(point: &FlightPoint, engines: usize) -> Result<Self, OutOfDomain> {
        let sat = point.static_air_temperature()?;
        let true_airspeed_m_s =
            atmos::airspeed::mach_to_true_airspeed(point.mach, sat).to_meters_per_second();
        let engines = engines.clamp(1, MAXIMUM_ENGINES);
        let mut fuel_flow_share = [0.0; MAXIMUM_ENGINES];
        fuel_flow_share[..engines].fill(1.0 / engines as f64);
        #[expect(clippy::cast_precision_loss, reason = "seconds since 1970 are below 2^53")]
        let date_s = point.date.map_or(0.0, |date| date.as_second() as f64);
        Ok(Self {
            date_s,
            pressure_altitude_m: point.pressure_altitude.to_meters(),
            static_air_temperature_k: sat.to_kelvin(),
            mach: point.mach.value(),
            true_airspeed_m_s,
            ground_speed_m_s: true_airspeed_m_s,
            acceleration_m_s2: 0.0,
            mass_kg: point.mass.to_kilograms(),
            fuel_used_kg: 0.0,
            fuel_flow_share,
            roll_squared_deg2: None,
            drift_deg: None,
            latitude_deg: point.latitude.map(units::Angle::to_degrees),
            true_heading_deg: point.true_heading.map(units::Angle::to_degrees),
            center_of_gravity_percent_mac: point.center_of_gravity_percent_mac,
            anti_ice: Some(if point.anti_ice == Some(true) { 1.0 } else { 0.0 }),
            corrected_thrust_by_n2_n: None,
        })
    }

    /// The point of a segment's means. `engines` is the aircraft's number. No deck is at hand: what N2 stands for is left
    /// open.
    #[must_use]
    pub fn of_means(means: &SegmentMeans, start_s: f64, engines: usize) -> Self {
        let engines = engines.clamp(1, MAXIMUM_ENGINES);
        let total: f64 = means.fuel_flow_engine_kg_s.iter().sum();
        let mut fuel_flow_share = [0.0; MAXIMUM_ENGINES];
        for (engine, share) in fuel_flow_share.iter_mut().enumerate().take(engines) {
            *share = match means.fuel_flow_engine_kg_s.get(engine) {
                Some(flow) if total > 0.0 => flow / total,
                _ => 1.0 / engines as f64,
            };
        }
        Self {
            date_s: start_s + means.time_s,
            pressure_altitude_m: means.pressure_altitude_m,
            static_air_temperature_k: means.static_air_temperature_k,
            mach: means.mach,
            true_airspeed_m_s: means.true_airspeed_m_s,
            ground_speed_m_s: means.ground_speed_m_s,
            acceleration_m_s2: means.acceleration_m_s2,
            mass_kg: means.mass_kg,
            fuel_used_kg: means.fuel_used_kg,
            fuel_flow_share,
            roll_squared_deg2: means
                .roll_squared_deg2
                .or_else(|| means.roll_deg.map(|roll| roll * roll)),
            drift_deg: means.drift_deg,
            latitude_deg: means.latitude_deg,
            true_heading_deg: means.true_heading_deg,
            center_of_gravity_percent_mac: means.center_of_gravity_percent_mac,
            anti_ice: means.anti_ice,
            corrected_thrust_by_n2_n: None,
        }
    }
}

impl EffectReferences {
    /// For a model in which no effect is switched on: only effects look at references.
    const UNUSED: Self = Self {
        date_s: 0.0,
        mach: 1.0,
        unit_reynolds_number_per_m: 1.0,
        temperature_ratio: 1.0,
        corrected_thrust_n: 1.0,
        fuel_flow_total_kg_s: 1.0,
        mass_kg: 1.0,
        center_of_gravity_percent_mac: None,
    };

    /// The size of θ that is usual for an effect, in its unit.
    #[must_use]
    pub fn typical_size(&self, effect: EffectId) -> f64 {
        match effect.entry().typical {
            TypicalSize::Absolute(size) => size,
            TypicalSize::ShareOfMass(share) => share * self.mass_kg,
            TypicalSize::Known => 1.0,
        }
    }

    /// Means over segments, with thrust and fuel flow as the model predicts them. Points outside the table are left out.
    ///
    /// # Errors
    /// [`EffectModelError::NothingInside`] where none is left.
    pub fn mean_of(
        aircraft: &Aircraft,
        drag_table: &Table,
        points: &[EffectPoint],
    ) -> Result<Self, EffectModelError> {
        let model = EffectModel {
            aircraft,
            drag_table,
            polar: Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] },
            references: Self::UNUSED,
            applied: None,
            contained: &[],
            recorded: &[],
        };
        let mut sum = Self { mach: 0.0, ..Self::UNUSED };
        sum.unit_reynolds_number_per_m = 0.0;
        sum.temperature_ratio = 0.0;
        sum.corrected_thrust_n = 0.0;
        sum.fuel_flow_total_kg_s = 0.0;
        sum.mass_kg = 0.0;
        let (mut count, mut center, mut centers) = (0.0, 0.0, 0.0);
        // Dates about the first one, so that 1970's distance costs no digits.
        let first_date_s = points.first().map_or(0.0, |point| point.date_s);
        for point in points {
            let Ok(response) = model.response(point, &Effects::none()) else { continue };
            count += 1.0;
            sum.date_s += point.date_s - first_date_s;
            sum.mach += point.mach;
            sum.unit_reynolds_number_per_m += response.unit_reynolds_number_per_m;
            sum.temperature_ratio += response.ln_temperature_ratio.exp();
            sum.corrected_thrust_n += response.ln_corrected_thrust.exp();
            sum.fuel_flow_total_kg_s += response.ln_fuel_flow_total.exp();
            sum.mass_kg += point.mass_kg;
            if let Some(percent) = point.center_of_gravity_percent_mac {
                center += percent;
                centers += 1.0;
            }
        }
        if count == 0.0 {
            return Err(EffectModelError::NothingInside { segments: points.len() });
        }
        Ok(Self {
            date_s: first_date_s + sum.date_s / count,
            mach: sum.mach / count,
            unit_reynolds_number_per_m: sum.unit_reynolds_number_per_m / count,
            temperature_ratio: sum.temperature_ratio / count,
            corrected_thrust_n: sum.corrected_thrust_n / count,
            fuel_flow_total_kg_s: sum.fuel_flow_total_kg_s / count,
            mass_kg: sum.mass_kg / count,
            center_of_gravity_percent_mac: (centers > 0.0).then(|| center / centers),
        })
    }

    fn check(&self) -> Result<(), EffectModelError> {
        for (quantity, value) in [
            ("Mach number", self.mach),
            ("Reynolds number", self.unit_reynolds_number_per_m),
            ("temperature ratio", self.temperature_ratio),
            ("corrected thrust", self.corrected_thrust_n),
            ("fuel flow", self.fuel_flow_total_kg_s),
            ("gross mass", self.mass_kg),
        ] {
            if !value.is_finite() || value <= 0.0 {
                return Err(EffectModelError::Reference { quantity, value });
            }
        }
        Ok(())
    }
}

impl<'a> EffectModel<'a> {
    /// A model with effects, over the performance model's own table or another one on its grid (an adapted one).
    ///
    /// CD0(M) and K(M), shares of which some effects scale, are the six-coefficient polynomial
    /// p0 + p1 M + p2 M² + (p3 + p4 M + p5 M²) CL² fitted to that table.
    ///
    /// # Errors
    /// [`EffectModelError`] where the table is on another grid, does not determine the polynomial, or a reference is not
    /// positive.
    pub fn new(
        model: &'a PerformanceModel,
        drag_table: &'a Table,
        references: EffectReferences,
    ) -> Result<Self, EffectModelError> {
        if drag_table.grid() != model.aircraft().grid() {
            return Err(EffectModelError::GridDiffers);
        }
        references.check()?;
        let contained = model.contained();
        Ok(Self {
            aircraft: model.aircraft(),
            drag_table,
            polar: polar_of(drag_table)?,
            references,
            applied: contained.map(|contained| &contained.applied),
            contained: contained.map_or(&[], |contained| &contained.physical),
            recorded: contained.map_or(&[], |contained| &contained.recorded),
        })
    }

    /// Whether the model contains an effect already, beside trial ones.
    #[must_use]
    pub fn contains(&self, effect: EffectId) -> bool {
        self.applied.is_some_and(|applied| applied.contains(effect))
    }

    /// What the model contains already; `None` for nothing.
    #[must_use]
    pub const fn applied(&self) -> Option<&AppliedEffects> {
        self.applied
    }

    /// A segment's means as they would have been recorded without the errors that the model contains: what points are made
    /// of.
    ///
    /// # Errors
    /// [`EffectError`] where a correction leaves the domain of a quantity.
    pub fn corrected_means<'m>(
        &self,
        means: &'m SegmentMeans,
    ) -> Result<Cow<'m, SegmentMeans>, EffectError> {
        applied::corrected_by(self.recorded, means, self.aircraft.engines())
    }

    /// Fuel that meters counted over fuel that was burnt, by the errors that the model contains, at a corrected point.
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
        self.aircraft
    }

    /// The drag table.
    #[must_use]
    pub const fn drag_table(&self) -> &Table {
        self.drag_table
    }

    /// The inputs, beyond the required ones, that an effect lacks at this point; `None` where it can be predicted.
    #[must_use]
    pub fn lacks(effect: EffectId, point: &EffectPoint) -> Option<&'static str> {
        let missing = |present: bool, name: &'static str| (!present).then_some(name);
        match effect {
            EffectId::TrimDragCg => missing(point.center_of_gravity_percent_mac.is_some(), "CG"),
            EffectId::AsymmetryDrag | EffectId::LoadFactor => {
                missing(point.roll_squared_deg2.is_some(), "ROLL")
            }
            EffectId::LocalGravity => missing(point.latitude_deg.is_some(), "LAT"),
            EffectId::RotatingEarth => missing(point.latitude_deg.is_some(), "LAT")
                .or_else(|| missing(point.true_heading_deg.is_some(), "HDG")),
            EffectId::IsobaricSlope => missing(point.latitude_deg.is_some(), "LAT")
                .or_else(|| missing(point.drift_deg.is_some(), "DRIFT")),
            _ => None,
        }
    }

    /// What would be recorded at this segment if the effects were there.
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
        let trial = Terms::of(effects, &self.references);
        let layers = Layers { contained: self.contained, trial: &trial };
        self.evaluate(point, layers, layers.moves_the_point(), None).map(|(response, _)| response)
    }

    /// As [`response`](Self::response), at a point beside a recorded one: the table is continued in a straight line for
    /// it too. For derivatives with respect to what is recorded.
    ///
    /// # Errors
    /// As for [`response`](Self::response), but for a point outside the table.
    pub fn response_beside(
        &self,
        point: &EffectPoint,
        effects: &Effects,
    ) -> Result<Response, EffectError> {
        let trial = Terms::of(effects, &self.references);
        let layers = Layers { contained: self.contained, trial: &trial };
        self.evaluate(point, layers, true, None).map(|(response, _)| response)
    }

    fn evaluate(
        &self,
        point: &EffectPoint,
        layers: Layers<'_>,
        may_leave: bool,
        known: Option<&Known>,
    ) -> Result<(Response, Known), EffectError> {
        let uncorrected = known.filter(|_| !layers.trial.corrects_recordings());
        let (flown, tsfc_kg_per_n_s) = if let Some(known) = uncorrected {
            (known.flown, known.tsfc_kg_per_n_s)
        } else {
            let flown = recorded::as_flown(point, layers.trial)?;
            let law =
                tsfc(self.aircraft.tsfc_law(), flown.temperature_ratio, Mach::new(flown.mach));
            (flown, law.to_kilograms_per_newton_second())
        };
        let gravity_m_s2 = match known {
            Some(known) if !layers.trial.changes_weight() => known.gravity_m_s2,
            _ => drag::apparent_gravity_m_s2(point, layers),
        };
        let surface_n = flown.dynamic_pressure_pa * self.aircraft.wing_area().to_square_meters();
        let lift_coefficient = flown.mass_kg * gravity_m_s2 / surface_n;
        let table = match uncorrected {
            Some(known) if !layers.trial.moves_the_point() => known.table,
            _ => self.table_value(lift_coefficient, flown.mach, may_leave)?,
        };
        let drag_coefficient =
            self.drag_coefficient(table, lift_coefficient, point, &flown, layers);
        let drag_n = surface_n * drag_coefficient;
        let net_thrust_n = drag_n + drag::path_force_n(point, &flown, layers);
        // Written so that NaN is refused too.
        if net_thrust_n.is_nan() || net_thrust_n <= 0.0 {
            return Err(EffectError::ThrustNotPositive { net_thrust_n });
        }
        let corrected_thrust_n = net_thrust_n / flown.pressure_ratio;
        let (total_kg_s, engines_kg_s) = self.recorded_fuel_flow(
            net_thrust_n,
            corrected_thrust_n,
            tsfc_kg_per_n_s,
            point,
            &flown,
            layers,
        );
        let mut ln_fuel_flow_engine = [f64::NEG_INFINITY; MAXIMUM_ENGINES];
        for (ln, flow_kg_s) in
            ln_fuel_flow_engine.iter_mut().zip(engines_kg_s).take(self.aircraft.engines())
        {
            *ln = flow_kg_s.ln();
        }
        let response = Response {
            ln_fuel_flow_total: total_kg_s.ln(),
            ln_fuel_flow_engine,
            ln_corrected_thrust: corrected_thrust_n.ln(),
            ln_pressure_ratio: flown.ln_pressure_ratio,
            ln_temperature_ratio: flown.ln_temperature_ratio,
            mach: flown.mach,
            lift_coefficient,
            drag_over_thrust: drag_n / net_thrust_n,
            net_thrust_n,
            unit_reynolds_number_per_m: flown.unit_reynolds_number_per_m,
            mass_kg: flown.mass_kg,
        };
        Ok((response, Known { flown, gravity_m_s2, table, tsfc_kg_per_n_s }))
    }

    /// The table's drag coefficient, continued in a straight line beyond the edge where an effect moved the point there.
    fn table_value(
        &self,
        lift_coefficient: f64,
        mach: f64,
        may_leave: bool,
    ) -> Result<f64, EffectError> {
        let grid = self.drag_table.grid();
        let outside = |_| EffectError::OutsideTable { lift_coefficient, mach };
        if !may_leave {
            let cell = grid.locate(lift_coefficient, mach, Outside::Error).map_err(outside)?;
            return Ok(self.drag_table.interpolate(&cell));
        }
        let clamped_lift = lift_coefficient.clamp(grid.x().first(), grid.x().last());
        let clamped_mach = mach.clamp(grid.y().first(), grid.y().last());
        let cell = grid.locate(clamped_lift, clamped_mach, Outside::Hold).map_err(outside)?;
        let (along_lift, along_mach) = self.drag_table.gradient(&cell);
        Ok(self.drag_table.interpolate(&cell)
            + along_lift * (lift_coefficient - clamped_lift)
            + along_mach * (mach - clamped_mach))
    }
}

/// CD0(M) and K(M) of a table.
fn polar_of(drag_table: &Table) -> Result<Surface, FitError> {
    let grid = drag_table.grid();
    let points: Vec<_> = drag_table
        .values()
        .iter()
        .enumerate()
        .map(|(node, &drag_coefficient)| {
            let (lift_coefficient, mach) = grid.coordinates(node);
            (lift_coefficient, mach, drag_coefficient, 1.0)
        })
        .collect();
    Ok(fit(Basis::SeparableQuadratic, &points)?.surface)
}

#[cfg(test)]
mod tests;
