//! The atmosphere and the airspeeds against published tables and against other implementations.

use atmos::{airspeed, isa, viscosity};
use icao_units::si::{Kelvin, Metres, MetresPerSecond, Pascals};
use units::convert::STANDARD_GRAVITY_M_S2;
use units::{CalibratedAirspeed, Mach, Pressure, PressureAltitude, Temperature, TrueAirspeed};

const ISA_TABLE: &str = include_str!("reference/isa_doc7488.csv");
const SEGMENTS: &str = include_str!("reference/segments.csv");
const WING_AREA_M2: f64 = 94.94690688;

fn rows(table: &str) -> impl Iterator<Item = Vec<&str>> {
    table
        .lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| line.split(',').collect())
}

fn assert_relative(what: &str, ours: f64, reference: f64, tolerance: f64) {
    let deviation = (ours / reference - 1.0).abs();
    assert!(deviation <= tolerance, "{what}: {ours} against {reference}, relative {deviation:e}");
}

/// ICAO Doc 7488 and U.S. Standard Atmosphere 1976: sources and tolerances in the head of the file.
#[test]
fn published_table() {
    let mut values = 0;
    for row in rows(ISA_TABLE) {
        let pressure_altitude = PressureAltitude::meters(row[0].parse().unwrap());
        let temperature = isa::temperature(pressure_altitude).unwrap();
        let pressure = isa::pressure(pressure_altitude).unwrap();
        let ours = [
            temperature.to_kelvin(),
            pressure.to_pascals(),
            isa::density(pressure, temperature).to_kilograms_per_cubic_meter(),
            isa::speed_of_sound(temperature).to_meters_per_second(),
            viscosity::dynamic_viscosity(temperature).to_pascal_seconds(),
        ];
        let tolerances = [5e-6, 5e-6, 5e-6, 5e-6, 5e-5];
        for ((ours, printed), tolerance) in ours.into_iter().zip(&row[1..]).zip(tolerances) {
            if let Ok(printed) = printed.parse::<f64>() {
                assert_relative(&row.join(","), ours, printed, tolerance);
                values += 1;
            }
        }
        // And back: the printed pressure gives the altitude, within the altitude of its last digit. Not at 20 000 m,
        // the end of the domain, where one of the two printed pressures is 7 mPa outside and is refused.
        if let Ok(printed_pa) = row[2].parse()
            && pressure_altitude < PressureAltitude::meters(20_000.0)
        {
            let back_m = isa::pressure_altitude(Pressure::pascals(printed_pa)).unwrap().to_meters();
            assert!((back_m - pressure_altitude.to_meters()).abs() < 0.05, "{row:?}: {back_m} m");
        }
    }
    assert_eq!(values, 70, "values found in the table");
}

/// Doc 7488/3, Tables 2 and 5: pressure and density ratios, six digits.
#[test]
fn published_ratios() {
    for (pressure_altitude_ft, printed) in
        [(16_000.0, 5.41971e-1), (20_000.0, 4.59543e-1), (50_000.0, 1.14456e-1)]
    {
        let pressure = isa::pressure(PressureAltitude::feet(pressure_altitude_ft)).unwrap();
        assert_relative("pressure ratio", isa::pressure_ratio(pressure), printed, 5e-6);
    }
    for (pressure_altitude_m, printed) in [(10_000.0, 3.36903e-1), (20_000.0, 7.18649e-2)] {
        let pressure_altitude = PressureAltitude::meters(pressure_altitude_m);
        let temperature = isa::temperature(pressure_altitude).unwrap();
        let density = isa::density(isa::pressure(pressure_altitude).unwrap(), temperature);
        assert_relative("density ratio", isa::density_ratio(density), printed, 5e-6);
        // sigma = delta/theta, the definition of the ratios.
        let by_ratios = isa::pressure_ratio(isa::pressure(pressure_altitude).unwrap())
            / isa::temperature_ratio(temperature);
        assert_relative("sigma", isa::density_ratio(density), by_ratios, 1e-14);
    }
}

/// The crate icao-isa computes with the same constants by its own code (BADA 3.12, equations 3.1-18 and 3.1-20).
#[test]
fn agrees_with_icao_isa() {
    for hectometers in -20..=200 {
        let altitude_m = 100.0 * f64::from(hectometers);
        let pressure_altitude = PressureAltitude::meters(altitude_m);
        let temperature = isa::temperature(pressure_altitude).unwrap();
        let pressure = isa::pressure(pressure_altitude).unwrap();
        let density = isa::density(pressure, temperature);

        let their_temperature =
            icao_isa::calculate_isa_temperature(Metres(altitude_m), Kelvin(0.0));
        let their_pressure = icao_isa::calculate_isa_pressure(Metres(altitude_m));
        let their_density = icao_isa::calculate_density(their_pressure, their_temperature);
        assert_relative("temperature", temperature.to_kelvin(), their_temperature.0, 1e-12);
        assert_relative("pressure", pressure.to_pascals(), their_pressure.0, 1e-12);
        assert_relative("density", density.to_kilograms_per_cubic_meter(), their_density.0, 1e-12);

        let back_m = isa::pressure_altitude(pressure).unwrap().to_meters();
        let their_back_m = icao_isa::calculate_isa_altitude(Pascals(pressure.to_pascals())).0;
        assert!((back_m - their_back_m).abs() < 1e-7, "{back_m} m against {their_back_m} m");
    }
}

