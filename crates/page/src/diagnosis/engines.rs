//! The chart of a gap that lies at one engine: every engine's gap against the mean of all, over time.

use diagnose::{SegmentGap, Variable};
use maud::{Markup, html};

use super::Tail;
use super::figures::{Points, chart, flight_means, mean};
use crate::chart::{Axis, Chart, dates, legend};
use crate::performance::{engine_entries, engine_look};
use crate::text::signed;

/// Whether the place that was found first, or an effect of the verdict, is of a single engine.
pub(super) fn is_of_one(tail: &Tail<'_>) -> bool {
    let diagnosis = &tail.diagnosed.diagnosis;
    let place = diagnosis.r#where.first();
    place.is_some_and(|place| {
        place.region.conditions.iter().any(|one| one.variable == Variable::Engine)
    }) || diagnosis.verdict.effects().iter().any(|effect| effect.engine().is_some())
}

/// Each engine's gap less the mean of all, flight by flight, before effects are added; means before and after in words.
pub(super) fn engines(tail: &Tail<'_>) -> Markup {
    let segments = &tail.figures.segments;
    let count = segments.iter().map(|one| one.engines_apart_percent.len()).max().unwrap_or(0);
    if count == 0 {
        return html! {};
    }
    let of = |engine: usize| move |one: &SegmentGap| of_engine(one, engine, 0);
    let before: Vec<Points> = (0..count).map(|engine| flight_means(segments, of(engine))).collect();
    let values = || before.iter().flatten().map(|point| point.1);
    let dates_s = || segments.iter().map(|one| one.date_s);
    let (first, last) =
        (dates_s().fold(f64::INFINITY, f64::min), dates_s().fold(f64::NEG_INFINITY, f64::max));
    let has_effects = !tail.diagnosed.diagnosis.verdict.effects().is_empty();
    let words: Vec<String> = (0..count)
        .map(|engine| {
            let mean_of = |after: usize| {
                let values = segments.iter().filter_map(|one| of_engine(one, engine, after));
                mean(&values.collect::<Vec<f64>>())
            };
            let left = if has_effects {
                format!(", with the effects added {} %", signed(mean_of(1)))
            } else {
                String::new()
            };
            format!("engine {}: mean {} %{left}", engine + 1, signed(mean_of(0)))
        })
        .collect();
    let chart = Chart {
        description: format!(
            "Gap of each engine less the mean of all, by flight. {}.",
            words.join("; ")
        ),
        x_label: "date, UTC".to_owned(),
        y_label: "gap against the mean of the engines, %".to_owned(),
        ..chart(
            tail,
            "gap by engine",
            dates::axis(first, last, 5),
            Axis::around(values().fold(0.0, f64::min), values().fold(0.0, f64::max), 6),
        )
    };
    html! {
        figure {
            figcaption { b { "The gap by engine." } " Fuel flow of each engine against its prediction, less the mean of all; mean of each flight." }
            (legend(&engine_entries(&words)))
            (chart.draw(&html! {
                (chart.horizontal(0.0, "zero"))
                @for (engine, points) in before.iter().enumerate() {
                    @let (mark, class) = engine_look(engine);
                    (chart.marks(points, mark, class))
                }
            }))
        }
    }
}

/// One engine's value of a segment: before (0) or after (1).
fn of_engine(segment: &SegmentGap, engine: usize, after: usize) -> Option<f64> {
    Some(segment.engines_apart_percent.get(engine)?[after])
}
