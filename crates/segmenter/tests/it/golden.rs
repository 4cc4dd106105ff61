//! Segments of simulated reports against those of an independent implementation of the book's page on stabilised segments:
//! two flights that are shipped with the crate, and all flights of three fleets where the reference results are at hand.

#![expect(clippy::disallowed_methods, reason = "tests read their fixtures")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use flight::Segment;
use segmenter::{Tally, TrimCriteria};
use test_support::{outside_data, reports};

/// Columns of the reference that a segment itself holds, in their order.
const MEANS: [&str; 10] = [
    "time_s",
    "pressure_altitude_m",
    "static_air_temperature_k",
    "mach",
    "true_airspeed_m_s",
    "ground_speed_m_s",
    "acceleration_m_s2",
    "mass_kg",
    "fuel_flow_kg_s",
    "samples",
];

struct Expected {
    rows: Vec<u32>,
    means: [f64; 10],
}

/// Expected segments by flight.
fn read_expected(path: &Path) -> BTreeMap<String, Vec<Expected>> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = |name: &str| names.iter().position(|found| *found == name).unwrap();
    let mut flights = BTreeMap::<String, Vec<Expected>>::new();
    for line in lines {
        let fields: Vec<&str> = line.split(',').collect();
        let rows = fields[at("rows")].split(';').map(|row| row.parse().unwrap()).collect();
        let means = MEANS.map(|name| fields[at(name)].parse().unwrap());
        flights.entry(fields[at("flight")].to_owned()).or_default().push(Expected { rows, means });
    }
    flights
}

fn compare(path: &Path, flights: &BTreeMap<String, Vec<Expected>>) -> Tally {
    let report = reports::read(&fs::read_to_string(path).unwrap());
    let track = track::derive(report).unwrap();
    let segmentation = segmenter::segment(&track, &TrimCriteria::ghazi_2020_table_4());
    let flight = &track.report().header().identity.flight;
    let none = Vec::new();
    let expected = flights.get(flight).unwrap_or(&none);
    assert_eq!(segmentation.segments.len(), expected.len(), "{}", path.display());
    for (segment, expected) in segmentation.segments.iter().zip(expected) {
        assert_eq!(segment.rows, expected.rows, "{}", path.display());
        for ((name, found), expected) in MEANS.iter().zip(means(segment)).zip(expected.means) {
            assert!(
                (found - expected).abs() <= (1e-9 * expected.abs()).max(1e-12),
                "{} {name} {found} {expected}",
                path.display()
            );
        }
    }
    segmentation.tally
}

fn means(segment: &Segment) -> [f64; 10] {
    let means = &segment.means;
    [
        means.time_s,
        means.pressure_altitude_m,
        means.static_air_temperature_k,
        means.mach,
        means.true_airspeed_m_s,
        means.ground_speed_m_s,
        means.acceleration_m_s2,
        means.mass_kg,
        means.fuel_flow_total_kg_s,
        segment.samples() as f64,
    ]
}

#[test]
fn two_shipped_flights() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    let expected = read_expected(&folder.join("SIM-01_segments.csv"));
    assert_eq!(compare(&folder.join("SIM-01_0001.txt"), &expected).segments, 8);
    assert_eq!(compare(&folder.join("SIM-01_0005.txt"), &expected).segments, 17);
}

#[test]
fn all_flights_of_three_fleets() {
    let (Some(golden), Some(data)) =
        (outside_data("golden"), outside_data("data/jsbsim-global5000"))
    else {
        return;
    };
    for (fleet, segments) in [("SIM-01", 248), ("SIM-02", 249), ("SIM-05", 247)] {
        let expected = read_expected(&golden.join(format!("{fleet}_segments.csv")));
        let folder = data.join(fleet);
        let mut reports: Vec<PathBuf> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        reports.sort();
        assert_eq!(reports.len(), 40);
        let mut found = Tally::NOTHING;
        for path in &reports {
            found += compare(path, &expected);
        }
        assert_eq!(found.segments, segments, "{fleet}");
        eprintln!("{fleet}: {found}");
    }
}
