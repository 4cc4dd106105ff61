//! The whitened linear model of a flight: which columns there are, and their rows.

use core::ops::Range;

use effects::{EffectReferences, Variable};
use faer::Mat;

use crate::baseline::Baseline;
use crate::baseline::layout::{DeckColumns, NuisanceLayout};
use crate::priors::{
    AGNOSTIC_QUANTILES, DECK_DEVIATION, PRODUCT_SCALE, SMOOTH_QUANTILES, SPLIT_SCALE,
};
use crate::residuals::rows::{FlightRows, SegmentRow};
use crate::residuals::segments::PreparedFlights;
use crate::residuals::whiten::{FlightWhitening, whiten_within_segment};
use crate::signals::channels::{ByChannel, Channels, MAXIMUM_CHANNELS};
use crate::signals::table_uncertainty::TableUncertainty;
use crate::signals::variables::{Hats, Scaled};

/// Variables of the smooth background. Our choice: what effects of the library depend on.
const SMOOTH_VARIABLES: [Variable; 15] = [
    Variable::Mach,
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::IsaDeviation,
    Variable::StaticAirTemperature,
    Variable::Date,
    Variable::FuelUsed,
    Variable::Roll,
    Variable::Acceleration,
    Variable::CrossWind,
    Variable::Latitude,
    Variable::EastwardSpeed,
    Variable::CenterOfGravity,
    Variable::Mass,
];
/// Products in the smooth background. Our choice: pairs that physics multiplies.
const SMOOTH_PRODUCTS: [(Variable, Variable); 10] = [
    (Variable::Mach, Variable::LiftCoefficient),
    (Variable::Mach, Variable::PressureAltitude),
    (Variable::LiftCoefficient, Variable::PressureAltitude),
    (Variable::Mach, Variable::IsaDeviation),
    (Variable::PressureAltitude, Variable::IsaDeviation),
    (Variable::CorrectedThrust, Variable::Mach),
    (Variable::CrossWind, Variable::Latitude),
    (Variable::EastwardSpeed, Variable::Latitude),
    (Variable::CenterOfGravity, Variable::LiftCoefficient),
    (Variable::Mach, Variable::Date),
];
/// Without acceleration: its own error is in the residual, which depends on it in every recording.
pub(crate) const AGNOSTIC_VARIABLES: [Variable; 19] = [
    Variable::Mach,
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::IsaDeviation,
    Variable::StaticAirTemperature,
    Variable::FuelUsed,
    Variable::Mass,
    Variable::Date,
    Variable::Roll,
    Variable::CrossWind,
    Variable::Latitude,
    Variable::EastwardSpeed,
    Variable::CenterOfGravity,
    Variable::LatitudeCrossWind,
    Variable::CenterOfGravityLift,
    Variable::MachLift,
    Variable::MachExcess,
    Variable::AntiIce,
];

/// How a smooth function acts: on fuel flow alone, or on thrust, so that N2 sees it too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Acts {
    FuelFlow,
    Thrust,
    Split,
}

/// A smooth term of one variable.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) variable: Variable,
    pub(crate) acts: Acts,
    pub(crate) columns: Range<usize>,
    hats: Option<Hats>,
}

