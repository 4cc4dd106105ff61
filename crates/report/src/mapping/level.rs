//! The level parts of a recording: climb and descent are not cruise.

use core::ops::Range;

/// Differences of decimal altitudes in binary: a range of exactly the band's width is within it.
const ROUNDING_M: f64 = 1e-9;

/// The definition of a level part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LevelCriteria {
    /// No sample lies below this pressure altitude, m.
    pub(super) minimum_pressure_altitude_m: f64,
    /// Largest difference between highest and lowest pressure altitude, m.
    pub(super) band_m: f64,
    /// Shortest part after trimming, s.
    pub(super) minimum_duration_s: f64,
    /// Time cut off at either end, where the aircraft is still levelling off or already leaving, s.
    pub(super) trim_s: f64,
}

/// The level parts in the order of time, trimmed, and the duration of the longest untrimmed one.
///
/// The longest part is taken first, then the longest in the rest before and after it; of equally long ones the
/// earliest. So a step climb gives two parts, and a part is never split to lengthen another.
pub(super) fn level_parts(
    time_s: &[f64],
    pressure_altitude_m: &[f64],
    criteria: &LevelCriteria,
) -> (Vec<Range<usize>>, f64) {
    let needed_s = criteria.minimum_duration_s + 2.0 * criteria.trim_s;
    let mut parts = Vec::new();
    let mut longest_s = 0.0_f64;
    let mut open: Vec<Range<usize>> = core::iter::once(0..time_s.len()).collect();
    while let Some(range) = open.pop() {
        let Some(part) = longest_level_part(time_s, pressure_altitude_m, criteria, range.clone())
        else {
            continue;
        };
        let duration_s = time_s[part.end - 1] - time_s[part.start];
        longest_s = longest_s.max(duration_s);
        if duration_s < needed_s {
            continue;
        }
        open.push(range.start..part.start);
        open.push(part.end..range.end);
        let trimmed = trim(time_s, part, criteria.trim_s);
        if trimmed.len() >= 3 {
            parts.push(trimmed);
        }
    }
    parts.sort_by_key(|part| part.start);
    (parts, longest_s)
}

/// The same of these rows alone, in their order: what lies between them belongs to the part around it.
pub(super) fn level_parts_of_rows(
    time_s: &[f64],
    pressure_altitude_m: &[f64],
    criteria: &LevelCriteria,
    kept: &[usize],
) -> (Vec<Range<usize>>, f64) {
    let of_kept = |values: &[f64]| -> Vec<f64> { kept.iter().map(|row| values[*row]).collect() };
    let (parts, longest_s) = level_parts(&of_kept(time_s), &of_kept(pressure_altitude_m), criteria);
    let of_all = |part: Range<usize>| kept[part.start]..kept[part.end - 1] + 1;
    (parts.into_iter().map(of_all).collect(), longest_s)
}

fn trim(time_s: &[f64], part: Range<usize>, trim_s: f64) -> Range<usize> {
    let first_s = time_s[part.start] + trim_s;
    let last_s = time_s[part.end - 1] - trim_s;
    let start = part.start + time_s[part.clone()].partition_point(|time| *time < first_s);
    let end = part.start + time_s[part.clone()].partition_point(|time| *time <= last_s);
    start..end.max(start)
}

