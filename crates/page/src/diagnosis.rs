//! `diagnosis.html`: for each tail what is wrong, where, how sure that is and what to do; figures under it; tables last.

use std::collections::BTreeMap;

use diagnose::Verdict;
use maud::{Markup, html};
use pipeline::diagnosed_tail::DiagnosedTail;
use pipeline::diagnosis_figures::DiagnosisFigures;
use pipeline::fleet_diagnosis::{FleetRecord, of_tail_words};
use pipeline::summary::{ReportsSummary, counted};

use crate::chart::dates;
use crate::fleet;
use crate::frame::framed;
use crate::place::Detail;
use crate::report::TAILS_IN_FULL;

mod causes;
mod engines;
mod figures;
pub(crate) mod map;
mod tables;
mod unseen;
mod verdict;

/// Segments drawn in a chart at most, of one tail and of all together. Our choice: more of one cannot be told apart, and 200
/// tails must stay below 6 MB.
const MOST_POINTS: usize = 600;
const FEWEST_POINTS: usize = 100;
const POINTS_OF_PAGE: usize = 20_000;

/// The page of diagnoses: the counts of the reports behind them, each diagnosis with what its charts are drawn from (in the
/// same order), the fleets that the tails were compared in (none where they were not), and the options of the run in words.
#[must_use]
pub fn diagnosis(
    reports: &ReportsSummary,
    diagnoses: &[DiagnosedTail],
    figures: &[DiagnosisFigures],
    fleets: &[FleetRecord],
    options: &[String],
) -> String {
    let tails: Vec<Tail<'_>> = diagnoses
        .iter()
        .zip(figures)
        .enumerate()
        .map(|(number, (diagnosed, figures))| Tail {
            id: anchor(number),
            diagnosed,
            figures,
            of_fleet: of_tail_words(fleets, diagnosed.name()),
            detail: if diagnoses.len() > TAILS_IN_FULL { Detail::Brief } else { Detail::Full },
            most_points: (POINTS_OF_PAGE / diagnoses.len()).clamp(FEWEST_POINTS, MOST_POINTS),
        })
        .collect();
    let body = html! {
        p.run { (head(reports, &tails, options)) }
        p.note {
            "Gap: ln recorded − ln predicted total fuel flow, in %; positive: the aircraft burns more than its model predicts. \
             Intervals are of 95 %."
        }
        @if tails.len() > 1 { (verdict::index(&tails)) }
        (fleet::refused(reports))
        @if tails.len() > TAILS_UNFOLDED {
            section {
                h2 { "Tails" }
                p.note { "Each tail unfolds at a click on its line, or on its name in the table above. All are printed." }
                @if let Some(tail) = tails.first().filter(|tail| tail.detail == Detail::Brief) { (left_out(tail)) }
                @for tail in &tails { (folded(tail)) }
            }
        } @else {
            @for tail in &tails {
                section id=(tail.id) { h2 { (tail.diagnosed.name()) } (section(tail)) }
            }
        }
    };
    framed("Diagnosis of performance models", &body)
}

/// Where the page has the diagnosis of this place in the order given.
pub(crate) fn anchor(number: usize) -> String {
    format!("tail-{}", number + 1)
}

/// So many tails lie open below each other; of more each is folded to a line. Our choice: a few screens.
const TAILS_UNFOLDED: usize = 3;

/// A diagnosis, its figures and its place on the page.
struct Tail<'a> {
    /// Unique on the page.
    id: String,
    diagnosed: &'a DiagnosedTail,
    figures: &'a DiagnosisFigures,
    /// What the comparison with its type says of it.
    of_fleet: Option<String>,
    /// Whether it has all charts and tables.
    detail: Detail,
    /// Segments drawn in a chart at most.
    most_points: usize,
}

impl Tail<'_> {
    /// Gaps before and, where effects are added, with all of them.
    fn before_and_after(&self) -> (Vec<f64>, Vec<f64>) {
        let segments = &self.figures.segments;
        (
            segments.iter().map(|segment| segment.before_percent).collect(),
            segments.iter().filter_map(|segment| segment.after_percent.last().copied()).collect(),
        )
    }

    /// Days of the first and the last segment.
    fn period(&self) -> Option<String> {
        let dates = self.figures.segments.iter().map(|segment| segment.date_s);
        let first = dates.clone().min_by(f64::total_cmp)?;
        let last = dates.max_by(f64::total_cmp)?;
        Some(dates::period(first, last))
    }
}

/// Version, period, counts and options, in a line.
fn head(reports: &ReportsSummary, tails: &[Tail<'_>], options: &[String]) -> String {
    let dates = || tails.iter().flat_map(|tail| &tail.figures.segments).map(|one| one.date_s);
    let mut told = vec![format!("cruisefit {}", env!("CARGO_PKG_VERSION"))];
    if let (Some(first), Some(last)) =
        (dates().min_by(f64::total_cmp), dates().max_by(f64::total_cmp))
    {
        told.push(format!("flown {}", dates::period(first, last)));
    }
    let mut types: BTreeMap<&str, usize> = BTreeMap::new();
    for tail in tails {
        *types.entry(tail.figures.type_code.as_str()).or_default() += 1;
    }
    let types: Vec<&str> = types.into_keys().filter(|code| !code.is_empty()).collect();
    told.push(format!("{} ({})", counted(tails.len(), "tail"), types.join(", ")));
    told.push(format!(
        "{} read, {} refused",
        counted(reports.read, "report"),
        reports.refused.len()
    ));
    told.extend(options.iter().cloned());
    format!("{}.", told.join("; "))
}

/// What the page of a large fleet leaves out to stay small.
fn left_out(tail: &Tail<'_>) -> Markup {
    html! {
        p.note {
            "The page of so many tails leaves out the gap of unseen flights, the table of all causes and the smallest effects that \
             flights would show (" code { "diagnosis.json" } " has them), and draws at most " (tail.most_points) " segments of a tail."
        }
    }
}

fn folded(tail: &Tail<'_>) -> Markup {
    html! {
        details.tail {
            summary { h3 { (tail.diagnosed.name()) } " " span { (verdict::short_of(tail)) } }
            // The anchor is inside: following a link to it unfolds the section.
            div id=(tail.id) { (section(tail)) }
        }
    }
}

fn section(tail: &Tail<'_>) -> Markup {
    let Tail { diagnosed, figures, .. } = tail;
    let diagnosis = &diagnosed.diagnosis;
    html! {
            p.run {
                (counted(diagnosis.flights, "flight")) " with " (counted(diagnosis.segments, "segment"))
                @if let Some(period) = tail.period() { ", " (period) }
                ". " (figures.aircraft) " (" (figures.type_code) "); model: " (figures.model) "."
            }
            (verdict::card(diagnosis, tail.of_fleet.as_deref()))
            @if !matches!(diagnosis.verdict, Verdict::InsufficientData(_)) && !figures.segments.is_empty() {
                (figures::figures(tail))
                (causes::causes(diagnosis))
                (causes::left(diagnosis, &figures.segments))
            }
            (causes::apart(diagnosis))
            (tables::tables(diagnosed, tail.detail))
    }
}
