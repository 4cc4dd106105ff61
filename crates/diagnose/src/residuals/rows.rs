//! One segment, one flight, as the search sees them.

use effects::{EffectPoint, KnownPoint, Response};

use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::signals::channels::{ByChannel, MAXIMUM_CHANNELS};
use crate::signals::n2_deck::DECK_TERMS;
use crate::signals::noise::SegmentNoise;

/// One segment.
#[derive(Clone, Debug)]
pub(crate) struct SegmentRow {
    pub(crate) point: EffectPoint,
    /// The same with what most effects leave alone.
    pub(crate) known: KnownPoint,
    /// Prediction without any effect.
    pub(crate) response: Response,
    pub(crate) is_recorded: [bool; MAXIMUM_CHANNELS],
    /// Recorded less predicted.
    pub(crate) residual: ByChannel,
    /// ∂channel/∂θ of each column.
    pub(crate) signatures: Vec<ByChannel>,
    pub(crate) noise: SegmentNoise,
    /// ∂channel/∂θ of the effects that a baseline carries; 0 where an input is not recorded.
    pub(crate) standing_effects: [ByChannel; STANDING_EFFECTS.len()],
    /// Whether it could not be computed.
    pub(crate) standing_unknown: [bool; STANDING_EFFECTS.len()],
    /// Its place among all segments that were given.
    pub(crate) place: usize,
    /// Deck terms at the prediction.
    pub(crate) deck: [f64; DECK_TERMS],
    /// ∂(N2 channel)/∂(ln F).
    pub(crate) n2_slope: f64,
    /// Drag over thrust.
    pub(crate) drag_over_thrust: f64,
    /// Mean N2 of the engines, %, where it is recorded.
    pub(crate) n2_percent: Option<f64>,
    /// Standard deviation of the recorded acceleration, m/s².
    pub(crate) acceleration_deviation_m_s2: f64,
    /// Factor on its whitened rows: below 1 where residuals have heavy tails and its own are large.
    pub(crate) weight: f64,
    /// Samples that its means are of.
    pub(crate) samples: usize,
    /// Chord errors of the drag table along lift coefficient and Mach number, relative to drag.
    pub(crate) chords: [f64; 2],
}

/// Gauges against meters, of one flight: residual, standard deviation, signature of each column.
#[derive(Clone, Debug)]
pub(crate) struct GaugeRow {
    pub(crate) residual: f64,
    pub(crate) deviation: f64,
    pub(crate) signatures: Vec<f64>,
}

/// Flights in order, with the range of their segments.
#[derive(Clone, Debug)]
pub(crate) struct FlightRows {
    pub(crate) segments: core::ops::Range<usize>,
    pub(crate) gauge: Option<GaugeRow>,
    /// When it began.
    pub(crate) start_s: f64,
    /// Share of what the flight says that still counts: 1 where knowledge does not age.
    pub(crate) share: f64,
}
