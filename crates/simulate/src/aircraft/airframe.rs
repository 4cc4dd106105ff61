//! The airframe's drag, term by term. It is assembled in `drag.rs`; here is one function per term.

use serde::{Deserialize, Serialize};

/// Drag counts per unit of drag coefficient.
pub(crate) const DRAG_COEFFICIENT_PER_COUNT: f64 = 1e-4;

/// The airframe's constants. Read from a preset, where every number has its source next to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Airframe {
    /// Reference area of the lift and drag coefficients, m².
    pub wing_area_m2: f64,
    /// Mean aerodynamic chord: reference length of the Reynolds number and unit of the center of gravity, m.
    pub mean_aerodynamic_chord_m: f64,
    /// Slope of the lift curve in cruise, 1/rad: the lift of a vertical gust.
    pub lift_curve_slope_per_rad: f64,
    /// Drag at zero lift.
    pub zero_lift: ZeroLiftDrag,
    /// Drag due to lift.
    pub induced: InducedDrag,
    /// Drag rise with Mach number.
    pub drag_rise: DragRise,
    /// Skin friction's share and reference, for the Reynolds number.
    pub friction: Friction,
    /// Trim drag with the center of gravity.
    pub trim: TrimDrag,
    /// Drag of holding a wing low, counts/deg² of roll.
    pub asymmetry_counts_per_deg2: f64,
}

/// Drag coefficient at zero lift, with the creep of a subsonic body towards its drag rise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ZeroLiftDrag {
    /// Below the creep.
    pub coefficient: f64,
    /// Relative growth per unit Mach number above `mach_from`.
    pub creep_per_mach: f64,
    /// Where the creep begins.
    pub mach_from: f64,
}

/// Induced drag factor K of K·CL², with its growth towards the drag rise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InducedDrag {
    /// K at low Mach number.
    pub factor: f64,
    /// Relative growth per Mach number squared above `mach_from`.
    pub growth_per_mach2: f64,
    /// Where the growth begins.
    pub mach_from: f64,
}

/// Compressibility drag: a quartic above a critical Mach number that falls with lift.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DragRise {
    /// Factor of the fourth power.
    pub quartic: f64,
    /// Drag-divergence Mach number at `at_lift_coefficient`.
    pub divergence_mach: f64,
    /// Lift coefficient of `divergence_mach`.
    pub at_lift_coefficient: f64,
    /// How much the divergence Mach number falls per unit of lift coefficient.
    pub fall_per_lift_coefficient: f64,
    /// Distance of the critical below the divergence Mach number.
    pub critical_below_divergence: f64,
}

/// Skin friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Share of the zero-lift drag that depends on friction.
    pub share_of_zero_lift: f64,
    /// Reynolds number over the mean aerodynamic chord at which the zero-lift drag was stated.
    pub reference_reynolds_number: f64,
}

/// Trim drag.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrimDrag {
    /// Counts per 10 %MAC of forward shift, at lift coefficient 0.4.
    pub counts_per_10_percent_mac: f64,
    /// Center of gravity at which the drag was stated, %MAC.
    pub reference_percent_mac: f64,
}

/// Drag coefficient at zero lift.
///
/// ```text
/// CD0 = c·(1 + k·max(0, M − M1))                                    [virtual.1]
/// ```
pub(crate) fn zero_lift_drag_coefficient(of: &ZeroLiftDrag, mach: f64) -> f64 {
    of.coefficient * (1.0 + of.creep_per_mach * (mach - of.mach_from).max(0.0))
}

/// Induced drag factor.
///
/// ```text
/// K = K1·(1 + g·max(0, M − M1)²)                                    [virtual.2]
/// ```
pub(crate) fn induced_drag_factor(of: &InducedDrag, mach: f64) -> f64 {
    let above = (mach - of.mach_from).max(0.0);
    of.factor * (1.0 + of.growth_per_mach2 * above * above)
}

