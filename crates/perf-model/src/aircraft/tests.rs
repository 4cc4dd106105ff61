use super::*;

const CITATION_X: &str = r#"(
    name: "Cessna Citation X",
    type_code: "C750",              // the value of AIRCRAFT in its reports
    engines: 2,
    wing_area_m2: 48.96,
    tsfc: (static_lb_per_lbf_h: 0.405, mach_exponent: 1.05),
    table: (lift_coefficient: (0.10, 0.70, 0.05), mach: (0.50, 0.95, 0.05)),   // from, to, step
)"#;

fn edited(from: &str, to: &str) -> String {
    assert!(CITATION_X.contains(from), "{from}");
    CITATION_X.replacen(from, to, 1)
}

/// Line, column and reason of the refusal.
fn refused(text: &str) -> (usize, usize, String) {
    match Aircraft::from_ron(text) {
        Err(AircraftError::File { line, column, reason }) => (line, column, reason.to_string()),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_file_with_every_field_reads() {
    let aircraft = Aircraft::from_ron(CITATION_X).unwrap();
    assert_eq!(aircraft.type_code(), "C750");
    assert_eq!(aircraft.engines(), 2);
    assert!((aircraft.wing_area().to_square_meters() - 48.96).abs() < 1e-12);
    assert_eq!(aircraft.grid().x().len(), 13);
    assert_eq!(aircraft.grid().x().breakpoints()[4].to_bits(), 0.3_f64.to_bits()); // as typed
    assert_eq!(aircraft.grid().y().last().to_bits(), 0.95_f64.to_bits());
    assert_eq!(aircraft.polynomial(), Basis::SeparableQuadratic);
    assert_eq!(*aircraft.sensors(), SensorDeviations::default());
    // 0.405/(3600·9.80665) = 1.147 181e-5 kg/(N s), by hand.
    let law = aircraft.tsfc_law();
    assert!((law.static_tsfc.to_kilograms_per_newton_second() - 1.147_181e-5).abs() < 1e-11);
    assert!((law.mach_exponent - 1.05).abs() < 1e-15);
}

#[test]
fn optional_fields_plainly_or_in_some() {
    let text = edited(
        "engines: 2,",
        "engines: 2, mean_aerodynamic_chord_m: 2.62, drag_divergence_mach: Some(0.86),
         reference_lhv_mj_kg: None, polynomial: FullQuadratic,
         table_uncertainty_percent: None,
         sensors: (mach: 0.002, mass: Kilograms(80)),",
    );
    let aircraft = Aircraft::from_ron(&text).unwrap();
    assert_eq!(aircraft.mean_aerodynamic_chord_m(), Some(2.62));
    assert_eq!(aircraft.drag_divergence_mach(), Some(Mach::new(0.86)));
    assert_eq!(aircraft.reference_lower_heating_value_mj_kg(), None);
    assert_eq!(aircraft.polynomial(), Basis::FullQuadratic);
    assert_eq!(aircraft.sensors().mass, MassDeviation::Kilograms(80.0));
    let rest =
        SensorDeviations { mach: 0.001, mass: MassDeviation::Percent(0.7), ..*aircraft.sensors() };
    assert_eq!(rest, SensorDeviations::default());
}

#[test]
fn an_axis_by_breakpoints_is_no_axis_by_step() {
    let text = edited("(0.10, 0.70, 0.05)", "[ /* uneven */ 0.1, 0.25, 0.7]");
    let aircraft = Aircraft::from_ron(&text).unwrap();
    assert_eq!(aircraft.grid().x().breakpoints(), [0.1, 0.25, 0.7]);
    let text = edited("(0.10, 0.70, 0.05)", "[0.10, 0.70, 0.05]");
    assert!(refused(&text).2.contains("breakpoints must increase"));
    let text = edited("(0.10, 0.70, 0.05)", "(0.10, 0.70)");
    assert_eq!(refused(&text).0, 7);
}

#[test]
fn errors_say_line_column_and_what_is_wrong() {
    // Positions counted by hand in the text above.
    for (from, to, line, column, words) in [
        ("wing_area_m2: 48.96", "wing_area_m2: -3", 5, 21, "wing area -3 m² outside 1 to 2000 m²"),
        ("wing_area_m2: 48.96", "wing_area_m2: NaN", 5, 22, "wing area NaN m²"),
        ("engines: 2", "engines: 5", 4, 15, "5 engines, expected 1 to 4"),
        ("wing_area_m2", "wing_area_m", 5, 16, "wing_area_m"),
        ("0.405", "zero", 6, 33, "float"),
        ("\"C750\"", "\" \"", 3, 19, "type_code is empty"),
        ("(0.10, 0.70, 0.05)", "(0.10, 0.72, 0.05)", 7, 49, "does not lead from 0.1 to 0.72"),
        (
            "(0.50, 0.95, 0.05)",
            "(0.50, 1.95, 0.05)",
            7,
            75,
            "Mach number 1.95 - outside 0.05 to 1.2",
        ),
        ("(0.50, 0.95, 0.05)", "(0.50, 0.95, 0.0001)", 7, 77, "4501 breakpoints, at most 1000"),
    ] {
        let (found_line, found_column, reason) = refused(&edited(from, to));
        assert_eq!((found_line, found_column), (line, column), "{to}: {reason}");
        assert!(reason.contains(words), "{reason}");
    }
    let (_, _, reason) = refused(&edited("engines: 2,", ""));
    assert!(reason.contains("engines"), "{reason}");
    let (_, _, reason) = refused(&edited("engines: 2,", "engines: 2, engines: 2,"));
    assert!(reason.contains("duplicate"), "{reason}");
    assert!(refused("").2.len() > 3);
}

#[test]
fn message_of_a_file_error() {
    let error =
        Aircraft::from_ron(&edited("wing_area_m2: 48.96", "wing_area_m2: 0.0")).unwrap_err();
    assert_eq!(error.to_string(), "line 5, column 22: wing area 0 m² outside 1 to 2000 m²");
}

#[test]
fn code_is_held_to_the_same_limits_as_text() {
    let file = Aircraft::from_ron(CITATION_X).unwrap().file().clone();
    let with = |edit: fn(&mut AircraftFile)| {
        let mut file = file.clone();
        edit(&mut file);
        Aircraft::new(file).unwrap_err()
    };
    assert!(matches!(with(|f| f.engines = 0), AircraftError::Engines { found: 0, .. }));
    assert!(matches!(with(|f| f.name.clear()), AircraftError::Text { field: "name" }));
    for edit in [
        (|f: &mut AircraftFile| f.wing_area_m2 = f64::NAN) as fn(&mut AircraftFile),
        |f| f.tsfc.static_lb_per_lbf_h = 40.5,
        |f| f.tsfc.mach_exponent = f64::INFINITY,
        |f| f.mean_aerodynamic_chord_m = Some(0.0),
        |f| f.drag_divergence_mach = Some(1.2),
        |f| f.reference_lhv_mj_kg = Some(18_400.0),
        |f| f.sensors.fuel_flow_percent = 0.0,
        |f| f.sensors.mach = -0.001,
        |f| f.sensors.static_air_temperature_k = 50.0,
        |f| f.sensors.acceleration_m_s2 = 1.0,
        |f| f.sensors.mass = MassDeviation::Percent(90.0),
        |f| f.sensors.mass = MassDeviation::Kilograms(-1.0),
        |f| f.sensors.lower_heating_value_percent = 11.0,
        |f| f.sensors.n2_percent = 0.0,
        |f| f.sensors.pressure_altitude_m = 600.0,
    ] {
        assert!(matches!(with(edit), AircraftError::OutOfDomain(_)));
    }
}

#[test]
fn a_round_trip_keeps_every_bit() {
    let text = edited("48.96", "48.9600000000000071")
        .replacen("1.05)", "1.1000000000000003)", 1)
        .replacen("engines: 2,", "engines: 2, drag_divergence_mach: 0.8600000000000001,", 1)
        .replacen("(0.50, 0.95, 0.05)", "[0.5, 0.6000000000000001, 0.95]", 1);
    let aircraft = Aircraft::from_ron(&text).unwrap();
    let written = aircraft.to_ron().unwrap();
    let again = Aircraft::from_ron(&written).unwrap();
    assert_eq!(again, aircraft);
    assert_eq!(again.to_ron().unwrap(), written);
    for (a, b) in [
        (aircraft.file().wing_area_m2, again.file().wing_area_m2),
        (aircraft.file().tsfc.mach_exponent, again.file().tsfc.mach_exponent),
        (aircraft.grid().y().breakpoints()[1], again.grid().y().breakpoints()[1]),
    ] {
        assert_eq!(a.to_bits(), b.to_bits());
    }
    assert!(written.contains("lift_coefficient: (0.1, 0.7, 0.05)"), "{written}");
}

#[test]
fn reads_as_a_part_of_another_file() {
    #[derive(Serialize, Deserialize)]
    struct Model {
        format: u32,
        aircraft: Aircraft,
    }
    let text = format!("(format: 1, aircraft: {CITATION_X})");
    let model: Model = ron::from_str(&text).unwrap();
    assert_eq!(model.aircraft, Aircraft::from_ron(CITATION_X).unwrap());
    let model: Model = ron::from_str(&ron::to_string(&model).unwrap()).unwrap();
    assert_eq!((model.format, model.aircraft), (1, Aircraft::from_ron(CITATION_X).unwrap()));
    let wrong = text.replace("48.96", "0");
    assert!(ron::from_str::<Model>(&wrong).is_err());
}

/// By definition of a file: what differs from the default is read back, and what does not is not written.
#[test]
fn sensors_are_written_and_read_back() {
    let drift = FuelFlowDrift { percent: 0.4, time_s: 900.0 };
    let of_air_data = AirDataDrift { share: 0.9, time_s: 900.0 };
    let bias = FlightBias { mach: 0.0, ..FlightBias::default() };
    for sensors in [
        SensorDeviations::default(),
        SensorDeviations { fuel_flow_drift: drift, ..SensorDeviations::default() },
        SensorDeviations { air_data_drift: of_air_data, ..SensorDeviations::default() },
        SensorDeviations { flight_bias: bias, ..SensorDeviations::default() },
    ] {
        let text = ron::to_string(&sensors).unwrap();
        assert_eq!(ron::from_str::<SensorDeviations>(&text).unwrap(), sensors, "{text}");
        let has_drift = sensors.fuel_flow_drift != FuelFlowDrift::default();
        assert_eq!(text.contains("fuel_flow_drift"), has_drift, "{text}");
        let air_data_drift = sensors.air_data_drift != AirDataDrift::default();
        assert_eq!(text.contains("air_data_drift"), air_data_drift, "{text}");
    }
    // More than all cannot drift.
    let error = ron::from_str::<SensorDeviations>("(air_data_drift: (share: 1.5))").unwrap_err();
    assert!(error.to_string().contains("share of the air data's variance that drifts"), "{error}");
}
