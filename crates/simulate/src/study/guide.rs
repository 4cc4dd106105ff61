//! A flight-planning guide made from a truth, with a known drag error.

use serde::Serialize;
use units::{Mach, Mass, OutOfDomain, PressureAltitude, TrueAirspeed};

use crate::aircraft::{AircraftTruth, TruthPhysics};
use crate::terms::Terms;
use crate::trim::{TrimPoint, trim_with};

/// Relative error of the guide's drag over Mach number and lift coefficient.
///
/// ```text
/// e = e0 + eM·(M − M0) + eC·(CL − C0)                               [virtual.17]
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragError {
    /// At M0 and C0.
    pub constant: f64,
    /// Per unit Mach number.
    pub per_mach: f64,
    /// M0.
    pub mach: f64,
    /// Per unit lift coefficient.
    pub per_lift_coefficient: f64,
    /// C0.
    pub lift_coefficient: f64,
}

impl DragError {
    /// No error: the guide is the truth on the standard day.
    #[must_use]
    pub const fn none() -> Self {
        Self {
            constant: 0.0,
            per_mach: 0.0,
            mach: 0.7,
            per_lift_coefficient: 0.0,
            lift_coefficient: 0.32,
        }
    }

    /// The error of the study: e = −0.05 − 0.30·(M − 0.70) + 0.25·(CL − 0.32).
    #[must_use]
    pub const fn study() -> Self {
        Self {
            constant: -0.05,
            per_mach: -0.30,
            mach: 0.70,
            per_lift_coefficient: 0.25,
            lift_coefficient: 0.32,
        }
    }

    /// Its value.
    #[must_use]
    pub fn at(&self, mach: f64, lift_coefficient: f64) -> f64 {
        self.constant
            + self.per_mach * (mach - self.mach)
            + self.per_lift_coefficient * (lift_coefficient - self.lift_coefficient)
    }
}

/// Grid of the guide's rows.
#[derive(Clone, Debug, PartialEq)]
pub struct GuideGrid {
    /// Gross masses, lb.
    pub weights_lb: Vec<f64>,
    /// Pressure altitudes, ft.
    pub pressure_altitudes_ft: Vec<f64>,
    /// True airspeeds, kt.
    pub true_airspeeds_kt: Vec<f64>,
    /// Largest lift coefficient of a row.
    pub largest_lift_coefficient: f64,
}

impl GuideGrid {
    /// The paper's ranges: 26 000 to 36 000 lb by 2 000, 5 000 to 49 000 ft (by 2 000, our choice), 291 to 470 kt (seven
    /// airspeeds, our choice).
    #[must_use]
    pub fn paper() -> Self {
        Self {
            weights_lb: (0..6).map(|i| 26_000.0 + 2_000.0 * f64::from(i)).collect(),
            pressure_altitudes_ft: (0..23).map(|i| 5_000.0 + 2_000.0 * f64::from(i)).collect(),
            true_airspeeds_kt: vec![291.0, 321.0, 351.0, 381.0, 411.0, 441.0, 470.0],
            largest_lift_coefficient: 0.70,
        }
    }
}

/// A row of the guide, standard day.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GuideRow {
    /// Gross mass, lb.
    pub weight_lb: f64,
    /// Pressure altitude, ft.
    pub pressure_altitude_ft: f64,
    /// True airspeed, kt.
    pub true_airspeed_kt: f64,
    /// Fuel flow of all engines, lb/h.
    pub fuel_flow_lb_h: f64,
}

