//! Outside the library: smooth terms of one variable compete with the named effects.

use effects::Variable;

use crate::hypotheses::backgrounds::{Background, TableBelief, small_effects};
use crate::hypotheses::design::Acts;
use crate::hypotheses::evidence::{Hypothesis, ScoredHypothesis, Scorer, Single};
use crate::library::Library;
use crate::math::eliminate::{Changed, Reduced, integrate_few_out, integrate_out};
use crate::math::linear::gather;
use crate::math::mixture::ln_sum;
use crate::priors::{AGNOSTIC_AMPLITUDES, FORM_ERROR, PRIOR_OTHER_FORM, PRIOR_OUTSIDE};
use crate::residuals::rows::SegmentRow;
use crate::search::analyse::Analysis;
use crate::search::system::WhitenedSystem;
use crate::thresholds::AGNOSTIC_SETS;

/// What the competition says.
#[derive(Clone, Debug)]
pub(crate) struct Outside {
    /// Probability that a smooth term is needed.
    pub(crate) probability: f64,
    /// The variable that it depends on, and how it acts.
    pub(crate) variable: Option<(Variable, Acts)>,
    /// Variables of smooth terms, the most probable first.
    pub(crate) leading: Vec<Variable>,
    /// If one is needed: the probability of each companion to act in addition to it.
    beside: Vec<(Companion, f64)>,
}

/// A named cause that may act together with a smooth term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Companion {
    /// An effect of the library.
    Effect(usize),
    /// Scatter between flights.
    Scatter,
}

impl Outside {
    /// If a smooth term is needed: the probability that this acts in addition to it.
    pub(crate) fn beside(&self, companion: Companion) -> f64 {
        self.beside.iter().filter(|b| b.0 == companion).map(|b| b.1).sum()
    }
}

/// Lets smooth terms compete with the most probable named sets.
pub(crate) fn compete(
    system: &WhitenedSystem<'_>,
    analysis: &Analysis,
    library: &Library,
) -> Outside {
    let scorer = &analysis.scorer;
    let empty = Hypothesis { columns: vec![], flight_scatter_percent: None };
    let none = ScoredHypothesis {
        hypothesis: empty,
        ln_weight: 0.0,
        sizes: vec![],
        deviations: vec![],
        background: 0,
        table_share: 0.0,
    };
    let mut sets: Vec<&ScoredHypothesis> =
        core::iter::once(&none).chain(named_models(analysis).take(AGNOSTIC_SETS)).collect();
    add_singles(&mut sets, analysis, library);
    let mut weights = Weights { named: Vec::new(), smooth_terms: Vec::new() };
    for set in &sets {
        let refined = analysis.refined.iter().find(|found| {
            found.scored.hypothesis == set.hypothesis && !set.hypothesis.columns.is_empty()
        });
        let rms = rms_of(system, refined.map_or(*set, |found| &found.scored));
        let shifts =
            refined.map_or_else(|| vec![0.0; set.hypothesis.columns.len()], |f| f.shifts.clone());
        for (level, reduced) in analysis.space.reduced.iter().enumerate() {
            let changed = refined.map(|found| &found.changed[level]);
            let ln_share = system.levels[level].ln_prior;
            let spikes = match system.levels[level].table {
                TableBelief::Uncertain => library.agnostic_spikes.len(),
                TableBelief::Right => 1,
            };
            let level = (reduced, changed);
            let set = NamedSet {
                hypothesis: &set.hypothesis,
                level,
                shifts: &shifts,
                ln_share,
                spikes,
                rms,
            };
            weights.add(system, library, scorer, &set);
        }
    }
    // Flight-to-flight scatter is a named cause as well: an effect that depends on a flight's conditions looks like scatter
    // until a function of those conditions competes. The sets above are summed over all amounts of scatter; here each size
    // replaces them.
    for (percent, reduced) in &analysis.heating {
        let model = Hypothesis { columns: vec![], flight_scatter_percent: Some(*percent) };
        let level = (reduced, None);
        let spikes = library.agnostic_spikes.len();
        let set =
            NamedSet { hypothesis: &model, level, shifts: &[], ln_share: 0.0, spikes, rms: 0.0 };
        weights.add(system, library, scorer, &set);
    }
    let Weights { named, smooth_terms } = weights;
    let inside = ln_sum(named);
    let outside = ln_sum(smooth_terms.iter().map(|a| a.ln));
    let probability = 1.0 / (1.0 + (inside - outside).clamp(-500.0, 500.0).exp());
    Outside {
        probability: if probability.is_finite() { probability } else { 0.0 },
        variable: leading_variable(system, &smooth_terms),
        leading: leading_variables(system, &smooth_terms),
        beside: (0..library.effects.len())
            .map(Companion::Effect)
            .chain([Companion::Scatter])
            .map(|companion| {
                let with =
                    smooth_terms.iter().filter(|a| a.beside == Some(companion)).map(|a| a.ln);
                (companion, (ln_sum(with) - outside).exp())
            })
            .filter(|(_, probability)| *probability > 0.0)
            .collect(),
    }
}

