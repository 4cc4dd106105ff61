//! The columns of a cruise report: name, units, range, defined once for parser, writer, messages and help.

use units::convert::{
    KELVIN_AT_ZERO_CELSIUS, KILOGRAMS_PER_POUND, KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR,
    KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR, METERS_PER_FOOT, METERS_PER_SECOND_PER_KNOT,
};

use crate::MAXIMUM_ENGINES;
use crate::header::MissingColumn;

/// Makes the enum, the list and everything that is known of a column from one list.
macro_rules! columns {
    ($($(#[$doc:meta])* $column:ident $(($engine:ty))? = $name:literal $entry:expr,)*) => {
        /// A column of the cruise report. Engine columns carry the engine's number from 1.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Column {
            $($(#[$doc])* $column $(($engine))?,)*
        }

        /// Columns without an engine's number, for their place in the list.
        enum Place {
            $($column,)*
        }

        impl Column {
            /// Every column in the order of the format's page; of the engine columns, that of engine 1.
            pub const ALL: [Self; [$($name),*].len()] =
                [$(Self::$column $((<$engine>::MIN + 1))?,)*];

            /// Index in [`ALL`](Self::ALL), whatever the engine.
            #[must_use]
            pub const fn index(self) -> usize {
                match self {
                    $(Self::$column $((columns!(@any $engine)))? => Place::$column as usize,)*
                }
            }

            /// The name in files, without an engine's number.
            pub(crate) const fn stem(self) -> &'static str {
                match self {
                    $(Self::$column $((columns!(@any $engine)))? => $name,)*
                }
            }

            const fn entry(self) -> Entry {
                match self {
                    $(Self::$column $((columns!(@any $engine)))? => $entry,)*
                }
            }

            /// The engine's number from 1.
            pub(crate) const fn engine(self) -> Option<u8> {
                match self {
                    $($(Self::$column(engine) => { let engine: $engine = engine; Some(engine) })?)*
                    _ => None,
                }
            }

            /// The same column of another engine; the column itself where it has no engine.
            const fn of_engine(self, engine: u8) -> Self {
                match self {
                    $(Self::$column $((columns!(@any $engine)))? => {
                        Self::$column $((columns!(@value engine $engine)))?
                    })*
                }
            }

            /// The column of this stem, with an engine's number or without.
            fn from_stem(stem: &str, engine: Option<u8>) -> Option<Self> {
                match (stem, engine) {
                    $(($name, columns!(@number engine $($engine)?)) => {
                        Some(Self::$column $((columns!(@value engine $engine)))?)
                    })*
                    _ => None,
                }
            }
        }

        const SPACED_NAMES: &str = concat!($(" ", $name, columns!(@k $($engine)?)),*);
    };
    (@any $engine:ty) => { _ };
    (@number $number:ident) => { None };
    (@number $number:ident $engine:ty) => { Some($number) };
    (@value $number:ident $engine:ty) => { $number };
    (@k) => { "" };
    (@k $engine:ty) => { "(k)" };
}

columns! {
    /// `TIME`: time since START.
    Time = "TIME" required("time since START", TIME, ANY_INCREASING),
    /// `ALT`: pressure altitude.
    PressureAltitude = "ALT" required("pressure altitude", LENGTH, ALTITUDE_RANGE),
    /// `SAT`: static air temperature.
    StaticAirTemperature = "SAT" required("static air temperature", TEMPERATURE, celsius(60.0, "-100 to +60 degC")),
    /// `MACH`: Mach number.
    Mach = "MACH" required("Mach number", RATIO, closed(0.1, 0.99, "0.1 to 0.99")),
    /// `VTAS`: true airspeed.
    TrueAirspeed = "VTAS" required("true airspeed", SPEED, SPEED_RANGE),
    /// `GSPD`: ground speed.
    GroundSpeed = "GSPD" required("ground speed", SPEED, SPEED_RANGE),
    /// `ROLL`: roll angle.
    Roll = "ROLL" required("roll angle", ANGLE, UP_TO_90_DEG),
    /// `DRIFT`: drift angle, track minus heading.
    Drift = "DRIFT" required("drift angle (track minus heading)", ANGLE, UP_TO_90_DEG),
    /// `N2(k)`: high-pressure rotor speed of engine k.
    N2(u8) = "N2" required("high-pressure rotor speed", PERCENT, ROTOR_SPEED_RANGE),
    /// `WF(k)`: fuel flow of engine k.
    FuelFlowEngine(u8) = "WF" required("fuel flow of one engine", FLOW, flow("above 0 to 100000 lb/h")),
    /// `WF`: fuel flow of all engines, where they are not recorded apart.
    FuelFlowTotal = "WF" required("fuel flow of all engines", FLOW, flow("above 0 to 100000 lb/h per engine")),
    /// `FU`: fuel used since engine start, all engines.
    FuelUsed = "FU" required("fuel used since engine start, all engines", MASS, from_zero("0 to FOB")),
    /// `LAT`: latitude.
    Latitude = "LAT" optional("latitude", ANGLE, UP_TO_90_DEG),
    /// `LON`: longitude.
    Longitude = "LON" direction("longitude", ANGLE, closed(-180.0, 360.0, "-180 to 360 deg")),
    /// `HDG`: true heading.
    TrueHeading = "HDG" direction("true heading", ANGLE, closed(-360.0, 360.0, "-360 to 360 deg")),
    /// `CG`: center of gravity.
    CenterOfGravity = "CG" optional("center of gravity", PERCENT_MAC, closed(-50.0, 150.0, "-50 to 150 %MAC")),
    /// `TAT`: total air temperature.
    TotalAirTemperature = "TAT" optional("total air temperature", TEMPERATURE, celsius(90.0, "-100 to +90 degC")),
    /// `N1(k)`: low-pressure rotor speed of engine k.
    N1(u8) = "N1" optional("low-pressure rotor speed", PERCENT, ROTOR_SPEED_RANGE),
    /// `EGT(k)`: exhaust gas temperature of engine k.
    ExhaustGasTemperature(u8) = "EGT" optional("exhaust gas temperature", TEMPERATURE, celsius(1500.0, "-100 to 1500 degC")),
    /// `FQ`: fuel quantity by the tank gauges, independent of the flow meters.
    FuelQuantity = "FQ" optional("fuel quantity by the tank gauges", MASS, from_zero("0 to 1.02 FOB")),
    /// `A/I`: anti-ice bleed, 0 or 1.
    AntiIce = "A/I" optional("anti-ice bleed", RATIO, closed(0.0, 1.0, "0 or 1")),
}

/// What is known of a column besides its name.
struct Entry {
    meaning: &'static str,
    units: &'static [ColumnUnit],
    is_optional: bool,
    is_direction: bool,
    range: ColumnRange,
}

const fn required(
    meaning: &'static str,
    units: &'static [ColumnUnit],
    range: ColumnRange,
) -> Entry {
    Entry { meaning, units, is_optional: false, is_direction: false, range }
}

const fn optional(
    meaning: &'static str,
    units: &'static [ColumnUnit],
    range: ColumnRange,
) -> Entry {
    Entry { meaning, units, is_optional: true, is_direction: false, range }
}

/// An optional column whose values are angles around the circle.
const fn direction(
    meaning: &'static str,
    units: &'static [ColumnUnit],
    range: ColumnRange,
) -> Entry {
    Entry { is_direction: true, ..optional(meaning, units, range) }
}

/// A unit a column may be written in: name, and SI (or canonical) value = `factor` × number + `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnUnit {
    /// As written in the file.
    pub name: &'static str,
    /// Factor to the column's stored unit.
    pub factor: f64,
    /// Offset in the column's stored unit.
    pub offset: f64,
}

/// Inclusive range of a column after conversion, in its stored unit, and in words for messages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnRange {
    /// Smallest admissible value; `None` where the format sets none.
    pub minimum: Option<f64>,
    /// Largest admissible value; `None` where it is unbounded or depends on the report (fuel used, fuel quantity).
    pub maximum: Option<f64>,
    /// Whether the minimum itself is excluded (fuel flow must be greater than zero).
    pub minimum_excluded: bool,
    /// The range as the format's page prints it.
    pub words: &'static str,
}

