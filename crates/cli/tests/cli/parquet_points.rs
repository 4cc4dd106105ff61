//! Flight points in Parquet: predicted column by column, to the bytes of the same points as text.

use std::path::Path;
use std::sync::Arc;

use parquet::data_type::{
    BoolType, ByteArrayType, DataType, DoubleType, FixedLenByteArray, FixedLenByteArrayType,
    FloatType, Int32Type, Int64Type,
};
use parquet::file::metadata::KeyValue;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::record::Field;
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
fn a_value_that_lacks_costs_its_row() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let parquet = scratch.path().join("points.parquet");
    let row = |mach| [Some(68_000.0), Some(41_000.0), mach, Some(1_500.0)];
    write(&parquet, &[row(Some(0.8)), row(None), row(Some(0.8))]);
    let ran = predict(&model, &parquet).expect(1);
    ran.says("points.parquet:3: mach: no value");
    let lines: Vec<&str> = ran.stdout.lines().collect();
    assert!(lines[2].ends_with(",,,,,,,"), "{}", lines[2]);
    assert_eq!(lines[1], lines[3]);
    // No line of a packed file is shown.
    assert!(!ran.stderr.contains("PAR1"), "{}", ran.stderr);
    write(&parquet, &[row(Some(0.8)), row(Some(78.0)), row(None)]);
    let refused = predict(&model, &parquet).expect(2);
    refused.says("points.parquet: line 3, column 3 (mach): found \"78\"");
}

/// A table in which no fuel flow is measured has the column of errors where it could have been.
#[test]
fn columns_do_not_depend_on_values() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let names = |points: &Path, more: &[&str]| {
        let given = ["predict", "--model"].map(AsRef::as_ref);
        let paths = [model.as_os_str(), points.as_os_str()];
        let more = more.iter().map(AsRef::as_ref);
        let all: Vec<&std::ffi::OsStr> = given.into_iter().chain(paths).chain(more).collect();
        let ran = cruisefit(&all).expect(0);
        ran.stdout.lines().next().unwrap().to_owned()
    };
    let row = |measured| [Some(68_000.0), Some(41_000.0), Some(0.8), measured];
    let (with, without) =
        (scratch.path().join("with.parquet"), scratch.path().join("without.parquet"));
    write(&with, &[row(Some(1_500.0)), row(None)]);
    write(&without, &[row(None), row(None)]);
    assert!(names(&with, &[]).contains("error_percent"));
    assert_eq!(names(&with, &[]), names(&without, &[]));
    let text = scratch.path().join("points.csv");
    std::fs::write(&text, "mass_kg,pressure_altitude_ft,mach\n30000,41000,0.8\n").unwrap();
    let asked = names(&text, &["--columns", "error_percent"]);
    assert_eq!(asked, "mass_kg,pressure_altitude_ft,mach,error_percent");
}

