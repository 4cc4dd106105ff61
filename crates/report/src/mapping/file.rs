//! The mapping file as it is written: RON into plain data; only the form is checked.

use serde::Deserialize;

mod quantities;

use quantities::Quantities;

impl MappingFile {
    /// The mapping for a recording with these column names: alternatives (`a|b`) and wildcards (`Eng*1*FF`) become the
    /// name that is there, optional quantities without their column are left away.
    pub(super) fn resolved(&self, names: &[&str]) -> Self {
        let mut file = self.clone();
        file.quantities.0.retain(|(_, source)| match source {
            QuantitySource::Recorded { column, optional: true, .. } => {
                present(column, names).is_some()
            }
            _ => true,
        });
        let mut columns: Vec<&mut String> = Vec::new();
        for (_, source) in &mut file.quantities.0 {
            match source {
                QuantitySource::Recorded { column, .. }
                | QuantitySource::FromCalibratedAirspeed { column, .. } => columns.push(column),
                QuantitySource::Difference { column, minus, .. } => columns.extend([column, minus]),
                _ => {}
            }
        }
        for source in [&mut file.aircraft, &mut file.tail, &mut file.flight] {
            if let TextSource::Column(column) = source {
                columns.push(column);
            }
        }
        file.mass.columns(&mut columns);
        file.time.columns(&mut columns);
        columns.extend(file.only.iter_mut().map(|(column, _)| column));
        if let RowsAre::AveragedPoints { scatter, .. } = &mut file.rows {
            columns.extend(scatter.iter_mut().map(|(_, column, _)| column));
        }
        for column in columns {
            if let Some(name) = present(column, names) {
                *column = name;
            }
        }
        file
    }
}

impl MassSource {
    fn columns<'a>(&'a mut self, columns: &mut Vec<&'a mut String>) {
        let mut amounts: Vec<&'a mut Amount> = Vec::new();
        match self {
            Self::GrossMass { column, .. } | Self::FuelUsed { column, .. } => columns.push(column),
            Self::LoadSheet { fuel_used, zero_fuel_weight, fuel_on_board } => {
                amounts.extend([fuel_used, zero_fuel_weight, fuel_on_board]);
            }
            Self::ZeroFuelAndTanks { zero_fuel_weight, tanks, .. } => {
                amounts.push(zero_fuel_weight);
                columns.extend(tanks);
            }
            Self::StartMass { gross_weight } => amounts.push(gross_weight),
        }
        for amount in amounts {
            match amount {
                Amount::Value(..) => {}
                Amount::Column(column, _) => columns.push(column),
                Amount::Columns(of_sum, _) => columns.extend(of_sum),
            }
        }
    }
}

impl TimeSource {
    fn columns<'a>(&'a mut self, columns: &mut Vec<&'a mut String>) {
        match self {
            Self::Timestamp { column, date, utc_offset_column, .. } => {
                columns.push(column);
                columns.extend(date);
                columns.extend(utc_offset_column);
            }
            Self::Epoch { column, .. }
            | Self::TimeOfDay { column, .. }
            | Self::Seconds { column, .. }
            | Self::Days { column, .. } => columns.push(column),
        }
    }
}

/// The name in the recording that a column of the mapping stands for: of several alternatives the first that is there; of
/// a wildcard the only one that fits.
fn present(column: &str, names: &[&str]) -> Option<String> {
    if names.contains(&column) {
        return Some(column.to_owned());
    }
    column.split('|').find_map(|alternative| {
        let mut fitting = names.iter().filter(|name| fits(alternative, name));
        match (fitting.next(), fitting.next()) {
            (Some(name), None) => Some((*name).to_owned()),
            _ => None,
        }
    })
}

/// Whether a name fits a pattern in which `*` stands for any text.
fn fits(pattern: &str, name: &str) -> bool {
    let mut pieces = pattern.split('*');
    let Some(mut rest) = pieces.next().and_then(|first| name.strip_prefix(first)) else {
        return false;
    };
    let Some(last) = pieces.next_back() else { return rest.is_empty() };
    for piece in pieces {
        let Some(at) = rest.find(piece) else { return false };
        rest = &rest[at + piece.len()..];
    }
    rest.ends_with(last)
}

