//! One case from seed to score.

use std::path::{Path, PathBuf};

use diagnose::trial::Case;
use flight::effect::EffectId;
use serde::{Deserialize, Serialize};

use super::draw::Withheld;
use super::evidence::Evidence;
use super::plan::{Background, CaseSpec, Denied, Kind, TrialPlan};
use super::planted::PlantedGap;
use super::seal::{CaseTruth, Seal};
use crate::failure::Failure;
use crate::files::write_atomically;
use crate::learning;

/// Distance beyond which none is told.
const FARTHEST: f64 = 1e6;

/// What came of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseResult {
    /// Its number.
    pub case: usize,
    /// SHA-256 of its truth, as it was sealed.
    pub truth_sha256: String,
    /// Which model.
    pub denied: Denied,
    /// On which background.
    pub background: Background,
    /// What kind.
    pub kind: Kind,
    /// Size over the typical size.
    pub times: f64,
    /// Flights and segments that were diagnosed.
    pub flights: usize,
    /// Segments.
    pub segments: usize,
    /// Effects that the verdict names.
    pub named: Vec<String>,
    /// Probability of a cause outside the library, and the variable that it hangs on.
    pub outside_probability: f64,
    /// The variable.
    pub outside_variable: Option<String>,
    /// Root mean square that noise alone makes, %.
    pub noise_floor_rms_percent: f64,
    /// What scores are made of.
    pub scored: Case,
}

/// Why a case came to nothing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CaseFailure {
    /// The plan.
    #[error(transparent)]
    Plan(#[from] simulate::PlanError),
    /// The flight.
    #[error(transparent)]
    Flight(#[from] simulate::SimulationError),
    /// Too few of the planned flights.
    #[error("{flown} of {planned} flights could be flown, nine tenths are needed")]
    NotFlown {
        /// Flights flown.
        flown: usize,
        /// Flights planned.
        planned: usize,
    },
    /// The track.
    #[error(transparent)]
    Track(#[from] track::TrackError),
    /// The aircraft of the denied model.
    #[error(transparent)]
    Aircraft(#[from] perf_model::AircraftError),
    /// Its table.
    #[error(transparent)]
    Table(#[from] lut::TableError),
    /// The denied model.
    #[error(transparent)]
    Model(#[from] perf_model::ModelError),
    /// What it should have learnt.
    #[error(transparent)]
    Learning(#[from] learning::LearningError),
    /// What its table does not know.
    #[error(transparent)]
    Uncertainty(#[from] diagnose::TableUncertaintyError),
    /// The diagnosis.
    #[error(transparent)]
    Diagnose(#[from] diagnose::DiagnoseError),
    /// A place that the diagnosis named.
    #[error(transparent)]
    Slice(#[from] diagnose::SliceError),
    /// A model that takes no effects.
    #[error(transparent)]
    Effects(#[from] perf_model::effects::EffectModelError),
    /// Truth or result on disk.
    #[error(transparent)]
    Disk(#[from] Failure),
}

/// Runs one case: flies it, diagnoses it, opens its truth, scores it, and writes the result below `DIR/cases` at once, so
/// that nothing is lost to an interruption. A result that is there already is taken.
///
/// # Errors
/// [`CaseFailure`]; other cases are not touched by it.
pub fn run_case(
    folder: &Path,
    plan: &TrialPlan,
    spec: &CaseSpec,
    seal: &Seal,
) -> Result<CaseResult, CaseFailure> {
    let path = folder.join("cases").join(format!("{:05}.json", spec.number));
    if let Some(known) = finished(&path, seal.hash_of(spec.number)) {
        return Ok(known);
    }
    let withheld = Withheld::draw(plan, spec)?;
    let evidence = Evidence::gather(&withheld)?;
    let without: Vec<EffectId> = match spec.part.kind {
        // Which name is struck is an instruction, not a hint: the name is then not in the library.
        Kind::Struck => {
            spec.planted.iter().filter_map(|id| EffectId::from_name(&id.to_string())).collect()
        }
        _ => Vec::new(),
    };
    let found = evidence.diagnose(&without, false)?;
    let truth = seal.open(spec.number)?;
    let mut scored = Case::of(truth.planted(), &found);
    let planted = PlantedGap::measure(&withheld, &evidence, &truth)?;
    scored.planted_closure = planted.closure(&evidence, &found);
    scored.located = planted.located(&evidence, &found, &truth)?;
    if !without.is_empty() {
        // How far the struck effect is from the rest is known only to a library that holds it.
        scored.take_distance(&evidence.diagnose(&[], true)?);
    }
    scored.nearest =
        scored.nearest.map(|(other, pair)| (at_size(other, &truth), at_size(pair, &truth)));
    let result = CaseResult {
        case: spec.number,
        truth_sha256: seal.hash_of(spec.number).to_owned(),
        denied: truth.denied,
        background: truth.background,
        kind: truth.kind,
        times: truth.times,
        flights: found.flights,
        segments: found.segments,
        named: found.verdict.effects.clone(),
        outside_probability: found.outside.probability,
        outside_variable: found.outside.variable.clone(),
        noise_floor_rms_percent: found.gap.noise_floor_rms_percent,
        scored,
    };
    let mut text =
        serde_json::to_string_pretty(&result).map_err(|error| Failure::unwritable(&path, error))?;
    text.push('\n');
    write_atomically(&path, text.as_bytes())?;
    // As a later run would read it: what goes on from a folder shall come to the same bytes.
    serde_json::from_str(&text).map_err(|error| CaseFailure::Disk(Failure::bad_file(&path, error)))
}

/// A distance at the typical size, at the planted one. JSON has no infinity: nothing is farther than this.
fn at_size(distance: f64, truth: &CaseTruth) -> f64 {
    (distance * truth.times).min(FARTHEST)
}

/// A result of an earlier run, if it is of this truth.
fn finished(path: &PathBuf, truth_sha256: &str) -> Option<CaseResult> {
    let bytes = std::fs::read(path).ok()?;
    let known: CaseResult = serde_json::from_slice(&bytes).ok()?;
    (known.truth_sha256 == truth_sha256).then_some(known)
}
