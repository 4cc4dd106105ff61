//! What a diagnosis found, as the document has it.

use std::collections::BTreeMap;

use diagnose::{
    Beside, Cause, Closure, Contribution, Detectable, Diagnosis, FoundForm, Gap, HeldOutFlight,
    OutsideLibrary, Region, Separation, Slice, Verdict,
};
use flight::effect::{EffectId, HiddenParameter};

use super::{
    BesideRecord, CauseRecord, ContributionRecord, DetectableRecord, FormRecord, GapRecord,
    HeldOutRecord, MagnitudeRecord, NotTestableRecord, OutsideLibraryRecord, SeparationRecord,
    SliceRecord, TailDiagnosis, VerdictKind, VerdictRecord,
};
use crate::addition_record::AdditionRecord;
use crate::diagnosed_tail::DiagnosedTail;
use crate::diagnosis_words::{
    ENGINE_BOUNDS, acts_on_words, advice, bounds_name, form_name, form_parameters, form_words,
    instant_words, left_out_words, measurement_words, region_words, variable_words,
};
impl From<&FoundForm> for FormRecord {
    fn from(found: &FoundForm) -> Self {
        let (place, width, exponent, with) = form_parameters(found.form);
        Self {
            form: form_name(found.form).to_owned(),
            variable: bounds_name(found.variable).to_owned(),
            with: with.map(|(variable, _)| bounds_name(variable).to_owned()),
            with_scale: with.map(|(_, scale)| scale),
            acts_on: acts_on_words(found.acts_on).to_owned(),
            size: found.size,
            size_ci95: found.size_ci95,
            place,
            place_ci95: found.place_ci95,
            width,
            exponent,
            scale: found.scale,
            probability: found.probability,
            closure: found.closure.map(|closure| closure.share),
            closure_ci95: found.closure.map(|closure| closure.ci95),
            statement: form_words(found),
        }
    }
}

impl From<&DiagnosedTail> for TailDiagnosis {
    fn from(diagnosed: &DiagnosedTail) -> Self {
        let Diagnosis {
            flights,
            segments,
            gap,
            r#where: places,
            causes,
            contributions,
            not_testable,
            verdict,
            addition,
            detectable,
            outside,
            held_out,
            left_out,
            outliers: _,
            notes: _,
        } = &diagnosed.diagnosis;
        let left_out = left_out.iter().map(|(reason, count)| (left_out_words(*reason), *count));
        Self {
            tail: diagnosed.tail.clone(),
            compared: diagnosed.compared.clone(),
            flights: *flights,
            segments: *segments,
            gap: match verdict {
                Verdict::InsufficientData(_) => GapRecord::default(),
                _ => GapRecord::from(gap),
            },
            months: diagnosed.months.clone(),
            r#where: places.iter().map(SliceRecord::from).collect(),
            causes: causes.iter().map(CauseRecord::from).collect(),
            contributions: contributions.iter().map(ContributionRecord::from).collect(),
            not_testable: not_testable
                .iter()
                .map(|entry| NotTestableRecord {
                    effect: entry.effect.to_string(),
                    needs: entry.needs.iter().map(|needed| needed.name().to_owned()).collect(),
                })
                .collect(),
            verdict: VerdictRecord::from(&diagnosed.diagnosis),
            addition: addition.as_ref().map(AdditionRecord::from),
            detectable: detectable.iter().map(DetectableRecord::from).collect(),
            outside: OutsideLibraryRecord::from(outside),
            held_out: held_out.iter().map(HeldOutRecord::from).collect(),
            left_out: left_out.map(|(words, count)| (words.to_owned(), count)).collect(),
            notes: diagnosed.notes(),
        }
    }
}

impl From<&HeldOutFlight> for HeldOutRecord {
    fn from(flight: &HeldOutFlight) -> Self {
        Self {
            segments: flight.segments,
            before_rms_percent: flight.before_rms_percent,
            after_rms_percent: flight.after_rms_percent,
            noise_rms_percent: flight.noise_rms_percent,
        }
    }
}

