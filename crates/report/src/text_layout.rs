//! The units and the number of decimals in which a report is written.

use core::fmt::Write;

use flight::column::{Column, ColumnUnit};

/// How many decimals a number is written with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decimals {
    /// Always this many.
    Fixed(usize),
    /// Rounded to this many; zeros at the end are left out.
    AtMost(usize),
    /// As few as restore the same number.
    Shortest,
}

/// Unit and decimals of every column. Zero-fuel weight and fuel on board are written like fuel used.
#[derive(Clone, Debug, PartialEq)]
pub struct TextLayout {
    families: [Family; Column::ALL.len()],
}

/// A unit in which a column is not written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {} is not written in {unit}", column.name())]
pub struct UnitUnknown {
    /// The column.
    pub column: Column,
    /// The unit.
    pub unit: String,
}

impl TextLayout {
    /// Units of the flight deck with the decimals that recordings of cruises carry: ft, °C, kt, lb/h, lb.
    /// Rounding to these decimals loses up to half of the last one.
    #[must_use]
    pub fn industry() -> Self {
        Self {
            families: Column::ALL.map(|column| Family {
                unit: column.units()[0],
                decimals: industry_decimals(column),
            }),
        }
    }

    /// The units in which a report is stored, with as many decimals as each number needs: reading the text restores the
    /// same bits.
    #[must_use]
    pub fn exact() -> Self {
        Self {
            families: Column::ALL.map(|column| Family {
                unit: *column
                    .units()
                    .iter()
                    .find(|unit| unit.name == column.canonical_unit())
                    .unwrap_or(&column.units()[0]),
                decimals: Decimals::Shortest,
            }),
        }
    }

    /// The same with another unit and other decimals for one column; for a column of an engine, for all engines.
    ///
    /// # Errors
    /// [`UnitUnknown`] for a unit that the format does not define for the column.
    pub fn with(
        mut self,
        column: Column,
        unit: &str,
        decimals: Decimals,
    ) -> Result<Self, UnitUnknown> {
        match column.units().iter().find(|known| known.name == unit) {
            Some(unit) => {
                self.families[column.index()] = Family { unit: *unit, decimals };
                Ok(self)
            }
            None => Err(UnitUnknown { column, unit: unit.to_owned() }),
        }
    }

    pub(crate) fn unit(&self, column: Column) -> &'static str {
        self.families[column.index()].unit.name
    }

    /// Appends a value of the column's stored unit.
    pub(crate) fn append(&self, column: Column, value: f64, text: &mut String) {
        let Family { unit, decimals } = &self.families[column.index()];
        append_number((value - unit.offset) / unit.factor, *decimals, text);
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Family {
    unit: ColumnUnit,
    decimals: Decimals,
}

const fn industry_decimals(column: Column) -> Decimals {
    match column {
        // Recordings faster than one sample a second keep their times distinct.
        Column::Time => Decimals::AtMost(3),
        Column::PressureAltitude
        | Column::FuelFlowEngine(_)
        | Column::FuelFlowTotal
        | Column::FuelUsed
        | Column::ExhaustGasTemperature(_)
        | Column::FuelQuantity => Decimals::Fixed(0),
        Column::StaticAirTemperature
        | Column::TotalAirTemperature
        | Column::TrueAirspeed
        | Column::GroundSpeed
        | Column::Roll
        | Column::Drift
        | Column::N1(_)
        | Column::N2(_)
        | Column::TrueHeading
        | Column::CenterOfGravity => Decimals::Fixed(1),
        Column::Latitude | Column::Longitude => Decimals::Fixed(3),
        Column::Mach => Decimals::Fixed(4),
        // Only 0 and 1 are values: nothing to round.
        Column::AntiIce => Decimals::Shortest,
    }
}

fn append_number(value: f64, decimals: Decimals, text: &mut String) {
    let start = text.len();
    // Writing into a string cannot fail.
    let _ = match decimals {
        Decimals::Shortest => write!(text, "{value}"),
        Decimals::Fixed(count) | Decimals::AtMost(count) => write!(text, "{value:.count$}"),
    };
    if matches!(decimals, Decimals::AtMost(1..)) {
        let kept = text[start..].trim_end_matches('0').trim_end_matches('.').len();
        text.truncate(start + kept);
    }
    // A value that rounds to zero has no sign.
    if text[start..].starts_with('-') && !text[start..].contains(|c: char| ('1'..='9').contains(&c))
    {
        text.remove(start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_has_its_own_place() {
        for (index, column) in Column::ALL.into_iter().enumerate() {
            assert_eq!(column.index(), index, "{column:?}");
        }
    }

    #[test]
    fn numbers() {
        let written = |value, decimals| {
            let mut text = "-".to_owned();
            append_number(value, decimals, &mut text);
            text.split_off(1)
        };
        for (value, decimals, expected) in [
            (-0.04, Decimals::Fixed(1), "0.0"),
            (-0.06, Decimals::Fixed(1), "-0.1"),
            (43_008.4, Decimals::Fixed(0), "43008"),
            (60.0, Decimals::AtMost(3), "60"),
            (1200.0, Decimals::AtMost(0), "1200"),
            (0.25, Decimals::AtMost(3), "0.25"),
            (-0.0001, Decimals::AtMost(3), "0"),
            (-0.0, Decimals::Shortest, "0"),
            (0.1 + 0.2, Decimals::Shortest, "0.30000000000000004"),
        ] {
            assert_eq!(written(value, decimals), expected, "{value} {decimals:?}");
        }
    }
}