/// Which column is what: effects, nuisance, smooth background, smooth terms, residual last.
#[derive(Clone, Debug)]
pub(crate) struct Design<'a> {
    pub(crate) effects: usize,
    pub(crate) nuisance: Range<usize>,
    pub(crate) smooth: Range<usize>,
    pub(crate) blocks: Vec<Block>,
    pub(crate) columns: usize,
    references: EffectReferences,
    smooth_hats: Vec<(Variable, Hats)>,
    smooth_products: Vec<(Variable, Scaled, Variable, Scaled)>,
    /// Root mean square of all smooth terms together, so that an amplitude is that of their sum.
    smooth_rms: f64,
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
        let rank = table.map_or(0, TableUncertainty::rank);
        let layout = if let Some(baseline) = baseline {
            NuisanceLayout::of_design_with_baseline(&baseline.layout(), rank)
        } else if data.channels.n2 {
            NuisanceLayout::of_design(DeckColumns::Present, rank)
        } else {
            NuisanceLayout::of_design(DeckColumns::Absent, rank)
        };
        let nuisance = effects..effects + layout.len();
        let parts = Nuisance { layout, baseline, acceleration, table };

        let smooth_hats: Vec<(Variable, Hats)> = SMOOTH_VARIABLES
            .into_iter()
            .filter_map(|v| Some((v, Hats::at_quantiles(&values(v)?, &SMOOTH_QUANTILES)?)))
            .collect();
        let smooth_products: Vec<_> = SMOOTH_PRODUCTS
            .into_iter()
            .filter_map(|(a, b)| {
                Some((a, Scaled::from_values(&values(a)?), b, Scaled::from_values(&values(b)?)))
            })
            .collect();
        let once = 1
            + smooth_hats.iter().map(|(_, hats)| hats.len()).sum::<usize>()
            + smooth_products.len();
        let kinds = if data.channels.n2 { 2 } else { 1 };
        let smooth = nuisance.end..nuisance.end + kinds * once;

        let (blocks, at) = agnostic_blocks(data, values, smooth.end);
        let mut design = Self {
            effects,
            nuisance,
            smooth,
            blocks,
            columns: at + 1,
            references: *references,
            smooth_hats,
            smooth_products,
            smooth_rms: 1.0,
            nuisance_parts: parts,
        };
        design.smooth_rms = design.rms_of_smooth(data, kinds);
        design
    }

    /// Root mean square over the segments of the sum of all smooth terms of unit amplitude, all kinds of them together.
    fn rms_of_smooth(&self, data: &PreparedFlights<'_>, kinds: usize) -> f64 {
        let mut terms = vec![0.0; self.smooth_terms()];
        let mut square = 0.0;
        for row in &data.segments {
            self.write_smooth(row, &mut terms);
            square += terms.iter().map(|term| term * term).sum::<f64>();
        }
        (kinds as f64 * square / data.segments.len().max(1) as f64).sqrt()
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
            smooth_hats: vec![],
            smooth_products: vec![],
            smooth_rms: self.smooth_rms,
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
            matrix[(rows - 1, self.columns - 1)] = gauge.residual / gauge.deviation;
        }
        self.scale_nuisance(&mut matrix);
        matrix
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
        for (column, contrast) in columns(&layout.contrasts).zip(1..) {
            let mut values = [0.0; MAXIMUM_CHANNELS];
            if contrast <= channels.contrasts && row.is_recorded[contrast] {
                values[contrast] = 1.0;
            }
            rows.put(column, &values);
        }
        for (column, term) in columns(&layout.deck).zip(row.deck) {
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
            if let Some(hats) = &block.hats {
                let value = block
                    .variable
                    .value(&row.point, &row.response, &self.references)
                    .unwrap_or(0.0);
                hats.write(value, &mut scratch[..hats.len()]);
                for (k, value) in scratch[..hats.len()].iter().enumerate() {
                    if block.acts == Acts::Thrust {
                        rows.put_thrust(block.columns.start + k, *value);
                    } else {
                        rows.put_fuel_flow(block.columns.start + k, *value);
                    }
                }
            } else {
                for (k, column) in block.columns.clone().enumerate() {
                    let mut values = [0.0; MAXIMUM_CHANNELS];
                    if row.is_recorded[1 + k] {
                        values[1 + k] = SPLIT_SCALE;
                    }
                    rows.put(column, &values);
                }
            }
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
        1 + self.smooth_hats.iter().map(|(_, hats)| hats.len()).sum::<usize>()
            + self.smooth_products.len()
    }

    /// Prior standard deviation of each smooth term that makes their sum this large, root mean square over the segments.
    pub(crate) fn smooth_deviation(&self, amplitude: f64) -> f64 {
        amplitude / self.smooth_rms
    }

    pub(crate) fn write_smooth(&self, row: &SegmentRow, into: &mut [f64]) {
        let value = |variable: Variable| {
            variable.value(&row.point, &row.response, &self.references).unwrap_or(0.0)
        };
        into[0] = 1.0;
        let mut at = 1;
        for (variable, hats) in &self.smooth_hats {
            hats.write(value(*variable), &mut into[at..at + hats.len()]);
            at += hats.len();
        }
        for (a, scaled_a, b, scaled_b) in &self.smooth_products {
            into[at] = PRODUCT_SCALE * scaled_a.at(value(*a)) * scaled_b.at(value(*b));
            at += 1;
        }
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

/// The rows of one segment in a matrix, one row per channel, whitened by the segment's own noise.
struct RowsOfSegment<'a> {
    row: &'a SegmentRow,
    channels: Channels,
    first: usize,
    matrix: &'a mut Mat<f64>,
    /// Whitened: a change of fuel flow alone, and of thrust, which N2 sees too.
    fuel_flow: ByChannel,
    thrust: ByChannel,
}

