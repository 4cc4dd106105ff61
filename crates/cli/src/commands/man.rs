//! `cruisefit man`: a manual page of the program and of each command, made from the grammar of the command line.

use crate::args::ManArgs;
use crate::commands::Outcome;
use crate::failure::{Failure, show};
use crate::files::{make_folder, write_atomically};

/// Writes `cruisefit.1`, `cruisefit-COMMAND.1`, …; to `-` the first of them.
///
/// # Errors
/// A folder or file that cannot be written.
pub(crate) fn run(arguments: &ManArgs) -> Result<Outcome, Failure> {
    let folder = &arguments.folder;
    let pages =
        pages(crate::args::help::command()).map_err(|error| Failure::unwritable(folder, error))?;
    if folder.as_os_str() == "-" {
        let program = pages.first().map(|(_, page)| String::from_utf8_lossy(page).into_owned());
        let figures = serde_json::json!({ "page": program });
        return Ok(Outcome::with_figures(program.unwrap_or_default(), figures));
    }
    make_folder(folder)?;
    for (name, page) in &pages {
        write_atomically(&folder.join(name), page)?;
    }
    let text = format!("{} pages written to {}\n", pages.len(), show(folder));
    let written: Vec<String> = pages.iter().map(|(name, _)| show(&folder.join(name))).collect();
    Ok(Outcome::with_figures(text, serde_json::json!({ "pages": pages.len(), "written": written })))
}

/// Every page with its file name: of the program, then of its commands in the order of the help.
fn pages(program: clap::Command) -> std::io::Result<Vec<(String, Vec<u8>)>> {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let mut pages = vec![("cruisefit.1".to_owned(), page(program.clone())?)];
    for command in program.get_subcommands() {
        pages.push((format!("cruisefit-{}.1", command.get_name()), page(command.clone())?));
    }
    Ok(pages)
}

fn page(command: clap::Command) -> std::io::Result<Vec<u8>> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page)?;
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::help::command;

    #[test]
    fn every_command_has_a_page() {
        let pages = pages(command()).unwrap();
        assert_eq!(pages.len(), 1 + command().get_subcommands().count());
        for (name, page) in pages {
            let page = String::from_utf8(page).unwrap();
            assert!(page.contains(".TH") && page.contains(".SH SYNOPSIS"), "{name}");
        }
    }
}
