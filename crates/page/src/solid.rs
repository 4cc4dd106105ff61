//! Drawings in three dimensions, seen from above at an angle, without perspective; nothing here is specific to aviation.

use std::collections::BTreeMap;
use std::fmt::Write;

use maud::{Markup, PreEscaped, html};

use crate::chart::{pixel, push_point};

const WIDTH: f64 = 500.0;
const HEIGHT: f64 = 350.0;
/// The middle of the box in the drawing, and pixels of half its side.
const MIDDLE: (f64, f64) = (258.0, 172.0);
const SCALE: f64 = 122.0;

/// From where a drawing is seen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Camera {
    /// By how much the box is turned about its upright axis, °.
    azimuth_deg: f64,
    /// How far above the horizon the eye is, °.
    elevation_deg: f64,
}

/// A camera's angles by their sines and cosines: a drawing has thousands of corners to be seen.
#[derive(Clone, Copy, Debug)]
struct Eye {
    azimuth: (f64, f64),
    elevation: (f64, f64),
}

/// A corner as it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    /// To the right.
    across: f64,
    up: f64,
    /// Away from the eye, along the floor: what is behind, whatever its height.
    away: f64,
}

/// Pieces of a drawing, in the painter's order when it is drawn.
pub(crate) struct Solid {
    camera: Camera,
    eye: Eye,
    /// In thousandths.
    corners: Vec<[f64; 3]>,
    /// The number of each, by its bits: a drawing has hundreds, each joined by several pieces.
    numbers: BTreeMap<[u64; 3], usize>,
    /// Never in front of anything.
    below: String,
    pieces: Vec<(f64, String)>,
    texts: String,
}

impl Camera {
    /// As drawn: the corner of the smallest values is nearest.
    pub(crate) const HOME: Self = Self { azimuth_deg: 35.0, elevation_deg: 28.0 };

    fn eye(self) -> Eye {
        Eye {
            azimuth: self.azimuth_deg.to_radians().sin_cos(),
            elevation: self.elevation_deg.to_radians().sin_cos(),
        }
    }
}

impl Eye {
    /// A corner of the box: first to the right, second away, third up, then turned and seen from above.
    fn see(self, [first, second, third]: [f64; 3]) -> Seen {
        let (sin, cos) = self.azimuth;
        let (sin_elevation, cos_elevation) = self.elevation;
        let away = first * sin + second * cos;
        Seen {
            across: first * cos - second * sin,
            up: third * cos_elevation + away * sin_elevation,
            away,
        }
    }
}

impl Solid {
    /// An empty drawing.
    pub(crate) fn new(camera: Camera) -> Self {
        let (below, texts) = (String::new(), String::new());
        let (corners, numbers) = (Vec::new(), BTreeMap::new());
        let eye = camera.eye();
        Self { camera, eye, corners, numbers, below, pieces: Vec::new(), texts }
    }

    /// Lines on the floor, behind everything.
    pub(crate) fn below(&mut self, class: &str, at: &[[f64; 3]]) {
        let path = self.path(class, at, "", &[]);
        self.below.push_str(&path);
    }

    /// A facet (class `cell`) or a line, in front of what is farther away, with words for the pointer.
    pub(crate) fn piece(&mut self, class: &str, at: &[[f64; 3]], tip: &str) {
        let path = self.path(class, at, tip, &[]);
        self.pieces.push((self.away(at), path));
    }

    /// Dots on a facet that was drawn before, just in front of it.
    pub(crate) fn dots_on(&mut self, facet: &[[f64; 3]], class: &str, at: &[[f64; 3]]) {
        if !at.is_empty() {
            let path = self.path(class, at, "", facet);
            self.pieces.push((self.away(facet), path));
        }
    }

    /// How far away corners are in the mean.
    fn away(&self, at: &[[f64; 3]]) -> f64 {
        at.iter().map(|corner| self.eye.see(*corner).away).sum::<f64>() / at.len() as f64
    }

    /// Words at a place, in front of everything.
    pub(crate) fn text(&mut self, class: &str, at: [f64; 3], words: &str) {
        let (x, y) = self.place(at);
        let corner = self.corner(at);
        let text = html! {
            text class=(class) text-anchor="middle" x=(pixel(x)) y=(pixel(y)) data-p=(corner) { (words) }
        };
        self.texts.push_str(&text.into_string());
    }

