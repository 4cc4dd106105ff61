//! What a fleet's truth states: whose every planted effect is, and what was done when.

use core::fmt::Write;

use flight::Timestamp;
use flight::effect::{EffectGroup, StepTarget};
use serde::{Deserialize, Serialize};

use crate::effect::TruthEffect;

/// Whose a planted effect is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PlantedLevel {
    /// All tails have it.
    Type,
    /// One tail has it.
    Tail,
    /// One tail's sensors have it.
    Sensor,
}

impl PlantedLevel {
    /// Whose an effect is that one tail has.
    pub(crate) const fn on_a_tail(id: TruthEffect) -> Self {
        match id {
            TruthEffect::Library(id) => match id.entry().group {
                EffectGroup::Sensor => Self::Sensor,
                _ => Self::Tail,
            },
            TruthEffect::Outside(_) => Self::Tail,
        }
    }
}

/// An effect of a fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Planted {
    /// Whose it is.
    pub level: PlantedLevel,
    /// The tail; `None` for the type.
    pub tail: Option<String>,
    /// Which.
    pub effect: TruthEffect,
    /// Size in its unit; of the type, the mean that tails scatter about.
    pub size: f64,
    /// Of a step: drag or fuel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<StepTarget>,
    /// Since when; `None` for always. Of a step or history without a date, the middle of the dates.
    #[serde(default, with = "crate::effect::optional_timestamp")]
    pub from: Option<Timestamp>,
    /// Until when; `None` for ever.
    #[serde(default, with = "crate::effect::optional_timestamp")]
    pub until: Option<Timestamp>,
}

/// A row of `EVENTS.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetEvent {
    /// When.
    #[serde(with = "crate::effect::timestamp")]
    pub at: Timestamp,
    /// The tail.
    pub tail: String,
    /// Kind: `wash`, `engine_wash`, `engine_change`, or what the plan calls it.
    pub kind: String,
    /// Note.
    pub note: String,
    /// By how much it changes what it acts on, %: the airframe's zero-lift drag, or the TSFC of the engine. `None` for
    /// effects, whose size is with them.
    pub change_percent: Option<f64>,
}

/// `EVENTS.csv`, as `monitor`, `adapt` and `diagnose` read it.
#[must_use]
pub fn events_csv(events: &[FleetEvent]) -> String {
    let mut text = String::from("date,tail,kind,note\n");
    for event in events {
        let FleetEvent { at, tail, kind, note, .. } = event;
        let _ = writeln!(text, "{at},{},{},{}", field(tail), field(kind), field(note));
    }
    text
}

/// Quoted where it must be (RFC 4180).
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_quoted_where_it_must_be() {
        let event = FleetEvent {
            at: "2018-03-01T00:00:00Z".parse().unwrap(),
            tail: "T-001".to_owned(),
            kind: "retrofit".to_owned(),
            note: "\"sharklets\", both".to_owned(),
            change_percent: None,
        };
        assert_eq!(
            events_csv(&[event]),
            "date,tail,kind,note\n2018-03-01T00:00:00Z,T-001,retrofit,\"\"\"sharklets\"\", both\"\n"
        );
    }
}
