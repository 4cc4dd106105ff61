//! Outliers: segments that are far from what all others show, and unlike their neighbors in every variable.
//!
//! They are left out before anything is searched or judged, so that search, competition with what is outside the library, forms,
//! regions and closure see the same flights. Who is an outlier is found in turns: all segments are judged by a flexible fit to
//! those that were none before, until they stay.
//!
//! Difficult: one absurd segment moves what its whole flight seems to have in common. Rows are therefore whitened segment by
//! segment, and a flight's common errors are estimated from its ordinary segments alone.

use std::borrow::Cow;

use effects::Variable;
use faer::Mat;

use crate::hypotheses::design::{AGNOSTIC_VARIABLES, Design};
use crate::library::Library;
use crate::library::dates::is_dated;
use crate::math::cholesky::Cholesky;
use crate::math::gram::Sum;
use crate::math::linear::gather;
use crate::math::quantile::{MEDIAN_TO_DEVIATION, median};
use crate::priors::{OUTLIER_SMOOTH, ROBUST_EFFECT};
use crate::residuals::rows::{FlightRows, SegmentRow};
use crate::residuals::segments::PreparedFlights;
use crate::residuals::whiten::common_loadings;
use crate::search::system::{RowsWithinSegments, fit_in_memory};
use crate::signals::channels::{ByChannel, MAXIMUM_CHANNELS};
use crate::thresholds::{
    ALIKE_NEIGHBORS, FARTHEST_FROM_MEDIAN, LEAST_MEDIAN_DISTANCE, LEAST_ROBUST_SCALE,
    NEIGHBORS_AS_THIS, OUTLIER_DISTANCE, OUTLIER_NEIGHBORS,
};

/// Turns at most; two or three settle who is an outlier.
const TURNS: usize = 8;

/// In which channel, and to which side, a segment or flight is far from all others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Side {
    channel: usize,
    is_above: bool,
}

/// Which segments are outliers.
///
/// ```text
/// e = y − Xθ̂ − Uẑ,  |e| > k·s in a channel, or |ẑ| > k·median|ẑ| of the flight                      [diagnosis.21]
/// ```
///
/// θ̂: all effects, nuisance and smooth functions, fitted to the other segments; ẑ: what the flight has in common, from its ordinary
/// segments; s: robust standard deviation of the channel; k: [`OUTLIER_DISTANCE`].
///
/// A gap that depends on something is shown by neighbors too: a segment is no outlier if half of the nearest segments of other
/// flights, in any variable, are as far to the same side. Among those variables is the date: two flights one after the other that
/// are off alike are none, one alone is.
///
/// A flight that is partly in such a gap has half of it in common, so that its segments are far on either side of it, and its
/// neighbors within flights that are wholly in the gap, or out of it, are not far. So neighbors are also asked whether what they
/// leave, with what their flights have in common, is rather what the segment leaves than what its flight has in common.
pub(crate) fn outliers(
    data: &PreparedFlights<'_>,
    design: &Design<'_>,
    library: &Library,
    rows: &RowsWithinSegments,
) -> Vec<bool> {
    let judge = Judge::new(data, design, library, rows);
    let mut judged = Judged { far: far_from_median(data), left: vec![] };
    for _ in 0..TURNS {
        let Some(sizes) = judge.fit(&judged.far) else { break };
        let Some(next) = judge.far(&sizes, &judged.far) else {
            return vec![false; data.segments.len()];
        };
        let settled = next.far.iter().zip(&judged.far).all(|(a, b)| a.is_some() == b.is_some());
        judged = next;
        if settled {
            break;
        }
    }
    Neighbors::new(data, design).alone(&judged)
}

/// What the fit says of every segment.
struct Judged {
    /// Which are far from all others.
    far: Vec<Option<Side>>,
    /// What the fit leaves of each; none before there is a fit.
    left: Vec<Left>,
}

/// What the fit leaves of a segment, by channel.
#[derive(Clone, Copy, Debug)]
struct Left {
    /// All of it.
    all: ByChannel,
    /// What would be left if the segment were as the others: what its flight has in common, or nothing where that is far itself.
    expected: ByChannel,
}

