//! Whatever the input, drag stays physical and every number finite.

use adapt::bayes::{
    BayesSettings, BayesState, DragTables, GuardReason, InitialError, ObservationUpdate,
    SettingValues,
};
use flight::{Observation, ObservationVariance, Timestamp};
use lut::Table;
use proptest::prelude::*;

use crate::fleet::{SENSORS, believed_drag, grid, table};

fn observation(lift_coefficient: f64, mach: f64, drag_coefficient: f64) -> Observation {
    Observation {
        time: Timestamp::UNIX_EPOCH,
        lift_coefficient,
        mach,
        drag_coefficient,
        fuel_flow_total_kg_s: 0.3,
        fuel_flow_per_drag_coefficient_kg_s: 10.0,
        variance: SENSORS,
    }
}

/// Rising with lift coefficient wherever the initial table does, and positive.
fn assert_physical(drag: &Table, initial: &Table) {
    let count = drag.grid().y().len();
    for (node, &value) in drag.values().iter().enumerate() {
        assert!(value.is_finite() && value > 0.0, "node {node}: {value}");
        if node >= count {
            let below = node - count;
            assert!(
                initial.value_at_node(node) > initial.value_at_node(below),
                "as these tests have it"
            );
            assert!(value >= drag.value_at_node(below), "node {node}: falls");
        }
    }
}

#[test]
fn what_cannot_be_used_is_said() {
    let initial = table(&grid(0.05, 0.95), believed_drag);
    let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
    let before = state.clone();
    let no_variance = ObservationVariance { segment: f64::NAN, flight: 0.0 };
    let negative = ObservationVariance { segment: 1e-4, flight: -1.0 };
    let flight = [
        observation(f64::NAN, 0.8, 0.03),
        observation(0.4, f64::INFINITY, 0.03),
        observation(0.4, 0.8, -0.03),
        observation(0.4, 0.8, f64::NAN),
        observation(0.4, 0.8, 1e300),
        observation(0.9, 0.8, 0.03),
        Observation { variance: no_variance, ..observation(0.4, 0.8, 0.03) },
        Observation { variance: negative, ..observation(0.4, 0.8, 0.03) },
    ];
    let update = state.learn_flight(&flight);
    let quantity = |update: &ObservationUpdate| match update {
        ObservationUpdate::Unusable { quantity, .. } => *quantity,
        ObservationUpdate::OutsideGrid(_) => "outside",
        learnt @ ObservationUpdate::Learnt { .. } => panic!("{learnt:?}"),
    };
    let quantities: Vec<&str> = update.observations.iter().map(quantity).collect();
    assert_eq!(
        quantities,
        [
            "lift coefficient",
            "Mach number",
            "observed drag coefficient",
            "observed drag coefficient",
            "observed drag coefficient",
            "outside",
            "variance of the segment",
            "variance of the flight",
        ]
    );
    assert_eq!(update.flight_weight, None);
    let _ = state.learn_flight(&[]);
    assert_eq!(state, before);
}

/// One good segment among refused ones is learnt, and reported at its place.
#[test]
fn refused_and_learnt_keep_their_places() {
    let initial = table(&grid(0.05, 0.95), believed_drag);
    let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
    let drag = 1.05 * believed_drag(0.4, 0.8);
    let flight =
        [observation(0.9, 0.8, 0.03), observation(0.4, 0.8, drag), observation(0.4, 0.8, -1.0)];
    let update = state.learn_flight(&flight);
    let [first, second, third] = update.observations[..] else { panic!() };
    assert!(matches!(first, ObservationUpdate::OutsideGrid(_)));
    assert!(matches!(second, ObservationUpdate::Learnt { residual, surprise, .. }
        if (residual - 0.05).abs() < 1e-12 && (surprise - 0.05).abs() < 1e-12));
    assert!(matches!(third, ObservationUpdate::Unusable { .. }));
    assert_eq!((state.flights(), state.segments(), state.touched_nodes()), (1, 1, 1));
}

