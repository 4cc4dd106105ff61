//! Input that asks for endless time or memory: the program runs with a limit on its address space and a limit of time, far above
//! what it needs, and ends by itself with a status of its own.
#![cfg(unix)]

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Address space, KiB: four times the 512 MiB that a text may have at most. An allocation beyond it aborts the program.
const MOST_KIB: u64 = 4 * 512 * 1024;
/// No measurement: whatever is meant to be linear needs seconds here, what is not needs hours.
const LONGEST: Duration = Duration::from_mins(2);

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/global5000").join(name)
}

/// Runs the program within the limits: its status, and what it printed.
fn run<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> (i32, String) {
    let mut child = Command::new("sh")
        .args([
            "-c",
            &format!("ulimit -v {MOST_KIB} && exec \"$@\""),
            "sh",
            env!("CARGO_BIN_EXE_cruisefit"),
        ])
        .args(arguments)
        .args(["--threads", "2", "--no-progress"])
        .env("NO_COLOR", "1")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    let mut stderr = child.stderr.take().unwrap();
    let reader = std::thread::spawn(move || {
        let mut text = Vec::new();
        std::io::Read::read_to_end(&mut stderr, &mut text).map(|_| text)
    });
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if begun.elapsed() > LONGEST {
            child.kill().unwrap();
            panic!("still running after {LONGEST:?}");
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let text = String::from_utf8_lossy(&reader.join().unwrap().unwrap()).into_owned();
    (status.code().unwrap_or(-1), text)
}

/// Runs and expects a refusal: not success, no panic (101), no signal (-1).
fn refused<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> String {
    let (status, text) = run(arguments);
    assert!(status == 1 || status == 2, "status {status}: {text}");
    text
}

fn segment(input: &Path, scratch: &Path) -> String {
    let output = scratch.join("segments.csv");
    refused(&["segment".as_ref(), input.as_os_str(), "-o".as_ref(), output.as_os_str()])
}

#[test]
fn an_endless_line() {
    let scratch = tempfile::tempdir().unwrap();
    // A sparse file: three gigabytes without a line end, on a disk of any size.
    let path = scratch.path().join("long.txt");
    std::fs::File::create(&path).unwrap().set_len(3 << 30).unwrap();
    segment(&path, scratch.path());
    segment(Path::new("/dev/zero"), scratch.path());
}

#[test]
fn a_gzip_bomb() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("bomb.txt.gz");
    let mut packed = flate2::write::GzEncoder::new(
        std::io::BufWriter::new(std::fs::File::create(&path).unwrap()),
        flate2::Compression::fast(),
    );
    let million = vec![b' '; 1 << 20];
    for _ in 0..600 {
        packed.write_all(&million).unwrap();
    }
    packed.finish().unwrap().flush().unwrap();
    let text = segment(&path, scratch.path());
    assert!(text.contains("at most 536870912 bytes"), "{text}");
}

#[test]
fn deep_nesting() {
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("deep.ron");
    for (opening, closing) in [("(", ")"), ("[", "]"), ("Some(", ")"), ("{0:", "}"), ("/*", "*/")] {
        let deep = format!("(seed: {}{})", opening.repeat(200_000), closing.repeat(200_000));
        std::fs::write(&path, &deep).unwrap();
        let output = scratch.path().join("out");
        let guide = fixture("guide.csv");
        refused(&["show".as_ref(), path.as_os_str()]);
        refused(&["simulate".as_ref(), path.as_os_str(), "-o".as_ref(), output.as_os_str()]);
        refused(&["trial".as_ref(), path.as_os_str(), "-o".as_ref(), output.as_os_str()]);
        let aircraft = ["init".as_ref(), "--aircraft".as_ref(), path.as_os_str()];
        let rest = ["--guide".as_ref(), guide.as_os_str(), "-o".as_ref(), output.as_os_str()];
        refused(&[&aircraft[..], &rest[..]].concat());
        let csv = fixture("static.csv");
        let mapping = ["segment".as_ref(), csv.as_os_str(), "--mapping".as_ref(), path.as_os_str()];
        refused(&[&mapping[..], &["-o".as_ref(), output.as_os_str()]].concat());
    }
}

