//! The pages as a browser shows them: nothing loaded, nothing on the console, charts drawn, tables that sort and filter, links,
//! keys, phone, print, and the numbers of the documents.

mod charts;
mod driver;
mod made_up;
mod probes;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::model_file::ModelFile;
use pipeline::segments_table;
use pipeline::summary::{ReportsSummary, SCHEMA, Summary};
use serde_json::Value;
use test_support::outside::skip;

use crate::support::{cruisefit, fixture};
use driver::Browser;
use probes::{
    check_drawn, check_laid_out_for_print, check_loaded, check_numbers_of_rows, check_phone,
    check_print, check_saved,
};

/// The version of axe-core that pages are held to.
const AXE: &str = "axe-core@4.14.1";
/// What the demo writes, and the months of its folder.
const PAGES: [&str; 3] =
    ["adapted-bayes/report.html", "diagnosis/diagnosis.html", "monitor/monitor.html"];
const ENTER: char = '\u{e007}';
const ARROW_RIGHT: char = '\u{e014}';

#[test]
fn pages_of_the_demo() {
    let Some(browser) = Browser::start() else { return };
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    cruisefit(&["demo".as_ref(), "-o".as_ref(), folder.as_os_str()]).expect(0);
    let adapted = folder.join("adapted-bayes");
    monitor(folder);
    for name in PAGES {
        let page = folder.join(name);
        browser.open(&page);
        check_loaded(&browser, &page);
        check_drawn(&browser, name);
        check_phone(&browser, name);
        check_saved(&browser, name);
        check_print(&browser, name);
    }
    browser.open(&folder.join("diagnosis/diagnosis.html"));
    check_causes(&browser, &document(&folder.join("diagnosis/diagnosis.json")));
    check_keys_and_pointer(&browser);
    charts::check_values(&browser, &folder.join("diagnosis/gaps.csv"));
    browser.open(&adapted.join("report.html"));
    check_numbers_of_rows(&browser, &document(&adapted.join("summary.json")));
    charts::check_zoom(&browser);
    charts::check_zoom_by_keys(&browser);
    charts::check_whole_in_print(&browser);
    charts::check_turn(&browser);
}

#[test]
fn pages_have_no_barrier() {
    let Some(browser) = Browser::start() else { return };
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    cruisefit(&["demo".as_ref(), "-o".as_ref(), folder.as_os_str()]).expect(0);
    monitor(folder);
    for name in PAGES {
        check_no_barrier(&browser, &folder.join(name));
    }
}

/// No violation by axe-core, light or dark, with everything unfolded.
fn check_no_barrier(browser: &Browser, page: &Path) {
    let Some(axe) = axe() else { return };
    for scheme in ["light", "dark"] {
        probes::color_scheme(browser, scheme);
        browser.open(page);
        let found = browser.run_waiting(
            "(0, eval)(given); for (const fold of document.querySelectorAll('details')) fold.open = true;
             const { violations } = await axe.run();
             return violations.map((one) => `${one.id}: ${one.nodes[0].html.slice(0, 200)} ${one.nodes[0].failureSummary}`);",
            &axe,
        );
        assert_eq!(found, serde_json::json!([]), "{}, {scheme}", page.display());
    }
}

/// 200 tails, one of them with a name that a page could take for a piece of itself.
#[test]
fn a_page_of_200_tails() {
    const HOSTILE: &str = "<b onmouseover=alert(1)>&\"N1\"";
    let Some(browser) = Browser::start() else { return };
    let scratch = tempfile::tempdir().unwrap();
    let page = scratch.path().join("report.html");
    let summary = large_fleet(&page, HOSTILE);
    assert!(fs::metadata(&page).unwrap().len() < 6_000_000, "a page that can be mailed");
    browser.open(&page);
    check_loaded(&browser, &page);
    check_phone(&browser, "200 tails");
    check_numbers_of_rows(&browser, &summary);
    let names = "const names = () => [...document.querySelectorAll('table.fleet tbody tr:not([hidden]) th')].map((cell) => cell.innerText);";
    assert_eq!(browser.run("return document.querySelectorAll('[onmouseover]').length"), 0);
    assert_eq!(
        browser.run(&format!("{names} return names().includes(String.raw`{HOSTILE}`)")),
        true
    );

    // Worst first as written; a click on the first heading sorts by name.
    let first = "const head = document.querySelector('table.fleet thead th button'); head.focus();";
    browser.run(first);
    browser.press(&[ENTER]);
    let falling = browser.run(&format!("{names} return names()"));
    browser.press(&[ENTER]);
    let rising = browser.run(&format!("{names} return names()"));
    let mut turned = falling.as_array().unwrap().clone();
    turned.reverse();
    assert_eq!(rising.as_array().unwrap(), &turned, "the second press turns the order round");
    assert_eq!(rising.as_array().unwrap().len(), 200);

    browser.run("const filter = document.querySelector('input[type=search]'); filter.focus();");
    browser.press(&['T', '-', '1', '7', '3']);
    assert_eq!(browser.run(&format!("{names} return names()")), serde_json::json!(["T-173"]));

    // A link unfolds the tail that it leads to and shows it.
    let shown = browser.run_waiting(
        "[...document.querySelectorAll('table.fleet a')].find((link) => link.innerText === 'T-173').click();
         await new Promise((done) => setTimeout(done, 300));
         const target = document.getElementById(location.hash.slice(1));
         const { top } = target.getBoundingClientRect();
         return [target.closest('details').open, top > -5 && top < innerHeight];",
        "",
    );
    assert_eq!(shown, serde_json::json!([true, true]));
    // Its PDF takes the browser longer than the driver waits: what is laid out for print has to do.
    check_laid_out_for_print(&browser, "200 tails");
}

