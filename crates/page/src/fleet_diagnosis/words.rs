//! What a fleet's diagnosis comes to, in words; what cannot be told apart, and what would tell it.

use std::collections::BTreeMap;
use std::fmt::Write;

use flight::effect::EffectId;
use maud::{Markup, html};
use pipeline::diagnosis_document::{SeparationRecord, TailDiagnosis};
use pipeline::fleet_diagnosis::{
    FleetFindingRecord, FleetRecord, TEACH_IT_FIRST, nothing_shared, size_words,
};

use super::{Fleet, Found, Whose};
use crate::text::capitalised;
use pipeline::summary::counted;

/// Tails named for each effect; the table has all. Our choice: a line or two.
const TAILS_NAMED: usize = 6;
/// Measurements named for each class. Our choice, as for a single tail.
const MEASUREMENTS_NAMED: usize = 3;

/// The answer, in a box.
pub(super) fn card(fleet: &Fleet<'_>) -> Markup {
    let record = fleet.record;
    let of_type: Vec<&FleetFindingRecord> =
        record.findings.iter().filter(|found| found.tail.is_none()).collect();
    let aircraft = of_tails(fleet, |whose| whose != Whose::Sensor);
    let sensors = of_tails(fleet, |whose| whose == Whose::Sensor);
    html! {
        dl.verdict.gap[!record.findings.is_empty()] {
            dt { "What all share" }
            dd {
                @if of_type.is_empty() { b { (nothing_shared(record.taught, record.mean_gap_percent)) } }
                @for found in &of_type { (shared(found)) }
            }
            dt { "Which tails differ" }
            dd { @if aircraft.is_empty() { b { "None." } } @for line in &aircraft { (line) } }
            dt { "Which sensors" }
            dd {
                @if sensors.is_empty() { b { (no_sensor_for_certain(record)) } }
                @for line in &sensors { (line) }
            }
            dt { "How sure" } dd { (how_sure(fleet)) }
            dt { "What to do" } dd { (what_to_do(fleet)) }
            @if !record.left_out.is_empty() {
                dt { "Left out" }
                dd { "Without a flight inside the table: " (record.left_out.join(", ")) "." }
            }
        }
    }
}

/// The effect in words at this sign, with its name in files; the name alone where the library does not have it.
pub(super) fn named(effect: &str, size: f64) -> Markup {
    let phrase = EffectId::from_name(effect).map(|id| capitalised(&id.phrase(size)));
    html! { @if let Some(phrase) = phrase { b { (phrase) } " " } span.id { "(" (effect) ")" } }
}

/// The unit of an effect's size in a sentence; as the document has it where the library does not have the effect.
pub(super) fn unit_words<'a>(effect: &str, unit: &'a str) -> &'a str {
    EffectId::from_name(effect).map_or(unit, |id| id.unit_words())
}

/// Where no sensor is found to be off for certain, some of what differs may be one.
fn no_sensor_for_certain(record: &FleetRecord) -> &'static str {
    let is_open =
        |found: &FleetFindingRecord| found.tail.is_some() && Whose::of(found) == Whose::Open;
    if record.findings.iter().any(is_open) {
        "None for certain; above it is said where a sensor may be what differs."
    } else {
        "None is found to be off."
    }
}

fn shared(found: &FleetFindingRecord) -> Markup {
    let magnitude = &found.magnitude;
    html! { div {
        (named(&found.effect, magnitude.value)) ": "
        (size_words(magnitude.value, magnitude.ci95)) " " (unit_words(&found.effect, &magnitude.unit)) ", probability "
        (format!("{:.2}", found.probability)) (or_others(found)) "."
    } }
}

fn or_others(found: &FleetFindingRecord) -> Markup {
    html! {
        @if found.class.len() > 1 {
            " (that it is this one " (format!("{:.2}", found.effect_probability)) "; else " (found.class[1..].join(", ")) ")"
        }
    }
}

