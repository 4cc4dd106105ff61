//! Flights whose rows alternate: the same reports as of the sorted recording, or a refusal with both lines.

use std::collections::BTreeMap;

use crate::mapping::table::Limits;
use crate::mapping::{MappedReport, Mapping, Pieces, Stream};
use crate::{FlightLimit, Parsed, Refusal, RefusalKind};

const MAPPING: &str = r#"(
    format: 1,
    aircraft: Text("A320"),
    tail: Column("reg"),
    flight: Column("flt"),
    time: Timestamp(column: "utc", utc_offset: "Z"),
    quantities: {
        "ALT": Recorded(column: "alt", unit: "ft"),
        "SAT": Recorded(column: "sat", unit: "degC"),
        "MACH": Recorded(column: "mach", unit: "-"),
        "VTAS": FromMach,
        "GSPD": Recorded(column: "gs", unit: "kt"),
        "WF": Recorded(column: "ff", unit: "kg/h"),
    },
    mass: GrossMass(column: "gw", unit: "kg", largest_rise_kg: 10),
)"#;
const NAMES: &str = "utc,reg,flt,alt,sat,mach,gs,ff,gw\n";
/// 8 o'clock on 1 March 2024.
const BEGINNING_S: i64 = 1_709_280_000;

/// A row of a flight of a tail, so many seconds after the beginning.
fn row(tail: usize, flight: usize, second: usize) -> String {
    let instant =
        flight::Timestamp::from_second(BEGINNING_S + i64::try_from(second).unwrap()).unwrap();
    let (altitude, mass) = (35_000 + (second + tail) % 3, 65_000.0 - 0.3 * second as f64 / 10.0);
    format!("{instant},T-{tail},F{flight},{altitude},-54.5,0.78,450,2400,{mass:.2}\n")
}

fn text<'t>(rows: impl IntoIterator<Item = &'t (usize, usize, usize)>) -> String {
    let rows = rows.into_iter().map(|(tail, flight, second)| row(*tail, *flight, *second));
    NAMES.to_owned() + &rows.collect::<String>()
}

/// The reports in the order in which they are given out.
fn read(mapping: &str, text: &str, limits: Limits) -> Result<Vec<Parsed>, Refusal> {
    let mut pieces = Pieces::new(text.as_bytes())?;
    let mut stream = Stream::begin(&Mapping::from_ron(mapping).unwrap(), &mut pieces, None)?;
    stream.assembly.limit(limits);
    let (mut flights, mut refusal) = (Vec::new(), None);
    while let Some(piece) = stream.next_piece(&mut pieces)? {
        let (ended, added) = stream.add(stream.converter().rows(piece));
        flights.extend(ended);
        refusal = refusal.or(added.err());
    }
    flights.extend(stream.finish());
    let reports = flights.into_iter().map(|flight| match stream.converter().report(flight) {
        MappedReport::Report(parsed) => *parsed,
        other => panic!("{other:?}"),
    });
    refusal.map_or_else(|| Ok(reports.collect()), Err)
}

fn read_plainly(text: &str) -> Result<Vec<Parsed>, Refusal> {
    read(MAPPING, text, Limits::default())
}

type ByFlight = BTreeMap<(String, String, flight::Timestamp), flight::Report>;

fn by_flight(reports: &[Parsed]) -> ByFlight {
    let named = reports.iter().map(|parsed| {
        let identity = &parsed.report.header().identity;
        ((identity.tail.clone(), identity.flight.clone(), identity.start), parsed.report.clone())
    });
    named.collect()
}

/// Three tails with two flights each, five hours apart, of 900 rows.
fn fleet() -> Vec<(usize, usize, usize)> {
    let flights = (0..3).flat_map(|tail| [(tail, 1, 0), (tail, 2, 18_900)]);
    flights
        .flat_map(|(tail, flight, from)| {
            (0..900).map(move |s| (tail, flight, from + 10 * s + tail))
        })
        .collect()
}

fn by_time(rows: &[(usize, usize, usize)]) -> Vec<(usize, usize, usize)> {
    let mut rows = rows.to_vec();
    rows.sort_by_key(|(tail, _, second)| (*second, *tail));
    rows
}

#[test]
fn alternating_rows_are_the_flights_of_the_sorted_recording() {
    let sorted = read_plainly(&text(&fleet())).unwrap();
    assert_eq!(sorted.len(), 6);
    let names: Vec<_> = sorted.iter().map(|parsed| &parsed.report.header().identity).collect();
    assert!(
        names
            .windows(2)
            .all(|pair| (&pair[0].tail, pair[0].start) < (&pair[1].tail, pair[1].start))
    );
    let alternating = read_plainly(&text(&by_time(&fleet()))).unwrap();
    assert_eq!(alternating.len(), 6);
    assert_eq!(by_flight(&alternating), by_flight(&sorted));
    // In blocks of 100 rows, larger than what is kept of flights that seem to be over: never in halves.
    let mut blocks = fleet();
    blocks.sort_by_key(|(tail, _, second)| (second / 1000, *tail, *second));
    let limits = Limits { kept_bytes: 4000, ..Limits::default() };
    let refusal = read(MAPPING, &text(&blocks), limits).unwrap_err();
    assert!(matches!(
        refusal.kind,
        RefusalKind::FlightCameBack { last_line: 101, limit: FlightLimit::KeptBytes(4000) }
    ));
}

