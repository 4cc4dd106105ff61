//! One search, the leading models refined: the posterior that the verdict reads.

use flight::effect::{EffectId, HiddenParameter};

use crate::hypotheses::backgrounds::{
    Background, Level, Smoothed, TableBelief, backgrounds, diagonals, smoothed,
};
use crate::hypotheses::evidence::{ScoredHypothesis, Scorer};
use crate::library::Testable;
use crate::math::eliminate::Reduced;
use crate::math::gram::Gram;
use crate::math::mixture::ln_sum;
use crate::priors::FLIGHT_SCATTER_SIZES_PERCENT;
use crate::search::pairs;
use crate::search::refine::{Relinearised, refine};
use crate::search::singles::{Kinds, search_all, search_flight_scatter};
use crate::search::system::{EliminatedGrams, Problem, SmoothTerms};
use crate::thresholds::{CONFUSED, REFINED, SHARE_BEYOND_TABLE, WORTH_REFINING};

/// The posterior over models.
pub(crate) struct Analysis {
    pub(crate) scorer: Scorer,
    pub(crate) backgrounds: Vec<Background>,
    /// Gram matrices with the nuisance integrated out, for every amount of scatter between flights.
    pub(crate) space: EliminatedGrams,
    /// Models, most probable first, with their probabilities.
    pub(crate) models: Vec<(ScoredHypothesis, f64)>,
    pub(crate) refined: Vec<Relinearised>,
    /// Gram matrices with the nuisance integrated out, at each size of flight-to-flight scatter (per cent) that is itself a
    /// probable cause.
    pub(crate) heating: Vec<(f64, Reduced)>,
    /// Probability of no effect, summed over the backgrounds that do not count as a finding.
    pub(crate) clean: f64,
}

/// Searches. `without` leaves a fold of flights out, and then no model is refined.
pub(crate) fn analyse(problem: Problem<'_>, without: Option<usize>) -> Option<Analysis> {
    let Problem { system, library, .. } = problem;
    let gram = system.gram(without);
    let smooth_terms = if without.is_none() { SmoothTerms::Kept } else { SmoothTerms::LeftOut };
    let mut levels = Vec::with_capacity(system.levels.len());
    let mut reduced = Vec::with_capacity(system.levels.len());
    for &at in &system.levels {
        let (level, left) = system.level(gram, at, without, smooth_terms)?;
        levels.push(level);
        reduced.push(left);
    }
    let at_levels: Vec<(Level, &Reduced)> = system.levels.iter().copied().zip(&reduced).collect();
    let space = EliminatedGrams {
        beliefs: system.levels.iter().map(|level| level.table).collect(),
        smoothed: smooth_out(problem, &at_levels),
        levels,
        reduced,
    };
    let all = backgrounds(&space.smoothed, library);
    let scorer = Scorer::new(library, gram.rows, held_by_table(problem, &space));
    let kinds = Kinds {
        nothing: all.iter().map(|at| system.is_nothing(at)).collect(),
        uncertain_table: all.iter().map(|at| system.belief(at) == TableBelief::Uncertain).collect(),
    };
    let negligible =
        if without.is_none() { pairs::NEGLIGIBLE } else { pairs::NEGLIGIBLE_BESIDE_THE_BEST };
    let search = search_all(&scorer, &all, negligible, &kinds);
    let mut models = search.models;
    if without.is_none() {
        models.extend(with_flight_scatter(problem, gram, &scorer)?);
    }
    models.sort_by(|a, b| b.ln_weight.total_cmp(&a.ln_weight));
    let mut refined = Vec::new();
    if without.is_none() {
        refined = refine_leading(problem, &scorer, &space, &all, &mut models);
        models.sort_by(|a, b| b.ln_weight.total_cmp(&a.ln_weight));
    }
    let total = ln_sum(models.iter().map(|m| m.ln_weight));
    let mut heating = Vec::new();
    for percent in FLIGHT_SCATTER_SIZES_PERCENT.into_iter().filter(|_| without.is_none()) {
        let scatter_alone = models.iter().any(|m| {
            m.hypothesis.columns.is_empty()
                && m.hypothesis
                    .flight_scatter_percent
                    .is_some_and(|p| p.total_cmp(&percent).is_eq())
                && (m.ln_weight - total).exp() > WORTH_REFINING
        });
        if scatter_alone {
            let (_, reduced) =
                system.level(gram, scattered(percent), without, SmoothTerms::Kept)?;
            heating.push((percent, reduced));
        }
    }
    let clean = (search.ln_clean - total).exp();
    let models = models
        .into_iter()
        .map(|m| {
            let probability = (m.ln_weight - total).exp();
            (m, probability)
        })
        .collect();
    Some(Analysis { scorer, backgrounds: all, space, models, refined, heating, clean })
}

