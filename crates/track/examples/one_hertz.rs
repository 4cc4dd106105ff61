//! A recording of one sample a second becomes a track of one sample a minute.

use flight::{
    FlightIdentity, FuelFlowColumns, OptionalColumns, Report, ReportColumns, ReportHeader,
    Sampling, Timestamp,
};
use units::{GroundSpeed, Mass, PressureAltitude};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let time_s: Vec<f64> = (0..600).map(f64::from).collect();
    let of = |value: f64| vec![value; 600];
    // Ground speed grows by 1 kt a minute, with a gust of ±2 kt every other second.
    let ground_speed_m_s = |time_s: &f64| {
        let gust_kt = if time_s % 2.0 < 0.5 { 2.0 } else { -2.0 };
        GroundSpeed::knots(450.0 + time_s / 60.0 + gust_kt).to_meters_per_second()
    };
    let columns = ReportColumns {
        pressure_altitude_m: of(PressureAltitude::feet(41_000.0).to_meters()),
        static_air_temperature_k: Some(of(217.0)),
        mach: of(0.80),
        true_airspeed_m_s: of(236.0),
        ground_speed_m_s: time_s.iter().map(ground_speed_m_s).collect(),
        roll_deg: Some(of(0.0)),
        drift_deg: Some(of(2.0)),
        n2_percent: Some(vec![of(89.4), of(89.4)]),
        fuel_flow: FuelFlowColumns::Total(of(0.17)),
        fuel_used_kg: time_s.iter().map(|time_s| 600.0 + 0.17 * time_s).collect(),
        time_s,
        optional: OptionalColumns::default(),
    };
    let identity = FlightIdentity {
        tail: "T-001".to_owned(),
        start: "2018-05-20T14:14:21Z".parse::<Timestamp>()?,
        flight: "0007".to_owned(),
    };
    let header = ReportHeader {
        aircraft_type: "C750".to_owned(),
        identity,
        zero_fuel_mass: Mass::kilograms(11_000.0),
        fuel_on_board: Mass::kilograms(3_000.0),
        lower_heating_value_mj_kg: None,
        missing: vec![],
        assumed: vec![],
        notes: vec![],
    };
    let track = track::derive(Report::new(header, columns)?)?;
    assert!(matches!(track.sampling(), Sampling::AveragedToBins { incomplete_bins: 0, .. }));
    assert_eq!(track.report().len(), 10);
    let one_knot_a_minute = GroundSpeed::knots(1.0).to_meters_per_second() / 60.0;
    for acceleration_m_s2 in &track.runs()[0].acceleration_m_s2 {
        assert!((acceleration_m_s2 - one_knot_a_minute).abs() < 1e-12);
    }
    Ok(())
}
