//! The conclusion: an effect, its class, advice; or that nothing in the library fits.

use effects::Variable;
use flight::effect::{DrivingVariable, EffectId};

use crate::advice::advisor::{Advisor, best_first};
use crate::advice::distances::Distances;
use crate::judge::closure::Shrinkage;
use crate::judge::pair::{PairEvidence, Partner, companion};
use crate::judge::posterior::{
    CauseEvidence, Posterior, class_of, closed_unseen, id_of, presence, presence_of_any,
};
use crate::judge::table::TableFinding;
use crate::library::{Library, Testable};
use crate::output::measurement::Separation;
use crate::output::note::Note;
use crate::output::verdict::{Beside, Found, Rest, RestKind, Unexplained, Verdict};
use crate::place::named::NamedGap;
use crate::search::analyse::Analysis;
use crate::search::outside::{Companion, Outside};
use crate::search::system::{Problem, WhitenedSystem};
use crate::thresholds::{
    CLOSES, CREDIBLE, LEVEL_LIKE, MORE_PROBABLE_THAN_NOT, OTHER_FORM, OUTSIDE_PROBABILITY,
    SIZE_ALONE,
};

/// Share of the explainable gap that the leading set closes, with its interval: on unseen flights; on the same ones where the
/// gap is too small for that; `None` where it is too small for either.
pub(crate) fn closed(unseen: Option<&Shrinkage>, own: &Shrinkage) -> Option<(f64, [f64; 2])> {
    unseen.and_then(Shrinkage::closure).or_else(|| own.closure())
}

/// How much of the evidence for an agnostic function goes to the leading effect `[diagnosis.41]`: the larger of
///
/// - what says that the function is the effect in another form. Truth never has the library's form exactly, and with enough
///   flights an agnostic function sees it. Effects of the library in other forms closed 0.94 to 0.98 of the gap on two
///   other simulators, effects that the library lacks 0.25 at most;
/// - what says that the effect acts *beside* the function: the probability of it or of a member of its class in the models
///   that hold a function, as long as the effect surely makes unseen flights better, where that can be measured. Real
///   gaps have many causes, and the largest has a name though the rest has none.
///
/// Scatter between flights closes nothing: it comes without a share `closed`, and only the second counts for it.
pub(crate) fn credit(beside: f64, closed: Option<(f64, [f64; 2])>) -> f64 {
    let Some((share, [least, _])) = closed else { return beside };
    let [none, all] = OTHER_FORM;
    let form = ((share - none) / (all - none)).clamp(0.0, 1.0);
    if least > 0.0 { form.max(beside) } else { form }
}

/// If an agnostic function is needed, the probability that the leading effect, or one that these flights cannot tell from it,
/// acts beside it.
pub(crate) fn beside(
    outside: &Outside,
    distances: &Distances,
    library: &Library,
    top: Option<&Posterior>,
) -> f64 {
    let Some(top) = top else { return 0.0 };
    let found: f64 = match top.confused(distances, library) {
        None => outside.beside(Companion::Scatter),
        Some(class) => {
            class.into_iter().map(|effect| outside.beside(Companion::Effect(effect))).sum()
        }
    };
    found.min(1.0)
}

/// All that the verdict reads.
pub(crate) struct Findings<'a> {
    pub(crate) analysis: &'a Analysis,
    pub(crate) library: &'a Library,
    pub(crate) distances: &'a Distances,
    pub(crate) advisor: &'a Advisor<'a>,
    pub(crate) outside: &'a Outside,
    /// Probability that a smooth term is needed, before any of it is credited to the leading effect.
    pub(crate) smooth_term: f64,
    /// Causes, the most probable first; none where there is no gap.
    pub(crate) posteriors: &'a [Posterior],
    /// Effects that are like a level in these flights.
    pub(crate) level_like: &'a [EffectId],
    /// What is found of a guide's table, where it is more probably off than not.
    pub(crate) table: Option<&'a TableFinding>,
    pub(crate) own: &'a Shrinkage,
    pub(crate) unseen: Option<&'a Shrinkage>,
}

