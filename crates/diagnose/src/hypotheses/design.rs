//! The whitened linear model of a flight: which columns there are, and their rows.

mod beyond;
mod blocks;
mod rows_of_segment;
mod smooth_background;

use core::ops::Range;

use effects::{EffectReferences, Variable};
use faer::Mat;
use units::convert::{DAYS_PER_YEAR, SECONDS_PER_DAY};

use crate::baseline::Baseline;
use crate::baseline::layout::{NuisanceLayout, Uncertain};
use crate::hypotheses::design::beyond::Beyond;
use crate::hypotheses::design::blocks::agnostic_blocks;
use crate::hypotheses::design::rows_of_segment::RowsOfSegment;
use crate::hypotheses::design::smooth_background::SmoothBackground;
use crate::priors::{
    BLEED_DEVIATION, DECK_DEVIATION, ENGINES_APART_PERCENT_PER_YEAR, FLEET_N2_LEVEL,
    GAUGE_GAIN_DEVIATION,
};
use crate::residuals::rows::{FlightRows, SegmentRow};
use crate::residuals::segments::PreparedFlights;
use crate::residuals::whiten::FlightWhitening;
use crate::signals::channels::MAXIMUM_CHANNELS;
use crate::signals::table_uncertainty::TableUncertainty;
use crate::thresholds::MEASURED_BURN_PERCENT;

pub(crate) use blocks::{AGNOSTIC_VARIABLES, Acts, Block};

/// Which column is what: effects, nuisance, smooth background, smooth terms, residual last.
#[derive(Clone, Debug)]
pub(crate) struct Design<'a> {
    pub(crate) effects: usize,
    pub(crate) nuisance: Range<usize>,
    pub(crate) smooth: Range<usize>,
    pub(crate) blocks: Vec<Block>,
    pub(crate) columns: usize,
    references: EffectReferences,
    background: SmoothBackground,
    nuisance_parts: Nuisance<'a>,
}

/// What is uncertain about the model, as columns of unit prior variance.
#[derive(Clone, Debug)]
struct Nuisance<'a> {
    layout: NuisanceLayout,
    baseline: Option<&'a Baseline>,
    /// Share of the recorded accelerations' mean square that their error has.
    acceleration: f64,
    table: Option<&'a TableUncertainty>,
    beyond: Beyond,
}

impl<'a> Design<'a> {
    pub(crate) fn new(
        data: &PreparedFlights<'_>,
        references: &EffectReferences,
        baseline: Option<&'a Baseline>,
        table: Option<&'a TableUncertainty>,
    ) -> Self {
        let values = |variable: Variable| -> Option<Vec<f64>> {
            data.segments
                .iter()
                .map(|row| variable.value(&row.point, &row.response, references))
                .collect()
        };
        let effects = data.columns();
        let acceleration = share_of_error(data);
        let is_bled = |row: &SegmentRow| row.point.anti_ice.is_some_and(|share| share > 0.0);
        let beyond = Beyond::of(baseline, &data.segments);
        let is_of_another =
            baseline.is_some_and(|baseline| baseline.of_another || data.of_other_aircraft);
        let uncertain = Uncertain {
            beyond: beyond.len(),
            drift: if data.engines_change { data.channels.contrasts } else { 0 },
            n2_level: usize::from(data.channels.n2 && is_of_another),
            deck: data.channels.n2,
            bleed: data.channels.n2 && data.segments.iter().any(is_bled),
            gauges: data.flights.iter().any(|flight| flight.gauge.is_some()),
            table_rank: table.map_or(0, TableUncertainty::rank),
        };
        let layout = baseline.map(Baseline::layout);
        let layout = NuisanceLayout::of_design(layout.as_ref(), uncertain);
        let nuisance = effects..effects + layout.len();
        let parts = Nuisance { layout, baseline, acceleration, table, beyond };

        let kinds = if data.channels.n2 { 2 } else { 1 };
        let background = SmoothBackground::new(data, references, values, kinds);
        let smooth = nuisance.end..nuisance.end + kinds * background.terms();
        let (blocks, at) = agnostic_blocks(data, values, smooth.end);
        Self {
            effects,
            nuisance,
            smooth,
            blocks,
            columns: at + 1,
            references: *references,
            background,
            nuisance_parts: parts,
        }
    }

