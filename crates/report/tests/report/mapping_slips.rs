//! What recorders write that is no value: drop-outs of fuel flow, spikes of gross mass, NaN; clocks with an offset or a midnight.

#![expect(clippy::panic, reason = "a test fails by panicking, in its helpers too")]

use std::fmt::Write;

use report::mapping::first_mapping;
use report::{Mapping, Parsed};

const NAMES: &str = "time,alt,sat,mach,tas,gs,ff1,ff2,gw";
const SECONDS: &str = "Seconds(column: \"time\", start: \"2024-03-01T10:00:00Z\")";
const START: &str = "StartMass(gross_weight: Value(10000, \"kg\"))";
const GROSS: &str = "GrossMass(column: \"gw\", unit: \"kg\", largest_rise_kg: 50)";

fn mapping(time: &str, mass: &str, entries: &str) -> Mapping {
    let text = format!(
        r#"(
        format: 1,
        aircraft: Text("C56X"), tail: Text("D-ABCD"), flight: Text("1"),
        time: {time},
        quantities: {{
            "ALT": Recorded(column: "alt", unit: "ft"),
            "SAT": Recorded(column: "sat", unit: "degC"),
            "MACH": Recorded(column: "mach", unit: "-"),
            "VTAS": Recorded(column: "tas", unit: "kt"),
            "GSPD": Recorded(column: "gs", unit: "kt"),
            "WF(1)": Recorded(column: "ff1", unit: "kg/h"),
            "WF(2)": Recorded(column: "ff2", unit: "kg/h"),
        }},
        mass: {mass},
        {entries}
    )"#
    );
    Mapping::from_ron(&text).unwrap_or_else(|error| panic!("{error}"))
}

fn read(mapping: &Mapping, text: &str) -> Parsed {
    match mapping.read(text.as_bytes()) {
        Ok(mut parsed) if parsed.len() == 1 => parsed.remove(0),
        Ok(parsed) => panic!("{} reports", parsed.len()),
        Err(refusal) => panic!("{refusal}"),
    }
}

fn refused(mapping: &Mapping, text: &str) -> String {
    match mapping.read(text.as_bytes()) {
        Ok(_) => panic!("it is accepted"),
        Err(refusal) => refusal.to_string(),
    }
}

pub(super) fn message<'p>(parsed: &'p Parsed, code: &str) -> &'p str {
    let finding = parsed.findings.iter().find(|finding| finding.code == code);
    finding.map_or("", |finding| finding.message.as_str())
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
}

/// Gross mass of a report's first row and fuel used until its last.
fn masses_kg(parsed: &Parsed) -> (f64, f64) {
    let header = parsed.report.header();
    let used_kg = &parsed.report.columns().fuel_used_kg;
    let on_board_kg = header.zero_fuel_mass + header.fuel_on_board;
    (
        on_board_kg.to_kilograms() - used_kg[0],
        used_kg.last().copied().unwrap_or(f64::NAN) - used_kg[0],
    )
}

/// A minute each: two on the ground, of which the engines run in the second, three of climb, four of cruise. The flows of one
/// engine, kg/h; the other one has the same unless it is stated.
fn climb_and_cruise(ones: [&str; 9], others: [&str; 9]) -> String {
    let mut text = format!("{NAMES}\n");
    for (minute, (one, other)) in ones.into_iter().zip(others).enumerate() {
        let (feet, knots) = match minute {
            0 | 1 => (500, 10),
            2..=4 => (10_000 * (minute - 1), 300),
            _ => (37_000, 450),
        };
        let seconds = 60 * minute;
        let _ = writeln!(
            text,
            "{seconds},{feet},-56.5,0.78,447,{knots},{one},{other},{}",
            9000 - minute
        );
    }
    text
}

const CRUISE: &str = "cruise: (minimum_pressure_altitude_ft: 36000, band_ft: 200, minimum_duration_s: 120, trim_s: 0), \
                      out_of_range: LeaveRowOut,";

