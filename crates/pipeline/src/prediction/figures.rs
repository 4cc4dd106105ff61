//! The columns of predictions at many points, and which of them are asked for.

use perf_model::fuel_flow::fuel_flow_error_percent;
use perf_model::{LevelBlock, PREDICTED_COLUMNS};
use units::FuelFlowTotal;

use super::PointPrediction;
use super::points::{PredictedPoints, Refused};

/// A column of predictions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PredictedColumn {
    /// Fuel flow of all engines.
    FuelFlow,
    /// Its standard deviation.
    FuelFlowDeviation,
    /// Specific range.
    SpecificRange,
    /// Lift coefficient.
    LiftCoefficient,
    /// Drag coefficient of the table.
    DragCoefficient,
    /// Whether a node that the guide does not support has a part.
    Extrapolated,
    /// 100 (measured − predicted)/measured fuel flow.
    ErrorPercent,
    /// What more than the table makes of the fuel flow.
    RemainderPercent,
    /// Whether the point lies beyond what was flown.
    BeyondFlights,
}

impl PredictedColumn {
    /// All, in the order in which they are given.
    pub const ALL: [Self; PREDICTED_COLUMNS.len()] = [
        Self::FuelFlow,
        Self::FuelFlowDeviation,
        Self::SpecificRange,
        Self::LiftCoefficient,
        Self::DragCoefficient,
        Self::Extrapolated,
        Self::ErrorPercent,
        Self::RemainderPercent,
        Self::BeyondFlights,
    ];

    /// Its name, with its unit.
    #[must_use]
    pub const fn name(self) -> &'static str {
        PREDICTED_COLUMNS[self as usize]
    }

    /// The column of a name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|column| column.name() == name)
    }

    /// Whether only more than the table has it.
    const fn is_beside_table(self) -> bool {
        matches!(self, Self::RemainderPercent | Self::BeyondFlights)
    }
}

/// Columns that are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Asked([bool; PredictedColumn::ALL.len()]);

impl Asked {
    pub(super) const EVERYTHING: Self = Self([true; PredictedColumn::ALL.len()]);

    pub(super) fn only(columns: &[PredictedColumn]) -> Self {
        let mut asked = Self([false; PredictedColumn::ALL.len()]);
        for column in columns {
            asked.0[*column as usize] = true;
        }
        asked
    }

    #[inline]
    pub(super) const fn has(self, column: PredictedColumn) -> bool {
        self.0[column as usize]
    }

    /// The same without what more than the table has.
    fn of_table(mut self) -> Self {
        for column in PredictedColumn::ALL {
            self.0[column as usize] &= !column.is_beside_table();
        }
        self
    }

    /// The same with the fuel flow where an error is asked for, which needs it.
    fn with_needed(mut self) -> Self {
        self.0[PredictedColumn::FuelFlow as usize] |= self.has(PredictedColumn::ErrorPercent);
        self
    }
}

/// Values of columns as they are filled; of those that nobody asked for none.
#[derive(Debug)]
pub(super) struct Figures {
    asked: Asked,
    computed: Asked,
    columns: [Vec<f64>; PredictedColumn::ALL.len()],
}

impl Figures {
    /// Room for the figures of so many points.
    pub(super) fn with_capacity(asked: Asked, is_whole: bool, count: usize) -> Self {
        let asked = if is_whole { asked } else { asked.of_table() };
        let mut computed = asked.with_needed();
        // Follows from the flows when all are known.
        computed.0[PredictedColumn::ErrorPercent as usize] = false;
        let mut columns = [const { Vec::new() }; PredictedColumn::ALL.len()];
        for column in PredictedColumn::ALL {
            if computed.has(column) {
                columns[column as usize] = Vec::with_capacity(count);
            }
        }
        Self { asked, computed, columns }
    }

    /// The same for so many points, of which nothing is known yet.
    pub(super) fn unknown(asked: Asked, is_whole: bool, count: usize) -> Self {
        let mut figures = Self::with_capacity(asked, is_whole, count);
        for column in PredictedColumn::ALL {
            if figures.has(column) {
                figures.columns[column as usize].resize(count, f64::NAN);
            }
        }
        figures
    }

