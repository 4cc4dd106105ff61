//! What is wrong with recorded data, before any model is trusted with it: units, signs, stuck channels, dates,
//! flights given twice.
//!
//! A cruise report carries every speed twice (true airspeed; Mach number with temperature), fuel twice (flow and its
//! counter) and motion twice (ground speed and position), so that most slips of a unit show without any model. What only
//! a model shows (a mass in the wrong unit where everything else is right) is in [`book`].

mod air;
pub mod book;
mod channels;
mod document;
mod flights;
mod fuel;
mod ground;
mod load;
mod slips;
mod spikes;

use std::hash::{DefaultHasher, Hasher};

use flight::{FlightIdentity, Report, Severity};
use segmenter::{INCOMPLETE_SHARE, Tally};
use serde::Serialize;

pub use document::{CheckDocument, SCHEMA, to_text};
pub use flights::check_flights;

/// Something that is, or may be, wrong with the data of a flight or of a tail.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DataFinding {
    /// How much it matters: `serious` where results from these data are worthless.
    #[serde(serialize_with = "severity_word")]
    pub severity: Severity,
    /// Stable name of the kind of finding.
    pub code: &'static str,
    /// Tail.
    pub tail: String,
    /// Flight; empty where the finding is about all flights of the tail.
    pub flight: String,
    /// START of the flight; empty as `flight` is.
    pub start: String,
    /// What was measured, in `unit`.
    pub size: f64,
    /// Unit of `size`; `-` for a ratio.
    pub unit: &'static str,
    /// What was found, with values.
    pub message: String,
    /// What probably caused it.
    pub likely_cause: String,
    /// The line of report or mapping that would mend it.
    pub remedy: String,
}

/// A finding about a flight before the flight is named.
#[derive(Clone, Debug, PartialEq)]
struct Draft {
    severity: Severity,
    code: &'static str,
    size: f64,
    unit: &'static str,
    message: String,
    likely_cause: String,
    remedy: String,
}

/// What was found in one report, with what is needed to compare flights with each other.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightCheck {
    /// Who and when.
    pub identity: FlightIdentity,
    /// Instants of first and last sample, s since 1970.
    pub instants_s: (f64, f64),
    /// Hash of the recorded columns: the same in a copy under another name or date. Of this program's run only: it is
    /// not kept.
    pub fingerprint: u64,
    /// What was found.
    pub findings: Vec<DataFinding>,
}

/// Share of a flight's rows from which those left out are worth a word. Our choice: a drop-out costs less.
const LEFT_OUT_SHARE: f64 = 0.05;

impl FlightCheck {
    /// The same with what is to be said of so many rows that a mapping left out beside those of the report.
    #[must_use]
    pub fn with_rows_left_out(mut self, rows: usize, left_out: usize) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "rows are far fewer than 2^53")]
        let share = left_out as f64 / (rows + left_out).max(1) as f64;
        if share > LEFT_OUT_SHARE {
            // What fuel or positions and time add up to without these rows says nothing of units.
            for finding in &mut self.findings {
                if [fuel::USED_AGAINST_FLOW, ground::AGAINST_POSITION].contains(&finding.code) {
                    "the rows that are left out".clone_into(&mut finding.likely_cause);
                    "see rows-left-out first".clone_into(&mut finding.remedy);
                }
            }
            let draft = Draft {
                severity: Severity::Warning,
                code: "rows-left-out",
                size: 100.0 * share,
                unit: "%",
                message: format!(
                    "{left_out} rows that cannot be read or hold a number out of range are left out, {rows} are used"
                ),
                likely_cause: "the form of time or of a number, or its unit".to_owned(),
                remedy: "look at the first of them, which the warning above names".to_owned(),
            };
            self.add(draft);
        }
        self
    }

    /// The same with what is to be said of minutes that are dropped because they hold too few samples.
    #[must_use]
    pub fn with_incomplete_minutes(mut self, tally: &Tally) -> Self {
        let share = tally.incomplete_share();
        if share > INCOMPLETE_SHARE {
            let minutes = tally.incomplete_bins;
            let draft = Draft {
                severity: Severity::Warning,
                code: "minutes-left-out",
                size: 100.0 * share,
                unit: "%",
                message: format!(
                    "{minutes} minutes with less than half of their samples are left out, {} are used",
                    tally.samples
                ),
                likely_cause: "drop-outs, or a recorder that changes to less than one sample in 30 s on the way".to_owned(),
                remedy: "export the recording with all its rows, or each rate as a flight of its own".to_owned(),
            };
            self.add(draft);
        }
        self
    }

    /// Adds a finding in its place: the gravest first.
    fn add(&mut self, draft: Draft) {
        self.findings.push(draft.for_flight(&self.identity));
        self.findings.sort_by_key(|finding| core::cmp::Reverse(finding.severity));
    }
}

