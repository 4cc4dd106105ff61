//! Recordings of other layouts.

#![expect(
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test fails by panicking, in its helpers too"
)]
#![expect(clippy::float_cmp, reason = "whole numbers are exact")]

use flight::column::Column;
use std::io::Write;

use flight::{Assumption, FuelFlowColumns, MissingColumn};
use report::{Mapping, Parsed, Reader, TextLayout, write};

/// A recording that shows most of what a mapping can express: semicolons, comments, quotes, several flights, gaps.
const RECORDING: &str = "\
# made up
type;reg;flt;utc;alt;cas;gs;ff1;ff2;gw;trk;hdg;n2a;n2b;tat;cg
A320;D-ABCD;\"LH;1\";2024-03-01 10:00:00;37000;250;450;1200;1210;65000;359;2;88;88.5;-22;27.5
A320;D-ABCD;\"LH;1\";2024-03-01 10:00:01;37010;250;450;1200;1210;64991;359;2;88;88.5;-22;n/a
A320;D-ABCD;\"LH;1\";2024-03-01 10:00:02;37000;250;450;1200;1210;;359;2;88;88.5;-22;27.5

A320;D-ABCD;\"LH;1\";2024-03-01 10:00:03;37000;250;450;1200;1210;65000;359;2;88;88.5;-22;27.5
A320;D-ABCD;LH 2;2024-03-01 14:00:00+02:00;37000;250;450;1.2E3;1210;60000;10;9;88;88.5;-22;27.5
A320;D-ABCD;LH 2;2024-03-01 14:00:01+02:00;37000;250;450;1200;1210;59995;10;9;88;88.5;-22;27.5
A320;D-ABCD;LH 2;2024-03-01 14:00:02+02:00;37000;250;450;1200;1210;59990;10;9;88;88.5;-22;27.5
";

const MAPPING: &str = r#"(
    format: 1,
    separator: ';',
    comment: '#',
    not_available: ["n/a"],
    aircraft: Column("type"),
    tail: Column("reg"),
    flight: Column("flt"),
    lower_heating_value_mj_kg: 43.1,
    notes: [("SOURCE", "made up")],
    time: Timestamp(column: "utc", utc_offset: "Z"),
    quantities: {
        "ALT": Recorded(column: "alt", unit: "ft"),
        "SAT": FromTotalTemperature(recovery_factor: 1.0),
        "TAT": Recorded(column: "tat", unit: "degC"),
        "MACH": FromCalibratedAirspeed(column: "cas", unit: "kt"),
        "VTAS": FromMach,
        "GSPD": Recorded(column: "gs", unit: "kt"),
        "DRIFT": Difference(column: "trk", minus: "hdg", unit: "deg"),
        "N2(1)": Recorded(column: "n2a", unit: "%"),
        "N2(2)": Recorded(column: "n2b", unit: "%"),
        "WF(1)": Recorded(column: "ff1", unit: "kg/h"),
        "WF(2)": Recorded(column: "ff2", unit: "kg/h", scale: 1.1),
        "CG": Recorded(column: "cg", unit: "%MAC"),
    },
    mass: GrossMass(column: "gw", unit: "kg", zero_fuel_weight: (52000, "kg"), largest_rise_kg: 10),
)"#;

fn mapping(text: &str) -> Mapping {
    Mapping::from_ron(text).unwrap_or_else(|error| panic!("{error:?}"))
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected}");
}

fn codes(parsed: &Parsed) -> Vec<&'static str> {
    parsed.findings.iter().map(|finding| finding.code).collect()
}

