//! Which measurement would tell two effects apart.

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
        use flight::effect::{EffectId, TypicalSize};
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
                found.push(Gain { measurement, before, after });
            }
        }
        let after = squared_from_any(&self.with_deck, k, others, size).sqrt();
        found.push(Gain { measurement: Measurement::N2Deck, before, after });
        found.retain(|gain| gains(gain.before, gain.after));
        found.sort_by(|a, b| b.after.total_cmp(&a.after));
        found
    }
}
