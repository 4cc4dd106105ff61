//! Means of the conditions that a model has learnt from: what effects that grow from a reference are measured against.

use std::collections::BTreeMap;

use flight::{MAXIMUM_ENGINES, Segment};
use perf_model::FlightPoint;
use serde::{Deserialize, Serialize};
use units::{Mach, Mass, PressureAltitude, Temperature, TemperatureDifference};

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

/// Signals whose means are kept; those of the engines are the last.
const SIGNALS: [&str; 12 + MAXIMUM_ENGINES] = [
    "mach",
    "lift_coefficient",
    "pressure_altitude_m",
    "static_air_temperature_k",
    "isa_deviation_k",
    "mass_kg",
    "fuel_used_kg",
    "unix_days",
    "cg_percent_mac",
    "roll_deg",
    "latitude_deg",
    "anti_ice",
    "n2_1_percent",
    "n2_2_percent",
    "n2_3_percent",
    "n2_4_percent",
];

/// The signals of a segment, as far as it has them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Conditions([Option<f64>; SIGNALS.len()]);

impl Conditions {
    /// Of a segment with this lift coefficient.
    pub(crate) fn of(segment: &Segment, lift_coefficient: f64) -> Self {
        let means = &segment.means;
        let isa_deviation = atmos::isa::isa_deviation(
            PressureAltitude::meters(means.pressure_altitude_m),
            Temperature::kelvin(means.static_air_temperature_k),
        );
        let n2 = |engine: usize| means.n2_percent.get(engine).copied();
        Self([
            Some(means.mach),
            Some(lift_coefficient),
            Some(means.pressure_altitude_m),
            Some(means.static_air_temperature_k),
            isa_deviation.ok().map(TemperatureDifference::to_kelvin),
            Some(means.mass_kg),
            Some(means.fuel_used_kg),
            Some(unix_days(segment)),
            means.center_of_gravity_percent_mac,
            means.roll_deg,
            means.latitude_deg,
            means.anti_ice,
            n2(0),
            n2(1),
            n2(2),
            n2(3),
        ])
    }
}

impl ConditionMeans {
    /// The flight point of mean mass, pressure altitude, Mach number and deviation from the ISA; `None` where one of them is not kept.
    pub(crate) fn mean_state(&self) -> Option<FlightPoint> {
        Some(FlightPoint {
            isa_deviation: TemperatureDifference::kelvin(self.mean("isa_deviation_k")?),
            ..FlightPoint::new(
                Mass::kilograms(self.mean("mass_kg")?),
                PressureAltitude::meters(self.mean("pressure_altitude_m")?),
                Mach::new(self.mean("mach")?),
            )
        })
    }

    /// Adds the segments of a flight, one after the other: Welford's running mean, so that learning in two runs gives the same
    /// bits as in one. Signal by signal: each is looked up once.
    pub(crate) fn add(&mut self, segments: &[Conditions]) {
        for (place, signal) in SIGNALS.iter().enumerate() {
            let mut values = segments.iter().filter_map(|conditions| conditions.0[place]);
            if !self.0.contains_key(*signal) {
                let Some(first) = values.next() else { continue };
                self.0.insert((*signal).to_owned(), Reference { mean: first, segments: 1 });
            }
            let Some(reference) = self.0.get_mut(*signal) else { continue };
            for value in values {
                reference.segments += 1;
                reference.mean += (value - reference.mean) / reference.segments as f64;
            }
        }
    }

    /// The mean of a signal, where any segment had it.
    pub fn mean(&self, signal: &str) -> Option<f64> {
        self.0.get(signal).map(|reference| reference.mean)
    }

    /// Adds the means of other segments: to the bit the same whichever of two is added to the other.
    pub fn merge(&mut self, other: &Self) {
        for (name, theirs) in &other.0 {
            match self.0.get_mut(name) {
                Some(ours) => {
                    let sum = |one: &Reference| one.mean * one.segments as f64;
                    let segments = ours.segments + theirs.segments;
                    ours.mean = (sum(ours) + sum(theirs)) / segments as f64;
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
}

/// Days since 1970-01-01 UTC of the segment's mean instant.
fn unix_days(segment: &Segment) -> f64 {
    let start_s = segment.identity.start_s();
    (start_s + segment.means.time_s) / units::convert::SECONDS_PER_DAY
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 3 segments of 0.7 and 7 of 0.8 have a mean of 0.77.
    #[test]
    fn of_two_either_may_be_added_to_the_other() {
        let of = |mean: f64, segments: u64| {
            ConditionMeans([("mach".to_owned(), Reference { mean, segments })].into())
        };
        let added = |one: &ConditionMeans, other: &ConditionMeans| {
            let mut sum = one.clone();
            sum.merge(other);
            sum.mean("mach").unwrap()
        };
        let (few, more) = (of(0.7, 3), of(0.8, 7));
        assert!((added(&few, &more) - 0.77).abs() < 1e-15);
        for segments in 1..200 {
            let (few, more) = (of(0.713, segments), of(0.807, 61));
            assert_eq!(added(&few, &more).to_bits(), added(&more, &few).to_bits(), "{segments}");
        }
    }
}
