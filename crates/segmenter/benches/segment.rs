//! One simulated cruise of 121 samples (`tests/golden/SIM-01_0001.txt`), already read.
//!
//! | id | what |
//! |---|---|
//! | `derive` | report to track, with the copy of the report that it takes |
//! | `segment` | track to eight segments and 121 verdicts |
#![expect(clippy::unwrap_used, reason = "a benchmark")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use segmenter::TrimCriteria;

fn reports(criterion: &mut Criterion) {
    let report = test_support::reports::read(include_str!("../tests/golden/SIM-01_0001.txt"));
    let track = track::derive(report.clone()).unwrap();
    let criteria = TrimCriteria::ghazi_2020_table_4();
    assert_eq!(segmenter::segment(&track, &criteria).segments.len(), 8);
    criterion.bench_function("derive", |bencher| {
        bencher.iter(|| track::derive(black_box(&report).clone()).unwrap());
    });
    criterion.bench_function("segment", |bencher| {
        bencher.iter(|| segmenter::segment(black_box(&track), &criteria));
    });
}

criterion_group!(benches, reports);
criterion_main!(benches);
