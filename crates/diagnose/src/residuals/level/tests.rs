use effects::ExtendedModel;
use perf_model::{GuideLevel, GuideLevels, LevelFlights};
use test_support::Random;
use test_support::fleet::{Background, Setup, exact_model, fly};

use super::*;
use crate::residuals::whole::WholeModel;
use crate::signals::record::FlightRecord;

/// What twelve flights teach a model.
fn taught(model: &ExtendedModel, seed: u64) -> Baseline {
    let fleet = fly(seed, &Setup { flights: 12, ..Setup::default() }, &[], &Background::default());
    let records: Vec<FlightRecord<'_>> =
        fleet.flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    Baseline::learn(model, model.drag_table(), None, &records, None).unwrap()
}

/// The oracle is the same computation number by number, as on a processor without vectors: to the bit, inside the table and beside it,
/// in blocks that are full and in one that is not.
#[test]
fn the_same_whatever_the_width_of_vectors() {
    let model = exact_model();
    let taught = taught(&model, 93);
    let whole = WholeModel::new(&model, &taught).unwrap().of_levels().unwrap();
    let mut random = Random::new(4, 1);
    let mut column =
        |from, to| -> Vec<f64> { (0..500).map(|_| random.uniform(from, to)).collect() };
    let (mass_kg, pressure_altitude_m) = (column(24_000.0, 42_000.0), column(9_000.0, 13_500.0));
    let (mach, isa_deviation_k) = (column(0.65, 0.89), column(-15.0, 15.0));
    let flights = LevelFlights {
        mass_kg: &mass_kg,
        pressure_altitude_m: &pressure_altitude_m,
        mach: &mach,
        isa_deviation_k: &isa_deviation_k,
    };
    let mut known = 0;
    model.base().level_blocks(flights, |from, block| {
        let wide = whole.answers(block, LevelQuestion::MeansAndVariances);
        let compute = Compute { model: &whole, block, of_variances: true };
        let one_by_one = pulp::NullaryFnOnce::call(compute);
        for place in (0..block.count).filter(|place| wide.is_known[*place]) {
            known += 1;
            let of = |found: &LevelAnswers| {
                [found.fuel_flow_total_kg_s[place], found.variance[place]].map(f64::to_bits)
            };
            assert_eq!(of(&wide), of(&one_by_one), "point {}", from + place);
        }
    });
    assert!(known > 100, "{known}");
}

/// The oracle is the single prediction: of a model whose drag differs by level, at its levels, between and beyond them.
#[test]
fn drag_by_level_is_that_of_single_predictions() {
    let level = |feet: f64, shares| GuideLevel {
        pressure_altitude_m: PressureAltitude::feet(feet).to_meters(),
        shares,
    };
    let levels = vec![
        level(35_000.0, [-0.02, 0.03, 0.01]),
        level(39_000.0, [0.01, -0.02, 0.015]),
        level(41_000.0, [0.03, 0.01, -0.02]),
    ];
    let levels = GuideLevels::new([(0.25, 0.55), (0.68, 0.86)], levels).unwrap();
    let model = ExtendedModel::from(exact_model().base().clone().with_levels(levels));
    let taught = taught(&model, 94);
    let whole = WholeModel::new(&model, &taught).unwrap();
    let by_levels = whole.of_levels().unwrap();
    let mut random = Random::new(5, 1);
    let mut column =
        |from, to| -> Vec<f64> { (0..300).map(|_| random.uniform(from, to)).collect() };
    let (mass_kg, mach) = (column(24_000.0, 40_000.0), column(0.66, 0.89));
    let isa_deviation_k = column(-10.0, 10.0);
    let mut pressure_altitude_m = column(10_000.0, 13_200.0);
    for (at_m, feet) in pressure_altitude_m.iter_mut().zip([35_000.0, 39_000.0, 41_000.0]) {
        *at_m = PressureAltitude::feet(feet).to_meters();
    }
    let flights = LevelFlights {
        mass_kg: &mass_kg,
        pressure_altitude_m: &pressure_altitude_m,
        mach: &mach,
        isa_deviation_k: &isa_deviation_k,
    };
    let mut known = 0;
    model.base().level_blocks(flights, |from, block| {
        let answers = by_levels.answers(block, LevelQuestion::MeansAndVariances);
        for place in (0..block.count).filter(|place| answers.is_known[*place]) {
            known += 1;
            let point = FlightPoint {
                isa_deviation: units::TemperatureDifference::kelvin(isa_deviation_k[from + place]),
                ..FlightPoint::new(
                    Mass::kilograms(mass_kg[from + place]),
                    PressureAltitude::meters(pressure_altitude_m[from + place]),
                    Mach::new(mach[from + place]),
                )
            };
            let single = whole.of_point(&point).unwrap();
            let ln_kg_s = answers.fuel_flow_total_kg_s[place].ln();
            assert!((ln_kg_s - single.ln_fuel_flow).abs() < 1e-9, "{}", from + place);
            let ratio = (answers.variance[place] / single.variance()).sqrt();
            assert!((ratio - 1.0).abs() < 1e-5, "{}: {ratio}", from + place);
        }
    });
    assert!(known > 100, "{known}");
}
