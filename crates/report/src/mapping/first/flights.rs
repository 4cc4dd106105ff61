//! What only reading a recording's flights shows: midnight in a count of seconds, and another flight behind a gap.

use flight::column::Column;

use super::super::table::Recording;
use super::super::{Converter, LOW_M, MappedFlight, Mapping, SHORTEST_GAP_S, Source};
use super::points::{LONGEST_STEP_S, median};
use super::times;
use crate::refusal::Refusal;

/// A mass that is larger by more has been taken on board, kg.
const LOADED_KG: f64 = 200.0;

/// The mapping with what its flights show.
pub(super) fn mended(mapping: String, text: &str) -> String {
    let mut passes_midnight = false;
    let mut begins_anew = false;
    let read = each_flight(&mapping, text, |converter, MappedFlight(flight)| {
        passes_midnight |= flight.first_bad.as_ref().is_some_and(Refusal::is_over_midnight);
        begins_anew |= has_another_flight(converter, &flight);
    });
    if read.is_none() {
        return mapping;
    }
    let mapping = if passes_midnight { times::of_day(&mapping) } else { mapping };
    if begins_anew && mapping.contains("\n    flight: FileName") {
        let entry = format!("\n    new_flight_after_s: {SHORTEST_GAP_S},   // ?\n    time:");
        return mapping.replacen("\n    time:", &entry, 1);
    }
    mapping
}

/// Reads flights as far as they can be read; `None` where the mapping cannot read the text.
pub(super) fn each_flight(
    mapping: &str,
    text: &str,
    mut read: impl FnMut(&Converter, MappedFlight),
) -> Option<()> {
    let mut source = Source::text(text.as_bytes()).ok()?;
    let mut stream = source.begin(&Mapping::from_ron(mapping).ok()?, Some("F")).ok()?;
    let converter = stream.converter();
    while let Some(piece) = source.next_piece(&mut stream).ok()? {
        let rows = converter.rows(piece);
        let (flights, _) = stream.add(rows);
        for flight in flights {
            read(&converter, flight);
        }
    }
    for flight in stream.finish() {
        read(&converter, flight);
    }
    Some(())
}

/// Whether behind a gap among samples the aircraft is low, or has more mass.
fn has_another_flight(converter: &Converter, flight: &Recording) -> bool {
    let steps = flight.time_s.windows(2).map(|pair| pair[1] - pair[0]);
    if median(steps.clone().collect()).is_none_or(|step_s| step_s > LONGEST_STEP_S) {
        return false;
    }
    let plan = &converter.layout.plan;
    let altitude = plan.recorded_as(Column::PressureAltitude);
    let of_row = |row: usize| {
        let altitude_m = altitude.map(|altitude| altitude.apply(&flight.numbers, row));
        let mass_kg = plan.gross_mass().map(|mass| mass.apply(&flight.numbers, row));
        (altitude_m.unwrap_or(f64::NAN), mass_kg.unwrap_or(f64::NAN))
    };
    let mut gaps = steps.zip(1..).filter(|(step_s, _)| *step_s >= SHORTEST_GAP_S);
    gaps.any(|(_, row)| {
        let ((_, before_kg), (altitude_m, mass_kg)) = (of_row(row - 1), of_row(row));
        altitude_m < LOW_M || mass_kg > before_kg + LOADED_KG
    })
}
