//! Tails made up for tests: ordinary ones, and the odd ones that a page must survive.

use flight::Timestamp;

use crate::view::{Cruise, Flight, Point, Polars, TailView};
use pipeline::statistics::ErrorStatistics;

/// Ordinary, with wild values, all alike, a single segment, nothing at all; each adapted and not.
pub(crate) fn views() -> Vec<TailView> {
    let ordinary: Vec<Point> = (0..240).map(|k| point(k, 4.0, Some(1.0))).collect();
    let mut wild = ordinary.clone();
    wild[7].before = Some(420.0);
    wild[8].after = Some(-75.0);
    wild[9].drag_coefficient = 0.9;
    let alike = vec![point(0, 4.0, Some(1.0)); 3];
    let mut views = Vec::new();
    for points in [ordinary, wild, alike, vec![point(0, 4.0, Some(1.0))], Vec::new()] {
        views.push(view(points.clone(), true));
        let given = points.into_iter().map(|point| Point { after: None, ..point }).collect();
        views.push(view(given, false));
    }
    views
}

/// The k-th of many segments about Mach 0.80 and lift coefficient 0.45, six per flight, one flight every other day.
fn point(k: u32, before: f64, after: Option<f64>) -> Point {
    let wave = (f64::from(k) * 0.7).sin();
    let (lift_coefficient, mach) = (0.45 + 0.08 * wave, 0.80 + 0.04 * (f64::from(k) * 0.31).cos());
    Point {
        start_s: 1.5e9 + f64::from(k / 6) * 172_800.0,
        lift_coefficient,
        mach,
        drag_coefficient: drag(lift_coefficient, mach) * 1.04,
        before: Some(before + wave),
        after: after.map(|after| after + wave),
    }
}

fn drag(lift_coefficient: f64, mach: f64) -> f64 {
    0.02 + 0.05 * lift_coefficient.powi(2) + 0.4 * (mach - 0.7).max(0.0).powi(3)
}

fn view(points: Vec<Point>, adapted: bool) -> TailView {
    let mut flights: Vec<Flight> = Vec::new();
    let mut starts: Vec<f64> = points.iter().map(|point| point.start_s).collect();
    starts.dedup();
    for start_s in starts {
        let of = |of: fn(&Point) -> Option<f64>| {
            let here = points.iter().filter(|point| point.start_s.total_cmp(&start_s).is_eq());
            ErrorStatistics::from_errors(&here.filter_map(of).collect::<Vec<f64>>())
        };
        #[expect(clippy::cast_possible_truncation, reason = "whole seconds")]
        let start = Timestamp::from_second(start_s as i64).unwrap();
        let (before, after) = (of(|point| point.before), of(|point| point.after));
        let (name, engines) = (format!("F{}", flights.len()), vec![-0.5, 0.5]);
        let before_learning = after.mean;
        flights.push(Flight { name, start, start_s, before, after, before_learning, engines });
    }
    TailView {
        points,
        outside: vec![(0.45, 0.96), (0.83, 0.81)],
        not_observed: Vec::new(),
        flights,
        cruise: vec![Cruise { mass_t: 60.0, specific_range: 180.0, predicted: 182.0 }; 3],
        engines: 2,
        polars: polars(),
        adapted,
    }
}

/// Lift coefficient 0.1 … 0.8 by 0.05, Mach number 0.50 … 0.95 by 0.05; two Mach numbers informed.
fn polars() -> Polars {
    let lift_coefficient: Vec<f64> = (2..=16).map(|k| f64::from(k) / 20.0).collect();
    let mach: Vec<f64> = (10..=19).map(|k| f64::from(k) / 20.0).collect();
    let nodes: Vec<(f64, f64)> =
        lift_coefficient.iter().flat_map(|cl| mach.iter().map(move |m| (*cl, *m))).collect();
    let informed: Vec<bool> =
        nodes.iter().map(|(cl, m)| (0.38..0.55).contains(cl) && (0.78..0.87).contains(m)).collect();
    let initial: Vec<f64> = nodes.iter().map(|(cl, m)| drag(*cl, *m)).collect();
    let current =
        initial.iter().zip(&informed).map(|(cd, i)| if *i { 1.04 * cd } else { *cd }).collect();
    let extrapolated = nodes.iter().map(|(cl, m)| !(0.3..0.6).contains(cl) || *m < 0.7).collect();
    let half_width95 = Some(vec![0.01; initial.len()]);
    let learnt = true;
    Polars {
        lift_coefficient,
        mach,
        initial,
        current,
        learnt,
        half_width95,
        informed,
        extrapolated,
    }
}
