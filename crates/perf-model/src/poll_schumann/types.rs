//! The types that the model has parameters for.

use std::sync::LazyLock;

use serde::Deserialize;

const TYPES: &str = include_str!("../../data/poll_schumann_types.csv");
const SYNONYMS: &str = include_str!("../../data/poll_schumann_synonyms.csv");

/// Parameters of a type, named as in the papers where they have no other name.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// ICAO type designator.
    pub type_code: String,
    /// Manufacturer.
    pub manufacturer: String,
    /// Variant that the parameters are of.
    pub variant: String,
    /// Number of engines.
    pub engines: u8,
    /// Whether the wing has winglets.
    #[serde(rename = "winglets", deserialize_with = "yes_or_no")]
    pub has_winglets: bool,
    /// Maximum take-off mass, kg.
    pub maximum_take_off_mass_kg: f64,
    /// Operating empty mass, kg.
    pub operating_empty_mass_kg: f64,
    /// Wing area, m².
    pub wing_area_m2: f64,
    /// δ2: interference of wing and fuselage in induced drag.
    pub delta_2: f64,
    /// Cosine of the sweep of the quarter-chord line.
    pub cos_sweep: f64,
    /// Aspect ratio.
    pub aspect_ratio: f64,
    /// ψ0: zero-lift drag over skin friction.
    pub psi_0: f64,
    /// Where the steep part of the wave drag begins.
    pub x_ref: f64,
    /// Technology and geometry of the wing in wave drag.
    pub wing_constant: f64,
    /// Where the gradual part of the wave drag begins.
    pub j_2: f64,
    /// Size of the gradual part.
    pub j_1: f64,
    /// Mach number of the design point.
    pub design_mach: f64,
    /// Thrust coefficient of the design point.
    pub design_thrust_coefficient: f64,
    /// Factor of the highest efficiency.
    pub eta_1: f64,
    /// Exponent of the Mach number in the highest efficiency.
    pub eta_2: f64,
    /// Highest flight level, hundreds of feet.
    pub maximum_flight_level: f64,
    /// Maximum operating Mach number.
    pub maximum_mach: f64,
}

static PARSED: LazyLock<Vec<Parameters>> = LazyLock::new(|| {
    // The file is part of the program: a test reads every row of it.
    csv::Reader::from_reader(TYPES.as_bytes()).deserialize().filter_map(Result::ok).collect()
});

/// All types, in the order of the table.
#[must_use]
pub fn types() -> &'static [Parameters] {
    &PARSED
}

impl Parameters {
    /// Whether the parameters are of this designator itself, and not of a type that represents it.
    #[must_use]
    pub fn is_of(&self, type_code: &str) -> bool {
        self.type_code.eq_ignore_ascii_case(type_code)
    }

    /// The other designators that the type may stand for: those that it represents and that have its number of engines.
    pub fn stands_for(&self) -> impl Iterator<Item = &'static str> {
        represented()
            .filter(|one| self.is_of(one.by) && one.engines == self.engines)
            .map(|one| one.type_code)
    }
}

/// A designator without parameters of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Represented {
    /// The designator.
    pub type_code: &'static str,
    /// The type whose parameters stand for it.
    pub by: &'static str,
    /// Its own number of engines, which that type's need not be.
    pub engines: u8,
}

/// Designators without parameters of their own, each with the type that represents it.
pub fn represented() -> impl Iterator<Item = Represented> {
    SYNONYMS.lines().skip(1).filter_map(|line| {
        let (type_code, rest) = line.split_once(',')?;
        let (by, engines) = rest.split_once(',')?;
        Some(Represented { type_code, by, engines: engines.parse().ok()? })
    })
}

/// The parameters of a type designator, of its own or of the type that represents it; upper and lower case are the same.
#[must_use]
pub fn find(type_code: &str) -> Option<&'static Parameters> {
    let own = |code: &str| types().iter().find(|parameters| parameters.is_of(code));
    own(type_code).or_else(|| {
        represented()
            .find(|one| one.type_code.eq_ignore_ascii_case(type_code))
            .and_then(|one| own(one.by))
    })
}

fn yes_or_no<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<bool, D::Error> {
    match String::deserialize(deserializer)?.as_str() {
        "yes" => Ok(true),
        "no" => Ok(false),
        other => Err(serde::de::Error::custom(format!("found {other:?}, expected yes or no"))),
    }
}