impl From<&Gap> for GapRecord {
    fn from(gap: &Gap) -> Self {
        Self {
            mean_percent: Some(gap.mean_percent),
            rms_percent: Some(gap.rms_percent),
            rms_ci95: Some(gap.rms_ci95),
            noise_floor_rms_percent: Some(gap.noise_floor_rms_percent),
            floor_by_replicates_rms_percent: gap.floor_by_replicates_rms_percent,
            floor_by_held_out_fit_rms_percent: gap.floor_by_held_out_fit_rms_percent,
            detected: gap.detected,
            p_value: Some(gap.p_value),
        }
    }
}

impl From<&Slice> for SliceRecord {
    fn from(slice: &Slice) -> Self {
        Self {
            slice: region_words(&slice.region),
            bounds: bounds(&slice.region),
            segments: slice.segments,
            mean_gap_percent: slice.mean_gap_percent,
            ci95: slice.ci95,
            share_of_gap: slice.share_of_gap,
            p_value: slice.p_value,
        }
    }
}

fn bounds(region: &Region) -> BTreeMap<String, [Option<f64>; 2]> {
    let engine = region.engine.map(|engine| {
        (ENGINE_BOUNDS.to_owned(), [Some(f64::from(engine)), Some(f64::from(engine))])
    });
    let conditions = region.conditions.iter().map(|condition| {
        let ends = [condition.from, condition.to].map(|end| end.map(|edge| edge.value));
        (bounds_name(condition.variable).to_owned(), ends)
    });
    engine.into_iter().chain(conditions).collect()
}

impl MagnitudeRecord {
    /// The size of an effect.
    pub(crate) fn of(effect: EffectId, magnitude: diagnose::Magnitude) -> Self {
        Self { value: magnitude.value, unit: effect.entry().unit.to_owned(), ci95: magnitude.ci95 }
    }
}

impl From<&Cause> for CauseRecord {
    fn from(cause: &Cause) -> Self {
        Self {
            effect: cause.effect.to_string(),
            probability: cause.probability,
            probability_flat: cause.probability_flat,
            class: names(&cause.class),
            magnitude: MagnitudeRecord::of(cause.effect, cause.magnitude),
            rms_after_percent: cause.rms_after_percent,
            closure: cause.closure.map(|closure| closure.share),
            closure_ci95: cause.closure.map(|closure| closure.ci95),
            hidden: cause.hidden.to_string(),
            since: since(cause.hidden),
            level: None,
        }
    }
}

/// The date of what has one: of a history the last fall, which the flights dated, and not the beginning, which mostly is
/// where the model's knowledge ends.
fn since(hidden: HiddenParameter) -> Option<String> {
    let since_s = match hidden {
        HiddenParameter::Step { from_s, .. } => from_s,
        HiddenParameter::History(history) => history.falls_s().last().unwrap_or(history.since_s()),
        HiddenParameter::None | HiddenParameter::DragRise(_) | HiddenParameter::Throttle { .. } => {
            return None;
        }
    };
    Some(instant_words(since_s)).filter(|instant| !instant.is_empty())
}

impl From<&Contribution> for ContributionRecord {
    fn from(contribution: &Contribution) -> Self {
        Self {
            effect: contribution.effect.to_string(),
            magnitude: MagnitudeRecord::of(contribution.effect, contribution.magnitude),
            rms_percent: contribution.rms_percent,
            rms_ci95: contribution.rms_ci95,
            leads: contribution.leads,
        }
    }
}

impl From<&Verdict> for VerdictKind {
    fn from(verdict: &Verdict) -> Self {
        match verdict {
            Verdict::NoGap => Self::NoGap,
            Verdict::Effects(_) => Self::Effects,
            Verdict::OutsideLibrary(_) => Self::OutsideLibrary,
            Verdict::InsufficientData(_) => Self::InsufficientData,
        }
    }
}

impl From<&Diagnosis> for VerdictRecord {
    fn from(diagnosis: &Diagnosis) -> Self {
        let verdict = &diagnosis.verdict;
        let closure: Option<Closure> = verdict.closure();
        Self {
            kind: VerdictKind::from(verdict),
            effects: names(verdict.effects()),
            class: names(verdict.class()),
            probability: match verdict {
                Verdict::NoGap | Verdict::InsufficientData(_) => 0.0,
                Verdict::OutsideLibrary(unexplained) => unexplained.probability,
                Verdict::Effects(found) => found.probability,
            },
            beside: verdict.found().map_or_else(Vec::new, |found| {
                found.beside.iter().map(BesideRecord::from).collect()
            }),
            closure: closure.map(|closure| closure.share),
            closure_ci95: closure.map(|closure| closure.ci95),
            advice: advice(diagnosis),
            separations: verdict.found().map_or_else(Vec::new, |found| {
                found.separations.iter().map(SeparationRecord::from).collect()
            }),
        }
    }
}

