//! `PLAN.ron` of a trial: which effects, how large, against which model, on which background, how often.

use flight::effect::{EffectId, TypicalSize};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use simulate::{AircraftChoice, Columns, OutsideEffect, SensorChoice, TruthEffect};

use crate::fleets::{FleetPart, FleetSpec};

mod part;

pub use part::{Background, Floor, Kind, Part, ReferenceModel};

const SHORT: &str = include_str!("../embedded/TRIAL-SHORT.ron");
const LONG: &str = include_str!("../embedded/TRIAL-LONG.ron");
/// Most cases of one plan: numbers of cases have five digits.
const MOST_CASES: usize = 99_999;

/// A plan of trials. Only `seed` is required, and `parts` or `fleets`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialPlan {
    /// Every random number comes from it and from the label of the case.
    pub seed: u64,
    /// Which aircraft flies.
    #[serde(default)]
    pub aircraft: AircraftChoice,
    /// Flights that are diagnosed.
    #[serde(default = "sixty")]
    pub flights: usize,
    /// Clean flights before them, that an adapted model learns.
    #[serde(default = "forty")]
    pub clean_flights: usize,
    /// Length of a recording, h.
    #[serde(default = "two_hours")]
    pub duration_h: f64,
    /// Optional columns that are recorded.
    #[serde(default)]
    pub columns: Columns,
    /// Sensors of the virtual aircraft. The aircraft file of the reference model states them as they are.
    #[serde(default)]
    pub sensors: SensorChoice,
    /// Clutter: standard deviation of every other effect over its typical size.
    #[serde(default = "a_tenth")]
    pub clutter_share: f64,
    /// Clutter: standard deviation of smooth errors of drag and of fuel flow, %.
    #[serde(default = "a_quarter")]
    pub smooth_error_percent: f64,
    /// Effects of the library that are planted; all when left out.
    #[serde(default)]
    pub effects: Vec<TruthEffect>,
    /// What is flown.
    #[serde(default)]
    pub parts: Vec<Part>,
    /// Whole fleets that are flown.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fleets: Vec<FleetPart>,
    /// Scores below (or above) which `--check` fails.
    #[serde(default)]
    pub floors: Vec<Floor>,
}

const fn sixty() -> usize {
    60
}

const fn forty() -> usize {
    40
}

const fn two_hours() -> f64 {
    2.0
}

const fn a_tenth() -> f64 {
    0.10
}

const fn a_quarter() -> f64 {
    0.25
}

pub(crate) const fn once() -> f64 {
    1.0
}

/// Most repeats of a part: each is a simulation and a diagnosis of a minute.
const MOST_REPEATS: usize = 10_000;

/// Why a text is not a plan of trials.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TrialPlanError {
    /// Not the notation of a plan, with line and column.
    #[error(transparent)]
    Syntax(#[from] ron::error::SpannedError),
    /// A value that makes no trial.
    #[error("{field}: found {found}, expected {expected}")]
    Value {
        /// Field of the plan.
        field: &'static str,
        /// Its value.
        found: String,
        /// The range, or the kind, that makes a trial.
        expected: &'static str,
    },
    /// Two parts of one model, background, kind and size.
    #[error("the part {label} occurs twice")]
    PartTwice {
        /// What distinguishes a part from every other.
        label: String,
    },
}

/// One case before it is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseSpec {
    /// Its number, from 1. Files are named by it, so that no name gives the truth away.
    pub number: usize,
    /// The part that it belongs to.
    pub part: Part,
    /// What is planted, the first of two being the one that scores ask for.
    pub planted: Vec<TruthEffect>,
    /// 32 random bytes of this case alone.
    pub draws: [u8; 32],
}

impl TrialPlan {
    /// The plan that a continuous integration runs.
    ///
    /// # Errors
    /// None in practice: a test parses it.
    pub fn short() -> Result<Self, TrialPlanError> {
        Self::from_ron(SHORT)
    }

    /// The plan behind published scores.
    ///
    /// # Errors
    /// None in practice: a test parses it.
    pub fn long() -> Result<Self, TrialPlanError> {
        Self::from_ron(LONG)
    }

    /// From the text of a plan.
    ///
    /// # Errors
    /// What is wrong, with line and column, or the first value that makes no trial.
    pub fn from_ron(text: &str) -> Result<Self, TrialPlanError> {
        let options = ron::Options::default()
            .with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let plan: Self = options.from_str(text)?;
        plan.check()?;
        Ok(plan)
    }