#[test]
fn two_flights_in_one_file() {
    let reports = mapping(MAPPING).read(RECORDING.as_bytes()).unwrap();
    assert_eq!(reports.len(), 2);
    let report = &reports[0].report;
    let (header, columns) = (report.header(), report.columns());
    assert_eq!(header.aircraft_type, "A320");
    assert_eq!(header.identity.tail, "D-ABCD");
    assert_eq!(header.identity.flight, "LH;1");
    assert_eq!(header.identity.start, "2024-03-01T10:00:00Z".parse().unwrap());
    assert_eq!(header.lower_heating_value_mj_kg, Some(43.1));
    assert_eq!(header.missing, [MissingColumn::Roll]);
    assert!(header.assumed.is_empty());
    assert_eq!(header.notes[0], ("SOURCE".to_owned(), "made up".to_owned()));
    let derived = "MACH from CAS and ALT, SAT from TAT and MACH, VTAS from MACH and SAT, DRIFT from track and heading, \
                   FU from the fall of gross mass";
    assert_eq!(header.notes[1], ("DERIVED".to_owned(), derived.to_owned()));
    // The row without mass is left out; the center of gravity is optional.
    assert_eq!(columns.time_s, [0.0, 1.0, 3.0]);
    let center_of_gravity = columns.optional.get(Column::CenterOfGravity).unwrap();
    assert_eq!(*center_of_gravity, [Some(27.5), None, Some(27.5)]);
    // 359° − 2° = 357°, which is −3°.
    assert_eq!(*columns.drift_deg.as_ref().unwrap(), [-3.0; 3]);
    let FuelFlowColumns::PerEngine(flows) = &columns.fuel_flow else { panic!("by engine") };
    close(flows[0][0], 1200.0 / 3600.0, 1e-12);
    close(flows[1][0], 1210.0 * 1.1 / 3600.0, 1e-12);
    // The mass falls by 9 kg and rises again: fuel used stays.
    assert_eq!(columns.fuel_used_kg, [0.0, 9.0, 9.0]);
    assert_eq!(header.zero_fuel_mass.to_kilograms(), 52_000.0);
    assert_eq!(header.fuel_on_board.to_kilograms(), 13_000.0);
    assert_eq!(codes(&reports[0]), ["mapped-derived", "mapped-fuel-used", "mapped-rows-left-out"]);
    // A mass that never rises has no rise to be told of.
    let fuel_used = reports[0].findings.iter().find(|one| one.code == "mapped-fuel-used").unwrap();
    assert!(!fuel_used.message.contains(" 0.0 kg"), "{}", fuel_used.message);
    assert_eq!(reports[0].findings[0].line, Some(3));
    assert_eq!(reports[0].findings[2].line, Some(5));

    let second = &reports[1].report;
    assert_eq!(second.header().identity.flight, "LH 2");
    assert_eq!(second.header().identity.start, "2024-03-01T12:00:00Z".parse().unwrap());
    assert_eq!(second.columns().fuel_used_kg, [0.0, 5.0, 10.0]);
    assert_eq!(reports[1].findings[0].line, Some(8));
}

/// Written out by hand from the compressible-flow formulas (CAS 250 kt at 37 000 ft in the ISA):
/// `M = √(5((qc/p + 1)^(2/7) − 1))`, `qc = p0((1 + 0.2 (CAS/a0)²)^3.5 − 1)` gives 0.773 056;
/// `SAT = TAT/(1 + 0.2 M²)` and `TAS = M √(γ R SAT)` follow.
#[test]
fn derived_quantities() {
    let reports = mapping(MAPPING).read(RECORDING.as_bytes()).unwrap();
    let columns = reports[0].report.columns();
    let mach = 0.773_056_325_455_373_4_f64;
    close(columns.mach[0], mach, 1e-9);
    let temperature_k = 251.15 / (1.0 + 0.2 * mach * mach);
    close(columns.static_air_temperature_k.as_ref().unwrap()[0], temperature_k, 1e-6);
    let speed = mach * (1.4 * 287.05287 * temperature_k).sqrt();
    close(columns.true_airspeed_m_s[0], speed, 1e-6);
}

