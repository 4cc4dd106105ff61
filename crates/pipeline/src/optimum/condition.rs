//! The optima of one mass, day and wind: at each level, and the best level.

use serde::Serialize;

use super::fuel::{Curve, Informed, OptimumModel};
use super::speeds::{Aim, Edge, Kind, edge};
use super::{CostIndex, MassAndDay, Question};

const SECONDS_PER_HOUR: f64 = 3600.0;

/// The optima of one mass, ISA deviation and wind.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConditionOptimum {
    /// Gross mass.
    pub mass_kg: f64,
    /// Deviation from the ISA.
    pub isa_deviation_k: f64,
    /// Tailwind; negative against the aircraft.
    pub tailwind_kt: f64,
    /// The best level for each way to choose the Mach number; empty where the model is informed at none of the levels.
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
    /// The edge of the informed Mach numbers at which it lies.
    pub edge: Option<Edge>,
    /// What informs the model there.
    pub informed_by: Informed,
    /// Predicted fuel flow of all engines.
    pub fuel_flow_kg_h: f64,
    /// Distance over ground for a mass of fuel.
    pub ground_range_m_kg: f64,
    /// The book's Mach number.
    pub book_mach: f64,
    /// The edge at which the book's lies.
    pub book_edge: Option<Edge>,
    /// What the tail's own Mach number saves compared with the book's, at the book's ground speed; with a cost index,
    /// time counts as fuel. `null` for long range, which gives up fuel on purpose.
    pub saving_kg_h: Option<f64>,
    /// Its 95 % interval.
    pub saving_ci95: Option<[f64; 2]>,
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
    /// Whether the next level, above or below, was not asked for or is not informed: the aircraft's own may be beyond.
    pub at_edge: bool,
    /// Mach number there.
    pub mach: f64,
    /// The book's best level.
    pub book_pressure_altitude_ft: f64,
    /// The book's Mach number there.
    pub book_mach: f64,
    /// What the tail's own level and Mach number save compared with the book's, as for a Mach number.
    pub saving_kg_h: Option<f64>,
    /// Its 95 % interval.
    pub saving_ci95: Option<[f64; 2]>,
}

/// The optima of a mass and day, one for each wind.
#[must_use]
pub fn at(
    model: &OptimumModel,
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
            let level = |at: usize| LevelOptimum {
                pressure_altitude_ft: curves[at].0,
                speeds: choices.iter().filter_map(|choices| choices.speed(at)).collect(),
            };
            ConditionOptimum {
                mass_kg: condition.mass.to_kilograms(),
                isa_deviation_k: condition.isa_deviation.to_kelvin(),
                tailwind_kt: wind.to_knots(),
                best: choices.iter().filter_map(Choices::best).collect(),
                levels: (0..curves.len())
                    .map(level)
                    .filter(|level| !level.speeds.is_empty())
                    .collect(),
            }
        })
        .collect()
}

fn aim(kind: Kind, tailwind: units::TrueAirspeed, cost_index: CostIndex) -> Aim {
    Aim::new(kind, tailwind.to_meters_per_second(), cost_index)
}

/// What the model, the book and each drawn model choose at every level for one aim.
struct Choices<'c> {
    curves: &'c [(f64, Curve)],
    aim: Aim,
    /// By level.
    own: Vec<Option<usize>>,
    book: Vec<Option<usize>>,
    /// By draw, then by level.
    drawn: Vec<Vec<Option<usize>>>,
}

