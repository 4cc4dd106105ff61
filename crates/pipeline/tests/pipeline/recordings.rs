//! What is read of a recording does not depend on who does the work, and in which order.
#![expect(clippy::unwrap_used, reason = "a test")]

use std::fmt::Write;
use std::path::Path;

use pipeline::reading::recordings::{self, Mapped, Spread, Workers};
use pipeline::reading::{Checks, FileRead};
use report::mapping::{Mapping, Source};
use segmenter::TrimCriteria;

const MAPPING: &str = r#"(
    format: 1,
    aircraft: Text("A320"),
    tail: Column("tail"),
    flight: Column("flight"),
    time: Seconds(column: "s", start: "2024-01-01T00:00:00Z"),
    quantities: {
        "ALT": Recorded(column: "alt", unit: "ft"),
        "MACH": Recorded(column: "mach", unit: "-"),
        "VTAS": Recorded(column: "tas", unit: "kt"),
        "GSPD": Recorded(column: "gs", unit: "kt"),
        "SAT": Recorded(column: "sat", unit: "degC"),
        "WF": Recorded(column: "ff", unit: "kg/h"),
    },
    mass: GrossMass(column: "gw", unit: "kg", largest_rise_kg: 50),
    cruise: (minimum_pressure_altitude_ft: 25000, band_ft: 200, minimum_duration_s: 900, trim_s: 60),
)"#;

const FLIGHTS: usize = 24;
const ROWS: usize = 2000;

/// A few megabytes: several times as many pieces as wait at a time. Every fifth flight never reaches its level.
fn recording() -> String {
    let mut text = "s,tail,flight,alt,mach,tas,gs,sat,ff,gw\n".to_owned();
    for flight in 0..FLIGHTS {
        let altitude = if flight % 5 == 4 { 20_000 } else { 35_000 + 10 * flight };
        for row in 0..ROWS {
            let second = flight * 10_000 + row;
            let mass = 65_000.0 - row as f64 / 1.5;
            let flow = 2400 + flight + row % 3;
            let _ = writeln!(
                text,
                "{second},F-T{:03},XX{flight:04},{altitude},0.7800,450.1,460.2,-54.3,{flow},{mass:.1}",
                flight % 3
            );
        }
    }
    text
}

fn read(text: &str, spread: &Spread<'_>) -> FileRead {
    let mapping = Mapping::from_ron(MAPPING).unwrap();
    let criteria = TrimCriteria::ghazi_2020_table_4();
    let path = Path::new("R.csv");
    let mapped = Mapped { path, mapping: &mapping, criteria: &criteria, checks: Checks::Made };
    recordings::read(&mapped, &mut Source::text(text.as_bytes()).unwrap(), spread)
}

/// Each task at once.
fn eagerly(work: &(dyn Fn() + Sync), run: &mut dyn FnMut(&Workers<'_>)) {
    run(&Workers { count: 3, call: &|| work() });
}

/// A thread for each task: which is done first is by chance.
fn by_chance(work: &(dyn Fn() + Sync), run: &mut dyn FnMut(&Workers<'_>)) {
    std::thread::scope(|scope| {
        run(&Workers { count: 4, call: &|| drop(scope.spawn(work)) });
    });
}

fn same_by_all(text: &str) -> FileRead {
    let first = read(text, &recordings::one_by_one);
    let others: [&Spread<'_>; 3] = [&eagerly, &by_chance, &by_chance];
    for spread in others {
        assert_eq!(format!("{:?}", read(text, spread)), format!("{first:?}"));
    }
    first
}

#[test]
fn flights_do_not_depend_on_who_reads_them() {
    let (flights, refused) = same_by_all(&recording());
    let names: Vec<&str> =
        flights.iter().map(|flight| flight.reduced.identity.flight.as_str()).collect();
    let level = (0..FLIGHTS).filter(|flight| flight % 5 != 4);
    assert_eq!(names, level.map(|flight| format!("XX{flight:04}")).collect::<Vec<_>>());
    assert_eq!(refused.len(), FLIGHTS / 5);
    assert!(flights.iter().all(|flight| !flight.reduced.segments.is_empty()));
}

/// Of two faults the one of the earlier flight is named, whoever meets which first.
#[test]
fn the_first_fault_is_named() {
    let good = recording();
    let line = |flight: usize, row: usize| 1 + flight * ROWS + row;
    let with = |faults: &[(usize, &str, &str)]| {
        let mut lines: Vec<String> = good.lines().map(str::to_owned).collect();
        for (line, from, to) in faults {
            assert!(lines[*line].contains(from), "{}", lines[*line]);
            lines[*line] = lines[*line].replacen(from, to, 1);
        }
        lines.join("\n") + "\n"
    };
    let word = (line(12, 700), "450.1", "fast");
    let (flights, refused) = same_by_all(&with(&[word, (line(20, 3), "450.1", "slow")]));
    assert!(flights.is_empty());
    assert_eq!(refused.iter().map(|one| one.line).collect::<Vec<_>>(), [Some(word.0 + 1)]);
    assert!(refused[0].reason.contains("fast"), "{}", refused[0].reason);
    // A flight that ended before that row and is only then made into a report: its mass rises.
    let risen = (line(10, 1000), ",64333.3", ",66333.3");
    let (flights, refused) = same_by_all(&with(&[word, risen]));
    assert!(flights.is_empty());
    assert_eq!(refused.iter().map(|one| one.line).collect::<Vec<_>>(), [Some(risen.0 + 1)]);
}
