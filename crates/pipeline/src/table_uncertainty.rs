//! What a learnt drag table does not know, as the diagnosis takes it.

use std::sync::Arc;

use adapt::bayes::{BayesSettings, BayesState, Posterior};
use diagnose::{FlightRecord, GuideStates, TableUncertainty, TableUncertaintyError, visited_nodes};
use effects::{ExtendedModel, GuideRange, lost_rises};

use crate::model_file::{GuideRecord, ModelFile};
use crate::whole_model::{HeldAgainst, Predicts};

/// Most nodes of a table whose full covariance is taken; beyond, that of the nodes which the flights at hand visit.
const NODES_WITH_COVARIANCE: usize = 700;

/// What a model's table does not know where these flights are. Of a model that no flight has taught, or that was taught by a
/// law that does not say, it is what is believed of a guide: the prior of law `bayes`; and so it is of what the flights have
/// left open of a table alone: it may still be off as a guide's is. `None`
/// where the aircraft file states that the table is exact (`table_uncertainty_percent: 0`) and nothing was learnt.
/// `None` too where the whole model is asked for, whose baseline has it.
///
/// # Errors
/// A covariance that is invalid.
pub fn of_model(
    model: &ModelFile,
    predicts: Predicts,
    flights: &[FlightRecord<'_>],
) -> Result<Option<TableUncertainty>, TableUncertaintyError> {
    let has_whole_model = model.has_whole_model();
    // What was learnt together with the table has its uncertainty too.
    if has_whole_model && predicts == Predicts::WholeModel {
        return Ok(None);
    }
    let HeldAgainst { model: initial, drag_table: table, .. } = model.held_against(predicts);
    let settings = model.settings.bayes;
    let belief = Belief { model: initial, settings, guide: Some(&model.guide) };
    let is_exact = initial.aircraft().table_uncertainty_percent() == Some(0.0);
    match model.posterior() {
        Some(posterior) if has_whole_model || (is_exact && model.has_learnt_segments()) => {
            of_posterior(posterior, initial, table, flights).map(Some)
        }
        Some(posterior) if model.has_learnt_segments() => {
            belief.after(posterior, table, flights).map(Some)
        }
        _ => of_book(initial, table, settings, Some(&model.guide), flights),
    }
}

/// What is believed of a guide's drag before any flight: the prior of law `bayes`, its size scaled to what the aircraft file
/// states, and what the polynomial lost of the guide, where that is given; `None` where the file states 0.
///
/// ```text
/// C = C_bayes + ε²/J·Σ_j r_j r_jᵀ/(CD CDᵀ),   ε rms of the guide beside the polynomial, r_j the J shapes of [diagnosis.59]
/// ```
///
/// Law `bayes` believes in corrections that bend little. Where a guide has a drag rise, its six-coefficient polynomial is off by
/// what bends most: without this belief such a table is taken for scatter between flights, or for an effect beside it. The nodes that
/// the guide's own rows make keep most of the rise; what they lose too is of these shapes, and at most as large.
///
/// # Errors
/// A covariance that is invalid: a table whose drag is not positive, or settings that make none.
pub fn of_book(
    model: &ExtendedModel,
    drag_table: &lut::Table,
    settings: BayesSettings,
    guide: Option<&GuideRecord>,
    flights: &[FlightRecord<'_>],
) -> Result<Option<TableUncertainty>, TableUncertaintyError> {
    if model.aircraft().table_uncertainty_percent() == Some(0.0) {
        return Ok(None);
    }
    let invalid = TableUncertaintyError::NotPositiveDefinite;
    let nothing_learnt = BayesState::new(drag_table, settings).map_err(|_| invalid)?;
    let prior = nothing_learnt.solve().map_err(|_| invalid)?;
    Belief { model, settings, guide }.after(&prior, drag_table, flights).map(Some)
}

/// What is believed of a guide's drag.
struct Belief<'a> {
    model: &'a ExtendedModel,
    settings: BayesSettings,
    guide: Option<&'a GuideRecord>,
}

impl Belief<'_> {
    /// C of [`of_book`], `C_bayes` being what law `bayes` knows after the flights that it has learnt.
    fn after(
        &self,
        posterior: &Posterior,
        drag_table: &lut::Table,
        flights: &[FlightRecord<'_>],
    ) -> Result<TableUncertainty, TableUncertaintyError> {
        let Self { model, settings, guide } = *self;
        let usual_percent = 100.0 * settings.values().correction_std;
        let stated = model.aircraft().table_uncertainty_percent();
        let scale = stated.map_or(1.0, |percent| percent / usual_percent);
        let visited = visited_nodes(model, drag_table, flights).unwrap_or_default();
        let lost = guide.map_or_else(Vec::new, |guide| lost_of_guide(model, drag_table, guide));
        Ok(of_visited_and(posterior, drag_table.grid(), &visited, scale, &lost)?.of_book())
    }
}

/// Masses and levels of a guide; `None` of model files from before they were kept.
pub(crate) fn states_of(guide: &GuideRecord) -> Option<GuideStates> {
    Some(GuideStates {
        masses_kg: guide.mass_kg?,
        pressure_altitudes_m: guide.pressure_altitude_m?,
    })
}

/// Relative errors of the nodes by what the polynomial lost of the guide, one vector a shape, their squares to be summed. None where
/// the guide's range is too small for a polynomial: then it lost nothing.
fn lost_of_guide(
    model: &ExtendedModel,
    drag_table: &lut::Table,
    guide: &GuideRecord,
) -> Vec<Vec<f64>> {
    let range = GuideRange { lift_coefficient: guide.lift_coefficient, mach: guide.mach };
    let basis = model.polynomial().basis;
    let mut shapes = lost_rises(basis, &range, drag_table.grid()).unwrap_or_default();
    let each = guide.residual_rms / (shapes.len().max(1) as f64).sqrt();
    for shape in &mut shapes {
        for (value, drag_coefficient) in shape.iter_mut().zip(drag_table.values()) {
            *value *= each / drag_coefficient;
        }
    }
    shapes
}

/// What a table learnt by law `bayes` does not know: `drag_table` is what the flights are held against.
///
/// # Errors
/// A covariance that is invalid.
pub fn of_posterior(
    posterior: &Posterior,
    model: &ExtendedModel,
    drag_table: &lut::Table,
    flights: &[FlightRecord<'_>],
) -> Result<TableUncertainty, TableUncertaintyError> {
    let grid = drag_table.grid();
    let nodes = grid.nodes();
    if nodes > NODES_WITH_COVARIANCE {
        // Flights of which none is inside the table visit no node; the diagnosis states why it has no result.
        let visited = visited_nodes(model, drag_table, flights).unwrap_or_default();
        return of_visited(posterior, grid, &visited, 1.0);
    }
    let cells: Vec<lut::Cell> = (0..nodes)
        .filter_map(|node| {
            let (x, y) = grid.coordinates(node);
            grid.locate(x, y, lut::Outside::Hold).ok()
        })
        .collect();
    TableUncertainty::from_covariance(Arc::clone(grid), &posterior.relative_covariances(&cells))
}

/// The same over the nodes that flights visit, one solve for each column that is kept; standard deviations times `scale`.
pub(crate) fn of_visited(
    posterior: &Posterior,
    grid: &Arc<lut::Grid>,
    visited: &[usize],
    scale: f64,
) -> Result<TableUncertainty, TableUncertaintyError> {
    of_visited_and(posterior, grid, visited, scale, &[])
}

/// The same with more shapes by which nodes err together, of a size unknown about 0 with a standard deviation of 1 each.
fn of_visited_and(
    posterior: &Posterior,
    grid: &Arc<lut::Grid>,
    visited: &[usize],
    scale: f64,
    shapes: &[Vec<f64>],
) -> Result<TableUncertainty, TableUncertaintyError> {
    let square = |(node, deviation): (usize, &f64)| {
        let of_shapes: f64 = shapes.iter().map(|shape| shape[node] * shape[node]).sum();
        (scale * deviation).powi(2) + of_shapes
    };
    let deviations = posterior.standard_deviation();
    let variances: Vec<f64> = deviations.iter().enumerate().map(square).collect();
    let column = |node: usize| {
        let mut covariances = posterior.covariances_with(node);
        for value in &mut covariances {
            *value *= scale * scale;
        }
        for shape in shapes {
            for (value, other) in covariances.iter_mut().zip(shape) {
                *value += shape[node] * other;
            }
        }
        covariances
    };
    TableUncertainty::from_columns(Arc::clone(grid), visited, &variances, column)
}

#[cfg(test)]
mod tests {
    use super::*;
    use adapt::bayes::{BayesSettings, BayesState};
    use flight::{Observation, ObservationVariance, Timestamp};
    use lut::{Axis, Grid, Outside, Table};

    /// Neighbouring nodes of a table of 1200 nodes err together, as the posterior has it.
    #[test]
    fn a_table_of_many_nodes_keeps_the_covariance_of_those_visited() {
        let axis = |first: f64, step: f64, count: u32| {
            Axis::new((0..count).map(|k| first + step * f64::from(k)).collect()).unwrap()
        };
        let grid = Arc::new(Grid::new(axis(0.10, 0.02, 40), axis(0.50, 0.015, 30)));
        let drag = |node: usize| 0.02 + 0.05 * grid.coordinates(node).0.powi(2);
        let initial = Table::new(Arc::clone(&grid), (0..grid.nodes()).map(drag).collect()).unwrap();
        let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
        let variance = ObservationVariance { segment: 2.5e-5, flight: 2e-5 };
        let at = |lift: f64, mach: f64| Observation {
            time: Timestamp::UNIX_EPOCH,
            lift_coefficient: lift,
            mach,
            drag_coefficient: 1.03 * (0.02 + 0.05 * lift * lift),
            fuel_flow_total_kg_s: 0.33,
            fuel_flow_per_drag_coefficient_kg_s: 10.0,
            variance,
        };
        let _ = state.learn_flight(&[at(0.42, 0.78), at(0.45, 0.80), at(0.51, 0.76)]);
        let posterior = state.solve().unwrap();
        let cells = [(0.42, 0.78), (0.45, 0.80), (0.51, 0.76)]
            .map(|(lift, mach)| grid.locate(lift, mach, Outside::Error).unwrap());
        let mut visited: Vec<usize> = cells.iter().flat_map(lut::Cell::nodes).collect();
        visited.sort_unstable();
        visited.dedup();
        let found = of_visited(&posterior, &grid, &visited, 1.0).unwrap();
        for &a in &visited {
            let known = posterior.covariances_with(a);
            for &b in &visited {
                let scale = posterior.standard_deviation()[a] * posterior.standard_deviation()[b];
                let off = (found.covariance(a, b) - known[b]).abs() / scale;
                assert!(off < 1e-3, "nodes {a} and {b}: off by {off} of their standard deviations");
            }
        }
    }
}