impl Left {
    /// Whether this is nearer to what another leaves than to what that one would if it were as its flight.
    fn is_as(&self, other: &Self, channel: usize) -> bool {
        let from = |value: f64| (self.all[channel] - value).abs();
        from(other.all[channel]) < from(other.expected[channel])
    }
}

/// Before anything is fitted: what is far from the median of all segments.
fn far_from_median(data: &PreparedFlights<'_>) -> Vec<Option<Side>> {
    let mut far = vec![None; data.segments.len()];
    for channel in 0..data.channels.count() {
        let recorded = || data.segments.iter().filter(|row| row.is_recorded[channel]);
        let middle = median(recorded().map(|row| row.residual[channel]).collect());
        let distance =
            median(recorded().map(|row| (row.residual[channel] - middle).abs()).collect());
        let scale = (MEDIAN_TO_DEVIATION * distance).max(LEAST_MEDIAN_DISTANCE);
        for (far, row) in far.iter_mut().zip(&data.segments).filter(|(far, _)| far.is_none()) {
            let off = row.residual[channel] - middle;
            if row.is_recorded[channel] && off.abs() > FARTHEST_FROM_MEDIAN * scale {
                *far = Some(Side { channel, is_above: off > 0.0 });
            }
        }
    }
    far
}

/// What segments are judged by.
struct Judge<'a> {
    data: &'a PreparedFlights<'a>,
    design: &'a Design<'a>,
    within_segments: &'a RowsWithinSegments,
    /// Columns of the flexible fit, the residual last, and their prior standard deviations.
    columns: Vec<usize>,
    deviations: Vec<f64>,
    /// Rows of every flight, where they fit in memory; else they are made again at every turn.
    kept: Option<Vec<OfFlight>>,
}

/// A flight's rows, whitened segment by segment: columns of the fit, and loadings of what the flight has in common.
#[derive(Clone)]
struct OfFlight {
    rows: Mat<f64>,
    common: Mat<f64>,
}

impl<'a> Judge<'a> {
    /// The fit has every effect without a date (a step that begins with one absurd flight would explain it), the nuisance and
    /// the smooth functions.
    fn new(
        data: &'a PreparedFlights<'a>,
        design: &'a Design<'a>,
        library: &Library,
        within_segments: &'a RowsWithinSegments,
    ) -> Self {
        let undated = library.effects.iter().filter(|effect| !is_dated(effect.id));
        let smooth = design.smooth_deviation(OUTLIER_SMOOTH);
        let (mut columns, deviations): (Vec<usize>, Vec<f64>) = undated
            .map(|effect| (effect.representative, ROBUST_EFFECT * effect.typical))
            .chain(design.nuisance.clone().map(|column| (column, 1.0)))
            .chain(design.smooth.clone().map(|column| (column, smooth)))
            .unzip();
        columns.push(design.residual());
        let keep = fit_in_memory(data, columns.len());
        let mut judge = Self { data, design, within_segments, columns, deviations, kept: None };
        let flights = 0..data.flights.len();
        judge.kept = keep.then(|| flights.map(|flight| judge.made(flight)).collect());
        judge
    }

