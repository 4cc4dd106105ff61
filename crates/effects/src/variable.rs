//! The physical variables that a gap may hang on.

use flight::effect::DrivingVariable;
use serde::{Deserialize, Serialize};
use units::convert::{DAYS_PER_YEAR, RADIANS_PER_DEGREE, SECONDS_PER_DAY};

use crate::point::EffectPoint;
use crate::references::EffectReferences;
use crate::response::Response;

/// A variable of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Variable {
    /// Mach number.
    Mach,
    /// Lift coefficient.
    LiftCoefficient,
    /// Pressure altitude, m.
    PressureAltitude,
    /// Corrected thrust over its reference.
    CorrectedThrust,
    /// Deviation from the standard day, K.
    IsaDeviation,
    /// Static air temperature, K.
    StaticAirTemperature,
    /// Date: years since the reference; the bounds of a region are s since 1970.
    Date,
    /// Fuel used, kg.
    FuelUsed,
    /// Root of the mean squared roll angle, degrees.
    Roll,
    /// Along-path acceleration, m/s².
    Acceleration,
    /// Cross-wind to the left, m/s.
    CrossWind,
    /// Latitude, degrees.
    Latitude,
    /// Speed over the ground towards east, m/s.
    EastwardSpeed,
    /// Center of gravity, %MAC.
    CenterOfGravity,
    /// Gross mass, kg.
    Mass,
    /// Latitude's sine times cross-wind.
    LatitudeCrossWind,
    /// Center of gravity times lift coefficient.
    CenterOfGravityLift,
    /// Mach number times lift coefficient.
    MachLift,
    /// Squared excess of Mach number over its reference.
    MachExcess,
    /// Which engine.
    Engine,
    /// Mean N2 of the engines, %: of a segment, not of a point.
    N2,
    /// Share of the segment with anti-ice bleed on, as recorded.
    AntiIce,
}

impl Variable {
    /// The value at a point, in the variable's unit; `None` where an input is not recorded, and for what is no variable of a
    /// point (engine, N2).
    #[must_use]
    pub fn value(
        self,
        point: &EffectPoint,
        aloft: impl Into<Aloft>,
        references: &EffectReferences,
    ) -> Option<f64> {
        let aloft = aloft.into();
        let cross_wind = || {
            point
                .drift_deg
                .map(|drift_deg| -point.true_airspeed_m_s * (drift_deg * RADIANS_PER_DEGREE).sin())
        };
        Some(match self {
            Self::Mach => point.mach,
            Self::LiftCoefficient => aloft.lift_coefficient,
            Self::PressureAltitude => point.pressure_altitude_m,
            Self::CorrectedThrust => {
                aloft.ln_corrected_thrust.exp() / references.corrected_thrust_n
            }
            Self::IsaDeviation => {
                let isa = atmos::isa::temperature(units::PressureAltitude::meters(
                    point.pressure_altitude_m,
                ))
                .ok()?;
                point.static_air_temperature_k - isa.to_kelvin()
            }
            Self::StaticAirTemperature => point.static_air_temperature_k,
            Self::Date => (point.date_s - references.date_s) / (DAYS_PER_YEAR * SECONDS_PER_DAY),
            Self::FuelUsed => point.fuel_used_kg,
            Self::Roll => point.roll_squared_deg2?.max(0.0).sqrt(),
            Self::Acceleration => point.acceleration_m_s2,
            Self::CrossWind => cross_wind()?,
            Self::Latitude => point.latitude_deg?,
            Self::EastwardSpeed => {
                let track_deg = point.true_heading_deg? + point.drift_deg.unwrap_or(0.0);
                point.ground_speed_m_s * (track_deg * RADIANS_PER_DEGREE).sin()
            }
            Self::CenterOfGravity => point.center_of_gravity_percent_mac?,
            Self::Mass => point.mass_kg,
            Self::AntiIce => point.anti_ice?,
            Self::LatitudeCrossWind => {
                (point.latitude_deg? * RADIANS_PER_DEGREE).sin() * cross_wind()?
            }
            Self::CenterOfGravityLift => {
                (point.center_of_gravity_percent_mac? - references.center_of_gravity_percent_mac?)
                    * aloft.lift_coefficient
            }
            Self::MachLift => (point.mach - references.mach) * aloft.lift_coefficient,
            Self::MachExcess => (point.mach - references.mach + 0.02).max(0.0).powi(2),
            Self::Engine | Self::N2 => return None,
        })
    }
}

impl Variable {
    /// The value that a form outside the library is over: of a date the instant itself, s since 1970, not years since a
    /// reference that nobody sees.
    #[must_use]
    pub fn value_of_form(
        self,
        point: &EffectPoint,
        aloft: impl Into<Aloft>,
        references: &EffectReferences,
    ) -> Option<f64> {
        match self {
            Self::Date => Some(point.date_s),
            _ => self.value(point, aloft, references),
        }
    }
}

/// The variable that bounds of a region are said in.
impl From<DrivingVariable> for Variable {
    fn from(driver: DrivingVariable) -> Self {
        match driver {
            DrivingVariable::Mach => Self::Mach,
            DrivingVariable::StaticAirTemperature => Self::StaticAirTemperature,
            DrivingVariable::PressureAltitude => Self::PressureAltitude,
            DrivingVariable::Roll => Self::Roll,
            DrivingVariable::CorrectedThrust => Self::CorrectedThrust,
            DrivingVariable::N2 => Self::N2,
            DrivingVariable::CrossWind => Self::CrossWind,
            DrivingVariable::Latitude => Self::Latitude,
            DrivingVariable::Date => Self::Date,
            DrivingVariable::FuelUsed => Self::FuelUsed,
            DrivingVariable::Mass => Self::Mass,
            DrivingVariable::CenterOfGravity => Self::CenterOfGravity,
            DrivingVariable::LiftCoefficient => Self::LiftCoefficient,
            DrivingVariable::IsaDeviation => Self::IsaDeviation,
            DrivingVariable::EastwardSpeed => Self::EastwardSpeed,
            DrivingVariable::Engine => Self::Engine,
            DrivingVariable::AntiIce => Self::AntiIce,
        }
    }
}

/// What a variable needs to know beside the point; a [`Response`] converts by [`From`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aloft {
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// ln of the net thrust of all engines over pressure ratio, N.
    pub ln_corrected_thrust: f64,
}

impl From<&Response> for Aloft {
    fn from(response: &Response) -> Self {
        Self {
            lift_coefficient: response.lift_coefficient,
            ln_corrected_thrust: response.ln_corrected_thrust,
        }
    }
}
