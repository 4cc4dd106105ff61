//! Variables that describe a region: their names, their edges, and which bin a segment is in.

use std::collections::BTreeMap;

use effects::EffectReferences;

use crate::residuals::rows::SegmentRow;
use crate::signals::variables::Variable;
use crate::thresholds::{BINS, EDGE_TOLERANCE, ROLL_EDGES_DEG};

/// A variable, the name of its bounds (a column, unit in the name), and its name and unit in words.
type Entry = (Variable, &'static str, &'static str, &'static str);

/// Variables of regions but engine; of two that describe a region equally well, the earlier one is reported.
const ENTRIES: [Entry; 16] = [
    (Variable::Mach, "mach", "mach", ""),
    (Variable::LiftCoefficient, "lift_coefficient", "lift_coefficient", ""),
    (Variable::PressureAltitude, "pressure_altitude_m", "pressure_altitude", " m"),
    (Variable::CorrectedThrust, "corrected_thrust_ratio", "corrected_thrust_ratio", ""),
    (Variable::N2, "n2_percent", "n2", " %"),
    (Variable::IsaDeviation, "isa_deviation_k", "isa_deviation", " K"),
    (Variable::StaticAirTemperature, "static_air_temperature_k", "static_air_temperature", " K"),
    (Variable::FuelUsed, "fuel_used_kg", "fuel_used", " kg"),
    (Variable::Mass, "mass_kg", "mass", " kg"),
    (Variable::Date, "date_s", "date", ""),
    (Variable::Roll, "roll_deg", "roll", " deg"),
    (Variable::Acceleration, "acceleration_m_s2", "acceleration", " m/s2"),
    (Variable::CrossWind, "cross_wind_m_s", "cross_wind", " m/s"),
    (Variable::Latitude, "latitude_deg", "latitude", " deg"),
    (Variable::CenterOfGravity, "center_of_gravity_percent_mac", "center_of_gravity", " %MAC"),
    (Variable::EastwardSpeed, "eastward_speed_m_s", "eastward_speed", " m/s"),
];
/// Name of the bounds of an engine.
pub(crate) const ENGINE: &str = "engine";

/// A variable cut into bins.
#[derive(Clone, Debug)]
pub(crate) struct BinnedVariable {
    entry: Entry,
    /// Inner edges, ascending; a segment is in bin k where exactly k edges are not above its value.
    edges: Vec<f64>,
    /// Of dates: the instant of the last flight before each edge.
    before: Vec<f64>,
    /// Bin of each segment.
    pub(crate) bins: Vec<u8>,
}

/// What a segment's variables are read from.
pub(crate) fn value_of(
    variable: Variable,
    row: &SegmentRow,
    references: &EffectReferences,
) -> Option<f64> {
    match variable {
        Variable::N2 => row.n2_percent,
        // The instant itself, not years since a reference that nobody sees.
        Variable::Date => Some(row.point.date_s),
        _ => variable.value(&row.point, &row.response, references),
    }
}

/// The variable whose bounds have this name; `None` for an engine's, and for an unknown name.
pub(crate) fn variable_named(name: &str) -> Option<Variable> {
    ENTRIES.iter().find(|entry| entry.1 == name).map(|entry| entry.0)
}

/// Every variable that all segments have, and that falls into two bins at least.
pub(crate) fn places(
    segments: &[SegmentRow],
    references: &EffectReferences,
) -> Vec<BinnedVariable> {
    ENTRIES
        .into_iter()
        .filter_map(|entry| {
            let values: Option<Vec<f64>> =
                segments.iter().map(|row| value_of(entry.0, row, references)).collect();
            BinnedVariable::new(entry, &values?)
        })
        .collect()
}

impl BinnedVariable {
    fn new(entry: Entry, values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (first, last) = (*sorted.first()?, *sorted.last()?);
        if !first.is_finite() || !last.is_finite() {
            return None;
        }
        let mut edges: Vec<f64> = match entry.0 {
            Variable::Roll => ROLL_EDGES_DEG.to_vec(),
            Variable::Date => (1..BINS).map(|k| flight_boundary(&sorted, share(k))).collect(),
            _ => (1..BINS).filter_map(|k| readable_edge(&sorted, share(k))).collect(),
        };
        edges.dedup_by(|a, b| a.total_cmp(b).is_eq());
        edges.retain(|&edge| edge > first && edge <= last);
        if edges.is_empty() {
            return None;
        }
        let before = edges
            .iter()
            .map(|edge| sorted[sorted.partition_point(|value| value < edge) - 1])
            .collect();
        let bins = values.iter().map(|&value| bin(&edges, value)).collect();
        Some(Self { entry, edges, before, bins })
    }

    pub(crate) fn count(&self) -> usize {
        self.edges.len() + 1
    }

    /// Bounds of bins `low..high`: not below the first, below the second; open ends without number.
    pub(crate) fn bounds(&self, low: usize, high: usize) -> (String, [Option<f64>; 2]) {
        let from = (low > 0).then(|| self.edges[low - 1]);
        let to = (high < self.count()).then(|| self.edges[high - 1]);
        (self.entry.1.to_owned(), [from, to])
    }

    /// Bins `low..high` in words.
    pub(crate) fn words(&self, low: usize, high: usize) -> String {
        let (_, name, unit) = (self.entry.1, self.entry.2, self.entry.3);
        let (_, [from, to]) = self.bounds(low, high);
        if self.entry.0 == Variable::Date {
            return self.dates(low, high);
        }
        match (from, to) {
            (Some(from), Some(to)) => format!("{name} {from} to {to}{unit}"),
            (Some(from), None) => format!("{name} >= {from}{unit}"),
            (None, Some(to)) => format!("{name} < {to}{unit}"),
            (None, None) => name.to_owned(),
        }
    }

    /// "after" is after the day of the last flight before; "before" is before the day of the first flight beyond. Where
    /// both sides of an edge were flown on one day, its time is said too.
    fn dates(&self, low: usize, high: usize) -> String {
        let words = |edge: usize, of_before: bool| {
            let (before_s, from_s) = (self.before[edge], self.edges[edge]);
            let (before, from) = (instant(before_s), instant(from_s));
            let same_day = before.get(..10) == from.get(..10);
            let chosen = if of_before { before } else { from };
            if same_day { chosen } else { chosen.get(..10).unwrap_or(&chosen).to_owned() }
        };
        let after = (low > 0).then(|| words(low - 1, true));
        let before = (high < self.count()).then(|| words(high - 1, false));
        match (after, before) {
            (Some(after), Some(before)) => format!("after {after} and before {before}"),
            (Some(after), None) => format!("after {after}"),
            (None, Some(before)) => format!("before {before}"),
            (None, None) => "date".to_owned(),
        }
    }
}

/// Whether a value lies within bounds.
pub(crate) fn is_within(value: f64, bounds: [Option<f64>; 2]) -> bool {
    bounds[0].is_none_or(|from| value >= from) && bounds[1].is_none_or(|to| value < to)
}

/// Names of bounds that are not known here.
pub(crate) fn unknown_names(bounds: &BTreeMap<String, [Option<f64>; 2]>) -> Vec<&str> {
    bounds
        .keys()
        .map(String::as_str)
        .filter(|name| *name != ENGINE && variable_named(name).is_none())
        .collect()
}

fn instant(seconds: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
    flight::Timestamp::from_second(seconds as i64).map_or_else(|_| String::new(), |t| t.to_string())
}

const fn share(edge: usize) -> f64 {
    edge as f64 / BINS as f64
}

#[expect(clippy::cast_possible_truncation, reason = "at most four edges")]
fn bin(edges: &[f64], value: f64) -> u8 {
    edges.partition_point(|&edge| edge <= value) as u8
}

/// First instant of the flight whose first segment is nearest to a share of the segments.
fn flight_boundary(sorted: &[f64], share: f64) -> f64 {
    let target = share * sorted.len() as f64;
    let mut best = (f64::INFINITY, sorted[0]);
    for k in 1..sorted.len() {
        let distance = (k as f64 - target).abs();
        if sorted[k] > sorted[k - 1] && distance < best.0 {
            best = (distance, sorted[k]);
        }
    }
    best.1
}

/// A number of few digits that cuts the sorted values near a share of them; `None` where they do not differ there.
fn readable_edge(sorted: &[f64], share: f64) -> Option<f64> {
    let count = sorted.len() as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of a length, not negative"
    )]
    let at = |share: f64| ((share * count).round().max(0.0) as usize).min(sorted.len() - 1);
    let middle = at(share);
    // At least the gap between two neighbors must hold the edge.
    let low = sorted[at(share - EDGE_TOLERANCE).min(middle.saturating_sub(1))];
    let high = sorted[at(share + EDGE_TOLERANCE)];
    (high > low).then(|| shortest_between(low, high, sorted[middle]))
}

