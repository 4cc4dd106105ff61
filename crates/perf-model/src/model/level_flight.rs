//! Fuel flow at many flight points of level flight: columns in, a column out.
//!
//! A difficult file. Powers and exponentials cost more than all the rest of a prediction, so that each of them is replaced by a
//! polynomial, fitted once a call to the very function that a single prediction calls. Its error is that of rounding. What
//! is left are products, quotients and roots over columns, several points in one instruction; only the search in the
//! table is done point by point.

use atmos::constants::{
    HIGHEST_PRESSURE_ALTITUDE_M, LOWEST_PRESSURE_ALTITUDE_M, TROPOPAUSE_PRESSURE_ALTITUDE_M,
};
use atmos::{airspeed, isa};
use lut::Outside;
use units::{Mach, Mass, Pressure, PressureAltitude, Temperature};

use super::PerformanceModel;
use crate::forces;
use crate::tsfc::tsfc;

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

/// Points whose states are computed together: few enough to stay in registers and the nearest cache.
const BLOCK: usize = 64;

/// What is known of the points of a block before the table is asked.
struct Block {
    static_air_temperature_k: [f64; BLOCK],
    lift_coefficient: [f64; BLOCK],
    /// Fuel flow of a drag coefficient of 1, kg/s.
    fuel_flow_per_drag_coefficient_kg_s: [f64; BLOCK],
}

impl PerformanceModel {
    /// Predicted fuel flow of all engines, kg/s, at each point that all columns have; NaN where
    /// [`predict`](Self::predict) finds none. Within 1e-12 of what `predict` finds.
    #[must_use]
    pub fn fuel_flows_kg_s(&self, points: LevelFlights<'_>) -> Vec<f64> {
        let functions = Functions::of(self);
        let columns =
            [points.mass_kg, points.pressure_altitude_m, points.mach, points.isa_deviation_k];
        let count = columns.iter().map(|column| column.len()).min().unwrap_or(0);
        let mut flows = vec![f64::NAN; count];
        let mut block = Block {
            static_air_temperature_k: [0.0; BLOCK],
            lift_coefficient: [0.0; BLOCK],
            fuel_flow_per_drag_coefficient_kg_s: [0.0; BLOCK],
        };
        for (index, flows) in flows.chunks_mut(BLOCK).enumerate() {
            let from = index * BLOCK;
            let columns = columns.map(|column| &column[from..from + flows.len()]);
            self.fill(&mut block, &functions, columns);
            self.ask_table(&block, columns, flows);
        }
        flows
    }

    /// Every quantity of a block that the table does not decide. Points outside a domain get numbers without meaning.
    fn fill(&self, block: &mut Block, functions: &Functions, columns: [&[f64]; 4]) {
        let [masses_kg, altitudes_m, machs, deviations_k] = columns;
        let area = self.aircraft().wing_area();
        let points = masses_kg.iter().zip(altitudes_m).zip(machs).zip(deviations_k);
        for (place, (((mass_kg, altitude_m), mach), deviation_k)) in points.enumerate() {
            let is_low = *altitude_m <= TROPOPAUSE_PRESSURE_ALTITUDE_M;
            let (low_pa, high_pa) = (
                functions.low_pressure_pa.at(*altitude_m),
                functions.high_pressure_pa.at(*altitude_m),
            );
            let pressure = Pressure::pascals(if is_low { low_pa } else { high_pa });
            let standard_k =
                functions.low_temperature_k.at(altitude_m.min(TROPOPAUSE_PRESSURE_ALTITUDE_M));
            let sat = Temperature::kelvin(standard_k + deviation_k);
            let airspeed = airspeed::mach_to_true_airspeed(Mach::new(*mach), sat);
            let dynamic_pressure =
                airspeed::dynamic_pressure(isa::density(pressure, sat), airspeed);
            let tsfc = functions.tsfc_at_sea_level.at(*mach) * isa::temperature_ratio(sat).sqrt();
            block.static_air_temperature_k[place] = sat.to_kelvin();
            block.lift_coefficient[place] =
                forces::lift_coefficient(Mass::kilograms(*mass_kg), dynamic_pressure, area);
            block.fuel_flow_per_drag_coefficient_kg_s[place] =
                dynamic_pressure.to_pascals() * area.to_square_meters() * tsfc;
        }
    }

