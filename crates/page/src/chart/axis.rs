//! A scale with its ticks: round numbers at round distances.

/// A scale from `first` to `last`, always of some length, with labelled ticks on it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    first: f64,
    last: f64,
    ticks: Vec<Tick>,
    values: Values,
}

/// What the values of a scale are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Values {
    Numbers,
    /// Whole numbers.
    Counts,
    /// The k-th name from k to k + 1.
    Names,
    /// s since 1970.
    Dates,
}

/// A labelled position on a scale.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub(crate) at: f64,
    pub(crate) label: String,
}

/// A step of 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    digit: f64,
    exponent: i32,
}

impl Axis {
    /// From the last tick below `low` to the first above `high`, about `ticks` steps apart.
    pub(crate) fn around(low: f64, high: f64, ticks: usize) -> Self {
        let (low, high) = of_some_length(low, high);
        let step = Step::at_least((high - low) / ticks.max(1) as f64);
        let first = (low / step.size() + 1e-9).floor();
        let last = (high / step.size() - 1e-9).ceil();
        Self {
            first: step.times(first),
            last: step.times(last),
            ticks: step.ticks(first, last),
            values: Values::Numbers,
        }
    }

    /// Exactly from `low` to `high`, with the ticks that lie on it.
    pub(crate) fn within(low: f64, high: f64, ticks: usize) -> Self {
        let (low, high) = of_some_length(low, high);
        let step = Step::at_least((high - low) / ticks.max(1) as f64);
        let first = (low / step.size() - 1e-9).ceil();
        let last = (high / step.size() + 1e-9).floor();
        Self { first: low, last: high, ticks: step.ticks(first, last), values: Values::Numbers }
    }

    /// From 0, for counts: ticks are whole numbers.
    pub(crate) fn of_counts(largest: usize, ticks: usize) -> Self {
        Self { values: Values::Counts, ..Self::around(0.0, largest.max(ticks) as f64, ticks) }
    }

    /// A scale of names: the k-th from k to k + 1, its tick in the middle.
    pub(crate) fn of_names(names: &[String]) -> Self {
        let ticks = names.iter().enumerate();
        let ticks = ticks.map(|(k, name)| Tick { at: k as f64 + 0.5, label: name.clone() });
        let (first, last) = of_some_length(0.0, names.len() as f64);
        Self { first, last, ticks: ticks.collect(), values: Values::Names }
    }

    /// A scale of instants with given ticks; those beyond the ends are left out.
    pub(crate) fn of_dates(low: f64, high: f64, ticks: Vec<Tick>) -> Self {
        let (first, last) = of_some_length(low, high);
        let ticks = ticks.into_iter().filter(|tick| first <= tick.at && tick.at <= last).collect();
        Self { first, last, ticks, values: Values::Dates }
    }

    /// What its values are where they are not plain numbers, for the script that draws ticks of a part of it.
    pub(crate) const fn of(&self) -> Option<&'static str> {
        match self.values {
            Values::Numbers => None,
            Values::Counts => Some("counts"),
            Values::Names => Some("names"),
            Values::Dates => Some("dates"),
        }
    }

    pub(crate) fn first(&self) -> f64 {
        self.first
    }

    pub(crate) fn last(&self) -> f64 {
        self.last
    }

    pub(crate) fn ticks(&self) -> &[Tick] {
        &self.ticks
    }

    /// Whether a value lies on the scale; a value that is not finite does not.
    pub(crate) fn holds(&self, value: f64) -> bool {
        self.first <= value && value <= self.last
    }

    /// Position of a value: 0 at the first, 1 at the last end.
    pub(crate) fn share(&self, value: f64) -> f64 {
        (value - self.first) / (self.last - self.first)
    }
}

