//! Errors of a tail's segments: their distribution, and their course over time.

use std::fmt::Write;

use maud::{Markup, html};

use crate::chart::{Axis, Bins, Chart, Key, Mark, dates, legend, thinned};
use crate::place::{BEFORE, Place};
use crate::text::{plain, signed};
use crate::view::{Flight, TailView};
use pipeline::statistics::ErrorStatistics;
use pipeline::summary::counted;

/// Width of a bin where 60 of them suffice, %.
const BIN_PERCENT: f64 = 0.5;
/// Flights that are listed as farthest from the others.
const FLIGHTS_NAMED: usize = 5;
const WIDTH: f64 = 500.0;
const HEIGHT: f64 = 290.0;

/// Bins for all errors of a tail; their range is also that of the error over time.
pub(crate) fn bins(view: &TailView) -> Bins {
    let mut all = view.before();
    all.extend(view.after());
    Bins::around(&all, BIN_PERCENT)
}

/// Histogram of segment errors, before and after on one scale.
pub(crate) fn histogram(view: &TailView, bins: &Bins, place: &Place<'_>) -> Markup {
    let (before, after) = (view.before(), view.after());
    let (counted_before, counted_after) = (bins.histogram(&before), bins.histogram(&after));
    let words_before = words(view.before_label(), &ErrorStatistics::from_errors(&before));
    let words_after = words("after", &ErrorStatistics::from_errors(&after));
    let mut description = format!("Number of segments by error. {words_before}.");
    let mut entries = vec![(Key::Area, BEFORE, words_before.as_str())];
    if view.adapted {
        let _ = write!(description, " {words_after}.");
        entries.push((Key::Area, "after", words_after.as_str()));
    }
    entries.push((Key::Line, "mean", "means"));
    let chart = Chart {
        id: place.id("histogram"),
        title: format!("{}: distribution of segment errors", place.tail),
        description,
        width: WIDTH,
        height: HEIGHT,
        x: Axis::within(bins.low(), bins.high(), 8),
        y: Axis::of_counts(counted_before.largest().max(counted_after.largest()), 5),
        x_label: "error of predicted total fuel flow, %".to_owned(),
        y_label: format!("segments per bin of {} %", bins.width()),
    };
    let marks = html! {
        (chart.bars(bins, &counted_before, BEFORE))
        @if view.adapted { (chart.bars(bins, &counted_after, "after")) }
        (chart.vertical(0.0, "zero"))
        @if let Some(mean) = ErrorStatistics::from_errors(&before).mean {
            (chart.vertical(mean, "mean before"))
        }
        @if let Some(mean) = ErrorStatistics::from_errors(&after).mean {
            (chart.vertical(mean, "mean after"))
        }
    };
    let beyond = counted_before.beyond() + counted_after.beyond();
    html! {
        figure {
            figcaption { b { "Distribution of errors." } " Positive: the aircraft burns more than the model predicts." }
            (legend(&entries))
            (chart.draw(&marks))
            @if beyond > 0 {
                p.note {
                    "Beyond the drawn range: "
                    (view.before_label()) " " (counted_before.below) " below and "
                    (counted_before.above) " above"
                    @if view.adapted {
                        ", after " (counted_after.below) " below and " (counted_after.above) " above"
                    }
                    ". They are in mean and std."
                }
            }
        }
    }
}

