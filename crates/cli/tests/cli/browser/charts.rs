//! What the scripts of a page add to charts: zoom, values, and surfaces that turn.

use std::path::Path;

use serde_json::{Value, json};

use super::driver::Browser;
use crate::support::{csv_columns, numbers as numbers_of};

/// Questions that all tests here ask of one chart, errors over time: its points lie on a scale of dates.
const CHART: &str = "const svg = [...document.querySelectorAll('svg[data-frame]')].find((one) =>
       one.querySelector('title').textContent.endsWith('error over time'));
     const frame = svg.dataset.frame.split(' ').map(Number);
     const points = () => [...svg.querySelectorAll('.dot,.disc')].flatMap((path) =>
       [...path.getAttribute('d').matchAll(/M([-\\d.]+) ([-\\d.]+)h0/g)].map((match) => [+match[1], +match[2]]));
     const ticks = () => [...svg.querySelectorAll('.tick')].map((tick) => tick.textContent);
     const box = () => { const { x, y, width } = svg.getBoundingClientRect(); return [x, y, width / svg.viewBox.baseVal.width]; };
     const tip = document.getElementById('tip');";
const ARROW_RIGHT: char = '\u{e014}';
const ESCAPE: char = '\u{e00c}';

/// Asks the page about the chart.
fn ask(browser: &Browser, question: &str) -> Value {
    browser.run(&format!("{CHART} {question}"))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|one| one.as_f64().unwrap()).collect()
}

/// Left and top edge of the chart in the window, and its scale.
fn scrolled_to(browser: &Browser) -> (f64, f64, f64) {
    let seen = numbers(&ask(browser, "svg.scrollIntoView({ block: 'center' }); return box();"));
    (seen[0], seen[1], seen[2])
}

/// A dragged rectangle fills the frame: as many points are in it as lay in the rectangle, on scales that give the same values; a
/// double click brings back every byte.
pub(super) fn check_zoom(browser: &Browser) {
    let whole = ask(browser, "return [svg.querySelector('.marks').innerHTML, ticks()];");
    let (left, top, scale) = scrolled_to(browser);
    let window = |x: f64, y: f64| ((left + x * scale).round(), (top + y * scale).round());
    let (from, to) = (window(150.0, 60.0), window(320.0, 200.0));
    // Edges in pixels of the drawing, as the pointer's whole pixels have them.
    let edge = |(x, y): (f64, f64)| ((x - left) / scale, (y - top) / scale);
    let ((l, t), (r, b)) = (edge(from), edge(to));
    let inside = format!(
        "return points().filter(([x, y]) => {l} <= x && x <= {r} && {t} <= y && y <= {b}).length;"
    );
    let expected = ask(browser, &inside).as_u64().unwrap();
    let all = ask(browser, "return points().length").as_u64().unwrap();
    assert!(0 < expected && expected < all, "{expected} of {all} points: a rectangle that tells");
    let of_first = "const k = points().findIndex(([x, y]) =>";
    let first = ask(
        browser,
        &format!(
            "{of_first} {l} < x && x < {r} && {t} < y && y < {b}); return [k, ...points()[k]];"
        ),
    );
    let first = numbers(&first);

    browser.drag(from, to);
    let shown = ask(
        browser,
        "const [l, r, t, b] = frame;
         return points().filter(([x, y]) => l <= x && x <= r && t <= y && y <= b).length;",
    );
    assert_eq!(shown.as_u64(), Some(expected), "points in the frame");
    assert_ne!(ask(browser, "return ticks();"), whole[1], "the scales follow");
    let at = numbers(&ask(browser, &format!("return points()[{}];", first[0])));
    check_scale(browser, "x", (first[1], at[0]));
    check_scale(browser, "y", (first[2], at[1]));

    // The value under the pointer is that of the point, wherever it is drawn; of some that lie together any.
    browser.point(left + at[0] * scale, top + at[1] * scale);
    let told = ask(browser, "return tip.style.display === 'block' ? tip.innerText : '';");
    let told_y: f64 = told.as_str().unwrap().rsplit(": ").next().unwrap().parse().unwrap();
    let meant = value(browser, "y", first[2]);
    let pixel = (value(browser, "y", t) - value(browser, "y", b)).abs() / 100.0;
    assert!((told_y - meant).abs() < 2.0 * pixel, "{told}: {meant}");

    browser.double_click(window(250.0, 100.0));
    let again = ask(browser, "return [svg.querySelector('.marks').innerHTML, ticks()];");
    assert_eq!(again, whole, "a double click goes back");
}

