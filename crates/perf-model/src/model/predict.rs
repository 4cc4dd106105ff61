//! Fuel flow by the model: for a recorded segment, and for a flight point.

use atmos::{airspeed, isa};
use flight::Segment;
use lut::{Cell, Outside, Table};
use units::{
    Acceleration, Force, FuelFlowTotal, OutOfDomain, Pressure, PressureAltitude, SpecificRange,
    TrueAirspeed, Tsfc, check_within,
};

use super::{OutsideTable, PerformanceModel, same_grid};
use crate::FlightPoint;
use crate::fuel_flow::{self, CruiseConditions};
use crate::levels::GuidePlace;
use crate::specific_range::specific_range;
use crate::tsfc::tsfc;
use crate::{forces, state::SegmentState};

/// Why there is no prediction.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PredictError {
    /// An input outside its domain.
    #[error(transparent)]
    OutOfDomain(#[from] OutOfDomain),
    /// The point's lift coefficient and Mach number lie outside the table.
    #[error(transparent)]
    OutsideTable(#[from] OutsideTable),
    /// A table on another grid than the model's.
    #[error("the drag table is not on the grid of the aircraft file")]
    GridDiffers,
}

/// The prediction of a table for a recorded segment.
#[derive(Clone, Copy, Debug)]
pub struct SegmentPrediction {
    /// The segment's state.
    pub state: SegmentState,
    /// Drag coefficient of the table, times its factor by level.
    pub drag_coefficient: f64,
    /// Predicted fuel flow of all engines.
    pub fuel_flow_total: FuelFlowTotal,
    /// Error of the prediction, % of the recorded fuel flow; positive: the aircraft burns more.
    pub error_percent: f64,
    /// Whether a node that no row of the guide supports has a part in it.
    pub extrapolated: bool,
    /// Cell of the table.
    pub cell: Cell,
}

/// The prediction for a flight point: level, unaccelerated flight.
#[derive(Clone, Copy, Debug)]
pub struct Prediction {
    /// Predicted fuel flow of all engines.
    pub fuel_flow_total: FuelFlowTotal,
    /// Specific range.
    pub specific_range: SpecificRange,
    /// True airspeed of the Mach number at the day's temperature.
    pub true_airspeed: TrueAirspeed,
    /// Static pressure.
    pub static_pressure: Pressure,
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Drag coefficient of the table, times its factor by level.
    pub drag_coefficient: f64,
    /// Net thrust of all engines, equal to drag.
    pub net_thrust: Force,
    /// TSFC: fuel flow divided by net thrust.
    pub tsfc: Tsfc,
    /// Change of predicted total fuel flow with drag coefficient, kg/s: what turns the table's standard deviation into
    /// that of fuel flow.
    pub fuel_flow_per_drag_coefficient_kg_s: f64,
    /// Whether a node that no row of the guide supports has a part in it.
    pub extrapolated: bool,
    /// Error of the prediction, % of the measured fuel flow, if that is given; positive: the aircraft burns more.
    pub error_percent: Option<f64>,
    /// Cell of the table.
    pub cell: Cell,
}

impl PerformanceModel {
    /// Predicted fuel flow and error of a segment by a drag table, for example an adapted one or
    /// [`drag_table`](Self::drag_table). The segment's acceleration is part of the prediction.
    ///
    /// # Errors
    /// [`PredictError`] where a mean is outside its domain, the point is outside the table, or the table is on another
    /// grid than the model's.
    ///
    /// # Source
    /// Book `[forces.12]`, `[forces.13]`; Ghazi et al. 2020, equations (23), (24).
    pub fn predict_segment(
        &self,
        segment: &Segment,
        drag_table: &Table,
    ) -> Result<SegmentPrediction, PredictError> {
        if !same_grid(self.aircraft().grid(), drag_table.grid()) {
            return Err(PredictError::GridDiffers);
        }
        let recorded =
            units::FuelFlowTotal::kilograms_per_second(segment.means.fuel_flow_total_kg_s);
        let state = self.state_of(segment)?;
        let cell = drag_table
            .grid()
            .locate(state.lift_coefficient, segment.means.mach, Outside::Error)
            .map_err(OutsideTable::from)?;
        let place = GuidePlace {
            lift_coefficient: state.lift_coefficient,
            mach: segment.means.mach,
            pressure_altitude: PressureAltitude::meters(segment.means.pressure_altitude_m),
        };
        let drag_coefficient = drag_table.interpolate(&cell) * self.level_factor(place);
        let fuel_flow_total = fuel_flow::predicted_fuel_flow(&state.conditions, drag_coefficient);
        Ok(SegmentPrediction {
            state,
            drag_coefficient,
            fuel_flow_total,
            error_percent: fuel_flow::fuel_flow_error_percent(recorded, fuel_flow_total),
            extrapolated: self.uses_extrapolated(&cell),
            cell,
        })
    }

    /// Predicted fuel flow and specific range at a flight point: level flight without acceleration.
    ///
    /// # Errors
    /// [`PredictError`] where a number is outside its domain or the point is outside the table. Nothing is
    /// extrapolated; a node outside the *guide's* range is used and reported in
    /// [`extrapolated`](Prediction::extrapolated).
    ///
    /// # Source
    /// Book `[forces.12]`, `[forces.15]`; Ghazi et al. 2020, equations (12), (13).
    pub fn predict(&self, point: &FlightPoint) -> Result<Prediction, PredictError> {
        check_within("gross mass", "kg", point.mass.to_kilograms(), f64::MIN_POSITIVE, f64::MAX)?;
        check_within("Mach number", "Mach", point.mach.value(), f64::MIN_POSITIVE, f64::MAX)?;
        let static_pressure = isa::pressure(point.pressure_altitude)?;
        let sat = point.static_air_temperature()?;
        check_within("static air temperature", "K", sat.to_kelvin(), f64::MIN_POSITIVE, f64::MAX)?;

        let true_airspeed = airspeed::mach_to_true_airspeed(point.mach, sat);
        let conditions = CruiseConditions {
            dynamic_pressure: airspeed::dynamic_pressure(
                isa::density(static_pressure, sat),
                true_airspeed,
            ),
            wing_area: self.aircraft().wing_area(),
            tsfc: tsfc(self.aircraft().tsfc_law(), isa::temperature_ratio(sat), point.mach),
            mass: point.mass,
            acceleration: Acceleration::meters_per_second_squared(0.0),
        };
        let lift_coefficient =
            forces::lift_coefficient(point.mass, conditions.dynamic_pressure, conditions.wing_area);
        let cell = self.locate(lift_coefficient, point.mach.value())?;
        let place = GuidePlace {
            lift_coefficient,
            mach: point.mach.value(),
            pressure_altitude: point.pressure_altitude,
        };
        let drag_coefficient = self.drag_table().interpolate(&cell) * self.level_factor(place);
        let fuel_flow_total = fuel_flow::predicted_fuel_flow(&conditions, drag_coefficient);
        Ok(Prediction {
            fuel_flow_total,
            specific_range: specific_range(true_airspeed, fuel_flow_total),
            true_airspeed,
            static_pressure,
            lift_coefficient,
            drag_coefficient,
            net_thrust: forces::drag(
                drag_coefficient,
                conditions.dynamic_pressure,
                conditions.wing_area,
            ),
            tsfc: conditions.tsfc,
            fuel_flow_per_drag_coefficient_kg_s: fuel_flow::fuel_flow_per_drag_coefficient_kg_s(
                &conditions,
            ),
            extrapolated: self.uses_extrapolated(&cell),
            error_percent: point
                .measured_fuel_flow_total
                .map(|measured| fuel_flow::fuel_flow_error_percent(measured, fuel_flow_total)),
            cell,
        })
    }
}

impl Prediction {
    /// The same prediction with another fuel flow; specific range and error follow it.
    #[must_use]
    pub fn with_fuel_flow(self, fuel_flow_total: FuelFlowTotal, point: &FlightPoint) -> Self {
        Self {
            fuel_flow_total,
            specific_range: specific_range(self.true_airspeed, fuel_flow_total),
            error_percent: point
                .measured_fuel_flow_total
                .map(|measured| fuel_flow::fuel_flow_error_percent(measured, fuel_flow_total)),
            ..self
        }
    }
}
