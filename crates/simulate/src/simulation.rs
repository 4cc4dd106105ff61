//! From a plan to reports and truth.

mod check;
mod draw;
mod effects;
mod ranges;

use std::collections::BTreeSet;

use flight::column::Column;
use flight::{Report, ReportDataError};
use units::OutOfDomain;

use crate::aircraft::AircraftTruth;
use crate::effect::PlannedEffect;
use crate::fleet::{DrawnFleet, FleetEvent, Lives, Planted};
use crate::fly::{FlightError, fly};
use crate::plan::{AircraftChoice, FleetDesign, Flights, Plan, PlanError, TailPlan};
use crate::random::{Purpose, Streams};
use crate::references::references_of_tails;
use crate::route::FlightPlan;
use crate::sensor::{BankSetup, SensorBank, Sensors};
use crate::smooth::SmoothErrors;
use crate::state::TrueState;
use crate::terms::References;
use crate::truth::{FlightTruth, TRUTH_SCHEMA, TailTruth, Truth};

use check::{MOST_FLIGHTS, check_flights, check_plan};
use draw::Drawn;
use effects::{draw_clutter, effect_truths, effects_of_tail};
use ranges::check_ranges;

/// A flight that lacks thrust is drawn again as often as this before it counts as one that cannot be flown.
const MOST_DRAWN_AGAIN: u32 = 20;

/// A plan, checked and drawn: every flight can now be flown, in any order and on any thread.
#[derive(Clone, Debug)]
pub struct Simulation {
    plan: Plan,
    aircraft: AircraftTruth,
    sensors: Sensors,
    tails: Vec<Tail>,
    /// Of the fleet: what was planted, and what was done when.
    planted: Vec<Planted>,
    events: Vec<FleetEvent>,
    /// Tail and flight of each job.
    jobs: Vec<(usize, usize)>,
}

#[derive(Clone, Debug)]
struct Tail {
    name: String,
    effects: Vec<(PlannedEffect, f64)>,
    clutter: Vec<(PlannedEffect, f64)>,
    deterioration_percent: Vec<f64>,
    lives: Lives,
    references: References,
    flights: Vec<FlightPlan>,
    /// From which a flight that cannot be flown is drawn again; `None` where the flights are listed.
    design: Option<FleetDesign>,
    smooth_errors: Option<SmoothErrors>,
}

