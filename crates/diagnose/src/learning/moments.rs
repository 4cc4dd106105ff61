//! Sums over flights from which the Gram matrix of the whitened columns follows in closed form, whatever the noise
//! factors: segments are looked at once, however often noise is turned.
//!
//! A noise factor multiplies rows and columns of a segment's covariance C and of its loadings U, nothing else. With
//! K = C⁻¹ at factors of 1, kinds a, b of channels, factors w within flights and v between them,
//!
//! ```text
//! XᵀC⁻¹X = Σ_ab 1/(w_a w_b) Σ_segments K_ab x_a x_bᵀ
//! XᵀC⁻¹U = Σ_ab v_b/(w_a w_b) Σ_segments K_ab x_a u_bᵀ,   UᵀC⁻¹U alike
//! Xᵀ(C + UUᵀ)⁻¹X = XᵀC⁻¹X − XᵀC⁻¹U (1 + UᵀC⁻¹U)⁻¹ UᵀC⁻¹X                                    [diagnosis.40]
//! ```
//!
//! Kinds that neither noise nor a column couples (engine against engine, as a rule) are kept apart.

use faer::Mat;

use crate::baseline::Baseline;
use crate::learning::outliers::Weights;
use crate::math::cholesky::factor_and_project;
use crate::math::linear::{subtract_gram, symmetrize};
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::residuals::whiten::whiten_within_segment;
use crate::signals::channels::{ByChannel, MAXIMUM_CHANNELS};
use crate::signals::noise::NoiseFactors;
use crate::thresholds::LEARNING_FOLDS;

#[cfg(test)]
mod tests;

/// Kinds of channels: fuel flow, engine against engine, N2.
pub(super) const KINDS: usize = 3;

/// All that learning asks of the data.
pub(super) struct GramSums {
    pub(super) parts: Vec<CoupledChannels>,
    /// What flights that are left out are judged on.
    pub(super) left_out: Vec<LeftOut>,
    /// Segments by which stated intervals are judged.
    pub(super) segments: Vec<LeftOutSegment>,
    /// Columns, the residual last.
    columns: usize,
}

/// Kinds of channels that are coupled with each other, and with no other kind.
pub(super) struct CoupledChannels {
    pub(super) kinds: [bool; KINDS],
    /// Columns that are not zero in it, ascending; the residual last.
    pub(super) columns: Vec<usize>,
    /// Sums of each fold of flights, and of all.
    folds: Vec<SegmentSums>,
    all: SegmentSums,
    flights: Vec<FlightSums>,
    /// Σ ln|C| of all segments at factors of 1.
    ln_noise: f64,
    /// Recorded channels of each kind.
    recorded: [usize; KINDS],
}

/// Mean residual of a flight in a channel, the mean columns there, and variances at factors of 1.
pub(super) struct LeftOut {
    pub(super) fold: usize,
    pub(super) kind: usize,
    pub(super) residual: f64,
    pub(super) loading: Vec<f64>,
    pub(super) within: f64,
    pub(super) between: f64,
}

/// A segment's fuel flow, the columns there, and variances at factors of 1.
pub(super) struct LeftOutSegment {
    pub(super) fold: usize,
    pub(super) residual: f64,
    pub(super) loading: Vec<f64>,
    pub(super) within: f64,
    pub(super) between: f64,
    /// Share of the smooth functions' variance that their terms do not hold, over all functions.
    pub(super) unflown_share: f64,
    /// Variance of the drag table that its loadings leave out.
    pub(super) drag_left_out: f64,
    pub(super) drag_over_thrust: f64,
}

/// What the own noise of segments contributes: one matrix per pair of kinds.
#[derive(Clone)]
struct SegmentSums {
    pairs: Vec<KindPair>,
}

/// `XᵀKX` of a pair of kinds; both triangles.
#[derive(Clone)]
struct KindPair {
    lower_kind: usize,
    upper_kind: usize,
    sums: Mat<f64>,
}

/// What the common errors of one flight need.
struct FlightSums {
    projections: Vec<Projection>,
    inner: Vec<LoadingProduct>,
    rank: usize,
}

/// Σ `K_ab` `x_a` `u_b` over a flight, for one loading u and every column x of coupled channels.
struct Projection {
    /// Kind of the column's channel.
    column_kind: usize,
    /// Kind of the loading's channel.
    loading_kind: usize,
    loading: usize,
    sums: Vec<f64>,
}

