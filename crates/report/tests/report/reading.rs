//! What the format allows, read as the format's page defines it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helpers too")]
#![expect(clippy::disallowed_methods, reason = "tests read data from files")]

use flight::column::Column;
use flight::{Assumption, FuelFlowColumns, MissingColumn};
use report::{Parsed, Reader};
use test_support::outside_data;
use test_support::reports::FORMAT_SAMPLE as SAMPLE;

fn read(text: &str) -> Parsed {
    Reader::new().read(text.as_bytes()).unwrap()
}

fn assert_close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs(), "{found} is not {expected}");
}

/// The number of the only finding.
fn only_code(parsed: &Parsed) -> &'static str {
    assert_eq!(parsed.findings.len(), 1, "{:?}", parsed.findings);
    parsed.findings[0].code
}

/// A report with the given header lines, column names, units and rows.
fn report_of(header: &str, names: &str, units: &str, rows: [&str; 3]) -> String {
    format!(
        "CRUISE-REPORT 1\nAIRCRAFT A\nTAIL T\nFLIGHT F\nSTART 2020-01-01T00:00:00Z\nZFW 40000 kg\nFOB 10000 kg\n\
         {header}{names}\n{units}\n{}\n{}\n{}\n",
        rows[0], rows[1], rows[2]
    )
}

/// Who flew and when is in the first lines; a beginning that ends before the columns' names holds no whole header.
#[test]
fn the_head_of_the_sample() {
    let at = SAMPLE.find("\n0 ").unwrap();
    for beginning in [SAMPLE.as_bytes(), &SAMPLE.as_bytes()[..=at]] {
        let head = report::head(beginning).unwrap();
        assert_eq!(head.aircraft_type, "C750");
        assert_eq!((head.identity.tail.as_str(), head.identity.flight.as_str()), ("T-001", "0007"));
        assert_eq!(head.identity.start.as_second(), 17_671 * 86_400 + 51_261);
    }
    let cut = SAMPLE.find("ZFW").unwrap();
    assert_eq!(report::head(&SAMPLE.as_bytes()[..cut]), None);
    assert_eq!(report::head(b"no report"), None);
}

#[test]
fn the_sample_of_the_format_page() {
    let report = read(SAMPLE).report;
    let header = report.header();
    assert_eq!(header.aircraft_type, "C750");
    assert_eq!(header.identity.tail, "T-001");
    assert_eq!(header.identity.flight, "0007");
    // 17 671 days and 51 261 s after 1970-01-01: 48 years with 12 leap days, 139 days to 20 May, 14:14:21.
    assert_eq!(header.identity.start.as_second(), 17_671 * 86_400 + 51_261);
    // Factors of the unit page: 1 lb = 0.45359237 kg, 1 ft = 0.3048 m, 1 kt = 1852/3600 m/s, 0 °C = 273.15 K.
    assert_close(header.zero_fuel_mass.to_kilograms(), 24_283.0 * 0.45359237);
    assert_close(header.fuel_on_board.to_kilograms(), 7_219.0 * 0.45359237);
    assert_eq!(header.lower_heating_value_mj_kg, None);
    assert!(header.missing.is_empty() && header.assumed.is_empty() && header.notes.is_empty());

    let columns = report.columns();
    assert_eq!(columns.time_s, [0.0, 60.0, 120.0]);
    assert_close(columns.pressure_altitude_m[1], 43_003.0 * 0.3048);
    assert_close(columns.static_air_temperature_k.as_ref().unwrap()[2], 273.15 - 56.8);
    assert_eq!(columns.mach, [0.803, 0.8025, 0.8025]);
    assert_close(columns.true_airspeed_m_s[2], 460.0 * 1852.0 / 3600.0);
    assert_close(columns.ground_speed_m_s[0], 451.5 * 1852.0 / 3600.0);
    assert_eq!(columns.roll_deg.as_ref().unwrap(), &[-0.1, 0.0, 0.0]);
    assert_eq!(columns.drift_deg.as_ref().unwrap(), &[4.2, 4.4, 4.6]);
    assert_eq!(
        columns.n2_percent.as_ref().unwrap(),
        &[vec![89.4, 89.4, 89.5], vec![89.4, 89.3, 89.5]]
    );
    let FuelFlowColumns::PerEngine(flows) = &columns.fuel_flow else { panic!("per engine") };
    assert_close(flows[0][0], 654.0 * 0.45359237 / 3600.0);
    assert_close(flows[1][1], 648.0 * 0.45359237 / 3600.0);
    assert_close(columns.fuel_used_kg[2], 1_396.0 * 0.45359237);
    assert_eq!(columns.optional.get(Column::Latitude).unwrap()[0], Some(41.516));
    assert_eq!(columns.optional.get(Column::Longitude).unwrap()[1], Some(-69.829));
    assert_eq!(columns.optional.get(Column::TrueHeading).unwrap()[2], Some(118.7));
    assert_eq!(columns.optional.get(Column::CenterOfGravity).unwrap()[2], Some(27.1));
    assert_eq!(columns.optional.get(Column::AntiIce).unwrap()[0], Some(0.0));
    assert_eq!(report.engines(), Some(2));
}

