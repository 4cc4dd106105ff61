//! The line of column names and the line of units, and from them the meaning of each field of a row.

use std::collections::BTreeMap;

use flight::column::{Column, ColumnUnit};
use flight::{Finding, MAXIMUM_ENGINES, MissingColumn, ReportHeader, Severity};

use crate::line::{Line, Lines, Word};
use crate::refusal::{Found, Refusal, RefusalKind};

/// Fuel quantity may exceed the fuel on board by 2 %.
const MAXIMUM_FUEL_QUANTITY_PER_FUEL_ON_BOARD: f64 = 1.02;
/// A limit is widened by this share of itself: a value written exactly on it must not fail because of a conversion's
/// rounding.
const LIMIT_ROUNDING: f64 = 1e-12;
const KEPT_OUT_PREFIX: &str = "X-";
const LAST_ENGINE: u8 = 4;
const _: () = assert!(LAST_ENGINE as usize == MAXIMUM_ENGINES);

/// One field of every row: which column it is, how it is read and converted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    /// `None` for a column that is ignored: its fields are counted and not read.
    pub(crate) column: Option<Column>,
    /// False for a column that the header declares missing: it is checked and not handed on.
    pub(crate) is_handed_on: bool,
    /// Whether `-` is allowed in it.
    pub(crate) is_optional: bool,
    /// Unit of the file, whose factor and offset lead to the stored unit.
    pub(crate) unit: ColumnUnit,
    /// Smallest value in the unit of the file, and the same minus rounding.
    pub(crate) minimum: f64,
    pub(crate) low: f64,
    /// Largest value in the unit of the file, and the same plus rounding.
    pub(crate) maximum: f64,
    pub(crate) high: f64,
}

impl Field {
    /// Whether a number in the unit of the file is inside the range.
    #[inline]
    pub(crate) fn holds(&self, number: f64) -> bool {
        self.low <= number && number <= self.high
    }

    /// From the unit of the file to the stored unit.
    #[inline]
    pub(crate) fn convert(&self, value: f64) -> f64 {
        value * self.unit.factor + self.unit.offset
    }
}

/// Reads names and units into `fields` and returns the number of engines, where the columns determine it.
pub(super) fn read(
    names: Line<'_>,
    lines: &mut Lines<'_>,
    header: &ReportHeader,
    fields: &mut Vec<Field>,
    findings: &mut Vec<Finding>,
) -> Result<Option<u8>, Refusal> {
    let columns = read_names(names)?;
    let engines = check_names(names, &columns, header)?;
    note_contradictions(names, &columns, header, findings);
    let Some(units) = lines.next_of_meaning() else {
        return Err(lines.refuse_end(Found::EndOfText, RefusalKind::UnitsMissing));
    };
    let count = units.meaning().words().count();
    if count != columns.len() {
        let kind = RefusalKind::UnitCountWrong { expected: columns.len() };
        let found = Found::Units(count);
        return Err(match units.meaning().words().nth(columns.len()) {
            Some(surplus) => units.refuse(surplus.offset, found, kind),
            None => units.refuse_end(found, kind),
        });
    }
    fields.clear();
    for ((_, column), unit) in columns.into_iter().zip(units.meaning().words()) {
        fields.push(match column {
            Some(column) => field_of(column, units, unit, header, engines)?,
            None => KEPT_OUT,
        });
    }
    Ok(engines)
}

/// An empty range: no number is read as one of this column.
const KEPT_OUT: Field = Field {
    column: None,
    is_handed_on: false,
    is_optional: true,
    unit: ColumnUnit { name: "-", factor: 1.0, offset: 0.0 },
    minimum: f64::MIN,
    low: f64::INFINITY,
    maximum: f64::MAX,
    high: f64::NEG_INFINITY,
};

type NamedColumn<'a> = (Word<'a>, Option<Column>);

