use flight::{Cruise, Segment, SegmentMeans};
use units::TemperatureDifference;

use super::functions::Polynomial;
use super::*;
use crate::FlightPoint;

#[test]
fn the_column_holds_what_single_predictions_find() {
    let model = super::super::tests::citation_x();
    let (mut mass_kg, mut altitude_m, mut machs, mut deviations_k) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for step in 0..4000_u32 {
        let share = |of: u32| f64::from(step % of) / f64::from(of);
        mass_kg.push(8_000.0 + 12_000.0 * share(37));
        altitude_m.push(3_000.0 + 18_000.0 * share(61));
        machs.push(0.4 + 0.6 * share(23));
        deviations_k.push(-20.0 + 40.0 * share(7));
    }
    for (place, odd) in [f64::NAN, 0.0, -1.0, f64::INFINITY].into_iter().enumerate() {
        mass_kg[4 * place] = odd;
        altitude_m[4 * place + 1] = 1e5 * odd;
        machs[4 * place + 2] = odd;
        deviations_k[4 * place + 3] = -300.0 * odd.abs();
    }
    let flows = model.fuel_flows_kg_s(LevelFlights {
        mass_kg: &mass_kg,
        pressure_altitude_m: &altitude_m,
        mach: &machs,
        isa_deviation_k: &deviations_k,
    });
    let mut found = 0;
    for (index, flow) in flows.iter().enumerate() {
        let point = FlightPoint {
            isa_deviation: TemperatureDifference::kelvin(deviations_k[index]),
            ..FlightPoint::new(
                Mass::kilograms(mass_kg[index]),
                PressureAltitude::meters(altitude_m[index]),
                Mach::new(machs[index]),
            )
        };
        match model.predict(&point) {
            Ok(single) => {
                let single = single.fuel_flow_total.to_kilograms_per_second();
                assert!((flow / single - 1.0).abs() < 1e-12, "{point:?}: {flow} for {single}");
                found += 1;
            }
            Err(_) => assert!(flow.is_nan(), "{point:?}: {flow}"),
        }
    }
    assert!((400..3600).contains(&found), "{found} of {} are inside the table", flows.len());
}

/// By definition: level flight that is recorded as it is predicted is a segment whose observation has this variance (its
/// derivatives are checked by finite differences elsewhere). By hand, two independent meters of 0.5 % are 0.005²/2 of it.
#[test]
fn the_variance_is_that_of_an_observation() {
    let model = super::super::tests::citation_x();
    let columns = LevelFlights {
        mass_kg: &[13_500.0],
        pressure_altitude_m: &[43_000.0 * 0.3048],
        mach: &[0.82],
        isa_deviation_k: &[5.0],
    };
    let mut compared = 0;
    model.predict_level(columns, |_, predicted| {
        let cruise = Cruise {
            pressure_altitude: PressureAltitude::meters(columns.pressure_altitude_m[0]),
            static_air_temperature: predicted.static_air_temperature,
            mach: predicted.mach,
            true_airspeed: predicted.true_airspeed,
            mass: predicted.mass,
            fuel_flow_total: predicted.fuel_flow_total,
        };
        let segment = Segment {
            rows: (0..8).collect(),
            means: SegmentMeans::cruise(&cruise),
            ..crate::variance::tests::segment()
        };
        let expected = model.observe(&segment).unwrap().variance;
        let found = model.level_variance(predicted, 8);
        assert!((found.segment / expected.segment - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.flight / expected.flight - 1.0).abs() < 1e-9, "{found:?}");
        assert!(found.segment > 0.005 * 0.005 / 2.0, "{found:?}");
        compared += 1;
    });
    assert_eq!(compared, 1);
}

#[test]
fn a_polynomial_meets_the_exponential() {
    // Oracle: the standard library, at points that the fit did not use.
    let polynomial: Polynomial<16> = Polynomial::of((-1.5, 0.5), f64::exp);
    for step in 0..=100 {
        let x = -1.5 + 0.02 * f64::from(step);
        assert!((polynomial.at(x) / x.exp() - 1.0).abs() < 1e-14, "{x}");
    }
}
