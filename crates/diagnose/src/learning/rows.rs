//! What each kind of channel has to say, as rows of columns: fuel flow, engine against engine, N2.
//!
//! The kinds are learnt one after the other, and fuel flow first. N2 says what its deck is like, given what fuel flow says of
//! thrust, and nothing the other way: a quadratic is not what an engine does, and what it lacks would be taken for drag.

use core::ops::Range;

use faer::{Mat, MatRef};

use crate::baseline::Baseline;
use crate::baseline::layout::NuisanceLayout;
use crate::residuals::predictor::with_thrust;
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::signals::n2_deck::Deck;

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

/// What N2 is learnt at: means of what fuel flow has said, each in its own unit, and the deck whose slopes hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct GivenThrust<'a> {
    pub(super) drag: &'a [f64],
    pub(super) standing_effects: &'a [f64],
    pub(super) remainder: &'a [f64],
    /// Share of the remainder that is thrust.
    pub(super) share: f64,
    pub(super) deck: &'a Deck,
}

impl ChannelRows {
    /// Columns that are learnt.
    pub(super) fn width(&self) -> usize {
        self.columns.ncols() - 1
    }

    pub(super) fn residual(&self) -> &[f64] {
        self.columns.col_as_slice(self.width())
    }

    pub(super) fn residual_mut(&mut self) -> &mut [f64] {
        let width = self.width();
        self.columns.col_as_slice_mut(width)
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
            let smooth = baseline.write_remainder(&row.response, &mut into[..terms]);
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

    /// N2: the deck, then, not to be learnt, what effects, drag and remainder change in it. The residual is what the deck at hand leaves
    /// at the thrust that is given. A deck bends, so that its slope is another at another thrust, and so is what effects do.
    pub(super) fn of_n2(
        baseline: &Baseline,
        data: &PreparedFlights<'_>,
        deviations: &[f64],
        given: &GivenThrust<'_>,
    ) -> Self {
        let layout = baseline.layout();
        let (deck, standing) = (layout.deck.len(), layout.standing_effects.len());
        let remainder = deck + standing + layout.drag.len();
        let channel = data.channels.n2_row();
        let columns = layout.deck.clone().chain(given_columns(&layout));
        let deviations: Vec<f64> = columns.map(|k| deviations[k]).collect();
        let at_hand = &data.predictor.deck;
        let mut loadings = vec![0.0; layout.drag.len()];
        let mut terms = vec![0.0; layout.remainder.len()];
        let mut residuals = Vec::with_capacity(data.segments.len());
        let mut rows = Self::of_channel(data, channel, deviations.len(), |row, into| {
            baseline.write_drag(&row.response, &mut loadings);
            let mut thrust = row.drag_over_thrust * dot(&loadings, given.drag);
            if given.share > 0.0 {
                baseline.write_remainder(&row.response, &mut terms);
                thrust += given.share * dot(&terms, given.remainder);
            }
            let response = with_thrust(&row.response, thrust);
            let (before, slope) = (row.n2_slope, given.deck.slope(&response));
            let by = if before == 0.0 { 0.0 } else { slope / before };
            into[..deck].copy_from_slice(&at_hand.terms(&response));
            let mut residual =
                row.residual[channel] + at_hand.value(&row.response) - at_hand.value(&response);
            let effects = row.standing_effects.iter().zip(given.standing_effects);
            for (slot, (of, size)) in into[deck..].iter_mut().zip(effects) {
                *slot = by * of[channel];
                residual -= size * *slot;
            }
            residuals.push(residual);
            for (slot, loading) in into[deck + standing..].iter_mut().zip(&loadings) {
                *slot = loading * slope * row.drag_over_thrust;
            }
            for (slot, term) in into[remainder..].iter_mut().zip(&terms) {
                *slot = term * slope * given.share;
            }
            for (slot, deviation) in into.iter_mut().zip(&deviations) {
                *slot *= deviation;
            }
        });
        rows.residual_mut().copy_from_slice(&residuals);
        rows
    }

    /// Rows of the segments in which a channel is recorded.
    fn of_channel(
        data: &PreparedFlights<'_>,
        channel: usize,
        width: usize,
        mut write: impl FnMut(&SegmentRow, &mut [f64]),
    ) -> Self {
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
        let mut columns = Mat::<f64>::zeros(rows.len(), width + 1);
        let mut values = vec![0.0; width];
        for (at, row) in rows.iter().enumerate() {
            write(row, &mut values);
            for (column, value) in values.iter().enumerate() {
                columns[(at, column)] = *value;
            }
            columns[(at, width)] = row.residual[channel];
        }
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
        Self { columns, variance, loadings, groups, shares }
    }

    /// Only some columns.
    pub(super) fn only(&self, columns: &[usize]) -> Self {
        let mut kept = Mat::<f64>::zeros(self.variance.len(), columns.len() + 1);
        for (into, from) in columns.iter().copied().chain([self.width()]).enumerate() {
            kept.col_as_slice_mut(into).copy_from_slice(self.columns.col_as_slice(from));
        }
        Self {
            columns: kept,
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

/// Columns of a baseline that N2 is given, in the order of its rows behind the deck.
pub(super) fn given_columns(
    layout: &NuisanceLayout,
) -> impl Iterator<Item = usize> + Clone + use<> {
    let standing = layout.standing_effects.clone();
    standing.chain(layout.drag.clone()).chain(layout.remainder.clone())
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Columns of a baseline that fuel flow informs, in the order of its rows.
pub(super) fn fuel_flow_columns(
    baseline: &Baseline,
) -> impl Iterator<Item = usize> + Clone + use<> {
    let layout = baseline.layout();
    layout.remainder.chain(layout.standing_effects).chain(layout.drag)
}