/// The value on a whole scale at a pixel of the drawing.
fn value(browser: &Browser, name: &str, at: f64) -> f64 {
    let ends =
        ask(browser, &format!("return [...svg.dataset.{name}.split(' ').map(Number), ...frame];"));
    let [first, last, left, right, top, bottom] = [0, 1, 2, 3, 4, 5].map(|k| numbers(&ends)[k]);
    let (from, to) = if name == "x" { (left, right) } else { (bottom, top) };
    first + (at - from) / (to - from) * (last - first)
}

/// The new scale gives a point that moved from `places.0` to `places.1` the value that it had: by its first and last label.
fn check_scale(browser: &Browser, name: &str, places: (f64, f64)) {
    let anchor = if name == "x" { "middle" } else { "end" };
    let labels = ask(
        browser,
        &format!(
            "const labels = [...svg.querySelectorAll('.tick[text-anchor={anchor}]')];
             return [labels[0], labels.at(-1)].map((tick) => [tick.getAttribute('{name}') - {},
               {}]);",
            if name == "x" { 0 } else { 4 },
            if name == "x" { "Date.parse(tick.textContent) / 1000" } else { "+tick.textContent" }
        ),
    );
    let (one, other) = (numbers(&labels[0]), numbers(&labels[1]));
    assert!((one[0] - other[0]).abs() > 20.0, "two labels: {labels}");
    let per_pixel = (other[1] - one[1]) / (other[0] - one[0]);
    let read = one[1] + (places.1 - one[0]) * per_pixel;
    let meant = value(browser, name, places.0);
    // The last label may give way to the drawing's edge; a date's is at its tick.
    assert!((read - meant).abs() < 2.0 * per_pixel.abs(), "{name}: {read} for {meant}");
}

/// `+` enlarges around the point that the arrow keys have reached, which keeps its value; `0` goes back.
pub(super) fn check_zoom_by_keys(browser: &Browser) {
    let whole = ask(browser, "svg.focus(); return ticks();");
    browser.press(&[ARROW_RIGHT; 40]);
    let told = ask(browser, "return tip.innerText;");
    browser.press(&['+', '+']);
    let near =
        ask(browser, "return [ticks().join() !== arguments[0], tip.innerText, tip.style.display];");
    assert_eq!(near, json!([true, told, "block"]));
    assert_ne!(ask(browser, "return ticks();"), whole);
    browser.press(&[ARROW_RIGHT]);
    assert_ne!(ask(browser, "return tip.innerText;"), told, "arrow keys still step");
    browser.press(&['-', '-']);
    assert_eq!(ask(browser, "return ticks();"), whole, "- undoes +");
    browser.press(&['+', '0']);
    assert_eq!(ask(browser, "return ticks();"), whole, "0 goes back");
    browser.press(&['+', ESCAPE]);
    assert_eq!(ask(browser, "return ticks();"), whole, "Escape goes back");
}

/// What is printed is the whole chart; on the screen it stays as it was.
pub(super) fn check_whole_in_print(browser: &Browser) {
    let whole = ask(browser, "svg.focus(); return ticks();");
    browser.press(&['+']);
    let part = ask(
        browser,
        "addEventListener('beforeprint', () => { window.printed = ticks(); }); return ticks();",
    );
    assert_ne!(part, whole);
    browser.print();
    assert_eq!(ask(browser, "return [window.printed, ticks()];"), json!([whole, part]));
    browser.press(&['0']);
}

