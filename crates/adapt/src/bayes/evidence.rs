//! Settings from past flights: marginal likelihood, and a search for its maximum.

use std::f64::consts::TAU;

use flight::Observation;
use lut::Table;

use super::information::Information;
use super::outlier_weights::FlightWeights;
use super::posterior::precision;
use super::settings::SettingValues;
use super::{BayesSettings, BayesState, InitialError, SolveError};

/// How far and how fine [`tune`] searches; it refuses one that has no end or no prior ([`TuneError::Search`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// No setting is changed by more than this factor, up or down; 1 or above.
    pub largest_factor: f64,
    /// The search ends when a factor this small improves nothing. Above 1, which factors come ever nearer to.
    pub smallest_factor: f64,
    /// The search ends after this many evaluations.
    pub maximum_evaluations: usize,
    /// How far a setting may be from its start: a factor of this size is one standard deviation of a log-normal prior.
    /// Some tens of flights carry little information about some settings; without the prior those would wander. Above 1.
    pub prior_factor: f64,
    /// Whether the correction's size, slopes and bends are searched too, or only the noise.
    ///
    /// One aircraft is one draw of a level, two slopes and three bends, however many its flights: it carries little
    /// information about how large they usually are. On three simulated fleets, ten flights made slopes 2 to 3 times as
    /// large for a gain of 6 to 10 in ln evidence, and the standard deviation over unseen flights 0.88 to 0.95 %
    /// instead of 0.80 to 0.83 %.
    pub with_correction: bool,
}

/// The settings found.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuned {
    /// The settings of the largest evidence times prior.
    pub settings: BayesSettings,
    /// Natural logarithm of their evidence, without the search's prior.
    pub log_evidence: f64,
    /// The steps of the search; the first is the start.
    pub path: Vec<TuneStep>,
    /// Evaluations of the evidence.
    pub evaluations: usize,
    /// Settings that ended at the limit of the search: the flights carry little information about them, or the limit is
    /// too narrow.
    pub at_limit: Vec<&'static str>,
}

/// An improvement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TuneStep {
    /// What was changed; "outlier weights" where outlier weights were computed again, after which evidences cannot be
    /// compared with those before.
    pub changed: &'static str,
    /// The settings after it.
    pub settings: BayesSettings,
    /// Natural logarithm of the evidence.
    pub log_evidence: f64,
}

/// Why nothing can be tuned.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TuneError {
    /// The initial table cannot be corrected by a relative amount.
    #[error(transparent)]
    Initial(#[from] InitialError),
    /// Prior plus information is not a positive definite precision matrix.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// A number of the search is outside its limits.
    #[error("{quantity} of the search is {value}, expected {limits}")]
    Search {
        /// Which.
        quantity: &'static str,
        /// The value given.
        value: f64,
        /// What it has to be.
        limits: &'static str,
    },
}

/// The number of changes that concern the correction; they come first.
const CORRECTION: usize = 3;
/// The settings that the search changes together: the flights cannot distinguish two slopes or three bends.
type Change = fn(&mut SettingValues, f64);
const CHANGES: [(&str, Change); CORRECTION + 4] = [
    ("correction_std", |values, factor| values.correction_std *= factor),
    ("slopes", |values, factor| {
        values.slope_std_per_lift_coefficient *= factor;
        values.slope_std_per_mach *= factor;
    }),
    ("bends", |values, factor| {
        values.bend_std_per_lift_coefficient_squared *= factor;
        values.bend_std_per_lift_coefficient_mach *= factor;
        values.bend_std_per_mach_squared *= factor;
    }),
    ("extra_flight_std", |values, factor| values.extra_flight_std *= factor),
    ("extra_segment_std", |values, factor| values.extra_segment_std *= factor),
    ("sensor_flight_factor", |values, factor| values.sensor_flight_factor *= factor),
    ("sensor_segment_factor", |values, factor| values.sensor_segment_factor *= factor),
];

/// Outlier weights depend on the settings: how often they are computed again with the settings found.
const ROUNDS: usize = 2;

impl Search {
    /// Factors of 2 down to 2^¼, up to 8 in all, at most 400 evaluations, each setting known to a factor of 2; only
    /// noise.
    #[must_use]
    pub const fn standard() -> Self {
        Self {
            largest_factor: 8.0,
            smallest_factor: 1.19,
            maximum_evaluations: 400,
            prior_factor: 2.0,
            with_correction: false,
        }
    }

    /// Refuses factors with which the search would not end, or whose prior is no density.
    fn check(&self) -> Result<(), TuneError> {
        let (largest, smallest, prior) =
            (self.largest_factor, self.smallest_factor, self.prior_factor);
        let refused = |quantity, value, limits| Err(TuneError::Search { quantity, value, limits });
        if largest.is_nan() || largest < 1.0 {
            return refused("largest factor", largest, "1 or above");
        }
        if !smallest.is_finite() || smallest <= 1.0 {
            return refused("smallest factor", smallest, "a number above 1");
        }
        if prior.is_nan() || prior <= 1.0 {
            return refused("prior factor", prior, "above 1");
        }
        Ok(())
    }

