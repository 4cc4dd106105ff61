//! Sizes of each effect found, tail by tail.

use flight::effect::EffectId;
use maud::{Markup, html};
use pipeline::diagnosis_document::MagnitudeRecord;
use pipeline::fleet_diagnosis::{FleetTailRecord, size_words};

use super::words::{named, unit_words};
use super::{Fleet, Found, Whose};
use crate::chart::{Axis, Chart, Key, Mark, legend};
use pipeline::summary::counted;

/// Effects that are drawn, those found most often; the table has all. Our choice: some three screens.
const MOST_PANELS: usize = 8;
const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 190.0;
/// Room that a name's character takes on the scale, and that the chart leaves for names, in pixels.
const CHARACTER: f64 = 7.6;
const ROOM: f64 = 920.0;

/// One chart for each effect found, the tails in the same order in all.
pub(super) fn panels(fleet: &Fleet<'_>) -> Markup {
    html! {
        @if !fleet.effects.is_empty() && !fleet.tails.is_empty() {
            figure.wide {
                figcaption {
                    b { "Every tail, effect by effect." } " Sizes with 95 % intervals, what all share included. The tails are in one order in \
                    all charts: those with findings first, and of these the largest difference from the type, relative to the largest \
                    found of that effect."
                }
                (legend(&[
                    (Key::Mark(Mark::Disc), "before", "found: the aircraft differs"),
                    (Key::Mark(Mark::Diamond), "", "found: a sensor"),
                    (Key::Mark(Mark::Ring), "before", "found: the aircraft or a sensor"),
                    (Key::Mark(Mark::Dot), "observed", "no finding on this tail"),
                    (Key::Line, "mean after", "what all share"),
                ]))
                @for (place, effect) in fleet.effects.iter().take(MOST_PANELS).enumerate() {
                    p.panel { (title(effect)) }
                    div.scroll { (panel(fleet, effect, place)) }
                }
                @if fleet.effects.len() > MOST_PANELS {
                    p.note {
                        "The " (MOST_PANELS) " effects that were found most often; the table below has all "
                        (fleet.effects.len()) "."
                    }
                }
            }
        }
    }
}

/// The effect in words at the sign of what was found; both where both were, each with its side of zero.
fn title(effect: &Found<'_>) -> Markup {
    let values = || effect.findings.iter().map(|found| found.magnitude.value);
    let both = values().any(|value| value > 0.0) && values().any(|value| value < 0.0);
    match EffectId::from_name(effect.id).filter(|_| both) {
        Some(id) => html! {
            b { "Above zero: " (id.phrase(1.0)) "; below: " (id.phrase(-1.0)) } " "
            span.id { "(" (effect.id) ")" }
        },
        None => named(effect.id, values().sum()),
    }
}

fn panel(fleet: &Fleet<'_>, effect: &Found<'_>, place: usize) -> Markup {
    let sizes: Vec<(f64, &FleetTailRecord, &MagnitudeRecord)> = fleet
        .tails
        .iter()
        .enumerate()
        .filter_map(|(k, tail)| Some((k as f64 + 0.5, *tail, effect.size(tail)?)))
        .collect();
    let ends = sizes.iter().flat_map(|(_, _, size)| size.ci95).chain([effect.of_type.value]);
    let (low, high) =
        ends.fold((0.0, 0.0), |(low, high), end| (f64::min(low, end), f64::max(high, end)));
    let on_tails = effect.findings.iter().filter(|found| found.tail.is_some()).count();
    let chart = Chart {
        id: format!("fleet-{}-effect-{place}", fleet.number),
        title: format!("{}: {} of every tail", fleet.record.aircraft_type, effect.id),
        description: format!(
            "Sizes of {} with 95 % intervals on {}; found on {on_tails}; {} {} in the type. The table below has the numbers.",
            effect.id,
            counted(sizes.len(), "tail"),
            size_words(effect.of_type.value, effect.of_type.ci95),
            unit_words(effect.id, &effect.of_type.unit)
        ),
        width: WIDTH,
        height: HEIGHT,
        x: tails_axis(fleet),
        y: Axis::around(low, high, 5),
        x_label: if has_names(fleet) { "tail" } else { "tail, by rank" }.to_owned(),
        y_label: unit_words(effect.id, &effect.of_type.unit).to_owned(),
    };
    let of = |whose: Option<Whose>| -> Vec<(f64, f64)> {
        let is_of = |tail: &FleetTailRecord| effect.finding(&tail.tail).map(Whose::of) == whose;
        let those = sizes.iter().filter(|(_, tail, _)| is_of(tail));
        those.map(|(at, _, size)| (*at, size.value)).collect()
    };
    let intervals = |is_found: bool| -> Vec<(f64, (f64, f64))> {
        let those =
            sizes.iter().filter(|(_, tail, _)| effect.finding(&tail.tail).is_some() == is_found);
        those.map(|(at, _, size)| (*at, (size.ci95[0], size.ci95[1]))).collect()
    };
    let marks = html! {
        (chart.horizontal(0.0, "zero"))
        (chart.horizontal(effect.of_type.value, "mean after"))
        (chart.intervals(&intervals(false), "span"))
        (chart.intervals(&intervals(true), "interval"))
        (chart.marks(&of(None), Mark::Dot, "observed"))
        (chart.marks(&of(Some(Whose::Aircraft)), Mark::Disc, "before"))
        (chart.marks(&of(Some(Whose::Open)), Mark::Ring, "before"))
        (chart.marks(&of(Some(Whose::Sensor)), Mark::Diamond, ""))
        @for (at, tail, size) in &sizes {
            (chart.cell((at - 0.5, at + 0.5), (chart.y.first(), chart.y.last()), "hit", &tip(effect, tail, size)))
        }
    };
    chart.draw(&marks)
}

/// The names of the tails where there is room for them, else their ranks.
fn tails_axis(fleet: &Fleet<'_>) -> Axis {
    let names: Vec<String> = fleet.tails.iter().map(|tail| tail.tail.clone()).collect();
    if has_names(fleet) {
        Axis::of_names(&names)
    } else {
        Axis::within(0.0, names.len() as f64, 10)
    }
}

fn has_names(fleet: &Fleet<'_>) -> bool {
    let longest = fleet.tails.iter().map(|tail| tail.tail.chars().count()).max().unwrap_or(0);
    (longest as f64 + 1.0) * CHARACTER * fleet.tails.len() as f64 <= ROOM
}

fn tip(effect: &Found<'_>, tail: &FleetTailRecord, size: &MagnitudeRecord) -> String {
    let found = effect.finding(&tail.tail).map_or_else(String::new, |found| {
        format!(
            "\ndiffers by {} {}, probability {:.2}: {}",
            size_words(found.magnitude.value, found.magnitude.ci95),
            unit_words(effect.id, &size.unit),
            found.probability,
            Whose::of(found).words()
        )
    });
    let unit = unit_words(effect.id, &size.unit);
    format!("{}: {} {unit}{found}", tail.tail, size_words(size.value, size.ci95))
}
