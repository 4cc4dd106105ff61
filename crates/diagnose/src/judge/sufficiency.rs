//! Whether the data is enough for any name.

use std::collections::BTreeMap;

use effects::EffectPoint;

use crate::library::Library;
use crate::output::verdict::{Insufficient, Verdict};
use crate::output::{Diagnosis, Gap, OutsideLibrary};
use crate::residuals::segments::Data;

/// Fewest flights and segments that a name is given on.
const FEWEST_FLIGHTS: usize = 6;
const FEWEST_SEGMENTS: usize = 30;

/// Why the data is too little for any name.
pub(crate) fn too_little(data: &Data<'_>, library: &Library) -> Option<Insufficient> {
    let (flights, segments) = (data.flights.len(), data.segments.len());
    if flights < FEWEST_FLIGHTS {
        return Some(Insufficient::Flights { found: flights, needed: FEWEST_FLIGHTS });
    }
    if segments < FEWEST_SEGMENTS {
        return Some(Insufficient::Segments { found: segments, needed: FEWEST_SEGMENTS });
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
        spread(&|p| p.mach) > 1e-3,
        spread(&|p| p.pressure_altitude_m) > 30.0,
        spread(&|p| p.mass_kg / p.mass_kg.max(1.0)) > 0.0 || spread(&|p| p.mass_kg) > 1.0,
        spread(&|p| p.static_air_temperature_k) > 0.1,
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
        not_testable: vec![],
        verdict: Verdict::InsufficientData(reason),
        addition: None,
        detectable: vec![],
        outside: OutsideLibrary { probability: 0.0, variable: None, acts_on: None },
        left_out: BTreeMap::new(),
        notes: vec![],
    }
}
