//! `report.html`: the result of a run.

use std::collections::BTreeMap;

use maud::{Markup, html};
use pipeline::evaluation::TailResult;
use pipeline::model_file::Learnt;
use pipeline::summary::Summary;

use crate::frame::framed;
use crate::place::Place;
use crate::text::counted;
use crate::{fleet, tail};

/// Largest number of points of a chart.
const MOST_POINTS: usize = 2000;
/// Smallest number of points of a chart, however many tails there are.
const FEWEST_POINTS: usize = 200;
/// Points of one kind on the whole page: about 1 MB.
const POINTS_OF_PAGE: usize = 60_000;
/// Up to this many tails all are printed, folded or not.
const TAILS_PRINTED: usize = 8;

/// The page: `summary` and the details of each tail under a title.
pub fn report(summary: &Summary, tails: &[TailResult], title: &str) -> String {
    let ids = ids(tails);
    let most_points = (POINTS_OF_PAGE / tails.len().max(1)).clamp(FEWEST_POINTS, MOST_POINTS);
    let adapted = tails.iter().any(|tail| tail.summary.fuel_flow_error_percent.after.is_some());
    let body = html! {
        p.run { (what_was_run(summary, tails)) }
        (how_to_read(adapted))
        section {
            h2 { "Fleet" }
            (fleet::table(summary, |tail| ids.get(tail).cloned()))
        }
        (fleet::refused(&summary.reports))
        section {
            h2 { "Tails" }
            @if tails.len() > 1 {
                p.note {
                    "Each tail unfolds at a click on its line, or on its name in the table above."
                    @if tails.len() > TAILS_PRINTED { " Only unfolded tails are printed." }
                }
            }
            @for (k, result) in tails.iter().enumerate() {
                @let id = ids.get(result.tail.as_str()).cloned().unwrap_or_default();
                (tail::section(result, &Place { tail: &result.tail, id, most_points }, k == 0))
            }
        }
    };
    framed(title, tails.len() <= TAILS_PRINTED, &body)
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

/// Version, law, settings and counts, in a line.
fn what_was_run(summary: &Summary, tails: &[TailResult]) -> String {
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
    format!(
        "cruisefit {}; {}; {} read, {} already known, {} refused; {}, {}, {}.",
        env!("CARGO_PKG_VERSION"),
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
