//! Two effects that act together: whether a second one does, which, and what it could be instead.

use flight::effect::EffectId;

use crate::advice::distances::Distances;
use crate::hypotheses::evidence::ScoredHypothesis;
use crate::judge::posterior::{Posterior, presence};
use crate::library::Library;
use crate::output::verdict::Beside;
use crate::search::analyse::Analysis;
use crate::search::outside::Outside;
use crate::thresholds::{CREDIBLE, MORE_PROBABLE_THAN_NOT};

/// What pairs are judged by.
pub(super) struct PairEvidence<'a> {
    pub(super) analysis: &'a Analysis,
    pub(super) library: &'a Library,
    pub(super) distances: &'a Distances,
}

/// The effect that acts together with the leading one.
#[derive(Clone, Copy)]
pub(super) struct Partner {
    pub(super) column: usize,
    pub(super) size: f64,
}

impl PairEvidence<'_> {
    /// The effect that acts together with the leading one: of those in the models with both, the most probable, where it or what
    /// these flights cannot tell from it is more probable than not. Twins (a step at the date that was found and at that of an
    /// event, a meter and its engine) share that probability, and neither need have half of it.
    pub(super) fn partner(&self, top: &Posterior) -> Option<Partner> {
        let leading = top.effect?;
        let acts = self.acts_with(leading);
        let most = (0..acts.len()).max_by(|&a, &b| acts[a].total_cmp(&acts[b]))?;
        let effect_of = |column: usize| self.library.columns[column].effect;
        let models = self.analysis.models.iter().map(|(scored, _)| scored);
        let in_model = |scored: &ScoredHypothesis| {
            let columns = &scored.hypothesis.columns;
            let has_leading = columns.iter().any(|&column| effect_of(column) == leading);
            let place = columns.iter().position(|&column| effect_of(column) == most)?;
            has_leading.then(|| Partner { column: columns[place], size: scored.sizes[place] })
        };
        // The most probable model comes first.
        let partner = models.into_iter().find_map(in_model)?;
        let class = self.distances.confused_with(self.library, partner.column, partner.size);
        let together: f64 =
            class.into_iter().filter(|&other| other != leading).map(|k| acts[k]).sum();
        (together > MORE_PROBABLE_THAN_NOT).then_some(partner)
    }

    /// Probability that each effect acts together with the leading one and nothing else does.
    fn acts_with(&self, leading: usize) -> Vec<f64> {
        let mut acts = vec![0.0; self.library.effects.len()];
        for (scored, probability) in &self.analysis.models {
            let members =
                || scored.hypothesis.columns.iter().map(|&c| self.library.columns[c].effect);
            if members().any(|effect| effect == leading) {
                for other in members().filter(|other| *other != leading) {
                    acts[other] += probability;
                }
            }
        }
        acts
    }

    /// Effects that act together with the leading one in models that hold 95 % of the probability of all with it and another one.
    fn in_place_of(&self, leading: usize) -> Vec<usize> {
        let acts = self.acts_with(leading);
        let total: f64 = acts.iter().sum();
        let mut order: Vec<usize> = (0..acts.len()).collect();
        order.sort_by(|a, b| acts[*b].total_cmp(&acts[*a]));
        let mut sum = 0.0;
        let is_needed = |effect: &usize| {
            let before = sum;
            sum += acts[*effect];
            before < CREDIBLE * total
        };
        order.into_iter().take_while(is_needed).collect()
    }
}

/// An effect that acts together with the leading one, and what it could be instead: what these flights cannot tell from it, allowing
/// for other forms than the library's, and what is as probable in its place.
pub(super) fn companion(
    pairs: &PairEvidence<'_>,
    outside: &Outside,
    effects: &[EffectId],
    (Partner { column, size }, leading): (Partner, usize),
) -> Beside {
    let PairEvidence { analysis, library, distances } = *pairs;
    let own = library.columns[column].effect;
    let mut class = distances.confused_with(library, column, size);
    class.extend(distances.alike_in_form(library, column, size));
    class.extend(pairs.in_place_of(leading));
    let mut ids: Vec<EffectId> = vec![library.effects[own].id];
    for effect in class {
        let id = library.effects[effect].id;
        if !effects.contains(&id) && !ids.contains(&id) {
            ids.push(id);
        }
    }
    let acts = presence(analysis, library)[own];
    Beside {
        effect: ids[0],
        class: ids,
        probability: (acts * (1.0 - outside.probability)).min(1.0),
    }
}
