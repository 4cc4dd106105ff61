//! What a flight management system would fly with a model: the Mach numbers of maximum range, of long range and of a
//! cost index, and the best level; with intervals, and compared with what the book (the initial table) makes it fly.
//!
//! Level flight without acceleration. A Mach number is chosen among thousandths, a level among those that were asked
//! for, and both only where the guide or learnt flights inform the model: no thrust limit, no buffet limit and no
//! ceiling is known here, so an optimum at the edge of what is informed is reported as such.
//!
//! Drag between the nodes is read from the smooth surface through them ([`lut::SmoothCell`]): of a bilinear surface the
//! optimum is almost always on a grid line, whatever the aircraft.

mod choices;
mod condition;
mod document;
mod fuel;
mod speeds;
mod text;

pub use condition::{
    BestLevel, ConditionOptimum, LevelOptimum, NoSaving, SpeedOptimum, at,
    largest_against_predict_percent,
};
pub use document::{OptimumDocument, SCHEMA, columns};
pub use fuel::{Informed, OptimumModel};
pub use speeds::{Edge, Kind, OpenEnds};
pub use text::{table, without_optimum};

use perf_model::GuidePlace;
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

/// Highest of the usual levels where nothing is known of an aircraft's, ft. Our choice.
const HIGHEST_USUAL_FT: f64 = 43_000.0;
/// Usual levels below the highest, every 1,000 ft. Our choice.
const LEVELS_BELOW: u32 = 18;

/// The highest pressure altitude of a model's guide, or that its flights flew; `None` where the model's file keeps neither.
#[must_use]
pub fn highest_known_level(model: &ModelFile) -> Option<PressureAltitude> {
    let guide_m = model.guide.pressure_altitude_m.map(|(_, high)| high);
    let flown_m = model
        .learnt
        .as_ref()
        .and_then(|learnt| learnt.baseline.as_ref()?.flown(effects::Variable::PressureAltitude))
        .map(|(_, high)| high);
    let highest_m = [guide_m, flown_m].into_iter().flatten().reduce(f64::max)?;
    Some(PressureAltitude::meters(highest_m))
}

/// The smallest and the largest mass of a model's guide and of what its flights flew, kg; `None` where the model's file keeps neither.
#[must_use]
pub fn known_masses_kg(model: &ModelFile) -> Option<(f64, f64)> {
    let learnt = model.learnt.as_ref();
    let flown = learnt.and_then(|learnt| learnt.baseline.as_ref()?.flown(effects::Variable::Mass));
    let both = [model.guide.mass_kg, flown].into_iter().flatten();
    both.reduce(|one, other| (one.0.min(other.0), one.1.max(other.1)))
}

/// Nineteen levels, every 1,000 ft, up to the highest of guide and flights: no model knows a ceiling. Up to 43,000 ft where its
/// file keeps neither.
#[must_use]
pub fn usual_levels(model: &ModelFile) -> Vec<PressureAltitude> {
    let highest_ft = highest_known_level(model).map_or(HIGHEST_USUAL_FT, PressureAltitude::to_feet);
    // A level in feet has gained digits in metres.
    let highest_thousand = ((highest_ft + 0.5) / 1000.0).floor();
    (0..=LEVELS_BELOW)
        .rev()
        .map(|below| PressureAltitude::feet(1000.0 * (highest_thousand - f64::from(below))))
        .filter(|level| level.to_feet() > 0.0)
        .collect()
}

/// Shares of the guide's range of masses, from its lightest to its heaviest.
const SHARES_OF_GUIDE: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.9];

/// Five masses. Of a model that has learnt flights, within 15 % about their mean mass. Without any, about the middle of the guide's
/// masses and within them; where the model's file does not keep these, about the mass that the middle of the guide's lift
/// coefficients and Mach numbers carries at 37,000 ft. Rounded to 100 kg.
///
/// `None` where a model's guide has no such middle, which no model file has.
#[must_use]
pub fn usual_masses(model: &ModelFile) -> Option<Vec<Mass>> {
    let rounded = |kg: f64| Mass::kilograms((kg / 100.0).round() * 100.0);
    let flown = model.learnt.as_ref().and_then(|learnt| learnt.references.mean("mass_kg"));
    let middle_kg = match (flown, model.guide.mass_kg) {
        (Some(mean), _) => mean,
        (None, Some((low, high))) => {
            let masses = SHARES_OF_GUIDE.map(|share| rounded(low + share * (high - low)));
            return Some(masses.to_vec());
        }
        (None, None) => mass_of_guide_kg(model)?,
    };
    let around = [0.85, 0.925, 1.0, 1.075, 1.15];
    Some(around.map(|share| rounded(share * middle_kg)).to_vec())
}

fn mass_of_guide_kg(model: &ModelFile) -> Option<f64> {
    let guide = &model.guide;
    let middle = |(low, high): (f64, f64)| f64::midpoint(low, high);
    let place = GuidePlace {
        lift_coefficient: middle(guide.lift_coefficient),
        mach: middle(guide.mach),
        pressure_altitude: PressureAltitude::feet(37_000.0),
    };
    mass_at_kg(model, place)
}

/// The mass that has a lift coefficient at a level on a standard day; `None` beyond the atmosphere.
pub(crate) fn mass_at_kg(model: &ModelFile, place: GuidePlace) -> Option<f64> {
    let level = place.pressure_altitude;
    let sat = atmos::isa::temperature(level).ok()?;
    let speed = atmos::airspeed::mach_to_true_airspeed(units::Mach::new(place.mach), sat);
    let density = atmos::isa::density(atmos::isa::pressure(level).ok()?, sat);
    let pressure = atmos::airspeed::dynamic_pressure(density, speed).to_pascals();
    let area = model.initial.aircraft().wing_area().to_square_meters();
    let weight_n = pressure * area * place.lift_coefficient;
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