#[test]
fn written_reports_read_back() {
    let read = mapping(MAPPING).read(RECORDING.as_bytes()).unwrap();
    assert_eq!(read.len(), 2);
    for parsed in read {
        let text = write(&parsed.report, &TextLayout::exact(), &[]).unwrap();
        assert_eq!(Reader::new().read(text.as_bytes()).unwrap().report, parsed.report);
    }
}

#[test]
fn gzip_and_file_names() {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(RECORDING.as_bytes()).unwrap();
    let packed = encoder.finish().unwrap();
    let plain = mapping(MAPPING).read(RECORDING.as_bytes()).unwrap();
    assert_eq!(mapping(MAPPING).read(&packed).unwrap(), plain);

    let by_name = mapping(&MAPPING.replace("Column(\"flt\")", "FileName"));
    // The two flights are read as one, and its time jumps by two hours.
    let reports = by_name.read_named(&packed, "flight 17").unwrap();
    assert_eq!(reports.len(), 1);
    assert_eq!(reports[0].report.header().identity.flight, "flight 17");
    assert_eq!(reports[0].report.columns().time_s[3], 7200.0);
    let refusal = by_name.read(&packed).unwrap_err();
    assert_eq!(refusal.to_string(), "line 3, column 1: found \"\", expected text for FLIGHT");
}

const FIRST_ROW: &str = "A320;D-ABCD;\"LH;1\";2024-03-01 10:00:00;37000;";
/// What is replaced in the recording, by what, the code of the refusal and how its text begins.
const REFUSED: &[(&str, &str, &str, &str)] = &[
    (
        "reg;flt",
        "reg;flight",
        "source-column-missing",
        "line 2, column 65: found the end of the line, expected a column named \"flt\"",
    ),
    (
        "tat;cg\n",
        "tat;cg;gw\n",
        "source-column-doubled",
        "line 2, column 63: found \"gw\", expected one column named \"gw\"",
    ),
    (
        "A320;D-ABCD;LH 2;",
        "A320;;LH 2;",
        "source-text-missing",
        "line 8, column 6: found \"\", expected text for TAIL",
    ),
    (
        "10:00:01;",
        "10.00.01;",
        "source-instant-malformed",
        "line 4, column 20: found \"2024-03-01 10.00.01\", expected an instant like 2018-05-20 14:14:21, with an offset or one in the mapping",
    ),
    (
        "10:00:01;",
        "10:00:00;",
        "time-not-increasing",
        "line 4, column 20: found \"2024-03-01 10:00:00\", expected TIME above that of the row before, 0 s",
    ),
    (
        "37010",
        "FL370",
        "source-not-a-number",
        "line 4, column 40: found \"FL370\", expected a number or nothing in \"alt\"",
    ),
    (
        "37010",
        "61000",
        "out-of-range",
        "line 4, column 40: found 18592.8 m, expected ALT of -2000 to 60000 ft (limit here 18288 m)",
    ),
    (
        "37000;250;450;1200;1210;65000;359;2;88;88.5;-22;27.5\nA320;D-ABCD;\"LH;1\";2024-03-01 10:00:01",
        "37000;20;450;1200;1210;65000;359;2;88;88.5;-22;27.5\nA320;D-ABCD;\"LH;1\";2024-03-01 10:00:01",
        "out-of-range",
        "line 3, column 46",
    ),
    (
        ";64991;",
        ";64989;",
        "gross-mass-rises",
        "line 7, column 64: found 65000 kg, expected gross mass no more than 10 kg above its smallest value so far, 64989 kg",
    ),
    (
        ";59990;",
        ";0;",
        "mass-not-positive",
        "line 10, column 68: found 0 kg, expected gross mass above zero",
    ),
    (
        ";59990;",
        ";51999;",
        "mass-not-positive",
        "line 8, column 69: found -1 kg, expected fuel on board above zero",
    ),
    (
        ";59990;10;9;",
        ";59990;120;9;",
        "out-of-range",
        "line 10, column 74: found 111 deg, expected DRIFT of -90 to 90 deg (limit here 90 deg)",
    ),
    (
        FIRST_ROW,
        "A320;D-ABCD;\"LH;1\";2024-03-01 10:00:00;",
        "too-few-fields",
        "line 3, column 86: found 15 fields, expected 16 fields, one per column",
    ),
    (
        FIRST_ROW,
        "x;A320;D-ABCD;\"LH;1\";2024-03-01 10:00:00;37000;",
        "too-many-fields",
        "line 3, column 90: found 17 fields, expected 16 fields, one per column",
    ),
    (
        ";27.5\nA320;D-ABCD;\"LH;1\";2024-03-01 10:00:01",
        ";150.1\nA320;D-ABCD;\"LH;1\";2024-03-01 10:00:01",
        "out-of-range",
        "line 3, column 88: found 150.1 %MAC, expected CG of -50 to 150 %MAC (limit here 150 %MAC)",
    ),
];

