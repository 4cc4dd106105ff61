//! The functions of a source without comments and strings.

use std::ops::Range;

/// One `fn` item.
pub(crate) struct Function {
    pub(crate) name: String,
    /// Without `self`.
    pub(crate) parameters: usize,
    /// From `fn` to the closing brace, or the semicolon of a declaration.
    pub(crate) span: Range<usize>,
}

/// Every function, those inside others too. The text is that of [`code_only`](crate::source::code_only).
pub(crate) fn functions(code: &str) -> Vec<Function> {
    code.match_indices("fn ").filter_map(|(at, _)| function(code, at)).collect()
}

fn function(code: &str, start: usize) -> Option<Function> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    if code[..start].ends_with(is_word) {
        return None;
    }
    let after = code[start + 3..].trim_start();
    let name: String = after.chars().take_while(|&c| is_word(c)).collect();
    let mut at = code.len() - after.len() + name.len();
    if name.is_empty() {
        return None;
    }
    if code[at..].starts_with('<') {
        at = closing(code, at)?;
    }
    at += code[at..].find('(')?;
    let end = closing(code, at)?;
    let parameters = parameters(&code[at + 1..end - 1]);
    let stop = end_of_signature(code, end)?;
    let stop = if code[stop..].starts_with('{') { closing(code, stop)? } else { stop + 1 };
    Some(Function { name, parameters, span: start..stop })
}

/// Where the body or the semicolon is; a semicolon may be inside the type of an array.
fn end_of_signature(code: &str, from: usize) -> Option<usize> {
    let mut depth = 0;
    for (at, c) in code[from..].char_indices() {
        match c {
            '{' | ';' if depth == 0 => return Some(from + at),
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ => {}
        }
    }
    None
}

fn parameters(list: &str) -> usize {
    let mut depth = 0_i32;
    let mut pieces = vec![String::new()];
    let mut before = ' ';
    for c in list.chars() {
        depth += step(c, before, true);
        if c == ',' && depth == 0 {
            pieces.push(String::new());
        } else {
            pieces.last_mut().unwrap().push(c);
        }
        before = c;
    }
    let is_self = |piece: &str| {
        let name = piece.split(':').next().unwrap_or_default();
        name.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == "self")
    };
    pieces.iter().map(|piece| piece.trim()).filter(|p| !p.is_empty() && !is_self(p)).count()
}

/// Just after the bracket that closes the one at `open`.
fn closing(code: &str, open: usize) -> Option<usize> {
    let angles = code[open..].starts_with('<');
    let mut depth = 0;
    let mut before = ' ';
    for (at, c) in code[open..].char_indices() {
        depth += step(c, before, angles);
        if depth == 0 {
            return Some(open + at + c.len_utf8());
        }
        before = c;
    }
    None
}

/// How a character changes the depth of brackets. `>` of an arrow closes nothing.
fn step(c: char, before: char, angles: bool) -> i32 {
    match c {
        '(' | '[' | '{' => 1,
        ')' | ']' | '}' => -1,
        '<' if angles => 1,
        '>' if angles && before != '-' => -1,
        _ => 0,
    }
}

#[test]
fn functions_are_found_with_their_parameters() {
    let code = "
impl A {
    fn one<'a, F: Fn(u8, u8) -> u8>(&'a mut self, f: F, (x, y): (u8, u8), m: Map<u8, u8>,) -> [u8; 2]
    where
        F: Copy,
    {
        if x < y { let g: fn (u8) -> u8 = h; }
        fn inner(self_: u8) { }
    }
    fn two(self: Box<Self>);
}
fn three() -> impl Fn(u8) -> u8 { |x| x }
";
    let found: Vec<_> = functions(code)
        .into_iter()
        .map(|f| (f.name, f.parameters, code[f.span].lines().count()))
        .collect();
    let expected = [("one", 3, 7), ("inner", 1, 1), ("two", 0, 1), ("three", 0, 1)];
    assert_eq!(found, expected.map(|(name, count, lines)| (name.to_owned(), count, lines)));
}
