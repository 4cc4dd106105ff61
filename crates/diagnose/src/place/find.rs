//! Where the gap lies: readable places, each with a p-value that accounts for the search.
//!
//! Difficult: the sums over all places of one and two variables are taken at once, by prefix sums over bins, for the
//! flights and for every draw of noise; draws go through in groups, so that their tables stay in the cache and the cost
//! is linear in segments.

use effects::Variable;
use faer::Mat;
use flight::effect::EffectId;

use crate::math::random::RandomStream;
use crate::output::Slice;
use crate::place::acceleration::expected_errors_removed;
use crate::place::binned_variable::places;
use crate::place::draws::{Drawing, NoiseLevel, chords, draw};
use crate::place::likelihood::Noise;
use crate::place::named::NamedGap;
use crate::place::null::Null;
use crate::place::regions::{BinnedRegion, Search, Series};
use crate::place::told::{Gaps, Told, engines_apart, gaps};
use crate::search::analyse::Analysis;
use crate::search::system::WhitenedSystem;
use crate::signals::channels::MAXIMUM_CHANNELS;
use crate::thresholds::{
    FEWEST_FLIGHTS_OF_A_REGION, MOST_COMPARED, MOST_REGIONS, REFUTES_SCATTER, REGION_DRAWS,
    REGION_P_VALUE,
};

/// Draws that are summed together.
const GROUP: usize = 40;
/// Segments whose draws are added together.
const TOGETHER: usize = 512;
/// Stream of random numbers: draws of noise.
const NOISE_STREAM: u64 = 1;
/// Falls of χ² that differ by less are of regions that fit alike.
const EQUAL: f64 = 1e-6;

/// Places that are not by chance, most striking first; and everywhere, where the level of all is not.
#[derive(Clone, Debug)]
pub(crate) struct FoundPlaces {
    regions: Vec<Slice>,
    everywhere: Option<Slice>,
    /// Variance that noise gives each segment's fuel flow.
    pub(crate) variances: Vec<f64>,
}

impl FoundPlaces {
    /// Puts the place of what is named first, unless one of its driving variables leads already. A level that varies is everywhere,
    /// and more so there.
    pub(crate) fn lead_with(&mut self, named: Slice, gap: &NamedGap) {
        let (drivers, is_level) = (gap.variables(), gap.is_level());
        let first = self.regions.first_mut();
        let leads = first.filter(|first| {
            let mut conditions = first.region.conditions.iter();
            conditions.any(|condition| drivers.contains(&condition.variable))
        });
        if let Some(first) = leads {
            // A step has its own date: bins of dates are weeks long, and a second condition is what they leave of it.
            if gap.step().is_some() {
                *first = named;
            }
            return;
        }
        let everywhere = self.everywhere.take().filter(|_| is_level && self.regions.is_empty());
        self.regions.insert(0, named);
        self.regions.truncate(MOST_REGIONS);
        if let Some(everywhere) = everywhere {
            self.regions.insert(0, everywhere);
        }
    }

    /// Whether nothing stands out.
    pub(crate) const fn are_none(&self) -> bool {
        self.regions.is_empty()
    }

    /// Says one more place, last.
    pub(crate) fn say(&mut self, place: Slice) {
        self.regions.push(place);
    }

    /// What is said of a gap: its places, everywhere where it has none. Nothing is said of what is no gap.
    pub(crate) fn of_gap(self, is_gap: bool) -> Vec<Slice> {
        if !is_gap {
            vec![]
        } else if self.regions.is_empty() {
            self.everywhere.into_iter().collect()
        } else {
            self.regions
        }
    }

    /// Whether a place is so clear that the gap is no scatter from flight to flight, which has none.
    pub(crate) fn refute_scatter(&self) -> bool {
        self.regions.first().is_some_and(|slice| slice.p_value <= REFUTES_SCATTER)
    }

