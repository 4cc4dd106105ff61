//! What the other tests' virtual twin does not have: three and four engines, tank gauges.
#![expect(clippy::unwrap_used, reason = "a test")]

use std::sync::Arc;

use diagnose::{
    Baseline, Diagnosis, FlightRecord, GaugeBurn, Input, Options, Region, Verdict, diagnose,
};
use effects::ExtendedModel;
use flight::Segment;
use flight::effect::EffectId;
use lut::surface::{Basis, Surface};
use perf_model::{Aircraft, PerformanceModel};
use test_support::Random;
use test_support::fleet::{Background, Planted, Setup, exact_model, fly};

/// Relative standard deviation of the virtual fleet's total fuel flow: its two meters have 0.7071 % each.
const TOTAL_DEVIATION: f64 = 0.005;

/// The virtual aircraft with another number of engines, whose meters together are as exact as the twin's.
fn model_with(engines: u32) -> ExtendedModel {
    let percent = 100.0 * TOTAL_DEVIATION * f64::from(engines).sqrt();
    let text = format!(
        r#"(
            name: "virtual", type_code: "VIRT", engines: {engines}, wing_area_m2: 48.96,
            tsfc: (static_lb_per_lbf_h: 0.48, mach_exponent: 0.8),
            table: (lift_coefficient: (0.08, 0.72, 0.005), mach: (0.50, 0.95, 0.005)),
            sensors: (
                fuel_flow_percent: {percent}, mass: Percent(0.6),
                flight_bias: (mach: 0, static_air_temperature_k: 0, n2_percent: 0, pressure_altitude_m: 0),
            ),
        )"#
    );
    let aircraft = Aircraft::from_ron(&text).unwrap();
    let grid = Arc::clone(aircraft.grid());
    let values = exact_model().drag_table().values().to_vec();
    let (marks, table) = (vec![false; values.len()], lut::Table::new(grid, values).unwrap());
    let polynomial = Surface { basis: Basis::SeparableQuadratic, coefficients: [0.0; 6] };
    PerformanceModel::new(aircraft, polynomial, table, marks).unwrap().into()
}

/// Flights of that aircraft: what the twin burnt, shared by all engines, each with its own meter; the last burns more.
fn flights_with(engines: u32, more_percent: f64) -> Vec<Vec<Segment>> {
    let mut flights = fly(501, &Setup::default(), &[], &Background::default()).flights;
    let count = engines as usize;
    let deviation = TOTAL_DEVIATION * f64::from(engines).sqrt();
    let mut random = Random::new(502, 0);
    for means in flights.iter_mut().flatten().map(|segment| &mut segment.means) {
        let noise: Vec<f64> = (0..count).map(|_| random.normal(0.0, deviation)).collect();
        let mean = noise.iter().sum::<f64>() / f64::from(engines);
        let share = means.fuel_flow_total_kg_s / f64::from(engines);
        let mut flows: Vec<f64> = noise.iter().map(|e| share * (1.0 + e - mean)).collect();
        flows[count - 1] *= 1.0 + more_percent / 100.0;
        means.fuel_flow_total_kg_s = flows.iter().sum();
        means.fuel_flow_engine_kg_s = flows;
        means.n2_percent.clear();
    }
    flights
}

fn records(
    flights: &[Vec<Segment>],
    gauges: impl Fn(usize) -> Option<GaugeBurn>,
) -> Vec<FlightRecord<'_>> {
    let record = |(flight, segments)| FlightRecord { segments, gauges: gauges(flight) };
    flights.iter().map(Vec::as_slice).enumerate().map(record).collect()
}

fn diagnosed(
    model: &ExtendedModel,
    flights: &[Vec<Segment>],
    gauges: impl Fn(usize) -> Option<GaugeBurn>,
) -> Diagnosis {
    let records = records(flights, gauges);
    let input = Input::against(model, &records);
    diagnose(&input, &Options { skip_closure: true, ..Options::default() }).unwrap()
}

