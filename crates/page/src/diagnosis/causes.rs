//! Causes as bars, what is left step by step, and what would tell causes apart.

use diagnose::{Cause, Diagnosis, SegmentGap, Separation};
use flight::effect::{EffectId, HiddenParameter};
use maud::{Markup, html};
use pipeline::diagnosis_words::{measurement_words, variable_words};

use super::verdict::effect;
use crate::text::{capitalised, three_digits};

/// Causes shown as bars, and the least probability of one beyond the first; all are in the table below. Our choice.
const CAUSES_SHOWN: usize = 6;
const LEAST_SHOWN: f64 = 0.01;
/// Measurements and flights shown. Our choice: what one would do first, and two other ways.
const SEPARATIONS_SHOWN: usize = 3;

/// Probability, size and closure of each cause.
pub(super) fn causes(diagnosis: &Diagnosis) -> Markup {
    let shown: Vec<&Cause> = diagnosis
        .causes
        .iter()
        .enumerate()
        .filter(|(place, cause)| *place == 0 || cause.probability >= LEAST_SHOWN)
        .map(|(_, cause)| cause)
        .take(CAUSES_SHOWN)
        .collect();
    let outside = &diagnosis.outside;
    html! {
        @if !shown.is_empty() {
            figure {
                figcaption {
                    b { "Causes." } " Probabilities add up to 1 with those not shown. The upper bar: with the sizes that effects \
                    usually have; the lower one: as if every size were as likely. The size is that of the effect alone, its \
                    interval of 95 % drawn from zero, the upright line."
                }
                div.scroll tabindex="0" role="region" aria-label="Causes" {
                    table.bars.data data-name="causes" {
                        thead { tr {
                            th scope="col" { "cause" } th scope="col" colspan="2" { "probability" } th scope="col" { "if any size" }
                            th scope="col" colspan="2" { "size" }
                            th scope="col" { "closes on unseen flights" }
                        } }
                        tbody {
                            @for cause in &shown { (cause_row(diagnosis, cause)) }
                            tr {
                                th scope="row" {
                                    "something outside the library"
                                    @if let Some(variable) = outside.variable.filter(|_| outside.probability >= LEAST_SHOWN) { ", by " (variable_words(variable)) }
                                }
                                (bar(outside.probability, "noise"))
                                td.number { (format!("{:.3}", outside.probability)) }
                                td { "–" } td.drawn {} td { "–" } td { "–" }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn cause_row(diagnosis: &Diagnosis, cause: &Cause) -> Markup {
    let [low, high] = cause.magnitude.ci95;
    html! {
        tr {
            th scope="row" {
                (effect(diagnosis, cause.effect))
                @if cause.hidden != HiddenParameter::None { br; span.id { (cause.hidden) } }
            }
            td.bar {
                (length(cause.probability, "after"))
                (length(cause.probability_flat, "noise thin"))
            }
            td.number { (format!("{:.3}", cause.probability)) }
            td.number { (format!("{:.3}", cause.probability_flat)) }
            td.drawn { (spark(cause)) }
            td { (three_digits(cause.magnitude.value)) " " (cause.effect.unit_words()) br;
                 span.id { (three_digits(low)) " to " (three_digits(high)) } }
            td.number { @if let Some(closure) = cause.closure {
                (format!("{:.0} %", 100.0 * closure.share))
            } @else { "–" } }
        }
    }
}

/// A bar of this share of the column's width; the number stands beside it.
fn bar(share: f64, class: &str) -> Markup {
    html! { td.bar { (length(share, class)) } }
}

fn length(share: f64, class: &str) -> Markup {
    let width = (100.0 * share).clamp(0.0, 100.0);
    html! { span class=(class) style=(format!("width:{width:.1}%")) {} }
}

/// A size with its interval on a scale of its own from zero: effects have different units.
fn spark(cause: &Cause) -> Markup {
    let [low, high] = cause.magnitude.ci95;
    let (least, most) = (low.min(0.0), high.max(0.0));
    let scale = (most - least).max(f64::MIN_POSITIVE);
    let at = |value: f64| 4.0 + 136.0 * ((value - least) / scale).clamp(0.0, 1.0);
    html! {
        svg.spark viewBox="0 0 144 14" aria-hidden="true" {
            path class="frame" d=(format!("M{:.1} 0V14", at(0.0))) {}
            path class="span" d=(format!("M{:.1} 7H{:.1}", at(low), at(high))) {}
            path class="disc after" d=(format!("M{:.1} 7h0", at(cause.magnitude.value))) {}
        }
    }
}

/// From the gap over the effects, one after the other, to the noise.
pub(super) fn left(diagnosis: &Diagnosis, segments: &[SegmentGap]) -> Markup {
    let gap = &diagnosis.gap;
    let mut steps: Vec<(Markup, f64, &str)> =
        vec![(html! { "gap before" }, gap.rms_percent, "before")];
    let effects = diagnosis.addition.iter().flat_map(|addition| &addition.effects);
    let added = effects.clone().count();
    for (place, added) in effects.enumerate() {
        let label = html! {
            @if place > 0 { "and with " } @else { "with " } (effect(diagnosis, added.effect))
        };
        steps.push((
            label,
            rms(segments.iter().filter_map(|one| one.after_percent.get(place))),
            "after",
        ));
    }
    if let Some(unseen) = diagnosis.causes.iter().find_map(|cause| cause.rms_after_percent) {
        steps.push((
            html! { "the first cause alone, on flights that it was not fitted to" },
            unseen,
            "after",
        ));
    }
    steps.push((html! { "noise alone, by the sensors" }, gap.noise_floor_rms_percent, "noise"));
    let floors = [
        ("noise by like segments of one flight", gap.floor_by_replicates_rms_percent),
        ("what a flexible model leaves on unseen flights", gap.floor_by_held_out_fit_rms_percent),
    ];
    for (words, floor) in floors {
        steps.extend(floor.map(|floor| (html! { (words) }, floor, "noise")));
    }
    let largest = steps.iter().map(|step| step.1).fold(f64::MIN_POSITIVE, f64::max);
    html! {
        figure {
            figcaption {
                b { "From the gap to the noise." } " Root mean square of the gap, %. “With” an effect: at the size fitted to all of \
                these flights; pale: what that takes away."
            }
            table.bars.data data-name="gap" {
                thead { tr {
                    th scope="col" { "step" } th scope="col" colspan="2" { "gap, % rms" }
                } }
                tbody { @for (place, (label, value, class)) in steps.iter().enumerate() { tr {
                    th scope="row" { (label) }
                    // What a step of the addition takes away of the one before.
                    @let taken = if (1..=added).contains(&place) { (steps[place - 1].1 - value).max(0.0) } else { 0.0 };
                    td.bar { div.fall {
                        (length(value / largest, class))
                        @if taken > 0.0 { (length(taken / largest, "taken")) }
                    } }
                    td.number { (format!("{value:.2}")) }
                } } }
            }
        }
    }
}

fn rms<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    let (sum, count) =
        values.fold((0.0, 0.0), |(sum, count), value| (sum + value * value, count + 1.0));
    if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
}

/// What these flights cannot tell apart, and what could: the best first, each measurement once.
pub(super) fn apart(diagnosis: &Diagnosis) -> Markup {
    let Some(found) = diagnosis.verdict.found() else { return html! {} };
    let mut told: Vec<(String, Vec<&Separation>)> = Vec::new();
    for separation in &found.separations {
        let words = measurement_words(&separation.measurement);
        match told.iter_mut().find(|(known, _)| *known == words) {
            Some((_, same)) => same.push(separation),
            None => told.push((words, vec![separation])),
        }
    }
    html! {
        @if !told.is_empty() {
            h3 { "What would tell it apart" }
            ol { @for (measurement, separations) in told.iter().take(SEPARATIONS_SHOWN) { li {
                (capitalised(measurement)) ": tells it from "
                @for (place, separation) in separations.iter().enumerate() {
                    @if place > 0 { "; " }
                    (effect(diagnosis, separation.from)) ", from "
                    (format!("{:.1} to {:.1} σ", separation.distance_now, separation.distance_then))
                    @if let Some(ordinary) = separation.distance_ordinary_flights {
                        (format!(" (six ordinary flights: {ordinary:.1} σ)"))
                    }
                }
                "."
            } } }
        }
    }
}

/// Effects as words, without sizes.
pub(super) fn named(effects: &[EffectId]) -> String {
    effects.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
