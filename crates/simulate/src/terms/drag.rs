//! The drag coefficient, assembled.

use super::Terms;
use crate::aircraft::{
    AircraftTruth, Airframe, DRAG_COEFFICIENT_PER_COUNT, TruthPhysics, drag_rise_coefficient,
    induced_drag_factor, local_friction_exponent, skin_friction_coefficient, trim_drag_shape,
    zero_lift_drag_coefficient,
};

/// Lift coefficient about which the induced-drag effect bends, and its bend per unit lift coefficient.
const INDUCED_BEND: (f64, f64) = (0.35, 0.3);
/// Width of the bump of drag at one Mach number.
const MACH_BUMP_WIDTH: f64 = 0.015;
/// Range of lift coefficient over which floating spoilers come up.
const SPOILER_RAMP: f64 = 0.05;

/// The variables of the drag coefficient.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DragInputs {
    pub(crate) lift_coefficient: f64,
    pub(crate) mach: f64,
    pub(crate) reynolds_number: f64,
    pub(crate) center_of_gravity_percent_mac: f64,
    pub(crate) roll_deg: f64,
}

/// Terms of the drag coefficient.
#[derive(Clone, Debug)]
pub(crate) struct DragTerms {
    /// Added zero-lift drag coefficient, and the Mach number at which it is stated.
    pub(crate) zero_lift: f64,
    pub(crate) zero_lift_mach: f64,
    /// Factor of the airframe's own zero-lift drag: ageing.
    pub(crate) zero_lift_factor: f64,
    /// Friction terms.
    pub(crate) friction: Vec<FrictionTerm>,
    /// Relative growth of K.
    pub(crate) induced: f64,
    /// Shift of the whole drag rise to lower Mach numbers.
    pub(crate) earlier_by_mach: f64,
    /// Trim drag coefficient per 10 %MAC at lift coefficient 0.4, with its reference, %MAC.
    pub(crate) trim: Vec<(f64, f64)>,
    /// Drag coefficient per squared degree of roll: natural, and of the effect.
    pub(crate) asymmetry: f64,
    pub(crate) asymmetry_effect: f64,
    /// Factor of all drag.
    pub(crate) factor: f64,
    /// Added drag coefficients of forms of their own.
    pub(crate) added: Vec<AddedDrag>,
}

/// An added drag coefficient of a form of its own.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AddedDrag {
    /// Drag coefficient at full size.
    pub(crate) drag_coefficient: f64,
    /// Where it acts, in the variable of the form.
    pub(crate) at: f64,
    /// Share of the full size at a point: of `at` and the point.
    pub(crate) share: fn(f64, &DragInputs) -> f64,
}

/// One friction term: weight of the relative change of the skin friction from a reference, and one over that reference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionTerm {
    weight: f64,
    inverse_reference: f64,
}

impl FrictionTerm {
    /// A share of the zero-lift drag follows the friction law.
    pub(crate) fn share(share: f64, reference_reynolds_number: f64) -> Self {
        Self {
            weight: share,
            inverse_reference: 1.0 / skin_friction_coefficient(reference_reynolds_number),
        }
    }

    /// The friction law, scaled so that it is tangent to the power law Re^−exponent at the reference.
    pub(crate) fn exponent(exponent: f64, reference_reynolds_number: f64) -> Self {
        Self::share(
            exponent / local_friction_exponent(reference_reynolds_number),
            reference_reynolds_number,
        )
    }
}

impl DragTerms {
    pub(super) fn new(aircraft: &AircraftTruth, physics: TruthPhysics) -> Self {
        let airframe = &aircraft.airframe;
        let mut friction = Vec::new();
        if physics.reynolds_number.is_on() {
            friction.push(FrictionTerm::share(
                airframe.friction.share_of_zero_lift,
                airframe.friction.reference_reynolds_number,
            ));
        }
        let mut trim = Vec::new();
        if physics.trim_drag.is_on() {
            trim.push((
                airframe.trim.counts_per_10_percent_mac * DRAG_COEFFICIENT_PER_COUNT,
                airframe.trim.reference_percent_mac,
            ));
        }
        Self {
            zero_lift: 0.0,
            zero_lift_mach: 0.8,
            zero_lift_factor: 1.0,
            friction,
            induced: 0.0,
            earlier_by_mach: 0.0,
            trim,
            asymmetry: physics.asymmetry.factor()
                * airframe.asymmetry_counts_per_deg2
                * DRAG_COEFFICIENT_PER_COUNT,
            asymmetry_effect: 0.0,
            factor: 1.0,
            added: Vec::new(),
        }
    }
}

impl Terms {
    /// Drag coefficient of the trimmed aircraft.
    pub(crate) fn drag_coefficient(&self, airframe: &Airframe, at: &DragInputs) -> f64 {
        let terms = &self.drag;
        let DragInputs { lift_coefficient, mach, reynolds_number, .. } = *at;

        let mut friction = 1.0;
        if !terms.friction.is_empty() {
            let skin_friction = skin_friction_coefficient(reynolds_number);
            for term in &terms.friction {
                friction += term.weight * (skin_friction * term.inverse_reference - 1.0);
            }
        }
        let mut drag = zero_lift_drag_coefficient(&airframe.zero_lift, mach)
            * terms.zero_lift_factor
            * friction;
        drag += induced_drag_factor(&airframe.induced, mach)
            * lift_coefficient
            * lift_coefficient
            * (1.0 + terms.induced * (1.0 + INDUCED_BEND.1 * (lift_coefficient - INDUCED_BEND.0)));
        drag += drag_rise_coefficient(
            &airframe.drag_rise,
            lift_coefficient,
            mach,
            terms.earlier_by_mach,
        );
        for (per_10_percent_mac, reference_percent_mac) in &terms.trim {
            drag += per_10_percent_mac
                * trim_drag_shape(
                    *reference_percent_mac,
                    at.center_of_gravity_percent_mac,
                    lift_coefficient,
                );
        }
        if terms.zero_lift != 0.0 {
            drag += terms.zero_lift * roughness_shape(mach, terms.zero_lift_mach);
        }
        let roll = at.roll_deg.abs();
        drag += (terms.asymmetry + terms.asymmetry_effect * (0.9 + 0.2 * roll)) * roll * roll;
        for term in &terms.added {
            drag += term.drag_coefficient * (term.share)(term.at, at);
        }
        drag * terms.factor
    }
}

/// Bump of drag around one Mach number.
pub(crate) fn mach_bump(center_mach: f64, at: &DragInputs) -> f64 {
    let distance = (at.mach - center_mach) / MACH_BUMP_WIDTH;
    (-distance * distance).exp()
}

/// Spoilers that float up beyond a lift coefficient: a smooth step.
pub(crate) fn floating_spoilers(from_lift_coefficient: f64, at: &DragInputs) -> f64 {
    let up = ((at.lift_coefficient - from_lift_coefficient) / SPOILER_RAMP).clamp(0.0, 1.0);
    up * up * (3.0 - 2.0 * up)
}

/// Roughness drag relative to its value at a reference Mach number: friction falls as the wall warms.
///
/// ```text
/// ((1 + 0.144·M²)/(1 + 0.144·Mref²))^−0.65                          [virtual.12]
/// ```
///
/// # Source
/// Compressibility factor of turbulent friction; Raymer, *Aircraft Design: A Conceptual Approach*, equation (12.27).
fn roughness_shape(mach: f64, reference_mach: f64) -> f64 {
    ((1.0 + 0.144 * mach * mach) / (1.0 + 0.144 * reference_mach * reference_mach)).powf(-0.65)
}
