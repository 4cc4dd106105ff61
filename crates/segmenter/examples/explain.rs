//! Where forty minutes of cruise go: a change of speed, a bumpy minute, and what is left.

use flight::{
    FlightIdentity, FuelFlowColumns, OptionalColumns, Report, ReportColumns, ReportHeader,
    SampleRun, Sampling, TemperatureSource, Timestamp, Track, TrackParts,
};
use segmenter::{Criterion, TrimCriteria, segment};
use units::{GroundSpeed, Mass, PressureAltitude};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let of = |value: f64| vec![value; 40];
    // Minutes 12 to 16: 0.005 Mach a minute faster. Minute 30: 2° of roll.
    let mach = (0..40_i32).map(|minute| 0.78 + 0.005 * f64::from((minute - 12).clamp(0, 4)));
    let columns = ReportColumns {
        time_s: (0..40).map(|minute| 60.0 * f64::from(minute)).collect(),
        pressure_altitude_m: of(PressureAltitude::feet(41_000.0).to_meters()),
        static_air_temperature_k: Some(of(217.0)),
        mach: mach.collect(),
        true_airspeed_m_s: of(236.0),
        ground_speed_m_s: of(GroundSpeed::knots(450.0).to_meters_per_second()),
        roll_deg: Some((0..40).map(|minute| if minute == 30 { 2.0 } else { 0.0 }).collect()),
        drift_deg: Some(of(2.0)),
        n2_percent: None,
        fuel_flow: FuelFlowColumns::Total(of(0.17)),
        fuel_used_kg: of(600.0),
        optional: OptionalColumns::default(),
    };
    let header = ReportHeader {
        aircraft_type: "C750".to_owned(),
        identity: FlightIdentity {
            tail: "T-001".to_owned(),
            start: "2018-05-20T14:14:21Z".parse::<Timestamp>()?,
            flight: "0007".to_owned(),
        },
        zero_fuel_mass: Mass::kilograms(11_000.0),
        fuel_on_board: Mass::kilograms(3_000.0),
        lower_heating_value_mj_kg: None,
        missing: vec![flight::MissingColumn::N2],
        assumed: vec![],
        notes: vec![],
    };
    // The crate `track` derives these; without wind or climb the rates are zero.
    let run = SampleRun { samples: 0..40, acceleration_m_s2: of(0.0), vertical_speed_m_s: of(0.0) };
    let track = Track::new(TrackParts {
        report: Report::new(header, columns)?,
        sampling: Sampling::AsSent,
        sample_interval_s: 60.0,
        static_air_temperature_k: of(217.0),
        temperature_source: TemperatureSource::Recorded,
        mass_kg: of(13_400.0),
        runs: vec![run],
        dropped_runs: vec![],
    })?;

    let segmentation = segment(&track, &TrimCriteria::ghazi_2020_table_4());
    assert_eq!(
        segmentation.tally.to_string(),
        "40 samples: 32 kept in 4 segments; 6 unsteady (MACH 5, 5 alone; ROLL 1, 1 alone); \
         0 filtered out; 2 in dropped pieces (1 piece too short, 0 of one sample); \
         not evaluated: N2"
    );
    assert_eq!(segmentation.tally.cost(Criterion::Mach).unsteady, 5);
    Ok(())
}
