//! What a first mapping makes of units, masses and dates that a recording states in its own way, or not at all.

#![expect(clippy::panic, reason = "a test fails by panicking, in its helpers too")]

use report::Mapping;
use report::mapping::first_mapping;

/// The mapping of a recording of these columns besides the usual ones: name, unit in a row of units, value.
fn of(columns: &[(&str, &str, &str)]) -> String {
    let usual = [
        ("utc", "UTC", "2024-03-01T10:00:00Z"),
        ("alt", "ft", "35000"),
        ("mach", "M", "0.78"),
        ("gs", "kt", "450"),
    ];
    let mut lines = ["", "", ""].map(str::to_owned);
    for (at, column) in usual.iter().chain(columns).enumerate() {
        for (line, field) in lines.iter_mut().zip([column.0, column.1, column.2]) {
            *line = format!("{line}{}{field}", if at == 0 { "" } else { "," });
        }
    }
    first_mapping((lines.join("\n") + "\n").as_bytes())
        .unwrap_or_else(|refusal| panic!("{refusal}"))
}

fn line_of<'m>(mapping: &'m str, what: &str) -> &'m str {
    mapping.lines().map(str::trim).find(|line| line.contains(what)).unwrap_or_default()
}

#[test]
fn units_are_known_by_their_usual_spellings() {
    for (quantity, name, written, spellings) in [
        ("WF", "ff", "\"lb/h\"", "lb/h|lbs/hr|LBS/HR|lb/hour|pounds/hr|pounds per hour|PPH|#/hr"),
        ("WF", "ff", "\"kg/h\", scale: 60", "kg/min|KG/MIN"),
        ("WF", "ff", "\"lb/h\", scale: 60", "lb/min|PPM"),
        ("mass", "gw", "\"lb\"", "lb|lbs|LBS|pounds|POUNDS|lbm|Lbs."),
        ("mass", "gw", "\"klb\"", "klb|KLBS|1000 lb|lbs*1000|lb x1000"),
        ("mass", "gw", "\"t\"", "t|tons|tonnes|TON|MT|1000 kg|kg x 1000"),
        ("mass", "gw", "\"kg\"", "kg|KGS|kilograms"),
        ("VTAS", "tas", "\"m/s\", scale: 0.277777778", "km/h|kmh|kph"),
        ("VTAS", "tas", "\"kt\", scale: 0.868976242", "mph|MPH"),
        ("ROLL", "roll", "\"deg\", scale: 57.2957795", "rad|radians|RAD"),
        ("SAT", "sat", "\"degF\"", "F|degF|DEG F|Fahrenheit"),
        ("SAT", "sat", "\"K\"", "K|degK|Kelvin"),
        ("FQ", "fq", "\"lb\"", "Lbs|pounds"),
    ] {
        for unit in spellings.split('|') {
            let expected = format!("unit: {written}");
            // In a row of units, and behind the name.
            let line = of(&[(name, unit, "30")]);
            let line = line_of(&line, quantity);
            assert!(line.contains(&expected), "{unit} in a row: {line}");
            let named = of(&[(&format!("{name} [{unit}]"), "-", "30")]);
            let line = line_of(&named, quantity);
            assert!(unit == "#/hr" || line.contains(&expected), "{unit} in a name: {line}");
        }
    }
}

#[test]
fn a_unit_that_is_not_known_is_quoted() {
    let mapping = of(&[("roll", "grad", "1"), ("ff", "slugs/h", "2400")]);
    assert!(line_of(&mapping, "ROLL").ends_with("// ?"), "{mapping}");
    let said =
        "// Stated in units that are not known, and guessed: \"roll\" (grad), \"ff\" (slugs/h).";
    assert!(mapping.contains(said), "{mapping}");
    assert!(!of(&[("roll", "deg", "1")]).contains("Stated in"));
    // Track and heading in radians make no drift in degrees.
    let angles = [("track", "rad", "1"), ("hdg", "rad", "1")];
    assert!(!of(&angles).contains("DRIFT"));
    assert!(of(&angles.map(|(name, _, value)| (name, "deg", value))).contains("DRIFT"));
}