/// Trapezoids by hand, a minute each, of each engine: 0 to 60, 60 to 600, 600 to 600 three times (kg/h) until cruise is entered:
/// 0.5 + 5.5 + 30 = 36 kg; two engines 72 kg. In cruise four rows of 600 kg/h: 3 minutes, 30 kg, of two engines 60 kg.
#[test]
fn a_drop_out_of_fuel_flow_is_bridged_where_mass_is_integrated() {
    let clean = ["0", "60", "600", "600", "600", "600", "600", "600", "600"];
    let with = |place: usize, drop_out| {
        let mut flows = clean;
        flows[place] = drop_out;
        flows
    };
    let cruise = mapping(SECONDS, START, CRUISE);
    for drop_out in ["600", "-9999", "0", "65535", "-0.5"] {
        let text = climb_and_cruise(with(3, drop_out), clean);
        let parsed = read(&cruise, &text);
        let (first_kg, used_kg) = masses_kg(&parsed);
        close(first_kg, 10_000.0 - 72.0);
        close(used_kg, 60.0);
        let said = message(&parsed, "mapped-flow-bridged");
        assert_eq!(said.starts_with("1 row with"), drop_out != "600", "{drop_out}: {said}");
        // In cruise the row is left out, and its fuel burnt all the same.
        let parsed = read(&cruise, &climb_and_cruise(with(6, drop_out), clean));
        close(masses_kg(&parsed).0, 10_000.0 - 72.0);
        close(masses_kg(&parsed).1, 60.0);
    }
}

/// By hand: an engine that is started a minute later burns nothing until then, 0.5 kg and 0.5 kg less.
#[test]
fn an_engine_burns_nothing_before_its_start() {
    let one = ["0", "60", "600", "600", "600", "600", "600", "600", "600"];
    let other = ["0", "0", "600", "600", "600", "600", "600", "600", "600"];
    let parsed = read(&mapping(SECONDS, START, CRUISE), &climb_and_cruise(one, other));
    close(masses_kg(&parsed).0, 10_000.0 - 36.0 - (36.0 - 0.5 - 0.5));
    assert_eq!(message(&parsed, "mapped-flow-bridged"), "");
    // Both stop on the ground between two legs: 60 kg/h, 0, 0, 600 kg/h.
    let leg = ["60", "0", "600", "600", "600", "600", "600", "600", "600"];
    let parsed = read(&mapping(SECONDS, START, CRUISE), &climb_and_cruise(leg, leg));
    close(masses_kg(&parsed).0, 10_000.0 - 2.0 * (0.5 + 5.0 + 30.0));
    assert_eq!(message(&parsed, "mapped-flow-bridged"), "");
}

/// A hundred seconds of cruise that burn a kilogram each, some masses of which are replaced.
fn cruise(replaced: &[(usize, &str)]) -> String {
    let mut text = format!("{NAMES}\n");
    for second in 0..100_usize {
        let mass = replaced.iter().find(|(place, _)| *place == second);
        let mass = mass.map_or_else(|| (9000 - second).to_string(), |(_, mass)| (*mass).to_owned());
        let _ = writeln!(text, "{second},37000,-56.5,0.78,447,450,1800,1800,{mass}");
    }
    text
}

#[test]
fn an_impossible_gross_mass_costs_its_row() {
    let lenient = mapping(SECONDS, GROSS, "out_of_range: LeaveRowOut,");
    let strict = mapping(SECONDS, GROSS, "");
    for wrong in ["1000", "0", "-5", "8700", "99999", "9200"] {
        for places in [&[50_usize, 51][..], &[0], &[99], &[7, 60, 61, 80]] {
            let replaced: Vec<(usize, &str)> = places.iter().map(|place| (*place, wrong)).collect();
            // A fall of some per cent that stays is one that masses have.
            if (wrong, places) == ("8700", &[99]) || (wrong, places) == ("9200", &[0]) {
                continue;
            }
            let text = cruise(&replaced);
            let parsed = read(&lenient, &text);
            let (first, last) = (usize::from(places[0] == 0), 99 - usize::from(places[0] == 99));
            let (first_kg, used_kg) = masses_kg(&parsed);
            close(first_kg, 9000.0 - first as f64);
            close(used_kg, (last - first) as f64);
            let said = message(&parsed, "mapped-rows-out-of-range");
            let expected = format!(
                "{} row{} left out for a number",
                places.len(),
                if places.len() == 1 { "" } else { "s" }
            );
            assert!(said.starts_with(&expected) && said.ends_with("gross mass"), "{said}");
            let found = parsed.findings.iter().find(|one| one.code == "mapped-rows-out-of-range");
            assert_eq!(found.and_then(|found| found.line), Some(places[0] + 2));
            // Where such rows are refused, the row that is wrong is.
            let refusal = refused(&strict, &text);
            assert!(refusal.starts_with(&format!("line {},", places[0] + 2)), "{refusal}");
        }
    }
}

