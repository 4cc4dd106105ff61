//! Steady level flight at one point: the truth without time.

use serde::Serialize;
use units::convert::STANDARD_GRAVITY_M_S2;
use units::{FuelFlowTotal, Mach, Mass, OutOfDomain, PressureAltitude, Temperature};

use crate::aircraft::{
    AircraftTruth, HEATING_FACTOR, TruthPhysics, maximum_thrust_n, n2_percent, pressure_rise,
};
use crate::state::FUEL_TEMPERATURE_AT_START_K;
use crate::terms::{DragInputs, FuelInputs, MAXIMUM_ENGINES, Terms};

/// A point to trim at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrimPoint {
    /// Gross mass.
    pub mass: Mass,
    /// Pressure altitude.
    pub pressure_altitude: PressureAltitude,
    /// Mach number.
    pub mach: Mach,
    /// Static air temperature.
    pub sat: Temperature,
    /// Center of gravity, %MAC.
    pub center_of_gravity_percent_mac: f64,
}

/// A trimmed point: level, unaccelerated, wings level, still air, standard gravity, engines alike.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Trimmed {
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Drag coefficient.
    pub drag_coefficient: f64,
    /// Reynolds number over the mean aerodynamic chord.
    pub reynolds_number: f64,
    /// True airspeed, m/s.
    pub true_airspeed_m_s: f64,
    /// Thrust of all engines, which is the drag, N.
    pub thrust_n: f64,
    /// Maximum thrust of all engines there, N.
    pub maximum_thrust_n: f64,
    /// Fuel flow of all engines, kg/s.
    pub fuel_flow_kg_s: f64,
    /// High-pressure rotor speed, %.
    pub n2_percent: f64,
    /// Static pressure over that at sea level.
    pub pressure_ratio: f64,
}

/// Why a point cannot be flown level.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrimError {
    /// Outside the atmosphere.
    #[error(transparent)]
    Atmosphere(#[from] OutOfDomain),
    /// More lift than the wing can give.
    #[error("lift coefficient {lift_coefficient} above {maximum}")]
    LiftCoefficient {
        /// Needed.
        lift_coefficient: f64,
        /// Largest.
        maximum: f64,
    },
    /// More thrust than the engines can give.
    #[error("thrust {thrust_n} N above {maximum_n} N")]
    Thrust {
        /// Needed, N.
        thrust_n: f64,
        /// Largest, N.
        maximum_n: f64,
    },
}

impl AircraftTruth {
    /// Trims the aircraft, without effects.
    ///
    /// # Errors
    /// [`TrimError`] outside the atmosphere's or the aircraft's limits.
    pub fn trim(&self, point: &TrimPoint, physics: TruthPhysics) -> Result<Trimmed, TrimError> {
        let trimmed = trim_with(self, &Terms::new(self, physics), point)?;
        let maximum = self.envelope.maximum_lift_coefficient;
        if trimmed.lift_coefficient > maximum {
            return Err(TrimError::LiftCoefficient {
                lift_coefficient: trimmed.lift_coefficient,
                maximum,
            });
        }
        if trimmed.thrust_n > trimmed.maximum_thrust_n {
            return Err(TrimError::Thrust {
                thrust_n: trimmed.thrust_n,
                maximum_n: trimmed.maximum_thrust_n,
            });
        }
        Ok(trimmed)
    }
}

/// The air at a point, before any drag is known.
struct Air {
    static_pressure_pa: f64,
    pressure_ratio: f64,
    temperature_ratio: f64,
    total_temperature_ratio: f64,
    dynamic_pressure_pa: f64,
    true_airspeed_m_s: f64,
    reynolds_number: f64,
    maximum_thrust_n: f64,
}