    /// Whether a column is to be filled.
    #[inline]
    pub(super) const fn has(&self, column: PredictedColumn) -> bool {
        self.computed.has(column)
    }

    /// Adds values to a column that is to be filled.
    pub(super) fn extend(&mut self, column: PredictedColumn, values: &[f64]) {
        if self.has(column) {
            self.columns[column as usize].extend_from_slice(values);
        }
    }

    /// Adds values at a block's first places to a column that is to be filled.
    pub(super) fn extend_with(
        &mut self,
        column: PredictedColumn,
        count: usize,
        value: impl Fn(usize) -> f64,
    ) {
        if self.has(column) {
            let mut values = [f64::NAN; LevelBlock::POINTS];
            for (place, slot) in values.iter_mut().enumerate() {
                *slot = value(place);
            }
            self.columns[column as usize].extend_from_slice(&values[..count]);
        }
    }

    /// Sets a value of a column that is to be filled.
    #[inline]
    pub(super) fn set(&mut self, column: PredictedColumn, place: usize, value: f64) {
        if let Some(slot) = self.columns[column as usize].get_mut(place) {
            *slot = value;
        }
    }

    /// Nothing is known of a point.
    pub(super) fn set_none(&mut self, place: usize) {
        for column in PredictedColumn::ALL {
            self.set(column, place, f64::NAN);
        }
    }

    /// The figures of some points, at their places.
    pub(super) fn set_all(&mut self, places: &[usize], found: &Self) {
        for (into, from) in self.columns.iter_mut().zip(&found.columns) {
            for (place, value) in places.iter().zip(from) {
                into[*place] = *value;
            }
        }
    }

    /// The figures of a prediction on its own.
    pub(super) fn set_prediction(&mut self, place: usize, found: &PointPrediction) {
        use PredictedColumn as Column;
        let prediction = &found.prediction;
        let total_kg_s = prediction.fuel_flow_total.to_kilograms_per_second();
        self.set(Column::FuelFlow, place, total_kg_s);
        let deviation_kg_s = found.fuel_flow_std_kg_s.unwrap_or(f64::NAN);
        self.set(Column::FuelFlowDeviation, place, deviation_kg_s);
        let range_m_kg = prediction.specific_range.to_meters_per_kilogram();
        self.set(Column::SpecificRange, place, range_m_kg);
        self.set(Column::LiftCoefficient, place, prediction.lift_coefficient);
        self.set(Column::DragCoefficient, place, prediction.drag_coefficient);
        self.set(Column::Extrapolated, place, flag(prediction.extrapolated));
        if let Some(beside) = found.beside_table {
            self.set(Column::RemainderPercent, place, 100.0 * beside.ln_fuel_flow.exp_m1());
            self.set(Column::BeyondFlights, place, flag(beside.beyond_flights));
        }
    }

    pub(super) fn into_predicted(
        mut self,
        measured_kg_s: Option<&[f64]>,
        refused: Refused,
    ) -> PredictedPoints {
        let flows = PredictedColumn::FuelFlow as usize;
        let measured_kg_s = measured_kg_s.filter(|_| self.asked.has(PredictedColumn::ErrorPercent));
        let error_percent = measured_kg_s.map(|measured| {
            let flows = measured.iter().zip(&self.columns[flows]);
            flows.map(|(measured, predicted)| error_percent(*measured, *predicted)).collect()
        });
        let is_error = error_percent.is_some();
        self.columns[PredictedColumn::ErrorPercent as usize] = error_percent.unwrap_or_default();
        let mut columns = Vec::new();
        for (column, values) in PredictedColumn::ALL.into_iter().zip(self.columns) {
            if self.asked.has(column) && (is_error || column != PredictedColumn::ErrorPercent) {
                columns.push((column.name(), values));
            }
        }
        PredictedPoints { columns, refused }
    }
}

/// 1 or 0.
pub(super) const fn flag(is_set: bool) -> f64 {
    if is_set { 1.0 } else { 0.0 }
}

fn error_percent(measured_kg_s: f64, predicted_kg_s: f64) -> f64 {
    let total = FuelFlowTotal::kilograms_per_second;
    fuel_flow_error_percent(total(measured_kg_s), total(predicted_kg_s))
}
