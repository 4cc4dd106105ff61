//! What was found in fleets against what was planted.

use diagnose::{FleetFinding, FleetLevel};
use serde::{Deserialize, Serialize};
use simulate::{Planted, PlantedLevel, TruthEffect};

use flight::effect::EffectId;

use super::found::{FoundFleet, MonitoredTail};
use super::part::FleetPart;
use super::truth::FleetTruth;
use crate::share::Share;

/// A step counts as dated where a change is this many flights away at most.
const NEAR_FLIGHTS: usize = 3;

/// What came of one fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetResult {
    /// Its number.
    pub fleet: usize,
    /// SHA-256 of its truth, as it was sealed.
    pub truth_sha256: String,
    /// The part of the plan.
    pub part: FleetPart,
    /// Tails that took part and have no effect, sensor or step of their own.
    pub quiet_tails: usize,
    /// Those of them without a finding.
    pub silent_tails: usize,
    /// Every effect that was planted but for steps, and whether it was found.
    pub planted: Vec<PlantedFound>,
    /// Every finding, and whether it is right.
    pub findings: Vec<JudgedFinding>,
    /// Share of false findings that the diagnosis expects.
    pub false_share_expected: f64,
    /// Every step, and the change nearest to it.
    pub steps: Vec<StepFound>,
    /// Changes that are near no step.
    pub false_changes: Vec<FoundChange>,
    /// Flights of all tails that were searched for changes.
    pub flights_monitored: usize,
}

/// A planted effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantedFound {
    /// What was planted.
    pub planted: Planted,
    /// As what, where it is in the class of a finding on its tail, or of the type.
    pub found: Option<FoundAs>,
}

/// As what a planted effect was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FoundAs {
    /// Whether it leads its class.
    pub named: bool,
    /// What is said of its level.
    pub level: LevelFound,
}

/// What is said of the level of a planted effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LevelFound {
    /// Its class holds effects of several levels.
    Open,
    /// Its own.
    Right,
    /// Another.
    Wrong,
}

/// A finding.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JudgedFinding {
    /// The level stated.
    pub level: PlantedLevel,
    /// The tail; `None` for the type.
    pub tail: Option<String>,
    /// The effect that leads.
    pub effect: TruthEffect,
    /// Effects that are not distinguished from it, itself first.
    pub class: Vec<TruthEffect>,
    /// That one of them acts.
    pub probability: f64,
    /// Whether an effect of the class was planted there.
    pub right: bool,
    /// Whether a step was planted there, which a fleet's diagnosis does not look for: neither right nor false.
    pub beside_a_step: bool,
    /// Whether its class holds the Earth's gravity or rotation, which act on all tails and which the model lacks, though
    /// nobody planted them: neither right nor false.
    pub of_the_earth: bool,
}

/// A step and what was found of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepFound {
    /// What was planted.
    pub planted: Planted,
    /// The first flight after it, from 0.
    pub flight: usize,
    /// The flight of the nearest change; `None` where the tail shows none.
    pub nearest: Option<usize>,
    /// Whether that is within three flights.
    pub dated: bool,
}

/// A change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoundChange {
    /// The tail.
    pub tail: String,
    /// The first flight after it, from 0.
    pub flight: usize,
}

/// Scores of the fleets of one part.
#[derive(Clone, Debug, Serialize)]
pub struct FleetGroup {
    /// The part.
    pub part: FleetPart,
    /// Fleets that were scored.
    pub fleets: usize,
    /// Scores.
    pub scores: Vec<FleetScore>,
}

/// A score of fleets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FleetScore {
    /// Its name.
    pub name: &'static str,
    /// What it means.
    pub words: &'static str,
    /// What was reached.
    pub reached: Share,
    /// Whether more is better, and the goal; `None` where there is none.
    pub goal: Option<(bool, f64)>,
    /// Whether it is met; `None` without a goal or a case.
    pub met: Option<bool>,
}

