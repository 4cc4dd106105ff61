//! Segments of hand-made reports.

use core::ops::Range;

use flight::{Report, ReportColumns, Track};
use segmenter::{Segmentation, TrimCriteria};
use test_support::reports::header;

/// Segments by the published criteria.
pub(crate) fn segmented(columns: ReportColumns) -> (Track, Segmentation) {
    let track = track::derive(Report::new(header(), columns).unwrap()).unwrap();
    let segmentation = segmenter::segment(&track, &TrimCriteria::ghazi_2020_table_4());
    (track, segmentation)
}

/// Kept samples of each segment.
pub(crate) fn rows(segmentation: &Segmentation) -> Vec<Vec<u32>> {
    segmentation.segments.iter().map(|segment| segment.rows.clone()).collect()
}

/// Rows of a segment without discarded samples.
pub(crate) fn all(rows: Range<u32>) -> Vec<u32> {
    rows.collect()
}
