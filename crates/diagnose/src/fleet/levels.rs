//! Which effects act at one level, on one tail or in the type: none, one or two beyond those already found.

use std::collections::BTreeMap;

use faer::Mat;
use flight::effect::{EffectGroup, EffectId};

use crate::hypotheses::backgrounds::Background;
use crate::hypotheses::evidence::{Prior, Scorer};
use crate::library::{Testable, acts_at_all_times};
use crate::math::eliminate::integrate_out;
use crate::math::mixture::ln_sum;
use crate::priors::{FLEET_FREE, FLEET_OTHER_LEVEL, PRIOR_BY_SIZE};
use crate::thresholds::{CONFUSED, FLEET_ACTS, FLEET_CLASS, FLEET_MOST_EFFECTS};

/// Where an effect acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum At {
    Type,
    Tail,
}

/// What is believed of the effects at one level.
#[derive(Clone, Debug)]
pub(crate) struct Beliefs {
    scorer: Scorer,
    typical: Vec<f64>,
    /// Effects that may be named here.
    may_act: Vec<bool>,
    /// ln of the share of the prior that each has.
    ln_share: Vec<f64>,
    /// Prior probabilities of none, one, two.
    pub(crate) by_size: [f64; 3],
}

/// A Gram over the effects and the residual, with what it belongs to.
pub(crate) struct Weighed {
    pub(crate) matrix: Mat<f64>,
    pub(crate) ln_weight: f64,
}

/// The posterior over what acts beyond what is free.
#[derive(Clone, Debug)]
pub(crate) struct LevelPosterior {
    /// Effects and probability of every hypothesis; the first is that of no effect.
    hypotheses: Vec<(Vec<usize>, f64)>,
    /// ln of the evidence summed over all.
    pub(crate) ln: f64,
}

/// An effect that acts, with those that the flights cannot distinguish from it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Acting {
    pub(crate) effect: usize,
    /// Effects that the flights cannot distinguish, itself first.
    pub(crate) class: Vec<usize>,
    /// That one of the class acts.
    pub(crate) probability: f64,
    /// That it is this one.
    pub(crate) own_probability: f64,
}

impl Beliefs {
    pub(crate) fn new(effects: &[Testable], at: At) -> Self {
        let may_act: Vec<bool> =
            effects.iter().map(|effect| at == At::Type || !effect.has_known_size).collect();
        let share = |effect: &Testable| if usual(effect.id, at) { 1.0 } else { FLEET_OTHER_LEVEL };
        let total: f64 = effects.iter().map(share).sum();
        let count = effects.len();
        Self {
            scorer: Scorer {
                priors: effects.iter().map(Prior::of).collect(),
                effect_of: (0..count).collect(),
                ln_choices: vec![0.0; count],
                effects: count,
                age_of: vec![None; count],
                held: vec![false; count],
                rows: 0.0,
            },
            typical: effects.iter().map(|effect| effect.typical).collect(),
            may_act,
            ln_share: effects.iter().map(|effect| (share(effect) / total).ln()).collect(),
            by_size: PRIOR_BY_SIZE.map(|share| share / PRIOR_BY_SIZE.iter().sum::<f64>()),
        }
    }

    pub(crate) fn effects(&self) -> usize {
        self.typical.len()
    }

    /// Standard deviations of effects that act a little, all at this scale, and of those that are free.
    pub(crate) fn deviations(&self, small: f64, free: &[usize]) -> Vec<f64> {
        (0..self.effects())
            .map(|k| {
                let free = if free.contains(&k) { FLEET_FREE } else { 0.0 };
                let small = if self.may_act[k] { small } else { 0.0 };
                self.typical[k] * small.hypot(free)
            })
            .collect()
    }

    /// What acts beyond the `free` effects where every other effect acts a little (`small`, of typical size).
    pub(crate) fn posterior(
        &self,
        gram: &Weighed,
        rows: f64,
        small: f64,
        free: &[usize],
    ) -> Option<LevelPosterior> {
        let effects = self.effects();
        let scorer = Scorer { rows, ..self.scorer.clone() };
        let deviations = self.deviations(small, free);
        let out: Vec<usize> = (0..effects).filter(|&k| deviations[k] > 0.0).collect();
        let out_deviations: Vec<f64> = out.iter().map(|&k| deviations[k]).collect();
        let all: Vec<usize> = (0..effects).collect();
        let kept: Vec<usize> = (0..=effects).collect();
        let left = integrate_out(&gram.matrix, &kept, &out, &out_deviations)?;
        let at = Background::small(&left.matrix, &all, effects, left.ln_determinant);
        // What the flights say nothing about would only take prior probability from no effect.
        let is_seen = |k: usize| at.gram(k, k) * self.typical[k].powi(2) >= CONFUSED;
        let may_act: Vec<usize> =
            (0..effects).filter(|k| self.may_act[*k] && !free.contains(k) && is_seen(*k)).collect();
        let by_size = self.by_size.map(|share| share.ln() + gram.ln_weight);
        let mut found = vec![(vec![], by_size[0] + scorer.none(&at))];
        for (place, &a) in may_act.iter().enumerate() {
            let ln_prior = by_size[1] + self.ln_share[a];
            found.push((vec![a], ln_prior + scorer.one(&at, a, 0.0).ln));
            for &b in &may_act[..place] {
                let ln_prior = by_size[2] + self.ln_share[a] + self.ln_share[b] + 2.0_f64.ln();
                found.push((vec![b, a], ln_prior + scorer.two(&at, [b, a], [0.0; 2]).ln));
            }
        }
        let ln = ln_sum(found.iter().map(|(_, ln)| *ln));
        for (_, value) in &mut found {
            *value = (*value - ln).exp();
        }
        Some(LevelPosterior { hypotheses: found, ln })
    }
}