/// What comes in goes out with type and value. Oracle: what was written.
#[test]
fn columns_of_any_type_go_out_as_they_came() {
    const SCHEMA: &str = "message points {
        required int32 mass_kg; optional int64 pressure_altitude_ft; required float mach;
        optional int64 X-id; optional binary X-name (UTF8); optional boolean X-flag; optional int32 X-day (DATE);
        optional int64 X-instant (TIMESTAMP(MICROS, true)); optional fixed_len_byte_array(5) X-price (DECIMAL(10, 2));
        optional group X-list (LIST) { repeated group list { optional int64 element; } }
    }";
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let (given, written) =
        (scratch.path().join("points.parquet"), scratch.path().join("out.parquet"));
    let schema = Arc::new(parse_message_type(SCHEMA).unwrap());
    let file = std::fs::File::create(&given).unwrap();
    let mut writer = SerializedFileWriter::new(file, schema, Arc::default()).unwrap();
    // Two groups; in the second all that may lack lacks.
    for levels in [[1_i16, 1], [1, 0]] {
        let mut group = writer.next_row_group().unwrap();
        write_column::<Int32Type>(&mut group, &[30_000, 31_000], &[1, 1]);
        write_column::<Int64Type>(&mut group, &[41_000, 39_000], &[1, 1]);
        write_column::<FloatType>(&mut group, &[0.78, 0.8], &[1, 1]);
        write_column::<Int64Type>(&mut group, &[(1 << 60) + 1, -(1 << 60) - 3], &levels);
        write_column::<ByteArrayType>(&mut group, &["=1".into(), "b".into()], &levels);
        write_column::<BoolType>(&mut group, &[true, false], &levels);
        write_column::<Int32Type>(&mut group, &[17_897, -1], &levels);
        write_column::<Int64Type>(&mut group, &[1_577_934_245_000_678, 0], &levels);
        let price = |bytes: [u8; 5]| FixedLenByteArray::from(bytes.to_vec());
        let prices = [price([0, 0, 0, 0, 10]), price([0xff, 0xff, 0xff, 0xff, 0x85])];
        write_column::<FixedLenByteArrayType>(&mut group, &prices, &levels);
        let mut list = group.next_column().unwrap().unwrap();
        let definition = [3, 3, levels[1]];
        list.typed::<Int64Type>()
            .write_batch(&[7, 8], Some(&definition), Some(&[0, 1, 0]))
            .unwrap();
        list.close().unwrap();
        group.close().unwrap();
    }
    writer.close().unwrap();
    let arguments: [&std::ffi::OsStr; 6] = [
        "predict".as_ref(),
        "--model".as_ref(),
        model.as_ref(),
        given.as_ref(),
        "-o".as_ref(),
        written.as_ref(),
    ];
    cruisefit(&arguments).expect(0);
    let read = |path: &Path| SerializedFileReader::new(std::fs::File::open(path).unwrap()).unwrap();
    let (before, after) = (read(&given), read(&written));
    let fields = |reader: &SerializedFileReader<std::fs::File>| {
        reader.metadata().file_metadata().schema().get_fields().to_vec()
    };
    let (came, went) = (fields(&before), fields(&after));
    assert_eq!(went[..came.len()], came[..]);
    assert_eq!(went[came.len()].name(), "fuel_flow_kg_s");
    let rows = |reader: &SerializedFileReader<std::fs::File>| {
        let rows = reader.get_row_iter(None).unwrap().map(Result::unwrap);
        let fields = rows.map(|row| row.get_column_iter().map(|(_, it)| it.clone()).collect());
        fields.collect::<Vec<Vec<Field>>>()
    };
    for (came, went) in rows(&before).iter().zip(rows(&after)) {
        assert_eq!(went[..came.len()], came[..]);
        assert!(matches!(went[came.len()], Field::Double(flow) if flow > 0.0));
    }
    assert_eq!(rows(&after).len(), 4);
    // As text every digit is kept too; a list is no cell, and that is said.
    let text = predict(&model, &given).expect(0);
    text.says("column X-list.list.element: of a type that is not read, left empty");
    assert!(text.stdout.contains("1152921504606846977"), "{}", text.stdout);
    assert!(text.stdout.contains(",-1.23,"), "{}", text.stdout);
}

fn write_column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, std::fs::File>,
    values: &[T::T],
    levels: &[i16],
) {
    let mut column = group.next_column().unwrap().unwrap();
    let present: Vec<T::T> = values
        .iter()
        .zip(levels)
        .filter(|(_, level)| **level > 0)
        .map(|(v, _)| v.clone())
        .collect();
    column.typed::<T>().write_batch(&present, Some(levels), None).unwrap();
    column.close().unwrap();
}

