//! Averaged points: rows that are means over stable frames, as observations in place of reports.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::support::{cruisefit, fixture, initial_model};

/// Segments of the fixture's twelve reports.
fn segments(folder: &Path) -> PathBuf {
    let path = folder.join("segments.csv");
    cruisefit(&[
        "segment".as_ref(),
        fixture("reports").as_os_str(),
        "-o".as_ref(),
        path.as_os_str(),
    ])
    .expect(0);
    path
}

/// A column of a table of comma-separated values.
fn column(table: &str, name: &str) -> Vec<String> {
    let mut lines = table.lines();
    let place = lines.next().unwrap().split(',').position(|column| column == name);
    let place = place.unwrap();
    lines.map(|line| line.split(',').nth(place).unwrap().to_owned()).collect()
}

/// Segments as an airline's ground station writes cruise points: one row each, in the units of the flight deck.
fn as_points(segments: &str) -> String {
    let number = |name: &str| -> Vec<f64> {
        column(segments, name).iter().map(|text| text.parse().unwrap()).collect()
    };
    let (altitude, sat) = (number("pressure_altitude_m"), number("static_air_temperature_k"));
    let (mach, speed) = (number("mach"), number("true_airspeed_m_s"));
    let (ground, mass) = (number("ground_speed_m_s"), number("mass_kg"));
    let flows = [number("fuel_flow_1_kg_s"), number("fuel_flow_2_kg_s")];
    let (time, roll) = (number("time_s"), number("roll_deg"));
    let (tail, flight) = (column(segments, "tail"), column(segments, "flight"));
    let start = column(segments, "start");
    let mut text =
        "reg,flt,day,sec,press alt,oat,mach,tas,gs,gw lb,ff1,ff2,roll,alt sd\n".to_owned();
    for row in 0..time.len() {
        let start: flight::Timestamp = start[row].parse().unwrap();
        let _ = writeln!(
            text,
            "{},{},x,{},{},{},{},{},{},{},{},{},{},3",
            tail[row],
            flight[row],
            flight::seconds_since_1970(start) + time[row],
            altitude[row] / 0.3048,
            sat[row] - 273.15,
            mach[row],
            speed[row] / 1852.0 * 3600.0,
            ground[row] / 1852.0 * 3600.0,
            mass[row] / 0.453_592_37,
            flows[0][row] * 3600.0,
            flows[1][row] * 3600.0,
            roll[row],
        );
    }
    text
}

const MAPPING: &str = r#"(
    format: 1,
    rows: AveragedPoints(averaged_over_s: 60, scatter: [("ALT", "alt sd", "ft")]),
    aircraft: Text("GL5T"),
    tail: Column("reg"),
    flight: Column("flt"),
    time: Epoch(column: "sec", unit: "s"),
    quantities: {
        "ALT": Recorded(column: "press alt", unit: "ft"),
        "SAT": Recorded(column: "oat", unit: "degC"),
        "MACH": Recorded(column: "mach", unit: "-"),
        "VTAS": Recorded(column: "tas", unit: "kt"),
        "GSPD": Recorded(column: "gs", unit: "kt"),
        "ROLL": Recorded(column: "roll", unit: "deg"),
        "WF(1)": Recorded(column: "ff1", unit: "kg/h"),
        "WF(2)": Recorded(column: "ff2", unit: "kg/h"),
    },
    mass: GrossMass(column: "gw lb", unit: "lb", largest_rise_kg: 5),
)
"#;

/// Files of a test.
struct Files {
    folder: tempfile::TempDir,
    model: PathBuf,
    segments: PathBuf,
    points: PathBuf,
    mapping: PathBuf,
}

fn points() -> Files {
    let folder = tempfile::tempdir().unwrap();
    let (points, mapping) = (folder.path().join("points.csv"), folder.path().join("POINTS.ron"));
    let segments = segments(folder.path());
    std::fs::write(&points, as_points(&std::fs::read_to_string(&segments).unwrap())).unwrap();
    let model = initial_model(folder.path());
    let aircraft = std::fs::read_to_string(fixture("AIRCRAFT.ron")).unwrap();
    let code = aircraft.split("type_code: \"").nth(1).unwrap().split('"').next().unwrap();
    std::fs::write(&mapping, MAPPING.replace("GL5T", code)).unwrap();
    Files { folder, model, segments, points, mapping }
}

