//! A diagnosis in plain words: the same dozen lines on the terminal and at the top of the page.
//!
//! Limits are said where they hold: what cannot be told apart, what was not testable, how much is left. An effect is named
//! by what it does *and* by its id, so that a reader without the library's table knows what is meant.

use diagnose::{Diagnosis, Verdict, VerdictKind};
use flight::effect::{EffectGroup, EffectId};

use crate::statistics::NORMAL_95;
use crate::summary::counted;

/// Effects whose smallest visible size is told where nothing was found: one of each kind that a person would think of.
const TOLD_WHEN_SILENT: [EffectId; 6] = [
    EffectId::DragFactor,
    EffectId::ZeroLiftDrag,
    EffectId::WaveDrag,
    EffectId::FuelFlowGain,
    EffectId::ZeroFuelMassBias,
    EffectId::MachBias,
];
/// Other causes than the verdict's that are told, and the least probability that is. Our choice: a dozen lines in all.
const OTHERS_TOLD: usize = 3;
const LEAST_TOLD: f64 = 0.02;
/// Measurements or flights that are told. Our choice: the best two.
const SEPARATIONS_TOLD: usize = 2;
/// Probability below which no cause is told as one. Our choice: more probable than not.
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
pub fn lines(diagnosis: &Diagnosis) -> Vec<String> {
    let verdict = &diagnosis.verdict;
    let mut lines = vec![format!(
        "{}: {}, {}.",
        if diagnosis.tail == "*" { "All tails" } else { &diagnosis.tail },
        counted(diagnosis.flights, "flight"),
        counted(diagnosis.segments, "segment"),
    )];
    if verdict.kind == VerdictKind::InsufficientData {
        lines.push(format!("No verdict, insufficient data. {}", verdict.advice));
        return lines;
    }
    lines.push(gap(diagnosis));
    lines.extend(places(diagnosis));
    match verdict.kind {
        VerdictKind::NoGap => lines.extend(silent(diagnosis)),
        VerdictKind::Effects => lines.extend(named(diagnosis)),
        VerdictKind::OutsideLibrary => lines.extend(unnamed(diagnosis)),
        VerdictKind::InsufficientData => {}
    }
    if !diagnosis.not_testable.is_empty() {
        let names: Vec<String> = diagnosis
            .not_testable
            .iter()
            .map(|entry| format!("{} (needs {})", entry.effect, entry.needs.join(", ")))
            .collect();
        lines.push(format!("Not testable with this data: {}.", names.join("; ")));
    }
    lines
}

fn gap(diagnosis: &Diagnosis) -> String {
    let gap = &diagnosis.gap;
    format!(
        "Gap {:+.2} % of fuel flow in the mean, {:.2} % rms (95 % interval {:.2} to {:.2}); noise alone makes {:.2} %.",
        gap.mean_percent,
        gap.rms_percent,
        gap.rms_ci95[0],
        gap.rms_ci95[1],
        gap.noise_floor_rms_percent
    )
}

