//! A virtual fleet on the level of segments: design, truth, sensors. It shares no physics with the library.
//!
//! The truth's forms are not the library's: Prandtl–Schlichting friction for a power law, saturating ageing for a rate,
//! two half-parabolas for one, bent trim drag, a hidden anti-ice switch, ageostrophic wind, exact sensor errors.
//!
//! The model that belongs to it, without any effect, is [`exact_model`].

mod aircraft;
mod design;
mod sensors;
mod truth;

use flight::Segment;
use flight::effect::{EffectId, HiddenParameter, TypicalSize};

pub use crate::Random;
pub use aircraft::{exact_model, isa};

use design::design;
use sensors::record_flight;
use truth::Truth;

/// Mass that effects stated as a share of mass refer to, kg.
const MASS_KG: f64 = 13_300.0;

/// A planted effect.
#[derive(Clone, Copy, Debug)]
pub struct Planted {
    /// Which effect.
    pub id: EffectId,
    /// Its size, in the unit of the effect ([`EffectId::entry`]).
    pub size: f64,
}

/// What else differs from the model, without being planted.
#[derive(Clone, Debug, Default)]
pub struct Background {
    /// Standard deviation of every other effect, in multiples of its typical size.
    pub clutter: f64,
    /// Amplitude of smooth errors of drag and of fuel flow over Mach number, lift and altitude, relative.
    pub field: f64,
}

/// Size of the fleet and quality of its recordings.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Number of flights.
    pub flights: usize,
    /// Number of segments of each flight.
    pub segments: usize,
    /// Share of segments whose fuel flow is an outlier, 0 to 1.
    pub outliers: f64,
    /// Factor on all sensor noise; 0: exact recordings.
    pub noise: f64,
}

impl Default for Setup {
    fn default() -> Self {
        Self { flights: 60, segments: 10, outliers: 0.0, noise: 1.0 }
    }
}

/// The segments that a fleet of one aircraft recorded.
#[derive(Clone, Debug)]
pub struct Fleet {
    /// Segments of each flight, in order of flying.
    pub flights: Vec<Vec<Segment>>,
}

/// Typical size of an effect for this aircraft, in the unit of the effect; 1 where the size is known.
#[must_use]
pub fn typical(id: EffectId) -> f64 {
    match id.entry().typical {
        TypicalSize::Absolute(size) => size,
        TypicalSize::ShareOfMass(share) => share * MASS_KG,
        TypicalSize::Known => 1.0,
    }
}

/// An effect at a multiple of its typical size, sign drawn where physics leaves it open.
pub fn plant(id: EffectId, times: f64, random: &mut Random) -> Planted {
    let size = typical(id) * if id.is_known() { 1.0 } else { times };
    let sign = if id.is_one_sided() || id.is_known() || random.uniform(0.0, 1.0) < 0.5 {
        1.0
    } else {
        -1.0
    };
    Planted { id, size: sign * size }
}

/// Flies a fleet with effects. The same seed gives the same design whatever is planted.
#[must_use]
pub fn fly(seed: u64, setup: &Setup, effects: &[Planted], background: &Background) -> Fleet {
    let rows = design(&mut Random::new(seed, 1), setup);
    let mut random = Random::new(seed, 2);
    let mut all = effects.to_vec();
    if background.clutter > 0.0 {
        all.extend(clutter(effects, background.clutter, &mut random));
    }
    let truth = Truth::new(&rows, all, background.field, &mut random);
    let mut random = Random::new(seed, 3);
    let flights = (0..setup.flights)
        .map(|flight| {
            let rows: Vec<_> = rows.iter().filter(|row| row.flight == flight).collect();
            record_flight(&truth, setup, flight, &rows, &mut random)
        })
        .collect();
    Fleet { flights }
}

/// Every effect that is not planted, at sizes drawn around zero.
fn clutter(planted: &[Planted], deviation: f64, random: &mut Random) -> Vec<Planted> {
    let mut all = Vec::new();
    for id in EffectId::library(2) {
        let dated =
            matches!(id.entry().hidden, HiddenParameter::Step { .. } | HiddenParameter::History(_));
        if dated || planted.iter().any(|effect| effect.id == id) {
            continue;
        }
        let size = random.normal(0.0, deviation) * typical(id);
        all.push(Planted { id, size: if id.is_one_sided() { size.abs() } else { size } });
    }
    all
}