/// Σ `K_ab` `u_a` `u_b` over a flight, for two loadings.
#[derive(Clone, Copy)]
struct LoadingProduct {
    kinds: [usize; 2],
    loadings: [usize; 2],
    sum: f64,
}

/// A segment as sums need it.
struct Row {
    flight: usize,
    /// Every column, the residual last.
    raw: Vec<ByChannel>,
    /// Inverse of the segment's own covariance.
    inverse: [ByChannel; MAXIMUM_CHANNELS],
    common: Vec<ByChannel>,
    ln_noise: ByChannel,
    is_recorded: [bool; MAXIMUM_CHANNELS],
}

impl GramSums {
    /// Sums over data whose noise has factors of 1.
    pub(super) fn new(baseline: &Baseline, data: &PreparedFlights<'_>, weights: &Weights) -> Self {
        let count = data.channels.count();
        let kind_of: Vec<usize> = (0..count).map(|channel| data.channels.kind(channel)).collect();
        let mut rows = Vec::with_capacity(data.segments.len());
        for (flight, range) in data.flights.iter().enumerate() {
            let of_flight = weights.flights[flight].sqrt();
            for at in range.segments.clone() {
                let (row, weight) = (&data.segments[at], weights.segments[at]);
                let white: [ByChannel; MAXIMUM_CHANNELS] = core::array::from_fn(|channel| {
                    let mut unit = [0.0; MAXIMUM_CHANNELS];
                    unit[channel] = 1.0;
                    whiten_within_segment(row, &unit, count)
                });
                rows.push(Row {
                    flight,
                    raw: baseline.raw_row(data, row),
                    inverse: core::array::from_fn(|a| {
                        core::array::from_fn(|b| {
                            weight * (0..count).map(|k| white[a][k] * white[b][k]).sum::<f64>()
                        })
                    }),
                    common: row.noise.common.iter().map(|u| u.map(|u| u / of_flight)).collect(),
                    ln_noise: core::array::from_fn(|channel| {
                        if channel < count {
                            2.0 * row.noise.factor[channel][channel].ln() - weight.ln()
                        } else {
                            0.0
                        }
                    }),
                    is_recorded: row.is_recorded,
                });
            }
        }
        let columns = baseline.factor.nrows() + 1;
        let parts = parts_of(&rows, &kind_of)
            .into_iter()
            .map(|kinds| CoupledChannels::new(kinds, &rows, &kind_of, data.flights.len(), columns))
            .collect();
        let segments = left_out_segments(baseline, data, &rows);
        Self { parts, left_out: left_out(data, &rows), segments, columns }
    }

    /// Gram matrix of all columns over all flights, or over a fold; both triangles.
    pub(super) fn gram(&self, noise: &NoiseFactors, fold: Option<usize>) -> Mat<f64> {
        let mut gram = Mat::<f64>::zeros(self.columns, self.columns);
        for part in &self.parts {
            let of_part = part.gram(noise, fold).0;
            for (j, &column) in part.columns.iter().enumerate() {
                for (i, &row) in part.columns.iter().enumerate().skip(j) {
                    gram[(row, column)] += of_part[(i, j)];
                }
            }
        }
        symmetrize(&mut gram);
        gram
    }
}

impl CoupledChannels {
    fn new(
        kinds: [bool; KINDS],
        rows: &[Row],
        kind_of: &[usize],
        flights: usize,
        columns: usize,
    ) -> Self {
        let channels: Vec<usize> =
            (0..kind_of.len()).filter(|&channel| kinds[kind_of[channel]]).collect();
        let is_used = |column: usize| {
            rows.iter().any(|row| channels.iter().any(|&c| row.raw[column][c] != 0.0))
        };
        let columns: Vec<usize> =
            (0..columns).filter(|&column| column + 1 == columns || is_used(column)).collect();
        let mut recorded = [0; KINDS];
        let mut ln_noise = 0.0;
        for row in rows {
            for &channel in &channels {
                ln_noise += row.ln_noise[channel];
                recorded[kind_of[channel]] += usize::from(row.is_recorded[channel]);
            }
        }
        let folds: Vec<SegmentSums> = (0..LEARNING_FOLDS)
            .map(|fold| {
                let rows: Vec<&Row> =
                    rows.iter().filter(|row| row.flight % LEARNING_FOLDS == fold).collect();
                SegmentSums::new(&rows, &channels, kind_of, &columns)
            })
            .collect();
        let all = SegmentSums::sum(&folds);
        let flights = (0..flights)
            .map(|flight| {
                let rows: Vec<&Row> = rows.iter().filter(|row| row.flight == flight).collect();
                FlightSums::new(&rows, &channels, kind_of, &columns)
            })
            .collect();
        Self { kinds, columns, folds, all, flights, ln_noise, recorded }
    }