impl FoundFleet {
    /// Scores what was found against the truth, which was sealed with this hash.
    pub fn score(&self, truth: &FleetTruth, truth_sha256: &str) -> FleetResult {
        let (steps, effects): (Vec<&Planted>, Vec<&Planted>) =
            truth.planted.iter().partition(|one| is_step(one));
        let planted = effects.iter().map(|one| self.found_of(one)).collect();
        let findings =
            self.diagnosis.findings.iter().map(|one| self.judged(one, &effects, &steps)).collect();
        let is_quiet = |tail: &&String| {
            !truth.planted.iter().any(|planted| planted.tail.as_ref() == Some(*tail))
        };
        let quiet: Vec<&String> = self.tails.iter().filter(is_quiet).collect();
        let has_finding = |tail: &str| {
            self.diagnosis.findings.iter().any(|found| self.tail_of(found) == Some(tail))
        };
        let steps: Vec<StepFound> = steps.iter().map(|step| self.step_found(step)).collect();
        FleetResult {
            fleet: truth.fleet,
            truth_sha256: truth_sha256.to_owned(),
            part: truth.part,
            quiet_tails: quiet.len(),
            silent_tails: quiet.iter().filter(|tail| !has_finding(tail)).count(),
            planted,
            findings,
            false_share_expected: self.diagnosis.false_share,
            false_changes: self.false_changes(&steps),
            steps,
            flights_monitored: self.monitored.iter().map(|tail| tail.starts.len()).sum(),
        }
    }

    fn tail_of(&self, finding: &FleetFinding) -> Option<&str> {
        finding.tail.map(|tail| self.tails[tail].as_str())
    }

    fn found_of(&self, planted: &Planted) -> PlantedFound {
        let id = library_id(planted.effect);
        let same: Vec<&FleetFinding> = self
            .diagnosis
            .findings
            .iter()
            .filter(|found| self.tail_of(found) == planted.tail.as_deref())
            .filter(|found| id.is_some_and(|id| found.class.contains(&id)))
            .collect();
        let stated: Vec<PlantedLevel> = same
            .iter()
            .filter(|found| found.levels.len() == 1)
            .map(|found| level(found.level))
            .collect();
        let found = (!same.is_empty()).then(|| FoundAs {
            named: same.iter().any(|found| Some(found.effect) == id),
            level: if stated.is_empty() {
                LevelFound::Open
            } else if stated.contains(&planted.level) {
                LevelFound::Right
            } else {
                LevelFound::Wrong
            },
        });
        PlantedFound { planted: planted.clone(), found }
    }

    fn judged(
        &self,
        found: &FleetFinding,
        effects: &[&Planted],
        steps: &[&Planted],
    ) -> JudgedFinding {
        let tail = self.tail_of(found);
        let right = effects.iter().any(|planted| {
            planted.tail.as_deref() == tail
                && library_id(planted.effect).is_some_and(|id| found.class.contains(&id))
        });
        JudgedFinding {
            level: level(found.level),
            tail: tail.map(ToOwned::to_owned),
            effect: TruthEffect::Library(found.effect),
            class: found.class.iter().copied().map(TruthEffect::Library).collect(),
            probability: found.probability,
            right,
            beside_a_step: tail.is_some()
                && steps.iter().any(|planted| planted.tail.as_deref() == tail),
            of_the_earth: !right
                && tail.is_none()
                && found.class.iter().any(|effect| effect.is_known()),
        }
    }

    /// On a tail that did not take part nothing is dated.
    fn step_found(&self, planted: &Planted) -> StepFound {
        let place = self.tails.iter().position(|tail| Some(tail) == planted.tail.as_ref());
        let Some(MonitoredTail { starts, changes }) = place.map(|place| &self.monitored[place])
        else {
            return StepFound { planted: planted.clone(), flight: 0, nearest: None, dated: false };
        };
        let flight = starts.partition_point(|start| planted.from.is_some_and(|from| *start < from));
        let nearest = changes.iter().copied().min_by_key(|change| change.abs_diff(flight));
        let dated = nearest.is_some_and(|change| change.abs_diff(flight) <= NEAR_FLIGHTS);
        StepFound { planted: planted.clone(), flight, nearest, dated }
    }

    fn false_changes(&self, steps: &[StepFound]) -> Vec<FoundChange> {
        let mut all = Vec::new();
        for (tail, monitored) in self.tails.iter().zip(&self.monitored) {
            for &flight in &monitored.changes {
                let near = steps.iter().any(|step| {
                    step.planted.tail.as_ref() == Some(tail)
                        && step.flight.abs_diff(flight) <= NEAR_FLIGHTS
                });
                if !near {
                    all.push(FoundChange { tail: tail.clone(), flight });
                }
            }
        }
        all
    }
}

