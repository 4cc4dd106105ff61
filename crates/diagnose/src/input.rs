//! What is diagnosed, against what, and what to look for.

use effects::{BetweenNodes, EffectReferences, ExtendedModel};
use flight::effect::EffectId;

use crate::baseline::Baseline;
use crate::signals::record::FlightRecord;
use crate::signals::references::{DiagnoseError, references_of};
use crate::signals::table_uncertainty::TableUncertainty;

/// What is diagnosed, and against what.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// The performance model.
    pub model: &'a ExtendedModel,
    /// Its drag table: its own, or the adapted one.
    pub drag_table: &'a lut::Table,
    /// What that table is between its nodes; with a baseline, what it was when that was learnt.
    pub between_nodes: BetweenNodes,
    /// Flights in order of flying, none of which the table has learnt.
    pub flights: &'a [FlightRecord<'a>],
    /// What the model remembers of clean flights; `None` against a table alone.
    pub baseline: Option<&'a Baseline>,
    /// What the table does not know, or what is believed of a guide's; `None` where every node counts as known.
    pub table: Option<&'a TableUncertainty>,
    /// Conditions that effects are zero at; else the baseline's, else the means of the data at hand.
    pub references: Option<EffectReferences>,
    /// Instants, s since 1970, at which something is known to have been done to the aircraft (wash, engine change, repair).
    pub events_s: &'a [f64],
}

impl<'a> Input<'a> {
    /// Flights against a model's own table, nothing taught and every node taken as known.
    #[must_use]
    pub const fn against(model: &'a ExtendedModel, flights: &'a [FlightRecord<'a>]) -> Self {
        Self {
            model,
            drag_table: model.drag_table(),
            between_nodes: BetweenNodes::Straight,
            flights,
            baseline: None,
            table: None,
            references: None,
            events_s: &[],
        }
    }

    /// The conditions that effects are zero at.
    ///
    /// # Errors
    /// [`DiagnoseError`] where they are to be the means of flights of which none is inside the table.
    pub fn effect_references(&self) -> Result<EffectReferences, DiagnoseError> {
        match (self.references, self.baseline) {
            (Some(given), _) => Ok(given),
            (None, Some(baseline)) => Ok(*baseline.references()),
            (None, None) => references_of(self.model, self.drag_table, self.flights),
        }
    }
}

/// What to look for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Only these effects; empty for all.
    pub effects: Vec<EffectId>,
    /// Not these.
    pub without: Vec<EffectId>,
    /// Leave closure out: choice and fit on folds cost as much again as the search.
    pub skip_closure: bool,
    /// Leave out where the gap lies; the verdict then does not know of a gap at one engine.
    pub skip_where: bool,
    /// Seed of the draws of noise and the resamples of flights behind intervals and `where`.
    pub seed: u64,
}