fn air_at(aircraft: &AircraftTruth, point: &TrimPoint) -> Result<Air, OutOfDomain> {
    let static_pressure = atmos::isa::pressure(point.pressure_altitude)?;
    let true_airspeed = atmos::airspeed::mach_to_true_airspeed(point.mach, point.sat);
    let density = atmos::isa::density(static_pressure, point.sat);
    let temperature_ratio = atmos::isa::temperature_ratio(point.sat);
    let pressure_ratio = atmos::isa::pressure_ratio(static_pressure);
    let mach = point.mach.value();
    let heating = 1.0 + HEATING_FACTOR * mach * mach;
    let engine = &aircraft.engine;
    Ok(Air {
        static_pressure_pa: static_pressure.to_pascals(),
        pressure_ratio,
        temperature_ratio,
        total_temperature_ratio: temperature_ratio * heating,
        dynamic_pressure_pa: atmos::airspeed::dynamic_pressure(density, true_airspeed).to_pascals(),
        true_airspeed_m_s: true_airspeed.to_meters_per_second(),
        reynolds_number: atmos::viscosity::reynolds_number(
            density,
            true_airspeed,
            aircraft.airframe.mean_aerodynamic_chord_m,
            atmos::viscosity::dynamic_viscosity(point.sat),
        ),
        maximum_thrust_n: f64::from(engine.count)
            * maximum_thrust_n(
                engine,
                mach,
                temperature_ratio * heating,
                pressure_ratio * pressure_rise(heating),
            ),
    })
}

fn fuel_flow_kg_s(
    aircraft: &AircraftTruth,
    terms: &Terms,
    mach: f64,
    air: &Air,
    thrust_n: f64,
) -> f64 {
    let engine = &aircraft.engine;
    let inputs = FuelInputs {
        mach,
        temperature_ratio: air.temperature_ratio,
        static_pressure_pa: air.static_pressure_pa,
        pressure_ratio: air.pressure_ratio,
        thrust_n,
        maximum_thrust_n: air.maximum_thrust_n,
        anti_ice: false,
        fuel_temperature_k: FUEL_TEMPERATURE_AT_START_K,
    };
    let shares = [1.0 / f64::from(engine.count); MAXIMUM_ENGINES];
    terms.fuel_flow_kg_s(engine, &inputs, &shares).iter().sum()
}

/// Fuel flow of all engines at a point for a thrust that need not be the drag.
pub(crate) fn fuel_flow_at_thrust(
    aircraft: &AircraftTruth,
    terms: &Terms,
    point: &TrimPoint,
    thrust_n: f64,
) -> Result<FuelFlowTotal, OutOfDomain> {
    let air = air_at(aircraft, point)?;
    let flow = fuel_flow_kg_s(aircraft, terms, point.mach.value(), &air, thrust_n);
    Ok(FuelFlowTotal::kilograms_per_second(flow))
}

/// Trims with terms; limits are not checked.
pub(crate) fn trim_with(
    aircraft: &AircraftTruth,
    terms: &Terms,
    point: &TrimPoint,
) -> Result<Trimmed, OutOfDomain> {
    let air = air_at(aircraft, point)?;
    let mach = point.mach.value();
    let area_pa_m2 = air.dynamic_pressure_pa * aircraft.airframe.wing_area_m2;
    let lift_coefficient = point.mass.to_kilograms() * STANDARD_GRAVITY_M_S2 / area_pa_m2;
    let drag_coefficient = terms.drag_coefficient(
        &aircraft.airframe,
        &DragInputs {
            lift_coefficient,
            mach,
            reynolds_number: air.reynolds_number,
            center_of_gravity_percent_mac: point.center_of_gravity_percent_mac,
            roll_deg: 0.0,
        },
    );
    let thrust_n = drag_coefficient * area_pa_m2;
    Ok(Trimmed {
        lift_coefficient,
        drag_coefficient,
        reynolds_number: air.reynolds_number,
        true_airspeed_m_s: air.true_airspeed_m_s,
        thrust_n,
        maximum_thrust_n: air.maximum_thrust_n,
        fuel_flow_kg_s: fuel_flow_kg_s(aircraft, terms, mach, &air, thrust_n),
        n2_percent: n2_percent(
            &aircraft.engine,
            mach,
            air.total_temperature_ratio,
            air.pressure_ratio,
            thrust_n / f64::from(aircraft.engine.count),
        ),
        pressure_ratio: air.pressure_ratio,
    })
}

#[cfg(test)]
mod tests {
    use units::TrueAirspeed;

    use super::*;
    use crate::aircraft::Preset;

    fn isa(flight_level: f64) -> (PressureAltitude, Temperature) {
        let pressure_altitude = PressureAltitude::feet(100.0 * flight_level);
        (pressure_altitude, atmos::isa::temperature(pressure_altitude).unwrap())
    }

