//! One flight, step by step.
//!
//! A difficult file. The state is airspeed relative to the mean wind, pressure altitude, vertical speed, pitch, thrust,
//! mass and a position with a direction on the sphere. Along the airspeed the equation of motion is `[flow.7]`.
//! Airspeed and mass are predicted by the two-step Adams–Bashforth rule, the forces are evaluated once there, and both
//! are corrected by the trapezoidal rule: second order for one evaluation per step. The fast heave mode is integrated
//! implicitly, wind by the exact difference between the two ends of a step. The energy and fuel balances in `state.rs`
//! check all that.

mod air_ahead;
mod controls;
mod error;
mod forces;
mod seen;
mod steering;

use units::PressureAltitude;

use crate::aircraft::AircraftTruth;
use crate::random::{Purpose, Streams};
use crate::route::{Autopilot, Earth, FlightPlan};
use crate::smooth::SmoothErrors;
use crate::state::{EnergyBook, FUEL_TEMPERATURE_AT_START_K, MassBook, TrueState};
use crate::terms::{FuelShares, MAXIMUM_ENGINES, Terms};
use crate::weather::{AirMass, DrydenFilters, Gusts, Patch, Turbulence, intensity_m_s};

pub use error::FlightError;

use air_ahead::AirAhead;
use controls::Controls;
use forces::{EarthHere, Forces, Motion};
use steering::Steering;

/// Time constant with which fuel in the wings approaches TAT, s.
const FUEL_TEMPERATURE_TIME_S: f64 = 7200.0;

/// Everything needed to fly one flight.
#[derive(Clone, Debug)]
pub(crate) struct FlightSetup<'a> {
    pub(crate) aircraft: &'a AircraftTruth,
    pub(crate) terms: Terms,
    pub(crate) earth: &'a Earth,
    pub(crate) autopilot: &'a Autopilot,
    pub(crate) plan: &'a FlightPlan,
    pub(crate) air: AirMass,
    pub(crate) turbulence: &'a Turbulence,
    pub(crate) patches: Vec<Patch>,
    pub(crate) smooth_errors: Option<&'a SmoothErrors>,
    pub(crate) streams: Streams,
    pub(crate) shares: FuelShares,
    pub(crate) roll_trim: RollTrim,
    /// Gross mass where the simulation starts, kg.
    pub(crate) start_mass_kg: f64,
    /// Fuel used until there, kg.
    pub(crate) start_fuel_used_kg: f64,
    /// Flown before the recording, s.
    pub(crate) settle_s: f64,
    /// Recording interval, s.
    pub(crate) interval_s: f64,
    /// Steps per interval.
    pub(crate) steps_per_interval: u32,
}

/// Roll held in straight flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RollTrim {
    pub(crate) start_deg: f64,
    pub(crate) drift_deg_h: f64,
    pub(crate) limit_deg: f64,
}

/// The quantities that the sensors read at every step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    pub(crate) static_pressure_pa: f64,
    pub(crate) mach: f64,
    pub(crate) total_air_temperature_k: f64,
    pub(crate) ground_speed_m_s: f64,
    pub(crate) roll_deg: f64,
    pub(crate) drift_deg: f64,
    pub(crate) fuel_flow_kg_s: [f64; MAXIMUM_ENGINES],
}

/// The energy and fuel balances of a flight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Books {
    pub(crate) energy: EnergyBook,
    pub(crate) mass: MassBook,
}

