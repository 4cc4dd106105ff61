//! What the verdict adds to the model.

use effects::EffectReferences;
use flight::effect::{EffectId, HiddenParameter};

use crate::hypotheses::evidence::ScoredHypothesis;
use crate::library::Library;
use crate::output::addition::{AddedEffect, Addition};
use crate::search::analyse::Analysis;
use crate::thresholds::SCATTER_SHARE;

impl Addition {
    /// The effects `named` with the sizes that they have in the most probable model of exactly these; `None` where the
    /// search has no such model.
    pub(crate) fn named(
        analysis: &Analysis,
        library: &Library,
        named: &[EffectId],
        references: EffectReferences,
    ) -> Option<Self> {
        let (scored, _) = analysis.models.iter().find(|(scored, _)| {
            let found = effects_of(scored, library);
            found.len() == named.len() && named.iter().all(|id| found.contains(id))
        })?;
        let mut effects: Vec<AddedEffect> = scored
            .hypothesis
            .columns
            .iter()
            .enumerate()
            .map(|(place, &column)| AddedEffect {
                effect: library.effects[library.columns[column].effect].id,
                size: scored.sizes[place],
                standard_deviation: scored.deviations[place],
                hidden: library.columns[column].hidden,
            })
            .collect();
        effects.extend(scored.hypothesis.flight_scatter_percent.map(|percent| AddedEffect {
            effect: EffectId::FuelHeatingValue,
            size: percent,
            standard_deviation: SCATTER_SHARE * percent,
            hidden: HiddenParameter::None,
        }));
        // The order of the verdict, the larger effect first.
        effects.sort_by_key(|added| named.iter().position(|id| *id == added.effect));
        Some(Self { effects, form: None, references })
    }
}

fn effects_of(scored: &ScoredHypothesis, library: &Library) -> Vec<EffectId> {
    let columns = scored.hypothesis.columns.iter();
    let mut effects: Vec<EffectId> =
        columns.map(|&column| library.effects[library.columns[column].effect].id).collect();
    effects.extend(scored.hypothesis.flight_scatter_percent.map(|_| EffectId::FuelHeatingValue));
    effects
}
