//! Measurements, and flights on purpose, that would tell effects apart.

use flight::effect::EffectId;

/// A measurement, or flights on purpose, that separate two effects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// The effect that would be told from the first.
    pub from: EffectId,
    /// What to measure or to fly.
    pub measurement: Measurement,
    /// Distance between them now, in standard deviations.
    pub distance_now: f64,
    /// And with the measurement or the flights.
    pub distance_then: f64,
    /// Of flights on purpose: with as many ordinary flights instead.
    pub distance_ordinary_flights: Option<f64>,
}

/// What to measure, or to fly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measurement {
    /// Weigh the aircraft, to 0.3 % of its mass.
    Weighing,
    /// Compare the flow meters with the fuel uplifted, or with tank gauges held against it, to 0.15 %.
    TankGauges,
    /// Compare static air temperature with a reanalysis, to 0.5 K.
    TemperatureReanalysis,
    /// Compare true airspeed with GPS and wind, to Mach 0.0015.
    AirspeedByGps,
    /// Compare pressure altitude with GPS height and a reanalysis, to 0.05 % of static pressure.
    AltitudeByGps,
    /// Measure an N2 deck, to 0.1 %.
    N2Deck,
    /// Flights on purpose.
    Flights(FlightsOnPurpose),
}

/// Six flights on purpose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FlightsOnPurpose {
    /// All with the same sweep.
    OneSort(Sweep),
    /// Three with each of two sweeps.
    TwoSorts([Sweep; 2]),
}

/// What a flight on purpose varies. Mach numbers are hundredths and levels flight levels: what is said is what is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sweep {
    /// Mach number at constant pressure altitude.
    Mach {
        /// Slowest and fastest, hundredths.
        hundredths: [u32; 2],
        /// Where the sweep goes below it: the slowest Mach number that was flown, hundredths.
        below_slowest_flown: Option<u32>,
        /// Flight level.
        level: u32,
        /// How heavy.
        loading: SweepLoading,
    },
    /// Pressure altitude at constant Mach number.
    Level {
        /// Lowest and highest flight level.
        levels: [u32; 2],
        /// Mach number, hundredths.
        mach_hundredths: u32,
        /// How heavy.
        loading: SweepLoading,
    },
}

/// How heavy the aircraft is at the beginning of a flight on purpose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepLoading {
    /// Against what was flown.
    pub kind: LoadingKind,
    /// Gross mass, kg.
    pub mass_kg: f64,
}

/// A loading against what was flown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum LoadingKind {
    /// Among the heaviest.
    Heavy,
    /// In the middle.
    Usual,
    /// Among the lightest.
    Light,
}
