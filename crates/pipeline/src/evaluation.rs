//! What a run knows of each tail at its end: the material of summary, tables and pages.

use crate::learning;
use crate::model_file::ModelFile;
use crate::segments_table::{Evaluated, SegmentRow};
use crate::statistics::ErrorStatistics;
use crate::summary::{ErrorsSummary, TailSummary};

/// One tail at the end of a run.
#[derive(Clone, Debug)]
pub struct TailResult {
    /// Tail.
    pub tail: String,
    /// Its model, with what it has learnt.
    pub model: ModelFile,
    /// Every segment, with what the initial (or given) table says of it.
    pub rows: Vec<SegmentRow>,
    /// What the final table says of each segment, as long as `rows`; empty where nothing is adapted.
    pub after: Vec<Option<Evaluated>>,
    /// The figures.
    pub summary: TailSummary,
    /// What is worth knowing about this tail's data ("roll not recorded: criterion not evaluated", …), each once.
    pub notes: Vec<String>,
}

/// Counts that the segments do not tell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TailCounts {
    /// All flights.
    pub flights: usize,
    /// Flights that this run added.
    pub flights_new: usize,
    /// Samples of all flights.
    pub samples: u64,
}

impl TailResult {
    /// Puts together what is known of a tail. `rows` get what the model's initial table says, or, where nothing is
    /// adapted, its current table.
    pub fn new(
        tail: String,
        model: ModelFile,
        segments: Vec<flight::Segment>,
        counts: TailCounts,
        adapted: bool,
        notes: Vec<String>,
    ) -> Self {
        let before_table =
            if adapted { model.initial.drag_table() } else { model.drag_coefficient() };
        let before = learning::evaluate(&model.initial, before_table, &segments);
        let after = if adapted {
            learning::evaluate(&model.initial, model.drag_coefficient(), &segments)
        } else {
            Vec::new()
        };
        let summary = TailSummary {
            tail: tail.clone(),
            flights: counts.flights,
            flights_new: counts.flights_new,
            samples: counts.samples,
            segments: segments.len(),
            outside_table: errors(&before).iter().filter(|error| error.is_none()).count(),
            informed_nodes: adapted.then(|| model.informed_nodes()),
            refits: if adapted { model.refits() } else { None },
            interval95_coverage: if adapted { None } else { coverage(&model, &segments) },
            fuel_flow_error_percent: ErrorsSummary {
                before: statistics(&before),
                after: adapted.then(|| statistics(&after)),
            },
        };
        let rows = segments
            .into_iter()
            .zip(before)
            .map(|(segment, evaluated)| SegmentRow { segment, evaluated })
            .collect();
        Self { tail, model, rows, after, summary, notes }
    }

    /// Errors of the initial (or given) table in per cent, segment by segment; `None` outside the table.
    pub fn errors_before(&self) -> Vec<Option<f64>> {
        self.rows.iter().map(|row| row.evaluated.and_then(|e| e.error_percent)).collect()
    }

    /// Errors of the final table in per cent, segment by segment; empty where nothing is adapted.
    pub fn errors_after(&self) -> Vec<Option<f64>> {
        errors(&self.after)
    }
}

/// Two-sided 95 % of a standard normal distribution.
const STANDARD_DEVIATIONS_OF_95_PERCENT: f64 = 1.959_963_984_540_054;

/// Share of segments whose error lies within the interval that law `bayes` states for them; `None` by another law, or
/// without a segment inside the table.
fn coverage(model: &ModelFile, segments: &[flight::Segment]) -> Option<f64> {
    let posterior = model.posterior()?;
    let mut inside = 0_usize;
    let mut all = 0_usize;
    for segment in segments {
        let Ok(observation) = model.initial.observe(segment) else { continue };
        let grid = posterior.drag().grid();
        let Ok(cell) =
            grid.locate(observation.lift_coefficient, observation.mach, lut::Outside::Error)
        else {
            continue;
        };
        let deviation = posterior.segment_variance(&cell, &observation.variance).sqrt();
        let initial = posterior.initial().interpolate(&cell);
        let excess = (observation.drag_coefficient - posterior.drag().interpolate(&cell)) / initial;
        all += 1;
        inside += usize::from(excess.abs() <= STANDARD_DEVIATIONS_OF_95_PERCENT * deviation);
    }
    (all > 0).then(|| inside as f64 / all as f64)
}

fn errors(evaluated: &[Option<Evaluated>]) -> Vec<Option<f64>> {
    evaluated.iter().map(|evaluated| evaluated.and_then(|e| e.error_percent)).collect()
}

fn statistics(evaluated: &[Option<Evaluated>]) -> ErrorStatistics {
    let errors: Vec<f64> = errors(evaluated).into_iter().flatten().collect();
    ErrorStatistics::of(&errors)
}
