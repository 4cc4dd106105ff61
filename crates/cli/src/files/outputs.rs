//! Files that a command may replace, and those that it leaves alone unless it is told to.

use std::path::Path;

use crate::failure::Failure;

/// Refuses to replace a file that holds something else than what the command makes.
///
/// `own` decides, from the file's text, whether the command may replace it; a file with the very bytes that would be
/// written may always be replaced. Devices and pipes hold nothing.
///
/// # Errors
/// A file that would be lost.
pub(crate) fn check_replaceable(
    path: &Path,
    force: bool,
    written: &[u8],
    own: impl FnOnce(&str) -> bool,
) -> Result<(), Failure> {
    let is_file = path.metadata().is_ok_and(|known| known.is_file());
    if force || !is_file || path.as_os_str() == "-" {
        return Ok(());
    }
    let known = std::fs::read(path).map_err(|error| Failure::unreadable(path, error))?;
    if known == written || std::str::from_utf8(&known).is_ok_and(own) {
        return Ok(());
    }
    Err(Failure::WouldReplace { path: crate::failure::show(path) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_was_made_by_the_command_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("M.ron");
        check_replaceable(&path, false, b"new", |_| false).unwrap();
        std::fs::write(&path, "old").unwrap();
        check_replaceable(&path, false, b"new", |_| false).unwrap_err();
        check_replaceable(&path, false, b"old", |_| false).unwrap();
        check_replaceable(&path, false, b"new", |text| text == "old").unwrap();
        check_replaceable(&path, true, b"new", |_| false).unwrap();
    }
}
