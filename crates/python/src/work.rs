//! One call's work: in threads of its own, without the interpreter's lock, interruptible, its warnings raised, no panic across
//! the border.

use std::any::Any;
use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use pyo3::prelude::*;

use crate::failure::Failure;
use crate::warned::Warnings;

/// How long the calling thread waits before it asks for signals. Our choice: shorter than a person notices.
const BETWEEN_SIGNALS: Duration = Duration::from_millis(50);

/// Whether the caller still waits.
#[derive(Clone, Debug, Default)]
pub(crate) struct Caller(Arc<AtomicBool>);

impl Caller {
    /// Ends the work of a caller that was interrupted.
    ///
    /// # Errors
    /// When it was.
    pub(crate) fn still_waits(&self) -> Result<(), Failure> {
        if self.0.load(Ordering::Relaxed) { Err(Failure::internal("interrupted")) } else { Ok(()) }
    }
}

/// A number of threads that a call is given; `None` for one per processor.
///
/// # Errors
/// `InputError` for less than one, `TypeError` for what is no whole number.
pub(crate) fn threads_of(given: &Bound<'_, PyAny>) -> PyResult<Option<NonZeroUsize>> {
    Ok(threads_in(given.extract()?)?)
}

/// The same among options.
///
/// # Errors
/// Less than one.
pub(crate) fn threads_in(given: Option<i128>) -> Result<Option<NonZeroUsize>, Failure> {
    let Some(found) = given else { return Ok(None) };
    let threads = usize::try_from(found).ok().and_then(NonZeroUsize::new);
    let refused = || Failure::input(format!("threads: found {found}, expected 1 or more"));
    threads.ok_or_else(refused).map(Some)
}

/// Runs `job` in a pool of `threads` threads (one per processor without a number) and waits for it.
///
/// # Errors
/// The job's own, a panic as `InternalError`, a warning that is to be an error, or what a signal handler raised.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<NonZeroUsize>,
    job: impl FnOnce(&Caller) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    // Not the process's common pool: its threads would be missing in a process that is forked later.
    let warnings = Warnings::new();
    let of_threads = warnings.clone();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, NonZeroUsize::get))
        .start_handler(move |_| of_threads.listen_to_thread())
        .build()
        .map_err(Failure::internal)?;
    let caller = Caller::default();
    let (send, mut receive) = channel();
    let of_job = caller.clone();
    pool.spawn(move || {
        // A receiver that is gone was interrupted: nobody wants the result.
        let _ = send.send(catch_unwind(AssertUnwindSafe(|| job(&of_job))));
    });
    loop {
        let waiting = &mut receive;
        match py.detach(move || waiting.recv_timeout(BETWEEN_SIGNALS)) {
            Ok(Ok(result)) => {
                warnings.raise(py)?;
                return Ok(result?);
            }
            Ok(Err(panic)) => return Err(panicked(panic.as_ref()).into()),
            Err(RecvTimeoutError::Timeout) => {
                if let Err(signal) = py.check_signals() {
                    caller.0.store(true, Ordering::Relaxed);
                    return Err(signal);
                }
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(Failure::internal("a worker thread ended without a result").into());
            }
        }
    }
}

fn panicked(payload: &(dyn Any + Send)) -> Failure {
    let text = payload
        .downcast_ref::<&str>()
        .map(|text| (*text).to_owned())
        .or_else(|| payload.downcast_ref::<String>().cloned())
        .unwrap_or_default();
    Failure::internal(format!("please report this: {text}"))
}
