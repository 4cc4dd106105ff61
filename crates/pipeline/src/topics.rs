//! What an effect, a column, a set of criteria, a verdict or a figure of an output is, from the library's own entries.

use std::fmt::Write;

use flight::column::Column;
use flight::effect::{
    EffectEntry, EffectId, EffectSign, HiddenParameter, NeededInput, TypicalSize,
};
use segmenter::TrimCriteria;

mod outputs;

use outputs::OUTPUTS;

/// Verdicts of a diagnosis.
const VERDICTS: [(&str, &str); 4] = [
    (
        "no_gap",
        "No effect is seen: nothing is beyond the noise, or nothing beyond it is the same from\n\
         flight to flight. The diagnosis says how large each effect would have to be to be seen.",
    ),
    (
        "effects",
        "One effect, or a set acting together, explains the gap. The class lists the effects that\n\
         these flights cannot tell from the first; the advice says what would.",
    ),
    (
        "outside_library",
        "A gap that is real and that no effect of the library explains. Nothing is applied unless\n\
         `cruisefit diagnose --effects outside` asks for the form that describes it: look at what\n\
         the flights have in common in that place, or record more signals.",
    ),
    (
        "insufficient_data",
        "Too little to say anything: too few flights or segments, or all at one condition.",
    ),
];
/// What a topic is, in words.
///
/// # Errors
/// A topic that is not known; the nearest one is named.
pub fn explain(topic: &str) -> Result<String, String> {
    EffectId::from_name(topic)
        .or_else(|| EffectId::ALL.iter().copied().find(|id| id.entry().name == topic))
        .map(effect)
        .or_else(|| column_of(topic).map(column))
        .or_else(|| TrimCriteria::preset(topic).map(|found| criteria(topic, &found)))
        .or_else(|| verdict(topic))
        .or_else(|| outputs::explain(topic))
        .ok_or_else(|| unknown(topic))
}

/// The page of the book: every topic as it is printed for one, so that book and program have one text.
pub fn book() -> String {
    let mut text = String::from(
        "# Topics\n\nWhat `cruisefit explain TOPIC` prints, made by `cruisefit explain --book`.\n",
    );
    let effects = EffectId::ALL.iter().map(|id| (id.entry().name.to_owned(), effect(*id)));
    let columns = Column::ALL.into_iter().map(|one| (one.name(), column(one)));
    let sets = TrimCriteria::PRESETS.into_iter().filter_map(|name| {
        TrimCriteria::preset(name).map(|found| (name.to_owned(), criteria(name, &found)))
    });
    let verdicts = VERDICTS
        .into_iter()
        .filter_map(|(name, _)| verdict(name).map(|text| (name.to_owned(), text)));
    append_part("Effects", effects, &mut text);
    append_part("Columns of a report", columns, &mut text);
    append_part("Trim criteria", sets, &mut text);
    append_part("Verdicts", verdicts, &mut text);
    let outputs = OUTPUTS
        .iter()
        .filter_map(|one| outputs::explain(one.name).map(|text| (one.name.to_owned(), text)));
    append_part("Columns and figures of outputs", outputs, &mut text);
    text
}

/// Every topic.
pub fn topics() -> Vec<String> {
    let effects = EffectId::library(2).into_iter().map(|id| id.to_string());
    let columns = Column::ALL.into_iter().map(Column::name);
    let others = TrimCriteria::PRESETS
        .into_iter()
        .chain(VERDICTS.map(|(name, _)| name))
        .chain(OUTPUTS.iter().map(|one| one.name));
    effects.chain(columns).chain(others.map(str::to_owned)).collect()
}

/// The names of all topics, by kind.
pub fn overview() -> String {
    let list = |names: Vec<String>| {
        let mut text = String::new();
        let mut length = 0;
        for name in names {
            if length > 0 && length + name.len() + 2 > 78 {
                text.push_str("\n ");
                length = 0;
            }
            let _ = write!(text, " {name}");
            length += name.len() + 1;
        }
        text
    };
    format!(
        "cruisefit explain TOPIC, where TOPIC is\n\nan effect:\n {}\n\na column of a report:\n {}\n\ntrim criteria:\n {}\n\n\
         a verdict:\n {}\n\na column or figure of an output:\n {}\n",
        list(EffectId::ALL.iter().map(|id| id.entry().name.to_owned()).collect()),
        list(Column::ALL.into_iter().map(Column::name).collect()),
        list(TrimCriteria::PRESETS.map(str::to_owned).to_vec()),
        list(VERDICTS.map(|(name, _)| name.to_owned()).to_vec()),
        list(OUTPUTS.iter().map(|one| one.name.to_owned()).collect())
    )
}

/// Usual size of an effect in its unit.
pub fn typical(entry: &EffectEntry) -> String {
    match entry.typical {
        TypicalSize::Absolute(size) => size.to_string(),
        TypicalSize::ShareOfMass(share) => format!("{} % of mass", 100.0 * share),
        TypicalSize::Known => "1, known".to_owned(),
    }
}

