//! Findings about a guide that is used nevertheless.

use flight::{Finding, Severity};

use lut::Outside;

use super::odd_row::odd_row;
use super::{GuideFit, GuideObservation};
use crate::{Aircraft, Guide, PerformanceModel, poll_schumann};

/// Growth of an error above which the guide has too few rows somewhere in its range: a guide rounded to 0.5 % is off by
/// more than 2.5 % there. Guides that span weights, altitudes and speeds reach 1 to 3.
const THIN_AMPLIFICATION: f64 = 5.0;
/// Residual above which the polynomial, or the TSFC law behind it, does not follow the guide, %. A quadratic polynomial
/// misses a drag rise by 1 to 3 %.
const LARGE_RESIDUAL_PERCENT: f64 = 5.0;
/// A row with a residual of this many times the root mean square is probably mistyped, unless the rows about it rise with it.
const ODD_ROW_FACTOR: f64 = 5.0;
/// Residual within which a row is as guides are rounded, %.
const ROUNDING_PERCENT: f64 = 1.0;
/// How far a table may be off its own polynomial between its nodes, root mean square, % of drag: a quarter of the scatter of guides
/// about theirs.
const COARSE_TABLE_PERCENT: f64 = 0.5;

/// Lift-to-drag ratios that an aircraft in cruise may have. A flow halved or a mass in lb under kg doubles it.
const LIFT_TO_DRAG: (f64, f64) = (6.0, 24.0);
/// Beyond these a light jet or a sailplane-like wing is possible, a wrong unit more likely: 9 for a light jet, 23.2 for the
/// best airliner of today.
///
/// # Source
/// Parameters of the 68 types of Poll and Schumann's model ([`poll_schumann`]): (η L/D) over η of the design point is 14.9 to
/// 23.2. A320 17 to 18, 787 21 to 21.4, A350 21.9 and 22.4, A330neo 22.6 and 23.2.
const USUAL_LIFT_TO_DRAG: (f64, f64) = (9.0, 23.2);
/// Drag coefficients in cruise, the median of a guide: of these the ratio of lift to drag cannot tell half the flow, as light jets
/// have half the ratio of long-range airliners. A lower one is friction of no aircraft.
///
/// # Source
/// The guides of the 68 public types and our three fixtures: 0.0193 (A350-1000) to 0.0352 (Global 5000). Half the flow makes 0.0096 to
/// 0.0176 of them, and is below the first limit for all but the last.
const DRAG_COEFFICIENT: (f64, f64) = (0.0170, 0.0190);
/// Lift coefficients of cruise, the median of a guide.
const LIFT_COEFFICIENT: (f64, f64) = (0.15, 0.75);
/// Mean deviation from the public model of the type worth a word, %: two such models differ by up to 15 %.
const PUBLIC_WARNING_PERCENT: f64 = 15.0;
/// And beyond which a column is in another unit, %.
const PUBLIC_SERIOUS_PERCENT: f64 = 30.0;

/// Findings about a guide, from its rows and from the fit.
pub(super) fn of_guide(
    aircraft: &Aircraft,
    guide: &Guide,
    (rows, residuals_percent): (&[GuideObservation], &[f64]),
    fit: &GuideFit,
) -> Vec<Finding> {
    let mut findings: Vec<Finding> =
        [of_drag(rows), lift_coefficient(rows), against_public(aircraft, guide)]
            .into_iter()
            .flatten()
            .collect();
    findings.extend(from_fit(fit, guide));
    findings.extend(mistyped(aircraft, guide, (rows, residuals_percent), fit));
    findings.extend(extrapolated(fit, aircraft.grid().nodes()));
    findings
}

