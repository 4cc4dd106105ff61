//! The section of one tail.

use maud::{Markup, html};

use crate::fleet::fuel_factor;
use crate::place::{Detail, Place};
use crate::text::{plain, signed};
use crate::view::TailView;
use crate::{criteria, envelope, errors, performance, polars, relief, surface};
use pipeline::criteria_costs::CriteriaCosts;
use pipeline::evaluation::TailResult;
use pipeline::statistics::{ErrorStatistics, error_percent};
use pipeline::summary::{FactorSummary, counted};

/// Deviation beyond which units or the guide are more probable causes than the aircraft, %: `add_an_aircraft` in the book.
const RARELY_THE_AIRCRAFT_PERCENT: f64 = 15.0;
/// Difference of two mean errors that a reader who meets both should have explained, %. Our choice.
const WORTH_A_WORD_PERCENT: f64 = 0.1;

/// What is in a tail's section.
pub(crate) fn body(
    result: &TailResult,
    view: &TailView,
    costs: Option<&CriteriaCosts>,
    place: &Place<'_>,
) -> Markup {
    html! {
        (verdict(result, view))
        p.run { (about(result)) }
        (figures(view, place))
        @if let Some(costs) = costs { (criteria::costs(costs)) }
        (notes(result, view))
    }
}

/// All charts and tables of a tail.
pub(crate) fn figures(view: &TailView, place: &Place<'_>) -> Markup {
    let bins = errors::bins(view);
    html! {
        div.figures {
            (errors::histogram(view, &bins, place))
            (errors::over_time(view, &bins, place))
            (errors::before_learning(view, place))
            @if place.detail == Detail::Full {
                (surface::surface(view, place))
                (relief::relief(view, place))
                (performance::specific_range(view, place))
                (performance::engines(view, place))
            }
        }
        @if place.detail == Detail::Brief {
            p.note { "The page of so many tails leaves out the drag surface (map and three dimensions), specific range and engines." }
        }
        (polars::polars(view, place))
        div.row {
            (envelope::envelope(view))
            (errors::flights_apart(view))
        }
    }
}

/// A tail's figures in a line.
pub(crate) fn headline(result: &TailResult) -> String {
    let summary = &result.summary;
    let errors = &summary.fuel_flow_error_percent;
    let words = |statistics: &ErrorStatistics| {
        format!(
            "mean\u{a0}{}\u{a0}%, std\u{a0}{}\u{a0}%",
            signed(statistics.mean),
            plain(statistics.std)
        )
    };
    let counts = format!(
        "{}, {}; error ",
        counted(summary.flights, "flight"),
        counted(summary.segments, "segment")
    );
    match &errors.after {
        Some(after) => format!("{counts}before {}; after {}", words(&errors.before), words(after)),
        None => format!("{counts}{}", words(&errors.before)),
    }
}

/// Flights from which on a page states an interval of their mean: that of two is thirteen of its standard deviations wide. Our choice.
const FEWEST_OF_AN_INTERVAL: usize = 3;

/// What was found, in plain words.
fn verdict(result: &TailResult, view: &TailView) -> Markup {
    let errors = &result.summary.fuel_flow_error_percent;
    let book = errors.book.and_then(|book| book.mean);
    let summary = &result.summary;
    let Some(FactorSummary { value: factor, ci95 }) = fuel_factor(summary) else {
        return html! { p.verdict { "No segment lies inside the table: nothing can be said about this tail." } };
    };
    let few = summary.flights < FEWEST_OF_AN_INTERVAL;
    let interval = ci95.filter(|_| !few);
    let within = interval.is_some_and(|[low, high]| low <= 0.0 && high >= 0.0);
    let flights = counted(summary.flights, "flight");
    let says = match book {
        Some(_) => "its guide says",
        None if view.adapted => "the model that it began with predicts",
        None => "its model predicts",
    };
    let before = errors
        .before
        .mean
        .filter(|before| book.is_some_and(|book| (book - before).abs() >= WORTH_A_WORD_PERCENT));
    html! {
        div.verdict.gap[!within] {
            p {
                b {
                    @if within { "It burns what " (says) ", as far as these flights tell" }
                    @else {
                        @if few { "On " (flights) " it burned " } @else { "It burns " }
                        (format!("{:.2}", factor.abs())) " % "
                        @if factor > 0.0 { "more" } @else { "less" } " than " (says)
                    }
                }
                ": fuel factor " (signed(Some(factor))) " %"
                @if let Some([low, high]) = interval { " (" (signed(Some(low))) " to " (signed(Some(high))) " %, 95 %)" }
                @if few { ", too few flights for an interval: others may show another" } @else { ", mean of all flights" }
                ". As an error, in % of recorded fuel flow: " (signed(Some(error_percent(factor))))
                @if let Some([low, high]) = interval.map(|ends| ends.map(error_percent)) {
                    " (" (signed(Some(low))) " to " (signed(Some(high))) ")"
                }
                "."
                @if let Some(period) = view.period() { " Flown " (period) "." }
            }
            @if let Some(before) = before {
                p {
                    "The model that it began with is a polynomial through the guide's rows, which it misses here: its own mean error is "
                    (signed(Some(before))) " %, “before”."
                }
            }
            @if let Some(after) = &errors.after {
                p {
                    "With what was learnt the model leaves " (signed(after.mean)) " % in the mean and " (plain(after.std))
                    " % of scatter on the same flights."
                }
            }
            @if error_percent(factor).abs() > RARELY_THE_AIRCRAFT_PERCENT {
                p { "A deviation beyond ±" (RARELY_THE_AIRCRAFT_PERCENT) " % is rarely the aircraft: check units, masses and the guide first." }
            }
        }
    }
}

fn about(result: &TailResult) -> String {
    let aircraft = result.model.initial.aircraft();
    let guide = &result.model.guide;
    format!(
        "{}, type {}. The initial model's guide has {} rows from lift coefficient {:.3} to {:.3} and Mach number \
         {:.3} to {:.3}.",
        aircraft.name(),
        aircraft.type_code(),
        guide.points,
        guide.lift_coefficient.0,
        guide.lift_coefficient.1,
        guide.mach.0,
        guide.mach.1
    )
}

fn notes(result: &TailResult, view: &TailView) -> Markup {
    let mut notes = Vec::new();
    notes.extend(envelope::outside(view));
    if let Some(first) = view.not_observed.first() {
        notes.push(format!(
            "{} give no drag, so they have no error and are in no figure; the first: {first}.",
            counted(view.not_observed.len(), "segment")
        ));
    }
    let assumed = result.rows.iter().filter(|row| row.segment.temperature_assumed).count();
    if assumed > 0 {
        notes.push(format!(
            "Static air temperature is an assumption, not a recording, in {}.",
            counted(assumed, "segment")
        ));
    }
    html! {
        @if !(notes.is_empty() && result.notes.is_empty()) {
            h4 { "Notes on the data" }
            ul {
                @for note in notes.iter().chain(&result.notes) { li { (note) } }
            }
        }
    }
}