    /// Natural logarithm of the prior density of such factors, 0 at the start.
    fn log_prior(&self, factors: &[f64]) -> f64 {
        let deviations = factors.iter().map(|factor| factor.ln() / self.prior_factor.ln());
        -0.5 * deviations.map(|deviation| deviation * deviation).sum::<f64>()
    }
}

/// Natural logarithm of the marginal likelihood of flights in the order learnt, with the outlier weights of these
/// settings. Constants are included, so that settings can be compared; knowledge does not age in it.
///
/// # Errors
/// [`TuneError`] where the initial table cannot be corrected.
///
/// # Source
/// Book `[bayes.10]`.
pub fn log_evidence(
    initial: &Table,
    settings: BayesSettings,
    flights: &[Vec<Observation>],
) -> Result<f64, TuneError> {
    let weights = outlier_weights_of(initial, settings, flights)?;
    evidence(initial, settings, flights, &weights)
}

/// Searches for the settings of the largest evidence times [`Search::prior_factor`]'s prior, one setting after the
/// other, by factors: deterministic, and never far from the start.
///
/// It changes the noise of flights and of segments: the extra one, and a factor on what the sensors propagate, which
/// handbook values state too large for a quiet fleet; with [`Search::with_correction`] also the correction's size, its
/// slopes and its bends (each by one factor). Degrees of freedom and half-life stay: outliers are too few, and ageing
/// is not part of this likelihood ([`search_half_life`](super::search_half_life)). With fewer than some tens of flights
/// expect little more than noise.
///
/// Outlier weights shrink the residuals slightly: where the noise of the start is right and normal, the standard
/// deviations found are 8 % too small.
///
/// # Errors
/// [`TuneError`] where the initial table cannot be corrected, or the search has no end or no prior.
pub fn tune(
    initial: &Table,
    start: BayesSettings,
    flights: &[Vec<Observation>],
    search: &Search,
) -> Result<Tuned, TuneError> {
    search.check()?;
    let mut weights = outlier_weights_of(initial, start, flights)?;
    let mut best = (start, evidence(initial, start, flights, &weights)?);
    let mut factors = [1.0; CHANGES.len()];
    let mut evaluations = 1;
    let mut path = vec![TuneStep { changed: "start", settings: start, log_evidence: best.1 }];
    for round in 0..ROUNDS {
        if round > 0 {
            weights = outlier_weights_of(initial, best.0, flights)?;
            best.1 = evidence(initial, best.0, flights, &weights)?;
            evaluations += 1;
            path.push(TuneStep {
                changed: "outlier weights",
                settings: best.0,
                log_evidence: best.1,
            });
        }
        let mut step = 2.0_f64;
        while step >= search.smallest_factor && evaluations < search.maximum_evaluations {
            let mut improved = false;
            let searched = if search.with_correction { 0 } else { CORRECTION };
            for (k, &(changed, _)) in CHANGES.iter().enumerate().skip(searched) {
                for factor in [step, 1.0 / step] {
                    let mut candidate = factors;
                    candidate[k] *= factor;
                    let within = candidate[k].max(1.0 / candidate[k]) <= search.largest_factor;
                    if !within || evaluations >= search.maximum_evaluations {
                        continue;
                    }
                    let Some(settings) = changed_by(&start, &candidate) else { continue };
                    evaluations += 1;
                    let log_evidence = evidence(initial, settings, flights, &weights)?;
                    let gain = log_evidence - best.1 + search.log_prior(&candidate)
                        - search.log_prior(&factors);
                    if gain > 0.0 {
                        best = (settings, log_evidence);
                        factors = candidate;
                        improved = true;
                        path.push(TuneStep { changed, settings, log_evidence });
                        break;
                    }
                }
            }
            if !improved {
                step = step.sqrt();
            }
        }
    }
    // One more smallest step would exceed the limit.
    let limit = search.largest_factor / search.smallest_factor;
    let at_limit = CHANGES
        .iter()
        .zip(&factors)
        .filter(|(_, factor)| factor.max(1.0 / **factor) > limit)
        .map(|((name, _), _)| *name)
        .collect();
    Ok(Tuned { settings: best.0, log_evidence: best.1, path, evaluations, at_limit })
}

/// The start with every change applied; `None` where a setting exceeds its limits.
fn changed_by(start: &BayesSettings, factors: &[f64; CHANGES.len()]) -> Option<BayesSettings> {
    let mut values = *start.values();
    for ((_, change), factor) in CHANGES.iter().zip(factors) {
        change(&mut values, *factor);
    }
    BayesSettings::new(values).ok()
}

