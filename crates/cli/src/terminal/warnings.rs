//! Warnings of the library, kept until the command is done: many of one kind become one with a count, they do not tear a
//! progress bar, and their order does not depend on threads. With `-v` or `RUST_LOG` each is printed when it comes.

use std::collections::BTreeMap;
use std::fmt::{Debug, Write as _};
use std::sync::{Arc, Mutex, PoisonError};

use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::layer::{Context, Layer};

use super::kinds::kind_of;

/// As many of a kind are printed one by one.
const ONE_BY_ONE: usize = 3;

/// The warnings of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Warnings(Arc<Mutex<Vec<Warning>>>);

#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Warning {
    message: String,
    /// Tail, file, line, …: where it applies.
    about: Vec<String>,
}

impl Warnings {
    /// Takes all that were kept, as lines.
    pub(crate) fn take(&self) -> String {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        lines(std::mem::take(&mut *kept))
    }
}

/// Kinds in alphabetical order, each with its first warnings in alphabetical order.
fn lines(mut warnings: Vec<Warning>) -> String {
    warnings.sort();
    let mut kinds: BTreeMap<String, Vec<Warning>> = BTreeMap::new();
    for warning in warnings {
        kinds.entry(kind_of(&warning.message)).or_default().push(warning);
    }
    let mut text = String::new();
    for kind in kinds.into_values() {
        let shown = if kind.len() > ONE_BY_ONE { 1 } else { kind.len() };
        for warning in &kind[..shown] {
            let about = if warning.about.is_empty() {
                String::new()
            } else {
                format!(" ({})", warning.about.join(", "))
            };
            let _ = writeln!(text, "Warning: {}{about}", warning.message);
        }
        if kind.len() > shown {
            let _ = writeln!(text, "  and {} more of this kind; -v lists each", kind.len() - shown);
        }
    }
    text
}

impl<S: Subscriber> Layer<S> for Warnings {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        if *event.metadata().level() > Level::WARN {
            return;
        }
        let mut warning = Warning::default();
        event.record(&mut warning);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(warning);
    }
}

impl Visit for Warning {
    fn record_str(&mut self, field: &Field, value: &str) {
        self.record(field.name(), value);
    }

    /// Numbers and what is displayed; the library's texts come by [`Visit::record_str`].
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        self.record(field.name(), &format!("{value:?}"));
    }
}

impl Warning {
    fn record(&mut self, name: &str, value: &str) {
        match name {
            "message" => value.clone_into(&mut self.message),
            "file" => self.about.push(value.to_owned()),
            _ => self.about.push(format!("{name} {value}")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thirty_warnings_of_one_kind_are_one_with_a_count() {
        let mut warnings: Vec<Warning> = (10..40)
            .map(|row| Warning {
                message: format!("{row} rows lack a number"),
                about: vec![format!("{row}.csv")],
            })
            .collect();
        warnings.reverse();
        warnings.push(Warning { message: "another".to_owned(), about: Vec::new() });
        assert_eq!(
            lines(warnings),
            "Warning: 10 rows lack a number (10.csv)\n  and 29 more of this kind; -v lists each\nWarning: another\n"
        );
    }

    #[test]
    fn fields_are_words() {
        use tracing_subscriber::layer::SubscriberExt;
        let warnings = Warnings::default();
        let subscriber = tracing_subscriber::registry().with(warnings.clone());
        tracing::subscriber::with_default(subscriber, || {
            tracing::warn!(tail = "T-1", line = 3, "has events, but no flight");
            tracing::info!("not a warning");
        });
        assert_eq!(warnings.take(), "Warning: has events, but no flight (tail T-1, line 3)\n");
        assert_eq!(warnings.take(), "");
    }
}
