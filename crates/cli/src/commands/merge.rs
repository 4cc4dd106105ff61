//! `cruisefit merge`: what several models of one initial model have learnt, in one.

use std::path::Path;

use crate::args::MergeArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::folder::stored_of;
use crate::models::{check_model_replaceable, file_of_model, read_model, write_model};
use pipeline::merging::{self, Merging, Part};
use pipeline::model_file::ModelFile;
use pipeline::summary::counted;

/// Runs the command.
///
/// # Errors
/// Models that do not add up: different initial models, laws, settings or trim criteria, or a flight that two have
/// learnt.
pub(crate) fn run(arguments: &MergeArgs) -> Result<Outcome, Failure> {
    let mut parts = Vec::with_capacity(arguments.models.len());
    for path in &arguments.models {
        parts.push(part_of(path)?);
    }
    let bare = parts.iter().position(|part| part.flights.is_none());
    let spread = merging::spread_of_tails_percent(&parts);
    let (merged, how) = merging::merge(parts)
        .map_err(|(place, error)| Failure::bad_file(&arguments.models[place], error))?;
    let flights = merged.learnt.as_ref().map_or(0, |learnt| learnt.ledger.len());
    // A sum may be made again; anything else would be lost.
    check_model_replaceable(&arguments.output, arguments.force, Some(&merged), |known| {
        let sum = |model: &ModelFile| {
            model.learnt.as_ref().map(|learnt| (learnt.tail.clone(), learnt.ledger.clone()))
        };
        sum(known) == sum(&merged) && known.difference_of_initial(&merged).is_none()
    })?;
    write_model(&merged, &arguments.output)?;
    if let Some(percent) = spread {
        tracing::warn!(
            "the models are of several tails, which differ by {percent:.2} % of fuel flow (standard deviation): the merged model says how \
             well it knows their mean, and each of them, like any other tail, is off it by about that"
        );
    }
    let by = match (how, bare) {
        (Merging::Added, Some(place)) => format!(
            "Added up, the table alone: the segments of {} are not at hand. From folders of `adapt` all flights are learnt again.\n",
            show(&arguments.models[place])
        ),
        _ => "All flights were learnt again from their segments, as if at once.\n".to_owned(),
    };
    let text = format!(
        "{} of {} merged, written to {}\n{by}",
        counted(flights, "flight"),
        counted(arguments.models.len(), "model"),
        show(&arguments.output)
    );
    let figures = serde_json::json!({
        "models": arguments.models.len(),
        "flights": flights,
        "learnt_again": how == Merging::LearntAgain,
        "written": [show(&arguments.output)],
    });
    Ok(Outcome::with_figures(text, figures))
}

/// A model with its flights and segments, where it is one of a folder of `adapt`.
fn part_of(path: &Path) -> Result<Part, Failure> {
    let path = file_of_model(path)?;
    if let Some(stored) = stored_of(&path)? {
        return Ok(Part { model: stored.model, flights: Some((stored.flights, stored.segments)) });
    }
    Ok(Part { model: read_model(&path)?, flights: None })
}
