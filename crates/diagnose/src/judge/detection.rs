//! Whether a gap is reported, and how much of each probability other flights bear out.

use core::cell::LazyCell;

use crate::advice::distances::Distances;
use crate::judge::closure::Shrinkage;
use crate::judge::forms::leading_forms;
use crate::judge::gap::{is_large, is_vague};
use crate::judge::noise_floors::held_out_smooth;
use crate::judge::posterior::{Posterior, id_of};
use crate::judge::table::TableFinding;
use crate::judge::verdict::{beside, closed, credit};
use crate::library::Library;
use crate::output::Gap;
use crate::output::form::FoundForm;
use crate::output::verdict::Closure;
use crate::place::find::FoundPlaces;
use crate::search::analyse::{Analysis, DRAG_OF_A_TABLE};
use crate::search::outside::Outside;
use crate::search::system::Problem;
use crate::thresholds::{
    LARGEST_REST, LEAST_OF_A_FORM, LEAST_OF_A_TABLE, MORE_PROBABLE_THAN_NOT, OTHER_FORM,
    OUTSIDE_PROBABILITY, SHARE_AT_ITS_PLACE, SMALLEST_GAP_PERCENT, SURE_P_VALUE, UNPROVEN_SHARE,
};

/// What a decision is made from.
pub(crate) struct DetectionInput<'a> {
    pub(crate) analysis: &'a Analysis,
    pub(crate) distances: &'a Distances,
    /// Causes, the most probable first.
    pub(crate) posteriors: &'a [Posterior],
    pub(crate) gap: &'a Gap,
    pub(crate) own: &'a Shrinkage,
    /// How far the gap shrinks on unseen flights, where that was measured.
    pub(crate) unseen: Option<&'a Shrinkage>,
    /// Noise variance over what the sensors announce.
    pub(crate) noise_scale: f64,
    /// Whether no effect at all is improbable, or the size exceeds noise and uncertainty; the latter alone.
    pub(crate) is_real: bool,
    pub(crate) exceeds_uncertainty: bool,
    /// Where the gap lies, beyond what the model does not know and what a search finds by chance.
    pub(crate) places: Option<&'a FoundPlaces>,
}

/// What was decided.
pub(crate) struct Detection {
    pub(crate) detected: bool,
    /// A guide's table, where it is more probably off than not.
    pub(crate) table: Option<TableFinding>,
    /// Probability that a smooth term is needed, before any of it is credited to the leading effect.
    pub(crate) smooth_term: f64,
    /// Forms that describe a gap without a name, best first, where they were asked.
    pub(crate) forms: Option<Vec<FoundForm>>,
}

