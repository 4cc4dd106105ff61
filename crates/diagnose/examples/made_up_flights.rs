//! A dozen made-up flights of an aircraft that burns 3 % more than its model says: what could it be, and by how much?
//!
//! The flights are plain numbers: pressure altitude, Mach number, mass and fuel flow of ten segments each. Instead of the
//! prediction times 1.03, put in what an aircraft recorded.
//!
//! `cargo run --release -p cruisefit-diagnose --example made_up_flights`
#![expect(clippy::print_stdout, reason = "an example shows what it does")]

use std::error::Error;
use std::sync::Arc;

use diagnose::{FlightRecord, Input, Options, Verdict, diagnose};
use effects::ExtendedModel;
use flight::effect::EffectId;
use flight::{Cruise, FlightIdentity, Segment, SegmentMeans, Timestamp};
use perf_model::{Aircraft, Guide, initial_model};
use units::{FuelFlowTotal, Mach, Mass, PressureAltitude};

const AIRCRAFT: &str = r#"(
    name: "JSBSim global5000", type_code: "GL5T", engines: 2, wing_area_m2: 94.94690688,
    tsfc: (static_lb_per_lbf_h: 0.657, mach_exponent: 0),
    table: (lift_coefficient: (0.10, 0.80, 0.05), mach: (0.50, 0.95, 0.05)),
)"#;
const GUIDE: &[u8] = include_bytes!("../../perf-model/tests/golden/guide.csv");
const FLIGHTS: u32 = 12;
const SEGMENTS: u32 = 10;
/// Fuel flow that the aircraft burns over what its model says.
const MORE: f64 = 1.03;
/// Noise of fuel flow, uniform, ± this share.
const NOISE: f64 = 0.008;
const DAY_S: i64 = 86_400;

fn main() -> Result<(), Box<dyn Error>> {
    let initial = initial_model(&Aircraft::from_ron(AIRCRAFT)?, &Guide::from_csv(GUIDE)?)?;
    let model = ExtendedModel::from(initial.model);
    let mut noise = Noise(2026);
    let flights: Vec<Vec<Segment>> =
        (0..FLIGHTS).map(|number| fly(&model, number, &mut noise)).collect::<Result<_, _>>()?;
    let records: Vec<FlightRecord<'_>> =
        flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();

    let found = diagnose(&Input::against(&model, &records), &Options::default())?;
    println!("{} flights, {} segments", found.flights, found.segments);
    println!(
        "gap {:+.2} %, noise {:.2} %",
        found.gap.mean_percent, found.gap.noise_floor_rms_percent
    );
    for cause in &found.causes {
        let [low, high] = cause.magnitude.ci95;
        println!(
            "{}: probability {:.2}, size {:.2} ({low:.2} to {high:.2}) {}",
            cause.effect,
            cause.probability,
            cause.magnitude.value,
            cause.effect.entry().unit
        );
    }

    let Verdict::Effects(verdict) = &found.verdict else {
        return Err(format!("no effect is named: {:?}", found.verdict).into());
    };
    // Engines, flow meters and drag look alike in fuel flow alone: the verdict has all of them in its class.
    println!("these flights cannot tell apart: {:?}", verdict.class);
    assert!(verdict.class.contains(&EffectId::TsfcFactor));
    assert!(verdict.class.contains(&EffectId::DragFactor));
    let tsfc = found.causes.iter().find(|cause| cause.effect == EffectId::TsfcFactor);
    let size = tsfc.ok_or("TSFC is among the causes")?.magnitude;
    assert!(size.ci95[0] < 3.0 && 3.0 < size.ci95[1], "{size:?}");
    assert!((size.value - 3.0).abs() < 0.5, "{size:?}");
    Ok(())
}

/// Ten segments of one flight; every flight begins at another mass and at another level.
fn fly(
    model: &ExtendedModel,
    number: u32,
    noise: &mut Noise,
) -> Result<Vec<Segment>, Box<dyn Error>> {
    let identity = Arc::new(FlightIdentity {
        tail: "MADE-UP".to_owned(),
        flight: number.to_string(),
        start: Timestamp::from_second(DAY_S * i64::from(number))?,
    });
    let segment = |index: u32, noise: &mut Noise| -> Result<Segment, Box<dyn Error>> {
        let flight_level = 350.0 + 20.0 * f64::from((number + index / 4) % 4);
        let mach = Mach::new(0.78 + 0.01 * f64::from((2 * number + 3 * index) % 7));
        let mass_kg = 34_000.0 - 500.0 * f64::from(number % 5) - 600.0 * f64::from(index);
        let pressure_altitude = PressureAltitude::feet(100.0 * flight_level);
        let static_air_temperature = atmos::isa::temperature(pressure_altitude)?;
        let mut made_up = Segment {
            identity: Arc::clone(&identity),
            // Sixty samples, two minutes between segments.
            rows: (180 * index..180 * index + 60).collect(),
            means: SegmentMeans {
                time_s: 180.0 * f64::from(index),
                fuel_used_kg: 600.0 * f64::from(index),
                ..SegmentMeans::cruise(&Cruise {
                    pressure_altitude,
                    static_air_temperature,
                    mach,
                    true_airspeed: atmos::airspeed::mach_to_true_airspeed(
                        mach,
                        static_air_temperature,
                    ),
                    mass: Mass::kilograms(mass_kg),
                    fuel_flow_total: FuelFlowTotal::kilograms_per_second(0.5),
                })
            },
            temperature_assumed: false,
        };
        let predicted = model.predict_segment(&made_up, model.drag_table())?.fuel_flow_total;
        made_up.means.fuel_flow_total_kg_s =
            predicted.to_kilograms_per_second() * MORE * (1.0 + NOISE * noise.next());
        Ok(made_up)
    };
    (0..SEGMENTS).map(|index| segment(index, noise)).collect()
}

/// A linear congruential generator: the same flights every time.
struct Noise(u64);

impl Noise {
    /// Uniform between −1 and 1.
    #[expect(clippy::cast_precision_loss, reason = "32 bits")]
    fn next(&mut self) -> f64 {
        // Constants of Knuth's MMIX.
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as f64 / f64::from(1_u32 << 31) - 1.0
    }
}
