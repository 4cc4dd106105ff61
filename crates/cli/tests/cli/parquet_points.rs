//! Flight points in Parquet: predicted column by column, to the bytes of the same points as text.

use std::path::Path;
use std::sync::Arc;

use parquet::data_type::DoubleType;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use crate::support::{Ran, cruisefit, initial_model};

const NAMES: [&str; 4] = ["weight_lb", "pressure_altitude_ft", "mach", "fuel_flow_lb_h"];

/// Writes rows of [`NAMES`]; a column in which a value lacks is optional, and each half is a row group of its own.
fn write(path: &Path, rows: &[[Option<f64>; 4]]) {
    let fields: Vec<String> = NAMES
        .iter()
        .enumerate()
        .map(|(column, name)| {
            let lacks = rows.iter().any(|row| row[column].is_none());
            format!("{} DOUBLE {name}; ", if lacks { "OPTIONAL" } else { "REQUIRED" })
        })
        .collect();
    let schema = parse_message_type(&format!("message points {{ {} }}", fields.concat())).unwrap();
    let file = std::fs::File::create(path).unwrap();
    let mut writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::default()).unwrap();
    for rows in rows.chunks(rows.len().div_ceil(2)) {
        let mut group = writer.next_row_group().unwrap();
        for column in 0..NAMES.len() {
            let values: Vec<f64> = rows.iter().filter_map(|row| row[column]).collect();
            let levels: Vec<i16> =
                rows.iter().map(|row| i16::from(row[column].is_some())).collect();
            let mut of = group.next_column().unwrap().unwrap();
            of.typed::<DoubleType>().write_batch(&values, Some(&levels), None).unwrap();
            of.close().unwrap();
        }
        group.close().unwrap();
    }
    writer.close().unwrap();
}

fn predict(model: &Path, points: &Path) -> Ran {
    cruisefit(&["predict".as_ref(), "--model".as_ref(), model.as_os_str(), points.as_os_str()])
}

#[test]
fn points_in_parquet_are_predicted_as_those_in_text() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let rows: Vec<[Option<f64>; 4]> = (0..9)
        .map(|row| {
            let step = f64::from(row);
            // At the fifth point nothing was measured; the last is outside the table.
            let measured = (row != 4).then_some(1_500.0 + step);
            let mach = if row == 8 { 0.98 } else { 0.78 + 0.005 * step };
            [Some(68_000.0 + 500.0 * step), Some(41_000.0), Some(mach), measured]
        })
        .collect();
    let (parquet, text) =
        (scratch.path().join("points.parquet"), scratch.path().join("points.csv"));
    write(&parquet, &rows);
    let lines = rows.iter().map(|row| {
        row.map(|cell| cell.map_or_else(String::new, |value| value.to_string())).join(",")
    });
    let lines: Vec<String> = lines.collect();
    std::fs::write(&text, format!("{}\n{}\n", NAMES.join(","), lines.join("\n"))).unwrap();
    let (by_column, by_row) =
        (predict(&model, &parquet).expect(1), predict(&model, &text).expect(1));
    by_column.says("points.parquet:10: ");
    by_row.says("points.csv:10: ");
    assert_eq!(by_row.stdout.lines().count(), 10, "{}", by_row.stdout);
    assert_eq!(by_column.stdout, by_row.stdout);
}

#[test]
fn a_value_that_lacks_is_named_by_its_row() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let parquet = scratch.path().join("points.parquet");
    let row = |mach| [Some(68_000.0), Some(41_000.0), mach, Some(1_500.0)];
    write(&parquet, &[row(Some(0.8)), row(None), row(Some(0.8))]);
    let ran = predict(&model, &parquet).expect(2);
    ran.says("points.parquet: line 3, column 3 (mach): found \"\", expected a number");
    // No line of a packed file is shown.
    assert!(!ran.stderr.contains("PAR1"), "{}", ran.stderr);
}