/// Two indices that only move forward: the longest of the windows between them, of equally long ones the first.
fn longest_level_part(
    time_s: &[f64],
    pressure_altitude_m: &[f64],
    criteria: &LevelCriteria,
    range: Range<usize>,
) -> Option<Range<usize>> {
    let mut best: Option<Range<usize>> = None;
    let mut best_s = f64::NEG_INFINITY;
    // Time increases: of the windows that begin at one sample the last is the longest.
    let mut ended = |window: Range<usize>| {
        if window.is_empty() {
            return;
        }
        let duration_s = time_s[window.end - 1] - time_s[window.start];
        if duration_s > best_s {
            best_s = duration_s;
            best = Some(window);
        }
    };
    let minimum_m = criteria.minimum_pressure_altitude_m - ROUNDING_M;
    let most_m = criteria.band_m + ROUNDING_M;
    let mut window = Window::new(range.start);
    let mut sample = range.start;
    while sample < range.end {
        // Most of a cruise is level: several samples together.
        let chunk_end = (sample + SAMPLES_TOGETHER).min(range.end);
        let chunk = Extremes::of(&pressure_altitude_m[sample..chunk_end]);
        if chunk.lowest >= minimum_m && window.extremes.with(chunk).span() <= most_m {
            window.take(chunk);
            sample = chunk_end;
            continue;
        }
        for sample in sample..chunk_end {
            let altitude = pressure_altitude_m[sample];
            if altitude < minimum_m {
                ended(window.start..sample);
                window = Window::new(sample + 1);
                continue;
            }
            let one = Extremes { lowest: altitude, highest: altitude };
            if window.extremes.with(one).span() > most_m {
                ended(window.start..sample);
            }
            window.take(one);
            while window.extremes.span() > most_m {
                window.leave_first(pressure_altitude_m, sample);
            }
        }
        sample = chunk_end;
    }
    ended(window.start..range.end);
    best
}

/// Samples that are looked at together.
const SAMPLES_TOGETHER: usize = 64;

/// Lowest and highest of some samples.
#[derive(Clone, Copy)]
struct Extremes {
    lowest: f64,
    highest: f64,
}

impl Extremes {
    const NONE: Self = Self { lowest: f64::INFINITY, highest: f64::NEG_INFINITY };

    fn of(values: &[f64]) -> Self {
        // Four of each side by side: one after the other would wait for each other.
        let mut lanes = [Self::NONE; 4];
        let (fours, rest) = values.as_chunks::<4>();
        for four in fours {
            for (lane, value) in lanes.iter_mut().zip(four) {
                *lane = lane.with(Self { lowest: *value, highest: *value });
            }
        }
        let all = lanes.into_iter().fold(Self::NONE, Self::with);
        rest.iter().fold(all, |all, value| all.with(Self { lowest: *value, highest: *value }))
    }

    fn with(self, other: Self) -> Self {
        Self {
            lowest: if other.lowest < self.lowest { other.lowest } else { self.lowest },
            highest: if other.highest > self.highest { other.highest } else { self.highest },
        }
    }

    fn span(self) -> f64 {
        self.highest - self.lowest
    }
}

/// Samples that follow each other, of which the first can leave: a queue with its extremes, as two stacks. Of the older samples
/// the extremes from each to the last of them are known, of the newer ones those of all together. Where no older one is left
/// the newer ones become older: each sample does so once.
struct Window {
    start: usize,
    extremes: Extremes,
    /// From each older sample to the last older one, the first sample last.
    older: Vec<Extremes>,
    newer: Extremes,
}

impl Window {
    const fn new(start: usize) -> Self {
        Self { start, extremes: Extremes::NONE, older: Vec::new(), newer: Extremes::NONE }
    }

    /// Adds samples at its end.
    fn take(&mut self, samples: Extremes) {
        self.newer = self.newer.with(samples);
        self.extremes = self.extremes.with(samples);
    }

    /// Lets the first sample leave; `last` is the last one.
    fn leave_first(&mut self, values: &[f64], last: usize) {
        if self.older.is_empty() {
            let mut to_last = Extremes::NONE;
            self.older.extend(values[self.start..=last].iter().rev().map(|value| {
                to_last = to_last.with(Extremes { lowest: *value, highest: *value });
                to_last
            }));
            self.newer = Extremes::NONE;
        }
        self.older.pop();
        self.start += 1;
        self.extremes = self.older.last().map_or(self.newer, |older| older.with(self.newer));
    }
}

