//! What a baseline is uncertain about, in the design.

use flight::effect::EffectId;
use test_support::fleet::{Background, Planted, Setup, fly, typical};

use crate::baseline::Baseline;
use crate::hypotheses::design::Design;
use crate::learning::tests::with_exact_table;
use crate::residuals::predictor::with_thrust;
use crate::residuals::segments::PreparedFlights;
use crate::signals::channels::MAXIMUM_CHANNELS;

/// A baseline of thirty flights whose drag follows Reynolds number, which no table does, and those flights held against it.
fn taught_by_thinner_air(work: impl FnOnce(&Baseline, &PreparedFlights<'_>)) {
    let setup = Setup { flights: 30, ..Setup::default() };
    let size = 6.0 * typical(EffectId::ReynoldsNumber);
    let planted = Planted { id: EffectId::ReynoldsNumber, size };
    let fleet = fly(95, &setup, &[planted], &Background::default());
    with_exact_table(&fleet.flights, work);
}

/// What is uncertain about a baseline, as the design has it: moved along any one of its directions, fuel flow and N2 change as the
/// column says (finite differences).
#[test]
fn columns_of_a_baseline_are_what_its_uncertainty_does_to_every_channel() {
    const STEP: f64 = 1e-3;
    taught_by_thinner_air(|taught, data| {
        assert!(taught.thrust_share() > 0.5);
        let mut plain = data.clone();
        for row in &mut plain.segments {
            row.noise.factor = [[0.0; MAXIMUM_CHANNELS]; MAXIMUM_CHANNELS];
            for channel in 0..MAXIMUM_CHANNELS {
                row.noise.factor[channel][channel] = 1.0;
            }
        }
        let design = Design::new(&plain, taught.references(), Some(taught), None);
        let layout = taught.layout();
        let n2 = data.channels.n2_row();
        for column in layout.remainder.clone().step_by(7) {
            let moved = |by: f64| {
                let mut moved = taught.clone();
                for (k, mean) in moved.parts.mean[layout.remainder.clone()].iter_mut().enumerate() {
                    *mean += by * taught.factor[(k, column)];
                }
                moved
            };
            let (up, down) = (moved(STEP), moved(-STEP));
            let flight = &plain.flights[0];
            let rows = design.within_segments(&plain, flight);
            let channels = data.channels.count();
            for (at, segment) in flight.segments.clone().enumerate() {
                let row = &plain.segments[segment];
                let deck = |of: &Baseline| {
                    // The deck as it was, and what moved with the column of its own coefficients.
                    let thrust = with_thrust(&row.response, of.thrust_at(&row.response));
                    data.predictor.deck.value(&thrust)
                };
                let of_deck: f64 = layout
                    .deck
                    .clone()
                    .zip(row.deck)
                    .map(|(k, term)| term * taught.factor[(k, column)])
                    .sum();
                let of_standing = |channel: usize| -> f64 {
                    let columns = layout.standing_effects.clone().zip(&row.standing_effects);
                    columns.map(|(k, slope)| slope[channel] * taught.factor[(k, column)]).sum()
                };
                let change = |of: &dyn Fn(&Baseline) -> f64| (of(&up) - of(&down)) / (2.0 * STEP);
                let fuel = change(&|of| of.mean_at(&row.response)) + of_standing(0);
                let speed = change(&deck) + of_deck + of_standing(n2);
                let place = design.nuisance.start + column;
                for (channel, expected) in [(0, fuel), (n2, speed)] {
                    let found = rows[(at * channels + channel, place)];
                    assert!(
                        (found - expected).abs() < 1e-6 + 1e-3 * expected.abs(),
                        "{column} {channel}: {found} {expected}"
                    );
                }
            }
        }
    });
}
