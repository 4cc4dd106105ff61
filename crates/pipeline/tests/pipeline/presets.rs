//! Recordings in the layouts for which there are presets, from the columns and units that public documentation gives to segments.
//!
//! Each is a steady cruise that is made here, so that the oracle of every mean is what was written into the rows.
#![expect(clippy::unwrap_used, reason = "a test")]

use std::fmt::Write;
use std::path::Path;

use flight::{Segment, Timestamp};
use pipeline::reading::recordings::{self, Mapped};
use pipeline::reading::{Checks, FlightRead};
use report::mapping::{Mapping, Source};
use segmenter::TrimCriteria;

/// Friday 1 March 2024, 8 o'clock UTC.
const BEGINNING_S: i64 = 1_709_280_000;

/// A steady cruise: standard atmosphere, so that no temperature needs to be recorded.
#[derive(Clone, Copy)]
struct Cruise {
    altitude_ft: f64,
    mach: f64,
    /// Kelvin.
    temperature_k: f64,
    mass_kg: f64,
    /// Of all engines, kg/h.
    flow_kg_h: f64,
    /// Of the first row, s since 1970.
    beginning_s: i64,
}

/// The standard atmosphere at 35 000 ft (ICAO Doc 7488): 218.808 K.
const A320: Cruise = Cruise {
    altitude_ft: 35_000.0,
    mach: 0.78,
    temperature_k: 218.808,
    mass_kg: 64_000.0,
    flow_kg_h: 2400.0,
    beginning_s: BEGINNING_S,
};

impl Cruise {
    /// 38.967854 kt is the speed of sound at 1 K.
    fn true_airspeed_kt(self) -> f64 {
        self.mach * 38.967_854 * self.temperature_k.sqrt()
    }

    fn mass_after(self, seconds: f64) -> f64 {
        self.mass_kg - self.flow_kg_h * seconds / 3600.0
    }

    /// Holds what became of its rows against what was written; masses to `mass_kg`.
    fn is_in(self, segments: &[Segment], mass_kg: f64) {
        assert!(!segments.is_empty());
        for segment in segments {
            let (means, start) = (&segment.means, segment.identity.start);
            let of_recording_s = start.as_second() - self.beginning_s;
            let seconds = of_recording_s as f64 + means.time_s;
            close(means.pressure_altitude_m / 0.3048, self.altitude_ft, 10.0);
            close(means.mach, self.mach, 0.0005);
            close(means.static_air_temperature_k, self.temperature_k, 0.1);
            close(means.true_airspeed_m_s * 3600.0 / 1852.0, self.true_airspeed_kt(), 0.2);
            close(means.ground_speed_m_s * 3600.0 / 1852.0, self.true_airspeed_kt() + 20.0, 0.2);
            close(means.fuel_flow_total_kg_s * 3600.0, self.flow_kg_h, 0.002 * self.flow_kg_h);
            close(means.mass_kg, self.mass_after(seconds), mass_kg);
        }
    }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} for {expected} ± {tolerance}");
}

fn read(preset: &str, name: &str, text: &str) -> Vec<FlightRead> {
    let mapping = Mapping::preset(preset).unwrap();
    let criteria = TrimCriteria::ghazi_2020_table_4();
    let (path, checks) = (Path::new(name), Checks::Made);
    let mapped = Mapped { path, mapping: &mapping, criteria: &criteria, checks };
    let mut source = Source::text(text.as_bytes()).unwrap();
    let (flights, refused) = recordings::read(&mapped, &mut source, &recordings::one_by_one);
    assert!(refused.is_empty(), "{refused:?}");
    flights
}

fn codes(flight: &FlightRead) -> Vec<&'static str> {
    let findings = flight.reduced.check.iter().flat_map(|check| &check.findings);
    findings.map(|finding| finding.code).collect()
}

fn instant(seconds: i64) -> Timestamp {
    Timestamp::from_second(seconds).unwrap()
}

/// A number in a row that is one of every so many; nothing in the others.
fn every(rows: usize, row: usize, number: f64) -> String {
    if row.is_multiple_of(rows) { format!("{number:.4}") } else { String::new() }
}