/// Flies. `observe` is called at every step of the recording, with the length of the step and, where a sample falls,
/// the whole true state.
pub(crate) fn fly(
    setup: &FlightSetup<'_>,
    mut observe: impl FnMut(&Instant, f64, Option<&TrueState>),
) -> Result<Books, FlightError> {
    let step_s = setup.interval_s / f64::from(setup.steps_per_interval);
    let settle_steps = (setup.settle_s / step_s).round();
    let intervals = (setup.plan.duration_s / setup.interval_s + 1e-9).floor();
    let mut flying = Flying::start(setup, -settle_steps * step_s, step_s)?;
    let mut steps_left = settle_steps;
    while steps_left > 0.0 {
        flying.evaluate()?;
        flying.advance();
        steps_left -= 1.0;
    }
    flying.time_s = 0.0;

    let mut interval = 0.0;
    loop {
        flying.evaluate()?;
        if interval == 0.0 {
            flying.open_books();
        }
        flying.keep_books(interval >= intervals);
        let state = flying.true_state();
        observe(&flying.instant(), step_s, Some(&state));
        if interval >= intervals {
            return Ok(flying.books);
        }
        flying.advance();
        for _ in 1..setup.steps_per_interval {
            flying.evaluate()?;
            flying.keep_books(false);
            observe(&flying.instant(), step_s, None);
            flying.advance();
        }
        interval += 1.0;
        // By multiplication: a sum of steps would carry rounding into TIME.
        flying.time_s = interval * setup.interval_s;
    }
}

/// The flight while it is flown.
struct Flying<'a> {
    setup: &'a FlightSetup<'a>,
    step_s: f64,
    time_s: f64,
    motion: Motion,
    steering: Steering,
    air: AirAhead,
    here: EarthHere,
    controls: Controls,
    gusts: Gusts,
    gust_filters: Option<DrydenFilters>,
    gust_random: crate::random::Stream,
    gust_sigma_m_s: f64,
    drift_wobble_rad: f64,
    forces: Forces,
    /// Acceleration without wind change, and fuel flow, of the step before, for the prediction.
    before: Option<(f64, f64)>,
    /// Where the last step began, for the correction.
    begun: Option<Begun>,
    wind_change_m_s2: f64,
    books: Books,
    opened_speed_m_s: f64,
    opened_mass_kg: f64,
}

/// The state from which a step was made.
#[derive(Clone, Copy, Debug)]
struct Begun {
    smooth_airspeed_m_s: f64,
    mass_kg: f64,
    fuel_used_kg: f64,
    acceleration_m_s2: f64,
    fuel_flow_kg_s: f64,
}

impl<'a> Flying<'a> {
    fn start(setup: &'a FlightSetup<'a>, time_s: f64, step_s: f64) -> Result<Self, FlightError> {
        let plan = setup.plan;
        let steering = Steering::start(&plan.waypoints);
        let air = AirAhead::start(&setup.air, steering.place());
        let pressure_altitude_m = PressureAltitude::feet(plan.pressure_altitude_ft).to_meters();
        let deviation_k = air.now().isa_deviation_k;
        let standard_k =
            atmos::isa::temperature(PressureAltitude::meters(pressure_altitude_m))?.to_kelvin();
        let speed_of_sound_m_s = forces::speed_of_sound_m_s(standard_k + deviation_k);
        let motion = Motion {
            smooth_airspeed_m_s: plan.mach * speed_of_sound_m_s,
            pressure_altitude_m,
            // A warm column is taller; its mean temperature is about 250 K.
            geometric_altitude_m: pressure_altitude_m * (1.0 + deviation_k / 250.0),
            vertical_speed_m_s: 0.0,
            pitch_rad: 0.0,
            mass_kg: setup.start_mass_kg,
            thrust_n: 0.0,
            fuel_used_kg: setup.start_fuel_used_kg,
            fuel_temperature_k: FUEL_TEMPERATURE_AT_START_K,
        };
        let mut flying = Self {
            setup,
            step_s,
            time_s,
            motion,
            here: EarthHere::default(),
            controls: Controls::start(setup.autopilot, plan, step_s),
            steering,
            air,
            gusts: Gusts::default(),
            gust_filters: None,
            gust_random: setup.streams.stream(Purpose::Gusts),
            gust_sigma_m_s: 0.0,
            drift_wobble_rad: 0.0,
            forces: Forces::default(),
            before: None,
            begun: None,
            wind_change_m_s2: 0.0,
            books: Books::default(),
            opened_speed_m_s: 0.0,
            opened_mass_kg: 0.0,
        };
        flying.renew_here();
        // In trim at the start: thrust equals drag.
        flying.evaluate()?;
        flying.motion.thrust_n = flying.forces.drag_n;
        flying.controls.trim(flying.forces.drag_n / flying.motion.mass_kg, plan.mach);
        Ok(flying)
    }

