//! The library's entry of an effect.

use super::HiddenParameter;

/// The library's entry of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectEntry {
    /// Name in files; `{k}` is an engine's number.
    pub name: &'static str,
    /// Its group.
    pub group: EffectGroup,
    /// Unit of its size θ.
    pub unit: &'static str,
    /// Usual size in that unit.
    pub typical: TypicalSize,
    /// Which sign physics expects.
    pub sign: EffectSign,
    /// Inputs beyond the required columns that it depends on. Without one of them it can neither be predicted nor
    /// tested, unless there is a substitute ([`NeededInput::has_substitute`]).
    pub needs: &'static [NeededInput],
    /// Its hidden parameter, with the default value.
    pub hidden: HiddenParameter,
    /// Variables that its share of fuel flow depends on; none where it is the same everywhere.
    pub driven_by: &'static [DrivingVariable],
    /// Its perturbation of the model, in one line.
    pub perturbation: &'static str,
    /// Its description in words, by the sign of θ.
    pub phrase: Phrase,
}

impl EffectEntry {
    /// What a size of 1 in this unit is in the equations: a share for per cent, a drag coefficient for drag counts, else
    /// the unit itself.
    #[must_use]
    pub fn unit_factor(&self) -> f64 {
        if self.unit.starts_with('%') {
            0.01
        } else if self.unit.contains("counts") {
            1e-4
        } else {
            1.0
        }
    }
}

/// The description of an effect in words; `{k}` is an engine's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Phrase {
    /// Where its size is positive, or has no sign.
    pub positive: &'static str,
    /// Where its size is negative.
    pub negative: &'static str,
}

/// Which sign of an effect's size physics expects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EffectSign {
    /// Positive: friction falls with Reynolds number, age and offtakes cost fuel.
    Positive,
    /// Either.
    Either,
    /// The size is a standard deviation.
    Spread,
}

/// The group of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EffectGroup {
    /// The airframe's drag.
    Airframe,
    /// The engines' consumption.
    Engine,
    /// The aircraft's mass.
    Mass,
    /// The readings of the sensors.
    Sensor,
    /// The Earth and its air.
    Environment,
    /// A dated event.
    Event,
}

/// The size that is usual for an effect, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TypicalSize {
    /// A number in the effect's unit.
    Absolute(f64),
    /// This share of the aircraft's mass, in kg.
    ShareOfMass(f64),
    /// The coefficient is known from physics and is 1.
    Known,
}

/// An input beyond the required columns that an effect depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NeededInput {
    /// `CG`.
    CenterOfGravity,
    /// `ROLL`.
    Roll,
    /// `WF(k)`: fuel flow engine by engine.
    FuelFlowPerEngine,
    /// `A/I`; where it is not recorded, static air temperature above −40 °C is used instead.
    AntiIce,
    /// `LAT`.
    Latitude,
    /// `HDG`.
    TrueHeading,
    /// `DRIFT`.
    Drift,
    /// `SAT`; where it is assumed, effects that depend on it are predicted with what is assumed, and not tested.
    StaticAirTemperature,
}

impl NeededInput {
    /// Whether there is a substitute for the input where it is not recorded, so that effects that depend on it can
    /// still be predicted: static air temperature above −40 °C for anti-ice bleed (our choice: bleed is used in visible
    /// moisture, of which there is little below), which is tested too; and the temperature that is assumed where none is
    /// recorded, of which recordings say nothing.
    #[must_use]
    pub const fn has_substitute(self) -> bool {
        matches!(self, Self::AntiIce | Self::StaticAirTemperature)
    }

    /// The column's name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::CenterOfGravity => "CG",
            Self::Roll => "ROLL",
            Self::FuelFlowPerEngine => "WF(k)",
            Self::AntiIce => "A/I",
            Self::Latitude => "LAT",
            Self::TrueHeading => "HDG",
            Self::Drift => "DRIFT",
            Self::StaticAirTemperature => "SAT",
        }
    }
}

/// A variable of a segment that an effect's share of fuel flow depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DrivingVariable {
    /// Mach number.
    Mach,
    /// Static air temperature, K.
    StaticAirTemperature,
    /// Pressure altitude, m.
    PressureAltitude,
    /// Root of the mean squared roll angle, degrees.
    Roll,
    /// Corrected thrust over its reference.
    CorrectedThrust,
    /// Mean N2 of the engines, %.
    N2,
    /// Cross-wind to the left, m/s.
    CrossWind,
    /// Latitude, degrees.
    Latitude,
    /// Date, s since 1970.
    Date,
    /// Fuel used since engine start, kg.
    FuelUsed,
    /// Gross mass, kg.
    Mass,
    /// Center of gravity, % of the mean aerodynamic chord.
    CenterOfGravity,
    /// Lift coefficient.
    LiftCoefficient,
    /// Deviation from the standard day, K.
    IsaDeviation,
    /// Speed over the ground towards east, m/s.
    EastwardSpeed,
    /// Which engine.
    Engine,
    /// Whether anti-ice bleed is on, as recorded: a share of the segment.
    AntiIce,
}

impl DrivingVariable {
    /// The name of its bounds in a diagnosis, with the unit.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mach => "mach",
            Self::StaticAirTemperature => "static_air_temperature_k",
            Self::PressureAltitude => "pressure_altitude_m",
            Self::Roll => "roll_deg",
            Self::CorrectedThrust => "corrected_thrust_ratio",
            Self::N2 => "n2_percent",
            Self::CrossWind => "cross_wind_m_s",
            Self::Latitude => "latitude_deg",
            Self::Date => "date_s",
            Self::FuelUsed => "fuel_used_kg",
            Self::Mass => "mass_kg",
            Self::CenterOfGravity => "center_of_gravity_percent_mac",
            Self::LiftCoefficient => "lift_coefficient",
            Self::IsaDeviation => "isa_deviation_k",
            Self::EastwardSpeed => "eastward_speed_m_s",
            Self::Engine => "engine",
            Self::AntiIce => "anti_ice",
        }
    }
}
