//! Which files a command reads: files, folders and globs, in an order that does not depend on how they were given.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use pipeline::summary::other_files_words;

use crate::failure::{Failure, RefusedReport, show};
use crate::files::standard_input;

/// The files to read, sorted and without repetition, and how many others were skipped.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Inputs {
    /// Files, in path order.
    pub(crate) files: Vec<PathBuf>,
    /// Files in folders whose ending is not that of a report.
    pub(crate) skipped: usize,
    /// Folders that cannot be listed.
    pub(crate) refused: Vec<RefusedReport>,
}

/// What was collected so far.
#[derive(Debug, Default)]
struct Collected {
    files: Vec<PathBuf>,
    skipped: usize,
    refused: Vec<RefusedReport>,
    /// Folders that were searched, whatever the links that led there: a link may lead back to a folder above it.
    searched: BTreeSet<PathBuf>,
}

/// Endings of a folder's files that are read.
const REPORT_ENDINGS: [&str; 3] = ["txt", "rpt", "gz"];
/// Endings of a folder's files that are read when a mapping file is given.
const RECORDING_ENDINGS: [&str; 8] =
    ["csv", "gz", "zst", "parquet", "arrow", "arrows", "feather", "ipc"];

/// Collects the files behind arguments: a file is taken as it is, a folder is searched recursively for files with a
/// report's ending, anything else is tried as a glob. `mapping` is the one in force, by its name: then a folder is searched for
/// recordings, and for cruise reports where it holds none.
///
/// # Errors
/// An argument that matches nothing, or no file at all.
pub(crate) fn collect(arguments: &[PathBuf], mapping: Option<&str>) -> Result<Inputs, Failure> {
    let all_with = |endings: &[&str]| {
        let mut collected = Collected::default();
        for argument in arguments {
            collect_one(argument, endings, &mut collected)?;
        }
        Ok::<_, Failure>(collected)
    };
    let endings: &[&str] = if mapping.is_some() { &RECORDING_ENDINGS } else { &REPORT_ENDINGS };
    let mut collected = all_with(endings)?;
    if mapping.is_some() && collected.files.is_empty() {
        let mut reports = all_with(&REPORT_ENDINGS)?;
        let found = reports.files.len();
        reports.files.retain(|path| crate::reading::is_cruise_report(path));
        reports.skipped += found - reports.files.len();
        collected = reports;
    }
    let Collected { mut files, skipped, refused, .. } = collected;
    // Equal paths are one file: their order among each other is nothing, and a stable sort takes half of the list again.
    files.sort_unstable();
    files.dedup();
    if files.is_empty() {
        crate::terminal::tell_refused(&refused);
        let inputs: Vec<String> = arguments.iter().map(|path| show(path)).collect();
        let skipped = other_files_words(skipped);
        let inputs = inputs.join(", ");
        return Err(match mapping {
            None => Failure::NoReports { inputs, skipped },
            Some(mapping) => Failure::NoRecordings { inputs, skipped, mapping: mapping.to_owned() },
        });
    }
    if skipped > 0 {
        tracing::info!(skipped, "files skipped: their endings are not those of reports");
    }
    Ok(Inputs { files, skipped, refused })
}

fn collect_one(
    argument: &Path,
    endings: &[&str],
    collected: &mut Collected,
) -> Result<(), Failure> {
    if argument.is_dir() {
        // A folder that was named has to be there; those below it may be unreadable.
        std::fs::read_dir(argument).map_err(|error| Failure::unreadable(argument, error))?;
        collect_folder(argument, endings, collected);
        return Ok(());
    }
    if argument.exists() || standard_input::is_meant(argument) {
        collected.files.push(argument.to_owned());
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
            collect_folder(&path, endings, collected);
        } else {
            collected.files.push(path);
        }
    }
    if any { Ok(()) } else { Err(Failure::unreadable(argument, "the pattern matches no file")) }
}

/// Whether a folder is one of those in which a folder of `adapt` keeps what it has learnt: its tables are no recordings.
fn is_result_of_adapt(path: &Path) -> bool {
    crate::folder::is_kept_by_a_state(path)
}

fn collect_folder(folder: &Path, endings: &[&str], collected: &mut Collected) {
    let listed = folder.canonicalize().and_then(|real| {
        if !collected.searched.insert(real) {
            return Ok(Vec::new());
        }
        let mut entries = Vec::new();
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            entries.push((entry.path(), entry.file_type()?));
        }
        entries.sort_by(|one, other| one.0.cmp(&other.0));
        Ok(entries)
    });
    let entries = match listed {
        Ok(entries) => entries,
        Err(error) => {
            collected.refused.push(RefusedReport::whole(folder.to_owned(), error));
            return;
        }
    };
    for (path, kind) in entries {
        let is_folder = kind.is_dir() || (kind.is_symlink() && path.is_dir());
        if is_folder && is_result_of_adapt(&path) {
            continue;
        }
        if is_folder {
            collect_folder(&path, endings, collected);
        } else if path
            .extension()
            .is_some_and(|ending| endings.iter().any(|known| ending.eq_ignore_ascii_case(known)))
        {
            collected.files.push(path);
        } else {
            collected.skipped += 1;
        }
    }
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
        let inputs = collect(&[folder.path().to_owned()], None).unwrap();
        assert_eq!(inputs.files.len(), 3);
        assert_eq!(inputs.skipped, 2);
        let globbed = collect(&[folder.path().join("a/*/*.txt")], None).unwrap();
        assert_eq!(globbed.files, [deep.join("2.txt")]);
        // The same file given twice, under two names of the same path, is read once.
        let twice = collect(&[deep.join("2.txt"), deep.clone()], None).unwrap();
        assert_eq!(twice.files.len(), 1);
    }

    /// What `convert` wrote is read as what it is; other texts are no recordings, and the mapping in force is named.
    #[test]
    fn with_a_mapping_reports_are_found_where_no_recording_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("notes.txt"), "CRUISE").unwrap();
        let failure = collect(&[folder.path().to_owned()], Some("qar.ron")).unwrap_err();
        let text = failure.to_string();
        assert!(text.starts_with("no recording in ") && text.contains("qar.ron"), "{text}");
        assert!(text.contains("1 other file skipped"), "{text}");
        std::fs::write(path("1.txt"), "CRUISE-REPORT 1\n").unwrap();
        let inputs = collect(&[folder.path().to_owned()], Some("qar.ron")).unwrap();
        assert_eq!((inputs.files, inputs.skipped), (vec![path("1.txt")], 1));
        std::fs::write(path("a.csv"), "x").unwrap();
        let inputs = collect(&[folder.path().to_owned()], Some("qar.ron")).unwrap();
        assert_eq!((inputs.files, inputs.skipped), (vec![path("a.csv")], 2));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_a_folder_above_is_not_followed_for_ever() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("1.txt"), "x").unwrap();
        for name in ["a", "b"] {
            std::os::unix::fs::symlink(".", folder.path().join(name)).unwrap();
        }
        let inputs = collect(&[folder.path().to_owned()], None).unwrap();
        assert_eq!(inputs.files, [folder.path().join("1.txt")]);
    }

    #[test]
    fn an_empty_folder_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let failure = collect(&[folder.path().to_owned()], None).unwrap_err();
        assert!(failure.to_string().starts_with("no cruise report in "), "{failure}");
        let missing = collect(&[folder.path().join("nothing.txt")], None).unwrap_err();
        assert!(missing.to_string().ends_with("no such file or folder"), "{missing}");
    }
}
