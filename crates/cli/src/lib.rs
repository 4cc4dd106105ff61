//! The command line of cruisefit: arguments, files, folders, threads, progress. Every computation, document and page is
//! in the crates below it; only [`run`] is public.
//!
//! Exit status: 0 done; 1 done, but some input was refused (each refusal on stderr and in the summary); 2 nothing was
//! done, with the reason on stderr; 3 done, and a rule of `monitor --alert` fired.

#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::disallowed_methods,
    reason = "the command line talks to the world"
)]

mod args;
mod arrow_batches;
mod cells;
mod columns;
mod commands;
mod criteria;
mod failure;
mod files;
mod folder;
mod inputs;
mod models;
mod parquet_batches;
mod parquet_numbers;
mod progress;
mod project;
mod reading;
mod simulated_reports;
mod threads;

use std::io::{IsTerminal, Write};
use std::process::ExitCode;

use clap::Parser;
use tracing_subscriber::EnvFilter;

use args::{Cli, Command};
use commands::Outcome;
use failure::{ALERTS_RAISED, DONE, Failure, NOTHING_DONE, SOME_REFUSED};
use progress::Progress;

/// What the fuzz targets reach of the readers of files, which are private; not part of the program.
#[doc(hidden)]
pub fn read_columnar(bytes: &[u8]) {
    reading::recording::read_columnar(bytes);
}

/// Reads the command line, runs the command, and reports the result.
pub fn run() -> ExitCode {
    let arguments = match project::with_project(std::env::args_os().collect()) {
        Ok(arguments) => arguments,
        Err(failure) => return ExitCode::from(print_result(Err(failure))),
    };
    let cli = Cli::parse_from(arguments);
    start_logging(cli.common.verbose);
    // Lines are not wrapped: a path with a line break in it cannot be copied. Fails only where a hook is already set.
    let _ = miette::set_hook(Box::new(|_| {
        Box::new(miette::MietteHandlerOpts::new().wrap_lines(false).build())
    }));
    let progress = if cli.common.no_progress { Progress::Hidden } else { Progress::Shown };
    let result = threads::in_pool(cli.common.threads, || run_command(&cli.command, progress));
    ExitCode::from(print_result(result))
}

/// The outcome of a command, and how many alerts it raised.
fn run_command(command: &Command, progress: Progress) -> Result<(Outcome, usize), Failure> {
    let outcome = match command {
        Command::Init(arguments) => commands::init::run(arguments),
        Command::Guide(arguments) => commands::guide::run(arguments),
        Command::Adapt(arguments) => commands::adapt::run(arguments, progress),
        Command::Check(arguments) => commands::check::run(arguments, progress),
        Command::Mapping(arguments) => commands::mapping::run(arguments),
        Command::Convert(arguments) => commands::convert::run(arguments, progress),
        Command::Forget(arguments) => commands::forget::run(arguments),
        Command::Segment(arguments) => commands::segment::run(arguments, progress),
        Command::Tune(arguments) => commands::tune::run(arguments, progress),
        Command::Merge(arguments) => commands::merge::run(arguments),
        Command::Predict(arguments) => commands::predict::run(arguments),
        Command::Evaluate(arguments) => commands::evaluate::run(arguments, progress),
        Command::Diagnose(arguments) => commands::diagnose::run(arguments, progress),
        Command::Monitor(arguments) => return commands::monitor::run(arguments, progress),
        Command::Show(arguments) => commands::show::run(arguments),
        Command::Export(arguments) => commands::export::run(arguments),
        Command::Optimum(arguments) => commands::optimum::run(arguments),
        Command::Plot(arguments) => commands::plot::run(arguments),
        Command::Effects(arguments) => commands::effects::run(arguments),
        Command::Explain(arguments) => commands::explain::run(arguments),
        Command::Completions(arguments) => Ok(commands::completions::run(arguments)),
        Command::Man(arguments) => commands::man::run(arguments),
        Command::Golden(command) => commands::golden::run(command),
        Command::Simulate(arguments) => commands::simulate::run(arguments, progress),
        Command::Trial(arguments) => commands::trial::run(arguments, progress),
        Command::Demo(arguments) => commands::demo::run(arguments, progress),
    };
    outcome.map(|outcome| (outcome, 0))
}

fn start_logging(verbose: u8) {
    let level = match verbose {
        0 => "warn",
        1 => "info",
        _ => "debug",
    };
    let filter = EnvFilter::try_from_default_env().unwrap_or_else(|_| EnvFilter::new(level));
    // Fails only where a program that embeds this one has already set a logger, which then serves.
    let _ = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .without_time()
        .with_target(false)
        .try_init();
}

/// Results to standard output, refusals and reasons to standard error; returns the exit status.
fn print_result(result: Result<(Outcome, usize), Failure>) -> u8 {
    match result {
        Ok((Outcome { text, refused }, alerts)) => {
            // A reader that closes the pipe early (`| head`) is not an error.
            let _ = std::io::stdout().write_all(shown(&text).as_bytes());
            for one in &refused {
                eprintln!("refused: {}", shown(&one.to_string()));
            }
            match (refused.is_empty(), alerts) {
                (true, 0) => DONE,
                (false, 0) => SOME_REFUSED,
                _ => ALERTS_RAISED,
            }
        }
        Err(failure) => {
            eprintln!("{:?}", miette::Report::new(failure));
            NOTHING_DONE
        }
    }
}

/// A text as a terminal may get it: names of files and what is quoted of them can hold sequences that it would act on.
fn shown(text: &str) -> std::borrow::Cow<'_, str> {
    let acts = |c: char| c.is_control() && c != '\n' && c != '\t';
    if text.contains(acts) { text.replace(acts, "\u{fffd}").into() } else { text.into() }
}