/// Of two flights neither is wrong.
#[test]
fn a_mass_that_rises_for_good_is_refused() {
    let refuelled: Vec<(usize, &str)> = (60..100).map(|place| (place, "9500")).collect();
    let text = cruise(&refuelled);
    let lenient = mapping(SECONDS, GROSS, "out_of_range: LeaveRowOut, bad_rows: LeaveRowOut,");
    let refusal = refused(&lenient, &text);
    assert!(refusal.starts_with("line 62,") && !refusal.contains("new_flight"), "{refusal}");
    // Behind a gap it is another flight.
    let refusal = refused(&lenient, &later(&text, 60, 3000));
    assert!(refusal.contains("3001 s without a row"), "{refusal}");
    assert!(refusal.contains("new_flight_after_s"), "{refusal}");
}

/// Rows behind the first `place` ones are so many seconds later.
fn later(text: &str, place: usize, seconds: usize) -> String {
    let mut shifted = String::new();
    for (row, line) in text.lines().enumerate() {
        let (time, rest) = line.split_once(',').unwrap_or_default();
        match time.parse::<usize>() {
            Ok(time) if row > place => drop(writeln!(shifted, "{},{rest}", time + seconds)),
            _ => drop(writeln!(shifted, "{line}")),
        }
    }
    shifted
}

/// By hand: flow is never integrated over the hours between two flights of one number, 3600 kg/h over 79 901 s would be 79.9 t.
#[test]
fn a_start_mass_does_not_reach_over_the_gap_between_two_flights() {
    let start = mapping(SECONDS, START, "");
    let refusal = refused(&start, &later(&cruise(&[]), 50, 79_900));
    assert_eq!(
        refusal,
        "line 52, column 1: found 79901 s, expected no more than 10800 s without a row where fuel flow is integrated \
         from a start mass: another flight? new_flight_after_s in the mapping divides them"
    );
    // Three hours are within a flight, and more where the mapping says so: one kilogram a second.
    let heavy = "StartMass(gross_weight: Value(90000, \"kg\"))";
    let parsed = read(&mapping(SECONDS, heavy, ""), &later(&cruise(&[]), 50, 10_799));
    close(masses_kg(&parsed).1, 99.0 + 10_799.0);
    let long = mapping(SECONDS, heavy, "new_flight_after_s: 80000,");
    close(masses_kg(&read(&long, &later(&cruise(&[]), 50, 79_900))).1, 99.0 + 79_900.0);
    // Before an engine burns anything the start mass is still that: systems may be switched on hours before.
    let flows = ["0", "0", "600", "600", "600", "600", "600", "600", "600"];
    let early = climb_and_cruise(flows, flows);
    let of_start = mapping(SECONDS, START, CRUISE);
    let (first_kg, used_kg) = masses_kg(&read(&of_start, &early));
    close(first_kg, 10_000.0 - 2.0 * (5.0 + 30.0));
    assert_eq!(masses_kg(&read(&of_start, &later(&early, 1, 20_000))), (first_kg, used_kg));
    assert!(refused(&of_start, &later(&early, 3, 20_000)).contains("new_flight_after_s"));
    // Behind the last row that is used nothing has to be known.
    let parked = early + "40000,500,-56.5,0.78,447,10,0,0,8990\n";
    assert_eq!(masses_kg(&read(&of_start, &parked)), (first_kg, used_kg));
}

/// A counter that begins again behind such a gap points to it too.
#[test]
fn a_counter_that_begins_again_behind_a_gap_is_another_flight() {
    let counter = "FuelUsed(column: \"gw\", unit: \"kg\", zero_fuel_weight: (5000, \"kg\"), fuel_on_board: (3000, \"kg\"))";
    let used: Vec<String> = (0..100).map(|second| (200 + second % 50).to_string()).collect();
    let used: Vec<(usize, &str)> = used.iter().map(String::as_str).enumerate().collect();
    let refusal = refused(&mapping(SECONDS, counter, ""), &cruise(&used));
    assert!(refusal.starts_with("line 52,") && !refusal.contains("new_flight"), "{refusal}");
    let refusal = refused(&mapping(SECONDS, counter, ""), &later(&cruise(&used), 50, 79_900));
    assert!(refusal.contains("79901 s without a row come before it: another flight?"), "{refusal}");
    assert!(refusal.contains("new_flight_after_s"), "{refusal}");
}

