//! A diagnosis in plain words: the same dozen lines on the terminal and at the top of the page.
//!
//! Limits are stated where they hold: what cannot be distinguished, what was not testable, how much is left. An effect is named
//! by what it does *and* by its id, so that a reader without the library's table knows what is meant.

use diagnose::{Diagnosis, OutsideLibrary, Slice, Variable, Verdict};
use flight::effect::{EffectId, HiddenParameter};

use crate::diagnosed_tail::{Compared, DiagnosedTail};
use crate::diagnosis_months::MonthGap;
use crate::diagnosis_words::{
    LEAST_TOLD, OTHERS_TOLD, advice, everywhere_words, form_words, left_out_words, outside_words,
    region_words, silent_words,
};
use crate::summary::{counted, not_minus_zero};

mod named;

use named::named;

/// Effects whose smallest visible size is printed where nothing was found: one of each kind that a person would think of.
const TOLD_WHEN_SILENT: [EffectId; 6] = [
    EffectId::DragFactor,
    EffectId::ZeroLiftDrag,
    EffectId::WaveDrag,
    EffectId::FuelFlowGain,
    EffectId::ZeroFuelMassBias,
    EffectId::MachBias,
];

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
            "model {}, {law}, {}{} learnt",
            compared.aircraft,
            counted(compared.flights_learnt, "flight"),
            compared.learnt_tail.as_ref().map_or_else(String::new, |tail| format!(" of {tail}"))
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
                    everywhere_words(diagnosis)
                } else {
                    "It is everywhere, but not alike."
                };
                return words.to_owned();
            }
            // "After a date" is a place by itself.
            let first = place.region.conditions.first().map(|condition| condition.variable);
            let is_date = place.region.engine.is_none() && first == Some(Variable::Date);
            let at = if is_date { "" } else { "at " };
            format!(
                "{} {at}{}: {:+.2} % there ({:+.2} to {:+.2}), {}, p {}.",
                if rank == 0 { "It lies" } else { "And" },
                region_words(&place.region),
                not_minus_zero(place.mean_gap_percent, 2),
                not_minus_zero(place.ci95[0], 2),
                not_minus_zero(place.ci95[1], 2),
                share_words(place),
                p_words(place.p_value)
            )
        })
        .collect()
}

/// A p-value with three decimals, of which 0.000 would claim more than any number of draws shows.
fn p_words(p_value: f64) -> String {
    if p_value < 0.0005 { "below 0.001".to_owned() } else { format!("{p_value:.3}") }
}

/// How much of the gap lies there.
fn share_words(place: &Slice) -> String {
    let share = 100.0 * place.share_of_gap;
    if place.region.engine.is_some() && share < 0.5 {
        return "hardly any of it in the fuel flow of all engines".to_owned();
    }
    if share > 100.0 {
        return "more than all of the explainable gap".to_owned();
    }
    format!("{:.0} % of the explainable gap", not_minus_zero(share, 0))
}

fn silent(diagnosis: &Diagnosis) -> Vec<String> {
    let told: Vec<String> = TOLD_WHEN_SILENT
        .iter()
        .filter_map(|id| {
            let entry = diagnosis.detectable.iter().find(|entry| entry.effect == *id)?;
            let size = format!("{id} {} {}", digits(entry.smallest?), id.unit_words());
            Some(match entry.hidden {
                HiddenParameter::None => size,
                hidden => format!("{size} ({hidden})"),
            })
        })
        .collect();
    let mut lines = vec![silent_words(diagnosis).to_owned()];
    if !told.is_empty() {
        lines.push(format!("What would just have been seen: {}.", told.join(", ")));
    }
    lines
}

fn unnamed(diagnosis: &Diagnosis) -> Vec<String> {
    let outside = &diagnosis.outside;
    let mut lines =
        vec![format!("{} (probability {:.2}).", outside_words(outside), outside.probability)];
    // What makes other flights worse is not near.
    let nearest = diagnosis
        .causes
        .first()
        .filter(|cause| cause.closure.is_none_or(|closure| closure.share > 0.0));
    if let Some(cause) = nearest {
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
    lines.extend(described(outside));
    lines.push("Nothing is applied. Look at what these flights have in common there, or record more signals.".to_owned());
    lines
}

/// The forms that describe a gap, best first; where the best makes unseen flights no better, that none does.
pub fn described(outside: &OutsideLibrary) -> Vec<String> {
    let Some(best) = outside.forms.first() else { return vec![] };
    if best.closure.is_some_and(|closure| closure.share <= 0.0) {
        return vec![format!(
            "No form that was tried describes it; the nearest: {}.",
            form_words(best)
        )];
    }
    let told = outside.forms.iter().zip(["Described best by", "Next best"]);
    told.map(|(found, words)| format!("{words} {}.", form_words(found))).collect()
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