/// The variable of the most probable smooth term, and how it acts: weights summed over sets and amplitudes.
fn leading_variable(
    system: &WhitenedSystem<'_>,
    smooth_terms: &[WithSmoothTerm],
) -> Option<(Variable, Acts)> {
    let blocks = &system.design.blocks;
    let ln = |block: usize| ln_sum(smooth_terms.iter().filter(|a| a.block == block).map(|a| a.ln));
    let best = (0..blocks.len()).map(|block| (ln(block), block)).max_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, block)| (blocks[block].variable, blocks[block].acts))
}

/// All variables, the most probable first: weights summed over sets, amplitudes and what they act on.
fn leading_variables(
    system: &WhitenedSystem<'_>,
    smooth_terms: &[WithSmoothTerm],
) -> Vec<Variable> {
    let blocks = &system.design.blocks;
    let mut variables: Vec<Variable> = blocks
        .iter()
        .filter(|block| block.acts != Acts::Split)
        .map(|block| block.variable)
        .collect();
    variables.dedup();
    let ln = |variable: Variable| {
        let own = smooth_terms.iter().filter(|term| blocks[term.block].variable == variable);
        ln_sum(own.map(|term| term.ln))
    };
    let mut weighed: Vec<(f64, Variable)> =
        variables.into_iter().map(|variable| (ln(variable), variable)).collect();
    weighed.sort_by(|a, b| b.0.total_cmp(&a.0));
    weighed.into_iter().map(|(_, variable)| variable).collect()
}

/// Models with a named effect and without scatter between flights, most probable first.
fn named_models(analysis: &Analysis) -> impl Iterator<Item = &ScoredHypothesis> {
    analysis.models.iter().map(|(scored, _)| scored).filter(|s| {
        !s.hypothesis.columns.is_empty() && s.hypothesis.flight_scatter_percent.is_none()
    })
}

/// Adds the best single model of every effect that a set holds: smooth terms join at most one effect, and the sets may
/// all be pairs.
fn add_singles<'a>(
    sets: &mut Vec<&'a ScoredHypothesis>,
    analysis: &'a Analysis,
    library: &Library,
) {
    let effect = |column: usize| library.columns[column].effect;
    let mut wanted: Vec<usize> =
        sets.iter().flat_map(|s| &s.hypothesis.columns).map(|&column| effect(column)).collect();
    wanted.sort_unstable();
    wanted.dedup();
    for set in sets.iter().filter(|s| s.hypothesis.columns.len() == 1) {
        wanted.retain(|&e| e != effect(set.hypothesis.columns[0]));
    }
    for single in named_models(analysis).filter(|s| s.hypothesis.columns.len() == 1) {
        let own = effect(single.hypothesis.columns[0]);
        if wanted.contains(&own) {
            wanted.retain(|&e| e != own);
            sets.push(single);
        }
    }
}

