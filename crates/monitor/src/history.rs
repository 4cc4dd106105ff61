//! One series read as a history: noise, changes with the interval of their dates, trend, levels, effects of events.

use core::ops::Range;

use flight::Timestamp;

use crate::filter::{ChangeFilter, EventBefore, FilteredFlight};
use crate::levels::{Estimate, Levels, NORMAL_95};
use crate::noise::{Noise, median};
use crate::series::Series;
use crate::settings::{ChangeBeliefs, REPORTED_PROBABILITY};

mod dated;
mod gap;
mod trend;

use dated::{changes, nearest};
pub use gap::StepInGap;

/// How often changes are looked for beside what conditions change. Our choice: where one is found, what conditions change is found
/// anew beside it, and may show another one.
const MOST_ROUNDS: usize = 4;

/// A change that the flights show.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// First flight after it.
    pub first_flight: usize,
    /// The 95 % interval of that flight: earliest.
    pub earliest: usize,
    /// The 95 % interval of that flight: latest.
    pub latest: usize,
    /// Probability that there is a change about here.
    pub probability: f64,
    /// Size of the step, %: positive, the aircraft burns more afterwards.
    pub step_percent: Estimate,
    /// The event that it belongs to, by its place among the events given.
    pub event: Option<usize>,
    /// Other events within the interval that could be it as well.
    pub other_events: Vec<usize>,
}

/// What a recorded event can have to do with a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bearing {
    /// Nothing: an exchange of another engine.
    None,
    /// It may have changed the series.
    Possible,
    /// The same, rather than others about the same time: an exchange of the engine that the series is of.
    Likely,
}

/// What is known of steps beforehand.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KnownSteps {
    /// When a part of what the series sums up stepped: levels and trend step there too, by whatever the flights say.
    pub of_a_part: Vec<Timestamp>,
    /// When something was done to burn less, such as a wash, whatever the flights say of each: the trend is that between them.
    pub to_burn_less: Vec<Timestamp>,
}

/// What an event did.
#[derive(Clone, Debug, PartialEq)]
pub struct EventEffect {
    /// Its place among the events given.
    pub event: usize,
    /// First flight at or after it.
    pub first_flight: usize,
    /// Size of the step there, %; `None` where there is no flight before or none after.
    pub effect_percent: Option<Estimate>,
    /// Other events between the same two flights: the step is that of all together.
    pub together_with: Vec<usize>,
}

/// A series with what it shows.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Scatter of flights when nothing changes.
    pub noise: Noise,
    /// Weight of each flight, %⁻².
    pub weights: Vec<f64>,
    /// Changes that are more probable than not, in order.
    pub changes: Vec<Change>,
    /// Trend, and levels between the changes.
    pub levels: Levels,
    /// A step that explains the flights about as well as a trend that stands out does: it is one or the other.
    pub step_in_gap: Option<StepInGap>,
    /// Of every event, in the order given.
    pub events: Vec<EventEffect>,
    /// The flights at the series' mean conditions; as they were where conditions are not known.
    pub at_mean_conditions: Series,
}

impl History {
    /// Reads a series; `None` for a series without a flight.
    ///
    /// An event belongs to the first flight that began at or after it. Its effect is measured whether or not it is a change
    /// that the flights would show by themselves.
    #[must_use]
    pub fn fit(series: &Series, events: &[Timestamp], beliefs: &ChangeBeliefs) -> Option<Self> {
        let events: Vec<_> = events.iter().map(|time| (*time, Bearing::Possible)).collect();
        Self::fit_to_events(series, &events, beliefs)
    }

    /// The same where of each event is known what it can have to do with the series: one without a bearing makes no change more
    /// probable and has none belong to it; its effect is measured all the same.
    #[must_use]
    pub fn fit_to_events(
        series: &Series,
        events: &[(Timestamp, Bearing)],
        beliefs: &ChangeBeliefs,
    ) -> Option<Self> {
        Self::fit_with_steps(series, events, &KnownSteps::default(), beliefs)
    }