/// The line of the fixture's tail in what a command prints.
/// The tail's cells of both tables: counts, then errors.
fn line_of_tail(text: &str) -> Vec<String> {
    let lines = text.lines().filter(|line| line.starts_with("SIM-01"));
    let words: Vec<String> = lines.flat_map(str::split_whitespace).map(str::to_owned).collect();
    assert!(words.len() > 6, "{text}");
    words
}

/// Oracle: the reports that the segments were formed of.
#[test]
fn a_table_of_segments_is_worth_the_reports_it_was_made_of() {
    let Files { model, segments, folder, .. } = points();
    let evaluate = |what: &Path| {
        let arguments =
            ["evaluate".as_ref(), "--model".as_ref(), model.as_os_str(), what.as_os_str()];
        line_of_tail(&cruisefit(&arguments).expect(0).stdout)
    };
    let (reports, table) = (evaluate(&fixture("reports")), evaluate(&segments));
    // All but the number of samples, of which a table has those in segments.
    assert_eq!(reports[..2], table[..2]);
    assert_eq!(reports[3..], table[3..]);
    let adapt = |what: &Path, name: &str| {
        let output = folder.path().join(name);
        cruisefit(&[
            "adapt".as_ref(),
            "--model".as_ref(),
            model.as_os_str(),
            what.as_os_str(),
            "-o".as_ref(),
            output.as_os_str(),
        ])
        .expect(0);
        let segments = std::fs::read_to_string(output.join("segments/SIM-01.csv")).unwrap();
        column(&segments, "predicted_fuel_flow_kg_s")
    };
    assert_eq!(adapt(&fixture("reports"), "A"), adapt(&segments, "B"));
    // And as Parquet.
    let parquet = folder.path().join("segments.parquet");
    let reports = fixture("reports");
    let write = ["segment".as_ref(), reports.as_os_str(), "-o".as_ref(), parquet.as_os_str()];
    cruisefit(&write).expect(0);
    assert_eq!(evaluate(&parquet), table);
    // Predicted alike, too.
    let predict = |segments: &Path| {
        let output = folder.path().join("predicted.csv");
        let (of, to) = (segments.as_os_str(), output.as_os_str());
        let arguments = ["predict".as_ref(), "--model".as_ref(), model.as_os_str(), of];
        let all: Vec<_> = arguments.into_iter().chain(["-o".as_ref(), to]).collect();
        let ran = cruisefit(&all);
        assert!(ran.stdout.contains("points predicted"), "{}", ran.stderr);
        std::fs::read_to_string(output).unwrap()
    };
    assert_eq!(predict(&parquet), predict(&segments));
}

/// Oracle: the segments that the points were written from, in other units.
#[test]
fn averaged_points_are_segments_and_say_what_is_not_judged() {
    let Files { model, segments, points, mapping, folder: _folder } = points();
    let read = [
        "segment".as_ref(),
        "--mapping".as_ref(),
        mapping.as_os_str(),
        points.as_os_str(),
        "--explain".as_ref(),
    ];
    let ran = cruisefit(&read).expect(0);
    ran.says("each row is the mean of 60 s, as stated; trim criteria not judged, for want of samples: VS, MACH, GSPD, SAT, N2, DRIFT");
    let expected = std::fs::read_to_string(&segments).unwrap();
    for name in ["mass_kg", "mach", "fuel_flow_kg_s", "pressure_altitude_m"] {
        let (found, expected) = (column(&ran.stdout, name), column(&expected, name));
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            let (found, expected): (f64, f64) = (found.parse().unwrap(), expected.parse().unwrap());
            assert!((found / expected - 1.0).abs() < 1e-9, "{name}: {found} for {expected}");
        }
    }
    let evaluate = [
        "evaluate".as_ref(),
        "--model".as_ref(),
        model.as_os_str(),
        "--mapping".as_ref(),
        mapping.as_os_str(),
        points.as_os_str(),
    ];
    let of_points = line_of_tail(&cruisefit(&evaluate).expect(0).stdout);
    let of_segments = line_of_tail(
        &cruisefit(&[
            "evaluate".as_ref(),
            "--model".as_ref(),
            model.as_os_str(),
            segments.as_os_str(),
        ])
        .expect(0)
        .stdout,
    );
    // The acceleration of a point is not known, so that its observed drag differs a little.
    let mean = |line: &[String]| line[6].parse::<f64>().unwrap();
    assert_eq!(of_points[3], of_segments[3]);
    assert!((mean(&of_points) - mean(&of_segments)).abs() < 0.5, "{of_points:?} {of_segments:?}");
}