/// Every smooth discrepancy that is admitted, over Grams without nuisance.
fn smooth_out(problem: Problem<'_>, levels: &[(Level, &Reduced)]) -> Vec<Smoothed> {
    let system = problem.system;
    smoothed(levels, system.design, |smooth_amplitude| system.admits(smooth_amplitude))
}

/// What only drag over lift coefficient and Mach number can be.
pub(crate) const DRAG_OF_A_TABLE: [EffectId; 4] =
    [EffectId::DragFactor, EffectId::ZeroLiftDrag, EffectId::InducedDrag, EffectId::WaveDrag];

/// Of every effect, whether a guide's table that is off could hold it as well: it can be seen where the table is right, and
/// where it may be off no longer, or by a small share of its signature alone. What such a share says depends on how a guide
/// may be off, of which nothing is known for certain. Nothing is held where the table is no guide's.
fn held_by_table(problem: Problem<'_>, space: &EliminatedGrams) -> Vec<bool> {
    let library = problem.library;
    let at = |belief: TableBelief| {
        let level = space.beliefs.iter().position(|found| *found == belief)?;
        space.reduced.get(level)
    };
    let beliefs = (at(TableBelief::Right), at(TableBelief::Uncertain));
    let (true, (Some(right), Some(uncertain))) = (problem.system.is_book(), beliefs) else {
        return vec![false; library.effects.len()];
    };
    let square = |under: &Reduced, column: usize| {
        let typical = library.effects[library.columns[column].effect].typical;
        typical * typical * under.matrix[(column, column)]
    };
    let is_hidden = |column: usize, share: f64| {
        let (seen, left) = (square(right, column), square(uncertain, column));
        seen >= CONFUSED && left < CONFUSED.max(share * seen)
    };
    let is_held = |effect: &Testable| match effect.id.entry().hidden {
        // What the few flights before a date say is little, and no table's.
        HiddenParameter::Step { .. } | HiddenParameter::History(_) => {
            is_hidden(effect.representative, 0.0)
        }
        _ => {
            let mut columns = effect.first_column..effect.first_column + effect.columns;
            columns.any(|column| is_hidden(column, SHARE_BEYOND_TABLE))
        }
    };
    let of_effect = |effect: &Testable| is_held(effect) || DRAG_OF_A_TABLE.contains(&effect.id);
    library.effects.iter().map(of_effect).collect()
}

/// This much scatter between flights; what is uncertain of the table is.
fn scattered(percent: f64) -> Level {
    Level { scatter: percent / 100.0, table: TableBelief::Uncertain, ln_prior: 0.0 }
}

/// Models with scatter between flights, alone and with one effect, where the library has it and it is no part of the noise
/// already.
fn with_flight_scatter(
    problem: Problem<'_>,
    gram: &Gram,
    scorer: &Scorer,
) -> Option<Vec<ScoredHypothesis>> {
    let Problem { system, library, .. } = problem;
    let mut models = Vec::new();
    for percent in FLIGHT_SCATTER_SIZES_PERCENT.into_iter().filter(|_| library.heating_value) {
        let at = scattered(percent);
        if system.levels.iter().any(|level| level.scatter >= at.scatter) {
            continue; // part of the noise already
        }
        let (_, left) = system.level(gram, at, None, SmoothTerms::LeftOut)?;
        let under = diagonals(&smooth_out(problem, &[(at, &left)]), library);
        models.extend(search_flight_scatter(scorer, &under, percent));
    }
    Some(models)
}

/// Refines the leading models in their places.
fn refine_leading(
    problem: Problem<'_>,
    scorer: &Scorer,
    space: &EliminatedGrams,
    backgrounds: &[Background],
    models: &mut [ScoredHypothesis],
) -> Vec<Relinearised> {
    let total = ln_sum(models.iter().map(|m| m.ln_weight));
    let leading: Vec<usize> = (0..models.len())
        .filter(|&k| {
            let hypothesis = &models[k].hypothesis;
            !hypothesis.columns.is_empty() && hypothesis.flight_scatter_percent.is_none()
        })
        .take(REFINED)
        .take_while(|&k| (models[k].ln_weight - total).exp() >= WORTH_REFINING)
        .collect();
    let starts: Vec<_> =
        leading.iter().map(|&k| (&models[k], &backgrounds[models[k].background])).collect();
    let found = refine(problem, scorer, space, &starts, None);
    let mut refined = Vec::new();
    for (&k, found) in leading.iter().zip(found) {
        if let Some(found) = found {
            models[k] = found.scored.clone();
            refined.push(found);
        }
    }
    refined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_per_cent_of_scatter_is_five_thousandths() {
        assert!((scattered(0.5).scatter - 0.005).abs() < 1e-15);
    }
}
