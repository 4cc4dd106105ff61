//! Tails as names of files.

use std::fmt::Write as _;

use crate::checksum::sha256;

/// Longest stem of a file: file systems allow 255 bytes with ending and, for temporary files, beginning.
const LONGEST: usize = 160;

/// A tail as a file name: letters, digits, `-` and `_` stay, any other character becomes `%` and its hexadecimal
/// bytes, so that two tails never share a file. A name that is too long for a file ends in its SHA-256 instead.
pub fn file_stem_of_tail(tail: &str) -> String {
    let mut stem = String::new();
    for byte in tail.bytes() {
        if byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_' {
            stem.push(char::from(byte));
        } else {
            let _ = write!(stem, "%{byte:02X}");
        }
    }
    if stem.len() > LONGEST {
        let digest = sha256(tail.as_bytes());
        stem.truncate(LONGEST - digest.len() - 1);
        stem.push('%');
        stem.push_str(&digest);
    }
    stem
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_as_file_names() {
        assert_eq!(file_stem_of_tail("D-ABCD"), "D-ABCD");
        assert_eq!(file_stem_of_tail("../x y"), "%2E%2E%2Fx%20y");
        let long = |last: &str| file_stem_of_tail(&format!("{}{last}", "x".repeat(300)));
        assert_eq!(long("a").len(), LONGEST);
        assert_ne!(long("a"), long("b"));
    }
}
