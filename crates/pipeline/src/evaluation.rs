//! What a table predicts for segments, and the results of each tail at the end of a run: the material of summary, tables, pages.

use std::borrow::Cow;
use std::collections::BTreeMap;

use adapt::paper;
use diagnose::{WholeModel, WholePrediction};
use effects::ExtendedModel;
use flight::{Observation, Segment, Timestamp};
use lut::{Outside, SmoothCell, Table};
use units::PressureAltitude;

use crate::fuel_factor;
use crate::learning::{LearningCurve, curve_of};
use crate::model_file::ModelFile;
use crate::not_evaluated;
use crate::reading::FlightRead;
use crate::segments_table::{Evaluated, SegmentRow};
use crate::statistics::{ErrorStatistics, NORMAL_95, mean_half_width95_by_flight};
use crate::summary::{ErrorsSummary, TailSummary};
use crate::whole_model::{HeldByTable, Predicts, SegmentHeld, error_percent_of};

/// One tail at the end of a run.
#[derive(Clone, Debug)]
pub struct TailResult {
    /// Tail.
    pub tail: String,
    /// Its model, with what it has learnt.
    pub model: ModelFile,
    /// Every segment, with what the initial (or given) table predicts for it.
    pub rows: Vec<SegmentRow>,
    /// What the book predicts for each segment, as long as `rows`; empty where nothing is adapted.
    pub book: Vec<Option<Evaluated>>,
    /// What the final table predicts for each segment, as long as `rows`; empty where nothing is adapted.
    pub after: Vec<Option<Evaluated>>,
    /// The figures.
    pub summary: TailSummary,
    /// What is worth knowing about this tail's data ("roll not recorded: criterion not evaluated", …), each once.
    pub notes: Vec<String>,
    /// How far off the model was on each flight before it learnt it, where that is known.
    pub curve: Option<LearningCurve>,
}

/// Counts that do not follow from the segments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TailCounts {
    /// All flights.
    pub flights: usize,
    /// Flights that this run added; of a model as it was given those that did not teach it.
    pub flights_new: usize,
    /// Samples of all flights.
    pub samples: u64,
}

/// A tail's model and segments, before their errors are computed.
#[derive(Clone, Debug)]
pub struct TailData {
    /// Tail.
    pub tail: String,
    /// Its model, with what it has learnt.
    pub model: ModelFile,
    /// Its segments, in the order of the table that is written.
    pub segments: Vec<Segment>,
    /// Counts that do not follow from the segments.
    pub counts: TailCounts,
    /// What is worth knowing about its data, each once.
    pub notes: Vec<String>,
    /// How far off the model was on each flight before it learnt it, where that is known.
    pub curve: Option<LearningCurve>,
}

impl TailResult {
    /// The result of an adaptation: errors of the initial table before, of the whole learnt model after.
    pub fn adapted(data: TailData) -> Self {
        Self::adapted_as_predicted(data, None)
    }

    /// The same, given what the whole model predicts for each segment where that is known already.
    pub(crate) fn adapted_as_predicted(data: TailData, predicted: Option<&[Option<f64>]>) -> Self {
        // A whole model says more than the table that it has learnt.
        let whole = data.model.whole(Predicts::WholeModel);
        let learnt = whole.is_none().then(|| data.model.drag_coefficient());
        let ByTables { initial: before, learnt: by_table, book } =
            evaluate_with_book(&data.model, learnt, &data.segments);
        let after = match &whole {
            Some(whole) => {
                evaluate_whole((whole, predicted), &data.model, &data.segments, before.clone())
            }
            None => by_table,
        };
        drop(whole);
        let mut summary = summary_of(&data, &before);
        summary.informed_nodes = Some(data.model.informed_nodes());
        summary.refits = data.model.refits();
        summary.fuel_flow_error_percent.after = Some(statistics(&after));
        if data.model.by_guide.is_some() {
            summary.fuel_flow_error_percent.book = Some(statistics(&book));
            summary.book_half_width95_percent =
                mean_half_width95_by_flight(&by_flight(&data, &book));
        }
        let without_effects = data
            .model
            .initial
            .effects()
            .map(|_| evaluate_book(&data.model, BookEffects::None, &data.segments));
        let of_book = without_effects.as_ref().unwrap_or(&book);
        summary.fuel_factor_percent =
            fuel_factor::of_all(&data.tail, &data.segments, of_book).as_ref().map(Into::into);
        Self { book, ..Self::put_together(data, before, after, summary) }
    }

