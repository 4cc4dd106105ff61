//! Round trips and monotonicity over the whole domain.

use atmos::{airspeed, gravity, isa, temperature, viscosity};
use proptest::prelude::*;
use units::{
    Acceleration, Angle, GeometricAltitude, Mach, PressureAltitude, Temperature, TrueAirspeed,
};

fn pressure_altitude_m() -> impl Strategy<Value = f64> {
    -2000.0..=20_000.0
}

fn sat_k() -> impl Strategy<Value = f64> {
    180.0..330.0
}

fn latitude_deg() -> impl Strategy<Value = f64> {
    -90.0..=90.0
}

fn m_s2(acceleration: Acceleration) -> f64 {
    acceleration.to_meters_per_second_squared()
}

proptest! {
    #[test]
    fn pressure_altitude_comes_back(pressure_altitude_m in pressure_altitude_m()) {
        let pressure = isa::pressure(PressureAltitude::meters(pressure_altitude_m)).unwrap();
        let back_m = isa::pressure_altitude(pressure).unwrap().to_meters();
        // A few units of the last place of the pressure, times dh/dlnp = 8.7 km at most.
        prop_assert!((back_m - pressure_altitude_m).abs() < 1e-8, "{back_m}");
    }

    #[test]
    fn pressure_falls_and_hydrostatic_balance_holds(pressure_altitude_m in -1999.0..19_999.0) {
        // dp = −ρ g0 dh: the equation both pressure laws are the solutions of. A difference across the tropopause is of both at
        // once, and the slope of density jumps there.
        prop_assume!(!(10_999.0..=11_001.0).contains(&pressure_altitude_m));
        let at = |altitude_m: f64| isa::pressure(PressureAltitude::meters(altitude_m)).unwrap().to_pascals();
        let slope_pa_m = (at(pressure_altitude_m + 1.0) - at(pressure_altitude_m - 1.0)) / 2.0;
        let pressure_altitude = PressureAltitude::meters(pressure_altitude_m);
        let density = isa::density(
            isa::pressure(pressure_altitude).unwrap(),
            isa::temperature(pressure_altitude).unwrap(),
        );
        let weight_pa_m = density.to_kilograms_per_cubic_meter() * 9.80665;
        prop_assert!(slope_pa_m < 0.0);
        prop_assert!((slope_pa_m / -weight_pa_m - 1.0).abs() < 1e-6, "{slope_pa_m} {weight_pa_m}");
    }

    #[test]
    fn isa_deviation_is_what_was_added(
        pressure_altitude_m in pressure_altitude_m(), deviation_k in -40.0_f64..40.0,
    ) {
        let pressure_altitude = PressureAltitude::meters(pressure_altitude_m);
        let sat = Temperature::kelvin(isa::temperature(pressure_altitude).unwrap().to_kelvin() + deviation_k);
        let back = isa::isa_deviation(pressure_altitude, sat).unwrap();
        prop_assert!((back.to_kelvin() - deviation_k).abs() < 1e-12);
    }

    #[test]
    fn airspeeds_come_back(
        pressure_altitude_m in 0.0..=20_000.0, sat_k in sat_k(), mach in 1e-4..0.999,
    ) {
        let pressure = isa::pressure(PressureAltitude::meters(pressure_altitude_m)).unwrap();
        let sat = Temperature::kelvin(sat_k);
        let density = isa::density(pressure, sat);
        let tas = airspeed::mach_to_true_airspeed(Mach::new(mach), sat);
        let cas = airspeed::true_airspeed_to_calibrated_airspeed(tas, pressure, sat);
        let eas = airspeed::true_airspeed_to_equivalent_airspeed(tas, density);
        let tas_of_cas = airspeed::calibrated_airspeed_to_true_airspeed(cas, pressure, sat);
        let tas_of_eas = airspeed::equivalent_airspeed_to_true_airspeed(eas, density);
        let mach_of_tas = airspeed::true_airspeed_to_mach(tas, sat);
        prop_assert!((tas_of_cas / tas - 1.0).abs() < 1e-13, "{tas_of_cas:?} {tas:?}");
        prop_assert!((tas_of_eas / tas - 1.0).abs() < 1e-14);
        prop_assert!((mach_of_tas.value() / mach - 1.0).abs() < 1e-14);
        // Compressibility: CAS is never below EAS when the air is thinner than at sea level.
        prop_assert!(cas.to_meters_per_second() >= eas.to_meters_per_second() * (1.0 - 1e-14));
    }

    #[test]
    fn calibrated_airspeed_rises_with_mach_and_pressure(
        pressure_altitude_m in 0.0..19_900.0, mach in 0.01..0.99,
    ) {
        let cas = |altitude_m: f64, mach: f64| {
            let pressure = isa::pressure(PressureAltitude::meters(altitude_m)).unwrap();
            airspeed::mach_to_calibrated_airspeed(Mach::new(mach), pressure)
        };
        prop_assert!(cas(pressure_altitude_m, mach + 0.005) > cas(pressure_altitude_m, mach));
        prop_assert!(cas(pressure_altitude_m + 100.0, mach) < cas(pressure_altitude_m, mach));
    }

    #[test]
    fn static_temperature_comes_back(sat_k in sat_k(), mach in 0.0..1.0, recovery_factor in 0.8..=1.0) {
        let sat = Temperature::kelvin(sat_k);
        let mach = Mach::new(mach);
        let total = temperature::static_to_total(sat, mach, recovery_factor);
        let back = temperature::total_to_static(total, mach, recovery_factor);
        prop_assert!(total >= sat);
        prop_assert!((back.to_kelvin() / sat_k - 1.0).abs() < 1e-15 * 4.0);
    }

    #[test]
    fn viscosity_rises_with_temperature(sat_k in sat_k()) {
        let viscosity = |sat_k: f64| viscosity::dynamic_viscosity(Temperature::kelvin(sat_k));
        prop_assert!(viscosity(sat_k + 0.1) > viscosity(sat_k));
    }

    #[test]
    fn reynolds_number_is_linear_in_length(sat_k in sat_k(), length_m in 0.1..10.0) {
        let sat = Temperature::kelvin(sat_k);
        let pressure = isa::pressure(PressureAltitude::meters(11_000.0)).unwrap();
        let over = |length_m: f64| {
            viscosity::reynolds_number(
                isa::density(pressure, sat),
                TrueAirspeed::meters_per_second(230.0),
                length_m,
                viscosity::dynamic_viscosity(sat),
            )
        };
        prop_assert!((over(length_m) / over(1.0) / length_m - 1.0).abs() < 1e-14);
    }

    #[test]
    fn gravity_is_even_and_falls_with_height(latitude_deg in latitude_deg(), height_m in 0.0..20_000.0) {
        let at = |latitude_deg: f64, height_m: f64| {
            m_s2(gravity::gravity(Angle::degrees(latitude_deg), GeometricAltitude::meters(height_m)))
        };
        prop_assert!((at(latitude_deg, height_m) - at(-latitude_deg, height_m)).abs() < 1e-15);
        // Free-air gradient 3.086e-6 1/s² (any geophysics text), within 1 % over latitude and height.
        let gradient = (at(latitude_deg, height_m) - at(latitude_deg, height_m + 100.0)) / 100.0;
        prop_assert!((gradient / 3.086e-6 - 1.0).abs() < 0.012, "{gradient}");
        let on_ellipsoid = m_s2(gravity::normal_gravity(Angle::degrees(latitude_deg)));
        prop_assert!((at(latitude_deg, 0.0) - on_ellipsoid).abs() < 1e-15);
    }

    #[test]
    fn earth_motion_splits_into_odd_and_even(
        latitude_deg in latitude_deg(), east_m_s in 0.0..300.0, north_m_s in -300.0..300.0, height_m in 0.0..20_000.0,
    ) {
        let latitude = Angle::degrees(latitude_deg);
        let at = |east_m_s: f64| {
            let height = GeometricAltitude::meters(height_m);
            m_s2(gravity::earth_motion_acceleration(latitude, east_m_s, north_m_s, height))
        };
        // Odd in the east velocity is Coriolis, 4Ω V cos φ between the two directions; the rest is never negative.
        let coriolis = 4.0 * 7.292115e-5 * east_m_s * latitude.to_radians().cos();
        prop_assert!((at(east_m_s) - at(-east_m_s) - coriolis).abs() < 1e-15);
        prop_assert!(at(east_m_s) + at(-east_m_s) >= -1e-15);
    }
}
