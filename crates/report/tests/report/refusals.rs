//! Every refusal of the format's page, with its position, what was found and what was expected.
//!
//! Lines and columns were counted by hand in `BASE`. Line 1 is the name of the format, 2 to 7 the header, 8 the column
//! names, 9 the units, 10 to 12 the rows.

#![expect(clippy::expect_used, reason = "a test fails by panicking, in its helpers too")]

use report::{Reader, RefusalKind};
use test_support::reports::FORMAT_SAMPLE as BASE;

/// `BASE` with `from` replaced by `to`, once; `from` must occur in it.
fn with(from: &str, to: &str) -> String {
    assert!(BASE.contains(from), "{from:?} is not in the base report");
    BASE.replacen(from, to, 1)
}

fn check(bytes: impl AsRef<[u8]>, code: &str, expected: &str) {
    let refusal = Reader::new().read(bytes.as_ref()).expect_err(expected);
    assert_eq!(refusal.to_string(), expected);
    assert_eq!(refusal.kind.code(), code, "{expected}");
}

#[test]
fn the_base_report_reads() {
    let parsed = Reader::new().read(BASE.as_bytes()).unwrap();
    assert_eq!(parsed.report.len(), 3);
    assert!(parsed.findings.is_empty());
}

#[test]
fn first_line() {
    let line = "\"CRUISE-REPORT 1\" as the first line";
    let version = "version 1 of the format";
    for (to, code, expected) in [
        (
            "CRUISE REPORT 1\n",
            "wrong-first-line",
            format!("line 1, column 1: found \"CRUISE REPORT 1\", expected {line}"),
        ),
        (
            "cruise-report 1\n",
            "wrong-first-line",
            format!("line 1, column 1: found \"cruise-report 1\", expected {line}"),
        ),
        (
            "# note\n\n  CRUISE-REPORTS 1\n",
            "wrong-first-line",
            format!("line 3, column 3: found \"CRUISE-REPORTS 1\", expected {line}"),
        ),
        (
            "CRUISE-REPORT 2\n",
            "unsupported-version",
            format!("line 1, column 15: found \"2\", expected {version}"),
        ),
        (
            "CRUISE-REPORT 1.0\n",
            "unsupported-version",
            format!("line 1, column 15: found \"1.0\", expected {version}"),
        ),
        (
            "CRUISE-REPORT 1 draft\n",
            "unsupported-version",
            format!("line 1, column 15: found \"1 draft\", expected {version}"),
        ),
        (
            "CRUISE-REPORT\n",
            "unsupported-version",
            format!("line 1, column 14: found the end of the line, expected {version}"),
        ),
        (
            "CRUISE-REPORT\u{a0}1\n",
            "wrong-first-line",
            format!("line 1, column 1: found \"CRUISE-REPORT\\u{{a0}}1\", expected {line}"),
        ),
    ] {
        check(with("CRUISE-REPORT 1\n", to), code, &expected);
    }
    check(
        "",
        "wrong-first-line",
        &format!("line 1, column 1: found the end of the text, expected {line}"),
    );
    check(
        "# only\n",
        "wrong-first-line",
        &format!("line 1, column 7: found the end of the text, expected {line}"),
    );
}

#[test]
fn header_keys() {
    for (line, key) in [
        ("AIRCRAFT C750\n", "AIRCRAFT"),
        ("TAIL     T-001\n", "TAIL"),
        ("FLIGHT   0007\n", "FLIGHT"),
        ("START    2018-05-20T14:14:21Z\n", "START"),
        ("ZFW      24283 lb\n", "ZFW"),
        ("FOB      7219 lb\n", "FOB"),
    ] {
        check(
            with(line, ""),
            "header-key-missing",
            &format!(
                "line 7, column 1: found \"TIME\", expected header key {key} before the column names"
            ),
        );
        check(
            with(line, &format!("{line}{line}")),
            "header-key-doubled",
            &format!(
                "line {0}, column 1: found \"{key}\", expected {key} once (it is in line {1} already)",
                2 + BASE.lines().position(|text| text.starts_with(key)).unwrap(),
                1 + BASE.lines().position(|text| text.starts_with(key)).unwrap()
            ),
        );
    }
    check(
        with("FOB ", "LHV 43.1 MJ/kg\nLHV 43.1 MJ/kg\nFOB "),
        "header-key-doubled",
        "line 8, column 1: found \"LHV\", expected LHV once (it is in line 7 already)",
    );
    // Different case is a different key: a note, and the required one is missing.
    check(
        with("TAIL ", "Tail "),
        "header-key-missing",
        "line 8, column 1: found \"TIME\", expected header key TAIL before the column names",
    );
    check(
        BASE.split("TIME").next().unwrap(),
        "column-names-missing",
        "line 7, column 17: found the end of the text, expected a line of column names that begins with TIME",
    );
}