impl Step {
    /// The smallest step that is not below `length`.
    fn at_least(length: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "an exponent of a double")]
        let exponent = length.log10().floor() as i32;
        let share = length / 10_f64.powi(exponent);
        // 1e-9: a length of 0.5 is a step of 0.5, however it was computed.
        let digit = [1.0, 2.0, 5.0].into_iter().find(|digit| share <= digit * (1.0 + 1e-9));
        match digit {
            Some(digit) => Self { digit, exponent },
            None => Self { digit: 1.0, exponent: exponent + 1 },
        }
    }

    fn size(self) -> f64 {
        self.times(1.0)
    }

    /// `count` steps. Divides where the step is a fraction: 3 steps of 0.1 are 0.3.
    fn times(self, count: f64) -> f64 {
        let power = 10_f64.powi(self.exponent.abs());
        if self.exponent < 0 { count * self.digit / power } else { count * self.digit * power }
    }

    fn ticks(self, first: f64, last: f64) -> Vec<Tick> {
        let decimals = usize::try_from(-self.exponent).unwrap_or(0);
        let mut ticks = Vec::new();
        let mut count = first;
        while count <= last {
            // + 0.0 turns −0 into 0.
            let at = self.times(count) + 0.0;
            ticks.push(Tick { at, label: format!("{at:.decimals$}") });
            count += 1.0;
        }
        ticks
    }
}

/// A scale needs a length to divide by: a single value gets some room on both sides.
fn of_some_length(low: f64, high: f64) -> (f64, f64) {
    if !((high - low).is_finite() && low <= high) {
        return (0.0, 1.0);
    }
    let room = 1e-6 * low.abs().max(high.abs());
    if high - low > room {
        return (low, high);
    }
    let room = if low.abs() > 0.0 { 0.1 * low.abs() } else { 1.0 };
    (low - room, high + room)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks().iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn ticks_are_round() {
        let axis = Axis::around(-0.9, 7.9, 5);
        assert_eq!(labels(&axis), ["-2", "0", "2", "4", "6", "8"]);
        assert_eq!((axis.first(), axis.last()), (-2.0, 8.0));
        let axis = Axis::within(0.031, 0.0452, 4);
        assert_eq!(labels(&axis), ["0.035", "0.040", "0.045"]);
        assert_eq!((axis.first(), axis.last()), (0.031, 0.0452));
        assert_eq!(labels(&Axis::around(0.1, 0.3, 2)), ["0.1", "0.2", "0.3"]);
        assert_eq!(labels(&Axis::of_counts(3, 4)), ["0", "1", "2", "3", "4"]);
        assert_eq!(labels(&Axis::of_counts(97, 4)), ["0", "50", "100"]);
    }

    #[test]
    fn steps_are_1_2_5_times_a_power_of_ten() {
        for length in [1e-7, 0.003, 0.019, 0.5, 0.51, 1.0, 4.4, 7.0, 99.0, 1.2e6] {
            let step = Step::at_least(length);
            assert!([1.0, 2.0, 5.0].contains(&step.digit), "{step:?}");
            assert!(
                step.size() >= length * (1.0 - 1e-9) && step.size() <= 2.5 * length,
                "{length}"
            );
            let axis = Axis::around(-3.3 * length, 2.2 * length, 5);
            for tick in axis.ticks() {
                assert!(axis.holds(tick.at));
                assert!((tick.label.parse::<f64>().unwrap() - tick.at).abs() < 1e-9 * length);
            }
        }
    }

    #[test]
    fn a_scale_always_has_a_length() {
        for (low, high) in [
            (0.0, 0.0),
            (4.0, 4.0),
            (-2.0, -2.0),
            (f64::NAN, 1.0),
            (2.0, 1.0),
            (0.0, f64::INFINITY),
        ] {
            for axis in [Axis::around(low, high, 5), Axis::within(low, high, 5)] {
                assert!(axis.last() > axis.first(), "{axis:?}");
                assert!(!axis.ticks().is_empty(), "{axis:?}");
                assert!(
                    (0.0..=1.0).contains(&axis.share(f64::midpoint(axis.first(), axis.last())))
                );
            }
        }
    }
}
