//! The cruise report as sent.

use std::borrow::Cow;

use crate::column::Column;
use crate::{MAXIMUM_ENGINES, OptionalColumn, OptionalColumns, ReportHeader};

/// Fuel flow as it was recorded: engine by engine, or the total only.
#[derive(Clone, Debug, PartialEq)]
pub enum FuelFlowColumns {
    /// `[engine][sample]`, kg/s per engine.
    PerEngine(Vec<Vec<f64>>),
    /// `[sample]`, kg/s of all engines together.
    Total(Vec<f64>),
}

impl FuelFlowColumns {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::PerEngine(engines) => engines.first().map_or(0, Vec::len),
            Self::Total(total) => total.len(),
        }
    }

    /// Whether there is no sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Total fuel flow of each sample, kg/s: the engines summed in their order, as [`FuelFlowColumns::total_kg_s`] does it.
    #[must_use]
    pub fn totals_kg_s(&self) -> Cow<'_, [f64]> {
        match self {
            Self::Total(total) => Cow::Borrowed(total),
            Self::PerEngine(engines) => {
                let mut totals = engines.first().cloned().unwrap_or_default();
                for engine in engines.iter().skip(1) {
                    for (total, flow) in totals.iter_mut().zip(engine) {
                        *total += flow;
                    }
                }
                Cow::Owned(totals)
            }
        }
    }

    /// Total fuel flow of one sample, kg/s: the engines summed in their order.
    #[must_use]
    pub fn total_kg_s(&self, sample: usize) -> f64 {
        match self {
            Self::PerEngine(engines) => engines.iter().map(|engine| engine[sample]).sum(),
            Self::Total(total) => total[sample],
        }
    }
}

/// The columns of a report, each of the same length, SI unless the name says otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportColumns {
    /// Time since START, s; strictly increasing.
    pub time_s: Vec<f64>,
    /// Pressure altitude, m.
    pub pressure_altitude_m: Vec<f64>,
    /// Static air temperature, K; absent when declared missing.
    pub static_air_temperature_k: Option<Vec<f64>>,
    /// Mach number.
    pub mach: Vec<f64>,
    /// True airspeed, m/s.
    pub true_airspeed_m_s: Vec<f64>,
    /// Ground speed, m/s.
    pub ground_speed_m_s: Vec<f64>,
    /// Roll angle, degrees; absent when declared missing.
    pub roll_deg: Option<Vec<f64>>,
    /// Drift angle (track minus heading), degrees; absent when declared missing.
    pub drift_deg: Option<Vec<f64>>,
    /// High-pressure rotor speed, %, `[engine][sample]`; absent when declared missing.
    pub n2_percent: Option<Vec<Vec<f64>>>,
    /// Fuel flow.
    pub fuel_flow: FuelFlowColumns,
    /// Fuel used since engine start by all engines, kg.
    pub fuel_used_kg: Vec<f64>,
    /// Columns that a report may lack, each with samples without a value.
    pub optional: OptionalColumns,
}

/// One cruise of one aircraft, as it was sent. Every column has the same length of at least three samples (one, where each
/// is an averaged point), time strictly increases, every number is finite, every sample's mass is positive.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    header: ReportHeader,
    columns: ReportColumns,
}

