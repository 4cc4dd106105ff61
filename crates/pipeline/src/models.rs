//! Which model a report uses: that of its tail, otherwise that of its type.

mod of_one_tail;

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::model_file::ModelFile;
use crate::reading::FlightRead;

pub use of_one_tail::{OfOneModel, ReportsByModel};

/// The type of a flight whose source states none: it uses the model of its tail, or the only one there is.
pub const TYPE_NOT_STATED: &str = "";

/// Why a report has no model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoModel {
    /// Another number of engines than the model's aircraft.
    #[error("found {found} engines, expected {expected} as the model's aircraft has")]
    Engines {
        /// Engines in the report.
        found: usize,
        /// Engines of the aircraft.
        expected: usize,
    },
    /// The tail is of another type: by its model, or by its other reports.
    #[error("found aircraft type {found:?}, expected {expected:?}, the type of tail {tail}")]
    TypeOfTail {
        /// Type in the report.
        found: String,
        /// Type of the tail.
        expected: String,
        /// The tail.
        tail: String,
    },
    /// Several models of the type, none of them the tail's.
    #[error(
        "found tail {tail:?}, expected a tail that one of the models has learnt, or one model of type {aircraft_type:?} for all others"
    )]
    Several {
        /// Tail in the report.
        tail: String,
        /// Its type.
        aircraft_type: String,
    },
    /// The tail's own model cannot be read.
    #[error("tail {tail} has no model: {reason}")]
    Damaged {
        /// The tail.
        tail: String,
        /// What is wrong with its file.
        reason: String,
    },
    /// Effects were applied to the model that are another tail's.
    #[error(
        "the model has effects of tail {of} applied to it, which are not tail {tail}'s: use the model before they were applied"
    )]
    EffectsOfOtherTail {
        /// Tail in the report.
        tail: String,
        /// Tail whose diagnosis was applied.
        of: String,
    },
    /// No type, and several models.
    #[error(
        "found a flight of tail {tail:?} without aircraft type, expected one model, or one that has learnt from the tail"
    )]
    TypeNotStated {
        /// Tail.
        tail: String,
    },
    /// No model of the type.
    #[error("found aircraft type {found:?}, expected {expected}{}", placeholder_words(found))]
    Type {
        /// Type in the report.
        found: String,
        /// Types of all models, quoted.
        expected: String,
    },
}

/// What a first mapping writes where no column holds the type is none.
fn placeholder_words(found: &str) -> &'static str {
    if found == report::mapping::NO_TYPE {
        ": the mapping states no type yet (aircraft: Text(…), or the column that holds it)"
    } else {
        ""
    }
}

/// Two models that claim the same tail or, both without a tail, the same type.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("claims {claim}, as {} does", other.display())]
pub struct SameClaim {
    /// The later model.
    pub path: PathBuf,
    /// What both claim.
    pub claim: String,
    /// The earlier model.
    pub other: PathBuf,
}

/// The models of a run, each with its file, or what its caller calls it.
#[derive(Clone, Debug)]
pub struct Models {
    models: Vec<(PathBuf, ModelFile)>,
    /// Tails whose models cannot be read, and why.
    damaged: BTreeMap<String, String>,
}

impl Models {
    /// Models of which no two claim the same tail or type.
    ///
    /// # Errors
    /// Two that do.
    pub fn new(given: Vec<(PathBuf, ModelFile)>) -> Result<Self, SameClaim> {
        let mut models: Vec<(PathBuf, ModelFile)> = Vec::with_capacity(given.len());
        let mut claims: BTreeMap<(bool, String), usize> = BTreeMap::new();
        for (path, model) in given {
            let key = (tail_of(&model).is_some(), claimed(&model).to_owned());
            if let Some(known) = claims.get(&key) {
                let claim = claim(&model);
                return Err(SameClaim { path, claim, other: models[*known].0.clone() });
            }
            claims.insert(key, models.len());
            models.push((path, model));
        }
        Ok(Self { models, damaged: BTreeMap::new() })
    }

    /// With tails whose models cannot be read, each with the reason: no other model stands in for theirs.
    #[must_use]
    pub fn with_damaged(self, damaged: BTreeMap<String, String>) -> Self {
        Self { damaged, ..self }
    }

