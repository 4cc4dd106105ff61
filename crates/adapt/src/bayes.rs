//! Law `bayes`: a smooth Gaussian correction of the initial table, with its uncertainty.
//!
//! The table is the initial one times (1 + x), with one number x per node; along an axis with more than 40 breakpoints, 40 of
//! them carry such numbers, evenly chosen, and x is bilinear between them. A prior states that x is smooth and about 10 % in
//! size; every segment observes the four nodes around it; the solution estimates x and its uncertainty everywhere,
//! including nodes never visited. The book's page on law `bayes` has equations, sources and measured figures.
//!
//! What is fixed: [`BayesSettings`] belong to the initial model and learning never changes them; [`tune`] finds better
//! ones on past flights. What grows: [`BayesState`] holds sums over the nodes of the flown region, whatever the number
//! of flights. What costs: learning a flight involves only its own segments; the only solve is [`BayesState::solve`].
//!
//! Limits: whatever is not a function of lift coefficient and Mach number (altitude, temperature, the engine) is
//! treated as an error common to a flight. A bilinear table cannot hold structure finer than about half a cell, and an
//! initial table's own chords are part of what is learnt. Outlier weights depend on what was learnt before; nothing
//! else depends on the order.
//!
//! ```
//! use std::sync::Arc;
//! use adapt::bayes::{BayesSettings, BayesState};
//! use flight::{Observation, ObservationVariance, Timestamp};
//! use lut::{Axis, Grid, Outside, Table};
//!
//! let grid = Arc::new(Grid::new(Axis::from_step(0.2, 0.6, 0.05)?, Axis::from_step(0.7, 0.9, 0.05)?));
//! let initial = Table::new(Arc::clone(&grid), vec![0.030; grid.nodes()])?;
//! let mut state = BayesState::new(&initial, BayesSettings::physical_2026())?;
//! let observation = Observation {
//!     time: Timestamp::UNIX_EPOCH,
//!     lift_coefficient: 0.42,
//!     mach: 0.78,
//!     drag_coefficient: 0.0315, // 5 % more
//!     fuel_flow_total_kg_s: 0.33,
//!     fuel_flow_per_drag_coefficient_kg_s: 10.0,
//!     variance: ObservationVariance { segment: 2.5e-5, flight: 2e-5 },
//! };
//! state.learn_flight(&[observation; 5]);
//! let posterior = state.solve()?;
//! let cell = grid.locate(0.42, 0.78, Outside::Error)?;
//! assert!((posterior.drag().interpolate(&cell) / 0.030 - 1.05).abs() < 0.002);
//! assert!(posterior.relative_variance(&cell).sqrt() < 0.02);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::sync::Arc;

use flight::{Observation, ObservationVariance, Timestamp};
use lut::{Cell, Grid, Outside, Table};

mod blocks;
mod data;
mod drag_tables;
mod evidence;
mod guard;
mod half_life;
mod information;
mod many_points;
mod outcome;
mod outlier_weights;
mod polynomial;
mod posterior;
mod prior;
mod settings;
mod support;
#[cfg(test)]
mod tests;

pub use data::{BayesStateData, StateDataError};
pub use drag_tables::DragTables;
pub use evidence::{Search, TuneError, TuneStep, Tuned, log_evidence, tune};
pub use guard::{GuardReason, GuardReport, GuardedNode};
pub use half_life::{HalfLife, log_predictive_density, search_half_life};
pub use many_points::VarianceByCell;
pub use outcome::{FlightUpdate, InitialError, MergeError, ObservationUpdate};
pub use polynomial::{PolynomialError, PolynomialExport, polynomial_export};
pub use posterior::{Posterior, SolveError};
pub use settings::{BayesSettings, SettingValues, SettingsError};

use information::{Information, Row};
use outlier_weights::{ExpectedResidual, SegmentResidual, WeightSettings};
use support::Support;

/// Drag of more than this many times the initial table's is not an observation of drag. Our choice: that is an error of
/// units or of a sensor.
pub const MAXIMUM_DRAG_RATIO: f64 = 10.0;

const SECONDS_A_DAY: f64 = 86_400.0;

/// The state of law `bayes`, without the prior: sums that can be added.
#[derive(Clone, Debug, PartialEq)]
pub struct BayesState {
    initial: Table,
    support: Support,
    settings: BayesSettings,
    weight_settings: WeightSettings,
    information: Information,
    expected_residual: ExpectedResidual,
    /// The newest observation learnt; with a half-life, the instant to which the sums refer.
    newest: Option<Timestamp>,
    flights: u64,
    segments: u64,
}

