//! A sheet of charts ([`crate::plot()`]) as a PNG or PDF file: same sheet, same bytes, on a machine without fonts as well.
//!
//! Letters come from the font that the program carries (`fonts/`, Inter): what a machine has installed would change the
//! picture, and servers have nothing. The renderer knows no CSS variables and no media queries, so that the style sheet is
//! made flat first: light colours, the variables replaced by what they stand for.

mod format;

use std::collections::BTreeSet;
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, WriteOptions, fontdb};
use svg2pdf::{ConversionOptions, PageOptions};
use ttf_parser::Face;

pub use format::PictureFormat;

use crate::style::STYLE;

/// Letters of the charts, regular and semi-bold.
const FONTS: [&[u8]; 2] =
    [include_bytes!("../fonts/Inter-Regular.otf"), include_bytes!("../fonts/Inter-SemiBold.otf")];
const FAMILY: &str = "Inter";
/// Drawn pixels per CSS pixel (1/96 inch). Our choice: 192 dpi, sharp on slides and in print.
const PIXELS_PER_UNIT: f32 = 2.0;
/// Pixels of a PNG at most; four bytes each while it is drawn. Our choice: 400 MB.
const MOST_PIXELS: f64 = 1e8;

/// A file of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// The file's bytes.
    pub bytes: Vec<u8>,
    /// Characters, of a tail's name for example, that the font does not have: boxes in the picture.
    pub unknown_characters: BTreeSet<char>,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The renderer does not read the sheet.
    #[error("the sheet of charts cannot be drawn: {0}")]
    Sheet(#[from] resvg::usvg::Error),
    /// Larger than a picture in memory may be.
    #[error(
        "the sheet of charts would have {width} by {height} pixels, more than {MOST_PIXELS:.0} together; name fewer tails or charts, or write SVG or PDF"
    )]
    TooLarge {
        /// Width, pixels.
        width: u32,
        /// Height, pixels.
        height: u32,
    },
    /// The PNG cannot be packed.
    #[error("the picture cannot be packed as PNG: {0}")]
    Png(String),
    /// The PDF cannot be written.
    #[error("the sheet of charts cannot be written as PDF: {0}")]
    Pdf(String),
}

/// A sheet of charts as PNG at 192 dpi.
///
/// # Errors
/// Where the sheet is no SVG of this crate, or too large.
pub fn png(sheet: &str) -> Result<Picture, PictureError> {
    let tree = tree(sheet)?;
    let size = tree.size().to_int_size().scale_by(PIXELS_PER_UNIT);
    let (width, height) = size.map_or((0, 0), |size| (size.width(), size.height()));
    if f64::from(width) * f64::from(height) > MOST_PIXELS {
        return Err(PictureError::TooLarge { width, height });
    }
    let mut pixels = Pixmap::new(width, height).ok_or(PictureError::TooLarge { width, height })?;
    let scale = Transform::from_scale(PIXELS_PER_UNIT, PIXELS_PER_UNIT);
    resvg::render(&tree, scale, &mut pixels.as_mut());
    let bytes = pixels.encode_png().map_err(|error| PictureError::Png(error.to_string()))?;
    Ok(Picture { bytes, unknown_characters: unknown_characters(sheet) })
}

/// A sheet of charts as PDF of one page of its size; letters are outlines.
///
/// # Errors
/// Where the sheet is no SVG of this crate.
pub fn pdf(sheet: &str) -> Result<Picture, PictureError> {
    // Written again, letters become outlines: embedding the font would take three more libraries.
    let outlines = tree(sheet)?.to_string(&WriteOptions::default());
    let tree = Tree::from_str(&outlines, &Options::default())?;
    let page = PageOptions { dpi: 96.0 };
    let bytes = svg2pdf::to_pdf(&tree, ConversionOptions::default(), page)
        .map_err(|error| PictureError::Pdf(error.to_string()))?;
    let bytes = with_resources_in_order(&bytes);
    Ok(Picture { bytes, unknown_characters: unknown_characters(sheet) })
}

