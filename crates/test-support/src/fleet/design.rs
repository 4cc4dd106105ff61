//! What is flown: loading, levels, Mach numbers, wind, dates.

use super::aircraft::{G0, R, WING_M2, isa};
use super::{Random, Setup};

/// One segment as it is flown, before effects and sensors.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// Number of its flight.
    pub(super) flight: usize,
    pub(super) mach: f64,
    /// Pressure altitude, m.
    pub(super) h: f64,
    /// K.
    pub(super) sat: f64,
    /// kg.
    pub(super) mass: f64,
    /// kg, since the start of the flight.
    pub(super) fuel_used: f64,
    /// Degrees, as track and roll angle.
    pub(super) lat: f64,
    pub(super) track: f64,
    pub(super) roll: f64,
    /// Along the path, m/s².
    pub(super) acc: f64,
    /// Centre of gravity, percent of the mean aerodynamic chord.
    pub(super) cg: f64,
    /// Since the first flight of the fleet.
    pub(super) years: f64,
    /// Whether anti-ice is on where it is warm enough for ice.
    pub(super) anti_ice_flight: bool,
    /// Wind to the left of the track, and ground speed, m/s.
    pub(super) cross: f64,
    pub(super) ground_speed: f64,
}

/// Draws the segments of a fleet, flight by flight.
pub(super) fn design(random: &mut Random, setup: &Setup) -> Vec<Row> {
    let mut rows = Vec::new();
    for flight in 0..setup.flights {
        let low = random.uniform(0.0, 1.0) < 0.30;
        let zfw = random.uniform(9950.0, 11_300.0);
        let ramp = random.uniform(3200.0, 5800.0_f64).min(16_300.0 - zfw);
        let mut level =
            if low { random.uniform(250.0, 370.0) } else { random.uniform(370.0, 450.0) };
        let m0 = if low { random.uniform(0.56, 0.78) } else { random.uniform(0.78, 0.895) };
        let deviation = random.normal(0.0, 5.0);
        let years = 1.6 * (flight as f64 + random.uniform(0.0, 1.0)) / setup.flights as f64;
        let mut lat = random.uniform(25.0, 58.0);
        let mut track: f64 = random.uniform(0.0, 360.0);
        let cg0 = random.uniform(19.0, 33.0);
        let mut wind = [random.normal(18.0, 14.0), random.normal(0.0, 12.0)];
        let anti_ice_flight = random.uniform(0.0, 1.0) < 0.8;
        let mut used = random.uniform(350.0, 700.0);
        for s in 0..setup.segments {
            if s > 0 && random.uniform(0.0, 1.0) < 0.22 {
                level = (level + 20.0_f64).min(470.0);
            }
            let jump = if random.uniform(0.0, 1.0) < 0.15 { random.normal(0.0, 0.04) } else { 0.0 };
            let mut mach = (m0 + random.normal(0.0, 0.018) + jump).clamp(0.55, 0.90);
            used += random.uniform(120.0, (ramp - 900.0) / setup.segments as f64 * 1.4);
            used = used.min(ramp - 500.0);
            let h = level * 30.48;
            let (t, p) = isa(h);
            let mass = zfw + ramp - used;
            let lift = |mach: f64| mass * G0 / (0.7 * p * mach * mach * WING_M2);
            while lift(mach) > 0.60 {
                mach += 0.02;
            }
            mach = mach.min(0.905);
            lat = (lat + track.to_radians().cos() * random.uniform(0.3, 1.2)).clamp(15.0, 65.0);
            wind = [wind[0] + random.normal(0.0, 5.0), wind[1] + random.normal(0.0, 5.0)];
            if random.uniform(0.0, 1.0) < 0.15 {
                track = (track + random.normal(0.0, 35.0)).rem_euclid(360.0);
            }
            let roll = if random.uniform(0.0, 1.0) > 0.06 {
                random.normal(0.0, 0.45)
            } else {
                random.uniform(8.0, 25.0) * if random.uniform(0.0, 1.0) < 0.5 { 1.0 } else { -1.0 }
            };
            let sat = t + deviation + random.normal(0.0, 1.2);
            let tr = track.to_radians();
            let tas = mach * (1.4 * R * sat).sqrt();
            rows.push(Row {
                flight,
                mach,
                h,
                sat,
                mass,
                fuel_used: used,
                lat,
                track,
                roll,
                acc: random.normal(0.0, 0.0045),
                cg: cg0 + 2.0 * (used / 3000.0 - 0.5) + random.normal(0.0, 0.3),
                years,
                anti_ice_flight,
                cross: -(wind[0] * tr.cos() - wind[1] * tr.sin()),
                ground_speed: tas + wind[0] * tr.sin() + wind[1] * tr.cos(),
            });
        }
    }
    rows
}
