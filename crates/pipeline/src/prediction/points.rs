//! Predictions at many flight points, as columns.

use diagnose::{LevelCorrection, LevelQuestion, WholeModelOfLevels};
use perf_model::fuel_flow::fuel_flow_error_percent;
use perf_model::{FlightPoint, LevelFlights, LevelPrediction, specific_range::specific_range};
use units::{FuelFlowTotal, Mach, Mass, PressureAltitude, TemperatureDifference};

use super::{PointPrediction, Predictor};
use crate::columns::Columns;

/// Predictions at many flight points.
#[derive(Clone, Debug, Default)]
pub struct PredictedPoints {
    /// Names and values, NaN where there is none: `fuel_flow_kg_s`, `fuel_flow_std_kg_s` (none by law `paper`
    /// and where it is not asked for),
    /// `specific_range_m_kg`, `lift_coefficient`, `drag_coefficient`, `extrapolated` (1 or 0), with measured fuel flows
    /// `error_percent`, and where more than the table predicts `remainder_percent` and `beyond_flights` (1 or 0).
    pub columns: Vec<(&'static str, Vec<f64>)>,
    /// Points (from 0) without a prediction, and why.
    pub refused: Vec<(usize, String)>,
}

/// Points without a prediction, and why.
type Refused = Vec<(usize, String)>;

/// The columns that every prediction has, in order.
#[derive(Debug)]
struct Figures {
    fuel_flow_kg_s: Vec<f64>,
    fuel_flow_std_kg_s: Vec<f64>,
    specific_range_m_kg: Vec<f64>,
    lift_coefficient: Vec<f64>,
    drag_coefficient: Vec<f64>,
    extrapolated: Vec<f64>,
    /// Of more than the table; empty where that alone predicts.
    remainder_percent: Vec<f64>,
    beyond_flights: Vec<f64>,
}

impl Predictor<'_> {
    /// Whether predictions at points of which mass, pressure altitude, Mach number and deviation from the ISA alone are known
    /// are computed over columns: within 1e-12 of what [`at`](Self::at) finds, by the whole model within 1e-9 and its standard
    /// deviations within 1e-5.
    pub fn predicts_columns(&self) -> bool {
        let whole = self.whole.is_none() || self.whole_of_levels.is_some();
        whole && self.current.without_applied().is_some()
    }

    /// Predictions at flight points. `measured_kg_s`, where anything was measured: fuel flow at each point, NaN where none.
    pub fn at_points(
        &self,
        points: &[FlightPoint],
        measured_kg_s: Option<&[f64]>,
    ) -> PredictedPoints {
        let (mut figures, mut refused) = (Figures::none(points.len()), Vec::new());
        // Whether a point goes over columns is a matter of the point alone, not of those around it.
        let is_plain = |point: &FlightPoint| self.predicts_columns() && self.is_plain(point);
        let plain: Vec<usize> =
            (0..points.len()).filter(|place| is_plain(&points[*place])).collect();
        let column = |of: fn(&FlightPoint) -> f64| {
            plain.iter().map(|place| of(&points[*place])).collect::<Vec<_>>()
        };
        let (found, without) = self.by_columns(LevelFlights {
            mass_kg: &column(|point| point.mass.to_kilograms()),
            pressure_altitude_m: &column(|point| point.pressure_altitude.to_meters()),
            mach: &column(|point| point.mach.value()),
            isa_deviation_k: &column(|point| point.isa_deviation.to_kelvin()),
        });
        figures.set_all(&plain, &found);
        refused.extend(without.into_iter().map(|(place, reason)| (plain[place], reason)));
        let mut plain = plain.into_iter().peekable();
        for (place, point) in points.iter().enumerate() {
            if plain.next_if_eq(&place).is_some() {
                continue;
            }
            match self.at(point) {
                Ok(found) => figures.set(place, &found),
                Err(reason) => refused.push((place, reason)),
            }
        }
        refused.sort_by_key(|(place, _)| *place);
        figures.into_predicted(self, measured_kg_s, refused)
    }

    /// The same at points of which no more is known than what columns of level flights hold.
    pub fn at_level_flights(
        &self,
        flights: LevelFlights<'_>,
        measured_kg_s: Option<&[f64]>,
    ) -> PredictedPoints {
        if self.predicts_columns() {
            let (figures, refused) = self.by_columns(flights);
            return figures.into_predicted(self, measured_kg_s, refused);
        }
        let points: Vec<FlightPoint> =
            (0..flights.count()).map(|place| point_of(flights, place)).collect();
        self.at_points(&points, measured_kg_s)
    }

    /// Whether no more than what columns hold decides the prediction at a point.
    fn is_plain(&self, point: &FlightPoint) -> bool {
        self.whole.is_none()
            || (point.latitude.is_none()
                && point.true_heading.is_none()
                && point.center_of_gravity_percent_mac.is_none()
                && point.anti_ice != Some(true))
    }

