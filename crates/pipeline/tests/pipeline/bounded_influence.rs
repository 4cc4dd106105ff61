//! What absurd recordings among forty flights do to predictions of the whole model: their influence stays below what the model
//! states that it does not know, however absurd they are.
#![expect(clippy::unwrap_used, reason = "a test")]

use adapt::bayes::BayesSettings;
use diagnose::{WholeModel, WholePrediction};
use flight::Segment;
use pipeline::learning::{LawChoice, begin, remember_remainder};
use test_support::fleet::{Background, Setup, exact_model, fly};

const TEACHING: usize = 40;

/// Predictions for every judging segment, by a model that these flights taught.
fn predicted(teaching: &[Vec<Segment>], judging: &[Segment]) -> Vec<WholePrediction> {
    let initial = exact_model();
    let law = LawChoice::Bayes(BayesSettings::physical_2026());
    let mut learnt = begin(&initial, "V-01", "standard", law).unwrap();
    remember_remainder((&initial, None), &mut learnt, &teaching.concat());
    let baseline = learnt.baseline.as_ref().unwrap();
    let whole = WholeModel::new(&initial, baseline).unwrap();
    judging.iter().map(|segment| whole.of_segment(segment).unwrap()).collect()
}

/// How far predictions of a model that spoilt flights taught are from those of one that was taught without what was spoilt, and
/// what the latter states of itself.
#[derive(Debug)]
struct Influence {
    /// Root mean square of the difference, relative.
    shift: f64,
    /// Root mean square of the model's own standard deviations.
    stated: f64,
    /// Standard deviation stated of a segment over the same of the other model, root mean squares.
    wider: f64,
}

/// `spoil` states of every segment, by flight and place, by what factor its fuel flow is off.
fn influence(seed: u64, spoil: impl Fn(usize, usize) -> Option<f64>) -> Influence {
    influence_of(TEACHING, seed, spoil)
}

/// The same of so many flights that teach.
fn influence_of(
    teaching: usize,
    seed: u64,
    spoil: impl Fn(usize, usize) -> Option<f64>,
) -> Influence {
    let setup = Setup { flights: 60, segments: 8, ..Setup::default() };
    let background = Background { field: 0.01, ..Background::default() };
    let fleet = fly(seed, &setup, &[], &background);
    let judging = fleet.flights[TEACHING..].concat();
    let teaching = &fleet.flights[..teaching];
    let (mut spoilt, mut without) = (teaching.to_vec(), teaching.to_vec());
    for (flight, segments) in spoilt.iter_mut().enumerate() {
        for (place, segment) in segments.iter_mut().enumerate() {
            burn_more(segment, spoil(flight, place).unwrap_or(1.0));
        }
        let mut place = 0;
        without[flight].retain(|_| {
            place += 1;
            spoil(flight, place - 1).is_none()
        });
    }
    let (spoilt, without) = (predicted(&spoilt, &judging), predicted(&without, &judging));
    let pairs = || spoilt.iter().zip(&without);
    let rms = |squares: f64| (squares / judging.len() as f64).sqrt();
    let off = pairs().map(|(a, b)| a.ln_fuel_flow - b.ln_fuel_flow);
    let shift = rms(off.map(|off| off * off).sum());
    let deviation = |of: &[WholePrediction]| rms(of.iter().map(WholePrediction::variance).sum());
    Influence {
        shift,
        stated: rms(without.iter().map(WholePrediction::of_model).sum()),
        wider: deviation(&spoilt) / deviation(&without),
    }
}

fn burn_more(segment: &mut Segment, factor: f64) {
    segment.means.fuel_flow_total_kg_s *= factor;
    for flow in &mut segment.means.fuel_flow_engine_kg_s {
        *flow *= factor;
    }
}

/// A flight that counts fully would move a mean over forty by 0.75 and 10 %.
#[test]
fn one_absurd_flight_of_forty() {
    for seed in [811, 812] {
        for factor in [1.3, 5.0] {
            let found = influence(seed, |flight, _| (flight == 17).then_some(factor));
            assert!(found.shift < 0.5 * found.stated, "{factor}: {found:?}");
        }
    }
}

/// A flight that counts fully would be the scatter between ten or twenty, and every interval as wide as it is absurd: by 30 times
/// and more at five times the fuel flow.
#[test]
fn one_absurd_flight_of_ten_leaves_intervals_alone() {
    for seed in [811, 812] {
        for (teaching, factor) in [(10, 1.3), (10, 5.0), (20, 0.7), (20, 5.0)] {
            let found = influence_of(teaching, seed, |flight, _| (flight == 5).then_some(factor));
            let ratio = found.wider;
            assert!((0.5..1.5).contains(&ratio), "{teaching} flights, {factor}: {found:?}");
        }
    }
}

/// A segment that counts fully would move a mean over 320 by 3 %.
#[test]
fn one_segment_with_ten_times_the_fuel_flow() {
    for seed in [811, 812] {
        let found = influence(seed, |flight, place| ((flight, place) == (5, 3)).then_some(10.0));
        assert!(found.shift < 0.5 * found.stated, "{found:?}");
    }
}

/// A mean over all segments would move by 1 %: half of that at most, and no more than twice what the model states.
#[test]
fn one_segment_in_ten_off_by_ten_per_cent() {
    for seed in [811, 812] {
        let found =
            influence(seed, |flight, place| ((8 * flight + place) % 10 == 3).then_some(1.1));
        assert!(found.shift < 0.005 && found.shift < 2.0 * found.stated, "{found:?}");
    }
}
