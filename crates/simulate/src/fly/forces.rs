//! Forces and fuel flow at one instant. A hot file: everything here runs once per step.

use atmos::constants::{RATIO_OF_SPECIFIC_HEATS, SPECIFIC_GAS_CONSTANT_J_KG_K};
use units::convert::STANDARD_GRAVITY_M_S2;
use units::{Angle, Density, GeometricAltitude, PressureAltitude, Temperature, TrueAirspeed};

use super::{FlightError, FlightSetup};
use crate::aircraft::{
    HEATING_FACTOR, exhaust_gas_temperature_k, maximum_thrust_n, n1_percent, n2_percent,
    pressure_rise,
};
use crate::terms::{DragInputs, FuelInputs, MAXIMUM_ENGINES};
use crate::vector::{Place, Vector, combine, dot, east_and_north};
use crate::weather::{Air, Gusts};

/// The state of motion and fuel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    pub(crate) smooth_airspeed_m_s: f64,
    pub(crate) pressure_altitude_m: f64,
    pub(crate) geometric_altitude_m: f64,
    pub(crate) vertical_speed_m_s: f64,
    /// Pitch beyond that of level flight in still air.
    pub(crate) pitch_rad: f64,
    pub(crate) mass_kg: f64,
    pub(crate) thrust_n: f64,
    pub(crate) fuel_used_kg: f64,
    pub(crate) fuel_temperature_k: f64,
}

/// The Earth's gravity and rotation here; renewed every 2 km.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EarthHere {
    /// Acceleration that lift has to carry, m/s².
    pub(crate) effective_gravity_m_s2: f64,
    /// f·(slope on) and f·(Coriolis on), 1/s: factors of the geostrophic and of the whole wind.
    slope_s: f64,
    coriolis_s: f64,
}

impl EarthHere {
    pub(crate) fn at(
        place: &Place,
        geometric_altitude_m: f64,
        ground_speed_m_s: f64,
        setup: &FlightSetup<'_>,
    ) -> Self {
        let latitude = Angle::radians(place.latitude_rad());
        let height = GeometricAltitude::meters(geometric_altitude_m);
        let terms = &setup.terms.earth;
        let mut gravity = STANDARD_GRAVITY_M_S2;
        if setup.earth.local_gravity.is_on() || terms.local_gravity {
            gravity = atmos::gravity::gravity(latitude, height).to_meters_per_second_squared();
        }
        if setup.earth.rotating_earth.is_on() || terms.rotating_earth {
            let (east, north) = east_and_north(place.position);
            gravity -= atmos::gravity::earth_motion_acceleration(
                latitude,
                ground_speed_m_s * dot(place.along, east),
                ground_speed_m_s * dot(place.along, north),
                height,
            )
            .to_meters_per_second_squared();
        }
        let coriolis = atmos::gravity::coriolis_parameter(latitude);
        let slope = setup.earth.isobaric_slope.factor() + terms.extra_slope;
        Self {
            effective_gravity_m_s2: gravity,
            slope_s: coriolis * slope,
            coriolis_s: coriolis * setup.earth.coriolis_along_path.factor(),
        }
    }
}

/// The inputs of the forces.
pub(crate) struct Circumstances<'a> {
    pub(crate) setup: &'a FlightSetup<'a>,
    pub(crate) time_s: f64,
    pub(crate) motion: &'a Motion,
    pub(crate) place: &'a Place,
    pub(crate) air: &'a Air,
    pub(crate) here: &'a EarthHere,
    pub(crate) gusts: &'a Gusts,
    /// Roll held in straight flight, and that of the turn.
    pub(crate) roll_trim_deg: f64,
    pub(crate) bank_deg: f64,
    pub(crate) lift_acceleration_m_s2: f64,
}

/// Forces, speeds and fuel at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Forces {
    pub(crate) static_pressure_pa: f64,
    pub(crate) pressure_ratio: f64,
    pub(crate) static_air_temperature_k: f64,
    pub(crate) temperature_ratio: f64,
    pub(crate) total_air_temperature_k: f64,
    pub(crate) speed_of_sound_m_s: f64,
    pub(crate) smooth_airspeed_m_s: f64,
    pub(crate) true_airspeed_m_s: f64,
    pub(crate) mach: f64,
    pub(crate) dynamic_pressure_pa: f64,
    pub(crate) drift_rad: f64,
    pub(crate) ground_speed_m_s: f64,
    pub(crate) tail_wind_m_s: f64,
    pub(crate) wind_from_left_m_s: f64,
    /// Direction of the airspeed.
    pub(crate) air_direction: Vector,
    pub(crate) upward_air_m_s: f64,
    pub(crate) geometric_climb_m_s: f64,
    pub(crate) climb_angle_rad: f64,
    pub(crate) center_of_gravity_percent_mac: f64,
    pub(crate) lift_coefficient: f64,
    /// Without the vertical acceleration of gusts.
    pub(crate) level_lift_coefficient: f64,
    pub(crate) drag_coefficient: f64,
    pub(crate) drag_n: f64,
    pub(crate) maximum_thrust_n: f64,
    pub(crate) gravity_along_m_s2: f64,
    pub(crate) coriolis_along_m_s2: f64,
    /// Of the airspeed relative to the mean wind, without the wind's change along the path.
    pub(crate) acceleration_m_s2: f64,
    pub(crate) anti_ice: bool,
    pub(crate) fuel_flow_kg_s: [f64; MAXIMUM_ENGINES],
    pub(crate) fuel_flow_total_kg_s: f64,
}

