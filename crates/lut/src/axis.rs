//! An axis of a table: checked breakpoints and the search among them.

use serde::{Deserialize, Serialize};

use buckets::Buckets;

mod buckets;
mod decimal;

/// A coordinate this near to a breakpoint is that breakpoint. In the axis' own unit; book `[tables.1]`.
pub const SNAP: f64 = 1e-9;

/// Largest magnitude of a breakpoint: squares of distances stay far from overflow.
const MAXIMUM_MAGNITUDE: f64 = 1e100;
/// Largest number of breakpoints that [`Axis::from_step`] makes: a larger one is a mistyped step.
const MAXIMUM_BREAKPOINTS: usize = 1_000_000;
/// Breakpoints of one axis: two or more, finite, increasing, no two closer than twice [`SNAP`].
///
/// ```
/// let axis = lut::Axis::from_step(0.1, 0.8, 0.05)?;
/// assert_eq!(axis.len(), 15);
/// assert_eq!(axis.breakpoints()[4], 0.3); // and not 0.1 + 4.0 * 0.05, which is 0.30000000000000004
/// # Ok::<(), lut::AxisError>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Vec<f64>", into = "Vec<f64>")]
pub struct Axis {
    breakpoints: Vec<f64>,
    /// Derived from the breakpoints.
    buckets: Buckets,
}

/// Why breakpoints do not make an axis.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AxisError {
    /// Fewer than two breakpoints span no cell.
    #[error("{count} breakpoints, an axis needs 2 or more")]
    TooShort {
        /// How many were given.
        count: usize,
    },
    /// A breakpoint is not finite or too large to square.
    #[error("breakpoint {index} is {value}, outside -1e100 to 1e100")]
    NotFinite {
        /// Its index, from 0.
        index: usize,
        /// The value given.
        value: f64,
    },
    /// A breakpoint does not exceed its predecessor.
    #[error("breakpoint {index} is {value} after {previous}: breakpoints must increase")]
    NotIncreasing {
        /// Index of the second of the two, from 0.
        index: usize,
        /// The first of the two.
        previous: f64,
        /// The second of the two.
        value: f64,
    },
    /// Two breakpoints are so close that one point would lie on both.
    #[error("breakpoint {index} is {value} after {previous}: closer than 2e-9")]
    TooClose {
        /// Index of the second of the two, from 0.
        index: usize,
        /// The first of the two.
        previous: f64,
        /// The second of the two.
        value: f64,
    },
    /// First, last or step of an even axis is not finite, or has more digits than exact decimal arithmetic holds.
    #[error("axis from {from} to {to} by {step}: not finite, or too many digits")]
    StepDigits {
        /// First breakpoint.
        from: f64,
        /// Last breakpoint.
        to: f64,
        /// Distance between neighbors.
        step: f64,
    },
    /// The step is not positive, or does not lead from the first to the last breakpoint.
    #[error("a step of {step} does not lead from {from} to {to}")]
    StepDoesNotReach {
        /// First breakpoint.
        from: f64,
        /// Last breakpoint.
        to: f64,
        /// Distance between neighbors.
        step: f64,
    },
    /// The step asks for more than a million breakpoints.
    #[error("axis from {from} to {to} by {step}: more than 1000000 breakpoints")]
    TooLong {
        /// First breakpoint.
        from: f64,
        /// Last breakpoint.
        to: f64,
        /// Distance between neighbors.
        step: f64,
    },
}

/// Where a coordinate lies on an axis: the cell, and the distances to its two ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Position {
    pub(crate) index: usize,
    pub(crate) above_low: f64,
    pub(crate) below_high: f64,
    pub(crate) width: f64,
    pub(crate) held: bool,
}

impl Position {
    /// Whether both ends of the cell are farther away than [`SNAP`].
    #[inline]
    pub(crate) fn is_off_breakpoints(&self) -> bool {
        self.above_low > SNAP && self.below_high > SNAP
    }
}

impl Axis {
    /// An axis of these breakpoints.
    ///
    /// # Errors
    /// [`AxisError`] states which breakpoint is wrong, and how.
    pub fn new(breakpoints: Vec<f64>) -> Result<Self, AxisError> {
        if breakpoints.len() < 2 {
            return Err(AxisError::TooShort { count: breakpoints.len() });
        }
        for (index, &value) in breakpoints.iter().enumerate() {
            if value.is_nan() || value.abs() > MAXIMUM_MAGNITUDE {
                return Err(AxisError::NotFinite { index, value });
            }
        }
        for (index, pair) in breakpoints.windows(2).enumerate() {
            let (index, previous, value) = (index + 1, pair[0], pair[1]);
            if value <= previous {
                return Err(AxisError::NotIncreasing { index, previous, value });
            }
            if value - previous <= 2.0 * SNAP {
                return Err(AxisError::TooClose { index, previous, value });
            }
        }
        let buckets = Buckets::new(&breakpoints);
        Ok(Self { breakpoints, buckets })
    }

