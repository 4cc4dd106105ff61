//! Why a guide does not give an initial model.

use lut::TableError;
use lut::surface::{COEFFICIENTS, FitError};
use units::OutOfDomain;

use crate::ModelError;

/// Why a guide does not give an initial model.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InitialModelError {
    /// Fewer rows than coefficients.
    #[error("{found} rows do not determine the polynomial's {needed} coefficients")]
    TooFewPoints {
        /// Rows found.
        found: usize,
        /// Coefficients.
        needed: usize,
    },
    /// The rows leave a direction undetermined.
    #[error(
        "the guide does not determine the polynomial: {reason} (rank {rank} of 6, condition number {condition_number:.1e})"
    )]
    NotDetermined {
        /// Directions that are determined.
        rank: usize,
        /// Ratio of largest to smallest singular value of the design; may be infinite.
        condition_number: f64,
        /// What the rows do not determine.
        reason: Undetermined,
    },
    /// The rows have full rank, but a small error of theirs swamps the polynomial within their own range.
    #[error(
        "the guide does not determine the polynomial: an error of 1 % in its rows would be {amplification:.3} % at lift coefficient {lift_coefficient:.3}, Mach number {mach:.3}, within its own range (at most {maximum} % is admitted). Its {rows} rows have {weights} different weights and {pressure_altitudes} different pressure altitudes: they lie near one curve of lift coefficient over Mach number (condition number {condition_number:.1e})"
    )]
    PoorlyDetermined {
        /// Growth of an error.
        amplification: f64,
        /// Largest growth that is allowed.
        maximum: f64,
        /// Lift coefficient where it grows most.
        lift_coefficient: f64,
        /// Mach number where it grows most.
        mach: f64,
        /// Rows of the guide.
        rows: usize,
        /// Different weights among them.
        weights: usize,
        /// Different pressure altitudes among them.
        pressure_altitudes: usize,
        /// Ratio of largest to smallest singular value of the design.
        condition_number: f64,
    },
    /// The polynomial is not positive at a node.
    #[error(
        "the polynomial's drag coefficient {drag_coefficient:.5} at lift coefficient {lift_coefficient}, Mach number {mach} is not positive: {}",
        if *.extrapolated {
            format!(
                "the node lies outside the guide's range (lift coefficient {:.3} to {:.3}, Mach number {:.3} to {:.3}): narrow the \
                 table, or, where the aircraft flies there, check the guide's units: metres under pressure_altitude_ft or \
                 kilograms under weight_lb make the lift coefficients too small",
                .lift_coefficients.0, .lift_coefficients.1, .machs.0, .machs.1
            )
        } else {
            "the guide's fuel flows are not those of one aircraft".to_owned()
        }
    )]
    DragNotPositive {
        /// The node's lift coefficient.
        lift_coefficient: f64,
        /// The node's Mach number.
        mach: f64,
        /// The polynomial's value.
        drag_coefficient: f64,
        /// Whether the node lies outside the guide's range.
        extrapolated: bool,
        /// Smallest and largest lift coefficient of the guide.
        lift_coefficients: (f64, f64),
        /// Smallest and largest Mach number of the guide.
        machs: (f64, f64),
    },
    /// A row outside a domain.
    #[error("line {line}: {domain}")]
    OutOfDomain {
        /// Line of the guide.
        line: u64,
        /// What is outside.
        domain: OutOfDomain,
    },
    /// A value at a node that is not finite.
    #[error("table of the polynomial: {0}")]
    Table(TableError),
    /// Parts that do not fit.
    #[error(transparent)]
    Model(ModelError),
    /// Any other refusal of the least-squares fit.
    #[error("least squares: {0}")]
    Fit(FitError),
}

/// What a guide's rows do not determine.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Undetermined {
    /// All rows fly at one Mach number.
    #[error("all rows fly at Mach number {mach:.4}, {needed} different ones are needed")]
    OneMach {
        /// That Mach number.
        mach: f64,
        /// How many are needed.
        needed: usize,
    },
    /// Too few different Mach numbers.
    #[error("the rows fly at {distinct} different Mach numbers, {needed} are needed")]
    FewMachs {
        /// How many there are.
        distinct: usize,
        /// How many are needed.
        needed: usize,
    },
    /// All rows have one lift coefficient.
    #[error("all rows have lift coefficient {lift_coefficient:.4}, different ones are needed")]
    OneLiftCoefficient {
        /// That lift coefficient.
        lift_coefficient: f64,
    },
    /// Too few different lift coefficients.
    #[error("the rows have {distinct} different lift coefficients, {needed} are needed")]
    FewLiftCoefficients {
        /// How many there are.
        distinct: usize,
        /// How many are needed.
        needed: usize,
    },
    /// The rows lie on one curve, as those of one weight at one altitude do.
    #[error(
        "lift coefficient and Mach number of the rows depend on each other, as those of one weight at one altitude do"
    )]
    OneCurve,
}

/// A polynomial that makes no model; `inside` tells whether a node lies inside the guide's range of lift coefficients and Mach numbers.
pub(super) fn from_model(
    error: ModelError,
    inside: impl Fn((f64, f64)) -> bool,
    (lift_coefficients, machs): ((f64, f64), (f64, f64)),
) -> InitialModelError {
    match error {
        ModelError::DragNotPositive { lift_coefficient, mach, drag_coefficient } => {
            InitialModelError::DragNotPositive {
                lift_coefficient,
                mach,
                drag_coefficient,
                extrapolated: !inside((lift_coefficient, mach)),
                lift_coefficients,
                machs,
            }
        }
        other => InitialModelError::Model(other),
    }
}

/// In the field's words.
pub(super) fn from_fit(error: FitError, rows: usize) -> InitialModelError {
    use lut::surface::Undetermined as Of;

    let FitError::RankDeficient { rank, condition_number, undetermined } = error else {
        return match error {
            FitError::TooFewPoints { .. } => {
                InitialModelError::TooFewPoints { found: rows, needed: COEFFICIENTS }
            }
            other => InitialModelError::Fit(other),
        };
    };
    let reason = match undetermined {
        // Either basis is a parabola in Mach number.
        Of::SameY { value } => Undetermined::OneMach { mach: value, needed: 3 },
        Of::FewY { distinct, needed } => Undetermined::FewMachs { distinct, needed },
        Of::SameX { value } => Undetermined::OneLiftCoefficient { lift_coefficient: value },
        Of::FewX { distinct, needed } => Undetermined::FewLiftCoefficients { distinct, needed },
        _ => Undetermined::OneCurve,
    };
    InitialModelError::NotDetermined { rank, condition_number, reason }
}
