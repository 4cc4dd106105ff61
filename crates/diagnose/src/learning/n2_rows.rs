//! What N2 has to say of its deck, given what fuel flow says of thrust.

use faer::Mat;

use crate::baseline::layout::NuisanceLayout;
use crate::learning::rows::ChannelRows;
use crate::residuals::predictor::with_thrust;
use crate::residuals::rows::SegmentRow;
use crate::residuals::segments::PreparedFlights;
use crate::signals::n2_deck::{DECK_TERMS, Deck};

/// What a baseline's fuel flow came to: its rows, and prior standard deviation and mean of every coefficient, the mean in these.
#[derive(Clone, Copy)]
pub(super) struct LearntFuelFlow<'a> {
    pub(super) layout: &'a NuisanceLayout,
    pub(super) rows: &'a ChannelRows,
    pub(super) deviations: &'a [f64],
    pub(super) means: &'a [f64],
}

/// What N2 is learnt at: the share of the remainder that is thrust, and the deck whose slopes hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct GivenThrust<'a> {
    pub(super) share: f64,
    pub(super) deck: &'a Deck,
}

/// The segments that have N2. What drag and remainder are worth in thrust does not depend on share and deck, and is the same as in
/// fuel flow.
pub(super) struct N2Rows<'a> {
    fuel: LearntFuelFlow<'a>,
    channel: usize,
    at_hand: &'a Deck,
    segments: Vec<&'a SegmentRow>,
    /// Their rows of fuel flow: that is recorded in every segment.
    places: Vec<usize>,
    noise: ChannelRows,
    /// ln(N2/√θt) by the deck at hand, at the thrust of the table.
    before: Vec<f64>,
    /// ln of thrust that drag is worth, and the whole remainder.
    by_drag: Vec<f64>,
    by_remainder: Vec<f64>,
}

impl<'a> N2Rows<'a> {
    pub(super) fn new(data: &'a PreparedFlights<'_>, fuel: LearntFuelFlow<'a>) -> Self {
        let channel = data.channels.n2_row();
        let (places, noise) = ChannelRows::without_columns(data, channel);
        let worth = |columns: core::ops::Range<usize>, first: usize| -> Vec<f64> {
            let mut worth = vec![0.0; places.len()];
            for (k, mean) in fuel.means[columns].iter().enumerate() {
                let column = fuel.rows.columns.col_as_slice(first + k);
                for (sum, place) in worth.iter_mut().zip(&places) {
                    *sum += mean * column[*place];
                }
            }
            worth
        };
        let layout = fuel.layout;
        let by_drag = worth(layout.drag.clone(), fuel.first_of_drag());
        let by_remainder = worth(layout.remainder.clone(), 0);
        let segments: Vec<&SegmentRow> = places.iter().map(|&at| &data.segments[at]).collect();
        let at_hand = &data.predictor.deck;
        let before =
            segments.iter().map(|row| at_hand.of_terms(&at_hand.terms(&row.response))).collect();
        Self { fuel, channel, at_hand, segments, places, noise, before, by_drag, by_remainder }
    }

    /// The deck's columns. The residual is what the deck at hand leaves at the thrust that is given.
    pub(super) fn of_deck(&self, given: &GivenThrust<'_>) -> ChannelRows {
        let LearntFuelFlow { layout, deviations, means, .. } = self.fuel;
        let sizes: Vec<f64> =
            layout.standing_effects.clone().map(|k| means[k] * deviations[k]).collect();
        let deviations = &deviations[layout.deck.clone()];
        let mut columns = Mat::<f64>::zeros(self.segments.len(), DECK_TERMS + 1);
        for (at, row) in self.segments.iter().enumerate() {
            let (terms, slope) = self.at_given_thrust(at, given);
            for (k, (term, deviation)) in terms.iter().zip(deviations).enumerate() {
                columns[(at, k)] = term * deviation;
            }
            let by = steeper(row, slope);
            let effects = row.standing_effects.iter().zip(&sizes);
            let carried: f64 = effects.map(|(of, size)| by * of[self.channel] * size).sum();
            columns[(at, DECK_TERMS)] = row.residual[self.channel] + self.before[at]
                - self.at_hand.of_terms(&terms)
                - carried;
        }
        self.noise.with_columns(columns)
    }

    /// What is given, in the order of [`given_columns`]: what effects, drag and remainder change in N2. A deck bends, so that its
    /// slope is another at another thrust, and so is what effects do.
    pub(super) fn of_given(&self, given: &GivenThrust<'_>) -> Mat<f64> {
        let LearntFuelFlow { layout, rows, deviations, .. } = self.fuel;
        let (standing, drag) = (layout.standing_effects.len(), layout.drag.len());
        let slopes: Vec<f64> =
            (0..self.segments.len()).map(|at| self.at_given_thrust(at, given).1).collect();
        let mut columns =
            Mat::<f64>::zeros(self.segments.len(), standing + drag + layout.remainder.len());
        for (effect, k) in layout.standing_effects.clone().enumerate() {
            let into = columns.col_as_slice_mut(effect);
            for (slot, (row, slope)) in into.iter_mut().zip(self.segments.iter().zip(&slopes)) {
                let of = row.standing_effects[effect][self.channel];
                *slot = steeper(row, *slope) * of * deviations[k];
            }
        }
        let first = self.fuel.first_of_drag();
        let of_drag = (0..drag).map(|k| (standing + k, first + k, 1.0));
        let of_remainder =
            (0..layout.remainder.len()).map(|k| (standing + drag + k, k, given.share));
        for (into, from, share) in of_drag.chain(of_remainder) {
            let from = rows.columns.col_as_slice(from);
            let into = columns.col_as_slice_mut(into);
            for (slot, (place, slope)) in into.iter_mut().zip(self.places.iter().zip(&slopes)) {
                *slot = share * slope * from[*place];
            }
        }
        columns
    }

    /// Terms of the deck, and its slope over thrust, at the thrust that is given.
    fn at_given_thrust(&self, at: usize, given: &GivenThrust<'_>) -> ([f64; DECK_TERMS], f64) {
        let thrust = self.by_drag[at] + given.share * self.by_remainder[at];
        let response = with_thrust(&self.segments[at].response, thrust);
        (self.at_hand.terms(&response), given.deck.slope(&response))
    }
}

impl LearntFuelFlow<'_> {
    /// The first of the drag's columns among those of fuel flow.
    fn first_of_drag(&self) -> usize {
        self.layout.remainder.len() + self.layout.standing_effects.len()
    }
}

/// Columns of a baseline that N2 is given.
pub(super) fn given_columns(
    layout: &NuisanceLayout,
) -> impl Iterator<Item = usize> + Clone + use<> {
    let standing = layout.standing_effects.clone();
    standing.chain(layout.drag.clone()).chain(layout.remainder.clone())
}

/// How much steeper the deck is at the thrust that is given.
fn steeper(row: &SegmentRow, slope: f64) -> f64 {
    if row.n2_slope == 0.0 { 0.0 } else { slope / row.n2_slope }
}
