//! Flight points side by side.

use atmos::constants::{HIGHEST_PRESSURE_ALTITUDE_M, LOWEST_PRESSURE_ALTITUDE_M};
use lut::Cells;

use super::LevelFlights;

/// A quantity at each point of a block.
pub(super) type Lanes = [f64; LevelBlock::POINTS];

/// Flight points side by side, one array for each quantity: what is known of them before drag is. Places beyond the last point
/// and points without a prediction hold numbers without meaning; [`is_known`](Self::is_known) tells.
#[derive(Clone, Debug)]
pub struct LevelBlock {
    /// Number of points.
    pub count: usize,
    /// Whether [`predict`](super::PerformanceModel::predict) finds a prediction.
    pub is_known: [bool; Self::POINTS],
    /// Gross mass.
    pub mass_kg: Lanes,
    /// Pressure altitude.
    pub pressure_altitude_m: Lanes,
    /// Mach number.
    pub mach: Lanes,
    /// Deviation from the ISA.
    pub isa_deviation_k: Lanes,
    /// Static pressure.
    pub pressure_pa: Lanes,
    /// Temperature of the ISA at the pressure altitude.
    pub standard_temperature_k: Lanes,
    /// Static air temperature.
    pub static_air_temperature_k: Lanes,
    /// True airspeed.
    pub true_airspeed_m_s: Lanes,
    /// Lift coefficient.
    pub lift_coefficient: Lanes,
    /// Drag of a drag coefficient of 1, N.
    pub dynamic_force_n: Lanes,
    /// Fuel flow of all engines of a drag coefficient of 1, kg/s.
    pub fuel_flow_per_drag_coefficient_kg_s: Lanes,
    /// Cells of the table.
    pub cells: Cells<{ Self::POINTS }>,
}

impl LevelBlock {
    /// Points that are computed together: so many that the code of a step, which is long, is fetched once for them all, and so few
    /// that what is known of them stays in a near cache.
    pub const POINTS: usize = 32;

    pub(super) fn new() -> Self {
        let none = [0.0; Self::POINTS];
        Self {
            count: 0,
            is_known: [false; Self::POINTS],
            mass_kg: none,
            pressure_altitude_m: none,
            mach: none,
            isa_deviation_k: none,
            pressure_pa: none,
            standard_temperature_k: none,
            static_air_temperature_k: none,
            true_airspeed_m_s: none,
            lift_coefficient: none,
            dynamic_force_n: none,
            fuel_flow_per_drag_coefficient_kg_s: none,
            cells: Cells::default(),
        }
    }

    /// Takes points from a place on, as many as there are and fit in; places beyond them repeat the first.
    pub(super) fn take(&mut self, points: &LevelFlights<'_>, from: usize, count: usize) {
        self.count = Self::POINTS.min(count - from);
        for (lanes, column) in [
            (&mut self.mass_kg, points.mass_kg),
            (&mut self.pressure_altitude_m, points.pressure_altitude_m),
            (&mut self.mach, points.mach),
            (&mut self.isa_deviation_k, points.isa_deviation_k),
        ] {
            let column = &column[from..from + self.count];
            lanes[..self.count].copy_from_slice(column);
            lanes[self.count..].fill(column[0]);
        }
    }

    #[expect(clippy::inline_always, reason = "compiled for the vectors of its caller")]
    #[expect(clippy::needless_bitwise_bool, reason = "no branch, so that compilers make vectors")]
    #[inline(always)]
    pub(super) fn is_inside_domains(&self, place: usize) -> bool {
        let (mass_kg, altitude_m) = (self.mass_kg[place], self.pressure_altitude_m[place]);
        (f64::MIN_POSITIVE..=f64::MAX).contains(&mass_kg)
            & (LOWEST_PRESSURE_ALTITUDE_M..=HIGHEST_PRESSURE_ALTITUDE_M).contains(&altitude_m)
            & (self.mach[place] >= f64::MIN_POSITIVE)
            & (self.static_air_temperature_k[place] >= f64::MIN_POSITIVE)
    }
}