/// The number of fewest digits above `low` and not above `high`, nearest to a target among those: a multiple of 10, 5 or 2
/// of the coarsest power of ten that has one there.
fn shortest_between(low: f64, high: f64, target: f64) -> f64 {
    #[expect(clippy::cast_possible_truncation, reason = "an exponent of ten")]
    let coarsest = (high - low).log10().ceil() as i32 + 1;
    for power in (coarsest - 20..=coarsest).rev() {
        for step in [5.0, 2.0, 1.0] {
            // Division by a power of ten gives the double nearest to the decimal, a product by 0.001 does not.
            let multiple = |count: f64| {
                if power >= 0 {
                    count * step * 10_f64.powi(power)
                } else {
                    count * step / 10_f64.powi(-power)
                }
            };
            let count = (target / multiple(1.0)).round();
            for candidate in [count, count - 1.0, count + 1.0].map(multiple) {
                if candidate > low && candidate <= high {
                    return candidate + 0.0; // −0 reads badly
                }
            }
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_read_well() {
        // By hand: the only multiple of 0.02 in (0.8513, 0.8631] nearest 0.8567 is 0.86; of 5 in (10 984, 11 013] 11 000.
        assert_eq!(shortest_between(0.8513, 0.8631, 0.8567).to_string(), "0.86");
        assert_eq!(shortest_between(10_984.0, 11_013.0, 11_003.0).to_string(), "11000");
        assert_eq!(shortest_between(-0.0032, 0.0008, -0.001).to_string(), "0");
        // Nothing but the upper end: neighbors one bit apart.
        let next = f64::from_bits(1.5_f64.to_bits() + 1);
        assert!((shortest_between(1.5, next, next) - next).abs() < 1e-18);
    }

    #[test]
    fn quintiles_of_a_hundred() {
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        let place = BinnedVariable::new(ENTRIES[8], &values).unwrap();
        assert_eq!(place.edges, [20.0, 40.0, 60.0, 80.0]);
        assert_eq!(place.bins[79..81], [3, 4]);
        assert_eq!(place.words(4, 5), "mass >= 80 kg");
        assert_eq!(place.words(1, 3), "mass 20 to 60 kg");
        assert_eq!(place.words(0, 1), "mass < 20 kg");
        assert_eq!(place.bounds(0, 1), ("mass_kg".to_owned(), [None, Some(20.0)]));
    }

    #[test]
    fn dates_are_cut_between_flights() {
        // Ten flights of ten segments, a day apart from 2019-06-01T00:00Z on (1 559 347 200 s).
        let values: Vec<f64> =
            (0..100).map(|k| 1_559_347_200.0 + 86_400.0 * f64::from(k / 10)).collect();
        let place = BinnedVariable::new(ENTRIES[9], &values).unwrap();
        assert_eq!(place.count(), 5);
        assert_eq!(place.words(4, 5), "after 2019-06-08");
        assert_eq!(place.words(0, 1), "before 2019-06-03");
        assert_eq!(place.words(1, 2), "after 2019-06-02 and before 2019-06-05");
        assert_eq!(place.bounds(4, 5).1, [Some(1_559_347_200.0 + 8.0 * 86_400.0), None]);
        // Two flights on one day: the time tells them apart.
        let values: Vec<f64> =
            (0..10).map(|k| 1_559_347_200.0 + 3600.0 * f64::from(k / 5)).collect();
        let place = BinnedVariable::new(ENTRIES[9], &values).unwrap();
        assert_eq!(place.words(1, 2), "after 2019-06-01T00:00:00Z");
    }

    #[test]
    fn what_does_not_vary_is_no_place() {
        assert!(BinnedVariable::new(ENTRIES[0], &[0.8; 50]).is_none());
        assert!(BinnedVariable::new(ENTRIES[0], &[0.8, f64::NAN]).is_none());
    }
}