#[cfg(test)]
mod tests {
    #![expect(clippy::single_range_in_vec_init, reason = "one part is one range")]
    #![expect(clippy::float_cmp, reason = "whole seconds are exact")]

    use super::*;

    const CRITERIA: LevelCriteria = LevelCriteria {
        minimum_pressure_altitude_m: 9_000.0,
        band_m: 60.0,
        minimum_duration_s: 20.0,
        trim_s: 5.0,
    };

    fn parts(pressure_altitude_m: &[f64]) -> Vec<Range<usize>> {
        let time_s: Vec<f64> = (0..pressure_altitude_m.len()).map(|second| second as f64).collect();
        level_parts(&time_s, pressure_altitude_m, &CRITERIA).0
    }

    /// Altitudes a second apart: so many seconds at each of the levels.
    fn levels(pieces: &[(usize, f64)]) -> Vec<f64> {
        pieces.iter().flat_map(|(seconds, altitude)| vec![*altitude; *seconds]).collect()
    }

    #[test]
    fn a_step_climb_gives_two_parts_and_short_levels_none() {
        let altitudes =
            levels(&[(50, 8_000.0), (40, 10_000.0), (3, 10_300.0), (31, 10_600.0), (25, 9_500.0)]);
        // 40 samples last 39 s, from 50 to 89; trimmed 55 to 84. 31 samples last 30 s, just enough, from 93 to 123;
        // trimmed 98 to 118. 25 samples last 24 s, too short.
        assert_eq!(parts(&altitudes), [55..85, 98..119]);
    }

    #[test]
    fn the_band_counts_from_lowest_to_highest() {
        let wave = |amplitude: f64| -> Vec<f64> {
            (0..60)
                .map(|second| 10_000.0 + if second % 2 == 0 { amplitude } else { -amplitude })
                .collect()
        };
        assert_eq!(parts(&wave(30.0)), [5..55]);
        assert!(parts(&wave(30.1)).is_empty());
    }

    #[test]
    fn low_flight_is_no_cruise() {
        assert!(parts(&levels(&[(100, 8_999.9)])).is_empty());
        assert_eq!(parts(&levels(&[(100, 9_000.0)])), [5..95]);
        assert!(parts(&[]).is_empty());
    }

    /// By hand: 40 s at one level, of which seconds 20 and 21 are an encoder's highest number. Without them one part lasts
    /// 39 s and is trimmed by 5 s at either end; with them no part lasts 30 s.
    #[test]
    fn rows_that_are_left_out_do_not_divide_a_part() {
        let altitudes = levels(&[(20, 10_000.0), (2, 39_950.0), (18, 10_000.0)]);
        assert!(parts(&altitudes).is_empty());
        let time_s: Vec<f64> = (0..40).map(f64::from).collect();
        let kept: Vec<usize> = (0..20).chain(22..40).collect();
        let found = level_parts_of_rows(&time_s, &altitudes, &CRITERIA, &kept);
        assert_eq!(found, (vec![5..35], 39.0));
    }

    proptest::proptest! {
        /// Oracle: every interval tried.
        #[test]
        fn no_stretch_is_longer(altitudes in proptest::collection::vec(8_980.0_f64..9_120.0, 0..40)) {
            let time_s: Vec<f64> = (0..altitudes.len()).map(|second| second as f64).collect();
            let longest = (0..altitudes.len())
                .flat_map(|start| (start..altitudes.len()).map(move |end| start..end + 1))
                .filter(|range| {
                    let piece = &altitudes[range.clone()];
                    let high = piece.iter().copied().fold(f64::MIN, f64::max);
                    let low = piece.iter().copied().fold(f64::MAX, f64::min);
                    low >= 9_000.0 && high - low <= 60.0
                })
                .map(|range| range.len() - 1)
                .max();
            let (_, found) = level_parts(&time_s, &altitudes, &CRITERIA);
            proptest::prop_assert_eq!(found, longest.unwrap_or(0) as f64);
        }
    }
}