    fn by_columns(&self, flights: LevelFlights<'_>) -> (Figures, Refused) {
        if let Some(whole) = &self.whole_of_levels {
            return self.by_whole_columns(whole, flights);
        }
        let model = self.current.base();
        let mut figures = Figures::none(flights.count());
        let posterior = self.model.posterior().filter(|_| self.states_deviations);
        let variances = posterior.map(adapt::bayes::Posterior::variance_by_cell);
        let known = variances.as_ref().zip(self.plain.as_ref());
        let mut next = 0;
        let mut refused = Vec::new();
        model.predict_level(flights, |place, predicted| {
            self.one_by_one(flights, next..place, &mut figures, &mut refused);
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
        self.one_by_one(flights, next..flights.count(), &mut figures, &mut refused);
        (figures, refused)
    }

    /// All that was learnt refers to the initial table; what else is stated of a point is by the learnt one, on the same grid.
    fn by_whole_columns(
        &self,
        whole: &WholeModelOfLevels,
        flights: LevelFlights<'_>,
    ) -> (Figures, Refused) {
        let initial = self.model.initial.base();
        let mut figures = Figures::none(flights.count());
        figures.predict_beside_table();
        let mut refused = Vec::new();
        let question = if self.states_deviations {
            LevelQuestion::MeansAndVariances
        } else {
            LevelQuestion::Means
        };
        let (mut places, mut block) = (Vec::new(), Vec::new());
        let mut next = 0;
        let mut answer = |places: &mut Vec<usize>, block: &mut Vec<LevelPrediction>| {
            let found = whole.corrections(block, question);
            for ((place, predicted), found) in places.iter().zip(&*block).zip(found) {
                let Some(found) = found else { continue };
                self.one_by_one(flights, next..*place, &mut figures, &mut refused);
                next = *place + 1;
                self.set_corrected(&mut figures, *place, predicted, &found);
            }
            places.clear();
            block.clear();
        };
        initial.predict_level(flights, |place, predicted| {
            places.push(place);
            block.push(*predicted);
            if block.len() == WholeModelOfLevels::TOGETHER {
                answer(&mut places, &mut block);
            }
        });
        answer(&mut places, &mut block);
        self.one_by_one(flights, next..flights.count(), &mut figures, &mut refused);
        (figures, refused)
    }

    fn set_corrected(
        &self,
        figures: &mut Figures,
        place: usize,
        predicted: &LevelPrediction,
        found: &LevelCorrection,
    ) {
        let current = self.current.base();
        let total_kg_s = predicted.fuel_flow_total.to_kilograms_per_second() * found.ratio;
        let drag_coefficient = current.drag_table().interpolate(&predicted.cell);
        let by_table_kg_s = drag_coefficient * predicted.fuel_flow_per_drag_coefficient_kg_s;
        let total = FuelFlowTotal::kilograms_per_second(total_kg_s);
        figures.fuel_flow_kg_s[place] = total_kg_s;
        figures.fuel_flow_std_kg_s[place] =
            self.with_scatter(found.variance.sqrt() * total_kg_s, total_kg_s);
        figures.specific_range_m_kg[place] =
            specific_range(predicted.true_airspeed, total).to_meters_per_kilogram();
        figures.lift_coefficient[place] = predicted.lift_coefficient;
        figures.drag_coefficient[place] = drag_coefficient;
        figures.extrapolated[place] = flag(current.uses_extrapolated(&predicted.cell));
        figures.remainder_percent[place] = 100.0 * (total_kg_s / by_table_kg_s - 1.0);
        figures.beyond_flights[place] = flag(found.beyond_flights);
    }

    /// Points of which columns say nothing: they give no reason, and a limit may be drawn a rounding apart.
    fn one_by_one(
        &self,
        flights: LevelFlights<'_>,
        places: core::ops::Range<usize>,
        figures: &mut Figures,
        refused: &mut Refused,
    ) {
        for place in places {
            match self.at(&point_of(flights, place)) {
                Ok(found) => figures.set(place, &found),
                Err(reason) => refused.push((place, reason)),
            }
        }
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
            beyond_flights: Vec::new(),
        }
    }

    /// More than the table predicts: there are columns for it.
    fn predict_beside_table(&mut self) {
        let count = self.fuel_flow_kg_s.len();
        self.remainder_percent.resize(count, f64::NAN);
        self.beyond_flights.resize(count, f64::NAN);
    }

    /// The figures of some points, at their places.
    fn set_all(&mut self, places: &[usize], found: &Self) {
        if !found.remainder_percent.is_empty() {
            self.predict_beside_table();
        }
        for (into, from) in [
            (&mut self.fuel_flow_kg_s, &found.fuel_flow_kg_s),
            (&mut self.fuel_flow_std_kg_s, &found.fuel_flow_std_kg_s),
            (&mut self.specific_range_m_kg, &found.specific_range_m_kg),
            (&mut self.lift_coefficient, &found.lift_coefficient),
            (&mut self.drag_coefficient, &found.drag_coefficient),
            (&mut self.extrapolated, &found.extrapolated),
            (&mut self.remainder_percent, &found.remainder_percent),
            (&mut self.beyond_flights, &found.beyond_flights),
        ] {
            for (place, value) in places.iter().zip(from) {
                into[*place] = *value;
            }
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
        if let Some(beside) = found.beside_table {
            self.predict_beside_table();
            self.remainder_percent[place] = 100.0 * beside.ln_fuel_flow.exp_m1();
            self.beyond_flights[place] = flag(beside.beyond_flights);
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
        self.predict_beside_table();
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
            columns.push(("beyond_flights", self.beyond_flights));
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