#[test]
fn header_values() {
    let start = "an instant like 2018-05-20T14:14:21Z (RFC 3339, with Z or an offset) after START";
    let mass = "a number and lb or kg, at most 1000000 kg after";
    let heat = "a number above zero and MJ/kg after LHV";
    let missing = "one or more of SAT N2 ROLL DRIFT, each once after MISSING";
    let assumed = "assumptions like SAT=ISA+3, each once after ASSUMED";
    let sat = "SAT=ISA, SAT=ISA+3 or SAT=ISA-2.5 (at most 120 K from the ISA) after ASSUMED";
    for (from, to, position, expected) in [
        ("T-001", "", "line 3, column 5: found the end of the line", "text after TAIL"),
        ("T-001", "# T-001", "line 3, column 5: found the end of the line", "text after TAIL"),
        (
            "2018-05-20T14:14:21Z",
            "2018-05-20T14:14:21",
            "line 5, column 10: found \"2018-05-20T14:14:21\"",
            start,
        ),
        (
            "2018-05-20T14:14:21Z",
            "2018-05-20 14:14:21Z",
            "line 5, column 10: found \"2018-05-20 14:14:21Z\"",
            start,
        ),
        (
            "2018-05-20T14:14:21Z",
            "20180520T141421Z",
            "line 5, column 10: found \"20180520T141421Z\"",
            start,
        ),
        (
            "2018-05-20T14:14:21Z",
            "2018-02-30T14:14:21Z",
            "line 5, column 10: found \"2018-02-30T14:14:21Z\"",
            start,
        ),
        (
            "2018-05-20T14:14:21Z",
            "2018-05-20T14:14Z",
            "line 5, column 10: found \"2018-05-20T14:14Z\"",
            start,
        ),
        (
            "2018-05-20T14:14:21Z",
            "2018-05-20T14:14:21.Z",
            "line 5, column 10: found \"2018-05-20T14:14:21.Z\"",
            start,
        ),
        (
            "2018-05-20T14:14:21Z",
            "2018-05-20T14:14:21+1",
            "line 5, column 10: found \"2018-05-20T14:14:21+1\"",
            start,
        ),
        ("24283 lb", "24283lb", "line 6, column 10: found \"24283lb\"", &format!("{mass} ZFW")),
        ("24283 lb", "24283", "line 6, column 10: found \"24283\"", &format!("{mass} ZFW")),
        ("24283 lb", "24283 t", "line 6, column 16: found \"t\"", &format!("{mass} ZFW")),
        ("24283 lb", "24283 LB", "line 6, column 16: found \"LB\"", &format!("{mass} ZFW")),
        (
            "24283 lb",
            "24283 lb dry",
            "line 6, column 10: found \"24283 lb dry\"",
            &format!("{mass} ZFW"),
        ),
        ("24283 lb", "24,283 lb", "line 6, column 10: found \"24,283 lb\"", &format!("{mass} ZFW")),
        (
            "24283 lb",
            "1000001 kg",
            "line 6, column 10: found \"1000001 kg\"",
            &format!("{mass} ZFW"),
        ),
        ("7219 lb", "1e999 lb", "line 7, column 10: found \"1e999 lb\"", &format!("{mass} FOB")),
        ("FOB ", "LHV 43.1\nFOB ", "line 7, column 5: found \"43.1\"", heat),
        ("FOB ", "LHV 0 MJ/kg\nFOB ", "line 7, column 5: found \"0 MJ/kg\"", heat),
        ("FOB ", "LHV 18500 BTU/lb\nFOB ", "line 7, column 5: found \"18500 BTU/lb\"", heat),
        ("FOB ", "MISSING\nFOB ", "line 7, column 8: found the end of the line", missing),
        ("FOB ", "MISSING ROLL MACH\nFOB ", "line 7, column 14: found \"MACH\"", missing),
        ("FOB ", "MISSING ROLL, ROLL\nFOB ", "line 7, column 15: found \"ROLL\"", missing),
        ("FOB ", "MISSING ROLL,MACH\nFOB ", "line 7, column 14: found \"MACH\"", missing),
        ("FOB ", "ASSUMED\nFOB ", "line 7, column 8: found the end of the line", assumed),
        ("FOB ", "ASSUMED warm\nFOB ", "line 7, column 9: found \"warm\"", assumed),
        ("FOB ", "ASSUMED CG=\nFOB ", "line 7, column 9: found \"CG=\"", assumed),
        ("FOB ", "ASSUMED =25\nFOB ", "line 7, column 9: found \"=25\"", assumed),
        ("FOB ", "ASSUMED CG=25 CG=26\nFOB ", "line 7, column 15: found \"CG=26\"", assumed),
        ("FOB ", "ASSUMED SAT=warm\nFOB ", "line 7, column 9: found \"SAT=warm\"", sat),
        ("FOB ", "ASSUMED CG=25 SAT=ISA3\nFOB ", "line 7, column 15: found \"SAT=ISA3\"", sat),
        ("FOB ", "ASSUMED SAT=ISA+\nFOB ", "line 7, column 9: found \"SAT=ISA+\"", sat),
        ("FOB ", "ASSUMED SAT=ISA+121\nFOB ", "line 7, column 9: found \"SAT=ISA+121\"", sat),
    ] {
        check(
            with(from, to),
            "header-value-malformed",
            &format!("{position}, expected {expected}"),
        );
    }
}

