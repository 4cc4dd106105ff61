//! The N2 deck, and how much of the remainder is thrust, given what fuel flow says.

use core::ops::Range;

use faer::Mat;

use crate::baseline::Baseline;
use crate::learning::channel::{FewColumns, LearntChannel, Weighed, learn_channel};
use crate::learning::fit::Joint;
use crate::learning::n2_rows::{GivenThrust, LearntFuelFlow, N2Rows, given_columns};
use crate::learning::rows::ChannelRows;
use crate::learning::sums::through_noise;
use crate::learning::turned::TurnedFlights;
use crate::priors::THRUST_SHARES;
use crate::residuals::segments::PreparedFlights;
use crate::signals::n2_deck::{DECK_TERMS, Deck};
use crate::signals::references::DiagnoseError;

/// Scales of the deck's columns: none.
const GROUPS: [usize; DECK_TERMS] = [0; DECK_TERMS];

impl Baseline {
    /// The deck, given what fuel flow says of thrust, and what it came to. `deviations` are those that fuel flow was learnt with,
    /// before it scaled any, `fuel` its rows.
    ///
    /// ```text
    /// d = V_d (D C⁻¹y − D C⁻¹B β),   cov d = V_d + A cov(β) Aᵀ,   cov(d, β) = −A cov(β),   A = V_d D C⁻¹B        [baseline.4]
    /// ```
    ///
    /// It is learnt twice: what effects do to N2 is taken by the slopes of the deck before.
    ///
    /// # Source
    /// Liu, Bayarri and Berger 2009, doi 10.1214/09-BA404: modularization.
    pub(super) fn fit_deck(
        &mut self,
        data: &PreparedFlights<'_>,
        joint: &mut Joint,
        deviations: &[f64],
        fuel: &ChannelRows,
    ) -> Result<LearntChannel, DiagnoseError> {
        let layout = self.layout();
        let before = &data.predictor.deck;
        let learnt = LearntFuelFlow { layout: &layout, rows: fuel, deviations, means: &joint.mean };
        let rows = N2Rows::new(data, learnt);
        // N2 errs alike, whatever it is asked.
        let mut turned = TurnedFlights::default();
        let share = share_that_is_thrust(&rows, before, &mut turned);
        let share = share.ok_or(DiagnoseError::Degenerate)?;
        self.parts.thrust_share = share;
        let found = first_deck(&rows.of_deck(&GivenThrust { share, deck: before }), &mut turned);
        let found = found.ok_or(DiagnoseError::Degenerate)?;
        let first = moved(before, &found, &deviations[layout.deck.clone()]);
        let given = GivenThrust { share, deck: &first };
        let of_deck = rows.of_deck(&given);
        let deck =
            learn_channel(&of_deck, &GROUPS, &mut turned).ok_or(DiagnoseError::Degenerate)?;
        self.set_noise(2, &deck);
        let dials = deck.posterior.dials;
        let through = through_noise(&of_deck, &deck.weights, dials.ratio(), &mut turned);
        let square = dials.within * dials.within;
        let informed = faer::Scale(1.0 / square) * (through.transpose() * rows.of_given(&given));
        let columns: Vec<usize> = given_columns(&layout).collect();
        joint.put_deck(layout.deck, &columns, &deck, &informed);
        Ok(deck)
    }
}

/// A deck so far from another, in prior standard deviations.
fn moved(from: &Deck, by: &[f64], deviations: &[f64]) -> Deck {
    let mut deck = from.clone();
    for (slot, (size, deviation)) in deck.coefficients.iter_mut().zip(by.iter().zip(deviations)) {
        *slot += size * deviation;
    }
    deck
}

/// Coefficients of the deck at the likeliest noise, in prior standard deviations.
fn first_deck(of_deck: &ChannelRows, turned: &mut TurnedFlights) -> Option<Vec<f64>> {
    let few = FewColumns::of(of_deck, &GROUPS);
    few.coefficients(&few.weigh(turned)?, &GROUPS)
}

/// How much of the remainder is thrust: the mean over shares that are as likely before, by the marginal likelihood of N2. `None`
/// where matrices are not positive definite.
///
/// ```text
/// φ = Σ φ_i p(N2 | φ_i) / Σ p(N2 | φ_i)                                                          [baseline.6]
/// ```
///
/// What no flight taught drag may be thrust or what an engine burns for it; fuel flow alone does not say which.
fn share_that_is_thrust(rows: &N2Rows<'_>, deck: &Deck, turned: &mut TurnedFlights) -> Option<f64> {
    let few_at = |share: f64| FewColumns::of(&rows.of_deck(&GivenThrust { share, deck }), &GROUPS);
    let mut few = few_at(THRUST_SHARES[0]);
    // The same weights for all shares, or each would choose its own outliers.
    let Weighed { weights, mut dials, .. } = few.weigh(turned)?;
    let (mut sum, mut shares, mut largest) = (0.0, 0.0, f64::NEG_INFINITY);
    for (at, share) in THRUST_SHARES.into_iter().enumerate() {
        if at > 0 {
            few = few_at(share);
        }
        let ln;
        (ln, dials) = few.ln_evidence(&weights, dials, turned);
        // Relative to the largest so far.
        let by = (largest - ln.max(largest)).exp();
        largest = largest.max(ln);
        let weight = (ln - largest).exp();
        (sum, shares) = (sum * by + weight, shares * by + weight * share);
    }
    Some(if sum > 0.0 { shares / sum } else { THRUST_SHARES[0] })
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
