//! The probability of each effect, and the causes made from it.

use flight::effect::{EffectId, HiddenParameter};

use crate::advice::distances::Distances;
use crate::hypotheses::evidence::ScoredHypothesis;
use crate::judge::closure::Shrinkage;
use crate::judge::size::{SizeBelief, magnitude};
use crate::judge::table::TableFinding;
use crate::library::forms::open_by_law;
use crate::library::{Column, Library};
use crate::math::mixture::ln_sum;
use crate::output::verdict::Closure;
use crate::output::{Cause, Magnitude};
use crate::priors::FLAT_RANGE;
use crate::search::analyse::Analysis;
use crate::search::outside::Outside;
use crate::search::system::WhitenedSystem;
use crate::thresholds::{
    FEWEST_CAUSES, LEAST_LISTED, LEAST_MADE_SMALLER, LISTED_PROBABILITY, SCATTER_INTERVAL,
};

/// An effect with its posterior.
#[derive(Clone, Debug)]
pub(crate) struct Posterior {
    /// Index in the library; `None` for flight-to-flight scatter.
    pub(crate) effect: Option<usize>,
    pub(crate) probability: f64,
    /// The same without the prior sizes of effects.
    pub(crate) flat: f64,
    /// The most probable model in which it is the larger effect.
    pub(crate) scored: ScoredHypothesis,
    /// Its place in that model.
    pub(crate) place: usize,
    /// What every model in which it is the larger effect believes of its size.
    pub(crate) beliefs: Vec<SizeBelief>,
}

impl Posterior {
    /// Its column of the library and the size there; `None` for scatter between flights.
    pub(crate) fn column_and_size(&self) -> Option<(usize, f64)> {
        self.effect?;
        Some((self.scored.hypothesis.columns[self.place], self.scored.sizes[self.place]))
    }

    /// Effects that these flights cannot tell from it, itself first; `None` for scatter between flights.
    pub(crate) fn confused(&self, distances: &Distances, library: &Library) -> Option<Vec<usize>> {
        let (column, size) = self.column_and_size()?;
        Some(distances.confused_with(library, column, size))
    }
}

/// Mean square of what a unit of a column changes ln fuel flow by.
pub(crate) fn mean_square(system: &WhitenedSystem<'_>, column: usize) -> f64 {
    let segments = &system.data.segments;
    let sum: f64 = segments.iter().map(|row| row.signatures[column][0].powi(2)).sum();
    sum / segments.len() as f64
}

/// How much effects have to make a gap smaller to be its cause.
struct Explainable {
    /// Mean square over fuel flow and the split between engines.
    least: f64,
}

impl Explainable {
    /// `None` where the gap is too small to ask.
    fn new(own: &Shrinkage) -> Option<Self> {
        own.explainable().map(|explainable| Self { least: LEAST_MADE_SMALLER * explainable })
    }

    /// Whether a model's effects make the gap so much smaller. In a model with a background of small effects or a smooth function
    /// that explains the gap, they need not: an effect that only mends where that fits badly is no cause, however surely it acts.
    ///
    /// ```text
    /// Σ_channels mean(r² − (r − Σ θ·s)²) + τ² ≥ 0.1·(rms²_before − floor²)                        [diagnosis.60]
    /// ```
    fn is_explained(&self, system: &WhitenedSystem<'_>, scored: &ScoredHypothesis) -> bool {
        let data = system.data;
        let scatter = scored.hypothesis.flight_scatter_percent.map_or(0.0, |tau| tau / 100.0);
        let named = || scored.hypothesis.columns.iter().zip(&scored.sizes);
        let smaller: f64 = data
            .segments
            .iter()
            .flat_map(|row| (0..=data.channels.contrasts).map(move |channel| (row, channel)))
            .map(|(row, channel)| {
                let of = |(&column, size): (&usize, &f64)| size * row.signatures[column][channel];
                let (gap, change) = (row.residual[channel], named().map(of).sum::<f64>());
                change * (2.0 * gap - change)
            })
            .sum();
        smaller / data.segments.len() as f64 + scatter * scatter >= self.least
    }
}

