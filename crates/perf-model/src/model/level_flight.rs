//! Predictions at many flight points of level flight: columns in, one short record per point out.
//!
//! A difficult file. Powers and exponentials cost more than all the rest of a prediction, so that each of them is replaced by a
//! polynomial, fitted once a call to the very function that a single prediction calls. Its error is that of rounding. What
//! is left are products, quotients and roots over columns, several points in one instruction; only the search in the
//! table is done point by point.

mod block;
mod functions;

use atmos::constants::TROPOPAUSE_PRESSURE_ALTITUDE_M;
use atmos::{airspeed, isa};
use flight::ObservationVariance;
use lut::{Cell, Outside};
use units::{
    Acceleration, Force, FuelFlowTotal, Mach, Mass, Pressure, PressureAltitude, SpecificRange,
    Temperature, TrueAirspeed,
};

use block::Lanes;
use functions::Functions;

use super::PerformanceModel;
use crate::forces;
use crate::levels::GuidePlace;
use crate::specific_range::specific_range;
use crate::variance::{self, RecordedPoint, TableSlopes};

pub use block::LevelBlock;

/// Flight points as columns of one length.
#[derive(Clone, Copy, Debug)]
pub struct LevelFlights<'a> {
    /// Gross mass.
    pub mass_kg: &'a [f64],
    /// Pressure altitude.
    pub pressure_altitude_m: &'a [f64],
    /// Mach number.
    pub mach: &'a [f64],
    /// Deviation from the ISA.
    pub isa_deviation_k: &'a [f64],
}

/// What is predicted at one of many flight points; the numbers of [`Prediction`](super::Prediction).
#[derive(Clone, Copy, Debug)]
pub struct LevelPrediction {
    /// Fuel flow of all engines.
    pub fuel_flow_total: FuelFlowTotal,
    /// True airspeed.
    pub true_airspeed: TrueAirspeed,
    /// Net thrust of all engines, equal to drag.
    pub net_thrust: Force,
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Drag coefficient of the table, times its factor by level.
    pub drag_coefficient: f64,
    /// Change of predicted total fuel flow with drag coefficient, kg/s.
    pub fuel_flow_per_drag_coefficient_kg_s: f64,
    /// Pressure altitude.
    pub pressure_altitude: PressureAltitude,
    /// Static pressure.
    pub pressure: Pressure,
    /// Static air temperature.
    pub static_air_temperature: Temperature,
    /// Temperature of the ISA at the pressure altitude.
    pub standard_temperature: Temperature,
    /// Gross mass.
    pub mass: Mass,
    /// Mach number.
    pub mach: Mach,
    /// Cell of the table.
    pub cell: Cell,
}

impl LevelPrediction {
    /// Specific range.
    #[must_use]
    #[inline]
    pub fn specific_range(&self) -> SpecificRange {
        specific_range(self.true_airspeed, self.fuel_flow_total)
    }
}

impl PerformanceModel {
    /// Predicted fuel flow of all engines, kg/s, at each point that all columns have; NaN where
    /// [`predict`](Self::predict) finds none. Within 1e-12 of what `predict` finds.
    #[must_use]
    pub fn fuel_flows_kg_s(&self, points: LevelFlights<'_>) -> Vec<f64> {
        let mut flows = Vec::with_capacity(points.count());
        self.level_blocks(points, |_, block| {
            let drag_coefficient = self.drag_table().interpolate_all(&block.cells);
            let mut of_block = [f64::NAN; LevelBlock::POINTS];
            for place in 0..LevelBlock::POINTS {
                let total_kg_s = drag_coefficient[place]
                    * block.fuel_flow_per_drag_coefficient_kg_s[place]
                    * self.factor_at(block, place);
                of_block[place] = if block.is_known[place] { total_kg_s } else { f64::NAN };
            }
            flows.extend_from_slice(&of_block[..block.count]);
        });
        flows
    }