    /// The result of a model as it was given: errors of what it predicts now, nothing adapted.
    pub fn as_given(data: TailData, predicts: Predicts) -> Self {
        let before = evaluate_model(&data.model, predicts, &data.segments);
        let mut summary = summary_of(&data, &before);
        summary.interval95_coverage = match data.model.whole(predicts) {
            Some(whole) => {
                let found = announced_by_whole(&whole, &data);
                summary.mean_error_within_percent =
                    found.as_ref().map(|one| one.mean_within_percent);
                summary.beyond_flights = found.as_ref().map(|one| one.beyond_flights);
                found.map(|one| one.coverage)
            }
            None => coverage(&data.model, &data.segments),
        };
        Self::put_together(data, before, Vec::new(), summary)
    }

    /// The result of a model as it was given, over flights of one tail in any order.
    pub fn of_flights(
        tail: String,
        model: ModelFile,
        mut flights: Vec<FlightRead>,
        predicts: Predicts,
    ) -> Self {
        flights.sort_by(FlightRead::order);
        let counts = TailCounts {
            flights: flights.len(),
            flights_new: flights
                .iter()
                .filter(|flight| !model.has_learnt(&flight.reduced.identity))
                .count(),
            samples: flights.iter().map(|flight| flight.reduced.samples as u64).sum(),
        };
        let mut notes: Vec<String> = model.note_of_effects().into_iter().collect();
        for flight in &flights {
            flight.add_notes(&mut notes);
        }
        // Those without a segment are known here, too.
        let not_evaluated = not_evaluated::of_flights(&flights);
        let segments = flights.into_iter().flat_map(|flight| flight.reduced.segments).collect();
        let data = TailData { tail, model, segments, counts, notes, curve: None };
        let mut result = Self::as_given(data, predicts);
        result.summary.not_evaluated = not_evaluated;
        result
    }

    fn put_together(
        data: TailData,
        before: Vec<Option<Evaluated>>,
        after: Vec<Option<Evaluated>>,
        summary: TailSummary,
    ) -> Self {
        let TailData { tail, model, segments, notes, curve, .. } = data;
        let rows = segments
            .into_iter()
            .zip(before)
            .map(|(segment, evaluated)| SegmentRow { segment, evaluated })
            .collect();
        Self { tail, model, rows, book: Vec::new(), after, summary, notes, curve }
    }

    /// How far off the model was on each flight before it learnt it; made anew where it is not known. Empty for a model that has
    /// learnt nothing, or that cannot learn its flights again, which is told.
    pub fn learning_curve(&self) -> Cow<'_, LearningCurve> {
        if let Some(curve) = &self.curve {
            return Cow::Borrowed(curve);
        }
        let segments: Vec<Segment> = self.rows.iter().map(|row| row.segment.clone()).collect();
        let curve = curve_of(&self.model, &segments);
        Cow::Owned(curve.unwrap_or_else(|error| {
            tracing::warn!(
                tail = self.tail,
                "what the model said before it learnt each flight is not known: {error}"
            );
            LearningCurve::new()
        }))
    }

    /// Errors of the final table in per cent, segment by segment; empty where nothing is adapted.
    pub fn errors_after(&self) -> Vec<Option<f64>> {
        errors(&self.after)
    }
}

