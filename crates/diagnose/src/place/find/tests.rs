use effects::Variable;

use super::*;
use crate::output::region::{Condition, Region};

/// A place with a condition on each of some variables.
fn slice(variables: &[Variable], segments: usize) -> Slice {
    let condition = |&variable: &Variable| Condition { variable, from: None, to: None };
    Slice {
        region: Region { engine: None, conditions: variables.iter().map(condition).collect() },
        segments,
        mean_gap_percent: 1.0,
        ci95: [0.5, 1.5],
        share_of_gap: 1.0,
        p_value: 0.01,
    }
}

#[test]
fn engines_apart_by_hand() {
    // Two: ln(Wf1/Wf2) = 0.02 is ±0.01. Four: l = (0.03, −0.01, −0.01, −0.01) has mean 0; contrasts (l1 − l2)·1,
    // ((l1 + l2)/2 − l3)·√(4/3) = 0.02·√(4/3), ((l1 + l2 + l3)/3 − l4)·√1.5 = (0.01/3 + 0.01)·√1.5.
    let two = engines_apart(&[0.02]);
    assert!((two[0] - 0.01).abs() < 1e-15 && (two[1] + 0.01).abs() < 1e-15);
    let contrasts = [0.04, 0.02 * (4.0_f64 / 3.0).sqrt(), (0.01 / 3.0 + 0.01) * 1.5_f64.sqrt()];
    let four = engines_apart(&contrasts);
    for (found, expected) in four.iter().zip([0.03, -0.01, -0.01, -0.01]) {
        assert!((found - expected).abs() < 1e-15, "{four:?}");
    }
}

/// A place by a name comes first, after everywhere where it is of a level; not where a variable that drives it leads.
#[test]
fn a_name_leads_unless_its_variable_does() {
    let led = |regions: &[&[Variable]], is_level: bool| {
        let mut found = FoundPlaces {
            regions: regions.iter().map(|variables| slice(variables, 1)).collect(),
            everywhere: Some(slice(&[], 1)),
            variances: vec![],
        };
        let gap = NamedGap {
            gap: vec![1.0, if is_level { 1.0 } else { -1.0 }],
            drivers: vec![(Variable::Mach, 0.0), (Variable::Mass, 0.0)],
        };
        found.lead_with(slice(&[Variable::Mach], 1), &gap);
        let places = found.of_gap(true);
        places.iter().map(|p| p.region.conditions.first().map(|c| c.variable)).collect::<Vec<_>>()
    };
    let (mach, roll) = (Some(Variable::Mach), Some(Variable::Roll));
    assert_eq!(led(&[], false), [mach]);
    assert_eq!(led(&[], true), [None, mach]);
    assert_eq!(led(&[&[Variable::Roll]], true), [mach, roll]);
    assert_eq!(
        led(&[&[Variable::Roll], &[Variable::Roll], &[Variable::Roll]], false),
        [mach, roll, roll]
    );
    assert_eq!(led(&[&[Variable::Mass]], true), [Some(Variable::Mass)]);
}

/// A step replaces a bin of dates that leads, whatever second condition the bin has, and no other place; what is not zero before is
/// no step.
#[test]
fn a_step_leads_with_its_own_date() {
    let led = |first: &[Variable], gap: &[f64]| {
        let mut found =
            FoundPlaces { regions: vec![slice(first, 7)], everywhere: None, variances: vec![] };
        let gap = NamedGap { gap: gap.to_vec(), drivers: vec![(Variable::Date, 0.0)] };
        found.lead_with(slice(&[Variable::Date], 2), &gap);
        found.of_gap(true)[0].segments
    };
    assert_eq!(led(&[Variable::Date], &[0.0, 0.0, 1.0, 1.1]), 2);
    assert_eq!(led(&[Variable::Date, Variable::Mach], &[0.0, 0.0, 1.0, 1.1]), 2);
    assert_eq!(led(&[Variable::Mach, Variable::Date], &[0.1, 0.2, 1.0, 1.1]), 7);
    assert_eq!(led(&[Variable::Date], &[0.1, 0.2, 1.0, 1.1]), 7);
    assert_eq!(led(&[Variable::Date], &[0.0, 1.0, 0.0, 1.1]), 7);
}
