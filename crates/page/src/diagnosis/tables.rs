//! Everything else that a diagnosis holds, folded.

use std::collections::BTreeMap;

use diagnose::{Diagnosis, LeftOutReason, Note};
use maud::{Markup, html};
use pipeline::diagnosed_tail::DiagnosedTail;
use pipeline::diagnosis_months::MonthGap;
use pipeline::diagnosis_text;
use pipeline::diagnosis_words::{left_out_words, measurement_words, region_words};

use super::causes::named;
use crate::place::Detail;
use crate::text::{capitalised, signed, three_digits};
use pipeline::summary::counted;

/// The folded part of a tail's section.
pub(super) fn tables(diagnosed: &DiagnosedTail, detail: Detail) -> Markup {
    let diagnosis = &diagnosed.diagnosis;
    let notes = diagnosed.notes();
    let full = detail == Detail::Full;
    // A note says more of outliers than their number.
    let are_noted = diagnosis.notes.iter().any(|note| matches!(note, Note::Outliers { .. }));
    let is_told = |reason: &LeftOutReason| are_noted && *reason == LeftOutReason::Outlier;
    let left_out: Vec<_> =
        diagnosis.left_out.iter().filter(|(reason, _)| !is_told(reason)).collect();
    html! {
        details.more {
            summary { "In full sentences" }
            @for line in diagnosis_text::lines(diagnosed).iter().skip(1) { p { (line) } }
        }
        @if !diagnosis.r#where.is_empty() { details.more { summary { "Places" } (places(diagnosis)) } }
        @if full && diagnosed.months.len() > 1 {
            details.more { summary { "Month by month" } (months(&diagnosed.months)) }
        }
        @if full && !diagnosis.causes.is_empty() { details.more { summary { "All causes" } (causes(diagnosis)) } }
        @if full && !diagnosis.contributions.is_empty() {
            details.more { summary { "What each effect makes of the gap, all of them at once" } (contributions(diagnosis)) }
        }
        @if full && !diagnosis.detectable.is_empty() {
            details.more { summary { "How small an effect these flights would show" } (detectable(diagnosis)) }
        }
        (beforehand(diagnosis))
        (not_testable(diagnosis))
        @if !(notes.is_empty() && left_out.is_empty()) {
            details.more {
                summary { "Notes on model and data (" (notes.len() + left_out.len()) ")" }
                ul {
                    @for (reason, count) in &left_out { li { (counted(**count, "segment")) " left out: " (left_out_words(**reason)) "." } }
                    @for note in &notes { li { (capitalised(note)) "." } }
                }
            }
        }
    }
}

fn places(diagnosis: &Diagnosis) -> Markup {
    html! {
        div.scroll {
            table.data data-name="places" {
                thead { tr {
                    th scope="col" { "place" } th scope="col" { "segments" } th scope="col" { "mean gap, %" }
                    th scope="col" { "95 % interval by flight, %" } th scope="col" { "share of the explainable gap" }
                    th scope="col" { "p, search accounted for" }
                } }
                tbody { @for place in &diagnosis.r#where { tr {
                    th scope="row" { (region_words(&place.region)) }
                    td { (place.segments) }
                    td { (signed(Some(place.mean_gap_percent))) }
                    td { (signed(Some(place.ci95[0]))) " to " (signed(Some(place.ci95[1]))) }
                    td { @if place.share_of_gap > 1.0 { "all" } @else { (format!("{:.0} %", 100.0 * place.share_of_gap)) } }
                    td { (format!("{:.3}", place.p_value)) }
                } } }
            }
        }
    }
}

fn months(months: &[MonthGap]) -> Markup {
    let interval = |ci95: Option<[f64; 2]>| {
        ci95.map_or_else(
            || "–".to_owned(),
            |[low, high]| format!("{} to {}", signed(Some(low)), signed(Some(high))),
        )
    };
    html! {
        p.note { "Mean gap over the segments of a month, its 95 % interval by flight; with what is named in the model, of the sizes \
                  that all flights together gave it." }
        div.scroll {
            table.data data-name="months" {
                thead { tr {
                    th scope="col" { "month" } th scope="col" { "flights" } th scope="col" { "segments" } th scope="col" { "mean gap, %" }
                    th scope="col" { "95 % interval, %" } th scope="col" { "with what is named, %" } th scope="col" { "95 % interval, %" }
                } }
                tbody { @for one in months { tr {
                    th scope="row" { (one.month) }
                    td { (one.flights) }
                    td { (one.segments) }
                    td { (signed(Some(one.mean_gap_percent))) }
                    td { (interval(one.ci95)) }
                    td { @if one.after_percent.is_some() { (signed(one.after_percent)) } @else { "–" } }
                    td { (interval(one.after_ci95)) }
                } } }
            }
        }
    }
}