/// Speed of sound, m/s.
pub(crate) fn speed_of_sound_m_s(static_air_temperature_k: f64) -> f64 {
    atmos::isa::speed_of_sound(Temperature::kelvin(static_air_temperature_k)).to_meters_per_second()
}

/// Evaluates them: air, then wind triangle and slopes, then drag, then fuel.
pub(crate) fn evaluate(of: &Circumstances<'_>) -> Result<Forces, FlightError> {
    let mut forces = Forces::default();
    let standard_k = air(of, &mut forces)?;
    wind_and_slope(of, standard_k, &mut forces);
    let (drag_error, fuel_error) = lift_and_drag(of, &mut forces);
    forces.drag_coefficient *= 1.0 + drag_error;
    forces.drag_n = forces.drag_coefficient
        * forces.dynamic_pressure_pa
        * of.setup.aircraft.airframe.wing_area_m2;
    fuel(of, fuel_error, &mut forces);
    forces.acceleration_m_s2 = (of.motion.thrust_n - forces.drag_n) / of.motion.mass_kg
        + forces.gravity_along_m_s2
        + forces.coriolis_along_m_s2;
    Ok(forces)
}

/// State of the air and speed in it; returns the temperature of the standard day, K.
fn air(of: &Circumstances<'_>, forces: &mut Forces) -> Result<f64, FlightError> {
    let motion = of.motion;
    let pressure_altitude = PressureAltitude::meters(motion.pressure_altitude_m);
    let static_pressure = atmos::isa::pressure(pressure_altitude)?;
    let standard_k = atmos::isa::temperature(pressure_altitude)?.to_kelvin();
    let sat_k = standard_k + of.air.isa_deviation_k;
    forces.static_pressure_pa = static_pressure.to_pascals();
    forces.pressure_ratio = atmos::isa::pressure_ratio(static_pressure);
    forces.static_air_temperature_k = sat_k;
    forces.temperature_ratio = atmos::isa::temperature_ratio(Temperature::kelvin(sat_k));
    forces.speed_of_sound_m_s = speed_of_sound_m_s(sat_k);
    forces.smooth_airspeed_m_s = motion.smooth_airspeed_m_s;
    forces.true_airspeed_m_s = motion.smooth_airspeed_m_s + of.gusts.head_on_m_s;
    let mach = forces.true_airspeed_m_s / forces.speed_of_sound_m_s;
    forces.mach = mach;
    forces.dynamic_pressure_pa =
        0.5 * RATIO_OF_SPECIFIC_HEATS * forces.static_pressure_pa * mach * mach;
    forces.total_air_temperature_k = sat_k * (1.0 + HEATING_FACTOR * mach * mach);
    Ok(standard_k)
}

/// The wind triangle, and the effect of slope, vertical air motion and Coriolis force along the airspeed.
fn wind_and_slope(of: &Circumstances<'_>, standard_k: f64, forces: &mut Forces) {
    let Circumstances { motion, place, air, here, gusts, .. } = *of;
    let speed_m_s = forces.smooth_airspeed_m_s;
    // The track is given, the heading follows.
    let right = place.right();
    forces.tail_wind_m_s = dot(air.wind_m_s, place.along);
    forces.wind_from_left_m_s = dot(air.wind_m_s, right);
    let sine = forces.wind_from_left_m_s / speed_m_s;
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    forces.drift_rad = sine.asin();
    forces.ground_speed_m_s = speed_m_s * cosine + forces.tail_wind_m_s;
    forces.air_direction = combine(cosine, place.along, -sine, right);
    let air_right = combine(sine, place.along, cosine, right);

    // [flow.4]: in the northern hemisphere the surface falls ahead where geostrophic wind comes from the left.
    let gravity = here.effective_gravity_m_s2;
    let surface_slope = -here.slope_s * dot(air.geostrophic_m_s, air_right) / gravity;
    forces.upward_air_m_s = air.vertical_wind_m_s + gusts.upward_m_s;
    forces.geometric_climb_m_s = motion.vertical_speed_m_s * forces.static_air_temperature_k
        / standard_k
        + speed_m_s * surface_slope;
    forces.climb_angle_rad = (forces.geometric_climb_m_s - forces.upward_air_m_s) / speed_m_s;
    forces.gravity_along_m_s2 = -gravity * forces.climb_angle_rad;
    forces.coriolis_along_m_s2 = -here.coriolis_s * dot(air.wind_m_s, air_right);
}

