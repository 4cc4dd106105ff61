//! `cruisefit.toml`: options of a project that every command would otherwise repeat.
//!
//! The file is a small part of TOML: `key = value` lines, where a value is a text in quotes, a number, or a list of texts in one
//! line, and comments. A key is the long name of an option; what the command line gives wins. Files are looked for beside
//! the project file.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::CommandFactory;

use crate::args::Cli;
use crate::failure::Failure;
use crate::files::read_text;

/// The file that is looked for in the working folder.
const FILE_NAME: &str = "cruisefit.toml";
/// The option that names another one.
const OPTION: &str = "--project";

/// Keys of a project file, each an option of some command, and whether it names a file.
const KEYS: [(&str, Names); 9] = [
    ("aircraft", Names::File),
    ("guide", Names::File),
    ("sensors", Names::File),
    ("model", Names::File),
    ("mapping", Names::FileOrPreset),
    ("criteria", Names::FileOrPreset),
    ("events", Names::File),
    ("law", Names::Word),
    ("threads", Names::Word),
];

/// What a value is the name of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Names {
    File,
    FileOrPreset,
    Word,
}

/// An entry of the file: an option without its dashes, and values.
type Entry = (&'static str, Vec<String>);

/// The command line with what a project file adds to it.
///
/// # Errors
/// A project file that cannot be read or holds what it may not.
pub(crate) fn with_project(arguments: Vec<OsString>) -> Result<Vec<OsString>, Failure> {
    let (path, arguments) = project_file(arguments)?;
    let Some(path) = path else { return Ok(arguments) };
    let entries = entries_of(&read_text(&path)?, &path)?;
    let Some(command) = command_of(&arguments) else { return Ok(arguments) };
    let is_given = |name: &str| {
        let (whole, with_value) = (format!("--{name}"), format!("--{name}="));
        let mut given = arguments.iter().take_while(|one| *one != "--");
        given.any(|one| {
            let one = one.to_string_lossy();
            one == whole || one.starts_with(&with_value)
        })
    };
    let mut added: Vec<OsString> = Vec::new();
    let mut used = Vec::new();
    for (name, values) in &entries {
        // A table of flight points has columns of its own: a project's mapping is for recordings.
        let is_for_points = *name == "mapping" && command.get_name() == "predict";
        if is_given(name) || !takes(&command, name, values.len()) || is_for_points {
            continue;
        }
        used.push(*name);
        let folder = path.parent().unwrap_or(Path::new(""));
        for value in values {
            added.push(format!("--{name}={}", resolved(name, value, folder)).into());
        }
    }
    if !used.is_empty() {
        crate::terminal::tell(&format!("{}: {}\n", path.display(), used.join(", ")));
    }
    let mut arguments = arguments;
    // Before a `--`, behind which all are files.
    let end = arguments.iter().position(|one| *one == "--").unwrap_or(arguments.len());
    arguments.splice(end..end, added);
    Ok(arguments)
}

/// The project file: the one that is named, or the one in the working folder; and the arguments without its option.
fn project_file(arguments: Vec<OsString>) -> Result<(Option<PathBuf>, Vec<OsString>), Failure> {
    let mut named = None;
    let mut rest = Vec::with_capacity(arguments.len());
    let mut arguments = arguments.into_iter();
    while let Some(argument) = arguments.next() {
        let text = argument.to_string_lossy().into_owned();
        if text == OPTION {
            named = Some(arguments.next().ok_or_else(|| Failure::BadArgument {
                argument: OPTION,
                reason: "expected a file".to_owned(),
            })?);
        } else if let Some(path) = text.strip_prefix("--project=") {
            named = Some(path.into());
        } else {
            let is_end = text == "--";
            rest.push(argument);
            if is_end {
                rest.extend(arguments.by_ref());
            }
        }
    }
    let found = named.map(PathBuf::from).or_else(|| {
        let beside = PathBuf::from(FILE_NAME);
        beside.is_file().then_some(beside)
    });
    Ok((found, rest))
}

/// The command that is asked for.
fn command_of(arguments: &[OsString]) -> Option<clap::Command> {
    let all = Cli::command();
    let words = || arguments.iter().skip(1);
    let place = words().position(|one| all.find_subcommand(one).is_some())?;
    // `help` takes the name of a command and nothing of a project; it is no command before it is built.
    if words().take(place).any(|one| one == "help") {
        return None;
    }
    let mut found = words().nth(place).and_then(|one| all.find_subcommand(one))?.clone();
    found.build();
    Some(found)
}

/// Whether a command takes so many values of an option.
fn takes(command: &clap::Command, name: &str, values: usize) -> bool {
    let option = || command.get_arguments().find(|one| one.get_long() == Some(name));
    name == "threads"
        || option()
            .is_some_and(|one| values <= 1 || matches!(one.get_action(), clap::ArgAction::Append))
}

/// A value as the command line would have it: files beside the project file.
fn resolved(name: &str, value: &str, folder: &Path) -> String {
    let names = KEYS.iter().find(|(known, _)| *known == name).map(|(_, names)| *names);
    let beside = folder.join(value);
    match names {
        Some(Names::File) => beside.to_string_lossy().into_owned(),
        Some(Names::FileOrPreset) if beside.exists() => beside.to_string_lossy().into_owned(),
        _ => value.to_owned(),
    }
}

fn entries_of(text: &str, path: &Path) -> Result<Vec<Entry>, Failure> {
    let mut entries: Vec<Entry> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let refuse =
            |reason: String| Failure::bad_file(path, format!("line {}: {reason}", index + 1));
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let (key, value) = line
            .split_once('=')
            .ok_or_else(|| refuse(format!("found {line:?}, expected key = value")))?;
        let key = key.trim();
        let known = KEYS.iter().find(|(known, _)| *known == key);
        let Some((name, _)) = known else { return Err(refuse(unknown(key))) };
        if entries.iter().any(|(other, _)| other == name) {
            return Err(refuse(format!("{name} for the second time")));
        }
        let values = values_of(value).ok_or_else(|| {
            refuse(format!(
                "found {:?} for {name}, expected a text in quotes, a number, or texts in brackets",
                value.trim()
            ))
        })?;
        entries.push((*name, values));
    }
    Ok(entries)
}

