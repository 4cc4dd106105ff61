//! The numbers of a flight, column by column, in stretches as they were read together: most are kept where they are, and not copied.

use core::ops::Range;
use std::sync::Arc;

/// Rows of a flight that are fewer than this share of those that were read with them are copied, lest they keep the others. Our choice.
const SHARE_TO_KEEP: usize = 4;

/// Numbers of rows that were read together.
#[derive(Clone, Debug, Default)]
pub(super) struct Block {
    /// `[input][row]`; NaN where there is no number.
    columns: Vec<Vec<f64>>,
    /// Of each input whether a number is not there.
    lacks: Vec<bool>,
}

/// The numbers of a flight.
#[derive(Debug)]
pub(super) struct Numbers {
    stretches: Vec<Stretch>,
    inputs: usize,
}

/// Rows of a block.
#[derive(Debug)]
struct Stretch {
    block: Arc<Block>,
    rows: Range<usize>,
    /// Rows of the flight before it.
    before: usize,
    /// Whether the block is this flight's own.
    is_own: bool,
}

impl Block {
    pub(super) fn new(columns: Vec<Vec<f64>>) -> Self {
        // Counted, without a way out of the loop: nearly always none is.
        let lack = |column: &Vec<f64>| {
            column.iter().map(|number| u64::from(number.is_nan())).sum::<u64>() > 0
        };
        let lacks = columns.iter().map(lack).collect();
        Self { columns, lacks }
    }

    /// Of columns of which it is known whether a number is not there.
    pub(super) const fn of(columns: Vec<Vec<f64>>, lacks: Vec<bool>) -> Self {
        Self { columns, lacks }
    }

    fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    /// Adds rows of another block.
    fn extend(&mut self, other: &Self, rows: Range<usize>) {
        for (column, numbers) in self.columns.iter_mut().zip(&other.columns) {
            column.extend_from_slice(&numbers[rows.clone()]);
        }
        for (lacks, other) in self.lacks.iter_mut().zip(&other.lacks) {
            *lacks |= other;
        }
    }
}

impl Numbers {
    pub(super) const fn new(inputs: usize) -> Self {
        Self { stretches: Vec::new(), inputs }
    }

    pub(super) const fn inputs(&self) -> usize {
        self.inputs
    }

    /// About the bytes that a row takes.
    pub(super) const fn bytes_of_row(&self) -> usize {
        self.inputs * size_of::<f64>()
    }

    /// Adds rows that were read.
    pub(super) fn extend(&mut self, block: &Arc<Block>, rows: Range<usize>) {
        if rows.is_empty() {
            return;
        }
        let last = self.stretches.last_mut();
        let before = last.as_ref().map_or(0, |last| last.before + last.rows.len());
        if SHARE_TO_KEEP * rows.len() >= block.rows() {
            let block = Arc::clone(block);
            self.stretches.push(Stretch { block, rows, before, is_own: false });
            return;
        }
        if let Some(last) = last.filter(|last| last.is_own)
            && let Some(own) = Arc::get_mut(&mut last.block)
        {
            own.extend(block, rows);
            last.rows.end = own.rows();
            return;
        }
        let mut own = self.empty();
        own.extend(block, rows);
        self.push_own(own, before);
    }

    /// Takes the last row away.
    pub(super) fn pop(&mut self) {
        let Some(last) = self.stretches.last_mut() else { return };
        last.rows.end -= 1;
        if last.is_own
            && let Some(own) = Arc::get_mut(&mut last.block)
        {
            own.columns.iter_mut().for_each(|column| column.truncate(last.rows.end));
        }
        if last.rows.is_empty() {
            self.stretches.pop();
        }
    }

    fn empty(&self) -> Block {
        Block { columns: vec![Vec::new(); self.inputs], lacks: vec![false; self.inputs] }
    }

    fn push_own(&mut self, own: Block, before: usize) {
        let rows = 0..own.rows();
        self.stretches.push(Stretch { block: Arc::new(own), rows, before, is_own: true });
    }

    /// A number.
    pub(super) fn at(&self, input: usize, row: usize) -> f64 {
        let later = self.stretches.partition_point(|stretch| stretch.before <= row);
        // The flight has the row.
        let stretch = &self.stretches[later - 1];
        stretch.block.columns[input][stretch.rows.start + row - stretch.before]
    }