/// Why header and columns do not make a report.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReportDataError {
    /// Fewer than three samples.
    #[error("{found} samples, at least 3 are needed")]
    TooFewSamples {
        /// Samples found.
        found: usize,
    },
    /// A column of another length than `time_s`.
    #[error("column {column} has {found} samples, time has {expected}")]
    LengthsDiffer {
        /// Field name of the column; its name in files where a report may lack it.
        column: &'static str,
        /// Its length.
        found: usize,
        /// Length of the time column.
        expected: usize,
    },
    /// A number that is not finite.
    #[error("column {column} sample {sample}: {value} is not finite")]
    NotFinite {
        /// Field name of the column; its name in files where a report may lack it.
        column: &'static str,
        /// Sample from 0.
        sample: usize,
        /// The value.
        value: f64,
    },
    /// Time does not strictly increase.
    #[error("sample {sample}: time {time_s} s does not follow {previous_s} s")]
    TimeNotIncreasing {
        /// Sample from 0.
        sample: usize,
        /// Its time.
        time_s: f64,
        /// The time before.
        previous_s: f64,
    },
    /// A column that every report has, among those that it may lack.
    #[error("column {column} is not one that a report may lack")]
    NotOptional {
        /// Name of the column in files.
        column: &'static str,
    },
    /// No engine, more than four, or sets of engines that differ.
    #[error("{found} engines in {column}, expected {expected}")]
    Engines {
        /// Field name of the column.
        column: &'static str,
        /// Engines found.
        found: usize,
        /// What is expected.
        expected: &'static str,
    },
    /// A mass at or below zero.
    #[error("sample {sample}: mass {mass_kg} kg is not positive")]
    MassNotPositive {
        /// Sample from 0.
        sample: usize,
        /// Zero-fuel mass plus fuel on board minus fuel used.
        mass_kg: f64,
    },
}

impl Report {
    /// Combines header and columns into one report.
    ///
    /// # Errors
    /// [`ReportDataError`] when the columns are not consistent with each other. Ranges of single columns are checked by
    /// the reader ([`crate::column::Column::range`]).
    pub fn new(header: ReportHeader, columns: ReportColumns) -> Result<Self, ReportDataError> {
        if columns.time_s.len() < 3 {
            return Err(ReportDataError::TooFewSamples { found: columns.time_s.len() });
        }
        Self::of_points(header, columns)
    }

    /// The same where each row is not a sample but the mean over a stable frame: one is enough.
    ///
    /// # Errors
    /// As [`Report::new`].
    pub fn of_points(
        header: ReportHeader,
        columns: ReportColumns,
    ) -> Result<Self, ReportDataError> {
        check_columns(&columns)?;
        let ramp_mass_kg =
            header.zero_fuel_mass.to_kilograms() + header.fuel_on_board.to_kilograms();
        // Written so that NaN is refused too.
        let is_refused = |fuel_used_kg: &f64| {
            let mass_kg = ramp_mass_kg - fuel_used_kg;
            mass_kg.is_nan() || mass_kg <= 0.0
        };
        if let Some(sample) = columns.fuel_used_kg.iter().position(is_refused) {
            let mass_kg = ramp_mass_kg - columns.fuel_used_kg[sample];
            return Err(ReportDataError::MassNotPositive { sample, mass_kg });
        }
        Ok(Self { header, columns })
    }

    /// The header.
    #[must_use]
    pub const fn header(&self) -> &ReportHeader {
        &self.header
    }

    /// The columns.
    #[must_use]
    pub const fn columns(&self) -> &ReportColumns {
        &self.columns
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.time_s.len()
    }

    /// Always false: a report has at least one sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.columns.time_s.is_empty()
    }

    /// Number of engines recorded separately; `None` where only total fuel flow and no rotor speed is recorded.
    #[must_use]
    pub fn engines(&self) -> Option<usize> {
        match (&self.columns.fuel_flow, &self.columns.n2_percent) {
            (FuelFlowColumns::PerEngine(engines), _)
            | (FuelFlowColumns::Total(_), Some(engines)) => Some(engines.len()),
            (FuelFlowColumns::Total(_), None) => None,
        }
    }

    /// Takes the report apart into header and columns.
    #[must_use]
    pub fn into_parts(self) -> (ReportHeader, ReportColumns) {
        (self.header, self.columns)
    }
}