    /// The same where more is known of some instants. A change that the flights show in addition to steps of a part is one of its own; one
    /// that may be these, which lie within the interval of its date, is theirs: it begins at the nearest, and its size is that of all of
    /// them.
    #[must_use]
    pub fn fit_with_steps(
        series: &Series,
        events: &[(Timestamp, Bearing)],
        steps: &KnownSteps,
        beliefs: &ChangeBeliefs,
    ) -> Option<Self> {
        let noise = Noise::estimate(series);
        let weights = noise.weights(series);
        let at_flight: Vec<usize> =
            events.iter().map(|(time, _)| series.first_from(*time)).collect();
        let candidates: Vec<Candidate> = at_flight
            .iter()
            .zip(events)
            .enumerate()
            .filter(|(_, (_, (_, bearing)))| *bearing != Bearing::None)
            .map(|(event, (flight, (_, bearing)))| Candidate {
                event,
                flight: *flight,
                is_likely: *bearing == Bearing::Likely,
            })
            .collect();
        let is_inside = |flight: &usize| (1..series.len()).contains(flight);
        let known: Vec<usize> =
            steps.of_a_part.iter().map(|time| series.first_from(*time)).filter(is_inside).collect();
        let recorded: Vec<usize> = at_flight.iter().copied().filter(is_inside).collect();
        let recorded = merged(&recorded, &known);
        let mut boundaries = Vec::new();
        let (mut changes, mut levels, mut stepped);
        let mut round = 0;
        loop {
            round += 1;
            let all = merged(&boundaries, &recorded);
            let shown = Levels::fit(series, &weights, &all, beliefs)?.at_mean_conditions(series);
            changes = found(&shown, &weights, &candidates, beliefs);
            let asked = Asked::new(&shown, &weights, &[], *beliefs);
            stepped = stepped_events(&asked, &changes, (&candidates, &known))?;
            levels = levels_between(&mut changes, &stepped, series, &weights, beliefs)?;
            let next: Vec<usize> = changes.iter().map(|change| change.first_flight).collect();
            let is_settled = next == boundaries;
            boundaries = next;
            if is_settled || series.conditions().is_empty() || round == MOST_ROUNDS {
                break;
            }
        }
        let done: Vec<usize> = steps
            .to_burn_less
            .iter()
            .map(|time| series.first_from(*time))
            .filter(is_inside)
            .collect();
        let shown = levels.at_mean_conditions(series);
        let asked = Asked::new(&shown, &weights, &[], *beliefs).beside(&done);
        let stepped = stepped_events(&asked, &changes, (&candidates, &known))?;
        let of_series = Asked::new(series, &weights, &[], *beliefs).beside(&done);
        // Asked in place of the trend as it is where nothing else stepped.
        let step_in_gap = gap::step_instead(series, &weights, &levels, (&recorded, beliefs));
        levels =
            levels.with_trend(trend::averaged(&stepped, &of_series, (&boundaries, &recorded))?);
        let measured = Levels::fit(series, &weights, &merged(&boundaries, &recorded), beliefs)?;
        let events = (0..events.len())
            .map(|event| effect(event, &at_flight, (&levels, &measured)))
            .collect();
        let at_mean_conditions = levels.at_mean_conditions(series);
        Some(Self { noise, weights, changes, levels, step_in_gap, events, at_mean_conditions })
    }

    /// [`weighted_mean_percent`] of flights with the weights of this history.
    #[must_use]
    pub fn mean_percent(&self, series: &Series, flights: Range<usize>) -> Option<Estimate> {
        weighted_mean_percent(series, &self.weights, flights)
    }
}

/// Weighted mean of flights, %.
///
/// ```text
/// Σ w·y/Σ w,  variance 1/Σ w                                                                 [monitoring.11]
/// ```
///
/// Weights are those of [`Noise::weights`], %⁻², as many as the series has flights. `None` without a flight.
#[must_use]
pub fn weighted_mean_percent(
    series: &Series,
    weights: &[f64],
    flights: Range<usize>,
) -> Option<Estimate> {
    let of = series.flights().get(flights.clone())?;
    let weights = weights.get(flights)?;
    let weight: f64 = weights.iter().sum();
    let sum: f64 = of.iter().zip(weights).map(|(f, w)| f.deviation_percent() * w).sum();
    (weight > 0.0).then(|| Estimate { value: sum / weight, deviation: weight.powf(-0.5) })
}

