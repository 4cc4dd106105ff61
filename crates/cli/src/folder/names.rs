//! Tails whose files would be one file, where names that differ only in case are the same (Windows, macOS).

use std::collections::BTreeSet;
use std::path::Path;

use crate::failure::{Failure, show};
use crate::files::{TEMPORARY, file_stem_of_tail};

/// Refuses tails that would share a file in this folder.
///
/// # Errors
/// Two tails whose names differ only in case, on a file system that does not distinguish them; a folder that cannot be
/// written.
pub(crate) fn check(folder: &Path, tails: &BTreeSet<String>) -> Result<(), Failure> {
    let Some((one, other)) = alike_but_for_case(tails) else { return Ok(()) };
    if ignores_case(folder).map_err(|error| Failure::unwritable(folder, error))? {
        return Err(Failure::SameFile {
            folder: show(folder),
            one: one.to_owned(),
            other: other.to_owned(),
        });
    }
    Ok(())
}

/// The first two tails whose files have the same name but for the case of letters.
fn alike_but_for_case(tails: &BTreeSet<String>) -> Option<(&str, &str)> {
    let mut known = std::collections::BTreeMap::new();
    tails.iter().find_map(|tail| {
        let earlier = known.insert(file_stem_of_tail(tail).to_lowercase(), tail.as_str());
        earlier.map(|earlier| (earlier, tail.as_str()))
    })
}

/// Whether a file is found under its name in capitals: asked of the file system, since each may be mounted either way.
fn ignores_case(folder: &Path) -> std::io::Result<bool> {
    let probe = tempfile::Builder::new().prefix(TEMPORARY).suffix(".tmp").tempfile_in(folder)?;
    let name = probe.path().file_name().unwrap_or_default().to_string_lossy().to_uppercase();
    Ok(folder.join(name).exists())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tails(names: &[&str]) -> BTreeSet<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn tails_that_differ_in_case_alone() {
        assert_eq!(alike_but_for_case(&tails(&["D-ABCD", "D-ABCE"])), None);
        assert_eq!(
            alike_but_for_case(&tails(&["SIM-01", "X", "sim-01"])),
            Some(("SIM-01", "sim-01"))
        );
        // A character that becomes %2E in a file's name, against its own escape written out.
        assert_eq!(alike_but_for_case(&tails(&["a.b", "A.B"])), Some(("A.B", "a.b")));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn where_case_counts_both_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        assert!(!ignores_case(folder.path()).unwrap());
        check(folder.path(), &tails(&["SIM-01", "sim-01"])).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
