//! A fleet in numbers: sizes by tail, every finding, sizes in the type.

use std::collections::BTreeMap;

use maud::{Markup, html};
use pipeline::diagnosis_document::MagnitudeRecord;
use pipeline::fleet_diagnosis::{FleetFindingRecord, FleetTailRecord, size_words};

use super::words::unit_words;
use super::{Fleet, Found, Whose};
use crate::shade;

/// Where tails have a section.
type Links<'a> = BTreeMap<&'a str, String>;

/// The tails with the sizes of every effect found; shaded by how much each differs from its type.
pub(super) fn tails(fleet: &Fleet<'_>, links: &Links<'_>) -> Markup {
    html! {
        h3 { "Tails" }
        p.note {
            "Sizes with half their 95 % intervals, what all share included. Marks: ● the aircraft differs, ◆ a sensor, ○ the aircraft or a \
             sensor; no mark, no finding. Shades: difference from the type, relative to the largest found of that effect; orange is \
             above, blue below. Noise: the scatter of a tail over what its sensors are stated to have."
        }
        div.scroll tabindex="0" role="region" aria-label=(format!("Tails of type {}", fleet.record.aircraft_type)) {
            table.fleet.heat.sort.data data-name=(format!("fleet-{}", fleet.record.aircraft_type)) {
                thead { tr {
                    th scope="col" { "tail" } th scope="col" { "findings" }
                    @for effect in &fleet.effects { th scope="col" { (effect.id) ", " (unit_words(effect.id, &effect.of_type.unit)) } }
                    th scope="col" { "flights" } th scope="col" { "segments" } th scope="col" { "noise" }
                } }
                tbody { @for tail in &fleet.tails { (tail_row(fleet, tail, links)) } }
                tfoot { tr {
                    th scope="row" { "what all share" }
                    td { (fleet.record.findings.iter().filter(|found| found.tail.is_none()).count()) }
                    @for effect in &fleet.effects { td { (size_words(effect.of_type.value, effect.of_type.ci95)) } }
                    td { (fleet.record.tails.iter().map(|tail| tail.flights).sum::<usize>()) }
                    td { (fleet.record.tails.iter().map(|tail| tail.segments).sum::<usize>()) }
                    td { "–" }
                } }
            }
        }
    }
}

fn tail_row(fleet: &Fleet<'_>, tail: &FleetTailRecord, links: &Links<'_>) -> Markup {
    let findings = fleet.effects.iter().filter(|effect| effect.finding(&tail.tail).is_some());
    let findings = findings.count();
    html! {
        tr {
            th scope="row" { (name(&tail.tail, links)) }
            td data-v=(findings) { (findings) }
            @for effect in &fleet.effects { (size_cell(effect, tail)) }
            td data-v=(tail.flights) { (tail.flights) }
            td data-v=(tail.segments) { (tail.segments) }
            td data-v=(tail.noise) { (format!("{:.2}", tail.noise)) }
        }
    }
}

fn name(tail: &str, links: &Links<'_>) -> Markup {
    html! {
        @match links.get(tail) {
            Some(link) => { a href=(link) { (tail) } }
            None => { (tail) }
        }
    }
}

fn size_cell(effect: &Found<'_>, tail: &FleetTailRecord) -> Markup {
    let mark = match effect.finding(&tail.tail).map(Whose::of) {
        Some(Whose::Aircraft) => " ●",
        Some(Whose::Sensor) => " ◆",
        Some(Whose::Open) => " ○",
        None => "",
    };
    html! {
        @match effect.size(tail) {
            Some(size) => {
                td class=(shade::class(effect.share(tail), 1.0)) data-v=(size.value) {
                    (size_words(size.value, size.ci95)) (mark)
                }
            }
            None => { td { "–" } }
        }
    }
}

/// Every finding, and the sizes of all effects in the type, folded.
pub(super) fn more(fleet: &Fleet<'_>, links: &Links<'_>) -> Markup {
    let name = &fleet.record.aircraft_type;
    html! {
        @if !fleet.record.findings.is_empty() {
            details.more {
                summary { "Every finding" }
                div.scroll tabindex="0" role="region" aria-label=(format!("Findings of type {name}")) {
                    table.findings.fleet.sort.data data-name=(format!("findings-{name}")) {
                        thead { tr {
                            th scope="col" { "whose" } th scope="col" { "level" } th scope="col" { "effect" } th scope="col" { "size" }
                            th scope="col" { "from" } th scope="col" { "to" } th scope="col" { "unit" } th scope="col" { "probability" }
                            th scope="col" { "of itself" } th scope="col" { "not distinguished from" }
                        } }
                        tbody { @for found in &fleet.record.findings { (finding_row(fleet, found, links)) } }
                    }
                }
            }
        }
        details.more {
            summary { "Sizes of all effects in the type" }
            div.scroll tabindex="0" role="region" aria-label=(format!("Sizes in type {name}")) {
                table.of-type.fleet.sort.data data-name=(format!("type-{name}")) {
                    thead { tr {
                        th scope="col" { "effect" } th scope="col" { "size" } th scope="col" { "from" } th scope="col" { "to" }
                        th scope="col" { "unit" }
                    } }
                    tbody { @for effect in &fleet.record.effects {
                        tr { th scope="row" { (effect.effect) } (magnitude_cells(&effect.magnitude)) }
                    } }
                }
            }
        }
    }
}

fn finding_row(fleet: &Fleet<'_>, found: &FleetFindingRecord, links: &Links<'_>) -> Markup {
    html! {
        tr {
            th scope="row" {
                @match &found.tail {
                    Some(tail) => (name(tail, links)),
                    None => { (fleet.record.aircraft_type) " (all)" }
                }
            }
            td { (found.levels.join(" or ")) }
            td { (found.effect) }
            (magnitude_cells(&found.magnitude))
            td data-v=(found.probability) { (format!("{:.3}", found.probability)) }
            td data-v=(found.effect_probability) { (format!("{:.3}", found.effect_probability)) }
            td { @if found.class.len() > 1 { (found.class[1..].join(", ")) } @else { "–" } }
        }
    }
}

/// Size, both ends of its interval, unit.
fn magnitude_cells(magnitude: &MagnitudeRecord) -> Markup {
    html! {
        @for value in [magnitude.value, magnitude.ci95[0], magnitude.ci95[1]] {
            td data-v=(value) { (crate::text::three_digits(value)) }
        }
        td { (magnitude.unit) }
    }
}
