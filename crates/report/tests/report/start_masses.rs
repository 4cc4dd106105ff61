//! What a start mass does not know: a recording that begins in flight, gaps, another flight's mass.

#![expect(clippy::panic, reason = "a test fails by panicking, in its helpers too")]

use report::{Mapping, Parsed};

use super::mapping_slips::message;

const NAMES: &str = "time,alt,sat,mach,tas,gs,ff,tow\n";

fn mapping(start_mass: &str) -> Mapping {
    let text = format!(
        r#"(
        format: 1, bad_rows: LeaveRowOut,
        aircraft: Text("A320"), tail: Text("T-1"), flight: Text("1"),
        time: Seconds(column: "time", start: "2024-03-01T10:00:00Z"),
        quantities: {{
            "ALT": Recorded(column: "alt", unit: "ft"),
            "SAT": Recorded(column: "sat", unit: "degC"),
            "MACH": Recorded(column: "mach", unit: "-"),
            "VTAS": Recorded(column: "tas", unit: "kt"),
            "GSPD": Recorded(column: "gs", unit: "kt"),
            "WF": Recorded(column: "ff", unit: "kg/h"),
        }},
        mass: StartMass(gross_weight: {start_mass}),
        cruise: (minimum_pressure_altitude_ft: 30000, band_ft: 100, minimum_duration_s: 600, trim_s: 0),
    )"#
    );
    Mapping::from_ron(&text).unwrap_or_else(|error| panic!("{error}"))
}

const COLUMN: &str = "Column(\"tow\", \"kg\")";

/// A minute at some second: on the ground, in climb or in cruise.
fn row(minute: usize, second: usize, mass: &str) -> String {
    let (alt, gs) = match minute {
        0..5 => (500, 10),
        5..15 => (500 + 3450 * (minute - 5), 300),
        _ => (35_000, 450),
    };
    format!("{second},{alt},-54,0.78,450,{gs},2400,{mass}\n")
}

/// An hour, with what comes before a minute left away and those from another one on later.
fn flight(from: usize, (gap_at, gap_s): (usize, usize), mass: impl Fn(usize) -> String) -> String {
    let rows = (from..60).map(|minute| {
        let later_s = if minute >= gap_at { gap_s } else { 0 };
        row(minute, 60 * minute + later_s, &mass(minute))
    });
    NAMES.to_owned() + &rows.collect::<String>()
}

fn read(start_mass: &str, text: &str) -> Parsed {
    match mapping(start_mass).read(text.as_bytes()) {
        Ok(mut parsed) => parsed.remove(0),
        Err(refusal) => panic!("{refusal}"),
    }
}

#[test]
fn a_recording_that_begins_in_flight_is_told() {
    let stays = |_| "70000".to_owned();
    let falls = |minute| format!("{}", 70_000 - 40 * minute);
    let code = "mapped-start-in-flight";
    let no_gap = (99, 0);
    for start_mass in [COLUMN, "Value(70000, \"kg\")"] {
        let said = read(start_mass, &flight(20, no_gap, stays));
        assert!(message(&said, code).contains("the first row, at 35000 ft"), "{start_mass}");
        assert_eq!(message(&read(start_mass, &flight(0, no_gap, stays)), code), "");
    }
    // What falls is the mass of each row.
    assert_eq!(message(&read(COLUMN, &flight(20, no_gap, falls)), code), "");
}

/// By hand: 2400 kg/h for 41 minutes are 1640 kg, for 6 minutes 240 kg: less than 0.5 % of 70 000 kg.
#[test]
fn fuel_over_a_gap_is_told() {
    let said = |gap_s| {
        let text = flight(0, (40, gap_s), |_| "70000".to_owned());
        message(&read(COLUMN, &text), "mapped-flow-over-gap").to_owned()
    };
    assert!(said(2400).starts_with("1640 kg are taken as burnt in gaps of the rows (1)"));
    assert_eq!(said(300), "");
}

#[test]
fn another_start_mass_is_another_flight() {
    let refused = |mass: fn(usize) -> String| {
        let read = mapping(COLUMN).read(flight(0, (99, 0), mass).as_bytes());
        read.err().map(|refusal| (refusal.line, refusal.kind.code()))
    };
    let another = |minute| if minute < 30 { "70000" } else { "66000" }.to_owned();
    assert_eq!(refused(another), Some((32, "start-mass-changes")));
    // A wrong number, a blank, what is corrected by little; gross mass in steps of a tonne.
    assert_eq!(refused(|minute| if minute == 30 { "7000" } else { "70000" }.to_owned()), None);
    assert_eq!(refused(|minute| if minute == 30 { "" } else { "70000" }.to_owned()), None);
    assert_eq!(refused(|minute| if minute < 4 { "70000" } else { "70500" }.to_owned()), None);
    assert_eq!(refused(|minute| format!("{}", 70_000 - 1000 * (minute / 25))), None);
}