/// Changes that a series shows, each with the event that it belongs to.
fn found(
    shown: &Series,
    weights: &[f64],
    candidates: &[Candidate],
    beliefs: &ChangeBeliefs,
) -> Vec<Change> {
    let flights: Vec<usize> = candidates.iter().map(|candidate| candidate.flight).collect();
    let mut changes = Asked::new(shown, weights, &flights, *beliefs).changes();
    for change in &mut changes {
        belong(change, candidates);
    }
    changes
}

/// Both together in order, each once.
fn merged(some: &[usize], others: &[usize]) -> Vec<usize> {
    let mut all = [some, others].concat();
    all.sort_unstable();
    all.dedup();
    all
}

/// First flights after recorded events that are more probably steps than not, beside the changes and each other: left out, one
/// after the other, where the flights and what is believed of an event say rather that nothing changed.
///
/// ```text
/// odds = p/(1 − p)·p(d | a step there)/p(d | none there),  p [`ChangeBeliefs::change_at_event`]    [monitoring.23]
/// ```
///
/// A wash that is too small to be a change by itself takes back what a year of wear makes all the same: a trend over several of
/// them, left out, is next to none.
fn stepped_events(
    asked: &Asked<'_>,
    changes: &[Change],
    (candidates, known): (&[Candidate], &[usize]),
) -> Option<SteppedEvents> {
    let Asked { series, ref beliefs, middle_percent, .. } = *asked;
    let found: Vec<usize> = changes.iter().map(|change| change.first_flight).collect();
    // What is known to be a step is one in every set, whatever else is found about its date.
    let is_asked = |flight: &usize| {
        let near = |change: &Change| (change.earliest..=change.latest).contains(flight);
        (1..series.len()).contains(flight) && !changes.iter().any(near) && !known.contains(flight)
    };
    let mut kept =
        merged(&[], &candidates.iter().map(|c| c.flight).filter(is_asked).collect::<Vec<_>>());
    let at_event = beliefs.change_at_event;
    let ln_believed = at_event.ln() - (-at_event).ln_1p();
    let ln_evidence = |kept: &[usize]| {
        let boundaries = merged(&found, &merged(known, kept));
        Some(asked.levels(&boundaries, beliefs)?.ln_evidence(middle_percent, beliefs))
    };
    let ln_posterior = |kept: &[usize]| Some(ln_evidence(kept)? + kept.len() as f64 * ln_believed);
    let mut with_all = ln_posterior(&kept)?;
    let mut weighed = vec![(merged(known, &kept), with_all)];
    loop {
        let mut best: Option<(usize, f64)> = None;
        for place in 0..kept.len() {
            let mut others = kept.clone();
            others.remove(place);
            let ln = ln_posterior(&others)?;
            if best.is_none_or(|(_, most)| ln > most) {
                best = Some((place, ln));
            }
            weighed.push((merged(known, &others), ln));
        }
        let Some((place, ln)) = best.filter(|(_, ln)| *ln > with_all) else {
            let kept = merged(known, &kept);
            return Some(SteppedEvents { kept, known: known.to_vec(), weighed });
        };
        kept.remove(place);
        with_all = ln;
    }
}

/// Which recorded events are steps.
struct SteppedEvents {
    /// First flights after those that more probably are than not, and after what is known to be one.
    kept: Vec<usize>,
    /// Those among them that are known to be steps.
    known: Vec<usize>,
    /// The sets that were weighed on the way to it, not all that there are, each with ln of its probability but for a common term.
    weighed: Vec<(Vec<usize>, f64)>,
}

impl SteppedEvents {
    /// Of the steps known within the interval of a change's date: the nearest one, and the first and the last of all.
    fn nearest_known(&self, change: &Change) -> Option<(usize, (usize, usize))> {
        let is_within = |flight: &&usize| (change.earliest..=change.latest).contains(*flight);
        let within = || self.known.iter().filter(is_within).copied();
        let nearest = within().min_by_key(|flight| flight.abs_diff(change.first_flight))?;
        Some((nearest, (within().min()?, within().max()?)))
    }
}

