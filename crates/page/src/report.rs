//! `report.html`: the result of a run.

use std::collections::{BTreeMap, BTreeSet};

use maud::{Markup, html};
use pipeline::evaluation::TailResult;
use pipeline::model_file::Learnt;
use pipeline::summary::Summary;

use crate::chart::dates;
use crate::fleet::FleetRow;
use crate::frame::framed;
use crate::place::Place;
use crate::text::{counted, signed};
use crate::view::TailView;
use crate::{fleet, tail};

/// Largest number of points of a chart.
const MOST_POINTS: usize = 2000;
/// Smallest number of points of a chart, however many tails there are.
const FEWEST_POINTS: usize = 200;
/// Points of one kind on the whole page: about 0.7 MB.
const POINTS_OF_PAGE: usize = 40_000;

/// The page: `summary` and the details of each tail under a title.
pub fn report(summary: &Summary, tails: &[TailResult], title: &str) -> String {
    let ids = ids(tails);
    let views: Vec<TailView> = tails.iter().map(TailView::of).collect();
    let most_points = (POINTS_OF_PAGE / tails.len().max(1)).clamp(FEWEST_POINTS, MOST_POINTS);
    let adapted = tails.iter().any(|tail| tail.summary.fuel_flow_error_percent.after.is_some());
    let rows = fleet_rows(summary, tails, &views, &ids);
    let body = html! {
        p.run { (what_was_run(summary, tails, &views)) }
        section {
            h2 { "Fleet" }
            p { (in_short(&rows)) }
            (fleet::overview(&rows))
        }
        (how_to_read(adapted))
        (fleet::refused(&summary.reports))
        section {
            h2 { "Tails" }
            @if tails.len() > 1 {
                p.note { "Each tail unfolds at a click on its line, or on its name in the table above. All are printed." }
            }
            @for (k, (result, view)) in tails.iter().zip(&views).enumerate() {
                @let id = ids.get(result.tail.as_str()).cloned().unwrap_or_default();
                (tail::section(result, view, &Place { tail: &result.tail, id, most_points }, k == 0))
            }
        }
    };
    framed(title, &body)
}

/// Rows of the fleet's table: what burns most beyond its prediction first, tails without an error last.
fn fleet_rows<'a>(
    summary: &'a Summary,
    tails: &[TailResult],
    views: &[TailView],
    ids: &BTreeMap<&str, String>,
) -> Vec<FleetRow<'a>> {
    let mut rows: Vec<FleetRow<'a>> = summary
        .tails
        .iter()
        .map(|summary| {
            let view = tails.iter().position(|tail| tail.tail == summary.tail).map(|k| &views[k]);
            FleetRow {
                summary,
                id: ids.get(summary.tail.as_str()).cloned(),
                half_width95: view.and_then(TailView::half_width95_before),
            }
        })
        .collect();
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

/// Anchors by tail: its name as far as an anchor can hold it, and a number where that is not unique.
fn ids(tails: &[TailResult]) -> BTreeMap<&str, String> {
    let plain = |tail: &str| -> String {
        tail.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect()
    };
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    let mut ids = BTreeMap::new();
    for tail in tails {
        let plain = format!("tail-{}", plain(&tail.tail));
        let times = taken.entry(plain.clone()).or_insert(0);
        *times += 1;
        // An underscore, which no plain name has: a numbered anchor is never another tail's plain one.
        let id = if *times == 1 { plain } else { format!("{plain}_{times}") };
        ids.insert(tail.tail.as_str(), id);
    }
    ids
}

/// Version, period, types, law, settings and counts, in a line.
fn what_was_run(summary: &Summary, tails: &[TailResult], views: &[TailView]) -> String {
    let mut laws: Vec<String> = Vec::new();
    for tail in tails {
        let law = match &tail.model.learnt {
            Some(Learnt { criteria, law, .. }) => {
                format!("{}, trim criteria {criteria}", law.told())
            }
            None => "initial model, nothing learnt".to_owned(),
        };
        if !laws.contains(&law) {
            laws.push(law);
        }
    }
    let reports = &summary.reports;
    let starts = || views.iter().flat_map(|view| &view.flights).map(|flight| flight.start_s);
    let period = match (starts().min_by(f64::total_cmp), starts().max_by(f64::total_cmp)) {
        (Some(first), Some(last)) => format!("flown {}", dates::period(first, last)),
        _ => "nothing flown".to_owned(),
    };
    let types: BTreeSet<&str> =
        tails.iter().map(|tail| tail.model.initial.aircraft().type_code()).collect();
    let types: Vec<&str> = types.into_iter().collect();
    format!(
        "cruisefit {}; {period}; type {}; {}; {} read, {} already known, {} refused; {}, {}, {}.",
        env!("CARGO_PKG_VERSION"),
        if types.is_empty() { "unknown".to_owned() } else { types.join(", ") },
        if laws.is_empty() { "no tail".to_owned() } else { laws.join("; ") },
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
            dd { "By how many per cent predicted fuel flow has to be raised to be the recorded one: 1/(1 − deviation) − 1." }
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