impl<'a> Findings<'a> {
    const fn of_pairs(&self) -> PairEvidence<'a> {
        PairEvidence { analysis: self.analysis, library: self.library, distances: self.distances }
    }

    /// What causes are judged by.
    pub(crate) const fn of_causes(&self) -> CauseEvidence<'a> {
        CauseEvidence {
            analysis: self.analysis,
            outside: self.outside,
            distances: self.distances,
            library: self.library,
            unseen: self.unseen,
            table: self.table,
        }
    }
}

/// The verdict; what named effects leave goes to `notes` too.
pub(crate) fn verdict(findings: &Findings<'_>, notes: &mut Vec<Note>) -> Verdict {
    let &Findings { library, outside, smooth_term, posteriors, own, unseen, .. } = findings;
    if let Some(table) = findings.table {
        return Verdict::Effects(found_with_table(findings, table));
    }
    let Some(top) = posteriors.first() else { return Verdict::NoGap };
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let variable = outside.variable.map(|(variable, _)| variable);
    let closed = closed(unseen, own);
    if outside.probability > OUTSIDE_PROBABILITY
        || named * (1.0 - outside.probability) <= MORE_PROBABLE_THAN_NOT
        || is_rather_outside(outside, top, unseen)
    {
        return Verdict::OutsideLibrary(Unexplained {
            probability: outside.probability.max(1.0 - named),
            closure: closed_unseen(unseen),
            variable,
            nearest: id_of(library, top.effect),
            nearest_closes: closed.map(|(share, _)| share),
        });
    }
    let is_form =
        closed.is_none_or(|(share, _)| share >= f64::midpoint(OTHER_FORM[0], OTHER_FORM[1]));
    let kind = if is_form { RestKind::OtherForm } else { RestKind::SomethingElse };
    let rest = (smooth_term > OUTSIDE_PROBABILITY).then_some(Rest { kind, variable });
    notes.extend(rest.map(Note::Rest));
    let mut found = found(findings, top, rest);
    if found.effects.first().is_some_and(|id| LEVELS.contains(id)) {
        for id in findings.level_like {
            notes.push(Note::LikeALevel(*id));
            if !found.class.contains(id) {
                found.class.push(*id);
            }
            found.credible.retain(|credible| credible != id);
        }
    }
    Verdict::Effects(found)
}

/// Whether something outside the library is more probable than the leading effect, which surely leaves more than a tenth of the gap of
/// flights that it was not fitted to.
fn is_rather_outside(outside: &Outside, top: &Posterior, unseen: Option<&Shrinkage>) -> bool {
    let leaves = unseen.and_then(Shrinkage::closure).is_some_and(|(_, [_, most])| most < CLOSES);
    leaves && outside.probability > top.probability * (1.0 - outside.probability)
}

/// The gap of the leading effect where it is named and no guide's table is off, and the variables that drive it: each with the
/// probability that no effect acts which the variable drives, so that members of a class count together.
pub(crate) fn named_gap(
    findings: &Findings<'_>,
    system: &WhitenedSystem<'_>,
    verdict: &Verdict,
) -> Option<NamedGap> {
    let &Findings { library, outside, posteriors, .. } = findings;
    let named = !verdict.effects().is_empty() && !verdict.is_of_table();
    let top = posteriors.first().filter(|_| named)?;
    let (column, size) = top.column_and_size()?;
    let segments = &system.data.segments;
    let gap = segments.iter().map(|row| size * row.signatures[column][0]).collect();
    let drivers = |posterior: &Posterior| id_of(library, posterior.effect).entry().driven_by;
    let inside = 1.0 - outside.probability;
    let doubt = |driver: &DrivingVariable| {
        let driven = posteriors.iter().filter(|posterior| drivers(posterior).contains(driver));
        // A sum of many may pass one by rounding.
        (1.0 - inside * driven.map(|posterior| posterior.probability).sum::<f64>()).max(0.0)
    };
    let drivers = drivers(top).iter().map(|driver| (Variable::from(*driver), doubt(driver)));
    Some(NamedGap { gap, drivers: drivers.collect() })
}