/// A table of a prediction given again: its columns are replaced, in Parquet as numbers, and once more make the same bytes.
#[test]
fn a_prediction_given_again_is_replaced() {
    let scratch = tempfile::tempdir().unwrap();
    let model = initial_model(scratch.path());
    let row = |mach| [Some(68_000.0), Some(41_000.0), Some(mach), Some(1_500.0)];
    let at = |name: &str| scratch.path().join(name);
    write(&at("points.parquet"), &[row(0.8), row(0.82)]);
    let predict = |from: &str, to: &str| {
        let (from, to) = (at(from), at(to));
        let words = ["predict".as_ref(), "--model".as_ref(), model.as_os_str(), from.as_os_str()];
        cruisefit(&[&words[..], &["-o".as_ref(), to.as_os_str()]].concat()).expect(0)
    };
    for ending in ["csv", "parquet"] {
        let (once, twice) = (format!("once.{ending}"), format!("twice.{ending}"));
        let first = predict("points.parquet", &once);
        assert!(!first.stderr.contains("replaced"), "{}", first.stderr);
        predict(&once, &twice)
            .says("columns of a prediction are not read, and replaced: fuel_flow_kg_s");
        let csv = |name: &str| {
            predict(name, "read.csv").stdout + &std::fs::read_to_string(at("read.csv")).unwrap()
        };
        assert_eq!(csv(&once), csv(&twice));
    }
}

/// Oracle: the schema is what pyarrow 22 writes for a duration[ms] beside a number. Its counts were taken for seconds.
#[test]
fn a_column_of_durations_is_not_read_as_numbers() {
    const OF_ARROW: &str = "/////6gAAAAQAAAAAAAKAAwABgAFAAgACgAAAAABBAAMAAAACAAIAAAABAAIAAAABAAAAAIAAABIAAAABAAAAND///8AAAEDEAAAABwAAAAEAAAAAAAAAAMAAABhbHQAAAAGAAgABgAGAAAAAAACABAAFAAIAAYABwAMAAAAEAAQAAAAAAABEhAAAAAcAAAABAAAAAAAAAAEAAAAVElNRQAAAAAEAAQABAAAAAAAAAA=";
    const MAPPING: &str = r#"(format: 1, aircraft: Text("A320"), tail: Text("T"), flight: Text("1"),
        time: Seconds(column: "TIME", start: "2024-03-01T10:00:00Z"),
        quantities: {
            "ALT": Recorded(column: "alt", unit: "ft"), "SAT": Isa(deviation_k: 0),
            "MACH": Recorded(column: "mach", unit: "-"), "VTAS": FromMach,
            "GSPD": Recorded(column: "gs", unit: "kt"), "WF": Recorded(column: "ff", unit: "kg/h"),
        },
        mass: StartMass(gross_weight: Value(65000, "kg")))"#;
    const SCHEMA: &str =
        "message recording { required int64 TIME; required double alt; required double mach;
        required double gs; required double ff; }";
    let scratch = tempfile::tempdir().unwrap();
    let [recording, mapping] = ["R.parquet", "M.ron"].map(|name| scratch.path().join(name));
    std::fs::write(&mapping, MAPPING).unwrap();
    let write = |schema: Option<&str>| {
        let file = std::fs::File::create(&recording).unwrap();
        let message = Arc::new(parse_message_type(SCHEMA).unwrap());
        let mut writer = SerializedFileWriter::new(file, message, Arc::default()).unwrap();
        if let Some(schema) = schema {
            let pair = KeyValue::new("ARROW:schema".to_owned(), schema.to_owned());
            writer.append_key_value_metadata(pair);
        }
        let mut group = writer.next_row_group().unwrap();
        let times: Vec<i64> = (0..120).map(|row| 10 * row).collect();
        let mut of = group.next_column().unwrap().unwrap();
        of.typed::<Int64Type>().write_batch(&times, None, None).unwrap();
        of.close().unwrap();
        for value in [35_000.0, 0.78, 450.0, 2400.0] {
            let mut of = group.next_column().unwrap().unwrap();
            of.typed::<DoubleType>().write_batch(&[value; 120], None, None).unwrap();
            of.close().unwrap();
        }
        group.close().unwrap();
        writer.close().unwrap();
    };
    let read = || {
        cruisefit(&[
            "segment".as_ref(),
            recording.as_os_str(),
            "--mapping".as_ref(),
            mapping.as_os_str(),
        ])
    };
    write(None);
    read().expect(0);
    write(Some(OF_ARROW));
    read().expect(2).says("column \"TIME\" is of a type that is not read");
}