#[test]
fn an_initial_table_without_drag_is_refused() {
    let initial = table(&grid(0.05, 0.95), |c, _| c - 0.2);
    let refused = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap_err();
    let InitialError { node, value, .. } = refused;
    assert_eq!((node, value), (0, initial.value_at_node(0)));
}

#[test]
fn settings_out_of_limits_are_refused_by_name() {
    let good = *BayesSettings::physical_2026().values();
    let refused = BayesSettings::new(SettingValues { correction_std: 0.0, ..good }).unwrap_err();
    assert_eq!(refused.to_string(), "setting correction_std of law bayes is 0, outside 0.001 to 1");
    assert!(BayesSettings::new(SettingValues { extra_flight_std: f64::NAN, ..good }).is_err());
    assert!(BayesSettings::new(SettingValues { half_life_days: Some(0.0), ..good }).is_err());
}

/// Many consistent but absurd flights, drag falling with lift: the guard keeps it from falling and reports where it acted.
#[test]
fn the_guard_acts_and_reports() {
    let initial = table(&grid(0.05, 0.95), believed_drag);
    let loose = SettingValues {
        correction_std: 1.0,
        slope_std_per_lift_coefficient: 20.0,
        bend_std_per_lift_coefficient_squared: 500.0,
        ..*BayesSettings::physical_2026().values()
    };
    let mut state = BayesState::new(&initial, BayesSettings::new(loose).unwrap()).unwrap();
    for _ in 0..50 {
        let flight: Vec<Observation> = (0..12)
            .map(|k| 0.25 + 0.02 * f64::from(k))
            .map(|c| observation(c, 0.80, 0.05 - 0.09 * c))
            .collect();
        let _ = state.learn_flight(&flight);
    }
    let posterior = state.solve().unwrap();
    assert_physical(posterior.drag(), &initial);
    assert_eq!(DragTables::new(&state).unwrap().drag(&state).unwrap(), *posterior.drag());
    let guard = posterior.guard().unwrap();
    assert!(guard.nodes.iter().any(|node| node.reason == GuardReason::NotRising));
    for node in &guard.nodes {
        assert_eq!(node.after, posterior.drag().value_at_node(node.node));
        let asked = initial.value_at_node(node.node) * (1.0 + posterior.correction()[node.node]);
        assert_eq!(node.before, asked);
        assert_ne!(node.before, node.after);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Garbage of any kind, in any settings: finite, positive, rising.
    #[test]
    fn drag_stays_physical_whatever_comes_in(
        flights in prop::collection::vec(
            prop::collection::vec((0.05..0.85_f64, 0.45..1.0_f64, -0.1..0.4_f64, 0..12_u8), 1..6),
            1..12,
        ),
        correction_std in 0.01..1.0_f64,
        slope in 0.01..50.0_f64,
        bend in 0.1..1000.0_f64,
    ) {
        let initial = table(&grid(0.05, 0.95), believed_drag);
        let values = SettingValues {
            correction_std,
            slope_std_per_lift_coefficient: slope,
            slope_std_per_mach: slope,
            bend_std_per_lift_coefficient_squared: bend,
            bend_std_per_mach_squared: bend,
            ..*BayesSettings::physical_2026().values()
        };
        let mut state = BayesState::new(&initial, BayesSettings::new(values).unwrap()).unwrap();
        for flight in flights {
            let segments: Vec<Observation> = flight
                .into_iter()
                .map(|(c, m, drag, kind)| match kind {
                    0 => observation(f64::NAN, m, drag),
                    1 => observation(c, m, f64::INFINITY),
                    2 => observation(c, m, drag * 1e308),
                    3 => Observation {
                        variance: ObservationVariance { segment: 0.0, flight: 1e300 },
                        ..observation(c, m, drag)
                    },
                    _ => observation(c, m, drag),
                })
                .collect();
            let _ = state.learn_flight(&segments);
        }
        let posterior = state.solve().unwrap();
        assert_physical(posterior.drag(), &initial);
        prop_assert!(posterior.standard_deviation().iter().all(|std| std.is_finite() && *std > 0.0));
        prop_assert!(posterior.correction().iter().all(|x| x.is_finite()));
    }
}