/// What changes drag or fuel flow nearly alike everywhere.
const LEVELS: [EffectId; 5] = [
    EffectId::DragFactor,
    EffectId::ZeroLiftDrag,
    EffectId::InducedDrag,
    EffectId::TsfcFactor,
    EffectId::FuelFlowGain,
];

/// Effects that are zero at a reference and, in these flights, have nearly the same sign and size everywhere: their mean signature
/// exceeds its standard deviation.
pub(crate) fn level_like(system: &WhitenedSystem<'_>, library: &Library) -> Vec<EffectId> {
    const ZERO_AT_REFERENCE: [EffectId; 6] = [
        EffectId::ReynoldsNumber,
        EffectId::TrimDragCg,
        EffectId::AirframeAgeing,
        EffectId::EngineAgeing,
        EffectId::TsfcMachExponent,
        EffectId::TsfcTemperatureExponent,
    ];
    let segments = &system.data.segments;
    let is_like = |effect: &&Testable| {
        is_like_a_level(segments.iter().map(|row| row.signatures[effect.representative][0]))
    };
    let moving = library.effects.iter().filter(|effect| ZERO_AT_REFERENCE.contains(&effect.id));
    moving.filter(is_like).map(|effect| effect.id).collect()
}

/// Whether the mean of a signature exceeds its standard deviation over the segments.
fn is_like_a_level(signature: impl ExactSizeIterator<Item = f64> + Clone) -> bool {
    let count = signature.len() as f64;
    let mean = signature.clone().sum::<f64>() / count;
    let variance = signature.map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    mean * mean > LEVEL_LIKE * LEVEL_LIKE * variance
}

/// A guide's table that is off, and beside it what the flights show that no table can hold.
fn found_with_table(findings: &Findings<'_>, table: &TableFinding) -> Found {
    let &Findings { library, distances, outside, posteriors, .. } = findings;
    let inside = 1.0 - outside.probability;
    let held = |id: &EffectId| table.class.contains(id);
    // What a table can hold as well says nothing beside it.
    let present = presence(findings.analysis, library);
    let of = |posterior: &Posterior| present[posterior.effect.unwrap_or(library.effects.len())];
    let mut named: Vec<&Posterior> =
        posteriors.iter().filter(|p| !held(&id_of(library, p.effect))).collect();
    named.sort_by(|a, b| of(b).total_cmp(&of(a)));
    let mut beside: Vec<Beside> = Vec::new();
    let mut found = Vec::new();
    let mut tops = Vec::new();
    for top in &named {
        let effect = id_of(library, top.effect);
        if beside.iter().any(|other| other.class.contains(&effect)) {
            continue;
        }
        let class = class_of(distances, library, top);
        // What an earlier one could be is not counted again.
        let is_open = |id: &EffectId| {
            class.contains(id) && !beside.iter().any(|other| other.class.contains(id))
        };
        let open = named.iter().filter(|p| is_open(&id_of(library, p.effect)));
        let open: Vec<Option<usize>> = open.map(|p| p.effect).collect();
        let acts = presence_of_any(findings.analysis, library, &open);
        if acts * inside > MORE_PROBABLE_THAN_NOT {
            found.extend(separations(findings.advisor, library, top, &class));
            beside.push(Beside { effect, class, probability: of(top) * inside });
            tops.push(*top);
        }
    }
    let acting: Vec<(EffectId, f64)> =
        named.iter().map(|p| (id_of(library, p.effect), of(p))).collect();
    for (place, top) in tops.into_iter().enumerate() {
        let open = left_open_beside(findings, (table, top), &beside, &acting);
        beside[place].class.extend(open);
    }
    let mut effects = vec![EffectId::DragTable];
    let mut class = table.class.clone();
    for beside in &beside {
        effects.push(beside.effect);
        for id in &beside.class {
            if !class.contains(id) {
                class.push(*id);
            }
        }
    }
    Found {
        effects,
        class,
        credible: vec![],
        probability: table.probability,
        beside,
        closure: closed_unseen(findings.unseen),
        rest: None,
        separations: found,
    }
}