/// The surface in three dimensions turns by dragging and by keys, what is nearest is painted last, and it goes back.
pub(super) fn check_turn(browser: &Browser) {
    const SOLID: &str = "const svg = document.querySelector('svg[data-turn]');
         const pieces = () => [...svg.querySelectorAll('[data-p]')];
         const drawn = () => pieces().map((one) => [one.getAttribute('d'), one.getAttribute('x'), one.getAttribute('y')].join());";
    let asked = |question: &str| browser.run(&format!("{SOLID} {question}"));
    let place = asked(
        // Values are filled in a moment after they are unfolded, and would move the drawing.
        "for (const fold of document.querySelectorAll('details:not(.values)')) fold.open = true;
         svg.scrollIntoView({ block: 'center' });
         const { x, y, width, height } = svg.getBoundingClientRect(); return [x + width / 2, y + height / 2];",
    );
    let at = numbers(&place);
    let home = asked("return drawn();");
    assert!(home.as_array().unwrap().len() > 100, "facets, bars, lines and labels: {home}");

    // Half a degree to a pixel: 120 pixels to the right turn it by 60°.
    browser.drag((at[0], at[1]), (at[0] + 120.0, at[1]));
    assert_ne!(asked("return drawn();"), home);
    let corners = asked(
        "const [azimuth, elevation, x0, y0, scale] = svg.dataset.turn.split(' ').map(Number);
         const corners = svg.dataset.at.split(',').map((corner) => corner.split(' ').map((one) => one / 1000));
         const facets = [...svg.querySelectorAll('.facet')].map((one) => [one.dataset.p.split(' ').map(Number), one.getAttribute('d')]);
         return [(azimuth + 60) * Math.PI / 180, elevation * Math.PI / 180, x0, y0, scale, corners, facets];",
    );
    let [azimuth, elevation, x0, y0, scale] =
        [0, 1, 2, 3, 4].map(|k: usize| corners[k].as_f64().unwrap());
    let mut last_away = f64::INFINITY;
    for facet in corners[6].as_array().unwrap() {
        let of = |k: usize| {
            numbers(&corners[5][usize::try_from(facet[0][k].as_u64().unwrap()).unwrap()])
        };
        let away = |corner: &[f64]| corner[0] * azimuth.sin() + corner[1] * azimuth.cos();
        let first = of(0);
        let x = x0 + scale * (first[0] * azimuth.cos() - first[1] * azimuth.sin());
        let y = y0 - scale * (first[2] * elevation.cos() + away(&first) * elevation.sin());
        let d = facet[1].as_str().unwrap();
        let begin: Vec<f64> =
            d[1..].split('L').next().unwrap().split(' ').map(|one| one.parse().unwrap()).collect();
        assert!((begin[0] - x).hypot(begin[1] - y) < 0.2, "{d}: expected {x} {y}");
        let middle = (0..4).map(|k| away(&of(k))).sum::<f64>() / 4.0;
        assert!(middle < last_away + 1e-9, "what is behind is painted first");
        last_away = middle;
    }

    // Of equally far pieces the order is free.
    let sorted = |drawn: &Value| {
        let mut drawn = drawn.as_array().unwrap().clone();
        drawn.sort_by_key(ToString::to_string);
        drawn
    };
    browser.double_click((at[0], at[1]));
    let is_home = || sorted(&asked("return drawn();")) == sorted(&home);
    assert!(is_home(), "a double click goes back");
    asked("svg.focus();");
    browser.press(&[ARROW_RIGHT]);
    assert!(!is_home(), "a key turns it");
    browser.press(&['0']);
    assert!(is_home(), "0 goes back");
}

/// What is saved from the chart of the gap over time are the gaps of the file beside the page, to a thousandth of the scale;
/// those off the scale are not drawn.
pub(super) fn check_values(browser: &Browser, gaps: &Path) {
    let saved = browser.run_waiting(
        "const chart = [...document.querySelectorAll('svg[data-frame]')]
           .find((svg) => svg.querySelector('title').textContent.endsWith('gap over time'));
         const fold = chart.closest('figure').querySelector('details.values');
         fold.open = true;
         await new Promise((done) => setTimeout(done, 200));
         let blob; URL.createObjectURL = (made) => { blob = made; return '#'; };
         HTMLAnchorElement.prototype.click = () => {};
         fold.querySelector('button.save').click();
         const lines = (await blob.text()).trim().split('\\r\\n').map((line) => line.slice(1, -1).split('\",\"'));
         return lines.filter(([series]) => series === 'segment before').map((fields) => +fields[2]);",
        "",
    );
    let mut saved: Vec<f64> =
        saved.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect();
    let mut recorded = numbers_of(&csv_columns(gaps), "gap_before_percent");
    saved.sort_by(f64::total_cmp);
    recorded.sort_by(f64::total_cmp);
    assert!(saved.len() + 3 >= recorded.len(), "{} of {}", saved.len(), recorded.len());
    for one in &saved {
        let nearest =
            recorded.iter().map(|other| (other - one).abs()).fold(f64::INFINITY, f64::min);
        assert!(nearest <= 0.01, "{one} is no gap of the file");
    }
}
