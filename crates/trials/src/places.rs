//! Scores of where a gap was said to lie.

use std::collections::BTreeMap;

use flight::effect::EffectId;

use diagnose::Slice;

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

/// Whether a place is said in a variable that drives the effect.
#[must_use]
pub fn names_driver(id: EffectId, slice: &Slice) -> bool {
    has_driver(id, &slice.bounds)
}

fn has_driver(id: EffectId, bounds: &BTreeMap<String, [Option<f64>; 2]>) -> bool {
    id.entry().driven_by.iter().any(|variable| bounds.contains_key(variable.name()))
}

#[cfg(test)]
mod tests {
    use diagnose::{Input, SliceError, slice_members};
    use simulate::{AircraftTruth, Preset, Sensors, TruthPhysics};

    use super::*;
    use crate::reference_model::{COARSE, reference_model};

    #[test]
    fn overlap_by_hand() {
        // Largest two of 5, 1, 4, 2, 3: the first and the third. Said: the first and the last: one of three.
        let effect = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!(worst_region(&effect, 2, true), [true, false, true, false, false]);
        let said = [true, false, false, false, true];
        assert_eq!(worst_region_overlap(&effect, &said), Some(1.0 / 3.0));
        // Said where it is least: the second and the fourth, exactly.
        let said = [false, true, false, true, false];
        assert_eq!(worst_region_overlap(&effect, &said), Some(1.0));
        assert_eq!(worst_region_overlap(&effect, &[false; 5]), None);
        assert!((spread(&effect) - 2.0_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn drivers_are_names_of_bounds() {
        let truth = AircraftTruth::preset(Preset::CitationX).unwrap();
        let model =
            reference_model(&truth, TruthPhysics::plain(), &Sensors::transport(), &COARSE, None)
                .unwrap();
        let input = Input::against(&model, &[]);
        let is_known = |name: &str| {
            let place = Slice {
                slice: String::new(),
                bounds: BTreeMap::from([(name.to_owned(), [None, Some(1.0)])]),
                segments: 0,
                mean_gap_percent: 0.0,
                ci95: [0.0; 2],
                share_of_gap: 0.0,
                p_value: 1.0,
            };
            // Without flights there are no members either; only an unknown name is refused as such.
            !matches!(slice_members(&input, &place), Err(SliceError::UnknownVariable { .. }))
        };
        assert!(!is_known("phase_of_moon"));
        for id in EffectId::library(2) {
            for name in id.entry().driven_by.iter().map(|variable| variable.name()) {
                assert!(is_known(name), "{id}: {name}");
            }
        }
        let bounds = BTreeMap::from([("mach".to_owned(), [Some(0.86), None])]);
        assert!(has_driver(EffectId::WaveDrag, &bounds));
        assert!(!has_driver(EffectId::TrimDragCg, &bounds));
        let engine = BTreeMap::from([("engine".to_owned(), [Some(2.0), Some(2.0)])]);
        assert!(has_driver(EffectId::TsfcEngine(2), &engine));
    }

    #[test]
    fn overlap_of_a_place_by_hand() {
        // Two of the three worst were said, and one that is not: 2 of 4.
        let effect = [0.0, 1.0, 2.0, 3.0, 0.5];
        let said = [true, false, true, true, false];
        assert_eq!(worst_region_overlap(&effect, &said), Some(0.5));
    }
}
