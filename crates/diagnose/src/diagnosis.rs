//! From flights to a verdict.

use std::collections::BTreeMap;

use effects::{EffectModel, EffectModelError, EffectReferences};
use flight::effect::{EffectId, HiddenParameter};

use crate::advice::advisor::Advisor;
use crate::advice::distances::{Distances, leading_columns};
use crate::hypotheses::design::{Acts, Design};
use crate::input::{Input, Options};
use crate::judge::closure::{Shrinkage, in_sample, nested};
use crate::judge::contributions::contributions;
use crate::judge::detection::{Detection, DetectionInput, detect};
use crate::judge::forms::leading_forms;
use crate::judge::gap::{exceeds_uncertainty, gap_of, is_real, noise_scale, unknown_square};
use crate::judge::noise_floors::{held_out_floor, replicate_floor};
use crate::judge::posterior::{causes, dominant};
use crate::judge::sufficiency::{insufficient, too_little};
use crate::judge::table::is_table_off;
use crate::judge::verdict::{Findings, advisor, level_like, named_gap, verdict};
use crate::library::Library;
use crate::library::dates::{DateGrid, is_dated};
use crate::library::engine_changes::SingleEngines;
use crate::output::addition::Addition;
use crate::output::form::{ActsOn, FoundForm};
use crate::output::note::{LeftOutReason, Note};
use crate::output::verdict::{Insufficient, Verdict};
use crate::output::{Detectable, Diagnosis, Gap, NotTestable, OutsideLibrary};
use crate::place::find::{FoundPlaces, find};
use crate::place::named::NamedGap;
use crate::priors::PRIOR_SCALES;
use crate::residuals::segments::PreparedFlights;
use crate::search::analyse::{Analysis, analyse};
use crate::search::outliers::outliers;
use crate::search::outside::{Outside, compete};
use crate::search::robust::outlier_weights;
use crate::search::system::{Problem, RowsWithinSegments, WhitenedSystem};
use crate::signals::references::DiagnoseError;
use crate::signals::table_uncertainty::{TableOrigin, TableUncertainty};
use crate::thresholds::{CLEAN_PROBABILITY, CLOSER_DATES, WORTH_CLOSER_DATES};

/// Diagnoses one set of flights.
///
/// # Errors
/// [`DiagnoseError`] where the model takes no effects or the numbers are degenerate. Too little data is a verdict, not
/// an error.
pub fn diagnose(input: &Input<'_>, options: &Options) -> Result<Diagnosis, DiagnoseError> {
    let references = match input.effect_references() {
        Ok(found) => found,
        Err(DiagnoseError::Model(EffectModelError::NothingInside { segments })) => {
            return Ok(insufficient(0, 0, Insufficient::NothingInside { segments }));
        }
        Err(error) => return Err(error),
    };
    let model = input.effect_model(references)?;
    let chosen = |id: EffectId| {
        (options.effects.is_empty() || options.effects.contains(&id))
            && !options.without.contains(&id)
    };
    // When the model was right, where it has learnt.
    let is_dated = input.references.is_some() || input.baseline.is_some();
    let right_at_s = is_dated.then_some(references.date_s);
    let run = Run { input, options, model: &model, references: &references };
    let (mut dates, mut judged) = (None, JudgedSegments::default());
    for attempt in 0..=CLOSER_DATES {
        let kept = dates.take();
        let (data, mut library) = PreparedFlights::prepare(
            &model,
            input.flights,
            input.reference(),
            |points, engines, starts| {
                let dates = kept.unwrap_or_else(|| {
                    let dates = DateGrid::coarse(starts, input.events_s, right_at_s);
                    match engines {
                        SingleEngines::Change => {
                            dates.with_single_engines(model.aircraft().engines())
                        }
                        SingleEngines::Alike | SingleEngines::NotRecorded => dates,
                    }
                });
                Library::new(&model, points, engines, dates, chosen)
            },
        );
        if input.table.map(TableUncertainty::origin) == Some(TableOrigin::Book) {
            library.believe_book();
        }
        match run.once(data, &library, &mut judged, attempt < CLOSER_DATES)? {
            Attempt::Done(found) => return Ok(*found),
            Attempt::Closer(closer) => dates = Some(*closer),
        }
    }
    Err(DiagnoseError::Degenerate)
}

/// What one pass over the dates that are tried comes to.
enum Attempt {
    Done(Box<Diagnosis>),
    /// A dated effect leads: these dates are to be tried.
    Closer(Box<DateGrid>),
}

/// What is found out about the segments once, whatever dates are tried.
#[derive(Default)]
struct JudgedSegments {
    /// Which of them are outliers.
    refused: Option<Vec<bool>>,
    /// Weights of the others, where their residuals have heavy tails.
    weights: Option<Vec<f64>>,
}