/// ln weights of sets without a smooth term, and of sets with one.
struct Weights {
    named: Vec<f64>,
    smooth_terms: Vec<WithSmoothTerm>,
}

/// A set with a smooth term.
struct WithSmoothTerm {
    ln: f64,
    block: usize,
    /// What the set names.
    beside: Option<Companion>,
}

/// A named set at one level of scatter between flights.
struct NamedSet<'a> {
    hypothesis: &'a Hypothesis,
    /// The Gram without nuisance at that level, and what takes the place of its own columns there.
    level: (&'a Reduced, Option<&'a Changed>),
    /// Where the set was linearised.
    shifts: &'a [f64],
    /// ln prior of the level.
    ln_share: f64,
    /// How many scales of small effects it is held over, from the smallest.
    spikes: usize,
    /// Root mean square of what it changes ln fuel flow by.
    rms: f64,
}

/// Root mean square of what a set changes ln fuel flow by.
fn rms_of(system: &WhitenedSystem<'_>, set: &ScoredHypothesis) -> f64 {
    let segments = &system.data.segments;
    let own = || set.hypothesis.columns.iter().zip(&set.sizes);
    let square = |row: &SegmentRow| {
        own().map(|(&column, size)| size * row.signatures[column][0]).sum::<f64>().powi(2)
    };
    (segments.iter().map(square).sum::<f64>() / segments.len().max(1) as f64).sqrt()
}

/// ln evidence of a named set whose form is right, or off by a function of one variable that is a share of the set's own
/// size: truth never has the library's form, and what a large effect leaves for that reason is no other cause.
fn with_other_forms(under: &Under<'_>, scorer: &Scorer, set: &NamedSet<'_>, right: f64) -> f64 {
    let blocks = under.blocks.len();
    if set.rms <= 0.0 || blocks == 0 {
        return right;
    }
    let amplitude = FORM_ERROR * set.rms;
    let other =
        (0..blocks).map(|block| under.evidence(scorer, Some((block, amplitude)), set.shifts));
    let other = ln_sum(other) - (blocks as f64).ln();
    ln_sum([PRIOR_OTHER_FORM.ln() + other, (1.0 - PRIOR_OTHER_FORM).ln() + right])
}

impl Weights {
    /// Adds a named set at one level of scatter and every spike, alone and with each smooth terms.
    fn add(
        &mut self,
        system: &WhitenedSystem<'_>,
        library: &Library,
        scorer: &Scorer,
        set: &NamedSet<'_>,
    ) {
        let &NamedSet { hypothesis, level, shifts, ln_share, .. } = set;
        let prior = scorer.ln_prior(hypothesis) + ln_share;
        for small_effects_scale in library.agnostic_spikes.into_iter().take(set.spikes) {
            let Some(under) = with_small_effects(
                system,
                library,
                level,
                &hypothesis.columns,
                small_effects_scale,
            ) else {
                continue;
            };
            let alone = under.evidence(scorer, None, shifts);
            let alone = with_other_forms(&under, scorer, set, alone);
            self.named.push(prior + (1.0 - PRIOR_OUTSIDE).ln() + alone);
            // Smooth terms of another cause are combined with at most one effect.
            if hypothesis.columns.len() > 1 {
                continue;
            }
            let effect = hypothesis.columns.first().map(|&column| library.columns[column].effect);
            let beside = match hypothesis.flight_scatter_percent {
                Some(_) => Some(Companion::Scatter),
                None => effect.map(Companion::Effect),
            };
            let blocks = system.design.blocks.len();
            let share = (AGNOSTIC_AMPLITUDES.len() * blocks).max(1) as f64;
            for block in 0..blocks {
                for amplitude in AGNOSTIC_AMPLITUDES {
                    let ln = under.evidence(scorer, Some((block, amplitude)), shifts);
                    let ln = prior + PRIOR_OUTSIDE.ln() - share.ln() + ln;
                    self.smooth_terms.push(WithSmoothTerm { ln, block, beside });
                }
            }
        }
    }
}

