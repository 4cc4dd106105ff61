use super::*;

fn three_samples(optional: OptionalColumns) -> ReportColumns {
    let of = |value: f64| vec![value; 3];
    ReportColumns {
        time_s: vec![0.0, 60.0, 120.0],
        pressure_altitude_m: of(11_000.0),
        static_air_temperature_k: None,
        mach: of(0.8),
        true_airspeed_m_s: of(236.0),
        ground_speed_m_s: of(236.0),
        roll_deg: None,
        drift_deg: None,
        n2_percent: None,
        fuel_flow: FuelFlowColumns::Total(of(0.5)),
        fuel_used_kg: of(600.0),
        optional,
    }
}

fn checked(column: Column, values: OptionalColumn) -> Result<(), ReportDataError> {
    check_columns(&three_samples([(column, values)].into_iter().collect()))
}

/// One to four engines, the same number in both columns, each with every sample.
#[test]
fn engines_that_do_not_fit_together_are_refused() {
    let engine = || vec![0.25; 3];
    let checked = |flows: usize, rotors: Option<usize>| {
        check_columns(&ReportColumns {
            fuel_flow: FuelFlowColumns::PerEngine((0..flows).map(|_| engine()).collect()),
            n2_percent: rotors.map(|rotors| (0..rotors).map(|_| engine()).collect()),
            ..three_samples(OptionalColumns::default())
        })
    };
    let refused =
        |column, found, expected| Err(ReportDataError::Engines { column, found, expected });
    for engines in 1..=4 {
        assert_eq!(checked(engines, None), Ok(()));
        assert_eq!(checked(engines, Some(engines)), Ok(()));
    }
    assert_eq!(checked(0, None), refused("fuel_flow", 0, "1 to 4"));
    assert_eq!(checked(5, None), refused("fuel_flow", 5, "1 to 4"));
    assert_eq!(checked(2, Some(0)), refused("n2_percent", 0, "1 to 4"));
    assert_eq!(checked(2, Some(5)), refused("n2_percent", 5, "1 to 4"));
    assert_eq!(checked(2, Some(3)), refused("n2_percent", 3, "as many as in fuel_flow"));
    let short = ReportColumns {
        n2_percent: Some(vec![engine(), vec![90.0; 2]]),
        ..three_samples(OptionalColumns::default())
    };
    let lengths = ReportDataError::LengthsDiffer { column: "n2_percent", found: 2, expected: 3 };
    assert_eq!(check_columns(&short), Err(lengths));
}

#[test]
fn the_first_number_that_is_none_is_named() {
    let infinite = f64::INFINITY;
    let columns = ReportColumns {
        mach: vec![0.8, infinite, infinite],
        ..three_samples(OptionalColumns::default())
    };
    let refused = ReportDataError::NotFinite { column: "mach", sample: 1, value: infinite };
    assert_eq!(check_columns(&columns), Err(refused));
}

#[test]
fn optional_columns_are_checked_like_the_others() {
    let values = || vec![Some(1.0), None, Some(2.0)];
    assert_eq!(checked(Column::N1(4), values()), Ok(()));
    let refused = ReportDataError::NotOptional { column: "MACH" };
    assert_eq!(checked(Column::Mach, values()), Err(refused));
    let refused = ReportDataError::Engines { column: "N1", found: 5, expected: "1 to 4" };
    assert_eq!(checked(Column::N1(5), values()), Err(refused));
    let refused = ReportDataError::LengthsDiffer { column: "CG", found: 2, expected: 3 };
    assert_eq!(checked(Column::CenterOfGravity, vec![None; 2]), Err(refused));
    let infinite = vec![None, Some(f64::INFINITY), None];
    let value = f64::INFINITY;
    let refused = ReportDataError::NotFinite { column: "LAT", sample: 1, value };
    assert_eq!(checked(Column::Latitude, infinite), Err(refused));
}
