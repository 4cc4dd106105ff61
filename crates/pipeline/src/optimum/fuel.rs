//! Fuel flow over Mach number at a level: by the model, by the book, and by models drawn from what is known.

use diagnose::WholeModel;
use effects::ExtendedModel;
use lut::{Outside, SmoothCell, Table};
use perf_model::model::NODE_WEIGHT_THRESHOLD;
use perf_model::{FlightPoint, GuidePlace, Prediction};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use serde::Serialize;
use units::{Mach, PressureAltitude};

use super::MassAndDay;
use crate::model_file::ModelFile;
use crate::prediction::{PointPrediction, Predictor};
use crate::whole_model::Predicts;

/// What informs a model at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Informed {
    /// The point lies within the guide's lift coefficients and Mach numbers.
    Guide,
    /// Learnt flights informed every node about the point, and the guide does not reach it.
    Flights,
    /// Both.
    GuideAndFlights,
}

/// A model and the book, ready for many points.
#[derive(Debug)]
pub struct OptimumModel<'a> {
    own: ExtendedModel,
    book: &'a ExtendedModel,
    learnt: Learnt<'a>,
    informed_by_flights: Vec<bool>,
    predictor: Predictor<'a>,
}

/// What a model has learnt, and models drawn from how well it knows it.
#[derive(Debug)]
enum Learnt<'a> {
    /// No more than a table, and tables drawn from what is known of it.
    Table(Vec<Table>),
    /// More than a table; for each drawn model standard normal numbers, one for each loading and the last for where nothing was
    /// flown.
    Whole(Box<WholeModel<'a>>, Vec<Vec<f64>>),
}

/// One Mach number of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvePoint {
    /// Mach number, thousandths.
    pub(super) mach_thousandths: u32,
    pub(super) true_airspeed_m_s: f64,
    pub(super) informed: Informed,
}

/// Fuel flow over the Mach numbers at which a model is informed, at one level.
#[derive(Clone, Debug, Default)]
pub(super) struct Curve {
    pub(super) points: Vec<CurvePoint>,
    /// All of them.
    pub(super) any: Vec<usize>,
    /// Those that the guide informs: elsewhere the initial table is an extrapolation, and nobody's book.
    pub(super) in_book: Vec<usize>,
    /// Fuel flow of all engines at each point, kg/s, by the model.
    pub(super) own_kg_s: Vec<f64>,
    /// By the book.
    pub(super) book_kg_s: Vec<f64>,
    /// By each drawn model.
    pub(super) drawn_kg_s: Vec<Vec<f64>>,
}

impl<'a> OptimumModel<'a> {
    /// A model as it stands, and `draws` models drawn from what it knows (none by law `paper`, which does not say how well
    /// it knows, or where nothing was learnt).
    ///
    /// # Errors
    /// As for [`ModelFile::current`].
    pub fn new(
        model: &'a ModelFile,
        draws: usize,
        seed: u64,
    ) -> Result<Self, effects::EffectModelError> {
        let nodes = model.grid().nodes();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut numbers = |count: usize| -> Vec<f64> {
            (0..count).map(|_| StandardNormal.sample(&mut random)).collect()
        };
        let learnt = if let Some(whole) = model.whole(Predicts::WholeModel) {
            let count = whole.directions() + 1;
            Learnt::Whole(Box::new(whole), (0..draws).map(|_| numbers(count)).collect())
        } else {
            Learnt::Table(model.posterior().map_or_else(Vec::new, |posterior| {
                (0..draws).map(|_| posterior.drawn(&numbers(nodes))).collect()
            }))
        };
        // A table alone goes on from the polynomial: against the guide's rows what that loses of them would be a saving.
        let has_whole = model.has_whole_model();
        let book = if has_whole { model.reference() } else { &model.initial };
        Ok(Self {
            own: model.current()?,
            book,
            learnt,
            informed_by_flights: model
                .learnt
                .as_ref()
                .map_or_else(|| vec![false; nodes], |learnt| learnt.law.informed()),
            predictor: Predictor::new(model, Predicts::WholeModel)?.without_deviations(),
        })
    }

    const fn draws(&self) -> usize {
        match &self.learnt {
            Learnt::Table(drawn) => drawn.len(),
            Learnt::Whole(_, drawn) => drawn.len(),
        }
    }

    /// Fuel flow at a level, over every thousandth of a Mach number at which the model is informed.
    pub(super) fn curve(&self, condition: MassAndDay, level: PressureAltitude) -> Curve {
        let axis = self.book.drag_table().grid().y();
        let mut curve = Curve { drawn_kg_s: vec![Vec::new(); self.draws()], ..Curve::default() };
        for mach_thousandths in thousandths(axis.first(), axis.last()) {
            let mach = f64::from(mach_thousandths) / 1000.0;
            self.add(&mut curve, mach_thousandths, &point_at(condition, level, mach));
        }
        curve
    }

    /// What `predict` states of a point.
    pub(super) fn predicted(
        &self,
        condition: MassAndDay,
        level: PressureAltitude,
        mach: f64,
    ) -> Option<PointPrediction> {
        self.predictor.at(&point_at(condition, level, mach)).ok()
    }