/// Ten minutes at one level a second each; what an encoder writes for "no altitude" does not divide them.
#[test]
fn an_altitude_out_of_range_costs_its_row_and_no_level_part() {
    let mut text = format!("{NAMES}\n");
    for second in 0..600 {
        let feet = if [150, 151, 300].contains(&second) { 131_071 } else { 37_000 };
        let _ = writeln!(text, "{second},{feet},-56.5,0.78,447,450,1800,1800,{}", 9000 - second);
    }
    let parsed = read(&mapping(SECONDS, GROSS, CRUISE), &text);
    assert_eq!(parsed.report.columns().time_s.len(), 597);
    assert_eq!(parsed.left_out, 3);
    assert_eq!(
        message(&parsed, "mapped-rows-out-of-range"),
        "3 rows left out for a number out of range, the first for its ALT"
    );
    let strict = mapping(SECONDS, GROSS, &CRUISE.replace("LeaveRowOut", "Refuse"));
    let refusal = refused(&strict, &text);
    assert!(refusal.starts_with("line 152, column 5: found 39950.4"), "{refusal}");
    assert!(refusal.contains("expected ALT of -2000 to 60000 ft"), "{refusal}");
    // Where all are, it is the column: refused at its first number, and not for want of a level part.
    let wrong = text.replace(",37000,", ",99000,");
    let refusal = refused(&mapping(SECONDS, GROSS, CRUISE), &wrong);
    assert!(refusal.starts_with("line 2, column 3:"), "{refusal}");
    assert!(refusal.contains("expected ALT of"), "{refusal}");
}

/// A column that is there and empty is named, and not a level part that is not.
#[test]
fn an_empty_column_is_named() {
    let text = climb_and_cruise(["600"; 9], [""; 9]);
    for mapping in [mapping(SECONDS, GROSS, ""), mapping(SECONDS, GROSS, CRUISE)] {
        assert_eq!(
            refused(&mapping, &text),
            "line 2, column 29: found 9 rows, expected every number that the report needs; most of these rows lack one in \"ff2\""
        );
    }
}

#[test]
fn nan_is_no_number_in_text() {
    let text = cruise(&[(3, "NaN"), (50, "nan"), (51, "-9")]);
    let parsed = read(&mapping(SECONDS, GROSS, "out_of_range: LeaveRowOut,"), &text);
    assert_eq!(parsed.report.columns().time_s.len(), 97);
    assert!(message(&parsed, "mapped-rows-left-out").starts_with("2 rows left out for want"));
    assert_eq!(message(&parsed, "mapped-rows-bad"), "");
}

/// Seconds of the day pass midnight in `TimeOfDay`; as seconds since an instant the message names it.
#[test]
fn seconds_of_the_day_pass_midnight() {
    let mut text = format!("{NAMES}\n");
    for second in 86_390..86_410 {
        let _ = writeln!(
            text,
            "{},37000,-56.5,0.78,447,450,1800,1800,{}",
            second % 86_400,
            95_400 - second
        );
    }
    let of_day = "TimeOfDay(column: \"time\", date: \"2024-03-01\", utc_offset: \"Z\")";
    let parsed = read(&mapping(of_day, GROSS, ""), &text);
    let time_s = &parsed.report.columns().time_s;
    close(time_s[19], 19.0);
    assert_eq!(parsed.report.header().identity.start.to_string(), "2024-03-01T23:59:50Z");
    let refusal = refused(&mapping(SECONDS, GROSS, ""), &text);
    assert!(refusal.contains("is midnight between them? time: TimeOfDay"), "{refusal}");
    // No other fall of time is.
    let refusal = refused(&mapping(SECONDS, GROSS, ""), &text.replace("\n86395", "\n86000"));
    assert!(!refusal.contains("midnight"), "{refusal}");
}

