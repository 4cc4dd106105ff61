//! Flights of a case as every command reduces them: what `simulate` and `diagnose` do through files, without the files.

use diagnose::FlightRecord;
use pipeline::reduction::ReducedFlight;
use segmenter::TrimCriteria;
use simulate::{Simulation, SimulationError};

use crate::failure::CaseFailure;

/// Flies, derives, segments. A flight that the weather does not allow is left out; the number of flights that were
/// diagnosed is in every result.
pub(crate) fn fly(
    simulation: &Simulation,
    indices: std::ops::Range<usize>,
) -> Result<Vec<ReducedFlight>, CaseFailure> {
    let criteria = TrimCriteria::ghazi_2020_table_4();
    let planned = indices.len();
    let mut flown = Vec::with_capacity(planned);
    for index in indices {
        match simulation.fly(index) {
            Ok(flight) => {
                flown.push(ReducedFlight::from_report(flight.report, &criteria, Vec::new())?);
            }
            // A day too warm for the planned level: nobody flies there.
            Err(SimulationError::Flight { .. }) => {}
            Err(error) => return Err(error.into()),
        }
    }
    if 10 * flown.len() < 9 * planned {
        return Err(CaseFailure::NotFlown { flown: flown.len(), planned });
    }
    Ok(flown)
}

/// Flights with segments, as the diagnosis takes them.
pub(crate) fn records(flights: &[ReducedFlight]) -> Vec<FlightRecord<'_>> {
    flights
        .iter()
        .filter(|flight| !flight.segments.is_empty())
        .map(|flight| FlightRecord { segments: &flight.segments, gauges: flight.gauges })
        .collect()
}
