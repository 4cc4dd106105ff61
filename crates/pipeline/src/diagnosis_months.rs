//! The gap month by month: whether it is still there, and whether what is named holds in the newest month.

use std::collections::BTreeMap;

use diagnose::SegmentGap;
use flight::Timestamp;
use monitor::Month;
use serde::{Deserialize, Serialize};

use crate::statistics::students_quantile975;

/// The gap in one calendar month, UTC.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MonthGap {
    /// Year and month.
    pub month: String,
    /// Flights that were used.
    pub flights: usize,
    /// Segments that were used.
    pub segments: usize,
    /// Mean gap, %.
    pub mean_gap_percent: f64,
    /// 95 % interval by flight, from how all flights scatter within their months; `null` where every month has one flight.
    pub ci95: Option<[f64; 2]>,
    /// Mean gap with the named effects in the model, of the sizes that all flights gave them, %; `null` where nothing is named.
    pub after_percent: Option<f64>,
    /// 95 % interval of that, by flight.
    pub after_ci95: Option<[f64; 2]>,
}

/// The months in which a tail flew, in order; a flight is of the month of its first segment.
#[must_use]
pub fn months(segments: &[SegmentGap]) -> Vec<MonthGap> {
    let mut begun: BTreeMap<usize, f64> = BTreeMap::new();
    for segment in segments {
        let first = begun.entry(segment.flight).or_insert(segment.date_s);
        *first = first.min(segment.date_s);
    }
    let month_of = |segment: &SegmentGap| {
        #[expect(clippy::cast_possible_truncation, reason = "seconds, far below 2^53")]
        let time = Timestamp::from_second(*begun.get(&segment.flight)? as i64).ok()?;
        Some(Month::from_timestamp(time))
    };
    let mut known: Vec<(Month, &SegmentGap)> =
        segments.iter().filter_map(|segment| Some((month_of(segment)?, segment))).collect();
    known.sort_by_key(|(month, segment)| (*month, segment.flight));
    let months: Vec<&[(Month, &SegmentGap)]> = known.chunk_by(|a, b| a.0 == b.0).collect();
    let scatter = [before, after].map(|value| Scatter::of(&months, value));
    months.iter().map(|rows| of_month(rows, scatter)).collect()
}

/// A flight's segments, with its month.
type FlightRows<'r, 's> = &'r [(Month, &'s SegmentGap)];

fn of_month(
    rows: &[(Month, &SegmentGap)],
    [scatter_before, scatter_after]: [Option<Scatter>; 2],
) -> MonthGap {
    let flights = flights_of(rows);
    let before = mean(&flights, scatter_before, before);
    let after = mean(&flights, scatter_after, after);
    MonthGap {
        month: rows.first().map_or_else(String::new, |(month, _)| month.to_string()),
        flights: flights.len(),
        segments: rows.len(),
        mean_gap_percent: before.map_or(0.0, |(mean, _)| mean),
        ci95: before.and_then(|(_, ci95)| ci95),
        after_percent: after.map(|(mean, _)| mean),
        after_ci95: after.and_then(|(_, ci95)| ci95),
    }
}

fn flights_of<'r, 's>(rows: &'r [(Month, &'s SegmentGap)]) -> Vec<FlightRows<'r, 's>> {
    rows.chunk_by(|a, b| a.1.flight == b.1.flight).collect()
}

#[expect(clippy::unnecessary_wraps, reason = "the signature of both values")]
const fn before(segment: &SegmentGap) -> Option<f64> {
    Some(segment.before_percent)
}

fn after(segment: &SegmentGap) -> Option<f64> {
    segment.after_percent.last().copied()
}

/// How flights scatter about the means of their months.
#[derive(Clone, Copy, Debug)]
struct Scatter {
    /// Standard deviation of a flight's mean, %.
    deviation_percent: f64,
    /// Student's quantile of as many flights less months.
    quantile: f64,
}

impl Scatter {
    /// Pooled over the months: two or three flights alone say little of how far their mean may be off. `None` where every month has
    /// one flight, or a segment has no value.
    ///
    /// ```text
    /// s² = Σ (flight − month)²/(flights − months),  half width t·s·√Σn²/Σn over the flights of a month, n their segments
    /// ```
    fn of(
        months: &[&[(Month, &SegmentGap)]],
        value: fn(&SegmentGap) -> Option<f64>,
    ) -> Option<Self> {
        let (mut squares, mut freedom) = (0.0, 0.0);
        for month in months {
            let means = flight_means(&flights_of(month), value)?;
            let mean = mean_over_segments(&means);
            squares += means.iter().map(|(own, _)| (own - mean).powi(2)).sum::<f64>();
            freedom += means.len() as f64 - 1.0;
        }
        let quantile = students_quantile975(freedom)?;
        Some(Self { deviation_percent: (squares / freedom).sqrt(), quantile })
    }
}