/// The only version of the mapping file.
pub(super) const FORMAT: u32 = 1;

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename = "Mapping")]
pub(super) struct MappingFile {
    pub(super) format: u32,
    #[serde(default = "comma")]
    pub(super) separator: char,
    /// The character before the decimals of a number.
    #[serde(default = "point")]
    pub(super) decimal: char,
    /// Character between groups of three digits, which is left out.
    #[serde(default)]
    pub(super) thousands: Option<char>,
    /// Line of the column names, from 1, where titles stand above it.
    #[serde(default = "first_line")]
    pub(super) names_line: usize,
    /// Whether a row of units follows the names.
    #[serde(default)]
    pub(super) units_row: bool,
    #[serde(default)]
    pub(super) rows: RowsAre,
    #[serde(default)]
    pub(super) comment: Option<char>,
    #[serde(default)]
    pub(super) not_available: Vec<String>,
    pub(super) aircraft: TextSource,
    pub(super) tail: TextSource,
    pub(super) flight: TextSource,
    #[serde(default)]
    pub(super) lower_heating_value_mj_kg: Option<f64>,
    #[serde(default)]
    pub(super) notes: Vec<(String, String)>,
    pub(super) time: TimeSource,
    pub(super) mass: MassSource,
    pub(super) quantities: Quantities,
    #[serde(default)]
    pub(super) out_of_range: OutOfRange,
    #[serde(default)]
    pub(super) bad_rows: BadRows,
    /// Rows that are used: those whose column holds one of the texts.
    #[serde(default)]
    pub(super) only: Vec<(String, Vec<String>)>,
    /// A gap in time after which another flight begins, s.
    #[serde(default)]
    pub(super) new_flight_after_s: Option<f64>,
    #[serde(default)]
    pub(super) cruise: Option<CruiseFile>,
}

/// What the rows are.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum RowsAre {
    /// Samples of a recorder, one after the other.
    #[default]
    Samples,
    /// Means over stable frames, one a row.
    AveragedPoints {
        /// Length of a frame, s.
        averaged_over_s: f64,
        /// Standard deviations within a frame: quantity, column, unit.
        #[serde(default)]
        scatter: Vec<(String, String, String)>,
    },
}

/// What happens to a row with a recorded number outside its column's range.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub(super) enum OutOfRange {
    /// The recording is refused, as a report is.
    #[default]
    Refuse,
    /// The row is left out and counted.
    LeaveRowOut,
}

/// What happens to a row that cannot be read, or whose time does not follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub(super) enum BadRows {
    /// The recording is refused, as a report is.
    #[default]
    Refuse,
    /// The row is left out and counted.
    LeaveRowOut,
}

/// The source of a text of the header.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) enum TextSource {
    /// The same in every file.
    Text(String),
    /// A column of the recording; where it changes, another recording begins.
    Column(String),
    /// The name of the file, which the caller knows.
    FileName,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum TimeSource {
    /// ISO text, or one of another `format`; `utc_offset` where the text has none; `date` and `utc_offset_column` where
    /// they are in columns of their own.
    Timestamp {
        column: String,
        #[serde(default)]
        date: Option<String>,
        #[serde(default)]
        format: Option<String>,
        #[serde(default)]
        utc_offset: Option<String>,
        /// Column of the offset, where that is recorded.
        #[serde(default)]
        utc_offset_column: Option<String>,
    },
    /// Time since 1970 in s, ms, us or ns.
    Epoch { column: String, unit: String },
    /// Hours, minutes and seconds, or seconds since midnight; the day of the first row is `date`, and midnight begins the next one.
    TimeOfDay { column: String, date: String, utc_offset: String },
    /// Seconds since `start`.
    Seconds { column: String, start: String },
    /// Days with their fraction since `start`, as spreadsheets count them, to the millisecond.
    Days { column: String, start: String },
}