    /// Drag coefficients from the table, and with them fuel flows; what is outside a domain or the table stays NaN.
    fn ask_table(&self, block: &Block, columns: [&[f64]; 4], flows: &mut [f64]) {
        let [masses_kg, altitudes_m, machs, _] = columns;
        let table = self.drag_table();
        for (place, flow) in flows.iter_mut().enumerate() {
            let is_inside = masses_kg[place] >= f64::MIN_POSITIVE
                && masses_kg[place] <= f64::MAX
                && altitudes_m[place] >= LOWEST_PRESSURE_ALTITUDE_M
                && altitudes_m[place] <= HIGHEST_PRESSURE_ALTITUDE_M
                && machs[place] >= f64::MIN_POSITIVE
                && block.static_air_temperature_k[place] >= f64::MIN_POSITIVE;
            if !is_inside {
                continue;
            }
            let (lift_coefficient, mach) = (block.lift_coefficient[place], machs[place]);
            if let Ok(cell) = table.grid().locate(lift_coefficient, mach, Outside::Error) {
                *flow = table.interpolate(&cell) * block.fuel_flow_per_drag_coefficient_kg_s[place];
            }
        }
    }
}

/// The functions of one variable that a prediction needs, as polynomials.
struct Functions {
    low_pressure_pa: Polynomial<16>,
    high_pressure_pa: Polynomial<16>,
    low_temperature_k: Polynomial<2>,
    /// TSFC of the static temperature of the standard day at sea level over Mach number, kg/(N·s).
    tsfc_at_sea_level: Polynomial<16>,
}

impl Functions {
    fn of(model: &PerformanceModel) -> Self {
        let (lowest, highest) = (LOWEST_PRESSURE_ALTITUDE_M, HIGHEST_PRESSURE_ALTITUDE_M);
        let tropopause = TROPOPAUSE_PRESSURE_ALTITUDE_M;
        let pressure = |altitude_m: f64| {
            isa::pressure(PressureAltitude::meters(altitude_m))
                .map_or(f64::NAN, Pressure::to_pascals)
        };
        let temperature = |altitude_m: f64| {
            isa::temperature(PressureAltitude::meters(altitude_m))
                .map_or(f64::NAN, Temperature::to_kelvin)
        };
        let machs = model.aircraft().grid().y();
        let law = model.aircraft().tsfc_law();
        Self {
            low_pressure_pa: Polynomial::of((lowest, tropopause), pressure),
            high_pressure_pa: Polynomial::of((tropopause, highest), pressure),
            low_temperature_k: Polynomial::of((lowest, tropopause), temperature),
            tsfc_at_sea_level: Polynomial::of((machs.first(), machs.last()), |mach| {
                tsfc(law, 1.0, Mach::new(mach)).to_kilograms_per_newton_second()
            }),
        }
    }
}

/// A smooth function between two ends as the polynomial that meets it at Chebyshev's points.
///
/// # Source
/// Press et al., *Numerical Recipes*, third edition, sections 5.8 (coefficients) and 5.10 (as powers).
struct Polynomial<const N: usize> {
    middle: f64,
    per_half_width: f64,
    /// Of the powers of the variable scaled to −1 to 1, from the lowest.
    coefficients: [f64; N],
}