#[test]
fn points_that_were_not_steady_are_left_out_and_no_command_but_convert_refuses_the_rest() {
    let Files { model, points, mapping, folder, .. } = points();
    // A frame in which the altitude moved by more than any criterion admits.
    let text = std::fs::read_to_string(&points).unwrap();
    let all = text.lines().count() - 1;
    std::fs::write(&points, text.replacen(",3\n", ",300\n", 1)).unwrap();
    let read = ["segment".as_ref(), "--mapping".as_ref(), mapping.as_os_str(), points.as_os_str()];
    let kept = cruisefit(&read).expect(0).stdout.lines().count() - 1;
    assert_eq!(kept, all - 1);
    for command in ["adapt", "diagnose", "check", "predict"] {
        let output = folder.path().join(command);
        let mut arguments: Vec<&std::ffi::OsStr> = vec![
            command.as_ref(),
            "--mapping".as_ref(),
            mapping.as_os_str(),
            points.as_os_str(),
            "--model".as_ref(),
            model.as_os_str(),
        ];
        let file = output.with_extension("csv");
        match command {
            "adapt" | "diagnose" => arguments.extend(["-o".as_ref(), output.as_os_str()]),
            "predict" => arguments.extend(["-o".as_ref(), file.as_os_str()]),
            _ => {}
        }
        let ran = cruisefit(&arguments).expect(0);
        if command == "predict" {
            let predicted = std::fs::read_to_string(&file).unwrap();
            assert_eq!(column(&predicted, "error_percent").len(), kept);
            assert!(ran.stdout.contains("points predicted"), "{}", ran.stdout);
        }
    }
    cruisefit(&[
        "convert".as_ref(),
        "--mapping".as_ref(),
        mapping.as_os_str(),
        points.as_os_str(),
        "--dry-run".as_ref(),
    ])
    .expect(2)
    .says("the mapping's rows are averaged points");
}

/// A value that is missing or a temperature that cannot be costs its row; of many refused rows twenty are printed.
#[test]
fn a_bad_row_of_points_costs_itself() {
    let folder = tempfile::tempdir().unwrap();
    let model = initial_model(folder.path());
    let points = folder.path().join("points.csv");
    let predict = |text: &str| {
        std::fs::write(&points, text).unwrap();
        cruisefit(&["predict".as_ref(), "--model".as_ref(), model.as_os_str(), points.as_os_str()])
    };
    let names = "mass_kg,pressure_altitude_ft,mach,isa_deviation_c,anti_ice\n";
    let good = "30000,41000,0.8,0,0.0\n";
    let text = format!(
        "{names}{good}30000,41000,NaN,0,0\n30000,41000,0.8,55,1.0\n30000,41000,0.8,NaN,False\n{good}"
    );
    let ran = predict(&text).expect(1);
    ran.says("points.csv:3: mach: no value")
        .says("points.csv:4: isa_deviation_c: found \"55\", expected -50 to 50 °C")
        .says("points.csv:5: isa_deviation_c: no value");
    let flows: Vec<bool> =
        column(&ran.stdout, "fuel_flow_kg_s").iter().map(|flow| !flow.is_empty()).collect();
    assert_eq!(flows, [true, false, false, false, true]);

    let outside = "30000,41000,0.2,0,0\n".repeat(100);
    let ran = predict(&format!("{names}{outside}{good}")).expect(1);
    assert_eq!(ran.stderr.lines().filter(|line| line.contains("points.csv:")).count(), 21);
    ran.says("points.csv: 80 more");
    // A column in another unit is that of a file.
    predict(&format!("{names}30000,41000,80,0,0\n{good}")).expect(2).says("(mach): found \"80\"");
}
