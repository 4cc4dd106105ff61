//! From the recorded to the flown state: sensor, mass and fuel-quantity effects undone.

use std::borrow::Cow;

use atmos::constants::SEA_LEVEL_PRESSURE_PA;
use atmos::{airspeed, isa, viscosity};
use flight::SegmentMeans;
use flight::effect::EffectId;
use units::{Pressure, PressureAltitude, Temperature, TrueAirspeed, check_within};

use crate::error::EffectError;
use crate::point::EffectPoint;
use crate::terms::Terms;

/// The state that was flown if the recording has the errors that the effects describe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AsFlown {
    pub(crate) mach: f64,
    pub(crate) static_air_temperature_k: f64,
    pub(crate) true_airspeed_m_s: f64,
    pub(crate) temperature_ratio: f64,
    pub(crate) pressure_ratio: f64,
    pub(crate) ln_temperature_ratio: f64,
    pub(crate) ln_pressure_ratio: f64,
    pub(crate) dynamic_pressure_pa: f64,
    pub(crate) mass_kg: f64,
    pub(crate) unit_reynolds_number_per_m: f64,
}

/// Undoes the errors of Mach number, static pressure, SAT, zero-fuel mass and fuel used, without linearising.
///
/// ```text
/// p = p_rec/(1 + θp)                                                  [diagnosis.1]
/// 1 + 0.2 M² = (1 + 0.2 (M_rec − θM)²)·(1 + θp)^(2/7)                 [diagnosis.2]
/// SAT = SAT_rec − θT,   V = V_rec·(M/M_rec)·√(SAT/SAT_rec)            [diagnosis.3]
/// m = m_rec + θZFM + FU_rec·(θFQ + Σ_k s_k θWF,k/(1 + θWF,k))         [diagnosis.4]
/// ```
///
/// [diagnosis.2] holds total pressure, which a static source does not affect. `s_k` is engine k's share of the recorded
/// fuel flow; a meter that reads `θWF` high has counted `FU·θWF/(1 + θWF)` of fuel too much.
pub(crate) fn as_flown(point: &EffectPoint, terms: &Terms) -> Result<AsFlown, EffectError> {
    let recorded_mach = positive("Mach number", "Mach", point.mach)?;
    let recorded_sat_k = positive("static air temperature", "K", point.static_air_temperature_k)?;
    let recorded_tas_m_s = positive("true airspeed", "m/s", point.true_airspeed_m_s)?;
    let pressure_factor = 1.0 + terms.size(EffectId::StaticPressureBias);
    positive("static pressure's recorded over true value", "1", pressure_factor)?;
    let recorded_pressure = isa::pressure(PressureAltitude::meters(point.pressure_altitude_m))?;
    let static_pressure = Pressure::pascals(recorded_pressure.to_pascals() / pressure_factor);
    let unbiased = recorded_mach - terms.size(EffectId::MachBias);
    let mach = if terms.size(EffectId::StaticPressureBias) == 0.0 {
        unbiased
    } else {
        let total = (1.0 + 0.2 * unbiased * unbiased) * pressure_factor.powf(2.0 / 7.0);
        ((total - 1.0) / 0.2).max(0.0).sqrt()
    };
    positive("Mach number less its error", "Mach", mach)?;
    let sat_k = recorded_sat_k - terms.size(EffectId::TemperatureBias);
    positive("static air temperature less its error", "K", sat_k)?;
    let true_airspeed_m_s =
        recorded_tas_m_s * (mach / recorded_mach) * (sat_k / recorded_sat_k).sqrt();
    let mass_kg = point.mass_kg
        + terms.size(EffectId::ZeroFuelMassBias)
        + point.fuel_used_kg
            * (terms.size(EffectId::FuelQuantityGain) + counted_too_much(point, terms));
    positive("gross mass", "kg", mass_kg)?;

    let sat = Temperature::kelvin(sat_k);
    let tas = TrueAirspeed::meters_per_second(true_airspeed_m_s);
    let density = isa::density(static_pressure, sat);
    let temperature_ratio = isa::temperature_ratio(sat);
    let pressure_ratio = isa::pressure_ratio(static_pressure);
    Ok(AsFlown {
        mach,
        static_air_temperature_k: sat_k,
        true_airspeed_m_s,
        temperature_ratio,
        pressure_ratio,
        ln_temperature_ratio: temperature_ratio.ln(),
        ln_pressure_ratio: pressure_ratio.ln(),
        dynamic_pressure_pa: airspeed::dynamic_pressure(density, tas).to_pascals(),
        mass_kg,
        unit_reynolds_number_per_m: viscosity::reynolds_number(
            density,
            tas,
            1.0,
            viscosity::dynamic_viscosity(sat),
        ),
    })
}

