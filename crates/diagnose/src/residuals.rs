//! Recorded less predicted, segment by segment, with signatures of every effect and the noise; whitening.

pub(crate) mod chords;
pub(crate) mod gauges;
pub(crate) mod level;
pub(crate) mod planned;
pub(crate) mod predictor;
pub(crate) mod reference;
pub(crate) mod rows;
pub(crate) mod segments;
pub(crate) mod signatures;
pub(crate) mod whiten;
pub(crate) mod whole;
