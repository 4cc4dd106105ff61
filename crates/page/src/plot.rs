//! The charts of one tail as a single SVG file, for a report or a slide.

use std::fmt::Write;

use maud::html;
use pipeline::evaluation::TailResult;

use crate::place::{Detail, Place};
use crate::style::STYLE;
use crate::tail;
use crate::view::TailView;

/// Points of a chart at most; a figure of one tail may be large.
const MOST_POINTS: usize = 5000;
/// Room for the heading of a chart, and between charts.
const HEADING: f64 = 24.0;
const GAP: f64 = 16.0;
const COLUMNS: usize = 2;

/// A chart cut out of the page: what is drawn, its size and its title.
struct Drawing<'a> {
    width: f64,
    height: f64,
    title: &'a str,
    marks: &'a str,
}

/// Histogram of errors, errors over time and drag polars of one tail as a file of its own; without segments, the polars alone.
#[must_use]
pub fn plot(result: &TailResult) -> String {
    let view = TailView::new(result);
    let place = Place {
        tail: &result.tail,
        id: "plot".to_owned(),
        most_points: MOST_POINTS,
        detail: Detail::Brief,
    };
    let page = tail::figures(&view, &place).into_string();
    let empty = view.points.is_empty();
    let drawings: Vec<Drawing<'_>> =
        drawings(&page).filter(|one| !empty || one.title.contains("polar")).collect();
    let cell_width = drawings.iter().map(|one| one.width).fold(0.0, f64::max) + GAP;
    let cell_height = drawings.iter().map(|one| one.height).fold(0.0, f64::max) + HEADING + GAP;
    let rows = drawings.len().div_ceil(COLUMNS);
    let (width, height) = (cell_width * COLUMNS as f64 + GAP, cell_height * rows as f64 + GAP);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\">\n<title>{}</title>\n<style><![CDATA[{STYLE}]]></style>\n\
         <rect width=\"100%\" height=\"100%\" style=\"fill:var(--paper)\"/>\n",
        html! { (result.tail) }.into_string()
    );
    for (k, one) in drawings.iter().enumerate() {
        let (left, top) =
            (GAP + cell_width * (k % COLUMNS) as f64, GAP + cell_height * (k / COLUMNS) as f64);
        let _ = writeln!(
            svg,
            "<g transform=\"translate({left} {top})\"><text x=\"64\" y=\"14\" style=\"font-weight:600\">{}</text>\
             <g transform=\"translate(0 {HEADING})\">{}</g></g>",
            one.title, one.marks
        );
    }
    svg.push_str("</svg>\n");
    svg
}

/// The charts of a piece of a page, in order; the keys of legends are not among them.
fn drawings(page: &str) -> impl Iterator<Item = Drawing<'_>> {
    page.split("<svg ").skip(1).filter_map(|drawing| {
        let (head, rest) = drawing.split_once('>')?;
        let size = head.strip_prefix("viewBox=\"0 0 ").filter(|_| head.contains("role=\"img\""))?;
        let (width, height) = size.split_once('"')?.0.split_once(' ')?;
        let marks = rest.split("</svg>").next()?;
        let title = marks.split_once("<title")?.1.split_once('>')?.1.split("</title>").next()?;
        Some(Drawing { width: width.parse().ok()?, height: height.parse().ok()?, title, marks })
    })
}
