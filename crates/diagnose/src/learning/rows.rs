//! What each kind of channel has to say, as rows of columns: fuel flow, engine against engine, N2.
//!
//! The kinds are learnt one after the other, and fuel flow first. N2 says what its deck is like, given what fuel flow says of
//! thrust, and nothing the other way: a quadratic is not what an engine does, and what it lacks would be taken for drag.

use core::ops::Range;

use faer::{Mat, MatRef};

use crate::baseline::Baseline;
use crate::baseline::layout::NuisanceLayout;
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;

/// Rows of one kind of channel. Columns are in prior standard deviations; noise is that of factors of 1.
pub(super) struct ChannelRows {
    /// One row per recorded value; the residual is the last column.
    pub(super) columns: Mat<f64>,
    /// Variance of what each value has of its own.
    pub(super) variance: Vec<f64>,
    /// Loadings of each value on what its group has in common, one vector per loading.
    pub(super) loadings: Vec<Vec<f64>>,
    /// Rows that err together: those of one flight.
    pub(super) groups: Vec<Range<usize>>,
    /// Share of what each group says that still counts: its likelihood is taken to that power.
    pub(super) shares: Vec<f64>,
}

/// Variance of the prediction at a row that no column holds, at scales of 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unheld {
    /// Of the smooth functions.
    pub(super) smooth: f64,
    /// Of the drag table.
    pub(super) drag: f64,
}

impl ChannelRows {
    /// Columns that are learnt.
    pub(super) fn width(&self) -> usize {
        self.columns.ncols() - 1
    }

    pub(super) fn residual(&self) -> &[f64] {
        self.columns.col_as_slice(self.width())
    }

    /// Fuel flow: the remainder, the effects that a fleet shows at all times, the drag table; and what no column holds.
    pub(super) fn of_fuel_flow(
        baseline: &Baseline,
        data: &PreparedFlights<'_>,
    ) -> (Self, Vec<Unheld>) {
        let layout = baseline.layout();
        let (terms, standing, drag) =
            (layout.remainder.len(), layout.standing_effects.len(), layout.drag.len());
        let deviations: Vec<f64> =
            fuel_flow_columns(baseline).map(|column| baseline.prior_deviation(column)).collect();
        let mut unheld = Vec::with_capacity(data.segments.len());
        let rows = Self::of_channel(data, 0, terms + standing + drag, |row, into| {
            let smooth = baseline.write_remainder(&row.response, &mut into[..terms]).total();
            let square = row.drag_over_thrust * row.drag_over_thrust;
            let of_drag =
                baseline.table.as_ref().map_or(0.0, |table| table.left_out(&row.response));
            unheld.push(Unheld { smooth, drag: square * of_drag });
            for (slot, slope) in into[terms..].iter_mut().zip(&row.standing_effects) {
                *slot = slope[0];
            }
            baseline.write_drag(&row.response, &mut into[terms + standing..]);
            for slot in &mut into[terms + standing..] {
                *slot *= row.drag_over_thrust;
            }
            for (slot, deviation) in into.iter_mut().zip(&deviations) {
                *slot *= deviation;
            }
        });
        (rows, unheld)
    }

    /// One engine against another: a level.
    pub(super) fn of_contrast(
        deviations: &[f64],
        layout: &NuisanceLayout,
        data: &PreparedFlights<'_>,
        at: usize,
    ) -> Self {
        let deviation = deviations[layout.contrasts.start + at - 1];
        Self::of_channel(data, at, 1, |_, into| into[0] = deviation)
    }

    /// Rows of the segments in which a channel is recorded.
    fn of_channel(
        data: &PreparedFlights<'_>,
        channel: usize,
        width: usize,
        mut write: impl FnMut(&SegmentRow, &mut [f64]),
    ) -> Self {
        let (segments, bare) = Self::without_columns(data, channel);
        let mut columns = Mat::<f64>::zeros(segments.len(), width + 1);
        let mut values = vec![0.0; width];
        for (at, segment) in segments.iter().enumerate() {
            let row = &data.segments[*segment];
            write(row, &mut values);
            for (column, value) in values.iter().enumerate() {
                columns[(at, column)] = *value;
            }
            columns[(at, width)] = row.residual[channel];
        }
        Self { columns, ..bare }
    }

    /// Which segments have a channel, and the noise of their rows.
    pub(super) fn without_columns(
        data: &PreparedFlights<'_>,
        channel: usize,
    ) -> (Vec<usize>, Self) {
        let mut segments = Vec::with_capacity(data.segments.len());
        let mut groups = Vec::with_capacity(data.flights.len());
        let mut shares = Vec::with_capacity(data.flights.len());
        for flight in &data.flights {
            let first = segments.len();
            segments.extend(
                flight.segments.clone().filter(|&at| data.segments[at].is_recorded[channel]),
            );
            if segments.len() > first {
                groups.push(first..segments.len());
                shares.push(flight.share);
            }
        }
        let rows: Vec<&SegmentRow> = segments.iter().map(|&at| &data.segments[at]).collect();
        let own = |row: &&SegmentRow| {
            row.noise.factor[channel][..=channel].iter().map(|l| l * l).sum::<f64>()
        };
        let count = rows.iter().map(|row| row.noise.common.len()).max().unwrap_or(0);
        let loadings = (0..count)
            .map(|r| {
                let of = |row: &&SegmentRow| row.noise.common.get(r).map_or(0.0, |u| u[channel]);
                rows.iter().map(of).collect::<Vec<f64>>()
            })
            .filter(|loading| loading.iter().any(|value| *value != 0.0))
            .collect();
        let variance = rows.iter().map(own).collect();
        let columns = Mat::<f64>::zeros(segments.len(), 0);
        (segments, Self { columns, variance, loadings, groups, shares })
    }

    /// Only some columns.
    pub(super) fn only(&self, columns: &[usize]) -> Self {
        let mut kept = Mat::<f64>::zeros(self.variance.len(), columns.len() + 1);
        for (into, from) in columns.iter().copied().chain([self.width()]).enumerate() {
            kept.col_as_slice_mut(into).copy_from_slice(self.columns.col_as_slice(from));
        }
        self.with_columns(kept)
    }

    /// The same noise under other columns, the residual last.
    pub(super) fn with_columns(&self, columns: Mat<f64>) -> Self {
        Self {
            columns,
            variance: self.variance.clone(),
            loadings: self.loadings.clone(),
            groups: self.groups.clone(),
            shares: self.shares.clone(),
        }
    }

    /// The columns without the residual.
    pub(super) fn learnt_columns(&self) -> MatRef<'_, f64> {
        self.columns.subcols(0, self.width())
    }

    /// What coefficients leave of each value.
    pub(super) fn left(&self, mean: &Mat<f64>) -> Vec<f64> {
        let fitted = self.learnt_columns() * mean;
        self.residual().iter().zip(fitted.col_as_slice(0)).map(|(y, fit)| y - fit).collect()
    }

    /// Variance of what each value has in common with its group.
    pub(super) fn common_variance(&self, row: usize) -> f64 {
        self.loadings.iter().map(|loading| loading[row] * loading[row]).sum()
    }
}

/// Columns of a baseline that fuel flow informs, in the order of its rows.
pub(super) fn fuel_flow_columns(
    baseline: &Baseline,
) -> impl Iterator<Item = usize> + Clone + use<> {
    let layout = baseline.layout();
    layout.remainder.chain(layout.standing_effects).chain(layout.drag)
}