    /// Whether the first place is where this effect alone acts: one engine, or the switch of anti-ice.
    pub(crate) fn lead_to(&self, id: EffectId) -> bool {
        self.regions.first().is_some_and(|slice| {
            let region = &slice.region;
            match id {
                EffectId::TsfcEngine(_) | EffectId::FuelFlowGainEngine(_) => {
                    region.engine.is_some()
                }
                EffectId::AntiIceBleed => {
                    let variables = region.conditions.iter().map(|condition| condition.variable);
                    region.engine.is_none() && variables.eq([Variable::AntiIce])
                }
                _ => false,
            }
        })
    }

    /// Whether one engine is apart from the others.
    pub(crate) fn name_an_engine(&self) -> bool {
        self.regions.iter().any(|slice| slice.region.engine.is_some())
    }
}

/// Looks for the places where the gap lies.
///
/// ```text
/// T = |Σ_{i in place} (y_i − ȳ)| / sd0,  sd0 over draws of noise; /1.15 with a second condition    [diagnosis.25]
/// ```
///
/// The same with u = C⁻¹(y − ŷ) for y − ȳ, C the noise within and between flights, ŷ the level that
/// fits best: the score test of a step over the place, which sees what differs within flights.
///
/// # Errors of method
/// Sizes are those of the place that stands out most, which is a little more than it is (winner's curse).
pub(crate) fn find(
    system: &WhitenedSystem<'_>,
    analysis: &Analysis,
    (noise_scale, floor): (f64, f64),
    seed: u64,
) -> FoundPlaces {
    let data = system.data;
    let places = places(&data.segments, system.design.references());
    let engines = if data.channels.contrasts > 0 { data.channels.contrasts + 1 } else { 0 };
    let mut source = RandomStream::new(seed, NOISE_STREAM);
    let level = level(system, analysis, noise_scale);
    let chords = chords(system);
    let noise = Noise::new(system, level);
    let search = Search::new(&places, &noise.weighed(&vec![1.0; data.segments.len()]), engines);
    let (null, mut variances) = null_of(&search, &noise, (level, &chords), &mut source);
    scale_to(floor, &mut variances);

    let as_recorded = gaps(system);
    let mut left = expected_errors_removed(system, &as_recorded);
    let told = Told { system, places: &places, gaps: &as_recorded, variances: &variances };
    let mut found = Vec::new();
    let mut said = Vec::new();
    let mut everywhere = (1.0, None);
    while found.len() < MOST_REGIONS {
        let statistics = statistics(&search, &null, &noise, &left);
        if found.is_empty() {
            let level = search.regions.iter().position(BinnedRegion::is_everywhere);
            everywhere = (level.map_or(1.0, |k| null.p_value_everywhere(statistics[k])), level);
        }
        let significant = Significant { search: &search, null: &null, said: &said };
        let Some((index, members)) = significant.best(&statistics, &told, &left, &noise) else {
            break;
        };
        let candidate = &search.regions[index];
        found.push(told.slice(candidate, &members, null.p_value(statistics[index]), seed));
        said.push(*candidate);
        take_out(&mut left, candidate, members, &noise);
    }
    let everywhere = match everywhere {
        (p_value, Some(index)) if p_value <= REGION_P_VALUE => {
            let members: Vec<usize> = (0..data.segments.len()).collect();
            Some(told.slice(&search.regions[index], &members, p_value, seed))
        }
        _ => None,
    };
    FoundPlaces { regions: found, everywhere, variances }
}

/// Variances with the mean square that closure takes for noise: what can be explained is the same for both. Draws hold also what the
/// model does not know, and the scatter that is itself named, which would leave less than nothing to explain.
fn scale_to(floor: f64, variances: &mut [f64]) {
    let mean = variances.iter().sum::<f64>() / variances.len().max(1) as f64;
    if mean > 0.0 {
        for variance in variances {
            *variance *= floor / mean;
        }
    }
}

