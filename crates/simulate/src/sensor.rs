//! From the truth through the sensors to the report.
//!
//! The air-data computer is modelled as one unit: it measures static and total pressure and total temperature, and
//! computes pressure altitude, Mach number, SAT and TAS from them by the exact formulas, so that one wrong pressure
//! affects all of them.

mod air_data;
mod bank;
mod channel;
mod faults;

use flight::column::Column;
use serde::{Deserialize, Serialize};

use crate::aircraft::Switch;

pub(crate) use bank::{BankSetup, RecordedLoading, SensorBank};
pub use channel::{ChannelSensor, DRIFT_TIME_CONSTANT_S, Faults};

/// The sensors of an aircraft. Units are those that reports usually carry.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensors {
    /// Static pressure, hPa; `resolution` is that of pressure altitude, ft.
    pub static_pressure: ChannelSensor,
    /// Total pressure, hPa; `resolution` is that of Mach number.
    pub total_pressure: ChannelSensor,
    /// Total air temperature, K; `resolution` is that of SAT and TAT, °C.
    pub total_air_temperature: ChannelSensor,
    /// True airspeed: only its resolution, kt, is used.
    pub true_airspeed_resolution_kt: f64,
    /// Ground speed, kt.
    pub ground_speed: ChannelSensor,
    /// Roll angle, degrees.
    pub roll: ChannelSensor,
    /// Drift angle, degrees.
    pub drift: ChannelSensor,
    /// High-pressure rotor speed, %.
    pub n2: ChannelSensor,
    /// Low-pressure rotor speed, %.
    pub n1: ChannelSensor,
    /// Exhaust gas temperature, K.
    pub exhaust_gas_temperature: ChannelSensor,
    /// Fuel flow of one engine, lb/h.
    pub fuel_flow: ChannelSensor,
    /// Resolution of fuel used, lb. Fuel used is the integral of the flow meters.
    pub fuel_used_resolution_lb: f64,
    /// Fuel quantity by the tank gauges, lb.
    pub fuel_quantity: ChannelSensor,
    /// Resolution of latitude and longitude, degrees.
    pub position_resolution_deg: f64,
    /// True heading, degrees.
    pub heading: ChannelSensor,
    /// Center of gravity, %MAC.
    pub center_of_gravity: ChannelSensor,
    /// Faults.
    pub faults: Faults,
}

impl Sensors {
    /// The truth itself, not even rounded.
    #[must_use]
    pub fn perfect() -> Self {
        let none = ChannelSensor::default();
        Self {
            static_pressure: none,
            total_pressure: none,
            total_air_temperature: none,
            true_airspeed_resolution_kt: 0.0,
            ground_speed: none,
            roll: none,
            drift: none,
            n2: none,
            n1: none,
            exhaust_gas_temperature: none,
            fuel_flow: none,
            fuel_used_resolution_lb: 0.0,
            fuel_quantity: none,
            position_resolution_deg: 0.0,
            heading: none,
            center_of_gravity: none,
            faults: Faults::default(),
        }
    }

    /// The truth in the figures of the format's example.
    #[must_use]
    pub fn rounded() -> Self {
        let rounded = |resolution| ChannelSensor { resolution, ..ChannelSensor::default() };
        Self {
            static_pressure: rounded(1.0),
            total_pressure: rounded(0.0005),
            total_air_temperature: rounded(0.1),
            true_airspeed_resolution_kt: 0.5,
            ground_speed: rounded(0.5),
            roll: rounded(0.1),
            drift: rounded(0.1),
            n2: rounded(0.1),
            n1: rounded(0.1),
            exhaust_gas_temperature: rounded(1.0),
            fuel_flow: rounded(1.0),
            fuel_used_resolution_lb: 1.0,
            fuel_quantity: rounded(10.0),
            position_resolution_deg: 0.001,
            heading: rounded(0.1),
            center_of_gravity: rounded(0.1),
            faults: Faults::default(),
        }
    }

