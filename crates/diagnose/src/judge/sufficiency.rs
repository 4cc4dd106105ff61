//! Whether the data is enough for any name.

use effects::EffectPoint;

use crate::library::Library;
use crate::output::{Diagnosis, Gap, OutsideLibrary, Verdict, VerdictKind};
use crate::residuals::segments::PreparedFlights;
use crate::thresholds::{FEWEST_FLIGHTS_OF_A_NAME, FEWEST_SEGMENTS_OF_A_NAME, LEAST_SPREADS};

/// Why the data is too little for any name.
pub(crate) fn too_little(data: &PreparedFlights<'_>, library: &Library) -> Option<String> {
    let (flights, segments) = (data.flights.len(), data.segments.len());
    if flights < FEWEST_FLIGHTS_OF_A_NAME {
        return Some(format!("{flights} flights, at least {FEWEST_FLIGHTS_OF_A_NAME} are needed"));
    }
    if segments < FEWEST_SEGMENTS_OF_A_NAME {
        return Some(format!(
            "{segments} segments, at least {FEWEST_SEGMENTS_OF_A_NAME} are needed"
        ));
    }
    if library.effects.is_empty() {
        return Some("no effect of the library can be tested".to_owned());
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
        spread(&|p| p.mass_kg / p.mass_kg.max(1.0)) > 0.0
            || spread(&|p| p.mass_kg) > LEAST_SPREADS[2],
        spread(&|p| p.static_air_temperature_k) > LEAST_SPREADS[3],
    ];
    if conditions.iter().filter(|varied| **varied).count() < 2 {
        return Some("all segments were flown at the same conditions".to_owned());
    }
    let first = data.segments[0].residual[0];
    if data.segments.iter().all(|row| (row.residual[0] - first).abs() < 1e-12) {
        return Some(
            "the residuals of all segments are equal: fuel flow was computed, not measured"
                .to_owned(),
        );
    }
    None
}

pub(crate) fn insufficient(flights: usize, segments: usize, reason: &str) -> Diagnosis {
    Diagnosis {
        tail: String::new(),
        flights,
        segments,
        gap: Gap {
            mean_percent: 0.0,
            rms_percent: 0.0,
            rms_ci95: [0.0; 2],
            noise_floor_rms_percent: 0.0,
            floor_by_replicates_rms_percent: None,
            floor_by_held_out_fit_rms_percent: None,
            detected: false,
            p_value: 1.0,
        },
        r#where: vec![],
        causes: vec![],
        not_testable: vec![],
        verdict: Verdict {
            kind: VerdictKind::InsufficientData,
            effects: vec![],
            class: vec![],
            probability: 0.0,
            closure: None,
            closure_ci95: None,
            advice: format!("Too little data: {reason}."),
            separations: vec![],
        },
        addition: None,
        detectable: vec![],
        outside: OutsideLibrary { probability: 0.0, variable: None, acts_on: None },
        left_out: std::collections::BTreeMap::new(),
        notes: vec![],
    }
}
