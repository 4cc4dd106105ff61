//! The text of `MODEL.ron`, both ways.

use std::fmt::Write as _;
use std::sync::Arc;

use adapt::bayes::{BayesSettings, BayesState, BayesStateData};
use diagnose::{Baseline, BaselineRecord};
use effects::ExtendedModel;
use lut::Table;
use lut::surface::Surface;
use perf_model::aircraft::AircraftFile;
use perf_model::{Aircraft, GuideLevel, GuideLevels, PerformanceModel};
use ron::ser::PrettyConfig;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::applied::{AppliedText, layers_of};
use super::error::{ModelTextError, ModelValueError};
use super::{
    AppliedRecord, FORMAT, GuideRecord, LawSettings, LawState, Learnt, LedgerEntry, ModelFile,
    PaperSettings, PaperState,
};
use crate::checksum::hexadecimal;
use crate::condition_means::ConditionMeans;
use crate::whole_model::belief_before_flights;

/// Begins the last line but one; everything before it is what the checksum is of.
const CHECKSUM: &str = "\n    checksum: \"";

/// The factor of a baseline's covariance before its numbers are put in.
const EMPTY_FACTOR: &str = "\n            factor: []";

/// The format of models without a baseline.
const FIRST_FORMAT: u32 = 1;
/// The format of a baseline that refers to the initial table.
const FIRST_WITH_FACTORS: u32 = 3;
/// The format of models with the drag of the guide's rows.
const FIRST_WITH_GUIDE: u32 = 4;
/// The format of a baseline with a term for the force along the path.
const FIRST_WITH_PATH_FORCE: u32 = 5;
/// The format from which on a baseline is one posterior.
const FIRST_WITH_POSTERIOR: u32 = 2;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: u32,
    aircraft: AircraftFile,
    guide: GuideRecord,
    polynomial: Surface,
    grid: GridText,
    initial: InitialText,
    settings: LawSettings,
    learnt: Option<LearntText>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    effects: Vec<AppliedText>,
    #[serde(default)]
    checksum: String,
}

