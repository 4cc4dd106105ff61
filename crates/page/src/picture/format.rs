//! Which file a picture becomes.

use std::collections::BTreeSet;

use super::{Picture, PictureError, pdf, png};

/// The files that a sheet of charts can become.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Text that browsers and drawing programs read; scales to any size.
    Svg,
    /// Pixels, 192 dpi.
    Png,
    /// One page, letters as outlines.
    Pdf,
}

impl PictureFormat {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Svg, Self::Png, Self::Pdf];

    /// How the names of its files end.
    #[must_use]
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
        }
    }

    /// The format whose files' names end so, in letters of either case.
    #[must_use]
    pub fn from_ending(ending: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| ending.eq_ignore_ascii_case(format.ending()))
    }

    /// The file of a sheet of charts.
    ///
    /// # Errors
    /// Where the sheet is no SVG of this crate, or too large for a PNG.
    pub fn draw(self, sheet: String) -> Result<Picture, PictureError> {
        match self {
            Self::Svg => {
                Ok(Picture { bytes: sheet.into_bytes(), unknown_characters: BTreeSet::new() })
            }
            Self::Png => png(&sheet),
            Self::Pdf => pdf(&sheet),
        }
    }
}
