//! A tail as plain numbers for the charts, taken out of the results once.

use std::collections::BTreeMap;

use effects::ObserveError;
use flight::Timestamp;

use pipeline::evaluation::TailResult;
use pipeline::model_file::ModelFile;
use pipeline::statistics::{ErrorStatistics, mean_half_width95_by_flight};

use crate::chart::dates;

/// A tail as plain numbers.
#[derive(Clone, Debug)]
pub(crate) struct TailView {
    /// Segments that could be reduced to a lift and a drag coefficient, in the results' order.
    pub(crate) points: Vec<Point>,
    /// Lift coefficients and Mach numbers of segments outside the table.
    pub(crate) outside: Vec<(f64, f64)>,
    /// Why other segments give no drag, one reason per segment.
    pub(crate) not_observed: Vec<String>,
    /// Flights with segments, by START.
    pub(crate) flights: Vec<Flight>,
    /// Its drag tables.
    pub(crate) polars: Polars,
    /// Whether there is an "after".
    pub(crate) adapted: bool,
}

/// A segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// START of its flight, seconds since 1970-01-01 UTC.
    pub(crate) start_s: f64,
    pub(crate) lift_coefficient: f64,
    pub(crate) mach: f64,
    /// Observed.
    pub(crate) drag_coefficient: f64,
    /// Error of the initial (or given) table, %; `None` outside it.
    pub(crate) before: Option<f64>,
    /// Error of the final table, %; `None` outside it, or where nothing is adapted.
    pub(crate) after: Option<f64>,
}

/// A flight's errors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Flight {
    /// As sent.
    pub(crate) name: String,
    pub(crate) start: Timestamp,
    /// START, seconds since 1970-01-01 UTC.
    pub(crate) start_s: f64,
    /// Of its segments inside the table.
    pub(crate) before: ErrorStatistics,
    /// Of its segments inside the table.
    pub(crate) after: ErrorStatistics,
}

/// The drag tables, lift coefficient outer and Mach number inner.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Polars {
    pub(crate) lift_coefficient: Vec<f64>,
    pub(crate) mach: Vec<f64>,
    /// Drag coefficient of the initial table.
    pub(crate) initial: Vec<f64>,
    /// Present drag coefficient.
    pub(crate) current: Vec<f64>,
    /// Whether anything was learnt; if not, both are the same.
    pub(crate) learnt: bool,
    /// Nodes that a segment ever adapted.
    pub(crate) informed: Vec<bool>,
    /// Nodes outside the range of the guide.
    pub(crate) extrapolated: Vec<bool>,
}

impl TailView {
    pub(crate) fn new(result: &TailResult) -> Self {
        let adapted = result.summary.fuel_flow_error_percent.after.is_some();
        let after = result.errors_after();
        let (mut points, mut outside, mut not_observed) = (Vec::new(), Vec::new(), Vec::new());
        let mut flights: BTreeMap<(Timestamp, &str), Errors> = BTreeMap::new();
        for (k, row) in result.rows.iter().enumerate() {
            let identity = &row.segment.identity;
            let errors = flights.entry((identity.start, &identity.flight)).or_default();
            if row.evaluated.is_none_or(|evaluated| evaluated.error_percent.is_none()) {
                match result.model.initial.observe(&row.segment) {
                    Err(ObserveError::Model(perf_model::ObserveError::OutsideTable(at))) => {
                        outside.push((at.lift_coefficient, at.mach));
                    }
                    Err(other) => not_observed.push(other.to_string()),
                    Ok(_) => {}
                }
            }
            let Some(evaluated) = row.evaluated else { continue };
            let point = Point {
                start_s: identity.start_s(),
                lift_coefficient: evaluated.lift_coefficient,
                mach: row.segment.means.mach,
                drag_coefficient: evaluated.drag_coefficient,
                before: evaluated.error_percent,
                after: after.get(k).copied().flatten(),
            };
            errors.before.extend(point.before);
            errors.after.extend(point.after);
            points.push(point);
        }
        let flights = flights.into_iter().map(|((start, flight), errors)| Flight {
            name: flight.to_owned(),
            start,
            start_s: start.as_second() as f64,
            before: ErrorStatistics::from_errors(&errors.before),
            after: ErrorStatistics::from_errors(&errors.after),
        });
        Self {
            points,
            outside,
            not_observed,
            flights: flights.collect(),
            polars: Polars::from_model(&result.model),
            adapted,
        }
    }

    /// The label of "before": there is one only where there is an "after".
    pub(crate) fn before_label(&self) -> &'static str {
        if self.adapted { "before" } else { "model as given" }
    }

    /// Half width of the 95 % interval of the mean error before, %; flights count, not segments.
    pub(crate) fn half_width95_before(&self) -> Option<f64> {
        let flights: Vec<ErrorStatistics> =
            self.flights.iter().map(|flight| flight.before).collect();
        mean_half_width95_by_flight(&flights)
    }

    /// Days of the first and the last flight.
    pub(crate) fn period(&self) -> Option<String> {
        let (first, last) = (self.flights.first()?, self.flights.last()?);
        Some(dates::period(first.start_s, last.start_s))
    }

    /// Errors of the initial (or given) table.
    pub(crate) fn before(&self) -> Vec<f64> {
        self.points.iter().filter_map(|point| point.before).collect()
    }

    /// Errors of the final table; none where nothing is adapted.
    pub(crate) fn after(&self) -> Vec<f64> {
        self.points.iter().filter_map(|point| point.after).collect()
    }
}

#[derive(Default)]
struct Errors {
    before: Vec<f64>,
    after: Vec<f64>,
}

impl Polars {
    fn from_model(model: &ModelFile) -> Self {
        let grid = model.grid();
        let initial = model.initial.drag_table().values().to_vec();
        let informed = model
            .learnt
            .as_ref()
            .map_or_else(|| vec![false; initial.len()], |learnt| learnt.law.informed());
        Self {
            lift_coefficient: grid.x().breakpoints().to_vec(),
            mach: grid.y().breakpoints().to_vec(),
            initial,
            current: model.drag_coefficient().values().to_vec(),
            learnt: model.learnt.is_some(),
            informed,
            extrapolated: model.initial.extrapolated().to_vec(),
        }
    }

    /// Node of two breakpoints.
    pub(crate) fn node(&self, lift_coefficient: usize, mach: usize) -> usize {
        lift_coefficient * self.mach.len() + mach
    }
}
