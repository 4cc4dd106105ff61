//! Findings about a guide that is used nevertheless.

use flight::{Finding, Severity};

use super::GuideFit;
use crate::Guide;

/// Growth of an error above which the guide has too few rows somewhere in its range: a guide rounded to 0.5 % is off by
/// more than 2.5 % there. Guides that span weights, altitudes and speeds reach 1 to 3.
const THIN_AMPLIFICATION: f64 = 5.0;
/// Residual above which the polynomial, or the TSFC law behind it, does not follow the guide, %. A quadratic polynomial
/// misses a drag rise by 1 to 3 %.
const LARGE_RESIDUAL_PERCENT: f64 = 5.0;
/// A row with a residual of this many times the root mean square is probably mistyped.
const ODD_ROW_FACTOR: f64 = 5.0;

pub(super) fn from_fit(fit: &GuideFit, guide: &Guide, nodes: usize) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut find = |severity, code, message, line| {
        findings.push(Finding { severity, code, message, line });
    };
    if let (1, Some(point)) = (fit.pressure_altitudes, guide.points().first()) {
        find(
            Severity::Warning,
            "guide-one-pressure-altitude",
            format!(
                "the guide has one pressure altitude only ({:.0} ft): drag at other altitudes rests on the TSFC law alone",
                point.pressure_altitude.to_feet()
            ),
            None,
        );
    }
    if fit.amplification > THIN_AMPLIFICATION {
        find(
            Severity::Warning,
            "guide-thin",
            format!(
                "an error of 1 % in the guide's rows grows to {:.0} % somewhere in its range: it has few weights or speeds",
                fit.amplification
            ),
            None,
        );
    }
    if fit.residual_rms_percent > LARGE_RESIDUAL_PERCENT {
        find(
            Severity::Warning,
            "guide-fit-residual",
            format!(
                "the polynomial misses the guide by {:.1} % (root mean square): check the TSFC constants and the units",
                fit.residual_rms_percent
            ),
            None,
        );
    }
    let (line, percent) = fit.worst_row;
    if percent.abs() > ODD_ROW_FACTOR * fit.residual_rms_percent && percent.abs() > 1.0 {
        find(
            Severity::Warning,
            "guide-odd-row",
            format!(
                "this row lies {percent:+.1} % off the polynomial, the rows together {:.1} %: mistyped?",
                fit.residual_rms_percent
            ),
            usize::try_from(line).ok(),
        );
    }
    if fit.extrapolated_nodes > 0 {
        let severity =
            if fit.extrapolated_nodes == nodes { Severity::Warning } else { Severity::Note };
        find(
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
            None,
        );
    }
    findings
}
