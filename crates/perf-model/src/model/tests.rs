use std::sync::Arc;

use lut::surface::Basis;
use units::{FuelFlowTotal, Mach, Mass, PressureAltitude, TemperatureDifference};

use super::*;
use crate::FlightPoint;
use crate::variance::tests::segment;

/// The synthetic Citation X whose outputs are published: static TSFC 1.0242e-5 kg/(N s), exponent 1.25, 48.96 m².
pub(super) fn citation_x() -> PerformanceModel {
    let aircraft = Aircraft::from_ron(
        r#"(
            name: "Synthetic Citation X", type_code: "C750", engines: 2, wing_area_m2: 48.96,
            tsfc: (static_lb_per_lbf_h: 0.3615865, mach_exponent: 1.25),
            table: (lift_coefficient: (0.10, 0.60, 0.001), mach: (0.50, 0.92, 0.001)),
        )"#,
    )
    .unwrap();
    let drag = |lift_coefficient: f64, mach: f64| {
        let critical = 0.915 - 0.09 * (lift_coefficient - 0.3) - 0.1077;
        0.0206 * (1.0 + 0.10 * (mach - 0.6).max(0.0))
            + 0.060 * (1.0 + 0.5 * (mach - 0.6).max(0.0).powi(2)) * lift_coefficient.powi(2)
            + 20.0 * (mach - critical).max(0.0).powi(4)
    };
    let grid = aircraft.grid();
    let values = (0..grid.nodes())
        .map(|node| grid.coordinates(node))
        .map(|(lift_coefficient, mach)| drag(lift_coefficient, mach))
        .collect();
    let table = Table::new(Arc::clone(grid), values).unwrap();
    let polynomial = Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] };
    let marks = vec![false; grid.nodes()];
    PerformanceModel::new(aircraft, polynomial, table, marks).unwrap()
}

fn point(weight_lb: f64, flight_level: f64, mach: f64) -> FlightPoint {
    FlightPoint::new(
        Mass::pounds(weight_lb),
        PressureAltitude::feet(100.0 * flight_level),
        Mach::new(mach),
    )
}

#[test]
fn published_outputs_of_a_synthetic_citation_x() {
    // Weight lb, flight level, Mach | lift coefficient, drag coefficient, L/D, TAS kt, fuel flow lb/h, nm/lb as printed.
    let printed = [
        (30_000.0, 430.0, 0.82, 0.357, 0.0289, 12.4, 470.0, 1610.0, 0.292),
        (30_000.0, 410.0, 0.82, 0.324, 0.0275, 11.8, 470.0, 1688.0, 0.279),
        (30_000.0, 410.0, 0.88, 0.281, 0.0266, 10.6, 505.0, 1959.0, 0.258),
        (34_000.0, 430.0, 0.86, 0.368, 0.0298, 12.4, 493.0, 1875.0, 0.263),
        (32_000.0, 370.0, 0.90, 0.237, 0.0259, 9.1, 516.0, 2447.0, 0.211),
        (30_000.0, 350.0, 0.75, 0.290, 0.0260, 11.2, 432.0, 1705.0, 0.254),
        (30_000.0, 250.0, 0.60, 0.288, 0.0256, 11.3, 361.0, 1579.0, 0.229),
        (26_000.0, 490.0, 0.80, 0.433, 0.0325, 13.3, 459.0, 1275.0, 0.360),
    ];
    let model = citation_x();
    for (weight_lb, level, mach, lift, drag, ratio, airspeed, flow, range) in printed {
        let prediction = model.predict(&point(weight_lb, level, mach)).unwrap();
        let row = format!("{weight_lb} lb FL{level} M{mach}: {prediction:?}");
        // Half a unit of the last printed digit, and one of fuel flow.
        assert!((prediction.lift_coefficient - lift).abs() < 0.0006, "{row}");
        assert!((prediction.drag_coefficient - drag).abs() < 0.00006, "{row}");
        let lift_to_drag = prediction.lift_coefficient / prediction.drag_coefficient;
        assert!((lift_to_drag - ratio).abs() < 0.06, "{row}");
        assert!((prediction.true_airspeed.to_knots() - airspeed).abs() < 0.6, "{row}");
        assert!((prediction.fuel_flow_total.to_pounds_per_hour() - flow).abs() < 1.0, "{row}");
        let nautical_miles = prediction.specific_range.to_nautical_miles_per_pound();
        assert!((nautical_miles - range).abs() < 0.0006, "{row}");
    }
}