/// What the evidence leaves open of an effect beside a table, and no class has: what differs from it by less than laws may; and where
/// it is the only one, the most probable that hold 95 % of all that acts. `acting`: what no table can hold, the most probable first.
fn left_open_beside(
    findings: &Findings<'_>,
    (table, top): (&TableFinding, &Posterior),
    beside: &[Beside],
    acting: &[(EffectId, f64)],
) -> Vec<EffectId> {
    let &Findings { library, distances, .. } = findings;
    let is_new = |id: &EffectId| !beside.iter().any(|other| other.class.contains(id));
    let alike = top
        .column_and_size()
        .map_or_else(Vec::new, |(column, size)| distances.alike_in_form(library, column, size));
    let alike = alike.into_iter().map(|effect| library.effects[effect].id);
    let mut open: Vec<EffectId> =
        alike.filter(|id| is_new(id) && !table.class.contains(id)).collect();
    let [_] = beside else { return open };
    // What acts in addition, and not instead, makes the sum exceed 1.
    let total = acting.iter().map(|(_, acts)| acts).sum::<f64>().min(1.0);
    let known = acting.iter().filter(|(id, _)| !is_new(id) || open.contains(id));
    let mut sum: f64 = known.map(|(_, acts)| acts).sum();
    for (id, acts) in acting {
        if sum >= CREDIBLE * total {
            break;
        }
        if is_new(id) && !open.contains(id) {
            open.push(*id);
            sum += acts;
        }
    }
    open
}

/// What these flights cannot tell from a cause, and what their evidence leaves open all the same, however far away that is. What
/// acts `together` with it is what it is, and no other name of it.
fn class_and_credible(
    findings: &Findings<'_>,
    top: &Posterior,
    posteriors: &[&Posterior],
    together: &[EffectId],
) -> [Vec<EffectId>; 2] {
    let &Findings { library, distances, .. } = findings;
    let class = class_of(distances, library, top);
    // What differs from it by less than laws may, and what only the prior sizes decide, is open as well.
    let alike = top
        .column_and_size()
        .map_or_else(Vec::new, |(column, size)| distances.alike_in_form(library, column, size));
    let alike = alike.into_iter().map(|effect| library.effects[effect].id);
    let mut others: Vec<EffectId> = alike.filter(|id| !class.contains(id)).collect();
    let by_size = posteriors.iter().copied().filter(|p| p.flat * SIZE_ALONE >= top.flat);
    for posterior in credible(posteriors).chain(by_size) {
        let id = id_of(library, posterior.effect);
        let is_companion = together.contains(&id);
        if !is_companion && !class.contains(&id) && !others.contains(&id) {
            others.push(id);
        }
    }
    [class, others]
}

/// The effects that the leading cause is of, and what it could be taken for.
fn found(findings: &Findings<'_>, top: &Posterior, rest: Option<Rest>) -> Found {
    let &Findings { library, advisor, outside, posteriors, .. } = findings;
    let all: Vec<&Posterior> = posteriors.iter().collect();
    let pairs = findings.of_pairs();
    let partner = pairs.partner(top);
    let effects = set_of(&pairs, top, partner);
    let [mut class, credible] = class_and_credible(findings, top, &all, &effects);
    class.extend(&credible);
    let mut separations = separations(advisor, library, top, &class);
    let mut beside = Vec::new();
    if let Some((partner, leading)) = partner.zip(top.effect) {
        let companion = companion(&pairs, outside, &effects, (partner, leading));
        let found = (partner.column, partner.size);
        separations.extend(apart(advisor, library, found, &companion.class));
        beside.push(companion);
    }
    best_first(&mut separations);
    Found {
        effects,
        probability: (top.probability * (1.0 - outside.probability)).min(1.0),
        beside,
        closure: closed_unseen(findings.unseen),
        rest,
        separations,
        class,
        credible,
    }
}

