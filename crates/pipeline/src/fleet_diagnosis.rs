//! All tails of a type diagnosed together: what their model lacks, what each tail has, what a sensor has.

use std::collections::BTreeMap;

use diagnose::{
    Baseline, FleetDiagnosis, FleetFinding, FleetFrame, FleetLevel, FleetTail, FlightRecord, Input,
    ModelOf, Options, diagnose_fleet,
};
use flight::effect::EffectId;

use crate::diagnosed_tail::{POOL, RunOptions};
use crate::diagnosis_groups::{Group, GroupError, GroupErrorReason};
use crate::model_file::{AppliedRecord, DiagnosisRecord};
use crate::statistics::NORMAL_95;
use crate::table_uncertainty;
use crate::whole_model::{HeldAgainst, Predicts};

mod document;
mod tables;
mod text;

pub use document::{FleetEffectRecord, FleetFindingRecord, FleetGap, FleetRecord, FleetTailRecord};
pub use tables::fleet_table;
pub use text::{TEACH_IT_FIRST, fleet_text, nothing_shared, of_tail_words, size_words};

/// The diagnosis of all tails of a type.
#[derive(Clone, Debug)]
pub struct DiagnosedFleet {
    /// The type.
    pub aircraft_type: String,
    /// The tails that took part, in the order of the diagnosis, each with its place among the groups.
    pub tails: Vec<FleetMember>,
    /// Tails without a flight inside the table.
    pub left_out: Vec<String>,
    /// Whether all tails are held against one model.
    pub model_of: ModelOf,
    /// Whether every model has learnt flights: an error of a table that none has taught looks like effects that all share.
    pub taught: bool,
    /// What was found.
    pub diagnosis: FleetDiagnosis,
}

/// A tail of a fleet.
#[derive(Clone, Debug)]
pub struct FleetMember {
    /// Its name.
    pub tail: String,
    /// Its place among the groups.
    pub group: usize,
    /// What its flights were reduced to.
    pub reduced: FleetTail,
}

/// Reduces tails, in whatever order and on however many threads the caller likes: the number of tails, and what reduces one.
pub type ReduceAll<'a> =
    &'a dyn Fn(usize, &(dyn Fn(usize) -> Option<FleetTail> + Sync)) -> Vec<Option<FleetTail>>;

/// Diagnoses the tails of each type together, `groups` being a tail each.
///
/// # Errors
/// [`GroupError`] where a model's table is refused, or a type has too few tails.
pub fn diagnose_fleets(
    groups: &[Group<'_>],
    options: &Options,
    asked: &RunOptions,
    reduce_all: ReduceAll<'_>,
) -> Result<Vec<DiagnosedFleet>, GroupError> {
    let mut types: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (place, group) in groups.iter().enumerate() {
        types.entry(group.model.initial.aircraft().type_code()).or_default().push(place);
    }
    types
        .into_iter()
        .map(|(aircraft_type, members)| {
            let fleet = Fleet { groups, members: &members, options, asked };
            fleet.diagnose(aircraft_type, reduce_all).map_err(|reason| GroupError {
                name: format!("all of type {aircraft_type}"),
                reason,
            })
        })
        .collect()
}

/// The tails of a type before they are diagnosed.
struct Fleet<'g> {
    groups: &'g [Group<'g>],
    members: &'g [usize],
    options: &'g Options,
    asked: &'g RunOptions,
}

impl Fleet<'_> {
    fn diagnose(
        &self,
        aircraft_type: &str,
        reduce_all: ReduceAll<'_>,
    ) -> Result<DiagnosedFleet, GroupErrorReason> {
        let first = self.groups[self.members[0]].model;
        let is_shared =
            self.members.iter().all(|&place| std::ptr::eq(self.groups[place].model, first));
        let taught = self.members.iter().all(|&place| self.groups[place].model.learnt.is_some());
        let model_of = if is_shared { ModelOf::Type } else { ModelOf::Tail };
        let reduced = match model_of {
            ModelOf::Type => {
                let records: Vec<FlightRecord<'_>> =
                    self.members.iter().flat_map(|&place| self.groups[place].records()).collect();
                self.groups[self.members[0]].with_frame(
                    (&records, self.options, self.asked, model_of),
                    |frame| {
                        reduce_all(self.members.len(), &|at| {
                            let records = self.groups[self.members[at]].records();
                            frame.tail(&records)
                        })
                    },
                )?
            }
            // A model of its own for each tail: what cannot be prepared is left out like a tail without flights.
            ModelOf::Tail => reduce_all(self.members.len(), &|at| {
                let group = &self.groups[self.members[at]];
                let records = group.records();
                let own = (&records[..], self.options, self.asked, model_of);
                group.with_frame(own, |frame| frame.tail(&records)).ok().flatten()
            }),
        };
        let mut tails = Vec::new();
        let mut left_out = Vec::new();
        for (&group, reduced) in self.members.iter().zip(reduced) {
            let tail = self.groups[group].name.clone();
            match reduced {
                Some(reduced) => tails.push(FleetMember { tail, group, reduced }),
                None => left_out.push(tail),
            }
        }
        let mut reduced: Vec<&mut FleetTail> =
            tails.iter_mut().map(|member: &mut FleetMember| &mut member.reduced).collect();
        let diagnosis = diagnose_fleet(&mut reduced)?;
        let aircraft_type = aircraft_type.to_owned();
        Ok(DiagnosedFleet { aircraft_type, tails, left_out, model_of, taught, diagnosis })
    }
}

