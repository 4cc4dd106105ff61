//! `report.html`: the result of a run.

use std::collections::BTreeMap;

use maud::{Markup, PreEscaped, html};
use pipeline::evaluation::TailResult;
use pipeline::model_file::Learnt;
use pipeline::summary::Summary;

use crate::frame::framed;
use crate::place::Place;
use crate::text::counted;
use crate::{fleet, tail};

/// Largest number of points of a chart.
const MOST_POINTS: usize = 2000;
/// Up to this many tails one page holds the charts of all; of more, each has its own page. At [`MOST_POINTS`] points in
/// each chart this is a page of about 2 MB.
pub const TAILS_ON_ONE_PAGE: usize = 30;
/// Up to this many tails all are printed, folded or not.
const TAILS_PRINTED: usize = 8;

/// A tail's part of a page: made tail by tail, so that a run need not hold all of them.
#[derive(Clone, Debug)]
pub struct Section {
    /// Tail.
    pub tail: String,
    id: String,
    headline: String,
    law: String,
    adapted: bool,
    body: String,
}

/// The section of a tail.
#[must_use]
pub fn section(result: &TailResult, anchors: &Anchors) -> Section {
    let id = anchors.0.get(&result.tail).cloned().unwrap_or_default();
    let place = Place { tail: &result.tail, id: id.clone(), most_points: MOST_POINTS };
    Section {
        tail: result.tail.clone(),
        headline: tail::headline(result),
        law: law_of(result),
        adapted: result.summary.fuel_flow_error_percent.after.is_some(),
        body: tail::body(result, &place).into_string(),
        id,
    }
}

/// The page: `summary` and the details of each tail under a title.
#[must_use]
pub fn report(summary: &Summary, tails: &[TailResult], title: &str) -> String {
    let anchors = Anchors::of(tails.iter().map(|tail| tail.tail.as_str()));
    let sections: Vec<Section> = tails.iter().map(|tail| section(tail, &anchors)).collect();
    report_of_sections(summary, &sections.iter().collect::<Vec<_>>(), title)
}

/// The page of sections that were made before.
#[must_use]
pub fn report_of_sections(summary: &Summary, sections: &[&Section], title: &str) -> String {
    let ids: BTreeMap<&str, &str> =
        sections.iter().map(|section| (section.tail.as_str(), section.id.as_str())).collect();
    let link = |tail: &str| ids.get(tail).map(|id| format!("#{id}"));
    let body = html! {
        p.run { (what_was_run(summary, sections)) }
        (how_to_read(sections.iter().any(|section| section.adapted)))
        section {
            h2 { "Fleet" }
            (fleet::table(summary, link))
        }
        (fleet::refused(&summary.reports))
        section {
            h2 { "Tails" }
            @if sections.len() > 1 {
                p.note {
                    "Each tail unfolds at a click on its line, or on its name in the table above."
                    @if sections.len() > TAILS_PRINTED { " Only unfolded tails are printed." }
                }
            }
            @for (k, section) in sections.iter().enumerate() { (folded(section, k == 0)) }
        }
    };
    framed(title, sections.len() <= TAILS_PRINTED, &body)
}

/// The page of a fleet whose tails have pages of their own: `links` lead to them.
#[must_use]
pub fn fleet_report(summary: &Summary, links: &BTreeMap<&str, String>, title: &str) -> String {
    let adapted = summary.tails.iter().any(|tail| tail.fuel_flow_error_percent.after.is_some());
    let body = html! {
        p.run { (what_was_run(summary, &[])) }
        (how_to_read(adapted))
        section {
            h2 { "Fleet" }
            p.note { "The name of a tail leads to its own page." }
            (fleet::table(summary, |tail| links.get(tail).cloned()))
        }
        (fleet::refused(&summary.reports))
    };
    framed(title, false, &body)
}

