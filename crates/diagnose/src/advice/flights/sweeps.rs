//! Flights that could be flown on purpose.

use effects::{EffectModel, EffectPoint};

use crate::advice::flights::envelope::{Envelope, Loading};
use crate::output::measurement::{Sweep, SweepLoading};
use crate::thresholds::{ADVISED_SEGMENTS, NARROWEST_LEVELS, NARROWEST_MACH, SWEEP_LEVELS};

/// A flight on purpose: ten segments.
#[derive(Clone, Debug)]
pub(crate) struct TestFlight {
    /// What it varies; `None` for nothing: the middle of what is flown, to compare with.
    pub(crate) sweep: Option<Sweep>,
    pub(crate) points: Vec<EffectPoint>,
}

/// Every flight on purpose that stays inside the envelope: no random numbers, always in the same order.
///
/// Mach numbers are hundredths, levels are flight levels: what is said is what is computed.
pub(crate) fn test_flights(envelope: &Envelope, model: &EffectModel<'_>) -> Vec<TestFlight> {
    let mut flights = Vec::new();
    flights.extend(steady(envelope, model));
    for level in spread(&envelope.levels, SWEEP_LEVELS) {
        for loading in &envelope.loadings {
            flights.extend(mach_sweep(envelope, model, level, loading));
        }
    }
    let mut machs = envelope.usual.to_vec();
    machs.dedup();
    machs.retain(|mach| (envelope.table_from..=envelope.fastest).contains(mach));
    for mach in machs {
        for loading in &envelope.loadings {
            flights.extend(level_sweep(envelope, model, mach, loading));
        }
    }
    flights
}

/// The widest range of Mach numbers at a level that ends nowhere outside the envelope. Never faster than was flown; slower
/// where lift coefficient and thrust allow it, and then that is said.
fn mach_sweep(
    envelope: &Envelope,
    model: &EffectModel<'_>,
    level: u32,
    loading: &Loading,
) -> Option<TestFlight> {
    let (low, high) = longest_run(envelope.table_from..=envelope.fastest, |mach| {
        [0, ADVISED_SEGMENTS - 1]
            .iter()
            .all(|&place| envelope.point(model, level, mach, loading, place).is_some())
    })?;
    if high - low < NARROWEST_MACH {
        return None;
    }
    let points = (0..ADVISED_SEGMENTS)
        .map(|place| {
            let along = place as f64 / (ADVISED_SEGMENTS - 1) as f64;
            let mach = (f64::from(low) + along * f64::from(high - low)) / 100.0;
            envelope.point_at(model, level, mach, loading, place)
        })
        .collect::<Option<_>>()?;
    let sweep = Sweep::Mach {
        hundredths: [low, high],
        below_slowest_flown: (low < envelope.slowest).then_some(envelope.slowest),
        level,
        loading: loading.of_sweep(),
    };
    Some(TestFlight { sweep: Some(sweep), points })
}

/// The widest range of flight levels at a Mach number that stays inside the envelope, climbed through.
fn level_sweep(
    envelope: &Envelope,
    model: &EffectModel<'_>,
    mach: u32,
    loading: &Loading,
) -> Option<TestFlight> {
    let levels = &envelope.levels;
    let last = u32::try_from(levels.len().checked_sub(1)?).ok()?;
    let (low, high) = longest_run(0..=last, |index| {
        let level = levels[index as usize];
        [0, ADVISED_SEGMENTS - 1]
            .iter()
            .all(|&place| envelope.point(model, level, mach, loading, place).is_some())
    })?;
    let levels = &levels[low as usize..=high as usize];
    let (lowest, highest) = (*levels.first()?, *levels.last()?);
    if highest - lowest < NARROWEST_LEVELS {
        return None;
    }
    let points = (0..ADVISED_SEGMENTS)
        .map(|place| {
            let index =
                (place * (levels.len() - 1) + (ADVISED_SEGMENTS - 1) / 2) / (ADVISED_SEGMENTS - 1);
            envelope.point(model, levels[index], mach, loading, place)
        })
        .collect::<Option<_>>()?;
    let sweep = Sweep::Level {
        levels: [lowest, highest],
        mach_hundredths: mach,
        loading: loading.of_sweep(),
    };
    Some(TestFlight { sweep: Some(sweep), points })
}

/// Ten segments in the middle of what is flown, at the first loading that allows it.
fn steady(envelope: &Envelope, model: &EffectModel<'_>) -> Option<TestFlight> {
    let level = *envelope.levels.get(envelope.levels.len() / 2)?;
    let points = envelope.loadings.iter().rev().find_map(|loading| {
        (0..ADVISED_SEGMENTS)
            .map(|place| envelope.point(model, level, envelope.usual[1], loading, place))
            .collect::<Option<_>>()
    })?;
    Some(TestFlight { sweep: None, points })
}

/// First and last of the longest run of numbers that pass; the first one of equals.
fn longest_run(
    numbers: core::ops::RangeInclusive<u32>,
    passes: impl Fn(u32) -> bool,
) -> Option<(u32, u32)> {
    let mut longest: Option<(u32, u32)> = None;
    let mut run: Option<(u32, u32)> = None;
    for number in numbers {
        run = passes(number).then(|| (run.map_or(number, |(first, _)| first), number));
        if let Some((first, last)) = run
            && longest.is_none_or(|(a, b)| last - first > b - a)
        {
            longest = run;
        }
    }
    longest
}

/// At most so many of the values, evenly from the first to the last.
fn spread(values: &[u32], most: usize) -> Vec<u32> {
    if values.len() <= most {
        return values.to_vec();
    }
    (0..most).map(|k| values[k * (values.len() - 1) / (most - 1)]).collect()
}

impl Loading {
    /// As an advice has it.
    const fn of_sweep(&self) -> SweepLoading {
        SweepLoading { kind: self.kind, mass_kg: self.mass_kg }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_by_hand() {
        let pass = |numbers: &'static [u32]| move |n: u32| numbers.contains(&n);
        assert_eq!(longest_run(0..=9, pass(&[1, 2, 4, 5, 6, 8, 9])), Some((4, 6)));
        assert_eq!(longest_run(0..=9, pass(&[0, 1, 8, 9])), Some((0, 1)));
        assert_eq!(longest_run(0..=9, pass(&[])), None);
        #[expect(clippy::reversed_empty_ranges, reason = "a fleet slower than its table")]
        let none = longest_run(9..=0, |_| true);
        assert_eq!(none, None);
    }

    #[test]
    fn five_of_many() {
        assert_eq!(spread(&[290, 300, 310], 5), [290, 300, 310]);
        assert_eq!(spread(&(0..9).collect::<Vec<u32>>(), 5), [0, 2, 4, 6, 8]);
    }
}
