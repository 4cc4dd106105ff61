//! Which flights are diagnosed together and against which model, and their diagnosis.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use diagnose::{
    Baseline, DiagnoseError, FlightRecord, Input, Options, TableUncertaintyError, diagnose,
};
use flight::effect::EffectId;

use crate::diagnosed_tail::{Compared, DiagnosedTail, POOL, RunOptions};
use crate::diagnosis_figures::DiagnosisFigures;
use crate::diagnosis_months::months;
use crate::export::rows_missed;
use crate::model_file::ModelFile;
use crate::monitoring::Event;
use crate::reading::{FlightRead, Reading, RefusedReport};
use crate::table_uncertainty;
use crate::whole_model::{HeldAgainst, Predicts};

/// Flights that are diagnosed together, and the model that they are compared with.
#[derive(Clone, Debug)]
pub struct Group<'a> {
    /// The tail; [`POOL`] for all tails of a model.
    pub name: String,
    /// Their model.
    pub model: &'a ModelFile,
    /// In the order of flying.
    pub flights: Vec<FlightRead>,
}

/// A name that no effect of the library has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoSuchEffect {
    /// The name.
    pub name: String,
    /// The names that there are, with commas.
    pub known: String,
}

/// The effects of these names.
///
/// # Errors
/// The first name that no effect has.
pub fn effects_named(names: &[String]) -> Result<Vec<EffectId>, NoSuchEffect> {
    let known = || {
        let library = EffectId::library(flight::MAXIMUM_ENGINES);
        library.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
    };
    let named = |name: &String| {
        EffectId::from_name(name).ok_or_else(|| NoSuchEffect { name: name.clone(), known: known() })
    };
    names.iter().map(named).collect()
}

/// Why a group has no diagnosis.
#[derive(Debug, thiserror::Error)]
#[error("tail {name}: {reason}")]
pub struct GroupError {
    /// The group.
    pub name: String,
    /// The reason.
    pub reason: GroupErrorReason,
}

/// A reason for which a group has no diagnosis.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GroupErrorReason {
    /// The covariance of a learnt table is invalid.
    #[error(transparent)]
    Table(#[from] TableUncertaintyError),
    /// The diagnosis refuses its input.
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
}

/// Flights by tail (or all of one model in a pool), as asked; those that their tail's model has learnt are moved to the refused
/// ones. `models`: that of each tail, as [`Models::of_tails`](crate::models::Models::of_tails) gives them.
pub fn group<'a>(
    models: &BTreeMap<String, &'a ModelFile>,
    reading: &mut Reading,
    asked: &RunOptions,
) -> Vec<Group<'a>> {
    let mut groups: BTreeMap<String, Group<'a>> = BTreeMap::new();
    let mut flights = std::mem::take(&mut reading.flights);
    flights.sort_by(FlightRead::order);
    for flight in flights {
        let Some(&model) = models.get(&flight.reduced.identity.tail) else { continue };
        if model.has_learnt(&flight.reduced.identity) {
            let finding = format!(
                "tail {} flight {} of {} is in the model's ledger: what it has learnt hides the gap",
                flight.reduced.identity.tail,
                flight.reduced.identity.flight,
                flight.reduced.identity.start
            );
            if !asked.allow_learnt {
                let reason = format!(
                    "{finding}; hold it against the initial model of its type, or a model from before this flight \
                     (--allow-learnt diagnoses it anyway)"
                );
                reading.refused.push(RefusedReport::whole(flight.path, reason));
                continue;
            }
            tracing::warn!("{finding}; diagnosed anyway, as asked");
        }
        // A pool has one model: a difference between models is not a gap of either.
        let (key, name) = if asked.pool {
            (model.initial.aircraft().type_code().to_owned(), POOL.to_owned())
        } else {
            (flight.reduced.identity.tail.clone(), flight.reduced.identity.tail.clone())
        };
        let group = groups.entry(key).or_insert_with(|| Group { name, model, flights: Vec::new() });
        if std::ptr::eq(group.model, model) {
            group.flights.push(flight);
        } else {
            reading.refused.push(RefusedReport::whole(
                flight.path,
                "its tail has a model of its own: a pool is diagnosed against one model",
            ));
        }
    }
    groups.into_values().collect()
}

