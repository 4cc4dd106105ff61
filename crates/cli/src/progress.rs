//! Progress on the terminal: count, rate, time left. None where stderr is not a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

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
        let bar = ProgressBar::with_draw_target(Some(total as u64), target);
        if let Ok(style) =
            ProgressStyle::with_template("{prefix} {wide_bar} {pos}/{len} {per_sec}, {eta} left")
        {
            bar.set_style(style);
        }
        bar.set_prefix(what);
        Bar(bar)
    }
}

/// One bar.
#[derive(Clone, Debug)]
pub(crate) struct Bar(ProgressBar);

impl Bar {
    /// One more is done.
    pub(crate) fn step(&self) {
        self.0.inc(1);
    }

    /// So many more are done.
    pub(crate) fn advance(&self, count: usize) {
        self.0.inc(count as u64);
    }

    /// All are done: the bar is removed.
    pub(crate) fn finish(&self) {
        self.0.finish_and_clear();
    }
}
