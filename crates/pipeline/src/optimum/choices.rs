//! What the model, the book and each drawn model choose at every level for one aim, and what the difference saves.

use super::condition::{BestLevel, NoSaving, SpeedOptimum};
use super::fuel::Curve;
use super::speeds::{Aim, Choice, Edge, Kind, OpenEnds};

const SECONDS_PER_HOUR: f64 = 3600.0;

/// A choice at each level; `None` where nothing can be chosen.
type ByLevel = Vec<Option<Choice>>;

/// A level, and a point of its curve.
type LevelAndPoint = (usize, usize);

/// A drawn value, and whether the drawn model's own may be lower or higher: it was chosen at an edge.
#[derive(Clone, Copy)]
struct Drawn {
    value: f64,
    may_be_lower: bool,
    may_be_higher: bool,
}

/// The choices for one aim.
pub(super) struct Choices<'c> {
    curves: &'c [(f64, Curve)],
    aim: Aim,
    own: ByLevel,
    book: ByLevel,
    /// By draw.
    drawn: Vec<ByLevel>,
}

impl<'c> Choices<'c> {
    /// The choices on curves of ascending levels, ft.
    pub(super) fn new(curves: &'c [(f64, Curve)], aim: Aim) -> Self {
        let choose = |flow: &dyn Fn(&'c Curve) -> (&'c [usize], &'c [f64])| -> ByLevel {
            let of = |curve: &'c Curve| {
                let (among, flow) = flow(curve);
                aim.choose(&curve.points, among, flow)
            };
            curves.iter().map(|(_, curve)| of(curve)).collect()
        };
        let draws = curves.first().map_or(0, |(_, curve)| curve.drawn_kg_s.len());
        let drawn = |draw: usize| choose(&|curve| (&curve.any, &curve.drawn_kg_s[draw]));
        Self {
            curves,
            aim,
            own: choose(&|curve| (&curve.any, &curve.own_kg_s)),
            book: choose(&|curve| (&curve.in_book, &curve.book_kg_s)),
            drawn: (0..draws).map(drawn).collect(),
        }
    }

    /// The optimum at a level.
    pub(super) fn speed(&self, level: usize) -> Option<SpeedOptimum> {
        let (own, book) = (self.own[level]?, self.book[level]);
        let curve = &self.curves[level].1;
        let drawn = self.drawn.iter().filter_map(|choice| choice[level]);
        let machs = drawn.map(|choice| Drawn {
            value: self.mach((level, choice.at)),
            may_be_lower: choice.edge == Some(Edge::Lowest),
            may_be_higher: choice.edge == Some(Edge::Highest),
        });
        let (mach_ci95, mach_ci95_open) = interval95_of_drawn(&machs.collect::<Vec<_>>());
        let no_saving = self.no_saving(own.edge.is_some(), book.map(|book| book.edge.is_some()));
        let saving = book
            .filter(|_| no_saving.is_none())
            .map(|book| self.saving((level, own.at), (level, book.at)));
        let point = &curve.points[own.at];
        Some(SpeedOptimum {
            kind: self.aim.kind,
            mach: self.mach((level, own.at)),
            mach_ci95,
            mach_ci95_open,
            edge: own.edge,
            informed_by: point.informed,
            beyond_flights: None,
            fuel_flow_kg_h: curve.own_kg_s[own.at] * SECONDS_PER_HOUR,
            against_predict_percent: None,
            ground_range_m_kg: self.aim.ground_speed_m_s(point) / curve.own_kg_s[own.at],
            book_mach: book.map(|book| self.mach((level, book.at))),
            book_edge: book.and_then(|book| book.edge),
            saving_kg_h: saving.map(|saving| saving.0),
            saving_ci95: saving.and_then(|saving| saving.1),
            no_saving,
        })
    }

    /// The best level.
    pub(super) fn best(&self) -> Option<BestLevel> {
        let own = self.best_of(&self.own, |curve| &curve.own_kg_s)?;
        let book = self.best_of(&self.book, |curve| &curve.book_kg_s);
        let drawn = self.drawn.iter().enumerate().filter_map(|(draw, choice)| {
            let (level, _) = self.best_of(choice, |curve| &curve.drawn_kg_s[draw])?;
            Some(Drawn {
                value: self.curves[level].0,
                may_be_lower: is_open_next(choice, level.checked_sub(1)),
                may_be_higher: is_open_next(choice, level.checked_add(1)),
            })
        });
        let (pressure_altitude_ci95, pressure_altitude_ci95_open) =
            interval95_of_drawn(&drawn.collect::<Vec<_>>());
        let no_saving = self.no_saving(
            is_open(&self.own, own.0) || is_at_edge(&self.own, own.0),
            book.map(|book| is_open(&self.book, book.0) || is_at_edge(&self.book, book.0)),
        );
        let saving = book.filter(|_| no_saving.is_none()).map(|book| self.saving(own, book));
        Some(BestLevel {
            kind: self.aim.kind,
            pressure_altitude_ft: self.curves[own.0].0,
            pressure_altitude_ci95,
            pressure_altitude_ci95_open,
            beyond_flights: None,
            at_edge: self.is_outermost(own.0) || is_open(&self.own, own.0),
            mach: self.mach(own),
            book_pressure_altitude_ft: book.map(|book| self.curves[book.0].0),
            book_mach: book.map(|book| self.mach(book)),
            book_at_edge: book.is_some_and(|book| {
                self.is_outermost(book.0)
                    || is_open(&self.book, book.0)
                    || is_at_edge(&self.book, book.0)
            }),
            saving_kg_h: saving.map(|saving| saving.0),
            saving_ci95: saving.and_then(|saving| saving.1),
            no_saving,
        })
    }

    fn mach(&self, (level, at): LevelAndPoint) -> f64 {
        f64::from(self.curves[level].1.points[at].mach_thousandths) / 1000.0
    }

    /// Whether no level further up or down was asked for.
    const fn is_outermost(&self, level: usize) -> bool {
        level == 0 || level + 1 == self.curves.len()
    }

    /// Why no saving is stated: it is one of an optimum against another, and an optimum that lies at an edge may be elsewhere.
    fn no_saving(&self, own_at_edge: bool, book_at_edge: Option<bool>) -> Option<NoSaving> {
        match (self.aim.kind, book_at_edge, own_at_edge) {
            (Kind::LongRange, _, _) => Some(NoSaving::LongRange),
            (_, None, _) => Some(NoSaving::NoBook),
            (_, Some(true), _) => Some(NoSaving::BookAtEdge),
            (_, Some(false), true) => Some(NoSaving::OwnAtEdge),
            (_, Some(false), false) => None,
        }
    }

    /// Level and point of the least cost among the choices at all levels.
    fn best_of<'f>(
        &'f self,
        choice: &[Option<Choice>],
        flow: impl Fn(&'f Curve) -> &'f [f64],
    ) -> Option<LevelAndPoint> {
        let cost = |(level, at): LevelAndPoint| {
            let curve = &self.curves[level].1;
            self.aim.cost_kg_m(&curve.points[at], flow(curve)[at])
        };
        let chosen = choice.iter().enumerate().filter_map(|(level, at)| Some((level, (*at)?.at)));
        chosen.min_by(|one, other| cost(*one).total_cmp(&cost(*other)))
    }

    /// What a choice saves compared with another, kg/h at the other's ground speed, and its 95 % interval.
    fn saving(&self, own: LevelAndPoint, book: LevelAndPoint) -> (f64, Option<[f64; 2]>) {
        let ground_speed_m_s = self.aim.ground_speed_m_s(&self.curves[book.0].1.points[book.1]);
        let saved = |flow: &dyn Fn(&'c Curve) -> &'c [f64]| {
            let cost = |(level, at): LevelAndPoint| {
                let curve = &self.curves[level].1;
                self.aim.cost_kg_m(&curve.points[at], flow(curve)[at])
            };
            (cost(book) - cost(own)) * ground_speed_m_s * SECONDS_PER_HOUR
        };
        let drawn = (0..self.drawn.len()).map(|draw| saved(&|curve| &curve.drawn_kg_s[draw]));
        (saved(&|curve| &curve.own_kg_s), interval95(drawn.collect()))
    }
}

