//! Running the binary, and the fixtures it runs on.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The repository's root.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The twelve reports of tail SIM-01 with aircraft file, guide and static points.
pub(crate) fn fixture(name: &str) -> PathBuf {
    root().join("fixtures/global5000").join(name)
}

/// How a run ended.
#[derive(Debug)]
pub(crate) struct Ran {
    pub(crate) status: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Runs the binary.
pub(crate) fn cruisefit<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> Ran {
    let Output { status, stdout, stderr } = Command::new(env!("CARGO_BIN_EXE_cruisefit"))
        .args(arguments)
        .env_remove("RUST_LOG")
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    Ran {
        status: status.code().unwrap_or(-1),
        stdout: String::from_utf8(stdout).unwrap(),
        stderr: String::from_utf8(stderr).unwrap(),
    }
}

impl Ran {
    /// Asserts the exit status, showing the output if it is another.
    pub(crate) fn expect(self, status: i32) -> Self {
        assert_eq!(self.status, status, "stdout:\n{}\nstderr:\n{}", self.stdout, self.stderr);
        self
    }

    /// Asserts that standard error contains this, whatever its line breaks.
    pub(crate) fn says(&self, words: &str) -> &Self {
        let flat = flatten(&self.stderr);
        assert!(flat.contains(&flatten(words)), "{words:?} is not in:\n{}", self.stderr);
        self
    }

    /// The same of standard output.
    pub(crate) fn prints(&self, words: &str) -> &Self {
        let flat = flatten(&self.stdout);
        assert!(flat.contains(&flatten(words)), "{words:?} is not in:\n{}", self.stdout);
        self
    }
}

/// Text without line breaks, frames of the terminal's error printer, or repeated blanks.
fn flatten(text: &str) -> String {
    let words: Vec<&str> = text
        .split(|c: char| c.is_whitespace() || c == '│')
        .filter(|word| !word.is_empty())
        .collect();
    words.join(" ")
}

/// An initial model of the fixture's aircraft, written to a folder.
pub(crate) fn initial_model(folder: &Path) -> PathBuf {
    let model = folder.join("MODEL.ron");
    init(&model, &[]).expect(0);
    model
}

/// `init` from the fixture's aircraft and guide, with further arguments.
pub(crate) fn init(model: &Path, more: &[&std::ffi::OsStr]) -> Ran {
    let (aircraft, guide) = (fixture("AIRCRAFT.ron"), fixture("guide.csv"));
    let mut arguments: Vec<&std::ffi::OsStr> = vec!["init".as_ref()];
    arguments.extend(["--aircraft".as_ref(), aircraft.as_os_str()]);
    arguments.extend(["--guide".as_ref(), guide.as_os_str(), "-o".as_ref(), model.as_os_str()]);
    arguments.extend(more);
    cruisefit(&arguments)
}

/// Adapts a model to reports, with further arguments.
pub(crate) fn adapt(model: &Path, output: &Path, reports: &[PathBuf], more: &[&str]) -> Ran {
    let mut arguments: Vec<std::ffi::OsString> = vec!["adapt".into()];
    arguments.extend(reports.iter().map(|path| path.as_os_str().to_owned()));
    arguments.extend(["--model".into(), model.as_os_str().to_owned()]);
    arguments.extend(["-o".into(), output.as_os_str().to_owned()]);
    arguments.extend(more.iter().map(Into::into));
    cruisefit(&arguments)
}

/// Every file below a folder with its bytes, by relative path.
pub(crate) fn bytes_below(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().to_string_lossy().into_owned();
                all.insert(name, std::fs::read(&path).unwrap());
            }
        }
    }
    all
}

/// Copies all files of a folder.
pub(crate) fn copy_of(folder: &Path, copy: &Path) {
    for (name, bytes) in bytes_below(folder) {
        let path = copy.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
}

/// What `diagnose` wrote to a folder, held to its schema.
pub(crate) fn diagnosis_document(folder: &Path) -> serde_json::Value {
    let text = std::fs::read_to_string(folder.join("diagnosis.json")).unwrap();
    let document = serde_json::from_str(&text).unwrap();
    crate::json_schema::assert_held("diagnosis-1.json", &document);
    document
}

/// A CSV file's columns by name.
pub(crate) fn csv_columns(path: &Path) -> BTreeMap<String, Vec<String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let names: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let mut columns: BTreeMap<String, Vec<String>> =
        names.iter().map(|name| (name.clone(), Vec::new())).collect();
    for record in reader.records() {
        for (name, field) in names.iter().zip(record.unwrap().iter()) {
            columns.get_mut(name).unwrap().push(field.to_owned());
        }
    }
    columns
}

/// The numbers of a CSV column.
pub(crate) fn numbers(columns: &BTreeMap<String, Vec<String>>, name: &str) -> Vec<f64> {
    columns[name].iter().map(|field| field.parse().unwrap()).collect()
}

/// The first report as a recording of another layout, and the mapping that reads it.
pub(crate) fn recording(folder: &Path) -> (PathBuf, PathBuf) {
    const MAPPING: &str = r#"(
    format: 1,
    separator: ',',
    aircraft: Text("global5000"),
    tail: Text("SIM-01"),
    flight: Text("0001"),
    time: Seconds(column: "TIME", start: "2019-03-14T10:45:00Z"),
    quantities: {
        "ALT": Recorded(column: "ALT", unit: "ft"),
        "SAT": Recorded(column: "SAT", unit: "degC"),
        "MACH": Recorded(column: "MACH", unit: "-"),
        "VTAS": Recorded(column: "VTAS", unit: "kt"),
        "GSPD": Recorded(column: "GSPD", unit: "kt"),
        "ROLL": Recorded(column: "ROLL", unit: "deg"),
        "DRIFT": Recorded(column: "DRIFT", unit: "deg"),
        "N2(1)": Recorded(column: "N2(1)", unit: "%"),
        "N2(2)": Recorded(column: "N2(2)", unit: "%"),
        "WF(1)": Recorded(column: "WF(1)", unit: "lb/h"),
        "WF(2)": Recorded(column: "WF(2)", unit: "lb/h"),
    },
    mass: FuelUsed(column: "FU", unit: "lb", zero_fuel_weight: (52960, "lb"), fuel_on_board: (15670, "lb")),
    out_of_range: LeaveRowOut,
)
"#;
    let text = std::fs::read_to_string(fixture("reports/0001.txt")).unwrap();
    let rows = text.lines().filter(|line| {
        line.starts_with("TIME") || line.trim_start().starts_with(|c: char| c.is_ascii_digit())
    });
    let csv: String = rows
        .flat_map(|row| [row.split_whitespace().collect::<Vec<_>>().join(","), "\n".to_owned()])
        .collect();
    let (recording, mapping) = (folder.join("recording.csv"), folder.join("mapping.ron"));
    std::fs::write(&recording, csv).unwrap();
    std::fs::write(&mapping, MAPPING).unwrap();
    (recording, mapping)
}
