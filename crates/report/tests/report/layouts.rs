//! Fourteen invented but typical layouts: the first mapping reads each as it is. They were at hand while it was written.
//!
//! `fixtures/layouts/make_layouts.py` writes the recordings.

use std::path::Path;

use report::Mapping;
use report::mapping::first_mapping;

const LAYOUTS: [&str; 14] = [
    "01_named_units.csv",
    "02_sparse_qar.csv",
    "03_european.csv",
    "04_units_row.csv",
    "05_split_date.tsv",
    "06_time_of_day.csv",
    "07_epoch_ms.csv",
    "08_analyser.csv",
    "09_load_sheet.csv",
    "10_discretes.csv",
    "11_unicode_text.txt",
    "12_bad_rows.csv",
    "15_titles.csv",
    "16_spreadsheet.csv",
];

#[test]
fn every_layout_is_read_with_its_first_mapping() {
    let mut failed = Vec::new();
    for name in LAYOUTS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/layouts").join(name);
        #[expect(clippy::disallowed_methods, reason = "tests read data from files")]
        let bytes = std::fs::read(path).unwrap();
        // The date and the mass are what a person has to state.
        let text = first_mapping(&bytes).unwrap().replace("YYYY-MM-DD", "2024-03-01");
        let text = text.replace("Column(\"ZERO FUEL WEIGHT\", \"kg\")", "Value(10000, \"kg\")");
        let read =
            Mapping::from_ron(&text).map_err(|error| error.to_string()).and_then(|mapping| {
                mapping.read_named(&bytes, name).map_err(|error| error.to_string())
            });
        match read {
            Ok(reports) => {
                let columns = reports[0].report.columns();
                let last = columns.time_s.len() - 1;
                let mach = columns.mach[last];
                let duration_s = columns.time_s[last];
                // As made: half an hour at Mach 0.78, 2400 kg/h; mapped cruise is trimmed by a minute at either end.
                let flow_kg_h = 3600.0 * columns.fuel_flow.total_kg_s(last);
                let is_as_made = (mach - 0.78).abs() < 0.003
                    && duration_s > 1500.0
                    && (flow_kg_h - 2400.0).abs() < 30.0;
                if !is_as_made {
                    failed.push(format!(
                        "{name}: Mach {mach}, {duration_s} s, {flow_kg_h} kg/h\n{text}"
                    ));
                }
            }
            Err(error) => failed.push(format!("{name}: {error}\n{text}")),
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

/// Registrations and flights by other names, and what is said where no column names flights.
#[test]
fn flights_and_tails_are_found_by_usual_names() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/layouts");
    #[expect(clippy::disallowed_methods, reason = "tests read data from files")]
    let text = std::fs::read_to_string(path.join("01_named_units.csv")).unwrap();
    let text = text.replace("registration", "AC_REG");
    let with = |names: &str, values: &str| {
        let mut lines = text.lines();
        let head = format!("{names}{}", lines.next().unwrap());
        let rows = lines.map(|line| format!("{values}{line}"));
        let all: Vec<String> = core::iter::once(head).chain(rows).collect();
        first_mapping(all.join("\n").as_bytes()).unwrap()
    };
    let named = with("FLT_ID,", "17,");
    assert!(named.contains("tail: Column(\"AC_REG\")"), "{named}");
    assert!(named.contains("flight: Column(\"FLT_ID\")"), "{named}");
    let unnamed = with("leg,", "17,");
    assert!(unnamed.contains("flight: FileName,   // ? one flight"), "{unnamed}");
}

/// Units in brackets, parentheses and behind underscores, and engines named by the hand: each by itself.
#[test]
fn units_are_found_behind_usual_names() {
    let of = |name: &str, value: &str| {
        let names = format!("utc,gs_kt,gw_kg,{name}");
        let row = format!("2024-03-01T10:00:00Z,470,64000,{value}");
        first_mapping(format!("{names}\n{row}\n").as_bytes()).unwrap()
    };
    for (name, value, quantity, unit) in [
        ("TAS [m/s]", "230", "VTAS", "m/s"),
        ("TAS (m/s)", "230", "VTAS", "m/s"),
        ("TAS_m_s", "230", "VTAS", "m/s"),
        ("ALT [m]", "11000", "ALT", "m"),
        ("Pressure Altitude [m]", "11000", "ALT", "m"),
        ("Press Alt [m]", "11000", "ALT", "m"),
        ("OAT (F)", "-60", "SAT", "degF"),
        ("FF LH [pph]", "900", "WF(1)", "lb/h"),
        ("FF LH [lb/hr]", "900", "WF(1)", "lb/h"),
        ("N2 LH", "87", "N2(1)", "%"),
    ] {
        let expected = format!("{quantity:?}: Recorded(column: {name:?}, unit: {unit:?}),\n");
        let mapping = of(name, value);
        assert!(mapping.contains(&expected), "{expected} is not in {mapping}");
    }
    // Milliseconds and minutes are no speed and no length.
    assert!(!of("TAS ms", "230").contains("VTAS\": Recorded"));
    assert!(of("time_m", "10").contains("\"time_m\" (10)"));
}

/// Where the standard atmosphere's temperature is written, a column that may hold the real one is named at that line.
#[test]
fn a_temperature_under_an_unknown_name_is_pointed_at() {
    let of = |name: &str| {
        let text = format!(
            "utc,alt_ft,mach,gs_kt,gw_kg,{name}\n2024-03-01T10:00:00Z,35000,0.78,470,64000,-54\n"
        );
        let mapping = first_mapping(text.as_bytes()).unwrap();
        mapping.lines().find(|line| line.contains("\"SAT\"")).unwrap().to_owned()
    };
    let line = of("amb temp");
    assert!(line.contains("Isa(deviation_k: 0.0),   // ? no column is known for it"), "{line}");
    assert!(line.contains("\"amb temp\" may hold it"), "{line}");
    assert!(of("oil temp").ends_with("// ?"), "{}", of("oil temp"));
}

/// Names of our own tables are known too, and the drift angle is found from track and heading.
#[test]
fn time_in_seconds_and_a_drift_from_track_and_heading() {
    let text = "time_s,pressure_altitude_ft,mach,ground_speed_kt,fuel_flow_kg_h,true_track,true_heading\n\
                0,37000,0.78,450,2400,92,90\n60,37000,0.78,450,2400,92,90\n";
    let mapping = first_mapping(text.as_bytes()).unwrap();
    assert!(mapping.contains("time: Seconds(column: \"time_s\""), "{mapping}");
    let drift =
        "\"DRIFT\": Difference(column: \"true_track\", minus: \"true_heading\", unit: \"deg\")";
    assert!(mapping.contains(drift), "{mapping}");
}

/// A computed fuel on board would bear out the meters that it was computed from.
#[test]
fn gauges_are_known_by_names_that_nothing_computed_has() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/layouts");
    #[expect(clippy::disallowed_methods, reason = "tests read data from files")]
    let text = std::fs::read_to_string(path.join("10_discretes.csv")).unwrap();
    let gauges = first_mapping(text.as_bytes()).unwrap();
    assert!(
        gauges.contains("\"FQ\": Recorded(column: \"fuel_qty_kg\", unit: \"kg\"),"),
        "{gauges}"
    );
    let computed = first_mapping(text.replace("fuel_qty_kg", "fob_kg").as_bytes()).unwrap();
    assert!(!computed.contains("\"FQ\"") && computed.contains("fob_kg"), "{computed}");
    // Every name of gauges serves for the mass too.
    for name in ["fuel_quantity_kg", "total_fuel_qty_kg", "fuel_qty_total_kg", "FQ"] {
        let mapping = first_mapping(text.replace("fuel_qty_kg", name).as_bytes()).unwrap();
        assert!(mapping.contains(&format!("\"FQ\": Recorded(column: \"{name}\"")), "{mapping}");
        assert!(mapping.contains(&format!("tanks: [\"{name}\"]")), "{mapping}");
    }
}

