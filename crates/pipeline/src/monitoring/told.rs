//! Which changes are told: one event may show in the fuel flow of all engines together and in that of one.

use flight::Timestamp;

use super::document::{ChangeDocument, TailDocument};

impl TailDocument {
    /// Its changes, each event once.
    #[must_use]
    pub fn told_changes(&self) -> Vec<&ChangeDocument> {
        let engines = self.flights.iter().map(|flight| flight.engines_percent.len()).max();
        told(&self.changes, engines.unwrap_or(0))
    }
}

/// Changes without those that are the same event as another one, in their order. Changes are one event where the intervals of their
/// dates overlap and:
///
/// ```text
/// a single engine has changed, and x/N lies in the 95 % interval of the step of all N engines: the engine's is told
/// the engine's step x itself lies in that interval: every engine has changed as all together, and that of all is told
/// ```
///
/// A step whose own 95 % interval holds 0 stands for no other one.
pub(super) fn told(changes: &[ChangeDocument], engines: usize) -> Vec<&ChangeDocument> {
    let numbers = changes.iter().filter_map(|change| change.engine);
    let engines = numbers.max().unwrap_or(1).max(engines);
    let of_all = || changes.iter().filter(|change| change.engine.is_none());
    let is_told = |change: &&ChangeDocument| match change.engine {
        None => !is_of_one_engine(change, changes, engines),
        Some(_) => !of_all().any(|all| {
            is_at_one_time(all, change)
                && is_sure(all)
                && holds(all, change.step_percent.value)
                && !is_of_one_engine(all, changes, engines)
        }),
    };
    changes.iter().filter(is_told).collect()
}

/// Whether a change of all engines together is that of a single one of several.
fn is_of_one_engine(all: &ChangeDocument, changes: &[ChangeDocument], engines: usize) -> bool {
    let is_near = |change: &&ChangeDocument| {
        change.engine.is_some() && is_sure(change) && is_at_one_time(all, change)
    };
    let near: Vec<&ChangeDocument> = changes.iter().filter(is_near).collect();
    let [one] = near[..] else { return false };
    engines > 1 && holds(all, one.step_percent.value / engines as f64)
}

fn holds(change: &ChangeDocument, percent: f64) -> bool {
    let [low, high] = change.step_percent.ci95;
    (low..=high).contains(&percent)
}

fn is_sure(change: &ChangeDocument) -> bool {
    !holds(change, 0.0)
}

fn is_at_one_time(one: &ChangeDocument, other: &ChangeDocument) -> bool {
    let interval = |change: &ChangeDocument| {
        let [from, to] = &change.since_ci95;
        Some((from.parse::<Timestamp>().ok()?, to.parse::<Timestamp>().ok()?))
    };
    match (interval(one), interval(other)) {
        (Some((from, to)), Some((other_from, other_to))) => from <= other_to && other_from <= to,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::document::Figure;
    use super::*;

    /// A step of an engine (0: of all), half its interval, and the days of a month between which it was.
    fn change(engine: usize, step: f64, half: f64, days: [u32; 2]) -> ChangeDocument {
        let instant = |day: u32| format!("2024-10-{day:02}T00:00:00Z");
        ChangeDocument {
            engine: (engine > 0).then_some(engine),
            since: instant(days[0]),
            since_ci95: days.map(instant),
            probability: 1.0,
            step_percent: Figure { value: step, ci95: [step - half, step + half] },
            event: None,
            other_events: Vec::new(),
        }
    }

    fn engines_told(changes: &[ChangeDocument]) -> Vec<usize> {
        told(changes, 2).iter().map(|change| change.engine.unwrap_or(0)).collect()
    }

    /// Engine 2 of two burns 1.88 % more: all together 0.94 %, which 0.87 ± 0.30 holds.
    #[test]
    fn what_one_engine_has_is_told_of_it_alone() {
        let engine = change(2, 1.88, 0.32, [4, 7]);
        assert_eq!(engines_told(&[change(0, 0.87, 0.30, [1, 17]), engine.clone()]), [2]);
        // Another date, or another size, is another event.
        assert_eq!(engines_told(&[change(0, 0.87, 0.30, [8, 17]), engine.clone()]), [0, 2]);
        assert_eq!(engines_told(&[change(0, -0.87, 0.30, [1, 17]), engine.clone()]), [0, 2]);
        // A step that may be none hides nothing.
        assert_eq!(engines_told(&[change(0, 0.5, 0.4, [4, 7]), change(2, 0.6, 0.7, [4, 7])])[0], 0);
        // Of an exchange all engines together show nothing.
        assert_eq!(
            engines_told(&[change(1, 2.0, 0.3, [4, 7]), change(2, -2.0, 0.3, [4, 7])]),
            [1, 2]
        );
    }

    /// Drag of +1.5 % is +1.5 % of each engine's fuel flow.
    #[test]
    fn what_every_engine_has_is_told_of_all() {
        let all = change(0, 1.5, 0.3, [4, 7]);
        let each = |engine| change(engine, 1.6, 0.4, [3, 6]);
        assert_eq!(engines_told(&[all.clone(), each(1), each(2)]), [0]);
        assert_eq!(engines_told(&[all, each(1)]), [0]);
        // The only engine of an aircraft is all engines.
        let alone = [change(0, 1.5, 0.3, [4, 7]), change(1, 1.5, 0.3, [4, 7])];
        assert_eq!(told(&alone, 1).len(), 1);
        assert_eq!(told(&alone, 1)[0].engine, None);
    }
}
