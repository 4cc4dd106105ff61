//! Tables whose cells are numbers and instants: the same flights as the text that says the same.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helpers too")]

use core::fmt::Write;

use report::mapping::{Batch, BatchColumn, NO_INSTANT, Source};
use report::{Mapping, Parsed};

const MAPPING: &str = r#"(
    format: 1,
    aircraft: Text("A320"),
    tail: Column("tail"),
    flight: Column("flight"),
    time: Timestamp(column: "utc", utc_offset: "Z"),
    bad_rows: LeaveRowOut,
    quantities: {
        "ALT": Recorded(column: "alt", unit: "ft"),
        "MACH": Recorded(column: "mach", unit: "-"),
        "VTAS": Recorded(column: "tas", unit: "kt"),
        "GSPD": Recorded(column: "tas", unit: "kt"),
        "SAT": Recorded(column: "sat", unit: "degC", hold_s: 120),
        "WF": Recorded(column: "ff", unit: "kg/h"),
        "A/I": Recorded(column: "ai", unit: "-", values: [("ON", 1), ("OFF", 0)], optional: true),
    },
    mass: GrossMass(column: "gw", unit: "kg", largest_rise_kg: 50),
)"#;

const ROWS: usize = 40;
const START_S: i64 = 1_700_000_000;

/// Instants, flights and numbers of a recording in which some are missing.
struct Table {
    instants: Vec<i64>,
    flights: Vec<&'static str>,
    numbers: Vec<(&'static str, Vec<f64>)>,
    flags: Vec<&'static str>,
}

fn table() -> Table {
    let rows = 0..ROWS;
    let column =
        |of: &dyn Fn(f64) -> f64| rows.clone().map(|row| of(row as f64)).collect::<Vec<_>>();
    let mut sat = column(&|row| -56.5 + 0.1 * row);
    sat[3] = f64::NAN;
    let mut gw = column(&|row| 64_000.0 - 2.5 * row);
    gw[30] = f64::NAN;
    let mut instants: Vec<i64> =
        (START_S..).step_by(60).take(ROWS).map(|second| second * 1_000_000_000).collect();
    instants[25] = NO_INSTANT;
    Table {
        instants,
        flights: rows.clone().map(|row| if row < 17 { "F1" } else { "F2" }).collect(),
        numbers: vec![
            ("alt", column(&|row| 35_000.0 + row)),
            ("mach", column(&|row| 0.78 + 1e-4 * row)),
            ("tas", column(&|row| 448.0 + 0.1 * row)),
            ("sat", sat),
            ("ff", column(&|row| 2400.0 - row)),
            ("gw", gw),
        ],
        flags: rows.map(|row| if row % 2 == 0 { "ON" } else { "OFF" }).collect(),
    }
}

impl Table {
    fn names(&self) -> Vec<String> {
        let numbers = self.numbers.iter().map(|(name, _)| *name);
        ["utc", "tail", "flight"]
            .into_iter()
            .chain(numbers)
            .chain(["ai"])
            .map(str::to_owned)
            .collect()
    }

    fn text(&self) -> String {
        let mut text = self.names().join(",") + "\n";
        for row in 0..ROWS {
            let count = Some(self.instants[row]).filter(|count| *count != NO_INSTANT);
            let instant = count.map_or_else(String::new, |count| {
                flight::Timestamp::from_nanosecond(i128::from(count)).unwrap().to_string()
            });
            let numbers: Vec<String> = self
                .numbers
                .iter()
                .map(|(_, values)| values[row])
                .map(|value| if value.is_nan() { String::new() } else { value.to_string() })
                .collect();
            let (flight, flag) = (self.flights[row], self.flags[row]);
            writeln!(text, "{instant},T-1,{flight},{},{flag}", numbers.join(",")).unwrap();
        }
        text
    }

