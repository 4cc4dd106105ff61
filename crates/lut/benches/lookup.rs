//! Look-ups at random points of a 30 × 20 table, one value and one four-node update per point, compared with `interpn`.
//!
//! Figures are points per second; compare them within one run only.
#![expect(clippy::unwrap_used, reason = "a benchmark")]

use std::hint::black_box;
use std::sync::Arc;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use interpn::{MultilinearRectilinear, MultilinearRegular};
use lut::{Axis, Grid, Outside, Table};

const POINTS: usize = 100_000;

/// A reproducible sequence in 0 … 1 (the generator of Knuth's MMIX, upper 53 bits).
struct Sequence(u64);

impl Sequence {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Two axes of 30 and 20 breakpoints; `bend` makes their steps grow.
fn grid(bend: f64) -> Arc<Grid> {
    let axis = |from: f64, to: f64, count: u32| {
        let place = |i: u32| {
            let share = f64::from(i) / f64::from(count - 1);
            from + (to - from) * ((1.0 - bend) * share + bend * share * share)
        };
        Axis::new((0..count).map(place).collect()).unwrap()
    };
    Arc::new(Grid::new(axis(0.1, 0.8, 30), axis(0.5, 0.95, 20)))
}

fn lookups(criterion: &mut Criterion) {
    let mut random = Sequence(1);
    let points: Vec<(f64, f64)> =
        (0..POINTS).map(|_| (0.1 + 0.7 * random.next(), 0.5 + 0.45 * random.next())).collect();
    let mut out = vec![0.0; POINTS];

    for (name, bend) in [("even axes", 0.0), ("uneven axes", 0.5)] {
        let grid = grid(bend);
        let values: Vec<f64> = (0..grid.nodes()).map(|_| 0.02 + 0.02 * random.next()).collect();
        let mut table = Table::new(Arc::clone(&grid), values).unwrap();
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(POINTS as u64));

        group.bench_function("value", |bencher| {
            bencher.iter(|| {
                for (&(x, y), out) in black_box(&points).iter().zip(&mut out) {
                    *out = grid
                        .locate(x, y, Outside::Error)
                        .map_or(f64::NAN, |cell| table.interpolate(&cell));
                }
                black_box(&mut out);
            });
        });
        let axes = [grid.x().breakpoints(), grid.y().breakpoints()];
        group.bench_function("value, interpn", |bencher| {
            let starts = [grid.x().first(), grid.y().first()];
            let steps = [axes[0][1] - axes[0][0], axes[1][1] - axes[1][0]];
            let regular = MultilinearRegular::new([30, 20], starts, steps, table.values()).unwrap();
            let rectilinear = MultilinearRectilinear::new(&axes, table.values()).unwrap();
            bencher.iter(|| {
                for (&(x, y), out) in black_box(&points).iter().zip(&mut out) {
                    *out = if bend == 0.0 {
                        regular.interp_one([x, y]).unwrap()
                    } else {
                        rectilinear.interp_one([x, y]).unwrap()
                    };
                }
                black_box(&mut out);
            });
        });
        group.bench_function("value and update of four nodes", |bencher| {
            bencher.iter(|| {
                for &(x, y) in black_box(&points) {
                    let Ok(cell) = grid.locate(x, y, Outside::Error) else { continue };
                    let excess = 0.03 - table.interpolate(&cell);
                    let values = table.values_mut();
                    for (node, weight) in cell.nodes().into_iter().zip(cell.weights()) {
                        values[node] += 0.5 * weight * excess;
                    }
                }
                black_box(table.values());
            });
        });
        group.finish();
    }
}

criterion_group!(benches, lookups);
criterion_main!(benches);
