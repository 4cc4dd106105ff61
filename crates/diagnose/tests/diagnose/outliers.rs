//! Absurd recordings name nothing and hide nothing.
#![expect(clippy::unwrap_used, reason = "a test")]

use diagnose::{Diagnosis, FlightRecord, Input, LeftOutReason, Options, Verdict, diagnose};
use flight::Segment;
use flight::effect::EffectId;
use test_support::Random;
use test_support::fleet::{Background, Planted, Setup, exact_model, fly};

fn diagnosed(flights: &[Vec<Segment>]) -> Diagnosis {
    let records: Vec<FlightRecord<'_>> =
        flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let options = Options { skip_closure: true, skip_where: true, ..Options::default() };
    diagnose(&Input::against(&exact_model(), &records), &options).unwrap()
}

fn flown(seed: u64, planted: &[Planted]) -> Vec<Vec<Segment>> {
    let setup = Setup { flights: 40, ..Setup::default() };
    fly(seed, &setup, planted, &Background::default()).flights
}

fn burn(segment: &mut Segment, by: f64) {
    segment.means.fuel_flow_total_kg_s *= by;
    for flow in &mut segment.means.fuel_flow_engine_kg_s {
        *flow *= by;
    }
}

/// Makes recordings of a seed absurd.
type Spoil = fn(u64, &mut [Vec<Segment>]);

/// What is absurd in the recordings.
const ABSURD: [Spoil; 5] = [
    // Two segments in a hundred at random, then five and ten that are off by 10 %.
    |seed, flights| some(seed, flights, 0.02, |random| (random.normal(0.0, 0.04)).exp()),
    |seed, flights| some(seed, flights, 0.05, up_or_down),
    |seed, flights| some(seed, flights, 0.10, up_or_down),
    // One segment tenfold; one whole flight.
    |_, flights| burn(&mut flights[13][4], 10.0),
    |_, flights| flights[20].iter_mut().for_each(|segment| burn(segment, 1.10)),
];

fn up_or_down(random: &mut Random) -> f64 {
    if random.uniform(0.0, 1.0) < 0.5 { 1.1 } else { 0.9 }
}

fn some(seed: u64, flights: &mut [Vec<Segment>], share: f64, by: fn(&mut Random) -> f64) {
    let mut random = Random::new(seed, 99);
    for segment in flights.iter_mut().flatten() {
        if random.uniform(0.0, 1.0) < share {
            burn(segment, by(&mut random));
        }
    }
}

#[test]
fn absurd_recordings_name_nothing() {
    for (kind, spoil) in ABSURD.into_iter().enumerate() {
        for seed in 520..524 {
            let mut flights = flown(seed, &[]);
            spoil(seed, &mut flights);
            let found = diagnosed(&flights);
            assert_eq!(found.verdict, Verdict::NoGap, "kind {kind}, seed {seed}");
            assert!(found.left_out[&LeftOutReason::Outlier] > 0, "kind {kind}, seed {seed}");
        }
    }
}

/// The effect that is there is in the class of the verdict, and the interval of its size holds the truth as often as it states:
/// of twenty at 95 % fewer than sixteen have a probability of 0.3 %.
#[test]
fn absurd_recordings_hide_nothing() {
    // Without gauges an engine's meter looks nearly the same: the finding is the class.
    let planted = Planted { id: EffectId::TsfcEngine(2), size: 3.0 };
    let mut held = 0;
    for (kind, spoil) in ABSURD.into_iter().enumerate() {
        for seed in 510..514 {
            let mut flights = flown(seed, &[planted]);
            spoil(seed, &mut flights);
            let found = diagnosed(&flights);
            let Verdict::Effects(named) = &found.verdict else {
                panic!("kind {kind}, seed {seed}: {:?}", found.verdict);
            };
            assert!(named.class.contains(&planted.id), "kind {kind}, seed {seed}: {named:?}");
            let cause = found.causes.iter().find(|cause| cause.effect == planted.id).unwrap();
            let [low, high] = cause.magnitude.ci95;
            held += usize::from(low < 3.0 && 3.0 < high);
        }
    }
    assert!(held >= 16, "{held} of 20 intervals hold the truth");
}
