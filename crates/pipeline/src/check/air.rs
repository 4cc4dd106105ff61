//! Airspeeds, temperature and altitude against each other.

use std::borrow::Cow;

use atmos::{airspeed, isa, temperature};
use flight::{Assumption, Report, Severity};
use units::convert::KELVIN_AT_ZERO_CELSIUS;
use units::{Mach, PressureAltitude, Temperature};

use super::slips::{self, FEET_PER_METER, SPEED};
use super::{Draft, mean};

/// Code of a true airspeed that Mach number and SAT contradict.
pub(super) const TRUE_AIRSPEED: &str = "true-airspeed-against-mach";

/// Difference of recorded true airspeed and M·a(SAT) worth a word. A probe 1 K off makes 0.25 %, a Mach number 0.004 off
/// 0.5 %.
const WARNING_SHARE: f64 = 0.015;
/// Difference above which a quantity is another one than its column says; degF for degC makes 3 % at the tropopause.
const SERIOUS_SHARE: f64 = 0.025;
/// How near an implied temperature has to be to be named, K.
const SAME_TEMPERATURE_K: f64 = 2.5;
/// Deviations from the ISA that cruise levels have: -25 to +25 K; tropical tropopauses at flight level 450 reach -25 K.
const WARNING_DEVIATION_K: f64 = 30.0;
const SERIOUS_DEVIATION_K: f64 = 45.0;
/// Calibrated airspeeds of cruise, kt: the fastest civil aircraft are limited to about 400.
const CALIBRATED_AIRSPEED_KT: (f64, f64) = (90.0, 410.0);

pub(super) fn check(report: &Report) -> Vec<Draft> {
    let Some(air) = Means::from_report(report) else { return Vec::new() };
    let altitude = altitude(&air);
    // A wrong altitude makes the temperature look wrong too.
    let deviation = if altitude.is_some() { None } else { deviation(&air) };
    [true_airspeed(&air), altitude, deviation].into_iter().flatten().collect()
}

/// True airspeed of each sample as far as it can be believed: that of Mach number and SAT where the recorded one contradicts both, so
/// that what is compared with it is not blamed for it.
pub(super) fn believed_true_airspeed_m_s(report: &Report) -> Cow<'_, [f64]> {
    let columns = report.columns();
    let recorded = Cow::Borrowed(&columns.true_airspeed_m_s[..]);
    let ratio = Means::from_report(report).and_then(|air| air.true_airspeed_ratio);
    let is_wrong = ratio.is_some_and(|ratio| (ratio - 1.0).abs() > SERIOUS_SHARE);
    let Some(temperatures_k) = columns.static_air_temperature_k.as_ref().filter(|_| is_wrong)
    else {
        return recorded;
    };
    let derived = columns.mach.iter().zip(temperatures_k).map(|(mach, temperature_k)| {
        let temperature = Temperature::kelvin(*temperature_k);
        airspeed::mach_to_true_airspeed(Mach::new(*mach), temperature).to_meters_per_second()
    });
    derived.collect()
}

/// Means over the report.
struct Means {
    mach: Mach,
    pressure_altitude: PressureAltitude,
    /// `None` where temperature is assumed.
    static_air_temperature: Option<Temperature>,
    /// Mean of recorded true airspeed over M·a(SAT); `None` as the temperature.
    true_airspeed_ratio: Option<f64>,
    true_airspeed_kt: f64,
    calibrated_airspeed_kt: f64,
}

impl Means {
    fn from_report(report: &Report) -> Option<Self> {
        let columns = report.columns();
        let mach = Mach::new(mean(columns.mach.iter().copied())?);
        let pressure_altitude =
            PressureAltitude::meters(mean(columns.pressure_altitude_m.iter().copied())?);
        let assumed = report
            .header()
            .assumed
            .iter()
            .any(|one| matches!(one, Assumption::StaticAirTemperatureIsa { .. }));
        let recorded = columns.static_air_temperature_k.as_ref().filter(|_| !assumed);
        let pressure = isa::pressure(pressure_altitude).ok()?;
        let calibrated = airspeed::mach_to_calibrated_airspeed(mach, pressure);
        Some(Self {
            mach,
            pressure_altitude,
            static_air_temperature: recorded
                .and_then(|values| mean(values.iter().copied()))
                .map(Temperature::kelvin),
            true_airspeed_ratio: recorded.and_then(|temperatures_k| {
                let samples =
                    columns.mach.iter().zip(temperatures_k).zip(&columns.true_airspeed_m_s);
                mean(samples.map(|((mach, temperature_k), true_airspeed_m_s)| {
                    let temperature = Temperature::kelvin(*temperature_k);
                    let expected = airspeed::mach_to_true_airspeed(Mach::new(*mach), temperature);
                    true_airspeed_m_s / expected.to_meters_per_second()
                }))
            }),
            true_airspeed_kt: units::TrueAirspeed::meters_per_second(mean(
                columns.true_airspeed_m_s.iter().copied(),
            )?)
            .to_knots(),
            calibrated_airspeed_kt: calibrated.to_knots(),
        })
    }
}

fn true_airspeed(air: &Means) -> Option<Draft> {
    let ratio = air.true_airspeed_ratio?;
    if (ratio - 1.0).abs() < WARNING_SHARE {
        return None;
    }
    let (likely_cause, remedy) = explain(air, ratio);
    let serious = (ratio - 1.0).abs() > SERIOUS_SHARE;
    Some(Draft {
        severity: if serious { Severity::Serious } else { Severity::Warning },
        code: TRUE_AIRSPEED,
        size: 100.0 * (ratio - 1.0),
        unit: "%",
        message: format!(
            "true airspeed is {:+.1} % off Mach number times the speed of sound at SAT",
            100.0 * (ratio - 1.0)
        ),
        likely_cause,
        remedy,
    })
}

