//! The search among breakpoints, without a loop: the axis is divided into equal buckets, so narrow that none holds more
//! than one breakpoint. A multiplication finds the bucket, a comparison with its one breakpoint the cell.
//!
//! Rounding cannot break it. The bucket of a coordinate never decreases with the coordinate, and breakpoints are put
//! into buckets by the same arithmetic: a breakpoint of a lower bucket is smaller, one of a higher bucket is larger.

/// Largest number of buckets: an axis that needs more (its narrowest cell is a thousandth of it, or less) is bisected.
const MAXIMUM_BUCKETS: usize = 4096;

/// Adding it to a number from 0 to `MAXIMUM_BUCKETS` rounds that to a whole number, which is then in the lowest bits.
/// A cast would spend seven instructions on numbers that do not occur here.
const ROUNDING: f64 = (1_u64 << 52) as f64;

/// Buckets of an axis.
#[derive(Clone, Debug)]
pub(super) struct Buckets {
    first: f64,
    per_unit: f64,
    /// For each bucket, the cell at its low end: the number of inner breakpoints in lower buckets. Empty where the axis
    /// is too uneven.
    cells: Vec<u16>,
}

impl Buckets {
    pub(super) fn new(breakpoints: &[f64]) -> Self {
        let cells = breakpoints.len() - 1;
        let (first, last) = (breakpoints[0], breakpoints[cells]);
        let mut count = cells;
        while count < MAXIMUM_BUCKETS {
            let mut this = Self { first, per_unit: count as f64 / (last - first), cells: vec![] };
            if this.fill(&breakpoints[1..cells], last) {
                return this;
            }
            count *= 2;
        }
        Self { first, per_unit: 0.0, cells: vec![] }
    }

    /// The half-open cell of a coordinate, which must be at least the first and below the last breakpoint.
    #[inline]
    pub(super) fn cell(&self, breakpoints: &[f64], coordinate: f64) -> usize {
        match self.cells.get(self.bucket(coordinate)) {
            // The next breakpoint is the bucket's own, or lies above the bucket.
            Some(&cell) => {
                let cell = usize::from(cell);
                cell + usize::from(coordinate >= breakpoints[cell + 1])
            }
            None => bisected(breakpoints, coordinate),
        }
    }

    /// Fills `cells`; false if a bucket holds two breakpoints.
    fn fill(&mut self, inner: &[f64], last: f64) -> bool {
        let buckets: Vec<usize> = inner.iter().map(|&breakpoint| self.bucket(breakpoint)).collect();
        if buckets.windows(2).any(|pair| pair[0] == pair[1]) {
            return false;
        }
        let cell = |bucket| buckets.partition_point(|&other| other < bucket);
        // At most 4096 buckets, and no more cells than that: the conversion cannot fail.
        let cells: Result<_, _> =
            (0..=self.bucket(last)).map(|bucket| u16::try_from(cell(bucket))).collect();
        cells.is_ok_and(|cells| {
            self.cells = cells;
            true
        })
    }

    /// The nearest whole number to the distance from the first breakpoint in buckets.
    #[inline]
    fn bucket(&self, coordinate: f64) -> usize {
        let in_lowest_bits = (coordinate - self.first) * self.per_unit + ROUNDING;
        #[expect(clippy::cast_possible_truncation, reason = "the lowest bits are what is wanted")]
        let bucket = in_lowest_bits.to_bits() as u16;
        usize::from(bucket)
    }
}

#[cold]
fn bisected(breakpoints: &[f64], coordinate: f64) -> usize {
    breakpoints[1..breakpoints.len() - 1].partition_point(|&breakpoint| breakpoint <= coordinate)
}
