//! A report reduced to what the later steps need: its stabilised segments, and what became of its samples.

use std::sync::Arc;

use diagnose::GaugeBurn;
use flight::{FlightIdentity, Report, Segment, TemperatureSource};
use segmenter::{Tally, TrimCriteria};
use track::TrackError;

use crate::check::{FlightCheck, check_report};

/// One flight, reduced to its segments.
#[derive(Clone, Debug)]
pub struct ReducedFlight {
    /// Who and when.
    pub identity: Arc<FlightIdentity>,
    /// Type code of the aircraft.
    pub aircraft_type: String,
    /// Engines recorded apart.
    pub engines: Option<usize>,
    /// Samples as sent.
    pub samples: usize,
    /// Segments in time order.
    pub segments: Vec<Segment>,
    /// Fuel burned by gauges and by meters, where fuel quantity is recorded.
    pub gauges: Option<GaugeBurn>,
    /// What became of every sample, counted.
    pub tally: Tally,
    /// What is worth knowing, each a sentence.
    pub notes: Vec<String>,
    /// What is wrong with the data.
    pub check: FlightCheck,
}

impl ReducedFlight {
    /// Derives mass and acceleration, finds the segments. `notes` are those of reading the report; what the derivation
    /// assumes is added to them.
    ///
    /// # Errors
    /// A report from which no track can be derived.
    pub fn from_report(
        report: Report,
        criteria: &TrimCriteria,
        mut notes: Vec<String>,
    ) -> Result<Self, TrackError> {
        let check = check_report(&report);
        let samples = report.len();
        let engines = report.engines();
        let header = report.header();
        let aircraft_type = header.aircraft_type.clone();
        let identity = Arc::new(header.identity.clone());
        let track = track::derive(report)?;
        if let TemperatureSource::AssumedIsa { isa_deviation_k } = track.temperature_source() {
            // A mapping that assumes it has reported so already.
            if !notes.iter().any(|note| note.contains("static air temperature")) {
                notes.push(format!("static air temperature assumed: ISA {isa_deviation_k:+} K"));
            }
        }
        let segmentation = segmenter::segment(&track, criteria);
        let not_evaluated = segmentation.not_evaluated();
        if !not_evaluated.is_empty() {
            notes.push(format!(
                "trim criteria not evaluated, for want of a recording: {not_evaluated}"
            ));
        }
        Ok(Self {
            identity,
            aircraft_type,
            engines,
            samples,
            segments: segmentation.segments,
            gauges: GaugeBurn::of_track(&track),
            tally: segmentation.tally,
            notes,
            check,
        })
    }
}