/// Compressibility drag coefficient, with the whole rise moved `earlier_by_mach` down in Mach number.
///
/// ```text
/// CDw = w·max(0, M − Mcr)⁴,  Mcr = Mdd − a·(CL − CLref) − b         [virtual.3]
/// ```
///
/// # Source
/// Lock's fourth-power law; Mason, *Configuration Aerodynamics*, section 7.
pub(crate) fn drag_rise_coefficient(
    of: &DragRise,
    lift_coefficient: f64,
    mach: f64,
    earlier_by_mach: f64,
) -> f64 {
    let critical_mach = of.divergence_mach
        - of.fall_per_lift_coefficient * (lift_coefficient - of.at_lift_coefficient)
        - of.critical_below_divergence;
    let above = (mach + earlier_by_mach - critical_mach).max(0.0);
    let squared = above * above;
    of.quartic * squared * squared
}

/// Skin-friction coefficient of a turbulent flat plate.
///
/// ```text
/// cf = 0.455/(log10 Re)^2.58                                        [virtual.4]
/// ```
///
/// Valid for 1e6 < Re < 1e9; arguments that are not positive give NaN.
///
/// # Source
/// Prandtl and Schlichting; Schlichting, *Boundary-Layer Theory*, 7th edition, equation (21.16).
pub(crate) fn skin_friction_coefficient(reynolds_number: f64) -> f64 {
    0.455 / reynolds_number.log10().powf(2.58)
}

/// Exponent of the power law that is tangent to the friction law at a Reynolds number: −d ln cf/d ln Re = 2.58/ln Re.
pub(crate) fn local_friction_exponent(reynolds_number: f64) -> f64 {
    2.58 / reynolds_number.ln()
}

/// Trim drag in counts per unit of `counts_per_10_percent_mac`: with a center of gravity forward of the reference the
/// tail pushes down, and the wing carries more; the download's own drag makes the curve bend upwards.
///
/// ```text
/// x = (CGref − CG)/10 %MAC;  n = (x + 0.15·x·|x|)·CL/0.4            [virtual.5]
/// ```
///
/// The bend is 0.15 of the slope at 10 %MAC, our choice.
pub(crate) fn trim_drag_shape(
    reference_percent_mac: f64,
    center_of_gravity_percent_mac: f64,
    lift_coefficient: f64,
) -> f64 {
    let forward = (reference_percent_mac - center_of_gravity_percent_mac) / 10.0;
    (forward + 0.15 * forward * forward.abs()) * lift_coefficient / 0.4
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn friction_law_of_the_textbook() {
        // Schlichting, Boundary-Layer Theory, figure 21.2 and its table: 0.00447 at 1e6, 0.00300 at 1e7, 0.00213 at 1e8.
        for (reynolds_number, expected) in [(1e6, 0.00447), (1e7, 0.00300), (1e8, 0.00213)] {
            let found = skin_friction_coefficient(reynolds_number);
            assert!((found - expected).abs() < 6e-6, "{reynolds_number}: {found}");
        }
    }

    #[test]
    fn power_law_touches_the_log_law() {
        let reynolds_number = 1.3e7;
        let ratio = skin_friction_coefficient(reynolds_number * 1.001)
            / skin_friction_coefficient(reynolds_number);
        let power = 1.001_f64.powf(-local_friction_exponent(reynolds_number));
        assert!((ratio - power).abs() < 1e-7, "{ratio} {power}");
    }

    #[test]
    fn trim_drag_rises_forward_and_falls_aft() {
        // Hand: 10 %MAC forward at CL 0.4 is 1 + 0.15; aft it is −1 − 0.15; half the lift, half of it.
        assert!((trim_drag_shape(25.0, 15.0, 0.4) - 1.15).abs() < 1e-12);
        assert!((trim_drag_shape(25.0, 35.0, 0.4) + 1.15).abs() < 1e-12);
        assert!((trim_drag_shape(25.0, 15.0, 0.2) - 0.575).abs() < 1e-12);
    }
}
