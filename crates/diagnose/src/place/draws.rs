//! What noise alone would make of the residuals: draws of everything that is uncertain.
//!
//! Sensors within a segment, what a flight has in common, and what the model does not know for sure (remainder, split
//! between engines, standing effects, chords and nodes of the table), which is the same for all flights.

use faer::Mat;
use lut::Outside;

use crate::math::cholesky::Cholesky;
use crate::math::random::RandomStream;
use crate::residuals::rows::SegmentRow;
use crate::search::system::WhitenedSystem;

/// How noisy the flights are beyond what the sensors announce.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NoiseLevel {
    /// Factor on the noise's standard deviations.
    pub(crate) factor: f64,
    /// Scatter of fuel flow from flight to flight beyond that, relative.
    pub(crate) scatter: f64,
}

/// Rows of numbers, one per draw.
#[derive(Clone, Debug, Default)]
struct Rows {
    width: usize,
    numbers: Vec<f64>,
}

impl Rows {
    fn normal(source: &mut RandomStream, rows: usize, width: usize) -> Self {
        let mut numbers = vec![0.0; rows * width];
        source.fill(&mut numbers);
        Self { width, numbers }
    }

    fn row(&self, index: usize) -> &[f64] {
        &self.numbers[index * self.width..(index + 1) * self.width]
    }

    fn row_mut(&mut self, index: usize) -> &mut [f64] {
        &mut self.numbers[index * self.width..(index + 1) * self.width]
    }
}

fn add(into: &mut [f64], from: &[f64], by: f64) {
    for (slot, value) in into.iter_mut().zip(from) {
        *slot += by * value;
    }
}

/// What all flights have in common in each draw.
struct ModelErrorDraws {
    taught: Option<Rows>,
    smooth: Option<Rows>,
    chords: Rows,
    nodes: Option<Rows>,
}

impl ModelErrorDraws {
    fn draw(system: &WhitenedSystem<'_>, source: &mut RandomStream, width: usize) -> Self {
        let design = system.design;
        let taught = design.baseline().map(|baseline| {
            let factor = baseline.factor();
            let unit = Rows::normal(source, factor.ncols(), width);
            let mut rows = Rows { width, numbers: vec![0.0; factor.nrows() * width] };
            for k in 0..factor.nrows() {
                for j in 0..factor.ncols() {
                    add(rows.row_mut(k), unit.row(j), factor[(k, j)]);
                }
            }
            rows
        });
        let smooth_amplitude = system.clean_smooth_amplitude();
        let smooth = (smooth_amplitude > 0.0).then(|| {
            let mut rows = Rows::normal(source, design.smooth_terms(), width);
            for number in &mut rows.numbers {
                *number *= design.smooth_deviation(smooth_amplitude);
            }
            rows
        });
        let chords = Rows::normal(source, 2, width);
        // A guide's errors are the gap whose place is asked for.
        let learnt = design.table().filter(|_| !system.is_book());
        let nodes = learnt.map(|table| {
            let unit = Rows::normal(source, table.rank(), width);
            let nodes = table.grid().nodes();
            let mut rows = Rows { width, numbers: vec![0.0; nodes * width] };
            for node in 0..nodes {
                for (k, &value) in table.row(node).iter().enumerate() {
                    if value != 0.0 {
                        add(rows.row_mut(node), unit.row(k), value);
                    }
                }
            }
            rows
        });
        Self { taught, smooth, chords, nodes }
    }

    /// Adds what the model does not know, at a segment, to fuel flow and contrasts.
    fn add_at(
        &self,
        system: &WhitenedSystem<'_>,
        row: &SegmentRow,
        chords: [f64; 2],
        terms: &mut Vec<f64>,
        into: &mut [Vec<f64>],
    ) {
        let design = system.design;
        if let (Some(taught), Some(baseline)) = (&self.taught, design.baseline()) {
            let layout = baseline.layout();
            terms.resize(layout.remainder.len(), 0.0);
            baseline.write_remainder(&row.response, terms);
            let remainder = layout.remainder.zip(&*terms);
            for (column, &term) in remainder.filter(|(_, term)| **term != 0.0) {
                add(&mut into[0], taught.row(column), term);
            }
            let contrasts = layout.contrasts.zip(into.iter_mut().enumerate().skip(1));
            for (column, (contrast, values)) in contrasts {
                if row.is_recorded[contrast] {
                    add(values, taught.row(column), 1.0);
                }
            }
            terms.resize(layout.drag.len(), 0.0);
            baseline.write_drag(&row.response, terms);
            for (column, &loading) in layout.drag.zip(&*terms) {
                add(&mut into[0], taught.row(column), loading * row.drag_over_thrust);
            }
            for (column, slope) in layout.standing_effects.zip(&row.standing_effects) {
                for (channel, values) in into.iter_mut().enumerate() {
                    if slope[channel] != 0.0 {
                        add(values, taught.row(column), slope[channel]);
                    }
                }
            }
        }
        if let Some(smooth) = &self.smooth {
            terms.resize(design.smooth_terms(), 0.0);
            design.write_smooth(row, terms);
            for (k, &term) in terms.iter().enumerate().filter(|(_, term)| **term != 0.0) {
                add(&mut into[0], smooth.row(k), term);
            }
        }
        for (k, chord) in chords.into_iter().enumerate() {
            add(&mut into[0], self.chords.row(k), chord);
        }
        if let (Some(nodes), Some(table)) = (&self.nodes, design.table()) {
            let response = &row.response;
            let cell = table.grid().locate(response.lift_coefficient, response.mach, Outside::Hold);
            if let Ok(cell) = cell {
                for (node, weight) in cell.nodes().into_iter().zip(cell.weights()) {
                    add(&mut into[0], nodes.row(node), weight * row.drag_over_thrust);
                }
            }
        }
    }
}

