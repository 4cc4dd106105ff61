//! All terms of one flight's drag and fuel: the aircraft, its physics, and the effects it carries.
//!
//! An effect is written here in the truth's own form, which is *not* the library's: saturating ageing instead of a
//! constant rate per year, a log law instead of a power law, two half-parabolas instead of one. A diagnosis that found
//! only its own formulas would prove nothing.

mod drag;
mod fuel;
mod resolve;

use crate::aircraft::{AircraftTruth, TruthPhysics};

pub(crate) use drag::DragInputs;
pub(crate) use fuel::{FuelInputs, FuelShares};
pub(crate) use resolve::EffectContext;
pub use resolve::References;

/// The number of engines a truth may have.
pub(crate) const MAXIMUM_ENGINES: usize = flight::MAXIMUM_ENGINES;

/// The resolved terms of one flight. All are zero, or one for factors, in a plain truth without effects.
#[derive(Clone, Debug)]
pub(crate) struct Terms {
    pub(crate) drag: drag::DragTerms,
    pub(crate) fuel: fuel::FuelTerms,
    pub(crate) earth: EarthTerms,
    pub(crate) recorded: RecordedTerms,
}

/// The effects of the Earth that are switched on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EarthTerms {
    pub(crate) load_factor: bool,
    pub(crate) local_gravity: bool,
    pub(crate) rotating_earth: bool,
    /// By how much the isobaric surface is steeper than geostrophic, relative.
    pub(crate) extra_slope: f64,
}

/// Errors of the recording.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RecordedTerms {
    pub(crate) mach_bias: f64,
    pub(crate) static_pressure_relative: f64,
    /// SAT reads high by this at `temperature_bias_mach`, K.
    pub(crate) temperature_bias_k: f64,
    pub(crate) temperature_bias_mach: f64,
    /// Recorded over true fuel flow of each engine.
    pub(crate) fuel_flow_factor: [f64; MAXIMUM_ENGINES],
    /// Recorded over metered fuel used.
    pub(crate) fuel_used_factor: f64,
    /// True minus recorded zero-fuel mass, kg.
    pub(crate) zero_fuel_mass_kg: f64,
    /// Flight-to-flight scatter of the heating value, relative, beyond the plan's own.
    pub(crate) heating_value_scatter: f64,
}

impl Default for RecordedTerms {
    fn default() -> Self {
        Self {
            mach_bias: 0.0,
            static_pressure_relative: 0.0,
            temperature_bias_k: 0.0,
            temperature_bias_mach: 0.8,
            fuel_flow_factor: [1.0; MAXIMUM_ENGINES],
            fuel_used_factor: 1.0,
            zero_fuel_mass_kg: 0.0,
            heating_value_scatter: 0.0,
        }
    }
}

impl Terms {
    /// The terms of an aircraft without effects.
    pub(crate) fn new(aircraft: &AircraftTruth, physics: TruthPhysics) -> Self {
        Self {
            drag: drag::DragTerms::new(aircraft, physics),
            fuel: fuel::FuelTerms::new(aircraft, physics),
            earth: EarthTerms::default(),
            recorded: RecordedTerms::default(),
        }
    }
}
