//! Fleets drawn from ranges, wide enough that the effects of a diagnosis can be distinguished.
//!
//! Two thirds of the flights are at cruise altitude, a third lower and slower; masses, centers of gravity, dates, latitudes,
//! tracks, changes of level and speed and anti-ice are spread independently of each other.

use flight::Timestamp;
use serde::{Deserialize, Serialize};
use units::{OutOfDomain, PressureAltitude, check_within};

mod margins;

use margins::can_be_flown;

use super::{MOST_FLIGHTS, PlanError};
use crate::aircraft::AircraftTruth;
use crate::random::{Purpose, Stream, Streams};
use crate::route::{Change, FlightPlan, Loading};
use crate::vector::Place;

/// A fleet's ranges. What is left out is derived from the aircraft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FleetDesign {
    /// How many flights.
    pub flights: usize,
    /// First and last date.
    #[serde(with = "dates")]
    pub dates: (Timestamp, Timestamp),
    /// Length of a recording, h.
    pub duration_h: (f64, f64),
    /// Share of low and slow flights.
    pub low_share: f64,
    /// Pressure altitudes of the others, ft.
    pub high_ft: Option<(f64, f64)>,
    /// Pressure altitudes of low flights, ft.
    pub low_ft: Option<(f64, f64)>,
    /// Mach numbers of the others.
    pub high_mach: Option<(f64, f64)>,
    /// Mach numbers of low flights.
    pub low_mach: Option<(f64, f64)>,
    /// Fuel on board at engine start over maximum fuel.
    pub fuel_share: (f64, f64),
    /// Centers of gravity, %MAC.
    pub center_of_gravity_percent_mac: Option<(f64, f64)>,
    /// Latitudes of the start, degrees.
    pub latitude_deg: (f64, f64),
    /// Step climbs and descents per hour.
    pub level_changes_per_h: f64,
    /// Size of one, ft.
    pub level_change_ft: f64,
    /// Speed changes per hour.
    pub speed_changes_per_h: f64,
    /// Standard deviation of one, Mach.
    pub speed_change_mach: f64,
    /// Turns per hour.
    pub turns_per_h: f64,
    /// Share of flights in air warm enough for ice that use anti-ice.
    pub anti_ice_share: f64,
}

impl Default for FleetDesign {
    /// Sixty flights of two hours within 1.6 years, spread as in the gap diagnosis' prototype.
    fn default() -> Self {
        Self {
            flights: 60,
            dates: (Timestamp::constant(1_515_153_600, 0), Timestamp::constant(1_565_870_400, 0)),
            duration_h: (2.0, 2.0),
            low_share: 0.30,
            high_ft: None,
            low_ft: None,
            high_mach: None,
            low_mach: None,
            fuel_share: (0.62, 0.98),
            center_of_gravity_percent_mac: None,
            latitude_deg: (25.0, 58.0),
            level_changes_per_h: 0.4,
            level_change_ft: 2000.0,
            speed_changes_per_h: 0.6,
            speed_change_mach: 0.02,
            turns_per_h: 0.3,
            anti_ice_share: 0.8,
        }
    }
}

/// Draws for one flight before the ranges count as infeasible.
const TRIES: usize = 500;
/// Between the end of a recording and the START of the next one, s: descent, turnaround and climb at the least.
const TURNAROUND_S: i64 = 3600;
/// Anti-ice is used in air warmer than this at the start, K: −45 °C of the standard day.
const ICE_K: f64 = 228.15;

struct Ranges {
    feet: (f64, f64),
    mach: (f64, f64),
}

