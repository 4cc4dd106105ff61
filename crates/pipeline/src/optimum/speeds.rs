//! The Mach numbers of maximum range, long range and a cost index on a curve of fuel flow.

use serde::Serialize;

use super::fuel::CurvePoint;
use super::{CostIndex, LONG_RANGE_SHARE};

/// A way to choose the Mach number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Most distance over ground for the fuel.
    MaximumRange,
    /// The higher Mach number with 99 % of the most distance through still air.
    LongRange,
    /// Least cost of fuel and time over the distance.
    CostIndex,
}

impl Kind {
    /// The name in files.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Self::MaximumRange => "maximum_range",
            Self::LongRange => "long_range",
            Self::CostIndex => "cost_index",
        }
    }
}

/// At which edge of the informed Mach numbers an optimum lies: the aircraft's own may be beyond.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// At the lowest informed Mach number.
    Lowest,
    /// At the highest.
    Highest,
}

/// What a choice minimises: fuel, and perhaps time as fuel, over distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aim {
    pub(super) kind: Kind,
    tailwind_m_s: f64,
    time_as_fuel_kg_s: f64,
}

impl Aim {
    /// An aim in a tailwind. Long range is a rule about still air.
    pub(super) fn new(kind: Kind, tailwind_m_s: f64, cost_index: CostIndex) -> Self {
        match kind {
            Kind::MaximumRange => Self { kind, tailwind_m_s, time_as_fuel_kg_s: 0.0 },
            Kind::LongRange => Self { kind, tailwind_m_s: 0.0, time_as_fuel_kg_s: 0.0 },
            Kind::CostIndex => Self { kind, tailwind_m_s, time_as_fuel_kg_s: cost_index.kg_s() },
        }
    }

    /// Cost of a distance in kilograms of fuel per meter; infinite where the wind is stronger than the aircraft.
    ///
    /// ```text
    /// c = (Wf + C)/(V + w)                                                                   [optimum.2]
    /// ```
    ///
    /// with C the cost index as a fuel flow and w the tailwind.
    ///
    /// # Source
    /// Airbus, *Getting to grips with the cost index*, 1998: direct operating cost over the specific distance.
    pub(super) fn cost_kg_m(self, point: &CurvePoint, fuel_flow_kg_s: f64) -> f64 {
        let ground_speed_m_s = self.ground_speed_m_s(point);
        if ground_speed_m_s > 0.0 {
            (fuel_flow_kg_s + self.time_as_fuel_kg_s) / ground_speed_m_s
        } else {
            f64::INFINITY
        }
    }

    pub(super) fn ground_speed_m_s(self, point: &CurvePoint) -> f64 {
        point.true_airspeed_m_s + self.tailwind_m_s
    }

    /// The point that is chosen on a curve; `None` on an empty one, or against too strong a wind.
    pub(super) fn choose(self, points: &[CurvePoint], fuel_flow_kg_s: &[f64]) -> Option<usize> {
        let costs: Vec<f64> = points
            .iter()
            .zip(fuel_flow_kg_s)
            .map(|(point, flow)| self.cost_kg_m(point, *flow))
            .collect();
        let least = (0..costs.len())
            .filter(|at| costs[*at].is_finite() && costs[*at] > 0.0)
            .min_by(|one, other| costs[*one].total_cmp(&costs[*other]))?;
        if self.kind != Kind::LongRange {
            return Some(least);
        }
        // Costs are the inverse of specific range: up to 1/0.99 of the least.
        let most = costs[least] / LONG_RANGE_SHARE;
        let above = (least + 1..costs.len()).take_while(|at| {
            costs[*at] <= most
                && points[*at].mach_thousandths == points[*at - 1].mach_thousandths + 1
        });
        above.last().or(Some(least))
    }
}

/// Whether a point is at an edge of what is informed.
pub(super) fn edge(points: &[CurvePoint], at: usize) -> Option<Edge> {
    let joins = |low: usize| {
        points
            .get(low + 1)
            .is_some_and(|next| next.mach_thousandths == points[low].mach_thousandths + 1)
    };
    if at == 0 || !joins(at - 1) {
        Some(Edge::Lowest)
    } else if !joins(at) {
        Some(Edge::Highest)
    } else {
        None
    }
}