#[test]
fn the_centre_tank_is_not_all_tanks() {
    let tanks = [("FQ_L", "-", "6400"), ("FQ_R", "-", "6400"), ("FQ_C", "-", "3200")];
    let mapping = of(&tanks);
    assert!(mapping.contains("tanks: [\"FQ_L\", \"FQ_R\", \"FQ_C\"]"), "{mapping}");
    assert!(
        mapping.contains("zero_fuel_weight: Column(\"ZERO FUEL WEIGHT\", \"kg\")"),
        "{mapping}"
    );
    assert!(!mapping.contains("\"FQ\": Recorded"), "{mapping}");
}

#[test]
fn masses_by_other_names_and_none_at_all() {
    for (name, unit) in [
        ("AC WEIGHT", "kg"),
        ("A/C GROSS WEIGHT", "kg"),
        ("ACGW", "kg"),
        ("GWT", "kg"),
        ("WGT", "kg"),
        ("GROSS_WT (lbs)", "lb"),
        ("GW_TON", "t"),
    ] {
        let mapping = of(&[(name, "-", if unit == "t" { "70" } else { "70000" })]);
        let expected = format!("mass: GrossMass(column: {name:?}, unit: {unit:?}");
        assert!(mapping.contains(&expected), "{expected}: {mapping}");
    }
    // None is invented: the mapping is not read with before one is stated.
    let mapping = of(&[("tas", "kt", "450")]);
    assert!(line_of(&mapping, "mass:").contains("// ? no column is known for it"), "{mapping}");
    assert!(!mapping.contains("60000"), "{mapping}");
    let text = "utc,alt,mach,sat,gs,ff\n2024-03-01T10:00:00Z,35000,0.78,-54,450,2400\n";
    let refused =
        Mapping::from_ron(&first_mapping(text.as_bytes()).unwrap()).unwrap().read(text.as_bytes());
    assert!(refused.unwrap_err().to_string().contains("GROSS WEIGHT"));
}

/// What stays for a flight is its take-off mass, though it is less from flight to flight.
#[test]
fn a_take_off_mass_is_no_gross_mass() {
    let with = |mass: fn(usize) -> usize| {
        let row = |row| format!("{},35000,0.78,-54,450,2400,{}\n", row * 10, mass(row));
        let rows = (0..2000).map(row).collect::<String>();
        let mapping = first_mapping(format!("time,alt,mach,sat,gs,ff,TOW_KG\n{rows}").as_bytes());
        line_of(&mapping.unwrap(), "mass:").to_owned()
    };
    assert!(with(|row| 70_000 - 1500 * (row / 700)).starts_with("mass: StartMass("));
    let gross = with(|row| 70_000 - 10 * (row / 2));
    assert!(gross.starts_with("mass: GrossMass(") && gross.ends_with("// ?"), "{gross}");
}

#[test]
fn years_of_two_digits_and_no_date() {
    let text =
        |date: &str| format!("DATE,TIME,alt\n{date},10:00:00,35000\n{date},10:00:04,35000\n");
    let of = |date: &str| first_mapping(text(date).as_bytes()).unwrap();
    assert!(of("31/12/24").contains("format: \"%d/%m/%y %H:%M:%S\", utc_offset: \"Z\"),   // ?\n"));
    assert!(of("12/31/24").contains("\"%m/%d/%y %H:%M:%S\""));
    let either = of("03/02/2024");
    assert!(
        either.contains("\"%d/%m/%Y %H:%M:%S\"") && either.contains("// ? %d is the day"),
        "{either}"
    );
    let without = first_mapping(b"TIME,alt\n10:00:00,35000\n10:00:04,35000\n").unwrap();
    assert!(without.contains("date: \"YYYY-MM-DD\""), "{without}");
    assert!(Mapping::from_ron(&without).is_err());
}