/// Whether the best level is left open by a level next to it that was asked for: nothing can be chosen there, or an optimum at an
/// edge, than which another may be better.
fn is_open(choices: &[Option<Choice>], level: usize) -> bool {
    let open = |next: Option<usize>| {
        let next = next.and_then(|next| choices.get(next));
        next.is_some_and(|choice| choice.is_none_or(|choice| choice.edge.is_some()))
    };
    open(level.checked_sub(1)) || open(level.checked_add(1))
}

/// The same of one neighbour, and where none was asked for.
fn is_open_next(choices: &[Option<Choice>], next: Option<usize>) -> bool {
    let next = next.and_then(|next| choices.get(next).copied().flatten());
    next.is_none_or(|choice| choice.edge.is_some())
}

/// Whether the choice at a level lies at an edge.
fn is_at_edge(choices: &[Option<Choice>], level: usize) -> bool {
    choices.get(level).copied().flatten().is_some_and(|choice| choice.edge.is_some())
}

/// The values between which 95 % of the draws lie, both of them drawn; `None` without draws.
fn interval95(mut values: Vec<f64>) -> Option<[f64; 2]> {
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    Some([values[last / 40], values[last - last / 40]])
}

/// The same of drawn values, and which of its ends are open: more draws than it leaves out there may lie beyond.
fn interval95_of_drawn(drawn: &[Drawn]) -> (Option<[f64; 2]>, Option<OpenEnds>) {
    let Some([low, high]) = interval95(drawn.iter().map(|one| one.value).collect()) else {
        return (None, None);
    };
    let left_out = drawn.len().saturating_sub(1) / 40;
    let below = drawn.iter().filter(|one| one.value < low || one.may_be_lower).count();
    let above = drawn.iter().filter(|one| one.value > high || one.may_be_higher).count();
    (Some([low, high]), OpenEnds::of(below > left_out, above > left_out))
}

