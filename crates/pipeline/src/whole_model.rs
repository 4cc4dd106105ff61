//! What a model predicts with everything that it has learnt, or with its drag table alone.

use adapt::bayes::{BayesSettings, BayesState, InitialError, Posterior, SolveError};
use diagnose::{TableUncertainty, TableUncertaintyError, WholeModel, WholePrediction};
use effects::{BetweenNodes, ExtendedModel};
use flight::Segment;
use lut::{Outside, Table};

use crate::model_file::ModelFile;

/// Which part of a model predicts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Predicts {
    /// Everything that was learnt; the drag table where nothing else was.
    #[default]
    WholeModel,
    /// The drag table as the law left it.
    TableOnly,
}

impl Predicts {
    /// The table alone where that is asked for.
    pub const fn table_only(asked: bool) -> Self {
        if asked { Self::TableOnly } else { Self::WholeModel }
    }
}

/// What flights are held against.
#[derive(Clone, Copy, Debug)]
pub struct HeldAgainst<'a> {
    /// The model.
    pub model: &'a ExtendedModel,
    /// Its drag table.
    pub drag_table: &'a Table,
    /// What that is between its nodes.
    pub between_nodes: BetweenNodes,
}

impl ModelFile {
    /// The model with everything that it has learnt; `None` where it has learnt no more than a table, or where only the table
    /// is asked for.
    pub fn whole(&self, predicts: Predicts) -> Option<WholeModel<'_>> {
        if predicts == Predicts::TableOnly {
            return None;
        }
        let baseline = self.learnt.as_ref()?.baseline.as_ref()?;
        // A baseline was learnt against this very model: it took its effects then.
        WholeModel::new(self.reference(), baseline).ok()
    }

    /// What flights are held against together with what the model has learnt: what everything learnt refers to, which before any flight
    /// is what the guide's rows say, smooth between the nodes; the initial model with the learnt table where there is nothing else.
    pub fn held_against(&self, predicts: Predicts) -> HeldAgainst<'_> {
        let has_table_alone = self.has_learnt_segments() && !self.has_whole_model();
        if has_table_alone || predicts == Predicts::TableOnly {
            let (model, drag_table) = (&self.initial, self.drag_coefficient());
            return HeldAgainst { model, drag_table, between_nodes: BetweenNodes::Straight };
        }
        let model = self.reference();
        let between_nodes = match self.by_guide {
            Some(_) => BetweenNodes::Smooth,
            None => BetweenNodes::Straight,
        };
        HeldAgainst { model, drag_table: model.drag_table(), between_nodes }
    }

    /// Whether more than a table was learnt.
    pub fn has_whole_model(&self) -> bool {
        self.learnt.as_ref().is_some_and(|learnt| learnt.baseline.is_some())
    }
}

/// A segment held against the whole model.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentHeld {
    /// ln of recorded over predicted fuel flow.
    pub gap: f64,
    /// The prediction.
    pub prediction: WholePrediction,
}

impl SegmentHeld {
    /// A segment held against a model; `None` outside its table or a domain.
    pub fn new(whole: &WholeModel<'_>, model: &ExtendedModel, segment: &Segment) -> Option<Self> {
        let prediction = whole.of_segment(segment).ok()?;
        let corrected = model.corrected_means(&segment.means).ok()?;
        let gap = corrected.fuel_flow_total_kg_s.ln() - prediction.ln_fuel_flow;
        gap.is_finite().then_some(Self { gap, prediction })
    }
}

/// A segment held against a table of law `bayes`, relative to the initial drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldByTable {
    /// Recorded less predicted drag.
    pub(crate) excess: f64,
    /// Standard deviation of it that the law states.
    pub(crate) deviation: f64,
    /// The same of fuel flow, relative to what is predicted: fuel flow goes with drag.
    pub(crate) fuel_flow_deviation: f64,
}

impl HeldByTable {
    /// `None` outside the table or a domain.
    pub(crate) fn new(
        model: &ExtendedModel,
        posterior: &Posterior,
        segment: &Segment,
    ) -> Option<Self> {
        let observation = model.observe(segment).ok()?;
        let (lift_coefficient, mach) = (observation.lift_coefficient, observation.mach);
        let grid = posterior.drag().grid();
        let cell = grid.locate(lift_coefficient, mach, Outside::Error).ok()?;
        let deviation = posterior.segment_variance(&cell, &observation.variance).sqrt();
        let (initial, drag) =
            (posterior.initial().interpolate(&cell), posterior.drag().interpolate(&cell));
        Some(Self {
            excess: (observation.drag_coefficient - drag) / initial,
            deviation,
            fuel_flow_deviation: deviation * initial / drag,
        })
    }
}

/// Why there is no belief about an initial drag table.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum BeliefError {
    /// A table that the law cannot correct.
    #[error(transparent)]
    Initial(#[from] InitialError),
    /// The prior has no solution.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The covariance is invalid.
    #[error(transparent)]
    Covariance(#[from] TableUncertaintyError),
}

/// 100 (recorded − predicted)/recorded fuel flow of a segment, without an interval; `None` outside its table or a domain. `known`
/// is ln of what is predicted, where that was computed already.
pub fn error_percent_of(
    whole: &WholeModel<'_>,
    model: &ExtendedModel,
    segment: &Segment,
    known: Option<f64>,
) -> Option<f64> {
    let predicted = match known {
        Some(ln) => ln,
        None => whole.ln_fuel_flow_of_segment(segment).ok()?,
    };
    gap_to(predicted, model, segment).map(error_percent)
}

/// ln of recorded over predicted fuel flow of a segment, without an interval: to the same bits as [`SegmentHeld`] at a fraction
/// of its cost; `None` outside its table or a domain.
pub fn ln_gap_of(whole: &WholeModel<'_>, model: &ExtendedModel, segment: &Segment) -> Option<f64> {
    gap_to(whole.ln_fuel_flow_of_segment(segment).ok()?, model, segment)
}

fn gap_to(predicted: f64, model: &ExtendedModel, segment: &Segment) -> Option<f64> {
    let corrected = model.corrected_means(&segment.means).ok()?;
    let gap = corrected.fuel_flow_total_kg_s.ln() - predicted;
    gap.is_finite().then_some(gap)
}

/// Of ln(recorded) − ln(predicted).
fn error_percent(gap: f64) -> f64 {
    -100.0 * (-gap).exp_m1()
}

/// What law `bayes` believes of an initial drag table before it has learnt anything, over the nodes that flights visit.
///
/// # Errors
/// A table that the law cannot correct, or a covariance that is invalid.
pub fn belief_before_flights(
    initial: &ExtendedModel,
    settings: BayesSettings,
    visited: &[usize],
) -> Result<TableUncertainty, BeliefError> {
    let prior = BayesState::new(initial.drag_table(), settings)?.solve()?;
    let grid = initial.drag_table().grid();
    Ok(crate::table_uncertainty::of_visited(&prior, grid, visited, 1.0)?)
}
