//! What a model predicts at flight points, with the standard deviation of what a segment recorded there would show.

use std::sync::Arc;

use diagnose::{WholeModel, WholeModelOfLevels, WholePrediction};
use effects::{AppliedEffects, EffectModelError, ExtendedModel};
use flight::{Cruise, FlightIdentity, Segment, SegmentMeans, Timestamp};
use perf_model::{FlightPoint, Prediction};
use units::{FuelFlowTotal, Temperature};

use crate::model_file::ModelFile;
use crate::whole_model::Predicts;

use figures::Asked;

mod figures;
mod of_segments;
mod points;

pub use figures::PredictedColumn;
pub use of_segments::{columns_of_segments, point_of_segment};
pub use points::{PredictedPoints, measured_kg_s, reason_of_row};

/// Samples of the segment that a standard deviation is of, as many as the whole model's is of.
const SAMPLES: u32 = 10;

/// A model, prepared for any number of predictions.
#[derive(Debug)]
pub struct Predictor<'a> {
    model: &'a ModelFile,
    current: ExtendedModel,
    whole: Option<WholeModel<'a>>,
    /// The same for points of conditions alone, where it can be asked that way.
    whole_of_levels: Option<WholeModelOfLevels>,
    /// Without effects: the imagined segment is recorded by the aircraft's sensors without any error of theirs.
    plain: Option<ExtendedModel>,
    /// Relative scatter between flights of an applied effect.
    scatter: f64,
    asked: Asked,
    has_deviations: bool,
}

/// What is predicted at a flight point.
#[derive(Clone, Copy, Debug)]
pub struct PointPrediction {
    /// The prediction, with everything that predicts.
    pub prediction: Prediction,
    /// Standard deviation of the fuel flow of all engines, kg/s; `None` by a law that states none.
    pub fuel_flow_std_kg_s: Option<f64>,
    /// What the rest of what was learnt makes of it; `None` where the table alone predicts.
    pub beside_table: Option<BesideTable>,
}

/// What is said of a flight point by all that was learnt, beside the learnt table.
#[derive(Clone, Copy, Debug)]
pub struct BesideTable {
    /// ln of the fuel flow over that of the learnt table.
    pub ln_fuel_flow: f64,
    /// Whether the point lies beyond what was flown.
    pub beyond_flights: bool,
}

impl<'a> Predictor<'a> {
    /// A predictor with all that a model has learnt, or with its table alone.
    ///
    /// # Errors
    /// A learnt table that makes no model (law `paper` takes what it is given).
    pub fn new(model: &'a ModelFile, predicts: Predicts) -> Result<Self, EffectModelError> {
        let effects = model.initial.effects();
        let whole = model.whole(predicts);
        Ok(Self {
            current: model.current()?,
            whole_of_levels: whole.as_ref().and_then(WholeModel::of_levels),
            whole,
            plain: model.initial.with_effects(AppliedEffects::default()).ok(),
            scatter: effects.map_or(0.0, AppliedEffects::fuel_heating_value_deviation),
            asked: Asked::EVERYTHING,
            has_deviations: true,
            model,
        })
    }

    /// The same predictions without their standard deviations, which take most of the time of a learnt model.
    #[must_use]
    pub fn without_deviations(self) -> Self {
        Self { has_deviations: false, ..self }
    }

    /// The same predictions at many points, of which these columns alone are wanted: what nobody wants is not computed.
    #[must_use]
    pub fn with_columns(self, columns: &[PredictedColumn]) -> Self {
        Self { asked: Asked::only(columns), ..self }
    }

    /// Whether standard deviations are computed at many points.
    const fn states_deviations(&self) -> bool {
        self.has_deviations && self.asked.has(PredictedColumn::FuelFlowDeviation)
    }

    /// Whether more than the table predicts.
    pub const fn is_whole(&self) -> bool {
        self.whole.is_some()
    }

