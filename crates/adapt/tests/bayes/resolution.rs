//! Refining the grid: 0.05 to 0.02 leaves what was learnt.

use adapt::bayes::Posterior;
use flight::Observation;
use lut::{Outside, Table};

use crate::fleet::{Fleet, Flights, SENSOR_NOISE, grid, off_by, solved, table};
use crate::golden;

/// The points' correction of two posteriors, largest difference in points of a per cent.
fn largest_difference(coarse: &Posterior, fine: &Posterior, flights: &Flights) -> f64 {
    let at = |posterior: &Posterior, segment: &Observation| {
        let grid = posterior.drag().grid();
        let cell = grid.locate(segment.lift_coefficient, segment.mach, Outside::Error).unwrap();
        posterior.correction_at(&cell)
    };
    flights
        .iter()
        .flatten()
        .map(|segment| 100.0 * (at(coarse, segment) - at(fine, segment)).abs())
        .fold(0.0, f64::max)
}

/// A level initial table: no chord of its own, so that only the law's answer to another grid is seen.
fn level(step: f64, mach_end: f64) -> Table {
    table(&grid(step, mach_end), |_, _| 0.030)
}

/// The same flights relative to the level table.
fn flattened(flights: &Flights, initial: impl Fn(&Observation) -> f64) -> Flights {
    let flat = |segment: &Observation| Observation {
        drag_coefficient: 0.030 * segment.drag_coefficient / initial(segment),
        ..*segment
    };
    flights.iter().map(|flight| flight.iter().map(flat).collect()).collect()
}

#[test]
fn a_finer_grid_gives_the_same_correction_of_virtual_fleets() {
    for seed in 0..4 {
        let truth = |c: f64, m: f64| 0.030 * (1.04 - 0.06 * (c - 0.35) - 0.3 * (m - 0.82));
        let flights = Fleet::new(600 + seed).flights(10, SENSOR_NOISE, truth);
        let coarse = solved(&level(0.05, 0.95), &flights);
        let fine = solved(&level(0.02, 0.94), &flights);
        let difference = largest_difference(&coarse, &fine, &flights);
        eprintln!("virtual fleet {seed}: {difference:.3} points");
        assert!(difference < 0.15, "{difference}");
    }
}

/// The golden fleets' ten flights, relative to the polynomial that the initial table was sampled from.
#[test]
fn a_finer_grid_gives_the_same_correction_of_golden_fleets() {
    // Coefficients of the reference's initial polynomial (CL outer, Mach number inner, equation 15).
    let p = [
        2.520587187220872e-01,
        -5.871615823818956e-01,
        3.821327392400387e-01,
        1.198478886625741e-01,
        -2.19996071187687e-01,
        1.963170934800188e-01,
    ];
    let polynomial = |segment: &Observation| {
        let (c, m) = (segment.lift_coefficient, segment.mach);
        p[0] + p[1] * m + p[2] * m * m + (p[3] + p[4] * m + p[5] * m * m) * c * c
    };
    for name in ["SIM-01", "SIM-02", "SIM-05"] {
        let (flights, _) = golden::fleet(name);
        let flights = flattened(&flights[..10].to_vec(), polynomial);
        let coarse = solved(&level(0.05, 0.95), &flights);
        let fine = solved(&level(0.02, 0.94), &flights);
        let difference = largest_difference(&coarse, &fine, &flights);
        eprintln!("{name}: {difference:.3} points");
        assert!(difference < 0.15, "{name}: {difference}");
    }
}

/// Bilinear functions of the coarse grid are bilinear on a grid that contains it: halving the step, with drag tables
/// and weights as they are.
#[test]
fn halving_the_step_keeps_means_and_standard_deviations() {
    let coarse_grid = grid(0.05, 0.95);
    let fine_grid = grid(0.025, 0.95);
    let coarse_table = table(&coarse_grid, crate::fleet::believed_drag);
    let fine_table = table(&fine_grid, |x, y| {
        coarse_table.interpolate(&coarse_grid.locate(x, y, Outside::Error).unwrap())
    });
    let truth = off_by(&coarse_table, [0.0175, 0.0530, 0.855], 1.04);
    let flights = Fleet::new(610).flights(20, SENSOR_NOISE, truth);
    let (coarse, fine) = (solved(&coarse_table, &flights), solved(&fine_table, &flights));
    assert!(largest_difference(&coarse, &fine, &flights) < 0.15);
    for (x, y) in [(0.35, 0.82), (0.15, 0.6), (0.75, 0.9)] {
        let std = |posterior: &Posterior| {
            let cell = posterior.drag().grid().locate(x, y, Outside::Error).unwrap();
            posterior.relative_variance(&cell).sqrt()
        };
        assert!((std(&coarse) / std(&fine) - 1.0).abs() < 0.1, "{} {}", std(&coarse), std(&fine));
    }
}