/// The first mapping of a recording is the same in every encoding that a recording is read in.
#[test]
fn a_first_mapping_does_not_depend_on_the_encoding() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/layouts");
    #[expect(clippy::disallowed_methods, reason = "tests read data from files")]
    let text = std::fs::read_to_string(path.join("01_named_units.csv")).unwrap();
    let plain = first_mapping(text.as_bytes()).unwrap();
    let units = || core::iter::once(0xfeff).chain(text.encode_utf16());
    let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
    for bytes in [little, big] {
        assert_eq!(first_mapping(&bytes).unwrap(), plain);
    }
}

/// Cruise points: a few rows for each flight, half an hour apart, and flights of one row.
#[test]
fn rows_far_apart_are_taken_for_averaged_points() {
    let names = "utc,registration,flight,altitude_ft,groundspeed_kt,tas_kt,mach,sat_degc,fuel_flow_kg_h,gw_kg";
    let row = |day: usize, hour: usize, minute: usize| {
        format!(
            "2024-03-{day:02}T{hour:02}:{minute:02}:00Z,F-AAAA,X{day},35000,450,449.5,0.78,-54.4,2400,{}",
            64_000 - 2400 * hour
        )
    };
    let several: Vec<String> =
        (1..4).flat_map(|day| [(10, 0), (10, 30), (11, 10)].map(|(h, m)| row(day, h, m))).collect();
    let single: Vec<String> = (1..5).map(|day| row(day, 12, 0)).collect();
    // Of many rows a step is far less than the time since the first one.
    let many: Vec<String> = (0..9).map(|k| row(1, 10 + k / 2, 30 * (k % 2))).collect();
    for rows in [several, single, many] {
        let text = format!("{names}\n{}\n", rows.join("\n"));
        let mapping = first_mapping(text.as_bytes()).unwrap();
        assert!(mapping.contains("rows: AveragedPoints(averaged_over_s: 60),   // ?"), "{mapping}");
        assert!(Mapping::from_ron(&mapping).is_ok(), "{mapping}");
        assert!(!mapping.contains("No column found"), "{mapping}");
    }
}