/// Local time with its offset in a column; the offset changes on the way, and time goes on.
#[test]
fn an_offset_in_a_column() {
    let mut text = format!("day,ofs,{NAMES}\n");
    for (second, (clock, offset)) in [
        ("23:59:58", "-05:00"),
        ("23:59:59", "-05:00"),
        ("06:00:00", "01:00"),
        ("06:00:01", "+01:00"),
    ]
    .into_iter()
    .enumerate()
    {
        let day = 1 + second / 2;
        let _ = writeln!(
            text,
            "2024-03-{day:02},{offset},{clock},37000,-56.5,0.78,447,450,1800,1800,{}",
            9000 - second
        );
    }
    let time = "Timestamp(column: \"time\", date: \"day\", utc_offset_column: \"ofs\")";
    let form = time.replace(", date", ", format: \"%Y-%m-%d %H:%M:%S\", date");
    for time in [time, form.as_str()] {
        let parsed = read(&mapping(time, GROSS, ""), &text);
        assert_eq!(parsed.report.header().identity.start.to_string(), "2024-03-02T04:59:58Z");
        // 06:00 at +01:00 is 05:00 UTC, a second after 23:59:59 at -05:00.
        let time_s = &parsed.report.columns().time_s;
        for (found, expected) in time_s.iter().zip([0.0, 1.0, 2.0, 3.0]) {
            close(*found, expected);
        }
    }
}

/// TAS of Mach number and SAT at the speed of sound of ICAO Doc 7488: 295.069 m/s at 216.65 K.
#[test]
fn temperature_of_true_airspeed_and_mach_number() {
    let text = cruise(&[]).replace(",-56.5,0.78,447,", ",,0.78,447.383,");
    let with = |mach: &str, airspeed: &str| {
        let quantities = format!(
            r#"(format: 1, aircraft: Text("A"), tail: Text("B"), flight: Text("C"), time: {SECONDS}, mass: {GROSS},
            quantities: {{"ALT": Recorded(column: "alt", unit: "ft"), "SAT": FromTrueAirspeed, "MACH": {mach},
            "VTAS": {airspeed}, "GSPD": Recorded(column: "gs", unit: "kt"), "WF": Recorded(column: "ff1", unit: "kg/h")}})"#
        );
        Mapping::from_ron(&quantities)
    };
    let mach = "Recorded(column: \"mach\", unit: \"-\")";
    let airspeed = "Recorded(column: \"tas\", unit: \"kt\")";
    let parsed = match with(mach, airspeed) {
        Ok(mapping) => read(&mapping, &text),
        Err(error) => panic!("{error}"),
    };
    let sat_k = parsed.report.columns().static_air_temperature_k.as_ref().map(|sat| sat[0]);
    let speed_of_sound_m_s = 447.383 * 1852.0 / 3600.0 / 0.78;
    let expected_k = 216.65 * (speed_of_sound_m_s / 295.069_f64).powi(2);
    assert!(sat_k.is_some_and(|sat_k| (sat_k - expected_k).abs() < 0.001), "{sat_k:?}");
    assert!(message(&parsed, "mapped-derived").contains("SAT from VTAS and MACH"));
    for (mach, airspeed) in [("FromTrueAirspeed", airspeed), (mach, "FromMach")] {
        assert!(
            with(mach, airspeed).is_err_and(|error| error.to_string().contains("from each other"))
        );
    }
}

/// The first mapping of a recording, and the report that it gives.
fn by_first_mapping(text: &str) -> (String, Vec<Parsed>) {
    let first = first_mapping(text.as_bytes()).unwrap_or_else(|refusal| panic!("{refusal}"));
    // The date and the mass are what a person has to state.
    let first = first.replace("YYYY-MM-DD", "2000-01-01");
    let first = first.replace("Column(\"ZERO FUEL WEIGHT\", \"kg\")", "Value(10000, \"kg\")");
    let mapping = Mapping::from_ron(&first).unwrap_or_else(|error| panic!("{error}\n{first}"));
    match mapping.read_named(text.as_bytes(), "F") {
        Ok(parsed) => (first, parsed),
        Err(refusal) => panic!("{refusal}\n{first}"),
    }
}

/// A quarter of an hour of cruise, a row each second: `row` writes one, given its second.
fn quarter_of_an_hour(names: &str, row: impl Fn(usize) -> String) -> String {
    (0..900).fold(format!("{names}\n"), |text, second| text + &row(second) + "\n")
}