#[test]
fn masses() {
    for (from, to, expected) in [
        ("24283 lb", "0 lb", "line 6, column 10: found \"0 lb\", expected ZFW above zero"),
        (
            "24283 lb",
            "-24283 lb",
            "line 6, column 10: found \"-24283 lb\", expected ZFW above zero",
        ),
        ("7219 lb", "-1 kg", "line 7, column 10: found \"-1 kg\", expected FOB above zero"),
    ] {
        check(with(from, to), "mass-not-positive", expected);
    }
    // Gross mass: all fuel used and a zero-fuel weight that vanishes in rounding.
    let text = with("24283 lb", "1e-300 lb").replace("1396", "7219.000000002");
    let refusal = Reader::new().read(text.as_bytes()).unwrap_err();
    assert_eq!(refusal.kind, RefusalKind::MassNotPositive { mass: "gross mass" });
    assert_eq!((refusal.line, refusal.column), (12, 1));
}

#[test]
fn column_names() {
    let unknown = "one of TIME ALT SAT MACH VTAS GSPD ROLL DRIFT N2(k) WF(k) WF FU LAT LON HDG CG TAT N1(k) EGT(k) FQ A/I \
         (k from 1 to 4), or a name that begins with X-";
    for (from, to, code, expected) in [
        (" LAT ", " LATITUDE ", "column-unknown", format!("line 8, column 67: found \"LATITUDE\", expected {unknown}")),
        (" LAT ", " lat ", "column-unknown", format!("line 8, column 67: found \"lat\", expected {unknown}; did you mean LAT?")),
        ("N2(2)", "N2(5)", "column-unknown", format!("line 8, column 46: found \"N2(5)\", expected {unknown}; did you mean N2(k)?")),
        ("N2(2)", "N2", "column-unknown", format!("line 8, column 46: found \"N2\", expected {unknown}")),
        (" LAT ", " x-LAT ", "column-unknown", format!("line 8, column 67: found \"x-LAT\", expected {unknown}")),
        (" LAT ", " ALT ", "column-doubled", "line 8, column 67: found \"ALT\", expected each column once (it is at column 6 already)".to_owned()),
        (" LAT LON ", " X-A X-A ", "column-doubled", "line 8, column 71: found \"X-A\", expected each column once (it is at column 67 already)".to_owned()),
        (" LAT ", " TIME ", "column-doubled", "line 8, column 67: found \"TIME\", expected each column once (it is at column 1 already)".to_owned()),
    ] {
        check(with(from, to), code, &expected);
    }
}

