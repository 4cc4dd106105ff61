//! How uncertain the residuals are: sensors propagated through the model by finite differences, channel by channel.

use effects::{EffectError, EffectModel, EffectPoint, Effects, KnownPoint, Response};
use perf_model::aircraft::{AirDataDrift, FlightBias, FuelFlowDrift, SensorDeviations};
use perf_model::variance::{mean_acceleration_deviation_m_s2, total_fuel_flow_relative_variance};
use serde::{Deserialize, Serialize};

use crate::math::cholesky::{semidefinite_cholesky, small_cholesky};
use crate::priors::FLIGHT_SPLIT_DEVIATION;
use crate::signals::channels::{ByChannel, Channels, MAXIMUM_CHANNELS};

/// Largest correlation of fuel flow and N2 within a flight. Our choice: a covariance has to be positive definite.
const MOST_CORRELATED: f64 = 0.99;
/// Place of the heating value among a segment's common loadings.
pub(crate) const HEATING_VALUE_LOADING: usize = 1;

/// Factors on the sensors' standard deviations, learnt from clean flights; 1 before.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoiseFactors {
    /// Of what differs from segment to segment: fuel flow, engine against engine, N2.
    pub within: [f64; 3],
    /// Of what all segments of one flight have in common, in the same order.
    pub between: [f64; 3],
    /// Of what fuel flow and N2 have in common from segment to segment, on their covariance in addition to these factors.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub fuel_flow_with_n2: f64,
    /// Whether what the aircraft file states of errors that a flight keeps and of drifting meters is noise in addition, which the
    /// factors multiply; factors of older files stand for it.
    #[serde(default, skip_serializing_if = "is_not")]
    pub with_flight_bias: bool,
}

impl Default for NoiseFactors {
    fn default() -> Self {
        Self {
            within: [1.0; 3],
            between: [1.0; 3],
            fuel_flow_with_n2: one(),
            with_flight_bias: true,
        }
    }
}

/// What files of older programs state.
const fn one() -> f64 {
    1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde asks")]
const fn is_not(value: &bool) -> bool {
    !*value
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde asks")]
fn is_one(factor: &f64) -> bool {
    factor.to_bits() == one().to_bits()
}

/// What is known of the noise in addition to the sensors' deviations from segment to segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Statistics {
    pub(crate) factors: NoiseFactors,
    pub(crate) flight_bias: FlightBias,
    pub(crate) fuel_flow_drift: FuelFlowDrift,
    pub(crate) air_data_drift: AirDataDrift,
}

impl Statistics {
    /// What factors multiply of what the aircraft file states.
    pub(crate) fn of(factors: &NoiseFactors, sensors: &SensorDeviations) -> Self {
        // Factors of older files stand for what a flight keeps, and for what drifts.
        let (flight_bias, fuel_flow_drift, air_data_drift) = if factors.with_flight_bias {
            (sensors.flight_bias, sensors.fuel_flow_drift, sensors.air_data_drift)
        } else {
            (FlightBias::none(), FuelFlowDrift::default(), AirDataDrift::default())
        };
        Self { factors: *factors, flight_bias, fuel_flow_drift, air_data_drift }
    }

    /// The drift of fuel flow, as large as the factors make it.
    pub(crate) fn drift(&self) -> FuelFlowDrift {
        let stated = self.fuel_flow_drift;
        FuelFlowDrift { percent: self.factors.between[0] * stated.percent, ..stated }
    }
}

/// Covariance of one segment's residuals: its own part, and its loadings on what the flight has in common.
#[derive(Clone, Debug)]
pub(crate) struct SegmentNoise {
    /// Lower triangle, row by row, of the Cholesky factor of the segment's own covariance.
    pub(crate) factor: [[f64; MAXIMUM_CHANNELS]; MAXIMUM_CHANNELS],
    /// Loadings: mass, heating value, one split a contrast, Mach number, SAT, pressure altitude, N2, then those of what wanders
    /// within the flight.
    pub(crate) common: Vec<ByChannel>,
    /// What wandering errors of air data make of each channel: lower triangle of the Cholesky factor of their covariance.
    pub(crate) air_data: [ByChannel; MAXIMUM_CHANNELS],
    /// What the recorded acceleration adds to each channel.
    pub(crate) acceleration: ByChannel,
}

/// What the noise of a segment depends on, in addition to the segment itself.
pub(crate) struct NoiseModel<'a> {
    pub(crate) model: &'a EffectModel<'a>,
    pub(crate) channels: Channels,
    pub(crate) statistics: &'a Statistics,
    /// The prediction of every channel from a response.
    pub(crate) predict: &'a dyn Fn(&Response) -> ByChannel,
}

