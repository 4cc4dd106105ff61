//! The drag polar of OpenAP: CD = cd0 + k·CL² at one Mach number.

use std::fmt::Write;

use lut::SmoothCell;

use super::{LeftOut, informed, origin, remainder_left_out, rms_and_largest};
use crate::model_file::ModelFile;

/// Lift coefficients at which the table is read for the fit: enough that their number does not matter.
const POINTS: u32 = 100;

/// OpenAP's polar fitted to a model.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenapPolar {
    /// Mach number of the fit.
    pub mach: f64,
    /// Informed lift coefficients there, which the fit is over.
    pub lift_coefficients: (f64, f64),
    /// Zero-lift drag coefficient.
    pub cd0: f64,
    /// Factor of CL².
    pub k: f64,
    /// Root mean square of what the polar misses of the smooth surface through the table's nodes, % of drag.
    pub rms_percent: f64,
    /// Largest miss, % of drag.
    pub maximum_percent: f64,
    origin: String,
    left_out: Option<LeftOut>,
}

/// Why there is no polar.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OpenapError {
    /// Fewer than two informed lift coefficients.
    #[error(
        "at Mach number {mach} guide and flights inform fewer than two lift coefficients of the table"
    )]
    NotInformed {
        /// The Mach number.
        mach: f64,
    },
    /// A slope or an intercept that no polar has.
    #[error("the best polar has cd0 {cd0} and k {k}: both must be positive")]
    NotAPolar {
        /// Zero-lift drag coefficient.
        cd0: f64,
        /// Factor of CL².
        k: f64,
    },
}

/// The polar nearest to the table at a Mach number, by ordinary least squares over the lift coefficients that guide or
/// flights inform there; without a Mach number, at the mean one of the learnt flights, or in the middle of the guide's.
///
/// # Errors
/// [`OpenapError`] where the table is not informed there, or no polar follows.
pub fn openap(model: &ModelFile, mach: Option<f64>) -> Result<OpenapPolar, OpenapError> {
    let flown = model.learnt.as_ref().and_then(|learnt| learnt.references.mean("mach"));
    let (low, high) = model.guide.mach;
    let mach = mach.or(flown).unwrap_or_else(|| f64::midpoint(low, high));
    let grid = model.grid();
    let informed = informed(model);
    let columns = grid.y().len();
    let at = grid.y().breakpoints().partition_point(|breakpoint| *breakpoint <= mach);
    // Both columns about the Mach number; at one of them, that one alone.
    let below = at.saturating_sub(1);
    let is_at_below = grid.y().breakpoints()[below] >= mach;
    let about = [below, if is_at_below { below } else { at.min(columns - 1) }];
    let mut lift_coefficients = grid
        .x()
        .breakpoints()
        .iter()
        .enumerate()
        .filter(|(row, _)| about.iter().all(|column| informed[row * columns + column]))
        .map(|(_, lift)| *lift);
    let missing = OpenapError::NotInformed { mach };
    let first = lift_coefficients.next().ok_or(missing)?;
    let last = lift_coefficients.next_back().ok_or(missing)?;
    let points: Vec<(f64, f64)> = (0..=POINTS)
        .map(|k| first + (last - first) * f64::from(k) / f64::from(POINTS))
        .filter_map(|lift| {
            let cell = SmoothCell::locate(grid, lift, mach).ok()?;
            Some((lift * lift, cell.value_of(model.drag_coefficient())))
        })
        .collect();
    let (cd0, k) = line(&points).ok_or(missing)?;
    if !(cd0 > 0.0 && k > 0.0) {
        return Err(OpenapError::NotAPolar { cd0, k });
    }
    let misses: Vec<f64> =
        points.iter().map(|(square, drag)| 100.0 * ((cd0 + k * square) / drag - 1.0)).collect();
    let [rms_percent, maximum_percent] = rms_and_largest(&misses).ok_or(missing)?;
    Ok(OpenapPolar {
        mach,
        lift_coefficients: (first, last),
        cd0,
        k,
        rms_percent,
        maximum_percent,
        origin: origin(model),
        left_out: remainder_left_out(model),
    })
}

impl OpenapPolar {
    /// The text of `data/dragpolar/TYPE.yml`.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        let mut text = String::new();
        let (first, last) = self.lift_coefficients;
        let _ = writeln!(text, "# cruisefit: {}", self.origin.replace(['\n', '\r'], " "));
        let _ = writeln!(
            text,
            "# Fitted at Mach number {:.4} over lift coefficients {first} to {last}; it misses the smooth surface through the table's nodes by {:.2} % rms, {:.2} % at most.",
            self.mach, self.rms_percent, self.maximum_percent
        );
        let _ = writeln!(
            text,
            "# Cruise only: nothing is known of gears and flaps. The wing area is that of the aircraft file."
        );
        if let Some(left_out) = self.left_out {
            let _ = writeln!(text, "# Drag alone: {}.", left_out.words());
        }
        let name = serde_json::to_string(&self.origin).unwrap_or_default();
        let _ = writeln!(text, "aircraft: {name}\n\nclean:\n  cd0: {}\n  k: {}", self.cd0, self.k);
        text
    }
}

/// Intercept and slope of the least-squares line; `None` where the abscissas are all alike.
fn line(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let count = points.len() as f64;
    let x_mean = points.iter().map(|(x, _)| x).sum::<f64>() / count;
    let y_mean = points.iter().map(|(_, y)| y).sum::<f64>() / count;
    let xx: f64 = points.iter().map(|(x, _)| (x - x_mean).powi(2)).sum();
    let xy: f64 = points.iter().map(|(x, y)| (x - x_mean) * (y - y_mean)).sum();
    let slope = xy / xx;
    (xx > 0.0 && slope.is_finite()).then_some((y_mean - slope * x_mean, slope))
}