#[test]
fn required_columns() {
    let names = BASE.lines().nth(7).unwrap();
    for (name, expected) in [
        ("ALT", "column ALT"),
        ("SAT", "column SAT, or MISSING SAT in the header"),
        ("MACH", "column MACH"),
        ("VTAS", "column VTAS"),
        ("GSPD", "column GSPD"),
        ("ROLL", "column ROLL, or MISSING ROLL in the header"),
        ("DRIFT", "column DRIFT, or MISSING DRIFT in the header"),
        ("FU", "column FU"),
    ] {
        let without = names.replacen(&format!(" {name} "), " ", 1);
        check(
            with(names, &without),
            "column-missing",
            &format!(
                "line 8, column {}: found the end of the line, expected {expected}",
                without.len() + 1
            ),
        );
    }
    check(
        with(" N2(1) N2(2)", ""),
        "column-missing",
        "line 8, column 73: found the end of the line, expected column N2(k) for each engine, or MISSING N2 in the header",
    );
    check(
        with(" WF(1) WF(2)", ""),
        "column-missing",
        "line 8, column 73: found the end of the line, expected column WF(k) for each engine, or WF of all engines",
    );
}

#[test]
fn engines() {
    let gap = "too: engines count from 1 without a gap";
    let set = "too: N2 and WF are of the same engines";
    for (from, to, code, expected) in [
        ("N2(1) N2(2)", "N2(1) N2(3)", "engine-missing", format!("line 8, column 46: found \"N2(3)\", expected N2(2) {gap}")),
        ("N2(1) N2(2)", "N2(2)", "engine-missing", format!("line 8, column 40: found \"N2(2)\", expected N2(1) {gap}")),
        ("WF(1) WF(2)", "WF(4)", "engine-missing", format!("line 8, column 52: found \"WF(4)\", expected WF(1) {gap}")),
        ("WF(1) WF(2)", "WF(1)", "engines-differ", format!("line 8, column 46: found \"N2(2)\", expected WF(2) {set}")),
        ("N2(1) N2(2)", "N2(1)", "engines-differ", format!("line 8, column 52: found \"WF(2)\", expected N2(2) {set}")),
        (" CG ", " N1(3) ", "engine-missing", format!("line 8, column 79: found \"N1(3)\", expected WF(3) {gap}")),
        (" CG ", " EGT(4) ", "engine-missing", format!("line 8, column 79: found \"EGT(4)\", expected WF(4) {gap}")),
        (" CG ", " WF ", "fuel-flow-twice", "line 8, column 79: found \"WF\", expected either WF(k) of each engine or WF of all engines, not both".to_owned()),
    ] {
        check(with(from, to), code, &expected);
    }
}

#[test]
fn unit_line() {
    let upto_names: String = BASE.split_inclusive('\n').take(8).collect();
    check(
        upto_names,
        "units-missing",
        "line 8, column 85: found the end of the text, expected a line of units",
    );
    for (from, to, code, expected) in [
        (
            "%MAC -\n",
            "%MAC\n",
            "unit-count-wrong",
            "line 9, column 60: found 17 units, expected 18 units, one per column",
        ),
        (
            "%MAC -\n",
            "%MAC - -\n",
            "unit-count-wrong",
            "line 9, column 63: found 19 units, expected 18 units, one per column",
        ),
        (
            "s ft ",
            "h ft ",
            "unit-unknown",
            "line 9, column 1: found \"h\", expected s or min for TIME",
        ),
        (
            "s ft ",
            "s FL ",
            "unit-unknown",
            "line 9, column 3: found \"FL\", expected ft or m for ALT",
        ),
        (
            "degC",
            "degc",
            "unit-unknown",
            "line 9, column 6: found \"degc\", expected degC or K for SAT; did you mean degC?",
        ),
        (
            "lb/h lb/h",
            "lb/h g/s",
            "unit-unknown",
            "line 9, column 36: found \"g/s\", expected lb/h, kg/h or kg/s for WF(2); did you mean kg/s?",
        ),
        (
            "- kt kt",
            "M kt kt",
            "unit-unknown",
            "line 9, column 11: found \"M\", expected - for MACH",
        ),
    ] {
        check(with(from, to), code, expected);
    }
}

#[test]
fn field_counts() {
    for (from, to, code, expected) in [
        (
            "27.2 0\n60",
            "27.2\n60",
            "too-few-fields",
            "line 10, column 91: found 17 fields, expected 18 fields, one per column",
        ),
        (
            "27.2 0\n60",
            "27.2 # 0\n60",
            "too-few-fields",
            "line 10, column 91: found 17 fields, expected 18 fields, one per column",
        ),
        (
            "27.2 0\n60",
            "27.2 0 0\n60",
            "too-many-fields",
            "line 10, column 94: found 19 fields, expected 18 fields, one per column",
        ),
        (
            "0 43008",
            "0 43008\t\t\n",
            "too-few-fields",
            "line 10, column 8: found 2 fields, expected 18 fields, one per column",
        ),
    ] {
        check(with(from, to), code, expected);
    }
}

