//! Virtual fleets with known truth: exactly as the model predicts, off in known ways, and with effects that no table
//! holds.

use adapt::bayes::{BayesSettings, BayesState, ObservationUpdate};
use lut::Outside;

use crate::fleet::{
    Fleet, Noise, SENSOR_NOISE, SENSORS, believed_drag, errors_percent, grid, learnt, mean_and_std,
    off_by, solved, table, times,
};

/// A fleet that flies exactly as the model predicts: how much spread adaptation adds to the errors, compared with what
/// it states. Twenty fleets, judged where 100 unseen flights go.
///
/// The table's error t is known, so that the spread it adds to an independent noise n is √(n² + t²) − n; the spread of
/// a sample would also have their chance correlation.
#[test]
fn a_true_model_is_hardly_disturbed() {
    let grid = grid(0.05, 0.95);
    let initial = table(&grid, believed_drag);
    let truth = times(&initial, 1.0);
    let noise = 100.0 * (SENSOR_NOISE.segment.powi(2) + SENSOR_NOISE.flight.powi(2)).sqrt();
    for (count, limit) in [(1, 0.2), (10, 0.08), (20, 0.08), (40, 0.08), (100, 0.08)] {
        let mut added = Vec::new();
        for seed in 0..20 {
            let mut fleet = Fleet::new(100 + seed);
            let flights = fleet.flights(count, SENSOR_NOISE, &truth);
            let unseen = fleet.flights(100, SENSOR_NOISE, &truth);
            let posterior = solved(&initial, &flights);
            let (errors, variances): (Vec<f64>, Vec<f64>) = unseen
                .iter()
                .flatten()
                .map(|segment| {
                    let at = (segment.lift_coefficient, segment.mach);
                    let cell = grid.locate(at.0, at.1, Outside::Error).unwrap();
                    let error = 100.0 * posterior.correction_at(&cell);
                    (error, 1e4 * posterior.relative_variance(&cell))
                })
                .unzip();
            let spread = (noise.powi(2) + mean_and_std(&errors).1.powi(2)).sqrt() - noise;
            let stated = mean_and_std(&variances).0.sqrt();
            assert!(spread <= stated, "{count} flights, fleet {seed}: {spread} {stated}");
            added.push(spread);
        }
        let worst = added.iter().copied().fold(f64::MIN, f64::max);
        let mean = mean_and_std(&added).0;
        eprintln!("{count} flights of a true model add {mean:.3}, at worst {worst:.3} points");
        assert!(worst <= limit, "{count}: {worst}");
    }
}

/// Three fleets that are off in other ways than the golden ones, defaults, ten flights learnt and sixty unseen. The
/// sensors' noise alone leaves 0.67 %.
#[test]
fn three_other_fleets_with_the_same_defaults() {
    let grid = grid(0.05, 0.95);
    let initial = table(&grid, believed_drag);
    let fleets: [(&str, [f64; 3], f64); 3] = [
        ("drag +5 %, induced +12 %", [0.0189, 0.0560, 0.860], 1.0),
        ("drag rise 0.006 Mach number early", [0.0180, 0.0500, 0.854], 1.0),
        (
            "zero-lift -4 %, induced +6 %, late drag rise, engine +3 %",
            [0.0173, 0.0530, 0.866],
            1.03,
        ),
    ];
    for (seed, (name, parameters, factor)) in fleets.into_iter().enumerate() {
        let truth = off_by(&initial, parameters, factor);
        let mut fleet = Fleet::new(200 + seed as u64);
        let flights = fleet.flights(10, SENSOR_NOISE, &truth);
        let unseen = fleet.flights(60, SENSOR_NOISE, &truth);
        let posterior = solved(&initial, &flights);
        let before = mean_and_std(&errors_percent(&initial, &unseen));
        let after = mean_and_std(&errors_percent(posterior.drag(), &unseen));
        eprintln!(
            "{name}: before {:.2}/{:.2} after {:.2}/{:.2} %",
            before.0, before.1, after.0, after.1
        );
        assert!(after.0.abs() <= 0.4, "{name}: {after:?}");
        assert!(after.1 <= 0.85, "{name}: {after:?}");
    }
}