const fn unit(name: &'static str, factor: f64) -> ColumnUnit {
    ColumnUnit { name, factor, offset: 0.0 }
}

const TIME: &[ColumnUnit] = &[unit("s", 1.0), unit("min", 60.0)];
const LENGTH: &[ColumnUnit] = &[unit("ft", METERS_PER_FOOT), unit("m", 1.0)];
const TEMPERATURE: &[ColumnUnit] =
    &[ColumnUnit { name: "degC", factor: 1.0, offset: KELVIN_AT_ZERO_CELSIUS }, unit("K", 1.0)];
const RATIO: &[ColumnUnit] = &[unit("-", 1.0)];
const SPEED: &[ColumnUnit] = &[unit("kt", METERS_PER_SECOND_PER_KNOT), unit("m/s", 1.0)];
const ANGLE: &[ColumnUnit] = &[unit("deg", 1.0)];
const PERCENT: &[ColumnUnit] = &[unit("%", 1.0)];
const FLOW: &[ColumnUnit] = &[
    unit("lb/h", KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR),
    unit("kg/h", KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR),
    unit("kg/s", 1.0),
];
const MASS: &[ColumnUnit] = &[unit("lb", KILOGRAMS_PER_POUND), unit("kg", 1.0)];
const PERCENT_MAC: &[ColumnUnit] = &[unit("%MAC", 1.0)];

