//! Texts as cells of CSV: a table that somebody opens in a spreadsheet or prints on a terminal must not act there.
//!
//! A cell that a spreadsheet takes for a formula (`=`, `+`, `-`, `@` in front, or a tabulator or carriage return, behind
//! which some look for one) gets an apostrophe in front; numbers are none. A control character, or one that turns the
//! direction of writing, is written as `\u{1b}`. [`read`] gives back what [`written`] was given.
//!
//! # Source
//! OWASP, CSV injection; Boucher and Anderson, Trojan Source, 2021 (arXiv:2111.00169).

use std::borrow::Cow;

/// What a formula begins with.
const FORMULA: [char; 6] = ['=', '+', '-', '@', '\t', '\r'];
/// In front of a formula that is text.
const TEXT_MARK: char = '\'';

/// A text as a cell, before it is quoted.
pub fn written(text: &str) -> Cow<'_, str> {
    if is_harmless(text) {
        return Cow::Borrowed(text);
    }
    let escaped = if text.contains("\\u{") {
        Cow::Owned(without_controls(&text.replace("\\u{", "\\u{5c}u{"), stays_in_cell).into_owned())
    } else {
        without_controls(text, stays_in_cell)
    };
    if is_formula(&escaped) { Cow::Owned(format!("{TEXT_MARK}{escaped}")) } else { escaped }
}

/// The text of a cell that [`written`] made.
pub fn read(cell: &str) -> Cow<'_, str> {
    let text = match cell.strip_prefix(TEXT_MARK) {
        Some(rest) if is_formula(rest) => rest,
        _ => cell,
    };
    if !text.contains("\\u{") {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len());
    let mut parts = text.split("\\u{");
    plain.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let decoded = part.split_once('}').and_then(|(digits, rest)| {
            let letter = char::from_u32(u32::from_str_radix(digits, 16).ok()?)?;
            Some((letter, rest))
        });
        if let Some((letter, rest)) = decoded {
            plain.push(letter);
            plain.push_str(rest);
        } else {
            // Nothing that was written here: it stays as it is.
            plain.push_str("\\u{");
            plain.push_str(part);
        }
    }
    Cow::Owned(plain)
}

/// Nearly every text: nothing in it needs a second look, and it begins as no formula does.
fn is_harmless(text: &str) -> bool {
    text.bytes().all(|byte| matches!(byte, b' '..=b'~') && byte != b'\\')
        && text.bytes().next().is_none_or(|byte| byte.is_ascii_alphanumeric())
}

/// Marks in front count as nothing, so that a text that begins with one reads back as it was. A dash alone is what tables have for
/// "not available".
fn is_formula(text: &str) -> bool {
    let bare = text.trim_start_matches(TEXT_MARK);
    bare.starts_with(FORMULA) && bare != "-" && text.parse::<f64>().is_err()
}

/// Tabulators and line ends are quoted, as in any table.
const fn stays_in_cell(letter: char) -> bool {
    matches!(letter, '\n' | '\r' | '\t')
}

/// A text in which control characters, and those that turn the direction of writing, are written as `\u{1b}`, except those
/// that stay.
pub fn without_controls(text: &str, stays: impl Fn(char) -> bool) -> Cow<'_, str> {
    without_controls_as(text, stays, |code| format!("\\u{{{code:x}}}"))
}

/// The same with another way to write the number of a character.
pub fn without_controls_as(
    text: &str,
    stays: impl Fn(char) -> bool,
    write: impl Fn(u32) -> String,
) -> Cow<'_, str> {
    let acts = |letter: char| is_obeyed(letter) && !stays(letter);
    let mut plain = String::new();
    let mut rest = text;
    while let Some((at, letter)) = first(rest, acts) {
        plain.push_str(&rest[..at]);
        plain.push_str(&write(u32::from(letter)));
        rest = &rest[at + letter.len_utf8()..];
    }
    if plain.is_empty() {
        return Cow::Borrowed(text);
    }
    plain.push_str(rest);
    Cow::Owned(plain)
}