fn explain(air: &Means, ratio: f64) -> (String, String) {
    // High up a calibrated airspeed is about half of the true one, as are metres per second of knots: the nearer one is meant.
    let off_calibrated = (air.true_airspeed_kt / air.calibrated_airspeed_kt - 1.0).abs();
    let slip = slips::find(&SPEED, ratio).filter(|slip| {
        off_calibrated > WARNING_SHARE || (ratio / slip.factor - 1.0).abs() < off_calibrated
    });
    if let Some(slip) = slip {
        return (format!("VTAS: {}", slip.cause), format!("VTAS: {}", slip.remedy));
    }
    if off_calibrated < WARNING_SHARE {
        return (
            "VTAS holds calibrated airspeed".to_owned(),
            "map VTAS to true airspeed, or derive it from MACH".to_owned(),
        );
    }
    if let Some(sat) = air.static_air_temperature {
        // The temperature at which Mach number and true airspeed agree: a² grows with it.
        let implied_k = sat.to_kelvin() * ratio * ratio;
        let fahrenheit_read_k =
            (sat.to_kelvin() - KELVIN_AT_ZERO_CELSIUS - 32.0) / 1.8 + KELVIN_AT_ZERO_CELSIUS;
        if (implied_k - fahrenheit_read_k).abs() < SAME_TEMPERATURE_K {
            return (
                "SAT: degrees Fahrenheit declared as Celsius".to_owned(),
                "SAT: unit \"degF\" in a mapping; a report is to have degC".to_owned(),
            );
        }
        let total = temperature::static_to_total(Temperature::kelvin(implied_k), air.mach, 1.0);
        if (total.to_kelvin() - sat.to_kelvin()).abs() < SAME_TEMPERATURE_K {
            return (
                "SAT holds total air temperature".to_owned(),
                "map the column to TAT, and derive SAT from TAT and MACH".to_owned(),
            );
        }
    }
    (
        "one of MACH, SAT and VTAS is another quantity, in another unit, or reads wrong".to_owned(),
        "compare MACH, SAT and VTAS with the recorder's list".to_owned(),
    )
}

/// Altitudes at which the Mach number is one that no aircraft flies.
fn altitude(air: &Means) -> Option<Draft> {
    let (low, high) = CALIBRATED_AIRSPEED_KT;
    let calibrated = air.calibrated_airspeed_kt;
    if (low..=high).contains(&calibrated) {
        return None;
    }
    let feet = air.pressure_altitude.to_feet();
    let (likely_cause, remedy) = if (100.0..=600.0).contains(&feet) {
        ("ALT: flight levels declared as feet", "ALT: scale 100")
    } else if calibrated > high && fits(air, FEET_PER_METER) {
        ("ALT: metres declared as feet", "ALT: unit m instead of ft")
    } else {
        ("ALT or MACH is in another unit", "compare ALT and MACH with the recorder's list")
    };
    Some(Draft {
        severity: Severity::Serious,
        code: "altitude-against-mach",
        size: calibrated,
        unit: "kt",
        message: format!(
            "Mach {:.3} at {feet:.0} ft is a calibrated airspeed of {calibrated:.0} kt, which no aircraft cruises at",
            air.mach.value()
        ),
        likely_cause: likely_cause.to_owned(),
        remedy: remedy.to_owned(),
    })
}

/// Whether an altitude that is larger by `factor` gives a calibrated airspeed that aircraft fly.
fn fits(air: &Means, factor: f64) -> bool {
    let altitude = PressureAltitude::meters(air.pressure_altitude.to_meters() * factor);
    isa::pressure(altitude).is_ok_and(|pressure| {
        let calibrated = airspeed::mach_to_calibrated_airspeed(air.mach, pressure).to_knots();
        (CALIBRATED_AIRSPEED_KT.0..=CALIBRATED_AIRSPEED_KT.1).contains(&calibrated)
    })
}

/// Temperatures that the atmosphere does not have at this altitude.
fn deviation(air: &Means) -> Option<Draft> {
    let sat = air.static_air_temperature?;
    let standard_k = isa::temperature(air.pressure_altitude).ok()?.to_kelvin();
    let deviation_k = sat.to_kelvin() - standard_k;
    if deviation_k.abs() < WARNING_DEVIATION_K {
        return None;
    }
    let higher = PressureAltitude::meters(air.pressure_altitude.to_meters() * FEET_PER_METER);
    let as_meters_k =
        isa::temperature(higher).map_or(f64::INFINITY, |t| (sat.to_kelvin() - t.to_kelvin()).abs());
    let total = temperature::total_to_static(sat, air.mach, 1.0).to_kelvin();
    let (likely_cause, remedy) = if as_meters_k < WARNING_DEVIATION_K && fits(air, FEET_PER_METER) {
        ("ALT: metres declared as feet", "ALT: unit m instead of ft")
    } else if (total - standard_k).abs() < 0.7 * WARNING_DEVIATION_K {
        (
            "SAT holds total air temperature",
            "map the column to TAT, and derive SAT from TAT and MACH",
        )
    } else {
        ("SAT or ALT is in another unit", "compare SAT and ALT with the recorder's list")
    };
    let serious = deviation_k.abs() > SERIOUS_DEVIATION_K;
    Some(Draft {
        severity: if serious { Severity::Serious } else { Severity::Warning },
        code: "temperature-against-altitude",
        size: deviation_k,
        unit: "K",
        message: format!(
            "SAT is {deviation_k:+.0} K off the standard atmosphere at {:.0} ft",
            air.pressure_altitude.to_feet()
        ),
        likely_cause: likely_cause.to_owned(),
        remedy: remedy.to_owned(),
    })
}