/// What a model predicts for each segment, with everything that it has learnt or with its table alone; otherwise as
/// [`evaluate`].
pub fn evaluate_model(
    model: &ModelFile,
    predicts: Predicts,
    segments: &[Segment],
) -> Vec<Option<Evaluated>> {
    let by_table = evaluate(&model.initial, model.drag_coefficient(), segments);
    let Some(whole) = model.whole(predicts) else { return by_table };
    evaluate_whole((&whole, None), model, segments, by_table)
}

/// The same, given what a table predicts, and of some segments what the whole model does.
fn evaluate_whole(
    (whole, predicted): (&WholeModel<'_>, Option<&[Option<f64>]>),
    model: &ModelFile,
    segments: &[Segment],
    by_table: Vec<Option<Evaluated>>,
) -> Vec<Option<Evaluated>> {
    segments
        .iter()
        .zip(by_table)
        .enumerate()
        .map(|(place, (segment, by_table))| {
            let by_table = by_table?;
            let known = predicted.and_then(|predicted| *predicted.get(place)?);
            let error = by_table
                .error_percent
                .and_then(|_| error_percent_of(whole, &model.initial, segment, known));
            let share = |error: f64| 1.0 - error / 100.0;
            Some(Evaluated {
                predicted_fuel_flow_kg_s: error
                    .map(|error| segment.means.fuel_flow_total_kg_s * share(error)),
                error_percent: error,
                ..by_table
            })
        })
        .collect()
}

/// What a table on the model's grid predicts for each segment; `None` for a state that the model is not defined for. A
/// segment outside the grid keeps its coefficients and has no error.
///
/// Coefficients are those without the effects that the model contains; the predicted fuel flow is the *recorded* one less
/// the error, effects included.
pub fn evaluate<'s>(
    model: &ExtendedModel,
    table: &Table,
    segments: impl IntoIterator<Item = &'s Segment>,
) -> Vec<Option<Evaluated>> {
    // Some effects are shares of the table's own drag: they are those of the table that is asked.
    let moved = model.effects().and_then(|_| model.with_drag_table(table.clone()).ok());
    let model = moved.as_ref().unwrap_or(model);
    segments
        .into_iter()
        .map(|segment| match model.observe(segment) {
            Ok(observation) => Some(evaluated(table, segment, &observation)),
            Err(_) => without_errors(model, segment),
        })
        .collect()
}

/// What the book predicts for each segment: the guide's own rows as a drag that is smooth between the nodes, times a factor by
/// level (`[bayes.16]`, `[tables.10]`), with or without the effects that the model contains.
///
/// A polynomial through those rows, and the chords of a table of it, are up to several per cent off, and what an aircraft burns more
/// than its book, or a flight management system multiplies, is counted from the guide. A file that does not keep those rows has the
/// initial table for a book.
pub fn evaluate_book(
    model: &ModelFile,
    effects: BookEffects,
    segments: &[Segment],
) -> Vec<Option<Evaluated>> {
    let without;
    let book = match effects {
        BookEffects::OfModel => model.reference(),
        BookEffects::None => {
            without = ExtendedModel::from(model.reference().base().clone());
            &without
        }
    };
    if model.by_guide.is_none() {
        return evaluate(book, book.drag_table(), segments);
    }
    let of_segment = |segment: &Segment| match book.observe(segment) {
        Ok(observation) => Some(by_book(book.drag_table(), segment, &observation)),
        Err(_) => without_errors(book, segment),
    };
    segments.iter().map(of_segment).collect()
}

/// Whether a book has the effects that its model contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BookEffects {
    /// It has.
    OfModel,
    /// It has not.
    None,
}

/// What the initial table, the learnt one where it is asked, and the book predict for each segment.
#[derive(Default)]
struct ByTables {
    initial: Vec<Option<Evaluated>>,
    learnt: Vec<Option<Evaluated>>,
    book: Vec<Option<Evaluated>>,
}

