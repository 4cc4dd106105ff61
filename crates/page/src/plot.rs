//! Charts as a single SVG file, for a report or a slide: of one tail, of a diagnosis, of months, of blind trials.

use std::collections::BTreeMap;
use std::fmt::Write;

use diagnose::SegmentGap;
use maud::{Markup, html};
use pipeline::diagnosis_document::TailDiagnosis;
use pipeline::evaluation::TailResult;
use pipeline::monitoring::TailDocument;
use serde::Deserialize;

use crate::diagnosis::map::gap_map;
use crate::place::{Detail, Place};
use crate::style::STYLE;
use crate::view::TailView;
use crate::{matrix, monitoring, tail, waterfall};

pub use crate::matrix::Confusion;

/// Points of a chart at most; a figure of one tail may be large.
const MOST_POINTS: usize = 5000;
/// Room for the heading of a chart, and between charts.
const HEADING: f64 = 24.0;
const GAP: f64 = 16.0;
const COLUMNS: usize = 2;
/// A line of a legend, below its chart, and where its words begin.
const LEGEND_LINE: f64 = 17.0;
const LEGEND_WORDS: f64 = 34.0;
/// Left edge of the frame of a chart, under which its title and legend stand.
const FRAME: f64 = 64.0;

/// Names of the charts of a tail; `polars` are several.
pub const TAIL_CHARTS: [&str; 8] =
    ["histogram", "time", "forecast", "surface", "relief", "specific-range", "engines", "polar"];

/// Names of the charts of a diagnosis.
pub const DIAGNOSIS_CHARTS: [&str; 2] = ["waterfall", "gap-map"];

/// A chart cut out of a page: what is drawn, its size, its title, and what its legend says.
struct Drawing<'a> {
    id: &'a str,
    width: f64,
    height: f64,
    title: &'a str,
    marks: &'a str,
    /// The mark and the words of each line of the legend.
    legend: Vec<(&'a str, &'a str)>,
}

impl Drawing<'_> {
    fn height_with_legend(&self) -> f64 {
        self.height + LEGEND_LINE * self.legend.len() as f64
    }
}

/// Charts of one tail as a file of its own, those of these names ([`TAIL_CHARTS`]) or all; without segments, what there is of
/// the table alone. `None` where nothing is left to draw.
#[must_use]
pub fn plot(result: &TailResult, charts: &[&str]) -> Option<String> {
    let view = TailView::new(result);
    let place = Place {
        tail: &result.tail,
        id: "plot".to_owned(),
        most_points: MOST_POINTS,
        detail: Detail::Full,
    };
    let page = tail::figures(&view, &place).into_string();
    let named = |one: &Drawing<'_>| {
        let id = one.id.trim_start_matches("plot-");
        charts.is_empty() || charts.iter().any(|chart| id.starts_with(chart))
    };
    let of_table = |one: &Drawing<'_>| {
        ["plot-polar", "plot-surface", "plot-relief"].iter().any(|id| one.id.starts_with(id))
    };
    let empty = view.points.is_empty();
    let drawn: Vec<Drawing<'_>> =
        drawings(&page).into_iter().filter(|one| named(one) && (!empty || of_table(one))).collect();
    sheet(&result.tail, &drawn)
}

/// From the gap to the noise, of each diagnosis of a file, and where the gap is, of those whose segments are given by tail;
/// the charts of these names ([`DIAGNOSIS_CHARTS`]) or all.
#[must_use]
pub fn plot_diagnoses(
    diagnoses: &[TailDiagnosis],
    gaps: &BTreeMap<String, Vec<SegmentGap>>,
    charts: &[&str],
) -> Option<String> {
    let asked = |name: &str| charts.is_empty() || charts.contains(&name);
    let page = html! {
        @for (k, one) in diagnoses.iter().enumerate() {
            @if asked("waterfall") { (waterfall::waterfall(one, k)) }
            @if let Some(segments) = gaps.get(&one.tail).filter(|_| asked("gap-map")) {
                // A region that holds every segment marks nothing.
                @let marked = segments.iter().any(|segment| !segment.in_region);
                (gap_map(&format!("gap-{k}"), &one.tail, segments, marked))
            }
        }
    };
    let page = page.into_string();
    sheet("Diagnoses", &drawings(&page))
}

/// Deviation over time of tails as `monitor.json` has them.
#[must_use]
pub fn plot_months(tails: &[TailDocument]) -> Option<String> {
    let page = html! {
        @for (k, tail) in tails.iter().enumerate() { (monitoring::chart(tail, k, MOST_POINTS)) }
    };
    let page = page.into_string();
    sheet("Deviation over time", &drawings(&page))
}

