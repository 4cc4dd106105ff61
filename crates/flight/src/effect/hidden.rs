//! Hidden parameters: the parameters of an effect other than its size.

use core::fmt;

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::History;
use crate::MAXIMUM_ENGINES;

/// What a dated step multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StepTarget {
    /// Fuel flow.
    FuelFlow,
    /// Drag coefficient.
    Drag,
    /// Fuel flow of engine 1.
    #[serde(rename = "engine_1")]
    Engine1,
    /// Fuel flow of engine 2.
    #[serde(rename = "engine_2")]
    Engine2,
    /// Fuel flow of engine 3.
    #[serde(rename = "engine_3")]
    Engine3,
    /// Fuel flow of engine 4.
    #[serde(rename = "engine_4")]
    Engine4,
}

/// The argument of the parabola of `tsfc_throttle`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThrottleArgument {
    /// Corrected thrust by the model.
    #[default]
    CorrectedThrust,
    /// The corrected thrust that the recorded N2 indicates; the model's where a point has none.
    N2,
}

/// How steeply drag rises with Mach number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DragRiseLaw {
    /// Lock's fourth power, which begins a tenth in Mach number below drag divergence.
    #[default]
    Lock,
    /// Three times as steep, as on supercritical wings, and earlier with lift, as on swept ones.
    Steep,
}

/// A rise of drag with Mach number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragRise {
    /// Drag-divergence Mach number at lift coefficient 0.35.
    pub divergence_mach: f64,
    /// How steeply.
    pub law: DragRiseLaw,
}

/// The hidden parameter of an effect, in addition to its size. Its kind and its default are in
/// [`EffectEntry::hidden`](super::EffectEntry::hidden).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HiddenParameter {
    /// No parameter other than the size.
    None,
    /// `wave_drag`: the rise that comes earlier.
    DragRise(DragRise),
    /// `tsfc_throttle`.
    Throttle {
        /// Corrected thrust over its reference at which TSFC is unchanged.
        pivot: f64,
        /// Where that corrected thrust comes from.
        argument: ThrottleArgument,
    },
    /// `step_change`.
    Step {
        /// Instant from which it holds, s since 1970.
        from_s: f64,
        /// What it multiplies.
        target: StepTarget,
    },
    /// `engine_history`, `airframe_history`.
    History(History),
}

impl StepTarget {
    /// The engines, by their number.
    pub const ENGINES: [Self; MAXIMUM_ENGINES] =
        [Self::Engine1, Self::Engine2, Self::Engine3, Self::Engine4];

    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::FuelFlow => "fuel flow",
            Self::Drag => "drag",
            Self::Engine1 => "fuel flow of engine 1",
            Self::Engine2 => "fuel flow of engine 2",
            Self::Engine3 => "fuel flow of engine 3",
            Self::Engine4 => "fuel flow of engine 4",
        }
    }

    /// The number of the engine, from 1, where it is one alone.
    #[must_use]
    pub const fn engine(self) -> Option<u8> {
        match self {
            Self::FuelFlow | Self::Drag => None,
            Self::Engine1 => Some(1),
            Self::Engine2 => Some(2),
            Self::Engine3 => Some(3),
            Self::Engine4 => Some(4),
        }
    }
}

impl ThrottleArgument {
    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::CorrectedThrust => "corrected thrust",
            Self::N2 => "N2",
        }
    }
}

impl DragRise {
    /// By Lock's law.
    #[must_use]
    pub const fn by_lock(divergence_mach: f64) -> Self {
        Self { divergence_mach, law: DragRiseLaw::Lock }
    }
}

impl HiddenParameter {
    /// Whether this is a value of the same parameter.
    #[must_use]
    pub const fn is_like(self, other: Self) -> bool {
        matches!(
            (self, other),
            (Self::None, Self::None)
                | (Self::DragRise(_), Self::DragRise(_))
                | (Self::Throttle { .. }, Self::Throttle { .. })
                | (Self::Step { .. }, Self::Step { .. })
                | (Self::History(_), Self::History(_))
        )
    }
}

/// In words, empty without a parameter: "over N2, pivot 1.0", "Mdd 0.86", "drag from
/// 2018-05-20T00:00:00Z".
impl fmt::Display for HiddenParameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => Ok(()),
            Self::DragRise(DragRise { divergence_mach, law: DragRiseLaw::Lock }) => {
                write!(f, "Mdd {divergence_mach}")
            }
            Self::DragRise(DragRise { divergence_mach, law: DragRiseLaw::Steep }) => {
                write!(f, "steep, Mdd {divergence_mach}")
            }
            Self::Throttle { pivot, argument } => {
                write!(f, "over {}, pivot {pivot:.1}", argument.words())
            }
            Self::Step { from_s, target } => {
                write!(f, "{} from ", target.words())?;
                write_instant(f, *from_s)
            }
            Self::History(history) => {
                f.write_str("growing since ")?;
                write_instant(f, history.since_s())?;
                let recovered_percent = 100.0 * history.recovered();
                for fall_s in history.falls_s() {
                    write!(f, ", {recovered_percent:.0} % of it taken back at ")?;
                    write_instant(f, fall_s)?;
                }
                Ok(())
            }
        }
    }
}

/// An instant, s since 1970, as RFC 3339; nothing beyond the calendar.
fn write_instant(f: &mut fmt::Formatter<'_>, instant_s: f64) -> fmt::Result {
    #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
    match Timestamp::from_second(instant_s as i64) {
        Ok(instant) => write!(f, "{instant}"),
        Err(_) => Ok(()),
    }
}