/// With many flights only noise is left: 0.67 % of the sensors.
#[test]
fn many_flights_leave_the_noise() {
    let grid = grid(0.05, 0.95);
    let initial = table(&grid, believed_drag);
    let truth = off_by(&initial, [0.0190, 0.0560, 0.854], 1.0);
    let mut fleet = Fleet::new(300);
    let flights = fleet.flights(300, SENSOR_NOISE, &truth);
    let unseen = fleet.flights(300, SENSOR_NOISE, &truth);
    let posterior = solved(&initial, &flights);
    let floor = 100.0 * (SENSOR_NOISE.segment.powi(2) + SENSOR_NOISE.flight.powi(2)).sqrt();
    let (mean, std) = mean_and_std(&errors_percent(posterior.drag(), &unseen));
    eprintln!("300 flights leave {mean:.3}/{std:.3} %, floor {floor:.3} %");
    assert!(mean.abs() < 0.1 && std < 1.05 * floor, "{mean} {std}");
}

/// A fleet 5 % off: its correct first flights are not outliers, and the first already moves the whole region.
#[test]
fn an_honest_bias_is_no_outlier() {
    let grid = grid(0.05, 0.95);
    let initial = table(&grid, believed_drag);
    let truth = times(&initial, 1.05);
    for seed in 0..20 {
        let mut fleet = Fleet::new(400 + seed);
        let mut state = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
        for flight in fleet.flights(5, SENSOR_NOISE, &truth) {
            let update = state.learn_flight(&flight);
            assert!(update.flight_weight.unwrap() > 0.8, "seed {seed}: {update:?}");
            let lightest = update.observations.iter().map(weight).fold(f64::MAX, f64::min);
            assert!(lightest > 0.3, "seed {seed}: {update:?}");
        }
        let far = grid.locate(0.6, 0.7, Outside::Error).unwrap();
        let posterior = state.solve().unwrap();
        let (x, std) = (posterior.correction_at(&far), posterior.relative_variance(&far).sqrt());
        assert!((x - 0.05).abs() < 0.015 && std < 0.035, "seed {seed}: {x} {std}");
    }
}

fn weight(update: &ObservationUpdate) -> f64 {
    match update {
        ObservationUpdate::Learnt { weight, .. } => *weight,
        other => panic!("{other:?}"),
    }
}

/// Where nobody flew nothing is certain: node standard deviations grow away from the flights.
#[test]
fn far_nodes_are_less_certain_and_marked() {
    let grid = grid(0.05, 0.95);
    let initial = table(&grid, believed_drag);
    let noise = Noise { segment: 0.005, flight: 0.0045 };
    let flights = Fleet::new(500).flights(30, noise, times(&initial, 1.0));
    let state = learnt(&initial, BayesSettings::physical_2026(), &flights);
    let posterior = state.solve().unwrap();
    let std =
        |x, y| posterior.relative_variance(&grid.locate(x, y, Outside::Error).unwrap()).sqrt();
    let line = [(0.35, 0.82), (0.55, 0.82), (0.80, 0.82)].map(|(x, y)| std(x, y));
    assert!(line[0] < line[1] && line[1] < line[2], "{line:?}");
    assert!(std(0.10, 0.50) > 2.0 * line[0]);
    let never = posterior.never_informed().count();
    assert_eq!(never + state.touched_nodes(), grid.nodes());
    // Prior standard deviations are about the setting everywhere.
    let nothing = BayesState::new(&initial, BayesSettings::physical_2026()).unwrap();
    for std in nothing.solve().unwrap().standard_deviation() {
        assert!((0.095..0.12).contains(std), "{std}");
    }
    // The variance of a segment is the table's and the noise's.
    let cell = grid.locate(0.35, 0.82, Outside::Error).unwrap();
    let extra = posterior.segment_variance(&cell, &SENSORS) - posterior.relative_variance(&cell);
    // 0.5 % and 0.3 % of a segment, 0.45 % and 1 % of a flight.
    assert!((extra - (25.0 + 9.0 + 20.25 + 100.0) * 1e-6).abs() < 1e-12, "{extra}");
}