    /// Gram matrix of the part's columns, lower triangle, and, of all flights, Σ `ln|C_f|`.
    pub(super) fn gram(&self, noise: &NoiseFactors, fold: Option<usize>) -> (Mat<f64>, f64) {
        let size = self.columns.len();
        let within = fold.map_or(&self.all, |fold| &self.folds[fold]);
        let mut gram = Mat::<f64>::zeros(size, size);
        for pair in &within.pairs {
            let share = 1.0 / (noise.within[pair.lower_kind] * noise.within[pair.upper_kind]);
            for column in 0..size {
                let from = pair.sums.col_as_slice(column);
                let into = gram.col_as_slice_mut(column);
                for (into, from) in into[column..].iter_mut().zip(&from[column..]) {
                    *into += share * from;
                }
            }
        }
        let mut ln_noise = self.ln_noise;
        for kind in 0..KINDS {
            ln_noise += 2.0 * self.recorded[kind] as f64 * noise.within[kind].ln();
        }
        let kept: Vec<&FlightSums> = self
            .flights
            .iter()
            .enumerate()
            .filter(|(flight, _)| fold.is_none_or(|fold| flight % LEARNING_FOLDS == fold))
            .map(|(_, common)| common)
            .collect();
        let mut explained =
            Mat::<f64>::zeros(size, kept.iter().map(|common| common.rank).sum::<usize>());
        let mut at = 0;
        for common in kept {
            ln_noise += common.write(noise, &mut explained, at);
            at += common.rank;
        }
        subtract_gram(&mut gram, &explained);
        (gram, ln_noise)
    }
}

impl SegmentSums {
    fn new(rows: &[&Row], channels: &[usize], kind_of: &[usize], columns: &[usize]) -> Self {
        // Most columns act on one channel only: products are taken over the columns that do.
        let used: Vec<Vec<usize>> = channels
            .iter()
            .map(|&channel| {
                (0..columns.len())
                    .filter(|&k| rows.iter().any(|row| row.raw[columns[k]][channel] != 0.0))
                    .collect()
            })
            .collect();
        let mut pairs: Vec<KindPair> = Vec::new();
        for (p, &c) in channels.iter().enumerate() {
            for (q, &d) in channels.iter().enumerate().take(p + 1) {
                if rows.iter().all(|row| row.inverse[c][d] == 0.0) {
                    continue;
                }
                let left = Mat::from_fn(rows.len(), used[p].len(), |s, k| {
                    rows[s].raw[columns[used[p][k]]][c]
                });
                let right = Mat::from_fn(rows.len(), used[q].len(), |s, k| {
                    rows[s].inverse[c][d] * rows[s].raw[columns[used[q][k]]][d]
                });
                let product = left.transpose() * &right;
                let (a, b) = (kind_of[c].min(kind_of[d]), kind_of[c].max(kind_of[d]));
                let known =
                    pairs.iter().position(|pair| (pair.lower_kind, pair.upper_kind) == (a, b));
                let at = known.unwrap_or_else(|| {
                    let sums = Mat::zeros(columns.len(), columns.len());
                    pairs.push(KindPair { lower_kind: a, upper_kind: b, sums });
                    pairs.len() - 1
                });
                let sum = &mut pairs[at].sums;
                for (j, &column) in used[q].iter().enumerate() {
                    for (i, &row) in used[p].iter().enumerate() {
                        sum[(row, column)] += product[(i, j)];
                        if c != d {
                            sum[(column, row)] += product[(i, j)];
                        }
                    }
                }
            }
        }
        Self { pairs }
    }

