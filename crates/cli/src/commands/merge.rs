//! `cruisefit merge`: the sum of what several models of one initial model have learnt.

use crate::args::MergeArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::models::{check_model_replaceable, read_model, write_model};
use pipeline::model_file::ModelFile;
use pipeline::{learning, merging};

/// Runs the command.
///
/// # Errors
/// Models that do not add up: different initial models, laws, settings or trim criteria, or a flight that two have
/// learnt.
pub(crate) fn run(arguments: &MergeArgs) -> Result<Outcome, Failure> {
    let mut models = Vec::with_capacity(arguments.models.len());
    for path in &arguments.models {
        models.push((path, read_model(path)?));
    }
    let Some(((_, first), others)) = models.split_first() else {
        return Err(Failure::BadArgument {
            argument: "MODEL.ron",
            reason: "none given".to_owned(),
        });
    };
    let mut merged = first.clone();
    for (path, other) in others {
        merging::add(&mut merged, other).map_err(|error| Failure::bad_file(path, error))?;
    }
    let Some(learnt) = &mut merged.learnt else {
        return Err(Failure::bad_file(&arguments.models[0], "has not learnt anything"));
    };
    learnt
        .ledger
        .sort_by(|one, other| (&one.start, &one.flight).cmp(&(&other.start, &other.flight)));
    learning::settle(learnt).map_err(|error| Failure::bad_file(&arguments.models[0], error))?;
    let flights = learnt.ledger.len();
    // A sum may be made again; anything else would be lost.
    check_model_replaceable(&arguments.output, arguments.force, Some(&merged), |known| {
        let sum = |model: &ModelFile| {
            model.learnt.as_ref().map(|learnt| (learnt.tail.clone(), learnt.ledger.clone()))
        };
        sum(known) == sum(&merged) && known.difference_of_initial(&merged).is_none()
    })?;
    write_model(&merged, &arguments.output)?;
    let text = format!(
        "{flights} flights of {} models merged, written to {}\n",
        arguments.models.len(),
        show(&arguments.output)
    );
    let figures = serde_json::json!({
        "models": arguments.models.len(), "flights": flights, "written": [show(&arguments.output)],
    });
    Ok(Outcome::with_figures(text, figures))
}