/// By tables and by the book, in one pass where segments give one observation for all.
fn evaluate_with_book(model: &ModelFile, learnt: Option<&Table>, segments: &[Segment]) -> ByTables {
    let initial = &model.initial;
    let table = initial.drag_table();
    if initial.effects().is_some() {
        return ByTables {
            initial: evaluate(initial, table, segments),
            learnt: learnt.map_or_else(Vec::new, |learnt| evaluate(initial, learnt, segments)),
            book: evaluate_book(model, BookEffects::OfModel, segments),
        };
    }
    let book = model.by_guide.as_deref();
    let mut found = ByTables::default();
    for segment in segments {
        let (by_initial, by_learnt, by_guide) = if let Ok(observation) = initial.observe(segment) {
            let by = |table| Some(evaluated(table, segment, &observation));
            let by_initial = by(table);
            let by_guide = book.map(|book| {
                let level = PressureAltitude::meters(segment.means.pressure_altitude_m);
                let of_table = book.base().without_level(&observation, level);
                by_book(book.drag_table(), segment, &of_table)
            });
            (by_initial, learnt.and_then(by), by_guide.or(by_initial))
        } else {
            let state = without_errors(initial, segment);
            (state, state, state)
        };
        found.initial.push(by_initial);
        if learnt.is_some() {
            found.learnt.push(by_learnt);
        }
        found.book.push(by_guide);
    }
    found
}

/// By the drag of the guide's rows, smooth between the nodes.
fn by_book(drag_table: &Table, segment: &Segment, observation: &Observation) -> Evaluated {
    let cell =
        SmoothCell::locate(drag_table.grid(), observation.lift_coefficient, observation.mach);
    let error =
        cell.ok().map(|cell| paper::error_percent_of(cell.value_of(drag_table), observation));
    with_error(segment, observation, error)
}

/// What a table predicts for a segment that gives this observation.
pub(crate) fn evaluated(table: &Table, segment: &Segment, observation: &Observation) -> Evaluated {
    with_error(segment, observation, error_percent(table, observation))
}

fn with_error(segment: &Segment, observation: &Observation, error: Option<f64>) -> Evaluated {
    Evaluated {
        lift_coefficient: observation.lift_coefficient,
        drag_coefficient: observation.drag_coefficient,
        predicted_fuel_flow_kg_s: error
            .map(|error| segment.means.fuel_flow_total_kg_s * (1.0 - error / 100.0)),
        error_percent: error,
    }
}

/// The coefficients of a segment that gives no observation.
fn without_errors(model: &ExtendedModel, segment: &Segment) -> Option<Evaluated> {
    let state = state_without_errors(model, segment)?;
    Some(Evaluated {
        lift_coefficient: state.lift_coefficient,
        drag_coefficient: state.drag_coefficient,
        predicted_fuel_flow_kg_s: None,
        error_percent: None,
    })
}

/// What a table predicts for an observation; `None` outside its grid.
pub fn error_percent(table: &Table, observation: &Observation) -> Option<f64> {
    let cell =
        table.grid().locate(observation.lift_coefficient, observation.mach, Outside::Error).ok()?;
    Some(paper::error_percent(table, &cell, observation))
}

/// What both kinds of results have in common.
fn summary_of(data: &TailData, before: &[Option<Evaluated>]) -> TailSummary {
    TailSummary {
        tail: data.tail.clone(),
        flights: data.counts.flights,
        flights_new: data.counts.flights_new,
        samples: data.counts.samples,
        segments: data.segments.len(),
        outside_table: errors(before).iter().filter(|error| error.is_none()).count(),
        not_evaluated: not_evaluated::of_segments(&data.segments),
        informed_nodes: None,
        refits: None,
        interval95_coverage: None,
        mean_error_within_percent: None,
        beyond_flights: None,
        fuel_flow_error_percent: ErrorsSummary {
            before: statistics(before),
            after: None,
            book: None,
        },
        mean_error_half_width95_percent: mean_half_width95_by_flight(&by_flight(data, before)),
        book_half_width95_percent: None,
        fuel_factor_percent: None,
    }
}