fn append_part(name: &str, topics: impl Iterator<Item = (String, String)>, text: &mut String) {
    let _ = writeln!(text, "\n## {name}");
    for (topic, explained) in topics {
        let _ = write!(text, "\n### `{topic}`\n\n```text\n{explained}```\n");
    }
}

fn effect(id: EffectId) -> String {
    let entry = id.entry();
    let mut text = format!("{id}: {}\n\n", id.phrase(1.0));
    if id.phrase(-1.0) != id.phrase(1.0) {
        let _ = writeln!(text, "Negative:    {}", id.phrase(-1.0));
    }
    let _ = writeln!(text, "Model:       {}", entry.perturbation);
    let _ = writeln!(text, "Unit of θ:   {}", entry.unit);
    let _ = writeln!(text, "Usual size:  {}", typical(entry));
    let sign = match entry.sign {
        EffectSign::Positive => "positive, by physics",
        EffectSign::Either => "either",
        EffectSign::Spread => "none: the size is a standard deviation",
    };
    let _ = writeln!(text, "Sign:        {sign}");
    let in_words = |needed: &NeededInput| match needed {
        NeededInput::AntiIce => "A/I (not recorded: assumed on above −40 °C)",
        NeededInput::StaticAirTemperature => "SAT (recorded, not assumed)",
        other => other.name(),
    };
    let needs: Vec<&str> = entry.needs.iter().map(in_words).collect();
    let needs = if needs.is_empty() { "the required columns".to_owned() } else { needs.join(", ") };
    let _ = writeln!(text, "Needs:       {needs}");
    let driven: Vec<&str> = entry.driven_by.iter().map(|variable| variable.name()).collect();
    let driven = if driven.is_empty() {
        "nothing: it is the same everywhere".to_owned()
    } else {
        driven.join(", ")
    };
    let _ = writeln!(text, "Depends on:  {driven}");
    if entry.hidden != HiddenParameter::None {
        let _ = writeln!(text, "Parameter:   {}", entry.hidden);
    }
    text.push_str(if id.is_of_recordings() {
        "\nAn error of the recording: applied, it corrects recordings and changes no prediction.\n"
    } else {
        "\nApplied, it changes predictions.\n"
    });
    text
}

/// A column by its name; of the engines' columns also without a number.
fn column_of(topic: &str) -> Option<Column> {
    Column::from_name(topic).or_else(|| {
        Column::ALL.into_iter().find(|column| column.name().split('(').next() == Some(topic))
    })
}

fn column(column: Column) -> String {
    let units: Vec<&str> = column.units().iter().map(|unit| unit.name).collect();
    format!(
        "{}: {}\n\nUnits:     {}\nRange:     {}\nRequired:  {}\n",
        column.name(),
        column.meaning(),
        units.join(", "),
        column.range().words,
        if column.is_optional() {
            "no"
        } else if column.missing().is_some() {
            "yes; MISSING states that it is not recorded"
        } else {
            "yes"
        }
    )
}

fn criteria(name: &str, found: &TrimCriteria) -> String {
    format!(
        "{name}: largest changes within a stabilised segment\n\n\
         pressure altitude       {} ft\nvertical speed          {} ft/min\nMach number             {}\n\
         ground speed            {} kt\nstatic air temperature  {} °C\nN2                      {} %\n\
         drift                   {}\nroll                    {}°\nlongest piece           {} s\nshortest segment        {} s\n",
        found.pressure_altitude_ft,
        found.vertical_speed_ft_min,
        found.mach,
        found.ground_speed_kt,
        found.static_air_temperature_c,
        found.n2_percent,
        if found.drift_deg.is_finite() {
            format!("{}°", found.drift_deg)
        } else {
            "no limit".to_owned()
        },
        found.roll_deg,
        found.piece_maximum_s,
        found.segment_minimum_s
    )
}

fn verdict(topic: &str) -> Option<String> {
    let (name, words) = VERDICTS.iter().find(|(name, _)| *name == topic)?;
    Some(format!("{name}\n\n{words}\n"))
}

fn unknown(topic: &str) -> String {
    let topics = topics();
    let meant = report::nearest(topic, topics.iter().map(String::as_str)).map_or_else(
        || "; cruisefit explain lists them".to_owned(),
        |name| format!("; did you mean {name}?"),
    );
    format!("{topic:?} is no effect, column, criteria, verdict or figure{meant}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_topic_is_explained() {
        for topic in topics() {
            let text = explain(&topic).unwrap();
            assert!(text.starts_with(&topic) && text.lines().count() > 2, "{topic}: {text}");
        }
    }

    #[test]
    fn a_topic_that_was_meant() {
        assert!(explain("tsfc_engine2").unwrap_err().contains("tsfc_engine_2"));
        assert!(explain("zzzzzzzzzzzz").unwrap_err().contains("lists them"));
    }
}
