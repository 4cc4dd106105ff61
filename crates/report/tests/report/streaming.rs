//! Recordings longer than what is read at a time: the same reports, and refusals with their place in the file.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helpers too")]

use core::fmt::Write as _;
use std::io::Write as _;

use report::{Mapping, Parsed, Refusal};

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
    bad_rows: Refuse,
)"#;

const FLIGHTS: usize = 5;
const ROWS_OF_A_FLIGHT: usize = 6000;

/// Two megabytes: every piece boundary lies within a flight.
fn recording() -> String {
    let mut text = String::from("utc,reg,flt,alt,sat,mach,gs,ff,gw,remark\n");
    for flight in 1..=FLIGHTS {
        for second in 0..ROWS_OF_A_FLIGHT {
            let (hour, minute) = (8 + second / 3600, second / 60 % 60);
            let mass = 65_000.0 - 0.6 * second as f64;
            writeln!(
                text,
                "2024-03-0{flight}T{hour:02}:{minute:02}:{:02}.5,D-ABCD,LH{flight},{},-54.{},0.78,450,2{},{mass:.1},as flown",
                second % 60,
                35_000 + second % 3,
                second % 10,
                400 + second % 7,
            )
            .unwrap();
        }
    }
    text
}

fn read(bytes: &[u8]) -> Result<Vec<Parsed>, Refusal> {
    Mapping::from_ron(MAPPING).unwrap().read(bytes)
}

/// A line of the recording, counted from 1, with other text.
fn with_line(text: &str, line: usize, change: impl Fn(&str) -> String) -> String {
    let lines = text
        .lines()
        .enumerate()
        .map(|(index, sent)| if index + 1 == line { change(sent) } else { sent.to_owned() });
    lines.collect::<Vec<_>>().join("\n") + "\n"
}

#[test]
fn every_row_of_every_flight_is_read() {
    let text = recording();
    assert!(text.len() > 2_000_000);
    let reports = read(text.as_bytes()).unwrap();
    assert_eq!(reports.len(), FLIGHTS);
    for (index, parsed) in reports.iter().enumerate() {
        let (header, columns) = (parsed.report.header(), parsed.report.columns());
        assert_eq!(header.identity.flight, format!("LH{}", index + 1));
        let start = format!("2024-03-0{}T08:00:00.5Z", index + 1);
        assert_eq!(header.identity.start, start.parse().unwrap());
        let seconds: Vec<f64> = (0..ROWS_OF_A_FLIGHT).map(|second| second as f64).collect();
        assert_eq!(columns.time_s, seconds);
        assert!((columns.fuel_used_kg[ROWS_OF_A_FLIGHT - 1] - 3599.4).abs() < 1e-6);
    }
}

/// Quotes, line ends of two bytes, gzip, UTF-16 and Windows-1252 are other roads to the same rows.
#[test]
fn other_forms_of_the_same_text_are_the_same_reports() {
    let text = recording();
    let expected = read(text.as_bytes()).unwrap();
    let quoted = text.replace(",as flown", ",\"as, \"\"flown\"\"\nin two lines\"");
    let read_quoted = read(quoted.as_bytes()).unwrap();
    let columns = |parsed: &[Parsed]| -> Vec<_> {
        parsed.iter().map(|parsed| parsed.report.columns().clone()).collect()
    };
    assert_eq!(columns(&read_quoted), columns(&expected));
    assert_eq!(read(text.replace('\n', "\r\n").as_bytes()).unwrap(), expected);
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(text.as_bytes()).unwrap();
    assert_eq!(read(&packer.finish().unwrap()).unwrap(), expected);
    let utf_16: Vec<u8> = core::iter::once(0xfeff_u16)
        .chain(text.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    assert_eq!(read(&utf_16).unwrap(), expected);
    // A letter of Windows-1252 far behind the beginning.
    let last = FLIGHTS * ROWS_OF_A_FLIGHT + 1;
    let marked = with_line(&text, last, |line| line.replace("as flown", "wie ge?bt"));
    let mut windows = marked.into_bytes();
    let at = windows.iter().rposition(|byte| *byte == b'?').unwrap();
    windows[at] = 0xfc;
    assert_eq!(read(&windows).unwrap(), expected);
}

#[test]
fn a_refusal_far_behind_has_its_line_and_column() {
    let text = recording();
    let line = 4 * ROWS_OF_A_FLIGHT + 3;
    let refusal = read(with_line(&text, line, |sent| sent.replace("0.78", "0,78")).as_bytes());
    assert_eq!(
        refusal.unwrap_err().to_string(),
        format!("line {line}, column 68: found 11 fields, expected 10 fields, one per column")
    );
    let refusal = read(with_line(&text, line, |sent| sent.replace("0.78", "fast")).as_bytes());
    let refusal = refusal.unwrap_err();
    // 2024-03-05T08:00:01.5,D-ABCD,LH5,35001,-54.1,fast
    assert_eq!((refusal.line, refusal.column), (line, 46));
    // A byte that no text has.
    let refusal =
        read(with_line(&text, line, |sent| sent.replace("as flown", "as\0flown")).as_bytes());
    assert_eq!(refusal.unwrap_err().line, line);
    // Found only when the flight is at its end.
    let refusal = read(with_line(&text, line, |sent| sent.replace("0.78", "7.8")).as_bytes());
    let refusal = refusal.unwrap_err();
    assert_eq!((refusal.line, refusal.column), (line, 46));
    // The first of two at fault, though the other is found before.
    let two = with_line(&text, 7, |sent| sent.replace("0.78", "7.8"));
    let refusal = read(with_line(&two, line, |sent| sent.replace("0.78", "fast")).as_bytes());
    assert_eq!(refusal.unwrap_err().line, 7);
}

#[test]
fn what_is_cut_off_is_refused() {
    let text = recording();
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(text.as_bytes()).unwrap();
    let packed = packer.finish().unwrap();
    let refusal = read(&packed[..packed.len() / 2]).unwrap_err();
    assert!(refusal.to_string().contains("gzip"), "{refusal}");
    let without_end = &text[..text.len() - 1];
    assert_eq!(read(without_end.as_bytes()).unwrap(), read(text.as_bytes()).unwrap());
}