/// Largest fuel flow of one engine that the format allows: 100 000 lb/h.
const MAXIMUM_ENGINE_FUEL_FLOW_KG_S: f64 = 100_000.0 * KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR;

const fn closed(minimum: f64, maximum: f64, words: &'static str) -> ColumnRange {
    ColumnRange { minimum: Some(minimum), maximum: Some(maximum), minimum_excluded: false, words }
}

const fn from_zero(words: &'static str) -> ColumnRange {
    ColumnRange { minimum: Some(0.0), maximum: None, minimum_excluded: false, words }
}

/// From -100 °C on.
const fn celsius(maximum: f64, words: &'static str) -> ColumnRange {
    closed(KELVIN_AT_ZERO_CELSIUS - 100.0, KELVIN_AT_ZERO_CELSIUS + maximum, words)
}

const fn flow(words: &'static str) -> ColumnRange {
    ColumnRange {
        minimum: Some(0.0),
        maximum: Some(MAXIMUM_ENGINE_FUEL_FLOW_KG_S),
        minimum_excluded: true,
        words,
    }
}

const ANY_INCREASING: ColumnRange = ColumnRange {
    minimum: None,
    maximum: None,
    minimum_excluded: false,
    words: "any, strictly increasing",
};
const ALTITUDE_RANGE: ColumnRange =
    closed(-2_000.0 * METERS_PER_FOOT, 60_000.0 * METERS_PER_FOOT, "-2000 to 60000 ft");
const SPEED_RANGE: ColumnRange =
    closed(50.0 * METERS_PER_SECOND_PER_KNOT, 1000.0 * METERS_PER_SECOND_PER_KNOT, "50 to 1000 kt");
const UP_TO_90_DEG: ColumnRange = closed(-90.0, 90.0, "-90 to 90 deg");
const ROTOR_SPEED_RANGE: ColumnRange = closed(0.0, 130.0, "0 to 130 %");

/// Names of all columns as the format's page prints them, for messages.
pub const COLUMN_NAMES: &str = SPACED_NAMES.split_at(1).1;

