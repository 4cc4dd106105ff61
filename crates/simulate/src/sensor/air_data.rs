//! The air-data computer: from pressures and total temperature to the quantities of the report.

use units::{OutOfDomain, Pressure, check_within};

use crate::aircraft::{HEATING_FACTOR, pressure_rise};

/// The inputs of the computer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AirDataInputs {
    pub(crate) static_pressure_pa: f64,
    pub(crate) total_pressure_pa: f64,
    pub(crate) total_air_temperature_k: f64,
    /// Added to the Mach number that it computes, before SAT and TAS.
    pub(crate) mach_bias: f64,
}

/// Its outputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AirData {
    pub(crate) pressure_altitude_m: f64,
    pub(crate) mach: f64,
    pub(crate) static_air_temperature_k: f64,
    pub(crate) true_airspeed_m_s: f64,
}

/// Pressure altitude from static pressure, Mach number from the ratio of the pressures, SAT from TAT and Mach number, TAS
/// from both.
///
/// ```text
/// M = √(5·((pt/p)^(2/7) − 1));  SAT = TAT/(1 + 0.2·M²);  TAS = M·a(SAT)        [virtual.16]
/// ```
pub(crate) fn compute(inputs: &AirDataInputs) -> Result<AirData, OutOfDomain> {
    let static_pressure = Pressure::pascals(inputs.static_pressure_pa);
    let pressure_altitude = atmos::isa::pressure_altitude(static_pressure)?;
    let ratio = check_within(
        "total over static pressure",
        "-",
        inputs.total_pressure_pa / inputs.static_pressure_pa,
        1.0,
        2.0,
    )?;
    let mach = ((ratio.powf(2.0 / 7.0) - 1.0) / HEATING_FACTOR).sqrt() + inputs.mach_bias;
    let static_air_temperature_k =
        inputs.total_air_temperature_k / (1.0 + HEATING_FACTOR * mach * mach);
    let speed_of_sound =
        atmos::isa::speed_of_sound(units::Temperature::kelvin(static_air_temperature_k));
    Ok(AirData {
        pressure_altitude_m: pressure_altitude.to_meters(),
        mach,
        static_air_temperature_k,
        true_airspeed_m_s: mach * speed_of_sound.to_meters_per_second(),
    })
}

/// Total pressure at the true static pressure and Mach number, Pa.
pub(crate) fn total_pressure_pa(static_pressure_pa: f64, mach: f64) -> f64 {
    static_pressure_pa * pressure_rise(1.0 + HEATING_FACTOR * mach * mach)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inputs(static_pressure_pa: f64, mach: f64, sat_k: f64) -> AirDataInputs {
        AirDataInputs {
            static_pressure_pa,
            total_pressure_pa: total_pressure_pa(static_pressure_pa, mach),
            total_air_temperature_k: sat_k * (1.0 + 0.2 * mach * mach),
            mach_bias: 0.0,
        }
    }

    #[test]
    fn true_inputs_give_the_truth() {
        let computed = compute(&inputs(17_874.0, 0.82, 219.0)).unwrap();
        assert!((computed.mach - 0.82).abs() < 1e-12);
        assert!((computed.static_air_temperature_k - 219.0).abs() < 1e-9);
        // a = √(1.4·287.05287·219) = 296.66 m/s.
        assert!((computed.true_airspeed_m_s - 0.82 * 296.6628).abs() < 1e-2, "{computed:?}");
    }

    #[test]
    fn static_pressure_that_reads_high_shows_everywhere() {
        // Gap diagnosis, effect static_pressure_bias: dM = −(dp/p)·(1 + 0.2·M²)/(1.4·M), dh = −(R·T/g)·dp/p, to first order.
        let (p, mach, sat_k) = (17_874.0, 0.80, 216.65);
        let truth = compute(&inputs(p, mach, sat_k)).unwrap();
        let relative = 0.003;
        let mut wrong = inputs(p, mach, sat_k);
        wrong.static_pressure_pa *= 1.0 + relative;
        let computed = compute(&wrong).unwrap();
        let mach_change = -relative * (1.0 + 0.2 * mach * mach) / (1.4 * mach);
        assert!((computed.mach - mach - mach_change).abs() < 2e-5, "{}", computed.mach - mach);
        let height_change = -287.05287 * sat_k / 9.80665 * relative;
        assert!(
            (computed.pressure_altitude_m - truth.pressure_altitude_m - height_change).abs() < 0.1
        );
        // SAT = TAT/(1 + 0.2·M²) rises as Mach number falls: −0.4·M·dM/(1 + 0.2·M²)·SAT.
        let sat_change = -0.4 * mach * mach_change / (1.0 + 0.2 * mach * mach) * sat_k;
        assert!((computed.static_air_temperature_k - sat_k - sat_change).abs() < 2e-3);
        assert!(computed.true_airspeed_m_s < truth.true_airspeed_m_s);
    }

    #[test]
    fn total_below_static_pressure_is_refused() {
        let mut wrong = inputs(17_874.0, 0.8, 216.65);
        wrong.total_pressure_pa = 17_000.0;
        assert!(compute(&wrong).unwrap_err().to_string().contains("total over static pressure"));
    }
}