/// Settings without ageing, because the likelihood has none.
fn ageless(settings: BayesSettings) -> BayesSettings {
    let values = SettingValues { half_life_days: None, ..*settings.values() };
    BayesSettings::new(values).unwrap_or(settings)
}

/// Outlier weights of all flights, learnt one after the other.
fn outlier_weights_of(
    initial: &Table,
    settings: BayesSettings,
    flights: &[Vec<Observation>],
) -> Result<Vec<FlightWeights>, TuneError> {
    let mut state = BayesState::new(initial, ageless(settings))?;
    let weights = flights.iter().map(|observations| {
        let flight = state.read(observations);
        let flight_weights = state.expected_residual.weigh(
            &state.weight_settings,
            &flight.residuals,
            flight.common_variance,
        );
        state.learn_weighted(&flight, &flight_weights);
        flight_weights
    });
    Ok(weights.collect())
}

/// Natural logarithm of the evidence with given weights:
///
/// ```text
/// −½ [Σ_flights (ln|V| + yᵀ·V⁻¹·y) + ln|Q + Λ| − ln|Q| − ηᵀ·(Q + Λ)⁻¹·η + n·ln 2π]
/// ```
fn evidence(
    initial: &Table,
    settings: BayesSettings,
    flights: &[Vec<Observation>],
    weights: &[FlightWeights],
) -> Result<f64, TuneError> {
    let mut state = BayesState::new(initial, ageless(settings))?;
    let mut sum = 0.0;
    for (observations, flight_weights) in flights.iter().zip(weights) {
        let flight = state.read(observations);
        let common = flight.common_variance / flight_weights.flight_weight;
        let (mut precisions, mut residuals) = (0.0, 0.0);
        for (case, weight) in flight.residuals.iter().zip(&flight_weights.weights) {
            let precision = weight / case.variance;
            precisions += precision;
            residuals += precision * case.residual;
            sum += precision * case.residual * case.residual - precision.ln() + TAU.ln();
        }
        if !flight.residuals.is_empty() {
            sum += (common * precisions).ln_1p();
            sum -= residuals * residuals / (1.0 / common + precisions);
        }
        state.learn_weighted(&flight, flight_weights);
    }
    let solve = |information: &Information| {
        let matrix = precision(state.support.grid(), &settings, information);
        matrix.factor().ok_or(SolveError::NotPositiveDefinite)
    };
    let prior = solve(&Information::new(state.support.grid().nodes()))?;
    let posterior = solve(&state.information)?;
    let vector = state.information.vector();
    let explained: f64 = vector.iter().zip(posterior.solve(&vector)).map(|(a, b)| a * b).sum();
    sum += posterior.log_determinant() - prior.log_determinant() - explained;
    Ok(-0.5 * sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By definition: slopes have one factor, bends have one, every other setting has its own, and the rest stays.
    #[test]
    fn every_factor_acts_on_its_settings() {
        let start = BayesSettings::physical_2026();
        let found = changed_by(&start, &[2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0]).unwrap();
        let before = *start.values();
        let expected = SettingValues {
            correction_std: 2.0 * before.correction_std,
            slope_std_per_lift_coefficient: 3.0 * before.slope_std_per_lift_coefficient,
            slope_std_per_mach: 3.0 * before.slope_std_per_mach,
            bend_std_per_lift_coefficient_squared: 5.0
                * before.bend_std_per_lift_coefficient_squared,
            bend_std_per_lift_coefficient_mach: 5.0 * before.bend_std_per_lift_coefficient_mach,
            bend_std_per_mach_squared: 5.0 * before.bend_std_per_mach_squared,
            extra_flight_std: 7.0 * before.extra_flight_std,
            extra_segment_std: 11.0 * before.extra_segment_std,
            sensor_flight_factor: 13.0 * before.sensor_flight_factor,
            sensor_segment_factor: 17.0 * before.sensor_segment_factor,
            ..before
        };
        assert_eq!(*found.values(), expected);
        let beyond_its_limit = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1e3];
        assert_eq!(changed_by(&start, &beyond_its_limit), None);
    }

    /// A factor of the prior's size is one standard deviation of a normal ln, up or down: by hand, ln density falls by ½ for
    /// each, and by 2 at two of them.
    #[test]
    fn the_prior_of_factors_is_log_normal() {
        for prior_factor in [2.0_f64, 1.5] {
            let search = Search { prior_factor, ..Search::standard() };
            let (up, down) = (prior_factor, 1.0 / prior_factor);
            for (factors, expected) in [
                ([1.0, 1.0, 1.0], 0.0),
                ([1.0, up, 1.0], -0.5),
                ([down, up, 1.0], -1.0),
                ([1.0, 1.0, up * up], -2.0),
            ] {
                let found = search.log_prior(&factors);
                assert!((found - expected).abs() < 1e-12, "{factors:?}: {found}");
            }
        }
    }
}
