//! `cruisefit completions`: what a shell completes after `cruisefit`, made from the grammar of the command line.

use crate::args::CompletionsArgs;
use crate::args::help::command;
use crate::commands::Outcome;

/// The script for standard output.
pub(crate) fn run(arguments: &CompletionsArgs) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command(), "cruisefit", &mut script);
    let script = String::from_utf8_lossy(&script);
    let figures = serde_json::json!({ "shell": arguments.shell.to_string() });
    Outcome::with_figures(script, figures)
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;
    use clap_complete::Shell;

    use super::*;
    use crate::args::JsonFlag;

    #[test]
    fn every_shell_completes_every_command() {
        for shell in Shell::value_variants() {
            let script = run(&CompletionsArgs { shell: *shell, json: JsonFlag::default() }).text;
            for command in command().get_subcommands() {
                assert!(script.contains(command.get_name()), "{shell}: {}", command.get_name());
            }
        }
    }
}
