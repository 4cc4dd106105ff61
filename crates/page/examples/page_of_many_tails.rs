//! The page of 200 tails, all on one page: the flights of `fixtures` under 200 names. `benches/first_paint.py` measures it.
//!
//! `cargo run --release -p cruisefit-page --example page_of_many_tails > report-200.html`

#![expect(clippy::print_stdout, reason = "the page goes where it is sent")]
#![expect(clippy::unwrap_used, reason = "an example shows the path that works")]

use pipeline::evaluation::{TailCounts, TailData, TailResult};
use pipeline::model_file::ModelFile;
use pipeline::segments_table;
use pipeline::summary::{ReportsSummary, SCHEMA, Summary};

const TAILS: u32 = 200;
const MODEL: &str = include_str!("../../../fixtures/global5000/expected/SIM-01.ron");
const SEGMENTS: &[u8] = include_bytes!("../../../fixtures/global5000/expected/SIM-01_segments.csv");

fn main() {
    let model = ModelFile::from_text(MODEL).unwrap();
    let segments = segments_table::read(SEGMENTS).unwrap();
    let tails: Vec<TailResult> = (0..TAILS)
        .map(|k| {
            let mut segments = segments.clone();
            // From 1 % less to 1 % more fuel flow, so that tails differ.
            for segment in &mut segments {
                segment.means.fuel_flow_total_kg_s *= 0.99 + 1e-4 * f64::from(k);
            }
            TailResult::adapted(TailData {
                tail: format!("T-{k:03}"),
                model: model.clone(),
                segments,
                counts: TailCounts { flights: 12, flights_new: 12, samples: 900 },
                notes: Vec::new(),
                curve: None,
            })
        })
        .collect();
    let summary = Summary {
        schema: SCHEMA,
        reports: ReportsSummary::default(),
        tails: tails.iter().map(|tail| tail.summary.clone()).collect(),
    };
    let page = page::report(&summary, &tails, "200 tails");
    assert!(page.len() < 6_000_000, "a page that can be mailed");
    print!("{page}");
}
