//! Everything random about one flight, except gusts and sensors.

use flight::{FlightIdentity, Timestamp};
use units::{Mach, Mass, OutOfDomain, PressureAltitude, TemperatureDifference};

use super::{Simulation, Tail};
use crate::effect::PlannedEffect;
use crate::fly::{FlightSetup, RollTrim};
use crate::plan::Scatter;
use crate::random::{Purpose, Stream, Streams};
use crate::route::{FlightPlan, Loading};
use crate::sensor::RecordedLoading;
use crate::state::{EnergyBook, MassBook};
use crate::terms::{EffectContext, FuelShares, MAXIMUM_ENGINES, Terms};
use crate::trim::{TrimPoint, trim_with};
use crate::truth::FlightTruth;
use crate::vector::Place;
use crate::weather::{AirMass, draw_patches};

impl Simulation {
    /// Draws it. The order of draws within a stream is part of the meaning of a seed.
    pub(super) fn draw<'a>(
        &'a self,
        tail: &'a Tail,
        plan: &'a FlightPlan,
        flight_index: usize,
    ) -> Result<Drawn<'a>, OutOfDomain> {
        let streams = Streams::of_flight(self.plan.seed, &tail.name, flight_index);
        let mut terms = self.terms_of(tail, plan);

        let scatter = &self.plan.scatter;
        let mut loading = streams.stream(Purpose::Loading);
        let heating_value = 0.01 * scatter.heating_value_percent * loading.normal()
            + terms.recorded.heating_value_scatter * loading.normal();
        terms.fuel.heating_value_factor = 1.0 / (1.0 + heating_value);
        let load_sheet_kg = self.load_sheet_error_kg(&mut loading);

        let mut airframe = streams.stream(Purpose::Airframe);
        let shares = draw_shares(self.aircraft.engines(), scatter, &mut airframe);
        let roll_trim = draw_roll_trim(scatter, &mut airframe);

        let mut weather = streams.stream(Purpose::Weather);
        let air = AirMass::draw(&self.plan.weather, middle_of(plan), plan.start, &mut weather);
        let settle_s = 60.0 * self.plan.recording.after_top_of_climb_min;
        let turbulence = &self.plan.weather.turbulence;
        let patches =
            draw_patches(turbulence, plan.duration_s, &mut streams.stream(Purpose::Patches));

        let masses = self.masses(plan, &terms, air.mean_isa_deviation_k(), settle_s)?;
        let recorded_zero_fuel_mass_kg =
            masses.zero_fuel_kg - terms.recorded.zero_fuel_mass_kg - load_sheet_kg;
        let fuel_on_board_kg = plan.loading.fuel_on_board_kg();
        let lower_heating_value_mj_kg =
            self.aircraft.engine.reference_lower_heating_value_mj_kg * (1.0 + heating_value);
        Ok(Drawn {
            loading: RecordedLoading {
                aircraft_type: self.aircraft.type_code.clone(),
                identity: identity_of(tail, plan),
                zero_fuel_mass_kg: recorded_zero_fuel_mass_kg,
                fuel_on_board_kg,
                lower_heating_value_mj_kg,
                notes: vec![("SOURCE".to_owned(), "simulated, not a real aircraft".to_owned())],
            },
            truth: FlightTruth {
                tail: tail.name.clone(),
                flight: plan.flight.clone(),
                start: plan.start,
                lower_heating_value_mj_kg,
                zero_fuel_mass_kg: masses.zero_fuel_kg,
                recorded_zero_fuel_mass_kg,
                fuel_on_board_kg,
                thrust_shares: shares,
                roll_trim_deg: roll_trim.start_deg,
                isa_deviation_k: air.mean_isa_deviation_k(),
                turbulence_min: 0.0,
                energy: EnergyBook::default(),
                mass: MassBook::default(),
            },
            setup: FlightSetup {
                aircraft: &self.aircraft,
                terms,
                earth: &self.plan.earth,
                autopilot: &self.plan.autopilot,
                plan,
                air,
                turbulence,
                patches,
                smooth_errors: tail.smooth_errors.as_ref(),
                streams,
                shares,
                roll_trim,
                start_mass_kg: masses.start_kg,
                start_fuel_used_kg: masses.climb_fuel_kg,
                settle_s,
                interval_s: self.plan.recording.interval_s,
                steps_per_interval: self.steps_per_interval(),
            },
            streams,
        })
    }

    /// Error of the load sheet's zero-fuel mass.
    fn load_sheet_error_kg(&self, loading: &mut Stream) -> f64 {
        0.01 * self.plan.scatter.zero_fuel_mass_percent
            * self.aircraft.masses.maximum_zero_fuel_kg
            * loading.normal()
    }

    /// Steps of integration between two samples.
    fn steps_per_interval(&self) -> u32 {
        let recording = &self.plan.recording;
        let steps = (recording.interval_s / recording.longest_step_s - 1e-9).ceil().max(1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked to be 1 to 36 million when the plan was"
        )]
        let steps = steps as u32;
        steps
    }

    fn terms_of(&self, tail: &Tail, plan: &FlightPlan) -> Terms {
        let mut terms = Terms::new(&self.aircraft, self.plan.physics);
        for (factor, percent) in
            terms.fuel.engine_factor.iter_mut().zip(&tail.deterioration_percent)
        {
            *factor *= 1.0 + 0.01 * percent;
        }
        let context = EffectContext {
            references: &tail.references,
            date_s: flight::seconds_since_1970(plan.start),
            engines: self.aircraft.engines(),
        };
        terms.drag.zero_lift_factor *= 1.0
            + 0.01 * tail.lives.airframe.as_ref().map_or(0.0, |life| life.percent_at(plan.start));
        for (factor, life) in terms.fuel.engine_factor.iter_mut().zip(&tail.lives.engines) {
            *factor *= 1.0 + 0.01 * life.percent_at(plan.start);
        }
        for (effect, size) in acting(&tail.effects, plan.start).iter().chain(&tail.clutter) {
            terms.add(effect, *size, &context);
        }
        terms
    }

    /// Masses at top of climb.
    fn masses(
        &self,
        plan: &FlightPlan,
        terms: &Terms,
        isa_deviation_k: f64,
        settle_s: f64,
    ) -> Result<Masses, OutOfDomain> {
        let pressure_altitude = PressureAltitude::feet(plan.pressure_altitude_ft);
        let point = |mass_kg: f64| -> Result<TrimPoint, OutOfDomain> {
            Ok(TrimPoint {
                mass: Mass::kilograms(mass_kg),
                pressure_altitude,
                mach: Mach::new(plan.mach),
                sat: atmos::isa::temperature(pressure_altitude)?
                    + TemperatureDifference::kelvin(isa_deviation_k),
                center_of_gravity_percent_mac: plan.center_of_gravity_percent_mac,
            })
        };
        let climb_fuel_kg = |mass_kg: f64| -> Result<(f64, f64), OutOfDomain> {
            let trimmed = trim_with(&self.aircraft, terms, &point(mass_kg)?)?;
            let speed = trimmed.true_airspeed_m_s;
            let energy_j = mass_kg
                * (units::convert::STANDARD_GRAVITY_M_S2 * pressure_altitude.to_meters()
                    + 0.5 * speed * speed);
            let fuel_per_work = trimmed.fuel_flow_kg_s / (trimmed.thrust_n * speed);
            Ok((self.aircraft.climb_fuel_factor * energy_j * fuel_per_work, trimmed.fuel_flow_kg_s))
        };
        match plan.loading {
            Loading::ZeroFuel { zero_fuel_mass_kg, fuel_on_board_kg } => {
                let ramp_kg = zero_fuel_mass_kg + fuel_on_board_kg;
                let (climb_fuel_kg, _) = climb_fuel_kg(ramp_kg)?;
                Ok(Masses {
                    zero_fuel_kg: zero_fuel_mass_kg,
                    start_kg: ramp_kg - climb_fuel_kg,
                    climb_fuel_kg,
                })
            }
            Loading::AtRecording { gross_mass_kg, fuel_on_board_kg } => {
                let (climb_fuel_kg, flow_kg_s) = climb_fuel_kg(gross_mass_kg)?;
                let start_kg = gross_mass_kg + flow_kg_s * settle_s;
                Ok(Masses {
                    zero_fuel_kg: start_kg + climb_fuel_kg - fuel_on_board_kg,
                    start_kg,
                    climb_fuel_kg,
                })
            }
        }
    }
}

