//! What is told of a region: its engine, mean, interval and share of the gap.

use crate::math::bootstrap::interval_95;
use crate::math::random::RandomStream;
use crate::output::Slice;
use crate::output::region::{Condition, Region};
use crate::place::binned_variable::BinnedVariable;
use crate::place::regions::{BinnedRegion, Series};
use crate::search::system::WhitenedSystem;
use crate::signals::channels::MAXIMUM_CHANNELS;
use crate::thresholds::{LARGER_IN_A_PLACE, LEAST_SHARE};

/// Stream of random numbers: resamples of flights behind intervals.
const INTERVAL_STREAM: u64 = 2;

/// The gap, segment by segment, as the search sees and changes it.
#[derive(Clone, Debug)]
pub(crate) struct Gaps {
    /// Of fuel flow.
    pub(crate) total: Vec<f64>,
    /// Of each engine, less the mean of all engines.
    pub(crate) apart: Vec<Vec<f64>>,
}

/// ln of each engine's fuel flow less the mean of all, from the contrasts between the first k engines and the next; one
/// value more than contrasts.
///
/// ```text
/// c_k = (m_k − l_(k+1))·√(2k/(k + 1)),  m_k the mean of the first k;  m_n = 0
/// ```
pub(crate) fn engines_apart(contrasts: &[f64]) -> [f64; MAXIMUM_CHANNELS] {
    let mut apart = [0.0; MAXIMUM_CHANNELS];
    let mut mean = 0.0;
    for k in (1..=contrasts.len()).rev() {
        let difference = contrasts[k - 1] / (2.0 * k as f64 / (k + 1) as f64).sqrt();
        // The mean of k + 1 is that of k less difference/(k + 1).
        mean += difference / (k + 1) as f64;
        apart[k] = mean - difference;
    }
    apart[0] = mean;
    apart
}

/// The gap of every segment.
pub(crate) fn gaps(system: &WhitenedSystem<'_>) -> Gaps {
    let data = system.data;
    let contrasts = data.channels.contrasts;
    let total = data.segments.iter().map(|row| row.residual[0]).collect();
    let mut apart = vec![
        Vec::with_capacity(data.segments.len());
        if contrasts > 0 { contrasts + 1 } else { 0 }
    ];
    for row in &data.segments {
        let of_segment = engines_apart(&row.residual[1..=contrasts]);
        for (series, value) in apart.iter_mut().zip(of_segment) {
            series.push(value);
        }
    }
    Gaps { total, apart }
}

/// What describes a region.
pub(crate) struct Told<'a> {
    pub(crate) system: &'a WhitenedSystem<'a>,
    pub(crate) places: &'a [BinnedVariable],
    pub(crate) gaps: &'a Gaps,
    pub(crate) variances: &'a [f64],
}

impl Told<'_> {
    pub(crate) fn flights_of(&self, members: &[usize]) -> usize {
        self.by_flight(members, |_| 1.0).len()
    }

    /// Sums and counts of the flights that have segments in a place.
    fn by_flight(&self, members: &[usize], value: impl Fn(usize) -> f64) -> Vec<(f64, f64)> {
        let mut sums = Vec::new();
        let mut members = members.iter().copied().peekable();
        for flight in &self.system.data.flights {
            let (mut sum, mut count) = (0.0, 0.0);
            while let Some(segment) = members.next_if(|segment| *segment < flight.segments.end) {
                sum += value(segment);
                count += 1.0;
            }
            if count > 0.0 {
                sums.push((sum, count));
            }
        }
        sums
    }

    /// The engine that a region is reported for. Two engines share one series (their contrast), so the one whose own gap is
    /// larger is named.
    fn engine(&self, candidate: &BinnedRegion, members: &[usize]) -> Option<usize> {
        let Series::Engine(engine) = candidate.series else { return None };
        if self.gaps.apart.len() != 2 {
            return Some(engine);
        }
        let size = |engine| members.iter().map(|&k| self.value(Some(engine), k)).sum::<f64>().abs();
        Some(usize::from(size(1) > size(0)))
    }

    fn value(&self, engine: Option<usize>, segment: usize) -> f64 {
        self.gaps.value(engine, segment)
    }

    pub(crate) fn mean(&self, candidate: &BinnedRegion, members: &[usize]) -> f64 {
        let engine = self.engine(candidate, members);
        members.iter().map(|&k| self.value(engine, k)).sum::<f64>() / members.len() as f64
    }

    pub(crate) fn slice(
        &self,
        candidate: &BinnedRegion,
        members: &[usize],
        p_value: f64,
        seed: u64,
    ) -> Slice {
        let engine = self.engine(candidate, members);
        let ranges = candidate.ranges.iter().flatten();
        let condition =
            |&(place, low, high): &(usize, usize, usize)| self.places[place].condition(low, high);
        self.slice_of((engine, ranges.map(condition).collect()), members, p_value, seed)
    }

    /// The same of segments that meet some conditions, of all engines or of one.
    pub(crate) fn slice_of(
        &self,
        (engine, conditions): (Option<usize>, Vec<Condition>),
        members: &[usize],
        p_value: f64,
        seed: u64,
    ) -> Slice {
        let by_flight = self.by_flight(members, |segment| self.value(engine, segment));
        let (sum, count) =
            by_flight.iter().fold((0.0, 0.0), |(sum, count), (of, n)| (sum + of, count + n));
        #[expect(clippy::cast_possible_truncation, reason = "four engines at most")]
        let engine_number = engine.map(|engine| (engine + 1) as u8);
        Slice {
            region: Region { engine: engine_number, conditions },
            segments: members.len(),
            mean_gap_percent: 100.0 * sum / count,
            ci95: bootstrap_mean(&by_flight, seed).map(|end| 100.0 * end),
            share_of_gap: self.share(engine, members),
            p_value,
        }
    }

    /// Whether a place holds next to nothing of the explainable gap, where there is any.
    pub(crate) fn holds_nothing(&self, members: &[usize]) -> bool {
        let share = self.gaps.share_of_any(None, members, self.variances);
        share.is_some_and(|share| share < LEAST_SHARE)
    }

    /// Share of the explainable gap; an engine's is what it has in it. 0 where there is no more than noise.
    ///
    /// ```text
    /// Σ_place (y² − σ²)/Σ (y² − σ²);   of engine k of n  Σ_place (y·y_k − σ²)/n / Σ (y² − σ²)         [diagnosis.28]
    /// ```
    fn share(&self, engine: Option<usize>, members: &[usize]) -> f64 {
        self.gaps.share(engine, members, self.variances)
    }
}

