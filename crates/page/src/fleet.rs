//! The fleet: a chart and a table with one row per tail, and the reports that were refused.

use std::fmt::Write;

use maud::{Markup, html};

use crate::chart::{Axis, Chart, Mark};
use crate::text::{count, percent, plain, signed};
use pipeline::statistics::fuel_factor_percent;
use pipeline::summary::{FactorSummary, RefusedSummary, ReportsSummary, TailSummary};

/// Refused reports that are listed; more would make the page unreadable.
const MOST_REFUSED: usize = 200;
/// Tails from which on there is a chart of them: of fewer the table says as much.
const FEWEST_IN_A_CHART: usize = 3;

/// A tail in the fleet's table and chart.
pub(crate) struct FleetRow<'a> {
    pub(crate) summary: &'a TailSummary,
    /// Where its section or page is, if it has one.
    pub(crate) link: Option<String>,
}

/// The fuel factor of a tail; where an older program stored it without, the one that its mean error over segments makes.
pub(crate) fn fuel_factor(summary: &TailSummary) -> Option<FactorSummary> {
    let errors = &summary.fuel_flow_error_percent;
    summary.fuel_factor_percent.or_else(|| {
        let half = match errors.book {
            Some(_) => summary.book_half_width95_percent,
            None => summary.mean_error_half_width95_percent,
        };
        let mean = errors.against_book().mean?;
        Some(FactorSummary {
            value: fuel_factor_percent(mean),
            ci95: half.map(|half| [mean - half, mean + half].map(fuel_factor_percent)),
        })
    })
}

impl FleetRow<'_> {
    /// Mean error of the initial (or given) model, %.
    fn deviation(&self) -> Option<f64> {
        self.summary.fuel_flow_error_percent.before.mean
    }

    /// What a planner multiplies the guide by, less 1, %.
    fn fuel_factor_percent(&self) -> Option<f64> {
        fuel_factor(self.summary).map(|factor| factor.value)
    }

    /// Half width of the deviation's 95 % interval, %.
    fn half_width95(&self) -> Option<f64> {
        self.summary.mean_error_half_width95_percent
    }

    /// Ends of its interval, the mean itself without one.
    fn interval(&self) -> Option<(f64, f64)> {
        let (mean, half) = (self.deviation()?, self.half_width95().unwrap_or(0.0));
        Some((mean - half, mean + half))
    }
}