/// Levels between changes and what is a step, without the changes, one after the other, whose step may be none: its 95 % interval
/// holds zero.
///
/// One that may be none in addition to steps known within the interval of its date may be these steps instead: it is asked for once
/// more as what they come to together, beginning at the nearest, and so a change of every engine of which each has another date stays
/// one.
fn levels_between(
    changes: &mut Vec<Change>,
    stepped: &SteppedEvents,
    series: &Series,
    weights: &[f64],
    beliefs: &ChangeBeliefs,
) -> Option<Levels> {
    // Of each change: the first and the last of the steps that it is taken for.
    let mut taken_for: Vec<Option<(usize, usize)>> = vec![None; changes.len()];
    loop {
        let found: Vec<usize> = changes.iter().map(|change| change.first_flight).collect();
        let levels = Levels::fit(series, weights, &merged(&found, &stepped.kept), beliefs)?;
        for (change, steps) in changes.iter_mut().zip(&taken_for) {
            let (first, last) = steps.unwrap_or((change.first_flight, change.first_flight));
            if let Some(step) = levels.step_over(first, last) {
                change.step_percent = step;
            }
        }
        let deviations = |step: Estimate| step.value.abs() / step.deviation;
        let least = changes
            .iter()
            .enumerate()
            .map(|(place, change)| (place, deviations(change.step_percent)))
            .min_by(|(_, one), (_, other)| one.total_cmp(other))
            .filter(|(_, deviations)| *deviations <= NORMAL_95);
        let Some((place, _)) = least else { return Some(levels) };
        let nearest = stepped.nearest_known(&changes[place]);
        if let (Some((nearest, steps)), None) = (nearest, taken_for[place]) {
            changes[place].first_flight = nearest;
            taken_for[place] = Some(steps);
        } else {
            changes.remove(place);
            taken_for.remove(place);
        }
    }
}

/// A series whose changes are asked for.
struct Asked<'a> {
    series: &'a Series,
    weights: &'a [f64],
    /// Flights before which an event was recorded.
    events: &'a [usize],
    beliefs: ChangeBeliefs,
    /// First flights after something was done to burn less, where that is allowed for.
    done: &'a [usize],
    /// The median deviation, %.
    middle_percent: f64,
}

impl<'a> Asked<'a> {
    fn new(
        series: &'a Series,
        weights: &'a [f64],
        events: &'a [usize],
        beliefs: ChangeBeliefs,
    ) -> Self {
        let mut all: Vec<f64> = series
            .flights()
            .iter()
            .map(super::series::FlightDeviation::deviation_percent)
            .collect();
        Self { series, weights, events, beliefs, done: &[], middle_percent: median(&mut all) }
    }

    /// The same beside what was done to burn less before these flights.
    fn beside(self, done: &'a [usize]) -> Self {
        Self { done, ..self }
    }

    /// Levels between boundaries.
    fn levels(&self, boundaries: &[usize], beliefs: &ChangeBeliefs) -> Option<Levels> {
        Levels::fit_beside(self.series, self.weights, (boundaries, self.done), beliefs)
    }

    /// A filter that has seen all flights, before some of which nothing can have changed.
    fn filter(&self, unchanged: &Range<usize>) -> ChangeFilter {
        let mut filter = ChangeFilter::new(self.beliefs);
        for (index, (flight, weight)) in self.series.flights().iter().zip(self.weights).enumerate()
        {
            filter.push(&FilteredFlight {
                years: self.series.years(flight.time()),
                deviation_percent: flight.deviation_percent() - self.middle_percent,
                weight: *weight,
                event_before: if unchanged.contains(&index) {
                    EventBefore::Unchanged
                } else if self.events.contains(&index) {
                    EventBefore::Recorded
                } else {
                    EventBefore::None
                },
            });
        }
        filter
    }

