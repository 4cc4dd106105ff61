//! Which rows of a recording are used, and the range of a column.

use core::ops::Range;

use flight::column::Column;

use crate::mapping::file::OutOfRange;
use crate::mapping::plan::Plan;
use crate::mapping::table::Recording;

/// A limit is widened by this share of itself: a number exactly on it must not fail because of a conversion's rounding.
const LIMIT_ROUNDING: f64 = 1e-12;

/// Rows of a recording, as runs of rows that follow each other: few of them, because hardly ever a row is left out.
#[derive(Debug)]
pub(super) struct UsedRows {
    runs: Vec<Range<usize>>,
    count: usize,
}

impl UsedRows {
    fn new(runs: Vec<Range<usize>>) -> Self {
        let count = runs.iter().map(Range::len).sum();
        Self { runs, count }
    }

    /// The runs without the rows that are left out, which are in their order.
    fn without(&self, surplus: &[Surplus]) -> Self {
        let mut left_out = surplus.iter().map(|(row, _)| *row).peekable();
        let mut runs = Vec::with_capacity(self.runs.len());
        for run in self.runs() {
            let mut from = run.start;
            while let Some(row) = left_out.next_if(|row| *row < run.end) {
                runs.push(from..row);
                from = row + 1;
            }
            runs.push(from..run.end);
        }
        runs.retain(|run| !run.is_empty());
        Self::new(runs)
    }

    pub(super) const fn len(&self) -> usize {
        self.count
    }

    pub(super) fn runs(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        self.runs.iter().cloned()
    }

    /// The row of the recording at a place among these, which has to be one of theirs.
    pub(super) fn at(&self, place: usize) -> usize {
        let mut before = 0;
        let run = self.runs().find(|run| {
            before += run.len();
            place < before
        });
        run.map_or(0, |run| run.end - (before - place))
    }
}

/// A row that is left out, and the column that is out of range in it.
pub(super) type Surplus = (usize, Column);

/// The rows to use, and those with a recorded number out of range where the mapping leaves such rows out. Where too few would be
/// left it is the column that is wrong and not its rows: all are used, and the first number out of range is refused.
pub(super) fn rows_in_range(
    plan: &Plan,
    recording: &Recording,
    parts: &[Range<usize>],
    fewest: usize,
) -> (UsedRows, Vec<Surplus>) {
    let all = UsedRows::new(parts.to_vec());
    if plan.out_of_range == OutOfRange::Refuse {
        return (all, Vec::new());
    }
    // Column by column, and row by row only where a column has something to leave out.
    let mut outside: Vec<(usize, usize)> = Vec::new();
    for (place, (column, conversion)) in plan.recorded.iter().enumerate() {
        let limits = Limits::new(*column, None);
        for run in all.runs() {
            let numbers = &recording.numbers;
            let is_simple =
                limits.is_simple() && conversion.all_are(numbers, run.clone(), limits.contain());
            if is_simple {
                continue;
            }
            let is_outside = |row: &usize| !limits.admit(conversion.apply(numbers, *row));
            outside.extend(run.filter(is_outside).map(|row| (row, place)));
        }
    }
    // Of a row that is outside in several columns, the first of them.
    outside.sort_unstable();
    outside.dedup_by_key(|(row, _)| *row);
    let surplus: Vec<Surplus> =
        outside.into_iter().map(|(row, place)| (row, plan.recorded[place].0)).collect();
    if surplus.is_empty() || all.len() - surplus.len() < fewest {
        return (all, Vec::new());
    }
    (all.without(&surplus), surplus)
}

/// The range of a column in its stored unit.
pub(super) struct Limits {
    column: Column,
    is_optional: bool,
    pub(super) minimum: f64,
    pub(super) low: f64,
    pub(super) maximum: f64,
    high: f64,
}

impl Limits {
    pub(super) fn new(column: Column, maximum: Option<f64>) -> Self {
        let range = column.range();
        let minimum = range.minimum.unwrap_or(f64::MIN);
        let maximum = maximum.or(range.maximum).unwrap_or(f64::MAX);
        let low = if range.minimum_excluded {
            f64::MIN_POSITIVE
        } else {
            minimum - minimum.abs() * LIMIT_ROUNDING
        };
        let high = (maximum + maximum.abs() * LIMIT_ROUNDING).min(f64::MAX);
        Self { column, is_optional: column.is_optional(), minimum, low, maximum, high }
    }

    /// Whether lying between the two limits is all that is asked.
    fn is_simple(&self) -> bool {
        self.column != Column::AntiIce
    }

    /// NaN is "not available" in an optional column and outside every range elsewhere.
    pub(super) fn admit(&self, value: f64) -> bool {
        self.contain()(value) && (self.is_simple() || value.is_nan() || value.fract() == 0.0)
    }

    /// Whether a number lies between the two limits, without a branch: what asks of many numbers compares several in one instruction.
    fn contain(&self) -> impl Fn(f64) -> bool + use<> {
        let Self { low, high, is_optional, .. } = *self;
        move |value| (low <= value && value <= high) || (value.is_nan() && is_optional)
    }

    /// Whether all of them are certainly admitted: a quick look, of which `false` means that each has to be looked at.
    pub(super) fn admit_all(&self, values: &[f64]) -> bool {
        let contain = self.contain();
        let others = values.iter().map(|value| u64::from(!contain(*value)));
        self.is_simple() && others.sum::<u64>() == 0
    }
}
