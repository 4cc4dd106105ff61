//! From checked rows to a report.

use flight::column::Column;
use flight::{
    FuelFlowColumns, OptionalColumns, Report, ReportColumns, ReportDataError, ReportHeader,
};

use super::columns::Field;
use crate::line::Lines;
use crate::refusal::{Found, Refusal, RefusalKind};

/// The report of these rows; `values` holds them one after the other, a number per field, in the units of the file.
pub(super) fn report(
    header: ReportHeader,
    fields: &[Field],
    engines: Option<u8>,
    values: &[f64],
) -> Result<Report, ReportDataError> {
    let table = Table { fields, values };
    let engine_count = engines.unwrap_or(0);
    let n2_percent: Vec<_> =
        (1..=engine_count).map_while(|engine| table.required(Column::N2(engine))).collect();
    let flows: Vec<_> = (1..=engine_count)
        .map_while(|engine| table.required(Column::FuelFlowEngine(engine)))
        .collect();
    let columns = ReportColumns {
        time_s: table.present(Column::Time),
        pressure_altitude_m: table.present(Column::PressureAltitude),
        static_air_temperature_k: table.required(Column::StaticAirTemperature),
        mach: table.present(Column::Mach),
        true_airspeed_m_s: table.present(Column::TrueAirspeed),
        ground_speed_m_s: table.present(Column::GroundSpeed),
        roll_deg: table.required(Column::Roll),
        drift_deg: table.required(Column::Drift),
        n2_percent: (!n2_percent.is_empty()).then_some(n2_percent),
        fuel_flow: if flows.is_empty() {
            FuelFlowColumns::Total(table.present(Column::FuelFlowTotal))
        } else {
            FuelFlowColumns::PerEngine(flows)
        },
        fuel_used_kg: table.present(Column::FuelUsed),
        optional: table.optional(),
    };
    Report::new(header, columns)
}

/// Position of data that do not make a report. The reader's own checks leave hardly anything to refuse here: masses
/// that vanish within rounding.
pub(super) fn refusal(error: ReportDataError, mut lines: Lines<'_>) -> Refusal {
    let (sample, found, kind) = match error {
        ReportDataError::MassNotPositive { sample, mass_kg } => (
            sample,
            Found::Number { value: mass_kg, unit: "kg" },
            RefusalKind::MassNotPositive { mass: "gross mass" },
        ),
        ReportDataError::NotFinite { sample, value, .. } => {
            (sample, Found::Number { value, unit: "SI" }, RefusalKind::Inconsistent(error))
        }
        other => (0, Found::EndOfLine, RefusalKind::Inconsistent(other)),
    };
    for _ in 0..sample {
        lines.next_of_meaning();
    }
    match lines.next_of_meaning() {
        Some(line) => line.refuse(line.meaning().offset, found, kind),
        None => lines.refuse_end(found, kind),
    }
}

struct Table<'a> {
    fields: &'a [Field],
    values: &'a [f64],
}

impl Table<'_> {
    /// The column in its stored unit; empty where it is absent, which the check of names has excluded.
    fn present(&self, column: Column) -> Vec<f64> {
        self.required(column).unwrap_or_default()
    }

    fn required(&self, column: Column) -> Option<Vec<f64>> {
        Some(self.column(column)?.collect())
    }

    /// Every column that a report may lack, of those that are there.
    fn optional(&self) -> OptionalColumns {
        let named = self.fields.iter().enumerate().filter_map(|(index, field)| {
            let column = field.column.filter(|column| column.is_optional())?;
            let available = |value: &f64| (!value.is_nan()).then(|| field.convert(*value));
            field.is_handed_on.then(|| (column, self.of_field(index).map(available).collect()))
        });
        named.collect()
    }

    fn column(&self, column: Column) -> Option<impl ExactSizeIterator<Item = f64>> {
        let index = self
            .fields
            .iter()
            .position(|field| field.column == Some(column) && field.is_handed_on)?;
        let field = self.fields[index];
        Some(self.of_field(index).map(move |value| field.convert(*value)))
    }

    /// The values of one field, in the unit of the file.
    fn of_field(&self, index: usize) -> impl ExactSizeIterator<Item = &f64> {
        // Faster than stepping: it is known of a row how long it is.
        self.values.chunks_exact(self.fields.len()).map(move |row| &row[index])
    }
}
