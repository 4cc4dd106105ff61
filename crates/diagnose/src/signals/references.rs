//! The conditions that effects are zero at, and why there may be no diagnosis.

use effects::ExtendedModel;
use effects::{EffectModelError, EffectPoint, EffectReferences};

use crate::signals::record::FlightRecord;

/// Why there is no diagnosis.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnoseError {
    /// The model takes no effects.
    #[error(transparent)]
    Model(#[from] EffectModelError),
    /// Nothing to learn a baseline from.
    #[error("no flight has a segment inside the drag table whose fuel flow can be used")]
    NoFlights,
    /// Too few tails to tell a type from its tails.
    #[error(
        "{found} tails with flights inside the drag table, at least {needed} are needed for a fleet"
    )]
    TooFewTails {
        /// Tails found.
        found: usize,
        /// Tails needed.
        needed: usize,
    },
    /// A matrix that is not positive definite: columns beyond what doubles hold.
    #[error("the linear model is degenerate")]
    Degenerate,
}

/// References of the data at hand.
///
/// # Errors
/// [`DiagnoseError::Model`] where nothing is inside the drag table.
pub fn references_of(
    model: &ExtendedModel,
    drag_table: &lut::Table,
    flights: &[FlightRecord<'_>],
) -> Result<EffectReferences, DiagnoseError> {
    let engines = model.aircraft().engines();
    let points: Vec<EffectPoint> = flights
        .iter()
        .flat_map(|flight| flight.segments)
        .filter_map(|segment| {
            // What cannot be corrected is left out of the diagnosis too, with its reason.
            let means = model.corrected_means(&segment.means).ok()?;
            let start_s = segment.identity.start_s();
            Some(EffectPoint::from_means(&means, start_s, engines))
        })
        .collect();
    Ok(effects::mean_references(model.aircraft(), drag_table, &points)?)
}