/// A table whose chords leave the polynomial between its nodes: its predictions are off the guide's by as much.
///
/// ```text
/// e = D_table/D_polynomial − 1 at the guide's rows;   a chord over a step h is off by at most h²·|D''|/8     [tables.3]
/// ```
pub(super) fn coarse_table(model: &PerformanceModel, rows: &[GuideObservation]) -> Option<Finding> {
    let (table, polynomial) = (model.drag_table(), model.polynomial());
    let off_percent = |row: &GuideObservation| {
        let cell = table.grid().locate(row.lift_coefficient, row.mach, Outside::Error).ok()?;
        let known = polynomial.value(row.lift_coefficient, row.mach);
        Some(100.0 * (table.interpolate(&cell) / known - 1.0))
    };
    let off: Vec<f64> = rows.iter().filter_map(off_percent).collect();
    let count = off.len() as f64;
    let rms = (off.iter().map(|percent| percent * percent).sum::<f64>() / count).sqrt();
    if off.is_empty() || rms < COARSE_TABLE_PERCENT {
        return None;
    }
    let mean = off.iter().sum::<f64>() / count;
    let largest = off.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    // The error grows with the square of the step.
    let share = (COARSE_TABLE_PERCENT / 2.0 / rms).sqrt();
    Some(finding(
        Severity::Warning,
        "guide-coarse-table",
        format!(
            "between its nodes the table is {rms:.1} % of drag off the polynomial (root mean square over the guide's rows; mean {mean:+.1} %, largest {largest:+.1} %), and so are its predictions: take steps of {share:.1} of these"
        ),
    ))
}

fn finding(severity: Severity, code: &'static str, message: String) -> Finding {
    Finding { severity, code, message, line: None }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// What the drag of the rows says of the flow. A slip of units shows in the ratio of lift to drag or in the drag coefficient: of the two
/// findings the graver one, which is that with the cause.
fn of_drag(rows: &[GuideObservation]) -> Option<Finding> {
    let found = [lift_to_drag(rows), drag_coefficient(rows)].into_iter().flatten();
    // Of two alike the last one is taken: the ratio is better known.
    found.rev().max_by_key(|finding| finding.severity)
}

fn drag_coefficient(rows: &[GuideObservation]) -> Option<Finding> {
    let value = median(rows.iter().map(|row| row.drag_coefficient).collect());
    let (serious, usual) = DRAG_COEFFICIENT;
    if value >= usual {
        return None;
    }
    Some(finding(
        if value < serious { Severity::Serious } else { Severity::Warning },
        "guide-drag-coefficient",
        format!(
            "the guide makes a drag coefficient of {value:.4} (median), aircraft in cruise have {usual} or more: {LITTLE_FLOW}, too \
             large a wing area or too large a TSFC"
        ),
    ))
}

/// What makes a guide's flow too small for its aircraft.
const LITTLE_FLOW: &str = "fuel flow of one engine as total, flow in kg/h under lb/h";

fn lift_to_drag(rows: &[GuideObservation]) -> Option<Finding> {
    let ratio =
        median(rows.iter().map(|row| row.lift_coefficient / row.drag_coefficient).collect());
    let (low, high) = USUAL_LIFT_TO_DRAG;
    if (low..=high).contains(&ratio) {
        return None;
    }
    let is_possible = (LIFT_TO_DRAG.0..=LIFT_TO_DRAG.1).contains(&ratio);
    let cause = if ratio > high {
        format!("mass in lb under mass_kg, {LITTLE_FLOW}, or too large a TSFC")
    } else {
        "mass in kg under weight_lb, flow in lb/h under kg/h, or too small a TSFC".to_owned()
    };
    Some(finding(
        if is_possible { Severity::Warning } else { Severity::Serious },
        "guide-lift-to-drag",
        format!(
            "the guide makes a lift-to-drag ratio of {ratio:.2} (median), aircraft in cruise have {low} to {high}: {cause}"
        ),
    ))
}

fn lift_coefficient(rows: &[GuideObservation]) -> Option<Finding> {
    let value = median(rows.iter().map(|row| row.lift_coefficient).collect());
    let (low, high) = LIFT_COEFFICIENT;
    if (low..=high).contains(&value) {
        return None;
    }
    let cause = if value > high {
        "mass in lb under mass_kg, or too small a wing area"
    } else {
        "mass in kg under weight_lb, pressure altitude in metres under pressure_altitude_ft, or too large a wing area"
    };
    Some(finding(
        Severity::Serious,
        "guide-lift-coefficient",
        format!(
            "the guide's median lift coefficient is {value:.2}, cruise is flown at {low} to {high}: {cause}"
        ),
    ))
}

/// Against the public model, for a type that has one: of a type that another one represents nobody states how near it is.
fn against_public(aircraft: &Aircraft, guide: &Guide) -> Option<Finding> {
    let parameters = poll_schumann::find(aircraft.type_code())?;
    if !parameters.is_of(aircraft.type_code()) {
        return None;
    }
    let percent = poll_schumann::mean_deviation_percent(parameters, guide)?;
    if percent.abs() < PUBLIC_WARNING_PERCENT {
        return None;
    }
    let severity =
        if percent.abs() > PUBLIC_SERIOUS_PERCENT { Severity::Serious } else { Severity::Warning };
    Some(finding(
        severity,
        "guide-against-public-model",
        format!(
            "fuel flow of the guide is {percent:+.0} % off the public model of {} on average: check the units of mass and flow, and whether the flow is of all engines",
            parameters.type_code
        ),
    ))
}

fn from_fit(fit: &GuideFit, guide: &Guide) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut warn = |code, message| findings.push(finding(Severity::Warning, code, message));
    if let (1, Some(point)) = (fit.pressure_altitudes, guide.points().first()) {
        warn(
            "guide-one-pressure-altitude",
            format!(
                "the guide has one pressure altitude only ({:.0} ft): drag at other altitudes rests on the TSFC law alone",
                point.pressure_altitude.to_feet()
            ),
        );
    }
    if fit.amplification > THIN_AMPLIFICATION {
        warn(
            "guide-thin",
            format!(
                "an error of 1 % in the guide's rows grows to {:.0} % somewhere in its range: it has few weights or speeds",
                fit.amplification
            ),
        );
    }
    if fit.residual_rms_percent > LARGE_RESIDUAL_PERCENT {
        warn(
            "guide-fit-residual",
            format!(
                "the polynomial misses the guide by {:.1} % (root mean square): check the TSFC constants and the units",
                fit.residual_rms_percent
            ),
        );
    }
    findings
}

