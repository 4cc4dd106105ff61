//! One tail's flights, learnt one after the other.

mod again;
mod curve;

use std::borrow::Cow;
use std::collections::BTreeMap;

use adapt::bayes::{BayesSettings, BayesState, InitialError, ObservationUpdate, SolveError};
use adapt::paper::{self, PaperLaw, State as PaperState, Update};
use diagnose::{Baseline, FlightRecord, GaugeBurn, visited_nodes};
use effects::ExtendedModel;
use flight::{FlightIdentity, Observation, Segment};
use refit::RefitRule;

use crate::condition_means::{ConditionMeans, Conditions};
use crate::model_file::{GuideRecord, LawState, Learnt, LedgerEntry, PaperSettings};
use crate::table_uncertainty::states_of;
use crate::whole_model::belief_before_flights;

pub(crate) use again::LearningAgain;
pub use again::begin_again;
pub use curve::{FlightKey, Forecast, LearningCurve, curve_of};
pub(crate) use curve::{continue_curve, deviation_percent};

/// A flight to learn.
#[derive(Clone, Debug)]
pub struct FlightToLearn<'a> {
    /// Its entry in the ledger, but for what learning counts.
    pub entry: LedgerEntry,
    /// Its segments in time order.
    pub segments: &'a [Segment],
}

/// What learning one flight came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlightLearnt {
    /// Segments that adapted the table.
    pub adapted: usize,
    /// Segments outside the grid, or that could not be reduced to an observation.
    pub outside_table: usize,
    /// Whether the polynomial was fitted anew.
    pub refitted: bool,
}

/// The law by which a tail learns, with what the caller may set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LawChoice {
    /// Law `paper`.
    Paper(PaperSettings),
    /// Law `bayes` with the model's settings.
    Bayes(BayesSettings),
}

/// The state in which a tail begins: the initial table, nothing learnt.
///
/// # Errors
/// An initial table that the law cannot correct.
pub fn begin(
    initial: &ExtendedModel,
    tail: &str,
    criteria: &str,
    law: LawChoice,
) -> Result<Learnt, LearningError> {
    let table = initial.drag_table();
    let law = match law {
        LawChoice::Paper(settings) => LawState::Paper {
            settings,
            state: PaperState::new(table.clone()),
            ever_adapted: vec![false; table.values().len()],
            refits: 0,
        },
        LawChoice::Bayes(settings) => {
            let state = BayesState::new(table, settings)?;
            let posterior = Box::new(state.solve()?);
            LawState::Bayes { state: Box::new(state), posterior }
        }
    };
    Ok(Learnt {
        tail: tail.to_owned(),
        criteria: criteria.to_owned(),
        law,
        references: ConditionMeans::default(),
        baseline: None,
        ledger: Vec::new(),
    })
}

/// Learns one flight. Law `paper`: each segment in time order, then, perhaps, the global refit. Law `bayes`: all its
/// segments at once; [`settle`] brings the table up to date.
///
/// # Errors
/// An invalid threshold, or a table whose nodes no longer determine its polynomial; the flight is then not learnt.
pub fn learn_flight(
    initial: &ExtendedModel,
    learnt: &mut Learnt,
    flight: &FlightToLearn<'_>,
) -> Result<FlightLearnt, LearningError> {
    let mut observations = Vec::with_capacity(flight.segments.len());
    let mut conditions = Vec::with_capacity(flight.segments.len());
    for segment in flight.segments {
        if let Some((observation, corrected)) = observed(initial, segment) {
            conditions.push(Conditions::of(&corrected, observation.lift_coefficient));
            observations.push(observation);
        }
    }
    let mut result = learn_observations(initial, &mut learnt.law, &observations)?;
    result.outside_table += flight.segments.len() - observations.len();
    learnt.references.add(&conditions);
    learnt.ledger.push(LedgerEntry {
        segments: flight.segments.len() as u64,
        outside_table: result.outside_table as u64,
        ..flight.entry.clone()
    });
    Ok(result)
}

/// What a segment says of drag, with the segment as it would have been recorded without the errors that the model contains;
/// `None` where it cannot be reduced to an observation.
fn observed<'s>(
    initial: &ExtendedModel,
    segment: &'s Segment,
) -> Option<(Observation, Cow<'s, Segment>)> {
    Some((initial.observe(segment).ok()?, initial.corrected(segment).ok()?))
}

/// Learns what the segments of one flight say of drag: the law's part of [`learn_flight`].
///
/// # Errors
/// As there.
fn learn_observations(
    initial: &ExtendedModel,
    law: &mut LawState,
    observations: &[Observation],
) -> Result<FlightLearnt, LearningError> {
    let mut result = FlightLearnt::default();
    match law {
        LawState::Paper { settings, state, ever_adapted, refits } => {
            let law = PaperLaw::new(settings.threshold_percent)?;
            // On copies: a flight whose refit fails leaves no trace.
            let (mut new_state, mut new_adapted) = (state.clone(), ever_adapted.clone());
            learn_by_paper(law, &mut new_state, &mut new_adapted, observations, &mut result);
            let (mut drag_coefficient, mut confidence) = new_state.into_tables();
            let basis = initial.polynomial().basis;
            let rule = RefitRule::ghazi_2020();
            let report = refit::refit(rule, basis, &mut drag_coefficient, &mut confidence)?;
            let new_state = paper::State::from_tables(drag_coefficient, confidence)?;
            if report.fit.is_some() {
                result.refitted = true;
                *refits += 1;
            }
            (*state, *ever_adapted) = (new_state, new_adapted);
        }
        LawState::Bayes { state, .. } => {
            let update = state.learn_flight(observations);
            for observation in &update.observations {
                match observation {
                    ObservationUpdate::Learnt { .. } => result.adapted += 1,
                    _ => result.outside_table += 1,
                }
            }
        }
    }
    Ok(result)
}