/// Probability of each effect to be the larger one of what acts, over models whose effects make the gap smaller.
pub(crate) fn dominant(
    system: &WhitenedSystem<'_>,
    analysis: &Analysis,
    library: &Library,
    own: &Shrinkage,
) -> Vec<Posterior> {
    // What acts beside a guide's table is small next to it.
    let explainable = Explainable::new(own).filter(|_| !system.is_book());
    let mean_squares: Vec<f64> =
        (0..library.columns.len()).map(|column| mean_square(system, column)).collect();
    // One entry per effect, flight-to-flight scatter last.
    let mut found: Vec<Option<Posterior>> = vec![None; library.effects.len() + 1];
    let flats = flat_probabilities(analysis, &mean_squares);
    for ((scored, probability), flat) in analysis.models.iter().zip(flats) {
        let is_cause = |explainable: &Explainable| explainable.is_explained(system, scored);
        if *probability > LEAST_LISTED && !explainable.as_ref().is_none_or(is_cause) {
            continue;
        }
        let mut shares: Vec<(f64, Option<usize>, usize)> = scored
            .hypothesis
            .columns
            .iter()
            .zip(&scored.sizes)
            .enumerate()
            .map(|(place, (&column, size))| {
                (size * size * mean_squares[column], Some(library.columns[column].effect), place)
            })
            .collect();
        if let Some(percent) = scored.hypothesis.flight_scatter_percent {
            shares.push(((percent / 100.0).powi(2), None, 0));
        }
        let Some(&(_, effect, place)) = shares.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else {
            continue;
        };
        let slot = &mut found[effect.unwrap_or(library.effects.len())];
        let belief = effect.map(|_| SizeBelief {
            probability: *probability,
            size: scored.sizes[place],
            deviation: scored.deviations[place],
        });
        match slot {
            Some(posterior) => {
                posterior.probability += probability;
                posterior.flat += flat;
                posterior.beliefs.extend(belief);
            }
            None => {
                *slot = Some(Posterior {
                    effect,
                    probability: *probability,
                    flat,
                    scored: scored.clone(),
                    place,
                    beliefs: belief.into_iter().collect(),
                });
            }
        }
    }
    let mut all: Vec<Posterior> = found.into_iter().flatten().collect();
    all.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    all
}

/// Probabilities of the models if every effect could change fuel flow by any amount within a range, in place of its prior
/// sizes: each weight times the ratio of the two densities at the estimate (Laplace's approximation).
fn flat_probabilities(analysis: &Analysis, mean_squares: &[f64]) -> Vec<f64> {
    let ln_flat: Vec<f64> = mean_squares
        .iter()
        .map(|square| 0.5 * square.max(f64::MIN_POSITIVE).ln() - FLAT_RANGE.ln())
        .collect();
    let ln_ratio = |scored: &ScoredHypothesis| -> f64 {
        let columns = scored.hypothesis.columns.iter().zip(&scored.sizes);
        let of = |(&column, &size): (&usize, &f64)| {
            ln_flat[column] - analysis.scorer.priors[column].ln_density(size)
        };
        columns.map(of).sum()
    };
    let ln: Vec<f64> = analysis
        .models
        .iter()
        .map(|(scored, probability)| probability.max(f64::MIN_POSITIVE).ln() + ln_ratio(scored))
        .collect();
    let total = ln_sum(ln.iter().copied());
    ln.into_iter().map(|ln| (ln - total).exp()).collect()
}

/// Probability that each effect acts at all, be it the larger one or not; scatter between flights is the last.
pub(crate) fn presence(analysis: &Analysis, library: &Library) -> Vec<f64> {
    let mut present = vec![0.0; library.effects.len() + 1];
    for (scored, probability) in &analysis.models {
        for effect in acting(scored, library) {
            present[effect.unwrap_or(library.effects.len())] += probability;
        }
    }
    present
}

/// Probability that at least one of these acts, `None` being scatter between flights: two of them together count once.
pub(crate) fn presence_of_any(
    analysis: &Analysis,
    library: &Library,
    effects: &[Option<usize>],
) -> f64 {
    let acts =
        |scored: &ScoredHypothesis| acting(scored, library).any(|effect| effects.contains(&effect));
    analysis.models.iter().filter(|(scored, _)| acts(scored)).map(|(_, p)| p).sum()
}

