//! Means of the conditions that a model has learnt from: what effects that grow from a reference are measured against.

use std::collections::BTreeMap;

use flight::{MAXIMUM_ENGINES, Segment};
use serde::{Deserialize, Serialize};
use units::{PressureAltitude, Temperature, TemperatureDifference};

/// A running mean.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// Mean over all segments that had the signal.
    pub mean: f64,
    /// Number of those segments.
    pub segments: u64,
}

/// Means by signal, the unit in the name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ConditionMeans(BTreeMap<String, Reference>);

/// Names of the engines' rotor speeds.
const N2_PERCENT: [&str; MAXIMUM_ENGINES] =
    ["n2_1_percent", "n2_2_percent", "n2_3_percent", "n2_4_percent"];

impl ConditionMeans {
    /// Adds a segment: Welford's running mean, so that learning in two runs gives the same bits as in one.
    pub fn add(&mut self, segment: &Segment, lift_coefficient: f64) {
        let means = &segment.means;
        self.add_value("mach", Some(means.mach));
        self.add_value("lift_coefficient", Some(lift_coefficient));
        self.add_value("pressure_altitude_m", Some(means.pressure_altitude_m));
        self.add_value("static_air_temperature_k", Some(means.static_air_temperature_k));
        let isa_deviation = atmos::isa::isa_deviation(
            PressureAltitude::meters(means.pressure_altitude_m),
            Temperature::kelvin(means.static_air_temperature_k),
        );
        self.add_value("isa_deviation_k", isa_deviation.ok().map(TemperatureDifference::to_kelvin));
        self.add_value("mass_kg", Some(means.mass_kg));
        self.add_value("fuel_used_kg", Some(means.fuel_used_kg));
        self.add_value("unix_days", Some(unix_days(segment)));
        self.add_value("cg_percent_mac", means.center_of_gravity_percent_mac);
        self.add_value("roll_deg", means.roll_deg);
        self.add_value("latitude_deg", means.latitude_deg);
        self.add_value("anti_ice", means.anti_ice);
        for (name, n2) in N2_PERCENT.iter().zip(&means.n2_percent) {
            self.add_value(name, Some(*n2));
        }
    }

    /// The mean of a signal, where any segment had it.
    pub fn mean(&self, signal: &str) -> Option<f64> {
        self.0.get(signal).map(|reference| reference.mean)
    }

    /// Adds the means of other segments.
    pub fn merge(&mut self, other: &Self) {
        for (name, theirs) in &other.0 {
            match self.0.get_mut(name) {
                Some(ours) => {
                    let segments = ours.segments + theirs.segments;
                    ours.mean +=
                        (theirs.mean - ours.mean) * theirs.segments as f64 / segments as f64;
                    ours.segments = segments;
                }
                None => {
                    self.0.insert(name.clone(), *theirs);
                }
            }
        }
    }

    /// All of them, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Reference)> {
        self.0.iter().map(|(name, reference)| (name.as_str(), reference))
    }

    fn add_value(&mut self, signal: &str, value: Option<f64>) {
        let Some(value) = value else { return };
        match self.0.get_mut(signal) {
            Some(reference) => {
                reference.segments += 1;
                reference.mean += (value - reference.mean) / reference.segments as f64;
            }
            None => {
                self.0.insert(signal.to_owned(), Reference { mean: value, segments: 1 });
            }
        }
    }
}

/// Days since 1970-01-01 UTC of the segment's mean instant.
fn unix_days(segment: &Segment) -> f64 {
    let start_s = segment.identity.start_s();
    (start_s + segment.means.time_s) / units::convert::SECONDS_PER_DAY
}
