//! The native half of the Python package `cruisefit`: bytes and Arrow tables in, Arrow tables, JSON and pages out.
//!
//! What it is: the border. Every computation is that of `pipeline`, called as the command line calls it, so that both give
//! the same bytes. Names, defaults and documentation that a user sees are in the Python files of `python/cruisefit`; nobody
//! calls this module directly.
//! What it is not: stable. Its functions take what those Python files pass.
//!
//! The one design decision: a call works in threads of its own, which end with it, while the calling thread waits without
//! the interpreter's lock and asks for signals (module `work`). A process that was forked after a call, an impatient Ctrl-C and a
//! panic are then all harmless; the price is some 0.1 ms a call.
//!
//! Limits: a diagnosis that was interrupted ends in the background; its result is dropped.

#![allow(clippy::needless_pass_by_value, reason = "what Python passes is converted into a value")]
#![expect(
    clippy::disallowed_methods,
    reason = "with the command line, the package is what opens files"
)]

#[cfg(panic = "abort")]
compile_error!("a panic must become an exception of Python: build the wheel with --profile wheel");

mod adapted;
mod adapting;
mod adding;
mod checked;
mod columnar;
mod diagnosed;
mod failure;
mod flights;
mod inputs;
mod model;
mod plots;
mod points;
mod recorded_rows;
mod recording;
mod simulated;
mod starting;
mod tables;
mod warned;
mod work;

/// The extension module `cruisefit._native`.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::adapted::Adapted;
    #[pymodule_export]
    use crate::adapting::{adapt, evaluate, merge};
    #[pymodule_export]
    use crate::adding::added;
    #[pymodule_export]
    use crate::checked::{Monitored, check, monitor_tails};
    #[pymodule_export]
    use crate::diagnosed::{Diagnosed, diagnose, effects, explain};
    #[pymodule_export]
    use crate::flights::{Flights, Source};
    #[pymodule_export]
    use crate::inputs::matches;
    #[pymodule_export]
    use crate::model::Model;
    #[pymodule_export]
    use crate::plots::{picture, plot_trials};
    #[pymodule_export]
    use crate::simulated::{Simulated, simulate};
    #[pymodule_export]
    use crate::starting::{mapping_of_content, mapping_of_table, public_guide, public_types};

    use pipeline::folder_state;
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("STATE_NAME", folder_state::NAME)?;
        module.add("STATE_FOLDERS", folder_state::FOLDERS)?;
        module.add("PREDICTED_COLUMNS", perf_model::PREDICTED_COLUMNS)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