fn unknown(key: &str) -> String {
    let names = KEYS.map(|(name, _)| name);
    let meant = report::nearest(key, names)
        .map_or_else(String::new, |name| format!("; did you mean {name:?}?"));
    format!("found {key:?}, expected one of {}{meant}", names.join(", "))
}

/// The values behind an equals sign.
fn values_of(text: &str) -> Option<Vec<String>> {
    let text = text.trim();
    let Some(list) = text.strip_prefix('[') else {
        let (value, rest) = value_of(text)?;
        return is_end(rest).then_some(vec![value]);
    };
    let mut values = Vec::new();
    let mut rest = list.trim_start();
    loop {
        if let Some(behind) = rest.strip_prefix(']') {
            return is_end(behind).then_some(values);
        }
        let (value, behind) = value_of(rest)?;
        values.push(value);
        let behind = behind.trim_start();
        rest = behind.strip_prefix(',').map_or(behind, str::trim_start);
    }
}

/// A value, and what is behind it.
fn value_of(text: &str) -> Option<(String, &str)> {
    let quote = text.chars().next()?;
    if quote == '\'' {
        return text[1..].split_once('\'').map(|(value, rest)| (value.to_owned(), rest));
    }
    if quote != '"' {
        let end = text.find([' ', ',', ']', '#']).unwrap_or(text.len());
        let number = &text[..end];
        return number.parse::<f64>().ok().map(|_| (number.to_owned(), &text[end..]));
    }
    let mut value = String::new();
    let mut letters = text[1..].char_indices();
    while let Some((at, letter)) = letters.next() {
        match letter {
            '"' => return Some((value, &text[1 + at + 1..])),
            '\\' => value.push(match letters.next()?.1 {
                known @ ('"' | '\\') => known,
                _ => return None,
            }),
            _ => value.push(letter),
        }
    }
    None
}

/// Nothing but a comment.
fn is_end(rest: &str) -> bool {
    let rest = rest.trim();
    rest.is_empty() || rest.starts_with('#')
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values are those that Python's `tomllib` reads from the same text.
    #[test]
    fn values_are_those_of_toml() {
        let text = "# a comment\n\nmodel = [\"A.ron\", 'B \"x\".ron',] # two\nmapping=\"a\\\\b.ron\"\nthreads = 4\n";
        let entries = entries_of(text, Path::new("p")).unwrap();
        let expected: Vec<Entry> = vec![
            ("model", vec!["A.ron".to_owned(), "B \"x\".ron".to_owned()]),
            ("mapping", vec!["a\\b.ron".to_owned()]),
            ("threads", vec!["4".to_owned()]),
        ];
        assert_eq!(entries, expected);
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        for (text, expected) in [
            ("model = \"A\"\nmaping = \"B\"", "line 2: found \"maping\""),
            ("maping = \"B\"", "did you mean \"mapping\"?"),
            ("[section]", "line 1: found \"[section]\", expected key = value"),
            ("model = A.ron", "expected a text in quotes"),
            ("model = \"A\" \"B\"", "expected a text in quotes"),
            ("model = \"A", "expected a text in quotes"),
            ("model = \"A\"\nmodel = \"B\"", "line 2: model for the second time"),
        ] {
            let error = entries_of(text, Path::new("p")).unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
