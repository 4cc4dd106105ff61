//! From rows of a recording to a report: conversion, derivation, ranges.

mod air;
mod flow;
mod load;
mod masses;
mod rows;
mod start;
mod told;

use core::ops::Range;

use flight::column::Column;
use flight::{
    Assumption, FlightIdentity, FuelFlowColumns, MAXIMUM_ENGINES, OptionalColumn, OptionalColumns,
    Report, ReportColumns, ReportDataError, ReportHeader, Timestamp,
};
use jiff::SignedDuration;
use units::Mass;

use super::plan::{Conversion, Plan, TemperatureSource};
use super::table::{EARLIEST_S, Layout, Recording};
use air::AirData;
pub(super) use rows::Limits;
use rows::{Converted, Used, UsedRows};

use crate::Parsed;
use crate::refusal::{Found, Refusal, RefusalKind};

const MAXIMUM_FUEL_QUANTITY_PER_FUEL_ON_BOARD: f64 = 1.02;

/// The report of the level parts of a recording; of averaged points also their scatter.
pub(super) fn report(
    layout: &Layout,
    recording: &Recording,
    parts: &[Range<usize>],
) -> Result<(Parsed, Option<PointScatter>), Refusal> {
    let plan = &layout.plan;
    let fewest = if plan.points.is_some() { 1 } else { 3 };
    let level_rows = parts.iter().map(Range::len).sum();
    let first = parts.first().map_or(0, |part| part.start);
    let Used { rows, mut surplus, converted } = Used::new(plan, recording, parts, fewest);
    let refuse_inconsistent = |left_out: usize, error| {
        let found = Found::Rows(level_rows - left_out);
        layout.refuse(recording, (first, 0), found, RefusalKind::Inconsistent(error))
    };
    if rows.len() < fewest {
        let error = ReportDataError::TooFewSamples { found: rows.len() };
        return Err(refuse_inconsistent(surplus.len(), error));
    }
    let level_parts = parts.len();
    let mut part = Part { plan, layout, recording, rows, converted, level_rows, level_parts };
    let (masses, impossible) = part.gross_masses(fewest)?;
    surplus.extend(impossible);
    surplus.sort_unstable_by_key(|(row, _)| *row);
    let air = part.air_data()?;
    let mut load = part.load(masses.as_ref())?;
    let fuel_used_kg = core::mem::take(&mut load.fuel_used_kg);
    let columns = part.columns(air, &load, fuel_used_kg)?;
    let mut notes = plan.notes.clone();
    let derived = part.derived(&load);
    if !derived.is_empty() {
        notes.push(("DERIVED".to_owned(), derived.join(", ")));
    }
    let header = ReportHeader {
        aircraft_type: recording.texts[0].clone(),
        identity: FlightIdentity {
            tail: recording.texts[1].clone(),
            start: part.start()?,
            flight: recording.texts[2].clone(),
        },
        zero_fuel_mass: load.zero_fuel_mass,
        fuel_on_board: load.fuel_on_board,
        lower_heating_value_mj_kg: plan.lower_heating_value_mj_kg,
        missing: plan.missing(),
        assumed: match plan.temperature {
            TemperatureSource::Isa { deviation_k: isa_deviation_k } => {
                vec![Assumption::StaticAirTemperatureIsa { isa_deviation_k }]
            }
            _ => Vec::new(),
        },
        notes,
    };
    let findings = part.findings(&derived, &load, &surplus);
    let scatter = part.scatter();
    let report = match scatter {
        None => Report::new(header, columns),
        Some(_) => Report::of_points(header, columns),
    };
    let report = report.map_err(|error| refuse_inconsistent(surplus.len(), error))?;
    let left_out = surplus.len() + recording.bad;
    Ok((Parsed { report, findings, left_out }, scatter))
}

/// Standard deviations within the frames of averaged points, by quantity.
type PointScatter = Vec<(Column, Vec<f64>)>;

/// Numbers in the stored unit of their column, with the input column that a refusal refers to.
struct Series {
    values: Vec<f64>,
    input: usize,
    /// The column in whose range all are known to be.
    within: Option<Column>,
}

impl Series {
    const fn new(values: Vec<f64>, input: usize) -> Self {
        Self { values, input, within: None }
    }

    const EMPTY: Self = Self::new(Vec::new(), 0);
}

struct Load {
    zero_fuel_mass: Mass,
    fuel_on_board: Mass,
    fuel_used_kg: Vec<f64>,
    /// How far a recorded gross mass rose above its smallest value before.
    largest_rise_kg: Option<f64>,
    /// Rows whose fuel flow was not believed where it was integrated.
    bridged: usize,
    /// What may be wrong with a start mass: code and words.
    doubts: Vec<(&'static str, String)>,
}

struct Part<'p> {
    plan: &'p Plan,
    layout: &'p Layout,
    recording: &'p Recording,
    /// Rows of the recording, at least three (of averaged points one).
    rows: UsedRows,
    /// What is recorded of them, until it is used.
    converted: Vec<Converted>,
    /// Number of rows before any was left out for its range.
    level_rows: usize,
    /// Number of level parts that they come from.
    level_parts: usize,
}