    fn sum(folds: &[Self]) -> Self {
        let mut all = Self { pairs: Vec::new() };
        for fold in folds {
            for pair in &fold.pairs {
                let kinds = (pair.lower_kind, pair.upper_kind);
                match all.pairs.iter_mut().find(|p| (p.lower_kind, p.upper_kind) == kinds) {
                    Some(known) => known.sums += &pair.sums,
                    None => all.pairs.push(pair.clone()),
                }
            }
        }
        all
    }
}

impl FlightSums {
    fn new(rows: &[&Row], channels: &[usize], kind_of: &[usize], columns: &[usize]) -> Self {
        let loadings = rows.first().map_or(0, |row| row.common.len());
        let acting: Vec<usize> = (0..loadings)
            .filter(|&r| rows.iter().any(|row| channels.iter().any(|&c| row.common[r][c] != 0.0)))
            .collect();
        let mut projections: Vec<Projection> = Vec::new();
        let mut inner: Vec<LoadingProduct> = Vec::new();
        for row in rows {
            for &c in channels {
                for &d in channels {
                    let (a, b) = (kind_of[c], kind_of[d]);
                    for (r, &loading) in acting.iter().enumerate() {
                        let by = row.inverse[c][d] * row.common[loading][d];
                        if by == 0.0 {
                            continue;
                        }
                        let known = projections
                            .iter()
                            .position(|p| (p.column_kind, p.loading_kind, p.loading) == (a, b, r));
                        let at = known.unwrap_or_else(|| {
                            projections.push(Projection {
                                column_kind: a,
                                loading_kind: b,
                                loading: r,
                                sums: vec![0.0; columns.len()],
                            });
                            projections.len() - 1
                        });
                        for (slot, &column) in projections[at].sums.iter_mut().zip(columns) {
                            *slot += row.raw[column][c] * by;
                        }
                        for (s, &other) in acting.iter().enumerate() {
                            let value = row.common[other][c] * by;
                            if value != 0.0 {
                                let (kinds, loadings) = ([a, b], [s, r]);
                                inner.push(LoadingProduct { kinds, loadings, sum: value });
                            }
                        }
                    }
                }
            }
        }
        let key = |entry: &LoadingProduct| (entry.kinds, entry.loadings);
        inner.sort_by_key(key);
        let mut summed: Vec<LoadingProduct> = Vec::new();
        for entry in inner {
            match summed.last_mut() {
                Some(last) if key(last) == key(&entry) => last.sum += entry.sum,
                _ => summed.push(entry),
            }
        }
        Self { projections, inner: summed, rank: acting.len() }
    }

    /// Writes XᵀC⁻¹U·L⁻ᵀ, `LLᵀ` = 1 + UᵀC⁻¹U, into columns from `at` on; returns `ln|1 + UᵀC⁻¹U|`.
    fn write(&self, noise: &NoiseFactors, into: &mut Mat<f64>, at: usize) -> f64 {
        let (within, between) = (&noise.within, &noise.between);
        let mut inner = Mat::<f64>::identity(self.rank, self.rank);
        for &LoadingProduct { kinds: [a, b], loadings: [s, r], sum: value } in &self.inner {
            inner[(s, r)] += value * between[a] * between[b] / (within[a] * within[b]);
        }
        for Projection { column_kind, loading_kind, loading, sums } in &self.projections {
            let share = between[*loading_kind] / (within[*column_kind] * within[*loading_kind]);
            for (slot, value) in into.col_as_slice_mut(at + loading).iter_mut().zip(sums) {
                *slot += share * value;
            }
        }
        factor_and_project(&mut inner, into, at)
    }
}

/// Kinds of channels, grouped by what couples them: noise of a segment, an error common to a flight, a column.
fn parts_of(rows: &[Row], kind_of: &[usize]) -> Vec<[bool; KINDS]> {
    let mut group: [usize; KINDS] = [0, 1, 2];
    let mut join = |a: usize, b: usize| {
        let (from, to) = (group[a].max(group[b]), group[a].min(group[b]));
        for slot in &mut group {
            if *slot == from {
                *slot = to;
            }
        }
    };
    for row in rows {
        for (c, &a) in kind_of.iter().enumerate() {
            for (d, &b) in kind_of.iter().enumerate().take(c) {
                if a == b {
                    continue;
                }
                let both = |values: &ByChannel| values[c] != 0.0 && values[d] != 0.0;
                let columns = &row.raw[..row.raw.len() - 1];
                if row.inverse[c][d] != 0.0
                    || row.common.iter().any(both)
                    || columns.iter().any(both)
                {
                    join(a, b);
                }
            }
        }
    }
    (0..KINDS)
        .map(|of| core::array::from_fn(|kind| group[kind] == of && kind_of.contains(&kind)))
        .filter(|kinds: &[bool; KINDS]| kinds.contains(&true))
        .collect()
}

