//! Reports of one tail that name aircraft of two types: one of them is a slip.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use super::{Models, NoModel};
use crate::model_file::ModelFile;
use crate::reading::{FlightRead, RefusedReport};

/// A tail's reports by the models that are theirs. A model learns from, and is held against, flights of its own aircraft alone.
#[derive(Debug)]
pub struct ReportsByModel<'m, R>(Vec<(&'m ModelFile, Vec<R>)>);

impl<R> Default for ReportsByModel<'_, R> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

/// Those of one model.
#[derive(Debug)]
pub struct OfOneModel<'m, R> {
    /// The model.
    pub model: &'m ModelFile,
    /// Its reports, in the order in which they were added.
    pub reports: Vec<R>,
    /// The others, each with the reason.
    pub strays: Vec<(R, NoModel)>,
}

impl<'m, R> ReportsByModel<'m, R> {
    /// One more report.
    pub fn add(&mut self, model: &'m ModelFile, report: R) {
        match self.0.iter_mut().find(|(known, _)| std::ptr::eq(*known, model)) {
            Some((_, reports)) => reports.push(report),
            None => self.0.push((model, vec![report])),
        }
    }

    /// Those of the model that is known to be the tail's, otherwise of the one that most of them have (of equals, the first).
    /// `None` without a report.
    pub fn of_one(
        self,
        tail: &str,
        mut is_known: impl FnMut(&'m ModelFile) -> bool,
    ) -> Option<OfOneModel<'m, R>> {
        let mut groups = self.0;
        let (_, first) = groups
            .iter()
            .enumerate()
            .map(|(place, (model, reports))| {
                ((is_known(model), reports.len(), Reverse(place)), place)
            })
            .max()?;
        let (model, reports) = groups.remove(first);
        let type_of = |model: &ModelFile| model.initial.aircraft().type_code().to_owned();
        let reason = |other| NoModel::TypeOfTail {
            found: type_of(other),
            expected: type_of(model),
            tail: tail.to_owned(),
        };
        let strays = groups
            .into_iter()
            .flat_map(|(other, reports)| reports.into_iter().map(move |report| (report, other)))
            .map(|(report, other)| (report, reason(other)))
            .collect();
        Some(OfOneModel { model, reports, strays })
    }
}

impl Models {
    /// Flights with the model of each, in their order: one model for all flights of a tail. Those without a model are moved to
    /// the refused ones.
    pub fn for_flights(
        &self,
        flights: Vec<FlightRead>,
        refused: &mut Vec<RefusedReport>,
    ) -> Vec<(&ModelFile, FlightRead)> {
        let mut tails: BTreeMap<String, ReportsByModel<'_, (usize, FlightRead)>> = BTreeMap::new();
        for (place, flight) in flights.into_iter().enumerate() {
            match self.for_flight(&flight) {
                Ok(model) => {
                    let tail = flight.reduced.identity.tail.clone();
                    tails.entry(tail).or_default().add(model, (place, flight));
                }
                Err(reason) => refused.push(RefusedReport::whole(flight.path, reason)),
            }
        }
        let mut found = Vec::new();
        for (tail, reports) in tails {
            let Some(one) = reports.of_one(&tail, |_| false) else { continue };
            found.extend(one.reports.into_iter().map(|(place, flight)| (place, one.model, flight)));
            let strays = one.strays.into_iter();
            refused.extend(
                strays.map(|((_, flight), reason)| RefusedReport::whole(flight.path, reason)),
            );
        }
        found.sort_by_key(|(place, ..)| *place);
        found.into_iter().map(|(_, model, flight)| (model, flight)).collect()
    }
}