/// Errors over START of the flight: segments and the means of flights.
pub(crate) fn over_time(view: &TailView, bins: &Bins, place: &Place<'_>) -> Markup {
    let starts = view.flights.iter().map(|flight| flight.start_s);
    let first = starts.clone().fold(f64::INFINITY, f64::min);
    let last = starts.fold(f64::NEG_INFINITY, f64::max);
    let chart = Chart {
        id: place.id("time"),
        title: format!("{}: error over time", place.tail),
        description: format!(
            "Error of each segment and mean error of each of {} over the START of the flight.{}",
            counted(view.flights.len(), "flight"),
            told_span(view)
        ),
        width: WIDTH,
        height: HEIGHT,
        x: dates::axis(first, last, 5),
        y: Axis::within(bins.low(), bins.high(), 8),
        x_label: "START of the flight, UTC".to_owned(),
        y_label: "error, %".to_owned(),
    };
    let shown = thinned(view.points.len(), place.most_points);
    let segments = |of: fn(&crate::view::Point) -> Option<f64>| {
        let points = shown.iter().filter_map(|k| {
            let point = &view.points[*k];
            Some((point.start_s, of(point)?))
        });
        points.collect::<Vec<_>>()
    };
    let flights_shown = thinned(view.flights.len(), place.most_points);
    let means = |of: fn(&Flight) -> Option<f64>| {
        let points = flights_shown.iter().filter_map(|k| {
            let flight = &view.flights[*k];
            Some((flight.start_s, of(flight)?))
        });
        points.collect::<Vec<_>>()
    };
    let (before, after) = (segments(|point| point.before), segments(|point| point.after));
    let (means_before, means_after) =
        (means(|flight| flight.before.mean), means(|flight| flight.after.mean));
    let beyond = [&before, &after, &means_before, &means_after]
        .map(|points| chart.beyond(points))
        .into_iter()
        .sum::<usize>();
    let marks = html! {
        (chart.horizontal(0.0, "zero"))
        (chart.marks(&before, Mark::Dot, BEFORE))
        (chart.marks(&after, Mark::Dot, "after"))
        (chart.marks(&means_before, Mark::Ring, BEFORE))
        (chart.marks(&means_after, Mark::Disc, "after"))
    };
    let label = view.before_label();
    let (segment_words, mean_words) = (format!("segment {label}"), format!("flight mean {label}"));
    let mut entries = vec![
        (Key::Mark(Mark::Dot), BEFORE, segment_words.as_str()),
        (Key::Mark(Mark::Ring), BEFORE, mean_words.as_str()),
    ];
    if view.adapted {
        entries.push((Key::Mark(Mark::Dot), "after", "segment after"));
        entries.push((Key::Mark(Mark::Disc), "after", "flight mean after"));
    }
    html! {
        figure {
            figcaption { b { "Error over time." } " A step may be an event, a slope may be wear, a flight far from all others may have a wrong load sheet." }
            (legend(&entries))
            (chart.draw(&marks))
            @if shown.len() < view.points.len() {
                p.note { (place.thinned_words(shown.len(), view.points.len(), "segments")) }
            }
            @if flights_shown.len() < view.flights.len() {
                p.note { (place.thinned_words(flights_shown.len(), view.flights.len(), "flight means")) }
            }
            @if beyond > 0 {
                p.note { (counted(beyond, "point")) " beyond the drawn range." }
            }
        }
    }
}

/// Mean error of each flight by the model before it learnt the flight: what it would have predicted.
pub(crate) fn before_learning(view: &TailView, place: &Place<'_>) -> Markup {
    let shown = thinned(view.flights.len(), place.most_points);
    let of = |of: fn(&Flight) -> Option<f64>| -> Vec<(f64, f64)> {
        let flights = shown.iter().map(|k| &view.flights[*k]);
        flights.filter_map(|flight| Some((flight.start_s, of(flight)?))).collect()
    };
    let forecast = of(|flight| flight.before_learning);
    let (Some(first), Some(last)) = (forecast.first(), forecast.last()) else { return html! {} };
    let initial = of(|flight| flight.before.mean);
    let values = || forecast.iter().chain(&initial).map(|point| point.1);
    let (low, high) = (values().fold(0.0, f64::min), values().fold(0.0, f64::max));
    let told: Vec<f64> = view.flights.iter().filter_map(|flight| flight.before_learning).collect();
    let later = ErrorStatistics::from_errors(&told[told.len() / 2..]);
    let chart = Chart {
        id: place.id("forecast"),
        title: format!("{}: error of each flight before it was learnt", place.tail),
        description: format!(
            "Mean error of {} by the initial model and by the model before it learnt the flight.",
            counted(told.len(), "flight")
        ),
        width: WIDTH,
        height: HEIGHT,
        x: dates::axis(first.0, last.0, 5),
        y: Axis::around(low, high, 6),
        x_label: "START of the flight, UTC".to_owned(),
        y_label: "mean error of the flight, %".to_owned(),
    };
    let marks = html! {
        (chart.horizontal(0.0, "zero"))
        (chart.marks(&initial, Mark::Ring, BEFORE))
        (chart.polyline(&forecast, "final thin"))
        (chart.marks(&forecast, Mark::Disc, "after"))
    };
    html! {
        figure {
            figcaption {
                b { "Each flight before it was learnt." }
                " What the model would have predicted on the day; over the later half of the flights " (signed(later.mean))
                " % in the mean"
                @if later.std.is_some() { ", " (plain(later.std)) " % of scatter between flights" }
                "."
            }
            (legend(&[
                (Key::Mark(Mark::Ring), BEFORE, "initial model"),
                (Key::Mark(Mark::Disc), "after", "model before it learnt the flight"),
            ]))
            (chart.draw(&marks))
        }
    }
}