#[test]
fn numbers() {
    for (from, to, column, found, expected) in [
        ("43008", "FL430", 3, "FL430", "a number in ALT"),
        ("43008", "43,008", 3, "43,008", "a number in ALT"),
        ("43008", "-", 3, "-", "a number in ALT"),
        ("43008", "nan", 3, "nan", "a number in ALT"),
        ("43008", "inf", 3, "inf", "a number in ALT"),
        ("43008", "4.3E4", 3, "4.3E4", "a number in ALT"),
        ("43008", "1e400", 3, "1e400", "a number in ALT"),
        ("43008", "43008#", 3, "43008#", "a number in ALT"),
        ("43008", "43008\u{a0}", 3, "43008\\u{a0}", "a number in ALT"),
        ("43008", "43008\r", 3, "43008\\r", "a number in ALT"),
        ("43008", "４３", 3, "４３", "a number in ALT"),
        ("-0.1 ", ". ", 34, ".", "a number in ROLL"),
        ("-69.976", "--", 73, "--", "a number or - in LON"),
        ("-69.976", "n/a", 73, "n/a", "a number or - in LON"),
        ("0 43008", "00:00 43008", 1, "00:00", "a number in TIME"),
    ] {
        check(
            with(from, to),
            "not-a-number",
            &format!("line 10, column {column}: found \"{found}\", expected {expected}"),
        );
    }
    // Blanks in a number make it two: the row is too long, whatever its shifted fields hold.
    check(
        with("0 43008", "# § 1\n0\t\t43 008"),
        "too-many-fields",
        "line 11, column 94: found 19 fields, expected 18 fields, one per column",
    );
}

#[test]
fn ranges() {
    for (from, to, column, expected) in [
        (" 43008 ", " 60000.1 ", 3, "ALT of -2000 to 60000 ft (limit here 60000 ft)"),
        (" 43008 ", " -2000.1 ", 3, "ALT of -2000 to 60000 ft (limit here -2000 ft)"),
        (" -56.6 ", " -100.01 ", 9, "SAT of -100 to +60 degC (limit here -100 degC)"),
        (" -56.6 ", " 60.01 ", 9, "SAT of -100 to +60 degC (limit here 60 degC)"),
        (" 0.8030 ", " 0.9901 ", 15, "MACH of 0.1 to 0.99 (limit here 0.99 -)"),
        (" 0.8030 ", " 0.0999 ", 15, "MACH of 0.1 to 0.99 (limit here 0.1 -)"),
        (" 460.5 ", " 49.9 ", 22, "VTAS of 50 to 1000 kt (limit here 50 kt)"),
        (" 451.5 ", " 1000.1 ", 28, "GSPD of 50 to 1000 kt (limit here 1000 kt)"),
        (" -0.1 ", " -90.1 ", 34, "ROLL of -90 to 90 deg (limit here -90 deg)"),
        (" 4.2 ", " 90.1 ", 39, "DRIFT of -90 to 90 deg (limit here 90 deg)"),
        (" 89.4 89.4 ", " 130.1 89.4 ", 43, "N2(1) of 0 to 130 % (limit here 130 %)"),
        (" 654 ", " 0 ", 53, "WF(1) of above 0 to 100000 lb/h (limit here 0 lb/h)"),
        (" 654 ", " 100001 ", 53, "WF(1) of above 0 to 100000 lb/h (limit here 100000 lb/h)"),
        (" 1353 ", " -1 ", 61, "FU of 0 to FOB (limit here 0 lb)"),
        (" 1353 ", " 7219.1 ", 61, "FU of 0 to FOB (limit here 7219 lb)"),
        (" 41.516 ", " 90.001 ", 66, "LAT of -90 to 90 deg (limit here 90 deg)"),
        (" -69.976 ", " -180.1 ", 73, "LON of -180 to 360 deg (limit here -180 deg)"),
        (" 118.7 ", " 360.1 ", 81, "HDG of -360 to 360 deg (limit here 360 deg)"),
        (" 27.2 ", " 150.1 ", 87, "CG of -50 to 150 %MAC (limit here 150 %MAC)"),
        (" 27.2 0\n", " 27.2 2\n", 92, "A/I of 0 or 1 (limit here 1 -)"),
        (" 27.2 0\n", " 27.2 0.5\n", 92, "A/I of 0 or 1 (limit here 1 -)"),
    ] {
        let base = with(from, to);
        let found = to.trim().rsplit(' ').next().unwrap();
        let found = if from.contains("89.4") { "130.1" } else { found };
        check(
            &base,
            "out-of-range",
            &format!("line 10, column {column}: found \"{found}\", expected {expected}"),
        );
    }
}