impl<'c> Choices<'c> {
    fn new(curves: &'c [(f64, Curve)], aim: Aim) -> Self {
        let choose = |flow: &dyn Fn(&'c Curve) -> &'c [f64]| -> Vec<Option<usize>> {
            curves.iter().map(|(_, curve)| aim.choose(&curve.points, flow(curve))).collect()
        };
        let draws = curves.first().map_or(0, |(_, curve)| curve.drawn_kg_s.len());
        Self {
            curves,
            aim,
            own: choose(&|curve| &curve.own_kg_s),
            book: choose(&|curve| &curve.book_kg_s),
            drawn: (0..draws).map(|draw| choose(&|curve| &curve.drawn_kg_s[draw])).collect(),
        }
    }

    /// The optimum at a level.
    fn speed(&self, level: usize) -> Option<SpeedOptimum> {
        let (own, book) = (self.own[level]?, self.book[level]?);
        let curve = &self.curves[level].1;
        let mach = |at: usize| f64::from(curve.points[at].mach_thousandths) / 1000.0;
        let machs: Vec<f64> =
            self.drawn.iter().filter_map(|choice| choice[level]).map(mach).collect();
        let (saving_kg_h, saving_ci95) = self.saving((level, own), (level, book));
        let point = &curve.points[own];
        Some(SpeedOptimum {
            kind: self.aim.kind,
            mach: mach(own),
            mach_ci95: interval95(machs),
            edge: edge(&curve.points, own),
            informed_by: point.informed,
            fuel_flow_kg_h: curve.own_kg_s[own] * SECONDS_PER_HOUR,
            ground_range_m_kg: self.aim.ground_speed_m_s(point) / curve.own_kg_s[own],
            book_mach: mach(book),
            book_edge: edge(&curve.points, book),
            saving_kg_h,
            saving_ci95,
        })
    }

    /// The best level.
    fn best(&self) -> Option<BestLevel> {
        let own = self.best_of(&self.own, |curve| &curve.own_kg_s)?;
        let book = self.best_of(&self.book, |curve| &curve.book_kg_s)?;
        let levels: Vec<f64> = self
            .drawn
            .iter()
            .enumerate()
            .filter_map(|(draw, choice)| self.best_of(choice, |curve| &curve.drawn_kg_s[draw]))
            .map(|(level, _)| self.curves[level].0)
            .collect();
        let (saving_kg_h, saving_ci95) = self.saving(own, book);
        let mach = |(level, at): (usize, usize)| {
            f64::from(self.curves[level].1.points[at].mach_thousandths) / 1000.0
        };
        let uninformed =
            |level: Option<usize>| level.and_then(|level| *self.own.get(level)?).is_none();
        Some(BestLevel {
            kind: self.aim.kind,
            pressure_altitude_ft: self.curves[own.0].0,
            pressure_altitude_ci95: interval95(levels),
            at_edge: uninformed(own.0.checked_sub(1)) || uninformed(own.0.checked_add(1)),
            mach: mach(own),
            book_pressure_altitude_ft: self.curves[book.0].0,
            book_mach: mach(book),
            saving_kg_h,
            saving_ci95,
        })
    }

    /// Level and point of the least cost among the choices at all levels.
    fn best_of<'f>(
        &'f self,
        choice: &[Option<usize>],
        flow: impl Fn(&'f Curve) -> &'f [f64],
    ) -> Option<(usize, usize)> {
        let cost = |(level, at): (usize, usize)| {
            let curve = &self.curves[level].1;
            self.aim.cost_kg_m(&curve.points[at], flow(curve)[at])
        };
        let chosen = choice.iter().enumerate().filter_map(|(level, at)| Some((level, (*at)?)));
        chosen.min_by(|one, other| cost(*one).total_cmp(&cost(*other)))
    }

    /// What a choice saves compared with another, each level and point; kg/h at the other's ground speed.
    fn saving(&self, own: (usize, usize), book: (usize, usize)) -> (Option<f64>, Option<[f64; 2]>) {
        if self.aim.kind == Kind::LongRange {
            return (None, None);
        }
        let ground_speed_m_s = self.aim.ground_speed_m_s(&self.curves[book.0].1.points[book.1]);
        let saved = |flow: &dyn Fn(&'c Curve) -> &'c [f64]| {
            let cost = |(level, at): (usize, usize)| {
                let curve = &self.curves[level].1;
                self.aim.cost_kg_m(&curve.points[at], flow(curve)[at])
            };
            (cost(book) - cost(own)) * ground_speed_m_s * SECONDS_PER_HOUR
        };
        let drawn = (0..self.drawn.len()).map(|draw| saved(&|curve| &curve.drawn_kg_s[draw]));
        (Some(saved(&|curve| &curve.own_kg_s)), interval95(drawn.collect()))
    }
}

/// The values between which 95 % of the draws lie, both of them drawn; `None` without draws.
fn interval95(mut values: Vec<f64>) -> Option<[f64; 2]> {
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    Some([values[last / 40], values[last - last / 40]])
}

/// Without the last digits that a level in feet has gained in metres: the level that was asked for, for whoever looks it up.
fn whole_millionths(feet: f64) -> f64 {
    (1e6 * feet).round() / 1e6
}
