//! What reaches the terminal: plain text as commands make it, made harmless, and on a terminal wrapped between words and
//! coloured. Files and pipes get the text as it is, so that the same input gives the same bytes there.

pub(crate) mod errors;
pub(crate) mod excerpt;
pub(crate) mod kinds;
pub(crate) mod warnings;

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io::{IsTerminal, Write};
use std::sync::OnceLock;

use crate::args::{Common, When};
use crate::failure::RefusedReport;

/// Columns of a terminal that does not say how many it has; tables are made to fit them.
const USUAL_WIDTH: usize = 80;
/// Narrower than this nothing is wrapped: the terminal reports nonsense.
const LEAST_WIDTH: usize = 20;
/// Refusals for one reason that a person still reads one by one.
const REFUSALS_OF_A_KIND: usize = 5;
/// Refusals in one file that are told one by one: of a million points many thousands may lie outside a table.
const REFUSALS_OF_A_FILE: usize = 20;

/// How the two streams are written in this run.
static TERMINAL: OnceLock<Terminal> = OnceLock::new();

/// Standard output and standard error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terminal {
    /// Standard output.
    pub(crate) out: Stream,
    /// Standard error.
    pub(crate) err: Stream,
}

/// How text is dressed for a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stream {
    /// Columns to wrap to; `None` where it is no terminal.
    pub(crate) width: Option<usize>,
    /// Whether it is coloured.
    pub(crate) colour: Colour,
}

/// Whether text is coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Colour {
    /// Escape sequences for colours.
    Ansi,
    /// Plain text.
    Plain,
}

impl Terminal {
    /// Decides once for the run.
    pub(crate) fn start(common: &Common) -> Self {
        let of = |is_terminal: bool| Stream {
            width: is_terminal.then(width),
            colour: match common.color {
                When::Always => Colour::Ansi,
                When::Auto if is_terminal && wants_colour() => Colour::Ansi,
                When::Auto | When::Never => Colour::Plain,
            },
        };
        let terminal = Self {
            out: of(std::io::stdout().is_terminal()),
            err: of(std::io::stderr().is_terminal()),
        };
        *TERMINAL.get_or_init(|| terminal)
    }

    /// That of this run; before it is decided, two plain streams.
    pub(crate) fn of_run() -> Self {
        const PLAIN: Stream = Stream { width: None, colour: Colour::Plain };
        TERMINAL.get().copied().unwrap_or(Self { out: PLAIN, err: PLAIN })
    }
}

/// `NO_COLOR` (<https://no-color.org>) is honoured where it holds anything.
fn wants_colour() -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !is_set("NO_COLOR") && std::env::var_os("TERM").is_none_or(|name| name != "dumb")
}

fn width() -> usize {
    let stated = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let seen = || terminal_size::terminal_size().map(|(columns, _)| usize::from(columns.0));
    stated.or_else(seen).filter(|columns| *columns >= LEAST_WIDTH).unwrap_or(USUAL_WIDTH)
}

/// Text for people, to standard output, and whether it got there; standard error says why not. A reader that closes the pipe early
/// (`| head`) is not an error.
pub(crate) fn print(text: &str) -> bool {
    let dressed = Terminal::of_run().out.dress(text);
    let mut to = std::io::stdout();
    is_delivered(to.write_all(dressed.as_bytes()).and_then(|()| to.flush()))
}

/// The same of a document for programs.
pub(crate) fn print_document(bytes: &[u8]) -> bool {
    is_delivered(print_data(bytes).and_then(|()| std::io::stdout().flush()))
}

fn is_delivered(written: std::io::Result<()>) -> bool {
    match written {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            tell(&format!("standard output cannot be written: {error}\n"));
            false
        }
        _ => true,
    }
}

/// Text that is dressed already, to standard error. Where that is closed or full, nobody can be told.
pub(crate) fn tell_as_it_is(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Text for people, to standard error.
pub(crate) fn tell(text: &str) {
    tell_as_it_is(&Terminal::of_run().err.dress(text));
}

/// Data to standard output: what a program reads stays as it is, what a terminal shows is made harmless.
///
/// # Errors
/// Any error of the operating system.
pub(crate) fn print_data(bytes: &[u8]) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    match std::str::from_utf8(bytes) {
        Ok(text) if Terminal::of_run().out.width.is_some() => {
            out.write_all(neutral(text).as_bytes())
        }
        _ => out.write_all(bytes),
    }
}

