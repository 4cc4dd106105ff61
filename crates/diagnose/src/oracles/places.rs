//! What the search for places is given, by hand.

use super::{fleet, with_system};
use crate::hypotheses::design::Design;
use crate::place::find::{expected_errors_removed, gaps};
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
        for ((found, whole), weight) in found.iter().zip(&whole).zip(&weights) {
            assert!(whole.abs() > 1e-9, "{whole}");
            assert!((found - weight * whole).abs() < 1e-12, "{found} {whole} {weight}");
        }
    });
}