/// A PDF whose lists of resources are sorted: `svg2pdf` writes them in the order of a hash map, another one at each call. Lines
/// change places with lines beside them, so that every offset in the file stays right.
fn with_resources_in_order(pdf: &[u8]) -> Vec<u8> {
    let mut lines: Vec<&[u8]> = pdf.split_inclusive(|byte| *byte == b'\n').collect();
    for neighbours in lines.chunk_by_mut(|one, other| is_resource(one) && is_resource(other)) {
        neighbours.sort_unstable();
    }
    lines.concat()
}

/// Whether a line of a PDF is like `      /gs12 20 0 R`: the name of a resource, two letters and a number, and where it is.
fn is_resource(line: &[u8]) -> bool {
    let Some(name) = line.trim_ascii_start().strip_prefix(b"/") else { return false };
    let kinds: [&[u8]; 6] = [b"gs", b"xo", b"po", b"sh", b"fo", b"cs"];
    name.len() > 2
        && kinds.contains(&&name[..2])
        && name[2].is_ascii_digit()
        && name.ends_with(b"\n")
}

fn tree(sheet: &str) -> Result<Tree, PictureError> {
    let mut fonts = fontdb::Database::new();
    for font in FONTS {
        fonts.load_font_data(font.to_vec());
    }
    fonts.set_sans_serif_family(FAMILY);
    let options =
        Options { font_family: FAMILY.to_owned(), fontdb: Arc::new(fonts), ..Options::default() };
    Ok(Tree::from_str(&flat(sheet), &options)?)
}

/// The sheet with the light colours of the screen, without variables and media queries.
fn flat(sheet: &str) -> String {
    let mut flat = sheet.replace(STYLE, &without_media_queries(STYLE));
    for (name, value) in variables() {
        flat = flat.replace(&format!("var({name})"), value);
    }
    // A dot is a line of no length with round ends; readers of PDF draw none where a path has but one.
    flat.replace("h0M", "h.01M").replace("h0\"", "h.01\"")
}

/// Names and values of the style sheet's variables: its first rule.
fn variables() -> impl Iterator<Item = (&'static str, &'static str)> {
    let (_, rule) = STYLE.split_once('{').unwrap_or_default();
    let (rule, _) = rule.split_once('}').unwrap_or_default();
    rule.split(';').filter_map(|line| {
        let (name, value) = line.split_once(':')?;
        Some((name.trim(), value.trim())).filter(|(name, _)| name.starts_with("--"))
    })
}

fn without_media_queries(style: &str) -> String {
    let mut kept = String::with_capacity(style.len());
    let mut rest = style;
    while let Some((before, query)) = rest.split_once("@media") {
        kept.push_str(before);
        rest = after_block(query);
    }
    kept.push_str(rest);
    kept
}

/// What follows the first block in braces.
fn after_block(text: &str) -> &str {
    let mut depth = 0_usize;
    for (at, letter) in text.char_indices() {
        match letter {
            '{' => depth += 1,
            '}' if depth <= 1 => return &text[at + 1..],
            '}' => depth -= 1,
            _ => {}
        }
    }
    ""
}