fn causes(diagnosis: &Diagnosis) -> Markup {
    html! {
        div.scroll {
            table.data data-name="all-causes" {
                thead { tr {
                    th scope="col" { "effect" } th scope="col" { "probability" } th scope="col" { "if any size" } th scope="col" { "size" }
                    th scope="col" { "95 % interval" } th scope="col" { "unit" } th scope="col" { "closes on unseen flights" }
                    th scope="col" { "cannot be told from" }
                } }
                tbody { @for cause in &diagnosis.causes { tr {
                    th scope="row" { code { (cause.effect) } }
                    td { (format!("{:.3}", cause.probability)) }
                    td { (format!("{:.3}", cause.probability_flat)) }
                    td { (three_digits(cause.magnitude.value)) }
                    td { (three_digits(cause.magnitude.ci95[0])) " to " (three_digits(cause.magnitude.ci95[1])) }
                    td { (cause.effect.unit_words()) }
                    td { @if let Some(closure) = cause.closure { (format!("{:.0} %", 100.0 * closure.share)) } @else { "–" } }
                    td { @if cause.class.len() > 1 { (named(&cause.class[1..])) } @else { "–" } }
                } } }
            }
        }
    }
}

fn contributions(diagnosis: &Diagnosis) -> Markup {
    html! {
        p.note { "Every effect of the library acts, most of them next to nothing: for a gap that no one or two carry. What these \
                  flights cannot tell apart shares what it makes, so that its intervals reach down to nothing." }
        div.scroll {
            table.data data-name="contributions" {
                thead { tr {
                    th scope="col" { "effect" } th scope="col" { "makes the most" } th scope="col" { "of fuel flow, % rms" }
                    th scope="col" { "95 % interval" } th scope="col" { "size" } th scope="col" { "95 % interval" } th scope="col" { "unit" }
                } }
                tbody { @for one in &diagnosis.contributions { tr {
                    th scope="row" { code { (one.effect) } }
                    td { (format!("{:.2}", one.leads)) }
                    td { (format!("{:.2}", one.rms_percent)) }
                    td { (format!("{:.2} to {:.2}", one.rms_ci95[0], one.rms_ci95[1])) }
                    td { (three_digits(one.magnitude.value)) }
                    td { (three_digits(one.magnitude.ci95[0])) " to " (three_digits(one.magnitude.ci95[1])) }
                    td { (one.effect.unit_words()) }
                } } }
            }
        }
    }
}

fn detectable(diagnosis: &Diagnosis) -> Markup {
    html! {
        p.note { "The smallest size that would be seen with about 60 % probability." }
        div.scroll {
            table.data data-name="detectable" {
                thead { tr { th scope="col" { "effect" } th scope="col" { "smallest size" } th scope="col" { "unit" } } }
                tbody { @for one in &diagnosis.detectable { tr {
                    th scope="row" { (one.effect.phrase(1.0)) " " span.id { "(" (one.effect) ")" } }
                    td { @if let Some(size) = one.smallest { (three_digits(size).trim_start_matches('+')) } @else { "never seen" } }
                    td { (one.effect.unit_words()) }
                } } }
            }
        }
    }
}

/// Effects of typical size that these flights cannot tell apart, by the measurement that could: each measurement once.
fn beforehand(diagnosis: &Diagnosis) -> Markup {
    let mut by_measurement: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for one in &diagnosis.detectable {
        if let Some(best) = one.separations.first() {
            let pair = format!("{} from {}", one.effect, best.from);
            by_measurement.entry(measurement_words(&best.measurement)).or_default().push(pair);
        }
    }
    let mut ranked: Vec<(String, Vec<String>)> = by_measurement.into_iter().collect();
    ranked.sort_by_key(|(_, pairs)| std::cmp::Reverse(pairs.len()));
    html! {
        @if !ranked.is_empty() {
            details.more {
                summary { "Measurements that would tell other effects apart" }
                p.note { "Whatever was found: effects of typical size that these flights cannot tell from another, by what would \
                          tell them best." }
                ol { @for (measurement, pairs) in &ranked { li { (capitalised(measurement)) ": " (pairs.join(", ")) "." } } }
            }
        }
    }
}

/// What cannot be tested, by the input that is missing.
fn not_testable(diagnosis: &Diagnosis) -> Markup {
    let mut by_need: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for entry in &diagnosis.not_testable {
        let needs: Vec<&str> = entry.needs.iter().map(|needed| needed.name()).collect();
        by_need.entry(needs.join(" and ")).or_default().push(entry.effect.to_string());
    }
    html! {
        @if !by_need.is_empty() {
            details.more {
                summary { "Not testable with this data (" (diagnosis.not_testable.len()) ")" }
                ul { @for (need, effects) in &by_need { li { "Without " code { (need) } ": " (effects.join(", ")) "." } } }
            }
        }
    }
}