/// Mean and number of segments of each flight; `None` where a segment has no value.
fn flight_means(
    flights: &[FlightRows<'_, '_>],
    value: fn(&SegmentGap) -> Option<f64>,
) -> Option<Vec<(f64, f64)>> {
    let of_flight = |own: &FlightRows<'_, '_>| {
        let sum = own.iter().map(|(_, one)| value(one)).sum::<Option<f64>>()?;
        Some((sum / own.len() as f64, own.len() as f64))
    };
    flights.iter().map(of_flight).collect()
}

/// Mean of flights' means by their numbers of segments.
fn mean_over_segments(means: &[(f64, f64)]) -> f64 {
    let total: f64 = means.iter().map(|(_, count)| count).sum();
    means.iter().map(|(mean, count)| mean * count).sum::<f64>() / total
}

/// Mean over segments, and its 95 % interval by flight: segments of a flight err together. `None` where a segment has no value.
fn mean(
    flights: &[FlightRows<'_, '_>],
    scatter: Option<Scatter>,
    value: fn(&SegmentGap) -> Option<f64>,
) -> Option<(f64, Option<[f64; 2]>)> {
    let means = flight_means(flights, value)?;
    let total: f64 = means.iter().map(|(_, count)| count).sum();
    let mean = mean_over_segments(&means);
    let squares: f64 = means.iter().map(|(_, count)| count * count).sum();
    let half = scatter.map(|of| of.quantile * of.deviation_percent * squares.sqrt() / total);
    Some((mean, half.map(|half| [mean - half, mean + half])))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(flight: usize, date: &str, before: f64, after: &[f64]) -> SegmentGap {
        let time: Timestamp = date.parse().unwrap();
        SegmentGap {
            flight,
            date_s: time.as_second() as f64,
            mach: 0.8,
            lift_coefficient: 0.4,
            driver: None,
            in_region: false,
            before_percent: before,
            after_percent: after.to_vec(),
            engines_apart_percent: vec![],
        }
    }

    /// By hand: gaps of 1, 1 in one flight and 3, 3 in another have the mean 2 and scatter by √2 about it, one flight more than
    /// months; of their mean that is √2·√8/4 = 1, of the single flight of the other month √2; Student's quantile is 12.7062 (table).
    #[test]
    fn months_by_hand() {
        let segments = [
            segment(2, "2026-02-01T00:00:00Z", 0.5, &[1.5, -0.25]),
            segment(0, "2026-01-01T08:00:00Z", 1.0, &[0.5, 0.5]),
            segment(0, "2026-01-01T09:00:00Z", 1.0, &[0.5, 0.5]),
            segment(1, "2026-01-31T23:30:00Z", 3.0, &[0.5, 0.5]),
            segment(1, "2026-01-31T23:59:59Z", 3.0, &[0.5, 0.5]),
        ];
        let found = months(&segments);
        assert_eq!(found.len(), 2);
        let january = &found[0];
        assert_eq!((january.month.as_str(), january.flights, january.segments), ("2026-01", 2, 4));
        let [low, high] = january.ci95.unwrap();
        assert!((january.mean_gap_percent - 2.0).abs() < 1e-12, "{january:?}");
        assert!((low + 10.7062).abs() < 1e-4 && (high - 14.7062).abs() < 1e-4, "{january:?}");
        assert_eq!(january.after_ci95, Some([0.5, 0.5]));
        let february = &found[1];
        assert_eq!(february.after_percent, Some(-0.25));
        let [low, high] = february.ci95.unwrap();
        let half = 12.7062 * 2.0_f64.sqrt();
        assert!(
            (low - 0.5 + half).abs() < 1e-3 && (high - 0.5 - half).abs() < 1e-3,
            "{low} {high}"
        );
    }

    #[test]
    fn a_flight_over_the_end_of_a_month_is_of_the_month_in_which_it_began() {
        let found = months(&[
            segment(0, "2026-02-01T00:30:00Z", 2.0, &[]),
            segment(0, "2026-01-31T23:30:00Z", 1.0, &[]),
            segment(1, "2026-02-01T08:00:00Z", 3.0, &[]),
        ]);
        let told: Vec<_> =
            found.iter().map(|of| (of.month.as_str(), of.flights, of.segments)).collect();
        assert_eq!(told, [("2026-01", 1, 2), ("2026-02", 1, 1)]);
    }

    #[test]
    fn without_named_effects_nothing_is_after() {
        let found = months(&[segment(0, "2026-01-01T08:00:00Z", 1.0, &[])]);
        assert_eq!((found[0].after_percent, found[0].after_ci95), (None, None));
        assert!(months(&[]).is_empty());
    }
}
