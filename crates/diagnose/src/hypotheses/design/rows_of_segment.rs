//! Rows of one segment in the whitened matrix.

use faer::Mat;

use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::residuals::whiten::whiten_within_segment;
use crate::signals::channels::{ByChannel, Channels, MAXIMUM_CHANNELS};

/// The rows of one segment in a matrix, one row per channel, whitened by the segment's own noise.
pub(super) struct RowsOfSegment<'a> {
    pub(super) row: &'a SegmentRow,
    pub(super) channels: Channels,
    first: usize,
    matrix: &'a mut Mat<f64>,
    /// Whitened: a change of fuel flow alone, and of thrust, which N2 sees too.
    fuel_flow: ByChannel,
    thrust: ByChannel,
}

impl<'a> RowsOfSegment<'a> {
    pub(super) fn new(
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
    pub(super) fn of_remainder(&self, thrust_share: f64) -> ByChannel {
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

    pub(super) fn put(&mut self, column: usize, values: &ByChannel) {
        let white = whiten_within_segment(self.row, values, self.channels.count());
        self.put_white(column, &white, 1.0);
    }

    pub(super) fn put_fuel_flow(&mut self, column: usize, by: f64) {
        let unit = self.fuel_flow;
        self.put_white(column, &unit, by);
    }

    pub(super) fn put_thrust(&mut self, column: usize, by: f64) {
        let unit = self.thrust;
        self.put_white(column, &unit, by);
    }

    pub(super) fn put_white(&mut self, column: usize, white: &ByChannel, by: f64) {
        for (channel, value) in white.iter().enumerate().take(self.channels.count()) {
            self.matrix[(self.first + channel, column)] = value * by;
        }
    }
}
