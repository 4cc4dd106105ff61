//! One pass over the data: Gram matrices of all flights and of folds of them, nuisance integrated out.

use std::borrow::Cow;

use faer::Mat;

use effects::EffectModel;

use crate::hypotheses::backgrounds::{Background, Level, Smoothed, TableBelief, without_nuisance};
use crate::hypotheses::design::Design;
use crate::library::Library;
use crate::math::eliminate::{Changed, Elimination, Reduced};
use crate::math::gram::{Gram, Sum};
use crate::math::linear::{gather, subtract_gram, symmetrize};
use crate::priors::{
    BOOK_AMPLITUDES, BOOK_SCATTERS, PRIOR_BOOK_RIGHT, TAUGHT_LARGEST_AMPLITUDE, TAUGHT_SCATTERS,
};
use crate::residuals::segments::PreparedFlights;
use crate::residuals::whiten::FlightWhitening;
use crate::search::folds::{Folds, fold_of};
use crate::signals::table_uncertainty::{TableOrigin, TableUncertainty};
use crate::thresholds::{CLOSURE_FOLDS, TAUGHT_CLEAN_AMPLITUDE, TAUGHT_CLEAN_SPIKE};

/// Whitened rows are kept in memory up to this many numbers (64 MB); beyond they are made again.
const KEPT_NUMBERS: usize = 8_000_000;

/// ln of a prior probability that no evidence outweighs: squares of residuals over their variances stay far below it. An
/// infinity would make differences of it undefined.
const LN_PRIOR_OF_NEVER: f64 = -1e12;

/// The whitened linear system of all flights: data, columns, Gram matrices.
pub(crate) struct WhitenedSystem<'a> {
    pub(crate) data: &'a PreparedFlights<'a>,
    pub(crate) design: &'a Design<'a>,
    gram: Gram,
    folds: Folds,
    whitenings: Vec<FlightWhitening>,
    kept: Option<Vec<Mat<f64>>>,
    /// What is assumed of all flights at once, integrated over.
    pub(crate) levels: Vec<Level>,
    /// Of each flight: products of all columns with its own fuel-flow level, for flight-to-flight scatter.
    flight_levels: Vec<Vec<f64>>,
}

/// What every step of the search works on: the linear system, the model behind it, the effects that are looked for.
#[derive(Clone, Copy)]
pub(crate) struct Problem<'a> {
    pub(crate) system: &'a WhitenedSystem<'a>,
    pub(crate) model: &'a EffectModel<'a>,
    pub(crate) library: &'a Library,
}

/// Whether the smooth terms outside the library take part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SmoothTerms {
    Kept,
    LeftOut,
}

/// Rows of all flights whose segments are whitened and nothing else, where they fit in memory: made once for outliers and system.
#[derive(Debug)]
pub(crate) struct RowsWithinSegments(Option<Vec<Mat<f64>>>);

impl RowsWithinSegments {
    /// Those of all flights.
    pub(crate) fn new(data: &PreparedFlights<'_>, design: &Design<'_>) -> Self {
        let of = |flight| design.within_segments(data, flight);
        let kept = fit_in_memory(data, design.columns);
        Self(kept.then(|| data.flights.iter().map(of).collect()))
    }

    /// Those of a flight, made again where they are not kept.
    pub(crate) fn of_flight(
        &self,
        data: &PreparedFlights<'_>,
        design: &Design<'_>,
        flight: usize,
    ) -> Cow<'_, Mat<f64>> {
        match &self.0 {
            Some(kept) => Cow::Borrowed(&kept[flight]),
            None => Cow::Owned(design.within_segments(data, &data.flights[flight])),
        }
    }
}

impl<'a> WhitenedSystem<'a> {
    pub(crate) fn new(data: &'a PreparedFlights<'a>, design: &'a Design<'a>) -> Self {
        Self::of_rows(data, design, RowsWithinSegments::new(data, design))
    }

    /// Of rows that were made from the same flights and design.
    pub(crate) fn of_rows(
        data: &'a PreparedFlights<'a>,
        design: &'a Design<'a>,
        rows: RowsWithinSegments,
    ) -> Self {
        let of_flight = |flight| FlightWhitening::new(data, flight);
        let mut system = Self {
            data,
            design,
            gram: Gram { matrix: Mat::zeros(0, 0), rows: 0.0 },
            folds: Folds::default(),
            whitenings: data.flights.iter().map(of_flight).collect(),
            kept: None,
            levels: levels(data, design),
            flight_levels: Vec::with_capacity(data.flights.len()),
        };
        system.kept = rows.0.map(|mut rows| {
            for (flight, rows) in rows.iter_mut().enumerate() {
                system.whiten(flight, rows);
            }
            rows
        });
        let mut sum = Sum::new(design.columns);
        for index in 0..data.flights.len() {
            let rows = system.whitened(index);
            sum.add(&rows, system.recorded_values(index));
            let products = rows.transpose() * rows.col(design.smooth.start);
            let level = products.iter().copied().collect();
            drop(rows);
            system.flight_levels.push(level);
        }
        system.gram = sum.finish();
        system
    }

