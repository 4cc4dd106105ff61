//! What the house asks of every file, as far as a program can see it: lengths, parameters, words, citations, examples.
//!
//! Offenders that are known are in `offenders.txt`, a line each. The list only shrinks: a new offender fails its test, and
//! so does a line of the list whose offender is gone.
#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test that reads the repository"
)]

mod functions;
mod source;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use functions::functions;
use source::code_only;

const MOST_LINES_OF_A_FILE: usize = 600;
const MOST_LINES_OF_A_FUNCTION: usize = 80;
const MOST_PARAMETERS: usize = 5;

#[test]
fn files_are_short() {
    let rule = "file over 600 lines";
    let long =
        library_files().into_iter().filter(|(_, text)| text.lines().count() > MOST_LINES_OF_A_FILE);
    only_known(rule, long.map(|(path, _)| path));
}

/// The page of the virtual aircraft gives the truth's own form of every effect, or why there is none.
#[test]
fn every_effect_has_its_form_in_the_book() {
    let page = std::fs::read_to_string(root().join("docs/src/theory/virtual_aircraft.md")).unwrap();
    let absent: Vec<String> = flight::effect::EffectId::ALL
        .iter()
        .map(|id| format!("`{}`", id.entry().name.replace("{k}", "k")))
        .filter(|name| !page.contains(name))
        .collect();
    assert_eq!(absent, Vec::<String>::new());
}

#[test]
fn functions_are_short() {
    let long =
        all_functions().into_iter().filter(|(_, lines, _)| *lines > MOST_LINES_OF_A_FUNCTION);
    only_known("function over 80 lines", long.map(|(name, _, _)| name));
}

#[test]
fn functions_have_few_parameters() {
    let wide =
        all_functions().into_iter().filter(|(_, _, parameters)| *parameters > MOST_PARAMETERS);
    only_known("function of more than 5 parameters", wide.map(|(name, _, _)| name));
}

/// A lint that is silenced is a rule that does not hold; code is shared by crates, not by paths.
#[test]
fn nothing_is_silenced_or_included_by_path() {
    for (rule, pattern) in [
        ("too_many_arguments silenced", "too_many_arguments"),
        ("too_many_lines silenced", "too_many_lines"),
        ("module by path", "#[path"),
        ("crate that names itself", "extern crate self"),
    ] {
        let holds = rust_files().into_iter().filter(|(_, text)| code_only(text).contains(pattern));
        only_known(rule, holds.map(|(path, _)| path));
    }
}

/// A reader of the repository has no contract and no specification: the book, a source or a measurement is cited.
#[test]
fn comments_cite_what_a_reader_has() {
    let phrases = ["contract", "specification"].map(|noun| format!("the {noun}"));
    let cites = files(&["rs", "md", "toml", "ron"]).into_iter().filter(|(_, text)| {
        // A phrase may be broken over two lines of a comment.
        let text = text.to_lowercase().replace("\n//", "\n").replace(['/', '!'], " ");
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        phrases.iter().any(|phrase| words.contains(phrase))
    });
    only_known("cites what a reader does not have", cites.map(|(path, _)| path));
}

/// Comments cite equations as `[page.3]`.
#[test]
fn cited_equations_exist() {
    let defined: BTreeSet<String> = ["docs/src/theory", "docs/src/guides"]
        .iter()
        .flat_map(|folder| below(&root().join(folder), &["md"]))
        .collect::<Vec<_>>()
        .iter()
        .flat_map(|(_, text)| text.lines().flat_map(named_in))
        .collect();
    assert!(defined.len() > 50, "the theory pages name {} equations", defined.len());
    let mut missing = BTreeSet::new();
    for (path, text) in rust_files() {
        let code = code_only(&text);
        for (at, _) in text.match_indices('[').filter(|(at, _)| code.as_bytes()[*at] == b' ') {
            let cited = equation(&text[at..]).filter(|id| !defined.contains(*id));
            missing.extend(cited.map(|id| format!("{id} in {path}")));
        }
    }
    only_known("equation that the book does not define", missing.into_iter());
}

