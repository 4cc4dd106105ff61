//! The folder of a run of trials: sealed truths, and the result of every case.

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use trials::{
    CaseFailure, CaseResult, CaseSpec, CaseTruth, DiagnosedCase, FleetResult, FleetSpec,
    FleetTruth, FoundFleet, Seal, SealError, TrialPlan,
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
        opened(&path_of(&self.folder, case), |bytes| self.seal.open(case, bytes))
    }

    /// The same of a fleet, by its place among the sealed truths.
    fn open_fleet(&self, fleet: usize, place: usize) -> Result<FleetTruth, Failure> {
        opened(&fleet_path(&self.folder, fleet), |bytes| self.seal.open_fleet(place, bytes))
    }
}

fn opened<T>(path: &Path, open: impl FnOnce(&[u8]) -> Result<T, SealError>) -> Result<T, Failure> {
    let bytes = std::fs::read(path).map_err(|error| Failure::unreadable(path, error))?;
    open(&bytes).map_err(|error| Failure::bad_file(path, error))
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
    let is_of_truth = |known: &CaseResult| known.truth_sha256 == sealed;
    if let Some(known) = finished(&path).filter(is_of_truth) {
        return Ok(known);
    }
    let diagnosed = DiagnosedCase::run(plan, spec)?;
    let result = diagnosed.score(&truths.open(spec.number)?, sealed)?;
    Ok(kept(&path, &result)?)
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
    // Fleets are sealed after all cases.
    let place = truths.cases + spec.number;
    let sealed = truths.seal().hash_of(place);
    let is_of_truth = |known: &FleetResult| known.truth_sha256 == sealed;
    if let Some(known) = finished(&path).filter(is_of_truth) {
        return Ok(known);
    }
    let found = FoundFleet::run(plan, spec)?;
    let result = found.score(&truths.open_fleet(spec.number, place)?, sealed);
    Ok(kept(&path, &result)?)
}

/// The result of an earlier run.
fn finished<T: DeserializeOwned>(path: &Path) -> Option<T> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

/// Writes a result and reads it back as a later run would read it: a run that continues from a folder must arrive at the same
/// bytes.
fn kept<T: Serialize + DeserializeOwned>(path: &Path, result: &T) -> Result<T, Failure> {
    let mut text =
        serde_json::to_string_pretty(result).map_err(|error| Failure::unwritable(path, error))?;
    text.push('\n');
    write_atomically(path, text.as_bytes())?;
    serde_json::from_str(&text).map_err(|error| Failure::bad_file(path, error))
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
