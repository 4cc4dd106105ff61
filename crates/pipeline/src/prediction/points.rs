//! Predictions at many flight points, as columns.

use perf_model::fuel_flow::fuel_flow_error_percent;
use perf_model::{FlightPoint, LevelFlights};
use units::{FuelFlowTotal, Mach, Mass, PressureAltitude, TemperatureDifference};

use super::{PointPrediction, Predictor};
use crate::columns::Columns;

/// Predictions at many flight points.
#[derive(Clone, Debug, Default)]
pub struct PredictedPoints {
    /// Names and values, NaN where there is none: `fuel_flow_kg_s`, `fuel_flow_std_kg_s` (none by law `paper`),
    /// `specific_range_m_kg`, `lift_coefficient`, `drag_coefficient`, `extrapolated` (1 or 0), with measured fuel flows
    /// `error_percent`, and where more than the table predicts `remainder_percent`.
    pub columns: Vec<(&'static str, Vec<f64>)>,
    /// Points (from 0) without a prediction, and why.
    pub refused: Vec<(usize, String)>,
}

/// The columns that every prediction has, in order.
#[derive(Debug)]
struct Figures {
    fuel_flow_kg_s: Vec<f64>,
    fuel_flow_std_kg_s: Vec<f64>,
    specific_range_m_kg: Vec<f64>,
    lift_coefficient: Vec<f64>,
    drag_coefficient: Vec<f64>,
    extrapolated: Vec<f64>,
    remainder_percent: Vec<f64>,
}

impl Predictor<'_> {
    /// Whether mass, pressure altitude, Mach number and deviation from the ISA alone decide a prediction. It is then computed
    /// over columns, within 1e-12 of what [`at`](Self::at) finds.
    pub fn needs_conditions_only(&self) -> bool {
        self.whole.is_none() && self.current.without_applied().is_some()
    }

    /// Predictions at flight points. `measured_kg_s`, where anything was measured: fuel flow at each point, NaN where none.
    pub fn at_points(
        &self,
        points: &[FlightPoint],
        measured_kg_s: Option<&[f64]>,
    ) -> PredictedPoints {
        if self.needs_conditions_only() {
            let column = |of: fn(&FlightPoint) -> f64| points.iter().map(of).collect::<Vec<_>>();
            let flights = LevelFlights {
                mass_kg: &column(|point| point.mass.to_kilograms()),
                pressure_altitude_m: &column(|point| point.pressure_altitude.to_meters()),
                mach: &column(|point| point.mach.value()),
                isa_deviation_k: &column(|point| point.isa_deviation.to_kelvin()),
            };
            return self.by_columns(flights, measured_kg_s);
        }
        let (mut figures, mut refused) = (Figures::none(points.len()), Vec::new());
        for (place, point) in points.iter().enumerate() {
            match self.at(point) {
                Ok(found) => figures.set(place, &found),
                Err(reason) => refused.push((place, reason)),
            }
        }
        figures.into_predicted(self, measured_kg_s, refused)
    }

    /// The same at points of which no more is known than what columns of level flights hold.
    pub fn at_level_flights(
        &self,
        flights: LevelFlights<'_>,
        measured_kg_s: Option<&[f64]>,
    ) -> PredictedPoints {
        if self.needs_conditions_only() {
            return self.by_columns(flights, measured_kg_s);
        }
        let points: Vec<FlightPoint> =
            (0..flights.count()).map(|place| point_of(flights, place)).collect();
        self.at_points(&points, measured_kg_s)
    }

    fn by_columns(
        &self,
        flights: LevelFlights<'_>,
        measured_kg_s: Option<&[f64]>,
    ) -> PredictedPoints {
        let model = self.current.base();
        let mut figures = Figures::none(flights.count());
        let variances = self.model.posterior().map(adapt::bayes::Posterior::variance_by_cell);
        let known = variances.as_ref().zip(self.plain.as_ref());
        let mut next = 0;
        let mut refused = Vec::new();
        let mut refuse_up_to = |figures: &mut Figures, next: usize, place: usize| {
            for missing in next..place {
                // Columns say no reason, and a limit may be drawn a rounding apart.
                match self.at(&point_of(flights, missing)) {
                    Ok(found) => figures.set(missing, &found),
                    Err(reason) => refused.push((missing, reason)),
                }
            }
        };
        model.predict_level(flights, |place, predicted| {
            refuse_up_to(&mut figures, next, place);
            next = place + 1;
            let total_kg_s = predicted.fuel_flow_total.to_kilograms_per_second();
            figures.fuel_flow_kg_s[place] = total_kg_s;
            figures.specific_range_m_kg[place] =
                predicted.specific_range().to_meters_per_kilogram();
            figures.lift_coefficient[place] = predicted.lift_coefficient;
            figures.drag_coefficient[place] = predicted.drag_coefficient;
            figures.extrapolated[place] = flag(model.uses_extrapolated(&predicted.cell));
            if let Some((variances, plain)) = known {
                let of_sensors = plain.base().level_variance(predicted, super::SAMPLES as usize);
                let per_relative_drag_kg_s = plain.drag_table().interpolate(&predicted.cell)
                    * predicted.fuel_flow_per_drag_coefficient_kg_s;
                let kg_s = variances.segment_variance(&predicted.cell, &of_sensors).sqrt()
                    * per_relative_drag_kg_s;
                figures.fuel_flow_std_kg_s[place] = self.with_scatter(kg_s, total_kg_s);
            }
        });
        refuse_up_to(&mut figures, next, flights.count());
        figures.into_predicted(self, measured_kg_s, refused)
    }
}

