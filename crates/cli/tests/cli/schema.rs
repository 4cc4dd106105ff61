//! Documents against the JSON schemas in `docs/schema`, by the part of JSON Schema that those use.

use serde_json::Value;

/// Where a document breaks a schema, or a schema uses what is not checked here; empty where all is well.
pub(crate) fn breaches(document: &Value, schema: &Value) -> Vec<String> {
    let mut found = Vec::new();
    check(document, schema, schema, "", &mut found);
    found
}

const CHECKED: [&str; 14] = [
    "$schema",
    "$defs",
    "title",
    "description",
    "$ref",
    "anyOf",
    "const",
    "enum",
    "type",
    "properties",
    "required",
    "additionalProperties",
    "items",
    "minItems",
];

fn check(value: &Value, schema: &Value, root: &Value, at: &str, found: &mut Vec<String>) {
    for keyword in schema.as_object().unwrap().keys() {
        if !CHECKED.contains(&keyword.as_str()) && keyword != "maxItems" {
            found.push(format!("{at}: keyword {keyword} is not checked"));
        }
    }
    if let Some(reference) = schema.get("$ref") {
        let target = reference.as_str().unwrap().strip_prefix('#').unwrap();
        check(value, root.pointer(target).unwrap(), root, at, found);
    }
    if let Some(options) = schema.get("anyOf") {
        let fits = |option: &Value| {
            let mut inner = Vec::new();
            check(value, option, root, at, &mut inner);
            inner.is_empty()
        };
        if !options.as_array().unwrap().iter().any(fits) {
            found.push(format!("{at}: {value} fits none of {options}"));
        }
    }
    if schema.get("const").is_some_and(|expected| expected != value) {
        found.push(format!("{at}: {value} is not {}", schema["const"]));
    }
    if schema.get("enum").is_some_and(|all| !all.as_array().unwrap().contains(value)) {
        found.push(format!("{at}: {value} is not among {}", schema["enum"]));
    }
    let fits = schema.get("type").and_then(Value::as_str).is_none_or(|kind| match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "null" => value.is_null(),
        other => panic!("type {other} is not checked"),
    });
    if !fits {
        found.push(format!("{at}: {value} is no {}", schema["type"]));
    }
    check_members(value, schema, root, at, found);
}

fn check_members(value: &Value, schema: &Value, root: &Value, at: &str, found: &mut Vec<String>) {
    if let (Some(members), Some(properties)) = (value.as_object(), schema.get("properties")) {
        for (name, member) in members {
            match properties.get(name) {
                Some(of) => check(member, of, root, &format!("{at}/{name}"), found),
                None if schema.get("additionalProperties") == Some(&Value::Bool(false)) => {
                    found.push(format!("{at}: {name} is not in the schema"));
                }
                None => {}
            }
        }
        for name in schema.get("required").and_then(Value::as_array).into_iter().flatten() {
            if !members.contains_key(name.as_str().unwrap()) {
                found.push(format!("{at}: {name} is missing"));
            }
        }
    }
    if let Some(items) = value.as_array() {
        let count = items.len() as u64;
        let limit = |name: &str| schema.get(name).and_then(Value::as_u64);
        if limit("minItems").is_some_and(|least| count < least)
            || limit("maxItems").is_some_and(|most| count > most)
        {
            found.push(format!("{at}: {count} items"));
        }
        for (index, item) in items.iter().enumerate() {
            if let Some(of) = schema.get("items") {
                check(item, of, root, &format!("{at}/{index}"), found);
            }
        }
    }
}

/// A checker that finds nothing is seen to.
#[test]
fn breaches_are_found() {
    let schema: Value = serde_json::from_str(
        r##"{"type": "object", "required": ["a"], "additionalProperties": false,
             "properties": {"a": {"type": "array", "items": {"$ref": "#/$defs/n"}, "maxItems": 1}, "b": {"const": 1}},
             "$defs": {"n": {"anyOf": [{"type": "number"}, {"type": "null"}]}}}"##,
    )
    .unwrap();
    let count = |text: &str| breaches(&serde_json::from_str(text).unwrap(), &schema).len();
    assert_eq!(count(r#"{"a": [null], "b": 1}"#), 0);
    for wrong in [
        r#"{"b": 1}"#,
        r#"{"a": ["x"]}"#,
        r#"{"a": [1, 2]}"#,
        r#"{"a": [], "b": 2}"#,
        r#"{"a": [], "c": 1}"#,
        "[]",
    ] {
        assert_eq!(count(wrong), 1, "{wrong}");
    }
}