/// Steps of slopes: of the mass a share of it.
const TEMPERATURE_STEP_K: f64 = 1e-3;
pub(crate) const ALTITUDE_STEP_M: f64 = 1e-3;
const ACCELERATION_STEP_M_S2: f64 = 1e-5;
const MASS_STEP: f64 = 1e-7;

/// The step in Mach number of slopes.
pub(crate) const fn mach_step(sensors: &SensorDeviations) -> f64 {
    sensors.mach.max(1e-6)
}

impl NoiseModel<'_> {
    /// Propagates the sensors' standard deviations.
    ///
    /// ```text
    /// C = diag(σ_meter²) + Σ_s J_s J_sᵀ σ_s²   within a segment, s over Mach number, SAT, V̇G, pressure altitude
    /// C_f = C + Σ_r u_r u_rᵀ                   over a flight, r over mass, heating value, split,
    ///                                          and Mach number, SAT, pressure altitude, N2 by `flight_bias`  [diagnosis.14]
    /// ```
    ///
    /// A share of the air data's part wanders instead ([`add_wander`](super::wander::add_wander)).
    pub(crate) fn segment_noise(
        &self,
        known: &KnownPoint,
        samples: usize,
        recorded: [bool; MAXIMUM_CHANNELS],
    ) -> Result<SegmentNoise, EffectError> {
        let point = known.point();
        let Self { model, channels, .. } = *self;
        let sensors = model.aircraft().sensors();
        let slopes = self.slopes(known)?;
        let relative_mass = sensors.mass.relative_to(units::Mass::kilograms(point.mass_kg));
        let covariance = self.own_covariance(&slopes, samples, recorded);
        let common = self.common_loadings(&slopes, relative_mass, recorded);
        let mut added = [0.0; MAXIMUM_CHANNELS];
        for channel in (0..channels.count()).filter(|&channel| recorded[channel]) {
            added[channel] = slopes.acceleration[channel] * point.acceleration_m_s2;
        }
        let factor = small_cholesky(&covariance, channels.count());
        let air_data = self.wandering_air_data(&slopes, recorded);
        Ok(SegmentNoise { factor, common, air_data, acceleration: added })
    }

    /// Slopes of every channel along what sensors measure, by central differences: of Mach number over the sensor's error, within
    /// which drag may rise, of all else over steps that are small beside any table's cell.
    fn slopes(&self, known: &KnownPoint) -> Result<Slopes, EffectError> {
        let point = known.point();
        let sensors = self.model.aircraft().sensors();
        let effects = Effects::none();
        let between = |step: f64, up: &Response, down: &Response| {
            let (up, down) = ((self.predict)(up), (self.predict)(down));
            let mut slope = [0.0; MAXIMUM_CHANNELS];
            for channel in 0..self.channels.count() {
                slope[channel] = (up[channel] - down[channel]) / (2.0 * step);
            }
            slope
        };
        let difference = |step: f64, moved: &dyn Fn(f64) -> EffectPoint| {
            let up = self.model.response_beside(&moved(step), &effects)?;
            let down = self.model.response_beside(&moved(-step), &effects)?;
            Ok::<ByChannel, EffectError>(between(step, &up, &down))
        };
        // Mass and acceleration leave the air as it is.
        let of_motion = |step: f64, moved: &dyn Fn(f64) -> (f64, f64)| {
            let at = |(mass_kg, acceleration_m_s2)| {
                self.model.response_with_mass_and_acceleration(known, mass_kg, acceleration_m_s2)
            };
            Ok::<ByChannel, EffectError>(between(step, &at(moved(step))?, &at(moved(-step))?))
        };
        let by_mach = difference(mach_step(sensors), &|step| EffectPoint {
            mach: point.mach + step,
            true_airspeed_m_s: point.true_airspeed_m_s * (1.0 + step / point.mach),
            ..*point
        })?;
        let by_temperature = difference(TEMPERATURE_STEP_K, &|step| {
            let sat_k = point.static_air_temperature_k + step;
            EffectPoint {
                static_air_temperature_k: sat_k,
                true_airspeed_m_s: point.true_airspeed_m_s
                    * (sat_k / point.static_air_temperature_k).sqrt(),
                ..*point
            }
        })?;
        let by_altitude = difference(ALTITUDE_STEP_M, &|step| EffectPoint {
            pressure_altitude_m: point.pressure_altitude_m + step,
            ..*point
        })?;
        let by_acceleration = of_motion(ACCELERATION_STEP_M_S2, &|step| {
            (point.mass_kg, point.acceleration_m_s2 + step)
        })?;
        let by_mass =
            of_motion(MASS_STEP, &|step| (point.mass_kg * (1.0 + step), point.acceleration_m_s2))?;
        Ok(Slopes {
            mach: by_mach,
            static_air_temperature: by_temperature,
            pressure_altitude: by_altitude,
            acceleration: by_acceleration,
            mass: by_mass,
        })
    }

    /// Covariance of a segment's own noise.
    #[expect(clippy::needless_range_loop, reason = "rows and columns of a covariance")]
    fn own_covariance(
        &self,
        slopes: &Slopes,
        samples: usize,
        recorded: [bool; MAXIMUM_CHANNELS],
    ) -> [ByChannel; MAXIMUM_CHANNELS] {
        let Self { model, channels, statistics, .. } = *self;
        let factors = &statistics.factors;
        let sensors = model.aircraft().sensors();
        let count = channels.count();
        let acceleration = mean_acceleration_deviation_m_s2(sensors.acceleration_m_s2, samples);
        let meter = sensors.fuel_flow_percent / 100.0;
        let engines = model.aircraft().engines();
        let fresh = 1.0 - statistics.air_data_drift.share;
        let mut covariance = [[0.0; MAXIMUM_CHANNELS]; MAXIMUM_CHANNELS];
        covariance[0][0] = total_fuel_flow_relative_variance(meter, &[], engines);
        for contrast in 1..=channels.contrasts {
            // Contrasts are normalized like ln(Wf1/Wf2): squares of the weights sum to 2.
            // What wanders is taken as new in every segment here: half as many columns, and a contrast is seldom short of data.
            let wander = statistics.fuel_flow_drift.percent / 100.0;
            covariance[contrast][contrast] = 2.0 * (meter * meter + wander * wander);
        }
        if channels.n2 {
            let n2 = sensors.n2_percent / 100.0;
            covariance[channels.n2_row()][channels.n2_row()] = n2 * n2;
        }
        for air_data in slopes.of_air_data(sensors) {
            add_products(&mut covariance, air_data, fresh);
        }
        add_products(&mut covariance, (&slopes.acceleration, acceleration), 1.0);
        for a in 0..count {
            for b in 0..count {
                covariance[a][b] *=
                    factors.within[channels.kind(a)] * factors.within[channels.kind(b)];
            }
        }
        if channels.n2 {
            let n2 = channels.n2_row();
            let limit = MOST_CORRELATED * (covariance[0][0] * covariance[n2][n2]).sqrt();
            let both = (covariance[0][n2] * factors.fuel_flow_with_n2).clamp(-limit, limit);
            covariance[0][n2] = both;
            covariance[n2][0] = both;
        }
        for channel in 0..count {
            if !recorded[channel] {
                for other in 0..count {
                    covariance[channel][other] = 0.0;
                    covariance[other][channel] = 0.0;
                }
                covariance[channel][channel] = 1.0; // the row is zero
            }
        }
        covariance
    }

    /// What wandering errors of air data make of the channels: the Cholesky factor of their covariance times the share that
    /// wanders.
    fn wandering_air_data(
        &self,
        slopes: &Slopes,
        recorded: [bool; MAXIMUM_CHANNELS],
    ) -> [ByChannel; MAXIMUM_CHANNELS] {
        let Self { model, channels, statistics, .. } = *self;
        let share = statistics.air_data_drift.share;
        let mut covariance = [[0.0; MAXIMUM_CHANNELS]; MAXIMUM_CHANNELS];
        if share <= 0.0 {
            return covariance;
        }
        for (slope, deviation) in slopes.of_air_data(model.aircraft().sensors()) {
            add_products(
                &mut covariance,
                (&self.between((slope, deviation), recorded), 1.0),
                share,
            );
        }
        semidefinite_cholesky(&covariance, channels.count())
    }

    /// Loadings on what all segments of a flight have in common: mass, heating value, one split a contrast, Mach number, SAT,
    /// pressure altitude, N2.
    fn common_loadings(
        &self,
        slopes: &Slopes,
        relative_mass: f64,
        recorded: [bool; MAXIMUM_CHANNELS],
    ) -> Vec<ByChannel> {
        let Self { model, channels, statistics, .. } = *self;
        let sensors = model.aircraft().sensors();
        let flight_bias = &statistics.flight_bias;
        let unit = |row: usize| {
            let mut slope = [0.0; MAXIMUM_CHANNELS];
            slope[row] = 1.0;
            slope
        };
        let mut sources = vec![
            (slopes.mass, relative_mass),
            (unit(0), sensors.lower_heating_value_percent / 100.0),
        ];
        sources.extend(
            (1..=channels.contrasts).map(|contrast| (unit(contrast), FLIGHT_SPLIT_DEVIATION)),
        );
        sources.extend([
            (slopes.mach, flight_bias.mach),
            (slopes.static_air_temperature, flight_bias.static_air_temperature_k),
            (slopes.pressure_altitude, flight_bias.pressure_altitude_m),
        ]);
        if channels.n2 {
            sources.push((unit(channels.n2_row()), flight_bias.n2_percent / 100.0));
        }
        sources
            .iter()
            .map(|(slope, deviation)| self.between((slope, *deviation), recorded))
            .collect()
    }

    /// What an error with these slopes and this standard deviation makes of each channel, as large as the factors make what
    /// segments of a flight have in common.
    fn between(
        &self,
        (slope, deviation): (&ByChannel, f64),
        recorded: [bool; MAXIMUM_CHANNELS],
    ) -> ByChannel {
        let Self { channels, statistics, .. } = *self;
        let mut loading = [0.0; MAXIMUM_CHANNELS];
        for channel in (0..channels.count()).filter(|&channel| recorded[channel]) {
            let factor = statistics.factors.between[channels.kind(channel)];
            loading[channel] = slope[channel] * deviation * factor;
        }
        loading
    }
}

