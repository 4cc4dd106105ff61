//! Flight states: what follows from recorded means without a drag table.

use atmos::{airspeed, isa};
use flight::SegmentMeans;
use units::{
    Acceleration, Density, Force, FuelFlowTotal, Mach, Mass, OutOfDomain, Pressure,
    PressureAltitude, Temperature, TrueAirspeed, Tsfc, check_within,
};

use crate::Aircraft;
use crate::forces;
use crate::fuel_flow::{self, CruiseConditions};
use crate::tsfc::tsfc;

/// The state of a segment, computed from its means (and not the mean of states).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentState {
    /// Static pressure, from pressure altitude alone.
    pub static_pressure: Pressure,
    /// Density, with the recorded static air temperature.
    pub density: Density,
    /// Ratio of static air temperature to that of the standard day at sea level.
    pub temperature_ratio: f64,
    /// Recorded Mach number.
    pub mach: Mach,
    /// Recorded true airspeed.
    pub true_airspeed: TrueAirspeed,
    /// Relates drag and fuel flow to each other at this state.
    pub conditions: CruiseConditions,
    /// Lift coefficient.
    pub lift_coefficient: f64,
    /// Recorded fuel flow of all engines.
    pub fuel_flow_total: FuelFlowTotal,
    /// Net thrust of all engines that corresponds to this fuel flow.
    pub net_thrust: Force,
    /// Observed drag coefficient; not positive where the recorded acceleration exceeds what the thrust can produce.
    pub drag_coefficient: f64,
}

impl SegmentState {
    /// The state of these means.
    ///
    /// Dynamic pressure is ½ρV² with ρ = p/(R·SAT) and V the *recorded* true airspeed; TSFC is taken at the recorded
    /// Mach number.
    ///
    /// # Errors
    /// [`OutOfDomain`] for a pressure altitude outside the atmosphere's domain, and for a static air temperature, Mach
    /// number, true airspeed, mass or fuel flow that is not positive.
    ///
    /// # Source
    /// Book `[forces.6]`, `[forces.11]`; Ghazi et al. 2020, equations (20)–(22).
    pub fn of_means(aircraft: &Aircraft, means: &SegmentMeans) -> Result<Self, OutOfDomain> {
        let sat = Temperature::kelvin(positive(
            "static air temperature",
            "K",
            means.static_air_temperature_k,
        )?);
        let mach = Mach::new(positive("Mach number", "Mach", means.mach)?);
        let true_airspeed = TrueAirspeed::meters_per_second(positive(
            "true airspeed",
            "m/s",
            means.true_airspeed_m_s,
        )?);
        let mass = Mass::kilograms(positive("gross mass", "kg", means.mass_kg)?);
        let fuel_flow_total = FuelFlowTotal::kilograms_per_second(positive(
            "fuel flow of all engines",
            "kg/s",
            means.fuel_flow_total_kg_s,
        )?);
        let acceleration = units::check_finite("acceleration", "m/s²", means.acceleration_m_s2)?;

        let static_pressure = isa::pressure(PressureAltitude::meters(means.pressure_altitude_m))?;
        let density = isa::density(static_pressure, sat);
        let temperature_ratio = isa::temperature_ratio(sat);
        let conditions = CruiseConditions {
            dynamic_pressure: airspeed::dynamic_pressure(density, true_airspeed),
            wing_area: aircraft.wing_area(),
            tsfc: tsfc(aircraft.tsfc_law(), temperature_ratio, mach),
            mass,
            acceleration: Acceleration::meters_per_second_squared(acceleration),
        };
        Ok(Self {
            static_pressure,
            density,
            temperature_ratio,
            mach,
            true_airspeed,
            conditions,
            lift_coefficient: forces::lift_coefficient(
                mass,
                conditions.dynamic_pressure,
                conditions.wing_area,
            ),
            fuel_flow_total,
            net_thrust: fuel_flow::net_thrust(fuel_flow_total, conditions.tsfc),
            drag_coefficient: fuel_flow::observed_drag_coefficient(&conditions, fuel_flow_total),
        })
    }

    /// Drag that corresponds to the fuel flow: net thrust minus the force that accelerates the aircraft.
    #[must_use]
    pub fn drag(&self) -> Force {
        self.net_thrust - forces::inertia(self.conditions.mass, self.conditions.acceleration)
    }

    /// TSFC at this temperature and Mach number.
    #[must_use]
    pub const fn tsfc(&self) -> Tsfc {
        self.conditions.tsfc
    }
}

fn positive(quantity: &'static str, unit: &'static str, value: f64) -> Result<f64, OutOfDomain> {
    check_within(quantity, unit, value, f64::MIN_POSITIVE, f64::MAX)
}