    #[test]
    fn citation_x_against_the_reconstruction_of_the_paper() {
        // Table of the reconstruction (synthetic Citation X, still air, ISA): lb, FL, M, CL, CD, L/D, KTAS, lb/h.
        let aircraft = AircraftTruth::preset(Preset::CitationX).unwrap();
        for (pounds, flight_level, mach, cl, cd, lift_to_drag, knots, pounds_per_hour) in [
            (30_000.0, 430.0, 0.82, 0.357, 0.0289, 12.4, 470.0, 1610.0),
            (30_000.0, 410.0, 0.82, 0.324, 0.0275, 11.8, 470.0, 1688.0),
            (30_000.0, 410.0, 0.88, 0.281, 0.0266, 10.6, 505.0, 1959.0),
            (34_000.0, 430.0, 0.86, 0.368, 0.0298, 12.4, 493.0, 1875.0),
            (32_000.0, 370.0, 0.90, 0.237, 0.0259, 9.1, 516.0, 2447.0),
            (30_000.0, 350.0, 0.75, 0.290, 0.0260, 11.2, 432.0, 1705.0),
            (30_000.0, 250.0, 0.60, 0.288, 0.0256, 11.3, 361.0, 1579.0),
            (26_000.0, 490.0, 0.80, 0.433, 0.0325, 13.3, 459.0, 1275.0),
        ] {
            let (pressure_altitude, sat) = isa(flight_level);
            let point = TrimPoint {
                mass: Mass::pounds(pounds),
                pressure_altitude,
                mach: Mach::new(mach),
                sat,
                center_of_gravity_percent_mac: 27.0,
            };
            let trimmed = aircraft.trim(&point, TruthPhysics::plain()).unwrap();
            let near = |found: f64, expected: f64, tolerance: f64| {
                assert!((found - expected).abs() <= tolerance, "{point:?}: {found} {expected}");
            };
            near(trimmed.lift_coefficient, cl, 6e-4);
            near(trimmed.drag_coefficient, cd, 6e-5);
            near(trimmed.lift_coefficient / trimmed.drag_coefficient, lift_to_drag, 0.06);
            near(TrueAirspeed::meters_per_second(trimmed.true_airspeed_m_s).to_knots(), knots, 0.6);
            let flow = FuelFlowTotal::kilograms_per_second(trimmed.fuel_flow_kg_s);
            near(flow.to_pounds_per_hour(), pounds_per_hour, 1.6);
        }
    }

    #[test]
    fn one_point_by_hand() {
        // Citation X, 13 000 kg, 12 000 m, M 0.80, ISA, everything written out.
        // p = 22632.06·exp(−1000·9.80665/(287.05287·216.65)) = 19330.4 Pa; q = 0.7·p·0.64 = 8660.0 Pa;
        // CL = 13000·9.80665/(q·48.96) = 0.300680.
        // CD0 = 0.0206·1.02 = 0.021012; K = 0.06·(1 + 0.5·0.04) = 0.0612; K·CL² = 0.0055330;
        // Mcr = 0.915 − 0.09·0.000680 − 0.1077 = 0.807239 > 0.80: no wave drag. CD = 0.0265450.
        // F = CD·q·S = 11254.9 N; TSFC = 1.0242e-5·√(216.65/288.15)·1.8^1.25 = 1.85157e-5; Wf = 0.208395 kg/s.
        let aircraft = AircraftTruth::preset(Preset::CitationX).unwrap();
        let point = TrimPoint {
            mass: Mass::kilograms(13_000.0),
            pressure_altitude: PressureAltitude::meters(12_000.0),
            mach: Mach::new(0.80),
            sat: Temperature::kelvin(216.65),
            center_of_gravity_percent_mac: 27.0,
        };
        let trimmed = aircraft.trim(&point, TruthPhysics::plain()).unwrap();
        assert!((trimmed.lift_coefficient - 0.300680).abs() < 2e-6, "{trimmed:?}");
        assert!((trimmed.drag_coefficient - 0.0265450).abs() < 2e-7, "{trimmed:?}");
        assert!((trimmed.thrust_n - 11255.0).abs() < 0.2, "{trimmed:?}");
        assert!((trimmed.fuel_flow_kg_s - 0.208395).abs() < 5e-6, "{trimmed:?}");
    }