/// Two hundred tails compared with each other.
#[test]
fn a_fleet_of_200_tails() {
    let Some(browser) = Browser::start() else { return };
    let scratch = tempfile::tempdir().unwrap();
    let page = scratch.path().join("fleet.html");
    let fleet = made_up::fleet(&page);
    assert!(fs::metadata(&page).unwrap().len() < 6_000_000, "a page that can be mailed");
    browser.open(&page);
    check_loaded(&browser, &page);
    check_drawn(&browser, "fleet.html");
    check_phone(&browser, "fleet.html");
    check_saved(&browser, "fleet.html");
    check_print(&browser, "fleet.html");
    browser.open(&page);
    check_sizes(&browser, &fleet);
    browser.run("document.querySelector('svg[tabindex]').focus();");
    browser.press(&[ARROW_RIGHT]);
    let told = browser.run(
        "return [document.getElementById('tip').innerText, document.querySelector('table.heat tbody th').innerText]",
    );
    let (tip, first) = (told[0].as_str().unwrap(), told[1].as_str().unwrap());
    assert!(tip.starts_with(&format!("{first}: ")), "the first tail has a name: {told}");
    browser.run("document.querySelector('input[type=search]').focus();");
    browser.press(&['T', '-', '1', '7', '3']);
    let left = browser.run(
        "return [...document.querySelectorAll('table.heat tbody tr:not([hidden]) th')].map((cell) => cell.innerText);",
    );
    assert_eq!(left, serde_json::json!(["T-173"]));
    check_no_barrier(&browser, &page);
}

/// The page of blind trials with thirty effects.
#[test]
fn a_page_of_trials() {
    let Some(browser) = Browser::start() else { return };
    let scratch = tempfile::tempdir().unwrap();
    let page = scratch.path().join("trials.html");
    made_up::trials(&page);
    browser.open(&page);
    check_loaded(&browser, &page);
    check_drawn(&browser, "trials.html");
    check_phone(&browser, "trials.html");
    check_saved(&browser, "trials.html");
    check_print(&browser, "trials.html");
    check_no_barrier(&browser, &page);
}

/// The table of tails has every size of the document, number by number.
fn check_sizes(browser: &Browser, fleet: &Value) {
    let rows = browser.run(
        "return [...document.querySelectorAll('table.heat tbody tr')].map((row) => [row.cells[0].innerText,
           [...row.cells].slice(1).map((cell) => +cell.dataset.v)]);",
    );
    let rows = rows.as_array().unwrap();
    let tails = fleet["tails"].as_array().unwrap();
    assert_eq!(rows.len(), tails.len());
    for tail in tails {
        let row = rows.iter().find(|row| row[0] == tail["tail"]).unwrap();
        let shown: Vec<f64> = row[1].as_array().unwrap().iter().filter_map(Value::as_f64).collect();
        let effects = tail["effects"].as_array().unwrap();
        let sizes = effects.iter().map(|effect| &effect["magnitude"]["value"]);
        for number in sizes.chain(["flights", "segments", "noise"].map(|name| &tail[name])) {
            let number = number.as_f64().unwrap();
            assert!(
                shown.iter().any(|one| (one - number).abs() <= 1e-12 * number.abs()),
                "{number} in {shown:?}"
            );
        }
    }
}