impl FleetDesign {
    /// The flights of a tail.
    pub(crate) fn draw(
        &self,
        aircraft: &AircraftTruth,
        seed: u64,
        tail: &str,
    ) -> Result<Vec<FlightPlan>, PlanError> {
        self.check(aircraft)?;
        let first_s = self.dates.0.as_second();
        let last_s = self.dates.1.as_second().max(first_s);
        let mut starts: Vec<i64> = {
            let mut random = Streams::of_tail(seed, tail).stream(Purpose::Design);
            let span = (last_s - first_s) as f64;
            #[expect(clippy::cast_possible_truncation, reason = "seconds, far below 2^53")]
            (0..self.flights).map(|_| first_s + (random.unit() * span) as i64 / 60 * 60).collect()
        };
        starts.sort_unstable();
        let mut free_s = i64::MIN;
        starts
            .into_iter()
            .enumerate()
            .map(|(index, start_s)| {
                let Some(mut plan) = self.draw_again(aircraft, seed, tail, index)? else {
                    return Err(PlanError::Infeasible { tail: tail.to_owned(), tries: TRIES });
                };
                // One aircraft does not fly twice at a time.
                let start_s = start_s.max(free_s);
                #[expect(clippy::cast_possible_truncation, reason = "seconds of a day at most")]
                let flown_s = plan.duration_s as i64;
                free_s = start_s + flown_s + TURNAROUND_S;
                plan.flight = format!("{:04}", index + 1);
                plan.start = Timestamp::from_second(start_s).unwrap_or(self.dates.0);
                Ok(plan)
            })
            .collect()
    }

    /// Another draw of a flight, without name and START; `None` where none within the ranges can be flown.
    pub(crate) fn draw_again(
        &self,
        aircraft: &AircraftTruth,
        seed: u64,
        tail: &str,
        key: usize,
    ) -> Result<Option<FlightPlan>, PlanError> {
        let mut random = Streams::of_flight(seed, tail, key).stream(Purpose::Design);
        for _ in 0..TRIES {
            if let Some(plan) = self.draw_flight(aircraft, &mut random)? {
                return Ok(Some(plan));
            }
        }
        Ok(None)
    }

    fn draw_flight(
        &self,
        aircraft: &AircraftTruth,
        random: &mut Stream,
    ) -> Result<Option<FlightPlan>, OutOfDomain> {
        let low = random.chance(self.low_share);
        let ranges = self.ranges(aircraft, low);
        // Levels are multiples of 1 000 ft.
        let feet = (random.uniform(ranges.feet.0, ranges.feet.1) / 1000.0).round() * 1000.0;
        let mach = (random.uniform(ranges.mach.0, ranges.mach.1) * 1000.0).round() / 1000.0;
        let duration_s =
            (3600.0 * random.uniform(self.duration_h.0, self.duration_h.1) / 60.0).round() * 60.0;
        let masses = &aircraft.masses;
        let zero_fuel_mass_kg =
            random.uniform(masses.operating_empty_kg, masses.maximum_zero_fuel_kg);
        let fuel_on_board_kg = (masses.maximum_fuel_kg
            * random.uniform(self.fuel_share.0, self.fuel_share.1))
        .min(masses.maximum_take_off_kg - zero_fuel_mass_kg);
        let center = self.center_of_gravity_percent_mac.unwrap_or((
            aircraft.airframe.trim.reference_percent_mac - 8.0,
            aircraft.airframe.trim.reference_percent_mac + 6.0,
        ));
        let mut plan = FlightPlan {
            flight: String::new(),
            start: self.dates.0,
            duration_s,
            waypoints: self.draw_route(duration_s, random),
            pressure_altitude_ft: feet,
            mach,
            loading: Loading::ZeroFuel { zero_fuel_mass_kg, fuel_on_board_kg },
            center_of_gravity_percent_mac: random.uniform(center.0, center.1),
            center_of_gravity_travel_percent_mac_h: random.uniform(-1.0, 1.0),
            changes: Vec::new(),
            anti_ice: Vec::new(),
        };
        plan.changes = self.draw_changes(aircraft, &plan, &ranges, random);
        plan.anti_ice = self.draw_anti_ice(&plan, random)?;
        Ok(can_be_flown(aircraft, &plan)?.then_some(plan))
    }

