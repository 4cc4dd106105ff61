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

    /// The response with the thrust that a baseline has learnt, at which the deck holds.
    pub(crate) fn at_learnt_thrust(&self, response: &Response) -> Response {
        with_thrust(response, self.learnt_thrust(response))
    }

    /// The corrected thrust that a recorded N2 stands for, N, as the table alone would have it: less what a baseline has learnt
    /// of thrust, like everything that thrusts are compared with.
    pub(crate) fn corrected_thrust_by_n2_n(
        &self,
        n2_percent: f64,
        response: &Response,
    ) -> Option<f64> {
        let learnt = self.learnt_thrust(response);
        let found = self.deck.corrected_thrust_n(n2_percent, &with_thrust(response, learnt))?;
        Some(found * (-learnt).exp())
    }

    fn learnt_thrust(&self, response: &Response) -> f64 {
        self.baseline.map_or(0.0, |baseline| baseline.thrust_at(response))
    }

    pub(crate) fn predict(&self, response: &Response) -> ByChannel {
        let channels = self.channels;
        let mut predicted = [0.0; MAXIMUM_CHANNELS];
        predicted[0] = response.ln_fuel_flow_total;
        contrasts(&response.ln_fuel_flow_engine, &mut predicted[1..=channels.contrasts]);
        let (drag, remainder, share) = self.baseline.map_or((0.0, 0.0, 0.0), |baseline| {
            (baseline.drag_at(response), baseline.mean_at(response), baseline.thrust_share())
        });
        if channels.n2 {
            let thrust = drag + share * remainder;
            predicted[channels.n2_row()] = self.deck.value_with_thrust(response, thrust);
        }
        if let Some(baseline) = self.baseline {
            predicted[0] += drag + remainder;
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

/// The same with another thrust: ln of the ratio.
pub(crate) fn with_thrust(response: &Response, ln_ratio: f64) -> Response {
    Response { ln_corrected_thrust: response.ln_corrected_thrust + ln_ratio, ..*response }
}
