//! What the aircraft file of a case states about the virtual aircraft's sensors.

use atmos::constants::ISOTHERMAL_SCALE_HEIGHT_M;
use perf_model::aircraft::{
    AirDataDrift, FlightBias, FuelFlowDrift, MassDeviation, SensorDeviations,
};
use simulate::{AircraftTruth, ChannelSensor, DRIFT_TIME_CONSTANT_S, Scatter, Sensors};

/// What the aircraft file states about the fleet's sensors: how they err within a flight and from flight to flight, as an operator
/// sees it in past reports.
///
/// A slow wander of variance σ² and time constant τ has, over a time T, a mean of variance
///
/// ```text
/// v(T)·σ²,  v(T) = 2τ/T·(1 − τ/T·(1 − e^(−T/τ)))
/// ```
///
/// (Ornstein–Uhlenbeck process): v of a segment less v of a flight is left within the flight, and noise counts with 1/√10
/// (ten samples a segment); the wander's share of the variance is stated for all air data as it is of the Mach number. What a
/// flow meter keeps through a flight is stated with the fuel's heating value, its wander, with v of a segment, as what it is. Of
/// what air data and rotor speed keep through a flight, σ of the flight and v of a flight of the wander are stated.
///
/// The air-data computer's errors are stated where the fleet cruises, Mach 0.80 and 200 hPa:
///
/// ```text
/// σM = √((σpt/pt)² + (σps/ps)²)·(1 + 0.2 M²)/(1.4 M),  σh = R·T·σps/(g0·ps)
/// ```
///
/// from M² = 5((pt/ps)^(2/7) − 1) and the hydrostatic equation at T = 216.65 K.
pub(crate) fn stated_sensors(
    sensors: &Sensors,
    scatter: &Scatter,
    truth: &AircraftTruth,
) -> SensorDeviations {
    const SAMPLES: f64 = 10.0;
    const SEGMENT_S: f64 = 600.0;
    const FLIGHT_S: f64 = 7200.0;
    const MACH: f64 = 0.80;
    const STATIC_PRESSURE_HPA: f64 = 200.0;
    // The quiet end of what is seen at 60 s in turbulence; the virtual air is turbulent now and then.
    const ACCELERATION_M_S2: f64 = 0.003;
    let of_mean = |over_s: f64| {
        let x = over_s / DRIFT_TIME_CONSTANT_S;
        2.0 / x * (1.0 - (1.0 - (-x).exp()) / x)
    };
    let wander = |slow: f64| (of_mean(SEGMENT_S) - of_mean(FLIGHT_S)).sqrt() * slow;
    let within = |slow: f64, noise: f64| wander(slow).hypot(noise / SAMPLES.sqrt());
    let through = |slow: f64, flight: f64| (of_mean(FLIGHT_S).sqrt() * slow).hypot(flight);
    let added = |sensor: &ChannelSensor| within(sensor.drift_sd, sensor.noise_sd);
    let kept = |sensor: &ChannelSensor| through(sensor.drift_sd, sensor.flight_sd);
    let gained = |sensor: &ChannelSensor| within(sensor.gain_drift_sd, sensor.gain_noise_sd);
    let heating = 1.0 + 0.2 * MACH * MACH;
    let of_pressures = |deviation: &dyn Fn(&ChannelSensor) -> f64| {
        let of_static = deviation(&sensors.static_pressure) / STATIC_PRESSURE_HPA;
        let of_total =
            deviation(&sensors.total_pressure) / (STATIC_PRESSURE_HPA * heating.powf(3.5));
        let mach = of_static.hypot(of_total) * heating / (1.4 * MACH);
        (mach, of_static * ISOTHERMAL_SCALE_HEIGHT_M)
    };
    let (mach, pressure_altitude_m) = of_pressures(&added);
    let (wandering_mach, _) = of_pressures(&|sensor| wander(sensor.drift_sd));
    let (mach_kept, pressure_altitude_kept_m) = of_pressures(&kept);
    let meter = &sensors.fuel_flow;
    // Engines err independently; the N2 channel is their mean.
    let engines = f64::from(truth.engine.count).sqrt();
    let kept_by_all = 100.0 * meter.gain_flight_sd / engines;
    let rotor_kept = (100.0 * through(sensors.n2.gain_drift_sd, sensors.n2.gain_flight_sd))
        .hypot(kept(&sensors.n2));
    SensorDeviations {
        fuel_flow_percent: 100.0 * meter.gain_noise_sd / SAMPLES.sqrt(),
        mach,
        static_air_temperature_k: added(&sensors.total_air_temperature) / heating,
        acceleration_m_s2: ACCELERATION_M_S2,
        mass: MassDeviation::Kilograms(
            0.01 * scatter.zero_fuel_mass_percent * truth.masses.maximum_zero_fuel_kg,
        ),
        lower_heating_value_percent: scatter.heating_value_percent.hypot(kept_by_all),
        n2_percent: (100.0 * gained(&sensors.n2)).hypot(added(&sensors.n2)),
        pressure_altitude_m,
        fuel_flow_drift: FuelFlowDrift {
            percent: 100.0 * of_mean(SEGMENT_S).sqrt() * meter.gain_drift_sd,
            time_s: DRIFT_TIME_CONSTANT_S,
        },
        air_data_drift: AirDataDrift {
            // Nothing drifts where nothing errs.
            share: if mach > 0.0 { (wandering_mach / mach).powi(2) } else { 0.0 },
            time_s: DRIFT_TIME_CONSTANT_S,
        },
        flight_bias: FlightBias {
            mach: mach_kept,
            static_air_temperature_k: kept(&sensors.total_air_temperature) / heating,
            n2_percent: rotor_kept / engines,
            pressure_altitude_m: pressure_altitude_kept_m,
        },
    }
}

