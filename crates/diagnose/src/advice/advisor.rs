//! What would tell confused effects apart: measurements and flights on purpose, in one list by the distance they put.

use crate::advice::distances::Distances;
use crate::advice::flights::Conditions;
use crate::library::Library;
use crate::output::measurement::{Measurement, Separation};
use crate::search::system::Problem;
use crate::thresholds::{CONFUSED, DECIDED};

/// Everything that advice is made of.
pub(crate) struct Advisor<'a> {
    distances: &'a Distances,
    library: &'a Library,
    conditions: Option<Conditions>,
}

impl<'a> Advisor<'a> {
    /// For the columns of a verdict, the effects that may be in its class, and those confused at typical sizes. Flights are
    /// only looked at for these.
    pub(crate) fn new(
        problem: Problem<'a>,
        distances: &'a Distances,
        classes: &[Vec<usize>],
        found: &[usize],
        likely: &[usize],
    ) -> Self {
        let Problem { system, model, library } = problem;
        let confused = classes.iter().filter(|class| class.len() > 1).flatten();
        let columns = confused
            .chain(likely)
            .flat_map(|&effect| library.effects[effect].all_columns())
            .chain(found.iter().copied())
            .collect();
        let conditions = Conditions::from_flights(system, model, library, distances, columns);
        Self { distances, library, conditions }
    }

    /// What would tell a column at a size from another effect, whatever the other's hidden parameter; the best first. Nothing of
    /// what is told apart already. Distances allow for forms other than the library's.
    pub(crate) fn between(&self, column: usize, size: f64, other: usize) -> Vec<Separation> {
        let from = self.library.effects[other].id;
        let others = self.library.effects[other].all_columns();
        let at = |l: usize| {
            let variance = self.distances.form_variance(self.library, [column, l], size);
            (self.distances.squared(column, l, size).0 / variance, variance)
        };
        let nearest = others.clone().map(at).min_by(|a, b| a.0.total_cmp(&b.0));
        let form = nearest.map_or(1.0, |(_, variance)| variance.sqrt());
        let mut all: Vec<Separation> = self
            .distances
            .measurements(self.library, column, others.clone(), size)
            .into_iter()
            .map(|found| Separation {
                from,
                measurement: found.measurement,
                distance_now: found.before / form,
                distance_then: found.after / form,
                distance_ordinary_flights: None,
            })
            .collect();
        let flights =
            self.conditions.iter().flat_map(|at| at.advised(column, others.clone(), size));
        all.extend(flights.map(|found| Separation {
            from,
            measurement: Measurement::Flights(found.flights),
            distance_now: found.before / form,
            distance_then: found.after / form,
            distance_ordinary_flights: Some(found.ordinary / form),
        }));
        all.retain(|found| found.distance_now < DECIDED);
        best_first(&mut all);
        all
    }

    /// What would tell an effect of typical size from the nearest other one of its class, the best first; nothing where
    /// that one is far enough already, seen from this side.
    pub(crate) fn beforehand(&self, effect: usize, class: &[usize]) -> Vec<Separation> {
        let column = self.distances.leading(effect);
        let size = self.library.effects[effect].typical;
        let nearest = class
            .iter()
            .filter(|&&other| other != effect)
            .map(|&other| {
                let columns = self.library.effects[other].all_columns();
                (self.distances.squared_from_any(column, columns, size), other)
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .filter(|(squared, _)| *squared < CONFUSED);
        nearest.map_or_else(Vec::new, |(_, other)| self.between(column, size, other))
    }
}

/// By the distance that is reached.
pub(crate) fn best_first(separations: &mut [Separation]) {
    separations.sort_by(|a, b| b.distance_then.total_cmp(&a.distance_then));
}
