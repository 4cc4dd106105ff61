//! `-` as a file to read: standard input, kept in a temporary file because readers look at a file more than once.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::NamedTempFile;

/// What was read from standard input in this run.
static KEPT: Mutex<Option<NamedTempFile>> = Mutex::new(None);

/// Whether an argument stands for standard input.
pub(crate) fn is_meant(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// The file to open for a path: itself, or what standard input held.
///
/// # Errors
/// Standard input that cannot be read, or no room for it.
pub(crate) fn file(path: &Path) -> std::io::Result<Cow<'_, Path>> {
    if !is_meant(path) {
        return Ok(Cow::Borrowed(path));
    }
    kept_of(&mut std::io::stdin().lock(), &mut KEPT.lock().unwrap_or_else(PoisonError::into_inner))
        .map(Cow::Owned)
}

/// Removes what was kept.
pub(crate) fn forget() {
    drop(KEPT.lock().unwrap_or_else(PoisonError::into_inner).take());
}

fn kept_of(
    input: &mut impl std::io::Read,
    kept: &mut Option<NamedTempFile>,
) -> std::io::Result<PathBuf> {
    if let Some(file) = kept {
        return Ok(file.path().to_owned());
    }
    let mut file = tempfile::Builder::new().prefix(super::TEMPORARY).suffix(".tmp").tempfile()?;
    std::io::copy(input, &mut file)?;
    let path = file.path().to_owned();
    *kept = Some(file);
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_read_once_can_be_read_again() {
        let mut kept = None;
        let path = kept_of(&mut &b"abc"[..], &mut kept).unwrap();
        assert_eq!(kept_of(&mut &b"other"[..], &mut kept).unwrap(), path);
        assert_eq!(std::fs::read(&path).unwrap(), b"abc");
        drop(kept);
        assert!(!path.exists());
    }
}
