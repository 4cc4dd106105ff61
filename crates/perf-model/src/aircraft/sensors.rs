//! Errors of recorded quantities: the standard deviations that uncertainties are propagated from.

use serde::{Deserialize, Serialize};

use super::AircraftError;
use super::limits;

/// Standard deviations of recorded quantities. Unless the field states otherwise, each is that of a segment's mean and
/// describes what differs from segment to segment; a bias that never changes is not a matter of variance but of
/// diagnosis.
///
/// The defaults are handbook values. A fleet in level flight is quieter: estimate them from past reports where there
/// are some.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SensorDeviations {
    /// Fuel flow of each engine, % of the reading; engines err independently. Default 0.5: the accuracy that
    /// operators quote for flow meters.
    #[serde(deserialize_with = "limits::fuel_flow_percent::deserialize")]
    pub fuel_flow_percent: f64,
    /// Mach number; the error of true airspeed follows it. Default 0.001: the resolution and repeatability of an
    /// air-data computer.
    #[serde(deserialize_with = "limits::mach::deserialize")]
    pub mach: f64,
    /// Static air temperature, K; the error of true airspeed follows it. Default 0.3: a total-temperature probe.
    #[serde(deserialize_with = "limits::static_air_temperature_k::deserialize")]
    pub static_air_temperature_k: f64,
    /// Along-path acceleration of one *sample* of 60 s, m/s², independent from sample to sample. Default 0.0045: the
    /// middle of 0.003 to 0.006, seen in simulated turbulence with ground speed rounded to 0.5 kt.
    #[serde(deserialize_with = "limits::acceleration_m_s2::deserialize")]
    pub acceleration_m_s2: f64,
    /// Gross mass from *flight to flight*: loading, standard passenger weights. Default 0.7 %: 80 kg of an 11 t
    /// zero-fuel mass.
    pub mass: MassDeviation,
    /// Lower heating value of the fuel from *flight to flight*, %. Default 0.3: the spread of batches is about ±0.5.
    #[serde(deserialize_with = "limits::lower_heating_value_percent::deserialize")]
    pub lower_heating_value_percent: f64,
    /// High-pressure rotor speed, % of the reading. Default 0.08.
    #[serde(deserialize_with = "limits::n2_percent::deserialize")]
    pub n2_percent: f64,
    /// Pressure altitude, m. Default 8: the resolution and repeatability of an air-data computer.
    #[serde(deserialize_with = "limits::pressure_altitude_m::deserialize")]
    pub pressure_altitude_m: f64,
    /// Per-flight bias of air data and rotor speed. Not written where it is the default.
    #[serde(alias = "through_flight", skip_serializing_if = "is_default")]
    pub flight_bias: FlightBias,
    /// Drift of flow meters within a flight, slower than a segment lasts. Not written where it is the default.
    #[serde(alias = "fuel_flow_wander", skip_serializing_if = "is_default")]
    pub fuel_flow_drift: FuelFlowDrift,
    /// How much of what air data err by from segment to segment drifts. Not written where it is the default.
    #[serde(skip_serializing_if = "is_default")]
    pub air_data_drift: AirDataDrift,
}

/// Drift of air data within a flight: a share of the variance from segment to segment of Mach number, static air temperature and
/// pressure altitude is a first-order Gauss–Markov process each, so that the errors of neighbouring segments are correlated. A
/// static source, a transducer and a probe err by temperature and attitude, which change within the hour; what is new in every
/// segment is rounding and turbulence, of which a mean keeps little.
///
/// We know of no figure for real air data, so the default is no drift. Where air data drift and the file does not state it, all is
/// taken as new in every segment, and functions of anything that changes slowly through a flight, as what burnt fuel makes of the
/// mass, seem to explain the drift. Against a learnt model the drift is multiplied by what flights show of errors that a flight
/// keeps, so that where it is stated, the deviations of air data are best those of the fleet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AirDataDrift {
    /// Share of the variance of a segment's mean that drifts: 0 all new in every segment, 1 nothing. Default 0.
    #[serde(deserialize_with = "limits::drifting_share::deserialize")]
    pub share: f64,
    /// Correlation time: the correlation of two means falls to 1/e over it, s. Default 1200.
    #[serde(deserialize_with = "limits::drift_time_s::deserialize")]
    pub time_s: f64,
}

/// Drift of flow meters within a flight, in addition to what differs from segment to segment: a first-order
/// Gauss–Markov process, so that the errors of neighbouring segments are correlated.
///
/// We know of no figure for real meters, so the default is no drift. Where meters drift and the file does not state it,
/// functions of anything that changes slowly through a flight seem to explain the drift.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FuelFlowDrift {
    /// Standard deviation of one engine's segment means, % of the reading; engines err independently. Default 0.
    #[serde(deserialize_with = "limits::fuel_flow_drift_percent::deserialize")]
    pub percent: f64,
    /// Correlation time: the correlation of two means falls to 1/e over it, s. Default 1200.
    #[serde(deserialize_with = "limits::drift_time_s::deserialize")]
    pub time_s: f64,
}