#[test]
fn layout_means_nothing() {
    let expected = read(SAMPLE);
    let same = [
        ("byte-order mark", format!("\u{feff}{SAMPLE}")),
        ("CRLF", SAMPLE.replace('\n', "\r\n")),
        ("byte-order mark and CRLF", format!("\u{feff}{}", SAMPLE.replace('\n', "\r\n"))),
        ("tabs", SAMPLE.replace(' ', "\t")),
        ("runs of blanks", SAMPLE.replace(' ', " \t  ")),
        ("blanks at both ends", SAMPLE.replace('\n', "  \n\t ")),
        ("blank lines", SAMPLE.replace('\n', "\n\n  \t\n")),
        ("comment lines", format!("#\n#x\n{}", SAMPLE.replace('\n', "\n# TIME 1 2 3\n\t#\n"))),
        ("comments behind", SAMPLE.replace('\n', "\t# ünd so weiter 1 2 3\n")),
        ("plus signs", SAMPLE.replace(" 0.0 ", " +0.0 ").replace(" 43003 ", " +4.3003e+4 ")),
        ("points alone", SAMPLE.replace(" 0.80", " .80").replace(" 43003 ", " 43003. ")),
        ("an offset", SAMPLE.replace("T14:14:21Z", "t16:14:21.000+02:00")),
    ];
    for (what, text) in same {
        assert_eq!(read(&text), expected, "{what}");
    }
}

#[test]
fn a_stream_reads_as_its_bytes() {
    let mut reader = Reader::new();
    let from_bytes = reader.read(SAMPLE.as_bytes()).unwrap();
    assert_eq!(reader.read_from(SAMPLE.as_bytes()).unwrap(), from_bytes);
    // The reader's buffers carry nothing over, even from a refused text.
    reader.read(b"CRUISE-REPORT 1\nTIME\n").unwrap_err();
    assert_eq!(reader.read(SAMPLE.as_bytes()).unwrap(), from_bytes);
}

#[test]
fn header_values() {
    let text = SAMPLE.replace("T-001", "T 001 \"x\" # really").replace("0007", "12#7").replace(
        "FOB ",
        "LHV 43.1 MJ/kg\nASSUMED CG=25,ROLL=0\nREMARK two\twords\nREMARK\ntail T-2\nFOB ",
    );
    let parsed = read(&text);
    let header = parsed.report.header();
    assert_eq!(header.identity.tail, "T 001 \"x\"");
    assert_eq!(header.identity.flight, "12#7");
    assert_eq!(header.lower_heating_value_mj_kg, Some(43.1));
    let other = |key: &str, value: &str| Assumption::Other { key: key.into(), value: value.into() };
    assert_eq!(header.assumed, [other("CG", "25"), other("ROLL", "0")]);
    let note = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    assert_eq!(
        header.notes,
        [note("REMARK", "two\twords"), note("REMARK", ""), note("tail", "T-2")]
    );
    assert_eq!(only_code(&parsed), "header-key-kept-as-note");
}

#[test]
fn missing_columns_and_what_stands_in() {
    for (assumed, isa_deviation_k) in
        [("ISA", 0.0), ("ISA+3", 3.0), ("ISA-2.5", -2.5), ("ISA+0", 0.0)]
    {
        let text = report_of(
            &format!("MISSING DRIFT, SAT N2 ROLL\nASSUMED SAT={assumed}\n"),
            "TIME ALT MACH VTAS GSPD WF FU",
            "s m - m/s m/s kg/s kg",
            [
                "0 11000 0.78 230 235 0.7 0",
                "60 11000 0.78 230 235 0.7 42",
                "120 11000 0.78 230 235 0.7 84",
            ],
        );
        let parsed = read(&text);
        let (header, columns) = parsed.report.into_parts();
        assert_eq!(header.missing, MissingColumn::ALL);
        assert_eq!(header.assumed, [Assumption::StaticAirTemperatureIsa { isa_deviation_k }]);
        assert_eq!(columns.static_air_temperature_k, None);
        assert_eq!(columns.n2_percent, None);
        assert_eq!(columns.roll_deg, None);
        assert_eq!(columns.drift_deg, None);
        assert_eq!(columns.fuel_flow, FuelFlowColumns::Total(vec![0.7; 3]));
        assert!(parsed.findings.is_empty());
    }
}