impl Group<'_> {
    /// The group's diagnosis, and what its charts are drawn from. `options` are those of `asked` for the diagnosis itself.
    ///
    /// # Errors
    /// [`GroupError`] where the model's table or the flights are refused.
    pub fn diagnose(
        &self,
        options: &Options,
        asked: &RunOptions,
    ) -> Result<(DiagnosedTail, DiagnosisFigures), GroupError> {
        let wrong = |reason| GroupError { name: self.name.clone(), reason };
        let records = self.records();
        let predicts = Predicts::table_only(asked.table_only);
        let table = table_uncertainty::of_model(self.model, predicts, &records)
            .map_err(|error| wrong(error.into()))?;
        let baseline = self.baseline();
        let baseline = baseline.as_deref();
        let events_s = self.events_s(&asked.events);
        let HeldAgainst { model, drag_table, between_nodes } = self.model.held_against(predicts);
        let input = Input {
            model,
            drag_table,
            between_nodes,
            flights: &records,
            baseline: if asked.table_only { None } else { baseline },
            table: table.as_ref(),
            references: baseline.map(|baseline| *baseline.references()),
            events_s: &events_s,
        };
        let diagnosis = diagnose(&input, options).map_err(|error| wrong(error.into()))?;
        let mut figures = DiagnosisFigures::new(self.model, &input, &diagnosis)
            .map_err(|error| wrong(error.into()))?;
        let events = self.own_events(&asked.events).into_iter();
        figures.events =
            events.map(|event| (event.time.as_second() as f64, event.kind.clone())).collect();
        let diagnosed = DiagnosedTail {
            tail: self.name.clone(),
            diagnosis,
            compared: self.compared(),
            months: months(&figures.segments),
            run_notes: self.run_notes(asked),
        };
        Ok((diagnosed, figures))
    }

    /// What the model remembers of clean flights; of another aircraft's, what holds of this one.
    pub(crate) fn baseline(&self) -> Option<Cow<'_, Baseline>> {
        let learnt = self.model.learnt.as_ref()?;
        let baseline = learnt.baseline.as_ref()?;
        Some(if learnt.tail == self.name {
            Cow::Borrowed(baseline)
        } else {
            Cow::Owned(baseline.of_another_aircraft())
        })
    }

    /// Flights with segments, as a diagnosis takes them.
    pub(crate) fn records(&self) -> Vec<FlightRecord<'_>> {
        self.flights
            .iter()
            .filter(|flight| !flight.reduced.segments.is_empty())
            .map(|flight| FlightRecord {
                segments: &flight.reduced.segments,
                gauges: flight.reduced.gauges,
            })
            .collect()
    }

    /// What was done to the tails of this group.
    fn own_events<'e>(&self, events: &'e [Event]) -> Vec<&'e Event> {
        let flown: BTreeSet<&str> =
            self.flights.iter().map(|flight| flight.reduced.identity.tail.as_str()).collect();
        events.iter().filter(|event| flown.contains(event.tail.as_str())).collect()
    }

    /// Instants of these, s since 1970.
    fn events_s(&self, events: &[Event]) -> Vec<f64> {
        let own = self.own_events(events).into_iter();
        let mut instants: Vec<f64> = own.map(|event| event.time.as_second() as f64).collect();
        instants.dedup();
        instants
    }

    fn run_notes(&self, asked: &RunOptions) -> Vec<String> {
        let mut run_notes = asked.restrictions();
        if !self.model.has_whole_model() && !asked.table_only {
            run_notes.extend(self.note_of_guide());
            let advice = if self.model.has_learnt_segments() {
                "the model has learnt a table alone: everything that a table cannot hold counts as gap; \
                 law bayes learns it too, without --no-remainder"
            } else {
                "the model has learnt nothing: everything that a table cannot hold counts as gap; adapt it to flights first"
            };
            run_notes.push(advice.to_owned());
        }
        let mut seen = BTreeSet::new();
        for note in self.flights.iter().flat_map(|flight| &flight.reduced.notes) {
            if seen.insert(note) {
                run_notes.push(note.clone());
            }
        }
        run_notes
    }

    /// Which drag a model is held against that has learnt nothing, where it is not that of its predictions.
    fn note_of_guide(&self) -> Option<String> {
        let [rms, _] = rows_missed(self.model)?;
        Some(format!(
            "flights are held against the drag of the guide's rows; the polynomial, by which predict and evaluate go until flights are \
             learnt, is {rms:.1} % off these (rms over the guide's range)"
        ))
    }

    fn compared(&self) -> Compared {
        // Those without a segment are not among the flights that are diagnosed.
        let shown = || self.flights.iter().filter(|flight| !flight.reduced.segments.is_empty());
        let starts = || shown().map(|flight| flight.reduced.identity.start);
        let learnt = self.model.learnt.as_ref().filter(|_| self.model.has_learnt_segments());
        Compared {
            aircraft: self.model.initial.aircraft().name().to_owned(),
            law: learnt.map(|learnt| learnt.law.told()),
            flights_learnt: learnt.map_or(0, |learnt| learnt.ledger.len()),
            learnt_tail: learnt.map(|learnt| learnt.tail.clone()).filter(|tail| *tail != self.name),
            first_flight: starts().min().map(|start| start.to_string()),
            last_flight: starts().max().map(|start| start.to_string()),
        }
    }
}
