//! Which files a command reads: files, folders and globs, in an order that does not depend on how they were given.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::failure::{Failure, show};

/// The files to read, sorted and without repetition, and how many others were skipped.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Inputs {
    /// Files, in path order.
    pub(crate) files: Vec<PathBuf>,
    /// Files in folders whose ending is not that of a report.
    pub(crate) skipped: usize,
}

/// Endings of a folder's files that are read.
const REPORT_ENDINGS: [&str; 3] = ["txt", "rpt", "gz"];
/// Endings of a folder's files that are read when a mapping file is given.
const RECORDING_ENDINGS: [&str; 2] = ["csv", "gz"];

/// Collects the files behind arguments: a file is taken as it is, a folder is searched recursively for files with a
/// report's ending, anything else is tried as a glob.
///
/// # Errors
/// An argument that matches nothing, a folder that cannot be listed, or no file at all.
pub(crate) fn collect(arguments: &[PathBuf], with_mapping: bool) -> Result<Inputs, Failure> {
    let endings: &[&str] = if with_mapping { &RECORDING_ENDINGS } else { &REPORT_ENDINGS };
    let mut files = BTreeSet::new();
    let mut skipped = 0;
    for argument in arguments {
        collect_one(argument, endings, &mut files, &mut skipped)?;
    }
    if files.is_empty() {
        let inputs: Vec<String> = arguments.iter().map(|path| show(path)).collect();
        return Err(Failure::NoReports {
            inputs: inputs.join(", "),
            skipped: match skipped {
                0 => String::new(),
                1 => ", 1 other file skipped".to_owned(),
                n => format!(", {n} other files skipped"),
            },
        });
    }
    Ok(Inputs { files: files.into_iter().collect(), skipped })
}

fn collect_one(
    argument: &Path,
    endings: &[&str],
    files: &mut BTreeSet<PathBuf>,
    skipped: &mut usize,
) -> Result<(), Failure> {
    if argument.is_dir() {
        return collect_folder(argument, endings, files, skipped);
    }
    if argument.exists() {
        files.insert(argument.to_owned());
        return Ok(());
    }
    let pattern = argument.to_string_lossy();
    if !pattern.contains(['*', '?', '[']) {
        return Err(Failure::unreadable(argument, "no such file or folder"));
    }
    let matches = glob::glob(&pattern).map_err(|error| Failure::unreadable(argument, error))?;
    let mut any = false;
    for entry in matches {
        let path = entry.map_err(|error| Failure::unreadable(error.path(), error.error()))?;
        any = true;
        if path.is_dir() {
            collect_folder(&path, endings, files, skipped)?;
        } else {
            files.insert(path);
        }
    }
    if any { Ok(()) } else { Err(Failure::unreadable(argument, "the pattern matches no file")) }
}

fn collect_folder(
    folder: &Path,
    endings: &[&str],
    files: &mut BTreeSet<PathBuf>,
    skipped: &mut usize,
) -> Result<(), Failure> {
    let entries = std::fs::read_dir(folder).map_err(|error| Failure::unreadable(folder, error))?;
    let mut paths = Vec::new();
    for entry in entries {
        paths.push(entry.map_err(|error| Failure::unreadable(folder, error))?.path());
    }
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect_folder(&path, endings, files, skipped)?;
        } else if path
            .extension()
            .is_some_and(|ending| endings.iter().any(|known| ending.eq_ignore_ascii_case(known)))
        {
            files.insert(path);
        } else {
            *skipped += 1;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_searched_and_other_files_counted() {
        let folder = tempfile::tempdir().unwrap();
        let deep = folder.path().join("a/b");
        std::fs::create_dir_all(&deep).unwrap();
        for name in ["a/b/2.txt", "a/1.RPT", "a/3.txt.gz", "readme.md", "a/x.csv"] {
            std::fs::write(folder.path().join(name), "x").unwrap();
        }
        let inputs = collect(&[folder.path().to_owned()], false).unwrap();
        assert_eq!(inputs.files.len(), 3);
        assert_eq!(inputs.skipped, 2);
        let globbed = collect(&[folder.path().join("a/*/*.txt")], false).unwrap();
        assert_eq!(globbed.files, [deep.join("2.txt")]);
        // The same file given twice, under two names of the same path, is read once.
        let twice = collect(&[deep.join("2.txt"), deep.clone()], false).unwrap();
        assert_eq!(twice.files.len(), 1);
    }

    #[test]
    fn an_empty_folder_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let failure = collect(&[folder.path().to_owned()], false).unwrap_err();
        assert!(failure.to_string().starts_with("no cruise report in "), "{failure}");
        let missing = collect(&[folder.path().join("nothing.txt")], false).unwrap_err();
        assert!(missing.to_string().ends_with("no such file or folder"), "{missing}");
    }
}
