//! The virtual aircraft: its truth, which is richer than any model that is fitted to it.

mod airframe;
mod engine;

use serde::{Deserialize, Serialize};
use units::{Force, Mach, OutOfDomain, Temperature, Tsfc, check_within};

pub use airframe::{Airframe, DragRise, Friction, InducedDrag, TrimDrag, ZeroLiftDrag};
pub(crate) use airframe::{
    DRAG_COEFFICIENT_PER_COUNT, drag_rise_coefficient, induced_drag_factor,
    local_friction_exponent, skin_friction_coefficient, trim_drag_shape,
    zero_lift_drag_coefficient,
};
pub use engine::{Engine, PartLoad, RotorDeck, ThrustLapse, TsfcLaw};
pub(crate) use engine::{
    exhaust_gas_temperature_k, maximum_thrust_n, n1_percent, n2_percent, part_load_factor,
    tsfc_kg_n_s,
};

use crate::terms::{DragInputs, Terms};

/// Total over static temperature minus one, per squared Mach number: (γ − 1)/2.
pub(crate) const HEATING_FACTOR: f64 = (atmos::constants::RATIO_OF_SPECIFIC_HEATS - 1.0) / 2.0;

/// An aircraft type as it truly is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AircraftTruth {
    /// Name for display.
    pub name: String,
    /// Type code, as `AIRCRAFT` in reports.
    pub type_code: String,
    /// Drag and lift.
    pub airframe: Airframe,
    /// Engines.
    pub engine: Engine,
    /// Mass limits.
    pub masses: MassLimits,
    /// Speed and altitude limits.
    pub envelope: Envelope,
    /// Fuel from engine start to top of climb, relative to what the energy gained would need at cruise efficiency.
    pub climb_fuel_factor: f64,
}

/// Masses between which a flight must stay, kg.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MassLimits {
    /// Operating empty.
    pub operating_empty_kg: f64,
    /// Maximum zero-fuel.
    pub maximum_zero_fuel_kg: f64,
    /// Maximum take-off.
    pub maximum_take_off_kg: f64,
    /// Maximum fuel.
    pub maximum_fuel_kg: f64,
}

/// Flight envelope in cruise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Envelope {
    /// MMO.
    pub maximum_operating_mach: f64,
    /// VMO, kt of calibrated airspeed.
    pub maximum_operating_calibrated_airspeed_kt: f64,
    /// Highest pressure altitude, ft.
    pub ceiling_ft: f64,
    /// Largest lift coefficient in level flight.
    pub maximum_lift_coefficient: f64,
}

/// The built-in aircraft types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Preset {
    /// Cessna Citation X, a reconstruction.
    CitationX,
    /// A narrow-body like the Airbus A320.
    A320,
    /// A regional jet like the Embraer 175.
    RegionalJet,
}

/// Off or on: one word for every switch of a plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Switch {
    /// Off.
    #[default]
    Off,
    /// On.
    On,
}

impl Switch {
    pub(crate) const fn is_on(self) -> bool {
        matches!(self, Self::On)
    }

    /// 1 when on, else 0.
    pub(crate) const fn factor(self) -> f64 {
        if self.is_on() { 1.0 } else { 0.0 }
    }
}

/// The truth's physics beyond CD(CL, M) and TSFC0·√θ·(1 + M)^n. With all off, a performance model of that form can be
/// exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TruthPhysics {
    /// Zero-lift drag depends on the Reynolds number by the Prandtl–Schlichting law.
    pub reynolds_number: Switch,
    /// Trim drag with the center of gravity.
    pub trim_drag: Switch,
    /// Drag of holding a wing low.
    pub asymmetry: Switch,
    /// TSFC depends on part load.
    pub part_load: Switch,
    /// TSFC has another exponent of temperature than one half.
    pub temperature_exponent: Switch,
    /// Fuel for bleed and shaft power.
    pub offtake: Switch,
}

impl TruthPhysics {
    /// Only the model's own equations.
    #[must_use]
    pub const fn plain() -> Self {
        Self::all(Switch::Off)
    }

    /// Everything.
    #[must_use]
    pub const fn full() -> Self {
        Self::all(Switch::On)
    }

    const fn all(switch: Switch) -> Self {
        Self {
            reynolds_number: switch,
            trim_drag: switch,
            asymmetry: switch,
            part_load: switch,
            temperature_exponent: switch,
            offtake: switch,
        }
    }
}

/// What drag depends on in addition to lift coefficient and Mach number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragConditions {
    /// Reynolds number over the mean aerodynamic chord.
    pub reynolds_number: f64,
    /// Center of gravity, %MAC.
    pub center_of_gravity_percent_mac: f64,
    /// Roll angle held in straight flight, degrees.
    pub roll_deg: f64,
}