impl Group<'_> {
    /// Calls `then` with what the tails of this group's model have in common, taken from these flights.
    fn with_frame<R>(
        &self,
        (records, options, asked, model_of): (&[FlightRecord<'_>], &Options, &RunOptions, ModelOf),
        then: impl FnOnce(&FleetFrame<'_>) -> R,
    ) -> Result<R, GroupErrorReason> {
        let predicts = Predicts::table_only(asked.table_only);
        let table = table_uncertainty::of_model(self.model, predicts, records)?;
        let own = self.baseline();
        let of_type = match model_of {
            ModelOf::Type => own.as_deref().map(Baseline::of_another_aircraft),
            ModelOf::Tail => None,
        };
        let baseline = of_type.as_ref().or(own.as_deref());
        let HeldAgainst { model, drag_table, between_nodes } = self.model.held_against(predicts);
        let input = Input {
            model,
            drag_table,
            between_nodes,
            flights: records,
            baseline: if asked.table_only { None } else { baseline },
            table: table.as_ref(),
            references: baseline.map(|baseline| *baseline.references()),
            events_s: &[],
        };
        let frame = FleetFrame::new(input, options, model_of)?;
        Ok(then(&frame))
    }
}

impl DiagnosedFleet {
    /// Whose a finding is: the tail's name, or the type.
    pub fn whose(&self, finding: &FleetFinding) -> &str {
        finding.tail.map_or(&self.aircraft_type, |tail| &self.tails[tail].tail)
    }

    /// Mean gap of the tails; `None` of one.
    pub fn mean_gap(&self) -> Option<FleetGap> {
        let gaps: Vec<f64> =
            self.tails.iter().map(|member| member.reduced.mean_gap_percent).collect();
        FleetGap::of_tails(&gaps)
    }

    /// Effects that were found anywhere, in the library's order: their places in the diagnosis.
    pub fn found_effects(&self) -> Vec<usize> {
        let is_found = |effect: &EffectId| {
            self.diagnosis.findings.iter().any(|finding| finding.effect == *effect)
        };
        let effects = self.diagnosis.effects.iter().enumerate();
        effects.filter(|(_, effect)| is_found(effect)).map(|(place, _)| place).collect()
    }

    /// What was found of the type (`None`) or a tail and nothing else can be, as the record of a model; `None` where there is
    /// nothing.
    pub fn applied(&self, tail: Option<usize>) -> Option<AppliedRecord> {
        self.applied_to(tail, tail.unwrap_or(0))
    }

    /// The same, with the references of the model that `member` has.
    pub fn applied_to(&self, tail: Option<usize>, member: usize) -> Option<AppliedRecord> {
        let findings: Vec<&FleetFinding> = self
            .diagnosis
            .findings
            .iter()
            .filter(|finding| finding.tail == tail && finding.class.len() == 1)
            .collect();
        let first = findings.first()?;
        let sizes: Vec<(EffectId, f64, f64)> = findings
            .iter()
            .map(|finding| {
                let [low, high] = finding.magnitude.ci95;
                (finding.effect, finding.magnitude.value, 0.5 * (high - low) / NORMAL_95)
            })
            .collect();
        let of =
            |member: &FleetMember| (member.reduced.flights as u64, member.reduced.segments as u64);
        let member = &self.tails[member];
        let (flights, segments) = match tail {
            Some(_) => of(member),
            None => self.tails.iter().map(of).fold((0, 0), |a, b| (a.0 + b.0, a.1 + b.1)),
        };
        Some(AppliedRecord {
            addition: member.reduced.addition(&sizes),
            diagnosis: DiagnosisRecord {
                tail: tail.map_or_else(|| POOL.to_owned(), |tail| self.tails[tail].tail.clone()),
                flights,
                segments,
                first: String::new(),
                last: String::new(),
                probability: first.probability,
                class: first.class.clone(),
            },
        })
    }
}

/// A level's name in files.
pub(crate) const fn level_name(level: FleetLevel) -> &'static str {
    match level {
        FleetLevel::Type => "type",
        FleetLevel::Tail => "tail",
        FleetLevel::Sensor => "sensor",
    }
}
