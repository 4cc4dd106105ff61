//! A report reduced to what the later steps need: its stabilised segments, and what became of its samples.

use std::sync::Arc;

use diagnose::GaugeBurn;
use flight::column::Column;
use flight::{FlightIdentity, Report, Segment, TemperatureSource, Track};
use report::mapping::MappedPoints;
use segmenter::{Criterion, Scatter, Segmentation, Tally, TrimCriteria};
use track::TrackError;

use crate::check::FlightCheck;

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
    /// What is wrong with the data; `None` where that was not asked for.
    pub check: Option<FlightCheck>,
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
        let engines = report.engines();
        let aircraft_type = report.header().aircraft_type.clone();
        let samples = report.len();
        if report.header().lower_heating_value_mj_kg.is_some() {
            notes.push(HEATING_VALUE_NOT_APPLIED.to_owned());
        }
        let track = track::derive(report)?;
        note_assumed_temperature(&track, &mut notes);
        let segmentation = segmenter::segment(&track, criteria);
        let not_evaluated = segmentation.not_evaluated();
        if !not_evaluated.is_empty() {
            notes.push(format!(
                "trim criteria not evaluated, for want of a recording: {not_evaluated}"
            ));
        }
        let gauges = GaugeBurn::of_track(&track);
        let of = Reduced { aircraft_type, engines, samples, gauges, notes };
        Ok(of.into_flight(&track, segmentation))
    }

    /// The same of averaged points, each of which is a segment where nothing that is stated of it speaks against it.
    ///
    /// # Errors
    /// As [`ReducedFlight::from_report`].
    pub fn from_points(
        points: MappedPoints,
        criteria: &TrimCriteria,
        mut notes: Vec<String>,
    ) -> Result<Self, TrackError> {
        let MappedPoints { parsed, averaged_over_s, scatter } = points;
        let report = parsed.report;
        let engines = report.engines();
        let aircraft_type = report.header().aircraft_type.clone();
        let samples = report.len();
        let track = track::of_averaged_points(report, averaged_over_s)?;
        note_assumed_temperature(&track, &mut notes);
        let scatter: Vec<Scatter> = scatter.into_iter().filter_map(scatter_of).collect();
        let segmentation = segmenter::of_points(&track, criteria, &scatter);
        notes.push(format!(
            "each row is the mean of {averaged_over_s} s, as stated; trim criteria not judged, for want of samples: {}",
            segmentation.not_evaluated()
        ));
        let of = Reduced { aircraft_type, engines, samples, gauges: None, notes };
        Ok(of.into_flight(&track, segmentation))
    }
}

/// Decision 14 of the book has the reasons.
const HEATING_VALUE_NOT_APPLIED: &str = "the stated heating value (LHV) is checked and not applied: that of a mixture in tanks is not known better than what differs between flights anyway";

/// What is known of a flight apart from its segments.
struct Reduced {
    aircraft_type: String,
    engines: Option<usize>,
    samples: usize,
    gauges: Option<GaugeBurn>,
    notes: Vec<String>,
}

impl Reduced {
    fn into_flight(self, track: &Track, segmentation: Segmentation) -> ReducedFlight {
        let Self { aircraft_type, engines, samples, gauges, notes } = self;
        ReducedFlight {
            identity: Arc::new(track.report().header().identity.clone()),
            aircraft_type,
            engines,
            samples,
            segments: segmentation.segments,
            gauges,
            tally: segmentation.tally,
            notes,
            check: None,
        }
    }
}

fn note_assumed_temperature(track: &Track, notes: &mut Vec<String>) {
    if let TemperatureSource::AssumedIsa { isa_deviation_k } = track.temperature_source() {
        // A mapping that assumes it has reported so already.
        if !notes.iter().any(|note| note.contains("static air temperature")) {
            notes.push(format!("static air temperature assumed: ISA {isa_deviation_k:+} K"));
        }
    }
}

/// The criterion that a quantity's scatter judges.
fn scatter_of((column, standard_deviations): (Column, Vec<f64>)) -> Option<Scatter> {
    let criterion = match column {
        Column::N2(_) => Criterion::N2,
        _ => Criterion::from_name(&column.name())?,
    };
    Some(Scatter { criterion, standard_deviations })
}
