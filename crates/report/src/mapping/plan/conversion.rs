//! From numbers of a recording to stored units.

use core::ops::Range;

use crate::mapping::numbers::Numbers;

/// Values that are converted, then looked at: few enough that they are still at hand.
const VALUES_TOGETHER: usize = 1024;

/// From a number of the recording to the stored unit of a quantity.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Conversion {
    pub(in super::super) input: usize,
    /// For the angle between two columns.
    pub(in super::super) minus: Option<usize>,
    pub(super) factor: f64,
    pub(super) offset: f64,
}

impl Conversion {
    pub(in super::super) fn apply(&self, numbers: &Numbers, row: usize) -> f64 {
        self.of(numbers.at(self.input, row), self.minus.map(|minus| numbers.at(minus, row)))
    }

    /// The same for rows that follow each other, behind what `values` holds. Gives how many of them are not so.
    pub(in super::super) fn append_to(
        &self,
        values: &mut Vec<f64>,
        numbers: &Numbers,
        rows: Range<usize>,
        is_so: impl Fn(f64) -> bool,
    ) -> u64 {
        let mut others = 0;
        for (columns, rows) in numbers.slices(rows) {
            let sent = columns[self.input][rows.clone()].chunks(VALUES_TOGETHER);
            let mut less = self.minus.map(|minus| columns[minus][rows].chunks(VALUES_TOGETHER));
            for sent in sent {
                let from = values.len();
                match less.as_mut().and_then(Iterator::next) {
                    None => {
                        // Copied, since the compiler knows then that they stay as they are while values are written.
                        let Self { factor, offset, .. } = *self;
                        values.extend(sent.iter().map(|value| value * factor + offset));
                    }
                    Some(less) => {
                        let both = sent.iter().zip(less);
                        values.extend(both.map(|(value, less)| self.of(*value, Some(*less))));
                    }
                }
                // Counted, without a way out of the loop: nearly always all are so.
                others += values[from..].iter().map(|value| u64::from(!is_so(*value))).sum::<u64>();
            }
        }
        others
    }

    /// Of a number, or of the angle between two.
    fn of(&self, value: f64, less: Option<f64>) -> f64 {
        let value = value * self.factor + self.offset;
        less.map_or(value, |less| wrap_deg(value - less * self.factor))
    }
}

/// An angle in −180 … 180°.
fn wrap_deg(angle_deg: f64) -> f64 {
    (angle_deg + 180.0).rem_euclid(360.0) - 180.0
}
