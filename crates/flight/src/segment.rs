//! A stabilised piece of cruise and the mean state over it.

use std::sync::Arc;

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
