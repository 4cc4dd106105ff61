//! Warnings of the library, collected in the threads of a call and raised as `DataWarning` at the line that made the call.

use std::collections::BTreeSet;
use std::fmt::{Debug, Write};
use std::sync::{Arc, Mutex, PoisonError};

use pyo3::prelude::*;
use tracing::dispatcher::{self, Dispatch};
use tracing::field::{Field, Visit};
use tracing::level_filters::LevelFilter;
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

/// What the library warns of during a call: each sentence once, in an order that does not depend on its threads.
#[derive(Clone, Debug)]
pub(crate) struct Warnings {
    found: Arc<Mutex<BTreeSet<String>>>,
    dispatch: Dispatch,
}

impl Warnings {
    pub(crate) fn new() -> Self {
        let found = Arc::<Mutex<BTreeSet<String>>>::default();
        Self { dispatch: Dispatch::new(Collector(Arc::clone(&found))), found }
    }

    /// Collects what this thread warns of, until it ends.
    pub(crate) fn listen_to_thread(&self) {
        // The guard would end it; with its thread the dispatch is dropped too.
        std::mem::forget(dispatcher::set_default(&self.dispatch));
    }

    /// What `work` comes to in this thread, its warnings raised.
    ///
    /// # Errors
    /// A warning that Python's filters make an error.
    pub(crate) fn of<T>(py: Python<'_>, work: impl FnOnce() -> T) -> PyResult<T> {
        let warnings = Self::new();
        let result = dispatcher::with_default(&warnings.dispatch, work);
        warnings.raise(py)?;
        Ok(result)
    }

    /// Raises what was collected.
    ///
    /// # Errors
    /// A warning that Python's filters make an error.
    pub(crate) fn raise(&self, py: Python<'_>) -> PyResult<()> {
        let found = std::mem::take(&mut *self.found.lock().unwrap_or_else(PoisonError::into_inner));
        if found.is_empty() {
            return Ok(());
        }
        let found: Vec<String> = found.into_iter().collect();
        py.import("cruisefit.errors")?.getattr("warn")?.call1((found,))?;
        Ok(())
    }
}

struct Collector(Arc<Mutex<BTreeSet<String>>>);

impl Subscriber for Collector {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        *metadata.level() <= tracing::Level::WARN
    }

    fn max_level_hint(&self) -> Option<LevelFilter> {
        Some(LevelFilter::WARN)
    }

    fn event(&self, event: &Event<'_>) {
        let mut sentence = Sentence::default();
        event.record(&mut sentence);
        let Sentence { subject, message } = sentence;
        let text = if subject.is_empty() { message } else { format!("{subject}: {message}") };
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(text);
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1) // spans are not looked at
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}
    fn record_follows_from(&self, _: &Id, _: &Id) {}
    fn enter(&self, _: &Id) {}
    fn exit(&self, _: &Id) {}
}

/// A message and what it is of: `file a.txt, line 3`.
#[derive(Default)]
struct Sentence {
    subject: String,
    message: String,
}

impl Visit for Sentence {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        // Writing to a string cannot fail.
        let _ = if field.name() == "message" {
            write!(self.message, "{value:?}")
        } else {
            let separator = if self.subject.is_empty() { "" } else { ", " };
            write!(self.subject, "{separator}{} {value:?}", field.name())
        };
    }

    fn record_str(&mut self, field: &Field, value: &str) {
        self.record_debug(field, &format_args!("{value}"));
    }
}
