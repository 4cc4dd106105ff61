//! A fleet's diagnosis in a terminal.

use core::fmt::Write;

use diagnose::{FleetFinding, FleetLevel, Magnitude, ModelOf};
use flight::effect::EffectId;

use super::{DiagnosedFleet, FleetGap, FleetRecord};
use crate::summary::{aligned, counted};

/// Most effects that the table of tails has columns for, the most frequent ones: what a terminal of usual width holds.
const MOST_COLUMNS: usize = 5;

/// What is said of a fleet whose model no flight has taught.
pub const TEACH_IT_FIRST: &str = "The model has learnt no flight: what all tails share may be an error of its table rather than an \
    effect. Teach it first (cruisefit adapt), and compare again.";

/// What all tails share where no effect of the type was found.
#[must_use]
pub fn nothing_shared(taught: bool, gap: Option<FleetGap>) -> String {
    match gap.filter(|gap| taught && gap.is_shared()) {
        Some(gap) => format!(
            "Something, and these flights do not decide what: all together {}, and no cause of it stands out.",
            gap.in_words()
        ),
        None if taught => "Nothing that the model lacks.".to_owned(),
        None => "Nothing that an error of the model's table would not explain.".to_owned(),
    }
}

/// What the comparison with its type says of a tail, in a sentence, from a document; `None` where nothing was found on it.
#[must_use]
pub fn of_tail_words(fleets: &[FleetRecord], tail: &str) -> Option<String> {
    let findings = fleets.iter().flat_map(|fleet| &fleet.findings);
    let told: Vec<String> = findings
        .filter(|found| found.tail.as_deref() == Some(tail))
        .map(|found| {
            let magnitude = &found.magnitude;
            let (phrase, unit) = EffectId::from_name(&found.effect).map_or_else(
                || (String::new(), magnitude.unit.as_str()),
                |id| (format!("{}, ", id.phrase(magnitude.value)), id.unit_words()),
            );
            let whose = match (found.levels.len(), found.level.as_str()) {
                (2.., _) => ", the aircraft or a sensor",
                (_, "sensor") => ", a sensor",
                _ => "",
            };
            format!(
                "{phrase}{} {} {unit} (probability {:.2}{whose})",
                found.effect,
                size_words(magnitude.value, magnitude.ci95),
                found.probability
            )
        })
        .collect();
    (!told.is_empty()).then(|| format!("It differs from its type by: {}.", told.join("; ")))
}

/// What was found, and a table of the tails on which something was.
#[must_use]
pub fn fleet_text(fleet: &DiagnosedFleet) -> String {
    let diagnosis = &fleet.diagnosis;
    let flights: usize = fleet.tails.iter().map(|member| member.reduced.flights).sum();
    let mut text = format!(
        "Fleet {}: {}, {}, {}.\n",
        fleet.aircraft_type,
        counted(fleet.tails.len(), "tail"),
        counted(flights, "flight"),
        match fleet.model_of {
            ModelOf::Type => "one model for all",
            ModelOf::Tail => "each tail against its own model",
        }
    );
    if !fleet.left_out.is_empty() {
        let _ =
            writeln!(text, "  Without a flight inside the table: {}.", fleet.left_out.join(", "));
    }
    let of_type: Vec<&FleetFinding> =
        diagnosis.findings.iter().filter(|found| found.level == FleetLevel::Type).collect();
    if of_type.is_empty() {
        let _ = writeln!(
            text,
            "  What all tails share: {}",
            nothing_shared(fleet.taught, fleet.mean_gap())
        );
    }
    for found in of_type {
        let _ = writeln!(text, "  The model of the type lacks {}.", told(found));
    }
    if !fleet.taught {
        let _ = writeln!(text, "  {TEACH_IT_FIRST}");
    }
    for found in diagnosis.findings.iter().filter(|found| found.tail.is_some()) {
        let whose = fleet.whose(found);
        let of = match found.levels[..] {
            [FleetLevel::Sensor] => " (a sensor)",
            [_, _, ..] => " (the aircraft or a sensor: not distinguished)",
            _ => "",
        };
        let _ = writeln!(text, "  {whose} differs by {}{of}.", told(found));
    }
    let _ = match diagnosis.findings.len() {
        0 => writeln!(text, "  No findings."),
        count => writeln!(
            text,
            "  {} in all, of which {:.1} % are expected to be false.",
            counted(count, "finding"),
            100.0 * diagnosis.false_share
        ),
    };
    text.push_str(&table(fleet));
    text
}

fn told(found: &FleetFinding) -> String {
    let mut words = format!(
        "{} {} {} (probability {:.2}",
        found.effect,
        size(&found.magnitude),
        found.effect.unit_words(),
        found.probability
    );
    if found.class.len() > 1 {
        let others: Vec<String> = found.class[1..].iter().map(ToString::to_string).collect();
        let _ =
            write!(words, "; itself {:.2}, or {}", found.effect_probability, others.join(" or "));
    }
    words.push(')');
    words
}

/// Sizes of the effects found, of the type and the tails on which something was found.
fn table(fleet: &DiagnosedFleet) -> String {
    let diagnosis = &fleet.diagnosis;
    let times = |place: usize| {
        let id = diagnosis.effects[place];
        diagnosis.findings.iter().filter(|found| found.effect == id).count()
    };
    let mut columns = fleet.found_effects();
    columns.sort_by_key(|&place| (core::cmp::Reverse(times(place)), place));
    columns.truncate(MOST_COLUMNS);
    columns.sort_unstable();
    if columns.is_empty() {
        return String::new();
    }
    let is_found = |tail: Option<usize>, place: usize| {
        let id = diagnosis.effects[place];
        diagnosis.findings.iter().any(|found| found.tail == tail && found.effect == id)
    };
    let row = |name: String, tail: Option<usize>, sizes: &[Magnitude]| {
        let of_effect = |&place: &usize| {
            let mark = if is_found(tail, place) { "*" } else { " " };
            format!("{}{mark}", size(&sizes[place]))
        };
        core::iter::once(name).chain(columns.iter().map(of_effect)).collect::<Vec<String>>()
    };
    let head = columns.iter().map(|&place| diagnosis.effects[place].to_string());
    let mut rows = vec![core::iter::once("tail".to_owned()).chain(head).collect::<Vec<String>>()];
    rows.push(row("all".to_owned(), None, &diagnosis.of_type));
    for (tail, member) in fleet.tails.iter().enumerate() {
        if diagnosis.findings.iter().any(|found| found.tail == Some(tail)) {
            rows.push(row(member.tail.clone(), Some(tail), &diagnosis.of_tails[tail]));
        }
    }
    let mut text = aligned(&rows);
    text.push_str(
        "  ± is half a 95 % interval, * a finding; sizes of tails include that of the type. 0 without an interval: none is \
         believed, since the tails do not differ beyond what was found.\n",
    );
    text
}

fn size(magnitude: &Magnitude) -> String {
    size_words(magnitude.value, magnitude.ci95)
}

/// A size with half of its 95 % interval: "+7.9 ± 1.2"; "0" where no size was believed, of which no flight says how sure that is.
#[must_use]
pub fn size_words(value: f64, ci95: [f64; 2]) -> String {
    let half = 0.5 * (ci95[1] - ci95[0]);
    if half <= 0.0 {
        return "0".to_owned();
    }
    // Two digits of the interval.
    let decimals = (1.0 - half.log10().floor()).clamp(0.0, 6.0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 6")]
    let decimals = decimals as usize;
    format!("{value:+.decimals$} ± {half:.decimals$}")
}