/// Characters of the sheet's texts that the regular font has no glyph for.
fn unknown_characters(sheet: &str) -> BTreeSet<char> {
    let Ok(face) = Face::parse(FONTS[0], 0) else { return BTreeSet::new() };
    let drawn = sheet.split("<text").skip(1).filter_map(|rest| rest.split("</text>").next());
    drawn
        .flat_map(str::chars)
        .filter(|letter| !letter.is_control() && face.glyph_index(*letter).is_none())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet as `plot` writes it: its style, a path of the colour "after", a heading.
    fn sheet(text: &str) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 40 20\" width=\"40\" height=\"20\" font-family=\"sans-serif\">\
             <style><![CDATA[{STYLE}]]></style><rect width=\"100%\" height=\"100%\" style=\"fill:var(--paper)\"/>\
             <path class=\"disc after\" d=\"M10 10h0\"/><text x=\"20\" y=\"15\">{text}</text></svg>"
        )
    }

    fn pixel(picture: &Picture, x: u32, y: u32) -> [u8; 3] {
        let pixels = Pixmap::decode_png(&picture.bytes).expect("a PNG");
        let one = pixels.pixel(x, y).expect("within the picture");
        [one.red(), one.green(), one.blue()]
    }

    #[test]
    fn variables_and_classes_of_the_style_sheet_are_drawn() {
        let picture = png(&sheet("")).expect("a picture");
        // --paper and --after of the light colours; a disc is 7 wide, at 10, 10, drawn at twice the size.
        assert_eq!(pixel(&picture, 1, 1), [0xff, 0xff, 0xff]);
        assert_eq!(pixel(&picture, 20, 20), [0x00, 0x72, 0xb2]);
    }

    #[test]
    fn letters_come_from_the_font_that_is_carried() {
        let (without, with) = (png(&sheet("")).expect("drawn"), png(&sheet("W")).expect("drawn"));
        assert_ne!(without, with);
        assert_eq!(with.unknown_characters, BTreeSet::new());
        assert_eq!(with, png(&sheet("W")).expect("drawn"), "same sheet, same bytes");
    }

    #[test]
    fn a_heading_is_heavier_than_a_label() {
        let heading = sheet("W").replace("<text ", "<text style=\"font-weight:600\" ");
        assert_ne!(png(&sheet("W")).expect("drawn"), png(&heading).expect("drawn"));
    }

    #[test]
    fn what_the_font_does_not_have_is_named() {
        let picture = png(&sheet("機 –−±²°σ≤→")).expect("drawn");
        let expected: BTreeSet<char> = ['機'].into();
        assert_eq!(picture.unknown_characters, expected);
    }

    #[test]
    fn a_pdf_has_a_page_of_the_sheets_size_and_keeps_its_bytes() {
        let first = pdf(&sheet("drag")).expect("drawn");
        let text = String::from_utf8_lossy(&first.bytes);
        assert!(text.starts_with("%PDF-1.7"), "{}", &text[..20]);
        // 40 by 20 CSS pixels at 96 dpi are 30 by 15 points.
        assert!(text.contains("/MediaBox [0 0 30 15]"), "{text}");
        assert_eq!(first, pdf(&sheet("drag")).expect("drawn"));
    }

    #[test]
    fn a_pdf_with_many_resources_has_the_same_bytes_each_time() {
        // Each opacity is a resource; `svg2pdf` alone has one order of six in 720.
        let areas = [1, 2, 3, 4, 5, 6]
            .map(|k| format!("<path d=\"M1 1H9V9Z\" style=\"fill:red;fill-opacity:.{k}\"/>"))
            .concat();
        let sheet = sheet("drag").replace("<text", &format!("{areas}<text"));
        let first = pdf(&sheet).expect("drawn");
        assert!(String::from_utf8_lossy(&first.bytes).contains("/gs5 "), "six resources");
        for _ in 0..4 {
            assert!(first == pdf(&sheet).expect("drawn"), "another order");
        }
    }

    #[test]
    fn a_dot_alone_has_a_length() {
        assert!(flat(&sheet("")).contains("d=\"M10 10h.01\""));
    }

    #[test]
    fn no_variable_and_no_media_query_is_left() {
        let flat = flat(&sheet("x"));
        assert!(!flat.contains("var(") && !flat.contains("@media"), "{flat}");
    }

    #[test]
    fn a_sheet_that_is_too_large_is_refused_with_its_size() {
        let large =
            sheet("").replace("width=\"40\" height=\"20\"", "width=\"9000\" height=\"9000\"");
        let error = png(&large).expect_err("refused");
        assert!(error.to_string().contains("18000 by 18000 pixels"), "{error}");
    }
}
