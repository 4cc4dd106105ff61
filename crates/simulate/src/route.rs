//! The plan of one flight.

use flight::Timestamp;
use serde::{Deserialize, Serialize};

use crate::aircraft::Switch;

/// One flight of a plan. Times are seconds since the start of the recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlightPlan {
    /// Flight number, as `FLIGHT` in the report.
    pub flight: String,
    /// Start of the recording.
    #[serde(with = "crate::effect::timestamp")]
    pub start: Timestamp,
    /// Length of the recording, s.
    pub duration_s: f64,
    /// Latitude and longitude of the top of climb and of each waypoint, degrees; two at least. Straight on after the last.
    pub waypoints: Vec<(f64, f64)>,
    /// Pressure altitude at the start, ft.
    pub pressure_altitude_ft: f64,
    /// Mach number at the start.
    pub mach: f64,
    /// Its mass.
    pub loading: Loading,
    /// Center of gravity with the fuel at the start of the recording, %MAC.
    pub center_of_gravity_percent_mac: f64,
    /// Shift of the center of gravity per hour of flight, %MAC.
    #[serde(default)]
    pub center_of_gravity_travel_percent_mac_h: f64,
    /// Step climbs, descents and speed changes, in order of time.
    #[serde(default)]
    pub changes: Vec<Change>,
    /// Stretches with anti-ice on: from and to, s.
    #[serde(default)]
    pub anti_ice: Vec<(f64, f64)>,
}

/// Mass of a flight, kg: the true one, whatever is on the load sheet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Loading {
    /// By zero-fuel mass and fuel at engine start.
    ZeroFuel {
        /// Zero-fuel mass, kg.
        zero_fuel_mass_kg: f64,
        /// Fuel on board at engine start, kg.
        fuel_on_board_kg: f64,
    },
    /// By gross mass when the recording starts.
    AtRecording {
        /// Gross mass, kg.
        gross_mass_kg: f64,
        /// Fuel on board at engine start, kg.
        fuel_on_board_kg: f64,
    },
}

impl Loading {
    /// Fuel on board at engine start, kg.
    #[must_use]
    pub const fn fuel_on_board_kg(&self) -> f64 {
        match self {
            Self::ZeroFuel { fuel_on_board_kg, .. }
            | Self::AtRecording { fuel_on_board_kg, .. } => *fuel_on_board_kg,
        }
    }
}

/// A new target of the autopilot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Change {
    /// Climb or descend.
    PressureAltitude {
        /// When, s.
        at_s: f64,
        /// Where to, ft.
        feet: f64,
    },
    /// Fly faster or slower.
    Mach {
        /// When, s.
        at_s: f64,
        /// New Mach number.
        mach: f64,
    },
}

impl Change {
    /// When, s.
    #[must_use]
    pub const fn at_s(&self) -> f64 {
        match self {
            Self::PressureAltitude { at_s, .. } | Self::Mach { at_s, .. } => *at_s,
        }
    }
}

/// Gains and limits of the autopilot and autothrottle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Autopilot {
    /// Vertical speed commanded per meter of altitude error, 1/s.
    pub altitude_gain_s: f64,
    /// Time constant of pitch, s.
    pub pitch_time_s: f64,
    /// Largest commanded vertical speed, ft/min.
    pub vertical_speed_ft_min: f64,
    /// Natural frequency of Mach hold, rad/s.
    pub mach_frequency_rad_s: f64,
    /// Damping ratio of Mach hold.
    pub mach_damping: f64,
    /// Time constant of the filter of the measured Mach number, s.
    pub mach_filter_s: f64,
    /// Rate of a speed change, Mach per minute.
    pub mach_rate_per_min: f64,
    /// Time constant of engine thrust, s.
    pub engine_time_s: f64,
    /// Bank in turns, degrees.
    pub bank_deg: f64,
    /// Time constant of roll, s.
    pub roll_time_s: f64,
}

impl Default for Autopilot {
    /// Our choice: a quiet transport autopilot.
    fn default() -> Self {
        Self {
            altitude_gain_s: 0.08,
            pitch_time_s: 2.0,
            vertical_speed_ft_min: 600.0,
            mach_frequency_rad_s: 0.03,
            mach_damping: 0.9,
            mach_filter_s: 8.0,
            mach_rate_per_min: 0.012,
            engine_time_s: 3.0,
            bank_deg: 20.0,
            roll_time_s: 3.0,
        }
    }
}

/// Which properties of the Earth the truth has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Earth {
    /// Lift grows in a turn.
    pub load_factor: Switch,
    /// Gravity by latitude and height instead of standard gravity.
    pub local_gravity: Switch,
    /// Lift saved by motion about the Earth's axis and center.
    pub rotating_earth: Switch,
    /// Pressure surfaces slope with the geostrophic wind.
    pub isobaric_slope: Switch,
    /// Coriolis force on the cross-wind, along the path.
    pub coriolis_along_path: Switch,
}

impl Earth {
    /// All of it.
    #[must_use]
    pub const fn full() -> Self {
        Self {
            load_factor: Switch::On,
            local_gravity: Switch::On,
            rotating_earth: Switch::On,
            isobaric_slope: Switch::On,
            coriolis_along_path: Switch::On,
        }
    }

    /// As in a performance model: standard gravity, and slope with Coriolis force, which cancel.
    #[must_use]
    pub const fn plain() -> Self {
        Self {
            load_factor: Switch::Off,
            local_gravity: Switch::Off,
            rotating_earth: Switch::Off,
            ..Self::full()
        }
    }
}
