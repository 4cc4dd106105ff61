use super::*;

const AIRCRAFT: &str = r#"(
    name: "Synthetic Citation X", type_code: "C750", engines: 2, wing_area_m2: 48.96,
    tsfc: (static_lb_per_lbf_h: 0.3616, mach_exponent: 1.25),
    table: (lift_coefficient: (0.10, 0.70, 0.05), mach: (0.50, 0.95, 0.05)),
)"#;

/// A drag polar that the separable basis holds exactly.
fn polar(lift_coefficient: f64, mach: f64) -> f64 {
    0.03 - 0.02 * mach
        + 0.015 * mach * mach
        + (0.06 - 0.01 * mach + 0.02 * mach * mach) * lift_coefficient * lift_coefficient
}

/// A guide of the polar, from formulas written out here independently of the crate's.
fn guide(aircraft: &Aircraft, weights_lb: &[f64], altitudes_ft: &[f64], machs: &[f64]) -> Guide {
    let mut rows = Vec::new();
    for &weight_lb in weights_lb {
        for &altitude_ft in altitudes_ft {
            let height_m = altitude_ft * 0.3048;
            let temperature_k =
                if height_m < 11_000.0 { 288.15 - 0.0065 * height_m } else { 216.65 };
            let pressure_pa = if height_m < 11_000.0 {
                101_325.0 * (temperature_k / 288.15_f64).powf(9.80665 / (287.05287 * 0.0065))
            } else {
                22_632.06 * (-9.80665 * (height_m - 11_000.0) / (287.05287 * 216.65)).exp()
            };
            for &mach in machs {
                let force_n = 0.7 * pressure_pa * mach * mach * 48.96;
                let lift_coefficient = weight_lb * 0.45359237 * 9.80665 / force_n;
                let tsfc = aircraft.tsfc_law().static_tsfc.to_kilograms_per_newton_second()
                    * (temperature_k / 288.15).sqrt()
                    * (1.0 + mach).powf(1.25);
                let flow_lb_h =
                    force_n * polar(lift_coefficient, mach) * tsfc / 0.45359237 * 3600.0;
                let airspeed_kt = mach * (1.4 * 287.05287 * temperature_k).sqrt() * 3600.0 / 1852.0;
                rows.push([weight_lb, altitude_ft, airspeed_kt, flow_lb_h]);
            }
        }
    }
    guide_of(&rows)
}

/// A guide of these rows: weight in lb, pressure altitude in ft, true airspeed in kt, fuel flow in lb/h.
fn guide_of(rows: &[[f64; 4]]) -> Guide {
    let mut text = "weight_lb,pressure_altitude_ft,true_airspeed_kt,fuel_flow_lb_h".to_owned();
    for row in rows {
        let fields = row.map(|number| number.to_string());
        text.push('\n');
        text.push_str(&fields.join(","));
    }
    Guide::from_csv(text.as_bytes()).unwrap()
}

/// The same guide with every fuel flow times a factor.
fn scaled(guide: &Guide, factor: impl Fn(&GuidePoint) -> f64) -> Guide {
    let rows: Vec<[f64; 4]> = guide
        .points()
        .iter()
        .map(|point| {
            [
                point.mass.to_pounds(),
                point.pressure_altitude.to_feet(),
                point.true_airspeed.to_knots(),
                point.fuel_flow_total.to_pounds_per_hour() * factor(point),
            ]
        })
        .collect();
    guide_of(&rows)
}

fn aircraft(polynomial: &str) -> Aircraft {
    let text = AIRCRAFT.replace("engines: 2,", &format!("engines: 2, polynomial: {polynomial},"));
    Aircraft::from_ron(&text).unwrap()
}

const WEIGHTS_LB: [f64; 3] = [26_000.0, 31_000.0, 36_000.0];
const ALTITUDES_FT: [f64; 4] = [30_000.0, 37_000.0, 41_000.0, 45_000.0];
const MACHS: [f64; 4] = [0.60, 0.70, 0.76, 0.82];

#[test]
fn the_polynomial_behind_a_guide_comes_back() {
    let aircraft = aircraft("SeparableQuadratic");
    let guide = guide(&aircraft, &WEIGHTS_LB, &ALTITUDES_FT, &MACHS);
    let initial = initial_model(&aircraft, &guide).unwrap();
    for (coefficient, truth) in
        initial.model.polynomial().coefficients.iter().zip([0.03, -0.02, 0.015, 0.06, -0.01, 0.02])
    {
        assert!((coefficient - truth).abs() < 1e-6, "{:?}", initial.model.polynomial());
    }
    assert!(initial.fit.residual_rms_percent < 1e-4, "{:?}", initial.fit);
    assert_eq!(
        (initial.fit.points, initial.fit.weights, initial.fit.pressure_altitudes),
        (48, 3, 4)
    );
    assert!(initial.fit.amplification < 4.0, "{:?}", initial.fit);
    let table = initial.model.drag_table();
    let cell = table.grid().locate(0.4, 0.8, lut::Outside::Error).unwrap();
    assert!((table.interpolate(&cell) - polar(0.4, 0.8)).abs() < 1e-7);
}

