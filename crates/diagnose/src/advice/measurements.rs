//! Which measurement would tell two effects apart.

use crate::advice::distances::{Distances, gains, squared_from_any};
use crate::library::Library;
use crate::thresholds::{
    MEASURED_BURN_PERCENT, MEASURED_MACH, MEASURED_MASS, MEASURED_PRESSURE_PERCENT, MEASURED_SAT_K,
};

/// A measurement that separates two effects, with the distance before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Measurement {
    pub(crate) words: &'static str,
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
    ) -> Vec<Measurement> {
        use flight::effect::EffectId;
        let before = self.squared_from_any(k, others.clone(), size).sqrt();
        let mut found = Vec::new();
        let mass_kg = library
            .effects
            .iter()
            .find(|e| e.id == EffectId::ZeroFuelMassBias)
            .map_or(f64::INFINITY, |e| e.typical / 0.015 * MEASURED_MASS);
        let engines = library
            .effects
            .iter()
            .filter(|e| matches!(e.id, EffectId::FuelFlowGainEngine(_)))
            .count()
            .max(1) as f64;
        let offers = [
            (EffectId::ZeroFuelMassBias, mass_kg, "weigh the aircraft (to 0.3 % of its mass)"),
            (EffectId::FuelFlowGain, MEASURED_BURN_PERCENT, "compare with tank gauges (to 0.15 %)"),
            (EffectId::TemperatureBias, MEASURED_SAT_K, "compare SAT with a reanalysis (to 0.5 K)"),
            (
                EffectId::MachBias,
                MEASURED_MACH,
                "compare true airspeed with GPS and wind (to Mach 0.0015)",
            ),
            (
                EffectId::StaticPressureBias,
                MEASURED_PRESSURE_PERCENT,
                "compare pressure altitude with GPS height and a reanalysis (to 0.05 % of p)",
            ),
        ];
        for (id, deviation, words) in offers {
            let mut gram = self.gram.clone();
            let mut touched = false;
            for column in others.clone().chain([k]) {
                let own = library.effects[library.columns[column].effect].id;
                // Gauges see the sum of the meters: one engine's share of an error is twice as hard to see with two.
                let share = match (id, own) {
                    (EffectId::FuelFlowGain, EffectId::FuelFlowGainEngine(_)) => engines,
                    _ if own == id => 1.0,
                    _ => continue,
                };
                gram[(column, column)] += 1.0 / (deviation * share).powi(2);
                touched = true;
            }
            if touched {
                let after = squared_from_any(&gram, k, others.clone(), size).sqrt();
                found.push(Measurement { words, before, after });
            }
        }
        let after = squared_from_any(&self.with_deck, k, others, size).sqrt();
        found.push(Measurement { words: "measure an N2 deck (to 0.1 %)", before, after });
        found.retain(|m| gains(m.before, m.after));
        found.sort_by(|a, b| b.after.total_cmp(&a.after));
        found
    }
}
