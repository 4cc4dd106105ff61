//! What is said of effects that explain a gap.

use diagnose::{Closure, Diagnosis, Found, Magnitude};
use flight::effect::EffectId;

use super::digits;
use crate::diagnosis_words::{
    LEAST_TOLD, NO_CAUSE_STANDS_OUT, NOT_RULED_OUT, OTHERS_TOLD, SEPARATIONS_TOLD, TOLD_APART,
    are_few, capital, distances_words, follows, is_open, joined, measurement_words, near_and_far,
    others_beside, others_of_class, phrase, told_size, variable_words,
};

/// A guide whose drag is off, and what acts in addition.
fn table_off(diagnosis: &Diagnosis, found: &Found) -> Vec<String> {
    let mut lines = vec![
        format!(
            "Cause: {}, probability {:.2}.",
            effect_told(diagnosis, EffectId::DragTable),
            found.probability
        ),
        "Adapt first (cruisefit adapt): a table learns this from flights. Then diagnose flights that it has not learnt."
            .to_owned(),
        closes(diagnosis, found),
    ];
    let of_beside = |id: &EffectId| found.beside.iter().any(|beside| beside.class.contains(id));
    let held: Vec<EffectId> = found
        .class
        .iter()
        .copied()
        .filter(|id| *id != EffectId::DragTable && !of_beside(id))
        .collect();
    if !held.is_empty() {
        lines.push(format!(
            "Against a guide nothing distinguishes it from: {}.",
            joined(&held, ", ")
        ));
    }
    for beside in &found.beside {
        lines.push(format!(
            "In addition, and no table can hold it: {}, probability {:.2}.",
            effect_told(diagnosis, beside.effect),
            beside.probability
        ));
        let others: Vec<EffectId> =
            beside.class.iter().copied().filter(|id| *id != beside.effect).collect();
        if !others.is_empty() {
            lines.push(format!(
                "These flights cannot distinguish it from: {}.",
                joined(&others, ", ")
            ));
        }
    }
    lines.extend(to_be_sure(found));
    lines
}

/// Effects that explain the gap.
pub(super) fn named(diagnosis: &Diagnosis, found: &Found) -> Vec<String> {
    if diagnosis.verdict.is_of_table() {
        return table_off(diagnosis, found);
    }
    let open = is_open(&diagnosis.verdict);
    let others = others_of_class(found);
    let few = are_few(&others);
    let mut lines = Vec::new();
    for (place, id) in found.effects.iter().enumerate() {
        let what = effect_told(diagnosis, *id);
        lines.push(if place == 0 && open {
            format!(
                "{}. The most probable is {what}, probability {:.2}: do not act on it.",
                capital(NO_CAUSE_STANDS_OUT),
                found.probability
            )
        } else if place == 0 && few {
            format!(
                "Cause: one of {}, {}: {what}, probability {:.2}; or {}.",
                others.len() + 1,
                if found.credible.is_empty() {
                    "which these flights cannot tell apart"
                } else {
                    "between which these flights do not decide"
                },
                found.probability,
                others
                    .iter()
                    .map(|id| with_probability(diagnosis, *id))
                    .collect::<Vec<_>>()
                    .join(", ")
            )
        } else if place == 0 {
            format!("Cause: {what}, probability {:.2}.", found.probability)
        } else {
            let others = others_beside(found, *id);
            if others.is_empty() {
                format!("Together with: {what}.")
            } else {
                format!(
                    "Together with: {what}; or {}, which these flights cannot tell from it.",
                    joined(&others, ", ")
                )
            }
        });
    }
    if !open {
        lines.extend(follows(found));
    }
    lines.push(closes(diagnosis, found));
    if open || !few {
        let [near, far] = near_and_far(found);
        if !near.is_empty() {
            lines.push(format!("These flights cannot tell it from: {}.", joined(&near, ", ")));
        }
        if !far.is_empty() {
            lines.push(format!("{NOT_RULED_OUT}: {}.", joined(&far, ", ")));
        }
    }
    lines.extend(to_be_sure(found));
    let told = if few && !open { &others[..] } else { &[] };
    lines.extend(rivals(diagnosis, found, told));
    lines
}

/// "`tsfc_engine_2` 0.09", without the backticks; where it is not worth a number the name alone.
fn with_probability(diagnosis: &Diagnosis, id: EffectId) -> String {
    let cause = diagnosis.causes.iter().find(|cause| cause.effect == id);
    match cause.filter(|cause| cause.probability >= LEAST_TOLD) {
        Some(cause) => format!("{id} {:.2}", cause.probability),
        None => id.to_string(),
    }
}