/// Scale of all intervals of the fleet, zero included.
fn scale(rows: &[FleetRow<'_>]) -> (f64, f64) {
    let intervals = rows.iter().filter_map(FleetRow::interval);
    intervals.fold((0.0, 0.0), |(low, high), (from, to)| (f64::min(low, from), f64::max(high, to)))
}

/// Chart and table of all tails; `rows` are those that burn most beyond the model's prediction first.
pub(crate) fn overview(rows: &[FleetRow<'_>]) -> Markup {
    html! {
        @if rows.len() >= FEWEST_IN_A_CHART { (chart(rows)) }
        (table(rows))
    }
}

/// Every tail's deviation with its interval, in order.
fn chart(rows: &[FleetRow<'_>]) -> Markup {
    let (low, high) = scale(rows);
    let chart = Chart {
        id: "fleet".to_owned(),
        title: "Deviation of every tail".to_owned(),
        description: format!(
            "Mean error of each of {} tails by the initial model with its 95 % interval, the largest first; the table below has \
             the numbers.",
            rows.len()
        ),
        width: 1000.0,
        height: 300.0,
        x: Axis::of_counts(rows.len() + 1, (rows.len() + 1).min(10)),
        y: Axis::around(low, high, 6),
        x_label: "tail, by rank".to_owned(),
        y_label: "deviation, %".to_owned(),
    };
    let places: Vec<(f64, f64)> = rows
        .iter()
        .enumerate()
        .filter_map(|(k, row)| Some((k as f64 + 1.0, row.deviation()?)))
        .collect();
    let marks = html! {
        (chart.horizontal(0.0, "zero"))
        @for (k, row) in rows.iter().enumerate() {
            @if let Some(interval) = row.interval() { (chart.interval(k as f64 + 1.0, interval, "interval", "")) }
        }
        (chart.marks(&places, Mark::Disc, "before"))
        @for (k, row) in rows.iter().enumerate() {
            @let across = (k as f64 + 0.5, k as f64 + 1.5);
            (chart.cell(across, (chart.y.first(), chart.y.last()), "hit", &tip(row)))
        }
    };
    html! {
        figure.wide {
            figcaption {
                b { "Deviation of every tail." } " Mean error of the model before it learnt these flights, with its 95 % interval \
                (flights count, not segments). The tail that burns most beyond its prediction is first."
            }
            div.scroll { (chart.draw(&marks)) }
        }
    }
}

fn tip(row: &FleetRow<'_>) -> String {
    let mut tip = format!("{}: {} %", row.summary.tail, signed(row.deviation()));
    if let Some(half) = row.half_width95() {
        let _ = write!(tip, " ± {half:.2} %");
    }
    if let Some(factor) = row.fuel_factor_percent() {
        let _ = write!(tip, "\nfuel factor {} %", signed(Some(factor)));
    }
    let _ = write!(tip, "\n{} flights, {} segments", row.summary.flights, row.summary.segments);
    tip
}

/// Table of all tails, in the order given.
fn table(rows: &[FleetRow<'_>]) -> Markup {
    let adapted = rows.iter().any(|row| row.summary.fuel_flow_error_percent.after.is_some());
    let refits = rows.iter().any(|row| row.summary.refits.is_some());
    let scale = scale(rows);
    html! {
        // Not a caption: it would be as wide as the table, beyond the edge of a phone.
        p.note { "Deviations and errors are in % of total fuel flow; ± is half a 95 % interval of the mean; std with n − 1; max without \
                  its sign. Deviation: of the model that each began with. Fuel factor: what fuel flow by the guide's rows has to be \
                  raised by, %." }
        div.scroll tabindex="0" role="region" aria-label="All tails" {
            table.fleet.sort.data data-name="fleet" {
                thead { tr {
                    th scope="col" { "tail" }
                    th scope="col" { "deviation" } th scope="col" { "±" } th.drawn scope="col" { "interval" }
                    th scope="col" { "fuel factor" } th scope="col" { "std" } th scope="col" { "max" }
                    @if adapted {
                        th.group scope="col" { "mean after" } th scope="col" { "std after" } th scope="col" { "max after" }
                        th scope="col" { "nodes informed" }
                    }
                    @if refits { th scope="col" { "refits" } }
                    th.group scope="col" { "flights" } th scope="col" { "new" } th scope="col" { "segments" }
                    th scope="col" { "outside table" }
                } }
                tbody { @for row in rows { (table_row(row, adapted, refits, scale)) } }
                @if rows.len() > 1 { tfoot { (totals(rows, adapted, refits)) } }
            }
        }
    }
}

fn table_row(row: &FleetRow<'_>, adapted: bool, refits: bool, scale: (f64, f64)) -> Markup {
    let summary = row.summary;
    let before = &summary.fuel_flow_error_percent.before;
    let after = summary.fuel_flow_error_percent.after;
    html! {
        tr {
            th scope="row" {
                @match &row.link {
                    Some(link) => { a href=(link) { (summary.tail) } }
                    None => { (summary.tail) }
                }
            }
            (number(before.mean, signed(before.mean)))
            (number(row.half_width95(), plain(row.half_width95())))
            td.drawn { (spark(row, scale)) }
            @let factor = row.fuel_factor_percent();
            (number(factor, signed(factor)))
            (number(before.std, plain(before.std)))
            (number(before.max_abs, plain(before.max_abs)))
            @if adapted {
                @let (mean, std, max) = after.map_or((None, None, None), |after| (after.mean, after.std, after.max_abs));
                td.group data-v=[mean] { (signed(mean)) }
                (number(std, plain(std)))
                (number(max, plain(max)))
                (number(summary.informed_nodes, percent(summary.informed_nodes)))
            }
            @if refits { (number(summary.refits.map(f64::from), count(summary.refits))) }
            td.group data-v=(summary.flights) { (summary.flights) }
            (number(Some(summary.flights_new as f64), summary.flights_new.to_string()))
            (number(Some(summary.segments as f64), summary.segments.to_string()))
            (number(Some(summary.outside_table as f64), summary.outside_table.to_string()))
        }
    }
}

/// A cell with the number by which it is sorted.
fn number(value: Option<f64>, words: impl Into<String>) -> Markup {
    let words: String = words.into();
    html! { td data-v=[value] { (words) } }
}

/// The interval as a small drawing on the fleet's scale; the numbers stand beside it.
fn spark(row: &FleetRow<'_>, (low, high): (f64, f64)) -> Markup {
    let length = (high - low).max(f64::MIN_POSITIVE);
    let at = |value: f64| 4.0 + 136.0 * (value - low) / length;
    html! {
        @if let (Some(mean), Some((from, to))) = (row.deviation(), row.interval()) {
            svg.spark viewBox="0 0 144 14" aria-hidden="true" {
                path class="frame" d=(format!("M{:.1} 0V14", at(0.0))) {}
                path class="interval" d=(format!("M{:.1} 7H{:.1}", at(from), at(to))) {}
                path class="disc before" d=(format!("M{:.1} 7h0", at(mean))) {}
            }
        }
    }
}

fn totals(rows: &[FleetRow<'_>], adapted: bool, refits: bool) -> Markup {
    let sum = |of: fn(&TailSummary) -> usize| rows.iter().map(|row| of(row.summary)).sum::<usize>();
    let columns = 5 + if adapted { 4 } else { 0 } + usize::from(refits);
    html! {
        tr {
            th scope="row" { (rows.len()) " tails" }
            td.drawn {}
            td colspan=(columns) {}
            td { (sum(|tail| tail.flights)) }
            td { (sum(|tail| tail.flights_new)) }
            td { (sum(|tail| tail.segments)) }
            td { (sum(|tail| tail.outside_table)) }
        }
    }
}

/// The refused reports, with position and reason.
pub(crate) fn refused(reports: &ReportsSummary) -> Markup {
    html! {
        @if !reports.refused.is_empty() {
            section {
                h2 { "Refused reports" }
                p { "No figure on this page includes them." }
                div.scroll { table.refused {
                    thead { tr {
                        th scope="col" { "file:line:column" }
                        th scope="col" { "found and expected" }
                    } }
                    tbody {
                        @for refused in reports.refused.iter().take(MOST_REFUSED) {
                            tr {
                                th scope="row" { code { (position(refused)) } }
                                td { (refused.reason) }
                            }
                        }
                    }
                } }
                @if reports.refused.len() > MOST_REFUSED {
                    p.note {
                        "The first " (MOST_REFUSED) " of " (reports.refused.len()) "; summary.json lists all."
                    }
                }
            }
        }
    }
}

fn position(refused: &RefusedSummary) -> String {
    let mut position = refused.path.clone();
    for number in [refused.line, refused.line.and(refused.column)].into_iter().flatten() {
        let _ = write!(position, ":{number}");
    }
    position
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_is_as_exact_as_known() {
        let mut refused = RefusedSummary {
            path: "a/b.txt".to_owned(),
            line: Some(12),
            column: Some(4),
            reason: String::new(),
        };
        assert_eq!(position(&refused), "a/b.txt:12:4");
        refused.column = None;
        assert_eq!(position(&refused), "a/b.txt:12");
        refused.line = None;
        assert_eq!(position(&refused), "a/b.txt");
    }
}