#[test]
fn ranges_of_columns_that_the_base_has_not() {
    for (name, unit, value, expected) in [
        ("TAT", "degC", "90.1", "TAT of -100 to +90 degC (limit here 90 degC)"),
        ("EGT(2)", "K", "1773.2", "EGT(2) of -100 to 1500 degC (limit here 1773.15 K)"),
        ("N1(1)", "%", "-0.1", "N1(1) of 0 to 130 % (limit here 0 %)"),
        ("FQ", "lb", "7363.5", "FQ of 0 to 1.02 FOB (limit here 7363.38 lb)"),
        ("FQ", "kg", "3340", "FQ of 0 to 1.02 FOB (limit here 3339.97298541 kg)"),
    ] {
        let text = BASE
            .replace(" CG A/I", &format!(" {name} A/I"))
            .replace(" %MAC -", &format!(" {unit} -"))
            .replace(" 27.2 0", &format!(" {value} 0"))
            .replace(" 27.1 0", &format!(" {value} 0"));
        let expected = format!("line 10, column 87: found \"{value}\", expected {expected}");
        check(text, "out-of-range", &expected);
    }
}

/// TIME has no limit of its own, but a number of minutes has to be one of seconds too.
#[test]
fn a_time_in_minutes_is_finite_in_seconds() {
    for (from, value) in [("\n0 ", "-1e307"), ("\n60 ", "1e307")] {
        let text = with(from, &format!("\n{value} ")).replacen("\ns ", "\nmin ", 1);
        assert!(text.contains("\nmin "));
        let refusal = Reader::new().read(text.as_bytes()).unwrap_err();
        assert_eq!(refusal.kind.code(), "out-of-range", "{refusal}");
        assert!(refusal.to_string().contains(value), "{refusal}");
    }
}

#[test]
fn series() {
    for (from, to, code, expected) in [
        (
            "\n60 ",
            "\n0 ",
            "time-not-increasing",
            "line 11, column 1: found \"0\", expected TIME above that of the row before, 0 s",
        ),
        (
            "\n120 ",
            "\n59.9 ",
            "time-not-increasing",
            "line 12, column 1: found \"59.9\", expected TIME above that of the row before, 60 s",
        ),
        (
            " 1396 ",
            " 1373.9 ",
            "fuel-used-falls",
            "line 12, column 62: found \"1373.9\", expected FU no more than 1 lb below its largest value so far, 1375 lb",
        ),
    ] {
        check(with(from, to), code, expected);
    }
    // The largest value so far counts, not the one before; half a kilogram where the unit is the kilogram.
    let in_kilograms = with("lb deg deg deg", "kg deg deg deg").replace(" 1353 ", " 1375.4 ");
    check(
        in_kilograms.replace(" 1396 ", " 1374.8 "),
        "fuel-used-falls",
        "line 12, column 62: found \"1374.8\", expected FU no more than 0.5 kg below its largest value so far, 1375.4 kg",
    );
    Reader::new().read(in_kilograms.replace(" 1396 ", " 1374.9 ").as_bytes()).unwrap();
    Reader::new().read(with(" 1396 ", " 1374 ").as_bytes()).unwrap();
}

#[test]
fn too_few_rows() {
    let rows = |count: usize| -> String { BASE.split_inclusive('\n').take(9 + count).collect() };
    check(rows(0), "too-few-rows", "line 9, column 62: found 0 rows, expected at least 3 rows");
    check(rows(2), "too-few-rows", "line 11, column 93: found 2 rows, expected at least 3 rows");
}