    /// Forces and fuel flow at the present state.
    fn evaluate(&mut self) -> Result<(), FlightError> {
        self.forces = forces::evaluate(&forces::Circumstances {
            setup: self.setup,
            time_s: self.time_s,
            motion: &self.motion,
            place: self.steering.place(),
            air: self.air.now(),
            here: &self.here,
            gusts: &self.gusts,
            roll_trim_deg: self.roll_trim_deg(),
            bank_deg: self.steering.roll_deg(),
            lift_acceleration_m_s2: self.controls.lift_acceleration_m_s2(),
        })?;
        if let Some(begun) = self.begun.take() {
            let half_s = 0.5 * self.step_s;
            let motion = &mut self.motion;
            motion.smooth_airspeed_m_s = begun.smooth_airspeed_m_s
                + half_s * (begun.acceleration_m_s2 + self.forces.acceleration_m_s2)
                + self.step_s * self.wind_change_m_s2;
            let burnt_kg = half_s * (begun.fuel_flow_kg_s + self.forces.fuel_flow_total_kg_s);
            motion.mass_kg = begun.mass_kg - burnt_kg;
            motion.fuel_used_kg = begun.fuel_used_kg + burnt_kg;
            let mean_speed = 0.5 * (begun.smooth_airspeed_m_s + motion.smooth_airspeed_m_s);
            self.books.energy.wind_change_j_kg += self.wind_change_m_s2 * mean_speed * self.step_s;
        }
        self.check_limits()
    }

    /// From this step to the next.
    fn advance(&mut self) {
        let step_s = self.step_s;
        let forces = self.forces;

        // Position and air at the end of the step first: the wind's change over it is then exact.
        let turning = self.steering.advance(
            forces.ground_speed_m_s,
            forces.smooth_airspeed_m_s,
            self.setup.autopilot,
            step_s,
        );
        let wind_before = self.air.now().wind_m_s;
        let renewed = self.air.advance(
            &self.setup.air,
            self.steering.place(),
            forces.ground_speed_m_s * step_s,
            turning,
        );
        let change = crate::vector::subtract(self.air.now().wind_m_s, wind_before);
        self.wind_change_m_s2 = -crate::vector::dot(change, forces.air_direction) / step_s;

        let (acceleration_before, fuel_flow_before) =
            self.before.unwrap_or((forces.acceleration_m_s2, forces.fuel_flow_total_kg_s));
        let acceleration =
            1.5 * forces.acceleration_m_s2 - 0.5 * acceleration_before + self.wind_change_m_s2;
        let fuel_flow = 1.5 * forces.fuel_flow_total_kg_s - 0.5 * fuel_flow_before;
        self.before = Some((forces.acceleration_m_s2, forces.fuel_flow_total_kg_s));

        let motion = &mut self.motion;
        self.begun = Some(Begun {
            smooth_airspeed_m_s: motion.smooth_airspeed_m_s,
            mass_kg: motion.mass_kg,
            fuel_used_kg: motion.fuel_used_kg,
            acceleration_m_s2: forces.acceleration_m_s2,
            fuel_flow_kg_s: forces.fuel_flow_total_kg_s,
        });
        motion.smooth_airspeed_m_s += acceleration * step_s;
        motion.mass_kg -= fuel_flow * step_s;
        motion.fuel_used_kg += fuel_flow * step_s;
        motion.fuel_temperature_k += (forces.total_air_temperature_k - motion.fuel_temperature_k)
            * step_s
            / FUEL_TEMPERATURE_TIME_S;
        self.controls.advance(motion, &forces, self.setup.aircraft, self.time_s, step_s);
        motion.geometric_altitude_m += forces.geometric_climb_m_s * step_s;

        if renewed {
            self.renew_here();
        }
        self.advance_gusts();
        self.time_s += step_s;
    }

