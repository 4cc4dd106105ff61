//! A tail as plain numbers for the charts, taken out of the results once.

use std::collections::BTreeMap;

use effects::ObserveError;
use flight::Timestamp;

use pipeline::evaluation::TailResult;
use pipeline::model_file::ModelFile;
use pipeline::segments_table::SegmentRow;
use pipeline::statistics::{ErrorStatistics, NORMAL_95};
use units::convert::METERS_PER_NAUTICAL_MILE;

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
    /// Cruise performance at every segment inside the table.
    pub(crate) cruise: Vec<Cruise>,
    /// Number of engines that are recorded separately.
    pub(crate) engines: usize,
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

/// What a segment says of cruise performance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cruise {
    /// Gross mass, t.
    pub(crate) mass_t: f64,
    /// Recorded specific range, nautical air miles per tonne of fuel.
    pub(crate) specific_range: f64,
    /// The same with the fuel flow that the present model predicts.
    pub(crate) predicted: f64,
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
    /// Mean error by the model before it learnt this flight, where that is known.
    pub(crate) before_learning: Option<f64>,
    /// Mean fuel flow of each engine against the mean of all engines, %; empty where they are not recorded separately.
    pub(crate) engines: Vec<f64>,
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
    /// Half width of the 95 % interval of each node's drag coefficient, relative to the initial one; `None` where the law has
    /// none.
    pub(crate) half_width95: Option<Vec<f64>>,
    /// Nodes that a segment ever adapted.
    pub(crate) informed: Vec<bool>,
    /// Nodes outside the range of the guide.
    pub(crate) extrapolated: Vec<bool>,
}

impl TailView {
    pub(crate) fn new(result: &TailResult) -> Self {
        let adapted = result.summary.fuel_flow_error_percent.after.is_some();
        let after = result.errors_after();
        let curve = result.learning_curve();
        let (mut points, mut outside, mut not_observed) = (Vec::new(), Vec::new(), Vec::new());
        let mut cruise = Vec::new();
        let mut flights: BTreeMap<(Timestamp, &str), Errors> = BTreeMap::new();
        for (k, row) in result.rows.iter().enumerate() {
            let identity = &row.segment.identity;
            let errors = flights.entry((identity.start, &identity.flight)).or_default();
            errors.add_engines(&row.segment.means.fuel_flow_engine_kg_s);
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
            cruise.extend(cruise_of(result, k));
            errors.before.extend(point.before);
            errors.after.extend(point.after);
            points.push(point);
        }
        let flights: Vec<Flight> = flights
            .into_iter()
            .map(|((start, flight), errors)| {
                let forecast = curve.get(&(start, flight.to_owned()));
                errors.of_flight(start, flight, forecast.map(|of| of.mean_error_percent))
            })
            .collect();
        Self {
            points,
            outside,
            not_observed,
            engines: flights.iter().map(|flight| flight.engines.len()).max().unwrap_or(0),
            flights,
            cruise,
            polars: Polars::from_model(&result.model),
            adapted,
        }
    }

    /// The label of "before": there is one only where there is an "after".
    pub(crate) fn before_label(&self) -> &'static str {
        if self.adapted { "before" } else { "model as given" }
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
    /// Sums of the fuel flow of each engine, kg/s.
    engines_kg_s: Vec<f64>,
}

impl Errors {
    /// Adds a segment's engines; segments with another number of engines than the first are left out.
    fn add_engines(&mut self, fuel_flow_kg_s: &[f64]) {
        if self.engines_kg_s.is_empty() {
            self.engines_kg_s = fuel_flow_kg_s.to_vec();
        } else if self.engines_kg_s.len() == fuel_flow_kg_s.len() {
            for (sum, one) in self.engines_kg_s.iter_mut().zip(fuel_flow_kg_s) {
                *sum += one;
            }
        }
    }

    fn of_flight(self, start: Timestamp, name: &str, before_learning: Option<f64>) -> Flight {
        let engines = &self.engines_kg_s;
        let mean = engines.iter().sum::<f64>() / engines.len() as f64;
        Flight {
            name: name.to_owned(),
            start,
            start_s: start.as_second() as f64,
            before: ErrorStatistics::from_errors(&self.before),
            after: ErrorStatistics::from_errors(&self.after),
            before_learning,
            engines: engines.iter().map(|one| 100.0 * (one / mean - 1.0)).collect(),
        }
    }
}

/// Cruise performance at a segment that the present model predicts.
fn cruise_of(result: &TailResult, k: usize) -> Option<Cruise> {
    let SegmentRow { segment, evaluated } = &result.rows[k];
    let means = &segment.means;
    let present = if result.after.is_empty() { *evaluated } else { result.after[k] };
    let predicted_kg_s = present?.predicted_fuel_flow_kg_s?;
    let miles_per_tonne =
        |fuel_kg_s: f64| 1000.0 * means.true_airspeed_m_s / fuel_kg_s / METERS_PER_NAUTICAL_MILE;
    Some(Cruise {
        mass_t: means.mass_kg / 1000.0,
        specific_range: miles_per_tonne(means.fuel_flow_total_kg_s),
        predicted: miles_per_tonne(predicted_kg_s),
    })
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
            half_width95: model.posterior().map(|posterior| {
                posterior.standard_deviation().iter().map(|sd| NORMAL_95 * sd).collect()
            }),
            informed,
            extrapolated: model.initial.extrapolated().to_vec(),
        }
    }

    /// Node of two breakpoints.
    pub(crate) fn node(&self, lift_coefficient: usize, mach: usize) -> usize {
        lift_coefficient * self.mach.len() + mach
    }
}
