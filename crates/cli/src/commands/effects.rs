//! `cruisefit effects`: the library of effects, one after the other.

use std::fmt::Write;

use flight::effect::{EffectGroup, EffectId, EffectSign, TypicalSize};

use crate::commands::Outcome;
use crate::failure::Failure;
use pipeline::summary::aligned;
use pipeline::topics::typical;

const GROUPS: [(EffectGroup, &str); 6] = [
    (EffectGroup::Airframe, "Airframe"),
    (EffectGroup::Engine, "Engines"),
    (EffectGroup::Mass, "Mass and fuel quantity, as recorded"),
    (EffectGroup::Sensor, "Sensors, as recorded"),
    (EffectGroup::Environment, "Air and Earth"),
    (EffectGroup::Event, "Events"),
];

/// Runs the command.
///
/// # Errors
/// What JSON refuses to write; nothing that is known.
pub(crate) fn run() -> Result<Outcome, Failure> {
    let mut text = String::new();
    for (group, name) in GROUPS {
        let mut rows = vec![["effect", "unit", "typical", "needs"].map(str::to_owned).to_vec()];
        let in_group = EffectId::ALL.iter().filter(|id| id.entry().group == group);
        for id in in_group {
            let entry = id.entry();
            let needs =
                entry.needs.iter().map(|needed| needed.name()).collect::<Vec<_>>().join(" ");
            rows.push(vec![
                entry.name.to_owned(),
                entry.unit.to_owned(),
                typical(entry),
                if needs.is_empty() { "–".to_owned() } else { needs },
            ]);
        }
        let _ = writeln!(text, "{name}\n{}", aligned(&rows));
    }
    text.push_str("{k} is an engine's number, from 1. cruisefit explain EFFECT says more.\n");
    Ok(Outcome::with_json(text, as_json()?))
}

fn as_json() -> Result<String, Failure> {
    let effects: Vec<serde_json::Value> = EffectId::ALL
        .iter()
        .map(|id| {
            let entry = id.entry();
            serde_json::json!({
                "effect": entry.name,
                "unit": entry.unit,
                "typical": match entry.typical {
                    TypicalSize::Absolute(size) => Some(size),
                    TypicalSize::ShareOfMass(_) => None,
                    TypicalSize::Known => Some(1.0),
                },
                "typical_share_of_mass": match entry.typical {
                    TypicalSize::ShareOfMass(share) => Some(share),
                    _ => None,
                },
                "sign": match entry.sign {
                    EffectSign::Positive => "positive",
                    EffectSign::Either => "either",
                    EffectSign::Spread => "spread",
                },
                "needs": entry.needs.iter().map(|needed| needed.name()).collect::<Vec<_>>(),
                "perturbation": entry.perturbation,
                "positive": entry.phrase.positive,
                "negative": entry.phrase.negative,
            })
        })
        .collect();
    let mut text = serde_json::to_string_pretty(&effects)
        .map_err(|error| Failure::BadArgument { argument: "--json", reason: error.to_string() })?;
    text.push('\n');
    Ok(text)
}