/// The last engine burns 3 % more: all of them together 3/n %.
#[test]
fn one_engine_of_three_and_of_four() {
    for engines in [3, 4] {
        let model = model_with(engines);
        let last = u8::try_from(engines).unwrap();
        let found = diagnosed(&model, &flights_with(engines, 3.0), |_| None);
        let first = &found.causes[0];
        assert_eq!(first.effect, EffectId::TsfcEngine(last), "{:?}", found.verdict);
        assert!(first.probability > 0.9, "{engines} engines: {first:?}");
        let [low, high] = first.magnitude.ci95;
        assert!(low < 3.0 && 3.0 < high && high - low < 1.5, "{engines} engines: {first:?}");
        let place = &found.r#where[0];
        assert_eq!(place.region, Region { engine: Some(last), conditions: vec![] });
        assert!(place.ci95[0] < 3.0 && 3.0 < place.ci95[1], "{engines} engines: {place:?}");
        let mean = found.gap.mean_percent;
        assert!((mean - 3.0 / f64::from(engines)).abs() < 0.2, "{engines} engines: {mean} %");
        // With nothing wrong nothing is found.
        let silent = diagnosed(&model, &flights_with(engines, 0.0), |_| None);
        assert_eq!(silent.verdict, Verdict::NoGap, "{engines} engines");
    }
}

/// Gauges read 1.5 % less than is burnt, at all times. Then engines burn 2 % more, or meters read 2 % high: the same flights but for
/// what the gauges show.
#[test]
fn gauges_distinguish_meters_from_engines() {
    const METERED_KG: f64 = 4000.0;
    let gauged = |burnt_kg: f64| {
        move |flight: usize| {
            // Errors of half the gauges' standard deviation, up and down.
            let error_kg = if flight.is_multiple_of(2) { 8.0 } else { -8.0 };
            Some(GaugeBurn {
                gauged_kg: 0.985 * burnt_kg + error_kg,
                metered_kg: METERED_KG,
                deviation_kg: 16.0,
            })
        }
    };
    let model = exact_model();
    let clean = fly(504, &Setup::default(), &[], &Background::default()).flights;
    let learn = |gauges: &dyn Fn(usize) -> Option<GaugeBurn>| {
        let records = records(&clean, gauges);
        Baseline::learn(&model, model.drag_table(), None, &records, None).unwrap()
    };
    let planted = Planted { id: EffectId::FuelFlowGain, size: 2.0 };
    let later = fly(503, &Setup::default(), &[planted], &Background::default()).flights;
    let found = |taught: &Baseline, gauges: &dyn Fn(usize) -> Option<GaugeBurn>| {
        let records = records(&later, gauges);
        let options = Options { skip_closure: true, ..Options::default() };
        let input = Input { baseline: Some(taught), ..Input::against(&model, &records) };
        diagnose(&input, &options).unwrap()
    };
    let probability = |found: &Diagnosis, effect: EffectId| {
        let cause = found.causes.iter().find(|cause| cause.effect == effect);
        cause.map_or(0.0, |cause| cause.probability)
    };
    let taught = learn(&gauged(METERED_KG));
    let level = taught.gauges().unwrap();
    assert!((level.mean - 0.985_f64.ln()).abs() < 2.0 * level.deviation, "{level:?}");
    let meters = found(&taught, &gauged(METERED_KG / 1.02));
    assert_eq!(meters.causes[0].effect, EffectId::FuelFlowGain, "{:?}", meters.verdict);
    assert!(probability(&meters, EffectId::FuelFlowGain) > 0.9, "{:?}", meters.causes);
    let [low, high] = meters.causes[0].magnitude.ci95;
    assert!(low < 2.0 && 2.0 < high, "{:?}", meters.causes[0]);
    let engines = found(&taught, &gauged(METERED_KG));
    assert!(probability(&engines, EffectId::FuelFlowGain) < 0.02, "{:?}", engines.causes);
    // Nobody knows how the gauges read before, and they may be off by as much: they move the odds by less than five.
    let odds = |found: &Diagnosis| {
        probability(found, EffectId::FuelFlowGain) / probability(found, EffectId::TsfcFactor)
    };
    let untaught = learn(&|_| None);
    let without = found(&untaught, &|_| None);
    let unknown = found(&untaught, &gauged(METERED_KG));
    let moved = odds(&unknown) / odds(&without);
    assert!((0.2..5.0).contains(&moved), "{moved}: {:?} {:?}", without.causes, unknown.causes);
}
