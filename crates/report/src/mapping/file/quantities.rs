//! Quantities by name.

use core::fmt;

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};

use super::QuantitySource;

/// A RON map by name that refuses a repeated name; `BTreeMap` would silently keep the last.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::mapping) struct Quantities(pub(in crate::mapping) Vec<(String, QuantitySource)>);

impl<'de> Deserialize<'de> for Quantities {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(QuantitiesVisitor)
    }
}

struct QuantitiesVisitor;

impl<'de> Visitor<'de> for QuantitiesVisitor {
    type Value = Quantities;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map from the names of report columns to where they come from")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Quantities, A::Error> {
        let mut quantities: Vec<(String, QuantitySource)> = Vec::new();
        while let Some((name, source)) = map.next_entry::<String, QuantitySource>()? {
            if quantities.iter().any(|(other, _)| *other == name) {
                return Err(serde::de::Error::custom(format_args!("{name} appears twice")));
            }
            quantities.push((name, source));
        }
        Ok(Quantities(quantities))
    }
}