impl Part<'_> {
    fn start(&self) -> Result<Timestamp, Refusal> {
        let seconds = self.recording.time_s[self.rows.at(0)];
        SignedDuration::try_from_secs_f64(seconds)
            .ok()
            .and_then(|duration| self.recording.origin.checked_add(duration).ok())
            .filter(|start| start.as_second() >= EARLIEST_S)
            .ok_or_else(|| {
                let found = Found::Number { value: seconds, unit: "s" };
                let kind = RefusalKind::SourceInstantMalformed;
                self.layout.refuse_time(self.recording, self.rows.at(0), found, kind)
            })
    }

    /// `row` counts from the part's first.
    fn refuse(&self, row: usize, input: usize, found: Found, kind: RefusalKind) -> Refusal {
        self.layout.refuse(self.recording, (self.rows.at(row), input), found, kind)
    }

    /// `None` where the rows are samples.
    fn scatter(&self) -> Option<PointScatter> {
        let points = self.plan.points.as_ref()?;
        let scatter = points.scatter.iter();
        Some(scatter.map(|(column, conversion)| (*column, self.convert(conversion))).collect())
    }

    fn convert(&self, conversion: &Conversion) -> Vec<f64> {
        let mut values = Vec::with_capacity(self.rows.len());
        for run in self.rows.runs() {
            conversion.append_to(&mut values, &self.recording.numbers, run, |_| true);
        }
        values
    }

    fn recorded(&mut self, wanted: Column) -> Option<Series> {
        let conversion = self.plan.recorded_as(wanted)?;
        let converted = self.converted.iter().position(|one| one.column == wanted);
        Some(match converted.map(|place| self.converted.swap_remove(place)) {
            Some(Converted { values, is_within, .. }) => {
                Series { values, input: conversion.input, within: is_within.then_some(wanted) }
            }
            // Some are asked for twice.
            None => Series::new(self.convert(conversion), conversion.input),
        })
    }

    /// The column, inside its range; empty where it is absent, which the plan has excluded for required ones.
    fn required(&mut self, column: Column) -> Result<Series, Refusal> {
        let series = self.recorded(column).unwrap_or(Series::EMPTY);
        self.check_range(column, &series, None)?;
        Ok(series)
    }

    fn all(&mut self, column: Column) -> Result<Option<Vec<f64>>, Refusal> {
        match self.recorded(column) {
            None => Ok(None),
            Some(series) => {
                self.check_range(column, &series, None)?;
                Ok(Some(series.values))
            }
        }
    }

    fn optional(
        &mut self,
        column: Column,
        maximum: Option<f64>,
    ) -> Result<Option<OptionalColumn>, Refusal> {
        let Some(series) = self.recorded(column) else { return Ok(None) };
        self.check_range(column, &series, maximum)?;
        Ok(Some(
            series.values.into_iter().map(|value| (!value.is_nan()).then_some(value)).collect(),
        ))
    }

    fn check_range(
        &self,
        column: Column,
        series: &Series,
        maximum: Option<f64>,
    ) -> Result<(), Refusal> {
        let limits = Limits::new(column, maximum);
        if (maximum.is_none() && series.within == Some(column)) || limits.admit_all(&series.values)
        {
            return Ok(());
        }
        match series.values.iter().position(|value| !limits.admit(*value)) {
            None => Ok(()),
            Some(row) => {
                let value = series.values[row];
                let unit = column.canonical_unit();
                let limit = if value < limits.low { limits.minimum } else { limits.maximum };
                let kind = RefusalKind::OutOfRange { column, limit, unit };
                Err(self.refuse(row, series.input, Found::Number { value, unit }, kind))
            }
        }
    }

    fn columns(
        &mut self,
        air: AirData,
        load: &Load,
        fuel_used_kg: Vec<f64>,
    ) -> Result<ReportColumns, Refusal> {
        let is_temperature_assumed = matches!(self.plan.temperature, TemperatureSource::Isa { .. });
        let first_s = self.recording.time_s[self.rows.at(0)];
        let fuel_quantity_kg =
            load.fuel_on_board.to_kilograms() * MAXIMUM_FUEL_QUANTITY_PER_FUEL_ON_BOARD;
        let mut time_s = Vec::with_capacity(self.rows.len());
        for run in self.rows.runs() {
            time_s.extend(self.recording.time_s[run].iter().map(|time| time - first_s));
        }
        let n2_percent = self.engines(Column::N2)?;
        let flows = self.engines(Column::FuelFlowEngine)?;
        let mut optional = OptionalColumns::default();
        for column in Column::optional_ones(MAXIMUM_ENGINES) {
            let maximum = (column == Column::FuelQuantity).then_some(fuel_quantity_kg);
            if let Some(values) = self.optional(column, maximum)? {
                optional.insert(column, values);
            }
        }
        Ok(ReportColumns {
            time_s,
            pressure_altitude_m: air.pressure_altitude_m.values,
            static_air_temperature_k: (!is_temperature_assumed)
                .then_some(air.static_air_temperature_k.values),
            mach: air.mach.values,
            true_airspeed_m_s: air.true_airspeed_m_s.values,
            ground_speed_m_s: self.required(Column::GroundSpeed)?.values,
            roll_deg: self.all(Column::Roll)?,
            drift_deg: self.all(Column::Drift)?,
            fuel_flow: if flows.is_empty() {
                FuelFlowColumns::Total(self.total_fuel_flow()?)
            } else {
                FuelFlowColumns::PerEngine(flows)
            },
            n2_percent: (!n2_percent.is_empty()).then_some(n2_percent),
            fuel_used_kg,
            optional,
        })
    }

    fn engines(&mut self, column: fn(u8) -> Column) -> Result<Vec<Vec<f64>>, Refusal> {
        let mut engines = Vec::new();
        for engine in (1..).take(MAXIMUM_ENGINES) {
            engines.extend(self.all(column(engine))?);
        }
        Ok(engines)
    }

    fn total_fuel_flow(&mut self) -> Result<Vec<f64>, Refusal> {
        let column = Column::FuelFlowTotal;
        let maximum = self.largest_total_flow_kg_s();
        let series = self.recorded(column).unwrap_or(Series::EMPTY);
        self.check_range(column, &series, maximum)?;
        Ok(series.values)
    }
}