impl BayesState {
    /// An empty state: nothing is learnt yet.
    ///
    /// # Errors
    /// [`InitialError`] where a drag coefficient is not above 0: there is no relative correction of it.
    pub fn new(initial: &Table, settings: BayesSettings) -> Result<Self, InitialError> {
        let not_positive = initial.values().iter().enumerate().find(|(_, value)| **value <= 0.0);
        if let Some((node, &value)) = not_positive {
            return Err(InitialError { node, value });
        }
        let (x, y) = (initial.grid().x(), initial.grid().y());
        let middle = (x.first().midpoint(x.last()), y.first().midpoint(y.last()));
        let support = Support::new(initial.grid());
        Ok(Self {
            weight_settings: WeightSettings::new(&settings, middle),
            information: Information::new(support.grid().nodes()),
            support,
            expected_residual: ExpectedResidual::new(),
            initial: initial.clone(), // shares the grid
            settings,
            newest: None,
            flights: 0,
            segments: 0,
        })
    }

    /// Learns one flight: all its observations at once, because they share an error.
    ///
    /// With a half-life, an observation older than the newest learnt counts less from the start: the order of flights
    /// does not matter, except for outlier weights.
    ///
    /// # Source
    /// Book `[bayes.3]`–`[bayes.8]`.
    pub fn learn_flight(&mut self, observations: &[Observation]) -> FlightUpdate {
        let flight = self.read(observations);
        let flight_weights = self.expected_residual.weigh(
            &self.weight_settings,
            &flight.residuals,
            flight.common_variance,
        );
        self.learn_weighted(&flight, &flight_weights);
        let mut learnt =
            flight_weights.weights.iter().zip(&flight_weights.surprises).zip(&flight.residuals);
        let updates = flight
            .refused
            .iter()
            .map(|refusal| {
                refusal.or_else(|| {
                    let ((&weight, &surprise), case) = learnt.next()?;
                    Some(ObservationUpdate::Learnt { residual: case.residual, surprise, weight })
                })
            })
            .collect::<Option<Vec<_>>>();
        FlightUpdate {
            observations: updates.unwrap_or_default(),
            flight_weight: (!flight.residuals.is_empty()).then_some(flight_weights.flight_weight),
        }
    }

    /// Solves for all nodes: the only expensive call. Of many states that touched few nodes the tables
    /// alone cost less by [`DragTables`], whose systems are dense in the nodes touched.
    ///
    /// # Errors
    /// [`SolveError`] where the sums are not a positive definite information matrix (a damaged file).
    pub fn solve(&self) -> Result<Posterior, SolveError> {
        Posterior::new(&self.initial, &self.support, self.settings, &self.information)
    }

    /// Adds what another state has learnt. The order of the two does not matter, up to rounding.
    ///
    /// # Errors
    /// [`MergeError`] where grid, initial table or settings differ; nothing was added then.
    pub fn merge(&mut self, other: &Self) -> Result<(), MergeError> {
        if self.grid() != other.grid() {
            return Err(MergeError::GridsDiffer);
        }
        let pairs = self.initial.values().iter().zip(other.initial.values());
        if let Some((node, (&ours, &theirs))) =
            pairs.enumerate().find(|(_, (ours, theirs))| ours.to_bits() != theirs.to_bits())
        {
            return Err(MergeError::InitialsDiffer { node, ours, theirs });
        }
        if let Some((setting, ours, theirs)) = self.settings.first_difference(&other.settings) {
            return Err(MergeError::SettingsDiffer { setting, ours, theirs });
        }
        let mut other = other.clone();
        if let Some(newest) = self.newest {
            other.decay_to(newest);
        }
        if let Some(newest) = other.newest {
            self.decay_to(newest);
        }
        // A state without a segment has no newest instant of its own.
        self.newest = self.newest.max(other.newest);
        self.information.merge(&other.information);
        self.expected_residual.merge(&other.expected_residual);
        self.flights = self.flights.saturating_add(other.flights);
        self.segments = self.segments.saturating_add(other.segments);
        Ok(())
    }

    /// Lets knowledge age to an instant; one that is not after the newest observation changes nothing.
    ///
    /// # Source
    /// Book `[bayes.8]`.
    pub fn decay_to(&mut self, instant: Timestamp) {
        let Some(newest) = self.newest else { return };
        if instant <= newest {
            return;
        }
        let share = self.settings.decay(days_between(newest, instant));
        if share < 1.0 {
            self.information.scale(share);
            self.expected_residual.scale(share);
        }
        self.newest = Some(instant);
    }

    /// The grid: x is the lift coefficient, y the Mach number.
    #[must_use]
    pub const fn grid(&self) -> &Arc<Grid> {
        self.initial.grid()
    }

    /// The table that is corrected.
    #[must_use]
    pub const fn initial(&self) -> &Table {
        &self.initial
    }

    /// The settings.
    #[must_use]
    pub const fn settings(&self) -> &BayesSettings {
        &self.settings
    }

    /// Flights learnt; ageing does not change the count.
    #[must_use]
    pub const fn flights(&self) -> u64 {
        self.flights
    }

    /// Segments learnt, outliers included; ageing does not change the count.
    #[must_use]
    pub const fn segments(&self) -> u64 {
        self.segments
    }

    /// Nodes of corrections that were ever touched: the size of the state.
    #[must_use]
    pub fn touched_nodes(&self) -> usize {
        self.information.touched().len()
    }