/// A group of blind trials as `trials.json` has it: what is drawn of it.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct TrialConfusion {
    denied: serde_json::Value,
    background: serde_json::Value,
    times: f64,
    scores: TrialScores,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
struct TrialScores {
    confusion: Confusion,
}

impl TrialConfusion {
    fn name(&self) -> String {
        let words = |value: &serde_json::Value| {
            value.as_str().map_or_else(|| value.to_string(), str::to_owned)
        };
        format!(
            "model {}, background {}, {} times the typical size",
            words(&self.denied),
            words(&self.background),
            self.times
        )
    }
}

/// What was planted against what was found, a matrix for each group of blind trials.
#[must_use]
pub fn plot_trials(groups: &[TrialConfusion]) -> Option<String> {
    let page: Markup = html! {
        @for (k, group) in groups.iter().enumerate() { (matrix::matrix(&group.name(), &group.scores.confusion, k)) }
    };
    let page = page.into_string();
    sheet("Planted and found", &drawings(&page))
}

/// Charts on one sheet; `None` without charts.
fn sheet(title: &str, drawings: &[Drawing<'_>]) -> Option<String> {
    if drawings.is_empty() {
        return None;
    }
    let columns = COLUMNS.min(drawings.len());
    let width_of = |column: usize| {
        let of_column = drawings.iter().skip(column).step_by(columns);
        of_column.map(|one| one.width).fold(0.0, f64::max) + GAP
    };
    let lefts: Vec<f64> = (0..columns)
        .scan(GAP, |left, column| Some(std::mem::replace(left, *left + width_of(column))))
        .collect();
    let width = GAP + (0..columns).map(width_of).sum::<f64>();
    let mut top = GAP;
    let mut rows = String::new();
    for row in drawings.chunks(columns) {
        for (one, left) in row.iter().zip(&lefts) {
            draw(one, (*left, top), &mut rows);
        }
        top += row.iter().map(Drawing::height_with_legend).fold(0.0, f64::max) + HEADING + GAP;
    }
    Some(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {top}\" width=\"{width}\" height=\"{top}\" \
         font-family=\"sans-serif\">\n<title>{}</title>\n<style><![CDATA[{STYLE}]]></style>\n\
         <rect width=\"100%\" height=\"100%\" style=\"fill:var(--paper)\"/>\n{rows}</svg>\n",
        html! { (title) }.into_string()
    ))
}

/// A chart with its title and its legend.
fn draw(one: &Drawing<'_>, (left, top): (f64, f64), svg: &mut String) {
    let _ = write!(
        svg,
        "<g transform=\"translate({left} {top})\"><text x=\"{FRAME}\" y=\"14\" style=\"font-weight:600\">{}</text>\
         <g transform=\"translate(0 {HEADING})\">{}</g>",
        one.title, one.marks
    );
    for (line, (mark, words)) in one.legend.iter().enumerate() {
        let down = HEADING + one.height + LEGEND_LINE * line as f64;
        let _ = write!(
            svg,
            "<g transform=\"translate({FRAME} {down})\">{mark}<text x=\"{LEGEND_WORDS}\" y=\"10\">{words}</text></g>"
        );
    }
    svg.push_str("</g>\n");
}

/// The charts of a piece of a page, in order, each with the legend before it.
fn drawings(page: &str) -> Vec<Drawing<'_>> {
    let mut drawings = Vec::new();
    let mut legend = Vec::new();
    for drawing in page.split("<svg ").skip(1) {
        if let Some(line) = legend_line(drawing) {
            legend.push(line);
        } else if let Some(chart) = chart(drawing) {
            drawings.push(Drawing { legend: std::mem::take(&mut legend), ..chart });
        }
    }
    drawings
}

/// The mark and the words of a line of a legend.
fn legend_line(drawing: &str) -> Option<(&str, &str)> {
    let (mark, after) =
        drawing.strip_prefix("class=\"key\"")?.split_once('>')?.1.split_once("</svg>")?;
    Some((mark, after.split("</li>").next()?))
}

fn chart(drawing: &str) -> Option<Drawing<'_>> {
    let (head, rest) = drawing.split_once('>')?;
    let size = head.strip_prefix("viewBox=\"0 0 ").filter(|_| head.contains("role=\"img\""))?;
    let (width, height) = size.split_once('"')?.0.split_once(' ')?;
    let marks = rest.split("</svg>").next()?;
    let (id, after) = marks.split_once("<title id=\"")?.1.split_once("-title\"")?;
    let title = after.split_once('>')?.1.split("</title>").next()?;
    let (width, height) = (width.parse().ok()?, height.parse().ok()?);
    Some(Drawing { id, width, height, title, marks, legend: Vec::new() })
}
