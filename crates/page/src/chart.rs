//! Charts as inline SVG: a frame with two scales, and marks in it.
//!
//! Nothing here is specific to aviation. Colors and line styles come from the page's style sheet by class name; many
//! marks form one path, because a page of a whole fleet has hundreds of thousands of them.

use std::fmt::Write;

use maud::{Markup, PreEscaped, html};

mod axis;
mod bins;
mod coordinate;
pub(crate) mod dates;

pub(crate) use axis::{Axis, Tick};
pub(crate) use bins::{Bins, Histogram, thinned};
pub(crate) use coordinate::{coordinate, pixel, push_point};

/// Room for labels around the frame.
const LEFT: f64 = 64.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 8.0;
const BOTTOM: f64 = 40.0;
const TICK: f64 = 4.0;
/// A generous half of the width of a label's character.
const HALF_CHARACTER: f64 = 3.8;

/// A chart. Sizes are in the drawing's own pixels; the page scales it as a whole.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    /// Unique on the page.
    pub(crate) id: String,
    /// Title, for screen readers.
    pub(crate) title: String,
    /// Description.
    pub(crate) description: String,
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// Quantity and unit.
    pub(crate) x_label: String,
    /// Quantity and unit.
    pub(crate) y_label: String,
}

/// Shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mark {
    /// A small filled point.
    Dot,
    /// A filled circle.
    Disc,
    /// A hollow circle.
    Ring,
    /// A hollow diamond.
    Diamond,
}

/// An entry of a legend.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Key {
    /// A line.
    Line,
    /// A filled area with its outline.
    Area,
    /// A mark.
    Mark(Mark),
}

impl Chart {
    /// Draws the frame with these marks in it.
    pub(crate) fn draw(&self, marks: &Markup) -> Markup {
        let (width, height) = (coordinate(self.width), coordinate(self.height));
        let (left, right, top, bottom) = (LEFT, self.width - RIGHT, TOP, self.height - BOTTOM);
        let middle_x = coordinate(f64::midpoint(left, right));
        let middle_y = coordinate(f64::midpoint(top, bottom));
        html! {
            svg viewBox=(format!("0 0 {width} {height}"))
                data-frame=(format!(
                    "{} {} {} {}", coordinate(left), coordinate(right), coordinate(top), coordinate(bottom)
                ))
                data-x=(format!("{} {}", self.x.first(), self.x.last()))
                data-y=(format!("{} {}", self.y.first(), self.y.last()))
                data-x-of=[self.x.of()] data-y-of=[self.y.of()]
                role="img" aria-labelledby=(format!("{0}-title {0}-desc", self.id)) {
                title id=(format!("{}-title", self.id)) { (self.title) }
                desc id=(format!("{}-desc", self.id)) { (self.description) }
                path class="grid" d=(PreEscaped(self.grid_lines())) {}
                g class="marks" { (marks) }
                path class="frame" d=(format!(
                    "M{} {}V{}H{}", coordinate(left), coordinate(top), coordinate(bottom), coordinate(right)
                )) {}
                path class="frame" d=(PreEscaped(self.tick_lines())) {}
                @for tick in self.x.ticks() {
                    text class="tick" text-anchor="middle"
                        x=(pixel(self.label_at(tick))) y=(pixel(bottom + 16.0)) { (tick.label) }
                }
                @for tick in self.y.ticks() {
                    text class="tick" text-anchor="end"
                        x=(pixel(left - 7.0)) y=(pixel(self.y_at(tick.at) + 4.0)) { (tick.label) }
                }
                text class="label" text-anchor="middle" x=(middle_x) y=(coordinate(self.height - 6.0)) {
                    (self.x_label)
                }
                text class="label" text-anchor="middle"
                    transform=(format!("translate(13 {middle_y}) rotate(-90)")) { (self.y_label) }
            }
        }
    }

    /// A line through points; a point off the scales ends it and starts another.
    pub(crate) fn polyline(&self, points: &[(f64, f64)], class: &str) -> Markup {
        let mut d = String::new();
        let mut pen = 'M';
        for point in points {
            match self.place(*point) {
                Some(place) => {
                    push_point(&mut d, pen, place);
                    pen = 'L';
                }
                None => pen = 'M',
            }
        }
        path(&format!("line {class}"), &d)
    }

    /// Marks at points; those off the scales are left out, see [`Chart::beyond`].
    pub(crate) fn marks(&self, points: &[(f64, f64)], mark: Mark, class: &str) -> Markup {
        let places = points.iter().filter_map(|point| self.place(*point));
        mark.paths(places, class)
    }

    /// Number of points that are off the scales and not drawn.
    pub(crate) fn beyond(&self, points: &[(f64, f64)]) -> usize {
        points.iter().filter(|point| self.place(**point).is_none()).count()
    }