/// The same name flies again after the gap: by the mapping's, or three hours.
#[test]
fn after_the_gap_it_is_another_flight() {
    let rows = |pause: usize| {
        let flights = [(0, 0), (1, 0), (0, pause), (1, pause)];
        flights.into_iter().flat_map(|(tail, from)| (0..20).map(move |s| (tail, 1, from + s)))
    };
    let count = |mapping: &str, pause| {
        let rows: Vec<_> = rows(pause).collect();
        let [blocks, alternating] = [rows.clone(), by_time(&rows)]
            .map(|rows| read(mapping, &text(&rows), Limits::default()).unwrap().len());
        assert_eq!(blocks, alternating);
        blocks
    };
    let shorter = MAPPING.replace("format: 1,", "format: 1, new_flight_after_s: 1800,");
    assert_eq!(count(MAPPING, 10_000), 2);
    assert_eq!(count(MAPPING, 12_000), 4);
    assert_eq!(count(&shorter, 1500), 2);
    assert_eq!(count(&shorter, 2000), 4);
}

/// Out, back and out again under one name: three flights, for the tail flew another in between; sorted, or among others.
#[test]
fn a_tail_flies_one_flight_at_a_time() {
    let legs = [(0, 1, 0), (0, 2, 3000), (0, 1, 6000), (1, 1, 0)];
    let rows: Vec<_> = legs
        .into_iter()
        .flat_map(|(tail, flight, from)| (0..200).map(move |s| (tail, flight, from + 10 * s)))
        .collect();
    for limits in [Limits::default(), Limits { kept_bytes: 1000, ..Limits::default() }] {
        let sorted = read(MAPPING, &text(&rows), limits).unwrap();
        assert_eq!(sorted.len(), 4);
        let alternating = read(MAPPING, &text(&by_time(&rows)), Limits::default()).unwrap();
        assert_eq!(by_flight(&alternating), by_flight(&sorted));
    }
    // Without a column of tails nobody knows that one aircraft flies them.
    let untold = MAPPING.replace("Column(\"reg\")", "Text(\"T\")");
    assert_eq!(read(&untold, &text(&rows[..600]), Limits::default()).unwrap().len(), 2);
}

/// While two fly for hours, the flight that ended is given out; what comes back late is not read as another flight.
#[test]
fn a_row_that_comes_back_late_is_refused_with_both_lines() {
    let mut rows: Vec<_> =
        (0..30).flat_map(|s| (0..3).map(move |tail| (tail, 1, 10 * s))).collect();
    rows.extend((30..3000).flat_map(|s| [(0, 1, 10 * s), (1, 1, 10 * s)]));
    rows.extend([(2, 1, 310), (2, 1, 320)]);
    let refusal = read_plainly(&text(&rows)).unwrap_err();
    assert_eq!((refusal.line, refusal.kind.code()), (rows.len(), "flight-came-back"));
    assert_eq!(
        refusal.to_string(),
        format!(
            "line {}, column 26: found \"T-2 F1\", expected no more rows of this flight, which ended in line 91 (the flights around are more than 10800 s past its last row): sort the table by tail, flight and time",
            rows.len()
        )
    );
}

#[test]
fn one_wrong_time_ends_no_other_flight_and_makes_no_halves() {
    let mut rows = by_time(&fleet());
    rows.retain(|(_, flight, _)| *flight == 1);
    let mut text = text(&rows);
    // A row of tail 1 a year late is of another flight; the next one is of the flight before it again.
    let line = row(1, 1, rows[301].2);
    let wrong = line.replace("2024-", "2025-");
    assert_eq!(rows[301].0, 1);
    text = text.replace(&line, &wrong);
    let lenient = MAPPING.replace("format: 1,", "format: 1, bad_rows: LeaveRowOut,");
    let without: Vec<_> =
        rows.iter().enumerate().filter(|(at, _)| *at != 301).map(|(_, r)| *r).collect();
    let expected = by_flight(&read(&lenient, &self::text(&without), Limits::default()).unwrap());
    let mut pieces = Pieces::new(text.as_bytes()).unwrap();
    let mapping = Mapping::from_ron(&lenient).unwrap();
    let mut stream = Stream::begin(&mapping, &mut pieces, None).unwrap();
    let mut flights = Vec::new();
    while let Some(piece) = stream.next_piece(&mut pieces).unwrap() {
        let (ended, added) = stream.add(stream.converter().rows(piece));
        added.unwrap();
        flights.extend(ended);
    }
    flights.extend(stream.finish());
    let (mut reports, mut others) = (Vec::new(), 0);
    for flight in flights {
        match stream.converter().report(flight) {
            MappedReport::Report(parsed) => reports.push(*parsed),
            MappedReport::WithoutCruise { rows: 1, .. } => others += 1,
            other => panic!("{other:?}"),
        }
    }
    assert_eq!((by_flight(&reports), others), (expected, 1));
}

