//! Conditions at which effects are zero: means over what a tail is planned to fly.

use units::{Mach, Mass, OutOfDomain, PressureAltitude, TemperatureDifference};

use crate::aircraft::{AircraftTruth, TruthPhysics};
use crate::plan::{FleetDesign, Plan, TailPlan, legs};
use crate::route::{FlightPlan, Loading};
use crate::terms::{References, Terms};
use crate::trim::{TrimPoint, Trimmed, trim_with};
use crate::weather::Weather;

/// Means over the planned legs, each weighted by its time, on the plan's mean day. An estimate before the flights: fuel
/// burnt is that of trimmed points.
pub(crate) fn references_of(
    aircraft: &AircraftTruth,
    physics: TruthPhysics,
    weather: &Weather,
    flights: &[FlightPlan],
) -> Result<References, OutOfDomain> {
    let terms = Terms::new(aircraft, physics);
    let mut sums = Sums::default();
    let mut dates_s: Vec<f64> = Vec::with_capacity(flights.len());
    for flight in flights {
        dates_s.push(flight::seconds_since_1970(flight.start));
        let mut mass_kg = match flight.loading {
            // About a tenth of the fuel is used when the recording starts.
            Loading::ZeroFuel { zero_fuel_mass_kg, fuel_on_board_kg } => {
                zero_fuel_mass_kg + 0.9 * fuel_on_board_kg
            }
            Loading::AtRecording { gross_mass_kg, .. } => gross_mass_kg,
        };
        let (latitude_deg, _) = flight.waypoints[0];
        let season_k = weather.season_at(flight.start, latitude_deg.to_radians());
        let deviation = TemperatureDifference::kelvin(weather.isa_deviation_k.mean + season_k);
        let legs = legs(flight);
        for (index, (from_s, feet, mach)) in legs.iter().enumerate() {
            let to_s = legs.get(index + 1).map_or(flight.duration_s, |next| next.0);
            let length_s = (to_s.min(flight.duration_s) - from_s).max(0.0);
            let pressure_altitude = PressureAltitude::feet(*feet);
            let sat = atmos::isa::temperature(pressure_altitude)? + deviation;
            let middle_s = from_s + 0.5 * length_s;
            let center = flight.center_of_gravity_percent_mac
                + flight.center_of_gravity_travel_percent_mac_h * middle_s / 3600.0;
            let point = TrimPoint {
                mass: Mass::kilograms(mass_kg),
                pressure_altitude,
                mach: Mach::new(*mach),
                sat,
                center_of_gravity_percent_mac: center,
            };
            let trimmed = trim_with(aircraft, &terms, &point)?;
            sums.add(length_s, &point, &trimmed);
            mass_kg -= length_s * trimmed.fuel_flow_kg_s;
        }
    }
    let [date_s, first_date_s, last_date_s] = mean_first_last(&dates_s);
    Ok(sums.means(date_s, first_date_s, last_date_s))
}

/// The references of every tail: those of its plan, else the means over its own flights. Effects that all tails share are
/// zero at the means over all flights, or each tail would have another effect; dates are the tail's own. The tails of a fleet,
/// the last ones, share conditions and dates; other tails of its plan share the conditions.
pub(crate) fn references_of_tails(
    plan: &Plan,
    (tails, aircraft): (&[TailPlan], &AircraftTruth),
    flown: &[(Vec<FlightPlan>, Option<FleetDesign>)],
) -> Result<Vec<References>, OutOfDomain> {
    let of = |flights: &[FlightPlan]| references_of(aircraft, plan.physics, &plan.weather, flights);
    let fleet_from = if plan.fleet.is_some() { plan.tails.len() } else { flown.len() };
    let shared = if fleet_from < flown.len() {
        let all: Vec<FlightPlan> =
            flown[fleet_from..].iter().flat_map(|(flights, _)| flights).cloned().collect();
        Some(of(&all)?)
    } else if plan.effects.is_empty() || flown.len() < 2 {
        None
    } else {
        let all: Vec<FlightPlan> = flown.iter().flat_map(|(flights, _)| flights).cloned().collect();
        Some(of(&all)?)
    };
    let of_tail =
        |(place, (tail, (flights, _))): (usize, (&TailPlan, &(Vec<FlightPlan>, _)))| match (
            tail.references,
            shared,
        ) {
            (Some(given), _) => Ok(given),
            (None, None) => of(flights),
            (None, Some(shared)) if place >= fleet_from => Ok(shared),
            (None, Some(shared)) => Ok(dated_by(shared, flights)),
        };
    tails.iter().zip(flown).enumerate().map(of_tail).collect()
}

/// These conditions with the dates of these flights.
fn dated_by(references: References, flights: &[FlightPlan]) -> References {
    let dates_s: Vec<f64> =
        flights.iter().map(|flight| flight::seconds_since_1970(flight.start)).collect();
    let [date_s, first_date_s, last_date_s] = mean_first_last(&dates_s);
    References { date_s, first_date_s, last_date_s, ..references }
}

fn mean_first_last(dates_s: &[f64]) -> [f64; 3] {
    let mean = dates_s.iter().sum::<f64>() / dates_s.len() as f64;
    let first = dates_s.iter().copied().fold(f64::INFINITY, f64::min);
    let last = dates_s.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [mean, first, last]
}

#[derive(Default)]
struct Sums {
    weight: f64,
    mach: f64,
    lift_coefficient: f64,
    reynolds_number: f64,
    temperature_ratio: f64,
    corrected_thrust: f64,
    fuel_flow: f64,
    mass: f64,
    center_of_gravity: f64,
}

impl Sums {
    fn add(&mut self, weight: f64, point: &TrimPoint, trimmed: &Trimmed) {
        self.weight += weight;
        self.mach += weight * point.mach.value();
        self.lift_coefficient += weight * trimmed.lift_coefficient;
        self.reynolds_number += weight * trimmed.reynolds_number;
        self.temperature_ratio += weight * atmos::isa::temperature_ratio(point.sat);
        self.corrected_thrust += weight * trimmed.thrust_n / trimmed.pressure_ratio;
        self.fuel_flow += weight * trimmed.fuel_flow_kg_s;
        self.mass += weight * point.mass.to_kilograms();
        self.center_of_gravity += weight * point.center_of_gravity_percent_mac;
    }

    fn means(&self, date_s: f64, first_date_s: f64, last_date_s: f64) -> References {
        let mean = |sum: f64| sum / self.weight;
        References {
            mach: mean(self.mach),
            lift_coefficient: mean(self.lift_coefficient),
            reynolds_number: mean(self.reynolds_number),
            temperature_ratio: mean(self.temperature_ratio),
            corrected_thrust_n: mean(self.corrected_thrust),
            fuel_flow_kg_s: mean(self.fuel_flow),
            mass_kg: mean(self.mass),
            center_of_gravity_percent_mac: mean(self.center_of_gravity),
            date_s,
            first_date_s,
            last_date_s,
        }
    }
}
