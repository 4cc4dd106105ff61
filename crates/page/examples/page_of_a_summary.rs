//! A page from a summary: two tails, one refused report.
//!
//! `cargo run -p cruisefit-page --example page_of_a_summary`

#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use pipeline::statistics::ErrorStatistics;
use pipeline::summary::{
    ErrorsSummary, RefusedSummary, ReportsSummary, SCHEMA, Summary, TailSummary,
};

fn tail(name: &str, errors_percent: &[f64]) -> TailSummary {
    TailSummary {
        tail: name.to_owned(),
        flights: 1,
        flights_new: 1,
        samples: 90,
        segments: errors_percent.len(),
        outside_table: 0,
        not_evaluated: Vec::new(),
        informed_nodes: None,
        refits: None,
        fuel_flow_error_percent: ErrorsSummary {
            before: ErrorStatistics::from_errors(errors_percent),
            after: None,
            book: None,
        },
        book_half_width95_percent: None,
        fuel_factor_percent: None,
        mean_error_half_width95_percent: None,
        interval95_coverage: None,
        mean_error_within_percent: None,
        beyond_flights: None,
    }
}

fn main() {
    let refused = RefusedSummary {
        path: "reports/0003.txt".to_owned(),
        line: Some(12),
        column: Some(4),
        reason: "found \"--\", expected TIME".to_owned(),
    };
    let summary = Summary {
        schema: SCHEMA,
        reports: ReportsSummary { read: 2, refused: vec![refused], ..ReportsSummary::default() },
        tails: vec![tail("T-001", &[1.0, 2.0, 6.0]), tail("T-002", &[-0.5, 0.5])],
    };
    let html = page::report(&summary, &[], "Two tails");
    println!("{} bytes", html.len());
    // The mean of 1, 2 and 6 %, and where the refused report is wrong.
    assert!(html.contains("+3.00") && html.contains("reports/0003.txt:12:4"));
}
