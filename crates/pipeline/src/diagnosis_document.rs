//! `diagnosis.json`: every diagnosis of a run, and what became of its reports.

use diagnose::FleetLevel;
use flight::effect::EffectId;
use serde::Serialize;

use crate::diagnosed_tail::{DiagnosedTail, RunOptions};
use crate::fleet_diagnosis::{DiagnosedFleet, FleetFindingRecord, FleetRecord, level_name};
use crate::summary::{RefusedSummary, ReportsSummary};

mod tail;

pub use tail::{
    BesideRecord, CauseRecord, DetectableRecord, GapRecord, HeldOutRecord, MagnitudeRecord,
    NotTestableRecord, OutsideLibraryRecord, SeparationRecord, SliceRecord, TailDiagnosis,
    VerdictKind, VerdictRecord,
};

/// Schema of [`DiagnosisDocument`].
pub const SCHEMA: &str = "cruisefit.diagnosis/1";

/// Name and version of the program.
const PROGRAM: &str = concat!("cruisefit ", env!("CARGO_PKG_VERSION"));

/// What a run of diagnoses came to.
#[derive(Debug, Serialize)]
pub struct DiagnosisDocument<'a> {
    schema: &'static str,
    program: &'static str,
    options: &'a RunOptions,
    reports: DiagnosedReports<'a>,
    diagnoses: Vec<TailDiagnosis>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    fleets: Vec<FleetRecord>,
}

#[derive(Debug, Serialize)]
struct DiagnosedReports<'a> {
    read: usize,
    refused: &'a [RefusedSummary],
}

impl<'a> DiagnosisDocument<'a> {
    /// The document of these diagnoses, and of what became of the reports.
    pub fn new(
        options: &'a RunOptions,
        reports: &'a ReportsSummary,
        diagnoses: &[DiagnosedTail],
    ) -> Self {
        let reports = DiagnosedReports { read: reports.read, refused: &reports.refused };
        Self {
            schema: SCHEMA,
            program: PROGRAM,
            options,
            reports,
            diagnoses: diagnoses.iter().map(TailDiagnosis::from).collect(),
            fleets: Vec::new(),
        }
    }

    /// With the fleets that the tails belong to: each cause of which its type or its tail has a finding, under its own name or
    /// another one's of the finding's class, has its level.
    #[must_use]
    pub fn with_fleets(mut self, fleets: &[DiagnosedFleet]) -> Self {
        self.fleets = fleets.iter().map(FleetRecord::from).collect();
        for diagnosis in &mut self.diagnoses {
            let is_member = |fleet: &&FleetRecord| {
                fleet.tails.iter().any(|member| member.tail == diagnosis.tail)
            };
            let fleet = self.fleets.iter().find(is_member);
            for cause in &mut diagnosis.causes {
                cause.level = fleet
                    .and_then(|fleet| level(&fleet.findings, &diagnosis.tail, &cause.effect))
                    .map(|level| level_name(level).to_owned());
            }
        }
        self
    }

    /// The diagnosis of each tail.
    pub fn diagnoses(&self) -> &[TailDiagnosis] {
        &self.diagnoses
    }

    /// The fleets.
    pub fn fleets(&self) -> &[FleetRecord] {
        &self.fleets
    }

    /// As JSON, with a final line end.
    ///
    /// # Errors
    /// None that is known: what JSON refuses to write.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        let mut json = serde_json::to_string_pretty(self)?;
        json.push('\n');
        Ok(json)
    }
}

/// Whose an effect is that was found of a tail or its type, by its own name or by one that the data cannot distinguish from it:
/// its own name goes before, then what the tail has.
fn level(findings: &[FleetFindingRecord], tail: &str, effect: &str) -> Option<FleetLevel> {
    let is_named = |found: &&FleetFindingRecord| found.effect == effect;
    let is_of_class =
        |found: &&FleetFindingRecord| found.class.iter().any(|member| member == effect);
    let of_tail = |found: &&FleetFindingRecord| found.tail.as_deref() == Some(tail);
    let of_type = |found: &&FleetFindingRecord| found.tail.is_none();
    let any = |of: &dyn Fn(&&FleetFindingRecord) -> bool| findings.iter().find(of);
    let found = any(&|found| of_tail(found) && is_named(found))
        .or_else(|| any(&|found| of_type(found) && is_named(found)))
        .or_else(|| any(&|found| of_tail(found) && is_of_class(found)))
        .or_else(|| any(&|found| of_type(found) && is_of_class(found)))?;
    // A class may hold a worn engine and its meter: the level is that of this effect, not of the one that leads.
    let on_tail = || EffectId::from_name(effect).map(FleetLevel::on_tail);
    if of_type(&found) { Some(FleetLevel::Type) } else { on_tail() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(tail: Option<&str>, class: &[&str]) -> FleetFindingRecord {
        FleetFindingRecord {
            level: String::new(),
            levels: Vec::new(),
            tail: tail.map(str::to_owned),
            effect: class[0].to_owned(),
            class: class.iter().map(|&member| member.to_owned()).collect(),
            probability: 1.0,
            effect_probability: 0.6,
            magnitude: MagnitudeRecord { value: 5.0, unit: "%".to_owned(), ci95: [4.0, 6.0] },
        }
    }

    #[test]
    fn a_cause_has_the_level_of_the_finding_whose_class_it_belongs_to() {
        let findings = [
            finding(None, &["zero_lift_drag", "drag_factor"]),
            finding(Some("T-3"), &["tsfc_engine_2", "fuel_flow_gain_2"]),
            finding(Some("T-3"), &["drag_factor"]),
        ];
        for (tail, effect, expected) in [
            ("T-1", "zero_lift_drag", Some(FleetLevel::Type)),
            ("T-1", "drag_factor", Some(FleetLevel::Type)),
            ("T-3", "drag_factor", Some(FleetLevel::Tail)),
            ("T-3", "tsfc_engine_2", Some(FleetLevel::Tail)),
            ("T-3", "fuel_flow_gain_2", Some(FleetLevel::Sensor)),
            ("T-1", "fuel_flow_gain_2", None),
            ("T-3", "mach_bias", None),
        ] {
            assert_eq!(level(&findings, tail, effect), expected, "{tail} {effect}");
        }
    }
}