impl<'a> RowsOfSegment<'a> {
    fn new(
        data: &PreparedFlights<'_>,
        row: &'a SegmentRow,
        first: usize,
        matrix: &'a mut Mat<f64>,
    ) -> Self {
        let channels = data.channels;
        let mut on_fuel = [0.0; MAXIMUM_CHANNELS];
        on_fuel[0] = 1.0;
        let mut on_thrust = on_fuel;
        on_thrust[0] = row.drag_over_thrust;
        if channels.n2 && row.is_recorded[channels.n2_row()] {
            on_thrust[channels.n2_row()] = row.n2_slope * row.drag_over_thrust;
        }
        let fuel_flow = whiten_within_segment(row, &on_fuel, channels.count());
        let thrust = whiten_within_segment(row, &on_thrust, channels.count());
        Self { row, channels, first, matrix, fuel_flow, thrust }
    }

    /// Whitened: a change of fuel flow, of which N2 sees a share.
    fn of_remainder(&self, thrust_share: f64) -> ByChannel {
        let (row, channels) = (self.row, self.channels);
        if thrust_share == 0.0 {
            return self.fuel_flow;
        }
        let mut values = [0.0; MAXIMUM_CHANNELS];
        values[0] = 1.0;
        if channels.n2 && row.is_recorded[channels.n2_row()] {
            values[channels.n2_row()] = thrust_share * row.n2_slope;
        }
        whiten_within_segment(row, &values, channels.count())
    }

    fn put(&mut self, column: usize, values: &ByChannel) {
        let white = whiten_within_segment(self.row, values, self.channels.count());
        self.put_white(column, &white, 1.0);
    }

    fn put_fuel_flow(&mut self, column: usize, by: f64) {
        let unit = self.fuel_flow;
        self.put_white(column, &unit, by);
    }

    fn put_thrust(&mut self, column: usize, by: f64) {
        let unit = self.thrust;
        self.put_white(column, &unit, by);
    }

    fn put_white(&mut self, column: usize, white: &ByChannel, by: f64) {
        for (channel, value) in white.iter().enumerate().take(self.channels.count()) {
            self.matrix[(self.first + channel, column)] = value * by;
        }
    }
}

/// Functions of single variables outside the library, and the contrasts of the engines: their columns from `first` on, and the
/// first column after them.
fn agnostic_blocks(
    data: &PreparedFlights<'_>,
    values: impl Fn(Variable) -> Option<Vec<f64>>,
    first: usize,
) -> (Vec<Block>, usize) {
    let mut blocks = Vec::new();
    let mut at = first;
    for variable in AGNOSTIC_VARIABLES {
        let hats = values(variable).and_then(|values| match variable {
            // A switch has no values between off and on that a bend could be at.
            Variable::AntiIce => Hats::at_quantiles(&values, &[0.0, 1.0]),
            _ => Hats::at_quantiles(&values, &AGNOSTIC_QUANTILES),
        });
        let Some(hats) = hats else { continue };
        for acts in [Acts::FuelFlow, Acts::Thrust] {
            if acts == Acts::Thrust && !data.channels.n2 {
                continue;
            }
            let columns = at..at + hats.len();
            at = columns.end;
            blocks.push(Block { variable, acts, columns, hats: Some(hats.clone()) });
        }
    }
    if data.channels.contrasts > 0 {
        let columns = at..at + data.channels.contrasts;
        at = columns.end;
        blocks.push(Block { variable: Variable::Engine, acts: Acts::Split, columns, hats: None });
    }
    (blocks, at)
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
