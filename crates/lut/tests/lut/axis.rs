//! What makes an axis and what does not, and the decimals of even axes.
#![expect(clippy::float_cmp, reason = "breakpoints are these doubles or they are wrong")]

use lut::{Axis, AxisError};

#[test]
fn accessors() {
    let axis = Axis::new(vec![0.5, 0.6, 0.9]).unwrap();
    assert_eq!(axis.breakpoints(), [0.5, 0.6, 0.9]);
    assert_eq!((axis.len(), axis.first(), axis.last()), (3, 0.5, 0.9));
}

#[test]
fn what_is_no_axis_is_refused_with_its_place() {
    assert_eq!(Axis::new(vec![]), Err(AxisError::TooShort { count: 0 }));
    assert_eq!(Axis::new(vec![0.5]), Err(AxisError::TooShort { count: 1 }));
    assert!(matches!(
        Axis::new(vec![0.5, f64::NAN, 0.9]),
        Err(AxisError::NotFinite { index: 1, .. })
    ));
    assert!(matches!(
        Axis::new(vec![0.5, f64::INFINITY]),
        Err(AxisError::NotFinite { index: 1, .. })
    ));
    assert!(matches!(Axis::new(vec![-1e101, 0.0]), Err(AxisError::NotFinite { index: 0, .. })));
    assert_eq!(
        Axis::new(vec![0.5, 0.7, 0.6]),
        Err(AxisError::NotIncreasing { index: 2, previous: 0.7, value: 0.6 })
    );
    assert!(matches!(Axis::new(vec![0.5, 0.5]), Err(AxisError::NotIncreasing { index: 1, .. })));
    assert!(matches!(Axis::new(vec![0.0, 2e-9, 1.0]), Err(AxisError::TooClose { index: 1, .. })));
    assert!(Axis::new(vec![0.0, 2.1e-9, 1.0]).is_ok());
}

#[test]
fn messages_name_the_breakpoint() {
    let text = |breakpoints| Axis::new(breakpoints).unwrap_err().to_string();
    assert_eq!(text(vec![0.5]), "1 breakpoints, an axis needs 2 or more");
    assert_eq!(
        text(vec![0.5, 0.7, 0.6]),
        "breakpoint 2 is 0.6 after 0.7: breakpoints must increase"
    );
    assert_eq!(
        Axis::from_step(0.1, 0.8, 0.15).unwrap_err().to_string(),
        "a step of 0.15 does not lead from 0.1 to 0.8"
    );
}

/// The oracle is the compiler: it reads a decimal as the nearest double.
#[test]
fn even_axes_have_the_decimals_that_one_would_type() {
    let lift = Axis::from_step(0.10, 0.80, 0.05).unwrap();
    assert_eq!(
        lift.breakpoints(),
        [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8]
    );
    let mach = Axis::from_step(0.76, 0.88, 0.02).unwrap();
    assert_eq!(mach.breakpoints(), [0.76, 0.78, 0.8, 0.82, 0.84, 0.86, 0.88]);
    // Both have members that binary sums miss.
    assert_ne!(0.1 + 0.05 * 4.0, 0.3);
    assert_ne!(0.76 + 0.02 * 3.0, 0.82);
    let negative = Axis::from_step(-0.3, 0.3, 0.1).unwrap();
    assert_eq!(negative.breakpoints(), [-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3]);
    let large = Axis::from_step(5000.0, 49000.0, 1e3).unwrap();
    assert_eq!((large.len(), large.breakpoints()[7]), (45, 12000.0));
    // An end that was computed counts as reached; the breakpoint is the decimal.
    assert_eq!(Axis::from_step(0.1, 0.1 + 0.7, 0.05).unwrap().last(), 0.8);
}

#[test]
fn steps_that_lead_nowhere_are_refused() {
    for (from, to, step) in
        [(0.1, 0.8, 0.0), (0.1, 0.8, -0.05), (0.8, 0.1, 0.05), (0.1, 0.1, 0.05), (0.1, 0.82, 0.05)]
    {
        assert_eq!(
            Axis::from_step(from, to, step),
            Err(AxisError::StepDoesNotReach { from, to, step })
        );
    }
    for (from, to, step) in [
        (f64::NAN, 0.8, 0.05),
        (0.1, f64::INFINITY, 0.05),
        (0.1, 0.8, f64::NAN),
        (1e80, 2e80, 1e-9),
    ] {
        assert!(matches!(Axis::from_step(from, to, step), Err(AxisError::StepDigits { .. })));
    }
    assert!(matches!(Axis::from_step(0.0, 1.0, 1e-7), Err(AxisError::TooLong { .. })));
}