    /// Bars of a histogram as one outline.
    pub(crate) fn bars(&self, bins: &Bins, histogram: &Histogram, class: &str) -> Markup {
        let mut d =
            format!("M{} {}", coordinate(self.x_at(bins.low())), coordinate(self.y_at(0.0)));
        for (k, count) in histogram.counts.iter().enumerate() {
            let right = bins.low() + (k as f64 + 1.0) * bins.width();
            let (right, top) = (self.x_at(right), self.y_at(*count as f64));
            let _ = write!(d, "V{}H{}", coordinate(top), coordinate(right));
        }
        let _ = write!(d, "V{}Z", coordinate(self.y_at(0.0)));
        path(&format!("area {class}"), &d)
    }

    /// A line across at one x.
    pub(crate) fn vertical(&self, x: f64, class: &str) -> Markup {
        self.polyline(&[(x, self.y.first()), (x, self.y.last())], class)
    }

    /// A line across at one y.
    pub(crate) fn horizontal(&self, y: f64, class: &str) -> Markup {
        self.polyline(&[(self.x.first(), y), (self.x.last(), y)], class)
    }

    /// A rectangle between two values of each scale, with words for the pointer; cut off at the frame.
    pub(crate) fn cell(&self, x: (f64, f64), y: (f64, f64), class: &str, tip: &str) -> Markup {
        let (left, right) = (self.x_at(x.0.max(self.x.first())), self.x_at(x.1.min(self.x.last())));
        let (bottom, top) = (self.y_at(y.0.max(self.y.first())), self.y_at(y.1.min(self.y.last())));
        html! {
            rect class=(format!("cell {class}")) x=(pixel(left)) y=(pixel(top))
                width=(pixel((right - left).max(0.0))) height=(pixel((bottom - top).max(0.0)))
                data-tip=(tip) {}
        }
    }

    /// An upright line with words for the pointer; cut off at the frame.
    pub(crate) fn interval(&self, x: f64, y: (f64, f64), class: &str, tip: &str) -> Markup {
        let clamped = |value: f64| self.y_at(value.clamp(self.y.first(), self.y.last()));
        html! {
            path class=(class) data-tip=[(!tip.is_empty()).then_some(tip)]
                d=(format!("M{} {}V{}", coordinate(self.x_at(x)), coordinate(clamped(y.0)), coordinate(clamped(y.1)))) {}
        }
    }

    /// Upright lines, cut off at the frame, as one path.
    pub(crate) fn intervals(&self, intervals: &[(f64, (f64, f64))], class: &str) -> Markup {
        let mut d = String::new();
        let clamped = |value: f64| self.y_at(value.clamp(self.y.first(), self.y.last()));
        for (x, (low, high)) in intervals.iter().filter(|(x, _)| self.x.holds(*x)) {
            push_point(&mut d, 'M', (self.x_at(*x), clamped(*low)));
            let _ = write!(d, "V{}", coordinate(clamped(*high)));
        }
        path(class, &d)
    }

    fn place(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        (self.x.holds(x) && self.y.holds(y)).then(|| (self.x_at(x), self.y_at(y)))
    }

    fn x_at(&self, value: f64) -> f64 {
        LEFT + self.x.share(value) * (self.width - LEFT - RIGHT)
    }

    fn y_at(&self, value: f64) -> f64 {
        self.height - BOTTOM - self.y.share(value) * (self.height - TOP - BOTTOM)
    }

    /// Middle of a label below the frame: at its tick, or as near as the drawing's right edge allows.
    fn label_at(&self, tick: &Tick) -> f64 {
        let half = HALF_CHARACTER * tick.label.len() as f64;
        self.x_at(tick.at).min(self.width - half)
    }

    fn grid_lines(&self) -> String {
        let mut d = String::new();
        for tick in self.x.ticks() {
            let (x, top, bottom) = (self.x_at(tick.at), TOP, self.height - BOTTOM);
            let _ = write!(d, "M{} {}V{}", coordinate(x), coordinate(top), coordinate(bottom));
        }
        for tick in self.y.ticks() {
            let (y, right) = (self.y_at(tick.at), self.width - RIGHT);
            let _ = write!(d, "M{} {}H{}", coordinate(LEFT), coordinate(y), coordinate(right));
        }
        d
    }

    fn tick_lines(&self) -> String {
        let mut d = String::new();
        for tick in self.x.ticks() {
            let (x, bottom) = (self.x_at(tick.at), self.height - BOTTOM);
            let _ = write!(d, "M{} {}v{TICK}", coordinate(x), coordinate(bottom));
        }
        for tick in self.y.ticks() {
            let y = self.y_at(tick.at);
            let _ = write!(d, "M{} {}h-{TICK}", coordinate(LEFT), coordinate(y));
        }
        d
    }
}

