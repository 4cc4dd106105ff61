//! What sensors and the true states see of an instant.

use super::{Flying, Instant, forces};
use crate::state::TrueState;

impl Flying<'_> {
    pub(super) fn instant(&self) -> Instant {
        let forces = &self.forces;
        Instant {
            static_pressure_pa: forces.static_pressure_pa,
            mach: forces.mach,
            total_air_temperature_k: forces.total_air_temperature_k,
            ground_speed_m_s: forces.ground_speed_m_s,
            roll_deg: self.roll_trim_deg() + self.steering.roll_deg(),
            drift_deg: (forces.drift_rad + self.drift_wobble_rad).to_degrees(),
            fuel_flow_kg_s: forces.fuel_flow_kg_s,
        }
    }

    pub(super) fn true_state(&self) -> TrueState {
        let forces = &self.forces;
        let place = self.steering.place();
        let drift_rad = forces.drift_rad + self.drift_wobble_rad;
        let rotors = forces::rotors(self.setup, &self.motion, forces);
        TrueState {
            time_s: self.time_s,
            pressure_altitude_m: self.motion.pressure_altitude_m,
            geometric_altitude_m: self.motion.geometric_altitude_m,
            static_pressure_pa: forces.static_pressure_pa,
            static_air_temperature_k: forces.static_air_temperature_k,
            mach: forces.mach,
            true_airspeed_m_s: forces.true_airspeed_m_s,
            smooth_airspeed_m_s: self.motion.smooth_airspeed_m_s,
            ground_speed_m_s: forces.ground_speed_m_s,
            acceleration_m_s2: forces.acceleration_m_s2 + self.wind_change_m_s2,
            vertical_speed_m_s: self.motion.vertical_speed_m_s,
            climb_angle_rad: forces.climb_angle_rad,
            roll_deg: self.roll_trim_deg() + self.steering.roll_deg(),
            drift_deg: drift_rad.to_degrees(),
            true_heading_deg: (place.track_rad() - drift_rad).to_degrees().rem_euclid(360.0),
            latitude_deg: place.latitude_rad().to_degrees(),
            longitude_deg: place.longitude_rad().to_degrees(),
            tail_wind_m_s: forces.tail_wind_m_s,
            wind_from_left_m_s: forces.wind_from_left_m_s,
            turbulence_m_s: self.gust_sigma_m_s,
            mass_kg: self.motion.mass_kg,
            fuel_used_kg: self.motion.fuel_used_kg,
            center_of_gravity_percent_mac: forces.center_of_gravity_percent_mac,
            effective_gravity_m_s2: self.here.effective_gravity_m_s2,
            lift_coefficient: forces.lift_coefficient,
            drag_coefficient: forces.drag_coefficient,
            drag_n: forces.drag_n,
            thrust_n: self.motion.thrust_n,
            fuel_flow_kg_s: forces.fuel_flow_kg_s,
            n1_percent: rotors.n1_percent,
            n2_percent: rotors.n2_percent,
            exhaust_gas_temperature_k: rotors.exhaust_gas_temperature_k,
            anti_ice: forces.anti_ice,
            fuel_temperature_k: self.motion.fuel_temperature_k,
        }
    }
}
