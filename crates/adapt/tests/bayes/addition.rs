//! States are added, age, and are refused where they do not belong together.

use adapt::bayes::{
    BayesSettings, BayesState, BayesStateData, MergeError, SettingValues, StateDataError,
};
use flight::Timestamp;
use lut::Table;

use crate::fleet::{Fleet, Flights, SENSOR_NOISE, believed_drag, grid, learnt, table, times};

fn settings_with_half_life(days: f64) -> BayesSettings {
    let values = SettingValues {
        half_life_days: Some(days),
        // Gaussian: weights do not depend on what was learnt before.
        student_degrees_of_freedom: 1e6,
        ..*BayesSettings::physical_2026().values()
    };
    BayesSettings::new(values).unwrap()
}

fn initial() -> Table {
    table(&grid(0.05, 0.95), believed_drag)
}

fn forty_flights() -> Flights {
    Fleet::new(800).flights(40, SENSOR_NOISE, times(&initial(), 1.03))
}

#[track_caller]
fn assert_same(a: &BayesState, b: &BayesState, tolerance: f64) {
    let (a, b) = (a.solve().unwrap(), b.solve().unwrap());
    let of_a = a.correction().iter().chain(a.standard_deviation()).chain(a.observations());
    let of_b = b.correction().iter().chain(b.standard_deviation()).chain(b.observations());
    for (a, b) in of_a.zip(of_b) {
        assert!((a - b).abs() <= tolerance * a.abs().max(1.0), "{a} {b}");
    }
}

/// Adapting 1 to 20 and 21 to 40 apart and adding equals adapting 1 to 40; with Student weights up to those.
#[test]
fn halves_add_up_to_the_whole() {
    let (initial, flights) = (initial(), forty_flights());
    let gaussian = SettingValues {
        student_degrees_of_freedom: 1e6,
        ..*BayesSettings::physical_2026().values()
    };
    let student = BayesSettings::physical_2026();
    for (settings, tolerance) in [(BayesSettings::new(gaussian).unwrap(), 2e-6), (student, 3e-3)] {
        let whole = learnt(&initial, settings, &flights);
        let (first, second) = flights.split_at(20);
        let mut forth = learnt(&initial, settings, first);
        let mut back = learnt(&initial, settings, second);
        let (one, other) = (forth.clone(), back.clone());
        forth.merge(&other).unwrap();
        back.merge(&one).unwrap();
        assert_same(&forth, &back, 1e-9);
        let (a, b) = (forth.solve().unwrap(), whole.solve().unwrap());
        for (a, b) in a.correction().iter().zip(b.correction()) {
            assert!((a - b).abs() < tolerance, "{a} {b}");
        }
        assert_eq!((forth.flights(), forth.segments()), (whole.flights(), whole.segments()));
        assert_eq!(forth.newest(), whole.newest());
    }
}

/// A state that learnt no segment, as of flights outside the table, takes over the instant from which on the other's knowledge ages.
#[test]
fn nothing_and_something_is_something() {
    let (initial, flights) = (initial(), forty_flights());
    let settings = settings_with_half_life(20.0);
    let something = learnt(&initial, settings, &flights[..5]);
    let nothing = BayesState::new(&initial, settings).unwrap();
    let (mut forth, mut back) = (something.clone(), nothing.clone());
    forth.merge(&nothing).unwrap();
    back.merge(&something).unwrap();
    assert_same(&forth, &back, 1e-12);
    assert_eq!((forth.newest(), back.newest()), (something.newest(), something.newest()));
}

#[test]
fn merging_is_associative() {
    let (initial, flights) = (initial(), forty_flights());
    let settings = settings_with_half_life(20.0);
    let parts: Vec<BayesState> =
        flights.chunks(14).map(|part| learnt(&initial, settings, part)).collect();
    let [a, b, c] = &parts[..] else { panic!() };
    let mut left = a.clone();
    left.merge(b).unwrap();
    left.merge(c).unwrap();
    let mut right = c.clone();
    right.merge(b).unwrap();
    right.merge(a).unwrap();
    assert_same(&left, &right, 1e-9);
}

#[test]
fn what_does_not_belong_together_is_refused_by_name() {
    let flights = forty_flights();
    let physical = BayesSettings::physical_2026();
    let mut state = learnt(&initial(), physical, &flights);
    let before = state.clone();

    let other_grid = learnt(&table(&grid(0.1, 0.9), believed_drag), physical, &flights);
    assert_eq!(state.merge(&other_grid), Err(MergeError::GridsDiffer));
    let thicker = table(&grid(0.05, 0.95), |c, m| 1.01 * believed_drag(c, m));
    let refused = state.merge(&learnt(&thicker, physical, &flights));
    assert!(matches!(refused, Err(MergeError::InitialsDiffer { node: 0, .. })), "{refused:?}");
    let refused = state.merge(&learnt(&initial(), settings_with_half_life(365.0), &flights));
    assert_eq!(
        refused.unwrap_err().to_string(),
        "setting student_degrees_of_freedom is 4 here and 1000000 there"
    );
    let aged = SettingValues { half_life_days: Some(365.0), ..*physical.values() };
    let refused = state.merge(&learnt(&initial(), BayesSettings::new(aged).unwrap(), &flights));
    assert_eq!(
        refused.unwrap_err().to_string(),
        "setting half_life_days is inf here and 365 there"
    );
    assert_eq!(state, before);
}

