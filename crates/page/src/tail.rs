//! The section of one tail.

use maud::{Markup, html};

use crate::place::Place;
use crate::text::{counted, plain, signed};
use crate::view::TailView;
use crate::{envelope, errors, polars};
use pipeline::evaluation::TailResult;
use pipeline::statistics::ErrorStatistics;

/// What is in a tail's section.
pub(crate) fn body(result: &TailResult, place: &Place<'_>) -> Markup {
    let view = TailView::of(result);
    html! {
        p { (about(result)) }
        (figures(&view, place))
        (notes(result, &view))
    }
}

/// All charts and tables of a tail.
pub(crate) fn figures(view: &TailView, place: &Place<'_>) -> Markup {
    let bins = errors::bins(view);
    html! {
        div.figures {
            (errors::histogram(view, &bins, place))
            (errors::over_time(view, &bins, place))
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
