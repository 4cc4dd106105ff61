//! A part of what was flown.

use effects::Variable;

/// A part of what was flown: the segments that meet every condition, of all engines or of one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    /// One engine, numbered from 1; `None` for all.
    pub engine: Option<u8>,
    /// Conditions that segments meet, at most two from [`diagnose`](crate::diagnose()); none for all segments.
    pub conditions: Vec<Condition>,
}

/// Bounds of one variable: not below the first edge, below the second; an end without edge is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// The variable. Of a region, [`Variable::Date`] is the instant in seconds since 1970; [`Variable::Engine`] has no
    /// value.
    pub variable: Variable,
    /// The least value inside.
    pub from: Option<Edge>,
    /// The least value beyond.
    pub to: Option<Edge>,
}

/// An edge between values that were flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The least value that lies above, in the variable's unit.
    pub value: f64,
    /// The largest flown value below the edge: of dates the last segment before it.
    pub flown_below: f64,
}

impl Region {
    /// Whether it is all that was flown, of all engines.
    #[must_use]
    pub const fn is_everywhere(&self) -> bool {
        self.engine.is_none() && self.conditions.is_empty()
    }
}

impl Condition {
    /// Whether a value lies within the bounds.
    #[must_use]
    pub fn holds(&self, value: f64) -> bool {
        self.from.is_none_or(|from| value >= from.value)
            && self.to.is_none_or(|to| value < to.value)
    }
}