    /// An even axis; every breakpoint is the double nearest to its decimal number, as if all had been typed.
    ///
    /// `to` counts as reached within [`SNAP`]; the last breakpoint is then the decimal `from + n·step`.
    ///
    /// # Errors
    /// [`AxisError`] where the step does not lead from `from` to `to`, or the result is not an axis.
    pub fn from_step(from: f64, to: f64, step: f64) -> Result<Self, AxisError> {
        let cells = ((to - from) / step).round();
        let decimals = decimal::Progression::new(from, step);
        let Some(decimals) = decimals.filter(|_| to.is_finite()) else {
            return Err(AxisError::StepDigits { from, to, step });
        };
        if !(step > 0.0 && cells >= 1.0) {
            return Err(AxisError::StepDoesNotReach { from, to, step });
        }
        if cells >= MAXIMUM_BREAKPOINTS as f64 {
            return Err(AxisError::TooLong { from, to, step });
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number between 1 and a million"
        )]
        let cells = cells as u32;
        let breakpoints: Option<Vec<f64>> = (0..=cells).map(|i| decimals.value(i)).collect();
        let Some(breakpoints) = breakpoints else {
            return Err(AxisError::StepDigits { from, to, step });
        };
        if !breakpoints.last().is_some_and(|last| (last - to).abs() <= SNAP) {
            return Err(AxisError::StepDoesNotReach { from, to, step });
        }
        Self::new(breakpoints)
    }

    /// The breakpoints, increasing.
    #[must_use]
    pub fn breakpoints(&self) -> &[f64] {
        &self.breakpoints
    }

    /// Number of breakpoints, at least 2.
    #[expect(clippy::len_without_is_empty, reason = "an axis is never empty")]
    #[must_use]
    pub fn len(&self) -> usize {
        self.breakpoints.len()
    }

    /// The smallest breakpoint.
    #[must_use]
    #[inline]
    pub fn first(&self) -> f64 {
        self.breakpoints[0]
    }

    /// The largest breakpoint.
    #[must_use]
    #[inline]
    pub fn last(&self) -> f64 {
        self.breakpoints[self.breakpoints.len() - 1]
    }

    /// Whether `coordinate` is at least the first and below the last breakpoint.
    #[inline]
    pub(crate) fn spans(&self, coordinate: f64) -> bool {
        self.first() <= coordinate && coordinate < self.last()
    }

    /// Position of `coordinate`, which the axis must span; not yet snapped to a breakpoint.
    #[expect(
        clippy::inline_always,
        reason = "a position through memory costs more than the search: measured"
    )]
    #[inline(always)]
    pub(crate) fn position_unsnapped(&self, coordinate: f64) -> Position {
        let index = self.buckets.cell(&self.breakpoints, coordinate);
        let (low, high) = (self.breakpoints[index], self.breakpoints[index + 1]);
        Position {
            index,
            above_low: coordinate - low,
            below_high: high - coordinate,
            width: high - low,
            held: false,
        }
    }

    /// Cells of several coordinates, and the shares of the cells' widths at which they lie. False in `is_off` where a coordinate
    /// is outside or within [`SNAP`] of a breakpoint; what is written there has no meaning.
    ///
    /// Only what must be looked up is done point by point.
    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[expect(clippy::needless_bitwise_bool, reason = "no branch, so that compilers make vectors")]
    #[inline(always)]
    pub(crate) fn place_all<const N: usize>(
        &self,
        coordinates: &[f64; N],
        cells: &mut [usize; N],
        shares: &mut [f64; N],
        is_off: &mut [bool; N],
    ) {
        let (first, last) = (self.first(), self.last());
        let mut held = [first; N];
        for place in 0..N {
            let coordinate = coordinates[place];
            // Also where it is no number.
            let inside = (first <= coordinate) & (coordinate < last);
            held[place] = if inside { coordinate } else { first };
        }
        let mut ends = ([0.0; N], [0.0; N]);
        for place in 0..N {
            let index = self.buckets.cell(&self.breakpoints, held[place]);
            let (low, high) = (self.breakpoints[index], self.breakpoints[index + 1]);
            cells[place] = index;
            (ends.0[place], ends.1[place]) = (low, high);
        }
        for place in 0..N {
            let (above_low, below_high) =
                (coordinates[place] - ends.0[place], ends.1[place] - coordinates[place]);
            shares[place] = above_low / (ends.1[place] - ends.0[place]);
            is_off[place] &= (above_low > SNAP) & (below_high > SNAP);
        }
    }

    /// Width of a cell.
    #[inline]
    pub(crate) fn width(&self, cell: usize) -> f64 {
        self.breakpoints[cell + 1] - self.breakpoints[cell]
    }

    /// Position of `coordinate`, `None` beyond the ends (or NaN); with `hold`, what is beyond takes the position of the
    /// nearer end.
    pub(crate) fn position(&self, coordinate: f64, hold: bool) -> Option<Position> {
        let (first, last) = (self.first(), self.last());
        // Within SNAP of an end a point is that end, and therefore inside.
        let inside = first - coordinate <= SNAP && coordinate - last <= SNAP;
        if !(inside || hold && coordinate.is_finite()) {
            return None;
        }
        if self.spans(coordinate) {
            let position = self.position_unsnapped(coordinate);
            if position.is_off_breakpoints() {
                return Some(position);
            }
        }
        let at = coordinate.clamp(first, last);
        let nearest = self.breakpoints.partition_point(|&breakpoint| at - breakpoint > SNAP);
        Some(Position { held: !inside, ..self.position_of_breakpoint(nearest) })
    }

    /// A breakpoint: the low end of its cell, or the high end of the last one.
    fn position_of_breakpoint(&self, breakpoint: usize) -> Position {
        let index = breakpoint.min(self.breakpoints.len() - 2);
        let width = self.breakpoints[index + 1] - self.breakpoints[index];
        let (above_low, below_high) = if breakpoint == index { (0.0, width) } else { (width, 0.0) };
        Position { index, above_low, below_high, width, held: false }
    }
}

impl PartialEq for Axis {
    fn eq(&self, other: &Self) -> bool {
        self.breakpoints == other.breakpoints
    }
}

impl TryFrom<Vec<f64>> for Axis {
    type Error = AxisError;
    fn try_from(breakpoints: Vec<f64>) -> Result<Self, AxisError> {
        Self::new(breakpoints)
    }
}

impl From<Axis> for Vec<f64> {
    fn from(axis: Axis) -> Self {
        axis.breakpoints
    }
}