    pub(crate) const fn residual(&self) -> usize {
        self.columns - 1
    }

    /// The same without the functions of one variable that stand for what is outside the library.
    pub(crate) fn without_blocks(&self) -> Self {
        Self { blocks: vec![], columns: self.smooth.end + 1, ..self.clone() }
    }

    /// The same nuisance with fewer columns of effects, without smooth background and smooth terms.
    pub(crate) fn of_nuisance(&self, effects: usize) -> Self {
        let nuisance = effects..effects + self.nuisance.len();
        Self {
            effects,
            smooth: nuisance.end..nuisance.end,
            blocks: vec![],
            columns: nuisance.end + 1,
            background: self.background.without_functions(),
            nuisance,
            references: self.references,
            nuisance_parts: self.nuisance_parts.clone(),
        }
    }

    /// All columns of a flight's fuel flow as they are, not whitened: one row per segment.
    pub(crate) fn fuel_flow(&self, data: &PreparedFlights<'_>, flight: &FlightRows) -> Mat<f64> {
        self.plain_rows(data, flight, |rows, scratch| self.write_columns(rows, scratch))
    }

    /// The same, the columns of the nuisance alone; the others are zero.
    pub(crate) fn nuisance_of_fuel_flow(
        &self,
        data: &PreparedFlights<'_>,
        flight: &FlightRows,
    ) -> Mat<f64> {
        self.plain_rows(data, flight, |rows, scratch| self.write_nuisance(rows, scratch))
    }