/// Noise as the best model finds it, never less than announced.
fn level(system: &WhitenedSystem<'_>, analysis: &Analysis, noise_scale: f64) -> NoiseLevel {
    let best = analysis.models.first().map(|(scored, _)| scored);
    let background = best.and_then(|scored| analysis.backgrounds.get(scored.background));
    let integrated = background.map_or(0.0, |at| system.scatter(at.level));
    let heating =
        best.and_then(|scored| scored.hypothesis.flight_scatter_percent).map_or(0.0, |p| p / 100.0);
    NoiseLevel { factor: noise_scale.max(1.0).sqrt(), scatter: integrated.max(heating) }
}

/// What noise alone does to every place; and the variance that it gives each segment's fuel flow.
fn null_of(
    search: &Search<'_>,
    noise: &Noise<'_>,
    (level, chords): (NoiseLevel, &[[f64; 2]]),
    source: &mut RandomStream,
) -> (Null, Vec<f64>) {
    let system = noise.system();
    let segments = system.data.segments.len();
    let mut squares = vec![0.0; search.regions.len()];
    let mut variances = vec![0.0; segments];
    let mut group = |source: &mut RandomStream| {
        // One matrix a series, one row a segment, one column a draw.
        let mut drawn = vec![Mat::<f64>::zeros(segments, GROUP); search.series().len()];
        draw(system, &Drawing { level, chords, width: GROUP }, source, |segment, channels| {
            for (draw, value) in channels[0].iter().enumerate() {
                variances[segment] += value * value / REGION_DRAWS as f64;
                drawn[0][(segment, draw)] = *value;
            }
            for draw in 0..if drawn.len() > 2 { GROUP } else { 0 } {
                let mut contrasts = [0.0; MAXIMUM_CHANNELS];
                for (slot, channel) in contrasts.iter_mut().zip(&channels[1..]) {
                    *slot = channel[draw];
                }
                let apart = engines_apart(&contrasts[..channels.len() - 1]);
                for (drawn, value) in drawn[2..].iter_mut().zip(apart) {
                    drawn[(segment, draw)] = value;
                }
            }
        });
        drawn[1] = drawn[0].clone();
        noise.weigh(&mut drawn[1]);
        let mut sums = search.sums(GROUP);
        for first in (0..segments).step_by(TOGETHER) {
            let range = first..segments.min(first + TOGETHER);
            let rows = |drawn: &Mat<f64>| {
                range.clone().flat_map(|at| (0..GROUP).map(move |draw| drawn[(at, draw)])).collect()
            };
            search.add(&mut sums, first, &drawn.iter().map(rows).collect::<Vec<Vec<f64>>>());
        }
        sums
    };
    for _ in 0..REGION_DRAWS / 2 / GROUP {
        let sums = group(source);
        search.for_each(&sums, |index, sums| {
            squares[index] += sums.iter().map(|sum| sum * sum).sum::<f64>();
        });
    }
    let mut null = Null::new(&squares, REGION_DRAWS / 2);
    for _ in 0..REGION_DRAWS / 2 / GROUP {
        let sums = group(source);
        null.add(search, &sums);
    }
    (null, variances)
}

fn statistics(search: &Search<'_>, null: &Null, noise: &Noise<'_>, gaps: &Gaps) -> Vec<f64> {
    let mut sums = search.sums(1);
    let values = |series: &Series| match series {
        Series::FuelFlow => gaps.total.clone(),
        Series::WithinFlights => noise.weighed(&gaps.total),
        Series::Engine(engine) => gaps.apart[*engine].clone(),
    };
    search.add(&mut sums, 0, &search.series().iter().map(values).collect::<Vec<Vec<f64>>>());
    let mut statistics = vec![0.0; search.regions.len()];
    search.for_each(&sums, |index, sum| statistics[index] = null.statistic(search, index, sum[0]));
    statistics
}

/// Places that are not by chance, but for those that were said.
struct Significant<'a> {
    search: &'a Search<'a>,
    null: &'a Null,
    said: &'a [BinnedRegion],
}