#[test]
fn the_second_basis_by_hand() {
    // The second basis cannot hold the separable polar's Mach-dependent CL²; a polar that it can hold: CL²·0.05 + 0.02.
    // 1, M, CL, M², M·CL, CL² in this order.
    let aircraft = aircraft("FullQuadratic");
    let guide = guide(&aircraft, &WEIGHTS_LB, &ALTITUDES_FT, &MACHS);
    let initial = initial_model(&aircraft, &guide).unwrap();
    let polynomial = initial.model.polynomial();
    assert_eq!(polynomial.basis, lut::surface::Basis::FullQuadratic);
    let [p0, p1, p2, p3, p4, p5] = polynomial.coefficients;
    let (lift_coefficient, mach) = (0.35, 0.75);
    let by_hand = p0
        + p1 * mach
        + p2 * lift_coefficient
        + p3 * mach * mach
        + p4 * mach * lift_coefficient
        + p5 * lift_coefficient * lift_coefficient;
    assert!((polynomial.value(lift_coefficient, mach) - by_hand).abs() < 1e-15);
    let node = initial.model.drag_table().grid().coordinates(55);
    let at_node = initial.model.drag_table().value_at_node(55);
    assert!((polynomial.value(node.0, node.1) - at_node).abs() < 1e-15);
    // It follows the other basis' polar to within a per cent, but not exactly.
    assert!((1e-3..2.0).contains(&initial.fit.residual_rms_percent), "{:?}", initial.fit);
    assert!((by_hand / polar(lift_coefficient, mach) - 1.0).abs() < 0.02);
}

#[test]
fn nodes_outside_the_guides_range_are_marked() {
    let aircraft = aircraft("SeparableQuadratic");
    let guide = guide(&aircraft, &WEIGHTS_LB, &ALTITUDES_FT, &MACHS);
    let initial = initial_model(&aircraft, &guide).unwrap();
    let (low, high) = initial.fit.lift_coefficients;
    for (node, &mark) in initial.model.extrapolated().iter().enumerate() {
        let (lift_coefficient, mach) = aircraft.grid().coordinates(node);
        // 0.60 is a Mach number of the guide and a breakpoint: inside, whatever the last bit.
        let inside = (low..=high).contains(&lift_coefficient) && (0.5999..=0.8201).contains(&mach);
        assert_eq!(mark, !inside, "{lift_coefficient} {mach}");
    }
    let finding = &initial.findings[0];
    assert_eq!(finding.code, "guide-extrapolated-nodes");
    assert_eq!(finding.severity, flight::Severity::Note);
    assert!(
        finding.message.starts_with(&format!("{} of 130 nodes", initial.fit.extrapolated_nodes))
    );
}

#[test]
fn one_altitude_is_enough_with_several_weights_and_says_so() {
    let aircraft = aircraft("SeparableQuadratic");
    let guide = guide(&aircraft, &WEIGHTS_LB, &[41_000.0], &MACHS);
    let initial = initial_model(&aircraft, &guide).unwrap();
    let codes: Vec<_> = initial.findings.iter().map(|finding| finding.code).collect();
    assert_eq!(codes[0], "guide-one-pressure-altitude", "{codes:?}");
    assert!(initial.findings[0].message.contains("41000 ft"));
}

#[test]
fn one_weight_at_one_altitude_is_refused_in_words() {
    for basis in ["SeparableQuadratic", "FullQuadratic"] {
        let aircraft = aircraft(basis);
        let machs: Vec<f64> = (0..20).map(|i| 0.6 + 0.012 * f64::from(i)).collect();
        let guide = guide(&aircraft, &[30_000.0], &[41_000.0], &machs);
        let error = initial_model(&aircraft, &guide).unwrap_err();
        let InitialModelError::PoorlyDetermined {
            amplification, weights, pressure_altitudes, ..
        } = error
        else {
            panic!("{error}")
        };
        assert_eq!((weights, pressure_altitudes), (1, 1));
        assert!(amplification > 1e4, "{error}");
        assert!(
            error.to_string().contains("1 different weights and 1 different pressure altitudes")
        );
    }
}

