//! Counting values in bins, and the range worth drawing.

/// Equal bins at whole multiples of their width, the same for every series that is counted in them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bins {
    /// Lower edge of the first bin, in widths.
    first: f64,
    count: usize,
    width: f64,
}

/// Values counted; all are in one of the three.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Histogram {
    /// Below the first bin.
    pub(crate) below: usize,
    /// Bin by bin.
    pub(crate) counts: Vec<usize>,
    /// Above the last bin.
    pub(crate) above: usize,
}

/// Most bins that a chart of this size can show.
const MOST_BINS: f64 = 60.0;
/// Share of the values that bins must hold where not all fit: a single wild value must not flatten the rest.
const SHARE_SHOWN: f64 = 0.98;

impl Bins {
    /// Bins of `width` around all values, if 60 bins suffice. Otherwise 60 around the median, if they hold 98 % of the
    /// values; otherwise wider bins (2, 4, 10, 20, … widths) that do.
    pub(crate) fn around(values: &[f64], width: f64) -> Self {
        let mut sorted: Vec<f64> =
            values.iter().copied().filter(|value| value.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else {
            return Self { first: -2.0, count: 4, width };
        };
        let median = sorted[sorted.len() / 2];
        let mut width = width;
        let mut factors = [2.0, 2.0, 2.5].into_iter().cycle();
        loop {
            let all = Self::between(low, high, width);
            if all.count as f64 <= MOST_BINS {
                return all;
            }
            let half = MOST_BINS / 2.0 * width;
            // If there are no values that far out on one side, the bins need not extend there either.
            let some = Self::between(low.max(median - half), high.min(median + half), width);
            let shown = sorted.iter().filter(|value| some.holds(**value)).count();
            if shown as f64 >= SHARE_SHOWN * sorted.len() as f64 {
                return some;
            }
            width *= factors.next().unwrap_or(2.0);
        }
    }

    fn between(low: f64, high: f64, width: f64) -> Self {
        let first = (low / width).floor();
        let last = (high / width).floor() + 1.0;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least 1; a cast of more than memory holds saturates and is refused by the caller"
        )]
        let count = (last - first) as usize;
        Self { first, count, width }
    }

    pub(crate) fn width(&self) -> f64 {
        self.width
    }

    pub(crate) fn low(&self) -> f64 {
        self.first * self.width
    }

    pub(crate) fn high(&self) -> f64 {
        (self.first + self.count as f64) * self.width
    }

    /// Whether a bin holds the value.
    pub(crate) fn holds(&self, value: f64) -> bool {
        matches!(self.place(value), Place::Bin(_))
    }

    /// Counts finite values; bins are half-open, `[low, high)`.
    pub(crate) fn histogram(&self, values: &[f64]) -> Histogram {
        let mut histogram = Histogram { below: 0, counts: vec![0; self.count], above: 0 };
        for value in values.iter().filter(|value| value.is_finite()) {
            match self.place(*value) {
                Place::Below => histogram.below += 1,
                Place::Bin(bin) => histogram.counts[bin] += 1,
                Place::Above => histogram.above += 1,
            }
        }
        histogram
    }

    fn place(&self, value: f64) -> Place {
        let bin = (value / self.width).floor() - self.first;
        if bin < 0.0 {
            Place::Below
        } else if bin < self.count as f64 {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number from 0 to the number of bins"
            )]
            Place::Bin(bin as usize)
        } else {
            Place::Above
        }
    }
}

impl Histogram {
    /// The fullest bin.
    pub(crate) fn largest(&self) -> usize {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// Values in no bin.
    pub(crate) fn beyond(&self) -> usize {
        self.below + self.above
    }
}

enum Place {
    Below,
    Bin(usize),
    Above,
}

/// Indices of at most `most` of `count` items, evenly spread and always the same.
pub(crate) fn thinned(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    (0..most).map(|k| k * count / most).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total(histogram: &Histogram) -> usize {
        histogram.counts.iter().sum::<usize>() + histogram.beyond()
    }

    #[test]
    fn counted_by_hand() {
        // Half-open bins of 0.5 from -0.5: [-0.5, 0) holds -0.1, [0, 0.5) nothing, [0.5, 1) 0.5 and 0.9, [1, 1.5) 1.0.
        let values = [0.5, -0.1, 1.0, 0.9];
        let bins = Bins::around(&values, 0.5);
        assert_eq!((bins.low(), bins.high(), bins.width()), (-0.5, 1.5, 0.5));
        assert_eq!(bins.histogram(&values).counts, [1, 0, 2, 1]);
    }

    #[test]
    fn every_value_is_counted_once() {
        let wide: Vec<f64> = (0..400).map(|k| f64::from(k) * 0.77 - 120.0).collect();
        let mut outlier: Vec<f64> = (0..400).map(|k| f64::from(k) * 0.01).collect();
        outlier.push(310.0);
        outlier.push(-95.0);
        for values in [wide, outlier, vec![4.0], vec![0.0; 7], vec![], vec![1e300, -1e300]] {
            let bins = Bins::around(&values, 0.5);
            let histogram = bins.histogram(&values);
            assert_eq!(total(&histogram), values.len());
            assert!(histogram.counts.len() <= 61, "{}", histogram.counts.len());
            assert!(histogram.beyond() * 50 <= values.len());
        }
    }

    #[test]
    fn one_wild_value_does_not_widen_the_bins() {
        let mut values: Vec<f64> = (0..400).map(|k| f64::from(k) * 0.01).collect();
        values.push(310.0);
        let bins = Bins::around(&values, 0.5);
        assert_eq!((bins.width(), bins.low()), (0.5, 0.0));
        assert_eq!(bins.histogram(&values).above, 1);
    }

    #[test]
    fn not_finite_is_no_value() {
        let values = [f64::NAN, 1.0, f64::INFINITY];
        assert_eq!(total(&Bins::around(&values, 0.5).histogram(&values)), 1);
    }

    #[test]
    fn thinning_is_even() {
        assert_eq!(thinned(3, 5), [0, 1, 2]);
        assert_eq!(thinned(10, 4), [0, 2, 5, 7]);
    }
}
