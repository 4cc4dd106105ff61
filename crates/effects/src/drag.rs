//! Effects on drag, on the weight that lift carries, and on the force along the path.

use atmos::gravity;
use flight::effect::{DragRise, DragRiseLaw, EffectId};
use lut::surface::Surface;
use units::convert::{DAYS_PER_YEAR, RADIANS_PER_DEGREE, SECONDS_PER_DAY, STANDARD_GRAVITY_M_S2};
use units::{Angle, GeometricAltitude};

use crate::point::EffectPoint;
use crate::recorded::AsFlown;
use crate::terms::{Layers, Terms};

/// Factor of Lock's fourth-power drag rise, per Mach⁴.
const LOCK_FACTOR: f64 = 20.0;
/// Distance from the beginning of the rise up to the drag-divergence Mach number (∂CD/∂M = 0.1): (0.1/80)^(1/3).
const LOCK_OFFSET_MACH: f64 = 0.1077;
/// How many times as steep a steep rise is. Our choice: it begins 0.036 below drag divergence, as on supercritical wings.
const STEEPNESS: f64 = 3.0;
/// Fall of the drag-divergence Mach number per unit of lift coefficient: a little less than the 0.1 of Korn's equation without
/// sweep, our choice; and of that equation at 29° of sweep, 0.1/cos³Λ.
const DIVERGENCE_FALL_PER_LIFT_COEFFICIENT: f64 = 0.085;
const DIVERGENCE_FALL_OF_SWEPT_WING: f64 = 0.15;
/// Lift coefficient at which drag-divergence Mach numbers are stated. Our choice: a usual cruise.
const DIVERGENCE_LIFT_COEFFICIENT: f64 = 0.35;
/// Lift coefficient at which trim drag is stated. Our choice: a usual cruise.
const TRIM_LIFT_COEFFICIENT: f64 = 0.4;
/// Roll angle up to which a segment counts as wings level, degrees. Our choice: beyond it an aircraft turns.
const WINGS_LEVEL_DEG: f64 = 5.0;

/// A point of the drag table, where effects change the drag coefficient.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtTable<'p> {
    /// Drag coefficient without effects.
    pub(crate) drag_coefficient: f64,
    /// Lift coefficient.
    pub(crate) lift_coefficient: f64,
    /// CD0(M) and K(M).
    pub(crate) polar: &'p Surface,
}

/// Rise of drag with Mach number.
///
/// ```text
/// w = 20·max(0, M − Mdd(CL) + 0.1077)⁴,   Mdd(CL) = Mdd − 0.085·(CL − 0.35)      [diagnosis.5]
/// ```
///
/// # Source
/// Lock's fourth-power law with the drag-divergence condition ∂CD/∂M = 0.1, from which the offset follows. The fall of
/// the drag-divergence Mach number with lift coefficient is our choice, a little less than the 0.1 of Korn's equation
/// without sweep; the lift coefficient at which it is stated is that of cruise in the middle of the envelope.
#[must_use]
#[inline]
pub fn drag_rise(mach: f64, lift_coefficient: f64, divergence_mach: f64) -> f64 {
    let divergence = divergence_mach
        - DIVERGENCE_FALL_PER_LIFT_COEFFICIENT * (lift_coefficient - DIVERGENCE_LIFT_COEFFICIENT);
    fourth_power_rise(mach - divergence, 1.0)
}

/// A rise that is steeper than Lock's and comes earlier with lift, its divergence the same: ∂CD/∂M = 0.1.
///
/// ```text
/// w = 20 s³·max(0, M − Mdd(CL) + 0.1077/s)⁴,   Mdd(CL) = Mdd − 0.15·(CL − 0.35),   s = 3          [diagnosis.72]
/// ```
///
/// # Source
/// Lock's law with a distance from the beginning of the rise up to divergence that is a third of his; Mason's extension of
/// Korn's equation to swept wings.
#[must_use]
pub fn steep_drag_rise(mach: f64, lift_coefficient: f64, divergence_mach: f64) -> f64 {
    let divergence = divergence_mach
        - DIVERGENCE_FALL_OF_SWEPT_WING * (lift_coefficient - DIVERGENCE_LIFT_COEFFICIENT);
    fourth_power_rise(mach - divergence, STEEPNESS)
}

/// Lock's rise, so many times as steep, at a distance in Mach number from its divergence.
#[inline]
fn fourth_power_rise(from_divergence: f64, steepness: f64) -> f64 {
    let beyond = (from_divergence + LOCK_OFFSET_MACH / steepness).max(0.0);
    LOCK_FACTOR * steepness.powi(3) * beyond.powi(4)
}