    /// Rows that follow each other, in slices: the columns of those that were read together, and which rows of them.
    pub(super) fn slices(
        &self,
        rows: Range<usize>,
    ) -> impl Iterator<Item = (&[Vec<f64>], Range<usize>)> {
        let first = self.stretches.partition_point(|one| one.before + one.rows.len() <= rows.start);
        self.stretches[first..].iter().take_while(move |one| one.before < rows.end).map(
            move |stretch| {
                let from = rows.start.saturating_sub(stretch.before);
                let to = stretch.rows.len().min(rows.end - stretch.before);
                let start = stretch.rows.start;
                (stretch.block.columns.as_slice(), start + from..start + to)
            },
        )
    }

    /// Whether a number of an input that is asked for may not be there.
    pub(super) fn may_lack(&self, asked: impl Fn(usize) -> bool) -> bool {
        let lack = |lacks: &[bool]| lacks.iter().enumerate().any(|(at, lacks)| *lacks && asked(at));
        self.stretches.iter().any(|stretch| lack(&stretch.block.lacks))
    }

    /// All columns as one stretch that can be changed: `[input][row]`.
    pub(super) fn make_own(&mut self) -> &mut [Vec<f64>] {
        let is_own = matches!(self.stretches.as_slice(), [one] if one.is_own);
        if !is_own {
            let mut own = self.empty();
            for stretch in core::mem::take(&mut self.stretches) {
                own.extend(&stretch.block, stretch.rows);
            }
            self.push_own(own, 0);
        }
        let own = self.stretches.first_mut().and_then(|one| Arc::get_mut(&mut one.block));
        own.map_or(&mut [], |own| own.columns.as_mut_slice())
    }

    /// Keeps some of the rows, as many as there are.
    pub(super) fn retain(&mut self, keep: &[bool]) {
        for column in self.make_own() {
            retain(column, keep);
        }
        if let Some(own) = self.stretches.first_mut() {
            own.rows = 0..own.block.rows();
        }
    }
}

/// Keeps some of the values, as many as there are.
pub(super) fn retain<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut kept = keep.iter();
    values.retain(|_| kept.next().copied().unwrap_or(true));
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn block(from: usize, rows: usize) -> Arc<Block> {
        let column = |input: usize| (from..from + rows).map(move |row| (10 * row + input) as f64);
        Arc::new(Block::new(vec![column(0).collect(), column(1).collect()]))
    }

    proptest! {
        /// Oracle: the same numbers in one vector, whichever were copied and whichever kept.
        #[test]
        fn numbers_are_those_that_were_added(
            reads in prop::collection::vec((1_usize..40, 0_usize..1000, 0_usize..1000), 1..12),
            ends in (0_usize..1000, 0_usize..1000),
            kept in prop::collection::vec(any::<bool>(), 500),
        ) {
            let mut numbers = Numbers::new(2);
            let mut expected: Vec<f64> = Vec::new();
            // In thousandths: a whole number of rows without a cast from a real number.
            let share = |share: usize, of: usize| share * of / 1000;
            for (number, (rows, one, other)) in reads.into_iter().enumerate() {
                let block = block(100 * number, rows);
                let (start, end) = (share(one.min(other), rows), share(one.max(other), rows));
                numbers.extend(&block, start..end);
                expected.extend(&block.columns[1][start..end]);
            }
            if ends.0 > 500 && expected.pop().is_some() {
                numbers.pop();
                numbers.extend(&block(7, 30), 3..4);
                expected.push(101.0);
            }
            let rows = expected.len();
            for (row, value) in expected.iter().enumerate() {
                prop_assert_eq!(numbers.at(1, row).to_bits(), value.to_bits());
            }
            let range = share(ends.0.min(ends.1), rows)..share(ends.0.max(ends.1), rows);
            let slices = |numbers: &Numbers, range: Range<usize>| -> Vec<f64> {
                numbers.slices(range).flat_map(|(columns, rows)| columns[1][rows].to_vec()).collect()
            };
            prop_assert_eq!(slices(&numbers, range.clone()), &expected[range]);
            numbers.retain(&kept[..rows]);
            let left: Vec<f64> =
                expected.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(x, _)| *x).collect();
            prop_assert_eq!(slices(&numbers, 0..left.len()), left);
        }
    }
}
