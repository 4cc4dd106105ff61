//! The truth of every case on disk, sealed by its hash before the first diagnosis begins.

use std::path::{Path, PathBuf};

use diagnose::trial::Planted;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use simulate::EffectTruth;

use super::plan::{Background, Denied, Kind};
use crate::failure::{Failure, show};
use crate::files::{make_folder, write_atomically};
use crate::model_file::hex;

/// Schema of a case's truth.
pub(super) const SEALED_SCHEMA: &str = "cruisefit.trial-truth/1";

/// What was planted in one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseTruth {
    /// Always `cruisefit.trial-truth/1`.
    pub schema: String,
    /// Number of the case.
    pub case: usize,
    /// Which model was denied it.
    pub denied: Denied,
    /// On which background.
    pub background: Background,
    /// What kind of case.
    pub kind: Kind,
    /// Size over the typical size.
    pub times: f64,
    /// Names struck from the library.
    pub struck: Vec<String>,
    /// What was planted, sizes in each effect's unit.
    pub effects: Vec<EffectTruth>,
    /// What was there besides, small.
    pub clutter: Vec<EffectTruth>,
}

impl CaseTruth {
    /// As the scorer wants it.
    pub fn planted(&self) -> Planted {
        Planted {
            effects: self.effects.iter().map(|e| (e.id.to_string(), e.size)).collect(),
            struck: self.struck.clone(),
        }
    }
}

/// Truths on disk, and the hash of each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seal {
    folder: PathBuf,
    hashes: Vec<String>,
}

impl Seal {
    /// Writes the truths of all cases, in the order of their numbers, below `DIR/truth`. Truths that are there already
    /// must be the same bytes: then the run goes on from what it had.
    ///
    /// # Errors
    /// A place that cannot be written; a folder whose truths are others.
    pub fn write(folder: &Path, truths: &[CaseTruth]) -> Result<Self, Failure> {
        let folder = folder.join("truth");
        make_folder(&folder)?;
        let mut hashes = Vec::with_capacity(truths.len());
        for truth in truths {
            let path = path_of(&folder, truth.case);
            let mut text = serde_json::to_string_pretty(truth)
                .map_err(|error| Failure::unwritable(&path, error))?;
            text.push('\n');
            match std::fs::read(&path) {
                Ok(bytes) if bytes == text.as_bytes() => {}
                Ok(_) => {
                    return Err(Failure::BegunOtherwise {
                        folder: show(&folder),
                        what: "truth",
                        difference: format!(
                            "case {}: another version of the program drew it, or the file was changed",
                            truth.case
                        ),
                    });
                }
                Err(_) => write_atomically(&path, text.as_bytes())?,
            }
            hashes.push(hash(text.as_bytes()));
        }
        Ok(Self { folder, hashes })
    }

    /// The hash over the hashes of all cases, hexadecimal: what is told before the first diagnosis.
    pub fn hash(&self) -> String {
        hash(self.hashes.join("\n").as_bytes())
    }

    /// The hash of a case's truth; empty for a case that is none.
    pub fn hash_of(&self, case: usize) -> &str {
        case.checked_sub(1).and_then(|index| self.hashes.get(index)).map_or("", String::as_str)
    }

    /// Opens the truth of a case, for the scorer.
    ///
    /// # Errors
    /// A file that cannot be read, or is no longer what was sealed.
    pub fn open(&self, case: usize) -> Result<CaseTruth, Failure> {
        let path = path_of(&self.folder, case);
        let bytes = std::fs::read(&path).map_err(|error| Failure::unreadable(&path, error))?;
        let found = hash(&bytes);
        if found != self.hash_of(case) {
            return Err(Failure::bad_file(
                &path,
                format!("its hash is {found}, sealed was {}", self.hash_of(case)),
            ));
        }
        serde_json::from_slice(&bytes).map_err(|error| Failure::bad_file(&path, error))
    }
}

fn path_of(folder: &Path, case: usize) -> PathBuf {
    folder.join(format!("{case:05}.json"))
}

fn hash(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(case: usize, times: f64) -> CaseTruth {
        CaseTruth {
            schema: SEALED_SCHEMA.to_owned(),
            case,
            denied: Denied::Exact,
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
        let seal = Seal::write(folder.path(), &[truth(1, 1.0), truth(2, 0.5)]).unwrap();
        assert_eq!(seal.open(2).unwrap(), truth(2, 0.5));
        // The same again is the same seal; another truth in the same place is refused.
        assert_eq!(Seal::write(folder.path(), &[truth(1, 1.0), truth(2, 0.5)]).unwrap(), seal);
        assert!(Seal::write(folder.path(), &[truth(1, 1.0), truth(2, 0.6)]).is_err());
        let path = folder.path().join("truth/00002.json");
        let text = std::fs::read_to_string(&path).unwrap().replace("0.5", "0.6");
        std::fs::write(&path, text).unwrap();
        let error = seal.open(2).unwrap_err().to_string();
        assert!(error.contains("sealed was"), "{error}");
        assert!(seal.open(1).is_ok());
    }

    #[test]
    fn the_hash_is_sha_256_of_the_bytes() {
        // FIPS 180-2, appendix B.1: SHA-256 of "abc".
        assert_eq!(
            hash(b"abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }
}