    /// The rows by batches of `at_once`, with flags as numbers or as text.
    fn batches(&self, at_once: usize, flags: &dyn Fn(&[&str]) -> BatchColumn) -> Vec<Batch> {
        let runs = |texts: &[&str]| texts.iter().map(|text| ((*text).to_owned(), 1)).collect();
        (0..ROWS)
            .step_by(at_once)
            .map(|from| {
                let rows = from..(from + at_once).min(ROWS);
                let mut columns = vec![
                    BatchColumn::Instants(self.instants[rows.clone()].to_vec()),
                    BatchColumn::Texts(vec![("T-1".to_owned(), rows.len())]),
                    BatchColumn::Texts(runs(&self.flights[rows.clone()])),
                ];
                columns.extend(
                    self.numbers
                        .iter()
                        .map(|(_, values)| BatchColumn::Numbers(values[rows.clone()].to_vec())),
                );
                columns.push(flags(&self.flags[rows.clone()]));
                let columns = columns.into_iter().enumerate().collect();
                Batch { first_row: 0, rows: rows.len(), columns }
            })
            .collect()
    }
}

fn read(mapping: &Mapping, names: Vec<String>, batches: Vec<Batch>) -> Vec<Parsed> {
    let mut batches = batches.into_iter();
    let mut source =
        Source::table(names, Vec::new(), Box::new(move |_: &[usize]| Ok(batches.next())));
    let mut parsed = Vec::new();
    mapping.each(&mut source, None, |report| parsed.push(report)).unwrap();
    parsed
}

#[test]
fn a_table_gives_what_its_text_gives() {
    let table = table();
    let as_text = |flags: &[&str]| {
        BatchColumn::Texts(flags.iter().map(|flag| ((*flag).to_owned(), 1)).collect())
    };
    let as_numbers = |flags: &[&str]| {
        BatchColumn::Numbers(flags.iter().map(|flag| f64::from(u8::from(*flag == "ON"))).collect())
    };
    let with_texts = Mapping::from_ron(MAPPING).unwrap();
    let expected = with_texts.read(table.text().as_bytes()).unwrap();
    assert_eq!(expected.len(), 2);
    // The mapping without texts for the flags takes columns as they are.
    let without = MAPPING.replace(", values: [(\"ON\", 1), (\"OFF\", 0)]", "");
    let without = Mapping::from_ron(&without).unwrap();
    for at_once in [1, 7, ROWS] {
        let found = read(&with_texts, table.names(), table.batches(at_once, &as_text));
        assert_eq!(found, expected, "{at_once} rows at once, through text");
        let found = read(&without, table.names(), table.batches(at_once, &as_numbers));
        assert_eq!(found, expected, "{at_once} rows at once, by columns");
    }
}

/// A batch without an instant goes through text, the batch behind it by columns: both are of one flight.
#[test]
fn a_flight_that_begins_in_text_goes_on_in_columns() {
    let mut table = table();
    table.instants[2] = NO_INSTANT;
    let flags = |flags: &[&str]| BatchColumn::Numbers(flags.iter().map(|_| 0.0).collect());
    let plain = MAPPING.replace(", values: [(\"ON\", 1), (\"OFF\", 0)]", "");
    let mapping = Mapping::from_ron(&plain).unwrap();
    let text = table.text().replace(",ON\n", ",0\n").replace(",OFF\n", ",0\n");
    let expected = mapping.read(text.as_bytes()).unwrap();
    assert_eq!(expected.len(), 2);
    assert_eq!(read(&mapping, table.names(), table.batches(7, &flags)), expected);
}

#[test]
fn a_time_without_a_zone_is_taken_with_the_offset_of_the_mapping() {
    let table = table();
    let flags = |flags: &[&str]| BatchColumn::Numbers(flags.iter().map(|_| 0.0).collect());
    let plain = MAPPING.replace(", values: [(\"ON\", 1), (\"OFF\", 0)]", "");
    let local = |mut batch: Batch| {
        if let BatchColumn::Instants(times) = &mut batch.columns[0].1 {
            batch.columns[0].1 = BatchColumn::LocalTimes(std::mem::take(times));
        }
        batch
    };
    let with_offset =
        |offset: &str| Mapping::from_ron(&plain.replace("utc_offset: \"Z\"", offset)).unwrap();
    let starts = |mapping: &Mapping, at_once: usize| -> Vec<i64> {
        let batches = table.batches(at_once, &flags).into_iter().map(local).collect();
        let read = read(mapping, table.names(), batches);
        read.iter().map(|flight| flight.report.header().identity.start.as_second()).collect()
    };
    let utc = starts(&with_offset("utc_offset: \"Z\""), ROWS);
    assert_eq!(utc[0], START_S);
    // At 08:00 in a zone that is two hours ahead it is 06:00 UTC. One row at a time, row 25 without a time goes through text.
    for at_once in [1, ROWS] {
        for (offset, east_s) in [("+02:00", 7_200), ("-05:30", -19_800), ("+02:00", 7_200)] {
            let found = starts(&with_offset(&format!("utc_offset: {offset:?}")), at_once);
            let expected: Vec<i64> = utc.iter().map(|start| start - east_s).collect();
            assert_eq!(found, expected, "{offset}, {at_once} rows at once");
        }
    }
    // Without an offset in the mapping nobody knows which clock it is: refused, as in a text.
    let strict =
        plain.replace(", utc_offset: \"Z\"", "").replace("    bad_rows: LeaveRowOut,\n", "");
    let mut batches = table.batches(ROWS, &flags).into_iter().map(local);
    let mut source =
        Source::table(table.names(), Vec::new(), Box::new(move |_: &[usize]| Ok(batches.next())));
    let refusal = Mapping::from_ron(&strict).unwrap().each(&mut source, None, |_| ()).unwrap_err();
    assert_eq!((refusal.line, refusal.kind.code()), (2, "source-instant-malformed"));
}

#[test]
fn a_number_that_is_refused_is_refused_where_it_is() {
    let mut table = table();
    table.numbers[1].1[20] = f64::INFINITY;
    let strict = MAPPING
        .replace("    bad_rows: LeaveRowOut,\n", "")
        .replace(", values: [(\"ON\", 1), (\"OFF\", 0)]", "");
    let mapping = Mapping::from_ron(&strict).unwrap();
    let as_numbers = |flags: &[&str]| BatchColumn::Numbers(flags.iter().map(|_| 0.0).collect());
    let mut batches = table.batches(8, &as_numbers).into_iter();
    let mut source =
        Source::table(table.names(), Vec::new(), Box::new(move |_: &[usize]| Ok(batches.next())));
    let refusal = mapping.each(&mut source, None, |_| ()).unwrap_err();
    // Line 1 has the names.
    assert_eq!((refusal.line, refusal.kind.code()), (22, "source-not-a-number"));
}

#[test]
fn a_table_that_breaks_off_says_why() {
    let mapping = Mapping::from_ron(MAPPING).unwrap();
    let names = table().names();
    let mut source = Source::table(
        names,
        Vec::new(),
        Box::new(|_: &[usize]| Err("a page is missing".to_owned())),
    );
    let refusal = mapping.each(&mut source, None, |_| ()).unwrap_err();
    assert!(refusal.to_string().contains("a page is missing"), "{refusal}");
}

/// Rows of two flights that alternate, by batches, by text, and sorted.
#[test]
fn flights_that_alternate_in_a_table_are_those_of_its_text() {
    let mut table = table();
    table.flights = (0..ROWS).map(|row| if row % 2 == 0 { "F1" } else { "F2" }).collect();
    let flags = |flags: &[&str]| BatchColumn::Numbers(flags.iter().map(|_| 0.0).collect());
    let plain = MAPPING.replace(", values: [(\"ON\", 1), (\"OFF\", 0)]", "");
    let mapping = Mapping::from_ron(&plain).unwrap();
    let text = table.text().replace(",ON\n", ",0\n").replace(",OFF\n", ",0\n");
    let (names, rows) = text.split_once('\n').unwrap();
    let of = |flight: &str| {
        let rows = rows.lines().filter(|row| row.contains(flight)).map(|row| format!("{row}\n"));
        rows.collect::<String>()
    };
    let sorted = format!("{names}\n{}{}", of(",F1,"), of(",F2,"));
    let by_name = |parsed: Vec<Parsed>| {
        let mut reports: Vec<_> = parsed.into_iter().map(|parsed| parsed.report).collect();
        reports.sort_by(|a, b| a.header().identity.flight.cmp(&b.header().identity.flight));
        reports
    };
    let expected = by_name(mapping.read(sorted.as_bytes()).unwrap());
    assert_eq!(expected.len(), 2);
    assert_eq!(by_name(mapping.read(text.as_bytes()).unwrap()), expected);
    for at_once in [1, 7, ROWS] {
        let found = by_name(read(&mapping, table.names(), table.batches(at_once, &flags)));
        assert_eq!(found, expected, "{at_once} rows at once");
    }
}
