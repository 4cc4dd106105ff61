//! `fleet.csv`: tails × effects.

use super::{DiagnosedFleet, level_name};
use crate::columns::Columns;
use crate::diagnosed_tail::POOL;

/// One row per tail (`*` for the type) and effect.
#[must_use]
pub fn fleet_table(fleets: &[DiagnosedFleet]) -> Columns {
    let mut rows = Vec::new();
    for fleet in fleets {
        let diagnosis = &fleet.diagnosis;
        let tails = core::iter::once(None).chain((0..fleet.tails.len()).map(Some));
        for (tail, effect) in
            tails.flat_map(|tail| (0..diagnosis.effects.len()).map(move |effect| (tail, effect)))
        {
            let size = match tail {
                None => diagnosis.of_type[effect],
                Some(tail) => diagnosis.of_tails[tail][effect],
            };
            let id = diagnosis.effects[effect];
            let found =
                diagnosis.findings.iter().find(|found| found.tail == tail && found.effect == id);
            rows.push((fleet, tail, id, size, found));
        }
    }
    let mut columns = Columns::default();
    columns.text("aircraft_type", rows.iter().map(|row| row.0.aircraft_type.clone()));
    let name = |fleet: &DiagnosedFleet, tail: Option<usize>| {
        tail.map_or_else(|| POOL.to_owned(), |tail| fleet.tails[tail].tail.clone())
    };
    columns.text("tail", rows.iter().map(|row| name(row.0, row.1)));
    columns.text("effect", rows.iter().map(|row| row.2.to_string()));
    columns.text("unit", rows.iter().map(|row| row.2.entry().unit.to_owned()));
    columns.number("size", rows.iter().map(|row| Some(row.3.value)));
    // No size was believed where both ends are one: that is no interval of anything.
    let end = |row: &(_, _, _, diagnose::Magnitude, _), end: usize| {
        let [low, high] = row.3.ci95;
        (low < high).then(|| row.3.ci95[end])
    };
    columns.number("size_ci95_low", rows.iter().map(|row| end(row, 0)));
    columns.number("size_ci95_high", rows.iter().map(|row| end(row, 1)));
    let level = |row: &(_, _, _, _, Option<&diagnose::FleetFinding>)| {
        row.4.map_or_else(String::new, |found| level_name(found.level).to_owned())
    };
    columns.text("level", rows.iter().map(level));
    columns.number("probability", rows.iter().map(|row| row.4.map(|found| found.probability)));
    let class = |found: &diagnose::FleetFinding| {
        found.class.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
    };
    columns.text("class", rows.iter().map(|row| row.4.map_or_else(String::new, class)));
    columns
}
