//! The optima of one mass, day and wind: at each level, and the best level.

use serde::Serialize;

use super::choices::Choices;
use super::fuel::{Curve, Informed, OptimumModel};
use super::speeds::{Aim, Edge, Kind, OpenEnds};
use super::{CostIndex, MassAndDay, Question};
use crate::prediction::PointPrediction;

/// The optima of one mass, ISA deviation and wind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConditionOptimum {
    /// Gross mass.
    pub mass_kg: f64,
    /// Deviation from the ISA.
    pub isa_deviation_k: f64,
    /// Tailwind; negative against the aircraft.
    pub tailwind_kt: f64,
    /// The best level for each way to choose the Mach number, of long range that of still air; empty where the model is informed at none of the levels.
    pub best: Vec<BestLevel>,
    /// Each level at which the model is informed.
    pub levels: Vec<LevelOptimum>,
}

/// The optima at one level.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelOptimum {
    /// Pressure altitude of the level.
    pub pressure_altitude_ft: f64,
    /// One for each way to choose the Mach number.
    pub speeds: Vec<SpeedOptimum>,
}

/// An optimum Mach number at a level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpeedOptimum {
    /// How it is chosen.
    pub kind: Kind,
    /// Mach number.
    pub mach: f64,
    /// Its 95 % interval, where the law knows one.
    pub mach_ci95: Option<[f64; 2]>,
    /// Which of its ends are at an edge of the informed Mach numbers: drawn models were cut off there.
    pub mach_ci95_open: Option<OpenEnds>,
    /// The edge of the informed Mach numbers at which it lies.
    pub edge: Option<Edge>,
    /// What informs the model there.
    pub informed_by: Informed,
    /// Whether it lies beyond all that the learnt flights flew, as `predict` states it; `None` of a model that has learnt no more than
    /// a table.
    pub beyond_flights: Option<bool>,
    /// Predicted fuel flow of all engines.
    pub fuel_flow_kg_h: f64,
    /// 100 (fuel flow/that of `predict` − 1): what is smooth between the nodes against what is bilinear.
    pub against_predict_percent: Option<f64>,
    /// Distance over ground for a mass of fuel in this wind, of long range too, whose Mach number is that of still air.
    pub ground_range_m_kg: f64,
    /// The book's Mach number, among those that the guide informs; `None` where it informs none.
    pub book_mach: Option<f64>,
    /// The edge of the guide at which the book's lies.
    pub book_edge: Option<Edge>,
    /// What the tail's own Mach number saves compared with the book's, at the book's ground speed; with a cost index,
    /// time counts as fuel.
    pub saving_kg_h: Option<f64>,
    /// Its 95 % interval.
    pub saving_ci95: Option<[f64; 2]>,
    /// Why no saving is stated.
    pub no_saving: Option<NoSaving>,
}

/// Why no saving is stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum NoSaving {
    /// Long range gives up fuel on purpose.
    LongRange,
    /// The guide informs nothing here: there is no book.
    NoBook,
    /// The book's optimum lies at the edge of the guide: what the book makes it fly is not known.
    BookAtEdge,
    /// The tail's own optimum lies at the edge of what is informed: what it would save is not known.
    OwnAtEdge,
}

impl NoSaving {
    /// The name in files.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Self::LongRange => "long_range",
            Self::NoBook => "no_book",
            Self::BookAtEdge => "book_at_edge",
            Self::OwnAtEdge => "own_at_edge",
        }
    }
}

/// The best of the levels, each flown at its own optimum Mach number.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BestLevel {
    /// How the Mach number is chosen.
    pub kind: Kind,
    /// Pressure altitude of the level.
    pub pressure_altitude_ft: f64,
    /// Its 95 % interval.
    pub pressure_altitude_ci95: Option<[f64; 2]>,
    /// Which of its ends are where no further level could be chosen: drawn models were cut off there.
    pub pressure_altitude_ci95_open: Option<OpenEnds>,
    /// Whether it lies beyond all that the learnt flights flew, as for a Mach number.
    pub beyond_flights: Option<bool>,
    /// Whether the aircraft's own level may be beyond: the next one, above or below, was not asked for, is not informed, or has its
    /// own optimum at an edge.
    pub at_edge: bool,
    /// Mach number there.
    pub mach: f64,
    /// The book's best level; `None` where the guide informs none.
    pub book_pressure_altitude_ft: Option<f64>,
    /// The book's Mach number there.
    pub book_mach: Option<f64>,
    /// Whether the book's level or Mach number lies at the edge of the guide or of the levels that were asked for.
    pub book_at_edge: bool,
    /// What the tail's own level and Mach number save compared with the book's, as for a Mach number.
    pub saving_kg_h: Option<f64>,
    /// Its 95 % interval.
    pub saving_ci95: Option<[f64; 2]>,
    /// Why no saving is stated. Levels that were not asked for are no reason: the saving is one among those that were.
    pub no_saving: Option<NoSaving>,
}