/// A half-life halves the information: of one flight, (prior − posterior precision) is half after it.
#[test]
fn knowledge_halves_in_a_half_life() {
    let (initial, flights) = (initial(), forty_flights());
    let settings = settings_with_half_life(365.0);
    let state = learnt(&initial, settings, &flights[..1]);
    let day = 86_400;
    let mut aged = state.clone();
    let newest = state.newest().unwrap().as_second();
    aged.decay_to(Timestamp::from_second(newest + 365 * day).unwrap());
    let counts = |state: &BayesState| state.solve().unwrap().observations().to_vec();
    for (young, old) in counts(&state).into_iter().zip(counts(&aged)) {
        assert!((old - young / 2.0).abs() < 1e-12);
    }
    let entries = |state: &BayesState| state.to_data().information.concat();
    for (young, old) in entries(&state).into_iter().zip(entries(&aged)) {
        assert!((old - young / 2.0).abs() <= 1e-12 * young.abs());
    }
    // Not after the newest: nothing changes.
    let mut same = state.clone();
    same.decay_to(Timestamp::from_second(newest - day).unwrap());
    assert_eq!(same, state);
}

/// With a half-life, too, the order of flights does not matter.
#[test]
fn the_order_of_flights_does_not_matter() {
    let (initial, flights) = (initial(), forty_flights());
    let settings = settings_with_half_life(30.0);
    let reversed: Flights = flights.iter().rev().cloned().collect();
    let (forth, back) =
        (learnt(&initial, settings, &flights), learnt(&initial, settings, &reversed));
    // The weights of a Student with 10^6 degrees of freedom differ by about 10^-6.
    assert_same(&forth, &back, 1e-5);
}

#[test]
fn files_give_back_every_bit() {
    let (initial, flights) = (initial(), forty_flights());
    let settings = settings_with_half_life(1000.0);
    let state = learnt(&initial, settings, &flights);
    let text = ron::to_string(&(state.settings(), state.to_data())).unwrap();
    let (read, data): (BayesSettings, BayesStateData) = ron::from_str(&text).unwrap();
    let again = BayesState::from_data(&initial, read, data).unwrap();
    assert_eq!(again.to_data(), state.to_data());
    let drag = |state: &BayesState| state.solve().unwrap().drag().clone();
    assert_eq!(drag(&again), drag(&state));
    let nothing = BayesState::new(&initial, settings).unwrap();
    let back = BayesState::from_data(&initial, settings, nothing.to_data()).unwrap();
    assert_eq!(back, nothing);
}

type Damage = fn(&mut BayesStateData);

#[test]
fn damaged_files_are_refused() {
    let initial = initial();
    let settings = BayesSettings::physical_2026();
    let good = learnt(&initial, settings, &forty_flights()).to_data();
    let damages: [(Damage, &str); 7] = [
        (|data| data.vector.truncate(3), "vector of what was learnt has 3 entries, expected"),
        (|data| data.judge.push(0.0), "judge of what was learnt has 28 entries, expected 27"),
        (|data| data.nodes[1] = data.nodes[0], "out of order"),
        (|data| *data.nodes.last_mut().unwrap() = 150, "touched node 150 is out of order or not"),
        (
            |data| data.information[2] = vec![0.0; 4],
            "row 2 of the information has 4 entries, outside 0 to 3",
        ),
        (|data| data.observations[0] = -1.0, "observations of what was learnt has the value -1"),
        (|data| data.newest = None, "the newest instant"),
    ];
    for (damage, message) in damages {
        let mut data = good.clone();
        damage(&mut data);
        let refusal = BayesState::from_data(&initial, settings, data).unwrap_err();
        assert!(refusal.to_string().contains(message), "{refusal}");
    }
    let mut data = good;
    data.information[0][0] = f64::NAN;
    let refusal = BayesState::from_data(&initial, settings, data).unwrap_err();
    assert!(matches!(refusal, StateDataError::Value { list: "information", .. }), "{refusal:?}");
    // Finite but not an information matrix: detected when solving.
    let mut data = learnt(&initial, settings, &forty_flights()).to_data();
    data.information[0][0] = -1e9;
    let state = BayesState::from_data(&initial, settings, data).unwrap();
    assert!(state.solve().is_err());
}
