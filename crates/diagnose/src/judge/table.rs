//! A guide's drag table that is off: how probable that is, by how much, and what these flights cannot tell from it.

use flight::effect::EffectId;

use crate::library::Library;
use crate::math::gram::Gram;
use crate::output::Magnitude;
use crate::residuals::rows::SegmentRow;
use crate::search::analyse::Analysis;
use crate::search::system::WhitenedSystem;
use crate::signals::table_uncertainty::TableUncertainty;
use crate::thresholds::{FLEXIBLE_EFFECT, MORE_PROBABLE_THAN_NOT, NORMAL_95};

/// What is found of a guide's table.
#[derive(Clone, Debug)]
pub(crate) struct TableFinding {
    /// Probability that the table is off.
    pub(crate) probability: f64,
    /// By how much, % rms over what was flown.
    pub(crate) magnitude: Magnitude,
    /// The effect itself first, then effects that a table can hold as well.
    pub(crate) class: Vec<EffectId>,
}

impl TableFinding {
    /// `None` where the table is no guide's, or cannot be fitted.
    pub(crate) fn fit(
        system: &WhitenedSystem<'_>,
        analysis: &Analysis,
        library: &Library,
    ) -> Option<Self> {
        if !system.is_book() {
            return None;
        }
        let probability = probability_off(analysis);
        let class = class(analysis, library);
        let best = &analysis.models.first()?.0.hypothesis.columns;
        let magnitude = magnitude(system, library, &beyond(library, &class, best))?;
        Some(Self { probability: probability.min(1.0), magnitude, class })
    }
}

/// Named effects and the table fitted together.
#[derive(Clone, Debug, Default)]
pub(crate) struct FittedTable {
    /// Columns of the library that were fitted with it: what no table can hold, and its sizes.
    pub(crate) columns: Vec<usize>,
    pub(crate) sizes: Vec<f64>,
    /// Coefficients of the table's columns, then of its chords.
    coefficients: Vec<f64>,
}

impl FittedTable {
    /// Fits a guide's table, and of these columns of the library those that no table can hold, to a Gram; `None` where the
    /// matrix is not positive definite.
    pub(crate) fn new(
        system: &WhitenedSystem<'_>,
        library: &Library,
        gram: &Gram,
        (analysis, named): (&Analysis, &[usize]),
    ) -> Option<Self> {
        let named = beyond(library, &class(analysis, library), named);
        Self::of_columns(system, library, gram, &named)
    }

    fn of_columns(
        system: &WhitenedSystem<'_>,
        library: &Library,
        gram: &Gram,
        named: &[usize],
    ) -> Option<Self> {
        let (columns, deviations) = columns(system, library, named);
        let solution = gram.fit(&columns, &deviations, system.design.residual())?;
        let size_of = |of_table: usize| {
            let at = columns.iter().position(|column| *column == of_table);
            at.map_or(0.0, |k| solution[(k, 0)])
        };
        Some(Self {
            columns: named.to_vec(),
            sizes: (0..named.len()).map(|k| solution[(k, 0)]).collect(),
            coefficients: columns_of_table(system).map(size_of).collect(),
        })
    }

    /// By how much the table's drag is off at a segment, ln.
    pub(crate) fn drag_at(&self, system: &WhitenedSystem<'_>, row: &SegmentRow) -> f64 {
        let loadings = loadings(system, row);
        loadings.iter().zip(&self.coefficients).map(|(loading, size)| loading * size).sum()
    }
}

/// Columns of a table's nodes, then of its chords: where flights lie within one or two cells the two are fitted against each other,
/// and neither says anything without the other.
fn columns_of_table(system: &WhitenedSystem<'_>) -> impl Iterator<Item = usize> {
    system.design.table_columns().chain(system.design.chord_columns())
}

/// What a segment's drag leans on, in the order of [`columns_of_table`].
fn loadings(system: &WhitenedSystem<'_>, row: &SegmentRow) -> Vec<f64> {
    let mut loadings = vec![0.0; system.design.table().map_or(0, TableUncertainty::rank)];
    if let Some(table) = system.design.table() {
        table.write(&row.response, &mut loadings);
    }
    loadings.extend(row.chords);
    loadings
}

/// Probability that a guide's table is off.
fn probability_off(analysis: &Analysis) -> f64 {
    analysis.models.iter().map(|(scored, p)| p * scored.table_share).sum()
}

/// Whether a guide's table is more probably off than right.
pub(crate) fn is_table_off(analysis: &Analysis) -> bool {
    probability_off(analysis) > MORE_PROBABLE_THAN_NOT
}

/// Columns of effects that no table can hold.
fn beyond(library: &Library, class: &[EffectId], columns: &[usize]) -> Vec<usize> {
    let id = |column: &usize| library.effects[library.columns[*column].effect].id;
    columns.iter().copied().filter(|column| !class.contains(&id(column))).collect()
}

/// Columns of named effects, then of the nuisance, with their prior standard deviations.
fn columns(
    system: &WhitenedSystem<'_>,
    library: &Library,
    named: &[usize],
) -> (Vec<usize>, Vec<f64>) {
    let wide =
        |column: &usize| FLEXIBLE_EFFECT * library.effects[library.columns[*column].effect].typical;
    let nuisance = system.design.nuisance.clone().map(|column| (column, 1.0));
    named.iter().map(|column| (*column, wide(column))).chain(nuisance).unzip()
}

/// Root mean square of the table's error over what was flown, with its interval by linear propagation.
fn magnitude(system: &WhitenedSystem<'_>, library: &Library, named: &[usize]) -> Option<Magnitude> {
    let gram = system.gram(None);
    let fitted = FittedTable::of_columns(system, library, gram, named)?;
    let segments = &system.data.segments;
    let count = segments.len() as f64;
    let mut square = 0.0;
    let mut slope = vec![0.0; fitted.coefficients.len()];
    for row in segments {
        let error = fitted.drag_at(system, row);
        square += error * error / count;
        for (slope, loading) in slope.iter_mut().zip(loadings(system, row)) {
            *slope += error * loading / count;
        }
    }
    let rms = square.sqrt();
    // d rms/d coefficient = Σ error·loading/(n·rms); its variance by the posterior covariance of all that was fitted.
    let (all, deviations) = columns(system, library, named);
    let slope_along = |column: &usize| {
        let at = columns_of_table(system).position(|of_table| of_table == *column);
        at.map_or(0.0, |k| slope[k] / rms)
    };
    let right: Vec<f64> = all.iter().map(slope_along).collect();
    let variance = gram.variance(&all, &deviations, &right)?;
    let half = NORMAL_95 * variance.sqrt();
    let [value, low, high] = [rms, (rms - half).max(0.0), rms + half].map(|share| 100.0 * share);
    Some(Magnitude { value, ci95: [low, high] })
}

/// The effect itself, then what the table can hold as well.
fn class(analysis: &Analysis, library: &Library) -> Vec<EffectId> {
    let held = library.effects.iter().zip(&analysis.scorer.held);
    let ids = held.filter(|(_, held)| **held).map(|(effect, _)| effect.id);
    core::iter::once(EffectId::DragTable).chain(ids).collect()
}