impl SpeedOptimum {
    /// With what `predict` states of it.
    fn held_against(self, found: Option<PointPrediction>) -> Self {
        let Some(found) = found else { return self };
        let predicted_kg_h = found.prediction.fuel_flow_total.to_kilograms_per_hour();
        Self {
            beyond_flights: found.beside_table.map(|beside| beside.beyond_flights),
            against_predict_percent: Some(100.0 * (self.fuel_flow_kg_h / predicted_kg_h - 1.0)),
            ..self
        }
    }
}

impl BestLevel {
    /// Whether this is the best level.
    pub(super) fn is(&self, level: &LevelOptimum) -> bool {
        level.pressure_altitude_ft.total_cmp(&self.pressure_altitude_ft).is_eq()
    }
}

impl ConditionOptimum {
    /// The optimum Mach number at a best level.
    pub(super) fn speed_at(&self, best: &BestLevel) -> Option<&SpeedOptimum> {
        speed_at(&self.levels, best)
    }
}

fn speed_at<'l>(levels: &'l [LevelOptimum], best: &BestLevel) -> Option<&'l SpeedOptimum> {
    levels.iter().find(|level| best.is(level))?.speeds.iter().find(|speed| speed.kind == best.kind)
}

/// The largest difference of the optima's fuel flow from that of `predict`, %, without its sign; `None` without any.
#[must_use]
pub fn largest_against_predict_percent(conditions: &[ConditionOptimum]) -> Option<f64> {
    let levels = conditions.iter().flat_map(|condition| &condition.levels);
    let speeds = levels.flat_map(|level| &level.speeds);
    speeds.filter_map(|speed| speed.against_predict_percent).map(f64::abs).reduce(f64::max)
}

/// The optima of a mass and day, one for each wind.
#[must_use]
pub fn at(
    model: &OptimumModel<'_>,
    condition: MassAndDay,
    question: &Question,
) -> Vec<ConditionOptimum> {
    let curves: Vec<(f64, Curve)> = question
        .levels
        .iter()
        .map(|level| (whole_millionths(level.to_feet()), model.curve(condition, *level)))
        .collect();
    let cost_index = question.cost_index.unwrap_or_default();
    let mut kinds = vec![Kind::MaximumRange, Kind::LongRange];
    kinds.extend(question.cost_index.map(|_| Kind::CostIndex));
    question
        .tailwinds
        .iter()
        .map(|wind| {
            let choices: Vec<Choices<'_>> = kinds
                .iter()
                .map(|kind| Choices::new(&curves, aim(*kind, *wind, cost_index)))
                .collect();
            let predicted = |at: usize, speed: SpeedOptimum| {
                model.predicted(condition, question.levels[at], speed.mach)
            };
            let level = |at: usize| LevelOptimum {
                pressure_altitude_ft: curves[at].0,
                speeds: choices
                    .iter()
                    .filter_map(|choices| choices.speed(at))
                    .map(|speed| speed.held_against(predicted(at, speed)))
                    .collect(),
            };
            let levels: Vec<LevelOptimum> =
                (0..curves.len()).map(level).filter(|level| !level.speeds.is_empty()).collect();
            let best = choices.iter().filter_map(Choices::best).map(|best| BestLevel {
                beyond_flights: speed_at(&levels, &best).and_then(|speed| speed.beyond_flights),
                ..best
            });
            ConditionOptimum {
                mass_kg: condition.mass.to_kilograms(),
                isa_deviation_k: condition.isa_deviation.to_kelvin(),
                tailwind_kt: wind.to_knots(),
                best: best.collect(),
                levels,
            }
        })
        .collect()
}

fn aim(kind: Kind, tailwind: units::TrueAirspeed, cost_index: CostIndex) -> Aim {
    Aim::new(kind, tailwind.to_meters_per_second(), cost_index)
}

/// Without the last digits that a level in feet has gained in metres: the level that was asked for, for whoever looks it up.
fn whole_millionths(feet: f64) -> f64 {
    (1e6 * feet).round() / 1e6
}