/// Why an aircraft cannot be flown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AircraftError {
    /// The text is not RON of this shape.
    #[error("aircraft file: {0}")]
    Format(#[from] ron::error::SpannedError),
    /// A number outside reasonable limits.
    #[error("aircraft file: {0}")]
    Value(#[from] OutOfDomain),
}

impl AircraftTruth {
    /// One of the built-in types.
    ///
    /// # Errors
    /// None in practice: every preset is parsed in a test.
    pub fn preset(preset: Preset) -> Result<Self, AircraftError> {
        Self::from_ron(match preset {
            Preset::CitationX => include_str!("../presets/citation_x.ron"),
            Preset::A320 => include_str!("../presets/a320.ron"),
            Preset::RegionalJet => include_str!("../presets/regional_jet.ron"),
        })
    }

    /// From the text of an aircraft file.
    ///
    /// # Errors
    /// [`AircraftError`] for text of another shape or numbers that do not make an aircraft.
    pub fn from_ron(text: &str) -> Result<Self, AircraftError> {
        let aircraft: Self = ron::from_str(text)?;
        aircraft.check()?;
        Ok(aircraft)
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`OutOfDomain`] for the first number out of its limits.
    pub fn check(&self) -> Result<(), OutOfDomain> {
        let airframe = &self.airframe;
        let engine = &self.engine;
        let checks = [
            ("wing area", "m²", airframe.wing_area_m2, 5.0, 1000.0),
            ("mean aerodynamic chord", "m", airframe.mean_aerodynamic_chord_m, 0.5, 20.0),
            ("lift curve slope", "1/rad", airframe.lift_curve_slope_per_rad, 2.0, 10.0),
            ("zero-lift drag coefficient", "-", airframe.zero_lift.coefficient, 0.005, 0.1),
            ("induced drag factor", "-", airframe.induced.factor, 0.01, 0.2),
            ("drag-divergence Mach number", "-", airframe.drag_rise.divergence_mach, 0.5, 1.0),
            ("friction share", "-", airframe.friction.share_of_zero_lift, 0.0, 1.0),
            (
                "reference Reynolds number",
                "-",
                airframe.friction.reference_reynolds_number,
                1e6,
                1e9,
            ),
            ("trim reference", "%MAC", airframe.trim.reference_percent_mac, -50.0, 150.0),
            ("number of engines", "-", f64::from(engine.count), 1.0, 4.0),
            ("rated thrust", "N", engine.rated_thrust_n, 1e3, 1e6),
            ("loss of thrust per root Mach number", "-", engine.lapse.per_sqrt_mach, 0.0, 0.9),
            ("static TSFC", "kg/(N s)", engine.tsfc.static_kg_n_s, 3e-6, 5e-5),
            ("Mach exponent of TSFC", "-", engine.tsfc.mach_exponent, -1.0, 3.0),
            ("best part load", "-", engine.part_load.best, 0.1, 1.5),
            ("offtake fuel flow", "kg/s", engine.offtake_fuel_flow_kg_s, 0.0, 1.0),
            (
                "reference heating value",
                "MJ/kg",
                engine.reference_lower_heating_value_mj_kg,
                35.0,
                130.0,
            ),
            ("operating empty mass", "kg", self.masses.operating_empty_kg, 500.0, 5e5),
            (
                "maximum zero-fuel mass",
                "kg",
                self.masses.maximum_zero_fuel_kg,
                self.masses.operating_empty_kg,
                6e5,
            ),
            (
                "maximum take-off mass",
                "kg",
                self.masses.maximum_take_off_kg,
                self.masses.operating_empty_kg,
                7e5,
            ),
            ("maximum fuel", "kg", self.masses.maximum_fuel_kg, 50.0, 3e5),
            ("maximum operating Mach number", "-", self.envelope.maximum_operating_mach, 0.3, 0.98),
            ("ceiling", "ft", self.envelope.ceiling_ft, 5_000.0, 60_000.0),
            ("maximum lift coefficient", "-", self.envelope.maximum_lift_coefficient, 0.3, 2.0),
            ("climb fuel factor", "-", self.climb_fuel_factor, 0.5, 5.0),
        ];
        for (quantity, unit, value, minimum, maximum) in checks {
            check_within(quantity, unit, value, minimum, maximum)?;
        }
        Ok(())
    }

    /// Number of engines.
    #[must_use]
    pub fn engines(&self) -> usize {
        usize::from(self.engine.count)
    }

    /// The conditions at which the drag was stated: reference Reynolds number and center of gravity, wings level.
    #[must_use]
    pub const fn reference_conditions(&self) -> DragConditions {
        DragConditions {
            reynolds_number: self.airframe.friction.reference_reynolds_number,
            center_of_gravity_percent_mac: self.airframe.trim.reference_percent_mac,
            roll_deg: 0.0,
        }
    }

    /// Drag coefficient of the trimmed aircraft, without effects.
    #[must_use]
    pub fn drag_coefficient(
        &self,
        lift_coefficient: f64,
        mach: Mach,
        at: &DragConditions,
        physics: TruthPhysics,
    ) -> f64 {
        Terms::new(self, physics).drag_coefficient(
            &self.airframe,
            &DragInputs {
                lift_coefficient,
                mach: mach.value(),
                reynolds_number: at.reynolds_number,
                center_of_gravity_percent_mac: at.center_of_gravity_percent_mac,
                roll_deg: at.roll_deg,
            },
        )
    }

    /// TSFC without offtake at a corrected thrust F/δ of all engines together, without effects.
    #[must_use]
    pub fn tsfc(
        &self,
        mach: Mach,
        sat: Temperature,
        corrected_thrust: Force,
        physics: TruthPhysics,
    ) -> Tsfc {
        let mach = mach.value();
        let temperature_ratio = atmos::isa::temperature_ratio(sat);
        let heating = 1.0 + HEATING_FACTOR * mach * mach;
        // Both thrusts over δ: the static pressure cancels in the part load.
        let maximum_n = f64::from(self.engine.count)
            * maximum_thrust_n(
                &self.engine,
                mach,
                temperature_ratio * heating,
                pressure_rise(heating),
            );
        let load = corrected_thrust.to_newtons() / maximum_n;
        let mut tsfc = tsfc_kg_n_s(&self.engine.tsfc, mach, temperature_ratio);
        if physics.temperature_exponent.is_on() {
            tsfc *= temperature_ratio.powf(self.engine.extra_temperature_exponent);
        }
        if physics.part_load.is_on() {
            tsfc *= part_load_factor(&self.engine.part_load, load);
        }
        Tsfc::kilograms_per_newton_second(tsfc)
    }
}

/// Total over static pressure from total over static temperature, t^3.5.
pub(crate) fn pressure_rise(heating: f64) -> f64 {
    heating * heating * heating * heating.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_parse_and_every_number_has_its_source() {
        for (preset, text) in [
            (Preset::CitationX, include_str!("../presets/citation_x.ron")),
            (Preset::A320, include_str!("../presets/a320.ron")),
            (Preset::RegionalJet, include_str!("../presets/regional_jet.ron")),
        ] {
            AircraftTruth::preset(preset).unwrap();
            for line in text.lines() {
                let code = line.split("//").next().unwrap_or_default();
                if code.contains(|c: char| c.is_ascii_digit())
                    && !code.contains('"')
                    && !code.trim().is_empty()
                {
                    assert!(line.contains("//"), "{preset:?}: {line}");
                }
            }
        }
    }

    #[test]
    fn a_negative_wing_is_refused_by_name() {
        let text = include_str!("../presets/citation_x.ron").replace("48.96", "-48.96");
        let error = AircraftTruth::from_ron(&text).unwrap_err();
        assert!(error.to_string().contains("wing area -48.96 m²"), "{error}");
    }

    #[test]
    fn plain_truth_knows_nothing_but_lift_coefficient_and_mach_number() {
        let aircraft = AircraftTruth::preset(Preset::CitationX).unwrap();
        let reference = aircraft.reference_conditions();
        let other = DragConditions {
            reynolds_number: 8e6,
            center_of_gravity_percent_mac: 20.0,
            roll_deg: 0.7,
        };
        let drag = |at, physics| aircraft.drag_coefficient(0.35, Mach::new(0.8), at, physics);
        let plain = TruthPhysics::plain();
        assert_eq!(drag(&reference, plain).to_bits(), drag(&other, plain).to_bits());
        assert!(drag(&other, TruthPhysics::full()) > drag(&reference, TruthPhysics::full()));
        let sat = Temperature::kelvin(216.65);
        let tsfc = |newtons, physics| {
            aircraft
                .tsfc(Mach::new(0.8), sat, Force::newtons(newtons), physics)
                .to_pounds_per_pound_force_hour()
        };
        assert_eq!(tsfc(40e3, plain).to_bits(), tsfc(70e3, plain).to_bits());
        // Ghazi et al. reconstruction, n = 1.25 at M 0.80, θ 0.7519: 0.654 lb/(lbf h).
        assert!((tsfc(60e3, plain) - 0.654).abs() < 6e-4, "{}", tsfc(60e3, plain));
        assert!(tsfc(20e3, TruthPhysics::full()) > tsfc(60e3, TruthPhysics::full()));
    }
}
