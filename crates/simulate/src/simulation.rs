//! From a plan to reports and truth.

use flight::{FlightIdentity, Report, ReportDataError};
use units::{Mach, Mass, OutOfDomain, PressureAltitude, TemperatureDifference, check_within};

use crate::aircraft::AircraftTruth;
use crate::effect::{PlannedEffect, TruthEffect};
use crate::fly::{FlightError, FlightSetup, RollTrim, fly};
use crate::plan::{AircraftChoice, Flights, Plan, PlanError, seconds};
use crate::random::{Purpose, Streams};
use crate::references::references_of;
use crate::route::{FlightPlan, Loading};
use crate::sensor::{RecordedLoading, SensorBank, Sensors};
use crate::smooth::SmoothErrors;
use crate::state::TrueState;
use crate::terms::{EffectContext, MAXIMUM_ENGINES, References, Terms};
use crate::trim::{TrimPoint, trim_with};
use crate::truth::{EffectTruth, FlightTruth, TRUTH_SCHEMA, TailTruth, Truth};
use crate::vector::Place;
use crate::weather::{AirMass, draw_patches};

/// A plan, checked and drawn: every flight can now be flown, in any order and on any thread.
#[derive(Clone, Debug)]
pub struct Simulation {
    plan: Plan,
    aircraft: AircraftTruth,
    sensors: Sensors,
    tails: Vec<Tail>,
    /// Tail and flight of each job.
    jobs: Vec<(usize, usize)>,
}

#[derive(Clone, Debug)]
struct Tail {
    name: String,
    effects: Vec<(PlannedEffect, f64)>,
    deterioration_percent: Vec<f64>,
    references: References,
    flights: Vec<FlightPlan>,
    smooth_errors: Option<SmoothErrors>,
}

/// What came of one flight.
#[derive(Clone, Debug)]
pub struct Flown {
    /// What the sensors said.
    pub report: Report,
    /// What was true of the flight as a whole.
    pub truth: FlightTruth,
    /// The true state of each sample, before faults of the recording; empty unless the plan asks for it.
    pub states: Vec<TrueState>,
}

/// Why a flight gives no report.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// It cannot be flown.
    #[error("tail {tail} flight {flight}: {source}")]
    Flight {
        /// Tail.
        tail: String,
        /// Flight.
        flight: String,
        /// Why.
        source: FlightError,
    },
    /// What was recorded is no report.
    #[error("tail {tail} flight {flight}: {source}")]
    Report {
        /// Tail.
        tail: String,
        /// Flight.
        flight: String,
        /// Why.
        source: ReportDataError,
    },
    /// Recorded fuel used is more than there was, because the plan makes it read high.
    #[error(
        "tail {tail} flight {flight}: recorded fuel used {fuel_used_kg} kg exceeds {fuel_on_board_kg} kg on board"
    )]
    FuelUsed {
        /// Tail.
        tail: String,
        /// Flight.
        flight: String,
        /// Recorded, kg.
        fuel_used_kg: f64,
        /// Recorded, kg.
        fuel_on_board_kg: f64,
    },
    /// No flight of that number.
    #[error("flight {index} of {flights}")]
    Index {
        /// Asked for.
        index: usize,
        /// How many there are.
        flights: usize,
    },
}

impl Simulation {
    /// Checks a plan and draws its fleets.
    ///
    /// # Errors
    /// [`PlanError`] with what cannot be simulated.
    pub fn new(plan: Plan) -> Result<Self, PlanError> {
        let aircraft = match &plan.aircraft {
            AircraftChoice::Preset(preset) => AircraftTruth::preset(*preset)?,
            AircraftChoice::Custom(aircraft) => {
                aircraft.check()?;
                (**aircraft).clone()
            }
        };
        check_plan(&plan)?;
        let mut tails: Vec<Tail> = Vec::with_capacity(plan.tails.len());
        for tail_plan in &plan.tails {
            if tails.iter().any(|tail| tail.name == tail_plan.tail) {
                return Err(PlanError::DoubledTail { tail: tail_plan.tail.clone() });
            }
            let flights = match &tail_plan.flights {
                Flights::Listed(flights) => flights.clone(),
                Flights::Designed(design) => design.draw(&aircraft, plan.seed, &tail_plan.tail)?,
            };
            check_flights(&tail_plan.tail, &flights)?;
            let references = match tail_plan.references {
                Some(references) => references,
                None => references_of(&aircraft, &plan.richness, &plan.weather, &flights)?,
            };
            let effects = plan
                .effects
                .iter()
                .chain(&tail_plan.effects)
                .map(|effect| sized(effect, &references, &aircraft))
                .collect::<Result<Vec<_>, _>>()?;
            let sizes = &plan.smooth_errors;
            let smooth_errors =
                (sizes.drag_percent > 0.0 || sizes.fuel_flow_percent > 0.0).then(|| {
                    let mut random =
                        Streams::of_tail(plan.seed, &tail_plan.tail).stream(Purpose::SmoothErrors);
                    SmoothErrors::draw(
                        0.01 * sizes.drag_percent,
                        0.01 * sizes.fuel_flow_percent,
                        &mut random,
                    )
                });
            tails.push(Tail {
                name: tail_plan.tail.clone(),
                effects,
                deterioration_percent: tail_plan.engine_deterioration_percent.clone(),
                references,
                flights,
                smooth_errors,
            });
        }
        let jobs = tails
            .iter()
            .enumerate()
            .flat_map(|(t, tail)| (0..tail.flights.len()).map(move |f| (t, f)))
            .collect();
        let sensors = plan.sensors.sensors();
        Ok(Self { plan, aircraft, sensors, tails, jobs })
    }