impl Significant<'_> {
    /// The place to say, with its segments; `None` where all is by chance. Variables are correlated, so that many regions are not
    /// by chance where one has a gap: of those in which the gap is larger than outside, a step over the place decides, which fits
    /// best by likelihood; of several that fit alike, the larger gap.
    fn best(
        &self,
        statistics: &[f64],
        told: &Told<'_>,
        left: &Gaps,
        noise: &Noise<'_>,
    ) -> Option<(usize, Vec<usize>)> {
        let regions = &self.search.regions;
        let mut order: Vec<usize> = (0..regions.len())
            .filter(|&index| !regions[index].is_everywhere())
            .filter(|&index| self.null.p_value(statistics[index]) <= REGION_P_VALUE)
            .collect();
        order.sort_by(|&a, &b| statistics[b].total_cmp(&statistics[a]));
        let enough = |(_, members): &(usize, Vec<usize>)| {
            told.flights_of(members) >= FEWEST_FLIGHTS_OF_A_REGION
        };
        let mut candidates = order
            .into_iter()
            .filter(|&index| {
                let region = &regions[index];
                !self.said.iter().any(|said| {
                    region.is_of_the_segments_of(said) || region.is_the_rest_of(said, told.places)
                })
            })
            .map(|index| (index, self.members(index, told)))
            .filter(enough)
            .peekable();
        if let Some(first) = candidates.next_if(|(index, _)| regions[*index].series.is_engine()) {
            return Some(first);
        }
        let (compared, members): (Vec<usize>, Vec<Vec<usize>>) = candidates
            .filter(|(index, _)| !regions[*index].series.is_engine())
            .filter(|(_, members)| left.is_larger_in(members) && !told.holds_nothing(members))
            .take(MOST_COMPARED)
            .unzip();
        let steps = noise.steps(&left.total, &members);
        let weighed: Vec<f64> = compared
            .iter()
            .zip(&steps)
            .map(|(&index, step)| step.fall * regions[index].weight().powi(2))
            .collect();
        let largest = weighed.iter().copied().fold(0.0, f64::max);
        compared
            .into_iter()
            .zip(members)
            .zip(weighed)
            .filter(|(_, fall)| *fall >= largest * (1.0 - EQUAL))
            .map(|((index, inside), _)| (told.mean(&regions[index], &inside).abs(), index, inside))
            // The first of equals, so that the order of variables decides.
            .reduce(|a, b| if b.0 > a.0 { b } else { a })
            .map(|(_, index, inside)| (index, inside))
    }

    fn members(&self, index: usize, told: &Told<'_>) -> Vec<usize> {
        let region = &self.search.regions[index];
        (0..told.gaps.total.len()).filter(|&k| region.holds(told.places, k)).collect()
    }
}

/// Removes what distinguishes a region: its excess over the rest, or what its engine does apart from the others.
fn take_out(left: &mut Gaps, candidate: &BinnedRegion, members: Vec<usize>, noise: &Noise<'_>) {
    let count = members.len() as f64;
    let mean_of = |values: &[f64]| members.iter().map(|&k| values[k]).sum::<f64>() / count;
    match candidate.series {
        Series::FuelFlow => {
            let inside = mean_of(&left.total);
            let all: f64 = left.total.iter().sum();
            let outside = (all - inside * count) / (left.total.len() as f64 - count).max(1.0);
            for &segment in &members {
                left.total[segment] -= inside - outside;
            }
        }
        Series::WithinFlights => {
            let regions = [members];
            let step = noise.steps(&left.total, &regions)[0];
            for &segment in &regions[0] {
                left.total[segment] -= step.size;
            }
        }
        Series::Engine(engine) => {
            // An engine alone that is off by θ shows θ/n in all fuel flow, θ(1 − 1/n) apart, and −θ/n at the others.
            let own = mean_of(&left.apart[engine]);
            let others = own / (left.apart.len() as f64 - 1.0);
            for &segment in &members {
                left.total[segment] -= others;
                for (index, series) in left.apart.iter_mut().enumerate() {
                    series[segment] -= if index == engine { own } else { -others };
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
