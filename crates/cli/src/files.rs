//! Writing files so that neither a reader nor a crash ever leaves half a file.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use crate::failure::Failure;

/// Writes to a temporary file next to `path`, syncs it, and renames it to `path`.
///
/// # Errors
/// Any error of the operating system; `path` then is as it was.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let attempt = || -> std::io::Result<()> {
        let mut file =
            tempfile::Builder::new().prefix(".cruisefit-").suffix(".tmp").tempfile_in(folder)?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        set_ordinary_permissions(file.path())?;
        file.persist(path).map_err(|error| error.error)?;
        Ok(())
    };
    attempt().map_err(|error| Failure::unwritable(path, error))
}

/// Temporary files are private to their owner; results must be as readable as any other file.
#[cfg(unix)]
fn set_ordinary_permissions(path: &Path) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn set_ordinary_permissions(_path: &Path) -> std::io::Result<()> {
    Ok(())
}

/// Reads a text file.
///
/// # Errors
/// A file that cannot be read or is not UTF-8.
pub(crate) fn read_text(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|error| {
        if error.kind() == std::io::ErrorKind::InvalidData {
            Failure::bad_file(path, "not a text file (invalid UTF-8)")
        } else {
            Failure::unreadable(path, error)
        }
    })
}

/// Creates a folder and its parents.
///
/// # Errors
/// Any error of the operating system.
pub(crate) fn make_folder(path: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(path).map_err(|error| Failure::unwritable(path, error))
}

/// A tail as a file name: letters, digits, `-` and `_` stay, any other character becomes `%` and its hexadecimal
/// bytes, so that two tails never share a file.
pub(crate) fn file_stem_of_tail(tail: &str) -> String {
    let mut stem = String::new();
    for byte in tail.bytes() {
        if byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_' {
            stem.push(char::from(byte));
        } else {
            let _ = write!(stem, "%{byte:02X}");
        }
    }
    stem
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_write_replaces_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("model.ron");
        write_atomically(&path, b"one").unwrap();
        write_atomically(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let nowhere = folder.path().join("no/such/folder/model.ron");
        assert!(write_atomically(&nowhere, b"three").is_err());
    }

    #[test]
    fn tails_as_file_names() {
        assert_eq!(file_stem_of_tail("D-ABCD"), "D-ABCD");
        assert_eq!(file_stem_of_tail("../x y"), "%2E%2E%2Fx%20y");
    }
}
