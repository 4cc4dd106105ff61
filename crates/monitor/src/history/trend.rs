//! The trend over all that may have stepped: events of which flights do not say whether they were steps, and what nobody recorded.

use super::{Asked, SteppedEvents, merged};
use crate::levels::{Estimate, Levels};
use crate::settings::LEAST_SHARE_WITH_A_STEP;

/// The trend over every set S of events that may be steps, alone, and with one step more that nobody recorded, before any flight: what it
/// would be counts as much as it is probable. With a step more, and where nothing was done to burn less, the tail may also be one that
/// hardly ages.
///
/// ```text
/// t = Σ p·t_p,  variance Σ p·(v_p + (t_p − t)²)                                                            [monitoring.24]
/// with a step N(0, σ²) before flight k: p_S·½·p_k/(1 − p_k)·p(d | S, o, step)/p(d | S),  each of two σ      [monitoring.25]
/// ```
///
/// with `p_k` of [`crate::ChangeBeliefs::change_within`] and σ of [`crate::ChangeBeliefs::unrecorded_step_deviations_percent`]. `found` are first flights
/// after changes, `recorded` those after events.
///
/// # Source
/// Madigan and Raftery 1994, doi 10.1080/01621459.1994.10476894: averaging over the models that are not far less probable.
pub(super) fn averaged(
    stepped: &SteppedEvents,
    asked: &Asked<'_>,
    (found, recorded): (&[usize], &[usize]),
) -> Option<Estimate> {
    let Asked { ref beliefs, middle_percent, .. } = *asked;
    let steady = beliefs.of_a_steady_tail();
    let most = stepped.weighed.iter().map(|(_, ln)| *ln).fold(f64::NEG_INFINITY, f64::max);
    let mut trends = Mixture::default();
    for (set, ln) in &stepped.weighed {
        let boundaries = merged(found, set);
        let ageing = asked.levels(&boundaries, beliefs)?;
        let ln = ln - most;
        trends.add(ln, ageing.trend_percent_per_year());
        if ln < LEAST_SHARE_WITH_A_STEP.ln() {
            continue;
        }
        add_unrecorded(&mut trends, ln, &ageing, (asked, recorded));
        // What is washed ages.
        if asked.done.is_empty() {
            let hardly = asked.levels(&boundaries, &steady)?;
            let ln_odds = hardly.ln_evidence(middle_percent, &steady)
                - ageing.ln_evidence(middle_percent, beliefs);
            add_unrecorded(&mut trends, ln + ln_odds, &hardly, (asked, recorded));
        }
    }
    Some(trends.mean())
}

/// Adds the trends beside one step more before each flight to one whose probability has this logarithm.
fn add_unrecorded(
    trends: &mut Mixture,
    ln: f64,
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
        let ln_before = p.ln() - (-p).ln_1p() - (sizes.len() as f64).ln();
        for size in sizes {
            trends.add(ln + ln_before + step.ln_odds(size), step.trend(levels, size));
        }
    }
}

/// Estimates, each with the logarithm of its probability but for a common term: of a step that stands out it is beyond what a number holds.
#[derive(Debug, Default)]
struct Mixture {
    parts: Vec<(f64, Estimate)>,
}

impl Mixture {
    fn add(&mut self, ln: f64, estimate: Estimate) {
        self.parts.push((ln, estimate));
    }

    /// Mean and standard deviation.
    fn mean(&self) -> Estimate {
        let most = self.parts.iter().map(|(ln, _)| *ln).fold(f64::NEG_INFINITY, f64::max);
        let sum = |of: &dyn Fn(&Estimate) -> f64| -> f64 {
            self.parts.iter().map(|(ln, part)| (ln - most).exp() * of(part)).sum()
        };
        let total = sum(&|_| 1.0);
        let value = sum(&|part| part.value) / total;
        let variance = sum(&|part| part.deviation.powi(2) + (part.value - value).powi(2)) / total;
        Estimate { value, deviation: variance.sqrt() }
    }
}