/// Decides. The probability of a cause outside takes what names lose.
pub(crate) fn detect(
    problem: Problem<'_>,
    input: &DetectionInput<'_>,
    outside: &mut Outside,
) -> Detection {
    let Problem { system, library, .. } = problem;
    let DetectionInput { distances, posteriors, gap, own, unseen, .. } = *input;
    let lies_at_an_engine = input.places.is_some_and(FoundPlaces::name_an_engine);
    let has_a_place = input.places.is_some_and(FoundPlaces::refute_scatter);
    let is_probable = |table: &TableFinding| table.probability > MORE_PROBABLE_THAN_NOT;
    let found = TableFinding::fit(system, input.analysis, library).filter(is_probable);
    let was_found = found.is_some();
    let table = found.map(|table| borne_out(table, unseen)).filter(is_probable);
    // What is named beside a table that other flights do not bear out was told from the wrong remainder.
    let refuted_table = was_found && table.is_none();
    let smooth_term = outside.probability;
    let top = posteriors.first();
    let is_scatter = top.is_some_and(|top| top.effect.is_none());
    outside.probability *= 1.0
        - credit(
            beside(outside, distances, library, top),
            closed(unseen, own).filter(|_| !is_scatter),
        );
    let judged = unseen.unwrap_or(own);
    let leaves_most = judged.after() > LARGEST_REST * judged.floor() / input.noise_scale
        && !closes_more_than(OTHER_FORM[0], unseen);
    let nothing_predicted = LazyCell::new(|| smooth_predicts_nothing(problem, own));
    // What smooth functions that were fitted to other flights predict does not differ from flight to flight by chance.
    // Nor is it scatter that has a place.
    let no_scatter = is_scatter && table.is_none() && (has_a_place || !*nothing_predicted);
    // A scatter closes nothing, but what is named with it must not make unseen flights worse.
    let is_refuted = leaves_most || no_scatter || surely_makes_worse(unseen);
    let is_doubted = refuted_table || may_close_nothing(unseen.filter(|_| !is_scatter));
    let leads = top
        .is_some_and(|top| top.probability * (1.0 - outside.probability) > MORE_PROBABLE_THAN_NOT);
    if table.is_none() {
        let keeps = kept_by_name(library, input, is_refuted, is_doubted);
        outside.probability = 1.0 - keeps * (1.0 - outside.probability);
    }
    // Where no name holds more than half and neither size nor p-value shows a gap, nothing is said to be there.
    let is_sure = gap.p_value < SURE_P_VALUE;
    let named: f64 = posteriors.iter().map(|p| p.probability).sum();
    let something = input.exceeds_uncertainty
        || is_sure
        || refuted_table
        || no_scatter
        || smooth_term > OUTSIDE_PROBABILITY
        || named * (1.0 - outside.probability) > MORE_PROBABLE_THAN_NOT;
    let taught = system.data.predictor.baseline.is_some();
    let is_surely_real = input.exceeds_uncertainty || lies_at_an_engine || is_sure;
    let own_error = taught && !is_surely_real && is_own_error(library, input, outside);
    let is_outside = is_unnamed(outside, named);
    let leading =
        || leading_forms(problem, input.analysis, outside, (input.noise_scale, own.seed()));
    let mut forms = None;
    // What no name explains is as large as the form that describes it.
    let is_seen = something
        && !own_error
        && (is_large(system, gap, top)
            || is_outside && is_large_form(forms.get_or_insert_with(leading)));
    let is_told = is_sure || is_scatter && has_a_place;
    let stands_out =
        is_seen && (is_told || !is_vague(gap, outside, top, taught && makes_worse(unseen)));
    // Whether anything that was fitted to other flights surely predicts a flight better than no gap at all does
    // [diagnosis.53]: what errs anew on every flight is no property of the aircraft. A bump between two knots is no sum of smooth
    // functions, and may be all of a large gap: the form that describes it is asked then. What is surely no noise, and has a name that
    // other channels than fuel flow bear out, is told anyhow.
    let has_no_witness = stands_out
        && taught
        && !(is_sure && leads)
        && !(lies_at_an_engine || has_a_place)
        && is_outside
        && *nothing_predicted;
    let is_borne_out = !has_no_witness || {
        let best = forms.get_or_insert_with(leading).first();
        bears_out(best.and_then(|best| best.closure))
    };
    let detected = input.is_real && (table.is_some() || (stands_out && is_borne_out));
    Detection { detected, table: table.filter(|_| detected), smooth_term, forms }
}

/// Share of its probability that a name keeps which other flights refute, or leave in doubt.
fn kept_by_name(
    library: &Library,
    input: &DetectionInput<'_>,
    is_refuted: bool,
    is_doubted: bool,
) -> f64 {
    let id = input.posteriors.first().map(|top| id_of(library, top.effect));
    let is_at_its_place =
        id.is_some_and(|id| input.places.is_some_and(|places| places.lead_to(id)));
    match (is_refuted, is_doubted) {
        (false, false) => 1.0,
        (false, true) if is_at_its_place => SHARE_AT_ITS_PLACE,
        _ => UNPROVEN_SHARE,
    }
}

