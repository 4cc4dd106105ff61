//! A diagnosis in plain words: the same dozen lines on the terminal and at the top of the page.
//!
//! Limits are stated where they hold: what cannot be distinguished, what was not testable, how much is left. An effect is named
//! by what it does *and* by its id, so that a reader without the library's table knows what is meant.

use diagnose::{Closure, Diagnosis, Found, Magnitude, Verdict};
use flight::effect::{EffectGroup, EffectId};

use crate::diagnosed_tail::{Compared, DiagnosedTail};
use crate::diagnosis_months::MonthGap;
use crate::diagnosis_words::{
    NOT_RULED_OUT, acts_on_words, advice, are_few, distances_words, form_words, joined,
    left_out_words, measurement_words, near_and_far, no_effect_words, others_of_class,
    region_words, silent_words, told_size, variable_words,
};
use crate::summary::{counted, not_minus_zero};

/// Effects whose smallest visible size is printed where nothing was found: one of each kind that a person would think of.
const TOLD_WHEN_SILENT: [EffectId; 6] = [
    EffectId::DragFactor,
    EffectId::ZeroLiftDrag,
    EffectId::WaveDrag,
    EffectId::FuelFlowGain,
    EffectId::ZeroFuelMassBias,
    EffectId::MachBias,
];
/// Number of causes other than the verdict's that are printed, and their least probability. Our choice: a dozen lines in all.
const OTHERS_TOLD: usize = 3;
const LEAST_TOLD: f64 = 0.02;
/// Measurements or flights that are printed. Our choice: the best two.
const SEPARATIONS_TOLD: usize = 2;
/// Distance, in standard deviations, that the second of them brings about at least. Our choice: below it two effects are of one class.
const TOLD_APART: f64 = 3.0;
/// Probability below which no cause is printed as one. Our choice: more probable than not.
const PROBABLE: f64 = 0.5;

/// What follows from an effect of this group for predictions.
const fn consequence(group: EffectGroup) -> &'static str {
    match group {
        EffectGroup::Airframe => "It belongs to the airframe: predictions change with it.",
        EffectGroup::Engine => {
            "It belongs to the engines: predictions change with it, the drag table does not."
        }
        EffectGroup::Mass => {
            "It is an error of the load sheet or the fuel count: recordings are corrected, predictions stay."
        }
        EffectGroup::Sensor => {
            "It is an error of the recording: recordings are corrected, predictions stay."
        }
        EffectGroup::Environment => {
            "It belongs to the air and the Earth: predictions change with it."
        }
        EffectGroup::Event => "Ask what was done to the aircraft on that date.",
    }
}

/// The diagnosis in about a dozen lines, each a sentence or two; the tail's name is the first one's.
pub fn lines(diagnosed: &DiagnosedTail) -> Vec<String> {
    let diagnosis = &diagnosed.diagnosis;
    let mut lines = vec![format!(
        "{}: {}{}, {}; {}.",
        diagnosed.name(),
        counted(diagnosis.flights, "flight"),
        period(&diagnosed.compared),
        counted(diagnosis.segments, "segment"),
        against(&diagnosed.compared),
    )];
    lines.extend(left_out(diagnosis));
    let found = match &diagnosis.verdict {
        Verdict::InsufficientData(_) => {
            let advice = advice(diagnosis);
            lines.push(format!("No verdict, insufficient data. {advice}"));
            return lines;
        }
        Verdict::NoGap => silent(diagnosis),
        Verdict::Effects(found) => named(diagnosis, found),
        Verdict::OutsideLibrary(_) => unnamed(diagnosis),
    };
    lines.push(gap(diagnosis));
    if diagnosis.gap.detected {
        lines.extend(newest_month(&diagnosed.months));
    }
    lines.extend(places(diagnosis));
    lines.extend(found);
    if !diagnosis.not_testable.is_empty() {
        let names: Vec<String> = diagnosis
            .not_testable
            .iter()
            .map(|entry| {
                let needs: Vec<&str> = entry.needs.iter().map(|needed| needed.name()).collect();
                format!("{} (needs {})", entry.effect, needs.join(", "))
            })
            .collect();
        lines.push(format!("Not testable with this data: {}.", names.join("; ")));
    }
    lines
}

/// "Left out: 94 segments outside the drag table."
fn left_out(diagnosis: &Diagnosis) -> Option<String> {
    let told: Vec<String> = diagnosis
        .left_out
        .iter()
        .map(|(reason, count)| {
            format!("{} {}", counted(*count, "segment"), left_out_words(*reason))
        })
        .collect();
    (!told.is_empty()).then(|| format!("Left out: {}.", told.join(", ")))
}