/// What stays the same whatever dates are tried.
#[derive(Clone, Copy)]
struct Run<'a> {
    input: &'a Input<'a>,
    options: &'a Options,
    model: &'a EffectModel<'a>,
    references: &'a EffectReferences,
}

impl Run<'_> {
    fn once(
        self,
        mut data: PreparedFlights<'_>,
        library: &Library,
        judged: &mut JudgedSegments,
        may_go_closer: bool,
    ) -> Result<Attempt, DiagnoseError> {
        let Self { input, options, model, references } = self;
        let not_testable: Vec<NotTestable> = library
            .not_testable
            .iter()
            .map(|(id, needs)| NotTestable { effect: *id, needs: needs.clone() })
            .collect();
        let mut notes = Vec::new();
        let too_few = |data: &PreparedFlights<'_>| {
            let reason = too_little(data, library)?;
            let mut found = insufficient(data.flights.len(), data.segments.len(), reason);
            found.not_testable.clone_from(&not_testable);
            found.left_out.clone_from(&data.left_out);
            Some(Attempt::Done(Box::new(found)))
        };
        if let Some(done) = too_few(&data) {
            return Ok(done);
        }
        notes.extend(data.notes(library, input.baseline));
        let design = |data: &_| Design::new(data, references, input.baseline, input.table);
        let of_all = design(&data);
        let rows = RowsWithinSegments::new(&data, &of_all);
        let refused =
            &*judged.refused.get_or_insert_with(|| outliers(&data, &of_all, library, &rows));
        let (design, rows) = if refused.contains(&true) {
            drop(rows);
            notes.push(leave_out(&mut data, refused));
            if let Some(done) = too_few(&data) {
                return Ok(done);
            }
            let of_kept = design(&data);
            let rows = RowsWithinSegments::new(&data, &of_kept);
            (of_kept, rows)
        } else {
            (of_all, rows)
        };
        notes.extend(input.table.and_then(table_in_columns));
        if input.references.is_none() && input.baseline.is_none() {
            notes.push(Note::ReferencesAreMeans);
        }
        if let Some(weights) = &judged.weights {
            data.weigh(weights);
        }
        let mut system = WhitenedSystem::of_rows(&data, &design, rows);
        let problem = Problem { system: &system, model, library };
        let mut analysis = analyse(problem, None).ok_or(DiagnoseError::Degenerate)?;
        // Heavy tails show only beside the best model; then everything is done again with weights.
        if judged.weights.is_none()
            && let Some(weights) = outlier_weights(&system, &analysis, library)
        {
            drop((analysis, system));
            data.weigh(judged.weights.insert(weights));
            system = WhitenedSystem::new(&data, &design);
            let problem = Problem { system: &system, model, library };
            analysis = analyse(problem, None).ok_or(DiagnoseError::Degenerate)?;
        }
        if let Some(off) = with_table_off(&mut system, (model, library), &analysis, options)? {
            analysis = off;
        }
        if let Some(closer) = closer_dates(&analysis, library).filter(|_| may_go_closer) {
            return Ok(Attempt::Closer(Box::new(closer)));
        }
        if judged.weights.is_some() {
            notes.push(Note::HeavyTails);
        }
        let problem = Problem { system: &system, model, library };
        let mut diagnosis = conclude(problem, &analysis, options, &mut notes)?;
        diagnosis.not_testable = not_testable;
        diagnosis.left_out.clone_from(&data.left_out);
        diagnosis.outliers = (0..refused.len()).filter(|&place| refused[place]).collect();
        diagnosis.notes = notes;
        Ok(Attempt::Done(Box::new(diagnosis)))
    }
}

/// The search again without the belief that a guide's table is right, where what is named under that belief explains unseen
/// flights no better than a table does.
///
/// Evidence prefers one effect of any size to a function of two variables, as long as neither explains all of the gap. But an
/// effect that is named in a guide's place sends someone to the aircraft, and a table costs an adaptation: the name has to be
/// better where it was not fitted.
fn with_table_off(
    system: &mut WhitenedSystem<'_>,
    (model, library): (&EffectModel<'_>, &Library),
    analysis: &Analysis,
    options: &Options,
) -> Result<Option<Analysis>, DiagnoseError> {
    let is_nothing = analysis.clean > CLEAN_PROBABILITY;
    if !system.is_book() || options.skip_closure || is_nothing || is_table_off(analysis) {
        return Ok(None);
    }
    // What is compared is what is left of the gap; the noise in it is the same.
    let judge = |system: &WhitenedSystem<'_>| {
        nested(Problem { system, model, library }, false, 1.0, options.seed)
    };
    let named = judge(system);
    let levels = system.levels.clone();
    system.rule_out_right_table();
    if named.leaves_less_than(&judge(system)) {
        system.levels = levels;
        return Ok(None);
    }
    let problem = Problem { system, model, library };
    analyse(problem, None).ok_or(DiagnoseError::Degenerate).map(Some)
}