/// Scores by part, in the order of the plan.
#[must_use]
pub(crate) fn fleet_groups(parts: &[FleetPart], results: &[FleetResult]) -> Vec<FleetGroup> {
    parts
        .iter()
        .filter_map(|part| {
            let own: Vec<&FleetResult> =
                results.iter().filter(|result| result.part == *part).collect();
            (!own.is_empty()).then(|| FleetGroup {
                part: *part,
                fleets: own.len(),
                scores: scores(&own),
            })
        })
        .collect()
}

/// The goals are our choice: what a fleet's diagnosis and the monitor are developed against.
fn scores(own: &[&FleetResult]) -> Vec<FleetScore> {
    let planted: Vec<&PlantedFound> = own.iter().flat_map(|fleet| &fleet.planted).collect();
    let found = |level: PlantedLevel| {
        let of: Vec<_> = planted.iter().filter(|one| one.planted.level == level).collect();
        Share::new(of.iter().filter(|one| one.found.is_some()).count(), of.len())
    };
    let all: Vec<FoundAs> = planted.iter().filter_map(|one| one.found).collect();
    let of_level = |level| all.iter().filter(|found| found.level == level).count();
    let right = of_level(LevelFound::Right);
    let stated_right = Share::new(right, right + of_level(LevelFound::Wrong));
    let open = Share::new(of_level(LevelFound::Open), all.len());
    let named = Share::new(all.iter().filter(|found| found.named).count(), all.len());
    let findings: Vec<&JudgedFinding> = own
        .iter()
        .flat_map(|fleet| &fleet.findings)
        .filter(|one| !one.beside_a_step && !one.of_the_earth)
        .collect();
    let steps: Vec<&StepFound> = own.iter().flat_map(|fleet| &fleet.steps).collect();
    let wrong = Share::new(findings.iter().filter(|one| !one.right).count(), findings.len());
    let of_all = |of: fn(&FleetResult) -> usize| own.iter().map(|fleet| of(fleet)).sum();
    let silent = Share::new(of_all(|fleet| fleet.silent_tails), of_all(|fleet| fleet.quiet_tails));
    let dated = Share::new(steps.iter().filter(|one| one.dated).count(), steps.len());
    let score = |name, words, reached: Share, goal: Option<(bool, f64)>| FleetScore {
        name,
        words,
        reached,
        goal,
        met: goal.filter(|_| reached.of > 0).map(|(at_least, goal)| {
            if at_least { reached.share >= goal } else { reached.share <= goal }
        }),
    };
    vec![
        score(
            "level_right",
            "one level stated for what was found: it is right",
            stated_right,
            Some((true, 0.95)),
        ),
        score("level_open", "found, level left open", open, None),
        score(
            "found_type",
            "effect of the type: in the class of a finding",
            found(PlantedLevel::Type),
            None,
        ),
        score(
            "found_tail",
            "effect of a tail: in the class of a finding there",
            found(PlantedLevel::Tail),
            None,
        ),
        score(
            "found_sensor",
            "effect of a sensor: in the class of a finding there",
            found(PlantedLevel::Sensor),
            None,
        ),
        score("named", "found: the planted effect leads its class", named, None),
        score(
            "false",
            "findings whose class holds nothing that was planted there",
            wrong,
            // Where nothing is planted every finding is false: there quiet tails count.
            Some((false, 0.05)).filter(|_| !planted.is_empty()),
        ),
        score("silent", "tails with nothing of their own: no finding", silent, None),
        score("dated", "steps with a change within three flights", dated, Some((true, 0.90))),
        score(
            "false_changes",
            "changes near no step, of all flights",
            Share::new(
                of_all(|fleet| fleet.false_changes.len()),
                of_all(|fleet| fleet.flights_monitored),
            ),
            Some((false, 1.0 / 300.0)),
        ),
    ]
}

fn is_step(planted: &Planted) -> bool {
    planted.effect == TruthEffect::Library(EffectId::StepChange)
}

const fn library_id(effect: TruthEffect) -> Option<EffectId> {
    match effect {
        TruthEffect::Library(id) => Some(id),
        TruthEffect::Outside(_) => None,
    }
}

const fn level(level: FleetLevel) -> PlantedLevel {
    match level {
        FleetLevel::Type => PlantedLevel::Type,
        FleetLevel::Tail => PlantedLevel::Tail,
        FleetLevel::Sensor => PlantedLevel::Sensor,
    }
}