/// Breakpoints of the two axes; tables list the Mach numbers of the first lift coefficient, then of the second, …
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct GridText {
    lift_coefficient: Vec<f64>,
    mach: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct InitialText {
    drag_coefficient: Vec<f64>,
    /// 1 for a node outside the range of the guide.
    extrapolated: Vec<u8>,
    /// By the rows of the guide in place of the polynomial through them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    drag_coefficient_of_guide: Option<Vec<f64>>,
    /// By how much the drag of these rows differs by level.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    levels_of_guide: Option<LevelsText>,
    /// Of programs of format 5: the guide with a factor by level, beside a drag of its rows without, to which what was learnt refers.
    #[serde(default, skip_serializing, rename = "book_of_guide")]
    _book_of_guide: Option<IgnoredAny>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LevelsText {
    lift_coefficient: (f64, f64),
    mach: (f64, f64),
    /// Pressure altitude in m, and drag there over that of the table, less 1: in the middle, and how much more at the largest
    /// lift coefficient and Mach number.
    levels: Vec<(f64, [f64; 3])>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct LearntText {
    tail: String,
    criteria: String,
    law: LawText,
    references: ConditionMeans,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    baseline: Option<BaselineRecord>,
    ledger: Vec<LedgerEntry>,
}

#[derive(Serialize, Deserialize)]
enum LawText {
    Paper {
        settings: PaperSettings,
        refits: u32,
        drag_coefficient: Vec<f64>,
        confidence: Vec<f64>,
        ever_adapted: Vec<u8>,
    },
    /// The first three lists follow from the state and are for readers of the file.
    Bayes {
        drag_coefficient: Vec<f64>,
        /// Relative to the initial drag coefficient.
        standard_deviation: Vec<f64>,
        observations: Vec<f64>,
        state: BayesStateData,
    },
}

/// The text of a model file.
pub(super) fn print(model: &ModelFile) -> Result<String, ron::Error> {
    let mut document = document_of(model);
    // Most of a learnt model is one list of numbers, which is written here in a third of the time.
    let baseline = document.learnt.as_mut().and_then(|learnt| learnt.baseline.as_mut());
    let factor = baseline.map(BaselineRecord::take_factor).unwrap_or_default();
    let config = PrettyConfig::new().compact_arrays(true).new_line("\n");
    let text = with_factor(ron::ser::to_string_pretty(&document, config)?, &factor);
    // The checksum field is written empty and last; the text before it is what is summed.
    let Some(end) = text.rfind(CHECKSUM) else { return Ok(text) };
    let body = &text[..end];
    Ok(format!("{body}{CHECKSUM}{}\",\n)\n", checksum_of(body)))
}

/// A text with the list in the place where it was left out.
fn with_factor(text: String, factor: &[f64]) -> String {
    let Some(place) = text.rfind(EMPTY_FACTOR).filter(|_| !factor.is_empty()) else { return text };
    let (before, after) = text.split_at(place + EMPTY_FACTOR.len() - 1);
    let mut whole = String::with_capacity(text.len() + 25 * factor.len());
    whole.push_str(before);
    for (k, number) in factor.iter().enumerate() {
        whole.push_str(if k == 0 { "" } else { ", " });
        push_debug(*number, &mut whole);
    }
    whole.push_str(after);
    whole
}

/// Appends a number in the form in which `Debug` writes it, and RON with it.
fn push_debug(value: f64, text: &mut String) {
    if value.is_finite() {
        let mut buffer = zmij::Buffer::new();
        let printed = buffer.format_finite(value);
        // Where `Debug` begins to write exponents the other writer may not have begun yet.
        let is_plain = value == 0.0 || (1e-4..1e15).contains(&value.abs());
        if is_plain {
            text.push_str(printed);
            return;
        }
        if let Some((digits, exponent)) = printed.split_once('e') {
            // `Debug` writes no plus sign.
            text.extend([digits, "e", exponent.trim_start_matches('+')]);
            return;
        }
    }
    // Writing to a string cannot fail.
    let _ = write!(text, "{value:?}");
}

/// A model from its text.
pub(super) fn parse(text: &str) -> Result<ModelFile, ModelTextError> {
    // An editor's byte-order mark is no content.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let format = format_of(text).ok_or(ModelTextError::NoModel)?;
    if format > FORMAT {
        return Err(ModelTextError::Newer { found: format });
    }
    let end = text.rfind(CHECKSUM).ok_or(ModelTextError::CutOff)?;
    let found = text[end + CHECKSUM.len()..].split('"').next().unwrap_or_default();
    let computed = checksum_of(&text[..end]);
    if found != computed {
        return Err(ModelTextError::Damaged { found: found.to_owned(), computed });
    }
    if format < FIRST_WITH_POSTERIOR {
        return without_old_remainder(text);
    }
    model_of(ron::from_str(text)?)
}

/// A model of format 1: its remainder, which was learnt against the adapted table and added to it, is left out; `adapt` learns
/// it anew from the segments that its folder keeps.
fn without_old_remainder(text: &str) -> Result<ModelFile, ModelTextError> {
    // Fields of that remainder are not looked at: it is cut out before the text is read.
    const BEGINS: &str = "\n        baseline: Some((";
    const ENDS: &str = "\n        )),";
    let cut = text.find(BEGINS).and_then(|from| {
        let length = text[from..].find(ENDS)? + ENDS.len();
        Some(format!("{}{}", &text[..from], &text[from + length..]))
    });
    if cut.is_some() {
        tracing::warn!(
            "the model's remainder is of format 1 and is left out: predictions are of its drag table until `adapt` has learnt \
             it anew"
        );
    }
    model_of(ron::from_str(cut.as_deref().unwrap_or(text))?)
}

/// The number behind the first `format:`.
fn format_of(text: &str) -> Option<u32> {
    let (_, after) = text.split_once("format:")?;
    let digits: String = after.trim_start().chars().take_while(char::is_ascii_digit).collect();
    digits.parse().ok()
}

fn checksum_of(body: &str) -> String {
    // Line ends do not count: a checkout or a mail may turn them. The body ends before a line feed, perhaps after its carriage
    // return.
    let body = body.strip_suffix('\r').unwrap_or(body);
    let mut hash = Sha256::new();
    for line in body.lines() {
        hash.update(line.as_bytes());
        hash.update(b"\n");
    }
    format!("sha256:{}", hexadecimal(&hash.finalize()))
}

fn document_of(model: &ModelFile) -> Document {
    let grid = model.grid();
    // Formats 2, 3 and 5 differ in the baseline alone, format 6 in what it refers to.
    let baseline = model.learnt.as_ref().and_then(|learnt| learnt.baseline.as_ref());
    Document {
        format: match (&model.by_guide, baseline) {
            (Some(model), _) if model.base().levels().is_some() => FORMAT,
            (_, Some(baseline)) if baseline.has_path_force() => FIRST_WITH_PATH_FORCE,
            (Some(_), _) => FIRST_WITH_GUIDE,
            (None, Some(_)) => FIRST_WITH_FACTORS,
            (None, None) => FIRST_FORMAT,
        },
        aircraft: model.initial.aircraft().file().clone(),
        guide: model.guide,
        polynomial: *model.initial.polynomial(),
        grid: GridText {
            lift_coefficient: grid.x().breakpoints().to_vec(),
            mach: grid.y().breakpoints().to_vec(),
        },
        initial: InitialText {
            drag_coefficient: model.initial.drag_table().values().to_vec(),
            extrapolated: flags_to_text(model.initial.extrapolated()),
            drag_coefficient_of_guide: model
                .by_guide
                .as_deref()
                .map(|model| model.drag_table().values().to_vec()),
            levels_of_guide: model
                .by_guide
                .as_deref()
                .and_then(|model| model.base().levels())
                .map(levels_to_text),
            _book_of_guide: None,
        },
        settings: model.settings,
        learnt: model.learnt.as_ref().map(learnt_to_text),
        effects: model.applied.iter().map(AppliedText::from).collect(),
        checksum: String::new(),
    }
}

fn levels_to_text(levels: &GuideLevels) -> LevelsText {
    let [lift_coefficient, mach] = levels.ranges();
    let levels = levels.levels().iter().map(|level| (level.pressure_altitude_m, level.shares));
    LevelsText { lift_coefficient, mach, levels: levels.collect() }
}

fn learnt_to_text(learnt: &Learnt) -> LearntText {
    let law = match &learnt.law {
        LawState::Paper { settings, state, ever_adapted, refits } => LawText::Paper {
            settings: *settings,
            refits: *refits,
            drag_coefficient: state.drag_coefficient().values().to_vec(),
            confidence: state.confidence().values().to_vec(),
            ever_adapted: flags_to_text(ever_adapted),
        },
        LawState::Bayes { state, posterior } => LawText::Bayes {
            drag_coefficient: posterior.drag().values().to_vec(),
            standard_deviation: posterior.standard_deviation().to_vec(),
            observations: posterior.observations().to_vec(),
            state: state.to_data(),
        },
    };
    LearntText {
        tail: learnt.tail.clone(),
        criteria: learnt.criteria.clone(),
        law,
        references: learnt.references.clone(),
        baseline: learnt.baseline.as_ref().map(|baseline| baseline.record().clone()),
        ledger: learnt.ledger.clone(),
    }
}

fn model_of(document: Document) -> Result<ModelFile, ModelTextError> {
    let aircraft = Aircraft::new(document.aircraft).map_err(|error| value("aircraft", error))?;
    // The breakpoints are written out for readers of the file; the aircraft's own are in force.
    let grid = Arc::clone(aircraft.grid());
    if grid.x().breakpoints() != document.grid.lift_coefficient {
        return Err(value("grid.lift_coefficient", ModelValueError::Breakpoints));
    }
    if grid.y().breakpoints() != document.grid.mach {
        return Err(value("grid.mach", ModelValueError::Breakpoints));
    }
    let table = |field, values: Vec<f64>| {
        Table::new(Arc::clone(&grid), values).map_err(|error| value(field, error))
    };
    let nodes = grid.nodes();
    let initial = PerformanceModel::new(
        aircraft,
        document.polynomial,
        table("initial.drag_coefficient", document.initial.drag_coefficient)?,
        flags_from_text("initial.extrapolated", &document.initial.extrapolated, nodes)?,
    )
    .map_err(|error| value("initial", error))?;
    let InitialText { drag_coefficient_of_guide, levels_of_guide, .. } = document.initial;
    let by_guide = match drag_coefficient_of_guide {
        None => None,
        Some(values) => {
            const FIELD: &str = "initial.drag_coefficient_of_guide";
            let model = initial.with_drag_table(table(FIELD, values)?);
            let model = model.map_err(|error| value(FIELD, error))?;
            Some(match levels_of_guide.map(levels_of).transpose()? {
                Some(levels) => model.with_levels(levels),
                None => model,
            })
        }
    };
    let applied = document.effects.into_iter().map(AppliedRecord::try_from);
    let applied: Vec<AppliedRecord> =
        applied.collect::<Result<_, _>>().map_err(|error| value("effects", error))?;
    let with_effects = |model| {
        ExtendedModel::new(model, layers_of(&applied)).map_err(|error| value("effects", error))
    };
    let initial = with_effects(initial)?;
    let by_guide = by_guide.map(with_effects).transpose()?.map(Box::new);
    let settings = document.settings;
    let learnt = match document.learnt {
        None => None,
        Some(LearntText { tail, criteria, law, references, baseline, ledger }) => {
            let law = law_of(law, &initial, settings.bayes)?;
            let reference = by_guide.as_deref().unwrap_or(&initial);
            let baseline = baseline
                .map(|record| baseline_of(record, reference, settings.bayes))
                .transpose()?;
            Some(Learnt { tail, criteria, law, references, baseline, ledger })
        }
    };
    let guide = document.guide;
    Ok(ModelFile { initial, guide, settings, learnt, applied, by_guide })
}

fn levels_of(text: LevelsText) -> Result<GuideLevels, ModelTextError> {
    let LevelsText { lift_coefficient, mach, levels } = text;
    let level = |(pressure_altitude_m, shares)| GuideLevel { pressure_altitude_m, shares };
    GuideLevels::new([lift_coefficient, mach], levels.into_iter().map(level).collect())
        .map_err(|error| value("initial.levels_of_guide", error))
}

/// A baseline of its record, with what was believed of the initial table.
fn baseline_of(
    record: BaselineRecord,
    initial: &ExtendedModel,
    settings: BayesSettings,
) -> Result<Baseline, ModelTextError> {
    const FIELD: &str = "learnt.baseline";
    let nodes = initial.drag_table().grid().nodes();
    if let Some(&node) = record.drag_nodes().iter().find(|&&node| node >= nodes) {
        return Err(value(FIELD, ModelValueError::NoSuchNode { node, nodes }));
    }
    let belief = if record.drag_nodes().is_empty() {
        None
    } else {
        Some(
            belief_before_flights(initial, settings, record.drag_nodes())
                .map_err(|error| value(FIELD, error))?,
        )
    };
    Baseline::new(record, belief).map_err(|error| value(FIELD, error))
}

fn law_of(
    law: LawText,
    initial: &ExtendedModel,
    bayes: BayesSettings,
) -> Result<LawState, ModelTextError> {
    let grid = initial.drag_table().grid();
    let table = |field, values: Vec<f64>| {
        Table::new(Arc::clone(grid), values).map_err(|error| value(field, error))
    };
    match law {
        LawText::Paper { settings, refits, drag_coefficient, confidence, ever_adapted } => {
            let state = PaperState::from_tables(
                table("learnt.law.drag_coefficient", drag_coefficient)?,
                table("learnt.law.confidence", confidence)?,
            )
            .map_err(|error| value("learnt.law", error))?;
            let ever_adapted =
                flags_from_text("learnt.law.ever_adapted", &ever_adapted, grid.nodes())?;
            Ok(LawState::Paper { settings, state, ever_adapted, refits })
        }
        LawText::Bayes { state, .. } => {
            let state = BayesState::from_data(initial.drag_table(), bayes, state)
                .map_err(|error| value("learnt.law.state", error))?;
            let posterior = state.solve().map_err(|error| value("learnt.law.state", error))?;
            Ok(LawState::Bayes { state: Box::new(state), posterior: Box::new(posterior) })
        }
    }
}

fn flags_to_text(flags: &[bool]) -> Vec<u8> {
    flags.iter().map(|flag| u8::from(*flag)).collect()
}

fn flags_from_text(
    field: &'static str,
    flags: &[u8],
    nodes: usize,
) -> Result<Vec<bool>, ModelTextError> {
    if flags.len() != nodes {
        return Err(value(field, ModelValueError::FlagCount { flags: flags.len(), nodes }));
    }
    flags
        .iter()
        .map(|flag| match flag {
            0 => Ok(false),
            1 => Ok(true),
            &found => Err(value(field, ModelValueError::Flag { found })),
        })
        .collect()
}

fn value(field: &'static str, reason: impl Into<ModelValueError>) -> ModelTextError {
    ModelTextError::Value { field, reason: reason.into() }
}

#[cfg(test)]
mod tests;