impl Mark {
    /// All marks of one kind as one or two paths.
    fn paths(self, places: impl Iterator<Item = (f64, f64)>, class: &str) -> Markup {
        let mut d = String::new();
        for (x, y) in places {
            match self {
                // A line of length zero with round ends is drawn as a point.
                Self::Dot | Self::Disc | Self::Ring => {
                    push_point(&mut d, 'M', (x, y));
                    d.push_str("h0");
                }
                Self::Diamond => {
                    push_point(&mut d, 'M', (x, y - 4.0));
                    d.push_str("l4 4l-4 4l-4-4z");
                }
            }
        }
        match self {
            Self::Dot => path(&format!("dot {class}"), &d),
            Self::Disc => path(&format!("disc {class}"), &d),
            Self::Ring => html! { (path(&format!("disc {class}"), &d)) (path("core", &d)) },
            Self::Diamond => path(&format!("diamond {class}"), &d),
        }
    }
}

/// A legend: the meaning of each mark, in words.
pub(crate) fn legend(entries: &[(Key, &str, &str)]) -> Markup {
    html! {
        ul class="legend" {
            @for (key, class, words) in entries {
                li {
                    svg class="key" viewBox="0 0 26 12" aria-hidden="true" {
                        @match key {
                            Key::Line => (path(&format!("line {class}"), "M1 6H25")),
                            Key::Area => (path(&format!("area {class}"), "M3 11V2H23V11Z")),
                            Key::Mark(mark) => (mark.paths(std::iter::once((13.0, 6.0)), class)),
                        }
                    }
                    (words)
                }
            }
        }
    }
}

/// A path; empty where there is nothing to draw. Letters and numbers, thousands of them, have nothing to escape.
fn path(class: &str, d: &str) -> Markup {
    html! {
        @if !d.is_empty() {
            path class=(class) d=(PreEscaped(d)) {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(x: Axis, y: Axis) -> Chart {
        Chart {
            id: "c".to_owned(),
            title: "A <title>".to_owned(),
            description: "Words".to_owned(),
            width: 176.0,
            height: 148.0,
            x,
            y,
            x_label: "x, m".to_owned(),
            y_label: "y, s".to_owned(),
        }
    }

    /// Frame of 100 by 100 pixels from (64, 8) to (164, 108).
    fn unit() -> Chart {
        chart(Axis::within(0.0, 1.0, 2), Axis::within(0.0, 1.0, 2))
    }

    #[test]
    fn places_computed_by_hand() {
        let line = unit().polyline(&[(0.0, 0.0), (0.5, 1.0)], "a").into_string();
        assert_eq!(line, r#"<path class="line a" d="M64 108L114 8"></path>"#);
        let dots = unit().marks(&[(1.0, 0.25), (2.0, 0.0)], Mark::Dot, "b").into_string();
        assert_eq!(dots, r#"<path class="dot b" d="M164 83h0"></path>"#);
        assert_eq!(unit().beyond(&[(1.0, 0.25), (2.0, 0.0), (f64::NAN, 0.0)]), 2);
    }

    #[test]
    fn a_point_off_the_scales_breaks_the_line() {
        let points = [(0.0, 0.0), (0.1, 7.0), (0.2, 0.0), (0.3, 0.0)];
        let line = unit().polyline(&points, "a").into_string();
        assert!(line.contains("M64 108M84 108L94 108"), "{line}");
    }

    #[test]
    fn bars_are_as_high_as_their_counts() {
        let bins = Bins::around(&[0.1, 0.6, 0.7], 0.5);
        let chart = chart(Axis::within(0.0, 1.0, 2), Axis::within(0.0, 2.0, 2));
        let bars = chart.bars(&bins, &bins.histogram(&[0.1, 0.6, 0.7]), "a").into_string();
        assert!(bars.contains("M64 108V58H114V8H164V108Z"), "{bars}");
    }

    #[test]
    fn nothing_that_is_no_number_gets_out() {
        let odd = [f64::NAN, f64::INFINITY, -1e300, 0.0, 1e300, -0.0];
        let points: Vec<(f64, f64)> = odd.iter().flat_map(|x| odd.map(|y| (*x, y))).collect();
        for (low, high) in [(0.0, 0.0), (f64::NAN, 2.0), (-1e300, 1e300), (5.0, 5.0)] {
            let chart = chart(Axis::around(low, high, 5), Axis::within(low, high, 5));
            let marks = html! {
                (chart.polyline(&points, "a"))
                (chart.marks(&points, Mark::Ring, "a"))
                (chart.horizontal(f64::NAN, "a"))
            };
            let text = chart.draw(&marks).into_string();
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }

    #[test]
    fn a_chart_can_be_heard() {
        let text = unit().draw(&html! {}).into_string();
        assert!(text.contains(r#"role="img" aria-labelledby="c-title c-desc""#), "{text}");
        assert!(text.contains(r#"<title id="c-title">A &lt;title&gt;</title>"#), "{text}");
        assert!(text.contains(r#"<desc id="c-desc">Words</desc>"#), "{text}");
    }
}
