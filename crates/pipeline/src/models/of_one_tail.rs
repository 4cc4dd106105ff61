//! Reports of one tail that name aircraft of two types: one of them is a slip.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use super::{Models, NoModel};
use crate::model_file::ModelFile;
use crate::reading::{FlightRead, Reading, RefusedReport};

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
    /// The model of each flight, in their order, or why it has none: one model for all flights of a tail.
    ///
    /// # Errors
    /// For each flight, why there is none.
    pub fn of_each(&self, flights: &[FlightRead]) -> Vec<Result<&ModelFile, NoModel>> {
        let mut tails: BTreeMap<&str, ReportsByModel<'_, usize>> = BTreeMap::new();
        let mut found: Vec<_> = flights.iter().map(|flight| self.for_flight(flight)).collect();
        for (place, flight) in flights.iter().enumerate() {
            if let Ok(model) = found[place] {
                tails.entry(&flight.reduced.identity.tail).or_default().add(model, place);
            }
        }
        for (tail, reports) in tails {
            for (place, reason) in
                reports.of_one(tail, |_| false).into_iter().flat_map(|o| o.strays)
            {
                found[place] = Err(reason);
            }
        }
        found
    }

    /// The model of each tail. Flights without a model, or of another type than their tail, are moved to the refused ones.
    pub fn of_tails(&self, reading: &mut Reading) -> BTreeMap<String, &ModelFile> {
        let found = self.of_each(&reading.flights);
        let mut tails = BTreeMap::new();
        for (flight, model) in std::mem::take(&mut reading.flights).into_iter().zip(found) {
            match model {
                Ok(model) => {
                    tails.insert(flight.reduced.identity.tail.clone(), model);
                    reading.flights.push(flight);
                }
                Err(reason) => reading.refused.push(RefusedReport::whole(flight.path, reason)),
            }
        }
        tails
    }

    /// The model of each tail with its flights, taken out of what was read. The others are refused as by [`of_tails`](Self::of_tails).
    pub fn with_flights(
        &self,
        reading: &mut Reading,
    ) -> BTreeMap<String, (&ModelFile, Vec<FlightRead>)> {
        let models = self.of_tails(reading).into_iter();
        let mut tails: BTreeMap<_, _> =
            models.map(|(tail, model)| (tail, (model, Vec::new()))).collect();
        for flight in std::mem::take(&mut reading.flights) {
            if let Some((_, flights)) = tails.get_mut(&flight.reduced.identity.tail) {
                flights.push(flight);
            }
        }
        tails
    }
}