    /// The Gram of all flights but those of one fold; of all where none is left out.
    pub(crate) fn gram(&self, without: Option<usize>) -> &Gram {
        let Some(fold) = without else { return &self.gram };
        self.folds.without(fold, || {
            let of = |fold: usize| {
                let mut sum = Sum::new(self.design.columns);
                for index in (fold..self.data.flights.len()).step_by(CLOSURE_FOLDS) {
                    sum.add(&self.whitened(index), self.recorded_values(index));
                }
                sum.finish()
            };
            (0..CLOSURE_FOLDS).map(of).collect()
        })
    }

    /// Smooth discrepancy in which neither a smooth term nor a region is reported: a learnt remainder is not exact, a table is
    /// taken at its word (its uncertainty is given apart).
    pub(crate) const fn clean_smooth_amplitude(&self) -> f64 {
        if self.data.predictor.baseline.is_some() { TAUGHT_CLEAN_AMPLITUDE } else { 0.0 }
    }

    /// Whether the table is a guide's that may be off or right.
    pub(crate) fn is_book(&self) -> bool {
        is_book(self.design)
    }

    /// No longer believes that a guide's table is right.
    pub(crate) fn rule_out_right_table(&mut self) {
        for level in &mut self.levels {
            if level.table == TableBelief::Right {
                level.ln_prior = LN_PRIOR_OF_NEVER;
            }
        }
    }

    /// Scatter between flights at a level, relative.
    pub(crate) fn scatter(&self, level: usize) -> f64 {
        self.levels.get(level).map_or(0.0, |level| level.scatter)
    }

    /// What a background believes of the table.
    pub(crate) fn belief(&self, at: &Background) -> TableBelief {
        self.levels.get(at.level).map_or(TableBelief::Uncertain, |level| level.table)
    }

    /// Whether a smooth discrepancy of this amplitude is among the backgrounds.
    pub(crate) fn admits(&self, smooth_amplitude: f64) -> bool {
        if self.is_book() {
            return BOOK_AMPLITUDES.contains(&smooth_amplitude);
        }
        self.data.predictor.baseline.is_none() || smooth_amplitude <= TAUGHT_LARGEST_AMPLITUDE
    }

    /// Whether a background without a named effect is no finding: nothing at all against a table, a guide's being right;
    /// against a taught
    /// remainder, small amounts of every other effect too. A smooth discrepancy is one: it has an amplitude for each of
    /// some thirty functions, and together they hide most of a per cent.
    pub(crate) fn is_nothing(&self, at: &Background) -> bool {
        let small_effects_scale =
            if self.data.predictor.baseline.is_some() { TAUGHT_CLEAN_SPIKE } else { 0.0 };
        at.smooth_amplitude == 0.0
            && at.small_effects_scale <= small_effects_scale
            && (!self.is_book() || self.belief(at) == TableBelief::Right)
    }

    /// Whitened rows of a flight.
    pub(crate) fn whitened(&self, flight: usize) -> Cow<'_, Mat<f64>> {
        match &self.kept {
            Some(kept) => Cow::Borrowed(&kept[flight]),
            None => Cow::Owned(self.made(flight)),
        }
    }

    fn made(&self, flight: usize) -> Mat<f64> {
        let mut rows = self.design.within_segments(self.data, &self.data.flights[flight]);
        self.whiten(flight, &mut rows);
        rows
    }

    /// Whitens rows of a flight, whose segments are already.
    pub(crate) fn whiten(&self, flight: usize, rows: &mut Mat<f64>) {
        self.whitenings[flight].whiten(self.data, &self.data.flights[flight], rows);
    }

    /// Values that were recorded in a flight.
    fn recorded_values(&self, flight: usize) -> f64 {
        self.data.recorded_values(&self.data.flights[flight])
    }

    /// Products of some columns with each flight's fuel-flow level, scaled to what `relative` more of scatter between flights
    /// takes off the Gram: one column a flight.
    ///
    /// ```text
    /// G' = G − Σ_f w_f z_f z_fᵀ,  w_f = θ²/(1 + θ² v_fᵀv_f),  ln det = Σ_f ln(1 + θ² v_fᵀv_f)     [diagnosis.20]
    /// ```
    pub(crate) fn scatter_of(
        &self,
        columns: &[usize],
        relative: f64,
        without: Option<usize>,
    ) -> (Scatter, f64) {
        let mut scaled = Mat::<f64>::zeros(columns.len(), self.flight_levels.len());
        let mut roots = vec![0.0; self.flight_levels.len()];
        let mut ln_determinant = 0.0;
        for (flight, level) in self.flight_levels.iter().enumerate() {
            if Some(fold_of(flight)) == without {
                continue;
            }
            let own = level[self.design.smooth.start];
            let grown = 1.0 + relative * relative * own;
            ln_determinant += grown.ln();
            roots[flight] = relative / grown.sqrt();
            for (value, &column) in scaled.col_as_slice_mut(flight).iter_mut().zip(columns) {
                *value = roots[flight] * level[column];
            }
        }
        (Scatter { scaled, roots }, ln_determinant)
    }

    /// Columns of a Gram without nuisance before it is taken out: all of the design, or all but the smooth terms; the
    /// residual is the last.
    fn columns_of(&self, smooth_terms: SmoothTerms) -> Vec<usize> {
        let end = match smooth_terms {
            SmoothTerms::Kept => self.design.residual(),
            SmoothTerms::LeftOut => self.design.smooth.end,
        };
        (0..end).chain([self.design.residual()]).collect()
    }

    /// The Gram without nuisance at a level.
    pub(crate) fn level(
        &self,
        gram: &Gram,
        at: Level,
        without: Option<usize>,
        smooth_terms: SmoothTerms,
    ) -> Option<(ScatterElimination, Reduced)> {
        let columns = self.columns_of(smooth_terms);
        if at.scatter == 0.0 && smooth_terms == SmoothTerms::Kept {
            let (elimination, reduced) = without_nuisance(&gram.matrix, self.design, at.table)?;
            return Some((ScatterElimination { scatter: None, elimination }, reduced));
        }
        let mut matrix = gather(&gram.matrix, &columns, &columns);
        if at.scatter == 0.0 {
            let (elimination, reduced) = without_nuisance(&matrix, self.design, at.table)?;
            return Some((ScatterElimination { scatter: None, elimination }, reduced));
        }
        let (scatter, ln_determinant) = self.scatter_of(&columns, at.scatter, without);
        subtract_gram(&mut matrix, &scatter.scaled);
        symmetrize(&mut matrix);
        let (elimination, mut reduced) = without_nuisance(&matrix, self.design, at.table)?;
        reduced.ln_determinant += ln_determinant;
        Some((ScatterElimination { scatter: Some(scatter), elimination }, reduced))
    }
}