/// Years from the reference date to a segment.
pub(crate) fn years_since_reference(point: &EffectPoint, terms: &Terms) -> f64 {
    (terms.date_s(point.date_s) - terms.references.date_s) / (DAYS_PER_YEAR * SECONDS_PER_DAY)
}

/// Weight over mass that lift carries.
///
/// ```text
/// g = (g0 + θg·(g(φ, h) − g0) − θr·(2Ω V_east cos φ + V²/R))·(1 + θn·(1/cos ϕ − 1))   [diagnosis.6]
/// ```
///
/// Pressure altitude is used as the height (1 km of difference is 0.03 % of gravity). Track is heading plus drift;
/// heading where drift is not recorded. ϕ is the root of the mean squared roll angle.
pub(crate) fn apparent_gravity_m_s2(point: &EffectPoint, layers: Layers<'_>) -> f64 {
    let mut gravity_m_s2 = STANDARD_GRAVITY_M_S2;
    let local_gravity = layers.sum(|terms| terms.size(EffectId::LocalGravity));
    let rotating_earth = layers.sum(|terms| terms.size(EffectId::RotatingEarth));
    if let Some(latitude_deg) = point.latitude_deg {
        let latitude = Angle::degrees(latitude_deg);
        let height = GeometricAltitude::meters(point.pressure_altitude_m);
        if local_gravity != 0.0 {
            let local = gravity::gravity(latitude, height).to_meters_per_second_squared();
            gravity_m_s2 += local_gravity * (local - STANDARD_GRAVITY_M_S2);
        }
        if rotating_earth != 0.0
            && let Some(heading_deg) = point.true_heading_deg
        {
            let track = (heading_deg + point.drift_deg.unwrap_or(0.0)) * RADIANS_PER_DEGREE;
            let lighter = gravity::earth_motion_acceleration(
                latitude,
                point.ground_speed_m_s * track.sin(),
                point.ground_speed_m_s * track.cos(),
                height,
            );
            gravity_m_s2 -= rotating_earth * lighter.to_meters_per_second_squared();
        }
    }
    let load_factor = layers.sum(|terms| terms.size(EffectId::LoadFactor));
    if load_factor != 0.0
        && let Some(roll_squared_deg2) = point.roll_squared_deg2
    {
        let roll = roll_squared_deg2.max(0.0).sqrt() * RADIANS_PER_DEGREE;
        gravity_m_s2 *= 1.0 + load_factor * (1.0 / roll.cos() - 1.0);
    }
    gravity_m_s2
}

/// Force along the path beyond drag: inertia, and the climb along a sloping pressure surface.
///
/// ```text
/// m·V̇G + θ·m·f·V_cross,  f = 2Ω sin φ,  V_cross = −GS·sin(drift)                 [diagnosis.7]
/// ```
///
/// `V_cross` is the wind from the right across the nose, positive when it blows to the left: in the northern hemisphere high
/// pressure is then ahead and a surface of constant pressure climbs. The ground speed has no other component across the nose. In geostrophic flow the Coriolis force on the cross-wind balances
/// this exactly.
pub(crate) fn path_force_n(point: &EffectPoint, flown: &AsFlown, layers: Layers<'_>) -> f64 {
    let mut force_n = flown.mass_kg * point.acceleration_m_s2;
    let isobaric_slope = layers.sum(|terms| terms.size(EffectId::IsobaricSlope));
    if isobaric_slope != 0.0
        && let (Some(latitude_deg), Some(drift_deg)) = (point.latitude_deg, point.drift_deg)
    {
        let coriolis = gravity::coriolis_parameter(Angle::degrees(latitude_deg));
        let cross_m_s = -point.ground_speed_m_s * (drift_deg * RADIANS_PER_DEGREE).sin();
        force_n += isobaric_slope * flown.mass_kg * coriolis * cross_m_s;
    }
    force_n
}

/// The drag coefficient with effects.
///
/// ```text
/// CD = (CD_table + θ0·1e-4 + θi K(M) CL² + w(Mdd − θw) − w(Mdd) + CD0(M)·((Re/Re_ref)^−θR − 1 + θa t + θh h(t))
///       + θc·1e-4·(CG_ref − CG)/10·CL/0.4 + θϕ·1e-4·ϕ²)·(1 + θD)·(1 + θs from the date on)   [diagnosis.8]
/// ```
///
/// Layer by layer: the effects that the model contains come first, and their result replaces the table for the layers
/// above.
pub(crate) fn drag_coefficient(
    at: AtTable<'_>,
    point: &EffectPoint,
    flown: &AsFlown,
    layers: Layers<'_>,
) -> f64 {
    let drag = layers.iter().fold(at, |below, terms| AtTable {
        drag_coefficient: drag_with_layer(below, point, flown, terms),
        ..below
    });
    drag.drag_coefficient
}

