//! How long a search takes: `speed [FLIGHTS]` on the virtual fleet of the tests, `speed SEGMENTS.csv` on another program's
//! data (the columns are those of `Row`, written by `docs/figures/diagnosis_speed.py`). Everything but closure and places:
//! signatures, whitening, evidence of every single effect and pair, refinement, agnostic functions, classes. With `all` as the
//! second argument closure and places too.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::cast_possible_truncation,
    reason = "a measuring tool: it reads files and the memory it took"
)]

use std::sync::Arc;
use std::time::Instant;

use diagnose::{FlightRecord, Input, Options, Verdict, diagnose};
use flight::{FlightIdentity, Segment, SegmentMeans};
use test_support::fleet::{Background, Random, Setup, exact_model, fly, plant};

const RUNS: usize = 7;
const COLUMNS: usize = 18;

fn main() {
    let argument = std::env::args().nth(1).unwrap_or_else(|| "60".to_owned());
    let flights: Vec<Vec<Segment>> = if let Ok(flights) = argument.parse() {
        let id = flight::effect::EffectId::WaveDrag;
        let planted = [plant(id, 1.0, &mut Random::new(1, 9))];
        let setup = Setup { flights, ..Setup::default() };
        fly(1, &setup, &planted, &Background::default()).flights
    } else {
        read(&std::fs::read_to_string(&argument).unwrap())
    };
    let model = exact_model();
    let records: Vec<_> =
        flights.iter().map(|segments| FlightRecord { segments, gauges: None }).collect();
    let input = Input::against(&model, &records);
    let skip = std::env::args().nth(2).as_deref() != Some("all");
    let options = Options { skip_closure: skip, skip_where: skip, ..Options::default() };
    let mut shortest = f64::INFINITY;
    let mut found = None;
    for _ in 0..if records.len() > 600 { 1 } else { RUNS } {
        let begin = Instant::now();
        found = Some(diagnose(&input, &options).unwrap());
        shortest = shortest.min(begin.elapsed().as_secs_f64());
    }
    let found = found.unwrap();
    let peak = std::fs::read_to_string("/proc/self/status").ok().and_then(|status| {
        let line = status.lines().find(|line| line.starts_with("VmHWM"))?.to_owned();
        line.split_whitespace().nth(1).map(str::to_owned)
    });
    println!(
        "segments {} seconds {shortest:.4} peak_kb {} verdict {:?} {}",
        found.segments,
        peak.unwrap_or_default(),
        found.verdict,
        found.causes.first().map_or_else(String::new, |cause| cause.effect.to_string()),
    );
    assert!(!matches!(found.verdict, Verdict::InsufficientData(_)));
}

/// One row a segment: flight, Mach, pressure altitude m, SAT K, mass kg, fuel used kg, latitude, track, cross-wind to the left
/// m/s, ground speed m/s, roll, acceleration, CG %, date s, fuel flow 1 and 2 kg/s, N2 1 and 2 %.
fn read(text: &str) -> Vec<Vec<Segment>> {
    let mut flights: Vec<Vec<Segment>> = Vec::new();
    for (line, row) in text.lines().skip(1).enumerate() {
        let v: Vec<f64> = row.split(',').map(|field| field.parse().unwrap()).collect();
        assert_eq!(v.len(), COLUMNS, "line {line}");
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts")]
        let (flight, date_s) = (v[0] as usize, v[13] as i64);
        if flight >= flights.len() {
            flights.resize(flight + 1, Vec::new());
        }
        let tas = v[1] * (1.4 * 287.05287 * v[3]).sqrt();
        let drift = -(v[8] / tas).clamp(-0.4, 0.4).asin().to_degrees();
        let index = flights[flight].len();
        flights[flight].push(Segment {
            identity: Arc::new(FlightIdentity {
                tail: "T".to_owned(),
                flight: flight.to_string(),
                start: flight::Timestamp::from_second(date_s).unwrap(),
            }),
            rows: (0..10).map(|k| 12 * index as u32 + k).collect(),
            means: SegmentMeans {
                time_s: 720.0 * index as f64,
                pressure_altitude_m: v[2],
                static_air_temperature_k: v[3],
                mach: v[1],
                true_airspeed_m_s: tas,
                ground_speed_m_s: v[9],
                acceleration_m_s2: v[11],
                vertical_speed_m_s: 0.0,
                mass_kg: v[4],
                fuel_flow_total_kg_s: v[14] + v[15],
                fuel_flow_engine_kg_s: vec![v[14], v[15]],
                fuel_used_kg: v[5],
                drift_deg: Some(drift),
                roll_deg: Some(v[10]),
                roll_squared_deg2: Some(v[10] * v[10]),
                n2_percent: vec![v[16], v[17]],
                latitude_deg: Some(v[6]),
                longitude_deg: None,
                true_heading_deg: Some(v[7] - drift),
                center_of_gravity_percent_mac: Some(v[12]),
                total_air_temperature_k: None,
                n1_percent: [None; flight::MAXIMUM_ENGINES],
                exhaust_gas_temperature_k: [None; flight::MAXIMUM_ENGINES],
                fuel_quantity_kg: None,
                anti_ice: None,
            },
            temperature_assumed: false,
        });
    }
    flights.retain(|segments| !segments.is_empty());
    flights
}