/// A tail's own page.
#[must_use]
pub fn tail_page(section: &Section) -> String {
    let body = html! {
        p.run { "cruisefit " (env!("CARGO_PKG_VERSION")) "; " (section.law) "." }
        (how_to_read(section.adapted))
        (folded(section, true))
    };
    framed(&format!("Tail {}", section.tail), true, &body)
}

fn folded(section: &Section, open: bool) -> Markup {
    html! {
        details.tail open[open] {
            summary { h3 { (section.tail) } " " span { (section.headline) } }
            // The anchor is inside: following a link to it unfolds the section.
            div id=(section.id) { (PreEscaped(&section.body)) }
        }
    }
}

/// Anchors of tails on a page: each name as far as an anchor can hold it, and a number where that is not unique.
#[derive(Clone, Debug)]
pub struct Anchors(BTreeMap<String, String>);

impl Anchors {
    /// Anchors of these tails.
    #[must_use]
    pub fn of<'a>(tails: impl Iterator<Item = &'a str>) -> Self {
        let plain = |tail: &str| -> String {
            tail.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect()
        };
        let mut taken: BTreeMap<String, usize> = BTreeMap::new();
        let mut ids = BTreeMap::new();
        for tail in tails {
            let plain = format!("tail-{}", plain(tail));
            let times = taken.entry(plain.clone()).or_insert(0);
            *times += 1;
            // An underscore, which no plain name has: a numbered anchor is never another tail's plain one.
            let id = if *times == 1 { plain } else { format!("{plain}_{times}") };
            ids.insert(tail.to_owned(), id);
        }
        Self(ids)
    }
}

fn law_of(result: &TailResult) -> String {
    match &result.model.learnt {
        Some(Learnt { criteria, law, .. }) => {
            format!("{}, trim criteria {criteria}", law.told())
        }
        None => "initial model, nothing learnt".to_owned(),
    }
}

/// Version, law, settings and counts, in a line.
fn what_was_run(summary: &Summary, sections: &[&Section]) -> String {
    let mut laws: Vec<&str> = Vec::new();
    for section in sections {
        if !laws.contains(&section.law.as_str()) {
            laws.push(&section.law);
        }
    }
    let laws = match (laws.is_empty(), summary.tails.is_empty()) {
        (false, _) => format!("{}; ", laws.join("; ")),
        (true, true) => "no tail; ".to_owned(),
        (true, false) => String::new(),
    };
    let reports = &summary.reports;
    format!(
        "cruisefit {}; {laws}{} read, {} already known, {} refused; {}, {}, {}.",
        env!("CARGO_PKG_VERSION"),
        counted(reports.read, "report"),
        reports.already_known,
        reports.refused.len(),
        counted(summary.tails.len(), "tail"),
        counted(summary.tails.iter().map(|tail| tail.flights).sum(), "flight"),
        counted(summary.tails.iter().map(|tail| tail.segments).sum(), "segment"),
    )
}

/// Signs, units and words of the page.
fn how_to_read(adapted: bool) -> Markup {
    html! {
        dl {
            dt { "error" }
            dd {
                "100 (recorded − predicted)/recorded, in % of total fuel flow (all engines), one for each segment. \
                 Positive: the aircraft burns more than the model predicts."
            }
            dt { "segment" }
            dd { "A stabilised piece of cruise, and the mean state over it." }
            @if adapted {
                dt { "before, after" }
                dd {
                    "Error of the initial table and of the final one, over all segments inside the table, those included \
                     from which the final table was learnt: “after” is how well the model fits what was flown, not a \
                     forecast."
                }
                dt { "nodes informed" }
                dd { "Share of the table's nodes that a segment has ever adapted. Elsewhere the model has learnt nothing from flights." }
                dt { "refits" }
                dd { "How often the polynomial was fitted again to the whole table." }
            }
            dt { "outside table" }
            dd { "Segments beyond the table's lift coefficients or Mach numbers. They have no error and are in no error figure." }
        }
    }
}
