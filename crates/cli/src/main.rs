//! The binary `cruisefit`.

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
