//! The physical lines of rows: nearly always each is the one behind the line before.

use core::ops::Range;

/// Lines of rows, in runs of lines that follow each other.
#[derive(Clone, Debug, Default)]
pub(in crate::mapping) struct LineNumbers {
    /// The first row of each run, and its line.
    runs: Vec<(usize, usize)>,
    rows: usize,
}

impl LineNumbers {
    /// Of rows on lines that follow each other.
    pub(super) fn from_line(first_line: usize, rows: usize) -> Self {
        let runs = if rows > 0 { vec![(0, first_line)] } else { Vec::new() };
        Self { runs, rows }
    }

    /// Adds a row.
    pub(super) fn push(&mut self, line: usize) {
        self.push_run(line, 1);
    }

    fn push_run(&mut self, line: usize, rows: usize) {
        if self.runs.last().is_none_or(|(row, first)| first + (self.rows - row) != line) {
            self.runs.push((self.rows, line));
        }
        self.rows += rows;
    }

    /// Adds some of other rows.
    pub(super) fn extend(&mut self, other: &Self, rows: Range<usize>) {
        let mut row = rows.start;
        let mut run = other.runs.partition_point(|(first, _)| *first <= row);
        while row < rows.end {
            let end = other.runs.get(run).map_or(rows.end, |(next, _)| rows.end.min(*next));
            self.push_run(other.at(row), end - row);
            (row, run) = (end, run + 1);
        }
    }

    /// The line of a row; 0 of one that there is not.
    pub(in crate::mapping) fn at(&self, row: usize) -> usize {
        let later = self.runs.partition_point(|(first, _)| *first <= row);
        later.checked_sub(1).map_or(0, |run| self.runs[run].1 + (row - self.runs[run].0))
    }

    /// The line of the last row.
    pub(super) fn last(&self) -> Option<usize> {
        self.rows.checked_sub(1).map(|row| self.at(row))
    }

    /// Takes the last row away.
    pub(super) fn pop(&mut self) {
        self.rows = self.rows.saturating_sub(1);
        self.runs.pop_if(|(first, _)| *first >= self.rows);
    }

    /// Keeps some of the rows, as many as there are.
    pub(super) fn retain(&mut self, keep: &[bool]) {
        let mut kept = Self::default();
        for row in (0..self.rows).filter(|row| keep.get(*row).copied().unwrap_or(true)) {
            kept.push(self.at(row));
        }
        *self = kept;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Oracle: the lines in a vector.
        #[test]
        fn lines_are_those_that_were_added(
            steps in prop::collection::vec(prop_oneof![4 => Just(1_usize), 1 => 1_usize..4], 1..60),
            ends in (0_usize..60, 0_usize..60),
            kept in prop::collection::vec(any::<bool>(), 120),
        ) {
            let lines: Vec<usize> = steps.iter().scan(0, |line, step| { *line += step; Some(*line) }).collect();
            let mut some = LineNumbers::default();
            for line in &lines {
                some.push(*line);
            }
            let all = |numbers: &LineNumbers| (0..numbers.rows).map(|row| numbers.at(row)).collect::<Vec<_>>();
            prop_assert_eq!(all(&some), lines.clone());
            prop_assert_eq!(some.last(), lines.last().copied());
            let mut fewer = some.clone();
            fewer.pop();
            fewer.push(1000);
            prop_assert_eq!(all(&fewer), [&lines[..lines.len() - 1], &[1000]].concat());
            let (one, other) = (ends.0.min(lines.len()), ends.1.min(lines.len()));
            let range = one.min(other)..one.max(other);
            let mut more = LineNumbers::from_line(7, 2);
            more.extend(&some, range.clone());
            let mut expected = vec![7, 8];
            expected.extend(&lines[range]);
            prop_assert_eq!(all(&more), expected.clone());
            more.retain(&kept[..expected.len()]);
            let left: Vec<usize> =
                expected.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(line, _)| *line).collect();
            prop_assert_eq!(all(&more), left);
        }
    }
}