    fn of_flight(&self, index: usize) -> Cow<'_, OfFlight> {
        match &self.kept {
            Some(kept) => Cow::Borrowed(&kept[index]),
            None => Cow::Owned(self.made(index)),
        }
    }

    fn made(&self, index: usize) -> OfFlight {
        let rows = self.within_segments.of_flight(self.data, self.design, index);
        let flight = &self.data.flights[index];
        let count = flight.segments.len() * self.data.channels.count();
        let places: Vec<usize> = (0..count).collect();
        let segments = &self.data.segments[flight.segments.clone()];
        OfFlight {
            rows: gather(&rows, &places, &self.columns),
            common: common_loadings(self.data, segments, count),
        }
    }

    /// Rows of a flight's segments that meet a condition.
    fn places(&self, flight: &FlightRows, meets: impl Fn(usize) -> bool) -> Vec<usize> {
        let channels = self.data.channels.count();
        let first = flight.segments.start;
        flight
            .segments
            .clone()
            .filter(|&segment| meets(segment))
            .flat_map(|segment| (0..channels).map(move |k| (segment - first) * channels + k))
            .collect()
    }

    /// Sizes of all columns from the segments that are not far; `None` where the numbers are degenerate.
    fn fit(&self, far: &[Option<Side>]) -> Option<Vec<f64>> {
        let width = self.columns.len();
        let all: Vec<usize> = (0..width).collect();
        let (mut own, mut shared) = (Sum::new(width), Sum::new(width));
        for (index, flight) in self.data.flights.iter().enumerate() {
            let places = self.places(flight, |segment| far[segment].is_none());
            if places.is_empty() {
                continue;
            }
            let of_flight = self.of_flight(index);
            let rows = gather(&of_flight.rows, &places, &all);
            let (common, inner) = inner(&of_flight.common, &places)?;
            let mut cross = common.transpose() * &rows;
            inner.solve_lower(&mut cross);
            own.add(&rows, 0.0);
            shared.add(&cross, 0.0);
        }
        let gram = own.finish().matrix - shared.finish().matrix;
        let last = width - 1;
        let mut normal = Mat::from_fn(last, last, |i, j| gram[(i, j)]);
        for (k, deviation) in self.deviations.iter().enumerate() {
            normal[(k, k)] += deviation.powi(-2);
        }
        let mut sizes = Mat::from_fn(last, 1, |k, _| gram[(k, last)]);
        Cholesky::new(&normal)?.solve(&mut sizes);
        Some(sizes.col_as_slice(0).to_vec())
    }

    /// What is far from the fit, of all segments; those that were `before` say nothing about what their flight has in common.
    /// `None` where the numbers are degenerate.
    fn far(&self, sizes: &[f64], before: &[Option<Side>]) -> Option<Judged> {
        let mut left = Vec::with_capacity(self.data.segments.len());
        let mut of_flights = Vec::with_capacity(self.data.flights.len());
        // A flight of which every segment was far is judged by all of them.
        for (index, flight) in self.data.flights.iter().enumerate() {
            let some = flight.segments.clone().any(|segment| before[segment].is_none());
            let ordinary = self.places(flight, |segment| !some || before[segment].is_none());
            let (of_segments, common) = self.left_of(index, sizes, &ordinary)?;
            left.extend(of_segments);
            of_flights.push(common);
        }
        let mut far = self.far_segments(&left);
        let distances = of_flights.iter().map(|(distance, _)| *distance).collect();
        let limit = OUTLIER_DISTANCE * median(distances).max(1.0);
        for (flight, (distance, side)) in self.data.flights.iter().zip(of_flights) {
            for segment in flight.segments.clone().filter(|_| distance > limit) {
                far[segment] = Some(side);
                left[segment].expected = [0.0; MAXIMUM_CHANNELS];
            }
        }
        Some(Judged { far, left })
    }

    /// What a flight's segments leave; how far the flight is off, and to which side.
    fn left_of(
        &self,
        flight: usize,
        sizes: &[f64],
        ordinary: &[usize],
    ) -> Option<(Vec<Left>, (f64, Side))> {
        let of_flight = self.of_flight(flight);
        let mut rows = of_flight.rows.col_as_slice(sizes.len()).to_vec();
        for (column, size) in sizes.iter().enumerate() {
            for (left, value) in rows.iter_mut().zip(of_flight.rows.col_as_slice(column)) {
                *left -= size * value;
            }
        }
        let (common, inner) = inner(&of_flight.common, ordinary)?;
        let of_ordinary = Mat::from_fn(ordinary.len(), 1, |k, _| rows[ordinary[k]]);
        let mut shared = common.transpose() * of_ordinary;
        inner.solve(&mut shared);
        let explained = &of_flight.common * &shared;
        let channels = self.data.channels.count();
        let mut means = [0.0; MAXIMUM_CHANNELS];
        let none = [0.0; MAXIMUM_CHANNELS];
        let mut left = vec![Left { all: none, expected: none }; rows.len() / channels];
        for (row, value) in rows.into_iter().enumerate() {
            let (segment, channel) = (row / channels, row % channels);
            left[segment].all[channel] = value;
            left[segment].expected[channel] = explained[(row, 0)];
            means[channel] += explained[(row, 0)];
        }
        let largest = (0..channels).max_by(|&a, &b| means[a].abs().total_cmp(&means[b].abs()));
        let channel = largest.unwrap_or(0);
        let side = Side { channel, is_above: means[channel] > 0.0 };
        Some((left, (shared.norm_l2(), side)))
    }

    fn far_segments(&self, left: &[Left]) -> Vec<Option<Side>> {
        let channels = self.data.channels.count();
        let mut far = vec![None; self.data.segments.len()];
        let mut farthest = vec![OUTLIER_DISTANCE; far.len()];
        for channel in 0..channels {
            let recorded = self.data.segments.iter().enumerate();
            let recorded: Vec<usize> =
                recorded.filter(|(_, row)| row.is_recorded[channel]).map(|(k, _)| k).collect();
            let of = |segment: usize| left[segment].all[channel] - left[segment].expected[channel];
            let distance = median(recorded.iter().map(|&k| of(k).abs()).collect());
            let scale = (MEDIAN_TO_DEVIATION * distance).max(LEAST_ROBUST_SCALE);
            for segment in recorded {
                let off = of(segment) / scale;
                if off.abs() > farthest[segment] {
                    farthest[segment] = off.abs();
                    far[segment] = Some(Side { channel, is_above: off > 0.0 });
                }
            }
        }
        far
    }
}

