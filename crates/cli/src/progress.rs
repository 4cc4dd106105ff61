//! Progress on the terminal: count, rate, time left. None where stderr is not a terminal.

use std::fmt::Write;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// Ticks of one piece of work, so that half of it can be shown.
const TICKS: u64 = 2;

/// Whether a run shows its progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Progress {
    /// Bars on stderr, where it is a terminal.
    Shown,
    /// No bars.
    Hidden,
}

impl Progress {
    /// A bar that counts to `total`.
    pub(crate) fn bar(self, total: usize, what: &'static str) -> Bar {
        let target = match self {
            Self::Shown => ProgressDrawTarget::stderr_with_hz(5),
            Self::Hidden => ProgressDrawTarget::hidden(),
        };
        let bar = ProgressBar::with_draw_target(Some(TICKS * total as u64), target);
        let template = "{prefix} {wide_bar} {done}/{all}, {rate}, {elapsed}, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            // Writing fails only where the bar's own text cannot grow.
            let style = style
                .with_key("done", |state: &ProgressState, text: &mut dyn Write| {
                    let _ = write!(text, "{}", state.pos() / TICKS);
                })
                .with_key("all", |state: &ProgressState, text: &mut dyn Write| {
                    let _ = write!(text, "{}", state.len().unwrap_or(0) / TICKS);
                })
                .with_key("rate", |state: &ProgressState, text: &mut dyn Write| {
                    let _ = text.write_str(&rate(state.per_sec() / TICKS as f64));
                });
            bar.set_style(style);
        }
        bar.set_prefix(what);
        // A single large tail takes long from one step to the next: the time shows that it is at work.
        if self == Self::Shown {
            bar.enable_steady_tick(Duration::from_secs(1));
        }
        Bar(bar)
    }
}

/// So many a second, or a minute where they are few.
fn rate(per_second: f64) -> String {
    match per_second {
        many if many >= 10.0 => format!("{many:.0}/s"),
        some if some >= 0.5 => format!("{some:.1}/s"),
        few => format!("{:.1}/min", 60.0 * few),
    }
}

/// One bar.
#[derive(Clone, Debug)]
pub(crate) struct Bar(ProgressBar);

impl Bar {
    /// One more is done.
    pub(crate) fn step(&self) {
        self.0.inc(TICKS);
    }

    /// So many more are done.
    pub(crate) fn advance(&self, count: usize) {
        self.0.inc(TICKS * count as u64);
    }

    /// Half of the work of so many more is done.
    pub(crate) fn half(&self, count: usize) {
        self.0.inc(count as u64);
    }

    /// All are done: the bar is removed.
    pub(crate) fn finish(&self) {
        self.0.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_have_two_digits_or_so() {
        assert_eq!([5611.23, 12.3, 2.46, 0.1].map(rate), ["5611/s", "12/s", "2.5/s", "6.0/min"]);
    }
}