/// Refused reports to standard error: one line each; more than five of one tail for one reason that is the tail's ("tail T flight 7
/// is in the model's ledger") in one line with their number. Those beyond the twentieth line of one file are counted, on a terminal
/// those beyond the fifth of one kind.
pub(crate) fn tell_refused(refused: &[RefusedReport]) {
    let terminal = Terminal::of_run();
    let most = if terminal.err.width.is_some() { REFUSALS_OF_A_KIND } else { usize::MAX };
    let mut told = kinds::Told::new(most);
    let mut of_tails: BTreeMap<(&str, String), usize> = BTreeMap::new();
    for reason in refused.iter().filter_map(reason_of_tail) {
        *of_tails.entry(reason).or_default() += 1;
    }
    of_tails.retain(|_, count| *count > REFUSALS_OF_A_KIND);
    let mut folded = BTreeSet::new();
    let mut lines_of_files: BTreeMap<&std::path::Path, usize> = BTreeMap::new();
    // Several flights of a recording may be refused for the same reason.
    for alike in refused.chunk_by(|one, other| one == other) {
        let one = &alike[0];
        if let Some(reason) = reason_of_tail(one)
            && let Some(count) = of_tails.get(&reason)
        {
            let tail = reason.0;
            if folded.insert(reason) {
                tell(&format!(
                    "refused: {one} (and {} more of tail {tail} like this)\n",
                    count - 1
                ));
            }
            continue;
        }
        if told.is_told(&one.reason) {
            let lines = lines_of_files.entry(&one.path).or_default();
            *lines += 1;
            if *lines > REFUSALS_OF_A_FILE {
                continue;
            }
            let is_first = told.count(&one.reason) == 1;
            let times = match alike.len() {
                1 => String::new(),
                flights => format!(" ({flights} flights)"),
            };
            tell(&format!("refused: {one}{times}\n"));
            if let (true, Some(line)) = (is_first, one.line) {
                tell_excerpt(&one.path, line, one.column, &one.reason);
            }
        }
    }
    for (path, lines) in lines_of_files {
        let more = lines.saturating_sub(REFUSALS_OF_A_FILE);
        if more > 0 {
            tell(&format!("refused: {}: {more} more\n", path.display()));
        }
    }
    for (reason, more) in told.untold() {
        tell(&format!("refused: {more} more like this: {reason}\n"));
    }
}

/// What follows a tail's name in a refusal.
const AFTER_A_TAIL: [&str; 4] = [" flight ", " has ", " is ", " was "];

/// The tail that a refusal is a matter of, and its reason without what differs from flight to flight.
fn reason_of_tail(one: &RefusedReport) -> Option<(&str, String)> {
    // A tail's name may have blanks.
    let rest = one.reason.strip_prefix("tail ")?;
    let end = AFTER_A_TAIL.iter().filter_map(|word| rest.find(word)).min()?;
    Some((&rest[..end], kinds::kind_of(&one.reason)))
}

fn tell_excerpt(path: &std::path::Path, line: usize, column: Option<usize>, reason: &str) {
    if let Some(excerpt) = excerpt::Excerpt::read(path, line, column, reason) {
        tell_as_it_is(&excerpt.drawn());
    }
}

impl Stream {
    /// Text as this stream shows it.
    pub(crate) fn dress(self, text: &str) -> String {
        let mut dressed = String::with_capacity(text.len());
        let neutral = neutral(text);
        for line in neutral.split_inclusive('\n') {
            let ended = line.ends_with('\n');
            self.push_line(line.strip_suffix('\n').unwrap_or(line), &mut dressed);
            if ended {
                dressed.push('\n');
            }
        }
        dressed
    }

    fn push_line(self, line: &str, text: &mut String) {
        let wrapped = match self.width {
            Some(width) if line.chars().count() > width => wrap(line, width),
            _ => line.to_owned(),
        };
        match self.colour {
            Colour::Ansi => paint(&wrapped, text),
            Colour::Plain => text.push_str(&wrapped),
        }
    }
}