    /// The plan as text, every default written out: what a folder of trials was begun with.
    ///
    /// # Errors
    /// None in practice: every part of a plan has a text.
    pub fn to_ron(&self) -> Result<String, ron::Error> {
        let options = ron::Options::default()
            .with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        options.to_string_pretty(self, ron::ser::PrettyConfig::default())
    }

    fn check(&self) -> Result<(), TrialPlanError> {
        let wrong = |field: &'static str, found: &dyn std::fmt::Display, expected: &'static str| {
            Err(TrialPlanError::Value { field, found: found.to_string(), expected })
        };
        if !(1..=5000).contains(&self.flights) {
            return wrong("flights", &self.flights, "1 to 5000");
        }
        if !(0..=5000).contains(&self.clean_flights) {
            return wrong("clean_flights", &self.clean_flights, "0 to 5000");
        }
        if !(0.3..=12.0).contains(&self.duration_h) {
            return wrong("duration_h", &self.duration_h, "0.3 to 12");
        }
        if !(0.0..=1.0).contains(&self.clutter_share) {
            return wrong("clutter_share", &self.clutter_share, "0 to 1");
        }
        if !(0.0..=5.0).contains(&self.smooth_error_percent) {
            return wrong("smooth_error_percent", &self.smooth_error_percent, "0 to 5");
        }
        for (index, part) in self.parts.iter().enumerate() {
            if !(1..=MOST_REPEATS).contains(&part.repeats) {
                return wrong("repeats", &part.repeats, "1 to 10000");
            }
            if !(0.01..=10.0).contains(&part.times) {
                return wrong("times", &part.times, "0.01 to 10");
            }
            if let Some(to) = part.times_to.filter(|to| !(part.times..=10.0).contains(to)) {
                return wrong("times_to", &to, "times to 10");
            }
            if self.parts[..index].iter().any(|other| other.label() == part.label()) {
                return Err(TrialPlanError::PartTwice { label: part.label() });
            }
        }
        for effect in &self.effects {
            if let TruthEffect::Outside(outside) = effect {
                return wrong("effects", &outside.name(), "effects of the library");
            }
        }
        for (index, part) in self.fleets.iter().enumerate() {
            if let Some((field, found, expected)) = part.wrong() {
                return Err(TrialPlanError::Value { field, found, expected });
            }
            if self.fleets[..index].iter().any(|other| other.label() == part.label()) {
                return Err(TrialPlanError::PartTwice { label: part.label() });
            }
        }
        let cases = self.cases(2).len() + self.fleets().len();
        if cases == 0 || cases > MOST_CASES {
            return wrong("cases", &cases, "1 to 99999");
        }
        Ok(())
    }

    /// Every case, numbered, for an aircraft with this many engines.
    pub fn cases(&self, engines: usize) -> Vec<CaseSpec> {
        let mut cases = Vec::new();
        for part in &self.parts {
            let library = self.plantable(part, engines);
            let each: Vec<Vec<TruthEffect>> = match part.kind {
                Kind::Null => vec![vec![]],
                Kind::Pair => vec![library],
                Kind::Single | Kind::Struck => library.into_iter().map(|id| vec![id]).collect(),
                Kind::Outside => OutsideEffect::ALL
                    .into_iter()
                    .map(|id| vec![TruthEffect::Outside(id)])
                    .collect(),
            };
            for repeat in 0..part.repeats {
                for planted in &each {
                    let first = planted.first().map_or_else(String::new, ToString::to_string);
                    let what = if part.kind == Kind::Pair { "pair" } else { &first };
                    let draws = self.draws(&format!("{}/{what}/{repeat}", part.label()));
                    let planted = match part.kind {
                        Kind::Pair => two_of(planted, &draws),
                        _ => planted.clone(),
                    };
                    let number = cases.len() + 1;
                    cases.push(CaseSpec { number, part: *part, planted, draws });
                }
            }
        }
        cases
    }

    /// Every fleet, numbered.
    #[must_use]
    pub fn fleets(&self) -> Vec<FleetSpec> {
        let each = |part: &FleetPart| {
            let draws = |repeat: usize| self.draws(&format!("{}/{repeat}", part.label()));
            (0..part.repeats).map(|repeat| (*part, draws(repeat))).collect::<Vec<_>>()
        };
        let all = self.fleets.iter().flat_map(each);
        all.zip(1..).map(|((part, draws), number)| FleetSpec { number, part, draws }).collect()
    }