#[test]
fn contradictions_are_found_and_not_fatal() {
    let parsed = read(&SAMPLE.replace("FOB ", "MISSING ROLL\nFOB "));
    assert_eq!(only_code(&parsed), "column-declared-missing");
    assert_eq!(parsed.findings[0].line, Some(9));
    assert_eq!(parsed.report.columns().roll_deg, None);
    let parsed = read(&SAMPLE.replace("FOB ", "ASSUMED SAT=ISA\nFOB "));
    assert_eq!(only_code(&parsed), "assumption-not-needed");
    assert!(parsed.report.columns().static_air_temperature_k.is_some());
}

#[test]
fn units_and_other_columns() {
    let text = report_of(
        "",
        "TIME X-WHO FU GSPD VTAS MACH SAT ALT DRIFT ROLL WF N2(1) N1(2) EGT(1) TAT FQ X-",
        "min furlong kg m/s m/s - K m deg deg kg/h % % K K kg °",
        [
            "-1 one 0 235 230 0.78 216.65 11000 0 0 2520 90 - - 243 10000 #7",
            "-0.5 - 21 235 230 0.78 216.65 11000 0 0 2520 90 85 900 - - - ",
            "1e0 #x 84 235 230 0.78 216.65 11000 0 0 2520 90 85 900 243 9916 x",
        ]
        .map(|row| row.replace("#7", "7").replace("#x", "x"))
        .each_ref()
        .map(String::as_str),
    );
    // One rotor speed, so one engine: N1(2) is of an engine that is not there.
    let refusal = Reader::new().read(text.as_bytes()).unwrap_err();
    assert_eq!(refusal.kind.code(), "engine-missing");
    let parsed = read(&text.replace("N1(2)", "N1(1)"));
    let columns = parsed.report.columns();
    assert_eq!(columns.time_s, [-60.0, -30.0, 60.0]);
    assert_eq!(columns.static_air_temperature_k.as_ref().unwrap(), &[216.65; 3]);
    assert_eq!(columns.fuel_flow, FuelFlowColumns::Total(vec![2520.0 / 3600.0; 3]));
    assert_eq!(columns.optional.get(Column::N1(1)).unwrap(), &[None, Some(85.0), Some(85.0)]);
    assert_eq!(columns.optional.get(Column::ExhaustGasTemperature(1)).unwrap()[0], None);
    assert_eq!(columns.optional.get(Column::TotalAirTemperature).unwrap()[1], None);
    assert_eq!(columns.optional.get(Column::FuelQuantity).unwrap()[2], Some(9916.0));
    assert_eq!(parsed.report.engines(), Some(1));
}

#[test]
fn limits_are_inclusive_in_every_unit() {
    // Decimals of the limits themselves; several are not exact after conversion to SI.
    let limits = [
        ("ALT", "ft", "-2000", "60000"),
        ("ALT", "m", "-609.6", "18288"),
        ("SAT", "degC", "-100", "60"),
        ("SAT", "K", "173.15", "333.15"),
        ("MACH", "-", "0.1", "0.99"),
        ("VTAS", "kt", "50", "1000"),
        ("GSPD", "m/s", "25.7222222222222", "514.444444444444"),
        ("ROLL", "deg", "-90", "90"),
        ("N2(1)", "%", "0", "130"),
        ("WF(1)", "lb/h", "1e-300", "100000"),
        ("WF(1)", "kg/h", "0.01", "45359.237"),
        ("FU", "kg", "0", "10000"),
        ("FU", "lb", "0", "22046.2262184878"),
        ("FQ", "kg", "0", "10200"),
        ("TAT", "K", "173.15", "363.15"),
        ("EGT(1)", "degC", "-100", "1500"),
        ("LON", "deg", "-180", "360"),
        ("CG", "%MAC", "-50", "150"),
    ];
    let others = [
        ("ALT", "m", "11000"),
        ("SAT", "K", "216.65"),
        ("MACH", "-", "0.78"),
        ("VTAS", "m/s", "230"),
        ("GSPD", "m/s", "230"),
        ("ROLL", "deg", "0"),
        ("DRIFT", "deg", "0"),
        ("N2(1)", "%", "90"),
        ("WF(1)", "kg/s", "0.7"),
        ("FU", "kg", "0"),
    ];
    for (name, unit, low, high) in limits {
        let mut columns = vec![("TIME", "s", ["0", "1", "2"]), (name, unit, [low, low, high])];
        columns.extend(
            others
                .iter()
                .filter(|(other, ..)| *other != name)
                .map(|(other, unit, value)| (*other, *unit, [*value; 3])),
        );
        let names: Vec<_> = columns.iter().map(|column| column.0).collect();
        let units: Vec<_> = columns.iter().map(|column| column.1).collect();
        let rows = [0, 1, 2]
            .map(|row| columns.iter().map(|column| column.2[row]).collect::<Vec<_>>().join(" "));
        let rows = rows.each_ref().map(String::as_str);
        let text = report_of("", &names.join(" "), &units.join(" "), rows);
        if let Err(refusal) = Reader::new().read(text.as_bytes()) {
            panic!("{name} {unit}: {refusal}");
        }
    }
}

