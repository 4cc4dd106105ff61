//! Fuel flow against the fuel that it should add up to, and engine against engine.

use flight::column::Column;
use flight::{FuelFlowColumns, Report, Severity};

use super::slips::{self, FUEL};
use super::{Draft, mean};

/// Shortest time over which an integral is compared with a counter, s: below it a counter in steps of 10 kg says little.
const SHORTEST_S: f64 = 600.0;
/// Difference of fuel used and integral that is worth a word. Flow meters are good to 1 %, counters add the same flow;
/// a meter that is read 3 % high by one of the two computers is within this.
const WARNING_SHARE: f64 = 0.04;
/// Difference above which mass or flow is wrong by more than any meter.
const SERIOUS_SHARE: f64 = 0.12;
/// Coarsest step of a counter that is allowed for, kg.
const COUNTER_STEP_KG: f64 = 10.0;
/// Engines at the same rotor speed burn the same within a few per cent; a worn engine 3 %.
const ASYMMETRY_SHARE: f64 = 0.05;
/// Rotor speeds that are called the same, % of rated speed.
const SAME_ROTOR_SPEED_PERCENT: f64 = 0.6;

/// The longest gap within a flight, s: as in a mapping that states none. What is burnt over a longer one nobody recorded.
const LONGEST_GAP_S: f64 = 10_800.0;

/// A mass that falls as seldom, in more samples than these, is not that of each sample. Our choice.
const MOST_STEPS: usize = 5;
const FEWEST_ROWS: usize = 100;

/// Code of the finding that fuel used and fuel flow do not add up.
pub(super) const USED_AGAINST_FLOW: &str = "fuel-used-against-flow";

pub(super) fn check(report: &Report, flow_kg_s: &[f64]) -> Vec<Draft> {
    let mut findings: Vec<Draft> = used_against_flow(report, flow_kg_s).into_iter().collect();
    findings.extend(quantity_against_flow(report, flow_kg_s));
    findings.extend(asymmetry(report, flow_kg_s));
    findings
}

/// Fuel burnt between the first and the last sample by the meters: trapezoids, kg.
fn integral_kg(time_s: &[f64], flow_kg_s: &[f64]) -> f64 {
    let steps = time_s.windows(2).zip(flow_kg_s.windows(2));
    steps.map(|(time_s, flow)| 0.5 * (flow[0] + flow[1]) * (time_s[1] - time_s[0])).sum()
}

fn used_against_flow(report: &Report, flow_kg_s: &[f64]) -> Option<Draft> {
    let columns = report.columns();
    let last = report.len() - 1;
    if columns.time_s[last] - columns.time_s[0] < SHORTEST_S {
        return None;
    }
    let by_flow_kg = integral_kg(&columns.time_s, flow_kg_s);
    let by_counter_kg = columns.fuel_used_kg[last] - columns.fuel_used_kg[0];
    let ratio = by_counter_kg / by_flow_kg;
    let allowed = COUNTER_STEP_KG / by_flow_kg;
    if (ratio - 1.0).abs() < WARNING_SHARE + allowed {
        return None;
    }
    let (likely_cause, remedy) = explain(ratio, report);
    let serious = (ratio - 1.0).abs() > SERIOUS_SHARE + allowed;
    Some(Draft {
        severity: if serious { Severity::Serious } else { Severity::Warning },
        code: USED_AGAINST_FLOW,
        size: ratio,
        unit: "-",
        message: format!(
            "fuel used rises by {by_counter_kg:.0} kg, the integral of fuel flow is {by_flow_kg:.0} kg: ratio {ratio:.3}"
        ),
        likely_cause,
        remedy,
    })
}

/// The longest time without a sample, where it is no gap within a flight: when it begins and how long it is, s.
fn gap_between_flights_s(time_s: &[f64]) -> Option<(f64, f64)> {
    let gaps = time_s.windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
    gaps.max_by(|one, other| one.1.total_cmp(&other.1)).filter(|(_, gap_s)| *gap_s > LONGEST_GAP_S)
}