/// Names, units and rates of `FlightDataAnalyzer`'s parameters: slow ones (temperatures every four seconds, gross weight every 64)
/// have no number in the rows between.
#[test]
fn flight_data_analyzer() {
    let mut text = "Timestamp,Altitude STD Smoothed,SAT,TAT,Mach,Airspeed True,Groundspeed,Roll,Drift,Latitude Smoothed,\
                    Longitude Smoothed,Heading True Continuous,Fuel Qty,Eng (1) N1,Eng (2) N1,Eng (1) N2,Eng (2) N2,\
                    Eng (1) Fuel Flow,Eng (2) Fuel Flow,Gross Weight Smoothed,Airspeed,Pitch\n"
        .to_owned();
    let cruise = A320;
    let sat = cruise.temperature_k - 273.15;
    // T0 = T (1 + 0.2 M²).
    let tat = cruise.temperature_k * (1.0 + 0.2 * cruise.mach * cruise.mach) - 273.15;
    for row in 0..1500_usize {
        let second = row as f64;
        let speed = cruise.true_airspeed_kt();
        let mass = cruise.mass_after(second);
        let time = instant(cruise.beginning_s + i64::try_from(row).unwrap());
        let time = time.to_string().replace('T', " ").replace('Z', "");
        let _ = writeln!(
            text,
            "{time},{:.1},{},{},{:.4},{speed:.2},{:.2},0.1,1.5,{:.5},{:.5},90.2,{:.0},85.1,85.2,92.1,92.2,{:.1},{:.1},{},265,2.1",
            cruise.altitude_ft + second % 3.0,
            every(4, row, sat),
            every(4, row, tat),
            cruise.mach,
            speed + 20.0,
            48.0 + 1e-6 * second,
            // East at the ground speed: a minute of longitude at 48° is cos 48° nautical miles.
            2.0 + (speed + 20.0) * second / 3600.0 / 60.0 / 48.0_f64.to_radians().cos(),
            12_000.0 - cruise.flow_kg_h * second / 3600.0,
            0.5 * cruise.flow_kg_h,
            0.5 * cruise.flow_kg_h,
            every(64, row, mass),
        );
    }
    let flights = read("flight-data-analyzer", "F-ABCD_0301.csv", &text);
    assert_eq!(flights.len(), 1);
    let reduced = &flights[0].reduced;
    cruise.is_in(&reduced.segments, 2.0);
    assert_eq!(reduced.engines, Some(2));
    let total_k = reduced.segments[0].means.total_air_temperature_k.unwrap();
    close(total_k, tat + 273.15, 0.1);
    assert_eq!(codes(&flights[0]), Vec::<&str>::new());
}

/// A file of NASA's "Sample Flight Data" as a table with a row for each sixteenth of a second, its fastest rate: parameters have a
/// number at their own rates, which are 16, 8, 4 and 1 a second. Fuel in lb; `time` is in seconds of the day and goes on at midnight.
#[test]
fn nasa_dashlink() {
    const ROWS_A_SECOND: usize = 16;
    let mut text = "time,IVV,ROLL,ALT,MACH,TAS,GS,DA,TH,FF_1,FF_2,FF_3,FF_4,N1_1,N1_2,N1_3,N1_4,N2_1,N2_2,N2_3,N2_4,\
                    SAT,TAT,LATP,LONP,FQTY_1,FQTY_2,FQTY_3,FQTY_4\n"
        .to_owned();
    let tank_lb = 2800.0;
    let kg_per_lb = 0.453_592_37;
    // 232.676 K: the standard atmosphere at 28 000 ft. The preset assumes 30 000 kg without fuel, and 1 January 2001.
    let cruise = Cruise {
        altitude_ft: 28_000.0,
        mach: 0.66,
        temperature_k: 232.676,
        mass_kg: 30_000.0 + 4.0 * tank_lb * kg_per_lb,
        flow_kg_h: 4.0 * 1300.0 * kg_per_lb,
        beginning_s: 978_307_200 + 86_000,
    };
    let speed = cruise.true_airspeed_kt();
    for row in 0..1000 * ROWS_A_SECOND {
        let second = row as f64 / ROWS_A_SECOND as f64;
        let at = |rate: usize, number: f64| every(ROWS_A_SECOND / rate, row, number);
        let tank = ((tank_lb - 1300.0 * second / 3600.0) / 2.0).round() * 2.0;
        let of_four = |number: f64| vec![at(4, number); 4].join(",");
        let _ = writeln!(
            text,
            "{:.4},0.5,{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
            86_000.0 + second,
            at(8, 0.2),
            at(4, cruise.altitude_ft),
            at(4, cruise.mach),
            at(4, speed),
            at(4, speed + 20.0),
            at(4, 1.0),
            at(4, 91.0),
            of_four(1300.0),
            of_four(88.0),
            of_four(93.0),
            at(1, cruise.temperature_k - 273.15),
            at(1, -20.2),
            at(1, 44.0),
            at(1, -93.0 + second / 5000.0),
            vec![at(1, tank); 4].join(","),
        );
    }
    let flights = read("nasa-dashlink", "652200101100500.csv", &text);
    assert_eq!(flights.len(), 1);
    let reduced = &flights[0].reduced;
    cruise.is_in(&reduced.segments, 8.0);
    assert_eq!((reduced.engines, reduced.aircraft_type.as_str()), (Some(4), "RJ85"));
    // One row a second has all numbers, of which two minutes are cut off.
    assert!((850..=882).contains(&reduced.samples), "{}", reduced.samples);
}

