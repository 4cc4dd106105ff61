use super::*;

#[test]
fn all_columns_and_the_rows_as_sent() {
    let text = "date,weight_lb,pressure_altitude_ft,mach,isa_deviation_c,fuel_flow_kg_h,\
                cg_percent_mac,anti_ice,latitude_deg,true_heading_deg,X-note\n\
                2018-05-20, 30000,43000,0.82,-5,730.3,25.5,1,-45,270,\"first, best\"\n\
                2018-05-20T14:14:21+02:00,30000,43000,.82,0,-,,0,,,\n";
    let points = FlightPoints::from_csv(text.as_bytes()).unwrap();
    assert_eq!(points.header().len(), 11);
    let [first, second] = points.rows() else { panic!("{points:?}") };
    assert_eq!((first.line, second.line), (2, 3));
    assert_eq!(first.fields[1], " 30000");
    assert_eq!(first.fields[10], "first, best");
    let point = first.point.clone().unwrap();
    assert_eq!(point.date, Some("2018-05-20T00:00:00Z".parse().unwrap()));
    assert!((point.mass.to_pounds() - 30_000.0).abs() < 1e-9);
    assert!((point.pressure_altitude.to_feet() - 43_000.0).abs() < 1e-9);
    assert!((point.static_air_temperature().unwrap().to_kelvin() - 211.65).abs() < 1e-9);
    let flow = point.measured_fuel_flow_total.unwrap().to_kilograms_per_hour();
    assert!((flow - 730.3).abs() < 1e-9);
    assert_eq!(point.center_of_gravity_percent_mac, Some(25.5));
    assert_eq!(point.anti_ice, Some(true));
    assert!((point.latitude.unwrap().to_degrees() + 45.0).abs() < 1e-9);
    assert!((point.true_heading.unwrap().to_degrees() - 270.0).abs() < 1e-9);
    let bare = second.point.clone().unwrap();
    assert_eq!(bare.date, Some("2018-05-20T12:14:21Z".parse().unwrap()));
    assert_eq!(
        bare,
        FlightPoint {
            date: bare.date,
            anti_ice: Some(false),
            ..FlightPoint::new(bare.mass, bare.pressure_altitude, bare.mach)
        }
    );
}

#[test]
fn flight_levels_are_hundreds_of_feet() {
    let in_feet =
        FlightPoints::from_csv(b"mass_kg,pressure_altitude_ft,mach\n14000,41000,0.8").unwrap();
    let in_levels = FlightPoints::from_csv(b"mass_kg,flight_level,mach\n14000,410,0.8").unwrap();
    assert_eq!(in_levels.rows()[0].point, in_feet.rows()[0].point);
    let both = b"mass_kg,pressure_altitude_ft,flight_level,mach\n14000,41000,410,0.8";
    assert!(FlightPoints::from_csv(both).is_err());
}

#[test]
fn the_shortest_file() {
    let points =
        FlightPoints::from_csv(b"mass_kg,pressure_altitude_ft,mach\n14000,41000,0.8").unwrap();
    let expected = FlightPoint::new(
        Mass::kilograms(14_000.0),
        PressureAltitude::feet(41_000.0),
        Mach::new(0.8),
    );
    assert_eq!(points.rows()[0].point, Ok(expected));
}

#[test]
fn a_row_that_lacks_a_needed_value_is_no_point_and_no_fault() {
    let text = "mass_kg,pressure_altitude_ft,mach,isa_deviation_c\n\
                ,41000,0.8,0\n14000,-,0.8,0\n14000,41000, ,0\n14000,41000,0.8,\n14000,41000,0.8,0\n";
    let points = FlightPoints::from_csv(text.as_bytes()).unwrap();
    let named = |row: &FlightPointRow| {
        row.point.as_ref().err().and_then(|error| error.column.as_ref()).map(|it| it.number)
    };
    let named: Vec<Option<usize>> = points.rows().iter().map(named).collect();
    assert_eq!(named, [Some(1), Some(2), Some(3), Some(4), None]);
    // A word is a fault, and so is the first one behind a value that is missing.
    assert!(FlightPoints::from_csv(text.replace('-', "none").as_bytes()).is_err());
}

/// As a data frame or another prediction writes them.
#[test]
fn a_deviation_out_of_its_limits_costs_its_row_and_nan_is_no_value() {
    let text = "mass_kg,pressure_altitude_ft,mach,isa_deviation_c,anti_ice,fuel_flow_kg_s\n\
                14000,41000,0.8,0,1.0,0.2\n14000,41000,0.8,216.65,0.0,\n14000,41000,NaN,0,true,0.2\n\
                14000,41000,0.8,inf,False,0.2\n14000,41000,0.8,nan,nan,nan\n";
    let points = FlightPoints::from_csv(text.as_bytes()).unwrap();
    let reasons: Vec<Option<String>> =
        points.rows().iter().map(|row| row.point.as_ref().err().map(ToString::to_string)).collect();
    assert_eq!(reasons[0], None);
    assert_eq!(
        reasons[1].as_deref(),
        Some(
            "line 3, column 4 (isa_deviation_c): found \"216.65\", expected -50 to 50 °C (deviation from the ISA)"
        )
    );
    let column = |row: usize| {
        let error = points.rows()[row].point.as_ref().unwrap_err();
        (error.column.as_ref().unwrap().number, error.is_missing_value())
    };
    assert_eq!([column(2), column(3), column(4)], [(3, true), (4, false), (4, true)]);
    let written = [("1.0", true), ("0.0", false), ("True", true), ("false", false), ("0", false)];
    for (text, expected) in written {
        assert_eq!(on_or_off(text), Some(expected), "{text}");
    }
    assert_eq!([on_or_off("0.5"), on_or_off("on"), on_or_off("2")], [None; 3]);
    // A column in another unit is no matter of a row.
    let text = "mass_kg,pressure_altitude_ft,mach\n14000,41000,78\n";
    assert!(FlightPoints::from_csv(text.as_bytes()).is_err());
}

#[test]
fn faults_have_line_column_found_and_expected() {
    let message = |row: &str| {
        let text =
            format!("mass_kg,pressure_altitude_ft,mach,isa_deviation_c,date,anti_ice\n{row}\n");
        FlightPoints::from_csv(text.as_bytes()).unwrap_err().to_string()
    };
    for (row, expected) in [
        (
            "14000,41000,1.2,0,,",
            "line 2, column 3 (mach): found \"1.2\", expected 0.1 to 0.99 Mach (Mach number)",
        ),
        (
            "14000,41000,0.8,0,20.5.2018,",
            "line 2, column 5 (date): found \"20.5.2018\", expected a date as 2018-05-20 or 2018-05-20T14:14:21Z",
        ),
        ("14000,41000,0.8,0,,0.5", "line 2, column 6 (anti_ice): found \"0.5\", expected 0 or 1"),
    ] {
        assert_eq!(message(row), expected);
    }
}
