//! A stabilised piece of cruise and the mean state over it.

use std::sync::Arc;

use units::{FuelFlowTotal, Mach, Mass, PressureAltitude, Temperature, TrueAirspeed};

use crate::{FlightIdentity, MAXIMUM_ENGINES};

/// Means over the kept samples of a segment, SI unless the name says otherwise.
///
/// An optional signal is the mean over the samples where it is available, `None` where it is at none of them.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentMeans {
    /// Time since START, s.
    pub time_s: f64,
    /// Pressure altitude, m.
    pub pressure_altitude_m: f64,
    /// Static air temperature, K.
    pub static_air_temperature_k: f64,
    /// Mach number.
    pub mach: f64,
    /// True airspeed, m/s.
    pub true_airspeed_m_s: f64,
    /// Ground speed, m/s.
    pub ground_speed_m_s: f64,
    /// Along-path acceleration, m/s².
    pub acceleration_m_s2: f64,
    /// Vertical speed (rate of pressure altitude), m/s.
    pub vertical_speed_m_s: f64,
    /// Gross mass, kg.
    pub mass_kg: f64,
    /// Fuel flow of all engines together, kg/s.
    pub fuel_flow_total_kg_s: f64,
    /// Fuel flow of each engine, kg/s; empty where engines are not recorded separately.
    pub fuel_flow_engine_kg_s: Vec<f64>,
    /// Fuel used since engine start, kg.
    pub fuel_used_kg: f64,
    /// Drift angle, degrees.
    pub drift_deg: Option<f64>,
    /// Roll angle, degrees.
    pub roll_deg: Option<f64>,
    /// Mean of the squared roll angle, degrees².
    pub roll_squared_deg2: Option<f64>,
    /// High-pressure rotor speed of each engine, %; empty where not recorded.
    pub n2_percent: Vec<f64>,
    /// Latitude, degrees.
    pub latitude_deg: Option<f64>,
    /// Longitude, degrees (mean direction).
    pub longitude_deg: Option<f64>,
    /// True heading, degrees (mean direction, 0 … 360).
    pub true_heading_deg: Option<f64>,
    /// Center of gravity, % of the mean aerodynamic chord.
    pub center_of_gravity_percent_mac: Option<f64>,
    /// Total air temperature, K.
    pub total_air_temperature_k: Option<f64>,
    /// Low-pressure rotor speed by engine, %.
    pub n1_percent: [Option<f64>; MAXIMUM_ENGINES],
    /// Exhaust gas temperature by engine, K.
    pub exhaust_gas_temperature_k: [Option<f64>; MAXIMUM_ENGINES],
    /// Fuel quantity by the tank gauges, kg.
    pub fuel_quantity_kg: Option<f64>,
    /// Share of the samples with anti-ice bleed on.
    pub anti_ice: Option<f64>,
}

/// Steady, wings-level cruise, as plain numbers describe it: what [`SegmentMeans::cruise`] is made from.
///
/// True airspeed is given apart because it follows from Mach number and static air temperature by an atmosphere, which this
/// crate has none of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cruise {
    /// Pressure altitude.
    pub pressure_altitude: PressureAltitude,
    /// Static air temperature.
    pub static_air_temperature: Temperature,
    /// Mach number.
    pub mach: Mach,
    /// True airspeed.
    pub true_airspeed: TrueAirspeed,
    /// Gross mass.
    pub mass: Mass,
    /// Fuel flow of all engines together.
    pub fuel_flow_total: FuelFlowTotal,
}

impl SegmentMeans {
    /// The means of a segment of which only the cruise is known: at the beginning of its flight, neither accelerating nor
    /// climbing, in still air, without fuel used and without any optional signal. What else is known goes over it with
    /// struct update syntax.
    ///
    /// ```
    /// use flight::{Cruise, SegmentMeans};
    /// use units::{FuelFlowTotal, Mach, Mass, PressureAltitude, Temperature, TrueAirspeed};
    ///
    /// let cruise = Cruise {
    ///     pressure_altitude: PressureAltitude::feet(41_000.0),
    ///     static_air_temperature: Temperature::celsius(-56.5),
    ///     mach: Mach::new(0.80),
    ///     true_airspeed: TrueAirspeed::knots(459.0),
    ///     mass: Mass::kilograms(29_000.0),
    ///     fuel_flow_total: FuelFlowTotal::kilograms_per_hour(1_250.0),
    /// };
    /// let means = SegmentMeans { fuel_used_kg: 1_800.0, ..SegmentMeans::cruise(&cruise) };
    /// assert_eq!(means.mass_kg, 29_000.0);
    /// assert!(means.n2_percent.is_empty());
    /// ```
    #[must_use]
    pub const fn cruise(cruise: &Cruise) -> Self {
        Self {
            time_s: 0.0,
            pressure_altitude_m: cruise.pressure_altitude.to_meters(),
            static_air_temperature_k: cruise.static_air_temperature.to_kelvin(),
            mach: cruise.mach.value(),
            true_airspeed_m_s: cruise.true_airspeed.to_meters_per_second(),
            ground_speed_m_s: cruise.true_airspeed.to_meters_per_second(),
            acceleration_m_s2: 0.0,
            vertical_speed_m_s: 0.0,
            mass_kg: cruise.mass.to_kilograms(),
            fuel_flow_total_kg_s: cruise.fuel_flow_total.to_kilograms_per_second(),
            fuel_flow_engine_kg_s: Vec::new(),
            fuel_used_kg: 0.0,
            drift_deg: None,
            roll_deg: None,
            roll_squared_deg2: None,
            n2_percent: Vec::new(),
            latitude_deg: None,
            longitude_deg: None,
            true_heading_deg: None,
            center_of_gravity_percent_mac: None,
            total_air_temperature_k: None,
            n1_percent: [None; MAXIMUM_ENGINES],
            exhaust_gas_temperature_k: [None; MAXIMUM_ENGINES],
            fuel_quantity_kg: None,
            anti_ice: None,
        }
    }
}

/// A stabilised segment of one flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// The flight it belongs to.
    pub identity: Arc<FlightIdentity>,
    /// Kept samples: indices into the track's samples, from 0, increasing.
    pub rows: Vec<u32>,
    /// The mean state.
    pub means: SegmentMeans,
    /// Whether the static air temperature is an assumption and not a recording.
    pub temperature_assumed: bool,
}

impl Segment {
    /// Number of kept samples.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.rows.len()
    }
}