impl Figures {
    fn none(count: usize) -> Self {
        let none = || vec![f64::NAN; count];
        Self {
            fuel_flow_kg_s: none(),
            fuel_flow_std_kg_s: none(),
            specific_range_m_kg: none(),
            lift_coefficient: none(),
            drag_coefficient: none(),
            extrapolated: none(),
            remainder_percent: Vec::new(),
        }
    }

    fn set(&mut self, place: usize, found: &PointPrediction) {
        let prediction = &found.prediction;
        self.fuel_flow_kg_s[place] = prediction.fuel_flow_total.to_kilograms_per_second();
        self.fuel_flow_std_kg_s[place] = found.fuel_flow_std_kg_s.unwrap_or(f64::NAN);
        self.specific_range_m_kg[place] = prediction.specific_range.to_meters_per_kilogram();
        self.lift_coefficient[place] = prediction.lift_coefficient;
        self.drag_coefficient[place] = prediction.drag_coefficient;
        self.extrapolated[place] = flag(prediction.extrapolated);
        if let Some(beyond) = found.beyond_table {
            self.remainder_percent.resize(self.fuel_flow_kg_s.len(), f64::NAN);
            self.remainder_percent[place] = 100.0 * beyond.exp_m1();
        }
    }

    fn into_predicted(
        mut self,
        predictor: &Predictor<'_>,
        measured_kg_s: Option<&[f64]>,
        refused: Vec<(usize, String)>,
    ) -> PredictedPoints {
        let error_percent = measured_kg_s.map(|measured| {
            let flows = measured.iter().zip(&self.fuel_flow_kg_s);
            flows.map(|(measured, predicted)| error_percent(*measured, *predicted)).collect()
        });
        self.remainder_percent.resize(self.fuel_flow_kg_s.len(), f64::NAN);
        let mut columns = vec![
            ("fuel_flow_kg_s", self.fuel_flow_kg_s),
            ("fuel_flow_std_kg_s", self.fuel_flow_std_kg_s),
            ("specific_range_m_kg", self.specific_range_m_kg),
            ("lift_coefficient", self.lift_coefficient),
            ("drag_coefficient", self.drag_coefficient),
            ("extrapolated", self.extrapolated),
        ];
        columns.extend(error_percent.map(|values| ("error_percent", values)));
        if predictor.is_whole() {
            columns.push(("remainder_percent", self.remainder_percent));
        }
        PredictedPoints { columns, refused }
    }
}

impl PredictedPoints {
    /// Appends the columns to others.
    pub fn append_to(self, columns: &mut Columns) {
        for (name, values) in self.columns {
            columns.dense(name, values);
        }
    }
}

/// Measured fuel flow of all engines at each point, kg/s, NaN where none.
pub fn measured_kg_s(points: &[FlightPoint]) -> Vec<f64> {
    let measured = points.iter().map(|point| point.measured_fuel_flow_total);
    measured.map(|flow| flow.map_or(f64::NAN, FuelFlowTotal::to_kilograms_per_second)).collect()
}

const fn flag(is_set: bool) -> f64 {
    if is_set { 1.0 } else { 0.0 }
}

fn error_percent(measured_kg_s: f64, predicted_kg_s: f64) -> f64 {
    let total = FuelFlowTotal::kilograms_per_second;
    fuel_flow_error_percent(total(measured_kg_s), total(predicted_kg_s))
}

fn point_of(flights: LevelFlights<'_>, place: usize) -> FlightPoint {
    FlightPoint {
        isa_deviation: TemperatureDifference::kelvin(flights.isa_deviation_k[place]),
        ..FlightPoint::new(
            Mass::kilograms(flights.mass_kg[place]),
            PressureAltitude::meters(flights.pressure_altitude_m[place]),
            Mach::new(flights.mach[place]),
        )
    }
}
