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
