//! Every step by which a folder's state changes on disk, one function each, so that tests can end the program before
//! any of them, cut a write short, or lose what was not synced.

use std::io;
use std::path::Path;

/// Writes a new file; it is not synced.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    #[cfg(test)]
    let bytes = faults::cut(path, bytes)?;
    std::fs::write(path, bytes)?;
    #[cfg(test)]
    faults::check()?;
    Ok(())
}

/// Renames a file or folder over what may be there.
pub(crate) fn rename(from: &Path, to: &Path) -> io::Result<()> {
    #[cfg(test)]
    faults::renaming(from, to)?;
    match std::fs::rename(from, to) {
        // A folder's part may lie on another file system: a copy beside its place is renamed there.
        Err(error) if error.kind() == io::ErrorKind::CrossesDevices && from.is_file() => {
            let beside = to.with_extension("moving");
            std::fs::copy(from, &beside)?;
            std::fs::File::open(&beside)?.sync_all()?;
            std::fs::rename(&beside, to)?;
            std::fs::remove_file(from)
        }
        result => result,
    }
}

/// Makes a folder; one that is there already is no error.
pub(crate) fn make_folder(path: &Path) -> io::Result<()> {
    #[cfg(test)]
    faults::step()?;
    match std::fs::create_dir(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists && path.is_dir() => Ok(()),
        result => result,
    }
}

/// Removes a file.
pub(crate) fn remove_file(path: &Path) -> io::Result<()> {
    #[cfg(test)]
    faults::step()?;
    std::fs::remove_file(path)
}

/// Removes a folder with everything in it.
pub(crate) fn remove_folder(path: &Path) -> io::Result<()> {
    #[cfg(test)]
    faults::step()?;
    std::fs::remove_dir_all(path)
}

/// Makes names in a folder durable. Where folders cannot be synced nothing is done.
pub(crate) fn sync_folder(path: &Path) -> io::Result<()> {
    #[cfg(test)]
    faults::synced(path)?;
    if cfg!(unix) { std::fs::File::open(path)?.sync_all() } else { Ok(()) }
}

/// Makes everything below a folder durable: with one call where the system has it, otherwise file by file.
pub(crate) fn sync_below(path: &Path) -> io::Result<()> {
    #[cfg(test)]
    faults::synced_all()?;
    #[cfg(target_os = "linux")]
    {
        // One flush for all files: a run may write thousands, and a flush for each costs more than all else.
        let folder = std::fs::File::open(path)?;
        rustix::fs::syncfs(&folder)?;
        Ok(())
    }
    #[cfg(not(target_os = "linux"))]
    sync_each(path)
}

#[cfg(not(target_os = "linux"))]
fn sync_each(path: &Path) -> io::Result<()> {
    for entry in std::fs::read_dir(path)? {
        let path = entry?.path();
        if path.is_dir() {
            sync_each(&path)?;
        } else {
            // Windows flushes only what is open for writing.
            let mut options = std::fs::OpenOptions::new();
            options.read(true).write(cfg!(windows)).open(&path)?.sync_all()?;
        }
    }
    sync_folder(path)
}

/// Faults on purpose, for tests: the program dies before or within a chosen step, and what was not synced is lost.
#[cfg(test)]
pub(crate) mod faults {
    use std::cell::RefCell;
    use std::io;
    use std::path::{Path, PathBuf};

    /// What was done since it was last made durable.
    #[derive(Debug)]
    enum Done {
        Wrote(PathBuf),
        Renamed { from: PathBuf, to: PathBuf, replaced: Option<Vec<u8>> },
    }

    #[derive(Debug, Default)]
    struct Faults {
        steps: usize,
        dies_at: Option<usize>,
        /// Share of the bytes that the write in which the program dies still writes, in 256ths.
        cut: u8,
        unsynced: Vec<Done>,
    }

    thread_local! {
        static FAULTS: RefCell<Faults> = RefCell::default();
    }

    /// From now on the program dies at this step of the thread; of a write some 256ths are still written.
    pub(crate) fn die_at(step: Option<usize>, cut: u8) {
        FAULTS.with_borrow_mut(|faults| {
            *faults = Faults { dies_at: step, cut, ..Faults::default() };
        });
    }

    /// Steps taken since [`die_at`].
    pub(crate) fn steps() -> usize {
        FAULTS.with_borrow(|faults| faults.steps)
    }

    /// A power cut: of what was not synced, each rename and each written file is lost where `lost` says so, in whatever
    /// order.
    pub(crate) fn lose_unsynced(mut lost: impl FnMut() -> bool) {
        let unsynced = FAULTS.with_borrow_mut(|faults| std::mem::take(&mut faults.unsynced));
        for done in unsynced.into_iter().rev() {
            if !lost() {
                continue;
            }
            match done {
                Done::Wrote(path) => {
                    if let Ok(bytes) = std::fs::read(&path) {
                        std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
                    }
                }
                Done::Renamed { from, to, replaced } => {
                    if to.exists() && from.parent().is_some_and(Path::exists) {
                        std::fs::rename(&to, &from).unwrap();
                        if let Some(bytes) = replaced {
                            std::fs::write(&to, bytes).unwrap();
                        }
                    }
                }
            }
        }
    }

    /// Whether the program died since [`die_at`].
    pub(crate) fn died() -> bool {
        check().is_err()
    }

    fn dead() -> io::Error {
        io::Error::other("the program is dead")
    }

    /// Whether the program still lives.
    pub(super) fn check() -> io::Result<()> {
        FAULTS.with_borrow(|faults| match faults.dies_at {
            Some(at) if faults.steps > at => Err(dead()),
            _ => Ok(()),
        })
    }

    /// One more step, unless the program died before it.
    pub(super) fn step() -> io::Result<()> {
        FAULTS.with_borrow_mut(|faults| faults.steps += 1);
        check()
    }

    pub(super) fn cut<'a>(path: &Path, bytes: &'a [u8]) -> io::Result<&'a [u8]> {
        FAULTS.with_borrow_mut(|faults| {
            if faults.dies_at.is_some_and(|at| faults.steps > at) {
                return Err(dead());
            }
            faults.steps += 1;
            faults.unsynced.push(Done::Wrote(path.to_owned()));
            let dies = faults.dies_at.is_some_and(|at| faults.steps > at);
            let length =
                if dies { bytes.len() * usize::from(faults.cut) / 256 } else { bytes.len() };
            Ok(&bytes[..length])
        })
    }

    pub(super) fn renaming(from: &Path, to: &Path) -> io::Result<()> {
        step()?;
        let replaced = std::fs::read(to).ok();
        FAULTS.with_borrow_mut(|faults| {
            faults.unsynced.push(Done::Renamed {
                from: from.to_owned(),
                to: to.to_owned(),
                replaced,
            });
        });
        Ok(())
    }

    pub(super) fn synced(folder: &Path) -> io::Result<()> {
        step()?;
        FAULTS.with_borrow_mut(|faults| {
            faults.unsynced.retain(|done| match done {
                Done::Renamed { to, .. } => to.parent() != Some(folder),
                Done::Wrote(_) => true,
            });
        });
        Ok(())
    }

    pub(super) fn synced_all() -> io::Result<()> {
        step()?;
        FAULTS.with_borrow_mut(|faults| faults.unsynced.clear());
        Ok(())
    }
}