#[test]
fn temperature_moves_airspeed_and_fuel_flow_by_its_root() {
    let model = citation_x();
    let standard = model.predict(&point(30_000.0, 410.0, 0.8)).unwrap();
    let warm = FlightPoint {
        isa_deviation: TemperatureDifference::kelvin(10.0),
        ..point(30_000.0, 410.0, 0.8)
    };
    let warm = model.predict(&warm).unwrap();
    // Dynamic pressure is γpM²/2 whatever the temperature, so CL and CD stay; √(226.65/216.65) = 1.022 818.
    assert!((warm.lift_coefficient - standard.lift_coefficient).abs() < 1e-12);
    let root = (226.65_f64 / 216.65).sqrt();
    assert!((warm.fuel_flow_total / standard.fuel_flow_total - root).abs() < 1e-6);
    assert!((warm.true_airspeed / standard.true_airspeed - root).abs() < 1e-6);
}

#[test]
fn a_measured_fuel_flow_gives_an_error() {
    let model = citation_x();
    let mut point = point(30_000.0, 430.0, 0.82);
    assert_eq!(model.predict(&point).unwrap().error_percent, None);
    let predicted = model.predict(&point).unwrap().fuel_flow_total;
    point.measured_fuel_flow_total = Some(predicted * 1.25);
    // (1.25 − 1)/1.25 = 20 %.
    assert!((model.predict(&point).unwrap().error_percent.unwrap() - 20.0).abs() < 1e-9);
}

#[test]
fn outside_the_table_there_is_no_prediction() {
    let model = citation_x();
    // p = 37 601 Pa, q = 0.7·p·0.45² = 5330 Pa: 133 447 N/(5330 Pa · 48.96 m²) = 0.5114.
    let error = model.predict(&point(30_000.0, 250.0, 0.45)).unwrap_err();
    assert!(matches!(error, PredictError::OutsideTable(_)));
    assert_eq!(
        error.to_string(),
        "lift coefficient 0.5114, Mach number 0.4500 outside the table's lift coefficients 0.1 to 0.6 and Mach numbers 0.5 to 0.92"
    );
    let error = model.predict(&point(30_000.0, 700.0, 0.8)).unwrap_err();
    assert!(matches!(error, PredictError::OutOfDomain(_)), "{error}");
    for broken in
        [point(0.0, 410.0, 0.8), point(f64::NAN, 410.0, 0.8), point(30_000.0, 410.0, f64::NAN)]
    {
        assert!(matches!(model.predict(&broken), Err(PredictError::OutOfDomain(_))));
    }
}

#[test]
fn extrapolated_is_said_when_a_marked_node_takes_part_and_only_then() {
    let aircraft = Aircraft::from_ron(
        r#"(
            name: "test", type_code: "TEST", engines: 2, wing_area_m2: 48.96,
            tsfc: (static_lb_per_lbf_h: 0.36, mach_exponent: 1.25),
            table: (lift_coefficient: [0.1, 0.4, 0.7], mach: [0.5, 0.8, 0.9]),
        )"#,
    )
    .unwrap();
    let table = Table::new(Arc::clone(aircraft.grid()), vec![0.03; 9]).unwrap();
    let polynomial = Surface { basis: Basis::FullQuadratic, coefficients: [0.0; 6] };
    let mut marks = vec![false; 9];
    marks[2] = true; // CL 0.1, Mach 0.9
    let model = PerformanceModel::new(aircraft, polynomial, table, marks).unwrap();
    let uses =
        |weight_lb, mach| model.predict(&point(weight_lb, 410.0, mach)).unwrap().extrapolated;
    assert!(uses(30_000.0, 0.85)); // CL 0.30, the cell below Mach 0.9
    assert!(!uses(30_000.0, 0.8)); // on the grid line of Mach 0.8: the marked node has weight 0
    assert!(!uses(30_000.0, 0.7));
    assert!(!uses(50_000.0, 0.85)); // CL 0.50: the cell above
}