    /// Hands the prediction at each point that all columns have to `each`, with its place from 0; none where
    /// [`predict`](Self::predict) finds none. Within 1e-12 of what `predict` finds, wherever a column is cut.
    #[inline]
    pub fn predict_level(
        &self,
        points: LevelFlights<'_>,
        mut each: impl FnMut(usize, &LevelPrediction),
    ) {
        self.each_block(points, Search::PointByPoint, |from, block| {
            for place in 0..block.count {
                if let Some(predicted) = self.ask_table(block, place) {
                    each(from + place, &predicted);
                }
            }
        });
    }

    /// Hands all that is known of points before drag is to `each`, a block at a time, with the place of its first point.
    /// Within 1e-12 of what [`predict`](Self::predict) finds, wherever a column is cut.
    #[inline]
    pub fn level_blocks(&self, points: LevelFlights<'_>, each: impl FnMut(usize, &LevelBlock)) {
        self.each_block(points, Search::Together, each);
    }

    #[inline]
    fn each_block(
        &self,
        points: LevelFlights<'_>,
        search: Search,
        mut each: impl FnMut(usize, &LevelBlock),
    ) {
        let functions = Functions::of(self);
        let vectors = pulp::Arch::new();
        let count = points.count();
        let mut block = LevelBlock::new();
        for from in (0..count).step_by(LevelBlock::POINTS) {
            block.take(&points, from, count);
            vectors.dispatch(Fill {
                model: self,
                functions: &functions,
                search,
                block: &mut block,
            });
            each(from, &block);
        }
    }

    #[inline]
    fn factor_at(&self, block: &LevelBlock, place: usize) -> f64 {
        self.level_factor(GuidePlace {
            lift_coefficient: block.lift_coefficient[place],
            mach: block.mach[place],
            pressure_altitude: PressureAltitude::meters(block.pressure_altitude_m[place]),
        })
    }

    /// Drag coefficient from the table, and with it the prediction; none outside a domain or the table.
    #[inline]
    fn ask_table(&self, block: &LevelBlock, place: usize) -> Option<LevelPrediction> {
        if !block.is_inside_domains(place) {
            return None;
        }
        let (mass_kg, mach) = (block.mass_kg[place], block.mach[place]);
        let altitude_m = block.pressure_altitude_m[place];
        let table = self.drag_table();
        let lift_coefficient = block.lift_coefficient[place];
        let cell = table.grid().locate(lift_coefficient, mach, Outside::Error).ok()?;
        let drag_coefficient = table.interpolate(&cell) * self.factor_at(block, place);
        let per_drag_coefficient_kg_s = block.fuel_flow_per_drag_coefficient_kg_s[place];
        Some(LevelPrediction {
            fuel_flow_total: FuelFlowTotal::kilograms_per_second(
                drag_coefficient * per_drag_coefficient_kg_s,
            ),
            true_airspeed: TrueAirspeed::meters_per_second(block.true_airspeed_m_s[place]),
            net_thrust: Force::newtons(drag_coefficient * block.dynamic_force_n[place]),
            lift_coefficient,
            drag_coefficient,
            fuel_flow_per_drag_coefficient_kg_s: per_drag_coefficient_kg_s,
            pressure_altitude: PressureAltitude::meters(altitude_m),
            pressure: Pressure::pascals(block.pressure_pa[place]),
            static_air_temperature: Temperature::kelvin(block.static_air_temperature_k[place]),
            standard_temperature: Temperature::kelvin(block.standard_temperature_k[place]),
            mass: Mass::kilograms(mass_kg),
            mach: Mach::new(mach),
            cell,
        })
    }