/// Loadings of some rows, and the factor of `1 + UᵀU` over them.
fn inner(common: &Mat<f64>, rows: &[usize]) -> Option<(Mat<f64>, Cholesky)> {
    let rank: Vec<usize> = (0..common.ncols()).collect();
    let common = gather(common, rows, &rank);
    let mut inner = common.transpose() * &common;
    for k in rank {
        inner[(k, k)] += 1.0;
    }
    Some((common, Cholesky::new(&inner)?))
}

/// Segments in the order of every variable.
struct Neighbors {
    orders: Vec<Vec<usize>>,
    /// Flight of each segment.
    flights: Vec<usize>,
}

impl Neighbors {
    fn new(data: &PreparedFlights<'_>, design: &Design<'_>) -> Self {
        let of_variable = |variable: &Variable| {
            let value =
                |row: &SegmentRow| variable.value(&row.point, &row.response, design.references());
            let values = data.segments.iter().map(value).collect::<Option<Vec<f64>>>()?;
            let mut order: Vec<usize> = (0..values.len()).collect();
            order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
            Some(order)
        };
        let mut flights = vec![0; data.segments.len()];
        for (index, flight) in data.flights.iter().enumerate() {
            flights[flight.segments.clone()].fill(index);
        }
        Self { orders: AGNOSTIC_VARIABLES.iter().filter_map(of_variable).collect(), flights }
    }

    /// Of what is far from all others, what has no neighbors that are off alike in any variable.
    fn alone(&self, judged: &Judged) -> Vec<bool> {
        let mut alone: Vec<bool> = judged.far.iter().map(Option::is_some).collect();
        for order in &self.orders {
            for (place, &segment) in order.iter().enumerate() {
                if alone[segment] && self.has_company(order, place, judged) {
                    alone[segment] = false;
                }
            }
        }
        alone
    }

    fn has_company(&self, order: &[usize], place: usize, judged: &Judged) -> bool {
        let segment = order[place];
        let Judged { far, left } = judged;
        let Some(side) = far[segment] else { return true };
        let is_as = |one: usize| match (left.get(one), left.get(segment)) {
            (Some(near), Some(own)) => near.is_as(own, side.channel),
            _ => false,
        };
        let other = |near: &&usize| self.flights[**near] != self.flights[segment];
        let (mut below, mut above) =
            (order[..place].iter().rev().filter(other), order[place + 1..].iter().filter(other));
        let (mut near, mut alike, mut as_this) = (0, 0, 0);
        while near < OUTLIER_NEIGHBORS {
            let pair = [below.next(), above.next()];
            for &one in pair.iter().flatten() {
                near += 1;
                alike += usize::from(far[*one] == Some(side));
                as_this += usize::from(is_as(*one));
            }
            if pair == [None, None] {
                break;
            }
        }
        let at_least = |count: usize, share: f64| count > 0 && count as f64 >= share * near as f64;
        at_least(alike, ALIKE_NEIGHBORS) || at_least(as_this, NEIGHBORS_AS_THIS)
    }
}

#[cfg(test)]
mod tests;