/// Whether rows of all flights, with so many columns, are few enough to be kept.
pub(crate) fn fit_in_memory(data: &PreparedFlights<'_>, columns: usize) -> bool {
    let rows = data.segments.len() * data.channels.count() + data.flights.len();
    rows * columns <= KEPT_NUMBERS
}

fn is_book(design: &Design<'_>) -> bool {
    design.table().map(TableUncertainty::origin) == Some(TableOrigin::Book)
}

/// What is assumed of all flights at once: a guide's table is right or uncertain; what a baseline says of the scatter between
/// flights comes from few flights, so that it may be more.
fn levels(data: &PreparedFlights<'_>, design: &Design<'_>) -> Vec<Level> {
    let uncertain = TableBelief::Uncertain;
    if data.predictor.baseline.is_some() {
        let ln_prior = -(TAUGHT_SCATTERS.len() as f64).ln();
        let level = |scatter| Level { scatter, table: uncertain, ln_prior };
        return TAUGHT_SCATTERS.map(level).to_vec();
    }
    let level = |table, prior: f64| Level { scatter: 0.0, table, ln_prior: prior.ln() };
    if is_book(design) {
        // What is no function of lift coefficient and Mach number scatters between flights.
        let off = (1.0 - PRIOR_BOOK_RIGHT) / BOOK_SCATTERS.len() as f64;
        let uncertain = |scatter| Level { scatter, ..level(uncertain, off) };
        let right = level(TableBelief::Right, PRIOR_BOOK_RIGHT);
        return core::iter::once(right).chain(BOOK_SCATTERS.map(uncertain)).collect();
    }
    vec![level(uncertain, 1.0)]
}

/// What scatter between flights takes off a Gram: `[diagnosis.20]`.
pub(crate) struct Scatter {
    /// One column a flight.
    pub(crate) scaled: Mat<f64>,
    /// √w of each flight.
    roots: Vec<f64>,
}

/// How a Gram without nuisance was made, at one level of scatter between flights.
pub(crate) struct ScatterElimination {
    scatter: Option<Scatter>,
    elimination: Elimination,
}

impl ScatterElimination {
    /// What becomes of changed columns; `levels` are their products with each flight's fuel-flow level, one row a flight.
    pub(crate) fn follow(&self, mut changed: Changed, levels: &Mat<f64>) -> Changed {
        if let Some(Scatter { scaled, roots }) = &self.scatter {
            let fresh =
                Mat::from_fn(levels.nrows(), levels.ncols(), |i, j| roots[i] * levels[(i, j)]);
            changed.cross -= scaled * &fresh;
            changed.own -= fresh.transpose() * &fresh;
        }
        self.elimination.follow(&changed)
    }
}

/// Grams without nuisance at every level, and every smooth discrepancy over them: where columns that change follow.
pub(crate) struct EliminatedGrams {
    /// What each level believes of the table.
    pub(crate) beliefs: Vec<TableBelief>,
    pub(crate) levels: Vec<ScatterElimination>,
    pub(crate) reduced: Vec<Reduced>,
    pub(crate) smoothed: Vec<Smoothed>,
}