/// Units and times by how large the numbers are, where names say nothing; and what no column is found for.
#[test]
fn numbers_without_a_unit_are_taken_for_what_they_can_be() {
    let of = |time: &str, speed: &str| {
        let text =
            format!("t,tas,alt,mach,sat_degc,gw_kg\n{time},{speed},35000,0.78,-54.4,64000\n");
        first_mapping(text.as_bytes()).unwrap()
    };
    for (speed, unit) in [("449.5", "kt"), ("231.2", "m/s")] {
        let mapping = of("12", speed);
        let expected = format!("\"VTAS\": Recorded(column: \"tas\", unit: \"{unit}\"),   // ?");
        assert!(mapping.contains(&expected), "{mapping}");
        assert!(mapping.contains("// No column found for: GSPD, WF."), "{mapping}");
    }
    // 2024-03-01 in seconds since 1970 and in fractions of them.
    for (time, unit) in [
        ("1709287200", "s"),
        ("1709287200000", "ms"),
        ("1709287200000000", "us"),
        ("1709287200000000000", "ns"),
    ] {
        let mapping = of(time, "449.5");
        assert!(mapping.contains(&format!("Epoch(column: \"t\", unit: \"{unit}\"),")), "{mapping}");
    }
    assert!(of("43210", "449.5").contains("Seconds(column: \"t\""));
}

