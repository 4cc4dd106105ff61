//! Every kind of finding that `cruisefit check` knows is planted once, and recordings that are right have none.

use std::collections::BTreeSet;
use std::path::PathBuf;

use crate::check::{SLIPS, Slip, check, codes, column, document, header, planted, unit};
use crate::support::{cruisefit, initial_model, root};

/// Kinds that need two flights or more, each planted in a test of its own.
const OF_SEVERAL_FLIGHTS: [&str; 3] = ["flight-copied", "flights-overlap", "date-wrong"];

/// The report's first rows.
fn first_rows(text: &str, rows: usize) -> String {
    let before = text.lines().position(|line| line.starts_with("TIME")).unwrap() + 2;
    text.lines().take(before + rows).collect::<Vec<_>>().join("\n") + "\n"
}

/// A column that is worked out of the row's number and its fuel used.
fn with_column(text: &str, [name, unit]: [&str; 2], value: fn(f64, f64) -> f64) -> String {
    let names = text.lines().position(|line| line.starts_with("TIME")).unwrap();
    let header: Vec<&str> = text.lines().nth(names).unwrap().split_whitespace().collect();
    let fuel_used = header.iter().position(|word| *word == "FU").unwrap();
    let lines = text.lines().enumerate().map(|(index, line)| match index {
        _ if index < names => line.to_owned(),
        _ if index == names => format!("{line} {name}"),
        _ if index == names + 1 => format!("{line} {unit}"),
        _ => {
            let word = line.split_whitespace().nth(fuel_used).unwrap();
            let row = (index - names - 2) as f64;
            format!("{line} {:.1}", value(row, word.parse().unwrap()))
        }
    });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

/// The report without the columns that `check` could compare ground speed and angles with.
fn without_positions(text: &str) -> String {
    ["LAT", "LON"]
        .iter()
        .fold(text.to_owned(), |text, name| text.replacen(name, &format!("X-{name}"), 1))
}

/// Each row so many times, a minute apart.
fn slowed(text: &str, times: usize) -> String {
    let before = text.lines().position(|line| line.starts_with("TIME")).unwrap() + 2;
    let mut lines: Vec<String> = text.lines().take(before).map(str::to_owned).collect();
    for (row, line) in text.lines().skip(before).enumerate() {
        let (_, rest) = line.trim_start().split_once(' ').unwrap();
        lines.extend((0..times).map(|time| format!("{} {rest}", 60 * (row * times + time))));
    }
    lines.join("\n") + "\n"
}

/// Ground speeds end at what three quarters of the samples exceed, as if the recorder's range did.
fn clipped(text: &str) -> String {
    let names = text.lines().position(|line| line.starts_with("TIME")).unwrap();
    let place = |line: &str| line.split_whitespace().position(|word| word == "GSPD").unwrap();
    let speed = place(text.lines().nth(names).unwrap());
    let mut speeds: Vec<f64> = text
        .lines()
        .skip(names + 2)
        .map(|line| line.split_whitespace().nth(speed).unwrap().parse().unwrap())
        .collect();
    speeds.sort_by(f64::total_cmp);
    let limit = speeds[speeds.len() / 4];
    let lines = text.lines().enumerate().map(|(index, line)| {
        if index < names + 2 {
            return line.to_owned();
        }
        let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        words[speed] = words[speed].parse::<f64>().unwrap().min(limit).to_string();
        words.join(" ")
    });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

/// The kinds that no slip of a single column shows.
const MORE_SLIPS: [Slip; 12] = [
    ("another type", |text| header(text, "AIRCRAFT", "A320"), "no-model-of-its-own"),
    (
        "FQ: kg declared as lb",
        |text| with_column(text, ["FQ", "lb"], |_, used| 0.453_592_37 * (15_670.0 - used)),
        "fuel-quantity-against-flow",
    ),
    (
        "SAT: total air temperature, and VTAS derived from it",
        |text| {
            let warm = column(text, "SAT", |sat| (sat + 273.15) * 1.128 - 273.15);
            column(&warm, "VTAS", |speed| speed * f64::sqrt(1.128))
        },
        "temperature-against-altitude",
    ),
    (
        "GSPD: m/s declared as kt, no position",
        |text| column(&without_positions(text), "GSPD", |speed| 0.514_444 * speed),
        "wind-impossible",
    ),
    (
        "HDG: magnetic",
        |text| column(text, "HDG", |heading| (heading + 15.0).rem_euclid(360.0)),
        "heading-against-track",
    ),
    (
        "ROLL: sign",
        // A right turn of 3 degrees a minute, recorded with the left wing down.
        |text| {
            let text = text.replacen("HDG", "X-HDG", 1);
            let turning = with_column(&text, ["HDG", "deg"], |row, _| 20.0 + 3.0 * row.min(20.0));
            column(&turning, "ROLL", |_| -6.0)
        },
        "roll-sign",
    ),
    (
        "WF and FU: lb declared as kg",
        |text| unit(&unit(text, "WF", "kg/h"), "FU", "kg"),
        "flow-against-mass",
    ),
    ("ZFW: digits too many", |text| header(text, "ZFW", "2000000 lb"), "mass-impossible"),
    ("HDG: radians", |text| column(text, "HDG", f64::to_radians), "heading-scale"),
    ("several flights in one", |text| slowed(text, 12), "duration-impossible"),
    ("a report cut short", |text| first_rows(text, 4), "duration-short"),
    ("GSPD: clipped", clipped, "channel-saturated"),
];

/// The findings of three flights with a slip: code, message, likely cause and remedy of each.
fn told(slip: fn(&str) -> String) -> Vec<[String; 4]> {
    let folder = tempfile::tempdir().unwrap();
    let model = initial_model(folder.path());
    let json = folder.path().join("check.json");
    check(&planted(folder.path(), slip), Some(&model), &json);
    let document = document(&json);
    let word = |finding: &serde_json::Value, key: &str| finding[key].as_str().unwrap().to_owned();
    let findings = document["findings"].as_array().unwrap().iter();
    let keys = ["code", "message", "likely_cause", "remedy"];
    findings.map(|finding| keys.map(|key| word(finding, key))).collect()
}

/// Two engines: neither is named unless fuel used states which one, as it does where it is counted by other meters.
#[test]
fn the_wrong_one_of_two_engines_is_named_only_where_the_data_state_it() {
    let of = |slip| {
        let found = told(slip);
        let asymmetry = found.into_iter().find(|[code, ..]| code == "engine-asymmetry");
        asymmetry.unwrap_or_else(|| panic!("no asymmetry"))
    };
    let [_, message, _, remedy] = of(|text| column(text, "WF(1)", |flow| 2.0 * flow));
    assert!(message.starts_with("engine 1 burns +"), "{message}");
    assert!(remedy.contains("the meter of engine 1"), "{remedy}");
    let [_, message, _, remedy] = of(|text| column(text, "WF(2)", |flow| 2.0 * flow));
    assert!(message.starts_with("engine 2 burns +"), "{message}");
    assert!(remedy.contains("the meter of engine 2"), "{remedy}");
    // A counter that adds up the meters is as wrong as they are.
    let [_, message, _, remedy] = of(|text| {
        let text = column(text, "WF(2)", |flow| (1.08 * flow).round());
        column(&text, "FU", |used| (1.04 * used).round())
    });
    assert!(message.contains("which of the two it is these data do not state"), "{message}");
    assert!(remedy.contains("both engines"), "{remedy}");
}

/// A calibrated airspeed in the place of the true one: by the formula of the standard atmosphere, not by half.
fn calibrated(text: &str) -> String {
    let names = text.lines().position(|line| line.starts_with("TIME")).unwrap();
    let header: Vec<&str> = text.lines().nth(names).unwrap().split_whitespace().collect();
    let place = |name: &str| header.iter().position(|word| *word == name).unwrap();
    let (altitude, mach, speed) = (place("ALT"), place("MACH"), place("VTAS"));
    let lines = text.lines().enumerate().map(|(index, line)| {
        if index < names + 2 {
            return line.to_owned();
        }
        let mut words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        let number = |place: usize| words[place].parse::<f64>().unwrap();
        // Above 11 km, by hand: 226.32 hPa and 6341.6 m of scale height; 1013.25 hPa and 661.4786 kt at sea level.
        let metres = 0.3048 * number(altitude);
        let pressure_hpa = if metres > 11_000.0 {
            226.32 * f64::exp(-(metres - 11_000.0) / 6341.6)
        } else {
            1013.25 * (1.0 - 2.25577e-5 * metres).powf(5.25588)
        };
        let impact_hpa = pressure_hpa * ((1.0 + 0.2 * number(mach).powi(2)).powf(3.5) - 1.0);
        let squared = 5.0 * ((impact_hpa / 1013.25 + 1.0).powf(1.0 / 3.5) - 1.0);
        words[speed] = format!("{:.1}", 661.4786 * squared.sqrt());
        words.join(" ")
    });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

#[test]
fn a_calibrated_airspeed_is_one_slip_and_no_wrong_unit_of_anything() {
    let found = told(calibrated);
    let mut of_speed = found.iter().filter(|[code, ..]| code == "true-airspeed-against-mach");
    assert!(of_speed.clone().count() > 0, "{found:?}");
    assert!(of_speed.all(|[.., cause, _]| cause == "VTAS holds calibrated airspeed"), "{found:?}");
    for [code, _, cause, remedy] in &found {
        assert!(code != "wind-impossible", "{found:?}");
        assert!(!cause.contains("declared as") && !remedy.contains("unit lb"), "{found:?}");
    }
}

/// Any heading that is 15 degrees off: the drift angle's sign is right, whatever the drift was.
#[test]
fn a_magnetic_heading_does_not_turn_the_drift_round() {
    for slip in [
        (|text| column(text, "HDG", |heading| (heading + 15.0).rem_euclid(360.0)))
            as fn(&str) -> String,
        |text| column(text, "HDG", |heading| (heading - 15.0).rem_euclid(360.0)),
        |text| column(text, "HDG", |heading| (heading + 8.0).rem_euclid(360.0)),
    ] {
        let found = told(slip);
        assert!(found.iter().any(|[code, ..]| code == "heading-against-track"), "{found:?}");
        assert!(found.iter().all(|[code, ..]| code != "drift-sign"), "{found:?}");
    }
    let found = told(|text| column(text, "DRIFT", |drift| -drift));
    assert!(found.iter().any(|[code, ..]| code == "drift-sign"), "{found:?}");
    assert!(found.iter().all(|[code, ..]| code != "heading-against-track"), "{found:?}");
}

#[test]
fn every_kind_of_finding_is_planted() {
    let folder = tempfile::tempdir().unwrap();
    let model = initial_model(folder.path());
    let json = folder.path().join("check.json");
    let mut missed = Vec::new();
    for (name, slip, expected) in MORE_SLIPS {
        let reports = planted(folder.path(), slip);
        let ran = check(&reports, Some(&model), &json);
        let found = if ran.status == 2 { vec![ran.stderr] } else { codes(&document(&json)) };
        if !found.iter().any(|code| code == expected) {
            missed.push(format!("{name}: {found:?}\n{}", ran.stdout));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
    // The page lists every kind; each of them is expected of some slip.
    let planted: BTreeSet<&str> = (SLIPS.iter().chain(&MORE_SLIPS).map(|(_, _, code)| *code))
        .chain(OF_SEVERAL_FLIGHTS)
        .chain(["rows-left-out", "minutes-left-out", "channel-spiked", "not-evaluated"])
        .collect();
    let page = std::fs::read_to_string(root().join("docs/src/guides/check.md")).unwrap();
    let listed: Vec<&str> = page
        .lines()
        .filter(|line| line.starts_with("| `"))
        .filter_map(|line| line.split('|').nth(1))
        .flat_map(|cell| cell.split('`').skip(1).step_by(2))
        .collect();
    assert!(listed.len() > 25, "{listed:?}");
    let never: Vec<&&str> = listed.iter().filter(|code| !planted.contains(*code)).collect();
    assert!(never.is_empty(), "listed and never planted: {never:?}");
}

#[test]
fn layouts_read_with_their_first_mapping_have_no_finding() {
    let folder = tempfile::tempdir().unwrap();
    let mapping = folder.path().join("M.ron");
    let json = folder.path().join("check.json");
    let mut layouts: Vec<PathBuf> = std::fs::read_dir(root().join("fixtures/layouts"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_none_or(|ending| ending != "py"))
        .collect();
    layouts.sort();
    assert_eq!(layouts.len(), 25);
    for layout in layouts {
        cruisefit(&[
            "mapping".as_ref(),
            layout.as_os_str(),
            "--force".as_ref(),
            "-o".as_ref(),
            mapping.as_os_str(),
        ])
        .expect(0);
        // The date and the mass are what a person has to state.
        let text = std::fs::read_to_string(&mapping).unwrap().replace("YYYY-MM-DD", "2024-03-01");
        let text = text.replace("Column(\"ZERO FUEL WEIGHT\", \"kg\")", "Value(10000, \"kg\")");
        std::fs::write(&mapping, text).unwrap();
        let ran = cruisefit(&[
            "check".as_ref(),
            layout.as_os_str(),
            "--mapping".as_ref(),
            mapping.as_os_str(),
            "--json".as_ref(),
            json.as_os_str(),
        ])
        .expect(0);
        assert_eq!(codes(&document(&json)), Vec::<String>::new(), "{}", ran.stdout);
    }
}

/// Ten minutes at one sample a second, then ten at one in 40 s, of which every minute has less than half of its samples.
#[test]
fn minutes_with_too_few_samples_are_a_finding_and_explained() {
    let slower = |text: &str| {
        let before = text.lines().position(|line| line.starts_with("TIME")).unwrap() + 2;
        let mut lines: Vec<String> = text.lines().take(before).map(str::to_owned).collect();
        let (_, rest) = text.lines().nth(before).unwrap().trim_start().split_once(' ').unwrap();
        let times = (0..600).chain((600..1200).step_by(40));
        lines.extend(times.map(|time| format!("{time} {rest}")));
        lines.join("\n") + "\n"
    };
    let found = told(slower);
    let of_minutes = found.iter().find(|[code, ..]| code == "minutes-left-out");
    let [_, message, ..] = of_minutes.unwrap_or_else(|| panic!("{found:?}"));
    assert_eq!(
        message,
        "15 minutes with less than half of their samples are left out, 10 are used"
    );
    let folder = tempfile::tempdir().unwrap();
    let mut arguments: Vec<std::ffi::OsString> = vec!["segment".into(), "--explain".into()];
    arguments.extend(planted(folder.path(), slower).into_iter().map(PathBuf::into_os_string));
    let ran = cruisefit(&arguments);
    assert!(ran.stderr.contains("15 minutes dropped for too few samples"), "{}", ran.stderr);
}

/// Twenty minutes at one sample a second, of which every fiftieth has ten times the fuel flow of engine 1: 24 of 1200, nine times the
/// mean too much, 18 %.
#[test]
fn spikes_of_fuel_flow_are_a_finding() {
    let spiked = |text: &str| {
        let row = |text: &str| {
            let before = text.lines().position(|line| line.starts_with("TIME")).unwrap() + 2;
            let line = text.lines().nth(before).unwrap().trim_start().to_owned();
            (before, line.split_once(' ').unwrap().1.to_owned())
        };
        let (before, usual) = row(text);
        let (_, high) = row(&column(text, "WF(1)", |flow| 10.0 * flow));
        let mut lines: Vec<String> = text.lines().take(before).map(str::to_owned).collect();
        lines.extend((0..1200).map(|time| {
            let rest = if time % 50 == 7 { &high } else { &usual };
            format!("{time} {rest}")
        }));
        lines.join("\n") + "\n"
    };
    let found = told(spiked);
    let of_spikes = found.iter().find(|[code, ..]| code == "channel-spiked");
    let [_, message, ..] = of_spikes.unwrap_or_else(|| panic!("{found:?}"));
    assert_eq!(
        message,
        "24 of 1200 samples of WF(1) are more than 30 % off those beside them and move its mean by +18.0 %"
    );
}

/// A tenth of the rows of a recording cannot be read.
#[test]
fn rows_that_a_mapping_leaves_out_are_a_finding() {
    let folder = tempfile::tempdir().unwrap();
    let [recording, mapping, json] =
        ["R.csv", "M.ron", "check.json"].map(|name| folder.path().join(name));
    let path = root().join("fixtures/layouts/01_named_units.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let spoilt = |(row, line): (usize, &str)| {
        if row % 10 == 5 { "oops\n".to_owned() } else { format!("{line}\n") }
    };
    std::fs::write(&recording, text.lines().enumerate().map(spoilt).collect::<String>()).unwrap();
    let made: [&std::ffi::OsStr; 4] =
        ["mapping".as_ref(), recording.as_ref(), "-o".as_ref(), mapping.as_ref()];
    cruisefit(&made).expect(0);
    let checked: [&std::ffi::OsStr; 6] = [
        "check".as_ref(),
        recording.as_ref(),
        "--mapping".as_ref(),
        mapping.as_ref(),
        "--json".as_ref(),
        json.as_ref(),
    ];
    cruisefit(&checked).expect(0);
    assert_eq!(codes(&document(&json)), ["rows-left-out"]);
}