/// Two hours ahead, or a year: the row is left out and named, and the rows behind it are not; sorted, alternating, and where the mapping
/// begins another flight after a gap.
#[test]
fn a_row_far_ahead_costs_itself() {
    let lenient = MAPPING.replace("format: 1,", "format: 1, bad_rows: LeaveRowOut,");
    let split = lenient.replace("format: 1,", "format: 1, new_flight_after_s: 1800,");
    let mut rows = fleet();
    rows.retain(|(_, flight, _)| *flight == 1);
    for (mapping, rows, later_s) in [
        (&lenient, rows.clone(), 7_200),
        (&lenient, rows.clone(), 31_536_000),
        (&split, rows.clone(), 7_200),
        (&lenient, by_time(&rows), 7_200),
    ] {
        let at = 1201;
        let (tail, flight, second) = rows[at];
        let mut lines: Vec<String> = text(&rows).lines().map(str::to_owned).collect();
        lines[1 + at] = row(tail, flight, second + later_s).trim_end().to_owned();
        let found = read(mapping, &(lines.join("\n") + "\n"), Limits::default()).unwrap();
        let mut without = rows.clone();
        without.remove(at);
        let expected = read(mapping, &text(&without), Limits::default()).unwrap();
        assert_eq!(by_flight(&found), by_flight(&expected));
        let findings = found.iter().flat_map(|parsed| &parsed.findings);
        let line = findings.filter(|one| one.code == "mapped-rows-bad").map(|one| one.line);
        assert_eq!(line.collect::<Vec<_>>(), [Some(at + 2)]);
    }
}

/// Rows ahead are left out, however many, where more rows go on behind them; rows that go back are where they are fewer.
#[test]
fn of_rows_ahead_and_rows_behind_the_fewer_are_left_out() {
    let lenient = MAPPING.replace("format: 1,", "format: 1, bad_rows: LeaveRowOut,");
    let split = lenient.replace("format: 1,", "format: 1, new_flight_after_s: 1800,");
    let mut rows = fleet();
    rows.retain(|(tail, flight, _)| (*tail, *flight) == (0, 1));
    let all = rows.len();
    // Only the time of a row is another one.
    let moved = |range: core::ops::Range<usize>, later_s: usize| -> Vec<String> {
        let line = |(at, (tail, flight, second)): (usize, &(usize, usize, usize))| {
            let later_s = if range.contains(&at) { later_s } else { 0 };
            let time = row(*tail, *flight, second + later_s)[..20].to_owned();
            time + &row(*tail, *flight, *second)[20..]
        };
        rows.iter().enumerate().map(line).collect()
    };
    for (mapping, changed, left_out) in [
        (&lenient, moved(201..203, 31_536_000), 201..203),
        (&lenient, moved(201..221, 3_600), 201..221),
        (&split, moved(201..221, 3_600), 201..221),
        (&split, moved(201..221, 31_536_000), 201..221),
        (&lenient, moved(201..all - 20, 31_536_000), all - 20..all),
        (&lenient, moved(all - 20..all, 3_600), 0..0),
    ] {
        let mut without = changed.clone();
        without.drain(left_out.clone());
        let [found, expected] = [changed, without].map(|lines| {
            read(mapping, &(NAMES.to_owned() + &lines.concat()), Limits::default()).unwrap()
        });
        assert_eq!(by_flight(&found), by_flight(&expected), "{left_out:?}");
        assert_eq!(found[0].left_out, left_out.len());
        let finding = found[0].findings.iter().find(|one| one.code == "mapped-rows-bad");
        let line = (!left_out.is_empty()).then_some(left_out.start + 2);
        assert_eq!(finding.and_then(|one| one.line), line);
    }
}

#[test]
fn beyond_a_limit_a_flight_that_comes_back_is_refused() {
    let rows: Vec<_> = (0..40).flat_map(|s| (0..6).map(move |tail| (tail, 1, s))).collect();
    let read = |limits| read(MAPPING, &text(&rows), limits);
    assert_eq!(read(Limits { flights: 5, ..Limits::default() }).unwrap().len(), 6);
    let refusal = read(Limits { flights: 4, ..Limits::default() }).unwrap_err();
    let limit = FlightLimit::OpenFlights(4);
    assert_eq!(refusal.kind, RefusalKind::FlightCameBack { last_line: 3, limit });
    assert_eq!(refusal.line, 9);
    let refusal = read(Limits { bytes: 8000, ..Limits::default() }).unwrap_err();
    let limit = FlightLimit::OpenBytes(8000);
    assert!(
        matches!(refusal.kind, RefusalKind::FlightCameBack { limit: found, .. } if found == limit)
    );
}
