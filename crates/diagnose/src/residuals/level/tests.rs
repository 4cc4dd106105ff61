use perf_model::LevelFlights;
use test_support::Random;
use test_support::fleet::{Background, Setup, exact_model, fly};

use super::*;
use crate::residuals::whole::WholeModel;
use crate::signals::record::FlightRecord;

/// The oracle is the same computation number by number, as on a processor without vectors: to the bit, inside the table and beside it,
/// in blocks that are full and in one that is not.
#[test]
fn the_same_whatever_the_width_of_vectors() {
    let fleet = fly(93, &Setup { flights: 12, ..Setup::default() }, &[], &Background::default());
    let records: Vec<FlightRecord<'_>> =
        fleet.flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let model = exact_model();
    let taught = Baseline::learn(&model, model.drag_table(), None, &records, None).unwrap();
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
