//! Which segments lie in a region.

use effects::{EffectModel, EffectPoint, Effects};

use crate::input::Input;
use crate::output::Slice;
use crate::place::binned_variable::{ENGINE, is_within, unknown_names, variable_named};
use crate::signals::channels::mean_n2_percent;
use crate::signals::references::{DiagnoseError, references_of};
use crate::signals::variables::Variable;

/// Why no segment lies in a region.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SliceError {
    /// Bounds of something that is no variable.
    #[error("\"{name}\" is no variable that a place has bounds in")]
    UnknownVariable {
        /// What it is called.
        name: String,
    },
    /// The model takes no effects, or knows none of the flights.
    #[error(transparent)]
    Model(#[from] DiagnoseError),
}

/// Of every segment, flight by flight, whether it lies within the bounds of a region. What the model cannot predict lies
/// nowhere; an engine has no bounds here.
///
/// # Errors
/// [`SliceError`] for a name that is no variable, or a model that takes no effects.
pub fn slice_members(input: &Input<'_>, slice: &Slice) -> Result<Vec<Vec<bool>>, SliceError> {
    if let Some(name) = unknown_names(&slice.bounds).first() {
        return Err(SliceError::UnknownVariable { name: (*name).to_owned() });
    }
    let references = match (input.references, input.baseline) {
        (Some(given), _) => given,
        (None, Some(baseline)) => *baseline.references(),
        (None, None) => references_of(input.model, input.drag_table, input.flights)?,
    };
    let model =
        EffectModel::new(input.model, input.drag_table, references).map_err(DiagnoseError::from)?;
    let engines = model.aircraft().engines();
    let bounds: Vec<(Variable, [Option<f64>; 2])> = slice
        .bounds
        .iter()
        .filter(|(name, _)| *name != ENGINE)
        .filter_map(|(name, &bounds)| Some((variable_named(name)?, bounds)))
        .collect();
    let is_member = |segment: &flight::Segment| {
        let start_s = segment.identity.start_s();
        let Ok(means) = model.corrected_means(&segment.means) else { return false };
        let point = EffectPoint::from_means(&means, start_s, engines);
        let Ok(response) = model.response(&point, &Effects::none()) else { return false };
        bounds.iter().all(|&(variable, bounds)| {
            let value = match variable {
                Variable::N2 => mean_n2_percent(&means),
                Variable::Date => Some(point.date_s),
                _ => variable.value(&point, &response, &references),
            };
            value.is_some_and(|value| is_within(value, bounds))
        })
    };
    Ok(input.flights.iter().map(|flight| flight.segments.iter().map(is_member).collect()).collect())
}
