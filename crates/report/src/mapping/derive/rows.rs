//! Which rows of a recording are used, and the range of a column.

use core::ops::Range;

use flight::column::Column;

use crate::mapping::file::OutOfRange;
use crate::mapping::plan::{Conversion, Plan};
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
    pub(super) fn without(&self, surplus: &[Surplus]) -> Self {
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

/// A row that is left out, and the column that is out of range in it; `None` of a gross mass.
pub(super) type Surplus = (usize, Option<Column>);

/// What is recorded of the rows that are used, in the stored unit of its column.
pub(super) struct Converted {
    pub(super) column: Column,
    pub(super) values: Vec<f64>,
    /// Whether all are known to be in its range.
    pub(super) is_within: bool,
}

/// The rows to use.
pub(super) struct Used {
    pub(super) rows: UsedRows,
    /// Rows with a recorded number out of range where the mapping leaves such rows out.
    pub(super) surplus: Vec<Surplus>,
    /// What is recorded of the rows, as far as it is converted already.
    pub(super) converted: Vec<Converted>,
}

impl Used {
    /// The rows of these level parts. Where too few would be left it is the column that is wrong and not its rows: all are used,
    /// and the first number out of range is refused.
    pub(super) fn new(
        plan: &Plan,
        recording: &Recording,
        parts: &[Range<usize>],
        fewest: usize,
    ) -> Self {
        let rows = UsedRows::new(parts.to_vec());
        let converted = converted(plan, recording, &rows);
        if plan.out_of_range == OutOfRange::Refuse {
            return Self { rows, surplus: Vec::new(), converted };
        }
        // Row by row only where a column has something to leave out.
        let mut outside: Vec<(usize, usize)> = Vec::new();
        for (place, one) in converted.iter().enumerate().filter(|(_, one)| !one.is_within) {
            let limits = Limits::new(one.column, None);
            let found = rows.runs().flatten().zip(&one.values);
            let found = found.filter(|(_, value)| !limits.admit(**value));
            outside.extend(found.map(|(row, _)| (row, place)));
        }
        // Of a row that is outside in several columns, the first of them.
        outside.sort_unstable();
        outside.dedup_by_key(|(row, _)| *row);
        let surplus: Vec<Surplus> =
            outside.into_iter().map(|(row, place)| (row, Some(converted[place].column))).collect();
        if surplus.is_empty() || rows.len() - surplus.len() < fewest {
            return Self { rows, surplus: Vec::new(), converted };
        }
        Self { rows: rows.without(&surplus), surplus, converted: Vec::new() }
    }
}

/// Each recorded quantity of these rows, in the order of the plan.
fn converted(plan: &Plan, recording: &Recording, rows: &UsedRows) -> Vec<Converted> {
    let of_column = |(column, conversion): &(Column, Conversion)| {
        let limits = Limits::new(*column, None);
        let mut values = Vec::with_capacity(rows.len());
        let mut others = 0;
        for run in rows.runs() {
            let is_within = limits.contain();
            others += conversion.append_to(&mut values, &recording.numbers, run, is_within);
        }
        let is_within = limits.is_simple() && others == 0;
        Converted { column: *column, values, is_within }
    };
    plan.recorded.iter().map(of_column).collect()
}

/// The range of a column in its stored unit.
pub(in crate::mapping) struct Limits {
    column: Column,
    is_optional: bool,
    pub(super) minimum: f64,
    pub(super) low: f64,
    pub(super) maximum: f64,
    high: f64,
}

impl Limits {
    pub(in crate::mapping) fn new(column: Column, maximum: Option<f64>) -> Self {
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
    pub(in crate::mapping) fn admit(&self, value: f64) -> bool {
        self.contain()(value) && (self.is_simple() || value.is_nan() || value.fract() == 0.0)
    }

    /// Whether a number lies between the two limits, without a branch: what asks of many numbers compares several in one instruction.
    #[expect(clippy::needless_bitwise_bool, reason = "lazy operators are branches")]
    pub(in crate::mapping) fn contain(&self) -> impl Fn(f64) -> bool + use<> {
        let Self { low, high, is_optional, .. } = *self;
        move |value| ((low <= value) & (value <= high)) | (value.is_nan() & is_optional)
    }

    /// Whether all of them are certainly admitted: a quick look, of which `false` means that each has to be looked at.
    pub(super) fn admit_all(&self, values: &[f64]) -> bool {
        let contain = self.contain();
        let others = values.iter().map(|value| u64::from(!contain(*value)));
        self.is_simple() && others.sum::<u64>() == 0
    }
}
