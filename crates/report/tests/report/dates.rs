//! Dates in a column of their own: of two digits, day and month exchanged, not followed past midnight.

#![expect(clippy::panic, reason = "a test fails by panicking, in its helpers too")]

use report::{Mapping, Parsed, Refusal};

fn read(format: &str, rows: &[(&str, &str)]) -> Result<Vec<Parsed>, Refusal> {
    let text = format!(
        r#"(
        format: 1,
        aircraft: Text("A320"), tail: Text("T-1"), flight: Text("1"),
        time: Timestamp(column: "TIME", date: "DATE", format: "{format} %H:%M:%S", utc_offset: "Z"),
        quantities: {{
            "ALT": Recorded(column: "alt", unit: "ft"),
            "SAT": Recorded(column: "sat", unit: "degC"),
            "MACH": Recorded(column: "mach", unit: "-"),
            "VTAS": FromMach,
            "GSPD": Recorded(column: "gs", unit: "kt"),
            "WF": Recorded(column: "ff", unit: "kg/h"),
        }},
        mass: GrossMass(column: "gw", unit: "kg", largest_rise_kg: 50),
    )"#
    );
    let mapping = Mapping::from_ron(&text).unwrap_or_else(|error| panic!("{error}"));
    let rows = rows.iter().enumerate().map(|(row, (date, time))| {
        format!("A,{date},{time},35000,-54,0.78,450,2400,{}\n", 65_000 - 40 * row)
    });
    let names = "x,DATE,TIME,alt,sat,mach,gs,ff,gw\n".to_owned();
    mapping.read((names + &rows.collect::<String>()).as_bytes())
}

fn refused(format: &str, rows: &[(&str, &str)]) -> (usize, &'static str) {
    let refusal = read(format, rows).err().unwrap_or_else(|| panic!("it is read"));
    assert_eq!(refusal.line, 2);
    (refusal.column, refusal.kind.code())
}

/// The refusal is at the date, which begins at the third character, and not at the time.
#[test]
fn the_cell_that_is_wrong_is_named() {
    let on = |day: &'static str| [(day, "10:00:00"), (day, "10:01:00"), (day, "10:02:00")];
    assert_eq!(refused("%d/%m/%Y", &on("03/14/2024")), (3, "source-day-and-month"));
    assert_eq!(refused("%d/%m/%Y", &on("33/14/2024")), (3, "source-instant-malformed"));
    // The year 24.
    assert_eq!(refused("%d/%m/%Y", &on("14/03/24")), (3, "source-instant-malformed"));
    assert_eq!(refused("%d/%m/%Y", &[("14/03/2024", "10-00")]), (14, "source-instant-malformed"));
    let read = read("%d/%m/%y", &on("14/03/24")).unwrap();
    assert_eq!(read[0].report.header().identity.start.to_string(), "2024-03-14T10:00:00Z");
}

#[test]
fn a_date_that_stays_at_midnight_is_passed() {
    let (day, next) = ("14/03/2024", "15/03/2024");
    let times = ["23:58:00", "23:59:00", "00:00:00", "00:01:00"];
    // It stays, it follows a minute late, it follows.
    for days in [[day; 4], [day, day, day, next], [day, day, next, next]] {
        let rows: Vec<_> = days.into_iter().zip(times).collect();
        let read = read("%d/%m/%Y", &rows).unwrap();
        assert_eq!(read[0].report.columns().time_s, [0.0, 60.0, 120.0, 180.0], "{days:?}");
    }
    // What falls by less is no midnight.
    let rows = [(day, "20:00:00"), (day, "05:00:00"), (day, "05:01:00")];
    assert!(read("%d/%m/%Y", &rows).is_err());
}
