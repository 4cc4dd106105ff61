//! How many threads a run has.

use crate::failure::Failure;

/// Readers that wait for a cold disk do not compute: a few more threads than processors pay, many more do not.
const THREADS_PER_PROCESSOR: usize = 4;

/// File handles that a run needs besides one for each thread: standard streams, lock, folders.
const HANDLES_BESIDES_THREADS: usize = 16;

/// Runs in a pool of as many threads as were asked for, and as the machine can use; results do not depend on it.
///
/// # Errors
/// Threads that the system does not grant, or what the work fails with.
pub(crate) fn in_pool<T: Send>(
    asked: Option<u16>,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> Result<T, Failure> {
    let processors = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let threads = usable(asked.map(usize::from), processors, handles());
    if let Some(asked) = asked
        && usize::from(asked) != threads
    {
        tracing::info!(asked, used = threads, "threads: as many as processors and handles serve");
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| {
        Failure::BadArgument { argument: "--threads", reason: error.to_string() }
    })?;
    pool.install(work)
}

fn usable(asked: Option<usize>, processors: usize, handles: Option<usize>) -> usize {
    let most = handles
        .map_or(usize::MAX, |handles| handles.saturating_sub(HANDLES_BESIDES_THREADS).max(1));
    asked.unwrap_or(processors).min(THREADS_PER_PROCESSOR * processors).min(most)
}

/// How many files the process may have open; `None` where nothing says so.
#[cfg(unix)]
fn handles() -> Option<usize> {
    rustix::process::getrlimit(rustix::process::Resource::Nofile)
        .current
        .and_then(|handles| usize::try_from(handles).ok())
}

#[cfg(not(unix))]
fn handles() -> Option<usize> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_threads_than_serve() {
        assert_eq!(usable(None, 2, Some(1024)), 2);
        assert_eq!(usable(Some(1024), 2, Some(1024)), 8);
        assert_eq!(usable(Some(64), 64, Some(32)), 16);
        assert_eq!(usable(Some(8), 8, Some(10)), 1);
        assert_eq!(usable(Some(1), 8, None), 1);
    }
}