/// Temperatures by their middle, times by their looks, decimals by what has any.
#[test]
fn columns_are_known_by_their_values_where_names_leave_it_open() {
    let of =
        |names: &str, rows: &str| first_mapping(format!("{names}\n{rows}\n").as_bytes()).unwrap();
    for (values, unit) in [("218\n217\n999", "K"), ("-55\n-56\n999", "degC")] {
        let mapping = of("sat", values);
        assert!(
            mapping.contains(&format!("\"SAT\": Recorded(column: \"sat\", unit: \"{unit}\")")),
            "{mapping}"
        );
        assert!(!mapping.contains("decimal:"), "{mapping}");
    }
    let mapping = of("frame,label,zulu", "17,a:b:c,10:00:00");
    assert!(mapping.contains("TimeOfDay(column: \"zulu\""), "{mapping}");
}

/// Rows of three tails, 20 minutes apart within a flight, without the columns named.
fn points_without(left_out: &[&str]) -> String {
    let names = [
        "tail", "flight", "utc", "alt_ft", "mach", "tas_kt", "gs_kt", "sat_degc", "ff_kg_h",
        "gw_kg",
    ];
    let kept = |name: &&str| !left_out.contains(name);
    let mut text = names.iter().copied().filter(kept).collect::<Vec<_>>().join(",") + "\n";
    for tail in ["D-AAAA", "D-BBBB", "D-CCCC"] {
        for row in 0..12 {
            let (flight, minute) = (row / 3, 20 * (row % 3));
            let utc = format!("2024-01-{:02}T08:{minute:02}:00Z", 1 + flight);
            let cells = [
                tail.to_owned(),
                format!("{tail}{flight}"),
                if left_out.contains(&"clock") { utc[..10].to_owned() } else { utc },
                "35000".to_owned(),
                "0.78".to_owned(),
                format!("{}", 450 + row),
                format!("{}", 460 - row),
                "-56".to_owned(),
                format!("{}", 2400 - row),
                format!("{}", 65_000 - 800 * (row % 3)),
            ];
            let cells = names.iter().zip(cells).filter(|(name, _)| kept(name));
            text += &(cells.map(|(_, cell)| cell).collect::<Vec<_>>().join(",") + "\n");
        }
    }
    text
}

/// Averaged points are guessed as such, marked as a guess, even where the mapping needs something that no column has; samples
/// are not.
#[test]
fn rows_minutes_apart_are_guessed_as_points() {
    for left_out in [
        &[][..],
        &["flight"],
        &["gs_kt"],
        &["gw_kg"],
        &["alt_ft"],
        &["tail", "gs_kt"],
        &["clock"],
        &["utc", "gs_kt"],
    ] {
        let mapping = first_mapping(points_without(left_out).as_bytes()).unwrap();
        let rows = mapping.lines().find(|line| line.trim().starts_with("rows: AveragedPoints"));
        assert!(rows.is_some_and(|line| line.ends_with("// ?")), "{left_out:?}: {mapping}");
        assert!(!mapping.contains("cruise:") && !mapping.contains("StartMass"), "{left_out:?}");
        if !left_out.iter().any(|name| ["gs_kt", "alt_ft"].contains(name)) {
            Mapping::from_ron(&mapping).unwrap();
        }
    }
    for left_out in [&[][..], &["flight"], &["gs_kt"], &["alt_ft"], &["gw_kg"]] {
        let seconds =
            points_without(left_out).replace(":20:00Z", ":00:04Z").replace(":40:00Z", ":00:08Z");
        let mapping = first_mapping(seconds.as_bytes()).unwrap();
        assert!(!mapping.contains("AveragedPoints"), "{left_out:?}: {mapping}");
    }
}

/// Exports of spreadsheets: a blank row below the names, a clock of twelve hours, the aircraft's type under `Aircraft`.
#[test]
fn blank_rows_and_clocks_of_twelve_hours() {
    let recording = "Time UTC,Reg,Flight,Aircraft,ALT_STD,SAT,Mach,TAS,GS\n,,,,,,,,\n\
                     1/13/2018 9:29:00 AM,D-BBBB,0001,A320,28993,-39.5,0.7175,427.5,419.5\n\
                     1/13/2018 1:29:00 PM,D-BBBB,0001,A320,28993,-39.5,0.7175,427.5,419.5\n";
    let mapping = first_mapping(recording.as_bytes()).unwrap();
    for line in [
        "time: Timestamp(column: \"Time UTC\", format: \"%m/%d/%Y %I:%M:%S %p\"",
        "aircraft: Column(\"Aircraft\")",
    ] {
        assert!(mapping.contains(line), "{line} is not in\n{mapping}");
    }
}

