//! Fuel flow over Mach number at a level: by the model, by the book, and by models drawn from what is known.

use effects::ExtendedModel;
use lut::{Outside, SmoothCell, Table};
use perf_model::FlightPoint;
use perf_model::model::NODE_WEIGHT_THRESHOLD;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use serde::Serialize;
use units::{Mach, PressureAltitude};

use super::MassAndDay;
use crate::model_file::ModelFile;

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
#[derive(Clone, Debug)]
pub struct OptimumModel {
    own: ExtendedModel,
    book: Table,
    drawn: Vec<Table>,
    informed_by_flights: Vec<bool>,
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

impl OptimumModel {
    /// A model as it stands, and `draws` models drawn from what it knows (none by law `paper`, which does not say how well
    /// it knows, or where nothing was learnt).
    ///
    /// # Errors
    /// As for [`ModelFile::current`].
    pub fn new(
        model: &ModelFile,
        draws: usize,
        seed: u64,
    ) -> Result<Self, effects::EffectModelError> {
        let nodes = model.grid().nodes();
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let drawn = model.posterior().map_or_else(Vec::new, |posterior| {
            let mut numbers = || (0..nodes).map(|_| StandardNormal.sample(&mut random)).collect();
            (0..draws)
                .map(|_| {
                    let numbers: Vec<f64> = numbers();
                    posterior.drawn(&numbers)
                })
                .collect()
        });
        Ok(Self {
            own: model.current()?,
            book: model.initial.drag_table().clone(),
            drawn,
            informed_by_flights: model
                .learnt
                .as_ref()
                .map_or_else(|| vec![false; nodes], |learnt| learnt.law.informed()),
        })
    }

    /// Fuel flow at a level, over every thousandth of a Mach number at which the model is informed.
    pub(super) fn curve(&self, condition: MassAndDay, level: PressureAltitude) -> Curve {
        let axis = self.book.grid().y();
        let mut curve =
            Curve { drawn_kg_s: vec![Vec::new(); self.drawn.len()], ..Curve::default() };
        for mach_thousandths in thousandths(axis.first(), axis.last()) {
            let mach = Mach::new(f64::from(mach_thousandths) / 1000.0);
            let mut point = FlightPoint::new(condition.mass, level, mach);
            point.isa_deviation = condition.isa_deviation;
            self.add(&mut curve, mach_thousandths, &point);
        }
        curve
    }

    /// Adds a point to a curve, unless the model is not informed there.
    ///
    /// Fuel flow is what the model predicts, moved from the bilinear drag coefficient to the smooth one:
    ///
    /// ```text
    /// Wf = Ŵf + (CD_smooth − CD_bilinear)·∂Ŵf/∂CD                                              [optimum.1]
    /// ```
    fn add(&self, curve: &mut Curve, mach_thousandths: u32, point: &FlightPoint) -> Option<()> {
        let plain = self.own.base().predict(point).ok()?;
        let own = if self.own.effects().is_some() { self.own.predict(point).ok()? } else { plain };
        let mach = point.mach.value();
        let informed = self.informed(plain.lift_coefficient, mach)?;
        let cell = SmoothCell::locate(self.book.grid(), plain.lift_coefficient, mach).ok()?;
        let by = |table: &Table, prediction: &perf_model::Prediction| {
            prediction.fuel_flow_total.to_kilograms_per_second()
                + (cell.value_of(table) - plain.drag_coefficient)
                    * prediction.fuel_flow_per_drag_coefficient_kg_s
        };
        let own_kg_s = by(self.own.drag_table(), &own);
        let book_kg_s = by(&self.book, &plain);
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
        for (drawn, table) in curve.drawn_kg_s.iter_mut().zip(&self.drawn) {
            drawn.push(by(table, &own));
        }
        Some(())
    }

    /// What informs the model at a point; `None` where nothing does.
    fn informed(&self, lift_coefficient: f64, mach: f64) -> Option<Informed> {
        let cell = self.book.grid().locate(lift_coefficient, mach, Outside::Error).ok()?;
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
