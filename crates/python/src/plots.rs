//! Charts of `cruisefit plot`, chosen by their names, and pictures of them.

use page::PictureFormat;
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
    let Some(of_ending) = PictureFormat::from_ending(format) else {
        let found = format!("found {format:?}, expected a name that ends in .svg, .png or .pdf");
        return Err(Failure::input(found).into());
    };
    run(py, None, move |_| {
        let picture = of_ending.draw(svg).map_err(Failure::internal)?;
        Ok((picture.bytes, picture.unknown_characters.iter().collect()))
    })
}

/// What was planted against what was found, of a `trials.json`, as SVG.
#[pyfunction]
pub(crate) fn plot_trials(json: &str) -> PyResult<String> {
    let wrong = |error: serde_json::Error| Failure::input(format!("trials.json: {error}"));
    let mut document: serde_json::Value = serde_json::from_str(json).map_err(wrong)?;
    // A document may be a list, a number or a text, which have nothing by a name.
    let groups = document.get_mut("groups").map(serde_json::Value::take).unwrap_or_default();
    let groups = serde_json::from_value::<Vec<page::TrialConfusion>>(groups);
    Ok(drawn(page::plot_trials(&groups.map_err(wrong)?))?)
}
