//! The columns of a cruise report: name, units, range, defined once for parser, writer, messages and help.

use units::convert::{
    KELVIN_AT_ZERO_CELSIUS, KILOGRAMS_PER_POUND, KILOGRAMS_PER_SECOND_PER_KILOGRAM_PER_HOUR,
    KILOGRAMS_PER_SECOND_PER_POUND_PER_HOUR, METERS_PER_FOOT, METERS_PER_SECOND_PER_KNOT,
};

/// Makes the enum, the list and the names from one list, so that they cannot differ in length.
macro_rules! columns {
    ($($(#[$doc:meta])* $column:ident $(($engine:ty))? = $name:literal,)*) => {
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
            const fn stem(self) -> &'static str {
                match self {
                    $(Self::$column $((columns!(@any $engine)))? => $name,)*
                }
            }

            /// The engine's number from 1.
            const fn engine(self) -> Option<u8> {
                match self {
                    $($(Self::$column(engine) => { let engine: $engine = engine; Some(engine) })?)*
                    _ => None,
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
    Time = "TIME",
    /// `ALT`: pressure altitude.
    PressureAltitude = "ALT",
    /// `SAT`: static air temperature.
    StaticAirTemperature = "SAT",
    /// `MACH`: Mach number.
    Mach = "MACH",
    /// `VTAS`: true airspeed.
    TrueAirspeed = "VTAS",
    /// `GSPD`: ground speed.
    GroundSpeed = "GSPD",
    /// `ROLL`: roll angle.
    Roll = "ROLL",
    /// `DRIFT`: drift angle, track minus heading.
    Drift = "DRIFT",
    /// `N2(k)`: high-pressure rotor speed of engine k.
    N2(u8) = "N2",
    /// `WF(k)`: fuel flow of engine k.
    FuelFlowEngine(u8) = "WF",
    /// `WF`: fuel flow of all engines, where they are not recorded apart.
    FuelFlowTotal = "WF",
    /// `FU`: fuel used since engine start, all engines.
    FuelUsed = "FU",
    /// `LAT`: latitude.
    Latitude = "LAT",
    /// `LON`: longitude.
    Longitude = "LON",
    /// `HDG`: true heading.
    TrueHeading = "HDG",
    /// `CG`: center of gravity.
    CenterOfGravity = "CG",
    /// `TAT`: total air temperature.
    TotalAirTemperature = "TAT",
    /// `N1(k)`: low-pressure rotor speed of engine k.
    N1(u8) = "N1",
    /// `EGT(k)`: exhaust gas temperature of engine k.
    ExhaustGasTemperature(u8) = "EGT",
    /// `FQ`: fuel quantity by the tank gauges, independent of the flow meters.
    FuelQuantity = "FQ",
    /// `A/I`: anti-ice bleed, 0 or 1.
    AntiIce = "A/I",
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
        match self {
            Self::Time => "time since START",
            Self::PressureAltitude => "pressure altitude",
            Self::StaticAirTemperature => "static air temperature",
            Self::Mach => "Mach number",
            Self::TrueAirspeed => "true airspeed",
            Self::GroundSpeed => "ground speed",
            Self::Roll => "roll angle",
            Self::Drift => "drift angle (track minus heading)",
            Self::N2(_) => "high-pressure rotor speed",
            Self::FuelFlowEngine(_) => "fuel flow of one engine",
            Self::FuelFlowTotal => "fuel flow of all engines",
            Self::FuelUsed => "fuel used since engine start, all engines",
            Self::Latitude => "latitude",
            Self::Longitude => "longitude",
            Self::TrueHeading => "true heading",
            Self::CenterOfGravity => "center of gravity",
            Self::TotalAirTemperature => "total air temperature",
            Self::N1(_) => "low-pressure rotor speed",
            Self::ExhaustGasTemperature(_) => "exhaust gas temperature",
            Self::FuelQuantity => "fuel quantity by the tank gauges",
            Self::AntiIce => "anti-ice bleed",
        }
    }

    /// The units this column may be written in; the first is the one that reports usually carry.
    #[must_use]
    pub const fn units(self) -> &'static [ColumnUnit] {
        match self {
            Self::Time => TIME,
            Self::PressureAltitude => LENGTH,
            Self::StaticAirTemperature
            | Self::TotalAirTemperature
            | Self::ExhaustGasTemperature(_) => TEMPERATURE,
            Self::Mach | Self::AntiIce => RATIO,
            Self::TrueAirspeed | Self::GroundSpeed => SPEED,
            Self::Roll | Self::Drift | Self::Latitude | Self::Longitude | Self::TrueHeading => {
                ANGLE
            }
            Self::N2(_) | Self::N1(_) => PERCENT,
            Self::FuelFlowEngine(_) | Self::FuelFlowTotal => FLOW,
            Self::FuelUsed | Self::FuelQuantity => MASS,
            Self::CenterOfGravity => PERCENT_MAC,
        }
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
        match self {
            Self::Latitude
            | Self::Longitude
            | Self::TrueHeading
            | Self::CenterOfGravity
            | Self::TotalAirTemperature
            | Self::N1(_)
            | Self::ExhaustGasTemperature(_)
            | Self::FuelQuantity
            | Self::AntiIce => true,
            Self::Time
            | Self::PressureAltitude
            | Self::StaticAirTemperature
            | Self::Mach
            | Self::TrueAirspeed
            | Self::GroundSpeed
            | Self::Roll
            | Self::Drift
            | Self::N2(_)
            | Self::FuelFlowEngine(_)
            | Self::FuelFlowTotal
            | Self::FuelUsed => false,
        }
    }

    /// Inclusive range in the stored unit. The upper limits that depend on the report (total fuel flow by the number of
    /// engines, fuel used and fuel quantity by the fuel on board) are for the caller to check.
    #[must_use]
    pub const fn range(self) -> ColumnRange {
        const fn closed(minimum: f64, maximum: f64, words: &'static str) -> ColumnRange {
            ColumnRange {
                minimum: Some(minimum),
                maximum: Some(maximum),
                minimum_excluded: false,
                words,
            }
        }
        match self {
            Self::Time => ColumnRange {
                minimum: None,
                maximum: None,
                minimum_excluded: false,
                words: "any, strictly increasing",
            },
            Self::PressureAltitude => {
                closed(-2_000.0 * METERS_PER_FOOT, 60_000.0 * METERS_PER_FOOT, "-2000 to 60000 ft")
            }
            Self::StaticAirTemperature => closed(
                KELVIN_AT_ZERO_CELSIUS - 100.0,
                KELVIN_AT_ZERO_CELSIUS + 60.0,
                "-100 to +60 degC",
            ),
            Self::TotalAirTemperature => closed(
                KELVIN_AT_ZERO_CELSIUS - 100.0,
                KELVIN_AT_ZERO_CELSIUS + 90.0,
                "-100 to +90 degC",
            ),
            Self::ExhaustGasTemperature(_) => closed(
                KELVIN_AT_ZERO_CELSIUS - 100.0,
                KELVIN_AT_ZERO_CELSIUS + 1500.0,
                "-100 to 1500 degC",
            ),
            Self::Mach => closed(0.1, 0.99, "0.1 to 0.99"),
            Self::TrueAirspeed | Self::GroundSpeed => closed(
                50.0 * METERS_PER_SECOND_PER_KNOT,
                1000.0 * METERS_PER_SECOND_PER_KNOT,
                "50 to 1000 kt",
            ),
            Self::Roll | Self::Drift | Self::Latitude => closed(-90.0, 90.0, "-90 to 90 deg"),
            Self::N2(_) | Self::N1(_) => closed(0.0, 130.0, "0 to 130 %"),
            Self::FuelFlowEngine(_) => ColumnRange {
                minimum: Some(0.0),
                maximum: Some(MAXIMUM_ENGINE_FUEL_FLOW_KG_S),
                minimum_excluded: true,
                words: "above 0 to 100000 lb/h",
            },
            Self::FuelFlowTotal => ColumnRange {
                minimum: Some(0.0),
                maximum: Some(MAXIMUM_ENGINE_FUEL_FLOW_KG_S),
                minimum_excluded: true,
                words: "above 0 to 100000 lb/h per engine",
            },
            Self::FuelUsed => ColumnRange {
                minimum: Some(0.0),
                maximum: None,
                minimum_excluded: false,
                words: "0 to FOB",
            },
            Self::FuelQuantity => ColumnRange {
                minimum: Some(0.0),
                maximum: None,
                minimum_excluded: false,
                words: "0 to 1.02 FOB",
            },
            Self::Longitude => closed(-180.0, 360.0, "-180 to 360 deg"),
            Self::TrueHeading => closed(-360.0, 360.0, "-360 to 360 deg"),
            Self::CenterOfGravity => closed(-50.0, 150.0, "-50 to 150 %MAC"),
            Self::AntiIce => closed(0.0, 1.0, "0 or 1"),
        }
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