impl AsFlown {
    /// A recorded point as it was flown, if the recording has the errors that the effects describe.
    pub(crate) fn point(
        &self,
        recorded: &EffectPoint,
        terms: &Terms,
    ) -> Result<EffectPoint, EffectError> {
        let pressure_altitude_m = if terms.size(EffectId::StaticPressureBias) == 0.0 {
            recorded.pressure_altitude_m
        } else {
            let pressure = Pressure::pascals(self.pressure_ratio * SEA_LEVEL_PRESSURE_PA);
            isa::pressure_altitude(pressure)?.to_meters()
        };
        Ok(EffectPoint {
            pressure_altitude_m,
            static_air_temperature_k: self.static_air_temperature_k,
            mach: self.mach,
            true_airspeed_m_s: self.true_airspeed_m_s,
            mass_kg: self.mass_kg,
            ..*recorded
        })
    }
}

/// Undoes layers of recording errors, one after the other.
pub(crate) fn corrected_by<'m>(
    layers: &[Terms],
    means: &'m SegmentMeans,
    engines: usize,
) -> Result<Cow<'m, SegmentMeans>, EffectError> {
    let mut result = Cow::Borrowed(means);
    for terms in layers {
        result = Cow::Owned(corrected(&result, terms, engines)?);
    }
    Ok(result)
}

/// The means of a segment as they would have been recorded without the errors.
///
/// Mach number, TAS, SAT and mass by [`as_flown`]; pressure altitude from the static pressure; and
///
/// ```text
/// Wf_k = Wf_k,rec/(1 + θWF,k),   FU = FU_rec·(1 − θFQ − Σ_k s_k θWF,k/(1 + θWF,k))          [applying.1]
/// ```
///
/// Ground speed, acceleration, gauged fuel quantity and rotor speeds stay as recorded.
fn corrected(
    means: &SegmentMeans,
    terms: &Terms,
    engines: usize,
) -> Result<SegmentMeans, EffectError> {
    let point = EffectPoint::from_means(means, 0.0, engines);
    let flown = as_flown(&point, terms)?;
    let mut corrected = means.clone();
    corrected.mach = flown.mach;
    corrected.static_air_temperature_k = flown.static_air_temperature_k;
    corrected.true_airspeed_m_s = flown.true_airspeed_m_s;
    corrected.mass_kg = flown.mass_kg;
    if terms.size(EffectId::StaticPressureBias) != 0.0 {
        let recorded = isa::pressure(PressureAltitude::meters(means.pressure_altitude_m))?;
        let flown = Pressure::pascals(
            recorded.to_pascals() / (1.0 + terms.size(EffectId::StaticPressureBias)),
        );
        corrected.pressure_altitude_m = isa::pressure_altitude(flown)?.to_meters();
    }
    let counted = counted_too_much(&point, terms);
    corrected.fuel_used_kg *= 1.0 - terms.size(EffectId::FuelQuantityGain) - counted;
    corrected.fuel_flow_total_kg_s *= 1.0 - counted;
    for (flow, gain) in corrected.fuel_flow_engine_kg_s.iter_mut().zip(terms.fuel_flow_gain) {
        *flow /= 1.0 + gain;
    }
    Ok(corrected)
}

/// Share of the metered fuel that was never burnt: the sum over engines in `[applying.1]`.
fn counted_too_much(point: &EffectPoint, terms: &Terms) -> f64 {
    point
        .fuel_flow_share
        .iter()
        .zip(terms.fuel_flow_gain)
        .map(|(share, gain)| share * gain / (1.0 + gain))
        .sum()
}

fn positive(quantity: &'static str, unit: &'static str, value: f64) -> Result<f64, EffectError> {
    Ok(check_within(quantity, unit, value, f64::MIN_POSITIVE, f64::MAX)?)
}
