//! The page of fleets made up: numbers as in the document, odd names, two hundred tails.

use pipeline::diagnosis_document::MagnitudeRecord;
use pipeline::fleet_diagnosis::{
    FleetEffectRecord, FleetFindingRecord, FleetGap, FleetRecord, FleetTailRecord,
};
use pipeline::summary::ReportsSummary;

use super::{FleetRun, fleet_diagnosis};

const EFFECTS: [&str; 3] = ["zero_lift_drag", "temperature_bias", "fuel_flow_gain"];

fn effect(place: usize, value: f64) -> FleetEffectRecord {
    let unit = ["counts", "K", "%"][place].to_owned();
    let magnitude = MagnitudeRecord { value, unit, ci95: [value - 0.5, value + 0.5] };
    FleetEffectRecord { effect: EFFECTS[place].to_owned(), magnitude }
}

fn finding(tail: Option<&str>, place: usize, value: f64, levels: &[&str]) -> FleetFindingRecord {
    let FleetEffectRecord { effect, magnitude } = effect(place, value);
    FleetFindingRecord {
        level: levels[0].to_owned(),
        levels: levels.iter().map(|&level| level.to_owned()).collect(),
        tail: tail.map(ToOwned::to_owned),
        class: vec![effect.clone()],
        effect,
        probability: 0.987,
        effect_probability: 0.912,
        magnitude,
    }
}

/// Tails whose temperatures differ, each fifth of them by 3 K.
fn fleet(names: &[String]) -> FleetRecord {
    let tails = names.iter().enumerate().map(|(k, name)| FleetTailRecord {
        tail: name.clone(),
        flights: 7 + k,
        segments: 31 + k,
        noise: 1.0 + 0.001 * k as f64,
        effects: vec![
            effect(0, 8.0 + 0.0123 * k as f64),
            effect(1, if k % 5 == 0 { 3.0 } else { 0.0 } + 0.001_7 * k as f64),
        ],
    });
    let mut findings = vec![finding(None, 0, 8.0, &["type"])];
    let odd = names.iter().step_by(5);
    findings.extend(odd.map(|name| finding(Some(name), 1, 3.0, &["sensor", "tail"])));
    if let Some(found) = findings.last_mut() {
        found.class.push("mach_bias".to_owned());
    }
    FleetRecord {
        aircraft_type: "GLEX <&>".to_owned(),
        model_of: "type".to_owned(),
        taught: true,
        mean_gap_percent: None,
        findings,
        false_share: 0.0123,
        spread_of_typical: 0.25,
        smooth_discrepancy_percent: 0.31,
        effects: vec![effect(0, 8.0), effect(1, 0.04), effect(2, 0.1)],
        tails: tails.collect(),
        left_out: vec!["GROUNDED".to_owned()],
    }
}

fn page(fleets: &[FleetRecord]) -> String {
    let reports = ReportsSummary { read: 12, ..ReportsSummary::default() };
    let options = ["trim criteria steady".to_owned()];
    let run =
        FleetRun { reports: &reports, fleets, diagnoses: &[], figures: &[], options: &options };
    fleet_diagnosis(&run)
}

fn names(count: usize) -> Vec<String> {
    (0..count).map(|k| format!("T-{k:03}")).collect()
}

#[test]
fn every_number_of_the_document_is_on_the_page() {
    let record = fleet(&names(12));
    let page = page(std::slice::from_ref(&record));
    let has = |value: f64| assert!(page.contains(&format!("data-v=\"{value}\"")), "{value}");
    for tail in &record.tails {
        assert!(page.contains(&format!("<th scope=\"row\">{}</th>", tail.tail)));
        for value in tail.effects.iter().map(|effect| effect.magnitude.value) {
            has(value);
        }
        for value in [tail.flights as f64, tail.segments as f64, tail.noise] {
            has(value);
        }
    }
    let of_type = record.effects.iter().map(|effect| &effect.magnitude);
    for magnitude in of_type.chain(record.findings.iter().map(|found| &found.magnitude)) {
        has(magnitude.value);
        has(magnitude.ci95[0]);
        has(magnitude.ci95[1]);
    }
    for found in &record.findings {
        has(found.probability);
        has(found.effect_probability);
    }
    assert!(page.contains("or more; 1.2 % expected to be false"), "{page}");
    assert!(page.contains("GROUNDED") && page.contains("GLEX &lt;&amp;&gt;"));
    assert!(page.contains("temperature_bias or mach_bias"));
    assert!(!page.contains("NaN") && !page.contains("inf\""));
}