#[test]
fn every_crate_has_an_example_that_ends_in_an_assertion() {
    let mut missing = Vec::new();
    for member in folders(&root().join("crates")) {
        let name = member.file_name().unwrap().to_str().unwrap().to_owned();
        let examples = below(&member.join("examples"), &["rs"]);
        // The command line, the Python module and the tests' support offer Rust nothing to call.
        if examples.is_empty() && !["cli", "python", "test-support"].contains(&name.as_str()) {
            missing.push(format!("crates/{name}"));
        }
        for (path, text) in examples {
            let code = code_only(&text);
            let main = functions(&code).into_iter().find(|function| function.name == "main");
            if !main.is_some_and(|main| code[main.span].contains("assert")) {
                missing.push(path);
            }
        }
    }
    only_known("no example that asserts", missing.into_iter());
}

/// Equations that a line of a theory page names: in front of the equation, in its tag, or in the sentence that states it.
fn named_in(line: &str) -> Vec<String> {
    let ids = |text: &str| -> Vec<String> {
        text.match_indices('[')
            .filter_map(|(at, _)| equation(&text[at..]))
            .map(str::to_owned)
            .collect()
    };
    match line.split_once("\\tag{") {
        Some((_, tag)) => ids(&format!("[{}]", tag.split('}').next().unwrap_or_default())),
        None => ids(line),
    }
}

/// `[page.3]` at the start of a text.
fn equation(text: &str) -> Option<&str> {
    let id = &text[..=text.find(']')?];
    let (page, number) = id.strip_prefix('[')?.strip_suffix(']')?.split_once('.')?;
    let is_page = !page.is_empty() && page.bytes().all(|b| b.is_ascii_lowercase() || b == b'_');
    let is_number = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
    (is_page && is_number).then_some(id)
}

/// Asserts that what offends a rule is exactly what is known to.
fn only_known(rule: &str, offenders: impl Iterator<Item = String>) {
    let found: BTreeSet<String> = offenders.map(|subject| format!("{rule}: {subject}")).collect();
    let known: BTreeSet<String> = include_str!("offenders.txt")
        .lines()
        .filter(|line| line.starts_with(&format!("{rule}: ")))
        .map(str::to_owned)
        .collect();
    let list =
        |lines: Vec<&String>| lines.into_iter().map(String::as_str).collect::<Vec<_>>().join("\n");
    let new = list(found.difference(&known).collect());
    let gone = list(known.difference(&found).collect());
    assert!(new.is_empty(), "mend, do not list:\n{new}");
    assert!(gone.is_empty(), "mended; take these lines out of tests/tidy/offenders.txt:\n{gone}");
}

/// Path and name, lines and parameters of every function of the libraries.
fn all_functions() -> Vec<(String, usize, usize)> {
    let mut all = Vec::new();
    for (path, text) in library_files() {
        let code = code_only(&text);
        for function in functions(&code) {
            let lines = code[function.span].lines().count();
            all.push((format!("{path}: {}", function.name), lines, function.parameters));
        }
    }
    assert!(all.len() > 1000, "{} functions found", all.len());
    all
}

/// Files of `crates/*/src`.
fn library_files() -> Vec<(String, String)> {
    let in_src = |path: &str| path.split('/').nth(2) == Some("src");
    rust_files().into_iter().filter(|(path, _)| in_src(path)).collect()
}

fn rust_files() -> Vec<(String, String)> {
    files(&["rs"])
}

/// Path and text of the files of all crates with these extensions, but for these tests.
fn files(extensions: &[&str]) -> Vec<(String, String)> {
    let mut files = below(&root().join("crates"), extensions);
    files.retain(|(path, _)| !path.starts_with("crates/test-support/tests/tidy"));
    assert!(!files.is_empty());
    files
}

/// Files below a folder, by their path from the root, in order; none where the folder does not exist.
fn below(folder: &Path, extensions: &[&str]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for path in entries(folder) {
        if path.is_dir() {
            found.extend(below(&path, extensions));
        } else if path.extension().is_some_and(|end| extensions.iter().any(|known| end == *known)) {
            let name = path.strip_prefix(root()).unwrap().to_str().unwrap().replace('\\', "/");
            found.push((name, std::fs::read_to_string(&path).unwrap()));
        }
    }
    found
}

fn folders(folder: &Path) -> Vec<PathBuf> {
    entries(folder).into_iter().filter(|path| path.join("Cargo.toml").is_file()).collect()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = folder.read_dir() else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap()
}