#[test]
fn absurd_counts() {
    let scratch = tempfile::tempdir().unwrap();
    let (path, output) = (scratch.path().join("plan.ron"), scratch.path().join("out"));
    for count in ["4000000000", "18446744073709551615"] {
        let plan =
            format!("(seed: 7, tails: [(tail: \"P-1\", flights: Designed((flights: {count})))])");
        std::fs::write(&path, plan).unwrap();
        refused(&["simulate".as_ref(), path.as_os_str(), "-o".as_ref(), output.as_os_str()]);
        let trial = format!(
            "(seed: 1, flights: 6, clean_flights: 5, duration_h: 0.5, effects: [\"wave_drag\"], parts: [(denied: exact, \
             background: clean, kind: single, times: 0.5, repeats: {count})])"
        );
        std::fs::write(&path, trial).unwrap();
        refused(&["trial".as_ref(), path.as_os_str(), "-o".as_ref(), output.as_os_str()]);
    }
}

#[test]
fn a_time_at_which_the_clock_stands_still() {
    // From 1e18 s on a minute more is the same number.
    let scratch = tempfile::tempdir().unwrap();
    let good = std::fs::read_to_string(fixture("reports/0001.txt")).unwrap();
    let last = good.lines().last().unwrap();
    let time = last.split_whitespace().next().unwrap();
    let path = scratch.path().join("time.txt");
    std::fs::write(&path, good.replacen(last, &last.replacen(time, "1e19", 1), 1)).unwrap();
    segment(&path, scratch.path());
}

#[test]
fn a_hundred_thousand_columns() {
    let scratch = tempfile::tempdir().unwrap();
    let names: String = (0..100_000).fold(String::new(), |mut names, k| {
        let _ = write!(names, " X-{k}");
        names
    });
    let good = std::fs::read_to_string(fixture("reports/0001.txt")).unwrap();
    let path = scratch.path().join("wide.txt");
    let wide: String = good
        .lines()
        .map(|line| {
            if line.starts_with("TIME") { format!("{line}{names}\n") } else { format!("{line}\n") }
        })
        .collect();
    std::fs::write(&path, wide).unwrap();
    segment(&path, scratch.path());
    let (guide, aircraft) = (scratch.path().join("guide.csv"), fixture("AIRCRAFT.ron"));
    std::fs::write(&guide, format!("{}\n1\n", names.trim().replace(' ', ","))).unwrap();
    let init = ["init".as_ref(), "--aircraft".as_ref(), aircraft.as_os_str(), "--guide".as_ref()];
    let output = scratch.path().join("MODEL.ron");
    refused(&[&init[..], &[guide.as_os_str(), "-o".as_ref(), output.as_os_str()]].concat());
}

/// The largest table that an aircraft file may ask for is made, or refused; a large one learns.
#[test]
fn large_tables() {
    let scratch = tempfile::tempdir().unwrap();
    let good = std::fs::read_to_string(fixture("AIRCRAFT.ron")).unwrap();
    let (aircraft, guide) = (scratch.path().join("AIRCRAFT.ron"), fixture("guide.csv"));
    let model = scratch.path().join("MODEL.ron");
    let init = |steps: &str| {
        let table = good.lines().find(|line| line.trim_start().starts_with("table:")).unwrap();
        std::fs::write(&aircraft, good.replace(table, steps)).unwrap();
        let init =
            ["init".as_ref(), "--force".as_ref(), "--aircraft".as_ref(), aircraft.as_os_str()];
        run(&[
            &init[..],
            &["--guide".as_ref(), guide.as_os_str(), "-o".as_ref(), model.as_os_str()],
        ]
        .concat())
    };
    for steps in ["(0.10, 0.80, 1e-9)", "(0.10, 0.80, 1e-300)"] {
        let table = format!("table: (lift_coefficient: {steps}, mach: (0.50, 0.95, 0.05)),");
        assert_eq!(init(&table).0, 2);
    }
    let (status, text) =
        init("table: (lift_coefficient: (0.10, 0.80, 0.0035), mach: (0.50, 0.95, 0.00225)),");
    assert_eq!(status, 0, "{text}");
    let (report, output) = (fixture("reports/0001.txt"), scratch.path().join("out"));
    let adapt = ["adapt".as_ref(), report.as_os_str(), "--model".as_ref(), model.as_os_str()];
    let (status, text) = run(&[&adapt[..], &["-o".as_ref(), output.as_os_str()]].concat());
    assert_eq!(status, 0, "{text}");
}

#[test]
fn links_that_double_at_every_step() {
    // Two links of a folder to itself: 2^40 paths, one report.
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("in");
    std::fs::create_dir(&folder).unwrap();
    std::fs::copy(fixture("reports/0001.txt"), folder.join("0001.txt")).unwrap();
    for name in ["a", "b"] {
        std::os::unix::fs::symlink(".", folder.join(name)).unwrap();
    }
    let output = scratch.path().join("s.csv");
    let (status, text) =
        run(&["segment".as_ref(), folder.as_os_str(), "-o".as_ref(), output.as_os_str()]);
    assert_eq!(status, 0, "{text}");
}