    /// How many flights there are, all tails together.
    #[must_use]
    pub fn len(&self) -> usize {
        self.jobs.len()
    }

    /// Always false: a simulation without flights is refused.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.jobs.is_empty()
    }

    /// The aircraft that is flown.
    #[must_use]
    pub const fn aircraft(&self) -> &AircraftTruth {
        &self.aircraft
    }

    /// The plan behind it.
    #[must_use]
    pub const fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Tail and plan of a flight.
    #[must_use]
    pub fn flight(&self, index: usize) -> Option<(&str, &FlightPlan)> {
        let (tail, flight) = *self.jobs.get(index)?;
        let tail = &self.tails[tail];
        Some((&tail.name, &tail.flights[flight]))
    }

    /// Flies one flight. The result depends on the plan and the index alone.
    ///
    /// # Errors
    /// [`SimulationError`] where the flight cannot be flown or what it records is no report.
    pub fn fly(&self, index: usize) -> Result<Flown, SimulationError> {
        let Some((tail_index, flight_index)) = self.jobs.get(index).copied() else {
            return Err(SimulationError::Index { index, flights: self.jobs.len() });
        };
        let tail = &self.tails[tail_index];
        let plan = &tail.flights[flight_index];
        let name = || (tail.name.clone(), plan.flight.clone());
        let of_flight = |source: FlightError| {
            let (tail, flight) = name();
            SimulationError::Flight { tail, flight, source }
        };
        let drawn = self.draw(tail, plan, flight_index).map_err(|e| of_flight(e.into()))?;
        let Drawn { setup, streams, loading, mut truth } = drawn;
        let recorded = setup.terms.recorded;
        let mut bank = SensorBank::draw(
            &self.sensors,
            &self.plan.columns,
            &recorded,
            self.aircraft.engines(),
            (Streams::of_tail(self.plan.seed, &tail.name), streams),
            truth.fuel_on_board_kg,
        );
        let keep = self.plan.recording.true_states.is_on();
        let mut states = Vec::new();
        let mut outside: Option<OutOfDomain> = None;
        let mut turbulent_samples = 0_u32;
        let books = fly(&setup, |instant, step_s, sample| {
            if let Err(error) = bank.observe(instant, step_s, sample) {
                outside.get_or_insert(error);
            }
            if let Some(state) = sample {
                turbulent_samples += u32::from(state.turbulence_m_s > 0.0);
                if keep {
                    states.push(*state);
                }
            }
        })
        .map_err(of_flight)?;
        if let Some(error) = outside {
            return Err(of_flight(error.into()));
        }
        truth.energy = books.energy;
        truth.mass = books.mass;
        truth.turbulence_min = f64::from(turbulent_samples) * self.plan.recording.interval_s / 60.0;
        let report = bank.finish(loading, streams).map_err(|source| {
            let (tail, flight) = name();
            SimulationError::Report { tail, flight, source }
        })?;
        let fuel_on_board_kg = report.header().fuel_on_board.to_kilograms();
        if let Some(fuel_used_kg) = report.columns().fuel_used_kg.last().copied()
            && fuel_used_kg > fuel_on_board_kg
        {
            let (tail, flight) = name();
            return Err(SimulationError::FuelUsed { tail, flight, fuel_used_kg, fuel_on_board_kg });
        }
        Ok(Flown { report, truth, states })
    }

    /// The document of what was true, from the flights flown, in any order.
    #[must_use]
    pub fn truth(&self, flown: Vec<FlightTruth>) -> Truth {
        let mut tails: Vec<TailTruth> = self
            .tails
            .iter()
            .map(|tail| TailTruth {
                tail: tail.name.clone(),
                effects: tail
                    .effects
                    .iter()
                    .map(|(effect, size)| effect_truth(effect, *size))
                    .collect(),
                references: tail.references,
                flights: Vec::new(),
            })
            .collect();
        let mut flown = flown;
        flown.sort_by(|a, b| (a.start, &a.flight).cmp(&(b.start, &b.flight)));
        for flight in flown {
            if let Some(tail) = tails.iter_mut().find(|tail| tail.tail == flight.tail) {
                tail.flights.push(flight);
            }
        }
        Truth {
            schema: TRUTH_SCHEMA.to_owned(),
            seed: self.plan.seed,
            aircraft: self.aircraft.type_code.clone(),
            tails,
        }
    }

    /// Draws everything of one flight that is random, but for gusts and sensors.
    fn draw<'a>(
        &'a self,
        tail: &'a Tail,
        plan: &'a FlightPlan,
        flight_index: usize,
    ) -> Result<Drawn<'a>, OutOfDomain> {
        let streams = Streams::of_flight(self.plan.seed, &tail.name, flight_index);
        let engines = self.aircraft.engines();
        let mut terms = Terms::of(&self.aircraft, &self.plan.richness);
        for (factor, percent) in
            terms.fuel.engine_factor.iter_mut().zip(&tail.deterioration_percent)
        {
            *factor *= 1.0 + 0.01 * percent;
        }
        let context =
            EffectContext { references: &tail.references, date_s: seconds(plan.start), engines };
        for (effect, size) in &tail.effects {
            terms.add(effect, *size, &context);
        }

        let scatter = &self.plan.scatter;
        let mut loading = streams.stream(Purpose::Loading);
        let heating_value = 0.01 * scatter.heating_value_percent * loading.normal()
            + terms.recorded.heating_value_scatter * loading.normal();
        terms.fuel.heating_value_factor = 1.0 / (1.0 + heating_value);
        let load_sheet_kg = 0.01
            * scatter.zero_fuel_mass_percent
            * self.aircraft.masses.maximum_zero_fuel_kg
            * loading.normal();

        let mut airframe = streams.stream(Purpose::Airframe);
        let mut shares = [0.0; MAXIMUM_ENGINES];
        for share in shares.iter_mut().take(engines) {
            *share = 1.0 + 0.01 * scatter.throttle_split_percent * airframe.normal();
        }
        let total: f64 = shares.iter().sum();
        for share in &mut shares {
            *share /= total;
        }
        let limit_deg = scatter.roll_trim_limit_deg;
        let roll_trim = RollTrim {
            start_deg: (scatter.roll_trim_deg * airframe.normal()).clamp(-limit_deg, limit_deg),
            per_h_deg: scatter.roll_trim_drift_deg_h * airframe.normal(),
            limit_deg,
        };

        let middle = middle_of(plan);
        let air = AirMass::draw(&self.plan.weather, middle, &mut streams.stream(Purpose::Weather));
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
        let interval_s = self.plan.recording.interval_s;
        let steps = (interval_s / self.plan.recording.longest_step_s - 1e-9).ceil().max(1.0);
        Ok(Drawn {
            loading: RecordedLoading {
                aircraft_type: self.aircraft.type_code.clone(),
                identity: FlightIdentity {
                    tail: tail.name.clone(),
                    start: plan.start,
                    flight: plan.flight.clone(),
                },
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
                energy: Default::default(),
                mass: Default::default(),
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
                interval_s,
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "checked to be 1 to 36 million when the plan was"
                )]
                steps_per_interval: steps as u32,
            },
            streams,
        })
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