#[test]
fn recordings_that_are_refused() {
    let base = mapping(MAPPING);
    for (from, to, code, expected) in REFUSED.iter().copied() {
        assert!(RECORDING.contains(from), "{from}");
        let refusal = base.read(RECORDING.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert_eq!(refusal.kind.code(), code, "{refusal}");
        assert!(refusal.to_string().starts_with(expected), "{refusal}\n{expected}");
    }
}

#[test]
fn recordings_without_rows_are_refused() {
    let base = mapping(MAPPING);
    let only_names: String = RECORDING.split_inclusive('\n').take(2).collect();
    let refusal = base.read(only_names.as_bytes()).unwrap_err();
    assert_eq!(refusal.to_string(), "line 2, column 62: found 0 rows, expected at least 3 rows");
    let refusal = base.read(b"").unwrap_err();
    assert_eq!(
        refusal.to_string(),
        "line 1, column 1: found the end of the text, expected a line of column names"
    );
    let refusal = base.read(&[0x1f, 0x8b, 8]).unwrap_err();
    assert_eq!(refusal.kind.code(), "gzip-truncated");
}

#[test]
fn mappings_that_are_refused() {
    for (from, to, expected) in [
        ("format: 1", "format: 2", "mapping file of format 2, expected format 1"),
        (
            "\"CG\"",
            "\"CoG\"",
            "quantity \"CoG\", expected one of TIME ALT SAT MACH VTAS GSPD ROLL DRIFT N2(k) WF(k) WF FU LAT LON HDG CG TAT N1(k) EGT(k) FQ A/I, without TIME and FU",
        ),
        ("\"CG\"", "\"FU\"", "quantity \"FU\", expected one of TIME"),
        ("\"GSPD\"", "\"FQ\"", "unit \"kt\" for FQ, expected one of lb kg"),
        ("\"GSPD\": Recorded(column: \"gs\", unit: \"kt\"),", "", "no source for GSPD"),
        ("\"VTAS\": FromMach,", "", "no source for VTAS"),
        (
            "\"VTAS\": FromMach",
            "\"VTAS\": FromTrueAirspeed",
            "VTAS cannot be derived by FromTrueAirspeed",
        ),
        (
            "FromCalibratedAirspeed(column: \"cas\", unit: \"kt\")",
            "FromTrueAirspeed",
            "MACH, SAT and VTAS are derived from each other",
        ),
        ("\"TAT\": Recorded(column: \"tat\", unit: \"degC\"),", "", "no source for TAT"),
        ("\"WF(2)\"", "\"WF\"", "WF both of all engines and engine by engine"),
        ("\"N2(2)\"", "\"N2(3)\"", "no source for N2(2)"),
        ("\"N2(2)\"", "\"N1(2)\"", "no source for N2(2)"),
        (
            "unit: \"kg/h\")",
            "unit: \"kg/min\")",
            "unit \"kg/min\" for WF(1), expected one of lb/h kg/h kg/s",
        ),
        (
            "utc_offset: \"Z\"",
            "utc_offset: \"UTC\"",
            "\"UTC\" is not an instant or offset of RFC 3339",
        ),
        ("separator: ';'", "separator: '§'", "'§' cannot separate fields or begin comments"),
        ("separator: ';'", "separator: '5'", "'5' cannot separate fields or begin comments"),
        (
            "recovery_factor: 1.0",
            "recovery_factor: 1.1",
            "recovery factor 1.1 - outside 0.5 to 1 -",
        ),
        ("52000", "-52000", "zero-fuel mass -52000 kg outside"),
        ("tail:", "tall:", "line 7, column 5"),
        ("\"CG\"", "\"ALT\"", "line 24, column"),
    ] {
        assert!(MAPPING.contains(from), "{from}");
        let error = Mapping::from_ron(&MAPPING.replacen(from, to, 1)).unwrap_err();
        assert!(error.to_string().starts_with(expected), "{error}\n{expected}");
    }
}

#[test]
fn level_parts_of_a_flight_become_one_report() {
    let text = MAPPING.replace("largest_rise_kg: 10),", "largest_rise_kg: 10),\n cruise: (minimum_pressure_altitude_ft: 36000, band_ft: 50, minimum_duration_s: 100, trim_s: 10),");
    let mut recording = RECORDING.split_inclusive('\n').take(2).collect::<String>();
    // 36 000 ft for 150 s, a step climb of 100 s, 38 000 ft for 200 s.
    for second in 0..450_u32 {
        let altitude_ft = match second {
            0..150 => 36_000,
            150..250 => 36_000 + 20 * (second - 150),
            _ => 38_000,
        };
        let row = format!(
            "A320;D-ABCD;LH 3;2024-03-01 11:{:02}:{:02};{altitude_ft};250;450;1200;1210;{};10;9;88;88;-22;27\n",
            second / 60,
            second % 60,
            65_000 - second
        );
        recording.push_str(&row);
    }
    let reports = mapping(&text).read(recording.as_bytes()).unwrap();
    // The first part ends where the climb has made 40 ft: 36 000 ft at 0 s to 36 040 ft at 152 s. Trimmed: 10 s to
    // 142 s. The second begins within 50 ft of its end: 37 960 ft at 248 s, to 449 s; trimmed 258 s to 439 s.
    // Both are one flight: an error of its load sheet or of its sensors is the same in both.
    assert_eq!(reports.len(), 1);
    let report = &reports[0].report;
    let time_s = &report.columns().time_s;
    assert_eq!(report.header().identity.start.to_string(), "2024-03-01T11:00:10Z");
    assert_eq!((time_s[132], time_s[133], time_s[time_s.len() - 1]), (132.0, 248.0, 429.0));
    assert!(codes(&reports[0]).contains(&"mapped-cruise-cut"));
    assert_eq!(report.columns().fuel_used_kg[133], 248.0);

    let refusal = mapping(&text.replace("minimum_duration_s: 100", "minimum_duration_s: 300"))
        .read(recording.as_bytes())
        .unwrap_err();
    assert_eq!(
        refusal.to_string(),
        "line 452, column 85: found 201 s of level flight, expected a level part of at least 320 s, as the mapping's cruise requires"
    );
}

/// One of the recordings that are not part of this repository.
fn outside(name: &str) -> Option<Vec<u8>> {
    let path = test_support::outside_data(&format!("data/real/{name}"))?;
    #[expect(clippy::disallowed_methods, reason = "tests read data from files")]
    let bytes = std::fs::read(path).unwrap();
    Some(bytes)
}

/// Oracle: the recording's own description of its cruise: one level part of 8604 s at FL360, Mach number 0.750 to
/// 0.780, mass 67.2 t to 61.3 t.
#[test]
fn an_a320_flight_data_recording() {
    let Some(bytes) = outside("traffic_fuelflow_a320/fuelflow_a320.csv.gz") else { return };
    let reports = Mapping::preset("traffic-a320").unwrap().read(&bytes).unwrap();
    assert_eq!(reports.len(), 1);
    let report = &reports[0].report;
    let columns = report.columns();
    assert_eq!(columns.time_s[report.len() - 1], 8604.0);
    for value in &columns.pressure_altitude_m {
        close(*value, 36_000.0 * 0.3048, 120.0 * 0.3048);
    }
    let mean_mach = columns.mach.iter().sum::<f64>() / report.len() as f64;
    assert!((0.75..0.78).contains(&mean_mach), "{mean_mach}");
    let header = report.header();
    let ramp_kg = header.zero_fuel_mass.to_kilograms() + header.fuel_on_board.to_kilograms();
    close(ramp_kg, 67_200.0, 50.0);
    close(ramp_kg - columns.fuel_used_kg[report.len() - 1], 61_300.0, 60.0);
    assert_eq!(header.missing, [MissingColumn::StaticAirTemperature, MissingColumn::N2]);
    assert_eq!(header.assumed, [Assumption::StaticAirTemperatureIsa { isa_deviation_k: 0.0 }]);
    let text = write(report, &TextLayout::industry(), &[]).unwrap();
    assert_eq!(Reader::new().read(text.as_bytes()).unwrap().report.len(), report.len());
}

/// Oracle: the recording's description: 4388 s at FL330, TAS 470.9 ± 0.7 kt, mass falls by 2731 kg/h; its fuel flow
/// is that of one engine of two.
#[test]
fn an_a320_quick_access_recording() {
    let Some(bytes) = outside("acropole_a320_qar/flight_a320_qar.csv.gz") else { return };
    let mapping = mapping(
        r#"(
            format: 1,
            aircraft: Column("FLPL_AIRC_TYPE"), tail: Text("A320-QAR"), flight: Column("SYST_TRAJ_ID"),
            time: Timestamp(column: "PLOT_DATE", utc_offset: "Z"),
            quantities: {
                "ALT": Recorded(column: "ALTI_STD_FT", unit: "ft"),
                "SAT": Isa(deviation_k: 0),
                "MACH": FromTrueAirspeed,
                "VTAS": Recorded(column: "TRUE_AIR_SPD_KT", unit: "kt"),
                "GSPD": Recorded(column: "GRND_SPD_KT", unit: "kt"),
                "WF": Recorded(column: "FUEL_FLOW_KGH", unit: "kg/h", scale: 2),
            },
            mass: GrossMass(column: "MASS_KG", unit: "kg", largest_rise_kg: 50),
            cruise: (minimum_pressure_altitude_ft: 30000, band_ft: 100, minimum_duration_s: 900, trim_s: 30),
        )"#,
    );
    let reports = mapping.read(&bytes).unwrap();
    assert_eq!(reports.len(), 1);
    let report = &reports[0].report;
    let columns = report.columns();
    close(columns.time_s[report.len() - 1], 4388.0, 20.0);
    let mean_knots =
        columns.true_airspeed_m_s.iter().sum::<f64>() / report.len() as f64 * 3600.0 / 1852.0;
    close(mean_knots, 470.9, 0.7);
    let hours = columns.time_s[report.len() - 1] / 3600.0;
    close(columns.fuel_used_kg[report.len() - 1] / hours, 2731.0, 60.0);
    assert_eq!(report.header().missing, MissingColumn::ALL);
}