/// The most probable causes that hold 95 % of the probability together.
fn credible<'a>(posteriors: &[&'a Posterior]) -> impl Iterator<Item = &'a Posterior> {
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let mut sum = 0.0;
    posteriors.iter().copied().take_while(move |posterior| {
        let before = sum;
        sum += posterior.probability;
        before < CREDIBLE * named
    })
}

/// The effects that act together, where a pair is more probable than not; else the top effect.
fn set_of(pairs: &PairEvidence<'_>, top: &Posterior, partner: Option<Partner>) -> Vec<EffectId> {
    let PairEvidence { analysis, library, .. } = *pairs;
    let mut set = vec![id_of(library, top.effect)];
    let (best, probability) = &analysis.models[0];
    let scatter = best.hypothesis.flight_scatter_percent;
    if *probability > MORE_PROBABLE_THAN_NOT && scatter.is_some() {
        let members = best.hypothesis.columns.iter().map(|&c| Some(library.columns[c].effect));
        for member in members.chain([None]) {
            let id = id_of(library, member);
            if !set.contains(&id) {
                set.push(id);
            }
        }
    } else if let Some(partner) = partner {
        set.push(library.effects[library.columns[partner.column].effect].id);
    }
    set
}

/// Who is asked for advice: about the leading effect of every probable cause, what acts together with it, and what could be taken
/// for either; about none where there are no causes.
pub(crate) fn advisor<'a>(
    problem: Problem<'a>,
    distances: &'a Distances,
    classes: &[Vec<usize>],
    posteriors: &[Posterior],
    analysis: &Analysis,
) -> Advisor<'a> {
    let library = problem.library;
    let top = posteriors.first();
    let mut found: Vec<usize> =
        top.and_then(Posterior::column_and_size).map(|(column, _)| column).into_iter().collect();
    let mut likely: Vec<usize> = Vec::new();
    if let Some(class) = top.and_then(|top| top.confused(distances, library)) {
        let all: Vec<&Posterior> = posteriors.iter().collect();
        likely.extend(credible(&all).filter_map(|posterior| posterior.effect));
        likely.extend(class);
    }
    let pairs = PairEvidence { analysis, library, distances };
    found.extend(top.and_then(|top| pairs.partner(top)).map(|partner| partner.column));
    Advisor::new(problem, distances, classes, &found, &likely)
}

fn separations(
    advisor: &Advisor<'_>,
    library: &Library,
    top: &Posterior,
    class: &[EffectId],
) -> Vec<Separation> {
    let Some(found) = top.column_and_size() else { return vec![] };
    let mut all = apart(advisor, library, found, class);
    best_first(&mut all);
    all
}

/// What would tell a column at a size from the others of its class.
fn apart(
    advisor: &Advisor<'_>,
    library: &Library,
    (column, size): (usize, f64),
    class: &[EffectId],
) -> Vec<Separation> {
    let own = library.columns[column].effect;
    let others = library.effects.iter().enumerate();
    let others = others.filter(|(index, effect)| *index != own && class.contains(&effect.id));
    others.flat_map(|(index, _)| advisor.between(column, size, index)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: as many values of m − 1 as of m + 1 have the mean m and the standard deviation 1, however many they are; a
    /// level may be negative.
    #[test]
    fn a_mean_beyond_one_standard_deviation_is_like_a_level() {
        for pairs in [1, 2, 50] {
            for (mean, expected) in [
                (3.0, true),
                (1.01, true),
                (0.99, false),
                (0.0, false),
                (-0.99, false),
                (-1.01, true),
            ] {
                let values = [mean - 1.0, mean + 1.0].repeat(pairs);
                assert_eq!(is_like_a_level(values.into_iter()), expected, "{pairs}: {mean}");
            }
        }
    }
}
