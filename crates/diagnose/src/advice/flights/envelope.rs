//! What the flights at hand show to be possible, and what is usual on them: the limits of a flight on purpose.

use effects::{EffectModel, EffectPoint, Effects, Variable};
use units::convert::METERS_PER_FOOT;
use units::{Mach, PressureAltitude, Temperature};

use crate::math::quantile::{QuantileType, quantile};
use crate::output::measurement::LoadingKind;
use crate::residuals::planned::Recorded;
use crate::residuals::segments::PreparedFlights;
use crate::thresholds::{
    ADVISED_SEGMENTS, EDGE_MACH, EDGE_MASS, HEAVY, LEVEL_TOLERANCE_M, LIGHT, REDUCED_SEPARATION_TO,
    SEGMENT_EVERY_S,
};

/// Gross masses are rounded to this, kg.
const MASS_STEP_KG: f64 = 100.0;

/// Gross mass and fuel used at the beginning of a flight on purpose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Loading {
    pub(crate) kind: LoadingKind,
    pub(crate) mass_kg: f64,
    pub(crate) fuel_used_kg: f64,
}

/// Limits that a flight on purpose keeps, and the rest of its conditions.
#[derive(Clone, Debug)]
pub(crate) struct Envelope {
    /// Flight levels from the lowest to the highest flown.
    pub(crate) levels: Vec<u32>,
    /// Slowest Mach number that was flown, hundredths.
    pub(crate) slowest: u32,
    /// A slow, the middle and a fast one.
    pub(crate) usual: [u32; 3],
    /// The fastest that was flown, inside the drag table.
    pub(crate) fastest: u32,
    /// Slowest Mach number of the drag table that may be planned, hundredths.
    pub(crate) table_from: u32,
    pub(crate) loadings: Vec<Loading>,
    pub(crate) recorded: Recorded,
    /// Fuel burned from one segment to the next, kg.
    burn_kg: f64,
    largest_lift_coefficient: f64,
    largest_ln_corrected_thrust: f64,
    /// Of ln(δM²): dynamic pressure is 0.7·p0·δM².
    largest_ln_pressure: f64,
    /// Lightest and heaviest mass of a segment with the fuel used before it.
    take_off_mass_kg: [f64; 2],
    mass_kg: [f64; 2],
    isa_deviation_k: f64,
    /// Wind, position, center of gravity, anti-ice, roll, date: as usual.
    template: EffectPoint,
}