impl Column {
    /// The column of this name; `None` for a name that the format does not define. Engines count from 1 to 4.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let Some((stem, engine)) = name.split_once('(') else {
            return Self::from_stem(name, None);
        };
        let engine = match engine {
            "1)" => 1,
            "2)" => 2,
            "3)" => 3,
            "4)" => 4,
            _ => return None,
        };
        Self::from_stem(stem, Some(engine))
    }

    /// Every column that a report of so many engines may lack, in the order of the format's page.
    pub fn optional_ones(engines: usize) -> impl Iterator<Item = Self> {
        let optional = Self::ALL.into_iter().filter(|column| column.is_optional());
        optional.flat_map(move |column| {
            let numbers = column.engine().map_or(1, |_| engines.min(MAXIMUM_ENGINES));
            (1_u8..).take(numbers).map(move |engine| column.of_engine(engine))
        })
    }

    /// The name in files.
    #[must_use]
    pub fn name(self) -> String {
        let stem = self.stem();
        match self.engine() {
            Some(engine) => format!("{stem}({engine})"),
            None => stem.to_owned(),
        }
    }

    /// The meaning of the column, in the field's words.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        self.entry().meaning
    }

    /// The units this column may be written in; the first is the one that reports usually carry.
    #[must_use]
    pub const fn units(self) -> &'static [ColumnUnit] {
        self.entry().units
    }

    /// The unit in which a [`Report`](crate::Report) stores the column: the one with factor 1 and no offset.
    #[must_use]
    pub fn canonical_unit(self) -> &'static str {
        self.units()
            .iter()
            .find(|unit| unit.factor.to_bits() == 1.0_f64.to_bits() && unit.offset.to_bits() == 0)
            .map_or("-", |unit| unit.name)
    }

    /// Whether `-` (not available for this sample) is allowed in it, and the column may be absent without `MISSING`.
    #[must_use]
    pub const fn is_optional(self) -> bool {
        self.entry().is_optional
    }

    /// What a header declares missing where the column is not recorded; `None` where it cannot be missing.
    #[must_use]
    pub const fn missing(self) -> Option<MissingColumn> {
        match self {
            Self::StaticAirTemperature => Some(MissingColumn::StaticAirTemperature),
            Self::N2(_) => Some(MissingColumn::N2),
            Self::Roll => Some(MissingColumn::Roll),
            Self::Drift => Some(MissingColumn::Drift),
            _ => None,
        }
    }

    /// Whether its values are angles around the circle, of which 359° and 1° have the mean 0°.
    #[must_use]
    pub const fn is_direction(self) -> bool {
        self.entry().is_direction
    }

    /// Inclusive range in the stored unit. The upper limits that depend on the report (total fuel flow by the number of
    /// engines, fuel used and fuel quantity by the fuel on board) are for the caller to check.
    #[must_use]
    pub const fn range(self) -> ColumnRange {
        self.entry().range
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_both_ways() {
        for column in Column::ALL {
            assert_eq!(Column::from_name(&column.name()), Some(column));
        }
        assert_eq!(Column::from_name("WF(4)"), Some(Column::FuelFlowEngine(4)));
        assert_eq!(Column::from_name("WF"), Some(Column::FuelFlowTotal));
        for wrong in
            ["alt", "N2", "N2(0)", "N2(5)", "N2(1", "WF()", "X-ALT", "", "N2(1)(2)", "ALT(1)"]
        {
            assert_eq!(Column::from_name(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn the_list_has_every_column_at_its_index() {
        for (index, column) in Column::ALL.into_iter().enumerate() {
            assert_eq!(column.index(), index, "{column:?}");
        }
        assert_eq!(Column::N2(4).index(), Column::N2(1).index());
        assert!(COLUMN_NAMES.starts_with("TIME ALT ") && COLUMN_NAMES.ends_with(" EGT(k) FQ A/I"));
    }

    #[test]
    fn every_column_has_a_canonical_unit() {
        for column in Column::ALL {
            assert!(
                column.units().iter().any(|unit| unit.name == column.canonical_unit()),
                "{column:?}"
            );
        }
        assert_eq!(Column::PressureAltitude.canonical_unit(), "m");
        assert_eq!(Column::StaticAirTemperature.canonical_unit(), "K");
    }
}
