//! The folder of a run of trials: sealed truths, and the result of every case.

use std::path::{Path, PathBuf};

use trials::{
    CaseFailure, CaseResult, CaseSpec, CaseTruth, DiagnosedCase, FleetResult, FleetSpec,
    FleetTruth, FoundFleet, Seal, TrialPlan,
};

use crate::failure::{Failure, show};
use crate::files::{make_folder, write_atomically};

/// Truths on disk, and their seal.
#[derive(Clone, Debug)]
pub(super) struct TruthFolder {
    folder: PathBuf,
    cases: usize,
    seal: Seal,
}

impl TruthFolder {
    /// Writes the truths of all cases, in the order of their numbers, below `DIR/truth`. Truths that exist already must
    /// be identical to the byte; the run then continues from the results it has.
    ///
    /// # Errors
    /// A file or folder that cannot be written; a folder with other truths.
    pub(super) fn write(
        folder: &Path,
        truths: &[CaseTruth],
        fleets: &[FleetTruth],
    ) -> Result<Self, Failure> {
        let folder = folder.join("truth");
        make_folder(&folder)?;
        let of_cases = truths.iter().map(|truth| {
            (format!("case {}", truth.case), path_of(&folder, truth.case), truth.to_text())
        });
        let of_fleets = fleets.iter().map(|truth| {
            (format!("fleet {}", truth.fleet), fleet_path(&folder, truth.fleet), truth.to_text())
        });
        let mut texts = Vec::with_capacity(truths.len() + fleets.len());
        for (name, path, text) in of_cases.chain(of_fleets) {
            let text = text.map_err(|error| Failure::unwritable(&path, error))?;
            match std::fs::read(&path) {
                Ok(bytes) if bytes == text.as_bytes() => {}
                Ok(_) => {
                    return Err(Failure::BegunOtherwise {
                        folder: show(&folder),
                        what: "truth",
                        difference: format!(
                            "{name}: it was drawn by another version of the program, or the file was changed"
                        ),
                    });
                }
                Err(_) => write_atomically(&path, text.as_bytes())?,
            }
            texts.push(text);
        }
        let seal = Seal::of_texts(texts.iter().map(String::as_str));
        Ok(Self { folder, cases: truths.len(), seal })
    }

    /// The seal.
    pub(super) const fn seal(&self) -> &Seal {
        &self.seal
    }

    /// Opens the truth of a case, for scoring.
    ///
    /// # Errors
    /// A file that cannot be read, or that differs from what was sealed.
    pub(super) fn open(&self, case: usize) -> Result<CaseTruth, Failure> {
        let path = path_of(&self.folder, case);
        let bytes = std::fs::read(&path).map_err(|error| Failure::unreadable(&path, error))?;
        self.seal.open(case, &bytes).map_err(|error| Failure::bad_file(&path, error))
    }
}

impl TruthFolder {
    /// The hash of a fleet's truth.
    fn hash_of_fleet(&self, fleet: usize) -> &str {
        self.seal.hash_of(self.cases + fleet)
    }

    fn open_fleet(&self, fleet: usize) -> Result<FleetTruth, Failure> {
        let path = fleet_path(&self.folder, fleet);
        let bytes = std::fs::read(&path).map_err(|error| Failure::unreadable(&path, error))?;
        let place = self.cases + fleet;
        self.seal.open_fleet(place, &bytes).map_err(|error| Failure::bad_file(&path, error))
    }
}