#[test]
fn an_observation_of_a_segment_and_its_error() {
    let model = citation_x();
    let mut recorded = segment();
    recorded.means.mass_kg = 13_600.0;
    recorded.means.fuel_flow_total_kg_s = 0.22;
    let observation = model.observe(&recorded).unwrap();
    let prediction = model.predict_segment(&recorded, model.drag_table()).unwrap();
    assert_eq!(observation.time.to_string(), "2018-05-20T14:23:51.25Z");
    let state = model.state_of(&recorded).unwrap();
    assert!((observation.drag_coefficient - state.drag_coefficient).abs() < 1e-18);
    // ε from the observation alone, as the adaptation uses it.
    let error_percent = 100.0
        * observation.fuel_flow_per_drag_coefficient_kg_s
        * (observation.drag_coefficient - prediction.drag_coefficient)
        / observation.fuel_flow_total_kg_s;
    assert!((error_percent - prediction.error_percent).abs() < 1e-9);
    assert!(!prediction.extrapolated);
}

#[test]
fn segments_that_are_no_observation_say_why() {
    let model = citation_x();
    let refused = |edit: fn(&mut flight::SegmentMeans)| {
        let mut segment = segment();
        segment.means.mass_kg = 13_600.0;
        edit(&mut segment.means);
        model.observe(&segment).unwrap_err()
    };
    assert!(matches!(refused(|means| means.mach = 0.93), ObserveError::OutsideTable(_)));
    assert!(matches!(refused(|means| means.mass_kg = 40_000.0), ObserveError::OutsideTable(_)));
    assert!(matches!(refused(|means| means.mass_kg = f64::NAN), ObserveError::OutOfDomain(_)));
    assert!(matches!(
        refused(|means| means.static_air_temperature_k = 0.0),
        ObserveError::OutOfDomain(_)
    ));
    let error = refused(|means| means.acceleration_m_s2 = 5.0);
    assert!(matches!(error, ObserveError::DragNotPositive { .. }), "{error}");
    assert!(error.to_string().contains("acceleration takes 68000 N"), "{error}");
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let model = citation_x();
    let mut table = model.drag_table().clone();
    table.values_mut()[3] = 0.0;
    let error = model.with_drag_table(table.clone()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "drag coefficient 0 at lift coefficient 0.1, Mach number 0.503 is not positive"
    );
    table.values_mut()[3] = f64::NAN;
    assert!(model.with_drag_table(table).is_err());
    let other = Arc::new(Grid::new(
        lut::Axis::new(vec![0.1, 0.6]).unwrap(),
        lut::Axis::new(vec![0.5, 0.92]).unwrap(),
    ));
    let other = Table::new(other, vec![0.03; 4]).unwrap();
    assert_eq!(model.with_drag_table(other.clone()), Err(ModelError::GridDiffers));
    assert_eq!(model.predict_segment(&segment(), &other).unwrap_err(), PredictError::GridDiffers);
    let with = |coefficients: [f64; 6], marks: usize| {
        PerformanceModel::new(
            model.aircraft().clone(),
            Surface { basis: Basis::FullQuadratic, coefficients },
            model.drag_table().clone(),
            vec![false; marks],
        )
        .unwrap_err()
    };
    assert!(matches!(with([0.0; 6], 7), ModelError::ExtrapolatedLength { found: 7, .. }));
    let nodes = model.aircraft().grid().nodes();
    assert!(matches!(
        with([0.0, 0.0, f64::NAN, 0.0, 0.0, 0.0], nodes),
        ModelError::CoefficientNotFinite { index: 2, .. }
    ));
}

#[test]
fn an_adapted_table_predicts_what_it_says() {
    // Drag 6 % up is fuel 6 % up: the table cannot distinguish it from an engine that burns 6 % more.
    let model = citation_x();
    let mut table = model.drag_table().clone();
    table.values_mut().iter_mut().for_each(|value| *value *= 1.06);
    let adapted = model.with_drag_table(table).unwrap();
    let at = point(30_000.0, 430.0, 0.82);
    let before: FuelFlowTotal = model.predict(&at).unwrap().fuel_flow_total;
    let after = adapted.predict(&at).unwrap().fuel_flow_total;
    assert!((after / before - 1.06).abs() < 1e-12);
}