/// All that acts at one level: one effect, or two and what is found beside them. `posterior` is that beside the effects given.
pub(crate) fn all_acting(
    mut posterior: impl FnMut(&[usize]) -> Option<LevelPosterior>,
) -> Option<Vec<Acting>> {
    let mut acting: Vec<Acting> = Vec::new();
    loop {
        let free: Vec<usize> = acting.iter().map(|one| one.effect).collect();
        let more = posterior(&free)?.acting();
        let is_last = more.len() < 2 || free.len() + more.len() >= FLEET_MOST_EFFECTS;
        acting.extend(more);
        if is_last {
            return Some(acting);
        }
    }
}

impl LevelPosterior {
    pub(crate) fn none(&self) -> f64 {
        self.hypotheses[0].1
    }

    /// What acts more probably than not: nothing, one effect, or two. After two there may be more beside them.
    pub(crate) fn acting(&self) -> Vec<Acting> {
        if self.none() >= 1.0 - FLEET_ACTS {
            return Vec::new();
        }
        let pairs = self.hypotheses.iter().filter(|(named, _)| named.len() == 2);
        let best_pair = pairs.clone().max_by(|a, b| a.1.total_cmp(&b.1));
        let two_act: f64 = pairs.map(|(_, probability)| probability).sum();
        match best_pair {
            Some((named, _)) if two_act > FLEET_ACTS => self.both([named[0], named[1]]),
            _ => self.one().into_iter().collect(),
        }
    }

    /// Probability that one of these acts.
    fn any_of(&self, effects: &[usize]) -> f64 {
        let is_in = |(named, _): &&(Vec<usize>, f64)| named.iter().any(|k| effects.contains(k));
        self.hypotheses.iter().filter(is_in).map(|(_, probability)| probability).sum()
    }

    /// The effect that acts most probably, with those that act instead.
    fn one(&self) -> Option<Acting> {
        let marginal = self.marginal(|_| true);
        let (&effect, &own_probability) = marginal.iter().max_by(|a, b| a.1.total_cmp(b.1))?;
        let instead = self.marginal(|named| !named.contains(&effect));
        let class = class_of(effect, own_probability, &instead);
        Some(Acting { effect, probability: self.any_of(&class), own_probability, class })
    }

    /// Two effects, the surer one first. The other one is one only where it acts beside the first.
    fn both(&self, pair: [usize; 2]) -> Vec<Acting> {
        let own = pair.map(|effect| self.any_of(&[effect]));
        let [first, second] = if own[0] >= own[1] { pair } else { [pair[1], pair[0]] };
        let class = |effect: usize, beside: usize| {
            let with = |named: &[usize]| named.len() == 2 && named.contains(&beside);
            let mut marginal = self.marginal(with);
            marginal.remove(&beside);
            class_of(effect, marginal.get(&effect).copied().unwrap_or(0.0), &marginal)
        };
        let classes = [class(first, second), class(second, first)];
        let is_both = |(named, _): &&(Vec<usize>, f64)| match named[..] {
            [a, b] => {
                (classes[0].contains(&a) && classes[1].contains(&b))
                    || (classes[0].contains(&b) && classes[1].contains(&a))
            }
            _ => false,
        };
        let of_both: f64 = self.hypotheses.iter().filter(is_both).map(|(_, p)| p).sum();
        let of_first = self.any_of(&classes[0]);
        let own_probability = |effect| self.any_of(&[effect]);
        [(first, of_first), (second, of_both)]
            .into_iter()
            .zip(classes)
            .map(|((effect, probability), class)| Acting {
                effect,
                class,
                probability,
                own_probability: own_probability(effect),
            })
            .collect()
    }

    /// Probability of every effect, of the hypotheses that are asked for.
    fn marginal(&self, is_asked: impl Fn(&[usize]) -> bool) -> BTreeMap<usize, f64> {
        let mut marginal = BTreeMap::new();
        for (named, probability) in &self.hypotheses {
            if is_asked(named) {
                for &effect in named {
                    *marginal.entry(effect).or_insert(0.0) += probability;
                }
            }
        }
        marginal
    }
}

/// An effect, then those whose probability to act instead of it is not far below its own.
fn class_of(effect: usize, own: f64, instead: &BTreeMap<usize, f64>) -> Vec<usize> {
    let mut others: Vec<(usize, f64)> = instead
        .iter()
        .filter(|&(&k, &probability)| k != effect && probability >= own / FLEET_CLASS)
        .map(|(&k, &probability)| (k, probability))
        .collect();
    others.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    core::iter::once(effect).chain(others.into_iter().map(|(k, _)| k)).collect()
}

/// Whether an effect is usual at a level: equations, laws and the air are the type's; sensors, loading, single engines and age
/// are the tail's; levels of drag and TSFC are either's.
fn usual(id: EffectId, at: At) -> bool {
    let is_law = matches!(
        id,
        EffectId::ReynoldsNumber
            | EffectId::TsfcMachExponent
            | EffectId::TsfcTemperatureExponent
            | EffectId::TsfcThrottle
    ) || id.entry().group == EffectGroup::Environment;
    match at {
        At::Type => acts_at_all_times(id),
        At::Tail => !is_law,
    }
}
