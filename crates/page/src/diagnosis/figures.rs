//! The charts of a diagnosis: the gap before and after, where, over what drives it, over time.

use std::fmt::Write;

use diagnose::{SegmentGap, Variable};
use flight::effect::HiddenParameter;
use maud::{Markup, html};
use pipeline::diagnosis_words::variable_words;

use super::{Tail, engines, map, unseen};
use crate::chart::{Axis, Bins, Chart, Key, Mark, dates, legend, thinned};
use crate::place::Detail;
use crate::text::{capitalised, signed};
use pipeline::summary::counted;

/// Width of a bin where 60 of them suffice, %.
const BIN_PERCENT: f64 = 0.25;
const WIDTH: f64 = 500.0;
const HEIGHT: f64 = 290.0;
/// Events named under the chart. Our choice: about two lines.
const EVENTS_NAMED: usize = 8;
/// Groups of equally many segments over the driving variable. Our choice.
const GROUPS: usize = 8;

/// All charts of a tail.
pub(super) fn figures(tail: &Tail<'_>) -> Markup {
    let (before, after) = tail.before_and_after();
    let mut all = before.clone();
    all.extend(&after);
    let bins = Bins::around(&all, BIN_PERCENT);
    html! {
        div.figures {
            (histograms(tail, &bins, &before, &after))
            (map::map(tail))
            (over_time(tail, &bins))
            @if tail.detail == Detail::Full { (unseen::unseen(tail)) }
            @if let Some(driver) = tail.figures.driver { (over_driver(tail, &bins, driver)) }
            @if engines::is_of_one(tail) { (engines::engines(tail)) }
        }
    }
}

pub(super) fn chart(tail: &Tail<'_>, what: &str, x: Axis, y: Axis) -> Chart {
    Chart {
        id: format!("{}-{}", tail.id, what.replace(' ', "-")),
        title: format!("{}: {what}", tail.diagnosed.name()),
        description: String::new(),
        width: WIDTH,
        height: HEIGHT,
        x,
        y,
        x_label: String::new(),
        y_label: "gap, %".to_owned(),
    }
}

fn histograms(tail: &Tail<'_>, bins: &Bins, before: &[f64], after: &[f64]) -> Markup {
    let (counted_before, counted_after) = (bins.histogram(before), bins.histogram(after));
    let largest = counted_before.largest().max(counted_after.largest());
    let scale = Axis::within(bins.low(), bins.high(), 8);
    let words_before = format!("before: mean {} %, rms {:.2} %", signed(mean(before)), rms(before));
    let words_after =
        format!("with the effects added: mean {} %, rms {:.2} %", signed(mean(after)), rms(after));
    let mut entries = vec![(Key::Area, "before", words_before.as_str())];
    let mut description = format!("Number of segments by gap. {words_before}.");
    if !after.is_empty() {
        entries.push((Key::Area, "after", words_after.as_str()));
        let _ = write!(description, " {words_after}.");
    }
    let chart = Chart {
        description,
        x_label: "gap, %".to_owned(),
        y_label: format!("segments per bin of {} %", bins.width()),
        ..chart(tail, "distribution of the gap", scale, Axis::of_counts(largest, 5))
    };
    let marks = html! {
        (chart.bars(bins, &counted_before, "before"))
        @if !after.is_empty() { (chart.bars(bins, &counted_after, "after")) }
        (chart.vertical(0.0, "zero"))
    };
    let beyond = counted_before.beyond() + counted_after.beyond();
    html! {
        figure {
            figcaption {
                b { "The gap before and after." }
                @if after.is_empty() { " Nothing is added to the model." }
                @else { " After: with the verdict's effects at the sizes fitted to these flights." }
            }
            (legend(&entries))
            (chart.draw(&marks))
            @if beyond > 0 { p.note { (counted(beyond, "segment")) " beyond the drawn range; they are in mean and rms." } }
        }
    }
}

fn over_time(tail: &Tail<'_>, bins: &Bins) -> Markup {
    let segments = &tail.figures.segments;
    let dates_s = segments.iter().map(|one| one.date_s);
    let first = dates_s.clone().fold(f64::INFINITY, f64::min);
    let last = dates_s.fold(f64::NEG_INFINITY, f64::max);
    let steps: Vec<f64> = tail
        .diagnosed
        .diagnosis
        .addition
        .iter()
        .flat_map(|addition| &addition.effects)
        .flat_map(|added| match added.hidden {
            HiddenParameter::Step { from_s, .. } => vec![from_s],
            HiddenParameter::History(history) => history.falls_s().collect(),
            _ => vec![],
        })
        .collect();
    let chart = Chart {
        description: "Gap of each segment, and mean gap of each flight before and after."
            .to_owned(),
        x_label: "date, UTC".to_owned(),
        ..chart(
            tail,
            "gap over time",
            dates::axis(first, last, 5),
            Axis::within(bins.low(), bins.high(), 8),
        )
    };
    let before = flight_means(segments, |one| Some(one.before_percent));
    let after = flight_means(segments, |one| one.after_percent.last().copied());
    let within: Vec<&(f64, String)> =
        tail.figures.events.iter().filter(|(at, _)| chart.x.holds(*at)).collect();
    let marks = html! {
        (chart.horizontal(0.0, "zero"))
        (chart.marks(&drawn(tail, |one| Some((one.date_s, one.before_percent))), Mark::Dot, "before"))
        @for (at, _) in &within { (chart.vertical(*at, "mean")) }
        @for step in &steps { (chart.vertical(*step, "event")) }
        (chart.marks(&before, Mark::Ring, "before"))
        (chart.marks(&after, Mark::Disc, "after"))
    };
    let mut entries = vec![
        (Key::Mark(Mark::Dot), "before", "segment before"),
        (Key::Mark(Mark::Ring), "before", "flight mean before"),
    ];
    if !after.is_empty() {
        entries.push((Key::Mark(Mark::Disc), "after", "flight mean after"));
    }
    if !within.is_empty() {
        entries.push((Key::Line, "mean", "what was done"));
    }
    if !steps.is_empty() {
        entries.push((Key::Line, "event", "date of the step that was found"));
    }
    html! {
        figure {
            figcaption { b { "The gap over time." } " A step may be an event, a slope may be wear, a flight far off a wrong load sheet." }
            (legend(&entries))
            (chart.draw(&marks))
            @if !tail.figures.events.is_empty() {
                p.note {
                    "What was done: "
                    @for (place, (at, kind)) in tail.figures.events.iter().take(EVENTS_NAMED).enumerate() {
                        @if place > 0 { ", " } (dates::period(*at, *at)) " " (kind)
                    }
                    @if tail.figures.events.len() > EVENTS_NAMED { " and " (tail.figures.events.len() - EVENTS_NAMED) " more" }
                    "."
                }
            }
        }
    }
}

