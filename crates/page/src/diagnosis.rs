//! `diagnosis.html`: verdicts, causes with sizes, what cannot be tested, what would just be detected.

use diagnose::{Cause, Diagnosis, Separation, Verdict};
use flight::effect::{EffectId, HiddenParameter};
use maud::{Markup, html};

use crate::fleet;
use crate::frame::framed;
use pipeline::diagnosed_tail::DiagnosedTail;
use pipeline::diagnosis_text;
use pipeline::diagnosis_words::{joined, measurement_words, region_words};
use pipeline::summary::{ReportsSummary, counted};

/// Causes shown for each tail.
const CAUSES_SHOWN: usize = 8;
/// Measurements or flights shown for each effect, whatever is found.
const SEPARATIONS_SHOWN: usize = 2;

/// The page of diagnoses, with the counts of the reports behind them.
#[must_use]
pub fn diagnosis(reports: &ReportsSummary, diagnoses: &[DiagnosedTail]) -> String {
    let title = "Diagnosis of performance models";
    let body = html! {
        p.run {
            (counted(reports.read, "report")) " read, " (reports.refused.len()) " refused. Gap: ln recorded − ln predicted "
            "total fuel flow, in %; positive: the aircraft burns more than the model predicts."
        }
        (fleet::refused(reports))
        @for one in diagnoses { (section(one)) }
    };
    framed(title, true, &body)
}

fn section(diagnosed: &DiagnosedTail) -> Markup {
    let diagnosis = &diagnosed.diagnosis;
    let separating = diagnosis.verdict.found().map_or(&[][..], |found| &found.separations);
    let notes = diagnosed.notes();
    html! {
        section {
            h2 { (diagnosed.name()) }
            @for (place, line) in diagnosis_text::lines(diagnosed).iter().skip(1).enumerate() {
                p { @if place == 0 {
                    (counted(diagnosis.flights, "flight")) ", " (counted(diagnosis.segments, "segment")) ". "
                } (line) }
            }
            (places(diagnosis))
            @if !matches!(diagnosis.verdict, Verdict::InsufficientData(_)) {
                (causes(&diagnosis.causes))
                p {
                    "A cause outside the library of effects: probability "
                    (format!("{:.3}", diagnosis.outside.probability))
                    ". The causes' probabilities and this one are parts of the same total."
                }
                (floors(diagnosis))
            }
            @if !separating.is_empty() {
                h3 { "What would distinguish them" }
                (separations(separating.iter().map(|one| (None, one))))
            }
            (detectable(diagnosis))
            (beforehand(diagnosis))
            @if !notes.is_empty() {
                h3 { "Notes" }
                ul { @for note in &notes { li { (note) } } }
            }
        }
    }
}

fn places(diagnosis: &Diagnosis) -> Markup {
    html! {
        @if !diagnosis.r#where.is_empty() {
            h3 { "Where the gap lies" }
            table {
                thead { tr {
                    th scope="col" { "region" } th scope="col" { "segments" } th scope="col" { "mean gap, %" }
                    th scope="col" { "95 % interval by flight, %" } th scope="col" { "share of the explainable gap" }
                    th scope="col" { "p, search accounted for" }
                } }
                tbody { @for place in &diagnosis.r#where { tr {
                    th scope="row" { (region_words(&place.region)) }
                    td { (place.segments) }
                    td { (format!("{:+.2}", place.mean_gap_percent)) }
                    td { (format!("{:+.2} to {:+.2}", place.ci95[0], place.ci95[1])) }
                    td { (format!("{:.0} %", 100.0 * place.share_of_gap)) }
                    td { (format!("{:.3}", place.p_value)) }
                } } }
            }
        }
    }
}

