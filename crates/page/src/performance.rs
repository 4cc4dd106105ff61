//! Cruise performance: specific range over gross mass, and the engines against each other.

use maud::{Markup, html};

use crate::chart::{Axis, Chart, Key, Mark, dates, legend, thinned};
use crate::place::Place;
use crate::text::signed;
use crate::view::{Cruise, TailView};
use pipeline::summary::counted;

const WIDTH: f64 = 500.0;
const HEIGHT: f64 = 290.0;
/// Points of these charts at most. Our choice: a cloud of as many is as dense as the eye can use.
const MOST_POINTS: usize = 300;
/// Classes of the engines' marks, by engine; shape repeats the colour.
const ENGINES: [(Mark, &str); 4] =
    [(Mark::Disc, "before"), (Mark::Ring, "after"), (Mark::Disc, "after"), (Mark::Ring, "before")];

/// How the marks of an engine look, numbered from 0.
pub(crate) const fn engine_look(engine: usize) -> (Mark, &'static str) {
    ENGINES[engine % ENGINES.len()]
}

/// The legend of the engines, with what is said of each.
pub(crate) fn engine_entries(words: &[String]) -> Vec<(Key, &'static str, &str)> {
    words
        .iter()
        .enumerate()
        .map(|(engine, words)| {
            let (mark, class) = engine_look(engine);
            (Key::Mark(mark), class, words.as_str())
        })
        .collect()
}

/// Recorded and predicted specific range over gross mass.
pub(crate) fn specific_range(view: &TailView, place: &Place<'_>) -> Markup {
    let shown = thinned(view.cruise.len(), MOST_POINTS.min(place.most_points));
    let points = |of: fn(&Cruise) -> f64| -> Vec<(f64, f64)> {
        shown.iter().map(|k| (view.cruise[*k].mass_t, of(&view.cruise[*k]))).collect()
    };
    let (recorded, predicted) = (points(|one| one.specific_range), points(|one| one.predicted));
    if recorded.is_empty() {
        return html! {};
    }
    let range = |values: Vec<f64>| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        Axis::around(low, values.iter().copied().fold(f64::NEG_INFINITY, f64::max), 6)
    };
    let chart = Chart {
        id: place.id("specific-range"),
        title: format!("{}: specific range over gross mass", place.tail),
        description: format!(
            "Specific range recorded and predicted by the present model, in {}.",
            counted(view.cruise.len(), "segment")
        ),
        width: WIDTH,
        height: HEIGHT,
        x: range(recorded.iter().map(|point| point.0).collect()),
        y: range(recorded.iter().chain(&predicted).map(|point| point.1).collect()),
        x_label: "gross mass, t".to_owned(),
        y_label: "specific range, NM/t".to_owned(),
    };
    let marks = html! {
        (chart.marks(&predicted, Mark::Ring, "after small"))
        (chart.marks(&recorded, Mark::Dot, "observed"))
    };
    html! {
        figure {
            figcaption {
                b { "Specific range." } " Nautical air miles per tonne of fuel, as flown: levels and Mach numbers differ from segment \
                to segment."
            }
            (legend(&[
                (Key::Mark(Mark::Dot), "observed", "recorded"),
                (Key::Mark(Mark::Ring), "after", "present model at the same point"),
            ]))
            (chart.draw(&marks))
            @if shown.len() < view.cruise.len() {
                p.note { "Drawn are " (shown.len()) " of " (counted(view.cruise.len(), "segment")) ", evenly chosen." }
            }
        }
    }
}

/// Fuel flow of each engine against the mean of all, flight by flight.
pub(crate) fn engines(view: &TailView, place: &Place<'_>) -> Markup {
    let flights: Vec<_> = view
        .flights
        .iter()
        .filter(|flight| flight.engines.len() == view.engines && view.engines > 1)
        .collect();
    let (Some(first), Some(last)) = (flights.first(), flights.last()) else { return html! {} };
    let shown = thinned(flights.len(), MOST_POINTS.min(place.most_points));
    let values = || flights.iter().flat_map(|flight| flight.engines.iter().copied());
    let low = values().fold(0.0, f64::min);
    let chart = Chart {
        id: place.id("engines"),
        title: format!("{}: fuel flow of the engines against each other", place.tail),
        description: format!(
            "Mean fuel flow of each of {} engines against the mean of all, in {}.",
            view.engines,
            counted(flights.len(), "flight")
        ),
        width: WIDTH,
        height: HEIGHT,
        x: dates::axis(first.start_s, last.start_s, 5),
        y: Axis::around(low, values().fold(0.0, f64::max), 6),
        x_label: "START of the flight, UTC".to_owned(),
        y_label: "against the mean of the engines, %".to_owned(),
    };
    let mean = |engine: usize| {
        flights.iter().map(|flight| flight.engines[engine]).sum::<f64>() / flights.len() as f64
    };
    let words: Vec<String> = (0..view.engines)
        .map(|engine| format!("engine {}: mean {} %", engine + 1, signed(Some(mean(engine)))))
        .collect();
    let points = |engine: usize| -> Vec<(f64, f64)> {
        shown.iter().map(|k| (flights[*k].start_s, flights[*k].engines[engine])).collect()
    };
    html! {
        figure {
            figcaption {
                b { "Engines against each other." } " Fuel flow of each engine, mean of each flight. A step of one engine is its \
                meter, its thrust setting or its wear."
            }
            (legend(&engine_entries(&words)))
            (chart.draw(&html! {
                (chart.horizontal(0.0, "zero"))
                @for engine in 0..view.engines {
                    @let (mark, class) = engine_look(engine);
                    (chart.marks(&points(engine), mark, class))
                }
            }))
        }
    }
}
