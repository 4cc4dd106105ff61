//! The bytes of an input file, within limits.

use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::Path;
use std::time::Duration;

use report::MAXIMUM_TEXT_BYTES;

use crate::files::standard_input;

/// How often a file is tried again when the system has no file handle left, and how long after each time.
const TRIES: u32 = 100;
const BETWEEN_TRIES: Duration = Duration::from_millis(20);

/// Reads a whole file.
///
/// # Errors
/// Why it is not read: an error of the system, a pipe or device, more than a report can hold.
pub(super) fn read(path: &Path, bytes: &mut Vec<u8>) -> Result<(), String> {
    bytes.clear();
    let file = open(path)?;
    let limit = MAXIMUM_TEXT_BYTES as u64;
    file.take(limit + 1).read_to_end(bytes).map_err(|error| error.to_string())?;
    if bytes.len() > MAXIMUM_TEXT_BYTES {
        return Err(format!("more than {} MiB, the most that is read", MAXIMUM_TEXT_BYTES >> 20));
    }
    Ok(())
}

/// Reads the first bytes of a file.
///
/// # Errors
/// Why it is not read.
pub(super) fn read_beginning(path: &Path, length: u64, bytes: &mut Vec<u8>) -> Result<(), String> {
    bytes.clear();
    open(path)?.take(length).read_to_end(bytes).map_err(|error| error.to_string())?;
    Ok(())
}

/// Opens a regular file.
///
/// # Errors
/// Why it is not read.
pub(super) fn open(path: &Path) -> Result<File, String> {
    let path = &*standard_input::file(path).map_err(|error| error.to_string())?;
    let mut tries = 0;
    loop {
        let file = match open_without_waiting(path) {
            Err(error) if is_out_of_handles(&error) && tries < TRIES => {
                tries += 1;
                std::thread::sleep(BETWEEN_TRIES);
                continue;
            }
            // What cannot be opened may be no file either, and then that is what has to be said.
            Err(error) => match path.metadata() {
                Ok(known) if !known.is_file() => return Err(no_file(&known)),
                _ => return Err(error.to_string()),
            },
            Ok(file) => file,
        };
        let known = file.metadata().map_err(|error| error.to_string())?;
        return if known.is_file() { Ok(file) } else { Err(no_file(&known)) };
    }
}

/// Why what is no file is not read.
fn no_file(known: &Metadata) -> String {
    let reason = if known.is_dir() {
        "a folder, where a file was expected"
    } else {
        "not a regular file: write what it gives to a file first"
    };
    reason.to_owned()
}

/// Opens a file for reading; a pipe without waiting for somebody to write into it.
#[cfg(unix)]
fn open_without_waiting(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    let without_waiting = rustix::fs::OFlags::NONBLOCK.bits().cast_signed();
    File::options().read(true).custom_flags(without_waiting).open(path)
}

#[cfg(not(unix))]
fn open_without_waiting(path: &Path) -> io::Result<File> {
    File::open(path)
}

#[cfg(unix)]
fn is_out_of_handles(error: &io::Error) -> bool {
    let number = error.raw_os_error();
    [rustix::io::Errno::MFILE, rustix::io::Errno::NFILE]
        .iter()
        .any(|known| number == Some(known.raw_os_error()))
}

#[cfg(not(unix))]
fn is_out_of_handles(_error: &io::Error) -> bool {
    false
}