fn floors(diagnosis: &Diagnosis) -> Markup {
    let gap = &diagnosis.gap;
    html! {
        @if gap.floor_by_replicates_rms_percent.is_some() || gap.floor_by_held_out_fit_rms_percent.is_some() {
            p {
                "Noise floor " (format!("{:.2} %", gap.noise_floor_rms_percent)) " by the sensors' standard deviations"
                @if let Some(floor) = gap.floor_by_replicates_rms_percent {
                    "; " (format!("{floor:.2} %")) " by like segments of one flight"
                }
                @if let Some(floor) = gap.floor_by_held_out_fit_rms_percent {
                    "; at most " (format!("{floor:.2} %")) " by a flexible model on flights it was not fitted to"
                }
                "."
            }
        }
    }
}

fn causes(causes: &[Cause]) -> Markup {
    html! {
        h3 { "Causes by probability" }
        table {
            thead { tr {
                th scope="col" { "effect" } th scope="col" { "probability" } th scope="col" { "size" }
                th scope="col" { "95 % interval" } th scope="col" { "unit" } th scope="col" { "closes, unseen flights" }
                th scope="col" { "cannot be distinguished from" }
            } }
            tbody { @for cause in causes.iter().take(CAUSES_SHOWN) { tr {
                th scope="row" { (cause.effect) }
                td { (format!("{:.3}", cause.probability)) }
                td { (format!("{:+.4}", cause.magnitude.value)) }
                td { (format!("{:+.4} to {:+.4}", cause.magnitude.ci95[0], cause.magnitude.ci95[1])) }
                td { (cause.effect.entry().unit) @if cause.hidden != HiddenParameter::None { "; " (cause.hidden) } }
                td { @if let Some(closure) = cause.closure { (format!("{:.0} %", 100.0 * closure.share)) } @else { "–" } }
                td { (others(cause)) }
            } } }
        }
    }
}

fn others(cause: &Cause) -> String {
    let others: Vec<EffectId> =
        cause.class.iter().copied().filter(|id| *id != cause.effect).collect();
    if others.is_empty() { "–".to_owned() } else { joined(&others, ", ") }
}

fn detectable(diagnosis: &Diagnosis) -> Markup {
    html! {
        @if !diagnosis.detectable.is_empty() {
            h3 { "Smallest sizes that this data would show" }
            table {
                thead { tr {
                    th scope="col" { "effect" } th scope="col" { "smallest size" } th scope="col" { "unit" }
                } }
                tbody { @for one in &diagnosis.detectable { tr {
                    th scope="row" { (one.effect) }
                    td { @if let Some(size) = one.smallest { (format!("{size:.4}")) } @else { "–" } }
                    td { (one.effect.entry().unit) }
                } } }
            }
        }
    }
}

/// Effects that share a class at their typical sizes, whatever was found, and what would distinguish each from the
/// nearest.
fn beforehand(diagnosis: &Diagnosis) -> Markup {
    let shared: Vec<_> = diagnosis
        .detectable
        .iter()
        .flat_map(|one| {
            let shown = one.separations.iter().take(SEPARATIONS_SHOWN);
            shown.map(|separation| (Some(one.effect), separation))
        })
        .collect();
    html! {
        @if !shared.is_empty() {
            h3 { "Effects of typical size that these flights cannot distinguish, and what would" }
            (separations(shared.into_iter()))
        }
    }
}

fn separations<'a>(
    all: impl Iterator<Item = (Option<EffectId>, &'a Separation)> + Clone,
) -> Markup {
    let named = all.clone().any(|(effect, _)| effect.is_some());
    html! {
        table {
            thead { tr {
                @if named { th scope="col" { "effect" } }
                th scope="col" { "measurement or flights" } th scope="col" { "distinguishes it from" }
                th scope="col" { "distance now, σ" } th scope="col" { "distance with it, σ" }
                th scope="col" { "with six ordinary flights, σ" }
            } }
            tbody { @for (effect, one) in all { tr {
                @if let Some(effect) = effect { th scope="row" { (effect) } }
                td { (measurement_words(&one.measurement)) } td { (one.from) }
                td { (format!("{:.1}", one.distance_now)) } td { (format!("{:.1}", one.distance_then)) }
                td { @if let Some(distance) = one.distance_ordinary_flights { (format!("{distance:.1}")) } @else { "–" } }
            } } }
        }
    }
}
