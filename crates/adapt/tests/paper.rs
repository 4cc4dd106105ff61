//! Law `paper` on small tables: cases written out by hand, limits, order, and what it leaves unchanged.
#![expect(clippy::unwrap_used, reason = "a test")]
#![expect(clippy::float_cmp, reason = "what is left alone or replaced is so to the bit")]

use std::sync::Arc;

use adapt::paper::{NodeChange, PaperLaw, State, StateError, Update, error_percent};
use flight::{Observation, ObservationVariance, Timestamp};
use lut::{Axis, Grid, Outside, Table};
use proptest::prelude::*;

/// Nine nodes, drag coefficient 0.030 everywhere.
fn grid() -> Arc<Grid> {
    let lift_coefficient = Axis::new(vec![0.3, 0.4, 0.5]).unwrap();
    let mach = Axis::new(vec![0.7, 0.8, 0.9]).unwrap();
    Arc::new(Grid::new(lift_coefficient, mach))
}

fn flat() -> State {
    State::new(Table::new(grid(), vec![0.030; 9]).unwrap())
}

/// Without acceleration, fuel flow is slope times drag coefficient: `ε = 100 (CD − CD_table)/CD`.
fn observation(lift_coefficient: f64, mach: f64, drag_coefficient: f64) -> Observation {
    let fuel_flow_per_drag_coefficient_kg_s = 10.0;
    Observation {
        time: Timestamp::UNIX_EPOCH,
        lift_coefficient,
        mach,
        drag_coefficient,
        fuel_flow_total_kg_s: fuel_flow_per_drag_coefficient_kg_s * drag_coefficient,
        fuel_flow_per_drag_coefficient_kg_s,
        variance: ObservationVariance { segment: 1e-4, flight: 1e-4 },
    }
}

fn changes(update: &Update) -> Vec<NodeChange> {
    update.changes().copied().collect()
}

fn error_after(state: &State, observation: &Observation) -> f64 {
    let cell = state
        .grid()
        .locate(observation.lift_coefficient, observation.mach, Outside::Error)
        .unwrap();
    error_percent(state.drag_coefficient(), &cell, observation)
}

/// Checks 2 and 3 of the reconstruction: the first touch gives all four nodes the observed drag coefficient, leaves no
/// error at the point, and confidence 2 − δ.
///
/// By hand at (0.43, 0.74) in the cell 0.4..0.5 × 0.7..0.8 of diagonal √0.02: squared distances to the nodes
/// 0.03² + 0.04² = 0.0025, 0.03² + 0.06² = 0.0045, 0.07² + 0.04² = 0.0065, 0.07² + 0.06² = 0.0085;
/// δ² = 0.125, 0.225, 0.325, 0.425. ε = 100·(0.033 − 0.030)/0.033 = 9.0909… %.
#[test]
fn first_touch_by_hand() {
    let mut state = flat();
    let observed = observation(0.43, 0.74, 0.033);
    let update = PaperLaw::ghazi_2020().adapt(&mut state, &observed);
    assert!((update.error_percent().unwrap() - 100.0 / 11.0).abs() < 1e-12);
    let changed = changes(&update);
    assert_eq!(changed.iter().map(|change| change.node).collect::<Vec<_>>(), [3, 4, 6, 7]);
    for (change, square) in changed.iter().zip([0.125, 0.225, 0.325, 0.425_f64]) {
        assert!((change.normalized_distance - square.sqrt()).abs() < 1e-14);
        assert_eq!((change.drag_coefficient_before, change.confidence_before), (0.030, 1.0));
        assert_eq!(change.drag_coefficient_after, 0.033);
        assert!((change.confidence_after - (2.0 - square.sqrt())).abs() < 1e-14);
        assert_eq!(state.drag_coefficient().value_at_node(change.node), 0.033);
        assert_eq!(state.confidence().value_at_node(change.node), change.confidence_after);
    }
    for node in [0, 1, 2, 5, 8] {
        assert_eq!(state.drag_coefficient().value_at_node(node), 0.030);
        assert_eq!(state.confidence().value_at_node(node), 1.0);
    }
    assert!(error_after(&state, &observed).abs() < 1e-13);
}