    /// The newest observation, or the instant that knowledge was aged to.
    #[must_use]
    pub const fn newest(&self) -> Option<Timestamp> {
        self.newest
    }

    /// Locates and checks a flight's observations; adds this law's own noise to theirs.
    fn read(&self, observations: &[Observation]) -> Flight {
        let mut flight = Flight::with_capacity(observations.len());
        let mut common_variance = 0.0;
        for observation in observations {
            match located(&self.initial, observation) {
                Ok((cell, residual)) => {
                    flight.residuals.push(SegmentResidual {
                        lift_coefficient: observation.lift_coefficient,
                        mach: observation.mach,
                        residual,
                        variance: self.settings.segment_variance(&observation.variance),
                    });
                    let terms = self.support.terms(&self.initial, &cell);
                    flight.rows.push(Row {
                        nodes: terms.nodes,
                        coefficients: terms.coefficients,
                        bilinear: terms.bilinear,
                        residual,
                        precision: 0.0,
                        count: 0.0,
                    });
                    common_variance += self.settings.flight_variance(&observation.variance);
                    flight.newest = flight.newest.max(Some(observation.time));
                    flight.refused.push(None);
                }
                Err(refusal) => flight.refused.push(Some(refusal)),
            }
        }
        // The segments of a flight may state slightly different variances of their common error.
        flight.common_variance = common_variance / flight.residuals.len().max(1) as f64;
        flight
    }

    fn learn_weighted(&mut self, flight: &Flight, flight_weights: &outlier_weights::FlightWeights) {
        let Some(time) = flight.newest else { return };
        self.decay_to(time);
        let newest = self.newest.unwrap_or(time);
        self.newest = Some(newest);
        let share = self.settings.decay(days_between(time, newest));

        let weighted = flight.rows.iter().zip(&flight.residuals).zip(&flight_weights.weights);
        let rows: Vec<Row> = weighted
            .map(|((row, case), weight)| Row {
                precision: weight / case.variance,
                count: weight.min(1.0),
                ..*row
            })
            .collect();
        let common = flight.common_variance / flight_weights.flight_weight;
        self.information.add_flight(&rows, common, share);
        self.expected_residual.learn(
            &self.weight_settings,
            &flight.residuals,
            flight_weights,
            flight.common_variance,
            share,
        );
        self.flights += 1;
        self.segments += flight.residuals.len() as u64;
    }
}

/// A flight that was read: what can be learnt, and what cannot.
#[derive(Clone, Debug)]
struct Flight {
    /// One per observation; `None` for those that can be learnt, which follow in the same order.
    refused: Vec<Option<ObservationUpdate>>,
    residuals: Vec<SegmentResidual>,
    rows: Vec<Row>,
    common_variance: f64,
    newest: Option<Timestamp>,
}

impl Flight {
    fn with_capacity(observations: usize) -> Self {
        Self {
            refused: Vec::with_capacity(observations),
            residuals: Vec::with_capacity(observations),
            rows: Vec::with_capacity(observations),
            common_variance: 0.0,
            newest: None,
        }
    }
}

/// Factors of the four nodes' corrections in the correction at the point: bilinear weight times the node's initial
/// drag, divided by the point's. They sum to 1.
///
/// # Source
/// Book `[bayes.3]`.
fn coefficients(initial: &Table, cell: &Cell) -> [f64; 4] {
    let drag = initial.interpolate(cell);
    let (nodes, weights) = (cell.nodes(), cell.weights());
    [0, 1, 2, 3].map(|k| weights[k] * initial.value_at_node(nodes[k]) / drag)
}

/// Cell and relative excess of drag of an observation that can be learnt.
fn located(initial: &Table, observation: &Observation) -> Result<(Cell, f64), ObservationUpdate> {
    let refuse = |quantity, value| Err(ObservationUpdate::Unusable { quantity, value });
    let Observation { lift_coefficient, mach, drag_coefficient, variance, .. } = *observation;
    for (quantity, value) in [("lift coefficient", lift_coefficient), ("Mach number", mach)] {
        if !value.is_finite() {
            return refuse(quantity, value);
        }
    }
    let ObservationVariance { segment, flight } = variance;
    for (quantity, value) in
        [("variance of the segment", segment), ("variance of the flight", flight)]
    {
        if !(value.is_finite() && value >= 0.0) {
            return refuse(quantity, value);
        }
    }
    let cell = initial
        .grid()
        .locate(lift_coefficient, mach, Outside::Error)
        .map_err(ObservationUpdate::OutsideGrid)?;
    let ratio = drag_coefficient / initial.interpolate(&cell);
    if !(ratio > 0.0 && ratio <= MAXIMUM_DRAG_RATIO) {
        return refuse("observed drag coefficient", drag_coefficient);
    }
    Ok((cell, ratio - 1.0))
}

fn days_between(earlier: Timestamp, later: Timestamp) -> f64 {
    later.duration_since(earlier).as_secs_f64() / SECONDS_A_DAY
}
