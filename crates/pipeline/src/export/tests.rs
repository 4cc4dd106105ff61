use perf_model::{Aircraft, Guide, initial_model};

use super::*;

fn model() -> ModelFile {
    let aircraft = Aircraft::from_ron(
        r#"(name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
            tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0),
            table: (lift_coefficient: (0.30, 0.60, 0.05), mach: (0.76, 0.88, 0.02)))"#,
    )
    .unwrap();
    let guide =
        Guide::from_csv(include_bytes!("../../../perf-model/tests/golden/guide.csv")).unwrap();
    ModelFile::from_initial(&initial_model(&aircraft, &guide).unwrap(), &guide)
}

/// The first basis is a polar at every Mach number: OpenAP's form misses nothing, and its coefficients are the
/// polynomial's own, p0 + p1·M + p2·M² and p3 + p4·M + p5·M².
#[test]
fn the_polar_of_a_polynomial_is_the_polynomial() {
    let model = model();
    let mach = 0.81;
    let polar = openap(&model, Some(mach)).unwrap();
    let p = model.initial.polynomial().coefficients;
    assert!((polar.cd0 - (p[0] + p[1] * mach + p[2] * mach * mach)).abs() < 1e-10);
    assert!((polar.k - (p[3] + p[4] * mach + p[5] * mach * mach)).abs() < 1e-9);
    assert!(polar.maximum_percent < 1e-6, "{}", polar.maximum_percent);
}

#[test]
fn no_polar_where_nothing_is_informed() {
    assert!(matches!(openap(&model(), Some(2.0)), Err(OpenapError::NotInformed { .. })));
}

/// Read by the standard library's parser, which is exact: that of `serde_json` may miss the last bit.
#[test]
fn the_json_holds_the_table_to_the_bit() {
    let model = model();
    let text = json(&model).unwrap();
    let table = text.split("\"drag_coefficient\": [").nth(1).unwrap();
    let numbers = table.lines().filter_map(|line| line.trim().trim_end_matches(',').parse().ok());
    let read: Vec<f64> = numbers.take(model.grid().nodes()).collect();
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&read), bits(model.drag_coefficient().values()));
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["schema"], SCHEMA);
    assert!(document["relative_std"].is_null());
}

#[test]
fn a_name_cannot_end_a_comment_of_the_xml() {
    let text = jsbsim(&model());
    assert_eq!(text.matches("<!--").count(), text.matches("-->").count());
    assert!(text.contains("0.36"), "CL 0.6 squared is a row");
}

/// A model that has learnt more than a table: every format that has comments or fields states what its table leaves out. The oracle is
/// what `predict` adds to the table at points inside its flights, which it cannot exceed by more than the points are fine.
#[test]
fn what_a_table_leaves_out_is_stated() {
    assert_eq!(remainder_left_out(&model()), None);
    let document: serde_json::Value = serde_json::from_str(&json(&model()).unwrap()).unwrap();
    assert!(document["remainder_left_out"].is_null());
    let whole = crate::prediction::tests::whole();
    let left_out = remainder_left_out(&whole).unwrap();
    let (rms, largest) = (left_out.rms_percent.unwrap(), left_out.largest_percent.unwrap());
    assert!(rms > 0.01 && largest > rms, "{left_out:?}");

    let baseline = whole.learnt.as_ref().unwrap().baseline.as_ref().unwrap();
    let middle = |variable| {
        let (low, high) = baseline.flown(variable).unwrap();
        f64::midpoint(low, high)
    };
    let point = perf_model::FlightPoint {
        isa_deviation: units::TemperatureDifference::kelvin(middle(
            effects::Variable::IsaDeviation,
        )),
        ..perf_model::FlightPoint::new(
            units::Mass::kilograms(middle(effects::Variable::Mass)),
            units::PressureAltitude::meters(middle(effects::Variable::PressureAltitude)),
            units::Mach::new(middle(effects::Variable::Mach)),
        )
    };
    let predictor =
        crate::prediction::Predictor::new(&whole, crate::whole_model::Predicts::WholeModel)
            .unwrap();
    let beside = predictor.at(&point).unwrap().beside_table.unwrap();
    assert!(!beside.beyond_flights);
    assert!(100.0 * beside.ln_fuel_flow.abs() < 1.1 * largest, "{beside:?} {left_out:?}");

    let document: serde_json::Value = serde_json::from_str(&json(&whole).unwrap()).unwrap();
    let stated = document["remainder_left_out"]["rms_percent"].as_f64().unwrap();
    assert!((stated / rms - 1.0).abs() < 1e-12, "{stated} {rms}");
    assert!(jsbsim(&whole).contains("left out"), "a comment");
    assert!(openap(&whole, None).unwrap().to_yaml().contains("left out"), "a comment");
    assert!(!openap(&model(), None).unwrap().to_yaml().contains("left out"));
}

/// Oracle: the rows of the guide at a node, by hand from both tables.
#[test]
fn what_the_polynomial_misses_of_the_rows_is_stated_until_a_segment_is_learnt() {
    let [rms, largest] = rows_missed(&model()).unwrap();
    let tables = (model().initial.drag_table().clone(), model().by_guide.unwrap());
    let inside = model().initial.extrapolated().iter().position(|beyond| !beyond).unwrap();
    let ratio = tables.0.value_at_node(inside) / tables.1.drag_table().value_at_node(inside);
    assert!(
        largest >= 100.0 * (ratio - 1.0).abs() && largest > rms && rms > 0.1,
        "{rms} {largest}"
    );
    assert_eq!(rows_missed(&crate::prediction::tests::whole()), None);
    assert_eq!(rows_missed(&ModelFile { by_guide: None, ..model() }), None);
}

/// A table that is the polynomial's own misses nothing; what law `paper` learnt node by node is no polynomial.
#[test]
fn the_miss_of_a_polynomial_is_that_of_its_nodes() {
    let miss = crate::model_table::polynomial_miss(&model()).unwrap();
    assert!(miss.maximum_percent < 1e-6, "{miss:?}");
    let learnt =
        ModelFile::from_text(include_str!("../../../../fixtures/global5000/expected/SIM-01.ron"))
            .unwrap();
    let miss = crate::model_table::polynomial_miss(&learnt).unwrap();
    assert!(miss.rms_percent > 0.01 && miss.maximum_percent > miss.rms_percent, "{miss:?}");
}
