//! Outliers: whitened residuals with heavy tails weigh segments down.

use crate::library::Library;
use crate::math::quantile::{QuantileType, quantile};
use crate::priors::{ROBUST_EFFECT, ROBUST_SMOOTH, STUDENT_FREEDOM};
use crate::search::analyse::Analysis;
use crate::search::system::WhitenedSystem;
use crate::thresholds::{HEAVY_KURTOSIS, LEAST_ROBUST_SCALE};

/// Median of |x| over the standard deviation of a normal distribution, inverted.
const MEDIAN_TO_DEVIATION: f64 = 1.4826;

/// Weights of segments, where the residuals of the best model have heavy tails.
///
/// ```text
/// w = min(1, √(5/(4 + e²/s²))),  e the largest whitened residual of the segment, s their robust scale   [diagnosis.21]
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

#[cfg(test)]
mod tests {
    use effects::EffectModel;

    use super::*;
    use crate::hypotheses::design::Design;
    use crate::library::dates::DateGrid;
    use crate::residuals::reference::Reference;
    use crate::residuals::segments::PreparedFlights;
    use crate::search::analyse::analyse;
    use crate::search::system::Problem;
    use crate::signals::record::FlightRecord;
    use crate::signals::references::references_of;
    use flight::Segment;
    use test_support::fleet::{Background, Setup, exact_model, fly};

    /// Rows, sum of squares of whitened residuals, and whether outlier weights are used.
    fn noise_of(flights: &[Vec<Segment>]) -> (f64, f64, bool) {
        noise_with(flights, None)
    }

    /// The same where every segment has this weight.
    fn noise_with(flights: &[Vec<Segment>], weight: Option<f64>) -> (f64, f64, bool) {
        let model = exact_model();
        let records: Vec<FlightRecord<'_>> =
            flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
        let references = references_of(&model, model.drag_table(), &records).unwrap();
        let effects = EffectModel::new(&model, model.drag_table(), references).unwrap();
        let (data, library) = PreparedFlights::prepare(
            &effects,
            &records,
            Reference::Table,
            |points, engines, starts| {
                Library::new(&effects, points, engines, DateGrid::coarse(starts, &[], None), |_| {
                    true
                })
            },
        );
        let design = Design::new(&data, &references, None, None);
        let weights = weight.map(|weight| vec![weight; data.segments.len()]);
        let system = WhitenedSystem::new(&data, &design, weights);
        let gram = system.gram(None);
        let square = gram.matrix[(design.residual(), design.residual())];
        let problem = Problem { system: &system, model: &effects, library: &library };
        let analysis = analyse(problem, None).unwrap();
        (gram.rows, square, outlier_weights(&system, &analysis, &library).is_some())
    }

    /// By hand: rows and squares of flights with N2 and of flights without are those of each kind alone, added. A channel
    /// that is not recorded is no perfect residual of zero.
    #[test]
    fn what_is_not_recorded_is_not_counted() {
        let setup = Setup { flights: 24, ..Setup::default() };
        let mut flights = fly(5, &setup, &[], &Background::default()).flights;
        let with_n2 = 13;
        for segment in flights[with_n2..].iter_mut().flatten() {
            segment.means.n2_percent.clear();
        }
        let (rows, square, _) = noise_of(&flights);
        let (rows_with, square_with, _) = noise_of(&flights[..with_n2]);
        let (rows_without, square_without, _) = noise_of(&flights[with_n2..]);
        let (found, by_hand) =
            (square / rows, (square_with + square_without) / (rows_with + rows_without));
        assert!((square / (square_with + square_without) - 1.0).abs() < 1e-9);
        assert!((found / by_hand - 1.0).abs() < 1e-9, "{rows} rows: {found}, by hand {by_hand}");
    }

    /// By hand: with a weight of a half everywhere squares and values are a quarter, and the noise between them is as before.
    #[test]
    fn weights_do_not_make_the_noise_smaller() {
        let setup = Setup { flights: 8, ..Setup::default() };
        let flights = fly(6, &setup, &[], &Background::default()).flights;
        let (rows, square, _) = noise_of(&flights);
        let (weighted_rows, weighted_square, _) = noise_with(&flights, Some(0.5));
        assert!((weighted_square / square - 0.25).abs() < 1e-12);
        assert!((weighted_rows / rows - 0.25).abs() < 1e-12, "{rows} {weighted_rows}");
    }

    /// Zeros of channels that are not recorded make normal residuals look as if they had heavy tails.
    #[test]
    fn what_is_not_recorded_is_no_heavy_tail() {
        let setup = Setup { flights: 24, ..Setup::default() };
        let mut flights = fly(5, &setup, &[], &Background::default()).flights;
        assert!(!noise_of(&flights).2);
        for segment in flights[13..].iter_mut().flatten() {
            segment.means.n2_percent.clear();
            segment.means.fuel_flow_engine_kg_s.clear();
        }
        assert!(!noise_of(&flights).2);
    }
}
