//! Masses, heating value and dates of the header.

use flight::{Report, Severity};

use super::{Draft, mean};
use crate::dates::{YEARS_OF_FLIGHTS, year_of};

/// Lower heating values of jet fuel, MJ/kg: ASTM D1655 asks for 42.8 and more, measured batches reach 43.7.
const LOWER_HEATING_VALUE_MJ_KG: (f64, f64) = (42.0, 44.5);
/// One British thermal unit per pound in MJ/kg.
const MJ_KG_PER_BTU_LB: f64 = 2.326e-3;
/// Masses of aircraft with a jet or turboprop engine, kg.
const GROSS_MASS_KG: (f64, f64) = (1_500.0, 650_000.0);
/// Fuel on board per zero-fuel mass. The longest-ranged business jets reach 0.95.
const FUEL_PER_ZERO_FUEL_MASS: f64 = 1.1;
/// Fuel burnt in an hour per gross mass. g·TSFC·D/L: 14 mg/(N s) at a lift-to-drag ratio of 21 is 0.024; 24 at 9 is
/// 0.094.
const HOURLY_FUEL_PER_MASS: (f64, f64) = (0.020, 0.105);

pub(super) fn check(report: &Report, flow_kg_s: &[f64]) -> Vec<Draft> {
    [heating_value(report), masses(report, flow_kg_s), date(report), duration(report)]
        .into_iter()
        .flatten()
        .collect()
}

/// Of averaged points, whose first and last may be of any two frames.
pub(super) fn check_point(report: &Report, flow_kg_s: &[f64]) -> Vec<Draft> {
    [heating_value(report), masses(report, flow_kg_s), date(report)].into_iter().flatten().collect()
}

fn heating_value(report: &Report) -> Option<Draft> {
    let value = report.header().lower_heating_value_mj_kg?;
    let (low, high) = LOWER_HEATING_VALUE_MJ_KG;
    if (low..=high).contains(&value) {
        return None;
    }
    let admissible = |number: f64| (low..=high).contains(&number);
    let (likely_cause, remedy) = if admissible(value * MJ_KG_PER_BTU_LB) {
        ("LHV: BTU/lb declared as MJ/kg", "LHV: multiply by 0.002326")
    } else if admissible(value / 1000.0) {
        ("LHV: kJ/kg declared as MJ/kg", "LHV: divide by 1000")
    } else if (45.0..=48.0).contains(&value) {
        ("LHV holds the higher heating value", "LHV: the lower (net) heating value")
    } else {
        ("LHV is mistyped", "LHV: as on the fuel's certificate, about 43.2 MJ/kg")
    };
    Some(Draft {
        severity: Severity::Serious,
        code: "heating-value",
        size: value,
        unit: "MJ/kg",
        message: format!("lower heating value {value} MJ/kg; jet fuel has {low} to {high}"),
        likely_cause: likely_cause.to_owned(),
        remedy: remedy.to_owned(),
    })
}

fn masses(report: &Report, flow_kg_s: &[f64]) -> Option<Draft> {
    let header = report.header();
    let columns = report.columns();
    let (zero_fuel_kg, fuel_kg) =
        (header.zero_fuel_mass.to_kilograms(), header.fuel_on_board.to_kilograms());
    let gross_kg = zero_fuel_kg + fuel_kg - mean(columns.fuel_used_kg.iter().copied())?;
    let flow_kg_s = mean(flow_kg_s.iter().copied())?;
    let hourly = 3600.0 * flow_kg_s / gross_kg;
    let draft = |severity, code, size, unit, message, likely_cause: &str, remedy: &str| Draft {
        severity,
        code,
        size,
        unit,
        message,
        likely_cause: likely_cause.to_owned(),
        remedy: remedy.to_owned(),
    };
    if !(GROSS_MASS_KG.0..=GROSS_MASS_KG.1).contains(&gross_kg) {
        return Some(draft(
            Severity::Serious,
            "mass-impossible",
            gross_kg,
            "kg",
            format!("gross mass {gross_kg:.0} kg"),
            "ZFW or FOB is mistyped or in another unit",
            "ZFW and FOB as on the load sheet, with their units",
        ));
    }
    if fuel_kg > FUEL_PER_ZERO_FUEL_MASS * zero_fuel_kg {
        return Some(draft(
            Severity::Serious,
            "fuel-against-mass",
            fuel_kg / zero_fuel_kg,
            "-",
            format!(
                "fuel on board {fuel_kg:.0} kg is {:.2} of the zero-fuel mass {zero_fuel_kg:.0} kg",
                fuel_kg / zero_fuel_kg
            ),
            "ZFW and FOB are in different units, or ZFW is mistyped",
            "ZFW and FOB as on the load sheet, with their units",
        ));
    }
    if (HOURLY_FUEL_PER_MASS.0..=HOURLY_FUEL_PER_MASS.1).contains(&hourly) {
        return None;
    }
    let likely_cause = if hourly < HOURLY_FUEL_PER_MASS.0 {
        "mass in lb declared as kg, flow in kg/h declared as lb/h, or flow of one engine as total"
    } else {
        "mass in kg declared as lb, flow in lb/h declared as kg/h, or total flow given for each engine"
    };
    Some(draft(
        Severity::Serious,
        "flow-against-mass",
        100.0 * hourly,
        "%/h",
        format!(
            "{:.1} % of the mass is burnt in an hour; aircraft in cruise burn 2 to 10 %",
            100.0 * hourly
        ),
        likely_cause,
        "compare the units of WF and of the mass (ZFW and FOB, or the column that a mapping derives them from) with their sources",
    ))
}

fn date(report: &Report) -> Option<Draft> {
    let start = report.header().identity.start;
    let year = year_of(start);
    if YEARS_OF_FLIGHTS.contains(&year) {
        return None;
    }
    Some(Draft {
        severity: Severity::Serious,
        code: "date-impossible",
        size: f64::from(year),
        unit: "year",
        message: format!("START is in the year {year}"),
        likely_cause: "a date of two digits, a clock that was not set, or an epoch in another unit"
            .to_owned(),
        remedy: "START with the year in four digits; for an epoch state s, ms or ns".to_owned(),
    })
}

/// A report that lasts too long for one flight, or is too short for a cruise.
fn duration(report: &Report) -> Option<Draft> {
    let time_s = &report.columns().time_s;
    let duration_s = time_s[time_s.len() - 1] - time_s[0];
    let (code, likely_cause, remedy) = if duration_s > 24.0 * 3600.0 {
        (
            "duration-impossible",
            "TIME in seconds declared as minutes, or several flights in one",
            "unit s instead of min for TIME",
        )
    } else if duration_s < 240.0 {
        (
            "duration-short",
            "TIME in minutes declared as seconds, or a report cut short",
            "unit min instead of s for TIME",
        )
    } else {
        return None;
    };
    Some(Draft {
        severity: Severity::Warning,
        code,
        size: duration_s,
        unit: "s",
        message: format!("{} samples over {duration_s:.0} s", time_s.len()),
        likely_cause: likely_cause.to_owned(),
        remedy: remedy.to_owned(),
    })
}