/// Brings the table up to date with what was learnt: the one solve of law `bayes`, nothing for law `paper`.
///
/// # Errors
/// A state that is not valid information (a damaged file).
pub fn settle(learnt: &mut Learnt) -> Result<(), LearningError> {
    if let LawState::Bayes { state, posterior } = &mut learnt.law {
        **posterior = state.solve()?;
        if let Some(guard) = posterior.guard() {
            tracing::warn!(
                tail = learnt.tail,
                nodes = guard.nodes.len(),
                "drag was kept physical at nodes where what was learnt was not"
            );
        }
    }
    Ok(())
}

/// ln of the fuel flow, kg/s, that a model with all that it has learnt predicts for each of its segments; `None` of those that it
/// did not learn from.
pub type LnFuelFlows = Vec<Option<f64>>;

/// Learns, from every segment of a tail, everything that flights show of it, the table included, in one posterior (law
/// `bayes`). From flights outside the table nothing is learnt. Returns what the model then predicts for each segment.
/// `guide` says which masses and levels the initial model is of.
pub fn remember_remainder(
    (initial, guide): (&ExtendedModel, Option<&GuideRecord>),
    learnt: &mut Learnt,
    segments: &[Segment],
) -> Option<LnFuelFlows> {
    let LawState::Bayes { state, .. } = &learnt.law else { return None };
    let gauges = GaugesOf::ledger(&learnt.ledger);
    let flights: Vec<FlightRecord<'_>> = segments
        .chunk_by(|one, other| one.identity == other.identity)
        .map(|segments| FlightRecord { segments, gauges: gauges.of(&segments[0].identity) })
        .collect();
    let (baseline, predicted) = baseline_of((initial, guide), *state.settings(), &flights)
        .inspect(|(baseline, _)| tell_of_physics(&learnt.tail, baseline))
        .inspect_err(|reason| {
            tracing::info!(tail = learnt.tail, "no remainder is remembered: {reason}");
        })
        .ok()
        .unzip();
    learnt.baseline = baseline;
    predicted
}

/// What gauges showed of the flights of a ledger, by START and FLIGHT.
struct GaugesOf<'l>(BTreeMap<(&'l str, &'l str), GaugeBurn>);

impl<'l> GaugesOf<'l> {
    fn ledger(ledger: &'l [LedgerEntry]) -> Self {
        let of = |entry: &'l LedgerEntry| {
            Some(((entry.start.as_str(), entry.flight.as_str()), entry.gauges?))
        };
        Self(ledger.iter().filter_map(of).collect())
    }

    fn of(&self, identity: &FlightIdentity) -> Option<GaugeBurn> {
        if self.0.is_empty() {
            return None;
        }
        self.0.get(&(identity.start.to_string().as_str(), identity.flight.as_str())).copied()
    }
}

/// Says where flights did not settle that drag is physical, and where they speak against it.
fn tell_of_physics(tail: &str, baseline: &Baseline) {
    let (held, against) = baseline.physics();
    if held > 0 {
        tracing::info!(tail, held, "drag that was in doubt was held to what is physical");
    }
    if against > 0 {
        tracing::warn!(
            tail,
            against,
            "flights speak against drag that rises with lift coefficient, or with Mach number in the drag rise: it is left as they have it"
        );
    }
}

/// Everything that flights say of a model, against its initial table.
fn baseline_of(
    (initial, guide): (&ExtendedModel, Option<&GuideRecord>),
    settings: BayesSettings,
    flights: &[FlightRecord<'_>],
) -> Result<(Baseline, LnFuelFlows), String> {
    let table = initial.drag_table();
    let visited = visited_nodes(initial, table, flights).map_err(|error| error.to_string())?;
    let belief = belief_before_flights(initial, settings, &visited).map_err(|e| e.to_string())?;
    let belief = belief.with_guide(guide.and_then(states_of));
    let half_life_days = settings.values().half_life_days;
    Baseline::learn_and_predict(initial, table, Some(belief), flights, half_life_days)
        .map_err(|error| error.to_string())
}

fn learn_by_paper(
    law: PaperLaw,
    state: &mut PaperState,
    ever_adapted: &mut [bool],
    observations: &[Observation],
    result: &mut FlightLearnt,
) {
    for observation in observations {
        match law.adapt(state, observation) {
            update @ Update::Adapted { .. } => {
                result.adapted += 1;
                for change in update.changes() {
                    ever_adapted[change.node] = true;
                }
            }
            Update::WithinDeadBand { .. } => {}
            Update::OutsideGrid(_) | Update::Unusable { .. } => result.outside_table += 1,
        }
    }
}

/// Why a flight was not learnt.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LearningError {
    /// The threshold of law `paper`.
    #[error(transparent)]
    Threshold(#[from] paper::ThresholdError),
    /// The global refit of law `paper`.
    #[error(transparent)]
    Refit(#[from] refit::RefitError),
    /// The tables of law `paper` after the refit.
    #[error(transparent)]
    Paper(#[from] paper::StateError),
    /// The initial table, for law `bayes`.
    #[error(transparent)]
    Initial(#[from] InitialError),
    /// The solution of law `bayes`.
    #[error(transparent)]
    Solve(#[from] SolveError),
}