/// ", 2019-09-01 to 2020-08-30", the days of the first and the last flight.
fn period(compared: &Compared) -> String {
    let day = |start: &Option<String>| start.as_ref().map(|start| start.chars().take(10).collect());
    let days: (Option<String>, Option<String>) =
        (day(&compared.first_flight), day(&compared.last_flight));
    match days {
        (Some(first), Some(last)) if first != last => format!(" from {first} to {last}"),
        (Some(first), _) => format!(" of {first}"),
        _ => String::new(),
    }
}

fn against(compared: &Compared) -> String {
    match &compared.law {
        Some(law) => format!(
            "model {}, {law}, {} learnt",
            compared.aircraft,
            counted(compared.flights_learnt, "flight")
        ),
        None => format!("model {}, which has learnt nothing", compared.aircraft),
    }
}

fn gap(diagnosis: &Diagnosis) -> String {
    let gap = &diagnosis.gap;
    format!(
        "Gap {:+.2} % of fuel flow in the mean, {:.2} % rms (95 % interval {:.2} to {:.2}); noise alone makes {:.2} %.",
        not_minus_zero(gap.mean_percent, 2),
        gap.rms_percent,
        gap.rms_ci95[0],
        gap.rms_ci95[1],
        gap.noise_floor_rms_percent
    )
}

/// The newest month apart, where there are others: whether the gap is still there, and what is named still holds.
fn newest_month(months: &[MonthGap]) -> Option<String> {
    let newest = months.last().filter(|_| months.len() > 1)?;
    let told = |mean: f64, ci95: Option<[f64; 2]>| {
        let mean = format!("{:+.2} %", not_minus_zero(mean, 2));
        match ci95 {
            Some([low, high]) => format!(
                "{mean} ({:+.2} to {:+.2})",
                not_minus_zero(low, 2),
                not_minus_zero(high, 2)
            ),
            None => mean,
        }
    };
    let after = newest.after_percent.map_or_else(String::new, |after| {
        format!("; {} with what is named in the model", told(after, newest.after_ci95))
    });
    Some(format!(
        "In the newest month, {} with {}, the mean gap is {}{after}.",
        newest.month,
        counted(newest.flights, "flight"),
        told(newest.mean_gap_percent, newest.ci95),
    ))
}

fn places(diagnosis: &Diagnosis) -> Vec<String> {
    diagnosis
        .r#where
        .iter()
        .enumerate()
        .map(|(rank, place)| {
            if place.region.is_everywhere() {
                let alone = diagnosis.r#where.len() == 1;
                let words = if alone {
                    "It has no place: it is everywhere."
                } else {
                    "It is everywhere, but not alike."
                };
                return words.to_owned();
            }
            format!(
                "{} at {}: {:+.2} % there ({:+.2} to {:+.2}), {} of the explainable gap, p {:.3}.",
                if rank == 0 { "It lies" } else { "And" },
                region_words(&place.region),
                not_minus_zero(place.mean_gap_percent, 2),
                not_minus_zero(place.ci95[0], 2),
                not_minus_zero(place.ci95[1], 2),
                if place.share_of_gap > 1.0 {
                    "more than all".to_owned()
                } else {
                    format!("{:.0} %", 100.0 * place.share_of_gap)
                },
                place.p_value
            )
        })
        .collect()
}

fn silent(diagnosis: &Diagnosis) -> Vec<String> {
    let told: Vec<String> = TOLD_WHEN_SILENT
        .iter()
        .filter_map(|id| {
            let entry = diagnosis.detectable.iter().find(|entry| entry.effect == *id)?;
            Some(format!("{id} {} {}", digits(entry.smallest?), id.unit_words()))
        })
        .collect();
    let mut lines = vec![silent_words(diagnosis).to_owned()];
    if !told.is_empty() {
        lines.push(format!("What would just have been seen: {}.", told.join(", ")));
    }
    lines
}

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

