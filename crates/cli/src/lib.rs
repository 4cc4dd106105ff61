//! The command line of cruisefit: arguments, files, folders, threads, progress. Every computation, document and page is
//! in the crates below it; only [`run`] is public.
//!
//! Exit status: 0 done; 1 done, but some input was refused (each refusal on stderr and in the summary); 2 nothing was
//! done, with the reason on stderr; 3 done, and a rule of `monitor --alert` fired.

#![expect(clippy::disallowed_methods, reason = "the command line talks to the world")]

mod args;
mod arrow_batches;
mod columns;
mod commands;
mod criteria;
mod failure;
mod files;
mod folder;
mod inputs;
mod json;
mod models;
mod parquet_batches;
mod parquet_numbers;
mod progress;
mod project;
mod reading;
mod simulated_reports;
mod terminal;
mod threads;

use std::io::IsTerminal;
use std::process::ExitCode;

use clap::FromArgMatches;
use tracing_subscriber::Layer;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::SubscriberExt;

use args::{Cli, Command, JsonWanted};
use commands::{Ending, Outcome};
use failure::{ALERTS_RAISED, DONE, Failure, NOTHING_DONE, SOME_REFUSED};
use progress::Progress;
use terminal::Terminal;
use terminal::warnings::Warnings;

/// What the fuzz targets reach of the readers of files, which are private; not part of the program.
#[doc(hidden)]
pub fn read_columnar(bytes: &[u8]) {
    reading::recording::read_columnar(bytes);
}

/// Reads the command line, runs the command, and reports the result.
pub fn run() -> ExitCode {
    let arguments = match project::with_project(std::env::args_os().collect()) {
        Ok(arguments) => arguments,
        Err(failure) => return ExitCode::from(print_result(Err(failure), Told::All, true)),
    };
    // Never taken apart: that would be a tenth of a start.
    let grammar = Box::leak(Box::new(args::help::command_for(&arguments)));
    let matches = grammar.try_get_matches_from_mut(arguments).unwrap_or_else(|error| error.exit());
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    Terminal::start(&cli.common);
    let warnings = start_logging(&cli.common);
    let is_hidden = cli.common.no_progress || cli.common.quiet;
    let progress = if is_hidden { Progress::Hidden } else { Progress::Shown };
    let wanted = cli.command.json_wanted();
    let result = threads::in_pool(cli.common.threads, || {
        json::check(wanted)?;
        let outcome = run_command(&cli.command, progress)?;
        let is_delivered = json::deliver(wanted, &outcome)?;
        Ok((outcome, is_delivered))
    });
    files::standard_input::forget();
    let told = match (cli.common.quiet, cli.command.prints_results()) {
        (_, _) if wanted == JsonWanted::Printed => Told::RefusalsOnly,
        (true, false) => Told::RefusalsOnly,
        _ => Told::All,
    };
    if !cli.common.quiet {
        terminal::tell(&warnings.take());
    }
    let is_delivered = result.as_ref().map_or(true, |(_, is_delivered)| *is_delivered);
    ExitCode::from(print_result(result.map(|(outcome, _)| outcome), told, is_delivered))
}

/// What a run tells when it is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Told {
    /// Its text and what was refused.
    All,
    /// What was refused.
    RefusalsOnly,
}

fn run_command(command: &Command, progress: Progress) -> Result<Outcome, Failure> {
    match command {
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
        Command::Monitor(arguments) => commands::monitor::run(arguments, progress),
        Command::Show(arguments) => commands::show::run(arguments),
        Command::Export(arguments) => commands::export::run(arguments),
        Command::Optimum(arguments) => commands::optimum::run(arguments),
        Command::Plot(arguments) => commands::plot::run(arguments),
        Command::Effects(_) => commands::effects::run(),
        Command::Explain(arguments) => commands::explain::run(arguments),
        Command::Completions(arguments) => Ok(commands::completions::run(arguments)),
        Command::Man(arguments) => commands::man::run(arguments),
        Command::Golden(command) => commands::golden::run(command),
        Command::Simulate(arguments) => commands::simulate::run(arguments, progress),
        Command::Trial(arguments) => commands::trial::run(arguments, progress),
        Command::Demo(arguments) => commands::demo::run(arguments, progress),
    }
}

/// Events of the library on standard error: warnings at the end, grouped; with `-v` or `RUST_LOG` all as they come.
fn start_logging(common: &args::Common) -> Warnings {
    let warnings = Warnings::default();
    let level = match common.verbose {
        0 => LevelFilter::WARN,
        1 => LevelFilter::INFO,
        _ => LevelFilter::DEBUG,
    };
    let asked: Option<Targets> =
        std::env::var("RUST_LOG").ok().and_then(|directives| directives.parse().ok());
    // Setting a logger fails only where a program that embeds this one has already set one, which then serves.
    if asked.is_none() && common.verbose == 0 {
        let subscriber = tracing_subscriber::registry().with(warnings.clone());
        let _ = tracing::subscriber::set_global_default(subscriber);
        return warnings;
    }
    let printed = tracing_subscriber::fmt::layer()
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .without_time()
        .with_target(false)
        // Where standard error is closed a warning is lost; telling of it there would end the program.
        .log_internal_errors(false)
        .with_filter(asked.unwrap_or_else(|| Targets::new().with_default(level)));
    let subscriber = tracing_subscriber::registry().with(printed);
    let _ = tracing::subscriber::set_global_default(subscriber);
    warnings
}

/// Results to standard output, refusals and reasons to standard error; returns the exit status. A document may not have been
/// delivered before.
fn print_result(result: Result<Outcome, Failure>, told: Told, is_delivered: bool) -> u8 {
    let failure = match result {
        Ok(Outcome { text, refused, ending, .. }) => {
            let is_delivered = is_delivered && (told != Told::All || terminal::print(&text));
            terminal::tell_refused(&refused);
            match ending {
                Ending::Done if refused.is_empty() && is_delivered => return DONE,
                Ending::Done => return SOME_REFUSED,
                Ending::Alerts => return ALERTS_RAISED,
                Ending::NotPassed(failure) => failure,
            }
        }
        Err(failure) => failure,
    };
    terminal::tell_as_it_is(&terminal::errors::shown(&failure, Terminal::of_run().err));
    NOTHING_DONE
}
