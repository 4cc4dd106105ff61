//! The aircraft file of a type's public model, as text.

use perf_model::poll_schumann::guide::PublicGuide;
use perf_model::poll_schumann::{Parameters, STATED_ACCURACY_PERCENT};

/// How the text of such a file begins.
const BEGINNING: &str = "// Public model of Poll and Schumann";

/// Whether a text was made by [`aircraft_text`], for any type.
pub fn is_public(text: &str) -> bool {
    text.starts_with(BEGINNING)
}

/// The aircraft file's text, its source above it.
///
/// # Errors
/// What RON says of a file that it cannot write.
pub fn aircraft_text(guide: &PublicGuide, parameters: &Parameters) -> Result<String, ron::Error> {
    let config = ron::ser::PrettyConfig::new().struct_names(false);
    let body = ron::ser::to_string_pretty(&guide.aircraft, config)?;
    Ok(format!(
        "{BEGINNING} (The Aeronautical Journal 125 (1284), 2021), parameters of {} as in pycontrails 0.63.5.\n\
         // Fuel burn within {STATED_ACCURACY_PERCENT} % in the majority of cases; not the manufacturer's book, and not for flight planning.\n\
         // The TSFC law is the one nearest to the model's engine: {:.1} % root mean square remain.\n{body}\n",
        parameters.type_code, guide.tsfc_residual_percent
    ))
}
