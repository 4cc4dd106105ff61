//! The bytes of an input file, within limits.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::time::Duration;

use report::MAXIMUM_TEXT_BYTES;

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

fn open(path: &Path) -> Result<File, String> {
    let mut tries = 0;
    loop {
        // Asked before it is opened: opening a pipe waits for somebody to write into it.
        match std::fs::metadata(path) {
            Ok(known) if !known.is_file() => {
                return Err("not a regular file: write what it gives to a file first".to_owned());
            }
            Ok(_) => {}
            Err(error) => return Err(error.to_string()),
        }
        match File::open(path) {
            Err(error) if is_out_of_handles(&error) && tries < TRIES => {
                tries += 1;
                std::thread::sleep(BETWEEN_TRIES);
            }
            result => return result.map_err(|error| error.to_string()),
        }
    }
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