/// Whether a gap is what a taught model announces of its own errors: no name shrinks it on unseen flights, and none is more probable
/// than not that is not what a table in error could look like.
fn is_own_error(library: &Library, input: &DetectionInput<'_>, outside: &Outside) -> bool {
    let top = input.posteriors.first();
    let beyond_table = top.filter(|top| !DRAG_OF_A_TABLE.contains(&id_of(library, top.effect)));
    let is_named = beyond_table
        .is_some_and(|top| top.probability * (1.0 - outside.probability) > MORE_PROBABLE_THAN_NOT);
    !is_named && !closes_more_than(0.0, input.unseen)
}

/// Whether no name would be reported.
fn is_unnamed(outside: &Outside, named: f64) -> bool {
    outside.probability > OUTSIDE_PROBABILITY
        || named * (1.0 - outside.probability) <= MORE_PROBABLE_THAN_NOT
}

/// Whether smooth functions that were fitted to other flights do not surely predict a flight better than no gap at all does.
fn smooth_predicts_nothing(problem: Problem<'_>, own: &Shrinkage) -> bool {
    held_out_smooth(problem.system)
        .is_some_and(|fitted| !own.with_change(problem.system, &fitted).closes())
}

/// Whether the form that describes a gap best explains enough to be a gap at all.
fn is_large_form(forms: &[FoundForm]) -> bool {
    forms.first().is_some_and(|best| best.rms_percent >= SMALLEST_GAP_PERCENT)
}

/// Whether a form surely closes more than half of the gap on flights that its parameters have not seen.
fn bears_out(closure: Option<Closure>) -> bool {
    closure.is_some_and(|closure| closure.is_surely_more_than(LEAST_OF_A_FORM))
}

/// A guide's table with less probability where a table that was fitted to other flights may close less than half of the gap:
/// drag over lift coefficient and Mach number is then not what is wrong.
fn borne_out(table: TableFinding, unseen: Option<&Shrinkage>) -> TableFinding {
    let closed = unseen.and_then(Shrinkage::closure);
    if closed.is_some_and(|(_, [least, _])| least < LEAST_OF_A_TABLE) {
        return TableFinding { probability: UNPROVEN_SHARE * table.probability, ..table };
    }
    table
}

/// Whether the closure of a name on flights that it was not fitted to may be none.
fn may_close_nothing(unseen: Option<&Shrinkage>) -> bool {
    unseen.and_then(Shrinkage::closure).is_some_and(|(_, [least, _])| least <= 0.0)
}

/// Whether the named effects certainly make other flights worse.
fn surely_makes_worse(unseen: Option<&Shrinkage>) -> bool {
    unseen.and_then(Shrinkage::closure).is_some_and(|(_, [_, most])| most < 0.0)
}

/// Whether a name certainly shrinks the gap by more than this share on flights that it was not fitted to. What a large effect
/// of another form leaves is many standard deviations of noise.
fn closes_more_than(share: f64, unseen: Option<&Shrinkage>) -> bool {
    unseen.and_then(Shrinkage::closure).is_some_and(|(_, [least, _])| least > share)
}

/// Whether the named effects make other flights worse. What a learnt remainder leaves need not be noise, but a name that does
/// this is wrong.
fn makes_worse(unseen: Option<&Shrinkage>) -> bool {
    unseen.and_then(Shrinkage::closure).is_some_and(|(closure, _)| closure < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// More than half for sure, or nothing is said to be there: the lower end of the interval decides, not the closure.
    #[test]
    fn a_form_has_to_close_more_than_half_for_sure() {
        let closure = |share: f64, low: f64| Some(Closure { share, ci95: [low, 1.1] });
        assert!(bears_out(closure(0.9, 0.51)));
        assert!(!bears_out(closure(0.9, 0.5)));
        assert!(!bears_out(closure(0.65, 0.2)));
        assert!(!bears_out(None));
    }
}