fn over_driver(tail: &Tail<'_>, bins: &Bins, driver: Variable) -> Markup {
    let segments = &tail.figures.segments;
    let mut known: Vec<(f64, &SegmentGap)> =
        segments.iter().filter_map(|one| Some((one.driver?, one))).collect();
    known.sort_by(|(one, _), (other, _)| one.total_cmp(other));
    let (Some((low, _)), Some((high, _))) = (known.first(), known.last()) else { return html! {} };
    let name = variable_words(driver);
    let chart = Chart {
        description: format!(
            "Gap of each segment over {name}, and means of groups of equally many segments."
        ),
        x_label: format!("{name}{}", unit(driver)),
        ..chart(
            tail,
            &format!("gap over {name}"),
            Axis::around(*low, *high, 6),
            Axis::within(bins.low(), bins.high(), 8),
        )
    };
    let groups = known.chunks(known.len().div_ceil(GROUPS).max(1));
    let group_mean = |of: fn(&SegmentGap) -> Option<f64>| -> Vec<(f64, f64)> {
        let means = groups.clone().filter_map(|group| {
            let at: Vec<f64> = group.iter().map(|(value, _)| *value).collect();
            let gaps: Vec<f64> = group.iter().filter_map(|(_, one)| of(one)).collect();
            Some((mean(&at)?, mean(&gaps)?))
        });
        means.collect()
    };
    let before = group_mean(|one| Some(one.before_percent));
    let after = group_mean(|one| one.after_percent.last().copied());
    let marks = html! {
        (chart.horizontal(0.0, "zero"))
        (chart.marks(&drawn(tail, |one| Some((one.driver?, one.before_percent))), Mark::Dot, "before"))
        (chart.polyline(&before, "initial")) (chart.marks(&before, Mark::Ring, "before"))
        (chart.polyline(&after, "final")) (chart.marks(&after, Mark::Disc, "after"))
    };
    let mut entries = vec![
        (Key::Mark(Mark::Dot), "before", "segment before"),
        (Key::Mark(Mark::Ring), "before", "mean of a group before"),
    ];
    if !after.is_empty() {
        entries.push((Key::Mark(Mark::Disc), "after", "mean of a group after"));
    }
    html! {
        figure {
            figcaption { b { (capitalised(&format!("the gap over {name}."))) } }
            (legend(&entries))
            (chart.draw(&marks))
        }
    }
}

/// Points of a chart, evenly thinned.
fn drawn(tail: &Tail<'_>, of: impl Fn(&SegmentGap) -> Option<(f64, f64)>) -> Points {
    let segments = &tail.figures.segments;
    thinned(segments.len(), tail.most_points).into_iter().filter_map(|k| of(&segments[k])).collect()
}

/// Points of a chart.
pub(super) type Points = Vec<(f64, f64)>;

/// Mean date of each flight and mean of a value of its segments, where it has any.
pub(super) fn flight_means(
    segments: &[SegmentGap],
    of: impl Fn(&SegmentGap) -> Option<f64>,
) -> Points {
    let flights = segments.chunk_by(|one, other| one.flight == other.flight);
    flights
        .filter_map(|flight| {
            let dates_s: Vec<f64> = flight.iter().map(|one| one.date_s).collect();
            let values: Vec<f64> = flight.iter().filter_map(&of).collect();
            Some((mean(&dates_s)?, mean(&values)?))
        })
        .collect()
}

pub(super) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

fn rms(values: &[f64]) -> f64 {
    mean(&values.iter().map(|value| value * value).collect::<Vec<f64>>()).unwrap_or(0.0).sqrt()
}

/// Unit of a variable on an axis.
const fn unit(variable: Variable) -> &'static str {
    match variable {
        Variable::PressureAltitude => ", m",
        Variable::CorrectedThrust => " over its reference",
        Variable::IsaDeviation | Variable::StaticAirTemperature => ", K",
        Variable::FuelUsed | Variable::Mass => ", kg",
        Variable::Roll | Variable::Latitude => ", °",
        Variable::Acceleration => ", m/s²",
        Variable::CrossWind | Variable::EastwardSpeed => ", m/s",
        Variable::CenterOfGravity => ", % MAC",
        Variable::N2 => ", %",
        _ => "",
    }
}