#[test]
fn guides_that_leave_a_direction_open_are_refused_in_words() {
    let aircraft = aircraft("SeparableQuadratic");
    let refused = |weights: &[f64], altitudes: &[f64], machs: &[f64]| {
        initial_model(&aircraft, &guide(&aircraft, weights, altitudes, machs)).unwrap_err()
    };
    let error = refused(&[30_000.0], &[41_000.0], &MACHS);
    assert_eq!(error, InitialModelError::TooFewPoints { found: 4, needed: 6 });
    assert_eq!(error.to_string(), "4 rows do not determine the polynomial's 6 coefficients");
    let error = refused(&WEIGHTS_LB, &ALTITUDES_FT, &[0.8]);
    assert!(
        error.to_string().starts_with(
            "the guide does not determine the polynomial: all rows fly at Mach number 0.8000, 3 different ones are needed (rank 2 of 6"
        ),
        "{error}"
    );
    let error = refused(&WEIGHTS_LB, &ALTITUDES_FT, &[0.7, 0.8]);
    assert!(
        error.to_string().contains("fly at 2 different Mach numbers, 3 are needed (rank 4"),
        "{error}"
    );
}

#[test]
fn a_table_far_outside_the_guide_has_no_negative_drag() {
    // A guide whose drag falls towards low Mach numbers as 1 − 8 (M − 0.82)²: at Mach 0.25 that is −1.6.
    let aircraft = Aircraft::from_ron(&AIRCRAFT.replace("mach: (0.50,", "mach: (0.25,")).unwrap();
    let healthy = guide(&aircraft, &WEIGHTS_LB, &[41_000.0, 45_000.0], &MACHS);
    let odd = scaled(&healthy, |row| 1.0 - 8.0 * (row.mach().unwrap().value() - 0.82).powi(2));
    let error = initial_model(&aircraft, &odd).unwrap_err();
    let InitialModelError::DragNotPositive { extrapolated, drag_coefficient, .. } = error else {
        panic!("{error}")
    };
    assert!(extrapolated && drag_coefficient <= 0.0);
    let text = error.to_string();
    assert!(text.contains("0.820): narrow the table") && text.contains("metres"), "{text}");
}

#[test]
fn a_mistyped_row_is_pointed_at() {
    let aircraft = aircraft("SeparableQuadratic");
    let healthy = guide(&aircraft, &WEIGHTS_LB, &ALTITUDES_FT, &MACHS);
    let typo = scaled(&healthy, |row| if row.line == 20 { 1.1 } else { 1.0 });
    let initial = initial_model(&aircraft, &typo).unwrap();
    let odd = initial.findings.iter().find(|finding| finding.code == "guide-odd-row").unwrap();
    assert_eq!(odd.line, Some(20));
}

fn finding(initial: &InitialModel, code: &str) -> Option<(flight::Severity, String)> {
    let found = initial.findings.iter().find(|finding| finding.code == code)?;
    Some((found.severity, found.message.clone()))
}

/// A table that lies above the guide's Mach numbers, 0.82 at most, is extrapolated as a whole: that is more than a note.
#[test]
fn a_table_that_is_all_extrapolated_is_a_warning() {
    let guide = guide(&aircraft("SeparableQuadratic"), &WEIGHTS_LB, &ALTITUDES_FT, &MACHS);
    let beyond = AIRCRAFT.replace("mach: (0.50, 0.95,", "mach: (0.85, 0.95,");
    let initial = initial_model(&Aircraft::from_ron(&beyond).unwrap(), &guide).unwrap();
    let (severity, message) = finding(&initial, "guide-extrapolated-nodes").unwrap();
    assert!(message.starts_with("39 of 39 nodes"), "{message}");
    assert_eq!(severity, flight::Severity::Warning);
}

/// By hand: flow times a factor is drag times it, the lift-to-drag ratio divided by it. The polar's is 11.7 in the median of the
/// guide's rows: 0.45 times the flow (kg/h under lb/h) makes 26.1, which is too high, twice the flow 5.9, which is too low,
/// and each has its own causes.
#[test]
fn a_lift_to_drag_ratio_has_causes_on_either_side() {
    let aircraft = aircraft("SeparableQuadratic");
    let healthy = guide(&aircraft, &WEIGHTS_LB, &ALTITUDES_FT, &MACHS);
    let cause = |factor: f64| {
        let initial = initial_model(&aircraft, &scaled(&healthy, |_| factor)).unwrap();
        finding(&initial, "guide-lift-to-drag").map(|(_, message)| message)
    };
    assert_eq!(cause(1.0), None);
    let high = cause(0.45).unwrap();
    assert!(high.contains("ratio of 26.1") && high.contains("flow in kg/h under lb/h"), "{high}");
    let low = cause(2.0).unwrap();
    assert!(low.contains("ratio of 5.87") && low.contains("mass in kg under weight_lb"), "{low}");
}

