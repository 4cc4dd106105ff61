//! What a diagnosis comes to: an answer to what, where, how sure and what to do; and the index of many tails.

use std::collections::BTreeMap;

use diagnose::{Diagnosis, Magnitude, Verdict};
use flight::effect::EffectId;
use maud::{Markup, html};
use pipeline::diagnosis_text::described;
use pipeline::diagnosis_words::{
    NO_CAUSE_STANDS_OUT, NOT_RULED_OUT, advice, are_few, everywhere_words, is_open, near_and_far,
    others_beside, others_of_class, outside_words, phrase, region_words, silent_words, told_size,
};

use super::Tail;
use crate::text::{capitalised, signed, three_digits};

/// The size of an effect with its 95 % interval.
fn size_words(diagnosis: &Diagnosis, id: EffectId) -> Option<(f64, String)> {
    let Magnitude { value, ci95: [low, high] } = told_size(diagnosis, id)?;
    let unit = id.unit_words();
    let words =
        format!("{} {unit} ({} to {})", three_digits(value), three_digits(low), three_digits(high));
    Some((value, words))
}

/// An effect in words at the sign that was found, and its name in files.
pub(super) fn effect(diagnosis: &Diagnosis, id: EffectId) -> Markup {
    let size = size_words(diagnosis, id).map_or(1.0, |(size, _)| size);
    html! { (phrase(diagnosis, id, size)) " " span.id { "(" (id) ")" } }
}

/// The answer, in a box, with what the comparison with its type says of the tail.
pub(super) fn card(diagnosis: &Diagnosis, of_fleet: Option<&str>) -> Markup {
    let gap = &diagnosis.gap;
    html! {
        dl.verdict.gap[gap.detected] {
            dt { "What" } dd { (what(diagnosis)) }
            @if let Some(words) = of_fleet {
                dt { "In its fleet" } dd { (words) " See " a href="fleet.html" { "fleet.html" } "." }
            }
            @if let Some(place) = diagnosis.r#where.first() {
                dt { "Where" }
                dd {
                    @if place.region.is_everywhere() {
                        @if diagnosis.r#where.len() == 1 { (everywhere_words(diagnosis)) }
                        @else { "Everywhere that was flown, but not alike." }
                    }
                    @else {
                        (capitalised(&region_words(&place.region))) ": " (signed(Some(place.mean_gap_percent)))
                        " % there (" (signed(Some(place.ci95[0]))) " to " (signed(Some(place.ci95[1]))) " %), "
                        (place.segments) " of " (diagnosis.segments) " segments."
                    }
                }
            }
            @if !matches!(diagnosis.verdict, Verdict::InsufficientData(_)) {
                dt { "How sure" } dd { (how_sure(diagnosis)) }
            }
            dt { "What to do" }
            dd {
                @if of_fleet.is_some() && matches!(diagnosis.verdict, Verdict::NoGap) { "What its fleet's page says of it. By itself: " }
                (advice(diagnosis))
            }
        }
    }
}

/// The verdict in a sentence.
fn what(diagnosis: &Diagnosis) -> Markup {
    match &diagnosis.verdict {
        Verdict::NoGap => html! { b { (silent_words(diagnosis)) } },
        Verdict::InsufficientData(_) => html! { b { "No verdict: too little data." } },
        Verdict::OutsideLibrary(_) => html! {
            b { (outside_words(&diagnosis.outside)) } "."
        },
        Verdict::Effects(found) => html! {
            @let open = is_open(&diagnosis.verdict);
            @if open { b { (capitalised(NO_CAUSE_STANDS_OUT)) "." } " The most probable, not to be acted on: " }
            @for (place, id) in found.effects.iter().enumerate() {
                @let size = size_words(diagnosis, *id);
                @if place > 0 { ", together with " }
                @let named = phrase(diagnosis, *id, size.as_ref().map_or(1.0, |(size, _)| *size));
                @if open { (named) }
                @else { b { @if place == 0 { (capitalised(&named)) } @else { (named) } } }
                " " span.id { "(" (id) ")" }
                @if let Some((_, words)) = size { ": " (words) }
                @if place > 0 {
                    @for other in others_beside(found, *id) { ", or " (effect(diagnosis, other)) " in its place" }
                }
            }
            @let others = others_of_class(found);
            @if are_few(&others) {
                @for id in others { ", or " (effect(diagnosis, id)) }
            }
            "."
        },
    }
}

