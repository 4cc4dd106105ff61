//! The gap of flights that neither choice nor fit has seen, flight by flight.

use diagnose::HeldOutFlight;
use maud::{Markup, html};

use super::Tail;
use super::figures::{chart, mean};
use crate::chart::{Axis, Key, Mark, dates, legend};
use pipeline::summary::counted;

/// The chart; nothing where closure is not measured.
pub(super) fn unseen(tail: &Tail<'_>) -> Markup {
    let flights = &tail.diagnosed.diagnosis.held_out;
    let segments = &tail.figures.segments;
    let dates_s: Vec<f64> = segments
        .chunk_by(|one, other| one.flight == other.flight)
        .filter_map(|flight| mean(&flight.iter().map(|one| one.date_s).collect::<Vec<f64>>()))
        .collect();
    // Both are of the flights that the diagnosis used, in its order.
    if flights.is_empty() || flights.len() != dates_s.len() {
        return html! {};
    }
    let points = |of: fn(&HeldOutFlight) -> f64| -> Vec<(f64, f64)> {
        dates_s.iter().copied().zip(flights.iter().map(of)).collect()
    };
    let (before, after) =
        (points(|one| one.before_rms_percent), points(|one| one.after_rms_percent));
    let noise = points(|one| one.noise_rms_percent);
    let highest = before.iter().chain(&after).map(|point| point.1).fold(0.0, f64::max);
    let less = flights.iter().filter(|one| one.after_rms_percent < one.before_rms_percent).count();
    let (first, last) = dates_s
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(*at), high.max(*at)));
    let told = format!("Less is left of {less} of {}.", counted(flights.len(), "flight"));
    let chart = crate::chart::Chart {
        description: format!("Root mean square of each flight's gap before and after. {told}"),
        x_label: "date, UTC".to_owned(),
        y_label: "gap, % rms".to_owned(),
        ..chart(
            tail,
            "gap of unseen flights",
            dates::axis(first, last, 5),
            Axis::around(0.0, highest, 6),
        )
    };
    let marks = html! {
        @for ((at, before), (_, after)) in before.iter().zip(&after) {
            (chart.interval(*at, (*before, *after), "span", ""))
        }
        (chart.polyline(&noise, "mean"))
        (chart.marks(&before, Mark::Ring, "before"))
        (chart.marks(&after, Mark::Disc, "after"))
    };
    html! {
        figure {
            figcaption {
                b { "Flights that it was not fitted to." }
                " The gap of each flight, before and with what the flights of the other four fifths would add. " (told)
            }
            (legend(&[
                (Key::Mark(Mark::Ring), "before", "before"),
                (Key::Mark(Mark::Disc), "after", "after"),
                (Key::Line, "mean", "noise alone"),
            ]))
            (chart.draw(&marks))
        }
    }
}