/// The same as an operator who does not know them may state them: every standard deviation times a factor, and nothing of
/// what is kept through a flight or drifts within it.
pub(crate) fn misstated(stated: &SensorDeviations, factor: f64) -> SensorDeviations {
    let mass = match stated.mass {
        MassDeviation::Percent(percent) => MassDeviation::Percent(factor * percent),
        MassDeviation::Kilograms(kilograms) => MassDeviation::Kilograms(factor * kilograms),
    };
    SensorDeviations {
        fuel_flow_percent: factor * stated.fuel_flow_percent,
        mach: factor * stated.mach,
        static_air_temperature_k: factor * stated.static_air_temperature_k,
        acceleration_m_s2: factor * stated.acceleration_m_s2,
        mass,
        lower_heating_value_percent: factor * stated.lower_heating_value_percent,
        n2_percent: factor * stated.n2_percent,
        pressure_altitude_m: factor * stated.pressure_altitude_m,
        fuel_flow_drift: FuelFlowDrift { percent: 0.0, ..stated.fuel_flow_drift },
        air_data_drift: AirDataDrift { share: 0.0, ..stated.air_data_drift },
        flight_bias: FlightBias {
            mach: 0.0,
            static_air_temperature_k: 0.0,
            n2_percent: 0.0,
            pressure_altitude_m: 0.0,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_aircraft_file_states_the_virtual_sensors() {
        // By hand: means of a wander of 1 200 s keep 0.852245 of its variance over 600 s and 0.277915 over 7 200 s. Then
        // 100·0.0030/√10, 100·√0.852245·0.0020, √(0.57433·0.10² + 0.05²/10)/1.128 and
        // √(0.3² + 100²·0.0015²/2). Through a flight: TAT √(0.277915·0.10² + 0.20²)/1.128 = 0.183361,
        // N2 0.03/√2, static pressure √(0.277915·0.03² + 0.10²)/200 = 5.0622e-4 of p, total pressure
        // √(0.277915·0.05² + 0.15²)/(200·1.128^3.5) = 4.9955e-4; Mach √(5.0622² + 4.9955²)e-4·1.128/1.12, altitude 5.0622e-4·6341.6.
        // Of the Mach number 0.57433·(0.03²/200² + 0.05²/(200·1.128^3.5)²) = 2.83706e-8 wanders,
        // 0.01²/10/200² + 0.03²/10/(200·1.128^3.5)² = 1.21832e-9 is new.
        let truth = AircraftTruth::preset(simulate::Preset::CitationX).unwrap();
        let stated = stated_sensors(&Sensors::transport(), &Scatter::default(), &truth);
        assert!((stated.fuel_flow_percent - 0.094868).abs() < 1e-5, "{stated:?}");
        assert!((stated.fuel_flow_drift.percent - 0.184634).abs() < 1e-5, "{stated:?}");
        assert!((stated.static_air_temperature_k - 0.068632).abs() < 1e-5, "{stated:?}");
        assert!((stated.lower_heating_value_percent - 0.318198).abs() < 1e-5, "{stated:?}");
        assert_eq!(stated.mass, MassDeviation::Kilograms(0.01 * 0.7 * 11_068.0));
        assert!(
            (stated.air_data_drift.share - 2.83706e-8 / 2.958893e-8).abs() < 1e-4,
            "{stated:?}"
        );
        let kept = stated.flight_bias;
        assert!((kept.static_air_temperature_k - 0.183361).abs() < 1e-5, "{kept:?}");
        assert!((kept.n2_percent - 0.021213).abs() < 1e-5, "{kept:?}");
        assert!((kept.mach - 7.1630e-4).abs() < 1e-6, "{kept:?}");
        assert!((kept.pressure_altitude_m - 3.2103).abs() < 1e-3, "{kept:?}");
    }
}
