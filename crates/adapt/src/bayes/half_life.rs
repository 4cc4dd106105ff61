//! How fast knowledge ages, estimated from past flights: each is predicted from those before it, with several
//! half-lives.

use flight::Observation;
use lut::Table;

use super::evidence::TuneError;
use super::settings::SettingValues;
use super::{BayesSettings, BayesState, Flight, days_between};

/// Half-lives that are tried, days, in addition to none: a month to 21 years, in factors of 2. Our choice.
const CANDIDATES_DAYS: [f64; 9] = [30.0, 60.0, 120.0, 240.0, 480.0, 960.0, 1920.0, 3840.0, 7680.0];
/// Half-lives longer than this many times the flights' span are equivalent to none. Our choice.
const LONGEST_OVER_SPAN: f64 = 4.0;
/// Gain in ln density that ageing must bring: "strong" evidence (Kass and Raftery 1995, section 3.2: 2 ln B > 6).
const NEEDED_GAIN: f64 = 3.0;

/// Which half-life predicts best.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfLife {
    /// The settings with the half-life found; none where ageing predicts no better.
    pub settings: BayesSettings,
    /// Every half-life tried, days, with the natural logarithm of the density of all flights, each predicted from those
    /// before; the first is none.
    pub tried: Vec<(Option<f64>, f64)>,
}

/// Searches for the half-life that predicts flights best from those before, in the order given; all other settings
/// stay.
///
/// It is kept only where it gains more than 3 in ln density over none: without ageing, a half-life discards knowledge.
/// Costs one solve per flight and half-life.
///
/// # Errors
/// [`TuneError`] where the initial table cannot be corrected.
///
/// # Source
/// Book `[bayes.12]`.
pub fn search_half_life(
    initial: &Table,
    settings: BayesSettings,
    flights: &[Vec<Observation>],
) -> Result<HalfLife, TuneError> {
    let times = || flights.iter().flatten().map(|observation| observation.time);
    let span_days = match (times().min(), times().max()) {
        (Some(first), Some(last)) => days_between(first, last),
        _ => 0.0,
    };
    let with = |half_life_days: Option<f64>| {
        BayesSettings::new(SettingValues { half_life_days, ..*settings.values() }).ok()
    };
    let short = CANDIDATES_DAYS.into_iter().filter(|days| *days <= LONGEST_OVER_SPAN * span_days);
    let mut tried = Vec::new();
    let mut best: Option<(BayesSettings, f64)> = None;
    for half_life_days in core::iter::once(None).chain(short.map(Some)) {
        let Some(settings) = with(half_life_days) else { continue };
        let log_density = log_predictive_density(initial, settings, flights)?;
        tried.push((half_life_days, log_density));
        // Compared with none, a half-life must gain enough; among half-lives the better one is taken.
        let needed = match &best {
            None => f64::NEG_INFINITY,
            Some((best, density)) if best.values().half_life_days.is_none() => {
                density + NEEDED_GAIN
            }
            Some((_, density)) => *density,
        };
        if log_density > needed {
            best = Some((settings, log_density));
        }
    }
    Ok(HalfLife { settings: best.map_or(settings, |(settings, _)| settings), tried })
}

/// Natural logarithm of the density of all flights, each predicted from those before it: Student's in as many
/// dimensions as the flight has segments, because outliers come.
///
/// ```text
/// Σ_flights ln Γ((ν+n)/2)/Γ(ν/2) − ½ n ln νπ − ½ ln|P| − ½ (ν + n) ln(1 + rᵀP⁻¹r/ν),
/// P = W S Wᵀ + D + s² 1 1ᵀ                                                               [bayes.12]
/// ```
///
/// S is the covariance of the nodes when the flight was flown, aged until then. The Γ functions and ln νπ do not depend
/// on the half-life and are left out.
///
/// # Errors
/// [`TuneError`] where the initial table cannot be corrected.
pub fn log_predictive_density(
    initial: &Table,
    settings: BayesSettings,
    flights: &[Vec<Observation>],
) -> Result<f64, TuneError> {
    let mut state = BayesState::new(initial, settings)?;
    let mut sum = 0.0;
    for observations in flights {
        let flight = state.read(observations);
        if let Some(time) = flight.newest {
            state.decay_to(time);
            sum += log_density(&state, &flight)?;
        }
        let _ = state.learn_flight(observations);
    }
    Ok(sum)
}

fn log_density(state: &BayesState, flight: &Flight) -> Result<f64, TuneError> {
    let posterior = state.solve()?;
    let correction = posterior.correction();
    let columns: Vec<Vec<(usize, f64)>> = flight
        .rows
        .iter()
        .map(|row| row.nodes.into_iter().zip(row.coefficients).collect())
        .collect();
    let mut covariance = posterior.covariances_of(&columns);
    for (k, (row, case)) in covariance.iter_mut().zip(&flight.residuals).enumerate() {
        for entry in row.iter_mut() {
            *entry += flight.common_variance;
        }
        row[k] += case.variance;
    }
    let residuals: Vec<f64> = columns
        .iter()
        .zip(&flight.residuals)
        .map(|(column, case)| {
            let expected: f64 = column.iter().map(|(node, by)| by * correction[*node]).sum();
            case.residual - expected
        })
        .collect();
    let (log_determinant, square) =
        whitened(covariance, residuals).ok_or(super::SolveError::NotPositiveDefinite)?;
    let degrees = state.settings.values().student_degrees_of_freedom;
    let count = flight.residuals.len() as f64;
    Ok(-0.5 * (log_determinant + (degrees + count) * (square / degrees).ln_1p()))
}

/// ln of the determinant and rᵀ·P⁻¹·r by Cholesky; `None` where P is not positive definite.
fn whitened(mut matrix: Vec<Vec<f64>>, mut residuals: Vec<f64>) -> Option<(f64, f64)> {
    let mut log_determinant = 0.0;
    let mut square = 0.0;
    for k in 0..residuals.len() {
        let (above, rest) = matrix.split_at_mut(k);
        let row = &mut rest[0];
        for j in 0..k {
            let inner: f64 = (0..j).map(|i| row[i] * above[j][i]).sum();
            row[j] = (row[j] - inner) / above[j][j];
        }
        let inner: f64 = row[..k].iter().map(|value| value * value).sum();
        let pivot = (row[k] - inner).sqrt();
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        row[k] = pivot;
        let known: f64 = row[..k].iter().zip(&residuals).map(|(a, b)| a * b).sum();
        residuals[k] = (residuals[k] - known) / pivot;
        log_determinant += 2.0 * pivot.ln();
        square += residuals[k] * residuals[k];
    }
    Some((log_determinant, square))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whitened_by_hand() {
        // [[4, 2], [2, 5]]: determinant 16; inverse [[5, −2], [−2, 4]]/16; (2, 3): (20 − 24 + 36)/16 = 2.
        let (log_determinant, square) =
            whitened(vec![vec![4.0, 2.0], vec![2.0, 5.0]], vec![2.0, 3.0]).unwrap();
        assert!((log_determinant - 16.0_f64.ln()).abs() < 1e-15 && (square - 2.0).abs() < 1e-15);
        assert!(whitened(vec![vec![1.0, 2.0], vec![2.0, 1.0]], vec![0.0; 2]).is_none());
    }
}
