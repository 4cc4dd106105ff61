//! The public model against pycontrails 0.63.5, and the guides made of it.
//!
//! `poll_schumann/make_oracle.py` writes the table: four points of each of the 68 types.

#![expect(clippy::unwrap_used, reason = "a test that cannot continue must stop")]

use perf_model::poll_schumann::{self, cruise, find, guide, represented, types};
use perf_model::{Aircraft, Guide, initial_model};
use units::{Mach, Mass, PressureAltitude, TemperatureDifference};

const ORACLE: &str = include_str!("poll_schumann/oracle.csv");

#[test]
fn agrees_with_pycontrails_to_a_millionth() {
    let mut rows = 0;
    for line in ORACLE.lines().skip(1) {
        let (code, numbers) = line.split_once(',').unwrap();
        let numbers: Vec<f64> = numbers.split(',').map(|field| field.parse().unwrap()).collect();
        let [mass, altitude, mach, deviation, lift, drag, efficiency, flow] = numbers[..] else {
            panic!("{line}")
        };
        let ours = cruise(
            find(code).unwrap(),
            Mass::kilograms(mass),
            PressureAltitude::feet(altitude),
            Mach::new(mach),
            TemperatureDifference::kelvin(deviation),
        )
        .unwrap();
        for (found, expected) in [
            (ours.lift_coefficient, lift),
            (ours.drag_coefficient, drag),
            (ours.efficiency, efficiency),
            (ours.fuel_flow_total.to_kilograms_per_second(), flow),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-6, "{line}: {found}, {expected}");
        }
        rows += 1;
    }
    assert_eq!(rows, 4 * 68);
}

#[test]
fn every_type_and_represented_one_is_found() {
    assert_eq!(types().len(), 68);
    assert_eq!(represented().count(), 35);
    for one in represented() {
        assert_eq!(find(one.type_code).unwrap().type_code, one.by, "{}", one.type_code);
        assert!(types().iter().all(|own| !own.is_of(one.type_code)), "{}", one.type_code);
    }
    assert_eq!(find("a320").unwrap().variant, "A320-200");
    assert!(find("C172").is_none());
}

/// Numbers of engines as in ICAO Doc 8643: a C-17 and a Nimrod have four, a 727 three. A type with another number than the one
/// that represents it has no guide; any other says whose it is.
#[test]
fn a_type_with_another_number_of_engines_has_no_guide() {
    let made = |code: &str| guide::guide(code, find(code).unwrap());
    for code in ["C17", "B701", "E3TF", "BLCF", "P1", "NIM", "IL62", "C141", "B721", "SLCH"] {
        let refused = made(code).unwrap_err();
        assert!(matches!(refused, guide::PublicGuideError::Engines { .. }), "{code}: {refused}");
        assert!(types().iter().all(|one| one.stands_for().all(|also| also != code)), "{code}");
    }
    let refused = made("C17").unwrap_err().to_string();
    assert!(refused.starts_with("C17 has 4 engines and B764, the type that represents it, has 2"));
    for (code, engines) in [("B722", 3), ("R721", 3), ("B74S", 4), ("C5", 4), ("P8", 2)] {
        assert_eq!(made(code).unwrap().aircraft.engines, engines, "{code}");
    }
    assert_eq!(made("P8").unwrap().aircraft.name, "Boeing B737-800 (B738), for P8, public model");
    assert!(find("A20N").unwrap().stands_for().eq(["A19N", "C919", "MC23"]));
}

