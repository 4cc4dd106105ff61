//! Every place where bytes from outside enter, as a function of bytes that returns whatever they are: a value, or a refusal. It
//! panics where the program would, and where a promise does not hold (a refusal without a position, a value that does not
//! read back).
//!
//! The tests of this folder and the fuzz targets (`fuzz/`) call the same functions.

use std::path::Path;

use perf_model::{Aircraft, FlightPoints, Guide, initial_model};
use pipeline::folder_state::{FolderStateError, State};
use pipeline::model_file::{ModelFile, ModelTextError};
use pipeline::reading::FlightReader;
use pipeline::segments_table::SegmentRow;
use pipeline::{learnt_flights, monitoring, segments_table};
use report::mapping::PRESETS;
use report::{Mapping, Reader};
use segmenter::TrimCriteria;
use simulate::{Plan, Simulation};
use trials::TrialPlan;

/// What takes bytes from outside.
pub type Entry = fn(&[u8]);

/// All of them by name; fuzz targets have the same names.
pub const ENTRIES: [(&str, Entry); 12] = [
    ("report", report_text),
    ("gzip", gzip),
    ("mapping", mapping),
    ("recording", recording),
    ("model", model),
    ("state", state),
    ("aircraft", aircraft),
    ("guide", guide),
    ("points", points),
    ("plan", plan),
    ("trial_plan", trial_plan),
    ("tables", tables),
];

/// A recording that most mappings find something in.
const RECORDING: &str = include_str!("seeds/recording.csv");

/// A cruise report, plain or gzip, through to its segments.
pub fn report_text(bytes: &[u8]) {
    if let Err(refusal) = Reader::new().read(bytes) {
        assert!(refusal.line >= 1 && refusal.column >= 1, "{refusal}");
        assert!(!refusal.to_string().is_empty());
    }
    let criteria = TrimCriteria::ghazi_2020_table_4();
    let (flights, refused) =
        FlightReader::default().read(Path::new("x.txt"), bytes, None, &criteria);
    assert!(!flights.is_empty() || !refused.is_empty(), "neither read nor refused");
    for segment in flights.iter().flat_map(|flight| &flight.reduced.segments) {
        assert_eq!(segments_table::not_finite(segment), None);
    }
}

/// Packed bytes; what does not begin as gzip does is packed first, so that unpacking is reached.
pub fn gzip(bytes: &[u8]) {
    let mut unpacked = Vec::new();
    if let Ok(content) = report::unpack(bytes, &mut unpacked) {
        assert!(content.len() <= report::MAXIMUM_TEXT_BYTES.max(bytes.len()));
    }
    let with_magic: Vec<u8> = [0x1f, 0x8b, 8].iter().chain(bytes).copied().collect();
    report_text(&with_magic);
}

/// A mapping file; one that is valid reads a recording.
pub fn mapping(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(mapping) = Mapping::from_ron(text) else { return };
    read_recording(&mapping, RECORDING.as_bytes());
}

/// A recording, by every built-in mapping, and what the program guesses of it.
pub fn recording(bytes: &[u8]) {
    for (name, _) in PRESETS {
        let Some(mapping) = Mapping::preset(name) else { panic!("no preset {name}") };
        read_recording(&mapping, bytes);
    }
    let Ok(own) = Mapping::from_ron(include_str!("seeds/mapping.ron")) else { panic!("seed") };
    read_recording(&own, bytes);
    let _ = report::mapping::first_mapping(bytes);
}

fn read_recording(mapping: &Mapping, bytes: &[u8]) {
    let criteria = TrimCriteria::ghazi_2020_table_4();
    let read = FlightReader::default().read(Path::new("x.csv"), bytes, Some(mapping), &criteria);
    for segment in read.0.iter().flat_map(|flight| &flight.reduced.segments) {
        assert_eq!(segments_table::not_finite(segment), None);
    }
}

/// A model; again with the checksum that its content asks for, so that what lies behind the checksum is reached.
pub fn model(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let read = match ModelFile::from_text(text) {
        Err(ModelTextError::Damaged { found, computed }) if !found.is_empty() => {
            ModelFile::from_text(&text.replacen(&found, &computed, 1))
        }
        read => read,
    };
    let Ok(model) = read else { return };
    let Ok(written) = model.to_text() else { panic!("a model without a text") };
    assert!(ModelFile::from_text(&written).is_ok(), "what was written does not read back");
}

/// The state of a folder; again with the checksum that its content asks for.
pub fn state(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let read = match State::from_text(text) {
        Err(FolderStateError::Damaged { found, computed }) if !found.is_empty() => {
            State::from_text(&text.replacen(&found, &computed, 1))
        }
        read => read,
    };
    let Ok(state) = read else { return };
    let Ok(written) = state.to_text() else { panic!("a state without a text") };
    assert!(State::from_text(&written).is_ok(), "what was written does not read back");
}

/// An aircraft file; a valid one makes an initial model of a guide, or says why not.
pub fn aircraft(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(aircraft) = Aircraft::from_ron(text) else { return };
    let Ok(written) = aircraft.to_ron() else { panic!("an aircraft without a text") };
    assert_eq!(Aircraft::from_ron(&written).as_ref(), Ok(&aircraft));
    let Ok(guide) = Guide::from_csv(include_bytes!("seeds/guide.csv")) else { panic!("seed") };
    // A table as large as the limits allow takes its time, which is not what is looked for here.
    if aircraft.grid().nodes() <= 10_000 {
        let _ = initial_model(&aircraft, &guide);
    }
}

/// A guide; a valid one makes an initial model, or says why not.
pub fn guide(bytes: &[u8]) {
    let Ok(guide) = Guide::from_csv(bytes) else { return };
    let Ok(aircraft) = Aircraft::from_ron(include_str!("seeds/aircraft.ron")) else {
        panic!("seed")
    };
    if let Ok(initial) = initial_model(&aircraft, &guide) {
        assert!(initial.model.drag_table().values().iter().all(|value| *value > 0.0));
    }
}

/// Flight points.
pub fn points(bytes: &[u8]) {
    let _ = FlightPoints::from_csv(bytes);
}

/// A plan of simulated flights: a simulation, or the reason. Nothing is flown.
pub fn plan(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(plan) = Plan::from_ron(text) else { return };
    let _ = Simulation::new(plan);
}

/// A plan of blind trials.
pub fn trial_plan(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(plan) = TrialPlan::from_ron(text) else { return };
    assert!(plan.to_ron().is_ok());
}

/// Tables that the program wrote or a user keeps: segments, reduced flights, learnt flights, events.
pub fn tables(bytes: &[u8]) {
    if let Ok(segments) = segments_table::read(bytes) {
        let row = |segment| SegmentRow { segment, evaluated: None };
        let rows: Vec<SegmentRow> = segments.iter().cloned().map(row).collect();
        let written = segments_table::table(&rows, segments_table::engines_of(&rows)).to_csv();
        if let Ok(again) = segments_table::read(&written) {
            assert_eq!(again, segments, "segments read back otherwise");
        }
    }
    let _ = pipeline::flights_table::read(bytes);
    let _ = learnt_flights::read("T-1", bytes);
    let _ = monitoring::read_events(bytes);
}
