//! The trend over all that may have stepped: events of which flights do not say whether they were steps, and what nobody recorded.

use super::{Asked, SteppedEvents, merged};
use crate::levels::{Estimate, Levels};
use crate::settings::ChangeBeliefs;

/// Sets of events that are less probable than this share of the most probable one are averaged without a step beside them: with one they
/// count next to nothing.
const LEAST_SHARE: f64 = 0.01;

/// The trend over every set S of events that may be steps, of a tail that ages as fast as is typical and of one that hardly does, each
/// alone and with one step more that nobody recorded, before any flight: what it would be counts as much as it is probable.
///
/// ```text
/// t = Σ p·t_S,o,  variance Σ p·(v_S,o + (t_S,o − t)²),  p ∝ p_S·p(d | S, o),  o of 1.5 and 0.3 % a year     [monitoring.24]
/// with a step N(0, σ²) before flight k: p·½·p_k/(1 − p_k)·p(d | step)/p(d | none),  each of two σ           [monitoring.25]
/// ```
///
/// with `p_k` of [`crate::ChangeBeliefs::change_within`] and σ of [`crate::ChangeBeliefs::unrecorded_step_deviations_percent`]. `found` are
/// first flights after changes, `recorded` those after events.
///
/// # Source
/// Madigan and Raftery 1994, doi 10.1080/01621459.1994.10476894: averaging over the models that are not far less probable.
pub(super) fn averaged(
    stepped: &SteppedEvents,
    asked: &Asked<'_>,
    (found, recorded): (&[usize], &[usize]),
) -> Option<Estimate> {
    let Asked { ref beliefs, middle_percent, .. } = *asked;
    let steady = ChangeBeliefs {
        slope_deviation_percent_per_year: beliefs.small_slope_deviation_percent_per_year,
        ..*beliefs
    };
    let most = stepped.weighed.iter().map(|(_, ln)| *ln).fold(f64::NEG_INFINITY, f64::max);
    let mut trends = Mixture::default();
    for (set, ln) in &stepped.weighed {
        let boundaries = merged(found, set);
        let ageing = asked.levels(&boundaries, beliefs)?;
        let hardly = asked.levels(&boundaries, &steady)?;
        let odds = (hardly.ln_evidence(middle_percent, &steady)
            - ageing.ln_evidence(middle_percent, beliefs))
        .exp();
        let share = (ln - most).exp();
        trends.add(share, ageing.trend_percent_per_year());
        // What is washed ages.
        let steady = asked.done.is_empty().then_some((share * odds, &hardly));
        for (share, levels) in core::iter::once((share, &ageing)).chain(steady) {
            if share >= LEAST_SHARE {
                add_unrecorded(&mut trends, share, levels, (asked, recorded));
            }
        }
    }
    Some(trends.mean())
}

/// Adds the trends beside one step more before each flight.
fn add_unrecorded(
    trends: &mut Mixture,
    share: f64,
    levels: &Levels,
    (asked, recorded): (&Asked<'_>, &[usize]),
) {
    let Asked { series, weights, ref beliefs, .. } = *asked;
    let years = |flight: usize| series.years(series.flights()[flight].time());
    let sizes = beliefs.unrecorded_step_deviations_percent;
    for step in levels.steps_beside(series, weights) {
        // What an event did is asked by the sets.
        if recorded.binary_search(&step.first_flight).is_ok() {
            continue;
        }
        let p = beliefs.change_within(years(step.first_flight) - years(step.first_flight - 1));
        let odds = p / (1.0 - p) / sizes.len() as f64;
        for size in sizes {
            trends.add(share * odds * step.ln_odds(size).exp(), step.trend(levels, size));
        }
    }
}

/// Estimates, each as probable as its weight says but for a common factor.
#[derive(Debug, Default)]
struct Mixture {
    parts: Vec<(f64, Estimate)>,
}

impl Mixture {
    fn add(&mut self, weight: f64, estimate: Estimate) {
        self.parts.push((weight, estimate));
    }

    /// Mean and standard deviation.
    fn mean(&self) -> Estimate {
        let total: f64 = self.parts.iter().map(|(weight, _)| weight).sum();
        let sum = |of: &dyn Fn(&Estimate) -> f64| -> f64 {
            self.parts.iter().map(|(weight, part)| weight * of(part)).sum::<f64>() / total
        };
        let value = sum(&|part| part.value);
        let variance = sum(&|part| part.deviation.powi(2) + (part.value - value).powi(2));
        Estimate { value, deviation: variance.sqrt() }
    }
}