#[cfg(test)]
mod tests {
    use super::super::CostIndex;
    use super::super::fuel::{CurvePoint, Informed};
    use super::*;
    use crate::optimum::Edge;

    const SOUND_M_S: f64 = 295.0;

    /// Fuel for a distance, kg/m, least at a Mach number.
    fn cost_kg_m(mach: f64, best_mach: f64) -> f64 {
        0.003 * (1.0 + 10.0 * (mach - best_mach).powi(2))
    }

    /// A curve over Mach numbers in thousandths, of the model and of the book, each with its optimum.
    fn curve(informed: &[(std::ops::RangeInclusive<u32>, Informed)], own: f64, book: f64) -> Curve {
        let mut curve = Curve::default();
        for (range, informed) in informed {
            for mach_thousandths in range.clone() {
                let mach = f64::from(mach_thousandths) / 1000.0;
                let true_airspeed_m_s = SOUND_M_S * mach;
                curve.any.push(curve.points.len());
                if *informed != Informed::Flights {
                    curve.in_book.push(curve.points.len());
                }
                let informed = *informed;
                curve.points.push(CurvePoint { mach_thousandths, true_airspeed_m_s, informed });
                curve.own_kg_s.push(true_airspeed_m_s * cost_kg_m(mach, own));
                curve.book_kg_s.push(true_airspeed_m_s * cost_kg_m(mach, book));
            }
        }
        curve
    }

    fn aim(kind: Kind) -> Aim {
        Aim::new(kind, 0.0, CostIndex::default())
    }

    /// A guide up to Mach 0.850, flights that inform 0.891 to 0.900 besides. The book would fly 0.878, which nobody knows: it is not
    /// taken from the island that flights inform, where its table is extrapolated, but at the guide's edge, and nothing is saved.
    #[test]
    fn a_book_beyond_its_guide_saves_nothing() {
        let informed = [(700..=850, Informed::GuideAndFlights), (891..=900, Informed::Flights)];
        let curves = [(43_000.0, curve(&informed, 0.80, 0.878))];
        let choices = Choices::new(&curves, aim(Kind::MaximumRange));
        let speed = choices.speed(0).unwrap();
        assert_eq!((speed.mach, speed.edge), (0.8, None));
        assert_eq!((speed.book_mach, speed.book_edge), (Some(0.85), Some(Edge::Highest)));
        assert_eq!((speed.saving_kg_h, speed.no_saving), (None, Some(NoSaving::BookAtEdge)));
        let best = choices.best().unwrap();
        assert_eq!((best.book_mach, best.book_at_edge), (Some(0.85), true));
        assert_eq!((best.saving_kg_h, best.no_saving), (None, Some(NoSaving::BookAtEdge)));
    }

