//! Standard atmosphere, airspeeds, temperatures, gravity, viscosity.
//!
//! What it is: the air and the Earth that an aircraft in cruise meets, one small free function per quantity, typed by
//! `units` and numbered `[atmosphere.N]` as in the book's page on the atmosphere. What it is not: a weather model. The
//! day enters as the measured SAT, the standard day only where it is asked for.
//!
//! The one design decision: pressure altitude is the only vertical coordinate of the air. Static pressure follows from
//! it alone on every day, density from that pressure and the *measured* SAT. Geometric altitude occurs in gravity only.
//!
//! Limits: pressure altitude −2 to 20 km, refused outside; dry air, γ = 1.4; calibrated airspeed subsonic only, NaN
//! outside; gravity of the smooth ellipsoid WGS 84.
//!
//! ```
//! use units::{Mach, PressureAltitude, Temperature};
//!
//! let pressure_altitude = PressureAltitude::feet(39_000.0);
//! let sat = Temperature::celsius(-50.0);
//! let static_pressure = atmos::isa::pressure(pressure_altitude)?;
//! let true_airspeed = atmos::airspeed::mach_to_true_airspeed(Mach::new(0.80), sat);
//! let density = atmos::isa::density(static_pressure, sat);
//! let dynamic_pressure = atmos::airspeed::dynamic_pressure(density, true_airspeed);
//! // ½ρV² and ½γpM² are the same thing.
//! let by_mach_pa = 0.7 * static_pressure.to_pascals() * 0.80 * 0.80;
//! assert!((dynamic_pressure.to_pascals() / by_mach_pa - 1.0).abs() < 1e-12);
//! # Ok::<(), units::OutOfDomain>(())
//! ```

pub mod airspeed;
pub mod constants;
pub mod gravity;
pub mod isa;
pub mod temperature;
pub mod viscosity;
