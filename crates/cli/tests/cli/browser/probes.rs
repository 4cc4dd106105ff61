//! What every page must be in a browser, as questions to the page that is open.

use std::path::Path;

use serde_json::{Value, json};

use super::driver::Browser;

/// Width of a small phone, in the page's pixels.
const PHONE: u32 = 390;
/// Least number of coloured pixels of a chart: a frame with a few points has some thousand.
const LEAST_COLOURED: f64 = 200.0;

/// Nothing on the console, and no request but the page itself.
pub(super) fn check_loaded(browser: &Browser, page: &Path) {
    let (console, requests) = browser.console_and_requests();
    assert_eq!(console, Vec::<String>::new(), "{}", page.display());
    assert_eq!(requests, vec![format!("file://{}", page.display())]);
}

/// Every chart has marks inside its frame, and the first one coloured pixels.
pub(super) fn check_drawn(browser: &Browser, name: &str) {
    let empty = browser.run(
        "for (const fold of document.querySelectorAll('details')) fold.open = true;
         return [...document.querySelectorAll('svg[data-frame]')]
           .filter((svg) => !svg.querySelector('.dot,.disc,.area,.cell,.line:not(.zero)') || svg.getBoundingClientRect().height < 100)
           .map((svg) => svg.querySelector('title').textContent);",
    );
    assert_eq!(empty, json!([]), "{name}: charts without marks");
    // A picture shows what is in the window, and the driver is content with an edge of it.
    browser.run("document.querySelector('svg[data-frame]').scrollIntoView({ block: 'center' });");
    let picture = browser.picture("svg[data-frame]");
    let page = browser.run("return location.href");
    // The page's own policy forbids every picture: it is looked at on an empty page.
    browser.visit("data:text/html,<p>");
    let coloured = browser.run_waiting(
        "const image = new Image(); image.src = `data:image/png;base64,${given}`; await image.decode();
         const canvas = document.createElement('canvas');
         [canvas.width, canvas.height] = [image.width, image.height];
         const context = canvas.getContext('2d'); context.drawImage(image, 0, 0);
         const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
         let coloured = 0;
         for (let k = 0; k < data.length; k += 4) {
           const channels = [data[k], data[k + 1], data[k + 2]];
           if (Math.max(...channels) - Math.min(...channels) > 60) coloured += 1;
         }
         return coloured;",
        &picture,
    );
    assert!(
        coloured.as_f64().is_some_and(|count| count > LEAST_COLOURED),
        "{name}: {coloured} pixels"
    );
    browser.visit(page.as_str().unwrap());
    // What this has asked for is not the next page's.
    browser.console_and_requests();
}

/// Every table that can be saved has as many fields in each line as headings.
pub(super) fn check_saved(browser: &Browser, name: &str) {
    let uneven = browser.run_waiting(
        "for (const fold of document.querySelectorAll('details.values')) fold.open = true;
         await new Promise((done) => setTimeout(done, 200));
         const saved = []; URL.createObjectURL = (blob) => { saved.push(blob); return '#'; };
         HTMLAnchorElement.prototype.click = () => {};
         for (const button of document.querySelectorAll('button.save')) button.click();
         const texts = await Promise.all(saved.map((blob) => blob.text()));
         const counts = (text) => text.trim().split('\\r\\n').map((line) => line.match(/\"([^\"]|\"\")*\"/g).length);
         const charts = document.querySelectorAll('figure svg[data-frame]').length;
         return [saved.length > 0 && saved.length >= charts, texts.filter((text) => new Set(counts(text)).size > 1).map((text) => text.slice(0, 400))];",
        "",
    );
    assert_eq!(uneven, json!([true, []]), "{name}: saved tables");
}

/// On a phone the page is as wide as the screen, unfolded too.
pub(super) fn check_phone(browser: &Browser, name: &str) {
    browser.tool(
        "Emulation.setDeviceMetricsOverride",
        &json!({ "width": PHONE, "height": 844, "deviceScaleFactor": 1, "mobile": true }),
    );
    let wide = browser.run(
        "for (const fold of [...document.querySelectorAll('details')].slice(0, 40)) fold.open = true;
         return [document.documentElement.scrollWidth, innerWidth];",
    );
    assert_eq!(wide, json!([PHONE, PHONE]), "{name} on a phone");
    browser.tool("Emulation.clearDeviceMetricsOverride", &json!({}));
}

/// Every tail is laid out for print, folded or not.
pub(super) fn check_laid_out_for_print(browser: &Browser, name: &str) {
    browser.run("for (const fold of document.querySelectorAll('details')) fold.open = false;");
    browser.tool("Emulation.setEmulatedMedia", &json!({ "media": "print" }));
    let hidden = browser.run(
        "return [...document.querySelectorAll('details.tail')]
           .filter((fold) => (fold.querySelector('svg, table, p')?.getBoundingClientRect().height ?? 0) < 1).length;",
    );
    assert_eq!(hidden, 0, "{name}: tails that are not printed");
    browser.tool("Emulation.setEmulatedMedia", &json!({ "media": "" }));
}

/// Every tail is printed: the pages of the PDF are at least as many as the tails.
pub(super) fn check_print(browser: &Browser, name: &str) {
    check_laid_out_for_print(browser, name);
    let printed = browser.print();
    let tails = browser.run("return document.querySelectorAll('details.tail').length");
    let pages = browser.run_waiting(
        "return (atob(given).match(/\\/Type\\s*\\/Page\\b/g) ?? []).length;",
        &printed,
    );
    assert!(
        pages.as_u64() >= tails.as_u64().map(|tails| tails.max(1)),
        "{name}: {pages} pages, {tails} tails"
    );
}

/// Light or dark, as the reader's system has it.
pub(super) fn color_scheme(browser: &Browser, scheme: &str) {
    let wanted = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
    browser.tool("Emulation.setEmulatedMedia", &wanted);
}

/// The table of tails has every number of the document, to the digits that are shown, and those that it is sorted by exactly.
pub(super) fn check_numbers_of_rows(browser: &Browser, document: &Value) {
    let rows = browser.run(
        "return [...document.querySelectorAll('table.fleet tbody tr')].map((row) => [row.cells[0].innerText,
           [...row.cells].slice(1).map((cell) => cell.dataset.v === undefined ? null : +cell.dataset.v)]);",
    );
    let rows = rows.as_array().unwrap();
    let tails = document["tails"].as_array().unwrap();
    assert_eq!(rows.len(), tails.len());
    for tail in tails {
        let row = rows.iter().find(|row| row[0] == tail["tail"]).unwrap();
        let shown: Vec<f64> = row[1].as_array().unwrap().iter().filter_map(Value::as_f64).collect();
        let errors = &tail["fuel_flow_error_percent"];
        let numbers = ["before", "after"]
            .into_iter()
            .flat_map(|when| ["mean", "std", "max_abs"].map(|name| &errors[when][name]))
            .chain(["flights", "flights_new", "segments", "outside_table"].map(|name| &tail[name]));
        for number in numbers {
            let number = number.as_f64().unwrap();
            assert!(
                shown.iter().any(|one| (one - number).abs() <= 1e-12 * number.abs()),
                "{number} in {shown:?}"
            );
        }
    }
}