    /// Effects of the library that a part plants.
    fn plantable(&self, part: &Part, engines: usize) -> Vec<TruthEffect> {
        #[expect(clippy::float_cmp, reason = "the number 1 as a plan writes it")]
        let typical = part.times == 1.0 && part.times_to.is_none();
        EffectId::library(engines)
            .into_iter()
            .filter(|id| {
                // What is known is all or nothing; and an Earth does not begin to turn between two flights.
                let known = id.entry().typical == TypicalSize::Known;
                !known
                    || (typical
                        && part.reference_model == ReferenceModel::Exact
                        && part.kind != Kind::Pair)
            })
            .filter(|id| !part.reference_model.is_of_guide() || !a_table_holds(*id))
            .map(TruthEffect::Library)
            .filter(|id| self.effects.is_empty() || self.effects.contains(id))
            .collect()
    }

    /// SHA-256 of seed and label: adding a part to a plan moves no case of another part.
    fn draws(&self, label: &str) -> [u8; 32] {
        Sha256::digest(format!("cruisefit trial {}/{label}", self.seed)).into()
    }
}

/// Effects that a table over lift coefficient and Mach number can hold, or that nothing tells from one in a fleet's usual flights.
const fn a_table_holds(id: EffectId) -> bool {
    !matches!(
        id,
        EffectId::TsfcEngine(_)
            | EffectId::FuelFlowGainEngine(_)
            | EffectId::AntiIceBleed
            | EffectId::TrimDragCg
            | EffectId::AirframeAgeing
            | EffectId::EngineAgeing
            | EffectId::AirframeHistory
            | EffectId::EngineHistory
            | EffectId::ReynoldsNumber
            | EffectId::TsfcTemperatureExponent
            | EffectId::StepChange
    )
}

/// Two different effects, drawn.
fn two_of(library: &[TruthEffect], draws: &[u8; 32]) -> Vec<TruthEffect> {
    let draw = |from: usize, below: usize| {
        let bytes = [draws[from], draws[from + 1], draws[from + 2], draws[from + 3]];
        u32::from_le_bytes(bytes) as usize % below.max(1)
    };
    if library.len() < 2 {
        return library.to_vec();
    }
    let first = draw(24, library.len());
    let second = (first + 1 + draw(28, library.len() - 1)) % library.len();
    vec![library[first], library[second]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn embedded_plans_parse_and_come_back_from_their_text() {
        for plan in [TrialPlan::short().unwrap(), TrialPlan::long().unwrap()] {
            assert_eq!(TrialPlan::from_ron(&plan.to_ron().unwrap()).unwrap(), plan);
        }
    }

    #[test]
    fn a_case_keeps_its_draws_when_parts_are_added() {
        let text = |more: &str| {
            format!(
                "(seed: 1, parts: [{more}(denied: exact, background: clean, kind: single, repeats: 1)])"
            )
        };
        let alone = TrialPlan::from_ron(&text("")).unwrap().cases(2);
        let more = "(denied: exact, background: clean, kind: null, repeats: 3),";
        let after = TrialPlan::from_ron(&text(more)).unwrap().cases(2);
        // 29 effects of an aircraft with two engines: 27 of the library's table, two of them once per engine.
        assert_eq!(alone.len(), EffectId::library(2).len());
        assert_eq!(after.len(), alone.len() + 3);
        for (one, other) in alone.iter().zip(&after[3..]) {
            assert_eq!((&one.planted, one.draws), (&other.planted, other.draws));
        }
    }

    #[test]
    fn pairs_are_of_two_different_effects() {
        let text =
            "(seed: 7, parts: [(denied: adapted, background: clean, kind: pair, repeats: 200)])";
        let cases = TrialPlan::from_ron(text).unwrap().cases(2);
        assert_eq!(cases.len(), 200);
        for case in cases {
            assert_eq!(case.planted.len(), 2);
            assert_ne!(case.planted[0], case.planted[1]);
        }
    }

    #[test]
    fn what_makes_no_trial_is_refused_by_name() {
        for (text, says) in [
            ("(seed: 1, parts: [])", "cases: found 0"),
            ("(seed: 1, flights: 0, parts: [])", "flights: found 0"),
            (
                "(seed: 1, parts: [(denied: exact, background: clean, kind: null, times: 0, repeats: 1)])",
                "times: found 0",
            ),
            (
                "(seed: 1, parts: [(denied: exact, background: clean, kind: null, repeats: 1), (denied: exact, background: clean, kind: null, repeats: 2)])",
                "occurs twice",
            ),
            (
                "(seed: 1, effects: [\"outside_mach_bump\"], parts: [(denied: exact, background: clean, kind: null, repeats: 1)])",
                "outside_mach_bump",
            ),
        ] {
            let error = TrialPlan::from_ron(text).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}