/// How far chords of the drag table may be off in fuel flow, relative, along lift coefficient and Mach number, at every
/// segment. A learnt remainder has seen the same chords: only the part that its functions cannot follow counts
/// (least squares).
pub(crate) fn chords(system: &WhitenedSystem<'_>) -> Vec<[f64; 2]> {
    let segments = &system.data.segments;
    let mut chords: Vec<[f64; 2]> =
        segments.iter().map(|row| row.chords.map(|chord| chord * row.drag_over_thrust)).collect();
    let Some(baseline) = system.design.baseline() else { return chords };
    let count = baseline.remainder_terms();
    let mut terms = vec![0.0; count];
    let mut normal = Mat::<f64>::zeros(count, count);
    let mut right = Mat::<f64>::zeros(count, 2);
    for (row, chord) in segments.iter().zip(&chords) {
        baseline.write_remainder(&row.response, &mut terms);
        for i in 0..count {
            for (k, value) in chord.iter().enumerate() {
                right[(i, k)] += terms[i] * value;
            }
            for j in 0..=i {
                normal[(i, j)] += terms[i] * terms[j];
            }
        }
    }
    // Hats sum to nothing, and some terms are zero within the range flown: a ridge of a millionth holds them.
    for i in 0..count {
        normal[(i, i)] += 1e-6 * segments.len() as f64;
    }
    let Some(factor) = Cholesky::new(&normal) else { return chords };
    factor.solve(&mut right);
    for (row, chord) in segments.iter().zip(&mut chords) {
        baseline.write_remainder(&row.response, &mut terms);
        for (k, value) in chord.iter_mut().enumerate() {
            *value -= (0..count).map(|i| terms[i] * right[(i, k)]).sum::<f64>();
        }
    }
    chords
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawing<'a> {
    pub(crate) level: NoiseLevel,
    /// Errors of the table's chords at every segment.
    pub(crate) chords: &'a [[f64; 2]],
    /// Number of draws.
    pub(crate) width: usize,
}

/// Draws `width` times the residuals of every segment, channel by channel, and hands them over segment by segment.
///
/// ```text
/// e = k·(L z_segment + Σ_r u_r z_flight,r) + s·z_flight + N z,   every z of N(0, 1)                [diagnosis.24]
/// ```
///
/// k and s: [`NoiseLevel`]; L and u: \[diagnosis.14\]; N: the columns of what the model does not know.
pub(crate) fn draw(
    system: &WhitenedSystem<'_>,
    drawing: &Drawing<'_>,
    source: &mut RandomStream,
    mut each: impl FnMut(usize, &[Vec<f64>]),
) {
    let Drawing { level, chords, width } = *drawing;
    let data = system.data;
    let channels = 1 + data.channels.contrasts;
    let model = ModelErrorDraws::draw(system, source, width);
    let mut values = vec![vec![0.0; width]; channels];
    let mut own = vec![vec![0.0; width]; channels];
    let mut terms = Vec::new();
    for flight in &data.flights {
        let rank = data.segments[flight.segments.start].noise.common.len();
        let common = Rows::normal(source, rank + 1, width);
        for index in flight.segments.clone() {
            let row = &data.segments[index];
            for channel in 0..channels {
                source.fill(&mut own[channel]);
                values[channel].fill(0.0);
                if !row.is_recorded[channel] {
                    continue;
                }
                let (before, _) = own.split_at(channel + 1);
                for (k, unit) in before.iter().enumerate() {
                    let by = level.factor * row.noise.factor[channel][k];
                    if by != 0.0 {
                        add(&mut values[channel], unit, by);
                    }
                }
                for (k, loading) in row.noise.common.iter().enumerate() {
                    if loading[channel] != 0.0 {
                        add(&mut values[channel], common.row(k), level.factor * loading[channel]);
                    }
                }
            }
            add(&mut values[0], common.row(rank), level.scatter);
            model.add_at(system, row, chords[index], &mut terms, &mut values);
            each(index, &values);
        }
    }
}
