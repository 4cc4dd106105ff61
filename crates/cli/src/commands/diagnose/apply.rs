//! `cruisefit diagnose --apply`: each tail's model extended by the effects of its verdict.

use std::fmt::Write;
use std::path::Path;

use diagnose::{Diagnosis, Verdict};

use crate::commands::Outcome;
use crate::failure::{Failure, RefusedReport, show};
use crate::files::{file_stem_of_tail, make_folder};
use crate::models::write_model;
use pipeline::diagnosed_tail::{DiagnosedTail, POOL};
use pipeline::diagnosis_groups::Group;
use pipeline::diagnosis_words::joined;
use pipeline::model_file::{AppliedRecord, DiagnosisRecord};

/// Writes the extended model of every group whose verdict names its effects unambiguously. The other groups are
/// reported, or refused where a person has to choose.
///
/// # Errors
/// A file or folder that cannot be written.
pub(super) fn apply(
    folder: &Path,
    groups: &[Group<'_>],
    diagnoses: &[DiagnosedTail],
) -> Result<Outcome, Failure> {
    make_folder(folder)?;
    let mut outcome = Outcome::default();
    for (group, diagnosed) in groups.iter().zip(diagnoses) {
        let path = folder.join(format!("{}.ron", file_stem(group)));
        let result = match chosen(group, &diagnosed.diagnosis) {
            Choice::Nothing(reason) => format!("nothing applied: {reason}"),
            Choice::Refused(reason) => {
                outcome.refused.push(RefusedReport::whole(path, reason));
                continue;
            }
            Choice::Record(record) => match group.model.extended(record) {
                Ok(model) => {
                    write_model(&model, &path)?;
                    let record = model.applied.last().map_or_else(String::new, AppliedRecord::told);
                    format!("applied {record}; written to {}", show(&path))
                }
                Err(reason) => {
                    outcome.refused.push(RefusedReport::whole(path, reason));
                    continue;
                }
            },
        };
        let _ = writeln!(outcome.text, "{}: {result}", group.name);
    }
    Ok(outcome)
}

/// The model of one tail is named after the tail, that of a pool after its type.
fn file_stem(group: &Group<'_>) -> String {
    if group.name == POOL {
        file_stem_of_tail(group.model.initial.aircraft().type_code())
    } else {
        file_stem_of_tail(&group.name)
    }
}

enum Choice {
    Record(AppliedRecord),
    Nothing(&'static str),
    Refused(String),
}

fn chosen(group: &Group<'_>, diagnosis: &Diagnosis) -> Choice {
    let found = match &diagnosis.verdict {
        Verdict::Effects(found) => found,
        Verdict::NoGap => return Choice::Nothing("no gap beyond the noise"),
        Verdict::OutsideLibrary(_) => {
            return Choice::Nothing("no effect of the library explains the gap");
        }
        Verdict::InsufficientData(_) => return Choice::Nothing("insufficient data"),
    };
    if diagnosis.verdict.is_of_table() {
        return Choice::Nothing(
            "the drag of the guide is off, and what else acts is not known before it is adapted: adapt first, then diagnose \
             flights that the adapted model has not learnt",
        );
    }
    if found.class.iter().any(|member| !found.effects.contains(member)) {
        return Choice::Refused(format!(
            "tail {}: nothing applied, these flights cannot distinguish {}; name the right one with --effects",
            group.name,
            joined(&found.class, ", ")
        ));
    }
    let Some(addition) = diagnosis.addition.clone() else {
        return Choice::Refused(format!(
            "tail {}: nothing applied, no model holds exactly {}",
            group.name,
            joined(&found.effects, " and ")
        ));
    };
    let starts = || group.flights.iter().map(|flight| flight.reduced.identity.start);
    let word = |start: Option<flight::Timestamp>| start.map_or_else(String::new, |s| s.to_string());
    Choice::Record(AppliedRecord {
        addition,
        diagnosis: DiagnosisRecord {
            tail: group.name.clone(),
            flights: diagnosis.flights as u64,
            segments: diagnosis.segments as u64,
            first: word(starts().min()),
            last: word(starts().max()),
            probability: found.probability,
            class: found.class.clone(),
        },
    })
}