/// A log as the G1000 and G3000 write it: two comment lines, of which the second has the units; local time with its offset.
#[test]
fn a_log_of_integrated_avionics() {
    let names = "#airframe_info, log_version=\"1.00\", airframe_name=\"Citation\",\n\
                 #yyy-mm-dd, hh:mm:ss,   hh:mm,  ident, ft Baro, deg C,     kt,     kt,   deg,   lbs,   lbs,      pph,      pph,     %,     %, kt\n  \
                 Lcl Date, Lcl Time, UTCOfst, AtvWpt, AltB, OAT, IAS, GndSpd, Roll, FQtyL, FQtyR, E1 FFlow, E2 FFlow, E1 N1, E2 N1, TAS";
    let text = quarter_of_an_hour(names, |second| {
        format!(
            "2024-03-10, 19:{:02}:{:02},  -05:00,    ,37000.0,-56.5,250.1,450.2,0.0,{fuel:.1},{fuel:.1},1800.0,1790.0,90.1,90.2,447.4",
            50 + second / 60 % 10,
            second % 60,
            fuel = 3000.0 - second as f64 / 4.0,
        )
    });
    // Ten minutes to eight, and on past eight.
    let text = text
        .lines()
        .enumerate()
        .map(|(line, text)| if line > 602 { text.replace("19:5", "20:0") } else { text.to_owned() } + "\n")
        .collect::<String>();
    let (first, parsed) = by_first_mapping(&text);
    for entry in [
        "comment: '#',",
        "Timestamp(column: \"Lcl Time\", date: \"Lcl Date\", utc_offset_column: \"UTCOfst\"),\n",
        "\"ALT\": Recorded(column: \"AltB\", unit: \"ft\"),   // ?",
        "\"SAT\": Recorded(column: \"OAT\", unit: \"degC\"),\n",
        "\"MACH\": FromTrueAirspeed,   // ?",
        "\"GSPD\": Recorded(column: \"GndSpd\", unit: \"kt\"),\n",
        "\"WF(1)\": Recorded(column: \"E1 FFlow\", unit: \"lb/h\"),\n",
        "\"WF(2)\": Recorded(column: \"E2 FFlow\", unit: \"lb/h\"),\n",
        "tanks: [\"FQtyL\", \"FQtyR\"], unit: \"lb\"",
    ] {
        assert!(first.contains(entry), "{entry}\n{first}");
    }
    let report = &parsed[0].report;
    // Trimmed by a minute; 19:51 at five hours behind UTC is 00:51 of the next day.
    assert_eq!(report.header().identity.start.to_string(), "2024-03-11T00:51:00Z");
    assert_eq!(report.columns().time_s.len(), 780);
    close(report.columns().fuel_flow.total_kg_s(0), 3590.0 * 0.453_592_37 / 3600.0);
}

/// Names with kilopounds, knots and abbreviations; what else such a name may be is marked.
#[test]
fn names_of_business_jets() {
    let row = |second: usize| {
        format!(
            "2024-03-10T10:{:02}:{:02}Z,37000,0.78,-56.5,447,450,900,900,{:.3}",
            second / 60,
            second % 60,
            30.0 - second as f64 / 1e4
        )
    };
    let names =
        "UTC,BARO ALT (FT),MACH,Static Air Temp (C),KTAS,GS (KTS),FF 1 (PPH),FF 2 (PPH),GW (KLB)";
    let (first, parsed) = by_first_mapping(&quarter_of_an_hour(names, row));
    for entry in [
        "\"ALT\": Recorded(column: \"BARO ALT (FT)\", unit: \"ft\"),   // ?",
        "\"SAT\": Recorded(column: \"Static Air Temp (C)\", unit: \"degC\"),\n",
        "\"VTAS\": Recorded(column: \"KTAS\", unit: \"kt\"),\n",
        "GrossMass(column: \"GW (KLB)\", unit: \"klb\", largest_rise_kg: 200),\n",
    ] {
        assert!(first.contains(entry), "{entry}\n{first}");
    }
    close(masses_kg(&parsed[0]).0, 1000.0 * (30.0 - 0.006) * 0.453_592_37);
    let vague = quarter_of_an_hour(names, |second| row(second).replace(",-56.5,", ",216.65,"))
        .replace("Static Air Temp (C)", "temperature")
        .replace("GW (KLB)", "TOGW (KLB)")
        .replace("KTAS", "TAS (KTS)");
    let (first, _) = by_first_mapping(&vague);
    assert!(
        first.contains("\"SAT\": Recorded(column: \"temperature\", unit: \"K\"),   // ?"),
        "{first}"
    );
    assert!(
        first.contains(
            "GrossMass(column: \"TOGW (KLB)\", unit: \"klb\", largest_rise_kg: 200),   // ?"
        ),
        "{first}"
    );
    // Without a temperature, that of TAS and Mach number is better than the standard atmosphere's.
    let without = quarter_of_an_hour(&names.replace("Static Air Temp (C)", "OTHER"), row);
    let (first, parsed) = by_first_mapping(&without);
    assert!(first.contains("\"SAT\": FromTrueAirspeed,   // ?"), "{first}");
    let sat_k = parsed[0].report.columns().static_air_temperature_k.as_ref().map(|sat| sat[0]);
    assert!(sat_k.is_some_and(|sat_k| (sat_k - 216.3).abs() < 0.2), "{sat_k:?}");
}