    /// Adds a point to a curve, unless the model is not informed there.
    ///
    /// Fuel flow is what the model predicts with all that it has learnt, with a drag table that is smooth between its nodes. Of a
    /// model that is no more than a table:
    ///
    /// ```text
    /// Wf = Ŵf + (CD_smooth − CD_bilinear)·∂Ŵf/∂CD,   both without the effects that the model contains    [optimum.1]
    /// ```
    fn add(&self, curve: &mut Curve, mach_thousandths: u32, point: &FlightPoint) -> Option<()> {
        let plain = self.own.base().predict(point).ok()?;
        let mach = point.mach.value();
        let informed = self.informed(plain.lift_coefficient, mach)?;
        let grid = self.book.drag_table().grid();
        let cell = SmoothCell::locate(grid, plain.lift_coefficient, mach).ok()?;
        let place = GuidePlace {
            lift_coefficient: plain.lift_coefficient,
            mach,
            pressure_altitude: point.pressure_altitude,
        };
        let book = self.book.base();
        let book_drag = cell.value_of(book.drag_table()) * book.level_factor(place);
        let book_kg_s = with_drag(&plain, &plain, book_drag);
        let (own_kg_s, drawn_kg_s) = self.own_kg_s(point, (&cell, place), &plain)?;
        if !(own_kg_s > 0.0 && book_kg_s > 0.0) {
            return None;
        }
        curve.any.push(curve.points.len());
        if informed != Informed::Flights {
            curve.in_book.push(curve.points.len());
        }
        curve.points.push(CurvePoint {
            mach_thousandths,
            true_airspeed_m_s: plain.true_airspeed.to_meters_per_second(),
            informed,
        });
        curve.own_kg_s.push(own_kg_s);
        curve.book_kg_s.push(book_kg_s);
        for (drawn, flow) in curve.drawn_kg_s.iter_mut().zip(drawn_kg_s) {
            drawn.push(flow);
        }
        Some(())
    }

    /// Fuel flow by the model, and by each drawn model; `plain` is what its table predicts without the effects that it contains.
    fn own_kg_s(
        &self,
        point: &FlightPoint,
        (cell, place): (&SmoothCell, GuidePlace),
        plain: &Prediction,
    ) -> Option<(f64, Vec<f64>)> {
        match &self.learnt {
            Learnt::Table(drawn) => {
                let with_effects = match self.own.effects() {
                    Some(_) => &self.own.predict(point).ok()?,
                    None => plain,
                };
                let factor = self.own.base().level_factor(place);
                let by_table =
                    |table| with_drag(with_effects, plain, cell.value_of(table) * factor);
                let drawn = drawn.iter().map(by_table).collect();
                Some((by_table(self.own.drag_table()), drawn))
            }
            Learnt::Whole(whole, draws) => {
                let found = whole.smooth_of_point(point).ok()?;
                let own_kg_s = found.ln_fuel_flow.exp();
                // Where nothing was flown a model errs alike everywhere.
                let mut leans = found.loadings;
                leans.push(found.unflown.sqrt());
                let drawn = draws.iter().map(|numbers| {
                    let ln: f64 = leans.iter().zip(numbers).map(|(lean, one)| lean * one).sum();
                    own_kg_s * ln.exp()
                });
                Some((own_kg_s, drawn.collect()))
            }
        }
    }

    /// What informs the model at a point; `None` where nothing does.
    fn informed(&self, lift_coefficient: f64, mach: f64) -> Option<Informed> {
        let cell =
            self.book.drag_table().grid().locate(lift_coefficient, mach, Outside::Error).ok()?;
        let parts = || {
            let nodes = cell.nodes().into_iter().zip(cell.weights());
            nodes.filter(|(_, weight)| *weight > NODE_WEIGHT_THRESHOLD).map(|(node, _)| node)
        };
        let by_guide = parts().all(|node| !self.own.extrapolated()[node]);
        let by_flights = parts().all(|node| self.informed_by_flights[node]);
        match (by_guide, by_flights) {
            (true, true) => Some(Informed::GuideAndFlights),
            (true, false) => Some(Informed::Guide),
            (false, true) => Some(Informed::Flights),
            (false, false) => None,
        }
    }
}

fn point_at(condition: MassAndDay, level: PressureAltitude, mach: f64) -> FlightPoint {
    FlightPoint {
        isa_deviation: condition.isa_deviation,
        ..FlightPoint::new(condition.mass, level, Mach::new(mach))
    }
}

/// What is predicted, with this drag in place of that of the table; `plain` is the prediction without the effects that the model
/// contains.
fn with_drag(predicted: &Prediction, plain: &Prediction, drag_coefficient: f64) -> f64 {
    predicted.fuel_flow_total.to_kilograms_per_second()
        + (drag_coefficient - plain.drag_coefficient)
            * predicted.fuel_flow_per_drag_coefficient_kg_s
}

/// Every thousandth from the first to the last Mach number of a table.
fn thousandths(first: f64, last: f64) -> std::ops::RangeInclusive<u32> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "Mach numbers of a table are between 0 and a few"
    )]
    let round = |value: f64| value.max(0.0) as u32;
    round((first * 1000.0 - 1e-6).ceil())..=round((last * 1000.0 + 1e-6).floor())
}
