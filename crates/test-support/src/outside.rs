//! Material that cannot be shipped with the repository (recordings of others, reference results of other programs), and
//! tests that need it.
//!
//! A folder with `data/README.md` and `golden/README.md` holds such material. It is looked for in the environment
//! variable `CRUISEFIT_DATA` and, where that is not set, among the folders that have the same parent as the repository's
//! root. A relative path in the variable starts at the root. A test that needs some of it asks [`outside_data`] and ends where there is none:
//!
//! ```no_run
//! let Some(flights) = test_support::outside_data("data/jsbsim-global5000") else {
//!     return; // the test has said that it is skipped, and why
//! };
//! assert!(flights.join("SIM-01").is_dir());
//! ```
//!
//! # How a skip becomes visible
//!
//! Neither the test runner of the standard library nor `cargo nextest` knows a test that is skipped when it runs, and
//! both swallow what a passing test prints. So a skip is said in two ways: a line written straight to standard error,
//! which the standard library's runner captures only from the print macros; and a line in `skipped-tests.txt` in the
//! build's target folder, where every runner's tests meet. `.ci/run` empties that file first and shows it at the end.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The environment variable that names the folder with outside material.
pub const VARIABLE: &str = "CRUISEFIT_DATA";

/// A file or folder of the outside material, by its path inside; `None`, said visibly ([`skip`]), where it is absent.
#[must_use]
pub fn outside_data(path: &str) -> Option<PathBuf> {
    let Some(folder) = folder() else {
        skip(&format!(
            "needs {path}: {VARIABLE} is not set, and no folder next to the repository holds outside data"
        ));
        return None;
    };
    let found = folder.join(path);
    if found.exists() {
        return Some(found);
    }
    skip(&format!("needs {path}, which {} does not hold", folder.display()));
    None
}

/// Says visibly that the running test is skipped, and why.
pub fn skip(reason: &str) {
    let line = format!("skipped: {}: {reason}\n", running_test());
    // Not being able to say so is no reason to fail a test.
    let _ = std::io::stderr().write_all(line.as_bytes());
    if let Some(mut file) = record() {
        let _ = file.write_all(line.as_bytes());
    }
}

/// Test program and test, as far as they are known.
fn running_test() -> String {
    let program = std::env::current_exe().ok();
    let stem = program.as_ref().and_then(|path| path.file_stem()?.to_str()).unwrap_or("tests");
    // Cargo names test programs after their file, a hyphen and a hash.
    let name = stem.rsplit_once('-').map_or(stem, |(name, _)| name);
    // With a thread for every test, which is the rule, the thread has the test's name.
    format!("{name}::{}", std::thread::current().name().unwrap_or("a test"))
}

/// The list of skipped tests in the target folder of the running test program, to append to.
fn record() -> Option<std::fs::File> {
    // target/debug/deps/test-…, target/debug/examples/…, or another profile's.
    let program = std::env::current_exe().ok()?;
    let target = program.ancestors().find(|folder| folder.join("CACHEDIR.TAG").is_file())?;
    OpenOptions::new().create(true).append(true).open(target.join("skipped-tests.txt")).ok()
}

fn folder() -> Option<PathBuf> {
    #[expect(clippy::disallowed_methods, reason = "where the material is differs by machine")]
    let named = std::env::var(VARIABLE).ok().filter(|path| !path.is_empty());
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().ok()?;
    if let Some(path) = named {
        return Some(root.join(path));
    }
    let mut siblings: Vec<PathBuf> =
        root.parent()?.read_dir().ok()?.filter_map(|entry| Some(entry.ok()?.path())).collect();
    siblings.sort();
    siblings.into_iter().find(|path| holds_material(path))
}

fn holds_material(folder: &Path) -> bool {
    ["data", "golden"].iter().all(|part| folder.join(part).join("README.md").is_file())
}
