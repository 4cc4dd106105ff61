//! `cruisefit explain`: what an effect, a column, a set of criteria, a verdict or a figure of an output is.

use pipeline::topics::{book, explain, overview, topics};

use crate::args::ExplainArgs;
use crate::commands::Outcome;
use crate::failure::Failure;

/// Runs the command.
///
/// # Errors
/// A topic that is not known; the nearest one is named.
pub(crate) fn run(arguments: &ExplainArgs) -> Result<Outcome, Failure> {
    if arguments.book {
        return Ok(Outcome::text(book()));
    }
    let Some(topic) = arguments.topic.as_deref() else {
        return Ok(Outcome::with_json(overview(), document(&topics().join("\n"), &overview())));
    };
    let text =
        explain(topic).map_err(|reason| Failure::BadArgument { argument: "TOPIC", reason })?;
    Ok(Outcome::with_json(&*text, document(topic, &text)))
}

fn document(topic: &str, text: &str) -> String {
    let topics: Vec<&str> = topic.lines().collect();
    let document =
        serde_json::json!({ "schema": "cruisefit.topic/1", "topics": topics, "text": text });
    format!("{document:#}\n")
}
