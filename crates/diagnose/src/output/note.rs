//! What was assumed, and why segments were left out.

use flight::effect::EffectId;

use crate::output::verdict::Rest;

/// Something that was assumed, or that a reader of the diagnosis should know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Note {
    /// N2 of some segments indicates no thrust near the predicted one: `tsfc_throttle` is over corrected thrust there.
    N2WithoutThrust {
        /// Segments where it indicates none.
        silent: usize,
        /// Segments with N2.
        recorded: usize,
    },
    /// Anti-ice bleed is not recorded in some segments: static air temperature above −40 °C stands for it there.
    AntiIceByTemperature {
        /// Segments where it is not recorded.
        segments: usize,
        /// Segments that the model can predict.
        of_segments: usize,
    },
    /// Segments lie beyond what the flights that taught the model flew: what is seen there may be what those did not show.
    BeyondFlights {
        /// Segments beyond.
        segments: usize,
        /// Segments that the model can predict.
        of_segments: usize,
    },
    /// References of effects are the means of these flights.
    ReferencesAreMeans,
    /// Whitened residuals have heavy tails: segments are weighed.
    HeavyTails,
    /// Segments are unlike all others: they were left out before anything was searched.
    Outliers {
        /// Outliers.
        segments: usize,
        /// Segments that the model can predict, outliers among them.
        of_segments: usize,
        /// Flights of which every segment is an outlier.
        flights: usize,
    },
    /// The uncertainty of a large drag table is kept for the nodes that these flights visit; elsewhere the table counts as
    /// known.
    TableInColumns {
        /// Nodes of the table.
        nodes: usize,
        /// Columns of the factor of their covariance.
        columns: usize,
        /// Largest share of a visited node's variance that the columns leave out.
        missing_share: f64,
    },
    /// These flights differ from the reference in the mean of what an effect depends on by more than they vary in it, so that it
    /// cannot be distinguished from a level of drag or fuel flow.
    LikeALevel(EffectId),
    /// Named effects leave something that depends on one variable.
    Rest(Rest),
}

/// Why a segment was left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LeftOutReason {
    /// Its fuel flow is not positive, or no number.
    FuelFlowNotPositive,
    /// It is outside the drag table.
    OutsideTable,
    /// One of its means is outside its domain.
    OutOfDomain,
    /// No thrust is left to fly it.
    NoThrust,
    /// It cannot be predicted for another reason.
    NotPredictable,
    /// It is an outlier: far from what all other segments show, and unlike its neighbors in every variable.
    Outlier,
}
