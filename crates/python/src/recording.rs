//! A recording opened for reading: text as it is unpacked, or the rows of a Parquet or Arrow file.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use pipeline::reading::recordings::Workers;
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use report::mapping::Source;

use crate::columnar;
use crate::work::Caller;

/// What a Zstandard frame begins with (RFC 8878, section 3.1.1).
const ZSTANDARD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];
/// Bytes that are read from a file at a time.
const BUFFER_BYTES: usize = 1 << 18;

/// Where a recording is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place<'a> {
    /// In a file.
    File(&'a Path),
    /// In memory.
    Bytes(&'a PyBackedBytes),
}

/// What is needed to open recordings.
#[derive(Debug)]
pub(crate) struct Opening {
    /// `cruisefit._columnar.opened`, which opens a Parquet or Arrow file.
    pub(crate) columnar: Py<PyAny>,
    /// Whoever is no longer waited for by it stops reading.
    pub(crate) caller: Caller,
}

impl Opening {
    /// Opens a recording.
    ///
    /// # Errors
    /// Why it is not read.
    pub(crate) fn open<'p>(&self, place: Place<'p>) -> Result<Source<'p>, String> {
        let mut content: Box<dyn BufRead + 'p> = match place {
            Place::File(path) => {
                let source = File::open(path).map_err(|error| error.to_string())?;
                let waited_for = WaitedFor { source, caller: self.caller.clone() };
                Box::new(BufReader::with_capacity(BUFFER_BYTES, waited_for))
            }
            Place::Bytes(bytes) => Box::new(&bytes[..]),
        };
        let beginning = content.fill_buf().map_err(|error| error.to_string())?;
        if columnar::is_columnar(beginning) {
            return columnar::source(&self.columnar, place, &self.caller);
        }
        let source = if beginning.starts_with(&ZSTANDARD_MAGIC) {
            Source::text(unpacked(content)?)
        } else {
            Source::text(content)
        };
        source.map_err(|refusal| refusal.to_string())
    }
}

fn unpacked<'p>(packed: Box<dyn BufRead + 'p>) -> Result<impl BufRead + 'p, String> {
    let decoder = zstd::stream::read::Decoder::with_buffer(packed);
    decoder
        .map(|decoder| BufReader::with_capacity(BUFFER_BYTES, decoder))
        .map_err(|error| error.to_string())
}

/// A source that fails once nobody waits for what is read of it.
struct WaitedFor<R> {
    source: R,
    caller: Caller,
}

impl<R: Read> Read for WaitedFor<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.caller.still_waits().map_err(|_| io::ErrorKind::TimedOut)?;
        self.source.read(buffer)
    }
}

/// The work of a recording, in the threads of the call.
pub(crate) fn in_parallel(work: &(dyn Fn() + Sync), run: &mut dyn FnMut(&Workers<'_>)) {
    let count = rayon::current_num_threads();
    rayon::in_place_scope(|scope| run(&Workers { count, call: &|| scope.spawn(|_| work()) }));
}
