//! `cruisefit diagnose --fleet`: all tails of a type compared with each other.

use std::fmt::Write;
use std::path::Path;

use diagnose::{ModelOf, Options};
use page::FleetRun;
use rayon::prelude::*;

use crate::columns;
use crate::commands::Outcome;
use crate::failure::{Failure, RefusedReport, show};
use crate::files::{file_stem_of_tail, make_folder, write_atomically};
use crate::models::write_model;
use crate::terminal::neutral;
use pipeline::diagnosed_tail::RunOptions;
use pipeline::diagnosis_groups::Group;
use pipeline::fleet_diagnosis::{DiagnosedFleet, diagnose_fleets, fleet_table, fleet_text};
use pipeline::model_file::{AppliedRecord, ModelFile};

/// The fleets that the tails belong to; none where they were not asked for.
///
/// # Errors
/// A fleet that cannot be diagnosed.
pub(super) fn diagnose(
    groups: &[Group<'_>],
    options: &Options,
    asked: &RunOptions,
) -> Result<Vec<DiagnosedFleet>, Failure> {
    if !asked.fleet {
        return Ok(Vec::new());
    }
    diagnose_fleets(groups, options, asked, &|tails, reduce| {
        (0..tails).into_par_iter().map(reduce).collect()
    })
    .map_err(|error| Failure::BadArgument { argument: "--fleet", reason: error.to_string() })
}

/// Refuses to put the fleet's table in the place of another one, before anything is written.
///
/// # Errors
/// A file that would be lost.
pub(super) fn check(fleets: &[DiagnosedFleet], folder: &Path) -> Result<(), Failure> {
    if fleets.is_empty() {
        return Ok(());
    }
    columns::check(&fleet_table(fleets), &folder.join(TABLE))
}

const TABLE: &str = "fleet.csv";

/// Writes `fleet.csv` and `fleet.html`; returns what to print.
///
/// # Errors
/// A file that cannot be written.
pub(super) fn write(
    fleets: &[DiagnosedFleet],
    run: &FleetRun<'_>,
    folder: &Path,
) -> Result<String, Failure> {
    if fleets.is_empty() {
        return Ok(String::new());
    }
    columns::write(&fleet_table(fleets), Some(&folder.join(TABLE)))?;
    let html = page::fleet_diagnosis(run);
    write_atomically(&folder.join("fleet.html"), neutral(&html).as_bytes())?;
    let texts: Vec<String> = fleets.iter().map(fleet_text).collect();
    Ok(format!("{}\n", texts.join("\n")))
}

/// Writes the model of each type with what all its tails share, and the models of tails that have effects of their own.
///
/// # Errors
/// A file or folder that cannot be written.
pub(super) fn apply(
    folder: &Path,
    groups: &[Group<'_>],
    fleets: &[DiagnosedFleet],
) -> Result<Outcome, Failure> {
    make_folder(folder)?;
    let mut outcome = Outcome::default();
    for fleet in fleets {
        let of_type = fleet.applied(None);
        if fleet.model_of == ModelOf::Type {
            let model = groups[fleet.tails[0].group].model;
            let records = of_type.iter().cloned().collect();
            extend(model, records, (folder, &fleet.aircraft_type), &mut outcome)?;
        }
        for (tail, member) in fleet.tails.iter().enumerate() {
            let own = fleet.applied(Some(tail));
            // A tail without effects of its own flies by the model of its type, where there is one.
            if own.is_none() && fleet.model_of == ModelOf::Type {
                continue;
            }
            let of_type = match fleet.model_of {
                ModelOf::Type => of_type.clone(),
                // What all share, as the tail's own model takes it.
                ModelOf::Tail => fleet.applied_to(None, tail),
            };
            let model = groups[member.group].model;
            let records = of_type.into_iter().chain(own).collect();
            extend(model, records, (folder, &member.tail), &mut outcome)?;
        }
        for found in fleet.diagnosis.findings.iter().filter(|found| found.class.len() > 1) {
            let whose = fleet.whose(found);
            let class: Vec<String> = found.class.iter().map(ToString::to_string).collect();
            outcome.refused.push(RefusedReport::whole(
                folder.join(format!("{}.ron", file_stem_of_tail(whose))),
                format!(
                    "{whose}: {} not applied, these flights cannot distinguish {}; name the right one with --effects",
                    found.effect,
                    class.join(", ")
                ),
            ));
        }
    }
    Ok(outcome)
}

/// Writes a model extended by the records, if there are any.
fn extend(
    model: &ModelFile,
    records: Vec<AppliedRecord>,
    (folder, name): (&Path, &str),
    outcome: &mut Outcome,
) -> Result<(), Failure> {
    let path = folder.join(format!("{}.ron", file_stem_of_tail(name)));
    let told: Vec<String> = records.iter().map(AppliedRecord::told).collect();
    if told.is_empty() {
        let _ = writeln!(outcome.text, "{name}: nothing applied");
        return Ok(());
    }
    let mut extended = model.clone();
    for record in records {
        extended = match extended.extended(record) {
            Ok(extended) => extended,
            Err(reason) => {
                outcome.refused.push(RefusedReport::whole(path, reason));
                return Ok(());
            }
        };
    }
    write_model(&extended, &path)?;
    let _ = writeln!(
        outcome.text,
        "{name}: applied {}; written to {}",
        told.join(" and "),
        show(&path)
    );
    Ok(())
}