/// How far the gap shrinks.
fn closes(diagnosis: &Diagnosis, found: &Found) -> String {
    if found.effects == [EffectId::FuelHeatingValue] {
        return "It is another on every flight: added to the model it makes no prediction better, only the stated interval wider."
            .to_owned();
    }
    // That of what is named alone: another cause may be of the most probable set, and the one that was judged.
    let own = diagnosis.causes.iter().find(|cause| Some(&cause.effect) == found.effects.first());
    let after = own.and_then(|cause| cause.rms_after_percent);
    match (after, found.closure) {
        (Some(after), Some(Closure { share, ci95: [low, high] })) => format!(
            "Added to the model it leaves {after:.2} % on flights that it was not fitted to: {:.0} % of what can be \
             explained ({:.0} to {:.0}{}).",
            100.0 * share,
            100.0 * low,
            100.0 * high,
            above_all(share)
        ),
        (None, Some(Closure { share, ci95: [low, high] })) => format!(
            "Chosen anew on four fifths of the flights, it closes {:.0} % of what can be explained on the rest ({:.0} to \
             {:.0}{}).",
            100.0 * share,
            100.0 * low,
            100.0 * high,
            above_all(share)
        ),
        (_, None) => "The gap is too small to measure how far it shrinks.".to_owned(),
    }
}

/// Why more than all of what can be explained may close.
fn above_all(share: f64) -> &'static str {
    if share >= 1.005 { "; above 100: less is left than the noise as stated" } else { "" }
}

/// The best measurements or flights. One often separates from several effects: it is printed once, where it separates most.
fn to_be_sure(found: &Found) -> Vec<String> {
    let mut told: Vec<String> = Vec::new();
    let mut lines = Vec::new();
    for separation in &found.separations {
        let measurement = measurement_words(&separation.measurement);
        if told.len() == SEPARATIONS_TOLD {
            break;
        }
        let is_weak = separation.distance_then < TOLD_APART && !told.is_empty();
        if told.contains(&measurement) || is_weak {
            continue;
        }
        lines.push(format!("To be sure: {measurement} ({}).", distances_words(separation)));
        told.push(measurement);
    }
    lines
}

/// Other causes that the data leave open, besides those that were told.
fn rivals(diagnosis: &Diagnosis, found: &Found, told_before: &[EffectId]) -> Vec<String> {
    let mut told: Vec<String> = diagnosis
        .causes
        .iter()
        .filter(|cause| !found.effects.contains(&cause.effect) && cause.probability >= LEAST_TOLD)
        .filter(|cause| !told_before.contains(&cause.effect))
        .take(OTHERS_TOLD)
        .map(|cause| format!("{} {:.2}", cause.effect, cause.probability))
        .collect();
    if diagnosis.outside.probability >= LEAST_TOLD {
        let variable = diagnosis.outside.variable.map(variable_words);
        let hangs =
            variable.map_or_else(String::new, |variable| format!(" that depends on {variable}"));
        told.push(format!(
            "something outside the library{hangs} {:.2}",
            diagnosis.outside.probability
        ));
    }
    if told.is_empty() {
        vec![]
    } else {
        vec![format!("Other probabilities: {}.", told.join(", "))]
    }
}

/// "earlier drag rise with Mach number, `wave_drag` +0.0080 Mach (0.0060 to 0.0100)", without the backticks; the interval is of 95 %.
fn effect_told(diagnosis: &Diagnosis, id: EffectId) -> String {
    let Some(Magnitude { value, ci95: [low, high] }) = told_size(diagnosis, id) else {
        return id.to_string();
    };
    let cause = diagnosis.causes.iter().find(|cause| cause.effect == id);
    let hidden = cause.map_or_else(String::new, |cause| cause.hidden.to_string());
    format!(
        "{}, {id} {} {} ({} to {}){}",
        phrase(diagnosis, id, value),
        figure(value),
        id.unit_words(),
        figure(low),
        figure(high),
        if hidden.is_empty() { String::new() } else { format!(", {hidden}") }
    )
}

/// With its sign, and three digits.
pub(super) fn figure(value: f64) -> String {
    format!("{}{}", if value < 0.0 { "−" } else { "+" }, digits(value.abs()))
}
