//! The columns of the search: every testable effect, one column for each value of a hidden parameter.

use effects::{EffectModel, EffectPoint};
use flight::effect::{
    DragRise, DragRiseLaw, EffectGroup, EffectId, EffectSign, HiddenParameter, NeededInput,
    ThrottleArgument,
};

use crate::library::dates::DateGrid;
use crate::library::engine_changes::SingleEngines;
use crate::priors::{
    AGNOSTIC_SPIKES, BACKGROUND_SPIKES, BOOK_AGNOSTIC_SPIKES, BOOK_OTHER_EFFECTS, BOOK_SPIKES,
    DIVERGENCE_MACHS, KNOWN_DEVIATION, N2_PIVOT, SPIKES_OF_RIGHT_TABLE,
    STEEP_DIVERGENCE_FROM_FASTEST_MACH, STEEP_DIVERGENCE_MACHS, THROTTLE_PIVOTS,
};
use crate::thresholds::RECORDED_SHARE;

pub(crate) mod dates;
pub(crate) mod engine_changes;
pub(crate) mod forms;

/// One column: an effect at one value of its hidden parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Column {
    pub(crate) effect: usize,
    pub(crate) hidden: HiddenParameter,
    /// ln of the number of hidden parameters that are believed in alike.
    pub(crate) ln_choices: f64,
}

/// One testable effect with its prior.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Testable {
    pub(crate) id: EffectId,
    /// Typical size in the effect's unit.
    pub(crate) typical: f64,
    /// Standard deviation, per unit of a background's scale, where no hypothesis names it.
    pub(crate) small: f64,
    /// Prior mean and standard deviation of θ; the standard deviation is mixed at once and three times where free.
    pub(crate) prior_mean: f64,
    pub(crate) prior_deviation: f64,
    pub(crate) has_known_size: bool,
    /// Whether physics says which sign to expect.
    pub(crate) sign: EffectSign,
    /// First column and number of columns.
    pub(crate) first_column: usize,
    pub(crate) columns: usize,
    /// The column that represents the effect where a single one is needed.
    pub(crate) representative: usize,
}

impl Testable {
    /// Its columns, one for each value of its hidden parameter.
    pub(crate) const fn all_columns(&self) -> core::ops::Range<usize> {
        self.first_column..self.first_column + self.columns
    }
}

/// Testable effects, their columns, and what cannot be tested.
#[derive(Clone, Debug)]
pub(crate) struct Library {
    pub(crate) effects: Vec<Testable>,
    pub(crate) columns: Vec<Column>,
    /// The dates that dated effects have.
    pub(crate) dates: DateGrid,
    pub(crate) not_testable: Vec<(EffectId, Vec<NeededInput>)>,
    /// `fuel_heating_value`, a variance: not among the columns.
    pub(crate) heating_value: bool,
    /// Scales of the backgrounds in which every effect acts a little, and of those behind functions without a name.
    pub(crate) spikes: [f64; 4],
    pub(crate) agnostic_spikes: [f64; 2],
    /// How many of each apply where a table that may be off is right: the smallest.
    pub(crate) spikes_of_right_table: usize,
}

impl Library {
    /// The library for these points. `only` and `without` are the caller's choice.
    pub(crate) fn new(
        model: &EffectModel<'_>,
        points: &[EffectPoint],
        engines: SingleEngines,
        dates: DateGrid,
        chosen: impl Fn(EffectId) -> bool,
    ) -> Self {
        let mut library = Self {
            effects: Vec::new(),
            columns: Vec::new(),
            dates,
            not_testable: Vec::new(),
            heating_value: false,
            spikes: BACKGROUND_SPIKES,
            agnostic_spikes: AGNOSTIC_SPIKES,
            spikes_of_right_table: SPIKES_OF_RIGHT_TABLE,
        };
        for id in EffectId::library(model.aircraft().engines()) {
            // What the model contains and physics knows the size of is no effect any more.
            if !chosen(id) || model.applied().is_some_and(|applied| applied.settles(id)) {
                continue;
            }
            if let Some(needs) = lacking(id, points, engines) {
                library.not_testable.push((id, needs));
            } else if id == EffectId::FuelHeatingValue {
                library.heating_value = true;
            } else {
                library.add(id, hidden_grid(id, model, points, &library.dates), model);
            }
        }
        library
    }

    /// Believes of the backgrounds what is believed of a guide: its equations lack what a model may lack at all times.
    pub(crate) fn believe_book(&mut self) {
        self.spikes = BOOK_SPIKES;
        self.agnostic_spikes = BOOK_AGNOSTIC_SPIKES;
        for effect in &mut self.effects {
            if !acts_at_all_times(effect.id) {
                effect.small = BOOK_OTHER_EFFECTS * effect.typical;
            }
        }
    }

