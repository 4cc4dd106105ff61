//! `cruisefit mapping` and `convert`: from a recording of another layout to reports, without writing a mapping by hand.

use std::path::{Path, PathBuf};

use crate::support::{cruisefit, root};

fn layout(name: &str) -> PathBuf {
    root().join("fixtures/layouts").join(name)
}

fn mapping_of(recording: &Path, mapping: &Path) {
    let made =
        cruisefit(&["mapping".as_ref(), recording.as_os_str(), "-o".as_ref(), mapping.as_os_str()]);
    made.expect(0).says("it reads 1 flight with");
}

/// The same where the flight is not called as its file.
fn mapping_of_flight(recording: &Path, mapping: &Path, flight: &str) {
    mapping_of(recording, mapping);
    let written = std::fs::read_to_string(mapping).unwrap();
    std::fs::write(mapping, written.replace("FileName", flight)).unwrap();
}

/// Segments of what these arguments read.
fn segments(arguments: &[&std::ffi::OsStr]) -> String {
    let mut all: Vec<&std::ffi::OsStr> = vec!["segment".as_ref()];
    all.extend(arguments);
    cruisefit(&all).expect(0).stdout
}

#[test]
fn converted_reports_hold_what_the_mapping_reads() {
    for name in ["02_sparse_qar.csv", "03_european.csv", "04_units_row.csv", "11_unicode_text.txt"]
    {
        let folder = tempfile::tempdir().unwrap();
        let (mapping, reports) = (folder.path().join("M.ron"), folder.path().join("reports"));
        let recording = layout(name);
        mapping_of(&recording, &mapping);
        let convert = [
            "convert".as_ref(),
            "--mapping".as_ref(),
            mapping.as_os_str(),
            recording.as_os_str(),
            "-o".as_ref(),
            reports.as_os_str(),
        ];
        cruisefit(&convert).expect(0);
        let directly = ["--mapping".as_ref(), mapping.as_os_str(), recording.as_os_str()];
        let direct = segments(&directly);
        assert!(direct.lines().count() > 1, "{name}: {direct}");
        assert_eq!(direct, segments(&[reports.as_os_str()]), "{name}");
        // Written again it is the same; what somebody changed is not lost.
        cruisefit(&convert).expect(0);
        let report = std::fs::read_dir(&reports).unwrap().next().unwrap().unwrap().path();
        std::fs::write(&report, "mine").unwrap();
        cruisefit(&convert).expect(2).says("--force");
        assert_eq!(std::fs::read_to_string(&report).unwrap(), "mine");
    }
}

#[test]
fn a_dry_run_shows_what_each_column_became_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mapping = folder.path().join("M.ron");
    let recording = layout("04_units_row.csv");
    mapping_of(&recording, &mapping);
    let shown = cruisefit(&[
        "convert".as_ref(),
        "--dry-run".as_ref(),
        "--mapping".as_ref(),
        mapping.as_os_str(),
        recording.as_os_str(),
    ])
    .expect(0)
    .stdout;
    // 2639 lb/h of each engine in the recording; a report has pounds too.
    assert!(shown.contains("CRUISE-REPORT 1"), "{shown}");
    assert!(shown.contains("WF(1) WF(2)"), "{shown}");
    assert!(shown.contains("nothing written"), "{shown}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_file_that_is_no_table_gets_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("NOTES.csv");
    std::fs::write(&path, b"\x00\x01\x02").unwrap();
    cruisefit(&["mapping".as_ref(), path.as_os_str()]).expect(2);
    let mine = folder.path().join("M.ron");
    std::fs::write(&mine, "mine").unwrap();
    let recording = layout("01_named_units.csv");
    let over = ["mapping".as_ref(), recording.as_os_str(), "-o".as_ref(), mine.as_os_str()];
    cruisefit(&over).expect(2).says("--force");
}

/// Oracle: pyarrow, which wrote the files (`fixtures/layouts/make_parquet.py`).
#[test]
fn parquet_is_read_as_the_text_it_was_made_of() {
    let folder = tempfile::tempdir().unwrap();
    let mapping = folder.path().join("M.ron");
    let text = layout("01_named_units.csv");
    mapping_of(&text, &mapping);
    let without_flight = |table: String| {
        // The flight is the name of the file.
        let lines = table.lines().map(|line| {
            let fields: Vec<&str> = line
                .split(',')
                .enumerate()
                .filter(|(k, _)| *k != 1)
                .map(|(_, field)| field)
                .collect();
            fields.join(",")
        });
        lines.collect::<Vec<_>>().join("\n")
    };
    let read =
        |path: &Path| segments(&["--mapping".as_ref(), mapping.as_os_str(), path.as_os_str()]);
    let expected = without_flight(read(&text));
    assert!(expected.lines().count() > 1);
    for codec in ["none", "snappy", "gzip", "brotli", "lz4", "zstd"] {
        let path = layout(&format!("13_{codec}.parquet"));
        assert_eq!(without_flight(read(&path)), expected, "{codec}");
        mapping_of(&path, &folder.path().join(format!("{codec}.ron")));
    }
    // A recording without a mapping gets a reason.
    cruisefit(&["segment".as_ref(), layout("13_snappy.parquet").as_os_str()]).expect(2);
}