impl Envelope {
    /// Of the data at hand.
    ///
    /// Whatever is neither Mach number, pressure altitude, mass nor fuel used is as usual: the median; wind and position
    /// those of the segment whose eastward speed is the median; the date is the last one.
    pub(crate) fn from_flights(
        data: &PreparedFlights<'_>,
        model: &EffectModel<'_>,
    ) -> Option<Self> {
        let of = |value: &dyn Fn(&EffectPoint) -> f64| {
            sorted(data.segments.iter().map(|row| value(&row.point)).collect())
        };
        let mach = of(&|p| p.mach);
        let pressure_altitude_m = of(&|p| p.pressure_altitude_m);
        let mass_kg = of(&|p| p.mass_kg);
        let fuel_used_kg = of(&|p| p.fuel_used_kg);
        let take_off_mass_kg = of(&|p| p.mass_kg + p.fuel_used_kg);
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NEG_INFINITY, f64::max);
        let rows = || data.segments.iter().map(|row| &row.response);
        let references = model.references();
        let table = model.drag_table().grid().y();
        let isa_deviation_k = sorted(
            data.segments
                .iter()
                .filter_map(|row| {
                    Variable::IsaDeviation.value(&row.point, &row.response, references)
                })
                .collect(),
        );
        let samples = sorted(data.segments.iter().map(|row| row.samples as f64).collect());
        let gauges: Vec<f64> =
            data.flights.iter().filter_map(|f| Some(f.gauge.as_ref()?.deviation)).collect();
        let gauged = 2 * gauges.len() > data.flights.len();
        let mut envelope = Self {
            levels: levels(*pressure_altitude_m.first()?, *pressure_altitude_m.last()?),
            slowest: hundredths(mach.first()? + 1e-9, f64::floor),
            usual: [LIGHT, 0.5, HEAVY]
                .map(|share| hundredths(flown_quantile(&mach, share), f64::round)),
            fastest: hundredths(mach.last()? + 1e-9, f64::floor)
                .min(hundredths(table.last() + 1e-9, f64::floor).saturating_sub(EDGE_MACH)),
            table_from: hundredths(table.first() - 1e-9, f64::ceil) + EDGE_MACH,
            loadings: vec![],
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a number of samples"
            )]
            recorded: Recorded {
                samples: flown_quantile(&samples, 0.5) as usize,
                gauge_deviation: gauged.then(|| flown_quantile(&sorted(gauges), 0.5)),
            },
            burn_kg: SEGMENT_EVERY_S * references.fuel_flow_total_kg_s,
            largest_lift_coefficient: largest(&mut rows().map(|r| r.lift_coefficient)),
            largest_ln_corrected_thrust: largest(&mut rows().map(|r| r.ln_corrected_thrust)),
            largest_ln_pressure: largest(
                &mut data
                    .segments
                    .iter()
                    .map(|row| ln_pressure(&row.point, row.response.ln_pressure_ratio)),
            ),
            take_off_mass_kg: [*take_off_mass_kg.first()?, *take_off_mass_kg.last()?],
            mass_kg: [*mass_kg.first()?, *mass_kg.last()?],
            isa_deviation_k: flown_quantile(&isa_deviation_k, 0.5),
            template: template(data, model)?,
        };
        envelope.loadings = envelope.loadings(&mass_kg, &fuel_used_kg);
        Some(envelope)
    }

    /// Heavy, early in flight; light, late. One in the middle where they are not far enough apart.
    fn loadings(&self, mass_kg: &[f64], fuel_used_kg: &[f64]) -> Vec<Loading> {
        let burned_kg = self.burn_kg * (ADVISED_SEGMENTS - 1) as f64;
        let round = |mass_kg: f64| (mass_kg / MASS_STEP_KG).round() * MASS_STEP_KG;
        let heavy = Loading {
            kind: LoadingKind::Heavy,
            mass_kg: round(flown_quantile(mass_kg, HEAVY)),
            fuel_used_kg: flown_quantile(fuel_used_kg, LIGHT),
        };
        let light = Loading {
            kind: LoadingKind::Light,
            mass_kg: round(flown_quantile(mass_kg, LIGHT) + burned_kg),
            fuel_used_kg: (flown_quantile(fuel_used_kg, HEAVY) - burned_kg).max(0.0),
        };
        if light.mass_kg < heavy.mass_kg {
            return vec![heavy, light];
        }
        let usual = Loading {
            kind: LoadingKind::Usual,
            mass_kg: round(flown_quantile(mass_kg, 0.5) + 0.5 * burned_kg),
            fuel_used_kg: (flown_quantile(fuel_used_kg, 0.5) - 0.5 * burned_kg).max(0.0),
        };
        vec![usual]
    }

    /// The point of a place in the flight, where a flight may be there: mass inside what was flown, lift coefficient,
    /// corrected thrust and dynamic pressure not above the largest that were flown, and a prediction of the model.
    pub(crate) fn point(
        &self,
        model: &EffectModel<'_>,
        level: u32,
        mach_hundredths: u32,
        loading: &Loading,
        place: usize,
    ) -> Option<EffectPoint> {
        self.point_at(model, level, f64::from(mach_hundredths) / 100.0, loading, place)
    }

    /// The same between two hundredths.
    pub(crate) fn point_at(
        &self,
        model: &EffectModel<'_>,
        level: u32,
        mach: f64,
        loading: &Loading,
        place: usize,
    ) -> Option<EffectPoint> {
        let pressure_altitude_m = level_m(level);
        let isa_k = atmos::isa::temperature(PressureAltitude::meters(pressure_altitude_m)).ok()?;
        let sat = Temperature::kelvin(isa_k.to_kelvin() + self.isa_deviation_k);
        let true_airspeed_m_s =
            atmos::airspeed::mach_to_true_airspeed(Mach::new(mach), sat).to_meters_per_second();
        let burned_kg = self.burn_kg * place as f64;
        let template = &self.template;
        let point = EffectPoint {
            pressure_altitude_m,
            static_air_temperature_k: sat.to_kelvin(),
            mach,
            true_airspeed_m_s,
            ground_speed_m_s: true_airspeed_m_s + template.ground_speed_m_s
                - template.true_airspeed_m_s,
            mass_kg: loading.mass_kg - burned_kg,
            fuel_used_kg: loading.fuel_used_kg + burned_kg,
            ..*template
        };
        self.admits(model, &point).then_some(point)
    }

    pub(crate) fn admits(&self, model: &EffectModel<'_>, point: &EffectPoint) -> bool {
        let Ok(response) = model.response(point, &Effects::none()) else { return false };
        let table = model.drag_table().grid().x();
        // Lift coefficient is proportional to mass.
        let lift = |share: f64| response.lift_coefficient * (1.0 + share);
        let within = |value: f64, [low, high]: [f64; 2]| (low..=high).contains(&value);
        lift(-EDGE_MASS) >= table.first()
            && lift(EDGE_MASS) <= table.last()
            && within(point.mass_kg, self.mass_kg)
            && within(point.mass_kg + point.fuel_used_kg, self.take_off_mass_kg)
            && response.lift_coefficient <= self.largest_lift_coefficient
            && response.ln_corrected_thrust <= self.largest_ln_corrected_thrust
            && ln_pressure(point, response.ln_pressure_ratio) <= self.largest_ln_pressure
    }
}

