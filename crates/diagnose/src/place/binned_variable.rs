//! Variables that a place is said in: their edges, and which bin a segment is in.

use effects::{EffectReferences, Variable};

use crate::output::region::{Condition, Edge};
use crate::residuals::rows::SegmentRow;
use crate::thresholds::{BINS, EDGE_TOLERANCE, ROLL_EDGES_DEG};

/// The variables that places are said in, besides the engine.
const VARIABLES: [Variable; 17] = [
    // Switches first: of two places that fit alike, the first is said.
    Variable::AntiIce,
    Variable::Mach,
    Variable::LiftCoefficient,
    Variable::PressureAltitude,
    Variable::CorrectedThrust,
    Variable::N2,
    Variable::IsaDeviation,
    Variable::StaticAirTemperature,
    Variable::FuelUsed,
    Variable::Mass,
    Variable::Date,
    Variable::Roll,
    Variable::Acceleration,
    Variable::CrossWind,
    Variable::Latitude,
    Variable::CenterOfGravity,
    Variable::EastwardSpeed,
];

/// Share of a segment from which a switch counts as on: most of it.
const SWITCHED_ON: f64 = 0.5;

/// A variable cut into bins.
#[derive(Clone, Debug)]
pub(crate) struct BinnedVariable {
    variable: Variable,
    /// Inner edges, ascending; a segment is in bin k where exactly k edges are not above its value.
    edges: Vec<f64>,
    /// The largest value below each edge: of dates the last segment before it.
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

/// Every variable that all segments have, and that falls into two bins at least.
pub(crate) fn places(
    segments: &[SegmentRow],
    references: &EffectReferences,
) -> Vec<BinnedVariable> {
    VARIABLES
        .into_iter()
        .filter_map(|variable| {
            let values: Option<Vec<f64>> =
                segments.iter().map(|row| value_of(variable, row, references)).collect();
            BinnedVariable::new(variable, &values?)
        })
        .collect()
}

impl BinnedVariable {
    fn new(variable: Variable, values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (first, last) = (*sorted.first()?, *sorted.last()?);
        if !first.is_finite() || !last.is_finite() {
            return None;
        }
        let mut edges: Vec<f64> = match variable {
            Variable::Roll => ROLL_EDGES_DEG.to_vec(),
            Variable::AntiIce => vec![SWITCHED_ON],
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
        Some(Self { variable, edges, before, bins })
    }

    pub(crate) const fn variable(&self) -> Variable {
        self.variable
    }

    /// On or off, and nothing between.
    pub(crate) const fn is_switch(&self) -> bool {
        matches!(self.variable, Variable::AntiIce)
    }

    pub(crate) fn count(&self) -> usize {
        self.edges.len() + 1
    }

    /// Bins `low..high` as a condition; open at the ends.
    pub(crate) fn condition(&self, low: usize, high: usize) -> Condition {
        let edge = |edge: usize| Edge { value: self.edges[edge], flown_below: self.before[edge] };
        Condition {
            variable: self.variable,
            from: (low > 0).then(|| edge(low - 1)),
            to: (high < self.count()).then(|| edge(high - 1)),
        }
    }
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
        let place = BinnedVariable::new(Variable::Mass, &values).unwrap();
        assert_eq!(place.edges, [20.0, 40.0, 60.0, 80.0]);
        assert_eq!(place.bins[79..81], [3, 4]);
        let edge = |value: f64| Some(Edge { value, flown_below: value - 1.0 });
        let mass = |from, to| Condition { variable: Variable::Mass, from, to };
        assert_eq!(place.condition(4, 5), mass(edge(80.0), None));
        assert_eq!(place.condition(1, 3), mass(edge(20.0), edge(60.0)));
        assert_eq!(place.condition(0, 1), mass(None, edge(20.0)));
    }

    #[test]
    fn dates_are_cut_between_flights() {
        // Ten flights of ten segments, a day apart from 2019-06-01T00:00Z on (1 559 347 200 s).
        let values: Vec<f64> =
            (0..100).map(|k| 1_559_347_200.0 + 86_400.0 * f64::from(k / 10)).collect();
        let place = BinnedVariable::new(Variable::Date, &values).unwrap();
        assert_eq!(place.count(), 5);
        // Midnight before the ninth flight, and the flight of the day before.
        let from = place.condition(4, 5).from.unwrap();
        assert!((from.value - (1_559_347_200.0 + 8.0 * 86_400.0)).abs() < 1e-9);
        assert!((from.flown_below - (1_559_347_200.0 + 7.0 * 86_400.0)).abs() < 1e-9);
        assert_eq!(place.condition(4, 5).to, None);
        assert_eq!(place.condition(0, 1).from, None);
    }

    #[test]
    fn a_switch_is_on_or_off() {
        let values: Vec<f64> = (0..100).map(|k| f64::from(u8::from(k >= 93))).collect();
        let place = BinnedVariable::new(Variable::AntiIce, &values).unwrap();
        assert_eq!(place.count(), 2);
        assert_eq!(place.bins[92..94], [0, 1]);
        let on = place.condition(1, 2);
        assert!(on.to.is_none() && (on.from.unwrap().value - 0.5).abs() < 1e-15);
        assert!(BinnedVariable::new(Variable::AntiIce, &[0.0; 50]).is_none());
    }

    #[test]
    fn what_does_not_vary_is_no_place() {
        assert!(BinnedVariable::new(Variable::Mach, &[0.8; 50]).is_none());
        assert!(BinnedVariable::new(Variable::Mach, &[0.8, f64::NAN]).is_none());
    }
}
