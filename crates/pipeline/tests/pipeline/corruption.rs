//! Every single-byte change of every file that a folder keeps is refused or changes nothing, exhaustively: each byte of a small
//! file becomes each of the 255 other values. And what mail programs and editors do to a model is accepted where it loses
//! nothing, and refused by name otherwise.
#![expect(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "a test")]
#![expect(clippy::disallowed_methods, reason = "tests read data from files")]

use std::collections::BTreeMap;
use std::path::Path;

use flight::Segment;
use perf_model::{Aircraft, Guide, initial_model};
use pipeline::checksum::sha256;
use pipeline::folder_state::{FileState, State, TailState};
use pipeline::learning::{FlightToLearn, LawChoice, begin, learn_flight, settle};
use pipeline::model_file::{LedgerEntry, ModelFile};
use pipeline::reading::{FlightRead, FlightReader};
use pipeline::segments_table::{self, SegmentRow};
use segmenter::TrimCriteria;

/// Three breakpoints by two: a model small enough to be changed in every byte, with a learnt state whose matrix is full.
const SMALL: &str = "table: (lift_coefficient: (0.20, 0.80, 0.30), mach: (0.70, 0.90, 0.20))";
/// Four by three: as many as the six coefficients of law `paper` need, and more.
const LARGER: &str = "table: (lift_coefficient: (0.20, 0.80, 0.20), mach: (0.70, 0.90, 0.10))";

fn fixture(name: &str) -> Vec<u8> {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/global5000");
    std::fs::read(fixtures.join(name)).unwrap()
}

fn initial(table: &str) -> ModelFile {
    let aircraft = format!(
        r#"(name: "small", type_code: "global5000", engines: 2, wing_area_m2: 94.94690688,
        tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0), {table})"#
    );
    let aircraft = Aircraft::from_ron(&aircraft).unwrap();
    let guide = Guide::from_csv(&fixture("guide.csv")).unwrap();
    ModelFile::from_initial(&initial_model(&aircraft, &guide).unwrap(), &guide)
}

fn first_flight() -> FlightRead {
    let (mut flights, refused) = FlightReader::default().read(
        Path::new("0001.txt"),
        &fixture("reports/0001.txt"),
        None,
        &TrimCriteria::ghazi_2020_table_4(),
    );
    assert_eq!(refused, []);
    flights.remove(0)
}

/// A model that has learnt one flight by law `bayes` or law `paper`.
fn learnt(mut model: ModelFile, law: LawChoice) -> ModelFile {
    let read = first_flight();
    let identity = &read.reduced.identity;
    let mut learnt = begin(&model.initial, &identity.tail, "standard", law).unwrap();
    let entry = LedgerEntry {
        tail: identity.tail.clone(),
        flight: identity.flight.clone(),
        start: identity.start.to_string(),
        content: read.content.clone(),
        samples: read.reduced.samples as u64,
        segments: 0,
        outside_table: 0,
        gauges: read.reduced.gauges,
    };
    let flight = FlightToLearn { entry, segments: &read.reduced.segments };
    let result = learn_flight(&model.initial, &mut learnt, &flight).unwrap();
    assert!(result.adapted > 0, "{result:?}");
    settle(&mut learnt).unwrap();
    model.learnt = Some(learnt);
    model
}

fn by_bayes() -> ModelFile {
    let model = initial(SMALL);
    let law = LawChoice::Bayes(model.settings.bayes);
    learnt(model, law)
}

fn state() -> State {
    let file = |file: &str| FileState::of(file, file.as_bytes());
    let summary = r#"{"tail": "T-1", "flights": 3, "flights_new": 0, "samples": 9, "segments": 2, "outside_table": 0,
        "fuel_flow_error_percent": {"before": {"mean": 0.25, "std": null, "max_abs": 1.5, "n": 2}}}"#;
    let tail = TailState {
        begun: sha256(b"begun"),
        model: file("models/T-1.ron"),
        segments: file("segments/T-1.csv"),
        flights: file("flights/T-1.csv"),
        deviations: None,
        summary: serde_json::from_str(summary).unwrap(),
    };
    State { generation: 7, tails: BTreeMap::from([("T-1".to_owned(), tail)]) }
}

/// How changes ended.
#[derive(Debug, Default)]
struct Tally {
    refused: usize,
    harmless: usize,
}

/// Puts every other byte at every place of a file. `outcome` of the bytes: `None` if they are refused, otherwise whether they
/// are read as the file is.
fn change_every_byte(what: &str, good: &[u8], outcome: impl Fn(&[u8]) -> Option<bool>) -> Tally {
    change_bytes(what, good, &(1..=u8::MAX).collect::<Vec<u8>>(), outcome)
}

/// The same with one bit of each byte changed at a time.
fn change_every_bit(what: &str, good: &[u8], outcome: impl Fn(&[u8]) -> Option<bool>) -> Tally {
    change_bytes(what, good, &[1, 2, 4, 8, 16, 32, 64, 128], outcome)
}

