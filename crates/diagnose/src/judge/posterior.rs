//! The probability of each effect, and the causes made from it.

use flight::effect::{EffectId, HiddenParameter};

use crate::advice::distances::Distances;
use crate::hypotheses::evidence::ScoredHypothesis;
use crate::judge::closure::Shrinkage;
use crate::library::Library;
use crate::output::verdict::Closure;
use crate::output::{Cause, Magnitude};
use crate::search::analyse::Analysis;
use crate::search::outside::Outside;
use crate::search::system::WhitenedSystem;
use crate::thresholds::{
    FEWEST_CAUSES, LEAST_LISTED, LISTED_PROBABILITY, NORMAL_95, SCATTER_INTERVAL,
};

/// An effect with its posterior.
#[derive(Clone, Debug)]
pub(crate) struct Posterior {
    /// Index in the library; `None` for flight-to-flight scatter.
    pub(crate) effect: Option<usize>,
    pub(crate) probability: f64,
    /// The most probable model in which it is the larger effect.
    pub(crate) model: ScoredHypothesis,
    /// Its place in that model.
    pub(crate) place: usize,
}

impl Posterior {
    /// Its column of the library and the size there; `None` for scatter between flights.
    pub(crate) fn column_and_size(&self) -> Option<(usize, f64)> {
        self.effect?;
        Some((self.model.model.columns[self.place], self.model.sizes[self.place]))
    }

    /// Effects that these flights cannot tell from it, itself first; `None` for scatter between flights.
    pub(crate) fn confused(&self, distances: &Distances, library: &Library) -> Option<Vec<usize>> {
        let (column, size) = self.column_and_size()?;
        Some(distances.confused_with(library, column, size))
    }
}

/// Probability of each effect to be the larger one of what acts, over models.
pub(crate) fn dominant(
    stacked: &WhitenedSystem<'_>,
    analysis: &Analysis,
    library: &Library,
) -> Vec<Posterior> {
    let count = stacked.data.segments.len() as f64;
    let mean_squares: Vec<f64> = (0..library.columns.len())
        .map(|column| {
            stacked.data.segments.iter().map(|row| row.signatures[column][0].powi(2)).sum::<f64>()
                / count
        })
        .collect();
    // One entry per effect, flight-to-flight scatter last.
    let mut found: Vec<Option<Posterior>> = vec![None; library.effects.len() + 1];
    for (scored, probability) in &analysis.models {
        let mut shares: Vec<(f64, Option<usize>, usize)> = scored
            .model
            .columns
            .iter()
            .zip(&scored.sizes)
            .enumerate()
            .map(|(place, (&column, size))| {
                (size * size * mean_squares[column], Some(library.columns[column].effect), place)
            })
            .collect();
        if let Some(percent) = scored.model.flight_scatter_percent {
            shares.push(((percent / 100.0).powi(2), None, 0));
        }
        let Some(&(_, effect, place)) = shares.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else {
            continue;
        };
        let slot = &mut found[effect.unwrap_or(library.effects.len())];
        match slot {
            Some(posterior) => posterior.probability += probability,
            None => {
                *slot = Some(Posterior {
                    effect,
                    probability: *probability,
                    model: scored.clone(),
                    place,
                });
            }
        }
    }
    let mut all: Vec<Posterior> = found.into_iter().flatten().collect();
    all.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    all
}

/// What the list of causes is made from, besides the posteriors.
pub(crate) struct CauseEvidence<'a> {
    pub(crate) analysis: &'a Analysis,
    pub(crate) outside: &'a Outside,
    pub(crate) distances: &'a Distances,
    pub(crate) library: &'a Library,
    /// How far the gap shrinks on unseen flights, where that was measured.
    pub(crate) unseen: Option<&'a Shrinkage>,
}

/// Causes worth listing, the most probable first.
pub(crate) fn causes(evidence: &CauseEvidence<'_>, posteriors: &[Posterior]) -> Vec<Cause> {
    let CauseEvidence { analysis, outside, distances, library, unseen } = *evidence;
    let inside = 1.0 - outside.probability;
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let best = &analysis.models[0].0;
    let mut sum = 0.0;
    let mut causes = Vec::new();
    for posterior in posteriors {
        if causes.len() >= FEWEST_CAUSES
            && (sum > LISTED_PROBABILITY * named || posterior.probability < LEAST_LISTED)
        {
            break;
        }
        sum += posterior.probability;
        let is_best = posterior.model.model == best.model;
        causes.push(Cause {
            effect: id_of(library, posterior.effect),
            probability: posterior.probability * inside,
            class: class_of(distances, library, posterior),
            magnitude: magnitude(posterior),
            rms_after_percent: unseen.filter(|_| is_best).map(|s| 100.0 * s.after().sqrt()),
            closure: closed_unseen(unseen.filter(|_| is_best)),
            hidden: hidden_of(library, posterior),
        });
    }
    causes
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

fn magnitude(posterior: &Posterior) -> Magnitude {
    if posterior.effect.is_none() {
        let percent = posterior.model.model.flight_scatter_percent.unwrap_or(0.0);
        return Magnitude { value: percent, ci95: SCATTER_INTERVAL.map(|factor| factor * percent) };
    }
    let value = posterior.model.sizes[posterior.place];
    let half = NORMAL_95 * posterior.model.deviations[posterior.place];
    Magnitude { value, ci95: [value - half, value + half] }
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
