//! `diagnosis.html`: verdicts, causes with sizes, what cannot be tested, what would just be seen.

use diagnose::{Cause, Diagnosis, VerdictKind};
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::{fleet, style};
use crate::failure::RefusedReport;
use crate::summary::{RefusedSummary, ReportsSummary, counted};

/// Causes shown of each tail.
const CAUSES_SHOWN: usize = 8;

/// The page of diagnoses.
pub fn diagnosis(read: usize, refused: &[RefusedReport], diagnoses: &[Diagnosis]) -> String {
    let title = "Diagnosis of performance models";
    let reports = ReportsSummary {
        read,
        already_known: 0,
        refused: refused.iter().map(RefusedSummary::from).collect(),
    };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content=(concat!("cruisefit ", env!("CARGO_PKG_VERSION")));
                title { (title) }
                style { (PreEscaped(style::STYLE)) }
            }
            body.print-all {
                main {
                    h1 { (title) }
                    p.run {
                        (counted(read, "report")) " read, " (refused.len()) " refused. Gap: ln recorded − ln predicted "
                        "total fuel flow, in %; positive, the aircraft burns more than the model says."
                    }
                    (fleet::refused(&reports))
                    @for one in diagnoses { (section(one)) }
                }
            }
        }
    };
    let mut page = page.into_string();
    page.push('\n');
    page
}

fn section(diagnosis: &Diagnosis) -> Markup {
    let gap = &diagnosis.gap;
    html! {
        section {
            h2 { @if diagnosis.tail == "*" { "All tails" } @else { (diagnosis.tail) } }
            p {
                (counted(diagnosis.flights, "flight")) ", " (counted(diagnosis.segments, "segment")) ". Gap "
                (format!("{:+.2} % in the mean, {:.2} % rms", gap.mean_percent, gap.rms_percent))
                (format!(" (95 % interval {:.2} to {:.2})", gap.rms_ci95[0], gap.rms_ci95[1]))
                "; noise floor " (format!("{:.2} %", gap.noise_floor_rms_percent)) "."
            }
            p { strong { (words(diagnosis)) } " " (diagnosis.verdict.advice) }
            @if diagnosis.verdict.class.len() > 1 {
                p { "This data cannot tell apart: " (diagnosis.verdict.class.join(", ")) "." }
            }
            @if diagnosis.verdict.kind != VerdictKind::InsufficientData { (causes(&diagnosis.causes)) }
            p {
                "Something that no effect of the library is: probability "
                (format!("{:.3}", diagnosis.outside.probability))
                @if let Some(variable) = &diagnosis.outside.variable { ", it hangs on " (variable) }
                ". The causes' probabilities share one whole with this one."
            }
            @if !diagnosis.verdict.separations.is_empty() {
                h3 { "What would separate them" }
                table {
                    thead { tr {
                        th scope="col" { "measurement" } th scope="col" { "tells it from" }
                        th scope="col" { "distance now, σ" } th scope="col" { "distance then, σ" }
                    } }
                    tbody { @for one in &diagnosis.verdict.separations { tr {
                        th scope="row" { (one.measurement) } td { (one.from) }
                        td { (format!("{:.1}", one.distance_now)) } td { (format!("{:.1}", one.distance_then)) }
                    } } }
                }
            }
            @if !diagnosis.not_testable.is_empty() {
                p {
                    "Not testable with this data: "
                    @for (k, entry) in diagnosis.not_testable.iter().enumerate() {
                        @if k > 0 { "; " }
                        (entry.effect) " (needs " (entry.needs.join(", ")) ")"
                    }
                    "."
                }
            }
            (detectable(diagnosis))
            @if !diagnosis.notes.is_empty() {
                h3 { "Notes" }
                ul { @for note in &diagnosis.notes { li { (note) } } }
            }
        }
    }
}

fn words(diagnosis: &Diagnosis) -> String {
    let verdict = &diagnosis.verdict;
    match verdict.kind {
        VerdictKind::NoGap => "No gap beyond the noise.".to_owned(),
        VerdictKind::Effects => format!("{}.", verdict.effects.join(" and ")),
        VerdictKind::OutsideLibrary => {
            "A gap that is real and that no effect of the library explains.".to_owned()
        }
        VerdictKind::InsufficientData => "Insufficient data.".to_owned(),
    }
}

fn causes(causes: &[Cause]) -> Markup {
    html! {
        h3 { "Causes by probability" }
        table {
            thead { tr {
                th scope="col" { "effect" } th scope="col" { "probability" } th scope="col" { "size" }
                th scope="col" { "95 % interval" } th scope="col" { "unit" } th scope="col" { "closes, unseen flights" }
                th scope="col" { "cannot be told from" }
            } }
            tbody { @for cause in causes.iter().take(CAUSES_SHOWN) { tr {
                th scope="row" { (cause.effect) }
                td { (format!("{:.3}", cause.probability)) }
                td { (format!("{:+.4}", cause.magnitude.value)) }
                td { (format!("{:+.4} to {:+.4}", cause.magnitude.ci95[0], cause.magnitude.ci95[1])) }
                td { (cause.magnitude.unit) @if !cause.hidden.is_empty() { "; " (cause.hidden) } }
                td { @if let Some(share) = cause.closure { (format!("{:.0} %", 100.0 * share)) } @else { "–" } }
                td { (others(cause)) }
            } } }
        }
    }
}

fn others(cause: &Cause) -> String {
    let others: Vec<&str> =
        cause.class.iter().filter(|name| **name != cause.effect).map(String::as_str).collect();
    if others.is_empty() { "–".to_owned() } else { others.join(", ") }
}

fn detectable(diagnosis: &Diagnosis) -> Markup {
    html! {
        @if !diagnosis.detectable.is_empty() {
            h3 { "What would just be seen with this data" }
            table {
                thead { tr {
                    th scope="col" { "effect" } th scope="col" { "smallest size" } th scope="col" { "unit" }
                } }
                tbody { @for one in &diagnosis.detectable { tr {
                    th scope="row" { (one.effect) }
                    td { @if let Some(size) = one.smallest { (format!("{size:.4}")) } @else { "–" } }
                    td { (one.unit) }
                } } }
            }
        }
    }
}