/// Lift and drag coefficient; returns the smooth errors of drag and fuel flow there.
fn lift_and_drag(of: &Circumstances<'_>, forces: &mut Forces) -> (f64, f64) {
    let Circumstances { setup, motion, here, .. } = *of;
    let airframe = &setup.aircraft.airframe;
    let turned = setup.earth.load_factor.is_on() || setup.terms.earth.load_factor;
    let load_factor =
        if turned { 1.0 / (of.roll_trim_deg + of.bank_deg).to_radians().cos() } else { 1.0 };
    let area_pa_m2 = forces.dynamic_pressure_pa * airframe.wing_area_m2;
    forces.level_lift_coefficient =
        motion.mass_kg * here.effective_gravity_m_s2 * load_factor / area_pa_m2;
    forces.lift_coefficient =
        forces.level_lift_coefficient + motion.mass_kg * of.lift_acceleration_m_s2 / area_pa_m2;
    forces.center_of_gravity_percent_mac = setup.plan.center_of_gravity_percent_mac
        + setup.plan.center_of_gravity_travel_percent_mac_h * of.time_s / 3600.0;
    let sat_k = forces.static_air_temperature_k;
    let reynolds_number = atmos::viscosity::reynolds_number(
        Density::kilograms_per_cubic_meter(
            forces.static_pressure_pa / (SPECIFIC_GAS_CONSTANT_J_KG_K * sat_k),
        ),
        TrueAirspeed::meters_per_second(forces.true_airspeed_m_s),
        airframe.mean_aerodynamic_chord_m,
        atmos::viscosity::dynamic_viscosity(Temperature::kelvin(sat_k)),
    );
    forces.drag_coefficient = setup.terms.drag_coefficient(
        airframe,
        &DragInputs {
            lift_coefficient: forces.lift_coefficient,
            mach: forces.mach,
            reynolds_number,
            center_of_gravity_percent_mac: forces.center_of_gravity_percent_mac,
            // A wing held low adds drag; a coordinated turn adds lift.
            roll_deg: of.roll_trim_deg,
        },
    );
    setup.smooth_errors.map_or((0.0, 0.0), |errors| {
        errors.at(forces.mach, forces.level_lift_coefficient, motion.pressure_altitude_m)
    })
}

/// Thrust limit and fuel flow.
fn fuel(of: &Circumstances<'_>, error: f64, forces: &mut Forces) {
    let Circumstances { setup, motion, .. } = *of;
    let engine = &setup.aircraft.engine;
    let heating = 1.0 + HEATING_FACTOR * forces.mach * forces.mach;
    forces.maximum_thrust_n = f64::from(engine.count)
        * maximum_thrust_n(
            engine,
            forces.mach,
            forces.temperature_ratio * heating,
            forces.pressure_ratio * pressure_rise(heating),
        );
    forces.anti_ice =
        setup.plan.anti_ice.iter().any(|(from_s, to_s)| (*from_s..*to_s).contains(&of.time_s));
    let inputs = FuelInputs {
        mach: forces.mach,
        temperature_ratio: forces.temperature_ratio,
        static_pressure_pa: forces.static_pressure_pa,
        pressure_ratio: forces.pressure_ratio,
        thrust_n: motion.thrust_n,
        maximum_thrust_n: forces.maximum_thrust_n,
        anti_ice: forces.anti_ice,
        fuel_temperature_k: motion.fuel_temperature_k,
    };
    forces.fuel_flow_kg_s = setup.terms.fuel_flow_kg_s(engine, &inputs, &setup.shares);
    for flow in &mut forces.fuel_flow_kg_s {
        *flow *= 1.0 + error;
    }
    forces.fuel_flow_total_kg_s = forces.fuel_flow_kg_s.iter().sum();
}

/// Rotor speeds and exhaust temperatures, engine by engine.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rotors {
    pub(crate) n1_percent: [f64; MAXIMUM_ENGINES],
    pub(crate) n2_percent: [f64; MAXIMUM_ENGINES],
    pub(crate) exhaust_gas_temperature_k: [f64; MAXIMUM_ENGINES],
}

/// Only where a sample falls.
pub(crate) fn rotors(setup: &FlightSetup<'_>, motion: &Motion, forces: &Forces) -> Rotors {
    let engine = &setup.aircraft.engine;
    let heating = 1.0 + HEATING_FACTOR * forces.mach * forces.mach;
    let total_temperature_ratio = forces.temperature_ratio * heating;
    let total_pressure_ratio = forces.pressure_ratio * pressure_rise(heating);
    let mut rotors = Rotors::default();
    for k in 0..setup.aircraft.engines() {
        let thrust_n = motion.thrust_n * setup.shares[k];
        rotors.n1_percent[k] =
            n1_percent(engine, total_temperature_ratio, forces.pressure_ratio, thrust_n);
        rotors.n2_percent[k] = n2_percent(
            engine,
            forces.mach,
            total_temperature_ratio,
            forces.pressure_ratio,
            thrust_n,
        );
        rotors.exhaust_gas_temperature_k[k] = exhaust_gas_temperature_k(
            engine,
            forces.total_air_temperature_k,
            total_temperature_ratio,
            total_pressure_ratio,
            forces.fuel_flow_kg_s[k],
        );
    }
    rotors
}
