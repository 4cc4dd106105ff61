//! Segments as flight points: conditions at which a prediction is wanted, and the fuel flow that was recorded there.

use atmos::isa;
use flight::Segment;
use perf_model::FlightPoint;
use units::{
    Angle, FuelFlowTotal, Mach, Mass, OutOfDomain, PressureAltitude, TemperatureDifference,
};

use crate::columns::Columns;
use crate::learnt_flights::instant_after;

const SECONDS_PER_HOUR: f64 = 3600.0;

/// The conditions of a segment, as if it were neither accelerating nor climbing.
///
/// # Errors
/// A pressure altitude outside the atmosphere's domain.
pub fn point_of_segment(segment: &Segment) -> Result<FlightPoint, OutOfDomain> {
    let means = &segment.means;
    let pressure_altitude = PressureAltitude::meters(means.pressure_altitude_m);
    let standard_k = isa::temperature(pressure_altitude)?.to_kelvin();
    let mass = Mass::kilograms(means.mass_kg);
    Ok(FlightPoint {
        isa_deviation: TemperatureDifference::kelvin(means.static_air_temperature_k - standard_k),
        measured_fuel_flow_total: Some(FuelFlowTotal::kilograms_per_second(
            means.fuel_flow_total_kg_s,
        )),
        date: instant_after(segment.identity.start, means.time_s),
        center_of_gravity_percent_mac: means.center_of_gravity_percent_mac,
        anti_ice: means.anti_ice.map(|share| share > 0.5),
        latitude: means.latitude_deg.map(Angle::degrees),
        true_heading: means.true_heading_deg.map(Angle::degrees),
        ..FlightPoint::new(mass, pressure_altitude, Mach::new(means.mach))
    })
}

/// What a row of predictions begins with: which flight, when, and the conditions in the columns of flight points.
pub fn columns_of_segments(segments: &[Segment], points: &[FlightPoint]) -> Columns {
    let mut columns = Columns::default();
    let identities = || segments.iter().map(|segment| &segment.identity);
    columns.text("X-tail", identities().map(|identity| identity.tail.clone()));
    columns.text("X-flight", identities().map(|identity| identity.flight.clone()));
    columns.text(
        "date",
        points.iter().map(|point| point.date.map_or_else(String::new, |date| date.to_string())),
    );
    let mut number = |name: &str, of: fn(&FlightPoint) -> f64| {
        columns.number(name, points.iter().map(|point| Some(of(point))));
    };
    number("mass_kg", |point| point.mass.to_kilograms());
    number("pressure_altitude_ft", |point| point.pressure_altitude.to_feet());
    number("mach", |point| point.mach.value());
    number("isa_deviation_c", |point| point.isa_deviation.to_kelvin());
    columns.number(
        "fuel_flow_recorded_kg_h",
        segments.iter().map(|segment| Some(SECONDS_PER_HOUR * segment.means.fuel_flow_total_kg_s)),
    );
    columns
}
