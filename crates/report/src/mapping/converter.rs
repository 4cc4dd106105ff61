//! What of reading a recording does not depend on what was read before: pieces into rows, and ended flights into reports.

use std::sync::Arc;

use super::stream::{MappedFlight, MappedPoints, MappedReport};
use super::table::{Layout, Rows};
use super::{Piece, derive, parts};

/// Reads pieces of a recording into rows, and makes reports of the flights that have ended: in any order, also several at the
/// same time, while its [`Stream`](super::Stream) adds rows in their order.
#[derive(Clone, Debug)]
pub struct Converter {
    pub(super) layout: Arc<Layout>,
}

impl Converter {
    /// Reads the rows of a piece.
    #[must_use]
    pub fn rows(&self, piece: Piece) -> Rows {
        self.layout.rows(piece)
    }

    /// The report of a flight.
    #[must_use]
    pub fn report(&self, MappedFlight(mut recording): MappedFlight) -> MappedReport {
        let plan = &self.layout.plan;
        let rows = recording.time_s.len();
        recording.settle(plan);
        let flight = recording.flight().to_owned();
        let (parts, longest_s) = parts(plan, &recording);
        if parts.is_empty() {
            let lacking = self.layout.lacking(&recording).map(Box::new);
            return MappedReport::WithoutCruise { flight, rows, longest_s, lacking };
        }
        match derive::report(&self.layout, &recording, &parts) {
            Ok((report, None)) => MappedReport::Report(Box::new(report)),
            Ok((parsed, Some(scatter))) => {
                let averaged_over_s = plan.points.as_ref().map_or(0.0, |plan| plan.averaged_over_s);
                MappedReport::Points(Box::new(MappedPoints { parsed, averaged_over_s, scatter }))
            }
            Err(refusal) => MappedReport::Refused { flight, refusal: Box::new(refusal) },
        }
    }
}
