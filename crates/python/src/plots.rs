//! Charts of `cruisefit plot`, chosen by their names, and pictures of them.

use pyo3::prelude::*;

use crate::failure::Failure;
use crate::work::run;

/// The charts that were asked for; none for all.
///
/// # Errors
/// A name that is not among `known`.
pub(crate) fn chosen<'a>(charts: &'a [String], known: &[&str]) -> Result<Vec<&'a str>, Failure> {
    match charts.iter().find(|chart| !known.contains(&chart.as_str())) {
        Some(unknown) => Err(Failure::input(format!(
            "charts: found {unknown:?}, expected one of {}",
            known.join(", ")
        ))),
        None => Ok(charts.iter().map(String::as_str).collect()),
    }
}

/// What was drawn.
///
/// # Errors
/// Nothing was: a model without flights has no errors, for example.
pub(crate) fn drawn(sheet: Option<String>) -> Result<String, Failure> {
    sheet.ok_or_else(|| Failure::input("charts: there is nothing of what was asked for"))
}

/// A sheet of charts as `png` or `pdf`, and the characters that the font of pictures does not have.
#[pyfunction]
pub(crate) fn picture(py: Python<'_>, svg: String, format: &str) -> PyResult<(Vec<u8>, String)> {
    let draw = match format {
        "png" => page::png,
        "pdf" => page::pdf,
        other => {
            let found = format!("found {other:?}, expected a name that ends in .svg, .png or .pdf");
            return Err(Failure::input(found).into());
        }
    };
    run(py, None, move |_| {
        let picture = draw(&svg).map_err(Failure::internal)?;
        Ok((picture.bytes, picture.unknown_characters.iter().collect()))
    })
}
