//! Why a flight cannot be flown.

use units::OutOfDomain;

/// Why a flight cannot be flown as planned.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FlightError {
    /// Outside the atmosphere.
    #[error(transparent)]
    Atmosphere(#[from] OutOfDomain),
    /// The engines cannot hold the speed.
    #[error("at {time_s} s Mach number {mach} falls away from {target}: not enough thrust")]
    Thrust {
        /// Time since the start of the recording, s.
        time_s: f64,
        /// Mach number.
        mach: f64,
        /// Target of the autopilot.
        target: f64,
    },
    /// More lift than the wing can give.
    #[error("at {time_s} s lift coefficient {lift_coefficient} above {maximum}")]
    LiftCoefficient {
        /// Time since the start of the recording, s.
        time_s: f64,
        /// Needed.
        lift_coefficient: f64,
        /// Largest.
        maximum: f64,
    },
    /// No fuel left.
    #[error("at {time_s} s no fuel is left of {fuel_on_board_kg} kg")]
    Fuel {
        /// Time since the start of the recording, s.
        time_s: f64,
        /// At engine start, kg.
        fuel_on_board_kg: f64,
    },
}