/// Standard deviations of the per-flight biases, constant within a flight and independent between flights: calibration,
/// hysteresis, the alignment of a computer. They are added to what differs from segment to segment.
///
/// Ten segments of one flight that share an error carry no more information than one of them. Without this, a diagnosis
/// without a learnt remainder mistakes three warm flights for a step, or for scatter between flights.
///
/// The defaults are our choice: 0.7 of the handbook value for one reading, so that half of its variance stays.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FlightBias {
    /// Mach number; true airspeed errs with it. Default 0.0007.
    #[serde(deserialize_with = "limits::mach::deserialize")]
    pub mach: f64,
    /// Static air temperature, K; true airspeed errs with it. Default 0.21.
    #[serde(deserialize_with = "limits::static_air_temperature_k::deserialize")]
    pub static_air_temperature_k: f64,
    /// High-pressure rotor speed, % of the reading. Default 0.056.
    #[serde(deserialize_with = "limits::n2_flight_bias_percent::deserialize")]
    pub n2_percent: f64,
    /// Pressure altitude, m. Default 5.6.
    #[serde(deserialize_with = "limits::pressure_altitude_m::deserialize")]
    pub pressure_altitude_m: f64,
}

/// Standard deviation of the gross mass from flight to flight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MassDeviation {
    /// Share of the gross mass, %.
    Percent(#[serde(deserialize_with = "limits::mass_percent::deserialize")] f64),
    /// The same mass at every loading, kg.
    Kilograms(#[serde(deserialize_with = "limits::mass_kg::deserialize")] f64),
}

impl MassDeviation {
    /// Relative to a gross mass: 0.007 for 0.7 %.
    #[must_use]
    pub fn relative_to(self, gross_mass: units::Mass) -> f64 {
        match self {
            Self::Percent(percent) => percent / 100.0,
            Self::Kilograms(kilograms) => kilograms / gross_mass.to_kilograms(),
        }
    }
}

impl Default for SensorDeviations {
    fn default() -> Self {
        Self {
            fuel_flow_percent: 0.5,
            mach: 0.001,
            static_air_temperature_k: 0.3,
            acceleration_m_s2: 0.0045,
            mass: MassDeviation::Percent(0.7),
            lower_heating_value_percent: 0.3,
            n2_percent: 0.08,
            pressure_altitude_m: 8.0,
            flight_bias: FlightBias::default(),
            fuel_flow_drift: FuelFlowDrift::default(),
            air_data_drift: AirDataDrift::default(),
        }
    }
}

impl Default for FuelFlowDrift {
    fn default() -> Self {
        Self { percent: 0.0, time_s: 1200.0 }
    }
}

impl FuelFlowDrift {
    fn check(&self) -> Result<(), AircraftError> {
        limits::fuel_flow_drift_percent::check(self.percent)?;
        limits::drift_time_s::check(self.time_s)?;
        Ok(())
    }
}

impl Default for AirDataDrift {
    fn default() -> Self {
        Self { share: 0.0, time_s: 1200.0 }
    }
}

impl AirDataDrift {
    fn check(&self) -> Result<(), AircraftError> {
        limits::drifting_share::check(self.share)?;
        limits::drift_time_s::check(self.time_s)?;
        Ok(())
    }
}

impl Default for FlightBias {
    fn default() -> Self {
        Self {
            mach: 0.0007,
            static_air_temperature_k: 0.21,
            n2_percent: 0.056,
            pressure_altitude_m: 5.6,
        }
    }
}

impl FlightBias {
    /// No per-flight bias.
    #[must_use]
    pub const fn none() -> Self {
        Self { mach: 0.0, static_air_temperature_k: 0.0, n2_percent: 0.0, pressure_altitude_m: 0.0 }
    }

    fn check(&self) -> Result<(), AircraftError> {
        limits::mach::check(self.mach)?;
        limits::static_air_temperature_k::check(self.static_air_temperature_k)?;
        limits::n2_flight_bias_percent::check(self.n2_percent)?;
        limits::pressure_altitude_m::check(self.pressure_altitude_m)?;
        Ok(())
    }
}

impl SensorDeviations {
    pub(super) fn check(&self) -> Result<(), AircraftError> {
        limits::fuel_flow_percent::check(self.fuel_flow_percent)?;
        limits::mach::check(self.mach)?;
        limits::static_air_temperature_k::check(self.static_air_temperature_k)?;
        limits::acceleration_m_s2::check(self.acceleration_m_s2)?;
        match self.mass {
            MassDeviation::Percent(percent) => limits::mass_percent::check(percent)?,
            MassDeviation::Kilograms(kilograms) => limits::mass_kg::check(kilograms)?,
        };
        limits::lower_heating_value_percent::check(self.lower_heating_value_percent)?;
        limits::n2_percent::check(self.n2_percent)?;
        limits::pressure_altitude_m::check(self.pressure_altitude_m)?;
        self.flight_bias.check()?;
        self.fuel_flow_drift.check()?;
        self.air_data_drift.check()
    }
}

/// Whether nothing need be written.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mass_deviation_of_the_default_is_80_kg_of_eleven_tonnes() {
        // 80/11 400 = 0.702 %, by hand.
        let relative =
            SensorDeviations::default().mass.relative_to(units::Mass::kilograms(11_400.0));
        assert!((relative - 80.0 / 11_400.0).abs() < 2e-5);
        let fixed = MassDeviation::Kilograms(80.0).relative_to(units::Mass::kilograms(16_000.0));
        assert!((fixed - 0.005).abs() < 1e-15);
    }
}
