//! The conditions at which effects are zero.

use flight::effect::{EffectId, TypicalSize};
use serde::{Deserialize, Serialize};

use crate::error::EffectModelError;

/// The conditions at which effects are zero: the mean over what a model was adapted to, or over the data at hand.
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

impl EffectReferences {
    /// For a model in which no effect is switched on: only effects use references.
    pub(crate) const UNUSED: Self = Self {
        date_s: 0.0,
        mach: 1.0,
        unit_reynolds_number_per_m: 1.0,
        temperature_ratio: 1.0,
        corrected_thrust_n: 1.0,
        fuel_flow_total_kg_s: 1.0,
        mass_kg: 1.0,
        center_of_gravity_percent_mac: None,
    };

    /// The usual size θ of an effect, in its unit.
    #[must_use]
    pub fn typical_size(&self, effect: EffectId) -> f64 {
        match effect.entry().typical {
            TypicalSize::Absolute(size) => size,
            TypicalSize::ShareOfMass(share) => share * self.mass_kg,
            TypicalSize::Known => 1.0,
        }
    }

    pub(crate) fn check(&self) -> Result<(), EffectModelError> {
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