/// A light jet's ratio is half of an airliner's, so that half its flow makes an airliner's ratio; its drag coefficient is then no
/// aircraft's. By hand: of the polar 11.7 and 0.033 in the median; 0.51 of the flow makes 23.0, which is an airliner's, and 0.0167.
#[test]
fn half_the_flow_of_a_light_jet_shows_in_its_drag_coefficient() {
    let aircraft = aircraft("SeparableQuadratic");
    let light_jet = guide(&aircraft, &WEIGHTS_LB, &ALTITUDES_FT, &MACHS);
    let found = |factor: f64| {
        let initial = initial_model(&aircraft, &scaled(&light_jet, |_| factor)).unwrap();
        ["guide-lift-to-drag", "guide-drag-coefficient"].map(|code| finding(&initial, code))
    };
    assert_eq!(found(1.0), [None, None]);
    let [ratio, drag] = found(0.51);
    assert_eq!(ratio, None);
    let (severity, message) = drag.unwrap();
    assert_eq!(severity, flight::Severity::Serious, "{message}");
    assert!(message.contains("fuel flow of one engine as total"), "{message}");
}

/// By hand: rows that all scatter by ±2 % have none that is five times as far off as the others, and a single row off by 0.5 %
/// is within how guides are rounded.
#[test]
fn scattered_and_rounded_rows_are_not_mistyped() {
    let aircraft = aircraft("SeparableQuadratic");
    let healthy = guide(&aircraft, &WEIGHTS_LB, &ALTITUDES_FT, &MACHS);
    let scattered = scaled(&healthy, |row| if row.line % 2 == 0 { 1.02 } else { 0.98 });
    let initial = initial_model(&aircraft, &scattered).unwrap();
    assert!(initial.fit.worst_row.1.abs() > 1.0, "{:?}", initial.fit);
    assert_eq!(finding(&initial, "guide-odd-row"), None);

    let rounded = scaled(&healthy, |row| if row.line == 20 { 1.005 } else { 1.0 });
    let initial = initial_model(&aircraft, &rounded).unwrap();
    let (line, percent) = initial.fit.worst_row;
    assert_eq!(line, 20);
    assert!(percent.abs() > 5.0 * initial.fit.residual_rms_percent, "{:?}", initial.fit);
    assert_eq!(finding(&initial, "guide-odd-row"), None);
}

/// The oracle is the polar at the four nodes about each row of the guide, bilinear by hand.
#[test]
fn a_table_of_large_steps_is_told() {
    let told = |aircraft: &str| {
        let aircraft = Aircraft::from_ron(aircraft).unwrap();
        let guide = guide(&aircraft, &WEIGHTS_LB, &ALTITUDES_FT, &MACHS);
        let initial = super::initial_model(&aircraft, &guide).unwrap();
        let found = initial.findings.into_iter().find(|one| one.code == "guide-coarse-table");
        let rows =
            guide.points().iter().map(|point| observe_guide_point(&aircraft, point).unwrap());
        (found.map(|one| one.message), rows.collect::<Vec<_>>())
    };
    assert_eq!(told(AIRCRAFT).0, None);
    let (found, rows) = told(&AIRCRAFT.replace("(0.50, 0.95, 0.05)", "(0.50, 0.90, 0.4)"));
    let off: Vec<f64> = rows
        .iter()
        .filter(|row| (0.10..=0.70).contains(&row.lift_coefficient) && row.mach <= 0.90)
        .map(|row| {
            let low = 0.10 + 0.05 * ((row.lift_coefficient - 0.10) / 0.05).floor();
            let (u, v) = ((row.lift_coefficient - low) / 0.05, (row.mach - 0.50) / 0.4);
            let along = |mach: f64| (1.0 - u) * polar(low, mach) + u * polar(low + 0.05, mach);
            let chord = (1.0 - v) * along(0.50) + v * along(0.90);
            100.0 * (chord / polar(row.lift_coefficient, row.mach) - 1.0)
        })
        .collect();
    let rms = (off.iter().map(|one| one * one).sum::<f64>() / off.len() as f64).sqrt();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let message = found.unwrap();
    assert!(message.contains(&format!("the table is {rms:.1} % of drag off")), "{rms} {message}");
    assert!(message.contains(&format!("mean {mean:+.1} %")), "{mean} {message}");
}
