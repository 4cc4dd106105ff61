//! The rules that fire on a tail: on all engines together, and changes on single ones too.

use flight::Timestamp;
use monitor::{Alert, AlertRule};
use units::convert::SECONDS_PER_DAY;

use super::{MonitorOptions, MonitoredTail};
use crate::monitoring::document::AlertDocument;
use crate::monitoring::told::told;

impl MonitoredTail<'_> {
    /// The rules that fire, in the order of the rules; of changes that are one event one fires.
    #[must_use]
    pub fn alerts(&self, options: &MonitorOptions) -> Vec<AlertDocument> {
        let changes = self.all_changes();
        let told = told(&changes, self.engines.of_each.len());
        let is_told = |alert: &AlertDocument| {
            told.iter().any(|change| change.engine == alert.engine && change.since == alert.since)
        };
        let documents = |rule: &AlertRule| -> Vec<AlertDocument> {
            let of_all = rule.apply(self.series(), &self.history).into_iter();
            let of_all = of_all.map(|alert| self.alert(None, &alert));
            if !matches!(rule, AlertRule::Change { .. }) {
                return of_all.collect();
            }
            of_all.chain(self.alerts_of_engines(rule)).filter(is_told).collect()
        };
        options.rules.iter().flat_map(documents).collect()
    }

    fn alerts_of_engines(&self, rule: &AlertRule) -> Vec<AlertDocument> {
        // Days count to the tail's last flight, which may lack the engines.
        let last = self.series().flights().last().map(monitor::FlightDeviation::time);
        let is_recent = |since: Timestamp| match (*rule, last) {
            (AlertRule::Change { days: Some(days), .. }, Some(last)) => {
                last.duration_since(since).as_secs_f64() <= days * SECONDS_PER_DAY
            }
            _ => true,
        };
        let mut documents = Vec::new();
        for (place, history) in self.engines.of_each.iter().enumerate() {
            let fired = rule.apply(&history.at_mean_conditions, history).into_iter();
            let recent = fired.filter(|alert| is_recent(alert.since));
            documents.extend(recent.map(|alert| self.alert(Some(place + 1), &alert)));
        }
        documents
    }

    fn alert(&self, engine: Option<usize>, alert: &Alert) -> AlertDocument {
        AlertDocument {
            tail: self.tail.to_owned(),
            engine,
            rule: alert.rule.to_string(),
            size: alert.size.into(),
            unit: match alert.rule {
                AlertRule::Trend { .. } => "%/year",
                AlertRule::Deviation { .. } | AlertRule::Change { .. } => "%",
            }
            .to_owned(),
            since: alert.since.to_string(),
            step_in_gap: match alert.rule {
                AlertRule::Trend { .. } => self.step_in_gap(),
                AlertRule::Deviation { .. } | AlertRule::Change { .. } => None,
            },
            likely_causes: Vec::new(),
            likely_causes_in_words: Vec::new(),
            no_likely_cause: None,
        }
    }
}
