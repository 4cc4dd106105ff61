//! Forces and fuel flow at one instant. A hot file: everything here runs once a step.

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

/// What moves and burns.
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

/// What the Earth does here; renewed every 2 km.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct EarthHere {
    /// What lift has to carry per mass, m/s².
    pub(crate) effective_gravity_m_s2: f64,
    /// f·(slope on) and f·(Coriolis on), 1/s: what the geostrophic and the whole wind are multiplied with.
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

/// What the forces are evaluated for.
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
    /// Of the airspeed against the mean wind, without the wind's change along the path.
    pub(crate) acceleration_m_s2: f64,
    pub(crate) anti_ice: bool,
    pub(crate) fuel_flow_kg_s: [f64; MAXIMUM_ENGINES],
    pub(crate) fuel_flow_total_kg_s: f64,
}

/// Speed of sound, m/s.
pub(crate) fn speed_of_sound_m_s(static_air_temperature_k: f64) -> f64 {
    atmos::isa::speed_of_sound(Temperature::kelvin(static_air_temperature_k)).to_meters_per_second()
}

/// Evaluates them.
pub(crate) fn evaluate(of: &Circumstances<'_>) -> Result<Forces, FlightError> {
    let Circumstances { setup, motion, place, air, here, gusts, .. } = *of;
    let airframe = &setup.aircraft.airframe;
    let engine = &setup.aircraft.engine;

    let pressure_altitude = PressureAltitude::meters(motion.pressure_altitude_m);
    let static_pressure = atmos::isa::pressure(pressure_altitude)?;
    let standard_k = atmos::isa::temperature(pressure_altitude)?.to_kelvin();
    let static_air_temperature_k = standard_k + air.isa_deviation_k;
    let sat = Temperature::kelvin(static_air_temperature_k);
    let static_pressure_pa = static_pressure.to_pascals();
    let speed_of_sound = speed_of_sound_m_s(static_air_temperature_k);

    let smooth_airspeed_m_s = motion.smooth_airspeed_m_s;
    let true_airspeed_m_s = smooth_airspeed_m_s + gusts.head_on_m_s;
    let mach = true_airspeed_m_s / speed_of_sound;
    let dynamic_pressure_pa = 0.5 * RATIO_OF_SPECIFIC_HEATS * static_pressure_pa * mach * mach;
    let heating = 1.0 + HEATING_FACTOR * mach * mach;

    // The wind triangle: the track is given, the nose finds its angle.
    let right = place.right();
    let tail_wind_m_s = dot(air.wind_m_s, place.along);
    let wind_from_left_m_s = dot(air.wind_m_s, right);
    let sine = wind_from_left_m_s / smooth_airspeed_m_s;
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    let ground_speed_m_s = smooth_airspeed_m_s * cosine + tail_wind_m_s;
    let air_direction = combine(cosine, place.along, -sine, right);
    let air_right = combine(sine, place.along, cosine, right);

    // [flow.4]: the surface falls ahead where geostrophic wind comes from the left, in the north.
    let gravity = here.effective_gravity_m_s2;
    let surface_slope = -here.slope_s * dot(air.geostrophic_m_s, air_right) / gravity;
    let upward_air_m_s = air.vertical_wind_m_s + gusts.upward_m_s;
    let geometric_climb_m_s = motion.vertical_speed_m_s * static_air_temperature_k / standard_k
        + smooth_airspeed_m_s * surface_slope;
    let climb_angle_rad = (geometric_climb_m_s - upward_air_m_s) / smooth_airspeed_m_s;
    let gravity_along_m_s2 = -gravity * climb_angle_rad;
    let coriolis_along_m_s2 = -here.coriolis_s * dot(air.wind_m_s, air_right);

    let turned = setup.earth.load_factor.is_on() || setup.terms.earth.load_factor;
    let load_factor =
        if turned { 1.0 / (of.roll_trim_deg + of.bank_deg).to_radians().cos() } else { 1.0 };
    let area_pa_m2 = dynamic_pressure_pa * airframe.wing_area_m2;
    let level_lift_coefficient = motion.mass_kg * gravity * load_factor / area_pa_m2;
    let lift_coefficient =
        level_lift_coefficient + motion.mass_kg * of.lift_acceleration_m_s2 / area_pa_m2;
    let center_of_gravity_percent_mac = setup.plan.center_of_gravity_percent_mac
        + setup.plan.center_of_gravity_travel_percent_mac_h * of.time_s / 3600.0;
    let density = Density::kilograms_per_cubic_meter(
        static_pressure_pa / (SPECIFIC_GAS_CONSTANT_J_KG_K * static_air_temperature_k),
    );
    let reynolds_number = atmos::viscosity::reynolds_number(
        density,
        TrueAirspeed::meters_per_second(true_airspeed_m_s),
        airframe.mean_aerodynamic_chord_m,
        atmos::viscosity::dynamic_viscosity(sat),
    );
    let mut drag_coefficient = setup.terms.drag_coefficient(
        airframe,
        &DragInputs {
            lift_coefficient,
            mach,
            reynolds_number,
            center_of_gravity_percent_mac,
            // A wing held low makes drag; a coordinated turn makes lift.
            roll_deg: of.roll_trim_deg,
        },
    );
    let (mut drag_error, mut fuel_error) = (0.0, 0.0);
    if let Some(errors) = setup.smooth_errors {
        (drag_error, fuel_error) =
            errors.at(mach, level_lift_coefficient, motion.pressure_altitude_m);
    }
    drag_coefficient *= 1.0 + drag_error;
    let drag_n = drag_coefficient * area_pa_m2;

    let temperature_ratio = atmos::isa::temperature_ratio(sat);
    let pressure_ratio = atmos::isa::pressure_ratio(static_pressure);
    let maximum = f64::from(engine.count)
        * maximum_thrust_n(
            engine,
            mach,
            temperature_ratio * heating,
            pressure_ratio * pressure_rise(heating),
        );
    let anti_ice =
        setup.plan.anti_ice.iter().any(|(from_s, to_s)| (*from_s..*to_s).contains(&of.time_s));
    let mut fuel_flow_kg_s = setup.terms.fuel_flow_kg_s(
        engine,
        &FuelInputs {
            mach,
            temperature_ratio,
            static_pressure_pa,
            pressure_ratio,
            thrust_n: motion.thrust_n,
            maximum_thrust_n: maximum,
            anti_ice,
            fuel_temperature_k: motion.fuel_temperature_k,
        },
        &setup.shares,
    );
    for flow in &mut fuel_flow_kg_s {
        *flow *= 1.0 + fuel_error;
    }

    Ok(Forces {
        static_pressure_pa,
        pressure_ratio,
        static_air_temperature_k,
        temperature_ratio,
        total_air_temperature_k: static_air_temperature_k * heating,
        speed_of_sound_m_s: speed_of_sound,
        smooth_airspeed_m_s,
        true_airspeed_m_s,
        mach,
        dynamic_pressure_pa,
        drift_rad: sine.asin(),
        ground_speed_m_s,
        tail_wind_m_s,
        wind_from_left_m_s,
        air_direction,
        upward_air_m_s,
        geometric_climb_m_s,
        climb_angle_rad,
        center_of_gravity_percent_mac,
        lift_coefficient,
        level_lift_coefficient,
        drag_coefficient,
        drag_n,
        maximum_thrust_n: maximum,
        gravity_along_m_s2,
        coriolis_along_m_s2,
        acceleration_m_s2: (motion.thrust_n - drag_n) / motion.mass_kg
            + gravity_along_m_s2
            + coriolis_along_m_s2,
        anti_ice,
        fuel_flow_total_kg_s: fuel_flow_kg_s.iter().sum(),
        fuel_flow_kg_s,
    })
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
