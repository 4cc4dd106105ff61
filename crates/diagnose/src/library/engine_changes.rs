//! Whether what an engine burns beside the others changes at some date, so that steps of single engines are worth trying.

use flight::{MAXIMUM_ENGINES, Segment};

use crate::math::quantile::{MEDIAN_TO_DEVIATION, median};
use crate::signals::record::FlightRecord;
use crate::thresholds::{ENGINE_CHANGES, FEWEST_FLIGHTS_OF_A_REGION};

/// What a set of flights shows of its single engines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SingleEngines {
    /// One engine, or the flow of all together.
    NotRecorded,
    /// Each burns beside the others what it did before.
    Alike,
    /// One burns beside the others something else before and after some date.
    Change,
}

impl SingleEngines {
    /// What these flights show, of which `recorded` tells whether each engine has its own flow.
    pub(crate) fn of(flights: &[FlightRecord<'_>], recorded: bool) -> Self {
        match recorded {
            false => Self::NotRecorded,
            true if engines_change(flights) => Self::Change,
            true => Self::Alike,
        }
    }
}

/// Whether, for some engine and some date, flights before and after it differ.
///
/// ```text
/// x = mean over a flight of ln Wf_k − mean_j ln Wf_j;  |x̄₂ − x̄₁| > k·s·√(1/n₁ + 1/n₂),  s = 1.48·median|x_(f+1) − x_f|/√2   [diagnosis.64]
/// ```
///
/// Engines that drift apart do as well: which of it fits is for the search to say. Without it, columns of steps cost time for
/// nothing where engines stay as they are.
fn engines_change(flights: &[FlightRecord<'_>]) -> bool {
    let mut by_date: Vec<(f64, [f64; MAXIMUM_ENGINES])> = flights
        .iter()
        .filter_map(|flight| {
            Some((flight.segments.first()?.identity.start_s(), apart(flight.segments)?))
        })
        .collect();
    by_date.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    (0..MAXIMUM_ENGINES).any(|engine| {
        let series: Vec<f64> = by_date.iter().map(|(_, apart)| apart[engine]).collect();
        largest_change(&series) > ENGINE_CHANGES
    })
}

/// Means over a flight of ln fuel flow of each engine, less that of all; `None` where a segment lacks an engine's.
fn apart(segments: &[Segment]) -> Option<[f64; MAXIMUM_ENGINES]> {
    let mut sums = [0.0; MAXIMUM_ENGINES];
    for segment in segments {
        let flows = &segment.means.fuel_flow_engine_kg_s;
        if flows.len() < 2 || flows.iter().any(|flow| !(flow.is_finite() && *flow > 0.0)) {
            return None;
        }
        let mean = flows.iter().map(|flow| flow.ln()).sum::<f64>() / flows.len() as f64;
        for (sum, flow) in sums.iter_mut().zip(flows) {
            *sum += (flow.ln() - mean) / segments.len() as f64;
        }
    }
    Some(sums)
}

/// The largest difference of means before and after a date, in its standard deviations.
fn largest_change(series: &[f64]) -> f64 {
    let steps = series.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let deviation = MEDIAN_TO_DEVIATION * median(steps) / 2.0_f64.sqrt();
    if deviation <= 0.0 {
        return 0.0; // an engine that is not there, or no flights
    }
    let (all, total) = (series.len(), series.iter().sum::<f64>());
    let (mut before, mut largest) = (0.0, 0.0_f64);
    for (count, value) in (1..all).zip(series) {
        before += value;
        if count < FEWEST_FLIGHTS_OF_A_REGION || all - count < FEWEST_FLIGHTS_OF_A_REGION {
            continue;
        }
        let (first, second) = (count as f64, (all - count) as f64);
        let apart = (total - before) / second - before / first;
        largest = largest.max(apart.abs() / (deviation * (1.0 / first + 1.0 / second).sqrt()));
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::random::RandomStream;

    /// By hand: 0, 1, 0, 1, … then the same and 10 more: neighbours are 1 apart, s = 1.4826/√2 = 1.0484; of six flights each
    /// the difference is 10/(1.0484·√(1/6 + 1/6)) = 16.52.
    #[test]
    fn a_change_by_hand() {
        let series: Vec<f64> =
            (0..12).map(|k| f64::from(k % 2) + if k < 6 { 0.0 } else { 10.0 }).collect();
        assert!((largest_change(&series) - 16.52).abs() < 0.01, "{}", largest_change(&series));
        assert!(largest_change(&series[..5]) < 1e-12, "fewer flights than two places have");
        assert!(largest_change(&[0.0; 12]) < 1e-12, "an engine that is not there");
    }

    fn normal(stream: &mut RandomStream) -> f64 {
        let mut one = [0.0];
        stream.fill(&mut one);
        one[0]
    }

    /// 200 series of 100 flights without a change: at most a few in a hundred have as much somewhere.
    #[test]
    fn chance_seldom_looks_like_a_change() {
        let mut stream = RandomStream::new(64, 1);
        let looks = (0..200).filter(|_| {
            let series: Vec<f64> = (0..100).map(|_| normal(&mut stream)).collect();
            largest_change(&series) > ENGINE_CHANGES
        });
        let looks = looks.count();
        assert!(looks <= 8, "{looks}");
    }
}
