//! Factors by which a number is wrong when its unit is.

use units::convert::{KILOGRAMS_PER_POUND, METERS_PER_FOOT, METERS_PER_SECOND_PER_KNOT};

/// How near a measured ratio has to be to a slip's factor to be named by it. The nearest two factors that mean different
/// things, 2 engines and 2.2046 lb/kg, are 10 % apart.
const TOLERANCE: f64 = 0.035;

/// A slip: the factor recorded/true that it makes, and the words for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slip {
    pub(super) factor: f64,
    pub(super) cause: &'static str,
    pub(super) remedy: &'static str,
}

const fn slip(factor: f64, cause: &'static str, remedy: &'static str) -> Slip {
    Slip { factor, cause, remedy }
}

/// Of a speed.
pub(super) const SPEED: [Slip; 4] = [
    slip(
        METERS_PER_SECOND_PER_KNOT,
        "metres per second declared as knots",
        "unit m/s instead of kt",
    ),
    slip(
        1.0 / METERS_PER_SECOND_PER_KNOT,
        "knots declared as metres per second",
        "unit kt instead of m/s",
    ),
    slip(
        1.852,
        "kilometres per hour declared as knots",
        "convert to kt (scale 0.539957 in a mapping)",
    ),
    slip(
        3.6,
        "kilometres per hour declared as metres per second",
        "convert to m/s (scale 0.277778 in a mapping)",
    ),
];

/// Of fuel used over the integral of fuel flow, without the number of engines.
pub(super) const FUEL: [Slip; 5] = [
    slip(
        1.0 / KILOGRAMS_PER_POUND,
        "pounds declared as kilograms in FU, or kilograms declared as pounds in WF",
        "unit lb instead of kg for FU, or kg/h instead of lb/h for WF",
    ),
    slip(
        KILOGRAMS_PER_POUND,
        "pounds declared as kilograms in WF, or kilograms declared as pounds in FU",
        "unit lb/h instead of kg/h for WF, or kg instead of lb for FU",
    ),
    slip(
        60.0,
        "fuel flow per minute declared as per hour, or TIME in minutes declared as seconds",
        "unit min instead of s for TIME, or scale 60 for WF",
    ),
    slip(1.0 / 60.0, "TIME in seconds declared as minutes", "unit s instead of min for TIME"),
    slip(3600.0, "fuel flow per second declared as per hour", "unit kg/s for WF"),
];

/// What a ratio of fuel used to the integral of fuel flow means where fuel used is right: cause and remedy for the flow.
pub(super) fn of_flow(ratio: f64) -> Option<(&'static str, &'static str)> {
    if is_near(ratio, KILOGRAMS_PER_POUND) {
        Some(("WF: lb/h declared as kg/h", "unit lb/h for WF"))
    } else if is_near(ratio, 1.0 / KILOGRAMS_PER_POUND) {
        Some(("WF: kg/h declared as lb/h", "unit kg/h for WF"))
    } else {
        None
    }
}

/// What a ratio of fuel used to the integral of fuel flow means where flow is right: cause and remedy for the mass, of which fuel used is
/// a part.
pub(super) fn of_mass(ratio: f64) -> Option<(&'static str, &'static str)> {
    if is_near(ratio, KILOGRAMS_PER_POUND) {
        Some((
            "mass in kg declared as lb",
            "unit kg for the mass: ZFW, FOB and FU, or the column that a mapping derives them from",
        ))
    } else if is_near(ratio, 1.0 / KILOGRAMS_PER_POUND) {
        Some((
            "mass in lb declared as kg",
            "unit lb for the mass: ZFW, FOB and FU, or the column that a mapping derives them from",
        ))
    } else {
        None
    }
}

/// Of a length.
pub(super) const FEET_PER_METER: f64 = 1.0 / METERS_PER_FOOT;

/// The slip that a ratio recorded/true fits.
pub(super) fn find(slips: &[Slip], ratio: f64) -> Option<Slip> {
    find_within(slips, ratio, TOLERANCE)
}

/// The first slip whose factor a ratio is within a share of.
pub(super) fn find_within(slips: &[Slip], ratio: f64, tolerance: f64) -> Option<Slip> {
    slips.iter().copied().find(|slip| (ratio / slip.factor - 1.0).abs() < tolerance)
}

/// Whether a ratio is that of a slip.
pub(super) fn is_near(ratio: f64, factor: f64) -> bool {
    (ratio / factor - 1.0).abs() < TOLERANCE
}