    /// The drawing.
    pub(crate) fn draw(mut self, id: &str, title: &str, description: &str) -> Markup {
        // Of equally far ones the order in which they came: the same bytes everywhere.
        self.pieces.sort_by(|one, other| other.0.total_cmp(&one.0));
        let mut corners = String::new();
        for corner in &self.corners {
            let [first, second, third] = corner;
            let separator = if corners.is_empty() { "" } else { "," };
            let _ = write!(corners, "{separator}{first} {second} {third}");
        }
        let camera = self.camera;
        html! {
            svg viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) data-at=(corners)
                data-turn=(format!("{} {} {} {} {SCALE}", camera.azimuth_deg, camera.elevation_deg, MIDDLE.0, MIDDLE.1))
                role="img" aria-labelledby=(format!("{id}-title {id}-desc")) {
                title id=(format!("{id}-title")) { (title) }
                desc id=(format!("{id}-desc")) { (description) }
                (PreEscaped(&self.below))
                g class="pieces" { @for (_, piece) in &self.pieces { (PreEscaped(piece)) } }
                (PreEscaped(&self.texts))
            }
        }
    }

    /// Where a corner is drawn: as rounded as the script has it, so that what it draws at first is the same.
    fn place(&self, at: [f64; 3]) -> (f64, f64) {
        let seen = self.eye.see(at.map(|one| thousandths(one) / 1000.0));
        (MIDDLE.0 + SCALE * seen.across, MIDDLE.1 - SCALE * seen.up)
    }

    /// The number of a corner.
    fn corner(&mut self, at: [f64; 3]) -> usize {
        let at = at.map(thousandths);
        *self.numbers.entry(at.map(f64::to_bits)).or_insert_with(|| {
            self.corners.push(at);
            self.corners.len() - 1
        })
    }

    /// A closed outline for facets, a dot at each corner for dots, else a line through each pair of corners; as far away as `on`
    /// where that is not itself.
    fn path(&mut self, class: &str, at: &[[f64; 3]], tip: &str, on: &[[f64; 3]]) -> String {
        let (is_facet, is_dots) = (class.starts_with("cell"), class.starts_with("dot"));
        let mut d = String::new();
        for (k, corner) in at.iter().enumerate() {
            let begins = is_dots || if is_facet { k == 0 } else { k.is_multiple_of(2) };
            push_point(&mut d, if begins { 'M' } else { 'L' }, self.place(*corner));
            d.push_str(if is_dots { "h0" } else { "" });
        }
        d.push_str(if is_facet { "Z" } else { "" });
        let (numbers, on) = (self.numbers(at), self.numbers(on));
        html! {
            path class=(class) d=(PreEscaped(d)) data-p=(PreEscaped(numbers))
                data-on=[(!on.is_empty()).then_some(PreEscaped(on))]
                data-tip=[(!tip.is_empty()).then_some(tip)] {}
        }
        .into_string()
    }

    /// The numbers of corners.
    fn numbers(&mut self, at: &[[f64; 3]]) -> String {
        let mut text = String::new();
        for corner in at {
            let separator = if text.is_empty() { "" } else { " " };
            let _ = write!(text, "{separator}{}", self.corner(*corner));
        }
        text
    }
}

/// Rounded, without a sign of zero.
fn thousandths(one: f64) -> f64 {
    (1000.0 * one).round() + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: turned by 30°, seen from 30° above, with sin 30° = 1/2 and cos 30° = √3/2 = 0.8660.
    #[test]
    fn corners_projected_by_hand() {
        let camera = Camera { azimuth_deg: 30.0, elevation_deg: 30.0 };
        let expected = [
            // To the right: cos 30° across, sin 30° away, which is seen sin 30° · sin 30° higher.
            ([1.0, 0.0, 0.0], [0.8660, 0.25, 0.5]),
            // Away: sin 30° to the left, cos 30° away, seen sin 30° · cos 30° higher.
            ([0.0, 1.0, 0.0], [-0.5, 0.4330, 0.8660]),
            // Up: seen shorter by cos 30°, and not farther along the floor.
            ([0.0, 0.0, 1.0], [0.0, 0.8660, 0.0]),
            // Sums: −0.8660 + 0.5; −0.25 − 0.4330 − 0.4330; −0.5 − 0.8660.
            ([-1.0, -1.0, -0.5], [-0.3660, -1.1160, -1.3660]),
        ];
        for (corner, by_hand) in expected {
            let Seen { across, up, away } = camera.eye().see(corner);
            for (found, by_hand) in [across, up, away].into_iter().zip(by_hand) {
                assert!((found - by_hand).abs() < 1e-4, "{corner:?}: {found} {by_hand}");
            }
        }
    }

    #[test]
    fn pieces_are_placed_and_painted_from_behind() {
        // Neither turned nor raised: across and up as they are.
        let mut solid = Solid::new(Camera { azimuth_deg: 0.0, elevation_deg: 0.0 });
        let facet =
            |away: f64| [[0.0, away, 0.0], [1.0, away, 0.0], [1.0, away, 0.5], [0.0, away, 0.5]];
        solid.piece("cell near", &facet(-1.0), "<n>");
        solid.piece("cell far", &facet(1.0), "");
        solid.dots_on(&facet(1.0), "dot", &[[0.0, -2.0, -0.5]]);
        solid.text("tick", [0.0, 0.0, 0.0], "a<b");
        let text = solid.draw("s", "T", "D").into_string();
        let at = |what: &str| text.find(what).unwrap();
        assert!(
            at("cell far") < at("\"dot")
                && at("\"dot") < at("cell near")
                && at("cell near") < at("a&lt;b")
        );
        // From the middle at (258, 172), 122 pixels to a side: 258 + 122 = 380, 172 − 61 = 111.
        assert!(text.contains("M258 172L380 172L380 111L258 111Z"), "{text}");
        assert!(text.contains("M258 233h0"), "{text}");
        assert!(text.contains("data-tip=\"&lt;n&gt;\""), "{text}");
        assert!(text.contains("data-at=\"0 -1000 0,1000 -1000 0,"), "{text}");
    }
}