    fn add(&mut self, id: EffectId, grid: Vec<HiddenParameter>, model: &EffectModel<'_>) {
        if grid.is_empty() {
            return; // a step needs flights on both sides of a date
        }
        let usual = model.references().typical_size(id);
        let typical = match id.entry().hidden {
            HiddenParameter::History(_) => {
                let fall_percent = model.references().typical_size(EffectId::StepChange);
                self.dates.typical_rate(usual, fall_percent)
            }
            _ => usual,
        };
        let known = id.is_known();
        let first_column = self.columns.len();
        let effect = self.effects.len();
        // What holds where nothing is said, where the grid has it.
        let middle = grid.iter().position(|hidden| *hidden == id.entry().hidden);
        let by_usual_law = grid.iter().filter(|hidden| !is_steep_rise(**hidden)).count();
        let middle = middle.unwrap_or(by_usual_law / 2);
        self.effects.push(Testable {
            id,
            typical,
            small: typical,
            prior_mean: if known { 1.0 } else { 0.0 },
            prior_deviation: if known { KNOWN_DEVIATION } else { typical },
            has_known_size: known,
            sign: id.entry().sign,
            first_column,
            columns: grid.len(),
            representative: first_column + middle,
        });
        let alike = (grid.len() as f64).ln();
        let dates = &self.dates;
        self.columns.extend(grid.into_iter().map(|hidden| Column {
            effect,
            hidden,
            ln_choices: dates.ln_choices(id, hidden).unwrap_or(alike),
        }));
    }
}

/// Whether an effect is one that the equations of a model may lack for every aircraft at all times, and not one of a single
/// aircraft: its sensors, its loading, one of its engines, its age, an event.
pub(crate) const fn acts_at_all_times(id: EffectId) -> bool {
    match id.entry().group {
        EffectGroup::Airframe => {
            !matches!(id, EffectId::AirframeAgeing | EffectId::AirframeHistory)
        }
        EffectGroup::Engine => !matches!(
            id,
            EffectId::TsfcEngine(_)
                | EffectId::EngineAgeing
                | EffectId::EngineHistory
                | EffectId::AntiIceBleed
        ),
        EffectGroup::Environment => true,
        EffectGroup::Mass | EffectGroup::Sensor | EffectGroup::Event => false,
    }
}

/// Which of an effect's inputs are missing in too many segments; `None` where it can be tested.
fn lacking(
    id: EffectId,
    points: &[EffectPoint],
    engines: SingleEngines,
) -> Option<Vec<NeededInput>> {
    if matches!(id, EffectId::TsfcEngine(_) | EffectId::FuelFlowGainEngine(_))
        && engines == SingleEngines::NotRecorded
    {
        return Some(vec![NeededInput::FuelFlowPerEngine]);
    }
    // Anti-ice bleed is tested by what stands for it. An assumed temperature can be predicted with, and nothing be learnt of it.
    let tells =
        |point: &EffectPoint, input: NeededInput| input == NeededInput::AntiIce || point.has(input);
    let needs = id.entry().needs;
    let are_too_many =
        |missing: usize| (missing as f64) > (1.0 - RECORDED_SHARE) * points.len() as f64;
    let untold = |point: &&EffectPoint| !needs.iter().all(|&it| tells(point, it));
    if !are_too_many(points.iter().filter(untold).count()) {
        return None;
    }
    let is_missing = |input: &NeededInput| {
        are_too_many(points.iter().filter(|point| !tells(point, *input)).count())
    };
    let missing: Vec<NeededInput> = needs.iter().copied().filter(is_missing).collect();
    // Inputs may each be recorded often enough, and too seldom together.
    Some(if missing.is_empty() { needs.to_vec() } else { missing })
}

fn hidden_grid(
    id: EffectId,
    model: &EffectModel<'_>,
    points: &[EffectPoint],
    dates: &DateGrid,
) -> Vec<HiddenParameter> {
    match id.entry().hidden {
        HiddenParameter::None => vec![HiddenParameter::None],
        HiddenParameter::Throttle { .. } => {
            let over_n2 = tells_thrust_by_n2(points).then_some(N2_PIVOT);
            let over_n2 = over_n2.map(|pivot| (pivot, ThrottleArgument::N2));
            THROTTLE_PIVOTS
                .map(|pivot| (pivot, ThrottleArgument::CorrectedThrust))
                .into_iter()
                .chain(over_n2)
                .map(|(pivot, argument)| HiddenParameter::Throttle { pivot, argument })
                .collect()
        }
        HiddenParameter::DragRise(_) => {
            let stated = model.aircraft().drag_divergence_mach();
            let by_lock = stated.map_or(DIVERGENCE_MACHS.to_vec(), |mach| vec![mach.value()]);
            let by_lock = by_lock.into_iter().map(DragRise::by_lock);
            by_lock.chain(steep_rises(points)).map(HiddenParameter::DragRise).collect()
        }
        HiddenParameter::Step { .. } | HiddenParameter::History(_) => dates.hidden(id).to_vec(),
    }
}

/// Steep rises that the fastest of these points may be in.
fn steep_rises(points: &[EffectPoint]) -> impl Iterator<Item = DragRise> {
    let fastest = points.iter().map(|point| point.mach).fold(0.0, f64::max);
    STEEP_DIVERGENCE_MACHS
        .into_iter()
        .filter(move |mach| (fastest - mach).abs() <= STEEP_DIVERGENCE_FROM_FASTEST_MACH)
        .map(|divergence_mach| DragRise { divergence_mach, law: DragRiseLaw::Steep })
}

const fn is_steep_rise(hidden: HiddenParameter) -> bool {
    matches!(hidden, HiddenParameter::DragRise(DragRise { law: DragRiseLaw::Steep, .. }))
}

/// Whether thrust can be read from N2 in enough segments.
fn tells_thrust_by_n2(points: &[EffectPoint]) -> bool {
    let without = points.iter().filter(|point| point.corrected_thrust_by_n2_n.is_none()).count();
    (without as f64) <= (1.0 - RECORDED_SHARE) * points.len() as f64
}