    /// Changes that are more probable than not, each with the probability that there is one among the flights R nearest to it.
    ///
    /// ```text
    /// P = 1 − Π_R (1 − p)·F(given none among R)/F,   Q = 1 − Π_R (1 − p)
    /// probability: odds P/(1 − P)·min(1, q(1 − Q)/(Q(1 − q)))                                     [monitoring.18]
    /// ```
    ///
    /// with q = [`ChangeBeliefs::change_at_most`]: over months with few flights the calendar alone makes a change probable,
    /// which is no sign of one.
    fn changes(&self) -> Vec<Change> {
        let filter = self.filter(&(0..0));
        let mut known = changes(&filter);
        let firsts: Vec<usize> = known.iter().map(|change| change.first_flight).collect();
        for (change, (_, near)) in known.iter_mut().zip(nearest(&firsts, self.series.len())) {
            change.probability = self.probability(&filter, near);
        }
        known.retain(|change| change.probability >= REPORTED_PROBABILITY);
        known
    }

    /// Probability of at least one change before one of these flights [monitoring.18]. In logarithms: of many events, or many
    /// years, it is certain beforehand that something changes to the last bit of a number.
    fn probability(&self, seen: &ChangeFilter, flights: Range<usize>) -> f64 {
        let ln_unchanged = self.ln_unchanged_before(flights.clone());
        let ln_evidence = seen.log_density() - self.filter(&flights).log_density();
        let ln_none = (ln_unchanged - ln_evidence).min(0.0);
        let ln_change = (-ln_none.exp_m1()).ln();
        let at_most = self.beliefs.change_at_most;
        // Odds, as they are believed beforehand and as they are believed at most: what is larger is left out.
        let as_believed = ln_change - ln_none;
        let from_the_most = ln_change + ln_evidence + at_most.ln()
            - (-at_most).ln_1p()
            - (-ln_unchanged.exp_m1()).ln();
        1.0 / (1.0 + (-as_believed.min(from_the_most)).exp())
    }

    /// ln of the probability that nothing changes before any of these flights, before any flight is seen.
    fn ln_unchanged_before(&self, flights: Range<usize>) -> f64 {
        let years = |flight: usize| self.series.years(self.series.flights()[flight].time());
        let changes = |flight: usize| {
            if self.events.contains(&flight) {
                self.beliefs.change_at_event
            } else {
                self.beliefs.change_within(years(flight) - years(flight - 1))
            }
        };
        flights.filter(|flight| *flight > 0).map(|flight| (-changes(flight)).ln_1p()).sum()
    }
}

/// An event that a change may belong to.
struct Candidate {
    event: usize,
    /// First flight at or after it.
    flight: usize,
    is_likely: bool,
}

/// A change within whose interval an event lies is that event's: the nearest one, but rather a likely one; the earlier of two that are
/// as near.
fn belong(change: &mut Change, candidates: &[Candidate]) {
    let mut near: Vec<&Candidate> = candidates
        .iter()
        .filter(|candidate| (change.earliest..=change.latest).contains(&candidate.flight))
        .collect();
    near.sort_by_key(|candidate| {
        let distance = candidate.flight.abs_diff(change.first_flight);
        (!candidate.is_likely, distance, candidate.flight, candidate.event)
    });
    if let Some((first, others)) = near.split_first() {
        change.event = Some(first.event);
        change.first_flight = first.flight;
        change.other_events = others.iter().map(|candidate| candidate.event).collect();
    }
}

/// What an event did: the step that the levels have there, or else, where they have none, the one of a fit with all events.
fn effect(
    event: usize,
    at_flight: &[usize],
    (levels, with_all): (&Levels, &Levels),
) -> EventEffect {
    let first_flight = at_flight[event];
    let effect_percent = levels.step_at(first_flight).or_else(|| with_all.step_at(first_flight));
    let others = at_flight.iter().enumerate();
    // Without a flight before and one after nothing is measured, and nothing together.
    let together_with = others
        .filter(|(other, flight)| {
            effect_percent.is_some() && *other != event && **flight == first_flight
        })
        .map(|(other, _)| other)
        .collect();
    EventEffect { event, first_flight, effect_percent, together_with }
}

#[cfg(test)]
mod tests;
