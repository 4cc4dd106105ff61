//! Two other estimates of the noise floor, which need no sensor's standard deviation.

use effects::EffectPoint;

use crate::judge::closure::Shrinkage;
use crate::library::Library;
use crate::priors::SMOOTH_AMPLITUDES;
use crate::search::folds::fold_of;
use crate::search::system::WhitenedSystem;
use crate::thresholds::{
    CLOSURE_FOLDS, FEWEST_REPLICATES, FLEXIBLE_EFFECT, FLEXIBLE_SMOOTH, REPLICATE_ALTITUDE_M,
    REPLICATE_MACH,
};

/// Mean square of the noise, the part within a flight by replicates, the part between flights as propagated; `None` for too
/// few replicates.
///
/// ```text
/// σ² = ½·mean (e_i − e_(i+1))² + mean Σ_r u_r,i u_r,(i+1),   e what the best model leaves            [diagnosis.30]
/// ```
///
/// Both means are over neighbouring segments at one Mach number and level, so that of what wanders within a flight each has its
/// part.
pub(crate) fn replicate_floor(
    system: &WhitenedSystem<'_>,
    own: &Shrinkage,
    noise_scale: f64,
) -> Option<f64> {
    let data = system.data;
    let (mut sum, mut common, mut pairs) = (0.0, 0.0, 0_usize);
    for flight in &data.flights {
        for index in flight.segments.clone().skip(1) {
            let (a, b) = (&data.segments[index - 1], &data.segments[index]);
            if are_replicates(&a.point, &b.point) {
                sum += (own.left[index] - own.left[index - 1]).powi(2);
                let loadings = a.noise.common.iter().zip(&b.noise.common);
                common += loadings.map(|(a, b)| a[0] * b[0]).sum::<f64>();
                pairs += 1;
            }
        }
    }
    if pairs < FEWEST_REPLICATES {
        return None;
    }
    Some((0.5 * sum + noise_scale * common) / pairs as f64)
}

/// Whether two neighbouring segments are flown alike.
pub(crate) fn are_replicates(a: &EffectPoint, b: &EffectPoint) -> bool {
    (a.mach - b.mach).abs() <= REPLICATE_MACH
        && (a.pressure_altitude_m - b.pressure_altitude_m).abs() <= REPLICATE_ALTITUDE_M
}

/// Mean square that a flexible model (all effects, smooth functions of all variables) leaves on folds of flights that it was
/// not fitted to: an upper bound of the noise, by as much as it cannot learn. `None` where it cannot be fitted.
pub(crate) fn held_out_floor(system: &WhitenedSystem<'_>, library: &Library) -> Option<f64> {
    let design = system.design;
    let (columns, deviations): (Vec<usize>, Vec<f64>) = library
        .effects
        .iter()
        .map(|effect| (effect.representative, FLEXIBLE_EFFECT * effect.typical))
        .chain(design.nuisance.clone().map(|column| (column, 1.0)))
        .chain(design.smooth.clone().map(|column| (column, FLEXIBLE_SMOOTH)))
        .unzip();
    let fitted = held_out(system, &columns, &deviations)?;
    let rows = system.data.segments.iter().zip(&fitted);
    let sum: f64 = rows.map(|(row, fitted)| (row.residual[0] - fitted).powi(2)).sum();
    Some(sum / fitted.len() as f64)
}

/// What smooth functions of all variables, as small as the least smooth discrepancy, say of each segment's ln fuel flow where
/// they were not fitted to the segment's fold of flights. `None` where they cannot be fitted.
pub(crate) fn held_out_smooth(system: &WhitenedSystem<'_>) -> Option<Vec<f64>> {
    let design = system.design;
    let (columns, deviations): (Vec<usize>, Vec<f64>) = design
        .nuisance
        .clone()
        .map(|column| (column, 1.0))
        .chain(design.smooth.clone().map(|column| (column, SMOOTH_AMPLITUDES[1])))
        .unzip();
    held_out(system, &columns, &deviations)
}

/// A fit of these columns with these prior standard deviations: what it says of each segment, fitted without its fold.
fn held_out(
    system: &WhitenedSystem<'_>,
    columns: &[usize],
    deviations: &[f64],
) -> Option<Vec<f64>> {
    let design = system.design;
    let mut all = vec![0.0; system.data.segments.len()];
    for fold in 0..CLOSURE_FOLDS {
        let gram = system.gram(Some(fold));
        let sizes = gram.fit(columns, deviations, design.residual())?;
        for (index, flight) in system.data.flights.iter().enumerate() {
            if fold_of(index) != fold {
                continue;
            }
            let rows = design.fuel_flow(system.data, flight);
            for (row, segment) in flight.segments.clone().enumerate() {
                all[segment] = columns
                    .iter()
                    .enumerate()
                    .map(|(k, &column)| rows[(row, column)] * sizes[(k, 0)])
                    .sum();
            }
        }
    }
    Some(all)
}