/// How often a counter of fuel used rises.
fn steps_of_counter(fuel_used_kg: &[f64]) -> usize {
    fuel_used_kg.windows(2).filter(|pair| pair[1] > pair[0]).count()
}

fn explain(ratio: f64, report: &Report) -> (String, String) {
    if let Some((from_s, gap_s)) = gap_between_flights_s(&report.columns().time_s) {
        return (
            format!("a gap of {gap_s:.0} s from {from_s:.0} s on: two flights of one number?"),
            "new_flight_after_s in the mapping, or one report for each flight".to_owned(),
        );
    }
    if ratio.abs() < 0.02 {
        return (
            "FU does not count: it is constant, or it is not fuel used".to_owned(),
            "map FU to the counter of fuel used, or derive mass from gross weight".to_owned(),
        );
    }
    let steps = steps_of_counter(&report.columns().fuel_used_kg);
    if (1..=MOST_STEPS).contains(&steps) && report.len() > FEWEST_ROWS {
        return (
            "mass stays while fuel is burnt: a take-off mass for the gross mass".to_owned(),
            "StartMass in the mapping, with a flight for each take-off mass".to_owned(),
        );
    }
    // Where only a total is recorded the number of engines is unknown: 2, 3 and 4 are tried.
    let counts = report.engines().map_or(2..=4, |engines| engines..=engines);
    for engines in counts.filter(|engines| *engines > 1) {
        #[expect(clippy::cast_precision_loss, reason = "engines are at most four")]
        let factor = engines as f64;
        if slips::is_near(ratio, factor) {
            return (
                format!("WF is the flow of one of {engines} engines"),
                format!("scale {engines} for WF, or one WF(k) for each engine"),
            );
        }
        if slips::is_near(ratio, 1.0 / factor) {
            return (
                format!(
                    "each WF(k) holds the flow of all {engines} engines, or FU counts one engine"
                ),
                "WF instead of WF(k), or FU of all engines".to_owned(),
            );
        }
    }
    match slips::find(&FUEL, ratio) {
        Some(slip) => (slip.cause.to_owned(), slip.remedy.to_owned()),
        None => (
            "unit of WF, FU or TIME; a meter that reads wrong; a counter of one engine".to_owned(),
            "compare the units of WF, FU and TIME with the recorder's list".to_owned(),
        ),
    }
}

/// Tank gauges against flow meters.
fn quantity_against_flow(report: &Report, flow_kg_s: &[f64]) -> Option<Draft> {
    let columns = report.columns();
    let quantity = columns.optional.get(Column::FuelQuantity)?;
    let first = quantity.iter().position(Option::is_some)?;
    let last = quantity.iter().rposition(Option::is_some)?;
    if columns.time_s[last] - columns.time_s[first] < 3.0 * SHORTEST_S {
        return None;
    }
    let by_gauges_kg = quantity[first]? - quantity[last]?;
    let by_flow_kg = integral_kg(&columns.time_s[first..=last], &flow_kg_s[first..=last]);
    let ratio = by_gauges_kg / by_flow_kg;
    // Gauges are good to 1 % of what the tanks hold, which may be ten times what was burnt here.
    let allowed = 0.01 * quantity[first]? / by_flow_kg;
    if (ratio - 1.0).abs() < 2.0 * WARNING_SHARE + allowed {
        return None;
    }
    let slip = slips::find(&FUEL, ratio);
    Some(Draft {
        severity: Severity::Warning,
        code: "fuel-quantity-against-flow",
        size: ratio,
        unit: "-",
        message: format!(
            "fuel quantity falls by {by_gauges_kg:.0} kg, the integral of fuel flow is {by_flow_kg:.0} kg: ratio {ratio:.3}"
        ),
        likely_cause: slip
            .map_or("unit of FQ, or one tank instead of all", |slip| slip.cause)
            .to_owned(),
        remedy: "declare FQ in the unit of its recorder, summed over all tanks".to_owned(),
    })
}

