//! Who flew, when, and with what on board.

use jiff::Timestamp;
use units::Mass;

/// Identifies one flight of one tail: the key of every ledger.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FlightIdentity {
    /// Tail (registration) as sent.
    pub tail: String,
    /// The instant of TIME 0. Before the flight's name, so that identities sort in the order of flying.
    pub start: Timestamp,
    /// Flight number or name as sent (free text).
    pub flight: String,
}

impl FlightIdentity {
    /// The instant of TIME 0, s since 1970 (whole seconds).
    #[must_use]
    pub fn start_s(&self) -> f64 {
        seconds_since_1970(self.start)
    }
}

/// Whole seconds since 1970 of an instant.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "seconds since 1970 are below 2^53")]
pub fn seconds_since_1970(instant: Timestamp) -> f64 {
    instant.as_second() as f64
}

/// Required columns that a recording may declare missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MissingColumn {
    /// Static air temperature.
    StaticAirTemperature,
    /// High-pressure rotor speed of all engines.
    N2,
    /// Roll angle.
    Roll,
    /// Drift angle.
    Drift,
}

impl MissingColumn {
    /// All of them, in the order of the format's page.
    pub const ALL: [Self; 4] = [Self::StaticAirTemperature, Self::N2, Self::Roll, Self::Drift];

    /// The name in the `MISSING` header.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::StaticAirTemperature => "SAT",
            Self::N2 => "N2",
            Self::Roll => "ROLL",
            Self::Drift => "DRIFT",
        }
    }
}

/// An assumption in place of something that was not recorded.
#[derive(Clone, Debug, PartialEq)]
pub enum Assumption {
    /// `SAT=ISA+3`: static air temperature is that of the ISA plus a deviation.
    StaticAirTemperatureIsa {
        /// Deviation from the ISA, K.
        isa_deviation_k: f64,
    },
    /// Any other assumption, as sent.
    Other {
        /// Left of the equals sign.
        key: String,
        /// Right of it.
        value: String,
    },
}

/// The header of a cruise report.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportHeader {
    /// Type code of the aircraft ("C750").
    pub aircraft_type: String,
    /// Tail, start and flight.
    pub identity: FlightIdentity,
    /// Zero-fuel mass (`ZFW`).
    pub zero_fuel_mass: Mass,
    /// Fuel on board at main engine start (`FOB`).
    pub fuel_on_board: Mass,
    /// Lower heating value of this fuel, MJ/kg, where known (`LHV`).
    pub lower_heating_value_mj_kg: Option<f64>,
    /// Required columns that the recording does not have, in order, each once.
    pub missing: Vec<MissingColumn>,
    /// The assumptions in their place.
    pub assumed: Vec<Assumption>,
    /// Other header lines, key and value, in order.
    pub notes: Vec<(String, String)>,
}