/// Why a case has no result: the case failed, or its files did.
#[derive(Debug, thiserror::Error)]
pub(super) enum CaseError {
    /// The case itself.
    #[error(transparent)]
    Case(#[from] CaseFailure),
    /// Truth or result on disk.
    #[error(transparent)]
    Disk(#[from] Failure),
}

/// Runs one case: flies it, diagnoses it, opens its truth, scores it, and writes the result below `DIR/cases` at once,
/// so that an interruption loses no finished case. An existing result is reused.
///
/// # Errors
/// [`CaseError`]; other cases are not affected.
pub(super) fn run_case(
    folder: &Path,
    plan: &TrialPlan,
    spec: &CaseSpec,
    truths: &TruthFolder,
) -> Result<CaseResult, CaseError> {
    let path = folder.join("cases").join(format!("{:05}.json", spec.number));
    let sealed = truths.seal().hash_of(spec.number);
    if let Some(known) = finished(&path, sealed) {
        return Ok(known);
    }
    let diagnosed = DiagnosedCase::run(plan, spec)?;
    let truth = truths.open(spec.number)?;
    let result = diagnosed.score(&truth, sealed)?;
    let mut text =
        serde_json::to_string_pretty(&result).map_err(|error| Failure::unwritable(&path, error))?;
    text.push('\n');
    write_atomically(&path, text.as_bytes())?;
    // Read back as a later run would read it: a run that continues from a folder must arrive at the same bytes.
    serde_json::from_str(&text).map_err(|error| CaseError::Disk(Failure::bad_file(&path, error)))
}

/// Runs one fleet in the same way.
///
/// # Errors
/// [`CaseError`]; other fleets are not affected.
pub(super) fn run_fleet(
    folder: &Path,
    plan: &TrialPlan,
    spec: &FleetSpec,
    truths: &TruthFolder,
) -> Result<FleetResult, CaseError> {
    let path = fleet_path(&folder.join("cases"), spec.number);
    let sealed = truths.hash_of_fleet(spec.number);
    let known = std::fs::read(&path).ok();
    let known = known.and_then(|bytes| serde_json::from_slice::<FleetResult>(&bytes).ok());
    if let Some(known) = known.filter(|known| known.truth_sha256 == sealed) {
        return Ok(known);
    }
    let found = FoundFleet::run(plan, spec)?;
    let result = found.score(&truths.open_fleet(spec.number)?, sealed);
    let mut text =
        serde_json::to_string_pretty(&result).map_err(|error| Failure::unwritable(&path, error))?;
    text.push('\n');
    write_atomically(&path, text.as_bytes())?;
    serde_json::from_str(&text).map_err(|error| CaseError::Disk(Failure::bad_file(&path, error)))
}

/// The result of an earlier run, if it belongs to this truth.
fn finished(path: &Path, truth_sha256: &str) -> Option<CaseResult> {
    let bytes = std::fs::read(path).ok()?;
    let known: CaseResult = serde_json::from_slice(&bytes).ok()?;
    (known.truth_sha256 == truth_sha256).then_some(known)
}

fn fleet_path(folder: &Path, fleet: usize) -> PathBuf {
    folder.join(format!("fleet-{fleet:05}.json"))
}

fn path_of(folder: &Path, case: usize) -> PathBuf {
    folder.join(format!("{case:05}.json"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::{Background, Kind, ReferenceModel};

    fn truth(case: usize, times: f64) -> CaseTruth {
        CaseTruth {
            schema: "cruisefit.trial-truth/1".to_owned(),
            case,
            reference_model: ReferenceModel::Exact,
            background: Background::Clean,
            kind: Kind::Null,
            times,
            struck: vec![],
            effects: vec![],
            clutter: vec![],
        }
    }

    #[test]
    fn a_broken_seal_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let write =
            |times| TruthFolder::write(folder.path(), &[truth(1, 1.0), truth(2, times)], &[]);
        let truths = write(0.5).unwrap();
        assert_eq!(truths.open(2).unwrap(), truth(2, 0.5));
        // The same truth gives the same seal; another truth in the same folder is refused.
        assert_eq!(write(0.5).unwrap().seal(), truths.seal());
        assert!(write(0.6).is_err());
        let path = folder.path().join("truth/00002.json");
        let text = std::fs::read_to_string(&path).unwrap().replace("0.5", "0.6");
        std::fs::write(&path, text).unwrap();
        let error = truths.open(2).unwrap_err().to_string();
        assert!(error.contains("sealed was"), "{error}");
        assert!(truths.open(1).is_ok());
    }
}