/// The initial model of each guide is within the model's stated accuracy of the model, root mean square.
#[test]
fn every_type_gives_a_guide_that_init_takes_without_a_serious_finding() {
    for parameters in types() {
        let code = &parameters.type_code;
        let made = guide::guide(code, parameters).unwrap();
        let aircraft = Aircraft::new(made.aircraft.clone()).unwrap();
        let guide = Guide::from_csv(made.to_csv().as_bytes()).unwrap();
        assert!(made.points.len() >= 60, "{code}: {} points", made.points.len());
        let deviation = poll_schumann::mean_deviation_percent(parameters, &guide).unwrap();
        assert!(deviation.abs() < 0.05, "{code}: {deviation} %"); // the CSV's rounding
        let initial = initial_model(&aircraft, &guide).unwrap();
        assert!(
            initial.fit.residual_rms_percent < poll_schumann::STATED_ACCURACY_PERCENT,
            "{code}: {} %",
            initial.fit.residual_rms_percent
        );
        assert!(made.tsfc_residual_percent < 5.0, "{code}: {}", made.tsfc_residual_percent);
        for finding in &initial.findings {
            assert!(finding.severity < flight::Severity::Serious, "{code}: {}", finding.message);
            // The best of them fly at 23 times their drag, and no row was typed.
            let is_slip = ["guide-lift-to-drag", "guide-odd-row"].contains(&finding.code);
            assert!(!is_slip, "{code}: {}", finding.message);
        }
    }
}

/// A row that is mistyped is found where the polynomial follows the guide and at the end of a drag rise where it does not: of
/// these five guides the last row at the highest Mach number lies 6 to 8 % off the polynomial.
#[test]
fn a_mistyped_row_is_found_in_a_drag_rise_too() {
    for (code, end_of_rise) in
        [("B734", 204), ("CRJ9", 107), ("E170", 307), ("E75S", 387), ("RJ1H", 290)]
    {
        let made = guide::guide(code, find(code).unwrap()).unwrap();
        let aircraft = Aircraft::new(made.aircraft.clone()).unwrap();
        let csv = made.to_csv();
        for line in [60, end_of_rise] {
            let lines: Vec<String> = csv
                .lines()
                .enumerate()
                .map(|(at, text)| match text.rsplit_once(',') {
                    Some((others, flow)) if at + 1 == line => {
                        format!("{others},{}", 1.12 * flow.parse::<f64>().unwrap())
                    }
                    _ => text.to_owned(),
                })
                .collect();
            let typed = Guide::from_csv(lines.join("\n").as_bytes()).unwrap();
            let initial = initial_model(&aircraft, &typed).unwrap();
            let odd = initial.findings.iter().find(|one| one.code == "guide-odd-row").unwrap();
            assert_eq!(odd.line, Some(line), "{code}: {}", odd.message);
        }
    }
}

/// Slips of a guide: each is serious or warned of. The public model shows them for its types, the ratio of lift to drag for any.
#[test]
fn a_guide_in_the_wrong_unit_is_a_serious_finding() {
    let parameters = find("A320").unwrap();
    for type_code in ["A320", "MY-OWN"] {
        let made = guide::guide(type_code, parameters).unwrap();
        let aircraft = Aircraft::new(made.aircraft.clone()).unwrap();
        let csv = made.to_csv();
        let slips: [(&str, String); 4] = [
            ("lb under kg", scaled(&csv, 0, 2.204_622_6)),
            ("kg under lb", scaled(&csv, 0, 0.453_592_37)),
            ("half the flow", scaled(&csv, 3, 0.5)),
            ("lb/h under kg/h", scaled(&csv, 3, 2.204_622_6)),
        ];
        for (name, text) in slips {
            let guide = Guide::from_csv(text.as_bytes()).unwrap();
            let Ok(initial) = initial_model(&aircraft, &guide) else { continue };
            let worst = initial
                .findings
                .iter()
                .filter(|one| one.code != "guide-extrapolated-nodes")
                .map(|one| one.severity)
                .max();
            // A small aircraft could have such a ratio of lift to drag: without its type there is a warning.
            let is_warning_enough =
                type_code != "A320" && !["lb under kg", "half the flow"].contains(&name);
            let least = if is_warning_enough {
                flight::Severity::Warning
            } else {
                flight::Severity::Serious
            };
            assert!(worst >= Some(least), "{type_code}, {name}: {:?}", initial.findings);
        }
    }
}

/// A column of a CSV times a factor.
fn scaled(csv: &str, column: usize, factor: f64) -> String {
    let mut lines = csv.lines();
    let mut text = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let fields: Vec<String> = line
            .split(',')
            .enumerate()
            .map(|(index, field)| {
                let times = if index == column { factor } else { 1.0 };
                (times * field.parse::<f64>().unwrap()).to_string()
            })
            .collect();
        text.push_str(&fields.join(","));
        text.push('\n');
    }
    text
}