/// A second touch at the cell's center, where every δ is 1/2, after a first one there: λ = 1.5, δ^λ = 0.5^1.5 = 0.353553,
/// ka = 0.5/0.646447 = 0.773459, kc = 0.226541. From 0.033 to 0.036: 0.226541·0.033 + 0.773459·0.036 = 0.035320377;
/// λ becomes 2. The third, with λ = 2 and ka = 2/3, back to 0.030: 0.035320377/3 + 0.02 = 0.031773459; λ becomes 2.5.
#[test]
fn second_and_third_touch_by_hand() {
    let mut state = flat();
    let law = PaperLaw::ghazi_2020();
    for (drag_coefficient, value, confidence) in
        [(0.033, 0.033, 1.5), (0.036, 0.035_320_377, 2.0), (0.030, 0.031_773_459, 2.5)]
    {
        let update = law.adapt(&mut state, &observation(0.35, 0.85, drag_coefficient));
        let changed = changes(&update);
        assert_eq!(changed.len(), 4);
        for change in changed {
            assert!((change.drag_coefficient_after - value).abs() < 1e-9);
            assert!((change.confidence_after - confidence).abs() < 1e-12);
        }
    }
}

/// Check 10: 4.99 % changes nothing, 5.01 % does. Without acceleration ε = 100 (1 − 0.030/CD).
#[test]
fn dead_band() {
    let law = PaperLaw::ghazi_2020();
    for (error, adapts) in [(4.99, false), (5.01, true), (-4.99, false), (-5.01, true)] {
        let mut state = flat();
        let update = law.adapt(&mut state, &observation(0.43, 0.74, 0.030 / (1.0 - error / 100.0)));
        assert!((update.error_percent().unwrap() - error).abs() < 1e-10);
        assert_eq!(matches!(update, Update::Adapted { .. }), adapts);
        assert_eq!(state == flat(), !adapts);
    }
}

/// Numbers without rounding: table 0.5, observed 0.75, slope and fuel flow 1, so ε = 25 exactly. At the threshold
/// nothing happens; it must be exceeded.
#[test]
fn an_error_at_the_threshold_does_not_exceed_it() {
    let state = || State::new(Table::new(grid(), vec![0.5; 9]).unwrap());
    for (observed, error) in [(0.75, 25.0), (0.25, -25.0)] {
        let exact = Observation {
            fuel_flow_total_kg_s: 1.0,
            fuel_flow_per_drag_coefficient_kg_s: 1.0,
            ..observation(0.4, 0.8, observed)
        };
        let mut at = state();
        let update = PaperLaw::new(25.0).unwrap().adapt(&mut at, &exact);
        assert_eq!(update, Update::WithinDeadBand { error_percent: error });
        assert_eq!(at, state());
        let mut above = state();
        let update = PaperLaw::new(25.0_f64.next_down()).unwrap().adapt(&mut above, &exact);
        assert!(matches!(update, Update::Adapted { .. }));
    }
}

/// A threshold of 0 adapts to any error, but not to an error of 0.
#[test]
fn a_threshold_of_0() {
    let law = PaperLaw::new(0.0).unwrap();
    let mut state = flat();
    assert!(matches!(
        law.adapt(&mut state, &observation(0.4, 0.8, 0.030)),
        Update::WithinDeadBand { error_percent: 0.0 }
    ));
    assert!(matches!(
        law.adapt(&mut state, &observation(0.4, 0.8, 0.0301)),
        Update::Adapted { .. }
    ));
}

/// Our deviation from the print: a node without weight keeps its value, so it does not matter which of two cells a
/// point on a grid line belongs to.
#[test]
fn nodes_of_no_weight_are_left_alone() {
    let law = PaperLaw::ghazi_2020();
    let on_node = law.adapt(&mut flat(), &observation(0.4, 0.8, 0.033));
    let [change] = changes(&on_node)[..] else { panic!("{on_node:?}") };
    assert_eq!((change.node, change.normalized_distance), (4, 0.0));
    assert_eq!((change.drag_coefficient_after, change.confidence_after), (0.033, 2.0));

    let on_line = law.adapt(&mut flat(), &observation(0.4 + 0.9e-9, 0.84, 0.033));
    assert_eq!(changes(&on_line).iter().map(|c| c.node).collect::<Vec<_>>(), [4, 5]);
    let last_line = law.adapt(&mut flat(), &observation(0.5, 0.84, 0.033));
    assert_eq!(changes(&last_line).iter().map(|c| c.node).collect::<Vec<_>>(), [7, 8]);

    // Just off the line the far nodes have a weight of 2e-8·0.6 and 2e-8·0.4: they take part.
    let off_line = law.adapt(&mut flat(), &observation(0.4 + 2e-9, 0.84, 0.033));
    assert_eq!(changes(&off_line).len(), 4);
    // Off two lines by 3e-9 the opposite node has a weight of 9e-16, its neighbors 3e-8.
    let near_node = law.adapt(&mut flat(), &observation(0.4 + 3e-9, 0.8 + 3e-9, 0.033));
    assert_eq!(changes(&near_node).iter().map(|c| c.node).collect::<Vec<_>>(), [4, 5, 7]);
}

