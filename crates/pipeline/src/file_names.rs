//! Tails as names of files.

use std::fmt::Write as _;

use crate::checksum::sha256;

/// Longest stem of a file: file systems allow 255 bytes with ending and, for temporary files, beginning.
const LONGEST: usize = 160;

/// A tail as a file name: letters, digits, `-` and `_` stay, any other character becomes `%` and its hexadecimal
/// bytes, so that two tails never share a file; so does the first letter of a name that Windows keeps for a device. A name that
/// is too long for a file ends in its SHA-256 instead. Where the file system takes names that differ only in case for one, who
/// writes the files refuses such tails.
pub fn file_stem_of_tail(tail: &str) -> String {
    let mut stem = String::new();
    let reserved = is_reserved(tail);
    for (place, byte) in tail.bytes().enumerate() {
        let stays = byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_';
        if stays && !(reserved && place == 0) {
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

/// Path of a tail's own page below a folder.
pub fn page_file_of_tail(tail: &str) -> String {
    format!("pages/{}.html", file_stem_of_tail(tail))
}

/// The link to a file: `%` is a character of its name, not of the link.
pub fn link_to(file: &str) -> String {
    file.replace('%', "%25")
}

/// Whether Windows takes a name for a device, whatever its ending.
///
/// # Source
/// Microsoft, Naming Files, Paths, and Namespaces: CON, PRN, AUX, NUL, COM0 to COM9, LPT0 to LPT9.
fn is_reserved(name: &str) -> bool {
    let name = name.to_ascii_uppercase();
    let port = name.strip_prefix("COM").or_else(|| name.strip_prefix("LPT"));
    let is_port =
        port.is_some_and(|digit| digit.len() == 1 && digit.bytes().all(|b| b.is_ascii_digit()));
    is_port || ["CON", "PRN", "AUX", "NUL"].contains(&name.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_as_file_names() {
        assert_eq!(file_stem_of_tail("D-ABCD"), "D-ABCD");
        assert_eq!(file_stem_of_tail("../x y"), "%2E%2E%2Fx%20y");
        for (name, stem) in
            [("CON", "%43ON"), ("nul", "%6Eul"), ("Com1", "%43om1"), ("LPT9", "%4CPT9")]
        {
            assert_eq!(file_stem_of_tail(name), stem);
        }
        for name in ["CON1", "COM", "COM10", "NULL", "D-CON"] {
            assert_eq!(file_stem_of_tail(name), name);
        }
        let long = |last: &str| file_stem_of_tail(&format!("{}{last}", "x".repeat(300)));
        assert_eq!(long("a").len(), LONGEST);
        assert_ne!(long("a"), long("b"));
    }
}