/// Slopes of the channels along what sensors measure.
struct Slopes {
    mach: ByChannel,
    acceleration: ByChannel,
    static_air_temperature: ByChannel,
    pressure_altitude: ByChannel,
    mass: ByChannel,
}

impl Slopes {
    /// Those of the air data, each with the standard deviation that is stated of a segment's mean.
    const fn of_air_data(&self, sensors: &SensorDeviations) -> [(&ByChannel, f64); 3] {
        [
            (&self.mach, sensors.mach),
            (&self.static_air_temperature, sensors.static_air_temperature_k),
            (&self.pressure_altitude, sensors.pressure_altitude_m),
        ]
    }
}

/// Adds a share of the covariance that an error with these slopes and this standard deviation makes.
fn add_products(
    covariance: &mut [ByChannel; MAXIMUM_CHANNELS],
    (slope, deviation): (&ByChannel, f64),
    share: f64,
) {
    for (row, a) in covariance.iter_mut().zip(slope) {
        for (value, b) in row.iter_mut().zip(slope) {
            *value += share * (a * b * deviation * deviation);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file that an older program wrote has neither field: its factors were learnt over sensors' errors from segment to segment,
    /// mass, heating value and split alone. Text and figures by hand.
    #[test]
    fn factors_of_older_files_stand_for_what_a_flight_keeps() {
        let old = "(within: (1.0, 2.0, 3.0), between: (4.0, 5.0, 6.0))";
        let old: NoiseFactors = ron::from_str(old).unwrap();
        assert_eq!((old.fuel_flow_with_n2, old.with_flight_bias), (1.0, false));
        let sensors = SensorDeviations {
            flight_bias: FlightBias { mach: 0.001, ..FlightBias::none() },
            fuel_flow_drift: FuelFlowDrift { percent: 0.2, time_s: 1200.0 },
            air_data_drift: AirDataDrift { share: 0.8, time_s: 1200.0 },
            ..SensorDeviations::default()
        };
        let of_old = Statistics::of(&old, &sensors);
        assert_eq!((of_old.flight_bias.mach, of_old.drift().percent), (0.0, 0.0));
        assert_eq!(of_old.air_data_drift, AirDataDrift::default());
        let new = NoiseFactors { with_flight_bias: true, ..old };
        let of_new = Statistics::of(&new, &sensors);
        // 4 × 0.2 %.
        assert!((of_new.drift().percent - 0.8).abs() < 1e-15);
        assert!((of_new.flight_bias.mach - 0.001).abs() < 1e-15);
        assert_eq!(of_new.air_data_drift, sensors.air_data_drift);
        let text = ron::to_string(&new).unwrap();
        assert_eq!(ron::from_str::<NoiseFactors>(&text).unwrap(), new);
    }
}
