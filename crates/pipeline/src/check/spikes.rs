//! Fuel flows of single samples that are far from those just before and behind. No trim criterion looks at fuel flow, so that they
//! go into the means of segments as any other does.

use flight::{FuelFlowColumns, Report, Severity};

use super::Draft;

/// Samples beside each other of which the median is what a sample is held against.
const WINDOW: usize = 11;
/// Share of that median from which a sample is a spike. Our choice: an engine that is throttled up or down stays there for more
/// than half of a window.
const SPIKE_SHARE: f64 = 0.3;
/// The window is a matter of seconds: slower recordings are not looked at, s.
const SLOWEST_STEP_S: f64 = 5.0;
/// Shares of the mean fuel flow that spikes add or take away from which they are told, and are serious. Our choice: the first is a
/// third of what a diagnosis can tell from nothing on one flight, the second is an effect of usual size.
const WORTH_TELLING: f64 = 0.001;
const SERIOUS: f64 = 0.01;

pub(super) fn check(report: &Report) -> Vec<Draft> {
    let columns = report.columns();
    let steps = columns.time_s.len().saturating_sub(1);
    let is_fast = steps >= WINDOW
        && columns.time_s[steps] - columns.time_s[0] <= SLOWEST_STEP_S * steps as f64;
    if !is_fast {
        return Vec::new();
    }
    match &columns.fuel_flow {
        FuelFlowColumns::Total(total) => spiked("WF", total).into_iter().collect(),
        FuelFlowColumns::PerEngine(engines) => engines
            .iter()
            .enumerate()
            .filter_map(|(engine, values)| spiked(&format!("WF({})", engine + 1), values))
            .collect(),
    }
}

fn spiked(name: &str, values: &[f64]) -> Option<Draft> {
    let Spikes { samples, sum } = spikes(values);
    let share = sum / (values.iter().sum::<f64>() - sum);
    if share.is_nan() || share.abs() < WORTH_TELLING {
        return None;
    }
    Some(Draft {
        severity: if share.abs() < SERIOUS { Severity::Warning } else { Severity::Serious },
        code: "channel-spiked",
        size: 100.0 * share,
        unit: "%",
        message: format!(
            "{samples} of {} samples of {name} are more than {:.0} % off those beside them and move its mean by {:+.1} %",
            values.len(),
            100.0 * SPIKE_SHARE,
            100.0 * share
        ),
        likely_cause: "words of the data bus that were lost or doubled".to_owned(),
        remedy: format!("leave these samples of {name} out of the recording"),
    })
}

struct Spikes {
    samples: usize,
    /// Of what they exceed their medians by.
    sum: f64,
}

fn spikes(values: &[f64]) -> Spikes {
    let mut spikes = Spikes { samples: 0, sum: 0.0 };
    for (place, &value) in values.iter().enumerate() {
        let first = place.saturating_sub(WINDOW / 2).min(values.len().saturating_sub(WINDOW));
        let Some(beside) = values.get(first..first + WINDOW) else { break };
        // A spike differs from at least half of those beside it: most samples differ from none.
        let differs = |other: &f64| (value - other).abs() > SPIKE_SHARE * other.abs();
        if beside.iter().filter(|other| differs(other)).count() <= WINDOW / 2 {
            continue;
        }
        let mut sorted = [0.0; WINDOW];
        sorted.copy_from_slice(beside);
        sorted.sort_by(f64::total_cmp);
        let median = sorted[WINDOW / 2];
        if differs(&median) {
            spikes.samples += 1;
            spikes.sum += value - median;
        }
    }
    spikes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two hours at about a second, throttle steps and a slow wave among them.
    fn cruise() -> Vec<f64> {
        let level = |second: usize| if (second / 900).is_multiple_of(2) { 0.32 } else { 0.46 };
        (0..7200).map(|second| level(second) + 0.01 * (second as f64 / 37.0).sin()).collect()
    }

    #[test]
    fn throttle_steps_are_no_spikes() {
        assert!(spiked("WF", &cruise()).is_none());
        assert_eq!(spikes(&cruise()[..WINDOW - 1]).samples, 0);
    }

    /// By hand: thirty samples ten times as large, and as many of zero.
    #[test]
    fn planted_spikes_are_counted_with_what_they_do_to_the_mean() {
        let clean = cruise();
        let total: f64 = clean.iter().sum();
        for (factor, severity) in [(10.0, Severity::Serious), (0.0, Severity::Warning)] {
            let mut spoilt = clean.clone();
            for sample in (100..6700).step_by(220) {
                spoilt[sample] *= factor;
            }
            let moved = 100.0 * (spoilt.iter().sum::<f64>() / total - 1.0);
            let draft = spiked("WF(1)", &spoilt).unwrap();
            assert_eq!((draft.code, draft.severity), ("channel-spiked", severity));
            assert!((draft.size - moved).abs() < 0.01, "{} {moved}", draft.size);
            assert!(draft.message.starts_with("30 of 7200 samples of WF(1)"), "{}", draft.message);
        }
    }
}
