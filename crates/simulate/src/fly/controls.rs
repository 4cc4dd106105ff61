//! Autopilot and autothrottle.

use units::PressureAltitude;
use units::convert::{METERS_PER_SECOND_PER_FOOT_PER_MINUTE, STANDARD_GRAVITY_M_S2};

use super::forces::{Forces, Motion};
use crate::aircraft::AircraftTruth;
use crate::route::{Autopilot, Change, FlightPlan};

/// Least thrust over maximum thrust.
const IDLE: f64 = 0.05;

/// Altitude hold through pitch, Mach hold through thrust.
#[derive(Clone, Debug)]
pub(crate) struct Controls {
    /// Changes to come, the next one last.
    changes: Vec<Change>,
    altitude_target_m: f64,
    mach_target: f64,
    /// Target, which moves at the autopilot's rate.
    mach_wanted: f64,
    mach_step: f64,
    mach_filtered: f64,
    /// Thrust over mass that the integrator holds, m/s².
    integral_m_s2: f64,
    proportional_s: f64,
    integral_per_s2: f64,
    filter_share: f64,
    engine_share: f64,
    pitch_share: f64,
    altitude_gain_s: f64,
    vertical_speed_limit_m_s: f64,
    lift_acceleration_m_s2: f64,
}

impl Controls {
    pub(crate) fn start(autopilot: &Autopilot, plan: &FlightPlan, step_s: f64) -> Self {
        let share = |time_s: f64| 1.0 - (-step_s / time_s).exp();
        let mut changes = plan.changes.clone();
        changes.sort_by(|a, b| b.at_s().total_cmp(&a.at_s()));
        let frequency = autopilot.mach_frequency_rad_s;
        Self {
            changes,
            altitude_target_m: PressureAltitude::feet(plan.pressure_altitude_ft).to_meters(),
            mach_target: plan.mach,
            mach_wanted: plan.mach,
            mach_step: autopilot.mach_rate_per_min / 60.0 * step_s,
            mach_filtered: plan.mach,
            integral_m_s2: 0.0,
            // s² + 2ζω·s + ω² of the speed error.
            proportional_s: 2.0 * autopilot.mach_damping * frequency,
            integral_per_s2: frequency * frequency,
            filter_share: share(autopilot.mach_filter_s),
            engine_share: share(autopilot.engine_time_s),
            pitch_share: share(autopilot.pitch_time_s),
            altitude_gain_s: autopilot.altitude_gain_s,
            vertical_speed_limit_m_s: autopilot.vertical_speed_ft_min
                * METERS_PER_SECOND_PER_FOOT_PER_MINUTE,
            lift_acceleration_m_s2: 0.0,
        }
    }

    /// Initialises the integrator for level flight.
    pub(crate) const fn trim(&mut self, thrust_over_mass_m_s2: f64, mach: f64) {
        self.integral_m_s2 = thrust_over_mass_m_s2;
        self.mach_filtered = mach;
    }

    /// The present targets of the autopilot.
    pub(crate) const fn mach_target(&self) -> f64 {
        self.mach_target
    }

    /// Vertical acceleration of the step before, which the wing carries, m/s².
    pub(crate) const fn lift_acceleration_m_s2(&self) -> f64 {
        self.lift_acceleration_m_s2
    }

    /// Thrust, pitch, vertical speed and pressure altitude one step later.
    pub(crate) fn advance(
        &mut self,
        motion: &mut Motion,
        forces: &Forces,
        aircraft: &AircraftTruth,
        time_s: f64,
        step_s: f64,
    ) {
        while let Some(change) = self.changes.last()
            && change.at_s() <= time_s
        {
            match *change {
                Change::PressureAltitude { feet, .. } => {
                    self.altitude_target_m = PressureAltitude::feet(feet).to_meters();
                }
                Change::Mach { mach, .. } => self.mach_wanted = mach,
            }
            self.changes.pop();
        }
        self.mach_target +=
            (self.mach_wanted - self.mach_target).clamp(-self.mach_step, self.mach_step);
        self.mach_filtered += (forces.mach - self.mach_filtered) * self.filter_share;
        let speed_error_m_s = (self.mach_target - self.mach_filtered) * forces.speed_of_sound_m_s;

        let speed_m_s = motion.smooth_airspeed_m_s;
        let limit = self.vertical_speed_limit_m_s;
        let climb_m_s = (self.altitude_gain_s
            * (self.altitude_target_m - motion.pressure_altitude_m))
            .clamp(-limit, limit);

        // Thrust for the climb is fed forward, ahead of the error that the climb would make.
        let wanted_n = motion.mass_kg
            * (self.integral_m_s2
                + self.proportional_s * speed_error_m_s
                + STANDARD_GRAVITY_M_S2 * climb_m_s / speed_m_s);
        let command_n = wanted_n.clamp(IDLE * forces.maximum_thrust_n, forces.maximum_thrust_n);
        // The integrator waits while the engines are at a stop.
        if (command_n - wanted_n).abs() < 1.0 {
            self.integral_m_s2 += self.integral_per_s2 * speed_error_m_s * step_s;
        }
        motion.thrust_n += (command_n - motion.thrust_n) * self.engine_share;

        // Heave: lift follows pitch, sink and gust; implicit in the vertical speed, whose own mode is as fast as a step.
        motion.pitch_rad += (climb_m_s / speed_m_s - motion.pitch_rad) * self.pitch_share;
        let per_rad_m_s2 = forces.dynamic_pressure_pa
            * aircraft.airframe.wing_area_m2
            * aircraft.airframe.lift_curve_slope_per_rad
            / motion.mass_kg;
        let before = motion.vertical_speed_m_s;
        let pushed = motion.pitch_rad + forces.upward_air_m_s / speed_m_s;
        motion.vertical_speed_m_s =
            (before + step_s * per_rad_m_s2 * pushed) / (1.0 + step_s * per_rad_m_s2 / speed_m_s);
        self.lift_acceleration_m_s2 = (motion.vertical_speed_m_s - before) / step_s;
        motion.pressure_altitude_m += 0.5 * step_s * (before + motion.vertical_speed_m_s);
    }
}
