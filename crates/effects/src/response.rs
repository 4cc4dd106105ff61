//! From a recorded point and the effects that act there to the recorded quantities: one path for all effects.

use flight::MAXIMUM_ENGINES;
use lut::surface::Surface;
use lut::{Axis, Outside, SmoothTable, Table};
use perf_model::tsfc::tsfc;
use perf_model::{Aircraft, GuideLevels, GuidePlace};
use units::{Mach, PressureAltitude};

use crate::drag::{self, AtTable};
use crate::engine::{self, Thrust};
use crate::error::EffectError;
use crate::form::Change;
use crate::point::EffectPoint;
use crate::recorded::{self, AsFlown};
use crate::terms::Layers;
use crate::variable::Aloft;

/// The prediction for one segment, with everything that the residual channels need.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Natural logarithm of the fuel flow of all engines that would be recorded, kg/s.
    pub ln_fuel_flow_total: f64,
    /// The same for each engine; equal thrust is assumed. −∞ beyond the aircraft's engines.
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
    /// Ratio of drag to net thrust: the share of a change of drag that appears in fuel flow.
    pub drag_over_thrust: f64,
    /// Net thrust of all engines, N.
    pub net_thrust_n: f64,
    /// Reynolds number over one meter.
    pub unit_reynolds_number_per_m: f64,
    /// Gross mass as it truly was, kg.
    pub mass_kg: f64,
}

/// A model without any effect: what effects act upon.
#[derive(Clone, Debug)]
pub(crate) struct Bare<'a> {
    pub(crate) aircraft: &'a Aircraft,
    pub(crate) drag_table: &'a Table,
    /// CD0(M) and K(M), of which some effects are a share.
    pub(crate) polar: Surface,
    /// By how much drag differs by level from the table.
    pub(crate) levels: Option<&'a GuideLevels>,
    /// The surface between the table's nodes, where that is smooth.
    pub(crate) smooth: Option<SmoothTable>,
}

impl Bare<'_> {
    /// Of the table, times the factor by level.
    fn drag_coefficient(&self, place: GuidePlace, edge: Edge) -> Result<f64, EffectError> {
        let surface = (self.drag_table, self.smooth.as_ref());
        let of_table = table_value(surface, place.lift_coefficient, place.mach, edge)?;
        Ok(self.levels.map_or(of_table, |levels| of_table * levels.factor(place)))
    }
}

/// What a drag table is between its nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BetweenNodes {
    /// Bilinear: as every table of this program is read.
    #[default]
    Straight,
    /// The smooth surface through the nodes ([`SmoothTable`]): a polynomial of the second degree that a table was made of comes
    /// back exactly, whatever the grid.
    Smooth,
}

/// The cached quantities of a point without trial effects.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    flown: AsFlown,
    gravity_m_s2: f64,
    /// `None` where the point lies elsewhere in the table.
    table: Option<f64>,
    tsfc_kg_per_n_s: f64,
}

impl Known {
    /// The same of an aircraft of another mass.
    pub(crate) const fn with_mass_kg(mut self, mass_kg: f64) -> Self {
        self.flown.mass_kg = mass_kg;
        self.table = None;
        self
    }
}

/// The rule beyond the edge of the drag table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edge {
    /// No value: the point was recorded there.
    Refuse,
    /// The table is continued in a straight line: an effect, or a derivative's step, moved the point there.
    Continue,
}

impl Edge {
    /// The rule for a recorded point with these effects.
    pub(crate) fn under(layers: Layers<'_>) -> Self {
        if layers.moves_the_point() { Self::Continue } else { Self::Refuse }
    }
}