impl From<&Beside> for BesideRecord {
    fn from(beside: &Beside) -> Self {
        Self {
            effect: beside.effect.to_string(),
            class: names(&beside.class),
            probability: beside.probability,
        }
    }
}

impl From<&Separation> for SeparationRecord {
    fn from(separation: &Separation) -> Self {
        Self {
            from: separation.from.to_string(),
            measurement: measurement_words(&separation.measurement),
            distance_now: separation.distance_now,
            distance_then: separation.distance_then,
            distance_ordinary_flights: separation.distance_ordinary_flights,
        }
    }
}

impl From<&Detectable> for DetectableRecord {
    fn from(detectable: &Detectable) -> Self {
        Self {
            effect: detectable.effect.to_string(),
            smallest: detectable.smallest,
            unit: detectable.effect.entry().unit.to_owned(),
            class: names(&detectable.class),
            nearest_other: detectable.nearest_other,
            nearest_pair: detectable.nearest_pair,
            separations: detectable.separations.iter().map(SeparationRecord::from).collect(),
        }
    }
}

impl From<&OutsideLibrary> for OutsideLibraryRecord {
    fn from(outside: &OutsideLibrary) -> Self {
        Self {
            probability: outside.probability,
            variable: outside.variable.map(|variable| variable_words(variable).to_owned()),
            acts_on: outside.acts_on.map(|acts_on| acts_on_words(acts_on).to_owned()),
            forms: outside.forms.iter().map(FormRecord::from).collect(),
        }
    }
}

fn names(effects: &[EffectId]) -> Vec<String> {
    effects.iter().map(ToString::to_string).collect()
}

#[cfg(test)]
mod tests {
    use flight::effect::{DragRise, History, StepTarget, ThrottleArgument};

    use super::*;

    /// 2019-06-01T00:00Z is 1 559 347 200 s since 1970 (`date -u -d 2019-06-01 +%s`).
    #[test]
    fn what_has_a_date_states_it() {
        const JUNE_S: f64 = 1_559_347_200.0;
        let step = HiddenParameter::Step { from_s: JUNE_S, target: StepTarget::Drag };
        assert_eq!(since(step).as_deref(), Some("2019-06-01T00:00:00Z"));
        let history =
            |falls_s: &[f64]| HiddenParameter::History(History::new(JUNE_S, 0.5, falls_s).unwrap());
        assert_eq!(since(history(&[])).as_deref(), Some("2019-06-01T00:00:00Z"));
        let falls_s = [JUNE_S + 7200.0, JUNE_S + 3600.0];
        assert_eq!(since(history(&falls_s)).as_deref(), Some("2019-06-01T02:00:00Z"));
        let argument = ThrottleArgument::N2;
        for undated in [
            HiddenParameter::None,
            HiddenParameter::DragRise(DragRise::by_lock(0.86)),
            HiddenParameter::Throttle { pivot: 1.0, argument },
        ] {
            assert_eq!(since(undated), None);
        }
        let cause = Cause { effect: EffectId::StepChange, hidden: step, ..cause() };
        let record = serde_json::to_value(CauseRecord::from(&cause)).unwrap();
        assert_eq!(record["since"], "2019-06-01T00:00:00Z");
        let record = serde_json::to_value(CauseRecord::from(&self::cause())).unwrap();
        assert!(record.get("since").is_none(), "{record}");
    }

    fn cause() -> Cause {
        Cause {
            effect: EffectId::DragFactor,
            probability: 0.9,
            probability_flat: 0.9,
            class: vec![EffectId::DragFactor],
            magnitude: diagnose::Magnitude { value: 3.0, ci95: [2.0, 4.0] },
            rms_after_percent: None,
            closure: None,
            hidden: HiddenParameter::None,
        }
    }
}