/// Texts that programs write where there is no number.
#[test]
fn texts_for_no_number_are_found() {
    for mark in ["NaN", "nan", "NULL", "****", "N/A", "---"] {
        let text = quarter_of_an_hour(
            "time,alt_ft,sat_c,mach,tas_kt,gs_kt,ff1_kgh,ff2_kgh,gw_kg,lat",
            |second| {
                let lat = if second % 10 == 0 { "48.5" } else { mark };
                format!("{second},37000,-56.5,0.78,447,450,1800,1800,{},{lat}", 9000 - second)
            },
        );
        let (first, parsed) = by_first_mapping(&text);
        assert_eq!(parsed[0].report.columns().time_s.len(), 780, "{first}");
        let is_listed = first.contains(&format!("not_available: [{mark:?}],"));
        assert_eq!(is_listed, !mark.eq_ignore_ascii_case("nan"), "{first}");
    }
}

/// Two flights in one file, the second of seconds of the day past midnight.
#[test]
fn a_first_mapping_sees_another_flight_and_midnight() {
    let row = |second: usize| {
        format!("{},37000,-56.5,0.78,447,450,1800,1800,{}", second % 86_400, 95_000 - second)
    };
    let names = "TIME,alt_ft,sat_c,mach,tas_kt,gs_kt,ff1_kgh,ff2_kgh,gw_kg";
    let text = quarter_of_an_hour(names, |second| row(second + 86_000));
    let (first, parsed) = by_first_mapping(&text);
    assert!(first.contains("time: TimeOfDay(column: \"TIME\", date: \"2000-01-01\""), "{first}");
    assert_eq!(parsed[0].report.columns().time_s.len(), 780);
    assert!(!first.contains("new_flight_after_s:"), "{first}");
    let one = quarter_of_an_hour(names, |second| row(second + 1000));
    let later: String = one
        .lines()
        .skip(1)
        .filter_map(|line| line.split_once(','))
        .filter_map(|(time, rest)| Some(format!("{},{rest}\n", time.parse::<usize>().ok()? + 9000)))
        .collect();
    let (first, parsed) = by_first_mapping(&(one + &later));
    assert!(first.contains("    new_flight_after_s: 1200,   // ?\n"), "{first}");
    assert_eq!(parsed.len(), 2);
}

/// By hand: counters of 100 and 90 kg, which rise by 2 and 1 kg a second; 50 000 + 10 000 kg at the engines' start.
#[test]
fn fuel_used_of_each_engine_adds_up() {
    let row = |second: usize| {
        format!(
            "2024-03-10T10:{:02}:{:02}Z,37000,0.78,-56.5,447,450,1800,1800,{},{},50000,10000",
            second / 60,
            second % 60,
            100 + 2 * second,
            90 + second
        )
    };
    let names = "UTC,alt_ft,mach,sat_c,tas_kt,gs_kt,ff1_kgh,ff2_kgh,FUEL_USED_1 (KG),FUEL_USED_2 (KG),zfw_kg,fob_kg";
    let (first, parsed) = by_first_mapping(&quarter_of_an_hour(names, row));
    assert!(
        first.contains("fuel_used: Columns([\"FUEL_USED_1 (KG)\", \"FUEL_USED_2 (KG)\"], \"kg\")"),
        "{first}"
    );
    // Trimmed by a minute at either end: from second 60 to 839.
    let (first_kg, used_kg) = masses_kg(&parsed[0]);
    close(first_kg, 60_000.0 - 190.0 - 3.0 * 60.0);
    close(used_kg, 3.0 * 779.0);
}