/// A line for each effect and sign found on tails that are of such a kind, those that differ most first: one engine burns more
/// on a tail, less on another.
fn of_tails(fleet: &Fleet<'_>, is_such: impl Fn(Whose) -> bool) -> Vec<Markup> {
    let line = |(effect, sign): (&Found<'_>, f64)| {
        let is_of = |found: &FleetFindingRecord| {
            let of_sign = found.magnitude.value.is_sign_negative() == sign.is_sign_negative();
            found.tail.is_some() && of_sign && is_such(Whose::of(found))
        };
        let mut found: Vec<&FleetFindingRecord> =
            effect.findings.iter().filter(|found| is_of(found)).copied().collect();
        found.sort_by(|one, other| {
            other.magnitude.value.abs().total_cmp(&one.magnitude.value.abs())
        });
        let told: Vec<String> =
            found.iter().take(TAILS_NAMED).map(|found| tail_words(found)).collect();
        let more = found.len().saturating_sub(TAILS_NAMED);
        (!found.is_empty()).then(|| {
            html! { div {
                (named(&found[0].effect, sign)) ": " (told.join("; "))
                @if more > 0 { "; " (more) " more in the table" }
                "."
            } }
        })
    };
    let signs = fleet.effects.iter().flat_map(|effect| [(effect, 1.0), (effect, -1.0)]);
    signs.filter_map(line).collect()
}

/// "F-3 +2.9 ± 0.4 K (the aircraft or a sensor)".
fn tail_words(found: &FleetFindingRecord) -> String {
    let magnitude = &found.magnitude;
    let mut words = format!(
        "{} {} {}",
        found.tail.as_deref().unwrap_or_default(),
        size_words(magnitude.value, magnitude.ci95),
        unit_words(&found.effect, &magnitude.unit)
    );
    let mut asides = Vec::new();
    if Whose::of(found) == Whose::Open {
        asides.push(Whose::Open.words().to_owned());
    }
    if found.class.len() > 1 {
        asides.push(format!("or {}", found.class[1..].join(", ")));
    }
    if !asides.is_empty() {
        let _ = write!(words, " ({})", asides.join("; "));
    }
    words
}

fn how_sure(fleet: &Fleet<'_>) -> String {
    let record = fleet.record;
    let least = record.findings.iter().map(|found| found.probability).reduce(f64::min);
    let findings = match least {
        None => "Nothing acts with a probability that would do for a finding.".to_owned(),
        Some(least) => format!(
            "{}, {} a probability of {least:.2}{}; {:.1} % expected to be false.",
            capitalised(&counted(record.findings.len(), "finding")),
            if record.findings.len() == 1 { "with" } else { "each with" },
            if record.findings.len() == 1 { "" } else { " or more" },
            100.0 * record.false_share
        ),
    };
    format!(
        "{findings} Beyond findings tails differ by {:.2} of an effect's typical size, and a smooth discrepancy of {:.2} % of fuel flow is \
         common to all.",
        record.spread_of_typical, record.smooth_discrepancy_percent
    )
}

fn what_to_do(fleet: &Fleet<'_>) -> Markup {
    let findings = &fleet.record.findings;
    let clear = |found: &&FleetFindingRecord| found.class.len() == 1;
    let on_tails = || findings.iter().filter(|found| found.tail.is_some()).map(Whose::of);
    let sensors = on_tails().any(|whose| whose == Whose::Sensor);
    let undecided = fleet.record.mean_gap_percent.is_some_and(|gap| gap.is_shared());
    let perhaps = on_tails().any(|whose| whose == Whose::Open);
    html! {
        @if !fleet.record.taught {
            div { (TEACH_IT_FIRST) }
        } @else if undecided && findings.iter().all(|found| found.tail.is_some()) {
            div { "Do not leave the model as it is: look at the tails' own pages, each of which says what would decide." }
        } @else if findings.is_empty() {
            "Nothing: the model can stay as it is."
        } @else if findings.iter().filter(clear).any(|found| found.tail.is_none()) {
            div { "Put what all share into the model of the type: the same run with " code { "--apply FOLDER" } " writes it." }
        }
        @if findings.iter().filter(clear).any(|found| found.tail.is_some()) {
            div { "Look into the tails named: " code { "--apply FOLDER" } " writes a model for each with its own effects; a finding after \
                maintenance or a repair has a date in the records." }
        }
        @if sensors {
            div { "Have the sensors named checked before the aircraft is blamed: a sensor's error changes what is recorded, not what is burnt." }
        } @else if perhaps {
            div { "Where it is the aircraft or a sensor, have the sensor checked first: its error changes what is recorded, not what is burnt." }
        }
        @if findings.iter().any(|found| found.class.len() > 1) {
            div { "What cannot be told apart is not applied; below is what would tell it." }
        }
    }
}