/// A row that is far off the polynomial, though the rows about it are not.
fn mistyped(
    aircraft: &Aircraft,
    guide: &Guide,
    (rows, residuals_percent): (&[GuideObservation], &[f64]),
    fit: &GuideFit,
) -> Option<Finding> {
    let least = (ODD_ROW_FACTOR * fit.residual_rms_percent).max(ROUNDING_PERCENT);
    let index = odd_row(aircraft.polynomial(), rows, residuals_percent, least)?;
    Some(Finding {
        severity: Severity::Warning,
        code: "guide-odd-row",
        message: format!(
            "this row lies {:+.1} % off the polynomial, the rows together {:.1} %, and the rows about it do not: probably mistyped",
            residuals_percent.get(index)?,
            fit.residual_rms_percent
        ),
        line: guide.points().get(index).and_then(|point| usize::try_from(point.line).ok()),
    })
}

fn extrapolated(fit: &GuideFit, nodes: usize) -> Option<Finding> {
    if fit.extrapolated_nodes == 0 {
        return None;
    }
    let severity = if fit.extrapolated_nodes == nodes { Severity::Warning } else { Severity::Note };
    Some(finding(
        severity,
        "guide-extrapolated-nodes",
        format!(
            "{} of {nodes} nodes lie outside the guide's range (lift coefficient {:.3} to {:.3}, Mach number {:.3} to {:.3}): the polynomial is extrapolated there",
            fit.extrapolated_nodes,
            fit.lift_coefficients.0,
            fit.lift_coefficients.1,
            fit.machs.0,
            fit.machs.1
        ),
    ))
}
