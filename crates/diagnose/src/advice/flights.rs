//! Which flights on purpose would tell two effects apart that the flights at hand do not.
//!
//! What it is: a fixed list of flights (a Mach sweep at a constant level, a level sweep at a constant Mach number, heavy or
//! light) inside what this fleet has shown to be possible, their rows made by the same signatures, noise and nuisance as
//! those of real flights, and the distance that six of them put between two effects, compared with what six more ordinary
//! flights would do. Most pairs gain little: then nothing is said.
//! What it is not: a flight planner. Weather, traffic and the aircraft's limits are not known here; nothing faster, higher,
//! lower, heavier, lighter or with more thrust, lift coefficient or dynamic pressure than was flown is proposed.

use effects::EffectModel;
use faer::Mat;

use crate::advice::distances::{Distances, gains, squared_from_any};
use crate::advice::flights::envelope::Envelope;
use crate::advice::flights::information::{FlightInformation, Known, added};
use crate::advice::flights::sweeps::test_flights;
use crate::library::{Column, Library};
use crate::math::eliminate::integrate_out;
use crate::output::measurement::{FlightsOnPurpose, Sweep};
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
    flights: FlightsOnPurpose,
    gram: Mat<f64>,
}

/// What flights on purpose vary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Mach,
    Level,
}

impl From<Sweep> for Kind {
    fn from(sweep: Sweep) -> Self {
        match sweep {
            Sweep::Mach { .. } => Self::Mach,
            Sweep::Level { .. } => Self::Level,
        }
    }
}

/// An advice: flights, and the distance between two effects now, with them, and with as many ordinary ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Advised {
    pub(crate) flights: FlightsOnPurpose,
    pub(crate) before: f64,
    pub(crate) ordinary: f64,
    pub(crate) after: f64,
}

impl Conditions {
    /// For these columns of the library; `None` where there is nothing to tell apart or nothing else can be flown.
    pub(crate) fn from_flights(
        system: &WhitenedSystem<'_>,
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
        let gram = system.gram(None);
        let nuisance = system.design.nuisance.clone();
        let known = Known::from_gram(&gram.matrix, &columns, nuisance.clone())?;
        let envelope = Envelope::from_flights(system.data, model)?;
        let design = system.design.of_nuisance(columns.len());
        let few = Library {
            effects: library.effects.clone(),
            columns: columns.iter().map(|&column| library.columns[column]).collect::<Vec<Column>>(),
            dates: library.dates.clone(),
            not_testable: vec![],
            heating_value: false,
            spikes: library.spikes,
            agnostic_spikes: library.agnostic_spikes,
            spikes_of_right_table: library.spikes_of_right_table,
        };
        let weight = system.data.mean_weight();
        let mut steady: Vec<FlightInformation> = Vec::new();
        let mut sweeps: Vec<(Sweep, FlightInformation)> = Vec::new();
        for flight in test_flights(&envelope, model) {
            let planned = system.data.planned(model, &few, &flight.points, envelope.recorded);
            let Some(planned) = planned else { continue };
            let rows = faer::Scale(weight) * design.whitened(&planned, &planned.flights[0]);
            let information = known.flight(&rows);
            match flight.sweep {
                Some(sweep) => sweeps.push((sweep, information)),
                None => steady.push(information),
            }
        }
        let now = distances.gram_of(&columns);
        let mut ordinary =
            vec![more_of_the_same(&gram.matrix, &columns, nuisance, system.data.flights.len())?];
        for flight in &steady {
            ordinary.push(&now + added(&[(flight, ADVISED_FLIGHTS as f64)])?);
        }
        let programs = programs(&sweeps, &now);
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
                    let more = next.1.is_mixed() && !best.1.is_mixed();
                    let worth = if more { WORTH_MIXING } else { 1.0 };
                    if next.0 > worth * best.0 { next } else { best }
                });
            let worth = |after: f64| after >= LEAST_DISTANCE && gains(ordinary, after);
            found.extend(best.filter(|(after, _)| worth(*after)).map(|(after, program)| Advised {
                flights: program.flights,
                before,
                ordinary,
                after,
            }));
        }
        found.sort_by(|a, b| b.after.total_cmp(&a.after));
        found
    }
}

impl Program {
    /// Whether it has two sorts of flights.
    const fn is_mixed(&self) -> bool {
        matches!(self.flights, FlightsOnPurpose::TwoSorts(_))
    }
}

/// Six flights of one sort first, then three each of two sorts of one kind.
fn programs(flights: &[(Sweep, FlightInformation)], now: &Mat<f64>) -> Vec<Program> {
    let mut programs = Vec::new();
    let mut add = |kind: Kind, flights: FlightsOnPurpose, parts: &[(&FlightInformation, f64)]| {
        if let Some(more) = added(parts) {
            programs.push(Program { kind, flights, gram: now + more });
        }
    };
    for &(sweep, ref flight) in flights {
        let six = FlightsOnPurpose::OneSort(sweep);
        add(Kind::from(sweep), six, &[(flight, ADVISED_FLIGHTS as f64)]);
    }
    let half = ADVISED_FLIGHTS as f64 / 2.0;
    for (place, &(sweep, ref flight)) in flights.iter().enumerate() {
        let kind = Kind::from(sweep);
        let others = flights[place + 1..].iter().filter(|other| Kind::from(other.0) == kind);
        for &(other_sweep, ref other) in others {
            let three_each = FlightsOnPurpose::TwoSorts([sweep, other_sweep]);
            add(kind, three_each, &[(flight, half), (other, half)]);
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
