//! Channels of a segment: total fuel flow, contrasts between engines, N2.

use flight::{MAXIMUM_ENGINES, SegmentMeans};

/// Most channels a segment has: fuel flow, three contrasts of four engines, N2.
pub(crate) const MAXIMUM_CHANNELS: usize = flight::MAXIMUM_ENGINES + 1;

/// One number a channel.
pub(crate) type ByChannel = [f64; MAXIMUM_CHANNELS];

/// Which channels there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Channels {
    /// Contrasts between engines: engines − 1, or 0.
    pub(crate) contrasts: usize,
    pub(crate) n2: bool,
}

impl Channels {
    pub(crate) const fn count(self) -> usize {
        1 + self.contrasts + if self.n2 { 1 } else { 0 }
    }

    pub(crate) const fn n2_row(self) -> usize {
        1 + self.contrasts
    }

    /// Kind of a channel, for noise factors: 0 fuel flow, 1 contrast, 2 N2.
    pub(crate) const fn kind(self, channel: usize) -> usize {
        if channel == 0 {
            0
        } else if channel <= self.contrasts {
            1
        } else {
            2
        }
    }
}

/// Contrasts between engines, normalized like ln(Wf1/Wf2): the mean of the first k engines less engine k + 1.
pub(crate) fn contrasts(ln_flows: &[f64], into: &mut [f64]) {
    for (k, slot) in into.iter_mut().enumerate() {
        let first = (k + 1) as f64;
        let mean = ln_flows[..=k].iter().sum::<f64>() / first;
        *slot = (mean - ln_flows[k + 1]) * (2.0 * first / (first + 1.0)).sqrt();
    }
}

pub(crate) fn recorded_channels(
    means: &SegmentMeans,
    channels: Channels,
) -> (ByChannel, [bool; MAXIMUM_CHANNELS]) {
    let mut values = [0.0; MAXIMUM_CHANNELS];
    let mut present = [false; MAXIMUM_CHANNELS];
    values[0] = means.fuel_flow_total_kg_s.ln();
    present[0] = true;
    let flows = &means.fuel_flow_engine_kg_s;
    if channels.contrasts > 0
        && flows.len() == channels.contrasts + 1
        && flows.iter().all(|flow| flow.is_finite() && *flow > 0.0)
    {
        let mut ln = [0.0; MAXIMUM_ENGINES];
        for (slot, flow) in ln.iter_mut().zip(flows) {
            *slot = flow.ln();
        }
        contrasts(&ln, &mut values[1..=channels.contrasts]);
        present[1..=channels.contrasts].fill(true);
    }
    if let Some(mean) = mean_n2_percent(means).filter(|_| channels.n2) {
        values[channels.n2_row()] = (mean / 100.0).ln();
        present[channels.n2_row()] = true;
    }
    (values, present)
}

/// Mean N2 of the engines, %, where all are recorded.
pub(crate) fn mean_n2_percent(means: &SegmentMeans) -> Option<f64> {
    has_n2(means).then(|| means.n2_percent.iter().sum::<f64>() / means.n2_percent.len() as f64)
}

pub(crate) fn has_n2(means: &SegmentMeans) -> bool {
    !means.n2_percent.is_empty() && means.n2_percent.iter().all(|n2| n2.is_finite() && *n2 > 1.0)
}