/// Conditions that are not swept.
fn template(data: &PreparedFlights<'_>, model: &EffectModel<'_>) -> Option<EffectPoint> {
    let median = |value: &dyn Fn(&EffectPoint) -> Option<f64>| {
        let found: Vec<f64> = data.segments.iter().filter_map(|row| value(&row.point)).collect();
        (2 * found.len() > data.segments.len()).then(|| flown_quantile(&sorted(found), 0.5))
    };
    let mut by_eastward_speed: Vec<(f64, &EffectPoint)> = data
        .segments
        .iter()
        .map(|row| {
            let value =
                Variable::EastwardSpeed.value(&row.point, &row.response, model.references());
            (value.unwrap_or(0.0), &row.point)
        })
        .collect();
    by_eastward_speed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (_, middle) = by_eastward_speed.get(by_eastward_speed.len() / 2)?;
    let engines = model.aircraft().engines();
    let mut fuel_flow_share = [0.0; flight::MAXIMUM_ENGINES];
    fuel_flow_share[..engines].fill(1.0 / engines as f64);
    Some(EffectPoint {
        date_s: data.segments.iter().map(|row| row.point.date_s).fold(f64::MIN, f64::max),
        acceleration_m_s2: 0.0,
        fuel_flow_share,
        roll_squared_deg2: median(&|p| p.roll_squared_deg2),
        center_of_gravity_percent_mac: median(&|p| p.center_of_gravity_percent_mac),
        anti_ice: median(&|p| p.anti_ice),
        ..**middle
    })
}

/// ln(δM²): dynamic pressure is 0.7·p0·δM².
fn ln_pressure(point: &EffectPoint, ln_pressure_ratio: f64) -> f64 {
    ln_pressure_ratio + 2.0 * point.mach.ln()
}

/// Pressure altitude of a flight level, m.
pub(crate) fn level_m(level: u32) -> f64 {
    f64::from(level) * 100.0 * METERS_PER_FOOT
}

/// Flight levels between two pressure altitudes: each 1000 ft up to FL410, each 2000 ft above.
fn levels(lowest_m: f64, highest_m: f64) -> Vec<u32> {
    (10..=1000)
        .step_by(10)
        .filter(|&level| {
            level <= REDUCED_SEPARATION_TO || (level - REDUCED_SEPARATION_TO).is_multiple_of(20)
        })
        .filter(|&level| {
            let m = level_m(level);
            m >= lowest_m - LEVEL_TOLERANCE_M && m <= highest_m + LEVEL_TOLERANCE_M
        })
        .collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "Mach numbers of a table"
)]
fn hundredths(mach: f64, round: fn(f64) -> f64) -> u32 {
    round(100.0 * mach) as u32
}

pub(crate) fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

/// The value below which a share of sorted values lies: one that was flown; NaN for none.
fn flown_quantile(sorted: &[f64], share: f64) -> f64 {
    quantile(sorted, share, QuantileType::NearestToType7)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_those_of_the_air() {
        // FL390 is 11887.2 m, FL450 13716 m: 1000 ft apart up to FL410, 2000 ft above (ICAO Annex 2, Appendix 3, RVSM).
        assert_eq!(levels(11_887.0, 13_716.0), [390, 400, 410, 430, 450]);
        // A fleet that keeps to one level within a few feet.
        assert_eq!(levels(10_668.5, 10_671.0), [350]);
    }
}
