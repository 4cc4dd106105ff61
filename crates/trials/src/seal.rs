//! The truth of every case, sealed by its hash before the first diagnosis begins.

use pipeline::checksum::sha256;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use simulate::EffectTruth;

use crate::fleets::FleetTruth;
use crate::plan::{Background, Kind, ReferenceModel};
use crate::scored_case::Planted;

/// Schema of a case's truth.
pub(crate) const SEALED_SCHEMA: &str = "cruisefit.trial-truth/1";

/// What was planted in one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseTruth {
    /// Always `cruisefit.trial-truth/1`.
    pub schema: String,
    /// Number of the case.
    pub case: usize,
    /// Which model it is held against.
    #[serde(rename = "denied")]
    pub reference_model: ReferenceModel,
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
    /// The text that is sealed, with a final line end.
    ///
    /// # Errors
    /// None that is known: what JSON refuses to write.
    pub fn to_text(&self) -> Result<String, serde_json::Error> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        Ok(text)
    }

    /// As the scorer wants it.
    pub fn planted(&self) -> Planted {
        Planted {
            effects: self.effects.iter().map(|e| (e.id.to_string(), e.size)).collect(),
            struck: self.struck.clone(),
        }
    }
}

/// The hash of every case's truth, in the order of their numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seal {
    hashes: Vec<String>,
}

impl Seal {
    /// Seals the texts of all truths ([`CaseTruth::to_text`]), in the order of their numbers.
    #[must_use]
    pub fn of_texts<'a>(texts: impl IntoIterator<Item = &'a str>) -> Self {
        Self { hashes: texts.into_iter().map(|text| sha256(text.as_bytes())).collect() }
    }

    /// The hash over the hashes of all cases, hexadecimal: what is printed before the first diagnosis.
    #[must_use]
    pub fn hash(&self) -> String {
        sha256(self.hashes.join("\n").as_bytes())
    }

    /// The hash of a case's truth; empty for an unknown case.
    #[must_use]
    pub fn hash_of(&self, case: usize) -> &str {
        case.checked_sub(1).and_then(|index| self.hashes.get(index)).map_or("", String::as_str)
    }

    /// Opens the truth of a case from its bytes, for the scorer.
    ///
    /// # Errors
    /// Bytes that are no longer what was sealed.
    pub fn open(&self, case: usize, bytes: &[u8]) -> Result<CaseTruth, SealError> {
        self.open_as(case, bytes)
    }

    /// Opens the truth of a fleet: fleets are sealed after all cases, `place` being cases and the fleet's number together.
    ///
    /// # Errors
    /// As of a case.
    pub fn open_fleet(&self, place: usize, bytes: &[u8]) -> Result<FleetTruth, SealError> {
        self.open_as(place, bytes)
    }

    fn open_as<T: DeserializeOwned>(&self, place: usize, bytes: &[u8]) -> Result<T, SealError> {
        let found = sha256(bytes);
        if found != self.hash_of(place) {
            return Err(SealError::Broken { found, sealed: self.hash_of(place).to_owned() });
        }
        Ok(serde_json::from_slice(bytes)?)
    }
}

/// Why a truth cannot be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SealError {
    /// The bytes are not those that were sealed.
    #[error("its hash is {found}, sealed was {sealed}")]
    Broken {
        /// SHA-256 of the bytes.
        found: String,
        /// SHA-256 of what was sealed.
        sealed: String,
    },
    /// Sealed, but no truth of a case.
    #[error(transparent)]
    Text(#[from] serde_json::Error),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth(case: usize, times: f64) -> CaseTruth {
        CaseTruth {
            schema: SEALED_SCHEMA.to_owned(),
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
        let texts = [truth(1, 1.0), truth(2, 0.5)].map(|truth| truth.to_text().unwrap());
        let seal = Seal::of_texts(texts.iter().map(String::as_str));
        assert_eq!(seal.open(2, texts[1].as_bytes()).unwrap(), truth(2, 0.5));
        // The same again is the same seal; another truth is another one.
        assert_eq!(Seal::of_texts(texts.iter().map(String::as_str)), seal);
        let changed = texts[1].replace("0.5", "0.6");
        assert_ne!(Seal::of_texts([texts[0].as_str(), changed.as_str()]).hash(), seal.hash());
        let error = seal.open(2, changed.as_bytes()).unwrap_err().to_string();
        assert!(error.contains("sealed was"), "{error}");
        assert!(seal.open(1, texts[0].as_bytes()).is_ok());
    }
}
