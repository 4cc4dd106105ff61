//! A flight-planning guide and an aircraft file from the public model.

use core::fmt::Write;

use atmos::isa;
use lut::surface::Basis;
use units::convert::{
    KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR, TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR,
};
use units::{Mach, Mass, OutOfDomain, PressureAltitude, TemperatureDifference};

use super::{Cruise, LOWER_HEATING_VALUE_MJ_KG, Parameters, cruise, represented};
use crate::aircraft::{AircraftFile, AxisFile, SensorDeviations, TableFile, TsfcFile};

/// Shares of the way from empty to maximum take-off mass.
const MASS_SHARES: [f64; 6] = [0.25, 0.40, 0.55, 0.70, 0.85, 0.97];
/// Step of the flight levels, ft.
const LEVEL_STEP_FT: f64 = 2000.0;
/// Levels below the highest one.
const LEVELS: u8 = 7;
/// Mach numbers from this far below the design point to the maximum, in steps.
const MACH_BELOW: f64 = 0.06;
const MACH_STEP: f64 = 0.01;
/// Distance kept from the maximum Mach number.
const MACH_MARGIN: f64 = 0.01;
/// Lift coefficients of cruise; above, buffet is near.
const LIFT_COEFFICIENTS: (f64, f64) = (0.25, 0.68);
/// Thrust over that of the highest efficiency up to which an engine is taken to reach it in cruise.
const HIGHEST_RELATIVE_THRUST: f64 = 1.15;
const TABLE_STEP_LIFT_COEFFICIENT: f64 = 0.05;
const TABLE_STEP_MACH: f64 = 0.02;

/// A guide of a type.
#[derive(Clone, Debug, PartialEq)]
pub struct PublicGuide {
    /// Content of the aircraft file.
    pub aircraft: AircraftFile,
    /// Points, in the order of mass, level and Mach number.
    pub points: Vec<PublicPoint>,
    /// Root mean square of what the TSFC law misses of the model's engine, %.
    pub tsfc_residual_percent: f64,
}

/// A row of the guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PublicPoint {
    /// Gross mass.
    pub mass: Mass,
    /// Pressure altitude, ft; a flight level.
    pub pressure_altitude_ft: f64,
    /// Mach number.
    pub mach: f64,
    /// What the model says.
    pub cruise: Cruise,
}

/// Why a type has no guide.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PublicGuideError {
    /// The type that represents it has another number of engines: it is another aircraft, and the reports of one would be
    /// refused by the model of the other.
    #[error(
        "{type_code} has {engines} engines and {by}, the type that represents it, has {engines_of_it}: it is no model of {type_code}; ask for {by} if that aircraft is wanted"
    )]
    Engines {
        /// The type.
        type_code: String,
        /// Its number of engines.
        engines: u8,
        /// The type that represents it.
        by: String,
        /// That one's number of engines.
        engines_of_it: u8,
    },
    /// A type's own limits are outside the model's domain.
    #[error(transparent)]
    Domain(#[from] OutOfDomain),
}

/// The guide of a type. `type_code` is what its reports say, which may be a type that the one with parameters represents: the
/// guide is of that one then, and the aircraft's name says so.
///
/// # Errors
/// [`PublicGuideError`] where the type that represents it is known to have another number of engines, or has limits outside the
/// model's domain.
pub fn guide(type_code: &str, parameters: &Parameters) -> Result<PublicGuide, PublicGuideError> {
    let by = &parameters.type_code;
    let other = represented().find(|one| {
        one.type_code.eq_ignore_ascii_case(type_code) && one.engines != parameters.engines
    });
    if let Some(other) = other {
        return Err(PublicGuideError::Engines {
            type_code: type_code.to_owned(),
            engines: other.engines,
            by: by.clone(),
            engines_of_it: parameters.engines,
        });
    }
    let points = points(parameters)?;
    let (tsfc, tsfc_residual_percent) = tsfc_law(&points)?;
    let whose = if parameters.is_of(type_code) { "" } else { &format!(" ({by}), for {type_code}") };
    let aircraft = AircraftFile {
        name: format!("{} {}{whose}, public model", parameters.manufacturer, parameters.variant),
        type_code: type_code.to_owned(),
        engines: parameters.engines,
        wing_area_m2: parameters.wing_area_m2,
        tsfc,
        table: table(&points),
        polynomial: Basis::SeparableQuadratic,
        mean_aerodynamic_chord_m: None,
        drag_divergence_mach: None,
        reference_lhv_mj_kg: Some(LOWER_HEATING_VALUE_MJ_KG),
        table_uncertainty_percent: None,
        sensors: SensorDeviations::default(),
    };
    Ok(PublicGuide { aircraft, points, tsfc_residual_percent })
}