    /// Every number of a design that has limits.
    fn check(&self, aircraft: &AircraftTruth) -> Result<(), OutOfDomain> {
        let fastest = aircraft.envelope.maximum_operating_mach;
        let ceiling_ft = aircraft.envelope.ceiling_ft;
        let mach = |range: Option<(f64, f64)>| range.unwrap_or((fastest, fastest));
        let feet = |range: Option<(f64, f64)>| range.unwrap_or((ceiling_ft, ceiling_ft));
        let checks = [
            (
                "number of flights",
                "-",
                (self.flights as f64, self.flights as f64),
                0.0,
                MOST_FLIGHTS as f64,
            ),
            ("high_mach", "-", mach(self.high_mach), 0.2, fastest),
            ("low_mach", "-", mach(self.low_mach), 0.2, fastest),
            ("high_ft", "ft", feet(self.high_ft), 1_000.0, ceiling_ft),
            ("low_ft", "ft", feet(self.low_ft), 1_000.0, ceiling_ft),
            ("duration_h", "h", self.duration_h, 0.01, 24.0),
            ("fuel_share", "-", self.fuel_share, 0.001, 1.0),
            ("latitude_deg", "deg", self.latitude_deg, -70.0, 70.0),
            ("level_changes_per_h", "1/h", (0.0, self.level_changes_per_h), 0.0, 60.0),
            ("level_change_ft", "ft", (0.0, self.level_change_ft), 0.0, 20_000.0),
            ("speed_changes_per_h", "1/h", (0.0, self.speed_changes_per_h), 0.0, 60.0),
            ("speed_change_mach", "-", (0.0, self.speed_change_mach), 0.0, 0.3),
            ("turns_per_h", "1/h", (0.0, self.turns_per_h), 0.0, 60.0),
        ];
        for (quantity, unit, (least, most), minimum, maximum) in checks {
            check_within(quantity, unit, least, minimum, maximum)?;
            check_within(quantity, unit, most, least, maximum)?;
        }
        Ok(())
    }

    fn ranges(&self, aircraft: &AircraftTruth, low: bool) -> Ranges {
        let ceiling_ft = aircraft.envelope.ceiling_ft;
        let fastest = aircraft.envelope.maximum_operating_mach;
        let divide_ft = 0.725 * ceiling_ft;
        if low {
            Ranges {
                feet: self.low_ft.unwrap_or((0.49 * ceiling_ft, divide_ft)),
                mach: self.low_mach.unwrap_or((fastest - 0.36, fastest - 0.14)),
            }
        } else {
            Ranges {
                feet: self.high_ft.unwrap_or((divide_ft, (0.97 * ceiling_ft).min(45_000.0))),
                mach: self.high_mach.unwrap_or((fastest - 0.14, fastest - 0.025)),
            }
        }
    }

    fn draw_route(&self, duration_s: f64, random: &mut Stream) -> Vec<(f64, f64)> {
        // At 250 m/s, including the quarter of an hour before the recording and some reserve.
        let length_m = 250.0 * (duration_s + 1500.0);
        let turns = count(self.turns_per_h * duration_s / 3600.0, random);
        let legs = turns + 1;
        let latitude_deg = random.uniform(self.latitude_deg.0, self.latitude_deg.1);
        let longitude_deg = random.uniform(-120.0, 40.0);
        let mut track_deg = random.uniform(0.0, 360.0);
        let mut waypoints = vec![(latitude_deg, longitude_deg)];
        let mut place = Place::at(latitude_deg, longitude_deg, track_deg);
        for leg in 0..legs {
            if leg > 0 {
                track_deg = place.track_rad().to_degrees() + 35.0 * random.normal();
                place = Place::at(
                    place.latitude_rad().to_degrees(),
                    place.longitude_rad().to_degrees(),
                    track_deg,
                );
            }
            let leg_m = length_m / legs as f64;
            // Away from the poles and the equator, where there is no geostrophic wind.
            let end_deg = place.ahead(leg_m).latitude_rad().to_degrees();
            if !(12.0..68.0).contains(&end_deg) {
                place = place.turned(core::f64::consts::PI);
            }
            place = place.ahead(leg_m);
            waypoints.push((place.latitude_rad().to_degrees(), place.longitude_rad().to_degrees()));
        }
        waypoints
    }