/// Effects that act in a model, `None` being scatter between flights.
fn acting(scored: &ScoredHypothesis, library: &Library) -> impl Iterator<Item = Option<usize>> {
    let hypothesis = &scored.hypothesis;
    let named = hypothesis.columns.iter().map(|&column| Some(library.columns[column].effect));
    named.chain(hypothesis.flight_scatter_percent.map(|_| None))
}

/// What the list of causes is made from, besides the posteriors.
pub(crate) struct CauseEvidence<'a> {
    pub(crate) analysis: &'a Analysis,
    pub(crate) outside: &'a Outside,
    pub(crate) distances: &'a Distances,
    pub(crate) library: &'a Library,
    /// How far the gap shrinks on unseen flights, where that was measured.
    pub(crate) unseen: Option<&'a Shrinkage>,
    /// What is found of a guide's table, where it is more probably off than not.
    pub(crate) table: Option<&'a TableFinding>,
}

/// Causes worth listing, the most probable first.
pub(crate) fn causes(evidence: &CauseEvidence<'_>, posteriors: &[Posterior]) -> Vec<Cause> {
    let CauseEvidence { analysis, outside, distances, library, unseen, table } = *evidence;
    let inside = 1.0 - outside.probability;
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let best = &analysis.models[0].0;
    let mut sum = 0.0;
    let mut causes: Vec<Cause> = table.map(|table| of_table(table, unseen)).into_iter().collect();
    for posterior in posteriors {
        if causes.len() >= FEWEST_CAUSES
            && (sum > LISTED_PROBABILITY * named || posterior.probability < LEAST_LISTED)
        {
            break;
        }
        sum += posterior.probability;
        let is_best = table.is_none() && posterior.scored.hypothesis == best.hypothesis;
        causes.push(Cause {
            effect: id_of(library, posterior.effect),
            // Sums of many may pass one by rounding.
            probability: (posterior.probability * inside).min(1.0),
            probability_flat: (posterior.flat * inside).min(1.0),
            class: class_of(distances, library, posterior),
            magnitude: size_of(library, posterior),
            rms_after_percent: unseen.filter(|_| is_best).map(|s| 100.0 * s.after().sqrt()),
            closure: closed_unseen(unseen.filter(|_| is_best)),
            hidden: hidden_of(library, posterior),
        });
    }
    causes
}

/// A guide's table that is off, as the first cause.
fn of_table(table: &TableFinding, unseen: Option<&Shrinkage>) -> Cause {
    Cause {
        effect: EffectId::DragTable,
        probability: table.probability,
        probability_flat: table.probability,
        class: table.class.clone(),
        magnitude: table.magnitude,
        rms_after_percent: unseen.map(|s| 100.0 * s.after().sqrt()),
        closure: closed_unseen(unseen),
        hidden: HiddenParameter::None,
    }
}

/// The id of an effect of the library; `None` for scatter between flights.
pub(crate) fn id_of(library: &Library, effect: Option<usize>) -> EffectId {
    effect.map_or(EffectId::FuelHeatingValue, |e| library.effects[e].id)
}

/// What closes on unseen flights, where that was measured.
pub(crate) fn closed_unseen(unseen: Option<&Shrinkage>) -> Option<Closure> {
    let (share, ci95) = unseen.and_then(Shrinkage::closure)?;
    Some(Closure { share, ci95 })
}

/// Its size with the 95 % interval.
fn size_of(library: &Library, posterior: &Posterior) -> Magnitude {
    let Some((column, value)) = posterior.column_and_size() else {
        let percent = posterior.scored.hypothesis.flight_scatter_percent.unwrap_or(0.0);
        return Magnitude { value: percent, ci95: SCATTER_INTERVAL.map(|factor| factor * percent) };
    };
    let Column { effect, hidden, .. } = library.columns[column];
    magnitude(value, &posterior.beliefs, open_by_law(library.effects[effect].id, hidden))
}

pub(crate) fn class_of(
    distances: &Distances,
    library: &Library,
    posterior: &Posterior,
) -> Vec<EffectId> {
    match posterior.confused(distances, library) {
        None => vec![id_of(library, None)],
        Some(effects) => effects.into_iter().map(|effect| library.effects[effect].id).collect(),
    }
}

fn hidden_of(library: &Library, posterior: &Posterior) -> HiddenParameter {
    posterior
        .column_and_size()
        .map_or(HiddenParameter::None, |(column, _)| library.columns[column].hidden)
}