/// A named set over a spike of every effect: Gram of its columns, all blocks, and the residual.
struct Under<'a> {
    reduced: Reduced,
    columns: &'a [usize],
    blocks: Vec<core::ops::Range<usize>>,
}

fn with_small_effects<'a>(
    system: &WhitenedSystem<'_>,
    library: &Library,
    (reduced, changed): (&Reduced, Option<&Changed>),
    columns: &'a [usize],
    small_effects_scale: f64,
) -> Option<Under<'a>> {
    let design = system.design;
    // Columns of `reduced`: effects, smooth, blocks one after the other, residual.
    let first_block = design.effects + design.smooth.len();
    let residual = reduced.matrix.ncols() - 1;
    let mut kept: Vec<usize> = columns.to_vec();
    let mut blocks = Vec::new();
    let mut at = first_block;
    for block in &design.blocks {
        let start = kept.len();
        kept.extend(at..at + block.columns.len());
        at += block.columns.len();
        blocks.push(start..kept.len());
    }
    kept.push(residual);
    let (mut out, mut deviations) = small_effects(library, small_effects_scale);
    // What a learnt remainder may lack does not count as a discovery.
    let smooth_amplitude = system.clean_smooth_amplitude();
    if smooth_amplitude > 0.0 {
        out.extend(design.effects..first_block);
        let deviation = design.smooth_deviation(smooth_amplitude);
        deviations.extend(vec![deviation; design.smooth.len()]);
    }
    let own: Vec<usize> = columns.iter().copied().chain([residual]).collect();
    let mut with_small_effects = match changed {
        Some(changed) => {
            // Only what is looked at, with the columns that changed.
            let used: Vec<usize> = kept.iter().chain(&out).copied().collect();
            let mut matrix = gather(&reduced.matrix, &used, &used);
            changed.write_used(&mut matrix, &own, &used);
            let kept: Vec<usize> = (0..kept.len()).collect();
            let out: Vec<usize> = (kept.len()..used.len()).collect();
            integrate_out(&matrix, &kept, &out, &deviations)?
        }
        None => integrate_out(&reduced.matrix, &kept, &out, &deviations)?,
    };
    with_small_effects.ln_determinant += reduced.ln_determinant;
    Some(Under { reduced: with_small_effects, columns, blocks })
}

impl Under<'_> {
    fn evidence(&self, scorer: &Scorer, block: Option<(usize, f64)>, shifts: &[f64]) -> f64 {
        let own = self.columns.len();
        let residual = self.reduced.matrix.ncols() - 1;
        let kept: Vec<usize> = (0..own).chain([residual]).collect();
        let out = block.map_or(0..0, |(block, _)| self.blocks[block].clone());
        let amplitude = block.map_or(0.0, |(_, amplitude)| amplitude);
        let Some(left) = integrate_few_out(&self.reduced.matrix, &kept, out, amplitude) else {
            return f64::NEG_INFINITY;
        };
        let ln_determinant = self.reduced.ln_determinant + left.ln_determinant;
        let square = left.matrix[(own, own)];
        match self.columns[..] {
            [] => scorer.nothing(square, ln_determinant),
            [a] => {
                let (gram, product) = (left.matrix[(0, 0)], left.matrix[(0, 1)]);
                let single = Single { gram, product, square, ln_determinant };
                scorer.single(single, a, shifts[0]).ln
            }
            [a, b, ..] => {
                let columns = scorer.columns();
                let at = Background::small(&left.matrix, self.columns, columns, ln_determinant);
                scorer.two(&at, [a, b], [shifts[0], shifts[1]]).ln
            }
        }
    }
}
