//! A failure as a person sees it: the message, the line of the file it is about, and what was probably meant.

use std::fmt::{Display, Formatter};
use std::path::Path;

use flight::MAXIMUM_ENGINES;
use flight::effect::EffectId;
use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme};

use super::excerpt::{Excerpt, position_in};
use super::{Colour, Stream, neutral};
use crate::failure::Failure;

/// The text that standard error gets.
pub(crate) fn shown(failure: &Failure, stream: Stream) -> String {
    let message = neutral(&failure.to_string()).into_owned();
    let help = failure.help().map(|help| help.to_string()).or_else(|| meant(&message));
    let error = Shown { message, help };
    let theme = match stream.colour {
        Colour::Ansi => GraphicalTheme::unicode(),
        Colour::Plain => GraphicalTheme::unicode_nocolor(),
    };
    let mut handler = GraphicalReportHandler::new_themed(theme);
    handler = match stream.width {
        // In a pipe lines are not wrapped: a path with a line break in it cannot be copied.
        None => handler.with_wrap_lines(false),
        Some(width) => handler.with_width(width).with_break_words(false),
    };
    let mut text = String::new();
    if handler.render_report(&mut text, &error).is_err() {
        text = format!("{}\n", error.message);
    }
    let excerpt = place_of(failure).and_then(|(path, line, column)| {
        Excerpt::read(Path::new(path), line, column, &error.message)
    });
    match excerpt {
        None => text,
        // Between the message and the help.
        Some(excerpt) => match text.find("  help:") {
            Some(help) => format!("{}{}{}", &text[..help], excerpt.drawn(), &text[help..]),
            None => format!("{}\n{}\n", text.trim_end(), excerpt.drawn()),
        },
    }
}

/// File, line and column that a failure is about.
fn place_of(failure: &Failure) -> Option<(&str, usize, Option<usize>)> {
    let (Failure::BadFile { path, reason, .. } | Failure::Unreadable { path, reason }) = failure
    else {
        return None;
    };
    let (line, column) = position_in(reason)?;
    Some((path, line, column))
}

/// "did you mean": the listed name that is nearest to the one that was found.
///
/// Every message of the program, and those of the parser of RON, has the form `found "x" … one of a, b, c`: read here once
/// instead of at each of the places that refuse a name.
fn meant(message: &str) -> Option<String> {
    if message.contains("did you mean") {
        return None;
    }
    if let Some((_, behind)) = message.split_once("no effect is called ") {
        let wrong = behind.split('"').nth(1)?;
        let outside = behind.split(' ').map(|name| name.trim_matches(','));
        let library = EffectId::library(MAXIMUM_ENGINES).into_iter().map(|id| id.to_string());
        let names: Vec<String> = library.chain(outside.map(str::to_owned)).collect();
        let name = report::nearest(wrong, names.iter().map(String::as_str))?;
        return Some(format!("did you mean {name}?"));
    }
    let (before, list) = ["one of ", "known are ", "presets: ", "it holds "]
        .into_iter()
        .find_map(|mark| message.split_once(mark))?;
    let wrong = wrong_name(before)?;
    let names: Vec<&str> = list
        .split([',', ';'])
        .map(|name| name.trim().trim_start_matches("or "))
        .map(|name| name.split([' ', ')']).next().unwrap_or_default())
        .map(|name| name.trim_matches(['`', '"', '(', ')', '.']))
        .filter(|name| !name.is_empty())
        .collect();
    let name = report::nearest(wrong, names.iter().copied())?;
    (name != wrong).then(|| format!("did you mean {name}?"))
}

/// The last quoted name, else the last one in parentheses, else the one before a colon.
fn wrong_name(before: &str) -> Option<&str> {
    let between = |open: char, close: char| {
        let end = before.rfind(close)?;
        let start = before[..end].rfind(open)? + open.len_utf8();
        Some(&before[start..end]).filter(|name| !name.is_empty())
    };
    let named = before.split("named `").nth(1).and_then(|behind| behind.split('`').next());
    named
        .or_else(|| between('"', '"'))
        .or_else(|| between('(', ')'))
        .or_else(|| before.split(": ").nth(1))
}

/// Message and help, as the printer of errors takes them.
#[derive(Debug)]
struct Shown {
    message: String,
    help: Option<String>,
}

impl Display for Shown {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Shown {}

impl Diagnostic for Shown {
    fn help<'a>(&'a self) -> Option<Box<dyn Display + 'a>> {
        self.help.as_ref().map(|help| Box::new(help) as Box<dyn Display>)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_were_probably_meant() {
        let cases = [
            (
                "--effects: no effect \"tsfc_engine2\"; known are drag_factor, tsfc_engine_2",
                "tsfc_engine_2",
            ),
            (
                "a.ron: line 8, column 14: Unexpected field named `wing_area` in `Aircraft`, expected one of `name`, `wing_area_m2`, or `table` instead",
                "wing_area_m2",
            ),
            (
                "g.csv: line 1, column 4 (fuelflow_lb_h): unknown column, expected one of mass_kg, fuel_flow_lb_h, or a name",
                "fuel_flow_lb_h",
            ),
            (
                "--mapping: traffic-a32: no such file, and no preset (presets: traffic-a320, phlab-c550)",
                "traffic-a320",
            ),
            ("--tail: no tail \"N750C\" in the folder; it holds N750CF", "N750CF"),
        ];
        for (message, name) in cases {
            assert_eq!(
                meant(message).as_deref(),
                Some(&*format!("did you mean {name}?")),
                "{message}"
            );
        }
        assert_eq!(meant("found \"zzzzzzzz\", expected one of ft, m"), None);
        assert_eq!(meant("No such file or directory"), None);
    }

    #[test]
    fn the_offending_line_is_underlined() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ron");
        crate::files::write_atomically(&path, b"(\n  wing_area: 3,\n)\n").unwrap();
        let failure = Failure::bad_file(&path, "line 2, column 12: found `wing_area`");
        let plain = Stream { width: None, colour: Colour::Plain };
        let text = shown(&failure, plain);
        assert!(text.contains("  2 │   wing_area: 3,\n    │   ^^^^^^^^^\n"), "{text}");
        assert!(!text.contains('\u{1b}'), "{text}");
    }
}
