//! Recorded flights against the book: what only a model shows.

use flight::{FlightIdentity, Severity};

use super::fuel::USED_AGAINST_FLOW;
use super::{DataFinding, mean, slips};
use crate::segments_table::Evaluated;
use crate::summary::counted;

/// Code of the finding that a tail is farther off the book than an aircraft can be.
pub const DEVIATION: &str = "book-deviation";
/// Mean deviation from the book beyond which it is a slip rather than an aircraft, %. Old aircraft burn 5 to 8 % more
/// than their book, a public model of the type is within 10 to 15 %.
pub const PLAUSIBLE_PERCENT: f64 = 15.0;
/// Code of the finding that segments of a tail lie outside the table of its book.
pub const OUTSIDE: &str = "outside-table";
/// Code of the finding that flights are compared with no book, as none is theirs.
pub const NOT_COMPARED: &str = "no-model-of-its-own";
/// Flights of which no segment is inside the table, from which that is a slip of units or a table that is too small: one or two may
/// have been flown where the aircraft seldom is.
pub const FLIGHTS_OUTSIDE: usize = 3;
/// Share of segments outside the table from which that is worth a word.
const OUTSIDE_SHARE: f64 = 0.5;
/// Lift coefficients of cruise end below this; masses twice as large do not.
const HIGHEST_CRUISE_LIFT_COEFFICIENT: f64 = 0.75;
/// And begin above this.
const LOWEST_CRUISE_LIFT_COEFFICIENT: f64 = 0.22;

/// What the segments of a tail say against the table of its book.
#[must_use]
pub fn against_book(tail: &str, evaluated: &[Option<Evaluated>]) -> Vec<DataFinding> {
    let errors: Vec<f64> =
        evaluated.iter().flatten().filter_map(|segment| segment.error_percent).collect();
    let lift = mean(evaluated.iter().flatten().map(|segment| segment.lift_coefficient));
    [deviation(tail, &errors, lift), outside(tail, errors.len(), evaluated.len(), lift)]
        .into_iter()
        .flatten()
        .collect()
}

/// Flights of a tail that none of the models is for, with the reason.
#[must_use]
pub fn not_compared(tail: &str, flights: usize, reason: &str) -> DataFinding {
    #[expect(clippy::cast_precision_loss, reason = "flights are far fewer than 2^53")]
    let size = flights as f64;
    DataFinding {
        severity: Severity::Warning,
        code: NOT_COMPARED,
        tail: tail.to_owned(),
        flight: String::new(),
        start: String::new(),
        size,
        unit: "-",
        message: format!("{} compared with no model: {reason}", counted(flights, "flight")),
        likely_cause: "a model of another aircraft, or another type in the reports or the mapping than the model's"
            .to_owned(),
        remedy: "the model of this aircraft, or the right type (`aircraft` in a mapping)".to_owned(),
    }
}

/// Whether a finding is one against a book: those that need no model are more certain.
#[must_use]
pub fn is_of_book(finding: &DataFinding) -> bool {
    [DEVIATION, OUTSIDE, NOT_COMPARED].contains(&finding.code)
}

/// What fuel used against fuel flow determines without a model decides what is wrong where a tail is off its book: the flow, if the book
/// is met by the flow that fuel used states, else the mass, of which fuel used is a part in the same unit.
pub fn decide_by_fuel_used(findings: &mut [DataFinding]) {
    let of_book: Vec<(String, f64)> = findings
        .iter()
        .filter(|finding| finding.code == DEVIATION)
        .map(|finding| (finding.tail.clone(), finding.size))
        .collect();
    for (tail, percent) in of_book {
        let of_tail = |finding: &&mut DataFinding| finding.tail == tail;
        let is_of_fuel = |finding: &&mut DataFinding| finding.code == USED_AGAINST_FLOW;
        let mut of_fuel: Vec<&mut DataFinding> =
            findings.iter_mut().filter(of_tail).filter(is_of_fuel).collect();
        let Some(ratio) = mean(of_fuel.iter().map(|finding| finding.size)) else { continue };
        let left_percent = 100.0 * ((1.0 + percent / 100.0) * ratio - 1.0);
        let is_flow = left_percent.abs() <= PLAUSIBLE_PERCENT;
        let slip = if is_flow { slips::of_flow(ratio) } else { slips::of_mass(ratio) };
        let (cause, remedy) = match slip {
            Some((cause, remedy)) => (cause.to_owned(), remedy.to_owned()),
            None if is_flow => (of_fuel[0].likely_cause.clone(), of_fuel[0].remedy.clone()),
            None => continue,
        };
        for finding in &mut of_fuel {
            (finding.likely_cause, finding.remedy) = (cause.clone(), remedy.clone());
        }
        let deviations = findings.iter_mut().filter(|finding| finding.code == DEVIATION);
        for finding in deviations.filter(of_tail) {
            (finding.likely_cause, finding.remedy) = (cause.clone(), remedy.clone());
        }
    }
}

