//! Text of reports in, an adapted model and its errors out, all in memory.
//!
//! `cargo run -p cruisefit-pipeline --example adapt_and_evaluate`

#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use perf_model::{Aircraft, Guide, initial_model};
use pipeline::checksum::sha256;
use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::learning::{FlightToLearn, LawChoice, begin, learn_flight, settle};
use pipeline::model_file::{LedgerEntry, ModelFile};
use pipeline::reduction::ReducedFlight;
use segmenter::TrimCriteria;

const AIRCRAFT: &str = include_str!("../../../fixtures/global5000/AIRCRAFT.ron");
const GUIDE: &[u8] = include_bytes!("../../../fixtures/global5000/guide.csv");
/// In the order of flying.
const REPORTS: [&[u8]; 4] = [
    include_bytes!("../../../fixtures/global5000/reports/0001.txt"),
    include_bytes!("../../../fixtures/global5000/reports/0002.txt"),
    include_bytes!("../../../fixtures/global5000/reports/0003.txt"),
    include_bytes!("../../../fixtures/global5000/reports/0004.txt"),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let guide = Guide::from_csv(GUIDE)?;
    let initial = initial_model(&Aircraft::from_ron(AIRCRAFT)?, &guide)?;
    let mut model = ModelFile::from_initial(&initial, &guide);

    let criteria = TrimCriteria::ghazi_2020_table_4();
    let law = LawChoice::Bayes(model.settings.bayes);
    let mut learnt = begin(&model.initial, "SIM-01", TrimCriteria::PRESETS[0], law)?;
    let mut counts = TailCounts::default();
    let mut segments = Vec::new();
    for bytes in REPORTS {
        let report = report::Reader::new().read(bytes)?.report;
        let flight = ReducedFlight::from_report(report, &criteria, Vec::new())?;
        let entry = LedgerEntry {
            tail: flight.identity.tail.clone(),
            flight: flight.identity.flight.clone(),
            start: flight.identity.start.to_string(),
            content: sha256(bytes),
            samples: flight.samples as u64,
            segments: 0,
            outside_table: 0,
            gauges: flight.gauges,
        };
        learn_flight(
            &model.initial,
            &mut learnt,
            &FlightToLearn { entry, segments: &flight.segments },
        )?;
        counts.flights += 1;
        counts.flights_new += 1;
        counts.samples += flight.samples as u64;
        segments.extend(flight.segments);
    }
    settle(&mut learnt)?;
    model.learnt = Some(learnt);
    let text = model.to_text()?;
    assert_eq!(ModelFile::from_text(&text)?.to_text()?, text);

    let tail = "SIM-01".to_owned();
    let result =
        TailResult::adapted(TailData { tail, model, segments, counts, notes: vec![], curve: None });
    let errors = result.summary.fuel_flow_error_percent;
    let (before, after) =
        (errors.before.mean.unwrap_or(f64::NAN), errors.after.and_then(|e| e.mean));
    println!("{} segments: mean error {before:+.2} %, then {after:+.2?} %", result.rows.len());
    assert!(after.is_some_and(|after| after.abs() < before.abs()));
    Ok(())
}
