//! What is said in the end: a name, its class, advice; or that nothing in the library fits.

use core::fmt::Write as _;

use crate::advice::advisor::{Advisor, best_first};
use crate::advice::distances::Distances;
use crate::judge::closure::Shrinkage;
use crate::judge::posterior::{Posterior, class_of, name_of};
use crate::library::Library;
use crate::output::{Separation, Verdict, VerdictKind};
use crate::search::analyse::Analysis;
use crate::search::outside::{Companion, Outside};
use crate::search::system::Problem;
use crate::thresholds::{CREDIBLE, MORE_PROBABLE_THAN_NOT, OTHER_FORM, OUTSIDE_PROBABILITY};

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
    pub(crate) own: &'a Shrinkage,
    pub(crate) unseen: Option<&'a Shrinkage>,
}

/// The verdict; what else it would say goes to `notes`.
pub(crate) fn verdict(findings: &Findings<'_>, notes: &mut Vec<String>) -> Verdict {
    let &Findings { analysis, library, distances, advisor, outside, smooth_term, .. } = findings;
    let &Findings { posteriors, own, unseen, .. } = findings;
    let closure = unseen.and_then(Shrinkage::closure);
    let mut verdict = Verdict {
        kind: VerdictKind::NoGap,
        effects: vec![],
        class: vec![],
        probability: 0.0,
        closure: closure.map(|c| c.0),
        closure_ci95: closure.map(|c| c.1),
        advice: String::new(),
        separations: vec![],
    };
    let Some(top) = posteriors.first() else {
        verdict.closure = None;
        verdict.closure_ci95 = None;
        "Nothing beyond the noise. `detectable` says how large each effect would have to be."
            .clone_into(&mut verdict.advice);
        return verdict;
    };
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let variable = outside.variable.map_or("no variable", |(variable, _)| variable.words());
    let closed = closed(unseen, own);
    if outside.probability > OUTSIDE_PROBABILITY
        || (smooth_term > OUTSIDE_PROBABILITY && named < MORE_PROBABLE_THAN_NOT)
    {
        verdict.kind = VerdictKind::OutsideLibrary;
        verdict.probability = outside.probability.max(1.0 - named);
        verdict.advice =
            format!("A gap that no effect of the library explains; it hangs on {variable}.");
        if let Some((closed, _)) = closed {
            let _ = write!(
                verdict.advice,
                " The nearest, {}, closes {:.0} % of it.",
                name_of(library, top.effect),
                100.0 * closed.clamp(0.0, 1.0)
            );
        }
        return verdict;
    }
    verdict.kind = VerdictKind::Effects;
    verdict.probability = top.probability * (1.0 - outside.probability);
    verdict.effects = set_of(analysis, library, top);
    verdict.class = class_of(distances, library, top);
    // What the evidence leaves open belongs to the class too, however far apart sizes typical of it would be.
    for posterior in credible(posteriors) {
        let name = name_of(library, posterior.effect);
        if !verdict.class.contains(&name) {
            verdict.class.push(name);
        }
    }
    verdict.separations = separations(advisor, library, top, &verdict.class);
    let rest = (smooth_term > OUTSIDE_PROBABILITY).then(|| Rest {
        variable,
        is_form: closed
            .is_none_or(|(share, _)| share >= f64::midpoint(OTHER_FORM[0], OTHER_FORM[1])),
    });
    if let Some(rest) = &rest {
        notes.push(rest.words());
    }
    verdict.advice = advice(&verdict, rest.as_ref());
    verdict
}

/// What an agnostic function sees beside a named effect.
struct Rest {
    variable: &'static str,
    /// The effect itself in another form; else something else.
    is_form: bool,
}

impl Rest {
    fn words(&self) -> String {
        if self.is_form {
            format!("the form of the effect differs in {}", self.variable)
        } else {
            format!("something else acts beside the effect; it hangs on {}", self.variable)
        }
    }
}

/// The most probable causes that hold 95 % of the probability together.
fn credible(posteriors: &[Posterior]) -> impl Iterator<Item = &Posterior> {
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let mut sum = 0.0;
    posteriors.iter().take_while(move |posterior| {
        let before = sum;
        sum += posterior.probability;
        before < CREDIBLE * named
    })
}

/// The effects that act together, where a pair is more probable than not; else the top effect.
fn set_of(analysis: &Analysis, library: &Library, top: &Posterior) -> Vec<String> {
    let (best, probability) = &analysis.models[0];
    let mut names = vec![name_of(library, top.effect)];
    if *probability > MORE_PROBABLE_THAN_NOT {
        let members = best.model.columns.iter().map(|&c| Some(library.columns[c].effect));
        let scatter = best.model.flight_scatter_percent.map(|_| None);
        for member in members.chain(scatter) {
            let name = name_of(library, member);
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names
}

/// Who is asked for advice: about the leading effect of every probable cause, and what could be taken for it.
pub(crate) fn advisor<'a>(
    problem: Problem<'a>,
    distances: &'a Distances,
    classes: &[Vec<usize>],
    posteriors: &[Posterior],
    detected: bool,
) -> Advisor<'a> {
    let library = problem.library;
    let top = posteriors.first().filter(|_| detected);
    let found: Vec<usize> =
        top.and_then(Posterior::column_and_size).map(|(column, _)| column).into_iter().collect();
    let mut likely: Vec<usize> = Vec::new();
    if let Some(class) = top.and_then(|top| top.confused(distances, library)) {
        likely.extend(credible(posteriors).filter_map(|posterior| posterior.effect));
        likely.extend(class);
    }
    Advisor::new(problem, distances, classes, &found, &likely)
}

fn separations(
    advisor: &Advisor<'_>,
    library: &Library,
    top: &Posterior,
    class: &[String],
) -> Vec<Separation> {
    let Some((column, size)) = top.column_and_size() else { return vec![] };
    let mut all = Vec::new();
    for (index, effect) in library.effects.iter().enumerate() {
        if Some(index) != top.effect && class.contains(&effect.id.to_string()) {
            all.extend(advisor.between(column, size, index));
        }
    }
    best_first(&mut all);
    all
}

fn advice(verdict: &Verdict, rest: Option<&Rest>) -> String {
    let mut words = if verdict.class.len() > 1 {
        format!("One of {}: these flights cannot tell them apart.", verdict.class.join(", "))
    } else {
        format!("{}.", verdict.effects.join(" and "))
    };
    match rest {
        Some(Rest { variable, is_form: true }) => {
            let _ = write!(words, " Its form differs from the library's in {variable}.");
        }
        Some(Rest { variable, is_form: false }) => {
            let _ = write!(words, " Something else acts beside it, which hangs on {variable}.");
        }
        None => {}
    }
    if let Some(best) = verdict.separations.first() {
        let _ = write!(words, " To be sure: {} ({}).", best.measurement, best.distances_told());
    }
    words
}