/// Probability, size of the gap against noise, and what closes on unseen flights.
fn how_sure(diagnosis: &Diagnosis) -> Markup {
    let gap = &diagnosis.gap;
    html! {
        @match &diagnosis.verdict {
            Verdict::Effects(found) => {
                @let others = others_of_class(found);
                @let few = are_few(&others);
                "Probability " (format!("{:.2}", found.probability)) @if few { " of the first" }
                ". "
                // Of a few the answer itself says that they are open, and advice says why.
                @let [near, far] = near_and_far(found);
                @let told = [
                    ("These flights cannot tell it from", near),
                    (NOT_RULED_OUT, far),
                ];
                @for (words, others) in told.iter().filter(|(_, others)| !few && !others.is_empty()) {
                    (words) ": "
                    @for (place, id) in others.iter().enumerate() { @if place > 0 { "; " } (effect(diagnosis, *id)) }
                    ". "
                }
            }
            Verdict::OutsideLibrary(unexplained) => {
                "Probability " (format!("{:.2}", unexplained.probability)) " that the cause is outside the library. "
                @for sentence in described(&diagnosis.outside) { (sentence) " " }
            }
            _ => {}
        }
        "The gap is " (signed(Some(gap.mean_percent))) " % in the mean and " (format!("{:.2}", gap.rms_percent)) " % rms ("
        (format!("{:.2} to {:.2}", gap.rms_ci95[0], gap.rms_ci95[1])) " %); noise alone makes "
        (format!("{:.2}", gap.noise_floor_rms_percent)) " %."
        @if let Some(closure) = diagnosis.verdict.closure() {
            " On flights that it was not fitted to, " (percent(closure.share)) " of what can be explained closes ("
            (percent(closure.ci95[0])) " to " (percent(closure.ci95[1])) ")."
        }
    }
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// All tails in a table: those with a gap first, of each the largest first.
pub(super) fn index(tails: &[Tail<'_>]) -> Markup {
    let mut order: Vec<&Tail<'_>> = tails.iter().collect();
    order.sort_by(|one, other| {
        let (one, other) = (&one.diagnosed.diagnosis.gap, &other.diagnosed.diagnosis.gap);
        let by_size = other.rms_percent.total_cmp(&one.rms_percent);
        other.detected.cmp(&one.detected).then(by_size)
    });
    html! {
        section {
            h2 { "All tails" }
            p { (in_short(tails)) }
            p.note { "Tails with a gap beyond what model and sensors leave uncertain first, then the largest. A click on a heading sorts." }
            div.scroll tabindex="0" role="region" aria-label="Verdict of every tail" {
                table.sort.data.fleet data-name="diagnosis" {
                    thead { tr {
                        th scope="col" { "tail" } th scope="col" style="text-align:left" { "verdict" } th scope="col" { "probability" }
                        th scope="col" { "gap, mean %" } th scope="col" { "rms %" } th scope="col" { "noise %" }
                        th scope="col" { "closes" }
                    } }
                    tbody { @for tail in order { (index_row(tail)) } }
                }
            }
        }
    }
}

/// All verdicts in a sentence, the most frequent first.
fn in_short(tails: &[Tail<'_>]) -> String {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for tail in tails {
        let kind = match &tail.diagnosed.diagnosis.verdict {
            Verdict::Effects(found) if !is_open(&tail.diagnosed.diagnosis.verdict) => {
                let diagnosis = &tail.diagnosed.diagnosis;
                let size = |id| size_words(diagnosis, id).map_or(1.0, |(size, _)| size);
                let named = found.effects.iter().map(|id| phrase(diagnosis, *id, size(*id)));
                named.collect::<Vec<_>>().join(" with ")
            }
            _ => short(&tail.diagnosed.diagnosis),
        };
        *counts.entry(kind).or_default() += 1;
    }
    let mut ranked: Vec<(String, usize)> = counts.into_iter().collect();
    // A stable sort: equal counts stay in the order of their words.
    ranked.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let told: Vec<String> =
        ranked.iter().map(|(kind, count)| format!("{kind} ({count})")).collect();
    format!("Of {} tails: {}.", tails.len(), told.join("; "))
}

fn index_row(tail: &Tail<'_>) -> Markup {
    let diagnosis = &tail.diagnosed.diagnosis;
    let gap = &diagnosis.gap;
    let closure = diagnosis.verdict.closure();
    let is_computed = !matches!(diagnosis.verdict, Verdict::InsufficientData(_));
    html! {
        tr {
            th scope="row" { a href=(format!("#{}", tail.id)) { (tail.diagnosed.name()) } }
            td.words { (short_of(tail)) }
            td { @if let Some(found) = diagnosis.verdict.found() { (format!("{:.2}", found.probability)) } @else { "–" } }
            @if is_computed {
                td data-v=(gap.mean_percent) { (signed(Some(gap.mean_percent))) }
                td data-v=(gap.rms_percent) { (format!("{:.2}", gap.rms_percent)) }
                td data-v=(gap.noise_floor_rms_percent) { (format!("{:.2}", gap.noise_floor_rms_percent)) }
            } @else { td { "–" } td { "–" } td { "–" } }
            td { @if let Some(closure) = closure { (percent(closure.share)) } @else { "–" } }
        }
    }
}

/// A tail in a line: its verdict, and whether more was found where it was compared with its type.
pub(super) fn short_of(tail: &Tail<'_>) -> String {
    let verdict = short(&tail.diagnosed.diagnosis);
    if tail.of_fleet.is_some() { format!("{verdict}; a finding in its fleet") } else { verdict }
}

fn short(diagnosis: &Diagnosis) -> String {
    match &diagnosis.verdict {
        Verdict::NoGap => "no gap".to_owned(),
        Verdict::InsufficientData(_) => "too little data".to_owned(),
        Verdict::OutsideLibrary(_) => "outside the library".to_owned(),
        verdict @ Verdict::Effects(_) if is_open(verdict) => NO_CAUSE_STANDS_OUT.to_owned(),
        Verdict::Effects(found) => {
            let told = found.effects.iter().map(|id| {
                let (size, words) = size_words(diagnosis, *id).unwrap_or((1.0, String::new()));
                format!("{}: {words}", phrase(diagnosis, *id, size))
            });
            told.collect::<Vec<_>>().join("; ")
        }
    }
}

#[cfg(test)]
mod tests {
    use diagnose::{Cause, Found, Gap, OutsideLibrary};
    use flight::effect::HiddenParameter;

    use super::*;

    /// Engine 2 burns more, with this probability.
    fn diagnosis(probability: f64) -> Diagnosis {
        let effect = EffectId::TsfcEngine(2);
        Diagnosis {
            flights: 20,
            segments: 200,
            gap: Gap {
                mean_percent: 1.0,
                rms_percent: 1.2,
                rms_ci95: [1.0, 1.4],
                noise_floor_rms_percent: 0.5,
                floor_by_replicates_rms_percent: None,
                floor_by_held_out_fit_rms_percent: None,
                detected: true,
                p_value: 0.001,
            },
            r#where: Vec::new(),
            causes: vec![Cause {
                effect,
                probability,
                probability_flat: probability,
                class: vec![effect],
                magnitude: Magnitude { value: 1.86, ci95: [1.2, 2.5] },
                rms_after_percent: None,
                closure: None,
                hidden: HiddenParameter::None,
            }],
            contributions: Vec::new(),
            not_testable: Vec::new(),
            verdict: Verdict::Effects(Found {
                effects: vec![effect],
                class: vec![effect],
                credible: Vec::new(),
                probability,
                beside: Vec::new(),
                closure: None,
                rest: None,
                separations: Vec::new(),
            }),
            addition: None,
            detectable: Vec::new(),
            outside: OutsideLibrary {
                looked_for_all: true,
                probability: 0.0,
                variable: None,
                acts_on: None,
                forms: Vec::new(),
                addition: None,
            },
            held_out: Vec::new(),
            left_out: BTreeMap::new(),
            outliers: Vec::new(),
            notes: Vec::new(),
        }
    }

    #[test]
    fn a_cause_that_does_not_stand_out_is_no_headline() {
        let open = diagnosis(0.17);
        let told = card(&open, None).into_string();
        assert!(
            told.contains("<b>No cause stands out.</b> The most probable, not to be acted on"),
            "{told}"
        );
        assert!(!told.contains("<b>Engine 2") && told.contains("Probability 0.17"), "{told}");
        assert_eq!(short(&open), "no cause stands out");
        let sure = diagnosis(0.83);
        let told = card(&sure, None).into_string();
        assert!(
            told.contains("<b>Engine 2 burns more</b>") && !told.contains("No cause"),
            "{told}"
        );
        assert!(short(&sure).starts_with("engine 2 burns more: "), "{}", short(&sure));
    }

    #[test]
    fn what_the_fleet_says_of_a_tail_is_pointed_to() {
        let told = card(&diagnosis(0.83), Some("It differs from its type by: …."));
        let told = told.into_string();
        assert!(
            told.contains("It differs from its type by: …. See <a href=\"fleet.html\">"),
            "{told}"
        );
    }
}
