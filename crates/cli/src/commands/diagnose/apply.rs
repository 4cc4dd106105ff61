//! `cruisefit diagnose --apply`: each tail's model extended by the effects of its verdict.

use std::borrow::Cow;
use std::fmt::Write;
use std::path::Path;

use diagnose::{Addition, Diagnosis, Verdict};
use effects::OUTSIDE;
use flight::effect::EffectId;

use crate::args::DiagnoseArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, RefusedReport, show};
use crate::files::{file_stem_of_tail, make_folder};
use crate::models::write_model;
use pipeline::diagnosed_tail::{DiagnosedTail, POOL};
use pipeline::diagnosis_groups::Group;
use pipeline::diagnosis_words::{form_words, joined};
use pipeline::model_file::{AppliedRecord, DiagnosisRecord};

/// Whether the form of a cause outside the library is applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outside {
    /// As long as nobody asks for it.
    Left,
    Applied,
}

impl Outside {
    /// # Errors
    /// Without `--apply` it asks for nothing; the causes of a fleet are those of the library.
    pub(super) fn of(arguments: &DiagnoseArgs) -> Result<Self, Failure> {
        if !arguments.effects.iter().any(|name| name == OUTSIDE) {
            return Ok(Self::Left);
        }
        if arguments.apply.is_none() {
            return Err(Failure::BadArgument {
                argument: "--effects",
                reason:
                    "`outside` is applied, and looked for without being asked: give --apply DIR too"
                        .to_owned(),
            });
        }
        if arguments.fleet {
            return Err(Failure::BadArgument {
                argument: "--effects",
                reason: "`outside` is the form of one tail's gap; with --fleet only effects of the library are applied"
                    .to_owned(),
            });
        }
        Ok(Self::Applied)
    }
}

/// Writes the extended model of every group whose verdict names its effects unambiguously, or is a cause outside the library
/// that a person asks for. The other groups are reported, or refused where a person has to choose.
///
/// # Errors
/// A file or folder that cannot be written.
pub(super) fn apply(
    folder: &Path,
    groups: &[Group<'_>],
    diagnoses: &[DiagnosedTail],
    outside: Outside,
) -> Result<Outcome, Failure> {
    make_folder(folder)?;
    let mut outcome = Outcome::default();
    for (group, diagnosed) in groups.iter().zip(diagnoses) {
        let path = folder.join(format!("{}.ron", file_stem(group)));
        let result = match chosen(group, &diagnosed.diagnosis, outside) {
            Choice::Nothing(reason) => format!("nothing applied: {reason}"),
            Choice::Refused(reason) => {
                outcome.refused.push(RefusedReport::whole(path, reason));
                continue;
            }
            Choice::Record(record) => match group.model.extended(*record) {
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
    Record(Box<AppliedRecord>),
    Nothing(Cow<'static, str>),
    Refused(String),
}

fn chosen(group: &Group<'_>, diagnosis: &Diagnosis, outside: Outside) -> Choice {
    let nothing = |reason: &'static str| Choice::Nothing(reason.into());
    let found = match &diagnosis.verdict {
        Verdict::Effects(found) => found,
        Verdict::NoGap => return nothing("no effect is seen"),
        Verdict::OutsideLibrary(unexplained) => {
            return of_outside(group, diagnosis, unexplained.probability, outside);
        }
        Verdict::InsufficientData(_) => return nothing("insufficient data"),
    };
    if diagnosis.verdict.is_of_table() {
        return nothing(
            "the drag of the guide is off, and what else acts is not known before it is adapted: adapt first, then diagnose \
             flights that the adapted model has not learnt",
        );
    }
    if found.class.iter().any(|member| !found.effects.contains(member)) {
        return Choice::Refused(format!(
            "tail {}: nothing applied, these flights {} {}; name the right one with --effects",
            group.name,
            if found.credible.is_empty() { "cannot distinguish" } else { "do not decide between" },
            joined(&found.class, ", ")
        ));
    }
    let open = found.beside.iter().find(|beside| beside.class.len() > 1);
    if let Some(beside) = open {
        return Choice::Refused(format!(
            "tail {}: nothing applied, together with {} these flights cannot distinguish {}; name both with --effects",
            group.name,
            joined(&found.effects[..1], ""),
            joined(&beside.class, ", ")
        ));
    }
    let Some(addition) = diagnosis.addition.clone() else {
        return Choice::Refused(format!(
            "tail {}: nothing applied, no model holds exactly {}",
            group.name,
            joined(&found.effects, " and ")
        ));
    };
    record(group, diagnosis, addition, (found.probability, &found.class))
}

/// What is applied of a cause outside the library: nothing, or the form that describes it best.
fn of_outside(
    group: &Group<'_>,
    diagnosis: &Diagnosis,
    probability: f64,
    outside: Outside,
) -> Choice {
    const UNEXPLAINED: &str = "no effect of the library explains the gap";
    let Some(form) = diagnosis.outside.forms.first() else {
        return Choice::Nothing(format!("{UNEXPLAINED}, and no form describes it").into());
    };
    let described = form_words(form);
    match (outside, diagnosis.outside.addition.clone()) {
        (Outside::Applied, Some(addition)) => {
            record(group, diagnosis, addition, (probability, &[]))
        }
        (Outside::Left, Some(_)) => Choice::Nothing(
            format!("{UNEXPLAINED}; --effects {OUTSIDE} applies the form that describes it, {described}")
                .into(),
        ),
        (_, None) => Choice::Nothing(
            format!("{UNEXPLAINED}; what describes it is of recordings, and no part of a prediction: {described}")
                .into(),
        ),
    }
}

fn record(
    group: &Group<'_>,
    diagnosis: &Diagnosis,
    addition: Addition,
    (probability, class): (f64, &[EffectId]),
) -> Choice {
    let starts = || group.flights.iter().map(|flight| flight.reduced.identity.start);
    let word = |start: Option<flight::Timestamp>| start.map_or_else(String::new, |s| s.to_string());
    Choice::Record(Box::new(AppliedRecord {
        addition,
        diagnosis: DiagnosisRecord {
            tail: group.name.clone(),
            flights: diagnosis.flights as u64,
            segments: diagnosis.segments as u64,
            first: word(starts().min()),
            last: word(starts().max()),
            probability,
            class: class.to_vec(),
        },
    }))
}