    fn plain_rows(
        &self,
        data: &PreparedFlights<'_>,
        flight: &FlightRows,
        write: impl Fn(&mut RowsOfSegment<'_>, &mut [f64]),
    ) -> Mat<f64> {
        let channels = data.channels.count();
        let mut matrix = Mat::<f64>::zeros(channels, self.columns);
        let mut rows = Mat::<f64>::zeros(flight.segments.len(), self.columns);
        let mut scratch = vec![0.0; self.columns];
        for (index, row) in data.segments[flight.segments.clone()].iter().enumerate() {
            let mut plain = row.clone();
            plain.noise.factor = [[0.0; MAXIMUM_CHANNELS]; MAXIMUM_CHANNELS];
            for channel in 0..MAXIMUM_CHANNELS {
                plain.noise.factor[channel][channel] = 1.0;
            }
            write(&mut RowsOfSegment::new(data, &plain, 0, &mut matrix), &mut scratch);
            for column in 0..self.columns {
                rows[(index, column)] = matrix[(0, column)];
            }
        }
        self.scale_nuisance(&mut rows);
        rows
    }

    /// Whitened rows of a flight, all columns.
    pub(crate) fn whitened(&self, data: &PreparedFlights<'_>, flight: &FlightRows) -> Mat<f64> {
        let mut matrix = self.within_segments(data, flight);
        FlightWhitening::new(data, flight).whiten(data, flight, &mut matrix);
        matrix
    }

    /// The same, each segment whitened by its own noise alone.
    pub(crate) fn within_segments(
        &self,
        data: &PreparedFlights<'_>,
        flight: &FlightRows,
    ) -> Mat<f64> {
        let channels = data.channels.count();
        let segments = &data.segments[flight.segments.clone()];
        let rows = segments.len() * channels + usize::from(flight.gauge.is_some());
        let mut matrix = Mat::<f64>::zeros(rows, self.columns);
        let mut scratch = vec![0.0; self.columns];
        for (index, row) in segments.iter().enumerate() {
            let mut rows = RowsOfSegment::new(data, row, index * channels, &mut matrix);
            self.write_columns(&mut rows, &mut scratch);
        }
        if let Some(gauge) = &flight.gauge {
            for (column, signature) in gauge.signatures.iter().enumerate() {
                matrix[(rows - 1, column)] = signature / gauge.deviation;
            }
            for column in self.nuisance_columns(&self.nuisance_parts.layout.gauges) {
                matrix[(rows - 1, column)] = self.gauge_gain_deviation() / gauge.deviation;
            }
            matrix[(rows - 1, self.columns - 1)] = gauge.residual / gauge.deviation;
        }
        self.scale_nuisance(&mut matrix);
        matrix
    }

    /// What is uncertain of the gain of gauges against meters: all of it, but where the flights that taught have shown it.
    fn gauge_gain_deviation(&self) -> f64 {
        let learnt = self.nuisance_parts.baseline.and_then(Baseline::gauges);
        let known = learnt.map_or(GAUGE_GAIN_DEVIATION, |level| level.deviation);
        known.hypot(0.01 * MEASURED_BURN_PERCENT)
    }

    fn write_columns(&self, rows: &mut RowsOfSegment<'_>, scratch: &mut [f64]) {
        let row = rows.row;
        for (column, signature) in row.signatures.iter().enumerate() {
            rows.put(column, signature);
        }
        self.write_nuisance(rows, scratch);
        rows.put(self.columns - 1, &row.residual);
        self.write_smooth_columns(rows, scratch);
    }

    /// Columns of what is uncertain about the model.
    fn write_nuisance(&self, rows: &mut RowsOfSegment<'_>, scratch: &mut [f64]) {
        let (row, channels) = (rows.row, rows.channels);
        let parts = &self.nuisance_parts;
        let columns = |range: &Range<usize>| self.nuisance_columns(range);
        let layout = &parts.layout;
        if let Some(baseline) = parts.baseline {
            let terms = &mut scratch[..layout.remainder.len()];
            baseline.write_remainder(&row.response, terms);
            let unit = rows.of_remainder(baseline.thrust_share());
            for (column, value) in columns(&layout.remainder).zip(&*terms) {
                rows.put_white(column, &unit, *value);
            }
        }
        if let Some(baseline) = parts.baseline.filter(|_| !layout.beyond.is_empty()) {
            let terms = &mut scratch[..layout.beyond.len()];
            parts.beyond.write(baseline, row, terms);
            let unit = rows.of_remainder(baseline.thrust_share());
            for (column, value) in columns(&layout.beyond).zip(&*terms) {
                rows.put_white(column, &unit, *value);
            }
        }
        for (column, contrast) in columns(&layout.contrasts).zip(1..) {
            let mut values = [0.0; MAXIMUM_CHANNELS];
            if contrast <= channels.contrasts && row.is_recorded[contrast] {
                values[contrast] = 1.0;
            }
            rows.put(column, &values);
        }
        let years = (row.point.date_s - self.references.date_s) / (DAYS_PER_YEAR * SECONDS_PER_DAY);
        for (column, contrast) in columns(&layout.drift).zip(1..) {
            let mut values = [0.0; MAXIMUM_CHANNELS];
            if row.is_recorded[contrast] {
                values[contrast] = ENGINES_APART_PERCENT_PER_YEAR / 100.0 * years;
            }
            rows.put(column, &values);
        }
        let terms = columns(&layout.deck).zip(row.deck);
        let level = columns(&layout.n2_level).map(|column| (column, FLEET_N2_LEVEL));
        for (column, term) in terms.chain(level) {
            let mut values = [0.0; MAXIMUM_CHANNELS];
            if channels.n2 && row.is_recorded[channels.n2_row()] {
                values[channels.n2_row()] = term;
            }
            rows.put(column, &values);
        }
        for (column, slope) in columns(&layout.standing_effects).zip(&row.standing_effects) {
            rows.put(column, slope);
        }
        if let Some(baseline) = parts.baseline {
            let loadings = &mut scratch[..layout.drag.len()];
            baseline.write_drag(&row.response, loadings);
            for (column, loading) in columns(&layout.drag).zip(&*loadings) {
                rows.put_thrust(column, *loading);
            }
        }
        for (column, chord) in columns(&layout.chords).zip(row.chords) {
            rows.put_thrust(column, chord);
        }
        for column in columns(&layout.acceleration) {
            rows.put(column, &row.noise.acceleration.map(|value| value * parts.acceleration));
        }
        for column in columns(&layout.bleed) {
            let mut values = [0.0; MAXIMUM_CHANNELS];
            if row.is_recorded[channels.n2_row()] {
                values[channels.n2_row()] = BLEED_DEVIATION * row.point.anti_ice.unwrap_or(0.0);
            }
            rows.put(column, &values);
        }
        if let Some(table) = parts.table {
            let loadings = &mut scratch[..layout.table.len()];
            table.write(&row.response, loadings);
            for (column, loading) in columns(&layout.table).zip(&*loadings) {
                rows.put_thrust(column, *loading);
            }
        }
    }

    /// Columns of the smooth background and of functions of one variable.
    fn write_smooth_columns(&self, rows: &mut RowsOfSegment<'_>, scratch: &mut [f64]) {
        let (row, channels) = (rows.row, rows.channels);
        let once = self.smooth.len() / if channels.n2 { 2 } else { 1 };
        if once > 0 {
            self.write_smooth(row, &mut scratch[..once]);
        }
        for (k, value) in scratch[..once].iter().enumerate() {
            rows.put_fuel_flow(self.smooth.start + k, *value);
            if channels.n2 {
                rows.put_thrust(self.smooth.start + once + k, *value);
            }
        }
        for block in &self.blocks {
            block.write(rows, &self.references, scratch);
        }
    }

    /// Columns of the design that a range of the nuisance has.
    fn nuisance_columns(&self, range: &Range<usize>) -> Range<usize> {
        self.nuisance.start + range.start..self.nuisance.start + range.end
    }

    /// Columns of the N2 deck's coefficients; empty where there is none.
    pub(crate) fn deck_columns(&self) -> Range<usize> {
        self.nuisance_columns(&self.nuisance_parts.layout.deck)
    }

    /// Columns of what the drag table does not know; empty where that is not given.
    pub(crate) fn table_columns(&self) -> Range<usize> {
        self.nuisance_columns(&self.nuisance_parts.layout.table)
    }

    /// Columns of how far the drag table's chords are off.
    pub(crate) fn chord_columns(&self) -> Range<usize> {
        self.nuisance_columns(&self.nuisance_parts.layout.chords)
    }

    /// The baseline, where there is one.
    pub(crate) const fn baseline(&self) -> Option<&Baseline> {
        self.nuisance_parts.baseline
    }

    /// What the table does not know, where that is given.
    pub(crate) const fn table(&self) -> Option<&TableUncertainty> {
        self.nuisance_parts.table
    }

    pub(crate) const fn references(&self) -> &EffectReferences {
        &self.references
    }

    /// Terms of the smooth background, of one kind.
    pub(crate) fn smooth_terms(&self) -> usize {
        self.background.terms()
    }

    /// Prior standard deviation of each smooth term that makes their sum this large, root mean square over the segments.
    pub(crate) fn smooth_deviation(&self, amplitude: f64) -> f64 {
        self.background.deviation(amplitude)
    }

    pub(crate) fn write_smooth(&self, row: &SegmentRow, into: &mut [f64]) {
        self.background.write(row, &self.references, into);
    }

    /// Turns the raw nuisance columns into columns of unit prior variance.
    fn scale_nuisance(&self, matrix: &mut Mat<f64>) {
        let parts = &self.nuisance_parts;
        if let Some(baseline) = parts.baseline {
            let factor = baseline.factor();
            let range = self.nuisance_columns(&parts.layout.of_baseline_range());
            let width = range.len();
            let raw = matrix.subcols(range.start, width).to_owned();
            let mut scaled = Mat::<f64>::zeros(raw.nrows(), width);
            faer::linalg::matmul::matmul(
                scaled.as_mut(),
                faer::Accum::Replace,
                raw.as_ref(),
                factor.as_ref(),
                1.0,
                faer::Par::Seq,
            );
            for column in 0..width {
                for row in 0..raw.nrows() {
                    matrix[(row, range.start + column)] = scaled[(row, column)];
                }
            }
        } else {
            for column in self.deck_columns() {
                for row in 0..matrix.nrows() {
                    matrix[(row, column)] *= DECK_DEVIATION;
                }
            }
        }
    }
}

/// Share of the recorded accelerations' mean square that their error has, at most 1.
///
/// A recorded acceleration errs in the prediction and in every signature that leans on thrust at once, so that residuals
/// seem to follow it:
///
/// ```text
/// E[residual | V̇] = −κ·V̇·∂channel/∂V̇,  κ = Σσ²/ΣV̇²                              [diagnosis.46]
/// ```
///
/// The sum of a drag factor and the opposite TSFC factor is that signature. The coefficient is nuisance, N(0, κ²).
fn share_of_error(data: &PreparedFlights<'_>) -> f64 {
    let (mut error, mut square) = (0.0, 0.0);
    for row in &data.segments {
        error += row.acceleration_deviation_m_s2.powi(2);
        square += row.point.acceleration_m_s2.powi(2);
    }
    if square > error { error / square } else { 1.0 }
}
