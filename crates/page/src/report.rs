//! `report.html`: the result of a run.

use std::collections::{BTreeMap, BTreeSet};

use maud::{Markup, PreEscaped, html};
use pipeline::criteria_costs::CriteriaCosts;
use pipeline::evaluation::TailResult;
use pipeline::model_file::Learnt;
use pipeline::summary::{Summary, TailSummary, counted};

use crate::chart::dates;
use crate::fleet::FleetRow;
use crate::frame::framed;
use crate::place::{Detail, Place};
use crate::text::signed;
use crate::view::TailView;
use crate::{fleet, tail};

/// Largest number of points of a chart.
const MOST_POINTS: usize = 2000;
/// The same of all tails together where a page leaves charts out, and the least of a tail. Our choice: 200 tails stay below 6 MB.
const POINTS_OF_PAGE: usize = 60_000;
const FEWEST_POINTS: usize = 200;
/// Up to this many tails have all charts and tables on one page: at 2,000 points in each chart a page of about 2 MB.
pub(crate) const TAILS_IN_FULL: usize = 30;
/// Up to this many tails one page holds the charts of all, which can be mailed; of more, each has its own page.
pub const TAILS_ON_ONE_PAGE: usize = 200;

/// A tail's part of a page, as large as the number of tails allows: made tail by tail, so that a run need not hold all of them.
#[derive(Clone, Debug)]
pub struct Section {
    /// Tail.
    pub tail: String,
    id: String,
    headline: String,
    law: String,
    type_code: String,
    /// START of the first and of the last flight, s since 1970.
    period_s: Option<(f64, f64)>,
    adapted: bool,
    body: String,
}

/// The section of a tail, with what the trim criteria cost where that is known.
#[must_use]
pub fn section(result: &TailResult, costs: Option<&CriteriaCosts>, anchors: &Anchors) -> Section {
    let id = anchors.0.get(&result.tail).cloned().unwrap_or_default();
    let tails = anchors.0.len();
    // Of few on one page, and of those on pages of their own, nothing is left out.
    let (detail, most_points) = if tails > TAILS_IN_FULL && tails <= TAILS_ON_ONE_PAGE {
        (Detail::Brief, (POINTS_OF_PAGE / tails).clamp(FEWEST_POINTS, MOST_POINTS))
    } else {
        (Detail::Full, MOST_POINTS)
    };
    let place = Place { tail: &result.tail, id: id.clone(), most_points, detail };
    let view = TailView::new(result);
    let starts = || view.flights.iter().map(|flight| flight.start_s);
    Section {
        tail: result.tail.clone(),
        headline: tail::headline(result),
        law: law_of(result),
        type_code: result.model.initial.aircraft().type_code().to_owned(),
        period_s: starts().min_by(f64::total_cmp).zip(starts().max_by(f64::total_cmp)),
        adapted: result.summary.fuel_flow_error_percent.after.is_some(),
        body: tail::body(result, &view, costs, &place).into_string(),
        id,
    }
}

/// The page: `summary` and the details of each tail under a title.
#[must_use]
pub fn report(summary: &Summary, tails: &[TailResult], title: &str) -> String {
    let anchors = Anchors::new(tails.iter().map(|tail| tail.tail.as_str()));
    let sections: Vec<Section> = tails.iter().map(|tail| section(tail, None, &anchors)).collect();
    report_of_sections(summary, &sections.iter().collect::<Vec<_>>(), title)
}

/// The page of sections that were made before.
#[must_use]
pub fn report_of_sections(summary: &Summary, sections: &[&Section], title: &str) -> String {
    let by_tail: BTreeMap<&str, &Section> =
        sections.iter().map(|section| (section.tail.as_str(), *section)).collect();
    let rows = fleet_rows(summary, |summary| {
        let section = by_tail.get(summary.tail.as_str());
        FleetRow { summary, link: section.map(|section| format!("#{}", section.id)) }
    });
    let body = html! {
        p.run { (what_was_run(summary, sections)) }
        (fleet_section(&rows))
        (how_to_read(sections.iter().any(|section| section.adapted)))
        (fleet::refused(&summary.reports))
        section {
            h2 { "Tails" }
            @if sections.len() > 1 {
                p.note { "Each tail unfolds at a click on its line, or on its name in the table above. All are printed." }
            }
            @for (k, section) in sections.iter().enumerate() { (folded(section, k == 0)) }
        }
    };
    framed(title, &body)
}

/// The page of a fleet whose tails have pages of their own: `links` lead to them.
#[must_use]
pub fn fleet_report(summary: &Summary, links: &BTreeMap<&str, String>, title: &str) -> String {
    let adapted = summary.tails.iter().any(|tail| tail.fuel_flow_error_percent.after.is_some());
    let rows = fleet_rows(summary, |summary| FleetRow {
        summary,
        link: links.get(summary.tail.as_str()).cloned(),
    });
    let body = html! {
        p.run { (what_was_run(summary, &[])) }
        (fleet_section(&rows))
        p.note { "The name of a tail leads to its own page, a file in the folder beside this one: to forward or print a tail, take that." }
        (how_to_read(adapted))
        (fleet::refused(&summary.reports))
    };
    framed(title, &body)
}

/// A tail's own page.
#[must_use]
pub fn tail_page(section: &Section) -> String {
    let body = html! {
        p.run { "cruisefit " (env!("CARGO_PKG_VERSION")) "; " (section.law) "." }
        (folded(section, true))
        (how_to_read(section.adapted))
    };
    framed(&format!("Tail {}", section.tail), &body)
}