#[test]
fn airspeeds_agree_with_icao_isa() {
    for (pressure_altitude_ft, sat_c) in
        [(0.0, 15.0), (0.0, -30.0), (25_000.0, -20.0), (39_000.0, -70.0), (51_000.0, -45.0)]
    {
        let pressure = isa::pressure(PressureAltitude::feet(pressure_altitude_ft)).unwrap();
        let sat = Temperature::celsius(sat_c);
        for percent in 5..=95 {
            let mach = Mach::new(0.01 * f64::from(percent));
            let true_airspeed = airspeed::mach_to_true_airspeed(mach, sat);
            let calibrated =
                airspeed::true_airspeed_to_calibrated_airspeed(true_airspeed, pressure, sat);
            let back = airspeed::calibrated_airspeed_to_true_airspeed(calibrated, pressure, sat);

            let theirs_tas = icao_isa::mach_true_air_speed(mach.value(), Kelvin(sat.to_kelvin()));
            let theirs_cas = icao_isa::calculate_calibrated_air_speed(
                MetresPerSecond(true_airspeed.to_meters_per_second()),
                Pascals(pressure.to_pascals()),
                Kelvin(sat.to_kelvin()),
            );
            let theirs_back = icao_isa::calculate_true_air_speed(
                MetresPerSecond(calibrated.to_meters_per_second()),
                Pascals(pressure.to_pascals()),
                Kelvin(sat.to_kelvin()),
            );
            assert_relative("TAS", true_airspeed.to_meters_per_second(), theirs_tas.0, 1e-13);
            // Theirs subtracts 1 from a power near 1: its own rounding at Mach 0.05 is about 1e-13/0.05².
            assert_relative("CAS", calibrated.to_meters_per_second(), theirs_cas.0, 1e-11);
            assert_relative("TAS of CAS", back.to_meters_per_second(), theirs_back.0, 1e-11);
        }
    }
}

/// Crossover altitudes, where a CAS and a Mach number are the same speed.
#[test]
fn crossover_altitudes() {
    let check = |calibrated_kt: f64, mach: f64, pressure_altitude_ft: f64, tolerance_kt: f64| {
        let pressure = isa::pressure(PressureAltitude::feet(pressure_altitude_ft)).unwrap();
        let ours = airspeed::mach_to_calibrated_airspeed(Mach::new(mach), pressure).to_knots();
        assert!((ours - calibrated_kt).abs() < tolerance_kt, "Mach {mach}: {ours} kt");
        let back = airspeed::calibrated_airspeed_to_mach(
            CalibratedAirspeed::knots(calibrated_kt),
            pressure,
        );
        // 1 kt of CAS is about 0.0025 Mach there.
        assert!((back.value() - mach).abs() < 0.0025 * tolerance_kt, "{calibrated_kt} kt: {back}");
    };
    // Cessna Citation X: MMO 0.92 and VMO 350 KCAS meet at 30 650 ft (published to 50 ft, which is 0.35 kt).
    check(350.0, 0.92, 30_650.0, 0.35);
    // Airbus A320: 300 kt / Mach 0.78 meet at FL293 (29 314 ft; published in whole feet, 0.01 kt).
    check(300.0, 0.78, 29_314.0, 0.01);
    // icao-isa solves for the altitude in closed form.
    for (calibrated_kt, mach) in [(250.0, 0.70), (280.0, 0.78), (300.0, 0.80), (320.0, 0.85)] {
        let theirs = icao_isa::calculate_crossover_altitude(
            MetresPerSecond(CalibratedAirspeed::knots(calibrated_kt).to_meters_per_second()),
            mach,
        );
        let pressure_altitude_ft = PressureAltitude::meters(theirs.0).to_feet();
        // Its a0 is the rounded 340.294 m/s, 3.5e-8 too much: 1.2e-5 kt at 320 kt.
        check(calibrated_kt, mach, pressure_altitude_ft, 1.2e-5);
    }
}

/// An independent implementation of the book's equations, through pressure and density to the lift coefficient.
#[test]
fn lift_coefficient_of_reduced_segments() {
    let mut segments = 0;
    for row in rows(SEGMENTS) {
        let number = |column: usize| row[column].parse::<f64>().unwrap();
        let pressure = isa::pressure(PressureAltitude::meters(number(2))).unwrap();
        let density = isa::density(pressure, Temperature::kelvin(number(3)));
        let dynamic_pressure =
            airspeed::dynamic_pressure(density, TrueAirspeed::meters_per_second(number(4)));
        let lift_coefficient =
            number(5) * STANDARD_GRAVITY_M_S2 / (dynamic_pressure.to_pascals() * WING_AREA_M2);
        // 13 digits in, 13 digits out, V squared.
        assert_relative(&row.join(","), lift_coefficient, number(6), 1e-11);
        segments += 1;
    }
    assert_eq!(segments, 7);
}

/// Doc 7488/3, Table C: at sea level 340.294 m/s and kinematic viscosity 1.4607e-5 m²/s, so at Mach 1 a unit Reynolds
/// number of 340.294/1.4607e-5 = 2.32966e7 1/m (five digits).
#[test]
fn unit_reynolds_number_at_sea_level() {
    let sat = Temperature::kelvin(288.15);
    let reynolds_number = viscosity::reynolds_number(
        isa::density(Pressure::pascals(101_325.0), sat),
        TrueAirspeed::meters_per_second(isa::speed_of_sound(sat).to_meters_per_second()),
        1.0,
        viscosity::dynamic_viscosity(sat),
    );
    assert_relative("Reynolds number", reynolds_number, 340.294 / 1.4607e-5, 5e-5);
}