/// The recorded quantities at a point. Cached quantities without trial effects are not computed again.
pub(crate) fn evaluate(
    bare: &Bare<'_>,
    point: &EffectPoint,
    layers: Layers<'_>,
    edge: Edge,
    known: Option<&Known>,
) -> Result<(Response, Known), EffectError> {
    let uncorrected = known.filter(|_| !layers.trial.corrects_recordings());
    let (flown, tsfc_kg_per_n_s) = if let Some(known) = uncorrected {
        (known.flown, known.tsfc_kg_per_n_s)
    } else {
        let flown = recorded::as_flown(point, layers.trial)?;
        let law = tsfc(bare.aircraft.tsfc_law(), flown.temperature_ratio, Mach::new(flown.mach));
        (flown, law.to_kilograms_per_newton_second())
    };
    let gravity_m_s2 = match known {
        Some(known) if !layers.trial.changes_weight() => known.gravity_m_s2,
        _ => drag::apparent_gravity_m_s2(point, layers),
    };
    let surface_n = flown.dynamic_pressure_pa * bare.aircraft.wing_area().to_square_meters();
    let lift_coefficient = flown.mass_kg * gravity_m_s2 / surface_n;
    let cached = uncorrected.filter(|_| !layers.trial.moves_the_point());
    let place = GuidePlace {
        lift_coefficient,
        mach: flown.mach,
        pressure_altitude: PressureAltitude::meters(point.pressure_altitude_m),
    };
    let cached = cached.and_then(|known| known.table);
    let table = cached.map_or_else(|| bare.drag_coefficient(place, edge), Ok)?;
    let at = AtTable { drag_coefficient: table, lift_coefficient, polar: &bare.polar };
    let of_effects = drag::drag_coefficient(at, point, &flown, layers);
    let path_force_n = drag::path_force_n(point, &flown, layers);
    let outside = if layers.has_forms() {
        let before = Thrusts { surface_n, drag_coefficient: of_effects, path_force_n };
        of_forms(point, &flown, lift_coefficient, before, layers)?
    } else {
        Change::default()
    };
    let drag_n = surface_n * (of_effects + outside.drag_coefficient);
    let net_thrust_n = drag_n + path_force_n;
    // Written so that NaN is refused too.
    if net_thrust_n.is_nan() || net_thrust_n <= 0.0 {
        return Err(EffectError::ThrustNotPositive { net_thrust_n });
    }
    let corrected_thrust_n = net_thrust_n / flown.pressure_ratio;
    let thrust = Thrust {
        net_thrust_n,
        corrected_thrust_n,
        tsfc_kg_per_n_s,
        engines: bare.aircraft.engines(),
    };
    let (total_kg_s, engines_kg_s) = engine::recorded_fuel_flow(&thrust, point, &flown, layers);
    let by_outside = outside.ln_fuel_flow;
    let mut ln_fuel_flow_engine = [f64::NEG_INFINITY; MAXIMUM_ENGINES];
    let mut before = (f64::NAN, f64::NAN);
    for (ln, flow_kg_s) in
        ln_fuel_flow_engine.iter_mut().zip(engines_kg_s).take(bare.aircraft.engines())
    {
        // Engines that burn alike have one logarithm, which is most of what a response costs.
        if flow_kg_s.to_bits() != before.0.to_bits() {
            before = (flow_kg_s, flow_kg_s.ln() + by_outside);
        }
        *ln = before.1;
    }
    let response = Response {
        ln_fuel_flow_total: total_kg_s.ln() + by_outside,
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
    Ok((response, Known { flown, gravity_m_s2, table: Some(table), tsfc_kg_per_n_s }))
}

/// Drag and path force before any form.
#[derive(Clone, Copy, Debug)]
struct Thrusts {
    surface_n: f64,
    drag_coefficient: f64,
    path_force_n: f64,
}

/// What forms outside the library change at the flown state, layer by layer: the thrust that a form is over has the forms of the
/// layers before it, as it had when the flights showed it.
fn of_forms(
    point: &EffectPoint,
    flown: &AsFlown,
    lift_coefficient: f64,
    before: Thrusts,
    layers: Layers<'_>,
) -> Result<Change, EffectError> {
    let flown_point = flown.point(point, layers.trial)?;
    let mut change = Change::default();
    for terms in layers.iter().filter(|terms| !terms.forms.is_empty()) {
        let drag_coefficient = before.drag_coefficient + change.drag_coefficient;
        let thrust_n = before.surface_n * drag_coefficient + before.path_force_n;
        let ln_corrected_thrust = (thrust_n / flown.pressure_ratio).ln();
        change =
            change.with_layer(terms, &flown_point, Aloft { lift_coefficient, ln_corrected_thrust });
    }
    if change.is_finite() { Ok(change) } else { Err(EffectError::FormUndefined) }
}

/// A table's drag coefficient, on the smooth surface through its nodes where that is given, continued in a straight line beyond its
/// edge; `None` where a coordinate is no number.
#[must_use]
pub fn value_continued(
    surface: (&Table, Option<&SmoothTable>),
    lift_coefficient: f64,
    mach: f64,
) -> Option<f64> {
    table_value(surface, lift_coefficient, mach, Edge::Continue).ok()
}

/// The table's drag coefficient, continued in a straight line beyond the edge where an effect moved the point there.
fn table_value(
    (drag_table, smooth): (&Table, Option<&SmoothTable>),
    lift_coefficient: f64,
    mach: f64,
    edge: Edge,
) -> Result<f64, EffectError> {
    let grid = drag_table.grid();
    let outside = |_| EffectError::OutsideTable { lift_coefficient, mach };
    let value = |lift_coefficient: f64, mach: f64| {
        let cell = grid.locate(lift_coefficient, mach, Outside::Error)?;
        Ok(smooth.map_or_else(|| drag_table.interpolate(&cell), |smooth| smooth.value(&cell)))
    };
    let held = |value: f64, axis: &Axis| value.clamp(axis.first(), axis.last());
    let (held_lift, held_mach) = (held(lift_coefficient, grid.x()), held(mach, grid.y()));
    let (beyond_lift, beyond_mach) = (lift_coefficient - held_lift, mach - held_mach);
    if edge == Edge::Refuse || (beyond_lift == 0.0 && beyond_mach == 0.0) {
        return value(lift_coefficient, mach).map_err(outside);
    }
    let cell = grid.locate(held_lift, held_mach, Outside::Hold).map_err(outside)?;
    let (along_lift, along_mach) = drag_table.gradient(&cell);
    let inside = value(held_lift, held_mach).map_err(outside)?;
    Ok(inside + along_lift * beyond_lift + along_mach * beyond_mach)
}
