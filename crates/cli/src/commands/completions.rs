//! `cruisefit completions`: what a shell completes after `cruisefit`, made from the grammar of the command line.

use crate::args::CompletionsArgs;
use crate::args::help::command;
use crate::commands::Outcome;

/// The script for standard output.
pub(crate) fn run(arguments: &CompletionsArgs) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command(), "cruisefit", &mut script);
    Outcome::text(String::from_utf8_lossy(&script))
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;
    use clap_complete::Shell;

    use super::*;

    #[test]
    fn every_shell_completes_every_command() {
        for shell in Shell::value_variants() {
            let script = run(&CompletionsArgs { shell: *shell }).text;
            for command in command().get_subcommands() {
                assert!(script.contains(command.get_name()), "{shell}: {}", command.get_name());
            }
        }
    }
}