/// The result of one flight.
#[derive(Clone, Debug)]
pub struct Flown {
    /// The recorded report.
    pub report: Report,
    /// The truth of the flight as a whole.
    pub truth: FlightTruth,
    /// How often the flight was drawn again because the aircraft could not fly what was drawn.
    pub drawn_again: u32,
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
        /// The reason.
        source: FlightError,
    },
    /// The recording does not make a report.
    #[error("tail {tail} flight {flight}: {source}")]
    Report {
        /// Tail.
        tail: String,
        /// Flight.
        flight: String,
        /// The reason.
        source: ReportDataError,
    },
    /// A recorded value that the report's format refuses: the plan makes sensors or effects absurd.
    #[error(
        "tail {tail} flight {flight}: {column} {value} {unit} outside {range}",
        column = column.name(), unit = column.canonical_unit()
    )]
    Range {
        /// Tail.
        tail: String,
        /// Flight.
        flight: String,
        /// Column of the report.
        column: Column,
        /// In the column's stored unit.
        value: f64,
        /// The range in words.
        range: &'static str,
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
    /// [`PlanError`] with the reason why it cannot be simulated.
    pub fn new(plan: Plan) -> Result<Self, PlanError> {
        let aircraft = match &plan.aircraft {
            AircraftChoice::Preset(preset) => AircraftTruth::preset(*preset)?,
            AircraftChoice::Custom(aircraft) => {
                aircraft.check()?;
                (**aircraft).clone()
            }
        };
        check_plan(&plan)?;
        if plan.tails.is_empty() && plan.fleet.is_none() {
            return Err(PlanError::NoTails);
        }
        let engines = aircraft.engine.count;
        let fleet = plan.fleet.as_ref().map(|fleet| fleet.draw(plan.seed, engines)).transpose()?;
        let DrawnFleet { tails: of_fleets, events } = fleet.unwrap_or_default();
        let tail_plans: Vec<TailPlan> =
            plan.tails.iter().chain(of_fleets.iter().map(|tail| &tail.plan)).cloned().collect();
        let flown = drawn_flights((&tail_plans, plan.seed), &aircraft)?;
        let references = references_of_tails(&plan, (&tail_plans, &aircraft), &flown)?;
        let mut tails: Vec<Tail> = Vec::with_capacity(tail_plans.len());
        let mut planted = Vec::new();
        for (place, ((tail_plan, (flights, design)), references)) in
            tail_plans.iter().zip(flown).zip(references).enumerate()
        {
            let of_fleet = place.checked_sub(plan.tails.len()).map(|place| &of_fleets[place]);
            let effects = effects_of_tail(
                (&plan, tail_plan, of_fleet),
                (&aircraft, &references),
                &mut planted,
            )?;
            let clutter = draw_clutter(&plan, &tail_plan.tail, &effects, &references, &aircraft);
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
                clutter,
                deterioration_percent: tail_plan.engine_deterioration_percent.clone(),
                lives: of_fleet.map(|tail| tail.lives.clone()).unwrap_or_default(),
                references,
                flights,
                design,
                smooth_errors,
            });
        }
        let jobs = tails
            .iter()
            .enumerate()
            .flat_map(|(t, tail)| (0..tail.flights.len()).map(move |f| (t, f)))
            .collect();
        let sensors = plan.sensors.sensors();
        planted.sort_by(|one: &Planted, other| {
            (one.level, &one.tail, one.effect).cmp(&(other.level, &other.tail, other.effect))
        });
        Ok(Self { plan, aircraft, sensors, tails, planted, events, jobs })
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

    /// Its plan.
    #[must_use]
    pub const fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What was done to the tails of the fleet, in order of time: the rows of `EVENTS.csv`.
    #[must_use]
    pub fn events(&self) -> &[FleetEvent] {
        &self.events
    }

    /// The effects of the fleet and whose they are: those of the type, then tail by tail.
    #[must_use]
    pub fn planted(&self) -> &[Planted] {
        &self.planted
    }

    /// Tail and plan of a flight.
    #[must_use]
    pub fn flight(&self, index: usize) -> Option<(&str, &FlightPlan)> {
        let (tail, flight) = *self.jobs.get(index)?;
        let tail = &self.tails[tail];
        Some((&tail.name, &tail.flights[flight]))
    }

    /// Flies one flight. The result depends on the plan and the index alone. A designed flight for which the aircraft lacks
    /// thrust or lift on its day is drawn again, with its weather; its name and START stay.
    ///
    /// # Errors
    /// [`SimulationError`] where the flight cannot be flown or its recording does not make a report.
    pub fn fly(&self, index: usize) -> Result<Flown, SimulationError> {
        let Some((tail_index, flight_index)) = self.jobs.get(index).copied() else {
            return Err(SimulationError::Index { index, flights: self.jobs.len() });
        };
        let tail = &self.tails[tail_index];
        let plan = &tail.flights[flight_index];
        let mut result = self.fly_plan(tail, plan, flight_index);
        for again in 1..=MOST_DRAWN_AGAIN {
            let (Err(SimulationError::Flight { source, .. }), Some(design)) =
                (&result, &tail.design)
            else {
                break;
            };
            if !matches!(source, FlightError::Thrust { .. } | FlightError::LiftCoefficient { .. }) {
                break;
            }
            let key = flight_index + again as usize * MOST_FLIGHTS;
            let drawn = design.draw_again(&self.aircraft, self.plan.seed, &tail.name, key);
            let Ok(Some(drawn)) = drawn else { continue };
            let other = FlightPlan { flight: plan.flight.clone(), start: plan.start, ..drawn };
            result =
                self.fly_plan(tail, &other, key).map(|flown| Flown { drawn_again: again, ..flown });
        }
        result
    }

    /// Flies one plan with the weather, sensors and scatter of a number.
    fn fly_plan(
        &self,
        tail: &Tail,
        plan: &FlightPlan,
        flight_index: usize,
    ) -> Result<Flown, SimulationError> {
        let name = || (tail.name.clone(), plan.flight.clone());
        let of_flight = |source: FlightError| {
            let (tail, flight) = name();
            SimulationError::Flight { tail, flight, source }
        };
        let drawn = self.draw(tail, plan, flight_index).map_err(|e| of_flight(e.into()))?;
        let Drawn { setup, streams, loading, mut truth } = drawn;
        let recorded = setup.terms.recorded;
        let mut bank = SensorBank::draw(&BankSetup {
            sensors: &self.sensors,
            columns: &self.plan.columns,
            recorded: &recorded,
            engines: self.aircraft.engines(),
            of_tail: Streams::of_tail(self.plan.seed, &tail.name),
            of_flight: streams,
            fuel_on_board_kg: truth.fuel_on_board_kg,
        });
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
        check_ranges(&report).map_err(|found| {
            let (tail, flight) = name();
            SimulationError::Range {
                tail,
                flight,
                column: found.column,
                value: found.value,
                range: found.words,
            }
        })?;
        Ok(Flown { report, truth, drawn_again: 0, states })
    }

    /// The document of the truth, from the flights flown, in any order.
    #[must_use]
    pub fn truth(&self, flown: Vec<FlightTruth>) -> Truth {
        let mut tails: Vec<TailTruth> = self
            .tails
            .iter()
            .map(|tail| TailTruth {
                tail: tail.name.clone(),
                effects: effect_truths(&tail.effects),
                clutter: effect_truths(&tail.clutter),
                airframe: tail.lives.airframe.clone(),
                engines: tail.lives.engines.clone(),
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
            planted: self.planted.clone(),
            events: self.events.clone(),
        }
    }
}

/// The flights of every tail, and the design they were drawn from.
type PlannedFlights = (Vec<FlightPlan>, Option<FleetDesign>);

fn drawn_flights(
    (tails, seed): (&[TailPlan], u64),
    aircraft: &AircraftTruth,
) -> Result<Vec<PlannedFlights>, PlanError> {
    let mut names = BTreeSet::new();
    tails
        .iter()
        .map(|tail_plan| {
            let tail = &tail_plan.tail;
            if !names.insert(tail) {
                return Err(PlanError::DoubledTail { tail: tail.clone() });
            }
            let (flights, design) = match &tail_plan.flights {
                Flights::Listed(flights) => (flights.clone(), None),
                Flights::Designed(design) => {
                    (design.draw(aircraft, seed, tail)?, Some((**design).clone()))
                }
            };
            check_flights(tail, &flights)?;
            Ok((flights, design))
        })
        .collect()
}
