//! The edges between crates are those of the table in `ARCHITECTURE.md`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// What each crate may depend on; `None` for a crate that may depend on all.
type Table = BTreeMap<String, Option<BTreeSet<String>>>;

#[test]
fn every_edge_between_crates_is_in_the_table() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let table = table_of(&fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap());
    let mut manifests = BTreeMap::new();
    for entry in fs::read_dir(root.join("crates")).unwrap() {
        let folder = entry.unwrap().path();
        if let Ok(manifest) = fs::read_to_string(folder.join("Cargo.toml")) {
            let name = folder.file_name().unwrap().to_str().unwrap().to_owned();
            manifests.insert(name, manifest);
        }
    }
    assert!(manifests.len() > 10 && table.len() > 10, "the workspace was not found");
    let found = edges_not_listed(&manifests, &table);
    assert!(
        found.is_empty(),
        "edges that the table \"depends on\" of ARCHITECTURE.md does not list (a new edge is a design decision):\n{}",
        found.join("\n")
    );
}

/// The rule on a made-up workspace, so that a check that finds nothing is seen to.
#[test]
fn an_edge_that_is_not_listed_is_found() {
    let table = table_of(
        "| crate | holds | depends on |\n|---|---|---|\n| `a` | x | – |\n| `b` | y | a |\n| `c` | z | all |\n",
    );
    let manifests = [
        ("a", "[dependencies]\nserde.workspace = true\n[dev-dependencies]\nb.workspace = true\n"),
        ("b", "[dependencies]\na.workspace = true\nc = { path = \"../c\" }\n"),
        ("c", "[dependencies]\na.workspace = true\nb.workspace = true\n"),
        ("d", "[dependencies]\na.workspace = true\n"),
    ]
    .map(|(name, manifest)| (name.to_owned(), manifest.to_owned()))
    .into();
    assert_eq!(edges_not_listed(&manifests, &table), ["b → c", "d → a"]);
}

fn edges_not_listed(manifests: &BTreeMap<String, String>, table: &Table) -> Vec<String> {
    let mut found = Vec::new();
    for (name, manifest) in manifests {
        for target in dependencies(manifest).filter(|target| manifests.contains_key(*target)) {
            let listed = match table.get(name) {
                Some(Some(listed)) => listed.contains(target),
                Some(None) => true,
                None => false,
            };
            if !listed {
                found.push(format!("{name} → {target}"));
            }
        }
    }
    found
}

/// Names under `[dependencies]`; those of tests and examples alone are free.
fn dependencies(manifest: &str) -> impl Iterator<Item = &str> {
    manifest
        .lines()
        .skip_while(|line| line.trim() != "[dependencies]")
        .skip(1)
        .take_while(|line| !line.starts_with('['))
        .filter_map(|line| line.split(['.', '=', ' ']).next())
        .filter(|name| !name.is_empty() && !name.starts_with('#'))
}

/// Reads the rows that begin with a crate's name in backquotes, below the header "depends on".
fn table_of(text: &str) -> Table {
    text.lines()
        .skip_while(|line| !(line.starts_with('|') && line.contains("depends on")))
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            let names = |cell: &str| -> BTreeSet<String> {
                cell.split(',').map(|name| name.trim().trim_matches('`').to_owned()).collect()
            };
            let last = cells.last().copied().unwrap_or_default();
            let listed = (!last.starts_with("all")).then(|| names(last));
            (cells[0].trim_matches('`').to_owned(), listed)
        })
        .collect()
}
