//! Heavy tails: where the residuals that outliers left have them, segments are weighed.

use crate::library::Library;
use crate::math::quantile::MEDIAN_TO_DEVIATION;
use crate::math::quantile::{QuantileType, quantile};
use crate::priors::{ROBUST_EFFECT, ROBUST_SMOOTH, STUDENT_FREEDOM};
use crate::search::analyse::Analysis;
use crate::search::system::WhitenedSystem;
use crate::thresholds::{HEAVY_KURTOSIS, LEAST_ROBUST_SCALE};

/// Weights of segments, where the residuals of the best model have heavy tails.
///
/// ```text
/// w = min(1, √(5/(4 + e²/s²))),  e the largest whitened residual of the segment, s their robust scale   [diagnosis.50]
/// ```
pub(crate) fn outlier_weights(
    system: &WhitenedSystem<'_>,
    analysis: &Analysis,
    library: &Library,
) -> Option<Vec<f64>> {
    let best = analysis.models.first().map_or(&[][..], |(scored, _)| &scored.hypothesis.columns);
    let design = system.design;
    let (columns, deviations): (Vec<usize>, Vec<f64>) = best
        .iter()
        .map(|&column| {
            (column, ROBUST_EFFECT * library.effects[library.columns[column].effect].typical)
        })
        .chain(design.nuisance.clone().map(|column| (column, 1.0)))
        .chain(design.smooth.clone().map(|column| (column, ROBUST_SMOOTH)))
        .unzip();
    let gram = system.gram(None);
    let solution = gram.fit(&columns, &deviations, design.residual())?;

    let data = system.data;
    let channels = data.channels.count();
    let mut worst = Vec::with_capacity(data.segments.len());
    let mut all = Vec::with_capacity(data.segments.len() * channels);
    for (index, flight) in data.flights.iter().enumerate() {
        let rows = system.whitened(index);
        let mut left = rows.col_as_slice(design.residual()).to_vec();
        for (k, &column) in columns.iter().enumerate() {
            let size = solution[(k, 0)];
            for (left, value) in left.iter_mut().zip(rows.col_as_slice(column)) {
                *left -= value * size;
            }
        }
        left.truncate(flight.segments.len() * channels);
        for (segment, row) in left.chunks(channels).zip(&data.segments[flight.segments.clone()]) {
            worst.push(segment.iter().fold(0.0_f64, |largest, e| largest.max(e.abs())));
            // What is not recorded left a zero, which is no small residual.
            let recorded = segment.iter().zip(row.is_recorded).filter(|(_, recorded)| *recorded);
            all.extend(recorded.map(|(e, _)| *e));
        }
    }
    let count = all.len() as f64;
    let second = all.iter().map(|e| e * e).sum::<f64>() / count;
    let fourth = all.iter().map(|e| e.powi(4)).sum::<f64>() / count;
    let kurtosis = fourth / (second * second);
    if !kurtosis.is_finite() || kurtosis <= HEAVY_KURTOSIS {
        return None;
    }
    let mut sizes: Vec<f64> = all.iter().map(|e| e.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let scale = (MEDIAN_TO_DEVIATION * quantile(&sizes, 0.5, QuantileType::UpperType1))
        .max(LEAST_ROBUST_SCALE);
    Some(worst.into_iter().map(|e| student_weight(e / scale)).collect())
}

/// Weight of a segment whose largest residual is z scales: that of Student's distribution.
pub(crate) fn student_weight(z: f64) -> f64 {
    ((STUDENT_FREEDOM + 1.0) / (STUDENT_FREEDOM + z * z)).sqrt().min(1.0)
}