fn change_bytes(
    what: &str,
    good: &[u8],
    masks: &[u8],
    outcome: impl Fn(&[u8]) -> Option<bool>,
) -> Tally {
    assert_eq!(outcome(good), Some(true), "{what}: the undamaged file");
    let mut tally = Tally::default();
    let mut bytes = good.to_vec();
    for place in 0..good.len() {
        for mask in masks {
            bytes[place] = good[place] ^ mask;
            match outcome(&bytes) {
                None => tally.refused += 1,
                Some(true) => tally.harmless += 1,
                Some(false) => {
                    panic!(
                        "{what}: byte {place} became {:#04x}, and was read as something else",
                        bytes[place]
                    )
                }
            }
        }
        bytes[place] = good[place];
    }
    assert_eq!(tally.refused + tally.harmless, masks.len() * good.len());
    println!("{what}: {} bytes, {tally:?}", good.len());
    tally
}

/// What the program makes of a model's bytes.
fn model_outcome(text: &str) -> impl Fn(&[u8]) -> Option<bool> {
    move |bytes| {
        let model = ModelFile::from_text(std::str::from_utf8(bytes).ok()?).ok()?;
        Some(model.to_text().unwrap() == text)
    }
}

#[test]
fn a_learnt_model_of_law_bayes() {
    let text = by_bayes().to_text().unwrap();
    assert!(text.contains("law: Bayes("), "the state of law bayes is in the file:\n{text}");
    let tally = change_every_byte("model, law bayes", text.as_bytes(), model_outcome(&text));
    // Blanks behind the checksum are all that does not matter.
    assert!(tally.harmless < 255, "{tally:?}");
}

#[test]
fn an_initial_model_and_one_of_law_paper() {
    let initial = initial(LARGER);
    let paper = learnt(initial.clone(), LawChoice::Paper(initial.settings.paper));
    for (what, model) in [("initial model", initial), ("model, law paper", paper)] {
        let text = model.to_text().unwrap();
        let tally = change_every_bit(what, text.as_bytes(), model_outcome(&text));
        assert!(tally.harmless < 8, "{tally:?}");
    }
}

#[test]
fn the_state_of_a_folder() {
    let (state, text) = (state(), state().to_text().unwrap());
    let tally = change_every_byte("STATE.ron", text.as_bytes(), |bytes| {
        Some(State::from_text(std::str::from_utf8(bytes).ok()?).ok()? == state)
    });
    assert!(tally.harmless < 255, "{tally:?}");
}

/// Segments and the list of flights have no checksum of their own: `STATE.ron` has it.
#[test]
fn the_tables_that_a_state_names() {
    let segments: Vec<Segment> = first_flight().reduced.segments;
    let row = |segment: &Segment| SegmentRow { segment: segment.clone(), evaluated: None };
    let rows: Vec<SegmentRow> = segments.iter().take(2).map(row).collect();
    let table = segments_table::table(&rows, 2).to_csv();
    let named = FileState::of("segments/SIM-01.csv", &table);
    let tally = change_every_byte("segments", &table, |bytes| named.names(bytes).then_some(true));
    assert_eq!(tally.harmless, 0);
}

#[test]
fn a_model_that_was_cut_off_or_doubled() {
    let text = by_bayes().to_text().unwrap();
    // The last line break may be missing: an editor takes it off, and nothing is lost with it.
    for end in (0..text.len() - 1).filter(|end| text.is_char_boundary(*end)) {
        assert!(ModelFile::from_text(&text[..end]).is_err(), "cut off at {end}");
    }
    assert!(ModelFile::from_text(text.trim_end()).is_ok());
    assert!(ModelFile::from_text(&format!("{text}{text}")).is_err());
    assert!(ModelFile::from_text(&format!("\n{text}")).is_err());
}

/// Other line ends and a byte-order mark lose nothing, and are accepted.
#[test]
fn line_ends_and_a_byte_order_mark_do_not_count() {
    let text = by_bayes().to_text().unwrap();
    let crlf = text.replace('\n', "\r\n");
    for same in [&crlf, &format!("\u{feff}{text}"), &format!("\u{feff}{crlf}")] {
        assert_eq!(ModelFile::from_text(same).unwrap().to_text().unwrap(), text);
    }
}

/// What else a mail program does is refused with the reason, never read as another model.
#[test]
fn re_encoding_by_mail_is_refused() {
    let text = by_bayes().to_text().unwrap();
    let refused = |what: &str, changed: &str, words: &str| {
        assert_ne!(changed, text, "{what}: nothing was changed");
        let error = ModelFile::from_text(changed).unwrap_err().to_string();
        assert!(error.contains(words), "{what}: {error}");
    };
    let damaged = "changed or damaged";
    refused("tabs for blanks", &text.replace("    ", "\t"), "cut off");
    refused("blanks before line ends", &text.replace('\n', " \n"), damaged);
    refused("a signature below", &format!("{text}-- \nsent from a phone\n"), "");
    refused("a quoting mark", &text.replace('\n', "\n> "), "cut off");
    refused("a non-breaking blank", &text.replacen(' ', "\u{a0}", 1), damaged);
    refused("old line ends", &text.replace('\n', "\r"), "cut off");
    refused("typographic quotation marks", &text.replace('"', "\u{201d}"), "cut off");
    refused("quoted-printable", &text.replace('=', "=3D").replace('\n', "=\n\n"), damaged);
    let folded: String = text
        .chars()
        .enumerate()
        .map(|(place, c)| if place % 76 == 75 { format!("{c}\n") } else { c.to_string() })
        .collect();
    refused("lines of 76 characters", &folded, "");
}
