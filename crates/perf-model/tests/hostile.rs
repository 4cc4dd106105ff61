//! Arbitrary text: gives a value or an error, never a panic.

use perf_model::{Aircraft, FlightPoints, Guide, initial_model};
use proptest::prelude::*;

const AIRCRAFT: &str = r#"(
    name: "Cessna Citation X", type_code: "C750", engines: 2, wing_area_m2: 48.96,
    tsfc: (static_lb_per_lbf_h: 0.405, mach_exponent: 1.05),
    table: (lift_coefficient: (0.10, 0.70, 0.05), mach: [0.50, /* uneven */ 0.8, 0.95]),
    drag_divergence_mach: Some(0.86), sensors: (mass: Kilograms(80)),
)"#;

/// Pieces that RON and CSV treat in their own ways.
const PIECES: [&str; 18] = [
    "(",
    ")",
    "[",
    "]",
    "/*",
    "*/",
    "//",
    "\n",
    "\"",
    ",",
    "1e999",
    "-0",
    "NaN",
    "Some(",
    "None",
    "\u{feff}",
    "#![enable(implicit_some)]",
    "é",
];

/// The aircraft file with pieces put into it, and a part of it cut out.
fn edited_aircraft() -> impl Strategy<Value = String> {
    (0..AIRCRAFT.len(), 0..AIRCRAFT.len(), prop::sample::select(PIECES.to_vec())).prop_map(
        |(from, length, piece)| {
            let to = (from + length % 12).min(AIRCRAFT.len());
            format!("{}{piece}{}", &AIRCRAFT[..from], &AIRCRAFT[to..])
        },
    )
}

proptest! {
    #[test]
    fn aircraft_files(text in edited_aircraft(), noise in ".{0,60}") {
        if let Ok(aircraft) = Aircraft::from_ron(&text) {
            // What can be read can be written, and reads back as the same.
            let written = aircraft.to_ron().map_err(|error| TestCaseError::fail(error.to_string()))?;
            prop_assert_eq!(Aircraft::from_ron(&written), Ok(aircraft));
        }
        prop_assert!(Aircraft::from_ron(&noise).is_err());
    }

    #[test]
    fn bytes_as_guide_or_points(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        prop_assert!(Guide::from_csv(&bytes).is_err());
        prop_assert!(FlightPoints::from_csv(&bytes).is_err());
    }

    #[test]
    fn guides_of_any_fuel_flow_give_positive_drag_or_none(
        rows in prop::collection::vec((2e4..4e4_f64, 2e4..4.5e4_f64, 300.0..480.0_f64, 500.0..5e3_f64), 6..30),
    ) {
        let rows: Vec<String> = rows
            .iter()
            .map(|(weight, altitude, airspeed, flow)| format!("{weight},{altitude},{airspeed},{flow}"))
            .collect();
        let header = "weight_lb,pressure_altitude_ft,true_airspeed_kt,fuel_flow_lb_h";
        let text = format!("{header}\n{}", rows.join("\n"));
        let guide = Guide::from_csv(text.as_bytes())
            .map_err(|error| TestCaseError::fail(error.to_string()))?;
        let aircraft = Aircraft::from_ron(AIRCRAFT).map_err(|error| TestCaseError::fail(error.to_string()))?;
        if let Ok(initial) = initial_model(&aircraft, &guide) {
            prop_assert!(initial.model.drag_table().values().iter().all(|&value| value > 0.0));
        }
    }
}