/// Leaves outliers out.
fn leave_out(data: &mut PreparedFlights<'_>, refused: &[bool]) -> Note {
    let (of_segments, of_flights) = (data.segments.len(), data.flights.len());
    data.leave_out(refused, LeftOutReason::Outlier);
    Note::Outliers {
        segments: of_segments - data.segments.len(),
        of_segments,
        flights: of_flights - data.flights.len(),
    }
}

/// Dates about those of the first hypothesis with a dated effect that is worth it.
fn closer_dates(analysis: &Analysis, library: &Library) -> Option<DateGrid> {
    let worth =
        analysis.models.iter().filter(|(_, probability)| *probability >= WORTH_CLOSER_DATES);
    let rival = |id: EffectId| {
        let columns = analysis.models.iter().flat_map(|(scored, _)| &scored.hypothesis.columns);
        let of_id = columns
            .map(|&column| &library.columns[column])
            .find(|column| library.effects[column.effect].id == id);
        of_id.and_then(|column| match column.hidden {
            HiddenParameter::History(history) => Some(history),
            _ => None,
        })
    };
    worth
        .flat_map(|(scored, _)| &scored.hypothesis.columns)
        .map(|&column| &library.columns[column])
        .find_map(|column| {
            library.dates.closer(library.effects[column.effect].id, column.hidden, rival)
        })
}

fn conclude(
    problem: Problem<'_>,
    analysis: &Analysis,
    options: &Options,
    notes: &mut Vec<Note>,
) -> Result<Diagnosis, DiagnoseError> {
    let Problem { system, model, library } = problem;
    let mut outside = compete(system, analysis, library);
    let distances = distances_of(problem, analysis)?;
    let best = &analysis.models[0].0;
    let scale = noise_scale(analysis, best, system.gram(None).rows);
    let own = in_sample(problem, &best.hypothesis.columns, &best.sizes, scale, options.seed);
    let posteriors = dominant(system, analysis, library, &own);
    let mut gap = gap_of(system, analysis, &own, scale);
    let exceeds = exceeds_uncertainty(&gap, unknown_square(system));
    let real = exceeds || is_real(analysis, &outside);
    let unseen =
        (!options.skip_closure && real).then(|| nested(problem, exceeds, scale, options.seed));
    let places =
        (!options.skip_where).then(|| find(system, analysis, (scale, own.floor()), options.seed));
    let asked = DetectionInput {
        analysis,
        distances: &distances,
        posteriors: &posteriors,
        gap: &gap,
        own: &own,
        unseen: unseen.as_ref(),
        noise_scale: scale,
        is_real: real,
        exceeds_uncertainty: exceeds,
        places: places.as_ref(),
    };
    let Detection { detected, table, smooth_term, forms } = detect(problem, &asked, &mut outside);
    gap.detected = detected;
    let unseen = unseen.filter(|_| gap.detected);
    if unseen.is_some() {
        add_floors(&mut gap, problem, &own, scale);
    }
    let classes = distances.classes(library);
    let shown = &posteriors[..if gap.detected { posteriors.len() } else { 0 }];
    let advisor = advisor(problem, &distances, &classes, shown, analysis);
    let findings = Findings {
        level_like: &level_like(system, library),
        analysis,
        library,
        distances: &distances,
        advisor: &advisor,
        outside: &outside,
        smooth_term,
        posteriors: shown,
        table: table.as_ref(),
        own: &own,
        unseen: unseen.as_ref(),
    };
    let verdict = verdict(&findings, notes);
    let leading = || leading_forms(problem, analysis, &outside, (scale, options.seed));
    let found_forms = told_forms(&verdict, forms, leading);
    let named = (&verdict, &found_forms[..]);
    let led = |places| led_by_name(places, &findings, system, named, options.seed);
    let places = places.map_or_else(Vec::new, |places| led(places).of_gap(detected));
    Ok(Diagnosis {
        flights: system.data.flights.len(),
        segments: system.data.segments.len(),
        gap,
        r#where: places,
        causes: causes(&findings.of_causes(), &posteriors),
        contributions: contributions(problem, analysis, detected, (scale, options.seed)),
        not_testable: vec![],
        addition: named_addition(analysis, library, &verdict, *model.references()),
        verdict,
        detectable: detectable(library, &distances, &classes, &advisor),
        outside: outside_library(&outside, found_forms, (model, options)),
        held_out: unseen.as_ref().map_or_else(Vec::new, Shrinkage::by_flight),
        left_out: BTreeMap::new(),
        outliers: vec![],
        notes: vec![],
    })
}

