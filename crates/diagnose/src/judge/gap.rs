//! How large the gap is, and whether there is one.

use statrs::function::erf::erfc;

use crate::hypotheses::evidence::ScoredHypothesis;
use crate::judge::closure::Shrinkage;
use crate::judge::posterior::Posterior;
use crate::output::Gap;
use crate::priors::NOISE_FREEDOM;
use crate::search::analyse::Analysis;
use crate::search::outside::Outside;
use crate::search::system::WhitenedSystem;
use crate::thresholds::{
    CLEAN_PROBABILITY, MORE_PROBABLE_THAN_NOT, NORMAL_95, OUTSIDE_PROBABILITY, SMALLEST_GAP,
    SMALLEST_GAP_PERCENT,
};

/// Whether there is more than noise: either nothing at all is improbable beside the library, or nothing outside it is.
pub(crate) fn is_real(analysis: &Analysis, outside: &Outside) -> bool {
    analysis.clean <= CLEAN_PROBABILITY || 1.0 - outside.probability <= CLEAN_PROBABILITY
}

/// Whether the gap is larger than noise and what the model does not know together by what closure needs, at 97.5 %: then it
/// is real, however many small effects could make it up together. `unknown` is a mean square of ln fuel flow.
pub(crate) fn exceeds_uncertainty(gap: &Gap, unknown: f64) -> bool {
    let expected = gap.noise_floor_rms_percent.powi(2) + 1e4 * unknown;
    gap.rms_ci95[0].powi(2) > (1.0 + SMALLEST_GAP) * expected
}

/// Whether what is explained, in fuel flow or between engines, or what exceeds the floor is large enough to be a gap at all.
pub(crate) fn is_large(system: &WhitenedSystem<'_>, gap: &Gap, top: Option<&Posterior>) -> bool {
    let excess = gap.rms_ci95[0].powi(2) - gap.noise_floor_rms_percent.powi(2);
    let channels = 1 + system.data.channels.contrasts;
    let explained = top.map_or(0.0, |top| {
        let scored = &top.scored;
        let scatter = scored.hypothesis.flight_scatter_percent.unwrap_or(0.0);
        let mut largest = scatter * scatter;
        for channel in 0..channels {
            let square: f64 = system
                .data
                .segments
                .iter()
                .map(|row| {
                    let columns = scored.hypothesis.columns.iter().zip(&scored.sizes);
                    let of =
                        |(&column, size): (&usize, &f64)| size * row.signatures[column][channel];
                    columns.map(of).sum::<f64>().powi(2)
                })
                .sum();
            largest = largest.max(1e4 * square / system.data.segments.len() as f64);
        }
        largest
    });
    excess.max(explained) >= SMALLEST_GAP_PERCENT * SMALLEST_GAP_PERCENT
}

/// Mean square of ln fuel flow that the table, the chords of its cells and a taught remainder leave open.
pub(crate) fn unknown_square(system: &WhitenedSystem<'_>) -> f64 {
    let (data, design) = (system.data, system.design);
    let sum: f64 = data
        .flights
        .iter()
        .map(|flight| {
            let rows = design.nuisance_of_fuel_flow(data, flight);
            (0..rows.nrows())
                .flat_map(|row| design.nuisance.clone().map(move |column| (row, column)))
                .map(|at| rows[at] * rows[at])
                .sum::<f64>()
        })
        .sum();
    sum / data.segments.len().max(1) as f64
}

/// Whether the evidence points at nothing: nothing is more probable than not, and the size of the gap is within its noise or
/// the leading set widens it on flights that it was not fitted to. A remainder is never exact, and what is left over
/// is spread over many small hypotheses.
pub(crate) fn is_vague(
    gap: &Gap,
    outside: &Outside,
    top: Option<&Posterior>,
    makes_worse: bool,
) -> bool {
    outside.probability <= OUTSIDE_PROBABILITY
        && top.is_none_or(|top| {
            top.probability * (1.0 - outside.probability) < MORE_PROBABLE_THAN_NOT
        })
        && (gap.rms_ci95[0] <= gap.noise_floor_rms_percent || makes_worse)
}

/// Noise variance over what the sensors announce, of the best model.
pub(crate) fn noise_scale(analysis: &Analysis, best: &ScoredHypothesis, rows: f64) -> f64 {
    let at = &analysis.backgrounds[best.background.min(analysis.backgrounds.len() - 1)];
    let explained: f64 = best
        .hypothesis
        .columns
        .iter()
        .zip(&best.sizes)
        .map(|(&column, size)| at.product(column) * size)
        .sum();
    let square = (at.square - explained).max(0.0);
    (NOISE_FREEDOM + square) / (NOISE_FREEDOM + rows)
}

pub(crate) fn gap_of(
    system: &WhitenedSystem<'_>,
    analysis: &Analysis,
    own: &Shrinkage,
    scale: f64,
) -> Gap {
    let count = system.data.segments.len() as f64;
    let mean = system.data.segments.iter().map(|row| row.residual[0]).sum::<f64>() / count;
    let square = own.before();
    // Interval of the mean square by flight, then its root.
    let flights = own.before.len() as f64;
    let spread: f64 =
        own.before.iter().zip(&own.weights).map(|(sum, n)| (sum - square * n).powi(2)).sum::<f64>()
            * flights
            / (flights - 1.0).max(1.0);
    let half = NORMAL_95 * spread.sqrt() / own.weight();
    // The largest deviation any effect makes of noise alone, with as many looks as columns (Bonferroni).
    let plain = analysis
        .backgrounds
        .iter()
        .find(|b| b.small_effects_scale == 0.0 && b.smooth_amplitude == 0.0);
    let p_value = plain.map_or(1.0, |at| {
        let columns = analysis.scorer.columns();
        let largest = (0..columns)
            .filter(|&column| at.gram(column, column) > 0.0)
            .map(|column| at.product(column).powi(2) / at.gram(column, column))
            .fold(0.0, f64::max);
        (columns as f64 * erfc((largest / scale / 2.0).sqrt())).min(1.0)
    });
    Gap {
        mean_percent: 100.0 * mean,
        rms_percent: 100.0 * square.sqrt(),
        rms_ci95: [100.0 * (square - half).max(0.0).sqrt(), 100.0 * (square + half).sqrt()],
        noise_floor_rms_percent: 100.0 * own.floor().sqrt(),
        floor_by_replicates_rms_percent: None,
        floor_by_held_out_fit_rms_percent: None,
        detected: false,
        p_value,
    }
}
