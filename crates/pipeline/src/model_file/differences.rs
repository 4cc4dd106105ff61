//! In which fields two parts of model files differ.

use ron::ser::PrettyConfig;
use serde::Serialize;

/// A field, with those that it is in: `table.mach`; and its value as the file has it.
type Field = (String, String);

/// The fields in which a value differs from another, each as the file has it: "`sensors.mach: 0.001` against `sensors.mach: 0.002`",
/// or "no `drag_divergence_mach`" where one of the two does not state it.
pub(super) fn told_against<T: Serialize>(own: &T, other: &T) -> String {
    let (own, other) = (fields_of(own), fields_of(other));
    format!("{} against {}", only_in(&own, &other), only_in(&other, &own))
}

fn only_in(fields: &[Field], others: &[Field]) -> String {
    let value_of = |fields: &[Field], name: &str| {
        fields.iter().find(|(other, _)| other == name).map(|(_, value)| value.clone())
    };
    let own = fields
        .iter()
        .filter(|(name, value)| value_of(others, name).as_ref() != Some(value))
        .map(|(name, value)| format!("{name}: {value}"));
    let missing = others
        .iter()
        .filter(|(name, _)| value_of(fields, name).is_none())
        .map(|(name, _)| format!("no {name}"));
    own.chain(missing).collect::<Vec<_>>().join(", ")
}

/// Every field of a value. In the text each is a line, and one that has fields itself is opened and closed by lines.
fn fields_of<T: Serialize>(value: &T) -> Vec<Field> {
    // What cannot be written cannot have been read from a file either.
    let text = ron::ser::to_string_pretty(value, PrettyConfig::new().compact_arrays(true));
    let mut within: Vec<&str> = Vec::new();
    let mut fields = Vec::new();
    for line in text.as_deref().unwrap_or_default().lines() {
        let line = line.trim().trim_end_matches(',');
        let (name, value) = line.split_once(": ").unwrap_or(("", line));
        if line.ends_with('(') {
            within.push(name);
        } else if line.starts_with(')') {
            within.pop();
        } else {
            let path = within.iter().filter(|name| !name.is_empty()).chain([&name]).copied();
            fields.push((path.collect::<Vec<_>>().join("."), value.to_owned()));
        }
    }
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Outer {
        name: &'static str,
        axis: (f64, f64),
        breakpoints: Vec<f64>,
        inner: Option<Inner>,
        #[serde(skip_serializing_if = "Option::is_none")]
        mach: Option<f64>,
    }

    #[derive(Serialize)]
    struct Inner {
        mach: f64,
    }

    const fn outer(inner: f64, mach: Option<f64>) -> Outer {
        let inner = Some(Inner { mach: inner });
        Outer { name: "a: (", axis: (0.5, 0.95), breakpoints: Vec::new(), inner, mach }
    }

    #[test]
    fn fields_have_the_names_of_what_they_are_in() {
        let (one, other) = (outer(0.1, None), outer(0.2, None));
        assert_eq!(told_against(&one, &other), "inner.mach: 0.1 against inner.mach: 0.2");
        let stated = outer(0.1, Some(0.1));
        assert_eq!(told_against(&one, &stated), "no mach against mach: Some(0.1)");
        let wider = Outer { axis: (0.5, 0.96), breakpoints: vec![1.0, 2.0], ..outer(0.1, None) };
        assert_eq!(
            told_against(&one, &wider),
            "axis: (0.5, 0.95), breakpoints: [] against axis: (0.5, 0.96), breakpoints: [1.0, 2.0]"
        );
    }
}
