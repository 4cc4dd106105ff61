//! Which segments lie in a region.

use effects::{EffectModel, EffectPoint, Effects, Variable};

use crate::input::Input;
use crate::output::region::Region;
use crate::signals::channels::mean_n2_percent;
use crate::signals::references::DiagnoseError;

/// Of every segment, flight by flight, whether it meets the conditions of a region. What the model cannot predict lies
/// nowhere; which engine the region is of changes nothing: every segment is of all engines.
///
/// # Errors
/// [`DiagnoseError`] for a model that takes no effects, or that knows none of the flights.
pub fn region_members(input: &Input<'_>, region: &Region) -> Result<Vec<Vec<bool>>, DiagnoseError> {
    let references = input.effect_references()?;
    let model = EffectModel::new(input.model, input.drag_table, references)?;
    let engines = model.aircraft().engines();
    let is_member = |segment: &flight::Segment| {
        let start_s = segment.identity.start_s();
        let Ok(means) = model.corrected_means(&segment.means) else { return false };
        let point = EffectPoint::from_means(&means, start_s, engines);
        let Ok(response) = model.response(&point, &Effects::none()) else { return false };
        region.conditions.iter().all(|condition| {
            let value = match condition.variable {
                Variable::N2 => mean_n2_percent(&means),
                Variable::Date => Some(point.date_s),
                variable => variable.value(&point, &response, &references),
            };
            value.is_some_and(|value| condition.holds(value))
        })
    };
    Ok(input.flights.iter().map(|flight| flight.segments.iter().map(is_member).collect()).collect())
}
