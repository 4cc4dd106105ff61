//! Physical lines, their content without comments, their words, and positions in them.

use crate::refusal::{Found, Refusal, RefusalKind};

/// Only blanks and tabs separate words.
#[inline]
pub(crate) const fn is_blank(byte: u8) -> bool {
    byte == b' ' || byte == b'\t'
}

/// A physical line without its line end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line<'a> {
    /// From 1.
    pub(crate) number: usize,
    /// Comment included, line end not.
    pub(crate) text: &'a str,
    /// From the start of this line to the end of the whole text: several bytes at a time can be read there.
    pub(crate) onward: &'a str,
    /// Whether a line feed ends it.
    pub(crate) is_ended: bool,
}

/// A word of a line: the text between blanks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word<'a> {
    /// First byte in the line.
    pub(crate) offset: usize,
    pub(crate) text: &'a str,
}

impl<'a> Line<'a> {
    /// The text before a comment, without blanks at either end.
    pub(crate) fn meaning(self) -> Word<'a> {
        let bytes = self.text.as_bytes();
        let comment = memchr::memchr_iter(b'#', bytes)
            .find(|&at| at == 0 || is_blank(bytes[at - 1]))
            .unwrap_or(bytes.len());
        trim(Word { offset: 0, text: &self.text[..comment] })
    }

    /// Refuses at a byte of this line.
    pub(crate) fn refuse(self, offset: usize, found: Found, kind: RefusalKind) -> Refusal {
        let column = self.text[..offset.min(self.text.len())].chars().count() + 1;
        Refusal { line: self.number, column, found, kind }
    }

    /// Refuses a word of this line.
    pub(crate) fn refuse_word(self, word: Word<'_>, kind: RefusalKind) -> Refusal {
        self.refuse(word.offset, Found::text(word.text), kind)
    }

    /// Refuses one character past the end of this line's content.
    pub(crate) fn refuse_end(self, found: Found, kind: RefusalKind) -> Refusal {
        let meaning = self.meaning();
        self.refuse(meaning.offset + meaning.text.len(), found, kind)
    }
}

impl<'a> Word<'a> {
    /// The words in this stretch of text.
    pub(crate) fn words(self) -> impl Iterator<Item = Word<'a>> {
        let mut rest = self;
        core::iter::from_fn(move || {
            rest = trim(rest);
            if rest.text.is_empty() {
                return None;
            }
            let (word, remainder) = rest.split_word();
            rest = remainder;
            Some(word)
        })
    }

    /// The first word, and the rest without blanks at either end.
    pub(crate) fn split_first(self) -> (Self, Self) {
        let (word, rest) = self.split_word();
        (word, trim(rest))
    }

    fn split_word(self) -> (Self, Self) {
        let length = self.text.bytes().position(is_blank).unwrap_or(self.text.len());
        let (word, rest) = self.text.split_at(length);
        (
            Self { offset: self.offset, text: word },
            Self { offset: self.offset + length, text: rest },
        )
    }
}

fn trim(word: Word<'_>) -> Word<'_> {
    let blank = |character: char| character == ' ' || character == '\t';
    let text = word.text.trim_start_matches(blank);
    Word { offset: word.offset + word.text.len() - text.len(), text: text.trim_end_matches(blank) }
}

/// The physical lines of a text, in order.
#[derive(Clone, Debug)]
pub(crate) struct Lines<'a> {
    rest: &'a str,
    number: usize,
    last: Line<'a>,
}

impl<'a> Lines<'a> {
    pub(crate) const fn new(text: &'a str) -> Self {
        Self {
            rest: text,
            number: 0,
            last: Line { number: 1, text: "", onward: "", is_ended: false },
        }
    }

    /// The next line with content: neither blank nor only a comment.
    pub(crate) fn next_of_meaning(&mut self) -> Option<Line<'a>> {
        self.find(|line| !line.meaning().text.is_empty())
    }

    /// Refuses one character past the end of the last line handed out.
    pub(crate) fn refuse_end(&self, found: Found, kind: RefusalKind) -> Refusal {
        self.last.refuse(self.last.text.len(), found, kind)
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    #[inline]
    fn next(&mut self) -> Option<Line<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let onward = self.rest;
        let (text, is_ended) = match memchr::memchr(b'\n', self.rest.as_bytes()) {
            Some(end) => {
                let text = &self.rest[..end];
                self.rest = &self.rest[end + 1..];
                (text, true)
            }
            None => (core::mem::take(&mut self.rest), false),
        };
        // Half of a line end at the end of a truncated file is not part of the line either.
        let text = text.strip_suffix('\r').unwrap_or(text);
        self.last = Line { number: self.number, text, onward, is_ended };
        Some(self.last)
    }
}