struct Drawn<'a> {
    setup: FlightSetup<'a>,
    streams: Streams,
    loading: RecordedLoading,
    truth: FlightTruth,
}

struct Masses {
    zero_fuel_kg: f64,
    start_kg: f64,
    climb_fuel_kg: f64,
}

fn middle_of(plan: &FlightPlan) -> crate::vector::Vector {
    let (latitude_deg, longitude_deg) = plan.waypoints[0];
    let start = Place::at(latitude_deg, longitude_deg, 0.0);
    let (latitude_deg, longitude_deg) = plan.waypoints[plan.waypoints.len() - 1];
    let target = crate::vector::point(latitude_deg, longitude_deg);
    start.turned(start.angle_to(target)).ahead(0.5 * start.distance_to_m(target)).position
}

fn sized(
    effect: &PlannedEffect,
    references: &References,
    aircraft: &AircraftTruth,
) -> Result<(PlannedEffect, f64), PlanError> {
    use flight::effect::EffectId;
    if let TruthEffect::Library(EffectId::TsfcEngine(k) | EffectId::FuelFlowGainEngine(k)) =
        effect.id
        && usize::from(k) > aircraft.engines()
    {
        return Err(PlanError::Engine {
            effect: effect.id.to_string(),
            engines: aircraft.engines(),
        });
    }
    let size = effect.size.unwrap_or_else(|| effect.id.typical_size(references.mass_kg));
    Ok((*effect, check_within("effect size", effect.id.unit(), size, -1e6, 1e6)?))
}