    /// Variance of what a segment of this many samples, recorded in level flight without acceleration at such a point and
    /// burning what is predicted, would show against *this model's* table: that of [`observe`](Self::observe). The
    /// prediction may be of another table on the same grid.
    #[must_use]
    #[inline]
    pub fn level_variance(
        &self,
        predicted: &LevelPrediction,
        samples: usize,
    ) -> ObservationVariance {
        let aircraft = self.aircraft();
        let slopes =
            TableSlopes::at(self.drag_table(), &predicted.cell, predicted.lift_coefficient);
        let point = RecordedPoint {
            mach: predicted.mach,
            static_air_temperature: predicted.static_air_temperature,
            standard_temperature: predicted.standard_temperature,
            mass: predicted.mass,
            acceleration: Acceleration::meters_per_second_squared(0.0),
            drag: predicted.net_thrust,
            net_thrust: predicted.net_thrust,
        };
        let fuel_flow = aircraft.sensors().fuel_flow_percent / 100.0;
        // All engines burn alike.
        let fuel_flow =
            variance::total_fuel_flow_relative_variance(fuel_flow, &[], aircraft.engines());
        variance::propagated(aircraft, &point, slopes, fuel_flow, samples)
    }
}

/// Every quantity of a block that the table does not decide. Points outside a domain get numbers without meaning.
///
/// Compiled for the widest vectors that a processor may have, which are chosen when it runs. Nothing is contracted or summed
/// in another order: the bits are the same on all of them.
struct Fill<'a> {
    model: &'a PerformanceModel,
    functions: &'a Functions,
    search: Search,
    block: &'a mut LevelBlock,
}

/// How the table's cells are found.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Search {
    /// With the predictions, each kept in registers.
    PointByPoint,
    /// With the block.
    Together,
}

impl pulp::NullaryFnOnce for Fill<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for the vectors of its caller, which a call of its own would not be"
    )]
    #[inline(always)]
    fn call(self) {
        let Self { model, functions, search, block } = self;
        let area = model.aircraft().wing_area();
        functions.write_pressures_pa(&block.pressure_altitude_m, &mut block.pressure_pa);
        for place in 0..LevelBlock::POINTS {
            let altitude_m = block.pressure_altitude_m[place];
            let mach = Mach::new(block.mach[place]);
            let pressure = Pressure::pascals(block.pressure_pa[place]);
            let standard_k =
                functions.low_temperature_k.at(altitude_m.min(TROPOPAUSE_PRESSURE_ALTITUDE_M));
            let sat = Temperature::kelvin(standard_k + block.isa_deviation_k[place]);
            let airspeed = airspeed::mach_to_true_airspeed(mach, sat);
            let dynamic_pressure =
                airspeed::dynamic_pressure(isa::density(pressure, sat), airspeed);
            let tsfc =
                functions.tsfc_at_sea_level.at(mach.value()) * isa::temperature_ratio(sat).sqrt();
            block.standard_temperature_k[place] = standard_k;
            block.static_air_temperature_k[place] = sat.to_kelvin();
            block.true_airspeed_m_s[place] = airspeed.to_meters_per_second();
            let mass = Mass::kilograms(block.mass_kg[place]);
            block.lift_coefficient[place] = forces::lift_coefficient(mass, dynamic_pressure, area);
            let dynamic_force_n = dynamic_pressure.to_pascals() * area.to_square_meters();
            block.dynamic_force_n[place] = dynamic_force_n;
            block.fuel_flow_per_drag_coefficient_kg_s[place] = dynamic_force_n * tsfc;
        }
        if search == Search::Together {
            let grid = model.drag_table().grid();
            block.cells.locate(grid, &block.lift_coefficient, &block.mach);
            for place in 0..LevelBlock::POINTS {
                block.is_known[place] =
                    block.cells.is_inside(place) & block.is_inside_domains(place);
            }
        }
    }
}

impl LevelFlights<'_> {
    /// Number of points that all columns have.
    #[must_use]
    pub fn count(&self) -> usize {
        let columns = [self.mass_kg, self.pressure_altitude_m, self.mach, self.isa_deviation_k];
        columns.iter().map(|column| column.len()).min().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests;