    /// Sensors of a transport aircraft, without faults. Sizes: industrial tolerances as far as known (fuel flow 0.5 %,
    /// Mach number 0.001, SAT 0.3 K, N2 0.1 %), split by our choice between tail, flight, minutes and sample.
    #[must_use]
    pub fn transport() -> Self {
        let r = Self::rounded();
        Self {
            static_pressure: ChannelSensor {
                flight_sd: 0.10,
                drift_sd: 0.03,
                noise_sd: 0.01,
                lag_s: 0.5,
                ..r.static_pressure
            },
            total_pressure: ChannelSensor {
                flight_sd: 0.15,
                drift_sd: 0.05,
                noise_sd: 0.03,
                lag_s: 0.5,
                ..r.total_pressure
            },
            total_air_temperature: ChannelSensor {
                flight_sd: 0.20,
                drift_sd: 0.10,
                noise_sd: 0.05,
                lag_s: 4.0,
                ..r.total_air_temperature
            },
            ground_speed: ChannelSensor { noise_sd: 0.1, ..r.ground_speed },
            roll: ChannelSensor { flight_sd: 0.05, noise_sd: 0.10, ..r.roll },
            drift: ChannelSensor { noise_sd: 0.05, ..r.drift },
            n2: ChannelSensor { gain_flight_sd: 0.0003, noise_sd: 0.05, ..r.n2 },
            n1: ChannelSensor { gain_flight_sd: 0.0003, noise_sd: 0.05, ..r.n1 },
            exhaust_gas_temperature: ChannelSensor {
                flight_sd: 2.0,
                noise_sd: 1.0,
                ..r.exhaust_gas_temperature
            },
            fuel_flow: ChannelSensor {
                gain_flight_sd: 0.0015,
                gain_drift_sd: 0.0020,
                gain_noise_sd: 0.0030,
                lag_s: 1.5,
                ..r.fuel_flow
            },
            fuel_quantity: ChannelSensor { flight_sd: 30.0, noise_sd: 10.0, ..r.fuel_quantity },
            heading: ChannelSensor { noise_sd: 0.05, ..r.heading },
            center_of_gravity: ChannelSensor { flight_sd: 0.2, ..r.center_of_gravity },
            ..r
        }
    }
}

/// Which optional columns are recorded, and in which form fuel flow is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Columns {
    /// `WF(k)` and `N2(k)` engine by engine; off: total `WF`, N2 still by engine.
    pub fuel_flow_per_engine: Switch,
    /// `LAT` and `LON`.
    pub position: Switch,
    /// `HDG`.
    pub true_heading: Switch,
    /// `CG`.
    pub center_of_gravity: Switch,
    /// `TAT`.
    pub total_air_temperature: Switch,
    /// `N1(k)`.
    pub n1: Switch,
    /// `EGT(k)`.
    pub exhaust_gas_temperature: Switch,
    /// `FQ`.
    pub fuel_quantity: Switch,
    /// `A/I`.
    pub anti_ice: Switch,
    /// `LHV` in the header.
    pub lower_heating_value: Switch,
}

impl Columns {
    /// Whether an optional column is recorded.
    pub(crate) const fn has(&self, column: Column) -> bool {
        let switch = match column {
            Column::Latitude | Column::Longitude => self.position,
            Column::TrueHeading => self.true_heading,
            Column::CenterOfGravity => self.center_of_gravity,
            Column::TotalAirTemperature => self.total_air_temperature,
            Column::N1(_) => self.n1,
            Column::ExhaustGasTemperature(_) => self.exhaust_gas_temperature,
            Column::FuelQuantity => self.fuel_quantity,
            Column::AntiIce => self.anti_ice,
            _ => Switch::Off,
        };
        switch.is_on()
    }
}

impl Default for Columns {
    /// Those of the format's example and all that effects need; the rest off.
    fn default() -> Self {
        Self {
            fuel_flow_per_engine: Switch::On,
            position: Switch::On,
            true_heading: Switch::On,
            center_of_gravity: Switch::On,
            total_air_temperature: Switch::Off,
            n1: Switch::Off,
            exhaust_gas_temperature: Switch::Off,
            fuel_quantity: Switch::Off,
            anti_ice: Switch::On,
            lower_heating_value: Switch::Off,
        }
    }
}

impl Columns {
    /// Every column of the format.
    #[must_use]
    pub const fn all() -> Self {
        Self {
            fuel_flow_per_engine: Switch::On,
            position: Switch::On,
            true_heading: Switch::On,
            center_of_gravity: Switch::On,
            total_air_temperature: Switch::On,
            n1: Switch::On,
            exhaust_gas_temperature: Switch::On,
            fuel_quantity: Switch::On,
            anti_ice: Switch::On,
            lower_heating_value: Switch::On,
        }
    }
}
