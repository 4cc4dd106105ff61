//! The guides of the handbook show texts for this crate: they are read here.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking, in its helpers too")]

use report::{Mapping, Reader, TextLayout, mapping, write};

const FORMAT: &str = include_str!("../../../../docs/src/guides/cruise_report_format.md");
const MAPPING: &str = include_str!("../../../../docs/src/guides/mapping.md");

/// The fenced blocks of a language in a page.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    page.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

#[test]
fn the_report_in_the_guide_reads_and_is_as_we_write() {
    let text = blocks(FORMAT, "text")[0];
    let report = Reader::new().read(text.as_bytes()).unwrap().report;
    assert_eq!(write(&report, &TextLayout::industry(), &[]).unwrap(), text);
}

#[test]
fn the_message_in_the_guide_is_the_message() {
    let text = blocks(FORMAT, "text")[0].replace(" 460.0 ", " 460,0 ");
    let refusal = Reader::new().read(text.as_bytes()).unwrap_err();
    assert_eq!(blocks(FORMAT, "text")[1].trim(), format!("0007.txt: {refusal}"));
}

#[test]
fn every_column_of_the_format_stands_in_the_guide() {
    for name in flight::column::COLUMN_NAMES.split(' ') {
        assert!(FORMAT.contains(&format!("`{name}`")), "{name}");
    }
}

#[test]
fn mappings_in_the_guide_are_read() {
    let shown = blocks(MAPPING, "ron");
    assert_eq!(shown.len(), 3);
    for text in &shown {
        Mapping::from_ron(text).unwrap_or_else(|error| panic!("{error:?}"));
    }
    // The first is the preset without its comments.
    let (_, preset) = mapping::PRESETS[0];
    let without_comments: String = preset
        .lines()
        .map(|line| line.split("//").next().unwrap().trim_end())
        .filter(|line| !line.is_empty())
        .map(|line| line.to_owned() + "\n")
        .collect();
    assert_eq!(without_comments, shown[0]);
}

#[test]
fn every_preset_is_read() {
    for (name, _) in mapping::PRESETS {
        assert!(Mapping::preset(name).is_some(), "{name}");
    }
    assert!(Mapping::preset("no such preset").is_none());
}