#[test]
fn total_fuel_flow_of_several_engines() {
    let text = |names: &str, units: &str, values: &str, header: &str, flow: &str| {
        report_of(
            header,
            &format!("TIME ALT SAT MACH VTAS GSPD ROLL DRIFT{names} WF FU"),
            &format!("s m K - m/s m/s deg deg{units} lb/h kg"),
            ["0", "1", "2"]
                .map(|time| format!("{time} 11000 216 0.78 230 230 0 0{values} {flow} 0"))
                .each_ref()
                .map(String::as_str),
        )
    };
    let code =
        |text: String| Reader::new().read(text.as_bytes()).map_err(|refusal| refusal.kind.code());
    // Two engines by their rotor speeds: up to 200 000 lb/h. None known: up to that of four.
    assert!(code(text(" N2(1) N2(2)", " % %", " 90 90", "", "200000")).is_ok());
    assert_eq!(code(text(" N2(1) N2(2)", " % %", " 90 90", "", "200001")), Err("out-of-range"));
    assert!(code(text("", "", "", "MISSING N2\n", "400000")).is_ok());
    assert_eq!(code(text("", "", "", "MISSING N2\n", "400001")), Err("out-of-range"));
}

#[test]
fn simulated_reports_of_another_program() {
    let Some(folder) = outside_data("data/jsbsim-global5000") else { return };
    let mut reader = Reader::new();
    let mut count = 0;
    for tail in ["SIM-01", "SIM-02", "SIM-05"] {
        for file in std::fs::read_dir(folder.join(tail)).unwrap() {
            let path = file.unwrap().path();
            let bytes = std::fs::read(&path).unwrap();
            let parsed =
                reader.read(&bytes).unwrap_or_else(|refusal| panic!("{path:?}: {refusal}"));
            let rows = memchr::memchr_iter(b'\n', &bytes).count() - 10;
            assert_eq!(parsed.report.len(), rows, "{path:?}");
            assert_eq!(parsed.report.header().identity.tail, tail);
            assert!(parsed.findings.is_empty(), "{path:?}: {:?}", parsed.findings);
            count += 1;
        }
    }
    assert_eq!(count, 120);
}

proptest::proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in proptest::collection::vec(proptest::num::u8::ANY, 0..400)) {
        let _ = Reader::new().read(&bytes);
        let with_magic: Vec<u8> = [0x1f, 0x8b].into_iter().chain(bytes).collect();
        let _ = Reader::new().read(&with_magic);
    }

    /// Near-reports reach every stage of the reader: the sample with a few bytes replaced, and cut somewhere.
    #[test]
    fn damaged_reports_never_panic(
        damage in proptest::collection::vec((0..SAMPLE.len(), "[ -~\t\r\n§#]"), 0..6),
        end in 0..SAMPLE.len() + 1,
    ) {
        let mut text: Vec<String> = SAMPLE.chars().map(String::from).collect();
        for (at, character) in damage {
            text[at] = character;
        }
        let text = text[..end].concat();
        if let Err(refusal) = Reader::new().read(text.as_bytes()) {
            proptest::prop_assert!(refusal.line >= 1 && refusal.column >= 1);
            proptest::prop_assert!(!refusal.to_string().is_empty());
        }
    }
}
