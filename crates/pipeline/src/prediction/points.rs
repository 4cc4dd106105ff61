//! Predictions at many flight points, as columns.

use adapt::bayes::Posterior;
use diagnose::{LevelAnswers, LevelQuestion, WholeModelOfLevels};
use effects::ExtendedModel;
use perf_model::specific_range::specific_range;
use perf_model::{CsvError, FlightPoint, LevelBlock, LevelFlights};
use units::{FuelFlowTotal, Mach, Mass, PressureAltitude, TemperatureDifference, TrueAirspeed};

use super::Predictor;
use super::figures::{Figures, PredictedColumn, flag};
use crate::columns::Columns;

/// Predictions at many flight points.
#[derive(Clone, Debug, Default)]
pub struct PredictedPoints {
    /// Names and values of the columns that were asked for, NaN where there is none: those of [`PredictedColumn`] in order. Without
    /// measured fuel flows there are no errors, and beside the table there is something only where more was learnt.
    pub columns: Vec<(&'static str, Vec<f64>)>,
    /// Points (from 0) without a prediction, and why.
    pub refused: Vec<(usize, String)>,
}

/// Points without a prediction, and why.
pub(super) type Refused = Vec<(usize, String)>;

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
        let mut figures = Figures::unknown(self.asked, self.is_whole(), points.len());
        let mut refused = Vec::new();
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
                Ok(found) => figures.set_prediction(place, &found),
                Err(reason) => refused.push((place, reason)),
            }
        }
        refused.sort_by_key(|(place, _)| *place);
        figures.into_predicted(measured_kg_s, refused)
    }

    /// The same at points of which no more is known than what columns of level flights hold.
    pub fn at_level_flights(
        &self,
        flights: LevelFlights<'_>,
        measured_kg_s: Option<&[f64]>,
    ) -> PredictedPoints {
        if self.predicts_columns() {
            let (figures, refused) = self.by_columns(flights);
            return figures.into_predicted(measured_kg_s, refused);
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
        let posterior = self.model.posterior().filter(|_| self.states_deviations());
        match (&self.whole_of_levels, posterior, &self.plain) {
            (None, Some(posterior), Some(plain)) => {
                self.with_deviations_of_table(posterior, plain, flights)
            }
            (whole, ..) => self.by_blocks(whole.as_ref(), flights),
        }
    }

    /// By the table alone, with the standard deviations of law `bayes`, which are asked of every cell.
    fn with_deviations_of_table(
        &self,
        posterior: &Posterior,
        plain: &ExtendedModel,
        flights: LevelFlights<'_>,
    ) -> (Figures, Refused) {
        use PredictedColumn as Column;
        let model = self.current.base();
        let mut figures = Figures::unknown(self.asked, self.is_whole(), flights.count());
        let variances = posterior.variance_by_cell();
        let mut next = 0;
        let mut refused = Vec::new();
        model.predict_level(flights, |place, predicted| {
            self.one_by_one(flights, next..place, &mut figures, &mut refused);
            next = place + 1;
            let total_kg_s = predicted.fuel_flow_total.to_kilograms_per_second();
            figures.set(Column::FuelFlow, place, total_kg_s);
            let of_sensors = plain.base().level_variance(predicted, super::SAMPLES as usize);
            let per_relative_drag_kg_s = plain.drag_table().interpolate(&predicted.cell)
                * predicted.fuel_flow_per_drag_coefficient_kg_s;
            let kg_s = variances.segment_variance(&predicted.cell, &of_sensors).sqrt()
                * per_relative_drag_kg_s;
            let deviation_kg_s = self.with_scatter(kg_s, total_kg_s);
            figures.set(Column::FuelFlowDeviation, place, deviation_kg_s);
            let range_m_kg = predicted.specific_range().to_meters_per_kilogram();
            figures.set(Column::SpecificRange, place, range_m_kg);
            figures.set(Column::LiftCoefficient, place, predicted.lift_coefficient);
            figures.set(Column::DragCoefficient, place, predicted.drag_coefficient);
            let is_extrapolated = model.uses_extrapolated(&predicted.cell);
            figures.set(Column::Extrapolated, place, flag(is_extrapolated));
        });
        self.one_by_one(flights, next..flights.count(), &mut figures, &mut refused);
        (figures, refused)
    }

    /// All that was learnt refers to the model's reference; what else is stated of a point is by the learnt one, on the same grid.
    fn by_blocks(
        &self,
        whole: Option<&WholeModelOfLevels>,
        flights: LevelFlights<'_>,
    ) -> (Figures, Refused) {
        let question = if self.states_deviations() {
            LevelQuestion::MeansAndVariances
        } else {
            LevelQuestion::Means
        };
        let current = self.current.base();
        let model = if whole.is_some() { self.model.reference().base() } else { current };
        let mut figures = Figures::with_capacity(self.asked, self.is_whole(), flights.count());
        let mut unknown = Vec::new();
        model.level_blocks(flights, |from, block| {
            let answers = whole.map(|whole| whole.answers(block, question));
            self.extend(&mut figures, block, answers.as_ref());
            let is_known = answers.as_ref().map_or(&block.is_known, |answers| &answers.is_known);
            for (place, is_known) in is_known[..block.count].iter().enumerate() {
                if !is_known {
                    unknown.push(from + place);
                }
            }
        });
        let mut refused = Vec::new();
        for place in unknown {
            self.one_by_one(flights, place..place + 1, &mut figures, &mut refused);
        }
        (figures, refused)
    }

    /// Adds the figures of a block; those of unknown points have no meaning yet.
    fn extend(&self, figures: &mut Figures, block: &LevelBlock, answers: Option<&LevelAnswers>) {
        use PredictedColumn as Column;
        let (current, count) = (self.current.base(), block.count);
        let is_by_table = answers.is_none()
            || figures.has(Column::DragCoefficient)
            || figures.has(Column::RemainderPercent);
        let none = [f64::NAN; LevelBlock::POINTS];
        let (mut drag_coefficient, mut by_table_kg_s) = (none, none);
        if is_by_table {
            drag_coefficient = current.drag_table().interpolate_all(&block.cells);
            for (place, kg_s) in by_table_kg_s.iter_mut().enumerate() {
                *kg_s = drag_coefficient[place] * block.fuel_flow_per_drag_coefficient_kg_s[place];
            }
        }
        let totals_kg_s = answers.map_or(&by_table_kg_s, |answers| &answers.fuel_flow_total_kg_s);
        figures.extend(Column::FuelFlow, &totals_kg_s[..count]);
        figures.extend_with(Column::FuelFlowDeviation, count, |place| {
            let variance = answers.map_or(f64::NAN, |answers| answers.variance[place]);
            self.with_scatter(variance.sqrt() * totals_kg_s[place], totals_kg_s[place])
        });
        figures.extend_with(Column::SpecificRange, count, |place| {
            let airspeed = TrueAirspeed::meters_per_second(block.true_airspeed_m_s[place]);
            let total = FuelFlowTotal::kilograms_per_second(totals_kg_s[place]);
            specific_range(airspeed, total).to_meters_per_kilogram()
        });
        figures.extend(Column::LiftCoefficient, &block.lift_coefficient[..count]);
        figures.extend(Column::DragCoefficient, &drag_coefficient[..count]);
        if figures.has(Column::Extrapolated) {
            let extrapolated = current.use_extrapolated(&block.cells);
            figures.extend_with(Column::Extrapolated, count, |place| flag(extrapolated[place]));
        }
        figures.extend_with(Column::RemainderPercent, count, |place| {
            100.0 * (totals_kg_s[place] / by_table_kg_s[place] - 1.0)
        });
        figures.extend_with(Column::BeyondFlights, count, |place| {
            flag(answers.is_some_and(|answers| answers.beyond_flights[place]))
        });
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
                Ok(found) => figures.set_prediction(place, &found),
                Err(reason) => {
                    figures.set_none(place);
                    refused.push((place, reason));
                }
            }
        }
    }
}