#[test]
fn last_row_without_line_end() {
    let complete = BASE.trim_end();
    let parsed = Reader::new().read(complete.as_bytes()).unwrap();
    assert_eq!(parsed.findings.len(), 1);
    assert_eq!(parsed.findings[0].code, "last-row-without-line-end");
    assert_eq!(parsed.findings[0].line, Some(12));

    let expected = "a complete row of 18 fields and a line end";
    for (end, position) in [
        (" 27.1", "line 12, column 92: found 17 fields"),
        (" 27.1 ", "line 12, column 92: found 17 fields"),
        (" 27.1 1e", "line 12, column 93: found \"1e\""),
        (" 27.1 1e-", "line 12, column 93: found \"1e-\""),
        (" 27.1 +", "line 12, column 93: found \"+\""),
        (" 27.1 -", "line 12, column 93: found \"-\""),
        (" -", "line 12, column 88: found \"-\""),
    ] {
        let text = complete.strip_suffix(" 27.1 0").unwrap().to_owned() + end;
        check(text, "last-row-unfinished", &format!("{position}, expected {expected}"));
    }
    // A blank, a comment or half a line end shows that "-" is complete.
    for end in [" 27.1 - ", " 27.1 - # anti-ice unknown", " 27.1 -\t"] {
        let text = complete.strip_suffix(" 27.1 0").unwrap().to_owned() + end;
        let parsed = Reader::new().read(text.as_bytes()).unwrap();
        assert_eq!(parsed.findings[0].code, "last-row-without-line-end", "{end:?}");
        assert_eq!(
            parsed.report.columns().optional.get(flight::column::Column::AntiIce).unwrap()[2],
            None
        );
    }
    // A last line that is not a row needs no line end.
    let with_comment = format!("{BASE}# end");
    assert!(Reader::new().read(with_comment.as_bytes()).unwrap().findings.is_empty());
}

#[test]
fn encodings() {
    check(
        with("T-001", "T-\0"),
        "nul-byte",
        "line 3, column 12: found byte 0x00, expected text without NUL bytes",
    );
    let mut latin1 = with("T-001", "§§!").into_bytes();
    let at = latin1.iter().position(|byte| *byte == b'!').unwrap();
    latin1[at] = 0xe9;
    check(latin1, "invalid-utf8", "line 3, column 12: found byte 0xe9, expected UTF-8 text");
    let utf16: Vec<u8> = [0xff, 0xfe].into_iter().chain(BASE.bytes()).collect();
    check(utf16, "invalid-utf8", "line 1, column 1: found byte 0xff, expected UTF-8 text");
    check(
        format!("\u{feff}{}", with("CRUISE-REPORT 1", "CRUISE-REPORT 1\0")),
        "nul-byte",
        "line 1, column 16: found byte 0x00, expected text without NUL bytes",
    );
}

#[test]
fn gzip() {
    use std::io::Write;
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(BASE.as_bytes()).unwrap();
    let good = encoder.finish().unwrap();
    assert_eq!(Reader::new().read(&good).unwrap(), Reader::new().read(BASE.as_bytes()).unwrap());

    for length in [2, 10, good.len() / 2, good.len() - 8, good.len() - 1] {
        let refusal = Reader::new().read(&good[..length]).unwrap_err();
        assert_eq!(refusal.kind, RefusalKind::GzipTruncated, "{length} bytes");
    }
    for position in [3, good.len() / 2, good.len() - 8, good.len() - 2] {
        let mut bad = good.clone();
        bad[position] ^= 0x55;
        let refusal = Reader::new().read(&bad).unwrap_err();
        assert!(
            matches!(refusal.kind, RefusalKind::GzipCorrupt | RefusalKind::GzipTruncated),
            "byte {position}: {refusal}"
        );
    }
    // A wrong checksum is found after the whole text: the position is its end.
    let mut bad = good.clone();
    bad[good.len() - 8] ^= 1;
    check(
        bad,
        "gzip-corrupt",
        "line 13, column 1: found the end of the text, expected compressed text: the gzip file is corrupt",
    );
}

#[test]
fn a_stream_that_fails() {
    struct Broken;
    impl std::io::Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::PermissionDenied.into())
        }
    }
    let stream = std::io::BufReader::new(Broken);
    let refusal = Reader::new().read_from(stream).unwrap_err();
    assert_eq!(
        refusal.to_string(),
        "line 1, column 1: found the end of the text, expected readable input: permission denied"
    );
}

#[test]
fn the_first_refusal_in_reading_order() {
    let text = with(" 43003 -56.5", " FL430 -56.5").replace(" 1353 ", " 99999 ");
    let refusal = Reader::new().read(text.as_bytes()).unwrap_err();
    assert_eq!((refusal.line, refusal.column), (10, 61));
}
