//! Signatures: what one unit of an effect changes in every channel, by central differences.

use effects::{EffectModel, Effects, KnownPoint, Trial};
use flight::effect::{EffectId, HiddenParameter};

use crate::baseline::Baseline;
use crate::baseline::standing_effects::STANDING_EFFECTS;
use crate::library::Library;
use crate::residuals::predictor::Predictor;
use crate::signals::channels::{ByChannel, MAXIMUM_CHANNELS};

/// Central difference of every channel with an effect, made ready for many segments.
#[derive(Debug)]
pub(crate) struct Difference {
    up: Trial,
    down: Trial,
    /// In the effect's unit.
    step: f64,
}

impl Difference {
    /// About `at`, whose other effects stay.
    pub(crate) fn new(
        model: &EffectModel<'_>,
        at: &Effects,
        id: EffectId,
        hidden: HiddenParameter,
        step: f64,
    ) -> Self {
        let size = at.size(id);
        let trial = |size: f64| model.trial(&at.clone().with(id, size).with_hidden(id, hidden));
        Self { up: trial(size + step), down: trial(size - step), step }
    }

    pub(crate) fn signature(
        &self,
        model: &EffectModel<'_>,
        point: &KnownPoint,
        is_recorded: [bool; MAXIMUM_CHANNELS],
        predictor: &Predictor<'_>,
    ) -> Result<ByChannel, effects::EffectError> {
        let up = predictor.predict(&model.response_at(point, &self.up)?);
        let down = predictor.predict(&model.response_at(point, &self.down)?);
        let mut slope = [0.0; MAXIMUM_CHANNELS];
        for channel in 0..predictor.channels.count() {
            if is_recorded[channel] {
                slope[channel] = (up[channel] - down[channel]) / (2.0 * self.step);
            }
        }
        Ok(slope)
    }
}

/// Differences of every column of a library, and of what a baseline carries.
pub(crate) struct Differences {
    pub(crate) columns: Vec<Difference>,
    pub(crate) standing_effects: Vec<Difference>,
}

impl Differences {
    pub(crate) fn new(
        model: &EffectModel<'_>,
        library: &Library,
        baseline: Option<&Baseline>,
    ) -> Self {
        let none = Effects::none();
        let columns = library
            .columns
            .iter()
            .map(|column| {
                let effect = &library.effects[column.effect];
                let hidden = column.hidden;
                Difference::new(model, &none, effect.id, hidden, 0.5 * effect.typical)
            })
            .collect();
        // Only where there is a baseline to carry them, or one is about to be learnt (then there is no library).
        let carries = baseline.is_some() || library.columns.is_empty();
        let standing_effects = STANDING_EFFECTS
            .iter()
            .filter(|_| carries)
            .map(|carried| {
                let step = 0.5 * model.references().typical_size(carried.id);
                Difference::new(model, &none, carried.id, carried.hidden, step)
            })
            .collect();
        Self { columns, standing_effects }
    }
}