    /// The model for a flight: that of its tail, otherwise that of its type; with as many engines as the report has.
    ///
    /// # Errors
    /// Why there is none.
    pub fn for_flight(&self, flight: &FlightRead) -> Result<&ModelFile, NoModel> {
        let model =
            self.for_report(&flight.reduced.identity.tail, &flight.reduced.aircraft_type)?;
        check_engines(model, flight)?;
        Ok(model)
    }

    /// The model that a tail of this type begins to learn with: as [`for_report`](Self::for_report), without effects of another
    /// tail.
    ///
    /// # Errors
    /// Why there is none.
    pub fn to_begin_with(&self, tail: &str, aircraft_type: &str) -> Result<&ModelFile, NoModel> {
        let model = self.for_report(tail, aircraft_type)?;
        match model.tail_of_effects().filter(|of| *of != tail) {
            Some(of) => {
                Err(NoModel::EffectsOfOtherTail { tail: tail.to_owned(), of: of.to_owned() })
            }
            None => Ok(model),
        }
    }

    fn first_type(&self) -> &str {
        self.models.first().map_or("", |(_, model)| model.initial.aircraft().type_code())
    }

    /// The model for a report of this tail and type.
    ///
    /// # Errors
    /// Why there is none.
    pub fn for_report(&self, tail: &str, aircraft_type: &str) -> Result<&ModelFile, NoModel> {
        let of_type = |model: &&ModelFile| {
            aircraft_type == TYPE_NOT_STATED
                || model.initial.aircraft().type_code() == aircraft_type
        };
        if let Some(reason) = self.damaged.get(tail) {
            return Err(NoModel::Damaged { tail: tail.to_owned(), reason: reason.clone() });
        }
        let all = || self.models.iter().map(|(_, model)| model);
        if let Some(model) = all().find(|model| tail_of(model) == Some(tail)) {
            return if of_type(&model) {
                Ok(model)
            } else {
                Err(NoModel::TypeOfTail {
                    found: aircraft_type.to_owned(),
                    expected: model.initial.aircraft().type_code().to_owned(),
                    tail: tail.to_owned(),
                })
            };
        }
        let is_type_open = aircraft_type == TYPE_NOT_STATED
            && all().any(|m| m.initial.aircraft().type_code() != self.first_type());
        if is_type_open {
            return Err(NoModel::TypeNotStated { tail: tail.to_owned() });
        }
        if let Some(model) = all().filter(of_type).find(|model| tail_of(model).is_none()) {
            return Ok(model);
        }
        // The only model of the type also serves a tail that it has not learnt from: that is the model to compare it
        // with.
        let mut others = all().filter(of_type);
        if let Some(model) = others.next() {
            return match others.next() {
                None => Ok(model),
                Some(_) => Err(NoModel::Several {
                    tail: tail.to_owned(),
                    aircraft_type: aircraft_type.to_owned(),
                }),
            };
        }
        let mut types: Vec<&str> = all().map(|m| m.initial.aircraft().type_code()).collect();
        types.sort_unstable();
        types.dedup();
        Err(NoModel::Type {
            found: aircraft_type.to_owned(),
            expected: if types.is_empty() {
                "a model: there is none".to_owned()
            } else {
                types.iter().map(|t| format!("{t:?}")).collect::<Vec<_>>().join(" or ")
            },
        })
    }
}

/// A flight has as many engines as its model's aircraft.
///
/// # Errors
/// Another number.
pub fn check_engines(model: &ModelFile, flight: &FlightRead) -> Result<(), NoModel> {
    let expected = model.initial.aircraft().engines();
    match flight.reduced.engines {
        Some(found) if found != expected => Err(NoModel::Engines { found, expected }),
        _ => Ok(()),
    }
}

fn tail_of(model: &ModelFile) -> Option<&str> {
    model.tail()
}

/// The tail, or the type of a model without one.
fn claimed(model: &ModelFile) -> &str {
    tail_of(model).unwrap_or_else(|| model.initial.aircraft().type_code())
}

fn claim(model: &ModelFile) -> String {
    let what = if tail_of(model).is_some() { "tail" } else { "type" };
    format!("{what} {}", claimed(model))
}