/// Whether flights are as far off the book, within [`PLAUSIBLE_PERCENT`], as all that was learnt of the tail before: then it is the
/// aircraft, or a book that somebody has accepted for it.
#[must_use]
pub fn is_as_far_off(found: &DataFinding, learnt: &[Option<Evaluated>]) -> bool {
    let errors = learnt.iter().flatten().filter_map(|segment| segment.error_percent);
    off_the_book(errors).is_some_and(|known| (found.size - known).abs() <= PLAUSIBLE_PERCENT)
}

/// How far a flight is off the book, %; `None` without a segment inside the table.
#[must_use]
pub fn flight_off_percent(evaluated: &[Option<Evaluated>]) -> Option<f64> {
    off_the_book(evaluated.iter().flatten().filter_map(|segment| segment.error_percent))
}

/// The finding on one flight, so far off the book where its tail is known to be `known_percent` off; `None` where the two agree within
/// [`PLAUSIBLE_PERCENT`].
#[must_use]
pub fn stray(
    identity: &FlightIdentity,
    evaluated: &[Option<Evaluated>],
    known_percent: f64,
) -> Option<DataFinding> {
    let percent = flight_off_percent(evaluated)?;
    if (percent - known_percent).abs() <= PLAUSIBLE_PERCENT {
        return None;
    }
    let lift = mean(evaluated.iter().flatten().map(|segment| segment.lift_coefficient));
    let beside = 100.0 * ((1.0 + percent / 100.0) / (1.0 + known_percent / 100.0) - 1.0);
    let (likely_cause, remedy) = causes(beside, lift, Compared::OneFlight);
    Some(DataFinding {
        severity: Severity::Serious,
        code: DEVIATION,
        tail: identity.tail.clone(),
        flight: identity.flight.clone(),
        start: identity.start.to_string(),
        size: percent,
        unit: "%",
        message: format!(
            "recorded fuel flow is {percent:+.1} % off the book, other flights of the tail {known_percent:+.1} %, in % of the book's flow; \
             more than {PLAUSIBLE_PERCENT} % apart is rarely an aircraft"
        ),
        likely_cause: likely_cause.to_owned(),
        remedy: remedy.to_owned(),
    })
}

/// Mean deviation of recorded fuel flow from the book, %.
///
/// Errors of predictions are shares of what was recorded, which no single segment makes large; the book is the whole here, or a flow
/// that is halved would be −100 %.
fn off_the_book(errors: impl Iterator<Item = f64>) -> Option<f64> {
    Some(100.0 * (1.0 / (1.0 - mean(errors)? / 100.0) - 1.0))
}

fn deviation(tail: &str, errors: &[f64], lift: Option<f64>) -> Option<DataFinding> {
    let percent = off_the_book(errors.iter().copied())?;
    if percent.abs() <= PLAUSIBLE_PERCENT {
        return None;
    }
    let (likely_cause, remedy) = causes(percent, lift, Compared::Tail);
    Some(DataFinding {
        severity: Severity::Serious,
        code: DEVIATION,
        tail: tail.to_owned(),
        flight: String::new(),
        start: String::new(),
        size: percent,
        unit: "%",
        message: format!(
            "recorded fuel flow is {percent:+.1} % off the book on average of {} segments, in % of the book's flow; beyond ±{PLAUSIBLE_PERCENT} % is rarely an aircraft",
            errors.len()
        ),
        likely_cause: likely_cause.to_owned(),
        remedy: remedy.to_owned(),
    })
}

/// What is off the book: where all flights of a tail are, the book may be at fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Compared {
    OneFlight,
    Tail,
}

/// How far off the book a mass in another unit is at least, %: half of the drag in cruise comes from lift, a quarter where an aircraft
/// flies fast and light.
const MASS_SLIP_PERCENT: f64 = 20.0;