fn check_columns(columns: &ReportColumns) -> Result<(), ReportDataError> {
    // Field by field, so that the compiler names a new one that is not checked.
    let ReportColumns {
        time_s,
        pressure_altitude_m,
        static_air_temperature_k,
        mach,
        true_airspeed_m_s,
        ground_speed_m_s,
        roll_deg,
        drift_deg,
        n2_percent,
        fuel_flow,
        fuel_used_kg,
        optional,
    } = columns;
    let samples = time_s.len();
    if samples == 0 {
        return Err(ReportDataError::TooFewSamples { found: samples });
    }
    check_full("time_s", time_s, samples)?;
    for (sample, pair) in time_s.windows(2).enumerate() {
        if pair[1] <= pair[0] {
            return Err(ReportDataError::TimeNotIncreasing {
                sample: sample + 1,
                time_s: pair[1],
                previous_s: pair[0],
            });
        }
    }
    check_full("pressure_altitude_m", pressure_altitude_m, samples)?;
    check_full("mach", mach, samples)?;
    check_full("true_airspeed_m_s", true_airspeed_m_s, samples)?;
    check_full("ground_speed_m_s", ground_speed_m_s, samples)?;
    check_full("fuel_used_kg", fuel_used_kg, samples)?;
    for (name, column) in [
        ("static_air_temperature_k", static_air_temperature_k),
        ("roll_deg", roll_deg),
        ("drift_deg", drift_deg),
    ] {
        if let Some(values) = column {
            check_full(name, values, samples)?;
        }
    }
    check_engines(fuel_flow, n2_percent.as_deref(), samples)?;
    for (column, values) in optional.iter() {
        check_optional(column, values, samples)?;
    }
    Ok(())
}

fn check_engines(
    fuel_flow: &FuelFlowColumns,
    n2_percent: Option<&[Vec<f64>]>,
    samples: usize,
) -> Result<(), ReportDataError> {
    let one_to_four = "1 to 4";
    match fuel_flow {
        FuelFlowColumns::Total(total) => check_full("fuel_flow", total, samples)?,
        FuelFlowColumns::PerEngine(engines) => {
            if !(1..=MAXIMUM_ENGINES).contains(&engines.len()) {
                return Err(ReportDataError::Engines {
                    column: "fuel_flow",
                    found: engines.len(),
                    expected: one_to_four,
                });
            }
            for engine in engines {
                check_full("fuel_flow", engine, samples)?;
            }
        }
    }
    if let Some(engines) = n2_percent {
        if !(1..=MAXIMUM_ENGINES).contains(&engines.len()) {
            return Err(ReportDataError::Engines {
                column: "n2_percent",
                found: engines.len(),
                expected: one_to_four,
            });
        }
        if let FuelFlowColumns::PerEngine(flows) = fuel_flow
            && flows.len() != engines.len()
        {
            return Err(ReportDataError::Engines {
                column: "n2_percent",
                found: engines.len(),
                expected: "as many as in fuel_flow",
            });
        }
        for engine in engines {
            check_full("n2_percent", engine, samples)?;
        }
    }
    Ok(())
}

fn check_full(
    column: &'static str,
    values: &[f64],
    expected: usize,
) -> Result<(), ReportDataError> {
    if values.len() != expected {
        return Err(ReportDataError::LengthsDiffer { column, found: values.len(), expected });
    }
    // All of them together first: without a way out of the loop, several values are looked at in one instruction.
    if values.iter().fold(true, |finite, value| finite & value.is_finite()) {
        return Ok(());
    }
    match values.iter().position(|value| !value.is_finite()) {
        Some(sample) => Err(ReportDataError::NotFinite { column, sample, value: values[sample] }),
        None => Ok(()),
    }
}

fn check_optional(
    column: Column,
    values: &OptionalColumn,
    expected: usize,
) -> Result<(), ReportDataError> {
    if !column.is_optional() {
        return Err(ReportDataError::NotOptional { column: column.stem() });
    }
    if let Some(engine) = column.engine().map(usize::from)
        && !(1..=MAXIMUM_ENGINES).contains(&engine)
    {
        let column = column.stem();
        return Err(ReportDataError::Engines { column, found: engine, expected: "1 to 4" });
    }
    if values.len() != expected {
        let column = column.stem();
        return Err(ReportDataError::LengthsDiffer { column, found: values.len(), expected });
    }
    for (sample, value) in values.iter().enumerate() {
        if let Some(value) = value.filter(|value| !value.is_finite()) {
            return Err(ReportDataError::NotFinite { column: column.stem(), sample, value });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