impl Gaps {
    /// Of fuel flow, or of an engine, at a segment.
    fn value(&self, engine: Option<usize>, segment: usize) -> f64 {
        self.total[segment] + engine.map_or(0.0, |engine| self.apart[engine][segment])
    }

    /// Whether the mean of fuel flow in a place is clearly larger, whatever its sign, than in all other segments. A place in which
    /// less is amiss than elsewhere differs as clearly, and is none where the gap lies; nor is one in which a gap that is everywhere
    /// is a trifle larger.
    pub(crate) fn is_larger_in(&self, members: &[usize]) -> bool {
        let inside: f64 = members.iter().map(|&segment| self.total[segment]).sum();
        let outside = self.total.iter().sum::<f64>() - inside;
        let (within, beyond) = (members.len(), self.total.len() - members.len());
        inside.abs() * beyond as f64 >= LARGER_IN_A_PLACE * outside.abs() * within as f64
    }

    /// Share of the explainable gap; 0 where there is none.
    fn share(&self, engine: Option<usize>, members: &[usize], variances: &[f64]) -> f64 {
        self.share_of_any(engine, members, variances).unwrap_or(0.0)
    }

    /// The same; `None` where there is no more than noise.
    fn share_of_any(
        &self,
        engine: Option<usize>,
        members: &[usize],
        variances: &[f64],
    ) -> Option<f64> {
        let of = |segment: usize, engine: Option<usize>| {
            self.total[segment] * self.value(engine, segment) - variances[segment]
        };
        let whole: f64 = (0..self.total.len()).map(|segment| of(segment, None)).sum();
        let inside: f64 = members.iter().map(|&segment| of(segment, engine)).sum();
        let engines = engine.map_or(1.0, |_| self.apart.len() as f64);
        (whole > 0.0).then(|| inside / engines / whole)
    }
}

/// 95 % interval of a mean, whole flights drawn with replacement.
fn bootstrap_mean(by_flight: &[(f64, f64)], seed: u64) -> [f64; 2] {
    let mut stream = RandomStream::new(seed, INTERVAL_STREAM);
    interval_95(by_flight, &mut stream, |sum, count| sum / count)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 9 and 1 of 10⁻⁴, each with noise of 10⁻⁴ in it, are 8 and 0 of 8: all of it lies in the first segment. Of two
    /// engines the first has 3·5 − 1 = 14 there and the second 3·1 − 1 = 2, each half: 14/16 and 2/16 of what both make.
    #[test]
    fn share_by_hand() {
        let gaps = Gaps { total: vec![0.03, 0.01], apart: vec![vec![0.02, 0.0], vec![-0.02, 0.0]] };
        let variances = [1e-4; 2];
        let share = |engine, members: &[usize]| gaps.share(engine, members, &variances);
        for (found, expected) in [
            (share(None, &[0]), 1.0),
            (share(None, &[1]), 0.0),
            (share(Some(0), &[0]), 14.0 / 16.0),
            (share(Some(1), &[0]), 2.0 / 16.0),
        ] {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        // Nothing but noise has no shares.
        assert!(gaps.share(None, &[0], &[1.0; 2]).abs() < 1e-15);
    }

    /// By hand: means of 0.02 and −0.03; of 0.02 and 0.01.
    #[test]
    fn a_gap_lies_where_its_mean_is_larger_whatever_its_sign() {
        let gaps = |total: &[f64]| Gaps { total: total.to_vec(), apart: vec![] };
        let apart = gaps(&[0.01, 0.03, -0.03]);
        assert!(apart.is_larger_in(&[2]) && !apart.is_larger_in(&[0, 1]));
        let alike = gaps(&[0.03, 0.01, 0.01]);
        assert!(alike.is_larger_in(&[0, 1]) && !alike.is_larger_in(&[2]));
        // 0.0210 to 0.02 is less than a tenth more, 0.0225 is more.
        assert!(!gaps(&[0.0210, 0.02, 0.02]).is_larger_in(&[0]));
        assert!(gaps(&[0.0225, 0.02, 0.02]).is_larger_in(&[0]));
    }

    #[test]
    fn bootstrap_of_many_equal_flights() {
        // 400 flights whose means are ±1 alternately: standard error 1/√400 = 0.05, interval ±0.098.
        let flights: Vec<(f64, f64)> =
            (0..400).map(|k| (if k % 2 == 0 { 10.0 } else { -10.0 }, 10.0)).collect();
        let [low, high] = bootstrap_mean(&flights, 3);
        assert!((low + 0.098).abs() < 0.012 && (high - 0.098).abs() < 0.012, "{low} {high}");
    }
}