#[test]
fn outside_the_grid_nothing_is_learnt() {
    for (lift_coefficient, mach) in [(0.29, 0.8), (0.51, 0.8), (0.4, 0.69), (0.4, 0.91)] {
        let mut state = flat();
        let far_off = observation(lift_coefficient, mach, 0.9);
        let update = PaperLaw::ghazi_2020().adapt(&mut state, &far_off);
        let Update::OutsideGrid(refusal) = update else { panic!("{update:?}") };
        assert_eq!((refusal.x, refusal.y), (lift_coefficient, mach));
        assert_eq!(state, flat());
        assert_eq!((update.error_percent(), update.changes().count()), (None, 0));
    }
}

#[test]
fn what_gives_no_error_is_named_and_changes_nothing() {
    let good = observation(0.43, 0.74, 0.033);
    for (bad, name) in [
        (Observation { lift_coefficient: f64::NAN, ..good }, "lift coefficient"),
        (Observation { mach: f64::INFINITY, ..good }, "Mach number"),
        (Observation { drag_coefficient: f64::NAN, ..good }, "observed drag coefficient"),
        (Observation { fuel_flow_total_kg_s: 0.0, ..good }, "total fuel flow, kg/s"),
        (Observation { fuel_flow_total_kg_s: f64::NAN, ..good }, "total fuel flow, kg/s"),
        (
            Observation { fuel_flow_per_drag_coefficient_kg_s: -1.0, ..good },
            "fuel flow per drag coefficient, kg/s",
        ),
    ] {
        let mut state = flat();
        let update = PaperLaw::ghazi_2020().adapt(&mut state, &bad);
        assert!(
            matches!(update, Update::Unusable { quantity, .. } if quantity == name),
            "{update:?}"
        );
        assert_eq!(state, flat());
    }
}

/// L9 of the reconstruction's list: the law depends on the order of segments, so the caller must keep it.
#[test]
fn order_matters() {
    let law = PaperLaw::ghazi_2020();
    let (one, two) = (observation(0.43, 0.74, 0.033), observation(0.47, 0.77, 0.036));
    let learn = |first, second| {
        let mut state = flat();
        let _ = law.adapt(&mut state, first);
        let _ = law.adapt(&mut state, second);
        state
    };
    assert_ne!(learn(&one, &two), learn(&two, &one));
}

/// Check 12: 6 % more fuel flow with the same drag has the same effect as 6 % more drag. The engine consumes first as
/// the model assumes and then 6 % more: observed drag is fuel flow divided by the *model's* TSFC.
#[test]
fn engine_and_drag_are_not_told_apart() {
    let (dynamic_pressure_times_area_n, tsfc_kg_n_s) = (1.1e6, 1.6e-5);
    let observe = |drag_coefficient: f64, true_tsfc_kg_n_s: f64| {
        let fuel_flow_total_kg_s =
            dynamic_pressure_times_area_n * drag_coefficient * true_tsfc_kg_n_s;
        let slope = dynamic_pressure_times_area_n * tsfc_kg_n_s;
        Observation {
            drag_coefficient: fuel_flow_total_kg_s / slope,
            fuel_flow_total_kg_s,
            fuel_flow_per_drag_coefficient_kg_s: slope,
            ..observation(0.43, 0.74, 0.0)
        }
    };
    let law = PaperLaw::ghazi_2020();
    let (mut by_drag, mut by_engine) = (flat(), flat());
    let more_drag = law.adapt(&mut by_drag, &observe(1.06 * 0.030, tsfc_kg_n_s));
    let more_fuel = law.adapt(&mut by_engine, &observe(0.030, 1.06 * tsfc_kg_n_s));
    assert!(
        matches!(more_drag, Update::Adapted { .. }) && matches!(more_fuel, Update::Adapted { .. })
    );
    for node in 0..9 {
        let (drag, engine) = (
            by_drag.drag_coefficient().value_at_node(node),
            by_engine.drag_coefficient().value_at_node(node),
        );
        assert!((drag - engine).abs() < 1e-16);
        assert_eq!(
            by_drag.confidence().value_at_node(node),
            by_engine.confidence().value_at_node(node)
        );
    }
}

