//! SI newtypes for the quantities of flight that must not be mixed up.
//!
//! What it is: one transparent type per *kind* of quantity, so that true and calibrated airspeed, pressure and
//! geometric altitude, static and total temperature, zero-fuel and gross mass cannot be swapped in a call. What it is
//! not: a unit system. Inside kernels, columns and files numbers are `f64` with the unit in the name.
//!
//! The one design decision: kinds, not dimensions. The dangerous mistakes of this field are between quantities of
//! the same dimension, which a dimension-checking library does not separate.
//!
//! Limits: constructors do not check (they are `const` and free); a stage's constructor checks what it needs, with
//! [`check_within`] or [`check_finite`]. Absolute temperatures do not add; altitudes of two kinds do not compare.
//!
//! ```
//! use units::{PressureAltitude, TrueAirspeed};
//!
//! let cruise = PressureAltitude::feet(41_000.0);
//! assert_eq!(cruise.to_meters(), 41_000.0 * 0.3048);
//! assert!((TrueAirspeed::knots(460.0).to_meters_per_second() - 236.644_444).abs() < 1e-6);
//! ```
//!
//! A calibrated airspeed is not a true airspeed:
//!
//! ```compile_fail
//! use units::{CalibratedAirspeed, TrueAirspeed};
//! fn density_kg_m3(_: TrueAirspeed) {}
//! density_kg_m3(CalibratedAirspeed::knots(250.0));
//! ```
//!
//! A bare number is not a quantity:
//!
//! ```compile_fail
//! let altitude: units::PressureAltitude = 12_000.0.into();
//! ```
//!
//! Absolute temperatures do not add up:
//!
//! ```compile_fail
//! use units::Temperature;
//! let nonsense = Temperature::kelvin(220.0) + Temperature::kelvin(220.0);
//! ```

mod altitude;
pub mod convert;
mod direction;
mod domain;
mod mass;
mod motion;
mod quantity;
mod speed;
mod state;
mod temperature;

pub use altitude::{GeometricAltitude, PressureAltitude};
pub use direction::mean_direction_deg;
pub use domain::{OutOfDomain, check_finite, check_within};
pub use mass::{FuelFlowEngine, FuelFlowTotal, Mass, SpecificRange, Tsfc};
pub use motion::{Acceleration, Angle, Area, Force, VerticalSpeed};
pub use speed::{
    CalibratedAirspeed, EquivalentAirspeed, GroundSpeed, Mach, SpeedOfSound, TrueAirspeed,
};
pub use state::{Density, DynamicViscosity, Pressure};
pub use temperature::{Temperature, TemperatureDifference};
