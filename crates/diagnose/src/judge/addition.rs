//! What the verdict adds to the model.

use effects::EffectReferences;
use flight::effect::{EffectId, HiddenParameter};

use crate::hypotheses::evidence::ScoredHypothesis;
use crate::library::Library;
use crate::output::addition::{AddedEffect, Addition};
use crate::search::analyse::Analysis;
use crate::thresholds::SCATTER_SHARE;

impl Addition {
    /// The effects `names` with the sizes that they have in the most probable model of exactly these; `None` where the
    /// search has no such model.
    pub(crate) fn of(
        analysis: &Analysis,
        library: &Library,
        names: &[String],
        references: EffectReferences,
    ) -> Option<Self> {
        let (scored, _) = analysis.models.iter().find(|(scored, _)| {
            let found = named(scored, library);
            found.len() == names.len() && names.iter().all(|name| found.contains(name))
        })?;
        let mut effects: Vec<AddedEffect> = scored
            .model
            .columns
            .iter()
            .enumerate()
            .map(|(place, &column)| {
                let id = library.effects[library.columns[column].effect].id;
                AddedEffect {
                    effect: id.to_string(),
                    size: scored.sizes[place],
                    standard_deviation: scored.deviations[place],
                    hidden: library.columns[column].hidden,
                }
            })
            .collect();
        effects.extend(scored.model.flight_scatter_percent.map(|percent| AddedEffect {
            effect: EffectId::FuelHeatingValue.to_string(),
            size: percent,
            standard_deviation: SCATTER_SHARE * percent,
            hidden: HiddenParameter::None,
        }));
        // The order of the verdict, the larger effect first.
        effects.sort_by_key(|added| names.iter().position(|name| *name == added.effect));
        Some(Self { effects, references })
    }
}

fn named(scored: &ScoredHypothesis, library: &Library) -> Vec<String> {
    let columns = scored.model.columns.iter();
    let mut names: Vec<String> = columns
        .map(|&column| library.effects[library.columns[column].effect].id.to_string())
        .collect();
    names.extend(
        scored.model.flight_scatter_percent.map(|_| EffectId::FuelHeatingValue.to_string()),
    );
    names
}
