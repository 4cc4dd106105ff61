//! The frame around the body of every page.

use std::sync::LazyLock;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::style;

/// What a page does beyond being read: values, tables and links; zoom; the numbers behind charts; surfaces that turn. What
/// they share comes first.
const SCRIPTS: [&str; 5] = [
    include_str!("script/shared.js"),
    include_str!("script/page.js"),
    include_str!("script/zoom.js"),
    include_str!("script/values.js"),
    include_str!("script/turn.js"),
];
/// All of them in one, made once: a fleet has a page for each tail.
static SCRIPT: LazyLock<String> = LazyLock::new(scripts);
/// The page may run what it holds and load nothing, whatever a name in it says.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

/// A whole page: `body` under a title, without network.
pub(crate) fn framed(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content=(concat!("cruisefit ", env!("CARGO_PKG_VERSION")));
                title { (title) }
                style { (PreEscaped(style::STYLE)) }
            }
            body {
                main {
                    h1 { (title) }
                    (body)
                }
                script { (PreEscaped(SCRIPT.as_str())) }
            }
        }
    };
    let mut page = page.into_string();
    page.push('\n');
    page
}

/// The scripts without comments and indentation: every page holds them.
fn scripts() -> String {
    let mut text = String::new();
    for line in SCRIPTS.iter().flat_map(|script| script.lines()).map(str::trim_start) {
        if !line.is_empty() && !line.starts_with("//") {
            text.push_str(line);
            text.push('\n');
        }
    }
    text
}