fn named(diagnosis: &Diagnosis, found: &Found) -> Vec<String> {
    if diagnosis.verdict.is_of_table() {
        return table_off(diagnosis, found);
    }
    let open = found.probability < PROBABLE;
    let others = others_of_class(found);
    let few = are_few(&others);
    let mut lines = Vec::new();
    for (place, id) in found.effects.iter().enumerate() {
        let what = effect_told(diagnosis, *id);
        lines.push(if place == 0 && open {
            format!(
                "No cause stands out. The most probable is {what}, probability {:.2}: do not act on it.",
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
                others.iter().map(|id| with_probability(diagnosis, *id)).collect::<Vec<_>>().join(", ")
            )
        } else if place == 0 {
            format!("Cause: {what}, probability {:.2}.", found.probability)
        } else {
            format!("Together with: {what}.")
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
    let after = diagnosis.causes.iter().find_map(|cause| cause.rms_after_percent);
    match (after, found.closure) {
        (Some(after), Some(Closure { share, ci95: [low, high] })) => format!(
            "Added to the model it leaves {after:.2} % on flights that it was not fitted to: {:.0} % of what can be \
             explained ({:.0} to {:.0}).",
            100.0 * share,
            100.0 * low,
            100.0 * high
        ),
        (None, Some(Closure { share, ci95: [low, high] })) => format!(
            "Chosen anew on four fifths of the flights, it closes {:.0} % of what can be explained on the rest ({:.0} to \
             {:.0}).",
            100.0 * share,
            100.0 * low,
            100.0 * high
        ),
        (_, None) => "The gap is too small to measure how far it shrinks.".to_owned(),
    }
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

fn unnamed(diagnosis: &Diagnosis) -> Vec<String> {
    let outside = &diagnosis.outside;
    let told = |words: &str, what: Option<&str>| {
        what.map_or_else(String::new, |what| format!("{words}{what}"))
    };
    let mut lines = vec![format!(
        "{}{}{} (probability {:.2}).",
        no_effect_words(outside.probability),
        told("; it depends on ", outside.variable.map(variable_words)),
        told(" and acts on ", outside.acts_on.map(acts_on_words)),
        outside.probability
    )];
    if let Some(cause) = diagnosis.causes.first() {
        lines.push(format!(
            "The nearest is {} ({}); do not act on it.",
            cause.effect,
            cause.closure.map_or_else(
                || "how much it closes could not be measured".to_owned(),
                |closure| {
                    format!(
                        "it closes {:.0} % on unseen flights",
                        not_minus_zero(100.0 * closure.share, 0)
                    )
                }
            )
        ));
    }
    lines.extend(made_up_of(diagnosis));
    for (found, words) in outside.forms.iter().zip(["Described best by", "Next best"]) {
        lines.push(format!("{words} {}.", form_words(found)));
    }
    lines.push("Nothing is applied. Look at what these flights have in common there, or record more signals.".to_owned());
    lines
}

/// What makes up a gap that no one or two effects carry, all of them at once; `None` where none may well make the most of it.
fn made_up_of(diagnosis: &Diagnosis) -> Option<String> {
    let told: Vec<String> = diagnosis
        .contributions
        .iter()
        .filter(|one| one.leads >= LEAST_TOLD)
        .take(OTHERS_TOLD)
        .map(|one| {
            let [low, high] = one.rms_ci95;
            format!("{} {:.2} % rms ({low:.2} to {high:.2})", one.effect, one.rms_percent)
        })
        .collect();
    let several = "If every effect of the library acted a little, the most would be made by";
    (!told.is_empty()).then(|| format!("{several} {}.", told.join(", ")))
}

/// What follows from the verdict; not before it is clear whether the recording errs or the aircraft.
fn follows(found: &Found) -> Option<String> {
    let first = found.effects.first()?;
    let mut ids = found.effects.iter().chain(&found.class);
    if ids.all(|id| id.is_of_recordings() == first.is_of_recordings()) {
        return Some(consequence(first.entry().group).to_owned());
    }
    Some(
        "Errors of the recording and changes of the aircraft are both possible: only the latter change predictions. Find \
         out which before you apply one."
            .to_owned(),
    )
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
        id.phrase(value),
        figure(value),
        id.unit_words(),
        figure(low),
        figure(high),
        if hidden.is_empty() { String::new() } else { format!(", {hidden}") }
    )
}

/// With its sign, and three digits.
fn figure(value: f64) -> String {
    format!("{}{}", if value < 0.0 { "−" } else { "+" }, digits(value.abs()))
}

/// Three digits, as a person writes them.
fn digits(size: f64) -> String {
    if size >= 100.0 {
        format!("{size:.0}")
    } else if size >= 10.0 {
        format!("{size:.1}")
    } else if size >= 1.0 {
        format!("{size:.2}")
    } else if size >= 0.1 {
        format!("{size:.3}")
    } else {
        format!("{size:.4}")
    }
}

#[cfg(test)]
mod tests;
