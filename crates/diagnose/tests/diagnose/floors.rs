//! The floors of this crate: a module imports from its own floor or a lower one, and the files of a floor import each other
//! in no circle.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that reads the sources"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Floors from the ground up.
const FLOORS: [&str; 22] = [
    "deciding",
    "priors",
    "thresholds",
    "math",
    "signals",
    "library",
    "baseline",
    "input",
    "output",
    "residuals",
    "learning",
    "hypotheses",
    "search",
    "fleet",
    "place",
    "advice",
    "judge",
    "diagnosis",
    "attainable",
    "numbers",
    // Tests of several floors at once.
    "oracles",
    "lib",
];

/// A module by its path below the crate, and the modules that it imports from, with the line.
type Imports = BTreeMap<String, Vec<(String, usize)>>;

#[test]
fn every_import_goes_down_or_stays_on_its_floor() {
    let imports = imports_of(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    assert!(imports.len() > 40, "the sources were not found");
    let found = upward(&imports);
    assert!(found.is_empty(), "imports from a lower floor to a higher one:\n{}", found.join("\n"));
}

#[test]
fn no_circle_among_files() {
    let imports = imports_of(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    let found = circle(&imports);
    assert!(found.is_none(), "a circle of files: {found:?}");
}

/// The rules on a made-up crate, so that a check that finds nothing is seen to.
#[test]
fn an_upward_import_and_a_circle_are_found() {
    let source =
        "use crate::judge::gap::{gap_of, is_real};\nfn f() { crate::search::folds::fold_of(1); }\n";
    let modules: BTreeSet<String> =
        ["math", "math::gram", "judge", "judge::gap", "search", "search::folds"]
            .map(str::to_owned)
            .into();
    let found = paths(source, "math::gram", &modules);
    assert_eq!(found, [("judge::gap".to_owned(), 1), ("search::folds".to_owned(), 2)]);
    let imports = Imports::from([
        ("math::gram".to_owned(), found),
        ("judge::gap".to_owned(), vec![("judge".to_owned(), 1)]),
        ("judge".to_owned(), vec![("judge::gap".to_owned(), 1)]),
    ]);
    assert_eq!(upward(&imports).len(), 2);
    assert_eq!(circle(&imports).unwrap(), ["judge", "judge::gap", "judge"]);
    let inner = paths("    use super::super::math::gram::Gram;", "search::folds", &modules);
    assert_eq!(inner, [("math::gram".to_owned(), 1)]);
}

fn floor_of(module: &str) -> usize {
    let first = module.split("::").next().unwrap_or(module);
    let found = FLOORS.iter().position(|floor| *floor == first);
    found.unwrap_or_else(|| panic!("the module `{first}` has no floor: add it to the list above"))
}

fn upward(imports: &Imports) -> Vec<String> {
    let mut found = Vec::new();
    for (module, targets) in imports {
        for (target, line) in targets {
            if floor_of(target) > floor_of(module) {
                found.push(format!("{module}, line {line}: {target}"));
            }
        }
    }
    found
}

/// Some circle of modules, its first module twice.
fn circle(imports: &Imports) -> Option<Vec<String>> {
    fn visit<'a>(
        imports: &'a Imports,
        module: &'a str,
        path: &mut Vec<&'a str>,
        done: &mut BTreeSet<&'a str>,
    ) -> Option<Vec<String>> {
        if let Some(start) = path.iter().position(|at| *at == module) {
            let names = path[start..].iter().chain([&module]);
            return Some(names.map(|name| (*name).to_owned()).collect());
        }
        if !done.insert(module) {
            return None;
        }
        path.push(module);
        for (target, _) in imports.get(module).into_iter().flatten() {
            if let Some(found) = visit(imports, target, path, done) {
                return Some(found);
            }
        }
        path.pop();
        None
    }
    let mut done = BTreeSet::new();
    imports.keys().find_map(|module| visit(imports, module, &mut Vec::new(), &mut done))
}

fn imports_of(src: &Path) -> Imports {
    let mut files = Vec::new();
    collect(src, &mut files);
    let module_of = |file: &Path| {
        let below = file.strip_prefix(src).unwrap().with_extension("");
        below.iter().map(|part| part.to_str().unwrap()).collect::<Vec<_>>().join("::")
    };
    let modules: BTreeSet<String> = files.iter().map(|file| module_of(file)).collect();
    files
        .iter()
        .map(|file| {
            let module = module_of(file);
            let found = paths(&fs::read_to_string(file).unwrap(), &module, &modules);
            (module, found)
        })
        .filter(|(module, _)| module != "lib") // names of the crate's root are re-exports
        .collect()
}

fn collect(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            into.push(path);
        }
    }
}

/// Modules of the crate that `crate::…` and `super::…` paths name, each with its line; the module itself left out.
fn paths(source: &str, module: &str, modules: &BTreeSet<String>) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    for (index, line) in without_tests_own(source).lines().enumerate() {
        let code = line.split("//").next().unwrap_or(line);
        for (start, _) in code.match_indices("crate::").chain(code.match_indices("super::")) {
            let before = code[..start].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '$') {
                continue; // the middle of another path
            }
            for target in targets(&code[start..], module, modules) {
                if target != module {
                    found.push((target, index + 1));
                }
            }
        }
    }
    found.sort_by_key(|(_, line)| *line);
    found
}

/// The modules that one path names: the longest known one, or several behind a brace.
fn targets(path: &str, module: &str, modules: &BTreeSet<String>) -> Vec<String> {
    let end = path.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'));
    let (plain, rest) = path.split_at(end.unwrap_or(path.len()));
    let mut at: Vec<&str> = module.split("::").collect();
    for part in plain.split("::").filter(|part| !part.is_empty()) {
        match part {
            "crate" => at.clear(),
            "super" => drop(at.pop()),
            name => at.push(name),
        }
    }
    let inside = rest.strip_prefix('{').and_then(|rest| rest.split('}').next()).unwrap_or("");
    let names: Vec<&str> = inside.split(',').map(str::trim).filter(|n| !n.is_empty()).collect();
    let names = if names.is_empty() { vec![""] } else { names };
    let mut found: Vec<String> = names
        .into_iter()
        .filter_map(|name| {
            let mut full: Vec<&str> = at.clone();
            full.extend(name.split("::").filter(|part| !part.is_empty()));
            while !full.is_empty() && !modules.contains(&full.join("::")) {
                full.pop();
            }
            // What is no module is a name of the crate's root, a re-export from any floor.
            let root = plain.starts_with("crate").then(|| "lib".to_owned());
            if full.is_empty() { root } else { Some(full.join("::")) }
        })
        .collect();
    found.dedup();
    found
}

/// The source with imports over several lines joined on their first one, and `super` of an inner test module, which is the
/// file itself, left out.
fn without_tests_own(source: &str) -> String {
    let mut out = String::new();
    let mut open: Option<usize> = None;
    let mut in_tests = false;
    for line in source.lines() {
        in_tests |= line.starts_with("mod tests {");
        let own = in_tests
            && line.trim_start().starts_with("use super::")
            && !line.contains("super::super");
        let line = if own { "" } else { line };
        let code = line.split("//").next().unwrap_or(line);
        if let Some(lines) = open {
            out.push_str(code.trim());
            open = Some(lines + 1);
            if code.contains(';') {
                out.push_str(&"\n".repeat(lines + 2));
                open = None;
            }
        } else if code.trim_start().trim_start_matches("pub ").starts_with("use ")
            && !code.contains(';')
        {
            out.push_str(code.trim_end());
            open = Some(0);
        } else {
            out.push_str(code);
            out.push('\n');
        }
    }
    out
}