fn left_out_segments(
    baseline: &Baseline,
    data: &PreparedFlights<'_>,
    rows: &[Row],
) -> Vec<LeftOutSegment> {
    let pairs = data.segments.iter().zip(rows);
    pairs
        .map(|(segment, row)| {
            let width = row.raw.len() - 1;
            LeftOutSegment {
                fold: row.flight % LEARNING_FOLDS,
                residual: segment.residual[0],
                loading: row.raw[..width].iter().map(|values| values[0]).collect(),
                within: segment.noise.factor[0][0] * segment.noise.factor[0][0],
                between: segment.noise.common.iter().map(|u| u[0] * u[0]).sum(),
                unflown_share: baseline.unflown_share(&segment.response),
                drag_left_out: baseline
                    .table
                    .as_ref()
                    .map_or(0.0, |table| table.left_out(&segment.response)),
                drag_over_thrust: segment.drag_over_thrust,
            }
        })
        .collect()
}

fn left_out(data: &PreparedFlights<'_>, rows: &[Row]) -> Vec<LeftOut> {
    let mut found = Vec::new();
    for (flight, range) in data.flights.iter().enumerate() {
        let segments = &data.segments[range.segments.clone()];
        let rows = &rows[range.segments.clone()];
        let count = segments.len() as f64;
        for channel in 0..data.channels.count() {
            if !segments.iter().all(|row| row.is_recorded[channel]) {
                continue;
            }
            let width = rows.first().map_or(0, |row| row.raw.len() - 1);
            let mut mean = LeftOut {
                fold: flight % LEARNING_FOLDS,
                kind: data.channels.kind(channel),
                residual: 0.0,
                loading: vec![0.0; width],
                within: 0.0,
                between: 0.0,
            };
            for (segment, row) in segments.iter().zip(rows) {
                mean.residual += segment.residual[channel] / count;
                for (slot, values) in mean.loading.iter_mut().zip(&row.raw) {
                    *slot += values[channel] / count;
                }
                let own: f64 =
                    segment.noise.factor[channel][..=channel].iter().map(|l| l * l).sum();
                mean.within += own / (count * count);
                mean.between +=
                    segment.noise.common.iter().map(|u| u[channel] * u[channel]).sum::<f64>()
                        / count;
            }
            found.push(mean);
        }
    }
    found
}

impl Baseline {
    /// Raw values of every column and, last, the residual.
    fn raw_row(
        &self,
        data: &PreparedFlights<'_>,
        row: &SegmentRow,
    ) -> Vec<[f64; MAXIMUM_CHANNELS]> {
        let layout = self.layout();
        let mut remainder = vec![0.0; layout.remainder.len()];
        self.write_remainder(&row.response, &mut remainder);
        let mut raw = vec![[0.0; MAXIMUM_CHANNELS]; layout.len() + 1];
        for (slot, value) in raw[layout.remainder].iter_mut().zip(&remainder) {
            slot[0] = *value;
        }
        for (slot, contrast) in raw[layout.contrasts].iter_mut().zip(1..) {
            if row.is_recorded[contrast] {
                slot[contrast] = 1.0;
            }
        }
        if data.channels.n2 {
            let channel = data.channels.n2_row();
            if row.is_recorded[channel] {
                for (slot, term) in raw[layout.deck].iter_mut().zip(row.deck) {
                    slot[channel] = term;
                }
            }
        }
        raw[layout.standing_effects].copy_from_slice(&row.standing_effects);
        let mut loadings = vec![0.0; layout.drag.len()];
        self.write_drag(&row.response, &mut loadings);
        for (slot, loading) in raw[layout.drag].iter_mut().zip(&loadings) {
            let by = row.drag_over_thrust * loading;
            slot[0] = by;
            if data.channels.n2 && row.is_recorded[data.channels.n2_row()] {
                slot[data.channels.n2_row()] = row.n2_slope * by;
            }
        }
        if let Some(last) = raw.last_mut() {
            *last = row.residual;
        }
        raw
    }
}
