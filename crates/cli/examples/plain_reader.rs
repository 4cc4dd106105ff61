//! Opens and reads every file below a folder and adds up its bytes, and nothing more: the limit that the speed of the
//! chain is compared with (benches/chain.py).

#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a program that reads files, for measurements"
)]

use std::fs::File;
use std::io::Read;
use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    let mut open: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let mut files = Vec::new();
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(folder)? {
            let entry = entry?;
            if entry.file_type()?.is_dir() {
                open.push(entry.path());
            } else {
                files.push(entry.path());
            }
        }
    }
    files.sort();
    let mut bytes = Vec::new();
    let mut sum = 0_u64;
    let (mut read, mut on_disk) = (0_u64, 0_u64);
    for path in &files {
        bytes.clear();
        File::open(path)?.read_to_end(&mut bytes)?;
        read += bytes.len() as u64;
        on_disk += path.metadata()?.len();
        sum += bytes.iter().map(|byte| u64::from(*byte)).sum::<u64>();
    }
    println!("{} files, sum of bytes {sum}", files.len());
    assert_eq!(read, on_disk, "every byte is read");
    Ok(())
}
