//! Writing files so that neither a reader nor a crash ever leaves half a file.

pub(crate) mod outputs;
pub(crate) mod standard_input;
pub(crate) mod steps;

use std::path::{Path, PathBuf};

use crate::failure::Failure;
pub(crate) use pipeline::file_names::file_stem_of_tail;

/// Begins the name of everything that the program puts into a folder for a while.
pub(crate) const TEMPORARY: &str = ".cruisefit-";

/// Writes bytes where a path leads: standard output for `-`; a device or pipe is written to; behind a link its target
/// is replaced; a file is replaced whole or not at all, through a temporary file next to it that is synced first.
///
/// # Errors
/// Any error of the operating system; a file at `path` then is as it was.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    write_streamed(path, |to| to.write_all(bytes))
}

/// Whether what is at a path takes bytes as they come, and its name says nothing of what they are.
pub(crate) fn is_device_or_pipe(path: &Path) -> bool {
    // `/dev/stdout` may be a regular file, which whoever opened it wants to see written, not replaced.
    let is_device = path.starts_with("/dev") || path.starts_with("/proc");
    path.metadata().is_ok_and(|known| is_device || !(known.is_file() || known.is_dir()))
}

/// The same of what a function writes, piece by piece: for files that need not be in memory as a whole.
///
/// # Errors
/// As for [`write_atomically`].
pub(crate) fn write_streamed(path: &Path, content: impl Fn(To<'_>) -> Done) -> Result<(), Failure> {
    let attempt = || -> std::io::Result<()> {
        if path.as_os_str() == "-" {
            return content(&mut std::io::stdout());
        }
        if is_device_or_pipe(path) {
            return content(&mut std::fs::OpenOptions::new().append(true).open(path)?);
        }
        let permissions = path.metadata().ok().map(|known| known.permissions());
        let target = behind_links(path)?;
        replace(&target, &content, permissions, Durability::Synced)
    };
    attempt().map_err(|error| Failure::unwritable(path, error))
}

/// Replaces a file whole or not at all, as long as the system runs: for files of which there are thousands and which can
/// be made again.
///
/// # Errors
/// Any error of the operating system; a file at `path` then is as it was.
pub(crate) fn write_unsynced(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    replace(path, &|to: To<'_>| to.write_all(bytes), None, Durability::Unsynced)
        .map_err(|error| Failure::unwritable(path, error))
}

/// Where a file's content is written to.
type To<'a> = &'a mut dyn std::io::Write;
type Done = std::io::Result<()>;

/// Whether a file survives a power cut right after it was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Durability {
    Synced,
    Unsynced,
}

/// Replaces a file by way of a temporary one. A file that was there keeps its mode, a new one has that of the umask.
fn replace(
    path: &Path,
    content: &dyn Fn(To<'_>) -> Done,
    permissions: Option<std::fs::Permissions>,
    durability: Durability,
) -> std::io::Result<()> {
    let folder = folder_of(path);
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY).suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder)?;
    content(&mut file)?;
    if let Some(permissions) = permissions {
        // Where the file belongs to somebody else its mode cannot be kept: the umask's serves.
        let _ = file.as_file().set_permissions(permissions);
    }
    if durability == Durability::Unsynced {
        file.persist(path).map_err(|error| error.error)?;
        return Ok(());
    }
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    steps::sync_folder(folder)
}

/// The folder in which a file is.
fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Where a path leads when links are followed, also if nothing is there yet.
fn behind_links(path: &Path) -> std::io::Result<PathBuf> {
    /// As many as Linux follows.
    const MOST_LINKS: usize = 40;
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        match target.symlink_metadata() {
            Ok(known) if known.is_symlink() => {
                target = folder_of(&target).join(std::fs::read_link(&target)?);
            }
            _ => return Ok(target),
        }
    }
    Err(std::io::Error::other("too many links, one to the other"))
}

/// Reads a text file, or standard input for `-`.
///
/// # Errors
/// A file that cannot be read or is not UTF-8.
pub(crate) fn read_text(path: &Path) -> Result<String, Failure> {
    standard_input::file(path).and_then(std::fs::read_to_string).map_err(|error| {
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

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_modes_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        symlink("file", &link).unwrap();
        // Nothing is there yet: the link's target is made.
        write_atomically(&link, b"one").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        std::fs::set_permissions(&file, std::fs::Permissions::from_mode(0o640)).unwrap();
        write_atomically(&link, b"two").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(std::fs::read(&file).unwrap(), b"two");
        assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o640);
        symlink("round", folder.path().join("round")).unwrap();
        assert!(write_atomically(&folder.path().join("round"), b"x").is_err());
    }
}
