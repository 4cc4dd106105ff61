//! What comes of learning and of adding, and why it cannot be done.

use lut::OutsideGrid;

/// Why a table cannot be corrected by a relative amount.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("initial drag coefficient of node {node} is {value}, not above 0")]
#[non_exhaustive]
pub struct InitialError {
    /// The node.
    pub node: usize,
    /// Its drag coefficient.
    pub value: f64,
}

/// Why two states cannot be added.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MergeError {
    /// They are not on one grid.
    #[error("the grids differ")]
    GridsDiffer,
    /// They correct different initial tables.
    #[error("initial drag coefficient of node {node} is {ours} here and {theirs} there")]
    InitialsDiffer {
        /// The first node that differs.
        node: usize,
        /// Drag coefficient here.
        ours: f64,
        /// Drag coefficient there.
        theirs: f64,
    },
    /// They were learnt with different settings. A half-life that is off counts as infinite.
    #[error("setting {setting} is {ours} here and {theirs} there")]
    SettingsDiffer {
        /// The first setting that differs.
        setting: &'static str,
        /// Its value here.
        ours: f64,
        /// Its value there.
        theirs: f64,
    },
}

/// The result of learning a flight.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct FlightUpdate {
    /// Of each observation, in the order given.
    pub observations: Vec<ObservationUpdate>,
    /// Outlier weight of the flight's common error: 1 for an ordinary flight, towards 0 for one that is off as a whole
    /// (a wrong load sheet). It divides the flight's common variance. `None` where nothing was learnt.
    pub flight_weight: Option<f64>,
}

/// The result of learning an observation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ObservationUpdate {
    /// A number of the observation cannot be used; nothing was learnt from it.
    Unusable {
        /// Which, in the field's words and with its unit.
        quantity: &'static str,
        /// The value given.
        value: f64,
    },
    /// The point lies outside the grid; nothing was learnt from it.
    OutsideGrid(OutsideGrid),
    /// It was learnt.
    Learnt {
        /// Observed drag over the initial table's, minus 1.
        residual: f64,
        /// The same minus what a quadratic through all earlier flights predicts.
        surprise: f64,
        /// Outlier weight: around 1 for an ordinary segment, towards 0 for an outlier. It divides the segment's
        /// variance.
        weight: f64,
    },
}
