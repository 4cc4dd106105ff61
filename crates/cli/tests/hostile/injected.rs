//! Names that a terminal, a browser, a spreadsheet or a file system would act on.

use std::path::{Path, PathBuf};
use std::process::Command;

const ESCAPE: char = '\u{1b}';

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/global5000").join(name)
}

/// Status, standard output and standard error together.
fn run(arguments: &[&std::ffi::OsStr]) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_cruisefit"))
        .args(arguments)
        .env("NO_COLOR", "1")
        .env_remove("RUST_LOG")
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].concat();
    (output.status.code().unwrap_or(-1), String::from_utf8(text).unwrap())
}

/// `adapt` of a report whose header has these values, in a folder of its own: status, output, files written.
fn adapted(scratch: &Path, key: &str, value: &str) -> (i32, String, Vec<PathBuf>) {
    let model = scratch.join("MODEL.ron");
    let (aircraft, guide) = (fixture("AIRCRAFT.ron"), fixture("guide.csv"));
    let init = ["init", "--aircraft"].map(AsRef::as_ref);
    let rest = [
        aircraft.as_os_str(),
        "--guide".as_ref(),
        guide.as_os_str(),
        "-o".as_ref(),
        model.as_os_str(),
    ];
    assert_eq!(run(&[&init[..], &rest[..]].concat()).0, 0);
    let good = std::fs::read_to_string(fixture("reports/0001.txt")).unwrap();
    let changed: String =
        good.lines()
            .map(|line| {
                if line.starts_with(key) { format!("{key} {value}\n") } else { format!("{line}\n") }
            })
            .collect();
    assert_ne!(good, changed);
    let (report, output) = (scratch.join("report.txt"), scratch.join("folder/out"));
    std::fs::create_dir(scratch.join("folder")).unwrap();
    std::fs::write(&report, changed).unwrap();
    let (status, text) = run(&[
        "adapt".as_ref(),
        report.as_os_str(),
        "--model".as_ref(),
        model.as_os_str(),
        "-o".as_ref(),
        output.as_os_str(),
    ]);
    (status, text, files_below(scratch))
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { open.push(path) } else { files.push(path) }
        }
    }
    files
}

#[test]
fn control_characters_and_formulas_in_a_name_are_text() {
    for key in ["TAIL", "FLIGHT"] {
        for value in [
            "x\u{1b}[2J\u{1b}]0;owned\u{7}",
            "a\u{9b}2J",
            "=1+1",
            "+1+1",
            "@SUM(A1)",
            "-2+3|' /C calc'!A0",
        ] {
            let scratch = tempfile::tempdir().unwrap();
            let (status, text, files) = adapted(scratch.path(), key, value);
            assert_eq!(status, 0, "{key} {value:?}: {text}");
            assert!(!text.contains(|c: char| c.is_control() && c != '\n' && c != '\t'), "{text:?}");
            for file in files.iter().filter(|file| file.extension().is_some_and(|e| e == "csv")) {
                let table = std::fs::read_to_string(file).unwrap();
                assert!(!table.contains([ESCAPE, '\u{9b}', '\u{7}']), "{file:?}");
                let formula = |cell: &str| cell.trim_start_matches('"').starts_with(value);
                let is_formula = value.starts_with(['=', '+', '@', '-']);
                assert!(
                    !is_formula || !table.lines().any(|line| line.split(',').any(formula)),
                    "{file:?}"
                );
            }
        }
    }
}

#[test]
fn a_tail_that_is_a_path_stays_in_the_folder() {
    for value in ["../../x", "/etc/passwd", "..", "a/b", "C:\\x", "~/x", "CON", "%2E"] {
        let scratch = tempfile::tempdir().unwrap();
        let (status, text, files) = adapted(scratch.path(), "TAIL", value);
        assert_eq!(status, 0, "{value:?}: {text}");
        let output = scratch.path().join("folder/out");
        let known = [scratch.path().join("MODEL.ron"), scratch.path().join("report.txt")];
        for file in files.iter().filter(|file| !known.contains(file)) {
            assert!(file.starts_with(&output), "{value:?} wrote {file:?}");
            let depth = file.strip_prefix(&output).unwrap().components().count();
            assert!(depth <= 2, "{value:?} wrote {file:?}");
        }
    }
}

#[test]
fn markup_in_names_is_text_on_the_page() {
    for key in ["TAIL", "FLIGHT"] {
        let scratch = tempfile::tempdir().unwrap();
        let value = "<script>alert(1)</script><img src=x onerror=alert(2)>'\"&";
        let (status, text, files) = adapted(scratch.path(), key, value);
        assert_eq!(status, 0, "{text}");
        let pages: Vec<&PathBuf> = files
            .iter()
            .filter(|file| file.extension().is_some_and(|ending| ending == "html"))
            .collect();
        assert!(!pages.is_empty());
        for page in pages {
            let page = std::fs::read_to_string(page).unwrap();
            assert!(!page.contains("<script>alert") && !page.contains("<img src=x"), "{key}");
        }
    }
}

/// The name of a file is not checked, because it exists; it is shown harmless.
#[cfg(unix)]
#[test]
fn a_file_name_does_not_reach_the_terminal_as_a_sequence() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join(format!("x{ESCAPE}[2J.txt"));
    std::fs::write(&path, "nothing\n").unwrap();
    let good = fixture("reports/0001.txt");
    let table = scratch.path().join("s.csv");
    let (status, text) = run(&[
        "segment".as_ref(),
        path.as_os_str(),
        good.as_os_str(),
        "-o".as_ref(),
        table.as_os_str(),
    ]);
    assert_eq!(status, 1, "{text}");
    assert!(!text.contains(ESCAPE), "{text:?}");
}
