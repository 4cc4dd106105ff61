//! Model files read and written.

use std::path::{Path, PathBuf};

use crate::failure::{Failure, show};
use crate::files::outputs::{check_no_state, check_replaceable};
use crate::files::{read_text, write_atomically};
use crate::folder::{ModelsFound, waiting_model};
use pipeline::model_file::ModelFile;
use pipeline::models::Models;

/// The file behind an argument that stands for one model: the file itself, or that of a folder's only model.
///
/// # Errors
/// A folder that holds none, several, or a damaged one.
pub(crate) fn file_of_model(path: &Path) -> Result<PathBuf, Failure> {
    if !path.is_dir() {
        return Ok(path.to_owned());
    }
    Ok(only_model_of(path)?.0)
}

/// Reads a model file, or the only model of a folder.
///
/// # Errors
/// A file that cannot be read, is not a model, is of a newer format, or whose checksum does not match; a folder of several.
pub(crate) fn read_model(path: &Path) -> Result<ModelFile, Failure> {
    if !path.is_dir() {
        return match waiting_model(path)? {
            Some(bytes) => model_of_bytes(path, &bytes),
            None => model_of_text(path, &read_text(path)?),
        };
    }
    Ok(only_model_of(path)?.1)
}

fn only_model_of(folder: &Path) -> Result<(PathBuf, ModelFile), Failure> {
    let ModelsFound { mut models, damaged } = models_of(folder)?;
    if let Some((_, failure)) = damaged.into_iter().next() {
        return Err(failure);
    }
    match models.pop() {
        Some(only) if models.is_empty() => Ok(only),
        Some((last, _)) => {
            let reason =
                format!("{} models; one is needed here, such as {}", models.len() + 1, show(&last));
            Err(Failure::bad_file(folder, reason))
        }
        None => Err(Failure::bad_file(folder, "a folder without a model")),
    }
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
    ModelFile::from_text(text).map_err(|error| match other_kind(text) {
        // Of another file nothing is damaged or cut off.
        Some(help) => Failure::BadFile {
            path: show(path),
            reason: "not a model file".to_owned(),
            help: Some(help),
        },
        None => {
            Failure::BadFile { path: show(path), help: error.help(), reason: error.to_string() }
        }
    })
}

/// What a text is that is no model, where it is of a kind that this program reads or writes.
fn other_kind(text: &str) -> Option<String> {
    let fields =
        || text.lines().map(str::trim).map(|line| line.split_once(':').map(|(key, _)| key));
    let has = |wanted: &str| fields().any(|key| key == Some(wanted));
    // A model, however damaged, has the aircraft and its guide in one file.
    if text.lines().any(|line| line.trim() == "(" || line.starts_with('('))
        && !has("drag_coefficient")
    {
        if has("quantities") && has("time") {
            return Some(kind_words("a mapping"));
        }
        if has("wing_area_m2") && has("type_code") && !has("format") {
            return Some(kind_words("an aircraft file"));
        }
    }
    let kind = match text.trim_start().chars().next()? {
        '{' => "a JSON document",
        '<' => "a page (HTML) or a picture",
        _ if text.starts_with("CRUISE-REPORT") => "a cruise report",
        '(' => return None,
        _ if text.lines().next()?.contains([',', ';', '\t']) => "a table (CSV)",
        _ => return None,
    };
    Some(kind_words(kind))
}

fn kind_words(kind: &str) -> String {
    format!("this is {kind}; models are the .ron files that `init` and `adapt` write")
}

/// Writes a model file: whole or not at all.
///
/// # Errors
/// A file that cannot be written, or that a folder has learnt.
pub(crate) fn write_model(model: &ModelFile, path: &Path) -> Result<(), Failure> {
    check_no_state(path)?;
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

/// The models behind arguments: files and folders.
///
/// # Errors
/// A file that cannot be read or is not a model; two that claim the same tail, or, both without a tail, the same type.
pub(crate) fn read_models(arguments: &[PathBuf]) -> Result<Models, Failure> {
    let mut found = ModelsFound::default();
    for argument in arguments {
        let ModelsFound { models, damaged } = models_of(argument)?;
        found.models.extend(models);
        found.damaged.extend(damaged);
    }
    // A tail costs itself, unless there is nothing else.
    if found.models.is_empty()
        && let Some((_, failure)) = found.damaged.pop()
    {
        return Err(failure);
    }
    let models = Models::new(found.models).map_err(|same| Failure::bad_file(&same.path, &same))?;
    let damaged = found.damaged.into_iter().map(|(tail, failure)| (tail, failure.to_string()));
    Ok(models.with_damaged(damaged.collect()))
}

/// The models behind an argument: a file, a folder that `adapt` wrote (or its folder of models), any other folder.
fn models_of(argument: &Path) -> Result<ModelsFound, Failure> {
    let whole = |models| ModelsFound { models, damaged: Vec::new() };
    if !argument.is_dir() {
        return Ok(whole(vec![(argument.to_owned(), read_model(argument)?)]));
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
    models.collect::<Result<_, _>>().map(whole)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// An intact file of another kind is not a damaged model; a model that is cut off is.
    #[test]
    fn other_kinds_of_files_are_named() {
        let mapping = "(\n    format: 1,\n    time: Seconds(),\n    quantities: {\n    },\n)\n";
        let aircraft = "// Of no tail.\n(\n    name: \"A\",\n    type_code: \"A320\", engines: 2,\n    wing_area_m2: 122.6,\n)\n";
        for (text, kind) in [
            (mapping, "this is a mapping"),
            (aircraft, "this is an aircraft file"),
            ("a;b\n1;2\n", "this is a table"),
            ("a,b\n1,2\n", "this is a table"),
        ] {
            let found = model_of_text(Path::new("x"), text).unwrap_err();
            let Failure::BadFile { reason, help, .. } = found else { panic!("{found:?}") };
            assert_eq!(reason, "not a model file");
            assert!(help.unwrap().starts_with(kind), "{text}");
        }
        let cut = "(\n    format: 5,\n    aircraft: (\n        type_code: \"A320\",\n        wing_area_m2: 122.6,\n";
        let found = model_of_text(Path::new("x"), cut).unwrap_err();
        assert!(found.to_string().contains("cut off"), "{found}");
    }
}
