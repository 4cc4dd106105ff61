//! `diagnosis.json`: every diagnosis of a run, and what became of its reports.

use serde::Serialize;

use crate::diagnosed_tail::{DiagnosedTail, RunOptions};
use crate::fleet_diagnosis::{DiagnosedFleet, FleetRecord};
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

    /// With the fleets that the tails belong to: each cause that was found of its type or its tail has its level.
    #[must_use]
    pub fn with_fleets(mut self, fleets: &[DiagnosedFleet]) -> Self {
        self.fleets = fleets.iter().map(FleetRecord::from).collect();
        for diagnosis in &mut self.diagnoses {
            let is_member = |fleet: &&FleetRecord| {
                fleet.tails.iter().any(|member| member.tail == diagnosis.tail)
            };
            let fleet = self.fleets.iter().find(is_member);
            for cause in &mut diagnosis.causes {
                let found = fleet.iter().flat_map(|fleet| &fleet.findings);
                let same: Vec<_> = found.filter(|found| found.effect == cause.effect).collect();
                let of =
                    |tail: Option<&str>| same.iter().find(|found| found.tail.as_deref() == tail);
                let found = of(Some(&diagnosis.tail)).or_else(|| of(None));
                cause.level = found.map(|found| found.level.clone());
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
