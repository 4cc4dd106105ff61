//! Speed of reading against the limit of merely summing the bytes, and of writing.
//!
//! `cargo bench -p cruisefit-report --bench read`. Before criterion's groups the ratio of reading to summing is
//! printed, as the median of alternating runs on the same bytes: times alone depend on what else the machine does, the
//! ratio less so. Everything is warm in memory: files are not opened here.

#![expect(clippy::unwrap_used, reason = "a bench that cannot read its own report is wrong")]
#![expect(clippy::print_stdout, reason = "a bench talks")]

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group};
use report::{Reader, TextLayout, write};

/// The form of a report's text.
#[derive(Clone, Copy)]
enum Shape {
    /// All columns of the format's sample, one blank between them.
    Sample,
    /// Only the required columns, padded as many recorders do.
    Aligned,
}

fn report_text(rows: usize, shape: Shape) -> String {
    let (columns, width) = match shape {
        Shape::Sample => (18, 0),
        Shape::Aligned => (13, 7),
    };
    let names =
        "TIME ALT SAT MACH VTAS GSPD ROLL DRIFT N2(1) N2(2) WF(1) WF(2) FU LAT LON HDG CG A/I";
    let units = "s ft degC - kt kt deg deg % % lb/h lb/h lb deg deg deg %MAC -";
    let mut text = "\
CRUISE-REPORT 1
AIRCRAFT C750
TAIL     T-001
FLIGHT   0007
START    2018-05-20T14:14:21Z
ZFW      24283 lb
FOB      7219 lb
"
    .to_owned();
    let mut append = |words: &mut dyn Iterator<Item = String>, width: usize| {
        for (index, word) in words.take(columns).enumerate() {
            let blank = if index == 0 { "" } else { " " };
            write!(text, "{blank}{word:>width$}").unwrap();
        }
        text.push('\n');
    };
    append(&mut names.split(' ').map(str::to_owned), 0);
    append(&mut units.split(' ').map(str::to_owned), 0);
    for row in 0..rows {
        let share = row as f64 / rows as f64;
        let wave = (row as f64 * 0.7).sin();
        let values = [
            format!("{}", row * 60),
            format!("{:.0}", 43_000.0 + 8.0 * wave),
            format!("{:.1}", -56.6 + 2.0 * share + 0.2 * wave),
            format!("{:.4}", 0.8025 + 0.001 * wave),
            format!("{:.1}", 460.5 + wave),
            format!("{:.1}", 451.5 + 20.0 * share + wave),
            format!("{:.1}", -0.1 + 0.3 * wave),
            format!("{:.1}", 4.2 - 3.0 * share),
            format!("{:.1}", 89.4 - share),
            format!("{:.1}", 89.3 - share),
            format!("{:.0}", 654.0 - 20.0 * share + 4.0 * wave),
            format!("{:.0}", 658.0 - 20.0 * share - 4.0 * wave),
            format!("{:.0}", 1353.0 + 5000.0 * share),
            format!("{:.3}", 41.516 - 10.0 * share),
            format!("{:.3}", -69.976 + 20.0 * share),
            format!("{:.1}", 118.7 - 5.0 * share),
            format!("{:.1}", 27.2 - share),
            "0".to_owned(),
        ];
        append(&mut values.into_iter(), width);
    }
    text
}

fn sum_of_bytes(bytes: &[u8]) -> u64 {
    bytes.iter().map(|byte| u64::from(*byte)).sum()
}

/// Median duration of a run, of many.
fn median(mut durations: Vec<Duration>) -> Duration {
    durations.sort_unstable();
    durations[durations.len() / 2]
}

fn print_ratios() {
    const RUNS: usize = 401;
    const REPEATS: u32 = 50;
    for (name, rows, shape) in [
        ("120 rows of 18", 120, Shape::Sample),
        ("120 rows of 13, aligned", 120, Shape::Aligned),
        ("7200 rows of 18", 7200, Shape::Sample),
    ] {
        let text = report_text(rows, shape);
        let repeats = if rows > 1000 { 1 } else { REPEATS };
        let mut reader = Reader::new();
        let mut sums = Vec::new();
        let mut reads = Vec::new();
        for _ in 0..RUNS {
            let start = Instant::now();
            for _ in 0..repeats {
                black_box(sum_of_bytes(black_box(text.as_bytes())));
            }
            sums.push(start.elapsed());
            let start = Instant::now();
            for _ in 0..repeats {
                black_box(reader.read(black_box(text.as_bytes())).unwrap());
            }
            reads.push(start.elapsed());
        }
        let sum = median(sums).as_secs_f64() / f64::from(repeats);
        let read = median(reads).as_secs_f64() / f64::from(repeats);
        println!(
            "{name} ({} bytes): read {:.0} MB/s, {:.0} ns per row; sum of bytes {:.0} MB/s; ratio {:.1}",
            text.len(),
            text.len() as f64 / read / 1e6,
            read / rows as f64 * 1e9,
            text.len() as f64 / sum / 1e6,
            read / sum
        );
    }
}

fn reading(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("read");
    for rows in [120_usize, 7200] {
        let text = report_text(rows, Shape::Sample);
        group.throughput(Throughput::Bytes(text.len() as u64));
        group.bench_with_input(BenchmarkId::new("sum_of_bytes", rows), &text, |bencher, text| {
            bencher.iter(|| sum_of_bytes(black_box(text.as_bytes())));
        });
        group.bench_with_input(BenchmarkId::new("report", rows), &text, |bencher, text| {
            let mut reader = Reader::new();
            bencher.iter(|| reader.read(black_box(text.as_bytes())).unwrap());
        });
    }
    let aligned = report_text(120, Shape::Aligned);
    group.throughput(Throughput::Bytes(aligned.len() as u64));
    group.bench_with_input(BenchmarkId::new("report_aligned", 120), &aligned, |bencher, text| {
        let mut reader = Reader::new();
        bencher.iter(|| reader.read(black_box(text.as_bytes())).unwrap());
    });
    group.finish();
}

fn writing(criterion: &mut Criterion) {
    let text = report_text(120, Shape::Sample);
    let report = Reader::new().read(text.as_bytes()).unwrap().report;
    let layout = TextLayout::industry();
    let mut group = criterion.benchmark_group("write");
    group.throughput(Throughput::Bytes(text.len() as u64));
    group.bench_with_input(BenchmarkId::new("industry", 120), &report, |bencher, report| {
        bencher.iter(|| write(black_box(report), &layout, &[]).unwrap());
    });
    group.finish();
}

criterion_group!(benches, reading, writing);

fn main() {
    // Under `cargo test --benches` criterion runs everything once; computing the ratio would only cost time there.
    if std::env::args().any(|argument| argument == "--bench") {
        print_ratios();
    }
    benches();
    Criterion::default().configure_from_args().final_summary();
}
