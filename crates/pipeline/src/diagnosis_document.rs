//! `diagnosis.json`: every diagnosis of a run, and what became of its reports.

use diagnose::Diagnosis;
use serde::Serialize;

use crate::summary::{RefusedSummary, ReportsSummary};

/// Schema of [`DiagnosisDocument`].
pub const SCHEMA: &str = "cruisefit.diagnosis/1";

/// What a run of diagnoses came to.
#[derive(Debug, Serialize)]
pub struct DiagnosisDocument<'a> {
    schema: &'static str,
    reports: DiagnosedReports<'a>,
    diagnoses: &'a [Diagnosis],
}

#[derive(Debug, Serialize)]
struct DiagnosedReports<'a> {
    read: usize,
    refused: &'a [RefusedSummary],
}

impl<'a> DiagnosisDocument<'a> {
    /// The document of these diagnoses, and of what became of the reports.
    pub fn new(reports: &'a ReportsSummary, diagnoses: &'a [Diagnosis]) -> Self {
        let reports = DiagnosedReports { read: reports.read, refused: &reports.refused };
        Self { schema: SCHEMA, reports, diagnoses }
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
