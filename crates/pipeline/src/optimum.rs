//! What a flight management system would fly with a model: the Mach numbers of maximum range, of long range and of a
//! cost index, and the best level; with intervals, and compared with what the book (the initial table) makes it fly.
//!
//! Level flight without acceleration. A Mach number is chosen among thousandths, a level among those that were asked
//! for, and both only where the guide or learnt flights inform the model: no thrust limit, no buffet limit and no
//! ceiling is known here, so an optimum at the edge of what is informed is reported as such.
//!
//! Drag between the nodes is read from the smooth surface through them ([`lut::SmoothCell`]): of a bilinear surface the
//! optimum is almost always on a grid line, whatever the aircraft.

mod condition;
mod document;
mod fuel;
mod speeds;
mod text;

pub use condition::{BestLevel, ConditionOptimum, LevelOptimum, SpeedOptimum, at};
pub use document::{OptimumDocument, SCHEMA, columns};
pub use fuel::{Informed, OptimumModel};
pub use speeds::{Edge, Kind};
pub use text::table;

use units::{Mass, PressureAltitude, TemperatureDifference, TrueAirspeed};

use crate::model_file::ModelFile;

/// Share of the maximum specific range that is given up for speed in long-range cruise.
///
/// # Source
/// Airbus, *Getting to grips with aircraft performance*, 2002: the long-range cruise Mach number is the higher of the two
/// at which specific range is 99 % of its maximum.
pub const LONG_RANGE_SHARE: f64 = 0.99;

/// Models drawn from what is known, for the intervals. Our choice: with 200 the ends of a 95 % interval are known to a
/// fifth of its half width.
pub const DRAWS: usize = 200;

/// Cost of time over cost of fuel: how much fuel a minute of flight is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct CostIndex(f64);

impl CostIndex {
    /// In kilograms of fuel per minute, the unit of Airbus aircraft. Boeing's is 100 lb/h: one of these is 0.756 kg/min.
    #[must_use]
    pub const fn kilograms_per_minute(value: f64) -> Self {
        Self(value)
    }

    /// In kilograms of fuel per minute.
    #[must_use]
    pub const fn to_kilograms_per_minute(self) -> f64 {
        self.0
    }

    /// As the fuel flow that time is worth, kg/s.
    fn kg_s(self) -> f64 {
        self.0 / 60.0
    }
}

/// What is asked for each mass and ISA deviation.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Levels to choose from, ascending.
    pub levels: Vec<PressureAltitude>,
    /// Tailwinds, negative for headwinds.
    pub tailwinds: Vec<TrueAirspeed>,
    /// Cost index, where one is asked for.
    pub cost_index: Option<CostIndex>,
}

/// Levels from 25,000 to 43,000 ft, every 1,000 ft: a model knows no ceiling.
#[must_use]
pub fn usual_levels() -> Vec<PressureAltitude> {
    (25..=43_u32).map(|thousands| PressureAltitude::feet(1000.0 * f64::from(thousands))).collect()
}

/// Five masses, 15 % about the mean mass of the flights that a model has learnt; without any, about the mass that the
/// middle of the guide's lift coefficients and Mach numbers carries at 37,000 ft. Rounded to 100 kg.
///
/// `None` where a model's guide has no such middle, which no model file has.
#[must_use]
pub fn usual_masses(model: &ModelFile) -> Option<Vec<Mass>> {
    let flown = model.learnt.as_ref().and_then(|learnt| learnt.references.mean("mass_kg"));
    let middle_kg = match flown {
        Some(mean) => mean,
        None => mass_of_guide_kg(model)?,
    };
    let around = [0.85, 0.925, 1.0, 1.075, 1.15];
    Some(around.map(|share| Mass::kilograms((share * middle_kg / 100.0).round() * 100.0)).to_vec())
}

fn mass_of_guide_kg(model: &ModelFile) -> Option<f64> {
    let guide = &model.guide;
    let middle = |(low, high): (f64, f64)| f64::midpoint(low, high);
    let level = PressureAltitude::feet(37_000.0);
    let sat = atmos::isa::temperature(level).ok()?;
    let speed = atmos::airspeed::mach_to_true_airspeed(units::Mach::new(middle(guide.mach)), sat);
    let density = atmos::isa::density(atmos::isa::pressure(level).ok()?, sat);
    let pressure = atmos::airspeed::dynamic_pressure(density, speed).to_pascals();
    let area = model.initial.aircraft().wing_area().to_square_meters();
    let weight_n = pressure * area * middle(guide.lift_coefficient);
    Some(weight_n / units::convert::STANDARD_GRAVITY_M_S2)
}

/// A mass and an ISA deviation, each in one type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassAndDay {
    /// Gross mass.
    pub mass: Mass,
    /// Deviation from the ISA.
    pub isa_deviation: TemperatureDifference,
}

#[cfg(test)]
mod tests;