impl PublicGuide {
    /// The points as a guide's CSV.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = String::from("mass_kg,pressure_altitude_ft,mach,fuel_flow_kg_h\n");
        for point in &self.points {
            let _ = writeln!(
                text,
                "{:.0},{:.0},{:.2},{:.1}",
                point.mass.to_kilograms(),
                point.pressure_altitude_ft,
                point.mach,
                point.cruise.fuel_flow_total.to_kilograms_per_second()
                    / KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR
            );
        }
        text
    }
}

fn points(parameters: &Parameters) -> Result<Vec<PublicPoint>, OutOfDomain> {
    let empty_kg = parameters.operating_empty_mass_kg;
    let highest_ft = 2000.0 * (parameters.maximum_flight_level / 20.0).floor();
    let machs = machs(parameters);
    let mut points = Vec::new();
    for share in MASS_SHARES {
        // To a hundredweight, so that the file's rows are what was computed.
        let mass_kg = empty_kg + share * (parameters.maximum_take_off_mass_kg - empty_kg);
        let mass = Mass::kilograms((mass_kg / 50.0).round() * 50.0);
        for level in (0..LEVELS).rev() {
            let pressure_altitude_ft = highest_ft - LEVEL_STEP_FT * f64::from(level);
            for &mach in &machs {
                let cruise = cruise(
                    parameters,
                    mass,
                    PressureAltitude::feet(pressure_altitude_ft),
                    Mach::new(mach),
                    TemperatureDifference::kelvin(0.0),
                )?;
                let (low, high) = LIFT_COEFFICIENTS;
                if (low..=high).contains(&cruise.lift_coefficient)
                    && cruise.relative_thrust <= HIGHEST_RELATIVE_THRUST
                {
                    points.push(PublicPoint { mass, pressure_altitude_ft, mach, cruise });
                }
            }
        }
    }
    Ok(points)
}

/// Mach numbers of the guide, hundredths.
fn machs(parameters: &Parameters) -> Vec<f64> {
    let first = ((parameters.design_mach - MACH_BELOW) / MACH_STEP).round();
    let last = ((parameters.maximum_mach - MACH_MARGIN) / MACH_STEP).round();
    let mut machs = Vec::new();
    let mut hundredths = first;
    while hundredths <= last {
        machs.push(hundredths / 100.0);
        hundredths += 1.0;
    }
    machs
}

/// The TSFC law nearest to the model's engine, by least squares of logarithms: ln(TSFC/√θ) = ln TSFC0 + n·ln(1 + M); and
/// the root mean square of what it misses, %.
fn tsfc_law(points: &[PublicPoint]) -> Result<(TsfcFile, f64), OutOfDomain> {
    let mut rows = Vec::new();
    for point in points {
        let sat = isa::temperature(PressureAltitude::feet(point.pressure_altitude_ft))?;
        let theta = isa::temperature_ratio(sat);
        let tsfc = point.cruise.tsfc.to_kilograms_per_newton_second();
        rows.push((point.mach.ln_1p(), (tsfc / theta.sqrt()).ln()));
    }
    let count = rows.len() as f64;
    let mean = |pick: fn(&(f64, f64)) -> f64| rows.iter().map(pick).sum::<f64>() / count;
    let (x_mean, y_mean) = (mean(|row| row.0), mean(|row| row.1));
    let covariance: f64 = rows.iter().map(|(x, y)| (x - x_mean) * (y - y_mean)).sum();
    let variance: f64 = rows.iter().map(|(x, _)| (x - x_mean).powi(2)).sum();
    // Two digits: the law misses the model by far more.
    let mach_exponent = (100.0 * covariance / variance).round() / 100.0;
    let static_tsfc = (y_mean - mach_exponent * x_mean).exp();
    let squares: f64 =
        rows.iter().map(|(x, y)| (y - static_tsfc.ln() - mach_exponent * x).powi(2)).sum();
    let pounds = static_tsfc / TSFC_SI_PER_POUND_PER_POUND_FORCE_HOUR;
    let file = TsfcFile { static_lb_per_lbf_h: (1e4 * pounds).round() / 1e4, mach_exponent };
    Ok((file, 100.0 * (squares / count).sqrt()))
}

/// Axes that span the points, on whole steps.
fn table(points: &[PublicPoint]) -> TableFile {
    let axis = |values: Vec<f64>, step: f64| {
        let (low, high) =
            values.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        let decimals = |value: f64| (value * 100.0).round() / 100.0;
        AxisFile::Step {
            from: decimals((low / step).floor() * step),
            to: decimals((high / step).ceil() * step),
            step,
        }
    };
    TableFile {
        lift_coefficient: axis(
            points.iter().map(|point| point.cruise.lift_coefficient).collect(),
            TABLE_STEP_LIFT_COEFFICIENT,
        ),
        // A hundredth beyond either end would round to the next step only by accident.
        mach: axis(points.iter().map(|point| point.mach).collect(), TABLE_STEP_MACH),
    }
}