    /// The prediction at a flight point.
    ///
    /// # Errors
    /// Why there is none, in words: a number outside its domain, a point outside the table.
    pub fn at(&self, point: &FlightPoint) -> Result<PointPrediction, String> {
        let by_table = self.current.predict(point).map_err(|error| error.to_string())?;
        let Some(whole) = &self.whole else {
            return Ok(PointPrediction {
                prediction: by_table,
                fuel_flow_std_kg_s: self.deviation(point, &by_table, None),
                beside_table: None,
            });
        };
        let found = whole.of_point(point).map_err(|error| error.to_string())?;
        let beyond = found.ln_fuel_flow - by_table.fuel_flow_total.to_kilograms_per_second().ln();
        let total = FuelFlowTotal::kilograms_per_second(found.ln_fuel_flow.exp());
        let prediction = by_table.with_fuel_flow(total, point);
        Ok(PointPrediction {
            prediction,
            fuel_flow_std_kg_s: self.deviation(point, &prediction, Some(&found)),
            beside_table: Some(BesideTable {
                ln_fuel_flow: beyond,
                beyond_flights: found.beyond_flights,
            }),
        })
    }

    /// Standard deviation, in kg/s, of what a segment recorded there would show: the uncertainty of what was learnt, the
    /// part common to a flight, the segment's own noise, and any applied scatter between flights. By the whole model the
    /// noise is as large as flights showed it to be, by the table alone as the aircraft's sensors and the law's settings
    /// have it.
    fn deviation(
        &self,
        point: &FlightPoint,
        prediction: &Prediction,
        whole: Option<&WholePrediction>,
    ) -> Option<f64> {
        if !self.states_deviations() {
            return None;
        }
        // The imagined segment is recorded by the aircraft's sensors without any error of theirs.
        let plain = self.plain.as_ref()?;
        let total_kg_s = prediction.fuel_flow_total.to_kilograms_per_second();
        let kg_s = if let Some(whole) = whole {
            whole.variance().sqrt() * total_kg_s
        } else {
            let posterior = self.model.posterior()?;
            let segment = imagined_segment(point, prediction, plain);
            let sensors = plain.observe(&segment).ok()?.variance;
            let per_relative_drag_kg_s = posterior.initial().interpolate(&prediction.cell)
                * prediction.fuel_flow_per_drag_coefficient_kg_s;
            posterior.segment_variance(&prediction.cell, &sensors).sqrt() * per_relative_drag_kg_s
        };
        Some(self.with_scatter(kg_s, total_kg_s))
    }

    /// A standard deviation with any applied scatter between flights.
    fn with_scatter(&self, kg_s: f64, total_kg_s: f64) -> f64 {
        if self.scatter > 0.0 { kg_s.hypot(self.scatter * total_kg_s) } else { kg_s }
    }
}

/// The segment that the aircraft would record at a flight point if it burnt what is predicted.
fn imagined_segment(
    point: &FlightPoint,
    prediction: &Prediction,
    model: &effects::ExtendedModel,
) -> Segment {
    let engines = model.aircraft().engines();
    let cruise = SegmentMeans::cruise(&Cruise {
        pressure_altitude: point.pressure_altitude,
        static_air_temperature: point
            .static_air_temperature()
            .unwrap_or(Temperature::kelvin(f64::NAN)),
        mach: point.mach,
        true_airspeed: prediction.true_airspeed,
        mass: point.mass,
        fuel_flow_total: prediction.fuel_flow_total,
    });
    let means = SegmentMeans {
        fuel_flow_engine_kg_s: vec![cruise.fuel_flow_total_kg_s / engines as f64; engines],
        ..cruise
    };
    let identity = FlightIdentity {
        tail: String::new(),
        start: point.date.unwrap_or(Timestamp::UNIX_EPOCH),
        flight: String::new(),
    };
    Segment {
        identity: Arc::new(identity),
        rows: (0..SAMPLES).collect(),
        means,
        temperature_assumed: false,
    }
}

#[cfg(test)]
pub(crate) mod tests;
