//! What the planted effect truly does to each segment, noise apart: the same flights are flown again without it.
//!
//! Only the scorer asks. Noise, weather and loading of both flights are the same draws, so that the difference of their gaps
//! is the effect, in the truth's own form, with whatever it does to the recording.

use std::collections::BTreeMap;

use crate::places::{names_driver, spread, worst_region_overlap};
use crate::scored_case::Located;
use diagnose::{Diagnosis, Region, Slice, region_members};
use effects::{EffectModel, EffectPoint, Effects};
use flight::Segment;
use flight::effect::EffectId;

use crate::diagnosis_inputs::DiagnosisInputs;
use crate::draw::DrawnCase;
use crate::failure::CaseFailure;
use crate::flown_case::fly;
use crate::plan::Kind;
use crate::seal::CaseTruth;

/// Largest p-value of a place that is reported: that of the diagnosis, the usual 5 %.
const SIGNIFICANT: f64 = 0.05;

/// Flight and first row, which identify a segment in both sets of flights.
type Key = (String, u32);

/// Gap that the planted effect makes, ln of fuel flow, of every segment that both flights have.
#[derive(Debug)]
pub(crate) struct PlantedGap(BTreeMap<Key, f64>);

impl PlantedGap {
    /// Flies the twin and takes the difference; empty where nothing was planted.
    pub(crate) fn measure(
        drawn: &DrawnCase,
        inputs: &DiagnosisInputs,
        truth: &CaseTruth,
    ) -> Result<Self, CaseFailure> {
        if truth.effects.is_empty() {
            return Ok(Self(BTreeMap::new()));
        }
        let range = drawn.clean_flights()..drawn.twin().len();
        let twin = inputs.against(fly(drawn.twin(), range)?);
        let none = Effects::none();
        let mut without = gaps(&twin, &none)?;
        let with = gaps(inputs, &none)?;
        let difference = with
            .into_iter()
            .filter_map(|(key, gap)| Some((key.clone(), gap - without.remove(&key)?)));
        Ok(Self(difference.collect()))
    }

    /// Share of its mean square that the named effects remove; `None` where none is named.
    pub(crate) fn closure(&self, inputs: &DiagnosisInputs, found: &Diagnosis) -> Option<f64> {
        let effects = found.effects();
        if self.0.is_empty() || effects.is_empty() {
            return None;
        }
        let before = gaps(inputs, &Effects::none()).ok()?;
        let after = gaps(inputs, &effects).ok()?;
        let (mut whole, mut left) = (0.0, 0.0);
        for (key, planted) in &self.0 {
            let removed = before.get(key)? - after.get(key)?;
            whole += planted * planted;
            left += (planted - removed) * (planted - removed);
        }
        (whole > 0.0).then(|| 1.0 - left / whole)
    }

    /// The region reported for the gap against the true one.
    pub(crate) fn located(
        &self,
        inputs: &DiagnosisInputs,
        found: &Diagnosis,
        truth: &CaseTruth,
    ) -> Result<Option<Located>, CaseFailure> {
        let place = found.r#where.iter().find(|slice| is_place(slice));
        if truth.kind == Kind::Null {
            return Ok(Some(Located {
                spread_percent: 0.0,
                significant: place.is_some(),
                driver_named: false,
                overlap: 0.0,
            }));
        }
        let Some(id) = truth.effects.first().and_then(|e| EffectId::from_name(&e.id.to_string()))
        else {
            return Ok(None);
        };
        if truth.kind != Kind::Single {
            return Ok(None);
        }
        let effect: Vec<f64> = self.0.values().copied().collect();
        let overlap = match place {
            Some(slice) => self.overlap(inputs, &slice.region)?,
            None => None,
        };
        Ok(Some(Located {
            spread_percent: 100.0 * spread(&effect),
            significant: place.is_some(),
            driver_named: place.is_some_and(|slice| names_driver(id, &slice.region)),
            overlap: overlap.unwrap_or(0.0),
        }))
    }

    fn overlap(
        &self,
        inputs: &DiagnosisInputs,
        region: &Region,
    ) -> Result<Option<f64>, CaseFailure> {
        let records = inputs.records();
        let members = region_members(&inputs.input(&records), region)?;
        let mut effect = Vec::new();
        let mut inside = Vec::new();
        for (record, members) in records.iter().zip(&members) {
            for (segment, member) in record.segments.iter().zip(members) {
                // A segment that only one of the two flights has, has no truth.
                if let Some(planted) = self.0.get(&key(segment)) {
                    effect.push(*planted);
                    inside.push(*member);
                }
            }
        }
        Ok(worst_region_overlap(&effect, &inside))
    }
}

/// A region that is not by chance. "Everywhere" does not count.
fn is_place(slice: &Slice) -> bool {
    !slice.region.is_everywhere() && slice.p_value <= SIGNIFICANT
}

/// ln recorded − ln predicted fuel flow of every segment that the model can predict with these effects.
fn gaps(inputs: &DiagnosisInputs, effects: &Effects) -> Result<BTreeMap<Key, f64>, CaseFailure> {
    let records = inputs.records();
    let input = inputs.input(&records);
    let model = EffectModel::new(input.model, input.drag_table, input.effect_references()?)?;
    let engines = model.aircraft().engines();
    let gap = |segment: &Segment| {
        let start_s = segment.identity.start_s();
        let point = EffectPoint::from_means(&segment.means, start_s, engines);
        let predicted = model.response(&point, effects).ok()?.ln_fuel_flow_total;
        Some((key(segment), segment.means.fuel_flow_total_kg_s.ln() - predicted))
    };
    Ok(records.iter().flat_map(|record| record.segments).filter_map(gap).collect())
}

fn key(segment: &Segment) -> Key {
    (segment.identity.flight.clone(), segment.rows.first().copied().unwrap_or_default())
}