/// The guide's rows, and how many points of the grid the aircraft cannot fly (lift, thrust, Mach number or calibrated
/// airspeed): a guide leaves those blank.
///
/// # Errors
/// [`OutOfDomain`] for a pressure altitude outside the atmosphere.
pub fn flight_planning_guide(
    aircraft: &AircraftTruth,
    physics: TruthPhysics,
    grid: &GuideGrid,
    error: &DragError,
) -> Result<(Vec<GuideRow>, usize), OutOfDomain> {
    let terms = Terms::new(aircraft, physics);
    let mut rows = Vec::new();
    let mut blank = 0;
    for weight_lb in &grid.weights_lb {
        for pressure_altitude_ft in &grid.pressure_altitudes_ft {
            let pressure_altitude = PressureAltitude::feet(*pressure_altitude_ft);
            let sat = atmos::isa::temperature(pressure_altitude)?;
            let static_pressure = atmos::isa::pressure(pressure_altitude)?;
            for true_airspeed_kt in &grid.true_airspeeds_kt {
                let true_airspeed = TrueAirspeed::knots(*true_airspeed_kt);
                let mach: Mach = atmos::airspeed::true_airspeed_to_mach(true_airspeed, sat);
                let point = TrimPoint {
                    mass: Mass::pounds(*weight_lb),
                    pressure_altitude,
                    mach,
                    sat,
                    center_of_gravity_percent_mac: aircraft.airframe.trim.reference_percent_mac,
                };
                let trimmed = trim_with(aircraft, &terms, &point)?;
                let airspeed = atmos::airspeed::mach_to_calibrated_airspeed(mach, static_pressure);
                let envelope = &aircraft.envelope;
                if trimmed.lift_coefficient > grid.largest_lift_coefficient
                    || trimmed.thrust_n > trimmed.maximum_thrust_n
                    || mach.value() > envelope.maximum_operating_mach
                    || airspeed.to_knots() > envelope.maximum_operating_calibrated_airspeed_kt
                {
                    blank += 1;
                    continue;
                }
                let wrong = 1.0 + error.at(mach.value(), trimmed.lift_coefficient);
                // Fuel for the wrong drag: the truth's own engine at another thrust.
                let fuel_flow = crate::trim::fuel_flow_at_thrust(
                    aircraft,
                    &terms,
                    &point,
                    trimmed.thrust_n * wrong,
                )?;
                rows.push(GuideRow {
                    weight_lb: *weight_lb,
                    pressure_altitude_ft: *pressure_altitude_ft,
                    true_airspeed_kt: *true_airspeed_kt,
                    fuel_flow_lb_h: (10.0 * fuel_flow.to_pounds_per_hour()).round() / 10.0,
                });
            }
        }
    }
    Ok((rows, blank))
}

/// The rows as the text of a guide file.
#[must_use]
pub fn guide_csv(rows: &[GuideRow]) -> String {
    let mut text = String::from("weight_lb,pressure_altitude_ft,true_airspeed_kt,fuel_flow_lb_h\n");
    for row in rows {
        let numbers =
            [row.weight_lb, row.pressure_altitude_ft, row.true_airspeed_kt, row.fuel_flow_lb_h];
        text.push_str(&numbers.map(|number| number.to_string()).join(","));
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aircraft::Preset;

    #[test]
    fn plain_guide_gives_the_drag_error_back() {
        // Inverting each row by Ghazi et al., equation (14), with the truth's own TSFC law must give CD·(1 + e).
        let aircraft = AircraftTruth::preset(Preset::CitationX).unwrap();
        let plain = TruthPhysics::plain();
        let error = DragError::study();
        let (rows, blank) =
            flight_planning_guide(&aircraft, plain, &GuideGrid::paper(), &error).unwrap();
        assert!(rows.len() > 400, "{}", rows.len());
        assert_eq!(rows.len() + blank, 6 * 23 * 7);
        for row in &rows {
            let pressure_altitude = PressureAltitude::feet(row.pressure_altitude_ft);
            let sat_k = atmos::isa::temperature(pressure_altitude).unwrap().to_kelvin();
            let static_pressure_pa = atmos::isa::pressure(pressure_altitude).unwrap().to_pascals();
            let speed_m_s = row.true_airspeed_kt * 1852.0 / 3600.0;
            let mach = speed_m_s / (1.4 * 287.05287 * sat_k).sqrt();
            let area_pa_m2 = 0.7 * static_pressure_pa * mach * mach * 48.96;
            let lift_coefficient = row.weight_lb * 0.45359237 * 9.80665 / area_pa_m2;
            let tsfc = 1.0242e-5 * (sat_k / 288.15).sqrt() * (1.0 + mach).powf(1.25);
            let found = row.fuel_flow_lb_h * 0.45359237 / 3600.0 / (tsfc * area_pa_m2);
            let truth = aircraft.drag_coefficient(
                lift_coefficient,
                Mach::new(mach),
                &aircraft.reference_conditions(),
                plain,
            );
            let expected =
                truth * (1.0 - 0.05 - 0.30 * (mach - 0.70) + 0.25 * (lift_coefficient - 0.32));
            // Rounding to 0.1 lb/h: 0.01 % at most.
            assert!((found / expected - 1.0).abs() < 1.2e-4, "{row:?}: {found} {expected}");
        }
        let text = guide_csv(&rows);
        assert_eq!(text.lines().count(), rows.len() + 1);
    }
}