    fn renew_here(&mut self) {
        self.here = EarthHere::at(
            self.steering.place(),
            self.motion.geometric_altitude_m,
            self.forces.ground_speed_m_s,
            self.setup,
        );
    }

    fn advance_gusts(&mut self) {
        let sigma =
            intensity_m_s(&self.setup.patches, self.setup.turbulence.elsewhere_m_s, self.time_s);
        self.gust_sigma_m_s = sigma;
        if sigma <= 0.0 {
            self.gust_filters = None;
            self.gusts = Gusts::default();
            self.drift_wobble_rad *= (-self.step_s / 3.0).exp();
            return;
        }
        let (speed, step_s) = (self.motion.smooth_airspeed_m_s, self.step_s);
        let random = &mut self.gust_random;
        let filters =
            self.gust_filters.get_or_insert_with(|| DrydenFilters::new(speed, step_s, random));
        let unit = filters.advance(&mut self.gust_random);
        self.gusts = Gusts {
            head_on_m_s: sigma * unit.head_on_m_s,
            from_left_m_s: sigma * unit.from_left_m_s,
            upward_m_s: sigma * unit.upward_m_s,
        };
        // The fin turns the nose into the gust within some seconds.
        let share = 1.0 - (-step_s / 3.0).exp();
        self.drift_wobble_rad += (self.gusts.from_left_m_s / speed - self.drift_wobble_rad) * share;
    }

    fn roll_trim_deg(&self) -> f64 {
        let trim = &self.setup.roll_trim;
        (trim.start_deg + trim.drift_deg_h * self.time_s / 3600.0)
            .clamp(-trim.limit_deg, trim.limit_deg)
    }

    fn open_books(&mut self) {
        self.books = Books::default();
        self.opened_speed_m_s = self.motion.smooth_airspeed_m_s;
        self.opened_mass_kg = self.motion.mass_kg;
    }

    /// Trapezoids: half a step's weight at both ends.
    fn keep_books(&mut self, last: bool) {
        let first = self.books.mass.fuel_flow_integral_kg == 0.0;
        let weight_s = if first || last { 0.5 * self.step_s } else { self.step_s };
        let forces = &self.forces;
        let power = weight_s * self.motion.smooth_airspeed_m_s;
        let energy = &mut self.books.energy;
        energy.thrust_j_kg += power * self.motion.thrust_n / self.motion.mass_kg;
        energy.drag_j_kg -= power * forces.drag_n / self.motion.mass_kg;
        energy.gravity_j_kg += power * forces.gravity_along_m_s2;
        energy.coriolis_j_kg += power * forces.coriolis_along_m_s2;
        self.books.mass.fuel_flow_integral_kg += weight_s * forces.fuel_flow_total_kg_s;
        let speed = self.motion.smooth_airspeed_m_s;
        energy.kinetic_gain_j_kg =
            0.5 * (speed * speed - self.opened_speed_m_s * self.opened_speed_m_s);
        self.books.mass.mass_lost_kg = self.opened_mass_kg - self.motion.mass_kg;
    }

    fn check_limits(&self) -> Result<(), FlightError> {
        let time_s = self.time_s;
        let target = self.controls.mach_target();
        // Written so that NaN is refused too.
        if self.forces.mach.is_nan() || self.forces.mach < target - 0.04 {
            return Err(FlightError::Thrust { time_s, mach: self.forces.mach, target });
        }
        let maximum = self.setup.aircraft.envelope.maximum_lift_coefficient;
        let lift_coefficient = self.forces.level_lift_coefficient;
        if lift_coefficient > maximum {
            return Err(FlightError::LiftCoefficient { time_s, lift_coefficient, maximum });
        }
        let fuel_on_board_kg = self.setup.plan.loading.fuel_on_board_kg();
        if self.motion.fuel_used_kg >= fuel_on_board_kg {
            return Err(FlightError::Fuel { time_s, fuel_on_board_kg });
        }
        Ok(())
    }
}