/// The effects that act on a flight that begins at an instant. What acts twice, of a type and on its tail, acts with both sizes:
/// several terms hold one size only. Steps and histories have dates of their own and stay apart.
fn acting(effects: &[(PlannedEffect, f64)], start: Timestamp) -> Vec<(PlannedEffect, f64)> {
    let mut all: Vec<(PlannedEffect, f64)> = Vec::with_capacity(effects.len());
    for (effect, size) in effects.iter().filter(|(effect, _)| effect.acts_at(start)) {
        let same = |other: &&mut (PlannedEffect, f64)| {
            other.0.id == effect.id && other.0.at == effect.at && !effect.has_dated_form()
        };
        match all.iter_mut().find(same) {
            Some((_, sum)) => *sum += size,
            None => all.push((*effect, *size)),
        }
    }
    all
}

/// The result of the draw.
pub(super) struct Drawn<'a> {
    pub(super) setup: FlightSetup<'a>,
    pub(super) streams: Streams,
    pub(super) loading: RecordedLoading,
    pub(super) truth: FlightTruth,
}

/// Masses of a flight.
#[expect(clippy::struct_field_names, reason = "the unit is in the name")]
struct Masses {
    zero_fuel_kg: f64,
    /// Where the simulation starts, at top of climb.
    start_kg: f64,
    /// Burnt until there.
    climb_fuel_kg: f64,
}

fn identity_of(tail: &Tail, plan: &FlightPlan) -> FlightIdentity {
    FlightIdentity { tail: tail.name.clone(), start: plan.start, flight: plan.flight.clone() }
}

fn draw_roll_trim(scatter: &Scatter, airframe: &mut Stream) -> RollTrim {
    let limit_deg = scatter.roll_trim_limit_deg;
    RollTrim {
        start_deg: (scatter.roll_trim_deg * airframe.normal()).clamp(-limit_deg, limit_deg),
        drift_deg_h: scatter.roll_trim_drift_deg_h * airframe.normal(),
        limit_deg,
    }
}

/// Each engine's share of the thrust, about alike.
fn draw_shares(engines: usize, scatter: &Scatter, random: &mut Stream) -> FuelShares {
    let mut shares = [0.0; MAXIMUM_ENGINES];
    for share in shares.iter_mut().take(engines) {
        *share = 1.0 + 0.01 * scatter.throttle_split_percent * random.normal();
    }
    let total: f64 = shares.iter().sum();
    for share in &mut shares {
        *share /= total;
    }
    shares
}

/// The middle of the great circle from the first to the last waypoint.
fn middle_of(plan: &FlightPlan) -> crate::vector::Vector {
    let (latitude_deg, longitude_deg) = plan.waypoints[0];
    let start = Place::at(latitude_deg, longitude_deg, 0.0);
    let (latitude_deg, longitude_deg) = plan.waypoints[plan.waypoints.len() - 1];
    let target = crate::vector::point(latitude_deg, longitude_deg);
    start.turned(start.angle_to(target)).ahead(0.5 * start.distance_to_m(target)).position
}
