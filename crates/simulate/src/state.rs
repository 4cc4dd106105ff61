//! True states, and the balances of energy and fuel that a flight must close.

use serde::{Deserialize, Serialize};

use crate::terms::MAXIMUM_ENGINES;

/// Temperature of the fuel at engine start: that of the ISA at sea level, K.
pub(crate) const FUEL_TEMPERATURE_AT_START_K: f64 = atmos::constants::SEA_LEVEL_TEMPERATURE_K;

/// The true state at one instant, independent of the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrueState {
    /// Time since the start of the recording, s.
    pub time_s: f64,
    /// Pressure altitude, m.
    pub pressure_altitude_m: f64,
    /// Geometric altitude, m.
    pub geometric_altitude_m: f64,
    /// Static pressure, Pa.
    pub static_pressure_pa: f64,
    /// Static air temperature, K.
    pub static_air_temperature_k: f64,
    /// Mach number.
    pub mach: f64,
    /// True airspeed with gusts, m/s.
    pub true_airspeed_m_s: f64,
    /// Airspeed relative to the mean wind, without gusts, m/s.
    pub smooth_airspeed_m_s: f64,
    /// Ground speed, m/s.
    pub ground_speed_m_s: f64,
    /// Rate of the airspeed relative to the mean wind, m/s².
    pub acceleration_m_s2: f64,
    /// Rate of pressure altitude, m/s.
    pub vertical_speed_m_s: f64,
    /// Climb angle relative to the air, with the slope of the pressure surface and vertical wind, rad.
    pub climb_angle_rad: f64,
    /// Roll angle, degrees.
    pub roll_deg: f64,
    /// Drift angle, track minus heading, degrees.
    pub drift_deg: f64,
    /// True heading, degrees from north.
    pub true_heading_deg: f64,
    /// Latitude, degrees.
    pub latitude_deg: f64,
    /// Longitude, degrees.
    pub longitude_deg: f64,
    /// Wind along the track, m/s.
    pub tail_wind_m_s: f64,
    /// Wind from the left of the track, m/s.
    pub wind_from_left_m_s: f64,
    /// Standard deviation of gusts, m/s.
    pub turbulence_m_s: f64,
    /// Gross mass, kg.
    pub mass_kg: f64,
    /// Fuel used since engine start, kg.
    pub fuel_used_kg: f64,
    /// Center of gravity, %MAC.
    pub center_of_gravity_percent_mac: f64,
    /// Acceleration that lift has to carry, m/s².
    pub effective_gravity_m_s2: f64,
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Drag coefficient.
    pub drag_coefficient: f64,
    /// Drag, N.
    pub drag_n: f64,
    /// Thrust of all engines, N.
    pub thrust_n: f64,
    /// Fuel flow by engine, kg/s.
    pub fuel_flow_kg_s: [f64; MAXIMUM_ENGINES],
    /// Low-pressure rotor speed by engine, %.
    pub n1_percent: [f64; MAXIMUM_ENGINES],
    /// High-pressure rotor speed by engine, %.
    pub n2_percent: [f64; MAXIMUM_ENGINES],
    /// Exhaust gas temperature by engine, K.
    pub exhaust_gas_temperature_k: [f64; MAXIMUM_ENGINES],
    /// Whether anti-ice is on.
    pub anti_ice: bool,
    /// Temperature of the fuel in the tanks, K.
    pub fuel_temperature_k: f64,
}

/// Work of each force along the airspeed, per mass, over the recording; trapezoids over the flown steps. J/kg.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyBook {
    /// Work of thrust.
    pub thrust_j_kg: f64,
    /// Work of drag, negative.
    pub drag_j_kg: f64,
    /// Work of gravity: climbing relative to the air, negative.
    pub gravity_j_kg: f64,
    /// Work of the Coriolis force on the wind.
    pub coriolis_j_kg: f64,
    /// Work of the wind's change along the path.
    pub wind_change_j_kg: f64,
    /// Gain of kinetic energy relative to the mean wind.
    pub kinetic_gain_j_kg: f64,
}

impl EnergyBook {
    /// Residual of the balance, relative to the work of thrust.
    #[must_use]
    pub fn residual(&self) -> f64 {
        (self.kinetic_gain_j_kg
            - self.thrust_j_kg
            - self.drag_j_kg
            - self.gravity_j_kg
            - self.coriolis_j_kg
            - self.wind_change_j_kg)
            / self.thrust_j_kg
    }
}

/// Fuel over the recording, kg.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MassBook {
    /// Loss of mass.
    pub mass_lost_kg: f64,
    /// Integral of the fuel flows, by trapezoids over the flown steps.
    pub fuel_flow_integral_kg: f64,
}

impl MassBook {
    /// Residual of the balance, relative to the loss of mass.
    #[must_use]
    pub fn residual(&self) -> f64 {
        (self.mass_lost_kg - self.fuel_flow_integral_kg) / self.mass_lost_kg
    }
}
