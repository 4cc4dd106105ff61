//! The frame around the body of every page.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::style;

/// A whole page: `body` under a title, without scripts or network. `prints_all` also unfolds the folded parts for
/// printing.
pub(crate) fn framed(title: &str, prints_all: bool, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="generator" content=(concat!("cruisefit ", env!("CARGO_PKG_VERSION")));
                title { (title) }
                style { (PreEscaped(style::STYLE)) }
            }
            body.print-all[prints_all] {
                main {
                    h1 { (title) }
                    (body)
                }
            }
        }
    };
    let mut page = page.into_string();
    page.push('\n');
    page
}
