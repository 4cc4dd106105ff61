//! Scores of the regions that were reported for a gap.

use diagnose::{Region, Variable};
use flight::effect::{DrivingVariable, EffectId};

/// The truly worst segments: as many as asked for, those where the effect is largest in the direction of its sign.
/// Of equal ones the first.
///
/// `effect` is what the effect does to each segment, noise apart, in any unit.
#[must_use]
pub fn worst_region(effect: &[f64], count: usize, is_more: bool) -> Vec<bool> {
    let sign = if is_more { 1.0 } else { -1.0 };
    let mut order: Vec<usize> = (0..effect.len()).collect();
    order.sort_by(|&a, &b| (sign * effect[b]).total_cmp(&(sign * effect[a])));
    let mut worst = vec![false; effect.len()];
    for index in order.into_iter().take(count) {
        worst[index] = true;
    }
    worst
}

/// Segments in both over segments in either (intersection over union); `None` where both are empty.
#[must_use]
pub fn overlap(a: &[bool], b: &[bool]) -> Option<f64> {
    let both = a.iter().zip(b).filter(|(a, b)| **a && **b).count();
    let either = a.iter().zip(b).filter(|(a, b)| **a || **b).count();
    (either > 0).then(|| both as f64 / either as f64)
}

/// Overlap of a place with the truly worst region of equal size: there where the effect is more than its mean, if it is so
/// inside the place, else where it is less. `None` for an empty place.
#[must_use]
pub fn worst_region_overlap(effect: &[f64], members: &[bool]) -> Option<f64> {
    let count = members.iter().filter(|&&inside| inside).count();
    if count == 0 {
        return None;
    }
    let mean = effect.iter().sum::<f64>() / effect.len() as f64;
    let inside: f64 =
        effect.iter().zip(members).filter(|(_, inside)| **inside).map(|(e, _)| e - mean).sum();
    overlap(members, &worst_region(effect, count, inside > 0.0))
}

/// Standard deviation of what an effect does within the data: how much there is to be localised.
#[must_use]
pub fn spread(effect: &[f64]) -> f64 {
    let count = effect.len().max(1) as f64;
    let mean = effect.iter().sum::<f64>() / count;
    (effect.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / count).sqrt()
}

/// Whether a region is bounded in a variable that drives the effect.
#[must_use]
pub fn names_driver(id: EffectId, region: &Region) -> bool {
    id.entry().driven_by.iter().any(|&driver| match driver {
        DrivingVariable::Engine => region.engine.is_some(),
        _ => region.conditions.iter().any(|c| c.variable == Variable::from(driver)),
    })
}

#[cfg(test)]
mod tests {
    use diagnose::{Condition, Edge};
    use pipeline::diagnosis_words::bounds_name;

    use super::*;

    #[test]
    fn overlap_by_hand() {
        // Largest two of 5, 1, 4, 2, 3: the first and the third. Reported: the first and the last: one of three.
        let effect = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!(worst_region(&effect, 2, true), [true, false, true, false, false]);
        let said = [true, false, false, false, true];
        assert_eq!(worst_region_overlap(&effect, &said), Some(1.0 / 3.0));
        // Reported where it is least: the second and the fourth, exactly.
        let said = [false, true, false, true, false];
        assert_eq!(worst_region_overlap(&effect, &said), Some(1.0));
        assert_eq!(worst_region_overlap(&effect, &[false; 5]), None);
        assert!((spread(&effect) - 2.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn drivers_are_variables_of_regions() {
        for id in EffectId::library(2) {
            for driver in id.entry().driven_by {
                assert_eq!(driver.name(), bounds_name(Variable::from(*driver)), "{id}");
            }
        }
        let from = Some(Edge { value: 0.86, flown_below: 0.859 });
        let fast = Condition { variable: Variable::Mach, from, to: None };
        let fast = Region { engine: None, conditions: vec![fast] };
        assert!(names_driver(EffectId::WaveDrag, &fast));
        assert!(!names_driver(EffectId::TrimDragCg, &fast));
        let engine = Region { engine: Some(2), conditions: vec![] };
        assert!(names_driver(EffectId::TsfcEngine(2), &engine));
    }

    #[test]
    fn overlap_of_a_place_by_hand() {
        // Two of the three worst were reported, and one that is not: 2 of 4.
        let effect = [0.0, 1.0, 2.0, 3.0, 0.5];
        let said = [true, false, true, true, false];
        assert_eq!(worst_region_overlap(&effect, &said), Some(0.5));
    }
}