fn places(diagnosis: &Diagnosis) -> Vec<String> {
    diagnosis
        .r#where
        .iter()
        .enumerate()
        .map(|(rank, place)| {
            if place.bounds.is_empty() && place.slice == "everywhere" {
                return "It has no place: it is everywhere.".to_owned();
            }
            format!(
                "{} at {}: {:+.2} % there ({:+.2} to {:+.2}), {} of the explainable gap, p {:.3}.",
                if rank == 0 { "It sits" } else { "And" },
                place.slice,
                place.mean_gap_percent,
                place.ci95[0],
                place.ci95[1],
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
            let name = id.to_string();
            let entry = diagnosis.detectable.iter().find(|entry| entry.effect == name)?;
            Some(format!("{name} {} {}", figure(entry.smallest?), entry.unit))
        })
        .collect();
    let mut lines = vec!["Nothing beyond the noise: the model fits these flights.".to_owned()];
    if !told.is_empty() {
        lines.push(format!("What would just have been seen: {}.", told.join(", ")));
    }
    lines
}

fn named(diagnosis: &Diagnosis) -> Vec<String> {
    let verdict = &diagnosis.verdict;
    let open = verdict.probability < PROBABLE;
    let mut lines = Vec::new();
    for (place, name) in verdict.effects.iter().enumerate() {
        let what = effect_told(diagnosis, name);
        lines.push(if place == 0 && open {
            format!(
                "No cause stands out. The most probable is {what}, probability {:.2}: do not act on it.",
                verdict.probability
            )
        } else if place == 0 {
            format!("Cause: {what}, probability {:.2}.", verdict.probability)
        } else {
            format!("Together with: {what}.")
        });
    }
    if !open {
        lines.extend(follows(verdict));
    }
    let after = diagnosis.causes.iter().find_map(|cause| cause.rms_after_percent);
    match (after, verdict.closure, verdict.closure_ci95) {
        (Some(after), Some(closure), Some([low, high])) => lines.push(format!(
            "Added to the model it leaves {after:.2} % on flights that it was not fitted to: {:.0} % of what can be \
             explained ({:.0} to {:.0}).",
            100.0 * closure,
            100.0 * low,
            100.0 * high
        )),
        (None, Some(closure), Some([low, high])) => lines.push(format!(
            "Chosen anew on four fifths of the flights, it closes {:.0} % of what can be explained on the rest ({:.0} to \
             {:.0}).",
            100.0 * closure,
            100.0 * low,
            100.0 * high
        )),
        _ => lines.push("The gap is too small to measure how far it shrinks.".to_owned()),
    }
    let others: Vec<&str> = verdict
        .class
        .iter()
        .filter(|name| !verdict.effects.contains(name))
        .map(String::as_str)
        .collect();
    if !others.is_empty() {
        lines.push(format!("These flights cannot tell it from: {}.", others.join(", ")));
    }
    // One measurement often separates from several effects: it is told once, where it does most.
    let mut told: Vec<&str> = Vec::new();
    for separation in &verdict.separations {
        if told.len() == SEPARATIONS_TOLD {
            break;
        }
        if told.contains(&separation.measurement.as_str()) {
            continue;
        }
        told.push(&separation.measurement);
        lines.push(format!(
            "To be sure: {} (tells it from {}: {:.1} to {:.1} standard deviations{}).",
            separation.measurement,
            separation.from,
            separation.distance_now,
            separation.distance_then,
            separation.distance_ordinary_flights.map_or_else(String::new, |distance| format!(
                "; six ordinary flights {distance:.1}"
            ))
        ));
    }
    lines.extend(rivals(diagnosis));
    lines
}

fn unnamed(diagnosis: &Diagnosis) -> Vec<String> {
    let outside = &diagnosis.outside;
    let told = |words: &str, what: Option<&String>| {
        what.map_or_else(String::new, |what| format!("{words}{what}"))
    };
    let mut lines = vec![format!(
        "A real gap that no effect of the library explains{}{} (probability {:.2}).",
        told("; it hangs on ", outside.variable.as_ref()),
        told(" and acts on ", outside.acts_on.as_ref()),
        outside.probability
    )];
    if let Some(cause) = diagnosis.causes.first() {
        lines.push(format!(
            "The nearest is {} ({}); do not act on it.",
            cause.effect,
            cause.closure.map_or_else(
                || "how much it closes could not be measured".to_owned(),
                |closure| format!("it closes {:.0} % on unseen flights", 100.0 * closure.max(0.0))
            )
        ));
    }
    lines.push("Nothing is applied. Look at what these flights have in common there, or record more signals.".to_owned());
    lines
}

/// What follows from the verdict; not before it is clear whether the recording errs or the aircraft.
fn follows(verdict: &Verdict) -> Option<String> {
    let ids: Vec<EffectId> = verdict
        .effects
        .iter()
        .chain(&verdict.class)
        .filter_map(|name| EffectId::from_name(name))
        .collect();
    let first = ids.first()?;
    if ids.iter().all(|id| id.is_of_recordings() == first.is_of_recordings()) {
        return Some(consequence(first.entry().group).to_owned());
    }
    Some(
        "Errors of the recording and changes of the aircraft are both possible: only the latter change predictions. Find \
         out which before you apply one."
            .to_owned(),
    )
}

/// Other causes that the data leave open.
fn rivals(diagnosis: &Diagnosis) -> Vec<String> {
    let verdict = &diagnosis.verdict;
    let mut told: Vec<String> = diagnosis
        .causes
        .iter()
        .filter(|cause| !verdict.effects.contains(&cause.effect) && cause.probability >= LEAST_TOLD)
        .take(OTHERS_TOLD)
        .map(|cause| format!("{} {:.2}", cause.effect, cause.probability))
        .collect();
    if diagnosis.outside.probability >= LEAST_TOLD {
        let hangs = diagnosis
            .outside
            .variable
            .as_ref()
            .map_or_else(String::new, |variable| format!(" that hangs on {variable}"));
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

/// "earlier drag rise with Mach number, `wave_drag` +0.0080 ± 0.0010 Mach", without the backticks.
fn effect_told(diagnosis: &Diagnosis, name: &str) -> String {
    let cause = diagnosis.causes.iter().find(|cause| cause.effect == name);
    let added = diagnosis
        .addition
        .as_ref()
        .and_then(|addition| addition.effects.iter().find(|added| added.effect == name));
    let size = added.map(|added| (added.size, added.standard_deviation)).or_else(|| {
        let [low, high] = cause?.magnitude.ci95;
        Some((cause?.magnitude.value, (high - low) / (2.0 * NORMAL_95)))
    });
    let (Some(id), Some((size, deviation))) = (EffectId::from_name(name), size) else {
        return name.to_owned();
    };
    let hidden = cause.map_or("", |cause| cause.hidden.as_str());
    format!(
        "{}, {name} {}{} ± {} {}{}",
        id.phrase(size),
        if size < 0.0 { "−" } else { "+" },
        figure(size.abs()),
        figure(deviation),
        id.entry().unit,
        if hidden.is_empty() { String::new() } else { format!(" ({hidden})") }
    )
}

/// Three digits, as a person writes them.
fn figure(value: f64) -> String {
    let size = value.abs();
    if size >= 100.0 {
        format!("{value:.0}")
    } else if size >= 10.0 {
        format!("{value:.1}")
    } else if size >= 1.0 {
        format!("{value:.2}")
    } else if size >= 0.1 {
        format!("{value:.3}")
    } else {
        format!("{value:.4}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_has_words_for_both_signs() {
        for id in EffectId::library(flight::MAXIMUM_ENGINES) {
            for size in [-1.0, 1.0] {
                let words = id.phrase(size);
                assert!(words.len() > 10 && !words.contains('_'), "{id}: {words}");
            }
        }
        assert_eq!(EffectId::TsfcEngine(2).phrase(3.0), "engine 2 burns more");
        assert_eq!(EffectId::MachBias.phrase(-0.004), "Mach number reads low");
    }

    #[test]
    fn figures_have_three_digits() {
        assert_eq!(figure(199.5), "200");
        assert_eq!(figure(12.34), "12.3");
        assert_eq!(figure(5.246), "5.25");
        assert_eq!(figure(0.336), "0.336");
        assert_eq!(figure(0.004), "0.0040");
    }
}