/// Rows of two aircraft in the order of time, as a query of `OpenSky`'s state vectors gives them: altitude in steps of 25 ft in metres,
/// speed in m/s, call signs filled up with blanks, moments without a position; TAS, mass and fuel flow joined to them.
#[test]
fn opensky_state_vectors() {
    let mut text = "time,icao24,lat,lon,velocity,heading,vertrate,callsign,onground,alert,spi,squawk,baroaltitude,geoaltitude,\
                    lastposupdate,lastcontact,hour,typecode,TAS,mass,fuelflow\n"
        .to_owned();
    let aircraft = [
        ("3c6444", "DLH400  ", A320),
        ("4ca7b5", "RYR12AB ", Cruise { altitude_ft: 37_000.0, temperature_k: 216.65, ..A320 }),
    ];
    for row in 0..1500_i64 {
        let (second, time) = (row as f64, BEGINNING_S + row);
        for (index, (icao24, callsign, cruise)) in aircraft.into_iter().enumerate() {
            let speed = cruise.true_airspeed_kt();
            let is_seen = row % 97 != 50 + i64::try_from(index).unwrap();
            let sent = |number: f64| if is_seen { format!("{number:.5}") } else { String::new() };
            let _ = writeln!(
                text,
                "{time},{icao24},{},{},{},90.0,0.0,{callsign},false,false,false,1000,{},{},{time}.2,{time}.4,{},A320,{speed:.2},{:.2},{}",
                sent(48.0),
                sent(2.0 + (speed + 20.0) * second / 3600.0 / 60.0 / 48.0_f64.to_radians().cos()),
                sent((speed + 20.0) * 1852.0 / 3600.0),
                sent((cruise.altitude_ft / 25.0).round() * 7.62),
                sent(cruise.altitude_ft * 0.3048 + 150.0),
                time - time % 3600,
                cruise.mass_after(second),
                cruise.flow_kg_h,
            );
        }
    }
    let flights = read("opensky-states", "states.csv", &text);
    assert_eq!(flights.len(), 2);
    for (icao24, callsign, cruise) in aircraft {
        let of_it = |flight: &&FlightRead| flight.reduced.identity.tail == icao24;
        let reduced = &flights.iter().find(of_it).unwrap().reduced;
        assert_eq!(reduced.identity.flight, callsign.trim());
        cruise.is_in(&reduced.segments, 1.0);
    }
}

/// What `traffic` writes of a flight with `Flight.fuelflow()`: instants with an offset, fuel flow in kg/s.
#[test]
fn tables_of_traffic() {
    let mut text = "timestamp,icao24,callsign,registration,typecode,flight_id,latitude,longitude,altitude,groundspeed,track,\
                    vertical_rate,TAS,mass,fuelflow\n"
        .to_owned();
    let cruise = A320;
    let speed = cruise.true_airspeed_kt();
    for row in 0..1200_i64 {
        let second = row as f64;
        let time = instant(cruise.beginning_s + row).to_string();
        let time = time.replace('T', " ").replace('Z', "+00:00");
        let _ = writeln!(
            text,
            "{time},3c6444,DLH400,D-AIZZ,A320,DLH400_001,48.0,{:.5},{},{:.1},90.0,0,{speed:.2},{:.2},{:.6}",
            2.0 + (speed + 20.0) * second / 3600.0 / 60.0 / 48.0_f64.to_radians().cos(),
            cruise.altitude_ft,
            speed + 20.0,
            cruise.mass_after(second),
            cruise.flow_kg_h / 3600.0,
        );
    }
    let flights = read("traffic-tables", "flights.csv", &text);
    assert_eq!(flights.len(), 1);
    assert_eq!(flights[0].reduced.identity.tail, "D-AIZZ");
    cruise.is_in(&flights[0].reduced.segments, 1.0);
}

/// Our own layout of averaged points, in the columns that its preset lists: each row is a segment.
#[test]
fn cruise_points() {
    let mut text = "type,tail,flight,utc,pressure_altitude_ft,mach,sat_degc,tas_kt,ground_speed_kt,gross_mass_kg,fuel_flow_1_kg_h,\
                    fuel_flow_2_kg_h\n"
        .to_owned();
    let cruise = A320;
    let speed = cruise.true_airspeed_kt();
    for point in 0..4_i64 {
        let second = 1800.0 * point as f64;
        let _ = writeln!(
            text,
            "A320,F-ABCD,XX1,{},{},{},{:.3},{speed:.2},{:.2},{:.1},1200,1200",
            instant(cruise.beginning_s + 1800 * point),
            cruise.altitude_ft,
            cruise.mach,
            cruise.temperature_k - 273.15,
            speed + 20.0,
            cruise.mass_after(second),
        );
    }
    let flights = read("cruise-points", "points.csv", &text);
    assert_eq!(flights.len(), 1);
    assert_eq!(flights[0].reduced.segments.len(), 4);
    cruise.is_in(&flights[0].reduced.segments, 0.1);
}