/// Engines that burn differently at the same rotor speed.
fn asymmetry(report: &Report, flow_kg_s: &[f64]) -> Option<Draft> {
    let columns = report.columns();
    let FuelFlowColumns::PerEngine(flows) = &columns.fuel_flow else { return None };
    let mut worst: Option<(f64, usize, &'static str)> = None;
    let together = mean(flow_kg_s.iter().copied())?;
    #[expect(clippy::cast_precision_loss, reason = "engines are at most four")]
    let average = together / flows.len() as f64;
    for (engine, flow) in flows.iter().enumerate() {
        let share = mean(flow.iter().copied())? / average - 1.0;
        let Some((difference, rotor)) = rotor_difference(report, engine) else { continue };
        if share.abs() > 0.5 * ASYMMETRY_SHARE
            && difference.abs() < SAME_ROTOR_SPEED_PERCENT
            && worst.is_none_or(|(known, ..)| share.abs() > known.abs())
        {
            worst = Some((share, engine + 1, rotor));
        }
    }
    let (share, engine, rotor) = worst?;
    let named = if flows.len() == 2 { wrong_of_two(report, flows) } else { Some(engine) };
    let of = named.unwrap_or(1);
    // Against the other engines, not against the average that holds this one too; of two, either is as far off as the other.
    #[expect(clippy::cast_precision_loss, reason = "engines are at most four")]
    let engines = flows.len() as f64;
    let share = if of == engine { share } else { -share };
    let others = (engines - 1.0 - share) / (engines - 1.0);
    let percent = 100.0 * ((1.0 + share) / others - 1.0);
    let (message, remedy) = match named {
        Some(engine) => (
            format!("engine {engine} burns {percent:+.1} % against the others at the same {rotor}"),
            format!(
                "compare the meter of engine {engine}; leave it as it is if the engine is worn"
            ),
        ),
        None => (
            format!(
                "engine 1 burns {percent:+.1} % against engine 2 at the same {rotor}: which of the two it is these data do not state"
            ),
            "compare the meters of both engines; leave them as they are if one is worn".to_owned(),
        ),
    };
    Some(Draft {
        severity: Severity::Warning,
        code: "engine-asymmetry",
        size: percent,
        unit: "%",
        message,
        likely_cause: "a flow meter that reads wrong, or an engine that is worn".to_owned(),
        remedy,
    })
}

/// Which of two engines has the wrong meter (from 1), as fuel used states it: what it leaves for that engine beside the other one's
/// meter is what the other one burns, and not so the other way round. `None` where fuel used does not state it, for instance because
/// it adds up the same meters.
fn wrong_of_two(report: &Report, flows: &[Vec<f64>]) -> Option<usize> {
    let columns = report.columns();
    let last = report.len() - 1;
    if columns.time_s[last] - columns.time_s[0] < SHORTEST_S {
        return None;
    }
    let used_kg = columns.fuel_used_kg[last] - columns.fuel_used_kg[0];
    let by_meters_kg: Vec<f64> =
        flows.iter().map(|flow| integral_kg(&columns.time_s, flow)).collect();
    let &[first_kg, second_kg] = by_meters_kg.as_slice() else { return None };
    let allowed = ASYMMETRY_SHARE + COUNTER_STEP_KG / used_kg.max(COUNTER_STEP_KG);
    let leaves_as_much =
        |by_other_kg: f64| ((used_kg - by_other_kg) / by_other_kg - 1.0).abs() < allowed;
    match (leaves_as_much(second_kg), leaves_as_much(first_kg)) {
        (true, false) => Some(1),
        (false, true) => Some(2),
        _ => None,
    }
}

/// Rotor speed of an engine less the mean of all, %, and which rotor: N1 where it is recorded.
fn rotor_difference(report: &Report, engine: usize) -> Option<(f64, &'static str)> {
    let columns = report.columns();
    let engines = report.engines()?;
    let n1 = |index: usize| Some(Column::N1(u8::try_from(index + 1).ok()?));
    let n1: Option<Vec<f64>> = (0..engines)
        .map(|index| mean(columns.optional.get(n1(index)?)?.iter().flatten().copied()))
        .collect();
    let (means, rotor) = if let Some(means) = n1 {
        (means, "N1")
    } else {
        let n2 = columns.n2_percent.as_ref()?;
        (n2.iter().map(|values| mean(values.iter().copied())).collect::<Option<Vec<_>>>()?, "N2")
    };
    Some((means[engine] - mean(means.iter().copied())?, rotor))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two hours of 1000 kg/h on each side of a gap: with one of 20 hours the integral is 24 t, and 4 t were used.
    #[test]
    fn a_gap_between_two_flights_is_named_as_the_cause() {
        let mut columns = test_support::reports::steady(60.0, 242);
        columns.fuel_flow = FuelFlowColumns::Total(vec![1000.0 / 3600.0; 242]);
        columns.fuel_used_kg = columns.time_s.iter().map(|time_s| time_s / 3.6 / 3.0).collect();
        let cause = |gap_s: f64| {
            let mut columns = columns.clone();
            columns.time_s[121..].iter_mut().for_each(|time_s| *time_s += gap_s - 60.0);
            let report = Report::new(test_support::reports::header(), columns).unwrap();
            let flow_kg_s = report.columns().fuel_flow.totals_kg_s();
            let draft = used_against_flow(&report, &flow_kg_s).unwrap();
            (draft.likely_cause, draft.remedy)
        };
        let (found, remedy) = cause(72_000.0);
        assert_eq!(found, "a gap of 72000 s from 7200 s on: two flights of one number?");
        assert!(remedy.starts_with("new_flight_after_s"), "{remedy}");
        assert!(!cause(10_800.0).0.contains("gap"));
    }

    /// Two take-off masses of two legs, of which the second is 1500 kg less.
    #[test]
    fn a_mass_that_stays_is_a_take_off_mass() {
        let mut columns = test_support::reports::steady(60.0, 242);
        columns.fuel_flow = FuelFlowColumns::Total(vec![2400.0 / 3600.0; 242]);
        columns.fuel_used_kg = vec![0.0; 121];
        columns.fuel_used_kg.resize(242, 1500.0);
        let report = Report::new(test_support::reports::header(), columns).unwrap();
        let flow_kg_s = report.columns().fuel_flow.totals_kg_s();
        let draft = used_against_flow(&report, &flow_kg_s).unwrap();
        assert!(draft.likely_cause.contains("take-off mass"), "{}", draft.likely_cause);
        assert!(draft.remedy.starts_with("StartMass"), "{}", draft.remedy);
    }

    /// Fuel used is twice the integral of flow: one engine of two, but not where a third of the rows is not there.
    #[test]
    fn with_rows_left_out_no_unit_is_blamed() {
        let mut columns = test_support::reports::steady(60.0, 242);
        columns.fuel_flow = FuelFlowColumns::Total(vec![1000.0 / 3600.0; 242]);
        columns.fuel_used_kg = columns.time_s.iter().map(|time_s| time_s / 1.8).collect();
        let report = Report::new(test_support::reports::header(), columns).unwrap();
        let cause = |left_out| {
            let check = super::super::check_report(&report).with_rows_left_out(242, left_out);
            let found = check.findings.into_iter().find(|one| one.code == USED_AGAINST_FLOW);
            found.unwrap().likely_cause
        };
        assert_eq!(cause(0), "WF is the flow of one of 2 engines");
        assert_eq!(cause(121), "the rows that are left out");
    }
}