    /// By hand: both inside, the saving is the difference of their costs by the own model at the book's speed. The own optimum in the
    /// island saves nothing that is known.
    #[test]
    fn a_saving_is_one_of_two_optima_inside() {
        let informed = [(700..=850, Informed::Guide), (891..=900, Informed::Flights)];
        let curves = [(43_000.0, curve(&informed, 0.80, 0.82))];
        let speed = Choices::new(&curves, aim(Kind::MaximumRange)).speed(0).unwrap();
        let by_hand = 0.003 * 10.0 * 0.02 * 0.02 * 0.82 * SOUND_M_S * 3600.0;
        assert!((speed.saving_kg_h.unwrap() / by_hand - 1.0).abs() < 1e-6, "{speed:?}");
        assert_eq!(speed.no_saving, None);
        let curves = [(43_000.0, curve(&informed, 0.89, 0.82))];
        let speed = Choices::new(&curves, aim(Kind::MaximumRange)).speed(0).unwrap();
        assert_eq!((speed.mach, speed.edge), (0.891, Some(Edge::Lowest)));
        assert_eq!((speed.saving_kg_h, speed.no_saving), (None, Some(NoSaving::OwnAtEdge)));
        let flown = [(700..=850, Informed::Flights)];
        let curves = [(43_000.0, curve(&flown, 0.80, 0.82))];
        let speed = Choices::new(&curves, aim(Kind::MaximumRange)).speed(0).unwrap();
        assert_eq!((speed.book_mach, speed.no_saving), (None, Some(NoSaving::NoBook)));
    }

    /// By hand: of 200 draws at Mach 0.700 to 0.899 the 5th and the 195th end the interval. Five of them that were cut at an edge there
    /// may lie anywhere beyond, so that the end is open; four may not change it.
    #[test]
    fn an_interval_is_open_where_draws_were_cut() {
        let drawn = |cut: std::ops::Range<u32>| -> Vec<Drawn> {
            (0..200)
                .map(|k| Drawn {
                    value: f64::from(700 + k.min(cut.start)) / 1000.0,
                    may_be_lower: false,
                    may_be_higher: cut.contains(&k),
                })
                .collect()
        };
        assert_eq!(interval95_of_drawn(&drawn(200..200)), (Some([0.704, 0.895]), None));
        assert_eq!(interval95_of_drawn(&drawn(196..200)), (Some([0.704, 0.895]), None));
        let open = (Some([0.704, 0.895]), Some(OpenEnds::Upper));
        assert_eq!(interval95_of_drawn(&drawn(195..200)), open);
        let lower: Vec<Drawn> = drawn(150..200)
            .into_iter()
            .map(|one| Drawn { may_be_lower: one.value < 0.71, ..one })
            .collect();
        assert_eq!(interval95_of_drawn(&lower), (Some([0.704, 0.85]), Some(OpenEnds::Both)));
        assert_eq!(interval95_of_drawn(&[]), (None, None));
    }

    /// Drawn models that would fly faster than anything informed: the Mach number's own optimum lies inside, its interval's end does not.
    #[test]
    fn a_drawn_optimum_at_the_edge_opens_the_interval() {
        let informed = [(700..=850, Informed::GuideAndFlights)];
        let with_draws = |best: &[f64]| {
            let mut one = curve(&informed, 0.82, 0.82);
            one.drawn_kg_s =
                best.iter().map(|best| curve(&informed, *best, 0.82).own_kg_s).collect();
            [(41_000.0, one)]
        };
        let of = |best: &[f64]| {
            let curves = with_draws(best);
            Choices::new(&curves, aim(Kind::MaximumRange)).speed(0).unwrap()
        };
        let cut = of(&[0.80, 0.82, 0.87]);
        assert_eq!((cut.edge, cut.mach_ci95), (None, Some([0.80, 0.85])));
        assert_eq!(cut.mach_ci95_open, Some(OpenEnds::Upper));
        assert_eq!(of(&[0.80, 0.82, 0.84]).mach_ci95_open, None);
    }

    /// A level is the best one where both next to it cost more at optima inside. One with its optimum at an edge leaves it open.
    #[test]
    fn a_level_next_to_one_at_its_edge_is_open() {
        let inside = || curve(&[(700..=850, Informed::Guide)], 0.80, 0.80);
        let edge = || curve(&[(820..=850, Informed::Guide)], 0.80, 0.80);
        let curves = [(35_000.0, inside()), (36_000.0, inside()), (37_000.0, edge())];
        let best = Choices::new(&curves, aim(Kind::MaximumRange)).best().unwrap();
        assert_eq!((best.pressure_altitude_ft, best.at_edge), (35_000.0, true));
        assert_eq!(best.no_saving, None, "what was not asked for is no reason");
        let curves = [(35_000.0, edge()), (36_000.0, inside()), (37_000.0, edge())];
        let best = Choices::new(&curves, aim(Kind::MaximumRange)).best().unwrap();
        assert_eq!((best.pressure_altitude_ft, best.at_edge), (36_000.0, true));
        assert_eq!(best.no_saving, Some(NoSaving::BookAtEdge));
    }
}