fn causes(percent: f64, lift: Option<f64>, compared: Compared) -> (&'static str, &'static str) {
    let lift = lift.unwrap_or(0.5);
    if lift > HIGHEST_CRUISE_LIFT_COEFFICIENT && percent < -MASS_SLIP_PERCENT {
        return (
            "mass in lb declared as kg, or ALT or MACH in another unit",
            "unit lb for the mass: that of the load sheet, or of the column that a mapping takes it from",
        );
    }
    if lift < LOWEST_CRUISE_LIFT_COEFFICIENT && percent > MASS_SLIP_PERCENT {
        return (
            "mass in kg declared as lb, or ALT or MACH in another unit",
            "unit kg for the mass: that of the load sheet, or of the column that a mapping takes it from",
        );
    }
    // Predicted over recorded flow: 2 for one engine of two, 2.2 for kg read as lb.
    let ratio = 1.0 / (1.0 + percent / 100.0);
    match (ratio, compared) {
        (1.6.., Compared::OneFlight) => (
            "WF: flow of one engine as total, or kg/h declared as lb/h",
            "scale 2 or unit kg/h for WF",
        ),
        (1.6.., Compared::Tail) => (
            "WF: flow of one engine as total, or kg/h declared as lb/h; or the guide's flow: lb/h declared as kg/h",
            "scale 2 or unit kg/h for WF, or a new model from a guide in its right unit",
        ),
        (..0.65, Compared::OneFlight) => {
            ("WF: lb/h declared as kg/h, or the total given for each engine", "unit lb/h for WF")
        }
        (..0.65, Compared::Tail) => (
            "WF: lb/h declared as kg/h, or the total given for each engine; or the guide's flow: of one engine, or kg/h declared as lb/h",
            "unit lb/h for WF, or a new model from a guide with the flow of all engines",
        ),
        (_, Compared::OneFlight) => (
            "a load sheet in another unit, or another aircraft than the tail",
            "compare the mass and the tail of this flight with their sources",
        ),
        (_, Compared::Tail) => (
            "another engine or variant than the book's, or a load sheet in another unit",
            "the guide of this variant",
        ),
    }
}

fn outside(tail: &str, inside: usize, all: usize, lift: Option<f64>) -> Option<DataFinding> {
    #[expect(clippy::cast_precision_loss, reason = "segments are far fewer than 2^53")]
    let share = 1.0 - inside as f64 / all.max(1) as f64;
    if all == 0 || share <= OUTSIDE_SHARE {
        return None;
    }
    Some(DataFinding {
        severity: if inside == 0 { Severity::Serious } else { Severity::Warning },
        code: OUTSIDE,
        tail: tail.to_owned(),
        flight: String::new(),
        start: String::new(),
        size: 100.0 * share,
        unit: "%",
        message: format!(
            "{} of {all} segments lie outside the model's table{}",
            all - inside,
            lift.map_or_else(String::new, |lift| format!(
                ", lift coefficient {lift:.2} on average"
            ))
        ),
        likely_cause: "mass, ALT or MACH in another unit, or a table that is too small".to_owned(),
        remedy: "check the units, or widen `table` in the aircraft file".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finding(code: &'static str, size: f64) -> DataFinding {
        DataFinding {
            severity: Severity::Serious,
            code,
            tail: "T".to_owned(),
            flight: String::new(),
            start: String::new(),
            size,
            unit: "-",
            message: String::new(),
            likely_cause: code.to_owned(),
            remedy: format!("mend {code}"),
        }
    }

    /// Of a mass in kg read as lb, half of which drag predicts: +57 % off the book, fuel used 0.4536 of what flows. Were the flow at fault
    /// it would be +120 %. Of a total given for each of two engines: +105 %, and 0.505.
    #[test]
    fn fuel_used_decides_between_mass_and_flow() {
        let mut mass = [finding(DEVIATION, 57.4), finding(USED_AGAINST_FLOW, 0.4536)];
        decide_by_fuel_used(&mut mass);
        for finding in &mass {
            assert!(finding.remedy.starts_with("unit kg"), "{}", finding.remedy);
        }
        let mut flow = [finding(DEVIATION, 105.5), finding(USED_AGAINST_FLOW, 0.505)];
        decide_by_fuel_used(&mut flow);
        assert_eq!(flow[0].remedy, "mend fuel-used-against-flow");
        assert_eq!(flow[1].remedy, "mend fuel-used-against-flow");
        let mut alone = [finding(DEVIATION, 57.4)];
        decide_by_fuel_used(&mut alone);
        assert_eq!(alone[0].remedy, "mend book-deviation");
    }

    /// A right flight of a light jet, fast and light, 16 % off its book: a mass in another unit would be farther off. What a guide may
    /// have made is not blamed on one flight alone.
    #[test]
    fn causes_are_those_that_the_size_admits() {
        let (cause, remedy) = causes(15.7, Some(0.21), Compared::Tail);
        assert!(!cause.contains("declared") && !remedy.contains("ZFW"), "{cause}: {remedy}");
        let (cause, _) = causes(57.0, Some(0.21), Compared::Tail);
        assert!(cause.starts_with("mass in kg declared as lb"), "{cause}");
        let (cause, _) = causes(-55.0, Some(0.9), Compared::Tail);
        assert!(cause.starts_with("mass in lb declared as kg"), "{cause}");
        // A guide with the flow of one engine of two makes every flight of the tail twice its book.
        for (percent, guide) in [(118.4, "of one engine"), (-54.6, "lb/h declared as kg/h")] {
            let (of_tail, _) = causes(percent, Some(0.35), Compared::Tail);
            assert!(of_tail.contains(&format!("the guide's flow: {guide}")), "{of_tail}");
            let (of_one, _) = causes(percent, Some(0.35), Compared::OneFlight);
            assert!(!of_one.contains("guide"), "{of_one}");
        }
    }
}
