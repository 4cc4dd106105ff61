//! What a report says of how it was made.

use flight::column::Column;
use flight::{Finding, Severity};

use super::super::plan::{MachSource, MassPlan, TemperatureSource, TrueAirspeedSource};
use super::rows::Surplus;
use super::{Load, Part};
use crate::refusal::counted;

/// A rise of gross mass that is printed as more than 0.0 kg.
const WORTH_A_WORD_KG: f64 = 0.05;

impl Part<'_> {
    /// The derivations, for the report's notes.
    pub(super) fn derived(&self, load: &Load) -> Vec<&'static str> {
        let mut derived = Vec::new();
        match self.plan.mach {
            MachSource::Recorded => {}
            MachSource::CalibratedAirspeed(_) => derived.push("MACH from CAS and ALT"),
            MachSource::TrueAirspeed => derived.push("MACH from VTAS and SAT"),
        }
        match self.plan.temperature {
            TemperatureSource::TotalTemperature { .. } => derived.push("SAT from TAT and MACH"),
            TemperatureSource::TrueAirspeed => derived.push("SAT from VTAS and MACH"),
            TemperatureSource::Recorded | TemperatureSource::Isa { .. } => {}
        }
        if matches!(self.plan.true_airspeed, TrueAirspeedSource::Mach) {
            derived.push("VTAS from MACH and SAT");
        }
        if self
            .plan
            .recorded
            .iter()
            .any(|(column, conversion)| *column == Column::Drift && conversion.minus.is_some())
        {
            derived.push("DRIFT from track and heading");
        }
        if load.largest_rise_kg.is_some() {
            derived.push(match self.plan.mass {
                MassPlan::ZeroFuelAndTanks { .. } => {
                    "FU from the fall of zero-fuel weight and tanks"
                }
                _ => "FU from the fall of gross mass",
            });
        }
        if matches!(self.plan.mass, MassPlan::StartMass { .. }) {
            derived.push("FU from the integral of WF");
        }
        derived
    }

    /// What is to be said of the rows.
    pub(super) fn findings(
        &self,
        derived: &[&'static str],
        load: &Load,
        surplus: &[Surplus],
    ) -> Vec<Finding> {
        let first_line = Some(self.recording.lines.at(self.rows.at(0)));
        let note = |severity, code, message| Finding { severity, code, message, line: first_line };
        let mut findings = Vec::new();
        if !derived.is_empty() {
            let message = format!("derived by the mapping: {}", derived.join(", "));
            findings.push(note(Severity::Note, "mapped-derived", message));
        }
        if let TemperatureSource::Isa { deviation_k } = self.plan.temperature {
            let message = format!(
                "static air temperature is not recorded: ISA {deviation_k:+} K is used instead"
            );
            findings.push(note(Severity::Warning, "mapped-temperature-assumed", message));
        }
        if let Some(largest_rise_kg) = load.largest_rise_kg {
            // A mass that never rises needs no word on its noise.
            let rise = if largest_rise_kg >= WORTH_A_WORD_KG {
                format!(", which rose by up to {largest_rise_kg:.1} kg on the way")
            } else {
                String::new()
            };
            let message =
                format!("fuel used is the running maximum of the fall of gross mass{rise}");
            findings.push(note(Severity::Note, "mapped-fuel-used", message));
        }
        self.findings_of_rows(load, surplus, &mut findings);
        findings
            .extend(self.cut().map(|message| note(Severity::Note, "mapped-cruise-cut", message)));
        findings
    }

    /// Rows that are left out, or filled.
    fn findings_of_rows(&self, load: &Load, surplus: &[Surplus], findings: &mut Vec<Finding>) {
        let first_line = Some(self.recording.lines.at(self.rows.at(0)));
        let note = |code, message| {
            let severity = Severity::Note;
            Finding { severity, code, message, line: first_line }
        };
        if self.recording.left_out > 0 {
            findings.push(Finding {
                severity: Severity::Warning,
                code: "mapped-rows-left-out",
                message: format!(
                    "{} left out for want of a number that the report needs{}",
                    counted(self.recording.left_out, "row"),
                    self.recording
                        .lacking
                        .as_ref()
                        .map_or_else(String::new, |column| format!(" (most of them {column:?})"))
                ),
                line: self.recording.first_left_out,
            });
        }
        if let Some(first) = &self.recording.first_bad {
            findings.push(Finding {
                severity: Severity::Warning,
                code: "mapped-rows-bad",
                message: format!(
                    "{} left out as unusable, the first: {first}",
                    counted(self.recording.bad, "row")
                ),
                line: Some(first.line),
            });
        }
        for (column, filled) in &self.recording.filled {
            let message = format!("{column:?} is held or interpolated in {filled} rows");
            findings.push(note("mapped-filled", message));
        }
        if load.bridged > 0 {
            let message = format!(
                "{} with a fuel flow out of range or, in flight, of zero: mass follows a straight line over them",
                counted(load.bridged, "row")
            );
            findings.push(note("mapped-flow-bridged", message));
        }
        for (code, message) in &load.doubts {
            let (severity, message) = (Severity::Warning, message.clone());
            findings.push(Finding { severity, code, message, line: first_line });
        }
        if let Some((row, column)) = surplus.first() {
            findings.push(Finding {
                severity: Severity::Warning,
                code: "mapped-rows-out-of-range",
                message: format!(
                    "{} left out for a number out of range, the first for its {}",
                    counted(surplus.len(), "row"),
                    column.map_or_else(|| "gross mass".to_owned(), Column::name)
                ),
                line: Some(self.recording.lines.at(*row)),
            });
        }
    }

    /// What of the recording is level cruise, where it is not all.
    fn cut(&self) -> Option<String> {
        let rows = self.recording.time_s.len();
        if self.level_rows >= rows {
            return None;
        }
        let last_line = self.recording.lines.at(self.rows.at(self.rows.len() - 1));
        let parts = match self.level_parts {
            0 | 1 => String::new(),
            parts => format!(" in {parts} level parts"),
        };
        Some(format!(
            "level cruise: {} of {rows} rows{parts}, to line {last_line}; the rest is climb, descent or too short",
            self.level_rows
        ))
    }
}
