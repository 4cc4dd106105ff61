//! Whether the data is enough for any name.

use std::collections::BTreeMap;

use effects::EffectPoint;

use crate::library::Library;
use crate::output::verdict::{Insufficient, Verdict};
use crate::output::{Diagnosis, Gap, OutsideLibrary};
use crate::residuals::segments::PreparedFlights;
use crate::thresholds::{FEWEST_FLIGHTS_OF_A_NAME, FEWEST_SEGMENTS_OF_A_NAME, LEAST_SPREADS};

/// Why the data is too little for any name.
pub(crate) fn too_little(data: &PreparedFlights<'_>, library: &Library) -> Option<Insufficient> {
    let (flights, segments) = (data.flights.len(), data.segments.len());
    if flights < FEWEST_FLIGHTS_OF_A_NAME {
        return Some(Insufficient::Flights { found: flights, needed: FEWEST_FLIGHTS_OF_A_NAME });
    }
    if segments < FEWEST_SEGMENTS_OF_A_NAME {
        return Some(Insufficient::Segments { found: segments, needed: FEWEST_SEGMENTS_OF_A_NAME });
    }
    if library.effects.is_empty() {
        return Some(Insufficient::NothingTestable);
    }
    let spread = |of: &dyn Fn(&EffectPoint) -> f64| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for row in &data.segments {
            low = low.min(of(&row.point));
            high = high.max(of(&row.point));
        }
        high - low
    };
    let conditions = [
        spread(&|p| p.mach) > LEAST_SPREADS[0],
        spread(&|p| p.pressure_altitude_m) > LEAST_SPREADS[1],
        spread(&|p| p.mass_kg) > LEAST_SPREADS[2],
        spread(&|p| p.static_air_temperature_k) > LEAST_SPREADS[3],
    ];
    if conditions.iter().filter(|varied| **varied).count() < 2 {
        return Some(Insufficient::OneCondition);
    }
    let first = data.segments[0].residual[0];
    if data.segments.iter().all(|row| (row.residual[0] - first).abs() < 1e-12) {
        return Some(Insufficient::ComputedFuelFlow);
    }
    None
}

pub(crate) const fn insufficient(
    flights: usize,
    segments: usize,
    reason: Insufficient,
) -> Diagnosis {
    Diagnosis {
        flights,
        segments,
        gap: Gap::UNMEASURED,
        r#where: vec![],
        causes: vec![],
        contributions: vec![],
        not_testable: vec![],
        verdict: Verdict::InsufficientData(reason),
        addition: None,
        detectable: vec![],
        outside: OutsideLibrary {
            looked_for_all: true,
            probability: 0.0,
            variable: None,
            acts_on: None,
            forms: vec![],
            addition: None,
        },
        held_out: vec![],
        left_out: BTreeMap::new(),
        outliers: vec![],
        notes: vec![],
    }
}
