//! The inputs of effects at a segment or flight point.

use flight::effect::{EffectId, NeededInput};
use flight::{MAXIMUM_ENGINES, Segment, SegmentMeans, seconds_since_1970};
use perf_model::FlightPoint;
use units::OutOfDomain;

/// The inputs of effects at a segment. SI unless the name says otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectPoint {
    /// Instant, s since 1970.
    pub date_s: f64,
    /// Pressure altitude, m.
    pub pressure_altitude_m: f64,
    /// Static air temperature, K.
    pub static_air_temperature_k: f64,
    /// Whether static air temperature is assumed and not recorded.
    pub is_temperature_assumed: bool,
    /// Mach number.
    pub mach: f64,
    /// True airspeed, m/s.
    pub true_airspeed_m_s: f64,
    /// Ground speed, m/s.
    pub ground_speed_m_s: f64,
    /// Along-path acceleration, m/s².
    pub acceleration_m_s2: f64,
    /// Gross mass, kg.
    pub mass_kg: f64,
    /// Fuel used since engine start, kg.
    pub fuel_used_kg: f64,
    /// Share of each engine in the recorded fuel flow; equal shares where engines are not recorded apart.
    pub fuel_flow_share: [f64; MAXIMUM_ENGINES],
    /// Mean of the squared roll angle, degrees².
    pub roll_squared_deg2: Option<f64>,
    /// Drift angle, degrees: track minus heading.
    pub drift_deg: Option<f64>,
    /// Latitude, degrees.
    pub latitude_deg: Option<f64>,
    /// True heading, degrees.
    pub true_heading_deg: Option<f64>,
    /// Center of gravity, % of the mean aerodynamic chord.
    pub center_of_gravity_percent_mac: Option<f64>,
    /// Share of the samples with anti-ice bleed on.
    pub anti_ice: Option<f64>,
    /// Net thrust of all engines over pressure ratio that the recorded N2 indicates, N. It needs a deck (N2 over
    /// corrected thrust), which the maker of the points may have; `None` without one, or where N2 is not recorded.
    pub corrected_thrust_by_n2_n: Option<f64>,
}

impl EffectPoint {
    /// The point for which a prediction is wanted: level, unaccelerated, wings level, no wind. Anti-ice bleed is off,
    /// and center of gravity, latitude and heading are unknown, where the flight point does not state them; `date_s` is
    /// 0 without a date.
    ///
    /// # Errors
    /// [`OutOfDomain`] for a pressure altitude outside the atmosphere's domain.
    pub fn from_flight_point(point: &FlightPoint, engines: usize) -> Result<Self, OutOfDomain> {
        let sat = point.static_air_temperature()?;
        let true_airspeed_m_s =
            atmos::airspeed::mach_to_true_airspeed(point.mach, sat).to_meters_per_second();
        let engines = engines.clamp(1, MAXIMUM_ENGINES);
        let mut fuel_flow_share = [0.0; MAXIMUM_ENGINES];
        fuel_flow_share[..engines].fill(1.0 / engines as f64);
        let date_s = point.date.map_or(0.0, seconds_since_1970);
        Ok(Self {
            date_s,
            pressure_altitude_m: point.pressure_altitude.to_meters(),
            static_air_temperature_k: sat.to_kelvin(),
            is_temperature_assumed: false,
            mach: point.mach.value(),
            true_airspeed_m_s,
            ground_speed_m_s: true_airspeed_m_s,
            acceleration_m_s2: 0.0,
            mass_kg: point.mass.to_kilograms(),
            fuel_used_kg: 0.0,
            fuel_flow_share,
            roll_squared_deg2: None,
            drift_deg: None,
            latitude_deg: point.latitude.map(units::Angle::to_degrees),
            true_heading_deg: point.true_heading.map(units::Angle::to_degrees),
            center_of_gravity_percent_mac: point.center_of_gravity_percent_mac,
            anti_ice: Some(if point.anti_ice == Some(true) { 1.0 } else { 0.0 }),
            corrected_thrust_by_n2_n: None,
        })
    }

    /// The point of a segment. `engines` is the aircraft's number of engines.
    #[must_use]
    pub fn from_segment(segment: &Segment, engines: usize) -> Self {
        Self {
            is_temperature_assumed: segment.temperature_assumed,
            ..Self::from_means(&segment.means, segment.identity.start_s(), engines)
        }
    }

    /// The point of a segment's means; its flight started `start_s` s since 1970. `engines` is the aircraft's number of
    /// engines. There is no deck here, so the thrust indicated by N2 stays unset; temperature counts as recorded.
    #[must_use]
    pub fn from_means(means: &SegmentMeans, start_s: f64, engines: usize) -> Self {
        let engines = engines.clamp(1, MAXIMUM_ENGINES);
        let total: f64 = means.fuel_flow_engine_kg_s.iter().sum();
        let mut fuel_flow_share = [0.0; MAXIMUM_ENGINES];
        for (engine, share) in fuel_flow_share.iter_mut().enumerate().take(engines) {
            *share = match means.fuel_flow_engine_kg_s.get(engine) {
                Some(flow) if total > 0.0 => flow / total,
                _ => 1.0 / engines as f64,
            };
        }
        Self {
            date_s: start_s + means.time_s,
            pressure_altitude_m: means.pressure_altitude_m,
            static_air_temperature_k: means.static_air_temperature_k,
            is_temperature_assumed: false,
            mach: means.mach,
            true_airspeed_m_s: means.true_airspeed_m_s,
            ground_speed_m_s: means.ground_speed_m_s,
            acceleration_m_s2: means.acceleration_m_s2,
            mass_kg: means.mass_kg,
            fuel_used_kg: means.fuel_used_kg,
            fuel_flow_share,
            roll_squared_deg2: means
                .roll_squared_deg2
                .or_else(|| means.roll_deg.map(|roll| roll * roll)),
            drift_deg: means.drift_deg,
            latitude_deg: means.latitude_deg,
            true_heading_deg: means.true_heading_deg,
            center_of_gravity_percent_mac: means.center_of_gravity_percent_mac,
            anti_ice: means.anti_ice,
            corrected_thrust_by_n2_n: None,
        }
    }

    /// The first required input of an effect that this point lacks; `None` where the effect can be predicted.
    ///
    /// Inputs that have a substitute ([`NeededInput::has_substitute`]) are never lacking.
    #[must_use]
    pub fn lacks(&self, effect: EffectId) -> Option<NeededInput> {
        let indispensable = effect.entry().needs.iter().filter(|needed| !needed.has_substitute());
        indispensable.copied().find(|needed| !self.has(*needed))
    }

    /// Whether the input is recorded; fuel flow engine by engine always is, as equal shares.
    #[must_use]
    pub const fn has(&self, input: NeededInput) -> bool {
        match input {
            NeededInput::CenterOfGravity => self.center_of_gravity_percent_mac.is_some(),
            NeededInput::Roll => self.roll_squared_deg2.is_some(),
            NeededInput::FuelFlowPerEngine => true,
            NeededInput::AntiIce => self.anti_ice.is_some(),
            NeededInput::Latitude => self.latitude_deg.is_some(),
            NeededInput::TrueHeading => self.true_heading_deg.is_some(),
            NeededInput::Drift => self.drift_deg.is_some(),
            NeededInput::StaticAirTemperature => !self.is_temperature_assumed,
        }
    }
}
