//! The fleet: one row per tail, and the reports that were refused.

use std::fmt::Write;

use maud::{Markup, html};

use crate::text::{count, percent, plain, signed};
use pipeline::statistics::ErrorStatistics;
use pipeline::summary::{RefusedSummary, ReportsSummary, Summary, TailSummary};

/// Refused reports that are listed; more would make the page unreadable.
const MOST_REFUSED: usize = 200;

/// Table of all tails, in the order given. `link_of` leads to what there is of a tail.
pub(crate) fn table(summary: &Summary, link_of: impl Fn(&str) -> Option<String>) -> Markup {
    let adapted = summary.tails.iter().any(|tail| tail.fuel_flow_error_percent.after.is_some());
    html! {
        div.scroll {
            table.fleet {
                caption { "Errors are in % of total fuel flow; std with n − 1; max is the largest without its sign." }
                thead {
                    tr {
                        th scope="col" rowspan="2" { "tail" }
                        th scope="colgroup" colspan="2" { "flights" }
                        th scope="col" rowspan="2" { "samples" }
                        th scope="col" rowspan="2" { "segments" }
                        th scope="col" rowspan="2" { "outside table" }
                        @if adapted {
                            th scope="col" rowspan="2" { "nodes informed" }
                            th scope="col" rowspan="2" { "refits" }
                        }
                        th.group scope="colgroup" colspan="3" { @if adapted { "error before" } @else { "error" } }
                        @if adapted { th.group scope="colgroup" colspan="3" { "error after" } }
                    }
                    tr {
                        th scope="col" { "all" }
                        th scope="col" { "new" }
                        @for _ in 0..if adapted { 2 } else { 1 } {
                            th.group scope="col" { "mean" }
                            th scope="col" { "std" }
                            th scope="col" { "max" }
                        }
                    }
                }
                tbody {
                    @for tail in &summary.tails { (row(tail, adapted, link_of(&tail.tail))) }
                }
                @if summary.tails.len() > 1 { tfoot { (totals(&summary.tails, adapted)) } }
            }
        }
    }
}

fn row(tail: &TailSummary, adapted: bool, link: Option<String>) -> Markup {
    let errors = &tail.fuel_flow_error_percent;
    html! {
        tr {
            th scope="row" {
                @match link {
                    Some(link) => { a href=(link) { (tail.tail) } }
                    None => { (tail.tail) }
                }
            }
            td { (tail.flights) }
            td { (tail.flights_new) }
            td { (tail.samples) }
            td { (tail.segments) }
            td { (tail.outside_table) }
            @if adapted {
                td { (percent(tail.informed_nodes)) }
                td { (count(tail.refits)) }
            }
            (statistics(Some(&errors.before)))
            @if adapted { (statistics(errors.after.as_ref())) }
        }
    }
}

fn statistics(statistics: Option<&ErrorStatistics>) -> Markup {
    html! {
        td.group { (signed(statistics.and_then(|s| s.mean))) }
        td { (plain(statistics.and_then(|s| s.std))) }
        td { (plain(statistics.and_then(|s| s.max_abs))) }
    }
}

fn totals(tails: &[TailSummary], adapted: bool) -> Markup {
    let sum = |of: fn(&TailSummary) -> usize| tails.iter().map(of).sum::<usize>();
    html! {
        tr {
            th scope="row" { (tails.len()) " tails" }
            td { (sum(|tail| tail.flights)) }
            td { (sum(|tail| tail.flights_new)) }
            td { (tails.iter().map(|tail| tail.samples).sum::<u64>()) }
            td { (sum(|tail| tail.segments)) }
            td { (sum(|tail| tail.outside_table)) }
            td colspan=(if adapted { 8 } else { 3 }) {}
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
                table.refused {
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
                }
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