/// Checks one report by itself.
#[must_use]
pub fn check_report(report: &Report) -> FlightCheck {
    let flow_kg_s = report.columns().fuel_flow.totals_kg_s();
    let drafts = [
        load::check(report, &flow_kg_s),
        air::check(report),
        ground::check(report),
        fuel::check(report, &flow_kg_s),
        channels::check(report),
        spikes::check(report),
    ];
    checked(report, &flow_kg_s, drafts.into_iter().flatten())
}

/// Checks averaged points: by what holds at each of them, not by what happens between them.
#[must_use]
pub fn check_points(report: &Report) -> FlightCheck {
    let flow_kg_s = report.columns().fuel_flow.totals_kg_s();
    let drafts = [
        load::check_point(report, &flow_kg_s),
        air::check(report),
        fuel::check(report, &flow_kg_s),
        channels::check(report),
    ];
    checked(report, &flow_kg_s, drafts.into_iter().flatten())
}

/// `flow_kg_s` is the total fuel flow of each sample.
fn checked(report: &Report, flow_kg_s: &[f64], drafts: impl Iterator<Item = Draft>) -> FlightCheck {
    let identity = report.header().identity.clone();
    let time_s = &report.columns().time_s;
    let start_s = identity.start_s();
    let mut findings: Vec<DataFinding> = drafts.map(|draft| draft.for_flight(&identity)).collect();
    findings.sort_by_key(|finding| core::cmp::Reverse(finding.severity));
    let (first, last) = (time_s.first().copied(), time_s.last().copied());
    FlightCheck {
        instants_s: (start_s + first.unwrap_or(0.0), start_s + last.unwrap_or(0.0)),
        fingerprint: fingerprint(report, flow_kg_s),
        identity,
        findings,
    }
}

impl Draft {
    fn for_flight(self, identity: &FlightIdentity) -> DataFinding {
        DataFinding {
            severity: self.severity,
            code: self.code,
            tail: identity.tail.clone(),
            flight: identity.flight.clone(),
            start: identity.start.to_string(),
            size: self.size,
            unit: self.unit,
            message: self.message,
            likely_cause: self.likely_cause,
            remedy: self.remedy,
        }
    }
}

/// The word for a severity in JSON and tables.
#[must_use]
pub const fn word(severity: Severity) -> &'static str {
    match severity {
        Severity::Note => "note",
        Severity::Warning => "warning",
        Severity::Serious => "serious",
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde calls")]
fn severity_word<S: serde::Serializer>(
    severity: &Severity,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(word(*severity))
}

fn fingerprint(report: &Report, flow_kg_s: &[f64]) -> u64 {
    const ROWS_AT_ONCE: usize = 64;
    let columns = report.columns();
    let series = [
        columns.pressure_altitude_m.as_slice(),
        &columns.mach,
        &columns.ground_speed_m_s,
        &columns.true_airspeed_m_s,
        flow_kg_s,
    ];
    let mut hasher = DefaultHasher::new();
    for from in (0..report.len()).step_by(ROWS_AT_ONCE) {
        // The hasher takes most of the time: of a row it gets one word.
        let mut words = [0_u64; ROWS_AT_ONCE];
        for (values, factor) in series.iter().zip(ROW_FACTORS) {
            let values = values.get(from..).unwrap_or_default();
            for (word, value) in words.iter_mut().zip(values) {
                *word = word.wrapping_add(value.to_bits().wrapping_mul(factor));
            }
        }
        hasher.write(words.map(u64::to_ne_bytes).as_flattened());
    }
    hasher.write_usize(report.len());
    hasher.finish()
}

/// The square roots of 2, 3, 5, 7 and 11, as odd 64-bit fractions: the sum of five values' bits, each times one of them, is another
/// where a value is.
const ROW_FACTORS: [u64; 5] = [
    0x6a09_e667_f3bc_c909,
    0xbb67_ae85_84ca_a73b,
    0x3c6e_f372_fe94_f82b,
    0xa54f_f53a_5f1d_36f1,
    0x510e_527f_ade6_82d1,
];

/// Arithmetic mean; `None` of nothing.
fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0_u32);
    for value in values {
        sum += value;
        count += 1;
    }
    (count > 0).then(|| sum / f64::from(count))
}
