//! One process at a time: a locked file in the folder, which names its holder. The system gives the lock up when the
//! holder ends, however it ends.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};

use crate::failure::{Failure, show};
use crate::files::TEMPORARY;

/// What to do when another process holds the lock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Busy {
    /// Refuse, and name the holder.
    Refuse,
    /// Wait until it ends.
    Wait,
}

impl Busy {
    /// From the option `--wait`.
    pub(crate) const fn from_option(wait: bool) -> Self {
        if wait { Self::Wait } else { Self::Refuse }
    }
}

/// The lock of a folder; given up, and its file removed, when dropped.
#[derive(Debug)]
pub(crate) struct Lock {
    path: PathBuf,
    _file: File,
}

/// The lock's file in a folder.
pub(crate) fn lock_file(folder: &Path) -> PathBuf {
    folder.join(format!("{TEMPORARY}lock"))
}

impl Lock {
    /// Takes the lock of a folder that exists.
    ///
    /// # Errors
    /// Another process that holds it, or a file system without locks.
    pub(crate) fn take(folder: &Path, busy: Busy) -> Result<Self, Failure> {
        let path = lock_file(folder);
        let failed = |error: std::io::Error| Failure::unwritable(folder, error);
        let mut waited = false;
        loop {
            let mut file = OpenOptions::new()
                .read(true)
                .write(true)
                .create(true)
                .truncate(false)
                .open(&path)
                .map_err(failed)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::Error(error)) => return Err(failed(error)),
                Err(TryLockError::WouldBlock) => {
                    let holder = holder_of(&mut file);
                    if busy == Busy::Refuse {
                        return Err(Failure::Busy { folder: show(folder), holder });
                    }
                    if !waited {
                        tracing::warn!("waiting for {holder}, which is writing {}", show(folder));
                        waited = true;
                    }
                    file.lock().map_err(failed)?;
                }
            }
            // The holder before removed its file, or set the folder aside: this is then the lock of nothing.
            if is_at(&file, &path) {
                write_holder(&mut file).map_err(failed)?;
                return Ok(Self { path, _file: file });
            }
            if !folder.is_dir() {
                std::fs::create_dir_all(folder).map_err(failed)?;
            }
        }
    }

    /// The folder was renamed while the lock was held.
    pub(crate) fn moved_to(&mut self, folder: &Path) {
        self.path = lock_file(folder);
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Removed while it is still held: whoever waits for it finds that it is gone and takes a new one.
        let _ = std::fs::remove_file(&self.path);
    }
}

fn holder_of(file: &mut File) -> String {
    let mut text = String::new();
    let _ = file.rewind();
    match file.take(1000).read_to_string(&mut text) {
        Ok(_) if !text.trim().is_empty() => text.trim().to_owned(),
        _ => "another process".to_owned(),
    }
}

fn write_holder(file: &mut File) -> std::io::Result<()> {
    file.set_len(0)?;
    file.rewind()?;
    writeln!(
        file,
        "process {}{} (since {})",
        std::process::id(),
        host(),
        flight::Timestamp::now().strftime("%Y-%m-%dT%H:%M:%SZ")
    )
}

#[cfg(unix)]
fn host() -> String {
    format!(" on {}", rustix::system::uname().nodename().to_string_lossy())
}

#[cfg(not(unix))]
fn host() -> String {
    String::new()
}

#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), path.metadata()) {
        (Ok(one), Ok(other)) => (one.dev(), one.ino()) == (other.dev(), other.ino()),
        _ => false,
    }
}

#[cfg(not(unix))]
fn is_at(_file: &File, path: &Path) -> bool {
    path.exists()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let lock = Lock::take(folder.path(), Busy::Refuse).unwrap();
        let refused = Lock::take(folder.path(), Busy::Refuse).unwrap_err();
        assert!(refused.to_string().contains(&format!("process {}", std::process::id())));
        let place = folder.path().to_owned();
        let waiting = std::thread::spawn(move || Lock::take(&place, Busy::Wait).map(drop));
        drop(lock);
        waiting.join().unwrap().unwrap();
        assert!(!lock_file(folder.path()).exists());
        Lock::take(folder.path(), Busy::Refuse).unwrap();
    }
}
