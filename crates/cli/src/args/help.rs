//! Examples and exit statuses in the help of every command, for `--help`, the manual pages and completions alike.

use std::ffi::OsString;

use clap::builder::StyledStr;

use super::Cli;

const STATUS: &str = "\
Exit status: 0 done; 1 done, but some input was refused (each refusal on standard error);
2 not done, the reason is on standard error and nothing that existed has changed.";
const STATUS_OF_MONITOR: &str = "\
Exit status: 0 done; 1 done, but for a tail whose files are damaged; 2 not done, the reason is on
standard error; 3 done, and a rule of --alert fired (also where 1 would be).";
const STATUS_OF_PROGRAM: &str = "\
First steps:
  cruisefit demo                 the whole chain on embedded data
  cruisefit explain TOPIC        what an effect, a column, a verdict is
  cruisefit help COMMAND         options and examples of a command";

/// Examples of each command, one a line; every command has some.
const EXAMPLES: [(&str, &[&str]); 26] = [
    ("init", &["cruisefit init --aircraft AIRCRAFT.ron --guide guide.csv -o MODEL.ron"]),
    ("guide", &["cruisefit guide --list", "cruisefit guide --type A320 -o a320"]),
    (
        "adapt",
        &[
            "cruisefit adapt reports/ --model MODEL.ron -o adapted",
            "cruisefit adapt qar/ --mapping qar.ron --model MODEL.ron -o adapted --json",
        ],
    ),
    (
        "check",
        &[
            "cruisefit check reports/",
            "cruisefit check reports/ --model MODEL.ron --json findings.json",
        ],
    ),
    (
        "mapping",
        &["cruisefit mapping qar.csv -o qar.ron", "cruisefit mapping --presets traffic-a320"],
    ),
    (
        "convert",
        &[
            "cruisefit convert qar.csv --mapping qar.ron --dry-run",
            "cruisefit convert qar/ --mapping qar.ron -o reports",
        ],
    ),
    ("forget", &["cruisefit forget adapted --tail D-ABCD --flight 0042"]),
    (
        "segment",
        &[
            "cruisefit segment reports/ --explain -o segments.csv",
            "zcat 0042.txt.gz | cruisefit segment - > segments.csv",
        ],
    ),
    ("tune", &["cruisefit tune reports/ --model MODEL.ron -o TUNED.ron --half-life search"]),
    ("merge", &["cruisefit merge here/models/D-ABCD.ron there/models/D-ABCD.ron -o D-ABCD.ron"]),
    (
        "predict",
        &[
            "cruisefit predict --model adapted/models/D-ABCD.ron points.csv -o predicted.csv",
            "cruisefit predict --model MODEL.ron - < points.csv",
        ],
    ),
    (
        "evaluate",
        &[
            "cruisefit evaluate later/ --model adapted",
            "cruisefit evaluate later/ --model adapted --json summary.json -o residuals.csv",
        ],
    ),
    (
        "diagnose",
        &[
            "cruisefit diagnose later/ --model adapted -o diagnosis",
            "cruisefit diagnose later/ --model adapted -o diagnosis --effects tsfc_engine_2 --apply extended",
        ],
    ),
    (
        "monitor",
        &[
            "cruisefit monitor adapted --events EVENTS.csv -o monitor",
            "cruisefit monitor adapted --alert change=1/90d",
        ],
    ),
    (
        "show",
        &[
            "cruisefit show adapted/models/D-ABCD.ron",
            "cruisefit show reports/0042.txt",
            "cruisefit show diagnosis",
        ],
    ),
    ("export", &["cruisefit export MODEL.ron --format openap -o polar.yml"]),
    (
        "optimum",
        &["cruisefit optimum --model adapted/models/D-ABCD.ron --cost-index 30 -o optimum.csv"],
    ),
    ("plot", &["cruisefit plot adapted --tail D-ABCD -o D-ABCD.svg"]),
    ("effects", &["cruisefit effects"]),
    (
        "explain",
        &["cruisefit explain", "cruisefit explain wave_drag", "cruisefit explain outside_library"],
    ),
    ("golden", &["cruisefit golden check golden/"]),
    (
        "simulate",
        &["cruisefit simulate PLAN.ron -o simulated", "cruisefit simulate ghazi-2020 -o study"],
    ),
    ("trial", &["cruisefit trial -o trials --check"]),
    (
        "completions",
        &["cruisefit completions bash > ~/.local/share/bash-completion/completions/cruisefit"],
    ),
    ("man", &["cruisefit man ~/.local/share/man/man1"]),
    ("demo", &["cruisefit demo"]),
];

/// The grammar of the command line with examples and exit statuses.
pub(crate) fn command() -> clap::Command {
    command_told(|_| true)
}

/// The grammar for a run with these arguments: what they do not name is not told about, for a start should not describe
/// twenty-five other commands.
pub(crate) fn command_for(arguments: &[OsString]) -> clap::Command {
    command_told(|name| arguments.iter().any(|argument| argument == name))
}

fn command_told(is_told: impl Fn(&str) -> bool) -> clap::Command {
    let mut program = <Cli as clap::CommandFactory>::command()
        .after_help(StyledStr::from(format!("{STATUS_OF_PROGRAM}\n\n{STATUS}")));
    // In place: to take one out and put it back moves all others.
    for one in program.get_subcommands_mut() {
        let of_this = |(name, _): &&(&str, _)| *name == one.get_name() && is_told(name);
        let Some((name, examples)) = EXAMPLES.iter().find(of_this) else {
            continue;
        };
        let status = if *name == "monitor" { STATUS_OF_MONITOR } else { STATUS };
        let head = if examples.len() == 1 { "Example" } else { "Examples" };
        let help = format!("{head}:\n  {}\n\n{status}", examples.join("\n  "));
        *one = core::mem::take(one).after_help(help);
    }
    program
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_has_an_example_that_the_grammar_takes_and_its_statuses() {
        for one in command().get_subcommands() {
            let (_, examples) = EXAMPLES.iter().find(|(name, _)| *name == one.get_name()).unwrap();
            let help = one.clone().render_long_help().to_string();
            assert!(help.contains("Exit status: 0 done"), "{help}");
            for example in *examples {
                assert!(help.contains(example), "{example}");
                let line = example.split(" | ").last().unwrap();
                let words = line.split(" > ").next().unwrap().split(" < ").next().unwrap();
                let parsed = command().try_get_matches_from(words.split(' '));
                assert!(parsed.is_ok(), "{example}: {}", parsed.unwrap_err());
            }
        }
    }

    #[test]
    fn help_fits_80_columns() {
        let mut program = command().term_width(80);
        program.build();
        for one in program.get_subcommands_mut() {
            let help = one.render_help().to_string();
            let after = help.split("Example").next().unwrap();
            // The usage line of clap is not wrapped: it is copied.
            for line in after.lines().filter(|line| !line.starts_with("Usage:")) {
                assert!(line.chars().count() <= 80, "{line}");
            }
        }
    }
}