/// A number and its unit.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) struct WithUnit(pub(super) f64, pub(super) String);

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum MassSource {
    /// Gross mass, from whose fall fuel used is derived.
    GrossMass {
        column: String,
        unit: String,
        #[serde(default = "one")]
        scale: f64,
        #[serde(default)]
        hold_s: Option<f64>,
        #[serde(default)]
        interpolate_s: Option<f64>,
        #[serde(default)]
        zero_fuel_weight: Option<WithUnit>,
        largest_rise_kg: f64,
    },
    /// Fuel used since engine start, together with a load sheet.
    FuelUsed {
        column: String,
        unit: String,
        #[serde(default = "one")]
        scale: f64,
        zero_fuel_weight: WithUnit,
        fuel_on_board: WithUnit,
    },
    /// The same where the load sheet is in columns: that of a recording's first row is used, with what was burnt until then where
    /// the column falls.
    LoadSheet { fuel_used: Amount, zero_fuel_weight: Amount, fuel_on_board: Amount },
    /// Gross mass is zero-fuel weight and what the tanks hold.
    ZeroFuelAndTanks {
        zero_fuel_weight: Amount,
        tanks: Vec<String>,
        unit: String,
        largest_rise_kg: f64,
    },
    /// Gross mass at the recording's first row less the integral of fuel flow.
    StartMass { gross_weight: Amount },
}

/// A mass: the same in every flight, from a column, or the sum of several.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) enum Amount {
    Value(f64, String),
    Column(String, String),
    Columns(Vec<String>, String),
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum QuantitySource {
    /// A column, in a unit of the report's format, times `scale`.
    Recorded {
        column: String,
        #[serde(default)]
        unit: Option<String>,
        #[serde(default = "one")]
        scale: f64,
        #[serde(default)]
        offset: f64,
        /// The last value holds for this long, s.
        #[serde(default)]
        hold_s: Option<f64>,
        /// Between values no farther apart than this, s, a straight line.
        #[serde(default)]
        interpolate_s: Option<f64>,
        /// Texts that stand for numbers.
        #[serde(default)]
        values: Vec<(String, f64)>,
        /// Whether the quantity is left away where the recording lacks the column.
        #[serde(default)]
        optional: bool,
    },
    /// The angle between two columns, −180 … 180°.
    Difference { column: String, minus: String, unit: String },
    /// Mach number from calibrated airspeed and pressure altitude.
    FromCalibratedAirspeed {
        column: String,
        unit: String,
        #[serde(default = "one")]
        scale: f64,
        #[serde(default)]
        hold_s: Option<f64>,
        #[serde(default)]
        interpolate_s: Option<f64>,
    },
    /// Mach number from true airspeed and static air temperature, or that temperature from true airspeed and Mach number.
    FromTrueAirspeed,
    /// True airspeed from Mach number and static air temperature.
    FromMach,
    /// Static air temperature from total air temperature and Mach number.
    FromTotalTemperature { recovery_factor: f64 },
    /// Static air temperature of the ISA plus a deviation.
    Isa { deviation_k: f64 },
}

impl QuantitySource {
    pub(super) const fn name(&self) -> &'static str {
        match self {
            Self::Recorded { .. } => "Recorded",
            Self::Difference { .. } => "Difference",
            Self::FromCalibratedAirspeed { .. } => "FromCalibratedAirspeed",
            Self::FromTrueAirspeed => "FromTrueAirspeed",
            Self::FromMach => "FromMach",
            Self::FromTotalTemperature { .. } => "FromTotalTemperature",
            Self::Isa { .. } => "Isa",
        }
    }
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CruiseFile {
    pub(super) minimum_pressure_altitude_ft: f64,
    pub(super) band_ft: f64,
    pub(super) minimum_duration_s: f64,
    pub(super) trim_s: f64,
}

const fn comma() -> char {
    ','
}

const fn point() -> char {
    '.'
}

const fn first_line() -> usize {
    1
}

const fn one() -> f64 {
    1.0
}
