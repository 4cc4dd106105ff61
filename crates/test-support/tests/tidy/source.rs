//! Rust source without what is no code.

/// The text with comments, strings and characters blanked; line breaks and all byte offsets stay.
pub(crate) fn code_only(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut code = bytes.to_vec();
    let mut at = 0;
    while at < bytes.len() {
        let end = end_of_no_code(bytes, at);
        if end == at {
            at += 1;
            // An identifier or a number as a whole: `for_r"…"` is no raw string, and a suffix is no prefix.
            if is_word(bytes[at - 1]) {
                while at < bytes.len() && is_word(bytes[at]) {
                    at += 1;
                }
            }
            continue;
        }
        for byte in &mut code[at..end] {
            if *byte != b'\n' {
                *byte = b' ';
            }
        }
        at = end;
    }
    String::from_utf8(code).unwrap()
}

/// End of the comment, string or character that begins here; `at` where none does.
fn end_of_no_code(bytes: &[u8], at: usize) -> usize {
    let rest = &bytes[at..];
    if rest.starts_with(b"//") {
        return at + rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
    }
    if rest.starts_with(b"/*") {
        return end_of_block_comment(bytes, at);
    }
    let prefix = [&b"br"[..], b"cr", b"r", b"b", b"c", b""]
        .into_iter()
        .find(|prefix| {
            rest.starts_with(prefix) && matches!(rest.get(prefix.len()), Some(b'"' | b'#' | b'\''))
        })
        .map_or(0, <[u8]>::len);
    let raw = prefix > 0 && rest[prefix - 1] == b'r';
    let start = at + prefix;
    match bytes.get(start) {
        Some(b'"' | b'#') if raw => end_of_raw_string(bytes, start).unwrap_or(at),
        Some(b'"') => end_of_quoted(bytes, start),
        Some(b'\'') if !raw && is_character(&bytes[start..]) => end_of_quoted(bytes, start),
        _ => at,
    }
}

fn end_of_block_comment(bytes: &[u8], start: usize) -> usize {
    let mut depth = 0;
    let mut at = start;
    while at < bytes.len() {
        if bytes[at..].starts_with(b"/*") {
            depth += 1;
            at += 2;
        } else if bytes[at..].starts_with(b"*/") {
            depth -= 1;
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    at
}

/// Of `##"…"##`; `None` for a raw identifier.
fn end_of_raw_string(bytes: &[u8], start: usize) -> Option<usize> {
    let hashes = bytes[start..].iter().take_while(|&&byte| byte == b'#').count();
    let open = start + hashes;
    if bytes.get(open) != Some(&b'"') {
        return None;
    }
    let close: Vec<u8> = [b'"'].into_iter().chain(vec![b'#'; hashes]).collect();
    let length = bytes[open + 1..].windows(close.len()).position(|window| window == close)?;
    Some(open + 1 + length + close.len())
}

/// Of a string or character with escapes; `start` is its opening quote.
fn end_of_quoted(bytes: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while at < bytes.len() && bytes[at] != bytes[start] {
        at += if bytes[at] == b'\\' { 2 } else { 1 };
    }
    (at + 1).min(bytes.len())
}

/// Whether a quote begins a character and no lifetime.
fn is_character(rest: &[u8]) -> bool {
    match rest.get(1) {
        Some(b'\\') => true,
        Some(&byte) if byte.is_ascii() => rest.get(2) == Some(&b'\''),
        Some(_) => true,
        None => false,
    }
}

fn is_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

#[test]
fn strings_comments_and_characters_are_blanked() {
    for (text, expected) in [
        (r#"a("b\"{", 'c', '\'')"#, "a(      ,    ,     )"),
        ("a // b { \"\nc", "a         \nc"),
        ("a /* b /* c */ d */ e", "a                   e"),
        ("r#\"a\"b\"# + b\"x\" + br\"\\\" + r#fn", "         +      +       + r#fn"),
        ("f::<'a>(&'a x, b'(', 'é')", "f::<'a>(&'a x,     ,     )"),
        ("for_r\"x\"", "for_r   "),
    ] {
        assert_eq!(code_only(text), expected, "{text}");
    }
}