/// Control characters and those that turn the direction of writing.
fn is_obeyed(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The first byte of such a character in UTF-8; others begin with it too. Without branches: of many bytes at once.
#[expect(clippy::needless_bitwise_bool, reason = "branches would take the bytes one by one")]
const fn may_begin_obeyed(byte: u8) -> bool {
    (byte < b' ') | (byte == 0x7f) | (byte == 0xc2) | (byte == 0xe2)
}

/// The first letter that acts, and where it is.
fn first(text: &str, acts: impl Fn(char) -> bool) -> Option<(usize, char)> {
    let mut from = 0;
    while let Some(at) = first_to_look_at(text.as_bytes(), from) {
        if let Some(letter) = text[at..].chars().next().filter(|letter| acts(*letter)) {
            return Some((at, letter));
        }
        from = at + 1;
    }
    None
}

/// The first byte from one on with which such a character may begin. Pages of megabytes hold none: bytes are looked at some at
/// a time, in which several fit into one instruction.
///
/// Not generic, so that it is compiled in this crate, for speed, and not in one that is compiled for size.
#[inline(never)]
fn first_to_look_at(bytes: &[u8], from: usize) -> Option<usize> {
    const BYTES_AT_ONCE: usize = 64;
    let one_by_one = |bytes: &[u8]| bytes.iter().position(|byte| may_begin_obeyed(*byte));
    let rest = &bytes[from..];
    let (chunks, _) = rest.as_chunks::<BYTES_AT_ONCE>();
    let without = chunks
        .iter()
        .take_while(|chunk| !chunk.iter().fold(false, |any, byte| any | may_begin_obeyed(*byte)))
        .count();
    let looked_at = without * BYTES_AT_ONCE;
    one_by_one(&rest[looked_at..]).map(|at| from + looked_at + at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_become_text_and_numbers_stay() {
        for (text, cell) in [
            ("=HYPERLINK(\"x\")", "'=HYPERLINK(\"x\")"),
            ("+1+1", "'+1+1"),
            ("-A1", "'-A1"),
            ("@SUM(A1)", "'@SUM(A1)"),
            ("\t=1", "'\t=1"),
            ("'=1", "''=1"),
            ("-5.25", "-5.25"),
            ("+3", "+3"),
            ("D-ABCD", "D-ABCD"),
            ("", ""),
            ("T\u{1b}[2J", "T\\u{1b}[2J"),
            ("a\\u{1b}", "a\\u{5c}u{1b}"),
        ] {
            assert_eq!(written(text), cell);
            assert_eq!(read(cell), text);
        }
        assert_eq!(read("'quoted'"), "'quoted'");
        assert_eq!(read("a\\u{zz}b"), "a\\u{zz}b");
    }

    proptest::proptest! {
        // The oracle is the definition, letter by letter.
        #[test]
        fn only_what_acts_is_written_otherwise(
            letters in "([a-zé°–\u{202e}\u{2066}\u{85}\u{a0}\u{7f}\u{1b}\n\t]|[ -~]{30}|\\PC|\\p{Cc}|\\p{Cf}){0,12}",
        ) {
            let by_letters: String = letters
                .chars()
                .map(|letter| match letter {
                    '\n' => letter.to_string(),
                    _ if is_obeyed(letter) => format!("\\u{{{:x}}}", u32::from(letter)),
                    _ => letter.to_string(),
                })
                .collect();
            let plain = without_controls(&letters, |letter| letter == '\n');
            proptest::prop_assert_eq!(&*plain, by_letters.as_str());
        }

        #[test]
        fn every_text_reads_back(text in "['=+@0-9\\\\u{}\t\r\u{1b}\u{202e}a-]{0,8}") {
            let cell = written(&text);
            proptest::prop_assert_eq!(read(&cell), text.as_str());
        }
    }
}
