//! What a run writes besides the tails' files: `summary.json` and `report.html`.

use std::collections::BTreeMap;

use pipeline::file_names::{link_to, page_file_of_tail};
use pipeline::summary::{RefusedSummary, ReportsSummary, SCHEMA, Summary};

use super::Run;
use super::tail::TailOutcome;
use crate::failure::{Failure, RefusedReport};
use crate::files::outputs::{check_replaceable, would_lose};
use crate::folder::Folder;
use crate::terminal::neutral;

const SUMMARY: &str = "summary.json";
const PAGE: &str = "report.html";

/// Refuses to replace a summary or page that `adapt` did not make, in a folder that it has not begun.
///
/// # Errors
/// A file that would be lost.
pub(super) fn check_own(folder: &Folder) -> Result<(), Failure> {
    if !folder.tails().is_empty() {
        return Ok(());
    }
    // What a page begins with, of whatever version.
    for (name, mark) in [(SUMMARY, "cruisefit.summary/"), (PAGE, "content=\"cruisefit ")] {
        let path = folder.path().join(name);
        let is_own = |text: &str| text.contains(mark);
        match check_replaceable(&path, false, &[], is_own) {
            Err(Failure::WouldReplace { .. }) => {
                would_lose(&path, "a file that was not made by this command")?;
            }
            checked => checked?,
        }
    }
    Ok(())
}

/// Writes both to the folder's waiting room.
///
/// # Errors
/// A file that cannot be written.
pub(super) fn write(
    run: &Run<'_>,
    refused: &[RefusedReport],
    outcomes: &[TailOutcome],
) -> Result<Summary, Failure> {
    let tails = outcomes.iter().filter_map(|outcome| {
        let mut summary = outcome.state.as_ref()?.summary.clone();
        summary.flights_new = outcome.flights_new;
        Some(summary)
    });
    let summary = Summary {
        schema: SCHEMA,
        reports: ReportsSummary {
            read: outcomes.iter().map(|outcome| outcome.flights_new).sum(),
            already_known: outcomes.iter().map(|outcome| outcome.already_known).sum(),
            copies: outcomes.iter().map(|outcome| outcome.copies).sum(),
            other_files: run.other_files,
            refused: refused.iter().map(RefusedSummary::from).collect(),
        },
        tails: tails.collect(),
    };
    run.folder.stage_unnamed(SUMMARY, &summary.to_json())?;
    let title = "Adaptation of performance models to cruise reports";
    let page = if run.on_one_page {
        let sections: Vec<&page::Section> =
            outcomes.iter().filter_map(|outcome| outcome.section.as_ref()).collect();
        page::report_of_sections(&summary, &sections, title)
    } else {
        let links: BTreeMap<&str, String> = outcomes
            .iter()
            .filter(|outcome| outcome.state.is_some())
            .map(|outcome| (outcome.tail.as_str(), link_to(&page_file_of_tail(&outcome.tail))))
            .collect();
        page::fleet_report(&summary, &links, title)
    };
    run.folder.stage_unnamed(PAGE, neutral(&page).as_bytes())?;
    Ok(summary)
}
