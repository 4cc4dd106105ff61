//! One case from seed to score.

use diagnose::Diagnosis;
use flight::effect::EffectId;
use pipeline::diagnosis_words::variable_words;
use serde::{Deserialize, Serialize};

use crate::diagnosis_inputs::DiagnosisInputs;
use crate::draw::DrawnCase;
use crate::failure::CaseFailure;
use crate::plan::{Background, CaseSpec, Kind, ReferenceModel, TrialPlan};
use crate::planted::PlantedGap;
use crate::scored_case::Case;
use crate::seal::CaseTruth;

/// Distance beyond which none is reported.
const FARTHEST: f64 = 1e6;

/// What came of one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseResult {
    /// Its number.
    pub case: usize,
    /// SHA-256 of its truth, as it was sealed.
    pub truth_sha256: String,
    /// Which model.
    #[serde(rename = "denied")]
    pub reference_model: ReferenceModel,
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
    /// Probability of a cause outside the library, and the variable that it depends on.
    pub outside_probability: f64,
    /// The variable.
    pub outside_variable: Option<String>,
    /// Root mean square that noise alone makes, %.
    pub noise_floor_rms_percent: f64,
    /// What scores are made of.
    pub scored: Case,
}

/// A case with its verdict, not yet scored: nothing of it has met the truth.
#[derive(Debug)]
pub struct DiagnosedCase {
    drawn: DrawnCase,
    inputs: DiagnosisInputs,
    struck: Vec<EffectId>,
    found: Diagnosis,
}

impl DiagnosedCase {
    /// Draws, flies and diagnoses a case.
    ///
    /// # Errors
    /// [`CaseFailure`]; other cases are not touched by it.
    pub fn run(plan: &TrialPlan, spec: &CaseSpec) -> Result<Self, CaseFailure> {
        let drawn = DrawnCase::draw(plan, spec)?;
        let inputs = DiagnosisInputs::gather(&drawn)?;
        let struck: Vec<EffectId> = match spec.part.kind {
            // Which name is struck is an instruction, not a hint: the name is then not in the library.
            Kind::Struck => {
                spec.planted.iter().filter_map(|id| EffectId::from_name(&id.to_string())).collect()
            }
            _ => Vec::new(),
        };
        let found = inputs.diagnose(&struck)?;
        Ok(Self { drawn, inputs, struck, found })
    }

    /// The diagnosis.
    pub const fn diagnosis(&self) -> &Diagnosis {
        &self.found
    }

    /// Scores the diagnosis against the truth, which was sealed with this hash.
    ///
    /// # Errors
    /// What flying the same flights without the planted effects, or diagnosing with the whole library, refuses.
    pub fn score(&self, truth: &CaseTruth, truth_sha256: &str) -> Result<CaseResult, CaseFailure> {
        let Self { drawn, inputs, struck, found } = self;
        let mut scored = Case::from_diagnosis(truth.planted(), found);
        let planted = PlantedGap::measure(drawn, inputs, truth)?;
        scored.planted_closure = planted.closure(inputs, found);
        scored.located = planted.located(inputs, found, truth)?;
        if !struck.is_empty() {
            // How far the struck effect is from the rest is known only to a library that holds it.
            scored.take_distance(&inputs.diagnose_quickly()?);
        }
        if truth.background == Background::Clutter && truth.kind == Kind::Single {
            scored.attainable = inputs.attainable(drawn.known_clutter(truth))?;
        }
        scored.nearest =
            scored.nearest.map(|(other, pair)| (at_size(other, truth), at_size(pair, truth)));
        Ok(CaseResult {
            case: truth.case,
            truth_sha256: truth_sha256.to_owned(),
            reference_model: truth.reference_model,
            background: truth.background,
            kind: truth.kind,
            times: truth.times,
            flights: found.flights,
            segments: found.segments,
            named: found.verdict.effects().iter().map(ToString::to_string).collect(),
            outside_probability: found.outside.probability,
            outside_variable: found
                .outside
                .variable
                .map(|variable| variable_words(variable).to_owned()),
            noise_floor_rms_percent: found.gap.noise_floor_rms_percent,
            scored,
        })
    }
}

/// A distance at the typical size, at the planted one. JSON has no infinity: nothing is farther than this.
fn at_size(distance: f64, truth: &CaseTruth) -> f64 {
    (distance * truth.times).min(FARTHEST)
}
