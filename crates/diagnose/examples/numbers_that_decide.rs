//! Prints the book's page "Every number that decides":
//! `cargo run -p cruisefit-diagnose --example numbers_that_decide > docs/src/theory/numbers_that_decide.md`.
//!
//! The numbers of `diagnose` come from its own list. Those of other crates are read from their sources, by the name of the
//! constant or field, so that the page cannot say another value than the code; only the words are here. A test compares the
//! page in the book with what is printed.
#![expect(
    clippy::print_stdout,
    clippy::disallowed_methods,
    clippy::expect_used,
    reason = "a program of the repository that prints a page from its sources"
)]

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use diagnose::{Certainty, DecidingNumber, numbers_that_decide};
use flight::effect::{EffectId, TypicalSize};

/// A number of another crate: its name in the source, unit, what it decides, where it comes from.
type Row = (&'static str, &'static str, &'static str, Certainty);

/// Numbers of one part of a source file: title, file, text after which they stand, rows.
type Part = (&'static str, &'static str, &'static str, &'static [Row]);

const INTRODUCTION: &str = "\
<!-- Made by `cargo run -p cruisefit-diagnose --example numbers_that_decide`; a test compares it with the program. -->

# Every number that decides

This page lists every number that decides what is believed before a flight is looked at, or what is answered afterwards.
It is made from the source code, by `cargo run -p cruisefit-diagnose --example numbers_that_decide`.

*Source* is a publication, or arithmetic that anyone can repeat.
*Measured* is a measurement with this program; most are on the pages under [Validation](../validation.md).
*Our choice* is nothing more than that, with the reason.
None of these numbers was fitted to the flights of an operator.

Criteria of stabilised segments are in [Sampling, rates and stabilised segments](steadiness.md), constants of physics in \
[Atmosphere](atmosphere.md) and [Conventions](conventions.md).
Iteration limits and tolerances of solvers change nothing that can be seen in an answer; they are not listed.
";

const OTHERS: &[Part] = &[
    (
        "Law `bayes`: the prior and the noise",
        "adapt/src/bayes/settings.rs",
        "fn physical_2026",
        BAYES,
    ),
    ("Law `bayes`: the patch", "adapt/src/bayes/settings.rs", "", PATCH),
    ("Law `bayes`: the guard", "adapt/src/bayes/guard.rs", "", GUARD),
    ("Law `bayes`: what is an observation", "adapt/src/bayes.rs", "", OBSERVATION),
    ("`tune`: noise", "adapt/src/bayes/evidence.rs", "fn standard", TUNE),
    ("`tune`: half-life", "adapt/src/bayes/half_life.rs", "", HALF_LIFE),
    ("Law `paper`", "adapt/src/paper.rs", "fn ghazi_2020", PAPER),
    (
        "Sensors, where the aircraft file states none",
        "perf-model/src/aircraft/sensors.rs",
        "for SensorDeviations",
        SENSORS,
    ),
    (
        "Per-flight bias, where the aircraft file states none",
        "perf-model/src/aircraft/sensors.rs",
        "for FlightBias",
        BIAS,
    ),
    ("What a guide must determine", "perf-model/src/initial.rs", "", GUIDE),
    ("What is said of a guide", "perf-model/src/initial/findings.rs", "", FINDINGS),
    ("Form of effects on drag", "effects/src/drag.rs", "", DRAG),
    ("Form of effects on engines", "effects/src/engine.rs", "", ENGINE),
    ("Form of effects: drag divergence", "flight/src/effect/airframe.rs", "", DIVERGENCE),
    ("What a diagnosis says in words", "pipeline/src/diagnosis_words/limits.rs", "", WORDS),
];

const BAYES: &[Row] = &[
    (
        "correction_std",
        "of drag",
        "typical size of the correction",
        Certainty::OurChoice(
            "A guide is 2 to 7 % too optimistic, an aircraft and its engines are a few per cent off.",
        ),
    ),
    (
        "slope_std_per_lift_coefficient",
        "per unit CL",
        "mean slope of the correction along lift coefficient",
        Certainty::OurChoice("Induced drag that is 6 to 18 % off tilts it by 0.06 to 0.17."),
    ),
    (
        "slope_std_per_mach",
        "per Mach",
        "mean slope of the correction along Mach number",
        Certainty::OurChoice(
            "A drag rise 0.006 Mach number early tilts it by 0.2 to 0.4 around drag divergence.",
        ),
    ),
    (
        "bend_std_per_lift_coefficient_squared",
        "per CL²",
        "mean bend along lift coefficient",
        Certainty::OurChoice("A polar that is no parabola departs by 1 to 2 % over half a patch."),
    ),
    (
        "bend_std_per_lift_coefficient_mach",
        "per CL and Mach",
        "mean mixed bend",
        Certainty::OurChoice("As along lift coefficient."),
    ),
    (
        "bend_std_per_mach_squared",
        "per Mach²",
        "mean bend along Mach number",
        Certainty::OurChoice(
            "The correction shall be straight to about 0.1 % in a cell 0.05 wide: a table holds nothing finer.",
        ),
    ),
    (
        "extra_flight_std",
        "of drag",
        "error common to a flight beyond the sensors' part",
        Certainty::OurChoice(
            "Reynolds number, temperature, throttle and heating value: about 1.2 % if all act at once.",
        ),
    ),
    (
        "extra_segment_std",
        "of drag",
        "error of a segment beyond the sensors' part",
        Certainty::OurChoice("The same causes change by about a third during a flight."),
    ),
    (
        "sensor_segment_factor",
        "",
        "factor on the sensors' part of a segment",
        Certainty::OurChoice("The aircraft file is believed; `tune` finds another factor."),
    ),
    (
        "sensor_flight_factor",
        "",
        "factor on the sensors' part of a flight",
        Certainty::OurChoice("The aircraft file is believed; `tune` finds another factor."),
    ),
    (
        "student_degrees_of_freedom",
        "",
        "degrees of freedom of the Student distribution behind outlier weights",
        Certainty::OurChoice(
            "An error of ten standard deviations keeps a twentieth of its weight.",
        ),
    ),
    (
        "half_life_days",
        "days",
        "calendar time after which knowledge counts half",
        Certainty::OurChoice(
            "Off: what ages, and how fast, is for flights to say (`tune --half-life`).",
        ),
    ),
];
const PATCH: &[Row] = &[
    (
        "PATCH_LIFT_COEFFICIENT",
        "CL",
        "extent over which slopes and bends have their size",
        Certainty::OurChoice("About the range of one aircraft's cruise."),
    ),
    (
        "PATCH_MACH",
        "Mach",
        "extent over which slopes and bends have their size",
        Certainty::OurChoice("About the range of one aircraft's cruise."),
    ),
];
const GUARD: &[Row] = &[(
    "MINIMUM_SHARE",
    "of the initial drag",
    "least drag that a correction may leave",
    Certainty::OurChoice("Drag stays positive; no aircraft has a tenth of its guide's drag."),
)];
const OBSERVATION: &[Row] = &[(
    "MAXIMUM_DRAG_RATIO",
    "of the initial drag",
    "drag beyond which a segment is no observation",
    Certainty::OurChoice("Ten times the table's drag is an error of units or of a sensor."),
)];
const TUNE: &[Row] = &[
    (
        "largest_factor",
        "",
        "largest change of a setting",
        Certainty::OurChoice("The defaults are sizes of known physics: not off by more."),
    ),
    (
        "prior_factor",
        "",
        "factor to which each setting is known before",
        Certainty::OurChoice("A factor of two: few flights do not make noise vanish."),
    ),
];
const HALF_LIFE: &[Row] = &[
    (
        "CANDIDATES_DAYS",
        "days",
        "half-lives that are tried",
        Certainty::OurChoice("A month to twenty-one years, in factors of two."),
    ),
    (
        "LONGEST_OVER_SPAN",
        "of the flights' span",
        "longest half-life that is tried",
        Certainty::OurChoice("Longer ones are as good as none."),
    ),
    (
        "NEEDED_GAIN",
        "ln density",
        "gain that ageing must bring",
        Certainty::Source("\"Strong\" evidence, 2 ln B > 6 (Kass and Raftery 1995, section 3.2)."),
    ),
];
const PAPER: &[Row] = &[(
    "threshold_percent",
    "% of fuel flow",
    "error above which a segment is learnt",
    Certainty::Source("Ghazi et al. 2020."),
)];
const SENSORS: &[Row] = &[
    (
        "fuel_flow_percent",
        "%",
        "fuel flow of each engine, a segment's mean",
        Certainty::OurChoice("The accuracy that operators quote for flow meters."),
    ),
    (
        "mach",
        "Mach",
        "Mach number",
        Certainty::OurChoice("Resolution and repeatability of an air-data computer."),
    ),
    (
        "static_air_temperature_k",
        "K",
        "static air temperature",
        Certainty::OurChoice("A total-temperature probe."),
    ),
    (
        "acceleration_m_s2",
        "m/s²",
        "along-path acceleration of one sample of 60 s",
        Certainty::Measured(
            "Simulated turbulence, ground speed rounded to 0.5 kt: 0.003 to 0.006.",
        ),
    ),
    (
        "mass",
        "%",
        "gross mass, from flight to flight",
        Certainty::OurChoice(
            "80 kg of a zero-fuel mass of 11 t: loading, standard passenger weights.",
        ),
    ),
    (
        "lower_heating_value_percent",
        "%",
        "heating value, from flight to flight",
        Certainty::OurChoice("Batches spread by about ±0.5 %."),
    ),
    (
        "n2_percent",
        "%",
        "speed of the high-pressure rotor",
        Certainty::OurChoice("Displays show tenths of a per cent."),
    ),
    (
        "pressure_altitude_m",
        "m",
        "pressure altitude",
        Certainty::OurChoice("Resolution and repeatability of an air-data computer."),
    ),
];
const BIAS: &[Row] = &[
    (
        "mach",
        "Mach",
        "what a flight has in common of Mach number",
        Certainty::OurChoice(
            "0.7 of the sensor's deviation, so that half of its variance stays through a flight.",
        ),
    ),
    (
        "static_air_temperature_k",
        "K",
        "the same of static air temperature",
        Certainty::OurChoice("0.7 of the sensor's deviation."),
    ),
    ("n2_percent", "%", "the same of N2", Certainty::OurChoice("0.7 of the sensor's deviation.")),
    (
        "pressure_altitude_m",
        "m",
        "the same of pressure altitude",
        Certainty::OurChoice("0.7 of the sensor's deviation."),
    ),
];
const GUIDE: &[Row] = &[(
    "MAXIMUM_AMPLIFICATION",
    "",
    "growth of an error from a guide's rows to a node beyond which the guide is refused",
    Certainty::OurChoice(
        "There an error of 1 % is as large as the drag. Usual guides reach 1 to 3, one weight and altitude 10⁴.",
    ),
)];
const FINDINGS: &[Row] = &[
    (
        "THIN_AMPLIFICATION",
        "",
        "growth above which a guide is called thin",
        Certainty::OurChoice(
            "A guide rounded to 0.5 % is then wrong by more than 2.5 % somewhere.",
        ),
    ),
    (
        "LARGE_RESIDUAL_PERCENT",
        "%",
        "residual above which the polynomial does not follow the guide",
        Certainty::OurChoice("A quadratic misses a drag rise by 1 to 3 %."),
    ),
    (
        "ODD_ROW_FACTOR",
        "of the rms",
        "residual of a row that is probably mistyped",
        Certainty::OurChoice("Five times the rms is rare in what was typed correctly."),
    ),
];
const DRAG: &[Row] = &[
    (
        "LOCK_FACTOR",
        "per Mach⁴",
        "steepness of the drag rise",
        Certainty::Source("Lock's parabola of fourth degree."),
    ),
    (
        "LOCK_OFFSET_MACH",
        "Mach",
        "drag divergence above the beginning of the rise",
        Certainty::Source(
            "Arithmetic from Lock's parabola: (0.1/80)^(1/3) is where its slope is 0.1.",
        ),
    ),
    (
        "DIVERGENCE_FALL_PER_LIFT_COEFFICIENT",
        "Mach",
        "fall of the drag-divergence Mach number per unit of lift coefficient",
        Certainty::OurChoice(
            "A number of usual size; the fit of θ makes up for what differs near cruise.",
        ),
    ),
    (
        "DIVERGENCE_LIFT_COEFFICIENT",
        "CL",
        "lift coefficient at which drag-divergence Mach numbers are stated",
        Certainty::OurChoice("A usual cruise."),
    ),
    (
        "TRIM_LIFT_COEFFICIENT",
        "CL",
        "lift coefficient at which trim drag is stated",
        Certainty::OurChoice("A usual cruise."),
    ),
    (
        "WINGS_LEVEL_DEG",
        "deg",
        "roll up to which a segment counts as wings level",
        Certainty::OurChoice("Beyond it an aircraft turns."),
    ),
];
const ENGINE: &[Row] = &[
    (
        "ANTI_ICE_PROXY_K",
        "K",
        "SAT above which anti-ice bleed is taken as on where it is not recorded",
        Certainty::OurChoice("−40 °C: colder air holds hardly any supercooled water."),
    ),
    (
        "THROTTLE_WIDTH",
        "of the reference",
        "width of the throttle effect's parabola",
        Certainty::OurChoice(
            "A quarter of the corrected thrust: θ is then TSFC at the edge of usual cruise.",
        ),
    ),
];
const DIVERGENCE: &[Row] = &[(
    "DRAG_DIVERGENCE_MACH",
    "Mach",
    "drag-divergence Mach number where neither aircraft file nor search says one",
    Certainty::OurChoice("The middle of the range that a search goes through."),
)];
const WORDS: &[Row] = &[
    (
        "OTHERS_TOLD",
        "causes",
        "further causes that are told",
        Certainty::OurChoice("A dozen lines in all; `diagnosis.json` has the rest."),
    ),
    (
        "LEAST_TOLD",
        "",
        "least probability of a further cause that is told",
        Certainty::OurChoice("One in fifty is not worth a line."),
    ),
    (
        "SEPARATIONS_TOLD",
        "",
        "measurements or flights that are told",
        Certainty::OurChoice("The best two; `diagnosis.json` has the rest."),
    ),
    (
        "TOLD_APART",
        "standard deviations",
        "distance that the second measurement brings about at least",
        Certainty::OurChoice("Below it two effects are of one class."),
    ),
    (
        "PROBABLE",
        "",
        "probability below which no cause is told as one",
        Certainty::OurChoice("More probable than not."),
    ),
];

fn main() {
    let page = page();
    assert!(numbers_that_decide().iter().all(|number| !reason(number.certainty).1.is_empty()));
    print!("{page}");
}

/// The whole page.
fn page() -> String {
    let mut page = INTRODUCTION.to_owned();
    let numbers = numbers_that_decide();
    page.push_str("\n## Diagnosis\n");
    for group in numbers.chunk_by(|a, b| a.group == b.group) {
        table(&mut page, group[0].group, group);
    }
    page.push_str("\n## Typical sizes of effects\n\n");
    page.push_str("Our choice: sizes at which an engineer would ask for the cause; [Assumptions](../assumptions.md) has sizes from sources.\n");
    page.push_str(
        "They decide through `PRIOR_SCALES`: three times as large is as probable a scale, ten times a fifth of that.\n\n",
    );
    page.push_str("| effect | typical size | unit |\n|---|---|---|\n");
    for id in EffectId::ALL {
        let entry = id.entry();
        let (size, unit) = match entry.typical {
            TypicalSize::Absolute(size) => {
                (size.to_string(), if entry.unit == "1" { "coefficient" } else { entry.unit })
            }
            TypicalSize::ShareOfMass(share) => (share.to_string(), "of the aircraft's mass"),
            TypicalSize::Known => ("1".to_owned(), "known from physics (`KNOWN_DEVIATION`)"),
        };
        let _ = writeln!(page, "| `{}` | {size} | {unit} |", entry.name);
    }
    page.push_str("\n## Adaptation, aircraft and words\n");
    for (title, file, after, rows) in OTHERS {
        let source = fs::read_to_string(root().join("crates").join(file)).expect("a source file");
        let source = &source[source.find(after).expect("a place in the source")..];
        let numbers: Vec<DecidingNumber> = rows
            .iter()
            .map(|&(name, unit, decides, certainty)| DecidingNumber {
                group: title,
                name,
                value: value_in(source, name),
                unit,
                decides,
                certainty,
            })
            .collect();
        table(&mut page, title, &numbers);
    }
    page
}

/// A heading and one row per number.
fn table(page: &mut String, title: &str, numbers: &[DecidingNumber]) {
    let _ =
        writeln!(page, "\n### {title}\n\n| number | value | decides | from |\n|---|---|---|---|");
    for number in numbers {
        let (kind, why) = reason(number.certainty);
        let space = if number.unit.is_empty() { "" } else { " " };
        let _ = writeln!(
            page,
            "| `{}` | {}{space}{} | {} | *{kind}:* {why} |",
            number.name, number.value, number.unit, number.decides
        );
    }
}

fn reason(certainty: Certainty) -> (&'static str, &'static str) {
    match certainty {
        Certainty::Source(text) => ("Source", text),
        Certainty::Measured(text) => ("Measured", text),
        Certainty::OurChoice(text) => ("Our choice", text),
    }
}

/// The value of a constant, `NAME: type = value;`, or of a field, `name: value,`, in a source text.
fn value_in(source: &str, name: &str) -> String {
    let definition = |line: &&str| {
        let before = line.split(&format!("{name}: ")).next().unwrap_or_default();
        before.len() < line.len()
            && !before.ends_with(|c: char| c.is_alphanumeric() || c == '_')
            && !before.contains("//")
    };
    let line = source.lines().find(definition).expect("a number in the source");
    let (_, value) = line.split_once(&format!("{name}: ")).expect("found above");
    let value = value.split_once(" = ").map_or(value, |(_, value)| value);
    let value = value.trim_end_matches([';', ',', ' ', '}', '{']);
    let value = value.trim_start_matches('[').trim_end_matches(']');
    let inner = value.rsplit_once('(').map_or(value, |(_, inner)| inner.trim_end_matches(')'));
    if inner == "None" { "none".to_owned() } else { inner.to_owned() }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_in_the_book_is_what_the_program_prints() {
        let path = root().join("docs/src/theory/numbers_that_decide.md");
        let committed = fs::read_to_string(path).unwrap();
        assert!(
            committed == page(),
            "make it again: cargo run -p cruisefit-diagnose --example numbers_that_decide > docs/src/theory/numbers_that_decide.md"
        );
    }

    #[test]
    fn no_cell_is_too_long_to_read() {
        for line in page().lines().filter(|line| line.starts_with('|')) {
            for cell in line.split('|') {
                assert!(cell.chars().count() < 140, "{cell}");
            }
        }
    }

    #[test]
    fn no_two_numbers_have_one_name() {
        let mut names: Vec<_> = numbers_that_decide().into_iter().map(|n| n.name).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
    }

    #[test]
    fn values_are_read_from_a_source() {
        let source = "/// NEEDED: 5\npub const NEEDED: f64 = 3.0;\nmass: MassDeviation::Percent(0.7),\nnumber_mass: 1,\nSelf { threshold: 5.0 }\nconst DAYS: [f64; 2] = [1.0, 2.0];";
        assert_eq!(value_in(source, "NEEDED"), "3.0");
        assert_eq!(value_in(source, "mass"), "0.7");
        assert_eq!(value_in(source, "threshold"), "5.0");
        assert_eq!(value_in(source, "DAYS"), "1.0, 2.0");
    }
}
