//! What the search for places is given, by hand.

use super::{fleet, with_system};
use effects::Variable;

use crate::hypotheses::design::Design;
use crate::place::acceleration::expected_errors_removed;
use crate::place::named::NamedGap;
use crate::place::told::gaps;
use crate::search::system::WhitenedSystem;

/// A segment of weight w counts w times in the search for places, with what is expected of the error of its acceleration:
/// a residual of weight w is w times itself in every fit.
#[test]
fn segments_that_are_weighed_down_count_less_in_places() {
    with_system(&fleet(80, 3), |problem| {
        let system = problem.system;
        let weights: Vec<f64> =
            (0..system.data.segments.len()).map(|k| [1.0, 0.5, 0.125][k % 3]).collect();
        let mut weighed = system.data.clone();
        weighed.weigh(&weights);
        let design = Design::new(&weighed, system.design.references(), None, None);
        let with_weights = WhitenedSystem::new(&weighed, &design);
        let whole = expected_errors_removed(system, &gaps(system)).total;
        let found = expected_errors_removed(&with_weights, &gaps(&with_weights)).total;
        assert!(!weights.is_empty());
        assert_eq!([found.len(), whole.len()], [weights.len(); 2]);
        for ((found, whole), weight) in found.iter().zip(&whole).zip(&weights) {
            assert!(whole.abs() > 1e-9, "{whole}");
            assert!((found - weight * whole).abs() < 1e-12, "{found} {whole} {weight}");
        }
    });
}

/// A gap that begins on a date lies from its first flight on, to the segment, however wide the bins of dates are. By hand: the
/// 8th of 20 flights.
#[test]
fn the_place_of_a_step_is_from_its_own_date_on() {
    with_system(&fleet(82, 20), |problem| {
        let data = problem.system.data;
        let from = data.flights[7].segments.start;
        let gap: Vec<f64> =
            (0..data.segments.len()).map(|k| if k < from { 0.0 } else { 0.01 }).collect();
        let variances = vec![1e-6; gap.len()];
        let named = |p| NamedGap { gap: gap.clone(), drivers: vec![(Variable::Date, p)] };
        let found = named(0.01).place(problem.system, &variances, 1).unwrap();
        let [condition] = &found.region.conditions[..] else { panic!("{:?}", found.region) };
        let edge = condition.from.unwrap();
        let date = |k: usize| data.segments[k].point.date_s.to_bits();
        assert_eq!(
            (edge.value.to_bits(), edge.flown_below.to_bits()),
            (date(from), date(from - 1))
        );
        assert_eq!(found.segments, gap.len() - from);
        assert!(named(0.2).place(problem.system, &variances, 1).is_none());
    });
}

/// `[diagnosis.56]`: what is named makes 1 % at the fastest tenth, and nothing else: the region is the fastest fifth, the nearest
/// that bins of fifths have. Not along a variable that is less sure than a place must be, nor where none is sure.
#[test]
fn the_place_of_a_name_is_where_its_gap_is_largest() {
    with_system(&fleet(81, 20), |problem| {
        let system = problem.system;
        let machs: Vec<f64> = system.data.segments.iter().map(|row| row.point.mach).collect();
        let mut sorted = machs.clone();
        sorted.sort_by(f64::total_cmp);
        let fast = sorted[sorted.len() * 9 / 10];
        let gap: Vec<f64> =
            machs.iter().map(|mach| if *mach >= fast { 0.01 } else { 0.0 }).collect();
        let variances = vec![1e-6; gap.len()];
        let scaled = |drivers: &[(Variable, f64)], by: f64| {
            let gap = gap.iter().map(|gap| 0.02 + by * gap).collect();
            NamedGap { gap, drivers: drivers.to_vec() }.place(system, &variances, 1)
        };
        let place = |drivers: &[(Variable, f64)]| scaled(drivers, 1.0);
        let found = place(&[(Variable::FuelUsed, 0.06), (Variable::Mach, 0.03)]).unwrap();
        assert!((found.p_value - 0.03).abs() < 1e-15);
        let [condition] = &found.region.conditions[..] else { panic!("{:?}", found.region) };
        assert_eq!(condition.variable, Variable::Mach);
        assert!(condition.to.is_none());
        // Edges move by up to 2 % of the segments to numbers of few digits.
        let inside = machs.iter().filter(|mach| condition.holds(**mach)).count() as f64;
        let share = inside / machs.len() as f64;
        assert!((share - 0.2).abs() <= 0.02 + 1e-9, "{condition:?} {share}");
        assert!(place(&[(Variable::Mach, 0.051)]).is_none());
        assert!(place(&[]).is_none());
        // 1 % of a tenth has a standard deviation of 0.3 %: half of that is 0.15 %.
        assert!(scaled(&[(Variable::Mach, 0.0)], 0.55).is_some());
        assert!(scaled(&[(Variable::Mach, 0.0)], 0.45).is_none());
    });
}