/// Classes of more than one effect, each once, with what would tell them apart by the diagnoses of the tails alone.
pub(super) fn apart(fleet: &Fleet<'_>, diagnoses: &[TailDiagnosis]) -> Markup {
    let mut classes: BTreeMap<&[String], Vec<&FleetFindingRecord>> = BTreeMap::new();
    for found in fleet.record.findings.iter().filter(|found| found.class.len() > 1) {
        classes.entry(&found.class).or_default().push(found);
    }
    html! {
        @if !classes.is_empty() {
            h3 { "What cannot be told apart, and what would tell it" }
            ul {
                @for (class, findings) in &classes {
                    li {
                        b { (class.join(" or ")) } " (" (places(findings)) "): "
                        @let told = measurements(fleet, class, diagnoses);
                        @if told.is_empty() { "no single measurement known to the program would." }
                        @for (place, (measurement, separation)) in told.iter().enumerate() {
                            @if place > 0 { "; " }
                            (measurement) " (from " (separation.from) ": " (format!("{:.1}", separation.distance_now)) " to "
                            (format!("{:.1}", separation.distance_then)) " standard deviations)"
                        }
                        @if !told.is_empty() { "." }
                    }
                }
            }
        }
    }
}

/// "the type, F-3 and 4 more".
fn places(findings: &[&FleetFindingRecord]) -> String {
    let names = findings.iter().map(|found| found.tail.as_deref().unwrap_or("the type"));
    let mut told = names.take(TAILS_NAMED).collect::<Vec<_>>().join(", ");
    if findings.len() > TAILS_NAMED {
        let _ = write!(told, " and {} more", findings.len() - TAILS_NAMED);
    }
    told
}

/// Measurements that distinguish the first of a class from another of it, those that most tails name first; each with the least
/// that it is worth on any of them.
fn measurements<'a>(
    fleet: &Fleet<'_>,
    class: &[String],
    diagnoses: &'a [TailDiagnosis],
) -> Vec<(&'a str, &'a SeparationRecord)> {
    let is_member =
        |one: &&TailDiagnosis| fleet.record.tails.iter().any(|member| member.tail == one.tail);
    let mut told: BTreeMap<&str, (usize, &SeparationRecord)> = BTreeMap::new();
    for one in diagnoses.iter().filter(is_member) {
        let of_effect = one.detectable.iter().filter(|known| known.effect == class[0]);
        let of_verdict = (one.verdict.effects.first() == class.first()).then_some(&one.verdict);
        let separations = of_effect
            .flat_map(|known| &known.separations)
            .chain(of_verdict.into_iter().flat_map(|verdict| &verdict.separations));
        for separation in separations.filter(|one| class[1..].contains(&one.from)) {
            let known = told.entry(&separation.measurement).or_insert((0, separation));
            known.0 += 1;
            if separation.distance_then < known.1.distance_then {
                known.1 = separation;
            }
        }
    }
    let mut ranked: Vec<(&str, (usize, &SeparationRecord))> = told.into_iter().collect();
    ranked.sort_by(|(_, one), (_, other)| {
        let by_distance = other.1.distance_then.total_cmp(&one.1.distance_then);
        other.0.cmp(&one.0).then(by_distance)
    });
    ranked.into_iter().take(MEASUREMENTS_NAMED).map(|(words, (_, one))| (words, one)).collect()
}