/// Oracle: pyarrow and polars, which wrote the files: three codecs in file and stream, texts as dictionary and as views, beside
/// columns of types that are not read.
#[test]
fn arrow_is_read_as_the_text_it_was_made_of() {
    let folder = tempfile::tempdir().unwrap();
    let mapping = folder.path().join("M.ron");
    let text = layout("01_named_units.csv");
    mapping_of_flight(&text, &mapping, "Text(\"F\")");
    let read =
        |path: &Path| segments(&["--mapping".as_ref(), mapping.as_os_str(), path.as_os_str()]);
    let expected = read(&text);
    assert!(expected.lines().count() > 1);
    for name in
        ["14_none.arrow", "14_lz4.arrow", "14_zstd.arrow", "14_stream.arrows", "14_views.arrow"]
    {
        assert_eq!(read(&layout(name)), expected, "{name}");
        // Columns that are not used are listed, and not every file has the same.
        mapping_of(&layout(name), &folder.path().join(format!("{name}.ron")));
    }
    // A column that is not read is named where it is asked for; a file that breaks off says so.
    let lists = folder.path().join("lists.ron");
    let asked = std::fs::read_to_string(&mapping).unwrap().replace("\"mach\"", "\"lists\"");
    std::fs::write(&lists, asked).unwrap();
    let arrow = layout("14_none.arrow");
    cruisefit(&["segment".as_ref(), "--mapping".as_ref(), lists.as_os_str(), arrow.as_os_str()])
        .expect(2)
        .says("column \"lists\" is of a type that is not read");
    let cut = folder.path().join("cut.arrow");
    let bytes = std::fs::read(&arrow).unwrap();
    for length in [9, 100, 2000, bytes.len() / 2] {
        std::fs::write(&cut, &bytes[..length]).unwrap();
        cruisefit(&[
            "segment".as_ref(),
            "--mapping".as_ref(),
            mapping.as_os_str(),
            cut.as_os_str(),
        ])
        .expect(2);
    }
}

/// Oracle: the same recording not packed.
#[test]
fn a_packed_recording_is_read_as_it_is_unpacked() {
    let folder = tempfile::tempdir().unwrap();
    let mapping = folder.path().join("M.ron");
    let text = layout("01_named_units.csv");
    mapping_of_flight(&text, &mapping, "Text(\"F\")");
    let read =
        |path: &Path| segments(&["--mapping".as_ref(), mapping.as_os_str(), path.as_os_str()]);
    let expected = read(&text);
    assert!(expected.lines().count() > 1);
    let packed = folder.path().join("recording.csv.zst");
    let bytes = std::fs::read(&text).unwrap();
    std::fs::write(&packed, zstd::encode_all(bytes.as_slice(), 3).unwrap()).unwrap();
    assert_eq!(read(&packed), expected);
    // A folder's packed recordings are found.
    assert_eq!(read(folder.path()), expected);
}

/// Oracle: the same rows sorted by flight.
#[test]
fn flights_that_alternate_give_the_segments_of_the_sorted_recording() {
    let folder = tempfile::tempdir().unwrap();
    let mapping = folder.path().join("M.ron");
    let text = layout("01_named_units.csv");
    mapping_of_flight(&text, &mapping, "Column(\"leg\")");
    let recorded = std::fs::read_to_string(&text).unwrap();
    let (names, rows) = recorded.split_once('\n').unwrap();
    let of = |tail: &str, leg: &str| -> Vec<String> {
        let rows = rows.lines().map(|row| row.trim_end().replace("F-AAAA", tail));
        rows.map(|row| format!("{row},{leg}\n")).collect()
    };
    let (one, other) = (of("F-AAAA", "A"), of("F-BBBB", "B"));
    let header = format!("{},leg\n", names.trim_end());
    let alternating = one.iter().zip(&other).flat_map(|(one, other)| [one.as_str(), other]);
    let alternating = header.clone() + &alternating.collect::<String>();
    let sorted = header + &one.concat() + &other.concat();
    // The file's name is in no segment.
    let read = |text: &str, threads: &str| {
        let path = folder.path().join("recording.csv");
        std::fs::write(&path, text).unwrap();
        let arguments = ["--threads".as_ref(), threads.as_ref(), "--mapping".as_ref()];
        let all = [&arguments[..], &[mapping.as_os_str(), path.as_os_str()]].concat();
        segments(&all)
    };
    let expected = read(&sorted, "1");
    assert!(expected.contains(",A,") && expected.contains(",B,"), "{expected}");
    for threads in ["1", "2"] {
        assert_eq!(read(&alternating, threads), expected, "{threads} threads");
    }
}
