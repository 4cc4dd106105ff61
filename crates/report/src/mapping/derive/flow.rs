//! Fuel burnt since a recording's first row, by fuel flow.

use flight::MAXIMUM_ENGINES;
use flight::column::Column;

use super::Part;
use super::rows::Limits;
use crate::mapping::plan::Conversion;
use crate::mapping::table::interpolate;

/// What was burnt until each row of a recording.
pub(super) struct Burnt {
    pub(super) by_row_kg: Vec<f64>,
    /// Rows of which a fuel flow is not believed.
    pub(super) bridged: usize,
}

impl Part<'_> {
    /// The integral of fuel flow from the recording's first row to each of its rows, climb included: trapezoids of each engine's flow.
    ///
    /// A flow that is out of range is bridged as a blank is, by a straight line between the flows around it. A flow of zero is out of
    /// range too, except where no fuel can flow: until the engine's first flow, behind its last one, and on the ground, where it is
    /// shut down between two flights or legs. Ground speed below its range (50 kt) is on the ground; one that is wrong itself is not.
    pub(super) fn burnt(&self) -> Burnt {
        let time_s = &self.recording.time_s;
        let on_ground = self.on_ground();
        let mut flow_kg_s = vec![0.0; time_s.len()];
        let mut is_bridged = vec![false; time_s.len()];
        for (column, conversion) in &self.plan.recorded {
            let maximum = match column {
                Column::FuelFlowEngine(_) => None,
                Column::FuelFlowTotal => self.largest_total_flow_kg_s(),
                _ => continue,
            };
            let limits = Limits::new(*column, maximum);
            let mut engine_kg_s = self.of_all_rows(conversion);
            let flows = |value: &f64| limits.admit(*value);
            let first = engine_kg_s.iter().position(flows).unwrap_or(time_s.len());
            let last = engine_kg_s.iter().rposition(flows).unwrap_or(0);
            for (row, value) in engine_kg_s.iter_mut().enumerate() {
                let may_be_zero = row < first || row > last || on_ground[row];
                let is_believed = flows(value) || (*value == 0.0 && may_be_zero);
                if !is_believed {
                    *value = f64::NAN;
                    is_bridged[row] = true;
                }
            }
            interpolate(time_s, &mut engine_kg_s, f64::INFINITY);
            for (sum, value) in flow_kg_s.iter_mut().zip(engine_kg_s) {
                // Before its first flow and behind its last one there is nothing to bridge from.
                *sum += if value.is_nan() { 0.0 } else { value };
            }
        }
        let mut burnt_kg = 0.0;
        let steps = time_s.windows(2).zip(flow_kg_s.windows(2)).map(|(time, flow)| {
            burnt_kg += 0.5 * (flow[0] + flow[1]) * (time[1] - time[0]);
            burnt_kg
        });
        let by_row_kg = core::iter::once(0.0).chain(steps).collect();
        Burnt { by_row_kg, bridged: is_bridged.iter().filter(|bridged| **bridged).count() }
    }

    /// The largest flow of all engines; where nothing determines their number, of four.
    pub(super) fn largest_total_flow_kg_s(&self) -> Option<f64> {
        let is_of_engine = |(column, _): &&(Column, _)| matches!(column, Column::N2(_));
        let engines = match self.plan.recorded.iter().filter(is_of_engine).count() {
            0 => MAXIMUM_ENGINES,
            engines => engines,
        };
        Column::FuelFlowTotal.range().maximum.map(|one| one * engines as f64)
    }

    /// Of each row of the recording whether its ground speed is that of an aircraft on the ground.
    fn on_ground(&self) -> Vec<bool> {
        let Some(speed) = self.plan.recorded_as(Column::GroundSpeed) else {
            return vec![false; self.recording.time_s.len()];
        };
        let slowest = Column::GroundSpeed.range().minimum.unwrap_or(0.0);
        self.of_all_rows(speed).iter().map(|speed| (0.0..slowest).contains(speed)).collect()
    }

    fn of_all_rows(&self, conversion: &Conversion) -> Vec<f64> {
        let rows = self.recording.time_s.len();
        let mut values = Vec::with_capacity(rows);
        conversion.append_to(&mut values, &self.recording.numbers, 0..rows, |_| true);
        values
    }
}
