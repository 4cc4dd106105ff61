//! The aircraft file of a type's public model, as text.

use perf_model::poll_schumann::guide::PublicGuide;
use perf_model::poll_schumann::{Parameters, STATED_ACCURACY_PERCENT};

/// How the text of such a file begins.
const BEGINNING: &str = "// Public model of Poll and Schumann";

/// Whether a text was made by [`aircraft_text`], for any type.
pub fn is_public(text: &str) -> bool {
    text.starts_with(BEGINNING)
}

/// How far to trust a guide, in one sentence: what the authors state of the type with parameters, and that it does not hold for a
/// type that this one represents.
pub fn accuracy(guide: &PublicGuide, parameters: &Parameters) -> String {
    let (by, type_code) = (&parameters.type_code, &guide.aircraft.type_code);
    if parameters.is_of(type_code) {
        return format!(
            "Its authors expect fuel burn within {STATED_ACCURACY_PERCENT} % in the majority of cases"
        );
    }
    format!(
        "It is a model of {by}, with its wing, masses and {} engines, and not of {type_code}: the {STATED_ACCURACY_PERCENT} % that its \
         authors expect in the majority of cases are those of {by}; how near {type_code} is to it, nobody states",
        parameters.engines
    )
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
         // {}.\n\
         // It is not the manufacturer's book, and not for flight planning.\n\
         // The TSFC law is the one nearest to the model's engine: {:.1} % root mean square remain.\n{body}\n",
        parameters.type_code,
        accuracy(guide, parameters),
        guide.tsfc_residual_percent
    ))
}