/// Errors of each flight, in the order of flying.
fn by_flight(data: &TailData, evaluated: &[Option<Evaluated>]) -> Vec<ErrorStatistics> {
    let mut flights: BTreeMap<(Timestamp, &str), Vec<f64>> = BTreeMap::new();
    for (segment, error) in data.segments.iter().zip(errors(evaluated)) {
        let identity = &segment.identity;
        flights.entry((identity.start, &identity.flight)).or_default().extend(error);
    }
    flights.values().map(|errors| ErrorStatistics::from_errors(errors)).collect()
}

fn state_without_errors(
    model: &ExtendedModel,
    segment: &Segment,
) -> Option<perf_model::SegmentState> {
    model.corrected(segment).ok().and_then(|corrected| model.state_of(&corrected).ok())
}

/// What the whole model states of segments, and how it holds.
struct Announced {
    /// Share of segments whose error lies within their interval.
    coverage: f64,
    /// Half the width of the interval of the mean over these flights, %.
    mean_within_percent: f64,
    /// Segments beyond what the learnt flights flew.
    beyond_flights: usize,
}

/// What the whole model states of these segments; `None` where it predicts none.
///
/// ```text
/// var(mean) = var of the model's mean error + Σ_f (n_f/n)²·(var_f + mean var_s/n_f),   f new flights, s their segments
/// ```
fn announced_by_whole(whole: &WholeModel<'_>, data: &TailData) -> Option<Announced> {
    let of_flight = |segments: &[Segment]| -> Vec<SegmentHeld> {
        let held = |segment| SegmentHeld::new(whole, &data.model.initial, segment);
        segments.iter().filter_map(held).collect()
    };
    let same_flight = |one: &Segment, other: &Segment| one.identity == other.identity;
    let flights: Vec<_> = data.segments.chunk_by(same_flight).map(of_flight).collect();
    let all = || flights.iter().flatten();
    let count = all().count();
    if count == 0 {
        return None;
    }
    let inside =
        all().filter(|held| held.gap.abs() <= NORMAL_95 * held.prediction.variance().sqrt());
    let predictions: Vec<_> = all().map(|held| &held.prediction).collect();
    let mut variance = whole.variance_of_mean(&predictions);
    for flight in flights.iter().filter(|flight| !flight.is_empty()) {
        let predictions: Vec<_> = flight.iter().map(|held| &held.prediction).collect();
        let own = WholePrediction::own_variance_of_flight(&predictions);
        variance += (flight.len() as f64 / count as f64).powi(2) * own;
    }
    Some(Announced {
        coverage: inside.count() as f64 / count as f64,
        mean_within_percent: 100.0 * NORMAL_95 * variance.sqrt(),
        beyond_flights: all().filter(|held| held.prediction.beyond_flights).count(),
    })
}

/// Share of segments whose error lies within the interval that law `bayes` states for them; `None` by another law, or
/// without a segment inside the table.
fn coverage(model: &ModelFile, segments: &[Segment]) -> Option<f64> {
    let posterior = model.posterior()?;
    let held = segments.iter().filter_map(|one| HeldByTable::new(&model.initial, posterior, one));
    let (mut inside, mut all) = (0_usize, 0_usize);
    for held in held {
        all += 1;
        inside += usize::from(held.excess.abs() <= NORMAL_95 * held.deviation);
    }
    (all > 0).then(|| inside as f64 / all as f64)
}

fn errors(evaluated: &[Option<Evaluated>]) -> Vec<Option<f64>> {
    evaluated.iter().map(|evaluated| evaluated.and_then(|e| e.error_percent)).collect()
}

fn statistics(evaluated: &[Option<Evaluated>]) -> ErrorStatistics {
    let errors: Vec<f64> = errors(evaluated).into_iter().flatten().collect();
    ErrorStatistics::from_errors(&errors)
}
