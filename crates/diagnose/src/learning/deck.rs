//! The N2 deck, and how much of the remainder is thrust, given what fuel flow says.

use core::ops::Range;

use faer::Mat;

use crate::baseline::Baseline;
use crate::learning::channel::{LearntChannel, learn_channel, ln_evidence};
use crate::learning::fit::Joint;
use crate::learning::rows::{ChannelRows, GivenThrust, given_columns};
use crate::learning::sums::ChannelSums;
use crate::priors::THRUST_SHARES;
use crate::residuals::segments::PreparedFlights;
use crate::signals::n2_deck::Deck;
use crate::signals::references::DiagnoseError;

/// Times that the deck is learnt: what effects do to N2 is taken by the slopes of the deck before.
const DECK_PASSES: usize = 2;

/// Means of what fuel flow has said, each in its own unit.
struct Given {
    drag: Vec<f64>,
    standing_effects: Vec<f64>,
    remainder: Vec<f64>,
}

impl Given {
    fn at<'a>(&'a self, share: f64, deck: &'a Deck) -> GivenThrust<'a> {
        let Self { drag, standing_effects, remainder } = self;
        GivenThrust { drag, standing_effects, remainder, share, deck }
    }
}

impl Baseline {
    /// The deck, given what fuel flow says of thrust, and what it came to. `deviations` are those that fuel flow was learnt with, before it scaled any.
    ///
    /// ```text
    /// d = V_d (D C⁻¹y − D C⁻¹B β),   cov d = V_d + A cov(β) Aᵀ,   cov(d, β) = −A cov(β),   A = V_d D C⁻¹B        [baseline.4]
    /// ```
    ///
    /// # Source
    /// Liu, Bayarri and Berger 2009, doi 10.1214/09-BA404: modularization.
    pub(super) fn fit_deck(
        &mut self,
        data: &PreparedFlights<'_>,
        joint: &mut Joint,
        deviations: &[f64],
    ) -> Result<LearntChannel, DiagnoseError> {
        let layout = self.layout();
        let terms = layout.deck.len();
        let means = |columns: Range<usize>| -> Vec<f64> {
            columns.map(|column| joint.mean[column] * deviations[column]).collect()
        };
        let means = Given {
            drag: means(layout.drag.clone()),
            standing_effects: means(layout.standing_effects.clone()),
            remainder: means(layout.remainder.clone()),
        };
        self.parts.thrust_share = self.share_that_is_thrust(data, &means, deviations)?;
        let mut at = data.predictor.deck.clone();
        let mut learnt = None;
        for _ in 0..DECK_PASSES {
            let all =
                ChannelRows::of_n2(self, data, deviations, &means.at(self.parts.thrust_share, &at));
            let deck = learn_deck(&all, terms).ok_or(DiagnoseError::Degenerate)?;
            for (k, column) in layout.deck.clone().enumerate() {
                at.coefficients[k] = data.predictor.deck.coefficients[k]
                    + deck.posterior.mean[k] * deviations[column];
            }
            learnt = Some((all, deck));
        }
        let (all, deck) = learnt.ok_or(DiagnoseError::Degenerate)?;
        self.set_noise(2, &deck);
        let given: Vec<usize> = given_columns(&layout).collect();
        let dials = deck.posterior.dials;
        let (gram, _) = ChannelSums::new(&all, &deck.weights).gram(dials.ratio());
        let square = dials.within * dials.within;
        // The lower triangle: rows of what is given, columns of the deck.
        let informed = Mat::from_fn(terms, given.len(), |i, k| gram[(terms + k, i)] / square);
        joint.put_deck(layout.deck, &given, &deck, &informed);
        Ok(deck)
    }

    /// How much of the remainder is thrust: the mean over shares that are as likely before, by the marginal likelihood of N2.
    ///
    /// ```text
    /// φ = Σ φ_i p(N2 | φ_i) / Σ p(N2 | φ_i)                                                          [baseline.6]
    /// ```
    ///
    /// What no flight taught drag may be thrust or what an engine burns for it; fuel flow alone does not say which.
    fn share_that_is_thrust(
        &self,
        data: &PreparedFlights<'_>,
        means: &Given,
        deviations: &[f64],
    ) -> Result<f64, DiagnoseError> {
        let terms = self.layout().deck.len();
        let deck = &data.predictor.deck;
        let rows_at =
            |share: f64| ChannelRows::of_n2(self, data, deviations, &means.at(share, deck));
        // The same weights for all shares, or each would choose its own outliers.
        let weights = learn_deck(&rows_at(THRUST_SHARES[0]), terms);
        let weights = weights.ok_or(DiagnoseError::Degenerate)?.weights;
        let (mut sum, mut shares, mut largest) = (0.0, 0.0, f64::NEG_INFINITY);
        for share in THRUST_SHARES {
            let rows = of_deck(&rows_at(share), terms);
            let ln = ln_evidence(&rows, &vec![0; terms], &weights);
            // Relative to the largest so far.
            let by = (largest - ln.max(largest)).exp();
            largest = largest.max(ln);
            let weight = (ln - largest).exp();
            (sum, shares) = (sum * by + weight, shares * by + weight * share);
        }
        Ok(if sum > 0.0 { shares / sum } else { THRUST_SHARES[0] })
    }
}

/// The rows without what is given.
fn of_deck(all: &ChannelRows, terms: usize) -> ChannelRows {
    all.only(&(0..terms).collect::<Vec<_>>())
}

fn learn_deck(all: &ChannelRows, terms: usize) -> Option<LearntChannel> {
    learn_channel(&of_deck(all, terms), &vec![0; terms])
}

impl Joint {
    /// Puts a deck in place that leans so on what it was given.
    fn put_deck(
        &mut self,
        columns: Range<usize>,
        given: &[usize],
        deck: &LearntChannel,
        informed: &Mat<f64>,
    ) {
        let leaning = &deck.posterior.covariance * informed;
        let width = self.mean.len();
        let of_given = Mat::from_fn(given.len(), width, |k, j| self.covariance[(given[k], j)]);
        let cross = &leaning * &of_given;
        let among = Mat::from_fn(given.len(), columns.len(), |k, i| cross[(i, given[k])]);
        let added = &leaning * &among;
        self.put(&columns.clone().collect::<Vec<_>>(), deck);
        for (i, row) in columns.clone().enumerate() {
            for column in (0..width).filter(|column| !columns.contains(column)) {
                self.covariance[(row, column)] = -cross[(i, column)];
                self.covariance[(column, row)] = -cross[(i, column)];
            }
            for (j, column) in columns.clone().enumerate() {
                self.covariance[(row, column)] += added[(i, j)];
            }
        }
    }
}
