//! Holds JSON against the part of JSON Schema that the files in `docs/schemas` use: type, const, enum, properties,
//! required, additionalProperties and items. Any other keyword is a violation, so that none is ignored silently.

use serde_json::Value;

/// Asserts that a document is as the file of this name in `docs/schemas` says.
pub(crate) fn assert_held(schema: &str, document: &Value) {
    let path = crate::support::root().join("docs/schemas").join(schema);
    let schema: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let found = violations(&schema, document);
    assert!(found.is_empty(), "{found:#?}");
}

/// Every place in which `value` is not as `schema` says.
pub(crate) fn violations(schema: &Value, value: &Value) -> Vec<String> {
    let mut found = Vec::new();
    hold(schema, value, "$", &mut found);
    found
}

fn hold(schema: &Value, value: &Value, place: &str, found: &mut Vec<String>) {
    for (keyword, expected) in schema.as_object().into_iter().flatten() {
        let is_met = match keyword.as_str() {
            "$schema" | "title" | "description" | "properties" => true,
            "additionalProperties" if expected.is_object() => {
                for (name, other) in value.as_object().into_iter().flatten() {
                    if schema["properties"].get(name).is_none() {
                        hold(expected, other, &format!("{place}.{name}"), found);
                    }
                }
                true
            }
            "additionalProperties" => *expected == Value::Bool(false) && no_other(schema, value),
            "const" => value == expected,
            "enum" => expected.as_array().unwrap().contains(value),
            "type" => match expected {
                Value::Array(kinds) => kinds.iter().any(|kind| is_of(value, kind)),
                kind => is_of(value, kind),
            },
            "required" => expected
                .as_array()
                .unwrap()
                .iter()
                .all(|name| !value.is_object() || value.get(name.as_str().unwrap()).is_some()),
            "items" => {
                for (index, item) in value.as_array().into_iter().flatten().enumerate() {
                    hold(expected, item, &format!("{place}[{index}]"), found);
                }
                true
            }
            _ => false,
        };
        if !is_met {
            found.push(format!("{place}: {keyword} {expected}, found {value}"));
        }
    }
    for (name, inner) in schema["properties"].as_object().into_iter().flatten() {
        if let Some(value) = value.get(name) {
            hold(inner, value, &format!("{place}.{name}"), found);
        }
    }
}

fn no_other(schema: &Value, value: &Value) -> bool {
    value.as_object().is_none_or(|object| {
        object.keys().all(|name| schema["properties"].get(name.as_str()).is_some())
    })
}

fn is_of(value: &Value, kind: &Value) -> bool {
    match kind.as_str().unwrap() {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        _ => false,
    }
}

#[test]
fn what_is_wrong_is_found() {
    let schema: Value = serde_json::from_str(
        r#"{"type": "object", "additionalProperties": false, "required": ["a"],
            "properties": {"a": {"type": "array", "items": {"enum": [1, "x"]}}}}"#,
    )
    .unwrap();
    let of = |text: &str| violations(&schema, &serde_json::from_str(text).unwrap()).len();
    assert_eq!(of(r#"{"a": [1, "x"]}"#), 0);
    assert_eq!(of(r#"{"a": [2]}"#), 1);
    assert_eq!(of(r#"{"b": 1}"#), 2);
    // Of what is no object nothing is required but to be one.
    assert_eq!(of("[]"), 1);
    let counts = serde_json::json!({"additionalProperties": {"type": "integer"}});
    assert_eq!(violations(&counts, &serde_json::json!({"a": 1, "b": "x", "c": null})).len(), 2);
    assert_eq!(violations(&serde_json::json!({"maximum": 3}), &Value::from(4)).len(), 1);
}