impl<const N: usize> Polynomial<N> {
    fn of((first, last): (f64, f64), function: impl Fn(f64) -> f64) -> Self {
        let (middle, half_width) = (f64::midpoint(first, last), 0.5 * (last - first));
        let angle = |k: usize| core::f64::consts::PI * (k as f64 + 0.5) / N as f64;
        let values: [f64; N] =
            core::array::from_fn(|k| function(middle + half_width * angle(k).cos()));
        // Chebyshev's polynomials as powers, one after the other: T(j+1) = 2 x T(j) − T(j−1).
        let (mut before, mut current) = ([0.0; N], [0.0; N]);
        current[0] = 1.0;
        let mut coefficients = [0.0; N];
        for j in 0..N {
            let sum: f64 = values
                .iter()
                .enumerate()
                .map(|(k, value)| value * (j as f64 * angle(k)).cos())
                .sum();
            let weight = sum * if j == 0 { 1.0 } else { 2.0 } / N as f64;
            for (coefficient, power) in coefficients.iter_mut().zip(&current) {
                *coefficient += weight * power;
            }
            let double = if j == 0 { 1.0 } else { 2.0 };
            let next: [f64; N] = core::array::from_fn(|power| {
                let raised = if power == 0 { 0.0 } else { double * current[power - 1] };
                raised - before[power]
            });
            before = current;
            current = next;
        }
        Self { middle, per_half_width: 1.0 / half_width, coefficients }
    }

    #[inline]
    fn at(&self, x: f64) -> f64 {
        let scaled = (x - self.middle) * self.per_half_width;
        self.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * scaled + coefficient)
    }
}

#[cfg(test)]
mod tests {
    use units::TemperatureDifference;

    use super::*;
    use crate::FlightPoint;

    #[test]
    fn the_column_holds_what_single_predictions_find() {
        let model = super::super::tests::citation_x();
        let (mut mass_kg, mut altitude_m, mut machs, mut deviations_k) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for step in 0..4000_u32 {
            let share = |of: u32| f64::from(step % of) / f64::from(of);
            mass_kg.push(8_000.0 + 12_000.0 * share(37));
            altitude_m.push(3_000.0 + 18_000.0 * share(61));
            machs.push(0.4 + 0.6 * share(23));
            deviations_k.push(-20.0 + 40.0 * share(7));
        }
        for (place, odd) in [f64::NAN, 0.0, -1.0, f64::INFINITY].into_iter().enumerate() {
            mass_kg[4 * place] = odd;
            altitude_m[4 * place + 1] = 1e5 * odd;
            machs[4 * place + 2] = odd;
            deviations_k[4 * place + 3] = -300.0 * odd.abs();
        }
        let flows = model.fuel_flows_kg_s(LevelFlights {
            mass_kg: &mass_kg,
            pressure_altitude_m: &altitude_m,
            mach: &machs,
            isa_deviation_k: &deviations_k,
        });
        let mut found = 0;
        for (index, flow) in flows.iter().enumerate() {
            let point = FlightPoint {
                isa_deviation: TemperatureDifference::kelvin(deviations_k[index]),
                ..FlightPoint::new(
                    Mass::kilograms(mass_kg[index]),
                    PressureAltitude::meters(altitude_m[index]),
                    Mach::new(machs[index]),
                )
            };
            match model.predict(&point) {
                Ok(single) => {
                    let single = single.fuel_flow_total.to_kilograms_per_second();
                    assert!((flow / single - 1.0).abs() < 1e-12, "{point:?}: {flow} for {single}");
                    found += 1;
                }
                Err(_) => assert!(flow.is_nan(), "{point:?}: {flow}"),
            }
        }
        assert!((400..3600).contains(&found), "{found} of {} are inside the table", flows.len());
    }

    #[test]
    fn a_polynomial_meets_the_exponential() {
        // Oracle: the standard library, at points that the fit did not use.
        let polynomial: Polynomial<16> = Polynomial::of((-1.5, 0.5), f64::exp);
        for step in 0..=100 {
            let x = -1.5 + 0.02 * f64::from(step);
            assert!((polynomial.at(x) / x.exp() - 1.0).abs() < 1e-14, "{x}");
        }
    }
}
