//! Which model a report uses: that of its tail, otherwise that of its type.

use std::path::{Path, PathBuf};

use crate::failure::{Failure, show};
use crate::files::outputs::check_replaceable;
use crate::files::{read_text, write_atomically};
use crate::reading::FlightRead;
use pipeline::model_file::ModelFile;

/// Reads a model file.
///
/// # Errors
/// A file that cannot be read, is not a model, is of a newer format, or whose checksum does not match.
pub(crate) fn read_model(path: &Path) -> Result<ModelFile, Failure> {
    model_of_text(path, &read_text(path)?)
}

/// A model from the bytes of its file.
///
/// # Errors
/// Bytes that are not a model.
pub(crate) fn model_of_bytes(path: &Path, bytes: &[u8]) -> Result<ModelFile, Failure> {
    let text = std::str::from_utf8(bytes)
        .map_err(|_| Failure::bad_file(path, "not a text file (invalid UTF-8)"))?;
    model_of_text(path, text)
}

fn model_of_text(path: &Path, text: &str) -> Result<ModelFile, Failure> {
    ModelFile::from_text(text).map_err(|error| Failure::BadFile {
        path: show(path),
        help: error.help(),
        reason: error.to_string(),
    })
}

/// Writes a model file: whole or not at all.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn write_model(model: &ModelFile, path: &Path) -> Result<(), Failure> {
    let text = model.to_text().map_err(|error| Failure::unwritable(path, error))?;
    write_atomically(path, text.as_bytes())
}

/// Refuses to replace a file that is neither the model to be `written` nor one of the command's own making, which `own`
/// decides.
///
/// # Errors
/// A file that would be lost.
pub(crate) fn check_model_replaceable(
    path: &Path,
    force: bool,
    written: Option<&ModelFile>,
    own: impl FnOnce(&ModelFile) -> bool,
) -> Result<(), Failure> {
    let text = written
        .map_or_else(|| Ok(String::new()), ModelFile::to_text)
        .map_err(|error| Failure::unwritable(path, error))?;
    check_replaceable(path, force, text.as_bytes(), |known| {
        ModelFile::from_text(known).is_ok_and(|known| own(&known))
    })
}

/// Why a report has no model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum NoModel {
    /// Another number of engines than the model's aircraft.
    #[error("found {found} engines, expected {expected} as the model's aircraft has")]
    Engines {
        /// Engines in the report.
        found: usize,
        /// Engines of the aircraft.
        expected: usize,
    },
    /// The tail has a model, which is of another type.
    #[error(
        "found aircraft type {found:?}, expected {expected:?}, the type of tail {tail}'s model"
    )]
    TypeOfTail {
        /// Type in the report.
        found: String,
        /// Type of the model.
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
    /// No model of the type.
    #[error("found aircraft type {found:?}, expected {expected}")]
    Type {
        /// Type in the report.
        found: String,
        /// Types of all models, quoted.
        expected: String,
    },
}

/// The models of a run.
#[derive(Clone, Debug)]
pub(crate) struct Models(Vec<(PathBuf, ModelFile)>);

impl Models {
    /// Reads model files, and those of folders (files ending in `.ron`), in path order.
    ///
    /// # Errors
    /// A file that is not a model, a folder without one, or two models that claim the same tail or, both without a
    /// tail, the same type.
    pub(crate) fn read(arguments: &[PathBuf]) -> Result<Self, Failure> {
        let mut models: Vec<(PathBuf, ModelFile)> = Vec::new();
        for argument in arguments {
            for (path, model) in models_of(argument)? {
                if let Some((other, _)) = models.iter().find(|(_, known)| same_claim(known, &model))
                {
                    return Err(Failure::bad_file(
                        &path,
                        format!("claims {}, as {} does", claim(&model), other.display()),
                    ));
                }
                models.push((path, model));
            }
        }
        Ok(Self(models))
    }

    /// The model for a flight: that of its tail, otherwise that of its type; with as many engines as the report has.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn for_flight(&self, flight: &FlightRead) -> Result<&ModelFile, NoModel> {
        let model =
            self.for_report(&flight.reduced.identity.tail, &flight.reduced.aircraft_type)?;
        check_engines(model, flight)?;
        Ok(model)
    }

    /// The model for a report of this tail and type.
    ///
    /// # Errors
    /// Why there is none.
    pub(crate) fn for_report(
        &self,
        tail: &str,
        aircraft_type: &str,
    ) -> Result<&ModelFile, NoModel> {
        let of_type = |model: &&ModelFile| model.initial.aircraft().type_code() == aircraft_type;
        let all = || self.0.iter().map(|(_, model)| model);
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
            expected: types.iter().map(|t| format!("{t:?}")).collect::<Vec<_>>().join(" or "),
        })
    }
}

/// A flight has as many engines as its model's aircraft.
///
/// # Errors
/// Another number.
pub(crate) fn check_engines(model: &ModelFile, flight: &FlightRead) -> Result<(), NoModel> {
    let expected = model.initial.aircraft().engines();
    match flight.reduced.engines {
        Some(found) if found != expected => Err(NoModel::Engines { found, expected }),
        _ => Ok(()),
    }
}

/// The models behind an argument: a file, a folder that `adapt` wrote (or its folder of models), any other folder.
fn models_of(argument: &Path) -> Result<Vec<(PathBuf, ModelFile)>, Failure> {
    if !argument.is_dir() {
        return Ok(vec![(argument.to_owned(), read_model(argument)?)]);
    }
    let above = argument.file_name().filter(|name| *name == "models").and(argument.parent());
    for folder in std::iter::once(argument).chain(above) {
        // `models` alone has an empty parent, which is the folder that we are in.
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        if let Some(models) = crate::folder::models_of(folder)? {
            return Ok(models);
        }
    }
    let models = files_of(argument)?.into_iter().map(|path| {
        let model = read_model(&path)?;
        Ok((path, model))
    });
    models.collect()
}

fn files_of(argument: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries =
        std::fs::read_dir(argument).map_err(|error| Failure::unreadable(argument, error))?;
    let mut paths = Vec::new();
    for entry in entries {
        let path = entry.map_err(|error| Failure::unreadable(argument, error))?.path();
        if path.extension().is_some_and(|ending| ending == "ron") {
            paths.push(path);
        }
    }
    paths.sort();
    if paths.is_empty() {
        return Err(Failure::bad_file(argument, "a folder without a model file (.ron)"));
    }
    Ok(paths)
}

fn tail_of(model: &ModelFile) -> Option<&str> {
    model.tail()
}

fn same_claim(one: &ModelFile, other: &ModelFile) -> bool {
    match (tail_of(one), tail_of(other)) {
        (Some(one), Some(other)) => one == other,
        (None, None) => one.initial.aircraft().type_code() == other.initial.aircraft().type_code(),
        _ => false,
    }
}

fn claim(model: &ModelFile) -> String {
    match tail_of(model) {
        Some(tail) => format!("tail {tail}"),
        None => format!("type {}", model.initial.aircraft().type_code()),
    }
}