/// What a spreadsheet or a print-out writes is found, and said to be a guess; the answer of each is its mapping's own reading above.
#[test]
fn titles_thousands_and_days_are_found() {
    let of = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/layouts").join(name);
        #[expect(clippy::disallowed_methods, reason = "tests read data from files")]
        let bytes = std::fs::read(path).unwrap();
        (first_mapping(&bytes).unwrap(), bytes)
    };
    let (titles, bytes) = of("15_titles.csv");
    assert!(titles.contains("    names_line: 4,   // ?\n"), "{titles}");
    assert!(titles.contains("GrossMass(column: \"GW(T)\", unit: \"t\""), "{titles}");
    // Places in the recording count its titles.
    let other =
        titles.replace("\"MACH\": Recorded(column: \"MACH\"", "\"MACH\": Recorded(column: \"M\"");
    let refusal = Mapping::from_ron(&other).unwrap().read_named(&bytes, "x").unwrap_err();
    assert_eq!(refusal.line, 4);
    let text = String::from_utf8(bytes).unwrap().replace(",2394\n", ",x\n");
    let strict = titles.replace("bad_rows: LeaveRowOut", "bad_rows: Refuse");
    let refusal = Mapping::from_ron(&strict).unwrap().read_named(text.as_bytes(), "x").unwrap_err();
    assert_eq!((refusal.line, refusal.column), (5, 59));
    let (days, bytes) = of("16_spreadsheet.csv");
    for entry in [
        "thousands: ',',   // ?",
        "time: Days(column: \"DateTime\", start: \"1899-12-30T00:00:00Z\"),   // ?",
        "\"ALT\": Recorded(column: \"FL\", unit: \"FL\"),   // ?",
        "\"SAT\": Recorded(column: \"SAT [degF]\", unit: \"degF\"),",
    ] {
        assert!(days.contains(entry), "{days}");
    }
    let reports = Mapping::from_ron(&days).unwrap().read_named(&bytes, "x").unwrap();
    let report = &reports[0].report;
    // As made: half past ten, trimmed by a minute, samples of ten seconds; 64 t less what was burnt.
    assert_eq!(report.header().identity.start.to_string(), "2024-03-01T10:01:00Z");
    assert!(
        report.columns().time_s.windows(2).all(|pair| (pair[1] - pair[0] - 10.0).abs() < 0.002)
    );
    assert!((report.columns().static_air_temperature_k.as_ref().unwrap()[0] - 218.8).abs() < 0.2);
}

/// A column in which nothing is recorded is no source: calibrated airspeed is not taken where it is empty, and a slow one is held.
#[test]
fn empty_columns_are_no_sources() {
    let of = |speed: &dyn Fn(usize) -> &'static str| {
        let rows = (0..40).map(|row| {
            format!("2024-03-01T10:{row:02}:00Z,35000,{},-54.4,470,2400,64000\n", speed(row))
        });
        let text =
            format!("utc,alt_ft,cas_kt,sat_degc,gs_kt,ff_kg_h,gw_kg\n{}", rows.collect::<String>());
        first_mapping(text.as_bytes()).unwrap()
    };
    let empty = of(&|_| "");
    assert!(empty.contains("\"MACH\": FromTrueAirspeed,"), "{empty}");
    let slow = of(&|row| if row % 4 == 0 { "265" } else { "" });
    let source = "FromCalibratedAirspeed(column: \"cas_kt\", unit: \"kt\", hold_s: 120),";
    assert!(slow.contains(source), "{slow}");
    Mapping::from_ron(&slow).unwrap();
}
