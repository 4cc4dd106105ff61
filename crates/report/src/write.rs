//! Reports into the text of format 1.

use flight::column::Column;
use flight::{Assumption, FuelFlowColumns, Report, ReportColumns, ReportHeader};

use crate::cruise_text::{FORMAT_NAME, FORMAT_VERSION, Reader};
use crate::refusal::Refusal;
use crate::text_layout::TextLayout;

/// Why a report cannot be written so that reading restores it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The format, or rounding to the layout's decimals, does not allow what the report holds.
    #[error("the text would be refused")]
    Refused(#[from] Refusal),
    /// A header value that the text form does not preserve: blanks at an end, a line end, `#` after a blank, a note
    /// whose key has another meaning.
    #[error("the value of {key} in the header does not survive the text form")]
    HeaderNotKept {
        /// The header key; `note` for one of the notes.
        key: &'static str,
    },
    /// A column that the header declares missing.
    #[error("the header declares a column missing that the report has")]
    ColumnDeclaredMissing,
}

/// Writes `report` as format-1 text, with `comments` as comment lines below the first line.
///
/// The same report, layout and comments give the same bytes. The text is read back before it is returned: [`Reader`]
/// accepts what this function returns, with the same header texts and with numbers that differ only by rounding to the
/// layout's decimals.
///
/// # Errors
/// [`WriteError`] when the text form cannot hold the report.
pub fn write(
    report: &Report,
    layout: &TextLayout,
    comments: &[&str],
) -> Result<String, WriteError> {
    let columns = columns_of(report);
    let mut text = format!("{FORMAT_NAME} {FORMAT_VERSION}\n");
    for line in comments.iter().flat_map(|comment| comment.lines()) {
        text.push_str(format!("# {line}").trim_end());
        text.push('\n');
    }
    append_header(report.header(), layout, &mut text);
    append_line(&columns, &mut text, |(column, _), text| text.push_str(&column.name()));
    append_line(&columns, &mut text, |(column, _), text| text.push_str(layout.unit(*column)));
    for sample in 0..report.len() {
        append_line(&columns, &mut text, |(column, values), text| match values.at(sample) {
            Some(value) => layout.append(*column, value, text),
            None => text.push('-'),
        });
    }
    check_reads_back(report.header(), &text)?;
    Ok(text)
}

#[derive(Clone, Copy)]
enum Values<'a> {
    All(&'a [f64]),
    Some(&'a [Option<f64>]),
}

impl Values<'_> {
    fn at(self, sample: usize) -> Option<f64> {
        match self {
            Self::All(values) => Some(values[sample]),
            Self::Some(values) => values[sample],
        }
    }
}

/// The columns that the report has, in the order of the format's sample.
fn columns_of(report: &Report) -> Vec<(Column, Values<'_>)> {
    // Field by field, so that the compiler names a new one that is not written.
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
    } = report.columns();
    let mut columns = Vec::new();
    let mut all = |column, values| columns.push((column, Values::All(values)));
    all(Column::Time, time_s);
    all(Column::PressureAltitude, pressure_altitude_m);
    if let Some(values) = static_air_temperature_k {
        all(Column::StaticAirTemperature, values);
    }
    all(Column::Mach, mach);
    all(Column::TrueAirspeed, true_airspeed_m_s);
    all(Column::GroundSpeed, ground_speed_m_s);
    if let Some(values) = roll_deg {
        all(Column::Roll, values);
    }
    if let Some(values) = drift_deg {
        all(Column::Drift, values);
    }
    for (engine, values) in (1..).zip(n2_percent.iter().flatten()) {
        all(Column::N2(engine), values);
    }
    match fuel_flow {
        FuelFlowColumns::Total(values) => all(Column::FuelFlowTotal, values),
        FuelFlowColumns::PerEngine(engines) => {
            for (engine, values) in (1..).zip(engines) {
                all(Column::FuelFlowEngine(engine), values);
            }
        }
    }
    all(Column::FuelUsed, fuel_used_kg);
    columns.extend(optional.iter().map(|(column, values)| (column, Values::Some(values))));
    columns
}

fn append_line<T>(words: &[T], text: &mut String, append: impl Fn(&T, &mut String)) {
    for (index, word) in words.iter().enumerate() {
        if index > 0 {
            text.push(' ');
        }
        append(word, text);
    }
    text.push('\n');
}

fn append_header(header: &ReportHeader, layout: &TextLayout, text: &mut String) {
    let mut line = |key: &str, value: &str| {
        text.push_str(format!("{key:<8} {value}").trim_end());
        text.push('\n');
    };
    // The masses as fuel used, which must not exceed them after rounding.
    let mass = |mass: units::Mass| {
        let mut value = String::new();
        layout.append(Column::FuelUsed, mass.to_kilograms(), &mut value);
        format!("{value} {}", layout.unit(Column::FuelUsed))
    };
    line("AIRCRAFT", &header.aircraft_type);
    line("TAIL", &header.identity.tail);
    line("FLIGHT", &header.identity.flight);
    line("START", &header.identity.start.to_string());
    line("ZFW", &mass(header.zero_fuel_mass));
    line("FOB", &mass(header.fuel_on_board));
    if let Some(heat) = header.lower_heating_value_mj_kg {
        line("LHV", &format!("{heat} MJ/kg"));
    }
    if !header.missing.is_empty() {
        let names: Vec<_> = header.missing.iter().map(|column| column.name()).collect();
        line("MISSING", &names.join(" "));
    }
    if !header.assumed.is_empty() {
        let assumed: Vec<_> = header.assumed.iter().map(assumption_text).collect();
        line("ASSUMED", &assumed.join(" "));
    }
    for (key, value) in &header.notes {
        line(key, value);
    }
}

fn assumption_text(assumption: &Assumption) -> String {
    match assumption {
        Assumption::StaticAirTemperatureIsa { isa_deviation_k } if *isa_deviation_k == 0.0 => {
            "SAT=ISA".to_owned()
        }
        Assumption::StaticAirTemperatureIsa { isa_deviation_k } => {
            format!("SAT=ISA{isa_deviation_k:+}")
        }
        Assumption::Other { key, value } => format!("{key}={value}"),
    }
}

fn check_reads_back(meant: &ReportHeader, text: &str) -> Result<(), WriteError> {
    let parsed = Reader::new().read(text.as_bytes())?;
    if parsed.findings.iter().any(|finding| finding.code == "column-declared-missing") {
        return Err(WriteError::ColumnDeclaredMissing);
    }
    let read = parsed.report.header();
    let mut missing = meant.missing.clone();
    missing.sort_unstable();
    let kept = [
        ("AIRCRAFT", read.aircraft_type == meant.aircraft_type),
        ("TAIL", read.identity.tail == meant.identity.tail),
        ("FLIGHT", read.identity.flight == meant.identity.flight),
        ("START", read.identity.start == meant.identity.start),
        ("LHV", read.lower_heating_value_mj_kg == meant.lower_heating_value_mj_kg),
        ("MISSING", read.missing == missing),
        ("ASSUMED", read.assumed == meant.assumed),
        ("note", read.notes == meant.notes),
    ];
    match kept.into_iter().find(|(_, is_kept)| !is_kept) {
        Some((key, _)) => Err(WriteError::HeaderNotKept { key }),
        None => Ok(()),
    }
}