/// A line in several, broken between words; what follows the first is indented two columns more than it.
fn wrap(line: &str, width: usize) -> String {
    let indent: String = line.chars().take_while(|letter| *letter == ' ').collect();
    // Deeper than half the terminal there is no room for words.
    let indent = if indent.len() > width / 2 { String::new() } else { indent };
    let further = format!("{indent}  ");
    let options = textwrap::Options::new(width)
        .initial_indent(&indent)
        .subsequent_indent(&further)
        .break_words(false)
        .wrap_algorithm(textwrap::WrapAlgorithm::FirstFit);
    textwrap::wrap(line.trim_start(), options).join("\n")
}

/// Beginnings of lines, and the colour of each: what is wrong in red, what to know in yellow, what was found in bold.
const PAINTED: [(&str, &str); 12] = [
    ("refused:", "31"),
    ("Error:", "31"),
    ("serious:", "31"),
    ("Warning:", "33"),
    ("Note:", "33"),
    ("Alert:", "33"),
    ("Cause:", "1"),
    ("Gap ", "1"),
    ("To be sure:", "1"),
    ("$ cruisefit", "1"),
    ("Error of predicted", "1"),
    ("Written to ", "2"),
];

fn paint(line: &str, text: &mut String) {
    let indent = line.len() - line.trim_start().len();
    let (blank, words) = line.split_at(indent);
    text.push_str(blank);
    let found = PAINTED.iter().find(|(beginning, _)| words.starts_with(beginning));
    let whole = is_head_of_table(line).then_some(("", "1"));
    match (found, whole) {
        (Some((beginning, code)), _) => {
            // A label alone is painted, the sentence behind it is to be read.
            let label = if beginning.ends_with(':') { beginning.len() } else { words.len() };
            let _ = write!(text, "\u{1b}[{code}m{}\u{1b}[0m{}", &words[..label], &words[label..]);
        }
        (None, Some((_, code))) => {
            let _ = write!(text, "\u{1b}[{code}m{words}\u{1b}[0m");
        }
        (None, None) => text.push_str(words),
    }
}

/// Names of columns: several words far apart, no digit.
fn is_head_of_table(line: &str) -> bool {
    let gaps = line.trim().split("  ").filter(|part| !part.trim().is_empty()).count();
    gaps >= 3 && !line.chars().any(|letter| letter.is_ascii_digit())
}

/// Text without what a terminal obeys: control characters and those that turn the direction of writing are written as
/// `\u{1b}`. Line ends and tabs stay.
pub(crate) fn neutral(text: &str) -> Cow<'_, str> {
    pipeline::csv_cell::without_controls(text, |letter| matches!(letter, '\n' | '\t'))
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDE: Stream = Stream { width: Some(30), colour: Colour::Plain };

    #[test]
    fn escapes_become_text() {
        let text = "T\u{1b}[2J\u{9b}31m\u{202e}\u{7}é\n\tx\r";
        assert_eq!(neutral(text), "T\\u{1b}[2J\\u{9b}31m\\u{202e}\\u{7}é\n\tx\\u{d}");
        assert_eq!(WIDE.dress("a\u{1b}b"), "a\\u{1b}b");
    }

    #[test]
    fn lines_are_broken_between_words_and_indented() {
        let text = "  Cause: the fuel-flow meter of engine 2 reads high.\n";
        let dressed = WIDE.dress(text);
        assert_eq!(dressed, "  Cause: the fuel-flow meter\n    of engine 2 reads high.\n");
        // In a pipe nothing changes.
        assert_eq!(Stream { width: None, ..WIDE }.dress(text), text);
        // A word that is too long stays whole: a path has to be copied.
        let path = format!("{}\n", "x".repeat(50));
        assert_eq!(WIDE.dress(&path), path);
    }

    #[test]
    fn labels_and_heads_are_painted() {
        let colours = Stream { width: None, colour: Colour::Ansi };
        assert_eq!(colours.dress("  Note: a.\n"), "  \u{1b}[33mNote:\u{1b}[0m a.\n");
        assert_eq!(
            colours.dress("tail  flights  mean\nT-1   3        0.1\n"),
            "\u{1b}[1mtail  flights  mean\u{1b}[0m\nT-1   3        0.1\n"
        );
        assert_eq!(colours.dress("plain words\n"), "plain words\n");
    }
}