/// Writes a page of 200 tails with the flights of the fixture, whose errors differ by tail, and returns its document.
fn large_fleet(page: &Path, hostile: &str) -> Value {
    let text = |name: &str| fs::read(fixture("expected").join(name)).unwrap();
    let model = ModelFile::from_text(std::str::from_utf8(&text("SIM-01.ron")).unwrap()).unwrap();
    let segments = segments_table::read(&text("SIM-01_segments.csv")).unwrap();
    let tails: Vec<TailResult> = (0..200_usize)
        .map(|k| {
            let tail = if k == 60 { hostile.to_owned() } else { format!("T-{k:03}") };
            let mut segments = segments.clone();
            for segment in &mut segments {
                segment.means.fuel_flow_total_kg_s *= 1.0 + 1e-4 * (k as f64 - 100.0);
            }
            let counts = TailCounts { flights: 12, flights_new: 12, samples: 900 };
            let notes = Vec::new();
            let model = model.clone();
            TailResult::adapted(TailData { tail, model, segments, counts, notes, curve: None })
        })
        .collect();
    let summary = Summary {
        schema: SCHEMA,
        reports: ReportsSummary::default(),
        tails: tails.iter().map(|tail| tail.summary.clone()).collect(),
    };
    fs::write(page, page::report(&summary, &tails, "200 tails")).unwrap();
    serde_json::from_slice(&summary.to_json()).unwrap()
}

/// Months of what the demo adapted.
fn monitor(demo: &Path) {
    let (adapted, output) = (demo.join("adapted-bayes"), demo.join("monitor"));
    cruisefit(&["monitor".as_ref(), adapted.as_os_str(), "-o".as_ref(), output.as_os_str()])
        .expect(0);
}

/// Every cause of the document is in the table of all causes, number by number.
fn check_causes(browser: &Browser, document: &Value) {
    let shown = browser.run(
        "for (const fold of document.querySelectorAll('details')) fold.open = true;
         return [...document.querySelectorAll('table[data-name=all-causes]')].map((table) =>
           [...table.tBodies[0].rows].map((row) => [...row.cells].map((cell) => cell.innerText.trim())));",
    );
    let tables = shown.as_array().unwrap();
    let with_causes: Vec<&Value> = document["diagnoses"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|one| !one["causes"].as_array().unwrap().is_empty())
        .collect();
    assert!(!with_causes.is_empty(), "the demo has a diagnosis with causes");
    assert_eq!(tables.len(), with_causes.len());
    for (rows, diagnosis) in tables.iter().zip(with_causes) {
        let causes = diagnosis["causes"].as_array().unwrap();
        assert_eq!(rows.as_array().unwrap().len(), causes.len());
        for (row, cause) in rows.as_array().unwrap().iter().zip(causes) {
            let cell = |k: usize| row[k].as_str().unwrap();
            assert_eq!(cell(0), cause["effect"].as_str().unwrap());
            for (k, name) in [(1, "probability"), (2, "probability_flat")] {
                let shown: f64 = cell(k).parse().unwrap();
                assert!((shown - cause[name].as_f64().unwrap()).abs() <= 0.000_501, "{name}");
            }
            let size: f64 = cell(3).parse().unwrap();
            let exact = cause["magnitude"]["value"].as_f64().unwrap();
            assert!((size - exact).abs() <= 0.006 * exact.abs().max(0.01), "{size} {exact}");
        }
    }
}

/// A value appears at the pointer and at the arrow keys, and goes with Escape.
fn check_keys_and_pointer(browser: &Browser) {
    let tip = "const tip = document.getElementById('tip'); return tip.style.display === 'block' ? tip.innerText : '';";
    browser.run("document.querySelector('svg[tabindex]:has(.dot)').focus();");
    browser.press(&[ARROW_RIGHT, ARROW_RIGHT]);
    let told = browser.run(tip);
    assert!(told.as_str().unwrap().contains(": "), "{told}");
    browser.press(&['\u{e00c}']);
    assert_eq!(browser.run(tip), "");
    // A map without points is stepped through cell by cell.
    browser.run(
        "[...document.querySelectorAll('svg[tabindex]:has(.cell)')].find((one) => !one.querySelector('.dot,.disc')).focus();",
    );
    browser.press(&[ARROW_RIGHT]);
    let told = browser.run(tip);
    assert!(told.as_str().unwrap().starts_with("Mach "), "{told}");
    browser.press(&['\u{e00c}']);
    let place = browser.run(
        "const cell = document.querySelector('svg .cell'); cell.scrollIntoView({ block: 'center' });
         const { x, y, width, height } = cell.getBoundingClientRect(); return [x + width / 2, y + height / 2];",
    );
    browser.point(place[0].as_f64().unwrap(), place[1].as_f64().unwrap());
    let told = browser.run(tip);
    assert!(told.as_str().unwrap().contains("Mach"), "{told}");
}

fn document(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// The source of axe-core, fetched once by npm; `None`, said visibly, where that cannot be.
fn axe() -> Option<String> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("axe");
    let source = folder.join("node_modules/axe-core/axe.min.js");
    if !source.is_file() {
        let fetched = Command::new("npm")
            .args(["install", "--no-audit", "--no-fund", "--ignore-scripts", "--prefix"])
            .arg(&folder)
            .arg(AXE)
            .output();
        if !fetched.is_ok_and(|output| output.status.success()) {
            skip(&format!("npm cannot fetch {AXE}"));
            return None;
        }
    }
    Some(fs::read_to_string(source).unwrap())
}