/// Forms that describe a gap without a name, as they were found for the decision already or else now.
fn told_forms(
    verdict: &Verdict,
    found: Option<Vec<FoundForm>>,
    leading: impl FnOnce() -> Vec<FoundForm>,
) -> Vec<FoundForm> {
    match verdict {
        Verdict::OutsideLibrary(_) => found.unwrap_or_else(leading),
        _ => vec![],
    }
}

/// How far effects are apart, each by the hidden parameter that leads.
fn distances_of(problem: Problem<'_>, analysis: &Analysis) -> Result<Distances, DiagnoseError> {
    let leading = leading_columns(problem.library, &analysis.models);
    let Problem { system, .. } = problem;
    Distances::from_gram(system.gram(None), system.design, leading).ok_or(DiagnoseError::Degenerate)
}

/// What the named effects add to the model; nothing where it is its table that is off.
fn named_addition(
    analysis: &Analysis,
    library: &Library,
    verdict: &Verdict,
    references: EffectReferences,
) -> Option<Addition> {
    let named = verdict.effects();
    Addition::named(analysis, library, named, references)
        .filter(|_| !named.is_empty() && !verdict.is_of_table())
}

/// The places, that of what the verdict names first where it has one; where nothing has one, that of the form which describes the gap.
fn led_by_name(
    mut places: FoundPlaces,
    findings: &Findings<'_>,
    system: &WhitenedSystem<'_>,
    (verdict, forms): (&Verdict, &[FoundForm]),
    seed: u64,
) -> FoundPlaces {
    if let Some(named) = named_gap(findings, system, verdict) {
        if let Some(place) = named.place(system, &places.variances, seed) {
            places.lead_with(place, &named);
        }
    } else if places.are_none()
        && let Some(described) = NamedGap::of_forms(forms, system)
        && let Some(place) = described.place(system, &places.variances, seed)
    {
        places.say(place);
    }
    places
}

/// Adds the two estimates of the noise floor that need no sensor's standard deviation.
fn add_floors(gap: &mut Gap, problem: Problem<'_>, own: &Shrinkage, noise_scale: f64) {
    let Problem { system, library, .. } = problem;
    gap.floor_by_replicates_rms_percent = replicate_floor(system, own, noise_scale).map(percent);
    gap.floor_by_held_out_fit_rms_percent = held_out_floor(system, library).map(percent);
}

/// Root of a mean square, %.
fn percent(mean_square: f64) -> f64 {
    100.0 * mean_square.sqrt()
}

/// What is reported of a cause outside the library.
fn outside_library(
    outside: &Outside,
    mut forms: Vec<FoundForm>,
    (model, options): (&EffectModel<'_>, &Options),
) -> OutsideLibrary {
    // What may have no size describes nothing.
    forms.retain(FoundForm::has_a_size);
    let form = forms.first().and_then(FoundForm::applied);
    OutsideLibrary {
        probability: outside.probability,
        looked_for_all: options.effects.is_empty() && options.without.is_empty(),
        variable: outside.variable.map(|(variable, _)| variable),
        acts_on: outside.variable.map(|(_, acts)| acts_on(acts)),
        forms,
        addition: form.map(|form| Addition {
            effects: vec![],
            form: Some(form),
            references: *model.references(),
        }),
    }
}

/// Of every effect the size that would just be seen, what it cannot be told from, and what would tell it.
fn detectable(
    library: &Library,
    distances: &Distances,
    classes: &[Vec<usize>],
    advisor: &Advisor<'_>,
) -> Vec<Detectable> {
    let id = |effect: usize| library.effects[effect].id;
    let [.., (most, _)] = PRIOR_SCALES;
    (0..library.effects.len())
        .map(|effect| {
            let smallest = distances.smallest_detectable(library, effect);
            let largest = most * library.effects[effect].typical;
            let class = classes.iter().find(|class| class.contains(&effect));
            Detectable {
                effect: id(effect),
                smallest: (smallest <= largest).then_some(smallest),
                hidden: if is_dated(id(effect)) {
                    HiddenParameter::None
                } else {
                    library.columns[library.effects[effect].representative].hidden
                },
                class: class.map_or_else(Vec::new, |class| class.iter().map(|&e| id(e)).collect()),
                nearest_other: distances.nearest_other(library, effect),
                nearest_pair: distances.nearest_pair(library, effect),
                separations: class.map_or_else(Vec::new, |class| advisor.beforehand(effect, class)),
            }
        })
        .collect()
}

const fn acts_on(acts: Acts) -> ActsOn {
    match acts {
        Acts::FuelFlow => ActsOn::FuelFlow,
        Acts::Thrust => ActsOn::Thrust,
        Acts::Split => ActsOn::OneEngine,
    }
}

/// What of a large table's uncertainty is left out.
fn table_in_columns(table: &TableUncertainty) -> Option<Note> {
    table.missing_share().map(|missing_share| Note::TableInColumns {
        nodes: table.grid().nodes(),
        columns: table.rank(),
        missing_share,
    })
}