/// Check 11 on a table: drag 8 % above a curved model on the usual grid; a flight of 40 segments through a few cells,
/// without noise. Where it flew, the error is then below 5 % (the dead band); elsewhere nothing was learnt.
#[test]
fn a_flight_with_8_percent_more_drag() {
    let model = |lift_coefficient: f64, mach: f64| {
        0.021 + 0.055 * lift_coefficient * lift_coefficient + 0.02 * (mach - 0.7) * (mach - 0.7)
    };
    let axes =
        (Axis::from_step(0.1, 0.8, 0.05).unwrap(), Axis::from_step(0.5, 0.95, 0.05).unwrap());
    let grid = Arc::new(Grid::new(axes.0, axes.1));
    let values = (0..grid.nodes()).map(|node| {
        let (lift_coefficient, mach) = grid.coordinates(node);
        model(lift_coefficient, mach)
    });
    let mut state = State::new(Table::new(Arc::clone(&grid), values.collect()).unwrap());
    let initial = state.clone();
    let flight: Vec<Observation> = (0..40)
        .map(|i| {
            let share = f64::from(i) / 39.0;
            let (lift_coefficient, mach) = (0.47 - 0.09 * share, 0.78 + 0.012 * share);
            observation(lift_coefficient, mach, 1.08 * model(lift_coefficient, mach))
        })
        .collect();
    let law = PaperLaw::ghazi_2020();
    let adapted = flight
        .iter()
        .filter(|segment| matches!(law.adapt(&mut state, segment), Update::Adapted { .. }))
        .count();
    assert!(adapted >= 2, "more than one cell was flown in");
    for segment in &flight {
        assert!(error_after(&initial, segment) > 7.0);
        assert!(error_after(&state, segment).abs() < 5.0);
    }
    let elsewhere = observation(0.22, 0.62, 1.08 * model(0.22, 0.62));
    assert_eq!(error_after(&state, &elsewhere), error_after(&initial, &elsewhere));
}

#[test]
fn thresholds_that_are_none() {
    for threshold_percent in [-1.0, f64::NAN, f64::INFINITY] {
        let error = PaperLaw::new(threshold_percent).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("adaptation threshold {threshold_percent} %, outside 0.. %")
        );
    }
    assert_eq!(PaperLaw::new(5.0).unwrap(), PaperLaw::ghazi_2020());
}

#[test]
fn tables_that_are_no_state() {
    let table = |value| Table::new(grid(), vec![value; 9]).unwrap();
    assert_eq!(
        State::from_tables(table(0.03), table(0.5)),
        Err(StateError::ConfidenceBelowOne { node: 0, value: 0.5 })
    );
    let other = Arc::new(Grid::new(Axis::new(vec![0.3, 0.4]).unwrap(), grid().y().clone()));
    assert_eq!(
        State::from_tables(table(0.03), Table::new(other, vec![1.0; 6]).unwrap()),
        Err(StateError::GridsDiffer)
    );
    let error = StateError::ConfidenceBelowOne { node: 4, value: 0.5 };
    assert_eq!(error.to_string(), "confidence of node 4 is 0.5, below 1");
    let (drag_coefficient, confidence) = flat().into_tables();
    assert_eq!(State::from_tables(drag_coefficient, confidence), Ok(flat()));
}

proptest! {
    /// Whatever the input: confidences stay 1 or more, drag coefficients between the old and the observed one, and an
    /// update reports exactly what changed.
    #[test]
    fn updates_are_bounded_and_told(
        points in prop::collection::vec((0.25..0.55, 0.65..0.95, 0.02..0.05), 1..60),
        threshold in 0.0..20.0,
    ) {
        let law = PaperLaw::new(threshold).unwrap();
        let mut state = flat();
        for (lift_coefficient, mach, drag_coefficient) in points {
            let (mut drag_table, mut confidence_table) = state.clone().into_tables();
            let update = law.adapt(&mut state, &observation(lift_coefficient, mach, drag_coefficient));
            for change in update.changes() {
                let (low, high) = (
                    change.drag_coefficient_before.min(drag_coefficient),
                    change.drag_coefficient_before.max(drag_coefficient),
                );
                let rounding = 1e-16;
                prop_assert!(change.drag_coefficient_after >= low - rounding);
                prop_assert!(change.drag_coefficient_after <= high + rounding);
                prop_assert!(change.confidence_after > change.confidence_before);
                prop_assert_eq!(drag_table.value_at_node(change.node), change.drag_coefficient_before);
                drag_table.values_mut()[change.node] = change.drag_coefficient_after;
                confidence_table.values_mut()[change.node] = change.confidence_after;
            }
            prop_assert_eq!(&state, &State::from_tables(drag_table, confidence_table).unwrap());
        }
    }
}