fn effect_truth(effect: &PlannedEffect, size: f64) -> EffectTruth {
    let step = effect.id == TruthEffect::Library(flight::effect::EffectId::StepChange);
    EffectTruth {
        id: effect.id,
        size,
        from: effect.from,
        target: step.then_some(effect.target),
        at: effect.at,
    }
}

fn check_plan(plan: &Plan) -> Result<(), PlanError> {
    let recording = &plan.recording;
    let weather = &plan.weather;
    let checks = [
        ("recording interval", "s", recording.interval_s, 0.1, 3600.0),
        ("simulation step", "s", recording.longest_step_s, 0.01, 1.0),
        ("time after top of climb", "min", recording.after_top_of_climb_min, 0.0, 600.0),
        ("wind field", "m/s", weather.wind_field_m_s, 0.0, 40.0),
        ("ISA deviation field", "K", weather.isa_deviation_field_k, 0.0, 15.0),
        ("ageostrophic share", "-", weather.ageostrophic_share, 0.0, 1.0),
        ("vertical wind", "m/s", weather.vertical_wind_m_s, 0.0, 2.0),
        ("shortest wave", "km", weather.wavelengths_km.0, 100.0, weather.wavelengths_km.1),
        ("longest wave", "km", weather.wavelengths_km.1, weather.wavelengths_km.0, 20_000.0),
        (
            "shortest vertical wave",
            "km",
            weather.vertical_wavelengths_km.0,
            20.0,
            weather.vertical_wavelengths_km.1,
        ),
        ("gusts elsewhere", "m/s", weather.turbulence.elsewhere_m_s, 0.0, 10.0),
        ("heating value scatter", "%", plan.scatter.heating_value_percent, 0.0, 10.0),
        ("zero-fuel mass scatter", "%", plan.scatter.zero_fuel_mass_percent, 0.0, 10.0),
        ("roll trim limit", "deg", plan.scatter.roll_trim_limit_deg, 0.0, 10.0),
        ("throttle split", "%", plan.scatter.throttle_split_percent, 0.0, 20.0),
        ("autopilot Mach frequency", "rad/s", plan.autopilot.mach_frequency_rad_s, 0.001, 0.3),
        ("autopilot altitude gain", "1/s", plan.autopilot.altitude_gain_s, 0.001, 0.3),
        ("engine time constant", "s", plan.autopilot.engine_time_s, 0.1, 30.0),
        ("bank in turns", "deg", plan.autopilot.bank_deg, 5.0, 35.0),
        ("roll time constant", "s", plan.autopilot.roll_time_s, 2.0, 30.0),
    ];
    for (quantity, unit, value, minimum, maximum) in checks {
        check_within(quantity, unit, value, minimum, maximum)?;
    }
    Ok(())
}

fn check_flights(tail: &str, flights: &[FlightPlan]) -> Result<(), PlanError> {
    if flights.is_empty() {
        return Err(PlanError::NoFlights { tail: tail.to_owned() });
    }
    for flight in flights {
        if flight.waypoints.len() < 2 {
            return Err(PlanError::Waypoints {
                tail: tail.to_owned(),
                flight: flight.flight.clone(),
                found: flight.waypoints.len(),
            });
        }
        for (latitude_deg, longitude_deg) in &flight.waypoints {
            check_within("latitude", "deg", *latitude_deg, -80.0, 80.0)?;
            check_within("longitude", "deg", *longitude_deg, -360.0, 360.0)?;
        }
        check_within("duration", "s", flight.duration_s, 1.0, 86_400.0)?;
        check_within("fuel on board", "kg", flight.loading.fuel_on_board_kg(), 1.0, 3e5)?;
        for (_, feet, mach) in crate::plan::legs(flight) {
            check_within("pressure altitude", "ft", feet, 1_000.0, 60_000.0)?;
            check_within("Mach number", "-", mach, 0.2, 0.98)?;
        }
    }
    Ok(())
}