fn drag_with_layer(below: AtTable<'_>, point: &EffectPoint, flown: &AsFlown, terms: &Terms) -> f64 {
    let AtTable { drag_coefficient, lift_coefficient, polar } = below;
    let references = &terms.references;
    let mach = flown.mach;
    let mut drag = drag_coefficient + terms.size(EffectId::ZeroLiftDrag);
    if terms.size(EffectId::InducedDrag) != 0.0 {
        let [_, _, _, k0, k1, k2] = polar.coefficients;
        let factor = k0 + k1 * mach + k2 * mach * mach;
        drag += terms.size(EffectId::InducedDrag) * factor * lift_coefficient * lift_coefficient;
    }
    if terms.size(EffectId::WaveDrag) != 0.0 {
        let DragRise { divergence_mach, law } = terms.drag_rise;
        let rise = match law {
            DragRiseLaw::Lock => drag_rise,
            DragRiseLaw::Steep => steep_drag_rise,
        };
        drag += rise(mach, lift_coefficient, divergence_mach - terms.size(EffectId::WaveDrag))
            - rise(mach, lift_coefficient, divergence_mach);
    }
    if terms.size(EffectId::AirframeHistory) != 0.0 {
        let years = terms.airframe_history.years(terms.date_s(point.date_s));
        drag += polar.value(0.0, mach) * terms.size(EffectId::AirframeHistory) * years;
    }
    if terms.size(EffectId::ReynoldsNumber) != 0.0 || terms.size(EffectId::AirframeAgeing) != 0.0 {
        let zero_lift = polar.value(0.0, mach);
        let ratio = flown.unit_reynolds_number_per_m / references.unit_reynolds_number_per_m;
        drag += zero_lift
            * (ratio.powf(-terms.size(EffectId::ReynoldsNumber)) - 1.0
                + terms.size(EffectId::AirframeAgeing) * years_since_reference(point, terms));
    }
    if terms.size(EffectId::TrimDragCg) != 0.0
        && let (Some(center), Some(reference)) =
            (point.center_of_gravity_percent_mac, references.center_of_gravity_percent_mac)
    {
        drag += terms.size(EffectId::TrimDragCg) * (reference - center) / 10.0 * lift_coefficient
            / TRIM_LIFT_COEFFICIENT;
    }
    if terms.size(EffectId::AsymmetryDrag) != 0.0
        && let Some(roll_squared_deg2) = point.roll_squared_deg2
        && roll_squared_deg2 < WINGS_LEVEL_DEG * WINGS_LEVEL_DEG
    {
        drag += terms.size(EffectId::AsymmetryDrag) * roll_squared_deg2;
    }
    drag *= 1.0 + terms.size(EffectId::DragFactor);
    if terms.step_drag != 0.0 && terms.date_s(point.date_s) >= terms.step_from_s {
        drag *= 1.0 + terms.step_drag;
    }
    drag
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Drag divergence by its definition, and Korn's equation as Mason extended it to swept wings: 0.1/cos³ 29° = 0.1495.
    #[test]
    fn both_rises_diverge_where_they_say() {
        for (rise, fall_per_lift_coefficient) in
            [(drag_rise as fn(f64, f64, f64) -> f64, 0.085), (steep_drag_rise, 0.15)]
        {
            for lift in [0.2, 0.35, 0.6] {
                let divergence = 0.83 - fall_per_lift_coefficient * (lift - 0.35);
                let slope = (rise(divergence + 1e-5, lift, 0.83)
                    - rise(divergence - 1e-5, lift, 0.83))
                    / 2e-5;
                assert!((slope - 0.1).abs() < 2e-4, "{lift}: {slope}");
            }
        }
        let swept = 0.1 / (29.0 * RADIANS_PER_DEGREE).cos().powi(3);
        assert!((swept - DIVERGENCE_FALL_OF_SWEPT_WING).abs() < 1e-3);
        // It begins 0.0359 below, Lock's 0.1077.
        assert!(steep_drag_rise(0.7941, 0.35, 0.83) > 0.0);
        assert!(steep_drag_rise(0.7940, 0.35, 0.83).abs() < 1e-15);
    }
}