/// The flights whose mean error is farthest from the others': where to look for a wrong load sheet.
pub(crate) fn flights_apart(view: &TailView) -> Markup {
    let (median, flights) = apart(view);
    html! {
        @if !flights.is_empty() {
            figure {
                figcaption {
                    b { "Flights far from the others." }
                    " Mean error " @if view.adapted { "before " } "farthest from the median ("
                    (signed(Some(median))) " %)."
                    @if view.adapted {
                        " Not “after”: the final table has also learnt from a flight that was recorded wrongly."
                    }
                }
                div.scroll {
                table.small {
                    thead { tr {
                        th scope="col" { "flight" }
                        th scope="col" { "START, UTC" }
                        th scope="col" { "segments" }
                        th scope="col" { "mean " (view.before_label()) ", %" }
                        @if view.adapted { th scope="col" { "mean after, %" } }
                    } }
                    tbody {
                        @for flight in flights {
                            tr {
                                th scope="row" { (flight.name) }
                                td { (dates::day(flight.start)) }
                                td { (flight.before.n) }
                                td { (signed(flight.before.mean)) }
                                @if view.adapted { td { (signed(flight.after.mean)) } }
                            }
                        }
                    }
                }
                }
            }
        }
    }
}

/// Fewer flights have none that is far from the others.
const FEWEST_FOR_APART: usize = 3;

/// Median of the flights' mean errors before, and the flights farthest from it. Stable: of equally far ones the earlier is listed first.
fn apart(view: &TailView) -> (f64, Vec<&Flight>) {
    let mut flights: Vec<(f64, &Flight)> =
        view.flights.iter().filter_map(|flight| Some((flight.before.mean?, flight))).collect();
    let mut means: Vec<f64> = flights.iter().map(|(mean, _)| *mean).collect();
    means.sort_unstable_by(f64::total_cmp);
    if means.len() < FEWEST_FOR_APART {
        return (0.0, Vec::new());
    }
    let (lower, upper) = (means[(means.len() - 1) / 2], means[means.len() / 2]);
    let median = f64::midpoint(lower, upper);
    let distance = |mean: f64| (mean - median).abs();
    flights.sort_by(|(one, _), (other, _)| distance(*other).total_cmp(&distance(*one)));
    flights.truncate(FLIGHTS_NAMED);
    (median, flights.into_iter().map(|(_, flight)| flight).collect())
}

fn words(label: &str, statistics: &ErrorStatistics) -> String {
    format!(
        "{label}: mean {} %, std {} %, n {}",
        signed(statistics.mean),
        plain(statistics.std),
        statistics.n
    )
}

fn told_span(view: &TailView) -> String {
    match (view.flights.first(), view.flights.last()) {
        (Some(first), Some(last)) => {
            format!(" From {} to {}.", dates::day(first.start), dates::day(last.start))
        }
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn a_wrong_flight_is_named_first() {
        let mut view = samples::views().remove(0);
        // Means about +4 %; one flight was recorded with too much mass, and the table has learnt it.
        view.flights[9].before = ErrorStatistics::from_errors(&[-11.0, -12.0]);
        view.flights[9].after = ErrorStatistics::from_errors(&[0.0, 0.1]);
        let (median, flights) = apart(&view);
        assert!((3.0..5.0).contains(&median), "{median}");
        assert_eq!((flights.len(), flights[0].name.as_str()), (FLIGHTS_NAMED, "F9"));
    }
}
