//! The fuzz targets' functions on edited valid input: for everybody who has no fuzzer, and in every run of the tests.

use proptest::prelude::*;

use super::entries::{ENTRIES, Entry};

/// A small valid input of each entry, in the entries' order of names.
const SEEDS: [(&str, &[u8]); 12] = [
    ("report", test_support::reports::FORMAT_SAMPLE.as_bytes()),
    ("gzip", test_support::reports::FORMAT_SAMPLE.as_bytes()),
    ("mapping", include_bytes!("seeds/mapping.ron")),
    ("recording", include_bytes!("seeds/recording.csv")),
    ("model", include_bytes!("seeds/model.ron")),
    ("state", include_bytes!("seeds/state.ron")),
    ("aircraft", include_bytes!("seeds/aircraft.ron")),
    ("guide", include_bytes!("seeds/guide.csv")),
    ("points", include_bytes!("seeds/points.csv")),
    ("plan", include_bytes!("seeds/plan.ron")),
    ("trial_plan", include_bytes!("seeds/trial_plan.ron")),
    ("tables", include_bytes!("seeds/segments.csv")),
];

/// What readers of numbers, RON and CSV treat in their own ways, and what a terminal, a browser or a spreadsheet acts on.
const PIECES: [&str; 36] = [
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "/*",
    "*/",
    "//",
    "\n",
    "\r\n",
    "\r",
    "\"",
    ",",
    ";",
    "\t",
    "1e999",
    "-0",
    "NaN",
    "inf",
    "1e308",
    "-1e308",
    "4294967296",
    "18446744073709551615",
    "-1",
    "0",
    "1e-320",
    "Some(",
    "None",
    "\u{feff}",
    "é",
    "#![enable(implicit_some)]",
    "../../x",
    "\u{1b}[2J",
    "<script>",
    "=1+1",
];

/// A change of a valid input.
#[derive(Clone, Debug)]
enum Edit {
    /// Puts a piece at a place, over so many bytes.
    Piece(usize, usize, &'static str),
    /// Puts a part of the input at another place.
    Copy(usize, usize, usize),
    /// Replaces a byte.
    Byte(usize, u8),
    /// Cuts the end off.
    Cut(usize),
}

fn edit() -> impl Strategy<Value = Edit> {
    prop_oneof![
        4 => (any::<usize>(), 0..12_usize, prop::sample::select(PIECES.to_vec()))
            .prop_map(|(at, over, piece)| Edit::Piece(at, over, piece)),
        1 => (any::<usize>(), 0..80_usize, any::<usize>()).prop_map(|(from, length, to)| Edit::Copy(from, length, to)),
        2 => (any::<usize>(), any::<u8>()).prop_map(|(at, byte)| Edit::Byte(at, byte)),
        1 => any::<usize>().prop_map(Edit::Cut),
    ]
}

fn edited(seed: &[u8], edits: &[Edit]) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for edit in edits {
        let place = |at: usize| at % (bytes.len() + 1);
        let end = |from: usize, length: usize| (from + length).min(bytes.len());
        match *edit {
            Edit::Piece(at, over, piece) => {
                let from = place(at);
                bytes.splice(from..end(from, over), piece.bytes());
            }
            Edit::Copy(from, length, to) => {
                let (from, to) = (place(from), place(to));
                let part = bytes[from..end(from, length)].to_vec();
                bytes.splice(to..to, part);
            }
            Edit::Byte(at, byte) => {
                let at = place(at);
                bytes.splice(at..end(at, 1), [byte]);
            }
            Edit::Cut(at) => bytes.truncate(place(at)),
        }
    }
    bytes
}

fn entry(name: &str) -> (Entry, &'static [u8]) {
    let (_, entry) = ENTRIES.iter().find(|(known, _)| *known == name).unwrap();
    let (_, seed) = SEEDS.iter().find(|(known, _)| *known == name).unwrap();
    (*entry, seed)
}

#[test]
fn every_entry_has_a_seed_and_takes_it() {
    for (name, entry) in ENTRIES {
        let seed = SEEDS.iter().find(|(known, _)| *known == name).unwrap().1;
        assert!(!seed.is_empty());
        entry(seed);
    }
}

/// Seeds are what they claim to be: an edit of something that was refused anyway would test nothing.
#[test]
fn seeds_are_valid() {
    let text = |name: &str| std::str::from_utf8(entry(name).1).unwrap();
    report::Reader::new().read(text("report").as_bytes()).unwrap();
    let mapping = report::Mapping::from_ron(text("mapping")).unwrap();
    assert_eq!(mapping.read(text("recording").as_bytes()).unwrap().len(), 1);
    pipeline::model_file::ModelFile::from_text(text("model")).unwrap();
    pipeline::folder_state::State::from_text(text("state")).unwrap();
    perf_model::Aircraft::from_ron(text("aircraft")).unwrap();
    perf_model::Guide::from_csv(text("guide").as_bytes()).unwrap();
    perf_model::FlightPoints::from_csv(text("points").as_bytes()).unwrap();
    simulate::Simulation::new(simulate::Plan::from_ron(text("plan")).unwrap()).unwrap();
    trials::TrialPlan::from_ron(text("trial_plan")).unwrap();
    assert!(!pipeline::segments_table::read(text("tables").as_bytes()).unwrap().is_empty());
}

macro_rules! edited_input_never_panics {
    ($($name:ident),*) => {
        proptest! {
            $(
                #[test]
                fn $name(edits in prop::collection::vec(edit(), 1..6)) {
                    let (entry, seed) = entry(stringify!($name));
                    entry(&edited(seed, &edits));
                }
            )*
        }
    };
}
edited_input_never_panics!(
    report, gzip, mapping, recording, model, state, aircraft, guide, points, plan, trial_plan,
    tables
);
