//! From a response of the model to the prediction of every channel.

use effects::Response;

use crate::baseline::Baseline;
use crate::signals::channels::{ByChannel, Channels, MAXIMUM_CHANNELS, contrasts};
use crate::signals::n2_deck::Deck;

/// What turns a response into the prediction of every channel: deck, and what a baseline has learnt.
#[derive(Clone, Debug)]
pub(crate) struct Predictor<'a> {
    pub(crate) channels: Channels,
    pub(crate) deck: Deck,
    pub(crate) baseline: Option<&'a Baseline>,
}

impl Predictor<'_> {
    /// Without what a baseline has learnt. Effects that it carries are learnt by their slopes before it has learnt anything; a
    /// remainder over thrust would answer to them once more.
    pub(crate) fn untaught(&self) -> Self {
        Self { baseline: None, ..self.clone() }
    }

    pub(crate) fn predict(&self, response: &Response) -> ByChannel {
        let channels = self.channels;
        let mut predicted = [0.0; MAXIMUM_CHANNELS];
        predicted[0] = response.ln_fuel_flow_total;
        contrasts(&response.ln_fuel_flow_engine, &mut predicted[1..=channels.contrasts]);
        let drag = self.baseline.map_or(0.0, |baseline| baseline.drag_at(response));
        if channels.n2 {
            let ln_thrust = response.ln_corrected_thrust + drag;
            predicted[channels.n2_row()] =
                self.deck.value(&Response { ln_corrected_thrust: ln_thrust, ..*response });
        }
        if let Some(baseline) = self.baseline {
            predicted[0] += drag + baseline.mean_at(response);
            #[expect(
                clippy::needless_range_loop,
                reason = "a contrast is a channel and a number of the baseline"
            )]
            for contrast in 1..=channels.contrasts.min(baseline.contrasts()) {
                predicted[contrast] += baseline.split_mean(contrast);
            }
        }
        predicted
    }
}