impl PredictedPoints {
    /// Those of points among rows of which others are no points: `places` are the rows of the points, `without` the others, with
    /// the reason.
    #[must_use]
    pub fn among_rows(self, places: &[usize], without: Vec<(usize, String)>) -> Self {
        if without.is_empty() {
            return self;
        }
        let rows = places.len() + without.len();
        let columns = self.columns.into_iter().map(|(name, values)| {
            let mut column = vec![f64::NAN; rows];
            for (place, value) in places.iter().zip(values) {
                column[*place] = value;
            }
            (name, column)
        });
        let mut refused: Refused =
            self.refused.into_iter().map(|(point, reason)| (places[point], reason)).collect();
        refused.extend(without);
        refused.sort_by_key(|(place, _)| *place);
        Self { columns: columns.collect(), refused }
    }

    /// Appends the columns to others.
    pub fn append_to(self, columns: &mut Columns) {
        for (name, values) in self.columns {
            columns.dense(name, values);
        }
    }
}

/// Why a row is no point: it lacks a value which it needs, or has one that costs it ([`CsvError::costs_its_row`]).
#[must_use]
pub fn reason_of_row(error: &CsvError) -> String {
    let column = error.column.as_ref().map_or("a column", |column| column.name.as_str());
    if error.is_missing_value() {
        format!("{column}: no value")
    } else {
        format!("{column}: {}", error.reason)
    }
}

/// Measured fuel flow of all engines at each point, kg/s, NaN where none.
pub fn measured_kg_s(points: &[FlightPoint]) -> Vec<f64> {
    let measured = points.iter().map(|point| point.measured_fuel_flow_total);
    measured.map(|flow| flow.map_or(f64::NAN, FuelFlowTotal::to_kilograms_per_second)).collect()
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