    #[test]
    fn published_performance_of_the_citation_x() {
        // aeropedia.com.au: maximum cruise M 0.91 at 37 000 ft; certified ceiling 51 000 ft. AIN, July 2014: FL450 at M
        // 0.86 after take-off some 500 lb below maximum take-off mass.
        let aircraft = AircraftTruth::preset(Preset::CitationX).unwrap();
        let fits = |pounds, flight_level, mach| {
            let (pressure_altitude, sat) = isa(flight_level);
            let mass = Mass::pounds(pounds);
            let mach = Mach::new(mach);
            let point = TrimPoint {
                mass,
                pressure_altitude,
                mach,
                sat,
                center_of_gravity_percent_mac: 27.0,
            };
            aircraft.trim(&point, TruthPhysics::full())
        };
        assert!(fits(32_000.0, 370.0, 0.91).is_ok(), "{:?}", fits(32_000.0, 370.0, 0.91));
        assert!(fits(26_500.0, 510.0, 0.82).is_ok(), "{:?}", fits(26_500.0, 510.0, 0.82));
        assert!(fits(34_000.0, 450.0, 0.86).is_ok(), "{:?}", fits(34_000.0, 450.0, 0.86));
        assert!(matches!(fits(34_000.0, 510.0, 0.82), Err(TrimError::Thrust { .. })));
    }

    #[test]
    fn a320_against_a_recorded_cruise() {
        // Flight-data recorder of an A320-216 published with the Python library `traffic` (MIT), FL360, means of 20
        // min: gross mass, calibrated airspeed, total fuel flow. The zero-lift drag was fitted to the middle one; the
        // others and the slope with mass test the rest. Its temperature is not recorded: ISA is assumed, which matters
        // by 0.2 %/K.
        let aircraft = AircraftTruth::preset(Preset::A320).unwrap();
        let (pressure_altitude, sat) = isa(360.0);
        let static_pressure = atmos::isa::pressure(pressure_altitude).unwrap();
        for (kilograms, knots, kilograms_per_hour) in
            [(66_815.0, 255.7, 2550.5), (64_302.0, 253.8, 2483.5), (61_837.0, 252.3, 2386.3)]
        {
            let mach = atmos::airspeed::calibrated_airspeed_to_mach(
                units::CalibratedAirspeed::knots(knots),
                static_pressure,
            );
            let point = TrimPoint {
                mass: Mass::kilograms(kilograms),
                pressure_altitude,
                mach,
                sat,
                center_of_gravity_percent_mac: 28.0,
            };
            let trimmed = aircraft.trim(&point, TruthPhysics::full()).unwrap();
            let found = 3600.0 * trimmed.fuel_flow_kg_s;
            assert!(
                (found / kilograms_per_hour - 1.0).abs() < 0.015,
                "{found} {kilograms_per_hour}"
            );
            let lift_to_drag = trimmed.lift_coefficient / trimmed.drag_coefficient;
            assert!((14.5..17.0).contains(&lift_to_drag), "{lift_to_drag}");
        }
    }

    #[test]
    fn regional_jet_flies_its_published_range() {
        // OpenAP, e75l: 2 200 nm at M 0.78; ceiling 41 000 ft. Cruise part on 7.5 t of fuel from 38 t, steps ignored.
        let aircraft = AircraftTruth::preset(Preset::RegionalJet).unwrap();
        let (pressure_altitude, sat) = isa(360.0);
        let mut kilograms = 37_300.0;
        let mut nautical_miles = 0.0;
        while kilograms > 30_500.0 {
            let point = TrimPoint {
                mass: Mass::kilograms(kilograms),
                pressure_altitude,
                mach: Mach::new(0.78),
                sat,
                center_of_gravity_percent_mac: 20.0,
            };
            let trimmed = aircraft.trim(&point, TruthPhysics::full()).unwrap();
            nautical_miles += 60.0 * trimmed.true_airspeed_m_s / 1852.0;
            kilograms -= 60.0 * trimmed.fuel_flow_kg_s;
        }
        assert!((1800.0..2300.0).contains(&nautical_miles), "{nautical_miles}");
        let (pressure_altitude, sat) = isa(410.0);
        let point = TrimPoint {
            mass: Mass::kilograms(32_000.0),
            pressure_altitude,
            mach: Mach::new(0.78),
            sat,
            center_of_gravity_percent_mac: 20.0,
        };
        assert!(
            aircraft.trim(&point, TruthPhysics::full()).is_ok(),
            "{:?}",
            aircraft.trim(&point, TruthPhysics::full())
        );
    }
}