fn fleet_section(rows: &[FleetRow<'_>]) -> Markup {
    html! {
        section {
            h2 { "Fleet" }
            p { (in_short(rows)) }
            (fleet::overview(rows))
        }
    }
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

/// Rows of the fleet's table: what burns most beyond its prediction first, tails without an error last.
fn fleet_rows<'a>(
    summary: &'a Summary,
    row_of: impl Fn(&'a TailSummary) -> FleetRow<'a>,
) -> Vec<FleetRow<'a>> {
    let mut rows: Vec<FleetRow<'a>> = summary.tails.iter().map(row_of).collect();
    // A stable sort: of equal ones the order of the summary.
    let mean = |row: &FleetRow<'_>| {
        row.summary.fuel_flow_error_percent.before.mean.unwrap_or(f64::NEG_INFINITY)
    };
    rows.sort_by(|one, other| mean(other).total_cmp(&mean(one)));
    rows
}

/// The fleet in a sentence.
fn in_short(rows: &[FleetRow<'_>]) -> String {
    let means: Vec<(f64, &str)> = rows
        .iter()
        .filter_map(|row| {
            Some((row.summary.fuel_flow_error_percent.before.mean?, row.summary.tail.as_str()))
        })
        .collect();
    match (means.first(), means.last()) {
        (Some((most, first)), Some((least, last))) if means.len() > 1 => format!(
            "Against the models that they began with, tails lie between {} % ({last}) and {} % ({first}); positive: more is burnt \
             than predicted.",
            signed(Some(*least)),
            signed(Some(*most))
        ),
        (Some((mean, tail)), _) => format!(
            "{tail}: {} % against the model that it began with; positive: more is burnt than predicted.",
            signed(Some(*mean))
        ),
        _ => "No segment lies inside a table: no tail has an error.".to_owned(),
    }
}

/// Anchors of tails on a page: each name as far as an anchor can hold it, and a number where that is not unique.
#[derive(Clone, Debug)]
pub struct Anchors(BTreeMap<String, String>);

impl Anchors {
    /// Anchors of these tails.
    #[must_use]
    pub fn new<'a>(tails: impl Iterator<Item = &'a str>) -> Self {
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

/// Version, period, types, law, settings and counts, in a line.
fn what_was_run(summary: &Summary, sections: &[&Section]) -> String {
    let mut laws: Vec<&str> = Vec::new();
    for section in sections {
        if !laws.contains(&section.law.as_str()) {
            laws.push(&section.law);
        }
    }
    let reports = &summary.reports;
    let periods = || sections.iter().filter_map(|section| section.period_s);
    let first = periods().map(|(first, _)| first).min_by(f64::total_cmp);
    let last = periods().map(|(_, last)| last).max_by(f64::total_cmp);
    let mut words = vec![format!("cruisefit {}", env!("CARGO_PKG_VERSION"))];
    if let (Some(first), Some(last)) = (first, last) {
        words.push(format!("flown {}", dates::period(first, last)));
    }
    let types: BTreeSet<&str> = sections.iter().map(|section| section.type_code.as_str()).collect();
    if !types.is_empty() {
        words.push(format!("type {}", types.into_iter().collect::<Vec<_>>().join(", ")));
    }
    if summary.tails.is_empty() {
        words.push("no tail".to_owned());
    }
    words.extend(laws.into_iter().map(str::to_owned));
    words.push(reports.to_words());
    words.push(format!(
        "{}, {}, {}.",
        counted(summary.tails.len(), "tail"),
        counted(summary.tails.iter().map(|tail| tail.flights).sum::<usize>(), "flight"),
        counted(summary.tails.iter().map(|tail| tail.segments).sum::<usize>(), "segment"),
    ));
    words.join("; ")
}

/// Signs, units and words of the page.
fn how_to_read(adapted: bool) -> Markup {
    html! {
        details.more {
        summary { "How to read this page" }
        dl {
            dt { "error" }
            dd {
                "100 (recorded − predicted)/recorded, in % of total fuel flow (all engines), one for each segment. \
                 Positive: the aircraft burns more than the model predicts."
            }
            dt { "deviation, ±" }
            dd {
                "Mean error of the model that the tail began with (“before”), and half its 95 % interval. What a flight has in common \
                 (load sheet, heating value, sensors) does not average out within it: the interval counts flights, not segments."
            }
            dt { "fuel factor" }
            dd { "By how many per cent fuel flow by the guide has to be raised to be the recorded one, exp(d) − 1 with d the mean over flights of a flight's mean \
                ln(recorded/guide): flights count alike, however many segments they gave. The guide is taken by its \
                own rows; “before” is a polynomial through them, which may miss them by some per cent. It is of all flights at the \
                conditions flown; " code { "monitor" } " gives that of the level now, at the tail's mean conditions, which is another \
                where the tail has changed or flies other routes." }
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
                dd { "Share of the table's nodes that a segment has adapted (law paper), or that have learnt as much as one segment at the node would teach (law bayes)." }
                dt { "refits" }
                dd { "How often the polynomial was fitted again to the whole table." }
            }
            dt { "outside table" }
            dd { "Segments beyond the table's lift coefficients or Mach numbers. They have no error and are in no error figure." }
        }
        }
    }
}