    fn draw_changes(
        &self,
        aircraft: &AircraftTruth,
        plan: &FlightPlan,
        ranges: &Ranges,
        random: &mut Stream,
    ) -> Vec<Change> {
        let hours = plan.duration_s / 3600.0;
        let mut changes = Vec::new();
        let mut feet = plan.pressure_altitude_ft;
        for _ in 0..count(self.level_changes_per_h * hours, random) {
            let at_s = random.uniform(0.1, 0.9) * plan.duration_s;
            // Mostly up; down where there is no room above.
            let up = random.chance(0.8);
            let next = feet + if up { self.level_change_ft } else { -self.level_change_ft };
            if (0.4 * aircraft.envelope.ceiling_ft..=0.97 * aircraft.envelope.ceiling_ft)
                .contains(&next)
            {
                changes.push((at_s, next));
                feet = next;
            }
        }
        // Levels in the order of time.
        let mut times: Vec<f64> = changes.iter().map(|(at_s, _)| *at_s).collect();
        times.sort_by(f64::total_cmp);
        let mut all: Vec<Change> = times
            .into_iter()
            .zip(changes)
            .map(|(at_s, (_, feet))| Change::PressureAltitude { at_s: at_s.round(), feet })
            .collect();
        for _ in 0..count(self.speed_changes_per_h * hours, random) {
            let at_s = random.uniform(0.1, 0.9) * plan.duration_s;
            let mach = (plan.mach + self.speed_change_mach * random.normal())
                .max(ranges.mach.0 - 0.03)
                .min(aircraft.envelope.maximum_operating_mach - 0.015);
            all.push(Change::Mach { at_s: at_s.round(), mach: (mach * 1000.0).round() / 1000.0 });
        }
        all.sort_by(|a, b| a.at_s().total_cmp(&b.at_s()));
        all
    }

    fn draw_anti_ice(
        &self,
        plan: &FlightPlan,
        random: &mut Stream,
    ) -> Result<Vec<(f64, f64)>, OutOfDomain> {
        let sat =
            atmos::isa::temperature(PressureAltitude::feet(plan.pressure_altitude_ft))?.to_kelvin();
        let uses = random.chance(self.anti_ice_share);
        let from_s = random.uniform(0.0, 0.5) * plan.duration_s;
        let length_s = random.uniform(0.2, 0.5) * plan.duration_s;
        Ok(if uses && sat > ICE_K {
            vec![(from_s.round(), (from_s + length_s).round())]
        } else {
            Vec::new()
        })
    }
}

/// A Poisson number, by counting exponential waits; 20 at most.
fn count(mean: f64, random: &mut Stream) -> usize {
    let mut waited = 0.0;
    (0..20)
        .take_while(|_| {
            waited += random.exponential(1.0);
            waited < mean
        })
        .count()
}

/// Levels and speeds of a flight one after the other, with the time from which each holds.
pub(crate) fn legs(plan: &FlightPlan) -> Vec<(f64, f64, f64)> {
    let mut legs = vec![(0.0, plan.pressure_altitude_ft, plan.mach)];
    let mut changes = plan.changes.clone();
    changes.sort_by(|a, b| a.at_s().total_cmp(&b.at_s()));
    for change in changes {
        let (_, feet, mach) = legs[legs.len() - 1];
        legs.push(match change {
            Change::PressureAltitude { at_s, feet } => (at_s, feet, mach),
            Change::Mach { at_s, mach } => (at_s, feet, mach),
        });
    }
    legs
}

/// Two instants as RFC 3339 texts.
mod dates {
    use flight::Timestamp;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        value: &(Timestamp, Timestamp),
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        (value.0.to_string(), value.1.to_string()).serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<(Timestamp, Timestamp), D::Error> {
        let (first, last) = <(String, String)>::deserialize(deserializer)?;
        Ok((
            first.parse().map_err(serde::de::Error::custom)?,
            last.parse().map_err(serde::de::Error::custom)?,
        ))
    }
}
