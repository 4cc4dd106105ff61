//! Which measurement would tell two effects apart.

use flight::effect::EffectId;

use crate::advice::distances::{Distances, gains, squared_from_any};
use crate::library::Library;
use crate::output::measurement::Measurement;
use crate::thresholds::{
    MEASURED_BURN_PERCENT, MEASURED_MACH, MEASURED_MASS, MEASURED_PRESSURE_PERCENT, MEASURED_SAT_K,
};

/// A measurement that separates two effects, with the distance before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gain {
    pub(crate) measurement: Measurement,
    pub(crate) before: f64,
    pub(crate) after: f64,
}

impl Distances {
    /// Measurements by the distance that they would put between a column at a size and another effect, whose columns are
    /// `others`, the best first; those that gain less than a tenth are left out.
    pub(crate) fn measurements(
        &self,
        library: &Library,
        k: usize,
        others: core::ops::Range<usize>,
        size: f64,
    ) -> Vec<Gain> {
        use flight::effect::TypicalSize;
        let before = self.squared_from_any(k, others.clone(), size).sqrt();
        let mut found = Vec::new();
        // The typical error of a load sheet is a share of the mass.
        let mass_kg = match EffectId::ZeroFuelMassBias.entry().typical {
            TypicalSize::ShareOfMass(share) => library
                .effects
                .iter()
                .find(|e| e.id == EffectId::ZeroFuelMassBias)
                .map_or(f64::INFINITY, |e| e.typical / share * MEASURED_MASS),
            TypicalSize::Absolute(_) | TypicalSize::Known => f64::INFINITY,
        };
        let engines = library
            .effects
            .iter()
            .filter(|e| matches!(e.id, EffectId::FuelFlowGainEngine(_)))
            .count()
            .max(1) as f64;
        let offers = [
            (EffectId::ZeroFuelMassBias, mass_kg, Measurement::Weighing),
            (EffectId::FuelFlowGain, MEASURED_BURN_PERCENT, Measurement::TankGauges),
            (EffectId::TemperatureBias, MEASURED_SAT_K, Measurement::TemperatureReanalysis),
            (EffectId::MachBias, MEASURED_MACH, Measurement::AirspeedByGps),
            (EffectId::StaticPressureBias, MEASURED_PRESSURE_PERCENT, Measurement::AltitudeByGps),
        ];
        for (id, deviation, measurement) in offers {
            // What a unit of each column changes of what is measured: one row of the design.
            let shown: Vec<(usize, f64)> = others
                .clone()
                .chain([k])
                .filter_map(|column| {
                    let own = library.effects[library.columns[column].effect].id;
                    Some((column, shown_by(id, own, engines)?))
                })
                .collect();
            if shown.is_empty() {
                continue;
            }
            let mut gram = self.gram.clone();
            for &(row, one) in &shown {
                for &(column, other) in &shown {
                    gram[(row, column)] += one * other / (deviation * deviation);
                }
            }
            let after = squared_from_any(&gram, k, others.clone(), size).sqrt();
            found.push(Gain { measurement, before, after });
        }
        let after = squared_from_any(&self.with_deck, k, others, size).sqrt();
        found.push(Gain { measurement: Measurement::N2Deck, before, after });
        found.retain(|gain| gains(gain.before, gain.after));
        found.sort_by(|a, b| b.after.total_cmp(&a.after));
        found
    }
}

/// What a unit of an effect changes of the quantity that is measured for another one; `None` where nothing.
///
/// A static pressure that reads high by dp makes Mach number low by (1 + 0.2 M²)(2/7)/(0.4 M)·dp/p, and true airspeed, which GPS and wind
/// show, follows Mach number and half of temperature; at M 0.80 and 220 K.
fn shown_by(measured: EffectId, effect: EffectId, engines: f64) -> Option<f64> {
    const MACH: f64 = 0.80;
    const TEMPERATURE_K: f64 = 220.0;
    match (measured, effect) {
        // Gauges see the sum of the meters: one engine's share of an error is twice as hard to see with two.
        (EffectId::FuelFlowGain, EffectId::FuelFlowGainEngine(_)) => Some(1.0 / engines),
        (EffectId::MachBias, EffectId::StaticPressureBias) => {
            Some(-0.01 * (1.0 + 0.2 * MACH * MACH) * (2.0 / 7.0) / (0.4 * MACH))
        }
        (EffectId::MachBias, EffectId::TemperatureBias) => Some(MACH * 0.5 / TEMPERATURE_K),
        _ => (measured == effect).then_some(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: q/p = (1 + 0.2 M²)^3.5 − 1 solved for the Mach number that is recorded where the impact pressure is right and static
    /// pressure reads 1 % high; and V = M·√(γRT).
    #[test]
    fn what_gps_shows_of_air_data() {
        let ratio = |mach: f64| (1.0 + 0.2 * mach * mach).powf(3.5) - 1.0;
        let recorded = |over: f64| (5.0 * ((over + 1.0).powf(2.0 / 7.0) - 1.0)).sqrt();
        // Total pressure is right: (q + p)/p' − 1.
        let mach = recorded((ratio(0.8) + 1.0) / 1.01 - 1.0);
        let shown = shown_by(EffectId::MachBias, EffectId::StaticPressureBias, 2.0).unwrap();
        assert!(((mach - 0.8) / shown - 1.0).abs() < 0.02, "{mach} {shown}");
        let of_a_kelvin = 0.8 * ((221.0_f64 / 220.0).sqrt() - 1.0);
        let shown = shown_by(EffectId::MachBias, EffectId::TemperatureBias, 2.0).unwrap();
        assert!((of_a_kelvin / shown - 1.0).abs() < 0.01, "{of_a_kelvin} {shown}");
    }
}
