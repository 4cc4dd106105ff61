//! Progress on the terminal: count, rate, time left. None where stderr is not a terminal.

use std::fmt::Write;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

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
            ProgressStyle::with_template("{prefix} {wide_bar} {pos}/{len}, {rate}, {eta} left")
        {
            bar.set_style(style.with_key("rate", |state: &ProgressState, text: &mut dyn Write| {
                // Writing fails only where the bar's own text cannot grow.
                let _ = text.write_str(&rate(state.per_sec()));
            }));
        }
        bar.set_prefix(what);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_have_two_digits_or_so() {
        assert_eq!([5611.23, 12.3, 2.46, 0.1].map(rate), ["5611/s", "12/s", "2.5/s", "6.0/min"]);
    }
}