fn read_names(line: Line<'_>) -> Result<Vec<NamedColumn<'_>>, Refusal> {
    let mut columns: Vec<NamedColumn<'_>> = Vec::new();
    // A line can hold a hundred thousand names that the format does not know, and of those that it knows some tens.
    let mut kept_out: BTreeMap<&str, Word<'_>> = BTreeMap::new();
    for word in line.meaning().words() {
        let column = Column::from_name(word.text);
        let first = match column {
            Some(_) => columns.iter().find(|(_, known)| *known == column).map(|(word, _)| *word),
            None => kept_out.insert(word.text, word),
        };
        if let Some(first) = first {
            let first_column = line.text[..first.offset].chars().count() + 1;
            return Err(line.refuse_word(word, RefusalKind::ColumnDoubled { first_column }));
        }
        if column.is_none() && !word.text.starts_with(KEPT_OUT_PREFIX) {
            return Err(line.refuse_word(word, RefusalKind::ColumnUnknown));
        }
        columns.push((word, column));
    }
    Ok(columns)
}

/// Required columns and the numbering of engines.
fn check_names(
    line: Line<'_>,
    columns: &[NamedColumn<'_>],
    header: &ReportHeader,
) -> Result<Option<u8>, Refusal> {
    let find = |wanted: Column| {
        columns.iter().find(|(_, column)| *column == Some(wanted)).map(|(word, _)| *word)
    };
    let require = |column: Column| match find(column) {
        Some(_) => Ok(()),
        None => Err(line.refuse_end(Found::EndOfLine, RefusalKind::ColumnMissing { column })),
    };
    let is_missing = |column| header.missing.contains(&column);
    require(Column::PressureAltitude)?;
    if !is_missing(MissingColumn::StaticAirTemperature) {
        require(Column::StaticAirTemperature)?;
    }
    require(Column::Mach)?;
    require(Column::TrueAirspeed)?;
    require(Column::GroundSpeed)?;
    if !is_missing(MissingColumn::Roll) {
        require(Column::Roll)?;
    }
    if !is_missing(MissingColumn::Drift) {
        require(Column::Drift)?;
    }
    require(Column::FuelUsed)?;

    let rotor_speeds = count_engines(line, find, Column::N2)?;
    let flows = count_engines(line, find, Column::FuelFlowEngine)?;
    if rotor_speeds == 0 && !is_missing(MissingColumn::N2) {
        return require(Column::N2(1)).map(|()| None);
    }
    match (flows, find(Column::FuelFlowTotal)) {
        (0, None) => return require(Column::FuelFlowEngine(1)).map(|()| None),
        (1.., Some(total)) => return Err(line.refuse_word(total, RefusalKind::FuelFlowTwice)),
        _ => {}
    }
    if flows > 0 && rotor_speeds > 0 && flows != rotor_speeds {
        let (surplus, lacking) = if flows > rotor_speeds {
            (Column::FuelFlowEngine(flows), Column::N2(flows))
        } else {
            (Column::N2(rotor_speeds), Column::FuelFlowEngine(rotor_speeds))
        };
        let kind = RefusalKind::EnginesDiffer { column: lacking };
        return Err(refuse_found(line, find(surplus), kind));
    }
    let engines = flows.max(rotor_speeds);
    if engines == 0 {
        return Ok(None);
    }
    for engine in engines + 1..=LAST_ENGINE {
        for column in [Column::N1(engine), Column::ExhaustGasTemperature(engine)] {
            if let Some(word) = find(column) {
                let lacking =
                    if flows > 0 { Column::FuelFlowEngine(engine) } else { Column::N2(engine) };
                let kind = RefusalKind::EngineMissing { column: lacking };
                return Err(line.refuse_word(word, kind));
            }
        }
    }
    Ok(Some(engines))
}

/// The number of engines in a family of columns that must be numbered without a gap; 0 where there is none.
fn count_engines<'a>(
    line: Line<'_>,
    find: impl Fn(Column) -> Option<Word<'a>>,
    column: impl Fn(u8) -> Column,
) -> Result<u8, Refusal> {
    let last = (1..=LAST_ENGINE).rev().find(|engine| find(column(*engine)).is_some());
    let Some(last) = last else { return Ok(0) };
    match (1..last).find(|engine| find(column(*engine)).is_none()) {
        Some(gap) => {
            let kind = RefusalKind::EngineMissing { column: column(gap) };
            Err(refuse_found(line, find(column(last)), kind))
        }
        None => Ok(last),
    }
}

fn refuse_found(line: Line<'_>, word: Option<Word<'_>>, kind: RefusalKind) -> Refusal {
    match word {
        Some(word) => line.refuse_word(word, kind),
        None => line.refuse_end(Found::EndOfLine, kind),
    }
}

fn is_declared_missing(column: Column, header: &ReportHeader) -> bool {
    column.missing().is_some_and(|missing| header.missing.contains(&missing))
}

/// A column that the header declares missing is not used, and an assumption for a recorded one is not needed.
fn note_contradictions(
    line: Line<'_>,
    columns: &[NamedColumn<'_>],
    header: &ReportHeader,
    findings: &mut Vec<Finding>,
) {
    let mut note = |code, message| {
        findings.push(Finding {
            severity: Severity::Warning,
            code,
            message,
            line: Some(line.number),
        });
    };
    for (word, column) in columns {
        if column.is_some_and(|column| is_declared_missing(column, header)) {
            note(
                "column-declared-missing",
                format!(
                    "column {} is not used: MISSING declares that it was not recorded",
                    word.text
                ),
            );
        }
    }
    let is_temperature_assumed = header
        .assumed
        .iter()
        .any(|assumed| matches!(assumed, flight::Assumption::StaticAirTemperatureIsa { .. }));
    if is_temperature_assumed && !header.missing.contains(&MissingColumn::StaticAirTemperature) {
        note(
            "assumption-not-needed",
            "SAT is recorded and used; the assumption about it in ASSUMED is not".to_owned(),
        );
    }
}

fn field_of(
    column: Column,
    line: Line<'_>,
    unit_name: Word<'_>,
    header: &ReportHeader,
    engines: Option<u8>,
) -> Result<Field, Refusal> {
    let Some(unit) = column.units().iter().find(|unit| unit.name == unit_name.text) else {
        return Err(line.refuse_word(unit_name, RefusalKind::UnitUnknown { column }));
    };
    let range = column.range();
    let fuel_on_board_kg = header.fuel_on_board.to_kilograms();
    // Where nothing determines the number of engines, the format's largest number of them.
    let engines = f64::from(engines.unwrap_or(LAST_ENGINE));
    let maximum = match column {
        Column::FuelUsed => Some(fuel_on_board_kg),
        Column::FuelQuantity => Some(fuel_on_board_kg * MAXIMUM_FUEL_QUANTITY_PER_FUEL_ON_BOARD),
        Column::FuelFlowTotal => range.maximum.map(|maximum| maximum * engines),
        _ => range.maximum,
    };
    let in_file_unit = |limit: f64| (limit - unit.offset) / unit.factor;
    let minimum = range.minimum.map(in_file_unit);
    let maximum = maximum.map(in_file_unit);
    Ok(Field {
        column: Some(column),
        is_handed_on: !is_declared_missing(column, header),
        is_optional: column.is_optional(),
        unit: *unit,
        minimum: minimum.unwrap_or(f64::MIN),
        low: match minimum {
            // Only a minimum of zero is excluded, and it needs no rounding.
            Some(_) if range.minimum_excluded => f64::MIN_POSITIVE,
            Some(limit) => limit - limit.abs() * LIMIT_ROUNDING,
            // Time has no limit of its own, but must stay finite in seconds.
            None => f64::MIN / unit.factor,
        },
        maximum: maximum.unwrap_or(f64::MAX),
        high: maximum.map_or(f64::MAX / unit.factor, |limit| limit + limit.abs() * LIMIT_ROUNDING),
    })
}
