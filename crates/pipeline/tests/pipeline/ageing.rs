//! A half-life lets the whole model follow an aircraft that changes.
#![expect(clippy::unwrap_used, reason = "a test")]

use adapt::bayes::{BayesSettings, SettingValues};
use diagnose::WholeModel;
use flight::Segment;
use pipeline::learning::{LawChoice, begin, remember_remainder};
use test_support::fleet::{Background, Setup, exact_model, fly};
use units::convert::SECONDS_PER_DAY;

/// Every flight from the middle on burns so much more.
const MORE: f64 = 0.03;

/// Mean of ln recorded less ln predicted fuel flow, over flights that burn more, by a model that all others taught.
fn left_of_more(flights: &[Vec<Segment>], half_life_days: Option<f64>) -> f64 {
    let (teaching, judging) = flights.split_at(40);
    let initial = exact_model();
    let values = SettingValues { half_life_days, ..*BayesSettings::physical_2026().values() };
    let law = LawChoice::Bayes(BayesSettings::new(values).unwrap());
    let mut learnt = begin(&initial, "V-01", "standard", law).unwrap();
    remember_remainder((&initial, None), &mut learnt, &teaching.concat());
    let whole = WholeModel::new(&initial, learnt.baseline.as_ref().unwrap()).unwrap();
    let judging = judging.concat();
    let gap = |segment: &Segment| {
        let predicted = whole.of_segment(segment).unwrap().ln_fuel_flow;
        segment.means.fuel_flow_total_kg_s.ln() - predicted
    };
    judging.iter().map(gap).sum::<f64>() / judging.len() as f64
}

/// Without a half-life twenty flights of each kind make a mean: half of the change is left (arithmetic). With one of four
/// flights those before the change count 2⁻⁵ to 0 of one, some 4 % in all.
#[test]
fn what_is_old_fades() {
    let setup = Setup { flights: 60, segments: 8, ..Setup::default() };
    let mut fleet = fly(821, &setup, &[], &Background::default());
    for segment in fleet.flights[20..].iter_mut().flatten() {
        segment.means.fuel_flow_total_kg_s *= 1.0 + MORE;
        for flow in &mut segment.means.fuel_flow_engine_kg_s {
            *flow *= 1.0 + MORE;
        }
    }
    let start_s = |flight: usize| fleet.flights[flight][0].identity.start_s();
    let days_a_flight = (start_s(39) - start_s(0)) / SECONDS_PER_DAY / 39.0;
    let change = (1.0 + MORE).ln();
    let never = left_of_more(&fleet.flights, None) / change;
    assert!((never - 0.5).abs() < 0.15, "{never}");
    let fading = left_of_more(&fleet.flights, Some(4.0 * days_a_flight)) / change;
    assert!(fading.abs() < 0.15, "{fading}");
}
