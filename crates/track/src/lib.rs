//! Mass, along-path acceleration and vertical speed along a report.