/// Against a model that no flight has taught, what all share is not offered as an effect to apply.
#[test]
fn an_untaught_table_is_doubted_before_an_effect() {
    let mut record = fleet(&names(12));
    record.findings.truncate(1);
    assert!(page(std::slice::from_ref(&record)).contains("Put what all share into the model"));
    record.taught = false;
    let of_untaught = page(&[record]);
    assert!(of_untaught.contains("may be an error of its table"), "{of_untaught}");
    assert!(!of_untaught.contains("Put what all share"));
}

#[test]
fn those_with_findings_come_first() {
    let page = page(&[fleet(&names(12))]);
    let rows: Vec<&str> = page
        .split("<table class=\"fleet heat")
        .nth(1)
        .and_then(|table| table.split("<tfoot").next())
        .unwrap()
        .split("<th scope=\"row\">")
        .skip(1)
        .map(|row| row.split('<').next().unwrap())
        .collect();
    // By hand: T-000, T-005 and T-010 have findings, and T-010 differs most (3.017 K less the type's 0.04 K).
    assert_eq!(rows[..4], ["T-010", "T-005", "T-000", "T-001"]);
    assert_eq!(rows.len(), 12);
}

/// One engine burns more on a tail and less on another: each is said at its own sign, and the chart says both.
#[test]
fn both_signs_of_an_effect_are_said_apart() {
    let mut record = fleet(&names(12));
    record.findings.retain(|found| found.tail.as_deref() != Some("T-010"));
    record.findings.push(finding(Some("T-001"), 1, -2.0, &["tail", "sensor"]));
    let page = page(&[record]);
    let line = |words: &str| page.split(words).nth(1).unwrap().split("</div>").next().unwrap();
    let (high, low) = (line("<b>SAT reads high</b>"), line("<b>SAT reads low</b>"));
    assert!(high.contains("T-000") && !high.contains("T-001"), "{high}");
    assert!(low.contains("T-001") && !low.contains("T-000"), "{low}");
    assert!(page.contains("Above zero: SAT reads high; below: SAT reads low"), "{page}");
    // Each may be a sensor: that none is off is not said beside it.
    assert!(page.contains("None for certain") && !page.contains("None is found to be off"));
}

#[test]
fn two_hundred_tails_can_be_mailed() {
    let mut names = names(200);
    names[60] = "<b onmouseover=alert(1)>&\"N1\"".to_owned();
    let page = page(&[fleet(&names)]);
    assert!(page.len() < 6_000_000, "{}", page.len());
    assert!(!page.contains("<b onmouseover"));
}

#[test]
fn a_fleet_without_findings_or_tails_is_a_page() {
    let mut quiet = fleet(&names(3));
    quiet.findings.clear();
    for tail in &mut quiet.tails {
        tail.effects.clear();
    }
    let mut empty = quiet.clone();
    empty.tails.clear();
    let page = page(&[quiet, empty]);
    assert!(page.contains("Nothing that the model lacks."), "{page}");
    assert!(!page.contains("NaN"));
}

/// Every tail burns 2 % more and no effect stands out: the model is not what it should be. By hand: 2.0, 2.1 and 2.2 % have the mean
/// 2.1 and the standard deviation 0.1; Student's quantile of two degrees of freedom is 4.303, the half width 0.25.
#[test]
fn what_all_share_is_said_though_its_cause_is_not_known() {
    let mut quiet = fleet(&names(3));
    quiet.findings.clear();
    quiet.mean_gap_percent = FleetGap::of_tails(&[2.0, 2.1, 2.2]);
    let told = page(&[quiet.clone()]);
    assert!(told.contains("burn 2.10 % (1.85 to 2.35) more than the model says"), "{told}");
    assert!(!told.contains("the model can stay as it is"), "{told}");
    quiet.mean_gap_percent = FleetGap::of_tails(&[-0.3, 0.2, 0.4]);
    assert!(page(&[quiet]).contains("the model can stay as it is"));
    assert_eq!(FleetGap::of_tails(&[2.0]), None);
}