/// Oracle: the recordings' description: one level part of 11 to 17 min per flight; TAS = M a(SAT) to 1e-4.
#[test]
fn citation_flights_with_every_parameter() {
    let mapping = mapping(
        r#"(
            format: 1,
            aircraft: Text("C550"), tail: Text("PH-LAB"), flight: FileName,
            time: Seconds(column: "ts", start: "2017-03-20T00:00:00Z"),
            quantities: {
                "ALT": Recorded(column: "alt", unit: "ft"),
                "SAT": Recorded(column: "sat", unit: "degC"),
                "MACH": Recorded(column: "mach", unit: "-"),
                "VTAS": Recorded(column: "tas", unit: "kt"),
                "GSPD": Recorded(column: "gs", unit: "kt"),
                "ROLL": Recorded(column: "roll", unit: "deg"),
                "DRIFT": Difference(column: "trk", minus: "hdg", unit: "deg"),
                "N2(1)": Recorded(column: "n2_l", unit: "%"),
                "N2(2)": Recorded(column: "n2_r", unit: "%"),
                "WF(1)": Recorded(column: "ff_l", unit: "kg/s"),
                "WF(2)": Recorded(column: "ff_r", unit: "kg/s"),
                "N1(1)": Recorded(column: "n1_l", unit: "%"),
                "N1(2)": Recorded(column: "n1_r", unit: "%"),
                "LAT": Recorded(column: "lat", unit: "deg"),
                "LON": Recorded(column: "lon", unit: "deg"),
                "HDG": Recorded(column: "hdg", unit: "deg"),
            },
            mass: GrossMass(column: "mass", unit: "kg", largest_rise_kg: 1),
            out_of_range: LeaveRowOut,
            cruise: (minimum_pressure_altitude_ft: 8000, band_ft: 200, minimum_duration_s: 600, trim_s: 30),
        )"#,
    );
    for hour in ["08", "10", "12", "14"] {
        let name = format!("phlab_20170320_{hour}");
        let Some(bytes) = outside(&format!("phlab_c550_openap/{name}.csv.gz")) else { return };
        let reports = mapping.read_named(&bytes, &name).unwrap();
        assert_eq!(reports.len(), 1, "{name}");
        let report = &reports[0].report;
        let columns = report.columns();
        assert_eq!(report.header().identity.flight, name);
        assert!(report.header().missing.is_empty());
        assert!((600.0..17.5 * 60.0).contains(&columns.time_s[report.len() - 1]), "{name}");
        let temperatures = columns.static_air_temperature_k.as_ref().unwrap();
        for ((mach, speed), temperature_k) in
            columns.mach.iter().zip(&columns.true_airspeed_m_s).zip(temperatures)
        {
            // The description says 1e-4 on the whole; a recorded digit of either is up to 3e-3 here.
            let derived = mach * (1.4 * 287.05287 * temperature_k).sqrt();
            close(derived / speed, 1.0, 5e-3);
        }
        let drift_deg = columns.drift_deg.as_ref().unwrap();
        // The recording averages angles across ±180°, which spoils single samples.
        let spoilt = drift_deg.iter().filter(|angle| angle.abs() > 45.0).count();
        assert!(spoilt < 5, "{name}: {spoilt}");
    }
}

proptest::proptest! {
    #[test]
    fn damaged_recordings_never_panic(
        damage in proptest::collection::vec((0..RECORDING.len(), "[ -~\t\r\n§]"), 0..8),
        end in 0..RECORDING.len() + 1,
    ) {
        let mut text: Vec<String> = RECORDING.chars().map(String::from).collect();
        for (at, character) in damage {
            text[at] = character;
        }
        let cruise = "cruise: (minimum_pressure_altitude_ft: 1, band_ft: 9, minimum_duration_s: 0, trim_s: 0)";
        let with_cruise = MAPPING.replace("largest_rise_kg: 10),", &format!("largest_rise_kg: 10), {cruise}"));
        for mapping_text in [MAPPING, &with_cruise] {
            if let Err(refusal) = mapping(mapping_text).read(text[..end].concat().as_bytes()) {
                proptest::prop_assert!(refusal.line >= 1 && refusal.column >= 1);
            }
        }
    }
}
