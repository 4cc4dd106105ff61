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

/// Which ends of an interval are where drawn models were cut off, at an edge of what is informed or was asked for: the interval
/// may reach beyond them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum OpenEnds {
    /// The lower end.
    Lower,
    /// The upper end.
    Upper,
    /// Both.
    Both,
}

impl OpenEnds {
    /// The name in files.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Self::Lower => "lower",
            Self::Upper => "upper",
            Self::Both => "both",
        }
    }

    /// Of the lower and of the upper end.
    pub(super) const fn of(lower: bool, upper: bool) -> Option<Self> {
        match (lower, upper) {
            (true, true) => Some(Self::Both),
            (true, false) => Some(Self::Lower),
            (false, true) => Some(Self::Upper),
            (false, false) => None,
        }
    }

    /// Whether the lower and whether the upper end is one of them.
    pub(super) const fn sides(self) -> (bool, bool) {
        (!matches!(self, Self::Upper), !matches!(self, Self::Lower))
    }
}

/// What a choice minimises: fuel, and perhaps time as fuel, over distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Aim {
    pub(super) kind: Kind,
    /// The wind that is flown in.
    tailwind_m_s: f64,
    time_as_fuel_kg_s: f64,
}

impl Aim {
    /// An aim in a tailwind.
    pub(super) fn new(kind: Kind, tailwind_m_s: f64, cost_index: CostIndex) -> Self {
        let time_as_fuel_kg_s = match kind {
            Kind::MaximumRange | Kind::LongRange => 0.0,
            Kind::CostIndex => cost_index.kg_s(),
        };
        Self { kind, tailwind_m_s, time_as_fuel_kg_s }
    }

    /// Cost of a distance in kilograms of fuel per meter; infinite where the wind is stronger than the aircraft.
    ///
    /// ```text
    /// c = (Wf + C)/(V + w)                                                                   [optimum.2]
    /// ```
    ///
    /// with C the cost index as a fuel flow and w the tailwind that the choice is for: long range is a rule about still
    /// air, whatever wind it is then flown in.
    ///
    /// # Source
    /// Airbus, *Getting to grips with the cost index*, 1998: direct operating cost over the specific distance.
    pub(super) fn cost_kg_m(self, point: &CurvePoint, fuel_flow_kg_s: f64) -> f64 {
        let speed_m_s = match self.kind {
            Kind::LongRange => point.true_airspeed_m_s,
            Kind::MaximumRange | Kind::CostIndex => self.ground_speed_m_s(point),
        };
        if speed_m_s > 0.0 {
            (fuel_flow_kg_s + self.time_as_fuel_kg_s) / speed_m_s
        } else {
            f64::INFINITY
        }
    }

    /// Speed over ground in the wind that is flown in: V + w.
    pub(super) fn ground_speed_m_s(self, point: &CurvePoint) -> f64 {
        point.true_airspeed_m_s + self.tailwind_m_s
    }

    /// The point that is chosen among some points of a curve, given in ascending order; `None` among none, or against too strong a
    /// wind.
    pub(super) fn choose(
        self,
        points: &[CurvePoint],
        among: &[usize],
        fuel_flow_kg_s: &[f64],
    ) -> Option<Choice> {
        let costs: Vec<f64> =
            among.iter().map(|at| self.cost_kg_m(&points[*at], fuel_flow_kg_s[*at])).collect();
        let least = (0..costs.len())
            .filter(|at| costs[*at].is_finite() && costs[*at] > 0.0)
            .min_by(|one, other| costs[*one].total_cmp(&costs[*other]))?;
        let joins = |low: usize| {
            among.get(low + 1).is_some_and(|next| {
                points[*next].mach_thousandths == points[among[low]].mach_thousandths + 1
            })
        };
        let edge = |at: usize| {
            if at == 0 || !joins(at - 1) {
                Some(Edge::Lowest)
            } else if !joins(at) {
                Some(Edge::Highest)
            } else {
                None
            }
        };
        if self.kind != Kind::LongRange {
            return Some(Choice { at: among[least], edge: edge(least) });
        }
        // Costs are the inverse of specific range: up to 1/0.99 of the least. Where that is at an edge the greatest specific range
        // may be beyond, and 99 % of it elsewhere.
        let most = costs[least] / LONG_RANGE_SHARE;
        let above = (least + 1..costs.len()).take_while(|at| costs[*at] <= most && joins(*at - 1));
        let long = above.last().unwrap_or(least);
        let choice = Choice { at: among[long], edge: edge(least).or(edge(long)) };
        // Against a wind that is stronger than the aircraft there is no long range either.
        Some(choice).filter(|choice| self.ground_speed_m_s(&points[choice.at]) > 0.0)
    }
}

/// A point of a curve that is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    /// Index of the point.
    pub(super) at: usize,
    /// The edge of what could be chosen at which it lies, or of long range the greatest specific range behind it.
    pub(super) edge: Option<Edge>,
}
