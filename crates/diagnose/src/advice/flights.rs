//! Which flights on purpose would tell two effects apart that the flights at hand do not.
//!
//! What it is: a fixed list of flights (a Mach sweep at a constant level, a level sweep at a constant Mach number, heavy or
//! light) inside what this fleet has shown to be possible, their rows made by the same signatures, noise and nuisance as
//! those of real flights, and the distance that six of them put between two effects, beside what six more ordinary flights
//! would do. Most pairs gain little: then nothing is said.
//! What it is not: a flight planner. Weather, traffic and the aircraft's limits are not known here; nothing faster, higher,
//! lower, heavier, lighter or with more thrust, lift coefficient or dynamic pressure than was flown is proposed.

use effects::EffectModel;
use faer::Mat;

use crate::advice::distances::{Distances, gains, squared_from_any};
use crate::advice::flights::envelope::Envelope;
use crate::advice::flights::information::{FlightInformation, Known, added};
use crate::advice::flights::sweeps::{Kind, test_flights};
use crate::library::{Column, Library};
use crate::math::eliminate::integrate_out;
use crate::search::system::WhitenedSystem;
use crate::thresholds::{ADVISED_FLIGHTS, LEAST_DISTANCE, WORTH_MIXING};

mod envelope;
mod information;
mod sweeps;

/// What flights on purpose would do for some columns of the library.
pub(crate) struct Conditions {
    /// Columns of the library, in order.
    columns: Vec<usize>,
    /// Gram of these columns now, nuisance integrated out.
    now: Mat<f64>,
    /// With six ordinary flights more: as the flights at hand, and as one in the middle of them at the last date.
    ordinary: Vec<Mat<f64>>,
    programs: Vec<Program>,
}

/// Six flights, of one kind.
struct Program {
    kind: Kind,
    /// Whether it has two sorts of flights.
    mixed: bool,
    words: String,
    gram: Mat<f64>,
}

/// An advice: flights, and the distance between two effects now, with them, and with as many ordinary ones.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Advised {
    pub(crate) words: String,
    pub(crate) before: f64,
    pub(crate) ordinary: f64,
    pub(crate) after: f64,
}

impl Conditions {
    /// For these columns of the library; `None` where there is nothing to tell apart or nothing else can be flown.
    pub(crate) fn of(
        stacked: &WhitenedSystem<'_>,
        model: &EffectModel<'_>,
        library: &Library,
        distances: &Distances,
        mut columns: Vec<usize>,
    ) -> Option<Self> {
        columns.sort_unstable();
        columns.dedup();
        if columns.len() < 2 {
            return None;
        }
        let gram = stacked.gram(None);
        let nuisance = stacked.design.nuisance.clone();
        let known = Known::of(&gram.matrix, &columns, nuisance.clone())?;
        let envelope = Envelope::of(stacked.data, model)?;
        let design = stacked.design.of_nuisance(columns.len());
        let few = Library {
            effects: library.effects.clone(),
            columns: columns.iter().map(|&column| library.columns[column]).collect::<Vec<Column>>(),
            not_testable: vec![],
            heating_value: false,
        };
        let weight = stacked.mean_weight();
        let mut flights: Vec<(Kind, String, FlightInformation)> = Vec::new();
        for flight in test_flights(&envelope, model) {
            let planned = stacked.data.planned(model, &few, &flight.points, envelope.recorded);
            let Some(planned) = planned else { continue };
            let rows = design.whitened(&planned, &planned.flights[0], None);
            let rows = faer::Scale(weight) * rows;
            flights.push((flight.kind, flight.words, known.flight(&rows)));
        }
        let now = distances.gram_of(&columns);
        let mut ordinary =
            vec![more_of_the_same(&gram.matrix, &columns, nuisance, stacked.data.flights.len())?];
        for (_, _, steady) in flights.iter().filter(|(kind, _, _)| *kind == Kind::Steady) {
            ordinary.push(&now + added(&[(steady, ADVISED_FLIGHTS as f64)])?);
        }
        flights.retain(|(kind, _, _)| *kind != Kind::Steady);
        let programs = programs(&flights, &now);
        (!programs.is_empty()).then_some(Self { columns, now, ordinary, programs })
    }

    /// The best flights of each kind between column `k` at a size and an effect whose columns are `others`, those that reach
    /// a distance worth flying for and clearly more than ordinary flights, the best first.
    pub(crate) fn advised(
        &self,
        k: usize,
        others: core::ops::Range<usize>,
        size: f64,
    ) -> Vec<Advised> {
        let place = |column: usize| self.columns.binary_search(&column).ok();
        let count = others.len();
        let others: Vec<usize> = others.filter_map(place).collect();
        let Some(k) = place(k).filter(|_| count > 0 && others.len() == count) else {
            return vec![];
        };
        let distance =
            |gram: &Mat<f64>| squared_from_any(gram, k, others.iter().copied(), size).sqrt();
        let before = distance(&self.now);
        let ordinary = self.ordinary.iter().map(distance).fold(before, f64::max);
        let mut found = Vec::new();
        for kind in [Kind::Mach, Kind::Level] {
            let best = self
                .programs
                .iter()
                .filter(|program| program.kind == kind)
                .map(|program| (distance(&program.gram), program))
                .reduce(|best, next| {
                    let worth = if next.1.mixed && !best.1.mixed { WORTH_MIXING } else { 1.0 };
                    if next.0 > worth * best.0 { next } else { best }
                });
            let worth = |after: f64| after >= LEAST_DISTANCE && gains(ordinary, after);
            found.extend(best.filter(|(after, _)| worth(*after)).map(|(after, program)| Advised {
                words: program.words.clone(),
                before,
                ordinary,
                after,
            }));
        }
        found.sort_by(|a, b| b.after.total_cmp(&a.after));
        found
    }
}

/// Six flights of one sort first, then three each of two sorts of one kind.
fn programs(flights: &[(Kind, String, FlightInformation)], now: &Mat<f64>) -> Vec<Program> {
    let mut programs = Vec::new();
    let mut add = |kind: Kind, words: String, parts: &[(&FlightInformation, f64)]| {
        if let Some(more) = added(parts) {
            programs.push(Program { kind, mixed: parts.len() > 1, words, gram: now + more });
        }
    };
    for (kind, words, flight) in flights {
        add(*kind, format!("six flights with {words}"), &[(flight, ADVISED_FLIGHTS as f64)]);
    }
    let half = ADVISED_FLIGHTS as f64 / 2.0;
    for (place, (kind, words, flight)) in flights.iter().enumerate() {
        for (_, other_words, other) in flights[place + 1..].iter().filter(|other| other.0 == *kind)
        {
            let words = format!("three flights with {words}, and three with {other_words}");
            add(*kind, words, &[(flight, half), (other, half)]);
        }
    }
    programs
}

/// The Gram if as many flights more were like the mean of those at hand: G·(1 + n/flights) before the nuisance is
/// integrated out.
fn more_of_the_same(
    gram: &Mat<f64>,
    columns: &[usize],
    nuisance: core::ops::Range<usize>,
    flights: usize,
) -> Option<Mat<f64>> {
    let grown = 1.0 + ADVISED_FLIGHTS as f64 / flights.max(1) as f64;
    let out: Vec<usize> = nuisance.collect();
    let deviations = vec![grown.sqrt(); out.len()];
    Some(faer::Scale(grown) * integrate_out(gram, columns, &out, &deviations)?.matrix)
}

#[cfg(test)]
mod tests;
